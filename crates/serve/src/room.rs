//! The places of connections. Where all are taken, the oldest that asks nothing at the moment is closed for a new one.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tokio::task::AbortHandle;

/// Connections at once; a browser opens six.
const CONNECTIONS: usize = 512;

/// All places, by the number of their connection: the oldest has the least.
#[derive(Debug, Default)]
pub(crate) struct Room(Arc<Mutex<Taken>>);

#[derive(Debug, Default)]
struct Taken {
    next: u64,
    by: BTreeMap<u64, Held>,
}

#[derive(Debug)]
struct Held {
    asking: Arc<AtomicUsize>,
    task: Option<AbortHandle>,
}

/// A place of a connection, free again when this is dropped.
#[derive(Debug)]
pub(crate) struct Place {
    pub(crate) number: u64,
    /// How many requests of it are being answered.
    pub(crate) asking: Arc<AtomicUsize>,
    room: Arc<Mutex<Taken>>,
}

/// A request that is being answered, until this is dropped.
#[derive(Debug)]
pub(crate) struct Asking(Arc<AtomicUsize>);

impl Asking {
    pub(crate) fn begin(of: &Arc<AtomicUsize>) -> Self {
        of.fetch_add(1, Relaxed);
        Self(Arc::clone(of))
    }
}

impl Drop for Asking {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Relaxed);
    }
}

impl Room {
    /// A place; none where everybody waits for an answer.
    pub(crate) fn place(&self) -> Option<Place> {
        let mut taken = locked(&self.0);
        if taken.by.len() >= CONNECTIONS {
            let idle =
                taken.by.iter().find(|(_, held)| held.asking.load(Relaxed) == 0 && held.task.is_some());
            let number = *idle?.0;
            if let Some(task) = taken.by.remove(&number).and_then(|held| held.task) {
                task.abort();
            }
        }
        let (number, asking) = (taken.next, Arc::default());
        taken.next += 1;
        taken.by.insert(number, Held { asking: Arc::clone(&asking), task: None });
        Some(Place { number, asking, room: Arc::clone(&self.0) })
    }

    /// Says who has taken a place.
    pub(crate) fn taken_by(&self, number: u64, task: AbortHandle) {
        if let Some(held) = locked(&self.0).by.get_mut(&number) {
            held.task = Some(task);
        }
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        locked(&self.room).by.remove(&self.number);
    }
}

fn locked(taken: &Mutex<Taken>) -> MutexGuard<'_, Taken> {
    taken.lock().unwrap_or_else(PoisonError::into_inner)
}
