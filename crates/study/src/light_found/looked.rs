//! Pixels of a cube that were looked at, and what they are like: brightness temperatures, medians, spreads.
//!
//! n_w counts of a pixel in band w, κ_w counts of a unit of radiance, σ_w² = n_w + the variance of the electronic noise. Against a median m a
//! pixel has the strength s = mean of n_w/m_w, and the shape n_w/m_w − s, whose mean square is that of σ_w²/m_w² for noise alone.
//!
//! Assumption: bad pixels and those without all samples are none that are looked at; which others are does not hang on them.

use hadar::cube::{Cube, Rows, Sample};
use hadar::error::Result;
use hadar::planck::{brightness_temperature, photon_radiance_slope};
use hadar::spectrum::Bands;

/// Pixels that are looked at.
const ASKED: usize = 1 << 14;
/// Share by which pixels of the sky differ at most.
const ALIKE: f64 = 0.15;
/// Kelvin by which what is nearly a blackbody differs from one.
pub(super) const BLACK_K: f64 = 3.0;
/// Times the usual mean square of what shapes differ by, and the scatter of noise, from which on a shape is another one.
const FAR: f64 = 4.0;
/// The median distance of a normal distribution is its deviation over this.
pub(super) const NORMAL: f64 = 1.4826;

/// What the samples of a cube are.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Readings<'a> {
    pub(crate) bands: &'a Bands,
    pub(crate) bad_bands: &'a [usize],
    pub(crate) counts_per_radiance: &'a [f64],
    pub(crate) var_added: &'a [f64],
    pub(crate) units_per_count: f64,
}

/// A pixel that was looked at: its row, counts in the bands that count.
pub(super) struct Seen {
    row: usize,
    pub(super) counts: Vec<f64>,
}

/// Pixels of a cube that were looked at.
pub(crate) struct Looked<'a> {
    pub(super) readings: Readings<'a>,
    pub(super) rows: usize,
    pub(super) used: Vec<usize>,
    /// Mean wavenumbers and κ Δν of the bands that count.
    centres_cm1: Vec<f64>,
    pub(super) kappa: Vec<f64>,
    pub(super) seen: Vec<Seen>,
    /// T̄ of each.
    pub(super) means_k: Vec<f64>,
}

impl<'a> Looked<'a> {
    pub(crate) fn at(cube: &Cube, readings: Readings<'a>) -> Result<Self> {
        let Readings { bands, bad_bands, .. } = readings;
        let used: Vec<usize> = (0..bands.len()).filter(|band| !bad_bands.contains(band)).collect();
        let (wide, widths) = (bands.weigh(bands.nodes_cm1()), bands.widths_cm1());
        let seen = match cube {
            Cube::F32(rows) => seen(rows.as_ref(), &used, readings.units_per_count),
            Cube::F64(rows) => seen(rows.as_ref(), &used, readings.units_per_count),
        }?;
        let mut looked = Self {
            readings,
            rows: cube.shape().rows(),
            centres_cm1: used.iter().map(|band| wide[*band] / widths[*band]).collect(),
            kappa: used.iter().map(|band| readings.counts_per_radiance[*band] * widths[*band]).collect(),
            used,
            seen,
            means_k: Vec::new(),
        };
        looked.means_k = looked.seen.iter().map(|one| mean(&looked.temperatures_k(&one.counts))).collect();
        Ok(looked)
    }

    pub(super) fn within(&self, rows: [usize; 2]) -> Vec<usize> {
        (0..self.seen.len()).filter(|i| (rows[0]..rows[1]).contains(&self.seen[*i].row)).collect()
    }

    /// Brightness temperatures in the bands that count, K; 0 where nothing is sent.
    pub(super) fn temperatures_k(&self, counts: &[f64]) -> Vec<f64> {
        let each = counts.iter().zip(&self.kappa).zip(&self.centres_cm1);
        each.map(|((n, k), nu)| if *n > 0.0 { brightness_temperature(*nu, n / k) } else { 0.0 }).collect()
    }

    /// Variance of the noise of counts in the `w`th band that counts.
    fn var(&self, w: usize, counts: f64) -> f64 {
        let added = self.used.get(w).and_then(|band| self.readings.var_added.get(*band));
        counts.max(0.0) + added.copied().unwrap_or(0.0)
    }

    /// Whether a pixel is like a median in strength and shape.
    pub(super) fn is_alike(&self, i: usize, median: &[f64]) -> bool {
        let [strength, shape, noise] = self.off(i, median);
        let var = ALIKE * ALIKE;
        strength * strength <= var + 9.0 * noise / median.len() as f64 && shape <= var + 4.0 * noise
    }

    /// By what share a pixel is stronger than a median, the mean square over the bands of what it differs by besides, and what noise does to that.
    fn off(&self, i: usize, median: &[f64]) -> [f64; 3] {
        let counts = &self.seen[i].counts;
        let used = || counts.iter().zip(median).enumerate().filter(|(_, (_, m))| **m > 0.0);
        let bands = used().count().max(1) as f64;
        let share = |n: f64, m: f64| n / m;
        let strength = used().map(|(_, (n, m))| share(*n, *m)).sum::<f64>() / bands;
        let shape = used().map(|(_, (n, m))| (share(*n, *m) - strength).powi(2)).sum::<f64>() / bands;
        let noise = used().map(|(w, (_, m))| self.var(w, *m) / m / m).sum::<f64>() / bands;
        [strength - 1.0, shape, noise]
    }

