//! Work without the interpreter, on so many threads, until the interpreter is interrupted or a limit is exceeded.
//!
//! The thread that calls waits, and asks the interpreter now and then whether there is a signal (Ctrl-C); then the work is stopped.
//! It also tells whoever asked for it how far the work is, since only it has the interpreter.
//! Pools are kept for the next call, and used by one call at a time, so that no other call is stopped with it; one that was stopped is
//! left. A process that was
//! forked has none of its parent's threads, so a pool is one of its process; the pool that all of rayon shares is never started.

use crate::error::{raised, shown};
use hadar::Error;
use hadar::stop::{self, Reason, Stop};
use hadar_study::budget::Limits;
use pyo3::{Borrowed, FromPyObject, Py, PyAny, PyErr, PyResult, Python};
use rayon::ThreadPool;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::{Condvar, Mutex, PoisonError};
use std::thread::yield_now;
use std::time::Duration;

/// Most threads that can be asked for.
const MOST: usize = 1024;
/// How many threads are asked for; 0 for all cores.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Threads(pub(crate) usize);

impl Threads {
    pub(crate) const INSTEAD: &str = "give a whole number from 1 to 1024, or None for all cores";
}

impl FromPyObject<'_, '_> for Threads {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        given.extract().map(Self).map_err(|_| {
            let found = format!("threads: {}", shown(&given));
            raised(Error::malformed(found, Self::INSTEAD))
        })
    }
}

/// How often the interpreter is asked whether it was interrupted.
const LOOK: Duration = Duration::from_millis(50);

/// How often the caller looks whether the work is done before it sleeps.
const YIELDS: usize = 100;

/// Those that nobody uses and that were never stopped, by process and number of threads.
static POOLS: Mutex<BTreeMap<(u32, usize), Vec<Pool>>> = Mutex::new(BTreeMap::new());

/// Threads, and what stops their work.
struct Pool {
    threads: ThreadPool,
    stop: Stop,
}

/// How far the step is that is at work: so many done, of so many.
#[derive(Debug, Default)]
pub(crate) struct Counted {
    done: AtomicUsize,
    of: AtomicUsize,
}

impl Counted {
    pub(crate) fn set(&self, done: usize, of: usize) {
        self.done.store(done, Relaxed);
        self.of.store(of, Relaxed);
    }

    pub(crate) fn add(&self, more: usize) {
        self.done.fetch_add(more, Relaxed);
    }

    fn seen(&self) -> (usize, usize) {
        (self.done.load(Relaxed), self.of.load(Relaxed))
    }
}

/// Does the work on as many threads as asked for, or as the command would take, while others have the interpreter.
pub(crate) fn with_threads<T: Send>(
    py: Python<'_>,
    threads: Option<Threads>,
    work: impl FnOnce() -> hadar::Result<T> + Send,
) -> PyResult<T> {
    with_limits(py, threads, &Limits::default(), None, |_| work())
}

/// The same within limits; `progress` is called with how far it is, and ends the work with what it raises.
pub(crate) fn with_limits<T: Send>(
    py: Python<'_>,
    threads: Option<Threads>,
    limits: &Limits,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&Counted) -> hadar::Result<T> + Send,
) -> PyResult<T> {
    // While the interpreter is held nobody forks, so that no child finds the list locked.
    let (key, pool) = pool(threads).map_err(raised)?;
    let stop = &pool.stop;
    let watch = limits.watch(stop, |_| ()).map_err(raised)?;
    let (done, woken) = (Mutex::new(None), Condvar::new());
    let counted = Counted::default();
    let job = || {
        let made = stop::within(stop, || work(&counted));
        *done.lock().unwrap_or_else(PoisonError::into_inner) = Some(made);
        woken.notify_all();
    };
    let wait = || {
        // What takes microseconds is there before a thread sleeps and wakes.
        for _ in 0..YIELDS {
            if done.try_lock().is_ok_and(|done| done.is_some()) {
                return true;
            }
            yield_now();
        }
        let found = done.lock().unwrap_or_else(PoisonError::into_inner);
        let found = match found.is_some() {
            true => found,
            false => woken.wait_timeout(found, LOOK).unwrap_or_else(PoisonError::into_inner).0,
        };
        found.is_some()
    };
    let mut interrupted: Option<PyErr> = None;
    let mut told = counted.seen();
    let mut tell = || {
        let seen = counted.seen();
        match progress {
            Some(progress) if seen != told => {
                told = seen;
                progress.call1(py, seen).map(drop)
            }
            _ => Ok(()),
        }
    };
    pool.threads.in_place_scope(|scope| {
        scope.spawn(|_| job());
        while !py.detach(wait) {
            if let Err(signal) = py.check_signals().and_then(|()| tell()) {
                stop.now(Reason::Interrupted);
                interrupted.get_or_insert(signal);
            }
        }
    });
    drop(watch);
    if stop.said().is_none() {
        POOLS.lock().unwrap_or_else(PoisonError::into_inner).entry(key).or_default().push(pool);
    }
    if interrupted.is_none() {
        tell()?;
    }
    match (done.into_inner().unwrap_or_else(PoisonError::into_inner), interrupted) {
        (_, Some(signal)) => Err(signal),
        (Some(Ok(made)), None) => made.map_err(raised),
        (Some(Err(stopped)), None) => Err(raised(limits.stopped(stopped.reason))),
        (None, None) => Err(raised(limits.stopped(Reason::NobodyListens))),
    }
}

fn pool(threads: Option<Threads>) -> hadar::Result<((u32, usize), Pool)> {
    let threads = threads.map(|Threads(count)| count);
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
    let stop = Stop::new();
    let threads = stop.own_threads(key.1).map_err(|error| {
        let found = format!("{count} threads cannot be started ({error})");
        Error::malformed(found, "ask for fewer with threads=1")
    })?;
    Ok((key, Pool { threads, stop }))
}
