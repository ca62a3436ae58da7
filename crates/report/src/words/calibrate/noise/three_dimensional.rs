//! What pixels, rows, columns and frames of a camera have in common, in words and as its figures.

use hadar::words::significant;
use hadar_study::calibrate::NoiseFound;
use std::fmt::Write as _;

/// What each of the seven variances is of, in the order in which they are found, and the key of a camera.
const TERMS: [(&str, &str, Option<&str>); 7] = [
    ("tvh", "pixel, from frame to frame", None),
    ("vh", "pixel to pixel, staying", Some("fixed_pattern")),
    ("v", "row to row, staying", Some("row_noise")),
    ("h", "column to column, staying", Some("column_noise")),
    ("tv", "row to row, from frame to frame", Some("temporal_row_noise")),
    ("th", "column to column, frame to frame", Some("temporal_column_noise")),
    ("t", "whole frames", Some("frame_noise")),
];

/// Deviations of the noise in three dimensions; nothing of one frame.
pub(super) fn in_three_dimensions(result: &NoiseFound) -> String {
    let Some(components) = &result.three_dimensional else { return String::new() };
    let scene = if result.scenario.noise.uniform { "" } else { "; what stays has the scene in it" };
    let mut out = format!("Noise in three dimensions, deviations (unit of the cube){scene}\n");
    for (component, (of, what, _)) in components.iter().zip(TERMS) {
        let [sigma, low, high] = component.sigma().map(|sigma| significant(sigma, 3));
        let name = format!("{what} ({of})");
        let _ = writeln!(out, "  {name:<40}  {sigma:>10}   95 %: {low} to {high}");
    }
    out.push('\n');
    out
}

/// What pixels share, as a scenario's `[camera]` has it: what is not seen is taken as large as it can be.
pub(super) fn shared(result: &NoiseFound) -> String {
    let Some(components) = &result.three_dimensional else { return String::new() };
    let (spec, mut out) = (&result.scenario.noise, String::new());
    let [pixel, ..] = components[0].sigma();
    for (component, (_, _, key)) in components.iter().zip(TERMS) {
        let Some(key) = key else { continue };
        let stays = matches!(key, "fixed_pattern" | "row_noise" | "column_noise");
        let [sigma, low, high] = component.sigma();
        let (share, at_most) = if low > 0.0 { (sigma / pixel, "") } else { (high / pixel, " # at most") };
        let _ = match spec.netd_k {
            _ if stays && !spec.uniform => {
                writeln!(out, "# {key}: the scene is in it; [noise] uniform = true says that there is none")
            }
            Some(netd_k) => writeln!(out, "{key} = \"{} mK\"{at_most}", significant(1e3 * netd_k * share, 3)),
            None => {
                writeln!(out, "# {key}: {} of the NETD{}", significant(share, 3), at_most.replace(" #", ","))
            }
        };
    }
    out
}
