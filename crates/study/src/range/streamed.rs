//! A cube of one view and one depth (or none) whose windows are too many to be kept: worked on by rows.
//!
//! Maps are handed on as their rows are made; medians and quantiles are counted in steps ([`Distribution`]), shares are exact. For
//! pictures, every so many rows and columns are kept, and the rows of lines.

#[cfg(test)]
mod tests;

use super::bounds::Ground;
use super::bounds::rank;
use super::distribution::{Distribution, QUANTILE_ERROR};
use super::looked_up::{RangeStudy, SECTIONS};
use super::results::{
    BoundMaps, CellMedians, DepthSolutions, Line, ObjectBounds, Ranging, Signal, SignalBounds,
};
use super::signals::{DECIDES, SignalMap};
use super::solve::Every;
use super::subject::{Depth, Measured, Resolved, Truth, nothing_left, nothing_to_see};
use super::verified::{Change, scaled};
use super::{MapSink, Progress, RangePlan};
use hadar::cube::Shape;
use hadar::demand::{self, Ledger, Reason, Thing};
use hadar::error::{Error, Result};
use hadar::ranging::depth::StereoGeometry;
use hadar::ranging::information::{Cell, InformationMap, Request, centres, information_by_rows};
use hadar::ranging::noise::Joined;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Windows of a cube that are kept, some 250 bytes each.
const KEPT: usize = 1 << 20;

/// Windows that are counted at a time by a thread, at most but for one row.
const AT_ONCE: usize = 1 << 16;

/// How near to a value that does not do what is solved for must be: every step nearer is a pass over the cube.
const CLOSE_OF_MANY: f64 = 1e-3;

/// Signals of a cube.
const SIGNALS: [Signal; 2] = [Signal::ThermalImage, Signal::HeatCube];

/// What is counted of the windows by one signal.
#[derive(Debug, Default)]
struct OfSignal {
    information: Mutex<Distribution>,
    correspondence_px: Mutex<Distribution>,
    disparity_error_px: Mutex<Distribution>,
    /// Windows that have a bound, and those that reach the demand.
    windows: AtomicUsize,
    met: AtomicUsize,
}

/// What is counted of all windows.
#[derive(Debug, Default)]
struct Counted {
    signals: [OfSignal; 2],
    photons: Mutex<Distribution>,
    var_added: Mutex<Distribution>,
    total: Mutex<Distribution>,
    spectral: Mutex<Distribution>,
    /// Errors of both signals along lines, with and without diffraction.
    lines: Mutex<BTreeMap<usize, [[Vec<f64>; 2]; 2]>>,
    /// Errors of both signals in the rows that are shown.
    shown: Mutex<BTreeMap<usize, [Vec<f64>; 2]>>,
    /// Windows that hold a missing sample.
    missing: AtomicUsize,
}

/// What all rows have in common.
struct Setting<'a> {
    study: &'a RangeStudy,
    cube: &'a Measured,
    shape: Shape,
    depth_m: Option<f64>,
    /// With diffraction, and without.
    var_diffraction_px2: [f64; 2],
    /// First windows of all.
    rows: Range<usize>,
    columns: Range<usize>,
    /// Rows and columns from one that is shown to the next.
    step: usize,
    lines: Vec<usize>,
}

impl RangeStudy {
    /// The cube, if it is one whose windows can be worked on by rows and are too many to be kept.
    pub(super) fn too_large_to_keep(&self, shape: Shape) -> Option<&Measured> {
        let Resolved::Cube(cube) = &self.subject else { return None };
        let alone = cube.right.is_none() && !matches!(cube.depth, Some(Depth::Map(_)));
        (alone && shape.rows() * shape.columns() > KEPT).then_some(cube)
    }

