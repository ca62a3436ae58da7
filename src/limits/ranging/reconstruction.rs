//! Fisher information about position in a scattered signal that is itself estimated from the bands.
//!
//! Counts of pixel and band are N_b = c[e_b B_b(T) + (1 − e_b) Σₖ Vₖ εₖ B_b(Tₖ)] with the emissivity e known, T and V not,
//! variance N_b + σ_b² (c counts per radiance). Where the state of the surface changes by (∂T, ∂V) per pixel along x,
//! with scores s_θ = ∂N/∂θ/√(N + σ²), one pixel tells of the position (pixel⁻²):
//!
//! * heat cube:                 ‖∂T s_T + Σₖ ∂Vₖ s_k‖², all of it (the full cell of [`super::information`]);
//! * reconstructed lighting:    ‖P⊥ Σₖ ∂Vₖ s_k‖², P⊥ removing the span of s_T and of what else is unknown: the change of
//!   V is used, and T differs from pixel to pixel in unknown ways. For one factor (∂V)²/[J⁻¹]_VV
//!   ([`PixelPrecision::others_unknown`]), formed by projection, never by an inverse;
//! * scattered signal as if measured: Σ_b (∂R_b)²/(R_b + σ_b²), R_b = c(1 − e_b)Σ Vₖεₖ B_b(Tₖ): what the paper's Fig. 4
//!   shows. It leaves out the shot noise of the emitted photons, which come through the same pixel, and can therefore
//!   **exceed what the heat cube tells**: no bound on anything that a camera measures.
//!
//! The second never exceeds the first, since the projection removes s_T from that as well.
//!
//! Assumptions: pixels are reconstructed one by one (no smoothing over neighbours, which brings information of its own);
//! the environment's temperatures do not change along x; emissivity the same on either side (a change of material is
//! texture besides); efficient, unbiased estimates ([`crate::fisher::precision`] tells when that fails).
//!
//! Source: paper eq. 3, Fig. 4, S2, S27, S37; nuisance parameters as in S28.

mod image;
#[cfg(test)]
mod tests;

pub use image::{BesideEmission, EmissionImage};

use crate::error::{Error, Result, check};
use crate::fisher::{Counting, Nuisance, Projector, Unknowns};
use crate::scene::{Columns, Jacobian, Parameter, State, Surroundings, check_emissivity};
use crate::spectrum::Bands;
use crate::sum::Compensated;

/// How precisely one lighting factor of a pixel is known, as 1/variance.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct PixelPrecision {
    /// J_VV: temperature and all else known.
    pub others_known: f64,
    /// 1/[J⁻¹]_VV: the other unknowns estimated from the same bands. 0 where they can imitate any change of V (fewer bands
    /// than unknowns), or where V changes nothing (a black surface).
    pub others_unknown: f64,
    /// Estimated bound on the relative rounding error of `others_unknown`.
    pub relative_error: f64,
}

/// What a pixel tells of the position, pixel⁻², where its state changes along x.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct PixelInformation {
    /// Information of the heat cube as it is measured, pixel⁻².
    pub heat_cube: f64,
    /// Lighting factors reconstructed from it.
    pub reconstructed: f64,
    /// The scattered signal, had it been measured alone; may exceed the heat cube.
    pub as_if_measured: f64,
    /// Estimated bound on the relative rounding error of `reconstructed`.
    pub relative_error: f64,
}

/// Precision of lighting factors in fixed bands and surroundings, pixel after pixel.
///
/// ```
/// use hadar::fisher::{Counting, Nuisance, Unknowns};
/// use hadar::ranging::reconstruction::LightingSolver;
/// use hadar::scene::{EnvironmentObject, Surroundings};
/// use hadar::spectrum::Bands;
///
/// let bands = Bands::uniform(800.0, 1200.0, 8.0)?;
/// let sky = EnvironmentObject { temperature_k: 293.15, emissivity: None };
/// let surroundings = Surroundings::new(bands.nodes_cm1(), vec![sky])?;
/// let ground: Vec<f64> = (0..bands.len()).map(|w| 0.9 + 0.05 * (w as f64 / 5.0).sin()).collect();
/// let state = surroundings.state(300.0, &[0.5])?;
/// let counting = Counting { counts_per_radiance: 1e-12, var_added: Vec::new() };
/// let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting])?;
/// let mut solver = LightingSolver::new(&bands, &surroundings, unknowns)?;
/// let precision = solver.precision(&ground, &state, &counting, 0)?;
/// assert!(precision.others_unknown > 0.0 && precision.others_unknown < precision.others_known);
/// let along_x = solver.information(&ground, &state, &counting, 0.1, &[0.02])?;
/// assert!(along_x.reconstructed < along_x.heat_cube);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct LightingSolver<'a> {
    unknowns: Unknowns,
    /// Unknowns other than lighting, then those of the lighting.
    parameters: Vec<Parameter>,
    /// How many are no lighting.
    others: usize,
    jacobian: Jacobian<'a>,
    projector: Projector,
    columns: Vec<f64>,
    weights: Vec<f64>,
}

