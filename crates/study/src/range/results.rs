//! What a ranging study finds, as data.

use crate::cube_bad::BadPixels;
use crate::{Condition, Warning};
use hadar::cube::Shape;
use hadar::demand::Work;
use hadar::ranging::depth::DepthSolution;
use hadar::ranging::metrics::DepthMetrics;
use hadar_formats::cube::Found;
use hadar_scenario::RangeScenario;
use hadar_scenario::range::Demand;
use serde::Serialize;
use std::ops::Range;

hadar::named! {
    /// What depth is read from.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Signal {
        /// All bands counted together, pixel by pixel: thermal imaging.
        ThermalImage = "thermal image",
        /// All bands apart: what no algorithm can beat.
        HeatCube = "heat cube",
        /// What remains of it where the temperature of every pixel is unknown and estimated from the bands: lighting and
        /// emissivity as they are reconstructed, with the noise of that.
        Reconstructed = "cube, T estimated",
        /// The same where the strength of the emission is unknown and estimated too: scattered light alone, as it is
        /// reconstructed where the texture of the emissivity is not known beforehand.
        ReconstructedBlind = "cube, T and e estimated",
        /// The scattered light alone, with only its own noise, as the paper has it: no camera measures it.
        ScatteredAsMeasured = "scattered, as if measured",
    }
    /// In a table.
    name
}

impl Signal {
    /// In file names and column heads.
    #[must_use]
    pub const fn key(self) -> &'static str {
        match self {
            Self::ThermalImage => "thermal_image",
            Self::HeatCube => "heat_cube",
            Self::Reconstructed => "temperature_estimated",
            Self::ReconstructedBlind => "temperature_and_emissivity_estimated",
            Self::ScatteredAsMeasured => "scattered_as_measured",
        }
    }
}

/// The answer to 'how well can depth be measured'.
#[derive(Debug, Serialize)]
pub struct Ranging {
    /// The scenario with its defaults filled in.
    pub scenario: RangeScenario,
    /// Yes or no, in a sentence and in numbers.
    pub verdict: DepthVerdict,
    /// What the file of the left view was read as, where there is one.
    pub read: Option<Found>,
    /// Rows, columns and bands of a view.
    pub shape: Shape,
    /// Positions of the cameras, and the depth that a pixel of disparity means.
    pub geometry: Geometry,
    /// Bounds, object by object; the first is all of them together.
    pub objects: Vec<ObjectBounds>,
    /// The four cells of Table S4 of the total signal, medians over all windows.
    pub cells: Option<CellMedians>,
    /// What would have to change for the demand to be just met, for the heat cube.
    pub solve_for: Option<DepthSolutions>,
    /// Witnesses along lines, where they were asked for.
    pub lines: Vec<Line>,
    /// Matching of whole views, where it was asked for.
    pub matched: Vec<Matched>,
    /// Relative error of medians and quantiles, at most, where there are too many windows to keep them all; none where exact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub quantile_error: Option<f64>,
    /// Pixels that were found to be bad in each view; their samples are missing. None where all are good.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub bad: Vec<BadInView>,
    /// Windows that hold a missing sample, and have no bound; none where there are none.
    #[serde(skip_serializing_if = "is_none")]
    pub missing_windows: usize,
    /// Row and column of the view, from 0, to which the first value of the maps belongs: the centre of the first window.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub maps_begin_at: Option<[usize; 2]>,
    /// What was computed and what was skipped.
    pub stats: Work,
    /// What the reader must know.
    pub warnings: Vec<Warning>,
    /// Bounds of every window, for pictures and tables.
    #[serde(skip)]
    pub maps: BoundMaps,
}

/// Bad pixels of a view.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct BadInView {
    /// The view that it is about: `left` or `right`.
    pub view: &'static str,
    /// How many pixels are bad, by why.
    pub pixels: Vec<BadPixels>,
    /// The code of every pixel, 0 for good ones, `[row][column]`.
    #[serde(skip)]
    pub map: Vec<u8>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde asks")]
const fn is_none(count: &usize) -> bool {
    *count == 0
}

