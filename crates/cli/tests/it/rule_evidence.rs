//! What a rule is evidence of: who crosses, on which day, by which rule; reforms beside it; limits and shared errors of figures.

use crate::support::folder::Folder;
use crate::support::rules::{NIGHT, answered, close, library, only};
use hadar_scenario::rule::Verdict;
use hadar_scenario::{Rule, Written};
use hadar_study::{Condition, FiguresMoved, Outcome, Reforms, RuleAsked, RuleStudy};
use serde_json::{Value, json};
use std::fs;

/// Who is told apart by far, before a camera of which everything is stated.
fn easy(stop: &str, camera: &str) -> String {
    NIGHT.replace("cameras = [\"flir-a325sc\"]\n", "").replace("latency = ", &format!("{stop}latency = "))
        + &format!("[[camera]]\npreset = \"ideal-pnrd\"\nexposure = \"1 ms\"\n{camera}")
}

/// 8 km/h across a pixel of 12 µm behind 18 mm at 36.1 m in 1 ms is 0.092 pixels more; the view is half of it either side.
#[test]
fn who_crosses_blurs_more_and_must_be_in_the_view() {
    let still = only(&easy("", ""));
    assert!(still.conditions.iter().any(|one| matches!(one, Condition::NobodyCrosses)));
    let camera = "focal_length = \"18 mm\"\npixel = \"12 um\"\nfield_of_view = \"25 deg\"\npixels = 655\n";
    let at = |speed: &str| only(&easy(&format!("crossing_speed = \"{speed}\"\noffset = \"0 m\"\n"), camera));
    let (stands, crosses) = (at("0 km/h"), at("8 km/h"));
    let sweep_s = crosses.sweep_s;
    // Straight ahead nothing moves; of 8 km/h at tan θ = 8/60 the part of 60 km/h along θ, and all of 8 km/h.
    assert!(stands.motion_blur_pixels.unwrap() < 1e-9);
    let theta = (8.0f64 / 60.0).atan();
    let pixels = (60.0 / 3.6 * theta.sin() + 8.0 / 3.6) * sweep_s / (325.0 / 9.0 * 12e-6 / 18e-3);
    assert!(close(crosses.motion_blur_pixels.unwrap(), pixels, 2e-3), "{crosses:?} {pixels}");
    assert!(!crosses.fails_by.iter().any(|by| by.code() == "out-of-view"));
    assert!(!crosses.conditions.iter().any(|one| matches!(one, Condition::NobodyCrosses)));
    // 8 km/h across 20 km/h is 21.8° beside the axis, beyond 12.5°.
    let slow = only(
        &easy("crossing_speed = \"8 km/h\"\noffset = \"0 m\"\n", camera)
            .replace("\"60 km/h\"", "[\"20 km/h\", \"60 km/h\"]"),
    );
    assert!(slow.fails_by.iter().any(|by| by.code() == "out-of-view") && slow.verdict == Verdict::Fails);
    let from = slow.approach.unwrap().in_view_from_m_s.unwrap().unwrap();
    // The narrower of 12.5° and what the lens shows of 655 pixels, tan θ = 655 · 12 µm/(2 · 18 mm).
    assert!(close(from, 8.0 / 3.6 / (0.5 * 655.0 * 12e-6 / 18e-3), 1e-6), "{}", from * 3.6);
    // Of a camera of which nobody says what it sees that is a condition.
    let blind = only(
        &easy("crossing_speed = \"8 km/h\"\n", "focal_length = \"18 mm\"\npixel = \"12 um\"\n")
            .replace("preset = \"ideal-pnrd\"\n", OWN),
    );
    assert!(
        blind.conditions.iter().any(|one| matches!(one, Condition::InView { .. }))
            || blind.verdict != Verdict::Meets
    );
    let folder = Folder::with(&easy("offset = \"1 m\"\n", ""));
    assert!(folder.refusal(&["rule", "a.toml"]).contains("where a target crosses, and not how fast"));
    let backwards = Folder::with(&easy("crossing_speed = \"-5 km/h\"\n", ""));
    assert!(backwards.refusal(&["rule", "a.toml"]).contains("crossing_speed"));
}

const OWN: &str = "f_number = 1.0\nnoise_electrons = 0\noptics_efficiency = 1.0\nquantum_efficiency = 1.0\n";

/// The same with a word on where its figures are from, those of the camera too.
fn sourced(text: &str) -> String {
    let law = "\"target\", \"environment\", \"alternatives\", \"bands\", \"envelope\", \"stop\"";
    format!("{text}[[source]]\nkeys = [{law}, \"camera[0]\"]\nchoice = \"a test\"\n")
}

