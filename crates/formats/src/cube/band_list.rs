//! Lists of wavelengths or wavenumbers beside a cube, in any file that has arrays or attributes with names.
//!
//! A list is told by its name, whatever its capitals: `wavelength`, `wavenumber`, `frequency` or a short form of them, words such as
//! `band_` or `sensor_` before it and a unit behind it (`wavelengths_um`), or by the name of the dimension of the bands where its unit is one
//! of wavelengths. Where the file states a unit beside the list, that is the unit. A unit is not guessed: of a list without one it is only said
//! that there is one.

use super::attributes::{Attribute, Attributes};
use super::stored::Stored;
use crate::spectral_unit::SpectralUnit;
use hadar::error::{Error, Result};

/// Names of lists, the longer ones of each kind first, and what they count; `""` for what may be several.
const NAMES: [(&str, &str); 13] = [
    ("wavelengths", "wavelength"),
    ("wavelength", "wavelength"),
    ("wavenumbers", "wavenumber"),
    ("wavenumber", "wavenumber"),
    ("frequencies", "frequency"),
    ("frequency", "frequency"),
    ("lambdas", "wavelength"),
    ("lambda", "wavelength"),
    ("wvl", "wavelength"),
    ("wl", "wavelength"),
    ("wn", "wavenumber"),
    ("freq", "frequency"),
    ("nu", ""),
];
/// Names of the dimension of the bands, which lists of their numbers have too.
const BANDS: [&str; 5] = ["band", "bands", "channel", "channels", "spectral"];
/// Words before the name of a list.
const BEFORE: [&str; 12] = [
    "band", "bands", "channel", "sensor", "center", "centre", "central", "centers", "centres", "nominal",
    "spectral", "data",
];
/// Lists in µm by the description of the data that call them so (TeX-1500, 'Data format').
const MICROMETRES: [&str; 2] = ["working_wav", "hsi_wav"];
/// By how much two lists may differ (relative), which rounding explains.
const ROUNDED: f64 = 1e-3;

