//! What sizing practice says of a camera: rules of thumb and models of an observer. None of it is a bound.
//!
//! A target of critical dimension h (m) at distance R (m) covers n pixels of side p (m) behind a focal length f (m), or
//! N cycles of a pattern that just fits them, a cycle being two pixels:
//!
//! n = h f/(R p),   N = n/2,   R = h f/(n p)
//!
//! | task | Johnson's cycles N50 | pixels of the industry |
//! |---|---|---|
//! | detect: something is there | 1.0 ± 0.25 | 1.5 |
//! | orient: which way it stands | 1.4 ± 0.35 | |
//! | recognise: which kind of thing | 4.0 ± 0.8 | 6 |
//! | identify: which one of its kind | 6.4 ± 1.5 | 12 |
//!
//! Johnson's are for one half of all observers to be right. [`observer`] has the share at other numbers of cycles,
//! [`resolution`] the temperature difference that an observer needs.
//!
//! Assumptions: small angles; no air, contrast, noise, blur, motion: ranges are geometry alone, and the same whatever the target's
//! temperature and material are. The critical dimension is the smaller of width and height, or the root of their product: both
//! are in use.
//!
//! Sources, and how sure they are. Cycles: J. Johnson, 'Analysis of Image Forming Systems', Image Intensifier Symposium
//! (1958), not seen; excerpts of two copies of an encyclopaedia agree. Pixels: FLIR technical note TN-0002, excerpt of a copy,
//! which cites IDA document D-4642, not seen; others ask 2 pixels for detection (a maker's page, excerpt). That the maker's ranges
//! are geometry alone: computed, its five (9 mm: 205, 52, 26 m; 13 mm: 300, 74 m) share h/p = 3.44e4 within 1 %.

pub mod observer;
pub mod resolution;

use crate::error::{Result, check};
use crate::instrument::Camera;

/// Pixels of a cycle.
pub const PIXELS_PER_CYCLE: f64 = 2.0;

crate::base::named::named! {
    /// What an observer is to do with a target.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum ObserverTask {
        /// See that something is there.
        Detect = "detect",
        /// See which way it stands.
        Orient = "orient",
        /// See which kind of thing it is.
        Recognise = "recognise",
        /// See which one of its kind it is.
        Identify = "identify",
    }
    /// Name, e.g. `detect`.
    name
}

impl ObserverTask {
    /// Johnson's N50: cycles across the critical dimension with which one half of all observers are right.
    #[must_use]
    pub const fn johnson_cycles(self) -> f64 {
        match self {
            Self::Detect => 1.0,
            Self::Orient => 1.4,
            Self::Recognise => 4.0,
            Self::Identify => 6.4,
        }
    }

    /// How far N50 varied between the targets of Johnson's experiments, ± cycles.
    #[must_use]
    pub const fn johnson_spread_cycles(self) -> f64 {
        match self {
            Self::Detect => 0.25,
            Self::Orient => 0.35,
            Self::Recognise => 0.8,
            Self::Identify => 1.5,
        }
    }

    /// Pixels across the critical dimension that makers of cameras ask; they have no number for the orientation.
    #[must_use]
    pub const fn industry_pixels(self) -> Option<f64> {
        match self {
            Self::Detect => Some(1.5),
            Self::Orient => None,
            Self::Recognise => Some(6.0),
            Self::Identify => Some(12.0),
        }
    }
}

impl serde::Serialize for ObserverTask {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// A target before a camera: how many pixels it covers from how far.
///
/// ```
/// use hadar::policy::practice::{ObserverTask, Subtense};
/// // Half a metre before 12 um behind 14 mm, by the pixels of the industry and by Johnson's cycles.
/// let person = Subtense::new(0.5, 14e-3, 12e-6)?;
/// assert!((person.range_m(6.0) - 97.2).abs() < 0.1);
/// assert!((person.range_of_cycles_m(ObserverTask::Recognise.johnson_cycles()) - 72.9).abs() < 0.1);
/// assert!((person.pixels(40.0) - 14.6).abs() < 0.1);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Subtense {
    /// Distance at which the target covers one pixel, h f/p.
    one_pixel_m: f64,
}

