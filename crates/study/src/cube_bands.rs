//! A cube beside its bands: as many of them, the same ones, in rising wavenumber.
//!
//! A file may lack bands, cut out for absorption or a gap of the detector: where it says the centres of those it has, each is the nearest
//! band of [bands], off it by no more than half that band's width; the others are absent, missing in every pixel.
//!
//! Bands are always counted in rising wavenumber here. A file that says its bands may have them in any order, as one of rising
//! wavelength has; it is put right. The bands of a file that says nothing are in the order of the list in [bands], rows, filters or
//! ranges; beside a grid they rise in wavenumber.

use crate::{Warning, bands};
use hadar::cube::Cube;
use hadar::error::{Error, Result};
use hadar::spectrum::Bands;
use hadar::units::Spectral;
use hadar::words::significant;
use hadar_formats::cube::{Axes, Found, Opened};
use hadar_scenario::BandSource;
use std::ops::RangeInclusive;
use std::path::Path;

/// Neighbouring distances of bands that differ by more than this factor are no widths.
const UNEVEN: f64 = 1.4;

/// Bands of any thermal camera, 0.5 to 500 µm, cm⁻¹: a unit that is off by 1000 leaves them.
const BANDS_CM1: RangeInclusive<f64> = 20.0..=2e4;

/// A cube with its bands in rising wavenumber.
#[derive(Debug)]
pub(super) struct InOrder {
    pub(super) cube: Cube,
    pub(super) found: Found,
    /// Which band of the file each of its bands is; none of one that the file lacks.
    pub(super) order: Vec<Option<usize>>,
}

/// The order in which [bands] state their bands.
#[derive(Debug)]
pub(super) struct Stated {
    /// Which place in its list each band has, in rising wavenumber; none of a grid.
    pub(super) listed: Option<Vec<usize>>,
    /// Whether they begin with the shortest wavelength, as the bands of a cube may.
    begins_short: bool,
}

impl Stated {
    pub(super) fn of(asked: &BandSource) -> Result<Self> {
        let listed = bands::as_listed(asked)?;
        let rises = |places: &Vec<usize>| places.windows(2).all(|pair| pair[0] < pair[1]);
        let begins_short = match &listed {
            Some(places) => !rises(places),
            None => matches!(asked, BandSource::Grid { start: Spectral::Wavelength(_), .. }),
        };
        Ok(Self { listed, begins_short })
    }

    /// What is not sure of the bands of a file that does not state them.
    pub(super) fn warning(&self, found: &Found) -> Option<Warning> {
        let doubt = self.begins_short && found.centres_cm1.is_none() && found.shape.bands() > 1;
        doubt.then_some(Warning::BandOrderTaken { listed: self.listed.is_some() })
    }
}

impl InOrder {
    /// `listed`: which place in its list each band has, in rising wavenumber.
    pub(super) fn open(
        path: &Path,
        variable: Option<&str>,
        axes: Option<Axes>,
        listed: Option<&[usize]>,
    ) -> Result<Self> {
        let Opened { cube, found } = hadar_formats::cube::open_as(path, variable, axes)?;
        let order = found.rising_bands(listed);
        let cube = cube.with_bands(order.clone())?;
        Ok(Self { cube, found, order: order.into_iter().map(Some).collect() })
    }

    /// Of a list in the order of the file, that in rising wavenumber; NaN of bands that the file lacks.
    pub(super) fn rising(&self, of_file: &[f64]) -> Vec<f64> {
        let at = |band: &Option<usize>| band.and_then(|band| of_file.get(band)).copied();
        self.order.iter().map(|band| at(band).unwrap_or(f64::NAN)).collect()
    }

    /// Of a list in rising wavenumber, that in the order of the file.
    pub(super) fn of_file(&self, rising: &[f64]) -> Vec<f64> {
        let mut of_file = vec![f64::NAN; self.found.shape.bands()];
        for (band, value) in self.order.iter().zip(rising) {
            if let Some(own) = band.and_then(|band| of_file.get_mut(band)) {
                *own = *value;
            }
        }
        of_file
    }

    /// Bands that the file lacks, in rising wavenumber.
    pub(super) fn absent(&self) -> Vec<usize> {
        (0..self.order.len()).filter(|band| self.order.get(*band).is_some_and(Option::is_none)).collect()
    }

