//! The worst case found without the envelope's bounds, sources or descents: all of scene and alternative's state as a point
//! of a unit cube, the distance from Planck's function band by band, and damped Gauss–Newton steps with numerical
//! derivatives from many random points.

use super::{Setting, sets};
use crate::fisher::{Nuisance, Unknowns};
use crate::planck::photon_radiance;
use crate::policy::envelope::{Certificate, Effort, Ranges, worst_case};
use crate::spectrum::Bands;
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};

const BANDS: [(f64, f64); 7] = [
    (740.0, 60.0),
    (810.0, 60.0),
    (890.0, 60.0),
    (960.0, 60.0),
    (1040.0, 60.0),
    (1130.0, 60.0),
    (1220.0, 60.0),
];
/// Starts and steps of the descents.
const STARTS: usize = 12;
const STEPS: usize = 60;

/// A setting with random spectra, and the meaning of the coordinates.
struct Brute {
    setting: Setting,
    objects: usize,
    scene: Ranges,
}

impl Brute {
    fn has(&self, nuisance: Nuisance) -> bool {
        self.setting.unknowns.contains(nuisance)
    }

    fn dimensions(&self) -> usize {
        3 + 4 * self.objects
    }

    /// √(N+v) − √(N′+v): T, G, T′, and of each object Tₖ, Vₖ, Tₖ′, Vₖ′.
    fn rows(&self, x: &[f64]) -> Vec<f64> {
        let within = |[low, high]: [f64; 2], x: f64| low + (high - low) * x;
        let geometric = |[low, high]: [f64; 2], x: f64| low * (high / low).powf(x);
        let t = within(self.scene.temperature_k(), x[0]);
        let gain = if self.has(Nuisance::Gain) { (28.0 * x[1] - 14.0).exp() } else { 1.0 };
        let own_t = self.has(Nuisance::Temperature);
        let t_other = if own_t { geometric(self.setting.range.temperature_k, x[2]) } else { t };
        let column = |which: usize| (0..self.objects).map(move |k| x[3 + 4 * k + which]);
        let around: Vec<f64> =
            column(0).zip(self.scene.environment_k()).map(|(x, r)| within(*r, x)).collect();
        let lit: Vec<f64> = column(1).zip(self.scene.lighting()).map(|(x, r)| within(*r, x)).collect();
        let own_k = self.has(Nuisance::EnvironmentTemperature);
        let around_other: Vec<f64> =
            if own_k { column(2).map(|x| geometric([0.1, 1e6], x)).collect() } else { around.clone() };
        let mut lit_other = lit.clone();
        if self.has(Nuisance::Lighting) {
            lit_other = column(3).collect();
            let sum: f64 = lit_other.iter().sum();
            let scale = match self.setting.unknowns.known_lighting_total() {
                Some(total) => total / sum.max(1e-300),
                None => (1.0 / sum).min(1.0),
            };
            lit_other.iter_mut().for_each(|v| *v *= scale);
        }
        let kappa = self.setting.counting.counts_per_radiance;
        let counts = |band: usize, e: f64, t: f64, v: &[f64], around: &[f64]| {
            let (nu, width) = BANDS[band];
            let scattered: f64 = v.iter().zip(around).map(|(v, t)| v * photon_radiance(nu, *t)).sum();
            kappa * width * (e * photon_radiance(nu, t) + (1.0 - e) * scattered)
        };
        let row = |band: usize| {
            let v = self.setting.counting.var_added(band);
            let own = counts(band, self.setting.emissivity[band], t, &lit, &around);
            let other =
                gain * counts(band, self.setting.alternative[band], t_other, &lit_other, &around_other);
            (own + v).sqrt() - (other + v).sqrt()
        };
        (0..BANDS.len()).map(row).collect()
    }

    fn distance(&self, x: &[f64]) -> f64 {
        self.rows(x).iter().map(|r| r * r).sum::<f64>().sqrt()
    }

