//! Filters, the typical curve and cubes of a response, looked up; filters that are bad in a cube are left out.
//!
//! A filter's transmittance over a part of a value is the mean of points over its width; the typical curve is brought to a peak of 1.
//!
//! Units: cm⁻¹ for wavenumbers and widths; transmittances from 0 to 1.

use super::{LeftOutFilter, ResponseStudy};
use crate::Warning;
use crate::calibrate::left_out::LeftOut;
use crate::calibrate::whole::{at, open, shown};
use crate::cube_bad::BadBand;
use crate::heat_cube::columns;
use hadar::calibration::finer::Finer;
use hadar::cube::Cube;
use hadar::error::{Error, Result};
use hadar::order;
use hadar::spectrum::interpolated;
use hadar_formats::filter_curves;
use hadar_scenario::calibrate::ResponseScenario;
use hadar_scenario::calibrate::blackbodies::CubeFile;
use std::path::Path;

/// Points over the width of a part of a response value at which a filter is looked at.
const POINTS: usize = 11;

impl ResponseStudy {
    /// Looks up filters and the typical curve, and opens the cubes.
    ///
    /// # Errors
    /// Filters that are dependent or not those of the cubes, cubes of different sizes, files that cannot be used; with file, line, key.
    pub fn new(scenario: &ResponseScenario) -> Result<Self> {
        let (source, spec) = (&scenario.source, &scenario.response);
        let [low, high] = spec.range_cm1;
        let step = (high - low) / (spec.values - 1) as f64;
        let centres_cm1: Vec<f64> = (0..spec.values).map(|j| low + step * j as f64).collect();
        let key = if spec.values < 2 { "response.values" } else { "response.correlation" };
        let finer = Finer::of(&centres_cm1, spec.known().correlation_cm1).map_err(at(source, key))?;
        let parts_cm1 = finer.centres_cm1();
        let (names, transmittances) =
            filters(&spec.filters, parts_cm1, finer.step_cm1()).map_err(at(source, "response.filters"))?;
        let typical = spec.typical.as_ref().map(|path| typical(path, parts_cm1)).transpose();
        let typical =
            typical.map_err(at(source, "response.typical"))?.unwrap_or_else(|| vec![1.0; parts_cm1.len()]);
        let mut named = Vec::new();
        let mut opened = |file: &CubeFile, key: &str| -> Result<Cube> {
            let (cube, bad) = open(file, source, key)?;
            named.extend(bad);
            Ok(cube)
        };
        let mut cubes = Vec::new();
        for (k, blackbody) in scenario.blackbodies.iter().enumerate() {
            let key = format!("blackbody[{k}].data");
            let cube = opened(&blackbody.data, &key)?;
            check_filters(&cube, names.len()).map_err(at(source, &key))?;
            if let Some(first) = cubes.first() {
                same_size(&cube, first, "blackbody[0]").map_err(at(source, &key))?;
            }
            cubes.push(cube);
        }
        let scene = scenario.scene.as_ref().map(|spec| {
            let scene = opened(&spec.data, "scene.data")?;
            same_size(&scene, &cubes[0], "blackbody[0]").map_err(at(source, "scene.data"))?;
            let file = CubeFile { path: spec.reference.clone(), ..spec.data.clone() };
            let reference = opened(&file, "scene.reference")?;
            same_size(&reference, &scene, "the scene").map_err(at(source, "scene.reference"))?;
            Ok([scene, reference])
        });
        let scene = scene.transpose()?;
        let mut study = Self {
            scenario: scenario.clone(),
            scene,
            left_out: Vec::new(),
            centres_cm1,
            finer,
            names,
            transmittances,
            typical,
            cubes,
        };
        study.leave_out(&named).map_err(at(source, "blackbody"))?;
        let wheel = study.wheel_of_values(1.0)?;
        if let Some([like, dependent]) = wheel.dependent() {
            let [like, dependent] = [like, dependent].map(|q| &study.names[q]);
            let found = format!(
                "filter `{dependent}` is a combination of those before it, the most like `{like}`: the filters are linearly dependent"
            );
            let error =
                Error::malformed(found, format!("leave `{dependent}` out, and its band of the cubes"));
            return Err(at(source, "response.filters")(error));
        }
        Ok(study)
    }

