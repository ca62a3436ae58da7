//! Where one descent starts: the minimum of the fitted cost downhill from the target's own temperature.
//!
//! Where one light is unknown beside T′, at most, the steps of the grid are walked in strides that double until the cost rises, and the
//! stretch between the last two is halved down to one step. The spectra of the steps are known from pair to pair. Between these two the
//! slope is taken to be straight. Nothing says that it is the nearest valley: that is left to the proof.

use super::between;
use super::fit::Fitted;
use super::table::{EmissionTable, step_at};
use super::whitened::Whitened;
use crate::fisher::Nuisance;
use crate::identifiability::nearest::residual::{Comparison, Target};
use crate::scene::{Parameter, State};

/// A step of the grid with the light fitted.
#[derive(Clone, Copy)]
struct Step {
    number: usize,
    temperature_k: f64,
    factor: f64,
    /// Half the derivative of the fitted cost along T′.
    slope: f64,
}

impl Step {
    /// Whether the cost falls towards colder or warmer steps, as asked.
    fn falls(&self, warmer: bool) -> bool {
        (self.slope < 0.0) == warmer
    }
}

impl Comparison<'_> {
    /// A state near that minimum; `None` if there is no such walk, or it comes to an end of the range.
    pub(in super::super) fn downhill(
        &mut self,
        table: &mut Option<EmissionTable>,
        target: &Target<'_>,
    ) -> Option<State> {
        crate::stop::check();
        let unknowns = &self.space.unknowns;
        let others = [Nuisance::Gain, Nuisance::EnvironmentTemperature].map(|other| unknowns.contains(other));
        let alone = unknowns.contains(Nuisance::Temperature) && others == [false; 2];
        if !alone || unknowns.known_lighting_total().is_some() {
            return None;
        }
        let own = self.space.within_range(target.state);
        let table = table.get_or_insert_with(|| EmissionTable::new(self.target.bands()));
        let whitened = Whitened::new(self, &table.thinned, target);
        let fit = self.fit(target, &table.thinned, &whitened, &own);
        let alone = fit.alone(&whitened, &own)?;
        let [square, centre] = self.thinned_prior(target, &table.thinned, Parameter::Temperature);
        let mut at = |number: usize| {
            let emission = table.banded(&whitened.emissivity, number);
            let (factor, Fitted { slope, .. }) = alone.at(emission);
            let temperature_k = emission.temperature_k;
            Step { number, temperature_k, factor, slope: slope + square * (temperature_k - centre) }
        };
        let [first, last] = self.space.range.temperature_k.map(step_at);
        let mut near = at(step_at(own.temperature_k));
        let warmer = near.slope < 0.0;
        let (mut stride, mut far) = (1, near);
        while far.falls(warmer) {
            near = far;
            let next = if warmer { near.number + stride } else { near.number.saturating_sub(stride) };
            let next = next.clamp(first, last.max(first));
            if next == near.number {
                return None;
            }
            (far, stride) = (at(next), 2 * stride);
        }
        while near.number.abs_diff(far.number) > 1 {
            let middle = at(near.number.midpoint(far.number));
            if middle.falls(warmer) {
                near = middle;
            } else {
                far = middle;
            }
        }
        let state = |step: &Step| {
            let mut state = State { temperature_k: step.temperature_k, ..own.clone() };
            if let Some(&k) = fit.lit.first() {
                state.lighting[k] = step.factor;
            }
            state
        };
        let share = near.slope / (near.slope - far.slope);
        share.is_finite().then(|| between(&state(&near), &state(&far), share))
    }
}
