//! The answer in a sentence, what diffraction adds, and what the reader must know.

use super::Overfull;
use super::looked_up::{RangeStudy, SECTIONS};
use super::results::{BoundMaps, DepthFinding, DepthVerdict, ObjectBounds, Ranging, Signal, SignalBounds};
use super::subject::{Depth, Measured, Resolved};
use super::watched::Tally;
use crate::rests_on::of_stereo;
use crate::{Condition, Warning};
use hadar::cube::Shape;
use hadar::demand::{Reason, Thing};
use hadar::error::Result;
use hadar::ranging::information::Cell;
use hadar::ranging::information::decide::{Stats, decide};
use hadar::ranging::noise::Joined;
use hadar_formats::cube::SampleUnit;
use hadar_scenario::range::Subject;
use std::f64::consts::PI;

/// A gain of the scattered signal over the heat cube by more than rounding.
const BEYOND: f64 = 1.0 + 1e-9;

impl RangeStudy {
    /// σ_d², pixel²: the diffraction that the image does not have in it. The pixel's own size is in the image: it is a mean
    /// over pixels.
    pub(super) fn var_diffraction_px2(&self) -> Result<f64> {
        let aperture_m =
            self.camera.as_ref().map_or(f64::NAN, |camera| camera.focal_length_m / camera.f_number);
        let var_m2 = self
            .var_diffraction_m2(aperture_m)
            .map_err(|error| error.at(self.scenario.place("stereo.diffraction")))?;
        let pitch = self.geometry.pitch_m();
        Ok(var_m2 / (pitch * pitch))
    }

    /// Yes or no by proofs alone: for a cube of one depth and one view, where every window has the same requirement. `None` where
    /// it takes the bounds themselves. Samples that no proof needed are not checked.
    pub(super) fn verdict_alone(&self, shape: Shape) -> Result<Option<Ranging>> {
        let Resolved::Cube(cube) = &self.subject else { return Ok(None) };
        let (Some(Depth::Uniform(depth_m)), None) = (&cube.depth, &cube.right) else { return Ok(None) };
        // Whether all readings fit into the well takes all samples.
        if self.camera.as_ref().is_some_and(|camera| camera.full_well.is_some()) {
            return Ok(None);
        }
        let var_diffraction_px2 = self.var_diffraction_px2()?;
        if var_diffraction_px2 != 0.0 || self.scenario.stereo.joined == Joined::OneReading {
            return Ok(None);
        }
        let requirement = self.scenario.requirement;
        let allowed_px = requirement.error.at(*depth_m) / self.geometry.depth_error_m(*depth_m, 1.0)?;
        let noise = cube.noise_per_unit()?;
        let request = self.request(noise.as_ref().unwrap_or(&cube.noise), &[Cell::Full], shape);
        // δd² = 2/J ≤ allowed².
        let required = 2.0 / (allowed_px * allowed_px) / cube.photons_per_unit;
        // Where a count is missing, or worse, all windows are looked at: they say what is wrong, if anything is.
        let Ok(decision) = decide(&cube.left, &request, required) else { return Ok(None) };
        let windows = decision.above.len();
        let share = decision.above.iter().filter(|above| **above).count() as f64 / windows.max(1) as f64;
        let met = share >= requirement.share;
        let verdict = DepthVerdict {
            met: Some(met),
            sentence: self.judged(Some(met), share, (Signal::HeatCube, None), [windows; 2]),
            share: Some(share),
            required_share: requirement.share,
            signal: Signal::HeatCube,
            windows,
            windows_of: windows,
            conditions: Vec::new(),
            accepted: Vec::new(),
        };
        let verdict = self.resting(verdict, None);
        let mut stats = self.looked_up.clone().and(&decision.stats.work(shape.len()));
        stats.compute(Thing::Sections, 1);
        stats.spare(Thing::Sections, Reason::NotAsked, SECTIONS - 1);
        Ok(Some(Ranging {
            scenario: self.scenario.clone(),
            verdict,
            read: Some(cube.read.clone()),
            shape,
            geometry: self.geometry(var_diffraction_px2)?,
            objects: Vec::new(),
            cells: None,
            solve_for: None,
            lines: Vec::new(),
            matched: Vec::new(),
            quantile_error: None,
            bad: self.bad(),
            missing_windows: 0,
            maps_begin_at: None,
            stats,
            warnings: {
                let unseen = self.unseen(&decision.stats, shape, required * cube.photons_per_unit);
                cube.said().into_iter().chain(unseen).collect()
            },
            maps: BoundMaps::default(),
        }))
    }

