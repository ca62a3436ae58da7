//! Work that keeps something of every pixel, refused where the machine has no memory for it.

use hadar::error::{Error, Result};
use hadar::stop;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::{Condvar, Mutex, PoisonError};
use std::time::Duration;

/// Who waits for memory looks so often whether his work is still wanted.
const LOOK: Duration = Duration::from_millis(50);

/// Most bytes that this process may take.
static MOST: AtomicU64 = AtomicU64::new(u64::MAX);
/// The memory of this process.
static MEMORY: Memory = Memory { promised: Mutex::new(0), returned: Condvar::new() };

/// Memory that several works share.
#[derive(Debug)]
struct Memory {
    /// Bytes that works under way have been promised.
    promised: Mutex<u64>,
    returned: Condvar,
}

/// Memory that a work may take until this is dropped.
#[derive(Debug)]
pub(super) struct Promised<'a> {
    bytes: u64,
    memory: &'a Memory,
}

impl Drop for Promised<'_> {
    fn drop(&mut self) {
        let mut promised = self.memory.promised.lock().unwrap_or_else(PoisonError::into_inner);
        *promised = promised.saturating_sub(self.bytes);
        self.memory.returned.notify_all();
    }
}

/// Promises so many bytes, where the system says how many are free (Linux does). What others of this process have been promised
/// may not be taken yet, so that it counts as not free; who does not fit beside them waits for them. A work asks only once, and never
/// while it holds a promise.
///
/// # Errors
/// More bytes than are free where nobody else is at work.
pub(super) fn promise(bytes: u64, what: &str, instead: &str) -> Result<Promised<'static>> {
    MEMORY.promise(bytes, &|| free().unwrap_or(u64::MAX), what, instead)
}

impl Memory {
    /// See [`promise`]; `free` says how many bytes are free.
    fn promise(&self, bytes: u64, free: &dyn Fn() -> u64, what: &str, instead: &str) -> Result<Promised<'_>> {
        let mut promised = self.promised.lock().unwrap_or_else(PoisonError::into_inner);
        loop {
            let free = free();
            if fits_beside(*promised, bytes, free) {
                within(bytes, free, what, instead)?;
                *promised += bytes;
                return Ok(Promised { bytes, memory: self });
            }
            stop::check();
            let waited = self.returned.wait_timeout(promised, LOOK);
            promised = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }
}

/// Refuses what takes more bytes than are free, of works that are never several at a time.
pub(super) fn check(bytes: u64, what: &str, instead: &str) -> Result<()> {
    within(bytes, free().unwrap_or(u64::MAX), what, instead)
}

/// Whether there is nobody to wait for, or room for all.
fn fits_beside(promised: u64, bytes: u64, free: u64) -> bool {
    promised == 0 || promised.checked_add(bytes).is_some_and(|all| all <= free)
}

fn within(bytes: u64, free: u64, what: &str, instead: &str) -> Result<()> {
    if bytes <= free {
        return Ok(());
    }
    let in_gb = |bytes: u64| format!("{:.1} GB", bytes as f64 / 1e9);
    let found = format!("{what} takes {} of memory, and {} are free", in_gb(bytes), in_gb(free));
    Err(Error::malformed(found, instead))
}

/// Limits what this process may take in all; none: as much as there is.
pub(super) fn limit(bytes: Option<u64>) {
    MOST.store(bytes.unwrap_or(u64::MAX), Relaxed);
}

/// Bytes that the system can give without swapping, and that this process may still take.
fn free() -> Option<u64> {
    let available = told("/proc/meminfo", "MemAvailable:");
    let allowed = match MOST.load(Relaxed) {
        u64::MAX => None,
        most => Some(most.saturating_sub(resident().unwrap_or(0))),
    };
    available.into_iter().chain(allowed).min()
}

/// Bytes of this process that are in memory, where the system says so (Linux does).
pub(super) fn resident() -> Option<u64> {
    told("/proc/self/status", "VmRSS:")
}

fn told(file: &str, name: &str) -> Option<u64> {
    let told = std::fs::read_to_string(file).ok()?;
    let line = told.lines().find_map(|line| line.strip_prefix(name))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicBool, Ordering::SeqCst};
    use std::sync::mpsc;

    #[test]
    fn what_fits_is_not_refused() {
        assert!(within(1 << 30, 1 << 31, "this", "that").is_ok());
        let message = within(3 << 30, 1 << 31, "this", "give less").unwrap_err().to_string();
        assert!(message.contains("this takes 3.2 GB of memory, and 2.1 GB are free"), "{message}");
        assert!(fits_beside(0, 5, 3), "alone it is refused, and does not wait");
        assert!(fits_beside(2, 3, 5) && !fits_beside(2, 4, 5) && !fits_beside(1, u64::MAX, u64::MAX));
        #[cfg(target_os = "linux")]
        assert!(free().is_some_and(|free| free > 1 << 20));
    }

    #[test]
    fn works_that_do_not_fit_together_wait_for_each_other() {
        let memory = Memory { promised: Mutex::new(0), returned: Condvar::new() };
        let first = memory.promise(6, &|| 10, "this", "that").unwrap();
        let returned = AtomicBool::new(false);
        let (asking, asked) = mpsc::channel();
        std::thread::scope(|scope| {
            scope.spawn(|| {
                // Asked with the lock held, which is given back only to wait.
                let free = || {
                    let _ = asking.send(());
                    10
                };
                let second = memory.promise(6, &free, "this", "that").unwrap();
                assert!(returned.load(SeqCst), "both at work");
                drop(second);
            });
            asked.recv().unwrap();
            returned.store(true, SeqCst);
            drop(first);
        });
        assert_eq!(*memory.promised.lock().unwrap(), 0);
    }
}
