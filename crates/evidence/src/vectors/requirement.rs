//! What it takes to reach a statistical distance: photons, hardware, and one figure of a camera with the others held.
//!
//! The figure is found by halving, to the last bit, with the camera's counts and noise at every trial rounded to doubles.

use super::answer::{Answer, Vector, reach};
use super::counts::{camera, camera_json, netd};
use super::json::Json;
use super::scene::{Scene, coat, glass, metal, sand};
use super::solve::crossing;
use super::topic::Topic;
use crate::reference::Extended;
use crate::reference::camera::{Place, counted};
use crate::reference::local::{LocalReference, Noise};
use hadar::error::Result;
use hadar::fisher::{Counting, Nuisance};
use hadar::instrument::{Camera, FASTEST_F_NUMBER, NoiseSpec};

/// To what share of itself a figure has to be found: roots are sought to the last bits of a logarithm.
const SOLVED: f64 = 1e-9;
/// How far a figure of a camera is changed in search of one that will do.
const FARTHEST: f64 = 1e12;

/// A figure that is solved for.
#[derive(Debug, Clone, Copy)]
enum Figure {
    Exposure,
    Pixel,
    FNumber,
    Noise,
    Frames,
}

pub(super) fn topic() -> Result<Topic> {
    let closed = [
        ("photons", "photons and hardware of the paper's inequality", 1.0, 8.85e-4, 3.3766e21),
        ("reliable", "a distance for 99.9 % of the cases", 3.090_232_306_167_814, 0.0125, 2.5e21),
        ("hopeless", "no distance: no number of photons is enough", 1.0, 0.0, 3e21),
        ("nearly-hopeless", "1e24 photons", 1.0, 1e-12, 3e21),
    ];
    let quiet = camera()?;
    let bolometer = Camera { noise: netd(0.05, &quiet), ..quiet.clone() };
    let flicker = Camera { flicker_fraction: 0.2, ..bolometer.clone() };
    let counts = Camera { noise: NoiseSpec::Counts { sigma_counts: 2e5 }, ..quiet.clone() };
    let easy = Scene::of(sand, glass)?.not_knowing([Nuisance::Temperature, Nuisance::Lighting]);
    let hard = Scene::of(coat, metal)?.not_knowing([Nuisance::Temperature, Nuisance::Lighting]);
    let solved = [
        ("exposure-shot", "shot noise alone: exposure as the square", &quiet, &hard, 100.0, Figure::Exposure),
        (
            "exposure-noisy",
            "Johnson noise, whose variance grows with the exposure as the photons do",
            &bolometer,
            &easy,
            20.0,
            Figure::Exposure,
        ),
        ("exposure-flicker", "with flicker: near its floor", &flicker, &easy, 15.0, Figure::Exposure),
        (
            "exposure-never",
            "beyond what flicker leaves: no exposure is long enough",
            &flicker,
            &easy,
            25.0,
            Figure::Exposure,
        ),
        ("f-number", "the slowest lens that will do", &counts, &easy, 40.0, Figure::FNumber),
        ("f-number-never", "no lens in air is faster than f/0.5", &counts, &easy, 1e3, Figure::FNumber),
        ("pixel", "the least pixel behind a lens of the same f-number", &counts, &easy, 40.0, Figure::Pixel),
        ("noise", "the most noise of a reading", &counts, &easy, 200.0, Figure::Noise),
        ("noise-never", "shot noise alone is too much", &counts, &easy, 2e3, Figure::Noise),
        ("frames", "the least whole number of frames", &counts, &easy, 300.0, Figure::Frames),
    ];
    let closed = closed.into_iter().map(|(id, about, required, distance, radiance)| {
        Ok(of_photons(id, about, [required, distance, radiance]))
    });
    let solved = solved.into_iter().map(|(id, about, camera, scene, required, figure)| {
        of_camera(id, about, (camera, scene), required, figure)
    });
    Ok(Topic {
        name: "requirement",
        title: "Photons, hardware and figures of a camera that a statistical distance takes",
        catches: "d for d^2, 4/pi upside down, a number where there is none; solutions from the noise at the camera's own exposure, or \
                  from one gamma for all bands; a flicker floor that is not seen",
        vectors: closed.chain(solved).collect::<Result<_>>()?,
        files: Vec::new(),
    })
}

