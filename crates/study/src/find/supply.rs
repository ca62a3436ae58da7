//! The filters of a question, and every scene behind all of them.
//!
//! A scene behind filters is the same whatever the camera: it is looked up and integrated once, and every camera takes those of its bands
//! that lie in the range of its detector. Filters that a spectrum of the scene does not cover are named and left out.

use super::candidates::Candidate;
use crate::{Study, bands, camera_bands};
use hadar::demand::{self, Reason, Thing};
use hadar::error::{Error, Result};
use hadar::instrument::Camera;
use hadar::material::Library;
use hadar::order;
use hadar::spectrum::FilterCurve;
use hadar::units::Spectral;
use hadar_scenario::find::FilterSupply;
use hadar_scenario::{BandSource, FilterPlace, Filters, FindSpec, Scenario};

/// Share by which an edge of a filter may lie beyond the range of a detector, as ranges are stated in two digits.
const BEYOND: f64 = 0.005;
/// Filters to choose from at most.
const MOST_FILTERS: usize = 500;
/// Relative difference of wavelengths that is rounding.
const SAME: f64 = 1e-9;

/// The filters of a question, in the order of their bands.
pub(super) struct Supply<'q> {
    pub(super) spec: &'q FindSpec,
    filters: Vec<Offered>,
    /// Each scene behind all of them without a camera, with the sine of the cone that they stand in where that counts.
    scenes: Vec<((usize, Option<f64>), Study)>,
    /// Names of filters that the spectra of the scene do not cover.
    pub(super) left_out: Vec<String>,
}

/// A filter that may be chosen.
#[derive(Debug, Clone)]
struct Offered {
    name: Option<String>,
    /// Between half of its peak, µm.
    range_um: [f64; 2],
}

impl<'q> Supply<'q> {
    /// Those that lie in the range of any of the cameras and that the spectra of a scene cover.
    pub(super) fn of(
        spec: &'q FindSpec,
        candidates: &[Candidate],
        scene: &Scenario,
        library: &Library,
    ) -> Result<Self> {
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
        if filters.len() > MOST_FILTERS {
            let found = format!("{} filters to choose from", filters.len());
            let error = Error::malformed(
                found,
                format!("give at most {MOST_FILTERS}: fewer in the file, or a larger step of free edges"),
            );
            return Err(error.at(scene.place("find.filters")));
        }
        let mut supply = Self { spec, filters, scenes: Vec::new(), left_out: Vec::new() };
        if let (Err(error), false) = (supply.looked_up(None, scene, library), supply.filters.is_empty()) {
            // One by one: a spectrum that ends within a filter is no reason against the others.
            let whole = std::mem::take(&mut supply.filters);
            for one in whole {
                let name = one.name.clone().unwrap_or_else(|| format!("{:?} um", one.range_um));
                let alone =
                    Self { spec, filters: vec![one.clone()], scenes: Vec::new(), left_out: Vec::new() };
                match alone.looked_up(None, scene, library) {
                    Ok(_) => supply.filters.push(one),
                    Err(_) => supply.left_out.push(name),
                }
            }
            if supply.filters.is_empty() {
                return Err(error);
            }
        }
        Ok(supply)
    }

    /// A scene behind all filters, without a camera.
    fn looked_up(&self, sine: Option<f64>, scene: &Scenario, library: &Library) -> Result<Study> {
        let mut bare = scene.clone();
        bare.camera = None;
        bare.bands.source = self.source(&(0..self.filters.len()).collect::<Vec<_>>());
        // Spectra are covered or not whatever the cone.
        if let (BandSource::Filters(filters), None) = (&mut bare.bands.source, sine) {
            filters.place = None;
        }
        Study::with_members_in(&bare, library, sine, None)?.with_means()
    }

    /// The bands that are these filters.
    pub(super) fn source(&self, chosen: &[usize]) -> BandSource {
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
    pub(super) fn inside(&self, camera: &Camera) -> Vec<usize> {
        (0..self.filters.len()).filter(|w| is_within(self.filters[*w].range_um, camera)).collect()
    }

    /// Of some free filters the first that may stand beside each one and behind it; none where any may.
    pub(super) fn next(&self, inside: &[usize]) -> Option<Vec<usize>> {
        let FilterSupply::Any { .. } = self.spec.filters.from else { return None };
        let range = |w: &usize| self.filters[*w].range_um;
        // In the order of the bands what is behind lies at shorter wavelengths.
        let after = |w: &usize| inside.partition_point(|other| range(other)[1] > range(w)[0] * (1.0 + SAME));
        Some(inside.iter().map(after).collect())
    }

    /// The scene behind some of the filters as a camera sees it.
    pub(super) fn seen_by(
        &mut self,
        mut made: Camera,
        inside: &[usize],
        (place, scenario): (usize, &Scenario),
        library: &Library,
    ) -> Result<Study> {
        let is_in_cone = matches!(self.spec.filters.place, Some(FilterPlace::Sensor { .. }));
        let sine = is_in_cone.then(|| made.rim_sine());
        let key = (place, sine);
        let place = match self.scenes.iter().position(|(known, _)| *known == key) {
            Some(place) => {
                demand::spared(Thing::BandIntegrals, Reason::Shared, inside.len() as u64);
                place
            }
            None => {
                let study = self.looked_up(sine, scenario, library)?;
                self.scenes.push((key, study));
                self.scenes.len() - 1
            }
        };
        let mut study = self.scenes[place].1.with_bands_alone(inside)?;
        made.sees(&study.open_bands);
        study.scenario.camera.clone_from(&scenario.camera);
        study.scenario.bands = scenario.bands.clone();
        study.camera = Some(made);
        (study.bands, study.air) = study.received(study.camera.as_ref(), study.scenario.target.distance_m)?;
        study.check_sight()?;
        if let (Some(camera), Some(spec)) = (&study.camera, &scenario.camera) {
            let at = |key: &str| scenario.place(key);
            drop(camera_bands::check(camera, spec, &scenario.bands.source, &study.open_bands, &at)?);
        }
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
    let run = |from: usize, to: usize| Offered {
        name: None,
        // As one would write it.
        range_um: [from, to].map(|at| (at as f64 * step_um * 1e9).round() / 1e9),
    };
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
