use super::*;
use crate::cube::Shape;
use crate::fisher::precision::PrecisionSolver;
use crate::planck;
use crate::random::generator;
use crate::ranging::derivative::Derivative;
use crate::scene::EnvironmentObject;
use rand_distr::{Distribution, Poisson};

const T_K: f64 = 305.0;
const AROUND_K: f64 = 288.0;
const COUNTS: f64 = 2e-16;

fn scene(bands: usize, objects: &[f64]) -> (Bands, Surroundings) {
    let bands = Bands::from_rows((0..bands).map(|w| (800.0 + 40.0 * w as f64, 30.0))).unwrap();
    let objects = objects.iter().map(|t| EnvironmentObject { temperature_k: *t, emissivity: None }).collect();
    let surroundings = Surroundings::new(bands.nodes_cm1(), objects).unwrap();
    (bands, surroundings)
}

/// An emissivity that temperature and lighting do not imitate.
fn striped(bands: usize) -> Vec<f64> {
    (0..bands).map(|w| [0.3, 0.8, 0.95][w % 3]).collect()
}

fn noisy(bands: usize) -> Counting {
    Counting { counts_per_radiance: COUNTS, var_added: (0..bands).map(|w| 1e5 * (1.0 + w as f64)).collect() }
}

fn unknowns(nuisances: &[Nuisance]) -> Unknowns {
    Unknowns::new(nuisances.iter().copied()).unwrap()
}

const BOTH: [Nuisance; 2] = [Nuisance::Temperature, Nuisance::Lighting];

/// Σ(∂N)²/(N + σ²) of (V, V), (V, T), (T, T), and of the scattered signal alone, from Planck's law.
fn by_hand(e: &[f64], lighting: f64) -> [f64; 4] {
    let counting = noisy(e.len());
    let mut sums = [0.0; 4];
    for (w, e) in e.iter().enumerate() {
        let (nu, kappa) = (800.0 + 40.0 * w as f64, COUNTS * 30.0);
        let (own, other) = (planck::photon_radiance(nu, T_K), planck::photon_radiance(nu, AROUND_K));
        let scattered = kappa * (1.0 - e) * lighting * other;
        let var = kappa * e * own + scattered + counting.var_added[w];
        let (by_v, by_t) = (kappa * (1.0 - e) * other, kappa * e * planck::photon_radiance_slope(nu, T_K));
        sums[0] += by_v * by_v / var;
        sums[1] += by_v * by_t / var;
        sums[2] += by_t * by_t / var;
        sums[3] += by_v * by_v / (scattered + counting.var_added[w]);
    }
    sums
}

/// J_VV − J_VT²/J_TT. Tolerance: a few digits of 16 cancel.
#[test]
fn two_parameters_are_a_closed_form() {
    let e = striped(9);
    let (bands, surroundings) = scene(9, &[AROUND_K]);
    let state = surroundings.state(T_K, &[0.4]).unwrap();
    let [vv, vt, tt, alone] = by_hand(&e, 0.4);
    let mut solver = LightingSolver::new(&bands, &surroundings, unknowns(&BOTH)).unwrap();
    let found = solver.precision(&e, &state, &noisy(9), 0).unwrap();
    let schur = vv - vt * vt / tt;
    assert!((found.others_known / vv - 1.0).abs() < 1e-13, "{found:?} {vv}");
    assert!((found.others_unknown / schur - 1.0).abs() < 1e-12, "{found:?} {schur}");
    assert!(found.relative_error < 1e-12 && schur < 0.9 * vv);
    let (dt, dv) = (0.3, -0.02);
    let along = solver.information(&e, &state, &noisy(9), dt, &[dv]).unwrap();
    let cube = dv * dv * vv + 2.0 * dv * dt * vt + dt * dt * tt;
    assert!((along.heat_cube / cube - 1.0).abs() < 1e-12);
    assert!((along.reconstructed / (dv * dv * schur) - 1.0).abs() < 1e-12);
    assert!((along.as_if_measured / (dv * dv * alone) - 1.0).abs() < 1e-12);
    let summed = found.others_unknown * dv * dv;
    assert!((summed / along.reconstructed - 1.0).abs() < 1e-12);
}

