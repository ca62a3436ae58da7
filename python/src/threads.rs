//! Work without the interpreter, on so many threads, until the interpreter is interrupted or a limit is exceeded.
//!
//! The thread that calls waits, and asks the interpreter now and then whether there is a signal (Ctrl-C); then the work is stopped.
//! Pools are kept for the next call, and used by one call at a time, so that no other call is stopped with it. A process that was
//! forked has none of its parent's threads, so a pool is one of its process; the pool that all of rayon shares is never started.

use crate::error::raised;
use hadar::Error;
use hadar::parallel::STACK;
use hadar::stop::{self, Reason, Stop};
use hadar_study::budget::Limits;
use pyo3::{PyErr, PyResult, Python};
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::collections::BTreeMap;
use std::sync::{Condvar, Mutex, PoisonError};
use std::time::Duration;

/// Most threads that can be asked for.
const MOST: usize = 1024;
/// How often the interpreter is asked whether it was interrupted.
const LOOK: Duration = Duration::from_millis(50);

/// Those that nobody uses, by process and number of threads.
static POOLS: Mutex<BTreeMap<(u32, usize), Vec<ThreadPool>>> = Mutex::new(BTreeMap::new());

/// Does the work on as many threads as asked for, or as the command would take, while others have the interpreter.
pub(crate) fn with_threads<T: Send>(
    py: Python<'_>,
    threads: Option<usize>,
    work: impl FnOnce() -> hadar::Result<T> + Send,
) -> PyResult<T> {
    with_limits(py, threads, Limits::default(), work)
}

/// The same within limits.
pub(crate) fn with_limits<T: Send>(
    py: Python<'_>,
    threads: Option<usize>,
    limits: Limits,
    work: impl FnOnce() -> hadar::Result<T> + Send,
) -> PyResult<T> {
    // While the interpreter is held nobody forks, so that no child finds the list locked.
    let (key, pool) = pool(threads).map_err(raised)?;
    let stop = Stop::new();
    let watch = limits.watch(&stop, |_| ()).map_err(raised)?;
    let (done, woken) = (Mutex::new(None), Condvar::new());
    let job = || {
        let made = stop::within(&stop, work);
        *done.lock().unwrap_or_else(PoisonError::into_inner) = Some(made);
        woken.notify_all();
    };
    let wait = || {
        let found = done.lock().unwrap_or_else(PoisonError::into_inner);
        let found = match found.is_some() {
            true => found,
            false => woken.wait_timeout(found, LOOK).unwrap_or_else(PoisonError::into_inner).0,
        };
        found.is_some()
    };
    let mut interrupted: Option<PyErr> = None;
    let lent = stop.lend(&pool);
    pool.in_place_scope(|scope| {
        scope.spawn(|_| job());
        while !py.detach(wait) {
            if let Err(signal) = py.check_signals() {
                stop.now(Reason::Interrupted);
                interrupted.get_or_insert(signal);
            }
        }
    });
    drop((lent, watch));
    POOLS.lock().unwrap_or_else(PoisonError::into_inner).entry(key).or_default().push(pool);
    match (done.into_inner().unwrap_or_else(PoisonError::into_inner), interrupted) {
        (_, Some(signal)) => Err(signal),
        (Some(Ok(made)), None) => made.map_err(raised),
        (Some(Err(stopped)), None) => Err(raised(limits.stopped(stopped.reason))),
        (None, None) => Err(raised(limits.stopped(Reason::NobodyListens))),
    }
}

fn pool(threads: Option<usize>) -> hadar::Result<((u32, usize), ThreadPool)> {
    if let Some(most) = threads.filter(|threads| *threads > MOST) {
        let expected = format!("at most {MOST}, or 0 for all cores");
        return Err(Error::out_of_range("threads", most as f64, "", expected));
    }
    let named = || std::env::var("RAYON_NUM_THREADS").ok()?.trim().parse::<usize>().ok();
    let count = match threads.or_else(named).unwrap_or(0) {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        count => count,
    };
    let key = (std::process::id(), count.min(MOST));
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(pool) = pools.get_mut(&key).and_then(Vec::pop) {
        return Ok((key, pool));
    }
    let started = ThreadPoolBuilder::new().num_threads(key.1).stack_size(STACK).build();
    let pool = started.map_err(|error| {
        let found = format!("{count} threads cannot be started ({error})");
        Error::malformed(found, "ask for fewer with threads=1")
    })?;
    Ok((key, pool))
}
