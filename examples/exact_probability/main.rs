//! What a test achieves, beside what the distances promise: makes `reports/exact_probability`.
//!
//! `cargo run --release --example exact_probability -- reports/exact_probability` takes pairs of the built-in
//! library in the scene of the paper and sets the local and the nearest distance, the two-sided estimate, the
//! rigorous bracket, Algorithm 1 of the paper (three bands) and Monte Carlo decisions side by side. With `--quick`
//! only the tables of the first pairs are made, with the same numbers.

mod decided;
mod files;
#[path = "../support/paper_scene.rs"]
mod paper_scene;
mod text;
mod three_bands;

use decided::{Materials, line};
use hadar::report::bundle::Bundle;
use hadar::spectrum::Bands;
use paper_scene::PaperScene;
use std::path::{Path, PathBuf};
use three_bands::lattice_line;

const SEED: u64 = 2023;
/// Half of the 95 % interval of every simulated probability.
const HALF_WIDTH: f64 = 0.006;
/// Statistical distances √N d_nearest at which each pair is looked at.
const LEVELS: [f64; 3] = [0.5, 1.0, 2.0];
/// Pairs of each table with `--quick`.
const QUICK: usize = 2;
/// A probability that the local distance promises misleads if it is off by more than this.
const MISLEADS: f64 = 0.02;

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
fn run(out: &Path, quick: bool) -> hadar::Result<()> {
    let first = if quick { QUICK } else { usize::MAX };
    let all = Materials::new(PaperScene::new(Bands::uniform(720.0, 1250.0, 10.0)?)?)?;
    let mut lines = Vec::new();
    for pair in PAIRS.into_iter().take(first) {
        eprintln!("{} against {}", pair.0, pair.1);
        for level in LEVELS {
            lines.push(line(&all, pair, "poisson", level)?);
        }
    }
    let mut laws = Vec::new();
    for pair in OTHER_LAWS.into_iter().take(first) {
        for law in ["gaussian", "negative-binomial"] {
            eprintln!("{} against {}, {law}", pair.0, pair.1);
            laws.push(line(&all, pair, law, 1.0)?);
        }
    }
    let wide = Bands::from_ranges(&[(720.0, 895.0), (895.0, 1070.0), (1070.0, 1250.0)])?;
    let filters = Materials::new(PaperScene::new(wide)?)?;
    let mut lattice = Vec::new();
    for (a, b) in LATTICE_PAIRS.into_iter().take(first) {
        eprintln!("{a} against {b}, three bands");
        lattice.push(lattice_line(&filters, [a, b])?);
    }
    let mut bundle = Bundle::default();
    bundle.add("pairs.csv", files::csv(&lines)?);
    bundle.add("three_bands.csv", files::lattice_csv(&lattice)?);
    bundle.add("other_laws.csv", files::csv(&laws)?);
    if !quick {
        bundle.add("README.md", text::readme(&lines, &lattice, &laws));
        bundle.add_plots(&[files::against_distances(&lines), files::against_estimates(&lines)])?;
    }
    bundle.write(out)?;
    eprintln!("wrote {}", out.display());
    Ok(())
}

fn main() -> std::process::ExitCode {
    let (quick, arguments) = paper_scene::arguments();
    let out = arguments.first().map_or_else(|| PathBuf::from("target/exact_probability"), PathBuf::from);
    paper_scene::end(run(&out, quick))
}
