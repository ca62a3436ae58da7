//! `hadar reproduce`: the committed reports are what the code makes today, and every mistake is one line.

use crate::support::folder::{Folder, SCENARIO};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Numbers computed without any draw: the same on every machine but for the last digits of its exponentials.
const COMPUTED: f64 = 1e-6;
/// Shares of 2500 spectra of each class: a draw that falls on the other side of a rounding elsewhere moves them by 2e-4.
const DRAWN: f64 = 2e-3;
/// The network's are trained in single precision on such draws, and its epochs multiply small differences.
const TRAINED: f64 = 0.01;

/// Tables of which the quick form makes some rows; those of the others are told by their place.
const IN_PART: [&str; 9] = [
    "fig3b.csv",
    "figs7.csv",
    "figs7_mixed_noise.csv",
    "sic_thermometry.csv",
    "skin_thermometry.csv",
    "sic_errors.csv",
    "sic_rmse.csv",
    "skin_errors.csv",
    "skin_rmse.csv",
];

/// Whose numbers are of drawn pixels, readings or pairs: a fit ends at another last digit elsewhere.
const DRAWN_ITEMS: [&str; 9] =
    ["figs17/", "figs19/", "figs20/", "figs29/", "edfig1/", "edfig5/", "edfig7/", "edfig8/", "edfig9a/"];

/// What `all` makes.
const ITEMS: [&str; 19] = [
    "tabs2", "tabs5", "policy", "fig3c", "edfig9a", "figs17", "figs20", "edfig7", "edfig8", "figs29",
    "figs12", "edfig1", "edfig5", "figs19", "fig4", "edfig6", "edfig9", "figs7", "fig3b",
];

/// Rows of a CSV file: in part, by their first number and the classifier.
type Rows = BTreeMap<String, Vec<(String, String)>>;

