//! Known cameras: their noise in every way of stating it, and compared.

use hadar::instrument::comparison::compare;
use hadar::instrument::equivalents::{self, NetdConditions};
use hadar::instrument::{Camera, NoiseSpec, Readout, presets};
use hadar::spectrum::Bands;
use hadar_testing::seeded;
use proptest::prelude::*;
use std::f64::consts::PI;

const PLANCK: f64 = 6.626_070_15e-34;
const LIGHT: f64 = 299_792_458.0;
const BOLTZMANN: f64 = 1.380_649e-23;

fn get(name: &str) -> Camera {
    presets::get(name).unwrap()
}

/// Photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹ of a blackbody.
fn radiance(wavenumber_cm1: f64, temperature_k: f64) -> f64 {
    let nu = 100.0 * wavenumber_cm1;
    200.0 * LIGHT * nu * nu / (PLANCK * LIGHT * nu / (BOLTZMANN * temperature_k)).exp_m1()
}

/// A camera whose figures are all drawn.
fn cameras() -> impl Strategy<Value = Camera> {
    prop::array::uniform8(0.0..1.0_f64).prop_map(|share| {
        let between = |i: usize, low: f64, high: f64| low * (high / low).powf(share[i]);
        let low = between(5, 700.0, 900.0);
        let mut camera = Camera {
            exposure_s: between(0, 1e-5, 1e-1),
            noise_exposure_s: between(1, 1e-5, 1e-1),
            pixel_m: between(2, 5e-6, 1e-3),
            f_number: between(3, 0.8, 5.0),
            optics_efficiency: between(4, 0.2, 1.0),
            quantum_efficiency: between(6, 0.2, 1.0),
            spectral_range_cm1: [low, low + between(7, 50.0, 500.0).round()],
            ..get("flir-a325sc")
        };
        // No NETD is below the shot noise of its conditions.
        let least_k = camera.least_netd_k().unwrap();
        if let NoiseSpec::Netd { netd_k, .. } = &mut camera.noise {
            *netd_k += least_k;
        }
        camera.checked().unwrap()
    })
}

/// 1 µflick in front of a camera.
fn microflick(of: &Camera) -> NoiseSpec {
    let (f_number, optics_efficiency, pixel_m) = (of.f_number, of.optics_efficiency, of.pixel_m);
    NoiseSpec::SpectralRadiance { microflick: 1.0, f_number, optics_efficiency, pixel_m }
}

#[track_caller]
fn same(a: f64, b: f64) {
    assert!((a / b - 1.0).abs() < 1e-13, "{a:e} {b:e}");
}

