//! Rows that are dear to come by: a block of them at a time, kept for the next that ask.
//!
//! All blocks together take so much memory as [`KEPT_BYTES`], however large the file, or as one block for every two threads where
//! a file cannot be read in smaller ones.

use hadar::cube::{Sample, Shape, beyond};
use hadar::error::Result;
use std::collections::VecDeque;
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

/// Memory of all blocks that are kept.
const KEPT_BYTES: usize = 1 << 27;

/// The blocks that were gathered last, the newest in front.
#[derive(Debug)]
pub(super) struct Blocks<S> {
    shape: Shape,
    /// Rows of a block.
    height: usize,
    most: usize,
    kept: Mutex<VecDeque<(usize, Arc<Vec<S>>)>>,
}

impl<S: Sample> Blocks<S> {
    /// Blocks of a multiple of so many rows.
    pub(super) fn new(shape: Shape, step: usize) -> Self {
        // Threads that share an image among them go through one part each.
        let most = (2 * rayon::current_num_threads()).clamp(4, 64);
        let rows = KEPT_BYTES / most / (shape.row_len() * size_of::<S>());
        let height = (rows / step.max(1)).max(1).saturating_mul(step).min(shape.rows());
        Self { shape, height, most, kept: Mutex::default() }
    }

    /// Puts rows into `samples`, out of blocks that `gather` makes where they are not there.
    pub(super) fn read(
        &self,
        rows: Range<usize>,
        samples: &mut [S],
        gather: impl Fn(&Range<usize>, &mut [S]) -> Result<()>,
    ) -> Result<()> {
        hadar::stop::check();
        let len = self.shape.row_len();
        for (row, out) in rows.zip(samples.chunks_exact_mut(len)) {
            let block = self.block(row / self.height, &gather)?;
            let place = row % self.height * len;
            out.copy_from_slice(&block[place..place + len]);
        }
        Ok(())
    }

    /// A block. It is gathered while others wait, so that there are never more than are kept.
    fn block(
        &self,
        number: usize,
        gather: impl Fn(&Range<usize>, &mut [S]) -> Result<()>,
    ) -> Result<Arc<Vec<S>>> {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(place) = kept.iter().position(|(own, _)| *own == number)
            && let Some(found) = kept.remove(place)
        {
            let block = found.1.clone();
            kept.push_front(found);
            return Ok(block);
        }
        kept.truncate(self.most - 1);
        let first = number * self.height;
        let rows = first..self.shape.rows().min(first + self.height);
        let mut samples = vec![S::zeroed(); rows.len() * self.shape.row_len()];
        gather(&rows, &mut samples)?;
        let block = Arc::new(samples);
        kept.push_front((number, block.clone()));
        Ok(block)
    }
}

/// Room for rows in a buffer.
pub(super) fn room<'a, S: Sample>(
    rows: &Range<usize>,
    shape: Shape,
    buffer: &'a mut Vec<S>,
) -> Result<&'a mut [S]> {
    if rows.start > rows.end || rows.end > shape.rows() {
        return Err(beyond(rows, shape));
    }
    let len = rows.len() * shape.row_len();
    // What is there already is only overwritten: cleared once, not with every read.
    if buffer.len() < len {
        buffer.resize(len, S::zeroed());
    }
    Ok(&mut buffer[..len])
}
