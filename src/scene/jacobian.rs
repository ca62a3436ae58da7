//! Band signals and their analytic derivatives.
//!
//! With the material mixed as e(g) = (1 − g)e + g e′ (S30), at g = 0 and per node:
//!
//! * ∂S/∂T = G e ∂B/∂T                    ∂S/∂Vₖ = G (1 − e) εₖ B(Tₖ)
//! * ∂S/∂ln G = S                         ∂S/∂Tₖ = G (1 − e) Vₖ εₖ ∂B/∂T(Tₖ)
//! * ∂S/∂g = G (e′ − e) C,  C = B(T) − Σₖ Vₖ εₖ B(Tₖ)
//!
//! The contrast C is formed as Σₖ Vₖεₖ[B(T) − B(Tₖ)] + [1 − ΣVₖ + ΣVₖ(1 − εₖ)] B(T), whose brackets are
//! exact to a few ulp, so that nothing is lost as T → Tₖ and ΣV → 1. With a known total of the lighting
//! (S48) the last factor is the total minus the others, and ∂S/∂Vₖ = G(1 − e)[εₖB(Tₖ) − ε_K B(T_K)].

use super::{State, Surroundings, unlit};
use crate::planck::{self, NearPair};
use crate::simd::dispatched;
use crate::spectrum::Bands;

/// What a column of a [`Jacobian`] is the derivative with respect to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Parameter {
    /// Target temperature, K.
    Temperature,
    /// Lighting factor of environment object k.
    Lighting(usize),
    /// Natural logarithm of the overall gain.
    Gain,
    /// Temperature of environment object k, K.
    EnvironmentTemperature(usize),
    /// Fraction g of the alternative material.
    Material,
}

/// Band signals with their derivatives, column after column in the order of the parameters asked for.
///
/// Units: photons s⁻¹ m⁻² sr⁻¹ (integrated over each band), per unit of the parameter. Blackbody radiances
/// are kept between calls and computed anew only when a temperature changes.
#[derive(Debug, Clone)]
pub struct Jacobian<'a> {
    bands: &'a Bands,
    surroundings: &'a Surroundings,
    parameters: Vec<Parameter>,
    signal: Vec<f64>,
    columns: Vec<f64>,
    cancellation: f64,
    /// The target and environment temperatures that the spectra below belong to.
    temperature_k: f64,
    environment_k: Vec<f64>,
    /// B(T) and ∂B/∂T at the nodes.
    value: Vec<f64>,
    slope: Vec<f64>,
    /// B(Tₖ) and B(T) − B(Tₖ) at the nodes, object by object.
    base: Vec<f64>,
    difference: Vec<f64>,
    /// The contrast C, the lighting ΣVₖεₖB(Tₖ) and scratch.
    contrast: Vec<f64>,
    lit: Vec<f64>,
    scratch: Vec<f64>,
    column: Vec<f64>,
}

impl<'a> Jacobian<'a> {
    /// Workspace for surfaces seen in `bands` amid `surroundings`, which must be made of their nodes.
    #[must_use]
    pub fn new(bands: &'a Bands, surroundings: &'a Surroundings) -> Self {
        let nodes = surroundings.nodes_cm1.len();
        let objects = surroundings.objects.len();
        Self {
            bands,
            surroundings,
            parameters: Vec::new(),
            signal: vec![0.0; bands.len()],
            columns: Vec::new(),
            cancellation: 1.0,
            temperature_k: f64::NAN,
            environment_k: vec![f64::NAN; objects],
            value: vec![0.0; nodes],
            slope: vec![0.0; nodes],
            base: vec![0.0; nodes * objects],
            difference: vec![0.0; nodes * objects],
            contrast: vec![0.0; nodes],
            lit: vec![0.0; nodes],
            scratch: vec![0.0; nodes],
            column: vec![0.0; nodes],
        }
    }

