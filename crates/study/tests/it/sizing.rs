//! From a requirement to a camera and back, and scenarios that say the same thing in other units.

use hadar::instrument::figures::NoiseFigures;
use hadar::material::Library;
use hadar::policy::{Quantity, Solution};
use hadar_scenario::Scenario;
use hadar_study::{Sizing, Study};
use hadar_testing::seeded;
use proptest::prelude::*;
use std::sync::OnceLock;

fn size(text: &str) -> Sizing {
    static LIBRARY: OnceLock<Library> = OnceLock::new();
    let library = LIBRARY.get_or_init(|| Library::embedded().unwrap());
    let scenario = Scenario::from_toml(text, None).unwrap_or_else(|error| panic!("{error}\n{text}"));
    Study::new(&scenario, library)
        .and_then(|study| study.size())
        .unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// A camera, a pair and a task, each drawn at random.
#[derive(Debug, Clone)]
struct Task {
    preset: &'static str,
    overrides: Vec<(&'static str, String)>,
    frames: u32,
    target: &'static str,
    other: &'static str,
    temperature_k: f64,
    lighting: f64,
    by: &'static str,
    /// Statistical distance demanded, in units of what the camera reaches.
    harder: f64,
}

impl Task {
    /// The scenario with `extra` keys of the camera in place of those it had.
    fn scenario(&self, required: f64, extra: &[(&str, String)]) -> String {
        let mut camera = vec![("preset", format!("{:?}", self.preset)), ("frames", self.frames.to_string())];
        camera.extend(self.overrides.iter().cloned());
        camera.retain(|(key, _)| extra.iter().all(|(other, _)| key != other));
        camera.extend(extra.iter().cloned());
        let camera: Vec<String> = camera.iter().map(|(key, value)| format!("{key} = {value}")).collect();
        format!(
            "[target]\nmaterial = {:?}\ntemperature = \"{} K\"\ndistance = \"20 m\"\n\
             [[environment]]\ntemperature = \"290 K\"\nlighting = {}\n\
             [alternatives]\nmaterials = [{:?}]\n\
             [bands]\nstep = \"5 cm^-1\"\n\
             [camera]\n{}\n\
             [requirement]\ndistance = {required:e}\nby = {:?}\n",
            self.target,
            self.temperature_k,
            self.lighting,
            self.other,
            camera.join("\n"),
            self.by
        )
    }
}

prop_compose! {
    fn task()(
        preset in prop_oneof![Just("flir-a325sc"), Just("nicolet-is50"), Just("ideal-pnrd")],
        (exposure, pixel, f_number, efficiency) in (0.1f64..10.0, 0.3f64..3.0, 1.0f64..4.0, 0.3f64..1.0),
        (flicker, long, frames) in (0.0f64..1.0, any::<bool>(), 2u32..50),
        (target, other) in prop_oneof![
            Just(("skin", "aluminium")), Just(("skin", "soda-lime-glass")), Just(("water", "concrete")),
            Just(("asphalt", "fabric")), Just(("sand-quartz", "skin")),
        ],
        temperature_k in 260.0..350.0,
        lighting in 0.1..0.9,
        by in prop_oneof![Just("nearest"), Just("local"), Just("local-unknown-gain")],
        harder in 0.1..4.0,
    ) -> Task {
        let own_exposure = if preset == "nicolet-is50" { 2.86e-6 } else { 12e-3 };
        let own_pixel = if preset == "nicolet-is50" { 1e-3 } else { 12e-6 };
        let mut overrides = vec![
            ("pixel", format!("\"{:e} m\"", own_pixel * pixel)),
            ("f_number", f_number.to_string()),
            ("optics_efficiency", efficiency.to_string()),
        ];
        // The detectivity of the spectrometer is pure Johnson noise.
        if preset == "flir-a325sc" {
            overrides.push(("flicker_fraction", flicker.to_string()));
        }
        // One longer exposure, or several frames of the stated one: noise is stated at an exposure.
        if long {
            overrides.push(("exposure", format!("\"{:e} s\"", own_exposure * exposure)));
        }
        let frames = if long { 1 } else { frames };
        Task { preset, overrides, frames, target, other, temperature_k, lighting, by, harder }
    }
}

/// The keys of `[camera]` that set a quantity to the value that was solved for.
fn fed_back(task: &Task, quantity: Quantity, solution: &Solution, value: f64) -> Vec<(&'static str, String)> {
    match quantity {
        Quantity::Exposure => vec![("exposure", format!("\"{value:e} s\""))],
        Quantity::Pixel => vec![("pixel", format!("\"{value:e} m\""))],
        Quantity::FNumber => vec![("f_number", format!("{value:e}"))],
        Quantity::Frames => vec![("frames", format!("{value:.0}"))],
        Quantity::Noise if task.preset == "nicolet-is50" => {
            let detectivity = 4.7e10 * solution.camera / value;
            // Stated under the bandwidth of the preset's own exposure.
            let conditions = ("noise_exposure", "\"2.86 us\"".into());
            vec![("detectivity", format!("\"{detectivity:e} Jones\"")), conditions]
        }
        Quantity::Noise => vec![("noise_electrons", format!("{value:e}"))],
        Quantity::Distance | Quantity::Speed => Vec::new(),
    }
}

/// The solutions that keys of `[camera]` can take.
fn of_camera(sizing: Sizing) -> impl Iterator<Item = (Quantity, Solution)> {
    let solutions = sizing.solve_for.unwrap().0.into_iter();
    solutions.filter(|(quantity, _)| Quantity::OF_CAMERA.contains(quantity))
}

proptest! {
    #![proptest_config(seeded(20, 60))]

    /// What is put in meets the requirement, by no more than rounding is feared to be. The value goes through the text of a scenario,
    /// as a user's would.
    #[test]
    fn what_is_solved_for_gives_the_demanded_distance(task in task()) {
        let reached = size(&task.scenario(1.0, &[])).verdict.statistical_distance.unwrap();
        let required = task.harder * reached;
        let sizing = size(&task.scenario(required, &[]));
        prop_assert_eq!(sizing.verdict.met, Some(task.harder <= 1.0));
        for (quantity, solution) in of_camera(sizing) {
            let Some(value) = solution.value else {
                prop_assert!(solution.reason.is_some() && solution.statistical_distance < required, "{quantity:?}");
                prop_assert!(task.harder > 1.0, "{quantity:?} as it is suffices, but {:?}", solution.reason);
                continue;
            };
            prop_assert!(solution.reason.is_none());
            let forward = |value: f64| {
                let text = task.scenario(required, &fed_back(&task, quantity, &solution, value));
                size(&text).verdict.statistical_distance.unwrap()
            };
            match quantity {
                Quantity::Frames => {
                    prop_assert!(value.fract() == 0.0 && forward(value) >= required * (1.0 - 1e-9), "{value} frames");
                    prop_assert!(value == 1.0 || forward(value - 1.0) < required, "{value} frames are too many");
                }
                // A noiseless detector stays so: it may be better than it must.
                Quantity::Noise if value == 0.0 => prop_assert!(forward(value) >= required),
                _ => {
                    let forward = forward(value);
                    let more = forward / required - 1.0;
                    prop_assert!((0.0..1e-6).contains(&more), "{quantity:?} = {value:e} gives {forward:e}, not {required:e}");
                    prop_assert!((solution.statistical_distance / required - 1.0).abs() < 1e-6);
                }
            }
        }
    }

    /// Longer exposure, larger pixel, faster lens, more frames, less noise: none ever lowers the distance. 1e-9 is the
    /// search's.
    #[test]
    fn a_better_camera_is_never_worse(task in task(), better in 1.0f64..20.0) {
        prop_assume!(task.preset != "ideal-pnrd");
        let sizing = size(&task.scenario(1.0, &[]));
        let now = sizing.verdict.statistical_distance.unwrap();
        for (quantity, solution) in of_camera(sizing) {
            let value = match quantity {
                Quantity::Exposure | Quantity::Pixel => solution.camera * better,
                Quantity::Frames => (solution.camera * better).ceil(),
                Quantity::FNumber => (solution.camera / better).max(0.5),
                Quantity::Noise => solution.camera / better,
                Quantity::Distance | Quantity::Speed => continue,
            };
            let text = task.scenario(1.0, &fed_back(&task, quantity, &solution, value));
            let then = size(&text).verdict.statistical_distance.unwrap();
            prop_assert!(then >= now * (1.0 - 1e-9), "{quantity:?} from {:e} to {value:e}: d {now:e} to {then:e}", solution.camera);
        }
    }
}

const PAIR: &str = "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\n[[environment]]\ntemperature = \"20 degC\"\n\
     lighting = 0.5\n[alternatives]\nmaterials = [\"aluminium\", \"soda-lime-glass\"]\n[camera]\npreset = \"flir-a325sc\"\n";

/// All numbers of two answers agree within `relative`.
#[track_caller]
fn same(a: &str, b: &str, relative: f64) {
    let (a, b) = (size(&format!("{PAIR}{a}")), size(&format!("{PAIR}{b}")));
    for (a, b) in a.pairs.iter().zip(&b.pairs) {
        let numbers = |pair: &hadar_study::PairResult| {
            [
                pair.distance_nearest,
                pair.distance_local,
                pair.distance_local_unknown_gain,
                pair.distance_return,
            ]
            .into_iter()
            .chain([pair.statistical_distance.unwrap(), pair.photons_required.unwrap()])
            .chain([pair.nearest_state.temperature_k, pair.nearest_state.lighting[0]])
            .collect::<Vec<f64>>()
        };
        for (i, (x, y)) in numbers(a).iter().zip(numbers(b)).enumerate() {
            assert!((x / y - 1.0).abs() <= relative, "{}: number {i} is {x:e} and {y:e}", a.alternative);
        }
    }
}

/// 10⁴/λ rounds once (1e-16); what the projection leaves of the spectra magnifies that 3e4-fold (S29), and the state is
/// as good as the root of the search's tolerance.
#[test]
fn bands_in_wavelength_are_those_in_wavenumber() {
    same(
        "[bands]\nranges = [[\"8 um\", \"9 um\"], [\"9 um\", \"10 um\"], [\"10 um\", \"12.5 um\"], [\"12.5 um\", \"14 um\"], [\"8 um\", \"14 um\"]]\n",
        &format!(
            "[bands]\nranges = [[\"{} cm^-1\", \"1250 cm^-1\"], [\"1000 cm^-1\", \"{} cm^-1\"], [\"800 cm^-1\", \"1000 cm^-1\"], [\"{} cm^-1\", \"800 cm^-1\"], [\"{} cm^-1\", \"1250 cm^-1\"]]\n",
            1e4 / 9.0,
            1e4 / 9.0,
            1e4 / 14.0,
            1e4 / 14.0
        ),
        1e-6,
    );
    same(
        "[bands]\nstart = \"8 um\"\nstop = \"13 um\"\nstep = \"0.1 um\"\n",
        "[bands]\nstart = \"8000 nm\"\nstop = \"13000 nm\"\nstep = \"100 nm\"\n",
        1e-6,
    );
}

/// The same numbers after one rounding of the conversion, so all but the last digits.
#[test]
fn the_units_of_temperatures_and_priors_do_not_matter() {
    let prior = |text: &str| {
        format!(
            "[unknown]\nnuisances = [\"temperature\", \"lighting\"]\npriors = {{ temperature = \"{text}\" }}\n"
        )
    };
    same(&prior("2 K"), &prior("2000 mK"), 1e-9);
    same(&prior("2 K"), &prior("2 degC"), 1e-9);
    let kelvin = PAIR.replace("37 degC", "310.15 K").replace("20 degC", "293.15 K");
    let (a, b) = (size(PAIR), size(&kelvin));
    assert!((a.pairs[0].distance_nearest / b.pairs[0].distance_nearest - 1.0).abs() < 1e-9);
}

/// 12.5 degrees behind 35 mm are 640 pixels of 12 um; that there are 8 of them contradicts it, is said, and makes the blur no less.
#[test]
fn pixels_that_contradict_the_view_do_not_sharpen_the_picture() {
    let camera = "[camera]\npreset = \"flir-boson-plus-640\"\nf_number = 1.0\nfocal_length = \"35 mm\"\nfield_of_view = \"12.5 deg\"\n";
    let scene = "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\ndistance = \"20 m\"\n\
                 [[environment]]\ntemperature = \"20 degC\"\nlighting = 0.5\n[alternatives]\nmaterials = [\"aluminium\"]\n\
                 [unknown]\nnuisances = []\n";
    let sized = |more: &str| size(&format!("{scene}\n[requirement]\nspeed = \"30 km/h\"\n{camera}{more}"));
    let blur = |sized: &Sizing| sized.camera.as_ref().unwrap().motion_blur_pixels.unwrap();
    let said =
        |sized: &Sizing| sized.warnings.iter().any(|warning| warning.code().name() == "contradictory-view");
    let (own, few) = (sized(""), sized("pixels = 8\n"));
    // One exposure of 8 ms at the edge of the view, by hand; 0.4 % between the lens and the view is no contradiction.
    let by_hand = 30.0 / 3.6 * 8e-3 * 6.25_f64.to_radians().sin() / (20.0 * 12e-6 / 35e-3);
    assert!((blur(&own) / by_hand - 1.0).abs() < 0.01 && !said(&own), "{}", blur(&own));
    assert!((blur(&few) / by_hand - 1.0).abs() < 1e-9 && said(&few), "{}", blur(&few));
    assert!(few.verdict.fails_by.iter().any(|by| by.code() == "motion-blur"));
    // The solver and the limits on the exposure go by the same blur.
    let solved = &few.solve_for.as_ref().unwrap().0;
    let speed = solved.iter().find(|(quantity, _)| *quantity == Quantity::Speed).unwrap();
    assert!((speed.1.camera * blur(&few) / (30.0 / 3.6) - 1.0).abs() < 1e-9);
}

/// A camera of the scenario's own whose NETD has its conditions: the filled-in scenario with only the solved quantity
/// changed gives the demanded distance. (Where nobody states them, the echo does not either.)
#[test]
fn a_camera_of_ones_own_can_be_fed_back() {
    let text = r#"
        [target]
        material = "skin"
        temperature = "37 degC"
        [[environment]]
        temperature = "20 degC"
        lighting = 0.5
        [alternatives]
        materials = ["aluminium"]
        [camera]
        exposure = "12 ms"
        pixel = "12 um"
        f_number = 1.3
        focal_length = "18 mm"
        netd = "50 mK"
        netd_temperature = "30 degC"
        netd_f_number = 1.3
        netd_pixel = "12 um"
        noise_exposure = "12 ms"
    "#;
    let library = Library::embedded().unwrap();
    let study = Study::new(&Scenario::from_toml(text, None).unwrap(), &library).unwrap();
    let result = study.size().unwrap();
    for (quantity, solution) in &result.solve_for.as_ref().unwrap().0 {
        let mut filled = Scenario::from_toml(&result.scenario.to_toml(), None).unwrap();
        let camera = filled.camera.as_mut().unwrap();
        let Some(value) = solution.value else { continue };
        match quantity {
            Quantity::Exposure => camera.exposure_s = Some(value),
            Quantity::Pixel => camera.pixel_m = Some(value),
            Quantity::FNumber => camera.f_number = Some(value),
            // The electronic part alone is solved for, not the shot noise that an NETD contains.
            Quantity::Noise => {
                camera.noise = NoiseFigures { electrons: Some(value), ..NoiseFigures::default() }
            }
            Quantity::Frames => camera.frames = Some(value as u32),
            Quantity::Distance | Quantity::Speed => continue,
        }
        let reached =
            Study::new(&filled, &library).unwrap().size().unwrap().verdict.statistical_distance.unwrap();
        let short =
            if *quantity == Quantity::Frames { reached < 1.0 - 1e-9 } else { (reached - 1.0).abs() > 3e-9 };
        assert!(!short, "{quantity:?}: {reached}");
    }
}
