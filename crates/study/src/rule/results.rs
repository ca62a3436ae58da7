//! What comes of a rule, as data.

use super::not_in_force::NotInForce;
use super::uncertainty::MarginUncertainty;
use crate::condition::Condition;
use crate::grade::Grade;
use crate::size::Solutions;
use crate::{ClassSide, NearestState, Shortfall, Warning};
use hadar::instrument::Readout;
use hadar::policy::envelope::Certificate;
use hadar::policy::stop::Decision;
use hadar::policy::{Quantity, Solution};
use hadar_scenario::Units;
use hadar_scenario::rule::Verdict;
use std::collections::BTreeMap;

/// Names of the cameras that meet a rule, and of the others; in JSON a sentence.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct WhoMeets {
    /// Those that do, each with what it hangs on.
    pub meet: Vec<(String, Vec<Condition>)>,
    /// Those of them of which it is not proved.
    pub unproved: Vec<String>,
    /// Those of which it cannot be said, their figures being uncertain, with the interval of their least margin.
    pub undecided: Vec<(String, Option<[f64; 2]>)>,
    /// Those that do not.
    pub fail: Vec<String>,
    /// Whether it is one clause of several that they meet.
    pub clause: bool,
    /// That the rule does not hold on the day that is asked about.
    pub idle: Option<NotInForce>,
    /// Pairs that limit a camera though each of the two is entered as one number, with the numbers.
    pub placeholders: Vec<(String, String, [f64; 2])>,
}

/// A camera over the pairs of which more than one number is known of one of the two.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct WithoutPlaceholders {
    /// Statistical distance over that demanded, least over the operating envelope.
    pub margin: f64,
    /// Statistical distance, least over the operating envelope.
    pub statistical_distance: f64,
    /// The numbers of which more than one is known of the target.
    pub target: String,
    /// What it is the least against.
    pub alternative: String,
}

/// What a rule demands of any camera.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct RuleRequirement {
    /// Statistical distance d that is required of any camera.
    pub distance: f64,
    /// Probability of a correct decision demanded, Φ of it.
    pub detection_probability: f64,
    /// Speed at which an image must not be blurred, m s⁻¹.
    pub speed_m_s: Option<f64>,
    /// H_req of t A_p/((1+γ)F²) ≥ H_req, m² s, lossless optics: the largest of all cameras' limiting scenes; `None` where
    /// no hardware suffices or only the verdict was asked for.
    pub hardware_m2_s: Option<f64>,
    /// The rule in a sentence that can be quoted.
    pub quotable: Quotable,
}

/// What can be quoted of a rule; in JSON a sentence or two.
#[derive(Debug, Clone, PartialEq)]
pub struct Quotable {
    /// Where it is demanded.
    pub envelope: EnvelopeResult,
    /// Temperatures that the alternatives may have, K; any where `None`.
    pub alternatives_k: Option<[f64; 2]>,
    /// Statistical distance demanded.
    pub required: f64,
    /// Speed of a vehicle that drives forward, m s⁻¹.
    pub speed_m_s: Option<f64>,
    /// How it comes to a stop, if that is said.
    pub stop: Option<StopResult>,
    /// H_req, m² s; `None` where that figure of the hardware does not tell all.
    pub hardware_m2_s: Option<f64>,
    /// Whether all pixels of the object tell together, not one.
    pub of_object: bool,
    /// Units of the sentence.
    pub units: Units,
}

/// The operating envelope as it was searched.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct EnvelopeResult {
    /// Temperature of the target, K.
    pub temperature_k: [f64; 2],
    /// Lighting factor of every object of the surroundings.
    pub lighting: Vec<[f64; 2]>,
    /// Temperature of every object of the surroundings, K.
    pub surroundings_k: Vec<[f64; 2]>,
    /// Distance of the target, m; infinitely far where `None`.
    pub distance_m: Option<[f64; 2]>,
    /// Materials of the target, and classes whose members all are.
    pub materials: Vec<String>,
    /// What they must be distinguished from.
    pub alternatives: Vec<String>,
    /// The classes among them; empty without.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub classes: Vec<ClassSide>,
}

