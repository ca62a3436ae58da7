//! The thermal stand-in: within which tolerances of temperature and emissivity a camera cannot tell it from a person.
//!
//! The rule's limit turned round ([`hadar::policy::stand_in`]). A stand-in of a material, at a temperature ± ΔT and an emissivity ± Δe (the
//! same at all wavenumbers), in all scenes of the rule's envelope: the edge is the ΔT at which the farthest of them is just as
//! far from the nearest person as the rule demands of cameras. Below it none is told from a person as reliably as the rule demands. The
//! person may have any temperature of the envelope, and what else the scenario leaves unknown.
//!
//! As all verdicts of a rule it is about what one pixel counts, in all bands and frames: shape, motion and many pixels tell more.
//!
//! The person's lighting is within the envelope as the stand-in's is (of objects with ranges of their own: within what these have in common, or as the
//! stand-in is lit), and its temperature where that is known: a stand-in outside is told.
//!
//! The shape of its spectrum is that of its material, or is off by errors of a deviation s and a correlation exp(−|Δν|/ℓ) (`emissivity_error`,
//! `correlation`). Then so many shapes are drawn that the least tolerance of all is, with 95 % confidence, one that 95 % of all shapes
//! have: 0.95^59 < 0.05 (Wilks, Ann. Math. Stat. 12, 91 (1941)). Nothing is proved of those.
//!
//! Proved is a ΔT a little smaller, at which the bound from above is no more than the demand. Cameras are taken from both ends of the
//! distance, at one of which they count most, with the least noise of the envelope and with uncertain figures on all sides, as far as the
//! rule guards them: what helps them to tell. Errors of emissivities (`[sensitivity]`) are not in it, and a warning says so. With air on the path, or
//! a target smaller than a pixel, distances between are searched, and nothing is proved.

use super::apart::{TellApart, steps};
use super::uncertainty::Uncertain;
use super::{Kind, NotInForce, RuleStudy};
use crate::size::sensitivity::ripple::Ripple;
use crate::{Study, Surface, Warning};
use hadar::error::{Error, Result};
use hadar::fisher::{Nuisance, Unknowns};
use hadar::identifiability::detection;
use hadar::identifiability::nearest::StateRange;
use hadar::material::Library;
use hadar::parallel;
use hadar::policy::envelope::{EnvelopeScene, Ranges};
use hadar::policy::stand_in::{Effort, Farthest, farthest};
use hadar::root;
use hadar::scene::State;
use hadar_scenario::rule::{Demand, StandInSpec};
use hadar_scenario::{Date, Envelope, MaterialRef, Scenario, SensitivitySpec, Units};
use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;

/// Tolerances of the temperature are looked for up to here, K.
const WIDEST_K: f64 = 40.0;
/// Boxes whose corners a tolerance is solved with, and of a proof.
const BOXES: usize = 17;
const PROOF_BOXES: usize = 20_000;
/// Shapes that are drawn, and the share of all shapes for which the least of them stands, with that confidence.
const SHAPES: usize = 59;
const SHARE: f64 = 0.95;
const SEED: u64 = 1;
/// Share of the demand up to which a tolerance is proved.
const PROVED: f64 = 0.99;

/// Tolerances within which surrogate targets pass for people.
#[derive(Debug, Clone, serde::Serialize)]
#[non_exhaustive]
pub struct StandInAnswer {
    /// The clause whose limit is turned round; none of a rule without clauses.
    pub clause: Option<String>,
    /// Statistical distance that the rule demands of cameras.
    pub distance: f64,
    /// Largest probability of a correct decision, Φ of that distance.
    pub detection_probability: f64,
    /// Temperatures that a person may have, K.
    pub person_k: [f64; 2],
    /// Temperature of the surrogate target, K.
    pub temperature_k: f64,
    /// Every camera, person, material and tolerance of the emissivity.
    pub rows: Vec<StandIn>,
    /// How far the shapes of its spectrum are off, where they are.
    pub shape: Option<ShapesDrawn>,
    /// Whether all pixels of the object tell together, not one.
    pub of_object: bool,
    /// What the reader must know.
    pub warnings: Vec<Warning>,
    /// That the rule does not hold on the day that is asked about.
    #[serde(skip)]
    pub idle: Option<NotInForce>,
    /// Whether errors of the emissivities, which the rule has, are left out.
    #[serde(skip)]
    pub without_errors: bool,
    /// Units of the rule.
    #[serde(skip)]
    pub units: Units,
}

