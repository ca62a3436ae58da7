//! Heat cubes taken apart.

use crate::array::{array_of, ends, list, numbers, rows, shaped};
use crate::error::{named, raised, shown};
use crate::lent::Lent;
use crate::quantity::{COUNTS_SQUARED, In, PER_RADIANCE, RADIANCE, number};
use crate::scene::bands;
use crate::threads::{Threads, with_limits};
use hadar::demand::Skipping;
use hadar::error::Error;
use hadar_estimate::decompose::{
    LibraryError, Light, Maps, Method, Options, Setting, SpatialPrior, decompose_by,
};
use hadar_study::budget::Limits;
use numpy::PyUntypedArrayMethods as _;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Temperatures that a target may have where nothing is said, K: as `hadar decompose`.
const RANGE_K: [f64; 2] = [200.0, 400.0];

/// Material, temperature and lighting of every pixel, by the names of [`Maps`].
#[pyfunction]
#[pyo3(signature = (cube, library, light, bands, *, counts_per_radiance, var_added=None, units_per_count=None,
    temperature_range=None, lighting_total=None, gain=false, bad_bands=None, light_in_counts=false, prior=None,
    emissivity_error=None, method="ml", potts=None, tex_sgd=None, skipping=true, threads=None, progress=None))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub(crate) fn decompose<'py>(
    py: Python<'py>,
    cube: &Bound<'py, PyAny>,
    library: &Bound<'py, PyAny>,
    light: &Bound<'py, PyAny>,
    bands: &Bound<'py, PyAny>,
    counts_per_radiance: &Bound<'py, PyAny>,
    var_added: Option<&Bound<'py, PyAny>>,
    units_per_count: Option<&Bound<'py, PyAny>>,
    temperature_range: Option<&Bound<'py, PyAny>>,
    lighting_total: Option<&Bound<'py, PyAny>>,
    gain: bool,
    bad_bands: Option<&Bound<'_, PyAny>>,
    light_in_counts: bool,
    prior: Option<&Bound<'py, PyAny>>,
    emissivity_error: Option<&Bound<'py, PyAny>>,
    method: &str,
    potts: Option<&Bound<'py, PyAny>>,
    tex_sgd: Option<&Bound<'py, PyAny>>,
    skipping: bool,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let temperature_k =
        temperature_range.map_or(Ok(RANGE_K), |given| ends(given, "temperature_range", In::Kelvin))?;
    let lent = Lent::of(cube)?;
    let view = lent.view()?;
    let bands = self::bands(bands)?;
    let bad_bands = bad_bands.map_or(Ok(Vec::new()), |given| left_out(given, bands.len()))?;
    let one = |given: Option<&Bound<'_, PyAny>>, what: &str| -> PyResult<Option<f64>> {
        given.map(|given| number(given, what, In::One)).transpose()
    };
    let (units_per_count, lighting_total) =
        (one(units_per_count, "units_per_count")?.unwrap_or(1.0), one(lighting_total, "lighting_total")?);
    let each = |given: &Bound<'_, PyAny>, what: &str| -> PyResult<Vec<f64>> {
        let stated = if what == "var_added" { COUNTS_SQUARED } else { PER_RADIANCE };
        let alone = numbers::<f64>(given, what, stated)?.ndim() == 0;
        let values = list(given, what, stated)?;
        Ok(match values.first() {
            Some(one) if alone => vec![*one; bands.len()],
            _ => values,
        })
    };
    let counts_per_radiance = each(counts_per_radiance, "counts_per_radiance")?;
    let var_added = var_added.map_or(Ok(Vec::new()), |given| each(given, "var_added"))?;
    let library = rows(library, "library", In::One)?;
    let kind = if light_in_counts { Light::Counts } else { Light::Radiance };
    let lit = if light_in_counts { In::Counts } else { RADIANCE };
    let surroundings = match numbers::<f64>(light, "light", lit)?.len() {
        0 => Vec::new(),
        _ => rows(light, "light", lit)?.into_iter().map(kind).collect::<Vec<_>>(),
    };
    let method = named("method", method, &Method::ALL, Method::name).map_err(raised)?;
    let spatial = match (potts, one(tex_sgd, "tex_sgd")?) {
        (None, None) => None,
        (Some(given), None) => {
            let (weight, step) = pair(given, "potts", "give (weight, step in K), or None as the step")?;
            let step = Some(step).filter(|step| !step.is_none());
            Some(SpatialPrior::Potts {
                weight: number(&weight, "potts[0]", In::One)?,
                temperature_step_k: step.map(|step| number(&step, "potts[1]", In::Kelvins)).transpose()?,
            })
        }
        (None, Some(weight)) => Some(SpatialPrior::TexSgd { weight }),
        (Some(_), Some(_)) => {
            return Err(raised(Error::malformed("two priors over the image", "take potts or tex_sgd")));
        }
    };
    let library_error = |given: &Bound<'py, PyAny>| -> PyResult<LibraryError> {
        let what = "emissivity_error";
        let (relative, correlation) = pair(given, what, "give (share, correlation length in cm^-1)")?;
        Ok(LibraryError {
            relative: number(&relative, "emissivity_error[0]", In::One)?,
            correlation_cm1: number(&correlation, "emissivity_error[1]", In::PerCentimetres)?,
        })
    };
    let options = Options {
        prior: prior.map_or(Ok(Vec::new()), |given| list(given, "prior", In::One))?,
        library_error: emissivity_error.map(library_error).transpose()?,
        skipping: if skipping { Skipping::On } else { Skipping::Off },
        spatial,
        ..Options::default()
    };
    let setting = Setting {
        bands: &bands,
        library: &library,
        surroundings: &surroundings,
        counts_per_radiance: &counts_per_radiance,
        var_added: &var_added,
        units_per_count,
        temperature_k,
        lighting_total,
        gain,
        bad_bands: &bad_bands,
        path: None,
        light_besides: &[],
    };
    let mut maps = with_limits(py, threads, &Limits::default(), progress.as_ref(), |counted| {
        counted.set(0, view.cube().shape().rows());
        decompose_by(method, &setting, &options, view.cube(), &|rows| counted.add(rows))
    })?;
    maps.leave_out_unknown_lighting(lighting_total);
    given_back(py, lent.pixels(), surroundings.len(), maps)
}

