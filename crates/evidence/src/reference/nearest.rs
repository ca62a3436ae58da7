//! Separation of two states in extended precision, and the nearest state of the alternative from given starts.
//!
//! d² = Σ_w (√(κS + σ²) − √(κS′ + σ²))² + Σ ((θ′ − θ)/(2σ_p))², plain square roots and differences: S the signal of the
//! target in its state, S′ that of the alternative in another, κ counts per unit of signal (1/ΣS per √photon), σ²
//! electronic noise, σ_p priors.
//!
//! [`NearestReference::nearest_from`] follows Newton's method downhill within the range (`refine`). It is no search: it
//! tells how deep the valley is in which a start lies.

mod refine;

use super::Extended;
use super::local::{ExtendedState, Noise, Pair, Spectra};
use hadar::fisher::Unknowns;
use hadar::identifiability::nearest::StateRange;
use hadar::scene::{Parameter, State, Surroundings};
use hadar::spectrum::Bands;

/// How far apart two states are.
#[derive(Debug, Clone)]
pub struct Separation {
    /// Half the separation in units of the noise.
    pub distance: Extended,
    /// The same with every term of S − S′ = (e − e′)C + e′[B(T) − B(T′)] + (1 − e′)Σ(…) taken by its magnitude: what
    /// cancels in the distance. A few units in the last place of this are what doubles can do.
    pub terms: Extended,
}

/// Separations in extended precision, in fixed bands, surroundings, unknowns and range.
#[derive(Debug, Clone)]
pub struct NearestReference<'a> {
    spectra: Spectra<'a>,
    unknowns: Unknowns,
    range: StateRange,
    parameters: Vec<Parameter>,
}

/// The target with everything about it that candidates are compared with.
struct Target<'t> {
    pair: Pair<'t>,
    noise: Noise<'t>,
    state: ExtendedState,
    signal: Vec<Extended>,
    /// κ.
    counts: Extended,
    /// √(κS + σ²).
    roots: Vec<Extended>,
}

impl Target<'_> {
    fn var(&self, band: usize) -> Extended {
        match self.noise {
            Noise::PerPhoton { .. } => Extended::zero(),
            Noise::Counting(counting) => Extended::from(counting.var_added(band)),
        }
    }

    /// 1/(2σ_p), or 0 where there is no prior.
    fn prior_weight(&self, unknowns: &Unknowns, parameter: Parameter) -> Extended {
        let Some(sigma) = unknowns.sigma_prior(parameter) else { return Extended::zero() };
        let weight = Extended::from(0.5) / Extended::from(sigma);
        match self.noise {
            Noise::PerPhoton { photons } if photons.is_infinite() => Extended::zero(),
            Noise::PerPhoton { photons } => weight / Extended::from(photons).sqrt(),
            Noise::Counting(_) => weight,
        }
    }
}

/// The coordinate of a state that a parameter is.
fn coordinate(state: &ExtendedState, parameter: Parameter) -> Extended {
    match parameter {
        Parameter::Temperature => state.temperature.clone(),
        Parameter::Lighting(k) => state.lighting[k].clone(),
        Parameter::Gain => state.gain.ln(),
        Parameter::EnvironmentTemperature(k) => state.environment[k].clone(),
        Parameter::Material => Extended::zero(),
    }
}

impl<'a> NearestReference<'a> {
    /// References for one set of bands, surroundings, unknowns and range of the alternative's state.
    #[must_use]
    pub fn new(
        bands: &'a Bands,
        surroundings: &'a Surroundings,
        unknowns: Unknowns,
        range: StateRange,
    ) -> Self {
        let parameters = unknowns.parameters(surroundings.objects().len());
        Self { spectra: Spectra::new(bands, surroundings), unknowns, range, parameters }
    }

    /// How far the alternative in the state `other` is from the target in its own.
    #[must_use]
    pub fn separation(&mut self, pair: Pair<'_>, other: &State, noise: Noise<'_>) -> Separation {
        let target = self.target(pair, noise);
        let other = ExtendedState::from(other);
        let distance = self.cost(&target, &other).sqrt();
        let terms = self.terms(&target, &other);
        self.spectra.forget();
        Separation { distance, terms }
    }

