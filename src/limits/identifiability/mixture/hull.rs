//! The two nearest points of two sets of mixed counts: N = Σ s_i n_i/D_i, s ≥ 0, Σs = 1, of the target's members, and M = Σ q_j m_j,
//! q ≥ 0, Σq = Σ s_i/D_i, of the alternative's, at the least
//!
//! F = Σ_w (√(N_w + v_w) − √(M_w + v_w))²,
//!
//! v variance beside that of the photons. F is jointly convex in (s, q), since −√(ab) is. D_i is 1 for a camera; the photons of member i
//! where distances are per photon of the mixture, whose photons are then 1.
//!
//! Gauss and Newton's steps on a few members that carry all weight (their least squares by orthogonal columns, no normal equations); a
//! member that runs out is dropped, and the one along which F falls most is taken in, until none is left: for any g_w < 1 and
//! h_w = −g_w/(1 − g_w)
//!
//! (√a − √b)² ≥ g a + h b,
//!
//! with equality at g = 1 − √(b/a), so that min_i (g·n_i + min_j h·m_j)/D_i + v·(g + h) is below the least F ([`Plane`]).
//!
//! Kept beside [`crate::box_least_squares`], whose normal equations square the condition: shares of four spectra that differ by
//! 1e-6 of themselves come out to 2e-10 here (2.7 µs) and to 7e-4 there (1.9 µs); at 1e-8 there is mostly no answer.

use crate::sum;

/// Share of F that may be missing at the end.
const GAP: f64 = 1e-10;
const STEPS: usize = 300;
/// Share of a column that is left by the others below which it says nothing new.
const DEPENDENT: f64 = 1e-9;

/// Spectra to be mixed: counts of members band by band.
pub(super) struct Hulls<'h> {
    pub(super) targets: &'h [Vec<f64>],
    /// D_i of each.
    pub(super) photons: &'h [f64],
    pub(super) alternatives: &'h [Vec<f64>],
    /// v.
    pub(super) var_added: &'h [f64],
}

/// s and q.
pub(super) type Shares = [Vec<f64>; 2];

/// Shares to be tried, and whether a member runs out there.
type Trial = (Shares, bool);

/// A pair of mixtures.
#[derive(Debug, Clone)]
pub(super) struct Mixed {
    pub(super) shares: Shares,
    pub(super) cost: f64,
}

/// g and h of a plane below (√a − √b)².
#[derive(Debug, Clone)]
pub(super) struct Plane {
    pub(super) g: Vec<f64>,
    pub(super) h: Vec<f64>,
}

impl Plane {
    /// That which touches at these counts.
    pub(super) fn at(target: &[f64], alternative: &[f64], var_added: &[f64]) -> Self {
        let pairs = target.iter().zip(alternative).zip(var_added);
        let g: Vec<f64> = pairs
            .map(|((a, b), v)| {
                let (root_a, root_b) = ((a + v).max(f64::MIN_POSITIVE).sqrt(), (b + v).max(0.0).sqrt());
                // Of differences, so that nothing is lost where the two are near; any number below 1 is a plane.
                let g = (a - b) / (root_a * (root_a + root_b));
                if g.is_finite() { g.clamp(-1e12, 1.0 - 1e-12) } else { 0.0 }
            })
            .collect();
        let h = g.iter().map(|g| -g / (1.0 - g)).collect();
        Self { g, h }
    }

    /// v·(g + h), and the terms that it is made of.
    pub(super) fn of_noise(&self, var_added: &[f64]) -> [f64; 2] {
        let terms = || self.g.iter().zip(&self.h).zip(var_added).map(|((g, h), v)| (g + h) * v);
        [terms().sum(), terms().map(f64::abs).sum::<f64>()]
    }
}

