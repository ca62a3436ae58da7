//! What one camera of the pair sees.

use super::lighting::Shares;
use super::radiosity::Basis;
use hadar::cube::{MemoryCube, Shape};
use hadar::error::{Error, Result, check};
use hadar::parallel;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// A part of the heat signal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Part {
    /// All of it: what a thermal camera sees.
    Total,
    /// e B(T).
    Emission,
    /// (1 − e) ΣVS.
    Scattered,
}

impl Part {
    /// All parts.
    pub const ALL: [Self; 3] = [Self::Total, Self::Emission, Self::Scattered];
}

/// Mixtures of a row of pixels: one entry for every surface in a pixel.
#[derive(Debug, Default)]
pub(super) struct MixedRow {
    /// One past the last entry of each pixel.
    pub(super) entries_until: Vec<u32>,
    /// Surface of each entry.
    pub(super) surfaces: Vec<u8>,
    /// Coefficients of the rows of that surface's spectra, entry after entry.
    pub(super) coefficients: Vec<f64>,
}

/// What is at the pixel's centre, and what the rays that meet the same surface see in the mean.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Centre {
    pub(super) depth_m: f64,
    pub(super) surface: u8,
    pub(super) seen_by_other: bool,
    pub(super) texture: f64,
    pub(super) temperature_k: f64,
    pub(super) lighting: Shares,
    /// Whether all rays meet this surface, and one of its emissivities alone.
    pub(super) pure: bool,
}

/// One camera's picture, with the truth about it. Maps are `[row][column]`. Depth and surface are those at a pixel's centre; texture,
/// temperature and lighting are means over the part of the pixel that this surface has; radiance is the mean over the pixel's area.
#[derive(Debug)]
pub struct View {
    pub(super) shape: Shape,
    pub(super) basis: Arc<Basis>,
    pub(super) rows: Vec<MixedRow>,
    /// Depth along the optical axis, m; infinite in the sky.
    pub depth_m: Vec<f64>,
    /// d = x_L − x_R, pixels; 0 in the sky.
    pub disparity_px: Vec<f64>,
    /// Temperature, K.
    pub temperature_k: Vec<f64>,
    /// Place of the surface in [`Scene::surfaces`](super::Scene::surfaces).
    pub surface: Vec<u8>,
    /// Mixing τ of the surface's two emissivities, 0 where it has but one.
    pub texture: Vec<f64>,
    /// Thermal lighting factors V, `[row][column][surface]`; all 0 in the sky.
    pub lighting: Vec<f64>,
    /// Whether all of the pixel is one surface of one emissivity: S = e B(T) + (1 − e) ΣVS, with the maps' T and V.
    pub pure: Vec<bool>,
    /// Whether the other camera sees the same point.
    pub seen_by_other: Vec<bool>,
}

impl View {
    /// Rows, columns and bands.
    #[must_use]
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// Mean radiance that leaves each surface towards what it lights, photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹ at the nodes of the bands: S_k.
    #[must_use]
    pub fn leaving(&self) -> &[Vec<f64>] {
        &self.basis.leaving
    }

    /// A part of the signal, photons s⁻¹ m⁻² sr⁻¹ in each band, times `factor`: expected counts if that is
    /// [`Counting::counts_per_radiance`](hadar::fisher::Counting::counts_per_radiance).
    ///
    /// # Errors
    /// A factor that is not positive and finite.
    pub fn cube(&self, part: Part, factor: f64) -> Result<MemoryCube<f64>> {
        check::positive("counts per radiance", factor, "")?;
        let mut samples = vec![0.0; self.shape.len()];
        let of_row = |(): &mut (), row: usize, out: &mut [f64]| {
            self.fill(part, factor, &self.rows[row], out);
            if out.iter().all(|sample| sample.is_finite()) {
                return Ok(());
            }
            let instead = "lower the temperatures or the counts per radiance";
            Err(Error::malformed("counts beyond all numbers", instead))
        };
        parallel::fill(&mut samples, self.shape.row_len(), || (), of_row)?;
        MemoryCube::new(self.shape, samples)
    }

    /// Rows of a part of the signal times `factor`, `[row][column][band]`, into `out`; nothing of rows that are not there.
    pub fn rows_into(&self, part: Part, factor: f64, rows: Range<usize>, out: &mut Vec<f64>) {
        let rows = self.rows.get(rows).unwrap_or_default();
        out.resize(rows.len() * self.shape.row_len(), 0.0);
        for (out, row) in out.chunks_exact_mut(self.shape.row_len()).zip(rows) {
            self.fill(part, factor, row, out);
        }
    }

    /// A part of the signal times `factor`, summed over the bands, `[row][column]`.
    #[must_use]
    pub fn sums(&self, part: Part, factor: f64) -> Vec<f64> {
        let mut sums = vec![0.0; self.shape.rows() * self.shape.columns()];
        let rows = sums.par_chunks_mut(self.shape.columns()).enumerate();
        rows.for_each_init(Vec::new, |row, (y, sums)| {
            self.rows_into(part, factor, y..y + 1, row);
            let pixels = row.chunks_exact(self.shape.bands());
            sums.iter_mut().zip(pixels).for_each(|(sum, pixel)| *sum = pixel.iter().sum());
        });
        sums
    }

    fn fill(&self, part: Part, factor: f64, row: &MixedRow, out: &mut [f64]) {
        hadar::stop::check();
        let bands = self.basis.bands;
        // Written before it is read: fresh memory that is read first is the system's page of zeros, copied at the first write.
        out.fill(0.0);
        let (mut entry, mut coefficients) = (0, row.coefficients.as_slice());
        for (pixel, &until) in out.chunks_exact_mut(bands).zip(&row.entries_until) {
            while entry < until {
                let surface = row.surfaces.get(entry as usize).map_or(0, |&surface| usize::from(surface));
                let (own, rest) = coefficients.split_at(self.basis.rows(surface).min(coefficients.len()));
                let spectra = self.basis.spectra.get(surface).map_or(&[][..], |spectra| spectra.as_slice());
                let temperatures = self.basis.temperatures.get(surface).copied().unwrap_or(1);
                for (i, (&weight, spectrum)) in own.iter().zip(spectra.chunks_exact(bands)).enumerate() {
                    let emitted = i % (temperatures + self.basis.sources) < temperatures;
                    let wanted = match part {
                        Part::Total => true,
                        Part::Emission => emitted,
                        Part::Scattered => !emitted,
                    };
                    if wanted && weight != 0.0 {
                        for (out, s) in pixel.iter_mut().zip(spectrum) {
                            *out += weight * s;
                        }
                    }
                }
                coefficients = rest;
                entry += 1;
            }
            pixel.iter_mut().for_each(|sample| *sample *= factor);
        }
    }
}