/// N = (d_req/d₀)², H = N/(Φ π/4).
fn of_photons(id: &'static str, about: &'static str, [required, distance, radiance]: [f64; 3]) -> Vector {
    let inputs = Json::object([
        ("statistical_distance_required", required.into()),
        ("distance", distance.into()),
        ("photon_radiance_per_s_m2_sr", radiance.into()),
    ]);
    let answers = if distance == 0.0 {
        [Answer::none(), Answer::none()]
    } else {
        let photons = (Extended::from(required) / Extended::from(distance)).square();
        let share = Extended::from(radiance) * Extended::pi() / Extended::from(4.0);
        [Answer::one(&photons, reach(0.0)), Answer::one(&(&photons / share), reach(0.0))]
    };
    let [photons, hardware] = answers;
    Vector::new(id, about, inputs, [("photons_required", photons), ("hardware_required_m2_s", hardware)])
}

fn of_camera(
    id: &'static str,
    about: &'static str,
    (camera, scene): (&Camera, &Scene),
    required: f64,
    figure: Figure,
) -> Result<Vector> {
    let (surroundings, state) = (scene.surroundings()?, scene.state());
    let mut reference = LocalReference::new(&scene.bands, &surroundings, scene.unknowns()?);
    let signal = reference.signal(&scene.target, &state);
    let place = Place { distance_m: Some(20.0), size_m: None };
    let mut reached = |camera: &Camera| -> Result<Extended> {
        let counting = counting(camera, scene, &signal, place)?;
        Ok(reference.answer(scene.pair(&state), Noise::Counting(&counting), &[]).distance)
    };
    let needed = Extended::from(required);
    let own = figure.of(camera);
    // From what is surely not enough to the best that there is.
    let [worst, best] = match figure {
        Figure::Exposure | Figure::Pixel => [own / FARTHEST, own * FARTHEST],
        Figure::FNumber => [own * FARTHEST, FASTEST_F_NUMBER],
        Figure::Noise => [own * FARTHEST, 0.0],
        Figure::Frames => [0.0, f64::from(u32::MAX)],
    };
    let enough = reached(&figure.changed(camera, best))? >= needed;
    let whole = matches!(figure, Figure::Frames);
    let mut failed = None;
    let value = enough.then(|| {
        let mut will_do = |value: f64| match reached(&figure.changed(camera, value)) {
            Ok(distance) => distance >= needed,
            Err(error) => {
                failed = Some(error);
                true
            }
        };
        if whole {
            crossing([worst, best], |value| will_do(value.floor())).floor()
        } else {
            crossing([worst, best], will_do)
        }
    });
    if let Some(error) = failed {
        return Err(error);
    }
    let answer =
        value.map_or_else(Answer::none, |value| Answer::double(value, if whole { 0.0 } else { SOLVED }));
    let mut inputs = scene.asked();
    inputs.retain(|(key, _)| key != "noise");
    inputs.push(("camera".into(), camera_json(camera)));
    inputs.push(("distance_m".into(), place.distance_m.into()));
    inputs.push(("statistical_distance_required".into(), required.into()));
    Ok(Vector::new(id, about, Json::Object(inputs), [(figure.name(), answer)]))
}

/// Counts and noise as doubles.
pub(super) fn counting(
    camera: &Camera,
    scene: &Scene,
    signal: &[Extended],
    place: Place,
) -> Result<Counting> {
    let found = counted(camera, &scene.bands, signal, place)?;
    Ok(Counting {
        counts_per_radiance: found.counts_per_radiance.to_f64(),
        var_added: found.var_added.iter().map(Extended::to_f64).collect(),
    })
}

impl Figure {
    const fn name(self) -> &'static str {
        match self {
            Self::Exposure => "exposure_s",
            Self::Pixel => "pixel_m",
            Self::FNumber => "f_number",
            Self::Noise => "noise_counts",
            Self::Frames => "frames",
        }
    }

    fn of(self, camera: &Camera) -> f64 {
        match (self, &camera.noise) {
            (Self::Exposure, _) => camera.exposure_s,
            (Self::Pixel, _) => camera.pixel_m,
            (Self::FNumber, _) => camera.f_number,
            (Self::Frames, _) => f64::from(camera.frames),
            (Self::Noise, NoiseSpec::Counts { sigma_counts }) => *sigma_counts,
            (Self::Noise, _) => 0.0,
        }
    }

    fn changed(self, camera: &Camera, value: f64) -> Camera {
        let mut camera = camera.clone();
        match self {
            Self::Exposure => camera.exposure_s = value,
            Self::Pixel => camera.pixel_m = value,
            Self::FNumber => camera.f_number = value,
            Self::Noise => camera.noise = NoiseSpec::Counts { sigma_counts: value },
            Self::Frames => camera.frames = value as u32,
        }
        camera
    }
}
