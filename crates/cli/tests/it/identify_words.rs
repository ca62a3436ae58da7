//! The words of `hadar identify`: what leads, and what is said of ranges, presets, skies, priors and trials.

use crate::support::answers::{FIVE, LIBRARY};
use crate::support::folder::{Folder, SCENARIO};

#[track_caller]
fn said(scenario: &str, flags: &[&str]) -> String {
    let outcome = Folder::with(scenario).run(&[&["identify", "a.toml"], flags].concat());
    assert_eq!((outcome.code, outcome.stderr.as_str()), (0, ""));
    outcome.stdout
}

#[test]
fn what_was_asked_for_comes_first() {
    let lead =
        "The camera distinguishes 7 of 10 pairs with a probability of 84.1 %, either of them the target\n";
    let (apart, matrix) = (said(FIVE, &["--apart"]), said(FIVE, &["--matrix"]));
    assert!(apart.starts_with(lead) && matrix.starts_with(lead), "{apart}\n{matrix}");
    let table = "  distances per sqrt(photon), the nearest proved to 1e-6 of it; photons by shot noise alone; camera d: statistical distance, required 1.000\n";
    assert!(!apart.contains(table) && matrix.contains(table), "{apart}\n{matrix}");
    let chains = "Chains: groups connected by pairs that are not distinguished\n  1   (4) skin, aluminium, pmma, concrete\n";
    let clusters =
        "distinguished; members of different clusters may still be confused\n  1   (2) skin, aluminium\n";
    assert!(apart.contains(chains) && apart.contains(clusters), "{apart}");
    // Where the groups are the same nothing more is said.
    let two = FIVE.replace(
        "\"aluminium\", \"fused-silica\", \"pmma\", \"concrete\"",
        "\"aluminium\", \"fused-silica\"",
    );
    let apart = said(&two, &["--apart"]);
    assert!(apart.contains("no two members are distinguished\n") && !apart.contains("Chains"), "{apart}");
}

#[test]
fn certain_is_only_what_is_certain() {
    for (wanted, words) in [("0.999999", "99.9999 %"), ("0.99", "99.0 %"), ("0.9995", "99.95 %")] {
        let scenario = FIVE.to_owned() + &format!("[requirement]\ndetection_probability = {wanted}\n");
        assert!(
            said(&scenario, &["--apart"]).contains(&format!("with a probability of {words}")),
            "{wanted}"
        );
        let said = Folder::with(&scenario).run(&["identify", "a.toml", "--check"]).stdout;
        assert!(said.ends_with(&format!("with a probability of {words}.\n")), "{said}");
    }
}

#[test]
fn an_edge_is_a_warning_only_where_the_scenario_set_it() {
    let named = |range: &str| FIVE.replace("\"concrete\"]", &format!("\"concrete\"]\n{range}"));
    assert!(!said(FIVE, &[]).contains("nearest-at-edge"));
    let lit = said(&named("lighting = [0.0, 0.7]"), &[]);
    assert!(lit.contains("[nearest-at-edge]") && lit.contains("(lighting of the surroundings)"), "{lit}");
    let warm = said(&named("temperature = [\"0 degC\", \"100 degC\"]"), &[]);
    assert!(
        warm.contains(
            "skin against aluminium: the closest confuser is at the edge of its range (temperature)"
        ),
        "{warm}"
    );
    // The other end is as physical as before.
    assert!(!said(&named("lighting = [0.05, 1.0]"), &[]).contains("nearest-at-edge"));
}

#[test]
fn a_changed_preset_and_skies_left_out_are_said() {
    let changed = SCENARIO.replace(
        "preset = \"flir-a325sc\"",
        "preset = \"flir-a325sc\"\nexposure = \"20 ms\"\nnetd = \"20 mK\"",
    );
    assert!(
        said(&changed, &[]).starts_with(
            "No: flir-a325sc with exposure, netd changed cannot distinguish skin from aluminium"
        )
    );
    assert!(said(SCENARIO, &[]).starts_with("No: flir-a325sc cannot distinguish"));
    let skies = "skies of the library are surroundings, not alternatives: sky-midlatitude-summer, ";
    assert!(said(LIBRARY, &["--apart"]).contains(skies) && !said(SCENARIO, &[]).contains("skies"));
}

#[test]
fn averages_over_priors_lead_where_the_nominal_state_is_blind() {
    let scenario = SCENARIO
        .replace("37 degC", "20 degC")
        .replace("lighting = 0.5", "lighting = 1.0")
        .replace("[camera]", "[unknown]\npriors = { temperature = \"1 K\", lighting = 0.1 }\n[camera]");
    assert!(!said(&scenario, &["--by", "local"]).contains("Averaged"));
    let text = said(&scenario, &["--by", "local", "--average"]);
    let lines: Vec<&str> = text.lines().collect();
    assert!(
        lines[0].starts_with("With the camera (")
            && lines[0].contains(" the best test distinguishes skin from aluminium in "),
        "{text}"
    );
    let averaged = "Averaged over the priors of both, to distinguish skin from aluminium with a probability of 84.1 % it takes between ";
    assert!(lines[1].starts_with(averaged), "{text}");
    assert_eq!(lines[3], "At exactly 20.00 degC and V 1.00:");
    assert!(lines[4].starts_with("No: ") && text.contains("no number of photons suffices"), "{text}");
}

/// The limit without a bracket where something has no prior, which is said; and what a simulation of it is told.
#[test]
fn averages_say_what_has_no_prior() {
    let scenario = SCENARIO.replace("[camera]", "[unknown]\npriors = { temperature = \"1 K\" }\n[camera]");
    let text = said(&scenario, &["--average"]);
    assert!(
        text.starts_with("With the camera (") && text.contains("no test distinguishes skin from"),
        "{text}"
    );
    assert!(text.contains("it takes at least ") && text.contains("how many suffice is not known"), "{text}");
    assert!(text.contains("No prior is stated for: lighting."), "{text}");
}

#[test]
fn trials_that_end_too_early_are_a_warning() {
    let short = said(SCENARIO, &["--exact", "--trials", "128"]);
    assert!(short.contains("[trials-ended] 1 of 1 simulations ended after 128 trials of a state"), "{short}");
    assert!(short.contains("raise --trials, or ask for less with --half-width"), "{short}");
    assert!(!said(SCENARIO, &["--exact", "--half-width", "0.2"]).contains("trials-ended"));
}

#[test]
fn nothing_is_replaced_in_a_library_of_its_own() {
    let folder = Folder::with(SCENARIO);
    std::fs::create_dir_all(folder.path().join("own")).unwrap();
    for (name, e) in [("skin", 0.9), ("aluminium", 0.3), ("copper", 0.1)] {
        folder.file(
            &format!("own/{name}.csv"),
            &format!("wavenumber_cm1,emissivity\n600,{e}\n1400,{}\n", 0.9 * e),
        );
    }
    let alone = folder.run(&["identify", "a.toml", "--library", "own", "--only-library"]);
    assert_eq!((alone.code, alone.stderr.as_str()), (0, ""));
    let beside = folder.run(&["identify", "a.toml", "--library", "own"]);
    assert_eq!(beside.stderr.matches("is replaced by").count(), 3, "{}", beside.stderr);
}
