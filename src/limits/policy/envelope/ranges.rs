//! The ranges of an envelope, the scenes within them, and whether one is in equilibrium.
//!
//! A target at the temperature of black surroundings that light it wholly (ΣVₖ = 1) radiates as a blackbody whatever it
//! is made of: S = eB + (1 − e)B. Where an envelope holds such a scene, and the alternative may be in that state too,
//! the least distance is 0, and no camera meets a requirement over it. Two gray materials need no more than one
//! temperature for that: another lighting factor makes up for another emissivity.

use super::scene::EnvelopeScene;
use crate::error::{Error, Result, check};
use crate::fisher::Nuisance;
use crate::scene::{State, unlit};

/// By how much a sum of lighting factors may differ from 1 by the rounding of the user's own numbers.
const ROUNDING: f64 = 1e-12;

/// How many scenes at one temperature are looked at, at either end of what is possible.
const ISOTHERMAL: u32 = 5;

/// Ranges of the states of a scene: what a requirement must hold for.
#[derive(Debug, Clone, PartialEq)]
pub struct Ranges {
    temperature_k: [f64; 2],
    lighting: Vec<[f64; 2]>,
    environment_k: Vec<[f64; 2]>,
}

impl Ranges {
    /// Lowest and highest temperature of the target (K), lighting factor and temperature (K) of each object around it. Of
    /// the lighting only what sums to 1 at most is in the envelope.
    ///
    /// # Errors
    /// Ends in the wrong order, a temperature that is not positive, a lighting factor outside [0, 1], lower ends of the
    /// lighting that sum to more than 1, not as many ranges of lighting as of temperatures.
    ///
    /// ```
    /// use hadar::policy::envelope::Ranges;
    /// assert!(Ranges::new([303.0, 313.0], vec![[0.1, 0.9]], vec![[263.0, 303.0]]).is_ok());
    /// assert!(Ranges::new([313.0, 303.0], vec![[0.1, 0.9]], vec![[263.0, 303.0]]).is_err());
    /// ```
    pub fn new(
        temperature_k: [f64; 2],
        lighting: Vec<[f64; 2]>,
        environment_k: Vec<[f64; 2]>,
    ) -> Result<Self> {
        if lighting.len() != environment_k.len() {
            let what = "ranges of the lighting".into();
            return Err(Error::Length { what, found: lighting.len(), expected: environment_k.len() });
        }
        let quantity = "temperature of the target in the envelope";
        temperature_k.iter().try_for_each(|&t| check::positive(quantity, t, "K").map(drop))?;
        ordered(quantity, temperature_k)?;
        for &range in &environment_k {
            let quantity = "temperature of the surroundings in the envelope";
            range.iter().try_for_each(|&t| check::positive(quantity, t, "K").map(drop))?;
            ordered(quantity, range)?;
        }
        for &range in &lighting {
            let quantity = "lighting in the envelope";
            range.iter().try_for_each(|&v| check::unit_interval(quantity, v).map(drop))?;
            ordered(quantity, range)?;
        }
        let least: f64 = lighting.iter().map(|range| range[0]).sum();
        if least > 1.0 + ROUNDING {
            let quantity = "sum of the least lighting factors of the envelope";
            return Err(Error::out_of_range(quantity, least, "", "at most 1, or the envelope is empty"));
        }
        Ok(Self { temperature_k, lighting, environment_k })
    }

    /// Lowest and highest temperature of the target, K.
    #[must_use]
    pub fn temperature_k(&self) -> [f64; 2] {
        self.temperature_k
    }

    /// Least and most lighting by each object.
    #[must_use]
    pub fn lighting(&self) -> &[[f64; 2]] {
        &self.lighting
    }

    /// Lowest and highest temperature of each object, K.
    #[must_use]
    pub fn environment_k(&self) -> &[[f64; 2]] {
        &self.environment_k
    }

    /// Makes sure that there is a range for every object of the surroundings.
    pub(super) fn check_objects(&self, expected: usize) -> Result<()> {
        let found = self.lighting.len();
        if found == expected {
            return Ok(());
        }
        Err(Error::Length { what: "ranges of the lighting".into(), found, expected })
    }

    /// Ranges of T, then of Tₖ and Vₖ object by object.
    pub(super) fn all(&self) -> Vec<[f64; 2]> {
        let objects = self.environment_k.iter().zip(&self.lighting).flat_map(|(t, v)| [*t, *v]);
        std::iter::once(self.temperature_k).chain(objects).collect()
    }

