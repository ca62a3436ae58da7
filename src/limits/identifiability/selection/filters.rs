//! The best k filters, each a run of neighbouring bands.
//!
//! Against a certificate (λ, c) a filter from band a to band b is worth
//! g(a, b) = Σ_p λ_p (E_pb − E_pa)²/(N_p + σ²), E_p the running sum of the residual and N_p + σ² the variance of
//! the filter's counts; the best k filters without overlap are found by dynamic programming over their ends,
//! V_k(b) = max(V_k(b − 1), max_a V_{k−1}(a) + g(a, b)), in k W²/2 steps, gaps and unused filters allowed. That
//! is the bound of [`super::certificate`]. The best choices met are then improved by moving edges (one alone, or
//! one that two filters share), by moving a filter elsewhere, and by starting anew with a third of the edges drawn
//! at random (a fixed sequence); few enough choices are gone through one by one.

use super::bands::combinations;
use super::certificate::{Certificate, Opponent, bound, worst};
use super::pair::{Fit, Pair};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use std::ops::Range;

/// Share by which a move must help.
const HELPS: f64 = 1e-10;
/// Normal equations set up in search of better edges, times one more than there are pairs.
const EFFORT: usize = 20_000;
/// Most choices of filters that are gone through one by one.
const FEW: f64 = 100_000.0;

/// Dynamic programming over the ends of filters.
struct BestRuns {
    k: usize,
    /// g of the filters that begin at one band.
    values: Vec<f64>,
    /// V and, for every number of filters and end, where the last filter begins (or none ends there).
    totals: Vec<Vec<f64>>,
    starts: Vec<Vec<Option<usize>>>,
}

impl BestRuns {
    fn new(k: usize, bands: usize) -> Self {
        Self {
            k,
            values: Vec::with_capacity(bands),
            totals: vec![vec![0.0; bands + 1]; k + 1],
            starts: vec![vec![None; bands + 1]; k + 1],
        }
    }

    /// g(start, end) for every end after `start`.
    fn weigh(&mut self, pairs: &[Pair], shares: &[f64], sums: &[Vec<f64>], start: usize) {
        self.values.clear();
        self.values.resize(pairs.first().map_or(0, Pair::bands) - start, 0.0);
        for ((pair, share), sums) in pairs.iter().zip(shares).zip(sums) {
            if *share == 0.0 {
                continue;
            }
            let base = sums[start];
            let ends = sums[start + 1..].iter().zip(pair.noise_from(start));
            self.values.iter_mut().zip(ends).for_each(|(value, (sum, inverse))| {
                *value += share * inverse * (sum - base) * (sum - base);
            });
        }
    }
}

impl Opponent for BestRuns {
    fn best(&mut self, pairs: &[Pair], certificate: &Certificate) -> (Vec<Range<usize>>, f64) {
        let bands = pairs.first().map_or(0, Pair::bands);
        let sums: Vec<Vec<f64>> =
            pairs.iter().zip(&certificate.coefficients).map(|(pair, c)| pair.residual_sums(c)).collect();
        self.totals.iter_mut().for_each(|totals| totals.fill(0.0));
        self.starts.iter_mut().for_each(|starts| starts.fill(None));
        for start in 0..bands {
            crate::stop::check();
            // V(start) is complete: all filters that end there began before.
            self.weigh(pairs, &certificate.shares, &sums, start);
            for used in 1..=self.k {
                let (before, after) = self.totals.split_at_mut(used);
                let (Some(before), Some(totals)) = (before.last(), after.first_mut()) else { continue };
                let starts = &mut self.starts[used];
                if totals[start] > totals[start + 1] {
                    totals[start + 1] = totals[start];
                    starts[start + 1] = None;
                }
                let base = before[start];
                let ends = totals[start + 1..].iter_mut().zip(&mut starts[start + 1..]);
                for ((total, from), value) in ends.zip(&self.values) {
                    if base + value > *total {
                        *total = base + value;
                        *from = Some(start);
                    }
                }
            }
        }
        let mut filters = Vec::new();
        let (mut used, mut end) = (self.k, bands);
        while used > 0 && end > 0 {
            match self.starts[used][end] {
                Some(start) => {
                    filters.push(start..end);
                    (used, end) = (used - 1, start);
                }
                None => end -= 1,
            }
        }
        filters.reverse();
        (filters, self.totals[self.k][bands] + certificate.prior_cost(pairs))
    }
}

