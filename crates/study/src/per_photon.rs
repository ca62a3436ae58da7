//! Distances of the target to an alternative per √photon, remembered where scenarios share them.

use super::remembered::{PerPhoton, Scene};
use super::{Study, Surface};
use hadar::error::Result;

impl Study {
    /// Distances of the target to an alternative among `photons` photons.
    pub(super) fn per_photon(&self, alternative: &Surface, photons: f64) -> Result<PerPhoton> {
        let compute = || {
            let local = self.local(self.unknowns.clone(), alternative, photons)?;
            let nearest = self.nearest(alternative, photons)?;
            let local_unknown_gain = self.local_unknown_gain(alternative, photons)?;
            let back = self.return_distance(alternative, &nearest)?;
            Ok(PerPhoton { local, local_unknown_gain, nearest, back })
        };
        let Some(remembered) = self.remembered.as_ref().filter(|_| !self.unknowns.has_priors()) else {
            return compute();
        };
        let scene = Scene {
            state: self.state.clone(),
            tolerance: self.tolerance(),
            range: self.range,
            unknowns: self.unknowns.clone(),
            target: self.target.emissivity.clone(),
            alternative: alternative.emissivity.clone(),
            surroundings: self.surroundings.clone(),
            bands: self.bands.clone(),
        };
        remembered.or_compute(scene, compute)
    }
}
