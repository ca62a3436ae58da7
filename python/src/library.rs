//! Emissivities of the built-in library and of files.

use crate::array::{flat, list};
use crate::error::raised;
use crate::quantity::In;
use hadar::material::Library;
use numpy::PyArray1;
use pyo3::prelude::*;
use std::path::PathBuf;

/// Names of the built-in materials.
#[pyfunction]
pub(crate) fn materials() -> PyResult<Vec<String>> {
    Ok(Library::embedded().map_err(raised)?.names().map(str::to_owned).collect())
}

/// Emissivity (nu,) of a material at wavenumbers.
///
/// material : a name of :func:`materials`, or the path of a CSV or ECOSTRESS file
/// nu : wavenumbers, cm⁻¹, within those of its data
#[pyfunction]
pub(crate) fn emissivity<'py>(
    material: &Bound<'py, PyAny>,
    nu: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let nu = list(nu, "nu", In::PerCentimetre)?;
    let found = match material.extract::<String>() {
        Ok(name) if !name.contains(['/', '\\', '.']) => {
            Library::embedded().and_then(|library| library.get(&name)?.emissivity(&nu))
        }
        _ => hadar_formats::spectra::material(&material.extract::<PathBuf>()?)
            .and_then(|found| found.emissivity(&nu)),
    };
    Ok(flat(material.py(), found.map_err(raised)?))
}
