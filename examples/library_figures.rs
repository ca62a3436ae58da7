//! How often the local distance misleads in a whole library: makes `reports/library_figures`.
//!
//! `cargo run --release --example library_figures -- LIBRARY.csv reports/library_figures` takes all ordered pairs
//! of a library (the report: the 54 channels that the authors of the paper publish), compares the local with the
//! nearest distance, and for some random pairs both with simulated decisions. With `--quick` it makes all
//! distances but simulates only the first of those pairs, with the same result for them.

#[path = "support/paper_scene.rs"]
mod paper_scene;

use hadar::error::Error;
use hadar::identifiability::detection;
use hadar::material::Library;
use hadar::report::bundle::Bundle;
use hadar::report::figures::Plot;
use hadar::report::plot::{Axis, LineFigure, Rule, Series, Style};
use hadar::report::table::Table;
use hadar::simulate::draws::generator;
use hadar::simulate::sequential::{Interval, Plan};
use hadar::spectrum::Bands;
use hadar::statistics::Statistics;
use paper_scene::{Distances, PaperScene, bars, markdown};
use std::path::{Path, PathBuf};

const SEED: u64 = 54;
/// Half of the 95 % interval of every simulated probability.
const HALF_WIDTH: f64 = 0.004;
/// Pairs that are simulated, and with `--quick`.
const SIMULATED: usize = 60;
const QUICK: usize = 3;
/// Off by more than this counts.
const OFF: f64 = 0.02;

struct Pair {
    names: [String; 2],
    materials: [usize; 2],
    distances: Distances,
}

impl Pair {
    fn ratio(&self) -> f64 {
        self.distances.local / self.distances.nearest
    }
}

/// A pair where √N d_nearest = 1.
struct Decided {
    names: [String; 2],
    photons: f64,
    /// √N d_local.
    local: f64,
    return_ratio: f64,
    probability: f64,
    interval: Interval,
    known: f64,
    trials: u64,
    unconverged: u64,
}

impl Decided {
    /// What the local distance calls the limit.
    fn promised(&self) -> f64 {
        detection::probability(self.local)
    }

    fn two_sided(&self) -> f64 {
        detection::two_sided_probability(1.0, self.return_ratio)
    }
}

/// A figure of the notes beside ours.
struct Figure {
    what: &'static str,
    expected: &'static str,
    found: String,
    verdict: &'static str,
}

fn all_pairs(scene: &PaperScene, library: &Library) -> hadar::Result<(Vec<Vec<f64>>, Vec<Pair>)> {
    let names: Vec<&str> = library.names().collect();
    let nodes = scene.bands.nodes_cm1();
    let materials: Vec<Vec<f64>> =
        names.iter().map(|name| library.get(name)?.emissivity(nodes)).collect::<hadar::Result<_>>()?;
    let state = scene.state(60.0, 0.5)?;
    let mut pairs = Vec::new();
    for (i, target) in materials.iter().enumerate() {
        for (j, other) in materials.iter().enumerate().filter(|(j, _)| *j != i) {
            let distances = scene.distances(target, other, &state)?;
            let names = [names[i].to_owned(), names[j].to_owned()];
            pairs.push(Pair { names, materials: [i, j], distances });
        }
    }
    Ok((materials, pairs))
}

fn decide(scene: &PaperScene, materials: &[Vec<f64>], pair: &Pair) -> hadar::Result<Decided> {
    let [target, other] = pair.materials.map(|i| materials[i].as_slice());
    let state = scene.state(60.0, 0.5)?;
    let (photons, kappa) = pair.distances.photons_at(1.0);
    let decisions = scene.decisions(kappa, &Statistics::Poisson);
    let plan = Plan::new(SEED, HALF_WIDTH, 100_000)?;
    let found = decisions.balanced((target, other), &state, &plan)?;
    let known =
        decisions.known_states((target, &state), (other, &pair.distances.nearest_state), &plan)?.probability;
    Ok(Decided {
        names: pair.names.clone(),
        photons,
        local: pair.ratio(),
        return_ratio: pair.distances.back / pair.distances.nearest,
        probability: found.probability,
        interval: found.interval,
        known,
        trials: found.classes.iter().map(|class| class.trials).sum(),
        unconverged: found.classes.iter().map(|class| class.unconverged).sum(),
    })
}