    /// The answer by rows; `sink` takes the maps.
    pub(super) fn streamed(
        &self,
        cube: &Measured,
        plan: &RangePlan,
        sink: Option<&dyn MapSink>,
        progress: Progress<'_>,
    ) -> Result<Ranging> {
        let shape = cube.left.shape();
        let var_diffraction_px2 = self.var_diffraction_px2()?;
        let noise = cube.noise_per_unit()?;
        let noise = noise.as_ref().unwrap_or(&cube.noise);
        let place = |error: Error| error.at(self.scenario.place("cube.left"));
        let request = self.request(noise, &Cell::ALL, shape);
        let [rows, columns] = centres(shape, &request).map_err(place)?;
        if rows.is_empty() || columns.is_empty() {
            return Err(nothing_to_see());
        }
        let windows = rows.len() * columns.len();
        let depth_m = match cube.depth {
            Some(Depth::Uniform(depth_m)) => Some(depth_m),
            _ => None,
        };
        let setting = Setting {
            study: self,
            cube,
            shape,
            depth_m,
            var_diffraction_px2: [var_diffraction_px2, 0.0],
            step: step(rows.len(), columns.len()),
            lines: self.line_rows(&rows),
            rows,
            columns,
        };
        self.check_lines(&setting.lines, &setting.rows)?;
        if let Some(sink) = sink {
            sink.begin(&SIGNALS, setting.rows.len(), setting.columns.len())?;
        }
        let (counted, done) = (Counted::default(), AtomicUsize::new(0));
        information_by_rows(&cube.left, &request, &|cells| {
            setting.take(cells, &counted, sink)?;
            let so_far = done.fetch_add(cells.rows.len(), Ordering::Relaxed) + cells.rows.len();
            progress(so_far, setting.rows.len());
            Ok(())
        })
        .map_err(place)?;
        let all = setting.bounds(&counted)?;
        let missing_windows = counted.missing.load(Ordering::Relaxed);
        if all.windows == 0 {
            return Err(nothing_left(missing_windows));
        }
        let cells = setting.cells(&counted, &request)?;
        let solve_for = if plan.bounds_alone { None } else { setting.solutions(&counted)? };
        let ledger = Ledger::open();
        demand::add(&self.looked_up);
        demand::computed(Thing::Samples, shape.len() as u64);
        demand::computed(Thing::Windows, windows as u64);
        demand::computed(Thing::Sections, SECTIONS - 1);
        demand::spared(Thing::Sections, Reason::NotAsked, 1);
        let mut result = Ranging {
            scenario: self.scenario.clone(),
            verdict: self.resting(self.verdict(Some(&all), Some(windows))?, None),
            shape,
            read: self.read(),
            geometry: self.geometry(var_diffraction_px2)?,
            cells: Some(cells),
            objects: vec![all],
            solve_for,
            lines: setting.lines(&counted)?,
            matched: Vec::new(),
            quantile_error: Some(QUANTILE_ERROR),
            bad: self.bad(),
            missing_windows,
            maps_begin_at: Some([setting.rows.start, setting.columns.start]),
            stats: ledger.close(),
            warnings: Vec::new(),
            maps: setting.maps(&counted),
        };
        result.warnings = self.warnings(&result);
        Ok(result)
    }
}

/// Every so many rows and columns are shown of what is too large.
fn step(rows: usize, columns: usize) -> usize {
    (1..).find(|step| rows.div_ceil(*step) * columns.div_ceil(*step) <= KEPT).unwrap_or(1)
}

