//! Counts of a camera and the noise beside them, in extended precision.
//!
//! * κ = π a²/(4F² + (f/z)²) η_o η_q t φ, counts per unit of band signal (m² sr s): pixel a (m), f-number F, focal length f (m),
//!   distance z (m), efficiencies η of optics and detector, t = exposure × frames (s), φ the share of the pixel that the target
//!   fills; W times as much through an interferometer with W bands;
//! * added variance of a band, counts²: r t (dark counts) + [(1 − p) s + p s²] σ² (Johnson and flicker, s = t/t₀) + n ρ² (read
//!   noise) + n q²/12 (steps q of the converter); through an interferometer 8W times that, and 4 ΣN − N;
//! * σ of a reading in the exposure t₀, counts: as stated; NETD·dN/dT, with dN/dT = κ₀ Σ ∂B/∂T over bands of 1 cm⁻¹ of the
//!   camera's range, κ₀ of a far target in t₀; η_q P t₀/(hcν) of a power P (W), which is NEP √Δf or √(A Δf)/D*, A in cm².
//!
//! Not known here: efficiencies that depend on wavenumber, tables of noise, NESR, bunching, other light.
//!
//! Source: paper S7, S10, Table S2; as `hadar::instrument` has them.

use super::Extended;
use super::planck::Blackbody;
use hadar::error::{Error, Result};
use hadar::instrument::{Camera, NoiseSpec, Readout};
use hadar::spectrum::Bands;

/// What a camera counts of a scene.
#[derive(Debug, Clone)]
pub struct Counted {
    /// κ, m² sr s.
    pub counts_per_radiance: Extended,
    /// Of each band, counts².
    pub var_added: Vec<Extended>,
}

/// Where the target is, and how much of the pixel it fills.
#[derive(Debug, Clone, Copy, Default)]
pub struct Place {
    /// Its distance, m; infinitely far where `None`.
    pub distance_m: Option<f64>,
    /// Its side, m; it fills the pixel where `None`.
    pub size_m: Option<f64>,
}

/// Étendue π a²/(4F² + (f/z)²) of a pixel, m² sr.
#[must_use]
pub fn etendue_m2_sr(camera: &Camera, distance_m: Option<f64>) -> Extended {
    let near = distance_m.map_or_else(Extended::zero, |z| {
        (Extended::from(camera.focal_length_m) / Extended::from(z)).square()
    });
    let lens = Extended::from(4.0) * Extended::from(camera.f_number).square();
    Extended::pi() * Extended::from(camera.pixel_m).square() / (lens + near)
}

/// φ: the share of the pixel that the target fills, (s f/(a z))² and at most 1.
#[must_use]
pub fn fill(camera: &Camera, place: Place) -> Extended {
    let (Some(distance_m), Some(size_m)) = (place.distance_m, place.size_m) else { return Extended::one() };
    let image = Extended::from(size_m) * Extended::from(camera.focal_length_m) / Extended::from(distance_m);
    let share = (image / Extended::from(camera.pixel_m)).square();
    if share < Extended::one() { share } else { Extended::one() }
}

/// Counts per unit of band signal, and the noise beside that of the target's photons; `signal` of each band.
///
/// # Errors
/// A noise that is not known here.
pub fn counted(camera: &Camera, bands: &Bands, signal: &[Extended], place: Place) -> Result<Counted> {
    let number = Extended::from;
    let frames = number(f64::from(camera.frames));
    let time = number(camera.exposure_s) * &frames;
    let width = number(bands.len() as f64);
    let interferometer = camera.readout == Readout::FourierTransform;
    let mut counts = etendue_m2_sr(camera, place.distance_m)
        * number(camera.optics_efficiency)
        * number(camera.quantum_efficiency)
        * &time
        * fill(camera, place);
    if interferometer {
        counts = counts * &width;
    }
    let step = match (camera.full_well, camera.quantisation_bits) {
        (Some(full), Some(bits)) => number(full) / number(f64::from(bits).exp2()),
        _ => Extended::zero(),
    };
    let every = number(camera.dark_rate_per_s) * &time
        + &frames * number(camera.read_noise_counts).square()
        + &frames * step.square() / number(12.0);
    let stretch = &time / number(camera.noise_exposure_s);
    let flicker = number(camera.flicker_fraction);
    let growth = (Extended::one() - &flicker) * &stretch + flicker * stretch.square();
    let total: Extended = signal.iter().map(|signal| &counts * signal).sum();
    let variance = |(sigma, signal): (Extended, &Extended)| {
        let of_readings = sigma.square() * &growth + &every;
        if !interferometer {
            return of_readings;
        }
        number(8.0) * &width * of_readings + number(4.0) * &total - &counts * signal
    };
    let var_added = reading_sigma(camera, bands)?.into_iter().zip(signal).map(variance).collect();
    Ok(Counted { counts_per_radiance: counts, var_added })
}

