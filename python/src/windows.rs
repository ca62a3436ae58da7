//! Fisher information about depth in the windows of a heat cube.

use crate::array::{list, numbers, shaped};
use crate::error::{named, raised};
use crate::lent::Lent;
use crate::quantity::COUNTS_SQUARED;
use crate::threads::{Threads, with_threads};
use hadar::ranging::derivative::Derivative;
use hadar::ranging::information::{Cell, InformationMap, Request, Window, information};
use hadar::ranging::noise::{Joined, NoiseVariance};
use numpy::PyUntypedArrayMethods as _;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Names of the cells of Table S4.
const fn name(cell: Cell) -> &'static str {
    match cell {
        Cell::Total => "total",
        Cell::Spatial => "spatial",
        Cell::Spectral => "spectral",
        Cell::Full => "full",
    }
}

/// J of every window, pixel⁻², by the names of the cells, with the photons of each, as large as the image: NaN at its edges.
#[pyfunction]
#[pyo3(signature = (cube, window=(5, 5), *, cells=None, derivative="central", var_added=None,
    joined="sum-of-readings", threads=None))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub(crate) fn window_information<'py>(
    py: Python<'py>,
    cube: &Bound<'py, PyAny>,
    window: (usize, usize),
    cells: Option<Vec<String>>,
    derivative: &str,
    var_added: Option<&Bound<'py, PyAny>>,
    joined: &str,
    threads: Option<Threads>,
) -> PyResult<Bound<'py, PyDict>> {
    let lent = Lent::of(cube)?;
    let view = lent.view()?;
    let noise = match var_added {
        None => NoiseVariance::None,
        Some(given) if numbers::<f64>(given, "var_added", COUNTS_SQUARED)?.ndim() == 0 => {
            NoiseVariance::Uniform(list(given, "var_added", COUNTS_SQUARED)?.into_iter().sum())
        }
        Some(given) => NoiseVariance::PerBand(list(given, "var_added", COUNTS_SQUARED)?),
    };
    let cells = match &cells {
        None => Ok(vec![Cell::Full]),
        Some(names) => names.iter().map(|cell| named("cell", cell, &Cell::ALL, name)).collect(),
    };
    let cells: Vec<Cell> = cells.map_err(raised)?;
    let shape = view.cube().shape();
    let request = Request {
        window: Window::new(window.0, window.1).map_err(raised)?,
        derivative: named("derivative", derivative, &Derivative::ALL, Derivative::name).map_err(raised)?,
        noise: &noise,
        joined: named("joined", joined, &Joined::ALL, Joined::name).map_err(raised)?,
        cells: &cells,
        centres: 0..shape.rows(),
    };
    let map = with_threads(py, threads, || information(view.cube(), &request))?;
    let out = PyDict::new(py);
    let size = (shape.rows(), shape.columns());
    for &cell in &cells {
        out.set_item(name(cell), shaped(py, &[size.0, size.1], framed(&map, map.cell(cell), size))?)?;
    }
    out.set_item("photons", shaped(py, &[size.0, size.1], framed(&map, &map.photons, size))?)?;
    Ok(out)
}

/// Values of the centres in an image of so many rows and columns, NaN around them.
fn framed(map: &InformationMap, values: &[f64], (rows, columns): (usize, usize)) -> Vec<f64> {
    let mut image = vec![f64::NAN; rows * columns];
    let width = map.columns.len().max(1);
    let inside = image.chunks_mut(columns).skip(map.rows.start).zip(values.chunks(width));
    for (row, values) in inside {
        if let Some(row) = row.get_mut(map.columns.clone()) {
            row.copy_from_slice(values);
        }
    }
    image
}