impl Setting<'_> {
    /// Takes some rows of windows into what is counted, and hands them on: a few at a time, whatever their width.
    fn take(&self, cells: &InformationMap, counted: &Counted, sink: Option<&dyn MapSink>) -> Result<()> {
        let height = (AT_ONCE / self.columns.len()).max(1);
        let parts = cells.rows.clone().step_by(height).map(|start| start..cells.rows.end.min(start + height));
        let mut part = InformationMap::default();
        for rows in parts {
            rows_of(cells, rows, &mut part);
            self.take_few(&part, counted, sink)?;
        }
        Ok(())
    }

    fn take_few(&self, cells: &InformationMap, counted: &Counted, sink: Option<&dyn MapSink>) -> Result<()> {
        let maps = self.cube.signals(cells, self.study.scenario.stereo.joined);
        let first = ((cells.rows.start - self.rows.start) * self.columns.len()) as u64;
        let errors = self.var_diffraction_px2.map(|var| [0, 1].map(|i| disparity_errors(maps.get(i), var)));
        let [with, _] = &errors;
        // A window counts if every signal has a bound of it.
        let [a, b] = with;
        let chosen = || (0..a.len().min(b.len())).filter(|i| !(a[*i].is_nan() || b[*i].is_nan()));
        let place = |i: usize| first + i as u64;
        for ((map, of), own) in maps.iter().zip(&counted.signals).zip(with) {
            let correspondence: Vec<(u64, f64)> =
                chosen().filter_map(|i| Some((place(i), map.window(i)?.var_content_px2().sqrt()))).collect();
            locked(&of.correspondence_px).count(correspondence.into_iter());
            locked(&of.disparity_error_px).count(chosen().filter_map(|i| Some((place(i), *own.get(i)?))));
            locked(&of.information).count(placed(first, &map.information));
            let met = match self.depth_m {
                None => 0,
                Some(depth_m) => {
                    let per_px = self.study.geometry.metres_per_pixel(depth_m);
                    let allowed_m = self.study.scenario.requirement.error.at(depth_m);
                    chosen().filter(|i| own.get(*i).is_some_and(|px| per_px * px <= allowed_m)).count()
                }
            };
            of.met.fetch_add(met, Ordering::Relaxed);
            of.windows.fetch_add(chosen().count(), Ordering::Relaxed);
        }
        if let Some(map) = maps.first() {
            let missing = map.information.iter().filter(|j| j.is_nan()).count();
            counted.missing.fetch_add(missing, Ordering::Relaxed);
            locked(&counted.photons).count(chosen().filter_map(|i| Some((place(i), *map.photons.get(i)?))));
        }
        if let Some(map) = maps.last() {
            locked(&counted.var_added)
                .count(chosen().filter_map(|i| Some((place(i), *map.var_added.get(i)?))));
        }
        let scaled = |cell: Cell| -> Vec<f64> {
            cells.cell(cell).iter().map(|j| j * self.cube.photons_per_unit).collect()
        };
        locked(&counted.total).count(placed(first, &scaled(Cell::Total)));
        locked(&counted.spectral).count(placed(first, &scaled(Cell::Spectral)));
        self.keep(cells, &errors, counted);
        if let Some(sink) = sink {
            for (signal, errors) in SIGNALS.into_iter().zip(with) {
                sink.put(signal, cells.rows.start - self.rows.start, errors)?;
            }
        }
        Ok(())
    }

    /// Keeps the rows that are lines or are shown.
    fn keep(&self, cells: &InformationMap, errors: &[[Vec<f64>; 2]; 2], counted: &Counted) {
        let width = self.columns.len();
        for (i, row) in cells.rows.clone().enumerate() {
            let of = |errors: &Vec<f64>| errors.get(i * width..(i + 1) * width).unwrap_or_default().to_vec();
            if self.lines.contains(&row) {
                locked(&counted.lines).insert(row, errors.each_ref().map(|pair| pair.each_ref().map(of)));
            }
            if (row - self.rows.start).is_multiple_of(self.step) {
                let [with, _] = errors;
                let thin = |errors: &Vec<f64>| of(errors).into_iter().step_by(self.step).collect();
                locked(&counted.shown).insert(row, with.each_ref().map(thin));
            }
        }
    }

    /// Bounds of all windows.
    fn bounds(&self, counted: &Counted) -> Result<ObjectBounds> {
        let requirement = self.study.scenario.requirement;
        let truth = Truth::default();
        let ground = self.ground(&truth);
        let in_depth = |error_px: f64| -> Result<Option<f64>> {
            self.depth_m.map(|depth_m| self.study.geometry.depth_error_m(depth_m, error_px)).transpose()
        };
        let one = |(signal, of): (Signal, &OfSignal)| -> Result<SignalBounds> {
            let windows = of.windows.load(Ordering::Relaxed);
            let photons = locked(&counted.photons).quantile(0.5);
            let errors = locked(&of.disparity_error_px);
            let mut depth_error_m = [0.0; 3];
            for (to, part) in depth_error_m.iter_mut().zip([0.1, 0.5, 0.9]) {
                *to = in_depth(errors.quantile(part))?.unwrap_or(f64::NAN);
            }
            let [_, median, _] = depth_error_m;
            let var_added = locked(&counted.var_added).quantile(0.5) / self.joined(signal);
            Ok(SignalBounds {
                signal,
                windows,
                photons,
                gamma: var_added / photons,
                information_per_px2: locked(&of.information).quantile(0.5),
                sigma_correspondence_px: locked(&of.correspondence_px).quantile(0.5),
                disparity_error_px: errors.quantile(0.5),
                depth_error_m: self.depth_m.map(|_| depth_error_m),
                relative_depth_error: self.depth_m.map(|depth_m| median / depth_m),
                share: self.depth_m.map(|_| of.met.load(Ordering::Relaxed) as f64 / windows as f64),
                largest_depth_m: (windows > 0)
                    .then(|| ground.largest_depth_m(errors.quantile_from_above(1.0 - requirement.share))),
            })
        };
        let signals = SIGNALS.into_iter().zip(&counted.signals).map(one).collect::<Result<Vec<_>>>()?;
        let windows = signals.first().map_or(0, |found| found.windows);
        let depth_m = self.depth_m.map(|depth_m| [depth_m; 3]);
        Ok(ObjectBounds { name: "all windows".to_owned(), windows, depth_m, signals })
    }

    /// By what the noise of the heat cube is divided for a signal.
    fn joined(&self, signal: Signal) -> f64 {
        let one = self.study.scenario.stereo.joined == Joined::OneReading;
        if signal == Signal::ThermalImage && one { self.shape.bands() as f64 } else { 1.0 }
    }

    fn ground<'a>(&'a self, truth: &'a Truth) -> Ground<'a> {
        Ground {
            geometry: &self.study.geometry,
            requirement: self.study.scenario.requirement,
            var_diffraction_px2: self.var_diffraction_px2[0],
            truth,
            columns: self.shape.columns(),
            windows_of: None,
        }
    }

    /// Windows, judged or not.
    fn windows(&self) -> usize {
        self.rows.len() * self.columns.len()
    }

    /// Medians of the four cells, and of the fullest by another derivative.
    fn cells(&self, counted: &Counted, request: &Request<'_>) -> Result<CellMedians> {
        let [spatial, full] = counted.signals.each_ref().map(|of| locked(&of.information).quantile(0.5));
        let other = Mutex::new(Distribution::default());
        let derivative = self.study.other_scheme();
        let request = Request { derivative, cells: &[Cell::Full], ..request.clone() };
        let found = information_by_rows(&self.cube.left, &request, &|map| {
            let other_map = SignalMap::of(Signal::HeatCube, Cell::Full, map);
            let mut values = Vec::with_capacity(other_map.information.len());
            for row in map.rows.clone().filter(|row| self.rows.contains(row)) {
                let own = self.columns.clone().filter_map(|column| other_map.at(row, column));
                values.extend(own.filter_map(|at| other_map.information.get(at).copied()));
            }
            locked(&other).count(values.into_iter().map(|j| (0, j)));
            Ok(())
        });
        let scale = self.cube.photons_per_unit;
        let other = found.ok().map(|()| locked(&other).quantile(0.5) * scale / full);
        Ok(CellMedians {
            total: locked(&counted.total).quantile(0.5),
            spatial,
            spectral: locked(&counted.spectral).quantile(0.5),
            full,
            other_derivative: other.filter(|other| full > 0.0 && !other.is_nan()),
        })
    }

    /// What would have to change, so that it holds for the demanded share of all windows.
    fn solutions(&self, counted: &Counted) -> Result<Option<DepthSolutions>> {
        let (Some(depth_m), [_, of]) = (self.depth_m, &counted.signals) else { return Ok(None) };
        let Some((error_px, window)) = self.at_share(&locked(&of.disparity_error_px)) else {
            return Ok(None);
        };
        let every = Every {
            pair: None,
            var_diffraction_px2: self.var_diffraction_px2[0],
            well: None,
            close: CLOSE_OF_MANY,
            ratio: &|change| self.ratio_with(depth_m, change),
            ratio_now: error_px / self.allowed_px(depth_m, &self.study.geometry),
        };
        self.study.solved(window, depth_m, &every)
    }

    /// The disparity error at the demanded share, and a window within a step of it.
    fn at_share(&self, errors: &Distribution) -> Option<(f64, (usize, usize))> {
        let rank = rank(self.study.scenario.requirement.share, self.windows());
        let (error_px, place) = errors.nth(rank as u64)?;
        let (row, column) = (place as usize / self.columns.len(), place as usize % self.columns.len());
        error_px.is_finite().then_some((error_px, (self.rows.start + row, self.columns.start + column)))
    }

    fn allowed_px(&self, depth_m: f64, geometry: &StereoGeometry) -> f64 {
        self.study.scenario.requirement.error.at(depth_m) / geometry.metres_per_pixel(depth_m)
    }

    /// The error at the demanded share of all windows over what is allowed, with a change: within a step of the histogram, on the side of
    /// 1 that the windows say.
    fn ratio_with(&self, depth_m: f64, change: Change) -> Result<Option<f64>> {
        let noise = self.cube.noise_per_unit()?;
        let noise = scaled(noise.as_ref().unwrap_or(&self.cube.noise), change.noise / change.photons)?;
        let request = self.study.request(&noise, &[Cell::Full], self.shape);
        let allowed_px = self.allowed_px(depth_m, &change.geometry);
        let (errors, met) = (Mutex::new(Distribution::default()), AtomicUsize::new(0));
        information_by_rows(&self.cube.left, &request, &|cells| {
            let map = SignalMap::of(DECIDES, Cell::Full, cells);
            let map = map.scaled(self.cube.photons_per_unit * change.photons);
            let own = disparity_errors(Some(&map), change.var_diffraction_px2);
            met.fetch_add(own.iter().filter(|px| **px <= allowed_px).count(), Ordering::Relaxed);
            let first = ((cells.rows.start - self.rows.start) * self.columns.len()) as u64;
            locked(&errors).count(placed(first, &own));
            Ok(())
        })?;
        let errors = locked(&errors);
        let share = met.load(Ordering::Relaxed) as f64 / self.windows() as f64;
        let met = share >= self.study.scenario.requirement.share;
        let found = self.at_share(&errors).map(|(error_px, _)| error_px / allowed_px);
        Ok(found.map(|ratio| if met { ratio.min(1.0) } else { ratio.max(1.0 + f64::EPSILON) }))
    }

    /// Bounds along the lines that are asked for.
    fn lines(&self, counted: &Counted) -> Result<Vec<Line>> {
        let kept = locked(&counted.lines);
        let mut lines = Vec::new();
        for (row, [with, without]) in self.lines.iter().filter_map(|row| Some((*row, kept.get(row)?))) {
            let maps = BoundMaps {
                rows: row..row + 1,
                columns: self.columns.clone(),
                depth_m: vec![self.depth_m.unwrap_or(f64::NAN); self.columns.len()],
                ..BoundMaps::default()
            };
            for ((signal, errors), sharp) in SIGNALS.into_iter().zip(with).zip(without) {
                lines.push(self.study.bound_line(row, signal, [errors, sharp], &maps)?);
            }
        }
        Ok(lines)
    }

    /// What is shown.
    fn maps(&self, counted: &Counted) -> BoundMaps {
        let shown = locked(&counted.shown);
        let of = |i: usize| shown.values().filter_map(|pair| pair.get(i)).flatten().copied().collect();
        let disparity_error_px: Vec<(Signal, Vec<f64>)> =
            SIGNALS.into_iter().enumerate().map(|(i, signal)| (signal, of(i))).collect();
        let pixels = disparity_error_px.first().map_or(0, |(_, values)| values.len());
        BoundMaps {
            rows: self.rows.clone(),
            columns: self.columns.clone(),
            step: self.step,
            disparity_error_px,
            depth_m: vec![self.depth_m.unwrap_or(f64::NAN); pixels],
            ..BoundMaps::default()
        }
    }
}

