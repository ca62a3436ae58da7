//! The pair that distances are measured on: skin at 37 °C among surroundings at 20 °C, V = 0.5, and aluminium.

use crate::reference::Extended;
use crate::reference::local::{LocalReference, Noise, Pair as Posed};
use crate::reference::nearest::NearestReference;
use hadar::error::Result;
use hadar::fisher::{Nuisance, Unknowns};
use hadar::identifiability::nearest::StateRange;
use hadar::material::{Library, Material};
use hadar::scene::{EnvironmentObject, State, Surroundings};
use hadar::spectrum::Bands;

/// The range of the bands, cm⁻¹: 536 of 1 cm⁻¹.
pub(super) const RANGE_CM1: [f64; 2] = [714.5, 1250.5];
pub(super) const TARGET_K: f64 = 310.15;
pub(super) const AMBIENT_K: f64 = 293.15;
pub(super) const LIGHTING: f64 = 0.5;

/// The limit of shot noise per √photon, without priors.
const FEW: Noise<'static> = Noise::PerPhoton { photons: f64::INFINITY };

/// Two materials in the same bands, surroundings and state.
pub(super) struct Pair {
    pub(super) bands: Bands,
    pub(super) surroundings: Surroundings,
    pub(super) target: Vec<f64>,
    pub(super) alternative: Vec<f64>,
    pub(super) state: State,
}

impl Pair {
    /// `materials` in these bands.
    pub(super) fn new(bands: Bands, materials: [&Material; 2]) -> Result<Self> {
        let [target, alternative] = materials.map(|material| material.emissivity(bands.nodes_cm1()));
        let object = EnvironmentObject { temperature_k: AMBIENT_K, emissivity: None };
        let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object])?;
        let state = surroundings.state(TARGET_K, &[LIGHTING])?;
        Ok(Self { target: target?, alternative: alternative?, bands, surroundings, state })
    }

    /// Their local distance in extended precision.
    pub(super) fn local(&self) -> Result<Extended> {
        let mut reference = LocalReference::new(&self.bands, &self.surroundings, unknowns()?);
        Ok(reference.answer(self.posed(), FEW, &[]).distance)
    }

    /// The distance at the bottom of the valley in which a state of the alternative lies, in extended precision.
    pub(super) fn nearest_from(&self, start: State) -> Result<Extended> {
        let range = StateRange::default();
        let mut reference = NearestReference::new(&self.bands, &self.surroundings, unknowns()?, range);
        let found = reference.nearest_from(self.posed(), std::slice::from_ref(&start), FEW);
        // There is a start, so that there is a nearest state.
        Ok(found.map_or_else(Extended::zero, |(distance, _)| distance))
    }

    fn posed(&self) -> Posed<'_> {
        Posed { emissivity: &self.target, alternative: &self.alternative, state: &self.state }
    }

    /// Skin and aluminium in `count` bands over the whole range.
    pub(super) fn skin_and_aluminium(count: usize) -> Result<Self> {
        let library = Library::embedded()?;
        Self::new(bands(count)?, [library.get("skin")?, library.get("aluminium")?])
    }
}

/// So many bands side by side over the whole range.
pub(super) fn bands(count: usize) -> Result<Bands> {
    let [low, high] = RANGE_CM1;
    let step = (high - low) / count as f64;
    Bands::from_rows((0..count).map(|i| (low + (i as f64 + 0.5) * step, step)))
}

/// Temperature and lighting.
pub(super) fn unknowns() -> Result<Unknowns> {
    Unknowns::new([Nuisance::Temperature, Nuisance::Lighting])
}
