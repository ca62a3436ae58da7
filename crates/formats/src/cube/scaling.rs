//! Factors and offsets of samples under other names than those of a format's own conventions.
//!
//! Which way they go differs: HDF4 has scale · (number − offset) where NetCDF has scale · number + offset, and ENVI divides. They are
//! therefore never applied, and never passed over: a cube that was not unpacked looks like one that was.

use hadar::error::{Error, Result};

/// What the factor is of, where its name says so.
const OF: [&str; 10] = [
    "radiance",
    "data",
    "sample",
    "samples",
    "value",
    "values",
    "cube",
    "counts",
    "temperature",
    "emissivity",
];
const FACTORS: [&str; 16] = [
    "scale",
    "scales",
    "scalefactor",
    "scalefactors",
    "scaling",
    "scalingfactor",
    "slope",
    "slopes",
    "mult",
    "multiplier",
    "factor",
    "conversionfactor",
    "calibrationfactor",
    "gain",
    "gains",
    "gainvalues",
];
const OFFSETS: [&str; 9] = [
    "offset",
    "offsets",
    "addoffset",
    "addoffsets",
    "intercept",
    "intercepts",
    "bias",
    "offsetvalues",
    "add",
];
/// Words that say a factor only with what it is of: a camera has a gain, too.
const OF_MUCH: [&str; 7] = ["gain", "gains", "factor", "mult", "bias", "add", "gainvalues"];

/// The number that leaves samples as they are, if a name is that of a factor or an offset; of the array `of_array`, whose name may be before it.
fn neutral(name: &str, of_array: &str) -> Option<f64> {
    let plain = |text: &str| -> String {
        text.chars().filter(char::is_ascii_alphanumeric).map(|char| char.to_ascii_lowercase()).collect()
    };
    let (name, array) = (plain(name), plain(of_array));
    let behind = OF.into_iter().chain([array.as_str()]).filter(|of| !of.is_empty());
    let kind = behind.filter_map(|of| name.strip_prefix(of)).find(|kind| !kind.is_empty());
    let is = |known: &[&str]| {
        kind.is_some_and(|kind| known.contains(&kind))
            || known.contains(&name.as_str()) && !OF_MUCH.contains(&name.as_str())
    };
    is(&FACTORS).then_some(1.0).or_else(|| is(&OFFSETS).then_some(0.0))
}

/// Whether a name is that of a factor or an offset of the samples of an array.
pub(super) fn is_named(name: &str, of_array: &str) -> bool {
    neutral(name, of_array).is_some()
}

/// Refuses numbers that would change the samples of an array.
///
/// # Errors
/// A factor other than 1, an offset other than 0, under a name of one.
pub(super) fn check(name: &str, of_array: &str, numbers: &[f64]) -> Result<()> {
    let Some(neutral) = neutral(name, of_array) else { return Ok(()) };
    if numbers.iter().all(|number| *number == neutral) {
        return Ok(());
    }
    let found = match numbers {
        [number] => format!("samples that are packed: {name} is {number}"),
        _ => format!("samples that are packed: {name} is not {neutral} throughout"),
    };
    let instead = "write them unpacked, or say it as the format does: attributes scale_factor and add_offset of the array (NetCDF, HDF5, Zarr), `data gain values` (ENVI)";
    Err(Error::malformed(found, instead).for_key(name))
}

#[cfg(test)]
mod tests {
    use super::{check, neutral};

    #[test]
    fn names_of_factors_and_offsets_are_known_and_others_are_not() {
        let factors = [
            "scale",
            "Slope",
            "ScaleFactor",
            "radiance_scale",
            "radiance scale factor",
            "cube_gain",
            "S_scale",
        ];
        for factor in factors {
            assert_eq!(neutral(factor, "S"), Some(1.0), "{factor}");
        }
        for offset in ["offset", "Intercept", "radiance_offset", "S_bias"] {
            assert_eq!(neutral(offset, "S"), Some(0.0), "{offset}");
        }
        let others = [
            "gain",
            "factor",
            "DIMENSION_SCALE",
            "grayscale",
            "bias",
            "data",
            "time_scale",
            "header offset",
            "",
        ];
        for other in others {
            assert_eq!(neutral(other, "S"), None, "{other}");
        }
    }

    #[test]
    fn what_changes_no_sample_is_passed() {
        assert!(check("scale", "", &[1.0, 1.0]).is_ok() && check("offset", "", &[0.0]).is_ok());
        for numbers in [&[0.01][..], &[1.0, 2.0], &[f64::NAN]] {
            let error = check("slope", "", numbers).unwrap_err().to_string();
            assert!(error.contains("slope") && error.contains("unpacked"), "{error}");
        }
    }
}