impl Subtense {
    /// Of a critical dimension, a focal length and the side of a pixel, all in m.
    ///
    /// # Errors
    /// A length that is not positive and finite, or lengths that leave floating point together.
    pub fn new(size_m: f64, focal_length_m: f64, pixel_m: f64) -> Result<Self> {
        let size_m = check::positive("size of the target", size_m, "m")?;
        let focal_length_m = check::positive("focal length", focal_length_m, "m")?;
        let pixel_m = check::positive("pixel", pixel_m, "m")?;
        let one_pixel_m = size_m * (focal_length_m / pixel_m);
        Ok(Self { one_pixel_m: check::positive("distance of a pixel", one_pixel_m, "m")? })
    }

    /// Of a critical dimension in m before a camera.
    ///
    /// # Errors
    /// As [`Subtense::new`].
    pub fn of(camera: &Camera, size_m: f64) -> Result<Self> {
        Self::new(size_m, camera.focal_length_m, camera.pixel_m)
    }

    /// Pixels across the target from a distance in m, above 0.
    #[must_use]
    pub fn pixels(self, distance_m: f64) -> f64 {
        self.one_pixel_m / distance_m
    }

    /// Cycles across the target from a distance in m, above 0.
    #[must_use]
    pub fn cycles(self, distance_m: f64) -> f64 {
        self.pixels(distance_m) / PIXELS_PER_CYCLE
    }

    /// Distance in m up to which the target covers so many pixels, above 0.
    #[must_use]
    pub fn range_m(self, pixels: f64) -> f64 {
        self.one_pixel_m / pixels
    }

    /// Distance in m up to which the target covers so many cycles, above 0.
    #[must_use]
    pub fn range_of_cycles_m(self, cycles: f64) -> f64 {
        self.range_m(PIXELS_PER_CYCLE * cycles)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// TN-0002: ranges are rounded to a metre, h and p are not told; one quotient of them gives all five.
    #[test]
    fn the_makers_five_ranges_are_geometry() {
        let printed = [
            (9e-3, ObserverTask::Detect, 205.0),
            (9e-3, ObserverTask::Recognise, 52.0),
            (9e-3, ObserverTask::Identify, 26.0),
            (13e-3, ObserverTask::Detect, 300.0),
            (13e-3, ObserverTask::Recognise, 74.0),
        ];
        let pixel_m = 12e-6;
        for (focal_length_m, task, metres) in printed {
            let target = Subtense::new(3.44e4 * pixel_m, focal_length_m, pixel_m).unwrap();
            let range = target.range_m(task.industry_pixels().unwrap());
            assert!((range / metres - 1.0).abs() < 0.01, "{focal_length_m} {task:?}: {range}");
        }
    }

    /// By hand: 0.5 m × 14 mm/12 µm = 583.333 m is one pixel.
    #[test]
    fn pixels_and_ranges_of_half_a_metre() {
        let target = Subtense::new(0.5, 14e-3, 12e-6).unwrap();
        let near = |found: f64, exact: f64| assert!((found / exact - 1.0).abs() < 1e-5, "{found} {exact}");
        // FMVSS 127's start from 60 km/h against 0.5 m, and the industry's ranges.
        near(target.pixels(66.6667), 8.75);
        near(target.cycles(66.6667), 4.375);
        for (task, johnson, industry) in [
            (ObserverTask::Detect, 291.6667, Some(388.8889)),
            (ObserverTask::Orient, 208.3333, None),
            (ObserverTask::Recognise, 72.91667, Some(97.22222)),
            (ObserverTask::Identify, 45.57292, Some(48.61111)),
        ] {
            near(target.range_of_cycles_m(task.johnson_cycles()), johnson);
            assert_eq!(task.industry_pixels().is_some(), industry.is_some());
            if let (Some(pixels), Some(metres)) = (task.industry_pixels(), industry) {
                near(target.range_m(pixels), metres);
            }
        }
    }

    #[test]
    fn lengths_that_are_none_are_named() {
        for (lengths, named) in [
            ([0.0, 1.0, 1.0], "size of the target"),
            ([1.0, f64::NAN, 1.0], "focal length"),
            ([1.0, 1.0, -1.0], "pixel"),
            ([1e300, 1e300, 1e-300], "distance of a pixel"),
        ] {
            let error = Subtense::new(lengths[0], lengths[1], lengths[2]).unwrap_err().to_string();
            assert!(error.starts_with(named), "{error}");
        }
    }
}
