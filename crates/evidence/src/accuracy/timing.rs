//! The time of one call: the least over short runs, so that what else the machine does counts as little as possible.

use std::hint::black_box;
use std::time::{Duration, Instant};

/// Calls are repeated until a run takes this long, so that the clock's own grain does not count.
const RUN: Duration = Duration::from_micros(200);

/// Seconds of one call of `work`: the least of the runs that fit into `budget`, at least three.
///
/// ```
/// use hadar_evidence::accuracy::timing::{Budget, seconds_of};
/// let short = seconds_of(Budget::QUICK, || (0..100_u64).fold(0, |a, i| a ^ i.wrapping_mul(3)));
/// assert!(short > 0.0 && short < 0.1);
/// ```
pub fn seconds_of<T>(budget: Budget, mut work: impl FnMut() -> T) -> f64 {
    let once = Instant::now();
    black_box(work());
    let once = once.elapsed().max(Duration::from_nanos(1));
    let calls = (RUN.as_secs_f64() / once.as_secs_f64()).ceil().clamp(1.0, 1e7) as u32;
    let start = Instant::now();
    let (mut least, mut runs) = (f64::INFINITY, 0);
    while runs < 3 || start.elapsed() < budget.0 {
        let run = Instant::now();
        for _ in 0..calls {
            black_box(work());
        }
        least = least.min(run.elapsed().as_secs_f64() / f64::from(calls));
        runs += 1;
    }
    least
}

/// How long one measurement may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Budget(Duration);

impl Budget {
    /// 5 ms.
    pub const QUICK: Self = Self(Duration::from_millis(5));
    /// 80 ms.
    pub const FULL: Self = Self(Duration::from_millis(80));

    /// Of a quick order or a full one.
    pub(super) fn of(quick: bool) -> Self {
        if quick { Self::QUICK } else { Self::FULL }
    }
}

/// Runs `work` in a pool of one thread; as it is if there can be no such pool.
pub(super) fn one_thread<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
        Ok(pool) => pool.install(work),
        Err(_) => work(),
    }
}
