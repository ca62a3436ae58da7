//! What would just meet the demand, asked of all windows.
//!
//! A quantity is solved for one window, that at the demanded share in the order of the windows' errors over what is allowed them.
//! The order changes with the quantity, so the answer is put in: all windows are looked at there, the window that is at the share
//! then is solved for, and so on, between the nearest value that does and the nearest that does not, which are halved where that leads
//! out of them. What is given does, and is [`CLOSE`] to what does not.
//!
//! With k times the photons and q times the variance of the noise J(kN, qσ²) = k J(N, qσ²/k): one pass over the samples. What all
//! windows say is monotone in exposure, aperture and noise, since each is (flicker grows no faster than the square of the photons);
//! with the baseline the pixels that are compared shift, and fewer windows are seen by both.

use super::bounds::Ground;
use super::signals::{self, SignalMap};
use super::subject::{Resolved, Truth};
use super::{Informed, RangeStudy};
use hadar::cube::{Cube, MemoryCube, Shape};
use hadar::error::Result;
use hadar::ranging::depth::{DepthSolution, StereoGeometry};
use hadar::ranging::information::{Cell, information};
use hadar::ranging::noise::NoiseVariance;
use hadar_simulate::render::Part;
use std::ops::Range;

/// Relative distance of the value that is given from one that does not do.
pub(super) const CLOSE: f64 = 1e-9;
/// Passes over all windows for one quantity, at most.
const PASSES: usize = 60;
/// Factor by which a side without a value is looked for.
const STRIDE: f64 = 4.0;

/// What a quantity changes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Change {
    /// Factors of the photons and of the variance of the electronic noise.
    pub(super) photons: f64,
    pub(super) noise: f64,
    pub(super) var_diffraction_px2: f64,
    pub(super) geometry: StereoGeometry,
}

/// All windows at one value.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen {
    /// Whether enough of them reach the demand.
    pub(super) met: bool,
    /// The window that decides, and its depth.
    pub(super) window: (usize, usize),
    pub(super) depth_m: f64,
}

/// A quantity that is solved for by its factor over the camera's own value.
pub(super) struct Asked<'a> {
    /// Whether a larger value does better.
    pub(super) rises: bool,
    /// The factor that does best of all.
    pub(super) best: f64,
    /// The factor beyond which something else than the demand fails, and what to say of it.
    pub(super) cap: Option<(f64, String)>,
    /// All windows at a factor; `None` where none is left.
    pub(super) seen: &'a dyn Fn(f64) -> Result<Option<Seen>>,
    /// The factor at which a window just does, if any.
    pub(super) of_window: &'a dyn Fn(Seen) -> Result<Option<f64>>,
    /// How near to a value that does not do what is given must be.
    pub(super) close: f64,
}

impl Asked<'_> {
    /// `first`, a solution of one window, solved on until it holds for all.
    pub(super) fn of_all(&self, first: DepthSolution) -> Result<DepthSolution> {
        let camera = first.camera;
        // A quantity that is 0 has no factor.
        if !(camera > 0.0 && first.sigma_z_m.is_finite()) {
            return Ok(first);
        }
        let none = |first: DepthSolution, reason: Option<String>| {
            let mut none = first;
            none.value = None;
            none.reason = reason.or(none.reason);
            none
        };
        let mut at = match first.value {
            Some(value) if value > 0.0 => value / camera,
            // What cannot be looked at does not do.
            _ if (self.seen)(self.best).is_ok_and(|seen| seen.is_some_and(|seen| seen.met)) => self.best,
            _ => return Ok(none(first, None)),
        };
        let (mut does, mut does_not): (Option<f64>, Option<f64>) = (None, None);
        for _ in 0..PASSES {
            let seen = (self.seen)(at).unwrap_or(None);
            match seen {
                Some(Seen { met: true, .. }) => does = Some(at),
                _ => does_not = Some(at),
            }
            if let (Some(a), Some(b)) = (does, does_not)
                && (a / b).ln().abs() <= self.close
            {
                break;
            }
            let solved = seen.map(|seen| (self.of_window)(seen)).transpose()?.flatten();
            at = self.next(at, solved, does, does_not);
        }
        let Some(found) = does else { return Ok(none(first, None)) };
        if let Some((most, reason)) = &self.cap
            && found > *most
        {
            return Ok(none(first, Some(reason.clone())));
        }
        let mut solution = first;
        (solution.value, solution.reason) = (Some(camera * found), None);
        Ok(solution)
    }

    /// Where to look next: at what the deciding window asks for, a little beyond it on the side that is not known yet, else half way.
    fn next(&self, at: f64, solved: Option<f64>, does: Option<f64>, does_not: Option<f64>) -> f64 {
        let better = if self.rises { 1.0 } else { -1.0 };
        match (does, does_not) {
            (Some(a), Some(b)) => {
                let inside = |x: &f64| (x / a).ln() * (x / b).ln() < 0.0;
                // The value itself may do or not by rounding: just beside it, towards the side that is further off.
                let beside = |x: f64| {
                    let towards = if (x / a).ln().abs() > (x / b).ln().abs() { a } else { b };
                    x * (1.0 + 0.25 * self.close * (towards / x).ln().signum())
                };
                solved.filter(inside).map(beside).filter(inside).unwrap_or((a * b).sqrt())
            }
            // Nothing that fails is known: a little worse than what the window asks for, or much worse.
            (Some(_), None) => match solved.filter(|x| (x / at).ln() * better < -self.close) {
                Some(solved) => solved,
                None if solved.is_some_and(|x| (x / at).ln().abs() <= self.close) => {
                    at * (-better * 0.5 * self.close).exp()
                }
                None => at * STRIDE.powf(-better),
            },
            _ => match solved.filter(|x| (x / at).ln() * better > self.close) {
                Some(solved) => solved,
                None if solved.is_some_and(|x| (x / at).ln().abs() <= self.close) => {
                    at * (better * 0.5 * self.close).exp()
                }
                None => at * STRIDE.powf(better),
            },
        }
    }
}

