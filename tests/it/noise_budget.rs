//! The noise budget, line by line: as it is written down, as it grows, and what an interferometer makes of it.

use hadar::instrument::{Camera, NoiseSpec, Readout, View, presets, view::Light};
use hadar::spectrum::Bands;
use hadar_testing::seeded;
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use std::f64::consts::PI;

const BANDS: usize = 5;

/// The figures that enter the budget.
#[derive(Debug, Clone)]
struct Inputs {
    exposure_s: f64,
    frames: u32,
    sigma: f64,
    stated_s: f64,
    flicker: f64,
    dark_per_s: f64,
    read: f64,
    bits: u32,
    full_well: f64,
    signal: f64,
    light: f64,
    occupancy: f64,
    fill: f64,
    distance_m: f64,
}

fn inputs() -> impl Strategy<Value = Inputs> {
    prop::array::uniform14(0.0..1.0_f64).prop_map(|share| {
        let between = |i: usize, low: f64, high: f64| low * (high / low).powf(share[i]);
        Inputs {
            exposure_s: between(0, 1e-4, 1e-1),
            frames: between(1, 1.0, 50.0) as u32,
            sigma: between(2, 1.0, 1e6),
            stated_s: between(3, 1e-4, 1e-1),
            flicker: between(4, 0.01, 0.99),
            dark_per_s: between(5, 1.0, 1e7),
            read: between(6, 0.1, 1e3),
            bits: between(7, 8.0, 20.0) as u32,
            full_well: between(8, 1e4, 1e9),
            signal: between(9, 1e17, 1e19),
            light: between(10, 1e16, 1e19),
            occupancy: between(11, 1e-4, 1.0),
            fill: between(12, 0.05, 1.0),
            distance_m: between(13, 0.1, 1e3),
        }
    })
}

impl Inputs {
    fn camera(&self) -> Camera {
        let camera = Camera {
            exposure_s: self.exposure_s,
            frames: self.frames,
            noise: NoiseSpec::Counts { sigma_counts: self.sigma },
            noise_exposure_s: self.stated_s,
            flicker_fraction: self.flicker,
            dark_rate_per_s: self.dark_per_s,
            read_noise_counts: self.read,
            quantisation_bits: Some(self.bits),
            full_well: Some(self.full_well),
            photon_bunching: true,
            quantum_efficiency: 0.7,
            ..presets::get("flir-a325sc").unwrap()
        };
        camera.checked().unwrap()
    }

    fn view(&self) -> View {
        let light = Light { label: "light of the path", radiance: vec![self.light; BANDS] };
        View {
            fill: self.fill,
            light: vec![light],
            signal: vec![self.signal; BANDS],
            occupancy: vec![self.occupancy; BANDS],
            ..View::at(Some(self.distance_m))
        }
    }

    /// Every line with its power of the exposure and of the frames, written down anew.
    fn lines(&self) -> Vec<(&'static str, f64, i32, i32)> {
        let t = self.exposure_s * f64::from(self.frames);
        let etendue = PI * 12e-6 * 12e-6 / (4.0 * 1.69 + (18e-3 / self.distance_m).powi(2));
        let all = etendue * 0.99 * 0.7 * t;
        let (own, other) = (all * self.fill * self.signal, all * self.light);
        let (stretch, frames) = (t / self.stated_s, f64::from(self.frames));
        let step = self.full_well / f64::from(1_u32 << self.bits);
        let sigma2 = self.sigma * self.sigma;
        vec![
            ("shot noise", own, 1, 1),
            ("light of the path", other, 1, 1),
            ("photon bunching", (own + other) * self.occupancy, 1, 1),
            ("dark counts", self.dark_per_s * t, 1, 1),
            ("Johnson noise", (1.0 - self.flicker) * sigma2 * stretch, 1, 1),
            ("flicker noise", self.flicker * sigma2 * stretch * stretch, 2, 2),
            ("read noise", frames * self.read * self.read, 0, 1),
            ("quantisation", frames * step * step / 12.0, 0, 1),
        ]
    }
}

fn bands() -> Bands {
    Bands::uniform(900.0, 900.0 + (BANDS - 1) as f64, 1.0).unwrap()
}

/// Label, variance and scaling of all lines.
fn budget(camera: &Camera, view: &View) -> Vec<(&'static str, f64, &'static str)> {
    let lines = camera.noise_budget(&bands(), &view.signal, view);
    lines.into_iter().map(|line| (line.label, line.var_counts, line.scaling)).collect()
}

