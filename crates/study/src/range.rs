//! A ranging scenario answered: bounds of every window by each signal, what would have to change, witnesses.

mod bounds;
mod distribution;
mod looked_up;
mod overfull;
mod resolve;
mod results;
mod signals;
mod solve;
mod streamed;
mod subject;
mod verdict;
mod verified;
mod watched;
mod witness;

pub use looked_up::RangeStudy;
pub(crate) use overfull::Overfull;
pub use results::{
    BadInView, BoundMaps, CellMedians, DepthFinding, DepthSolutions, DepthVerdict, Geometry, Line, Matched,
    ObjectBounds, PictureKind, Ranging, Signal, SignalBounds,
};

pub use bounds::{median, quantile};
pub(super) use resolve::camera_noise;

use self::bounds::Ground;
use self::looked_up::SECTIONS;
use self::signals::SignalMap;
use self::subject::{Resolved, Truth, nothing_left, nothing_to_see};
use super::{Warning, memory};
use crate::budget::Takes;
use hadar::cube::{Cube, Shape};
use hadar::demand::{self, Ledger, Skipping, Thing};
use hadar::error::Result;
use hadar::parallel;
use hadar::ranging::depth::StereoGeometry;
use hadar::ranging::derivative::Derivative;
use hadar::ranging::information::{Cell, InformationMap, Request, information};
use hadar::ranging::noise::NoiseVariance;
use hadar::spectrum::Bands;
use hadar_formats::cube::Found;
use hadar_scenario::RangeScenario;
use hadar_simulate::render::{Part, StereoPair};
use std::sync::Arc;

/// Bytes of a pixel that are kept of cubes, beside those of the file; measured.
const ONE_VIEW: u64 = 320;
const TWO_VIEWS: u64 = 430;

/// How a study is to be answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct RangePlan {
    /// Draws of the noise that are matched; none for the bounds alone.
    pub trials: usize,
    /// Seed of the draws.
    pub seed: u64,
    /// Whether what a proof makes needless is left out; the answer is the same.
    pub skipping: Skipping,
    /// Whether yes or no is enough.
    pub verdict_alone: bool,
    /// Whether what would have to change is left out, whose every look may render the scene.
    pub bounds_alone: bool,
    /// Whether signals are left out that nobody counts: parts of the light of a rendered scene.
    pub counted_alone: bool,
}

/// Is told how much of how much is done.
pub type Progress<'a> = &'a (dyn Fn(usize, usize) + Sync);

/// Takes the maps of what is too large to be kept, as their rows are made.
pub trait MapSink: Sync {
    /// Maps of the least disparity error of these signals will come, of so many rows and columns.
    ///
    /// # Errors
    /// No room for them.
    fn begin(&self, signals: &[Signal], rows: usize, columns: usize) -> Result<()>;

    /// Whole rows of one of them, pixels, from row `first` on; in any order, by several threads.
    ///
    /// # Errors
    /// No room for them.
    fn put(&self, signal: Signal, first: usize, disparity_error_px: &[f64]) -> Result<()>;
}

/// Information of every window in both views.
struct Informed {
    left: Vec<SignalMap>,
    /// Empty where there is no right view.
    right: Vec<SignalMap>,
    /// The four cells of the left view.
    cells: InformationMap,
    truth: Truth,
    /// Of a scene, with the counts of its left view.
    pair: Option<Arc<StereoPair>>,
    counts: Option<Cube>,
}

impl RangeStudy {
    /// What it takes at least.
    #[must_use]
    pub fn takes(&self) -> Takes {
        let bands = self.bands.as_ref().map_or(1, Bands::len);
        match &self.subject {
            Resolved::Scene(scene) => Takes::of_samples([scene.rig.rows, scene.rig.columns, bands]),
            Resolved::Cube(cube) => {
                let shape = cube.left.shape();
                Takes::of_samples([shape.rows(), shape.columns(), shape.bands()])
            }
        }
    }

    /// The scenario.
    #[must_use]
    pub fn scenario(&self) -> &RangeScenario {
        &self.scenario
    }

