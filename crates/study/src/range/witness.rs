//! Matching of views with noise: along lines many times, and once over the whole view.

use super::results::{BoundMaps, Line, Matched, Signal};
use super::subject::{Rendered, Resolved, Truth};
use super::{Informed, Progress, RangePlan, RangeStudy, median};
use hadar::cube::Shape;
use hadar::error::{Error, Result};
use hadar::ranging::metrics::DepthMetrics;
use hadar::ranging::noise::{Joined, NoiseVariance};
use hadar::statistics::Statistics;
use hadar_simulate::draws::{Draws, generator};
use hadar_simulate::efficiency::Criteria;
use hadar_simulate::matching::block::Block;
use hadar_simulate::matching::dense::disparity_map;
use hadar_simulate::matching::likelihood::Likelihood;
use hadar_simulate::matching::trials::{Centre, MatchingTrials, Noisy, Run, Setup};
use hadar_simulate::matching::{Matcher, Search, StereoPair};
use hadar_simulate::render::{Part, StereoPair as Rendering, View};
use std::ops::Range;

/// Disparities tried beyond the largest true one.
const BEYOND_PX: f64 = 4.0;
/// Share of outliers beyond which matches are guesses.
const GUESSES: f64 = 0.1;
/// The signals that are matched: what a thermal camera has, what a spectral one has, what the paper has.
const MATCHED: [Signal; 3] = [Signal::ThermalImage, Signal::HeatCube, Signal::ScatteredAsMeasured];

const MATCHED_IN_ONE_BAND: [Signal; 2] = [Signal::ThermalImage, Signal::ScatteredAsMeasured];

/// Expected counts of both views as a matcher gets them.
struct Views {
    shape: Shape,
    left: Vec<f64>,
    right: Vec<f64>,
    noise: NoiseVariance,
}

impl RangeStudy {
    /// Rows along which bounds are drawn: those of the scenario, or where a scene has both ground and objects.
    pub(super) fn line_rows(&self, rows: &Range<usize>) -> Vec<usize> {
        let own = &self.scenario.stereo.lines;
        match &self.subject {
            Resolved::Scene(_) if own.is_empty() => vec![(rows.end * 5 / 8).clamp(rows.start, rows.end - 1)],
            _ => own.clone(),
        }
    }

    /// Whether lines are among the rows that have whole windows.
    pub(super) fn check_lines(&self, lines: &[usize], rows: &Range<usize>) -> Result<()> {
        let Some(row) = lines.iter().find(|row| !rows.contains(row)) else { return Ok(()) };
        let found = format!("row {row} has no whole window");
        let instead = format!("choose rows from {} to {}", rows.start, rows.end.saturating_sub(1));
        Err(Error::malformed(found, instead).at(self.scenario.place("stereo.lines")))
    }

    /// Bounds along the lines of the scenario, with matches beside them where trials are asked for. The maps are those with
    /// diffraction and those without.
    pub(super) fn lines(
        &self,
        plan: &RangePlan,
        informed: &Informed,
        [maps, sharp]: [&BoundMaps; 2],
        progress: Progress<'_>,
    ) -> Result<Vec<Line>> {
        let mut lines = Vec::new();
        if maps.rows.is_empty() {
            return Ok(lines);
        }
        let rows = self.line_rows(&maps.rows);
        self.check_lines(&rows, &maps.rows)?;
        let one_band = self.shape()?.bands() == 1;
        let jobs = rows.len() * maps.disparity_error_px.len();
        for (i, &row) in rows.iter().enumerate() {
            for (k, (signal, errors)) in maps.disparity_error_px.iter().enumerate() {
                let sharp = sharp.disparity_error_px.get(k).map_or(&[][..], |(_, errors)| errors);
                let bound = self.bound_line(row, *signal, [errors, sharp], maps)?;
                // In one band the cube is the image, and nothing is reconstructed.
                if one_band && !MATCHED_IN_ONE_BAND.contains(signal) {
                    continue;
                }
                match (&self.subject, &informed.pair) {
                    (Resolved::Scene(scene), Some(pair)) if plan.trials > 0 && MATCHED.contains(signal) => {
                        let views = self.views(scene, pair, *signal)?;
                        for method in [Method::Block, Method::Likelihood] {
                            lines.push(self.witnessed(plan, &bound, method, &views)?);
                        }
                    }
                    _ => lines.push(bound),
                }
                progress(i * maps.disparity_error_px.len() + k + 1, jobs);
            }
        }
        Ok(lines)
    }

