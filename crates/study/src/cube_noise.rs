//! Noise of a cube by band, as `[cube] noise` states it: one deviation, or a table with a row for each band.
//!
//! A table has a column `sigma` (all noise of a sample; for radiances) or `electronic_sigma` (what is added to shot noise; for counts),
//! and, where it is known, `sigma_common`: what all pixels are off by, each band for itself, as by noise of a calibration. For the interval of
//! one pixel that is one more deviation, independent of its noise: the squares add. `sigma_together` is what all bands are off by together,
//! as by temperatures of blackbodies: bands do not average it down, so that it is kept apart. A band that is left out may have no row.

use hadar::error::{Error, Result, check};
use hadar::grid::Grid;
use hadar::words::significant;
use hadar_formats::file::text_of_file;
use hadar_scenario::decompose::{CubeNoise, CubeUnit};
use std::path::Path;

/// Share of the way to the next band by which a row may be off its band: numbers are rounded, and centres are those of a response.
const SAME_BAND: f64 = 0.25;

/// Noise of the bands, in the unit of the cube.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct NoiseOfBands {
    /// Squared deviations, NaN of bands without a row; none where nothing is said.
    pub(super) var: Option<Vec<f64>>,
    /// What all pixels are off by, each band for itself, a deviation that is in `var` as well; none where nothing is said.
    pub(super) common: Option<Vec<f64>>,
    /// What all bands are off by together, a deviation; none where nothing is said.
    pub(super) together: Option<Vec<f64>>,
}

impl NoiseOfBands {
    /// The same in another unit, each band by its factor.
    pub(super) fn scale(&mut self, factors: &[f64]) {
        for sigmas in [&mut self.common, &mut self.together].into_iter().flatten() {
            sigmas.iter_mut().zip(factors).for_each(|(sigma, factor)| *sigma *= factor);
        }
        for var in self.var.iter_mut() {
            var.iter_mut().zip(factors).for_each(|(var, factor)| *var *= factor * factor);
        }
    }
}

/// As `[cube] noise` says.
pub(super) fn of_bands(
    noise: Option<&CubeNoise>,
    unit: &CubeUnit,
    centres_cm1: &[f64],
    widths_cm1: &[f64],
) -> Result<NoiseOfBands> {
    match noise {
        None => Ok(NoiseOfBands::default()),
        Some(CubeNoise::Uniform(sigma)) => {
            Ok(NoiseOfBands { var: Some(vec![sigma * sigma; centres_cm1.len()]), ..NoiseOfBands::default() })
        }
        Some(CubeNoise::File(path)) => {
            let whole = matches!(unit, CubeUnit::Radiance { .. } | CubeUnit::BrightnessTemperature { .. });
            let column = if whole { "sigma" } else { "electronic_sigma" };
            table(path, column, centres_cm1, widths_cm1).map_err(|error| error.in_file(path))
        }
    }
}

/// How names of a spectral axis begin.
const AXES: [&str; 6] = ["wave", "wn", "wl", "nu", "freq", "lambda"];

/// Rows that say where they are, beside the bands that they are taken for.
fn check_wavenumbers(grid: &Grid, places: &[usize], centres_cm1: &[f64], widths_cm1: &[f64]) -> Result<()> {
    let named = |(place, name): (usize, &String)| match name.as_str() {
        "wavenumber_cm1" => Some((place, false)),
        "wavelength_um" => Some((place, true)),
        _ => None,
    };
    // An axis by another name is not passed over: its rows may be in another order.
    let is_axis = |name: &&String| {
        let name = name.to_lowercase();
        AXES.iter().any(|axis| name.starts_with(axis))
    };
    let unknown = |name: &&String| is_axis(name) && named((0, name)).is_none();
    if let Some(other) = grid.header.iter().find(unknown) {
        let instead = "name the column wavenumber_cm1 or wavelength_um, or leave it out";
        return Err(Error::malformed(format!("a column `{other}`"), instead).on_line(grid.header_line));
    }
    let Some((place, is_wavelength)) = grid.header.iter().enumerate().find_map(named) else { return Ok(()) };
    for ((line, cells), i) in grid.rows.iter().zip(places.iter().copied()) {
        let centre = centres_cm1.get(i).unwrap_or(&f64::NAN);
        let cell = cells.get(place).copied().unwrap_or(f64::NAN);
        let own = if is_wavelength { 1e4 / cell } else { cell };
        let beside = [i.checked_sub(1), Some(i + 1)].into_iter().flatten().filter_map(|k| centres_cm1.get(k));
        let apart = beside.map(|other| (other - centre).abs()).fold(f64::INFINITY, f64::min);
        // A band alone reaches over its own width.
        let apart = if apart.is_finite() { apart } else { widths_cm1.get(i).copied().unwrap_or(0.0) };
        let off = (own - centre).abs();
        if off.is_nan() || off > SAME_BAND * apart {
            let found = format!(
                "a row at {} cm^-1 for band {i} at {} cm^-1",
                significant(own, 6),
                significant(*centre, 6)
            );
            let key = if is_wavelength { "wavelength_um" } else { "wavenumber_cm1" };
            let instead = "give the noise of these bands, a row for each in their order";
            return Err(Error::malformed(found, instead).for_key(key).on_line(*line));
        }
    }
    Ok(())
}

