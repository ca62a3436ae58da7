//! The paper's scene in any bands: materials amid surroundings at 20 °C, temperature and lighting of each unknown; and
//! the readings of the distance of two of them.

use hadar::error::Result;
use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::local::LocalSolver;
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::scene::{EnvironmentObject, State, Surroundings};
use hadar::spectrum::Bands;
use hadar::statistics::Statistics;
use hadar_simulate::decision::DecisionScene;

/// Bands, surroundings, and what a material's state may be.
#[derive(Clone)]
pub(super) struct PaperScene {
    pub(super) bands: Bands,
    pub(super) surroundings: Surroundings,
    pub(super) unknowns: Unknowns,
    pub(super) range: StateRange,
}

/// One pair by all readings, per √photon of the target.
pub(super) struct Distances {
    pub(super) local: f64,
    pub(super) local_unknown_gain: f64,
    pub(super) nearest: f64,
    pub(super) nearest_state: State,
    /// From the nearest state back to the target's material, at the same exposure.
    pub(super) back: f64,
    /// ΣS of the target, photons s⁻¹ m⁻² sr⁻¹.
    pub(super) photon_radiance: f64,
}

impl Distances {
    /// Exposure at which the target sends so many photons that √N d_nearest = `distance`: N and κ.
    pub(super) fn photons_at(&self, distance: f64) -> (f64, f64) {
        let photons = (distance / self.nearest).powi(2);
        (photons, photons / self.photon_radiance)
    }
}

impl PaperScene {
    pub(super) fn new(bands: Bands) -> Result<Self> {
        let ambient = EnvironmentObject { temperature_k: 293.15, emissivity: None };
        let surroundings = Surroundings::new(bands.nodes_cm1(), vec![ambient])?;
        let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting])?;
        let range = StateRange { temperature_k: [250.0, 450.0], ..StateRange::default() };
        Ok(Self { bands, surroundings, unknowns, range })
    }

    pub(super) fn state(&self, celsius: f64, lighting: f64) -> Result<State> {
        self.surroundings.state(celsius + 273.15, &[lighting])
    }

    /// Signal of every band.
    pub(super) fn signal(&self, emissivity: &[f64], state: &State) -> Vec<f64> {
        self.bands.weigh(&self.surroundings.signal(emissivity, state))
    }

    pub(super) fn distances(&self, target: &[f64], other: &[f64], state: &State) -> Result<Distances> {
        let local = |unknowns| {
            let mut solver = LocalSolver::new(&self.bands, &self.surroundings, unknowns);
            solver.per_photon(target, other, state, f64::INFINITY).map(|found| found.distance)
        };
        let photon_radiance: f64 = self.signal(target, state).iter().sum();
        let per_photon = Counting { counts_per_radiance: 1.0 / photon_radiance, var_added: Vec::new() };
        let solver =
            || NearestSolver::new(&self.bands, &self.surroundings, self.unknowns.clone(), self.range);
        let nearest = solver().with_counting(target, other, state, &per_photon)?;
        let back = solver().with_counting(other, target, &nearest.state, &per_photon)?;
        Ok(Distances {
            local: local(self.unknowns.clone())?,
            local_unknown_gain: if self.bands.len() > 3 {
                local(self.unknowns.with(Nuisance::Gain))?
            } else {
                f64::NAN
            },
            nearest: nearest.distance,
            nearest_state: nearest.state,
            back: back.distance,
            photon_radiance,
        })
    }

    pub(super) fn decisions<'a>(
        &'a self,
        counts_per_radiance: f64,
        statistics: &'a Statistics,
    ) -> DecisionScene<'a> {
        DecisionScene {
            bands: &self.bands,
            surroundings: &self.surroundings,
            unknowns: &self.unknowns,
            range: self.range,
            counts_per_radiance,
            statistics,
        }
    }
}
