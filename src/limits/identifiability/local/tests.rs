use super::*;
use crate::fisher::Nuisance;
use crate::fisher::Nuisance::{EnvironmentTemperature, Gain, Lighting, Temperature};
use crate::fisher::precision::PrecisionSolver;
use crate::identifiability::multi::LocalMatrix;
use crate::scene::EnvironmentObject;

fn objects(temperatures_k: &[f64]) -> Vec<EnvironmentObject> {
    temperatures_k
        .iter()
        .map(|&temperature_k| EnvironmentObject { temperature_k, emissivity: None })
        .collect()
}

fn unknowns(nuisances: &[Nuisance]) -> Unknowns {
    Unknowns::new(nuisances.iter().copied()).unwrap()
}

fn spectra(bands: &Bands) -> [Vec<f64>; 3] {
    let nu = bands.nodes_cm1();
    let wave = |middle: f64, width: f64, period: f64| {
        nu.iter().map(|nu| middle + width * (nu / period).sin()).collect()
    };
    [wave(0.9, 0.05, 40.0), wave(0.7, 0.1, 70.0), wave(0.8, 0.08, 23.0)]
}

/// Two surroundings that differ by the last bit of their temperature: their shares are as free as the share and the
/// temperature of one, but for what the last bit changes. So it is for the distance, alone and in a matrix, and for the
/// bound of the target's temperature; with the gain unknown, where the derivatives are nearly dependent, too.
#[test]
fn the_last_bit_of_a_temperature_is_a_direction_of_its_own() {
    let bands = Bands::uniform(750.0, 1250.0, 20.0).unwrap();
    let next = f64::from_bits(300.0_f64.to_bits() + 1);
    let two = Surroundings::new(bands.nodes_cm1(), objects(&[300.0, next])).unwrap();
    let one = Surroundings::new(bands.nodes_cm1(), objects(&[300.0])).unwrap();
    let [target, other, third] = spectra(&bands);
    let (of_two, of_one) = (two.state(320.0, &[0.25, 0.5]).unwrap(), one.state(320.0, &[0.75]).unwrap());
    let counting = Counting { counts_per_radiance: 1e-15, var_added: vec![1e3; bands.len()] };
    for more in [&[][..], &[Temperature], &[Temperature, Gain]] {
        let free = |own: &[Nuisance]| unknowns(&[more, own].concat());
        let [free_two, free_one] = [free(&[Lighting]), free(&[Lighting, EnvironmentTemperature])];
        let mut solver = LocalSolver::new(&bands, &two, free_two.clone());
        let mut plain = LocalSolver::new(&bands, &one, free_one.clone());
        let found = solver.per_photon(&target, &other, &of_two, f64::INFINITY).unwrap();
        let exact = plain.per_photon(&target, &other, &of_one, f64::INFINITY).unwrap();
        let off = found.distance / exact.distance - 1.0;
        println!("{more:?}: {} off by {off:.1e}", found.distance);
        assert!(off.abs() < 1e-11 && found.dropped.is_empty() && found.relative_error < 1e-14, "{found:?}");
        let all = [&target[..], &other, &third];
        let mut matrix = LocalMatrix::new(&bands, &two, free_two.clone());
        let rows = matrix.with_counting(&all, &of_two, &counting).unwrap();
        let errors = matrix.relative_errors(&rows);
        for (i, own) in all.iter().enumerate() {
            for (j, other) in all.iter().enumerate().filter(|(j, _)| *j != i) {
                let exact = plain.with_counting(own, other, &of_one, &counting).unwrap().distance;
                assert!((rows[3 * i + j] / exact - 1.0).abs() < 1e-11 + errors[3 * i + j], "{i} {j}");
            }
        }
        if more.is_empty() {
            continue;
        }
        let sigma = |surroundings: &Surroundings, free: &Unknowns, state: &State| {
            PrecisionSolver::new(&bands, surroundings, free.clone())
                .bound(&target, state, &counting, Parameter::Temperature)
                .unwrap()
                .sigma
        };
        let ratio = sigma(&two, &free_two, &of_two) / sigma(&one, &free_one, &of_one);
        assert!((ratio - 1.0).abs() < 1e-10, "{ratio}");
    }
}

/// The same object twice changes nothing, and is said to.
#[test]
fn what_depends_exactly_is_dropped() {
    let bands = Bands::uniform(750.0, 1250.0, 20.0).unwrap();
    let two = Surroundings::new(bands.nodes_cm1(), objects(&[300.0, 300.0])).unwrap();
    let one = Surroundings::new(bands.nodes_cm1(), objects(&[300.0])).unwrap();
    let [target, other, _] = spectra(&bands);
    let free = unknowns(&[Temperature, Lighting]);
    let state = two.state(320.0, &[0.25, 0.5]).unwrap();
    let found =
        LocalSolver::new(&bands, &two, free.clone()).per_photon(&target, &other, &state, f64::INFINITY);
    let state = one.state(320.0, &[0.75]).unwrap();
    let exact = LocalSolver::new(&bands, &one, free).per_photon(&target, &other, &state, f64::INFINITY);
    let (found, exact) = (found.unwrap(), exact.unwrap());
    assert_eq!(found.dropped, [Parameter::Lighting(1)]);
    assert!((found.distance / exact.distance - 1.0).abs() < 1e-13, "{found:?} {exact:?}");
}

