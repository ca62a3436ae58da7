//! The scene, its counts, and stripes put into them.

use hadar::cube::{MemoryCube, Shape};
use hadar::error::Result;
use hadar::planck::photon_radiance;
use hadar::statistics::Statistics;
use hadar_simulate::draws::{Draws, generator};
use rand::RngExt;

pub(super) const ROWS: usize = 120;
pub(super) const COLUMNS: usize = 384;
pub(super) const BANDS: usize = 24;
const EMISSIVITY: f64 = 0.95;
/// Counts of a sample of the middle band at 290 K, and electrons of a reading.
const COUNTS: f64 = 1e5;
const ELECTRONS: f64 = 100.0;
/// Deviations of the gains, and of the offsets over the level of the band.
pub(super) const GAIN: f64 = 0.02;
pub(super) const OFFSET: f64 = 0.01;
/// Root mean square of the texture, K.
pub(super) const TEXTURE_K: f64 = 1.0;

/// Means and their derivatives, `[row][column][band]`.
#[derive(Debug)]
pub(super) struct Twin {
    pub(super) shape: Shape,
    pub(super) mean: Vec<f64>,
    /// Counts per kelvin.
    pub(super) per_kelvin: Vec<f64>,
    /// Level of each band.
    pub(super) level: Vec<f64>,
}

/// A line of a band that reads gain·x + offset.
#[derive(Debug, Clone, Copy)]
pub(super) struct Put {
    pub(super) line: usize,
    pub(super) band: usize,
    pub(super) gain: f64,
    pub(super) offset: f64,
}

impl Twin {
    pub(super) fn new() -> Result<Self> {
        let shape = Shape::new(ROWS, COLUMNS, BANDS)?;
        let mut random = generator(41, 0);
        let waves: Vec<[f64; 3]> = (0..60)
            .map(|_| {
                let [length, angle]: [f64; 2] =
                    [random.random_range(3.0..60.0), random.random_range(0.0..std::f64::consts::TAU)];
                let k = std::f64::consts::TAU / length;
                [k * angle.cos(), k * angle.sin(), random.random_range(0.0..std::f64::consts::TAU)]
            })
            .collect();
        let amplitude = TEXTURE_K * (2.0 / waves.len() as f64).sqrt();
        let nu = |band: usize| 800.0 + 20.0 * band as f64;
        let scale = COUNTS / (EMISSIVITY * photon_radiance(nu(BANDS / 2), 290.0));
        let counts = |band: usize, t: f64| scale * EMISSIVITY * photon_radiance(nu(band), t);
        let (mut mean, mut per_kelvin) = (Vec::new(), Vec::new());
        for row in 0..ROWS {
            for column in 0..COLUMNS {
                let (y, x) = (row as f64, column as f64);
                let texture: f64 = waves.iter().map(|[a, b, c]| amplitude * (a * x + b * y + c).sin()).sum();
                let block = (45..90).contains(&row) && (120..170).contains(&column);
                let ground = if row < 40 { 264.0 + 0.05 * y } else { 284.0 + 0.03 * y };
                let t = texture + if block { 305.0 } else { ground };
                for band in 0..BANDS {
                    mean.push(counts(band, t));
                    per_kelvin.push((counts(band, t + 0.05) - counts(band, t - 0.05)) / 0.1);
                }
            }
        }
        let level = (0..BANDS)
            .map(|band| mean.iter().skip(band).step_by(BANDS).sum::<f64>() / (ROWS * COLUMNS) as f64)
            .collect();
        Ok(Self { shape, mean, per_kelvin, level })
    }

    pub(super) fn var(&self, i: usize) -> f64 {
        self.mean[i] + ELECTRONS * ELECTRONS
    }

    pub(super) fn drawn(&self, seed: u64, stream: u64) -> Result<Vec<f64>> {
        let draws = Draws::new(&Statistics::Poisson, &self.mean)?
            .with_electronic_noise(&vec![ELECTRONS * ELECTRONS; self.mean.len()])?;
        let mut counts = vec![0.0; self.mean.len()];
        draws.draw_into(&mut generator(seed, stream), &mut counts);
        Ok(counts)
    }

    /// Stripes a share of the lines of each band.
    pub(super) fn striped(
        &self,
        samples: &[f64],
        share: f64,
        seed: u64,
        stream: u64,
    ) -> (Vec<f64>, Vec<Put>) {
        let mut random = generator(seed, stream);
        let (mut own, mut put) = (samples.to_vec(), Vec::new());
        for line in 0..ROWS {
            for band in 0..BANDS {
                if random.random_range(0.0..1.0) < share {
                    let gain = 1.0 + GAIN * normal(&mut random);
                    let offset = OFFSET * self.level[band] * normal(&mut random);
                    put.push(Put { line, band, gain, offset });
                    let samples = &mut own[line * COLUMNS * BANDS..(line + 1) * COLUMNS * BANDS];
                    for sample in samples.iter_mut().skip(band).step_by(BANDS) {
                        *sample = gain * *sample + offset;
                    }
                }
            }
        }
        (own, put)
    }

    pub(super) fn cube(&self, samples: Vec<f64>) -> Result<MemoryCube<f64>> {
        MemoryCube::new(self.shape, samples)
    }
}

/// Twelve uniform deviates are a normal one.
fn normal(random: &mut impl RngExt) -> f64 {
    (0..12).map(|_| random.random_range(0.0..1.0)).sum::<f64>() - 6.0
}