/// Passed is only what is proved and unconditional, on a stated day on which the rule as it is written holds.
#[test]
fn a_rule_is_passed_on_a_stated_day_alone() {
    let own = easy("", "").replacen("[target]", "[rule]\nname = \"R\"\nfrom = 2026-01-01\n[target]", 1);
    let text = sourced(&own);
    let rule = |set: &[&str]| {
        let set = set.iter().map(|one| hadar_scenario::Setting::parse(one, "--set").unwrap());
        Rule::from_written(&Written::of(&text, None).with(set)).unwrap()
    };
    let outcome = |set: &[&str], on: Option<&str>, accepted: &[String]| {
        let study = RuleStudy::new(&rule(set), library()).unwrap();
        let on = on.map(|day| hadar_scenario::day(day).unwrap());
        let asked = RuleAsked { on, accepted: accepted.to_vec(), ..RuleAsked::default() };
        let (outcome, reasons) = study.answer(&asked, &|_, _| ()).unwrap().outcome();
        (outcome, reasons.iter().map(hadar_study::NotPassed::code).collect::<Vec<_>>())
    };
    let all = Condition::codes();
    let day = Some("2026-11-28");
    assert_eq!(outcome(&[], day, &all), (Outcome::Passed, vec![]));
    // Nobody says where the camera's exposure is from: the rule names no source at all, or none for it.
    let without = RuleStudy::new(&Rule::from_toml(&own, None).unwrap(), library()).unwrap();
    let asked = RuleAsked {
        on: day.map(|day| hadar_scenario::day(day).unwrap()),
        accepted: all.clone(),
        ..RuleAsked::default()
    };
    let (result, reasons) = without.answer(&asked, &|_, _| ()).unwrap().outcome();
    assert_eq!(result, Outcome::Warned);
    assert_eq!(serde_json::to_value(&reasons).unwrap()[0]["figures"], json!(["camera[0].exposure"]));
    assert_eq!(outcome(&[], None, &all), (Outcome::Warned, vec!["no-day"]));
    assert_eq!(outcome(&[], Some("2025-12-31"), &all), (Outcome::Warned, vec!["not-in-force"]));
    assert_eq!(outcome(&["requirement.distance=1"], day, &all), (Outcome::Warned, vec!["changed"]));
    assert_eq!(outcome(&[], day, &all[1..2]).0, Outcome::Warned);
    let failed = outcome(&["requirement.distance=1e8"], day, &all);
    assert_eq!(failed.0, Outcome::Warned, "another rule is not the one that is failed");
    assert!(failed.1.contains(&"fails"));
}

/// Values that are set over a rule stand in its certificate as they are, with nothing behind them.
#[test]
fn what_is_set_over_a_camera_has_no_source() {
    let folder = Folder::with(&sourced(&easy("", "frames = 3\n")));
    let rows = |set: &[&str]| {
        let set: Vec<&str> = set.iter().flat_map(|one| ["--set", *one]).collect();
        let made = folder.run(&[&["rule", "a.toml", "--out", "out", "--force", "-q"], &set[..]].concat());
        assert_eq!(made.code, 0, "{}", made.stderr);
        let text = fs::read_to_string(folder.path().join("out/certificate.md")).unwrap();
        let (_, after) = text.split_once("figures of the cameras are from").unwrap();
        after.split_once("##").unwrap().0.to_owned()
    };
    let plain = rows(&[]);
    assert!(plain.contains("`1 ms`") || plain.contains("\"1 ms\""), "{plain}");
    assert!(!plain.contains("nobody says") && plain.contains("a choice: a test"), "{plain}");
    let set = rows(&["camera[0].exposure=2 ms", "camera[0].quantum_efficiency=0.5"]);
    assert!(set.contains("2 ms") && !set.contains("1 ms") && set.contains("quantum_efficiency"), "{set}");
    assert_eq!(set.matches("nobody says from where").count(), 2, "{set}");
    let whole = rows(&["camera=[{preset=\"ideal-pnrd\",frames=7}]"]);
    assert!(!whole.contains("a choice: a test") && !whole.contains("1 ms"), "{whole}");
}

