//! Jobs in parallel, their results in order.
//!
//! The threads are handed one and the same kind of job, a call of a function with an index, so that the code that hands it out is
//! compiled once and not anew for each use (an iterator of `rayon` costs the compiler some 9000 lines of intermediate code a use). Each result costs a lock of its
//! own, some 20 ns: what takes less is better done in blocks.

use crate::demand;
use crate::error::Result as Checked;
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use std::sync::{Mutex, PoisonError};

/// `of(0)`, `of(1)`, … `of(count - 1)`, computed in parallel, in this order.
///
/// ```
/// assert_eq!(hadar::parallel::map(4, |i| i * i), [0, 1, 4, 9]);
/// ```
pub fn map<T: Send>(count: usize, of: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let made: Vec<Mutex<Option<T>>> = (0..count).map(|_| Mutex::new(None)).collect();
    each(count, &|i| *made[i].lock().unwrap_or_else(PoisonError::into_inner) = Some(of(i)));
    made.into_iter().filter_map(|one| one.into_inner().unwrap_or_else(PoisonError::into_inner)).collect()
}

/// As [`map`], each job with a workspace that no other uses at the same time; what is left in it must not change a result.
pub fn map_with<W: Send, T: Send>(
    count: usize,
    workspace: impl Fn() -> W + Sync,
    of: impl Fn(&mut W, usize) -> T + Sync,
) -> Vec<T> {
    let idle = Mutex::new(Vec::new());
    map(count, |i| {
        let kept = idle.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut own = kept.unwrap_or_else(&workspace);
        let made = of(&mut own, i);
        idle.lock().unwrap_or_else(PoisonError::into_inner).push(own);
        made
    })
}

/// As [`map`] for jobs that can fail.
///
/// # Errors
/// That of the first job, in their order, that failed.
pub fn try_map<T: Send, E: Send>(
    count: usize,
    of: impl Fn(usize) -> Result<T, E> + Sync,
) -> Result<Vec<T>, E> {
    map(count, of).into_iter().collect()
}

/// As [`map_with`] for jobs that can fail.
///
/// # Errors
/// That of the first job, in their order, that failed.
pub fn try_map_with<W: Send, T: Send, E: Send>(
    count: usize,
    workspace: impl Fn() -> W + Sync,
    of: impl Fn(&mut W, usize) -> Result<T, E> + Sync,
) -> Result<Vec<T>, E> {
    map_with(count, workspace, of).into_iter().collect()
}

/// As [`try_map`], each job with a ledger of its own; what they took is booked in the one that is open here.
///
/// # Errors
/// That of the first job, in their order, that failed.
pub fn booked<T: Send>(count: usize, of: impl Fn(usize) -> Checked<T> + Sync) -> Checked<Vec<T>> {
    booked_with(count, || (), |(), i| of(i))
}

/// As [`booked`], each job with a workspace that no other uses at the same time.
///
/// # Errors
/// That of the first job, in their order, that failed.
pub fn booked_with<W: Send, T: Send>(
    count: usize,
    workspace: impl Fn() -> W + Sync,
    of: impl Fn(&mut W, usize) -> Checked<T> + Sync,
) -> Checked<Vec<T>> {
    let done = try_map_with(count, workspace, |own, i| demand::ledger_of(|| of(own, i)))?;
    Ok(done.into_iter().inspect(|(_, work)| demand::add(work)).map(|(made, _)| made).collect())
}

/// Every run of `length` values, filled in parallel: `of` is told its index.
///
/// # Errors
/// That of the first run, in their order, that failed.
pub fn fill<V: Send, W: Send, E: Send>(
    values: &mut [V],
    length: usize,
    workspace: impl Fn() -> W + Sync,
    of: impl Fn(&mut W, usize, &mut [V]) -> Result<(), E> + Sync,
) -> Result<(), E> {
    let runs: Vec<Mutex<&mut [V]>> = values.chunks_mut(length.max(1)).map(Mutex::new).collect();
    let of_run =
        |own: &mut W, i: usize| of(own, i, &mut runs[i].lock().unwrap_or_else(PoisonError::into_inner));
    try_map_with(runs.len(), workspace, of_run).map(|_| ())
}

fn each(count: usize, job: &(dyn Fn(usize) + Sync)) {
    (0..count).into_par_iter().for_each(job);
}
