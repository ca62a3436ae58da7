//! What several pictures say below their titles.

use crate::shown::Shown;

/// Of a pixel without a value.
pub(crate) const NOTHING_TOLD: &str = "nothing is told";

/// Of alternatives that are not computed because others decide.
pub(crate) const FARTHER: &str = "farther than those that decide; how far is not computed";

/// Of groups with several samples.
pub(crate) const NEAREST_OF_SAMPLES: &str =
    "Of several samples of one material the nearest is shown. All pairs are in the table.";

/// Title of the image of a thermal camera beside the signal that is scattered.
pub(crate) const THERMAL_IMAGE: &str =
    "Thermal image, all bands; colours span as many photons as in the scattered signal";

/// Of a bound that is not drawn, from the smallest to the largest of its values, K.
pub(crate) fn bound_left_out(least_k: &str, most_k: &str) -> String {
    format!(
        " The bound for unbiased estimates and unknown lighting, {least_k} to {most_k} K, does not apply and is not drawn."
    )
}

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
