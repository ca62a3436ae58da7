//! The report's text.

use super::decided::{HALF_WIDTH, Line, MISLEADS};
use super::three_bands::LatticeLine;
use crate::reproduce::studies::page::{markdown, root_mean_square};

fn row(line: &Line) -> Vec<String> {
    let p = |value: f64| format!("{value:.3}");
    vec![
        line.names[0].into(),
        line.names[1].into(),
        format!("{}", line.celsius),
        format!("{:.1e}", line.photons),
        format!("{:.2}", line.local),
        p(line.promised()),
        p(line.limit()),
        p(line.two_sided()),
        line.fitted.print(),
        line.known.print(),
        format!("{:.3} to {:.3}", line.bracket[0], line.bracket[1]),
        line.verdict().into(),
    ]
}

const HEADER: [&str; 12] = [
    "target",
    "alternative",
    "target (°C)",
    "photons N",
    "√N·d_local",
    "Φ(√N·d_local)",
    "limit Φ(√N·d_nearest)",
    "two-sided estimate",
    "test of best fits",
    "known states",
    "bracket",
    "verdict",
];

/// How the local distance and the two-sided estimate fare.
pub(super) fn finding(lines: &[Line]) -> String {
    let count = |verdict: &str| lines.iter().filter(|l| l.verdict().ends_with(verdict)).count();
    let error = |predicted: fn(&Line) -> f64| {
        root_mean_square(&lines.iter().map(|l| predicted(l) - l.fitted.value).collect::<Vec<_>>()).0
    };
    format!(
        "Of {} comparisons the local distance is too optimistic in {}, too pessimistic in {}, and agrees in {}. Its rms \
         error is {:.2}; that of the two-sided estimate {:.3}.",
        lines.len(),
        count("optimistic"),
        count("pessimistic"),
        count("agrees"),
        error(Line::promised),
        error(Line::two_sided)
    )
}

/// Those with √N·d_nearest at a level.
fn at(lines: &[Line], level: f64) -> impl Iterator<Item = &Line> {
    lines.iter().filter(move |l| (l.nearest - level).abs() < 1e-3)
}

/// Rows of fewer photons and more.
fn fewer_and_more(lines: &[Line]) -> Vec<Vec<String>> {
    at(lines, 0.5)
        .zip(at(lines, 2.0))
        .map(|pair| {
            let (few, _) = pair;
            let mut cells = vec![few.names[0].into(), few.names[1].into(), format!("{}", few.celsius)];
            for line in [pair.0, pair.1] {
                cells.extend([line.promised(), line.two_sided()].map(|p| format!("{p:.3}")));
                cells.push(line.fitted.print());
            }
            cells
        })
        .collect()
}

/// Rows of three bands.
fn by_lattice(lattice: &[LatticeLine]) -> Vec<Vec<String>> {
    lattice
        .iter()
        .map(|l| {
            let p = |value: f64| format!("{value:.3}");
            vec![
                l.names[0].into(),
                l.names[1].into(),
                format!("{:.0}", l.photons),
                p(l.promised),
                p(l.lattice[0]),
                l.classes[0].print(),
                p(l.lattice[1]),
                l.classes[1].print(),
                p(0.5 * (l.lattice[0] + l.lattice[1])),
                l.mean.print(),
                p(l.mesh_change),
            ]
        })
        .collect()
}

/// Rows of other laws of counting.
fn by_law(laws: &[Line]) -> Vec<Vec<String>> {
    laws.iter()
        .map(|l| {
            let mut cells = row(l);
            cells.insert(3, l.law.replace('-', " "));
            cells
        })
        .collect()
}

