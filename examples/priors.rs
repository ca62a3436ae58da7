//! What priors do: makes `reports/priors`.
//!
//! `cargo run --release --example priors -- reports/priors` takes skin against aluminium around thermal
//! equilibrium, where without a prior no number of photons suffices, with a prior on the temperature; and the
//! nearest distance for ever narrower ranges of the alternative's state. With `--quick` only these and the first
//! widths of the prior are made, with the same numbers.

#[path = "support/paper_scene.rs"]
mod paper_scene;

use hadar::fisher::Nuisance;
use hadar::identifiability::bayes::{BayesianBound, Distances, Pair};
use hadar::identifiability::detection;
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::material::Library;
use hadar::report::bundle::Bundle;
use hadar::report::figures::Plot;
use hadar::report::plot::{Axis, LineFigure, Rule, Series, Style};
use hadar::report::table::Table;
use hadar::scenario::Scenario;
use hadar::simulate::sequential::Plan;
use hadar::spectrum::Bands;
use hadar::statistics::Statistics;
use hadar::study::Study;
use paper_scene::{PaperScene, markdown};
use rayon::prelude::*;
use std::path::{Path, PathBuf};

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

/// Deviation of the prior of the curves, K.
const PRIOR_K: f64 = 2.0;
const SEED: u64 = 37;
const AMBIENT_CELSIUS: f64 = 20.0;

/// Photons for a statistical distance of 1, by every reading; none where no number suffices.
#[derive(Clone, Copy)]
struct Photons {
    nearest: Option<f64>,
    local: Option<f64>,
    bound: Option<f64>,
    average_nearest: Option<f64>,
    average_local: Option<f64>,
}

impl Photons {
    fn all(&self) -> [Option<f64>; 5] {
        [self.nearest, self.local, self.bound, self.average_nearest, self.average_local]
    }
}

struct Task {
    scene: PaperScene,
    skin: Vec<f64>,
    aluminium: Vec<f64>,
}

impl Task {
    fn new() -> hadar::Result<Self> {
        let library = Library::embedded()?;
        let mut scene = PaperScene::new(Bands::uniform(715.0, 1250.0, 1.0)?)?;
        scene.range = StateRange::default();
        let nodes = scene.bands.nodes_cm1();
        let skin = library.get("skin")?.emissivity(nodes)?;
        let aluminium = library.get("aluminium")?.emissivity(nodes)?;
        Ok(Self { scene, skin, aluminium })
    }

    fn photons(&self, celsius: f64, lighting: f64, prior_k: f64) -> hadar::Result<Photons> {
        let scene = &self.scene;
        let state = scene.state(celsius, lighting)?;
        let plain = scene.distances(&self.skin, &self.aluminium, &state)?;
        // Distances below this are rounding.
        let required = |distance: f64| (distance > 1e-12).then(|| distance.powi(-2));
        let unknowns = scene.unknowns.clone().prior(Nuisance::Temperature, prior_k)?;
        let bayes = BayesianBound::new(&scene.bands, &scene.surroundings, unknowns);
        let pair = Pair { emissivity: &self.skin, alternative: &self.aluminium, state: &state };
        let average = |distances| bayes.photons_for_average(pair, detection::probability(1.0), distances);
        Ok(Photons {
            nearest: required(plain.nearest),
            local: required(plain.local),
            bound: bayes.photons_required(pair, 1.0)?,
            average_nearest: average(Distances::Nearest(scene.range))?,
            average_local: average(Distances::Local)?,
        })
    }
}

impl Task {
    /// Share of right decisions with `photons` photons from a target at just this temperature, 95 % within ± 0.006.
    fn simulated(&self, celsius: f64, lighting: f64, photons: f64) -> hadar::Result<f64> {
        let scene = PaperScene {
            unknowns: self.scene.unknowns.clone().prior(Nuisance::Temperature, PRIOR_K)?,
            ..self.scene.clone()
        };
        let state = scene.state(celsius, lighting)?;
        let kappa = photons / scene.signal(&self.skin, &state).iter().sum::<f64>();
        let plan = Plan::new(SEED, 0.006, 100_000)?;
        let found = scene.decisions(kappa, &Statistics::Poisson).balanced(
            (&self.skin, &self.aluminium),
            &state,
            &plan,
        )?;
        Ok(found.probability)
    }
}

const HEADER: [&str; 5] = [
    "photons_without_prior_nearest",
    "photons_without_prior_local",
    "photons_hybrid_bound",
    "photons_average_nearest",
    "photons_average_local",
];

fn table(first: &[&str], rows: &[(Vec<f64>, Photons)]) -> Table {
    let mut table = Table::new(first.iter().chain(&HEADER).copied());
    for (keys, photons) in rows {
        let found = photons.all().map(|n| n.map_or_else(|| "infinite".into(), |n| format!("{n:.3e}")));
        table.push(keys.iter().map(|key| format!("{key:.4}")).chain(found).collect());
    }
    table
}

