//! Band signals and their derivatives in numbers of many digits: what [`Jacobian`](super::Jacobian) computes, without its
//! rounding.
//!
//! The formulas are those of [`Jacobian`](super::Jacobian), per node and summed over the nodes of a band:
//!
//! * ∂S/∂T = G e ∂B/∂T;  ∂S/∂Vₖ = G(1 − e)εₖB(Tₖ), with a known total G(1 − e)[εₖB(Tₖ) − ε_K B(T_K)];
//! * ∂S/∂ln G = S;  ∂S/∂Tₖ = G(1 − e)Vₖεₖ ∂B/∂T(Tₖ);  ∂S/∂g = G(e′ − e){Σ Vₖεₖ[B(T) − B(Tₖ)] + [1 − ΣVₖεₖ]B(T)};
//! * B = 2cν²/(eˣ − 1), ∂B/∂T = B·x(1 + 1/(eˣ − 1))/T, x = hcν/kT, with exact SI constants.
//!
//! The doubles of a scene count as exact: two temperatures that differ by their last bit are two temperatures.
//!
//! Source: paper S24–S30, S48; SI constants (2019).

use super::{Parameter, State, Surroundings};
use crate::spectrum::Bands;
use crate::wide::Wide;

/// hc/k in cm K: h·10⁴², c in m s⁻¹ and k·10²⁹, which are integers; together with the power of ten that is left.
const HC_OVER_K: [f64; 4] = [662_607_015.0, 299_792_458.0, 1_380_649.0, 1e11];
/// 2c in cm s⁻¹ times cm² per m².
const PREFACTOR: f64 = 2.0 * 299_792_458.0 * 1e6;

/// What columns are asked for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Asked<'q> {
    pub(crate) emissivity: &'q [f64],
    pub(crate) alternative: &'q [f64],
    pub(crate) state: &'q State,
    pub(crate) parameters: &'q [Parameter],
    pub(crate) lighting_total_known: bool,
}

/// A derivative of each band.
#[derive(Debug, Clone)]
pub(crate) struct Column<const L: usize> {
    pub(crate) values: Vec<Wide<L>>,
    /// The same with every term taken by its magnitude, where some cancel: rounding is a share of these.
    pub(crate) terms: Option<Vec<Wide<L>>>,
}

impl<const L: usize> Column<L> {
    pub(crate) fn exact(values: Vec<Wide<L>>) -> Self {
        Self { values, terms: None }
    }

    /// Adds a row that is exact.
    pub(crate) fn push(&mut self, value: Wide<L>) {
        self.values.push(value);
        if let Some(terms) = &mut self.terms {
            terms.push(value);
        }
    }
}

/// B and ∂B/∂T at the nodes.
#[derive(Debug, Clone)]
struct Blackbody<const L: usize> {
    temperature_k: f64,
    value: Vec<Wide<L>>,
    slope: Vec<Wide<L>>,
}

/// Spectra of one set of bands and surroundings, with the blackbodies of the last state.
#[derive(Debug, Clone)]
pub(crate) struct CarefulScene<'a, const L: usize> {
    bands: &'a Bands,
    surroundings: &'a Surroundings,
    blackbodies: Vec<Blackbody<L>>,
}

/// Σ weight × value over the nodes of every band.
fn banded<const L: usize>(bands: &Bands, values: impl Iterator<Item = Wide<L>>) -> Vec<Wide<L>> {
    let mut terms = values.zip(bands.weights_cm1()).map(|(value, weight)| value * Wide::from(*weight));
    let add = |a: Wide<L>, b| a + b;
    bands.nodes_per_band().map(|count| terms.by_ref().take(count).fold(Wide::ZERO, add)).collect()
}

impl<'a, const L: usize> CarefulScene<'a, L> {
    pub(crate) fn new(bands: &'a Bands, surroundings: &'a Surroundings) -> Self {
        Self { bands, surroundings, blackbodies: Vec::new() }
    }

