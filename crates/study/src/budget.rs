//! A budget for a question: how long it may take and how much memory, what that does to it, and what it will take at least.
//!
//! Two things hold a question to its [`Limits`]. Before the work, what it takes at least is computed from its scenario
//! (`takes` of every study, `memory` for cubes), and what exceeds a limit is refused. During the work one thread looks at
//! the clock and at the memory of the process, and stops the question at its next [`stop::check`](hadar::stop::check) where either
//! has passed its limit. The forecast is a lower bound, since how many boxes a proof needs, or a classifier needs epochs, is known
//! only afterwards: the rest is the watching thread's.
//!
//! Memory is what is resident of the process, whoever took it; Linux says how much that is. Elsewhere it is not watched, and only
//! what is known before the work is refused.

use super::Study;
use super::memory;
use hadar::error::{Error, Result};
use hadar::stop::{Reason, Stop};
use hadar::units::Dimension;
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How often the memory is looked at.
const LOOK: Duration = Duration::from_millis(20);
/// Seconds that a core of a fast machine takes at least for one value: a band of a scene with one of its terms, as it is evaluated.
const SECONDS_A_VALUE: f64 = 2e-10;
/// Evaluations of a scene that a search for the closest state takes at least.
const EVALUATIONS: f64 = 100.0;
/// Seconds that a core of a fast machine takes at least for one sample of a cube, rendered, taken apart or matched: a fiftieth of what a
/// street of 480 x 640 x 54 takes.
const SECONDS_A_SAMPLE: f64 = 2e-8;
/// Spectra of doubles that every material is kept as: at nodes and bands, before and behind the path.
const SPECTRA_OF_A_MATERIAL: u64 = 2;
/// Units of memory, bytes.
const UNITS: [(&str, f64); 7] = [
    ("B", 1.0),
    ("kB", 1e3),
    ("MB", 1e6),
    ("GB", 1e9),
    ("KiB", 1024.0),
    ("MiB", 1048576.0),
    ("GiB", 1073741824.0),
];

/// How long a question may take, and how much memory; none: as much as there is.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Limits {
    /// Longest time.
    pub time: Option<Duration>,
    /// Most memory of the process, bytes.
    pub memory_bytes: Option<u64>,
}

/// What a question takes at least.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Takes {
    /// Memory, bytes.
    pub memory_bytes: u64,
    /// Time of one core, s.
    pub core_s: f64,
}

impl Takes {
    /// What a cube takes of which every sample is looked at; its memory is asked for where it is taken.
    pub(crate) fn of_samples([rows, columns, bands]: [usize; 3]) -> Self {
        let core_s = SECONDS_A_SAMPLE * rows as f64 * columns as f64 * bands as f64;
        Self { core_s, ..Self::default() }
    }
}

/// One after the other.
impl std::iter::Sum for Takes {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), |sum, one| Self {
            memory_bytes: sum.memory_bytes.max(one.memory_bytes),
            core_s: sum.core_s + one.core_s,
        })
    }
}

/// Reads a limit of time: `90 s`, `5 min`.
///
/// # Errors
/// No duration, or none above 0.
pub fn time(text: &str) -> Result<Duration> {
    let seconds = Dimension::Time.parse(text)?;
    Duration::try_from_secs_f64(seconds).ok().filter(|time| !time.is_zero()).ok_or_else(|| {
        Error::malformed(format!("`{text}` is not a valid duration"), "write it as 90 s, 5 min or 2 h")
    })
}

/// Reads a limit of memory: `2 GB`, `500 MB`, `4 GiB`.
///
/// # Errors
/// No size, or less than a byte.
pub fn size(text: &str) -> Result<u64> {
    let (number, unit) = text.split_at(text.find(|c: char| c.is_alphabetic()).unwrap_or(text.len()));
    let factor = UNITS.iter().find(|(name, _)| *name == unit.trim()).map(|(_, factor)| *factor);
    let bytes = number.trim().parse::<f64>().ok().zip(factor).map(|(number, factor)| number * factor);
    bytes.filter(|bytes| *bytes >= 1.0 && bytes.is_finite()).map(|bytes| bytes as u64).ok_or_else(|| {
        Error::malformed(format!("`{text}` is not an amount of memory"), "write it as 2 GB, 500 MB or 4 GiB")
    })
}

