//! Every figure that would do is put in: then the requirement is met, and with one per cent less it is not.

use hadar::material::Library;
use hadar::policy::Quantity;
use hadar_scenario::Scenario;
use hadar_study::{Sizing, Study};
use hadar_testing::seeded;
use proptest::prelude::*;
use std::sync::OnceLock;

pub(crate) fn library() -> &'static Library {
    static LIBRARY: OnceLock<Library> = OnceLock::new();
    LIBRARY.get_or_init(|| Library::embedded().unwrap())
}

fn size(text: &str) -> Sizing {
    let scenario = Scenario::from_toml(text, None).unwrap_or_else(|error| panic!("{error}\n{text}"));
    Study::new(&scenario, library())
        .and_then(|study| study.size())
        .unwrap_or_else(|error| panic!("{error}\n{text}"))
}

const MATERIALS: [&str; 10] = [
    "skin",
    "aluminium",
    "concrete",
    "pmma",
    "fabric",
    "water",
    "asphalt",
    "soda-lime-glass",
    "sand-quartz",
    "pvc-tape",
];

/// A camera before a target and several alternatives, with what limits it beside the statistical distance.
#[derive(Debug, Clone)]
pub(crate) struct Task {
    target: usize,
    alternatives: Vec<usize>,
    class: bool,
    temperature_k: f64,
    lighting: f64,
    unknown: &'static str,
    air: bool,
    pub(crate) exposure_s: f64,
    pixel_m: f64,
    f_number: f64,
    pub(crate) noise: f64,
    frames: u32,
    flicker: f64,
    pub(crate) full_well: Option<f64>,
    speed: Option<f64>,
    distance_m: f64,
    harder: f64,
}

impl Task {
    /// The scenario with one figure replaced.
    pub(crate) fn scenario(
        &self,
        required: f64,
        changed: Option<(Quantity, f64)>,
        exposure_s: Option<f64>,
    ) -> String {
        let value = |quantity, own: f64| match changed {
            Some((other, value)) if other == quantity => value,
            _ => own,
        };
        let exposure = exposure_s.unwrap_or_else(|| value(Quantity::Exposure, self.exposure_s));
        let speed = match changed {
            Some((Quantity::Speed, value)) => Some(value),
            _ => self.speed,
        };
        let others: Vec<&str> = self
            .alternatives
            .iter()
            .map(|i| MATERIALS[*i])
            .filter(|name| *name != MATERIALS[self.target])
            .collect();
        let (class, others) = match self.class {
            true => (format!("[class.thing]\nmaterials = {others:?}\n"), "[\"thing\"]".to_owned()),
            false => (String::new(), format!("{others:?}")),
        };
        let air =
            if self.air { "[atmosphere]\nmodel = \"us-standard\"\ntemperature = \"285 K\"\n" } else { "" };
        let well = self.full_well.map_or_else(String::new, |well| format!("full_well = {well:e}\n"));
        let speed = speed.map_or_else(String::new, |speed| format!("speed = \"{speed:e} m/s\"\n"));
        format!(
            "[target]\nmaterial = {:?}\ntemperature = \"{} K\"\ndistance = \"{:e} m\"\n\
             [[environment]]\ntemperature = \"290 K\"\nlighting = {}\n\
             [alternatives]\nmaterials = {others}\n{class}\
             [bands]\nstart = \"720 cm^-1\"\nstop = \"1240 cm^-1\"\nstep = \"40 cm^-1\"\n\
             [unknown]\nnuisances = {}\n{air}\
             [camera]\nexposure = \"{exposure:e} s\"\npixel = \"{:e} m\"\nf_number = {}\nfocal_length = \"18 mm\"\n\
             noise_electrons = {:e}\nnoise_exposure = \"{:e} s\"\nflicker_fraction = {}\nframes = {}\n\
             frame_rate = \"30 Hz\"\nreadout = \"simultaneous\"\n{well}\
             [requirement]\ndistance = {required:e}\n{speed}",
            MATERIALS[self.target],
            self.temperature_k,
            value(Quantity::Distance, self.distance_m),
            self.lighting,
            self.unknown,
            value(Quantity::Pixel, self.pixel_m),
            value(Quantity::FNumber, self.f_number),
            value(Quantity::Noise, self.noise),
            self.exposure_s,
            self.flicker,
            value(Quantity::Frames, f64::from(self.frames)),
        )
    }
}

