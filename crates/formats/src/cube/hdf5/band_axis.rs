//! Where the bands of an array are: lists beside it, or, if nothing is there, in a group of their own as NASA's spectrometers have them.
//!
//! A list is called `wavelengths` or the like, has as many numbers as there are bands and says its unit; `fwhm` beside it has the widths, in its unit, and
//! `good_wavelengths` 0 for a bad band. Lists of several groups count where they agree.
//!
//! Source: EMIT L1B Product User Guide (LP DAAC), 'sensor_band_parameters'.

use super::array::{Array, listed};
use super::source::check_chunks;
use crate::cube::band_list;
use crate::cube::packed::Slices;
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
        let beside = Self::of_folder(source, own, bands, len);
        if beside.centres_cm1.is_some() {
            return beside;
        }
        let all = listed(source);
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
            .filter(|(folder, last)| *folder != own && band_list::is_axis(last) && !has_cube(folder))
            .map(|(folder, _)| folder.to_owned())
            .collect();
        folders.dedup();
        let mut found = folders.iter().map(|folder| Self::of_folder(source, folder, bands, len));
        let Some(first) = found.find(|axis| axis.centres_cm1.is_some()) else { return beside };
        let agree = found.all(|axis| axis.centres_cm1.is_none() || axis.centres_cm1 == first.centres_cm1);
        if agree { first } else { Self { unused: true, ..Self::default() } }
    }

    fn of_folder(source: &File, folder: &str, bands: usize, len: u64) -> Self {
        let of_bands = |name: &&str| {
            let path = if folder.is_empty() { (*name).to_owned() } else { format!("{folder}/{name}") };
            let array = Array::of(source.dataset(&path).ok()?).and_then(Array::with_values).ok()?;
            (array.sides == [bands]).then_some(array)
        };
        let numbers = |list: &Array| {
            check_chunks(&list.dataset, len).ok()?;
            let mut numbers = vec![0.0; bands];
            list.slices(0, bands, &mut numbers).ok()?;
            list.values.iter().for_each(|values| values.of_stored(&mut numbers, 1));
            Some(numbers)
        };
        let axes: Vec<Array> = band_list::AXIS.iter().filter_map(of_bands).collect();
        let centres = |axis: &Array| {
            let (unit, numbers) = (axis.unit.as_deref()?, numbers(axis)?);
            Some((band_list::in_unit(unit, &numbers)?, SpectralUnit::spelt(unit)?, numbers))
        };
        let Some((centres_cm1, own, centres)) = axes.iter().find_map(centres) else {
            return Self { unused: !axes.is_empty(), ..Self::default() };
        };
        let widths = of_bands(&"fwhm").and_then(|list| {
            let said = list.unit.as_deref().map_or(Some(own), SpectralUnit::spelt);
            let widths = numbers(&list).filter(|_| said == Some(own))?;
            band_list::widths_cm1(own, &centres, &widths)
        });
        let good = ["good_wavelengths", "good_wavelength"].iter().find_map(of_bands);
        let good = good.and_then(|list| numbers(&list));
        let bad = |(band, good): (usize, f64)| (good == 0.0).then_some(band);
        let bad = good.into_iter().flatten().enumerate().filter_map(bad).collect();
        Self { centres_cm1: Some(centres_cm1), widths_cm1: widths, bad, unused: false }
    }
}

/// The folder of an array, and its own name.
fn parts(path: &str) -> (&str, &str) {
    path.rsplit_once('/').unwrap_or(("", path))
}
