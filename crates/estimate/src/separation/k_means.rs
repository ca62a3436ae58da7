//! Points in groups about their means.
//!
//! Lloyd's steps from starts that k-means++ draws (each next one with a probability proportional to the squared distance from the
//! nearest so far); the best of some starts. A group that loses all its points takes the point that is farthest from its mean.
//! Sums go in one order whatever the number of threads.
//!
//! Sources: Lloyd, IEEE Trans. Inf. Theory 28, 129 (1982), doi:10.1109/TIT.1982.1056489; Arthur and Vassilvitskii, SODA 2007, 1027.

use hadar::error::{Error, Result};
use hadar::random::generator;
use rand::RngExt;
use rand::rngs::ChaCha8Rng;
use rayon::prelude::*;

/// Most steps of one start.
const STEPS: usize = 60;
/// Points that one thread takes at a time.
const CHUNK: usize = 256;

/// Groups of points.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Means {
    /// Means of the groups, one after the other.
    pub centres: Vec<f64>,
    /// Group of each point.
    pub group: Vec<usize>,
    /// Sum of the squared distances of the points from their means.
    pub inertia: f64,
}

/// Groups `points`, of so many coordinates each, into `count`.
///
/// ```
/// use hadar_estimate::separation::k_means;
/// let found = k_means(&[0.0, 0.1, 5.0, 5.1], 1, 2, 1, 4)?;
/// assert!(found.group[0] == found.group[1] && found.group[2] == found.group[3] && found.group[0] != found.group[2]);
/// assert!((found.inertia - 0.01).abs() < 1e-12);
/// # Ok::<(), hadar::Error>(())
/// ```
///
/// # Errors
/// No group, or more groups than points.
pub fn k_means(points: &[f64], coordinates: usize, count: usize, seed: u64, starts: usize) -> Result<Means> {
    let coordinates = coordinates.max(1);
    let all = points.len() / coordinates;
    if count == 0 || count > all {
        return Err(Error::malformed(
            format!("{count} groups of {all} points"),
            "ask for one group at least, and no more than there are points",
        ));
    }
    let mut best: Option<Means> = None;
    for start in 0..starts.max(1) {
        let mut random = generator(seed, start as u64);
        let found = lloyd(points, coordinates, seeds(points, coordinates, count, &mut random));
        if best.as_ref().is_none_or(|best| found.inertia < best.inertia) {
            best = Some(found);
        }
    }
    best.ok_or_else(|| Error::malformed("no start", "report this as a bug"))
}

