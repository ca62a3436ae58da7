//! Information of every window by each signal, in one view.

use super::results::Signal;
use super::subject::Rendered;
use crate::error::Result;
use crate::planck;
use crate::fisher::Projector;
use crate::ranging::cube::{Cube, MemoryCube, Rows as _};
use crate::ranging::derivative::Differentiator;
use crate::ranging::information::{Cell, InformationMap, Request, information};
use crate::ranging::noise::NoiseVariance;
use crate::render::{Part, View};
use crate::spectrum::Bands;
use rayon::prelude::*;
use std::ops::Range;

/// J, photons and Σσ² of every window by one signal.
#[derive(Debug, Clone)]
pub(super) struct SignalMap {
    pub(super) signal: Signal,
    pub(super) rows: Range<usize>,
    pub(super) columns: Range<usize>,
    pub(super) information: Vec<f64>,
    pub(super) photons: Vec<f64>,
    pub(super) var_electronic: Vec<f64>,
}

impl SignalMap {
    /// Takes one cell out of a map.
    pub(super) fn of(signal: Signal, cell: Cell, map: &InformationMap) -> Self {
        Self {
            signal,
            rows: map.rows.clone(),
            columns: map.columns.clone(),
            information: map.cell(cell).to_vec(),
            photons: map.photons.clone(),
            var_electronic: map.var_electronic.clone(),
        }
    }

    /// Counts in units of `photons` photons each: J, N and Σσ² in photons.
    pub(super) fn scaled(mut self, photons: f64) -> Self {
        for values in [&mut self.information, &mut self.photons, &mut self.var_electronic] {
            values.iter_mut().for_each(|value| *value *= photons);
        }
        self
    }

    /// The place of a centre in the map.
    pub(super) fn at(&self, row: usize, column: usize) -> Option<usize> {
        let inside = self.rows.contains(&row) && self.columns.contains(&column);
        inside.then(|| (row - self.rows.start) * self.columns.len() + column - self.columns.start)
    }
}

/// All signals of one view of a scene, and the four cells of its total signal.
pub(super) fn of_scene(
    subject: &Rendered,
    view: &View,
    bands: &Bands,
    request: &Request<'_>,
) -> Result<(Vec<SignalMap>, InformationMap)> {
    let factor = subject.counting.counts_per_radiance;
    let total = view.cube(Part::Total, factor)?;
    let emission = view.cube(Part::Emission, factor)?;
    let in_pixels = beside_emission(&total, &emission, view, bands, request)?;
    drop(emission);
    let all = information(&Cube::from(total), request)?;
    let scattered = view.cube(Part::Scattered, factor)?;
    let full = Request { cells: &[Cell::Full], ..request.clone() };
    let scattered = information(&Cube::from(filled(&scattered)?), &full)?;
    let reconstructed = SignalMap::of(Signal::Reconstructed, Cell::Full, &all);
    let margin = view.shape().columns().saturating_sub(in_pixels.columns) / 2;
    let maps = vec![
        SignalMap::of(Signal::ThermalImage, Cell::Spatial, &all),
        SignalMap::of(Signal::HeatCube, Cell::Full, &all),
        SignalMap { information: in_pixels.windows(&all, request, margin), ..reconstructed },
        SignalMap::of(Signal::ScatteredAsMeasured, Cell::Full, &scattered),
    ];
    Ok((maps, all))
}

/// The sky scatters nothing, and a count of 0 without noise has no bound: its pixels get the largest count of
/// the view. No window that touches the sky is used.
fn filled(cube: &MemoryCube<f64>) -> Result<MemoryCube<f64>> {
    let largest = cube.samples().iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let samples = cube.samples().iter().map(|&count| if count > 0.0 { count } else { largest }).collect();
    MemoryCube::new(cube.shape(), samples)
}

/// Information in each pixel, pixel⁻².
struct PerPixel {
    values: Vec<f64>,
    columns: usize,
}

impl PerPixel {
    /// Sums over the windows of a map; the pixels' first column is `margin`.
    fn windows(&self, map: &InformationMap, request: &Request<'_>, margin: usize) -> Vec<f64> {
        let (half_rows, half_columns) = (request.window.half_rows(), request.window.half_columns());
        let row = |row: usize| &self.values[row * self.columns..(row + 1) * self.columns];
        let sums: Vec<Vec<f64>> = map
            .rows
            .clone()
            .into_par_iter()
            .map(|centre| {
                let mut columns = vec![0.0; self.columns];
                for y in centre - half_rows..=centre + half_rows {
                    columns.iter_mut().zip(row(y)).for_each(|(sum, value)| *sum += value);
                }
                map.columns
                    .clone()
                    .map(|x| columns[x - margin - half_columns..=x - margin + half_columns].iter().sum())
                    .collect()
            })
            .collect();
        sums.concat()
    }
}

/// What each pixel tells about position when the strength and the temperature of its own emission are unknown:
/// ‖P⊥ ∂N‖² with P⊥ taking off the span of E and ∂E/∂T, in the inner product of weights 1/(N + σ²).
fn beside_emission(
    total: &MemoryCube<f64>,
    emission: &MemoryCube<f64>,
    view: &View,
    bands: &Bands,
    request: &Request<'_>,
) -> Result<PerPixel> {
    let shape = total.shape();
    let (count, row_len) = (shape.bands(), shape.row_len());
    let margin = request.derivative.margin();
    let columns = shape.columns() - 2 * margin;
    let centres: Vec<f64> = bands.bands().iter().map(|band| band.center_cm1).collect();
    let var: Vec<f64> = match request.noise {
        NoiseVariance::Uniform(var) => vec![*var; count],
        NoiseVariance::PerBand(var) => var.clone(),
        NoiseVariance::None | NoiseVariance::PerSample(_) => vec![0.0; count],
    };
    let rows: Result<Vec<Vec<f64>>> = total
        .samples()
        .par_chunks(row_len)
        .zip(emission.samples().par_chunks(row_len))
        .zip(view.temperature_k.par_chunks(shape.columns()))
        .map_init(
            || (Projector::default(), vec![0.0; 3 * count], vec![0.0; count]),
            |(projector, work, weights), ((counts, emitted), temperatures)| {
                let mut slopes = vec![0.0; columns * count];
                Differentiator::new(request.derivative, shape.columns())?.apply(counts, count, &mut slopes)?;
                let pixels = slopes.chunks_exact(count).enumerate();
                let found = pixels.map(|(i, slope)| {
                    let x = i + margin;
                    let at = x * count..(x + 1) * count;
                    let temperature_k = temperatures.get(x).copied().unwrap_or(f64::NAN);
                    let (unknown, wanted) = work.split_at_mut(2 * count);
                    let (strength, warmth) = unknown.split_at_mut(count);
                    wanted.copy_from_slice(slope);
                    strength.copy_from_slice(&emitted[at.clone()]);
                    for (b, (warmth, strength)) in warmth.iter_mut().zip(&*strength).enumerate() {
                        *warmth = strength * planck::log_derivative(centres[b], temperature_k);
                    }
                    let noisy = counts[at].iter().zip(&var);
                    weights.iter_mut().zip(noisy).for_each(|(u, (n, var))| *u = 1.0 / (n + var));
                    let projection = projector.project(work, weights, 1.0).residual;
                    projection * projection
                });
                Ok(found.collect())
            },
        )
        .collect();
    Ok(PerPixel { values: rows?.concat(), columns })
}
