//! The command line as a program sees it: exit codes, JSON, files, text.

use crate::support::folder::{Folder, SCENARIO};
use serde_json::Value;
use std::fs;

#[track_caller]
fn keys(value: &Value, expected: &[&str]) {
    let object = value.as_object().unwrap_or_else(|| panic!("not an object: {value}"));
    for key in expected {
        assert!(object.contains_key(*key), "`{key}` is missing among {:?}", object.keys());
    }
}

const PAIR_KEYS: [&str; 20] = [
    "target",
    "alternative",
    "distance_local",
    "distance_local_unknown_gain",
    "distance_nearest",
    "nearest_state",
    "distance_return",
    "photons_required",
    "statistical_distance",
    "detection_probability",
    "miss_probability",
    "information_bits",
    "condition_number",
    "relative_error",
    "relative_error_unknown_gain",
    "relative_error_no_nuisance",
    "status",
    "blind_direction",
    "two_sided_probability",
    "error_bracket",
];

#[test]
fn json_of_size_and_identify_is_one_object_with_the_agreed_keys() {
    let folder = Folder::with(SCENARIO);
    let size = folder.json(&["size", "a.toml"]);
    keys(
        &size,
        &[
            "verdict",
            "requirement",
            "camera",
            "solve_for",
            "sensitivity",
            "trade_offs",
            "warnings",
            "scenario",
            "pairs",
            "limiting",
            "photon_radiance",
        ],
    );
    keys(&size["verdict"], &["met", "sentence", "statistical_distance", "required_distance", "margin"]);
    keys(&size["requirement"], &["by", "distance", "detection_probability", "photons", "hardware_m2_s"]);
    keys(
        &size["solve_for"],
        &["exposure_s", "pixel_m", "f_number", "noise_counts", "frames", "distance_m", "speed_m_s"],
    );
    keys(
        &size["sensitivity"]["elasticities"],
        &["exposure", "pixel", "f_number", "noise", "frames", "optics_efficiency", "distance"],
    );
    keys(
        &size["sensitivity"]["emissivity"],
        &[
            "error",
            "correlation_cm1",
            "distance_5",
            "distance_50",
            "distance_95",
            "share_met",
            "sigma_linear",
        ],
    );
    keys(&size["trade_offs"][0], &["x", "y", "camera", "points", "limits"]);
    keys(
        &size["camera"],
        &["photons", "gamma_per_band", "hardware_m2_s", "noise_counts", "least_distance", "noise_budget"],
    );
    assert_eq!(size["verdict"]["met"], Value::Bool(false));
    let identify = folder.json(&["identify", "a.toml"]);
    keys(&identify, &["scenario", "photon_radiance", "pairs", "limiting", "warnings"]);
    for result in [&size, &identify] {
        let pair = &result["pairs"][0];
        keys(pair, &PAIR_KEYS);
        keys(&pair["nearest_state"], &["temperature_k", "lighting", "gain"]);
        assert_eq!((pair["status"].as_str(), pair["target"].as_str()), (Some("ok"), Some("skin")));
        assert_eq!(result["limiting"], "aluminium");
        for warning in result["warnings"].as_array().unwrap() {
            keys(warning, &["code", "message"]);
        }
        // Half of the light all around, the default bands but for their step.
        assert_eq!(result["scenario"]["environment"][0]["lighting"], 0.5);
    }
    assert_eq!(size["pairs"], identify["pairs"]);
    let without = Folder::with(&SCENARIO.replace("[camera]\npreset = \"flir-a325sc\"\n", ""));
    let size = without.json(&["size", "a.toml"]);
    assert!(size["camera"].is_null() && size["solve_for"].is_null() && size["verdict"]["met"].is_null());
    assert!(size["pairs"][0]["statistical_distance"].is_null());
    assert!(size["requirement"]["photons"].as_f64().unwrap() > 1e5);
}

