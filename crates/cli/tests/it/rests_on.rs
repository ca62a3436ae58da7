//! Inputs to which a 'yes' was said that rested on something nobody had stated, as a user types them.

use crate::support::folder::Folder;
use hadar_testing::shared;
use serde_json::Value;

fn path(folder: &str, name: &str) -> Option<String> {
    Some(shared(&format!("reference/cases/{folder}"))?.join(name).display().to_string())
}

fn codes(answer: &Value) -> Vec<&str> {
    let all = answer["verdict"]["conditions"].as_array().unwrap();
    all.iter().filter(|one| one["favourable"] == true).filter_map(|one| one["code"].as_str()).collect()
}

#[test]
fn a_verdict_names_what_it_rests_on() {
    let folder = Folder::with("");
    let Some(one_band) = path("verdict", "own_one_band_camera.toml") else { return };
    let own = folder.run(&["size", &one_band]).stdout;
    assert!(own.starts_with("No: the camera could distinguish") && own.contains("[readout] "), "{own}");

    let edge = path("verdict", "one_band_yes.toml").unwrap();
    let said = folder.run(&["size", &edge, "--check"]);
    assert_eq!(said.code, 3);
    assert!(
        said.stdout.starts_with("Yes, if no alternative is colder than 0.00 degC or warmer than 40.00 degC")
    );
    let wider = ["size", &edge, "--set", "alternatives.temperature=[\"0 degC\", \"60 degC\"]"];
    assert!(folder.run(&wider).stdout.starts_with("No: "));

    let pixel = folder.run(&["size", &path("verdict", "one_pixel_no.toml").unwrap()]).stdout;
    // d = 0.126 of a pixel, 2.45 of 378 of them: 99.3 %.
    assert!(
        pixel.contains("upper limit for one pixel 55.0 %; for all 378 pixels on it together 99.3 %"),
        "{pixel}"
    );

    // Frames do not average away the row and column noise of the camera's own sheet; of one without them they are assumed to.
    let floor = path("verdict", "frames_without_floor.toml").unwrap();
    let none = folder.run(&["size", &floor]).stdout;
    assert!(none.starts_with("No: ") && none.contains("no number of frames is enough"), "{none}");
    let quiet = ["--set", "camera.row_noise=\"0 mK\"", "--set", "camera.column_noise=\"0 mK\""];
    let frames = folder.json(&[&["size", &floor], quiet.as_slice()].concat());
    for code in ["flicker-fraction", "still-scene", "fixed-pattern"] {
        assert!(codes(&frames).contains(&code), "{code}");
    }

    let mwir = folder.run(&["size", &path("verdict", "own_mwir_camera.toml").unwrap()]);
    assert!(!mwir.stderr.contains("range of the detector"), "{}", mwir.stderr);
}

#[test]
fn a_rule_is_not_passed_on_the_ground_of_what_nobody_stated() {
    let folder = Folder::with("");
    let Some(flicker) = path("rule", "flicker_left_out.toml") else { return };
    let of = |name: &str| path("rule", name).unwrap();
    for (rule, more, said) in [
        (flicker, &[][..], "yes, if nothing moves for 4.99 s"),
        (of("patient_camera.toml"), &[], "yes, if its 40000000 frames can be registered (20000 s"),
        (
            of("set_over_law.toml"),
            &["--set", "requirement.detection_probability=0.6"],
            "yes, if requirement.detection_probability = 0.6 replaces the value of the rule",
        ),
    ] {
        let outcome = folder.run(&[&["rule", &rule, "--check"], more].concat());
        assert_eq!(outcome.code, 3, "{rule}");
        assert!(outcome.stdout.contains(said), "{rule}: {}", outcome.stdout);
        let written = folder.run(&[&["rule", &rule, "--out", "out", "--force", "-q"], more].concat());
        assert_eq!(written.code, 0, "{}", written.stderr);
        let statement = std::fs::read_to_string(folder.path().join("out/certificate.intoto.json")).unwrap();
        assert!(statement.contains("\"result\": \"WARNED\""), "{statement}");
    }
    let contradiction = folder.json(&["rule", &of("view_contradiction.toml")]);
    let blur = contradiction["clauses"][0]["cameras"][0]["motion_blur_pixels"].as_f64();
    let blur = blur.or(contradiction["cameras"][0]["motion_blur_pixels"].as_f64()).unwrap();
    assert!((blur / 2.3 - 1.0).abs() < 0.03, "{blur}");
}

