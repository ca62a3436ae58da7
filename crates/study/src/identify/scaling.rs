//! How distances scale: with the size of the library, and with the number of bands.
//!
//! More materials can only bring the least distance down. More bands can only bring it up as long as photons are all
//! there is; with electronic noise of every reading, finer bands share the photons among more readings and
//! can lose. Bands are joined two by two, over and over, so that every number of bands refines the one before.

use crate::{Study, Surface};
use hadar::error::Result;
use hadar::fisher::Counting;
use hadar::identifiability::local::LocalSolver;
use hadar::identifiability::multi::{Progress, expected_minimum};
use hadar::parallel;
use hadar_scenario::DistanceKind;

/// Expected least distance against the size of the library.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct LibrarySize {
    /// Materials in the library, the target among them.
    pub materials: Vec<usize>,
    /// Expected least distance per √photon of the scenario's target over all libraries of that size.
    pub target: Vec<f64>,
    /// The same of each material as the target: 10 %, 50 % and 90 % quantiles over the materials.
    pub quantiles: Vec<[f64; 3]>,
    /// Least distance of all pairs of the whole library.
    pub whole_library: f64,
}

/// Least distance from the target to any alternative against the number of bands.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct BandNumber {
    /// Alternatives left out since not even all bands with shot noise alone tell them as required; none where that
    /// holds for all.
    pub left_out: Vec<String>,
    /// Bands, each as wide as the next (but for the last).
    pub bands: Vec<usize>,
    /// Least distance per √photon: shot noise alone, photons fixed.
    pub shot_noise: Vec<f64>,
    /// Median over the alternatives of the distance per √photon, shot noise alone.
    pub shot_noise_median: Vec<f64>,
    /// Least statistical distance with the camera, whose noise is the same in every reading; empty without electronic
    /// noise, when it would be that of shot noise.
    pub camera: Vec<f64>,
    /// Median over the alternatives with the camera; empty without one.
    pub camera_median: Vec<f64>,
}

/// Both scaling laws.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Scaling {
    /// Which distance they are of.
    pub by: &'static str,
    /// Against the size of the library.
    pub library: LibrarySize,
    /// Against the number of bands.
    pub bands: BandNumber,
}

impl Study {
    /// The scaling laws of the least distance, by the distance that decides. `progress` is told the targets that are searched.
    ///
    /// # Errors
    /// As [`Study::matrix`].
    pub fn scaling(&self, progress: Progress<'_>) -> Result<Scaling> {
        let kind = self.scenario.requirement.by;
        Ok(Scaling {
            by: kind.name(),
            library: self.library_size(kind, progress)?,
            bands: self.band_number(kind)?,
        })
    }

    fn library_size(&self, kind: DistanceKind, progress: Progress<'_>) -> Result<LibrarySize> {
        let materials = self.materials()?;
        let emissivities: Vec<&[f64]> = materials.iter().map(|m| m.emissivity.as_slice()).collect();
        let count = materials.len();
        let distances = self.all_distances(kind, &emissivities, None, progress)?.found;
        self.book_distances(kind, count * (count - 1));
        let curves: Vec<Vec<f64>> = (0..count)
            .map(|target| {
                let row = &distances[target * count..(target + 1) * count];
                let rivals: Vec<f64> =
                    row.iter().enumerate().filter(|(other, _)| *other != target).map(|(_, d)| *d).collect();
                expected_minimum(&rivals)
            })
            .collect();
        let quantiles = (0..count - 1)
            .map(|k| {
                let mut values: Vec<f64> = curves.iter().map(|curve| curve[k]).collect();
                values.sort_by(f64::total_cmp);
                [0.1, 0.5, 0.9].map(|share| quantile(&values, share))
            })
            .collect();
        let off_diagonal = distances.iter().enumerate().filter(|(i, _)| i % (count + 1) != 0);
        let whole_library = off_diagonal.map(|(_, d)| *d).fold(f64::INFINITY, f64::min);
        let target = curves.into_iter().next().unwrap_or_default();
        Ok(LibrarySize { materials: (2..=count).collect(), target, quantiles, whole_library })
    }

    fn band_number(&self, kind: DistanceKind) -> Result<BandNumber> {
        let (within, beyond) = self.within_reach()?;
        let beyond = if within.is_empty() { Vec::new() } else { beyond };
        let counted = self.alternatives.iter().enumerate().filter(|(i, _)| !beyond.contains(i));
        let counted: Vec<Surface> = counted.map(|(_, surface)| surface.clone()).collect();
        let mut found = BandNumber {
            left_out: self.names_of(&beyond),
            bands: Vec::new(),
            shot_noise: Vec::new(),
            shot_noise_median: Vec::new(),
            camera: Vec::new(),
            camera_median: Vec::new(),
        };
        let whole = self.bands.len();
        let groups: Vec<usize> =
            std::iter::successors(Some(1), |group| (*group < whole).then_some(2 * group)).collect();
        for group in groups.into_iter().rev() {
            let (bands, open_bands) = (self.bands.merged(group), self.open_bands.merged(group));
            let study = Self { bands, open_bands, alternatives: counted.clone(), ..self.clone() };
            if !study.enough_bands(&study.decisive_unknowns()) {
                continue;
            }
            let (least, median) = study.least_and_median(kind, None)?;
            study.book_distances(kind, counted.len());
            found.bands.push(study.bands.len());
            found.shot_noise.push(least);
            found.shot_noise_median.push(median);
            let noisy = |counting: &Counting| counting.var_added.iter().any(|&var| var > 0.0);
            if let Some(counting) = study.counting().filter(noisy) {
                let (least, median) = study.least_and_median(kind, Some(&counting))?;
                study.book_distances(kind, counted.len());
                found.camera.push(least);
                found.camera_median.push(median);
            }
        }
        Ok(found)
    }
}

impl Study {
    /// Least and median distance from the target to the alternatives.
    fn least_and_median(&self, kind: DistanceKind, counting: Option<&Counting>) -> Result<(f64, f64)> {
        let (own, state, photons) = (&self.target.emissivity, &self.state, f64::INFINITY);
        let local = || LocalSolver::new(&self.bands, &self.surroundings, self.decisive_unknowns());
        let nearest = || self.nearest_solver();
        let count = self.alternatives.len();
        let found: Result<Vec<f64>> = match kind {
            DistanceKind::Nearest => parallel::try_map_with(count, nearest, |solver, i| {
                let other = &self.alternatives[i].emissivity;
                match counting {
                    Some(counting) => solver.with_counting(own, other, state, counting),
                    None => solver.per_photon(own, other, state, photons),
                }
                .map(|nearest| nearest.distance)
            }),
            DistanceKind::Local | DistanceKind::LocalUnknownGain => {
                parallel::try_map_with(count, local, |solver, i| {
                    let other = &self.alternatives[i].emissivity;
                    match counting {
                        Some(counting) => solver.with_counting(own, other, state, counting),
                        None => solver.per_photon(own, other, state, photons),
                    }
                    .map(|local| local.distance)
                })
            }
        };
        let mut distances = found?;
        distances.sort_by(f64::total_cmp);
        Ok((quantile(&distances, 0.0), quantile(&distances, 0.5)))
    }
}

/// The value below which this share of sorted values lies.
pub(crate) fn quantile(sorted: &[f64], share: f64) -> f64 {
    let last = sorted.len().saturating_sub(1);
    sorted.get((share * last as f64).round() as usize).copied().unwrap_or(f64::NAN)
}
