//! Distances of a pair over many states of the target.

use crate::array::{numbers, shaped};
use crate::error::{named, raised};
use crate::pairs::{DISTANCES, share};
use crate::quantity::In;
use crate::scene::Scene;
use crate::threads::{Threads, with_limits};
use hadar::error::Error;
use hadar::identifiability::local::LocalSolver;
use hadar::identifiability::nearest::NearestSolver;
use hadar::scene::State;
use hadar_study::budget::Limits;
use numpy::{PyArrayDyn, PyUntypedArrayMethods as _};
use pyo3::prelude::*;
use rayon::prelude::*;

/// States whose distances are found before others are begun.
const BLOCK: usize = 1 << 12;

/// Distances of a pair at many states of the target, as many as there are temperatures: an array of their shape.
///
/// target, alternative : (nodes,) emissivities at ``scene.nodes``
/// scene : Scene; its own state does not count
/// temperature : array of the target's temperatures, K
/// lighting : array of the same shape with a last axis of the surroundings, which is left out where there is one alone
/// by, prove, threads : as :func:`matrix`
/// progress : called with (states done, states) now and then
#[pyfunction]
#[pyo3(signature = (target, alternative, scene, temperature, lighting, *, by="local", prove=None, threads=None,
    progress=None))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub(crate) fn over_states<'py>(
    py: Python<'py>,
    target: &Bound<'py, PyAny>,
    alternative: &Bound<'py, PyAny>,
    scene: &Bound<'py, Scene>,
    temperature: &Bound<'py, PyAny>,
    lighting: &Bound<'py, PyAny>,
    by: &str,
    prove: Option<f64>,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let scene = scene.get();
    let (target, alternative) =
        (scene.emissivity(target, "target")?, scene.emissivity(alternative, "alternative")?);
    let by_nearest = named("distance", by, &DISTANCES, |by| by.1).map_err(raised)?.0;
    let tolerance = share(prove)?;
    let (temperatures, lit) = (
        numbers::<f64>(temperature, "temperature", In::Kelvin)?,
        numbers::<f64>(lighting, "lighting", In::One)?,
    );
    let shape = temperatures.shape().to_vec();
    let objects = scene.surroundings.objects().len();
    let with_axis: Vec<usize> = shape.iter().copied().chain([objects]).collect();
    if lit.shape() != with_axis && !(objects == 1 && lit.shape() == shape) {
        let found = format!("lighting of shape {:?} for temperatures of shape {shape:?}", lit.shape());
        let instead = format!(
            "broadcast both to one shape first; with {objects} surroundings give lighting {with_axis:?}"
        );
        return Err(raised(Error::malformed(found, instead)));
    }
    let lit: Vec<f64> = lit.as_array().iter().copied().collect();
    let temperatures: Vec<f64> = temperatures.as_array().iter().copied().collect();
    let found = with_limits(py, threads, &Limits::default(), progress.as_ref(), |counted| {
        counted.set(0, temperatures.len());
        let Scene { bands, surroundings, unknowns, range, counting, .. } = scene;
        let mut all = Vec::with_capacity(temperatures.len());
        // Block by block, so that few threads have to be stopped where it is stopped.
        for (block, temperatures) in temperatures.chunks(BLOCK).enumerate() {
            let lit = |i: usize| lit.get(i * objects..(i + 1) * objects).unwrap_or_default();
            let states = temperatures.iter().enumerate();
            let states = states.map(|(i, kelvin)| surroundings.state(*kelvin, lit(block * BLOCK + i)));
            let states: Vec<State> = states.collect::<hadar::Result<_>>()?;
            let found: hadar::Result<Vec<f64>> = if by_nearest {
                let solver = || {
                    let solver = NearestSolver::new(bands, surroundings, unknowns.clone(), *range);
                    match tolerance {
                        Some(share) => solver.proving(share),
                        None => solver,
                    }
                };
                let each = |solver: &mut NearestSolver<'_>, state: &State| {
                    let found = match counting {
                        None => solver.per_photon(&target, &alternative, state, f64::INFINITY),
                        Some(counting) => solver.with_counting(&target, &alternative, state, counting),
                    };
                    found.map(|found| found.distance)
                };
                states.par_iter().with_min_len(8).map_init(solver, each).collect()
            } else {
                let solver = || LocalSolver::new(bands, surroundings, unknowns.clone());
                let each = |solver: &mut LocalSolver<'_>, state: &State| {
                    let found = match counting {
                        None => solver.per_photon(&target, &alternative, state, f64::INFINITY),
                        Some(counting) => solver.with_counting(&target, &alternative, state, counting),
                    };
                    found.map(|found| found.distance)
                };
                states.par_iter().with_min_len(64).map_init(solver, each).collect()
            };
            all.extend(found?);
            counted.add(states.len());
            hadar::stop::check();
        }
        Ok(all)
    })?;
    shaped(py, &shape, found)
}
