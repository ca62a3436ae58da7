//! Temperature differences that a camera shows: of its noise alone (NETD), and of bars for an observer (MRTD).
//!
//! * NETD = σ/(dN/dT) of one frame before a blackbody, N photons of all of the detector's range read as one, σ everything that a
//!   reading scatters by: shot noise, electronic noise at the camera's exposure, dark counts, steps of the converter (K);
//! * MTF(f) = (2/π)(arccos ν − ν√(1 − ν²)) · |sin(πpf)/(πpf)|, ν = λFf: a lens without aberrations of f-number F at a wavelength
//!   λ (m), and a pixel of side p (m) that is sensitive all over, at f cycles m⁻¹ in the image;
//! * MRTD(f) = k NETD/MTF(f) (K), k what an observer needs of four bars.
//!
//! Assumptions: the mean wavelength stands for all; no aberration, display, motion, nor noise between pixels. k holds all that is known
//! of eye and display; it is a choice, and other forms differ by factors. Beyond f = 1/(2p) bars are not sampled any more, and
//! no MRTD is meant.
//!
//! Sources, and how sure they are. k = 2.25: seen in a public radiometric program, which calls it the observer's signal-to-noise
//! threshold in the Night Vision Laboratory's literature, not seen; another one leaves k to its user. Lloyd's form, (π²/8) NETD
//! (f/MTF) √(αβ/(t_eye F_frame τ)) with the solid angle αβ of a pixel and the integration of the eye, seen in a third program as
//! Lloyd (1975), is another k that depends on f. ASTM E1543-14 (abstract, seen at the issuer's): NETD at a background of 295 K; 'intercomparisons
//! based solely on NETD figures may be misleading', for it depends on spectral bandwidth and background temperature; its scope is
//! scanning systems with photonic detectors, so that what is computed here is at its temperature, not by it. ASTM E1213-14 (abstract, seen
//! at the issuer's): MRTD differences below 0.2 °C are insignificant. Diffraction: J. W. Goodman, 'Introduction to Fourier
//! Optics', recalled; the same formula was seen in a public program.

use crate::error::{Result, check};
use crate::instrument::{Camera, Readout, budget};
use crate::spectrum::Bands;
use std::f64::consts::PI;

/// Background temperature of ASTM E1543, K.
pub const BACKGROUND_K: f64 = 295.0;
/// What an observer needs of four bars, in signal over noise.
pub const PERCEPTION: f64 = 2.25;
/// Differences of MRTD below it mean nothing (ASTM E1213), K.
pub const SIGNIFICANT_K: f64 = 0.2;

/// Below it x − sin x is summed as a series.
const SMALL: f64 = 0.5;

/// NETD in K of one frame of a camera before a blackbody at a temperature in K, all of its range read as one; infinite where
/// the blackbody sends nothing.
///
/// # Errors
/// A temperature that is not positive; as [`Camera::own_bands`].
///
/// ```
/// use hadar::policy::practice::resolution::{BACKGROUND_K, netd_k};
/// let camera = hadar::instrument::presets::get("flir-a325sc")?;
/// // 47.8 mK are stated at 30 degC, in front of optics that pass 0.99.
/// assert!((netd_k(&camera, 303.15)? / (47.8e-3 / 0.99) - 1.0).abs() < 1e-3);
/// assert!(netd_k(&camera, BACKGROUND_K)? > netd_k(&camera, 303.15)?);
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn netd_k(camera: &Camera, temperature_k: f64) -> Result<f64> {
    check::positive("temperature of the blackbody", temperature_k, "K")?;
    let frame = Camera { frames: 1, readout: Readout::Simultaneous, ..camera.clone() };
    let bands = frame.own_bands()?;
    let lines = frame.budget_of_blackbody(&bands, temperature_k);
    // Photons of all bands are in the one reading, its other noise once.
    let var = lines.iter().map(|line| match line.label {
        budget::SHOT | budget::BUNCHING => line.var_counts * bands.len() as f64,
        _ => line.var_counts,
    });
    Ok(var.sum::<f64>().sqrt() / frame.counts_per_kelvin(temperature_k))
}

/// Wavelength in m, mean over wavenumber of what reaches the detector in its bands.
///
/// ```
/// use hadar::policy::practice::resolution::mean_wavelength_m;
/// let one = hadar::spectrum::Bands::from_rows([(1000.0, 100.0)])?;
/// assert!((mean_wavelength_m(&one) / 10e-6 - 1.0).abs() < 1e-12);
/// # Ok::<(), hadar::Error>(())
/// ```
#[must_use]
pub fn mean_wavelength_m(bands: &Bands) -> f64 {
    let with_weight = bands.nodes_cm1().iter().zip(bands.weights_cm1());
    let weighed: f64 = with_weight.map(|(node, weight)| weight * 1e-2 / node).sum();
    weighed / bands.weights_cm1().iter().sum::<f64>()
}

