//! Fig. 3b and Fig. S7: information that classifiers retrieve, against the normalised photon number.
//!
//! The paper's experiment: 150 photon numbers, 5000 spectra of the person and of the nearest robot each, 25 % for
//! training, 25 % for validation, 50 % for the test; 536 bands (Fig. 3b) or three (Fig. S7).

use super::{Effort, Figures, Line, Made, Order, Progress, Verdict, scene};
use crate::error::Result;
use crate::report::bundle::Bundle;
use crate::report::figures::{self, SimulationCurves};
use crate::report::simulation::curves;
use crate::simulate::classifier::Method;
use crate::simulate::experiment::Design;
use crate::study::{
    NoiseCurves, PhotonLaw, SimulatedPerformance, Simulation, SimulationPlan, Standing, Study,
};
use std::path::Path;

/// The paper's numbers of photon numbers and of spectra.
const EXPERIMENTS: usize = 150;
const SPECTRA: usize = 5000;
/// Of the experiments, the quick form makes every so many.
const QUICK: usize = 25;
/// Normalised photon numbers N d₀² of the experiments: from hopeless to certain.
const SHOT: [f64; 2] = [0.01, 10.0];
/// Those with the detector's noise: around where its flicker noise begins to hold the information down.
const NOISY: [f64; 2] = [10.0, 1e6];
/// Those of the curves.
const CURVES: [f64; 2] = [0.01, 1e8];
const CURVE_POINTS: usize = 121;
/// Share of the experiments whose 95 % interval must reach up to the limit for a classifier to be said to reach it;
/// an ideal one's do in 97.5 %.
const REACHED: f64 = 0.9;

/// Fig. 3b.
pub(super) fn all_bands(order: Order, out: &Path, progress: Progress<'_>) -> Result<Made> {
    let study = scene::study(scene::HUMAN_VS_ROBOT)?;
    let result = experiments(&study, order, SHOT, false, progress)?;
    let rival = &study.alternatives()[..1];
    let mut bundle = Bundle::default();
    bundle.add("scenario.toml", study.scenario().to_toml_beside(out));
    let mut lines = robot(&result);
    if let [rival] = rival {
        let noise = study.noise_curves(rival, CURVES, CURVE_POINTS)?;
        bundle.add("noise_curves.csv", curves(&noise).to_csv()?);
        let title = "Person or robot, 536 bands: no classifier beats the limit".to_owned();
        let plot = SimulationCurves { title, noise: Some(&noise), other: None, name: "fig3b" };
        bundle.add_plots(&[figures::classifiers(&result, &plot)])?;
        lines.extend(noisy_lines("Fig. 3b", "3.34e5", &noise));
    }
    lines.extend(shortfalls("Fig. 3b", &result));
    let caption = "Information of each classifier against the normalised photon number";
    Ok((bundle, lines, Figures { pictures: vec![("fig3b.png", caption)], text: String::new() }))
}

/// Fig. S7.
pub(super) fn three_bands(order: Order, out: &Path, progress: Progress<'_>) -> Result<Made> {
    let study = scene::study(scene::THREE_BANDS)?;
    let (first, second) = (AtHalf(progress, 0), AtHalf(progress, 1));
    let result = experiments(&study, order, SHOT, false, &|done, total| first.set(done, total))?;
    let noisy = experiments(&study, order, NOISY, true, &|done, total| second.set(done, total))?;
    let mut bundle = Bundle::default();
    bundle.add("scenario.toml", study.scenario().to_toml_beside(out));
    let mut lines = Vec::new();
    if let [rival] = study.alternatives() {
        let noise = study.noise_curves(rival, CURVES, CURVE_POINTS)?;
        bundle.add("noise_curves.csv", curves(&noise).to_csv()?);
        let title = "Person or robot, three bands: classifiers reach the limit".to_owned();
        let other = Some((&noisy, "all of them with mixed noise, below"));
        let plot = SimulationCurves { title, noise: Some(&noise), other, name: "figs7" };
        bundle.add_plots(&[figures::classifiers(&result, &plot)])?;
        bundle.add("figs7_mixed_noise.csv", figures::simulation_table(&noisy).to_csv()?);
        lines.extend(noisy_lines("Fig. S7", "6.85e4", &noise));
    }
    lines.extend(shortfalls("Fig. S7, shot noise", &result));
    lines.extend(shortfalls("Fig. S7, mixed noise", &noisy));
    let caption = "Information of each classifier against the normalised photon number, three bands";
    Ok((bundle, lines, Figures { pictures: vec![("figs7.png", caption)], text: String::new() }))
}

/// One of two halves of the work.
struct AtHalf<'a>(Progress<'a>, usize);

impl AtHalf<'_> {
    fn set(&self, done: usize, total: usize) {
        (self.0)(self.1 * total + done, 2 * total);
    }
}

fn experiments(
    study: &Study,
    order: Order,
    normalised: [f64; 2],
    camera_noise: bool,
    progress: Progress<'_>,
) -> Result<Simulation> {
    let mut photons = study.sweep(normalised, EXPERIMENTS, &[])?;
    if order.effort == Effort::Quick {
        photons = photons.into_iter().skip(QUICK / 2).step_by(QUICK).collect();
    }
    let design = Design {
        per_class: SPECTRA,
        methods: Method::ALL.to_vec(),
        seed: order.seed,
        level: 0.95,
        skip_spectra: false,
    };
    let (law, against) = (PhotonLaw::Poisson, Vec::new());
    let plan = SimulationPlan { photons, law, camera_noise, against, design, models: Vec::new() };
    study.simulate(&plan, progress).map(|(result, _)| result)
}