/// A target at 2 K sends 10⁻²⁰⁰ to 10⁻³⁷⁰ of the light of its surroundings, too little for a double, and yet its temperature
/// is a direction: ∂B/∂T ∝ ν³e⁻ˣ up to a factor that is 1 here. Against a fit of the columns divided by their largest.
#[test]
fn a_direction_is_one_however_faint() {
    let bands = Bands::uniform(700.0, 1300.0, 1.0).unwrap();
    let surroundings = Surroundings::new(bands.nodes_cm1(), objects(&[290.0])).unwrap();
    let [target, other, _] = spectra(&bands);
    let state = surroundings.state(2.0, &[0.5]).unwrap();
    let found = LocalSolver::new(&bands, &surroundings, unknowns(&[Temperature, Lighting]))
        .per_photon(&target, &other, &state, f64::INFINITY)
        .unwrap();
    let nu = bands.nodes_cm1();
    let mut lit = vec![0.0; nu.len()];
    crate::planck::photon_radiance_into(nu, 290.0, &mut lit);
    let signal: Vec<f64> = lit.iter().zip(&target).map(|(lit, e)| 0.5 * lit * (1.0 - e)).collect();
    let total: f64 = signal.iter().sum();
    let x = |nu: f64| crate::units::SECOND_RADIATION_CM_K * nu / 2.0;
    let column = |f: &dyn Fn(usize) -> f64| -> Vec<f64> {
        (0..nu.len()).map(|j| f(j) / (signal[j] * total).sqrt()).collect()
    };
    let mut columns = [
        column(&|j| target[j] * (nu[j] / nu[0]).powi(3) * (x(nu[0]) - x(nu[j])).exp()),
        column(&|j| (1.0 - target[j]) * lit[j]),
        column(&|j| 0.5 * (target[j] - other[j]) * lit[j]),
    ];
    for pivot in 0..2 {
        let (done, later) = columns.split_at_mut(pivot + 1);
        let own = &done[pivot];
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        for column in later {
            let share = dot(own, column) / dot(own, own);
            column.iter_mut().zip(own).for_each(|(value, own)| *value -= share * own);
        }
    }
    let exact = 0.5 * columns[2].iter().map(|value| value * value).sum::<f64>().sqrt();
    println!("{} {exact}, {}", found.distance, found.distance_no_nuisance);
    assert!((found.distance / exact - 1.0).abs() < 1e-10, "{} {exact}", found.distance);
    assert!(found.dropped.is_empty() && found.relative_error < 1e-14);
}

/// 1 − ΣV is what the factors leave of 1, to the last bit: at T = T₀(1 + 10⁻¹⁴) the contrast is (1 − ΣV)B + ΣV ∂B/∂T ΔT, and
/// the two terms are of one size.
#[test]
fn the_last_bit_of_the_lighting_counts() {
    let bands = Bands::uniform(750.0, 1250.0, 20.0).unwrap();
    let surroundings = Surroundings::new(bands.nodes_cm1(), objects(&[300.0, 300.0])).unwrap();
    let [target, other, _] = spectra(&bands);
    let lighting = [0.3, 0.7];
    let rest = crate::scene::unlit(&lighting);
    assert!(rest > 5e-17 && rest < 6e-17, "{rest}");
    for bits in [1, 4] {
        let warmer = f64::from_bits(300.0_f64.to_bits() + bits);
        let state = surroundings.state(warmer, &lighting).unwrap();
        let mut solver = LocalSolver::new(&bands, &surroundings, unknowns(&[]));
        let found = solver.per_photon(&target, &other, &state, f64::INFINITY).unwrap();
        let nu = bands.nodes_cm1();
        let (mut value, mut slope) = (vec![0.0; nu.len()], vec![0.0; nu.len()]);
        crate::planck::photon_radiance_and_slope_into(nu, 300.0, &mut value, &mut slope);
        let total: f64 = value.iter().sum();
        let square = |j: usize| {
            let contrast = rest * value[j] + slope[j] * (warmer - 300.0);
            ((other[j] - target[j]) * contrast).powi(2) / value[j] / total
        };
        let exact = 0.5 * (0..nu.len()).map(square).sum::<f64>().sqrt();
        assert!((found.distance / exact - 1.0).abs() < 1e-12, "{} {exact}", found.distance);
    }
    // At the very same temperature that bit is no contrast.
    let state = surroundings.state(300.0, &lighting).unwrap();
    let mut solver = LocalSolver::new(&bands, &surroundings, unknowns(&[]));
    let found = solver.per_photon(&target, &other, &state, f64::INFINITY).unwrap();
    assert_eq!((found.status, found.distance), (Status::Equilibrium, 0.0));
}