impl<'a> LightingSolver<'a> {
    /// A solver for one set of bands, surroundings and unknowns, with priors and a known total of the lighting if they say so.
    ///
    /// # Errors
    /// Lighting that is not among the unknowns, or has no factor that is free.
    pub fn new(bands: &'a Bands, surroundings: &'a Surroundings, unknowns: Unknowns) -> Result<Self> {
        if !unknowns.contains(Nuisance::Lighting) {
            return Err(Error::malformed(
                "a reconstruction that knows the lighting",
                "add it to the unknowns",
            ));
        }
        let (mut parameters, lighting): (Vec<_>, Vec<_>) = (unknowns
            .parameters(surroundings.objects().len()))
        .into_iter()
        .partition(|parameter| !matches!(parameter, Parameter::Lighting(_)));
        if lighting.is_empty() {
            let found = "surroundings that leave no lighting factor free";
            return Err(Error::malformed(
                found,
                "give more objects, or leave the total of the lighting unknown",
            ));
        }
        let others = parameters.len();
        parameters.extend(lighting);
        Ok(Self {
            unknowns,
            parameters,
            others,
            jacobian: Jacobian::new(bands, surroundings),
            projector: Projector::default(),
            columns: Vec::new(),
            weights: Vec::new(),
        })
    }

    /// Precision of lighting factor `factor` (0 the first) of a surface of `emissivity` (at the nodes) in `state`.
    ///
    /// # Errors
    /// A factor that is not free; an emissivity, state or noise that does not fit the scene; no finite result.
    pub fn precision(
        &mut self,
        emissivity: &[f64],
        state: &State,
        counting: &Counting,
        factor: usize,
    ) -> Result<PixelPrecision> {
        check_emissivity(emissivity, self.jacobian.surroundings().nodes_cm1().len())?;
        counting.check(self.jacobian.bands().len())?;
        self.jacobian.surroundings().check(state)?;
        let wanted = Parameter::Lighting(factor);
        let Some(own) = self.parameters.iter().position(|parameter| *parameter == wanted) else {
            let free = self.parameters.len() - self.others;
            let found = format!("the precision of lighting factor {factor}, of which {free} are free");
            return Err(Error::malformed(found, "count them from 0"));
        };
        let total_known = self.unknowns.known_lighting_total().is_some();
        self.jacobian.evaluate(emissivity, emissivity, state, &self.parameters, total_known);
        self.weigh(counting);
        self.columns.clear();
        let priors = self.prior_rows();
        for i in (0..self.parameters.len()).filter(|i| *i != own).chain([own]) {
            self.columns.extend_from_slice(self.jacobian.column(i));
            // A prior stands in a row of its own, whose weight is 1.
            self.columns
                .extend(priors.iter().map(|(owner, sigma)| if *owner == i { 1.0 / sigma } else { 0.0 }));
        }
        self.weights.extend(priors.iter().map(|_| 1.0));
        let (others_known, others_unknown, relative_error) = self.project()?;
        Ok(PixelPrecision { others_known, others_unknown, relative_error })
    }