/// What lens and pixel leave of the contrast of a fine pattern.
///
/// ```
/// use hadar::policy::practice::resolution::Transfer;
/// // f/1 at 10 um before 12 um: a pixel of 12 um keeps 2/pi of what just fits it.
/// let transfer = Transfer::new(10e-6, 1.0, 12e-6)?;
/// let finest = transfer.nyquist_per_m();
/// assert!((transfer.pixel(finest) - 2.0 / std::f64::consts::PI).abs() < 1e-15);
/// assert!((transfer.at(finest) - 0.309).abs() < 1e-3);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transfer {
    /// λF, m.
    blur_m: f64,
    pixel_m: f64,
}

impl Transfer {
    /// Of a wavelength in m, an f-number and the side of a pixel in m.
    ///
    /// # Errors
    /// Any of them that is not positive and finite.
    pub fn new(wavelength_m: f64, f_number: f64, pixel_m: f64) -> Result<Self> {
        let wavelength_m = check::positive("wavelength", wavelength_m, "m")?;
        let f_number = check::positive("f-number", f_number, "")?;
        let blur_m = check::positive("blur of the lens", wavelength_m * f_number, "m")?;
        Ok(Self { blur_m, pixel_m: check::positive("pixel", pixel_m, "m")? })
    }

    /// Of a camera, at the mean wavelength of bands as it receives them.
    ///
    /// # Errors
    /// As [`Transfer::new`].
    pub fn of(camera: &Camera, bands: &Bands) -> Result<Self> {
        Self::new(mean_wavelength_m(bands), camera.f_number, camera.pixel_m)
    }

    /// The finest pattern that pixels sample, 1/(2p), cycles m⁻¹ in the image.
    #[must_use]
    pub fn nyquist_per_m(self) -> f64 {
        0.5 / self.pixel_m
    }

    /// The pattern of which the lens leaves nothing, 1/(λF), cycles m⁻¹ in the image.
    #[must_use]
    pub fn cutoff_per_m(self) -> f64 {
        1.0 / self.blur_m
    }

    /// What a circular lens without aberrations leaves at cycles m⁻¹ in the image.
    #[must_use]
    pub fn lens(self, frequency_per_m: f64) -> f64 {
        let angle = 2.0 * (self.blur_m * frequency_per_m.abs()).min(1.0).acos();
        if angle >= SMALL {
            return (angle - angle.sin()) / PI;
        }
        // Near the cut-off the two cancel: x − sin x = x³/6 (1 − x²/20 (1 − x²/42 (1 − x²/72 (1 − x²/110)))).
        let square = angle * angle;
        let series = [110.0, 72.0, 42.0, 20.0].iter().fold(1.0, |series, term| 1.0 - square / term * series);
        angle * square / 6.0 * series / PI
    }

    /// What the width of a pixel leaves at cycles m⁻¹ in the image.
    #[must_use]
    pub fn pixel(self, frequency_per_m: f64) -> f64 {
        let angle = PI * self.pixel_m * frequency_per_m;
        if angle == 0.0 { 1.0 } else { (angle.sin() / angle).abs() }
    }

    /// What both leave.
    #[must_use]
    pub fn at(self, frequency_per_m: f64) -> f64 {
        self.lens(frequency_per_m) * self.pixel(frequency_per_m)
    }
}

/// MRTD in K of an NETD in K where the share `transfer` of the contrast is left; infinite where none is.
///
/// ```
/// use hadar::policy::practice::resolution::{PERCEPTION, mrtd_k};
/// assert_eq!(mrtd_k(PERCEPTION, 40e-3, 0.5), 0.18);
/// ```
#[must_use]
pub fn mrtd_k(perception: f64, netd_k: f64, transfer: f64) -> f64 {
    perception * netd_k / transfer
}

#[cfg(all(test, feature = "library"))]
mod tests {
    use super::*;

    #[track_caller]
    fn near(found: f64, exact: f64, tolerance: f64) {
        assert!((found / exact - 1.0).abs() <= tolerance, "{found:e} against {exact:e}");
    }

    /// At ν = ½ it is 2/3 − √3/(2π), at ν = cos θ (2θ − sin 2θ)/π; a quarter of a cycle a pixel leaves 2√2/π.
    #[test]
    fn the_transfer_at_values_that_are_known() {
        let transfer = Transfer::new(10e-6, 1.2, 12e-6).unwrap();
        let cutoff = transfer.cutoff_per_m();
        near(cutoff, 1.0 / 12e-6, 1e-15);
        near(transfer.nyquist_per_m(), 1.0 / 24e-6, 1e-15);
        assert_eq!([transfer.lens(0.0), transfer.pixel(0.0)], [1.0; 2]);
        near(transfer.lens(0.5 * cutoff), 2.0 / 3.0 - 3f64.sqrt() / (2.0 * PI), 1e-14);
        near(transfer.lens(0.5f64.sqrt() * cutoff), 0.5 - 1.0 / PI, 1e-14);
        near(transfer.pixel(0.25 / 12e-6), 8f64.sqrt() / PI, 1e-14);
        near(transfer.at(0.5 * cutoff), (2.0 / 3.0 - 3f64.sqrt() / (2.0 * PI)) * 2.0 / PI, 1e-14);
        assert_eq!([cutoff, 2.0 * cutoff].map(|beyond| transfer.lens(beyond)), [0.0; 2]);
        assert!(transfer.pixel(1.0 / 12e-6) < 1e-15);
    }

