//! The unit of a cube's samples where a file has it as text beside the array, as MATLAB and NPZ files do, or in a title.
//!
//! Such a text may be of something else, so that one counts only if it is a spectral radiance, a temperature, counts or a share.

use super::sample_unit::SampleUnit;
use hadar::radiance_unit::RadianceUnit;

/// What such a text is called: this, or behind the name of the array.
const NAMES: [&str; 3] = ["units", "unit", "data_units"];
/// Characters that are looked at.
pub(super) const MOST: usize = 200;

/// Whether a text of this name may be the unit of an array.
pub(super) fn is_name(name: &str, of_array: &str) -> bool {
    let is = |unit: &&str| {
        name.eq_ignore_ascii_case(unit) || name.eq_ignore_ascii_case(&format!("{of_array}_{unit}"))
    };
    NAMES.iter().any(is)
}

/// The unit in a text; none where it is of something else.
pub(super) fn of(text: &str) -> Option<String> {
    let text = text.trim_matches(|c: char| c.is_whitespace() || c == '\0');
    let is_unit = RadianceUnit::spelt(text).is_ok()
        || (SampleUnit::spelt(text) != SampleUnit::Other && !SampleUnit::says_nothing(text));
    is_unit.then(|| text.to_owned())
}

/// That in brackets behind the last of some titles: `{Wavelength, Radiance (W/m^2/sr/um)}`.
pub(super) fn of_title(titles: &str) -> Option<String> {
    let (_, title) = titles.rsplit_once(',')?;
    let title = title.trim_end_matches(|c: char| c.is_whitespace() || c == '}');
    let (_, unit) = title.split_once(['(', '['])?;
    of(unit.strip_suffix([')', ']'])?)
}

#[cfg(test)]
mod tests {
    use super::{is_name, of, of_title};

    #[test]
    fn texts_that_are_units_of_samples_count() {
        for (text, is_unit) in [
            ("W m-2 sr-1 um-1\0", true),
            (" microflick ", true),
            ("K", true),
            ("counts", true),
            ("um", false),
            ("", false),
            ("see the manual", false),
        ] {
            assert_eq!(of(text).is_some(), is_unit, "{text}");
        }
        assert!(is_name("Units", "S") && is_name("s_units", "S") && !is_name("wavelength_units", "S"));
        let title = of_title("{Wavelength, Radiance (uW/cm^2/sr/nm)}");
        assert_eq!(title.as_deref(), Some("uW/cm^2/sr/nm"));
        assert_eq!(of_title("{Wavelength (um), Value}"), None);
        assert_eq!(of_title("Radiance"), None);
    }
}