/// Wherever `size` says no by its image, `identify` says yes under `[image]` alone; nothing else that a 'yes' of `size` rests on is missing.
#[test]
fn who_compares_distances_alone_says_so() {
    let scene = |exposure: &str, more: &str| {
        format!(
            "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\ndistance = \"10 m\"\n\
             [[environment]]\ntemperature = \"20 degC\"\nlighting = 0.5\n\
             [alternatives]\nmaterials = [\"concrete\"]\n[unknown]\nnuisances = [\"temperature\"]\n\
             [camera]\npreset = \"ideal-pnrd\"\nexposure = \"{exposure}\"\n{more}"
        )
    };
    let (mut spoiled, mut kept) = (0, 0);
    for exposure in ["10 us", "12 ms", "1 s"] {
        for more in [
            "",
            "[requirement]\nspeed = \"5 m/s\"\n",
            "full_well = 1e7\n",
            "frames = 3\n[requirement]\nspeed = \"5 m/s\"\ntime = \"2 s\"\n",
        ] {
            let folder = Folder::with(&scene(exposure, more));
            let size = folder.json(&["size", "a.toml"]);
            let identify = folder.json(&["identify", "a.toml"]);
            let check = folder.run(&["identify", "a.toml", "--check", "--json"]);
            assert_eq!(check.code, 3);
            let check: Value = serde_json::from_str(&check.stdout).unwrap();
            assert_eq!(identify["conditions"], check["conditions"], "{exposure} {more}");
            let list = identify["conditions"].as_array().unwrap();
            let said = |code: &str| list.iter().any(|one| one["code"] == code);
            let by_image = size["verdict"]["fails_by"].as_array().unwrap().iter().any(|by| by != "distance");
            assert_eq!(said("image"), by_image, "{exposure} {more}: {}", identify["conditions"]);
            spoiled += u32::from(by_image);
            if size["verdict"]["answer"] == "yes" {
                kept += 1;
                assert_eq!(size["verdict"]["conditions"], identify["conditions"], "{exposure} {more}");
            }
        }
    }
    assert!(spoiled > 2 && kept > 2, "{spoiled} {kept}");
}

/// A target that is told from nothing, among materials of which some are: what that rests on is listed, its range too.
#[test]
fn a_table_of_pairs_lists_what_its_yes_rests_on() {
    let scene = "[target]\nmaterial = \"marble\"\ntemperature = \"37 degC\"\n\
                 [alternatives]\nmaterials = [\"concrete\", \"pvc-tape\"]\nRANGE\n\
                 [bands]\nranges = [[\"750 cm^-1\", \"900 cm^-1\"], [\"900 cm^-1\", \"1050 cm^-1\"]]\n\
                 [unknown]\nnuisances = [\"temperature\"]\n[camera]\npreset = \"flir-a325sc\"\n";
    let of = |range: &str| {
        let folder = Folder::with(&scene.replace("RANGE", range));
        let answer = folder.json(&["identify", "a.toml", "--apart"]);
        let codes: Vec<String> = answer["conditions"]
            .as_array()
            .unwrap()
            .iter()
            .map(|one| one["code"].as_str().unwrap().to_owned())
            .collect();
        (answer["apart"]["told_apart"].as_array().unwrap().len(), codes)
    };
    let (told, codes) = of("");
    assert!(told == 1 && codes.contains(&"full-well".to_owned()), "{told} {codes:?}");
    assert!(!codes.contains(&"range".to_owned()), "{codes:?}");
    // At one temperature all of them differ.
    let (told, codes) = of("temperature = [\"36.9 degC\", \"37.1 degC\"]");
    assert!(told > 1 && codes.contains(&"range".to_owned()), "{told} {codes:?}");
}