/// The unit of a list of the places of bands, by its name and by what its file `states` of it: none where an array is called otherwise,
/// `Some(None)` where it is such a list in a unit that is not known.
pub(super) fn unit(name: &str, states: Option<&str>) -> Option<Option<SpectralUnit>> {
    let lower = name.trim().to_lowercase();
    let states = states.filter(|text| !text.trim().is_empty());
    if MICROMETRES.contains(&lower.as_str()) {
        return Some(Some(SpectralUnit::Micrometre));
    }
    if BANDS.contains(&lower.as_str()) {
        // Numbers of bands are no places.
        return states.and_then(SpectralUnit::spelt).map(Some);
    }
    let mut rest = lower.as_str();
    while let Some(short) =
        BEFORE.iter().find_map(|word| rest.strip_prefix(word)?.strip_prefix(['_', ' ', '-', '.']))
    {
        rest = short;
    }
    let named = |(name, quantity): &(&str, &'static str)| Some((rest.strip_prefix(name)?, *quantity));
    let (behind, quantity) = NAMES.iter().find_map(named)?;
    let is_of = |unit: &SpectralUnit| quantity.is_empty() || unit.quantity() == quantity || states.is_some();
    let by_name = match behind {
        "" => None,
        // What is behind it and no unit makes it the name of something else.
        behind if name_ends(rest, behind) => Some(SpectralUnit::spelt(behind)?).filter(is_of),
        _ => return None,
    };
    let stated = states.map(SpectralUnit::spelt);
    Some(match (stated, behind.is_empty()) {
        (None, _) => by_name,
        (Some(stated), true) => stated,
        // Two units that differ are none.
        (Some(stated), false) => stated.filter(|unit| Some(*unit) == by_name),
    })
}

/// Whether an array of this name may be such a list, whatever unit is stated of it.
pub(super) fn may_be(name: &str) -> bool {
    unit(name, None).is_some() || BANDS.contains(&name.to_lowercase().as_str())
}

/// Whether what is behind a name is apart from it, or a unit as it stands: `wavelengthnm`, but not `nuclei`.
fn name_ends(rest: &str, behind: &str) -> bool {
    behind.starts_with(|c: char| !c.is_alphanumeric()) || rest.len() - behind.len() > 6
}

/// Centres of the bands, cm⁻¹, by an attribute of the array; and whether there is only one whose unit is not known.
pub(super) fn of_attributes(attributes: &Attributes, bands: usize) -> (Option<Vec<f64>>, bool) {
    let mut unused = false;
    for (name, value) in attributes.all() {
        let (Attribute::Floating(numbers) | Attribute::Whole(numbers)) = value else { continue };
        let stated = ["units", "unit"].iter().find_map(|unit| attributes.text(&format!("{name}_{unit}")));
        let Some(unit) = unit(name, stated).filter(|_| numbers.len() == bands && bands > 1) else { continue };
        match unit.and_then(|unit| in_unit(unit, numbers)) {
            Some(centres) => return (Some(centres), false),
            None => unused = true,
        }
    }
    (None, unused)
}

/// Whether an array of these sides may be such a list: one of them has as many numbers as there are bands, the others one.
pub(super) fn is_list(sides: &[usize], bands: usize) -> bool {
    sides.contains(&bands) && sides.iter().product::<usize>() == bands && !sides.is_empty()
}

/// Centres of bands, cm⁻¹, from their numbers in a unit; none where a number is none of a band.
pub(super) fn in_unit(unit: SpectralUnit, numbers: &[f64]) -> Option<Vec<f64>> {
    let centres: Vec<f64> = numbers.iter().map(|number| unit.wavenumber_cm1(*number)).collect();
    centres.iter().all(|centre| *centre > 0.0 && centre.is_finite()).then_some(centres)
}

/// Centres of bands, cm⁻¹, by an array of a name with attributes: none where it is no list of such, `Some(None)` where its unit is not known,
/// or a number is missing or none of a band.
pub(super) fn of_array(
    name: &str,
    attributes: &Attributes,
    stored: Stored,
    numbers: impl FnOnce() -> Option<Vec<f64>>,
) -> Option<Option<Vec<f64>>> {
    let unit = unit(name, attributes.stated_unit())?;
    Some(unit.and_then(|unit| {
        let mut numbers = numbers()?;
        if let Some(values) = attributes.values(stored).ok()? {
            values.of_stored(&mut numbers, 1);
        }
        in_unit(unit, &numbers)
    }))
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
        let Some(Some(unit)) = unit(name, None) else { continue };
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
        for (name, stated, expected) in [
            ("wavelengths_um", None, Some(Some(Micrometre))),
            ("Wavelength (nm)", None, Some(Some(Nanometre))),
            ("wavelength_\u{3bc}m", None, Some(Some(Micrometre))),
            ("wavenumber_cm1", None, Some(Some(PerCentimetre))),
            ("lambda_um", None, Some(Some(Micrometre))),
            ("WL", Some("um"), Some(Some(Micrometre))),
            ("nu", Some("cm-1"), Some(Some(PerCentimetre))),
            ("nu", None, Some(None)),
            ("band_wavelength", Some("nm"), Some(Some(Nanometre))),
            ("sensor_band_center_wavelengths", Some("nm"), Some(Some(Nanometre))),
            ("wavenumbers", None, Some(None)),
            ("wavelength", None, Some(None)),
            ("wavelength", Some("furlongs"), Some(None)),
            ("wavelength_cm1", None, Some(None)),
            ("wavelengths_um", Some("nm"), Some(None)),
            // The unit is what counts, not the name.
            ("wavelength", Some("cm-1"), Some(Some(PerCentimetre))),
            ("channel", Some("um"), Some(Some(Micrometre))),
            ("band", None, None),
            ("band", Some("1"), None),
            ("wavelength_error", Some("um"), None),
            ("nuclei", Some("um"), None),
            ("number", Some("um"), None),
            ("cube", Some("um"), None),
        ] {
            assert_eq!(unit(name, stated), expected, "{name}");
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
