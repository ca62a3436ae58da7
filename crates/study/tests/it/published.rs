//! The published numbers, by the product.
//!
//! Bao et al., Nature 619, 743 (2023), doi:10.1038/s41586-023-06174-6, and what an independent recomputation with the
//! authors' own spectra found (`../shared/reproduction.md`; the rows are named as there). A number agrees if it rounds
//! to what is printed, digit for digit, unless a test says why it may not.

use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::detection;
use hadar::identifiability::local::LocalSolver;
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::instrument::{Camera, presets};
use hadar::material::Library;
use hadar::policy::{self, Motion};
use hadar::scene::{EnvironmentObject, State, Surroundings};
use hadar::spectrum::Bands;
use hadar_formats::ReadLibrary as _;
use hadar_scenario::Scenario;
use hadar_study::{PairResult, Study};

const ZERO_CELSIUS_K: f64 = 273.15;

/// `value` in the digits of `printed`, which is either `1.28e6` or `0.187`.
#[track_caller]
fn prints(what: &str, value: f64, printed: &str) {
    let mantissa = printed.split('e').next().unwrap();
    let decimals = mantissa.split('.').nth(1).map_or(0, str::len);
    let shown =
        if printed.contains('e') { format!("{value:.decimals$e}") } else { format!("{value:.decimals$}") };
    println!("{what}: {shown}");
    assert_eq!(shown, printed, "{what} is {value:e}");
}

#[track_caller]
fn within(what: &str, value: f64, published: f64, relative: f64) {
    println!("{what}: {value:.4e}, published {published:.3e}");
    assert!((value / published - 1.0).abs() <= relative, "{what} is {value:e}, published {published:e}");
}

/// The main table: person against robot by three readings, from the example and the embedded materials.
#[test]
fn the_example_gives_the_main_table() {
    let path = hadar_testing::repository().join("examples/human_vs_robot.toml");
    let scenario = Scenario::from_file(&path).unwrap();
    let sizing = Study::new(&scenario, &Library::embedded().unwrap()).unwrap().size().unwrap();
    let pair = &sizing.pairs[0];
    prints("nearest distance", pair.distance_nearest, "8.85e-4");
    prints("local distance", pair.distance_local, "7.31e-4");
    prints("S29", pair.distance_local_unknown_gain, "5.1e-6");
    let photons = sizing.requirement.photons_by;
    prints("photons, nearest", photons.nearest.unwrap(), "1.28e6");
    prints("photons, local", photons.local.unwrap(), "1.87e6");
    prints("photons, S29", photons.local_unknown_gain.unwrap(), "3.8e10");
    let hardware = sizing.requirement.hardware_by_m2_s;
    prints("H, nearest", hardware.nearest.unwrap(), "4.8e-16");
    prints("H, local", hardware.local.unwrap(), "7.1e-16");
    prints("H, S29", hardware.local_unknown_gain.unwrap(), "1.4e-11");
    prints("nearest robot, degC", pair.nearest_state.temperature_k - ZERO_CELSIUS_K, "82.80");
    prints("nearest robot, V", pair.nearest_state.lighting[0], "0.187");
    // 6a: 30 mph at 30 m, with the lens of the paper's view, which the entry's own pixel and focal length contradict.
    let camera = sizing.camera.unwrap().camera;
    let (view_rad, pixels) = camera.view_and_pixels().unwrap();
    let of_view = Camera { focal_length_m: camera.pixel_m * pixels / view_rad, ..camera };
    let blur = Motion::of(&of_view, Some(30.0)).unwrap().blur_pixels(13.4112, 12e-3);
    prints("motion blur, pixels", blur, "0.831");
    // 6e: the information at d = 1.
    prints("information at d = 1, bit", detection::information_bits(1.0), "0.7508");
    // The binary channel that the paper's 'maximum Shannon information' is not.
    prints("mutual information at d = 1, bit", detection::mutual_information_bits(1.0), "0.369");
    assert_eq!(sizing.requirement.photons, photons.nearest);
    assert_eq!(pair.alternative, "aluminium");
}

