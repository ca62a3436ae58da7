//! What would have to change for the demand to be just met: the window that decides, taken apart.

use super::bounds::Ground;
use super::results::{DepthSolutions, Signal};
use super::subject::{Measured, Resolved, Truth};
use super::{Informed, RangeStudy};
use hadar::cube::Cube;
use hadar::error::Result;
use hadar::planck;
use hadar::ranging::depth::{DepthTask, ExposureNoise, Image, WindowSamples};
use hadar::ranging::derivative::Differentiator;
use hadar::ranging::noise::NoiseVariance;
use hadar::ranging::psf::{PointSpread, bands_var_m2};
use hadar_scenario::range::Diffraction;
use hadar_simulate::render::{Part, StereoPair, View};
use std::ops::Range;

/// A share of a number of windows that is whole but for rounding.
const RANK_ROUNDING: f64 = 1e-9;

/// The place, among so many windows in their order, of the first that leaves fewer than a share before it.
pub(super) fn rank(share: f64, windows: usize) -> usize {
    let reached = (share * windows as f64 - RANK_ROUNDING).ceil() as usize;
    reached.saturating_sub(1).min(windows.saturating_sub(1))
}

/// Rows of counts of a view, in photons, with σ² of a sample of band b.
struct Counts {
    rows: Vec<f64>,
    first: usize,
    var: Vec<f64>,
}

impl RangeStudy {
    /// Each quantity for the heat cube's window at the demanded share; `None` without depth or texture.
    pub(super) fn solutions(
        &self,
        informed: &Informed,
        ground: &Ground<'_>,
        windows: &[(usize, usize)],
        variances: &[Vec<f64>],
    ) -> Result<Option<DepthSolutions>> {
        let place = informed.left.iter().position(|map| map.signal == Signal::HeatCube);
        let Some(var) = place.and_then(|at| variances.get(at)) else { return Ok(None) };
        let Some(((row, column), depth_m)) = self.decisive(ground.truth, ground.columns, windows, var)?
        else {
            return Ok(None);
        };
        self.solved(informed.pair.as_ref(), (row, column), depth_m, ground.var_diffraction_px2)
    }

    /// Each quantity for the heat cube's window at a row and column, seen in a rendered pair or in cubes.
    pub(super) fn solved(
        &self,
        pair: Option<&StereoPair>,
        (row, column): (usize, usize),
        depth_m: f64,
        var_diffraction_px2: f64,
    ) -> Result<Option<DepthSolutions>> {
        let disparity = self.geometry.disparity_px(depth_m)?;
        let partner = (column as f64 - disparity).round();
        let left = self.samples(pair, true, row, column)?;
        let has_right = match &self.subject {
            Resolved::Scene(_) => true,
            Resolved::Cube(cube) => cube.right.is_some(),
        };
        let right = match has_right && partner >= 0.0 {
            true => self.samples(pair, false, row, partner as usize)?,
            false => left.clone(),
        };
        let (Some(left), Some(right)) = (left, right) else { return Ok(None) };
        let pitch = self.geometry.pitch_m();
        let image = match var_diffraction_px2 {
            0.0 => Image::Measured,
            var => Image::Ideal { var_diffraction_m2: var * pitch * pitch },
        };
        let demand = self.scenario.requirement.error;
        let task =
            DepthTask { geometry: self.geometry, distance_m: depth_m, views: [&left, &right], image, demand };
        let camera = self.camera.as_ref();
        let aperture = camera.map(|camera| {
            task.aperture(camera.focal_length_m / camera.f_number, |aperture_m| {
                self.var_diffraction_m2(aperture_m)
            })
        });
        let exposure = camera.map(|camera| {
            task.exposure(ExposureNoise {
                exposure_s: camera.exposure_s,
                noise_exposure_s: camera.noise_exposure_s / f64::from(camera.frames),
                flicker_fraction: camera.flicker_fraction,
            })
        });
        Ok(Some(DepthSolutions {
            signal: Signal::HeatCube,
            depth_m,
            pixel: [row, column],
            allowed_m: demand.at(depth_m),
            farthest_on_object_m: task.distance_texture_on_object()?.value,
            baseline_m: task.baseline()?,
            exposure_s: exposure.transpose()?,
            aperture_m: aperture.transpose()?,
            noise_counts: camera.map(|_| task.noise()).transpose()?,
        }))
    }

