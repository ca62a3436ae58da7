use super::*;
use crate::efficiency::{Criteria, Efficiency, Verdict};
use hadar::fisher::Nuisance;
use hadar::planck::occupancy;
use hadar::scene::EnvironmentObject;
use hadar::units::SECOND_RADIATION_CM_K;

struct Setup {
    bands: Bands,
    surroundings: Surroundings,
    emissivity: Vec<f64>,
    counting: Counting,
}

impl Setup {
    fn new(nodes_cm1: &[f64], emissivity: impl Fn(f64) -> f64, counts_per_radiance: f64, var: f64) -> Self {
        let bands = Bands::from_rows(nodes_cm1.iter().map(|nu| (*nu, 1.0))).unwrap();
        let object = EnvironmentObject { temperature_k: 293.15, emissivity: None };
        let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object]).unwrap();
        let var_added = if var > 0.0 { vec![var; bands.len()] } else { Vec::new() };
        let emissivity = nodes_cm1.iter().map(|nu| emissivity(*nu)).collect();
        Self { bands, surroundings, emissivity, counting: Counting { counts_per_radiance, var_added } }
    }

    /// Reflecting between 800 and 970 cm⁻¹, as silicon carbide does.
    fn carbide(counts_per_radiance: f64, var: f64) -> Self {
        let nodes: Vec<f64> = (0..27).map(|i| 720.0 + 20.0 * f64::from(i)).collect();
        let emissivity = |nu: f64| if (800.0..970.0).contains(&nu) { 0.2 } else { 0.85 };
        Self::new(&nodes, emissivity, counts_per_radiance, var)
    }

    fn scene(&self) -> ThermometryScene<'_> {
        ThermometryScene {
            bands: &self.bands,
            surroundings: &self.surroundings,
            emissivity: &self.emissivity,
            range: StateRange::default(),
            counting: &self.counting,
        }
    }

    fn state(&self, temperature_k: f64) -> State {
        self.surroundings.state(temperature_k, &[0.5]).unwrap()
    }
}

fn both() -> Unknowns {
    Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).unwrap()
}

/// In one band e n(T) + (1 − e)V n(T₀) = e′ n(T′) + … with occupancies n is solved by hand: T′ = c₂ν/ln(1 + 1/n).
#[test]
fn conventional_readings_of_one_band_are_closed_forms() {
    let (nu, e, v, own) = (1000.0, 0.7, 0.5, 330.0);
    let setup = Setup::new(&[nu], |_| e, 1e-13, 0.0);
    let scene = setup.scene();
    let counts = |t: f64| hadar::sum::sum(&scene.means(&setup.state(t)).unwrap());
    let mean = |t: f64| e * occupancy(nu, t) + (1.0 - e) * v * occupancy(nu, 293.15);
    let kelvin = |n: f64| SECOND_RADIATION_CM_K * nu / (1.0 / n).ln_1p();
    let read = |how: &Conventional, t: f64| match scene.reading(how, counts(t)) {
        Reading::Kelvin(reading) => reading,
        other => panic!("{other:?}"),
    };
    let fixed = Conventional::with_surroundings(0.95, &setup.surroundings).unwrap();
    let expected = kelvin((mean(own) - 0.05 * occupancy(nu, 293.15)) / 0.95);
    assert!((read(&fixed, own) / expected - 1.0).abs() < 1e-13);
    let manual = Conventional::calibrated(&scene, &setup.state(303.15)).unwrap();
    assert!((manual.emissivity * occupancy(nu, 303.15) / mean(303.15) - 1.0).abs() < 1e-13);
    assert!((read(&manual, 303.15) - 303.15).abs() < 1e-9);
    let expected = kelvin(mean(own) / manual.emissivity);
    assert!((read(&manual, own) / expected - 1.0).abs() < 1e-13);
    // The scattered part stays behind: the hotter, the more it reads too cold.
    assert!(own - read(&manual, own) > 1.0 && 400.0 - read(&manual, 400.0) > own - read(&manual, own));
}

