//! A scenario answered: from names and files to physics, and from physics to results as data.
//!
//! [`Study`] is the scenario with its materials, bands, surroundings and camera looked up. Its
//! [`Study::identify`] gives the distances to every alternative, [`Study::size`] the verdict on the camera and what
//! each hardware quantity would have to be. Results are plain data that serialise to the JSON of the
//! command line; text, tables and plots only render them.

mod answers;
mod bands;
mod bands_that_matter;
mod camera;
mod chosen_bands;
mod curves;
mod distances;
mod envelope;
mod exact;
mod identify;
mod magnitudes;
mod matrix;
mod noise_curves;
mod priors;
pub mod ranging;
mod reliability;
mod resolve;
mod rule;
mod samples;
mod scaling;
mod sensitivity;
mod sight;
mod simulation;
mod size;
mod thermometry;
mod trade_offs;
mod warn;
mod within_reach;

pub use answers::{Answers, Asked};
pub use bands_that_matter::{BandsThatMatter, Choice, Passband};
pub use chosen_bands::Reached;
pub use curves::{InformationCurves, PhotonMap, Spectra};
pub use exact::{Exact, ExactLibrary, ExactPair, Law, Trial};
pub use identify::{Identifiability, Identification, NearestState, PairResult, Prediction};
pub use matrix::{Apart, Check, Matrix, Rows, TargetVerdict};
pub use noise_curves::{NoiseCurve, NoiseCurves};
pub use priors::PriorAverage;
pub use reliability::{probability, reliability};
pub use resolve::{Study, Surface};
pub use rule::{
    CameraVerdict, Certified, EnvelopeResult, FileHash, Fixes, LimitingScene, Neighbourhood, NotIdentifiable,
    RuleAnswer, RuleAsked, RuleRequirement, RuleStudy,
};
pub use samples::SampleSpectra;
pub use scaling::{BandNumber, LibrarySize, Scaling};
pub use sensitivity::{Elasticities, EmissivityErrors, Sensitivity};
pub use sight::Sight;
pub use simulation::{
    PhotonLaw, SimulatedClass, SimulatedPerformance, SimulatedPoint, Simulation, SimulationPlan, Standing,
};
pub use size::{CameraResult, RequirementResult, Sizing, Solutions, Verdict, VerdictAlone};
pub use thermometry::{FIXED_EMISSIVITY, ImagerErrors, Reader, Thermometry, ThermometryRow};

/// Something the reader of a result must know, with a code that programs can rely on.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Warning {
    /// Stable code, e.g. `nearest-at-edge`.
    pub code: &'static str,
    /// One sentence.
    pub message: String,
}

impl Warning {
    /// A warning of that code.
    #[must_use]
    pub fn new(code: &'static str, message: impl Into<String>) -> Self {
        Self { code, message: message.into() }
    }
}