/// The same from the solver of precision, with two objects, priors, gain and a known total.
#[test]
fn precisions_agree_with_the_bound_of_the_state() {
    let (bands, surroundings) = scene(12, &[AROUND_K, 250.0]);
    let state = surroundings.state(T_K, &[0.4, 0.3]).unwrap();
    let e = striped(12);
    let more = unknowns(&[Nuisance::Temperature, Nuisance::Lighting, Nuisance::Gain]);
    for unknowns in [
        unknowns(&BOTH),
        unknowns(&BOTH).lighting_total(Some(0.7)).unwrap(),
        unknowns(&BOTH).prior(Nuisance::Temperature, 0.5).unwrap(),
        more.prior(Nuisance::Gain, 0.01).unwrap().prior(Nuisance::Lighting, 0.3).unwrap(),
    ] {
        let mut solver = LightingSolver::new(&bands, &surroundings, unknowns.clone()).unwrap();
        let ours = solver.precision(&e, &state, &noisy(12), 0).unwrap();
        let theirs = PrecisionSolver::new(&bands, &surroundings, unknowns)
            .bound(&e, &state, &noisy(12), Parameter::Lighting(0))
            .unwrap();
        let error = ours.others_unknown * theirs.sigma * theirs.sigma - 1.0;
        assert!(error.abs() < 1e-9, "{error:e}");
        let error = ours.others_known * theirs.sigma_others_known * theirs.sigma_others_known - 1.0;
        assert!(error.abs() < 1e-12, "{error:e}");
    }
}

#[test]
fn limits() {
    let (bands, surroundings) = scene(9, &[AROUND_K]);
    let state = surroundings.state(T_K, &[0.4]).unwrap();
    let mut solver = LightingSolver::new(&bands, &surroundings, unknowns(&BOTH)).unwrap();
    // A black surface scatters nothing.
    let black = solver.precision(&[1.0; 9], &state, &noisy(9), 0).unwrap();
    assert_eq!((black.others_known, black.others_unknown), (0.0, 0.0));
    // Temperature known: nothing is lost; unknown, something is.
    let mut known = LightingSolver::new(&bands, &surroundings, unknowns(&[Nuisance::Lighting])).unwrap();
    let at_known = known.precision(&striped(9), &state, &noisy(9), 0).unwrap();
    let at_unknown = solver.precision(&striped(9), &state, &noisy(9), 0).unwrap();
    assert_eq!(at_known.others_known, at_known.others_unknown);
    assert!(at_unknown.others_unknown < at_known.others_unknown);
    // One band cannot tell lighting from temperature.
    let (bands, surroundings) = scene(1, &[AROUND_K]);
    let mut solver = LightingSolver::new(&bands, &surroundings, unknowns(&BOTH)).unwrap();
    let one = solver.precision(&[0.5], &state, &noisy(1), 0).unwrap();
    assert!(one.others_known > 0.0 && one.others_unknown == 0.0, "{one:?}");
    let along = solver.information(&[0.5], &state, &noisy(1), 0.1, &[0.1]).unwrap();
    assert!(along.heat_cube > 0.0 && along.reconstructed == 0.0);
}

/// Reconstruction never tells more than the cube; the scattered signal alone would, where most photons are emitted.
#[test]
fn as_if_measured_is_no_bound() {
    let (bands, surroundings) = scene(9, &[AROUND_K]);
    let shot = Counting { counts_per_radiance: COUNTS, var_added: Vec::new() };
    let mut solver = LightingSolver::new(&bands, &surroundings, unknowns(&BOTH)).unwrap();
    for lighting in [0.05, 0.4, 1.0] {
        let state = surroundings.state(T_K, &[lighting]).unwrap();
        for (dt, dv) in [(0.0, 0.01), (0.3, 0.01), (-0.3, 0.01), (0.05, -0.2), (0.3, 0.0)] {
            for e in [striped(9), vec![0.9; 9]] {
                let found = solver.information(&e, &state, &shot, dt, &[dv]).unwrap();
                assert!(found.reconstructed <= found.heat_cube * (1.0 + 1e-9), "{found:?}");
            }
        }
        let found = solver.information(&[0.9; 9], &state, &shot, 0.0, &[0.01]).unwrap();
        // Grey: of N = e B(T) + (1 − e)V B(T₀), a tenth of V at most is scattered.
        assert!(found.as_if_measured > 9.0 * found.heat_cube, "{found:?}");
    }
}

