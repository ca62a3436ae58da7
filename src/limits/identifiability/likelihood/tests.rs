//! Derivatives against differences of the likelihood as [`Statistics`] writes it, and fits whose answer is known.

use super::*;
use crate::fisher::Nuisance;
use crate::scene::EnvironmentObject;

/// A likelihood with everything unknown but the environment's temperature.
struct Scene {
    bands: Bands,
    surroundings: Surroundings,
    emissivity: Vec<f64>,
}

impl Scene {
    fn new() -> Self {
        let bands = Bands::uniform(720.0, 1250.0, 53.0).unwrap();
        let object = |temperature_k| EnvironmentObject { temperature_k, emissivity: None };
        let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object(270.0), object(320.0)]).unwrap();
        let emissivity = bands.nodes_cm1().iter().map(|nu| 0.6 + 0.3 * (nu / 90.0).sin()).collect();
        Self { bands, surroundings, emissivity }
    }

    fn fits(&self, unknowns: Unknowns, statistics: Statistics, range: StateRange) -> MaximumLikelihood<'_> {
        MaximumLikelihood::new(&self.bands, &self.surroundings, unknowns, range, KAPPA, statistics).unwrap()
    }

    fn means(&self, state: &State) -> Vec<f64> {
        let signal = self.bands.weigh(&self.surroundings.signal(&self.emissivity, state));
        signal.iter().map(|signal| KAPPA * signal).collect()
    }

    fn state(&self) -> State {
        self.surroundings.state(305.0, &[0.3, 0.2]).unwrap()
    }
}

/// Makes some hundred counts per band.
const KAPPA: f64 = 1e-18;

fn laws(bands: usize) -> [Statistics; 3] {
    [
        Statistics::Poisson,
        Statistics::gaussian(vec![150.0; bands]).unwrap(),
        Statistics::negative_binomial(vec![80.0; bands]).unwrap(),
    ]
}

/// Temperature, two lighting factors with a prior, gain: Σ log-likelihood by its definition, differentiated by steps
/// of which the fourth-order formula keeps some ten digits of gradients and six of second derivatives.
#[test]
fn gradient_and_hessian_are_those_of_the_likelihood() {
    let scene = Scene::new();
    let known = scene.state();
    let at = State { temperature_k: 309.0, lighting: vec![0.25, 0.35], gain: 1.1, ..known.clone() };
    let counts: Vec<f64> = scene.means(&known).iter().map(|mean| (1.05 * mean).round()).collect();
    assert!(counts.iter().all(|&count| count > 30.0), "{counts:?}");
    let set = [Nuisance::Temperature, Nuisance::Lighting, Nuisance::Gain];
    let unknowns = Unknowns::new(set).unwrap().prior(Nuisance::Lighting, 0.1).unwrap();
    for statistics in laws(scene.bands.len()) {
        let mut fits = scene.fits(unknowns.clone(), statistics.clone(), StateRange::default());
        let parameters = fits.space.parameters.clone();
        let steps: Vec<f64> =
            parameters.iter().map(|p| if *p == Parameter::Temperature { 0.3 } else { 3e-3 }).collect();
        let loss = |moves: &[f64]| {
            let mut state = at.clone();
            for ((parameter, step), by) in parameters.iter().zip(&steps).zip(moves) {
                set_to(&mut state, *parameter, value(&at, *parameter) + by * step);
            }
            let means = scene.means(&state);
            let bands = means.iter().zip(&counts).enumerate();
            let prior: f64 = (0..2).map(|k| ((state.lighting[k] - known.lighting[k]) / 0.1).powi(2)).sum();
            0.5 * prior
                - bands.map(|(band, (mean, n))| statistics.log_likelihood(band, *n, *mean)).sum::<f64>()
        };
        let task = Task { emissivity: &scene.emissivity, counts: &counts, known: &known };
        fits.loss(&task, &at);
        let quadratic = fits.quadratic(&task, &at);
        // (8[f(1) − f(−1)] − f(2) + f(−2))/12.
        let weights = [(-2.0, 1.0 / 12.0), (-1.0, -2.0 / 3.0), (1.0, 2.0 / 3.0), (2.0, -1.0 / 12.0)];
        let n = parameters.len();
        for i in 0..n {
            let along = |by: f64| (0..n).map(|k| if k == i { by } else { 0.0 }).collect::<Vec<_>>();
            let slope: f64 = weights.iter().map(|(by, w)| w * loss(&along(*by))).sum::<f64>() / steps[i];
            let size = (0..n).map(|k| quadratic.gradient[k].abs() * steps[k]).fold(0.0, f64::max) / steps[i];
            let off = (quadratic.gradient[i] - slope).abs();
            assert!(off < 1e-6 * size, "{} {i}: {} {slope}", statistics.name(), quadratic.gradient[i]);
            for j in 0..n {
                let both = |a: f64, b: f64| {
                    let mut moves = along(a);
                    moves[j] += b;
                    loss(&moves)
                };
                let mut bend = 0.0;
                for (a, wa) in weights {
                    bend += weights.iter().map(|(b, wb)| wa * wb * both(a, *b)).sum::<f64>();
                }
                bend /= steps[i] * steps[j];
                let exact = quadratic.hessian[(i, j)];
                let size = (quadratic.hessian[(i, i)] * quadratic.hessian[(j, j)]).abs().sqrt();
                assert!((exact - bend).abs() < 1e-4 * size, "{} {i} {j}: {exact} {bend}", statistics.name());
            }
        }
    }
}