/// What is demanded of a report is not believed but read in a statement that was made again; an envelope holds its very bytes.
#[test]
fn a_report_is_held_against_what_is_demanded() {
    let dated = easy("", "").replacen("[target]", "[rule]\nname = \"R\"\nfrom = 2026-01-01\n[target]", 1);
    let folder = Folder::with(&sourced(&dated));
    let codes = Condition::codes().join(",");
    let made =
        folder.run(&["rule", "a.toml", "--on", "2026-11-28", "--accept", &codes, "--out", "out", "-q"]);
    assert_eq!(made.code, 0, "{}", made.stderr);
    let statement = fs::read(folder.path().join("out/certificate.intoto.json")).unwrap();
    let value: Value = serde_json::from_slice(&statement).unwrap();
    assert_eq!(value["predicate"]["result"], "PASSED");
    // Every file of the report but the statement and the list is its subject.
    let listed: Value =
        serde_json::from_slice(&fs::read(folder.path().join("out/hadar.json")).unwrap()).unwrap();
    assert_eq!(value["subject"].as_array().unwrap().len() + 1, listed["files"].as_array().unwrap().len());
    let verify = |more: &[&str]| folder.run(&[&["verify", "out"], more].concat());
    assert_eq!(verify(&["--passed", "--on", "2026-11-28"]).code, 0);
    assert_eq!(verify(&["--on", "2026-11-29"]).code, 1);
    // Accepted conditions are a part of the policy: it is not the rule alone.
    assert_eq!(verify(&["--rule", "a.toml"]).code, 1);
    let plain = folder.run(&["rule", "a.toml", "--on", "2026-11-28", "--out", "out", "--force", "-q"]);
    assert_eq!(plain.code, 0, "{}", plain.stderr);
    assert_eq!(verify(&["--rule", "a.toml"]).code, 0);
    let passed = verify(&["--passed"]);
    assert!(passed.code == 1 && passed.stdout.contains("PASSED is demanded"), "{}", passed.stdout);

    let statement = fs::read(folder.path().join("out/certificate.intoto.json")).unwrap();
    let envelope = |bytes: &[u8]| {
        let signature = json!({ "keyid": "somebody", "sig": "c2ln" });
        json!({ "payload": base64(bytes), "payloadType": "application/vnd.in-toto+json", "signatures": [signature] }).to_string()
    };
    folder.file("signed.json", &envelope(&statement));
    let signed = verify(&["--envelope", "signed.json"]);
    assert!(signed.code == 0 && signed.stdout.contains("signed by somebody"), "{}", signed.stdout);
    for byte in [0, statement.len() / 2, statement.len() - 1] {
        let mut other = statement.clone();
        other[byte] ^= 1;
        folder.file("signed.json", &envelope(&other));
        assert_eq!(verify(&["--envelope", "signed.json"]).code, 1, "{byte}");
    }
    // A statement that the report does not list was not made again, and is none.
    let other = folder.run(&["rule", "a.toml", "--figures", "--out", "plain", "-q"]);
    assert_eq!(other.code, 0, "{}", other.stderr);
    fs::write(folder.path().join("plain/certificate.intoto.json"), &statement).unwrap();
    assert!(folder.refusal(&["verify", "plain", "--on", "2026-11-28"]).contains("there is no statement"));
    // One byte in any file of the report is enough.
    for name in ["certificate.md", "certificate.intoto.json", "report.html", "margins.png", "cameras.csv"] {
        let path = folder.path().join("out").join(name);
        let own = fs::read(&path).unwrap();
        let mut other = own.clone();
        let middle = other.len() / 2;
        other[middle] ^= 1;
        fs::write(&path, &other).unwrap();
        let found = folder.run(&["rule", "--verify", "out/certificate.json"]);
        assert!(found.code == 1 && found.stdout.contains(name), "{name}: {}", found.stdout);
        fs::write(&path, &own).unwrap();
    }
    assert_eq!(folder.run(&["rule", "--verify", "out/certificate.json"]).code, 0);
}

fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::new();
    for chunk in bytes.chunks(3) {
        let word =
            chunk.iter().chain([0, 0].iter()).take(3).fold(0u32, |word, byte| word << 8 | u32::from(*byte));
        for place in 0..4 {
            let letter = char::from(LETTERS[(word >> (18 - 6 * place)) as usize & 63]);
            out.push(if place <= chunk.len() { letter } else { '=' });
        }
    }
    out
}

