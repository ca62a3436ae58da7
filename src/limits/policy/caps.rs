//! Limits that shot noise does not know: what a solution must keep within beside the statistical distance.
//!
//! | code | limit | |
//! |---|---|---|
//! | `diffraction` | pixel ≥ λF, F ≤ pixel/λ | λ the longest wavelength of the bands |
//! | `full-well` | counts of the fullest reading ≤ full well | on exposure, pixel, f-number |
//! | `motion` | time until all bands are exposed ≤ r θ/(v_⊥ L) | [`super::motion`]; on exposure, pixel, distance, and speed, where one is demanded |
//! | `frame-rate` | exposure ≤ 1/frame rate | |
//! | `decision-time` | time until all frames are read ≤ that which is demanded | on exposure and frames |
//! | `impractical` | exposure ≤ 1 s, pixel ≤ 100 µm, time of all frames ≤ 60 s | or what the camera itself has |
//! | `lowest-noise` | σ ≥ √(ρ² + q²/12) | read noise ρ and steps q of the converter stay whatever the detector |
//!
//! λF is the diffraction blur at which an image goes from detector-limited to optics-limited (Fλ/pixel = 1; the first dark
//! ring of a point has the radius 1.22 λF): below it a smaller pixel shows no more detail and sees what is beside it.
//!
//! `impractical` is a convention, not physics: pitches of thermal arrays are 5 to 50 µm, their frames milliseconds, and what
//! is looked at seldom holds still for a minute.
//!
//! Source: G. C. Holst, Opt. Eng. 46, 103204 (2007), doi:10.1117/1.2790066; paper SII E (motion).

use super::motion::Motion;
use super::solve::{CameraTask, Cap, CapCode, Quantity, Trial};
use crate::error::Result;
use crate::instrument::Camera;
use crate::root::crossing_between;
use crate::spectrum::Bands;
use crate::words::{quantity as in_unit, significant};

/// Logarithm of the largest factor by which a pixel or f-number is changed to fill the well.
const LOG_RANGE: f64 = 30.0;
/// The longest exposure (s), largest pixel (m) and longest time for all frames (s) in practice.
const LONGEST_EXPOSURE_S: f64 = 1.0;
const LARGEST_PIXEL_M: f64 = 100e-6;
const LONGEST_ACQUISITION_S: f64 = 60.0;
/// Share by which a limit may be passed: rounding.
const ROUNDING: f64 = 1e-9;

/// A limit on one quantity, the rest of the camera as it is.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Limit {
    /// Which.
    pub code: CapCode,
    /// The quantity.
    pub quantity: Quantity,
    /// Its limit.
    pub value: f64,
    /// Whether the quantity must be at least so large, not at most.
    pub is_least: bool,
    /// The reason in words.
    pub reason: String,
}

impl Limit {
    /// The cap of a solution, if its value breaks the limit.
    #[must_use]
    pub fn broken_by(&self, value: f64) -> Option<Cap> {
        let broken = if self.is_least {
            value < self.value * (1.0 - ROUNDING)
        } else {
            value > self.value * (1.0 + ROUNDING)
        };
        broken.then(|| Cap {
            code: self.code,
            limit: self.value,
            blocks: self.is_least != self.quantity.is_least(),
            reason: self.reason.clone(),
        })
    }
}

/// What limits are judged by, beside the camera.
pub struct Circumstances<'a> {
    /// Bands, as the camera receives them.
    pub bands: &'a Bands,
    /// Speed that is demanded, m s⁻¹.
    pub speed_m_s: Option<f64>,
    /// Time after which a decision must stand, s.
    pub time_s: Option<f64>,
    /// Counts of the fullest reading.
    pub brightest: &'a dyn Fn(&Trial) -> Result<f64>,
}

/// Longest wavelength of bands, at the edge of the outermost, m.
#[must_use]
pub fn longest_wavelength_m(bands: &Bands) -> f64 {
    let edge = bands.bands().iter().map(|band| band.low_cm1).fold(f64::INFINITY, f64::min);
    0.01 / if edge > 0.0 { edge } else { bands.range_cm1().0 }
}

