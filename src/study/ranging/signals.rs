//! Information of every window by each signal, in one view.

use super::results::Signal;
use super::subject::Rendered;
use crate::error::Result;
use crate::ranging::cube::{Cube, MemoryCube, Rows as _};
use crate::ranging::information::{Cell, InformationMap, Request, information};
use crate::ranging::reconstruction::EmissionImage;
use crate::render::{Part, View};
use crate::spectrum::Bands;
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
    let centres: Vec<f64> = bands.bands().iter().map(|band| band.center_cm1).collect();
    let image = EmissionImage {
        shape: total.shape(),
        counts: total.samples(),
        emission: emission.samples(),
        temperature_k: &view.temperature_k,
        wavenumbers_cm1: &centres,
        var_electronic: &subject.var_per_band(bands.len()),
    };
    let beside = image.beside_emission(request.derivative)?;
    drop(emission);
    let all = information(&Cube::from(total), request)?;
    let scattered = view.cube(Part::Scattered, factor)?;
    let full = Request { cells: &[Cell::Full], ..request.clone() };
    let scattered = information(&Cube::from(filled(&scattered)?), &full)?;
    let half = [request.window.half_rows(), request.window.half_columns()];
    let reconstructed = |signal: Signal, pixels: &[f64]| SignalMap {
        information: beside.windows(pixels, &all, half),
        ..SignalMap::of(signal, Cell::Full, &all)
    };
    let maps = vec![
        SignalMap::of(Signal::ThermalImage, Cell::Spatial, &all),
        SignalMap::of(Signal::HeatCube, Cell::Full, &all),
        reconstructed(Signal::Reconstructed, &beside.temperature),
        reconstructed(Signal::ReconstructedBlind, &beside.strength_too),
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