/// Rows 1, 2 and 4b. The paper's own digits are met within 2 %: it reads 12 µm, 47.8 mK and η = 0.99 from two tables
/// and rounds in between; the recomputed ones to their last digit.
#[test]
fn cameras_of_the_tables() {
    let figures = presets::get("flir-a325sc").unwrap().figures().unwrap();
    prints("1a photons", figures.photons, "2.51e9");
    prints("1b photons per band", figures.photons / figures.bands as f64, "4.67e6");
    prints("2a noise, counts", figures.noise_counts, "1.77e6");
    within("2b gamma, recomputed", figures.gamma_per_band, 6.6e5, 0.02);
    within("2b gamma, Table S2", figures.gamma_per_band, 6.68e5, 0.02);
    within("4b hardware of one frame", figures.hardware_m2_s, 1.53e-18, 0.02);
    within("4b printed 8.16e-18 is 5.33 times that", 8.16e-18 / figures.hardware_m2_s, 5.33, 0.02);
    assert_eq!(figures.bands, 536);
    assert_eq!(figures.reference_temperature_k, 303.15);
    // 2d: Table S2 prints 4.53e4; its own formula gives 1.28e5 at 10 µm, 1.39e5 at the mean wavenumber of 921 cm⁻¹.
    let spectrometer = presets::get("nicolet-is50").unwrap();
    let sigma = |nu| spectrometer.reading_sigma(&Bands::from_rows([(nu, 1.0)]).unwrap()).unwrap()[0];
    prints("2d MCT noise at 10 um", sigma(1000.0), "1.28e5");
    prints("2d MCT noise at 921 cm^-1", sigma(921.0), "1.39e5");
    assert_eq!(presets::get("ideal-pnrd").unwrap().figures().unwrap().gamma_per_band, 0.0);
}

/// One of the authors' tables; `None`, with a printed line, where it is not there.
fn published(name: &str) -> Option<Library> {
    let path = hadar_testing::shared(&format!("hadar-library/{name}"))?;
    let mut library = Library::empty();
    library.add_file(&path).unwrap();
    Some(library)
}

/// A pair in the scene of the paper: T₀ = 20 °C, 715–1250 cm⁻¹ in steps of 1, temperature and lighting unknown,
/// edges held as the recomputation did.
fn pair(library: &Library, target: &str, other: &str, celsius: f64, lighting: f64) -> PairResult {
    let text = format!(
        "[target]\nmaterial = {target:?}\ntemperature = \"{celsius} degC\"\nextrapolate = \"hold\"\n\
         [[environment]]\ntemperature = \"20 degC\"\nlighting = {lighting}\n\
         [alternatives]\nmaterials = [{other:?}]\nextrapolate = \"hold\"\n"
    );
    let scenario = Scenario::from_toml(&text, None).unwrap();
    Study::new(&scenario, library).unwrap().identify().unwrap().pairs.remove(0)
}

/// Row 5a with the authors' 54 channels, and the ratios of calibrated to normalised distance of the notes.
#[test]
fn the_table_of_54_channels() {
    let Some(library) = published("emissivity_54.csv") else { return };
    let robot = pair(&library, "human", "al", 37.0, 0.5);
    prints("5a human to al, raw counts", robot.distance_local, "7.5e-4");
    prints("5a human to al, S29", robot.distance_local_unknown_gain, "1.48e-4");
    prints("5b photons, S29", robot.photons_required_by.local_unknown_gain.unwrap(), "4.6e7");
    // 5d's weighted fit: 82.74 °C and 0.188 by χ².
    prints("5d nearest robot, degC", robot.nearest_state.temperature_k - ZERO_CELSIUS_K, "82.74");
    prints("5d nearest robot, V", robot.nearest_state.lighting[0], "0.188");
    prints(
        "al to human, S29",
        pair(&library, "al", "human", 37.0, 0.5).distance_local_unknown_gain,
        "8.9e-4",
    );
    let glass = pair(&library, "human", "crystal-glass", 37.0, 0.5);
    prints("5c glass, raw counts", glass.distance_local, "0.0484");
    prints("5c glass, S29", glass.distance_local_unknown_gain, "0.039");
    prints("5c glass, nearest with V at most 1", glass.distance_nearest, "0.052");
    assert_eq!(glass.nearest_at_edge, ["lighting[0]"]);
    for (other, printed) in
        [("al", "5.1"), ("crystal-glass", "1.24"), ("carwindow", "1.29"), ("weathered-metal", "1.44")]
    {
        let pair = pair(&library, "human", other, 37.0, 0.5);
        prints(
            &format!("raw over normalised, {other}"),
            pair.distance_local / pair.distance_local_unknown_gain,
            printed,
        );
    }
}