fn column(rows: &[(Vec<f64>, Photons)], pick: fn(&Photons) -> Option<f64>) -> Vec<f64> {
    rows.iter().map(|(_, photons)| pick(photons).unwrap_or(f64::NAN)).collect()
}

/// Photons against the target's temperature at one lighting.
fn temperatures(name: &'static str, lighting: f64, most: f64, rows: &[(Vec<f64>, Photons)]) -> Plot {
    let x: Vec<f64> = rows.iter().map(|(keys, _)| keys[0]).collect();
    let line = |label: &str, pick| Series::line(label, x.clone(), column(rows, pick));
    let figure = LineFigure::new(
        format!("Photons to tell skin from aluminium, V = {lighting}"),
        Axis::linear("target temperature (°C)"),
        Axis::log("photons required").range(1e2, most),
    )
    .subtitle("Surroundings at 20 °C, 536 bands, temperature and lighting unknown; for Φ(1) = 84.1 % right.")
    .series(line("no prior, nearest distance", |n| n.nearest).colour(0))
    .series(line("no prior, local distance", |n| n.local).style(Style::Dashed).colour(0))
    .series(line("2 K prior, average of the nearest: what a user sees", |n| n.average_nearest).colour(1))
    .series(
        line("2 K prior, hybrid bound (of estimates, not of decisions)", |n| n.bound)
            .style(Style::Dashed)
            .colour(2),
    )
    .rule(Rule::vertical(AMBIENT_CELSIUS, "equal temperatures"));
    Plot { name: name.into(), figure: figure.into(), table: table(&["target_celsius", "lighting"], rows) }
}

/// Photons at equilibrium against the width of the prior.
fn widths(rows: &[(Vec<f64>, Photons)]) -> Plot {
    let x: Vec<f64> = rows.iter().map(|(keys, _)| keys[0]).collect();
    let line = |label: &str, pick| Series::line(label, x.clone(), column(rows, pick));
    let bound = column(rows, |n| n.bound);
    // Anchored at the narrowest prior.
    let slope: Vec<f64> = match (x.first(), bound.first()) {
        (Some(x0), Some(n0)) => x.iter().map(|x| 2.0 * n0 * (x0 / x).powi(2)).collect(),
        _ => Vec::new(),
    };
    let figure = LineFigure::new(
        "At equilibrium the prior alone decides",
        Axis::log("deviation of the prior on the temperature (K)"),
        Axis::log("photons required"),
    )
    .subtitle("Target and surroundings at 20 °C, V = 1; without a prior no number of photons suffices.")
    .series(line("average of the nearest: what a user sees", |n| n.average_nearest).colour(1))
    .series(line("average of the local", |n| n.average_local).style(Style::Dashed).colour(1))
    .series(line("hybrid bound (of estimates, not of decisions)", |n| n.bound).style(Style::Dashed).colour(2))
    .series(Series::line("slope −2", x.clone(), slope).style(Style::Dotted).colour(6));
    Plot { name: "prior_width".into(), figure: figure.into(), table: table(&["prior_k"], rows) }
}

/// Nearest distance in one range of the alternative's state.
struct Ranged {
    cells: [String; 2],
    found: Vec<[String; 3]>,
}

fn ranges(task: &Task) -> hadar::Result<Vec<Ranged>> {
    let scene = &task.scene;
    let glass = Library::embedded()?.get("soda-lime-glass")?.emissivity(scene.bands.nodes_cm1())?;
    let state = scene.state(37.0, 0.5)?;
    let own = state.temperature_k;
    let physical = StateRange::default();
    let mut rows = Vec::new();
    for (text, temperature_k) in [
        ("all that physics allows", physical.temperature_k),
        ("250 to 450 K", [250.0, 450.0]),
        ("273 to 323 K", [273.0, 323.0]),
        ("target ± 5 K", [own - 5.0, own + 5.0]),
        ("target ± 1 K", [own - 1.0, own + 1.0]),
    ] {
        for (lit, lighting) in [("0 to 1", [0.0, 1.0]), ("0.4 to 0.6", [0.4, 0.6])] {
            let range = StateRange { temperature_k, lighting, ..physical };
            let mut found = Vec::new();
            for other in [&task.aluminium, &glass] {
                let mut solver =
                    NearestSolver::new(&scene.bands, &scene.surroundings, scene.unknowns.clone(), range);
                let nearest = solver.per_photon(&task.skin, other, &state, f64::INFINITY)?;
                found.push([
                    format!("{:.2e}", nearest.distance),
                    format!("{:.2e}", nearest.distance.powi(-2)),
                    format!(
                        "{:.1} °C, {:.3}",
                        nearest.state.temperature_k - 273.15,
                        nearest.state.lighting.first().copied().unwrap_or(0.0)
                    ),
                ]);
            }
            rows.push(Ranged { cells: [text.into(), lit.into()], found });
        }
    }
    Ok(rows)
}

