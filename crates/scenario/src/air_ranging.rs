//! A scenario of ranging by air: one camera, a target, its surroundings, and the air between, whose absorption is the ruler.
//!
//! It is a ranging scenario with `signal = "air"` above its first table. `[target]`, `[[environment]]`, `[atmosphere]`, `[bands]` and
//! `[camera]` are those of a [`Scenario`]; `[unknown]` has the temperature of the air and the emissivity among its unknowns too.

mod read;
mod write;

use super::range::Subject;
use super::{RangeScenario, Scenario};
use hadar::error::{Error, Result};
pub use hadar::ranging::air::SmoothEmissivity;
pub use hadar::ranging::depth::Demand;

/// Most draws of the noise.
const MOST_TRIALS: usize = 1_000_000;

/// Everything a scenario of ranging by air says, defaults filled in.
///
/// ```
/// use hadar_scenario::AirRangingScenario;
/// let text = r#"
///     signal = "air"
///     [target]
///     material = "skin"
///     temperature = "37 degC"
///     distance = "50 m"
///     [atmosphere]
///     model = "us-standard"
///     [camera]
///     preset = "flir-a325sc"
/// "#;
/// let scenario = AirRangingScenario::from_toml(text, None)?;
/// assert_eq!((scenario.distances_m[0], scenario.unknown.emissivity), (5.0, None));
/// let error = AirRangingScenario::from_toml(&text.replace("50 m", "0 m"), None).unwrap_err();
/// assert!(error.to_string().starts_with("line 6: target.distance: `0 m` is out of range"));
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct AirRangingScenario {
    /// Target (with its distance), surroundings, air, bands, camera, and what of them is unknown.
    pub scene: Scenario,
    /// What else is unknown.
    pub unknown: AirUnknown,
    /// Distances at which the error is asked for, m, ascending; each above 0.
    pub distances_m: Vec<f64>,
    /// A second camera to compare with.
    pub stereo: Option<AirStereo>,
    /// How well the distance must be known.
    pub requirement: Option<Demand>,
}

/// What is unknown of air and emissivity (`[unknown]`).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AirUnknown {
    /// The temperature of the air, with the deviation of its prior, K, where it has one.
    pub air_temperature: Option<Option<f64>>,
    /// Errors of the emissivity; it is known exactly if silent.
    pub emissivity: Option<SmoothEmissivity>,
}

/// A second camera beside the first, and what of the target it could match (`[stereo]`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AirStereo {
    /// Distance of the two cameras, m.
    pub baseline_m: f64,
    /// Rows and columns of the window that is matched.
    pub window: [usize; 2],
    /// Root mean square change of the target's own light from pixel to pixel, as a share of it.
    pub texture: f64,
}

/// What a ranging scenario reads distances from.
#[derive(Debug, Clone)]
pub enum RangingScenario {
    /// Two views.
    Stereo(Box<RangeScenario>),
    /// The air on the path.
    Air(Box<AirRangingScenario>),
}

impl RangingScenario {
    /// Whether so many draws, and so many bands, can be asked for. Messages name the flags of the command line.
    ///
    /// # Errors
    /// A single draw or more than a million; bands of a stereo scenario; draws of a cube, whose truth nobody knows.
    pub fn check_asked(&self, trials: usize, bands: Option<usize>) -> Result<()> {
        if trials == 1 {
            let expected = "at least 2, for one error has no scatter; 0 for the bounds alone";
            return Err(Error::out_of_range("--trials", 1.0, "", expected));
        }
        if trials > MOST_TRIALS {
            return Err(Error::out_of_range("--trials", trials as f64, "", format!("at most {MOST_TRIALS}")));
        }
        let Self::Stereo(scenario) = self else { return Ok(()) };
        if bands.is_some() {
            let instead =
                "leave it out; bands are chosen for signal = \"air\", or of a pair by identify --bands";
            return Err(Error::malformed("--bands of a stereo scenario", instead));
        }
        if trials > 0 && matches!(scenario.subject, Subject::Cube(_)) {
            let found = "--trials match views whose truth is known, which a cube's is not";
            return Err(Error::malformed(found, "leave it out, or give a [scene]"));
        }
        Ok(())
    }
}
