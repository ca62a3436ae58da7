//! Lists of wavelengths or wavenumbers beside a cube, in files of arrays with names: NPZ, MATLAB 5.
//!
//! One of as many numbers as the cube has bands says where they are, in its order, if its name is `wavelength` or `wavenumber`
//! (or several of them) with a unit behind it, as in `wavelengths_um`. A unit is not guessed: of a list without one it is only
//! said that there is one.

use super::attributes::Attributes;
use super::stored::Stored;
use crate::spectral_unit::SpectralUnit;
use hadar::error::{Error, Result};

/// Names of lists, the longer ones first, and what they count.
const NAMES: [(&str, &str); 4] = [
    ("wavelengths", "wavelength"),
    ("wavelength", "wavelength"),
    ("wavenumbers", "wavenumber"),
    ("wavenumber", "wavenumber"),
];
/// Lists in µm by the description of the data that call them so (TeX-1500, 'Data format').
const MICROMETRES: [&str; 2] = ["working_wav", "hsi_wav"];
/// By how much two lists may differ (relative), which rounding explains.
const ROUNDED: f64 = 1e-3;

/// Whether an array is called as a list is, and the unit behind its name.
pub(super) fn unit_of(name: &str) -> Option<Option<SpectralUnit>> {
    let lower = name.to_lowercase();
    if MICROMETRES.contains(&lower.as_str()) {
        return Some(Some(SpectralUnit::Micrometre));
    }
    let (rest, quantity) =
        NAMES.iter().find_map(|(name, quantity)| Some((lower.strip_prefix(name)?, *quantity)))?;
    if rest.is_empty() {
        return Some(None);
    }
    // A unit of something else is none.
    SpectralUnit::spelt(rest).map(|unit| Some(unit).filter(|unit| unit.quantity() == quantity))
}

/// What the spectral axis of a file is called, in lower case.
pub(super) const AXIS: [&str; 7] =
    ["wavelength", "wavelengths", "wavenumber", "wavenumbers", "lambda", "frequency", "frequencies"];

/// Whether an array is called as a spectral axis is.
pub(super) fn is_axis(name: &str) -> bool {
    AXIS.contains(&name.to_lowercase().as_str())
}

/// Centres of bands, cm⁻¹, from their numbers in a unit; none where it is no unit, or a number none of a band.
pub(super) fn in_unit(unit: &str, numbers: &[f64]) -> Option<Vec<f64>> {
    let unit = SpectralUnit::spelt(unit)?;
    let centres: Vec<f64> = numbers.iter().map(|number| unit.wavenumber_cm1(*number)).collect();
    centres.iter().all(|centre| *centre > 0.0 && centre.is_finite()).then_some(centres)
}

/// The numbers of a list as its attributes say what they stand for, and its unit; none where they do not say it, or a number is missing.
pub(super) fn said_by(
    attributes: &Attributes,
    stored: Stored,
    mut numbers: Vec<f64>,
) -> Option<(String, Vec<f64>)> {
    let unit = attributes.text("units")?.to_owned();
    if let Some(values) = attributes.values(stored).ok()? {
        values.of_stored(&mut numbers, 1);
    }
    Some((unit, numbers))
}

/// Widths of bands, cm⁻¹, from their centres and widths in a unit; none where one is no width of a band.
pub(super) fn widths_cm1(unit: SpectralUnit, centres: &[f64], widths: &[f64]) -> Option<Vec<f64>> {
    let width = |(centre, width): (&f64, &f64)| {
        let [a, b] = [-0.5, 0.5].map(|half| unit.wavenumber_cm1(centre + half * width));
        (*width > 0.0 && *width < 2.0 * centre).then(|| (a - b).abs())
    };
    let widths: Option<Vec<f64>> = centres.iter().zip(widths).map(width).collect();
    widths.filter(|widths| widths.iter().all(|width| *width > 0.0 && width.is_finite()))
}

/// Centres of the bands by lists with their names, cm⁻¹; and whether there are only lists without a unit.
///
/// # Errors
/// A list that says its unit with a number that is none of a band, or one number twice; two lists that differ.
pub(super) fn centres(lists: &[(String, Vec<f64>)]) -> Result<(Option<Vec<f64>>, bool)> {
    let mut found: Option<(&str, Vec<f64>)> = None;
    for (name, values) in lists {
        let Some(Some(unit)) = unit_of(name) else { continue };
        let centres: Vec<f64> = values.iter().map(|value| unit.wavenumber_cm1(*value)).collect();
        let mut sorted = centres.clone();
        sorted.sort_by(f64::total_cmp);
        let positive = |nu: &f64| *nu > 0.0 && nu.is_finite();
        if !centres.iter().all(positive) || sorted.windows(2).any(|pair| pair.first() == pair.last()) {
            let error = "these are no bands: one is not above 0, not finite or there twice";
            let instead = format!("correct the array `{name}`, or leave it out of the file");
            return Err(Error::malformed(error, instead).for_key(name.as_str()));
        }
        match &found {
            None => found = Some((name, centres)),
            Some((first, own)) => {
                let agree = |(a, b): (&f64, &f64)| (a - b).abs() <= ROUNDED * a;
                if !own.iter().zip(&centres).all(agree) {
                    let error = format!("the bands are elsewhere by this list than by `{first}`");
                    let instead = "keep the list that is true";
                    return Err(Error::malformed(error, instead).for_key(name.as_str()));
                }
            }
        }
    }
    let unused = found.is_none() && !lists.is_empty();
    Ok((found.map(|(_, centres)| centres), unused))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_is_told_by_its_name() {
        use SpectralUnit::{Micrometre, Nanometre, PerCentimetre};
        for (name, unit) in [
            ("wavelengths_um", Some(Some(Micrometre))),
            ("Wavelength (nm)", Some(Some(Nanometre))),
            ("wavelength_\u{3bc}m", Some(Some(Micrometre))),
            ("wavenumber_cm1", Some(Some(PerCentimetre))),
            ("wavenumbers", Some(None)),
            ("wavelength", Some(None)),
            ("wavelength_cm1", Some(None)),
            ("wavelength_error", None),
            ("cube", None),
        ] {
            assert_eq!(unit_of(name), unit, "{name}");
        }
    }

    #[test]
    fn lists_agree_and_have_numbers_of_bands() {
        let list = |name: &str, values: &[f64]| (name.to_owned(), values.to_vec());
        let (um, cm1) = (list("wavelength_um", &[8.0, 10.0]), list("wavenumber_cm1", &[1250.0, 1000.0]));
        assert_eq!(centres(&[um.clone(), cm1]), Ok((Some(vec![1250.0, 1000.0]), false)));
        assert_eq!(centres(&[list("wavelength", &[8.0, 10.0])]), Ok((None, true)));
        assert_eq!(centres(&[]), Ok((None, false)));
        let message = |lists: &[(String, Vec<f64>)]| centres(lists).unwrap_err().to_string();
        let other = message(&[um, list("wavenumber_cm1", &[1250.0, 1002.0])]);
        assert!(other.starts_with("wavenumber_cm1: ") && other.contains("`wavelength_um`"), "{other}");
        for bad in [[8.0, 8.0], [0.0, 8.0], [f64::NAN, 8.0], [-1.0, 8.0]] {
            assert!(message(&[list("wavelength_um", &bad)]).contains("no bands"));
        }
    }
}
