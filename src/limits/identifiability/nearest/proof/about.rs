//! The best state as a minimum in the bands, or in groups of them, and the widest box about it that can be closed ([`super::closing`]).

use super::bound::Mixture;
use super::closing::{Minimum, Reach, close};
use super::groups::{neighbours_summed, products_summed};
use super::priors::PriorAt;
use super::prover::{Goal, Prover, temperature_of};
use super::sources::Spectrum;
use super::vectors::{Weights, differences_into, pulls_into, weights_into};
use super::view::View;
use crate::aligned::Aligned;
use crate::identifiability::nearest::blackbodies::rounded;
use crate::identifiability::nearest::residual::{Comparison, Target};
use crate::scene::State;
use crate::sum::dot;

/// Half widths of the closed box that are tried, as shares of T/max(x, 2) in the middle of the bands.
const WIDTHS: [f64; 9] = [0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3, 1e-4, 1e-5, 1e-6];

/// What has come of closing a box about the best state.
pub(super) enum Closed {
    /// A lower bound of d² in it, and its faces.
    Box(f64, Vec<[f64; 2]>),
    /// A nearer state.
    Nearer(State),
    /// No box can be closed.
    Nothing,
}

impl Minimum {
    /// The same minimum with so many neighbouring bands counted as one, as a view has them; none where bands were left out, of which their
    /// sums would know.
    pub(super) fn counted_together(&self, view: &View<'_>, count: usize) -> Option<Self> {
        crate::stop::check();
        let bands = view.sources.bands.len();
        let [root, other, pull] = [&self.root, &self.other, &self.pull].map(|x| &x[..bands]);
        let mut differences = Aligned::unset(bands);
        if !differences_into(pull, root, other, &mut differences) {
            return None;
        }
        let differences = neighbours_summed(&differences, count);
        let mut other = products_summed([other; 2], count);
        other.iter_mut().for_each(|s| *s = s.sqrt());
        let over = |a: f64, b: f64| if b > 0.0 { a / b } else { 0.0 };
        let pairs = differences.iter().zip(view.root.iter().zip(other.iter()));
        let residual = Aligned::filled(other.len(), pairs.map(|(d, (y, s))| over(*d, y + s)));
        let pull = residual.iter().zip(other.iter()).map(|(r, s)| over(-r, *s));
        let pull = Aligned::filled(other.len(), pull);
        let of_priors: f64 = self.priors.iter().map(|prior| prior.residual * prior.residual).sum();
        let mut weight = Aligned::unset(other.len());
        let (reach, root) = (self.reach, &view.root);
        weights_into(Weights { root, other: &other, reach, most: None, weight: &mut weight });
        Some(Self {
            amplitudes: self.amplitudes.clone(),
            spectra: self.spectra.iter().map(|own| view.sources.summed(own, count)).collect(),
            pull,
            root: root.clone(),
            other,
            weight,
            priors: self.priors.clone(),
            reach,
            cost: dot(&residual, &residual) + of_priors,
        })
    }
}

impl Prover<'_, '_> {
    /// The best state as a minimum in the bands.
    pub(super) fn minimum(
        &self,
        comparison: &mut Comparison<'_>,
        target: &Target<'_>,
        state: &State,
    ) -> Minimum {
        crate::stop::check();
        let (residual, other) = comparison.residual(target, state);
        let count = self.all.sources.list.len();
        let gain = if self.all.allowed.gain_free { state.gain } else { 1.0 };
        let amplitudes: Vec<f64> =
            (0..count).map(|s| if s == 0 { gain } else { gain * state.lighting[s - 1] }).collect();
        let own = self.all.sources.of(0, state.temperature_k, comparison.radiances());
        let others = (1..count).map(|s| self.all.spectrum(s, temperature_of(state, s)));
        let spectra: Vec<Spectrum> = std::iter::once(own).chain(others).collect();
        let bands = self.all.root.len();
        let [mut pull, mut seen, mut kept] = [(); 3].map(|()| Aligned::unset(bands));
        pulls_into(&residual, &other, &self.all.root, [&mut pull, &mut seen, &mut kept]);
        let priors: Vec<PriorAt> = self.all.priors.at(state).collect();
        let of_priors: f64 = priors.iter().map(|prior| prior.residual * prior.residual).sum();
        let (cost, root, reach) = (dot(&kept, &kept) + of_priors, self.all.root.clone(), self.all.reach);
        let mut weight = Aligned::unset(bands);
        weights_into(Weights { root: &root, other: &seen, reach, most: None, weight: &mut weight });
        Minimum { amplitudes, spectra, pull, root, other: seen, weight, priors, reach, cost }
    }