/// The parts of a scene, each of which may be left out or be another.
const PARTS: [[&str; 2]; 5] = [
    [
        "[[environment]]\ntemperature = \"10 degC\"\nlighting = 0.5\n",
        "[[environment]]\ntemperature = \"10 degC\"\nlighting = 1.0\n",
    ],
    ["[atmosphere]\nmodel = \"us-standard\"\n", ""],
    [
        "[unknown]\nnuisances = [\"temperature\", \"lighting\", \"gain\"]\n",
        "[unknown]\nnuisances = [\"temperature\"]\n",
    ],
    [
        "materials = [\"aluminium\", \"polycarbonate\"]\n",
        "materials = [\"aluminium\", \"polycarbonate\"]\ntemperature = [\"25 degC\", \"40 degC\"]\n",
    ],
    ["f_number = 1.0\nfull_well = 1e12\nflicker_fraction = 0.0\n", "f_number = 2.0\n"],
];

fn scene(which: usize, demand: f64, own: &str) -> String {
    let part = |index: usize| PARTS[index][which >> index & 1];
    format!(
        "{own}[target]\nmaterial = \"skin\"\ntemperature = \"33 degC\"\ndistance = \"8 m\"\n{}{}{}\
         [bands]\nranges = [[\"8 um\", \"9 um\"], [\"9 um\", \"10 um\"], [\"10 um\", \"11 um\"], [\"11 um\", \"12 um\"], [\"12 um\", \"13 um\"]]\n\
         [alternatives]\n{}[requirement]\ndistance = {demand}\n[CAMERA]\nframes = 60\n{}",
        part(0),
        part(1),
        part(2),
        part(3),
        part(4)
    )
}

/// Whatever a scene leaves open: a rule of this one scene rests on what `size` rests on in it, and a temperature measured in it on the scene too.
#[test]
fn a_rule_of_one_scene_rests_on_what_its_camera_does_in_it() {
    let sorted = |list: &Value| {
        let mut codes: Vec<String> = list
            .as_array()
            .unwrap()
            .iter()
            .filter(|one| one["favourable"] == true)
            .map(|one| one["code"].as_str().unwrap().to_owned())
            .collect();
        codes.sort();
        codes
    };
    let (mut yes, mut ranges, mut of_objects) = (0, 0, 0);
    for which in (0..32).chain((32..64).step_by(3)) {
        for demand in [2.0, 20.0] {
            let camera = "[camera]\npreset = \"flir-boson-plus-640\"\nfocal_length = \"14 mm\"\nfield_of_view = \"32 deg\"";
            let scene = match which < 32 {
                true => scene(which, demand, ""),
                false => scene(which, demand, "")
                    .replace(
                        "\n[[environment]]",
                        "\nsize = \"0.5 m\"\n[background]\ntemperature = \"5 degC\"\n[[environment]]",
                    )
                    .replace("[requirement]", "[requirement]\nof = \"object\""),
            };
            let folder = Folder::with(&scene.replace("[CAMERA]", camera));
            let size = folder.json(&["size", "a.toml"]);
            let rule = scene.replace("[CAMERA]", &camera.replace("[camera]", "[[camera]]\nname = \"b\""));
            folder.file("r.toml", &format!("{rule}[envelope]\ndistance = [\"8 m\", \"8 m\"]\n"));
            let rule = folder.run(&["rule", "r.toml", "--check", "--json"]);
            let rule: Value = serde_json::from_str(&rule.stdout).unwrap();
            let verdict = &rule["cameras"][0];
            if size["verdict"]["answer"] != "yes" || verdict["passes"] != true {
                continue;
            }
            yes += 1;
            let codes = sorted(&verdict["conditions"]);
            ranges += u32::from(codes.contains(&"range".to_owned()));
            of_objects += u32::from(codes.contains(&"shared-emissivity-errors".to_owned()));
            assert_eq!(codes, sorted(&size["verdict"]["conditions"]), "{which} {demand}");
        }
    }
    assert!(yes > 20 && ranges > 0 && of_objects > 5, "{yes} {ranges} {of_objects}");
}