proptest! {
    #![proptest_config(seeded(7, 128))]

    /// 1e-13: a dozen roundings each.
    #[test]
    fn every_line_is_what_it_says_and_they_sum_to_what_solvers_take(inputs in inputs()) {
        let (camera, view) = (inputs.camera(), inputs.view());
        let (lines, by_hand) = (budget(&camera, &view), inputs.lines());
        prop_assert_eq!(lines.len(), by_hand.len());
        for (line, hand) in lines.iter().zip(&by_hand) {
            prop_assert_eq!(line.0, hand.0);
            prop_assert!((line.1 / hand.1 - 1.0).abs() < 1e-13, "{:?} {:?}", line, hand);
        }
        let counting = camera.counting(&bands(), &view);
        let total = counting.counts_per_radiance * inputs.signal + counting.var_added(BANDS - 1);
        let sum: f64 = by_hand.iter().map(|line| line.1).sum();
        prop_assert!((total / sum - 1.0).abs() < 1e-13);
    }

    #[test]
    fn every_line_grows_as_it_says(inputs in inputs(), longer in 0.01..100.0_f64, more in 2_u32..40) {
        let view = inputs.view();
        let before = budget(&inputs.camera(), &view);
        let exposed = budget(&Inputs { exposure_s: longer * inputs.exposure_s, ..inputs.clone() }.camera(), &view);
        let averaged = budget(&Inputs { frames: more * inputs.frames, ..inputs.clone() }.camera(), &view);
        for ((line, power), (exposed, averaged)) in
            before.iter().zip(inputs.lines()).zip(exposed.iter().zip(&averaged))
        {
            let says = match line.2 { "t" => (1, 1), "t^2" => (2, 2), "frames" => (0, 1), other => panic!("{other}") };
            prop_assert_eq!(says, (power.2, power.3), "{}", line.0);
            let by_exposure = line.1 * longer.powi(says.0);
            let by_frames = line.1 * f64::from(more).powi(says.1);
            prop_assert!((exposed.1 / by_exposure - 1.0).abs() < 1e-13, "{}", line.0);
            prop_assert!((averaged.1 / by_frames - 1.0).abs() < 1e-13, "{}", line.0);
        }
    }

    #[test]
    fn no_line_knows_of_another(inputs in inputs()) {
        let (camera, view) = (inputs.camera(), inputs.view());
        let all = budget(&camera, &view);
        let without: [(&[&str], Camera, View); 6] = [
            (&["light of the path"], camera.clone(), View { light: Vec::new(), ..view.clone() }),
            (&["photon bunching"], Camera { photon_bunching: false, ..camera.clone() }, view.clone()),
            (&["dark counts"], Camera { dark_rate_per_s: 0.0, ..camera.clone() }, view.clone()),
            (&["Johnson noise", "flicker noise"], Camera { noise: NoiseSpec::None, ..camera.clone() }, view.clone()),
            (&["read noise"], Camera { read_noise_counts: 0.0, ..camera.clone() }, view.clone()),
            (&["quantisation"], Camera { quantisation_bits: None, ..camera.clone() }, view.clone()),
        ];
        for (gone, camera, view) in without {
            let left = budget(&camera, &view);
            prop_assert_eq!(left.len() + gone.len(), all.len(), "{:?}", gone);
            for line in &left {
                // Bunching is of all light that falls on the pixel, so that it alone changes when some of it goes.
                if gone == ["light of the path"] && line.0 == "photon bunching" { continue }
                prop_assert!(all.contains(line), "{:?} without {:?}", line, gone);
            }
        }
    }

    /// N²/(N + σ²) of endless time is N₀²/(φσ²), whether the bands wait for each other or not; they only get there W times later.
    #[test]
    fn bands_in_turn_have_the_same_flicker_floor_reached_later(inputs in inputs()) {
        let alone = |readout, exposure_s| Camera {
            exposure_s, readout, frames: 1, dark_rate_per_s: 0.0, read_noise_counts: 0.0, quantisation_bits: None,
            photon_bunching: false, ..inputs.camera()
        };
        let view = View::at(Some(inputs.distance_m));
        let merit = |camera: &Camera| {
            let counting = camera.counting(&bands(), &view);
            let counts = counting.counts_per_radiance * inputs.signal;
            counts * (counts / (counts + counting.var_added(0)))
        };
        let stated = alone(Readout::Simultaneous, inputs.stated_s);
        let counts = stated.counts_per_radiance(&bands(), &view) * inputs.signal;
        let flicker = inputs.flicker * inputs.sigma * inputs.sigma;
        let floor = counts * counts / flicker;
        // Half of the floor: all that grows as t is then as large as the flicker noise.
        let half_s = inputs.stated_s * (counts + (1.0 - inputs.flicker) * inputs.sigma * inputs.sigma) / flicker;
        for readout in [Readout::Simultaneous, Readout::Sequential] {
            let (half, late) = (alone(readout, half_s), alone(readout, 1e9 * half_s));
            prop_assert!((merit(&half) / floor - 0.5).abs() < 1e-12);
            prop_assert!((merit(&late) / floor - 1.0).abs() < 2e-9);
            let waits = if readout == Readout::Sequential { BANDS as f64 } else { 1.0 };
            prop_assert!((half.acquisition_s(BANDS) / (waits * half_s) - 1.0).abs() < 1e-15);
        }
    }
}

