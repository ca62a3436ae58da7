//! What a key of a scenario may be of: the members of a class, or one material.

use super::ClassSide;
use crate::Surface;
use hadar::error::Result;
use hadar::identifiability::mixture;
use hadar_scenario::{ClassSpec, Spread};

/// A class with its members on the nodes of the bands; a material is one of itself.
#[derive(Debug, Clone)]
pub(crate) struct Members {
    /// Name of the class, or of the material.
    pub(crate) name: String,
    /// What the class is, if it is one.
    pub(crate) spec: Option<ClassSpec>,
    pub(crate) surfaces: Vec<Surface>,
    /// A share for each; Σ = 1.
    pub(crate) weights: Vec<f64>,
    /// How many spectra it rests on.
    pub(crate) spectra: usize,
    /// Of a class that stands as its mean: √(w_i/(1 − Σw²)) (e_i − ē), of whose products the sample covariance is the sum.
    pub(crate) modes: Vec<Vec<f64>>,
}

impl Members {
    /// Surfaces by their weights; there is at least one.
    pub(crate) fn new(
        name: &str,
        spec: Option<ClassSpec>,
        surfaces: Vec<Surface>,
        weights: Vec<f64>,
    ) -> Self {
        let spectra = surfaces.len();
        Self { name: name.to_owned(), spec, surfaces, weights, spectra, modes: Vec::new() }
    }

    pub(crate) fn is_class(&self) -> bool {
        self.spec.is_some()
    }

    pub(crate) fn mixtures(&self) -> bool {
        self.spec.as_ref().is_some_and(|spec| spec.mixtures) && self.surfaces.len() > 1
    }

    /// A class with a sample covariance becomes its mean.
    pub(super) fn stand_as_mean(&mut self) -> Result<()> {
        if self.spec.as_ref().is_none_or(|spec| spec.spread != Some(Spread::Sample))
            || self.surfaces.len() < 2
        {
            return Ok(());
        }
        let rest = 1.0 - self.weights.iter().map(|w| w * w).sum::<f64>();
        if rest < 1e-9 {
            // All weight is on one: a sample of one has no covariance.
            return Ok(());
        }
        let mean = mixed(&self.surfaces, &self.weights);
        self.modes = self
            .surfaces
            .iter()
            .zip(&self.weights)
            .filter(|(_, weight)| **weight > 0.0)
            .map(|(surface, weight)| {
                let share = (weight / rest).sqrt();
                surface.emissivity.iter().zip(&mean).map(|(e, mean)| share * (e - mean)).collect()
            })
            .collect();
        let name = format!("{}/mean", self.name);
        self.surfaces = vec![Surface { name, emissivity: mean, one_number: None }];
        self.weights = vec![1.0];
        Ok(())
    }

    /// What the class is called, and how much it rests on.
    pub(super) fn side(&self) -> ClassSide {
        ClassSide {
            name: self.name.clone(),
            spectra: self.spectra,
            is_class: self.is_class(),
            mixtures: self.mixtures(),
            mean: !self.modes.is_empty(),
            members: named(self.surfaces.iter()),
            weights: self.weights.clone(),
            one_number: named(self.surfaces.iter().filter(|surface| surface.one_number.is_some())),
        }
    }
}

fn named<'a>(surfaces: impl Iterator<Item = &'a Surface>) -> Vec<String> {
    surfaces.map(|surface| surface.name.clone()).collect()
}

/// Σ w_i e_i.
pub(super) fn mixed(surfaces: &[Surface], weights: &[f64]) -> Vec<f64> {
    let spectra: Vec<&[f64]> = surfaces.iter().map(|surface| surface.emissivity.as_slice()).collect();
    mixture::mixed(&spectra, weights)
}
