//! Contrast-limited adaptive equalisation of an image (CLAHE).
//!
//! The image is cut into tiles. Each has a histogram of 256 bins of equal width between the least and the largest value of the whole
//! image, of which no bin holds more than a limit times the mean one: what is beyond it is spread over all bins, so that the noise of
//! a plain part is not made much of. A tile sends a value to the share of its histogram below it, linear within a bin; a pixel takes
//! what the four tiles around it say, linear between their centres. Values that are no numbers are left out and stay what they are.
//!
//! An infinite limit and one tile are the plain equalisation of the histogram. An image of one value becomes ½.
//!
//! Source: Zuiderveld, Graphics Gems IV, 474 (1994); the paper's `adapthisteq` has 8 × 8 tiles and a limit of 0.01 of all pixels of a
//! tile beyond the mean bin of 1/256.

/// Bins of a histogram.
const BINS: usize = 256;
/// Tiles along each side of an image that is large enough.
pub(super) const TILES: usize = 8;
/// Fewest pixels along a side of a tile: with less a histogram says nothing.
const SMALLEST: usize = 16;
/// Most that a bin holds, as a multiple of the mean bin: 1 + 0.01 × 256, rounded.
pub(super) const LIMIT: f64 = 3.5;

/// How an image is cut, and what a bin holds at most as a multiple of the mean one.
#[derive(Debug, Clone, Copy)]
pub struct Clahe {
    pub(super) tiles: [usize; 2],
    pub(super) limit: f64,
}

/// The maps from values to brightness that an image has been equalised by, one for each pixel.
#[derive(Debug, Clone)]
pub struct Curves {
    rows: usize,
    columns: usize,
    tiles: [usize; 2],
    ends: [f64; 2],
    /// Of each tile, the shares below the edges of its bins; nothing of an empty one.
    shares: Vec<Vec<f64>>,
}

impl Curves {
    fn place(&self, value: f64) -> f64 {
        let [low, high] = self.ends;
        (value - low) / (high - low) * BINS as f64
    }

    /// What a tile says of a value: along its curve, which a tile without a pixel does not have.
    fn says(&self, row: usize, column: usize, value: f64) -> Option<f64> {
        let curve = self.shares.get(row * self.tiles[1] + column).filter(|curve| !curve.is_empty())?;
        let at = self.place(value).clamp(0.0, BINS as f64);
        let bin = (at as usize).min(BINS - 1);
        let (from, to) = (curve.get(bin)?, curve.get(bin + 1)?);
        Some(from + (at - bin as f64) * (to - from))
    }

    /// Brightness, from 0 to 1, of a value at the pixel `i`, counted row after row; a value that is no number stays what it is.
    #[must_use]
    pub fn at(&self, i: usize, value: f64) -> f64 {
        let [low, high] = self.ends;
        if !value.is_finite() {
            return value;
        }
        if low >= high {
            return 0.5;
        }
        let [down, across] = self.tiles;
        let (upper, lower, downwards) = between(i / self.columns, self.rows, down);
        let (left, right, sideways) = between(i % self.columns, self.columns, across);
        let corners = [
            (upper, left, (1.0 - downwards) * (1.0 - sideways)),
            (upper, right, (1.0 - downwards) * sideways),
            (lower, left, downwards * (1.0 - sideways)),
            (lower, right, downwards * sideways),
        ];
        let said = corners.iter().filter_map(|(row, column, w)| Some((self.says(*row, *column, value)?, w)));
        let (sum, weight) = said.fold((0.0, 0.0), |(sum, all), (x, w)| (sum + w * x, all + w));
        // A pixel is in a tile that has it, at least.
        if weight > 0.0 { sum / weight } else { 0.5 }
    }