#[test]
fn check_tells_scripts_whether_the_requirement_is_met() {
    let folder = Folder::with(SCENARIO);
    folder.file("easy.toml", &SCENARIO.replace("flir-a325sc", "ideal-pnrd"));
    for (arguments, code) in [
        (["size", "a.toml"].as_slice(), 0),
        (&["size", "a.toml", "--check"], 3),
        (&["size", "a.toml", "--check", "--json"], 3),
        (&["size", "easy.toml", "--check"], 0),
        (&["size", "easy.toml", "--check", "--by", "local-unknown-gain"], 3),
    ] {
        let outcome =
            if arguments.contains(&"--check") { folder.accepting(arguments) } else { folder.run(arguments) };
        assert_eq!(outcome.code, code, "{arguments:?}");
        assert!(!outcome.stdout.is_empty());
    }
    // A 'yes' under conditions that nobody accepted is none that a script may rely on; one that does not exist is refused.
    assert_eq!(folder.run(&["size", "easy.toml", "--check"]).code, 3);
    let most: Vec<String> =
        hadar_study::Condition::codes().into_iter().filter(|code| code != "still-scene").collect();
    assert_eq!(folder.run(&["size", "easy.toml", "--check", "--accept", &most.join(",")]).code, 3);
    let unknown = folder.run(&["size", "easy.toml", "--check", "--accept", "still-scen"]);
    assert!(unknown.code == 2 && unknown.stderr.contains("`still-scene`"), "{}", unknown.stderr);
}

/// Every number of the second answer is that of the first, to the last bit or one.
#[track_caller]
fn same_numbers(a: &Value, b: &Value, path: &str) {
    match (a, b) {
        (Value::Object(x), Value::Object(y)) => {
            assert_eq!(x.keys().collect::<Vec<_>>(), y.keys().collect::<Vec<_>>(), "{path}");
            x.iter().for_each(|(key, value)| same_numbers(value, &y[key], &format!("{path}.{key}")));
        }
        (Value::Array(x), Value::Array(y)) => {
            assert_eq!(x.len(), y.len(), "{path}");
            x.iter().zip(y).for_each(|(x, y)| same_numbers(x, y, path));
        }
        (Value::Number(x), Value::Number(y)) => {
            let (x, y) = (x.as_f64().unwrap(), y.as_f64().unwrap());
            assert!((x - y).abs() <= 4.0 * f64::EPSILON * x.abs(), "{path}: {x:e} {y:e}");
        }
        _ => assert_eq!(a, b, "{path}"),
    }
}

#[test]
fn the_report_is_complete_and_its_scenario_gives_it_again() {
    for scenario in [
        SCENARIO.to_owned(),
        SCENARIO.replace("\"skin\"", "\"sub/my.csv\"").replace("step = \"5 cm^-1\"", "rows = \"sub/rows.csv\""),
        SCENARIO.replace("[camera]", "[unknown]\nnuisances = [\"lighting\"]\npriors = { lighting = 0.2 }\n[camera]\nframes = 3\npixel = \"20 um\""),
    ] {
        let folder = Folder::with(&scenario);
        fs::create_dir(folder.path().join("sub")).unwrap();
        folder.file("sub/my.csv", "wavelength_um,reflectance\n7,0.02\n10,0.1\n15,0.05\n");
        folder.file("sub/rows.csv", "wavenumber_cm1\n750\n800\n900\n1000\n1100\n1200\n");
        let first = folder.json(&["size", "a.toml", "--out", "deep/report"]);
        let report = folder.path().join("deep/report");
        for name in ["scenario.toml", "pairs.csv", "requirement.csv", "solve_for.csv", "noise_budget.csv", "warnings.csv"] {
            assert!(fs::metadata(report.join(name)).unwrap().len() > 10, "{name}");
        }
        for name in ["emissivities", "incident_spectra", "identifiability", "required_photons"] {
            let table = fs::read_to_string(report.join(format!("{name}.csv"))).unwrap();
            assert!(table.lines().count() > 5, "{name}.csv");
            let svg = fs::read_to_string(report.join(format!("{name}.svg"))).unwrap();
            assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"), "{name}.svg");
            assert!(fs::read(report.join(format!("{name}.png"))).unwrap().starts_with(b"\x89PNG"), "{name}.png");
        }
        let leftovers: Vec<String> = folder.files().into_iter().filter(|name| name.contains(".tmp")).collect();
        assert!(leftovers.is_empty(), "{leftovers:?}");
        let again = folder.json(&["size", "deep/report/scenario.toml"]);
        for key in ["verdict", "requirement", "camera", "solve_for", "sensitivity", "pairs", "photon_radiance"] {
            same_numbers(&first[key], &again[key], key);
        }
    }
}

