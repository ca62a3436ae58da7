//! A heat cube with what is around it, its bands and its noise looked up: what every question about a cube begins with.

use super::cube_bands::{InOrder, axes_in_doubt};
use super::cube_noise::{NoiseOfBands, of_bands};
use super::cube_unit::check_light;
use super::{Warning, bands, camera, camera_bands};
use hadar::cube::{Cube, Rows, Sample};
use hadar::error::{Error, Result};
use hadar::grid::Grid;
use hadar::instrument::View;
use hadar::material::Library;
use hadar::order;
use hadar::planck;
use hadar::spectrum::{Bands, interpolated};
use hadar::units::{PLANCK_J_S, SPEED_OF_LIGHT_M_S};
use hadar_estimate::decompose::Light;
use hadar_formats::cube::Found;
use hadar_formats::file::{READ_SPECTRUM, text_of_file};
use hadar_scenario::decompose::{CubeUnit, HeatCube, LightSource};
use hadar_scenario::{BandSource, BandsSpec, CameraSpec, MaterialRef, Source};
use std::path::Path;

/// Counts that stand for a squared deviation of a stated noise: so many that shot noise adds nothing to it.
const PER_VARIANCE: f64 = 1e6;

/// What a scenario says of its cube.
#[derive(Debug, Clone, Copy)]
pub(super) struct Said<'a> {
    pub(super) cube: &'a HeatCube,
    pub(super) bands: Option<&'a BandsSpec>,
    pub(super) camera: Option<&'a CameraSpec>,
    pub(super) environment: &'a [LightSource],
    pub(super) source: &'a Source,
}

/// A cube that is open, and what its samples are.
#[derive(Debug)]
pub(super) struct Measured {
    pub(super) cube: Cube,
    /// What its file was read as.
    pub(super) read: Found,
    /// Bands that are left out, as the scenario and the file say, in rising wavenumber.
    pub(super) bad_bands: Vec<usize>,
    pub(super) warnings: Vec<Warning>,
    pub(super) bands: Bands,
    pub(super) lights: Vec<Light>,
    pub(super) counts_per_radiance: Vec<f64>,
    pub(super) var_added: Vec<f64>,
    /// What all bands and pixels are off by together, a deviation of each band in counts; none where nothing is said.
    pub(super) together: Option<Vec<f64>>,
    /// What one count is in the unit of the cube.
    pub(super) units_per_count: f64,
}