/// Reforms stand beside the law: whose verdict changes, and that a stricter law never makes a margin larger.
#[test]
fn reforms_are_held_beside_the_law() {
    let law = easy("", "share = 0.25\n").replacen(
        "[target]",
        "[rule]\nname = \"R\"\nfrom = 2026-01-01\n[target]",
        1,
    );
    let reform = |set: &str| {
        law.replacen("[[camera]]", &format!("[[reform]]\nname = \"more\"\nfrom = 2030-01-01\nset = [{set}]\nchoice = \"a test\"\n[[camera]]"), 1)
    };
    let found = |text: &str| Reforms::of(&Written::of(text, None), library(), false, &|_, _| ());
    let stricter = found(&reform("\"requirement.distance = 1e8\"")).unwrap();
    assert_eq!(stricter.reforms[0].changed.len(), 1);
    assert!(stricter.reforms[0].cameras[0].margin < stricter.law[0].margin);
    let market = stricter.reforms[0].market.unwrap();
    assert!(close(market.fails, 0.25, 1e-12) && close(market.not_stated, 0.75, 1e-12));
    let same = found(&reform("\"requirement.distance = 0.1\"")).unwrap();
    assert!(close(
        same.reforms[0].cameras[0].margin / same.law[0].margin,
        answered(&law).clauses[0].apart().unwrap().requirement.distance / 0.1,
        1e-6
    ));
    let refused = |text: &str, said: &str| {
        let error = found(text).unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    };
    refused(&law, "no reforms");
    refused(
        &reform("\"requirement.distance = 1\"").replace("2030-01-01", "2020-01-01"),
        "a law that holds from 2026-01-01",
    );
    refused(&reform("\"camera[0].frames = 2\""), "no demand of the law");
    refused(&reform("\"requirement.distnce = 1\""), "distnce");
    refused(&reform("\"requirement\""), "sets nothing");
    refused(&law.replace("share = 0.25", "share = 1.2"), "at most 1");
    let two = law.replace("share = 0.25\n", "share = 0.7\nname = \"a\"\n")
        + "[[camera]]\npreset = \"ideal-pnrd\"\nname = \"b\"\nshare = 0.6\n";
    refused(&two, "add up to 1.3");
}

/// Every number of a rule moved: what no verdict knows of has no change, what is demanded has its own.
#[test]
fn every_figure_of_a_rule_is_moved() {
    let found = FiguresMoved::of(&Written::of(&easy("", ""), None), library(), false, &|_, _| ()).unwrap();
    let change = |key: &str, to: &str| {
        let one = found.figures.iter().find(|one| one.key == key && one.moved_to.contains(to));
        one.unwrap_or_else(|| panic!("{key} {to}: {:?}", found.figures)).largest_change
    };
    // What the envelope says of the temperature stands in the place of the target's.
    assert_eq!(change("stop.latency", "0.55 s").map(|change| change < 0.2), Some(true));
    assert!(found.figures.iter().all(|one| one.refused.is_some() || one.largest_change.is_some()));
    assert!(found.figures.iter().any(|one| one.largest_change.is_some_and(|change| change > 0.01)));
}

