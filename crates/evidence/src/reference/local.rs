//! Local distances by the paper's formulas as they stand.
//!
//! Per node ν with S = G[eB(T) + (1 − e)ΣVₖεₖB(Tₖ)] and C = B(T) − ΣVₖεₖB(Tₖ):
//!
//! * ∂S/∂T = G e ∂B/∂T;  ∂S/∂Vₖ = G(1 − e)εₖB(Tₖ), with a known total G(1 − e)[εₖB(Tₖ) − ε_K B(T_K)];
//! * ∂S/∂ln G = S;  ∂S/∂Tₖ = G(1 − e)Vₖεₖ ∂B/∂T(Tₖ);  ∂S/∂g = G(e′ − e)C.
//!
//! Each is summed over the nodes of a band with their weights. In the inner product Σ u_w a_w b_w, u = 1/(S ΣS) per photon
//! and κ²/(κS + σ²) for counts, with one more row for every prior, the columns are made orthogonal one after the
//! other, as by Gram and Schmidt; d = ½ of what is left of the last, ∂S/∂g.
//!
//! A convention that belongs to the question, not to its arithmetic, is that of the fast path: a band without photons
//! tells nothing. All doubles count as exact, and only a nuisance that depends on the others exactly (of which less than
//! 1e-100 is left), or that the caller names, is left out.
//!
//! Source: paper S24–S30, S48, Algorithm 2.

use super::Extended;
use super::planck::Blackbody;
use hadar::fisher::{Counting, Unknowns};
use hadar::scene::{Parameter, State, Surroundings};
use hadar::spectrum::Bands;

/// Share of a column below which what is left of it is the rounding of 512 bits.
const EXACTLY_DEPENDENT: f64 = 1e-130;

/// Which noise weighs the bands.
#[derive(Debug, Clone, Copy)]
pub enum Noise<'a> {
    /// Shot noise per √photon; priors count as they do among `photons` photons, for nothing where infinite.
    PerPhoton {
        /// Photons in all.
        photons: f64,
    },
    /// Counts with the camera's own noise.
    Counting(&'a Counting),
}

/// A target, what it must be told apart from, and the state that both are compared in.
#[derive(Debug, Clone, Copy)]
pub struct Pair<'a> {
    /// Emissivity e of the target at the nodes.
    pub emissivity: &'a [f64],
    /// Emissivity e′ of the alternative at the nodes.
    pub alternative: &'a [f64],
    /// The target's state.
    pub state: &'a State,
}

/// What extended precision says of a pair.
#[derive(Debug, Clone)]
pub struct LocalAnswer {
    /// d₀ per √photon, or d; 0 where nothing is left but the rounding of 512 bits.
    pub distance: Extended,
    /// The same with no nuisance at all.
    pub distance_no_nuisance: Extended,
    /// ΣS of the target, photons s⁻¹ m⁻² sr⁻¹.
    pub photon_radiance: Extended,
    /// What the others leave of each nuisance.
    pub shares: Vec<Share>,
    /// Nuisances left out: those the caller named, and those that are zero or depend on others exactly.
    pub dropped: Vec<Parameter>,
    /// ½Σ|cᵢ|‖aᵢ‖, cᵢ the coefficients of the material's column on the nuisances: what was projected away, term by
    /// term.
    pub carried: Extended,
    /// [`LocalAnswer::distance_no_nuisance`] with every term of the contrast Σ Vₖεₖ[B(T) − B(Tₖ)] + [1 − ΣVₖεₖ]B(T)
    /// taken by its magnitude: a few units in the last place of this are what doubles can do.
    pub terms: Extended,
}

/// What is left of a nuisance.
#[derive(Debug, Clone, Copy)]
pub struct Share {
    /// Which.
    pub parameter: Parameter,
    /// What the ones before it that were kept leave of it, as a share of ‖a‖ + Σ|cⱼ|‖aⱼ‖, cⱼ its coefficients on them: 0
    /// where it is zero or depends on them exactly.
    pub left: f64,
    /// Largest magnitude of its column, photons s⁻¹ m⁻² sr⁻¹ per unit of the parameter.
    pub largest: f64,
}

