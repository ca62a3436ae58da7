//! `hadar simulate`: the limit is kept, results do not depend on threads, models come back, and every mistake is one line.

use crate::support::folder::Folder;
use serde_json::Value;
use std::fs;

/// A person and a robot in three bands, no camera.
const THREE: &str = r#"[target]
material = "skin"
temperature = "37 degC"
[[environment]]
temperature = "20 degC"
lighting = 0.5
[alternatives]
materials = ["aluminium", "concrete"]
[bands]
ranges = [["714.5 cm^-1", "893.5 cm^-1"], ["893.5 cm^-1", "1072.5 cm^-1"], ["1072.5 cm^-1", "1250.5 cm^-1"]]
"#;

/// Skin and aluminium at the temperature of the room, known to 2 K: no number of photons distinguishes the nominal states.
const BLIND: &str = r#"[target]
material = "skin"
temperature = "20 degC"
[[environment]]
temperature = "20 degC"
lighting = 1.0
[alternatives]
materials = ["aluminium"]
[bands]
start = "720 cm^-1"
stop = "1240 cm^-1"
step = "20 cm^-1"
[unknown]
nuisances = ["temperature"]
priors = { temperature = "2 K" }
"#;

/// By a program of its own (NumPy: Poisson counts in all bands, 2001 temperatures within 5 deviations, 20 000 decisions each) the Bayes
/// test is right in 81.6 % of the cases at 1.77e6 photons, 84.0 at 2.6e6, 84.7 at 3.0e6, each ± 0.26 (one deviation): the photons for
/// 84.1 % lie between 2.4e6 and 3.0e6. What was printed were 1.77e6.
#[test]
fn an_average_over_priors_is_bracketed_and_simulated() {
    let folder = Folder::with(BLIND);
    let found = folder.json(&["identify", "a.toml", "--average"]);
    let side = |key: &str| number(&found["prior_average"][key]);
    let (lower, upper) = (side("photons_required_lower"), side("photons_required_upper"));
    println!("{lower:.4e} to {upper:.4e}");
    assert!(
        lower > 2.2e6 && lower < 2.85e6 && upper > 2.5e6 && upper < 3.3e6 && lower <= upper,
        "{lower} {upper}"
    );
    let found = simulate(&folder, &["--average", "--photons", "1.77e6", "--spectra", "10000"]);
    let point = &found["averages"][0];
    println!("{point}");
    assert!((number(&point["probability"]) - 0.8159).abs() < 3.3 * 0.0038, "{point}");
    assert!(
        number(&point["probability_lower"]) > 0.80 && number(&point["probability_upper"]) < 0.83,
        "{point}"
    );
    assert!(found["brackets_hold"] == true && number(&point["changed_by_half_the_states"]) < 0.01, "{point}");
    // Without a number they are those that suffice.
    let own = simulate(&folder, &["--average", "--spectra", "100"]);
    assert!((number(&own["averages"][0]["photons"]) / upper - 1.0).abs() < 1e-12);
    let refused = |more: &[&str]| folder.refusal(&[&["simulate", "a.toml", "--average"], more].concat());
    assert!(refused(&["--statistics", "fixed-total"]).contains("fixed total"));
    assert!(
        refused(&["--set", "unknown.nuisances=[\"temperature\", \"lighting\"]"])
            .contains("none for lighting")
    );
    let plain = Folder::with(THREE);
    assert!(plain.refusal(&["simulate", "a.toml", "--average"]).contains("`unknown.priors` states none"));
}

fn simulate(folder: &Folder, more: &[&str]) -> Value {
    folder.json(&[&["simulate", "a.toml"], more].concat())
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("not a number: {value}"))
}

fn performance<'v>(point: &'v Value, method: &str) -> &'v Value {
    let all = point["performances"].as_array().unwrap();
    all.iter().find(|found| found["method"] == method).unwrap_or_else(|| panic!("no {method} in {point}"))
}

