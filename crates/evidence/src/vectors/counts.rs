//! Counts of a camera and the noise beside them, from band signals that are given.

use super::answer::{Answer, Vector, reach};
use super::json::Json;
use super::topic::Topic;
use crate::reference::Extended;
use crate::reference::camera::{Place, counted, etendue_m2_sr};
use hadar::error::Result;
use hadar::instrument::{Camera, NoiseSpec, PAPER_RANGE_CM1, Readout, presets};
use hadar::spectrum::Bands;

/// Centre and width of three bands, cm⁻¹, and what arrives in them, photons s⁻¹ m⁻² sr⁻¹.
const BANDS_CM1: [(f64, f64); 3] = [(800.0, 50.0), (1000.0, 50.0), (1200.0, 50.0)];
const SIGNAL: [f64; 3] = [4.5e20, 3.0e20, 1.75e20];

/// A camera without noise that is stated in full.
pub(super) fn camera() -> Result<Camera> {
    Ok(Camera {
        exposure_s: 0.012,
        pixel_m: 17e-6,
        f_number: 1.2,
        focal_length_m: 0.025,
        optics_efficiency: 0.9,
        quantum_efficiency: 0.6,
        efficiency_curves: Vec::new(),
        noise: NoiseSpec::None,
        noise_exposure_s: 0.012,
        flicker_fraction: 0.0,
        dark_rate_per_s: 0.0,
        read_noise_counts: 0.0,
        quantisation_bits: None,
        full_well: None,
        photon_bunching: false,
        readout: Readout::Simultaneous,
        frames: 1,
        frame_rate_hz: None,
        spectral_range_cm1: PAPER_RANGE_CM1,
        ..presets::get("ideal-pnrd")?
    })
}

/// NETD of the camera as it is.
pub(super) fn netd(netd_k: f64, camera: &Camera) -> NoiseSpec {
    NoiseSpec::Netd {
        netd_k,
        temperature_k: 303.15,
        f_number: camera.f_number,
        optics_efficiency: camera.optics_efficiency,
        pixel_m: camera.pixel_m,
    }
}

pub(super) fn topic() -> Result<Topic> {
    let base = camera()?;
    let near = Place { distance_m: Some(0.05), size_m: None };
    let far = Place { distance_m: Some(30.0), size_m: None };
    let noisy = Camera { noise: NoiseSpec::Counts { sigma_counts: 3e4 }, ..base.clone() };
    let spectrometer = Camera {
        readout: Readout::FourierTransform,
        noise: NoiseSpec::Detectivity { detectivity_cm_hz05_w: 4.7e10, bandwidth_hz: None },
        noise_exposure_s: 2.86e-6,
        exposure_s: 2.86e-6,
        ..base.clone()
    };
    let asked = [
        (
            "far",
            "no distance: infinitely far; no noise but that of the photons",
            base.clone(),
            Place::default(),
        ),
        ("thirty-metres", "(f/z)^2 = 7e-7 counts", base.clone(), far),
        ("macro", "a target nearer than two focal lengths", base.clone(), near),
        (
            "small-target",
            "a target that fills a quarter of the pixel's footprint",
            base.clone(),
            Place { distance_m: Some(50.0), size_m: Some(0.017) },
        ),
        (
            "frames",
            "frames add counts, Johnson noise and read noise",
            Camera { frames: 16, read_noise_counts: 250.0, ..noisy.clone() },
            far,
        ),
        (
            "netd",
            "noise of a data sheet: NETD times dN/dT of a blackbody of 303.15 K, less the shot noise of its photons, in squares",
            Camera { noise: netd(0.05, &base), ..base.clone() },
            far,
        ),
        (
            "netd-elsewhere",
            "an NETD that was stated for another lens, pixel, temperature and exposure",
            Camera {
                noise: NoiseSpec::Netd {
                    netd_k: 0.03,
                    temperature_k: 298.15,
                    f_number: 1.0,
                    optics_efficiency: 1.0,
                    pixel_m: 25e-6,
                },
                noise_exposure_s: 0.01,
                ..base.clone()
            },
            far,
        ),
        (
            "detectivity",
            "D* in the bandwidth of the exposure",
            Camera {
                noise: NoiseSpec::Detectivity { detectivity_cm_hz05_w: 2e9, bandwidth_hz: None },
                ..base.clone()
            },
            far,
        ),
        (
            "nep",
            "NEP in a bandwidth that is stated",
            Camera { noise: NoiseSpec::Nep { nep_w_hz05: 3e-12, bandwidth_hz: Some(100.0) }, ..base.clone() },
            far,
        ),
        (
            "johnson",
            "eight times the exposure for which the noise is stated",
            Camera { exposure_s: 0.096, ..noisy.clone() },
            far,
        ),
        (
            "flicker",
            "a third of it is flicker, which grows as the square of exposure times frames",
            Camera { exposure_s: 0.096, frames: 4, flicker_fraction: 0.3, ..noisy.clone() },
            far,
        ),
        (
            "dark-and-steps",
            "dark counts, read noise and the steps of a 14-bit converter",
            Camera {
                dark_rate_per_s: 2e6,
                read_noise_counts: 400.0,
                quantisation_bits: Some(14),
                full_well: Some(3e7),
                frames: 2,
                ..base.clone()
            },
            far,
        ),
        (
            "huge-noise",
            "noise 1e24 times the photons",
            Camera { noise: NoiseSpec::Counts { sigma_counts: 1e16 }, ..base },
            far,
        ),
        (
            "interferometer",
            "every band is read all the time, and carries the noise of all",
            spectrometer,
            far,
        ),
    ];
    let vectors = asked.into_iter().map(|(id, about, camera, place)| vector(id, about, &camera, place));
    Ok(Topic {
        name: "counts",
        title: "Counts of a camera and the noise beside them",
        catches: "the pixel's side for its area, F for 2F, a half or a whole angle, a distance of which only the square counts, an \
                  efficiency forgotten or counted twice, noise scaled as its variance, or the variance as the deviation, \
                  with exposure and frames; NETD of the wrong lens; D* in m for cm, or a bandwidth of 1/t for 1/(2t)",
        vectors: vectors.collect::<Result<_>>()?,
        files: Vec::new(),
    })
}

