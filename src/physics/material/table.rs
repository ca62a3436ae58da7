//! Rows of a spectrum and linear interpolation between them.
//!
//! Between rows i and i+1 every column is linear in wavenumber ν (cm⁻¹),
//! y(ν) = yᵢ + (yᵢ₊₁ − yᵢ)(ν − νᵢ)/(νᵢ₊₁ − νᵢ); not over a gap, where rows at even steps were left out. Two wavenumbers within 1e-12 of each other
//! (relative) are the same one, because 10⁴/λ seldom hits a round wavenumber exactly; at a row the
//! row's own value is returned. A table does not know what lies outside its rows.

use crate::error::{Error, Result, check};
use crate::order;
use crate::spectrum::{Gaps, same};

/// Rows in ascending wavenumber, each with `N` values.
#[derive(Debug, Clone, PartialEq)]
pub struct Table<const N: usize> {
    wavenumbers_cm1: Vec<f64>,
    values: Vec<[f64; N]>,
    gaps: Gaps,
}

/// What is wrong with a list of wavenumbers; rows are counted from 0 in the order given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fault {
    /// Fewer than two rows.
    TooFew,
    /// The same wavenumber in two rows, the earlier one first.
    Duplicate(usize, usize),
}

/// Order in which rows must be read to ascend in wavenumber.
///
/// # Errors
/// A [`Fault`] if there are fewer than two rows or two are at the same wavenumber.
pub fn ascending(wavenumbers_cm1: &[f64]) -> std::result::Result<Vec<usize>, Fault> {
    if wavenumbers_cm1.len() < 2 {
        return Err(Fault::TooFew);
    }
    let at = |row: usize| wavenumbers_cm1.get(row).copied().unwrap_or(f64::NAN);
    let mut order: Vec<usize> = (0..wavenumbers_cm1.len()).collect();
    order::ascending(&mut order, |row| at(*row));
    for pair in order.windows(2) {
        if let [a, b] = *pair
            && same(at(a), at(b))
        {
            return Err(Fault::Duplicate(a.min(b), a.max(b)));
        }
    }
    Ok(order)
}

/// The two rows that a wavenumber lies between, and how far it is from the first to the second.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Bracket {
    low: usize,
    high: usize,
    fraction: f64,
}

impl<const N: usize> Table<N> {
    /// Sorts rows of (wavenumber in cm⁻¹, values).
    ///
    /// # Errors
    /// Fewer than two rows, a wavenumber that is not above 0, or one that is there twice.
    pub fn new(rows: &[(f64, [f64; N])]) -> Result<Self> {
        let given: Vec<f64> = rows.iter().map(|(wavenumber, _)| *wavenumber).collect();
        for &wavenumber in &given {
            check::positive("wavenumber", wavenumber, "cm^-1")?;
        }
        let order = ascending(&given).map_err(|fault| match fault {
            Fault::TooFew => {
                Error::malformed(format!("{} rows", given.len()), "a spectrum needs at least 2 rows")
            }
            Fault::Duplicate(_, second) => Error::malformed(
                format!(
                    "the wavenumber {} cm^-1 is there twice",
                    given.get(second).copied().unwrap_or(f64::NAN)
                ),
                "keep one row for each wavenumber",
            ),
        })?;
        let (wavenumbers_cm1, values): (Vec<f64>, _) =
            order.into_iter().filter_map(|row| rows.get(row)).copied().unzip();
        Ok(Self { gaps: Gaps::of(&wavenumbers_cm1), wavenumbers_cm1, values })
    }

    /// Wavenumbers of the rows, ascending, cm⁻¹.
    pub(super) fn wavenumbers_cm1(&self) -> &[f64] {
        &self.wavenumbers_cm1
    }

    /// First and last wavenumber, cm⁻¹.
    pub fn range_cm1(&self) -> Option<(f64, f64)> {
        Some((*self.wavenumbers_cm1.first()?, *self.wavenumbers_cm1.last()?))
    }