/// In three bands, at the distance of the requirement, each classifier is within 1 point of Φ(1) = 0.8413. The 10 000 test
/// spectra of each class leave a deviation of 0.26 points: an optimal one would fail once in 7000 seeds.
#[test]
fn the_limit_is_reached_in_three_bands() {
    let folder = Folder::with(THREE);
    let found = simulate(
        &folder,
        &["--spectra", "20000", "--classifiers", "likelihood-ratio,best-fits,discriminant,logistic"],
    );
    assert_eq!(found["limit_holds"], true);
    assert_eq!(found["comparisons"], 4);
    let point = &found["points"][0];
    assert!((number(&point["statistical_distance"]) - 1.0).abs() < 1e-6);
    // 1.3e6 photons in each band: exact and asymptotic limit differ by the third moment, 1e-4 at most.
    assert!((number(&point["limit_accuracy"]) - 0.841_344_75).abs() < 1e-4);
    assert_eq!(point["classes"][1]["material"], "aluminium");
    assert!((number(&point["classes"][1]["temperature_k"]) - 355.97).abs() < 0.05);
    for method in ["likelihood-ratio", "best-fits", "discriminant", "logistic"] {
        let right = number(&performance(point, method)["accuracy"]);
        assert!((right - 0.8413).abs() < 0.01, "{method}: {right}");
        let rows = &performance(point, method)["confusion"]["decisions"];
        let sum: f64 = (0..2).flat_map(|a| (0..2).map(move |b| number(&rows[a][b]))).sum();
        assert_eq!(sum, 20_000.0);
    }
    // The local distance promises less than what is reached: it is no limit.
    let local = number(&point["local_accuracy"]);
    assert!(local < number(&performance(point, "likelihood-ratio")["interval"]["low"]), "{local}");
}

/// Same seed, same bits: for any number of threads, and for a photon number alone or in a list.
#[test]
fn a_seed_brings_everything_back() {
    let folder = Folder::with(THREE);
    let flags = |photons: &'static str, threads: &'static str| {
        let all = ["--spectra", "400", "--seed", "5", "--photons", photons, "--threads", threads];
        simulate(&folder, &all)
    };
    let (one, three) = (flags("1e5,1e6", "1"), flags("1e5,1e6", "3"));
    assert_eq!(one, three);
    assert_eq!(one["points"][1], flags("1e6", "2")["points"][0]);
    assert_eq!(one["seed"], 5);
    assert!(one["generator"].as_str().unwrap().contains("ChaCha8"));
    let other = simulate(&folder, &["--spectra", "400", "--seed", "6", "--photons", "1e6"]);
    assert_ne!(other["points"][0]["performances"], one["points"][1]["performances"]);
}

/// The saved spectra decide anew, by Σ n ln(b/a) − (b − a) written here, as often as it is printed; the file depends on the seed alone.
#[test]
fn saved_spectra_can_be_judged_by_anybody() {
    let folder = Folder::with(THREE);
    let saved = |out: &str, threads: &str| {
        let flags = ["--spectra", "4000", "--photons", "2e5,8e5", "--classifiers", "likelihood-ratio"];
        let found = simulate(
            &folder,
            &[&flags[..], &["--save-spectra", "--out", out, "--threads", threads]].concat(),
        );
        (found, fs::read_to_string(folder.path().join(out).join("spectra.csv")).unwrap())
    };
    let ((found, spectra), (_, again)) = (saved("one", "1"), saved("three", "3"));
    assert!(spectra == again);
    let rows = |text: &str| -> Vec<Vec<String>> {
        text.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect()
    };
    let value = |cell: &String| cell.parse::<f64>().unwrap();
    let classes = rows(&fs::read_to_string(folder.path().join("one/spectra_classes.csv")).unwrap());
    assert_eq!(classes.len(), 2 * 2 * 3);
    for (experiment, point) in found["points"].as_array().unwrap().iter().enumerate() {
        let means = |class: usize| -> Vec<f64> {
            let own = &classes[6 * experiment + 3 * class..][..3];
            own.iter().map(|row| value(&row[8])).collect()
        };
        let (a, b) = (means(0), means(1));
        let mut right = [0.0; 2];
        let all = rows(&spectra);
        let own = &all[4000 * experiment..4000 * (experiment + 1)];
        for row in own {
            let class: usize = row[2].parse().unwrap();
            let ratio: f64 = (0..3).map(|w| value(&row[3 + w]) * (b[w] / a[w]).ln() - (b[w] - a[w])).sum();
            right[class] += f64::from(u8::from((ratio > 0.0) == (class == 1))) / 2000.0;
        }
        let printed = number(&performance(point, "likelihood-ratio")["accuracy"]);
        // A spectrum at the threshold may fall to the other side by rounding.
        assert!((0.5 * (right[0] + right[1]) - printed).abs() < 3e-4, "{right:?} {printed}");
    }
    let many = ["--spectra", "400000", "--photons", "8e5", "--classifiers", "likelihood-ratio"];
    simulate(&folder, &[&many[..], &["--save-spectra", "--out", "many"]].concat());
    let bytes = fs::read(folder.path().join("many/spectra.npy")).unwrap();
    assert_eq!(bytes.len(), 128 + 8 * 200_000 * 2 * 3);
}