impl Said<'_> {
    /// Puts the place of a key on an error that has none of its own.
    pub(super) fn at(&self, key: &str) -> impl Fn(Error) -> Error + use<> {
        let place = self.source.place(key);
        let key = key.to_owned();
        move |error: Error| match &error {
            Error::At { place, .. } if place.path.is_some() => error.for_key(key.clone()),
            _ => error.at(place.clone()),
        }
    }

    /// Opens the cube; materials of the surroundings are looked up in `library`.
    pub(super) fn measured(&self, library: &Library) -> Result<Measured> {
        let at = |key: &str| self.at(key);
        let camera = self.camera.map(|spec| camera::resolved(spec, self.source)).transpose()?;
        if self.bands.is_some_and(|spec| spec.integrate == Some(true)) {
            let found = "integrals over bands are not made here";
            let instead = "leave bands.integrate out: a filter is sampled at the rows of its curve";
            return Err(at("bands.integrate")(Error::malformed(found, instead)));
        }
        let (path, variable) = (&self.cube.data, self.cube.variable.as_deref());
        let opened = InOrder::open(path, variable, self.cube.axes).map_err(at("cube.data"))?;
        let (asked, mut bands) = match self.bands {
            Some(spec) => {
                let asked = camera_bands::asked(&spec.source, camera.as_ref().zip(self.camera));
                let bands = bands::at_centres(&asked, self.source)?;
                (asked, bands)
            }
            None => (BandSource::Rows(path.clone()), opened.bands().map_err(at("bands"))?),
        };
        check_light(&opened.found).and_then(|()| opened.check(&bands)).map_err(at("cube.data"))?;
        let doubt = axes_in_doubt(&opened.found, self.bands.map(|_| &bands));
        let mut warnings: Vec<Warning> = doubt.into_iter().collect();
        if asked.is_in_wavelength() && opened.found.centres_cm1.is_none() && bands.len() > 1 {
            warnings.push(Warning::BandOrderTaken);
        }
        if opened.found.axis_without_unit {
            warnings.push(Warning::WavelengthsUnused);
        }
        if let (Some(camera), Some(spec)) = (&camera, self.camera) {
            camera_bands::check(camera, spec, &asked, &bands, &|key| self.source.place(key))?;
            bands = camera.received(&bands);
        }
        let bad_bands = self.bad_bands(&opened, bands.len()).map_err(at("cube.bad_bands"))?;
        let widths = bands.widths_cm1();
        let centres: Vec<f64> =
            bands.weigh(bands.nodes_cm1()).iter().zip(&widths).map(|(sum, width)| sum / width).collect();
        let mut units_per_count = 1.0;
        // Its table has the order of the file.
        let noise = of_bands(
            self.cube.noise.as_ref(),
            self.cube.unit,
            &opened.of_file(&centres),
            &opened.of_file(&widths),
        )
        .map_err(at("cube.noise"))?;
        let noise = NoiseOfBands {
            var: noise.var.map(|var| opened.rising(&var)),
            together: noise.together.map(|sigma| opened.rising(&sigma)),
        };
        let InOrder { cube, found: read, .. } = opened;
        let added = |band: usize| noise.var.as_ref().and_then(|var| var.get(band).copied()).unwrap_or(0.0);
        let (counts_per_radiance, var_added) = match self.cube.unit {
            CubeUnit::CountsPerPhotonRadiance(counts) => {
                (widths.iter().map(|width| counts / width).collect(), (0..bands.len()).map(added).collect())
            }
            CubeUnit::Radiance => {
                // A variance so much larger than that of the photons that the noise alone counts.
                let least = (0..bands.len()).map(added).fold(f64::INFINITY, f64::min);
                units_per_count = least / (PER_VARIANCE * largest(&cube)?.max(least.sqrt()));
                let joules = |nu: &f64| PLANCK_J_S * SPEED_OF_LIGHT_M_S * 100.0 * nu;
                let scale = |(nu, width): (&f64, &f64)| joules(nu) / (units_per_count * width);
                let var = (0..bands.len()).map(|band| added(band) / units_per_count / units_per_count);
                (centres.iter().zip(&widths).map(scale).collect(), var.collect())
            }
            CubeUnit::Camera => {
                let Some(camera) = &camera else {
                    return Err(at("camera")(Error::malformed("the table is missing", "write [camera]")));
                };
                let counting = camera.counting(&bands, &View::default());
                let var = (0..bands.len()).map(|w| counting.var_added(w) + added(w));
                (vec![counting.counts_per_radiance; bands.len()], var.collect())
            }
        };
        let lights = self.environment.iter().enumerate().map(|(k, light)| {
            let key = format!("environment[{k}]");
            lit(light, &cube, &bands, library, units_per_count).map_err(at(&key))
        });
        let lights = lights.collect::<Result<Vec<_>>>()?;
        let together =
            noise.together.map(|sigma| sigma.into_iter().map(|sigma| sigma / units_per_count).collect());
        Ok(Measured {
            cube,
            read,
            bad_bands,
            warnings,
            bands,
            lights,
            counts_per_radiance,
            var_added,
            together,
            units_per_count,
        })
    }

    /// Bands that are left out, as the scenario and the file say, in rising wavenumber.
    fn bad_bands(&self, opened: &InOrder, bands: usize) -> Result<Vec<usize>> {
        if let Some(bad) = self.cube.bad_bands.iter().find(|band| **band >= bands) {
            let found = format!("band {bad} of {bands}");
            return Err(Error::malformed(found, format!("count from 0 up to {}", bands - 1)));
        }
        let is_bad =
            |band: usize| self.cube.bad_bands.contains(&band) || opened.found.bad_bands.contains(&band);
        let is_bad = opened.rising(&(0..bands).map(is_bad).collect::<Vec<bool>>());
        let bad = is_bad.into_iter().enumerate().filter(|(_, bad)| *bad);
        let bad: Vec<usize> = bad.map(|(band, _)| band).collect();
        if bad.len() == bands {
            let instead = "leave some of them, or mend the list of the file";
            return Err(Error::malformed("all bands are bad", instead));
        }
        Ok(bad)
    }
}

/// Name and rows (cm⁻¹, value) of a column.
pub(super) type Column = (String, Vec<(f64, f64)>);

/// The columns of a table beside its wavenumbers.
pub(super) fn columns(path: &Path) -> Result<Vec<Column>> {
    let text = text_of_file(path, READ_SPECTRUM)?;
    let read = || -> Result<Vec<Column>> {
        let grid = Grid::parse(&text)?;
        let axis = grid.wavenumbers_cm1()?;
        let column = |(i, name): (usize, &String)| {
            let rows = axis.iter().zip(&grid.rows).map(|(nu, (_, cells))| (*nu, cells[i])).collect();
            (name.clone(), rows)
        };
        Ok(grid.header.iter().enumerate().skip(1).map(column).collect())
    };
    read().map_err(|error| error.in_file(path))
}

