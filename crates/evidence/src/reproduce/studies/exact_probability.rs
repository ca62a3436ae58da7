//! What a test achieves, beside what the distances promise.
//!
//! Pairs of the built-in library in the paper's scene: the local and the nearest distance, the two-sided estimate, the
//! rigorous bracket, Algorithm 1 of the paper (three bands) and simulated decisions side by side.

mod decided;
mod files;
mod text;
mod three_bands;

use super::paper_scene::PaperScene;
use crate::reproduce::order::{Effort, Order, Progress};
use decided::{HALF_WIDTH, Line, Materials, line};
use hadar::error::Result;
use hadar::material::Library;
use hadar::spectrum::Bands;
use hadar_report::bundle::Bundle;
use hadar_simulate::sequential::Plan;
use three_bands::lattice_line;

/// Seed of the committed report.
const SEED: u64 = 2023;
/// Statistical distances √N d_nearest at which each pair is looked at.
const LEVELS: [f64; 3] = [0.5, 1.0, 2.0];
/// Pairs of each table in the quick form.
const QUICK: usize = 2;

/// Target, alternative, temperature of the target in °C; from a local distance far too large to one far too small.
const PAIRS: [(&str, &str, f64); 20] = [
    ("aluminium", "ice", 37.0),
    ("aluminium", "brick-red", 60.0),
    ("aluminium", "pet", 60.0),
    ("steel-rough", "aluminium-anodised", 60.0),
    ("steel-rough", "fused-silica", 60.0),
    ("aluminium", "skin", 37.0),
    ("soil-loam", "brick-red", 60.0),
    ("skin", "soda-lime-glass", 60.0),
    ("terracotta-tile", "concrete", 60.0),
    ("paint-matt-black", "slate", 60.0),
    ("concrete", "fused-silica", 60.0),
    ("skin", "aluminium", 37.0),
    ("skin", "aluminium", 60.0),
    ("skin", "fused-silica", 60.0),
    ("rubber-tyre", "asphalt", 60.0),
    ("soda-lime-glass", "concrete", 60.0),
    ("sand-quartz", "soil-loam", 60.0),
    ("ice", "pvc-tape", 60.0),
    ("soda-lime-glass", "asphalt", 60.0),
    ("fabric", "steel-rough", 60.0),
];

/// Pairs for three bands and Algorithm 1.
const LATTICE_PAIRS: [(&str, &str); 6] = [
    ("skin", "fused-silica"),
    ("skin", "soda-lime-glass"),
    ("soda-lime-glass", "aluminium"),
    ("fused-silica", "concrete"),
    ("concrete", "titanium-dioxide"),
    ("fused-silica", "aluminium-anodised"),
];

/// Pairs for other laws of counting.
const OTHER_LAWS: [(&str, &str, f64); 2] = [("skin", "aluminium", 37.0), ("sand-quartz", "soil-loam", 60.0)];
const LAWS: [&str; 2] = ["gaussian", "negative-binomial"];

/// The quick form has the tables alone, of the first pairs.
pub(super) fn make(order: Order, library: &Library, progress: Progress<'_>) -> Result<(Bundle, String)> {
    let seed = order.seed_from(SEED);
    let pairs = order.some_of(&PAIRS, QUICK);
    let other_laws = order.some_of(&OTHER_LAWS, QUICK);
    let lattice_pairs = order.some_of(&LATTICE_PAIRS, QUICK);
    let total = LEVELS.len() * pairs.len() + LAWS.len() * other_laws.len() + lattice_pairs.len();
    let mut done = 0;
    let mut tell = || {
        done += 1;
        progress(done, total);
    };
    let plan = Plan::new(seed, HALF_WIDTH, 100_000)?;
    let all = Materials { library, scene: PaperScene::new(Bands::uniform(720.0, 1250.0, 10.0)?)?, plan };
    let lines = pairs.iter().flat_map(|pair| LEVELS.map(|level| (*pair, level)));
    let lines: Vec<Line> = lines
        .map(|(pair, level)| line(&all, pair, "poisson", level).inspect(|_| tell()))
        .collect::<Result<_>>()?;
    let laws = other_laws.iter().flat_map(|pair| LAWS.map(|law| (*pair, law)));
    let laws: Vec<Line> =
        laws.map(|(pair, law)| line(&all, pair, law, 1.0).inspect(|_| tell())).collect::<Result<_>>()?;
    let wide = Bands::from_ranges(&[(720.0, 895.0), (895.0, 1070.0), (1070.0, 1250.0)])?;
    let filters = Materials { scene: PaperScene::new(wide)?, ..all };
    let lattice = lattice_pairs
        .iter()
        .map(|&(a, b)| lattice_line(&filters, [a, b]).inspect(|_| tell()))
        .collect::<Result<Vec<_>>>()?;
    let mut bundle = Bundle::default();
    bundle.add("pairs.csv", files::csv(&lines)?);
    bundle.add("three_bands.csv", files::lattice_csv(&lattice)?);
    bundle.add("other_laws.csv", files::csv(&laws)?);
    if order.effort == Effort::Full {
        bundle.add("README.md", text::readme(&lines, &lattice, &laws, seed));
        bundle.add_plots(&[files::against_distances(&lines), files::against_estimates(&lines)])?;
    }
    Ok((bundle, text::finding(&lines)))
}