/// Poisson counts, fitted by iterated weighted least squares: the scatter of V is that of the bound.
/// 20 000 trials: the variance is known to 1 %; 5 deviations are a false alarm in 2e6.
#[test]
fn least_squares_reach_the_bound() {
    const TRIALS: usize = 20_000;
    let e = striped(6);
    let (bands, surroundings) = scene(6, &[AROUND_K]);
    let state = surroundings.state(T_K, &[0.4]).unwrap();
    let counting = Counting { counts_per_radiance: 1e3 * COUNTS, var_added: Vec::new() };
    let mut solver = LightingSolver::new(&bands, &surroundings, unknowns(&BOTH)).unwrap();
    let bound = solver.precision(&e, &state, &counting, 0).unwrap().others_unknown;
    let mut model = Jacobian::new(&bands, &surroundings);
    let parameters = [Parameter::Temperature, Parameter::Lighting(0)];
    model.evaluate(&e, &e, &state, &parameters, false);
    let mean: Vec<f64> = model.signal().iter().map(|s| s * counting.counts_per_radiance).collect();
    let laws: Vec<Poisson<f64>> = mean.iter().map(|mean| Poisson::new(*mean).unwrap()).collect();
    let (mut sum, mut square) = (0.0, 0.0);
    for trial in 0..TRIALS {
        let mut rng = generator(11, trial as u64);
        let counts: Vec<f64> = laws.iter().map(|law| law.sample(&mut rng)).collect();
        let mut fit = state.clone();
        for _ in 0..3 {
            model.evaluate(&e, &e, &fit, &parameters, false);
            let (mut a, mut b) = ([0.0; 3], [0.0; 2]);
            for (w, observed) in counts.iter().enumerate() {
                let c = counting.counts_per_radiance;
                let [n, t, v] = [model.signal()[w], model.column(0)[w], model.column(1)[w]].map(|x| c * x);
                a = [a[0] + t * t / n, a[1] + t * v / n, a[2] + v * v / n];
                b = [b[0] + t * (observed - n) / n, b[1] + v * (observed - n) / n];
            }
            let det = a[0] * a[2] - a[1] * a[1];
            fit.temperature_k += (a[2] * b[0] - a[1] * b[1]) / det;
            fit.lighting[0] += (a[0] * b[1] - a[1] * b[0]) / det;
        }
        let error = fit.lighting[0] - 0.4;
        sum += error;
        square += error * error;
    }
    let n = TRIALS as f64;
    let var = (square - sum * sum / n) / (n - 1.0);
    assert!((var * bound - 1.0).abs() < 5.0 * (2.0 / n).sqrt(), "{}", var * bound);
}

/// A road of one emissivity whose lighting and temperature change along x: what its pixels tell is what the state's derivatives tell. The
/// counts are made by hand; central differences of a linear change are exact but for the curvature of Planck's law (1e-4).
#[test]
fn a_picture_tells_what_its_states_tell() {
    const BANDS: usize = 9;
    let (bands, surroundings) = scene(BANDS, &[AROUND_K]);
    let (e, counting) = (striped(BANDS), noisy(BANDS));
    let (dt, dv) = (1e-3, 2e-4);
    let width = 30.0;
    let nodes = bands.nodes_cm1();
    let at = |x: f64| {
        let (t, v) = (T_K + dt * x, 0.4 + dv * x);
        let pixel = nodes.iter().zip(&e).map(move |(nu, e)| {
            let emitted = COUNTS * width * e * planck::photon_radiance(*nu, t);
            (emitted, emitted + COUNTS * width * (1.0 - e) * v * planck::photon_radiance(*nu, AROUND_K))
        });
        pixel.collect::<Vec<_>>()
    };
    let pixels: Vec<Vec<(f64, f64)>> = (-3..=3).map(|x| at(f64::from(x))).collect();
    let emission: Vec<f64> = pixels.iter().flatten().map(|pixel| pixel.0).collect();
    let counts: Vec<f64> = pixels.iter().flatten().map(|pixel| pixel.1).collect();
    let temperature_k: Vec<f64> = (-3..=3).map(|x| T_K + dt * f64::from(x)).collect();
    let scattered: Vec<f64> = counts.iter().zip(&emission).map(|(n, e)| n - e).collect();
    let image = EmissionImage {
        shape: Shape::new(1, 7, BANDS).unwrap(),
        counts: &counts,
        emission: &emission,
        scattered: &scattered,
        temperature_k: &temperature_k,
        wavenumbers_cm1: nodes,
        var_added: &counting.var_added,
    };
    let found = image.beside_emission(Derivative::Central).unwrap();
    let state = surroundings.state(T_K, &[0.4]).unwrap();
    let mut solver = LightingSolver::new(&bands, &surroundings, unknowns(&BOTH)).unwrap();
    let told = solver.information(&e, &state, &counting, dt, &[dv]).unwrap();
    assert!((found.temperature[2] / told.reconstructed - 1.0).abs() < 1e-3, "{found:?} {told:?}");
    assert!((found.scattered_alone[2] / told.as_if_measured - 1.0).abs() < 1e-3, "{found:?} {told:?}");
    assert!(found.strength_too[2] < found.temperature[2] && found.strength_too[2] > 0.0);
    let short = EmissionImage { temperature_k: &temperature_k[1..], ..image };
    assert!(short.beside_emission(Derivative::Central).is_err());
}