/// A temperature and pixels on the target rest on scene and lens as well, and a table of chosen columns keeps what its verdicts rest on.
#[test]
fn what_is_measured_rests_on_scene_and_lens() {
    let folder = Folder::with(&scene(4, 2.0, "").replace(
        "[CAMERA]",
        "[camera]\npreset = \"flir-boson-plus-640\"\nfocal_length = \"14 mm\"\nfield_of_view = \"32 deg\"",
    ));
    let rule = "[target]\nmaterial = \"skin\"\ntemperature = \"33 degC\"\n\
        [[environment]]\ntemperature = \"20 degC\"\nlighting = 0.7\n[alternatives]\nmaterials = [\"fabric\"]\n\
        [bands]\nranges = [[\"8 um\", \"13 um\"]]\nUNKNOWN[envelope]\nlighting = [0.2, 0.7]\ndistance = [\"1 m\", \"2 m\"]\n\
        [[clause]]\nname = \"t\"\nkind = \"temperature-error\"\n[clause.requirement]\ntemperature_error = \"5 K\"\n\
        [[clause]]\nname = \"p\"\nkind = \"resolution\"\n[clause.requirement]\npixels = 2\nsize = \"0.5 m\"\n\
        [[camera]]\nname = \"b\"\npreset = \"flir-boson-plus-640\"\nf_number = 1.0\nfocal_length = \"14 mm\"\nfield_of_view = \"32 deg\"\n\
        full_well = 1e12\nflicker_fraction = 0.0\n";
    let of = |unknown: &str| {
        folder.file("r.toml", &rule.replace("UNKNOWN", unknown));
        let answer = folder.json(&["rule", "r.toml"]);
        let clauses = answer["clauses"].as_array().unwrap();
        let codes = |index: usize| -> Vec<(String, Value)> {
            let list = clauses[index]["cameras"][0]["conditions"].as_array().unwrap();
            list.iter().map(|one| (one["code"].as_str().unwrap().to_owned(), one["value"].clone())).collect()
        };
        (codes(0), codes(1))
    };
    let has = |codes: &[(String, Value)], code: &str| codes.iter().any(|one| one.0 == code);
    let (temperature, pixels) = of("[unknown]\nnuisances = [\"temperature\"]\n");
    for code in ["no-air", "fills-pixel", "calibrated", "surroundings-known", "emissivity-known", "dark-rest"]
    {
        assert!(has(&temperature, code), "{code}: {temperature:?}");
    }
    // The darkest scene of the envelope leaves 80 %.
    let dark = temperature.iter().find(|one| one.0 == "dark-rest").unwrap();
    assert!((dark.1.as_f64().unwrap() - 0.8).abs() < 1e-12, "{dark:?}");
    assert!(has(&pixels, "diffraction"), "{pixels:?}");
    let (temperature, _) = of("[unknown]\nnuisances = [\"temperature\", \"gain\"]\n");
    assert!(!has(&temperature, "calibrated") || temperature.is_empty(), "{temperature:?}");

    let sweep =
        ["sweep", "a.toml", "--vary", "target.distance=8 m,9 m", "--columns", "verdict.met", "--out", "rows"];
    assert_eq!(folder.run(&sweep).code, 0);
    let table = std::fs::read_to_string(folder.path().join("rows/sweep.csv")).unwrap();
    assert!(table.lines().next().unwrap().ends_with("verdict.met,verdict.conditions"), "{table}");
    assert!(table.contains("still-scene"), "{table}");
}

/// A time below one exposure is no demand but a mistake, told by its key.
#[test]
fn a_time_below_one_exposure_is_refused() {
    let camera =
        "[camera]\npreset = \"flir-boson-plus-640\"\nfocal_length = \"14 mm\"\nfield_of_view = \"32 deg\"";
    let folder = Folder::with(&scene(4, 2.0, "").replace("[CAMERA]", camera));
    let exposure_s = folder.json(&["size", "a.toml"])["camera"]["exposure_s"].as_f64().unwrap();
    let with = |share: f64| format!("requirement.time=\"{} ms\"", 1e3 * share * exposure_s);
    for command in ["size", "identify"] {
        let said = folder.refusal(&[command, "a.toml", "--set", &with(0.99)]);
        assert!(
            said.contains("requirement.time: a decision after ") && said.contains("one exposure of"),
            "{said}"
        );
        assert_eq!(folder.run(&[command, "a.toml", "--set", &with(1.01)]).code, 0);
    }
}