impl Limits {
    /// Whether there are any.
    #[must_use]
    pub fn any(self) -> bool {
        self != Self::default()
    }

    /// Makes them those of the whole process: works that ask for memory beforehand get no more than is allowed.
    pub fn hold(self) {
        memory::limit(self.memory_bytes);
    }

    /// Refuses in advance what takes more than is allowed even if all `threads` do nothing else.
    ///
    /// # Errors
    /// A limit that is exceeded, with what would be taken.
    pub fn admit(self, takes: Takes, threads: usize) -> Result<()> {
        let seconds = takes.core_s / threads.max(1) as f64;
        if let Some(time) = self.time.filter(|time| seconds > time.as_secs_f64()) {
            let found = format!(
                "this takes {} or more on {threads} threads, and the limit of time is {}",
                duration(seconds),
                duration(time.as_secs_f64())
            );
            return Err(Error::malformed(
                found,
                "allow more, or ask for fewer bands, alternatives, surroundings or pixels",
            ));
        }
        if let Some(memory) = self.memory_bytes.filter(|memory| takes.memory_bytes > *memory) {
            let found = format!(
                "this takes {} of memory or more, and the limit is {}",
                bytes(takes.memory_bytes),
                bytes(memory)
            );
            return Err(Error::malformed(found, "allow more, or ask for fewer bands or alternatives"));
        }
        Ok(())
    }

    /// Watches over work until the result is dropped. Where a limit is exceeded the work is stopped, and `then` is done on the thread
    /// that watches.
    ///
    /// # Errors
    /// There are limits, and the system gives no thread.
    pub fn watch(self, stop: &Stop, then: impl FnOnce(Reason) + Send + 'static) -> Result<Watch> {
        let ended = Arc::new((Mutex::new(false), Condvar::new()));
        let watch = Watch { ended: Arc::clone(&ended) };
        if !self.any() {
            return Ok(watch);
        }
        let (stop, begun) = (stop.clone(), Instant::now());
        let work = move || {
            let (over, woken) = &*ended;
            let mut over = over.lock().unwrap_or_else(PoisonError::into_inner);
            while !*over {
                let left = self.time.map(|time| time.saturating_sub(begun.elapsed()));
                let reason = if left.is_some_and(|left| left.is_zero()) {
                    Some(Reason::TimeLimit)
                } else {
                    let most = self.memory_bytes.unwrap_or(u64::MAX);
                    memory::resident().filter(|resident| *resident > most).map(|_| Reason::MemoryLimit)
                };
                if let Some(reason) = reason {
                    drop(over);
                    stop.now(reason);
                    return then(reason);
                }
                let nap = left.unwrap_or(Duration::MAX).min(match self.memory_bytes {
                    Some(_) => LOOK,
                    None => Duration::from_secs(3600),
                });
                over = woken.wait_timeout(over, nap).unwrap_or_else(PoisonError::into_inner).0;
            }
        };
        let started = std::thread::Builder::new().name("watch".into()).spawn(work);
        started.map(|_| watch).map_err(|error| {
            Error::malformed(format!("no thread can watch over the limits ({error})"), "leave the limits out")
        })
    }

    /// What is said of work that was stopped.
    #[must_use]
    pub fn stopped(self, reason: Reason) -> Error {
        match (reason, self) {
            (Reason::TimeLimit, Self { time: Some(time), .. }) => Error::malformed(
                format!("stopped after {}, the limit of time", duration(time.as_secs_f64())),
                "allow more, or ask for less",
            ),
            (Reason::MemoryLimit, Self { memory_bytes: Some(most), .. }) => Error::malformed(
                format!("stopped above {} of memory, the limit", bytes(most)),
                "allow more, or ask for less",
            ),
            (Reason::NobodyListens, _) => {
                Error::malformed("stopped: nobody waits for the answer any more", "ask again")
            }
            _ => Error::malformed("stopped", "ask again"),
        }
    }
}

