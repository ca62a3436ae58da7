use super::*;
use crate::fisher::Nuisance;
use crate::planck;
use crate::scene::EnvironmentObject;

const T: Parameter = Parameter::Temperature;
const V: Parameter = Parameter::Lighting(0);

fn unknown(nuisances: &[Nuisance]) -> Unknowns {
    Unknowns::new(nuisances.iter().copied()).unwrap()
}

fn scene(rows: &[(f64, f64)]) -> (Bands, Surroundings) {
    let bands = Bands::from_rows(rows.iter().copied()).unwrap();
    let object = EnvironmentObject { temperature_k: 293.15, emissivity: None };
    let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object]).unwrap();
    (bands, surroundings)
}

fn noisy(bands: usize) -> Counting {
    Counting { counts_per_radiance: 3e-13, var_added: (0..bands).map(|w| 1e9 * (1.0 + w as f64)).collect() }
}

fn bound(rows: &[(f64, f64)], e: &[f64], unknowns: Unknowns, parameter: Parameter) -> Precision {
    let (bands, surroundings) = scene(rows);
    let state = surroundings.state(310.0, &[0.4]).unwrap();
    PrecisionSolver::new(&bands, &surroundings, unknowns)
        .bound(e, &state, &noisy(e.len()), parameter)
        .unwrap()
}

