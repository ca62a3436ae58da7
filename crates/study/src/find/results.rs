//! What was found: choices that meet, those that do not and why.

use crate::size::{Sizing, Solutions, Verdict};
use crate::{CameraAnswer, Condition, Warning, YesNo};
use hadar::demand::Work;
use hadar::instrument::Price;
use hadar_scenario::{Rule, Scenario};

/// Which cameras meet.
#[derive(Debug, Clone, serde::Serialize)]
#[non_exhaustive]
pub struct FindAnswer {
    /// The question with its defaults filled in; of a rule the scene of its first clause.
    pub scenario: Scenario,
    /// The rule that is to be met, if it is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rule: Option<Rule>,
    /// Scenes in which choices were judged before the whole rule was asked; 1 of a scenario.
    pub scenes: usize,
    /// Statistical distance d that is required of the camera.
    pub required_distance: f64,
    /// Whether any camera meets it.
    pub met: bool,
    /// The first of those that meet, by what is to be small.
    pub best: Option<Choice>,
    /// Pareto-optimal choices in all that is to be small, in the order of the question.
    pub listed: Vec<Choice>,
    /// The best of every other camera that meets.
    pub also: Vec<Choice>,
    /// Choices of which it is not shown whether they meet.
    pub undecided: Vec<Choice>,
    /// Filters of the list that the spectra of the scene do not cover: not looked at.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub filters_left_out: Vec<String>,
    /// Whether a well would overflow, so that exposures were tried a factor 2 apart.
    pub exposures_tried: bool,
    /// Cameras that do not, and why.
    pub failed: Vec<Failed>,
    /// Where none meets, what comes nearest.
    pub near: Option<NearMiss>,
    /// What the reader must know of the best.
    pub warnings: Vec<Warning>,
    /// What was computed and what was skipped, with the time.
    pub stats: Work,
}

/// A camera with a lens, filters and a number of frames.
#[derive(Debug, Clone, serde::Serialize)]
#[non_exhaustive]
pub struct Choice {
    /// Name of the camera in the catalogue.
    pub camera: String,
    /// The lens in front of the camera.
    pub lens: LensUsed,
    /// Its filters by their wavelengths; empty for the camera alone.
    pub filters: Vec<FilterUsed>,
    /// Bands that it reads: those of its filters, its own, or one.
    pub bands: usize,
    /// Frames that are added up.
    pub frames: u32,
    /// Exposure where it was shortened to the full well, s.
    pub exposure_s: Option<f64>,
    /// Time until all is read, s.
    pub time_s: f64,
    /// Diameter of the lens's opening, m.
    pub aperture_m: f64,
    /// What is known to be paid for it.
    pub price: Option<Price>,
    /// Parts of which no price is known.
    pub price_without: Vec<&'static str>,
    /// Statistical distance demanded of it.
    pub required_distance: f64,
    /// Statistical distance that is proved; of a rule the least of all its scenes.
    pub lower: f64,
    /// That of a state that was found.
    pub upper: f64,
    /// The alternative that is hardest to distinguish from the target.
    pub limiting: String,
    /// What the main job says of it, with its conditions.
    pub verdict: Option<Verdict>,
    /// What the reader must know about this choice.
    pub warnings: Vec<Warning>,
    /// The scenario of this choice, as the main job takes it; of a rule that of its first clause.
    pub scenario: Scenario,
    /// The rule with this choice as its camera.
    #[serde(skip)]
    pub rule: Option<Rule>,
    /// What the rule says of it, with its conditions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub of_rule: Option<CameraAnswer>,
}