    pub(super) fn warnings_of_left_out(&self) -> impl Iterator<Item = Warning> + '_ {
        ["missing", "stuck", "saturated"].into_iter().filter_map(|why| {
            let of = self.left_out.iter().filter(|one| one.why == why);
            let filters: Vec<String> = of.map(|one| one.filter.clone()).collect();
            (!filters.is_empty()).then_some(Warning::FiltersLeftOut { filters, why })
        })
    }

    /// Leaves the filters out whose bands are bad in some cube.
    fn leave_out(&mut self, named: &[usize]) -> Result<()> {
        let left_out = LeftOut::of(self.names.len(), named, &[], &self.cubes, self.scenario.noise)?;
        if left_out.bands.is_empty() {
            return Ok(());
        }
        let name = |band: usize| self.names.get(band).cloned().unwrap_or_default();
        let of = |bad: &BadBand| LeftOutFilter { filter: name(bad.band), band: bad.band, why: bad.why };
        self.left_out = left_out.bands.iter().map(of).collect();
        let is_good = |band: usize| left_out.good.contains(&band);
        let mut places = (0..).map(is_good);
        self.names.retain(|_| places.next().unwrap_or(false));
        let mut places = (0..).map(is_good);
        self.transmittances.retain(|_| places.next().unwrap_or(false));
        let cubes = std::mem::take(&mut self.cubes);
        self.cubes = cubes.into_iter().map(|cube| left_out.without(cube)).collect::<Result<_>>()?;
        if let Some([scene, reference]) = self.scene.take() {
            self.scene = Some([left_out.without(scene)?, left_out.without(reference)?]);
        }
        Ok(())
    }
}

fn check_filters(cube: &Cube, filters: usize) -> Result<()> {
    if cube.shape().bands() == filters {
        return Ok(());
    }
    let found = format!("the cube is {}, but there are {filters} filters", shown(cube.shape()));
    Err(Error::malformed(found, "give a band for each filter, in the order of their columns"))
}

fn same_size(cube: &Cube, other: &Cube, name: &str) -> Result<()> {
    if cube.shape() == other.shape() {
        return Ok(());
    }
    let found =
        format!("the cube is {}, but that of {name} is {}", shown(cube.shape()), shown(other.shape()));
    Err(Error::malformed(found, "give cubes of one size, as the camera makes them"))
}

/// Names and mean transmittances over each width `step` about some centres.
fn filters(path: &Path, centres_cm1: &[f64], step: f64) -> Result<(Vec<String>, Vec<Vec<f64>>)> {
    let (mut names, mut all) = (Vec::new(), Vec::new());
    for curve in filter_curves(path)? {
        let mean = |nu: &f64| {
            let at = |i: usize| curve.transmittance(nu + step * ((i as f64 + 0.5) / POINTS as f64 - 0.5));
            (0..POINTS).map(at).sum::<f64>() / POINTS as f64
        };
        all.push(centres_cm1.iter().map(mean).collect());
        names.push(curve.name().to_owned());
    }
    Ok((names, all))
}

/// The first column beside the wavenumbers, brought to a peak of 1; 0 outside of its rows.
fn typical(path: &Path, centres_cm1: &[f64]) -> Result<Vec<f64>> {
    let table = columns(path)?;
    let Some((_, rows)) = table.first() else {
        let error = Error::malformed("the table has one column", "write wavenumber_cm1,response");
        return Err(error.in_file(path));
    };
    let mut rows = rows.clone();
    order::ascending(&mut rows, |a| a.0);
    let (xs, ys): (Vec<f64>, Vec<f64>) = rows.into_iter().unzip();
    let (Some(low), Some(high)) = (xs.first(), xs.last()) else {
        return Err(Error::malformed("the table has no rows", "write one for every wavenumber").in_file(path));
    };
    let at = |nu: &f64| if (*low..=*high).contains(nu) { interpolated(&xs, &ys, *nu) } else { 0.0 };
    let curve: Vec<f64> = centres_cm1.iter().map(at).collect();
    let peak = curve.iter().copied().fold(0.0, f64::max);
    if !(peak > 0.0 && curve.iter().all(|r| *r >= 0.0)) {
        let error =
            Error::malformed("the typical curve is nowhere above 0, or below it", "write responses from 0");
        return Err(error.in_file(path));
    }
    Ok(curve.iter().map(|r| r / peak).collect())
}
