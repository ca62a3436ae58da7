//! A camera with a lens and all filters that it could have, as bands of one study in every scene.
//!
//! A camera whose well would overflow is tried at exposures a factor 2 apart, each with the filters that do not fill it.

use super::candidates::Candidate;
use super::judged::Best;
use super::results::{Choice, Failed, FilterUsed, LensUsed, Why};
use super::supply::Supply;
use crate::{Study, camera};
use hadar::error::Result;
use hadar::instrument::{Camera, CameraSpec, Price};
use hadar::material::Library;
use hadar::policy::Motion;
use hadar::units::Spectral;
use hadar_scenario::{BandSource, Scenario};

/// Share of the full well that an exposure is shortened to.
const FULL: f64 = 0.9;
/// Exposures that a camera whose well would overflow is tried at lie so far apart.
const LADDER: f64 = 2.0;
/// Relative difference of exposures that is rounding.
const SAME: f64 = 1e-9;

/// A scene before a camera.
pub(super) struct Scene {
    /// As it is asked.
    pub(super) scenario: Scenario,
    /// Behind all filters.
    pub(super) study: Study,
}

/// A camera with a lens and all filters that it could have, in every scene.
pub(super) struct Wheel<'a> {
    pub(super) candidate: &'a Candidate,
    /// The first is the question's own.
    pub(super) scenes: Vec<Scene>,
    /// What each band is.
    pub(super) filters: Vec<FilterUsed>,
    /// The first filter that may stand beside each one and behind it.
    pub(super) next: Option<Vec<usize>>,
    exposure_s: Option<f64>,
    /// What each filter costs.
    filter_price: Option<Price>,
    pub(super) kind: WheelKind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum WheelKind {
    /// Filters of which some are chosen.
    Filters,
    /// Bands of its own.
    Own,
    /// No filter lies in its range.
    Nothing,
}

impl<'a> Wheel<'a> {
    /// In some scenes, of which there is one at least; a camera whose well would overflow at several exposures, each with the filters
    /// that do not fill it.
    pub(super) fn all(
        candidate: &'a Candidate,
        questions: &[Scenario],
        supply: &mut Supply<'_>,
        library: &Library,
    ) -> Result<Vec<Self>> {
        let mut inside = supply.inside(&candidate.made);
        let mut whole = Self::new(candidate, None, &inside, questions, supply, library);
        if whole.is_err() && candidate.made.spectral_bands.is_none_or(|bands| bands == 1) {
            // A table of the camera that ends within a filter is no reason against the others.
            let all = std::mem::take(&mut inside);
            for w in all {
                if Self::new(candidate, None, &[w], questions, supply, library).is_ok() {
                    inside.push(w);
                }
            }
            if !inside.is_empty() {
                whole = Self::new(candidate, None, &inside, questions, supply, library);
            }
        }
        let whole = whole?;
        let Some(made) = whole.first().study.camera.clone().filter(|_| whole.kind != WheelKind::Nothing)
        else {
            return Ok(vec![whole]);
        };
        let Some(full) = made.full_well.filter(|full| whole.brightest(&made) > *full) else {
            return Ok(vec![whole]);
        };
        if whole.kind == WheelKind::Own {
            let longest_s = made.exposure_s * FULL * full / whole.brightest(&made);
            return Ok(vec![Self::new(candidate, Some(longest_s), &inside, questions, supply, library)?]);
        }
        // The longest exposure of each filter by itself.
        let mut longest_s = Vec::with_capacity(inside.len());
        for at in 0..inside.len() {
            let mut brightest: f64 = 0.0;
            for scene in &whole.scenes {
                brightest = brightest.max(scene.study.with_bands_alone(&[at])?.brightest_member(&made));
            }
            longest_s.push(if brightest > full {
                made.exposure_s * FULL * full / brightest
            } else {
                made.exposure_s
            });
        }
        let is_fixed =
            questions.iter().any(|asked| asked.camera.as_ref().is_some_and(|own| own.exposure_s.is_some()));
        let mut exposures_s = vec![made.exposure_s];
        if !is_fixed {
            let mut at_s = longest_s.iter().copied().fold(f64::INFINITY, f64::min);
            exposures_s.clear();
            while at_s < made.exposure_s {
                exposures_s.push(at_s);
                at_s *= LADDER;
            }
            exposures_s.push(made.exposure_s);
        }
        let mut wheels = Vec::with_capacity(exposures_s.len());
        for exposure_s in exposures_s {
            let fits =
                |(w, longest_s): (&usize, &f64)| (exposure_s <= longest_s * (1.0 + SAME)).then_some(*w);
            let kept: Vec<usize> = inside.iter().zip(&longest_s).filter_map(fits).collect();
            if !kept.is_empty() {
                let own_s = (exposure_s != made.exposure_s).then_some(exposure_s);
                wheels.push(Self::new(candidate, own_s, &kept, questions, supply, library)?);
            }
        }
        Ok(if wheels.is_empty() { vec![whole] } else { wheels })
    }

