use super::*;
use crate::efficiency::{Criteria, Efficiency, Verdict};
use hadar::atmosphere::Atmosphere;
use hadar::fisher::precision::JointBound;
use hadar::fisher::{Nuisance, Unknowns};
use hadar::ranging::air::{AirScene, AirUnknowns, SmoothEmissivity};
use hadar::scene::{EnvironmentObject, Surroundings};
use hadar::spectrum::Bands;

struct Fixture {
    bands: Bands,
    air: Atmosphere,
    surroundings: Surroundings,
    emissivity: Vec<f64>,
}

fn fixture() -> Fixture {
    let bands = Bands::uniform(780.0, 1240.0, 20.0).unwrap();
    let sky = EnvironmentObject { temperature_k: 250.0, emissivity: None };
    let emissivity =
        bands.nodes_cm1().iter().map(|nu| 0.92 - 0.1 * (-((nu - 1080.0) / 45.0).powi(2)).exp()).collect();
    Fixture {
        surroundings: Surroundings::new(bands.nodes_cm1(), vec![sky]).unwrap(),
        air: Atmosphere::embedded("midlatitude-summer").unwrap(),
        emissivity,
        bands,
    }
}

impl Fixture {
    fn solver(&self, nuisances: &[Nuisance], emissivity: Option<SmoothEmissivity>) -> AirSolver<'_> {
        let scene = AirScene {
            bands: &self.bands,
            surroundings: &self.surroundings,
            emissivity: &self.emissivity,
            air: &self.air,
        };
        let unknowns = Unknowns::new(nuisances.iter().copied()).unwrap();
        AirSolver::new(scene, AirUnknowns { scene: unknowns, air_temperature: None, emissivity }).unwrap()
    }

    fn state(&self, distance_m: f64) -> AirState {
        let target = self.surroundings.state(315.0, &[0.6]).unwrap();
        AirState { distance_m, target, air_k: 294.2 }
    }
}

const BOTH: [Nuisance; 2] = [Nuisance::Temperature, Nuisance::Lighting];

#[test]
fn counts_without_noise_give_the_distance_back() {
    let fixture = fixture();
    let counting = Counting { counts_per_radiance: 1e-10, var_added: vec![1e8; fixture.bands.len()] };
    for smooth in [None, Some(SmoothEmissivity { sigma: 0.01, correlation_cm1: 100.0 })] {
        let solver = fixture.solver(&BOTH, smooth);
        for z in [6.0, 40.0, 300.0, 2500.0] {
            let state = fixture.state(z);
            let fitter = AirFitter::new(&solver, &state, &counting).unwrap();
            let centres = fitter.values(&state);
            let fit = fitter.fit(&fitter.means(&state).unwrap(), &fixture.state(1.0), &centres).unwrap();
            let bound = solver.bound(&state, &counting).unwrap().sigma_m;
            assert!(
                (fit.distance_m - z).abs() < 1e-3 * bound && fit.converged && !fit.at_edge,
                "{z}: {fit:?}"
            );
        }
    }
}

/// At a level of 1e-3, each of three with the same seed.
#[test]
fn the_estimator_reaches_the_bound() {
    let fixture = fixture();
    let counting = Counting { counts_per_radiance: 1e-9, var_added: vec![1e9; fixture.bands.len()] };
    let smooth = SmoothEmissivity { sigma: 0.003, correlation_cm1: 150.0 };
    for (index, (nuisances, emissivity)) in
        [(&BOTH[..], None), (&BOTH[..], Some(smooth)), (&[], None)].iter().enumerate()
    {
        let solver = fixture.solver(nuisances, *emissivity);
        let state = fixture.state(120.0);
        let bound = solver.bound(&state, &counting).unwrap().sigma_m;
        let fitter = AirFitter::new(&solver, &state, &counting).unwrap();
        let fits = fitter.trials(&state, index as u32, 400, 11).unwrap();
        let lost: Vec<_> = fits.iter().filter(|fit| !fit.converged || fit.at_edge).take(3).collect();
        assert!(lost.is_empty(), "{nuisances:?}, bound {bound}: {lost:?}");
        let estimates: Vec<f64> = fits.iter().map(|fit| fit.distance_m).collect();
        let criteria = Criteria { level: 0.999, ..Criteria::default() };
        let found =
            Efficiency::of(&estimates, &[120.0], &JointBound::from_sigma(bound).unwrap(), &criteria).unwrap();
        let one = found.parameters[0];
        assert!(
            bound < 12.0 && one.ratio_interval.low < 1.0 && one.ratio_interval.high > 1.0,
            "{bound} {one:?}"
        );
        assert_ne!(one.verdict, Verdict::Biased, "{one:?}");
        // The same whatever the number of threads, and another with another stream.
        let again = fitter.trials(&state, index as u32, 3, 11).unwrap();
        assert_eq!(again.as_slice(), &fits[..3]);
    }
}

/// Without the sky that lights it, a target seems farther or nearer, noise or none.
#[test]
fn a_model_without_sky_is_biased_and_one_of_a_black_target_is_not() {
    let mut fixture = fixture();
    let counting = Counting { counts_per_radiance: 1e-10, var_added: vec![1e8; fixture.bands.len()] };
    let bias = |fixture: &Fixture| {
        let state = fixture.state(100.0);
        let means = {
            let full = fixture.solver(&BOTH, None);
            AirFitter::new(&full, &state, &counting).unwrap().means(&state).unwrap()
        };
        let solver = fixture.solver(&[Nuisance::Temperature], None);
        let dark = AirState { target: fixture.surroundings.state(315.0, &[0.0]).unwrap(), ..state.clone() };
        let fitter = AirFitter::new(&solver, &dark, &counting).unwrap();
        fitter.fit(&means, &dark, &fitter.values(&dark)).unwrap().distance_m - 100.0
    };
    assert!(bias(&fixture).abs() > 1.0, "{}", bias(&fixture));
    fixture.emissivity.fill(1.0);
    assert!(bias(&fixture).abs() < 1e-3, "{}", bias(&fixture));
}