    /// Values between `ends` at which the brightness of the pixel `i` passes each of `levels`, which rise.
    #[must_use]
    pub fn crossings(&self, i: usize, [from, to]: [f64; 2], levels: &[f64]) -> Vec<f64> {
        let [low, high] = self.ends;
        let knot = |bin: usize| low + (high - low) * bin as f64 / BINS as f64;
        let bins = |value: f64| self.place(value).clamp(0.0, BINS as f64);
        let knots = (bins(from).floor() as usize..=bins(to).ceil() as usize).map(knot);
        let inside = knots.filter(|x| *x > from && *x < to);
        let mut before = (from, self.at(i, from));
        let mut found = Vec::new();
        let mut next = levels.partition_point(|level| *level <= before.1);
        for x in inside.chain([to]) {
            let here = (x, self.at(i, x));
            while let Some(level) = levels.get(next).filter(|level| **level <= here.1) {
                found.push(before.0 + (level - before.1) / (here.1 - before.1) * (here.0 - before.0));
                next += 1;
            }
            before = here;
        }
        found
    }
}

impl Clahe {
    /// For an image of so many rows and columns.
    #[must_use]
    pub fn of(rows: usize, columns: usize) -> Self {
        Self { tiles: [rows, columns].map(|side| (side / SMALLEST).clamp(1, TILES)), limit: LIMIT }
    }

    /// The image `[row][column]` with values from 0 to 1.
    #[must_use]
    pub fn equalised(self, values: &[f64], columns: usize) -> Vec<f64> {
        let curves = self.curves(values, columns);
        values.iter().enumerate().map(|(i, value)| curves.at(i, *value)).collect()
    }

    /// The maps that equalise an image `[row][column]`.
    #[must_use]
    pub fn curves(self, values: &[f64], columns: usize) -> Curves {
        let finite = values.iter().copied().filter(|value| value.is_finite());
        let ends = finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], x| [l.min(x), h.max(x)]);
        let mut tiles = self.tiles(values.len().checked_div(columns).unwrap_or(0), columns, ends);
        tiles.count(0, values.iter().copied());
        tiles.curves()
    }

    /// Counts an image of so many rows and columns, whose values lie between `ends`, part by part.
    #[must_use]
    pub fn tiles(self, rows: usize, columns: usize, ends: [f64; 2]) -> Tiles {
        let [down, across] = self.tiles.map(|count| count.max(1));
        let [low, high] = ends;
        let counts = if low < high { vec![vec![0.0; BINS]; down * across] } else { Vec::new() };
        let curves = Curves { rows, columns, tiles: [down, across], ends, shares: Vec::new() };
        Tiles { clahe: self, curves, counts }
    }

    /// Shares of a histogram below each edge of its bins, once it is limited; nothing of an empty one.
    fn below(self, mut bins: Vec<f64>) -> Vec<f64> {
        let total: f64 = bins.iter().sum();
        if total <= 0.0 {
            return Vec::new();
        }
        let most = self.limit.max(1.0) * total / BINS as f64;
        let mut beyond = 0.0;
        for bin in &mut bins {
            beyond += (*bin - most).max(0.0);
            *bin = bin.min(most);
        }
        let more = beyond / BINS as f64;
        let sums = bins.iter().scan(0.0, |sum, bin| {
            *sum += bin + more;
            Some(*sum / total)
        });
        std::iter::once(0.0).chain(sums).collect()
    }
}

/// The histograms of the tiles of an image.
#[derive(Debug, Clone)]
pub struct Tiles {
    clahe: Clahe,
    curves: Curves,
    /// `[tile][bin]`; empty for an image of one value.
    counts: Vec<Vec<f64>>,
}

impl Tiles {
    /// Counts values from the pixel `first` on, counted row after row.
    pub fn count(&mut self, first: usize, values: impl Iterator<Item = f64>) {
        let Curves { rows, columns, tiles: [down, across], .. } = self.curves;
        for (i, value) in (first..).zip(values).filter(|(_, value)| value.is_finite()) {
            let (row, column) = (i / columns * down / rows, i % columns * across / columns);
            let bin = (self.curves.place(value) as usize).min(BINS - 1);
            let count = self.counts.get_mut(row * across + column).and_then(|tile| tile.get_mut(bin));
            count.into_iter().for_each(|count| *count += 1.0);
        }
    }