fn range_cells(rows: &[Ranged]) -> Vec<Vec<String>> {
    rows.iter().map(|row| row.cells.iter().chain(row.found.iter().flatten()).cloned().collect()).collect()
}

fn ranges_csv(rows: &[Ranged]) -> hadar::Result<String> {
    let mut table = Table::new([
        "temperature_range",
        "lighting_range",
        "nearest_aluminium_per_sqrt_photon",
        "photons_aluminium",
        "nearest_state_aluminium",
        "nearest_glass_per_sqrt_photon",
        "photons_glass",
        "nearest_state_glass",
    ]);
    range_cells(rows).into_iter().for_each(|row| table.push(row));
    table.to_csv()
}

fn photon_cells(rows: &[(Vec<f64>, Photons)], keep: &[f64]) -> Vec<Vec<String>> {
    let print = |n: Option<f64>| n.map_or_else(|| "infinite".into(), |n| format!("{n:.1e}"));
    rows.iter()
        .filter(|(keys, _)| keep.iter().any(|k| (k - keys[0]).abs() < 1e-6))
        .map(|(keys, photons)| {
            std::iter::once(format!("{}", keys[0])).chain(photons.all().map(print)).collect()
        })
        .collect()
}

fn readme(
    one: &[(Vec<f64>, Photons)],
    half: &[(Vec<f64>, Photons)],
    wide: &[(Vec<f64>, Photons)],
    rows: &[Ranged],
    simulated: [f64; 2],
) -> String {
    let shown = [10.0, 15.0, 18.0, 20.0, 22.0, 25.0, 37.0, 45.0];
    let header = |first: &'static str| {
        [
            first,
            "no prior, nearest",
            "no prior, local",
            "prior, hybrid bound",
            "prior, average of nearest",
            "prior, average of local",
        ]
    };
    let simulated = simulated.map(|share| format!("{share:.3}"));
    format!(
        "# What priors do\n\n\
         Skin or aluminium? 536 bands (715 to 1250 cm⁻¹, step 1), surroundings at 20 °C, photon noise only, \
         temperature and lighting V of either unknown. All photon numbers are for {:.1} % right decisions \
         (statistical distance 1). Where target and surroundings have one temperature and V = 1, every surface \
         sends the same light: no number of photons tells anything. With a prior on the target's temperature the \
         target is a little off equilibrium nearly always, and the number becomes finite.\n\n\
         Which curve is what:\n\n\
         * **No prior, nearest**: the limit for a target at exactly the temperature of the axis.\n\
         * **No prior, local**: the paper's distance for the same; it can err either way.\n\
         * **Prior, average of nearest**: what a user will see at best: Φ of the nearest distance, averaged over \
         targets drawn from the prior. The prior counts as a thermometer of that deviation. Plan with this \
         one.\n\
         * **Prior, average of local**: the same average of the paper's distance; errs as that does.\n\
         * **Prior, hybrid bound**: a bound on estimates: no unbiased estimate of a small admixture of \
         aluminium needs fewer photons. It is no bound on decisions between skin and aluminium. Near equilibrium \
         it is far below what a user sees, since it averages the information of rare targets far from equilibrium \
         with that of the others; away from equilibrium it is above it, since it is local.\n\n\
         ## V = 1, prior of 2 K on the temperature: photons\n\n{}\n\
         ![Photons against target temperature, V = 1](temperature_v1.png)\n\n\
         ## V = 0.5, prior of 2 K: photons\n\n{}\n\
         ![Photons against target temperature, V = 0.5](temperature_v05.png)\n\n\
         Half of the surroundings are cold sky, so equal temperatures are nothing special, and the photons are finite \
         without a prior. Yet it helps here too, and as much for a target at 37 °C: without a prior the aluminium \
         may be the far hotter one that looks like skin, with it that one is excluded.\n\n\
         Simulated decisions with the 2 K prior, at the photons of 'average of nearest' and a target at just 37 \
         °C: {} right at V = 1 and {} at V = 0.5 (± 0.006; 0.841 wanted). The simulation takes the thermometer \
         to be right, without scatter, which makes it up to 0.02 better. The hybrid bound asks for several times \
         more photons, which shows that it is no limit of decisions.\n\n\
         ## Width of the prior at equilibrium (20 °C, V = 1): photons\n\n{}\n\
         ![Photons against the width of the prior](prior_width.png)\n\n\
         A prior twice as wide needs four times fewer photons (slope −2): at equilibrium it helps that the target \
         is off it, not that its temperature is known. The hybrid bound promises some 150 times fewer photons than a \
         user needs.\n\n\
         ## What the alternative may do\n\n\
         A range of the alternative's state is a prior too. Skin at 37 °C, V = 0.5; T′ and V′ are what the \
         alternative may be. d₀ is the nearest distance per √photon, photons are 1/d₀².\n\n{}\n\
         The aluminium that looks like skin is far hotter than skin: who may exclude that needs hundreds of times \
         fewer photons, and fewer still who may exclude odd lighting. The glass that looks like skin has its \
         temperature: only the lighting helps.\n\n\
         ## How it was made\n\n\
         `cargo run --release --example priors -- reports/priors`. `hadar identify reports/priors/scenario.toml` \
         gives the two figures with a prior at 20 °C and V = 1. The prior is a Gaussian centred at the nominal \
         temperature; seed {SEED}. All numbers are in the CSV files beside the plots and in `state_ranges.csv`; three digits \
         are given.\n",
        100.0 * detection::probability(1.0),
        markdown(&header("target (°C)"), &photon_cells(one, &shown)),
        markdown(&header("target (°C)"), &photon_cells(half, &shown)),
        simulated[0],
        simulated[1],
        markdown(&header("prior (K)"), &photon_cells(wide, &[0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0])),
        markdown(
            &[
                "T′",
                "V′",
                "aluminium: d₀",
                "photons",
                "nearest state (T′, V′)",
                "window glass: d₀",
                "photons",
                "nearest state (T′, V′)",
            ],
            &range_cells(rows)
        ),
    )
}