proptest! {
    #![proptest_config(seeded(7, 48))]

    /// Noise of equal counts in all bands, stated anew in each way, is that noise in the middle of the range.
    #[test]
    fn every_statement_gives_the_same_noise_again(camera in cameras(), sigma in 1.0..1e7_f64) {
        let counts = Camera { noise: NoiseSpec::Counts { sigma_counts: sigma }, ..camera };
        let stated = counts.equivalents().unwrap();
        same(stated.sigma_counts, sigma);
        let bandwidth_hz = None;
        let (f_number, optics_efficiency, pixel_m) = (counts.f_number, counts.optics_efficiency, counts.pixel_m);
        // An NETD is stated with the shot noise of its photons, which hides the digits of what is left.
        let hidden = (stated.netd_with_shot_noise_k / stated.netd_k).powi(2);
        for noise in [
            NoiseSpec::Netd {
                netd_k: stated.netd_with_shot_noise_k,
                temperature_k: stated.reference_temperature_k,
                f_number: counts.f_number,
                optics_efficiency: counts.optics_efficiency,
                pixel_m: counts.pixel_m,
            },
            NoiseSpec::Nep { nep_w_hz05: stated.nep_w_hz05, bandwidth_hz },
            NoiseSpec::Detectivity { detectivity_cm_hz05_w: stated.detectivity_cm_hz05_w.unwrap(), bandwidth_hz },
            NoiseSpec::SpectralRadiance { microflick: stated.nesr_microflick, f_number, optics_efficiency, pixel_m },
        ] {
            let share = if matches!(noise, NoiseSpec::Netd { .. }) { hidden } else { 1.0 };
            let again = Camera { noise, ..counts.clone() }.equivalents().unwrap();
            let same = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-13 * (1.0 + share), "{a:e} {b:e} {share}");
            same(again.netd_of_a_band_k, stated.netd_of_a_band_k);
            same(again.nep_w, stated.nep_w);
            same(again.detectivity_cm_hz05_w.unwrap(), stated.detectivity_cm_hz05_w.unwrap());
            same(again.nesr_microflick, stated.nesr_microflick);
        }
    }

    #[test]
    fn conversions_there_and_back(camera in cameras(), figure in 1e-3..1e3_f64, nu in 750.0..1200.0_f64) {
        let at = NetdConditions::of(&camera, 300.0);
        same(equivalents::netd_of_sigma(&camera, equivalents::sigma_of_netd(&camera, figure, at), at), figure);
        let (pixel_m, bandwidth_hz) = (camera.pixel_m, 0.5 / camera.noise_exposure_s);
        let nep_w = equivalents::nep_of_detectivity(figure * 1e9, pixel_m, bandwidth_hz);
        let sigma = equivalents::sigma_of_nep(&camera, nep_w, nu).unwrap();
        let back_w = equivalents::nep_of_sigma(&camera, sigma, nu).unwrap();
        same(equivalents::detectivity_of_nep(back_w, pixel_m, bandwidth_hz), figure * 1e9);
        let sigma = equivalents::sigma_of_nesr(&camera, figure, nu).unwrap();
        same(equivalents::nesr_of_sigma(&camera, sigma, nu).unwrap(), figure);
        // By hand: photons of that power, and of that radiance in the band 1 cm⁻¹ wide.
        let photon_j = PLANCK * LIGHT * 100.0 * nu;
        let eta = camera.quantum_efficiency;
        let t = camera.noise_exposure_s;
        let by_hand = eta * figure * t / photon_j;
        same(equivalents::sigma_of_nep(&camera, figure, nu).unwrap(), by_hand);
        let etendue = PI * (camera.pixel_m / (2.0 * camera.f_number)).powi(2);
        // ∫ 10⁴/ν² / (hcν) dν over the band, by the antiderivative.
        let photons = 0.5 * 1e4 * ((nu - 0.5).powi(-2) - (nu + 0.5).powi(-2)) / (photon_j / nu);
        let power = figure * 1e-6 * 1e4 * etendue * camera.optics_efficiency;
        prop_assert!((sigma / (eta * power * t * photons) - 1.0).abs() < 1e-10);
        // Elsewhere and back; four times the counts at half the f-number.
        let to = NetdConditions { temperature_k: 350.0, f_number: 0.5 * at.f_number, ..at };
        let there = equivalents::netd_elsewhere(&camera, figure, at, to);
        same(equivalents::netd_elsewhere(&camera, there, to, at), figure);
        let warm = NetdConditions { temperature_k: 350.0, ..at };
        same(equivalents::netd_elsewhere(&camera, figure, at, warm), 4.0 * there);
        same(equivalents::sigma_of_netd(&camera, there, to), equivalents::sigma_of_netd(&camera, figure, at));
    }

    #[test]
    fn more_noise_is_more_in_every_statement(camera in cameras(), netd_k in 1e-3..1.0_f64, worse in 1.01..10.0_f64) {
        let of = |netd_k| {
            let noise = NoiseSpec::Netd {
                netd_k, temperature_k: 300.0, f_number: 1.0, optics_efficiency: 1.0, pixel_m: camera.pixel_m,
            };
            let mut stated = Camera { noise, ..camera.clone() };
            // None is below the shot noise of its conditions.
            let least_k = stated.least_netd_k().unwrap();
            if let NoiseSpec::Netd { netd_k, .. } = &mut stated.noise {
                *netd_k += least_k;
            }
            stated.equivalents().unwrap()
        };
        let (less, more) = (of(netd_k), of(worse * netd_k));
        for (less, more) in [
            (less.sigma_counts, more.sigma_counts),
            (less.netd_k, more.netd_k),
            (less.netd_with_shot_noise_k, more.netd_with_shot_noise_k),
            (less.nep_w, more.nep_w),
            (less.nesr_microflick, more.nesr_microflick),
            (less.gamma_per_band, more.gamma_per_band),
            (more.detectivity_cm_hz05_w.unwrap(), less.detectivity_cm_hz05_w.unwrap()),
        ] {
            prop_assert!(less < more);
        }
        prop_assert!(less.netd_with_shot_noise_k > less.netd_k);
        let at = NetdConditions::of(&camera, 300.0);
        let elsewhere = |to| equivalents::netd_elsewhere(&camera, netd_k, at, to);
        let [warm, slow, wide] = [
            NetdConditions { temperature_k: 310.0, ..at },
            NetdConditions { f_number: 1.1 * at.f_number, ..at },
            NetdConditions { pixel_m: 1.1 * at.pixel_m, ..at },
        ]
        .map(elsewhere);
        prop_assert!(warm < netd_k && slow > netd_k && wide < netd_k);
    }
}

