//! Tables of a text that is read many times, as they were read where nothing is set in them.

use hadar::error::Result;
use std::any::{Any, TypeId};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// What a table is read as, by its key and type.
type Reading = (&'static str, TypeId);

/// Tables of a text as they were read where nothing is set in them.
#[derive(Debug, Default)]
pub(super) struct Kept(Mutex<HashMap<Reading, Arc<dyn Any + Send + Sync>>>);

impl Kept {
    /// What stands at a key: kept, or read.
    pub(super) fn or_read<T: Any + Clone + Send + Sync>(
        &self,
        key: &'static str,
        read: impl FnOnce() -> Result<T>,
    ) -> Result<T> {
        let reading = (key, TypeId::of::<T>());
        let kept = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let before = kept().get(&reading).cloned();
        if let Some(found) = before.as_deref().and_then(|found| found.downcast_ref::<T>()) {
            return Ok(found.clone());
        }
        let found = read()?;
        kept().insert(reading, Arc::new(found.clone()));
        Ok(found)
    }
}
