//! Arrays over bands whose coordinate says where each band is: in which order they are to be read.

use crate::array::{list, numbers, shaped};
use crate::error::{named, raised};
use crate::quantity::{In, RADIANCE};
use crate::scene::bands;
use hadar::error::{Error, check};
use hadar::order;
use hadar::words::significant;
use numpy::{PyArrayDyn, PyUntypedArrayMethods as _};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};

const WANTED: [(In, &str); 4] =
    [(In::PerCentimetre, "cm^-1"), (In::One, "1"), (In::Counts, "counts"), (RADIANCE, "radiance")];

/// Numbers without their unit, in the one that is wanted.
#[pyfunction]
pub(crate) fn plain<'py>(
    given: &Bound<'py, PyAny>,
    what: &str,
    wanted: &str,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let wanted = named("unit", wanted, &WANTED, |wanted| wanted.1).map_err(raised)?.0;
    let values = numbers::<f64>(given, what, wanted)?;
    shaped(given.py(), values.shape(), values.as_array().iter().copied().collect())
}

/// An array of xarray, or a list of them, with its bands in the order of `bands`, as its coordinates say; any other as it is.
pub(crate) fn in_order<'py>(
    given: &Bound<'py, PyAny>,
    bands: impl FnOnce() -> PyResult<Bound<'py, PyAny>>,
    what: &str,
    at_nodes: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let py = given.py();
    let is_list = given.is_instance_of::<PyList>() || given.is_instance_of::<PyTuple>();
    if !is_list && !given.hasattr(intern!(py, "coords"))? {
        return Ok(given.clone());
    }
    let named = PyDict::new(py);
    named.set_item("at_nodes", at_nodes)?;
    let cubes = py.import(intern!(py, "hadar_limits._cubes"))?;
    cubes.call_method(intern!(py, "in_order"), (given, bands()?, what), Some(&named))
}

/// Places in rising wavenumber of the bands of an array whose coordinate says where they are, each no further from the centre of its band
/// than half of its width, as heat cubes in files are read. `at_nodes`: the array is one of spectra at the nodes of the bands.
#[pyfunction]
pub(crate) fn order_of_bands(
    coordinate: &Bound<'_, PyAny>,
    bands: &Bound<'_, PyAny>,
    what: &str,
    at_nodes: bool,
) -> PyResult<Vec<usize>> {
    let bands = self::bands(bands)?;
    let own = list(coordinate, what, In::PerCentimetre)?;
    if at_nodes && !bands.one_node_per_band() {
        let found = format!("{what}: a coordinate of spectra at the nodes of bands that are ranges");
        return Err(raised(Error::malformed(found, "give the values alone, in the order of the nodes")));
    }
    if own.len() != bands.len() {
        let what = format!("bands by {what}");
        return Err(raised(Error::Length { what, found: own.len(), expected: bands.len() }));
    }
    for nu in &own {
        check::positive(what, *nu, "cm^-1").map_err(raised)?;
    }
    let mut order: Vec<usize> = (0..own.len()).collect();
    let at = |band: &usize| own.get(*band).copied().unwrap_or(f64::NAN);
    order::ascending(&mut order, at);
    for ((place, band), width) in order.iter().zip(bands.bands()).zip(bands.widths_cm1()) {
        let half = 0.5 * width.max(band.high_cm1 - band.low_cm1);
        let (own, centre) = (at(place), band.center_cm1);
        if (own - centre).abs() > half {
            let (own, centre) = (significant(own, 6), significant(centre, 6));
            let found = format!("{what}: band {place} is at {own} cm^-1, but at {centre} cm^-1 in bands");
            return Err(raised(Error::malformed(
                found,
                "give the bands of the array, or mend its coordinate",
            )));
        }
    }
    Ok(order)
}