impl RangeStudy {
    /// All windows of a rendered pair or of cubes with a change.
    pub(super) fn seen_with(
        &self,
        informed: &Informed,
        shape: Shape,
        change: Change,
    ) -> Result<Option<Seen>> {
        let moved = change.geometry.baseline_m() != self.geometry.baseline_m();
        let drawn = match (&self.subject, &self.bands) {
            (Resolved::Scene(scene), Some(bands)) if moved => {
                let rig =
                    hadar_simulate::render::Rig { baseline_m: change.geometry.baseline_m(), ..scene.rig };
                Some(scene.scene.render(&rig, bands, &scene.options, &|_, _| ())?)
            }
            _ => None,
        };
        let pair = drawn.as_ref().or(informed.pair.as_ref());
        let ratio = change.noise / change.photons;
        let as_it_is = !moved && change.noise == 1.0 && change.photons == 1.0;
        let map = |left: bool| -> Result<Option<SignalMap>> {
            let known = if left { &informed.left } else { &informed.right };
            if as_it_is && let Some(known) = known.iter().find(|map| map.signal == signals::DECIDES) {
                return Ok(Some(known.clone()));
            }
            let of = |cube: &Cube, noise: &NoiseVariance, unit: f64| {
                let noise = scaled(noise, ratio)?;
                let map = information(cube, &self.request(&noise, &[Cell::Full], shape))?;
                let map = SignalMap::of(signals::DECIDES, Cell::Full, &map);
                Ok(Some(map.scaled(unit * change.photons)))
            };
            match (&self.subject, pair) {
                (Resolved::Scene(scene), Some(pair)) => {
                    let view = if left { &pair.left } else { &pair.right };
                    of(&scene.counts(view, Part::Total)?, &scene.noise, 1.0)
                }
                (Resolved::Cube(cube), _) => {
                    let view = if left { Some(&cube.left) } else { cube.right.as_ref() };
                    let noise = cube.noise_per_unit()?;
                    let noise = noise.as_ref().unwrap_or(&cube.noise);
                    view.map_or(Ok(None), |view| of(view, noise, cube.photons_per_unit))
                }
                (Resolved::Scene(_), None) => Ok(None),
            }
        };
        let (Some(left), right) = (map(true)?, map(false)?) else { return Ok(None) };
        let own_truth = match (&self.subject, &drawn) {
            (Resolved::Scene(scene), Some(pair)) => Some(Truth::of_scene(&scene.scene, &pair.left)),
            _ => None,
        };
        let truth = own_truth.as_ref().unwrap_or(&informed.truth);
        let ground = Ground {
            geometry: &change.geometry,
            requirement: self.scenario.requirement,
            var_diffraction_px2: change.var_diffraction_px2,
            truth,
            columns: shape.columns(),
        };
        let window = self.scenario.stereo.window;
        let windows = ground.windows(&left, [window.half_rows(), window.half_columns()]);
        let variances = ground.variances(&left, right.as_ref(), &windows);
        let Some((ratio, window, depth_m)) = ground.decisive(&windows, &variances)? else { return Ok(None) };
        Ok(Some(Seen { met: ratio <= 1.0, window, depth_m }))
    }

    /// Factor of the photons at which the brightest sample of a frame fills its well, if that is known.
    pub(super) fn photons_of_the_well(&self, informed: &Informed) -> Result<Option<(f64, f64)>> {
        let Some(full_well) = self.camera.as_ref().and_then(|camera| camera.full_well) else {
            return Ok(None);
        };
        let Some(pair) = &informed.pair else { return Ok(None) };
        Ok(self.brightest(pair)?.filter(|most| *most > 0.0).map(|most| (full_well / most, full_well)))
    }
}

/// Variances times a factor.
pub(super) fn scaled(noise: &NoiseVariance, factor: f64) -> Result<NoiseVariance> {
    Ok(match noise {
        NoiseVariance::None => NoiseVariance::None,
        NoiseVariance::Uniform(var) => NoiseVariance::Uniform(var * factor),
        NoiseVariance::PerBand(var) => NoiseVariance::PerBand(var.iter().map(|var| var * factor).collect()),
        NoiseVariance::PerSample(cube) => {
            let shape = cube.shape();
            let mut samples = as_f64(cube, 0..shape.rows())?;
            samples.iter_mut().for_each(|var| *var *= factor);
            NoiseVariance::PerSample(Cube::from(MemoryCube::new(shape, samples)?))
        }
    })
}

/// Samples of some rows of a cube.
pub(super) fn as_f64(cube: &Cube, rows: Range<usize>) -> Result<Vec<f64>> {
    Ok(match cube {
        Cube::F32(cube) => cube.read(rows, &mut Vec::new())?.iter().map(|n| f64::from(*n)).collect(),
        Cube::F64(cube) => cube.read(rows, &mut Vec::new())?.to_vec(),
    })
}

#[cfg(test)]
mod tests;
