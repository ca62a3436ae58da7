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
    assert!(own.starts_with("No: the camera could tell") && own.contains("[readout] "), "{own}");

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
        pixel.contains("a pixel reaches 55.0 % at most; all 378 pixels on it together 99.3 %"),
        "{pixel}"
    );

    let frames = folder.json(&["size", &path("verdict", "frames_without_floor.toml").unwrap()]);
    assert!(codes(&frames).contains(&"flicker-fraction") && codes(&frames).contains(&"still-scene"));

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
            "yes, if the rule said requirement.detection_probability = 0.6, which it does not",
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