/// Yes or no.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DepthVerdict {
    /// Whether enough windows reach the demanded error; `None` without depth.
    pub met: Option<bool>,
    /// The answer, in JSON a sentence.
    pub sentence: DepthFinding,
    /// Share of the windows that reach it by the heat cube: of a cube those without a bound (no depth, a missing sample, no partner in the
    /// right view) are counted, as not reaching it.
    pub share: Option<f64>,
    /// Share of the windows that must meet the requirement, 0 to 1.
    pub required_share: f64,
    /// Name of the signal by which the verdict is given.
    pub signal: Signal,
    /// Windows that were judged: those with a bound and a depth.
    pub windows: usize,
    /// All windows of the left view, but for those that show what is stated to be infinitely far; of a scene those that both cameras see.
    pub windows_of: usize,
    /// What a 'yes' rests on, hardest first; of a 'no' what was taken on the unfavourable side.
    pub conditions: Vec<Condition>,
    /// Codes of conditions that whoever asks accepts.
    pub accepted: Vec<String>,
}

/// What there is to be said of depth.
#[derive(Debug, Clone, PartialEq)]
pub enum DepthFinding {
    /// Windows were held against the demand.
    Judged {
        /// Whether enough of them reach it; `None` where windows that could not be judged decide.
        met: Option<bool>,
        /// Error demanded.
        error: Demand,
        /// Share of the windows that reach it.
        share: f64,
        /// Share demanded.
        required_share: f64,
        /// The signal that decides.
        signal: Signal,
        /// Another signal, and its share.
        beside: Option<(Signal, f64)>,
        /// Windows that were judged, and all that there are.
        windows: [usize; 2],
        /// Photons of the brightest reading and of the full well, where they do not fit: no window is met then.
        overfull: Option<[f64; 2]>,
        /// What a 'yes' rests on, hardest first.
        conditions: Vec<Condition>,
    },
    /// Depth is not known.
    NoDepth {
        /// Median of the least disparity error by the heat cube, pixels.
        disparity_error_px: f64,
    },
    /// No window has a bound.
    NoBound,
}

/// The pair of cameras.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Geometry {
    /// Distance of the cameras, m.
    pub baseline_m: f64,
    /// Focal length of both cameras, m.
    pub focal_length_m: f64,
    /// Distance of the pixels, m.
    pub pixel_m: f64,
    /// Disparity of a point 10 m away, pixels.
    pub disparity_at_10_m_px: f64,
    /// Depth error that a disparity error of 1 pixel makes 10 m away, m.
    pub depth_error_per_px_at_10_m: f64,
    /// Deviation σ_d that diffraction gives to the position of one photon, pixels; 0 where the image has it in it.
    pub sigma_diffraction_px: f64,
}

/// Bounds of the windows on one object.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ObjectBounds {
    /// Name of the object in the scene.
    pub name: String,
    /// Windows that both cameras see.
    pub windows: usize,
    /// Least, median and largest depth, m; `None` where depth is not known.
    pub depth_m: Option<[f64; 3]>,
    /// The bounds of each signal on this object.
    pub signals: Vec<SignalBounds>,
}

/// Bounds of an object's windows by one signal: medians over the windows.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SignalBounds {
    /// Name of the signal to which these bounds apply.
    pub signal: Signal,
    /// How many have a bound; not those in which a sample is 0 and has no noise, whose information has no value.
    pub windows: usize,
    /// Median number of photons of a window.
    pub photons: f64,
    /// γ: electronic noise over shot noise of a window.
    pub gamma: f64,
    /// Information J of one view about the window's position, pixel⁻².
    pub information_per_px2: f64,
    /// Deviation σ_c of one photon by correspondence, pixels; infinite without texture.
    pub sigma_correspondence_px: f64,
    /// Least error of the disparity of a window, pixels.
    pub disparity_error_px: f64,
    /// Least depth error: the tenth, the half and nine tenths of the windows stay below, m.
    pub depth_error_m: Option<[f64; 3]>,
    /// Median of the least depth error over the depth.
    pub relative_depth_error: Option<f64>,
    /// Share of the windows that reach the demanded error.
    pub share: Option<f64>,
    /// Largest depth at which the demanded share of the windows would still reach it, their image as it is, m.
    pub largest_depth_m: Option<f64>,
}

