//! The files of `simulate`: scenario, tables and plots.

pub mod average;
pub mod figures;
mod spectra;
pub mod thermometry;

pub use crate::words::simulate::text;

use self::figures::SimulationCurves;
use crate::bundle::Bundle;
use crate::table::{Table, number};
use crate::tables;
use crate::words::simulate::{pair, retrieved};
use hadar::error::Result;
use hadar_study::{NoiseCurves, Simulation, Study};

/// All files of a simulation; paths in the scenario are written relative to `out` where they lie below it.
///
/// # Errors
/// A figure that cannot be drawn.
pub fn bundle(study: &Study, result: &Simulation, noise: Option<&NoiseCurves>) -> Result<Bundle> {
    let mut bundle = Bundle::about(study.scenario().title.as_deref());
    bundle.add_asked("scenario.toml", study.scenario().to_toml());
    bundle.add_table("simulation.csv", figures::simulation_table(result))?;
    bundle.add_table("confusion.csv", confusion(result))?;
    spectra::add(&mut bundle, result)?;
    if !result.safety.is_empty() {
        bundle.add_table("safety.csv", tables::safety(&result.safety))?;
    }
    bundle.add_warnings(&result.warnings)?;
    let pair = pair(result);
    let plot = match result.points.as_slice() {
        [point] => figures::accuracies(result, point, &pair),
        _ => {
            let title = retrieved(&pair);
            figures::classifiers(result, &SimulationCurves { title, noise, other: None, name: "classifiers" })
        }
    };
    bundle.add_plots(&[plot])?;
    if let Some(noise) = noise {
        bundle.add_table("noise_curves.csv", curves(noise))?;
    }
    Ok(bundle)
}

/// Decisions by true and by chosen class.
fn confusion(result: &Simulation) -> Table {
    let mut table = Table::new(["photons", "classifier", "true_class", "chosen_class", "decisions", "share"]);
    for point in &result.points {
        let name = |class: usize| point.classes.get(class).map_or("", |class| class.material.as_str());
        for found in &point.performances {
            let confusion = &found.performance.confusion;
            for (class, (row, spectra)) in confusion.decisions.iter().zip(confusion.spectra()).enumerate() {
                for (chosen, decisions) in row.iter().enumerate() {
                    table.push(vec![
                        number(point.photons),
                        found.performance.name(),
                        name(class).into(),
                        name(chosen).into(),
                        number(*decisions),
                        number(decisions / spectra.max(1.0)),
                    ]);
                }
            }
        }
    }
    table
}

/// Limits over photons under each kind of noise.
#[must_use]
pub fn curves(noise: &NoiseCurves) -> Table {
    let mut header = vec!["normalised_photons_n_d0_squared".to_owned()];
    for curve in &noise.curves {
        let name = curve.name.replace(' ', "_").to_lowercase();
        header.extend(
            ["gamma_per_band", "statistical_distance", "information_bits"].map(|q| format!("{q}_{name}")),
        );
    }
    let mut table = Table::new(header);
    let bits: Vec<Vec<f64>> = noise.curves.iter().map(|curve| curve.information_bits()).collect();
    for (i, n) in noise.normalised_photons.iter().enumerate() {
        let mut row = vec![*n];
        for (curve, bits) in noise.curves.iter().zip(&bits) {
            row.extend([curve.gamma[i], curve.distance[i], bits[i]]);
        }
        table.push_numbers(&row);
    }
    table
}
