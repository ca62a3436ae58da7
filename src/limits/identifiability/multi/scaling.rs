//! How the least distance falls as a library grows.
//!
//! Of n rivals at distances d₍₁₎ ≤ … ≤ d₍ₙ₎, k are drawn at random. The i-th is the nearest one drawn with probability
//! C(n − i, k − 1)/C(n, k), so the expectation of the least distance over all C(n, k) libraries is a finite sum:
//! no random draws are needed.

/// Expected least of k of these distances, for k = 1…n.
///
/// ```
/// let least = hadar::identifiability::multi::expected_minimum(&[3.0, 1.0, 2.0]);
/// assert!(least.iter().zip([2.0, 4.0 / 3.0, 1.0]).all(|(a, b)| (a - b).abs() < 1e-15));
/// ```
#[must_use]
pub fn expected_minimum(distances: &[f64]) -> Vec<f64> {
    crate::stop::check();
    let mut sorted = distances.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len();
    (1..=n)
        .map(|k| {
            // The probability that none of the first i is drawn falls from 1 by (n − i − k)/(n − i).
            let (mut none_before, mut expected) = (1.0, 0.0);
            for (i, distance) in sorted.iter().enumerate().take(n - k + 1) {
                let here = none_before * k as f64 / (n - i) as f64;
                expected += here * distance;
                none_before -= here;
            }
            expected
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the mean over all subsets, written out.
    #[test]
    fn it_is_the_mean_over_all_libraries() {
        let distances = [0.3, 2.0, 0.7, 1.1, 5.0, 0.7];
        let found = expected_minimum(&distances);
        for k in 1..=distances.len() {
            let (mut total, mut count) = (0.0, 0);
            for set in 0u32..1 << distances.len() {
                if set.count_ones() as usize == k {
                    let members = distances.iter().enumerate().filter(|(i, _)| set >> i & 1 == 1);
                    total += members.map(|(_, d)| *d).fold(f64::INFINITY, f64::min);
                    count += 1;
                }
            }
            assert!((found[k - 1] / (total / f64::from(count)) - 1.0).abs() < 1e-14, "{k}");
        }
        assert!(expected_minimum(&[]).is_empty());
    }
}