/// One camera against the rule.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct CameraVerdict {
    /// Name of the camera, as the rule names it.
    pub name: String,
    /// Whether the camera meets the rule: yes, no or undecided.
    pub verdict: Verdict,
    /// How that is known: the weakest of what it rests on.
    pub grade: Grade,
    /// How it is known where all conditions hold.
    pub evidence: Grade,
    /// Whether it meets the rule.
    pub passes: bool,
    /// What it does not meet.
    pub fails_by: Vec<Shortfall>,
    /// What it may or may not meet, its figures being uncertain.
    pub undecided_by: Vec<Shortfall>,
    /// How well its margin is known; `None` where no uncertainty is stated.
    pub uncertainty: Option<MarginUncertainty>,
    /// What meeting it rests on, hardest first; of a 'no' what was taken on the unfavourable side.
    pub conditions: Vec<Condition>,
    /// Number of spectral bands that the camera measures.
    pub bands: usize,
    /// Whether its bands are measured at once or one after the other.
    pub readout: Readout,
    /// Time until all of them are exposed once, s.
    pub sweep_s: f64,
    /// Statistical distance over that demanded, in the limiting scene.
    pub margin: f64,
    /// Statistical distance in the limiting scene.
    pub statistical_distance: f64,
    /// Φ of it: no test is right more often there.
    pub detection_probability: f64,
    /// Proved: no scene of the operating envelope is below, by the lower end of uncertain figures. `None` if nothing is proved.
    pub lower_bound: Option<f64>,
    /// How sure the limiting scene is.
    pub certificate: Certified,
    /// The scene of the operating envelope in which the margin is least.
    pub limiting: LimitingScene,
    /// Where that is of a pair entered as one number each: what the camera does without such pairs, if there are others.
    pub without_placeholders: Option<WithoutPlaceholders>,
    /// What would fix it, in the limiting scene; `None` where nothing needs to be fixed or that was not asked for.
    pub fixes: Option<Fixes>,
    /// Apparent motion during an exposure at the rule's speed and the least distance, pixels; `None` where it cannot be known.
    pub motion_blur_pixels: Option<f64>,
    /// Photons of the fullest reading in the brightest scene, at most.
    pub brightest_reading: f64,
    /// The longest exposure without a pixel of blur and without a full well, s; 0 where the frames alone take too long, `None`
    /// where neither can be known.
    pub longest_exposure_s: Option<f64>,
    /// How the vehicle comes nearer, if that is said.
    pub approach: Option<ApproachResult>,
    /// What the reader must know.
    pub warnings: Vec<Warning>,
}

/// How sure a worst case is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Certified {
    /// How it is known.
    pub kind: Proof,
    /// By how much the lower bound is below the distance attained, as a share of it.
    pub gap: Option<f64>,
}

hadar::named! {
    /// How a worst case is known.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Proof {
        /// Proved within the gap by branch and bound.
        BranchAndBound = "branch-and-bound",
        /// Searched, with a proved lower bound.
        Bounded = "bounded",
        /// Proved: a scene in which nothing differs.
        Equilibrium = "equilibrium",
        /// Searched, with no bound.
        DenseSearch = "dense-search",
        /// A scene that fails; no worse one was looked for.
        Counterexample = "counterexample",
    }
    /// Stable code, e.g. `branch-and-bound`.
    code
}

impl Certified {
    /// Of a worst case, `gap` being that of its lower bound if there is one.
    pub(super) fn of(certificate: Certificate, gap: Option<f64>) -> Self {
        let kind = match (certificate, gap) {
            (Certificate::Equilibrium, _) => Proof::Equilibrium,
            (Certificate::DenseSearch { .. }, _) | (_, None) => Proof::DenseSearch,
            (Certificate::BranchAndBound, Some(_)) => Proof::BranchAndBound,
            (Certificate::Bounded { .. }, Some(_)) => Proof::Bounded,
        };
        Self { kind, gap }
    }

    /// Of a scene that fails, with none looked for that is worse.
    pub(super) const fn counterexample() -> Self {
        Self { kind: Proof::Counterexample, gap: None }
    }
}

/// The scene in which a camera is nearest to failing.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct LimitingScene {
    /// Name of the material of the target.
    pub target: String,
    /// Name of the alternative that is most similar there.
    pub alternative: String,
    /// Temperature of the target, K.
    pub temperature_k: f64,
    /// Lighting factor of every object.
    pub lighting: Vec<f64>,
    /// Temperature of every object, K.
    pub surroundings_k: Vec<f64>,
    /// Distance, m; infinitely far where `None`.
    pub distance_m: Option<f64>,
    /// Whether the counts at the least and the greatest distance of the operating envelope differ by more than a thousandth.
    pub distance_matters: bool,
    /// Emissivities of the two where each is entered as one number.
    pub placeholders: Option<[f64; 2]>,
    /// The state of the alternative that is nearest to it.
    pub nearest_state: NearestState,
    /// H_req of the paper's inequality in this scene, m² s; `None` where no hardware suffices.
    pub hardware_m2_s: Option<f64>,
}

/// What would let a camera reach the distance in its limiting scene, each with the rest of it as it is.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Fixes {
    /// Whether any single quantity does, and spoils nothing else.
    pub any: bool,
    /// By quantity, what its value would spoil.
    pub spoils: BTreeMap<&'static str, Vec<Shortfall>>,
    /// Solutions by quantity.
    #[serde(flatten)]
    pub quantities: Solutions,
}

