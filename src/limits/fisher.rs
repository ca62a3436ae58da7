//! Fisher information of photon counts: which parameters are unknown, and what noise weighs the bands.
//!
//! Counts N_w of band w are independent with variance N_w + σ²_w, so the Fisher matrix is
//! J_ij = Σ_w ∂_iN_w ∂_jN_w/(N_w + σ²_w) = sᵀs (S27) with scores s_i = ∂_iN/√(N + σ²). The scores are never
//! formed: columns of derivatives are orthogonalised in the inner product ⟨a,b⟩ = Σ_w u_w a_w b_w with
//! u = 1/(N + σ²), which is the same thing with one division and no square root per band.
//!
//! A Gaussian prior of deviation σ_p on parameter i adds 1/σ_p² to J_ii: one more row, with weight 1,
//! that holds 1/σ_p in column i alone.
//!
//! With gain among the unknowns this is the paper's normalised single-photon matrix (S29); without it,
//! the calibrated camera (S27). Assumption: Gaussian limit of the counts, O(1/N) terms of the variance's
//! own dependence on the parameters left out, as in the paper.

mod bound;
mod careful;
pub mod emissivity;
pub mod precision;

pub(crate) use bound::Reduced;
pub use bound::{Projection, Projector};
pub(crate) use careful::{CarefulProjector, Noise, project_columns};

pub use crate::instrument::Counting;

use crate::error::{Error, Result, check};
use crate::scene::Parameter;

crate::base::named::named! {
    /// A kind of nuisance: unknown, but not what is asked for.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum Nuisance {
        /// Target temperature; prior in K.
        Temperature = "temperature",
        /// Lighting factors, one per environment object; prior dimensionless.
        Lighting = "lighting",
        /// Overall scale of the signal; prior dimensionless (relative).
        Gain = "gain",
        /// Temperatures of the environment objects; prior in K.
        EnvironmentTemperature = "environment-temperature",
    }
    /// The name used in scenario files.
    name
}

/// The set of nuisances with their priors: what is not known besides the material.
///
/// ```
/// use hadar::fisher::{Nuisance, Unknowns};
/// let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting])?;
/// assert_eq!(unknowns.parameters(1).len(), 2);
/// assert_eq!(unknowns.with(Nuisance::Gain).parameters(1).len(), 3);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Unknowns {
    nuisances: Vec<Nuisance>,
    /// (nuisance, deviation σ_p in the unit of the parameter: K, 1, 1, K).
    priors: Vec<(Nuisance, f64)>,
    lighting_total: Option<f64>,
}

impl Unknowns {
    /// A set of nuisances without priors.
    ///
    /// # Errors
    /// A nuisance named twice.
    pub fn new(nuisances: impl IntoIterator<Item = Nuisance>) -> Result<Self> {
        let mut set: Vec<Nuisance> = nuisances.into_iter().collect();
        set.sort_unstable();
        if let Some(twice) = set.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(Error::malformed(
                format!("nuisance `{}` comes twice", twice[0].name()),
                "name it once",
            ));
        }
        Ok(Self { nuisances: set, ..Self::default() })
    }

    /// Adds a Gaussian prior of deviation `sigma` (K for temperatures, 1 for lighting and ln gain). Below 1e-100 it is certainty,
    /// above 1e100 nothing: no more is told apart, for its square must be a number.
    ///
    /// # Errors
    /// A deviation that is not positive, or a nuisance that is not in the set.
    pub fn prior(mut self, nuisance: Nuisance, sigma: f64) -> Result<Self> {
        check::positive(&format!("prior on {}", nuisance.name()), sigma, "")?;
        if !self.nuisances.contains(&nuisance) {
            return Err(Error::malformed(
                format!("a prior on `{}`, which is not among the nuisances", nuisance.name()),
                "add it to unknown.nuisances or drop the prior",
            ));
        }
        self.priors.retain(|prior| prior.0 != nuisance);
        self.priors.push((nuisance, sigma.clamp(1e-100, 1e100)));
        Ok(self)
    }

    /// The same nuisances, with nothing known of them beforehand.
    #[must_use]
    pub fn without_priors(&self) -> Self {
        Self { priors: Vec::new(), ..self.clone() }
    }

    /// Declares the total of the lighting factors known (S48).
    ///
    /// # Errors
    /// A total outside [0, 1].
    pub fn lighting_total(mut self, total: Option<f64>) -> Result<Self> {
        if let Some(total) = total {
            check::unit_interval("lighting_total", total)?;
        }
        self.lighting_total = total;
        Ok(self)
    }

    /// The same set with one more nuisance.
    #[must_use]
    pub fn with(&self, nuisance: Nuisance) -> Self {
        let mut more = self.clone();
        if !more.nuisances.contains(&nuisance) {
            more.nuisances.push(nuisance);
            more.nuisances.sort_unstable();
        }
        more
    }

    /// The nuisances, in a fixed order.
    #[must_use]
    pub fn nuisances(&self) -> &[Nuisance] {
        &self.nuisances
    }

    /// Whether a nuisance is in the set.
    #[must_use]
    pub fn contains(&self, nuisance: Nuisance) -> bool {
        self.nuisances.contains(&nuisance)
    }

    /// Whether the total of the lighting is known.
    #[must_use]
    pub fn known_lighting_total(&self) -> Option<f64> {
        self.lighting_total
    }

    /// Whether any nuisance has a prior.
    #[must_use]
    pub fn has_priors(&self) -> bool {
        !self.priors.is_empty()
    }

    /// The unknown parameters with `objects` environment objects: nuisances in their fixed order.
    #[must_use]
    pub fn parameters(&self, objects: usize) -> Vec<Parameter> {
        let mut parameters = Vec::new();
        for nuisance in &self.nuisances {
            match nuisance {
                Nuisance::Temperature => parameters.push(Parameter::Temperature),
                Nuisance::Gain => parameters.push(Parameter::Gain),
                Nuisance::Lighting => {
                    let free =
                        if self.lighting_total.is_some() { objects.saturating_sub(1) } else { objects };
                    parameters.extend((0..free).map(Parameter::Lighting));
                }
                Nuisance::EnvironmentTemperature => {
                    parameters.extend((0..objects).map(Parameter::EnvironmentTemperature));
                }
            }
        }
        parameters
    }

    /// The nuisances that have a free parameter and no prior, with `objects` environment objects.
    #[must_use]
    pub fn without_prior(&self, objects: usize) -> Vec<Nuisance> {
        let has_prior = |nuisance: &Nuisance| self.priors.iter().any(|prior| prior.0 == *nuisance);
        let is_free = |nuisance: &Nuisance| match nuisance {
            Nuisance::Lighting => objects > usize::from(self.lighting_total.is_some()),
            Nuisance::EnvironmentTemperature => objects > 0,
            Nuisance::Temperature | Nuisance::Gain => true,
        };
        self.nuisances.iter().copied().filter(|nuisance| !has_prior(nuisance) && is_free(nuisance)).collect()
    }

    /// Deviation of the prior on a parameter, if it has one.
    #[must_use]
    pub fn sigma_prior(&self, parameter: Parameter) -> Option<f64> {
        let nuisance = match parameter {
            Parameter::Temperature => Nuisance::Temperature,
            Parameter::Lighting(_) => Nuisance::Lighting,
            Parameter::Gain => Nuisance::Gain,
            Parameter::EnvironmentTemperature(_) => Nuisance::EnvironmentTemperature,
            Parameter::Material => return None,
        };
        self.priors.iter().find(|prior| prior.0 == nuisance).map(|prior| prior.1)
    }
}