    /// With some of the filters, at an exposure of its own or that of the camera.
    fn new(
        candidate: &'a Candidate,
        exposure_s: Option<f64>,
        inside: &[usize],
        questions: &[Scenario],
        supply: &mut Supply<'_>,
        library: &Library,
    ) -> Result<Self> {
        let camera = &candidate.made;
        let (source, kind) = match camera.spectral_bands.filter(|bands| *bands > 1) {
            Some(bands) => (own_grid(camera, bands), WheelKind::Own),
            None if inside.is_empty() => (BandSource::Unsaid, WheelKind::Nothing),
            None => (supply.source(inside), WheelKind::Filters),
        };
        let mut scenes = Vec::with_capacity(questions.len());
        for (place, question) in questions.iter().enumerate() {
            let mut scenario = question.clone();
            scenario.find = None;
            let spec =
                CameraSpec { exposure_s: exposure_s.or(candidate.spec.exposure_s), ..candidate.spec.clone() };
            let made = camera::resolved(&spec, &scenario.source)?;
            scenario.camera = Some(spec);
            scenario.bands.source = source.clone();
            let study = match (&camera.efficiency_curves[..], kind) {
                ([], WheelKind::Filters) => supply.seen_by(made, inside, (place, &scenario), library)?,
                _ => Study::with_members(&scenario, library)?.with_means()?,
            };
            scenes.push(Scene { scenario, study });
        }
        let next = supply.next(inside);
        let filter_price = supply.spec.filters.price.clone();
        let mut wheel = Self { candidate, scenes, filters: Vec::new(), next, exposure_s, filter_price, kind };
        let bands = wheel.first().study.open_bands.bands();
        let filters = bands.iter().map(|band| FilterUsed {
            name: band.name.clone(),
            range_um: [1e4 / band.high_cm1, 1e4 / band.low_cm1],
        });
        wheel.filters = filters.collect();
        Ok(wheel)
    }

    /// The question's own scene.
    pub(super) fn first(&self) -> &Scene {
        &self.scenes[0]
    }

    /// How often the distances of a scene count beside those of the first.
    pub(super) fn scale(&self, scene: usize) -> f64 {
        self.first().study.required / self.scenes[scene].study.required
    }

    /// Counts of the fullest reading in any scene.
    pub(super) fn brightest(&self, camera: &Camera) -> f64 {
        self.scenes.iter().map(|scene| scene.study.brightest_member(camera)).fold(0.0, f64::max)
    }

    pub(super) fn failed(&self, why: Why, best: Option<&Best>) -> Failed {
        Failed {
            camera: self.candidate.camera.clone(),
            lens: self.candidate.lens.clone(),
            why,
            lower: best.map(|best| best.judged.lower),
            upper: best.map(|best| best.judged.upper),
        }
    }

    /// Apparent motion while so many bands are exposed, pixels; 0 where nothing moves, none where it is not known.
    pub(super) fn blur(&self, camera: &Camera, bands: usize) -> Option<f64> {
        let Some(speed) = self.first().scenario.requirement.speed_m_s else { return Some(0.0) };
        let motion = Motion::of(camera, self.first().scenario.target.distance_m)?;
        Some(motion.blur_pixels(speed, camera.sweep_s(bands)))
    }

    /// Whether so many bands and frames are read in time and without a blur.
    pub(super) fn is_in_time(&self, camera: &Camera, bands: usize) -> bool {
        let is_late = |time_s: f64| camera.acquisition_s(bands) > time_s;
        !self.first().scenario.requirement.time_s.is_some_and(is_late)
            && self.blur(camera, bands).is_some_and(|blur| blur < 1.0)
    }

    /// The choice as it is listed.
    pub(super) fn choice(&self, best: &Best) -> Choice {
        let (candidate, camera) = (self.candidate, at_frames(&self.candidate.made, best.frames));
        let camera = Camera { exposure_s: self.exposure_s.unwrap_or(camera.exposure_s), ..camera };
        let mut scenario = self.first().scenario.clone();
        let filters: Vec<FilterUsed> = match self.kind {
            WheelKind::Filters => best.chosen.iter().filter_map(|w| self.filters.get(*w).cloned()).collect(),
            _ => Vec::new(),
        };
        match &mut scenario.bands.source {
            BandSource::Filters(of) => {
                of.names = Some(filters.iter().filter_map(|filter| filter.name.clone()).collect());
            }
            BandSource::Ranges(ranges) => {
                *ranges = filters.iter().map(|filter| filter.range_um.map(Spectral::Wavelength)).collect();
            }
            _ => {}
        }
        if let Some(spec) = scenario.camera.as_mut() {
            spec.frames = Some(best.frames);
        }
        let lens = candidate.lens.clone().unwrap_or(LensUsed {
            name: None,
            f_number: camera.f_number,
            focal_length_m: camera.focal_length_m,
            document: None,
        });
        let (mut price, mut price_without) = (candidate.price.clone(), candidate.price_without.clone());
        match (&price, &self.filter_price) {
            (Some(own), Some(each)) if !filters.is_empty() => price = own.and(&each.times(filters.len())),
            (Some(_), None) if !filters.is_empty() => price_without.push("filters"),
            _ => {}
        }
        Choice {
            camera: candidate.camera.clone(),
            bands: best.chosen.len(),
            frames: best.frames,
            exposure_s: self.exposure_s,
            time_s: camera.acquisition_s(best.chosen.len()),
            aperture_m: lens.focal_length_m / lens.f_number,
            lens,
            filters,
            price,
            price_without,
            required_distance: self.first().study.required,
            lower: best.judged.lower,
            upper: best.judged.upper,
            limiting: String::new(),
            verdict: None,
            warnings: Vec::new(),
            scenario,
            rule: None,
            of_rule: None,
        }
    }
}

/// The bands of a spectrometer: so many over its range.
fn own_grid(camera: &Camera, bands: u32) -> BandSource {
    let [low, high] = camera.spectral_range_cm1;
    let step = (high - low) / f64::from(bands);
    let [start, stop, step] = [low + 0.5 * step, high - 0.5 * step, step].map(Spectral::Wavenumber);
    if bands < 2 { BandSource::Unsaid } else { BandSource::Grid { start, stop, step } }
}

/// A camera that adds up so many frames.
pub(super) fn at_frames(camera: &Camera, frames: u32) -> Camera {
    Camera { frames, ..camera.clone() }
}
