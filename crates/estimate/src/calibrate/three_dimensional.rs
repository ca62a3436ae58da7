//! Noise in three dimensions out of frames of one scene: seven variances by the analysis of variance of a crossed random model.
//!
//! y_tvh = μ + T + V + H + TV + TH + VH + TVH, independent deviations of frame t of N, row v of h, column c of w, band by band. With the
//! mean squares MS of their effects (each of its degrees of freedom, Π (n − 1) over its own letters)
//!
//!   E MS_TVH = σ²_TVH,  E MS_TV = σ²_TVH + w σ²_TV,  E MS_TH = σ²_TVH + h σ²_TH,  E MS_VH = σ²_TVH + N σ²_VH,
//!   E MS_V = σ²_TVH + w σ²_TV + N σ²_VH + N w σ²_V, and so on,
//!
//! every variance is a sum of mean squares with known signs, unbiased, also below 0 where there is none. Mean squares are means over
//! the bands; the 95 % intervals are those of Graybill and Wang for such sums, with the degrees of freedom of one band, since a
//! pattern may be common to all. A scene that is not the same everywhere is in V, H and VH.
//!
//! Assumes every sample there and Gaussian deviations. Source: J. D'Agostino, C. Webb, Proc. SPIE 1488, 110 (1991); F. A. Graybill, C.-M. Wang,
//! J. Am. Stat. Assoc. 75, 869 (1980) (intervals of linear combinations of mean squares).

use hadar::cube::{Rows, Sample, Shape};
use hadar::error::{Error, Result};
use hadar::statistics::chi_square_quantile;

/// Probability beyond either end of an interval.
const TAIL: f64 = 0.025;

/// One variance.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Component {
    /// Letters of the dimensions along which it changes: `tvh` is the noise of a pixel.
    pub of: &'static str,
    /// The variance, unit² of the cube; below 0 by chance where there is none.
    pub variance: f64,
    /// Ends of its 95 % interval.
    pub interval: [f64; 2],
}

impl Component {
    /// The deviation with the ends of its interval.
    #[must_use]
    pub fn sigma(&self) -> [f64; 3] {
        [self.variance, self.interval[0], self.interval[1]].map(|var| var.max(0.0).sqrt())
    }
}

