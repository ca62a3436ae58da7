//! The companion table: what practice says beside the bound, and that they answer different questions.

use hadar::material::Library;
use hadar::policy::practice::ObserverTask;
use hadar::spectrum::Bands;
use hadar_scenario::Scenario;
use hadar_study::companion::{Companion, CompanionRow, Given, Kind, Measure, Told, Unknown};
use hadar_study::{Sizing, Study};
use std::sync::OnceLock;

/// Half a metre at 20 m; 24 mm over 12 um: 50 pixels across it, 1 km for one.
const SCENE: &str = r#"
[target]
material = "skin"
temperature = "37 degC"
distance = "20 m"
size = "0.5 m"
[background]
temperature = "20 degC"
[[environment]]
temperature = "20 degC"
lighting = 1.0
[alternatives]
materials = ["aluminium"]
[bands]
step = "20 cm^-1"
[camera]
exposure = "10 ms"
pixel = "12 um"
f_number = 1.0
focal_length = "24 mm"
netd = "50 mK"
"#;

fn study(text: &str) -> Study {
    static LIBRARY: OnceLock<Library> = OnceLock::new();
    let library = LIBRARY.get_or_init(|| Library::embedded().unwrap());
    let scenario = Scenario::from_toml(text, None).unwrap_or_else(|error| panic!("{error}\n{text}"));
    Study::new(&scenario, library).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn size(text: &str) -> (Sizing, Companion) {
    let sizing = study(text).size().unwrap();
    let companion = sizing.companion.clone().unwrap();
    (sizing, companion)
}

#[track_caller]
fn one(companion: &Companion, measure: Measure, task: Option<ObserverTask>) -> &CompanionRow {
    let mut rows = companion.of_measure(measure).filter(|row| row.task == task);
    let row = rows.next().unwrap();
    assert!(rows.next().is_none());
    row
}

#[track_caller]
fn near(found: Option<f64>, exact: f64, tolerance: f64) {
    let found = found.unwrap();
    assert!((found / exact - 1.0).abs() <= tolerance, "{found:e} against {exact:e}");
}

/// By hand: 50 pixels are 25 cycles; detection to 1000 m/(2 × 1.0).
#[test]
fn every_row_is_what_its_formula_gives() {
    let (sizing, companion) = size(SCENE);
    let across = one(&companion, Measure::PixelsOnTarget, None);
    near(across.value("pixels"), 50.0, 1e-12);
    near(across.value("cycles"), 25.0, 1e-12);
    for (task, johnson, industry) in [
        (ObserverTask::Detect, 500.0, Some(2000.0 / 3.0)),
        (ObserverTask::Orient, 357.142_857, None),
        (ObserverTask::Recognise, 125.0, Some(1000.0 / 6.0)),
        (ObserverTask::Identify, 78.125, Some(1000.0 / 12.0)),
    ] {
        near(one(&companion, Measure::JohnsonRange, Some(task)).value("range_m"), johnson, 1e-8);
        let found = companion.of_measure(Measure::IndustryRange).find(|row| row.task == Some(task));
        assert_eq!(found.is_some(), industry.is_some());
        if let (Some(row), Some(exact)) = (found, industry) {
            near(row.value("range_m"), exact, 1e-12);
        }
    }
    // x = 25/6.4, E = 5.434375: 1 - P = 1/(1 + x^E).
    let identified = one(&companion, Measure::Ttpf, Some(ObserverTask::Identify)).value("probability");
    near(Some(1.0 - identified.unwrap()), 1.0 / (1.0 + 3.90625f64.powf(5.434_375)), 1e-9);
    // 50 mK at 30 degC are 1.0746 times that at 295 K (another program's sum over 715 to 1250 cm^-1); shot noise is 4e-4 of it.
    let netd = one(&companion, Measure::Netd, None);
    near(netd.value("netd_k"), 53.73e-3, 1e-3);
    assert_eq!((netd.condition("blackbody_k"), netd.condition("frames")), (Some(295.0), Some(1.0)));
    // 6.4 cycles over 50 pixels of 12 um are 10.667 cycles/mm, 0.256 per mrad: the lens leaves 0.8578, the pixel 0.9732.
    let bars = one(&companion, Measure::Mrtd, Some(ObserverTask::Identify));
    near(bars.condition("frequency_cycles_per_mrad"), 0.256, 1e-12);
    near(bars.condition("finest_cycles_per_mrad"), 1.0, 1e-12);
    near(bars.condition("transfer"), 0.8348, 2e-3);
    near(bars.value("mrtd_k"), 2.25 * 53.73e-3 / 0.8348, 3e-3);
    // The bound of a pixel is the verdict's, that of fifty by fifty fifty times as far.
    let pair = &sizing.pairs[0];
    let pixel = one(&companion, Measure::Material, None);
    assert_eq!(pixel.value("statistical_distance"), pair.statistical_distance_nearest);
    assert_eq!(pixel.value("detection_probability"), pair.detection_probability);
    let all = one(&companion, Measure::MaterialOfAllPixels, None);
    near(all.value("statistical_distance"), 50.0 * pair.statistical_distance_nearest.unwrap(), 1e-12);
    near(all.condition("pixels"), 2500.0, 1e-12);
}

/// Everything at 20 degC, and nothing but that around: every material is a blackbody, whatever its shape.
#[test]
fn shape_and_material_are_different_questions() {
    let (warm, with_contrast) = size(SCENE);
    let text =
        SCENE.replace("37 degC", "20 degC").replace("[bands]", "[unknown]\nlighting_total = 1.0\n[bands]");
    let (still, without) = size(&text);
    assert!(warm.verdict.statistical_distance.unwrap() > 0.1, "{:?}", warm.verdict);
    assert_eq!(still.verdict.statistical_distance, Some(0.0));
    for (before, after) in with_contrast.rows.iter().zip(&without.rows) {
        match before.measure.kind() {
            Kind::Bound => {
                assert!(before.value("statistical_distance").unwrap() > 0.1);
                assert_eq!(after.value("statistical_distance"), Some(0.0));
                assert_eq!(after.value("detection_probability"), Some(0.5));
            }
            _ => assert_eq!(before, after),
        }
    }
}

#[test]
fn one_band_makes_no_difference_to_the_rest() {
    let (_, many) = size(SCENE);
    let bands = "ranges = [[\"900 cm^-1\", \"910 cm^-1\"]]";
    let study = study(&SCENE.replace("step = \"20 cm^-1\"", bands));
    assert_eq!(study.bands().len(), 1);
    let single = study.companion(&study.identify().unwrap().pairs[0], None).unwrap();
    // One band, two unknowns: nothing is told.
    assert_eq!(one(&single, Measure::Material, None).value("detection_probability"), Some(0.5));
    assert_eq!(many.rows.len(), single.rows.len());
    assert!(single.rows.iter().all(|row| row.unknown().is_none()), "{single:?}");
}

/// What nobody said is no number, and the reason is there.
#[test]
fn what_is_not_known_is_no_number() {
    let plain =
        SCENE.replace("size = \"0.5 m\"\n", "").replace("[background]\ntemperature = \"20 degC\"\n", "");
    let sizing = study(&plain).size().unwrap();
    assert!(sizing.companion.is_none());
    assert!(serde_json::to_value(&sizing).unwrap().get("companion").is_none());
    let reasons = |companion: &Companion| -> Vec<(Measure, Option<Unknown>)> {
        companion.rows.iter().map(|row| (row.measure, row.unknown())).collect()
    };
    let sizeless = study(&plain).companion(&sizing.pairs[0], None).unwrap();
    for (measure, unknown) in reasons(&sizeless) {
        let known = matches!(measure, Measure::Netd | Measure::Material);
        assert_eq!(unknown, (!known).then_some(Unknown::NoSize), "{measure:?}");
    }
    // A size beside the scenario, and then no distance.
    let sized = study(&plain).companion(&sizing.pairs[0], Some(0.5)).unwrap();
    near(one(&sized, Measure::PixelsOnTarget, None).value("pixels"), 50.0, 1e-12);
    let anywhere = study(&plain.replace("distance = \"20 m\"\n", ""));
    let found = anywhere.companion(&anywhere.identify().unwrap().pairs[0], Some(0.5)).unwrap();
    for (measure, unknown) in reasons(&found) {
        use Measure::{IndustryRange, JohnsonRange, Material, Netd};
        let known = matches!(measure, Netd | Material | JohnsonRange | IndustryRange);
        assert_eq!(unknown, (!known).then_some(Unknown::NoDistance), "{measure:?}");
    }
    let bands = Bands::from_rows([(1000.0, 10.0)]).unwrap();
    let told = Told { target: "a", alternative: "b", statistical_distance: 1.0, pixels: None };
    let nothing =
        Given { camera: None, bands: &bands, size_m: Some(1.0), distance_m: Some(1.0), told: Some(told) };
    let without = Companion::of(&nothing).unwrap();
    assert!(reasons(&without).iter().all(|(_, unknown)| *unknown == Some(Unknown::NoCamera)), "{without:?}");
    let json = serde_json::to_value(&without).unwrap();
    assert!(json["camera"].is_null() && json["rows"][0]["values"]["pixels"].is_null());
    // Nor is there a camera with a focal length of nothing, or a size of no length.
    let camera = anywhere.camera().unwrap();
    for (size_m, distance_m) in [(Some(-1.0), None), (Some(f64::NAN), None), (None, Some(0.0))] {
        let given = Given { camera: Some(camera), size_m, distance_m, ..nothing };
        assert!(Companion::of(&given).is_err());
    }
    for (size_m, distance_m) in [(1e308, 1.0), (1.0, 1e-308), (1e-300, 1e300)] {
        let given =
            Given { camera: Some(camera), size_m: Some(size_m), distance_m: Some(distance_m), ..nothing };
        let row = &Companion::of(&given).unwrap().rows[0];
        assert_eq!(row.unknown(), Some(Unknown::BeyondNumbers), "{size_m:e} {distance_m:e}");
    }
}

/// At 200 m five pixels are on it: 2.5 cycles fit, four do not, and bars that are not sampled have no MRTD.
#[test]
fn bars_finer_than_pixels_have_no_difference() {
    let (_, far) = size(&SCENE.replace("distance = \"20 m\"", "distance = \"200 m\""));
    let unknown = |companion: &Companion, task| one(companion, Measure::Mrtd, Some(task)).unknown();
    assert_eq!(unknown(&far, ObserverTask::Orient), None);
    assert_eq!(unknown(&far, ObserverTask::Recognise), Some(Unknown::FinerThanPixels));
    // f/3 at 10 um leaves nothing of what 12 um still sample.
    let slow = SCENE
        .replace("distance = \"20 m\"", "distance = \"112 m\"")
        .replace("f_number = 1.0", "f_number = 3.0");
    let (_, blurred) = size(&slow);
    assert_eq!(unknown(&blurred, ObserverTask::Recognise), Some(Unknown::FinerThanLens));
    // The probability of a shape has no such end.
    assert!(one(&blurred, Measure::Ttpf, Some(ObserverTask::Recognise)).value("probability").is_some());
}

/// 50 degrees over 320 pixels against 12 um behind 18 mm, as the paper has them; a lens with the usual distortion is no contradiction.
#[test]
fn two_angles_of_a_pixel_are_both_told() {
    let preset = SCENE.split("[camera]").next().unwrap().to_owned() + "[camera]\npreset = \"flir-a325sc\"\n";
    let (_, companion) = size(&preset);
    near(one(&companion, Measure::PixelsOnTarget, None).value("pixels"), 37.5, 1e-12);
    // 0.5 m at 20 m are 25 mrad, 0.8727 rad are 320 pixels.
    let row = one(&companion, Measure::PixelsByFieldOfView, None);
    near(row.value("pixels"), 9.167, 1e-4);
    assert_eq!(row.measure.caveat().code(), "field-of-view-differs");
    let (_, agrees) = size(&SCENE.replace("f_number", "field_of_view = \"18 deg\"\npixels = 640\nf_number"));
    assert_eq!(agrees.of_measure(Measure::PixelsByFieldOfView).count(), 0);
}

#[test]
fn the_json_says_kind_conditions_and_caveat_of_every_value() {
    let (_, companion) = size(SCENE);
    let json = serde_json::to_value(&companion).unwrap();
    for row in json["rows"].as_array().unwrap() {
        let kind = row["kind"].as_str().unwrap();
        assert!(["rule-of-thumb", "observer-model", "bound"].contains(&kind), "{row}");
        assert!(json["caveats"].get(row["caveat"].as_str().unwrap()).is_some(), "{row}");
        assert!(row["values"].as_object().unwrap().values().all(serde_json::Value::is_number), "{row}");
        assert!(!row["conditions"].as_object().unwrap().is_empty() && row["unknown"].is_null(), "{row}");
    }
    let first =
        |code: &str| json["rows"].as_array().unwrap().iter().find(|row| row["code"] == code).unwrap().clone();
    assert_eq!(first("johnson-range")["task"], "detect");
    assert_eq!(first("mrtd")["conditions"]["perception"], 2.25);
    assert_eq!(first("material")["conditions"]["alternative"], "aluminium");
}
