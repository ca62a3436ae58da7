//! The curves of a filter: transmittance T, reflectance R, absorptance E = 1 − T − R (S8).

use super::rows::{distinct, interpolated};
use crate::error::{Error, Result, check};
use crate::order;

/// By so much transmittance and reflectance may exceed 1: rounding of a table.
const ROUNDING: f64 = 1e-3;

/// Share of its peak above which a filter that ends with its rows is cut.
const CUT: f64 = 0.05;

/// Rings that a cone of light is cut into.
const RINGS: usize = 32;

/// The transmittance of a filter at ascending wavenumbers, straight lines between the rows, 0 outside; and its reflectance,
/// which is what is not transmitted where no other is given.
#[derive(Debug, Clone, PartialEq)]
pub struct FilterCurve {
    pub(super) name: String,
    pub(super) wavenumbers_cm1: Vec<f64>,
    transmittances: Vec<f64>,
    /// Empty where the filter absorbs nothing.
    reflectances: Vec<f64>,
}

impl FilterCurve {
    /// A filter from rows (wavenumber in cm⁻¹, transmittance) in any order.
    ///
    /// # Errors
    /// Fewer than two rows, a wavenumber that is not positive or comes twice, a transmittance outside
    /// [0, 1], or a filter that transmits nothing.
    pub fn new(name: impl Into<String>, mut rows: Vec<(f64, f64)>) -> Result<Self> {
        let name = name.into();
        for &(wavenumber, transmittance) in &rows {
            check::positive("wavenumber of a filter", wavenumber, "cm^-1")?;
            check::unit_interval(&format!("transmittance of filter `{name}`"), transmittance)?;
        }
        order::ascending(&mut rows, |a| a.0);
        distinct(rows.iter().map(|row| row.0), &format!("filter `{name}`"))?;
        if rows.len() < 2 || rows.iter().all(|row| row.1 == 0.0) {
            return Err(Error::malformed(
                format!("filter `{name}` transmits nothing"),
                "give at least two rows with a transmittance above 0",
            ));
        }
        let (wavenumbers_cm1, transmittances) = rows.into_iter().unzip();
        Ok(Self { name, wavenumbers_cm1, transmittances, reflectances: Vec::new() })
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The filter with its reflectance at rows (wavenumber in cm⁻¹, reflectance), those of its transmittance in any order.
    ///
    /// # Errors
    /// Rows at other wavenumbers, a reflectance outside [0, 1], or one that makes more than 1 with the transmittance.
    ///
    /// ```
    /// use hadar::spectrum::FilterCurve;
    /// let filter = FilterCurve::new("a", vec![(900.0, 0.6), (1000.0, 0.8)])?
    ///     .with_reflectance(vec![(900.0, 0.3), (1000.0, 0.1)])?;
    /// assert!((filter.reflectance(950.0) - 0.2).abs() < 1e-15);
    /// assert_eq!(filter.reflectance(2000.0), 1.0);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn with_reflectance(mut self, mut rows: Vec<(f64, f64)>) -> Result<Self> {
        order::ascending(&mut rows, |a| a.0);
        let quantity = format!("reflectance of filter `{}`", self.name);
        if !rows.iter().map(|row| &row.0).eq(&self.wavenumbers_cm1) {
            let instead = "give both in the same rows";
            return Err(Error::malformed(
                format!("{quantity} at other wavenumbers than its transmittance"),
                instead,
            ));
        }
        for ((_, reflectance), transmittance) in rows.iter().zip(&self.transmittances) {
            check::unit_interval(&quantity, *reflectance)?;
            if reflectance + transmittance > 1.0 + ROUNDING {
                let most = format!("at most 1 with the transmittance of {transmittance}");
                return Err(Error::out_of_range(quantity, *reflectance, "", most));
            }
        }
        self.reflectances = rows.into_iter().map(|row| row.1).collect();
        Ok(self)
    }

    /// Reflectance at a wavenumber in cm⁻¹: 1 where the filter has no rows.
    #[must_use]
    pub fn reflectance(&self, wavenumber_cm1: f64) -> f64 {
        let (low, high) = self.range_cm1();
        if self.reflectances.is_empty() || !(low..=high).contains(&wavenumber_cm1) {
            return 1.0 - self.transmittance(wavenumber_cm1);
        }
        interpolated(&self.wavenumbers_cm1, &self.reflectances, wavenumber_cm1)
    }