    /// The maps that equalise the image.
    #[must_use]
    pub fn curves(self) -> Curves {
        let shares = self.counts.into_iter().map(|tile| self.clahe.below(tile)).collect();
        Curves { shares, ..self.curves }
    }
}

/// The tiles before and after a pixel, and how far from the centre of the first to that of the second it is.
fn between(at: usize, pixels: usize, tiles: usize) -> (usize, usize, f64) {
    let place = (at as f64 + 0.5) / pixels as f64 * tiles as f64 - 0.5;
    let before = (place.max(0.0) as usize).min(tiles - 1);
    let after = (before + 1).min(tiles - 1);
    (before, after, if after > before { (place - before as f64).clamp(0.0, 1.0) } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(count: usize) -> Vec<f64> {
        let mut state = 1u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        (0..count).map(|_| next().powi(3) + 1e-3 * next()).collect()
    }

    #[test]
    fn a_flat_image_stays_flat() {
        let flat = vec![7.0; 64 * 64];
        assert!(Clahe::of(64, 64).equalised(&flat, 64).iter().all(|x| *x == 0.5));
        // A flat part of an image that is not flat: all of it becomes one value in each tile, and no step at their edges.
        let mut part = flat;
        part[0] = 0.0;
        part[1] = 14.0;
        let found = Clahe::of(64, 64).equalised(&part, 64);
        let (low, high) = found[2..].iter().fold((1.0f64, 0.0f64), |(l, h), x| (l.min(*x), h.max(*x)));
        assert!(high - low < 0.01, "{low} {high}");
        // What has no value keeps none, and all that has one is between 0 and 1.
        part[5] = f64::NAN;
        let found = Clahe::of(64, 64).equalised(&part, 64);
        assert!(found[5].is_nan() && found.iter().filter(|x| x.is_nan()).count() == 1);
        assert!(Clahe::of(1, 1).equalised(&[f64::NAN], 1)[0].is_nan());
        assert!(Clahe::of(0, 0).equalised(&[], 0).is_empty());
    }

    /// Ranks are what plain equalisation gives, but for the width of a bin.
    #[test]
    fn one_tile_without_limit_gives_ranks() {
        let values = noise(4096);
        let found = Clahe { tiles: [1, 1], limit: f64::INFINITY }.equalised(&values, 64);
        let mut sorted = values.clone();
        sorted.sort_by(f64::total_cmp);
        let (low, high) = (sorted[0], sorted[4095]);
        let rank = |value: f64| sorted.partition_point(|x| *x <= value) as f64 / 4096.0;
        for (value, found) in values.iter().zip(found) {
            // At the edges of its bin the value has exactly the ranks of those.
            let bin = (high - low) / 256.0;
            let edge = low + ((value - low) / bin).floor() * bin;
            assert!((rank(edge - 1e-12) - 1e-3..=rank(edge + bin) + 1e-3).contains(&found), "{value}");
        }
        // Of evenly spread values it is the identity.
        let even: Vec<f64> = (0..4096).map(|i| f64::from(i) / 4095.0).collect();
        let found = Clahe { tiles: [1, 1], limit: f64::INFINITY }.equalised(&even, 64);
        assert!(even.iter().zip(found).all(|(x, y)| (x - y).abs() < 1e-3));
    }

    /// Within a tile, and where all tiles are alike, more is never shown as less; no slope exceeds the limit.
    #[test]
    fn more_is_never_shown_as_less() {
        let tile = noise(32 * 32);
        let values: Vec<f64> = (0..64 * 64).map(|i| tile[i / 64 % 32 * 32 + i % 64 % 32]).collect();
        for limit in [1.0, LIMIT, f64::INFINITY] {
            let found = Clahe { tiles: [2, 2], limit }.equalised(&values, 64);
            let mut order: Vec<usize> = (0..values.len()).collect();
            order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
            let span = values[order[4095]] - values[order[0]];
            for pair in order.windows(2) {
                let (apart, shown) = (values[pair[1]] - values[pair[0]], found[pair[1]] - found[pair[0]]);
                // What is beyond the limit adds at most as much as an even spread.
                let most = if limit.is_finite() { (limit + 1.0) * apart / span } else { 1.0 };
                assert!(shown >= -1e-12 && shown <= most + 1e-12, "{limit}");
            }
        }
    }

    /// An equalised image in levels tells no more of a pixel's count than the count, and as much as its levels' probabilities say; the
    /// standard deviation of the image rises all the same. The probabilities are sums over the counts, one by one.
    #[test]
    fn equalisation_raises_contrast_and_never_information() {
        const LEVELS: usize = 256;
        let top = (LEVELS - 1) as f64;
        let steps: Vec<f64> = (1..LEVELS).map(|k| (k as f64 - 0.5) / top).collect();
        for seed in 0..4_usize {
            // Counts about a few hundred thousand with a weak texture, and a bright corner that takes the scale.
            let image: Vec<f64> = noise(64 * 64 + seed)[seed..]
                .iter()
                .enumerate()
                .map(|(i, x)| 3e5 + 4e3 * x + if i < 200 { 2e5 } else { 0.0 })
                .collect();
            let curves = Clahe::of(64, 64).curves(&image, 64);
            for i in [1000 + 97 * seed, 2222, 3000, 4000] {
                let (mean, sigma) = (image[i], image[i].sqrt());
                let ends = [mean - 8.0 * sigma, mean + 8.0 * sigma];
                let edges = curves.crossings(i, ends, &steps);
                assert!(edges.windows(2).all(|pair| pair[0] <= pair[1]));
                let share = hadar::ranging::levels::share_left(mean, sigma, &edges);
                let of = |mean: f64| {
                    let mut p = [0.0; LEVELS];
                    let step = 0.01 * sigma;
                    for k in -900..=900 {
                        let n = image[i] + f64::from(k) * step;
                        let level = (curves.at(i, n) * top).round() as usize;
                        p[level] += (-0.5 * ((n - mean) / sigma).powi(2)).exp() * step
                            / (sigma * std::f64::consts::TAU.sqrt());
                    }
                    p
                };
                let h = 0.02 * sigma;
                let (before, here, after) = (of(mean - h), of(mean), of(mean + h));
                let each = (0..LEVELS).filter(|k| here[*k] > 1e-12);
                let j: f64 = each.map(|k| (after[k] - before[k]).powi(2) / (4.0 * h * h * here[k])).sum();
                let expected = j * sigma * sigma;
                assert!((share / expected - 1.0).abs() < 0.02, "{i}: {share} {expected}");
                assert!((0.0..=1.0).contains(&share));
            }
            let deviation = |image: &[f64]| {
                let own = &image[2048..];
                let mean = own.iter().sum::<f64>() / own.len() as f64;
                (own.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / own.len() as f64).sqrt()
            };
            let span = image.iter().fold(0.0_f64, |most, x| most.max(*x)) - 3e5;
            let shown = Clahe::of(64, 64).equalised(&image, 64);
            assert!(deviation(&shown) > 2.0 * deviation(&image) / span);
        }
    }

    /// Two halves of different brightness each get the whole scale.
    #[test]
    fn tiles_bring_out_what_is_in_them() {
        let values: Vec<f64> = (0..64 * 64)
            .map(|i| if i % 64 < 32 { 0.1 } else { 0.9 } + 0.02 * f64::from(u8::from(i / 64 % 2 == 0)))
            .collect();
        let contrast = |clahe: Clahe| {
            let found = clahe.equalised(&values, 64);
            (found[3] - found[64 + 3]).abs()
        };
        let plain = 0.02 / 0.82;
        assert!(contrast(Clahe { tiles: [2, 2], limit: 20.0 }) > 3.0 * plain);
    }
}