    pub(super) fn bound_line(
        &self,
        row: usize,
        signal: Signal,
        [errors, sharp]: [&[f64]; 2],
        maps: &BoundMaps,
    ) -> Result<Line> {
        let width = maps.columns.len();
        let from = (row - maps.rows.start) * width;
        let mut line = Line {
            row,
            signal,
            method: None,
            columns: Vec::new(),
            depth_m: Vec::new(),
            bound_m: Vec::new(),
            bound_without_diffraction_m: Vec::new(),
            rmse_m: Vec::new(),
            bias_m: Vec::new(),
            outliers: Vec::new(),
            scatter_over_bound: None,
            trials: 0,
        };
        for (i, column) in maps.columns.clone().enumerate() {
            let (Some(error), Some(depth_m)) = (errors.get(from + i), maps.depth_m.get(from + i)) else {
                continue;
            };
            if error.is_nan() {
                continue;
            }
            line.columns.push(column);
            line.depth_m.push(*depth_m);
            let in_depth = |error: f64| match depth_m.is_nan() || error.is_nan() {
                true => Ok(error),
                false => self.geometry.depth_error_m(*depth_m, error),
            };
            line.bound_m.push(in_depth(*error)?);
            line.bound_without_diffraction_m
                .push(in_depth(sharp.get(from + i).copied().unwrap_or(f64::NAN))?);
        }
        Ok(line)
    }

    /// The line with matches beside the bound. Depth errors are those of the disparity, δz = z²/(b f)·δd, also where they
    /// are large.
    fn witnessed(&self, plan: &RangePlan, bound: &Line, method: Method, views: &Views) -> Result<Line> {
        let disparity = |depth_m: &f64| self.geometry.disparity_px(*depth_m);
        let disparities = bound.depth_m.iter().map(disparity).collect::<Result<Vec<f64>>>()?;
        let search = search(&disparities)?;
        let centres: Vec<Centre> = bound
            .columns
            .iter()
            .zip(&disparities)
            .map(|(column, disparity)| Centre { row: bound.row, column: *column, disparity: *disparity })
            .collect();
        let window = self.scenario.stereo.window;
        let trials = MatchingTrials::new(&Setup {
            pair: &StereoPair::new(views.shape, &views.left, &views.right)?,
            noise: &views.noise,
            noisy: Noisy::Both,
            matcher: match method {
                Method::Block => Matcher::Block(Block::new(window)),
                Method::Likelihood => Matcher::Likelihood(Likelihood::new(window)),
            },
            search,
            centres: &centres,
        })?;
        // Every signal and method sees the same noise streams.
        let index = u32::try_from(bound.row).unwrap_or(u32::MAX);
        let matches = trials.run(Run { index, trials: plan.trials, seed: plan.seed });
        let mut line = Line { method: Some(method.name()), trials: plan.trials, ..bound.clone() };
        let report = matches.report(&[], &Criteria::default())?;
        for (centre, depth_m) in report.centres.iter().zip(&bound.depth_m) {
            let per_px = self.geometry.depth_error_m(*depth_m, 1.0)?;
            line.rmse_m.push(per_px * centre.errors.map_or(f64::NAN, |errors| errors.rmse));
            // More disparity is less depth.
            line.bias_m.push(-per_px * centre.errors.map_or(f64::NAN, |errors| errors.bias));
            line.outliers.push(centre.lost);
        }
        let scatter = line
            .rmse_m
            .iter()
            .zip(&line.bias_m)
            .map(|(rmse, bias)| ((rmse - bias) * (rmse + bias)).max(0.0).sqrt());
        let ratios: Vec<f64> = scatter
            .zip(&line.bound_without_diffraction_m)
            .map(|(scatter, bound)| scatter / bound)
            .filter(|ratio| ratio.is_finite())
            .collect();
        // Where matches are guesses, the range that is searched sets their scatter.
        let guesses = line.outliers.iter().sum::<f64>() > GUESSES * line.outliers.len() as f64;
        line.scatter_over_bound = (!ratios.is_empty() && !guesses).then(|| median(&ratios));
        Ok(line)
    }

    /// Both views as a signal has them.
    fn views(&self, scene: &Rendered, pair: &Rendering, signal: Signal) -> Result<Views> {
        let factor = scene.counting.counts_per_radiance;
        let part = if signal == Signal::ScatteredAsMeasured { Part::Scattered } else { Part::Total };
        let whole = |view: &View| Ok::<_, Error>(view.cube(part, factor)?.samples().to_vec());
        let (left, right, shape) = (whole(&pair.left)?, whole(&pair.right)?, pair.left.shape());
        if signal != Signal::ThermalImage {
            let noise = match &scene.noise {
                NoiseVariance::Uniform(var) => NoiseVariance::Uniform(*var),
                NoiseVariance::PerBand(var) => NoiseVariance::PerBand(var.clone()),
                NoiseVariance::None | NoiseVariance::PerSample(_) => NoiseVariance::None,
            };
            return Ok(Views { shape, left, right, noise });
        }
        let bands = shape.bands();
        let summed = |view: Vec<f64>| view.chunks_exact(bands).map(|pixel| pixel.iter().sum()).collect();
        let total = match &scene.noise {
            NoiseVariance::Uniform(var) => var * bands as f64,
            NoiseVariance::PerBand(var) => var.iter().sum(),
            NoiseVariance::None | NoiseVariance::PerSample(_) => 0.0,
        };
        let var = match self.scenario.stereo.joined {
            Joined::SumOfReadings => total,
            Joined::OneReading => total / bands as f64,
        };
        let noise = if var == 0.0 { NoiseVariance::None } else { NoiseVariance::Uniform(var) };
        Ok(Views {
            shape: Shape::new(shape.rows(), shape.columns(), 1)?,
            left: summed(left),
            right: summed(right),
            noise,
        })
    }

