//! What comes of a rule, as data.

use crate::scenario::Rule;
use crate::study::size::Solutions;
use crate::study::{NearestState, Warning};
use hadar::demand::Work;
use hadar::policy::envelope::Certificate;
use hadar::policy::{Quantity, Solution};
use std::collections::BTreeMap;

/// Which cameras meet a rule.
#[derive(Debug, Clone, serde::Serialize)]
pub struct RuleAnswer {
    /// The rule with its defaults filled in.
    pub rule: Rule,
    /// The answer in a sentence.
    pub sentence: String,
    /// What is demanded.
    pub requirement: RuleRequirement,
    /// Where it is demanded.
    pub envelope: EnvelopeResult,
    /// Every camera, in the order of the rule.
    pub cameras: Vec<CameraVerdict>,
    /// The part of the envelope in which no camera could do it; `None` where only the verdict was asked for.
    pub not_identifiable: Option<NotIdentifiable>,
    /// Files and embedded entries that the answer rests on.
    pub inputs: Vec<FileHash>,
    /// What the reader must know; what concerns one camera is with that camera.
    pub warnings: Vec<Warning>,
    /// What it took.
    pub stats: Work,
}

/// What a rule demands of any camera.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct RuleRequirement {
    /// Statistical distance demanded.
    pub distance: f64,
    /// Detection probability demanded, Φ of it.
    pub detection_probability: f64,
    /// Speed at which an image must not be blurred, m s⁻¹.
    pub speed_m_s: Option<f64>,
    /// H_req of t A_p/((1+γ)F²) ≥ H_req, m² s, lossless optics: the largest of all cameras' limiting scenes; `None` where
    /// no hardware suffices or only the verdict was asked for.
    pub hardware_m2_s: Option<f64>,
    /// The rule in a sentence that can be quoted.
    pub quotable: String,
}

/// The envelope as it was searched.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct EnvelopeResult {
    /// Temperature of the target, K.
    pub temperature_k: [f64; 2],
    /// Lighting factor of every object of the surroundings.
    pub lighting: Vec<[f64; 2]>,
    /// Temperature of every object of the surroundings, K.
    pub surroundings_k: Vec<[f64; 2]>,
    /// Distance of the target, m; infinitely far where `None`.
    pub distance_m: Option<[f64; 2]>,
    /// Materials of the target.
    pub materials: Vec<String>,
    /// What they must be told apart from.
    pub alternatives: Vec<String>,
}

/// One camera against the rule.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct CameraVerdict {
    /// Its name.
    pub name: String,
    /// Whether it meets the rule.
    pub passes: bool,
    /// What it does not meet: `distance`, `motion-blur`, `full-well`.
    pub fails_by: Vec<&'static str>,
    /// Statistical distance over that demanded, in the limiting scene.
    pub margin: f64,
    /// Statistical distance in the limiting scene.
    pub statistical_distance: f64,
    /// Φ of it: no test is right more often there.
    pub detection_probability: f64,
    /// Proved: no scene of the envelope is below. `None` if nothing is proved.
    pub lower_bound: Option<f64>,
    /// How sure the limiting scene is.
    pub certificate: Certified,
    /// The scene that limits.
    pub limiting: LimitingScene,
    /// What would fix it, in the limiting scene; `None` where nothing needs to be fixed or that was not asked for.
    pub fixes: Option<Fixes>,
    /// Apparent motion during an exposure at the rule's speed and the least distance, pixels; `None` where it cannot be known.
    pub motion_blur_pixels: Option<f64>,
    /// Photons of the fullest reading in the brightest scene, at most.
    pub brightest_reading: f64,
    /// The longest exposure without a pixel of blur and without a full well, s; `None` where neither can be known.
    pub longest_exposure_s: Option<f64>,
    /// What the reader must know.
    pub warnings: Vec<Warning>,
}

/// How sure a worst case is.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Certified {
    /// `branch-and-bound`, `bounded`, `equilibrium`, `dense-search` or `counterexample`.
    pub kind: &'static str,
    /// The same in words.
    pub statement: String,
    /// By how much the lower bound is below the distance attained, as a share of it.
    pub gap: Option<f64>,
}

