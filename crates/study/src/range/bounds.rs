//! From the information of two views to errors of disparity and depth, window by window and object by object.

use super::results::{BoundMaps, ObjectBounds, Signal, SignalBounds};
use super::signals::SignalMap;
use super::subject::Truth;
use hadar::error::Result;
use hadar::parallel;
use hadar::ranging::depth::StereoGeometry;
use hadar_scenario::range::{Demand, DepthRequirement};

/// Error over demand, row and column, and depth (m) of a window.
type Ranked = (f64, (usize, usize), f64);

/// A share of a number of windows that is whole but for rounding.
const RANK_ROUNDING: f64 = 1e-9;

/// The place, among so many windows in their order, of the first that leaves fewer than a share before it.
pub(super) fn rank(share: f64, windows: usize) -> usize {
    let reached = (share * windows as f64 - RANK_ROUNDING).ceil() as usize;
    reached.saturating_sub(1).min(windows.saturating_sub(1))
}

/// What the bounds of a study rest on.
pub(super) struct Ground<'a> {
    pub(super) geometry: &'a StereoGeometry,
    pub(super) requirement: DepthRequirement,
    /// σ_d², pixel².
    pub(super) var_diffraction_px2: f64,
    pub(super) truth: &'a Truth,
    /// Columns of the view.
    pub(super) columns: usize,
    /// Windows that a share is of, where it is not those that have a bound: the others reach nothing.
    pub(super) windows_of: Option<usize>,
}

/// A window as one signal has it.
#[derive(Debug, Clone, Copy)]
struct Bound {
    /// Place of the window in the left map.
    place: usize,
    depth_m: f64,
    /// Variance of the disparity, pixel².
    var_px2: f64,
}