    /// The cube among these bands: those that its file lacks are missing.
    ///
    /// # Errors
    /// As [`Self::check`]; of a file that has fewer bands and says where they are, one that is none of these, or two that are one of them.
    pub(super) fn among(self, bands: &Bands) -> Result<Self> {
        let (own, wanted) = (self.order.len(), bands.len());
        let (Some(centres), true) = (&self.found.centres_cm1, own < wanted) else {
            self.check(bands)?;
            return Ok(self);
        };
        let mut places = vec![None; wanted];
        let mut order = places.clone();
        let reaches: Vec<f64> = half_widths(bands).collect();
        for (i, centre) in self.rising(centres).into_iter().enumerate() {
            let off = |band: usize| {
                bands.bands().get(band).map_or(f64::INFINITY, |band| (band.center_cm1 - centre).abs())
            };
            let nearest = (0..wanted).min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or(0);
            if off(nearest) > reaches.get(nearest).copied().unwrap_or(0.0) {
                return Err(self.elsewhere(i, centre, bands, nearest));
            }
            if let Some(Some(twin)) = places.get(nearest) {
                let found = format!(
                    "bands {} and {} of the cube are both the band at {} cm^-1 of [bands]",
                    self.of_the_file(*twin),
                    self.of_the_file(i),
                    significant(bands.bands().get(nearest).map_or(f64::NAN, |band| band.center_cm1), 6)
                );
                return Err(Error::malformed(found, "make [bands] as narrow as those of the cube"));
            }
            if let (Some(place), Some(of_file)) = (places.get_mut(nearest), order.get_mut(nearest)) {
                (*place, *of_file) = (Some(i), self.order.get(i).copied().flatten());
            }
        }
        Ok(Self { cube: self.cube.with_places(places)?, found: self.found, order })
    }

    fn of_the_file(&self, band: usize) -> usize {
        self.order.get(band).copied().flatten().unwrap_or(band)
    }

    fn elsewhere(&self, own: usize, centre_cm1: f64, bands: &Bands, band: usize) -> Error {
        let wanted = bands.bands().get(band).map_or(f64::NAN, |band| band.center_cm1);
        let found = format!(
            "band {} of the cube is at {} cm^-1 by its file, but at {} cm^-1 in [bands]",
            self.of_the_file(own),
            significant(centre_cm1, 6),
            significant(wanted, 6)
        );
        Error::malformed(found, "leave [bands] out, or mend the wavelengths of the file")
    }

    /// Bands that are left out, as is said (`named`, in the order of the file), as the file says, and those it lacks, in rising wavenumber.
    ///
    /// # Errors
    /// A band that is not there, or all of them.
    pub(super) fn bad_bands(&self, named: &[usize]) -> Result<Vec<usize>> {
        let (bands, of_file) = (self.order.len(), self.found.shape.bands());
        if let Some(bad) = named.iter().find(|band| **band >= of_file) {
            let found = format!("band {bad} of {of_file}");
            return Err(Error::malformed(found, format!("count from 0 up to {}", of_file - 1)));
        }
        let is_bad = |band: &Option<usize>| {
            band.is_none_or(|band| named.contains(&band) || self.found.bad_bands.contains(&band))
        };
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
    /// A file that does not, bands that are there twice or that no thermal camera has.
    pub(super) fn bands(&self, path: &Path) -> Result<Bands> {
        let centres = self.found.centres_cm1.iter().flatten();
        if let Some(band) = centres.clone().position(|nu| !BANDS_CM1.contains(nu)) {
            let centre_cm1 = centres.clone().nth(band).copied().unwrap_or(f64::NAN);
            let found = format!(
                "band {band} of the cube is at {} um by its file, where nothing is seen by heat",
                significant(1e4 / centre_cm1, 3)
            );
            let error =
                Error::malformed(found, "mend the unit of the wavelengths in the file, or write [bands]");
            return Err(error.in_file(path));
        }
        match (&self.found.centres_cm1, &self.found.widths_cm1) {
            (Some(centres), Some(widths)) => {
                Bands::from_rows(centres.iter().copied().zip(widths.iter().copied()))
            }
            (Some(centres), None) => {
                evenly_spaced(&self.rising(centres))?;
                Bands::from_centers(centres)
            }
            (None, _) if self.found.axis_without_unit => Err(Error::malformed(
                "the table is missing, and the cube's file lists its wavelengths without a unit, or on an axis that is not read",
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
    /// Another number of bands, or one that the file has elsewhere by more than a quarter of its width.
    pub(super) fn check(&self, bands: &Bands) -> Result<()> {
        check_count(&self.found, bands)?;
        let Some(centres) = &self.found.centres_cm1 else { return Ok(()) };
        let halves = half_widths(bands);
        for (i, ((band, own), half)) in bands.bands().iter().zip(self.rising(centres)).zip(halves).enumerate()
        {
            if (band.center_cm1 - own).abs() > SAME_BAND * half {
                return Err(self.elsewhere(i, own, bands, i));
            }
        }
        Ok(())
    }
}

/// Share of half a band's width by which its centre may be elsewhere in the file: a wide one has another in wavelength than in wavenumber.
const SAME_BAND: f64 = 0.5;

/// Half the width of each band: one node stands for its band; a filter reaches over its rows.
fn half_widths(bands: &Bands) -> impl Iterator<Item = f64> {
    let widths = bands.widths_cm1().into_iter().zip(bands.bands());
    widths.map(|(width, band)| 0.5 * width.max(band.high_cm1 - band.low_cm1))
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
        "write their widths into the file (fwhm), or [bands] with start, stop and step of all of them, or with rows = \"bands.csv\"",
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
        None if found.centres_cm1.is_none() && shape.bands() < bands.len() => {
            "make [bands] those of the cube, or write into its file where the bands are that it has".into()
        }
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