/// What limits `quantity` where all else is as in `trial`.
///
/// # Errors
/// Those of `brightest`.
pub fn limits(quantity: Quantity, trial: &Trial, given: &Circumstances<'_>) -> Result<Vec<Limit>> {
    let camera = &trial.camera;
    let mut limits = Vec::new();
    let mut push = |code, value: f64, is_least, reason: String| {
        limits.push(Limit { code, quantity, value, is_least, reason });
    };
    let wavelength_m = longest_wavelength_m(given.bands);
    let blur = format!("diffraction at {}", in_unit(wavelength_m, "m"));
    match quantity {
        Quantity::Exposure => {
            if let (Some(speed), Some(motion)) = (given.speed_m_s, Motion::of(camera, trial.distance_m)) {
                let exposures = camera.readout.exposures(given.bands.len());
                let longest = camera.exposure_of_sweep_s(given.bands.len(), motion.longest_s(speed));
                let all =
                    if exposures > 1 { format!(" for all {exposures} exposures") } else { String::new() };
                let speed = significant(speed, 3);
                let reason = if longest > 0.0 {
                    format!("in a longer one the target moves a pixel at {speed} m/s{all}")
                } else {
                    format!(
                        "the target moves a pixel at {speed} m/s while {exposures} frames pass, however short the exposures"
                    )
                };
                push(CapCode::Motion, longest.max(0.0), false, reason);
            }
            if let Some(frame) = camera.frame_s() {
                push(CapCode::FrameRate, frame, false, "a frame is no longer".into());
            }
            if let Some(time_s) = given.time_s {
                let longest = camera.exposure_of_acquisition_s(given.bands.len(), time_s);
                let reason = format!("all must be read within {}", in_unit(time_s, "s"));
                push(CapCode::DecisionTime, longest.max(0.0), false, reason);
            }
            let longest = LONGEST_EXPOSURE_S.max(camera.exposure_s);
            push(CapCode::Impractical, longest, false, "no thermal array is exposed for longer".into());
        }
        Quantity::Pixel => {
            let reason = format!("{blur} blurs over lambda F");
            push(CapCode::Diffraction, wavelength_m * camera.f_number, true, reason);
            if let Some(least) = still_pixel_m(trial, given)? {
                push(CapCode::Motion, least, true, "in a smaller one the target moves by a pixel".into());
            }
            let largest = LARGEST_PIXEL_M.max(camera.pixel_m);
            push(CapCode::Impractical, largest, false, "no thermal array has larger ones".into());
        }
        Quantity::FNumber => {
            let reason = format!("{blur} blurs over more than the pixel");
            push(CapCode::Diffraction, camera.pixel_m / wavelength_m, false, reason);
        }
        Quantity::Noise => {
            let step = camera.quantisation_step_counts().unwrap_or(0.0);
            let floor = camera.read_noise_counts.hypot(step / 12f64.sqrt());
            if floor > 0.0 {
                push(CapCode::LowestNoise, floor, true, "read noise and quantisation remain".into());
            }
        }
        Quantity::Speed => {
            if let Some(speed) = given.speed_m_s {
                push(CapCode::Motion, speed, true, "this speed is required".into());
            }
        }
        Quantity::Frames => {
            let bands = given.bands.len();
            let one_s = Camera { frames: 1, ..camera.clone() }.acquisition_s(bands);
            let most = (LONGEST_ACQUISITION_S / one_s).floor().max(f64::from(camera.frames));
            let reason = format!("more take longer than {}", in_unit(LONGEST_ACQUISITION_S, "s"));
            push(CapCode::Impractical, most, false, reason);
            if let Some(time_s) = given.time_s {
                let most = f64::from(camera.frames_within(time_s, bands));
                let reason = format!("more cannot be read within {}", in_unit(time_s, "s"));
                push(CapCode::DecisionTime, most, false, reason);
            }
        }
        Quantity::Distance => {
            // The blur falls with the distance.
            if let (Some(speed), Some(motion), Some(z)) =
                (given.speed_m_s, Motion::of(camera, trial.distance_m), trial.distance_m)
            {
                let least = z * motion.blur_pixels(speed, camera.sweep_s(given.bands.len()));
                push(CapCode::Motion, least, true, "closer, the target moves by a pixel".into());
            }
        }
    }
    if let Some(full) = camera.full_well
        && let Some((value, is_least)) = fills(quantity, trial, full, given)?
    {
        push(
            CapCode::FullWell,
            value,
            is_least,
            format!("the pixel saturates at {} counts", significant(full, 2)),
        );
    }
    Ok(limits)
}

