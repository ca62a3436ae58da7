//! How often the local distance misleads in a whole library.
//!
//! All ordered pairs of a library (the report: the 54 channels that the authors of the paper publish), the local distance
//! against the nearest; for some random pairs both against simulated decisions.

mod figures;
mod files;
mod pairs;
mod text;

use super::paper_scene::PaperScene;
use crate::reproduce::order::{Effort, Order, Progress};
use figures::{decision_figures, distance_figures, figures_csv};
use hadar::error::Result;
use hadar::material::Library;
use hadar::spectrum::Bands;
use hadar_report::bundle::Bundle;
use hadar_simulate::draws::generator;
use hadar_simulate::sequential::Plan;
use pairs::{all_pairs, decide};

/// Seed of the committed report, for the choice of the pairs and for the draws.
const SEED: u64 = 54;
/// Half of the 95 % interval of every simulated probability.
const HALF_WIDTH: f64 = 0.004;
/// Pairs that are simulated, and in the quick form.
const SIMULATED: usize = 60;
const QUICK: usize = 3;

/// The quick form has the tables alone: all distances, and the first of the simulated pairs.
pub(super) fn make(order: Order, library: &Library, progress: Progress<'_>) -> Result<(Bundle, String)> {
    let seed = order.seed_from(SEED);
    let scene = PaperScene::new(Bands::uniform(720.0, 1250.0, 10.0)?)?;
    let plan = Plan::new(seed, HALF_WIDTH, 100_000)?;
    let (spectra, pairs) = all_pairs(&scene, library)?;
    let chosen =
        rand::seq::index::sample(&mut generator(seed, 0), pairs.len(), SIMULATED.min(pairs.len())).into_vec();
    let chosen = order.some_of(&chosen, QUICK);
    let mut decided = Vec::new();
    for &i in chosen {
        decided.push(decide(&scene, &spectra, &pairs[i], &plan)?);
        progress(decided.len(), chosen.len());
    }
    let mut bundle = Bundle::default();
    bundle.add("pairs.csv", files::pairs_csv(&pairs)?);
    bundle.add("simulated.csv", files::decisions_csv(&decided)?);
    let mut figures = distance_figures(&pairs);
    if order.effort == Effort::Full {
        figures.extend(decision_figures(&decided));
        bundle.add("figures.csv", figures_csv(&figures)?);
        bundle.add("README.md", text::readme(&pairs, &decided, &figures, (seed, HALF_WIDTH)));
        bundle.add_plots(&[files::ratios(&pairs), files::decisions(&decided)])?;
    }
    Ok((bundle, text::findings(&figures)))
}