/// README.md.
pub(super) fn readme(lines: &[Line], lattice: &[LatticeLine], laws: &[Line], seed: u64) -> String {
    let (total, finding) = (lines.len(), finding(lines));
    let above = lines.iter().filter(|l| l.fitted.low > l.limit()).count();
    let outside = lines.iter().filter(|l| l.known.high < l.bracket[0] || l.known.low > l.bracket[1]).count();
    let lattice_off = lattice
        .iter()
        .map(|l| (0.5 * (l.lattice[0] + l.lattice[1]) - l.mean.value).abs())
        .fold(0.0, f64::max);
    let mut law_header = HEADER.to_vec();
    law_header.insert(3, "law of counting");
    format!(
        "# What a test achieves, beside what the distances promise\n\n\
         A camera must tell a target from an alternative, and knows neither temperature nor lighting of \
         either. How often can it be right? Pairs of the built-in library, 54 bands (720 to 1250 cm⁻¹, step \
         10), surroundings at 20 °C, lighting V = 0.5, states of any material between 250 and 450 K and V \
         between 0 and 1, photon (Poisson) noise. Every pair is looked at with the number of photons at which \
         the nearest distance gives √N·d_nearest = 1, and with those for 0.5 and 2.\n\n\
         * Φ(√N·d_local): what the paper's local distance (S27) promises. With an unknown gain (S29) it is in \
         `pairs.csv`.\n\
         * Limit Φ(√N·d_nearest): for many photons no test is right more often, averaged over the target's \
         state and the nearest state of the alternative.\n\
         * Two-sided estimate: from d_nearest and the distance back; no bound.\n\
         * Test of best fits: the state of both materials is fitted to the counts, the larger likelihood wins. \
         Simulated. This is what a user gets.\n\
         * Known states: the same without anything to fit, the best test there is between the two states. \
         Simulated.\n\
         * Bracket: rigorous limits for 'known states', at any number of photons. Its upper end limits every \
         test.\n\n\
         The verdict compares Φ(√N·d_local) with the test of best fits: it misleads where it is off by more \
         than {MISLEADS}.\n\n\
         ## √N·d_nearest = 1\n\n{}\n\
         ![Simulated decisions against the distances](against_distances.png)\n\n\
         ## Fewer photons and more: √N·d_nearest = 0.5 and 2\n\n{}\n\
         ![Simulated decisions against estimates](against_estimates.png)\n\n\
         ## What it shows\n\n\
         {finding} The test of best fits is \
         above the limit, beyond its 95 % interval, in {above} of {total} (by chance alone: about one in forty \
         of those that reach the limit). The simulated test of known states is outside the bracket in \
         {outside}. The pairs were picked to show both kinds of error; how common they are in a library is in \
         `../library_figures`.\n\n\
         ## Three bands: Algorithm 1\n\n\
         Three wide bands (720 to 895, 895 to 1070, 1070 to 1250 cm⁻¹), target at 60 °C, √N·d_nearest = 1. The \
         lattice sums the probabilities of all counts (Algorithm 1 of the paper; 257 temperatures in 250 to 450 \
         K, 129 lightings in 0 to 1 for each material); 'drawn' is the Monte Carlo with states fitted \
         continuously. 'Mesh' is the largest change from a mesh twice as coarse.\n\n{}\n\
         The means differ by {lattice_off:.3} at most. One class alone may lie above or below the limit Φ(1) = 0.841: \
         only the mean of both is limited.\n\n\
         ## Other laws of counting\n\n\
         Gaussian: electronic noise of variance σ² equal to the photons of each band (γ = 1). Negative \
         binomial: bunched light of 0.5 photons per mode, far more than thermal light of this scene has (some \
         0.03). Photons for √N·d_nearest = 1 by the noise of the law.\n\n{}\n\
         With bunched light the nearest distance takes the variance of the target for both states, which is an \
         approximation; the bracket uses the exact law.\n\n\
         ## How it was made\n\n\
         `hadar reproduce exact-probability --out reports`. Seed {seed}; every \
         simulation runs until its 95 % interval is ± {HALF_WIDTH} (of one class alone it is wider); all start from the same seed, so \
         that their errors may go together. Everything is \
         in `pairs.csv`, `three_bands.csv` and `other_laws.csv`.\n",
        markdown(&HEADER, &at(lines, 1.0).map(row).collect::<Vec<_>>()),
        markdown(
            &[
                "target",
                "alternative",
                "target (°C)",
                "0.5: Φ(√N·d_local)",
                "two-sided estimate",
                "test of best fits",
                "2: Φ(√N·d_local)",
                "two-sided estimate",
                "test of best fits",
            ],
            &fewer_and_more(lines)
        ),
        markdown(
            &[
                "target",
                "alternative",
                "photons N",
                "Φ(√N·d_local)",
                "lattice, target true",
                "drawn",
                "lattice, alternative true",
                "drawn",
                "lattice, mean",
                "drawn",
                "mesh"
            ],
            &by_lattice(lattice)
        ),
        markdown(&law_header, &by_law(laws)),
    )
}