/// A grey road as warm as what lights it: emitted and scattered light have one spectrum, nothing separates them; nor in two bands.
#[test]
fn what_has_one_spectrum_is_not_separated() {
    let found = |bands: usize, around_k: f64| {
        let nodes: Vec<f64> = (0..bands).map(|w| 800.0 + 50.0 * w as f64).collect();
        let e = |x: usize| 0.85 + 0.02 * (x as f64).sin();
        let pixel = |x: usize, nu: f64, around: f64| {
            1e-12
                * (e(x) * planck::photon_radiance(nu, T_K)
                    + around * (1.0 - e(x)) * planck::photon_radiance(nu, around_k))
        };
        let cube = |around: f64| -> Vec<f64> {
            (0..7)
                .flat_map(|x| nodes.iter().map(move |nu| (x, *nu)))
                .map(|(x, nu)| pixel(x, nu, around))
                .collect()
        };
        let (counts, emission) = (cube(0.5), cube(0.0));
        let scattered: Vec<f64> = counts.iter().zip(&emission).map(|(n, e)| n - e).collect();
        let image = EmissionImage {
            shape: Shape::new(1, 7, bands).unwrap(),
            counts: &counts,
            emission: &emission,
            scattered: &scattered,
            temperature_k: &[T_K; 7],
            wavenumbers_cm1: &nodes,
            var_added: &vec![0.0; bands],
        };
        let told = image.beside_emission(Derivative::Central).unwrap();
        (told.temperature[2], told.strength_too[2])
    };
    let (apart, blind) = found(9, 250.0);
    assert!(blind > 0.0 && apart > blind);
    // Rounding of the counts, 1e-16 of them each, is all that is left.
    let (same, nothing) = found(9, T_K);
    assert!(nothing < 1e-20 * same, "{nothing} {same}");
    assert_eq!(found(2, 250.0).1, 0.0);
}

#[test]
fn impossible_input_is_refused() {
    let (bands, surroundings) = scene(3, &[AROUND_K]);
    assert!(LightingSolver::new(&bands, &surroundings, unknowns(&[Nuisance::Temperature])).is_err());
    let tied = unknowns(&BOTH).lighting_total(Some(1.0)).unwrap();
    assert!(LightingSolver::new(&bands, &surroundings, tied).is_err());
    let mut solver = LightingSolver::new(&bands, &surroundings, unknowns(&BOTH)).unwrap();
    let state = surroundings.state(T_K, &[0.4]).unwrap();
    let e = striped(3);
    assert!(solver.precision(&e, &state, &noisy(3), 1).is_err());
    assert!(solver.precision(&e[1..], &state, &noisy(3), 0).is_err());
    assert!(solver.precision(&[0.5, f64::NAN, 0.5], &state, &noisy(3), 0).is_err());
    assert!(solver.precision(&e, &state, &noisy(2), 0).is_err());
    let bad = State { lighting: vec![f64::NAN], ..state.clone() };
    assert!(solver.precision(&e, &bad, &noisy(3), 0).is_err());
    assert!(solver.information(&e, &state, &noisy(3), f64::NAN, &[0.1]).is_err());
    assert!(solver.information(&e, &state, &noisy(3), 0.1, &[]).is_err());
}