/// The nearest robot.
fn robot(result: &Simulation) -> Vec<Line> {
    let Some(robot) = result.points.first().and_then(|point| point.classes.get(1)) else { return Vec::new() };
    let lighting = robot.lighting.first().copied().unwrap_or(f64::NAN);
    let ours = format!("{:.2} degC, {lighting:.3}", robot.temperature_k - 273.15);
    let why = "nearest by shot noise; with the same noise in every band (the camera's, or an unweighted fit) it is \
               83.55 degC, 0.167";
    vec![Line::new(
        "Methods",
        "nearest robot: temperature, V",
        "83.46 degC, 0.17",
        ours,
        Verdict::UnderAChoice,
        why,
    )]
}

/// What the detector's noise makes of the limit.
fn noisy_lines(place: &'static str, printed: &'static str, noise: &NoiseCurves) -> Vec<Line> {
    let quantity = "gamma_0 and gamma_1 N at one frame of the camera";
    // One frame is where Johnson and flicker noise are equal: both are half of the camera's noise there.
    let [_, johnson, flicker, _] = noise.curves.as_slice() else { return Vec::new() };
    let gamma = johnson.gamma.first().copied().unwrap_or(f64::NAN);
    let floor = flicker.distance.last().copied().unwrap_or(f64::NAN);
    let bits = crate::identifiability::detection::information_bits(floor);
    let (verdict, why) = if place == "Fig. 3b" {
        (
            Verdict::Reproduced,
            "half of sigma^2/N_band each; this scene is 7 % brighter than the 30 degC blackbody of Table S2",
        )
    } else {
        (Verdict::UnderAChoice, "chosen 'for better visual clarity' in the paper; set by the scenario here")
    };
    vec![
        Line::new(place, quantity, printed, format!("{gamma:.2e}"), verdict, why),
        Line::new(
            place,
            "information at an endless exposure with flicker noise, bit",
            "only drawn",
            format!("{bits:.3}"),
            Verdict::NoValuePrinted,
            "gamma_1 held at its value of one frame; the paper does not say at which N it holds",
        ),
    ]
}

/// How far each classifier stays below the limit.
fn shortfalls(place: &'static str, result: &Simulation) -> Vec<Line> {
    let beyond = result
        .points
        .iter()
        .flat_map(|point| &point.performances)
        .filter(|found| found.standing == Some(Standing::Beyond))
        .count();
    let (verdict, ours) = if beyond == 0 {
        (Verdict::Reproduced, format!("none of {}", result.comparisons))
    } else {
        (Verdict::NotReproduced, format!("{beyond} of {}", result.comparisons))
    };
    let why =
        "balanced accuracy above the limit by more than chance explains in all comparisons together (1 %)";
    let mut lines =
        vec![Line::new(place, "experiments beyond the limit", "bounded by the limit", ours, verdict, why)];
    for method in Method::ALL {
        let found: Vec<(f64, &SimulatedPerformance)> = result
            .points
            .iter()
            .filter_map(|point| {
                let found = point.performances.iter().find(|found| found.performance.method == method)?;
                Some((point.limit.unwrap_or(point.limit_normal), found))
            })
            .collect();
        if found.is_empty() {
            continue;
        }
        let n = found.len() as f64;
        let mean = |value: &dyn Fn(f64, &SimulatedPerformance) -> f64| {
            found.iter().map(|(limit, found)| value(*limit, found)).sum::<f64>() / n
        };
        let points = mean(&|limit, found| 100.0 * (limit - found.performance.accuracy));
        let bits = mean(&|limit, found| (2.0 * limit).log2() - found.information_bits);
        // Deviation of the mean by the finite number of test spectra alone.
        let test = (SPECTRA - 2 * (SPECTRA / 4)) as f64;
        let sigma = 100.0 * (mean(&|limit, _| limit * (1.0 - limit)) / (2.0 * test) / n).sqrt();
        let within = found.iter().filter(|(limit, found)| found.performance.interval.high >= *limit).count();
        let ours = format!(
            "limit within the interval in {within} of {} experiments; {points:.2} ± {sigma:.2} points of accuracy below it \
             on average ({bits:.3} bit)",
            found.len()
        );
        // Of few experiments one may miss it by chance.
        let reached = within as f64 >= REACHED * n - 1.0;
        let (paper, verdict, why) = expected(place, method, reached);
        lines.push(Line::new(place, method.words(), paper, ours, verdict, why));
    }
    lines
}

/// What the paper says of a classifier, and whether it comes out.
fn expected(place: &str, method: Method, reached: bool) -> (&'static str, Verdict, &'static str) {
    match (method, place) {
        (Method::LikelihoodRatio, _) => (
            "-",
            Verdict::NoValuePrinted,
            "the optimum: it scatters about the limit, by which the limit is confirmed",
        ),
        (Method::BestFits, _) => (
            "-",
            Verdict::NoValuePrinted,
            "knows the materials, not their states: what is lost is the price of the unknown states",
        ),
        (Method::Discriminant | Method::Logistic, _) => {
            ("-", Verdict::NoValuePrinted, "learns from the same spectra as the network")
        }
        (Method::Network, "Fig. 3b") => (
            "slight deviation (overfitting)",
            if reached { Verdict::NotReproduced } else { Verdict::Reproduced },
            "2500 spectra do not tell every weight of 536 bands; the paper states no sizes of its network, ours are in the documentation",
        ),
        (Method::Network, _) => (
            "perfect agreement",
            if reached { Verdict::Reproduced } else { Verdict::NotReproduced },
            "an ideal classifier's interval reaches up to the limit in 97.5 % of the experiments; at least 90 % count as agreement",
        ),
    }
}
