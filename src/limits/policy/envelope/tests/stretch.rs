//! What is proved of a stretch of distances against the worst cases at distances along it, each from its own bands.

use super::*;
use crate::atmosphere::Atmosphere;
use crate::planck;

/// Five wide bands of several nodes, before a camera behind some air.
struct Path {
    setting: Setting,
    open: Bands,
    air: Atmosphere,
}

impl Path {
    fn new(pair: [&str; 2], objects: usize, camera: &str, air: &str) -> Self {
        let edges: Vec<(f64, f64)> =
            (0..5).map(|i| (740.0 + 100.0 * f64::from(i), 840.0 + 100.0 * f64::from(i))).collect();
        let air = Atmosphere::embedded(air).unwrap();
        let spectra = |nu: &[f64]| {
            let mut radiance = vec![0.0; nu.len()];
            planck::photon_radiance_into(nu, 300.0, &mut radiance);
            let tau = air.transmittance(nu, 1000.0)?;
            Ok(vec![radiance.iter().zip(tau).map(|(b, tau)| b * tau).collect()])
        };
        let open =
            Bands::from_ranges(&edges).unwrap().integrated(air.wavenumbers_cm1(), 1e-2, spectra).unwrap();
        assert!(open.nodes_cm1().len() >= 20);
        let setting = Setting::new(open.clone(), pair, objects, camera);
        Self { setting, open, air }
    }

    fn bands_at(&self, distance_m: f64) -> Bands {
        let tau = self.air.transmittance(self.open.nodes_cm1(), distance_m).unwrap();
        self.open.transmitted_at_nodes(&tau)
    }

    fn worst_at(&self, distance_m: f64, ranges: &Ranges) -> WorstCase {
        let bands = self.bands_at(distance_m);
        let scene = EnvelopeScene { bands: &bands, ..self.setting.scene() };
        worst_case(&scene, ranges, &Effort { boxes: 3_000, ..Effort::default() }).unwrap()
    }

    fn proved(&self, stretch: [f64; 2], ranges: &Ranges, distance: f64, worst: &WorstCase) -> f64 {
        let [a, b] = stretch;
        let [near, middle, far] = [a, (a * b).sqrt(), b].map(|z| self.bands_at(z));
        let sag = self.open.transmitted_at_nodes(&self.air.sag(self.open.nodes_cm1(), stretch).unwrap());
        let scene = EnvelopeScene { bands: &near, ..self.setting.scene() };
        let stretch = Stretch { far: &far, middle: &middle, sag: &sag };
        let effort = Effort { boxes: 3_000, ..Effort::default() };
        lower_bound_along(&scene, &stretch, ranges, &known(distance, worst), &effort).unwrap().unwrap().0
    }
}

fn known(distance: f64, worst: &WorstCase) -> LeastKnown<'_> {
    LeastKnown { distance, state: &worst.state, nearest: &worst.nearest }
}

/// For every set of unknowns: no distance along a stretch is below what is proved, whatever it was told is attained; and
/// along short stretches little is lost.
#[test]
#[ignore = "15 s of processor time: .ci/evidence runs it"]
fn no_distance_along_a_stretch_is_below_its_bound() {
    stretches(1, 5);
}

/// The same for every third set.
#[test]
fn no_distance_along_a_stretch_is_below_its_bound_in_some_sets() {
    stretches(3, 1);
}

fn stretches(every: usize, least_short: u32) {
    let mut random = ChaCha8Rng::seed_from_u64(17);
    let pairs = [["0.95", "aluminium"], ["fabric", "kapton-tape"], ["silver", "0.4"], ["skin", "pmma"]];
    let airs = Atmosphere::names();
    let (mut short, mut tight, mut positive, mut all) = (0, 0, 0, 0);
    for (case, (nuisances, objects, total)) in sets().into_iter().enumerate().step_by(every) {
        let camera = ["ideal-pnrd", "flir-a325sc"][case % 2];
        let mut path = Path::new(pairs[case % 4], objects, camera, airs[case % airs.len()]);
        path.setting.unknowns = Unknowns::new(nuisances).unwrap().lighting_total(total).unwrap();
        path.setting.range.temperature_k = [200.0, 450.0];
        let t = random.random_range(290.0..320.0);
        let lit = 0.8 / objects as f64;
        let around: Vec<[f64; 2]> =
            (0..objects).map(|k| [250.0 + 12.0 * k as f64, 262.0 + 12.0 * k as f64]).collect();
        let ranges = Ranges::new([t, t + 6.0], vec![[0.3 * lit, lit]; objects], around).unwrap();
        for width in [1.01, 1.1] {
            // Not beyond a column of the table, where a transmittance may bend.
            let column = path.air.lengths_m()[random.random_range(0..5)];
            let near = column * random.random_range(1.0..2.5);
            let far = near * width;
            let along = [0.0, 0.4, 1.0].map(|share| path.worst_at(near * (far / near).powf(share), &ranges));
            let least = along.iter().min_by(|a, b| a.distance.total_cmp(&b.distance)).unwrap();
            for times in [1.0, 5.0] {
                let lower = path.proved([near, far], &ranges, times * least.distance, least);
                assert!(
                    lower <= least.distance * (1.0 + 1e-7),
                    "case {case}, {near} to {far} m, {times}: {lower:e} {:e}",
                    least.distance
                );
                all += 1;
                positive += u32::from(lower > 0.2 * least.distance);
                let known = least.certificate == Certificate::BranchAndBound && least.distance > 0.1;
                if times == 1.0 && width < 1.1 && known {
                    short += 1;
                    tight += u32::from(lower >= 0.98 * least.distance);
                }
            }
        }
    }
    println!("{positive} of {all} positive, {tight} of {short} tight");
    assert!(2 * positive > all && 2 * tight >= short && short > least_short);
}

#[test]
fn bands_that_let_more_through_from_afar_are_refused() {
    let path = Path::new(["0.95", "aluminium"], 1, "ideal-pnrd", "us-standard");
    let [near, far] = [100.0, 90.0].map(|z| path.bands_at(z));
    let scene = EnvelopeScene { bands: &near, ..path.setting.scene() };
    let worst = path.worst_at(100.0, &evening());
    let known = known(worst.distance, &worst);
    let stretch = Stretch { far: &far, middle: &far, sag: &far };
    let refused = lower_bound_along(&scene, &stretch, &evening(), &known, &Effort::default());
    assert!(matches!(refused, Err(crate::Error::OutOfRange { .. })), "{refused:?}");
    let stretch = Stretch { far: &near, middle: &near, sag: &Bands::uniform(700.0, 800.0, 10.0).unwrap() };
    let refused = lower_bound_along(&scene, &stretch, &evening(), &known, &Effort::default());
    assert!(matches!(refused, Err(crate::Error::Length { .. })), "{refused:?}");
}