    /// Closes the widest box about the best state that can be: its bound, where it is least, and its faces.
    pub(super) fn close_about(
        &mut self,
        comparison: &mut Comparison<'_>,
        target: &Target<'_>,
        minimum: &Minimum,
        goal: Goal,
    ) -> Closed {
        crate::stop::check();
        let Minimum { amplitudes, spectra, cost, .. } = minimum;
        let temperature_k: Vec<f64> = spectra.iter().map(|spectrum| spectrum.temperature_k).collect();
        let (count, cost, enough) = (spectra.len(), *cost, goal.enough);
        let nu = self.all.sources.range_cm1;
        // Beside one unknown temperature the intervals that follow are cheaper than a second attempt.
        let skipped = usize::from(self.all.axes.len() == 1);
        for width in &WIDTHS[skipped..] {
            let reach: Vec<Option<Reach>> = (0..count)
                .map(|s| {
                    let [low, high] = self.all.sources.list[s].temperature_k;
                    let t = temperature_k[s];
                    let x = crate::units::SECOND_RADIATION_CM_K * 0.5 * (nu.0 + nu.1) / t;
                    let half = width * t / x.max(2.0);
                    let least = if self.all.held(s).is_some() { amplitudes[s] } else { 0.25 * amplitudes[s] };
                    let [cold, hot] = [t - half, t + half].map(|face| rounded(face, t));
                    let faces = [cold.max(low).min(t), hot.min(high).max(t)];
                    let (down_k, up_k) = (t - faces[0], faces[1] - t);
                    self.all.sources.list[s].free().then_some(Reach { faces, down_k, up_k, least })
                })
                .collect();
            let Some(closed) = close(&self.all.sources, minimum, &reach, &self.all.allowed, enough) else {
                continue;
            };
            if closed.lower.is_nan() {
                continue;
            }
            let lower = closed.lower.min(cost);
            let mixture = Mixture { amplitudes: closed.amplitudes, temperature_k: closed.temperature_k };
            let faces: Vec<[f64; 2]> = self.all.axes.iter().filter_map(|&s| Some(reach[s]?.faces)).collect();
            if lower >= enough && self.dim_ones_are_farther(&faces, amplitudes, enough) {
                return Closed::Box(lower, faces);
            }
            if let Some(state) = self.nearer(comparison, target, goal.limit, &mixture) {
                return Closed::Nearer(state);
            }
            if self.all.axes.is_empty() {
                return Closed::Box(lower, faces);
            }
        }
        Closed::Nothing
    }

    /// Whether no state in a box is nearer in which a source of unknown temperature and amplitude has less than half its share:
    /// what the closed box leaves out.
    fn dim_ones_are_farther(&mut self, faces: &[[f64; 2]], amplitudes: &[f64], enough: f64) -> bool {
        let free: Vec<usize> =
            self.all.axes.iter().copied().filter(|&s| self.all.held(s).is_none()).collect();
        if free.is_empty() {
            return true;
        }
        let ends: Vec<[usize; 2]> = faces
            .iter()
            .enumerate()
            .map(|(axis, face)| [self.end(axis, face[0]), self.end(axis, face[1])])
            .collect();
        free.into_iter().chain(self.all.allowed.gain_free.then_some(0)).all(|s| {
            let mut allowed = self.all.allowed.clone();
            match s.checked_sub(1) {
                None => allowed.gain_cap = 0.5 * amplitudes[0],
                Some(k) => {
                    let share = 0.5 * amplitudes[s] / amplitudes[0];
                    if share <= allowed.ranges[k][0] {
                        // None is so dim.
                        return true;
                    }
                    allowed.ranges[k][1] = share;
                }
            }
            self.bound(&ends, Some(&allowed), enough).lower >= enough
        })
    }
}
