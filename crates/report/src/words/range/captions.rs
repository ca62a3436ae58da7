//! What stands below the pictures of a ranging study.

use crate::plot;
use hadar::ranging::information::Window;
use hadar_scenario::range::Demand;

/// Below matched depths.
pub(crate) const MATCHED: &str = "Block matching of one noisy pair.";
/// Below the errors of derivatives.
pub(crate) const DERIVATIVES: &str =
    "Lines: closed form. Points: measured on sinusoids. The information found is the square of this.";

/// Below the views; `same` is what is said of those that are the same everywhere.
pub(crate) fn views([rows, columns]: [usize; 2], same: &str) -> String {
    format!(
        "Left camera, {rows} × {columns} pixels. Colours cover all but the lowest and highest percent of the values.{same}"
    )
}

/// That a picture would have one colour alone.
pub(crate) fn everywhere(title: &str, value: f64, unit: &str) -> String {
    format!(" {title}: {} everywhere ({unit}).", plot::number(value))
}

/// Below the bounds of all windows; `without` are the signals that have none.
pub(crate) fn bounds(window: Window, with_depth: bool, without: &[&str]) -> String {
    let clipped = match with_depth {
        true => " Colours end at the largest depth, beyond which an error is no depth at all.",
        false => "",
    };
    let missing = match without {
        [] => String::new(),
        names => format!(" No information at all in: {}.", names.join("; ")),
    };
    format!(
        "Least error of windows of {} × {} pixels, at their centres in the left view. One colour scale for all.{clipped}{missing}",
        window.rows(),
        window.columns()
    )
}

/// The meaning of the line in them.
pub(crate) fn boundary(demand: Demand) -> String {
    format!("demanded error, {}; it is met on the darker side", demanded(demand))
}

/// A demand in words.
pub(crate) fn demanded(error: Demand) -> String {
    match error {
        Demand::Absolute(error_m) => format!("{} m", plot::number(error_m)),
        Demand::Relative(share) => format!("{} % of the depth", plot::number(100.0 * share)),
    }
}

/// Below a line; `hopeless` are signals whose error is more than `beyond` times the depth.
pub(crate) fn line(witnessed: bool, beyond: f64, hopeless: &[&str]) -> String {
    let mut said = "Lines: least error of an unbiased estimate.".to_owned();
    if witnessed {
        said += " Points: root-mean-square error of matches in repeated draws of the noise; where they are guesses, the range \
                 that is searched limits it. The views that are matched have no diffraction.";
    }
    if !hopeless.is_empty() {
        said += &format!(" More than {beyond} times the depth, and not drawn: {}.", hopeless.join("; "));
    }
    said
}

/// Which pixels of the view a picture has, and which of those its table.
pub(crate) fn some_of(thinned: usize, step: usize) -> String {
    let mut said = String::new();
    if thinned > 1 {
        said += &format!(" One in {thinned} rows and columns is shown; all are in the NPY files.");
    }
    if step > 1 {
        said += &format!(" The table holds one in {} rows and columns.", step * thinned);
    }
    said
}