    /// The scene at a point of the unit cube, in the order of [`Ranges::all`]; lighting that sums to more than 1 is drawn
    /// towards its least.
    pub(super) fn scene_at(&self, place: &[f64]) -> State {
        let within = |[low, high]: [f64; 2], x: f64| (low + (high - low) * x).clamp(low, high);
        let values: Vec<f64> =
            self.all().into_iter().zip(place).map(|(range, &x)| within(range, x)).collect();
        let objects = values[1..].chunks_exact(2);
        let environment_k = objects.clone().map(|object| object[0]).collect();
        let mut lighting: Vec<f64> = objects.map(|object| object[1]).collect();
        let least: f64 = self.lighting.iter().map(|range| range[0]).sum();
        let total: f64 = lighting.iter().sum();
        if total > 1.0 {
            let share = if total > least { ((1.0 - least) / (total - least)).max(0.0) } else { 0.0 };
            for (factor, [low, _]) in lighting.iter_mut().zip(&self.lighting) {
                *factor = low + share * (*factor - low);
            }
        }
        State { temperature_k: values[0], lighting, gain: 1.0, environment_k }
    }

    /// Some scenes in which all is at one temperature, where contrast is least.
    pub(super) fn isothermal(&self) -> Vec<State> {
        let ranges = || self.environment_k.iter().chain([&self.temperature_k]);
        let low = ranges().map(|range| range[0]).fold(0.0, f64::max);
        let high = ranges().map(|range| range[1]).fold(f64::INFINITY, f64::min);
        if low > high {
            return Vec::new();
        }
        let dimensions = 1 + 2 * self.lighting.len();
        let states = [low, high].into_iter().flat_map(|t| {
            (0..ISOTHERMAL).map(move |step| {
                let share = f64::from(step) / f64::from(ISOTHERMAL - 1);
                let lit = self.scene_at(&vec![share; dimensions]);
                State { temperature_k: t, environment_k: vec![t; self.lighting.len()], ..lit }
            })
        });
        states.collect()
    }

    /// A scene of the envelope in which nothing differs, if there is one that the alternative may be in.
    pub(super) fn equilibrium(&self, scene: &EnvelopeScene<'_>) -> Option<State> {
        // The least temperature common to all that must have it is the lower end of one of the ranges.
        let ends = self.environment_k.iter().chain([&self.temperature_k]).map(|range| range[0]);
        ends.filter_map(|t| self.equilibrium_at(t, scene)).find(|state| may_be_in(scene, state))
    }

    fn equilibrium_at(&self, t: f64, scene: &EnvelopeScene<'_>) -> Option<State> {
        let holds = |range: &[f64; 2]| (range[0]..=range[1]).contains(&t);
        if !holds(&self.temperature_k) {
            return None;
        }
        let mut lighting: Vec<f64> = self.lighting.iter().map(|range| range[0]).collect();
        let mut environment_k = Vec::new();
        for (k, object) in scene.surroundings.objects().iter().enumerate() {
            let [least, most] = self.lighting[k];
            let joins = holds(&self.environment_k[k]) && object.emissivity.is_none();
            if joins {
                lighting[k] += unlit(&lighting).clamp(0.0, most - least);
            } else if least > 0.0 {
                return None;
            }
            environment_k.push(if joins { t } else { self.environment_k[k][0] });
        }
        let dark = unlit(&lighting).abs() > ROUNDING;
        (!dark).then_some(State { temperature_k: t, lighting, gain: 1.0, environment_k })
    }
}

/// Whether the alternative may be in a state of the target, as far as its own is unknown.
fn may_be_in(scene: &EnvelopeScene<'_>, state: &State) -> bool {
    let (unknowns, range) = (scene.unknowns, &scene.range);
    let within = |[low, high]: [f64; 2], value: f64| low <= value && value <= high;
    let warm = within(range.temperature_k, state.temperature_k);
    let limit = unknowns.known_lighting_total().unwrap_or(range.lighting_sum) + ROUNDING;
    let lit = state.lighting.iter().all(|&v| within(range.lighting, v))
        && state.lighting.iter().sum::<f64>() <= limit
        && unknowns.known_lighting_total().is_none_or(|total| (1.0 - total).abs() <= ROUNDING);
    (warm || !unknowns.contains(Nuisance::Temperature)) && (lit || !unknowns.contains(Nuisance::Lighting))
}

fn ordered(quantity: &str, [low, high]: [f64; 2]) -> Result<()> {
    if low <= high {
        return Ok(());
    }
    Err(Error::malformed(
        format!("{quantity} from {low} to {high}: the envelope is empty"),
        "give the lower end first",
    ))
}
