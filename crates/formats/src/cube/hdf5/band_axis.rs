//! Where the bands of an array are: lists beside it, or, if nothing is there, in a group of their own as NASA's spectrometers have them.
//!
//! A list is called `wavelengths` or the like, has as many numbers as there are bands and says its unit; `fwhm` beside it has the widths, in its unit, and
//! `good_wavelengths` 0 for a bad band. Lists of several groups count where they agree.
//!
//! Source: EMIT L1B Product User Guide (LP DAAC), 'sensor_band_parameters'.

use super::array::listed;
use super::source::check_chunks;
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
        let own = array.rsplit_once('/').map_or("", |(folder, _)| folder);
        let beside = Self::of_folder(source, own, bands, len);
        if beside.centres_cm1.is_some() {
            return beside;
        }
        let mut folders: Vec<String> = listed(source)
            .into_iter()
            .filter_map(|(name, _)| {
                let (folder, last) = name.rsplit_once('/').unwrap_or(("", &name));
                (folder != own && band_list::is_axis(last)).then(|| folder.to_owned())
            })
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
            source.dataset(&path).ok().filter(|axis| axis.shape().is_ok_and(|shape| shape == [bands as u64]))
        };
        let numbers = |axis: &Dataset| {
            check_chunks(axis, len).ok()?;
            axis.read_f64().ok()
        };
        let unit = |axis: &Dataset| Some(axis.attrs().ok()?.get("units")?.as_str()?.to_owned());
        let axes: Vec<Dataset> = band_list::AXIS.iter().filter_map(of_bands).collect();
        let centres = |axis: &Dataset| {
            let (unit, numbers) = (unit(axis)?, numbers(axis)?);
            Some((band_list::in_unit(&unit, &numbers)?, SpectralUnit::spelt(&unit)?, numbers))
        };
        let Some((centres_cm1, own, centres)) = axes.iter().find_map(centres) else {
            return Self { unused: !axes.is_empty(), ..Self::default() };
        };
        let widths = of_bands(&"fwhm").and_then(|list| {
            let said = unit(&list).map_or(Some(own), |unit| SpectralUnit::spelt(&unit));
            let widths = numbers(&list).filter(|_| said == Some(own))?;
            band_list::widths_cm1(own, &centres, &widths)
        });
        let good =
            ["good_wavelengths", "good_wavelength"].iter().find_map(of_bands).and_then(|list| numbers(&list));
        let bad = |(band, good): (usize, f64)| (good == 0.0).then_some(band);
        let bad = good.into_iter().flatten().enumerate().filter_map(bad).collect();
        Self { centres_cm1: Some(centres_cm1), widths_cm1: widths, bad, unused: false }
    }
}
