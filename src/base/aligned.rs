//! Slices of doubles that start at a cache line, their memory used again.
//!
//! A loop over spectra is short: fetching and clearing memory for each of them can take as long as what is done with it. What is given
//! back stays with its thread, up to 32 slices of each of eight sizes, for the next one of the same size.

use crate::simd::LANES;
use std::cell::RefCell;

/// How many of one size a thread keeps, of how many sizes, and doubles of one at most.
const KEPT: usize = 32;
const SIZES: usize = 8;
const LONGEST: usize = 1 << 14;

/// Slices of one size.
struct Spare {
    size: usize,
    slices: Vec<Vec<f64>>,
}

thread_local! {
    static SPARE: RefCell<Vec<Spare>> = const { RefCell::new(Vec::new()) };
}

/// Memory for so many doubles, whatever they are: what was given back before, if any fits.
fn taken(size: usize) -> Vec<f64> {
    let spare = |spare: &RefCell<Vec<Spare>>| {
        spare.borrow_mut().iter_mut().find(|spare| spare.size == size)?.slices.pop()
    };
    SPARE.try_with(spare).ok().flatten().unwrap_or_else(|| vec![0.0; size])
}

/// Room for `len` doubles such that arrays laid out one after the other do not start at nearly the same
/// place in a page of 512 doubles: a processor takes a load for one of a store not yet done if their places in the
/// page agree, and waits.
pub fn spaced(len: usize) -> usize {
    const PAGE: usize = 512;
    const APART: usize = 64;
    let whole = len.next_multiple_of(LANES);
    match whole % PAGE {
        _ if len <= APART => whole,
        near if near < APART => whole + APART - near,
        near if near > PAGE - APART => whole + PAGE + APART - near,
        _ => whole,
    }
}

/// A slice of doubles that starts at a cache line, so that no full-width access straddles two lines.
///
/// Only speed depends on the alignment, never a result.
#[derive(Debug, Default)]
pub struct Aligned {
    storage: Vec<f64>,
    start: usize,
    len: usize,
}

impl Aligned {
    /// `len` zeros.
    pub fn zeros(len: usize) -> Self {
        let mut zeros = Self::unset(len);
        zeros.fill(0.0);
        zeros
    }

    /// `len` doubles to be written to: what they are before is not said.
    pub fn unset(len: usize) -> Self {
        #[cfg_attr(not(test), expect(unused_mut, reason = "tests write what nobody may read"))]
        let mut storage = taken(spaced(len) + LANES - 1);
        #[cfg(test)]
        storage.fill(f64::NAN);
        let start = storage.as_ptr().align_offset(LANES * size_of::<f64>()).min(LANES - 1);
        Self { storage, start, len }
    }

    /// These values, and zeros up to `len`.
    pub fn filled(len: usize, values: impl Iterator<Item = f64>) -> Self {
        let mut filled = Self::unset(len);
        let mut count = 0;
        for (to, value) in filled.iter_mut().zip(values) {
            *to = value;
            count += 1;
        }
        filled[count..].fill(0.0);
        filled
    }

    /// The same of a slice.
    pub fn padded(len: usize, values: &[f64]) -> Self {
        let mut padded = Self::unset(len);
        padded[..values.len()].copy_from_slice(values);
        padded[values.len()..].fill(0.0);
        padded
    }

    /// Changes the length; what the values are afterwards is not said.
    pub fn set_len(&mut self, len: usize) {
        if self.start + len <= self.storage.len() {
            self.len = len;
        } else {
            *self = Self::unset(len);
        }
    }
}

impl From<&[f64]> for Aligned {
    fn from(values: &[f64]) -> Self {
        let mut copy = Self::unset(values.len());
        copy.copy_from_slice(values);
        copy
    }
}

impl Clone for Aligned {
    fn clone(&self) -> Self {
        Self::from(&**self)
    }
}

impl std::ops::Deref for Aligned {
    type Target = [f64];

    #[inline]
    fn deref(&self) -> &[f64] {
        &self.storage[self.start..self.start + self.len]
    }
}

impl std::ops::DerefMut for Aligned {
    #[inline]
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.storage[self.start..self.start + self.len]
    }
}

impl<'a> IntoIterator for &'a Aligned {
    type Item = &'a f64;
    type IntoIter = std::slice::Iter<'a, f64>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl Drop for Aligned {
    fn drop(&mut self) {
        let storage = std::mem::take(&mut self.storage);
        if storage.is_empty() || storage.len() > LONGEST {
            return;
        }
        // Where the thread ends there is nobody to keep it for.
        let _ = SPARE.try_with(|spare| {
            let mut spare = spare.borrow_mut();
            match spare.iter_mut().find(|spare| spare.size == storage.len()) {
                Some(own) if own.slices.len() < KEPT => own.slices.push(storage),
                Some(_) => {}
                None => {
                    if spare.len() == SIZES {
                        spare.remove(0);
                    }
                    spare.push(Spare { size: storage.len(), slices: vec![storage] });
                }
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_are_zeros_whatever_was_there_before() {
        for round in 0..3 {
            for len in [0, 1, 7, 8, 100, 536, 4096] {
                let mut some: Vec<Aligned> = (0..5).map(|_| Aligned::zeros(len)).collect();
                for one in &mut some {
                    assert!(one.len() == len && one.iter().all(|x| *x == 0.0), "{round} {len}");
                    assert_eq!(one.as_ptr().align_offset(64), 0);
                    one.fill(f64::NAN);
                }
                let few = Aligned::filled(len, (0..len / 2).map(|i| i as f64));
                let is_right = |(i, x): (usize, &f64)| *x == if i < len / 2 { i as f64 } else { 0.0 };
                assert!(few.iter().enumerate().all(is_right), "{len}");
            }
        }
    }

    #[test]
    fn a_thread_keeps_no_more_than_it_may() {
        drop((1..3 * SIZES).map(|size| Aligned::zeros(1000 * size)).collect::<Vec<_>>());
        drop((0..3 * KEPT).map(|_| Aligned::zeros(100)).collect::<Vec<_>>());
        drop(Aligned::zeros(2 * LONGEST));
        SPARE.with(|spare| {
            let spare = spare.borrow();
            let own = spare.iter().find(|spare| spare.size == spaced(100) + LANES - 1);
            assert_eq!(own.map(|own| own.slices.len()), Some(KEPT));
            assert!(spare.len() <= SIZES && spare.iter().all(|one| one.size <= LONGEST));
        });
    }
}
