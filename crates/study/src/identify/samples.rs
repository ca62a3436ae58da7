//! Spectra as a camera would read them once, drawn at random.

use crate::Study;
use hadar::error::Result;
use hadar::fisher::Counting;
use hadar::statistics::Statistics;
use hadar_simulate::draws::{Draws, GENERATOR, generator};

/// One reading of every material in the target's state.
#[derive(Debug, Clone, PartialEq)]
pub struct SampleSpectra {
    /// Band centres, cm⁻¹.
    pub wavenumber_cm1: Vec<f64>,
    /// Material by material: name, mean counts, counts drawn.
    pub materials: Vec<(String, Vec<f64>, Vec<f64>)>,
    /// Seed of the draws.
    pub seed: u64,
    /// Generator that the seed belongs to.
    pub generator: &'static str,
}

impl Study {
    /// One reading of each material by the camera; `None` without one. Each material has a stream of its own.
    ///
    /// # Errors
    /// Too many photons to draw.
    pub fn sample_spectra(&self, seed: u64) -> Result<Option<SampleSpectra>> {
        let Some(counting) = self.counting() else { return Ok(None) };
        let Counting { counts_per_radiance, var_added } = counting;
        let statistics = if var_added.iter().all(|&var| var == 0.0) {
            Statistics::Poisson
        } else {
            Statistics::gaussian(var_added)?
        };
        let mut materials = Vec::new();
        for (stream, surface) in self.materials()?.into_iter().enumerate() {
            let signal = self.bands.weigh(&self.surroundings.signal(&surface.emissivity, &self.state));
            let mean: Vec<f64> = signal.iter().map(|s| s * counts_per_radiance).collect();
            let mut counts = vec![0.0; mean.len()];
            Draws::new(&statistics, &mean)?.draw_into(&mut generator(seed, stream as u64), &mut counts);
            materials.push((surface.name.clone(), mean, counts));
        }
        let wavenumber_cm1 = self.bands.bands().iter().map(|band| band.center_cm1).collect();
        Ok(Some(SampleSpectra { wavenumber_cm1, materials, seed, generator: GENERATOR }))
    }
}