/// Shapes of spectra that were drawn.
#[derive(Debug, Clone, Copy, serde::Serialize)]
#[non_exhaustive]
pub struct ShapesDrawn {
    /// Root mean square error of the emissivity.
    pub emissivity_error: f64,
    /// Difference of wavenumbers over which the errors lose their correlation, cm⁻¹.
    pub correlation_cm1: f64,
    /// How many were drawn; a tolerance is the least of theirs.
    pub count: usize,
    /// Share of all such shapes that have at least the tolerance.
    pub share: f64,
    /// Level of confidence of that statement, 0 to 1.
    pub confidence: f64,
}

/// One surrogate target seen by one camera.
#[derive(Debug, Clone, serde::Serialize)]
#[non_exhaustive]
pub struct StandIn {
    /// Name of the camera that looks at both.
    pub camera: String,
    /// Name of the material of the person.
    pub person: String,
    /// Name of the material of the surrogate target.
    pub material: String,
    /// Tolerance of the emissivity of the surrogate target, 0 to 1.
    pub emissivity_tolerance: f64,
    /// Tolerance of its temperature at the edge, K; `None` where it is distinguished from a person at its very temperature. No more than 40 K are
    /// looked at.
    pub temperature_tolerance_k: Option<f64>,
    /// The same, proved for all that is within; `None` where nothing is.
    pub temperature_tolerance_proved_k: Option<f64>,
    /// Statistical distance of the farthest at the edge.
    pub distance: f64,
    /// The state at the edge of the tolerance in which the surrogate differs most from the person.
    pub farthest: StandInScene,
}

/// A surrogate target and the person that is most similar to it.
#[derive(Debug, Clone, serde::Serialize)]
#[non_exhaustive]
pub struct StandInScene {
    /// Difference of the surrogate's emissivity from that of its material.
    pub emissivity_offset: f64,
    /// Temperature of the surrogate in that state, K.
    pub temperature_k: f64,
    /// Lighting factor of every object.
    pub lighting: Vec<f64>,
    /// Temperature of every object, K.
    pub surroundings_k: Vec<f64>,
    /// Temperature of the person, K.
    pub person_temperature_k: f64,
    /// Lighting factors of the person in that state, 0 to 1.
    pub person_lighting: Vec<f64>,
}

/// A camera before one person and one stand-in, from one distance.
struct Before<'a> {
    study: &'a Study,
    /// Emissivities of the stand-in: its material's own, or shapes about it.
    shapes: Vec<Vec<f64>>,
    counting: hadar::fisher::Counting,
    envelope: &'a Envelope,
    required: f64,
    person_k: [f64; 2],
    /// In common to every object; `None` where there is none.
    person_lighting: Option<[f64; 2]>,
    temperature_k: f64,
}

