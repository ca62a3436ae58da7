//! What is computed and what is not: answers with and without skipping, and a ledger that is true.

use crate::support::folder::{Folder, Outcome, SCENARIO};
use hadar::demand::{Reason, Skipping, Thing};
use hadar::fisher::{Nuisance, Unknowns};
use hadar::material::Library;
use hadar_scenario::Scenario;
use hadar_study::{Asked, Study, Watch};
use serde_json::Value;

/// Four materials, a camera that tells some of them.
const FOUR: &str = r#"[target]
material = "skin"
temperature = "60 degC"
[[environment]]
temperature = "20 degC"
lighting = 0.5
[alternatives]
materials = ["aluminium", "fused-silica", "concrete"]
[bands]
step = "2 cm^-1"
[camera]
exposure = "1 us"
pixel = "12 um"
f_number = 1.3
focal_length = "18 mm"
noise_electrons = 0
"#;

/// What an average is over.
const PRIORS: &str = "unknown.priors={ temperature = \"1 K\", lighting = 0.1 }";

fn count(stats: &Value, thing: &str, what: &str) -> u64 {
    stats[thing][what].as_u64().unwrap_or_else(|| panic!("no {what} of {thing} in {stats}"))
}

/// Every line adds up.
#[track_caller]
fn adds_up(stats: &Value) {
    let lines = stats.as_object().expect("a ledger");
    assert!(!lines.is_empty());
    for (thing, line) in lines {
        let spared: u64 = line["spared"].as_object().unwrap().values().map(|n| n.as_u64().unwrap()).sum();
        assert_eq!(count(stats, thing, "possible"), count(stats, thing, "computed") + spared, "{thing}");
    }
}

/// The answer without the ledger.
fn bare(mut answer: Value) -> Value {
    adds_up(&answer["stats"]);
    answer.as_object_mut().unwrap().remove("stats");
    answer
}

/// Every command has its ledger, on stderr and in the JSON, and says the same with `--no-skip`.
#[test]
fn every_command_says_what_it_took_and_answers_the_same_in_full() {
    let folder = Folder::with(FOUR);
    for arguments in [
        &["size", "a.toml"][..],
        &["identify", "a.toml"],
        &["identify", "a.toml", "--apart"],
        &["identify", "a.toml", "--check"],
        &["identify", "a.toml", "--check", "--by", "local"],
        &["identify", "a.toml", "--matrix", "--scaling", "--bands", "2"],
        &["identify", "a.toml", "--exact", "--photons", "1e4", "--half-width", "0.1", "--trials", "128"],
        &["simulate", "a.toml", "--classifiers", "likelihood-ratio", "--spectra", "40"],
        &["simulate", "a.toml", "--skip-spectra", "--spectra", "40", "--against", "concrete"],
        &["simulate", "a.toml", "--thermometry", "60 degC", "--spectra", "4"],
        &["simulate", "a.toml", "--average", "--set", PRIORS, "--spectra", "40"],
        &["materials", "list"],
        &["materials", "show", "gold"],
        &["cameras", "list"],
        &["cameras", "show", "flir-a325sc"],
    ] {
        let of = |more: &[&str]| folder.run(&[arguments, more].concat());
        let (plain, stats) = (of(&[]), of(&["--stats"]));
        assert_eq!(plain.stdout, stats.stdout, "{arguments:?}");
        let ledger = stats.stderr.strip_prefix(&plain.stderr).unwrap_or(&stats.stderr);
        assert!(ledger.contains("possible  computed"), "{arguments:?}: {}", stats.stderr);
        let json = |more: &[&str]| -> Value {
            let outcome = of(&[&["--json"], more].concat());
            serde_json::from_str(&outcome.stdout)
                .unwrap_or_else(|error| panic!("{error}: {}", outcome.stderr))
        };
        // Where no proof could spare anything there is no such flag.
        if !["materials", "cameras"].contains(&arguments[0]) {
            assert_eq!(bare(json(&[])), bare(json(&["--no-skip"])), "{arguments:?}");
            assert_eq!(of(&["--no-skip"]).code, plain.code, "{arguments:?}");
        }
        let quiet = of(&["--stats", "-q"]);
        assert_eq!(quiet.stderr, "", "{arguments:?}");
    }
}

/// `size --check` says yes or no by the cheapest proofs, as the whole answer does.
#[test]
fn size_checks_by_proofs_what_it_finds_in_full() {
    for exposure in ["1 ns", "1 us", "1 s"] {
        let folder = Folder::with(&FOUR.replace("1 us", exposure));
        let quick = folder.run(&["size", "a.toml", "--check", "--json"]);
        let full = folder.run(&["size", "a.toml", "--check", "--no-skip", "--json"]);
        let report = folder.run(&["size", "a.toml", "--check", "--json", "--out", "out", "-q"]);
        assert_eq!((quick.code, quick.code), (full.code, report.code), "{exposure}");
        let parsed = |outcome: &Outcome| serde_json::from_str::<Value>(&outcome.stdout).unwrap();
        let (quick, full, report) = (parsed(&quick), parsed(&full), parsed(&report));
        assert_eq!(quick["verdict"]["met"], full["verdict"]["met"]);
        assert_eq!(bare(full.clone()), bare(report));
        let said = folder.run(&["size", "a.toml", "--check"]).stdout;
        // A program is given the whole answer, with skipping or without; text of a 'no' is one line, decided by proofs.
        assert_eq!(bare(quick.clone()), bare(full));
        let yes = quick["verdict"]["met"] == true;
        let first = if yes { "Yes, if " } else { "No" };
        assert!(
            said.starts_with(first) && (yes || said.lines().count() == 1) && quick["pairs"].is_array(),
            "{said}"
        );
    }
    let without = FOUR[..FOUR.find("[camera]").unwrap()].to_owned();
    let folder = Folder::with(&without);
    assert_eq!(folder.run(&["size", "a.toml", "--check"]).code, 3);
}

