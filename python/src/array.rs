//! Arrays of Python as numbers, and numbers as arrays.
//!
//! An array of the kind that is wanted is read where it lies, whatever its strides; other numbers are converted by NumPy. What
//! would be taken wrongly without notice is refused: masked arrays, complex numbers, text, objects.

use crate::error::raised;
use crate::quantity::{In, converted, refuse_masked};
use hadar::Error;
use numpy::ndarray::{ArrayD, IxDyn, arr0};
use numpy::{
    Element, IntoPyArray as _, PyArray, PyArrayDyn, PyArrayMethods as _, PyReadonlyArrayDyn, PyUntypedArray,
    PyUntypedArrayMethods as _,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::type_object::PyTypeInfo as _;
use pyo3::types::{PyFloat, PyInt};

/// Numbers as they lie, of type `T` if they are, else converted.
pub(crate) fn numbers<'py, T: Element>(
    given: &Bound<'py, PyAny>,
    what: &str,
    wanted: In,
) -> PyResult<PyReadonlyArrayDyn<'py, T>> {
    if let Some(array) = as_it_lies(given)? {
        return Ok(array);
    }
    let py = given.py();
    if given.is_exact_instance_of::<PyFloat>() || given.is_exact_instance_of::<PyInt>() {
        let one = PyArrayDyn::from_owned_array(py, arr0(given.extract::<f64>()?).into_dyn());
        if let Some(array) = as_it_lies(one.as_any())? {
            return Ok(array);
        }
    }
    let values = converted(given, what, wanted)?;
    let array = array_of(values.as_ref().unwrap_or(given), what)?;
    let refused = |found: &str, instead: &str| raised(Error::malformed(format!("{what}: {found}"), instead));
    let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
    if !"iuf".contains(&kind) {
        let dtype = array.getattr("dtype")?.str()?;
        return Err(refused(
            &format!("an array of {dtype}"),
            "give real numbers, f32 or f64, and nan for what is missing",
        ));
    }
    let wanted = numpy::dtype::<T>(py);
    let numpy = py.import(intern!(py, "numpy"))?;
    let converted = numpy.call_method1("require", (array, wanted, ("A", "E")))?;
    as_it_lies(&converted)?.ok_or_else(|| refused("no array", "give an array of numbers"))
}

/// What NumPy makes an array of, none of it under a mask.
pub(crate) fn array_of<'py>(given: &Bound<'py, PyAny>, what: &str) -> PyResult<Bound<'py, PyAny>> {
    refuse_masked(given, what)?;
    let numpy = given.py().import(intern!(given.py(), "numpy"))?;
    // What is more than an array says so again once it is one.
    let array = numpy.call_method1("asanyarray", (given,)).map_err(|error| {
        let py = given.py();
        let of_value = error.is_instance_of::<PyValueError>(py) || error.is_instance_of::<PyTypeError>(py);
        let found = format!("{what}: {}", error.value(py));
        if of_value { raised(Error::malformed(found, "give one array of numbers")) } else { error }
    })?;
    refuse_masked(&array, what)?;
    Ok(array)
}

/// The array itself, if it is one of `T`, and of no class that means more by it.
pub(crate) fn as_it_lies<'py, T: Element>(
    given: &Bound<'py, PyAny>,
) -> PyResult<Option<PyReadonlyArrayDyn<'py, T>>> {
    let py = given.py();
    if !given.get_type().is(PyUntypedArray::type_object(py)) {
        return Ok(None);
    }
    let Ok(array) = given.cast::<PyArrayDyn<T>>() else { return Ok(None) };
    // Views of records may begin at any byte.
    let aligned: bool = given.getattr(intern!(py, "flags"))?.getattr(intern!(py, "aligned"))?.extract()?;
    Ok(if aligned { array.try_readonly().ok() } else { None })
}

/// Numbers of one dimension; a single one counts as a list of one.
pub(crate) fn list(given: &Bound<'_, PyAny>, what: &str, wanted: In) -> PyResult<Vec<f64>> {
    let array = numbers::<f64>(given, what, wanted)?;
    if array.ndim() > 1 {
        let found = format!("{what}: an array of {} dimensions", array.ndim());
        return Err(raised(Error::malformed(found, "give one of one dimension")));
    }
    Ok(array.as_slice().map_or_else(|_| array.as_array().iter().copied().collect(), <[f64]>::to_vec))
}

/// A range of temperatures, K: its two ends.
pub(crate) fn ends(given: &Bound<'_, PyAny>, what: &str, wanted: In) -> PyResult<[f64; 2]> {
    let values = list(given, what, wanted)?;
    let found = values.len();
    values
        .try_into()
        .map_err(|_| raised(Error::Length { what: format!("ends of {what}"), found, expected: 2 }))
}

/// Rows of two dimensions; a single row counts as a table of one.
pub(crate) fn rows(given: &Bound<'_, PyAny>, what: &str, wanted: In) -> PyResult<Vec<Vec<f64>>> {
    let array = numbers::<f64>(given, what, wanted)?;
    let view = array.as_array();
    match view.ndim() {
        1 => Ok(vec![view.iter().copied().collect()]),
        2 => Ok(view.outer_iter().map(|row| row.iter().copied().collect()).collect()),
        other => {
            let found = format!("{what}: an array of {other} dimensions");
            Err(raised(Error::malformed(found, "give one row each, in an array of two dimensions")))
        }
    }
}

/// Numbers as an array of a shape.
pub(crate) fn shaped<'py, T: Element>(
    py: Python<'py>,
    shape: &[usize],
    values: Vec<T>,
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    let (found, expected) = (values.len(), shape.iter().product());
    let array = ArrayD::from_shape_vec(IxDyn(shape), values)
        .map_err(|_| raised(Error::Length { what: "values of a result".into(), found, expected }))?;
    Ok(array.into_pyarray(py))
}

/// Numbers as an array of one dimension.
pub(crate) fn flat<T: Element>(py: Python<'_>, values: Vec<T>) -> Bound<'_, PyArray<T, numpy::Ix1>> {
    values.into_pyarray(py)
}