fn rows(path: &Path) -> Rows {
    let mut reader =
        csv::Reader::from_path(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let in_part = IN_PART.iter().any(|name| path.ends_with(name));
    let header = reader.headers().unwrap().clone();
    let mut rows = Rows::new();
    for (i, record) in reader.records().map(Result::unwrap).enumerate() {
        let cells: Vec<(String, String)> =
            header.iter().zip(&record).map(|(a, b)| (a.to_owned(), b.to_owned())).collect();
        let named =
            |column: &str| cells.iter().find(|(name, _)| name == column).map(|(_, cell)| cell.clone());
        let key = match cells[0].1.parse::<f64>() {
            Ok(value) if in_part => format!("{value:.6e} {}", named("classifier").unwrap_or_default()),
            _ => i.to_string(),
        };
        assert!(rows.insert(key, cells).is_none(), "{}: row {i} comes twice", path.display());
    }
    rows
}

/// Every row of `made` is in `kept`, its numbers within what their kind allows.
fn compare(name: &str, made: &Rows, kept: &Rows) -> usize {
    let mut compared = 0;
    for (key, cells) in made {
        let old = kept.get(key).unwrap_or_else(|| panic!("{name}: the committed report has no row {key}"));
        let of_network = key.ends_with("network");
        for ((column, new), (_, old)) in cells.iter().zip(old) {
            let (Ok(a), Ok(b)) = (new.parse::<f64>(), old.parse::<f64>()) else {
                // Verdicts hold for all rows of a table together, and a quick one has fewer; training is in words.
                // A pixel that two categories fit may fall to the other one elsewhere.
                let free = ["against_the_limit", "training", "by_materials", "by_brightness"]
                    .contains(&column.as_str())
                    || column.starts_with("verdict");
                assert!(free || new == old, "{name}: {column} of {key} is {new}, was {old}");
                continue;
            };
            let ranging = name.starts_with("fig4/") || name.starts_with("figs12/");
            // No texture but rounding: an error beyond any depth, an information that is none.
            if ranging && (a.min(b) > 1e3 || a.max(b) < 1e-6) {
                continue;
            }
            let tolerance = match column.as_str() {
                // A match that falls on the other side of a rounding is elsewhere; so is a pixel that two materials fit.
                c if name == "figs19/errors.csv" || c.starts_with("error_over_sigma") => f64::INFINITY,
                _ if DRAWN_ITEMS.iter().any(|item| name.starts_with(item)) => DRAWN * (1.0 + b.abs()),
                // A draw that falls on the other side of a rounding sends a match elsewhere.
                c if name == "fig4/matched.csv" && c != "depth_m_truth" => f64::INFINITY,
                c if ranging && (c.starts_with("entropy") || c == "standard_deviation_with_noise_counts") => {
                    f64::INFINITY
                }
                "outliers" => 0.05,
                "rmse_m" | "bias_m" if ranging => 0.1 * (1.0 + b.abs()),
                c if ["accuracy", "accuracy_low", "accuracy_high"].contains(&c) => {
                    if of_network {
                        TRAINED
                    } else {
                        DRAWN
                    }
                }
                c if c.starts_with("information_bits") && key.contains(' ') => {
                    3.0 * if of_network { TRAINED } else { DRAWN }
                }
                c if c.starts_with("share_of_photons") => f64::INFINITY,
                // Estimates from draws: their own deviation is a hundredth of what they are.
                c if c.contains("bias")
                    || c.contains("rmse")
                    || c.contains("error")
                    || c.contains("over_bound") =>
                {
                    1e-3 * (1.0 + b.abs())
                }
                _ => COMPUTED * b.abs() + 1e-12,
            };
            assert!((a - b).abs() <= tolerance, "{name}: {column} of {key} is {a}, was {b}");
            compared += 1;
        }
    }
    compared
}

/// The quick form of everything.
#[test]
fn the_committed_reports_are_those_of_today() {
    are_those_of(&["reproduce", "all", "--quick", "--out", "new", "-q"]);
}

#[test]
#[ignore = "takes minutes; `.ci/evidence` runs it"]
fn the_committed_reports_are_those_of_today_in_full() {
    are_those_of(&["reproduce", "all", "--out", "new", "-q"]);
}

/// What is made, held against the committed reports; of the ledgers, whose sentences count experiments, those of the items that
/// the quick form makes whole.
fn are_those_of(arguments: &[&str]) {
    let folder = Folder::with(SCENARIO);
    let outcome = folder.run(arguments);
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    assert!(outcome.stdout.starts_with("Of "), "{}", outcome.stdout);
    let committed = hadar_testing::repository().join("reports");
    let mut numbers = 0;
    for item in ITEMS {
        for entry in fs::read_dir(folder.path().join("new").join(item)).unwrap() {
            let path = entry.unwrap().path();
            let file = path.file_name().unwrap().to_str().unwrap().to_owned();
            // Who made it of what is of the run that made it.
            if ["hadar.json", "report.html", "answer.txt"].contains(&file.as_str()) {
                continue;
            }
            let old = committed.join(item).join(&file);
            assert!(old.exists(), "{item}/{file} is not among the committed reports");
            let name = format!("{item}/{file}");
            match path.extension().and_then(|extension| extension.to_str()) {
                Some("csv") if file != "ledger.csv" => numbers += compare(&name, &rows(&path), &rows(&old)),
                Some("csv") if ["tabs2", "policy", "fig3c", "edfig6"].contains(&item) => {
                    assert_eq!(
                        fs::read_to_string(&path).unwrap(),
                        fs::read_to_string(&old).unwrap(),
                        "{name}"
                    );
                }
                Some("toml") => {
                    assert_eq!(
                        fs::read_to_string(&path).unwrap(),
                        fs::read_to_string(&old).unwrap(),
                        "{name}"
                    );
                }
                _ => {}
            }
        }
    }
    for item in ITEMS {
        for entry in fs::read_dir(committed.join(item)).unwrap() {
            let file = entry.unwrap().file_name();
            let made = folder.path().join("new").join(item).join(&file);
            assert!(made.exists(), "{item}/{} is not made any more", file.display());
        }
    }
    println!("{numbers} numbers compared");
    assert!(numbers > 10_000);
}

#[test]
fn every_mistake_is_one_line() {
    let folder = Folder::with(SCENARIO);
    for (items, said) in [
        (vec!["fig9"], "unknown figure or table `fig9`; choose among tabs2, tabs5, policy"),
        (vec!["library-figures"], "give it with --library FILE"),
        (vec!["priors", "library-figures", "--library", "a.csv"], "ask for it alone"),
        (vec!["all", "fig3b"], "`all` beside other names; write `all` alone"),
        (vec!["tabs2", "--out", "a.toml"], "part of the path is a file; name a folder"),
    ] {
        let message = folder.refusal(&[&["reproduce"], items.as_slice()].concat());
        assert!(message.contains(said), "{items:?}: {message}");
    }
}

/// One item, as an object: what the paper says, what comes out, and a verdict.
#[test]
fn the_ledger_is_there_for_programs() {
    let folder = Folder::with(SCENARIO);
    let found = folder.json(&["reproduce", "tabs2"]);
    let lines = found["ledger"].as_array().unwrap();
    let sigma = lines.iter().find(|line| line["quantity"] == "FLIR A325sc: sigma, counts").unwrap();
    assert_eq!(sigma["paper"], "1.77e6");
    assert_eq!(sigma["verdict"], "reproduced");
    let ours: f64 = sigma["ours"].as_str().unwrap().parse().unwrap();
    assert!((ours / 1.77e6 - 1.0).abs() < 0.02, "{ours}");
}
