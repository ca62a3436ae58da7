//! Values with a unit of their own: astropy, pint, unyt, and arrays whose attributes name one (xarray, pandas).
//!
//! What means the same is converted, all else is refused by its name; nothing is stripped. A bare number means what the documentation says.

use crate::error::raised;
use hadar::Error;
use hadar_formats::spectral_unit::SpectralUnit;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyFloat, PyInt, PyList, PyString, PyTuple};

/// What an argument is measured in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum In {
    /// Absolute temperature, K.
    Kelvin,
    /// Difference of temperatures, K.
    Kelvins,
    /// Wavenumber, cm⁻¹; wavelengths and frequencies become it.
    PerCentimetre,
    /// Difference of wavenumbers, cm⁻¹.
    PerCentimetres,
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
/// How texts spell temperatures, without blanks and underscores, with what makes kelvins of them: factor, offset.
const TEMPERATURES: &[(&[&str], f64, f64)] = &[
    (&["K", "kelvin", "kelvins", "degK"], 1.0, 0.0),
    (&["degC", "C", "°C", "℃", "celsius", "degreeCelsius", "degreesCelsius", "degreeC"], 1.0, 273.15),
    (
        &["degF", "F", "°F", "℉", "fahrenheit", "degreeFahrenheit", "degreesFahrenheit", "degreeF"],
        5.0 / 9.0,
        459.67 * 5.0 / 9.0,
    ),
];
const DIFFERENCES: &[&str] = &["K", "kelvin", "kelvins", "deltadegC", "deltadegreeCelsius"];
const ONES: &[&str] = &["", "1", "dimensionless", "none", "unitless"];
const PERCENT: &[&str] = &["%", "percent"];
const COUNTS: &[&str] = &["count", "counts", "ct", "photon", "photons", "ph", "electron", "electrons"];
/// Units in full, and as scenarios spell them.
const IN_FULL: [(&str, &str); 6] = [
    ("meter", "m"),
    ("second", "s"),
    ("millisecond", "ms"),
    ("degree", "deg"),
    ("radian", "rad"),
    ("milliradian", "mrad"),
];
/// Lists in lists have no more levels than arrays of NumPy have dimensions.
const DEEPEST: usize = 64;

/// Whether a unit is one of these; of short ones, as of their prefixes, the case counts.
fn is_of(names: &[&str], unit: &str) -> bool {
    let plain: String = unit.chars().filter(|char| !char.is_whitespace() && *char != '_').collect();
    let long = plain.chars().count() > 2;
    names.iter().any(|name| *name == plain || long && name.to_lowercase() == plain.to_lowercase())
}

/// Values without their unit, in the one that is wanted; as they are where they have none. `None` of what has no unit.
pub(crate) fn converted<'py>(
    given: &Bound<'py, PyAny>,
    what: &str,
    wanted: In,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    if given.is_instance_of::<PyString>() {
        return Ok(None);
    }
    if is_list(given) {
        return plain_throughout(given, what, DEEPEST).map(|()| None);
    }
    let Some(Parts { values, unit, of }) = parts(given)? else { return Ok(None) };
    refuse_masked(&values, what)?;
    let found = match (of, wanted.in_libraries()) {
        (Some(of), Some(unit)) => by_its_library(&of, &values, unit)?,
        _ => wanted.factor(&unit).map(|how| scaled(&values, how)).transpose()?,
    };
    found.map(Some).ok_or_else(|| {
        raised(Error::malformed(format!("{what}: the unit `{unit}` of the values"), wanted.instead()))
    })
}

/// What makes numbers in a unit ones in another.
enum How {
    Scaled {
        factor: f64,
        offset: f64,
    },
    /// ν = ν(1)/λ of a wavelength.
    Inverted {
        one: f64,
    },
}

