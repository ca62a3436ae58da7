//! A heat cube with what is around it, its bands and its noise looked up: what every question about a cube begins with.

mod brightness;
mod lights;
mod said;
mod scale;

use self::lights::brightest;
pub(super) use self::lights::{columns, sent, spectrum};
pub(super) use self::said::Said;
use self::scale::{Scale, noise_of_left_out};
use super::cube_bad::{self, BadBand, BadFound};
use super::cube_bands::{InOrder, Stated, axes_in_doubt};
use super::cube_noise::{NoiseOfBands, of_bands};
use super::cube_unit::{self, check_light};
use super::cube_without::without;
use super::light_found::{LightFound, Readings};
use super::pixel_map::Map;
use super::{Warning, bands, camera, camera_bands};
use hadar::cube::Cube;
use hadar::error::{Error, Result};
use hadar::instrument::Camera;
use hadar::material::Library;
use hadar::planck;
use hadar::spectrum::Bands;
use hadar_estimate::decompose::Light;
use hadar_formats::cube::Found;
use hadar_scenario::decompose::{Bad, CubeNoise, CubeUnit};

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

impl Said<'_> {
    /// Opens the cube; materials of the surroundings are looked up in `library`.
    pub(super) fn measured(&self, library: &Library) -> Result<Measured> {
        let at = |key: &str| self.at(key);
        let camera = self.camera.map(|spec| camera::resolved(spec, self.source)).transpose()?;
        let (opened, bands, mut warnings) = self.opened(camera.as_ref())?;
        let mut bad_bands = opened.bad_bands(&self.cube.bad_bands).map_err(at("cube.bad_bands"))?;
        let widths = bands.widths_cm1();
        let centres: Vec<f64> =
            bands.weigh(bands.nodes_cm1()).iter().zip(&widths).map(|(sum, width)| sum / width).collect();
        let converted = cube_unit::of_file(&opened.found, &self.cube.unit).map_err(at("cube.data"))?;
        let mut noise = self.noise(&opened, &centres, &widths)?;
        if let (Some(of_file), CubeUnit::Radiance { unit, written }) = (converted, &self.cube.unit) {
            // The noise is stated in the scenario's unit.
            let factors = centres.iter().map(|nu| unit.watts_per_cm1(*nu) / of_file.watts_per_cm1(*nu));
            noise.scale(&factors.collect::<Vec<_>>());
            let file = opened.found.unit.clone().unwrap_or_default();
            // Per wavelength the mean over ν₁ to ν₂ has ν₁ν₂ in the place of ν².
            let halves = centres.iter().zip(&widths).map(|(nu, width)| 0.5 * width / nu);
            let of_mean = halves.map(|half| half * half).fold(0.0, f64::max);
            warnings.push(Warning::UnitConverted { file, scenario: written.clone(), of_mean });
        }
        let absent = opened.absent();
        let InOrder { mut cube, found: read, .. } = opened;
        if let CubeUnit::BrightnessTemperature { unit, written } = &self.cube.unit {
            // The noise is in the scenario's unit, the samples in that of their file.
            noise.scale(&brightness::radiances_of_kelvin(&bands, unit.kelvin_apart(1.0)));
            let of_file = cube_unit::temperature(&read);
            let called = read.unit.as_ref().filter(|_| of_file.is_some()).unwrap_or(written);
            let unit = of_file.unwrap_or(*unit);
            brightness::check(&cube, unit, called).map_err(at("cube.unit"))?;
            cube = brightness::in_radiance(cube, unit, bands.clone())?;
        }
        let lit = self.environment.iter().enumerate().map(|(k, source)| {
            sent(source, bands.nodes_cm1(), library).map_err(at(&format!("environment[{k}]")))
        });
        let lit = lit.collect::<Result<Vec<_>>>()?;
        let most = brightest(&bands, self.temperature_k[1], &lit);
        let added = |band: usize| noise.var.as_ref().and_then(|var| var.get(band).copied()).unwrap_or(0.0);
        let added: Vec<f64> = (0..bands.len()).map(added).collect();
        let scale = self.scale((&bands, &bad_bands), &centres, &added, &most, converted, camera.as_ref())?;
        let mut bad = self.found_bad(&cube, (&bands, &bad_bands), &scale, most)?;
        let Scale { counts_per_radiance, mut var_added, units_per_count } = scale;
        bad_bands.extend(bad.bands.iter().map(|bad| bad.band));
        bad_bands.sort_unstable();
        bad.bands.extend(absent.into_iter().map(|band| BadBand { band, why: "absent" }));
        bad.bands.sort_by_key(|bad| bad.band);
        warnings.extend(bad.warnings(cube.shape()));
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

    /// The file and the bands of its samples, as the camera receives them, with what is to be said of their order.
    fn opened(&self, camera: Option<&Camera>) -> Result<(InOrder, Bands, Vec<Warning>)> {
        let at = |key: &str| self.at(key);
        if self.bands.is_some_and(|spec| spec.integrate == Some(true)) {
            let found = "integrals over bands are not made here";
            let instead = "leave bands.integrate out: a filter is sampled at the rows of its curve";
            return Err(at("bands.integrate")(Error::malformed(found, instead)));
        }
        let (path, variable) = (&self.cube.data, self.cube.variable.as_deref());
        let asked = self.bands.map(|spec| camera_bands::asked(&spec.source, camera.zip(self.camera)));
        let said = asked.as_ref().map(|asked| bands::at_centres(asked, self.source)).transpose()?;
        let stated = asked.as_ref().map(Stated::of).transpose().map_err(at("bands"))?;
        let listed = stated.as_ref().and_then(|stated| stated.listed.as_deref());
        let opened = InOrder::open(path, variable, self.cube.axes, listed);
        let opened = opened.map_err(at("cube.data"))?;
        let mut bands = match said {
            Some(bands) => bands,
            None => opened.bands(path).map_err(at("bands"))?,
        };
        let is_light = match &self.cube.unit {
            CubeUnit::BrightnessTemperature { .. } => Ok(()),
            _ => check_light(&opened.found),
        };
        let opened = is_light.and_then(|()| opened.among(&bands)).map_err(at("cube.data"))?;
        let doubt = axes_in_doubt(&opened.found, self.bands.map(|_| &bands));
        let mut warnings: Vec<Warning> = doubt.into_iter().collect();
        warnings.extend(stated.and_then(|stated| stated.warning(&opened.found)));
        if opened.found.axis_without_unit {
            warnings.push(Warning::WavelengthsUnused);
        }
        if let (Some(camera), Some(spec), Some(asked)) = (camera, self.camera, &asked) {
            camera_bands::check(camera, spec, asked, &bands, &|key| self.source.place(key))?;
            bands = camera.received(&bands);
        }
        Ok((opened, bands, warnings))
    }

    /// The noise of the bands, in rising wavenumber; its table has the order of the file.
    fn noise(&self, opened: &InOrder, centres_cm1: &[f64], widths_cm1: &[f64]) -> Result<NoiseOfBands> {
        let [centres, widths] = [centres_cm1, widths_cm1].map(|values| opened.of_file(values));
        let noise = of_bands(self.cube.noise.as_ref(), &self.cube.unit, &centres, &widths)
            .map_err(self.at("cube.noise"))?;
        Ok(NoiseOfBands {
            var: noise.var.map(|var| opened.rising(&var)),
            together: noise.together.map(|sigma| opened.rising(&sigma)),
            common: noise.common.map(|sigma| opened.rising(&sigma)),
        })
    }

    /// Bad pixels and bands, named or found; `most` is what can be sent in each band.
    fn found_bad(
        &self,
        cube: &Cube,
        (bands, bad_bands): (&Bands, &[usize]),
        scale: &Scale,
        most: Vec<f64>,
    ) -> Result<BadFound> {
        let shape = cube.shape();
        let named = self.cube.bad_pixels.as_ref();
        let named = named.map(|path| Map::open(path, shape, &[1])?.read(0..shape.rows()));
        let named = named.transpose().map_err(self.at("cube.bad_pixels"))?.unwrap_or_default();
        let named: Vec<bool> = named.iter().map(|one| *one != 0.0).collect();
        let counts = |sums: Vec<f64>| -> Vec<f64> {
            sums.iter().zip(&scale.counts_per_radiance).map(|(s, k)| s * k).collect()
        };
        let mut coldest = vec![0.0; bands.nodes_cm1().len()];
        planck::photon_radiance_into(bands.nodes_cm1(), self.temperature_k[0], &mut coldest);
        let (least, most) = (counts(bands.weigh(&coldest)), counts(most));
        let readings = cube_bad::Readings {
            bad_bands,
            units_per_count: scale.units_per_count,
            var_added: &scale.var_added,
            least: &least,
            most: &most,
            keeps: self.cube.bad == Bad::Keep,
            gain: self.gain,
        };
        readings.find(cube, &named).map_err(self.at("cube.data"))
    }
}
