//! A few numbers, such as those of unknowns, for which no memory is fetched.
//!
//! Fetching and giving back memory takes longer than what is done with two or three numbers. More than a few are kept as usual.

use std::ops::{Deref, DerefMut, Index, IndexMut};

/// How many need no memory of their own: a square of four by four.
const ROOM: usize = 16;

/// Values, a few as a rule: numbers unless said otherwise.
#[derive(Debug, Clone)]
pub(crate) enum Few<T = f64> {
    Here([T; ROOM], usize),
    Elsewhere(Vec<T>),
}

impl Few {
    /// `len` zeros.
    pub(crate) fn zeros(len: usize) -> Self {
        Self::filled(0.0, len)
    }

    /// Σ aᵢbᵢ.
    pub(crate) fn dot(&self, other: &[f64]) -> f64 {
        self.iter().zip(other).map(|(a, b)| a * b).sum()
    }
}

impl<T: Copy + Default> Few<T> {
    /// So many of one value.
    pub(crate) fn filled(value: T, len: usize) -> Self {
        if len <= ROOM { Self::Here([value; ROOM], len) } else { Self::Elsewhere(vec![value; len]) }
    }

    /// One more.
    pub(crate) fn push(&mut self, value: T) {
        match self {
            Self::Here(values, len) if *len < ROOM => {
                values[*len] = value;
                *len += 1;
            }
            Self::Here(values, _) => {
                let mut all = values.to_vec();
                all.push(value);
                *self = Self::Elsewhere(all);
            }
            Self::Elsewhere(values) => values.push(value),
        }
    }
}

impl<T: Copy + Default> Default for Few<T> {
    fn default() -> Self {
        Self::filled(T::default(), 0)
    }
}

impl From<&[f64]> for Few {
    fn from(values: &[f64]) -> Self {
        let mut few = Self::zeros(values.len());
        few.copy_from_slice(values);
        few
    }
}

impl<T: Copy + Default> FromIterator<T> for Few<T> {
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Self {
        let mut few = Self::default();
        values.into_iter().for_each(|value| few.push(value));
        few
    }
}

impl<T> Deref for Few<T> {
    type Target = [T];

    #[inline]
    fn deref(&self) -> &[T] {
        match self {
            Self::Here(values, len) => &values[..*len],
            Self::Elsewhere(values) => values,
        }
    }
}

impl<T> DerefMut for Few<T> {
    #[inline]
    fn deref_mut(&mut self) -> &mut [T] {
        match self {
            Self::Here(values, len) => &mut values[..*len],
            Self::Elsewhere(values) => values,
        }
    }
}

/// Columns of as many numbers each.
#[derive(Debug, Clone, Default)]
pub(crate) struct FewColumns {
    height: usize,
    values: Few,
}

impl FewColumns {
    /// So many columns of zeros.
    pub(crate) fn zeros(height: usize, count: usize) -> Self {
        Self { height, values: Few::zeros(height * count) }
    }

    /// So many columns of what each row and column has.
    pub(crate) fn from_fn(height: usize, count: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let all = (0..count).flat_map(|column| (0..height).map(move |row| (row, column)));
        Self { height, values: all.map(|(row, column)| entry(row, column)).collect() }
    }

    /// Column by column.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &[f64]> {
        self.values.chunks_exact(self.height.max(1))
    }

    /// All numbers, column by column.
    pub(crate) fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }
}

impl Index<usize> for FewColumns {
    type Output = [f64];

    #[inline]
    fn index(&self, column: usize) -> &[f64] {
        &self.values[column * self.height..(column + 1) * self.height]
    }
}

impl IndexMut<usize> for FewColumns {
    #[inline]
    fn index_mut(&mut self, column: usize) -> &mut [f64] {
        &mut self.values[column * self.height..(column + 1) * self.height]
    }
}

/// By row and column.
impl Index<(usize, usize)> for FewColumns {
    type Output = f64;

    #[inline]
    fn index(&self, (row, column): (usize, usize)) -> &f64 {
        &self[column][row]
    }
}

impl IndexMut<(usize, usize)> for FewColumns {
    #[inline]
    fn index_mut(&mut self, (row, column): (usize, usize)) -> &mut f64 {
        &mut self[column][row]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_and_many_are_the_same_numbers() {
        for len in [0, 1, ROOM - 1, ROOM, ROOM + 1, 3 * ROOM] {
            let list: Vec<f64> = (0..len).map(|i| i as f64).collect();
            let mut few: Few = list.iter().copied().collect();
            assert_eq!(few.dot(&list), list.iter().map(|x| x * x).sum::<f64>());
            assert_eq!(few[..], list[..]);
            assert_eq!(Few::from(&list[..])[..], list[..]);
            few.push(-1.0);
            assert!(few.len() == len + 1 && few[len] == -1.0);
            assert!(Few::zeros(len).iter().all(|x| *x == 0.0) && Few::zeros(len).len() == len);
            let mut columns = FewColumns::zeros(3, len);
            (0..len).for_each(|k| columns[k].fill(k as f64));
            assert_eq!(columns.iter().map(|column| column[2]).collect::<Vec<_>>(), list);
            let same = FewColumns::from_fn(3, len, |_, column| column as f64);
            assert!((0..len).all(|k| columns[k] == same[k] && columns[(1, k)] == k as f64));
        }
    }
}
