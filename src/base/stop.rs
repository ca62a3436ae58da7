//! Work that can be stopped before it ends, by agreement: long loops ask now and then whether they are still wanted.
//!
//! Whoever asks a question makes a [`Stop`] and does the work [`within`] it. Any thread may then say [`Stop::now`], with a reason. Loops
//! that can last call [`check`], which where their question was stopped unwinds to `within`: no value is returned, destructors run, and
//! nothing is printed. Where nobody has stopped anything `check` reads one number that all threads share, and where there is no `Stop`
//! it does nothing, so that users of this library who have none never notice it. No stretch of work between two checks should take
//! more than 0.1 s.
//!
//! A `Stop` belongs to the thread that works within it. Parallel work belongs to it too if its threads do: [`Stop::own_threads`] starts
//! such a pool. A program that answers one question in its life makes its `Stop` that of the whole process by
//! [`Stop::of_the_process`].
//!
//! What is shared between questions must not be left half done: initialisers of statics do not check, and locks are taken over
//! from a thread that unwound.

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use std::cell::RefCell;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::{Arc, OnceLock};
use std::thread::panicking;

/// Why work was stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Reason {
    /// The user interrupted it (SIGINT, Ctrl-C).
    Interrupted,
    /// The system asked the program to end (SIGTERM).
    Terminated,
    /// It took longer than it was allowed to.
    TimeLimit,
    /// It took more memory than it was allowed to.
    MemoryLimit,
    /// Nobody waits for its answer any more.
    NobodyListens,
}

/// Stack of every thread that the program starts, bytes: what it needs does not depend on what the system gives the first one.
pub const STACK: usize = 16 << 20;

const REASONS: [Reason; 5] =
    [Reason::Interrupted, Reason::Terminated, Reason::TimeLimit, Reason::MemoryLimit, Reason::NobodyListens];

/// How many tokens have something to say: as long as there is none, nobody looks for his own.
static SPEAKING: AtomicUsize = AtomicUsize::new(0);
static OF_THE_PROCESS: OnceLock<Stop> = OnceLock::new();

thread_local! {
    static OF_THIS_THREAD: RefCell<Option<Stop>> = const { RefCell::new(None) };
}

/// Says whether some work is still wanted. Its clones say the same.
#[derive(Clone, Default)]
pub struct Stop(Arc<Token>);

#[derive(Default)]
struct Token {
    /// 0, or one more than the index of the reason.
    said: AtomicUsize,
    /// Checks that are passed before it stops by itself; 0: it does not.
    at_check: usize,
    checks: AtomicUsize,
    counts: bool,
}

impl Drop for Token {
    fn drop(&mut self) {
        if self.counts || *self.said.get_mut() != 0 {
            SPEAKING.fetch_sub(1, Relaxed);
        }
    }
}

/// That work was stopped, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stopped {
    /// Why.
    pub reason: Reason,
    by: Stop,
}

impl fmt::Debug for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Stop").field(&self.said()).finish()
    }
}

impl PartialEq for Stop {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl Eq for Stop {}

impl Stop {
    /// One that has said nothing yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// One that counts the checks of its work ([`Stop::checks`]), and stops it at the one of this number, from 1; 0: never. For tests,
    /// which must not depend on a clock.
    #[must_use]
    pub fn at_check(number: usize) -> Self {
        SPEAKING.fetch_add(1, Relaxed);
        let [said, checks] = [AtomicUsize::new(0), AtomicUsize::new(0)];
        Self(Arc::new(Token { said, at_check: number, checks, counts: true }))
    }

    /// How many checks were passed, of a token that counts them.
    #[must_use]
    pub fn checks(&self) -> usize {
        self.0.checks.load(Relaxed)
    }

    /// Stops the work. The first reason holds.
    pub fn now(&self, reason: Reason) {
        let index = REASONS.iter().position(|known| *known == reason).unwrap_or(0) + 1;
        // Counted first, so that it is never given back before.
        SPEAKING.fetch_add(1, Relaxed);
        let first = self.0.said.compare_exchange(0, index, Relaxed, Relaxed).is_ok();
        if !first || self.0.counts {
            SPEAKING.fetch_sub(1, Relaxed);
        }
    }

