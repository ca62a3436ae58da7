//! The report's text.

use super::figures::Figure;
use super::pairs::{Decided, Pair};
use crate::reproduce::studies::page::markdown;
use hadar::identifiability::detection;

/// Every figure in a line.
pub(super) fn findings(figures: &[Figure]) -> String {
    let line = |f: &Figure| format!("{}: {} (expected {}: {})", f.what, f.found, f.expected, f.verdict);
    figures.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// README.md.
pub(super) fn readme(
    pairs: &[Pair],
    decided: &[Decided],
    figures: &[Figure],
    (seed, half_width): (u64, f64),
) -> String {
    let rows: Vec<Vec<&str>> =
        figures.iter().map(|f| vec![f.what, f.expected, f.found.as_str(), f.verdict]).collect();
    let limit = detection::probability(1.0);
    let above = decided.iter().filter(|d| d.interval.low > limit).count();
    let unconverged: u64 = decided.iter().map(|d| d.unconverged).sum();
    let small = pairs.iter().filter(|p| p.ratio() < 0.5).count();
    let large = pairs.iter().filter(|p| p.ratio() > 2.0).count();
    format!(
        "# How often does the local distance mislead?\n\n\
         The paper calls its local distance the limit of telling two materials apart. It is the tangent at the \
         target's own state; the alternative may be in any other. Here both are compared over the whole \
         library of the paper's authors (28 materials, 54 channels, 720 to 1250 cm⁻¹): all {} ordered pairs, \
         target at 60 °C, lighting V = 0.5, surroundings at 20 °C; the alternative between 250 and 450 K, V \
         between 0 and 1; temperature and lighting unknown, photon noise only. For {} of the pairs, drawn at \
         random, decisions were simulated with the number of photons at which the nearest distance is 1.\n\n\
         {}\n\
         'Expected' is an independent calculation made before, with another choice of random pairs. 'Beats' and \
         'falls short' are about a likelihood-ratio test of best fits, averaged over the target's state and \
         the nearest state of the alternative. The intervals of the shares are those of {} pairs out of all; for \
         the first two lines every pair was counted.\n\n\
         ![Share of the pairs against the ratio of the distances](ratios.png)\n\n\
         ![Simulated decisions against predictions](decisions.png)\n\n\
         ## What it shows\n\n\
         The local distance errs both ways: less than half of the nearest in {small} pairs, more than twice in \
         {large}. A test beats what it calls the limit in about half of the pairs, which a limit does not allow. \
         The nearest distance holds: {above} of {} simulated pairs are above Φ(1) beyond their 95 % interval (by \
         chance about one in forty of those at the limit). A test that must fit temperature and lighting often \
         stays below; the two-sided estimate tells by how much.\n\n\
         ## How it was made\n\n\
         `hadar reproduce library-figures --library emissivity_54.csv --out reports`, with the \
         table `emiLib_synthetic` of github.com/FanglinBao/HADAR (MIT licence, © 2022 FanglinBao) as a CSV file; \
         its emissivities are not part of this project. Seed {seed} for the choice of the pairs and for the draws; \
         every probability until its 95 % interval is ± {half_width}; {unconverged} fits did not converge. \
         All distances are in `pairs.csv`, all simulated pairs in `simulated.csv`.\n",
        pairs.len(),
        decided.len(),
        markdown(&["figure", "expected", "found", "verdict"], &rows),
        decided.len(),
        decided.len(),
    )
}
