//! What priors do.
//!
//! Skin against aluminium around thermal equilibrium, where without a prior no number of photons suffices, with a prior
//! on the temperature; and the nearest distance for ever narrower ranges of the alternative's state.

mod files;
mod photons;
mod ranges;
mod text;

use crate::reproduce::order::{Effort, Order, Progress};
use hadar::error::Result;
use hadar::material::Library;
use hadar_report::bundle::Bundle;
use photons::{AMBIENT_CELSIUS, PRIOR_K, Photons, Task};
use ranges::{ranges, ranges_csv};
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Equilibrium, with the prior of the curves: what `hadar identify` reads.
const SCENARIO: &str = r#"title = "A person and a robot in a room at their own temperature"

[target]
material = "skin"
temperature = "20 degC"

[[environment]]
temperature = "20 degC"
lighting = 1.0

[alternatives]
materials = ["aluminium"]

[bands]
start = "715 cm^-1"
stop = "1250 cm^-1"
step = "1 cm^-1"

[unknown]
nuisances = ["temperature", "lighting"]
priors = { temperature = "2 K" }
"#;

/// Seed of the committed report.
const SEED: u64 = 37;
/// Deviations of the prior at equilibrium, K; the quick form has the first.
const WIDTHS_K: [f64; 9] = [0.1, 0.2, 0.5, 1.0, 2.0, 3.0, 5.0, 7.0, 10.0];
const QUICK: usize = 2;
/// Temperatures of the target beside the whole degrees from 10 to 45, °C: closer where the curves bend.
const BEND_CELSIUS: [f64; 12] =
    [19.5, 19.75, 19.9, 19.97, 19.99, 20.01, 20.03, 20.1, 20.25, 20.4, 20.5, 20.75];

/// The quick form has the tables alone: the ranges, and the first widths of the prior.
pub(super) fn make(order: Order, library: &Library, progress: Progress<'_>) -> Result<(Bundle, String)> {
    let task = Task::new(library)?;
    let seed = order.seed_from(SEED);
    let mut celsius: Vec<f64> = (10..=45).map(f64::from).chain(BEND_CELSIUS).collect();
    celsius.sort_by(f64::total_cmp);
    let widths_k = order.some_of(&WIDTHS_K, QUICK);
    let total = match order.effort {
        Effort::Full => widths_k.len() + 2 * celsius.len(),
        Effort::Quick => widths_k.len(),
    };
    let done = AtomicUsize::new(0);
    let photons = |celsius: f64, lighting: f64, prior_k: f64| {
        task.photons(celsius, lighting, prior_k)
            .inspect(|_| progress(done.fetch_add(1, Ordering::Relaxed) + 1, total))
    };
    let wide = widths_k
        .par_iter()
        .map(|&prior_k| Ok((vec![prior_k], photons(AMBIENT_CELSIUS, 1.0, prior_k)?)))
        .collect::<Result<Vec<_>>>()?;
    let rows = ranges(&task, library)?;
    let finding = text::finding(&wide);
    let mut bundle = Bundle::default();
    bundle.add("state_ranges.csv", ranges_csv(&rows)?);
    if order.effort == Effort::Quick {
        bundle.add_table("prior_width.csv", files::widths(&wide).table)?;
        return Ok((bundle, finding));
    }
    let sweep = |lighting: f64| {
        let row = |&t: &f64| Ok((vec![t, lighting], photons(t, lighting, PRIOR_K)?));
        celsius.par_iter().map(row).collect::<Result<Vec<(Vec<f64>, Photons)>>>()
    };
    let (one, half) = (sweep(1.0)?, sweep(0.5)?);
    let at_37 = |rows: &photons::Rows, lighting: f64| {
        let found = rows.iter().find(|(keys, _)| keys[0] == 37.0);
        let photons = found.and_then(|(_, photons)| photons.average_nearest).unwrap_or(f64::NAN);
        task.simulated(37.0, lighting, photons, seed)
    };
    let simulated = [at_37(&one, 1.0)?, at_37(&half, 0.5)?];
    bundle.add("README.md", text::readme(&one, &half, &wide, &rows, simulated, seed));
    bundle.add_asked("scenario.toml", SCENARIO);
    bundle.add_plots(&[
        files::temperatures("temperature_v1", 1.0, 1e11, &one),
        files::temperatures("temperature_v05", 0.5, 1e8, &half),
        files::widths(&wide),
    ])?;
    Ok((bundle, finding))
}
