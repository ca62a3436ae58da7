//! The best k of the bands: bound, exchange, and proof by enumeration where it can be had.
//!
//! * Bound: against a certificate (λ, c) the best k bands are those of the largest g_w = Σ_p λ_p r_pw(c_p)².
//! * Exchange: from the best selections that the search for the bound met (and then from the best so far with a
//!   third of it drawn anew, a fixed sequence of draws), one band is swapped for the best
//!   other one until no swap helps (Fedorov's exchange).
//! * Enumeration: bands in falling order of g; a selection that begins with given bands has at most their g and
//!   the next largest, so that all that cannot beat what is known is left out, at the root with the root's
//!   certificate and lower down with one fitted to the bands chosen so far. It ends with a proof, or with
//!   the effort it was given.
//!
//! Source: Fedorov, *Theory of Optimal Experiments*, Academic Press (1972), chapter 3.

use super::certificate::{Bounded, Certificate, Opponent, bound, worst};
use super::pair::{Fit, Pair, residual};
use crate::order;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use std::ops::Range;

/// Share by which a swap must help.
const HELPS: f64 = 1e-10;
/// Share by which squares from normal equations may differ from those of orthogonalised rows.
const AGREE: f64 = 1e-7;
/// Rows weighed in exchanges, times one more than there are pairs.
const EXCHANGES: usize = 250_000;
/// So many choices are gone through one by one without more exchanges.
const FEW: f64 = 10_000.0;
/// Rows weighed in the enumeration before it gives up.
const EFFORT: usize = 3_000_000;

/// Takes the k bands of greatest value.
pub(super) struct TopBands {
    pub(super) k: usize,
    values: Vec<f64>,
    order: Vec<usize>,
}

impl TopBands {
    pub(super) fn new(k: usize) -> Self {
        Self { k, values: Vec::new(), order: Vec::new() }
    }

    /// g_w of every band.
    fn weigh(&mut self, pairs: &[Pair], certificate: &Certificate) {
        crate::stop::check();
        self.values.clear();
        self.values.resize(pairs.first().map_or(0, Pair::bands), 0.0);
        for ((pair, share), c) in pairs.iter().zip(&certificate.shares).zip(&certificate.coefficients) {
            if *share == 0.0 {
                continue;
            }
            for (value, row) in self.values.iter_mut().zip(pair.rows().chunks(pair.width())) {
                let left = residual(row, c);
                *value += share * left * left;
            }
        }
    }
}

impl Opponent for TopBands {
    fn best(&mut self, pairs: &[Pair], certificate: &Certificate) -> (Vec<Range<usize>>, f64) {
        self.weigh(pairs, certificate);
        let values = &self.values;
        self.order.clear();
        self.order.extend(0..values.len());
        if self.k < values.len() {
            self.order.select_nth_unstable_by(self.k, |a, b| values[*b].total_cmp(&values[*a]));
            self.order.truncate(self.k);
        }
        self.order.sort_unstable();
        let square: f64 = self.order.iter().map(|w| values[*w]).sum();
        (as_filters(&self.order), square + certificate.prior_cost(pairs))
    }
}

fn as_filters(bands: &[usize]) -> Vec<Range<usize>> {
    bands.iter().map(|&w| w..w + 1).collect()
}

/// A choice of bands.
pub(super) struct Chosen {
    pub(super) bands: Vec<usize>,
    /// No choice has a greater (d/required)².
    pub(super) bound_square: f64,
    pub(super) exact: bool,
}

/// The best k bands for the pair that fares worst; all pairs must differ, and k be enough for each.
pub(super) fn choose(pairs: &[Pair], k: usize, rounds: usize) -> Chosen {
    let mut opponent = TopBands::new(k);
    let found = bound(pairs, &mut opponent, rounds);
    let mut exchange = Exchange::new(pairs);
    for (_, selection) in &found.met {
        exchange.improve(selection.iter().map(|filter| filter.start).collect());
    }
    if combinations(pairs.first().map_or(0, Pair::bands), k) > FEW {
        exchange.restart(&found);
    }
    let mut bands = exchange.best.1;
    let mut distance = worst(pairs, &as_filters(&bands)).0;
    let mut exact = found.proves(distance);
    if !exact {
        let mut search = Enumeration::new(pairs, &mut opponent, &found, k, distance * distance);
        search.extend(0, search.prior);
        exact = search.fits.left > 0;
        if let Some(better) = search.best {
            let better_distance = worst(pairs, &as_filters(&better)).0;
            // The enumeration rests on normal equations: believed where the orthogonalised rows agree.
            exact &= better_distance * better_distance >= search.goal * (1.0 - AGREE);
            if better_distance > distance {
                (distance, bands) = (better_distance, better);
            }
        }
    }
    bands.sort_unstable();
    Chosen { bands, bound_square: if exact { distance * distance } else { found.square }, exact }
}

