//! What would have to change for the demand to be just met: windows taken apart, and held against all the others (`verified`).

use super::bounds::Ground;
use super::results::DepthSolutions;
use super::signals::DECIDES;
use super::subject::{Measured, Resolved};
use super::verified::{Asked, CLOSE, CLOSE_OF_RENDERED, Change, as_f64};
use super::{Informed, RangeStudy};
use hadar::cube::Shape;
use hadar::error::Result;
use hadar::ranging::depth::{
    DepthSolution, DepthTask, ExposureNoise, Image, StereoGeometry, WindowSamples, frame_is_over,
    well_is_full,
};
use hadar::ranging::derivative::Differentiator;
use hadar::ranging::noise::NoiseVariance;
use hadar::ranging::psf::{PointSpread, bands_var_m2};
use hadar::{instrument, planck};
use hadar_scenario::range::Diffraction;
use hadar_simulate::render::{Part, StereoPair, View};
use std::ops::Range;

/// All windows, as quantities are solved for.
pub(super) struct Every<'a> {
    pub(super) pair: Option<&'a StereoPair>,
    pub(super) var_diffraction_px2: f64,
    /// Factor of the photons at which the brightest pixel fills its well, and the well.
    pub(super) well: Option<(f64, f64)>,
    /// How near to a value that does not do what is given must be.
    pub(super) close: f64,
    /// The error at the demanded share of all windows over what is allowed; `None` where no window is left.
    pub(super) ratio: &'a dyn Fn(Change) -> Result<Option<f64>>,
    /// The same as the camera is.
    pub(super) ratio_now: f64,
}

/// Rows of counts of a view, in photons, with σ² of a sample of band b.
struct Counts {
    rows: Vec<f64>,
    first: usize,
    var: Vec<f64>,
}

impl RangeStudy {
    /// Each quantity for the heat cube, solved on until it holds for the demanded share of all windows; `None` without depth or texture.
    pub(super) fn solutions(
        &self,
        informed: &Informed,
        shape: Shape,
        (ground, windows): (&Ground<'_>, &[(usize, usize)]),
        variances: &[Vec<f64>],
    ) -> Result<Option<DepthSolutions>> {
        let place = informed.left.iter().position(|map| map.signal == DECIDES);
        let Some(var) = place.and_then(|at| variances.get(at)) else { return Ok(None) };
        let decisive = ground.decisive(windows, var)?.filter(|(ratio, ..)| ratio.is_finite());
        let Some((ratio_now, window, depth_m)) = decisive else { return Ok(None) };
        let every = Every {
            pair: informed.pair.as_deref(),
            var_diffraction_px2: ground.var_diffraction_px2,
            well: self.photons_of_the_well(informed)?,
            close: CLOSE,
            ratio: &|change| self.ratio_with(informed, shape, change),
            ratio_now,
        };
        self.solved(window, depth_m, &every)
    }

    /// Each quantity for all windows, from the one at a row and column on.
    pub(super) fn solved(
        &self,
        (row, column): (usize, usize),
        depth_m: f64,
        every: &Every<'_>,
    ) -> Result<Option<DepthSolutions>> {
        let Some(first) = self.of_window((row, column), depth_m, every)? else { return Ok(None) };
        let as_it_is = Change {
            photons: 1.0,
            noise: 1.0,
            var_diffraction_px2: every.var_diffraction_px2,
            geometry: self.geometry,
        };
        let well = |power: f64, by_exposure: bool| {
            let (factor, full_well) = every.well?;
            Some((factor.powf(power), well_is_full(by_exposure, full_well)))
        };
        let geometry = |factor: f64| {
            let [b, f, p] =
                [self.geometry.baseline_m(), self.geometry.focal_length_m(), self.geometry.pitch_m()];
            StereoGeometry::new(b * factor, f, p)
        };
        let baseline_m = Asked {
            rises: true,
            best: 1e30,
            cap: None,
            ratio: &|factor| (every.ratio)(Change { geometry: geometry(factor)?, ..as_it_is }),
            ratio_now: every.ratio_now,
            close: if every.pair.is_some() { CLOSE_OF_RENDERED } else { every.close },
        }
        .of_all(first.baseline_m.clone());
        let Some(camera) = &self.camera else { return Ok(Some(DepthSolutions { baseline_m, ..first })) };

        let noise = self.exposure_noise(camera)?;
        let stretch = noise.exposure_s / noise.noise_exposure_s;
        let growth = |factor: f64| instrument::noise::growth(stretch * factor, noise.flicker_fraction);
        let frame = camera.frame_s().map(|frame_s| (frame_s / camera.exposure_s, frame_is_over(frame_s)));
        let longest = [well(1.0, true), frame].into_iter().flatten();
        let exposure = Asked {
            rises: true,
            best: 1e30,
            cap: longest.min_by(|a, b| a.0.total_cmp(&b.0)),
            ratio: &|factor| {
                let noise = growth(factor) / growth(1.0);
                (every.ratio)(Change { photons: factor, noise, ..as_it_is })
            },
            ratio_now: every.ratio_now,
            close: every.close,
        };
        let aperture_m = camera.focal_length_m / camera.f_number;
        let pitch = self.geometry.pitch_m();
        let aperture = Asked {
            rises: true,
            best: camera.f_number / instrument::FASTEST_F_NUMBER,
            cap: well(0.5, false),
            ratio: &|factor| {
                let var_diffraction_px2 = match every.var_diffraction_px2 {
                    0.0 => 0.0,
                    _ => self.var_diffraction_m2(aperture_m * factor)? / (pitch * pitch),
                };
                (every.ratio)(Change { photons: factor * factor, var_diffraction_px2, ..as_it_is })
            },
            ratio_now: every.ratio_now,
            close: every.close,
        };
        let noise = Asked {
            rises: false,
            best: 1e-30,
            cap: None,
            ratio: &|factor| (every.ratio)(Change { noise: factor * factor, ..as_it_is }),
            ratio_now: every.ratio_now,
            close: every.close,
        };
        let of =
            |asked: Asked<'_>, first: &Option<DepthSolution>| first.clone().map(|first| asked.of_all(first));
        Ok(Some(DepthSolutions {
            baseline_m,
            exposure_s: of(exposure, &first.exposure_s),
            aperture_m: of(aperture, &first.aperture_m),
            noise_counts: of(noise, &first.noise_counts),
            ..first
        }))
    }

    fn exposure_noise(&self, camera: &instrument::Camera) -> Result<ExposureNoise> {
        Ok(ExposureNoise {
            exposure_s: camera.exposure_s,
            noise_exposure_s: camera.noise_exposure_s / f64::from(camera.frames),
            flicker_fraction: camera.lasting_share()?,
        })
    }

    /// Each quantity for one window, seen in a rendered pair or in cubes.
    fn of_window(
        &self,
        (row, column): (usize, usize),
        depth_m: f64,
        every: &Every<'_>,
    ) -> Result<Option<DepthSolutions>> {
        let pair = every.pair;
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
        let image = match every.var_diffraction_px2 {
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
        let exposure = camera.map(|camera| task.exposure(self.exposure_noise(camera)?));
        Ok(Some(DepthSolutions {
            signal: DECIDES,
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