/// Row 5a with the 49 channels, whose edges below 760 cm⁻¹ are held: the hazard of the notes, reproduced.
#[test]
fn the_table_of_49_channels() {
    let Some(library) = published("emissivity_49.csv") else { return };
    let robot = pair(&library, "human", "al", 37.0, 0.5);
    prints("5a human to al, raw counts", robot.distance_local, "7.9e-4");
    prints("5a human to al, S29", robot.distance_local_unknown_gain, "7.58e-4");
    prints("raw over normalised", robot.distance_local / robot.distance_local_unknown_gain, "1.04");
    let glass = pair(&library, "human", "crystal-glass", 37.0, 0.5);
    prints("5c glass, raw counts", glass.distance_local, "0.0480");
    prints("5c glass, S29", glass.distance_local_unknown_gain, "0.039");
    let s29 = |target, other, celsius, lighting| {
        pair(&library, target, other, celsius, lighting).distance_local_unknown_gain
    };
    prints("al to human", s29("al", "human", 37.0, 0.5), "1.74e-3");
    prints("human to al at 60 degC", s29("human", "al", 60.0, 0.5), "8.7e-4");
    prints("human to al, V = 0.17", s29("human", "al", 37.0, 0.17), "1.10e-3");
    prints("glass at 60 degC", s29("human", "crystal-glass", 60.0, 0.5), "0.047");
}

/// Emissivities on the paper's 536 bands with the surroundings at 20 °C.
struct Scene {
    bands: Bands,
    surroundings: Surroundings,
}

impl Scene {
    fn new() -> Self {
        let bands = Bands::uniform(715.0, 1250.0, 1.0).unwrap();
        let object = EnvironmentObject { temperature_k: 293.15, emissivity: None };
        let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object]).unwrap();
        Self { bands, surroundings }
    }

    fn material(&self, library: &Library, name: &str) -> Vec<f64> {
        let material = library.get(name).unwrap().clone();
        material
            .with_extrapolation(hadar::material::Extrapolation::Hold)
            .emissivity(self.bands.nodes_cm1())
            .unwrap()
    }

    fn state(&self, celsius: f64, lighting: f64) -> State {
        self.surroundings.state(celsius + ZERO_CELSIUS_K, &[lighting]).unwrap()
    }

    fn solver(&self, range: StateRange) -> NearestSolver<'_> {
        NearestSolver::new(&self.bands, &self.surroundings, free(), range)
    }
}

fn free() -> Unknowns {
    Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).unwrap()
}

/// Row 5d: the paper's robot, 83.46 °C and V = 0.17, is the unweighted fit of absolute spectra. With a constant
/// electronic noise far above the shot noise the nearest state is that fit. The notes find 83.49 and 0.169 with the
/// authors' table (83.38–83.53, 0.168–0.172 by grid and extrapolation), 83.56 and 0.167 with the quadratic.
#[test]
fn the_papers_robot_is_the_unweighted_fit() {
    let scene = Scene::new();
    let unweighted = |human: &[f64], robot: &[f64]| {
        let counting = Counting { counts_per_radiance: 1e-12, var_added: vec![1e22; scene.bands.len()] };
        let mut solver = scene.solver(StateRange::default());
        let nearest = solver.with_counting(human, robot, &scene.state(37.0, 0.5), &counting).unwrap();
        (nearest.state.temperature_k - ZERO_CELSIUS_K, nearest.state.lighting[0])
    };
    let embedded = Library::embedded().unwrap();
    let (celsius, lighting) =
        unweighted(&scene.material(&embedded, "skin"), &scene.material(&embedded, "aluminium"));
    // A fit of T′ alone, V′ eliminated in closed form, gives 83.5546 as well; the notes round it up.
    prints("quadratic, degC", celsius, "83.5546");
    assert!((celsius - 83.56).abs() < 0.01);
    prints("quadratic, V", lighting, "0.167");
    let Some(library) = published("emissivity_54.csv") else { return };
    let (celsius, lighting) = unweighted(&scene.material(&library, "human"), &scene.material(&library, "al"));
    prints("5d degC", celsius, "83.49");
    prints("5d V", lighting, "0.169");
}

