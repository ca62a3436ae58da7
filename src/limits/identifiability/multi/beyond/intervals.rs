//! The range of temperatures cut into intervals, eight side by side, and their products with a target. Symbols as in [`super`].
//!
//! Between the temperatures T₀ < T₁ of an interval b lies within ±h of p + σd by its chord and tangents. In hcν/kT, which falls as T grows,
//! ν the middle of the bands, an interval is so wide that of a target's own counts its chord misses [`MISSED`] of the required distance once
//! it is cut into eight.

use super::kernels::Products;
use crate::identifiability::nearest::{Chord, chord};
use crate::planck;
use crate::simd::{Chunk, LANES};
use crate::spectrum::Bands;
use crate::units::SECOND_RADIATION_CM_K;

/// Share of the required distance that chords of the finer intervals may miss of a target's own counts.
const MISSED: f64 = 0.1;
/// hcν/kT at the hot end of the intervals, ν the middle of the bands, and the widest of the finer ones.
const HOT: f64 = 0.35;
const WIDEST: f64 = 0.1;
/// The hot end of an interval over its cold one at most, and intervals at most.
const RATIO: f64 = 1.35;
const MOST_INTERVALS: usize = 512;
/// Share of the required distance that what is colder than all intervals may send, and hcν/kT beyond which radiances underflow.
const DARK: f64 = 0.05;
const DARKEST: f64 = 300.0;
/// A blackbody in counts.
#[derive(Clone, Copy)]
pub(super) struct Curve<'c> {
    pub(super) bands: &'c Bands,
    /// Counts per radiance of each band.
    pub(super) scale: &'c [f64],
}

/// All intervals, the coldest first.
pub(super) struct Intervals {
    pub(super) count: usize,
    /// In eights, and each one cut into eight where that is of use.
    pub(super) coarse: Vec<Eight>,
    pub(super) fine: Vec<Eight>,
    /// The blackbody at the cold end of each, and at the hot end of the last.
    pub(super) ends: Vec<Vec<f64>>,
    /// Whether nothing in the range is warmer.
    pub(super) is_closed: bool,
}

/// Eight intervals side by side, of each band p, d and h.
pub(super) struct Eight {
    low: Vec<Chunk>,
    rise: Vec<Chunk>,
    half: Vec<Chunk>,
}

/// p, d and h of one interval.
struct Interval {
    low: Vec<f64>,
    rise: Vec<f64>,
    half: Vec<f64>,
}

impl Curve<'_> {
    /// Counts and their slopes.
    fn at(&self, temperature_k: f64) -> [Vec<f64>; 2] {
        let nodes = self.bands.nodes_cm1();
        let [mut value, mut slope] = [(); 2].map(|()| vec![0.0; nodes.len()]);
        planck::photon_radiance_and_slope_into(nodes, temperature_k, &mut value, &mut slope);
        for spectrum in [&mut value, &mut slope] {
            spectrum.iter_mut().zip(self.scale).for_each(|(x, scale)| *x *= scale);
        }
        [value, slope]
    }

    fn between(&self, [cold_k, hot_k]: [f64; 2]) -> Interval {
        let [cold, hot] = [self.at(cold_k), self.at(hot_k)];
        let [mut low, mut rise, mut half] = [(); 3].map(|()| vec![0.0; self.scale.len()]);
        chord(Chord {
            width: hot_k - cold_k,
            more: 0.0,
            cold: [&cold[0], &cold[1]],
            hot: [&hot[0], &hot[1]],
            low: &mut low,
            rise: &mut rise,
            half: &mut half,
        });
        Interval { low, rise, half }
    }

    /// hcν/kT of the middle of the bands, times T.
    fn middle_k(&self) -> f64 {
        let (first, last) = self.bands.range_cm1();
        SECOND_RADIATION_CM_K * 0.5 * (first + last)
    }
}

impl Interval {
    /// All between so many counts and none.
    fn below(counts: &[f64]) -> Self {
        let half: Vec<f64> = counts.iter().map(|b| 0.5 * b).collect();
        Self { low: half.clone(), rise: vec![0.0; counts.len()], half }
    }
}

impl Intervals {
    /// Of the one temperature at which a blackbody sends so many counts.
    pub(super) fn at(counts: &[f64]) -> Self {
        let none = vec![0.0; counts.len()];
        let point = Interval { low: counts.to_vec(), rise: none.clone(), half: none };
        Self {
            count: 1,
            coarse: vec![Eight::of(&[point])],
            fine: Vec::new(),
            ends: Vec::new(),
            is_closed: true,
        }
    }