impl Ground<'_> {
    /// Windows of the left view whose pixels the right camera sees too, by row and column; where depths are known at all, those
    /// whose centre has one.
    pub(super) fn windows(&self, map: &SignalMap, half: [usize; 2]) -> Vec<(usize, usize)> {
        let [half_rows, half_columns] = half;
        let mapped = self.truth.depth_m.iter().any(|depth_m| depth_m.is_finite());
        let has_depth = |row: usize, column: usize| {
            !mapped || self.truth.depth_m.get(row * self.columns + column).is_some_and(|z| z.is_finite())
        };
        let whole = |row: usize, column: usize| {
            has_depth(row, column)
                && (row - half_rows..=row + half_rows).all(|y| {
                    let pixels =
                        y * self.columns + column - half_columns..=y * self.columns + column + half_columns;
                    // The sky is infinitely far: it has no depth, and no texture of its own.
                    self.truth
                        .depth_m
                        .get(pixels.clone())
                        .is_some_and(|depths| depths.iter().all(|z| !z.is_infinite()))
                        && self.truth.seen.get(pixels).is_some_and(|seen| seen.iter().all(|seen| *seen))
                })
        };
        let centres = |row: usize| {
            map.columns
                .clone()
                .map(move |column| (row, column))
                .filter(|&(y, x)| whole(y, x))
                .collect::<Vec<_>>()
        };
        parallel::map(map.rows.len(), |i| centres(map.rows.start + i)).concat()
    }

    /// Disparity variance of every window, pixel²; NaN where the right view has no such window.
    pub(super) fn variances(
        &self,
        left: &SignalMap,
        right: Option<&SignalMap>,
        windows: &[(usize, usize)],
    ) -> Vec<f64> {
        let one =
            |map: &SignalMap, at: usize| Some(map.window(at)?.var_position_px2(self.var_diffraction_px2));
        let both = |&(row, column): &(usize, usize)| {
            let own = one(left, left.at(row, column)?)?;
            let depth_m = *self.truth.depth_m.get(row * self.columns + column)?;
            let partner = match right {
                Some(right) if depth_m.is_finite() => {
                    let shifted = column as f64 - self.geometry.disparity_px(depth_m).ok()?;
                    let there =
                        (shifted.round() >= 0.0).then(|| right.at(row, shifted.round() as usize))??;
                    one(right, there)?
                }
                _ => own,
            };
            Some(own + partner)
        };
        windows.iter().map(|window| both(window).unwrap_or(f64::NAN)).collect()
    }

    /// The window that the demanded share of the windows does as well as, or better: its error over what is allowed, its centre and depth.
    pub(super) fn decisive(&self, windows: &[(usize, usize)], var: &[f64]) -> Result<Option<Ranked>> {
        let mut ranked = Vec::with_capacity(windows.len());
        for (window, var) in windows.iter().zip(var) {
            let depth_m =
                self.truth.depth_m.get(window.0 * self.columns + window.1).copied().unwrap_or(f64::NAN);
            if depth_m.is_finite() && !var.is_nan() {
                let error = self.geometry.depth_error_m(depth_m, var.sqrt())?;
                ranked.push((error / self.requirement.error.at(depth_m), *window, depth_m));
            }
        }
        if ranked.is_empty() {
            return Ok(None);
        }
        let rank = rank(self.requirement.share, self.windows_of.unwrap_or(ranked.len()));
        if rank >= ranked.len() {
            return Ok(None);
        }
        let (_, decisive, _) =
            ranked.select_nth_unstable_by(rank, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        Ok(Some(*decisive))
    }

    /// Bounds of the windows on each object, all of them together first.
    pub(super) fn objects(
        &self,
        windows: &[(usize, usize)],
        maps: &[SignalMap],
        variances: &[Vec<f64>],
    ) -> Result<Vec<ObjectBounds>> {
        let name_of =
            |&(row, column): &(usize, usize)| self.truth.object.get(row * self.columns + column).copied();
        let of = |i: usize| {
            let Some(i) = i.checked_sub(1) else {
                return Some(self.object("all windows", windows, maps, variances, &|_| true));
            };
            let own = |window: &(usize, usize)| name_of(window) == u8::try_from(i).ok();
            windows.iter().any(own).then(|| self.object(&self.truth.names[i], windows, maps, variances, &own))
        };
        parallel::map(1 + self.truth.names.len(), of).into_iter().flatten().collect()
    }

    fn object(
        &self,
        name: &str,
        windows: &[(usize, usize)],
        maps: &[SignalMap],
        variances: &[Vec<f64>],
        own: &(dyn Fn(&(usize, usize)) -> bool + Sync),
    ) -> Result<ObjectBounds> {
        // A window counts if it has a partner in every signal that a camera measures: what only might be does not decide.
        let measured = |map: &SignalMap| map.signal != Signal::ScatteredAsMeasured;
        let has_partner =
            |i: usize| maps.iter().zip(variances).all(|(map, var)| !(measured(map) && var[i].is_nan()));
        let chosen: Vec<usize> = (0..windows.len()).filter(|&i| own(&windows[i]) && has_partner(i)).collect();
        let depth = |i: usize| {
            let (row, column) = windows[i];
            self.truth.depth_m.get(row * self.columns + column).copied().unwrap_or(f64::NAN)
        };
        let depths: Vec<f64> = chosen.iter().map(|&i| depth(i)).filter(|z| z.is_finite()).collect();
        let signals = parallel::try_map(maps.len().min(variances.len()), |at| {
            let (map, var) = (&maps[at], &variances[at]);
            let bound = |&i: &usize| {
                let place = map.at(windows[i].0, windows[i].1)?;
                Some(Bound { place, depth_m: depth(i), var_px2: var[i] })
            };
            let bounds: Vec<Bound> = chosen.iter().filter(|&&i| !var[i].is_nan()).filter_map(bound).collect();
            self.signal(map, &bounds)
        })?;
        let depth_m = (!depths.is_empty()).then(|| [0.0, 0.5, 1.0].map(|part| quantile(&depths, part)));
        Ok(ObjectBounds { name: name.to_owned(), windows: chosen.len(), depth_m, signals })
    }

    fn signal(&self, map: &SignalMap, bounds: &[Bound]) -> Result<SignalBounds> {
        let of = |values: &[f64]| {
            median(&bounds.iter().filter_map(|bound| values.get(bound.place).copied()).collect::<Vec<_>>())
        };
        let photons = of(&map.photons);
        let gamma = of(&map.var_added) / photons;
        let correspondence: Vec<f64> = bounds
            .iter()
            .filter_map(|bound| Some(map.window(bound.place)?.var_content_px2().sqrt()))
            .collect();
        let disparities: Vec<f64> = bounds.iter().map(|bound| bound.var_px2.sqrt()).collect();
        let with_depth: Vec<&Bound> = bounds.iter().filter(|bound| bound.depth_m.is_finite()).collect();
        let errors = with_depth
            .iter()
            .map(|bound| self.geometry.depth_error_m(bound.depth_m, bound.var_px2.sqrt()))
            .collect::<Result<Vec<f64>>>()?;
        let known = !errors.is_empty();
        let relative: Vec<f64> =
            errors.iter().zip(&with_depth).map(|(error, bound)| error / bound.depth_m).collect();
        let met = errors
            .iter()
            .zip(&with_depth)
            .filter(|(error, bound)| **error <= self.requirement.error.at(bound.depth_m))
            .count();
        let farthest: Vec<f64> =
            bounds.iter().map(|bound| self.largest_depth_m(bound.var_px2.sqrt())).collect();
        Ok(SignalBounds {
            signal: map.signal,
            windows: bounds.len(),
            photons,
            gamma,
            information_per_px2: of(&map.information),
            sigma_correspondence_px: median(&correspondence),
            disparity_error_px: median(&disparities),
            depth_error_m: known.then(|| [0.1, 0.5, 0.9].map(|part| quantile(&errors, part))),
            relative_depth_error: known.then(|| median(&relative)),
            share: known.then(|| met as f64 / errors.len() as f64),
            largest_depth_m: (!farthest.is_empty())
                .then(|| quantile(&farthest, 1.0 - self.requirement.share)),
        })
    }

    /// The depth at which a window of this disparity error would just reach the demand, its image as it is.
    pub(super) fn largest_depth_m(&self, disparity_error_px: f64) -> f64 {
        // δz = c δd z².
        let slope = self.geometry.metres_per_pixel(1.0) * disparity_error_px;
        match self.requirement.error {
            Demand::Absolute(error_m) => (error_m / slope).sqrt(),
            Demand::Relative(share) => share / slope,
        }
    }

    /// Maps of the disparity errors, for pictures.
    pub(super) fn maps(
        &self,
        windows: &[(usize, usize)],
        maps: &[SignalMap],
        variances: &[Vec<f64>],
    ) -> BoundMaps {
        let Some(first) = maps.first() else { return BoundMaps::default() };
        let (rows, columns) = (first.rows.clone(), first.columns.clone());
        let spread = |values: &[f64]| {
            let mut map = vec![f64::NAN; rows.len() * columns.len()];
            for (window, value) in windows.iter().zip(values) {
                if let Some(to) = first.at(window.0, window.1).and_then(|at| map.get_mut(at)) {
                    *to = value.sqrt();
                }
            }
            map
        };
        let centres =
            rows.clone().flat_map(|row| columns.clone().map(move |column| row * self.columns + column));
        let depth_m = centres.map(|at| self.truth.depth_m.get(at).copied().unwrap_or(f64::NAN)).collect();
        let disparity_error_px: Vec<(Signal, Vec<f64>)> =
            parallel::map(maps.len().min(variances.len()), |i| (maps[i].signal, spread(&variances[i])));
        BoundMaps { rows, columns, disparity_error_px, depth_m, ..BoundMaps::default() }
    }
}

/// The middle one of the values.
#[must_use]
pub fn median(values: &[f64]) -> f64 {
    quantile(values, 0.5)
}

/// The value that a share `part` of `values` does not exceed, the nearest rank; NaN without values.
pub fn quantile(values: &[f64], part: f64) -> f64 {
    let mut sorted = values.to_vec();
    let last = sorted.len().saturating_sub(1);
    let rank = (part * last as f64).round() as usize;
    match sorted.get_mut(..) {
        Some([]) | None => f64::NAN,
        Some(values) => *values.select_nth_unstable_by(rank.min(last), f64::total_cmp).1,
    }
}