    /// Why the work was stopped; none if it was not.
    #[must_use]
    pub fn said(&self) -> Option<Reason> {
        let index = self.0.said.load(Relaxed).checked_sub(1)?;
        REASONS.get(index).copied()
    }

    /// The one that holds for all threads of this process that have none of their own.
    pub fn of_the_process() -> &'static Self {
        OF_THE_PROCESS.get_or_init(Self::new)
    }

    /// A pool of so many threads whose work is stopped by this. It is to be dropped with its question.
    ///
    /// # Errors
    /// The system does not give so many threads.
    pub fn own_threads(&self, count: usize) -> Result<ThreadPool, ThreadPoolBuildError> {
        let own = self.clone();
        ThreadPoolBuilder::new()
            .num_threads(count.max(1))
            .stack_size(STACK)
            .start_handler(move |_| OF_THIS_THREAD.set(Some(own.clone())))
            .build()
    }

    /// Makes the threads of a pool work for this until the result is dropped. Nobody else may use the pool meanwhile.
    pub fn lend<'p>(&self, pool: &'p ThreadPool) -> Lent<'p> {
        pool.broadcast(|_| OF_THIS_THREAD.set(Some(self.clone())));
        Lent(pool)
    }

    /// Unwinds where it has said something.
    fn look(&self) {
        if self.0.counts && self.0.checks.fetch_add(1, Relaxed) + 1 == self.0.at_check {
            self.now(Reason::Interrupted);
        }
        if let Some(reason) = self.said() {
            resume_unwind(Box::new(Stopped { reason, by: self.clone() }));
        }
    }
}

/// A pool whose threads work for a [`Stop`] until this is dropped.
#[derive(Debug)]
#[must_use]
pub struct Lent<'p>(&'p ThreadPool);

impl Drop for Lent<'_> {
    fn drop(&mut self) {
        self.0.broadcast(|_| OF_THIS_THREAD.set(None));
    }
}

/// Unwinds to [`within`] where the work that this thread does was stopped; else does nothing.
#[inline]
pub fn check() {
    if SPEAKING.load(Relaxed) != 0 {
        look();
    }
}

#[cold]
fn look() {
    // A destructor that unwinds while another does would end the process.
    if panicking() {
        return;
    }
    let own = OF_THIS_THREAD.try_with(|own| own.borrow().clone()).ok().flatten();
    if let Some(own) = own {
        own.look();
    }
    if let Some(of_all) = OF_THE_PROCESS.get() {
        of_all.look();
    }
}

/// Makes this thread work for a token until it is dropped.
struct Working(Option<Stop>);

impl Working {
    fn begin(stop: &Stop) -> Self {
        Self(OF_THIS_THREAD.replace(Some(stop.clone())))
    }
}

impl Drop for Working {
    fn drop(&mut self) {
        OF_THIS_THREAD.set(self.0.take());
    }
}

/// What comes of a job that `stop` can stop.
///
/// ```
/// use hadar::stop::{self, Reason, Stop};
///
/// let stop = Stop::new();
/// let count = |most: u64| (1..=most).inspect(|_| stop::check()).sum::<u64>();
/// assert_eq!(stop::within(&stop, || count(4)), Ok(10));
/// stop.now(Reason::TimeLimit);
/// assert_eq!(stop::within(&stop, || count(u64::MAX)).unwrap_err().reason, Reason::TimeLimit);
/// ```
///
/// # Errors
/// It was stopped. Whatever else the job panics with goes on.
pub fn within<T>(stop: &Stop, job: impl FnOnce() -> T) -> Result<T, Stopped> {
    let working = Working::begin(stop);
    let done = catch_unwind(AssertUnwindSafe(job));
    drop(working);
    done.or_else(|payload| match payload.downcast::<Stopped>() {
        Ok(stopped) if stopped.by == *stop => Err(*stopped),
        Ok(other) => resume_unwind(other),
        Err(other) => resume_unwind(other),
    })
}

/// What comes of a job whose panics are held in; none if it panicked. That it was stopped goes on.
pub fn unless_it_panics<T>(job: impl FnOnce() -> T) -> Option<T> {
    catch_unwind(AssertUnwindSafe(job)).map_or_else(
        |payload| match payload.downcast::<Stopped>() {
            Ok(stopped) => resume_unwind(stopped),
            Err(_) => None,
        },
        Some,
    )
}

#[cfg(test)]
mod tests;
