//! Extended Data Fig. 6: which of five materials can be told apart.

use super::ledger::{Line, Verdict};
use super::order::{Figures, Made, Order, Progress};
use super::scene;
use hadar::demand::Skipping;
use hadar::error::Result;
use hadar_report::identify;
use hadar_scenario::examples;
use hadar_simulate::sequential::Plan;
use hadar_study::{Answers, Asked, Trial, Watch};

/// Half width of the simulated decisions' intervals, and most trials.
const HALF_WIDTH: f64 = 0.005;
const TRIALS: u64 = 1_000_000;

pub(super) fn make(order: Order, progress: Progress<'_>) -> Result<Made> {
    let study = scene::study(examples::FIVE_MATERIALS)?;
    let asked = Asked {
        matrix: true,
        apart: false,
        skipping: Skipping::On,
        scaling: true,
        bands: Some((Some(6), Some(5))),
        exact: Some(Trial { law: None, photons: None, plan: Plan::new(order.seed, HALF_WIDTH, TRIALS)? }),
        average: false,
    };
    let answers = study.answer(&asked, &Watch { simulated: progress, ..Watch::NONE })?;
    let answer = identify::text(&answers, &study);
    let mut bundle = identify::bundle(&study, &answers, order.seed)?;
    let lines = lines(&answers);
    let text = format!(
        "`hadar identify examples/five_materials.toml --matrix --scaling --bands 6 --filters 5 --exact --half-width \
         {HALF_WIDTH}` prints:\n\n```text\n{answer}```\n"
    );
    bundle.add("answer.txt", answer);
    let pictures = vec![
        ("sample_spectra.png", "One reading of each material"),
        ("minimum_distances.png", "Least distance of each material"),
        ("distance_matrix.png", "All against all"),
        ("bands_that_matter.png", "Which bands matter"),
        ("band_number.png", "Number of bands"),
        ("library_size.png", "Size of the library"),
    ];
    Ok((bundle, lines, Figures { pictures, text }))
}

fn lines(answers: &Answers) -> Vec<Line> {
    let targets = answers.matrix.iter().flat_map(|matrix| &matrix.targets);
    let targets: Vec<_> = targets.collect();
    let place = "Ext. Data Fig. 6b";
    // d grows with the root of the exposure, 1 us here: from when on and up to when the verdicts are the paper's.
    let of = |name: &str| {
        let found = targets.iter().find(|target| target.material == name);
        found.and_then(|target| target.statistical_distance_minimum).map_or(f64::NAN, |d| d.powi(-2))
    };
    let (from, to) = (of("fused-silica").max(of("pmma")), of("aluminium").min(of("skin")));
    let window = format!(
        "the paper prints neither spectra nor exposure; with the built-in spectra all four verdicts are the paper's from \
         {from:.2} to {to:.1} us of exposure, of which 1 us was chosen"
    );
    [
        ("silica", "fused-silica", "yes"),
        ("paint", "pmma", "yes"),
        ("aluminium", "aluminium", "no"),
        ("human skin", "skin", "no"),
        ("a fifth material", "concrete", "not legible"),
    ]
    .into_iter()
    .filter_map(|(paper_name, name, paper)| {
        let target = targets.iter().find(|target| target.material == name)?;
        let ours = if target.identifiable? { "yes" } else { "no" };
        let distance = target.statistical_distance_minimum?;
        let (verdict, why) = match paper {
            "not legible" => (Verdict::NoValuePrinted, "its name is not in the text"),
            same if same == ours => (Verdict::UnderAChoice, window.as_str()),
            _ => (Verdict::NotReproduced, "spectra of the built-in library"),
        };
        let quantity = format!("{paper_name} ({name}) identifiable");
        Some(Line::new(place, quantity, paper, format!("{ours}, least d = {distance:.2}"), verdict, why))
    })
    .collect()
}