/// A thread that watches over limits until this is dropped.
#[derive(Debug)]
#[must_use]
pub struct Watch {
    ended: Arc<(Mutex<bool>, Condvar)>,
}

impl Drop for Watch {
    fn drop(&mut self) {
        let (over, woken) = &*self.ended;
        *over.lock().unwrap_or_else(PoisonError::into_inner) = true;
        woken.notify_all();
    }
}

impl Study {
    /// What the closest states of all alternatives take at least: every material at every node of the bands, and a search for each
    /// alternative, which evaluates the scene with all of its surroundings. A factor of ten more is usual, more with a proof among
    /// many surroundings.
    #[must_use]
    pub fn takes(&self) -> Takes {
        let nodes = self.bands.nodes_cm1().len() as u64;
        let materials = (self.targets().count() + self.alternatives.len()) as u64;
        let terms = (self.surroundings.objects().len() + 2) as f64;
        let searches = self.alternatives.len() as f64;
        Takes {
            memory_bytes: 8 * SPECTRA_OF_A_MATERIAL * nodes.saturating_mul(materials),
            core_s: SECONDS_A_VALUE * EVALUATIONS * searches * nodes as f64 * terms,
        }
    }
}

/// A time in the unit that suits it.
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{s:.3} s").replace(".000", ""),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.0} h", s / 3600.0),
    }
}

fn bytes(count: u64) -> String {
    match count as f64 {
        n if n < 1e9 => format!("{:.0} MB", n / 1e6),
        n => format!("{:.1} GB", n / 1e9),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hadar::stop;

    #[test]
    fn limits_are_read_with_their_unit() {
        assert_eq!(time("90 s").unwrap(), Duration::from_secs(90));
        assert_eq!(time("5 min").unwrap(), Duration::from_secs(300));
        assert_eq!([size("2 GB").unwrap(), size("1.5MiB").unwrap()], [2_000_000_000, 3 << 19]);
        for wrong in ["", "5", "0 s", "-1 s", "s", "1e999 s", "1e300 h", "nan s", "2 GB"] {
            assert!(time(wrong).is_err(), "{wrong}");
        }
        for wrong in ["", "2", "0 GB", "-1 GB", "GB", "1e999 GB", "nan GB", "inf GB", "2 gb", "2 s"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }

    /// Work without an end is stopped by either limit; what is allowed is left alone.
    #[test]
    fn work_is_stopped_where_a_limit_is_exceeded() {
        let endless = || loop {
            stop::check();
        };
        let soon = Limits { time: Some(Duration::from_millis(1)), ..Limits::default() };
        let little = Limits { memory_bytes: Some(1), ..Limits::default() };
        let one_by_one = [(soon, Reason::TimeLimit), (little, Reason::MemoryLimit)];
        for (limits, reason) in one_by_one
            .into_iter()
            .filter(|(_, reason)| *reason == Reason::TimeLimit || memory::resident().is_some())
        {
            let token = Stop::new();
            let (told, heard) = std::sync::mpsc::channel();
            let watch = limits.watch(&token, move |reason| told.send(reason).unwrap_or(())).unwrap();
            assert_eq!(stop::within(&token, endless).unwrap_err().reason, reason);
            assert_eq!(heard.recv(), Ok(reason));
            drop(watch);
        }
        let token = Stop::new();
        let watch = Limits::default().watch(&token, |_| panic!("there is no limit")).unwrap();
        drop(watch);
        assert_eq!(token.said(), None);
    }

    #[test]
    fn what_is_known_to_exceed_a_limit_is_refused_with_both_figures() {
        let limits = Limits { time: Some(Duration::from_secs(60)), memory_bytes: Some(1_000_000_000) };
        let takes = |core_s, memory_bytes| Takes { core_s, memory_bytes };
        assert!(limits.admit(takes(100.0, 999_999_999), 2).is_ok());
        let long = limits.admit(takes(3600.0, 0), 2).unwrap_err().to_string();
        assert!(long.contains("30 min") && long.contains("60 s"), "{long}");
        let large = limits.admit(takes(0.0, 3_000_000_000), 2).unwrap_err().to_string();
        assert!(large.contains("3.0 GB") && large.contains("1.0 GB"), "{large}");
    }
}
