//! What a test achieves, beside what the distances promise: makes `reports/exact_probability`.
//!
//! `cargo run --release --example exact_probability -- reports/exact_probability` takes pairs of the built-in
//! library in the scene of the paper and sets the local and the nearest distance, the two-sided estimate, the
//! rigorous bracket, Algorithm 1 of the paper (three bands) and Monte Carlo decisions side by side. With `--quick`
//! only the tables of the first pairs are made, with the same numbers.

#[path = "support/paper_scene.rs"]
mod paper_scene;

use hadar::fisher::{Counting, Unknowns};
use hadar::identifiability::bracket::KnownStates;
use hadar::identifiability::detection;
use hadar::identifiability::lattice::{LatticeDetector, LatticeMesh};
use hadar::identifiability::local::LocalSolver;
use hadar::identifiability::nearest::NearestSolver;
use hadar::material::Library;
use hadar::report::bundle::Bundle;
use hadar::report::figures::Plot;
use hadar::report::plot::{Axis, LineFigure, Series, Style};
use hadar::report::table::Table;
use hadar::scene::State;
use hadar::simulate::sequential::Plan;
use hadar::spectrum::Bands;
use hadar::statistics::Statistics;
use paper_scene::{PaperScene, bars, markdown};
use std::path::{Path, PathBuf};

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

/// A probability with the ends of its interval.
#[derive(Clone, Copy)]
struct Estimate {
    value: f64,
    low: f64,
    high: f64,
}

impl Estimate {
    fn print(self) -> String {
        format!("{:.3} ± {:.3}", self.value, 0.5 * (self.high - self.low))
    }
}

/// A pair at one photon number.
struct Line {
    names: [&'static str; 2],
    celsius: f64,
    law: &'static str,
    photons: f64,
    /// √N times local, local with unknown gain (none with other laws), nearest.
    local: f64,
    unknown_gain: f64,
    nearest: f64,
    return_ratio: f64,
    nearest_state: State,
    /// The test of best fits, averaged over the two states, and for each of them.
    fitted: Estimate,
    classes: [f64; 2],
    known: Estimate,
    /// Rigorous limits of the best test between the two states.
    bracket: [f64; 2],
}

impl Line {
    fn promised(&self) -> f64 {
        detection::probability(self.local)
    }

    fn limit(&self) -> f64 {
        detection::probability(self.nearest)
    }

    fn two_sided(&self) -> f64 {
        detection::two_sided_probability(self.nearest, self.return_ratio)
    }

    fn verdict(&self) -> &'static str {
        let off = self.promised() - self.fitted.value;
        if off > MISLEADS {
            "local misleads: too optimistic"
        } else if off < -MISLEADS {
            "local misleads: too pessimistic"
        } else {
            "local agrees"
        }
    }
}

struct Materials {
    library: Library,
    scene: PaperScene,
}

impl Materials {
    fn new(scene: PaperScene) -> hadar::Result<Self> {
        Ok(Self { library: Library::embedded()?, scene })
    }

    fn emissivity(&self, name: &str) -> hadar::Result<Vec<f64>> {
        self.library.get(name)?.emissivity(self.scene.bands.nodes_cm1())
    }
}

/// A law of counting whose excess over Poisson is a fixed share of each band of the target.
fn statistics(law: &str, means: &[f64]) -> hadar::Result<Statistics> {
    match law {
        "gaussian" => Statistics::gaussian(means.to_vec()),
        "negative-binomial" => Statistics::negative_binomial(means.iter().map(|n| 2.0 * n).collect()),
        _ => Ok(Statistics::Poisson),
    }
}

