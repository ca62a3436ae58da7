//! The surroundings of a cube: spectra that are told, or rows of the cube that show them.
//!
//! A surface sends e(ν) B(ν, T), a column of a table what stands in it on straight lines between its rows, which must reach over all bands;
//! rows of the cube give their mean counts, without the pixels that are not like the others.
//!
//! Units: photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹.

use super::said::Said;
use crate::light_found::{LightFound, Looked, Readings};
use crate::{Warning, cube_rows};
use hadar::cube::Cube;
use hadar::error::{Error, Result};
use hadar::grid::Grid;
use hadar::material::Library;
use hadar::order;
use hadar::planck;
use hadar::spectrum::{Bands, Gaps, interpolated};
use hadar_estimate::decompose::Light;
use hadar_formats::file::{READ_SPECTRUM, text_of_file};
use hadar_formats::spectra::{measured, radiance};
use hadar_scenario::MaterialRef;
use hadar_scenario::decompose::LightSource;
use std::path::Path;

/// By how much a band may be beyond the last row, relative: rounding.
const ROUNDED: f64 = 1e-9;

impl Said<'_> {
    /// The surroundings: `lit` where they are told, else rows of the cube without what is not like the rest of them, or what is found in it.
    pub(super) fn lights(
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
                if let Some(before) = self.environment[..environment].iter().position(|one| one == source) {
                    let found = format!("what environment[{before}] finds once more");
                    let instead = "leave one of them out, or name the rows of each";
                    return Err(self.at(&key)(Error::malformed(found, instead)));
                }
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

/// Name and rows (cm⁻¹, value) of a column.
pub(crate) type Column = (String, Vec<(f64, f64)>);

/// The columns of a table beside its wavenumbers.
pub(crate) fn columns(path: &Path) -> Result<Vec<Column>> {
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
pub(crate) fn sent(light: &LightSource, nodes: &[f64], library: &Library) -> Result<Option<Vec<f64>>> {
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
pub(super) fn brightest(bands: &Bands, temperature_k: f64, lit: &[Option<Vec<f64>>]) -> Vec<f64> {
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

/// A column of a table of radiances at the nodes, as photon radiance.
pub(crate) fn spectrum(path: &Path, column: &str, nodes_cm1: &[f64]) -> Result<Vec<f64>> {
    let rows = radiance(path, column)?;
    let largest = rows.iter().fold(0.0_f64, |most, row| most.max(row.1));
    let rows = measured(&rows, largest).map_err(|error| error.for_key(column).in_file(path))?;
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
    let gaps = Gaps::of(&xs);
    let at = |nu: &f64| {
        gaps.check(*nu)?;
        // Bands in another unit end beside the row that is meant.
        let end = nu.max(*low).min(*high);
        if (end - nu).abs() > ROUNDED * nu {
            let found = format!("the spectrum reaches from {low} to {high} cm^-1, the bands to {nu} cm^-1");
            return Err(Error::malformed(found, "give rows that cover the bands"));
        }
        let value = interpolated(&xs, &ys, end);
        if value < 0.0 {
            let found = format!("a radiance of {value} at {nu} cm^-1");
            return Err(Error::malformed(found, "write radiances from 0"));
        }
        Ok(value)
    };
    nodes_cm1.iter().map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_band_that_rounding_puts_beyond_the_last_row_has_its_value() {
        let rows = [(800.0, 1.0), (1200.0, 3.0)];
        assert_eq!(on_nodes(&rows, &[800.0 - 1e-13, 1_200.000_000_000_000_2]), Ok(vec![1.0, 3.0]));
        assert!(on_nodes(&rows, &[1200.001]).is_err());
        let rows: Vec<_> = (0..30).chain(60..90).map(|i| (800.0 + 4.0 * f64::from(i), 1.0)).collect();
        assert!(on_nodes(&rows, &[916.0, 1040.0]).is_ok());
        let refusal = on_nodes(&rows, &[900.0, 950.0]).unwrap_err().to_string();
        assert!(refusal.starts_with("no rows between 916.00 and 1040.00 cm^-1"), "{refusal}");
    }

    #[test]
    fn a_sky_in_watts_is_that_in_photons() {
        let folder = tempfile::tempdir().unwrap();
        let table = |name: &str, unit: &str, of: &dyn Fn(f64) -> f64| {
            let line = |nu: f64| format!("{nu},{}\n", planck::photon_radiance(nu, 260.0) * of(nu));
            let file = folder.path().join(name);
            let rows: String = [700.0, 900.0, 1100.0, 1300.0].map(line).concat();
            std::fs::write(&file, format!("wavenumber_cm1,sky{unit}\n{rows}")).unwrap();
            spectrum(&file, "sky", &[720.0, 1000.0, 1250.0]).unwrap()
        };
        let photons = table("photons.csv", "", &|_| 1.0);
        // h c nu, with nu in m^-1, and 1e-4 for cm^2.
        let watts =
            table("watts.csv", " [W cm^-2 sr^-1 (cm^-1)^-1]", &|nu| 1.986_445_857e-25 * 100.0 * nu * 1e-4);
        for (one, other) in photons.iter().zip(&watts) {
            assert!((one / other - 1.0).abs() < 1e-8, "{photons:?} {watts:?}");
        }
    }
}
