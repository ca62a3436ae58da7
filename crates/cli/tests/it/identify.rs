//! `hadar identify` as a program sees it: every section of the JSON, the files, the words, and what agrees with what.

use crate::support::answers::{
    EVERYTHING, FIVE, LIBRARY, by_alternative, close, example, has, identify, keys, number, pairs, same,
    texts,
};
use crate::support::folder::{Folder, SCENARIO};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;

/// The whole text, so that a change of it is seen; three digits are the same on every machine.
#[test]
fn the_example_of_five_materials_in_words() {
    let outcome = Folder::with("").run(&["identify", &example(), "--matrix"]);
    assert_eq!((outcome.code, outcome.stderr.as_str()), (0, ""));
    insta::assert_snapshot!("identify_five_materials", outcome.stdout);
}

#[test]
fn every_section_has_the_agreed_keys_and_is_there_only_if_asked_for() {
    let folder = Folder::with(FIVE);
    let bare = identify(&folder, &[]);
    let sections = ["matrix", "apart", "scaling", "bands_that_matter", "exact"];
    assert!(sections.iter().all(|section| !keys(&bare).contains(section)), "{:?}", keys(&bare));
    let all = identify(&folder, &EVERYTHING);
    let apart = identify(&folder, &["--apart"]);
    has(&all, &["matrix", "scaling", "bands_that_matter", "exact", "pairs", "identifiability", "limiting"]);
    // Whatever else is asked for, the target's own answer is the same to the last bit.
    for key in ["pairs", "identifiability", "limiting", "warnings", "photon_radiance", "scenario"] {
        assert!(bare[key] == all[key] && bare[key] == apart[key], "{key}");
    }
    let of_target = &all["identifiability"];
    has(
        of_target,
        &[
            "distance_minimum",
            "statistical_distance_minimum",
            "detection_probability_minimum",
            "identifiability_bits",
            "identifiable",
            "told_from",
            "prediction_heuristic",
        ],
    );
    has(
        &all["matrix"],
        &[
            "materials",
            "by",
            "distance_nearest",
            "distance_local",
            "statistical_distance",
            "required_distance",
            "targets",
            "apart",
        ],
    );
    has(
        &all["matrix"]["targets"][0],
        &["material", "limiting", "distance_minimum", "statistical_distance_minimum", "identifiable"],
    );
    let found = &apart["apart"];
    has(found, &["told_apart", "not_told_apart", "clusters", "chains"]);
    for line in ["library_spectra", "sections", "own_state_distances", "nearest_searches", "reports"] {
        has(&apart["stats"][line], &["possible", "computed", "spared"]);
    }
    has(&all["scaling"], &["by", "library", "bands"]);
    has(&all["scaling"]["library"], &["materials", "target", "quantiles", "whole_library"]);
    has(&all["scaling"]["bands"], &["bands", "shot_noise", "shot_noise_median", "camera", "camera_median"]);
    let bands = &all["bands_that_matter"];
    has(
        bands,
        &[
            "alternatives",
            "left_out",
            "alternative",
            "center_cm1",
            "share_local",
            "lost_without",
            "share_nearest",
        ],
    );
    for choice in [&bands["bands"], &bands["filters"]] {
        has(
            choice,
            &["passbands", "distance", "distance_all_bands", "kept", "bound", "exact", "limiting", "fewest"],
        );
        has(&choice["passbands"][0], &["low_cm1", "high_cm1", "center_cm1"]);
    }
    let exact = &all["exact"];
    has(exact, &["statistics", "generator", "seed", "level", "pairs", "library"]);
    has(
        &exact["pairs"][0],
        &[
            "alternative",
            "photons",
            "statistical_distance_nearest",
            "statistical_distance_local",
            "limit",
            "local",
            "two_sided",
            "error_lower",
            "error_upper",
            "balanced",
            "balanced_interval",
            "classes",
            "trials",
            "unconverged",
        ],
    );
    has(&exact["library"], &["probability", "interval", "decisions", "union_bound_known_states", "trials"]);
}

/// Paths at which there is nothing; a number that is none would be written so too.
fn nothings(value: &Value, path: &str, found: &mut BTreeSet<String>) {
    match value {
        Value::Null => {
            found.insert(path.to_owned());
        }
        Value::Array(all) => all.iter().for_each(|value| nothings(value, path, found)),
        Value::Object(all) => {
            all.iter().for_each(|(key, value)| nothings(value, &format!("{path}.{key}"), found));
        }
        _ => {}
    }
}

