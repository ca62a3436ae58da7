//! The distance between the target's counts and those of a state of the alternative, and its derivatives.

use super::bounds::{unit, value};
use super::{Linearised, Metric, NearestSolver, Target};
use crate::planck;
use crate::scene::State;
use crate::simd::dispatched;
use crate::sum::{Compensated, dot};
use nalgebra::{DMatrix, DVector};

impl NearestSolver<'_> {
    /// Cost ‖r‖², gradient and Gauss–Newton matrix of half the cost at a state of the alternative.
    pub(super) fn linearise(&mut self, target: &Target<'_>, state: &State) -> Linearised {
        let total_known = self.unknowns.known_lighting_total().is_some();
        self.surface.evaluate(target.alternative, target.alternative, state, &self.parameters, total_known);
        self.separate(target, state);
        let n = self.parameters.len();
        residuals_into(Residuals {
            counts: target.counts,
            noise: &self.noise,
            target_root: &self.target_root,
            signal: self.surface.signal(),
            residual: &mut self.separation,
            slope: &mut self.slope,
        });
        let mut cost = Compensated::default();
        cost.add(dot(&self.separation, &self.separation));
        let (mut gradient, mut hessian) = (DVector::zeros(n), DMatrix::zeros(n, n));
        for i in 0..n {
            self.surface.scale_column(i, &self.slope);
        }
        for i in 0..n {
            let column = self.surface.column(i);
            gradient[i] = dot(column, &self.separation);
            for j in i..n {
                hessian[(i, j)] = dot(column, self.surface.column(j));
                hessian[(j, i)] = hessian[(i, j)];
            }
            self.add_prior(i, target, state, &mut cost, &mut gradient, &mut hessian);
        }
        Linearised { cost: cost.value(), gradient, hessian }
    }

    /// The row (θ′ − θ)/(2σ_p) of a prior.
    fn add_prior(
        &self,
        i: usize,
        target: &Target<'_>,
        state: &State,
        cost: &mut Compensated,
        gradient: &mut DVector<f64>,
        hessian: &mut DMatrix<f64>,
    ) {
        let Some(sigma) = self.unknowns.sigma_prior(self.parameters[i]) else { return };
        let weight = match target.metric {
            Metric::PerPhoton { photons } => 0.5 / (sigma * photons.sqrt()),
            Metric::Counting(_) => 0.5 / sigma,
        };
        let parameter = self.parameters[i];
        let row = weight * (value(state, parameter) - value(target.state, parameter));
        let slope = weight * unit(state, parameter);
        cost.add(row * row);
        gradient[i] += slope * row;
        hessian[(i, i)] += slope * slope;
    }

    /// Band integrals of S − S′ from differences that lose no digits.
    fn separate(&mut self, target: &Target<'_>, state: &State) {
        let surroundings = self.target.surroundings();
        let nu = surroundings.nodes_cm1();
        let own = target.state;
        let warmer = own.temperature_k - state.temperature_k;
        planck::photon_radiance_difference_into(
            nu,
            state.temperature_k,
            warmer,
            self.surface.radiance(),
            &mut self.difference,
        );
        self.target.lighting_difference_into(own, &self.surface, state, &mut self.spectrum);
        separation_into(Separation {
            gain: own.gain,
            emissivity: target.emissivity,
            alternative: target.alternative,
            contrast: self.target.contrast(),
            warmer: &self.difference,
            lighting: &self.spectrum,
            out: &mut self.node,
        });
        self.target.bands().weigh_into(&self.node, &mut self.separation);
        if state.gain == own.gain {
            return;
        }
        let gain = state.gain - own.gain;
        for (separation, other) in self.separation.iter_mut().zip(self.surface.signal()) {
            // S = G s and S′ = G′ s′: S − S′ = G(s − s′) − (G′ − G)s′.
            *separation -= gain * other / state.gain;
        }
    }
}

/// What [`residuals_into`] reads and writes, band by band.
struct Residuals<'a> {
    counts: f64,
    /// σ².
    noise: &'a [f64],
    /// √(N + σ²).
    target_root: &'a [f64],
    /// S′.
    signal: &'a [f64],
    /// S − S′ on entry.
    residual: &'a mut [f64],
    /// ∂r/∂S′ = −κ/(2√(N′ + σ²)).
    slope: &'a mut [f64],
}

dispatched! {
    fn residuals_into<'a>(work: Residuals<'a>) {
        let Residuals { counts, noise, target_root, signal, residual, slope } = work;
        let bands = residual.iter_mut().zip(slope).zip(signal).zip(target_root).zip(noise);
        for ((((residual, slope), signal), target_root), noise) in bands {
            let root = (counts * signal + noise).sqrt();
            let sum = target_root + root;
            *residual = if sum > 0.0 { counts * *residual / sum } else { 0.0 };
            *slope = if root > 0.0 { -0.5 * counts / root } else { 0.0 };
        }
    }
}

dispatched! {
    /// √(κS + σ²).
    pub(super) fn roots_into<'a>(counts: f64, signal: &'a [f64], noise: &'a [f64], out: &'a mut [f64]) {
        for ((out, signal), noise) in out.iter_mut().zip(signal).zip(noise) {
            *out = (counts * signal + noise).sqrt();
        }
    }
}

/// What [`separation_into`] reads and writes, node by node.
struct Separation<'a> {
    gain: f64,
    emissivity: &'a [f64],
    alternative: &'a [f64],
    contrast: &'a [f64],
    /// B(T) − B(T′).
    warmer: &'a [f64],
    /// X − X′.
    lighting: &'a [f64],
    out: &'a mut [f64],
}

dispatched! {
    /// G[(e − e′)C + e′(B(T) − B(T′)) + (1 − e′)(X − X′)].
    fn separation_into<'a>(work: Separation<'a>) {
        let Separation { gain, emissivity, alternative, contrast, warmer, lighting, out } = work;
        let nodes = out.iter_mut().zip(emissivity).zip(alternative).zip(contrast).zip(warmer).zip(lighting);
        for (((((out, e), other), contrast), warmer), lighting) in nodes {
            *out = gain * ((e - other) * contrast + other * warmer + (1.0 - other) * lighting);
        }
    }
}