    /// Spread of the strengths of pixels, and of their shapes beside noise, as shares.
    pub(super) fn spread(&self, chosen: &[usize], median: &[f64]) -> [f64; 2] {
        let off: Vec<[f64; 3]> = chosen.iter().map(|i| self.off(*i, median)).collect();
        let mut strengths: Vec<f64> = off.iter().map(|[strength, ..]| strength.abs()).collect();
        let mut shapes: Vec<f64> = off.iter().map(|[_, shape, noise]| shape - noise).collect();
        [NORMAL * middle(&mut strengths), middle(&mut shapes).max(0.0).sqrt()]
    }

    /// Whether a pixel sends nearly what a blackbody does.
    pub(super) fn is_black(&self, i: usize) -> bool {
        let (counts, mean_k) = (&self.seen[i].counts, self.means_k[i]);
        let bands_k = self.temperatures_k(counts);
        let bands = bands_k.len().max(1) as f64;
        let square = bands_k.iter().map(|t| (t - mean_k).powi(2)).sum::<f64>() / bands;
        let of_noise = |w: usize| {
            let slope = self.kappa[w] * photon_radiance_slope(self.centres_cm1[w], mean_k);
            self.var(w, counts[w]) / slope / slope
        };
        let noise = (0..bands_k.len()).map(of_noise).sum::<f64>() / bands;
        // What noise adds scatters itself.
        square - noise <= BLACK_K * BLACK_K + 3.0 * noise * (2.0 / bands).sqrt()
    }

    /// The median of their shapes, as strong as their median: of spectra that differ in strength, medians of each band for itself would be
    /// those of different pixels.
    pub(super) fn median(&self, chosen: &[usize]) -> Vec<f64> {
        let of = |value: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
            let band = |w: usize| middle(&mut chosen.iter().map(|i| value(*i, w)).collect::<Vec<_>>());
            (0..self.used.len()).map(band).collect()
        };
        let own = |i: usize, w: usize| self.seen[i].counts[w];
        let plain = of(&own);
        let mut strengths = vec![f64::NAN; self.seen.len()];
        chosen.iter().for_each(|i| strengths[*i] = 1.0 + self.off(*i, &plain)[0]);
        let mut known: Vec<f64> = chosen.iter().map(|i| strengths[*i]).collect();
        if known.iter().any(|one| *one <= 0.0) {
            return plain;
        }
        let strength = middle(&mut known);
        let shape = of(&|i, w| own(i, w) / strengths[i]);
        shape.iter().map(|n| n * strength).collect()
    }

    /// Those that have the shape of most of them: what else is as bright would bend the median more finely than its error says.
    pub(super) fn of_one_shape(&self, chosen: &[usize]) -> Vec<usize> {
        let median = self.median(chosen);
        let off: Vec<[f64; 3]> = chosen.iter().map(|i| self.off(*i, &median)).collect();
        let mut excess: Vec<f64> = off.iter().map(|[_, shape, noise]| shape - noise).collect();
        let usual = middle(&mut excess).max(0.0);
        // What noise adds scatters itself.
        let scatter = (2.0 / self.used.len().max(1) as f64).sqrt();
        let is_like = |[_, shape, noise]: &[f64; 3]| shape - noise <= FAR * (usual + noise * scatter);
        chosen.iter().zip(&off).filter(|(_, off)| is_like(off)).map(|(i, _)| *i).collect()
    }
}

fn seen<S: Sample>(cube: &dyn Rows<S>, used: &[usize], unit: f64) -> Result<Vec<Seen>> {
    let shape = cube.shape();
    // By its place, not by how many are whole: a pixel that is missing moves no other.
    let stride = (shape.rows() * shape.columns()).div_ceil(ASKED).max(1);
    let (mut all, mut buffer) = (Vec::new(), Vec::new());
    for row in 0..shape.rows() {
        hadar::stop::check();
        let own = cube.read(row..row + 1, &mut buffer)?.chunks(shape.bands()).enumerate();
        for (_, pixel) in own.filter(|(x, _)| (row * shape.columns() + x).is_multiple_of(stride)) {
            let counts: Vec<f64> = used.iter().map(|band| pixel[*band].into() / unit).collect();
            // Nothing at all is no reading.
            if counts.iter().all(|n| n.is_finite()) && counts.iter().any(|n| *n > 0.0) {
                all.push(Seen { row, counts });
            }
        }
    }
    Ok(all)
}

pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

pub(super) fn range(values: &[f64]) -> [f64; 2] {
    let ends = |f: fn(f64, f64) -> f64| values.iter().copied().reduce(f).unwrap_or(f64::NAN);
    [ends(f64::min), ends(f64::max)]
}

pub(super) fn middle(values: &mut [f64]) -> f64 {
    let place = values.len() / 2;
    if values.is_empty() { f64::NAN } else { *values.select_nth_unstable_by(place, f64::total_cmp).1 }
}
