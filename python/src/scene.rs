//! A scene: bands, the target's state, its surroundings, what is unknown, and how photons are counted.

use crate::array::{ends, flat, list, numbers, rows, shaped};
use crate::error::{named, raised};
use crate::order::in_order;
use crate::quantity::{COUNTS_SQUARED, In, PER_RADIANCE, number};
use hadar::error::{Error, Result};
use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::nearest::StateRange;
use hadar::scene::{EnvironmentObject, State, Surroundings};
use hadar::spectrum::Bands;
use numpy::{PyArray1, PyUntypedArrayMethods as _};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::collections::BTreeMap;

/// A target in its surroundings: S = e·B(T) + (1 − e)·Σ V_k ε_k B(T_k), what of it is unknown, and how it is counted.
///
/// bands : (bands,) ascending centres, or (bands, 2) lower and upper ends, cm⁻¹
/// temperature : of the target, K
/// lighting : (surroundings,) thermal lighting factors V ≥ 0, of a sum of at most 1; the rest is deep space
/// environment : (surroundings,) temperatures of the surroundings, K
/// environment_emissivity : (surroundings, nodes); blackbodies where silent
/// unknown : of "temperature", "lighting" (these two where silent), "gain", "environment-temperature"
/// priors : {unknown: deviation}, K or dimensionless
/// lighting_total : ΣV where it is known
/// temperature_range, lighting_range : (low, high) of the alternative's state; all that physics allows where silent
/// counts_per_radiance : étendue × efficiency × time, m² sr s. With it distances are statistical, d; without it they are per
///     √photon, in the limit of shot noise
/// var_added : number or (bands,), variance of noise besides, counts²
///
/// Source: paper S2, S3, S27–S30, S48.
#[pyclass(frozen, module = "hadar_limits")]
#[derive(Debug)]
pub(crate) struct Scene {
    pub(crate) bands: Bands,
    pub(crate) surroundings: Surroundings,
    pub(crate) unknowns: Unknowns,
    pub(crate) state: State,
    pub(crate) range: StateRange,
    /// Counts of a camera; silent for a bound per √photon.
    pub(crate) counting: Option<Counting>,
    /// Bands and unknowns as they were given, of which a copy is made.
    given: Given,
}

#[derive(Debug)]
struct Given {
    shape_of_bands: Vec<usize>,
    bands: Vec<f64>,
    unknown: Option<Vec<String>>,
    priors: BTreeMap<String, f64>,
    lighting_total: Option<f64>,
}

/// Bands by their centres, or by rows of lower and upper ends.
pub(crate) fn bands(given: &Bound<'_, PyAny>) -> PyResult<Bands> {
    let array = numbers::<f64>(given, "bands", In::PerCentimetre)?;
    let view = array.as_array();
    let ascending = |values: &[f64]| match values.windows(2).find(|pair| !matches!(pair, [a, b] if a < b)) {
        None => Ok(()),
        Some(_) => Err(Error::malformed(
            "bands: wavenumbers that do not ascend",
            "sort them, and with them every array over the bands: nu[::-1] turns it round",
        )),
    };
    let found = match (view.ndim(), array.shape()) {
        (0 | 1, _) => {
            let centres: Vec<f64> = view.iter().copied().collect();
            ascending(&centres).and_then(|()| Bands::from_centers(&centres))
        }
        (2, [_, 2]) => {
            let ends: Vec<f64> = view.iter().copied().collect();
            let ranges: Vec<(f64, f64)> =
                ends.chunks_exact(2).filter_map(|ends| Some((*ends.first()?, *ends.get(1)?))).collect();
            let lower: Vec<f64> = ranges.iter().map(|range| range.0).collect();
            ascending(&lower).and_then(|()| Bands::from_ranges(&ranges))
        }
        (_, shape) => Err(Error::malformed(
            format!("bands: an array of shape {shape:?}"),
            "give centres (bands,) or lower and upper ends (bands, 2), in cm^-1",
        )),
    };
    found.map_err(raised)
}

