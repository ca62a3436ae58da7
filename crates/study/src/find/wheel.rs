//! A camera with a lens and all filters that it could have, as bands of one study.
//!
//! The scene behind all filters is the same whatever the camera: it is looked up and integrated once, and every camera takes those of its
//! bands that lie in the range of its detector.

use super::candidates::Candidate;
use super::results::{Choice, Failed, FilterUsed, LensUsed, Why};
use super::searched::{Best, at_frames};
use crate::{Study, bands, camera};
use hadar::demand::{self, Reason, Thing};
use hadar::error::Result;
use hadar::instrument::{Camera, Price};
use hadar::material::Library;
use hadar::order;
use hadar::policy::Motion;
use hadar::spectrum::FilterCurve;
use hadar::units::Spectral;
use hadar_scenario::find::FilterSupply;
use hadar_scenario::{BandSource, FilterPlace, Filters, FindSpec, Scenario};

/// Share of the full well that an exposure is shortened to.
const FULL: f64 = 0.9;
/// Share by which an edge of a filter may lie beyond the range of a detector, as ranges are stated in two digits.
const BEYOND: f64 = 0.005;
/// Relative difference of wavelengths that is rounding.
const SAME: f64 = 1e-9;

/// The filters of a question, in the order of their bands.
pub(super) struct Supply<'q> {
    spec: &'q FindSpec,
    filters: Vec<Offered>,
    /// The scene behind all of them without a camera, with the sine of the cone that they stand in where that counts.
    scenes: Vec<(Option<f64>, Study)>,
}

/// A filter that may be chosen.
#[derive(Debug, Clone)]
struct Offered {
    name: Option<String>,
    /// Between half of its peak, µm.
    range_um: [f64; 2],
}

impl<'q> Supply<'q> {
    /// Those that lie in the range of any of the cameras.
    pub(super) fn of(spec: &'q FindSpec, candidates: &[Candidate]) -> Result<Self> {
        let mut filters = match &spec.filters.from {
            FilterSupply::List(list) => {
                let mut curves = bands::curves(list)?;
                // As bands are.
                order::ascending(&mut curves, |curve| curve.range_cm1().0);
                let offered = |curve: &FilterCurve| {
                    let [low, high] = curve.half_power_cm1();
                    Offered { name: Some(curve.name().to_owned()), range_um: [1e4 / high, 1e4 / low] }
                };
                curves.iter().map(offered).collect()
            }
            FilterSupply::Any { step_um } => free(*step_um, candidates),
        };
        filters.retain(|filter: &Offered| candidates.iter().any(|one| is_within(filter.range_um, &one.made)));
        Ok(Self { spec, filters, scenes: Vec::new() })
    }

    /// The bands that are these filters.
    fn source(&self, chosen: &[usize]) -> BandSource {
        let filters = chosen.iter().filter_map(|w| self.filters.get(*w));
        match &self.spec.filters.from {
            FilterSupply::List(list) => BandSource::Filters(Filters {
                list: list.clone(),
                names: Some(filters.filter_map(|filter| filter.name.clone()).collect()),
                place: self.spec.filters.place,
            }),
            FilterSupply::Any { .. } => {
                BandSource::Ranges(filters.map(|filter| filter.range_um.map(Spectral::Wavelength)).collect())
            }
        }
    }

    /// Places of those that lie in the range of a camera.
    fn inside(&self, camera: &Camera) -> Vec<usize> {
        (0..self.filters.len()).filter(|w| is_within(self.filters[*w].range_um, camera)).collect()
    }

    /// Of some free filters the first that may stand beside each one and behind it; none where any may.
    fn next(&self, inside: &[usize]) -> Option<Vec<usize>> {
        let FilterSupply::Any { .. } = self.spec.filters.from else { return None };
        let range = |w: &usize| self.filters[*w].range_um;
        // In the order of the bands what is behind lies at shorter wavelengths.
        let after = |w: &usize| inside.partition_point(|other| range(other)[1] > range(w)[0] * (1.0 + SAME));
        Some(inside.iter().map(after).collect())
    }

    /// The scene behind some of the filters as a camera sees it.
    fn seen_by(
        &mut self,
        candidate: &Candidate,
        inside: &[usize],
        scenario: &Scenario,
        library: &Library,
    ) -> Result<Study> {
        let is_in_cone = matches!(self.spec.filters.place, Some(FilterPlace::Sensor { .. }));
        let sine = is_in_cone.then(|| candidate.made.rim_sine());
        let place = match self.scenes.iter().position(|(known, _)| *known == sine) {
            Some(place) => {
                demand::spared(Thing::BandIntegrals, Reason::Shared, inside.len() as u64);
                place
            }
            None => {
                let mut bare = scenario.clone();
                bare.camera = None;
                bare.bands.source = self.source(&(0..self.filters.len()).collect::<Vec<_>>());
                self.scenes.push((sine, Study::with_members_in(&bare, library, sine)?.with_means()?));
                self.scenes.len() - 1
            }
        };
        let mut study = self.scenes[place].1.with_bands_alone(inside)?;
        let mut made = candidate.made.clone();
        made.sees(&study.open_bands);
        study.scenario.camera.clone_from(&scenario.camera);
        study.scenario.bands = scenario.bands.clone();
        study.camera = Some(made);
        (study.bands, study.air) = study.received(study.camera.as_ref(), study.scenario.target.distance_m)?;
        study.check_sight()?;
        Ok(study)
    }
}

