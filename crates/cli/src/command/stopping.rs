//! What ends a command before it has answered: the user (Ctrl-C), the system (SIGTERM), and the limits of time and memory that it
//! was given.
//!
//! The work is told to stop and unwinds, so that nothing is left behind: staging folders go, a sweep's journal ends with a whole line,
//! and no report is written. What does not come back in time is ended as by a kill, which folders of reports survive. A second
//! signal ends the process at once.

use super::stderr::say;
use super::terminal::Stream;
use hadar::error::Result;
use hadar::stop::{self, Reason, Stop};
use hadar_study::budget::{Limits, Watch};
use std::process::ExitCode;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering::SeqCst};
use std::time::Duration;

/// How long work may take to come back after it was told to stop.
const GRACE: Duration = Duration::from_secs(2);

static LIMITS: OnceLock<Limits> = OnceLock::new();
static TOLD: AtomicBool = AtomicBool::new(false);

/// Holds the work of this process to its limits from now on, and listens for signals.
pub(super) fn begin(limits: Limits) -> Result<Watch> {
    LIMITS.get_or_init(|| limits);
    limits.hold();
    // Without them a signal ends the process as it does by itself.
    #[cfg(unix)]
    let _ = signals::listen();
    limits.watch(Stop::of_the_process(), end_after_grace)
}

/// What comes of a command, or what its process ends with if it was stopped.
pub(super) fn or_stopped<T>(work: impl FnOnce() -> T) -> std::result::Result<T, ExitCode> {
    stop::within(Stop::of_the_process(), work).map_err(|stopped| {
        tell(stopped.reason);
        ExitCode::from(code(stopped.reason))
    })
}

const fn code(reason: Reason) -> u8 {
    match reason {
        // As a shell says of what a signal has ended.
        Reason::Interrupted => 128 + 2,
        Reason::Terminated => 128 + 15,
        Reason::TimeLimit | Reason::MemoryLimit | Reason::NobodyListens => 1,
    }
}

/// Says once why the process ends.
fn tell(reason: Reason) {
    if TOLD.swap(true, SeqCst) {
        return;
    }
    match reason {
        Reason::Interrupted | Reason::Terminated => say("stopped"),
        _ => {
            let limits = LIMITS.get().copied().unwrap_or_default();
            say(&Stream::Err.message("error:", &limits.stopped(reason).to_string()));
        }
    }
}

/// Ends the process if its work does not.
fn end_after_grace(reason: Reason) {
    std::thread::sleep(GRACE);
    tell(reason);
    std::process::exit(i32::from(code(reason)));
}

#[cfg(unix)]
mod signals {
    use super::{code, end_after_grace};
    use hadar::stop::{Reason, Stop};
    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::flag;
    use signal_hook::low_level::pipe;
    use std::io::{self, Read as _};
    use std::os::unix::net::UnixStream;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering::SeqCst};

    const HEARD: [(i32, Reason); 2] = [(SIGINT, Reason::Interrupted), (SIGTERM, Reason::Terminated)];

    /// A thread that waits for a signal. One that the process was started to ignore (`nohup`, a job in the background) stays ignored.
    pub(super) fn listen() -> io::Result<()> {
        let ignored = ignored();
        let heard = HEARD.iter().filter(|(signal, _)| ignored >> (signal - 1) & 1 == 0);
        let (mut ear, mouth) = UnixStream::pair()?;
        let mut flags = Vec::new();
        for &(signal, reason) in heard {
            let came = Arc::new(AtomicBool::new(false));
            // In this order: the first signal finds the flag unset.
            flag::register_conditional_shutdown(signal, i32::from(code(reason)), Arc::clone(&came))?;
            flag::register(signal, Arc::clone(&came))?;
            pipe::register(signal, mouth.try_clone()?)?;
            flags.push((came, reason));
        }
        let wait = move || {
            let _open = mouth;
            while ear.read(&mut [0; 1]).is_ok_and(|count| count > 0) {
                if let Some((_, reason)) = flags.iter().find(|(came, _)| came.load(SeqCst)) {
                    Stop::of_the_process().now(*reason);
                    end_after_grace(*reason);
                }
            }
        };
        std::thread::Builder::new().name("signals".into()).spawn(wait).map(drop)
    }

    /// The signals that this process ignores, as a set of bits; where the system does not say (Linux does), none.
    fn ignored() -> u64 {
        let told = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let set = told.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        set.and_then(|set| u64::from_str_radix(set.trim(), 16).ok()).unwrap_or(0)
    }
}