/// The band of each row: those of a table with fewer rows than bands say it in a column `band`.
fn places(grid: &Grid, bands: usize) -> Result<Vec<usize>> {
    let named = grid.header.iter().position(|own| own == "band");
    let rows = grid.rows.len();
    let some = named.filter(|_| rows < bands);
    if rows != bands && some.is_none() {
        return Err(Error::Length { what: "noise of the bands".into(), found: rows, expected: bands });
    }
    let (mut places, mut next) = (Vec::with_capacity(rows), 0);
    for (line, cells) in &grid.rows {
        let band = named.map_or(next as f64, |place| cells.get(place).copied().unwrap_or(f64::NAN));
        let place =
            (0..bands).skip(next).take(if some.is_some() { bands } else { 1 }).find(|i| *i as f64 == band);
        let Some(place) = place else {
            let found = format!("band {band} in the place of {next}");
            return Err(Error::malformed(found, "give a row for each band, counted from 0").on_line(*line));
        };
        places.push(place);
        next = place + 1;
    }
    Ok(places)
}

fn table(path: &Path, column: &str, centres_cm1: &[f64], widths_cm1: &[f64]) -> Result<NoiseOfBands> {
    let bands = centres_cm1.len();
    let grid =
        Grid::parse(&text_of_file(path, "read the noise of the bands")?).map_err(|error| match &error {
            Error::Malformed { found, .. } => {
                Error::malformed(found.clone(), format!("begin it with a line such as band,{column}"))
            }
            _ => error,
        })?;
    let place = |name: &str| grid.header.iter().position(|own| own == name);
    let Some(own) = place(column) else {
        let found = format!("the file has no column {column}");
        let instead = match column {
            "sigma" => "radiances take all their noise from it: write band,sigma and a row for each band",
            _ => {
                "counts scatter by themselves: write band,electronic_sigma, the noise that is added to that, and a row for each band"
            }
        };
        return Err(Error::malformed(found, instead));
    };
    let places = places(&grid, bands)?;
    check_wavenumbers(&grid, &places, centres_cm1, widths_cm1)?;
    let (common, coherent) = (place("sigma_common"), place("sigma_together"));
    let mut own_common = vec![0.0; bands];
    let (mut var, mut together) = (vec![f64::NAN; bands], vec![0.0; bands]);
    for ((line, cells), i) in grid.rows.iter().zip(places) {
        let cell = |place: usize| cells.get(place).copied().unwrap_or(f64::NAN);
        let at = |name: &str, value: f64| {
            check::non_negative(name, value, "").map_err(|error| error.for_key(name).on_line(*line))
        };
        let sigma = at(column, cell(own))?;
        let more = common.map_or(Ok(0.0), |place| at("sigma_common", cell(place)))?;
        if column == "sigma" && sigma == 0.0 {
            let found = Error::out_of_range("sigma", 0.0, "", "above 0, for nothing is known exactly");
            return Err(found.on_line(*line));
        }
        if let Some(own) = own_common.get_mut(i) {
            *own = more;
        }
        let coherent = coherent.map_or(Ok(0.0), |place| at("sigma_together", cell(place)))?;
        if let (Some(var), Some(together)) = (var.get_mut(i), together.get_mut(i)) {
            (*var, *together) = (sigma * sigma + more * more, coherent);
        }
    }
    let together = together.iter().any(|sigma| *sigma > 0.0).then_some(together);
    let common = own_common.iter().any(|sigma| *sigma > 0.0).then_some(own_common);
    Ok(NoiseOfBands { var: Some(var), common, together })
}