    /// Of a range, for targets that as blackbodies send the counts `own`; `None` if it takes too many.
    pub(super) fn of(curve: Curve<'_>, range_k: [f64; 2], own: &[f64], required: f64) -> Option<Self> {
        let [lowest_k, highest_k] = range_k;
        let mut temperatures_k = temperatures(curve, range_k, own, required)?;
        let hottest_k = temperatures_k[0];
        temperatures_k.reverse();
        let coldest_k = temperatures_k[0];
        let is_closed = hottest_k >= highest_k;
        let [coldest, _] = curve.at(coldest_k);
        if temperatures_k.len() == 1 && coldest_k <= lowest_k {
            return Some(Self {
                is_closed,
                ends: vec![vec![0.0; coldest.len()], coldest.clone()],
                ..Self::at(&coldest)
            });
        }
        let (mut intervals, mut fine, mut ends) = (Vec::new(), Vec::new(), Vec::new());
        if coldest_k > lowest_k {
            fine.push(Eight::of(&[Interval::below(&coldest)]));
            ends.push(vec![0.0; coldest.len()]);
            intervals.push(Interval::below(&coldest));
        }
        for pair in temperatures_k.windows(2) {
            crate::stop::check();
            let [cold_k, hot_k] = [pair[0], pair[1]];
            let end = |i: usize| {
                if i == LANES { hot_k } else { cold_k + (hot_k - cold_k) * i as f64 / LANES as f64 }
            };
            let parts: Vec<Interval> = (0..LANES).map(|i| curve.between([end(i), end(i + 1)])).collect();
            fine.push(Eight::of(&parts));
            intervals.push(curve.between([cold_k, hot_k]));
            ends.push(curve.at(cold_k)[0].clone());
        }
        ends.push(curve.at(hottest_k)[0].clone());
        let coarse = intervals.chunks(LANES).map(Eight::of).collect();
        Some(Self { count: intervals.len(), coarse, fine, ends, is_closed })
    }
}

/// Where intervals end, the hottest first: from where next to nothing is sent, or the range begins, to its end or [`HOT`].
fn temperatures(
    curve: Curve<'_>,
    [lowest_k, highest_k]: [f64; 2],
    own: &[f64],
    required: f64,
) -> Option<Vec<f64>> {
    let middle_k = curve.middle_k();
    let all: f64 = own.iter().sum();
    // A chord misses (Δx)²/8 of the counts, which of the distance is half that share of their root.
    let finest = (16.0 * MISSED * required / all.sqrt()).sqrt().min(WIDEST);
    let step = LANES as f64 * finest;
    // Weights are at most 1/R².
    let is_dark = |temperature_k: f64| {
        let [counts, _] = curve.at(temperature_k);
        counts.iter().map(|b| b * b).sum::<f64>().sqrt() <= DARK * required * required
    };
    let mut cold_k = highest_k.min(middle_k / HOT).max(lowest_k);
    let mut temperatures_k = vec![cold_k];
    while cold_k > lowest_k && !is_dark(cold_k) {
        crate::stop::check();
        let x = middle_k / cold_k;
        if temperatures_k.len() > MOST_INTERVALS || x > DARKEST {
            return None;
        }
        cold_k = (middle_k / (x + step).min(x * RATIO)).max(lowest_k);
        temperatures_k.push(cold_k);
    }
    Some(temperatures_k)
}

impl Eight {
    /// Of at most eight intervals; where there are fewer the last one stands again.
    fn of(some: &[Interval]) -> Self {
        let side = |of: fn(&Interval) -> &[f64]| -> Vec<Chunk> {
            let bands = some.first().map_or(0, |one| of(one).len());
            (0..bands).map(|w| std::array::from_fn(|k| of(&some[k.min(some.len() - 1)])[w])).collect()
        };
        Self { low: side(|one| &one.low), rise: side(|one| &one.rise), half: side(|one| &one.half) }
    }

    /// Its products with a target, band by band, from r, x − N, a and x: N′ − N = e′(P + σd) + (1 − e′)V′a + (x − N) with P = p − x.
    pub(super) fn products(&self, [weight, rest, light, known]: [&[f64]; 4]) -> Vec<Products> {
        crate::stop::check();
        let times =
            |factor: f64, a: Chunk, b: Chunk| -> Chunk { std::array::from_fn(|k| factor * a[k] * b[k]) };
        let one = [1.0; LANES];
        let of_band = |w: usize| {
            let (r, rest, light) = (weight[w], rest[w], light[w]);
            let (rise, half) = (self.rise[w], self.half[w]);
            let above: Chunk = std::array::from_fn(|k| self.low[w][k] - known[w]);
            [
                times(r, rise, rise),
                times(r, rise, above),
                times(r, above, above),
                times(r, half, half),
                times(r * light, rise, one),
                times(r * light, above, one),
                times(r * rest, rise, one),
                times(2.0 * r * rest, above, one),
            ]
        };
        (0..weight.len()).map(of_band).collect()
    }
}