/// Everything about a pair where √N d_nearest is `level`, d_nearest by the noise of the law.
fn line(
    all: &Materials,
    (a, b, celsius): (&'static str, &'static str, f64),
    law: &'static str,
    level: f64,
) -> hadar::Result<Line> {
    let scene = &all.scene;
    let (target, other) = (all.emissivity(a)?, all.emissivity(b)?);
    let state = scene.state(celsius, 0.5)?;
    let poisson = scene.distances(&target, &other, &state)?;
    let signal = scene.signal(&target, &state);
    let counted = |kappa: f64| -> hadar::Result<(Statistics, Counting)> {
        let means: Vec<f64> = signal.iter().map(|s| kappa * s).collect();
        let statistics = statistics(law, &means)?;
        let excess = means.iter().enumerate().map(|(w, &n)| statistics.variance(w, n) - n).collect();
        Ok((statistics, Counting { counts_per_radiance: kappa, var_electronic: excess }))
    };
    let solver =
        || NearestSolver::new(&scene.bands, &scene.surroundings, scene.unknowns.clone(), scene.range);
    // All noise grows with the photons as shot noise does, so that d goes with √N.
    let (_, one) = counted(1.0 / poisson.photon_radiance)?;
    let photons = (level / solver().with_counting(&target, &other, &state, &one)?.distance).powi(2);
    let kappa = photons / poisson.photon_radiance;
    let (statistics, counting) = counted(kappa)?;
    let nearest = solver().with_counting(&target, &other, &state, &counting)?;
    let back = solver().with_counting(&other, &target, &nearest.state, &counting)?.distance;
    let local = |unknowns: Unknowns| {
        LocalSolver::new(&scene.bands, &scene.surroundings, unknowns)
            .with_counting(&target, &other, &state, &counting)
            .map(|found| found.distance)
    };
    let decisions = scene.decisions(kappa, &statistics);
    let plan = Plan::new(SEED, HALF_WIDTH, 100_000)?;
    let fitted = decisions.balanced((&target, &other), &state, &plan)?;
    let known = decisions.known_states((&target, &state), (&other, &nearest.state), &plan)?;
    let means = |emissivity: &[f64], state: &State| -> Vec<f64> {
        scene.signal(emissivity, state).iter().map(|s| kappa * s).collect()
    };
    let bracket =
        KnownStates::new(&means(&target, &state), &means(&other, &nearest.state), &statistics)?.bracket();
    Ok(Line {
        names: [a, b],
        celsius,
        law,
        photons,
        local: local(scene.unknowns.clone())?,
        unknown_gain: photons.sqrt() * poisson.local_unknown_gain,
        nearest: nearest.distance,
        return_ratio: back / nearest.distance,
        nearest_state: nearest.state,
        fitted: Estimate { value: fitted.probability, low: fitted.interval.low, high: fitted.interval.high },
        classes: [fitted.classes[0].probability, fitted.classes[1].probability],
        known: Estimate { value: known.probability, low: known.interval.low, high: known.interval.high },
        bracket: [1.0 - bracket.upper, 1.0 - bracket.lower],
    })
}