/// All runs between edges in the ranges of some cameras, in the order of their bands: by lower wavenumber, then by upper.
fn free(step_um: f64, candidates: &[Candidate]) -> Vec<Offered> {
    let ranges = candidates.iter().map(|one| range_um(&one.made));
    let [short, long] =
        ranges.fold([f64::INFINITY, 0.0_f64], |[short, long], [a, b]| [short.min(a), long.max(b)]);
    let first = (short * (1.0 - BEYOND) / step_um).ceil().clamp(1.0, 1e4) as usize;
    let last = (long * (1.0 + BEYOND) / step_um).floor().clamp(0.0, 1e4) as usize;
    let run =
        |from: usize, to: usize| Offered { name: None, range_um: [from, to].map(|at| at as f64 * step_um) };
    (first + 1..=last).rev().flat_map(|to| (first..to).rev().map(move |from| run(from, to))).collect()
}

fn range_um(camera: &Camera) -> [f64; 2] {
    let [low, high] = camera.spectral_range_cm1;
    [1e4 / high, 1e4 / low]
}

fn is_within([from, to]: [f64; 2], camera: &Camera) -> bool {
    let [short, long] = range_um(camera);
    from >= short * (1.0 - BEYOND) && to <= long * (1.0 + BEYOND)
}

/// A camera with a lens and all filters that it could have, as bands of one study.
pub(super) struct Wheel<'a> {
    pub(super) candidate: &'a Candidate,
    pub(super) scenario: Scenario,
    pub(super) study: Study,
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
    pub(super) fn new(
        candidate: &'a Candidate,
        question: &Scenario,
        supply: &mut Supply<'_>,
        library: &Library,
    ) -> Result<Self> {
        let camera = &candidate.made;
        let mut scenario = question.clone();
        scenario.find = None;
        scenario.camera = Some(candidate.spec.clone());
        let inside = supply.inside(camera);
        let (source, kind) = match camera.spectral_bands.filter(|bands| *bands > 1) {
            Some(bands) => (own_grid(camera, bands), WheelKind::Own),
            None if inside.is_empty() => (BandSource::Unsaid, WheelKind::Nothing),
            None => (supply.source(&inside), WheelKind::Filters),
        };
        scenario.bands.source = source;
        let mut study = match (&camera.efficiency_curves[..], kind) {
            ([], WheelKind::Filters) => supply.seen_by(candidate, &inside, &scenario, library)?,
            _ => Study::with_members(&scenario, library)?.with_means()?,
        };
        let mut exposure_s = None;
        let is_fixed = question.camera.as_ref().is_some_and(|camera| camera.exposure_s.is_some());
        if let (Some(full), Some(made), false) = (camera.full_well, study.camera.clone(), is_fixed) {
            let brightest = study.brightest_member(&made);
            if let (true, Some(spec)) = (brightest > full, scenario.camera.as_mut()) {
                exposure_s = Some(made.exposure_s * FULL * full / brightest);
                spec.exposure_s = exposure_s;
                let mut made = camera::resolved(spec, &scenario.source)?;
                made.sees(&study.open_bands);
                study.camera = Some(made);
            }
        }
        let filters = study.open_bands.bands().iter().map(|band| FilterUsed {
            name: band.name.clone(),
            range_um: [1e4 / band.high_cm1, 1e4 / band.low_cm1],
        });
        let (filters, next) = (filters.collect(), supply.next(&inside));
        let filter_price = supply.spec.filters.price.clone();
        Ok(Self { candidate, scenario, study, filters, next, exposure_s, filter_price, kind })
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
        let Some(speed) = self.scenario.requirement.speed_m_s else { return Some(0.0) };
        let motion = Motion::of(camera, self.scenario.target.distance_m)?;
        Some(motion.blur_pixels(speed, camera.sweep_s(bands)))
    }

    /// Whether so many bands and frames are read in time and without a blur.
    pub(super) fn is_in_time(&self, camera: &Camera, bands: usize) -> bool {
        let is_late = |time_s: f64| camera.acquisition_s(bands) > time_s;
        !self.scenario.requirement.time_s.is_some_and(is_late)
            && self.blur(camera, bands).is_some_and(|blur| blur < 1.0)
    }

    /// The choice as it is listed.
    pub(super) fn choice(&self, best: &Best) -> Choice {
        let (candidate, camera) = (self.candidate, at_frames(&self.candidate.made, best.frames));
        let camera = Camera { exposure_s: self.exposure_s.unwrap_or(camera.exposure_s), ..camera };
        let mut scenario = self.scenario.clone();
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
            lower: best.judged.lower,
            upper: best.judged.upper,
            limiting: String::new(),
            verdict: None,
            warnings: Vec::new(),
            scenario,
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