#[test]
fn the_headers_of_the_tables_carry_units() {
    let folder = Folder::with(SCENARIO);
    assert_eq!(folder.run(&["size", "a.toml", "--out", "report"]).code, 0);
    let header = |name: &str| {
        let text = fs::read_to_string(folder.path().join("report").join(name)).unwrap();
        text.lines().next().unwrap().to_owned()
    };
    assert!(header("requirement.csv").contains("hardware_m2_s"));
    assert!(header("pairs.csv").contains("nearest_temperature_k"));
    assert!(header("noise_budget.csv").contains("variance_counts2"));
    assert!(header("emissivities.csv").starts_with("wavenumber_cm1"));
}

#[test]
fn the_number_of_threads_changes_no_byte() {
    let scenario = SCENARIO.replace("[alternatives]\nmaterials = [\"aluminium\"]\n", "");
    let folder = Folder::with(&scenario);
    let one = folder.run(&["size", "a.toml", "--json", "--threads", "1", "--out", "one"]);
    let two = folder.run(&["size", "a.toml", "--json", "--threads", "2", "--out", "two"]);
    assert_eq!((one.code, two.code), (0, 0), "{}", one.stderr);
    assert!(one.stdout == two.stdout, "the JSON differs");
    let names: Vec<_> =
        fs::read_dir(folder.path().join("one")).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert!(names.len() >= 15, "{names:?}");
    for name in names {
        let read = |of: &str| fs::read(folder.path().join(of).join(&name)).unwrap();
        assert!(read("one") == read("two"), "{name:?} differs");
    }
}

#[test]
fn quiet_is_quiet() {
    let folder = Folder::with(SCENARIO);
    folder.file("skin.csv", "wavenumber_cm1,emissivity\n600,0.9\n1400,0.9\n");
    let arguments = ["size", "a.toml", "--out", "report", "--library", "skin.csv"];
    let loud = folder.run(&arguments);
    assert!(
        loud.stderr.contains(" files to report/") && loud.stderr.contains("`skin` is replaced"),
        "{}",
        loud.stderr
    );
    let quiet = folder.run(&[&arguments[..], &["-q"]].concat());
    assert_eq!((quiet.code, quiet.stderr.as_str()), (0, ""));
    assert_eq!(quiet.stdout, loud.stdout);
    // An error is said all the same.
    assert_eq!(folder.run(&["size", "none.toml", "-q"]).stderr.lines().count(), 1);
}

/// The figures that the issue asks for, with its digits.
#[test]
fn cameras_show_their_figures() {
    let folder = Folder::with(SCENARIO);
    let camera = folder.json(&["cameras", "show", "flir-a325sc"]);
    let number = |key: &str| camera[key].as_f64().unwrap_or_else(|| panic!("{key}: {}", camera[key]));
    assert_eq!(format!("{:.2e}", number("photons")), "2.51e9");
    assert_eq!(format!("{:.2e}", number("noise_counts")), "1.77e6");
    assert!((number("gamma_per_band") / 6.6e5 - 1.0).abs() < 0.02);
    assert_eq!(format!("{:.2e}", number("hardware_m2_s")), "1.53e-18");
    assert_eq!((number("reference_temperature_k"), number("bands")), (303.15, 536.0));
    let notes = camera["provenance"].as_array().unwrap();
    assert!(notes.iter().any(|note| note.as_str().unwrap().contains("8.16e-18")), "{notes:?}");
    let list = folder.json(&["cameras", "list"]);
    let names: Vec<&str> =
        list["cameras"].as_array().unwrap().iter().map(|c| c["name"].as_str().unwrap()).collect();
    assert_eq!(names[..4], ["flir-a325sc", "nicolet-is50", "ideal-pnrd", "hadar-prototype-2"]);
    let text = folder.run(&["cameras", "show", "flir-a325sc"]).stdout;
    assert!(text.contains("2.51e9") && text.contains("12.0 um") && text.contains("Table S2"), "{text}");
}