/// reproduction.md 6d: 1 µflick at 10 µm and 300 K is one of 992, and 62.5 mK, by Planck's law over wavelength.
#[test]
fn a_microflick_in_kelvin() {
    let (lambda, kelvin) = (10e-6_f64, 300.0);
    let x = PLANCK * LIGHT / (lambda * BOLTZMANN * kelvin);
    // W m⁻² sr⁻¹ m⁻¹; a flick is 1e4 W m⁻² sr⁻¹ µm⁻¹.
    let flicks = 2.0 * PLANCK * LIGHT * LIGHT / lambda.powi(5) / x.exp_m1() * 1e-6 / 1e4;
    let slope = flicks * x / (kelvin * (1.0 - (-x).exp()));
    let (all, per_kelvin) = equivalents::blackbody_microflick(10.0, kelvin);
    assert!((all / (1e6 * flicks) - 1.0).abs() < 1e-14 && (per_kelvin / (1e6 * slope) - 1.0).abs() < 1e-14);
    assert_eq!((format!("{all:.0}"), format!("{:.1}", 1e3 / per_kelvin)), ("992".into(), "62.5".into()));
    // The same through a camera, whatever its optics and exposure.
    let camera = Camera {
        noise: microflick(&get("nicolet-is50")),
        spectral_range_cm1: [900.0, 1100.0],
        reference_temperature_k: kelvin,
        ..get("nicolet-is50")
    };
    let of_band = camera.equivalents().unwrap().netd_of_a_band_k;
    // Its slope is that of the middle of the band, the noise is integrated over it: 2 (0.5/1000)² more.
    assert!((of_band * per_kelvin - 1.0).abs() < 1e-6, "{of_band}");
}

/// A wide band has the noise of its narrow parts together, whether it is sampled or one node stands for it: at the centre alone
/// it would be too small by 5 to 14 %.
#[test]
fn spectral_noise_is_integrated_over_wide_bands() {
    let camera = Camera { noise: microflick(&get("nicolet-is50")), ..get("nicolet-is50") };
    let sigma = |bands: &Bands| camera.reading_sigma(bands).unwrap().iter().sum::<f64>();
    for (low, high, too_small) in [(750.0, 990.0, 0.02), (730.0, 1250.0, 0.12), (714.3, 1250.0, 0.13)] {
        let width: f64 = high - low;
        let parts = 5000;
        let narrow = Bands::from_rows((0..parts).map(|i| {
            let step = width / f64::from(parts);
            (low + (f64::from(i) + 0.5) * step, step)
        }));
        let exact = sigma(&narrow.unwrap());
        let center = 0.5 * (low + high);
        for wide in [Bands::from_ranges(&[(low, high)]), Bands::from_rows([(center, width)])] {
            assert!((sigma(&wide.unwrap()) / exact - 1.0).abs() < 1e-6);
        }
        let at_center = sigma(&Bands::from_rows([(center, 1.0)]).unwrap()) * width;
        assert!(1.0 - at_center / exact > too_small, "{}", 1.0 - at_center / exact);
    }
}

/// Table S2 in other words, by hand from its σ; 1e-3 is the last printed digit.
#[test]
fn the_bolometer_and_the_mct_detector_by_hand() {
    let close =
        |value: f64, expected: f64| assert!((value / expected - 1.0).abs() < 1e-3, "{value:e} {expected:e}");
    let noise = get("flir-a325sc").equivalents().unwrap();
    close(noise.sigma_counts, 1.769e6);
    // Stated in front of the optics, which pass 0.99.
    close(noise.netd_k, 47.8e-3 / 0.99);
    close(noise.netd_with_shot_noise_k, 47.8e-3 / 0.99 * (1.0 + 2.505e9 / 1.769e6_f64.powi(2)).sqrt());
    let nep_w = 1.769e6 * PLANCK * LIGHT * 98_250.0 / 12e-3;
    close(noise.nep_w, nep_w);
    close(noise.nep_w_hz05, nep_w / (1.0 / 24e-3_f64).sqrt());
    close(noise.detectivity_cm_hz05_w.unwrap(), 12e-4 * (1.0 / 24e-3_f64).sqrt() / nep_w);
    // The electronic part of it is what the shot noise of all photons leaves.
    close(noise.gamma_per_band, 536.0 * (1.769e6_f64.powi(2) - 2.505e9) / 2.505e9);
    let mct = get("nicolet-is50");
    let nep_w = equivalents::nep_of_detectivity(4.7e10, 1e-3, 0.5 / 2.86e-6);
    close(nep_w, 0.1 * 174_825_f64.sqrt() / 4.7e10);
    close(equivalents::sigma_of_nep(&mct, nep_w, 1000.0).unwrap(), 1.281e5);
    same(mct.equivalents().unwrap().detectivity_cm_hz05_w.unwrap(), 4.7e10);
}