/// A grey body of just that emissivity amid black surroundings is read rightly in any number of bands.
#[test]
fn an_imager_is_right_where_its_assumptions_hold() {
    let setup = Setup::new(&[700.0, 900.0, 1300.0], |_| 0.95, 1e-13, 0.0);
    let scene = setup.scene();
    let fixed = Conventional::with_surroundings(0.95, &setup.surroundings).unwrap();
    for t in [250.0, 293.15, 310.0, 900.0] {
        let state = setup.surroundings.state(t, &[1.0]).unwrap();
        let counts = hadar::sum::sum(&scene.means(&state).unwrap());
        let Reading::Kelvin(reading) = scene.reading(&fixed, counts) else { panic!("{t}") };
        assert!((reading / t - 1.0).abs() < 1e-13, "{t}: {reading}");
    }
}

#[test]
fn a_sum_without_a_temperature_is_said_so() {
    let setup = Setup::carbide(1e-13, 0.0);
    let scene = setup.scene();
    let fixed = Conventional::with_surroundings(0.95, &setup.surroundings).unwrap();
    for dark in [0.0, -5.0, f64::NEG_INFINITY, f64::NAN] {
        assert_eq!(scene.reading(&fixed, dark), Reading::TooDark);
    }
    for bright in [1e300, f64::INFINITY] {
        assert_eq!(scene.reading(&fixed, bright), Reading::TooBright);
    }
    assert!(Conventional::with_surroundings(0.0, &setup.surroundings).is_err());
    assert!(Conventional::with_surroundings(1.1, &setup.surroundings).is_err());
}

fn efficiency(setup: &Setup, unknowns: &Unknowns, run: Run) -> Efficiency {
    let (scene, state) = (setup.scene(), setup.state(320.0));
    let bound = scene.bound(unknowns, &state).unwrap().joint.unwrap();
    let fits = scene.fits(unknowns, &state, run).unwrap();
    assert_eq!((fits.unconverged, fits.at_edge), (0, 0));
    Efficiency::of(&fits.estimates, &fits.truth, &bound, &Criteria { together: 12, ..Criteria::default() })
        .unwrap()
}

/// Many photons: the variance is the bound's within 4.5 of its deviations (7e-6 each), with shot noise alone, with
/// electronic noise, and with a prior that tells about as much as the counts do. (With 200000 trials of each, once:
/// 0.9945 to 1.0032 ± 0.0062.)
#[test]
fn maximum_likelihood_reaches_the_bound() {
    let trials = 10_000;
    let within = 4.5 * (2.0 / trials as f64).sqrt();
    let shot = Setup::carbide(1e-15, 0.0);
    let noisy = Setup::carbide(1e-14, 1e7);
    let prior = both().prior(Nuisance::Lighting, 0.01).unwrap();
    let temperature = Unknowns::new([Nuisance::Temperature]).unwrap();
    let cases = [(&shot, &temperature), (&shot, &both()), (&noisy, &both()), (&noisy, &prior)];
    for (index, (setup, unknowns)) in cases.into_iter().enumerate() {
        let found = efficiency(setup, unknowns, Run { index: index as u32, trials, seed: 3 });
        for one in &found.parameters {
            assert!((one.ratio - 1.0).abs() < within, "{index}: {one:?}");
            assert_eq!(one.verdict, Verdict::Reaches, "{index}: {one:?}");
        }
        assert!((found.joint.ratio - 1.0).abs() < within, "{index}: {:?}", found.joint);
    }
    // What the prior tells: without it the bound is clearly above.
    let sigma =
        |unknowns: &Unknowns| noisy.scene().bound(unknowns, &noisy.state(320.0)).unwrap().each[0].sigma;
    let [free, prior, held] = [&both(), &prior, &temperature].map(sigma);
    assert!(prior < 0.99 * free && held < 0.99 * prior, "{free} {prior} {held}");
}

/// A nearly grey target hides its lighting: the range 0 ≤ V ≤ 1 then tells more than the counts, estimates pile up at
/// its edges, and their variance is below a bound that is not theirs.
#[test]
fn a_range_that_holds_the_estimates_is_reported() {
    let nodes: Vec<f64> = (0..27).map(|i| 720.0 + 20.0 * f64::from(i)).collect();
    let setup = Setup::new(&nodes, |nu| 0.95 + 1e-5 * (nu - 980.0), 1e-14, 1e7);
    let (scene, state) = (setup.scene(), setup.state(310.0));
    let bound = scene.bound(&both(), &state).unwrap();
    assert!(bound.each[1].sigma > 1.0, "{bound:?}");
    let fits = scene.fits(&both(), &state, Run { index: 0, trials: 2000, seed: 4 }).unwrap();
    assert!(fits.at_edge > 1000, "{}", fits.at_edge);
    let found =
        Efficiency::of(&fits.estimates, &fits.truth, &bound.joint.unwrap(), &Criteria::default()).unwrap();
    assert_eq!(found.parameters[0].verdict, Verdict::Below);
    assert!(fits.of(Parameter::Lighting(0)).iter().all(|v| (0.0..=1.0).contains(v)));
}