#[pymethods]
impl Scene {
    #[new]
    #[pyo3(signature = (bands, temperature, lighting=None, environment=None, *, environment_emissivity=None,
        unknown=None, priors=None, lighting_total=None, temperature_range=None, lighting_range=None,
        counts_per_radiance=None, var_added=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn new(
        bands: &Bound<'_, PyAny>,
        temperature: &Bound<'_, PyAny>,
        lighting: Option<&Bound<'_, PyAny>>,
        environment: Option<&Bound<'_, PyAny>>,
        environment_emissivity: Option<&Bound<'_, PyAny>>,
        unknown: Option<Vec<String>>,
        priors: Option<BTreeMap<String, Bound<'_, PyAny>>>,
        lighting_total: Option<&Bound<'_, PyAny>>,
        temperature_range: Option<&Bound<'_, PyAny>>,
        lighting_range: Option<&Bound<'_, PyAny>>,
        counts_per_radiance: Option<&Bound<'_, PyAny>>,
        var_added: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let stated = numbers::<f64>(bands, "bands", In::PerCentimetre)?;
        let given = (stated.shape().to_vec(), stated.as_array().iter().copied().collect());
        let of_python = bands;
        let bands = self::bands(bands)?;
        let var_added = var_added
            .map(|given| in_order(given, || Ok(of_python.clone()), "var_added", false))
            .transpose()?;
        let of = |given: Option<&Bound<'_, PyAny>>, what, wanted| {
            given.map_or(Ok(Vec::new()), |given| list(given, what, wanted))
        };
        let temperature = number(temperature, "temperature", In::Kelvin)?;
        let temperature_range =
            temperature_range.map(|given| ends(given, "temperature_range", In::Kelvin)).transpose()?;
        let lighting_range =
            lighting_range.map(|given| ends(given, "lighting_range", In::One)).transpose()?;
        let lighting_total =
            lighting_total.map(|given| number(given, "lighting_total", In::One)).transpose()?;
        let counts_per_radiance = counts_per_radiance
            .map(|given| number(given, "counts_per_radiance", PER_RADIANCE))
            .transpose()?;
        let deviation = |(name, given): (String, Bound<'_, PyAny>)| {
            let wanted = if name.contains("temperature") { In::Kelvins } else { In::One };
            Ok((name.clone(), number(&given, &format!("priors.{name}"), wanted)?))
        };
        let priors = priors.unwrap_or_default().into_iter().map(deviation).collect::<PyResult<_>>()?;
        let (shape_of_bands, of_bands) = given;
        let given = Given { shape_of_bands, bands: of_bands, unknown, priors, lighting_total };
        let lighting = of(lighting, "lighting", In::One)?;
        let environment = of(environment, "environment", In::Kelvin)?;
        let emissivities = match environment_emissivity {
            Some(given) => {
                let what = "environment_emissivity";
                let given = in_order(given, || Ok(of_python.clone()), what, true)?;
                rows(&given, what, In::One)?.into_iter().map(Some).collect()
            }
            None => vec![None; environment.len()],
        };
        let counting = match (counts_per_radiance, of(var_added.as_ref(), "var_added", COUNTS_SQUARED)?) {
            (None, var_added) if var_added.is_empty() => None,
            (None, _) => {
                let found = "var_added without counts_per_radiance";
                let instead =
                    "say how many counts there are: counts_per_radiance=etendue * efficiency * time";
                return Err(raised(Error::malformed(found, instead)));
            }
            (Some(counts_per_radiance), var_added) => {
                let all = |one: f64| vec![one; bands.len()];
                let var_added = if let [one] = *var_added { all(one) } else { var_added };
                Some(Counting { counts_per_radiance, var_added })
            }
        };
        let make = || -> Result<Self> {
            let (found, expected) = (emissivities.len(), environment.len());
            if found != expected {
                return Err(Error::Length {
                    what: "emissivities of the environment".into(),
                    found,
                    expected,
                });
            }
            let objects = environment.iter().zip(emissivities);
            let objects =
                objects.map(|(&temperature_k, emissivity)| EnvironmentObject { temperature_k, emissivity });
            let surroundings = Surroundings::new(bands.nodes_cm1(), objects.collect())?;
            let state = surroundings.state(temperature, &lighting)?;
            let unknowns = unknowns(&given)?;
            let mut range = StateRange::default();
            range.temperature_k = temperature_range.unwrap_or(range.temperature_k);
            range.lighting = lighting_range.unwrap_or(range.lighting);
            range.check()?;
            counting.as_ref().map_or(Ok(()), |counting| counting.check(bands.len()))?;
            Ok(Self { bands, surroundings, unknowns, state, range, counting, given })
        };
        make().map_err(raised)
    }

    /// Wavenumbers at which emissivities are asked for, cm⁻¹: the centres of bands that are given by them, else more.
    #[getter]
    fn nodes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        flat(py, self.bands.nodes_cm1().to_vec())
    }

    /// Signal ∫S dν of every band (bands,), photons s⁻¹ m⁻² sr⁻¹, of a target of an emissivity (nodes,).
    fn signal<'py>(&self, emissivity: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let spectrum = self.emissivity(emissivity, "emissivity")?;
        Ok(flat(emissivity.py(), self.bands.weigh(&self.surroundings.signal(&spectrum, &self.state))))
    }

    /// What makes the same scene again, for copies and pickles.
    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
        let Self { state, range, given, counting, .. } = self;
        let objects = self.surroundings.objects();
        let temperatures: Vec<f64> = objects.iter().map(|object| object.temperature_k).collect();
        let emissivities: Option<Vec<Vec<f64>>> =
            objects.iter().map(|object| object.emissivity.clone()).collect();
        let named = PyDict::new(py);
        named.set_item("bands", shaped(py, &given.shape_of_bands, given.bands.clone())?)?;
        named.set_item("temperature", state.temperature_k)?;
        named.set_item("lighting", state.lighting.clone())?;
        named.set_item("environment", temperatures)?;
        named.set_item("environment_emissivity", emissivities.filter(|all| !all.is_empty()))?;
        named.set_item("unknown", given.unknown.clone())?;
        named.set_item("priors", given.priors.clone())?;
        named.set_item("lighting_total", given.lighting_total)?;
        named.set_item("temperature_range", range.temperature_k)?;
        named.set_item("lighting_range", range.lighting)?;
        if let Some(Counting { counts_per_radiance, var_added }) = counting {
            named.set_item("counts_per_radiance", counts_per_radiance)?;
            named.set_item("var_added", var_added.clone())?;
        }
        Ok((PyTuple::empty(py), named))
    }

    fn __repr__(&self) -> String {
        let (low, high) = self.bands.range_cm1();
        format!(
            "Scene({} bands of {low:.6} to {high:.6} cm^-1, {} K, lighting {:?})",
            self.bands.len(),
            self.state.temperature_k,
            self.state.lighting
        )
    }
}

