//! Cameras that come into question, each with every lens.

use super::results::{Failed, LensUsed, Why};
use crate::{OwnCameras, camera};
use hadar::error::{Error, Result};
use hadar::instrument::catalogue::{self, is_like};
use hadar::instrument::figures::TABLE;
use hadar::instrument::presets::{self, Preset};
use hadar::instrument::{Camera, CameraSpec, Price, Readout};
use hadar_scenario::find::LensSpec;
use hadar_scenario::{FindSpec, Scenario};
use std::sync::Arc;

/// Lenses whose figures differ by no more are the same.
const SAME_LENS: f64 = 0.01;

/// A camera with a lens.
#[derive(Debug, Clone)]
pub(super) struct Candidate {
    pub(super) camera: String,
    pub(super) lens: Option<LensUsed>,
    pub(super) spec: CameraSpec,
    pub(super) made: Camera,
    /// What is known of its price, and the parts of which nothing is.
    pub(super) price: Option<Price>,
    pub(super) price_without: Vec<&'static str>,
    /// Whether it was named rather than one of many.
    pub(super) is_named: bool,
}

/// The cameras of a question, and those of which it is known at once that they cannot be asked.
pub(super) fn of(
    scenario: &Scenario,
    spec: &FindSpec,
    own: &OwnCameras,
) -> Result<(Vec<Candidate>, Vec<Failed>)> {
    let (mut candidates, mut failed) = (Vec::new(), Vec::new());
    let all: Vec<&Preset> = presets::all()?.iter().chain(&own.presets).collect();
    let mut seen: Vec<&str> = Vec::new();
    for (index, pattern) in spec.cameras.iter().enumerate() {
        let found: Vec<&&Preset> = all.iter().filter(|camera| is_like(&camera.name, pattern)).collect();
        if found.is_empty() {
            let error = Error::unknown_name("camera", pattern, all.iter().map(|camera| camera.name.as_str()));
            return Err(error.at(scenario.place(&format!("find.cameras[{index}]"))));
        }
        for preset in found {
            let is_of_kind = spec.kind.is_none_or(|kind| preset.kind == Some(kind));
            if !is_of_kind || seen.contains(&preset.name.as_str()) {
                continue;
            }
            seen.push(&preset.name);
            let is_named = !pattern.contains('*');
            let of_camera = Of { preset, scenario, spec, own, is_named };
            match of_camera.candidates() {
                Ok(found) => candidates.extend(found),
                Err(Rejected { error: Some(error), .. }) if is_named => return Err(error),
                Err(Rejected { why, .. }) => {
                    let camera = preset.name.clone();
                    failed.push(Failed { camera, lens: None, why, lower: None, upper: None });
                }
            }
        }
    }
    if seen.is_empty() {
        let found = "no camera is left of these patterns and this kind";
        let error = Error::malformed(
            found,
            "name others in find.cameras (`hadar cameras list` has them), or leave find.kind out",
        );
        return Err(error.at(scenario.place("find.cameras")));
    }
    one_currency(&candidates, scenario)?;
    Ok((candidates, failed))
}

/// That a camera cannot be asked.
struct Rejected {
    why: Why,
    error: Option<Error>,
}

impl From<Why> for Rejected {
    fn from(why: Why) -> Self {
        Self { why, error: None }
    }
}

/// Figures of a camera that may be fixed without making another device of it, whose price would be another.
const SAME_DEVICE: [&str; 17] = [
    "exposure",
    "f_number",
    "focal_length",
    "frames",
    "readout",
    "optics_efficiency",
    "field_of_view",
    "sensor_temperature",
    "filter_temperature",
    // What was measured of its array.
    "fixed_pattern",
    "row_noise",
    "column_noise",
    "offset_drift",
    "temporal_row_noise",
    "temporal_column_noise",
    "frame_noise",
    "pattern_drift",
];

/// A camera before it has a lens.
struct Of<'a> {
    preset: &'a Preset,
    scenario: &'a Scenario,
    spec: &'a FindSpec,
    own: &'a OwnCameras,
    is_named: bool,
}