/// Spectra in extended precision, and what has been computed of blackbodies.
#[derive(Debug, Clone)]
pub(super) struct Spectra<'a> {
    pub(super) bands: &'a Bands,
    pub(super) surroundings: &'a Surroundings,
    nodes_per_band: Vec<usize>,
    weights: Vec<Extended>,
    blackbodies: Vec<(Extended, Blackbody)>,
}

/// A state with fields of any precision.
#[derive(Debug, Clone)]
pub(super) struct ExtendedState {
    pub(super) temperature: Extended,
    pub(super) lighting: Vec<Extended>,
    pub(super) gain: Extended,
    pub(super) environment: Vec<Extended>,
}

impl From<&State> for ExtendedState {
    fn from(state: &State) -> Self {
        let all = |values: &[f64]| values.iter().map(|&value| Extended::from(value)).collect();
        Self {
            temperature: Extended::from(state.temperature_k),
            lighting: all(&state.lighting),
            gain: Extended::from(state.gain),
            environment: all(&state.environment_k),
        }
    }
}

impl<'a> Spectra<'a> {
    pub(super) fn new(bands: &'a Bands, surroundings: &'a Surroundings) -> Self {
        let ones = vec![1.0; bands.nodes_cm1().len()];
        Self {
            bands,
            surroundings,
            nodes_per_band: bands.sum_nodes(&ones).iter().map(|&count| count as usize).collect(),
            weights: bands.weights_cm1().iter().map(|&weight| Extended::from(weight)).collect(),
            blackbodies: Vec::new(),
        }
    }

    /// Index of the blackbody of a temperature.
    fn blackbody(&mut self, temperature: &Extended) -> usize {
        if let Some(known) = self.blackbodies.iter().position(|(known, _)| known == temperature) {
            return known;
        }
        let new = Blackbody::new(self.bands.nodes_cm1(), temperature);
        self.blackbodies.push((temperature.clone(), new));
        self.blackbodies.len() - 1
    }

    /// Forgets all blackbodies but those of the surroundings as they were given.
    pub(super) fn forget(&mut self) {
        let objects = self.surroundings.objects();
        self.blackbodies
            .retain(|(known, _)| objects.iter().any(|object| *known == Extended::from(object.temperature_k)));
    }

    fn object_emissivity(&self, object: usize, node: usize) -> Extended {
        let emissivity = self.surroundings.objects()[object].emissivity.as_ref();
        emissivity.map_or_else(Extended::one, |emissivity| Extended::from(emissivity[node]))
    }

    /// Σ over the nodes of each band of weight × value.
    fn banded(&self, values: impl Iterator<Item = Extended>) -> Vec<Extended> {
        let mut terms = values.zip(&self.weights).map(|(value, weight)| value * weight);
        self.nodes_per_band.iter().map(|&count| terms.by_ref().take(count).sum()).collect()
    }

    /// Blackbodies of the target and of the objects.
    fn lights(&mut self, state: &ExtendedState) -> (usize, Vec<usize>) {
        let own = self.blackbody(&state.temperature);
        (own, state.environment.iter().map(|temperature| self.blackbody(temperature)).collect())
    }

    fn value(&self, blackbody: usize, node: usize) -> &Extended {
        &self.blackbodies[blackbody].1.values[node]
    }

    fn slope(&self, blackbody: usize, node: usize) -> &Extended {
        &self.blackbodies[blackbody].1.slopes[node]
    }

    /// ΣVₖεₖB(Tₖ) at every node.
    fn lit(&mut self, state: &ExtendedState) -> Vec<Extended> {
        let (_, objects) = self.lights(state);
        let nodes = 0..self.weights.len();
        let at = |node: usize| {
            let term = |(k, factor): (usize, &Extended)| {
                factor * self.object_emissivity(k, node) * self.value(objects[k], node)
            };
            state.lighting.iter().enumerate().map(term).sum()
        };
        nodes.map(at).collect()
    }

    /// Band signals S.
    pub(super) fn signal(&mut self, emissivity: &[f64], state: &ExtendedState) -> Vec<Extended> {
        let lit = self.lit(state);
        let (own, _) = self.lights(state);
        let one = Extended::one();
        let at = |(node, (e, lit)): (usize, (&f64, &Extended))| {
            let e = Extended::from(*e);
            &state.gain * (&e * self.value(own, node) + (&one - &e) * lit)
        };
        self.banded(emissivity.iter().zip(&lit).enumerate().map(at))
    }