/// Counts of a small case by hand.
#[test]
fn the_ledger_counts_what_was_done() {
    let library = Library::embedded().unwrap();
    let all = library.names().count() as u64;
    assert_eq!((library.work().computed(Thing::LibrarySpectra), all), (0, 68));
    let study = Study::new(&Scenario::from_toml(FOUR, None).unwrap(), &library).unwrap();
    let looked_up = library.work();
    // The four, and what three of them are made of.
    assert!((4..8).contains(&looked_up.computed(Thing::LibrarySpectra)), "{looked_up:?}");
    assert_eq!(looked_up.possible(Thing::LibrarySpectra), all);

    let asked = Asked {
        matrix: false,
        apart: false,
        skipping: Skipping::On,
        scaling: false,
        bands: None,
        exact: None,
        average: false,
    };
    let answer = |asked: &Asked| study.answer(asked, &Watch::NONE).unwrap().identification.stats;
    let work = answer(&asked);
    assert_eq!((work.possible(Thing::Sections), work.computed(Thing::Sections)), (7, 1));
    // For each alternative by shot noise, back, and by the camera; 64 draws of the emissivities of the hardest pair that is told, and the
    // pair without; local, and local with unknown gain.
    assert_eq!(work.computed(Thing::NearestSearches), 3 * 3 + 65);
    assert_eq!(work.computed(Thing::LocalDistances), 2 * 3);
    let columns = |nuisances: &[Nuisance]| {
        let unknowns = Unknowns::new(nuisances.iter().copied()).unwrap();
        unknowns.parameters(study.surroundings().objects().len()).len() as u64 + 1
    };
    let own = [Nuisance::Temperature, Nuisance::Lighting];
    let formed = 3 * (columns(&own) + columns(&[own[0], own[1], Nuisance::Gain]));
    assert_eq!(work.computed(Thing::DerivativeColumns), formed);
    let every = [own[0], own[1], Nuisance::Gain, Nuisance::EnvironmentTemperature];
    assert_eq!(work.possible(Thing::DerivativeColumns), 6 * columns(&every));

    // Six pairs, both ways.
    for skipping in [Skipping::On, Skipping::Off] {
        let more = answer(&Asked { apart: true, skipping, ..asked });
        assert_eq!(more.possible(Thing::NearestSearches), 9 + 65 + 12);
        let all = more.computed(Thing::NearestSearches) == 9 + 65 + 12;
        assert_eq!(all, skipping == Skipping::Off);
    }
    let matrix = answer(&Asked { matrix: true, ..asked });
    assert_eq!(matrix.computed(Thing::NearestSearches), 9 + 65 + 12 + 12);
    assert_eq!(matrix.computed(Thing::LocalDistances), 6 + 12);
    // Nuisances of each target are formed once, for three alternatives.
    let shared = 2 * (12 - 4);
    assert_eq!(matrix.spared(Thing::DerivativeColumns, Reason::Shared), shared);
}

/// Draws and files, against what stands in the answer and in the folder.
#[test]
fn draws_and_files_are_counted_as_they_are() {
    let folder = Folder::with(FOUR);
    let exact = folder.json(&["identify", "a.toml", "--exact", "--photons", "1e4", "--half-width", "0.03"]);
    let pairs = exact["exact"]["pairs"].as_array().unwrap();
    let of_pairs: u64 = pairs.iter().map(|pair| pair["trials"].as_u64().unwrap()).sum();
    let drawn = of_pairs + exact["exact"]["library"]["trials"].as_u64().unwrap();
    assert_eq!(count(&exact["stats"], "trials", "computed"), drawn);
    assert_eq!(count(&exact["stats"], "trials", "possible"), 7_000_000);

    for (names, trained, spectra) in [("likelihood-ratio", 0, 20), ("likelihood-ratio,discriminant", 1, 40)] {
        let found = folder.json(&["simulate", "a.toml", "--classifiers", names, "--spectra", "40"]);
        let judged: f64 = found["points"][0]["performances"][0]["confusion"]["decisions"]
            .as_array()
            .unwrap()
            .iter()
            .flat_map(|row| row.as_array().unwrap())
            .map(|n| n.as_f64().unwrap())
            .sum();
        assert_eq!(judged, 2.0 * 20.0);
        let stats = &found["stats"];
        assert_eq!(count(stats, "trained_classifiers", "computed"), trained);
        assert_eq!(
            (count(stats, "spectra", "computed"), count(stats, "spectra", "possible")),
            (2 * spectra, 80)
        );
    }

    let folder = Folder::with(SCENARIO);
    let bare = folder.json(&["size", "a.toml"]);
    assert_eq!(
        (count(&bare["stats"], "reports", "possible"), count(&bare["stats"], "reports", "computed")),
        (1, 0)
    );
    let found = folder.json(&["size", "a.toml", "--out", "out", "-q"]);
    let drawn = folder.files().iter().filter(|name| name.ends_with(".svg")).count() as u64;
    // Four of the limiting pair, and the trade-off curves.
    let figures = 4 + found["trade_offs"].as_array().unwrap().len() as u64;
    assert!(figures > 4);
    assert_eq!((count(&found["stats"], "figures", "computed"), drawn), (figures, figures));
    assert_eq!(count(&found["stats"], "reports", "computed"), 1);
    let only = folder.json(&["materials", "show", "gold"]);
    assert_eq!(count(&only["stats"], "library_spectra", "computed"), 1);
}
