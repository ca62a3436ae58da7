//! The threads of the whole process, started before anything else: those that cannot be had are missed here, with a word,
//! and not in the middle of the work.
//!
//! Whoever waits for parallel work may be a thread of its own, as each question of the page is. So the pool has threads of its own too,
//! even if it is only one: the first thread of the program does other things and would leave that work undone.

use super::stderr::say;
use super::terminal::Stream;
use hadar::parallel::STACK;
use std::process::ExitCode;
use std::sync::{Arc, Mutex, mpsc};

/// Most threads that can be asked for.
pub(super) const MOST: usize = 1024;

/// Does the work of the program on a thread of a stack of its own, whatever the first one was given; where none can be had, on this one.
pub(crate) fn on_own_stack(work: impl Fn() -> ExitCode + Sync) -> ExitCode {
    with_stack(STACK, &work)
}

fn with_stack<T: Send>(bytes: usize, work: &(dyn Fn() -> T + Sync)) -> T {
    std::thread::scope(|scope| {
        match std::thread::Builder::new().name("main".to_owned()).stack_size(bytes).spawn_scoped(scope, work)
        {
            Ok(thread) => thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
            Err(_) => work(),
        }
    })
}

/// Starts as many as were asked for, here or by `RAYON_NUM_THREADS`, else one per core. Where the system does not give so
/// many, one does the work; where it gives none, the first thread of the program.
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
        std::thread::Builder::new().stack_size(STACK).spawn(move || {
            let part = parts.lock().ok().and_then(|parts| parts.recv().ok());
            part.map(rayon::ThreadBuilder::run)
        })
    };
    let mut failed = None;
    let threads = (0..count).map_while(|_| thread().map_err(|reason| failed = Some(reason)).ok()).count();
    if let Some(reason) = failed {
        let what = if count == 1 { "a thread" } else { &format!("{count} threads") };
        warn(format!("{what} cannot be started ({reason}); one does the work"));
    }
    let pool = rayon::ThreadPoolBuilder::new();
    let started = match threads {
        0 => pool.num_threads(1).use_current_thread().build_global(),
        _ => pool
            // Those that are left over end with `work`.
            .num_threads(if threads < count { 1 } else { count })
            .spawn_handler(|part| work.send(part).map_err(|_| std::io::Error::other("a thread has ended")))
            .build_global(),
    };
    if let Err(error) = started {
        warn(format!("{error}"));
    }
}

#[cfg(test)]
mod tests {
    use super::with_stack;
    use std::thread::current;

    #[test]
    fn a_stack_that_no_machine_has_leaves_the_thread_that_is_there() {
        let (here, of) = (current().id(), |bytes| with_stack(bytes, &|| current().id()));
        assert_ne!(of(1 << 20), here);
        assert_eq!(of(usize::MAX / 4), here);
    }
}
