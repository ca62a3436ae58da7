//! The residual r = √(N + σ²) − √(N′ + σ²) of a candidate state, its gradient and second derivatives.
//!
//! With ρ = √(κS′ + σ²) and s = ∂r/∂S′ = −κ/(2ρ), half the cost has the second derivatives
//! Σ s²(1 + r/ρ) S′ᵢS′ⱼ + Σ r s S′ᵢⱼ. The first sum without r/ρ is the Gauss–Newton matrix; where temperature and
//! lighting of the alternative are nearly degenerate it alone converges slowly, so the rest is added:
//! S′_TT = G e′ B″ (`curvature`), and S′_gj = S′ⱼ for the logarithm g of the gain.
//! (Second derivatives along environment temperatures are left out.)

use super::{Metric, NearestSolver};
use crate::identifiability::curvature::{Curvature, curvature_into};
use crate::identifiability::space::{Quadratic, value};
use crate::planck;
use crate::scene::{Parameter, State};
use crate::simd::dispatched;
use crate::sum;
use nalgebra::{DMatrix, DVector};

/// The target as every candidate state is compared with it.
pub(super) struct Target<'t> {
    pub(super) emissivity: &'t [f64],
    pub(super) alternative: &'t [f64],
    pub(super) state: &'t State,
    /// Counts per unit of band signal.
    pub(super) counts: f64,
    pub(super) metric: Metric<'t>,
}

/// Cost ‖r‖², and half of it to second order, at a candidate state.
pub(super) struct Linearised {
    pub(super) cost: f64,
    pub(super) quadratic: Quadratic,
}

/// Spectra kept between calls so that none allocates.
#[derive(Debug, Clone)]
pub(super) struct Workspace {
    /// σ²_w of each band, and √(N + σ²) of the target.
    noise: Vec<f64>,
    root: Vec<f64>,
    /// S − S′ at the nodes and in the bands.
    node: Vec<f64>,
    separation: Vec<f64>,
    /// r and ∂r/∂S′ of each band.
    residual: Vec<f64>,
    slope: Vec<f64>,
    /// r ∂r/∂S′, and s² r/ρ.
    pull: Vec<f64>,
    bend: Vec<f64>,
    /// One column times ∂r/∂S′, and again, and times s² r/ρ.
    column: Vec<f64>,
    squared: Vec<f64>,
    bent: Vec<f64>,
    /// B(T) − B(T′) and X − X′ at the nodes.
    difference: Vec<f64>,
    lighting: Vec<f64>,
}

impl Workspace {
    pub(super) fn new(bands: usize, nodes: usize) -> Self {
        let (band, node) = (vec![0.0; bands], vec![0.0; nodes]);
        Self {
            noise: band.clone(),
            root: band.clone(),
            node: node.clone(),
            separation: band.clone(),
            residual: band.clone(),
            slope: band.clone(),
            pull: band.clone(),
            bend: band.clone(),
            column: band.clone(),
            squared: band.clone(),
            bent: band,
            difference: node.clone(),
            lighting: node,
        }
    }

    /// Noise and √(N + σ²) of the target, once per search.
    pub(super) fn weigh_target(&mut self, target: &Target<'_>, signal: &[f64]) {
        for (band, noise) in self.noise.iter_mut().enumerate() {
            *noise = match target.metric {
                Metric::PerPhoton { .. } => 0.0,
                Metric::Counting(counting) => counting.var_electronic(band),
            };
        }
        for ((root, signal), noise) in self.root.iter_mut().zip(signal).zip(&self.noise) {
            *root = (target.counts * signal + noise).sqrt();
        }
    }

    /// σ²_w of each band.
    pub(super) fn noise(&self) -> &[f64] {
        &self.noise
    }
}