fn pairs_csv(pairs: &[Pair]) -> hadar::Result<String> {
    let mut table = Table::new([
        "target",
        "alternative",
        "local_per_sqrt_photon",
        "local_unknown_gain_per_sqrt_photon",
        "nearest_per_sqrt_photon",
        "local_over_nearest",
        "return_over_nearest",
        "nearest_state_celsius",
        "nearest_state_lighting",
    ]);
    for pair in pairs {
        let d = &pair.distances;
        table.push(vec![
            pair.names[0].clone(),
            pair.names[1].clone(),
            format!("{:.3e}", d.local),
            format!("{:.2e}", d.local_unknown_gain),
            format!("{:.3e}", d.nearest),
            format!("{:.3e}", pair.ratio()),
            format!("{:.3}", d.back / d.nearest),
            format!("{:.2}", d.nearest_state.temperature_k - 273.15),
            format!("{:.3}", d.nearest_state.lighting.first().copied().unwrap_or(0.0)),
        ]);
    }
    table.to_csv()
}

fn decisions_csv(decided: &[Decided]) -> hadar::Result<String> {
    let mut table = Table::new([
        "target",
        "alternative",
        "photons",
        "local_distance",
        "probability_local",
        "probability_two_sided_estimate",
        "probability_best_fits",
        "best_fits_low",
        "best_fits_high",
        "probability_known_states",
        "trials",
        "unconverged",
    ]);
    for one in decided {
        let p = |value: f64| format!("{value:.4}");
        table.push(vec![
            one.names[0].clone(),
            one.names[1].clone(),
            format!("{:.3e}", one.photons),
            p(one.local),
            p(one.promised()),
            p(one.two_sided()),
            p(one.probability),
            p(one.interval.low),
            p(one.interval.high),
            p(one.known),
            one.trials.to_string(),
            one.unconverged.to_string(),
        ]);
    }
    table.to_csv()
}

/// Share of the pairs with a ratio below each.
fn ratios(pairs: &[Pair]) -> Plot {
    let mut sorted: Vec<f64> = pairs.iter().map(Pair::ratio).collect();
    sorted.sort_by(f64::total_cmp);
    let share: Vec<f64> =
        (1..=sorted.len()).map(|rank| 100.0 * rank as f64 / sorted.len().max(1) as f64).collect();
    let mut table = Table::new(["local_over_nearest", "share_of_pairs_percent"]);
    sorted.iter().zip(&share).for_each(|(ratio, share)| table.push_numbers(&[*ratio, *share]));
    let below = |limit: f64| 100.0 * sorted.partition_point(|r| *r < limit) as f64 / sorted.len() as f64;
    let figure = LineFigure::new(
        "The local distance against the nearest, over a whole library",
        Axis::log("local distance over nearest distance"),
        Axis::linear("pairs with a smaller ratio (%)").range(0.0, 100.0),
    )
    .subtitle(format!(
        "{} ordered pairs, target at 60 °C and V = 0.5, surroundings at 20 °C. Below one half: {:.0} %; above \
         two: {:.0} %.",
        sorted.len(),
        below(0.5),
        100.0 - below(2.0)
    ))
    .series(Series::line("", sorted, share).colour(0))
    .rule(Rule::vertical(0.5, "too small by a factor 2"))
    .rule(Rule::vertical(1.0, "equal"))
    .rule(Rule::vertical(2.0, "too large by a factor 2"));
    Plot { name: "ratios".into(), figure: figure.into(), table }
}

