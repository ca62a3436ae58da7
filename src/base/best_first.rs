//! Best-first branch and bound: the boxes that are still to be divided, the lowest bound first.
//!
//! Each box has a bound b that no value of the function within it is below, and a part's is no less than that of the whole.
//! The box of least b is divided first, until that b is enough, a number of boxes has been looked at, or none is left. What is
//! then proved is the least b of all that wait and of all that were left aside undivided.
//!
//! Source: Lawler and Wood, Oper. Res. 14, 699 (1966), doi:10.1287/opre.14.4.699.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// The boxes of a search.
pub(crate) struct BestFirst<T> {
    waiting: BinaryHeap<Waiting<T>>,
    aside: f64,
    looked_at: u64,
    most: u64,
}

struct Waiting<T> {
    bound: f64,
    age: u64,
    item: T,
}

impl<T> BestFirst<T> {
    /// Nothing yet; the search looks at `most` boxes at the most.
    pub(crate) fn new(most: u64) -> Self {
        Self { waiting: BinaryHeap::new(), aside: f64::INFINITY, looked_at: 0, most }
    }

    /// Queues a box; a bound that is no number says nothing. Of equal bounds the least age comes first; of equal ages any, by the order of all calls alone.
    pub(crate) fn push(&mut self, bound: f64, age: u64, item: T) {
        self.waiting.push(Waiting { bound: known(bound), age, item });
    }

    /// Leaves a box undivided for good.
    pub(crate) fn leave(&mut self, bound: f64) {
        self.aside = self.aside.min(known(bound));
    }

    /// Counts one box more as looked at; how many that makes.
    pub(crate) fn look(&mut self) -> u64 {
        crate::stop::check();
        self.looked_at += 1;
        self.looked_at
    }

    /// How many boxes were looked at.
    pub(crate) fn looked_at(&self) -> u64 {
        self.looked_at
    }

    /// The box of least bound, unless that is `enough` or the search is over.
    pub(crate) fn take(&mut self, enough: impl FnOnce(f64) -> bool) -> Option<(f64, T)> {
        crate::stop::check();
        let over = self.lowest().is_none_or(|(bound, _)| enough(bound));
        if over { None } else { self.waiting.pop().map(|Waiting { bound, item, .. }| (bound, item)) }
    }

    /// The same, left where it is; none once as many were looked at as may be.
    pub(crate) fn lowest(&self) -> Option<(f64, &T)> {
        let lowest = self.waiting.peek().filter(|_| self.looked_at < self.most);
        lowest.map(|Waiting { bound, item, .. }| (*bound, item))
    }

    /// What is proved: no value is below it.
    pub(crate) fn bound(&self) -> f64 {
        self.waiting.peek().map_or(f64::INFINITY, |lowest| lowest.bound).min(self.aside)
    }
}

fn known(bound: f64) -> f64 {
    if bound.is_nan() { f64::NEG_INFINITY } else { bound }
}

impl<T> Ord for Waiting<T> {
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound.total_cmp(&self.bound).then(other.age.cmp(&self.age))
    }
}

impl<T> PartialOrd for Waiting<T> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<T> PartialEq for Waiting<T> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl<T> Eq for Waiting<T> {}

#[cfg(test)]
mod tests {
    use super::*;

    /// The least of x² − x over [−4, 4], bounded in [a, b] by the least of x² less the most of x.
    #[test]
    fn a_minimum_is_proved_from_below() {
        let bound = |[a, b]: [f64; 2]| if a <= 0.0 && b >= 0.0 { -b } else { (a * a).min(b * b) - b };
        for (most, known) in [(u64::MAX, 1e-6), (100, 1e-1), (1, 4.0)] {
            let mut search = BestFirst::new(most);
            search.push(-4.0, 0, [-4.0, 4.0]);
            while let Some((_, [a, b])) = search.take(|bound| bound >= -0.25 - 1e-6) {
                search.look();
                for half in [[a, 0.5 * (a + b)], [0.5 * (a + b), b]] {
                    search.push(bound(half), 0, half);
                }
            }
            assert!(search.bound() <= -0.25 && search.bound() >= -0.25 - known, "{}", search.bound());
            search.leave(f64::NAN);
            assert_eq!(search.bound(), f64::NEG_INFINITY);
        }
    }

    #[test]
    fn of_equal_bounds_the_oldest_comes_first() {
        let mut search = BestFirst::new(9);
        for (age, name) in [(3, 'c'), (1, 'a'), (2, 'b')] {
            search.push(1.0, age, name);
        }
        search.push(2.0, 0, 'd');
        let order: String = std::iter::from_fn(|| search.take(|_| false)).map(|(_, name)| name).collect();
        assert_eq!(order, "abcd");
    }
}