impl Of<'_> {
    fn candidates(&self) -> std::result::Result<Vec<Candidate>, Rejected> {
        if self.preset.sold == Some(false) && !self.is_named {
            return Err(Why::NotSold.into());
        }
        let fixed = self.scenario.camera.clone().unwrap_or_default();
        let states =
            |of: &dyn Fn(&CameraSpec) -> Option<f64>| of(&fixed).or_else(|| of(&self.preset.figures));
        let (f_number, focal_length_m) = (states(&|spec| spec.f_number), states(&|spec| spec.focal_length_m));
        let lenses: Vec<(Option<LensUsed>, Option<Price>)> = match (f_number, focal_length_m) {
            // A camera with a lens of its own keeps it.
            (Some(f_number), Some(focal_length_m)) => {
                vec![(Some(LensUsed { name: None, f_number, focal_length_m, document: None }), None)]
            }
            _ => self.lenses([f_number, focal_length_m]),
        };
        if lenses.is_empty() {
            return Err(Why::NoLens.into());
        }
        lenses.into_iter().map(|(lens, price)| self.with_lens(&fixed, lens, price)).collect()
    }

    /// Lenses of the question, else of the catalogue; with what the camera states of its own.
    fn lenses(&self, own: [Option<f64>; 2]) -> Vec<(Option<LensUsed>, Option<Price>)> {
        // Of a lens that the camera has in part only that one.
        let fits = |f_number: f64, focal_length_m: f64| {
            let same =
                |own: Option<f64>, other: f64| own.is_none_or(|own| (own / other - 1.0).abs() < SAME_LENS);
            same(own[0], f_number) && same(own[1], focal_length_m)
        };
        let of_question = |lens: &LensSpec| {
            let used = LensUsed {
                name: lens.name.clone(),
                f_number: lens.f_number,
                focal_length_m: lens.focal_length_m,
                document: None,
            };
            fits(lens.f_number, lens.focal_length_m).then(|| (Some(used), lens.price.clone()))
        };
        let given: Vec<_> = self.spec.lenses.iter().flatten().filter_map(of_question).collect();
        let has_part = own.iter().any(Option::is_some);
        if !given.is_empty() || (self.spec.lenses.is_some() && !has_part) {
            return given;
        }
        let of_catalogue = |lens: &catalogue::Lens| {
            let used = LensUsed {
                name: Some(lens.name.clone()),
                f_number: lens.f_number,
                focal_length_m: lens.focal_length_m,
                document: Some(lens.document.clone()),
            };
            let is_its = lens.cameras.iter().any(|pattern| is_like(&self.preset.name, pattern));
            (is_its && fits(lens.f_number, lens.focal_length_m)).then(|| (Some(used), lens.price.clone()))
        };
        catalogue::lenses().unwrap_or_default().iter().filter_map(of_catalogue).collect()
    }

    fn with_lens(
        &self,
        fixed: &CameraSpec,
        lens: Option<LensUsed>,
        price: Option<Price>,
    ) -> std::result::Result<Candidate, Rejected> {
        let mut spec = fixed.clone();
        spec.preset = Some(self.preset.name.clone());
        let own = self.own.stated.iter().find(|own| own.name == self.preset.name);
        spec.own = own.map(|own| Arc::new(own.spec.clone()));
        if let Some(lens) = &lens {
            spec.f_number = Some(lens.f_number);
            spec.focal_length_m = Some(lens.focal_length_m);
        }
        // Filters before a camera of one band are exposed one after the other.
        if self.preset.figures.spectral_bands == Some(1) && spec.readout.is_none() {
            spec.readout = Some(Readout::Sequential);
        }
        let refused =
            |error: Error| Rejected { why: Why::Refused { because: error.to_string() }, error: Some(error) };
        let stated = camera::stated_at(&spec, &|_| hadar::error::Place::default()).map_err(refused)?;
        if let Err(missing) = stated.camera() {
            return Err(Why::Figures { missing: missing.0 }.into());
        }
        let made = camera::resolved(&spec, &self.scenario.source).map_err(refused)?;
        let figures = &self.preset.figures;
        let has_lens = figures.f_number.is_some() || figures.focal_length_m.is_some();
        let is_without = self.preset.price_without_lens == Some(true) || !has_lens;
        let mut price_without = Vec::new();
        let is_same_device =
            TABLE.iter().filter(|row| row.is_given(fixed)).all(|row| SAME_DEVICE.contains(&row.key));
        let own_price = self.preset.price.as_ref().filter(|_| is_same_device);
        let total = match (own_price, price) {
            (Some(camera), Some(lens)) => camera.and(&lens),
            (Some(camera), None) => {
                if is_without {
                    price_without.push("lens");
                }
                Some(camera.clone())
            }
            (None, _) => None,
        };
        let mismatch = own_price.is_some() && total.is_none();
        let total = if mismatch { own_price.cloned() } else { total };
        Ok(Candidate {
            camera: self.preset.name.clone(),
            lens,
            spec,
            made,
            price: total,
            price_without,
            is_named: self.is_named,
        })
    }
}

/// Refuses prices of two currencies.
fn one_currency(candidates: &[Candidate], scenario: &Scenario) -> Result<()> {
    let spec = scenario.find.clone().unwrap_or_default();
    let of_lenses = spec.lenses.iter().flatten().filter_map(|lens| lens.price.clone());
    let prices = candidates.iter().filter_map(|one| one.price.clone());
    let all: Vec<String> =
        prices.chain(of_lenses).chain(spec.filters.price.clone()).map(|price| price.currency).collect();
    let Some(first) = all.first() else { return Ok(()) };
    match all.iter().find(|currency| *currency != first) {
        None => Ok(()),
        Some(other) => {
            let found = format!("prices in {first} and in {other}");
            let error =
                Error::malformed(found, "write all prices in one currency; those of the program are in USD");
            Err(error.at(scenario.place("find")))
        }
    }
}
