//! Quantiles of values that are too many to be kept: counted in steps of their size.
//!
//! An octave has 2¹⁴ steps: the middle of a step is within 2⁻¹⁵ of every value in it ([`QUANTILE_ERROR`]). 0, infinity and values
//! that are all the same are exact. What is counted does not depend on the order of counting.

/// Relative error of a quantile, at most.
pub(super) const QUANTILE_ERROR: f64 = 1.0 / (STEPS as f64 * 2.0);

/// Steps of an octave, and the bits of a double below them.
const STEPS: usize = 1 << 14;
const BELOW: u32 = 52 - STEPS.trailing_zeros();

/// Octaves of positive doubles, with 0 in the first and infinity in the last.
const OCTAVES: usize = 1 << 11;

/// Values within a step.
#[derive(Debug, Clone, Copy)]
struct Step {
    count: u64,
    /// The first place of any.
    first: u64,
}

const EMPTY: Step = Step { count: 0, first: u64::MAX };

/// Values from 0 to infinity, each with a place.
#[derive(Debug)]
pub(super) struct Distribution {
    octaves: Vec<Vec<Step>>,
    least: f64,
    most: f64,
}

impl Default for Distribution {
    fn default() -> Self {
        Self { octaves: vec![Vec::new(); OCTAVES], least: f64::INFINITY, most: 0.0 }
    }
}

impl Distribution {
    /// Counts values, each with its place; those below 0 and NaN are left out.
    pub(super) fn count(&mut self, values: impl Iterator<Item = (u64, f64)>) {
        for (place, value) in values {
            // Also −0.
            let value = value + 0.0;
            if value.is_nan() || value < 0.0 {
                continue;
            }
            let step = (value.to_bits() >> BELOW) as usize;
            let Some(octave) = self.octaves.get_mut(step / STEPS) else { continue };
            if octave.is_empty() {
                octave.resize(STEPS, EMPTY);
            }
            if let Some(step) = octave.get_mut(step % STEPS) {
                step.count += 1;
                step.first = step.first.min(place);
            }
            self.least = self.least.min(value);
            self.most = self.most.max(value);
        }
    }

    /// How many there are.
    pub(super) fn len(&self) -> u64 {
        self.octaves.iter().flatten().map(|step| step.count).sum()
    }

    /// The value that as many as `rank` do not exceed, and the first place of one within its step.
    pub(super) fn nth(&self, rank: u64) -> Option<(f64, u64)> {
        let steps = self.octaves.iter().enumerate().flat_map(|(octave, steps)| {
            steps.iter().enumerate().map(move |(step, found)| (octave * STEPS + step, found))
        });
        let mut before = 0;
        let (step, found) = steps.into_iter().find(|(_, found)| {
            before += found.count;
            before > rank
        })?;
        let edge = |step: usize| f64::from_bits((step as u64) << BELOW);
        let low = edge(step);
        let value = if low == 0.0 || low.is_infinite() { low } else { 0.5 * (low + edge(step + 1)) };
        Some((value.clamp(self.least, self.most), found.first))
    }

    /// The value that a share `part` does not exceed, the nearest rank as [`super::quantile`] has it; NaN without values.
    pub(super) fn quantile(&self, part: f64) -> f64 {
        let last = self.len().saturating_sub(1);
        self.nth(((part * last as f64).round() as u64).min(last)).map_or(f64::NAN, |(value, _)| value)
    }

    /// The value that a share `part` exceeds or equals: the quantile of what falls as the values rise.
    pub(super) fn quantile_from_above(&self, part: f64) -> f64 {
        let last = self.len().saturating_sub(1);
        let rank = ((part * last as f64).round() as u64).min(last);
        self.nth(last - rank).map_or(f64::NAN, |(value, _)| value)
    }
}

#[cfg(test)]
mod tests {
    use super::super::quantile;
    use super::*;
    use proptest::prelude::*;

    fn of(values: &[f64]) -> Distribution {
        let mut found = Distribution::default();
        found.count(values.iter().enumerate().map(|(i, value)| (i as u64, *value)));
        found
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        #[test]
        fn quantiles_are_those_of_the_sorted_values(
            logs in proptest::collection::vec(-20.0..20.0_f64, 1..300), part in 0.0..=1.0_f64,
        ) {
            let values: Vec<f64> = logs.iter().map(|log| log.exp()).collect();
            let found = of(&values);
            let (own, exact) = (found.quantile(part), quantile(&values, part));
            prop_assert!((own - exact).abs() <= QUANTILE_ERROR * exact, "{} {}", own, exact);
            let turned: Vec<f64> = values.iter().map(|value| 1.0 / value).collect();
            let (own, exact) = (1.0 / found.quantile_from_above(part), quantile(&turned, part));
            prop_assert!((own - exact).abs() <= 1.0001 * QUANTILE_ERROR * exact, "{} {}", own, exact);
            // The place is that of a value within the step.
            let (own, place) = found.nth(logs.len() as u64 / 2).unwrap();
            prop_assert!((values[place as usize] / own - 1.0).abs() <= 2.0 * QUANTILE_ERROR);
        }
    }

    #[test]
    fn ends_are_exact() {
        let found = of(&[0.0, 0.0, f64::INFINITY, 3.0, f64::NAN, -0.0]);
        assert_eq!((found.len(), found.quantile(0.0), found.quantile(1.0)), (5, 0.0, f64::INFINITY));
        assert_eq!(of(&[0.1; 7]).quantile(0.5), 0.1);
        assert!(of(&[]).quantile(0.5).is_nan());
        let smallest = f64::from_bits(1);
        assert_eq!(of(&[smallest, 1.0]).quantile(0.0), smallest);
        assert_eq!(of(&[f64::MAX, 1.0]).quantile(1.0), f64::MAX);
    }
}