/// A classifier trained on four times the spectra has seen none of the test: it stays below the limit.
#[test]
fn a_model_of_a_larger_run_has_not_seen_the_test() {
    let folder = Folder::with(&THREE.replace(
        "ranges = [[\"714.5 cm^-1\", \"893.5 cm^-1\"], [\"893.5 cm^-1\", \"1072.5 cm^-1\"], [\"1072.5 cm^-1\", \"1250.5 cm^-1\"]]",
        "start = \"715 cm^-1\"\nstop = \"1250 cm^-1\"\nstep = \"1 cm^-1\"",
    ));
    let common = ["--photons", "3e5", "--classifiers"];
    let trained = ["discriminant", "--spectra", "20000", "--save-models", "models"];
    simulate(&folder, &[&common[..], &trained].concat());
    let again = ["likelihood-ratio", "--spectra", "5000", "--model", "models/discriminant.json", "--check"];
    let found = simulate(&folder, &[&common[..], &again].concat());
    let right = number(&performance(&found["points"][0], "discriminant")["accuracy"]);
    // 2500 test spectra of each class: 0.66 points; the discriminant of 5000 for training misses 3 in theory.
    assert!(right < number(&found["points"][0]["limit_accuracy"]), "{right}");
}

/// A saved classifier judges as it did, and refuses other bands and other classes.
#[test]
fn models_are_saved_and_come_back() {
    let folder = Folder::with(THREE);
    let common = ["--spectra", "2000", "--photons", "2.6e6"];
    let trained = simulate(
        &folder,
        &[&common[..], &["--save-models", "models", "--classifiers", "discriminant,logistic"]].concat(),
    );
    let again = simulate(
        &folder,
        &[&common[..], &["--model", "models/discriminant.json", "--model", "models/logistic.json"]].concat(),
    );
    for method in ["discriminant", "logistic"] {
        let (a, b) = (performance(&trained["points"][0], method), performance(&again["points"][0], method));
        assert_eq!(a["confusion"], b["confusion"], "{method}");
    }
    let refused = |more: &[&str]| {
        folder.refusal(&[&["simulate", "a.toml", "--model", "models/logistic.json"], more].concat())
    };
    assert!(
        refused(&["--against", "concrete"])
            .contains("the saved model tells apart skin, aluminium; the scenario has skin, concrete")
    );
    folder.file("a.toml", &THREE.replace("[\"714.5 cm^-1\", \"893.5 cm^-1\"], ", ""));
    assert!(
        refused(&["--photons", "1e6"])
            .contains("the saved model has 3 bands from 804 to 1161.5 cm^-1, the scenario 2 bands")
    );
    folder.file("a.toml", THREE);
    let text = fs::read_to_string(folder.path().join("models/logistic.json")).unwrap();
    for (damaged, said) in [
        (text.replacen("\"schema\":1", "\"schema\":9", 1), "a saved model of format 9"),
        (text.replacen("\"constants\":[0.0,", "\"constants\":[", 1), "no saved model"),
        (text.replacen("logistic", "oracle", 1), "no saved model"),
        (String::new(), "no saved model"),
    ] {
        folder.file("models/logistic.json", &damaged);
        let message = refused(&[]);
        assert!(message.contains(said) && message.contains("logistic.json"), "{message}");
    }
}