fn vector(id: &'static str, about: &'static str, camera: &Camera, place: Place) -> Result<Vector> {
    let bands = Bands::from_rows(BANDS_CM1)?;
    let signal = SIGNAL.map(Extended::from);
    let found = counted(camera, &bands, &signal, place)?;
    let counts: Vec<Extended> = signal.iter().map(|signal| &found.counts_per_radiance * signal).collect();
    let sum = |values: &[Extended]| -> Extended { values.iter().cloned().sum() };
    let gamma = sum(&found.var_added) / sum(&counts);
    let [centers, widths] = [BANDS_CM1.map(|band| band.0), BANDS_CM1.map(|band| band.1)];
    let inputs = Json::object([
        ("band_wavenumber_cm1", centers.as_slice().into()),
        ("band_width_cm1", widths.as_slice().into()),
        ("band_signal_per_s_m2_sr", SIGNAL.as_slice().into()),
        ("camera", camera_json(camera)),
        ("distance_m", place.distance_m.into()),
        ("target_size_m", place.size_m.into()),
    ]);
    // Sums of slopes over a camera's range at hcν/kT up to 6, and products.
    let reach = reach(6.0);
    let answers = [
        ("etendue_m2_sr", Answer::one(&etendue_m2_sr(camera, place.distance_m), reach)),
        ("counts_per_radiance_s_m2_sr", Answer::one(&found.counts_per_radiance, reach)),
        ("counts", Answer::many(&counts, reach)),
        ("added_variance_counts2", Answer::many(&found.var_added, reach)),
        ("gamma", Answer::one(&gamma, reach)),
    ];
    Ok(Vector::new(id, about, inputs, answers))
}

/// A camera as its inputs are written.
pub(super) fn camera_json(camera: &Camera) -> Json {
    let noise = match camera.noise {
        NoiseSpec::Netd { netd_k, temperature_k, f_number, optics_efficiency, pixel_m } => Json::object([
            ("netd_k", netd_k.into()),
            ("netd_temperature_k", temperature_k.into()),
            ("netd_f_number", f_number.into()),
            ("netd_optics_efficiency", optics_efficiency.into()),
            ("netd_pixel_m", pixel_m.into()),
            ("spectral_range_cm1", camera.spectral_range_cm1.as_slice().into()),
        ]),
        NoiseSpec::Detectivity { detectivity_cm_hz05_w, bandwidth_hz } => Json::object([
            ("detectivity_cm_hz05_w", detectivity_cm_hz05_w.into()),
            ("noise_bandwidth_hz", bandwidth_hz.into()),
        ]),
        NoiseSpec::Nep { nep_w_hz05, bandwidth_hz } => {
            Json::object([("nep_w_hz05", nep_w_hz05.into()), ("noise_bandwidth_hz", bandwidth_hz.into())])
        }
        NoiseSpec::Counts { sigma_counts } => Json::object([("noise_counts", sigma_counts.into())]),
        NoiseSpec::None | NoiseSpec::SpectralRadiance { .. } | NoiseSpec::Table { .. } => Json::Null,
    };
    Json::object([
        ("pixel_m", camera.pixel_m.into()),
        ("f_number", camera.f_number.into()),
        ("focal_length_m", camera.focal_length_m.into()),
        ("optics_efficiency", camera.optics_efficiency.into()),
        ("quantum_efficiency", camera.quantum_efficiency.into()),
        ("exposure_s", camera.exposure_s.into()),
        ("frames", f64::from(camera.frames).into()),
        ("readout", camera.readout.name().into()),
        ("noise", noise),
        ("noise_exposure_s", camera.noise_exposure_s.into()),
        ("flicker_fraction", camera.flicker_fraction.into()),
        ("dark_rate_per_s", camera.dark_rate_per_s.into()),
        ("read_noise_counts", camera.read_noise_counts.into()),
        ("full_well_counts", camera.full_well.into()),
        ("quantisation_bits", camera.quantisation_bits.map(f64::from).into()),
    ])
}