    /// The exact values are of arithmetic with 50 digits.
    #[test]
    fn what_is_left_near_the_cut_off_keeps_its_digits() {
        let transfer = Transfer::new(1.0, 1.0, 1.0).unwrap();
        for (power, exact) in [
            (-5, 6.600_283_748_507_714e-3),
            (-10, 3.662_859_791_596_784_6e-5),
            (-30, 3.411_803_830_625_912e-14),
        ] {
            // 1 − 2^power has no rounding: what is left is that of the arc cosine, three times over.
            near(transfer.lens(1.0 - 2f64.powi(power)), exact, 2e-15);
        }
        // No step where the series begins.
        let [series, closed] = [SMALL - 1e-9, SMALL].map(|angle| transfer.lens((0.5 * angle).cos()));
        near(closed, series, 1e-7);
    }

    /// The numbers are sums of Planck's law over 715 to 1250 cm⁻¹ by another program.
    #[test]
    fn the_noise_of_the_bolometer_in_kelvin() {
        let mut camera = crate::instrument::presets::get("flir-a325sc").unwrap();
        let own = netd_k(&camera, 303.15).unwrap();
        // 47.8 mK in front of optics of 0.99, less the shot noise there and with that behind them; by sums over Planck's law elsewhere.
        near(own, 48.282_632_9e-3, 1e-8);
        near(netd_k(&camera, BACKGROUND_K).unwrap(), 51.882_599_9e-3, 1e-8);
        let ideal = crate::instrument::presets::get("ideal-pnrd").unwrap();
        near(netd_k(&ideal, BACKGROUND_K).unwrap(), 1.381_651_94e-3, 1e-8);
        // Frames do not count, read noise does, and flicker alone does not care for the exposure.
        camera.frames = 60;
        assert_eq!(netd_k(&camera, 303.15).unwrap(), own);
        camera.read_noise_counts = 1.767_47e6;
        near(netd_k(&camera, 303.15).unwrap() / own, 2f64.sqrt(), 1e-3);
        camera.read_noise_counts = 0.0;
        (camera.flicker_fraction, camera.exposure_s) = (1.0, 4.0 * camera.exposure_s);
        near(netd_k(&camera, 303.15).unwrap(), own, 1e-3);
        camera.flicker_fraction = 0.0;
        near(netd_k(&camera, 303.15).unwrap(), 0.5 * own, 1e-3);
    }

    /// The instrument's own statement of its noise, where it is stated.
    #[test]
    fn the_noise_is_that_of_the_data_sheet() {
        for preset in ["flir-a325sc", "nicolet-is50", "ideal-pnrd"] {
            let camera = crate::instrument::presets::get(preset).unwrap();
            let stated = camera.equivalents().unwrap();
            let found = netd_k(&camera, stated.reference_temperature_k).unwrap();
            near(found, stated.netd_with_shot_noise_k, 1e-12);
        }
    }

    #[test]
    fn a_resolvable_difference_is_as_the_noise_over_the_contrast() {
        near(mrtd_k(2.25, 50e-3, 0.4), 0.28125, 1e-14);
        assert_eq!(mrtd_k(2.25, 50e-3, 0.0), f64::INFINITY);
        let bands = Bands::uniform(800.0, 1250.0, 1.0).unwrap();
        // ln(ν₂/ν₁)/(ν₂ − ν₁) between the outer edges.
        near(mean_wavelength_m(&bands), 1e-2 * (1250.5f64 / 799.5).ln() / 451.0, 1e-6);
    }

    #[test]
    fn what_is_no_lens_is_named() {
        for ([wavelength, f_number, pixel], named) in [
            ([0.0, 1.0, 1.0], "wavelength"),
            ([1.0, f64::NAN, 1.0], "f-number"),
            ([1.0, 1.0, -1.0], "pixel"),
            ([1e-300, 1e-300, 1.0], "blur of the lens"),
        ] {
            let error = Transfer::new(wavelength, f_number, pixel).unwrap_err().to_string();
            assert!(error.starts_with(named), "{error}");
        }
        let camera = crate::instrument::presets::get("ideal-pnrd").unwrap();
        assert!(netd_k(&camera, -1.0).is_err());
    }
}
