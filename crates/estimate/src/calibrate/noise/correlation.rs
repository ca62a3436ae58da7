//! Whether the noise of frames is independent from pixel to pixel and from frame to frame, as a photon transfer takes it to be: a camera
//! that filters its frames leaves less variance than its photons have, so that they would be taken for more.
//!
//! With d the difference of a pixel's samples in frames k and k + 1, e that of frames k and k + 2, ⟨⟩ the mean over pixels and frames,
//!
//!   columns, rows: (⟨d d₁⟩ − ⟨d d₉⟩) / (⟨d²⟩ − ⟨d d₉⟩)   d₁, d₉: of the pixels 1 and 9 further on,
//!   frames:        1 − ⟨(d − ⟨d⟩)²⟩ / ⟨(e − ⟨e⟩)²⟩         = (ρ₁ − ρ₂)/(1 − ρ₂) of correlations 1 and 2 frames apart.
//!
//! What whole rows or columns share is in ⟨d d₉⟩ as in ⟨d d₁⟩ and not in these; 9 is odd and one more than 8, so that outputs read by
//! turns are no correlation either. Means of the ratios of all bands. Independent noise is within 4/√N of 0, N pixels and frames of
//! which bands are not counted, as they may go together; differences beyond 6 deviations are left out.

use super::start::Start;
use hadar::cube::{Rows, Sample};
use hadar::error::Result;

/// Correlation that is let pass, as light that spreads between pixels of a detector: photons are some tenth too many by it.
const SMALL: f64 = 0.03;
/// Standard errors by which chance is let pass.
const CHANCE: f64 = 4.0;
/// Pixels that are far from each other.
const FAR: usize = 9;
/// Fewest pixels of which a correlation is told.
const FEWEST: f64 = 256.0;
/// Rows that are looked at.
const ROWS: usize = 64;

/// How noise goes together along one dimension.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Correlation {
    /// The dimension: `frames`, `rows`, `columns`.
    pub of: &'static str,
    /// Correlation of neighbours along it.
    pub value: f64,
    /// What the noise of a camera that does not filter stays within.
    pub limit: f64,
}

impl Correlation {
    /// Whether no figure of photons follows from this noise.
    #[must_use]
    pub fn is_large(&self) -> bool {
        // Of what is no number nothing follows either.
        self.value.is_nan() || self.value.abs() > self.limit
    }
}

/// The correlations of two or more frames of one scene, as far as there are enough pixels to look at; of one frame none.
///
/// # Errors
/// Samples that do not scatter at all, or that cannot be read.
pub fn noise_correlations<S: Sample>(frames: &[&dyn Rows<S>], dark_level: f64) -> Result<Vec<Correlation>> {
    let (Some(first), true) = (frames.first(), frames.len() > 1) else { return Ok(Vec::new()) };
    let (start, shape) = (Start::new(frames, dark_level)?, first.shape());
    let (bands, line) = (shape.bands(), shape.columns() * shape.bands());
    let [mut of_frames, mut of_rows, mut of_columns] = [(); 3].map(|()| Sums::new(bands));
    for row in (0..shape.rows()).step_by(shape.rows().div_ceil(ROWS)) {
        let own = Differences::read(frames, row, &start)?;
        if row + FAR < shape.rows() {
            let beside = Differences::read(frames, row + 1, &start)?;
            let far = Differences::read(frames, row + FAR, &start)?;
            for ((own, beside), far) in own.of_one.iter().zip(&beside.of_one).zip(&far.of_one) {
                for i in 0..line {
                    of_rows.add(i % bands, [own[i] * own[i], own[i] * beside[i], own[i] * far[i]]);
                }
            }
        }
        for d in &own.of_one {
            for i in 0..line.saturating_sub(FAR * bands) {
                of_columns.add(i % bands, [d[i] * d[i], d[i] * d[i + bands], d[i] * d[i + FAR * bands]]);
            }
        }
        for (d, e) in own.of_one.iter().zip(&own.of_two) {
            for band in 0..bands {
                of_frames.add_variances(band, (band..line).step_by(bands).map(|i| [d[i], e[i]]));
            }
        }
    }
    let told = [
        of_frames.told("frames", |[d, e, _]| 1.0 - d / e),
        of_rows.told("rows", |[all, near, far]| (near - far) / (all - far)),
        of_columns.told("columns", |[all, near, far]| (near - far) / (all - far)),
    ];
    Ok(told.into_iter().flatten().collect())
}

