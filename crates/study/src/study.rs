//! A scenario answered: from names and files to physics, and from physics to results as data.
//!
//! [`Study`] is the scenario with its materials, bands, surroundings and camera looked up. Its
//! [`Study::identify`] gives the distances to every alternative, [`Study::size`] the verdict on the camera and what
//! each hardware quantity would have to be. Results are plain data that serialise to the JSON of the
//! command line; text, tables and plots only render them.

mod bands;
mod camera;
mod distances;
mod identify;
pub mod range;
mod reliability;
mod resolve;
mod rule;
mod sight;
mod simulate;
mod size;
mod warn;

pub use identify::{
    Answers, Apart, Asked, BandNumber, BandsThatMatter, Check, Choice, Exact, ExactLibrary, ExactPair,
    Identifiability, Identification, Law, LibrarySize, Matrix, NearestState, PairResult, Passband,
    Prediction, PriorAverage, Reached, Rows, SampleSpectra, Scaling, TargetVerdict, Trial,
};
pub use reliability::{probability, reliability};
pub use resolve::{Study, Surface};
pub use rule::{
    CameraVerdict, Certified, EnvelopeResult, FileHash, Fixes, LimitingScene, Neighbourhood, NotIdentifiable,
    RuleAnswer, RuleAsked, RuleRequirement, RuleStudy,
};
pub use sight::Sight;
pub use simulate::{
    FIXED_EMISSIVITY, ImagerErrors, NoiseCurve, NoiseCurves, PhotonLaw, Reader, SimulatedClass,
    SimulatedPerformance, SimulatedPoint, Simulation, SimulationPlan, Standing, Thermometry, ThermometryRow,
};
pub use size::{
    CameraResult, Elasticities, EmissivityErrors, InformationCurves, PhotonMap, RequirementResult,
    Sensitivity, Sizing, Solutions, Spectra, Verdict, VerdictAlone,
};

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
