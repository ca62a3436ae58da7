//! What several pictures say below their titles.

use crate::shown::Shown;

/// Of a pixel without a value.
pub(crate) const NOTHING_TOLD: &str = "nothing is told";

/// Which pixels a picture has, where it has not all of them; nothing where it has. All are in other files.
pub(crate) fn thinned(shown: Shown) -> String {
    every(shown, "; all are in the NPY files")
}

/// The same of a picture that is all there is.
pub(crate) fn thinned_alone(shown: Shown) -> String {
    every(shown, " is shown")
}

fn every(shown: Shown, end: &str) -> String {
    let Shown { size: [rows, columns], stride } = shown;
    match stride {
        1 => String::new(),
        stride => format!(" Every {stride}th row and column of {rows} × {columns}{end}."),
    }
}