fn set_to(state: &mut State, parameter: Parameter, to: f64) {
    set(state, parameter, to);
}

/// Where every mean equals its count nothing is more likely (Poisson, negative binomial), and the answer is the truth.
#[test]
fn counts_without_scatter_give_the_truth() {
    let scene = Scene::new();
    let truth = scene.state();
    let counts = scene.means(&truth);
    let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).unwrap();
    let start = State { temperature_k: 330.0, lighting: vec![0.05, 0.6], ..truth.clone() };
    let [poisson, _, bunched] = laws(counts.len());
    for statistics in [poisson, bunched] {
        let mut fits = scene.fits(unknowns.clone(), statistics, StateRange::default());
        let fit = fits.fit(&scene.emissivity, &counts, &truth, std::slice::from_ref(&start));
        assert!(fit.converged && fit.log_likelihood.abs() < 1e-9, "{fit:?}");
        assert!((fit.state.temperature_k - truth.temperature_k).abs() < 1e-2, "{fit:?}");
    }
}

/// Gain alone, Poisson: the best gain is Σn/ΣN, in closed form.
#[test]
fn the_best_gain_is_the_ratio_of_the_counts() {
    let scene = Scene::new();
    let known = scene.state();
    let means = scene.means(&known);
    let counts: Vec<f64> = means.iter().enumerate().map(|(i, mean)| mean * (1.0 + 0.1 * i as f64)).collect();
    let unknowns = Unknowns::new([Nuisance::Gain]).unwrap();
    let mut fits = scene.fits(unknowns, Statistics::Poisson, StateRange::default());
    let fit = fits.fit(&scene.emissivity, &counts, &known, &[]);
    let best = counts.iter().sum::<f64>() / means.iter().sum::<f64>();
    assert!(fit.converged && (fit.state.gain / best - 1.0).abs() < 1e-5, "{fit:?} {best}");
    let exact: f64 =
        counts.iter().zip(&means).map(|(n, mean)| n - n * (n / (best * mean)).ln() - best * mean).sum();
    assert!((fit.log_likelihood - exact).abs() < 1e-7, "{} {exact}", fit.log_likelihood);
}

/// A state out of its range is not found, the edge is; nothing unknown is no fit at all; no counts at all are no
/// trouble.
#[test]
fn edges_and_empty_cases() {
    let scene = Scene::new();
    let truth = scene.state();
    let counts = scene.means(&truth);
    let unknowns = Unknowns::new([Nuisance::Temperature]).unwrap();
    for statistics in laws(counts.len()) {
        let range = StateRange { temperature_k: [250.0, 300.0], ..StateRange::default() };
        let mut fits = scene.fits(unknowns.clone(), statistics.clone(), range);
        let fit = fits.fit(&scene.emissivity, &counts, &truth, &[]);
        assert!(fit.converged && fit.state.temperature_k == 300.0, "{fit:?}");
        let fit = fits.fit(&scene.emissivity, &vec![0.0; counts.len()], &truth, &[]);
        assert!(fit.state.temperature_k == 250.0, "{fit:?}");
        let mut fits = scene.fits(Unknowns::default(), statistics.clone(), range);
        let fit = fits.fit(&scene.emissivity, &counts, &truth, &[]);
        assert!(fit.converged && fit.state == truth, "{fit:?}");
        let mut fits = scene.fits(unknowns.clone(), statistics, StateRange::default());
        let fit = fits.fit(&scene.emissivity, &vec![0.0; counts.len()], &truth, &[]);
        assert!(fit.log_likelihood.is_finite() && fit.state.temperature_k < 305.0, "{fit:?}");
    }
    let refuse = |kappa, statistics| {
        let (unknowns, range) = (Unknowns::default(), StateRange::default());
        MaximumLikelihood::new(&scene.bands, &scene.surroundings, unknowns, range, kappa, statistics).is_err()
    };
    assert!(refuse(0.0, Statistics::Poisson) && refuse(f64::NAN, Statistics::Poisson));
    assert!(refuse(1.0, Statistics::gaussian(vec![1.0]).unwrap()));
}