    /// Rows, columns and bands of a view.
    ///
    /// # Errors
    /// A scene without bands.
    pub fn shape(&self) -> Result<Shape> {
        match &self.subject {
            Resolved::Scene(scene) => {
                Shape::new(scene.rig.rows, scene.rig.columns, self.bands.as_ref().map_or(0, Bands::len))
            }
            Resolved::Cube(cube) => Ok(cube.left.shape()),
        }
    }

    /// What the file of the left view was read as.
    fn read(&self) -> Option<Found> {
        match &self.subject {
            Resolved::Cube(cube) => Some(cube.read.clone()),
            Resolved::Scene(_) => None,
        }
    }

    /// Expected counts of the left view of a scene, and their noise; `None` of cubes, which are there.
    ///
    /// # Errors
    /// A scene that cannot be rendered.
    pub fn rendered_left(&self, progress: Progress<'_>) -> Result<Option<(Cube, &NoiseVariance)>> {
        let (Resolved::Scene(scene), Some(bands)) = (&self.subject, &self.bands) else { return Ok(None) };
        let pair = scene.scene.render(&scene.rig, bands, &scene.options, progress)?;
        Ok(Some((scene.counts(&pair.left, Part::Total)?, &scene.noise)))
    }

    /// The stereo geometry.
    #[must_use]
    pub fn stereo_geometry(&self) -> &StereoGeometry {
        &self.geometry
    }

    /// The bounds, what would have to change, and the witnesses that the plan asks for.
    ///
    /// # Errors
    /// Counts that are negative or no numbers, a window that does not fit into the view, files that cannot be read.
    pub fn range(
        &self,
        plan: &RangePlan,
        sink: Option<&dyn MapSink>,
        progress: Progress<'_>,
    ) -> Result<Ranging> {
        self.range_of(plan, None, sink, progress)
    }

    /// The scene as both of its cameras see it; `None` of cubes.
    ///
    /// # Errors
    /// A scene that cannot be rendered.
    pub(crate) fn rendered(&self, progress: Progress<'_>) -> Result<Option<Arc<StereoPair>>> {
        let (Resolved::Scene(scene), Some(bands)) = (&self.subject, &self.bands) else { return Ok(None) };
        let at = |error: hadar::Error| error.at(self.scenario.place("scene"));
        let pair = scene.scene.render(&scene.rig, bands, &scene.options, progress).map_err(at)?;
        Ok(Some(Arc::new(pair)))
    }

    /// Whether another camera, however much noise it has, has the same scene before it and sees the same of it.
    pub(crate) fn is_rendered_as(&self, other: &Self) -> bool {
        match (&self.subject, &other.subject) {
            (Resolved::Scene(own), Resolved::Scene(others)) => {
                self.scenario.subject == other.scenario.subject
                    && self.bands == other.bands
                    && own.rig == others.rig
                    && own.options == others.options
            }
            _ => false,
        }
    }

