//! Exact quantiles of values that are read several times, since they are too many to be kept.
//!
//! The 32 bits of a number, turned so that their order is that of the numbers, are found in three passes over all values: each counts
//! those that begin with the bits known so far by the next 11, 11 and 10.

use hadar::error::Result;

/// Bits that each pass finds.
const BITS: [u32; 3] = [11, 11, 10];

/// Takes a value of a group.
pub type Count<'a> = dyn FnMut(usize, f32) + 'a;

/// One value that is looked for.
struct Target {
    share: f64,
    rank: u64,
    /// The bits that are known.
    known: u32,
    /// Values by the bits that follow; empty before the first.
    counts: Vec<u64>,
}

/// For every group of values those at its `shares`, of which `rank` makes a place in their order, from 0, out of so many; `None` where a
/// group has no value. `pass` hands on all values with their groups, the same ones each time, NaN left out.
///
/// # Errors
/// What `pass` meets.
///
/// ```
/// use hadar_study::decompose::ranked;
/// let values = [3.0_f32, -1.0, 2.0];
/// let middle = |share: f64, count: u64| (share * count as f64) as u64;
/// let found = ranked(&[&[0.5]], middle, &mut |count| Ok(values.iter().for_each(|value| count(0, *value))))?;
/// assert_eq!(found, [[Some(2.0)]]);
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn ranked(
    shares: &[&[f64]],
    rank: impl Fn(f64, u64) -> u64,
    pass: &mut dyn FnMut(&mut Count<'_>) -> Result<()>,
) -> Result<Vec<Vec<Option<f32>>>> {
    let target = |share: &f64| Target { share: *share, rank: 0, known: 0, counts: Vec::new() };
    let mut groups: Vec<Vec<Target>> = shares.iter().map(|own| own.iter().map(target).collect()).collect();
    let mut left = u32::BITS;
    for (i, bits) in BITS.into_iter().enumerate() {
        let above = left;
        left -= bits;
        pass(&mut |group, value| {
            let turned = turned(value);
            for target in groups.get_mut(group).into_iter().flatten() {
                if turned.checked_shr(above).unwrap_or(0) != target.known {
                    continue;
                }
                if target.counts.is_empty() {
                    target.counts.resize(1 << bits, 0);
                }
                let next = (turned >> left) as usize & ((1 << bits) - 1);
                target.counts.get_mut(next).into_iter().for_each(|count| *count += 1);
            }
        })?;
        for target in groups.iter_mut().flatten() {
            let counts = std::mem::take(&mut target.counts);
            if i == 0 {
                let all: u64 = counts.iter().sum();
                target.rank = rank(target.share, all).min(all.saturating_sub(1));
            }
            let Some(next) = counts.iter().position(|count| {
                let is_within = target.rank < *count;
                target.rank -= if is_within { 0 } else { *count };
                is_within
            }) else {
                // No value of the group: no number has these bits.
                target.known = u32::MAX;
                continue;
            };
            target.known = target.known << bits | next as u32;
        }
    }
    let found = |target: Target| (target.known != u32::MAX).then(|| turned_back(target.known));
    Ok(groups.into_iter().map(|own| own.into_iter().map(found).collect()).collect())
}

/// Bits whose order is that of the numbers.
fn turned(value: f32) -> u32 {
    let bits = value.to_bits();
    if bits >> 31 == 1 { !bits } else { bits | 1 << 31 }
}

fn turned_back(turned: u32) -> f32 {
    f32::from_bits(if turned >> 31 == 1 { turned & !(1 << 31) } else { !turned })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn values_are_those_of_the_sorted_ones(
            values in proptest::collection::vec(
                (0..3_usize, prop_oneof![-1e3..1e3_f32, any::<f32>(), Just(0.0), Just(7.0)]), 0..200,
            ),
            shares in proptest::collection::vec(0.0..=1.0_f64, 4),
        ) {
            let values: Vec<(usize, f32)> = values.into_iter().filter(|(_, value)| !value.is_nan()).collect();
            let wanted = [&shares[..2], &shares[2..], &shares[1..3]];
            let rank = |share: f64, count: u64| (share * count as f64) as u64;
            let found = ranked(&wanted, rank, &mut |count| {
                values.iter().for_each(|(group, value)| count(*group, *value));
                Ok(())
            }).unwrap();
            for (group, (shares, found)) in wanted.iter().zip(&found).enumerate() {
                let mut own: Vec<f32> =
                    values.iter().filter(|(of, _)| *of == group).map(|(_, value)| *value).collect();
                own.sort_by(f32::total_cmp);
                for (share, found) in shares.iter().zip(found) {
                    let place = ((share * own.len() as f64) as usize).min(own.len().saturating_sub(1));
                    prop_assert_eq!(found.map(f32::to_bits), own.get(place).map(|value| value.to_bits()));
                }
            }
        }
    }
}
