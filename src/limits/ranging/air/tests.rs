use super::*;
use crate::fisher::precision::Sight;
use crate::fisher::{Counting, Nuisance};
use crate::scene::EnvironmentObject;
use nalgebra::DMatrix;
use std::path::Path;

/// Air of Beer's law, with a coefficient that changes along the bands, m⁻¹.
fn coefficient(nu: f64) -> f64 {
    2e-4 + 3e-3 * (-((nu - 900.0) / 60.0).powi(2)).exp()
}

fn beer(nodes: &[f64]) -> Atmosphere {
    let mut text = "wavenumber_cm1,tau_10m,tau_100m,tau_1000m".to_owned();
    for nu in nodes {
        let tau = |z: f64| (-coefficient(*nu) * z).exp();
        text += &format!("\n{nu},{:e},{:e},{:e}", tau(10.0), tau(100.0), tau(1000.0));
    }
    Atmosphere::from_csv(&text, Path::new("beer.csv")).unwrap()
}

fn bands() -> Bands {
    Bands::uniform(760.0, 1240.0, 8.0).unwrap()
}

struct Fixture {
    bands: Bands,
    air: Atmosphere,
    surroundings: Surroundings,
    emissivity: Vec<f64>,
}

impl Fixture {
    fn new(emissivity: impl Fn(f64) -> f64, objects_k: &[f64]) -> Self {
        let bands = bands();
        let objects =
            objects_k.iter().map(|&temperature_k| EnvironmentObject { temperature_k, emissivity: None });
        Self {
            air: beer(bands.nodes_cm1()),
            surroundings: Surroundings::new(bands.nodes_cm1(), objects.collect()).unwrap(),
            emissivity: bands.nodes_cm1().iter().map(|nu| emissivity(*nu)).collect(),
            bands,
        }
    }

    fn solver(&self, unknowns: AirUnknowns) -> AirSolver<'_> {
        let scene = AirScene {
            bands: &self.bands,
            surroundings: &self.surroundings,
            emissivity: &self.emissivity,
            air: &self.air,
        };
        AirSolver::new(scene, unknowns).unwrap()
    }

    fn state(&self, distance_m: f64, temperature_k: f64, lighting: &[f64]) -> AirState {
        AirState {
            distance_m,
            target: self.surroundings.state(temperature_k, lighting).unwrap(),
            air_k: 290.0,
        }
    }

    fn counting(&self) -> Counting {
        Counting { counts_per_radiance: 2e-12, var_added: vec![3e6; self.bands.len()] }
    }
}

fn unknowns(nuisances: &[Nuisance]) -> AirUnknowns {
    let scene = Unknowns::new(nuisances.iter().copied()).unwrap();
    AirUnknowns { scene, ..AirUnknowns::default() }
}

fn near(a: f64, b: f64, share: f64) {
    assert!((a / b - 1.0).abs() <= share, "{a} {b}");
}

fn silica(nu: f64) -> f64 {
    0.93 - 0.12 * (-((nu - 1080.0) / 45.0).powi(2)).exp()
}