#[test]
fn nothing_is_null_but_what_does_not_apply() {
    let mut found = BTreeSet::new();
    for scenario in [FIVE, &FIVE.replace("noise_electrons = 0", "noise_electrons = 20")] {
        let mut all = identify(&Folder::with(scenario), &EVERYTHING);
        // The diagonals are empty, and nothing else of these.
        for key in [
            "distance_nearest",
            "distance_nearest_lower",
            "relative_error_nearest",
            "distance_local",
            "relative_error",
            "statistical_distance",
            "statistical_distance_lower",
        ] {
            let rows = all["matrix"][key].take();
            for (i, row) in rows.as_array().unwrap().iter().enumerate() {
                let empty: Vec<usize> = (0..5).filter(|&j| row[j].is_null()).collect();
                assert_eq!(empty, [i], "{key}");
            }
            all["matrix"].as_object_mut().unwrap().remove(key);
        }
        all.as_object_mut().unwrap().remove("scenario");
        nothings(&all, "", &mut found);
    }
    // No blind direction and no priors.
    let expected = [".pairs.blind_direction", ".prior_average"];
    assert_eq!(found, expected.map(str::to_owned).into());
}

/// Row by row the matrix is what `identify` says of the same target, by every distance.
#[test]
fn the_matrix_is_that_of_its_pairs() {
    let five = ["skin", "aluminium", "fused-silica", "pmma", "concrete"];
    for by in ["nearest", "local", "local-unknown-gain"] {
        let whole = identify(&Folder::with(FIVE), &["--matrix", "--by", by]);
        let matrix = &whole["matrix"];
        assert_eq!((texts(&matrix["materials"]), matrix["by"].as_str()), (five.to_vec(), Some(by)));
        for (i, target) in five.iter().enumerate() {
            let others: Vec<&str> = five.iter().copied().filter(|name| name != target).collect();
            let scenario = FIVE
                .replace("material = \"skin\"", &format!("material = {target:?}"))
                .replace("[\"aluminium\", \"fused-silica\", \"pmma\", \"concrete\"]", &format!("{others:?}"));
            let alone = identify(&Folder::with(&scenario), &["--by", by]);
            for key in ["distance_nearest", "distance_local", "statistical_distance"] {
                for (other, expected) in by_alternative(&alone, key) {
                    let j = five.iter().position(|name| *name == other).unwrap();
                    // The same search, but for the rounding of what targets share.
                    close(
                        &format!("{key} {target} {other}"),
                        number(&matrix[key][i][j]),
                        number(expected),
                        1e-8,
                    );
                }
            }
            let verdict = &matrix["targets"][i];
            assert_eq!(verdict["material"], *target);
            assert_eq!(verdict["limiting"], alone["limiting"], "{target} by {by}");
            assert_eq!(verdict["identifiable"], alone["identifiability"]["identifiable"]);
        }
    }
}