/// Swaps bands as long as that helps the pair that fares worst.
struct Exchange<'a> {
    fits: Fits<'a>,
    /// (d/required)² and bands of the best selection so far.
    best: (f64, Vec<usize>),
}

impl<'a> Exchange<'a> {
    fn new(pairs: &'a [Pair]) -> Self {
        Self { fits: Fits::new(pairs, EXCHANGES * (1 + pairs.len())), best: (f64::NEG_INFINITY, Vec::new()) }
    }

    fn bands(&self) -> usize {
        self.fits.pairs.first().map_or(0, Pair::bands)
    }

    /// Goes on from the best selection with a third of its bands drawn anew, again and again.
    fn restart(&mut self, bound: &Bounded) {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let (count, k) = (self.bands(), self.best.1.len());
        if k == count {
            return;
        }
        while self.fits.left > 0 && !bound.proves(self.best.0.max(0.0).sqrt()) {
            let mut bands = self.best.1.clone();
            for _ in 0..1 + k / 3 {
                let (place, band) = (random.random_range(0..k), random.random_range(0..count));
                if !bands.contains(&band) {
                    bands[place] = band;
                }
            }
            self.fits.spend(1);
            self.improve(bands);
        }
    }

    /// Swaps each band for the best other one until none helps.
    fn improve(&mut self, mut bands: Vec<usize>) {
        let mut taken = vec![false; self.bands()];
        bands.iter().for_each(|&w| taken[w] = true);
        self.fits.solve(bands.iter().copied());
        let mut now = self.fits.least();
        let (mut unchanged, mut place) = (0, 0);
        while unchanged < bands.len() && self.fits.left > 0 {
            self.fits.solve(bands.iter().enumerate().filter(|(i, _)| *i != place).map(|(_, w)| *w));
            let mut best = (now * (1.0 + HELPS), None);
            for w in (0..taken.len()).filter(|w| !taken[*w]) {
                let value = self.fits.least_with(w, best.0);
                if value > best.0 {
                    best = (value, Some(w));
                }
            }
            unchanged += 1;
            if let (value, Some(w)) = best {
                taken[bands[place]] = false;
                taken[w] = true;
                bands[place] = w;
                now = value;
                unchanged = 0;
            }
            place = (place + 1) % bands.len();
        }
        if now > self.best.0 {
            self.best = (now, bands);
        }
    }
}

/// Fits of all pairs to a selection that lacks one band.
struct Fits<'a> {
    pairs: &'a [Pair],
    fits: Vec<Fit>,
    /// Pairs in the order in which they are asked: those that said no last come first.
    order: Vec<usize>,
    /// Rows that may still be weighed.
    left: usize,
}

impl<'a> Fits<'a> {
    fn new(pairs: &'a [Pair], effort: usize) -> Self {
        let fits = vec![Fit::default(); pairs.len()];
        Self { pairs, fits, order: (0..pairs.len()).collect(), left: effort }
    }

    fn spend(&mut self, rows: usize) {
        self.left = self.left.saturating_sub(rows);
    }

    fn solve(&mut self, bands: impl Iterator<Item = usize> + Clone) {
        crate::stop::check();
        for (fit, pair) in self.fits.iter_mut().zip(self.pairs) {
            fit.solve(&pair.gram_of_bands(bands.clone()), pair.width());
        }
    }

    /// Least (d/required)² of the selection as it is.
    fn least(&self) -> f64 {
        self.fits.iter().map(|fit| fit.square).fold(f64::INFINITY, f64::min)
    }

    /// Least (d/required)² with one more band; not worked out to the end where it is not above `goal`.
    #[inline]
    fn least_with(&mut self, band: usize, goal: f64) -> f64 {
        crate::stop::check();
        let mut least = f64::INFINITY;
        for i in 0..self.order.len() {
            let p = self.order[i];
            least = least.min(self.fits[p].with_row(self.pairs[p].row(band)));
            if least <= goal {
                self.order[..=i].rotate_right(1);
                self.spend(i + 1);
                return least;
            }
        }
        self.spend(self.order.len());
        least
    }
}