    /// What proofs leave unsaid: samples that were not looked at, and the noise that measured counts have of their own.
    fn unseen(&self, stats: &Stats, shape: Shape, required_per_px2: f64) -> Vec<Warning> {
        let mut warnings = Vec::new();
        if stats.samples_evaluated < stats.samples_total {
            let (evaluated, samples) = (stats.samples_evaluated, stats.samples_total);
            warnings.push(Warning::SamplesNotChecked { evaluated, samples });
        }
        let floor_per_px2 = noise_floor(self, shape);
        let demanded_per_px2 = required_per_px2;
        if floor_per_px2 > 0.02 * demanded_per_px2 {
            warnings.push(Warning::NoiseOfDemanded { floor_per_px2, demanded_per_px2 });
        }
        warnings
    }

    /// The verdict on all windows, of which a cube has `windows_of`, judged or not: yes where those that reach the demand are enough of all,
    /// no where those that could not be judged would not be enough with them, else undecided.
    pub(super) fn verdict(
        &self,
        all: Option<&ObjectBounds>,
        windows_of: Option<usize>,
    ) -> Result<DepthVerdict> {
        let by = |signal: Signal| all.and_then(|all| all.signals.iter().find(|found| found.signal == signal));
        // Windows that reach it, of all.
        let reach = |found: &SignalBounds| {
            let reach = (found.share? * found.windows as f64).round();
            let of = windows_of.unwrap_or(found.windows).max(found.windows);
            Some((reach, of, if of == found.windows { found.share? } else { reach / of as f64 }))
        };
        // Bands joined in the detector are read once: with much noise the image then tells more than the cube.
        let share_of = |signal: Signal| by(signal).and_then(|found| found.share).unwrap_or(-1.0);
        let image_tells_more = self.scenario.stereo.joined == Joined::OneReading
            && share_of(Signal::ThermalImage) > share_of(Signal::HeatCube);
        let signal = if image_tells_more { Signal::ThermalImage } else { Signal::HeatCube };
        let cube = by(signal);
        let required = self.scenario.requirement.share;
        let judged = cube.map_or(0, |found| found.windows);
        let (mut met, mut share, mut windows_of) = (None, None, windows_of.unwrap_or(judged).max(judged));
        let sentence = match (cube.and_then(reach), cube) {
            (Some((met_by, of, own)), Some(_)) => {
                let at_most = (met_by + (of - judged) as f64) / of as f64;
                met = match () {
                    () if own >= required => Some(true),
                    () if judged == of || at_most < required => Some(false),
                    () => None,
                };
                (share, windows_of) = (Some(own), of);
                let other = by(if image_tells_more { Signal::HeatCube } else { Signal::ThermalImage });
                let beside = other.and_then(|other| Some((other.signal, reach(other)?.2)));
                self.judged(met, own, (signal, beside), [judged, of])
            }
            (None, Some(cube)) => DepthFinding::NoDepth { disparity_error_px: cube.disparity_error_px },
            (_, None) => DepthFinding::NoBound,
        };
        Ok(DepthVerdict {
            met,
            sentence,
            share,
            required_share: required,
            signal,
            windows: judged,
            windows_of,
            conditions: Vec::new(),
            accepted: Vec::new(),
        })
    }