/// From a camera that tells next to nothing to one that tells nearly all: the decision is that of the full distances,
/// with and without shortcuts, and groups are disjoint and hold only pairs that are not told apart.
#[test]
fn who_is_told_apart_is_the_same_by_every_way() {
    for exposure in ["100 us", "100 ms", "1 s"] {
        let camera = format!("preset = \"ideal-pnrd\"\nexposure = \"{exposure}\"\nf_number = 30");
        let folder = Folder::with(&LIBRARY.replace("preset = \"flir-a325sc\"", &camera));
        let mut all = identify(&folder, &["--matrix"]);
        let (fast, slow) = (identify(&folder, &["--apart"]), identify(&folder, &["--apart", "--no-skip"]));
        let materials: Vec<String> =
            texts(&all["matrix"]["materials"]).iter().map(|name| (*name).to_owned()).collect();
        let count = materials.len();
        let full = all["matrix"]["apart"].take();
        for key in ["told_apart", "not_told_apart", "clusters", "chains"] {
            assert!(full[key] == fast["apart"][key] && full[key] == slow["apart"][key], "{exposure}: {key}");
        }
        // Beside all pairs, three searches for each alternative of the target: with shot noise, back, by the camera; and where one is told
        // 65 for errors of the emissivities.
        let searches = |result: &Value, key: &str| result["stats"]["nearest_searches"][key].as_u64().unwrap();
        let told_from = fast["identifiability"]["told_from"].as_u64().unwrap();
        let possible = (count * (count - 1) + 3 * (count - 1)) as u64 + if told_from > 0 { 65 } else { 0 };
        assert_eq!([&fast, &slow].map(|result| searches(result, "possible")), [possible; 2]);
        assert_eq!(searches(&slow, "computed"), possible);
        assert!(searches(&fast, "computed") < possible, "{exposure}");
        let (told, not) = (pairs(&full["told_apart"]), pairs(&full["not_told_apart"]));
        println!("{exposure}: {} pairs distinguished, {} not", told.len(), not.len());
        assert!(told.is_disjoint(&not));
        assert_eq!(told.len() + not.len(), count * (count - 1) / 2);
        assert!(!told.is_empty() && !not.is_empty(), "{exposure} decides everything alike");
        let mut seen = BTreeSet::new();
        for cluster in full["clusters"].as_array().unwrap() {
            let members = texts(cluster);
            assert!(members.len() > 1);
            for (i, a) in members.iter().enumerate() {
                assert!(seen.insert((*a).to_owned()), "{a} is in two clusters");
                for b in &members[..i] {
                    let pair = if a < b { (*a, *b) } else { (*b, *a) };
                    assert!(not.contains(&(pair.0.to_owned(), pair.1.to_owned())), "{a} {b}");
                }
            }
        }
        // Not told apart by chains: whoever is not told from someone is in exactly one of them.
        let chained: Vec<&str> = full["chains"].as_array().unwrap().iter().flat_map(texts).collect();
        let confused: BTreeSet<&str> = not.iter().flat_map(|(a, b)| [a.as_str(), b.as_str()]).collect();
        assert_eq!(chained.len(), confused.len());
        assert_eq!(chained.into_iter().collect::<BTreeSet<_>>(), confused);
    }
}

#[test]
fn a_check_ends_with_the_code_of_its_answer() {
    let mut answers = BTreeSet::new();
    for (exposure, materials) in [
        ("1 us", "\"aluminium\", \"pmma\""),
        ("1 us", "\"fused-silica\", \"pmma\", \"concrete\""),
        ("100 us", "\"aluminium\", \"fused-silica\""),
        ("1 us", "\"aluminium\""),
    ] {
        let scenario = FIVE
            .replace("\"aluminium\", \"fused-silica\", \"pmma\", \"concrete\"", materials)
            .replace("1 us", exposure);
        let folder = Folder::with(&scenario);
        for by in ["nearest", "local", "local-unknown-gain"] {
            let expected =
                identify(&folder, &["--by", by])["identifiability"]["identifiable"].as_bool().unwrap();
            let arguments = ["identify", "a.toml", "--by", by, "--check"];
            let words = folder.accepting(&arguments);
            let json = folder.accepting(&[&arguments[..], &["--json"]].concat());
            assert_eq!(folder.run(&arguments).code, 3, "its conditions are accepted by nobody");
            let code = if expected { 0 } else { 3 };
            assert_eq!((words.code, json.code), (code, code), "{materials} by {by}");
            let json: Value = serde_json::from_str(&json.stdout).unwrap();
            assert_eq!(json["identifiable"], expected);
            assert_eq!(json["not_told_from"].is_null(), expected);
            assert_eq!(words.stdout.lines().count() == 1, !expected);
            let start = if expected {
                "Yes, if "
            } else if by == "nearest" {
                "No: the camera cannot distinguish skin from "
            } else {
                "No: the camera does not distinguish skin from "
            };
            assert!(words.stdout.starts_with(start), "{}", words.stdout);
            assert_eq!(words.stdout.contains(": the camera distinguishes skin from "), expected);
            answers.insert(expected);
        }
    }
    assert_eq!(answers.len(), 2, "all checks end alike");
}