    /// What a pixel tells of the position where its temperature changes by `temperature_per_px` (K/pixel) and its lighting factors by
    /// `lighting_per_px` (pixel⁻¹), all of them, along x.
    ///
    /// Priors are left out: they know nothing of the position. A known total of the lighting changes nothing here.
    ///
    /// # Errors
    /// As [`LightingSolver::precision`]; a change that is no number, or not one per lighting factor.
    pub fn information(
        &mut self,
        emissivity: &[f64],
        state: &State,
        counting: &Counting,
        temperature_per_px: f64,
        lighting_per_px: &[f64],
    ) -> Result<PixelInformation> {
        let surroundings = self.jacobian.surroundings();
        check_emissivity(emissivity, surroundings.nodes_cm1().len())?;
        counting.check(self.jacobian.bands().len())?;
        self.jacobian.surroundings().check(state)?;
        check::finite("change of temperature", temperature_per_px, "K per pixel")?;
        let (found, expected) = (lighting_per_px.len(), surroundings.objects().len());
        if found != expected {
            return Err(Error::Length { what: "changes of the lighting factors".into(), found, expected });
        }
        for &change in lighting_per_px {
            check::finite("change of a lighting factor", change, "per pixel")?;
        }
        // Temperature, the other unknowns, and then every lighting factor, whether it is free or not.
        let mut parameters = vec![Parameter::Temperature];
        parameters.extend(self.parameters[..self.others].iter().filter(|p| **p != Parameter::Temperature));
        let first = parameters.len();
        parameters.extend((0..expected).map(Parameter::Lighting));
        self.jacobian.evaluate(emissivity, emissivity, state, &parameters, false);
        self.weigh(counting);
        let bands = self.jacobian.bands().len();
        let mut lighting = vec![0.0; bands];
        let mut scattered = vec![0.0; bands];
        for (k, (change, factor)) in lighting_per_px.iter().zip(&state.lighting).enumerate() {
            for (w, column) in self.jacobian.column(first + k).iter().enumerate() {
                lighting[w] += change * column;
                scattered[w] += factor * column;
            }
        }
        let counts = counting.counts_per_radiance;
        let (mut heat_cube, mut as_if_measured) = (Compensated::default(), Compensated::default());
        for (w, (change, slope)) in lighting.iter().zip(self.jacobian.column(0)).enumerate() {
            let both = change + temperature_per_px * slope;
            heat_cube.add(both * both * self.weights[w]);
            let var = counts * scattered[w] + counting.var_added(w);
            if var > 0.0 {
                as_if_measured.add((counts * change / var.sqrt()).powi(2));
            }
        }
        self.columns.clear();
        let temperature_known = !self.unknowns.contains(Nuisance::Temperature);
        for i in usize::from(temperature_known)..first {
            self.columns.extend_from_slice(self.jacobian.column(i));
        }
        self.columns.extend_from_slice(&lighting);
        let (_, reconstructed, relative_error) = self.project()?;
        Ok(PixelInformation {
            heat_cube: check::finite("information of the heat cube", heat_cube.value(), "pixel^-2")?,
            reconstructed,
            as_if_measured: check::finite(
                "information of the scattered signal",
                as_if_measured.value(),
                "pixel^-2",
            )?,
            relative_error,
        })
    }

    /// ‖a‖² and ‖P⊥a‖² of the last column, and the relative error of the second.
    fn project(&mut self) -> Result<(f64, f64, f64)> {
        let columns = Columns { values: &mut self.columns, stride: self.weights.len() };
        let found = self.projector.reduce(columns, &self.weights, 1.0);
        let known = check::finite("precision of the lighting", found.norm * found.norm, "")?;
        // Twice, of the square. What is no more than rounding is imitated by the others.
        let relative_error = 2.0 * found.relative_error;
        if found.residual > 0.0 && found.relative_error < 1.0 {
            Ok((known, (found.residual * found.residual).min(known), relative_error))
        } else {
            Ok((known, 0.0, 0.0))
        }
    }

    /// c²/(N + σ²) of every band.
    fn weigh(&mut self, counting: &Counting) {
        let counts = counting.counts_per_radiance;
        self.weights.clear();
        self.weights.extend(self.jacobian.signal().iter().enumerate().map(|(band, signal)| {
            let var = counts * signal + counting.var_added(band);
            if var > 0.0 { counts * (counts / var) } else { 0.0 }
        }));
    }

    /// Parameters that have a prior, and its deviation.
    fn prior_rows(&self) -> Vec<(usize, f64)> {
        if !self.unknowns.has_priors() {
            return Vec::new();
        }
        let of = |(i, parameter): (usize, &Parameter)| self.unknowns.sigma_prior(*parameter).map(|s| (i, s));
        self.parameters.iter().enumerate().filter_map(of).collect()
    }
}