    /// A verdict with what it rests on, the brightest reading holding so many photons: one that does not fit into the well meets nothing.
    pub(super) fn resting(&self, mut verdict: DepthVerdict, brightest: Option<f64>) -> DepthVerdict {
        let (camera, brightest) = (self.camera.as_ref(), brightest.or_else(|| self.brightest_of_cube()));
        let full = brightest.zip(camera).and_then(|(counts, camera)| Overfull::of(counts, camera));
        let DepthFinding::Judged { met, overfull, conditions, .. } = &mut verdict.sentence else {
            return verdict;
        };
        if let Some(full) = full {
            (verdict.met, *met) = (Some(false), Some(false));
            *overfull = Some([full.counts, full.full_well]);
        }
        let more = match &self.subject {
            Resolved::Scene(_) => vec![Condition::NoAir, Condition::OneScene],
            Resolved::Cube(cube) => self.of_cube(cube),
        };
        let bands = self.bands.as_ref().map_or(1, hadar::spectrum::Bands::len);
        let camera = camera.map(|camera| (camera, bands, brightest));
        *conditions = of_stereo(camera, more, &self.scenario.source.settings, verdict.met == Some(true));
        verdict.conditions.clone_from(conditions);
        verdict
    }

    /// Photons of the largest sample that was looked at in the views of a cube, of one of its camera's frames.
    fn brightest_of_cube(&self) -> Option<f64> {
        let Resolved::Cube(cube) = &self.subject else { return None };
        let tallies = cube.watches.iter().map(|watch| watch.tally()).filter(|tally| tally.pixels > 0);
        let most = tallies.map(|tally| tally.most).reduce(f64::max)?;
        Some(most * cube.photons_per_unit / f64::from(self.camera.as_ref()?.frames))
    }