#[test]
fn neither_threads_nor_a_second_run_change_a_byte_and_a_seed_only_the_simulation() {
    let folder = Folder::with(FIVE);
    let run = |more: &[&str]| {
        let outcome = folder.run(&[&["identify", "a.toml"], &EVERYTHING[..], more].concat());
        assert_eq!(outcome.code, 0, "{}", outcome.stderr);
        outcome.stdout
    };
    let one = run(&["--json", "--threads", "1", "--out", "one"]);
    let two = run(&["--json", "--threads", "2", "--out", "two"]);
    assert!(one == two, "the JSON differs");
    assert!(run(&["--threads", "1"]) == run(&["--threads", "2"]), "the text differs");
    let names: Vec<_> =
        fs::read_dir(folder.path().join("one")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert!(names.len() > 20);
    for name in names {
        let read = |of: &str| fs::read(folder.path().join(of).join(&name)).unwrap();
        assert!(read("one") == read("two"), "{name:?} differs");
    }
    let parse = |text: &str| serde_json::from_str::<Value>(text).unwrap();
    let (mut first, mut other) = (parse(&one), parse(&run(&["--json", "--seed", "2"])));
    assert_eq!((&first["exact"]["seed"], &other["exact"]["seed"]), (&Value::from(1), &Value::from(2)));
    let (a, b) = (first["exact"].take(), other["exact"].take());
    // The second has no report, and another number of trials.
    assert!(first["stats"].take() != other["stats"].take());
    assert!(first == other, "the seed changes more than the simulation");
    assert_ne!(a["pairs"][0]["balanced"], b["pairs"][0]["balanced"]);
    assert_ne!(a["library"]["decisions"], b["library"]["decisions"]);
    for key in ["limit", "local", "two_sided", "error_lower", "error_upper", "photons", "alternative"] {
        for (a, b) in a["pairs"].as_array().unwrap().iter().zip(b["pairs"].as_array().unwrap()) {
            assert_eq!(a[key], b[key], "{key}");
        }
    }
}

/// Every plot with the numbers in it, every table with rows, and the scenario that gives it all again.
#[test]
fn the_files_are_complete_and_their_scenario_gives_them_again() {
    let folder = Folder::with(FIVE);
    let first = identify(&folder, &[&EVERYTHING[..], &["--out", "deep/report"]].concat());
    let report = folder.path().join("deep/report");
    let text = |name: &str| fs::read_to_string(report.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
    let rows = |name: &str| text(name).lines().count() - 1;
    for (name, expected) in [
        ("pairs.csv", 4),
        ("prediction.csv", 5),
        ("matrix_nearest.csv", 5),
        ("matrix_local.csv", 5),
        ("matrix_camera.csv", 5),
        ("targets.csv", 5),
        ("told_apart.csv", 10),
        ("best_bands.csv", 6),
        ("exact.csv", 4),
        ("distance_matrix.csv", 5),
        ("sample_spectra.csv", 108),
        ("library_size.csv", 4),
        ("distances.csv", 4),
        ("incident_spectra.csv", 108),
        ("bands_that_matter.csv", 108),
    ] {
        assert_eq!(rows(name), expected, "{name}");
    }
    for name in fs::read_dir(&report).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap())
    {
        if name.ends_with(".csv") {
            let content = text(&name);
            let mut cells = content.split([',', '\n']);
            assert!(cells.all(|cell| cell != "NaN" && cell != "inf"), "{name}:\n{content}");
        }
        if let Some(stem) = name.strip_suffix(".svg") {
            assert!(rows(&format!("{stem}.csv")) > 1, "{stem}");
            assert!(fs::read(report.join(format!("{stem}.png"))).unwrap().starts_with(b"\x89PNG"), "{stem}");
            let svg = text(&name);
            assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"), "{stem}");
            assert!(!svg.contains("NaN") && !svg.contains("inf\""), "{stem}");
        }
    }
    // The matrix of the CSV is that of the JSON.
    let camera = text("matrix_camera.csv");
    for (line, row) in camera.lines().skip(1).zip(first["matrix"]["statistical_distance"].as_array().unwrap())
    {
        for (cell, value) in line.split(',').skip(1).zip(row.as_array().unwrap()) {
            match cell.parse::<f64>() {
                // One of the two readers may round differently.
                Ok(cell) => close("camera", cell, number(value), 1e-15),
                Err(_) => assert!(cell.is_empty() && value.is_null()),
            }
        }
    }
    let again = folder.json(&[&["identify", "deep/report/scenario.toml"], &EVERYTHING[..]].concat());
    for key in ["pairs", "identifiability", "matrix", "scaling", "bands_that_matter", "exact", "scenario"] {
        // The echo writes SI units: a rounding of the focal length or two.
        same(&first[key], &again[key], key);
    }
}

#[test]
fn quiet_is_quiet_and_what_was_skipped_is_said_on_stderr_only() {
    let folder = Folder::with(FIVE);
    let plain = folder.run(&["identify", "a.toml", "--apart"]);
    let stats = folder.run(&["identify", "a.toml", "--apart", "--stats"]);
    assert_eq!((plain.stderr.as_str(), &plain.stdout), ("", &stats.stdout));
    let searches = |stderr: &str| -> Vec<u64> {
        let line = stderr.lines().find(|line| line.starts_with("searches in all bands")).unwrap();
        line.split_whitespace().filter_map(|word| word.parse().ok()).take(3).collect()
    };
    assert!(stats.stderr.starts_with("work "), "{}", stats.stderr);
    // 65 for what errors of the emissivities do to the hardest pair that is told.
    assert_eq!(searches(&stats.stderr)[0], 20 + 12 + 65);
    let all = folder.run(&["identify", "a.toml", "--matrix", "--stats"]);
    assert_eq!(searches(&all.stderr), [2 * 20 + 12 + 65, 2 * 20 + 12 + 65, 0]);
    let check = folder.run(&["identify", "a.toml", "--check", "--stats", "--json"]);
    let counts = searches(&check.stderr);
    assert_eq!((counts[0], counts[1] + counts[2]), (4, 4));
    let json: Value = serde_json::from_str(&check.stdout).unwrap();
    assert_eq!(json["stats"]["nearest_searches"]["possible"], 4);
    let loud = folder.run(&["identify", "a.toml", "--matrix", "--out", "report"]);
    assert!(
        loud.stderr.starts_with("wrote ") && loud.stderr.contains(" files to report/"),
        "{}",
        loud.stderr
    );
    let quiet = folder.run(&["identify", "a.toml", "--matrix", "--out", "report", "--stats", "-q"]);
    assert_eq!((quiet.stderr.as_str(), quiet.stdout), ("", loud.stdout));
}

/// Unknowns that are nearly dependent, of which doubles leave one out: against 60 digits.
#[test]
fn nearly_dependent_unknowns_count() {
    let Some(folder) = hadar_testing::shared("reference/nearest") else { return };
    for (scene, alternative, key, exact, digits) in [
        ("gainvariant_2679", "alt2", "distance_local_unknown_gain", 0.027_555, 2e-5),
        ("local_2807", "alt1", "distance_local", 0.073_248, 1e-5),
        ("local_2807", "alt1", "distance_local_unknown_gain", 0.073_248, 1e-5),
    ] {
        let scenario = folder.join(scene).join("case.toml");
        let found = Folder::with("").json(&["identify", scenario.to_str().unwrap()]);
        let pairs = found["pairs"].as_array().unwrap();
        let pair = pairs.iter().find(|pair| pair["alternative"] == alternative).unwrap();
        assert!((number(&pair[key]) / exact - 1.0).abs() < digits, "{scene} {pair}");
        let error = if key == "distance_local" { "relative_error" } else { "relative_error_unknown_gain" };
        assert!(number(&pair[error]) < 1e-9, "{pair}");
        let warnings = found["warnings"].as_array().unwrap();
        assert!(warnings.iter().all(|warning| warning["code"] != "unknown-without-effect"), "{warnings:?}");
    }
}

/// Photons that are enough rest on what is proved, with priors too: as many as it takes where all is proved, more or no number
/// where a proof leaves priors out.
#[test]
fn photons_that_are_enough_are_proved_with_priors_too() {
    let folder = Folder::with(SCENARIO);
    for (unknown, priors, is_proved) in [
        (r#"["temperature", "lighting"]"#, r#"{ temperature = "2 K" }"#, true),
        (r#"["temperature", "lighting"]"#, "{ lighting = 0.05 }", true),
        (r#"["temperature", "environment-temperature"]"#, r#"{ environment-temperature = "3 K" }"#, true),
        (r#"["temperature", "gain"]"#, r#"{ temperature = "1 K", gain = 0.02 }"#, false),
        (r#"["temperature", "lighting", "gain"]"#, "{ gain = 0.02 }", false),
        (
            r#"["temperature", "lighting", "environment-temperature"]"#,
            r#"{ environment-temperature = "3 K" }"#,
            false,
        ),
    ] {
        let set = [format!("unknown.nuisances={unknown}"), format!("unknown.priors={priors}")];
        let answer = folder.json(&["identify", "a.toml", "--set", &set[0], "--set", &set[1]]);
        let pair = &answer["pairs"][0];
        let [needed, enough] = [0, 1].map(|end| pair["photons_required_bounds"][end].as_f64());
        let needed = needed.expect("a number of photons");
        assert_eq!(enough == Some(needed), is_proved, "{set:?}: {needed} {enough:?}");
        assert!(enough.is_none_or(|enough| enough >= needed), "{set:?}: {needed} {enough:?}");
    }
}
