//! A heat cube with what is around it, its bands and its noise looked up: what every question about a cube begins with.

use super::cube_bad::{self, BadBand, BadFound};
use super::cube_bands::{InOrder, axes_in_doubt};
use super::cube_noise::{NoiseOfBands, of_bands};
use super::cube_rows;
use super::cube_unit::check_light;
use super::cube_without::without;
use super::light_found::{LightFound, Looked, Readings};
use super::pixel_map::Map;
use super::{Warning, bands, camera, camera_bands};
use hadar::cube::Cube;
use hadar::error::{Error, Result};
use hadar::grid::Grid;
use hadar::instrument::{Camera, View};
use hadar::material::Library;
use hadar::order;
use hadar::planck;
use hadar::spectrum::{Bands, interpolated};
use hadar::units::{PLANCK_J_S, SPEED_OF_LIGHT_M_S};
use hadar_estimate::decompose::Light;
use hadar_formats::cube::Found;
use hadar_formats::file::{READ_SPECTRUM, text_of_file};
use hadar_formats::spectra::measured;
use hadar_scenario::decompose::{Bad, CubeNoise, CubeUnit, HeatCube, LightSource};
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
    /// Temperatures that a surface may have, K.
    pub(super) temperature_k: [f64; 2],
    /// Whether the scale of the counts is unknown.
    pub(super) gain: bool,
}

/// A cube that is open, and what its samples are.
#[derive(Debug)]
pub(super) struct Measured {
    pub(super) cube: Cube,
    /// What its file was read as.
    pub(super) read: Found,
    /// Bands that are left out, as the scenario and the file say or as they were found, in rising wavenumber.
    pub(super) bad_bands: Vec<usize>,
    /// What was found to be bad; samples of such pixels are missing in the cube.
    pub(super) bad: BadFound,
    pub(super) warnings: Vec<Warning>,
    pub(super) bands: Bands,
    pub(super) lights: Vec<Light>,
    /// What is said of those that the cube itself shows.
    pub(super) found: Vec<LightFound>,
    pub(super) counts_per_radiance: Vec<f64>,
    pub(super) var_added: Vec<f64>,
    /// What all bands and pixels are off by together, a deviation of each band in counts; none where nothing is said.
    pub(super) together: Option<Vec<f64>>,
    /// What all pixels are off by alike, each band for itself, a deviation of each in counts; empty where nothing is said.
    pub(super) common: Vec<f64>,
    /// What one count is in the unit of the cube.
    pub(super) units_per_count: f64,
}

