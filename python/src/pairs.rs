//! Distances of pairs of materials, and of all against all.

use crate::array::{flat, rows, shaped};
use crate::error::{named, raised};
use crate::quantity::In;
use crate::scene::Scene;
use crate::threads::{Threads, with_limits, with_threads};
use hadar::error::check;
use hadar::identifiability::local::LocalSolver;
use hadar::identifiability::multi::{LibraryScene, LocalMatrix};
use hadar::identifiability::nearest::NearestSolver;
use hadar::identifiability::{Status, detection};
use hadar_study::budget::Limits;
use numpy::PyArrayDyn;
use pyo3::prelude::*;

/// Distances by name; whether to the nearest state.
pub(crate) const DISTANCES: [(bool, &str); 2] = [(false, "local"), (true, "nearest")];

/// What :func:`local` finds: ``distance`` d₀ per √photon (``per_photon``) or d, ``distance_no_nuisance`` the same with nothing
/// unknown, ``relative_error`` of the distance by rounding, ``status`` "ok", "equilibrium", "blind" or "identical".
#[pyclass(frozen, get_all, new = "from_fields", module = "hadar_limits")]
#[derive(Debug)]
pub(crate) struct Local {
    distance: f64,
    distance_no_nuisance: f64,
    relative_error: f64,
    status: String,
    per_photon: bool,
}

/// What :func:`nearest` finds: ``distance``, ``lower`` below which it is proved that no state is (0: not proved), ``relative_error``
/// by rounding, ``converged``, and the nearest state: ``temperature`` (K), ``lighting`` (surroundings,), ``gain``.
#[pyclass(frozen, get_all, module = "hadar_limits")]
#[derive(Debug)]
pub(crate) struct Nearest {
    distance: f64,
    lower: f64,
    relative_error: f64,
    converged: bool,
    per_photon: bool,
    temperature: f64,
    lighting: Py<PyAny>,
    gain: f64,
}

#[pymethods]
impl Local {
    /// Φ(d), of a distance with a camera's counts.
    #[getter]
    fn probability(&self) -> Option<f64> {
        (!self.per_photon).then(|| detection::probability(self.distance))
    }

    /// For copies and pickles.
    fn __getnewargs__(&self) -> (f64, f64, f64, &str, bool) {
        let Self { distance, distance_no_nuisance, relative_error, status, per_photon } = self;
        (*distance, *distance_no_nuisance, *relative_error, status, *per_photon)
    }

    fn __repr__(&self) -> String {
        format!("Local(distance={:e}, {}, status='{}')", self.distance, unit(self.per_photon), self.status)
    }
}

#[pymethods]
impl Nearest {
    /// Φ(d), of a distance with a camera's counts.
    #[getter]
    fn probability(&self) -> Option<f64> {
        (!self.per_photon).then(|| detection::probability(self.distance))
    }

    /// Of what [`Self::__getnewargs__`] gives.
    #[new]
    fn new(found: (f64, f64, f64), converged: bool, per_photon: bool, state: (f64, Py<PyAny>, f64)) -> Self {
        let ((distance, lower, relative_error), (temperature, lighting, gain)) = (found, state);
        Self { distance, lower, relative_error, converged, per_photon, temperature, lighting, gain }
    }

    /// For copies and pickles.
    #[expect(clippy::type_complexity, reason = "the fields in two groups")]
    fn __getnewargs__(&self, py: Python<'_>) -> ((f64, f64, f64), bool, bool, (f64, Py<PyAny>, f64)) {
        let found = (self.distance, self.lower, self.relative_error);
        let state = (self.temperature, self.lighting.clone_ref(py), self.gain);
        (found, self.converged, self.per_photon, state)
    }

    fn __repr__(&self) -> String {
        let Self { distance, lower, temperature, .. } = self;
        format!(
            "Nearest(distance={distance:e}, lower={lower:e}, {}, temperature={temperature})",
            unit(self.per_photon)
        )
    }
}

fn unit(per_photon: bool) -> &'static str {
    if per_photon { "per root of a photon" } else { "statistical" }
}

/// The paper's semantic distance d₀ = 1/(2σ₀) of two materials at the target's own state, with the scene's unknowns.
///
/// target, alternative : (nodes,) emissivities at ``scene.nodes``
/// scene : Scene
///
/// Per √photon, or the statistical distance d where the scene has counts. The tangent of :func:`nearest`: for finite separations it
/// can err either way. Source: paper S24–S30, Algorithm 2.
#[pyfunction]
pub(crate) fn local(
    target: &Bound<'_, PyAny>,
    alternative: &Bound<'_, PyAny>,
    scene: &Bound<'_, Scene>,
) -> PyResult<Local> {
    let scene = scene.get();
    let target = scene.emissivity(target, "target")?;
    let alternative = scene.emissivity(alternative, "alternative")?;
    let mut solver = LocalSolver::new(&scene.bands, &scene.surroundings, scene.unknowns.clone());
    let found = match &scene.counting {
        None => solver.per_photon(&target, &alternative, &scene.state, f64::INFINITY),
        Some(counting) => solver.with_counting(&target, &alternative, &scene.state, counting),
    };
    let found = found.map_err(raised)?;
    Ok(Local {
        distance: found.distance,
        distance_no_nuisance: found.distance_no_nuisance,
        relative_error: found.relative_error,
        status: match found.status {
            Status::Ok => "ok",
            Status::Equilibrium => "equilibrium",
            Status::Blind => "blind",
            Status::Identical => "identical",
        }
        .to_owned(),
        per_photon: scene.counting.is_none(),
    })
}

