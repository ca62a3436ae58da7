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

mod kernels;
mod radiances;
mod rounding;
mod sampling;

use self::kernels::{
    LightObject, LightSpectra, OneObject, add_darkness, add_object, inverse_into, largest_by_one,
    light_by_one, mixing_into, product_into, scale_by, scattered_into, signal_and_mixing_by_one, signal_into,
};
use self::sampling::Sampling;
use super::{State, Surroundings, unlit};
use crate::aligned::{Aligned, spaced};
use crate::planck;
use crate::simd::largest;
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
    signal: Aligned,
    /// 1/S of each band, where it was formed on the way.
    inverse: Aligned,
    inverse_known: bool,
    columns: Aligned,
    stride: usize,
    cancellation: f64,
    /// The target and environment temperatures that the spectra below belong to.
    temperature_k: f64,
    environment_k: Vec<f64>,
    /// B(T) and ∂B/∂T at the nodes.
    value: Aligned,
    slope: Aligned,
    /// B(Tₖ) and B(T) − B(Tₖ) at the nodes, object by object.
    base: Aligned,
    difference: Aligned,
    /// The contrast C, the lighting ΣVₖεₖB(Tₖ) and scratch.
    contrast: Aligned,
    lit: Aligned,
    scratch: Aligned,
    column: Aligned,
    sampling: Sampling,
}

/// Σ|terms| ÷ |sum|, and 1 where there is nothing.
fn ratio(terms: f64, sum: f64) -> f64 {
    if sum > 0.0 { terms / sum } else { 1.0 }
}

/// Columns to be worked on in place, each beginning `stride` after the one before.
#[derive(Debug)]
pub(crate) struct Columns<'a> {
    pub(crate) values: &'a mut [f64],
    pub(crate) stride: usize,
}