    /// The bands it was made for.
    #[must_use]
    pub fn bands(&self) -> &'a Bands {
        self.bands
    }

    /// The surroundings it was made for.
    #[must_use]
    pub fn surroundings(&self) -> &'a Surroundings {
        self.surroundings
    }

    /// What each column is the derivative with respect to.
    #[must_use]
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// Signal of each band.
    #[must_use]
    pub fn signal(&self) -> &[f64] {
        &self.signal
    }

    /// Derivative with respect to parameter i; empty if there is none.
    #[must_use]
    pub fn column(&self, i: usize) -> &[f64] {
        self.columns.chunks(self.bands.len()).nth(i).unwrap_or_default()
    }

    /// All columns, one after the other.
    #[must_use]
    pub fn columns(&self) -> &[f64] {
        &self.columns
    }

    /// Factor by which rounding errors of ∂S/∂g may exceed a few ulp of it: 1 unless T < some Tₖ.
    #[must_use]
    pub fn cancellation(&self) -> f64 {
        self.cancellation
    }

    /// B(T) at the nodes, of the last evaluation.
    pub(crate) fn radiance(&self) -> &[f64] {
        &self.value
    }

    /// The contrast C at the nodes, of the last evaluation.
    pub(crate) fn contrast(&self) -> &[f64] {
        &self.contrast
    }

    /// X − X′ at the nodes: the lighting of this one's last `state` less that of `other` in `other_state`,
    /// as Σ (Vₖ − Vₖ′)εₖB(Tₖ) + Vₖ′εₖ[B(Tₖ) − B(Tₖ′)], which keeps its digits as the two become equal.
    pub(crate) fn lighting_difference_into(
        &self,
        state: &State,
        other: &Self,
        other_state: &State,
        out: &mut [f64],
    ) {
        let nodes = out.len();
        out.fill(0.0);
        for k in 0..state.lighting.len() {
            let span = k * nodes..(k + 1) * nodes;
            let change = state.lighting[k] - other_state.lighting[k];
            for (j, (out, base)) in out.iter_mut().zip(&self.base[span.clone()]).enumerate() {
                *out += change * self.surroundings.object_emissivity(k, j) * base;
            }
            let (t, other_k) = (state.environment_k[k], other_state.environment_k[k]);
            if t == other_k {
                continue;
            }
            let nu = &self.surroundings.nodes_cm1;
            let mut warmer = vec![0.0; nodes];
            planck::photon_radiance_difference_into(nu, other_k, t - other_k, &other.base[span], &mut warmer);
            for (j, (out, warmer)) in out.iter_mut().zip(&warmer).enumerate() {
                *out += other_state.lighting[k] * self.surroundings.object_emissivity(k, j) * warmer;
            }
        }
    }

    /// Evaluates signal and derivatives of a surface `emissivity` in `state`; `alternative` is the material
    /// that g mixes in. Emissivities are values at the nodes.
    ///
    /// With the total of the lighting known, `Parameter::Lighting(k)` moves object k against the last one.
    pub fn evaluate(
        &mut self,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
        parameters: &[Parameter],
        lighting_total_known: bool,
    ) {
        let bands = self.bands;
        self.parameters.clear();
        self.parameters.extend_from_slice(parameters);
        self.columns.resize(bands.len() * parameters.len(), 0.0);
        self.update_radiances(state);
        self.light(state);
        signal_into(emissivity, &self.value, &self.lit, state.gain, &mut self.column);
        bands.weigh_into(&self.column, &mut self.signal);
        for (i, parameter) in parameters.iter().enumerate() {
            let gain = state.gain;
            match *parameter {
                Parameter::Temperature => product_into(emissivity, &self.slope, gain, &mut self.column),
                Parameter::Gain => signal_into(emissivity, &self.value, &self.lit, gain, &mut self.column),
                Parameter::Material => {
                    mixing_into(emissivity, alternative, &self.contrast, gain, &mut self.column);
                }
                Parameter::Lighting(k) => {
                    self.lighting(state, k, lighting_total_known);
                    scattered_into(emissivity, &self.scratch, gain, &mut self.column);
                }
                Parameter::EnvironmentTemperature(k) => {
                    self.environment_slope(state, k);
                    scattered_into(emissivity, &self.scratch, gain * state.lighting[k], &mut self.column);
                }
            }
            if let Some(out) = self.columns.chunks_mut(bands.len()).nth(i) {
                bands.weigh_into(&self.column, out);
            }
        }
    }

    /// B(T), ∂B/∂T, B(Tₖ) and B(T) − B(Tₖ), where a temperature has changed.
    fn update_radiances(&mut self, state: &State) {
        let t = state.temperature_k;
        if self.temperature_k == t && self.environment_k == state.environment_k {
            return;
        }
        let nu = &self.surroundings.nodes_cm1;
        let mut value_known = false;
        for (k, &base_k) in state.environment_k.iter().enumerate() {
            let span = k * nu.len()..(k + 1) * nu.len();
            let (base, difference) = (&mut self.base[span.clone()], &mut self.difference[span]);
            if planck::is_near_pair(base_k, t) {
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
            planck::photon_radiance_difference_into(nu, base_k, t - base_k, base, difference);
        }
        if !value_known {
            planck::photon_radiance_and_slope_into(nu, t, &mut self.value, &mut self.slope);
        }
        self.temperature_k = t;
        self.environment_k.copy_from_slice(&state.environment_k);
    }

    /// The contrast C and the lighting ΣVₖεₖB(Tₖ).
    fn light(&mut self, state: &State) {
        let nodes = self.value.len();
        let rest = unlit(&state.lighting);
        self.cancellation = 1.0;
        let colder = state.environment_k.iter().any(|&base_k| base_k > state.temperature_k);
        let black = self.surroundings.objects.iter().all(|object| object.emissivity.is_none());
        if let ([factor], true, false) = (state.lighting.as_slice(), black, colder) {
            light_by_one(*factor, rest, self.light_spectra());
            return;
        }
        let (mut largest_term, mut largest_sum): (f64, f64) = (0.0, 0.0);
        for j in 0..nodes {
            let (mut lit, mut contrast, mut dark, mut terms) = (0.0, 0.0, rest, 0.0);
            for (k, factor) in state.lighting.iter().enumerate() {
                let e = self.surroundings.object_emissivity(k, j);
                lit += factor * e * self.base[k * nodes + j];
                contrast += factor * e * self.difference[k * nodes + j];
                terms += (factor * e * self.difference[k * nodes + j]).abs();
                dark += factor * (1.0 - e);
            }
            self.lit[j] = lit;
            self.contrast[j] = contrast + dark * self.value[j];
            largest_term = largest_term.max(terms + dark * self.value[j]);
            largest_sum = largest_sum.max(self.contrast[j].abs());
        }
        if largest_sum > 0.0 {
            self.cancellation = largest_term / largest_sum;
        }
    }

    fn light_spectra(&mut self) -> LightSpectra<'_> {
        LightSpectra {
            value: &self.value,
            base: &self.base,
            difference: &self.difference,
            lit: &mut self.lit,
            contrast: &mut self.contrast,
        }
    }

    /// εₖB(Tₖ), or its difference from the last object's, into the scratch spectrum.
    fn lighting(&mut self, state: &State, k: usize, total_known: bool) {
        let nodes = self.value.len();
        let last = state.lighting.len() - 1;
        let emissivity = |object, j| self.surroundings.object_emissivity(object, j);
        if !total_known || k == last {
            for (j, out) in self.scratch.iter_mut().enumerate() {
                *out = emissivity(k, j) * self.base[k * nodes + j];
            }
            return;
        }
        let nu = &self.surroundings.nodes_cm1;
        let base = &self.base[last * nodes..];
        let (t, last_k) = (state.environment_k[k], state.environment_k[last]);
        planck::photon_radiance_difference_into(nu, last_k, t - last_k, base, &mut self.column);
        for (j, out) in self.scratch.iter_mut().enumerate() {
            *out = emissivity(k, j) * self.column[j] + (emissivity(k, j) - emissivity(last, j)) * base[j];
        }
    }

    /// εₖ ∂B/∂T(Tₖ) into the scratch spectrum.
    fn environment_slope(&mut self, state: &State, k: usize) {
        let nu = &self.surroundings.nodes_cm1;
        planck::photon_radiance_and_slope_into(
            nu,
            state.environment_k[k],
            &mut self.column,
            &mut self.scratch,
        );
        for (j, out) in self.scratch.iter_mut().enumerate() {
            *out *= self.surroundings.object_emissivity(k, j);
        }
    }
}