impl Scene {
    /// Spectra at the nodes with their bands in order, where they say where these are.
    pub(crate) fn in_order<'py>(&self, given: &Bound<'py, PyAny>, what: &str) -> PyResult<Bound<'py, PyAny>> {
        let Given { shape_of_bands, bands, .. } = &self.given;
        in_order(given, || Ok(shaped(given.py(), shape_of_bands, bands.clone())?.into_any()), what, true)
    }

    /// An emissivity at the nodes of the bands.
    pub(crate) fn emissivity(&self, given: &Bound<'_, PyAny>, what: &str) -> PyResult<Vec<f64>> {
        let spectrum = list(&self.in_order(given, what)?, what, In::One)?;
        let checked = hadar::scene::check_emissivity(&spectrum, self.bands.nodes_cm1().len());
        checked.map_err(|error| raised(error.for_key(what)))?;
        Ok(spectrum)
    }
}

fn unknowns(given: &Given) -> Result<Unknowns> {
    let nuisance = |name: &str| named("unknown", name, &Nuisance::ALL, Nuisance::name);
    let set = match &given.unknown {
        None => vec![Nuisance::Temperature, Nuisance::Lighting],
        Some(names) => names.iter().map(|name| nuisance(name)).collect::<Result<_>>()?,
    };
    let mut unknowns = Unknowns::new(set)?;
    for (name, sigma) in &given.priors {
        unknowns = unknowns.prior(nuisance(name)?, *sigma)?;
    }
    unknowns.lighting_total(given.lighting_total)
}
