//! The paper's prediction vector for a library, and the groups of materials that look alike.
//!
//! S32: P(m) = ε(m)/Σε, ε(d) = (1 − erf(d/√2))/(1 + erf(d/√2)), with d = 0 and ε = 1 for the target's own material.
//! It has the right limits (all rivals far: P → 1; M̄ of them at d = 0: P → 1/(M̄ + 1); one rival: Φ(d)) but is a
//! heuristic, neither a bound nor the probability of any test: two rivals at d = 1 give 0.726, where the exact
//! value lies between 0.683 and 0.841 as the rivals are opposite or the same.

use crate::identifiability::detection;

/// Prediction probabilities by S32 of a target whose rivals stand at these statistical distances: first the
/// target's own, then the rivals'.
///
/// ```
/// let p = hadar::identifiability::multi::prediction(&[1.0]);
/// assert!((p[0] - hadar::identifiability::detection::probability(1.0)).abs() < 1e-15);
/// ```
#[must_use]
pub fn prediction(distances: &[f64]) -> Vec<f64> {
    // (1 − erf)/(1 + erf) is the miss probability over the detection probability.
    let epsilon = |d: &f64| detection::miss_probability(*d) / detection::probability(*d);
    let rivals: Vec<f64> = distances.iter().map(epsilon).collect();
    let total = 1.0 + crate::sum::sum(&rivals);
    std::iter::once(1.0).chain(rivals).map(|epsilon| epsilon / total).collect()
}

/// Disjoint groups of two and more of which no two members can be told apart, each material in the first group
/// that takes it, those that are `alike` to most others first.
///
/// Being alike does not carry over: two members of different groups may be alike too (see [`chains`]).
#[must_use]
pub fn clusters(count: usize, alike: impl Fn(usize, usize) -> bool) -> Vec<Vec<usize>> {
    let alike = |a: usize, b: usize| alike(a, b) || alike(b, a);
    let mut order: Vec<usize> = (0..count).collect();
    let neighbours: Vec<usize> =
        (0..count).map(|a| (0..count).filter(|&b| b != a && alike(a, b)).count()).collect();
    order.sort_by_key(|&a| (std::cmp::Reverse(neighbours[a]), a));
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for material in order {
        match groups.iter_mut().find(|group| group.iter().all(|&member| alike(member, material))) {
            Some(group) => group.push(material),
            None => groups.push(vec![material]),
        }
    }
    tidied(groups)
}

/// Groups of two and more that hang together by pairs that are `alike`: a chain of them is enough.
#[must_use]
pub fn chains(count: usize, alike: impl Fn(usize, usize) -> bool) -> Vec<Vec<usize>> {
    let mut free = vec![true; count];
    let mut found = Vec::new();
    for first in 0..count {
        if !std::mem::take(&mut free[first]) {
            continue;
        }
        let (mut members, mut next) = (vec![first], 0);
        while let Some(&member) = members.get(next) {
            next += 1;
            for (other, free) in free.iter_mut().enumerate() {
                if *free && (alike(member, other) || alike(other, member)) {
                    *free = false;
                    members.push(other);
                }
            }
        }
        found.push(members);
    }
    tidied(found)
}

/// Groups of two and more, sorted within, the largest first.
fn tidied(mut groups: Vec<Vec<usize>>) -> Vec<Vec<usize>> {
    groups.retain(|group| group.len() > 1);
    groups.iter_mut().for_each(|group| group.sort_unstable());
    groups.sort_by_key(|group| (std::cmp::Reverse(group.len()), group[0]));
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The limits that the paper names, and its published value for two rivals at d = 1.
    #[test]
    fn the_prediction_vector_has_its_limits() {
        assert!((prediction(&[0.0; 4])[0] - 0.2).abs() < 1e-15);
        assert!((prediction(&[40.0, 50.0])[0] - 1.0).abs() < 1e-15);
        assert!((prediction(&[1.0, 1.0])[0] - 0.726).abs() < 5e-4);
        assert!((prediction(&[1.0; 19])[0] - 0.218).abs() < 5e-4);
        let p = prediction(&[0.3, 1.2, 5.0]);
        assert!((p.iter().sum::<f64>() - 1.0).abs() < 1e-15 && p[1] > p[2] && p[2] > p[3]);
        assert_eq!(prediction(&[]), [1.0]);
    }

    #[test]
    fn a_chain_hangs_together_but_is_no_cluster() {
        let pairs = [(0, 3), (3, 5), (1, 4)];
        let alike = |a: usize, b: usize| pairs.contains(&(a, b));
        assert_eq!(chains(6, alike), [vec![0, 3, 5], vec![1, 4]]);
        assert_eq!(clusters(6, alike), [vec![0, 3], vec![1, 4]]);
        assert!(clusters(3, |_, _| false).is_empty() && chains(3, |_, _| false).is_empty());
        assert_eq!(clusters(4, |a, b| a != b), [vec![0, 1, 2, 3]]);
    }
}