/// The limits that a solution breaks: its own, and for a speed also those of the exposure that it takes.
///
/// # Errors
/// Those of `brightest`.
pub fn broken(
    quantity: Quantity,
    value: f64,
    task: &CameraTask<'_>,
    given: &Circumstances<'_>,
) -> Result<Vec<Cap>> {
    let own = limits(quantity, &task.own(), given)?;
    let mut broken: Vec<Cap> = own.iter().filter_map(|limit| limit.broken_by(value)).collect();
    if quantity == Quantity::Speed {
        let taken = task.forward(quantity, value);
        let of_exposure = limits(Quantity::Exposure, &taken, given)?;
        let others = of_exposure.iter().filter(|limit| limit.code != CapCode::Motion);
        let caps = others.filter_map(|limit| limit.broken_by(taken.camera.exposure_s));
        // The speed is as the inverse of the exposure.
        broken.extend(caps.map(|cap| Cap { limit: value * taken.camera.exposure_s / cap.limit, ..cap }));
    }
    Ok(broken)
}

/// The least pixel in which a target at the demanded speed does not move by a pixel; `None` where no speed is demanded or no pixel
/// is large enough.
fn still_pixel_m(trial: &Trial, given: &Circumstances<'_>) -> Result<Option<f64>> {
    let Some(speed) = given.speed_m_s else { return Ok(None) };
    let camera = &trial.camera;
    let time_s = camera.sweep_s(given.bands.len());
    // ln of the room for motion as the pixel grows.
    let room = |log: f64| -> Result<f64> {
        let changed = Camera { pixel_m: camera.pixel_m * log.exp(), ..camera.clone() };
        let blur =
            Motion::of(&changed, trial.distance_m).map_or(0.0, |motion| motion.blur_pixels(speed, time_s));
        Ok(-blur.max(1e-300).ln())
    };
    let (low, high) = ([-LOG_RANGE, room(-LOG_RANGE)?], [LOG_RANGE, room(LOG_RANGE)?]);
    if high[1] <= 0.0 || low[1] >= 0.0 {
        return Ok(None);
    }
    crossing_between(low, high, room).map(|log| Some(camera.pixel_m * log.exp()))
}