/// Readings of an interferometer y_m = ½ Σ_w n_w (1 + cos θ_mw), θ_mw = π(m + ½)ν_w/M, at M mirror positions; with
/// `offset` a further unknown that adds to all readings (stray light, drift, or a detector that passes no constant).
fn interferogram(positions: usize, wavenumbers: &[f64], offset: bool) -> DMatrix<f64> {
    DMatrix::from_fn(positions, wavenumbers.len() + usize::from(offset), |m, w| match wavenumbers.get(w) {
        Some(nu) => 0.5 * (1.0 + (PI * (m as f64 + 0.5) * nu / positions as f64).cos()),
        None => 1.0,
    })
}

/// Variances of ordinary least squares, (AᵀA)⁻¹ Aᵀ V A (AᵀA)⁻¹, by QR: the columns of A⁺ᵀ.
fn variances(design: &DMatrix<f64>, of_readings: &DVector<f64>) -> Vec<f64> {
    let qr = design.clone().qr();
    let inverse = qr.r().solve_upper_triangular(&qr.q().transpose()).unwrap();
    (0..design.ncols())
        .map(|w| inverse.row(w).iter().zip(of_readings.iter()).map(|(x, var)| x * x * var).sum())
        .collect()
}

/// Added variance of an interferometer's bands by the crate: noise of a reading of variance 1, and photons.
fn by_crate(bands: usize, signal: &[f64]) -> (f64, Vec<f64>) {
    let camera = Camera {
        readout: Readout::FourierTransform,
        noise: NoiseSpec::Counts { sigma_counts: 1.0 },
        noise_exposure_s: 1.0,
        exposure_s: 1.0,
        flicker_fraction: 0.0,
        ..presets::get("flir-a325sc").unwrap()
    };
    let view = View { signal: signal.to_vec(), ..View::default() };
    let bands = Bands::uniform(900.0, 899.0 + bands as f64, 1.0).unwrap();
    let lines = camera.added_noise(&bands, &view);
    let find = |label: &str| lines.iter().find(|line| line.label == label).unwrap();
    let kappa = camera.counts_per_radiance(&bands, &view);
    let photons = find("multiplexed shot noise").var_counts.iter().zip(signal);
    (
        find("Johnson noise").var_counts[0],
        photons.map(|(beyond, signal)| (beyond + kappa * signal) / kappa).collect(),
    )
}

/// Noise of every reading: 8 W v for counts N = W n, so 8 v/W for n. With the constant part unknown that is exact where the
/// cosines are orthogonal; where it is known to be ½ Σ n, it tells of the sum and the factor is 8(1 − 2/(2W + 1)).
#[test]
fn the_factor_of_eight_is_the_least_squares_covariance_of_one_sided_cosines() {
    for count in [8_usize, 16, 31] {
        let positions = count + 1;
        let wavenumbers: Vec<f64> = (1..=count).map(|w| w as f64).collect();
        let ones = DVector::from_element(positions, 1.0);
        let free = variances(&interferogram(positions, &wavenumbers, true), &ones);
        let known = variances(&interferogram(positions, &wavenumbers, false), &ones);
        let factor = |var: f64| var * positions as f64;
        let informed = 8.0 * (1.0 - 2.0 / (2.0 * count as f64 + 1.0));
        for w in 0..count {
            assert!((factor(free[w]) / 8.0 - 1.0).abs() < 1e-12, "{w}: {}", factor(free[w]));
            assert!((factor(known[w]) / informed - 1.0).abs() < 1e-12, "{w}: {}", factor(known[w]));
        }
        let ours = by_crate(positions, &vec![1.0; positions]).0 / (positions * positions) as f64;
        assert!((ours / free[0] - 1.0).abs() < 1e-12);
        println!("W {count}: 8 with an unknown constant, {informed:.4} with a known one");
    }
}