#[test]
fn materials_are_listed_shown_drawn_and_imported() {
    let folder = Folder::with(SCENARIO);
    let list = folder.json(&["materials", "list"]);
    let all = list["materials"].as_array().unwrap();
    assert!(all.len() >= 30, "{}", all.len());
    assert!(folder.run(&["materials", "list"]).stdout.lines().count() > all.len());
    let shown = folder.json(&["materials", "show", "aluminium"]);
    keys(&shown, &["name", "wavenumber_cm1", "emissivity"]);
    let at = shown["wavenumber_cm1"].as_array().unwrap().iter().position(|nu| nu == 985.0).unwrap();
    assert_eq!(shown["emissivity"][at], 0.49287);
    assert!(folder.run(&["materials", "show", "aluminium"]).stdout.contains("source"));
    let drawn = folder.run(&["materials", "plot", "skin", "aluminium", "--out", "drawn"]);
    assert_eq!(drawn.code, 0, "{}", drawn.stderr);
    // The picture in three forms, answer, page and manifest.
    assert_eq!(fs::read_dir(folder.path().join("drawn")).unwrap().count(), 6);
    // In and out again: the same values, now as emissivity over wavenumber.
    folder.file("paint.csv", "wavelength_um,reflectance\n8,0.25\n10,0.125\n12.5,0.5\n");
    let imported = folder.json(&["materials", "import", "paint.csv", "--out", "mine"]);
    assert_eq!(imported["materials"][0]["name"], "paint");
    let text = fs::read_to_string(folder.path().join("mine/paint.csv")).unwrap();
    let rows: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    assert_eq!(rows, ["wavenumber_cm1,emissivity", "800,0.5", "1000,0.875", "1250,0.75"]);
    let used = Folder::with(
        &SCENARIO.replace("\"skin\"", "\"paint\"").replace("step = \"5 cm^-1\"", "start = \"800 cm^-1\""),
    );
    let mine = folder.path().join("mine").display().to_string();
    assert_eq!(used.json(&["size", "a.toml", "--library", &mine])["pairs"][0]["target"], "paint");
}

#[test]
fn an_ecostress_file_is_imported_and_used() {
    let name = "ecostress/manmade.concrete.pavingconcrete.solid.all.0092uuu_cnc.jhu.becknic.spectrum.txt";
    let Some(file) = hadar_testing::shared(name) else { return };
    let folder = Folder::with(&SCENARIO.replace("\"skin\"", &format!("{:?}", file.display().to_string())));
    let path = file.display().to_string();
    let imported = folder.json(&["materials", "import", &path, "--out", "mine"]);
    let name = imported["materials"][0]["name"].as_str().unwrap().to_owned();
    assert!(folder.path().join(format!("mine/{name}.csv")).is_file());
    let direct = folder.json(&["identify", "a.toml"]);
    let through = Folder::with(&SCENARIO.replace("\"skin\"", &format!("{name:?}")));
    let mine = folder.path().join("mine").display().to_string();
    let imported = through.json(&["identify", "a.toml", "--library", &mine]);
    let distance = |result: &Value| result["pairs"][0]["distance_nearest"].as_f64().unwrap();
    // 10⁴/λ printed and read again, and the reflectance subtracted from 1: a rounding each.
    assert!((distance(&direct) / distance(&imported) - 1.0).abs() < 1e-9);
}

/// The whole text, so that a change of it is seen; three digits are the same on every machine.
#[test]
fn the_example_in_words() {
    let folder = Folder::with(SCENARIO);
    let example = hadar_testing::repository().join("examples/human_vs_robot.toml");
    let outcome = folder.run(&["size", &example.display().to_string()]);
    assert_eq!((outcome.code, outcome.stderr.as_str()), (0, ""));
    insta::assert_snapshot!("size_human_vs_robot", outcome.stdout);
}