fn square(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

/// k-means++.
fn seeds(points: &[f64], coordinates: usize, count: usize, random: &mut ChaCha8Rng) -> Vec<f64> {
    hadar::stop::check();
    let all = points.len() / coordinates;
    let point = |i: usize| &points[i * coordinates..][..coordinates];
    let mut centres = point(random.random_range(0..all)).to_vec();
    let mut near: Vec<f64> = (0..all).map(|i| square(point(i), &centres)).collect();
    while centres.len() < count * coordinates {
        hadar::stop::check();
        let total: f64 = near.iter().sum();
        let mut left = random.random_range(0.0..1.0) * total;
        // Where all points lie on centres any will do.
        let mut chosen = if total > 0.0 { all - 1 } else { random.random_range(0..all) };
        for (i, share) in near.iter().enumerate().filter(|_| total > 0.0) {
            left -= share;
            if left < 0.0 {
                chosen = i;
                break;
            }
        }
        let from = centres.len();
        centres.extend_from_slice(point(chosen));
        let new = &centres[from..];
        near.iter_mut().enumerate().for_each(|(i, near)| *near = near.min(square(point(i), new)));
    }
    centres
}

fn nearest(point: &[f64], centres: &[f64]) -> (usize, f64) {
    let each = centres.chunks(point.len()).map(|centre| square(point, centre)).enumerate();
    each.fold((0, f64::INFINITY), |best, (i, d)| if d < best.1 { (i, d) } else { best })
}

fn lloyd(points: &[f64], coordinates: usize, mut centres: Vec<f64>) -> Means {
    let count = centres.len() / coordinates;
    let mut group: Vec<usize> = Vec::new();
    let mut inertia = f64::INFINITY;
    for _ in 0..STEPS {
        hadar::stop::check();
        let found: Vec<(usize, f64)> = points
            .par_chunks(coordinates * CHUNK)
            .inspect(|_| hadar::stop::check())
            .flat_map_iter(|chunk| chunk.chunks(coordinates).map(|point| nearest(point, &centres)))
            .collect();
        let mut now: Vec<usize> = found.iter().map(|one| one.0).collect();
        let mut sizes = vec![0usize; count];
        now.iter().for_each(|own| sizes[*own] += 1);
        let mut farthest: Vec<usize> = Vec::new();
        if sizes.contains(&0) {
            farthest = (0..now.len()).collect();
            farthest.sort_by(|a, b| found[*b].1.total_cmp(&found[*a].1).then(a.cmp(b)));
        }
        let mut next = farthest.into_iter();
        for empty in 0..count {
            while sizes[empty] == 0 {
                let Some(point) = next.next() else { break };
                if sizes[now[point]] > 1 {
                    sizes[now[point]] -= 1;
                    (now[point], sizes[empty]) = (empty, 1);
                }
            }
        }
        inertia = found.iter().map(|one| one.1).sum();
        let settled = now == group;
        group = now;
        centres.fill(0.0);
        for (point, own) in points.chunks(coordinates).zip(&group) {
            centres[own * coordinates..][..coordinates].iter_mut().zip(point).for_each(|(sum, x)| *sum += x);
        }
        for (centre, size) in centres.chunks_mut(coordinates).zip(&sizes) {
            centre.iter_mut().for_each(|sum| *sum /= (*size).max(1) as f64);
        }
        if settled {
            break;
        }
    }
    let each = points.chunks(coordinates).zip(&group);
    let last: f64 =
        each.map(|(point, own)| square(point, &centres[own * coordinates..][..coordinates])).sum();
    Means { centres, group, inertia: last.min(inertia) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All ways to put a few points into groups.
    fn brute_force(points: &[f64], coordinates: usize, count: usize) -> f64 {
        let all = points.len() / coordinates;
        let mut best = f64::INFINITY;
        for code in 0..count.pow(all as u32) {
            let group: Vec<usize> = (0..all).map(|i| code / count.pow(i as u32) % count).collect();
            let mut total = 0.0;
            for own in 0..count {
                let members: Vec<&[f64]> = (0..all)
                    .filter(|i| group[*i] == own)
                    .map(|i| &points[i * coordinates..][..coordinates])
                    .collect();
                let mean: Vec<f64> = (0..coordinates)
                    .map(|w| members.iter().map(|m| m[w]).sum::<f64>() / members.len().max(1) as f64)
                    .collect();
                total += members.iter().map(|m| square(m, &mean)).sum::<f64>();
            }
            best = best.min(total);
        }
        best
    }

    #[test]
    fn few_points_are_grouped_as_well_as_they_can_be() {
        let mut random = generator(5, 0);
        for case in 0..40 {
            let (all, count) = (6 + case % 3, 2 + case % 2);
            let points: Vec<f64> = (0..all * 2).map(|_| random.random_range(0.0..1.0)).collect();
            let found = k_means(&points, 2, count, 1, 40).unwrap();
            let best = brute_force(&points, 2, count);
            assert!((found.inertia - best).abs() < 1e-12, "{case}: {} {best}", found.inertia);
        }
    }

    #[test]
    fn no_group_stays_empty_and_threads_change_nothing() {
        let equal = vec![1.0; 12];
        let found = k_means(&equal, 2, 4, 1, 2).unwrap();
        let mut used = found.group.clone();
        used.sort_unstable();
        used.dedup();
        assert_eq!(used, [0, 1, 2, 3]);
        assert_eq!(found.inertia, 0.0);
        assert!(k_means(&equal, 2, 7, 1, 2).is_err() && k_means(&equal, 2, 0, 1, 2).is_err());
        let mut random = generator(6, 0);
        let points: Vec<f64> = (0..3000).map(|_| random.random_range(0.0..1.0)).collect();
        let by = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| k_means(&points, 3, 5, 9, 2).unwrap())
        };
        assert_eq!(by(1), by(3));
    }
}
