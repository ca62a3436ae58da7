//! A scenario with everything it names looked up: what all questions about it start from.

use super::Warning;
use super::air::{Air, Behind};
use super::classes::{ClassAnswer, Members};
use super::integration::Integration;
use super::remembered::Remembered;
use super::surface::Surface;
use hadar::demand::Work;
use hadar::error::{Error, Result, check};
use hadar::fisher::{Nuisance, Unknowns};
use hadar::identifiability::nearest::StateRange;
use hadar::instrument::Camera;
use hadar::scene::{State, Surroundings};
use hadar::spectrum::Bands;
use hadar_scenario::{Scenario, Units};

/// A scenario with everything it names looked up and checked.
#[derive(Debug, Clone)]
pub struct Study {
    pub(super) scenario: Scenario,
    /// The bands as they leave the target.
    pub(super) open_bands: Bands,
    /// The same behind path, optics and detector: what is counted.
    pub(super) bands: Bands,
    /// How they integrate the spectra.
    pub(super) integration: Integration,
    /// The air on the path.
    pub(super) atmosphere: Option<Air>,
    /// Emission of the path at the nodes, photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹; empty for none.
    pub(super) air: Vec<f64>,
    /// What is behind a target that does not fill the pixel.
    pub(super) behind: Option<Behind>,
    pub(super) surroundings: Surroundings,
    pub(super) state: State,
    pub(super) unknowns: Unknowns,
    pub(super) range: StateRange,
    pub(super) target: Surface,
    pub(super) alternatives: Vec<Surface>,
    /// With classes, the member of the target's that is nearest to each alternative; else empty.
    pub(super) paired: Vec<Surface>,
    /// What the target, and the alternatives, may be of: classes with their members, materials of one.
    pub(super) members: [Vec<Members>; 2],
    /// What the members of classes say together, alternative by alternative; empty without classes.
    pub(super) classes: Vec<ClassAnswer>,
    pub(super) camera: Option<Camera>,
    pub(super) required: f64,
    /// To what share of itself a nearest distance is proved, if somebody asks.
    pub(super) tolerance: Option<f64>,
    /// Skies of the library that are no alternatives.
    pub(super) skies: Vec<String>,
    /// Materials that do not cover the bands and were left out, as was asked for.
    pub(super) left_out: Vec<String>,
    /// Materials that do not cover the bands and are guessed beyond their spectra, as was asked for.
    pub(super) extrapolated: Vec<String>,
    pub(super) warnings: Vec<Warning>,
    /// What it took to look everything up.
    pub(super) looked_up: Work,
    /// What it shares with others.
    pub(super) remembered: Option<Remembered>,
}

impl Study {
    /// The scenario with its defaults filled in.
    #[must_use]
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// The same, with nearest distances proved to this share of themselves.
    ///
    /// # Errors
    /// A share that is not above 0 and below 1.
    pub fn proving(self, share: f64) -> Result<Self> {
        check::positive("share to which a distance is proved", share, "")?;
        if share >= 1.0 {
            let quantity = "share to which a distance is proved";
            return Err(Error::out_of_range(quantity, share, "", "above 0 and below 1, e.g. 1e-6"));
        }
        Ok(Self { tolerance: Some(share), ..self })
    }

    /// The units in which the scenario was written.
    #[must_use]
    pub fn units(&self) -> Units {
        self.scenario.units()
    }

    /// The bands.
    #[must_use]
    pub fn bands(&self) -> &Bands {
        &self.bands
    }

    /// The surroundings.
    #[must_use]
    pub fn surroundings(&self) -> &Surroundings {
        &self.surroundings
    }

    /// The state of the target.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The unknowns.
    #[must_use]
    pub fn unknowns(&self) -> &Unknowns {
        &self.unknowns
    }

    /// The range of the alternatives' states.
    #[must_use]
    pub fn range(&self) -> StateRange {
        self.range
    }

    /// The target.
    #[must_use]
    pub fn target(&self) -> &Surface {
        &self.target
    }

    /// The alternatives.
    #[must_use]
    pub fn alternatives(&self) -> &[Surface] {
        &self.alternatives
    }

    /// The camera, if the scenario has one.
    #[must_use]
    pub fn camera(&self) -> Option<&Camera> {
        self.camera.as_ref()
    }

    /// The statistical distance that the requirement demands.
    #[must_use]
    pub fn required_distance(&self) -> f64 {
        self.required
    }

    /// Skies of the library that were left out where the scenario names no alternatives.
    #[must_use]
    pub fn skies_left_out(&self) -> &[String] {
        &self.skies
    }

    /// Whether a nuisance is among the unknowns.
    pub(super) fn is_unknown(&self, nuisance: Nuisance) -> bool {
        self.unknowns.contains(nuisance)
    }
}
