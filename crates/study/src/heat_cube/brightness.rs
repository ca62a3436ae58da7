//! Cubes of brightness temperatures as radiances: L = hcν ∫B(T) dν/Δν, the mean over each band and ν its centre, which is what a blackbody at T is seen as.
//!
//! A noise in K is that of a blackbody at 300 K, as a NETD is: σ_L = σ_T hcν ∫dB/dT(300 K) dν/Δν, the same for all samples.
//!
//! Units: W m⁻² sr⁻¹ per cm⁻¹, K; ν in cm⁻¹, B photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹.

use hadar::cube::{Cube, Rows, Sample, Shape};
use hadar::error::{Error, Result};
use hadar::planck::{Tabulated, photon_radiance_and_slope_into, photon_radiance_slope};
use hadar::spectrum::Bands;
use hadar::units::{PLANCK_J_S, SPEED_OF_LIGHT_M_S};
use hadar::words::significant;
use hadar_formats::cube::TemperatureUnit;
use std::ops::Range;

/// The temperature at which a noise in K is stated.
const NETD_AT_K: f64 = 300.0;
/// Nothing that is seen is colder, or warmer, K.
const SEEN_K: [f64; 2] = [100.0, 2e4];

/// hcν, J.
fn joules(wavenumber_cm1: f64) -> f64 {
    PLANCK_J_S * SPEED_OF_LIGHT_M_S * 100.0 * wavenumber_cm1
}

/// Means of what is known at the nodes of bands, as energies.
fn energies(bands: &Bands, at_nodes: &[f64]) -> Vec<f64> {
    let [sums, moments] = [bands.weigh(at_nodes), bands.weigh(bands.nodes_cm1())];
    let widths = bands.widths_cm1();
    sums.iter()
        .zip(moments)
        .zip(widths)
        .map(|((sum, moment), width)| joules(moment / width) * sum / width)
        .collect()
}

/// What so many K at 300 K are in each band, W m⁻² sr⁻¹ per cm⁻¹.
pub(super) fn radiances_of_kelvin(bands: &Bands, kelvin: f64) -> Vec<f64> {
    let slopes = bands.nodes_cm1().iter().map(|nu| kelvin * photon_radiance_slope(*nu, NETD_AT_K));
    energies(bands, &slopes.collect::<Vec<_>>())
}

/// Refuses a cube whose first row is colder or warmer than anything that is seen, all of it, and so in another unit.
///
/// # Errors
/// Samples below 100 K, or above 20 000 K.
pub(super) fn check(cube: &Cube, unit: TemperatureUnit, called: &str) -> Result<()> {
    fn ends<S: Sample>(cube: &dyn Rows<S>) -> Result<[f64; 2]> {
        let mut buffer = Vec::new();
        let row = cube.read(0..1, &mut buffer)?.iter().map(|sample| (*sample).into());
        let ends = [f64::INFINITY, f64::NEG_INFINITY];
        Ok(row
            .filter(|one: &f64| one.is_finite())
            .fold(ends, |[low, high], one| [low.min(one), high.max(one)]))
    }
    let [low, high] = match cube {
        Cube::F32(cube) => ends(cube.as_ref()),
        Cube::F64(cube) => ends(cube.as_ref()),
    }?;
    let found = match (unit.kelvin(low), unit.kelvin(high)) {
        (_, most_k) if most_k.is_finite() && most_k < SEEN_K[0] => {
            format!("at most {} {called} in the first row, colder than any sky", significant(high, 3))
        }
        (least_k, _) if least_k.is_finite() && least_k > SEEN_K[1] => {
            format!("at least {} {called} in the first row, warmer than any flame", significant(low, 3))
        }
        _ => return Ok(()),
    };
    let instead = "write their unit, as in \"degC\" or \"W m^-2 sr^-1 um^-1\"";
    Err(Error::malformed(format!("the samples are {found}"), instead))
}

/// A cube of temperatures.
#[derive(Debug)]
struct InRadiance<S> {
    cube: Box<dyn Rows<S>>,
    unit: TemperatureUnit,
    bands: Bands,
    seen: Tabulated,
}

/// The radiances of a cube of temperatures in a unit; what is not above 0 K is missing.
///
/// # Errors
/// As [`Tabulated::new`].
pub(super) fn in_radiance(cube: Cube, unit: TemperatureUnit, bands: Bands) -> Result<Cube> {
    let seen = Tabulated::new(SEEN_K, |t| radiances(&bands, t))?;
    Ok(match cube {
        Cube::F32(cube) => Cube::F32(Box::new(InRadiance { cube, unit, bands, seen })),
        Cube::F64(cube) => Cube::F64(Box::new(InRadiance { cube, unit, bands, seen })),
    })
}

/// What a blackbody is in each band, and how it changes with its temperature, W m⁻² sr⁻¹ per cm⁻¹, and per K.
fn radiances(bands: &Bands, temperature_k: f64) -> Vec<[f64; 2]> {
    let nodes = bands.nodes_cm1();
    let (mut values, mut slopes) = (vec![0.0; nodes.len()], vec![0.0; nodes.len()]);
    photon_radiance_and_slope_into(nodes, temperature_k, &mut values, &mut slopes);
    energies(bands, &values)
        .into_iter()
        .zip(energies(bands, &slopes))
        .map(|(value, slope)| [value, slope])
        .collect()
}

impl<S: Sample> Rows<S> for InRadiance<S> {
    fn shape(&self) -> Shape {
        self.cube.shape()
    }

    fn read<'a>(&'a self, rows: Range<usize>, buffer: &'a mut Vec<S>) -> Result<&'a [S]> {
        let mut own = Vec::new();
        let samples = self.cube.read(rows, &mut own)?;
        buffer.clear();
        for pixel in samples.chunks(self.bands.len()) {
            buffer.extend(pixel.iter().enumerate().map(|(band, sample)| {
                let temperature_k = self.unit.kelvin((*sample).into());
                let is_one = temperature_k > 0.0 && temperature_k.is_finite();
                let unseen = || radiances(&self.bands, temperature_k)[band][0];
                let radiance = is_one.then(|| self.seen.signal(band, temperature_k).unwrap_or_else(unseen));
                S::of(radiance.unwrap_or(f64::NAN))
            }));
        }
        Ok(buffer)
    }
}