impl NearestSolver<'_> {
    /// Cost, gradient and Gauss–Newton matrix at a state of the alternative.
    pub(super) fn linearise(&mut self, target: &Target<'_>, state: &State) -> Linearised {
        let total_known = self.space.unknowns.known_lighting_total().is_some();
        self.surface.evaluate(
            target.alternative,
            target.alternative,
            state,
            &self.space.parameters,
            total_known,
        );
        self.separate(target, state);
        let n = self.space.parameters.len();
        let work = &mut self.work;
        let mut cost = residuals(Residuals {
            counts: target.counts,
            signal: self.surface.signal(),
            noise: &work.noise,
            root: &work.root,
            separation: &work.separation,
            residual: &mut work.residual,
            slope: &mut work.slope,
            pull: &mut work.pull,
            bend: &mut work.bend,
        });
        let (mut gradient, mut gauss_newton, mut hessian) =
            (DVector::zeros(n), DMatrix::zeros(n, n), DMatrix::zeros(n, n));
        for i in 0..n {
            scale_twice(self.surface.column(i), &work.slope, &mut work.column, &mut work.squared);
            scale_by(self.surface.column(i), &work.bend, &mut work.bent);
            gradient[i] = dot(&work.column, &work.residual);
            for j in i..n {
                let column = self.surface.column(j);
                gauss_newton[(i, j)] = dot(&work.squared, column);
                gauss_newton[(j, i)] = gauss_newton[(i, j)];
                hessian[(i, j)] = gauss_newton[(i, j)] + dot(&work.bent, column);
                // ∂²S′/∂g∂θⱼ = ∂S′/∂θⱼ.
                if self.space.parameters[i] == Parameter::Gain || self.space.parameters[j] == Parameter::Gain
                {
                    let other = if self.space.parameters[i] == Parameter::Gain { j } else { i };
                    hessian[(i, j)] += dot(&work.pull, self.surface.column(other));
                }
                if i == j && self.space.parameters[i] == Parameter::Temperature {
                    curvature_into(Curvature {
                        nu: self.surface.surroundings().nodes_cm1(),
                        temperature_k: state.temperature_k,
                        gain: state.gain,
                        emissivity: target.alternative,
                        value: self.surface.radiance(),
                        slope: self.surface.radiance_slope(),
                        out: &mut work.node,
                    });
                    self.surface.bands().weigh_into(&work.node, &mut work.column);
                    hessian[(i, i)] += dot(&work.pull, &work.column);
                }
                hessian[(j, i)] = hessian[(i, j)];
            }
            let Some(sigma) = self.space.unknowns.sigma_prior(self.space.parameters[i]) else { continue };
            // The row (θ′ − θ)/(2σ_p) of a prior.
            let weight = match target.metric {
                Metric::PerPhoton { photons } => 0.5 / (sigma * photons.sqrt()),
                Metric::Counting(_) => 0.5 / sigma,
            };
            let parameter = self.space.parameters[i];
            let row = weight * (value(state, parameter) - value(target.state, parameter));
            cost += row * row;
            gradient[i] += weight * row;
            gauss_newton[(i, i)] += weight * weight;
            hessian[(i, i)] += weight * weight;
        }
        Linearised { cost, quadratic: Quadratic { gradient, gauss_newton, hessian } }
    }

    /// Band integrals of S − S′ from differences that lose no digits.
    fn separate(&mut self, target: &Target<'_>, state: &State) {
        let (own, work) = (target.state, &mut self.work);
        let nu = self.target.surroundings().nodes_cm1();
        let warmer = own.temperature_k - state.temperature_k;
        let base = self.surface.radiance();
        planck::photon_radiance_difference_into(nu, state.temperature_k, warmer, base, &mut work.difference);
        self.target.lighting_difference_into(own, &self.surface, state, &mut work.lighting);
        separation_into(Separation {
            gain: own.gain,
            emissivity: target.emissivity,
            alternative: target.alternative,
            contrast: self.target.contrast(),
            difference: &work.difference,
            lighting: &work.lighting,
            out: &mut work.node,
        });
        self.target.bands().weigh_into(&work.node, &mut work.separation);
        let gain = state.gain - own.gain;
        if gain != 0.0 {
            for (separation, other) in work.separation.iter_mut().zip(self.surface.signal()) {
                // S = G s and S′ = G′ s′: S − S′ = G(s − s′) − (G′ − G)s′.
                *separation -= gain * other / state.gain;
            }
        }
    }
}

struct Separation<'a> {
    gain: f64,
    emissivity: &'a [f64],
    alternative: &'a [f64],
    contrast: &'a [f64],
    difference: &'a [f64],
    lighting: &'a [f64],
    out: &'a mut [f64],
}

dispatched! {
    /// (e − e′)C + e′[B(T) − B(T′)] + (1 − e′)(X − X′), times the target's gain.
    fn separation_into<'a>(spectra: Separation<'a>) {
        let Separation { gain, emissivity, alternative, contrast, difference, lighting, out } = spectra;
        let own = emissivity.iter().zip(alternative);
        let terms = contrast.iter().zip(difference).zip(lighting);
        for ((out, (e, other)), ((contrast, difference), lighting)) in out.iter_mut().zip(own).zip(terms) {
            let mixed = (e - other).mul_add(*contrast, other * difference);
            *out = gain * (1.0 - other).mul_add(*lighting, mixed);
        }
    }
}

struct Residuals<'a> {
    counts: f64,
    signal: &'a [f64],
    noise: &'a [f64],
    root: &'a [f64],
    separation: &'a [f64],
    residual: &'a mut [f64],
    slope: &'a mut [f64],
    pull: &'a mut [f64],
    bend: &'a mut [f64],
}

dispatched! {
    /// r = κ(S − S′)/(√(κS+σ²) + √(κS′+σ²)) and ∂r/∂S′ = −κ/(2√(κS′+σ²)) of each band; returns ‖r‖².
    fn residuals<'a>(bands: Residuals<'a>) -> f64 {
        let Residuals { counts, signal, noise, root, separation, residual, slope, pull, bend } = bands;
        let own = root.iter().zip(separation);
        let other = signal.iter().zip(noise);
        let first = residual.iter_mut().zip(slope.iter_mut());
        let second = pull.iter_mut().zip(bend.iter_mut());
        for ((((residual, slope), (pull, bend)), (root, separation)), (signal, noise)) in
            first.zip(second).zip(own).zip(other)
        {
            let other_root = counts.mul_add(*signal, *noise).sqrt();
            let both = root + other_root;
            *residual = if both > 0.0 { counts * separation / both } else { 0.0 };
            let inverse = if other_root > 0.0 { 1.0 / other_root } else { 0.0 };
            *slope = -0.5 * counts * inverse;
            *pull = *residual * *slope;
            *bend = *pull * (*slope * inverse);
        }
        sum::dot(residual, residual)
    }
}

dispatched! {
    fn scale_twice<'a>(column: &'a [f64], slope: &'a [f64], once: &'a mut [f64], twice: &'a mut [f64]) {
        for (((once, twice), column), slope) in once.iter_mut().zip(twice).zip(column).zip(slope) {
            *once = column * slope;
            *twice = *once * slope;
        }
    }
}

dispatched! {
    fn scale_by<'a>(column: &'a [f64], factors: &'a [f64], out: &'a mut [f64]) {
        for ((out, column), factor) in out.iter_mut().zip(column).zip(factors) {
            *out = column * factor;
        }
    }
}

dispatched! {
    pub(super) fn dot<'a>(a: &'a [f64], b: &'a [f64]) -> f64 {
        sum::dot(a, b)
    }
}
