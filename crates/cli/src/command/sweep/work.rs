//! Rows worked off by as many threads as there are, each row on one of them.

use hadar::error::{Error, Result};
use hadar::parallel::STACK;
use hadar::stop;
use std::panic::resume_unwind;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Does `count` jobs, each on a thread of its own; fewer jobs than threads share these out among themselves. `done` is told how many.
///
/// # Errors
/// The first that a job gives, which ends the work. A job that unwinds ends it too, with its own payload.
pub(super) fn each(
    count: usize,
    job: &(dyn Fn(usize) -> Result<()> + Sync),
    done: &(dyn Fn(usize, usize) + Sync),
) -> Result<()> {
    let threads = rayon::current_num_threads();
    let workers = threads.min(count).max(1);
    let (next, finished, stopped) = (AtomicUsize::new(0), AtomicUsize::new(0), AtomicBool::new(false));
    let failure = Mutex::new(None);
    let fail = |error: Error| {
        stopped.store(true, Ordering::Relaxed);
        if let Ok(mut failure) = failure.lock() {
            failure.get_or_insert(error);
        }
    };
    let work = || {
        while !stopped.load(Ordering::Relaxed) {
            let index = next.fetch_add(1, Ordering::Relaxed);
            if index >= count {
                return;
            }
            stop::check();
            match job(index) {
                Ok(()) => done(finished.fetch_add(1, Ordering::Relaxed) + 1, count),
                Err(error) => fail(error),
            }
        }
    };
    // A pool of its own keeps a row on its worker, so that no thread takes up another row while it waits for parts of its own.
    let pool = || rayon::ThreadPoolBuilder::new().num_threads((threads / workers).max(1)).stack_size(STACK);
    let worker = || match pool().build() {
        Ok(pool) => pool.install(work),
        Err(_) => work(),
    };
    std::thread::scope(|scope| {
        let started: Vec<_> = (1..workers)
            .filter_map(|_| std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, worker).ok())
            .collect();
        worker();
        // A row that was stopped stops the sweep.
        for other in started {
            other.join().unwrap_or_else(|payload| resume_unwind(payload));
        }
    });
    match failure.into_inner() {
        Ok(Some(error)) => Err(error),
        _ => Ok(()),
    }
}