/// A grey target in Beer's air without surroundings: every number in closed form.
#[test]
fn a_grey_target_in_beers_air_has_a_closed_form() {
    let fixture = Fixture::new(|_| 0.9, &[]);
    let counting = fixture.counting();
    for (z, t) in [(12.0, 310.0), (60.0, 291.0), (400.0, 270.0)] {
        let state = fixture.state(z, t, &[]);
        let closed = |nu: f64| {
            let k = coefficient(nu);
            let tau = (-k * z).exp();
            let radiance = crate::planck::photon_radiance(nu, t);
            let air = crate::planck::photon_radiance(nu, 290.0);
            let per = 2e-12 * 8.0;
            let n = per * (tau * 0.9 * radiance + (1.0 - tau) * air);
            let dz = per * -k * tau * (0.9 * radiance - air);
            let dt = per * tau * 0.9 * crate::planck::photon_radiance_slope(nu, t);
            (dz, dt, n + 3e6)
        };
        let each: Vec<(f64, f64, f64)> = fixture.bands.nodes_cm1().iter().map(|nu| closed(*nu)).collect();
        let sum = |f: &dyn Fn(&(f64, f64, f64)) -> f64| each.iter().map(f).sum::<f64>();
        let [zz, zt, tt] = [
            sum(&|(dz, _, var)| dz * dz / var),
            sum(&|(dz, dt, var)| dz * dt / var),
            sum(&|(_, dt, var)| dt * dt / var),
        ];
        let alone = fixture.solver(unknowns(&[])).bound(&state, &counting).unwrap();
        near(alone.sigma_m, zz.powf(-0.5), 1e-10);
        for (found, (dz, _, var)) in alone.information_per_m2.iter().zip(&each) {
            // The elements themselves: a table of the depth keeps some 13 digits of 1e-3.
            assert!((found - dz * dz / var).abs() <= 1e-10 * zz, "{found} {}", dz * dz / var);
            near(*found, dz * dz / var, 1e-10);
        }
        let both = fixture.solver(unknowns(&[Nuisance::Temperature])).bound(&state, &counting).unwrap();
        near(both.sigma_m, (zz - zt * zt / tt).powf(-0.5), 1e-10);
        near(both.sigma_others_known_m, zz.powf(-0.5), 1e-10);
        let total: f64 = both.information_per_m2.iter().sum();
        near(total, both.sigma_m.powi(-2), 1e-12);
        assert!(both.relative_error < 1e-10 && both.sight == Sight::Seen && both.dropped.is_empty());
    }
}

#[test]
fn derivatives_are_those_of_the_signal() {
    let fixture = Fixture::new(silica, &[230.0, 288.0]);
    let solver = fixture.solver(unknowns(&[]));
    let scene = solver.scene();
    let modes =
        vec![fixture.bands.nodes_cm1().iter().map(|nu| 1e-2 * (nu / 100.0).sin()).collect::<Vec<f64>>()];
    let mut state = fixture.state(45.0, 305.0, &[0.5, 0.3]);
    state.target.gain = 1.1;
    let parameters = [
        AirParameter::Distance,
        AirParameter::Scene(Parameter::Temperature),
        AirParameter::Scene(Parameter::Lighting(0)),
        AirParameter::Scene(Parameter::Lighting(1)),
        AirParameter::Scene(Parameter::Gain),
        AirParameter::Scene(Parameter::EnvironmentTemperature(1)),
        AirParameter::AirTemperature,
        AirParameter::Emissivity(0),
    ];
    let at = |state: &AirState, shift: f64| {
        let emissivity: Vec<f64> =
            fixture.emissivity.iter().zip(&modes[0]).map(|(e, mode)| e + shift * mode).collect();
        scene.evaluate(&emissivity, state, &parameters, &modes, false).unwrap()
    };
    let found = at(&state, 0.0);
    for (i, parameter) in parameters.iter().enumerate() {
        let step = |sign: f64| {
            let mut moved = state.clone();
            let mut shift = 0.0;
            match parameter {
                AirParameter::Distance => moved.distance_m += sign * 1e-3,
                AirParameter::Scene(Parameter::Temperature) => moved.target.temperature_k += sign * 1e-3,
                AirParameter::Scene(Parameter::Lighting(k)) => moved.target.lighting[*k] += sign * 1e-3,
                AirParameter::Scene(Parameter::Gain) => moved.target.gain *= (sign * 1e-3).exp(),
                AirParameter::Scene(_) => moved.target.environment_k[1] += sign * 1e-3,
                AirParameter::AirTemperature => moved.air_k += sign * 1e-3,
                AirParameter::Emissivity(_) => shift = sign * 1e-3,
            }
            at(&moved, shift).signal
        };
        let (up, down) = (step(1.0), step(-1.0));
        let largest = found.columns[i].iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        for (w, column) in found.columns[i].iter().enumerate() {
            let slope = (up[w] - down[w]) / 2e-3;
            assert!((column - slope).abs() < 1e-5 * largest, "{parameter:?} {w}: {column} {slope}");
        }
    }
}

