//! Values with a unit of their own: astropy, pint, unyt, and arrays whose attributes name one (xarray, pandas).
//!
//! What means the same is converted, all else is refused by its name; nothing is stripped. A bare number means what the documentation says.

use crate::error::raised;
use hadar::Error;
use hadar_formats::spectral_unit::SpectralUnit;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyString, PyTuple};

/// What an argument is measured in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum In {
    /// Absolute temperature, K.
    Kelvin,
    /// Difference of temperatures, K.
    Kelvins,
    /// Wavenumber, cm⁻¹; wavelengths and frequencies become it.
    PerCentimetre,
    /// Shares and other numbers without a unit.
    One,
    /// Photons or counts.
    Counts,
    /// What only the documentation says, such as photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹: no unit of another library is understood.
    Stated(&'static str),
}

/// Arguments whose unit only the documentation says.
pub(crate) const RADIANCE: In = In::Stated("in photons s^-1 m^-2 sr^-1 per cm^-1");
pub(crate) const PER_RADIANCE: In = In::Stated("counts for each unit of a band's signal, m^2 sr s");
pub(crate) const COUNTS_SQUARED: In = In::Stated("a variance in counts^2");

/// Units of packages of quantities.
const PACKAGES: [&str; 3] = ["astropy", "pint", "unyt"];
/// How temperatures are spelt, in lower case without blanks and underscores, with what makes kelvins of them: factor, offset.
const TEMPERATURES: &[(&[&str], f64, f64)] = &[
    (&["k", "kelvin", "kelvins", "degk"], 1.0, 0.0),
    (&["degc", "c", "°c", "℃", "celsius", "degreecelsius", "degreescelsius", "degreec"], 1.0, 273.15),
    (
        &["degf", "f", "°f", "℉", "fahrenheit", "degreefahrenheit", "degreesfahrenheit", "degreef"],
        5.0 / 9.0,
        459.67 * 5.0 / 9.0,
    ),
];
const ONES: &[&str] = &["", "1", "dimensionless", "none", "unitless"];
const COUNTS: &[&str] = &["count", "counts", "ct", "photon", "photons", "ph", "electron", "electrons"];

/// Values without their unit, in the one that is wanted; as they are where they have none. `None` of what has no unit.
pub(crate) fn converted<'py>(
    given: &Bound<'py, PyAny>,
    what: &str,
    wanted: In,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    if given.is_instance_of::<PyString>() {
        return Ok(None);
    }
    if given.is_instance_of::<PyList>() || given.is_instance_of::<PyTuple>() {
        // As far as the first item of every list in it: arrays of numbers have no more to say.
        if let Some(first) = given.try_iter()?.next().transpose()?
            && converted(&first, what, wanted)?.is_some()
        {
            let found = format!("{what}: a list of quantities, each with a unit of its own");
            return Err(raised(Error::malformed(found, "give one array with one unit")));
        }
        return Ok(None);
    }
    let Some((values, unit)) = parts(given)? else { return Ok(None) };
    let plain: String =
        unit.to_lowercase().chars().filter(|char| !char.is_whitespace() && *char != '_').collect();
    let refused = |instead: &str| {
        Err(raised(Error::malformed(format!("{what}: the unit `{unit}` of the values"), instead)))
    };
    let scaled = |factor: f64, offset: f64| -> PyResult<Bound<'py, PyAny>> {
        let values = floats(&values)?;
        let values = if factor == 1.0 { values } else { values.mul(factor)? };
        if offset == 0.0 { Ok(values) } else { values.add(offset) }
    };
    match wanted {
        In::Kelvin => match TEMPERATURES.iter().find(|(names, ..)| names.contains(&plain.as_str())) {
            Some((_, factor, offset)) => scaled(*factor, *offset).map(Some),
            None => refused("give temperatures in K, degC or degF"),
        },
        // A difference in degC is one in K, and nobody can tell whether it is one.
        In::Kelvins if matches!(plain.as_str(), "k" | "kelvin" | "deltadegc" | "deltadegreecelsius") => {
            scaled(1.0, 0.0).map(Some)
        }
        In::Kelvins => refused("give a difference of temperatures in K"),
        In::PerCentimetre => match SpectralUnit::spelt(&unit) {
            // ν = ν(1)/λ of a wavelength, ν(1) f of a frequency.
            Some(unit) if unit.quantity() == "wavelength" => {
                let numpy = values.py().import(intern!(values.py(), "numpy"))?;
                numpy.call_method1("true_divide", (unit.wavenumber_cm1(1.0), floats(&values)?)).map(Some)
            }
            Some(unit) => scaled(unit.wavenumber_cm1(1.0), 0.0).map(Some),
            None => refused("give wavenumbers in cm^-1, or wavelengths in um or nm"),
        },
        In::One if ONES.contains(&plain.as_str()) => scaled(1.0, 0.0).map(Some),
        In::One if matches!(plain.as_str(), "%" | "percent") => scaled(0.01, 0.0).map(Some),
        In::One => refused("give plain numbers; this one has no unit"),
        In::Counts if ONES.contains(&plain.as_str()) || COUNTS.contains(&plain.as_str()) => {
            scaled(1.0, 0.0).map(Some)
        }
        In::Counts => refused("give counts: photons or electrons, without another unit"),
        In::Stated(said) => refused(&format!("give plain numbers, {said}")),
    }
}