/// Half the separation of the target from the nearest state of the alternative: no test is right more often than Φ(d).
///
/// target, alternative : (nodes,) emissivities at ``scene.nodes``
/// scene : Scene
/// prove : to what share of itself the distance is proved, or None for a search without proof
///
/// Per √photon, or the statistical distance d where the scene has counts.
#[pyfunction]
#[pyo3(signature = (target, alternative, scene, *, prove=1e-6))]
pub(crate) fn nearest(
    py: Python<'_>,
    target: &Bound<'_, PyAny>,
    alternative: &Bound<'_, PyAny>,
    scene: &Bound<'_, Scene>,
    prove: Option<f64>,
) -> PyResult<Nearest> {
    let scene = scene.get();
    let target = scene.emissivity(target, "target")?;
    let alternative = scene.emissivity(alternative, "alternative")?;
    let prove = share(prove)?;
    let found = with_threads(py, Some(Threads(1)), || {
        let Scene { bands, surroundings, unknowns, range, state, .. } = scene;
        let solver = NearestSolver::new(bands, surroundings, unknowns.clone(), *range);
        let mut solver = match prove {
            Some(share) => solver.proving(share),
            None => solver,
        };
        match &scene.counting {
            None => solver.per_photon(&target, &alternative, state, f64::INFINITY),
            Some(counting) => solver.with_counting(&target, &alternative, state, counting),
        }
    })?;
    Ok(Nearest {
        distance: found.distance,
        lower: found.lower,
        relative_error: found.relative_error,
        converged: found.converged,
        per_photon: scene.counting.is_none(),
        temperature: found.state.temperature_k,
        lighting: flat(py, found.state.lighting).into_any().unbind(),
        gain: found.state.gain,
    })
}

/// Distances of every material as the target (row) from every other one (column): (materials, materials), 0 on the diagonal.
///
/// emissivities : (materials, nodes) at ``scene.nodes``
/// scene : Scene; all targets are in its state
/// by : "local" or "nearest"
/// prove : share of a nearest distance to which it is proved; not proved where silent
/// threads : all cores where silent; the answer does not depend on it
/// progress : called with (targets done, targets) of nearest distances as they are found
///
/// Source: paper S32–S34, Algorithm 3.
#[pyfunction]
#[pyo3(signature = (emissivities, scene, *, by="local", prove=None, threads=None, progress=None))]
pub(crate) fn matrix<'py>(
    py: Python<'py>,
    emissivities: &Bound<'py, PyAny>,
    scene: &Bound<'py, Scene>,
    by: &str,
    prove: Option<f64>,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let scene = scene.get();
    let by_nearest = named("distance", by, &DISTANCES, |by| by.1).map_err(raised)?.0;
    let spectra = rows(&scene.in_order(emissivities, "emissivities")?, "emissivities", In::One)?;
    for (row, spectrum) in spectra.iter().enumerate() {
        let checked = hadar::scene::check_emissivity(spectrum, scene.bands.nodes_cm1().len());
        checked.map_err(|error| raised(error.for_key(format!("emissivities[{row}]"))))?;
    }
    let tolerance = share(prove)?;
    let found = with_limits(py, threads, &Limits::default(), progress.as_ref(), |counted| {
        let spectra: Vec<&[f64]> = spectra.iter().map(Vec::as_slice).collect();
        let Scene { bands, surroundings, unknowns, range, state, counting, .. } = scene;
        if by_nearest {
            let count = |done, of| counted.set(done, of);
            let library = LibraryScene { bands, surroundings, unknowns, range: *range, state, tolerance };
            let found = match counting {
                None => library.nearest_per_photon(&spectra, &count),
                Some(counting) => library.nearest_with_counting(&spectra, counting, &count),
            };
            return found.map(|found| found.distance);
        }
        let mut local = LocalMatrix::new(bands, surroundings, unknowns.clone());
        match counting {
            None => local.per_photon(&spectra, state),
            Some(counting) => local.with_counting(&spectra, state, counting),
        }
    })?;
    shaped(py, &[spectra.len(), spectra.len()], found)
}

/// To what share of itself a distance is proved.
pub(crate) fn share(prove: Option<f64>) -> PyResult<Option<f64>> {
    let Some(share) = prove else { return Ok(None) };
    check::positive("prove", share, "").map_err(raised)?;
    if share >= 1.0 {
        let expected = "above 0 and below 1, e.g. 1e-6";
        return Err(raised(hadar::Error::out_of_range("prove", share, "", expected)));
    }
    Ok(Some(share))
}
