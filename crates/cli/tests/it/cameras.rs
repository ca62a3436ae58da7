//! Known cameras listed, shown and compared.

use crate::support::answers::{close, number};
use crate::support::folder::{Folder, SCENARIO};
use hadar::instrument::presets;
use hadar::planck::photon_radiance;

#[test]
fn all_cameras_are_listed_in_a_line_and_can_be_shown() {
    let folder = Folder::with(SCENARIO);
    let all = presets::all().unwrap();
    let text = folder.run(&["cameras", "list"]).stdout;
    assert!(text.starts_with(&format!("{} cameras, ", all.len())), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 110));
    for preset in all {
        assert_eq!(text.lines().filter(|line| line.starts_with(&format!("{} ", preset.name))).count(), 1);
        let shown = folder.json(&["cameras", "show", &preset.name]);
        let missing = shown["missing"].as_array().unwrap();
        assert_eq!(missing.is_empty(), preset.camera().is_ok(), "{}", preset.name);
        for key in ["equivalents", "noise_budget"] {
            assert_eq!(shown[key].is_null(), !missing.is_empty(), "{} {key}", preset.name);
        }
        // What is asked for is enough.
        if let Err(asked) = preset.camera() {
            assert!(missing.iter().map(|one| &one["key"]).eq(&asked.0), "{missing:?}");
        }
    }
    let list = folder.json(&["cameras", "list"]);
    let listed = list["cameras"].as_array().unwrap();
    assert_eq!(listed.len(), all.len());
    let of = |name: &str| listed.iter().find(|camera| camera["name"] == name).unwrap();
    assert_eq!(of("flir-a325sc")["pixel_m"], 12e-6);
    assert!(of("hadar-prototype-2")["exposure_s"].is_null());
}

/// The sum of the budget is the variance that the figures give for a band.
#[test]
fn the_json_of_show_and_compare() {
    let folder = Folder::with(SCENARIO);
    let shown = folder.json(&["cameras", "show", "flir-a325sc"]);
    let lines = shown["noise_budget"].as_array().unwrap();
    let sum: f64 = lines.iter().map(|line| number(&line["var_counts"])).sum();
    let sigma = number(&shown["equivalents"]["sigma_counts"]);
    let mean = (715..=1250).map(|nu| photon_radiance(f64::from(nu), 300.0)).sum::<f64>() / 536.0;
    let shot = mean * number(&shown["etendue_m2_sr"]) * 0.99 * 12e-3;
    assert!((sum / (sigma * sigma + shot) - 1.0).abs() < 1e-12);
    close("diffraction", number(&shown["diffraction_pixels"]), 13.0 / 12.0, 1e-13);
    let both = folder.json(&["cameras", "compare", "flir-a325sc", "nicolet-is50"]);
    let keys: Vec<&String> = both.as_object().unwrap().keys().collect();
    assert_eq!(
        keys,
        [
            "a",
            "b",
            "caveats",
            "common_range_cm1",
            "hadar",
            "lens_of_both",
            "ratios",
            "scene_temperature_k",
            "schema",
            "sentence",
            "stats"
        ]
    );
    for (key, ratio) in both["ratios"].as_object().unwrap() {
        let (a, b) = (&both["a"], &both["b"]);
        let Some((a, b)) = a[key].as_f64().zip(b[key].as_f64()).filter(|_| !key.starts_with("noise")) else {
            continue;
        };
        if key != "photons" {
            assert!((number(ratio) / (b / a) - 1.0).abs() < 1e-14, "{key}");
        }
    }
    assert_eq!(number(&both["stats"]["cameras"]["computed"]), 2.0);
    let itself = folder.json(&["cameras", "compare", "flir-a325sc", "flir-a325sc"]);
    assert!(itself["ratios"].as_object().unwrap().values().all(|ratio| ratio == 1.0));
    assert_eq!(number(&itself["stats"]["cameras"]["computed"]), 1.0);
    let unknown = folder.json(&["cameras", "compare", "flir-a325sc", "hadar-prototype-2"]);
    assert!(unknown["ratios"]["distance"].is_null() && unknown["common_range_cm1"].is_null());
    close("pixels", number(&unknown["ratios"]["pixel_m"]), 40.0 / 12.0, 1e-13);
}

#[test]
fn unknown_names_are_answered_with_the_nearest() {
    let folder = Folder::with(SCENARIO);
    for arguments in [
        ["cameras", "show", "flir-a325"].as_slice(),
        &["cameras", "compare", "flir-a325", "nicolet-is50"],
        &["cameras", "compare", "nicolet-is50", "flir-a325"],
    ] {
        let outcome = folder.run(arguments);
        assert_eq!((outcome.code, outcome.stdout.as_str()), (1, ""));
        assert!(
            outcome.stderr.contains("`flir-a325sc`") && outcome.stderr.lines().count() == 1,
            "{}",
            outcome.stderr
        );
    }
}

#[test]
fn cameras_in_words() {
    let folder = Folder::with(SCENARIO);
    for (name, arguments) in [
        ("list", ["list"].as_slice()),
        ("show_flir_a325sc", &["show", "flir-a325sc"]),
        ("show_hadar_prototype_2", &["show", "hadar-prototype-2"]),
        ("show_flir_a325sc_25um", &["show", "flir-a325sc-25um"]),
        ("compare_bolometer_mct", &["compare", "flir-a325sc", "nicolet-is50"]),
        ("compare_bolometer_ideal", &["compare", "flir-a325sc", "ideal-pnrd"]),
        ("compare_incomplete", &["compare", "flir-a325sc", "flir-a655sc"]),
    ] {
        let outcome = folder.run(&[&["cameras"], arguments].concat());
        assert_eq!((outcome.code, outcome.stderr.as_str()), (0, ""));
        insta::assert_snapshot!(name, outcome.stdout);
    }
}