/// Spectra depend on seed, run and trial alone, and estimates not on where the fit starts.
#[test]
fn neither_threads_nor_starts_change_an_estimate() {
    let setup = Setup::carbide(1e-16, 0.0);
    let (scene, state) = (setup.scene(), setup.state(320.0));
    let on = |threads: usize, trials: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| scene.fits(&both(), &state, Run { index: 2, trials, seed: 5 }).unwrap())
    };
    let (one, three) = (on(1, 200), on(3, 200));
    assert_eq!(one, three);
    assert_eq!(on(3, 70).estimates, one.estimates[..140]);
    let range = StateRange::default();
    let mut fits = MaximumLikelihood::new(
        scene.bands,
        scene.surroundings,
        both(),
        range,
        setup.counting.counts_per_radiance,
        Statistics::Poisson,
    )
    .unwrap();
    let draws = scene.draws(&state).unwrap();
    let sigma = scene.bound(&both(), &state).unwrap().each[0].sigma;
    let mut counts = vec![0.0; setup.bands.len()];
    for trial in 0..200 {
        draws.draw_into(&mut generator(5, 2 * STREAMS + trial as u64), &mut counts);
        let fit = fits.fit(scene.emissivity, &counts, &state, std::slice::from_ref(&state));
        // Fits end within 1e-9 of the largest ln L: √(2e-9) deviations of the bound.
        assert!((fit.state.temperature_k - one.estimates[2 * trial]).abs() < 1e-4 * sigma, "{trial}");
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let setup = Setup::carbide(1e-14, 0.0);
    let (scene, state) = (setup.scene(), setup.state(320.0));
    let run = Run { index: 0, trials: 2, seed: 1 };
    assert!(scene.fits(&Unknowns::default(), &state, run).is_err());
    let narrow = StateRange { temperature_k: [300.0, 310.0], ..StateRange::default() };
    assert!(ThermometryScene { range: narrow, ..scene }.fits(&both(), &state, run).is_err());
    assert!(ThermometryScene { emissivity: &[0.5], ..scene }.means(&state).is_err());
    let bright = Counting { counts_per_radiance: 1e10, var_added: Vec::new() };
    assert!(ThermometryScene { counting: &bright, ..scene }.fits(&both(), &state, run).is_err());
    assert!(scene.means(&State { lighting: vec![], ..state.clone() }).is_err());
}

/// Spectra drawn once for two fits, one of them with a prior, and two imagers: each reads what it reads alone.
#[test]
fn spectra_drawn_once_for_all_are_those_drawn_for_each() {
    let setup = Setup::carbide(1e-15, 50.0);
    let (scene, state) = (setup.scene(), setup.state(330.0));
    let run = Run { index: 3, trials: 40, seed: 9 };
    let with_prior = both().prior(Nuisance::Lighting, 0.05).unwrap();
    let unknowns = [&Unknowns::new([Nuisance::Temperature]).unwrap(), &with_prior];
    let imagers = [
        &Conventional::with_surroundings(0.95, &setup.surroundings).unwrap(),
        &Conventional::calibrated(&scene, &state).unwrap(),
    ];
    let (fits, readings) = scene.read(&unknowns, &imagers, &state, run).unwrap();
    for (unknowns, fits) in unknowns.iter().zip(&fits) {
        assert_eq!(*fits, scene.fits(unknowns, &state, run).unwrap());
        assert_eq!(fits.estimates.len(), 40 * fits.parameters.len());
    }
    for (imager, readings) in imagers.iter().zip(&readings) {
        assert_eq!(*readings, scene.readings(imager, &state, run).unwrap());
        assert_eq!(readings.len(), 40);
    }
    assert_ne!(fits[0].estimates[..4], fits[1].estimates[..4]);
}