/// What the samples of a cube are in counts.
struct Scale {
    counts_per_radiance: Vec<f64>,
    var_added: Vec<f64>,
    units_per_count: f64,
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
        let opened =
            check_light(&opened.found).and_then(|()| opened.among(&bands)).map_err(at("cube.data"))?;
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
        let mut bad_bands = opened.bad_bands(&self.cube.bad_bands).map_err(at("cube.bad_bands"))?;
        let widths = bands.widths_cm1();
        let centres: Vec<f64> =
            bands.weigh(bands.nodes_cm1()).iter().zip(&widths).map(|(sum, width)| sum / width).collect();
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
            common: noise.common.map(|sigma| opened.rising(&sigma)),
        };
        let absent = opened.absent();
        let InOrder { cube, found: read, .. } = opened;
        let lit = self.environment.iter().enumerate().map(|(k, source)| {
            sent(source, bands.nodes_cm1(), library).map_err(at(&format!("environment[{k}]")))
        });
        let lit = lit.collect::<Result<Vec<_>>>()?;
        let most = brightest(&bands, self.temperature_k[1], &lit);
        let added = |band: usize| noise.var.as_ref().and_then(|var| var.get(band).copied()).unwrap_or(0.0);
        let added: Vec<f64> = (0..bands.len()).map(added).collect();
        let Scale { counts_per_radiance, mut var_added, units_per_count } =
            self.scale((&bands, &bad_bands), &centres, &added, &most, camera.as_ref())?;
        let shape = cube.shape();
        let named = self.cube.bad_pixels.as_ref();
        let named = named.map(|path| Map::open(path, shape, &[1])?.read(0..shape.rows()));
        let named = named.transpose().map_err(at("cube.bad_pixels"))?.unwrap_or_default();
        let named: Vec<bool> = named.iter().map(|one| *one != 0.0).collect();
        let counts = |sums: Vec<f64>| sums.iter().zip(&counts_per_radiance).map(|(s, k)| s * k).collect();
        let mut coldest = vec![0.0; bands.nodes_cm1().len()];
        planck::photon_radiance_into(bands.nodes_cm1(), self.temperature_k[0], &mut coldest);
        let (least, most): (Vec<f64>, Vec<f64>) = (counts(bands.weigh(&coldest)), counts(most));
        let readings = cube_bad::Readings {
            bad_bands: &bad_bands,
            units_per_count,
            var_added: &var_added,
            least: &least,
            most: &most,
            keeps: self.cube.bad == Bad::Keep,
            gain: self.gain,
        };
        let mut bad = readings.find(&cube, &named).map_err(at("cube.data"))?;
        bad_bands.extend(bad.bands.iter().map(|bad| bad.band));
        bad_bands.sort_unstable();
        bad.bands.extend(absent.into_iter().map(|band| BadBand { band, why: "absent" }));
        bad.bands.sort_by_key(|bad| bad.band);
        warnings.extend(bad.warnings(shape));
        let in_table = |error: Error| match &self.cube.noise {
            Some(CubeNoise::File(path)) => error.in_file(path),
            _ => error,
        };
        noise_of_left_out(&mut var_added, &bad_bands).map_err(in_table).map_err(at("cube.noise"))?;
        let cube = without(cube, &bad.map);
        let readings = Readings {
            bands: &bands,
            bad_bands: &bad_bands,
            counts_per_radiance: &counts_per_radiance,
            var_added: &var_added,
            units_per_count,
        };
        let (lights, found) = self.lights(lit, (&cube, readings), &mut warnings)?;
        // Of a band that the file lacks there is none.
        let in_counts = |sigma: Vec<f64>| -> Vec<f64> {
            let one = |sigma: f64| if sigma.is_nan() { 0.0 } else { sigma / units_per_count };
            sigma.into_iter().map(one).collect()
        };
        let together = noise.together.map(in_counts);
        let common = noise.common.map(in_counts).unwrap_or_default();
        Ok(Measured {
            cube,
            read,
            bad_bands,
            bad,
            warnings,
            bands,
            lights,
            found,
            counts_per_radiance,
            var_added,
            together,
            common,
            units_per_count,
        })
    }

    /// What a sample is. `added` is the variance of its noise in the unit of the cube, `most` what can be sent in each band.
    fn scale(
        &self,
        (bands, bad_bands): (&Bands, &[usize]),
        centres_cm1: &[f64],
        added: &[f64],
        most: &[f64],
        camera: Option<&Camera>,
    ) -> Result<Scale> {
        let widths = bands.widths_cm1();
        Ok(match self.cube.unit {
            CubeUnit::CountsPerPhotonRadiance(counts) => Scale {
                counts_per_radiance: widths.iter().map(|width| counts / width).collect(),
                var_added: added.to_vec(),
                units_per_count: 1.0,
            },
            CubeUnit::Radiance => {
                // A variance so much larger than that of the photons that the noise alone counts.
                // What is left out is worth nothing, whether it is a band of the file or not.
                let used = |(band, value): (usize, f64)| (!bad_bands.contains(&band)).then_some(value);
                let least = added.iter().copied().enumerate().filter_map(used).fold(f64::INFINITY, f64::min);
                let joules = |nu: &f64| PLANCK_J_S * SPEED_OF_LIGHT_M_S * 100.0 * nu;
                let of_bands = || centres_cm1.iter().zip(&widths);
                // Of what surfaces and lights can send, not of what the cube holds: no sample changes what another one is worth.
                let largest = of_bands().zip(most).map(|((nu, width), sum)| joules(nu) * sum / width);
                let largest = largest.enumerate().filter_map(used).fold(least.sqrt(), f64::max);
                let units_per_count = least / (PER_VARIANCE * largest);
                Scale {
                    counts_per_radiance: of_bands()
                        .map(|(nu, width)| joules(nu) / (units_per_count * width))
                        .collect(),
                    var_added: added.iter().map(|var| var / units_per_count / units_per_count).collect(),
                    units_per_count,
                }
            }
            CubeUnit::Camera => {
                let Some(camera) = camera else {
                    let missing = Error::malformed("the table is missing", "write [camera]");
                    return Err(self.at("camera")(missing));
                };
                let counting = camera.counting(bands, &View::default());
                Scale {
                    counts_per_radiance: vec![counting.counts_per_radiance; bands.len()],
                    var_added: added.iter().enumerate().map(|(w, var)| counting.var_added(w) + var).collect(),
                    units_per_count: 1.0,
                }
            }
        })
    }

    /// The surroundings: `lit` where they are told, else rows of the cube without what is not like the rest of them, or what is found in it.
    fn lights(
        &self,
        lit: Vec<Option<Vec<f64>>>,
        (cube, readings): (&Cube, Readings<'_>),
        warnings: &mut Vec<Warning>,
    ) -> Result<(Vec<Light>, Vec<LightFound>)> {
        let Readings { bad_bands, units_per_count, .. } = readings;
        let is_asked = self.environment.iter().any(|source| matches!(source, LightSource::Found { .. }));
        let looked =
            is_asked.then(|| Looked::at(cube, readings)).transpose().map_err(self.at("cube.data"))?;
        let mut all_found = Vec::new();
        let each = self.environment.iter().zip(lit).enumerate();
        let lights = each.map(|(environment, (source, lit))| match (source, &looked) {
            (LightSource::Found { like, rows }, Some(looked)) => {
                let key = format!("environment[{environment}].found");
                let (light, found) = looked.find(environment, (*like, *rows)).map_err(self.at(&key))?;
                all_found.push(found);
                Ok(light)
            }
            (LightSource::Rows(rows), _) => {
                let (light, left_out) = counted(cube, *rows, bad_bands, units_per_count)
                    .map_err(self.at(&format!("environment[{environment}]")))?;
                if left_out > 0 {
                    let of = (rows[1] - rows[0]) * cube.shape().columns();
                    warnings.push(Warning::RowsUneven { environment, pixels: left_out, of });
                }
                Ok(light)
            }
            _ => Ok(Light::Radiance(lit.unwrap_or_default())),
        });
        let lights = lights.collect::<Result<Vec<_>>>()?;
        Ok((lights, all_found))
    }
}