#[test]
fn every_mistake_is_one_line() {
    let folder = Folder::with(THREE);
    for (flags, said) in [
        (vec!["--spectra", "0"], "--spectra: spectra of each class is 0; it must be at least 4"),
        (vec!["--photons", "0"], "--photons: number of photons is 0"),
        (vec!["--photons", "-5"], "number of photons is -5"),
        (vec!["--photons", "NaN"], "number of photons is NaN"),
        (vec!["--photons", "1e6,inf"], "number of photons is inf"),
        (vec!["--photons", "1e19"], "number of photons is 1e19"),
        (vec!["--statistics", "fixed-total", "--photons", "1e16"], "at most 2^53"),
        (
            vec!["--classifiers", "oracle"],
            "unknown classifier `oracle`; choose among likelihood-ratio, best-fits",
        ),
        (vec!["--sweep", "0"], "--sweep: experiments of a sweep is 0"),
        (vec!["--sweep", "1000000000000"], "experiments of a sweep is 1000000000000"),
        (vec!["--spectra", "18446744073709551615"], "spectra of each class is"),
        (vec!["--skip-spectra", "--spectra", "4000000000000000000"], "spectra of each class is"),
        (vec!["--skip-spectra", "--statistics", "fixed-total"], "judges by another law"),
        (vec!["--photons", "1e-300"], "number of photons is"),
        (vec!["--check", "--against", "all"], "--check holds two classes"),
        (vec!["--threads", "1000000"], "--threads is 1000000"),
        (
            vec!["--thermometry", "-10 degC..20 degC", "--temperatures", "100000000000"],
            "--temperatures is 100000000000",
        ),
        (vec!["--against", "gold"], "`gold` is none of the alternatives; choose among aluminium, concrete"),
        (vec!["--model", "nothing.json"], "nothing.json"),
        (
            vec!["--skip-spectra", "--classifiers", "network"],
            "spectra can be skipped for the likelihood ratio",
        ),
        (vec!["--save-spectra"], "name one with --out"),
        (vec!["--save-spectra", "--out", "x", "--skip-spectra"], "leave out one of them"),
        (vec!["--save-spectra", "--out", "x", "--spectra", "90000000"], "too many to be saved"),
        (vec!["--thermometry", "30 degC..40 degC"], "thermometry without a camera"),
        (vec!["--thermometry", "30..40"], "--thermometry: `30` is a number without a unit"),
        (vec!["--thermometry", "30 degC..40 degC", "--temperatures", "1"], "--temperatures is 1"),
    ] {
        let message = folder.refusal(&[&["simulate", "a.toml"], flags.as_slice()].concat());
        assert!(message.contains(said), "{flags:?}: {message}");
    }
}

/// So few photons that every spectrum is empty, and so many that counts are no whole numbers any more: answers with warnings.
#[test]
fn extremes_are_answered() {
    let folder = Folder::with(THREE);
    for (photons, code) in [("1e-6", "spectra-empty"), ("5e17", "counts-rounded")] {
        let found = simulate(&folder, &["--spectra", "40", "--photons", photons]);
        let codes: Vec<&str> =
            found["warnings"].as_array().unwrap().iter().map(|w| w["code"].as_str().unwrap()).collect();
        assert!(codes.contains(&code), "{photons}: {codes:?}");
        let point = &found["points"][0];
        let (limit, right) =
            (number(&point["limit_accuracy"]), number(&performance(point, "likelihood-ratio")["accuracy"]));
        if photons == "1e-6" {
            // Nothing is seen: a coin.
            assert!((limit - 0.5).abs() < 1e-5 && right == 0.5, "{limit} {right}");
        } else {
            assert!(limit == 1.0 && right == 1.0, "{limit} {right}");
        }
    }
}