/// A unit of another library as scenarios spell it; what is not known there is refused there, by its name.
pub(crate) fn as_written(unit: &str) -> String {
    let plain: String =
        unit.to_lowercase().chars().filter(|char| !char.is_whitespace() && *char != '_').collect();
    let known = TEMPERATURES.iter().zip(["K", "degC", "degF"]);
    let of_temperature = known.into_iter().find(|((names, ..), _)| names.contains(&plain.as_str()));
    match (of_temperature, SpectralUnit::spelt(unit)) {
        (Some((_, name)), _) => name.to_owned(),
        (None, Some(unit)) if !matches!(unit, SpectralUnit::Metre | SpectralUnit::Hertz) => {
            unit.name().to_owned()
        }
        _ => match plain.as_str() {
            "meter" => "m".to_owned(),
            "second" => "s".to_owned(),
            "millisecond" => "ms".to_owned(),
            _ => unit.to_owned(),
        },
    }
}

/// Values as an array of f64; one that says what is missing still does.
fn floats<'py>(values: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let numpy = values.py().import(intern!(values.py(), "numpy"))?;
    numpy.call_method1("asanyarray", (values, "float64"))
}

/// Values and the unit that they have, if they have one.
pub(crate) fn parts<'py>(given: &Bound<'py, PyAny>) -> PyResult<Option<(Bound<'py, PyAny>, String)>> {
    for name in ["unit", "units"] {
        let Ok(unit) = given.getattr(name) else { continue };
        let module: String = unit.get_type().getattr("__module__")?.extract().unwrap_or_default();
        if !PACKAGES.iter().any(|package| module == *package || module.starts_with(&format!("{package}."))) {
            continue;
        }
        let values = ["magnitude", "value"].into_iter().find_map(|values| given.getattr(values).ok());
        let text = unit.str()?.extract()?;
        return Ok(Some((values.unwrap_or_else(|| given.clone()), text)));
    }
    let Ok(attributes) = given.getattr("attrs") else { return Ok(None) };
    // Of an array of quantities the quantities say it.
    if let Ok(data) = given.getattr("data")
        && !data.hasattr("attrs")?
        && let Some(found) = parts(&data)?
    {
        return Ok(Some(found));
    }
    for name in ["units", "unit"] {
        if let Ok(unit) = attributes.get_item(name)
            && let Ok(text) = unit.extract::<String>()
        {
            let values = given.getattr("values").unwrap_or_else(|_| given.clone());
            return Ok(Some((values, text)));
        }
    }
    Ok(None)
}

/// A number in the unit that is wanted.
pub(crate) fn number(given: &Bound<'_, PyAny>, what: &str, wanted: In) -> PyResult<f64> {
    let values = converted(given, what, wanted)?;
    let given = values.as_ref().unwrap_or(given);
    let one = given.call_method0(intern!(given.py(), "item")).and_then(|one| one.extract());
    one.or_else(|_| given.extract()).map_err(|_| {
        let kind = given.get_type().name().map(|name| name.to_string()).unwrap_or_default();
        raised(Error::malformed(format!("{what}: no number but a value of type {kind}"), "give one number"))
    })
}
