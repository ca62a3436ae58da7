//! Questions about thermal cameras answered: from names and files to physics, and from physics to results as data.
//!
//! [`Study`] is a scenario with its materials, bands, surroundings and camera looked up. [`Study::identify`] gives the distances to every
//! alternative, [`Study::size`] the verdict on the camera and what each hardware quantity would have to be; a folder a command. [`sweep`] asks one question
//! about many scenes or cameras. Results are plain data that serialise to the JSON of the command line, whose sentences are those of the one
//! who writes it ([`spoken`]); text, tables and plots only render them.
//!
//! ```
//! use hadar::material::Library;
//! use hadar_scenario::Scenario;
//! use hadar_study::Study;
//!
//! let text = "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\n[alternatives]\nmaterials = [\"aluminium\"]";
//! let study = Study::new(&Scenario::from_toml(text, None)?, &Library::embedded()?)?;
//! assert_eq!(study.identify()?.pairs[0].alternative, "aluminium");
//! # Ok::<(), hadar::Error>(())
//! ```

mod air;
pub mod air_ranging;
mod bands;
pub mod budget;
pub mod calibrate;
mod camera;
mod camera_bands;
mod classes;
pub mod companion;
mod condition;
pub mod cube_bad;
mod cube_bands;
mod cube_noise;
mod cube_outliers;
mod cube_rows;
mod cube_sample;
mod cube_unit;
mod cube_without;
mod decision;
pub mod decompose;
mod distances;
pub mod find;
mod grade;
mod heat_cube;
mod identify;
mod integration;
pub mod library;
mod light_found;
mod looked_up;
mod memory;
mod model_judged;
mod own_cameras;
mod per_photon;
mod pixel_map;
mod proviso;
pub mod range;
mod remembered;
pub mod render;
mod resolve;
mod rests_on;
mod rule;
mod shared_errors;
mod shared_unknown;
mod shortfall;
mod sight;
mod simulate;
mod size;
pub mod spoken;
mod stage;
mod surface;
pub mod sweep;
mod warn;
pub mod warning;

pub use crate::condition::{Condition, ConditionKind, RangeDecides};
pub use crate::grade::Grade;
pub use crate::proviso::Proviso;
pub use crate::warning::{Warning, WorstBlackbody};
pub use camera::with_noise_kept;
pub use classes::{ClassAnswer, ClassSide, LeftOut, MixtureAnswer};
pub use companion::Companion;
pub use decision::YesNo;
pub use identify::{
    Answers, Apart, Asked, BandNumber, BandsThatMatter, Check, Choice, Exact, ExactLibrary, ExactPair,
    Identifiability, Identification, Law, LibrarySize, Matrix, NearestProof, NearestState, PairResult,
    Passband, Prediction, PriorAverage, Reached, Rows, SafetyMaterial, SafetyOfTarget, SampleSpectra,
    Scaling, TargetVerdict, Trial, Watch,
};
pub use looked_up::Study;
pub use own_cameras::OwnCameras;
pub use remembered::Remembered;
pub use rule::{
    ApartAnswer, ApproachResult, BeforeLaw, BudgetLine, CameraAnswer, CameraBeforeClause, CameraInCell,
    CameraVerdict, Certified, ClauseAnswer, Course, CourseOfCamera, CrossingResult, Definition, Drawn,
    EmissivityError, EnvelopeResult, Extent, FiguresMoved, Fixes, Found, Grid, GridCell, IdealCamera,
    LightTime, LimitingScene, Line, MarginUncertainty, Market, Measure, MeasuredAnswer, MeasuredScene,
    MeasuredVerdict, Moment, Moved, Neighbourhood, NotIdentifiable, NotInForce, NotPassed, Outcome, Proof,
    Quotable, Reformed, Reforms, RuleAnswer, RuleAsked, RuleRequirement, RuleStudy, SafetyOfRule,
    ShapesDrawn, StandIn, StandInAnswer, StandInScene, StopResult, TestCheck, TestResult, Told, WhoMeets,
    WithoutPlaceholders,
};
pub use shortfall::Shortfall;
pub use sight::Sight;
pub use simulate::{
    AveragePoint, AverageSimulation, FIXED_EMISSIVITY, ImagerErrors, NoiseCurve, NoiseCurves, PhotonLaw,
    Reader, SimulatedClass, SimulatedPerformance, SimulatedPoint, Simulation, SimulationAsked,
    SimulationPlan, Standing, TestSpectra, Thermometry, ThermometryRow, true_temperatures,
};
pub use size::{
    Answer, CameraResult, CeilingShare, Elasticities, EmissivityErrors, Finding, InformationCurves,
    ObjectAnswer, ObjectCurve, PhotonMap, RequirementResult, ScatterOf, Sensitivity, SizeAsked, Sizing,
    Solutions, Spectra, Verdict, VerdictAlone,
};
pub use surface::Surface;

#[cfg(doctest)]
#[doc = include_str!("../../../docs/src/reference/programs.md")]
struct Guide;