/// Differences of the samples of a row, one line for each pair of frames; NaN for those that are outliers or missing.
struct Differences {
    /// Of successive frames.
    of_one: Vec<Vec<f64>>,
    /// Of frames two apart, where those between them are differences as well.
    of_two: Vec<Vec<f64>>,
}

impl Differences {
    fn read<S: Sample>(frames: &[&dyn Rows<S>], row: usize, start: &Start) -> Result<Self> {
        let bands = frames.first().map_or(1, |frame| frame.shape().bands());
        let mut buffer = Vec::new();
        let mut of_one: Vec<Vec<f64>> = Vec::with_capacity(frames.len());
        let mut last: Vec<f64> = Vec::new();
        for frame in frames {
            let samples: Vec<f64> =
                frame.read(row..row + 1, &mut buffer)?.iter().map(|s| (*s).into()).collect();
            let difference = |(i, (one, two)): (usize, (&f64, &f64))| {
                let (d, mean) = (two - one, 0.5 * (one + two) - start.dark_level);
                if 0.5 * d * d <= start.most(i % bands, mean) { d } else { f64::NAN }
            };
            if !last.is_empty() {
                of_one.push(last.iter().zip(&samples).enumerate().map(difference).collect());
            }
            last = samples;
        }
        let of_two = of_one.windows(2).map(|pair| pair[0].iter().zip(&pair[1]).map(|(a, b)| a + b).collect());
        Ok(Self { of_two: of_two.collect(), of_one })
    }
}

/// Sums of each band, and of how many.
struct Sums(Vec<([f64; 3], f64)>);

impl Sums {
    fn new(bands: usize) -> Self {
        Self(vec![Default::default(); bands])
    }

    fn add(&mut self, band: usize, values: [f64; 3]) {
        if values.iter().all(|value| value.is_finite()) {
            let (sums, count) = &mut self.0[band];
            sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
            *count += 1.0;
        }
    }

    /// Sums of squared deviations from the means of those that are there.
    fn add_variances(&mut self, band: usize, pairs: impl Iterator<Item = [f64; 2]>) {
        let (mut count, mut mean, mut square) = (0.0, [0.0; 2], [0.0; 2]);
        for pair in pairs.filter(|pair| pair.iter().all(|value| value.is_finite())) {
            count += 1.0;
            for ((mean, square), value) in mean.iter_mut().zip(&mut square).zip(pair) {
                let off = value - *mean;
                *mean += off / count;
                *square += off * (value - *mean);
            }
        }
        let (sums, all) = &mut self.0[band];
        sums.iter_mut().zip(square).for_each(|(sum, square)| *sum += square);
        *all += count;
    }

    /// The mean of what the bands have; none of too few pixels.
    fn told(&self, of: &'static str, value: fn([f64; 3]) -> f64) -> Option<Correlation> {
        let most = self.0.iter().map(|band| band.1).fold(0.0, f64::max);
        if most < FEWEST {
            return None;
        }
        // A band that does not scatter has no correlation.
        let there = self.0.iter().filter(|(sums, count)| *count >= FEWEST && sums[0] > 0.0);
        let (sum, bands) =
            there.fold((0.0, 0.0), |(sum, bands), (sums, _)| (sum + value(*sums), bands + 1.0));
        Some(Correlation { of, value: sum / bands, limit: SMALL + CHANCE / most.sqrt() })
    }
}