/// The value at which the fullest reading fills the well.
fn fills(
    quantity: Quantity,
    trial: &Trial,
    full: f64,
    given: &Circumstances<'_>,
) -> Result<Option<(f64, bool)>> {
    // ln of the fill as the quantity grows by a factor.
    let fill = |change: &dyn Fn(&mut Camera, f64), log: f64| -> Result<f64> {
        let mut changed = trial.clone();
        change(&mut changed.camera, log.exp());
        Ok(((given.brightest)(&changed)? / full).max(1e-300).ln())
    };
    let crossed = |change: &dyn Fn(&mut Camera, f64)| -> Result<Option<f64>> {
        let ends = [-LOG_RANGE, LOG_RANGE].map(|log| fill(change, log).map(|value| [log, value]));
        let [low, high] = ends;
        let (low, high) = (low?, high?);
        if low[1] >= 0.0 || high[1] <= 0.0 {
            return Ok(None);
        }
        crossing_between(low, high, |log| fill(change, log)).map(|log| Some(log.exp()))
    };
    let camera = &trial.camera;
    Ok(match quantity {
        // Light and dark counts both grow with it.
        Quantity::Exposure => {
            let counts = (given.brightest)(trial)?;
            (counts > 0.0).then(|| (camera.exposure_s * full / counts, false))
        }
        Quantity::Pixel => crossed(&|camera, factor| camera.pixel_m *= factor)?
            .map(|factor| (camera.pixel_m * factor, false)),
        Quantity::FNumber => crossed(&|camera, factor| camera.f_number /= factor)?
            .map(|factor| (camera.f_number / factor, true)),
        Quantity::Noise | Quantity::Frames | Quantity::Distance | Quantity::Speed => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::instrument::{View, presets};

    fn trial() -> Trial {
        let mut camera = presets::get("flir-a325sc").unwrap();
        (camera.full_well, camera.frame_rate_hz) = (Some(1e7), Some(60.0));
        // The paper's lens contradicts its view; here it is one of 320 pixels across 50 degrees.
        camera.focal_length_m = camera.pixel_m * 320.0 / 50f64.to_radians();
        Trial { camera, distance_m: Some(30.0) }
    }

    fn of(quantity: Quantity, trial: &Trial) -> Vec<Limit> {
        let bands = Bands::from_rows([(800.0, 1.0), (1000.0, 1.0)]).unwrap();
        let brightest =
            |trial: &Trial| Ok(trial.camera.brightest_reading(&[1e19, 3e19], &View::at(trial.distance_m)));
        let given =
            Circumstances { bands: &bands, speed_m_s: Some(13.4112), time_s: None, brightest: &brightest };
        limits(quantity, trial, &given).unwrap()
    }

    fn value(limits: &[Limit], code: CapCode) -> f64 {
        limits.iter().find(|limit| limit.code == code).unwrap_or_else(|| panic!("{limits:?}")).value
    }

    #[test]
    fn limits_are_those_of_the_formulas() {
        let trial = trial();
        let camera = &trial.camera;
        // The band at 800 cm^-1 reaches down to 799.5 cm^-1, 12.508 um.
        let longest_m = 1e-2 / 799.5;
        assert!(
            (value(&of(Quantity::Pixel, &trial), CapCode::Diffraction) / (longest_m * 1.3) - 1.0).abs()
                < 1e-12
        );
        assert!(
            (value(&of(Quantity::FNumber, &trial), CapCode::Diffraction) / (12e-6 / longest_m) - 1.0).abs()
                < 1e-12
        );
        let exposure = of(Quantity::Exposure, &trial);
        assert!((value(&exposure, CapCode::FrameRate) - 1.0 / 60.0).abs() < 1e-15);
        let (pixels, view) = (f64::from(camera.pixels.unwrap()), camera.field_of_view_rad.unwrap());
        let longest = 30.0 * view / (13.4112 * (0.5 * view).sin() * pixels);
        assert!((value(&exposure, CapCode::Motion) / longest - 1.0).abs() < 1e-12);
        // Far from the lens counts grow as t a²/F²; 12 mm behind 30 m change the last digits.
        let counts = camera.brightest_reading(&[1e19, 3e19], &View::at(None));
        let ratio = 1e7 / counts;
        assert!((value(&exposure, CapCode::FullWell) / (camera.exposure_s * ratio) - 1.0).abs() < 1e-6);
        let pixel = value(&of(Quantity::Pixel, &trial), CapCode::FullWell);
        assert!((pixel / (camera.pixel_m * ratio.sqrt()) - 1.0).abs() < 1e-6);
        let f_number = value(&of(Quantity::FNumber, &trial), CapCode::FullWell);
        assert!((f_number / (camera.f_number / ratio.sqrt()) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn a_wheel_of_filters_shares_the_time_between_the_bands() {
        let mut trial = trial();
        trial.camera.frame_rate_hz = None;
        let at_once = value(&of(Quantity::Exposure, &trial), CapCode::Motion);
        trial.camera.readout = crate::instrument::Readout::Sequential;
        let one_by_one = value(&of(Quantity::Exposure, &trial), CapCode::Motion);
        assert!((at_once / one_by_one - 2.0).abs() < 1e-12);
        // The second waits for its frame: what is left of the time is that of the last exposure.
        trial.camera.frame_rate_hz = Some(100.0);
        let waiting = value(&of(Quantity::Exposure, &trial), CapCode::Motion);
        assert!((waiting / (at_once - 10e-3) - 1.0).abs() < 1e-12);
        trial.camera.frame_rate_hz = Some(60.0);
        assert_eq!(value(&of(Quantity::Exposure, &trial), CapCode::Motion), 0.0);
    }

    #[test]
    fn a_cap_says_whether_it_can_be_kept() {
        let trial = trial();
        let exposure = of(Quantity::Exposure, &trial);
        let longest = value(&exposure, CapCode::Motion);
        let caps: Vec<Cap> = exposure.iter().filter_map(|limit| limit.broken_by(2.0 * longest)).collect();
        assert!(caps.iter().any(|cap| cap.code == CapCode::Motion && cap.blocks), "{caps:?}");
        assert!(exposure.iter().all(|limit| limit.broken_by(0.1 * longest).is_none()));
        // A pixel smaller than the blur can be made larger; an f-number larger than it asks for, smaller.
        let pixel = of(Quantity::Pixel, &trial)[0].broken_by(1e-6).unwrap();
        let f_number = of(Quantity::FNumber, &trial)[0].broken_by(2.0).unwrap();
        assert_eq!((pixel.blocks, f_number.blocks), (false, false));
        // A slower lens keeps the well from filling, but the task asks for a faster one.
        let full =
            of(Quantity::FNumber, &trial).into_iter().find(|limit| limit.code == CapCode::FullWell).unwrap();
        assert!(full.broken_by(0.5 * full.value).unwrap().blocks);
    }
}
