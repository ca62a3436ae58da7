//! What would just meet the demand, asked of all windows.
//!
//! A quantity is solved for one window, that at the demanded share in the order of the windows' errors over what is allowed them.
//! The order changes with the quantity, so the answer is put in, all windows are looked at there, and ln of the error at the share is
//! followed over ln of the quantity by the secant (by halves where that is slow) to its crossing. What is given does, and is [`CLOSE`]
//! to what does not.
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

/// Relative distance, at most, of the value that is given from one that does not do.
pub(super) const CLOSE: f64 = 1e-6;
/// The same where each look renders the scene.
pub(super) const CLOSE_OF_RENDERED: f64 = 1e-3;
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

/// A quantity that is solved for by its factor over the camera's own value.
pub(super) struct Asked<'a> {
    /// Whether a larger value does better.
    pub(super) rises: bool,
    /// The factor that does best of all.
    pub(super) best: f64,
    /// The factor beyond which something else than the demand fails, and what to say of it.
    pub(super) cap: Option<(f64, String)>,
    /// The error at the demanded share of all windows over what is allowed, at a factor; `None` where no window is left.
    pub(super) ratio: &'a dyn Fn(f64) -> Result<Option<f64>>,
    /// The same as the camera is.
    pub(super) ratio_now: f64,
    /// How near to a value that does not do what is given must be.
    pub(super) close: f64,
}

/// A look at all windows: ln of the factor, and ln of the error over what is allowed there.
#[derive(Debug, Clone, Copy)]
struct Look {
    x: f64,
    f: f64,
}

impl Look {
    fn does(self) -> bool {
        self.f <= 0.0
    }
}

impl Asked<'_> {
    /// `first`, a solution of one window, solved on until it holds for all.
    pub(super) fn of_all(&self, first: DepthSolution) -> DepthSolution {
        let camera = first.camera;
        // A quantity that is 0 has no factor.
        if !(camera > 0.0 && first.sigma_z_m.is_finite()) {
            return first;
        }
        let none = |first: DepthSolution, reason: Option<String>| {
            let mut none = first;
            none.value = None;
            none.reason = reason.or(none.reason);
            none
        };
        let guess = match first.value {
            Some(value) if value > 0.0 => (value / camera).ln(),
            _ if self.look(self.best.ln()).does() => self.best.ln(),
            _ => return none(first, None),
        };
        let Some(found) = self.nearest_that_does(guess).map(f64::exp) else { return none(first, None) };
        if let Some((most, reason)) = &self.cap
            && found > *most
        {
            return none(first, Some(reason.clone()));
        }
        let mut solution = first;
        (solution.value, solution.reason) = (Some(camera * found), None);
        solution
    }

    /// What cannot be looked at does not do.
    fn look(&self, x: f64) -> Look {
        let ratio = (self.ratio)(x.exp()).ok().flatten().unwrap_or(f64::NAN);
        Look { x, f: if ratio.is_nan() { f64::INFINITY } else { ratio.ln() } }
    }

    /// The value that does, as ln of the factor, that is [`Self::close`] to one that does not; the first look is at `guess`.
    fn nearest_that_does(&self, guess: f64) -> Option<f64> {
        let mut last = Look { x: 0.0, f: self.ratio_now.ln() };
        let (mut does, mut does_not) = (last.does().then_some(last), (!last.does()).then_some(last));
        let (mut x, mut width) = (guess, [f64::INFINITY; 2]);
        for _ in 0..PASSES {
            let look = self.look(x);
            *(if look.does() { &mut does } else { &mut does_not }) = Some(look);
            let secant = look.x - look.f * (look.x - last.x) / (look.f - last.f);
            last = look;
            x = match (does, does_not) {
                (Some(a), Some(b)) => {
                    let between = (a.x - b.x).abs();
                    if between <= self.close {
                        break;
                    }
                    // Half way where two looks have not halved what is left.
                    let slow = between > 0.5 * width[0];
                    width = [width[1], between];
                    let inside = |x: &f64| (x - a.x) * (x - b.x) < 0.0;
                    // Beyond the crossing by less than what is asked for, so that it lies between two near looks.
                    let farther = if (secant - a.x).abs() > (secant - b.x).abs() { a.x } else { b.x };
                    let beyond = secant + 0.4 * self.close * (farther - secant).signum();
                    Some(beyond).filter(|x| !slow && inside(x)).unwrap_or(0.5 * (a.x + b.x))
                }
                (one, _) => {
                    // Nothing on the other side is known: where the last two looks point to, if that is farther, or a stride on.
                    let on = if self.rises == one.is_none() { 1.0 } else { -1.0 };
                    let stride = look.x + on * STRIDE.ln();
                    let ahead = secant + on * 0.4 * self.close;
                    Some(ahead).filter(|x| (x - look.x) * on > 0.0 && x.is_finite()).unwrap_or(stride)
                }
            };
        }
        does.map(|look| look.x)
    }
}

impl RangeStudy {
    /// The error at the demanded share of all windows over what is allowed, of a rendered pair or of cubes with a change.
    pub(super) fn ratio_with(
        &self,
        informed: &Informed,
        shape: Shape,
        change: Change,
    ) -> Result<Option<f64>> {
        let moved = change.geometry.baseline_m() != self.geometry.baseline_m();
        let drawn = match (&self.subject, &self.bands) {
            (Resolved::Scene(scene), Some(bands)) if moved => {
                let rig =
                    hadar_simulate::render::Rig { baseline_m: change.geometry.baseline_m(), ..scene.rig };
                Some(scene.scene.render(&rig, bands, &scene.options, &|_, _| ())?)
            }
            _ => None,
        };
        let pair = drawn.as_ref().or(informed.pair.as_deref());
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
            windows_of: self.windows_of(informed, shape),
        };
        let window = self.scenario.stereo.window;
        let windows = ground.windows(&left, [window.half_rows(), window.half_columns()]);
        let variances = ground.variances(&left, right.as_ref(), &windows);
        Ok(ground.decisive(&windows, &variances)?.map(|(ratio, ..)| ratio))
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