/// Simulated decisions against what the local distance and the two-sided estimate say.
fn decisions(decided: &[Decided]) -> Plot {
    let mut table = Table::new([
        "probability_local",
        "probability_two_sided_estimate",
        "probability_best_fits",
        "best_fits_low",
        "best_fits_high",
    ]);
    for one in decided {
        table.push_numbers(&[
            one.promised(),
            one.two_sided(),
            one.probability,
            one.interval.low,
            one.interval.high,
        ]);
    }
    let of = |pick: fn(&Decided) -> f64| decided.iter().map(pick).collect::<Vec<f64>>();
    let (p, low, high) = (of(|d| d.probability), of(|d| d.interval.low), of(|d| d.interval.high));
    let figure = LineFigure::new(
        "Simulated decisions against what is said of them",
        Axis::linear("predicted share of right decisions").range(0.48, 1.02),
        Axis::linear("simulated share of right decisions").range(0.70, 0.88),
    )
    .subtitle(format!(
        "{} random pairs, each with the photons at which the nearest distance is 1; bars are 95 % intervals.",
        decided.len()
    ))
    .series(
        Series::line("simulated = predicted", vec![0.70, 0.88], vec![0.70, 0.88])
            .style(Style::Dashed)
            .colour(6),
    )
    .series(bars("", &of(Decided::promised), &low, &high).colour(1))
    .series(bars("", &of(Decided::two_sided), &low, &high).colour(2))
    .series(Series::points("by the local distance", of(Decided::promised), p.clone()).colour(1))
    .series(Series::points("by the two-sided estimate", of(Decided::two_sided), p).colour(2))
    .rule(Rule::horizontal(detection::probability(1.0), "limit Φ(1) of the nearest distance"));
    Plot { name: "decisions".into(), figure: figure.into(), table }
}

/// Root mean square with its 95 % interval from the scatter of the squares.
fn root_mean_square(errors: &[f64]) -> (f64, Interval) {
    let n = errors.len().max(2) as f64;
    let mean = errors.iter().map(|e| e * e).sum::<f64>() / n;
    let var = errors.iter().map(|e| (e * e - mean).powi(2)).sum::<f64>() / (n - 1.0);
    let reach = 1.96 * (var / n).sqrt();
    (mean.sqrt(), Interval { low: (mean - reach).max(0.0).sqrt(), high: (mean + reach).sqrt() })
}

fn agrees(interval: Interval, expected: f64) -> &'static str {
    let inside = (interval.low..=interval.high).contains(&expected);
    if inside { "agrees" } else { "differs by more than chance" }
}

fn share(what: &'static str, printed: &'static str, expected: f64, hits: usize, of: usize) -> Figure {
    let interval = Interval::wilson(hits as f64, of as u64, 0.95);
    Figure {
        what,
        expected: printed,
        found: format!(
            "{:.0} % (95 %: {:.0} to {:.0} %)",
            100.0 * hits as f64 / of as f64,
            100.0 * interval.low,
            100.0 * interval.high
        ),
        verdict: agrees(interval, expected),
    }
}

/// Shares over all pairs: nothing is random in them.
fn distance_figures(pairs: &[Pair]) -> Vec<Figure> {
    let count = |limit: f64| pairs.iter().filter(|p| p.ratio().max(1.0 / p.ratio()) > limit).count();
    let figure = |what, printed, expected: f64, limit: f64| {
        let found = 100.0 * count(limit) as f64 / pairs.len() as f64;
        Figure {
            what,
            expected: printed,
            found: format!("{found:.1} % ({} of {})", count(limit), pairs.len()),
            verdict: if (found - expected).abs() < 1.0 { "agrees" } else { "differs" },
        }
    };
    vec![
        figure("pairs whose local distance is off by more than a factor 2", "38 %", 38.0, 2.0),
        figure("pairs whose photon number is off by more than a factor 10", "22 %", 22.0, 10f64.sqrt()),
    ]
}

