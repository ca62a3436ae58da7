//! Plots and tables into a bundle, rendered in parallel.

use crate::error::Result;
use crate::report::bundle::Bundle;
use crate::report::figures::Plot;
use crate::report::plot::{render_png, render_svg};
use crate::report::table::{Table, number, optional};
use crate::study::PairResult;
use rayon::prelude::*;

/// Adds SVG, PNG and CSV of every plot.
pub(super) fn add(bundle: &mut Bundle, plots: &[Plot]) -> Result<()> {
    let rendered: Result<Vec<(String, Vec<u8>, String)>> = plots
        .par_iter()
        .map(|plot| Ok((render_svg(&plot.figure)?, render_png(&plot.figure)?, plot.table.to_csv()?)))
        .collect();
    for (plot, (svg, png, csv)) in plots.iter().zip(rendered?) {
        bundle.add(format!("{}.svg", plot.name), svg);
        bundle.add(format!("{}.png", plot.name), png);
        bundle.add(format!("{}.csv", plot.name), csv);
    }
    Ok(())
}

/// All pairs as a table.
pub(super) fn pairs(pairs: &[PairResult]) -> Table {
    let mut table = Table::new([
        "target",
        "alternative",
        "distance_nearest_per_sqrt_photon",
        "distance_local_per_sqrt_photon",
        "distance_local_unknown_gain_per_sqrt_photon",
        "distance_no_nuisance_per_sqrt_photon",
        "distance_return_per_sqrt_photon",
        "nearest_temperature_k",
        "nearest_lighting",
        "photons_required_nearest",
        "photons_required_local",
        "photons_required_local_unknown_gain",
        "statistical_distance_camera",
        "detection_probability_camera",
        "miss_probability_camera",
        "information_bits_camera",
        "condition_number",
        "relative_error_local",
    ]);
    for pair in pairs {
        let lighting: Vec<String> = pair.nearest_state.lighting.iter().map(|&v| number(v)).collect();
        table.push(vec![
            pair.target.clone(),
            pair.alternative.clone(),
            number(pair.distance_nearest),
            number(pair.distance_local),
            number(pair.distance_local_unknown_gain),
            number(pair.distance_no_nuisance),
            number(pair.distance_return),
            number(pair.nearest_state.temperature_k),
            lighting.join(" "),
            optional(pair.photons_required_by.nearest),
            optional(pair.photons_required_by.local),
            optional(pair.photons_required_by.local_unknown_gain),
            optional(pair.statistical_distance),
            optional(pair.detection_probability),
            optional(pair.miss_probability),
            optional(pair.information_bits),
            optional(pair.condition_number),
            number(pair.relative_error),
        ]);
    }
    table
}
