//! Information of every window by each signal, in one view.

use super::results::Signal;
use super::subject::{Measured, Rendered, nothing_to_see};
use hadar::cube::{Cube, MemoryCube, Rows as _, Shape};
use hadar::error::Result;
use hadar::parallel;
use hadar::ranging::depth::WindowInformation;
use hadar::ranging::information::{Cell, InformationMap, Request, information};
use hadar::ranging::noise::Joined;
use hadar::ranging::reconstruction::{BesideEmission, EmissionImage};
use hadar::spectrum::Bands;
use hadar_simulate::render::{Part, View};
use std::ops::Range;

/// The signal that quantities are solved for.
pub(super) const DECIDES: Signal = Signal::HeatCube;

/// J, photons and Σσ² of every window by one signal.
#[derive(Debug, Clone)]
pub(super) struct SignalMap {
    pub(super) signal: Signal,
    pub(super) rows: Range<usize>,
    pub(super) columns: Range<usize>,
    pub(super) information: Vec<f64>,
    pub(super) photons: Vec<f64>,
    pub(super) var_added: Vec<f64>,
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
            var_added: map.var_added.clone(),
        }
    }

    /// The thermal image, whose joined bands have the noise of one reading or of all.
    pub(super) fn thermal(map: &InformationMap, joined: Joined, bands: usize) -> Self {
        let mut thermal = Self::of(Signal::ThermalImage, Cell::Spatial, map);
        if joined == Joined::OneReading {
            thermal.var_added.iter_mut().for_each(|var| *var /= bands as f64);
        }
        thermal
    }

    /// Counts in units of `photons` photons each: J, N and Σσ² in photons.
    pub(super) fn scaled(mut self, photons: f64) -> Self {
        for values in [&mut self.information, &mut self.photons, &mut self.var_added] {
            values.iter_mut().for_each(|value| *value *= photons);
        }
        self
    }

    /// A window as the bounds take it.
    pub(super) fn window(&self, at: usize) -> Option<WindowInformation> {
        let (j, n) = (*self.information.get(at)?, *self.photons.get(at)?);
        WindowInformation::new(j, n, *self.var_added.get(at)?).ok()
    }

    /// The place of a centre in the map.
    pub(super) fn at(&self, row: usize, column: usize) -> Option<usize> {
        let inside = self.rows.contains(&row) && self.columns.contains(&column);
        inside.then(|| (row - self.rows.start) * self.columns.len() + column - self.columns.start)
    }
}

impl Measured {
    /// What the thermal image and the heat cube tell, of the cells of the counts as they are in the file.
    ///
    /// A unit of g photons: J(N, σ²) = g J(n, σ²/g) for counts n = N/g.
    pub(super) fn signals(&self, cells: &InformationMap, joined: Joined) -> Vec<SignalMap> {
        let both = [
            SignalMap::thermal(cells, joined, self.left.shape().bands()),
            SignalMap::of(Signal::HeatCube, Cell::Full, cells),
        ];
        both.map(|map| map.scaled(self.photons_per_unit)).to_vec()
    }
}

/// Rows whose emission and scattered light are made at a time: a core's own cache holds them.
const ROWS: usize = 4;

/// All signals of one view of a scene, or those alone that a camera counts, the four cells of its total signal, and that signal.
pub(super) fn of_scene(
    subject: &Rendered,
    view: &View,
    (bands, counted_alone): (&Bands, bool),
    request: &Request<'_>,
) -> Result<(Vec<SignalMap>, InformationMap, Cube)> {
    let total = view.cube(Part::Total, subject.counting.counts_per_radiance)?;
    let beside = if counted_alone { None } else { Some(beside(subject, view, bands, &total, request)?) };
    let total = Cube::from(total);
    let all = information(&total, request)?;
    let mut maps = vec![
        SignalMap::thermal(&all, request.joined, bands.len()),
        SignalMap::of(Signal::HeatCube, Cell::Full, &all),
    ];
    if let Some(beside) = beside {
        let half = [request.window.half_rows(), request.window.half_columns()];
        let of = |signal: Signal, pixels: &[f64]| SignalMap {
            information: beside.windows(pixels, &all, half),
            ..SignalMap::of(signal, Cell::Full, &all)
        };
        let alone = of(Signal::ScatteredAsMeasured, &beside.scattered_alone);
        maps.push(of(Signal::Reconstructed, &beside.temperature));
        maps.push(of(Signal::ReconstructedBlind, &beside.strength_too));
        maps.push(SignalMap { photons: beside.windows(&beside.scattered_counts, &all, half), ..alone });
    }
    Ok((maps, all, total))
}

/// What the scattered light tells beside what is emitted.
fn beside(
    subject: &Rendered,
    view: &View,
    bands: &Bands,
    total: &MemoryCube<f64>,
    request: &Request<'_>,
) -> Result<BesideEmission> {
    let factor = subject.counting.counts_per_radiance;
    let (shape, var_added) = (total.shape(), subject.var_per_band(bands.len()));
    let centres: Vec<f64> = bands.bands().iter().map(|band| band.center_cm1).collect();
    let counts: Vec<_> = total.samples().chunks(ROWS * shape.row_len()).collect();
    let temperatures_k: Vec<_> = view.temperature_k.chunks(ROWS * shape.columns()).collect();
    let blocks = parallel::try_map_with(counts.len(), Default::default, |parts: &mut [Vec<f64>; 2], i| {
        let (counts, temperature_k) = (counts[i], temperatures_k[i]);
        let rows = counts.len() / shape.row_len();
        for (part, of) in parts.iter_mut().zip([Part::Emission, Part::Scattered]) {
            view.rows_into(of, factor, i * ROWS..i * ROWS + rows, part);
        }
        let [emission, scattered] = parts;
        let image = EmissionImage {
            shape: Shape::new(rows, shape.columns(), shape.bands())?,
            counts,
            emission,
            scattered,
            temperature_k,
            wavenumbers_cm1: &centres,
            var_added: &var_added,
        };
        image.beside_emission(request.derivative)
    })?;
    let mut blocks = blocks.into_iter();
    let Some(mut beside) = blocks.next() else { return Err(nothing_to_see()) };
    blocks.for_each(|below| beside.append(&below));
    Ok(beside)
}