    /// As [`Self::range`], of a scene that was rendered, perhaps for another camera.
    pub(crate) fn range_of(
        &self,
        plan: &RangePlan,
        rendered: Option<&Arc<StereoPair>>,
        sink: Option<&dyn MapSink>,
        progress: Progress<'_>,
    ) -> Result<Ranging> {
        let shape = self.shape()?;
        if plan.verdict_alone
            && plan.skipping == Skipping::On
            && let Some(result) = self.verdict_alone(shape)?
        {
            return Ok(result);
        }
        if let Some(cube) = self.too_large_to_keep(shape) {
            return self.streamed(cube, plan, sink, progress);
        }
        let informed = self.informed(shape, (rendered, plan.counted_alone), progress)?;
        let ground = self.ground(&informed.truth, shape)?;
        let window = self.scenario.stereo.window;
        let Some(first) = informed.left.first() else { return Err(nothing_to_see()) };
        let windows = ground.windows(first, [window.half_rows(), window.half_columns()]);
        let of_all = |ground: &Ground<'_>, windows: &[(usize, usize)]| -> Vec<Vec<f64>> {
            let of = |i: usize| ground.variances(&informed.left[i], informed.right.get(i), windows);
            parallel::map(informed.left.len(), of)
        };
        let variances = of_all(&ground, &windows);
        let objects = ground.objects(&windows, &informed.left, &variances)?;
        let is_missing = |map: &SignalMap| map.information.iter().filter(|j| j.is_nan()).count();
        let missing_windows = match &self.subject {
            Resolved::Cube(_) => informed.left.first().map_or(0, is_missing),
            Resolved::Scene(_) => 0,
        };
        if objects.first().is_none_or(|all| all.windows == 0) {
            return Err(nothing_left(missing_windows));
        }
        let mut maps = ground.maps(&windows, &informed.left, &variances);
        if let Some(pair) = &informed.pair {
            maps.pictures = self.pictures(pair);
            maps.brightest = self.brightest(pair)?;
        }
        let solve_for = match plan.bounds_alone {
            true => None,
            false => {
                let ground = Ground { windows_of: self.windows_of(&informed, shape), ..ground };
                self.solutions(&informed, shape, (&ground, &windows), &variances)?
            }
        };
        // The views that are matched have no diffraction.
        let sharp = Ground { var_diffraction_px2: 0.0, ..self.ground(&informed.truth, shape)? };
        let rows = self.line_rows(&maps.rows);
        let on_lines: Vec<_> = windows.iter().copied().filter(|(row, _)| rows.contains(row)).collect();
        let sharp = sharp.maps(&on_lines, &informed.left, &of_all(&sharp, &on_lines));
        let lines = self.lines(plan, &informed, [&maps, &sharp], progress)?;
        let ledger = Ledger::open();
        demand::add(&self.looked_up);
        let views = if informed.right.is_empty() { 1 } else { 2 };
        demand::computed(Thing::Samples, (shape.len() * views) as u64);
        demand::computed(Thing::Windows, windows.len() as u64);
        demand::computed(Thing::Sections, SECTIONS - 1);
        let matched = demand::if_asked(plan.trials > 0, Thing::Sections, 1, || {
            let matched = self.matched(plan, &informed)?;
            let of_lines: usize = lines.iter().map(|line| line.trials).sum();
            demand::computed(Thing::MatchedViews, (matched.len() + of_lines) as u64);
            Ok(matched)
        })?;
        let mut result = Ranging {
            scenario: self.scenario.clone(),
            verdict: self
                .resting(self.verdict(objects.first(), self.windows_of(&informed, shape))?, maps.brightest),
            read: self.read(),
            shape,
            geometry: self.geometry(ground.var_diffraction_px2)?,
            cells: self.cell_medians(&informed, &windows)?,
            objects,
            solve_for,
            lines,
            matched: matched.unwrap_or_default(),
            quantile_error: None,
            bad: self.bad(),
            missing_windows,
            maps_begin_at: Some([maps.rows.start, maps.columns.start]),
            stats: ledger.close(),
            warnings: Vec::new(),
            maps,
        };
        result.warnings = self.warnings(&result);
        Ok(result)
    }

    /// What was found to be bad in the views, where anything was.
    fn bad(&self) -> Vec<BadInView> {
        let Resolved::Cube(cube) = &self.subject else { return Vec::new() };
        let views = ["left", "right"].into_iter().zip(&cube.bad);
        let found = views.filter(|(_, found)| !found.pixels.is_empty());
        let of = |(view, found): (&'static str, &crate::cube_bad::BadFound)| BadInView {
            view,
            pixels: found.pixels.clone(),
            map: found.map.clone(),
        };
        found.map(of).collect()
    }

    /// Windows of the left view of a cube, judged or not, but for those that show what is infinitely far; `None` of scenes, all of which is
    /// known.
    fn windows_of(&self, informed: &Informed, shape: Shape) -> Option<usize> {
        let (Resolved::Cube(_), Some(map)) = (&self.subject, informed.left.first()) else { return None };
        let half = [self.scenario.stereo.window.half_rows(), self.scenario.stereo.window.half_columns()];
        let depth_m = &informed.truth.depth_m;
        if !depth_m.iter().any(|depth_m| depth_m.is_infinite()) {
            return Some(map.rows.len() * map.columns.len());
        }
        let [half_rows, half_columns] = half;
        let is_far = |row: usize, column: usize| {
            (row - half_rows..=row + half_rows).any(|y| {
                let first = y * shape.columns() + column;
                depth_m
                    .get(first - half_columns..=first + half_columns)
                    .is_some_and(|depths| depths.iter().any(|depth_m| depth_m.is_infinite()))
            })
        };
        let of_row =
            |i: usize| map.columns.clone().filter(|column| !is_far(map.rows.start + i, *column)).count();
        Some(parallel::map(map.rows.len(), of_row).into_iter().sum())
    }

    fn request<'a>(&self, noise: &'a NoiseVariance, cells: &'a [Cell], shape: Shape) -> Request<'a> {
        let stereo = &self.scenario.stereo;
        Request {
            window: stereo.window,
            derivative: stereo.derivative,
            noise,
            joined: stereo.joined,
            cells,
            centres: 0..shape.rows(),
        }
    }

    fn informed(
        &self,
        shape: Shape,
        (rendered, counted_alone): (Option<&Arc<StereoPair>>, bool),
        progress: Progress<'_>,
    ) -> Result<Informed> {
        match (&self.subject, &self.bands) {
            (Resolved::Scene(scene), Some(bands)) => {
                let own = if rendered.is_none() { self.rendered(progress)? } else { None };
                let pair = rendered.cloned().or(own).ok_or_else(nothing_to_see)?;
                let request = self.request(&scene.noise, &Cell::ALL, shape);
                let (left, cells, counts) =
                    signals::of_scene(scene, &pair.left, (bands, counted_alone), &request)?;
                let (right, ..) = signals::of_scene(scene, &pair.right, (bands, counted_alone), &request)?;
                let truth = Truth::of_scene(&scene.scene, &pair.left);
                Ok(Informed { left, right, cells, truth, pair: Some(pair), counts: Some(counts) })
            }
            (Resolved::Scene(_), None) => Err(nothing_to_see()),
            (Resolved::Cube(cube), _) => {
                let per_pixel = if cube.right.is_some() { TWO_VIEWS } else { ONE_VIEW };
                let pixels = (shape.rows() * shape.columns()) as u64;
                let instead =
                    "give one view and one depth, which is worked on by rows, or cut the cubes into parts";
                let _memory =
                    memory::promise(per_pixel * pixels, "two views or a depth of every pixel", instead)
                        .map_err(|error| error.at(self.scenario.place("cube")))?;
                let noise = cube.noise_per_unit()?;
                let of = |cells: &InformationMap| cube.signals(cells, self.scenario.stereo.joined);
                let place = |key: &'static str| move |error: hadar::Error| error.at(self.scenario.place(key));
                let noise = noise.as_ref().unwrap_or(&cube.noise);
                let cells = information(&cube.left, &self.request(noise, &Cell::ALL, shape))
                    .map_err(place("cube.left"))?;
                let right = match &cube.right {
                    Some(right) => {
                        let both = [Cell::Spatial, Cell::Full];
                        let found = information(right, &self.request(noise, &both, shape))
                            .map_err(place("cube.right"))?;
                        of(&found)
                    }
                    None => Vec::new(),
                };
                let truth = Truth::of_cube(cube.depth.as_ref(), shape);
                Ok(Informed { left: of(&cells), right, cells, truth, pair: None, counts: None })
            }
        }
    }

    fn ground<'a>(&'a self, truth: &'a Truth, shape: Shape) -> Result<Ground<'a>> {
        Ok(Ground {
            geometry: &self.geometry,
            requirement: self.scenario.requirement,
            var_diffraction_px2: self.var_diffraction_px2()?,
            truth,
            columns: shape.columns(),
            windows_of: None,
        })
    }

    fn geometry(&self, var_diffraction_px2: f64) -> Result<Geometry> {
        Ok(Geometry {
            baseline_m: self.geometry.baseline_m(),
            focal_length_m: self.geometry.focal_length_m(),
            pixel_m: self.geometry.pitch_m(),
            disparity_at_10_m_px: self.geometry.disparity_px(10.0)?,
            depth_error_per_px_at_10_m: self.geometry.depth_error_m(10.0, 1.0)?,
            sigma_diffraction_px: var_diffraction_px2.sqrt(),
        })
    }

    /// Medians of the four cells in the left view, and of the fullest by another derivative.
    fn cell_medians(&self, informed: &Informed, windows: &[(usize, usize)]) -> Result<Option<CellMedians>> {
        let Some(first) = informed.left.first() else { return Ok(None) };
        let of = |map: &InformationMap, cell: Cell, scale: f64| {
            let values = map.cell(cell);
            let at = |&(row, column): &(usize, usize)| values.get(first.at(row, column)?).map(|j| j * scale);
            median(&windows.iter().filter_map(at).filter(|j| !j.is_nan()).collect::<Vec<_>>())
        };
        let scale = match &self.subject {
            Resolved::Scene(_) => 1.0,
            Resolved::Cube(cube) => cube.photons_per_unit,
        };
        let map = &informed.cells;
        Ok(Some(CellMedians {
            total: of(map, Cell::Total, scale),
            spatial: of(map, Cell::Spatial, scale),
            spectral: of(map, Cell::Spectral, scale),
            full: of(map, Cell::Full, scale),
            other_derivative: self.other_derivative(informed, windows, of(map, Cell::Full, scale) / scale)?,
        }))
    }

    /// Another derivative than that asked for.
    const fn other_scheme(&self) -> Derivative {
        match self.scenario.stereo.derivative {
            Derivative::Central => Derivative::CubicSpline,
            _ => Derivative::Central,
        }
    }

    /// J of the heat cube by another derivative over that asked for, medians; the windows are those of the map that has fewer.
    fn other_derivative(
        &self,
        informed: &Informed,
        windows: &[(usize, usize)],
        own: f64,
    ) -> Result<Option<f64>> {
        let (shape, derivative) = (self.shape()?, self.other_scheme());
        let noise;
        let (cube, noise): (&Cube, &NoiseVariance) = match (&self.subject, &informed.counts) {
            (Resolved::Scene(scene), Some(counts)) => (counts, &scene.noise),
            (Resolved::Cube(cube), _) => {
                noise = cube.noise_per_unit()?;
                (&cube.left, noise.as_ref().unwrap_or(&cube.noise))
            }
            (Resolved::Scene(_), None) => return Ok(None),
        };
        let request = Request { derivative, ..self.request(noise, &[Cell::Full], shape) };
        let Ok(map) = information(cube, &request) else { return Ok(None) };
        let map = SignalMap::of(Signal::HeatCube, Cell::Full, &map);
        let at = |&(row, column): &(usize, usize)| map.information.get(map.at(row, column)?).copied();
        let other = median(&windows.iter().filter_map(at).filter(|j| !j.is_nan()).collect::<Vec<_>>());
        Ok((own > 0.0).then(|| other / own).filter(|ratio| !ratio.is_nan()))
    }

    /// Photons of the brightest sample of a frame.
    fn brightest(&self, pair: &StereoPair) -> Result<Option<f64>> {
        let (Resolved::Scene(scene), Some(camera)) = (&self.subject, &self.camera) else { return Ok(None) };
        if camera.full_well.is_none() {
            return Ok(None);
        }
        let counts = pair.left.cube(Part::Total, scene.counting.counts_per_radiance)?;
        let most = counts.samples().iter().copied().fold(0.0, f64::max);
        Ok(Some(most / f64::from(camera.frames)))
    }

    /// Pictures of the left view, sums over the bands.
    fn pictures(&self, pair: &StereoPair) -> Vec<(PictureKind, Vec<f64>)> {
        let Resolved::Scene(scene) = &self.subject else { return Vec::new() };
        let view = &pair.left;
        let summed = |part: Part| view.sums(part, scene.counting.counts_per_radiance);
        let sky = |depth: &f64| depth.is_infinite();
        let hidden = |values: Vec<f64>| -> Vec<f64> {
            values
                .into_iter()
                .zip(&view.depth_m)
                .map(|(value, z)| if sky(z) { f64::NAN } else { value })
                .collect()
        };
        let surfaces = view.lighting.len() / view.depth_m.len().max(1);
        // The sky is the first of the surfaces.
        let not_sky =
            view.lighting.chunks_exact(surfaces.max(1)).map(|v| 1.0 - v.first().unwrap_or(&0.0)).collect();
        vec![
            (PictureKind::ThermalImage, summed(Part::Total)),
            (PictureKind::Scattered, hidden(summed(Part::Scattered))),
            (PictureKind::Temperature, view.temperature_k.iter().map(|t| t - 273.15).collect()),
            (PictureKind::Lighting, hidden(not_sky)),
            (PictureKind::Depth, view.depth_m.clone()),
        ]
    }

    fn warnings(&self, result: &Ranging) -> Vec<Warning> {
        verdict::warnings(self, result)
    }
}