    /// ∂S/∂θ of each band for one parameter; for the material, towards `alternative`.
    pub(super) fn column(
        &mut self,
        parameter: Parameter,
        emissivity: &[f64],
        alternative: &[f64],
        state: &ExtendedState,
        total_known: bool,
    ) -> Vec<Extended> {
        if parameter == Parameter::Gain {
            return self.signal(emissivity, state);
        }
        let (own, objects) = self.lights(state);
        let lit = if parameter == Parameter::Material { self.lit(state) } else { Vec::new() };
        let last = objects.len().saturating_sub(1);
        let one = Extended::one();
        let at = |(node, e): (usize, &f64)| {
            let e = Extended::from(*e);
            let incident = |k: usize| self.object_emissivity(k, node) * self.value(objects[k], node);
            let derivative = match parameter {
                Parameter::Temperature => e * self.slope(own, node),
                Parameter::Lighting(k) if total_known && k != last => {
                    (one.clone() - e) * (incident(k) - incident(last))
                }
                Parameter::Lighting(k) => (one.clone() - e) * incident(k),
                Parameter::EnvironmentTemperature(k) => {
                    (one.clone() - e)
                        * &state.lighting[k]
                        * self.object_emissivity(k, node)
                        * self.slope(objects[k], node)
                }
                Parameter::Material => {
                    let contrast = self.value(own, node) - &lit[node];
                    (Extended::from(alternative[node]) - e) * contrast
                }
                Parameter::Gain => Extended::zero(),
            };
            &state.gain * derivative
        };
        self.banded(emissivity.iter().enumerate().map(at))
    }

    /// G[|e − e′||terms of C| + e′|B(T) − B(T′)| + (1 − e′)Σ(|Vₖ − Vₖ′|εₖB(Tₖ) + Vₖ′εₖ|B(Tₖ) − B(Tₖ′)|)] of each band.
    pub(super) fn terms(
        &mut self,
        emissivity: &[f64],
        alternative: &[f64],
        state: &ExtendedState,
        other: &ExtendedState,
    ) -> Vec<Extended> {
        let (own, objects) = self.lights(state);
        let (own_other, objects_other) = self.lights(other);
        let one = Extended::one();
        let lit: Extended = state.lighting.iter().cloned().sum();
        let unlit = &one - lit;
        let at = |(node, (e, other_e)): (usize, (&f64, &f64))| {
            let (e, other_e) = (Extended::from(*e), Extended::from(*other_e));
            let value = self.value(own, node);
            let mut contrast = unlit.abs() * value;
            let mut light = Extended::zero();
            for (k, factor) in state.lighting.iter().enumerate() {
                let (here, there) = (self.value(objects[k], node), self.value(objects_other[k], node));
                let own_e = self.object_emissivity(k, node);
                contrast = contrast + factor * (&own_e * (value - here).abs() + (&one - &own_e) * value);
                let change = (factor - &other.lighting[k]).abs() * here;
                light = light + own_e * (change + &other.lighting[k] * (here - there).abs());
            }
            let own_change = &other_e * (value - self.value(own_other, node)).abs();
            &state.gain * ((e - &other_e).abs() * contrast + own_change + (&one - &other_e) * light)
        };
        self.banded(emissivity.iter().zip(alternative).enumerate().map(at))
    }
}

/// Local distances in extended precision, in fixed bands and surroundings.
///
/// ```
/// use hadar::fisher::{Nuisance, Unknowns};
/// use hadar_evidence::reference::local::{LocalReference, Noise, Pair};
/// use hadar::scene::{EnvironmentObject, Surroundings};
/// use hadar::spectrum::Bands;
///
/// let bands = Bands::uniform(800.0, 1200.0, 50.0)?;
/// let object = EnvironmentObject { temperature_k: 293.15, emissivity: None };
/// let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object])?;
/// let (skin, fabric) = (vec![0.95; bands.len()], vec![0.88; bands.len()]);
/// let state = surroundings.state(310.15, &[0.5])?;
/// let unknowns = Unknowns::new([Nuisance::Temperature])?;
/// let pair = Pair { emissivity: &skin, alternative: &fabric, state: &state };
/// let noise = Noise::PerPhoton { photons: f64::INFINITY };
/// let exact = LocalReference::new(&bands, &surroundings, unknowns).answer(pair, noise, &[]);
/// assert!(exact.distance < exact.distance_no_nuisance);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct LocalReference<'a> {
    spectra: Spectra<'a>,
    unknowns: Unknowns,
}