/// Drawn without spectra, the likelihood ratio is right as often as with them: 100 000 trials each way, three
/// deviations of their difference apart at most (by chance 3e-3, and not with this seed).
#[test]
fn without_spectra_the_accuracy_is_the_same() {
    let folder = Folder::with(THREE);
    let flags = ["--spectra", "100000", "--photons", "1.5e6", "--classifiers", "likelihood-ratio"];
    let drawn = simulate(&folder, &flags);
    let skipped = simulate(&folder, &[&flags[..], &["--skip-spectra"]].concat());
    let [a, b] = [&drawn, &skipped]
        .map(|found| number(&performance(&found["points"][0], "likelihood-ratio")["accuracy"]));
    let sigma = (2.0 * a * (1.0 - a) / 1e5_f64).sqrt();
    assert!((a - b).abs() < 3.0 * sigma && a != b, "{a} {b} {sigma}");
    assert_eq!(drawn["points"][0]["limit_accuracy"], skipped["points"][0]["limit_accuracy"]);
}

/// Maximum likelihood reads the temperature of a camera's target with the error that is the least there is.
#[test]
fn thermometry_reaches_its_bound() {
    let folder = Folder::with(&format!("{THREE}[camera]\npreset = \"flir-a325sc\"\n"));
    let found = simulate(
        &folder,
        &["--thermometry", "30 degC..40 degC", "--temperatures", "2", "--spectra", "8000", "--out", "out"],
    );
    for row in found["rows"].as_array().unwrap() {
        let reader = &row["lighting_known"];
        let (bound, rmse) = (number(&reader["bound_k"]), number(&reader["errors"]["rmse"]));
        // Deviation of the ratio 1/√16000; four of them.
        assert!((rmse / bound - 1.0).abs() < 0.032, "{rmse} {bound}");
    }
    assert!(folder.path().join("out/thermometry.csv").exists());
}

/// Every law of photons, a camera's noise, three classes at once.
#[test]
fn laws_and_classes() {
    let folder = Folder::with(THREE);
    let flags = ["--spectra", "2000", "--photons", "2.6e6"];
    for law in ["poisson", "negative-binomial", "fixed-total"] {
        let found = simulate(&folder, &[&flags[..], &["--statistics", law]].concat());
        assert_eq!(found["photon_law"], law);
        assert_eq!(found["limit_holds"], true, "{law}");
        // Of a fixed total only the limit of many photons is known, against which nothing is held.
        assert_eq!(found["comparisons"], if law == "fixed-total" { 0 } else { 5 }, "{law}");
    }
    let all = simulate(&folder, &[&flags[..], &["--against", "all"]].concat());
    let point = &all["points"][0];
    assert_eq!(point["classes"].as_array().unwrap().len(), 3);
    assert!(point["limit_accuracy"].is_null());
    let best = number(&performance(point, "likelihood-ratio")["accuracy"]);
    // Concrete is far away; the pair of skin and aluminium is right in 84 % of two thirds of the spectra.
    // 1000 test spectra of each class: a deviation of 0.6 points; 3.3 of them.
    assert!((best - (2.0 * 0.8413 + 1.0) / 3.0).abs() < 0.02, "{best}");

    let noisy = Folder::with(&format!("{THREE}[camera]\npreset = \"flir-a325sc\"\n"));
    let found = simulate(&noisy, &["--spectra", "4000"]);
    assert_eq!(found["camera_noise"], true);
    assert_eq!(found["judged_as"], "gaussian");
    assert!(number(&found["points"][0]["gamma"]) > 1e3);
    let silent = simulate(&noisy, &["--spectra", "400", "--shot-noise-only", "--photons", "1e6"]);
    assert_eq!(silent["camera_noise"], false);
}

/// A sweep covers N d₀² from 0.01 to 10 and writes its curves.
#[test]
fn a_sweep_writes_its_files() {
    let folder = Folder::with(THREE);
    let found = simulate(&folder, &["--spectra", "200", "--sweep", "3", "--out", "out"]);
    for (i, expected) in [0.01, 0.316_227_766, 10.0].into_iter().enumerate() {
        let normalised = number(&found["points"][i]["normalised_photons"]);
        assert!((normalised / expected - 1.0).abs() < 1e-6, "{normalised}");
    }
    for name in [
        "scenario.toml",
        "simulation.csv",
        "confusion.csv",
        "warnings.csv",
        "noise_curves.csv",
        "classifiers.png",
    ] {
        assert!(fs::metadata(folder.path().join("out").join(name)).unwrap().len() > 0, "{name}");
    }
}