/// Goes through all selections that might be better than what is known.
struct Enumeration<'a> {
    pairs: &'a [Pair],
    k: usize,
    /// Bands in falling order of their value g at the root, and sums of g in that order.
    order: Vec<usize>,
    values: Vec<f64>,
    sums: Vec<f64>,
    prior: f64,
    /// (d/required)² to beat.
    goal: f64,
    best: Option<Vec<usize>>,
    chosen: Vec<usize>,
    opponent: TopBands,
    /// With no effort left where it was not enough.
    fits: Fits<'a>,
}

impl<'a> Enumeration<'a> {
    fn new(pairs: &'a [Pair], opponent: &mut TopBands, found: &Bounded, k: usize, goal: f64) -> Self {
        opponent.weigh(pairs, &found.certificate);
        let values = opponent.values.clone();
        let mut order: Vec<usize> = (0..values.len()).collect();
        order::descending(&mut order, |b| values[*b]);
        let mut sums = vec![0.0];
        sums.extend(order.iter().scan(0.0, |sum, w| {
            *sum += values[*w];
            Some(*sum)
        }));
        Self {
            pairs,
            k,
            order,
            values,
            sums,
            prior: found.certificate.prior_cost(pairs),
            goal: goal * (1.0 + HELPS),
            best: None,
            chosen: Vec::new(),
            opponent: TopBands::new(k),
            fits: Fits::new(pairs, EFFORT),
        }
    }

    /// All selections that begin with the chosen bands and go on from `position` of the order.
    fn extend(&mut self, position: usize, value: f64) {
        crate::stop::check();
        let missing = self.k - self.chosen.len();
        if missing == 1 {
            return self.last(position, value);
        }
        for at in position..self.order.len().saturating_sub(missing - 1) {
            // With the root's certificate: this band and the next of the order are the best that follow.
            if value + (self.sums[at + missing] - self.sums[at]) <= self.goal || self.fits.left == 0 {
                return;
            }
            self.chosen.push(self.order[at]);
            // With one band missing it costs less to try them all.
            if missing == 2 || self.may_beat(at + 1, missing - 1) {
                self.extend(at + 1, value + self.values[self.order[at]]);
            }
            self.chosen.pop();
        }
    }

    /// The last band of a selection.
    fn last(&mut self, position: usize, value: f64) {
        crate::stop::check();
        self.fits.solve(self.chosen.iter().copied());
        for at in position..self.order.len() {
            let w = self.order[at];
            if value + self.values[w] <= self.goal || self.fits.left == 0 {
                return;
            }
            let square = self.fits.least_with(w, self.goal);
            if square > self.goal {
                self.goal = square * (1.0 + HELPS);
                let mut better = self.chosen.clone();
                better.push(w);
                self.best = Some(better);
            }
        }
    }

    /// Whether a certificate made for the chosen bands leaves room for something better.
    fn may_beat(&mut self, position: usize, missing: usize) -> bool {
        crate::stop::check();
        let mut grams: Vec<Vec<f64>> =
            self.pairs.iter().map(|pair| pair.gram_of_bands(self.chosen.iter().copied())).collect();
        let start = grams.clone();
        // Completed at first with the next of the order, then with the best against the last certificate.
        let mut completion: Vec<usize> = self.order[position..position + missing].to_vec();
        for round in 0..4 {
            let part = 1.0 / f64::from(round + 1);
            for ((gram, start), pair) in grams.iter_mut().zip(&start).zip(self.pairs) {
                let mut new = start.clone();
                for &w in &completion {
                    super::pair::add_square(&mut new, pair.row(w), 1.0);
                }
                gram.iter_mut().zip(&new).for_each(|(g, n)| *g += part * (n - *g));
            }
            let certificate = Certificate::fitted(self.pairs, &grams, 10.0);
            self.opponent.weigh(self.pairs, &certificate);
            self.fits.spend(self.pairs.len() * self.order.len());
            let values = &self.opponent.values;
            let taken: f64 = self.chosen.iter().map(|w| values[*w]).sum();
            let rest = &mut self.opponent.order;
            rest.clear();
            rest.extend_from_slice(&self.order[position..]);
            if missing < rest.len() {
                rest.select_nth_unstable_by(missing, |a, b| values[*b].total_cmp(&values[*a]));
                rest.truncate(missing);
            }
            let more: f64 = rest.iter().map(|w| values[*w]).sum();
            if taken + more + certificate.prior_cost(self.pairs) <= self.goal {
                return false;
            }
            completion.clone_from(rest);
        }
        true
    }
}

/// Number of ways to take k of n.
pub(super) fn combinations(n: usize, k: usize) -> f64 {
    (0..k).map(|i| (n as f64 - i as f64) / (i + 1) as f64).product()
}