    /// Values of all rows, in ascending wavenumber.
    pub fn rows(&self) -> impl Iterator<Item = (f64, [f64; N])> + '_ {
        self.wavenumbers_cm1.iter().copied().zip(self.values.iter().copied())
    }

    /// The rows that the value at a wavenumber is made of: one twice at a row, else its neighbours.
    /// `None` outside the table.
    pub(super) fn used_rows(&self, wavenumber_cm1: f64) -> Option<[(f64, [f64; N]); 2]> {
        let Bracket { low, high, .. } = self.bracket(wavenumber_cm1)?;
        let row = |i: usize| Some((*self.wavenumbers_cm1.get(i)?, *self.values.get(i)?));
        Some([row(low)?, row(high)?])
    }

    /// Values at a wavenumber; `None` outside the table.
    pub(super) fn at(&self, wavenumber_cm1: f64) -> Option<[f64; N]> {
        let Bracket { low, high, fraction } = self.bracket(wavenumber_cm1)?;
        let (a, b) = (self.values.get(low)?, self.values.get(high)?);
        let mut value = *a;
        for (y, to) in value.iter_mut().zip(b) {
            *y += (to - *y) * fraction;
        }
        Some(value)
    }

    /// Refuses a wavenumber in a gap of the rows.
    ///
    /// # Errors
    /// As [`Gaps::check`].
    pub(super) fn check_gap(&self, wavenumber_cm1: f64) -> Result<()> {
        self.gaps.check(wavenumber_cm1)
    }

    fn bracket(&self, wavenumber_cm1: f64) -> Option<Bracket> {
        let rows = &self.wavenumbers_cm1;
        let next = rows.partition_point(|&row| row < wavenumber_cm1);
        for row in [Some(next), next.checked_sub(1)].into_iter().flatten() {
            if rows.get(row).is_some_and(|&x| same(x, wavenumber_cm1)) {
                return Some(Bracket { low: row, high: row, fraction: 0.0 });
            }
        }
        let low = next.checked_sub(1)?;
        let (a, b) = (*rows.get(low)?, *rows.get(next)?);
        Some(Bracket { low, high: next, fraction: (wavenumber_cm1 - a) / (b - a) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_in_any_order_are_interpolated_and_hit_exactly() {
        let table = Table::new(&[(1e4 / 12.5, [0.3]), (1e4 / 7.0, [0.9]), (1e4 / 10.0, [0.1])]).unwrap();
        assert_eq!(table.range_cm1(), Some((800.0, 1e4 / 7.0)));
        assert_eq!(table.at(800.0), Some([0.3]));
        assert_eq!(table.at(1e4 / 7.0 * (1.0 + 5e-13)), Some([0.9]));
        let middle = table.at(900.0).unwrap()[0];
        assert!((middle - 0.2).abs() < 1e-15, "half-way between 0.3 and 0.1: {middle}");
        assert!(table.check_gap(900.0).is_ok());
        assert_eq!(table.at(799.0), None);
        assert_eq!(table.at(1429.0), None);
    }

    #[test]
    fn bad_rows_are_refused() {
        assert!(Table::new(&[(800.0, [0.3])]).unwrap_err().to_string().contains("at least 2 rows"));
        let twice = Table::new(&[(800.0, [0.3]), (900.0, [0.2]), (800.0, [0.3])]).unwrap_err();
        assert!(twice.to_string().contains("800 cm^-1 is there twice"), "{twice}");
        assert!(Table::new(&[(f64::NAN, [0.3]), (900.0, [0.2])]).is_err());
    }

    #[test]
    fn rows_that_were_left_out_of_even_ones_are_a_gap_and_steps_by_hand_are_none() {
        let table = |rows: &mut dyn Iterator<Item = f64>| {
            Table::new(&rows.map(|nu| (nu, [0.5])).collect::<Vec<_>>()).unwrap()
        };
        // Even in wavelength, so that steps in wavenumber grow fourfold.
        let nu = |i: u32| 1e4 / (7.0 + 0.05 * f64::from(i));
        let even = table(&mut (0..140).map(nu));
        let cut = table(&mut (0..140).filter(|i| !(40..60).contains(i)).map(nu));
        for i in 0..1390 {
            let at = 1e4 / (7.0 + 0.005 * f64::from(i));
            let is_gap = at < nu(39) * (1.0 - 1e-9) && at > nu(60) * (1.0 + 1e-9);
            assert_eq!((even.check_gap(at).is_ok(), cut.check_gap(at).is_err()), (true, is_gap), "{at}");
        }
        let refusal = cut.check_gap(nu(50)).unwrap_err().to_string();
        assert!(refusal.starts_with("no rows between 1000.00 and 1117.32 cm^-1"), "{refusal}");
        // Boxes, and a few rows.
        let boxes = table(&mut (0..20).map(|i| 700.0 + 50.0 * f64::from(i / 2) + f64::from(i % 2)));
        let few = table(&mut [700.0, 701.0, 702.0, 1300.0, 1301.0].into_iter());
        assert!((0..600).all(|i| boxes.check_gap(701.0 + 0.5 * f64::from(i)).is_ok()));
        // Three even steps are the fewest that say so: 8, 8.1, 8.2, 13.9 and 14 um made d = 29 of 0.4.
        let fewer = table(&mut [700.0, 701.0, 1300.0, 1301.0].into_iter());
        assert!(few.check_gap(1000.0).is_err() && fewer.check_gap(1000.0).is_ok());
        // A last row far behind the others has none beside it.
        let last = table(&mut [700.0, 701.0, 702.0, 703.0, 1300.0].into_iter());
        assert!(last.check_gap(1000.0).is_ok());
    }
}