/// The spectrum of one of the surroundings.
fn lit(light: &LightSource, cube: &Cube, bands: &Bands, library: &Library, unit: f64) -> Result<Light> {
    let nodes = bands.nodes_cm1();
    match light {
        LightSource::Surface { material, temperature_k } => {
            let mut radiance = vec![0.0; nodes.len()];
            planck::photon_radiance_into(nodes, *temperature_k, &mut radiance);
            let emissivity = match material {
                None => return Ok(Light::Radiance(radiance)),
                Some(MaterialRef::Name(name)) => library.get(name)?.emissivity(nodes)?,
                Some(MaterialRef::File(path)) => hadar_formats::spectra::material(path)?.emissivity(nodes)?,
            };
            radiance.iter_mut().zip(&emissivity).for_each(|(radiance, e)| *radiance *= e);
            Ok(Light::Radiance(radiance))
        }
        LightSource::Spectrum { path, column } => Ok(Light::Radiance(spectrum(path, column, nodes)?)),
        LightSource::Rows([first, last]) => {
            let counts = match cube {
                Cube::F32(rows) => mean_of(rows.as_ref(), *first, *last),
                Cube::F64(rows) => mean_of(rows.as_ref(), *first, *last),
            }?;
            Ok(Light::Counts(counts.iter().map(|n| n / unit).collect()))
        }
    }
}

/// A column of a table of photon radiances at the nodes.
pub(super) fn spectrum(path: &Path, column: &str, nodes_cm1: &[f64]) -> Result<Vec<f64>> {
    let table = columns(path)?;
    let Some((_, rows)) = table.iter().find(|(name, _)| name == column) else {
        let names = table.iter().map(|(name, _)| name.as_str());
        return Err(Error::unknown_name("column", column, names).for_key("column").in_file(path));
    };
    let mut rows = rows.clone();
    order::ascending(&mut rows, |a| a.0);
    on_nodes(&rows, nodes_cm1).map_err(|error| error.in_file(path))
}

/// A spectrum on straight lines between its rows, which must reach over all nodes.
fn on_nodes(rows: &[(f64, f64)], nodes_cm1: &[f64]) -> Result<Vec<f64>> {
    let (Some((low, _)), Some((high, _))) = (rows.first(), rows.last()) else {
        return Err(Error::malformed("the table has no rows", "write one for every wavenumber"));
    };
    let (xs, ys): (Vec<f64>, Vec<f64>) = rows.iter().copied().unzip();
    let at = |nu: &f64| {
        if !(*low..=*high).contains(nu) {
            let found = format!("the spectrum reaches from {low} to {high} cm^-1, the bands to {nu} cm^-1");
            return Err(Error::malformed(found, "give rows that cover the bands"));
        }
        let value = interpolated(&xs, &ys, *nu);
        if value < 0.0 {
            let found = format!("a radiance of {value} at {nu} cm^-1");
            return Err(Error::malformed(found, "write photons s^-1 m^-2 sr^-1 per cm^-1, from 0"));
        }
        Ok(value)
    };
    nodes_cm1.iter().map(at).collect()
}

fn mean_of<S: Sample>(cube: &dyn Rows<S>, first: usize, last: usize) -> Result<Vec<f64>> {
    let shape = cube.shape();
    if last > shape.rows() {
        let found = format!("rows {first} to {last} of a cube of {}", shape.rows());
        return Err(Error::malformed(found, format!("write rows up to {}", shape.rows())));
    }
    let (mut sum, mut count, mut buffer) = (vec![0.0; shape.bands()], 0.0, Vec::new());
    for row in first..last {
        for pixel in cube.read(row..row + 1, &mut buffer)?.chunks(shape.bands()) {
            if pixel.iter().all(|sample| (*sample).into().is_finite()) {
                pixel.iter().zip(&mut sum).for_each(|(sample, sum)| *sum += (*sample).into());
                count += 1.0;
            }
        }
    }
    if count == 0.0 {
        return Err(Error::malformed("these rows hold no pixel with all its samples", "name other rows"));
    }
    sum.iter_mut().for_each(|sum| *sum /= count);
    Ok(sum)
}

/// The largest sample of a cube.
fn largest(cube: &Cube) -> Result<f64> {
    fn of<S: Sample>(cube: &dyn Rows<S>) -> Result<f64> {
        let mut buffer = Vec::new();
        (0..cube.shape().rows()).try_fold(0.0, |most, row| {
            let samples = cube.read(row..row + 1, &mut buffer)?;
            let finite =
                samples.iter().map(|sample| (*sample).into()).filter(|sample: &f64| sample.is_finite());
            Ok(finite.fold(most, f64::max))
        })
    }
    match cube {
        Cube::F32(rows) => of(rows.as_ref()),
        Cube::F64(rows) => of(rows.as_ref()),
    }
}