/// Medians of J over all windows, pixel⁻².
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CellMedians {
    /// Neither spatial nor spectral resolution.
    pub total: f64,
    /// Information with spatial but without spectral resolution.
    pub spatial: f64,
    /// Information with spectral but without spatial resolution.
    pub spectral: f64,
    /// Information with both spatial and spectral resolution.
    pub full: f64,
    /// The last by another derivative (cubic spline, or central if that is the one asked for), over that asked for.
    pub other_derivative: Option<f64>,
}

/// Each quantity with the others held.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DepthSolutions {
    /// The signal they are for.
    pub signal: Signal,
    /// Depth of the window that decides, m.
    pub depth_m: f64,
    /// Row and column of the window that decides.
    pub pixel: [usize; 2],
    /// Largest depth at which this window would do, if texture and window stay on the object, m.
    pub farthest_on_object_m: Option<f64>,
    /// δz that is allowed there, m.
    pub allowed_m: f64,
    /// Distance of the cameras, m.
    pub baseline_m: DepthSolution,
    /// Exposure of a frame, s.
    pub exposure_s: Option<DepthSolution>,
    /// Diameter of the lens, m.
    pub aperture_m: Option<DepthSolution>,
    /// Electronic noise per reading, counts.
    pub noise_counts: Option<DepthSolution>,
}

/// Bounds and witnesses along a row of the left view.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Line {
    /// Row of the left view, counted from 0.
    pub row: usize,
    /// Name of the signal that is matched.
    pub signal: Signal,
    /// Method of matching; `None` for the bound alone.
    pub method: Option<&'static str>,
    /// Columns of the windows' centres.
    pub columns: Vec<usize>,
    /// True depth of the window, m.
    pub depth_m: Vec<f64>,
    /// Least depth error, m; of the disparity in pixels where depth is not known, as all that follows.
    pub bound_m: Vec<f64>,
    /// The same of a lens without diffraction, as the views are that are matched.
    pub bound_without_diffraction_m: Vec<f64>,
    /// Root-mean-square depth error of the matches, m.
    pub rmse_m: Vec<f64>,
    /// Mean error of the estimated depth, m.
    pub bias_m: Vec<f64>,
    /// Share of matches that fail or miss by more than a pixel.
    pub outliers: Vec<f64>,
    /// Median over the columns of the scatter of the matches, √(RMSE² − bias²), over the bound without diffraction.
    pub scatter_over_bound: Option<f64>,
    /// Number of noisy pairs of views that were matched.
    pub trials: usize,
}

/// A whole view matched once, with noise.
#[derive(Debug, Clone, Serialize)]
pub struct Matched {
    /// Name of the signal that is matched.
    pub signal: Signal,
    /// How far the depths are from the truth.
    pub metrics: DepthMetrics,
    /// Depth, m, `[row][column]` of the left view; NaN where there is no match.
    #[serde(skip)]
    pub depth_m: Vec<f64>,
}

/// Maps over the windows' centres in the left view.
#[derive(Debug, Clone)]
pub struct BoundMaps {
    /// Rows of the centres.
    pub rows: Range<usize>,
    /// Columns of the centres.
    pub columns: Range<usize>,
    /// From a row and column that is here to the next: 1 for all of them. The others were given to the [`MapSink`](super::MapSink).
    pub step: usize,
    /// Least disparity error of each signal, pixels; NaN where there is none.
    pub disparity_error_px: Vec<(Signal, Vec<f64>)>,
    /// Depth at the centres, m.
    pub depth_m: Vec<f64>,
    /// Photons of the brightest band of the brightest pixel in one frame, of a scene.
    pub brightest: Option<f64>,
    /// Pictures of the left view, `[row][column]`.
    pub pictures: Vec<(PictureKind, Vec<f64>)>,
}

impl Default for BoundMaps {
    fn default() -> Self {
        Self {
            rows: 0..0,
            columns: 0..0,
            step: 1,
            disparity_error_px: Vec::new(),
            depth_m: Vec::new(),
            brightest: None,
            pictures: Vec::new(),
        }
    }
}

/// What a picture of the left view shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PictureKind {
    /// Photons of all bands.
    ThermalImage,
    /// Photons that were scattered, all bands.
    Scattered,
    /// Share of the ground and the objects in the lighting, the rest being sky.
    Lighting,
    /// Temperature, K.
    Temperature,
    /// Depth, m.
    Depth,
}