/// A choice of filters.
pub(super) struct Chosen {
    pub(super) filters: Vec<Range<usize>>,
    /// No choice has a greater (d/required)².
    pub(super) bound_square: f64,
    pub(super) exact: bool,
}

/// The best k filters for the pair that fares worst; all pairs must differ, and k be enough for each.
pub(super) fn choose(pairs: &[Pair], k: usize, rounds: usize) -> Chosen {
    let bands = pairs.first().map_or(0, Pair::bands);
    let mut opponent = BestRuns::new(k, bands);
    let found = bound(pairs, &mut opponent, rounds);
    let mut best: (f64, Vec<Range<usize>>) = (0.0, Vec::new());
    // 2k edges, of which neighbouring filters may share some.
    let few = combinations(bands + k, 2 * k) <= FEW;
    let mut edges = Edges::new(pairs);
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut starts: Vec<Vec<Range<usize>>> = found.met.iter().map(|met| met.1.clone()).collect();
    while let Some(mut filters) = starts.pop() {
        edges.improve(&mut filters, k);
        let (distance, _) = worst(pairs, &filters);
        if distance > best.0 {
            best = (distance, filters);
        }
        if found.proves(best.0) {
            break;
        }
        if starts.is_empty() && edges.left > 0 && !few {
            starts.push(shaken(&best.1, bands, &mut random));
        }
    }
    let proven = found.proves(best.0);
    if few && !proven {
        let mut all =
            All { edges: Edges::new(pairs), k, bands, goal: 0.0, best: Vec::new(), chosen: Vec::new() };
        all.extend(0);
        let (distance, _) = worst(pairs, &all.best);
        if distance > best.0 {
            best = (distance, all.best);
        }
    }
    let exact = few || proven;
    Chosen { filters: best.1, bound_square: if exact { best.0 * best.0 } else { found.square }, exact }
}

/// The same filters with a third of their edges drawn anew.
fn shaken(filters: &[Range<usize>], bands: usize, random: &mut ChaCha8Rng) -> Vec<Range<usize>> {
    let mut edges: Vec<usize> = filters.iter().flat_map(|filter| [filter.start, filter.end]).collect();
    for _ in 0..1 + edges.len() / 3 {
        let place = random.random_range(0..edges.len().max(1));
        if let Some(edge) = edges.get_mut(place) {
            *edge = random.random_range(0..=bands);
        }
    }
    edges.sort_unstable();
    edges.chunks_exact(2).map(|two| two[0]..two[1]).filter(|filter| !filter.is_empty()).collect()
}

/// Values of choices of filters.
struct Edges<'a> {
    pairs: &'a [Pair],
    fit: Fit,
    /// Normal equations that may still be set up in search of better edges.
    left: usize,
}

impl<'a> Edges<'a> {
    fn new(pairs: &'a [Pair]) -> Self {
        Self { pairs, fit: Fit::default(), left: EFFORT * (1 + pairs.len()) }
    }

    /// Least (d/required)²; not worked out to the end where it is not above `goal`.
    fn value(&mut self, filters: &[Range<usize>], goal: f64) -> f64 {
        crate::stop::check();
        let mut least = f64::INFINITY;
        for pair in self.pairs {
            self.left = self.left.saturating_sub(1);
            self.fit.solve(&pair.gram(filters), pair.width());
            least = least.min(self.fit.square);
            if least <= goal {
                break;
            }
        }
        least
    }

    /// Takes the candidate if it is better.
    fn accept(
        &mut self,
        filters: &mut Vec<Range<usize>>,
        now: &mut f64,
        candidate: Vec<Range<usize>>,
    ) -> bool {
        crate::stop::check();
        let ordered = candidate.windows(2).all(|two| two[0].end <= two[1].start);
        if !ordered || candidate.iter().any(|filter| filter.is_empty()) {
            return false;
        }
        let goal = *now * (1.0 + HELPS);
        let value = self.value(&candidate, goal);
        if value <= goal {
            return false;
        }
        (*filters, *now) = (candidate, value);
        true
    }