/// Of unknowns with priors, the bound by an inverse in a matrix library.
#[test]
fn unknowns_and_priors_are_those_of_the_whole_matrix() {
    let fixture = Fixture::new(silica, &[230.0]);
    let (state, counting) = (fixture.state(60.0, 312.0, &[0.7]), fixture.counting());
    let scene = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting, Nuisance::Gain])
        .unwrap()
        .prior(Nuisance::Gain, 0.01)
        .unwrap();
    let unknowns = AirUnknowns { scene, air_temperature: Some(Some(0.5)), emissivity: None };
    let solver = fixture.solver(unknowns);
    let scores = solver.scores(&state, &counting).unwrap();
    let n = scores.columns.len();
    let product = |a: &[f64], b: &[f64]| -> f64 {
        let noise = scores.counts.iter().zip(&scores.var_added).map(|(n, var)| n + var);
        a.iter().zip(b).zip(noise).map(|((a, b), var)| a * b / var).sum()
    };
    let scale: Vec<f64> = scores.columns.iter().map(|column| product(column, column).sqrt()).collect();
    let matrix = DMatrix::from_fn(n, n, |i, j| {
        let prior = scores.priors.get(i).copied().flatten().filter(|_| i == j).map_or(0.0, |s| 1.0 / (s * s));
        (product(&scores.columns[i], &scores.columns[j]) + prior) / scale[i] / scale[j]
    });
    let sigma = matrix.try_inverse().unwrap()[(n - 1, n - 1)].sqrt() / scale[n - 1];
    let bound = solver.bound(&state, &counting).unwrap();
    near(bound.sigma_m, sigma, 1e-6);
    assert_eq!(bound.unknowns.len(), 4);
    let total: f64 = bound.information_per_m2.iter().sum::<f64>() + bound.information_of_priors_per_m2;
    near(total, bound.sigma_m.powi(-2), 1e-12);
}

/// A smooth error in modes is the same as its covariance added to that of the noise.
#[test]
fn modes_of_the_emissivity_are_its_covariance() {
    let fixture = Fixture::new(silica, &[230.0]);
    let (state, counting) = (fixture.state(60.0, 312.0, &[0.7]), fixture.counting());
    let smooth = SmoothEmissivity { sigma: 0.02, correlation_cm1: 120.0 };
    let scene = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).unwrap();
    let known = AirUnknowns { scene: scene.clone(), ..AirUnknowns::default() };
    let solver = fixture.solver(AirUnknowns { emissivity: Some(smooth), ..known.clone() });
    let found = solver.bound(&state, &counting).unwrap();

    let plain = fixture.solver(known);
    let scores = plain.scores(&state, &counting).unwrap();
    let ones = [vec![1.0; fixture.bands.len()]];
    let change = plain
        .scene()
        .evaluate(&fixture.emissivity, &state, &[AirParameter::Emissivity(0)], &ones, false)
        .unwrap();
    let reach: Vec<f64> = change.columns[0].iter().map(|x| 2e-12 * x).collect();
    let centres = fixture.bands.nodes_cm1();
    let covariance = DMatrix::from_fn(reach.len(), reach.len(), |i, j| {
        let x = 3.55 * (centres[i] - centres[j]).abs() / 120.0;
        let own = if i == j { scores.counts[i] + scores.var_added[i] } else { 0.0 };
        own + 4e-4 * (1.0 + x + x * x / 3.0) * (-x).exp() * reach[i] * reach[j]
    });
    let columns = DMatrix::from_fn(reach.len(), 3, |w, i| scores.columns[i][w]);
    let scale: Vec<f64> = (0..3).map(|i| columns.column(i).norm()).collect();
    let factor = covariance.cholesky().unwrap();
    let solved = factor.solve(&columns);
    let information =
        DMatrix::from_fn(3, 3, |i, j| columns.column(i).dot(&solved.column(j)) / scale[i] / scale[j]);
    let sigma = information.try_inverse().unwrap()[(2, 2)].sqrt() / scale[2];
    // What is left out is 1e-4 of the noise of a band.
    near(found.sigma_m, sigma, 2e-4);
    let known = plain.bound(&state, &counting).unwrap();
    assert!(found.sigma_m > 1.5 * known.sigma_m, "{} {}", found.sigma_m, known.sigma_m);
    // Hardly any error at all is none.
    let hardly = AirUnknowns {
        scene: Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).unwrap(),
        air_temperature: None,
        emissivity: Some(SmoothEmissivity { sigma: 1e-9, ..smooth }),
    };
    near(fixture.solver(hardly).bound(&state, &counting).unwrap().sigma_m, known.sigma_m, 1e-4);
}