/// Where the spectrum stands that the surface scatters.
#[derive(Debug, Clone, Copy)]
enum Incident {
    /// The blackbody radiance of object k.
    Blackbody(usize),
    /// The scratch spectrum.
    Scratch,
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
            signal: Aligned::zeros(bands.len()),
            inverse: Aligned::zeros(bands.len()),
            inverse_known: false,
            columns: Aligned::default(),
            stride: spaced(bands.len()),
            cancellation: 1.0,
            temperature_k: f64::NAN,
            environment_k: vec![f64::NAN; objects],
            value: Aligned::zeros(nodes),
            slope: Aligned::zeros(nodes),
            base: Aligned::zeros(nodes * objects),
            difference: Aligned::zeros(nodes * objects),
            contrast: Aligned::zeros(nodes),
            lit: Aligned::zeros(nodes),
            scratch: Aligned::zeros(nodes),
            column: Aligned::zeros(nodes),
            sampling: Sampling::of(bands),
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
        self.columns
            .chunks(self.stride)
            .nth(i)
            .and_then(|column| column.get(..self.bands.len()))
            .unwrap_or_default()
    }

    /// All columns, each beginning `stride` after the one before, to be worked on in place: the next
    /// evaluation writes them anew.
    pub(crate) fn columns_mut(&mut self) -> Columns<'_> {
        Columns { values: &mut self.columns, stride: self.stride }
    }

    /// [`Jacobian::columns_mut`], and 1/S of each band (0 where S is 0).
    pub(crate) fn columns_and_inverse(&mut self) -> (Columns<'_>, &[f64]) {
        if !self.inverse_known {
            inverse_into(&self.signal, &mut self.inverse);
            self.inverse_known = true;
        }
        (Columns { values: &mut self.columns, stride: self.stride }, &self.inverse)
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

    /// ∂B/∂T at the nodes, of the last evaluation.
    pub(crate) fn radiance_slope(&self) -> &[f64] {
        &self.slope
    }

    /// The contrast C at the nodes, of the last evaluation that had no `Parameter::Material`.
    pub(crate) fn contrast(&self) -> &[f64] {
        &self.contrast
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
        crate::stop::check();
        self.begin(parameters);
        self.update_radiances(state);
        let mut parameters = parameters;
        match (self.one_black_object(state), parameters.split_last()) {
            (Some(factor), Some((Parameter::Material, others))) if self.sampling != Sampling::Integrated => {
                parameters = others;
                self.signal_and_mixing(emissivity, alternative, factor, state);
            }
            _ => {
                self.light(state);
                self.see(emissivity, state.gain);
            }
        }
        self.differentiate(emissivity, alternative, state, parameters, lighting_total_known);
    }

    /// What every evaluation begins with.
    fn begin(&mut self, parameters: &[Parameter]) {
        self.parameters.clear();
        self.parameters.extend_from_slice(parameters);
        self.columns.set_len(self.stride * parameters.len());
        self.inverse_known = false;
    }

    /// The signal, from radiance and lighting.
    fn see(&mut self, emissivity: &[f64], gain: f64) {
        self.sampling.sample(self.bands, &mut self.column, &mut self.signal, |out| {
            signal_into(emissivity, &self.value, &self.lit, gain, out);
        });
    }

    /// The first columns, one for each of `parameters`.
    fn differentiate(
        &mut self,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
        parameters: &[Parameter],
        lighting_total_known: bool,
    ) {
        let (bands, sampling, gain) = (self.bands, self.sampling, state.gain);
        for (i, parameter) in parameters.iter().enumerate() {
            let incident = match *parameter {
                Parameter::Lighting(k) => self.lighting(state, k, lighting_total_known),
                Parameter::EnvironmentTemperature(k) => self.environment_slope(state, k),
                Parameter::Temperature | Parameter::Gain | Parameter::Material => Incident::Scratch,
            };
            let incident = match incident {
                Incident::Blackbody(k) => &self.base[k * self.value.len()..(k + 1) * self.value.len()],
                Incident::Scratch => &self.scratch,
            };
            let Some(out) = self.columns.chunks_mut(self.stride).nth(i) else { continue };
            let out = &mut out[..bands.len()];
            if *parameter == Parameter::Gain {
                out.copy_from_slice(&self.signal);
                continue;
            }
            sampling.sample(bands, &mut self.column, out, |out| match *parameter {
                Parameter::Temperature => product_into(emissivity, &self.slope, gain, out),
                Parameter::Gain => {}
                Parameter::Material => mixing_into(emissivity, alternative, &self.contrast, gain, out),
                Parameter::Lighting(_) => scattered_into(emissivity, incident, gain, out),
                Parameter::EnvironmentTemperature(k) => {
                    scattered_into(emissivity, incident, gain * state.lighting[k], out);
                }
            });
        }
    }

    /// The lighting factor, where there is a single object that is black.
    fn one_black_object(&self, state: &State) -> Option<f64> {
        match (self.surroundings.objects.as_slice(), state.lighting.as_slice()) {
            ([object], [factor]) if object.emissivity.is_none() => Some(*factor),
            _ => None,
        }
    }

    /// Signal and the last column, ∂S/∂g, in one pass that leaves lighting and contrast as they were.
    fn signal_and_mixing(&mut self, emissivity: &[f64], alternative: &[f64], factor: f64, state: &State) {
        let rest = unlit(&state.lighting);
        let start = self.columns.len() - self.stride;
        let mixing = &mut self.columns[start..start + self.bands.len()];
        signal_and_mixing_by_one(OneObject {
            factor,
            rest,
            gain: state.gain,
            value: &self.value,
            base: &self.base,
            difference: &self.difference,
            emissivity,
            alternative,
            signal: &mut self.signal,
            mixing: &mut *mixing,
            inverse: &mut self.inverse,
        });
        self.inverse_known = self.sampling == Sampling::Unit;
        if self.sampling == Sampling::Scaled {
            scale_by(self.bands.weights_cm1(), &mut self.signal);
            scale_by(self.bands.weights_cm1(), mixing);
        }
        self.cancellation = self.cancellation_by_one(factor, rest, state);
    }

    /// The contrast C and the lighting ΣVₖεₖB(Tₖ).
    fn light(&mut self, state: &State) {
        let nodes = self.value.len();
        let rest = unlit(&state.lighting);
        let black = self.surroundings.objects.iter().all(|object| object.emissivity.is_none());
        if let ([factor], true) = (state.lighting.as_slice(), black) {
            light_by_one(*factor, rest, self.light_spectra());
            self.cancellation = self.cancellation_by_one(*factor, rest, state);
            return;
        }
        let (dark, terms) = (&mut self.scratch, &mut self.column);
        dark.fill(rest);
        for zero in [&mut self.lit, &mut self.contrast, &mut *terms] {
            zero.fill(0.0);
        }
        for (k, factor) in state.lighting.iter().enumerate() {
            let span = k * nodes..(k + 1) * nodes;
            add_object(LightObject {
                factor: *factor,
                emissivity: self.surroundings.objects[k].emissivity.as_deref(),
                base: &self.base[span.clone()],
                difference: &self.difference[span],
                lit: &mut self.lit,
                contrast: &mut self.contrast,
                terms,
                dark,
            });
        }
        add_darkness(dark, &self.value, terms, &mut self.contrast);
        self.cancellation = ratio(largest(terms), largest(&self.contrast));
    }

    /// How far the terms of the contrast of a single black object cancel: not at all unless it is warmer
    /// than the target.
    fn cancellation_by_one(&self, factor: f64, rest: f64, state: &State) -> f64 {
        if state.environment_k.first().is_none_or(|&base_k| base_k <= state.temperature_k) {
            return 1.0;
        }
        let (term, sum) = largest_by_one(factor, rest, &self.difference, &self.value);
        ratio(term, sum)
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

    /// εₖB(Tₖ), or its difference from the last object's.
    fn lighting(&mut self, state: &State, k: usize, total_known: bool) -> Incident {
        let nodes = self.value.len();
        let objects = &self.surroundings.objects;
        let last = objects.len() - 1;
        let own = objects[k].emissivity.as_deref();
        if !total_known || k == last {
            let Some(own) = own else { return Incident::Blackbody(k) };
            product_into(own, &self.base[k * nodes..(k + 1) * nodes], 1.0, &mut self.scratch);
            return Incident::Scratch;
        }
        let nu = &self.surroundings.nodes_cm1;
        let base = &self.base[last * nodes..];
        let (t, last_k) = (state.environment_k[k], state.environment_k[last]);
        planck::photon_radiance_apart_into(nu, (last_k, base), t, &mut self.column);
        // εₖ[B(Tₖ) − B(T_K)] + (εₖ − ε_K)B(T_K), or where the two differ much, as they stand: the parts must not cancel.
        let other = objects[last].emissivity.as_deref();
        let own_base = &self.base[k * nodes..(k + 1) * nodes];
        for (j, (out, difference)) in self.scratch.iter_mut().zip(self.column.iter()).enumerate() {
            let at = |emissivity: Option<&[f64]>| emissivity.map_or(1.0, |e| e[j]);
            let (own, other) = (at(own), at(other));
            *out = if difference.abs() <= 0.5 * base[j] {
                own * difference + (own - other) * base[j]
            } else {
                own * own_base[j] - other * base[j]
            };
        }
        Incident::Scratch
    }

    /// εₖ ∂B/∂T(Tₖ).
    fn environment_slope(&mut self, state: &State, k: usize) -> Incident {
        let (nu, t) = (&self.surroundings.nodes_cm1, state.environment_k[k]);
        planck::photon_radiance_and_slope_into(nu, t, &mut self.column, &mut self.scratch);
        if let Some(emissivity) = &self.surroundings.objects[k].emissivity {
            scale_by(emissivity, &mut self.scratch);
        }
        Incident::Scratch
    }
}
