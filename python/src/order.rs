//! Arrays over bands whose coordinate says where each band is: in which order they are to be read.

use crate::array::{as_it_lies, list, numbers, shaped};
use crate::error::{named, raised};
use crate::quantity::{In, RADIANCE};
use crate::scene::bands;
use hadar::error::{Error, check};
use hadar::order;
use hadar::words::significant;
use numpy::{PyArrayDyn, PyUntypedArrayMethods as _};
use pyo3::intern;
use pyo3::prelude::*;

const WANTED: [(In, &str); 4] =
    [(In::PerCentimetre, "cm^-1"), (In::One, "1"), (In::Counts, "counts"), (RADIANCE, "radiance")];

/// Names of the dimensions of bands, rows and columns, as those of cubes in files.
#[pyfunction]
pub(crate) fn dimension_names() -> [&'static [&'static str]; 3] {
    hadar_formats::cube::dimension_names()
}

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

/// An array of xarray or pandas, or a list of them, with its bands in the order of `bands`, as its labels say; any other as it is.
pub(crate) fn in_order<'py>(
    given: &Bound<'py, PyAny>,
    bands: impl FnOnce() -> PyResult<Bound<'py, PyAny>>,
    what: &str,
    at_nodes: bool,
) -> PyResult<Bound<'py, PyAny>> {
    if as_it_lies::<f64>(given)?.is_some() {
        return Ok(given.clone());
    }
    let order = given.py().import(intern!(given.py(), "hadar_limits._order"))?;
    order.call_method1(intern!(given.py(), "in_order"), (given, bands()?, what, at_nodes))
}

/// Places in the order of `bands` of those of an array whose coordinate says where they are, each no further from the centre of its band
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
    let expected: Vec<(f64, f64)> = match at_nodes && !bands.one_node_per_band() {
        // Nodes are as near as the bands are wide to each other: their own numbers, but for rounding.
        true => bands.nodes_cm1().iter().map(|node| (*node, 1e-6 * node)).collect(),
        false => {
            let each = bands.bands().iter().zip(bands.widths_cm1());
            each.map(|(band, width)| (band.center_cm1, 0.5 * width.max(band.high_cm1 - band.low_cm1)))
                .collect()
        }
    };
    if own.len() != expected.len() {
        let what = format!("bands by {what}");
        return Err(raised(Error::Length { what, found: own.len(), expected: expected.len() }));
    }
    for nu in &own {
        check::positive(what, *nu, "cm^-1").map_err(raised)?;
    }
    let sorted = |at: &dyn Fn(usize) -> f64| {
        let mut order: Vec<usize> = (0..own.len()).collect();
        order::ascending(&mut order, |place| at(*place));
        order
    };
    let own_at = |place: usize| own.get(place).copied().unwrap_or(f64::NAN);
    let mut order = vec![0; own.len()];
    let at = |place: usize| expected.get(place).copied().unwrap_or((f64::NAN, 0.0));
    for (place, band) in sorted(&own_at).into_iter().zip(sorted(&|band| at(band).0)) {
        let (own, (centre, half)) = (own_at(place), at(band));
        if (own - centre).abs() > half {
            let (own, centre) = (significant(own, 6), significant(centre, 6));
            let found = format!("{what}: band {place} is at {own} cm^-1, but at {centre} cm^-1 in bands");
            return Err(raised(Error::malformed(
                found,
                "give the bands of the array, or mend its coordinate",
            )));
        }
        if let Some(ordered) = order.get_mut(band) {
            *ordered = place;
        }
    }
    Ok(order)
}
