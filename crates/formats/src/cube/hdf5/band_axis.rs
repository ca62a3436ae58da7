//! Where the bands of an array are: lists beside it, or, if nothing is there, in a group of their own as NASA's spectrometers have them.
//!
//! A list is called `wavelengths` or the like ([`band_list`]), has as many numbers as there are bands and says its unit; `fwhm` beside it has the widths, in its unit, and
//! `good_wavelengths` 0 for a bad band. Lists of several groups count where they agree.
//!
//! Source: EMIT L1B Product User Guide (LP DAAC), 'sensor_band_parameters'.

use super::array::{Array, listed};
use crate::cube::band_list;
use crate::spectral_unit::SpectralUnit;
use hdf5_pure::{Dataset, File};

/// What a file says of its bands.
#[derive(Debug, Default)]
pub(super) struct BandAxis {
    pub(super) centres_cm1: Option<Vec<f64>>,
    pub(super) widths_cm1: Option<Vec<f64>>,
    pub(super) bad: Vec<usize>,
    /// Whether there are only lists that do not say their unit.
    pub(super) unused: bool,
}

impl BandAxis {
    /// Of an array of so many bands, in a file of so many bytes.
    pub(super) fn of(source: &File, array: &str, bands: usize, len: u64) -> Self {
        let (own, _) = parts(array);
        let all = listed(source);
        let beside = Self::of_folder(source, &all, own, bands, len);
        if beside.centres_cm1.is_some() {
            return beside;
        }
        let of_array = source.dataset(array).ok().and_then(|dataset| Array::of(dataset).ok());
        let (centres_cm1, unknown) =
            of_array.map_or((None, false), |array| band_list::of_attributes(&array.attributes, bands));
        if centres_cm1.is_some() {
            return Self { centres_cm1, ..Self::default() };
        }
        let beside = Self { unused: beside.unused || unknown, ..beside };
        // Wavelengths beside another cube are those of another instrument.
        let has_cube = |folder: &str| {
            let deep = |(name, dataset): &(String, Dataset)| {
                parts(name).0 == folder && dataset.shape().is_ok_and(|shape| shape.len() > 1)
            };
            all.iter().any(deep)
        };
        let mut folders: Vec<String> = all
            .iter()
            .map(|(name, _)| parts(name))
            .filter(|(folder, last)| *folder != own && band_list::may_be(last) && !has_cube(folder))
            .map(|(folder, _)| folder.to_owned())
            .collect();
        folders.dedup();
        let mut found = folders.iter().map(|folder| Self::of_folder(source, &all, folder, bands, len));
        let Some(first) = found.find(|axis| axis.centres_cm1.is_some()) else { return beside };
        let agree = found.all(|axis| axis.centres_cm1.is_none() || axis.centres_cm1 == first.centres_cm1);
        if agree { first } else { Self { unused: true, ..Self::default() } }
    }

    fn of_folder(source: &File, all: &[(String, Dataset)], folder: &str, bands: usize, len: u64) -> Self {
        // Some have lists of one row or one column, as MATLAB has.
        let of_bands = |name: &str| {
            let array = Array::of(source.dataset(name).ok()?).and_then(Array::with_values).ok()?;
            (array.sides == [bands] || array.matlab && band_list::is_list(&array.sides, bands))
                .then_some(array)
        };
        let named = |names: &[&str]| {
            let is = |(name, _): &&(String, Dataset)| {
                let (own, last) = parts(name);
                own == folder && names.iter().any(|one| last.eq_ignore_ascii_case(one))
            };
            all.iter().find(is).and_then(|(name, _)| of_bands(name))
        };
        let numbers = |list: &Array| {
            let mut numbers = list.numbers(bands, len)?;
            list.values.iter().for_each(|values| values.of_stored(&mut numbers, 1));
            Some(numbers)
        };
        let mut unused = false;
        let mut centres = |(name, _): &(String, Dataset)| {
            let (own, last) = parts(name);
            // Most arrays are none by their names alone.
            let list = (own == folder && band_list::may_be(last)).then(|| of_bands(name)).flatten()?;
            let unit = band_list::unit(last, list.attributes.stated_unit())?;
            let found = unit.and_then(|unit| {
                let numbers = numbers(&list)?;
                Some((band_list::in_unit(unit, &numbers)?, unit, numbers))
            });
            unused |= found.is_none();
            found
        };
        let Some((centres_cm1, own, centres)) = all.iter().find_map(&mut centres) else {
            return Self { unused, ..Self::default() };
        };
        let widths = named(&["fwhm"]).and_then(|list| {
            let said = list.attributes.stated_unit().map_or(Some(own), SpectralUnit::spelt);
            let widths = numbers(&list).filter(|_| said == Some(own))?;
            band_list::widths_cm1(own, &centres, &widths)
        });
        let good = named(&["good_wavelengths", "good_wavelength"]).and_then(|list| numbers(&list));
        let bad = |(band, good): (usize, f64)| (good == 0.0).then_some(band);
        let bad = good.into_iter().flatten().enumerate().filter_map(bad).collect();
        Self { centres_cm1: Some(centres_cm1), widths_cm1: widths, bad, unused: false }
    }
}

/// The folder of an array, and its own name.
fn parts(path: &str) -> (&str, &str) {
    path.rsplit_once('/').unwrap_or(("", path))
}
