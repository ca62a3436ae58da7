//! Priors in a proof.
//!
//! A Gaussian prior of deviation σ_p adds ρ² to d², ρ = w(θ′ − θ) with w = 1/(2σ_p) and θ what the target has. A state within reach
//! has |ρ| ≤ reach in each of them, which narrows what is unknown. Where the gain is known a prior is also one more residual that is
//! linear in what the bounds are over, without any loss: a lighting factor is the amplitude of its source, and the temperature of a
//! source of known amplitude c is the place between the ends of its chord, T = T_cold + z (T_hot − T_cold)/c with z the hot share. The others (of the gain,
//! of factors beside an unknown gain, of temperatures of sources whose amplitude is unknown) only add to a distance; the bound leaves them out.

use super::amplitudes::{Amplitudes, Pieces};
use crate::identifiability::nearest::residual::{Comparison, Target};
use crate::identifiability::space::value;
use crate::scene::{Parameter, State};

/// Rounding of a parameter, as a share of it.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Share of a parameter up to which a prior leaves it open within reach for it to be as good as known.
const PINNED: f64 = 1e-10;
/// Slope of a row from which on its square would soon be beyond numbers.
const STEEPEST: f64 = 1e120;

/// Parameter, w and θ.
#[derive(Debug, Clone, Copy)]
struct Prior {
    parameter: Parameter,
    weight: f64,
    centre: f64,
}

/// A residual: ρ = slope · (z of a source's amplitude or hot share) + …
#[derive(Debug, Clone, Copy)]
struct Row {
    prior: Prior,
    /// Whose amplitude or temperature it is of.
    source: usize,
    /// The known amplitude of that source, where it is of its temperature.
    amplitude: Option<f64>,
}

/// All priors of a pair.
#[derive(Debug, Clone, Default)]
pub(super) struct Priors {
    all: Vec<Prior>,
    reach: f64,
    rows: Vec<Row>,
    is_whole: bool,
}

impl Priors {
    pub(super) fn new(comparison: &Comparison<'_>, target: &Target<'_>, reach: f64) -> Self {
        let priors = comparison.priors(target).map(|(i, weight)| {
            let parameter = comparison.space.parameters[i];
            Prior { parameter, weight, centre: value(target.state, parameter) }
        });
        Self { all: priors.collect(), reach, rows: Vec::new(), is_whole: true }
    }

    /// The range of a parameter as far as it is within reach.
    pub(super) fn within_reach(&self, parameter: Parameter, [low, high]: [f64; 2]) -> [f64; 2] {
        let Some(prior) = self.all.iter().find(|prior| prior.parameter == parameter) else {
            return [low, high];
        };
        let room = self.reach / prior.weight + ROUNDING * prior.centre.abs();
        [low.max(prior.centre - room).min(high), high.min(prior.centre + room).max(low)]
    }

    /// Finds which of them are residuals, by what the amplitudes may be.
    pub(super) fn put_rows(&mut self, allowed: &Amplitudes) {
        self.is_whole = true;
        for prior in &self.all {
            // Within reach that is known as well as it matters: the range says it all, and a residual would be nothing but rounding.
            if self.reach <= PINNED * prior.weight * prior.centre.abs() {
                continue;
            }
            let linear = match prior.parameter {
                _ if allowed.gain_free => None,
                Parameter::Lighting(k) => Some((k + 1, None)),
                Parameter::Temperature => Some((0, Some(1.0))),
                Parameter::EnvironmentTemperature(k) => match allowed.tied(k) {
                    // What is dark has the target's temperature for nothing.
                    Some(0.0) => continue,
                    factor => factor.map(|factor| (k + 1, Some(factor))),
                },
                Parameter::Gain | Parameter::Material => None,
            };
            // Of what is next to dark the slope is beyond numbers.
            let linear = linear.filter(|(_, amplitude)| prior.weight / amplitude.unwrap_or(1.0) < STEEPEST);
            match linear {
                Some((source, amplitude)) => self.rows.push(Row { prior: *prior, source, amplitude }),
                None => self.is_whole = false,
            }
        }
    }

    /// Whether the bound leaves none out.
    pub(super) fn are_rows(&self) -> bool {
        self.is_whole
    }

    /// The rows at a state.
    pub(super) fn at<'s>(&'s self, state: &'s State) -> impl Iterator<Item = PriorAt> + 's {
        self.rows.iter().map(|Row { prior, source, amplitude }| PriorAt {
            residual: prior.weight * (value(state, prior.parameter) - prior.centre),
            per_unit: prior.weight / amplitude.unwrap_or(1.0),
            source: *source,
            of_temperature: amplitude.is_some(),
        })
    }

    /// ρ = constant + entries · z of the pieces of a box, row by row; no entries where it is not linear in them, of an amplitude that
    /// stands in it by its shape.
    pub(super) fn put_pieces(&self, pieces: &Pieces, mut put: impl FnMut(f64, &[f64])) {
        let count = pieces.source.len();
        let mut entries = vec![0.0; count];
        for Row { prior: Prior { weight, centre, .. }, source, amplitude } in &self.rows {
            entries.fill(0.0);
            let mut own = (0..count).filter(|&i| pieces.source[i] == *source);
            let Some(first) = own.next() else { continue };
            if pieces.unit[first] != [1.0; 2] {
                continue;
            }
            let Some(amplitude) = amplitude else {
                entries[first] = *weight;
                put(-weight * centre, &entries);
                continue;
            };
            let per_unit = weight / amplitude;
            entries[first] = per_unit * (pieces.temperature_k[first] - centre);
            if let Some(rise) = own.next() {
                entries[rise] = per_unit * (pieces.temperature_k[rise] - pieces.temperature_k[first]);
            }
            put(0.0, &entries);
        }
    }
}

/// A row at a state.
#[derive(Debug, Clone, Copy)]
pub(super) struct PriorAt {
    /// ρ.
    pub(super) residual: f64,
    /// ∂ρ by the amplitude c of the source, or by cT.
    pub(super) per_unit: f64,
    pub(super) source: usize,
    pub(super) of_temperature: bool,
}

impl PriorAt {
    /// ∂ρ by changes of the amplitudes of some sources, and by cT of others.
    pub(super) fn entries(&self, lit: &[usize], axes: impl Iterator<Item = usize>) -> Vec<f64> {
        let entry = |s: usize, of_temperature: bool| {
            if (s, of_temperature) == (self.source, self.of_temperature) { self.per_unit } else { 0.0 }
        };
        lit.iter().map(|&s| entry(s, false)).chain(axes.map(|s| entry(s, true))).collect()
    }
}