impl Fixes {
    /// Quantities with the value that would do, and what it would spoil.
    pub fn that_do(&self) -> impl Iterator<Item = (Quantity, &Solution, &[Shortfall])> {
        let solved = self.quantities.0.iter().filter(|(_, solution)| solution.value.is_some());
        solved.map(|(quantity, solution)| {
            let spoiled = self.spoils.get(quantity.key()).map_or(&[][..], Vec::as_slice);
            (*quantity, solution, spoiled)
        })
    }
}

/// The part of an operating envelope in which no camera could meet the rule.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct NotIdentifiable {
    /// Share of all scenes and pairs, each range uniform, each pair alike.
    pub fraction: f64,
    /// Its statistical error, one standard deviation.
    pub standard_error: f64,
    /// What is taken for 'no camera' here, in words.
    pub definition: IdealCamera,
    /// Share in which errors of the emissivities make up more than the distance, whatever the camera.
    pub fraction_within_emissivity_error: f64,
    /// Its statistical error, one standard deviation.
    pub standard_error_within_emissivity_error: f64,
    /// What the stated error of the emissivities means here, in words.
    pub emissivity_error: EmissivityError,
    /// Number of scenes that were drawn from the operating envelope.
    pub scenes: usize,
    /// Where those scenes are in which no camera could do it; `None` where there are none.
    pub neighbourhood: Option<Neighbourhood>,
}

/// The camera that no other surpasses; in JSON that it does not tell the pair.
#[derive(Debug, Clone, PartialEq)]
pub struct IdealCamera {
    /// f-number.
    pub f_number: f64,
    /// Pixel, the largest of the cameras, m.
    pub pixel_m: f64,
    /// Time in which it collects light, s.
    pub time_s: f64,
    /// Why so long.
    pub why: LightTime,
    /// Distance at which the target fills the pixel, m.
    pub distance_m: Option<f64>,
    /// Statistical distance demanded.
    pub required: f64,
    /// Pixels of the object that count together, the most of the cameras; 1 of a pixel.
    pub pixels: f64,
    /// Units of the sentence.
    pub units: Units,
}

/// Why light is collected for so long.
#[derive(Debug, Clone, PartialEq)]
pub enum LightTime {
    /// Motion blurs longer exposures.
    Sharp {
        /// Frames.
        frames: u32,
        /// Speed, m s⁻¹.
        speed_m_s: f64,
        /// Least distance, m.
        distance_m: f64,
        /// Units of the sentence.
        units: Units,
    },
    /// No camera collects it longer.
    LongestIntegration,
}

/// Standard deviation of an emissivity in a band; in JSON that it makes up more than the distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EmissivityError(pub f64);

/// How near to equilibrium scenes are, nine tenths of them.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Neighbourhood {
    /// |T − T₀| at most, T₀ the mean temperature of the surroundings weighed by their lighting, K.
    pub temperature_difference_k: f64,
    /// 1 − ΣV at most.
    pub unlit: f64,
}

/// How a vehicle comes to a stop before the target.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct StopResult {
    /// At the lowest speed: the least distance of a decision.
    pub slowest: Decision,
    /// At the highest speed: the greatest distance.
    pub fastest: Decision,
    /// At the speed that leaves the least time; `None` where nothing is said of the start.
    pub hastiest: Option<Decision>,
    /// At the speed at which the picture moves fastest.
    pub swiftest: Decision,
    /// How the target crosses, where that is said.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crossing: Option<CrossingResult>,
}

/// A camera while its vehicle comes nearer.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct ApproachResult {
    /// Distance at the highest speed when the first of its frames begins, m.
    pub seen_from_m: f64,
    /// Time until all bands of all its frames are read, s.
    pub needed_s: f64,
    /// Frames that it lays over each other.
    pub frames_needed: u32,
    /// Least time until the decision is due, s; none where nothing is said of the start.
    pub time_s: Option<f64>,
    /// Frames of all bands that fit into it.
    pub frames_within: Option<u32>,
    /// Side of what a pixel sees at the greatest distance of a decision, m.
    pub footprint_m: f64,
    /// Of a target on its way across that is not in the view in time at every speed: the speed from which on it is, m s⁻¹; an inner `None` where
    /// there is none. `None` where it is, or nobody says how it crosses.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub in_view_from_m_s: Option<Option<f64>>,
}

/// A target that crosses.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct CrossingResult {
    /// Speed of the target across the line of sight, m s⁻¹.
    pub speed_m_s: f64,
    /// Largest distance from the camera's axis at which it would be met, m.
    pub offset_m: f64,
    /// How far compared with that axis it is until the decision, at most, rad.
    pub bearing_rad: f64,
}

impl Grade {
    /// That of a line with such a verdict, if its margin is guarded: what is promised then rests on draws.
    pub(super) fn guarded(self, verdict: Verdict, uncertainty: Option<&MarginUncertainty>) -> Self {
        let drawn = uncertainty.is_some_and(|found| found.low < found.high);
        if verdict == Verdict::Meets && drawn { self.max(Self::Simulated) } else { self }
    }
}
