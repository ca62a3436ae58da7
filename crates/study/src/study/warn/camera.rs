//! Warnings on the camera in its scene: where an assumption of the bound fails.

use super::super::identify::PairResult;
use super::super::size::CameraResult;
use super::super::{Study, Warning};
use hadar::instrument::Camera;
use hadar::policy::caps::longest_wavelength_m;
use hadar::words::{quantity, significant};

/// Relative difference between shortcut and exact statistical distance worth a word.
const SHORTCUT: f64 = 0.1;
/// Share of a band that may be outside: a band that is centred at the end of the range, and rounding.
const HALF: f64 = 0.5 + 1e-9;
/// Radius of the first dark ring of a point's image, in units of λF.
const AIRY: f64 = 1.22;

impl Study {
    /// Warnings on the camera in the scene, against the limiting alternative.
    pub(in crate::study) fn camera_result_warnings(
        &self,
        result: &CameraResult,
        pair: &PairResult,
    ) -> Vec<Warning> {
        let camera = &result.camera;
        let found = [
            shortcut(pair),
            self.motion(result),
            full_well(result),
            self.small_target(camera),
            self.diffraction(camera),
            self.frame_rate(camera),
            self.outside_range(camera),
            self.filter_light(camera),
            assumed(camera),
        ];
        found.into_iter().flatten().collect()
    }

    fn motion(&self, result: &CameraResult) -> Option<Warning> {
        self.scenario.requirement.speed_m_s?;
        let Some(blur) = result.motion_blur_pixels else {
            let message = "a speed is given, but for the motion blur the scenario must say target.distance";
            return Some(Warning::new("motion-blur-unknown", message));
        };
        (blur >= 1.0).then(|| {
            let blur = significant(blur, 2);
            let message = format!(
                "the target moves {blur} pixels until all bands are exposed; the bound assumes less than 1"
            );
            Warning::new("motion-blur", message)
        })
    }

    /// Filters without the light they throw back, or a sensor's temperature without filters.
    fn filter_light(&self, camera: &Camera) -> Option<Warning> {
        let filters = self.open_bands.bands().iter().any(|band| band.name.is_some());
        let message = match (filters, camera.sensor_temperature_k) {
            (true, None) => {
                "the light that filters throw back onto the sensor, and their own, is left out: sensor_temperature is not given"
            }
            (false, Some(_)) => {
                "sensor_temperature changes nothing: there are no filters that throw its light back"
            }
            _ => return None,
        };
        Some(Warning::new("filter-light", message))
    }

    fn small_target(&self, camera: &Camera) -> Option<Warning> {
        let fill = self.view_of(camera).fill;
        (fill < 1.0).then(|| {
            let message = format!(
                "the target fills {} % of its pixel, as long as it stands in the middle of one; on the edge of two or \
                 four of them it is seen by each in part",
                significant(100.0 * fill, 2)
            );
            Warning::new("target-smaller-than-pixel", message)
        })
    }

    fn diffraction(&self, camera: &Camera) -> Option<Warning> {
        let wavelength_m = longest_wavelength_m(&self.bands);
        let blur_m = wavelength_m * camera.f_number;
        (camera.pixel_m < blur_m).then(|| {
            let message = format!(
                "at {} the lens blurs a point over lambda F = {} (first dark ring at {}), more than the pixel of {}: \
                 neighbours see the same, and an edge of the target is spread over pixels",
                quantity(wavelength_m, "m"),
                quantity(blur_m, "m"),
                quantity(AIRY * blur_m, "m"),
                quantity(camera.pixel_m, "m"),
            );
            Warning::new("diffraction", message)
        })
    }

    /// Several exposures come at the frame rate, however short each is.
    fn frame_rate(&self, camera: &Camera) -> Option<Warning> {
        let frame_s = camera.frame_s()?;
        let exposures = camera.readout.exposures(self.bands.len()) as f64 * f64::from(camera.frames);
        // Shorter by less than this is no other time.
        let waits = camera.exposure_s < 0.9 * frame_s;
        (exposures > 1.0 && waits).then(|| {
            let message = format!(
                "{exposures:.0} exposures take {} at {} frames per second, not {}; nothing may change meanwhile",
                quantity(camera.acquisition_s(self.bands.len()), "s"),
                significant(frame_s.recip(), 3),
                quantity(exposures * camera.exposure_s, "s"),
            );
            Warning::new("frame-rate", message)
        })
    }

    /// Bands of which more than half is out of the range of the detector; one that is wholly so was refused.
    fn outside_range(&self, camera: &Camera) -> Option<Warning> {
        let [low, high] = camera.spectral_range_cm1;
        let beyond = |from: f64, to: f64| (low - from).max(to - high) > HALF * (to - from);
        let count = self.bands.bands().iter().filter(|band| beyond(band.low_cm1, band.high_cm1)).count();
        (count > 0).then(|| {
            let of = self.bands.len();
            let message = format!(
                "{count} of {of} bands are for the most part outside {low} to {high} cm^-1, the range in which the figures of the detector are \
                 stated; they are taken to hold there too"
            );
            Warning::new("outside-detector-range", message)
        })
    }
}

fn shortcut(pair: &PairResult) -> Option<Warning> {
    let (exact, shortcut) = (pair.statistical_distance?, pair.statistical_distance_shortcut?);
    let off = shortcut / exact - 1.0;
    (exact > 0.0 && off.abs() > SHORTCUT).then(|| {
        let percent = 100.0 * off;
        let message =
            format!("the shortcut sqrt(N/(1+gamma)) d0 is off by {percent:+.0} %; the exact value is used");
        Warning::new("gamma-shortcut", message)
    })
}

fn full_well(result: &CameraResult) -> Option<Warning> {
    let full = result.camera.full_well?;
    let counts = result.brightest_reading;
    (counts > full).then(|| {
        let message = format!("{counts:.2e} photons in one reading exceed the full well of {full:.2e}");
        Warning::new("full-well", message)
    })
}

fn assumed(camera: &Camera) -> Option<Warning> {
    (!camera.assumed.is_empty()).then(|| {
        let message = format!("no document states all of {}: {}", camera.name, camera.assumed.join("; "));
        Warning::new("camera-figure-assumed", message)
    })
}