    /// Whole views matched once by blocks, where trials are asked for.
    pub(super) fn matched(&self, plan: &RangePlan, informed: &Informed) -> Result<Vec<Matched>> {
        let (Resolved::Scene(scene), Some(pair), true) = (&self.subject, &informed.pair, plan.trials > 0)
        else {
            return Ok(Vec::new());
        };
        let Truth { depth_m, seen, .. } = &informed.truth;
        let finite: Vec<f64> = depth_m.iter().copied().filter(|z| z.is_finite()).collect();
        let disparities =
            finite.iter().map(|z| self.geometry.disparity_px(*z)).collect::<Result<Vec<f64>>>()?;
        let search = search(&disparities)?;
        let block = Block::new(self.scenario.stereo.window);
        [Signal::ThermalImage, Signal::ScatteredAsMeasured]
            .into_iter()
            .map(|signal| {
                let views = self.views(scene, pair, signal)?.joined(self.scenario.stereo.joined)?;
                let noisy = |counts: &[f64], stream: u64| views.drawn(counts, plan.seed, stream);
                let (left, right) = (noisy(&views.left, 0)?, noisy(&views.right, 1)?);
                let map = disparity_map(&StereoPair::new(views.shape, &left, &right)?, &block, search)?;
                let columns = views.shape.columns();
                let found: Vec<f64> = (0..left.len())
                    .map(|at| match map.at(at / columns, at % columns) {
                        Some(Ok(disparity)) if disparity > 0.0 => {
                            self.geometry.depth_m(disparity).unwrap_or(f64::NAN)
                        }
                        _ => f64::NAN,
                    })
                    .collect();
                let mask: Vec<bool> =
                    seen.iter().zip(depth_m).map(|(seen, z)| *seen && z.is_finite()).collect();
                let metrics = DepthMetrics::of(&found, depth_m, Some(&mask))?;
                Ok(Matched { signal, metrics, depth_m: found })
            })
            .collect()
    }
}

impl Views {
    /// All bands together, as a picture.
    fn joined(self, joined: Joined) -> Result<Self> {
        let bands = self.shape.bands();
        if bands == 1 {
            return Ok(self);
        }
        let summed = |view: &[f64]| view.chunks_exact(bands).map(|pixel| pixel.iter().sum()).collect();
        let readings = match joined {
            Joined::SumOfReadings => bands as f64,
            Joined::OneReading => 1.0,
        };
        let noise = match &self.noise {
            NoiseVariance::Uniform(var) => NoiseVariance::Uniform(var * readings),
            NoiseVariance::PerBand(var) => {
                NoiseVariance::Uniform(var.iter().sum::<f64>() / bands as f64 * readings)
            }
            NoiseVariance::None | NoiseVariance::PerSample(_) => NoiseVariance::None,
        };
        let shape = Shape::new(self.shape.rows(), self.shape.columns(), 1)?;
        Ok(Self { shape, left: summed(&self.left), right: summed(&self.right), noise })
    }

    /// Counts drawn about their expectation.
    fn drawn(&self, counts: &[f64], seed: u64, stream: u64) -> Result<Vec<f64>> {
        let mut draws = Draws::new(&Statistics::Poisson, counts)?;
        if let NoiseVariance::Uniform(var) = self.noise {
            draws = draws.with_electronic_noise(&vec![var; counts.len()])?;
        }
        let mut drawn = vec![0.0; counts.len()];
        draws.draw_into(&mut generator(seed, WHOLE_VIEWS + stream), &mut drawn);
        Ok(drawn)
    }
}

/// The streams of whole views, beyond those of the lines.
const WHOLE_VIEWS: u64 = 1 << 62;

fn search(disparities: &[f64]) -> Result<Search> {
    let most = disparities.iter().copied().fold(0.0, f64::max) + BEYOND_PX;
    Search::new(0, most.ceil().min(f64::from(i32::MAX)) as i32)
}

#[derive(Debug, Clone, Copy)]
enum Method {
    Block,
    Likelihood,
}

impl Method {
    const fn name(self) -> &'static str {
        match self {
            Self::Block => "block matching",
            Self::Likelihood => "maximum likelihood",
        }
    }
}
