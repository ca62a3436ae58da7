//! What stands below the pictures of many materials.

use hadar_study::Scaling;

/// Below the shares of the bands.
pub(crate) const SHARES: &str =
    "What each band adds to the square of the distance once the unknowns are fitted.";

/// Below all materials against all.
pub(crate) fn all_against_all(by: &str, told_apart: bool) -> String {
    let both =
        if told_apart { " A pair counts as distinguished only if it is in both directions." } else { "" };
    format!("By the {by} distance; every target in the scenario's state.{both}")
}

/// Below the target against all.
pub(crate) fn against_all(by: &str) -> String {
    format!("By the {by} distance, in the scenario's state.")
}

/// Below the readings of several materials.
pub(crate) fn readings(limiting: &str, seed: u64) -> String {
    format!(
        "Above: means, all in the scenario's state. Below: the target and {limiting}, one reading of each drawn at random \
         (seed {seed}), less the target's mean, and the expected difference."
    )
}

/// Below the distances over the size of the library.
pub(crate) fn library_size(by: &str, all_are_0: bool) -> String {
    format!(
        "Expected {by} distance from a target to the nearest of its alternatives, over all libraries of that size.{}",
        zero(all_are_0)
    )
}

/// Below the distances over the number of bands.
pub(crate) fn band_number(scaling: &Scaling) -> String {
    let bands = &scaling.bands;
    let left_out = match bands.left_out.as_slice() {
        [] => String::new(),
        [one] => {
            format!(" Without {one}, which cannot be distinguished as required even with shot noise alone.")
        }
        more => format!(
            " Without {} alternatives that cannot be distinguished as required even with shot noise alone.",
            more.len()
        ),
    };
    format!(
        "Neighbouring bands joined. Photons are the same for any number of bands{}.{left_out}{}",
        if bands.camera.is_empty() { "" } else { "; the camera's noise is added to every reading" },
        zero(bands.shot_noise_median.iter().all(|d| *d == 0.0))
    )
}

const fn zero(all: bool) -> &'static str {
    if all { " All are 0." } else { "" }
}