impl Hulls<'_> {
    fn counts(&self, shares: &Shares) -> [Vec<f64>; 2] {
        let bands = self.var_added.len();
        let (mut own, mut other) = (vec![0.0; bands], vec![0.0; bands]);
        for (i, share) in shares[0].iter().enumerate().filter(|(_, share)| **share > 0.0) {
            let scale = share / self.photons[i];
            own.iter_mut().zip(&self.targets[i]).for_each(|(sum, n)| *sum += scale * n);
        }
        for (j, share) in shares[1].iter().enumerate().filter(|(_, share)| **share > 0.0) {
            other.iter_mut().zip(&self.alternatives[j]).for_each(|(sum, m)| *sum += share * m);
        }
        [own, other]
    }

    fn cost(&self, [own, other]: &[Vec<f64>; 2]) -> f64 {
        let terms = own.iter().zip(other).zip(self.var_added);
        terms.map(|((a, b), v)| separation(*a, *b, *v).powi(2)).sum()
    }

    /// A member of each.
    pub(super) fn pure(&self, i: usize, j: usize) -> Mixed {
        let mut shares = [vec![0.0; self.targets.len()], vec![0.0; self.alternatives.len()]];
        (shares[0][i], shares[1][j]) = (1.0, 1.0 / self.photons[i]);
        let cost = self.cost(&self.counts(&shares));
        Mixed { shares, cost }
    }

    /// The nearest mixtures, from a start with shares of both; and the plane that touches there.
    pub(super) fn nearest(&self, start: Mixed) -> (Mixed, Plane) {
        let mut at = start;
        let mut counts = self.counts(&at.shares);
        at.cost = self.cost(&counts);
        let mut taken_in = [usize::MAX; 2];
        for _ in 0..STEPS {
            let (step, blocked) = self.step(&at, &counts);
            let mut moved = false;
            for (shares, block) in step {
                let found = self.counts(&shares);
                let cost = self.cost(&found);
                if cost < at.cost || (block && cost <= at.cost * (1.0 + 1e-14)) {
                    moved = cost < at.cost * (1.0 - GAP);
                    (at, counts) = (Mixed { shares, cost }, found);
                    break;
                }
            }
            if moved || blocked {
                taken_in = [usize::MAX; 2];
                if moved {
                    continue;
                }
            }
            // The member along which it falls most, one of each side.
            let plane = Plane::at(&counts[0], &counts[1], self.var_added);
            let own: Vec<f64> = self.targets.iter().map(|n| sum::dot(&plane.g, n)).collect();
            let other: Vec<f64> = self.alternatives.iter().map(|m| sum::dot(&plane.h, m)).collect();
            let (least, cheapest) = argmin(other.iter().copied());
            let (lowest, dearest) = argmin(own.iter().zip(self.photons).map(|(n, d)| (n + cheapest) / d));
            let reached = own.iter().zip(&at.shares[0]).zip(self.photons).map(|((n, s), d)| n * s / d);
            let reached =
                reached.sum::<f64>() + other.iter().zip(&at.shares[1]).map(|(m, q)| m * q).sum::<f64>();
            let gap = reached - dearest;
            let known = [lowest, least];
            let new = (0..2).any(|side| at.shares[side][known[side]] <= 0.0);
            if gap <= GAP * at.cost || !new || known == taken_in {
                return (at, plane);
            }
            taken_in = known;
            self.take_in(&mut at, known);
            counts = self.counts(&at.shares);
            at.cost = self.cost(&counts);
        }
        let plane = Plane::at(&counts[0], &counts[1], self.var_added);
        (at, plane)
    }

    /// Gives members without weight a little, so that a step can change it.
    fn take_in(&self, at: &mut Mixed, members: [usize; 2]) {
        const LITTLE: f64 = 1e-9;
        let [own, other] = &mut at.shares;
        if own[members[0]] <= 0.0 {
            own.iter_mut().for_each(|share| *share *= 1.0 - LITTLE);
            own[members[0]] = LITTLE;
        }
        let total: f64 = own.iter().zip(self.photons).map(|(s, d)| s / d).sum();
        let so_far: f64 = other.iter().sum();
        let little = if other[members[1]] <= 0.0 { LITTLE * total } else { 0.0 };
        let scale = (total - little) / so_far;
        other.iter_mut().for_each(|share| *share *= scale);
        other[members[1]] += little;
    }

    /// Shares after a whole step and after shorter ones, the longest first; whether a member ran out before the end of it.
    fn step(&self, at: &Mixed, counts: &[Vec<f64>; 2]) -> (Vec<Trial>, bool) {
        crate::stop::check();
        let heaviest = |shares: &[f64]| argmin(shares.iter().map(|share| -share)).0;
        let reference = [heaviest(&at.shares[0]), heaviest(&at.shares[1])];
        let roots: [Vec<f64>; 2] = [0, 1].map(|side| {
            let root = |(n, v): (&f64, &f64)| 2.0 * (n + v).max(f64::MIN_POSITIVE).sqrt();
            counts[side].iter().zip(self.var_added).map(root).collect()
        });
        let mut columns: Vec<(usize, usize, Vec<f64>)> = Vec::new();
        let (own_ref, other_ref) = (&self.targets[reference[0]], &self.alternatives[reference[1]]);
        let photons_ref = self.photons[reference[0]];
        for (i, _) in at.shares[0].iter().enumerate().filter(|(i, s)| **s > 0.0 && *i != reference[0]) {
            let (d, more) = (self.photons[i], 1.0 / self.photons[i] - 1.0 / photons_ref);
            let bands =
                self.targets[i].iter().zip(own_ref).zip(other_ref).zip(roots[0].iter().zip(&roots[1]));
            let column = bands.map(|(((n, n0), m0), (a, b))| (n / d - n0 / photons_ref) / a - more * m0 / b);
            columns.push((0, i, column.collect()));
        }
        for (j, _) in at.shares[1].iter().enumerate().filter(|(j, q)| **q > 0.0 && *j != reference[1]) {
            let bands = self.alternatives[j].iter().zip(other_ref).zip(&roots[1]);
            columns.push((1, j, bands.map(|((m, m0), b)| -(m - m0) / b).collect()));
        }
        if columns.is_empty() {
            return (Vec::new(), false);
        }
        let bands = counts[0].iter().zip(&counts[1]).zip(self.var_added);
        let residual: Vec<f64> = bands.map(|((a, b), v)| -separation(*a, *b, *v)).collect();
        let spectra: Vec<&[f64]> = columns.iter().map(|(.., column)| column.as_slice()).collect();
        let change = least_squares(&spectra, &residual);
        let mut direction = [vec![0.0; self.targets.len()], vec![0.0; self.alternatives.len()]];
        for ((side, member, _), change) in columns.iter().zip(&change) {
            direction[*side][*member] += change;
            direction[*side][reference[*side]] -= change;
            if *side == 0 {
                direction[1][reference[1]] += change * (1.0 / self.photons[*member] - 1.0 / photons_ref);
            }
        }
        let (mut longest, mut first) = (1.0, None);
        for (side, (shares, changes)) in at.shares.iter().zip(&direction).enumerate() {
            for (member, (share, change)) in shares.iter().zip(changes).enumerate() {
                if *change < 0.0 && share + longest * change < 0.0 {
                    (longest, first) = (-share / change, Some((side, member)));
                }
            }
        }
        let moved = |length: f64, drop: Option<(usize, usize)>| {
            let mut shares = at.shares.clone();
            for (shares, changes) in shares.iter_mut().zip(&direction) {
                let each = shares.iter_mut().zip(changes);
                each.for_each(|(share, change)| *share = (*share + length * change).max(0.0));
            }
            if let Some((side, member)) = drop {
                shares[side][member] = 0.0;
            }
            // Of rounding: the sums are what they must be.
            let total: f64 = shares[0].iter().sum();
            shares[0].iter_mut().for_each(|share| *share /= total);
            let wanted: f64 = shares[0].iter().zip(self.photons).map(|(s, d)| s / d).sum();
            let total: f64 = shares[1].iter().sum();
            shares[1].iter_mut().for_each(|share| *share *= wanted / total);
            (shares, drop.is_some())
        };
        let mut trials = vec![moved(longest, first)];
        trials.extend([0.5, 0.125, 0.015_625].map(|part| moved(part * longest, None)));
        (trials, first.is_some())
    }
}