    /// What nobody stated of a cube.
    fn of_cube(&self, cube: &Measured) -> Vec<Condition> {
        let Subject::Cube(spec) = &self.scenario.subject else { return Vec::new() };
        let says_photons = cube.read.unit.as_deref().is_some_and(|unit| {
            SampleUnit::spelt(unit) == SampleUnit::Counts && !SampleUnit::says_nothing(unit)
        });
        let is_silent = spec.noise.is_none() && self.camera.is_none();
        let is_unit_open = spec.photons_per_unit.is_none() && !says_photons;
        [
            is_silent.then_some(Condition::ShotNoiseAlone),
            is_unit_open.then_some(Condition::SamplesArePhotons),
            Some(Condition::ExpectedCounts),
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    fn judged(
        &self,
        met: Option<bool>,
        share: f64,
        (signal, beside): (Signal, Option<(Signal, f64)>),
        windows: [usize; 2],
    ) -> DepthFinding {
        let requirement = self.scenario.requirement;
        DepthFinding::Judged {
            met,
            error: requirement.error,
            share,
            required_share: requirement.share,
            signal,
            beside,
            windows,
            overfull: None,
            conditions: Vec::new(),
        }
    }
}

impl RangeStudy {
    /// The brightest pixel, where it holds more than its well.
    pub(crate) fn overfull(&self, result: &Ranging) -> Option<Overfull> {
        Overfull::of(result.maps.brightest?, self.camera.as_ref()?)
    }
}

/// What the reader must know.
pub(super) fn warnings(study: &RangeStudy, result: &Ranging) -> Vec<Warning> {
    let mut warnings = match &study.subject {
        Resolved::Cube(cube) => cube.said(),
        Resolved::Scene(_) => Vec::new(),
    };
    if study.camera.as_ref().is_some_and(|camera| camera.pattern.is_shared()) {
        warnings.push(Warning::PatternOfEachPixel);
    }
    if result.missing_windows > 0 {
        let of = [result.maps.rows.len(), result.maps.columns.len()].iter().product();
        warnings.push(Warning::WindowsMissing { windows: result.missing_windows, of });
    }
    let Some(all) = result.objects.first() else { return warnings };
    let by = |signal: Signal| all.signals.iter().find(|found| found.signal == signal);
    if let (Some(cube), Some(alone)) = (by(Signal::HeatCube), by(Signal::ScatteredAsMeasured))
        && alone.disparity_error_px * BEYOND < cube.disparity_error_px
    {
        let ratio = cube.disparity_error_px / alone.disparity_error_px;
        warnings.push(Warning::ScatteredAsMeasured { ratio });
    }
    for found in all.signals.iter().filter(|found| found.windows < all.windows) {
        let (signal, left_out) = (found.signal.name(), all.windows - found.windows);
        warnings.push(Warning::DarkSamples { signal, left_out, windows: all.windows });
    }
    warnings.extend(study.overfull(result).map(Overfull::remark));
    if let Resolved::Cube(_) = &study.subject
        && let Some(cube) = by(Signal::HeatCube)
    {
        let floor_per_px2 = noise_floor(study, result.shape);
        let found_per_px2 = cube.information_per_px2;
        // Without texture there is no noise in the counts either.
        if found_per_px2 > 0.0 && floor_per_px2 > 0.02 * found_per_px2 {
            warnings.push(Warning::NoiseOfFound { floor_per_px2, found_per_px2 });
        }
        if result.objects.iter().all(|object| object.depth_m.is_none()) {
            warnings.push(Warning::NoDepth);
        }
    }
    if let Some(ratio) = result.cells.and_then(|cells| cells.other_derivative)
        && !(0.5..=2.0).contains(&ratio)
    {
        warnings.push(Warning::Derivative { ratio });
    }
    let bands = study.bands.as_ref().map_or(0, hadar::spectrum::Bands::len);
    if bands < 3 && by(Signal::Reconstructed).is_some() {
        warnings.push(Warning::FewBands { bands });
    }
    warnings
}

/// Share of the pixels at one value, and their number, from which on it is no accident.
const MANY: (f64, usize) = (1e-3, 10);
/// Share of the pixels that are dark from which on it is said.
const DARK: f64 = 0.01;

impl Measured {
    /// What the files say that is in doubt, and what was seen of their samples.
    fn said(&self) -> Vec<Warning> {
        let mut said = self.warnings.clone();
        for (view, found) in ["left", "right"].into_iter().zip(&self.bad) {
            let of = found.map.len();
            let pixels = found.pixels.iter().filter(|bad| bad.why != "missing");
            said.extend(pixels.map(|bad| Warning::ViewFoundBad {
                view,
                pixels: bad.pixels,
                of,
                why: bad.why,
            }));
        }
        for (view, watch) in ["left", "right"].into_iter().zip(&self.watches) {
            let Tally { pixels, most, at_most, dark } = watch.tally();
            if dark > 0 && dark as f64 >= DARK * pixels as f64 {
                said.push(Warning::CubeDark { view, pixels: dark, of: pixels });
            }
            let (share, number) = MANY;
            if most > 0.0 && at_most >= number && at_most as f64 >= share * pixels as f64 {
                let largest = (view == "left").then(|| self.read.largest_stored()).flatten() == Some(most);
                said.push(Warning::CubeSaturated { view, pixels: at_most, of: pixels, value: most, largest });
            }
        }
        said
    }
}

/// Information that noise of N + σ² in each sample would make, pixel⁻²: Σ of the squared taps for every sample.
fn noise_floor(study: &RangeStudy, shape: Shape) -> f64 {
    // By Parseval: the mean of (ω·response)² over all frequencies.
    const FREQUENCIES: usize = 1000;
    let scheme = study.scenario.stereo.derivative;
    let squared = |i: usize| {
        let omega = PI * (i as f64 + 0.5) / FREQUENCIES as f64;
        (omega * scheme.response(omega).unwrap_or(f64::NAN)).powi(2)
    };
    let per_sample = (0..FREQUENCIES).map(squared).sum::<f64>() / FREQUENCIES as f64;
    let window = study.scenario.stereo.window;
    per_sample * (window.rows() * window.columns() * shape.bands()) as f64
}