    /// Index of the blackbody of a temperature.
    fn blackbody(&mut self, temperature_k: f64) -> usize {
        if let Some(known) = self.blackbodies.iter().position(|known| known.temperature_k == temperature_k) {
            return known;
        }
        let [h, c, k, ten] = HC_OVER_K.map(Wide::<L>::from);
        let per_kelvin = Wide::from(temperature_k).inverse();
        let thermal = h * c * (k * ten).inverse() * per_kelvin;
        let one = Wide::from(1.0);
        let of = |&nu: &f64| {
            let nu = Wide::from(nu);
            let x = thermal * nu;
            let occupancy = x.exp_minus_one().inverse();
            let value = Wide::from(PREFACTOR) * nu * nu * occupancy;
            (value, value * x * (one + occupancy) * per_kelvin)
        };
        let (value, slope) = self.bands.nodes_cm1().iter().map(of).unzip();
        self.blackbodies.push(Blackbody { temperature_k, value, slope });
        self.blackbodies.len() - 1
    }

    /// Signal of each band, and its derivatives, one for each of the parameters.
    pub(crate) fn columns(&mut self, asked: Asked<'_>) -> (Vec<Wide<L>>, Vec<Column<L>>) {
        let Asked { emissivity, alternative, state, parameters, lighting_total_known } = asked;
        self.blackbodies.retain(|known| {
            known.temperature_k == state.temperature_k || state.environment_k.contains(&known.temperature_k)
        });
        let own = self.blackbody(state.temperature_k);
        let objects: Vec<usize> = state.environment_k.iter().map(|&t| self.blackbody(t)).collect();
        let (own, bodies) = (&self.blackbodies[own], &self.blackbodies);
        let one = Wide::<L>::from(1.0);
        let given = |k: usize, j: usize| {
            self.surroundings.objects()[k].emissivity.as_ref().map_or(one, |e| Wide::from(e[j]))
        };
        let lighting: Vec<Wide<L>> = state.lighting.iter().map(|&factor| Wide::from(factor)).collect();
        let gain = Wide::from(state.gain);
        let incident = |k: usize, j: usize| given(k, j) * bodies[objects[k]].value[j];
        let rest = lighting.iter().fold(one, |rest, factor| rest - *factor);
        let signal = banded(
            self.bands,
            emissivity.iter().enumerate().map(|(j, &e)| {
                let e = Wide::from(e);
                let lit = lighting
                    .iter()
                    .enumerate()
                    .fold(Wide::ZERO, |lit, (k, factor)| lit + *factor * incident(k, j));
                gain * (e * own.value[j] + (one - e) * lit)
            }),
        );
        let last = objects.len().saturating_sub(1);
        let contrast = |j: usize| {
            lighting.iter().enumerate().fold(rest * own.value[j], |sum, (k, factor)| {
                let (e, difference) = (given(k, j), own.value[j] - bodies[objects[k]].value[j]);
                sum + *factor * (e * difference + (one - e) * own.value[j])
            })
        };
        let column = |parameter: &Parameter| {
            if *parameter == Parameter::Gain {
                return Column::exact(signal.clone());
            }
            let at = |(j, &e): (usize, &f64)| {
                let e = Wide::from(e);
                gain * match *parameter {
                    Parameter::Temperature => e * own.slope[j],
                    Parameter::Lighting(k) if lighting_total_known && k != last => {
                        (one - e) * (incident(k, j) - incident(last, j))
                    }
                    Parameter::Lighting(k) => (one - e) * incident(k, j),
                    Parameter::EnvironmentTemperature(k) => {
                        (one - e) * lighting[k] * given(k, j) * bodies[objects[k]].slope[j]
                    }
                    Parameter::Material => (Wide::from(alternative[j]) - e) * contrast(j),
                    Parameter::Gain => Wide::ZERO,
                }
            };
            let values = banded(self.bands, emissivity.iter().enumerate().map(at));
            let all = |(j, &e): (usize, &f64)| {
                let e = Wide::from(e);
                gain * match *parameter {
                    Parameter::Material => {
                        let lit = (0..objects.len())
                            .fold(own.value[j].shifted(1), |sum, k| sum + lighting[k] * incident(k, j));
                        (Wide::from(alternative[j]) - e).abs() * lit
                    }
                    Parameter::Lighting(k) => (one - e) * (incident(k, j) + incident(last, j)),
                    _ => Wide::ZERO,
                }
            };
            let cancels = match *parameter {
                Parameter::Material => true,
                Parameter::Lighting(k) => lighting_total_known && k != last,
                _ => false,
            };
            let terms = cancels.then(|| banded(self.bands, emissivity.iter().enumerate().map(all)));
            Column { values, terms }
        };
        let columns = parameters.iter().map(column).collect();
        (signal, columns)
    }
}