prop_compose! {
    pub(crate) fn task()(
        (target, alternatives) in (0..10usize, prop::collection::vec(0..10usize, 2..5)),
        (class, air) in (prop::bool::weighted(0.3), prop::bool::weighted(0.3)),
        (temperature_k, lighting) in (270.0..330.0f64, 0.1..0.9f64),
        unknown in prop_oneof![
            Just("[]"), Just("[\"temperature\"]"), Just("[\"temperature\", \"lighting\"]"),
            Just("[\"temperature\", \"lighting\", \"gain\"]"),
        ],
        (exposure, pixel_um, f_number) in (0.1..20.0f64, 8.0..40.0f64, 1.0..3.0f64),
        (noise, frames, flicker) in (3.0..7.0f64, 1u32..20, 0.0..0.6f64),
        (full, well) in (prop::bool::weighted(0.4), 7.0..13.0f64),
        (moves, speed) in (prop::bool::weighted(0.5), 0.01..10.0f64),
        (distance_m, harder) in (5.0..100.0f64, 0.2..3.0f64),
    ) -> Task {
        // Another one than the target.
        let mut alternatives = alternatives;
        alternatives.push((target + 1) % MATERIALS.len());
        alternatives.sort_unstable();
        alternatives.dedup();
        Task {
            target,
            alternatives,
            class,
            temperature_k,
            lighting,
            unknown,
            air,
            exposure_s: 1e-3 * exposure,
            pixel_m: 1e-6 * pixel_um,
            f_number,
            noise: 10f64.powf(noise),
            frames,
            flicker,
            full_well: full.then(|| 10f64.powf(well)),
            speed: moves.then_some(speed),
            distance_m,
            harder,
        }
    }
}

proptest! {
    #![proptest_config(seeded(40, 60))]
    #[test]
    fn what_is_put_in_meets_and_one_per_cent_less_does_not(task in task()) {
        let own = size(&task.scenario(1.0, None, None));
        let reached = own.verdict.upper.unwrap_or(0.0);
        prop_assume!(reached > 1e-3 && reached < 1e6);
        let required = reached * task.harder;
        let sizing = size(&task.scenario(required, None, None));
        prop_assert!(sizing.verdict.lower <= sizing.verdict.upper);
        for (quantity, solution) in &sizing.solve_for.as_ref().expect("a camera").0 {
            let Some(value) = solution.value else { continue };
            if quantity.is_least() {
                prop_assert!(solution.necessary.is_some_and(|necessary| necessary <= value * (1.0 + 1e-12)));
            }
            let again = |value: f64| {
                let text = task.scenario(required * (1.0 - 1e-8), Some((*quantity, value)), solution.exposure_s);
                (size(&text).verdict, text)
            };
            let (verdict, text) = again(value);
            prop_assert!(verdict.met == Some(true), "{quantity:?} {solution:?} {verdict:?}\n{text}");
            let less = match quantity {
                Quantity::Frames => value - 1.0,
                _ if quantity.is_least() => 0.99 * value,
                _ => 1.01 * value,
            };
            // Without air the distance hardly matters.
            let same = *quantity == Quantity::Distance && !task.air;
            if same || less < 1.0 && *quantity == Quantity::Frames || value == 0.0 {
                continue;
            }
            let (verdict, text) = again(less);
            prop_assert!(verdict.met != Some(true), "{quantity:?} {solution:?} {verdict:?}\n{text}");
        }
    }
}
