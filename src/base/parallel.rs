//! Jobs in parallel, their results in order.
//!
//! The threads are handed one and the same kind of job, a call of a function with an index, so that the code that hands it out is
//! compiled once and not anew for each use (an iterator of `rayon` costs the compiler some 9000 lines of intermediate code a use). Locks
//! cost some 20 ns for each result, three times that with a workspace: what takes less is better done in blocks.

pub use crate::stop::STACK;

use crate::demand;
use crate::error::Result as Checked;
use crate::stop;
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use std::sync::atomic::{AtomicUsize, Ordering};
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
/// As [`try_map_with`].
pub fn try_map<T: Send, E: Send>(
    count: usize,
    of: impl Fn(usize) -> Result<T, E> + Sync,
) -> Result<Vec<T>, E> {
    try_map_with(count, || (), |(), i| of(i))
}

/// As [`map_with`] for jobs that can fail. After one that failed no later one is begun.
///
/// # Errors
/// That of the first job, in their order, that fails, whatever the number of threads.
pub fn try_map_with<W: Send, T: Send, E: Send>(
    count: usize,
    workspace: impl Fn() -> W + Sync,
    of: impl Fn(&mut W, usize) -> Result<T, E> + Sync,
) -> Result<Vec<T>, E> {
    let failed = AtomicUsize::new(count);
    let of = |own: &mut W, i: usize| {
        // Every job before the first that fails is done.
        (i < failed.load(Ordering::Relaxed)).then(|| {
            of(own, i).inspect_err(|_| {
                failed.fetch_min(i, Ordering::Relaxed);
            })
        })
    };
    map_with(count, workspace, of).into_iter().flatten().collect()
}

/// As [`try_map`], each job with a ledger of its own; what they took is booked in the one that is open here.
///
/// # Errors
/// As [`try_map_with`].
pub fn booked<T: Send>(count: usize, of: impl Fn(usize) -> Checked<T> + Sync) -> Checked<Vec<T>> {
    booked_with(count, || (), |(), i| of(i))
}

/// As [`booked`], each job with a workspace that no other uses at the same time.
///
/// # Errors
/// As [`try_map_with`].
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
/// As [`try_map_with`].
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
    (0..count).into_par_iter().for_each(|i| {
        stop::check();
        job(i);
    });
}

#[cfg(test)]
mod tests {
    use super::{booked, fill, map_with, try_map};
    use crate::demand::{self, Ledger, Thing};
    use std::sync::atomic::{AtomicUsize, Ordering};

    fn with_threads<T: Send>(threads: usize, job: impl FnOnce() -> T + Send) -> T {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(job)
    }

    /// Results stand in the order of the jobs, the first failure is told, and the ledger has all, for any number of threads.
    #[test]
    fn order_failures_and_ledgers_do_not_depend_on_threads() {
        for threads in [1, 2, 5] {
            let begun = AtomicUsize::new(0);
            let fails = |i| {
                begun.fetch_add(1, Ordering::SeqCst);
                if i % 7 == 6 { Err(i) } else { Ok(i) }
            };
            assert_eq!(with_threads(threads, || try_map(100, fails)), Err(6));
            // By one thread nothing after it.
            assert!(threads > 1 || begun.load(Ordering::SeqCst) == 7);
            assert_eq!(with_threads(threads, || try_map(6, fails)), Ok((0..6).collect()));
            let mut runs = [0; 10];
            let filled = |runs: &mut [usize]| {
                fill(
                    runs,
                    3,
                    || (),
                    |(), at, run| {
                        run.fill(at + run.len());
                        Ok::<(), ()>(())
                    },
                )
            };
            with_threads(threads, || filled(&mut runs)).unwrap();
            assert_eq!(runs, [3, 3, 3, 4, 4, 4, 5, 5, 5, 4]);
            let work = with_threads(threads, || {
                let ledger = Ledger::open();
                booked(50, |i| {
                    demand::computed(Thing::Samples, i as u64);
                    Ok(())
                })
                .unwrap();
                ledger.close()
            });
            assert_eq!(work.computed(Thing::Samples), 49 * 50 / 2);
        }
    }

    /// A workspace is of one job at a time, and no more are made than jobs run at once.
    #[test]
    fn workspaces_are_of_one_job_at_a_time() {
        let made = AtomicUsize::new(0);
        let own = || (made.fetch_add(1, Ordering::SeqCst), 0_usize);
        let found = with_threads(3, || {
            map_with(200, own, |(_, jobs), i| {
                *jobs += 1;
                i
            })
        });
        assert_eq!(found, (0..200).collect::<Vec<_>>());
        assert!(made.load(Ordering::SeqCst) <= 3);
    }
}