    /// The largest transmittance at an end of its rows that lies within a range, cm⁻¹, where that is more than a twentieth of its peak: beyond, where
    /// nothing is known, none is taken.
    #[must_use]
    pub fn cut_within(&self, [low_cm1, high_cm1]: [f64; 2]) -> Option<f64> {
        let peak = self.transmittances.iter().copied().fold(0.0, f64::max);
        let (from_cm1, to_cm1) = self.range_cm1();
        let ends = [
            (from_cm1 > low_cm1).then(|| self.transmittances.first()),
            (to_cm1 < high_cm1).then(|| self.transmittances.last()),
        ];
        let most = ends.into_iter().flatten().flatten().copied().fold(0.0, f64::max);
        (most > CUT * peak).then_some(most)
    }

    /// The filter in a beam that fills a cone of half angle θ, sin θ = `sine`: an interference filter of effective index n passes at the angle a
    /// what it passes at right angles at wavenumbers lower by √(1 − sin²a/n²), and every ring of the cone counts by its solid angle times
    /// cos a (H. A. Macleod, *Thin-Film Optical Filters*, 'Effect of tilting'). Its reflectance is then what it does not transmit.
    ///
    /// # Errors
    /// An index below 1 or no number, a sine outside [0, 1].
    ///
    /// ```
    /// use hadar::spectrum::FilterCurve;
    /// let filter = FilterCurve::new("a", vec![(990.0, 0.0), (1000.0, 1.0), (1010.0, 0.0)])?;
    /// let tilted = filter.in_cone(2.0, 0.5)?;
    /// // At the rim 1000/√(1 − 1/16) = 1032.8 passes what 1000 does at right angles.
    /// assert!(tilted.transmittance(1032.0) > 0.0 && filter.transmittance(1032.0) == 0.0);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn in_cone(&self, index: f64, sine: f64) -> Result<Self> {
        if !(index >= 1.0 && index.is_finite()) {
            return Err(Error::out_of_range(
                "effective index of a filter",
                index,
                "",
                "a number of at least 1",
            ));
        }
        check::unit_interval("sine of the angle of a beam", sine)?;
        let factor = |share: f64| (1.0 - share * (sine / index).powi(2)).sqrt();
        if sine == 0.0 || factor(1.0) == 0.0 {
            return Ok(self.clone());
        }
        // Rings of equal étendue.
        let shares: Vec<f64> = (0..RINGS).map(|i| (i as f64 + 0.5) / RINGS as f64).collect();
        let mut rows: Vec<f64> = self.wavenumbers_cm1.clone();
        for share in shares.iter().copied().chain([1.0]) {
            rows.extend(self.wavenumbers_cm1.iter().map(|nu| nu / factor(share)));
        }
        rows.sort_by(f64::total_cmp);
        rows.dedup();
        let at = |nu: &f64| {
            let rings = shares.iter().map(|share| self.transmittance(nu * factor(*share)));
            (*nu, rings.sum::<f64>() / RINGS as f64)
        };
        Self::new(self.name.clone(), rows.iter().map(at).collect())
    }

    /// Transmittance at a wavenumber in cm⁻¹.
    #[must_use]
    pub fn transmittance(&self, wavenumber_cm1: f64) -> f64 {
        let (low, high) = self.range_cm1();
        if !(low..=high).contains(&wavenumber_cm1) {
            return 0.0;
        }
        interpolated(&self.wavenumbers_cm1, &self.transmittances, wavenumber_cm1)
    }

    /// Lowest and highest wavenumber at which it transmits half of its most, cm⁻¹, on the straight lines between its rows.
    #[must_use]
    pub fn half_power_cm1(&self) -> [f64; 2] {
        let half = 0.5 * self.transmittances.iter().copied().fold(0.0, f64::max);
        let crossing = |a: usize, b: usize| {
            let (from, to) = (self.transmittances[a], self.transmittances[b]);
            let share = if to > from { (half - from) / (to - from) } else { 1.0 };
            share.mul_add(self.wavenumbers_cm1[b] - self.wavenumbers_cm1[a], self.wavenumbers_cm1[a])
        };
        let above = |w: &usize| self.transmittances[*w] >= half;
        let count = self.wavenumbers_cm1.len();
        let first = (0..count).find(above).unwrap_or(0);
        let last = (0..count).rev().find(above).unwrap_or(0);
        let low = if first > 0 { crossing(first - 1, first) } else { self.wavenumbers_cm1[0] };
        let high = if last + 1 < count { crossing(last + 1, last) } else { self.wavenumbers_cm1[last] };
        [low, high]
    }

    /// Lowest and highest wavenumber of its rows, cm⁻¹.
    #[must_use]
    pub fn range_cm1(&self) -> (f64, f64) {
        (self.wavenumbers_cm1[0], self.wavenumbers_cm1[self.wavenumbers_cm1.len() - 1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// However many rows are left out at the ends of a table, what is cut is said; within the range of the detector alone.
    #[test]
    fn a_filter_without_its_last_rows_is_cut() {
        let rows: Vec<(f64, f64)> = (0..=40)
            .map(|i| (800.0 + 10.0 * f64::from(i), 0.9 * (1.0 - (f64::from(i) / 20.0 - 1.0).powi(2))))
            .collect();
        let of = |from: usize, to: usize| FilterCurve::new("f", rows[from..to].to_vec()).unwrap();
        assert_eq!(of(0, 41).cut_within([700.0, 1300.0]), None);
        for from in 1..20 {
            let cut = of(from, 41).cut_within([700.0, 1300.0]);
            // 1 − (1 − i/20)² is above a twentieth from i = 1 on.
            assert_eq!(cut, Some(rows[from].1), "{from}");
            assert_eq!(of(0, 41 - from).cut_within([700.0, 1300.0]), Some(rows[40 - from].1), "{from}");
            assert_eq!(of(from, 41).cut_within([rows[from].0, 1300.0]), None, "the detector sees no more");
        }
    }

    #[test]
    fn half_of_the_most_is_where_the_lines_cross_it() {
        let rows = vec![(900.0, 0.0), (910.0, 0.8), (990.0, 0.8), (1010.0, 0.0)];
        assert_eq!(FilterCurve::new("a", rows).unwrap().half_power_cm1(), [905.0, 1000.0]);
        let whole = FilterCurve::new("b", vec![(900.0, 1.0), (1000.0, 1.0)]).unwrap();
        assert_eq!(whole.half_power_cm1(), [900.0, 1000.0]);
    }

    /// A step at ν₀ seen in a cone: T(ν) is the share u of the cone with ν√(1 − u sin²θ/n²) ≤ ν₀, u = (1 − (ν₀/ν)²) n²/sin²θ from the rim.
    #[test]
    fn an_edge_in_a_cone_is_as_its_closed_form() {
        let (edge, index, sine) = (1000.0, 2.2, 0.45);
        let rows = vec![(800.0, 1.0), (edge, 1.0), (edge + 1e-6, 0.0), (1200.0, 0.0)];
        let filter = FilterCurve::new("edge", rows).unwrap();
        let cone = filter.in_cone(index, sine).unwrap();
        for nu in [999.0, 1002.0, 1008.0, 1015.0, 1020.0, 1022.0] {
            let beyond = (1.0 - (edge / nu) * (edge / nu)) * (index / sine).powi(2);
            let exact = (1.0 - beyond).clamp(0.0, 1.0);
            assert!((cone.transmittance(nu) - exact).abs() < 0.6 / RINGS as f64, "{nu}");
        }
        // ∫T dν beyond the edge, whose shift is of 1/n².
        let rim = edge / (1.0 - (sine / index).powi(2)).sqrt();
        let exact =
            (rim - edge) - (index / sine).powi(2) * ((rim - edge) - edge * edge * (1.0 / edge - 1.0 / rim));
        let step = 0.01;
        let middle = |i: i32| edge + (f64::from(i) + 0.5) * step;
        let found: f64 = (0..4000).map(|i| step * cone.transmittance(middle(i))).sum();
        assert!((found / exact - 1.0).abs() < 5e-3, "{found} {exact}");
        assert_eq!(filter.in_cone(index, 0.0).unwrap(), filter);
        assert!(filter.in_cone(0.9, 0.1).is_err() && filter.in_cone(f64::NAN, 0.1).is_err());
        assert!(filter.in_cone(2.0, 1.1).is_err());
    }
}