impl Choice {
    /// Whether another is the same camera, lens, filters, frames and exposure.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        (&self.camera, &self.lens, &self.filters, self.frames, self.exposure_s)
            == (&other.camera, &other.lens, &other.filters, other.frames, other.exposure_s)
    }

    /// Whether it was put to the main job, or to the rule.
    pub(super) fn is_judged(&self) -> bool {
        self.verdict.is_some() || self.of_rule.is_some()
    }

    /// Whether the main job, or the rule, leaves it open.
    pub(super) fn is_undecided(&self) -> bool {
        match (&self.of_rule, &self.verdict) {
            (Some(found), _) => found.verdict == hadar_scenario::rule::Verdict::Undecided,
            (None, Some(verdict)) => verdict.answer == Some(YesNo::Undecided),
            (None, None) => true,
        }
    }

    /// What it rests on that it meets, hardest first.
    #[must_use]
    pub fn conditions(&self) -> &[Condition] {
        match (&self.of_rule, &self.verdict) {
            (Some(found), _) => &found.conditions,
            (None, Some(verdict)) => &verdict.conditions,
            (None, None) => &[],
        }
    }
}

/// A lens before a camera.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct LensUsed {
    /// Its name; none of one that the camera has.
    pub name: Option<String>,
    /// f-number: focal length over the diameter of the aperture.
    pub f_number: f64,
    /// Focal length of the lens, m.
    pub focal_length_m: f64,
    /// The document that names it for the camera; none of one that the question gives.
    pub document: Option<String>,
}

/// A filter before a camera.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct FilterUsed {
    /// Its name; none of an ideal one.
    pub name: Option<String>,
    /// From wavelength to wavelength, µm: edges of an ideal one, else where it begins and ends to pass.
    pub range_um: [f64; 2],
}

/// A camera that does not meet.
#[derive(Debug, Clone, serde::Serialize)]
#[non_exhaustive]
pub struct Failed {
    /// Name of the camera in the catalogue.
    pub camera: String,
    /// Its lens, if it comes to that.
    pub lens: Option<LensUsed>,
    /// The reason why the camera does not meet the requirement.
    pub why: Why,
    /// What is proved of the best that it reaches; none where it does not come to that.
    pub lower: Option<f64>,
    /// What it reaches at most.
    pub upper: Option<f64>,
}

/// Why a camera does not meet.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[serde(tag = "code", rename_all = "kebab-case")]
pub enum Why {
    /// No document states these figures.
    Figures {
        /// Keys of the figures that are not known of the camera.
        missing: Vec<&'static str>,
    },
    /// No document names a lens for it, and the question gives none.
    NoLens,
    /// No filter lies within its range.
    NoFilter {
        /// Range of its detector, µm.
        range_um: [f64; 2],
    },
    /// It cannot be asked, with the message of why.
    Refused {
        /// The error message of the camera's computation.
        because: String,
    },
    /// Nobody can order it.
    NotSold,
    /// Even with all filters at once and the most frames it does not reach the distance.
    AllFilters {
        /// Whether any number of frames would do with all filters.
        frames_would_do: bool,
    },
    /// No choice of so many filters and frames reaches the distance.
    Distance {
        /// The most filters that were tried.
        filters: usize,
        /// The most frames that were tried within the time.
        frames: u32,
        /// Whether all choices were excluded or judged.
        all_judged: bool,
        /// Whether more filters take too long: for the decision, or for something that moves.
        is_cut: bool,
    },
    /// Not even one frame of the fewest bands is read in time.
    Time {
        /// The time it takes, s.
        takes_s: f64,
    },
    /// The target moves by a pixel or more while the bands are exposed.
    Motion,
    /// A reading overflows the full well, and the exposure is fixed.
    FullWell,
    /// What is proved does not reach the distance, and what was found does.
    Undecided,
    /// Its best choice meets pair by pair, and the main job, or the rule, does not call it met.
    NotAsAWhole,
}

/// The choice that comes nearest where none meets, and what it would have to be.
#[derive(Debug, Clone, serde::Serialize)]
#[non_exhaustive]
pub struct NearMiss {
    /// The choice of lens, filters and frames that comes nearest.
    pub choice: Choice,
    /// Every quantity of its camera with the others held.
    pub solve_for: Option<Solutions>,
    /// The whole of what the main job says of it.
    #[serde(skip)]
    pub sizing: Sizing,
}

/// That a camera fails, with the choice of it that comes nearest.
#[derive(Debug, Clone)]
pub struct Misses {
    /// Why it fails.
    pub failed: Failed,
    /// Its best choice.
    pub near: Option<Choice>,
}
