//! Which cameras there can be: every figure in the range that its row of the table allows, and those that bound each other.

use super::figures::TABLE;
use super::{Camera, CameraSpec};
use crate::error::{Error, Result, check};

/// Share of a frame by which a stated exposure may exceed it: rounding.
const FRAME_ROUNDING: f64 = 0.01;
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
        Ok(self)
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
