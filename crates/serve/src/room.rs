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

#[cfg(test)]
mod tests {
    use super::*;

    /// Clients that keep their connections keep nobody out, and nobody is cut off who waits for an answer.
    #[test]
    fn the_oldest_that_asks_nothing_makes_room() {
        let runtime = tokio::runtime::Builder::new_current_thread().build().unwrap();
        runtime.block_on(async {
            let room = Room::default();
            let enter = || {
                let place = room.place()?;
                let (number, asking) = (place.number, Arc::clone(&place.asking));
                let task = tokio::spawn(async move {
                    let _place = place;
                    std::future::pending::<()>().await;
                });
                room.taken_by(number, task.abort_handle());
                Some((task, asking))
            };
            let mut first: Vec<_> = (0..CONNECTIONS).map(|_| enter().unwrap()).collect();
            let asking: Vec<Asking> =
                first.iter().step_by(2).map(|(_, asking)| Asking::begin(asking)).collect();
            let (oldest_idle, _) = first.remove(1);
            let new = enter().unwrap();
            assert!(oldest_idle.await.unwrap_err().is_cancelled());
            assert_eq!(locked(&room.0).by.len(), CONNECTIONS);
            // Where everybody waits for an answer there is no place.
            let more: Vec<Asking> =
                first.iter().skip(1).chain([&new]).map(|(_, asking)| Asking::begin(asking)).collect();
            assert!(enter().is_none());
            drop((asking, more));
            assert!(enter().is_some());
        });
    }
}