fn run(out: &Path, quick: bool) -> hadar::Result<()> {
    let task = Task::new()?;
    eprintln!("width of the prior");
    let wide = [0.1, 0.2, 0.5, 1.0, 2.0, 3.0, 5.0, 7.0, 10.0]
        .into_par_iter()
        .filter(|&prior_k| !quick || prior_k < 0.3)
        .map(|prior_k| Ok((vec![prior_k], task.photons(AMBIENT_CELSIUS, 1.0, prior_k)?)))
        .collect::<hadar::Result<Vec<_>>>()?;
    let rows = ranges(&task)?;
    let mut bundle = Bundle::default();
    bundle.add("state_ranges.csv", ranges_csv(&rows)?);
    if quick {
        bundle.add("prior_width.csv", widths(&wide).table.to_csv()?);
        return bundle.write(out);
    }
    let mut celsius: Vec<f64> = (10..=45).map(f64::from).collect();
    // Closer where the curves bend.
    celsius.extend([19.5, 19.75, 19.9, 19.97, 19.99, 20.01, 20.03, 20.1, 20.25, 20.4, 20.5, 20.75]);
    celsius.sort_by(f64::total_cmp);
    let sweep = |lighting: f64| -> hadar::Result<Vec<(Vec<f64>, Photons)>> {
        eprintln!("V = {lighting}");
        let row = |&t: &f64| Ok((vec![t, lighting], task.photons(t, lighting, PRIOR_K)?));
        celsius.par_iter().map(row).collect()
    };
    let (one, half) = (sweep(1.0)?, sweep(0.5)?);
    let at_37 = |rows: &[(Vec<f64>, Photons)], lighting: f64| {
        let found = rows.iter().find(|(keys, _)| keys[0] == 37.0);
        let photons = found.and_then(|(_, photons)| photons.average_nearest).unwrap_or(f64::NAN);
        task.simulated(37.0, lighting, photons)
    };
    let simulated = [at_37(&one, 1.0)?, at_37(&half, 0.5)?];
    bundle.add("README.md", readme(&one, &half, &wide, &rows, simulated));
    bundle.add("scenario.toml", SCENARIO);
    bundle.add_plots(&[
        temperatures("temperature_v1", 1.0, 1e11, &one),
        temperatures("temperature_v05", 0.5, 1e8, &half),
        widths(&wide),
    ])?;
    let study = Study::new(&Scenario::from_toml(SCENARIO, None)?, &Library::embedded()?)?;
    for alternative in study.alternatives() {
        if let Some(average) = study.prior_average(alternative)? {
            println!(
                "the scenario: {} photons on average, {} by the hybrid bound",
                average.photons_required.map_or_else(|| "infinitely many".into(), |n| format!("{n:.2e}")),
                average
                    .photons_required_hybrid_bound
                    .map_or_else(|| "infinitely many".into(), |n| format!("{n:.2e}")),
            );
        }
    }
    bundle.write(out)?;
    eprintln!("wrote {}", out.display());
    Ok(())
}

fn main() -> std::process::ExitCode {
    let (quick, arguments) = paper_scene::arguments();
    let out = arguments.first().map_or_else(|| PathBuf::from("target/priors"), PathBuf::from);
    paper_scene::end(run(&out, quick))
}
