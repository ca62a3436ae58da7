//! Things in the order of a number, that of `f64::total_cmp`: equal ones stay in the order that they had, NaN is beyond infinity.
//!
//! Sorting itself is compiled once, for numbers and places; a sort with a comparison of its own costs the compiler some 2800 lines of
//! intermediate code.

/// The smallest number first.
///
/// ```
/// let mut lines = [(2.0, "b"), (1.0, "c"), (2.0, "a")];
/// hadar::order::ascending(&mut lines, |line| line.0);
/// assert_eq!(lines, [(1.0, "c"), (2.0, "b"), (2.0, "a")]);
/// ```
pub fn ascending<T>(things: &mut [T], number: impl Fn(&T) -> f64) {
    let mut places = places(things.len(), &|i| number(&things[i]));
    // Each thing is swapped to its place; where its source was swapped away before, that is followed.
    for to in 0..things.len() {
        let mut from = places[to];
        while from < to {
            from = places[from];
        }
        places[to] = from;
        things.swap(to, from);
    }
}

/// The largest number first.
pub fn descending<T>(things: &mut [T], number: impl Fn(&T) -> f64) {
    ascending(things, |thing| -number(thing));
}

/// `0..count`, by their numbers.
fn places(count: usize, number: &dyn Fn(usize) -> f64) -> Vec<usize> {
    let mut all: Vec<(f64, usize)> = (0..count).map(|i| (number(i), i)).collect();
    all.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    all.into_iter().map(|(_, place)| place).collect()
}

#[cfg(test)]
mod tests {
    use super::{ascending, descending};
    use proptest::prelude::*;

    proptest! {
        /// As the standard library's stable sort, zeros and numbers that are none among them.
        #[test]
        fn order_is_that_of_a_stable_sort(numbers in prop::collection::vec(0..9_usize, 0..40)) {
            let values = [-1.0, 0.0, -0.0, 2.0, f64::NAN, -f64::NAN, f64::INFINITY, 1.0, -3.0];
            let things: Vec<(usize, usize)> = numbers.into_iter().enumerate().collect();
            let value = |thing: &(usize, usize)| values[thing.1];
            let (mut up, mut down, mut known) = (things.clone(), things.clone(), things);
            ascending(&mut up, value);
            descending(&mut down, value);
            known.sort_by(|a, b| value(a).total_cmp(&value(b)));
            prop_assert_eq!(up, known.clone());
            known.sort_by_key(|thing| thing.0);
            known.sort_by(|a, b| value(b).total_cmp(&value(a)));
            prop_assert_eq!(down, known);
        }
    }
}
