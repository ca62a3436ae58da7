//! Which cameras there can be: every figure in the range that its row of the table allows, and those that bound each other.

use super::figures::TABLE;
use super::{Camera, CameraSpec, NoiseSpec};
use crate::error::{Error, Result, check};
use crate::words::significant;

/// Share of a frame by which a stated exposure may exceed it: rounding.
const FRAME_ROUNDING: f64 = 0.01;
/// What a least value is raised by, so that as it is printed, in four digits, it is allowed.
const PRINTED: f64 = 1.000_51;
/// The most bits a converter has.
const MOST_BITS: u32 = 32;

impl Camera {
    /// Checks every figure.
    ///
    /// # Errors
    /// The first figure that is out of range, by its name in the scenario.
    pub fn checked(self) -> Result<Self> {
        let figures = CameraSpec::of(&self);
        TABLE.iter().try_for_each(|row| row.check(&figures))?;
        check::positive("reference temperature", self.reference_temperature_k, "K")?;
        self.check_frame()?;
        if self.quantisation_bits.is_some() && self.full_well.is_none() {
            return Err(Error::malformed(
                "quantisation_bits without a full_well to divide",
                "write full_well = 1e7 beside it",
            ));
        }
        if let Some(bits) = self.quantisation_bits.filter(|bits| *bits > MOST_BITS) {
            let bits = f64::from(bits);
            return Err(Error::out_of_range("quantisation_bits", bits, "", format!("at most {MOST_BITS}")));
        }
        if self.filter_temperature_k.is_some() && self.sensor_temperature_k.is_none() {
            return Err(Error::malformed(
                "filter_temperature without a sensor_temperature",
                "write sensor_temperature = \"30 degC\" beside it",
            ));
        }
        let [low, high] = self.spectral_range_cm1;
        check::positive("spectral range", low, "cm^-1")?;
        if high <= low {
            return Err(Error::out_of_range("spectral range", high, "cm^-1", format!("above {low} cm^-1")));
        }
        self.noise.check()?;
        self.check_netd()?;
        Ok(self)
    }

    /// Refuses a NETD that is below the shot noise of its own conditions.
    fn check_netd(&self) -> Result<()> {
        let NoiseSpec::Netd { netd_k, temperature_k, f_number, pixel_m, .. } = self.noise else {
            return Ok(());
        };
        let least_k = self.least_netd_k().unwrap_or(0.0);
        // Conditions under which nothing is counted are refused with the noise that they make.
        if netd_k >= least_k || !least_k.is_finite() {
            return Ok(());
        }
        let least = significant(1e3 * least_k * PRINTED, 4);
        // Without the digits of a conversion of units.
        let [kelvin, pixel, exposure] = [temperature_k, 1e6 * pixel_m, 1e3 * self.noise_exposure_s]
            .map(|value| significant(value, 5).parse().unwrap_or(value));
        let expected = format!(
            "at least {least} mK, the shot noise of a blackbody of {kelvin} K at f/{f_number}, {pixel} um and {exposure} ms, which a \
             measured NETD contains"
        );
        Err(Error::out_of_range("netd", netd_k, "K", expected))
    }

    /// Refuses an exposure that is longer than a frame.
    fn check_frame(&self) -> Result<()> {
        let Some(rate) = self.frame_rate_hz else { return Ok(()) };
        // Stated figures are rounded: 16.7 ms at 60 Hz is a whole frame.
        if self.exposure_s * rate <= 1.0 + FRAME_ROUNDING {
            return Ok(());
        }
        let frame_ms = (1e7 / rate).round() / 1e4;
        Err(Error::out_of_range(
            "exposure",
            self.exposure_s,
            "s",
            format!("at most the {frame_ms} ms of a frame (frame_rate = \"{rate} Hz\")"),
        ))
    }
}