impl<'a> LocalReference<'a> {
    /// References for one set of bands, surroundings and unknowns.
    #[must_use]
    pub fn new(bands: &'a Bands, surroundings: &'a Surroundings, unknowns: Unknowns) -> Self {
        Self { spectra: Spectra::new(bands, surroundings), unknowns }
    }

    /// The signal S of each band, photons s⁻¹ m⁻² sr⁻¹.
    #[must_use]
    pub fn signal(&mut self, emissivity: &[f64], state: &State) -> Vec<Extended> {
        self.spectra.signal(emissivity, &state.into())
    }

    /// ∂S/∂θ of each band for one parameter, photons s⁻¹ m⁻² sr⁻¹ per unit of it; for the material, towards the alternative.
    #[must_use]
    pub fn derivative(&mut self, parameter: Parameter, pair: Pair<'_>) -> Vec<Extended> {
        let Pair { emissivity, alternative, state } = pair;
        let total_known = self.unknowns.known_lighting_total().is_some();
        self.spectra.column(parameter, emissivity, alternative, &state.into(), total_known)
    }

    /// The derivative along the material with every term of the contrast taken by its magnitude
    /// (as in [`LocalAnswer::terms`]).
    #[must_use]
    pub fn material_terms(&mut self, pair: Pair<'_>) -> Vec<Extended> {
        let Pair { emissivity, alternative, state } = pair;
        let state = ExtendedState::from(state);
        self.spectra.terms(emissivity, alternative, &state, &state)
    }

    /// The distance of a pair with the nuisances but those `left_out`; unlike the fast path it takes any pair, without
    /// errors.
    #[must_use]
    pub fn answer(&mut self, pair: Pair<'_>, noise: Noise<'_>, left_out: &[Parameter]) -> LocalAnswer {
        let Pair { emissivity, alternative, state } = pair;
        let state = ExtendedState::from(state);
        let total_known = self.unknowns.known_lighting_total().is_some();
        let mut parameters = self.unknowns.parameters(self.spectra.surroundings.objects().len());
        parameters.push(Parameter::Material);
        let signal = self.spectra.signal(emissivity, &state);
        let photon_radiance: Extended = signal.iter().cloned().sum();
        let mut weights = weights(&signal, &photon_radiance, noise);
        let mut columns: Vec<Vec<Extended>> = parameters
            .iter()
            .map(|&parameter| self.spectra.column(parameter, emissivity, alternative, &state, total_known))
            .collect();
        let per_prior = match noise {
            Noise::PerPhoton { photons } if !photons.is_finite() => None,
            Noise::PerPhoton { photons } => Some(Extended::from(photons).sqrt()),
            Noise::Counting(_) => Some(Extended::one()),
        };
        for (owner, parameter) in parameters.iter().enumerate() {
            let (Some(sigma), Some(per_prior)) = (self.unknowns.sigma_prior(*parameter), &per_prior) else {
                continue;
            };
            weights.push(Extended::one());
            for (i, column) in columns.iter_mut().enumerate() {
                let own = Extended::one() / (Extended::from(sigma) * per_prior);
                column.push(if i == owner { own } else { Extended::zero() });
            }
        }
        let terms = self.spectra.terms(emissivity, alternative, &state, &state);
        let terms = inner(&terms, &terms, &weights).sqrt();
        self.spectra.forget();
        // Of bands that count; never 0 where it is not, so that what no double holds is known to be there.
        let size = |value: &Extended| match value.abs().to_f64() {
            0.0 if !value.is_zero() => f64::MIN_POSITIVE,
            size => size,
        };
        let counts = |column: &[Extended]| -> f64 {
            let known = column.iter().zip(&weights).filter(|(_, weight)| weight.is_positive());
            known.map(|(value, _)| size(value)).fold(0.0, f64::max)
        };
        let largest: Vec<f64> = columns.iter().map(|column| counts(column)).collect();
        let projected = project(columns, &weights, |i| left_out.contains(&parameters[i]));
        let half = Extended::from(0.5);
        let of = |indices: Vec<usize>| indices.into_iter().map(|i| parameters[i]).collect();
        LocalAnswer {
            distance: &half * projected.residual,
            distance_no_nuisance: &half * projected.norm,
            photon_radiance,
            shares: parameters
                .iter()
                .zip(projected.shares)
                .zip(largest)
                .map(|((&parameter, left), largest)| Share { parameter, left, largest })
                .collect(),
            dropped: of(projected.dropped),
            terms: &half * terms,
            carried: half * projected.carried,
        }
    }
}

