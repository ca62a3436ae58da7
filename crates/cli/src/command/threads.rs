//! The threads of the whole process, started before anything else: those that cannot be had are missed here, with a word,
//! and not in the middle of the work.

use super::stderr::say;
use super::terminal::Stream;
use std::sync::{Arc, Mutex, mpsc};

/// Most threads that can be asked for.
pub(super) const MOST: usize = 1024;

/// Starts as many as were asked for, here or by `RAYON_NUM_THREADS`, else one per core. Where the system does not give so
/// many, the work is done by this one.
pub(super) fn start(asked: Option<usize>, quiet: bool) {
    let warn = |text: String| {
        if !quiet {
            say(&Stream::Err.message("warning:", &text));
        }
    };
    let named = || std::env::var("RAYON_NUM_THREADS").ok()?.trim().parse::<usize>().ok();
    let count = match asked.or_else(named).unwrap_or(0) {
        0 => std::thread::available_parallelism().map_or(1, usize::from).min(MOST),
        most if most > MOST => {
            warn(format!("RAYON_NUM_THREADS is {most}; {MOST} threads are taken"));
            MOST
        }
        count => count,
    };
    // A pool that could not be started cannot be started again: its threads are there before it is.
    let (work, parts) = mpsc::channel::<rayon::ThreadBuilder>();
    let parts = Arc::new(Mutex::new(parts));
    let thread = || {
        let parts = Arc::clone(&parts);
        std::thread::Builder::new().spawn(move || {
            let part = parts.lock().ok().and_then(|parts| parts.recv().ok());
            part.map(rayon::ThreadBuilder::run)
        })
    };
    let failed = if count == 1 { None } else { (0..count).find_map(|_| thread().err()) };
    let pool = rayon::ThreadPoolBuilder::new();
    let started = if count == 1 || failed.is_some() {
        drop(work);
        pool.num_threads(1).use_current_thread().build_global()
    } else {
        pool.num_threads(count)
            .spawn_handler(|part| work.send(part).map_err(|_| std::io::Error::other("a thread has ended")))
            .build_global()
    };
    if let Some(reason) = failed {
        warn(format!("{count} threads cannot be started ({reason}); one does the work"));
    }
    if let Err(error) = started {
        warn(format!("{error}"));
    }
}