fn decision_figures(decided: &[Decided]) -> Vec<Figure> {
    let n = decided.len();
    let limit = detection::probability(1.0);
    let off =
        |pick: fn(&Decided) -> f64| -> Vec<f64> { decided.iter().map(|d| pick(d) - d.probability).collect() };
    let (local, two_sided) = (off(Decided::promised), off(Decided::two_sided));
    let count = |errors: &[f64], hit: fn(f64) -> bool| errors.iter().filter(|e| hit(**e)).count();
    let rms = |what, printed, expected: f64, errors: &[f64]| {
        let (value, interval) = root_mean_square(errors);
        Figure {
            what,
            expected: printed,
            found: format!("{value:.3} (95 %: {:.3} to {:.3})", interval.low, interval.high),
            verdict: agrees(interval, expected),
        }
    };
    let near = decided.iter().filter(|d| (d.probability - limit).abs() < OFF).count();
    let mut figures = vec![
        share("beats the local 'limit' by more than 0.02", "55 %", 0.55, count(&local, |e| e < -OFF), n),
        share("falls short of it by more than 0.02", "37 %", 0.37, count(&local, |e| e > OFF), n),
        rms("rms error of the local distance", "0.146", 0.146, &local),
    ];
    if let Some(best) = decided.iter().max_by(|a, b| a.probability.total_cmp(&b.probability)) {
        let reach = best.interval.half_width();
        let same = (best.probability - 0.8435).abs() <= reach.hypot(0.007);
        figures.push(Figure {
            what: "largest share of right decisions (limit Φ(1) = 0.8413)",
            expected: "0.8435 ± 0.007",
            found: format!("{:.4} ± {reach:.4}", best.probability),
            verdict: if same { "agrees" } else { "differs by more than chance" },
        });
    }
    figures.push(share("within 0.02 of the limit", "53 %", 0.53, near, n));
    figures.push(rms("rms error of the two-sided estimate", "0.034", 0.034, &two_sided));
    figures
}

fn figures_csv(figures: &[Figure]) -> hadar::Result<String> {
    let mut table = Table::new(["figure", "expected", "found", "verdict"]);
    for figure in figures {
        let cells = [figure.what, figure.expected, figure.found.as_str(), figure.verdict];
        table.push(cells.map(str::to_owned).to_vec());
    }
    table.to_csv()
}

fn readme(pairs: &[Pair], decided: &[Decided], figures: &[Figure]) -> String {
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
         `cargo run --release --example library_figures -- emissivity_54.csv reports/library_figures`, with the \
         table `emiLib_synthetic` of github.com/FanglinBao/HADAR (MIT licence, © 2022 FanglinBao) as a CSV file; \
         its emissivities are not part of this project. Seed {SEED} for the choice of the pairs and for the draws; \
         every probability until its 95 % interval is ± {HALF_WIDTH}; {unconverged} fits did not converge. \
         All distances are in `pairs.csv`, all simulated pairs in `simulated.csv`.\n",
        pairs.len(),
        decided.len(),
        markdown(&["figure", "expected", "found", "verdict"], &rows),
        decided.len(),
        decided.len(),
    )
}

fn run(library: &Path, out: &Path, quick: bool) -> hadar::Result<()> {
    let scene = PaperScene::new(Bands::uniform(720.0, 1250.0, 10.0)?)?;
    let mut materials = Library::empty();
    materials.add_file(library)?;
    let (spectra, pairs) = all_pairs(&scene, &materials)?;
    eprintln!("{} pairs", pairs.len());
    let mut rng = generator(SEED, 0);
    let chosen = rand::seq::index::sample(&mut rng, pairs.len(), SIMULATED.min(pairs.len()));
    let mut decided = Vec::new();
    for i in chosen.into_iter().take(if quick { QUICK } else { SIMULATED }) {
        eprintln!("{} against {}", pairs[i].names[0], pairs[i].names[1]);
        decided.push(decide(&scene, &spectra, &pairs[i])?);
    }
    let mut bundle = Bundle::default();
    bundle.add("pairs.csv", pairs_csv(&pairs)?);
    bundle.add("simulated.csv", decisions_csv(&decided)?);
    if !quick {
        let mut figures = distance_figures(&pairs);
        figures.extend(decision_figures(&decided));
        bundle.add("figures.csv", figures_csv(&figures)?);
        bundle.add("README.md", readme(&pairs, &decided, &figures));
        bundle.add_plots(&[ratios(&pairs), decisions(&decided)])?;
    }
    bundle.write(out)?;
    eprintln!("wrote {}", out.display());
    Ok(())
}

fn main() -> std::process::ExitCode {
    let (quick, arguments) = paper_scene::arguments();
    let [library, out] = arguments.as_slice() else {
        let usage = Error::malformed("two paths are needed", "library_figures [--quick] LIBRARY.csv FOLDER");
        return paper_scene::end(Err(usage));
    };
    paper_scene::end(run(&PathBuf::from(library), &PathBuf::from(out), quick))
}