impl RuleStudy {
    /// Within which tolerances a stand-in passes for a person, by the clause that tells people apart, on a day; `progress` is told
    /// how many rows of how many are done.
    ///
    /// # Errors
    /// No such clause, or several and none of them named; a material that is not known; surroundings that leave no room for the largest lighting.
    pub fn stand_in(
        &self,
        library: &Library,
        on: Option<Date>,
        progress: &dyn Fn(usize, usize),
    ) -> Result<StandInAnswer> {
        let spec = self.rule.stand_in.clone().unwrap_or_default();
        let (apart, name) = self.turned(spec.clause.as_deref())?;
        if apart
            .scenario
            .unknown
            .priors
            .keys()
            .any(|of| matches!(of, Nuisance::Temperature | Nuisance::Lighting))
        {
            let found = "what is known beforehand of a person is not known to the bounds of a stand-in";
            let error =
                Error::malformed(found, "leave out the priors, and write [envelope] as narrow as they are");
            return Err(error.at(apart.scenario.place("unknown.priors")));
        }
        let studies = studies(apart, &spec, library)?;
        let scenario = &apart.scenario;
        let temperature_k = spec.temperature_k.unwrap_or(scenario.target.temperature_k);
        let person_k = apart.envelope.temperature_k.unwrap_or([scenario.target.temperature_k; 2]);
        let mut jobs = Vec::new();
        for (camera, ends) in &studies {
            let Some(first) = ends.first() else { continue };
            for (index, stand_in) in first.alternatives.iter().enumerate() {
                for &tolerance in &spec.emissivity {
                    jobs.push((camera, ends, index, stand_in, tolerance));
                }
            }
        }
        let mut rows = Vec::with_capacity(jobs.len());
        let all = jobs.len();
        for part in jobs.chunks(rayon::current_num_threads().max(1)) {
            let done: Vec<StandIn> = parallel::try_map(part.len(), |i| {
                let (camera, ends, index, stand_in, tolerance) = &part[i];
                let before = ends.iter().map(|study| {
                    let stand_in = &study.alternatives[*index];
                    Before::new(study, shapes(study, stand_in, spec.shape), apart, person_k, temperature_k)
                });
                let before = undominated(before.collect::<Result<Vec<_>>>()?);
                // Between two ends of a plain sight nothing is counted more than at one of them.
                let z = |study: &Study| study.scenario.target.distance_m;
                let provable = plain(&apart.scenario) || ends.iter().all(|study| z(study) == z(&ends[0]));
                let names = [camera.as_str(), &ends[0].target.name, &stand_in.name];
                row(&before, names.map(str::to_owned), *tolerance, provable && spec.shape.is_none())
            })?;
            rows.extend(done);
            progress(rows.len(), all);
        }
        let without_errors = scenario.sensitivity.is_some_and(|errors| errors.emissivity_error > 0.0);
        let idle = self.idle(on);
        let left_out = without_errors.then_some(Warning::EmissivityErrorsLeftOut);
        Ok(StandInAnswer {
            clause: name,
            idle,
            warnings: idle.map(Warning::NotInForce).into_iter().chain(left_out).collect(),
            without_errors,
            distance: apart.required,
            detection_probability: detection::probability(apart.required),
            person_k,
            temperature_k,
            shape: spec.shape.map(|shape| ShapesDrawn {
                emissivity_error: shape.emissivity_error,
                correlation_cm1: shape.correlation_cm1,
                count: SHAPES,
                share: SHARE,
                confidence: 1.0 - SHARE.powi(SHAPES as i32),
            }),
            of_object: apart.scenario.is_of_object(),
            rows,
            units: scenario.units(),
        })
    }
}

impl RuleStudy {
    /// The clause whose limit is turned round.
    fn turned(&self, named: Option<&str>) -> Result<(&TellApart, Option<String>)> {
        let clauses = self.clauses.iter().zip(&self.rule.clauses).filter_map(|(kind, clause)| match kind {
            Kind::Apart(apart) if clause.demand == Demand::TellApart => Some((&**apart, clause.name.clone())),
            _ => None,
        });
        let all: Vec<(&TellApart, Option<String>)> = clauses.collect();
        let names: Vec<String> =
            all.iter().flat_map(|(_, name)| name).map(|name| format!("{name:?}")).collect();
        let wrong = |key: &str, found: String, instead: String| {
            Err(Error::malformed(found, instead).at(self.rule.scenario.place(key)))
        };
        match (all.as_slice(), named) {
            ([], _) => {
                let instead = "write [[clause]] with kind = \"tell-apart\"".into();
                wrong("", "no clause of the rule distinguishes people".into(), instead)
            }
            (_, Some(named)) => match all.iter().find(|(_, name)| name.as_deref() == Some(named)) {
                Some(found) => Ok(found.clone()),
                None if names.is_empty() => {
                    wrong("stand_in.clause", "the rule has no [[clause]]".into(), "leave it out".into())
                }
                None => {
                    let found = format!("no clause `{named}` distinguishes people");
                    wrong("stand_in.clause", found, format!("write one of {}", names.join(", ")))
                }
            },
            ([one], None) => Ok(one.clone()),
            (_, None) => {
                let found = format!("{} clauses distinguish people: {}", all.len(), names.join(", "));
                let instead = format!("write clause = {} in [stand_in], or another of them", names[0]);
                wrong("stand_in", found, instead)
            }
        }
    }
}

