//! The bytes of an HDF5 file as its reader asks for them: of the one opened file, and not again and again.
//!
//! Lengths and addresses stand in the file, and a damaged one may name more than there is, or lead in a circle. No read begins that
//! would go beyond the end, and no step of the work reads more than some times the file: what is kept of each byte is bounded, so
//! that is, too.

use super::links::without_soft;
use crate::cube::raw::read_at;
use hdf5_pure::{Chunk, Dataset, FormatError, Layout, Source};
use std::cell::Cell;
use std::fs::File;
use std::path::PathBuf;

/// Most that a step of the work reads: so many times the file, and so many bytes beyond.
const AGAIN: u64 = 16;
const BEYOND: u64 = 1 << 24;

thread_local! {
    /// What this thread has read in this step.
    static READ: Cell<u64> = const { Cell::new(0) };
}

/// Begins a step of the work on this thread.
pub(super) fn step() {
    READ.set(0);
}

/// An opened file of `len` bytes.
#[derive(Debug)]
pub(super) struct Bounded {
    pub(super) file: File,
    pub(super) path: PathBuf,
    pub(super) len: u64,
}

impl Source for Bounded {
    fn len(&self) -> u64 {
        self.len
    }

    fn read_at(&self, offset: u64, bytes: &mut [u8]) -> Result<(), FormatError> {
        let read = READ.get().saturating_add(bytes.len() as u64);
        READ.set(read);
        if read > self.len.saturating_mul(AGAIN).saturating_add(BEYOND) {
            return Err(FormatError::Source("its parts lead to each other again and again".to_owned()));
        }
        let failed = |error: std::io::Error| FormatError::Source(error.to_string());
        read_at(&self.file, &self.path, bytes, offset).map_err(failed)
    }

    fn read_metadata_at(&self, offset: u64, len: usize) -> Result<Vec<u8>, FormatError> {
        let bytes = self.read_exact_at(offset, len)?;
        without_soft(bytes, len, |len| self.read_exact_at(offset, len))
    }
}

/// That every chunk of an array stands in a file of `len` bytes, which its reader would make room for first.
pub(super) fn check_chunks(dataset: &Dataset, len: u64) -> Result<(), String> {
    if !matches!(dataset.layout().map_err(|error| error.to_string())?, Layout::Chunked { .. }) {
        return Ok(());
    }
    let beyond = |chunk: &Chunk| chunk.address.checked_add(chunk.storage_size).is_none_or(|end| end > len);
    let chunks = dataset.chunks().map_err(|error| error.to_string())?;
    match chunks.iter().find(|chunk| beyond(chunk)) {
        None if chunks.is_empty() => Err("the array was never written".to_owned()),
        None => Ok(()),
        Some(Chunk { address, storage_size, .. }) => Err(format!(
            "a chunk of {storage_size} bytes is said to begin at byte {address}, and the file has {len}"
        )),
    }
}