/// u of each band.
fn weights(signal: &[Extended], total: &Extended, noise: Noise<'_>) -> Vec<Extended> {
    let weight = |(band, signal): (usize, &Extended)| {
        let (square, variance) = match noise {
            Noise::PerPhoton { .. } => (Extended::one(), signal * total),
            Noise::Counting(counting) => {
                let counts = Extended::from(counting.counts_per_radiance);
                let var = Extended::from(counting.var_added(band));
                (counts.square(), counts * signal + var)
            }
        };
        if variance.is_positive() { square / variance } else { Extended::zero() }
    };
    signal.iter().enumerate().map(weight).collect()
}

/// What Gram and Schmidt find.
struct Projected {
    residual: Extended,
    norm: Extended,
    carried: Extended,
    shares: Vec<f64>,
    dropped: Vec<usize>,
}

fn inner(a: &[Extended], b: &[Extended], weights: &[Extended]) -> Extended {
    a.iter().zip(b).zip(weights).map(|((a, b), weight)| a * b * weight).sum()
}

/// Takes every column off those after it; the last is what is asked for.
fn project(
    mut columns: Vec<Vec<Extended>>,
    weights: &[Extended],
    left_out: impl Fn(usize) -> bool,
) -> Projected {
    let count = columns.len();
    let last = count - 1;
    let lengths: Vec<Extended> = columns.iter().map(|column| inner(column, column, weights)).collect();
    let mut triangle = vec![vec![Extended::zero(); count]; count];
    let (mut shares, mut dropped) = (Vec::new(), Vec::new());
    let sizes: Vec<Extended> = lengths.iter().map(Extended::sqrt).collect();
    for pivot in 0..last {
        let square = inner(&columns[pivot], &columns[pivot], weights);
        let made_of = &sizes[pivot] + carried(&triangle, &sizes, pivot, &dropped);
        let share = if sizes[pivot].is_zero() { 0.0 } else { (square.sqrt() / made_of).to_f64() };
        shares.push(if share < EXACTLY_DEPENDENT { 0.0 } else { share });
        if left_out(pivot) || share < EXACTLY_DEPENDENT {
            dropped.push(pivot);
            continue;
        }
        let (before, after) = columns.split_at_mut(pivot + 1);
        let own = &before[pivot];
        for (i, column) in after.iter_mut().enumerate() {
            let share = inner(own, column, weights) / &square;
            for (value, own) in column.iter_mut().zip(own) {
                *value = &*value - &share * own;
            }
            triangle[pivot][pivot + 1 + i] = share;
        }
    }
    let norm = lengths[last].sqrt();
    let left = inner(&columns[last], &columns[last], weights).sqrt();
    // What 512 bits leave of a column that lies in the span of the others.
    let nothing = left <= &norm * Extended::from(EXACTLY_DEPENDENT);
    let carried = carried(&triangle, &sizes, last, &dropped);
    Projected { residual: if nothing { Extended::zero() } else { left }, norm, carried, shares, dropped }
}

/// Σ|cⱼ|‖aⱼ‖ of the coefficients of a column on those before it, from the unit upper triangle.
fn carried(triangle: &[Vec<Extended>], sizes: &[Extended], column: usize, dropped: &[usize]) -> Extended {
    let mut coefficients = vec![Extended::zero(); column];
    for row in (0..column).rev().filter(|row| !dropped.contains(row)) {
        let known: Extended = (row + 1..column).map(|i| &triangle[row][i] * &coefficients[i]).sum();
        coefficients[row] = &triangle[row][column] - known;
    }
    coefficients.iter().zip(sizes).map(|(c, size)| c.abs() * size).sum()
}

#[cfg(test)]
mod tests;