/// dN/dT of Planck's law by differences, at another temperature: 1e-6 is what differences leave.
#[test]
fn an_netd_at_another_temperature() {
    let camera = get("flir-a325sc");
    let slope = |kelvin: f64| -> f64 {
        (715..=1250)
            .map(|nu| radiance(f64::from(nu), kelvin + 0.05) - radiance(f64::from(nu), kelvin - 0.05))
            .sum()
    };
    let at = NetdConditions::of(&camera, 300.0);
    let cold = equivalents::netd_elsewhere(&camera, 50e-3, at, NetdConditions { temperature_k: 250.0, ..at });
    assert!((cold / (50e-3 * slope(300.0) / slope(250.0)) - 1.0).abs() < 1e-6, "{cold}");
}

#[test]
fn without_noise_every_statement_is_zero() {
    let noise = get("ideal-pnrd").equivalents().unwrap();
    let zeros = [noise.sigma_counts, noise.netd_k, noise.nep_w, noise.nesr_microflick, noise.gamma_per_band];
    assert_eq!((zeros, noise.detectivity_cm_hz05_w), ([0.0; 5], None));
    assert!(noise.netd_with_shot_noise_k > 0.0);
}

/// Against sums written down anew; 1e-12: rounding of 536 terms.
#[test]
fn the_distance_of_a_comparison_is_that_of_its_definition() {
    let (bolometer, ideal) = (get("flir-a325sc"), get("ideal-pnrd"));
    let ratios = compare(&bolometer, &ideal).unwrap();
    let kappa = PI * (12e-6 / 2.6_f64).powi(2) * 0.99 * 12e-3;
    let var = bolometer.equivalents().unwrap().sigma_counts.powi(2);
    let counts = (715..=1250).map(|nu| kappa * radiance(f64::from(nu), 300.0));
    let (shot, all) = counts.fold((0.0, 0.0), |sum, n| (sum.0 + n, sum.1 + n * n / (n + var)));
    assert!((ratios.distance / (shot / all).sqrt() - 1.0).abs() < 1e-12);
    assert!((ratios.a.photons / shot - 1.0).abs() < 1e-12 && (ratios.photons - 1.0).abs() < 1e-15);
    assert!((ratios.a.noise_counts / var.sqrt() - 1.0).abs() < 1e-13 && ratios.b.noise_counts == 0.0);
    let back = compare(&ideal, &bolometer).unwrap();
    assert!((back.distance * ratios.distance - 1.0).abs() < 1e-14 && back.noise.is_none());
}

/// W bands in turn get a W-th of the time: √W less without flicker; nothing less where all is flicker.
#[test]
fn in_the_same_time_the_quicker_camera_averages() {
    let at_once = Camera { flicker_fraction: 0.0, ..get("flir-a325sc") };
    let in_turn = Camera { readout: Readout::Sequential, ..at_once.clone() };
    let ratios = compare(&in_turn, &at_once).unwrap();
    assert!((ratios.distance - 1.0).abs() < 1e-14);
    assert!((ratios.distance_in_same_time / 536_f64.sqrt() - 1.0).abs() < 1e-12);
    assert!((ratios.photons_in_same_time / 536.0 - 1.0).abs() < 1e-12);
    let flicker = |camera: Camera| Camera { flicker_fraction: 1.0, ..camera };
    let ratios = compare(&flicker(in_turn), &flicker(at_once)).unwrap();
    assert!((ratios.distance_in_same_time - 1.0).abs() < 1e-5, "{}", ratios.distance_in_same_time);
}

#[test]
fn cameras_that_see_nothing_in_common_are_refused() {
    let near = Camera { spectral_range_cm1: [1500.0, 2500.0], name: "near".into(), ..get("flir-a325sc") };
    let message = compare(&near, &get("flir-a325sc")).unwrap_err().to_string();
    assert!(message.contains("near") && message.contains("flir-a325sc"), "{message}");
}