/// Bands far from zero path frequency, as those of a long-wave instrument are: half-integers couple to the constant by
/// ±1/(W sin(πν/2W)), which is all but gone in the upper half of the range, and large in the lowest bands.
#[test]
fn the_factor_of_eight_holds_away_from_wavenumber_zero() {
    for count in [8_usize, 16, 32] {
        let wavenumbers: Vec<f64> = (0..count).map(|w| w as f64 + 0.5).collect();
        let ones = DVector::from_element(count, 1.0);
        let var = variances(&interferogram(count, &wavenumbers, false), &ones);
        let factor: Vec<f64> = var.iter().map(|var| var * count as f64).collect();
        // Sherman and Morrison: cosines C with CᵀC = W/2, and the constant 1 = C a.
        let a = |w: usize| {
            let sign = if w.is_multiple_of(2) { 1.0 } else { -1.0 };
            sign / (count as f64 * (PI * (w as f64 + 0.5) / (2.0 * count as f64)).sin())
        };
        let s = 1.0 + (0..count).map(a).sum::<f64>();
        for (w, factor) in factor.iter().enumerate() {
            let by_hand = 8.0 * (1.0 - 2.0 * a(w) / s + count as f64 * (a(w) / s).powi(2));
            assert!((factor / by_hand - 1.0).abs() < 1e-10, "{w}: {factor} {by_hand}");
        }
        println!("W {count}: {factor:.2?}");
        assert!(
            factor[count / 2..].iter().all(|factor| (factor / 8.0 - 1.0).abs() < 2.0 / count as f64),
            "{factor:?}"
        );
        assert!(factor[0] > 16.0, "{factor:?}");
    }
}

/// Shot noise of the readings themselves: 4 ΣN and half the photons of the band at twice the wavenumber, a share 1/W.
#[test]
fn the_factor_of_four_is_the_shot_noise_of_all_photons() {
    for count in [8_usize, 16, 31] {
        let positions = count + 1;
        let wavenumbers: Vec<f64> = (1..=count).map(|w| w as f64).collect();
        let counts: Vec<f64> = (0..count).map(|w| 100.0 + 10.0 * w as f64).collect();
        let design = interferogram(positions, &wavenumbers, false);
        let readings = &design * DVector::from_column_slice(&counts);
        let var = variances(&interferogram(positions, &wavenumbers, true), &readings);
        // Counts of the whole acquisition are N = M n.
        let total: f64 = counts.iter().sum::<f64>() * positions as f64;
        let twice = |w: usize| {
            let alias = 2 * (w + 1);
            let (alias, sign) = if alias > positions { (2 * positions - alias, -1.0) } else { (alias, 1.0) };
            if alias == positions { 0.0 } else { sign * counts[alias - 1] * positions as f64 }
        };
        let photons = by_crate(count, &counts).1;
        for (w, var) in var.iter().take(count).enumerate() {
            let of_counts = var * (positions * positions) as f64;
            let by_hand = 4.0 * total + 2.0 * twice(w);
            assert!((of_counts / by_hand - 1.0).abs() < 1e-10, "{w}: {of_counts} {by_hand}");
            // The crate's line is 4 ΣN, up to that share.
            let ours = photons[w] * positions as f64;
            assert!((ours / (4.0 * total) - 1.0).abs() < 1e-12, "{ours} {total}");
            assert!((of_counts / ours - 1.0).abs() < 1.0 / count as f64);
        }
    }
}

/// Noise over counts in the same time: 8/W of a sequential instrument's variance where electronics are the noise, and 4 times
/// the sum of all photons instead of W N where photons are.
#[test]
fn the_multiplex_advantage_and_its_price() {
    let bands = 64;
    let all = Bands::uniform(900.0, 963.0, 1.0).unwrap();
    let camera = |readout| Camera {
        readout,
        noise: NoiseSpec::Counts { sigma_counts: 1e5 },
        flicker_fraction: 0.0,
        ..presets::get("flir-a325sc").unwrap()
    };
    let view = View { signal: vec![5e18; bands], ..View::default() };
    let relative = |readout, label: &str| {
        let camera = camera(readout);
        let kappa = camera.counts_per_radiance(&all, &view);
        let lines = camera.added_noise(&all, &view);
        let line = lines.iter().find(|line| line.label == label).unwrap();
        (line.var_counts[0] / (kappa * 5e18).powi(2), kappa * 5e18, camera.acquisition_s(bands))
    };
    let (one, own, time) = relative(Readout::Sequential, "Johnson noise");
    let (many, counts, same_time) = relative(Readout::FourierTransform, "Johnson noise");
    assert_eq!(time, same_time);
    assert!((many / one / (8.0 / bands as f64) - 1.0).abs() < 1e-12);
    let (beyond, ..) = relative(Readout::FourierTransform, "multiplexed shot noise");
    // Shot noise of the sequential instrument is 1/N; that of all photons 4 W N/(W N)² = 4/N: a fourfold price for grey light.
    assert!(((beyond + 1.0 / counts) * own / 4.0 - 1.0).abs() < 1e-12);
}