/// Some rows of a map.
fn rows_of(map: &InformationMap, rows: Range<usize>, part: &mut InformationMap) {
    let width = map.columns.len();
    let own = (rows.start - map.rows.start) * width..(rows.end - map.rows.start) * width;
    let copy = |from: &Vec<f64>, to: &mut Vec<f64>| {
        to.clear();
        to.extend_from_slice(from.get(own.clone()).unwrap_or_default());
    };
    map.information.iter().zip(&mut part.information).for_each(|(from, to)| copy(from, to));
    copy(&map.photons, &mut part.photons);
    copy(&map.var_added, &mut part.var_added);
    (part.rows, part.columns) = (rows, map.columns.clone());
}

/// Values with their places, of which the first is given.
fn placed(first: u64, values: &[f64]) -> impl Iterator<Item = (u64, f64)> {
    (first..).zip(values.iter().copied())
}

/// Disparity errors of the windows of a view that stands for both, pixels; NaN where there is none.
fn disparity_errors(map: Option<&SignalMap>, var_diffraction_px2: f64) -> Vec<f64> {
    let Some(map) = map else { return Vec::new() };
    let error = |i: usize| {
        let own = map.window(i)?.var_position_px2(var_diffraction_px2);
        Some((own + own).sqrt())
    };
    (0..map.information.len()).map(|i| error(i).unwrap_or(f64::NAN)).collect()
}

fn locked<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}
