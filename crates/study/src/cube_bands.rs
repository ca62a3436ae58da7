//! A cube beside its bands: as many of them, the same ones, in rising wavenumber.
//!
//! Bands are always counted in rising wavenumber here. A file that says its bands may have them in any order, as one of rising
//! wavelength has; it is put right. Of a file that says nothing, that order is expected.

use crate::Warning;
use hadar::cube::Cube;
use hadar::error::{Error, Result};
use hadar::order;
use hadar::spectrum::Bands;
use hadar::words::significant;
use hadar_formats::cube::{Axes, Found, Opened};
use std::path::Path;

/// Neighbouring distances of bands that differ by more than this factor are no widths.
const UNEVEN: f64 = 1.4;

/// A cube with its bands in rising wavenumber.
#[derive(Debug)]
pub(super) struct InOrder {
    pub(super) cube: Cube,
    pub(super) found: Found,
    /// Which band of the file each of its bands is.
    pub(super) order: Vec<usize>,
}

impl InOrder {
    pub(super) fn open(path: &Path, variable: Option<&str>, axes: Option<Axes>) -> Result<Self> {
        let Opened { cube, found } = hadar_formats::cube::open_as(path, variable, axes)?;
        let mut order: Vec<usize> = (0..cube.shape().bands()).collect();
        if let Some(centres) = &found.centres_cm1 {
            let centre = |band: &usize| centres.get(*band).copied().unwrap_or(f64::NAN);
            order::ascending(&mut order, centre);
        }
        Ok(Self { cube: cube.with_bands(order.clone())?, found, order })
    }

    /// Of a list in the order of the file, that in rising wavenumber.
    pub(super) fn rising<T: Clone>(&self, of_file: &[T]) -> Vec<T> {
        self.order.iter().filter_map(|band| of_file.get(*band).cloned()).collect()
    }

    /// Of a list in rising wavenumber, that in the order of the file.
    pub(super) fn of_file(&self, rising: &[f64]) -> Vec<f64> {
        let mut of_file = vec![f64::NAN; rising.len()];
        for (band, value) in self.order.iter().zip(rising) {
            if let Some(own) = of_file.get_mut(*band) {
                *own = *value;
            }
        }
        of_file
    }

    /// Bands that are left out, as is said (`named`, in the order of the file) and as the file says, in rising wavenumber.
    ///
    /// # Errors
    /// A band that is not there, or all of them.
    pub(super) fn bad_bands(&self, named: &[usize]) -> Result<Vec<usize>> {
        let bands = self.order.len();
        if let Some(bad) = named.iter().find(|band| **band >= bands) {
            let found = format!("band {bad} of {bands}");
            return Err(Error::malformed(found, format!("count from 0 up to {}", bands - 1)));
        }
        let is_bad = |band: &usize| named.contains(band) || self.found.bad_bands.contains(band);
        let bad: Vec<usize> = (0..bands).filter(|band| self.order.get(*band).is_some_and(is_bad)).collect();
        if bad.len() == bands {
            let instead = "leave some of them, or mend the list of the file";
            return Err(Error::malformed("all bands are bad", instead));
        }
        Ok(bad)
    }

    /// The bands as the file says them.
    ///
    /// # Errors
    /// A file that does not, bands that are there twice.
    pub(super) fn bands(&self) -> Result<Bands> {
        match (&self.found.centres_cm1, &self.found.widths_cm1) {
            (Some(centres), Some(widths)) => {
                Bands::from_rows(centres.iter().copied().zip(widths.iter().copied()))
            }
            (Some(centres), None) => {
                evenly_spaced(&self.rising(centres))?;
                Bands::from_centers(centres)
            }
            (None, _) if self.found.axis_without_unit => Err(Error::malformed(
                "the table is missing, and the cube's file lists its wavelengths without a unit",
                "write the unit into the file (ENVI: wavelength units = Micrometers; NPZ, MATLAB: call the list wavelengths_um), or write [bands]",
            )),
            (None, _) => Err(Error::malformed(
                "the table is missing, and the cube's file does not say its bands",
                "write [bands] with start, stop and step, or rows = \"bands.csv\"",
            )),
        }
    }

    /// Refuses bands that are not those of the cube.
    ///
    /// # Errors
    /// Another number of bands, or one that the file has elsewhere by more than half its width.
    pub(super) fn check(&self, bands: &Bands) -> Result<()> {
        check_count(&self.found, bands)?;
        let Some(centres) = &self.found.centres_cm1 else { return Ok(()) };
        let widths = bands.widths_cm1();
        for (i, ((band, own), width)) in
            bands.bands().iter().zip(self.rising(centres)).zip(widths).enumerate()
        {
            // One node stands for its band; a filter reaches over its rows.
            let half = 0.5 * width.max(band.high_cm1 - band.low_cm1);
            if (band.center_cm1 - own).abs() > half {
                let place = self.order.get(i).copied().unwrap_or(i);
                let found = format!(
                    "band {place} of the cube is at {} cm^-1 by its file, but at {} cm^-1 in [bands]",
                    significant(own, 6),
                    significant(band.center_cm1, 6)
                );
                let instead = "leave [bands] out, or mend the wavelengths of the file";
                return Err(Error::malformed(found, instead));
            }
        }
        Ok(())
    }
}

/// Refuses bands whose widths cannot be told from their distances, as where some are left out.
fn evenly_spaced(centres_cm1: &[f64]) -> Result<()> {
    let apart: Vec<f64> = centres_cm1.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let uneven = |pair: &[f64]| pair[0].max(pair[1]) > UNEVEN * pair[0].min(pair[1]);
    let Some(place) = apart.windows(2).position(uneven) else { return Ok(()) };
    let around: Vec<String> =
        centres_cm1.iter().skip(place).take(3).map(|nu| significant(*nu, 6).to_string()).collect();
    let found = format!(
        "bands at {} cm^-1 by the cube's file, which does not say how wide they are",
        around.join(", ")
    );
    Err(Error::malformed(
        found,
        "write their widths into the file (fwhm), or [bands] with rows = \"bands.csv\"",
    ))
}

/// What is not sure of the axes of a cube, beside the bands that were asked for.
pub(super) fn axes_in_doubt(found: &Found, said: Option<&Bands>) -> Option<Warning> {
    let [rows, columns, bands] = [found.shape.rows(), found.shape.columns(), found.shape.bands()];
    // As many bands as were asked for, and not as many rows: there is no doubt.
    let sure = said.is_some_and(|said| said.len() == bands && said.len() != rows);
    (found.may_begin_with_bands() && !sure).then_some(Warning::AxesInDoubt { rows, columns, bands })
}

fn check_count(found: &Found, bands: &Bands) -> Result<()> {
    let shape = found.shape;
    if shape.bands() == bands.len() {
        return Ok(());
    }
    let instead = match found.axes_of_bands(bands.len()) {
        Some(axes) => format!("if these are the bands of its file, write axes = \"{axes}\""),
        None => "make [bands] those of the cube".into(),
    };
    let found = format!(
        "the cube is {} x {} x {} (rows, columns, bands), but [bands] are {}",
        shape.rows(),
        shape.columns(),
        shape.bands(),
        bands.len()
    );
    Err(Error::malformed(found, instead))
}