    /// The window that the demanded share of the windows does as well as, or better: its centre and depth.
    fn decisive(
        &self,
        truth: &Truth,
        columns: usize,
        windows: &[(usize, usize)],
        var: &[f64],
    ) -> Result<Option<((usize, usize), f64)>> {
        let mut ranked = Vec::with_capacity(windows.len());
        for (window, var) in windows.iter().zip(var) {
            let depth_m = truth.depth_m.get(window.0 * columns + window.1).copied().unwrap_or(f64::NAN);
            if depth_m.is_finite() && !var.is_nan() {
                let error = self.geometry.depth_error_m(depth_m, var.sqrt())?;
                ranked.push((error / self.scenario.requirement.error.at(depth_m), *window, depth_m));
            }
        }
        if ranked.is_empty() {
            return Ok(None);
        }
        let rank = rank(self.scenario.requirement.share, ranked.len());
        let (_, (ratio, window, depth_m), _) =
            ranked.select_nth_unstable_by(rank, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        Ok(ratio.is_finite().then_some((*window, *depth_m)))
    }

    /// Samples of a window of one view; `None` where it does not fit in.
    fn samples(
        &self,
        pair: Option<&StereoPair>,
        left: bool,
        row: usize,
        column: usize,
    ) -> Result<Option<WindowSamples>> {
        let shape = self.shape()?;
        let stereo = &self.scenario.stereo;
        let (half_rows, half_columns) = (stereo.window.half_rows(), stereo.window.half_columns());
        let margin = stereo.derivative.margin();
        if column < half_columns + margin || column + half_columns + margin >= shape.columns() {
            return Ok(None);
        }
        let counts = self.counts(pair, left, row - half_rows..row + half_rows + 1)?;
        let bands = shape.bands();
        let columns = column - half_columns..column + half_columns + 1;
        let mut differentiator = Differentiator::new(stereo.derivative, shape.columns())?;
        let mut slopes = vec![0.0; (shape.columns() - 2 * margin) * bands];
        let (mut n, mut slope) = (Vec::new(), Vec::new());
        for counts in counts.rows.chunks_exact(shape.row_len()) {
            differentiator.apply(counts, bands, &mut slopes)?;
            n.extend_from_slice(&counts[columns.start * bands..columns.end * bands]);
            slope
                .extend_from_slice(&slopes[(columns.start - margin) * bands..(columns.end - margin) * bands]);
        }
        let var = match counts.var.len() {
            0 => Vec::new(),
            found if found == bands => n.chunks(bands).flat_map(|_| counts.var.iter().copied()).collect(),
            _ => {
                let at = |row: usize| row * shape.row_len() + columns.start * bands;
                (0..counts.rows.len() / shape.row_len())
                    .flat_map(|row| counts.var[at(row)..at(row) + columns.len() * bands].iter().copied())
                    .collect()
            }
        };
        debug_assert_eq!(counts.first + half_rows, row);
        WindowSamples::new(n, slope, var).map(Some)
    }

    fn counts(&self, pair: Option<&StereoPair>, left: bool, rows: Range<usize>) -> Result<Counts> {
        let first = rows.start;
        match (&self.subject, pair) {
            (Resolved::Scene(scene), Some(pair)) => {
                let view: &View = if left { &pair.left } else { &pair.right };
                let mut counts = Vec::new();
                view.rows_into(Part::Total, scene.counting.counts_per_radiance, rows, &mut counts);
                Ok(Counts { rows: counts, first, var: per_band(&scene.noise, view.shape().bands()) })
            }
            (Resolved::Cube(cube), _) => cube.counts(left, rows),
            (Resolved::Scene(_), None) => Ok(Counts { rows: Vec::new(), first, var: Vec::new() }),
        }
    }

    /// σ_d² of a lens, m² on the detector.
    pub(super) fn var_diffraction_m2(&self, aperture_m: f64) -> Result<f64> {
        match (self.scenario.stereo.diffraction, &self.bands) {
            (Diffraction::None, _) | (Diffraction::Airy, None) => Ok(0.0),
            (Diffraction::Gaussian(sigma_m), _) => Ok(PointSpread::gaussian(sigma_m)?.var_m2()),
            (Diffraction::Airy, Some(bands)) => {
                let focal = self.geometry.focal_length_m();
                // Photons of a blackbody at 293 K share out the bands: J ∝ ν² hardly depends on how.
                let part = |nu: f64| {
                    let spread = PointSpread::airy_of_aperture(aperture_m, focal, nu)?;
                    Ok((spread, planck::photon_radiance(nu, 293.15)))
                };
                let parts =
                    bands.bands().iter().map(|band| part(band.center_cm1)).collect::<Result<Vec<_>>>()?;
                bands_var_m2(&parts)
            }
        }
    }
}

fn per_band(noise: &NoiseVariance, bands: usize) -> Vec<f64> {
    match noise {
        NoiseVariance::Uniform(var) => vec![*var; bands],
        NoiseVariance::PerBand(var) => var.clone(),
        NoiseVariance::None | NoiseVariance::PerSample(_) => Vec::new(),
    }
}

impl Measured {
    /// Rows in photons. A cube of variances gives one per sample.
    fn counts(&self, left: bool, rows: Range<usize>) -> Result<Counts> {
        let cube = match (&self.right, left) {
            (Some(right), false) => right,
            _ => &self.left,
        };
        let first = rows.start;
        let mut counts = as_f64(cube, rows.clone())?;
        counts.iter_mut().for_each(|n| *n *= self.photons_per_unit);
        let var = match &self.noise {
            NoiseVariance::PerSample(cube) => as_f64(cube, rows)?,
            other => per_band(other, cube.shape().bands()),
        };
        Ok(Counts { rows: counts, first, var })
    }
}

fn as_f64(cube: &Cube, rows: Range<usize>) -> Result<Vec<f64>> {
    Ok(match cube {
        Cube::F32(cube) => cube.read(rows, &mut Vec::new())?.iter().map(|n| f64::from(*n)).collect(),
        Cube::F64(cube) => cube.read(rows, &mut Vec::new())?.to_vec(),
    })
}