/// Spectra that [`light_by_one`] reads and writes.
struct LightSpectra<'a> {
    value: &'a [f64],
    base: &'a [f64],
    difference: &'a [f64],
    lit: &'a mut [f64],
    contrast: &'a mut [f64],
}

dispatched! {
    /// Lighting and contrast for the common case of a single black object.
    fn light_by_one<'a>(factor: f64, rest: f64, spectra: LightSpectra<'a>) {
        let LightSpectra { value, base, difference, lit, contrast } = spectra;
        let nodes = lit.iter_mut().zip(contrast).zip(base).zip(difference).zip(value);
        for ((((lit, contrast), base), difference), value) in nodes {
            *lit = factor * base;
            *contrast = factor.mul_add(*difference, rest * value);
        }
    }
}

dispatched! {
    fn signal_into<'a>(emissivity: &'a [f64], value: &'a [f64], lit: &'a [f64], gain: f64, out: &'a mut [f64]) {
        for (((out, e), value), lit) in out.iter_mut().zip(emissivity).zip(value).zip(lit) {
            *out = gain * e.mul_add(*value, (1.0 - e) * lit);
        }
    }
}

dispatched! {
    fn product_into<'a>(a: &'a [f64], b: &'a [f64], factor: f64, out: &'a mut [f64]) {
        for ((out, a), b) in out.iter_mut().zip(a).zip(b) {
            *out = factor * (a * b);
        }
    }
}

dispatched! {
    fn scattered_into<'a>(emissivity: &'a [f64], incident: &'a [f64], factor: f64, out: &'a mut [f64]) {
        for ((out, e), incident) in out.iter_mut().zip(emissivity).zip(incident) {
            *out = factor * ((1.0 - e) * incident);
        }
    }
}

dispatched! {
    fn mixing_into<'a>(
        emissivity: &'a [f64],
        alternative: &'a [f64],
        contrast: &'a [f64],
        gain: f64,
        out: &'a mut [f64],
    ) {
        for (((out, e), other), contrast) in out.iter_mut().zip(emissivity).zip(alternative).zip(contrast) {
            *out = gain * ((other - e) * contrast);
        }
    }
}