    /// Moves edges as long as that helps, by steps that become ever finer.
    fn improve(&mut self, filters: &mut Vec<Range<usize>>, k: usize) {
        let bands = self.pairs.first().map_or(0, Pair::bands);
        let mut now = self.value(filters, f64::NEG_INFINITY);
        let coarsest = bands.next_power_of_two() / 4;
        let mut step = coarsest.max(1);
        loop {
            let mut helped = self.add(filters, &mut now, k, step);
            for place in 0..2 * filters.len() {
                for up in [true, false] {
                    while let Some(candidate) = moved(filters, place, step, up, bands) {
                        if !self.accept(filters, &mut now, candidate) {
                            break;
                        }
                        helped = true;
                    }
                    if let Some(candidate) = moved_together(filters, place, step, up, bands)
                        && self.accept(filters, &mut now, candidate)
                    {
                        helped = true;
                    }
                }
            }
            match (helped, step) {
                (true, _) if self.left > 0 => {}
                (true, _) | (false, 1) => return,
                (false, _) => step /= 2,
            }
        }
    }

    /// Puts filters that are still to be had into gaps, or splits one in two.
    fn add(&mut self, filters: &mut Vec<Range<usize>>, now: &mut f64, k: usize, step: usize) -> bool {
        let bands = self.pairs.first().map_or(0, Pair::bands);
        let mut helped = false;
        while filters.len() < k {
            let before = filters.len();
            for start in (0..bands).step_by(step) {
                let mut candidate = filters.clone();
                match filters.iter().position(|filter| filter.start < start && start < filter.end) {
                    Some(i) => {
                        let end = candidate[i].end;
                        candidate[i].end = start;
                        candidate.insert(i + 1, start..end);
                    }
                    None => {
                        candidate.push(start..(start + step).min(bands));
                        candidate.sort_by_key(|filter| filter.start);
                    }
                }
                if self.accept(filters, now, candidate) {
                    helped = true;
                    break;
                }
            }
            if filters.len() == before {
                break;
            }
        }
        helped
    }
}

fn shifted(at: usize, step: usize, up: bool, bands: usize) -> Option<usize> {
    if up { Some(at + step).filter(|at| *at <= bands) } else { at.checked_sub(step) }
}

/// One edge of a filter elsewhere; an even place is a start, an odd one an end.
fn moved(
    filters: &[Range<usize>],
    place: usize,
    step: usize,
    up: bool,
    bands: usize,
) -> Option<Vec<Range<usize>>> {
    let mut candidate = filters.to_vec();
    let filter = candidate.get_mut(place / 2)?;
    let edge = if place.is_multiple_of(2) { &mut filter.start } else { &mut filter.end };
    *edge = shifted(*edge, step, up, bands)?;
    Some(candidate)
}

/// From an even place: the whole filter elsewhere. From an odd one: the edge that it shares with the next filter.
fn moved_together(
    filters: &[Range<usize>],
    place: usize,
    step: usize,
    up: bool,
    bands: usize,
) -> Option<Vec<Range<usize>>> {
    let mut candidate = filters.to_vec();
    let (one, next) = (place / 2, place / 2 + 1);
    let end = shifted(candidate.get(one)?.end, step, up, bands)?;
    if place.is_multiple_of(2) {
        candidate[one] = shifted(candidate[one].start, step, up, bands)?..end;
    } else {
        let next = candidate.get_mut(next).filter(|next| next.start == filters[one].end)?;
        next.start = end;
        candidate[one].end = end;
    }
    Some(candidate)
}

/// Goes through all choices of at most k filters.
struct All<'a> {
    edges: Edges<'a>,
    k: usize,
    bands: usize,
    goal: f64,
    best: Vec<Range<usize>>,
    chosen: Vec<Range<usize>>,
}

impl All<'_> {
    fn extend(&mut self, from: usize) {
        if !self.chosen.is_empty() {
            let value = self.edges.value(&self.chosen, self.goal);
            if value > self.goal {
                self.goal = value * (1.0 + HELPS);
                self.best.clone_from(&self.chosen);
            }
        }
        if self.chosen.len() == self.k {
            return;
        }
        for start in from..self.bands {
            for end in start + 1..=self.bands {
                self.chosen.push(start..end);
                self.extend(end);
                self.chosen.pop();
            }
        }
    }
}