/// Two bands with their scores of T, V and ln gain by hand.
fn by_hand(rows: &[(f64, f64)], e: &[f64]) -> [Vec<f64>; 3] {
    let counting = noisy(e.len());
    let mut scores = [vec![], vec![], vec![]];
    for (w, ((nu, width), e)) in rows.iter().zip(e).enumerate() {
        let kappa = counting.counts_per_radiance * width;
        let (own, other) = (planck::photon_radiance(*nu, 310.0), planck::photon_radiance(*nu, 293.15));
        let mean = kappa * (e * own + (1.0 - e) * 0.4 * other);
        let sigma = (mean + counting.var_added[w]).sqrt();
        scores[0].push(kappa * e * planck::photon_radiance_slope(*nu, 310.0) / sigma);
        scores[1].push(kappa * (1.0 - e) * other / sigma);
        scores[2].push(mean / sigma);
    }
    scores
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// √(N + σ²)/(κ e ∂B/∂T). Tolerance: a few roundings.
#[test]
fn one_band_with_known_lighting_is_a_closed_form() {
    let (rows, e) = ([(1000.0, 2.0)], [0.8]);
    let found = bound(&rows, &e, unknown(&[Nuisance::Temperature]), T);
    assert!((found.sigma * by_hand(&rows, &e)[0][0] - 1.0).abs() < 4e-15, "{found:?}");
    assert_eq!((found.sight, found.sigma_others_known), (Sight::Seen, found.sigma));
}

/// The inverse of a 2 × 2 matrix by hand: σ_T² = (V₁² + V₂²)/(T₁V₂ − T₂V₁)².
#[test]
fn two_bands_and_two_unknowns_by_hand() {
    let (rows, e) = ([(800.0, 1.0), (1200.0, 1.5)], [0.6, 0.9]);
    let [t, v, _] = by_hand(&rows, &e);
    let determinant = t[0] * v[1] - t[1] * v[0];
    let unknowns = || unknown(&[Nuisance::Temperature, Nuisance::Lighting]);
    let of_t = bound(&rows, &e, unknowns(), T);
    let of_v = bound(&rows, &e, unknowns(), V);
    let tolerance = of_t.relative_error.max(of_v.relative_error) + 1e-14;
    assert!((of_t.sigma * determinant.abs() / v[0].hypot(v[1]) - 1.0).abs() < tolerance);
    assert!((of_v.sigma * determinant.abs() / t[0].hypot(t[1]) - 1.0).abs() < tolerance);
    assert!((of_t.sigma_others_known * t[0].hypot(t[1]) - 1.0).abs() < 1e-14);
    assert!(of_t.relative_error < 1e-12);
}

/// A black target scatters nothing: its lighting is not seen, and costs its temperature nothing.
#[test]
fn a_black_target_hides_the_lighting_but_not_the_temperature() {
    let (rows, e) = ([(800.0, 1.0), (1200.0, 1.5)], [1.0, 1.0]);
    let both = || unknown(&[Nuisance::Temperature, Nuisance::Lighting]);
    let (of_t, of_v) = (bound(&rows, &e, both(), T), bound(&rows, &e, both(), V));
    assert_eq!((of_v.sight, of_v.sigma), (Sight::Unchanged, f64::INFINITY));
    assert_eq!((of_t.sight, of_t.dropped.as_slice()), (Sight::Seen, [V].as_slice()));
    assert_eq!(of_t.sigma, bound(&rows, &e, unknown(&[Nuisance::Temperature]), T).sigma);
    // A mirror emits nothing.
    let mirror = bound(&rows, &[0.0, 0.0], unknown(&[Nuisance::Temperature]), T);
    assert_eq!((mirror.sight, mirror.sigma), (Sight::Unchanged, f64::INFINITY));
}

/// One band cannot tell two unknowns apart, nor can a gain and two unknowns in two.
#[test]
fn fewer_bands_than_unknowns_leave_it_imitated() {
    let both = unknown(&[Nuisance::Temperature, Nuisance::Lighting]);
    let one = bound(&[(1000.0, 1.0)], &[0.8], both.clone(), T);
    assert_eq!((one.sight, one.sigma), (Sight::Imitated, f64::INFINITY));
    let rows = [(800.0, 1.0), (1200.0, 1.5)];
    let three = bound(&rows, &[0.6, 0.9], both.clone().with(Nuisance::Gain), T);
    assert_eq!(three.sight, Sight::Imitated, "{three:?}");
    // A prior on the lighting is a third row.
    let with_prior = both.with(Nuisance::Gain).prior(Nuisance::Lighting, 0.1).unwrap();
    assert_eq!(bound(&rows, &[0.6, 0.9], with_prior, T).sight, Sight::Seen);
}

/// 1/σ_T² = J_TT − J_TV²/(J_VV + 1/σ_p²); no prior and certainty are its limits.
#[test]
fn priors_lead_from_unknown_to_known() {
    let rows = [(800.0, 1.0), (950.0, 1.0), (1200.0, 1.5)];
    let e = [0.6, 0.7, 0.9];
    let [t, v, _] = by_hand(&rows, &e);
    let both = unknown(&[Nuisance::Temperature, Nuisance::Lighting]);
    let with = |sigma: f64| bound(&rows, &e, both.clone().prior(Nuisance::Lighting, sigma).unwrap(), T).sigma;
    for sigma in [1e-3, 0.02, 0.3] {
        let schur = dot(&t, &t) - dot(&t, &v).powi(2) / (dot(&v, &v) + 1.0 / (sigma * sigma));
        // The subtraction loses about the square of the ratio of the bounds, here below 1e3.
        assert!((with(sigma) * schur.sqrt() - 1.0).abs() < 1e-12, "{sigma}");
    }
    let known = bound(&rows, &e, unknown(&[Nuisance::Temperature]), T).sigma;
    let free = bound(&rows, &e, both.clone(), T).sigma;
    assert!((with(1e-9) / known - 1.0).abs() < 1e-9 && (with(1e9) / free - 1.0).abs() < 1e-9);
    assert!(known < 0.5 * free && known < with(0.02) && with(0.02) < free);
}

/// J from central differences of the means, inverted by another algorithm. Tolerance: h² of the differences,
/// 1e-7 here, times what the inversion makes of it.
#[test]
fn bounds_agree_with_finite_differences() {
    let rows: Vec<(f64, f64)> = (0..40).map(|i| (750.0 + 13.0 * f64::from(i), 1.0)).collect();
    let e: Vec<f64> = (0..40).map(|i| 0.5 + 0.4 * (0.4 * f64::from(i)).sin()).collect();
    let (bands, surroundings) = scene(&rows);
    let counting = noisy(e.len());
    let mean = |t: f64, v: f64, gain: f64| -> Vec<f64> {
        let mut state = surroundings.state(t, &[v]).unwrap();
        state.gain = gain.exp();
        let signal = bands.weigh(&surroundings.signal(&e, &state));
        signal.iter().map(|s| s * counting.counts_per_radiance).collect()
    };
    let at = [310.0, 0.4, 0.0];
    let steps = [0.05, 1e-3, 1e-4];
    let here = mean(at[0], at[1], at[2]);
    let columns: Vec<Vec<f64>> = (0..3)
        .map(|i| {
            let moved = |sign: f64| {
                let mut place = at;
                place[i] += sign * steps[i];
                mean(place[0], place[1], place[2])
            };
            let (up, down) = (moved(1.0), moved(-1.0));
            let slope = up.iter().zip(&down).map(|(a, b)| (a - b) / (2.0 * steps[i]));
            let var = here.iter().enumerate().map(|(w, n)| n + counting.var_added[w]);
            slope.zip(var).map(|(slope, var)| slope / var.sqrt()).collect()
        })
        .collect();
    let information = nalgebra::DMatrix::from_fn(3, 3, |i, j| dot(&columns[i], &columns[j]));
    let covariance = information.try_inverse().unwrap();
    let unknowns = unknown(&[Nuisance::Temperature, Nuisance::Lighting, Nuisance::Gain]);
    let state = surroundings.state(310.0, &[0.4]).unwrap();
    let mut solver = PrecisionSolver::new(&bands, &surroundings, unknowns);
    let found = solver.joint(&e, &state, &counting).unwrap();
    let joint = found.joint.unwrap();
    for i in 0..3 {
        assert!((found.each[i].sigma / covariance[(i, i)].sqrt() - 1.0).abs() < 1e-5, "{i}");
        assert!((joint.sigma(i) / found.each[i].sigma - 1.0).abs() < 1e-12, "{i}");
        for j in 0..3 {
            let scale = found.each[i].sigma * found.each[j].sigma;
            assert!((joint.covariance(i, j) - covariance[(i, j)]).abs() < 1e-5 * scale, "{i} {j}");
        }
    }
}

/// Counts of 1e-200 and of 1e+200 in a band: the bound scales with 1/√N, to rounding.
#[test]
fn no_number_of_photons_is_too_small_or_too_large() {
    let (bands, surroundings) = scene(&[(800.0, 1.0), (1200.0, 1.5)]);
    let state = surroundings.state(310.0, &[0.4]).unwrap();
    let unknowns = unknown(&[Nuisance::Temperature, Nuisance::Lighting]);
    let mut solver = PrecisionSolver::new(&bands, &surroundings, unknowns);
    let mut sigma = |counts_per_radiance: f64| {
        let counting = Counting { counts_per_radiance, var_added: Vec::new() };
        solver.bound(&[0.6, 0.9], &state, &counting, T).unwrap().sigma
    };
    let one = sigma(1.0);
    for scale in [1e-220, 1e-100, 1e100, 1e200] {
        assert!((sigma(scale) * scale.sqrt() / one - 1.0).abs() < 1e-13, "{scale:e}");
    }
}

/// Surroundings δ warmer than a grey target, their temperature unknown too: what tells them apart is of first order in δ, so
/// σ_T δ has a limit. Tolerance: δ = 1e-5 K itself, over some 100 K.
#[test]
fn surroundings_as_warm_as_the_target_cost_all_but_the_last_of_its_precision() {
    let rows = [(800.0, 1.0), (1200.0, 1.5)];
    let (bands, surroundings) = scene(&rows);
    let unknowns = unknown(&[Nuisance::Temperature, Nuisance::EnvironmentTemperature]);
    let mut solver = PrecisionSolver::new(&bands, &surroundings, unknowns);
    let mut scaled = |warmer_k: f64| {
        let mut state = surroundings.state(310.0, &[0.4]).unwrap();
        state.environment_k[0] = 310.0 + warmer_k;
        let found = solver.bound(&[0.6, 0.6], &state, &noisy(2), T).unwrap();
        assert!(found.relative_error < 1e-9, "{warmer_k:e}: {found:?}");
        found.sigma * (state.environment_k[0] - 310.0)
    };
    let limit = scaled(1e-5);
    for warmer_k in [1e-7, 1e-9, 1e-11] {
        let found = scaled(warmer_k);
        assert!((found / limit - 1.0).abs() < 1e-6, "{warmer_k:e}: {found:e} is not {limit:e}");
    }
}

/// A factor of the information and the covariance that follows from it whiten alike.
#[test]
fn both_factors_measure_the_same_ellipsoid() {
    let rows = [(800.0, 1.0), (950.0, 1.0), (1200.0, 1.5)];
    let (bands, surroundings) = scene(&rows);
    let state = surroundings.state(310.0, &[0.4]).unwrap();
    let unknowns = unknown(&[Nuisance::Temperature, Nuisance::Lighting]);
    let mut solver = PrecisionSolver::new(&bands, &surroundings, unknowns);
    let factor = solver.joint(&[0.6, 0.7, 0.9], &state, &noisy(3)).unwrap().joint.unwrap();
    let rows: Vec<f64> = (0..4).map(|i| factor.covariance(i / 2, i % 2)).collect();
    let covariance = JointBound::from_covariance(2, &rows).unwrap();
    for x in [[1.0, 0.0], [0.0, 1.0], [0.3, -0.02]] {
        let square = |bound: &JointBound| bound.whitened(&x).iter().map(|z| z * z).sum::<f64>();
        assert!((square(&factor) / square(&covariance) - 1.0).abs() < 1e-8);
    }
}

/// Three parameters: the covariance comes out as it went in, and whitens as its inverse by another algorithm.
#[test]
fn a_covariance_of_three_is_kept_and_whitens() {
    let rows = [4.0, 1.2, -0.6, 1.2, 9.0, 2.1, -0.6, 2.1, 1.0];
    let bound = JointBound::from_covariance(3, &rows).unwrap();
    for (i, wanted) in rows.iter().enumerate() {
        assert!((bound.covariance(i / 3, i % 3) - wanted).abs() < 1e-14, "{i}");
    }
    let inverse = nalgebra::DMatrix::from_row_slice(3, 3, &rows).try_inverse().unwrap();
    for x in [[1.0, 0.0, 0.0], [0.2, -1.0, 0.7], [0.0, 0.0, 1.0]] {
        let square: f64 = bound.whitened(&x).iter().map(|z| z * z).sum();
        let by_inverse: f64 = (0..9).map(|i| x[i / 3] * inverse[(i / 3, i % 3)] * x[i % 3]).sum();
        assert!((square / by_inverse - 1.0).abs() < 1e-12, "{x:?}");
    }
}

#[test]
fn what_is_no_bound_is_refused() {
    let (bands, surroundings) = scene(&[(800.0, 1.0)]);
    let state = surroundings.state(310.0, &[0.4]).unwrap();
    let mut solver = PrecisionSolver::new(&bands, &surroundings, unknown(&[Nuisance::Temperature]));
    assert!(solver.bound(&[0.5], &state, &noisy(1), V).is_err());
    assert!(solver.bound(&[0.5, 0.5], &state, &noisy(1), T).is_err());
    assert!(solver.bound(&[0.5], &State { lighting: vec![], ..state.clone() }, &noisy(1), T).is_err());
    assert!(solver.bound(&[0.5], &State { environment_k: vec![], ..state.clone() }, &noisy(1), T).is_err());
    assert!(solver.bound(&[0.5], &State { gain: f64::NAN, ..state.clone() }, &noisy(1), T).is_err());
    assert!(solver.bound(&[0.5], &state, &noisy(2), T).is_err());
    assert!(
        PrecisionSolver::new(&bands, &surroundings, unknown(&[])).joint(&[0.5], &state, &noisy(1)).is_err()
    );
    assert!(JointBound::from_covariance(2, &[1.0, 2.0, 2.0, 1.0]).is_err());
    assert!(JointBound::from_covariance(2, &[1.0, 0.1, 0.2, 1.0]).is_err());
    assert!(JointBound::from_covariance(0, &[]).is_err() && JointBound::from_sigma(f64::NAN).is_err());
}