impl In {
    /// Its unit where libraries convert to it; `delta` of what has no zero.
    const fn in_libraries(self) -> Option<&'static str> {
        match self {
            Self::Kelvin => Some("K"),
            Self::Kelvins => Some("delta_K"),
            Self::PerCentimetre => Some("cm^-1"),
            Self::PerCentimetres => Some("delta_cm^-1"),
            Self::One | Self::Counts | Self::Stated(_) => None,
        }
    }

    /// How numbers are converted whose unit is a text.
    fn factor(self, unit: &str) -> Option<How> {
        let by = |factor| How::Scaled { factor, offset: 0.0 };
        match self {
            Self::Kelvin => {
                let found = TEMPERATURES.iter().find(|(names, ..)| is_of(names, unit));
                found.map(|(_, factor, offset)| How::Scaled { factor: *factor, offset: *offset })
            }
            // A difference in degC is one in K, and nobody can tell whether it is one.
            Self::Kelvins => is_of(DIFFERENCES, unit).then_some(by(1.0)),
            Self::PerCentimetre => SpectralUnit::spelt(unit).map(|unit| match unit.quantity() {
                "wavelength" => How::Inverted { one: unit.wavenumber_cm1(1.0) },
                _ => by(unit.wavenumber_cm1(1.0)),
            }),
            Self::PerCentimetres => {
                let unit = SpectralUnit::spelt(unit).filter(|unit| unit.quantity() == "wavenumber");
                unit.map(|unit| by(unit.wavenumber_cm1(1.0)))
            }
            Self::One if is_of(PERCENT, unit) => Some(by(0.01)),
            Self::One => is_of(ONES, unit).then_some(by(1.0)),
            Self::Counts => (is_of(ONES, unit) || is_of(COUNTS, unit)).then_some(by(1.0)),
            Self::Stated(_) => None,
        }
    }

    fn instead(self) -> String {
        match self {
            Self::Kelvin => "give temperatures in K, degC or degF".to_owned(),
            Self::Kelvins => "give a difference of temperatures in K".to_owned(),
            Self::PerCentimetre => "give wavenumbers in cm^-1, or wavelengths in um or nm".to_owned(),
            Self::PerCentimetres => "give a difference of wavenumbers in cm^-1".to_owned(),
            Self::One => "give plain numbers; this one has no unit".to_owned(),
            Self::Counts => "give counts: photons or electrons, without another unit".to_owned(),
            Self::Stated(said) => format!("give plain numbers, {said}"),
        }
    }
}

fn scaled<'py>(values: &Bound<'py, PyAny>, how: How) -> PyResult<Bound<'py, PyAny>> {
    let values = floats(values)?;
    match how {
        How::Scaled { factor, offset } => {
            let values = if factor == 1.0 { values } else { values.mul(factor)? };
            if offset == 0.0 { Ok(values) } else { values.add(offset) }
        }
        How::Inverted { one } => {
            let numpy = values.py().import(intern!(values.py(), "numpy"))?;
            numpy.call_method1("true_divide", (one, values))
        }
    }
}

fn is_list(given: &Bound<'_, PyAny>) -> bool {
    given.is_instance_of::<PyList>() || given.is_instance_of::<PyTuple>()
}

/// Refuses lists in which something says more than a number: a unit, or what is missing.
fn plain_throughout(given: &Bound<'_, PyAny>, what: &str, deepest: usize) -> PyResult<()> {
    let refused =
        |found: &str, instead: &str| Err(raised(Error::malformed(format!("{what}: {found}"), instead)));
    if deepest == 0 {
        return refused("lists in lists without end", "give an array of numbers");
    }
    for item in given.try_iter()? {
        let item = item?;
        if item.is_instance_of::<PyFloat>() || item.is_instance_of::<PyInt>() {
            continue;
        }
        if is_list(&item) {
            plain_throughout(&item, what, deepest - 1)?;
            continue;
        }
        refuse_masked(&item, what)?;
        if !item.is_instance_of::<PyString>() && parts(&item)?.is_some() {
            return refused(
                "a list of quantities, each with a unit of its own",
                "give one array with one unit",
            );
        }
    }
    Ok(())
}

