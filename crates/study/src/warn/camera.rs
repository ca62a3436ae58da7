//! Warnings on the camera in its scene: where an assumption of the bound fails.

use super::super::identify::PairResult;
use super::super::size::CameraResult;
use super::super::{Proviso, Study, Warning};
use hadar::identifiability::decision::DecisionLaw;
use hadar::instrument::Camera;
use hadar::policy::caps::longest_wavelength_m;

/// Relative difference between shortcut and exact statistical distance worth a word.
const SHORTCUT: f64 = 0.1;
/// Share of a band that may be outside: a band that is centred at the end of the range, and rounding.
const HALF: f64 = 0.5 + 1e-9;
/// Radius of the first dark ring of a point's image, in units of λF.
const AIRY: f64 = 1.22;

/// That the figures of a camera which say what a pixel sees contradict each other.
pub(crate) fn contradiction(camera: &Camera) -> Option<Warning> {
    let [finer_rad, coarser_rad] = camera.pixel_angles_rad();
    camera.contradicts_its_view().then_some(Warning::ContradictoryView { finer_rad, coarser_rad })
}

impl Study {
    /// Warnings on the camera in the scene, against the limiting alternative.
    pub(crate) fn camera_result_warnings(&self, result: &CameraResult, pair: &PairResult) -> Vec<Warning> {
        let camera = &result.camera;
        let found = [
            shortcut(pair),
            contradiction(camera).filter(|_| self.angle_matters()),
            self.proviso(camera).map(Warning::FramesInMotion),
            self.small_target(camera),
            self.size_unknown(camera, self.scenario.target.distance_m),
            self.diffraction(camera),
            self.frame_rate(camera),
            self.outside_range(camera),
            self.filter_light(camera),
            assumed(camera),
        ];
        self.image_warnings(result).into_iter().chain(found.into_iter().flatten()).collect()
    }

    /// What spoils the image, whatever is made of its counts.
    pub(crate) fn image_warnings(&self, result: &CameraResult) -> Vec<Warning> {
        [self.motion(result), full_well(result)].into_iter().flatten().collect()
    }

    fn proviso(&self, camera: &Camera) -> Option<Proviso> {
        Proviso::of(camera, self.bands.len(), self.scenario.requirement.speed_m_s?)
    }

    fn motion(&self, result: &CameraResult) -> Option<Warning> {
        self.scenario.requirement.speed_m_s?;
        let Some(blur) = result.motion_blur_pixels else {
            return Some(Warning::MotionBlurUnknown);
        };
        (blur >= 1.0).then_some(Warning::MotionBlur { pixels: blur })
    }

    /// Whether what a pixel sees is used: for motion blur, or for the share of it that the target fills.
    const fn angle_matters(&self) -> bool {
        self.scenario.requirement.speed_m_s.is_some() || self.scenario.target.size_m.is_some()
    }

    /// Filters without the light they throw back, or a sensor's temperature without filters.
    fn filter_light(&self, camera: &Camera) -> Option<Warning> {
        let filters = self.open_bands.bands().iter().any(|band| band.name.is_some());
        match (filters, camera.sensor_temperature_k) {
            (true, None) => Some(Warning::FilterLightLeftOut),
            (false, Some(_)) => Some(Warning::SensorTemperatureIdle),
            _ => None,
        }
    }

    fn small_target(&self, camera: &Camera) -> Option<Warning> {
        let fill = self.fill(camera, self.scenario.target.distance_m);
        (fill < 1.0).then_some(Warning::TargetSmallerThanPixel { fill })
    }

    fn diffraction(&self, camera: &Camera) -> Option<Warning> {
        let wavelength_m = longest_wavelength_m(&self.bands);
        let blur_m = wavelength_m * camera.f_number;
        let (ring_m, pixel_m) = (AIRY * blur_m, camera.pixel_m);
        (pixel_m < blur_m).then_some(Warning::Diffraction { wavelength_m, blur_m, ring_m, pixel_m })
    }

    /// Several exposures come at the frame rate, however short each is.
    fn frame_rate(&self, camera: &Camera) -> Option<Warning> {
        let frame_s = camera.frame_s()?;
        let exposures = camera.readout.exposures(self.bands.len()) as f64 * f64::from(camera.frames);
        // Shorter by less than this is no other time.
        let waits = camera.exposure_s < 0.9 * frame_s;
        (exposures > 1.0 && waits).then(|| Warning::FrameRate {
            exposures,
            acquisition_s: camera.acquisition_s(self.bands.len()),
            frame_rate_hz: frame_s.recip(),
            exposed_s: exposures * camera.exposure_s,
        })
    }

    /// How many bands are for more than half out of the range of the detector; one that is wholly so was refused.
    pub(crate) fn bands_beyond(&self, camera: &Camera) -> usize {
        let [low, high] = camera.spectral_range_cm1;
        let beyond = |from: f64, to: f64| (low - from).max(to - high) > HALF * (to - from);
        self.bands.bands().iter().filter(|band| beyond(band.low_cm1, band.high_cm1)).count()
    }

    pub(crate) fn outside_range(&self, camera: &Camera) -> Option<Warning> {
        let outside = self.bands_beyond(camera);
        let (bands, range_cm1) = (self.bands.len(), camera.spectral_range_cm1);
        (outside > 0).then_some(Warning::OutsideDetectorRange { outside, bands, range_cm1 })
    }
}

fn shortcut(pair: &PairResult) -> Option<Warning> {
    // Of few counts it is not the distance that is off.
    pair.decided_by.filter(|law| *law == DecisionLaw::Gaussian)?;
    let (exact, shortcut) = (pair.statistical_distance?, pair.statistical_distance_shortcut?);
    let off = shortcut / exact - 1.0;
    (exact > 0.0 && off.abs() > SHORTCUT).then_some(Warning::GammaShortcut { off })
}

fn full_well(result: &CameraResult) -> Option<Warning> {
    let (counts, full_well) = (result.brightest_reading, result.camera.full_well?);
    (counts > full_well).then_some(Warning::FullWell { counts, full_well })
}

pub(crate) fn assumed(camera: &Camera) -> Option<Warning> {
    let (name, figures) = (&camera.name, &camera.assumed);
    (!figures.is_empty())
        .then(|| Warning::CameraFiguresAssumed { camera: name.clone(), figures: figures.clone() })
}
