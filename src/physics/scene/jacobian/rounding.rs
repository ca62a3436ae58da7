//! How far the terms of ∂S/∂g cancel, weighted as the distance is.
//!
//! C = Σₖ Vₖεₖ[B(T) − B(Tₖ)] + [1 − ΣVₖεₖ]B(T): every term is good to a few ulp, so that ∂S/∂g = G(e′ − e)C is off by a few
//! ulp of G|e′ − e|Σ|terms|. No term has another sign than the others unless an object is warmer than the target, or a band
//! has several nodes, over which e′ − e may change its sign.

use super::{Jacobian, Parameter, ratio};
use crate::scene::{State, unlit};

impl Jacobian<'_> {
    /// ‖G(e′ − e)Σ|terms|‖ ÷ ‖∂S/∂g‖ of the last evaluation, whose last column must be that of the material; `root` gives the
    /// square root of the weight of a band.
    pub(crate) fn material_cancellation(
        &self,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
        root: impl Fn(usize) -> f64,
    ) -> f64 {
        let Some(last) = self.parameters.len().checked_sub(1) else { return 1.0 };
        if self.terms_are_alike(state) && self.bands.one_node_per_band() {
            return 1.0;
        }
        let mut terms = self.contrast_terms(state);
        for (j, terms) in terms.iter_mut().enumerate() {
            *terms *= state.gain * (alternative[j] - emissivity[j]).abs();
        }
        self.cancelled(&terms, last, &root)
    }

    /// The most that ‖G(1 − e)Σ|terms|‖ is of ‖∂S/∂Vₖ‖, by object, of the last evaluation with the total of the lighting
    /// known: εₖB(Tₖ) − ε_K B(T_K) may cancel.
    pub(crate) fn lighting_cancellation(
        &self,
        emissivity: &[f64],
        state: &State,
        root: impl Fn(usize) -> f64,
    ) -> f64 {
        let (nodes, objects) = (self.value.len(), &self.surroundings.objects);
        let Some(last) = objects.len().checked_sub(1) else { return 1.0 };
        let of = |k: usize| {
            let own = objects[k].emissivity.as_deref();
            move |j: usize| (own.map_or(1.0, |own| own[j]), self.base[k * nodes + j])
        };
        let mut most = 1.0_f64;
        for (column, parameter) in self.parameters.iter().enumerate() {
            let Parameter::Lighting(k) = *parameter else { continue };
            if k == last {
                continue;
            }
            let (one, other) = (of(k), of(last));
            let terms = (0..nodes).map(|j| {
                let ((own, own_base), (other, base)) = (one(j), other(j));
                let difference = (own_base - base).abs();
                let terms = if difference <= 0.5 * base {
                    own * difference + (own - other).abs() * base
                } else {
                    own * own_base + other * base
                };
                state.gain * (1.0 - emissivity[j]) * terms
            });
            most = most.max(self.cancelled(&terms.collect::<Vec<_>>(), column, &root));
        }
        most
    }

    /// ‖terms‖ ÷ ‖column‖, both weighted.
    fn cancelled(&self, terms: &[f64], column: usize, root: &impl Fn(usize) -> f64) -> f64 {
        let banded = self.bands.weigh(terms);
        let scores = banded.iter().zip(self.column(column)).enumerate();
        let scores: Vec<(f64, f64)> = scores.map(|(w, (a, b))| (root(w) * a, root(w) * b)).collect();
        // Brought near 1, so that no square overflows.
        let size = scores.iter().fold(0.0_f64, |size, (terms, _)| size.max(*terms));
        let square = |x: f64| (x / size) * (x / size);
        let sums = scores.iter().fold((0.0, 0.0), |sums, (a, b)| (sums.0 + square(*a), sums.1 + square(*b)));
        if size > 0.0 { ratio(sums.0.sqrt(), sums.1.sqrt()).max(1.0) } else { 1.0 }
    }

    /// The largest Σ|terms| ÷ |C| of a node, of the last evaluation without `Parameter::Material`.
    pub(crate) fn contrast_cancellation(&self, state: &State) -> f64 {
        if self.terms_are_alike(state) {
            return 1.0;
        }
        let parts = self.contrast_terms(state).into_iter().zip(self.contrast.iter());
        parts.fold(
            1.0,
            |most, (terms, contrast)| if terms > 0.0 { most.max(terms / contrast.abs()) } else { most },
        )
    }

    /// Whether no term of the contrast has another sign than the others.
    fn terms_are_alike(&self, state: &State) -> bool {
        let warmer = |(base_k, factor): (&f64, &f64)| *base_k > state.temperature_k && *factor > 0.0;
        unlit(&state.lighting) >= 0.0 && !state.environment_k.iter().zip(&state.lighting).any(warmer)
    }

    /// Σ|terms| of the contrast at the nodes.
    fn contrast_terms(&self, state: &State) -> Vec<f64> {
        let nodes = self.value.len();
        let mut dark = vec![unlit(&state.lighting); nodes];
        let mut terms = vec![0.0; nodes];
        for (k, factor) in state.lighting.iter().enumerate() {
            let difference = &self.difference[k * nodes..(k + 1) * nodes];
            let own = self.surroundings.objects[k].emissivity.as_deref();
            for (j, (terms, dark)) in terms.iter_mut().zip(&mut dark).enumerate() {
                let e = own.map_or(1.0, |own| own[j]);
                *terms += (factor * e * difference[j]).abs();
                *dark += factor * (1.0 - e);
            }
        }
        for ((terms, dark), value) in terms.iter_mut().zip(dark).zip(self.value.iter()) {
            *terms += dark.abs() * value;
        }
        terms
    }
}