    /// The least distance of the valleys that `starts` lie in, and its state, rounded; nothing without starts.
    #[must_use]
    pub fn nearest_from(
        &mut self,
        pair: Pair<'_>,
        starts: &[State],
        noise: Noise<'_>,
    ) -> Option<(Extended, State)> {
        let target = self.target(pair, noise);
        let mut best: Option<(Extended, State)> = None;
        for start in starts {
            let found = self.refine(&target, start);
            if best.as_ref().is_none_or(|best| found.0 < best.0) {
                best = Some(found);
            }
        }
        self.spectra.forget();
        best
    }

    fn target<'t>(&mut self, pair: Pair<'t>, noise: Noise<'t>) -> Target<'t> {
        let state = ExtendedState::from(pair.state);
        let signal = self.spectra.signal(pair.emissivity, &state);
        let counts = match noise {
            Noise::PerPhoton { .. } => Extended::one() / signal.iter().cloned().sum::<Extended>(),
            Noise::Counting(counting) => Extended::from(counting.counts_per_radiance),
        };
        let mut target = Target { pair, noise, state, signal, counts, roots: Vec::new() };
        target.roots = roots(&target, &target.signal);
        target
    }

    /// d².
    fn cost(&mut self, target: &Target<'_>, state: &ExtendedState) -> Extended {
        let signal = self.spectra.signal(target.pair.alternative, state);
        let bands: Extended =
            roots(target, &signal).iter().zip(&target.roots).map(|(a, b)| (a - b).square()).sum();
        let priors = self.parameters.iter().map(|&parameter| {
            let weight = target.prior_weight(&self.unknowns, parameter);
            if weight.is_zero() {
                return weight;
            }
            (weight * (coordinate(state, parameter) - coordinate(&target.state, parameter))).square()
        });
        bands + priors.sum::<Extended>()
    }

    /// ½ ∂d²/∂θ of every parameter.
    fn gradient(&mut self, target: &Target<'_>, state: &ExtendedState) -> Vec<Extended> {
        let alternative = target.pair.alternative;
        let total_known = self.unknowns.known_lighting_total().is_some();
        let roots = roots(target, &self.spectra.signal(alternative, state));
        let half = Extended::from(0.5);
        let parameters = self.parameters.clone();
        let along = |&parameter: &Parameter| {
            let column = self.spectra.column(parameter, alternative, alternative, state, total_known);
            let band = |(w, slope): (usize, Extended)| {
                if roots[w].is_zero() {
                    return Extended::zero();
                }
                (&roots[w] - &target.roots[w]) * &half * &target.counts * slope / &roots[w]
            };
            let bands: Extended = column.into_iter().enumerate().map(band).sum();
            let weight = target.prior_weight(&self.unknowns, parameter);
            let change = coordinate(state, parameter) - coordinate(&target.state, parameter);
            bands + weight.square() * change
        };
        parameters.iter().map(along).collect()
    }

    /// [`Separation::terms`].
    fn terms(&mut self, target: &Target<'_>, state: &ExtendedState) -> Extended {
        let Pair { emissivity, alternative, .. } = target.pair;
        let other = self.spectra.signal(alternative, state);
        let sum = self.spectra.terms(emissivity, alternative, &target.state, state);
        let gain = (&state.gain - &target.state.gain).abs() / &state.gain;
        let roots = roots(target, &other);
        let band = |(w, terms): (usize, Extended)| {
            let together = &roots[w] + &target.roots[w];
            if together.is_zero() {
                return Extended::zero();
            }
            ((terms + &gain * &other[w]) * &target.counts / together).square()
        };
        sum.into_iter().enumerate().map(band).sum::<Extended>().sqrt()
    }
}

/// √(κS + σ²) of every band.
fn roots(target: &Target<'_>, signal: &[Extended]) -> Vec<Extended> {
    signal.iter().enumerate().map(|(w, signal)| (&target.counts * signal + target.var(w)).sqrt()).collect()
}

#[cfg(test)]
mod tests;