/// A limit is met or undecided, never failed; figures with one error that undo each other leave none; a rectangular error ends.
#[test]
fn limits_and_shared_errors_of_figures() {
    let scene = |figures: &str| {
        let text = NIGHT.replace("cameras = [\"flir-a325sc\"]\n", "");
        let (scene, _) = text.split_once("[stop]").unwrap();
        format!(
            "{scene}[requirement]\ndistance = 0.01\n[[camera]]\nnoise_exposure = \"10 ms\"\npixel = \"12 um\"\nfocal_length = \"14 mm\"\n\
             netd_temperature = \"25 degC\"\nnetd_f_number = 1.0\nf_number = 1.0\nexposure = \"10 ms\"\n{figures}\n"
        )
    };
    let stated = only(&scene("netd = \"50 mK\""));
    let limit = only(&scene("netd = { at_most = \"50 mK\" }"));
    assert!(close(limit.margin, stated.margin, 1e-12) && limit.verdict == stated.verdict);
    let demanded = |text: String| text.replace("distance = 0.01", "distance = 1e6");
    assert_eq!(only(&demanded(scene("netd = \"50 mK\""))).verdict, Verdict::Fails);
    assert_eq!(only(&demanded(scene("netd = { at_most = \"50 mK\" }"))).verdict, Verdict::Undecided);
    // d goes with 1/NETD and 1/F²: errors of NETD twice as large as of F, and one error for both, add; independent ones by their squares.
    let with = |same: &str| {
        let netd = format!("netd = {{ value = \"50 mK\", u = \"1 mK\"{same} }}\n");
        only(&scene(&netd).replace(
            "f_number = 1.0\nexposure",
            &format!("f_number = {{ value = 1.0, u = 0.01{same} }}\nexposure"),
        ))
    };
    let (apart, one) = (with(""), with(", same = \"lens\""));
    let share = |camera: &hadar_study::CameraVerdict| {
        camera.uncertainty.as_ref().unwrap().first_order / camera.margin
    };
    assert!(close(share(&apart), 0.02 * 2f64.sqrt(), 0.01), "{}", share(&apart));
    assert!(close(share(&one), 0.04, 0.01), "{}", share(&one));
    let flat = only(&scene("netd = { value = \"50 mK\", u = \"1 mK\", law = \"rectangular\" }"));
    let drawn = flat.uncertainty.as_ref().unwrap().draws.unwrap();
    // No farther than √3 u, 3.5 % of the margin, however wide the guard.
    assert!(drawn.interval[0] > flat.margin / (1.0 + 0.02 * 3f64.sqrt()) * (1.0 - 1e-6), "{drawn:?}");
    let folder = Folder::with("");
    for (figures, said) in [
        ("netd = { at_most = \"50 mK\", u = \"1 mK\" }", "u beside at_most"),
        ("netd = \"50 mK\"\nflicker_fraction = { at_most = 0.5 }", "not known which side is worse"),
        ("netd = { value = \"50 mK\" }", "u"),
        ("netd = { value = \"50 mK\", u = \"1 mK\", same = \"lens\" }", "no other figure has the same error"),
        ("netd = { value = \"50 mK\", u = \"1 mK\", law = \"flat\" }", "rectangular"),
    ] {
        folder.file("a.toml", &scene(figures));
        let refused = folder.refusal(&["rule", "a.toml"]);
        assert!(refused.contains(said), "{refused}");
    }
    let two = scene("name = \"a\"\nnetd = { value = \"50 mK\", u = \"1 mK\", same = \"lens\" }")
        + "[[camera]]\nname = \"b\"\npreset = \"flir-a325sc\"\nnetd = { value = \"50 mK\", u = \"1 mK\", same = \"lens\" }\n";
    folder.file("a.toml", &two);
    assert!(folder.refusal(&["rule", "a.toml"]).contains("figures of two cameras"));
}

/// Materials by a name of the program that are others, and spectra beyond what was measured, are no ground for a pass.
#[test]
fn other_materials_and_guessed_spectra_are_no_pass() {
    let text =
        sourced(&easy("", "").replacen("[target]", "[rule]\nname = \"R\"\nfrom = 2026-01-01\n[target]", 1));
    let folder = Folder::with(&text);
    fs::create_dir(folder.path().join("own")).unwrap();
    folder.file("own/skin.csv", "wavenumber_cm1,emissivity\n700,0.97\n1300,0.98\n");
    let codes = Condition::codes().join(",");
    let run = |more: &[&str]| {
        let asked = [
            &["rule", "a.toml", "--on", "2026-11-28", "--accept", &codes, "--out", "out", "--force", "-q"],
            more,
        ]
        .concat();
        let made = folder.run(&asked);
        assert_eq!(made.code, 0, "{}", made.stderr);
        let text = fs::read(folder.path().join("out/certificate.intoto.json")).unwrap();
        serde_json::from_slice::<Value>(&text).unwrap()["predicate"].clone()
    };
    assert_eq!(run(&[])["result"], "PASSED");
    let other = run(&["--library", "own"]);
    assert_eq!(
        (&other["result"], &other["reasons"][0]["code"]),
        (&json!("WARNED"), &json!("materials-replaced"))
    );

    folder.file("short.csv", "wavenumber_cm1,emissivity\n900,0.3\n1300,0.4\n");
    folder.file("a.toml", &text.replace("[\"aluminium\"]", "[\"short.csv\"]\nextrapolate = \"hold\""));
    let guessed = run(&[]);
    assert!(
        guessed["conditions"]["ideal-pnrd with exposure changed"]
            .as_array()
            .unwrap()
            .contains(&json!("extrapolated")),
        "{guessed}"
    );
    // The policy is the rule's file, and every file that it names must be the one beside it.
    let plain = folder.run(&["rule", "a.toml", "--on", "2026-11-28", "--out", "out", "--force", "-q"]);
    assert_eq!(plain.code, 0, "{}", plain.stderr);
    assert_eq!(folder.run(&["verify", "out", "--rule", "a.toml"]).code, 0);
    fs::create_dir(folder.path().join("law")).unwrap();
    fs::copy(folder.path().join("a.toml"), folder.path().join("law/a.toml")).unwrap();
    folder.file("law/short.csv", "wavenumber_cm1,emissivity\n900,0.5\n1300,0.6\n");
    assert_eq!(folder.run(&["verify", "out", "--rule", "law/a.toml"]).code, 1);
}
