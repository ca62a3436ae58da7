//! What a pixel sees: from how far, how much of it the target fills, and which other light falls on it.
//!
//! A pixel of side a behind a lens of focal length f has the footprint a z/f at distance z (m). A target whose side s is
//! smaller fills the share φ = (s f/(a z))²; what is behind it sends the rest. Light that does not
//! depend on the target (from behind it, from the air between, from filters and sensor) tells nothing of it and adds
//! its shot noise.
//!
//! Assumptions: square target in the middle of the pixel; a sharp edge; what is behind the target is known.
//!
//! Source: paper S7–S9.

use crate::error::{Error, Result};

/// No array is wider.
const MOST_PIXELS_ACROSS: f64 = 1e5;

/// Pixels that an object covers, whose counts are added up: rows by columns, at least one of each.
///
/// ```
/// use hadar::instrument::Extent;
/// assert_eq!(Extent::new([30.0, 10.0])?.pixels(), 300.0);
/// assert_eq!(Extent::square(400.0)?.sides(), [20.0, 20.0]);
/// assert!(Extent::new([30.0, 0.0]).is_err());
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Extent {
    rows: f64,
    columns: f64,
}

impl Default for Extent {
    fn default() -> Self {
        Self::ONE
    }
}

impl Extent {
    /// One pixel.
    pub const ONE: Self = Self { rows: 1.0, columns: 1.0 };

    /// So many rows and columns.
    ///
    /// # Errors
    /// Fewer than one of them, or more than an array has.
    pub fn new(sides: [f64; 2]) -> Result<Self> {
        if let Some(side) = sides.into_iter().find(|side| !(1.0..=MOST_PIXELS_ACROSS).contains(side)) {
            return Err(Error::out_of_range(
                "rows or columns of an object",
                side,
                "pixels",
                "from 1 to 100000",
            ));
        }
        let [rows, columns] = sides;
        Ok(Self { rows, columns })
    }

    /// So many pixels, as many rows as columns.
    ///
    /// # Errors
    /// As [`Extent::new`].
    pub fn square(pixels: f64) -> Result<Self> {
        Self::new([pixels.sqrt(); 2])
    }

    /// Those that a square of side `size_m` surely fills wherever it lies on the array, one at least: its image has s = size/footprint
    /// pixels across, a blur of radius `blur_pixels` takes as much at either edge, and an edge within a pixel takes that one: s − 2b − 2,
    /// which changes without steps and is at most one less than the whole pixels that there are.
    ///
    /// ```
    /// use hadar::instrument::Extent;
    /// // 0.5 m of 25 mm each are 20 pixels; a blur of 1.5 at either edge leaves 17, of which 15 are whole wherever it lies.
    /// assert!((Extent::inside(0.5, 0.025, 1.5).pixels() - 225.0).abs() < 1e-9);
    /// assert_eq!(Extent::inside(0.5, 0.4, 1.4), Extent::ONE);
    /// ```
    #[must_use]
    pub fn inside(size_m: f64, footprint_m: f64, blur_pixels: f64) -> Self {
        let side = (size_m / footprint_m - 2.0 * blur_pixels - 2.0).clamp(1.0, MOST_PIXELS_ACROSS);
        if side.is_nan() { Self::ONE } else { Self { rows: side, columns: side } }
    }

    /// What of them is on an array of so many rows and columns.
    #[must_use]
    pub fn within(self, [rows, columns]: [f64; 2]) -> Self {
        Self { rows: self.rows.min(rows.max(1.0)), columns: self.columns.min(columns.max(1.0)) }
    }

    /// Rows and columns.
    #[must_use]
    pub const fn sides(self) -> [f64; 2] {
        [self.rows, self.columns]
    }

    /// Their number.
    #[must_use]
    pub fn pixels(self) -> f64 {
        self.rows * self.columns
    }
}

/// Light of one origin that tells nothing of the target.
#[derive(Debug, Clone, PartialEq)]
pub struct Light {
    /// Its line in the noise budget.
    pub label: &'static str,
    /// Its signal in each band, weighed as that of the target is, photons s⁻¹ m⁻² sr⁻¹.
    pub radiance: Vec<f64>,
}

/// What a pixel sees, or each pixel of an object.
///
/// ```
/// use hadar::instrument::View;
/// assert_eq!(View::at(Some(30.0)).fill, 1.0);
/// assert_eq!(View::default().distance_m, None);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// Distance of the target, m; infinitely far where `None`.
    pub distance_m: Option<f64>,
    /// Share of the pixel's footprint that the target fills, in (0, 1].
    pub fill: f64,
    /// Pixels of the object that see the same and whose counts are added up.
    pub extent: Extent,
    /// Other light on the pixel.
    pub light: Vec<Light>,
    /// Signal of the target in each band where it fills the pixel, photons s⁻¹ m⁻² sr⁻¹: what the noise of an
    /// interferometer and of bunched photons is made of. Empty where neither is asked for.
    pub signal: Vec<f64>,
    /// Width of each band behind the optics but without what the path takes away, cm⁻¹: what a noise stated as radiance is
    /// spread over. Empty where nothing is on the path.
    pub open_widths_cm1: Vec<f64>,
    /// Photons that are counted per mode, mean over each band; empty where bunching is not asked for.
    pub occupancy: Vec<f64>,
}

impl Default for View {
    fn default() -> Self {
        Self::at(None)
    }
}

impl View {
    /// A target that fills the pixel, and nothing between.
    #[must_use]
    pub const fn at(distance_m: Option<f64>) -> Self {
        Self {
            distance_m,
            fill: 1.0,
            extent: Extent::ONE,
            light: Vec::new(),
            signal: Vec::new(),
            open_widths_cm1: Vec::new(),
            occupancy: Vec::new(),
        }
    }

    /// Other light in band w, photons s⁻¹ m⁻² sr⁻¹.
    #[must_use]
    pub fn other_light(&self, band: usize) -> f64 {
        self.light.iter().map(|light| light.radiance.get(band).copied().unwrap_or(0.0)).sum()
    }
}

/// Share of a pixel of side `pixel_m` behind a lens of focal length `focal_length_m` that a target of side `size_m` fills
/// at `distance_m`; 1 where it is larger. All in m.
///
/// ```
/// // 12 um behind 18 mm see 20 mm at 30 m: 5 mm fill a sixteenth of it.
/// let share = hadar::instrument::view::fill(5e-3, 12e-6, 18e-3, 30.0);
/// assert!((share - 1.0 / 16.0).abs() < 1e-12);
/// ```
#[must_use]
pub fn fill(size_m: f64, pixel_m: f64, focal_length_m: f64, distance_m: f64) -> f64 {
    let side = size_m / (pixel_m * distance_m / focal_length_m);
    (side * side).min(1.0)
}
