//! What priors do.
//!
//! Skin against aluminium around thermal equilibrium, where without a prior no number of photons suffices, with priors
//! on temperature and lighting; and the nearest distance for ever narrower ranges of the alternative's state.

mod files;
mod photons;
mod ranges;
mod text;

use crate::reproduce::order::{Effort, Order, Progress};
use hadar::error::Result;
use hadar::material::Library;
use hadar_report::bundle::Bundle;
use photons::{AMBIENT_CELSIUS, PRIOR_K, PRIOR_LIGHTING, Photons, Task};
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
priors = { temperature = "2 K", lighting = 0.1 }
"#;

/// Seed of the committed report.
const SEED: u64 = 37;
/// Deviations of the prior at equilibrium, K; the quick form has the first.
const WIDTHS_K: [f64; 9] = [0.1, 0.2, 0.5, 1.0, 2.0, 3.0, 5.0, 7.0, 10.0];
const QUICK: usize = 2;
/// Temperatures of the target, °C: closer where the curves bend.
const CELSIUS: [f64; 17] =
    [10.0, 12.5, 15.0, 17.0, 18.0, 19.0, 19.5, 19.9, 20.0, 20.1, 20.5, 21.0, 22.0, 25.0, 30.0, 37.0, 45.0];

/// The quick form has the tables alone: the ranges, and the first widths of the prior.
pub(super) fn make(order: Order, library: &Library, progress: Progress<'_>) -> Result<(Bundle, String)> {
    let task = Task::new(library)?;
    let seed = order.seed_from(SEED);
    let widths_k = order.some_of(&WIDTHS_K, QUICK);
    let total = match order.effort {
        Effort::Full => widths_k.len() + 2 * CELSIUS.len(),
        Effort::Quick => widths_k.len(),
    };
    let done = AtomicUsize::new(0);
    let photons = |celsius: f64, lighting: f64, prior_k: f64, prior_lighting: Option<f64>| {
        task.photons(celsius, lighting, prior_k, prior_lighting)
            .inspect(|_| progress(done.fetch_add(1, Ordering::Relaxed) + 1, total))
    };
    let wide = widths_k
        .par_iter()
        .map(|&prior_k| Ok((vec![prior_k], photons(AMBIENT_CELSIUS, 1.0, prior_k, None)?)))
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
        let row = |&t: &f64| Ok((vec![t, lighting], photons(t, lighting, PRIOR_K, Some(PRIOR_LIGHTING))?));
        CELSIUS.par_iter().map(row).collect::<Result<Vec<(Vec<f64>, Photons)>>>()
    };
    let (one, half) = (sweep(1.0)?, sweep(0.5)?);
    let at_37 = |rows: &photons::Rows, lighting: f64| {
        let found = rows.iter().find(|(keys, _)| keys[0] == 37.0);
        let photons = found.and_then(|(_, photons)| photons.average_upper).unwrap_or(f64::NAN);
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