/// Rows 4a, 5a and 5c by their definitions, evaluated at the states that the paper names.
#[test]
fn chords_to_the_papers_states() {
    let Some(library) = published("emissivity_54.csv") else { return };
    let scene = Scene::new();
    let (human, robot) = (scene.material(&library, "human"), scene.material(&library, "al"));
    let state = scene.state(37.0, 0.5);
    let signal = scene.surroundings.signal(&human, &state);
    let total: f64 = signal.iter().sum();
    // 5a: half the Mahalanobis chord to (83.46 °C, 0.17), ½√Σ(ΔN)²/N.
    let other = scene.surroundings.signal(&robot, &scene.state(83.46, 0.17));
    let chord: f64 = signal.iter().zip(&other).map(|(a, b)| (a - b).powi(2) / a).sum();
    let chord = 0.5 * (chord / total).sqrt();
    prints("5a chord to the paper's robot", chord, "1.014e-3");
    prints("5b photons by that chord", policy::photons_required(1.0, chord).unwrap(), "9.7e5");
    // 4a: H for N/(1 + γ) ≥ 10⁶; another sampling of the table's edges moves the third digit.
    within("4a hardware for 1e6 photons", policy::hardware_required_m2_s(1e6, total), 3.78e-16, 3e-3);
    // 5c with V unbounded: 0.0130 at V = 1.29.
    let glass = scene.material(&library, "crystal-glass");
    let range = StateRange { lighting: [0.0, 10.0], lighting_sum: 10.0, ..StateRange::default() };
    let nearest = scene.solver(range).per_photon(&human, &glass, &state, f64::INFINITY).unwrap();
    prints("5c glass, any V", nearest.distance, "0.0130");
    prints("5c glass, that V", nearest.state.lighting[0], "1.29");
}

/// All 756 ordered pairs of the authors' table, target at 60 °C and V = 0.5, T′ in 250–450 K: the local distance is off
/// by more than a factor 2 in 38 % of them, the photons it demands by more than 10 in 22 %. Tolerance 1.5 %: half of
/// the last digit, and one in a hundred pairs for another reading of 'nearest' (a chord to first order), since it only
/// counts.
#[test]
fn how_often_the_local_distance_is_no_limit() {
    let Some(library) = published("emissivity_54.csv") else { return };
    let scene = Scene::new();
    let names: Vec<&str> = library.names().collect();
    assert_eq!(names.len(), 28);
    let materials: Vec<Vec<f64>> = names.iter().map(|name| scene.material(&library, name)).collect();
    let range = StateRange { temperature_k: [250.0, 450.0], ..StateRange::default() };
    let mut solver = scene.solver(range);
    let mut local = LocalSolver::new(&scene.bands, &scene.surroundings, free());
    let state = scene.state(60.0, 0.5);
    let (mut pairs, mut off_by_two, mut photons_off_by_ten) = (0.0, 0.0, 0.0);
    for (i, target) in materials.iter().enumerate() {
        for other in materials.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, other)| other) {
            let nearest = solver.per_photon(target, other, &state, f64::INFINITY).unwrap().distance;
            let tangent = local.per_photon(target, other, &state, f64::INFINITY).unwrap().distance;
            let ratio = (nearest / tangent).max(tangent / nearest);
            pairs += 1.0;
            off_by_two += f64::from(u8::from(ratio > 2.0));
            photons_off_by_ten += f64::from(u8::from(ratio * ratio > 10.0));
        }
    }
    println!("off by 2: {:.4}; photons off by 10: {:.4}", off_by_two / pairs, photons_off_by_ten / pairs);
    assert_eq!(pairs, 756.0);
    assert!((off_by_two / pairs - 0.38_f64).abs() <= 0.015);
    assert!((photons_off_by_ten / pairs - 0.22_f64).abs() <= 0.015);
}