/// Refuses what has a mask, as arrays of NumPy's `ma` and of astropy, and of them in chunks: of values under it nobody would hear.
pub(crate) fn refuse_masked(given: &Bound<'_, PyAny>, what: &str) -> PyResult<()> {
    let of_chunks = given.getattr("_meta").ok();
    let masks =
        [Some(given), of_chunks.as_ref()].into_iter().flatten().filter_map(|one| one.getattr("mask").ok());
    for mask in masks {
        if !mask.is_none() && !mask.is_callable() {
            let instead = "say what is missing with nan: array.filled(nan)";
            return Err(raised(Error::malformed(format!("{what}: a masked array"), instead)));
        }
    }
    Ok(())
}

/// Values of a quantity in another unit, as its library converts them; none of what means something else.
fn by_its_library<'py>(
    quantity: &Bound<'py, PyAny>,
    values: &Bound<'py, PyAny>,
    wanted: &str,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    let library = quantity.py().import(intern!(quantity.py(), "hadar_limits._quantities"))?;
    let found = library.call_method1("converted", (quantity, values, wanted))?;
    Ok(Some(found).filter(|found| !found.is_none()))
}

/// A number and its unit as scenarios spell it; what is not known there is refused there, by its name.
pub(crate) fn as_written(Parts { unit, of, .. }: &Parts<'_>, value: f64) -> PyResult<(f64, String)> {
    if let Some(of) = of {
        let library = of.py().import(intern!(of.py(), "hadar_limits._quantities"))?;
        if let Some(known) = library.call_method1("written", (of, value))?.extract()? {
            return Ok(known);
        }
    } else {
        let named = TEMPERATURES.iter().zip(["K", "degC", "degF"]);
        if let Some((_, name)) = named.into_iter().find(|((names, ..), _)| is_of(names, unit)) {
            return Ok((value, name.to_owned()));
        }
        match SpectralUnit::spelt(unit) {
            None | Some(SpectralUnit::Metre | SpectralUnit::Hertz) => {}
            Some(unit) => return Ok((value, unit.name().to_owned())),
        }
    }
    let short = IN_FULL.iter().find(|(long, _)| is_of(&[long], unit)).map(|(_, short)| *short);
    Ok((value, short.unwrap_or(unit).to_owned()))
}

/// Values as an array of f64; one that says what is missing still does.
fn floats<'py>(values: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let numpy = values.py().import(intern!(values.py(), "numpy"))?;
    numpy.call_method1("asanyarray", (values, "float64"))
}

/// Values, the unit that they have, and the quantity of a library that they are of, if not a text says the unit.
pub(crate) struct Parts<'py> {
    pub(crate) values: Bound<'py, PyAny>,
    pub(crate) unit: String,
    of: Option<Bound<'py, PyAny>>,
}

/// Values and the unit that they have, if they have one.
pub(crate) fn parts<'py>(given: &Bound<'py, PyAny>) -> PyResult<Option<Parts<'py>>> {
    for name in ["unit", "units"] {
        let Ok(unit) = given.getattr(name) else { continue };
        let module: String = unit.get_type().getattr("__module__")?.extract().unwrap_or_default();
        if !PACKAGES.iter().any(|package| module == *package || module.starts_with(&format!("{package}."))) {
            continue;
        }
        let values = ["magnitude", "value"].into_iter().find_map(|values| given.getattr(values).ok());
        let values = values.unwrap_or_else(|| given.clone());
        return Ok(Some(Parts { values, unit: unit.str()?.extract()?, of: Some(given.clone()) }));
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
            && let Ok(unit) = unit.extract::<String>()
        {
            let values = given.getattr("values").unwrap_or_else(|_| given.clone());
            return Ok(Some(Parts { values, unit, of: None }));
        }
    }
    Ok(None)
}

/// A number in the unit that is wanted.
pub(crate) fn number(given: &Bound<'_, PyAny>, what: &str, wanted: In) -> PyResult<f64> {
    let values = converted(given, what, wanted)?;
    let given = values.as_ref().unwrap_or(given);
    refuse_masked(given, what)?;
    let one = given.call_method0(intern!(given.py(), "item")).and_then(|one| one.extract());
    one.or_else(|_| given.extract()).map_err(|_| {
        let kind = given.get_type().name().map(|name| name.to_string()).unwrap_or_default();
        raised(Error::malformed(format!("{what}: no number but a value of type {kind}"), "give one number"))
    })
}
