//! Thermal imaging without a spectrum: one sum of counts, one stated emissivity.
//!
//! The counts of all bands together are explained by a grey body of emissivity e that reflects blackbody surroundings
//! of temperature T₀ from all around (lighting 1), or nothing:
//!
//! S = e ΣB(T) + (1 − e) ΣB(T₀),  solved for T.
//!
//! * [`Conventional::with_surroundings`]: e as a default (0.95 in the paper's figure), T₀ that of the surroundings;
//! * [`Conventional::calibrated`]: e entered by hand such that the reading is right in one state, with scattered signal
//!   ignored: e = S/ΣB(T). It deviates in every other state, since the scattered part does not grow with the target's.
//!
//! Both are exact models of what is done in the figure's description; what is not stated there (T₀, whether any
//! reflection is subtracted after the calibration) is assumed as written here.

use super::ThermometryScene;
use hadar::error::{Result, check};
use hadar::planck;
use hadar::root::crossing;
use hadar::scene::{State, Surroundings};

/// Readings are looked for between these temperatures, K.
const RANGE_K: [f64; 2] = [10.0, 1e5];

/// How a thermal imager makes a temperature of a sum of counts.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Conventional {
    /// Emissivity e in all bands; above 1 where a calibration in warm surroundings asks for it.
    pub emissivity: f64,
    /// Temperature T₀ of the surroundings that it subtracts, K; `None` to subtract nothing.
    pub reflected_k: Option<f64>,
}

/// What it reads.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reading {
    /// A temperature, K.
    Kelvin(f64),
    /// No body above 10 K is so dark, after subtraction.
    TooDark,
    /// No body below 10⁵ K is so bright.
    TooBright,
}

impl Conventional {
    /// A stated emissivity, in (0, 1], and black surroundings all around at the temperature of the first object; no
    /// reflection if there is none.
    ///
    /// # Errors
    /// An emissivity outside (0, 1].
    pub fn with_surroundings(emissivity: f64, surroundings: &Surroundings) -> Result<Self> {
        check::positive("emissivity of the thermal imager", emissivity, "")?;
        check::unit_interval("emissivity of the thermal imager", emissivity)?;
        let reflected_k = surroundings.objects().first().map(|object| object.temperature_k);
        Ok(Self { emissivity, reflected_k })
    }

    /// The emissivity that makes the reading right in `state`, without noise, when nothing is subtracted.
    ///
    /// # Errors
    /// A state that does not fit the scene, or one without photons.
    pub fn calibrated(scene: &ThermometryScene<'_>, state: &State) -> Result<Self> {
        let counts = hadar::sum::sum(&scene.means(state)?);
        let emissivity = counts / scene.blackbody_counts(state.temperature_k);
        check::positive("emissivity by calibration", emissivity, "")?;
        Ok(Self { emissivity, reflected_k: None })
    }
}

impl ThermometryScene<'_> {
    /// What a thermal imager reads from `counts` in all bands together.
    #[must_use]
    pub fn reading(&self, conventional: &Conventional, counts: f64) -> Reading {
        let Conventional { emissivity, reflected_k } = *conventional;
        let reflected = reflected_k.map_or(0.0, |t| (1.0 - emissivity) * self.blackbody_counts(t));
        let emitted = (counts - reflected) / emissivity;
        let [low, high] = RANGE_K;
        if emitted.is_nan() || emitted <= self.blackbody_counts(low) {
            return Reading::TooDark;
        }
        if emitted >= self.blackbody_counts(high) {
            return Reading::TooBright;
        }
        // ln ΣB is nearly a straight line over −1/T: a few steps suffice.
        let wanted = emitted.ln();
        let off = |inverse: f64| -> Result<f64> { Ok(self.blackbody_counts(-1.0 / inverse).ln() - wanted) };
        match crossing(-1.0 / low, -1.0 / high, off) {
            Ok(inverse) => Reading::Kelvin(-1.0 / inverse),
            Err(_) => Reading::TooDark,
        }
    }

    /// Counts of a blackbody in all bands together.
    fn blackbody_counts(&self, temperature_k: f64) -> f64 {
        let nodes = self.surroundings.nodes_cm1();
        let mut radiance = vec![0.0; nodes.len()];
        planck::photon_radiance_into(nodes, temperature_k, &mut radiance);
        self.counting.counts_per_radiance * hadar::sum::sum(&self.bands.weigh(&radiance))
    }
}
