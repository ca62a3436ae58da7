//! Work without the interpreter, on so many threads.
//!
//! Pools are kept for the next call. A process that was forked has none of its parent's threads, so a pool is one of its process;
//! the pool that all of rayon shares is never started.

use crate::error::raised;
use hadar::Error;
use hadar::parallel::STACK;
use pyo3::{PyResult, Python};
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Most threads that can be asked for.
const MOST: usize = 1024;

/// By process and number of threads.
static POOLS: Mutex<BTreeMap<(u32, usize), Arc<ThreadPool>>> = Mutex::new(BTreeMap::new());

/// Does the work on as many threads as asked for, or as the command would take, while others have the interpreter.
pub(crate) fn with_threads<T: Send>(
    py: Python<'_>,
    threads: Option<usize>,
    work: impl FnOnce() -> hadar::Result<T> + Send,
) -> PyResult<T> {
    // While the interpreter is held nobody forks, so that no child finds the list locked.
    let pool = pool(threads).map_err(raised)?;
    py.detach(|| pool.install(work)).map_err(raised)
}

fn pool(threads: Option<usize>) -> hadar::Result<Arc<ThreadPool>> {
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
    if let Some(pool) = pools.get(&key) {
        return Ok(Arc::clone(pool));
    }
    let started = ThreadPoolBuilder::new().num_threads(key.1).stack_size(STACK).build();
    let pool = Arc::new(started.map_err(|error| {
        let found = format!("{count} threads cannot be started ({error})");
        Error::malformed(found, "ask for fewer with threads=1")
    })?);
    pools.insert(key, Arc::clone(&pool));
    Ok(pool)
}