/// Two values.
fn pair<'py>(
    given: &Bound<'py, PyAny>,
    what: &str,
    instead: &str,
) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
    let found = given.try_iter().and_then(|items| items.take(3).collect::<PyResult<Vec<_>>>());
    match found.as_deref() {
        Ok([one, other]) => Ok((one.clone(), other.clone())),
        _ => Err(raised(Error::malformed(format!("{what}: {}", shown(given)), instead))),
    }
}

/// Bands that are left out: their places, or a mask of all of them.
#[pyfunction]
pub(crate) fn left_out(given: &Bound<'_, PyAny>, bands: usize) -> PyResult<Vec<usize>> {
    let refused = |found: String| {
        let instead = "name bands by numbers from 0, or give a mask with a truth value for each";
        Err(raised(Error::malformed(format!("bad_bands: {found}"), instead)))
    };
    let array = array_of(given, "bad_bands")?;
    let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
    if kind == "b" {
        let mask: Vec<bool> = array.call_method0("ravel")?.call_method0("tolist")?.extract()?;
        if mask.len() != bands {
            return refused(format!("a mask of {} values for {bands} bands", mask.len()));
        }
        return Ok((0..bands).filter(|band| mask[*band]).collect());
    }
    let is_empty = array.len()? == 0;
    if !is_empty && !"iu".contains(&kind) {
        return refused(format!("an array of {}", array.getattr("dtype")?.str()?));
    }
    let places: Vec<i128> =
        if is_empty { Vec::new() } else { array.call_method0("ravel")?.call_method0("tolist")?.extract()? };
    let mut all = Vec::with_capacity(places.len());
    for place in places {
        match usize::try_from(place) {
            Ok(band) if band < bands => all.push(band),
            _ => return refused(format!("{place} of {bands} bands")),
        }
    }
    Ok(all)
}

fn given_back<'py>(
    py: Python<'py>,
    pixels: &[usize],
    surroundings: usize,
    maps: Maps,
) -> PyResult<Bound<'py, PyDict>> {
    let lit: Vec<usize> = pixels.iter().copied().chain([surroundings]).collect();
    let out = PyDict::new(py);
    out.set_item("material", shaped(py, pixels, maps.material)?)?;
    out.set_item("temperature_k", shaped(py, pixels, maps.temperature_k)?)?;
    out.set_item("temperature_sigma_k", shaped(py, pixels, maps.temperature_sigma_k)?)?;
    out.set_item("lighting", shaped(py, &lit, maps.lighting)?)?;
    out.set_item("p_value", shaped(py, pixels, maps.p_value)?)?;
    out.set_item("posterior", shaped(py, pixels, maps.posterior)?)?;
    out.set_item("candidates", shaped(py, pixels, maps.candidates)?)?;
    out.set_item("flags", shaped(py, pixels, maps.flags)?)?;
    Ok(out)
}
