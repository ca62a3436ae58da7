//! The blackbody radiances that a [`Jacobian`] is made of, and differences between those of two.

use super::kernels::{add_scaled, scaled_into};
use super::{Jacobian, Parameter, Sampling};
use crate::planck::{self, Beside, NearPair};
use crate::scene::State;

impl Jacobian<'_> {
    /// B(T), ∂B/∂T, B(Tₖ) and B(T) − B(Tₖ), where a temperature has changed.
    pub(super) fn update_radiances(&mut self, state: &State) {
        let t = state.temperature_k;
        if self.temperature_k == t && self.environment_k == state.environment_k {
            return;
        }
        let nu = &self.surroundings.nodes_cm1;
        let mut value_known = false;
        for (k, &base_k) in state.environment_k.iter().enumerate() {
            let span = k * nu.len()..(k + 1) * nu.len();
            let (base, difference) = (&mut self.base[span.clone()], &mut self.difference[span]);
            if planck::is_near_pair(nu, base_k, t) {
                let (value, slope) = (&mut self.value, &mut self.slope);
                planck::near_pair_into(nu, base_k, t, NearPair { base, value, slope, difference });
                value_known = true;
                continue;
            }
            if base_k == self.surroundings.objects[k].temperature_k {
                base.copy_from_slice(&self.surroundings.blackbody[k]);
            } else {
                planck::photon_radiance_into(nu, base_k, base);
            }
            planck::photon_radiance_apart_into(nu, (base_k, base), t, difference);
        }
        if !value_known {
            planck::photon_radiance_and_slope_into(nu, t, &mut self.value, &mut self.slope);
        }
        self.temperature_k = t;
        self.environment_k.copy_from_slice(&state.environment_k);
    }

    /// [`Jacobian::evaluate`] without the contrast, for a surface that is compared with `other`: B(T) of the other one
    /// less B(T′) of this one's `state`, exact to a few ulp, comes at no more than the cost of B(T′).
    pub(crate) fn evaluate_beside(
        &mut self,
        other: &Self,
        emissivity: &[f64],
        state: &State,
        parameters: &[Parameter],
        lighting_total_known: bool,
        difference: &mut [f64],
    ) {
        crate::stop::check();
        self.begin(parameters);
        let nu = &self.surroundings.nodes_cm1;
        let nodes = nu.len();
        if self.environment_k != state.environment_k {
            for (k, &base_k) in state.environment_k.iter().enumerate() {
                let base = &mut self.base[k * nodes..(k + 1) * nodes];
                if base_k == self.surroundings.objects[k].temperature_k {
                    base.copy_from_slice(&self.surroundings.blackbody[k]);
                } else {
                    planck::photon_radiance_into(nu, base_k, base);
                }
            }
            self.environment_k.copy_from_slice(&state.environment_k);
        }
        // The differences B(T) − B(Tₖ) stay as they were: an evaluation that needs them forms all anew.
        self.temperature_k = f64::NAN;
        let beside = Beside { value: &mut self.value, slope: &mut self.slope, difference };
        planck::beside_into(nu, (other.temperature_k, &other.value), state.temperature_k, beside);
        if self.surroundings.objects.is_empty() {
            self.lit.fill(0.0);
        }
        for (k, (object, factor)) in self.surroundings.objects.iter().zip(&state.lighting).enumerate() {
            let base = &self.base[k * nodes..(k + 1) * nodes];
            let put = if k == 0 { scaled_into } else { add_scaled };
            put(*factor, object.emissivity.as_deref(), base, &mut self.lit);
        }
        self.see(emissivity, state.gain);
        self.differentiate(emissivity, emissivity, state, parameters, lighting_total_known);
    }

    /// How spectra at the nodes become band signals.
    pub(crate) fn sampling(&self) -> Sampling {
        self.sampling
    }

    /// X − X′ at the nodes: the lighting of this one's last `state` less that of `other` in `other_state`,
    /// as Σ (Vₖ − Vₖ′)εₖB(Tₖ) + Vₖ′εₖ[B(Tₖ) − B(Tₖ′)] where the radiances are alike, which keeps its digits as the two become equal.
    pub(crate) fn lighting_difference_into(
        &self,
        state: &State,
        other: &Self,
        other_state: &State,
        out: &mut [f64],
    ) {
        self.lighting_apart_into(state, other, other_state, false, out);
    }

    /// The same with every term taken by its magnitude: what cancels in it.
    pub(crate) fn lighting_terms_into(
        &self,
        state: &State,
        other: &Self,
        other_state: &State,
        out: &mut [f64],
    ) {
        self.lighting_apart_into(state, other, other_state, true, out);
    }

    fn lighting_apart_into(
        &self,
        state: &State,
        other: &Self,
        other_state: &State,
        magnitudes: bool,
        out: &mut [f64],
    ) {
        let nodes = out.len();
        if self.surroundings.objects.is_empty() {
            out.fill(0.0);
        }
        for (k, object) in self.surroundings.objects.iter().enumerate() {
            let span = k * nodes..(k + 1) * nodes;
            let emissivity = object.emissivity.as_deref();
            let (factor, other_factor) = (state.lighting[k], other_state.lighting[k]);
            let change = factor - other_factor;
            let (t, other_k) = (state.environment_k[k], other_state.environment_k[k]);
            let base = &self.base[span.clone()];
            let put = if k == 0 { scaled_into } else { add_scaled };
            if t == other_k {
                put(if magnitudes { change.abs() } else { change }, emissivity, base, out);
                continue;
            }
            let nu = &self.surroundings.nodes_cm1;
            let other_base = &other.base[span];
            let mut apart = vec![0.0; nodes];
            planck::photon_radiance_apart_into(nu, (other_k, other_base), t, &mut apart);
            for (apart, (base, other)) in apart.iter_mut().zip(base.iter().zip(other_base)) {
                // Radiances of other orders are subtracted as they are: in the terms of their difference one would cancel.
                let near = (base - other).abs() <= 0.5 * base.max(*other);
                let [a, b] = if near {
                    [change * base, other_factor * *apart]
                } else {
                    [factor * base, -other_factor * other]
                };
                *apart = if magnitudes { a.abs() + b.abs() } else { a + b };
            }
            put(1.0, emissivity, &apart, out);
        }
    }
}
