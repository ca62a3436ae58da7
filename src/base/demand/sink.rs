//! Where work is booked: the open [`Ledger`] of the thread that does it, so that no function hands one on.
//!
//! Who asks opens a ledger and closes it with the answer; who works books what was done, and where no ledger is open
//! nothing is. Ledgers nest, and what stands in the inner one is not in the outer one unless it is added there.
//!
//! A thread that waits for others may take up work of another question. Jobs that run in parallel therefore have each a
//! ledger of its own ([`ledger_of`]), and [`crate::parallel::booked`] adds them up in the one that was open around them.

use super::{Reason, Thing, Work};
use crate::error::Result;
use std::cell::RefCell;
use std::marker::PhantomData;

thread_local! {
    static OPEN: RefCell<Option<Work>> = const { RefCell::new(None) };
}

/// A ledger that is open on this thread until it is closed or dropped, which opens the one around it again.
///
/// ```
/// use hadar::demand::{self, Ledger, Thing};
/// let ledger = Ledger::open();
/// demand::computed(Thing::Windows, 3);
/// assert_eq!(ledger.close().computed(Thing::Windows), 3);
/// ```
#[derive(Debug)]
#[must_use]
pub struct Ledger {
    outer: Option<Work>,
    of_this_thread: PhantomData<*const ()>,
}

impl Ledger {
    /// An empty one.
    pub fn open() -> Self {
        Self { outer: OPEN.replace(Some(Work::default())), of_this_thread: PhantomData }
    }

    /// What was booked since it was opened.
    #[must_use]
    pub fn close(self) -> Work {
        OPEN.take().unwrap_or_default()
    }
}

impl Drop for Ledger {
    fn drop(&mut self) {
        OPEN.set(self.outer.take());
    }
}

/// What comes of a job, and what it took.
///
/// # Errors
/// Those of the job.
pub fn ledger_of<T>(job: impl FnOnce() -> Result<T>) -> Result<(T, Work)> {
    let ledger = Ledger::open();
    Ok((job()?, ledger.close()))
}

/// So many were computed.
pub fn computed(thing: Thing, count: u64) {
    book(|work| work.compute(thing, count));
}

/// So many were not, for a reason.
pub fn spared(thing: Thing, reason: Reason, count: u64) {
    book(|work| work.spare(thing, reason, count));
}

/// What another ledger has.
pub fn add(other: &Work) {
    book(|work| work.add(other));
}

fn book(entry: impl FnOnce(&mut Work)) {
    OPEN.with_borrow_mut(|open| open.as_mut().map(entry));
}
