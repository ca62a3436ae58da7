//! Planck's law on arrays.

use crate::array::{numbers, shaped};
use crate::error::raised;
use crate::quantity::{In, RADIANCE};
use hadar::error::{Error, check};
use hadar::planck as law;
use numpy::ndarray::{ArrayViewD, Axis, IxDyn};
use numpy::{PyReadonlyArrayDyn, PyUntypedArrayMethods as _};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// Values beyond which others may have the interpreter.
const MANY: usize = 1 << 12;

/// Photon radiance B(ν, T) = 2cν²/(exp(hcν/kT) − 1) of a blackbody, photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹, both polarisations.
///
/// nu : array, wavenumbers, cm⁻¹
/// temperature : array, K; NaN where it is missing
///
/// Shapes are broadcast as NumPy does. Relative error below 2e-16·(10 + hcν/kT). Source: Planck's law, paper S2.
#[pyfunction]
pub(crate) fn planck<'py>(
    nu: &Bound<'py, PyAny>,
    temperature: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    broadcast(nu, temperature, law::photon_radiance_into)
}

/// ∂B/∂T of :func:`planck`, photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹ per K; arguments as there.
#[pyfunction]
pub(crate) fn planck_slope<'py>(
    nu: &Bound<'py, PyAny>,
    temperature: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    broadcast(nu, temperature, |nu, temperature_k, out| {
        let mut radiance = vec![0.0; out.len()];
        law::photon_radiance_and_slope_into(nu, temperature_k, &mut radiance, out);
    })
}

/// Temperature of the blackbody that sends a photon radiance, K; 0 for none.
///
/// nu : array, wavenumbers, cm⁻¹
/// radiance : array, photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹; shapes are broadcast
#[pyfunction]
pub(crate) fn brightness_temperature<'py>(
    nu: &Bound<'py, PyAny>,
    radiance: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let py = nu.py();
    let (nu, radiance) =
        (numbers::<f64>(nu, "nu", In::PerCentimetre)?, numbers::<f64>(radiance, "radiance", RADIANCE)?);
    positive(&nu, "wavenumber", "cm^-1")?;
    for &value in radiance.as_array().iter().filter(|value| !value.is_nan()) {
        check::non_negative("radiance", value, "photons s^-1 m^-2 sr^-1 per cm^-1").map_err(raised)?;
    }
    let shape = common(py, nu.shape(), radiance.shape())?;
    let (nu, radiance) = (nu.as_array(), radiance.as_array());
    let (nu, radiance) = (over(&nu, &shape)?, over(&radiance, &shape)?);
    let found = nu.iter().zip(&radiance).map(|(nu, radiance)| law::brightness_temperature(*nu, *radiance));
    given_back(py, &shape, found.collect())
}

/// A law at every pair of wavenumber and temperature, as NumPy puts them together.
fn broadcast<'py>(
    nu: &Bound<'py, PyAny>,
    temperature: &Bound<'py, PyAny>,
    law: impl for<'a> Fn(&'a [f64], f64, &'a mut [f64]) + Send + Sync,
) -> PyResult<Bound<'py, PyAny>> {
    let py = nu.py();
    let (nu, temperature) = (
        numbers::<f64>(nu, "nu", In::PerCentimetre)?,
        numbers::<f64>(temperature, "temperature", In::Kelvin)?,
    );
    positive(&nu, "wavenumber", "cm^-1")?;
    positive(&temperature, "temperature", "K")?;
    let shape = common(py, nu.shape(), temperature.shape())?;
    let mut out = vec![0.0; shape.iter().product()];
    let (nu, temperature) = (nu.as_array(), temperature.as_array());
    let (nu, temperature) = (over(&nu, &shape)?, over(&temperature, &shape)?);
    let many = out.len() > MANY;
    let mut work = || spectra(nu.view(), temperature.view(), &law, &mut out);
    if many {
        py.detach(work)
    } else {
        work()
    }
    given_back(py, &shape, out)
}

/// Along the last axis a law is that of one temperature, or of one wavenumber after the other.
fn spectra(
    nu: ArrayViewD<'_, f64>,
    temperature: ArrayViewD<'_, f64>,
    law: &impl for<'a> Fn(&'a [f64], f64, &'a mut [f64]),
    out: &mut [f64],
) {
    let of = |nu: &[f64], temperature_k: f64, out: &mut [f64]| match temperature_k.is_nan() {
        true => out.fill(f64::NAN),
        false => law(nu, temperature_k, out),
    };
    if nu.ndim() == 0 {
        if let (Some(nu), Some(temperature_k)) = (nu.first(), temperature.first()) {
            of(&[*nu], *temperature_k, out);
        }
        return;
    }
    let last = Axis(nu.ndim() - 1);
    let one_temperature = temperature.stride_of(last) == 0;
    let (length, mut copy) = (nu.len_of(last).max(1), Vec::new());
    let lanes = nu.lanes(last).into_iter().zip(temperature.lanes(last));
    for ((nu, temperature), out) in lanes.zip(out.chunks_mut(length)) {
        let nu = match nu.to_slice() {
            Some(nu) => nu,
            None => {
                copy.clear();
                copy.extend(nu.iter().copied());
                &copy
            }
        };
        match temperature.first() {
            Some(one) if one_temperature => of(nu, *one, out),
            _ => {
                for ((nu, temperature_k), out) in nu.chunks(1).zip(temperature).zip(out.chunks_mut(1)) {
                    of(nu, *temperature_k, out);
                }
            }
        }
    }
}

/// Every value above 0; one that is missing (NaN) stays so, but for wavenumbers.
fn positive(values: &PyReadonlyArrayDyn<'_, f64>, what: &str, unit: &'static str) -> PyResult<()> {
    let missing = |value: f64| value.is_nan() && unit == "K";
    let wrong = values.as_array().iter().copied().find(|x| !(*x > 0.0 && x.is_finite() || missing(*x)));
    wrong.map_or(Ok(()), |wrong| check::positive(what, wrong, unit).map(drop).map_err(raised))
}

fn common(py: Python<'_>, one: &[usize], other: &[usize]) -> PyResult<Vec<usize>> {
    if one == other || other.is_empty() {
        return Ok(one.to_vec());
    }
    let tuple = |shape: &[usize]| PyTuple::new(py, shape);
    py.import("numpy")?.call_method1("broadcast_shapes", (tuple(one)?, tuple(other)?))?.extract()
}

fn over<'a>(array: &'a ArrayViewD<'_, f64>, shape: &[usize]) -> PyResult<ArrayViewD<'a, f64>> {
    let (found, expected) = (array.len(), shape.iter().product());
    let what = "values of an array".to_owned();
    array.broadcast(IxDyn(shape)).ok_or_else(|| raised(Error::Length { what, found, expected }))
}

/// An array, or the number where there is one alone.
fn given_back<'py>(py: Python<'py>, shape: &[usize], values: Vec<f64>) -> PyResult<Bound<'py, PyAny>> {
    let array = shaped(py, shape, values)?.into_any();
    if shape.is_empty() { array.get_item(PyTuple::empty(py)) } else { Ok(array) }
}