/// Letters in the order of the components.
const OF: [&str; 7] = ["tvh", "vh", "v", "h", "tv", "th", "t"];
/// Which mean squares a variance is made of, in the same order, and with which signs.
const SIGNS: [[f64; 7]; 7] = [
    [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [-1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, -1.0, 1.0, 0.0, -1.0, 0.0, 0.0],
    [1.0, -1.0, 0.0, 1.0, 0.0, -1.0, 0.0],
    [-1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
    [-1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0],
    [1.0, 0.0, 0.0, 0.0, -1.0, -1.0, 1.0],
];

/// The seven variances of two or more frames of two rows and columns or more; `None` of fewer, or where samples are missing.
///
/// # Errors
/// Frames of different shapes, or that cannot be read.
pub fn three_dimensional<S: Sample>(frames: &[&dyn Rows<S>]) -> Result<Option<[Component; 7]>> {
    let Some(shape) = frames.first().map(|frame| frame.shape()) else { return Ok(None) };
    if frames.iter().any(|frame| frame.shape() != shape) {
        return Err(Error::malformed("frames of different shapes", "give frames of one shape"));
    }
    if frames.len() < 2 || shape.rows() < 2 || shape.columns() < 2 {
        return Ok(None);
    }
    Sums::of(frames, shape)?.map(|sums| sums.components()).transpose()
}

/// Mean squares of the effects, in the order of [`OF`].
struct Sums {
    squares: [f64; 7],
    freedom: [f64; 7],
    /// Samples over which each component's deviation is the same.
    alike: [f64; 7],
}

impl Sums {
    fn of<S: Sample>(frames: &[&dyn Rows<S>], shape: Shape) -> Result<Option<Self>> {
        let (times, rows, columns, bands) = (frames.len(), shape.rows(), shape.columns(), shape.bands());
        let line = columns * bands;
        let [t, v, h] = [times as f64, rows as f64, columns as f64];
        let mut buffer = Vec::new();
        // Samples of one row in all frames, less the first one of its band, so that sums keep their digits.
        let mut first: Vec<f64> = Vec::new();
        let mut read = |row: usize, lines: &mut Vec<f64>, first: &mut Vec<f64>| -> Result<bool> {
            lines.clear();
            for frame in frames {
                let samples = frame.read(row..row + 1, &mut buffer)?;
                if first.is_empty() {
                    first.extend(samples[..bands].iter().map(|sample| (*sample).into()));
                }
                lines.extend(
                    samples
                        .iter()
                        .enumerate()
                        .map(|(i, sample)| -> f64 { (*sample).into() - first[i % bands] }),
                );
            }
            Ok(lines.iter().all(|sample| sample.is_finite()))
        };
        let mut lines = Vec::with_capacity(times * line);
        // Means over rows of every frame and column, and over columns of every frame and row.
        let (mut of_th, mut of_tv) = (vec![0.0; times * line], vec![0.0; times * rows * bands]);
        for row in 0..rows {
            if !read(row, &mut lines, &mut first)? {
                return Ok(None);
            }
            for (i, sample) in lines.iter().enumerate() {
                of_th[i] += sample / v;
                let (time, band) = (i / line, i % bands);
                of_tv[(time * rows + row) * bands + band] += sample / h;
            }
        }
        let mean_over = |values: &[f64], keep: &dyn Fn(usize) -> usize, kept: usize, count: f64| {
            let mut means = vec![0.0; kept];
            values.iter().enumerate().for_each(|(i, value)| means[keep(i)] += value / count);
            means
        };
        let of_t = mean_over(&of_tv, &|i| i / (rows * bands) * bands + i % bands, times * bands, v);
        let of_v = mean_over(&of_tv, &|i| i % (rows * bands), rows * bands, t);
        let of_h = mean_over(&of_th, &|i| i % line, line, t);
        let mean = mean_over(&of_t, &|i| i % bands, bands, t);
        let band = |i: usize| mean[i % bands];
        let mut sums = [0.0; 7];
        sums[2] = t * h * of_v.iter().enumerate().map(|(i, m)| (m - band(i)).powi(2)).sum::<f64>();
        sums[3] = t * v * of_h.iter().enumerate().map(|(i, m)| (m - band(i)).powi(2)).sum::<f64>();
        sums[6] = v * h * of_t.iter().enumerate().map(|(i, m)| (m - band(i)).powi(2)).sum::<f64>();
        let of_time = |i: usize, each: usize| of_t[i / (each * bands) * bands + i % bands];
        let tv =
            of_tv.iter().enumerate().map(|(i, m)| m - of_time(i, rows) - of_v[i % (rows * bands)] + band(i));
        sums[4] = h * tv.map(|effect| effect * effect).sum::<f64>();
        let th = of_th.iter().enumerate().map(|(i, m)| m - of_time(i, columns) - of_h[i % line] + band(i));
        sums[5] = v * th.map(|effect| effect * effect).sum::<f64>();
        for row in 0..rows {
            read(row, &mut lines, &mut first)?;
            let of_vh = mean_over(&lines, &|i| i % line, line, t);
            let effect = |i: usize| of_vh[i] - of_v[row * bands + i % bands] - of_h[i] + band(i);
            sums[1] += t * (0..line).map(|i| effect(i).powi(2)).sum::<f64>();
            for (i, sample) in lines.iter().enumerate() {
                let (time, band_of) = (i / line, i % bands);
                // What is left of the sample beside all means of two and of one dimension.
                let left = sample - of_tv[(time * rows + row) * bands + band_of] - of_th[i] - of_vh[i % line]
                    + of_t[time * bands + band_of]
                    + of_v[row * bands + band_of]
                    + of_h[i % line]
                    - mean[band_of];
                sums[0] += left * left;
            }
        }
        let [ft, fv, fh] = [t - 1.0, v - 1.0, h - 1.0];
        let freedom = [ft * fv * fh, fv * fh, fv, fh, ft * fv, ft * fh, ft];
        let squares = std::array::from_fn(|i| sums[i] / (freedom[i] * bands as f64));
        let alike = [1.0, t, t * h, t * v, h, v, v * h];
        Ok(Some(Self { squares, freedom, alike }))
    }

    fn components(&self) -> Result<[Component; 7]> {
        let mut ends = [[0.0; 2]; 7];
        for (ends, freedom) in ends.iter_mut().zip(self.freedom) {
            *ends = [chi_square_quantile(TAIL, freedom)?, chi_square_quantile(1.0 - TAIL, freedom)?];
        }
        Ok(std::array::from_fn(|i| {
            let signs = SIGNS[i];
            let variance: f64 = signs.iter().zip(&self.squares).map(|(sign, ms)| sign * ms).sum();
            let [mut below, mut above] = [0.0, 0.0];
            for ((sign, ms), [low, high]) in signs.iter().zip(&self.squares).zip(ends) {
                // How far the expectation of a mean square may be below it, and above it.
                let (less, more) = (ms * (1.0 - 1.0 / high), ms * (1.0 / low - 1.0));
                let (down, up) = if *sign > 0.0 { (less, more) } else { (more, less) };
                below += (sign * down).powi(2);
                above += (sign * up).powi(2);
            }
            let interval = [variance - below.sqrt(), variance + above.sqrt()];
            Component {
                of: OF[i],
                variance: variance / self.alike[i],
                interval: interval.map(|end| end / self.alike[i]),
            }
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hadar::cube::MemoryCube;
    use rand::SeedableRng;
    use rand::rngs::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    /// Frames with deviations of all seven kinds, of known size; the sizes of `sigma` are in the order of [`OF`].
    fn drawn(seed: u64, [times, rows, columns, bands]: [usize; 4], sigma: [f64; 7]) -> Vec<MemoryCube<f64>> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut normals = |count: usize, sigma: f64| -> Vec<f64> {
            (0..count).map(|_| -> f64 { StandardNormal.sample(&mut random) }).map(|z| sigma * z).collect()
        };
        let vh = normals(rows * columns * bands, sigma[1]);
        let v = normals(rows * bands, sigma[2]);
        let h = normals(columns * bands, sigma[3]);
        (0..times)
            .map(|_| {
                let (tv, th, t) = (
                    normals(rows * bands, sigma[4]),
                    normals(columns * bands, sigma[5]),
                    normals(bands, sigma[6]),
                );
                let own = normals(rows * columns * bands, sigma[0]);
                let sample = |i: usize| {
                    let (band, column, row) = (i % bands, i / bands % columns, i / (bands * columns));
                    1e4 * (1.0 + band as f64)
                        + own[i]
                        + vh[i]
                        + v[row * bands + band]
                        + h[column * bands + band]
                        + tv[row * bands + band]
                        + th[column * bands + band]
                        + t[band]
                };
                let samples = (0..rows * columns * bands).map(sample).collect();
                MemoryCube::new(Shape::new(rows, columns, bands).unwrap(), samples).unwrap()
            })
            .collect()
    }

    fn found(frames: &[MemoryCube<f64>]) -> Option<[Component; 7]> {
        let rows: Vec<&dyn Rows<f64>> = frames.iter().map(|frame| frame as &dyn Rows<f64>).collect();
        three_dimensional(&rows).unwrap()
    }

    /// The sums of squares of a small table by hand: 2 frames of 2 × 2 pixels in one band. y = 1..8 is t, v and h alone: effects ±2, ±1, ±0.5.
    #[test]
    fn a_table_by_hand() {
        let shape = Shape::new(2, 2, 1).unwrap();
        let frames =
            [[1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 7.0, 8.0]].map(|f| MemoryCube::new(shape, f.to_vec()).unwrap());
        let all = found(&frames).unwrap();
        // MS_t = 8 · 4, MS_v = 8 · 1, MS_h = 8 · 0.25; all others 0.
        let exact = [0.0, 0.0, 8.0 / 4.0, 2.0 / 4.0, 0.0, 0.0, 32.0 / 4.0];
        for (one, exact) in all.iter().zip(exact) {
            assert!((one.variance - exact).abs() < 1e-12, "{one:?}");
        }
    }

    /// 95 % of the intervals hold the truth: of 7 × 200, with 4 deviations; and the variances are right on average.
    #[test]
    fn intervals_hold_the_truth() {
        let sigma = [3.0, 1.0, 0.8, 0.6, 0.7, 0.5, 0.9];
        let (draws, mut held, mut means) = (200, [0u32; 7], [0.0; 7]);
        for seed in 0..draws {
            let all = found(&drawn(seed, [12, 20, 16, 1], sigma)).unwrap();
            for (i, one) in all.iter().enumerate() {
                let truth = sigma[i] * sigma[i];
                held[i] += u32::from(one.interval[0] <= truth && truth <= one.interval[1]);
                means[i] += one.variance / f64::from(draws as u32);
            }
        }
        for i in 0..7 {
            let share = f64::from(held[i]) / f64::from(draws as u32);
            let chance = 4.0 * (0.05f64 * 0.95 / 200.0).sqrt();
            assert!(share > 0.95 - chance, "{}: {share}", OF[i]);
            // And hardly more than that: such sums are known to hold a little more.
            assert!(share < 1.0 || i > 0, "{}: {share}", OF[i]);
            let spread = (2.0f64 / (11.0 * 200.0)).sqrt().max((2.0f64 / (15.0 * 200.0)).sqrt());
            // A row's or a column's own noise carries part of the pixels' along.
            assert!((means[i] / sigma[i].powi(2) - 1.0).abs() < 8.0 * spread, "{}: {}", OF[i], means[i]);
        }
    }

    /// Bands of other levels and none of some terms: estimates about 0, and nothing of one goes into another.
    #[test]
    fn what_is_not_there_is_not_found() {
        let all = found(&drawn(5, [30, 24, 24, 3], [2.0, 0.0, 1.5, 0.0, 0.0, 0.0, 0.0])).unwrap();
        for one in &all {
            let truth = match one.of {
                "tvh" => 4.0,
                "v" => 2.25,
                _ => 0.0,
            };
            assert!(one.interval[0] <= truth && truth <= one.interval[1], "{one:?}");
        }
        // 2 of a chi-square of 29 · 23 · 23 degrees: 4 (1 +- 1.96 √(2/15341)).
        assert!(
            (all[0].interval[1] / 4.0 - 1.0).abs() < 0.06 && (all[0].interval[0] / 4.0 - 1.0).abs() < 0.06,
            "{all:?}"
        );
        assert!(all[1].sigma()[0] < 0.1 && all[3].sigma()[0] < 0.1);
    }

    #[test]
    fn too_little_is_no_answer() {
        let one = drawn(1, [1, 4, 4, 1], [1.0; 7]);
        assert!(found(&one).is_none() && found(&[]).is_none());
        let line = drawn(1, [3, 1, 4, 1], [1.0; 7]);
        assert!(found(&line).is_none());
        let shape = Shape::new(2, 2, 1).unwrap();
        let missing = [[1.0, f64::NAN, 3.0, 4.0], [5.0, 6.0, 7.0, 8.0]]
            .map(|f| MemoryCube::new(shape, f.to_vec()).unwrap());
        assert!(found(&missing).is_none());
    }
}