/// √(a + v) − √(b + v) of the difference of the two.
fn separation(a: f64, b: f64, v: f64) -> f64 {
    let roots = (a + v).max(0.0).sqrt() + (b + v).max(0.0).sqrt();
    if roots > 0.0 { (a - b) / roots } else { 0.0 }
}

fn argmin(values: impl Iterator<Item = f64>) -> (usize, f64) {
    let least = values.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
    least.unwrap_or((0, f64::INFINITY))
}

/// x at the least ‖Σ x_i c_i − r‖, by orthogonal columns; columns that the others make are not used.
fn least_squares(columns: &[&[f64]], right: &[f64]) -> Vec<f64> {
    let count = columns.len();
    let mut orthogonal: Vec<Vec<f64>> = Vec::with_capacity(count);
    // R of columns = QR, column by column; `None` where a column is made of those before.
    let mut triangle: Vec<Option<Vec<f64>>> = Vec::with_capacity(count);
    for column in columns {
        let norm = sum::dot(column, column).sqrt();
        let mut rest = column.to_vec();
        let mut row = vec![0.0; orthogonal.len()];
        // Twice is enough.
        for _ in 0..2 {
            for (q, sum_of) in orthogonal.iter().zip(&mut row) {
                let part = sum::dot(q, &rest);
                rest.iter_mut().zip(q).for_each(|(rest, q)| *rest -= part * q);
                *sum_of += part;
            }
        }
        let left = sum::dot(&rest, &rest).sqrt();
        if left > DEPENDENT * norm {
            rest.iter_mut().for_each(|value| *value /= left);
            orthogonal.push(rest);
            row.push(left);
            triangle.push(Some(row));
        } else {
            triangle.push(None);
        }
    }
    let mut along: Vec<f64> = orthogonal.iter().map(|q| sum::dot(q, right)).collect();
    let mut found = vec![0.0; count];
    let mut place = orthogonal.len();
    for (i, row) in triangle.iter().enumerate().rev() {
        let Some(row) = row else { continue };
        place -= 1;
        found[i] = along[place] / row[place];
        along[..place].iter_mut().zip(row).for_each(|(along, part)| *along -= found[i] * part);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A target that is the mean of two alternatives is met, whatever third there is; the plane then says nothing is below 0.
    #[test]
    fn a_mixture_that_is_the_target_is_found() {
        let target: Vec<f64> = (0..20).map(|w| 1e4 * (1.0 + 0.3 * f64::from(w).sin())).collect();
        let tilt = |sign: f64| -> Vec<f64> {
            target.iter().enumerate().map(|(w, n)| n * (1.0 + sign * 0.01 * (w as f64 - 9.5))).collect()
        };
        let far: Vec<f64> = target.iter().map(|n| 1.3 * n).collect();
        let (targets, alternatives) = (vec![target.clone()], vec![tilt(1.0), far, tilt(-1.0)]);
        let hulls =
            Hulls { targets: &targets, photons: &[1.0], alternatives: &alternatives, var_added: &[10.0; 20] };
        let (found, plane) = hulls.nearest(hulls.pure(0, 1));
        assert!(found.cost < 1e-12 && (found.shares[1][0] - 0.5).abs() < 1e-6, "{found:?}");
        assert!(plane.g.iter().all(|g| g.abs() < 1e-6));
    }

    /// Whatever touches, a plane is below (√a − √b)² for all other counts.
    #[test]
    fn planes_are_below() {
        let spectra: Vec<Vec<f64>> = (0..12)
            .map(|i| (0..7).map(|w| 10f64.powf((f64::from(7 * i + w) * 1.7).sin() * 4.0)).collect())
            .collect();
        let var = [0.0, 1.0, 1e3, 0.0, 5.0, 0.1, 1e6];
        for touched in spectra.chunks(2) {
            let plane = Plane::at(&touched[0], &touched[1], &var);
            for pair in spectra.windows(2) {
                let exact: f64 = (0..7).map(|w| separation(pair[0][w], pair[1][w], var[w]).powi(2)).sum();
                let below =
                    sum::dot(&plane.g, &pair[0]) + sum::dot(&plane.h, &pair[1]) + plane.of_noise(&var)[0];
                assert!(below <= exact * (1.0 + 1e-9) + 1e-9, "{below} {exact}");
            }
            let at =
                sum::dot(&plane.g, &touched[0]) + sum::dot(&plane.h, &touched[1]) + plane.of_noise(&var)[0];
            let exact: f64 = (0..7).map(|w| separation(touched[0][w], touched[1][w], var[w]).powi(2)).sum();
            assert!((at / exact - 1.0).abs() < 1e-9, "{at} {exact}");
        }
    }
}