    /// Where damped steps from a point end.
    fn descend(&self, mut x: Vec<f64>) -> f64 {
        let (n, mut damping, mut best) = (self.dimensions(), 1e-3, self.distance(&x));
        for _ in 0..STEPS {
            let rows = DVector::from_vec(self.rows(&x));
            let mut slopes = DMatrix::zeros(BANDS.len(), n);
            for i in 0..n {
                let step = 1e-6;
                let ends = [-step, step].map(|step| {
                    let mut moved = x.clone();
                    moved[i] = (moved[i] + step).clamp(0.0, 1.0);
                    (moved[i], DVector::from_vec(self.rows(&moved)))
                });
                slopes.set_column(i, &((&ends[1].1 - &ends[0].1) / (ends[1].0 - ends[0].0)));
            }
            let pull = slopes.transpose() * &rows;
            for i in 0..n {
                // What is at an end and pulled beyond it stays there.
                if (x[i] <= 0.0 && pull[i] > 0.0) || (x[i] >= 1.0 && pull[i] < 0.0) {
                    slopes.fill_column(i, 0.0);
                }
            }
            let normal = slopes.transpose() * &slopes;
            let pull = slopes.transpose() * &rows;
            let mut moved_at_all = false;
            for _ in 0..8 {
                let mut damped = normal.clone();
                for i in 0..n {
                    damped[(i, i)] += damping * normal[(i, i)] + 1e-300;
                }
                let Some(step) = damped.lu().solve(&pull) else { break };
                let moved: Vec<f64> =
                    x.iter().zip(step.iter()).map(|(x, s)| (x - s).clamp(0.0, 1.0)).collect();
                let distance = self.distance(&moved);
                if distance < best {
                    (x, best, damping, moved_at_all) = (moved, distance, damping * 0.1, true);
                    break;
                }
                damping *= 10.0;
            }
            if !moved_at_all {
                break;
            }
        }
        best
    }

    fn least(&self, random: &mut ChaCha8Rng) -> f64 {
        let starts: Vec<Vec<f64>> = (0..STARTS)
            .map(|_| {
                let mut x: Vec<f64> = (0..self.dimensions()).map(|_| random.random()).collect();
                // Near the scene's own temperatures and a gain of 1, more or less.
                let near =
                    |t: f64, [low, high]: [f64; 2]| ((t / low).ln() / (high / low).ln()).clamp(0.0, 1.0);
                let mut about = |t: f64| t * random.random_range(-0.4..0.4f64).exp();
                x[2] = near(about(300.0), self.setting.range.temperature_k);
                (0..self.objects).for_each(|k| x[5 + 4 * k] = near(about(280.0), [0.1, 1e6]));
                x[1] = 0.5 + 0.05 * (x[1] - 0.5);
                x
            })
            .collect();
        starts.into_iter().map(|x| self.descend(x)).fold(f64::INFINITY, f64::min)
    }
}

/// For every set of unknowns: no state of any scene is below what is proved, and what is attained is as near as anything
/// that many descents find.
#[test]
fn descents_from_anywhere_end_nowhere_below_the_bound() {
    let mut random = ChaCha8Rng::seed_from_u64(17);
    let mut proofs = 0;
    for (case, (nuisances, objects, total)) in sets().into_iter().enumerate() {
        let camera = ["flir-a325sc", "ideal-pnrd"][case % 2];
        let bands = Bands::from_rows(BANDS).unwrap();
        let mut setting = Setting::new(bands, ["0.9", "0.3"], objects, camera);
        setting.emissivity = BANDS.iter().map(|_| random.random_range(0.7..0.98)).collect();
        setting.alternative = BANDS.iter().map(|_| random.random_range(0.2..0.9)).collect();
        setting.range.temperature_k = [150.0, 900.0];
        setting.unknowns = Unknowns::new(nuisances.clone()).unwrap().lighting_total(total).unwrap();
        let around = vec![[265.0, 292.0]; objects];
        let scene = Ranges::new([300.0, 308.0], vec![[0.1, 0.3]; objects], around).unwrap();
        let effort = Effort { boxes: 2000, ..Effort::default() };
        let worst = worst_case(&setting.scene(), &scene, &effort).unwrap();
        let brute = Brute { setting, objects, scene };
        let least = brute.least(&mut random);
        let lower = worst.lower_bound.unwrap();
        assert!(lower <= least * (1.0 + 1e-9), "{nuisances:?} {objects} {least} {worst:?}");
        assert!(worst.distance <= least * 1.0102, "{nuisances:?} {objects} {least} {worst:?}");
        // The search for the nearest state in the worst scene, and these descents, agree.
        let proved = worst.certificate == Certificate::BranchAndBound;
        assert!(!proved || least >= 0.99 * worst.distance, "{nuisances:?} {least} {worst:?}");
        proofs += usize::from(proved);
    }
    assert!(proofs >= 6, "{proofs}");
}