/// Bands that are left out need no noise of their own: they take the largest of the others.
fn noise_of_left_out(var_added: &mut [f64], bad_bands: &[usize]) -> Result<()> {
    let unknown = |(band, var): (usize, &f64)| (var.is_nan() && !bad_bands.contains(&band)).then_some(band);
    if let Some(band) = var_added.iter().enumerate().find_map(unknown) {
        let found = format!("no row for band {band} (in rising wavenumber), which has readings");
        return Err(Error::malformed(found, "give its noise, or name the band in cube.bad_bands"));
    }
    let most = var_added.iter().copied().fold(0.0, f64::max);
    var_added.iter_mut().filter(|var| var.is_nan()).for_each(|var| *var = most);
    Ok(())
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

/// The spectrum of one of the surroundings at the nodes; nothing where the cube itself shows it.
pub(super) fn sent(light: &LightSource, nodes: &[f64], library: &Library) -> Result<Option<Vec<f64>>> {
    match light {
        LightSource::Surface { material, temperature_k } => {
            let mut radiance = vec![0.0; nodes.len()];
            planck::photon_radiance_into(nodes, *temperature_k, &mut radiance);
            let emissivity = match material {
                None => return Ok(Some(radiance)),
                Some(MaterialRef::Name(name)) => library.get(name)?.emissivity(nodes)?,
                Some(MaterialRef::File(path)) => hadar_formats::spectra::material(path)?.emissivity(nodes)?,
            };
            radiance.iter_mut().zip(&emissivity).for_each(|(radiance, e)| *radiance *= e);
            Ok(Some(radiance))
        }
        LightSource::Spectrum { path, column } => spectrum(path, column, nodes).map(Some),
        LightSource::Rows(_) | LightSource::Found { .. } => Ok(None),
    }
}

/// The most that a blackbody at a temperature or a light sends in each band, photons s⁻¹ m⁻² sr⁻¹.
fn brightest(bands: &Bands, temperature_k: f64, lit: &[Option<Vec<f64>>]) -> Vec<f64> {
    let mut radiance = vec![0.0; bands.nodes_cm1().len()];
    planck::photon_radiance_into(bands.nodes_cm1(), temperature_k, &mut radiance);
    for light in lit.iter().flatten() {
        radiance.iter_mut().zip(light).for_each(|(most, light)| *most = most.max(*light));
    }
    bands.weigh(&radiance)
}

/// Mean counts of rows of the cube, and how many of their pixels are not like the others.
fn counted(cube: &Cube, rows: [usize; 2], bad_bands: &[usize], unit: f64) -> Result<(Light, usize)> {
    let (mean, left_out) = match cube {
        Cube::F32(cube) => cube_rows::mean_of(cube.as_ref(), rows, bad_bands),
        Cube::F64(cube) => cube_rows::mean_of(cube.as_ref(), rows, bad_bands),
    }?;
    Ok((Light::Counts(mean.iter().map(|n| n / unit).collect()), left_out))
}

/// A column of a table of photon radiances at the nodes.
pub(super) fn spectrum(path: &Path, column: &str, nodes_cm1: &[f64]) -> Result<Vec<f64>> {
    let table = columns(path)?;
    let Some((_, rows)) = table.iter().find(|(name, _)| name == column) else {
        let names = table.iter().map(|(name, _)| name.as_str());
        return Err(Error::unknown_name("column", column, names).for_key("column").in_file(path));
    };
    let largest = rows.iter().fold(0.0_f64, |most, row| most.max(row.1));
    let rows = measured(rows, largest).map_err(|error| error.for_key(column).in_file(path))?;
    let mut rows = rows.to_vec();
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