impl Certified {
    /// Of a worst case, `gap` being that of its lower bound if there is one.
    pub(super) fn of(certificate: Certificate, gap: Option<f64>) -> Self {
        let percent = |gap: f64| format!("{:.2} %", 100.0 * gap.max(0.0));
        let (kind, statement) = match (certificate, gap) {
            (Certificate::Equilibrium, _) => {
                ("equilibrium", "proved: the envelope holds a scene in which nothing differs".into())
            }
            (Certificate::DenseSearch { .. }, _) | (_, None) => (
                "dense-search",
                "searched, not proved: the best of a dense search and its refinements".into(),
            ),
            (Certificate::BranchAndBound, Some(gap)) => {
                ("branch-and-bound", format!("proved by branch and bound to {}", percent(gap)))
            }
            (Certificate::Bounded { .. }, Some(gap)) => {
                ("bounded", format!("searched; proved that no scene is more than {} below", percent(gap)))
            }
        };
        Self { kind, statement, gap }
    }

    /// Of a scene that fails, with none looked for that is worse.
    pub(super) fn counterexample() -> Self {
        let statement = "proved by this scene; a worse one was not looked for".into();
        Self { kind: "counterexample", statement, gap: None }
    }
}

/// The scene in which a camera is nearest to failing.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct LimitingScene {
    /// Material of the target.
    pub target: String,
    /// The alternative.
    pub alternative: String,
    /// Temperature of the target, K.
    pub temperature_k: f64,
    /// Lighting factor of every object.
    pub lighting: Vec<f64>,
    /// Temperature of every object, K.
    pub surroundings_k: Vec<f64>,
    /// Distance, m; infinitely far where `None`.
    pub distance_m: Option<f64>,
    /// Whether the counts at the least and the greatest distance of the envelope differ by more than a thousandth.
    pub distance_matters: bool,
    /// The state of the alternative that is nearest to it.
    pub nearest_state: NearestState,
    /// H_req of the paper's inequality in this scene, m² s; `None` where no hardware suffices.
    pub hardware_m2_s: Option<f64>,
}

/// What would let a camera reach the distance in its limiting scene, each with the rest of it as it is.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Fixes {
    /// Whether any single quantity does, and spoils nothing else.
    pub any: bool,
    /// By quantity, what its value would spoil: `motion-blur`, `full-well`, `frame-rate`, `diffraction`, `lowest-noise`.
    pub spoils: BTreeMap<&'static str, Vec<&'static str>>,
    /// Solutions by quantity.
    #[serde(flatten)]
    pub quantities: Solutions,
}

impl Fixes {
    /// Quantities with the value that would do, and what it would spoil.
    pub fn that_do(&self) -> impl Iterator<Item = (Quantity, &Solution, &[&'static str])> {
        let solved = self.quantities.0.iter().filter(|(_, solution)| solution.value.is_some());
        solved.map(|(quantity, solution)| {
            let spoiled = self.spoils.get(quantity.key()).map_or(&[][..], Vec::as_slice);
            (*quantity, solution, spoiled)
        })
    }
}

/// The part of an envelope in which no camera could do what the rule demands.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct NotIdentifiable {
    /// Share of all scenes and pairs, each range uniform, each pair alike.
    pub fraction: f64,
    /// Its statistical error, one standard deviation.
    pub standard_error: f64,
    /// What 'no camera' means.
    pub definition: String,
    /// Share in which errors of the emissivities make up more than the distance, whatever the camera.
    pub fraction_within_emissivity_error: f64,
    /// Its statistical error, one standard deviation.
    pub standard_error_within_emissivity_error: f64,
    /// What that means.
    pub emissivity_error: String,
    /// Scenes that were drawn.
    pub scenes: usize,
    /// Where those scenes are in which no camera could do it; `None` where there are none.
    pub neighbourhood: Option<Neighbourhood>,
}

/// How near to equilibrium scenes are, nine tenths of them.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Neighbourhood {
    /// |T − T₀| at most, T₀ the mean temperature of the surroundings weighed by their lighting, K.
    pub temperature_difference_k: f64,
    /// 1 − ΣV at most.
    pub unlit: f64,
}

/// A file or embedded entry, by its content.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct FileHash {
    /// Where it is.
    pub path: String,
    /// SHA-256 of it.
    pub sha256: String,
}