/// σ of each band reading in the exposure for which it is stated, counts.
fn reading_sigma(camera: &Camera, bands: &Bands) -> Result<Vec<Extended>> {
    let number = Extended::from;
    let time = number(camera.noise_exposure_s);
    let of_power = |power_w: Extended| {
        let energy = |center: f64| {
            // h = 6.62607015e-34 J s, c = 29979245800 cm s⁻¹.
            let [h, c] = ["6.62607015e-34", "29979245800"].map(Extended::parse);
            h * c * number(center)
        };
        let sigma = |center: f64| number(camera.quantum_efficiency) * &power_w * &time / energy(center);
        bands.bands().iter().map(|band| sigma(band.center_cm1)).collect()
    };
    let bandwidth = |stated: Option<f64>| stated.map_or_else(|| number(0.5) / &time, number);
    Ok(match camera.noise {
        NoiseSpec::None => vec![Extended::zero(); bands.len()],
        NoiseSpec::Counts { sigma_counts } => vec![number(sigma_counts); bands.len()],
        NoiseSpec::Netd { netd_k, temperature_k, f_number, optics_efficiency, pixel_m } => {
            let [low, high] = camera.spectral_range_cm1;
            let nodes: Vec<f64> = (0..=(high - low) as usize).map(|i| low + i as f64).collect();
            let blackbody = Blackbody::new(&nodes, &number(temperature_k));
            let [all, slope]: [Extended; 2] =
                [blackbody.values, blackbody.slopes].map(|of| of.into_iter().sum());
            let stated = Camera { f_number, pixel_m, ..camera.clone() };
            let counted = etendue_m2_sr(&stated, None)
                * number(optics_efficiency)
                * number(camera.quantum_efficiency)
                * &time;
            // What is measured contains the shot noise of the photons.
            let measured = number(netd_k) * &counted * slope;
            vec![(measured.square() - counted * all).sqrt(); bands.len()]
        }
        NoiseSpec::Detectivity { detectivity_cm_hz05_w, bandwidth_hz } => {
            let side_cm = number(camera.pixel_m) * number(100.0);
            let power = side_cm * bandwidth(bandwidth_hz).sqrt() / number(detectivity_cm_hz05_w);
            of_power(power)
        }
        NoiseSpec::Nep { nep_w_hz05, bandwidth_hz } => {
            of_power(number(nep_w_hz05) * bandwidth(bandwidth_hz).sqrt())
        }
        NoiseSpec::SpectralRadiance { .. } | NoiseSpec::Table { .. } => {
            let instead = "state it as netd, detectivity, nep or noise_electrons";
            return Err(Error::malformed("a noise that the reference does not know", instead));
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use hadar::instrument::presets;

    fn sigma(camera: &Camera, bands: &Bands) -> Vec<f64> {
        let signal = vec![Extended::zero(); bands.len()];
        let found = counted(camera, bands, &signal, Place::default()).unwrap();
        found.var_added.iter().map(|var| var.sqrt().to_f64()).collect()
    }

    /// Table S2 of the paper: 47.8 mK at 30 °C, f/1.3, 12 µm, 12 ms are 1.769e6 counts in front of the optics.
    #[test]
    fn the_noise_of_the_papers_bolometer() {
        let preset = presets::get("flir-a325sc").unwrap();
        let noise = NoiseSpec::Netd {
            netd_k: 47.8e-3,
            temperature_k: 303.15,
            f_number: 1.3,
            optics_efficiency: 1.0,
            pixel_m: 12e-6,
        };
        let camera = Camera { noise, flicker_fraction: 0.0, ..preset };
        let found = sigma(&camera, &Bands::uniform(800.0, 1200.0, 200.0).unwrap());
        assert!(found.iter().all(|sigma| (sigma / 1.769e6 - 1.0).abs() < 1e-3), "{found:?}");
        let etendue = etendue_m2_sr(&camera, None).to_f64();
        assert!((etendue / (std::f64::consts::PI * 12e-6 * 12e-6 / 6.76) - 1.0).abs() < 1e-14);
    }

    /// 1 pW at 1000 cm⁻¹ is 5.0341e7 photons a second; half of them counted in 0.01 s, with a bandwidth of 100 Hz and ten times
    /// the power of 1 Hz. A pixel of 1 cm² with D* = 10¹² cm √Hz W⁻¹ has the same noise.
    #[test]
    fn powers_are_photons() {
        let per_watt = 1.0 / (6.626_070_15e-34 * 29_979_245_800.0 * 1000.0);
        let bands = Bands::from_rows([(1000.0, 10.0)]).unwrap();
        let camera = Camera {
            pixel_m: 0.01,
            quantum_efficiency: 0.5,
            noise: NoiseSpec::Nep { nep_w_hz05: 1e-12, bandwidth_hz: Some(100.0) },
            noise_exposure_s: 0.01,
            exposure_s: 0.04,
            flicker_fraction: 0.25,
            ..presets::get("ideal-pnrd").unwrap()
        };
        // Four times the exposure: 0.75 · 4 + 0.25 · 16 of the variance.
        let expected = 0.5 * 1e-12 * 10.0 * per_watt * 0.01 * 7.0_f64.sqrt();
        assert!((sigma(&camera, &bands)[0] / expected - 1.0).abs() < 1e-13);
        let noise = NoiseSpec::Detectivity { detectivity_cm_hz05_w: 1e12, bandwidth_hz: None };
        let detector = Camera { noise, ..camera };
        let expected = expected * (50.0_f64 / 100.0).sqrt();
        assert!((sigma(&detector, &bands)[0] / expected - 1.0).abs() < 1e-13);
    }

    /// A target of a third of the footprint's side fills a ninth of the pixel; nearer than the focal length counts as it must.
    #[test]
    fn small_and_near_targets() {
        let camera = Camera {
            pixel_m: 10e-6,
            focal_length_m: 0.05,
            f_number: 0.5,
            ..presets::get("ideal-pnrd").unwrap()
        };
        let place = Place { distance_m: Some(150.0), size_m: Some(0.01) };
        assert!((fill(&camera, place).to_f64() * 9.0 - 1.0).abs() < 1e-14);
        assert_eq!(fill(&camera, Place { size_m: Some(1.0), ..place }).to_f64(), 1.0);
        // 4F² = 1 and (f/z)² = 1.
        let half = etendue_m2_sr(&camera, Some(0.05)) / etendue_m2_sr(&camera, None);
        assert!((half.to_f64() * 2.0 - 1.0).abs() < 1e-14);
    }
}