#[test]
fn the_modes_are_the_covariance() {
    let bands = bands();
    let smooth = SmoothEmissivity { sigma: 0.05, correlation_cm1: 90.0 };
    let modes = SmoothModes::new(&bands, smooth).unwrap();
    let centres = bands.nodes_cm1();
    for (i, j) in [(0, 0), (3, 3), (10, 14), (0, 60), (20, 31)] {
        let sum: f64 = modes.all().iter().map(|mode| mode[i] * mode[j]).sum();
        let x = 3.55 * (centres[i] - centres[j]).abs() / 90.0;
        let exact = 0.0025 * (1.0 + x + x * x / 3.0) * (-x).exp();
        assert!((sum - exact).abs() < 1e-14, "{i} {j}: {sum} {exact}");
    }
    let few = modes.that_matter(&vec![1.0; bands.len()]).len();
    let more = modes.that_matter(&vec![30.0; bands.len()]).len();
    assert!(0 < few && few < more && more < bands.len(), "{few} {more}");
    assert!(modes.that_matter(&vec![0.0; bands.len()]).is_empty());
    assert!(SmoothModes::new(&bands, SmoothEmissivity { sigma: 0.0, ..smooth }).is_err());
    assert!(SmoothModes::new(&bands, SmoothEmissivity { correlation_cm1: f64::NAN, ..smooth }).is_err());
}

#[test]
fn what_looks_like_the_air_has_no_distance() {
    let fixture = Fixture::new(silica, &[290.0]);
    let counting = fixture.counting();
    let bound = |t: f64, nuisances: &[Nuisance]| {
        fixture.solver(unknowns(nuisances)).bound(&fixture.state(80.0, t, &[1.0]), &counting).unwrap()
    };
    let blind = bound(290.0, &[]);
    assert_eq!((blind.sight, blind.sigma_m), (Sight::Unchanged, f64::INFINITY));
    assert!(blind.information_per_m2.iter().all(|information| *information == 0.0));
    assert!(blind.blind_direction.is_empty());
    // As it comes near to that, the error grows as the inverse of the difference, without a jump.
    let [far, near_by] = [1e-3, 1e-9].map(|by| bound(290.0 + by, &[]).sigma_m);
    near(far / near_by, 1e-6, 1e-4);
    // One band cannot tell a warmer target from a nearer one.
    let one =
        Bands::uniform(900.0, 904.0, 8.0).unwrap_or_else(|_| Bands::from_ranges(&[(896.0, 904.0)]).unwrap());
    let air = beer(&[800.0, 850.0, 880.0, 900.0, 920.0, 950.0]);
    let surroundings = Surroundings::new(one.nodes_cm1(), Vec::new()).unwrap();
    let emissivity = vec![0.9; one.nodes_cm1().len()];
    let scene = AirScene { bands: &one, surroundings: &surroundings, emissivity: &emissivity, air: &air };
    let solver = AirSolver::new(scene, unknowns(&[Nuisance::Temperature])).unwrap();
    let state = AirState { distance_m: 80.0, target: surroundings.state(310.0, &[]).unwrap(), air_k: 290.0 };
    let counting = Counting { counts_per_radiance: 2e-12, var_added: Vec::new() };
    let found = solver.bound(&state, &counting).unwrap();
    assert_eq!((found.sight, found.sigma_m), (Sight::Imitated, f64::INFINITY));
    let [(AirParameter::Scene(Parameter::Temperature), per_metre)] = found.blind_direction.as_slice() else {
        panic!("{:?}", found.blind_direction)
    };
    // Along it the counts stand still: 1 m farther, and as much warmer.
    let counts = |z: f64, t: f64| {
        let state = AirState { distance_m: z, target: surroundings.state(t, &[]).unwrap(), air_k: 290.0 };
        scene.evaluate(&emissivity, &state, &[], &[], false).unwrap().signal[0]
    };
    let (along, across) = (counts(80.01, 310.0 + 0.01 * per_metre), counts(80.01, 310.0));
    let here = counts(80.0, 310.0);
    assert!((along - here).abs() < 1e-4 * (across - here).abs(), "{along} {across} {here}");
}