/// Algorithm 1 and Monte Carlo for one pair in three bands.
struct LatticeLine {
    names: [&'static str; 2],
    photons: f64,
    promised: f64,
    lattice: [f64; 2],
    mesh_change: f64,
    classes: [Estimate; 2],
    mean: Estimate,
}

fn lattice_line(all: &Materials, names: [&'static str; 2]) -> hadar::Result<LatticeLine> {
    let scene = &all.scene;
    let library = [all.emissivity(names[0])?, all.emissivity(names[1])?];
    let state = scene.state(60.0, 0.5)?;
    let distances = scene.distances(&library[0], &library[1], &state)?;
    let (photons, kappa) = distances.photons_at(1.0);
    let law = Statistics::Poisson;
    let mesh = LatticeMesh { temperatures: 129, lightings: 65, ..LatticeMesh::default() };
    let detector = LatticeDetector::new(
        &scene.bands,
        &scene.surroundings,
        scene.unknowns.clone(),
        scene.range,
        law.clone(),
    )?
    .with_mesh(mesh)?;
    let nearest = &distances.nearest_state;
    let theirs: f64 = scene.signal(&library[1], nearest).iter().map(|s| kappa * s).sum();
    let first = detector.detect(&library, 0, &state, photons)?;
    let second = detector.detect(&library, 1, nearest, theirs)?;
    let plan = Plan::new(SEED, HALF_WIDTH, 100_000)?;
    let drawn = scene.decisions(kappa, &law).balanced((&library[0], &library[1]), &state, &plan)?;
    let classes = [0, 1].map(|i| {
        let class = &drawn.classes[i];
        Estimate { value: class.probability, low: class.interval.low, high: class.interval.high }
    });
    Ok(LatticeLine {
        names,
        photons,
        promised: detection::probability(photons.sqrt() * distances.local),
        lattice: [first.probabilities[0], second.probabilities[1]],
        mesh_change: first.mesh_change.max(second.mesh_change),
        classes,
        mean: Estimate { value: drawn.probability, low: drawn.interval.low, high: drawn.interval.high },
    })
}

fn csv(lines: &[Line]) -> hadar::Result<String> {
    let mut table = Table::new([
        "target",
        "alternative",
        "target_celsius",
        "statistics",
        "photons",
        "local_distance",
        "local_distance_unknown_gain",
        "nearest_distance",
        "return_ratio",
        "nearest_state_celsius",
        "nearest_state_lighting",
        "probability_local",
        "probability_limit_nearest",
        "probability_two_sided_estimate",
        "probability_best_fits",
        "best_fits_low",
        "best_fits_high",
        "best_fits_target_true",
        "best_fits_alternative_true",
        "probability_known_states",
        "known_states_low",
        "known_states_high",
        "bracket_low",
        "bracket_high",
        "verdict",
    ]);
    for line in lines {
        let p = |value: f64| format!("{value:.4}");
        let lighting = line.nearest_state.lighting.first().copied().unwrap_or(0.0);
        table.push(vec![
            line.names[0].into(),
            line.names[1].into(),
            format!("{}", line.celsius),
            line.law.into(),
            format!("{:.3e}", line.photons),
            p(line.local),
            if line.law == "poisson" { p(line.unknown_gain) } else { String::new() },
            p(line.nearest),
            p(line.return_ratio),
            format!("{:.2}", line.nearest_state.temperature_k - 273.15),
            format!("{lighting:.3}"),
            p(line.promised()),
            p(line.limit()),
            p(line.two_sided()),
            p(line.fitted.value),
            p(line.fitted.low),
            p(line.fitted.high),
            p(line.classes[0]),
            p(line.classes[1]),
            p(line.known.value),
            p(line.known.low),
            p(line.known.high),
            p(line.bracket[0]),
            p(line.bracket[1]),
            line.verdict().into(),
        ]);
    }
    table.to_csv()
}

fn lattice_csv(lines: &[LatticeLine]) -> hadar::Result<String> {
    let mut table = Table::new([
        "target",
        "alternative",
        "photons",
        "probability_local",
        "lattice_target_true",
        "lattice_alternative_true",
        "lattice_mean",
        "lattice_mesh_change",
        "drawn_target_true",
        "drawn_alternative_true",
        "drawn_mean",
        "drawn_mean_low",
        "drawn_mean_high",
    ]);
    for line in lines {
        let p = |value: f64| format!("{value:.4}");
        table.push(vec![
            line.names[0].into(),
            line.names[1].into(),
            format!("{:.0}", line.photons),
            p(line.promised),
            p(line.lattice[0]),
            p(line.lattice[1]),
            p(0.5 * (line.lattice[0] + line.lattice[1])),
            p(line.mesh_change),
            p(line.classes[0].value),
            p(line.classes[1].value),
            p(line.mean.value),
            p(line.mean.low),
            p(line.mean.high),
        ]);
    }
    table.to_csv()
}

/// What the test of best fits achieves against the distances.
fn against_distances(lines: &[Line]) -> Plot {
    let mut table = Table::new([
        "local_distance",
        "nearest_distance",
        "probability_best_fits",
        "best_fits_low",
        "best_fits_high",
    ]);
    for line in lines {
        table.push_numbers(&[line.local, line.nearest, line.fitted.value, line.fitted.low, line.fitted.high]);
    }
    let of = |pick: fn(&Line) -> f64| lines.iter().map(pick).collect::<Vec<f64>>();
    let (p, low, high) = (of(|l| l.fitted.value), of(|l| l.fitted.low), of(|l| l.fitted.high));
    let curve: Vec<f64> = (0..=200).map(|i| 10f64.powf(-2.0 + 3.5 * f64::from(i) / 200.0)).collect();
    let phi = curve.iter().map(|&d| detection::probability(d)).collect();
    let figure = LineFigure::new(
        "What a test achieves, against what the distances promise",
        Axis::log("statistical distance √N·d₀").range(0.01, 30.0),
        Axis::linear("right decisions").range(0.45, 1.02),
    )
    .subtitle(
        "Every pair twice: at its nearest and at its local distance. Test of best fits, temperature and \
         lighting unknown; bars are 95 % intervals.",
    )
    .series(Series::line("Φ(√N·d₀)", curve, phi).colour(6))
    .series(bars("", &of(|l| l.local), &low, &high).colour(1))
    .series(bars("", &of(|l| l.nearest), &low, &high).colour(0))
    .series(Series::points("at the local distance", of(|l| l.local), p.clone()).colour(1))
    .series(Series::points("at the nearest distance", of(|l| l.nearest), p).colour(0));
    Plot { name: "against_distances", figure: figure.into(), table }
}

/// What the test achieves against the estimates of it.
fn against_estimates(lines: &[Line]) -> Plot {
    let mut table = Table::new([
        "probability_local",
        "probability_limit_nearest",
        "probability_two_sided_estimate",
        "probability_best_fits",
        "best_fits_low",
        "best_fits_high",
    ]);
    for line in lines {
        let Estimate { value, low, high } = line.fitted;
        table.push_numbers(&[line.promised(), line.limit(), line.two_sided(), value, low, high]);
    }
    let of = |pick: fn(&Line) -> f64| lines.iter().map(pick).collect::<Vec<f64>>();
    let (p, low, high) = (of(|l| l.fitted.value), of(|l| l.fitted.low), of(|l| l.fitted.high));
    let figure = LineFigure::new(
        "The two-sided estimate follows the test, the local distance does not",
        Axis::linear("predicted share of right decisions").range(0.48, 1.02),
        Axis::linear("simulated share of right decisions").range(0.48, 1.02),
    )
    .subtitle("All pairs at nearest distances √N·d₀ of 0.5, 1 and 2; bars are 95 % intervals.")
    .series(
        Series::line("simulated = predicted", vec![0.5, 1.0], vec![0.5, 1.0]).style(Style::Dashed).colour(6),
    )
    .series(bars("", &of(Line::promised), &low, &high).colour(1))
    .series(bars("", &of(Line::two_sided), &low, &high).colour(2))
    .series(Series::points("local distance", of(Line::promised), p.clone()).colour(1))
    .series(Series::points("two-sided estimate", of(Line::two_sided), p).colour(2));
    Plot { name: "against_estimates", figure: figure.into(), table }
}

fn root_mean_square(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = values.clone().count().max(1) as f64;
    (values.map(|v| v * v).sum::<f64>() / count).sqrt()
}

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

fn readme(lines: &[Line], lattice: &[LatticeLine], laws: &[Line]) -> String {
    let at = |level: f64| lines.iter().filter(move |l| (l.nearest - level).abs() < 1e-3);
    let fewer_and_more: Vec<Vec<String>> = at(0.5)
        .zip(at(2.0))
        .map(|pair| {
            let (few, _) = pair;
            let mut cells = vec![few.names[0].into(), few.names[1].into(), format!("{}", few.celsius)];
            for line in [pair.0, pair.1] {
                cells.extend([line.promised(), line.two_sided()].map(|p| format!("{p:.3}")));
                cells.push(line.fitted.print());
            }
            cells
        })
        .collect();
    let count = |verdict: &str| lines.iter().filter(|l| l.verdict().ends_with(verdict)).count();
    let total = lines.len();
    let local = root_mean_square(lines.iter().map(|l| l.promised() - l.fitted.value));
    let two_sided = root_mean_square(lines.iter().map(|l| l.two_sided() - l.fitted.value));
    let above = lines.iter().filter(|l| l.fitted.low > l.limit()).count();
    let outside = lines.iter().filter(|l| l.known.high < l.bracket[0] || l.known.low > l.bracket[1]).count();
    let by_lattice: Vec<Vec<String>> = lattice
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
        .collect();
    let lattice_off = lattice
        .iter()
        .map(|l| (0.5 * (l.lattice[0] + l.lattice[1]) - l.mean.value).abs())
        .fold(0.0, f64::max);
    let by_law: Vec<Vec<String>> = laws
        .iter()
        .map(|l| {
            let mut cells = row(l);
            cells.insert(3, l.law.replace('-', " "));
            cells
        })
        .collect();
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
         Of {total} comparisons the local distance is too optimistic in {}, too pessimistic in {}, and agrees in \
         {}. Its rms error is {local:.2}; that of the two-sided estimate {two_sided:.3}. The test of best fits is \
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
         `cargo run --release --example exact_probability -- reports/exact_probability`. Seed {SEED}; every \
         simulation runs until its 95 % interval is ± {HALF_WIDTH} (of one class alone it is wider); all start from the same seed, so \
         that their errors may go together. Everything is \
         in `pairs.csv`, `three_bands.csv` and `other_laws.csv`.\n",
        markdown(&HEADER, &at(1.0).map(row).collect::<Vec<_>>()),
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
            &fewer_and_more
        ),
        count("optimistic"),
        count("pessimistic"),
        count("agrees"),
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
            &by_lattice
        ),
        markdown(&law_header, &by_law),
    )
}

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
    bundle.add("pairs.csv", csv(&lines)?);
    bundle.add("three_bands.csv", lattice_csv(&lattice)?);
    bundle.add("other_laws.csv", csv(&laws)?);
    if !quick {
        bundle.add("README.md", readme(&lines, &lattice, &laws));
        bundle.add_plots(&[against_distances(&lines), against_estimates(&lines)])?;
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