/// Whether a camera counts most from one of the ends of the distances: not through air, nor where the target is smaller than its pixel.
fn plain(scenario: &Scenario) -> bool {
    scenario.target.size_m.is_none() && scenario.atmosphere.is_none()
}

/// Those of them before which no other, from the same distance, counts as much or more amid as little noise or less.
fn undominated(all: Vec<Before<'_>>) -> Vec<Before<'_>> {
    let no_worse = |one: &Before<'_>, other: &Before<'_>| {
        one.study.scenario.target.distance_m == other.study.scenario.target.distance_m
            && one.counting.counts_per_radiance >= other.counting.counts_per_radiance
            && (0..one.study.bands.len()).all(|w| one.counting.var_added(w) <= other.counting.var_added(w))
    };
    let mut best: Vec<Before<'_>> = Vec::with_capacity(all.len());
    for one in all {
        if !best.iter().any(|known| no_worse(known, &one)) {
            best.retain(|known| !no_worse(&one, known));
            best.push(one);
        }
    }
    best
}

/// For each camera and person the studies whose alternatives are the stand-ins, from the ends of the distances, with uncertain figures of
/// the camera on all of their sides.
fn studies(apart: &TellApart, spec: &StandInSpec, library: &Library) -> Result<Vec<(String, Vec<Study>)>> {
    let mut found = Vec::new();
    for candidate in &apart.candidates {
        let place = |key: &str| apart.rule.camera_place(candidate.named.index, key);
        let uncertain = apart.uncertain(candidate, &place)?;
        let sides = uncertain.iter().flat_map(Uncertain::sides).collect::<Result<Vec<_>>>()?;
        for near in &candidate.near {
            if near.has_classes() {
                let found = "a stand-in is judged for one material, and there is a class";
                let error = Error::malformed(found, "name one of its members in the target and the envelope");
                return Err(error.at(apart.scenario.place("class")));
            }
            let mut scenario = near.scenario.clone();
            let own = scenario.target.material.clone();
            let materials: Vec<MaterialRef> = spec.materials.clone().unwrap_or_else(|| vec![own.clone()]);
            let others: Vec<MaterialRef> = materials.iter().filter(|one| **one != own).cloned().collect();
            // A study has at least one alternative; of the person's own material there is none.
            let asked = if others.is_empty() {
                scenario.alternatives.materials.clone()
            } else {
                Some(others.clone())
            };
            scenario.alternatives.materials = asked;
            let mut ends = Vec::new();
            let plain = plain(&scenario);
            let distances = match candidate.distance_m {
                Some([least, most]) if least < most && plain => vec![Some(least), Some(most)],
                Some([least, most]) if least < most => steps([least, most]).map(Some).collect(),
                other => vec![other.map(|[least, _]| least)],
            };
            for distance_m in distances {
                scenario.target.distance_m = distance_m;
                let mut study = Study::new(&scenario, library)?;
                if let Some(class) = study.members[1].iter().find(|members| members.spec.is_some()) {
                    let found = format!("`{}` is a class, and a stand-in is one material", class.name);
                    let error = Error::malformed(found, "name its members, each a stand-in of its own");
                    return Err(error.at(apart.scenario.place("stand_in.materials")));
                }
                if others.is_empty() {
                    study.alternatives.clear();
                }
                if materials.contains(&own) {
                    study.alternatives.insert(0, study.target.clone());
                }
                for camera in &sides {
                    ends.push(study.before(camera, distance_m)?);
                }
                ends.push(study);
            }
            found.push((candidate.named.name.clone(), ends));
        }
    }
    Ok(found)
}

impl<'a> Before<'a> {
    fn new(
        study: &'a Study,
        shapes: Vec<Vec<f64>>,
        apart: &'a TellApart,
        person_k: [f64; 2],
        temperature_k: f64,
    ) -> Result<Self> {
        // The least noise that there may be: what helps to tell.
        let ranges = study.ranges(&apart.envelope)?;
        let cold = |ranges: &[[f64; 2]]| ranges.iter().map(|range| range[0]).collect::<Vec<_>>();
        let darkest = State {
            temperature_k: ranges.temperature_k()[0].min(temperature_k - widest_k(temperature_k)),
            lighting: cold(ranges.lighting()),
            gain: 1.0,
            environment_k: cold(ranges.environment_k()),
        };
        let counting = Study { state: darkest, ..study.clone() }.counting().ok_or_else(|| {
            Error::malformed("a rule without a camera", "name one, as in cameras = [\"ideal-pnrd\"]")
        })?;
        let (envelope, required) = (&apart.envelope, apart.required);
        let lighting = ranges.lighting().iter();
        let person_lighting =
            lighting.fold(study.range.lighting, |[a, b], [low, high]| [a.max(*low), b.min(*high)]);
        // Without one a person is lit as the stand-in is.
        let person_lighting = Some(person_lighting).filter(|[low, high]| low <= high);
        Ok(Self { study, shapes, counting, envelope, required, person_k, person_lighting, temperature_k })
    }

    /// How wide a tolerance of the temperature may be, K; below 0 where the stand-in is no person's temperature, and that is known.
    fn widest_k(&self) -> f64 {
        let [low, high] = self.person_k;
        let within = (self.temperature_k - low).min(high - self.temperature_k);
        match self.study.is_unknown(Nuisance::Temperature) {
            true => widest_k(self.temperature_k),
            false => widest_k(self.temperature_k).min(within),
        }
    }

    /// The farthest of a shape within tolerances.
    fn farthest(
        &self,
        shape: usize,
        [emissivity, temperature_k]: [f64; 2],
        effort: &Effort,
    ) -> Result<Farthest> {
        let study = self.study;
        let shape = &self.shapes[shape];
        let own = shape.iter().copied();
        let least = own.clone().fold(f64::INFINITY, f64::min);
        let most = own.fold(0.0, f64::max);
        // What no surface can be is not within a tolerance.
        let offsets = [-emissivity.min(least), emissivity.min(1.0 - most)];
        let ranges = study.ranges(self.envelope)?;
        let around = [self.temperature_k - temperature_k, self.temperature_k + temperature_k];
        let ranges = Ranges::new(around, ranges.lighting().to_vec(), ranges.environment_k().to_vec())?;
        let own = study.unknowns.nuisances().iter().copied();
        let unknowns = match self.person_lighting {
            Some(_) => study.unknowns.clone(),
            None => Unknowns::new(own.filter(|nuisance| *nuisance != Nuisance::Lighting))?,
        };
        let lighting = self.person_lighting.unwrap_or(study.range.lighting);
        let scene = EnvelopeScene {
            bands: &study.bands,
            surroundings: &study.surroundings,
            emissivity: shape,
            alternative: &study.target.emissivity,
            counting: &self.counting,
            unknowns: &unknowns,
            range: StateRange { temperature_k: self.person_k, lighting, ..study.range },
        };
        farthest(&scene, offsets, &ranges, effort)
    }
}

/// How wide a tolerance may be, K.
fn widest_k(temperature_k: f64) -> f64 {
    WIDEST_K.min(0.5 * temperature_k)
}

/// Emissivities of a stand-in: its material's own, or so many shapes about it.
fn shapes(study: &Study, stand_in: &Surface, error: Option<SensitivitySpec>) -> Vec<Vec<f64>> {
    let Some(error) = error else { return vec![stand_in.emissivity.clone()] };
    let ripple = Ripple::new(study.bands.nodes_cm1(), error.emissivity_error, error.correlation_cm1);
    let drawn = |shape: usize| {
        let mut random = ChaCha8Rng::seed_from_u64(SEED);
        random.set_stream(shape as u64);
        ripple.applied(&stand_in.emissivity, &mut random)
    };
    (0..SHAPES).map(drawn).collect()
}

fn row(
    ends: &[Before<'_>],
    [camera, person, material]: [String; 3],
    tolerance: f64,
    provable: bool,
) -> Result<StandIn> {
    let required = ends.first().map_or(f64::NAN, |before| before.required);
    let widest_k = ends.first().map_or(0.0, Before::widest_k);
    let of = |shape: usize, temperature_k: f64, effort: &Effort| -> Result<Farthest> {
        let mut worst: Option<Farthest> = None;
        for before in ends {
            let found = before.farthest(shape, [tolerance, temperature_k], effort)?;
            let upper_bound = worst.as_ref().map_or(0.0, |known| known.upper_bound).max(found.upper_bound);
            let farther = worst.as_ref().is_none_or(|known| found.distance > known.distance);
            worst = Some(if farther { found } else { worst.unwrap_or(found) });
            if let Some(worst) = &mut worst {
                worst.upper_bound = upper_bound;
            }
        }
        worst.ok_or_else(|| Error::malformed("a stand-in before no camera", "report this as a bug"))
    };
    let search = Effort { relative_tolerance: 0.0, boxes: BOXES, enough: None };
    // The widest tolerance of a shape, no more than one that is wide enough.
    let edge_of = |shape: usize, demanded: f64, enough_k: f64| -> Result<Option<f64>> {
        let excess = |k: f64| Ok(of(shape, k, &search)?.distance / demanded - 1.0);
        if enough_k < 0.0 {
            return Ok(None);
        }
        let widest = excess(enough_k)?;
        if widest <= 0.0 {
            return Ok(Some(enough_k));
        }
        let at_once = excess(0.0)?;
        if at_once >= 0.0 {
            return Ok(None);
        }
        root::crossing_between([0.0, at_once], [enough_k, widest], excess).map(Some)
    };
    // The least of all shapes.
    let (mut edge, mut hardest) = (Some(widest_k), 0);
    for shape in 0..ends.first().map_or(0, |before| before.shapes.len()) {
        let Some(enough_k) = edge else { break };
        let own = edge_of(shape, required, enough_k)?;
        if own.is_none_or(|own| own < enough_k) {
            (edge, hardest) = (own, shape);
        }
    }
    let mut at = of(hardest, edge.unwrap_or(0.0), &search)?;
    // Where none passes the farthest of all shapes is told, at the very temperature.
    for shape in 0..ends.first().filter(|_| edge.is_none()).map_or(0, |before| before.shapes.len()) {
        let other = of(shape, 0.0, &search)?;
        at = if other.distance > at.distance { other } else { at };
    }
    let proof = Effort { relative_tolerance: 0.0, boxes: PROOF_BOXES, enough: Some(required) };
    let mut proved = None;
    if provable && edge.is_some() {
        let inner = edge_of(hardest, PROVED * required, widest_k)?;
        let holds = |k: f64| Ok::<_, Error>(of(hardest, k, &proof)?.upper_bound <= required);
        proved = match inner {
            Some(k) if holds(k)? => Some(k),
            _ => None,
        };
    }
    let State { temperature_k, lighting, environment_k, .. } = at.state;
    Ok(StandIn {
        camera,
        person,
        material,
        emissivity_tolerance: tolerance,
        temperature_tolerance_k: edge,
        temperature_tolerance_proved_k: proved,
        distance: at.distance,
        farthest: StandInScene {
            emissivity_offset: at.offset,
            temperature_k,
            lighting,
            surroundings_k: environment_k,
            person_temperature_k: at.person.temperature_k,
            person_lighting: at.person.lighting,
        },
    })
}