/// Exhaustive search over all choices of a few bands.
#[test]
fn best_bands_are_the_best_of_all_choices() {
    let bands = Bands::uniform(760.0, 1240.0, 40.0).unwrap();
    let air = beer(bands.nodes_cm1());
    let sky = EnvironmentObject { temperature_k: 230.0, emissivity: None };
    let surroundings = Surroundings::new(bands.nodes_cm1(), vec![sky]).unwrap();
    let emissivity: Vec<f64> = bands.nodes_cm1().iter().map(|nu| silica(*nu)).collect();
    let scene = AirScene { bands: &bands, surroundings: &surroundings, emissivity: &emissivity, air: &air };
    let state =
        AirState { distance_m: 60.0, target: surroundings.state(312.0, &[0.7]).unwrap(), air_k: 290.0 };
    let counting = Counting { counts_per_radiance: 2e-12, var_added: vec![3e6; bands.len()] };
    for smooth in [None, Some(SmoothEmissivity { sigma: 0.01, correlation_cm1: 150.0 })] {
        let mut free = unknowns(&[Nuisance::Temperature, Nuisance::Lighting]);
        free.emissivity = smooth;
        let solver = AirSolver::new(scene, free).unwrap();
        let all = solver.bound(&state, &counting).unwrap().sigma_m;
        for k in [3, 4, 5] {
            let found = solver.best_bands(&state, &counting, k).unwrap();
            near(found.sigma_all_bands_m, all, 1e-9);
            // Bands that are not chosen are read with a noise that hides all.
            let with = |chosen: &dyn Fn(usize) -> bool| {
                let var = (0..bands.len()).map(|w| if chosen(w) { 3e6 } else { 1e40 }).collect();
                solver.bound(&state, &Counting { var_added: var, ..counting.clone() }).unwrap().sigma_m
            };
            let own = with(&|w| found.bands.contains(&w));
            near(found.sigma_m, own, 2e-3);
            let mut least = f64::INFINITY;
            for set in 0u32..1 << bands.len() {
                if set.count_ones() as usize == k {
                    least = least.min(with(&|w| set >> w & 1 == 1));
                }
            }
            assert!(found.sigma_least_m <= least * (1.0 + 1e-3), "{k}: {} {least}", found.sigma_least_m);
            assert!(!found.exact || own <= least * (1.0 + 2e-3), "{k}: {own} {least}");
            assert!(own <= 1.05 * least && found.sigma_least_m <= found.sigma_m);
        }
        let error = solver.best_bands(&state, &counting, 2).unwrap_err().to_string();
        assert!(error.starts_with("number of bands is 2; it must be at least 3"), "{error}");
        assert!(solver.best_bands(&state, &counting, 0).is_err());
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let fixture = Fixture::new(silica, &[230.0]);
    let (solver, counting) = (fixture.solver(unknowns(&[])), fixture.counting());
    let error = |state: AirState| solver.bound(&state, &counting).unwrap_err().to_string();
    let state = |z: f64| fixture.state(z, 300.0, &[0.5]);
    assert!(error(state(0.0)).starts_with("distance is 0 m; it must be "));
    assert!(error(state(-3.0)).contains("distance") && error(state(f64::NAN)).contains("finite"));
    assert!(error(state(2000.0)).contains("at most 1000 m, the longest path"));
    assert!(error(AirState { air_k: 0.0, ..state(50.0) }).starts_with("temperature of the air"));
    let other = Counting { var_added: vec![1.0; 3], ..counting.clone() };
    assert!(solver.bound(&state(50.0), &other).is_err());
    // More than can be taken apart, or chosen beside.
    let many = Bands::uniform(700.0, 1300.0, 0.5).unwrap();
    let smooth = SmoothEmissivity { sigma: 0.1, correlation_cm1: 1.0 };
    let refused = SmoothModes::new(&many, smooth).unwrap_err().to_string();
    assert!(refused.starts_with("number of bands is 1201; it must be at most 1000"), "{refused}");
    let prior = AirUnknowns { air_temperature: Some(Some(-1.0)), ..AirUnknowns::default() };
    assert!(AirSolver::new(*solver.scene(), prior).is_err());
}
