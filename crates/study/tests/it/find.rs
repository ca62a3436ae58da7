//! Cameras that are found: the same without skipping, each met by the main job, and what cannot be asked is said.

use hadar::demand::{Skipping, Thing};
use hadar::material::Library;
use hadar_scenario::cameras::StatedCameras;
use hadar_scenario::{Rule, Scenario, Written};
use hadar_study::find::{Choice, FindAnswer, Why, find, find_for_rule};
use hadar_study::{OwnCameras, RuleAsked, RuleStudy, Study, YesNo};
use hadar_testing::seeded;
use proptest::prelude::*;
use std::path::Path;
use std::sync::OnceLock;

fn library() -> &'static Library {
    static LIBRARY: OnceLock<Library> = OnceLock::new();
    LIBRARY.get_or_init(|| Library::embedded().unwrap())
}

fn try_find(text: &str, own: &OwnCameras, folder: &Path, skipping: Skipping) -> Result<FindAnswer, String> {
    let scenario = Scenario::from_toml(text, Some(&folder.join("question.toml")));
    scenario.and_then(|scenario| find(&scenario, own, library(), skipping)).map_err(|error| error.to_string())
}

fn found(text: &str) -> FindAnswer {
    found_in(text, Path::new("."), Skipping::On)
}

fn found_in(text: &str, folder: &Path, skipping: Skipping) -> FindAnswer {
    try_find(text, &OwnCameras::default(), folder, skipping).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// A person at night; `task` stands in front of `[find]`, whose keys are `find`.
fn question(materials: &str, task: &str, find: &str) -> String {
    format!(
        "[target]\nmaterial = \"skin\"\ntemperature = \"33 degC\"\ndistance = \"30 m\"\n\
         [[environment]]\ntemperature = \"5 degC\"\nlighting = 0.6\n\
         [[environment]]\nmaterial = \"sky-us-standard\"\ntemperature = \"5 degC\"\nlighting = 0.4\n\
         [alternatives]\nmaterials = [{materials}]\n\
         [unknown]\nnuisances = [\"temperature\", \"lighting\"]\nlighting_total = 1.0\n{task}\n\
         [find]\n{find}\n"
    )
}

const LENS: &str = "lenses = [{ f_number = 1.0, focal_length = \"14 mm\" }]";

fn names(choice: &Choice) -> Vec<String> {
    choice
        .filters
        .iter()
        .map(|one| one.name.clone().unwrap_or_else(|| format!("{:?}", one.range_um)))
        .collect()
}

fn listed(answer: &FindAnswer) -> Vec<(String, Vec<String>, u32, f64, f64)> {
    let all = answer.listed.iter().chain(&answer.also);
    let round = |d: f64| (d * 1e5).round() / 1e5;
    all.map(|one| (one.camera.clone(), names(one), one.frames, round(one.lower), round(one.upper))).collect()
}

/// Filters of a file: (name, from, to) in µm.
fn filters(folder: &Path, filters: &[(&str, f64, f64)]) {
    let mut rows: Vec<f64> =
        filters.iter().flat_map(|(_, from, to)| [*from, from + 0.1, to - 0.1, *to]).collect();
    rows.sort_by(f64::total_cmp);
    rows.dedup();
    let head: Vec<&str> = filters.iter().map(|filter| filter.0).collect();
    let mut text = format!("wavelength_um,{}\n", head.join(","));
    for row in rows {
        let cells: Vec<String> = filters
            .iter()
            .map(|(_, from, to)| {
                let edge = ((row - from) / 0.1).min((to - row) / 0.1).clamp(0.0, 1.0);
                format!("{:.6}", 0.8 * edge)
            })
            .collect();
        text += &format!("{row},{}\n", cells.join(","));
    }
    std::fs::write(folder.join("mine.csv"), text).unwrap();
}

/// Every choice is gone through where nothing is skipped: the same cameras, filters, frames and distances.
#[test]
fn the_list_is_that_of_going_through_every_choice() {
    let folder = tempfile::tempdir().unwrap();
    filters(
        folder.path(),
        &[
            ("a", 8.0, 9.0),
            ("b", 8.6, 9.4),
            ("c", 9.2, 10.2),
            ("d", 10.0, 11.5),
            ("e", 11.2, 12.4),
            ("f", 8.0, 12.6),
            ("g", 12.0, 13.2),
        ],
    );
    for (materials, supply, camera) in [
        ("\"pmma\", \"aluminium\"", "{ from = \"mine.csv\", at_most = 3 }", "flir-boson-plus-640"),
        (
            "\"bare-metal\"",
            "{ from = \"mine.csv\", at_most = 2, place = \"sensor\", index = 2.0 }",
            "teledyne-geosnap-18-lw",
        ),
        ("\"pmma\"", "{ from = \"any\", at_most = 3, step = \"1.3 um\" }", "flir-tau-2-640"),
    ] {
        let text = question(
            materials,
            "[requirement]\ndistance = 1.0",
            &format!("cameras = [\"{camera}\"]\n{LENS}\nfilters = {supply}\nframes = [1, 64]"),
        );
        let [on, off] =
            [Skipping::On, Skipping::Off].map(|skipping| found_in(&text, folder.path(), skipping));
        assert_eq!(listed(&on), listed(&off), "{supply}");
        assert_eq!(on.met, off.met);
        assert_eq!(on.failed.len(), off.failed.len());
        assert!(on.met, "{supply}");
        // The bound is that of the distances: few choices are left to be judged.
        let judged = [&on, &off].map(|answer| answer.stats.computed(Thing::CameraChoices));
        assert!(judged[0] * 3 < judged[1], "{supply}: {judged:?}");
    }
}

/// What is listed is what the main job calls met, in time, and by no more filters and frames than were allowed.
#[test]
fn every_choice_that_is_listed_is_met_by_the_main_job() {
    let text = question(
        "\"plastic\"",
        "[requirement]\ndetection_probability = 0.95",
        &format!("{LENS}\nfilters = {{ at_most = 4 }}\nframes = [1, 16, 64]\ntime = \"3 s\""),
    );
    let answer = found(&text);
    assert!(answer.met && !answer.listed.is_empty());
    for choice in answer.listed.iter().chain(&answer.also) {
        let written = choice.scenario.to_toml();
        let again = Scenario::from_toml(&written, None).unwrap();
        let sizing = Study::new(&again, library()).unwrap().size().unwrap();
        assert_eq!(sizing.verdict.answer, Some(YesNo::Yes), "{written}");
        assert_eq!(sizing.verdict.lower, Some(choice.lower));
        assert_eq!(sizing.verdict.conditions, choice.verdict.as_ref().unwrap().conditions);
        assert!(choice.time_s <= 3.0 && choice.filters.len() <= 4 && [1, 16, 64].contains(&choice.frames));
    }
    // Nobody is told to buy what nobody sells.
    let sold =
        |name: &str| matches!(answer.failed.iter().find(|one| one.camera == name).unwrap().why, Why::NotSold);
    assert!(sold("ideal-pnrd") && sold("jwst-miri-sias"));
}

/// The first is the least in what is to be small, and none of the list is beaten in all of it.
#[test]
fn the_order_is_that_of_what_is_to_be_small() {
    for (least, of) in [("time", 0), ("filters", 1), ("aperture", 2)] {
        let text = question(
            "\"bare-metal\"",
            "",
            &format!(
                "cameras = [\"flir-*\", \"teledyne*\"]\n{LENS}\nleast = [\"{least}\"]\nfilters = {{ at_most = 3 }}"
            ),
        );
        let answer = found(&text);
        let figure = |one: &Choice| [one.time_s, one.filters.len() as f64, one.aperture_m][of];
        let best = figure(answer.best.as_ref().unwrap());
        assert_eq!(answer.listed.len(), 1);
        assert!(answer.also.iter().all(|one| figure(one) >= best * (1.0 - 1e-9)), "{least}");
    }
}

#[test]
fn a_price_counts_and_one_that_is_not_known_is_last() {
    let text = question(
        "\"bare-metal\"",
        "",
        &format!("cameras = [\"flir-*\", \"teledyne*\"]\n{LENS}\nleast = [\"price\"]"),
    );
    let answer = found(&text);
    let best = answer.best.unwrap();
    let most = |one: &Choice| one.price.as_ref().map_or(f64::INFINITY, |price| price.range[1]);
    assert!(most(&best).is_finite() && best.price_without.contains(&"filters"));
    assert!(answer.also.iter().all(|one| most(one) >= most(&best)));
}

#[test]
fn where_none_meets_the_nearest_is_told_with_what_it_would_have_to_be() {
    let text = question(
        "\"plastic\"",
        "[requirement]\ndetection_probability = 0.999999",
        &format!("cameras = [\"flir-boson-*\"]\n{LENS}\nframes = [1, 4]\nfilters = {{ at_most = 4 }}"),
    );
    let answer = found(&text);
    assert!(!answer.met && answer.best.is_none() && answer.listed.is_empty());
    let near = answer.near.unwrap();
    assert!(near.choice.upper < answer.required_distance && near.solve_for.is_some());
    // What every camera reaches at most is no less than what the nearest does.
    let most = answer.failed.iter().filter_map(|one| one.upper).fold(0.0, f64::max);
    assert!(most >= near.choice.lower);
}

/// Errors that the pixels of an object share are in what is found: nothing is recommended that they undo.
#[test]
fn shared_errors_of_an_object_are_heeded() {
    let of = |more: &str| {
        let text = question(
            "\"pmma\"",
            &format!("[requirement]\ndetection_probability = 0.95\n{more}"),
            &format!(
                "cameras = [\"flir-boson-plus-640\"]\n{LENS}\nframes = [1]\nfilters = {{ from = \"any\", step = \"1.2 um\", at_most = 3 }}"
            ),
        );
        found(&text.replace("\"30 m\"\n[[", "\"30 m\"\npixels = [40, 10]\n[["))
    };
    let without = of("");
    assert!(without.met);
    let with = of("[sensitivity]\nemissivity_error = \"0.005 absolute\"");
    assert!(!with.met, "{:?}", with.best);
}

#[test]
fn what_cannot_be_asked_is_told_in_a_line() {
    let folder = tempfile::tempdir().unwrap();
    filters(folder.path(), &[("short", 3.0, 4.0), ("too", 4.0, 5.0)]);
    std::fs::write(folder.path().join("twice.csv"), "wavelength_um,a,a\n8,0.1,0.1\n9,0.1,0.1\n").unwrap();
    let own = |price: &str| {
        let file = folder.path().join("own.toml");
        let text =
            format!("[[camera]]\nname = \"ours\"\npreset = \"flir-boson-plus-640\"\nprice = \"{price}\"\n");
        std::fs::write(&file, text).unwrap();
        drop(StatedCameras::from_written(&Written::from_file(&file).unwrap()).unwrap());
        OwnCameras::from_files(&[file]).unwrap()
    };
    let none = OwnCameras::default();
    let boson = format!("cameras = [\"flir-boson-plus-640\"]\n{LENS}");
    let cases: [(&str, String, &OwnCameras, &str); 13] = [
        ("", "cameras = [\"no-such\"]".into(), &none, "find.cameras[0]: there is no camera `no-such`"),
        ("", "cameras = [\"snspd*\"]\nkind = \"uncooled\"".into(), &none, "find.cameras: no camera is left"),
        (
            "",
            format!("{boson}\nfilters = {{ from = \"mine.csv\" }}"),
            &none,
            "find.filters: no filter lies within the range",
        ),
        (
            "",
            format!("{boson}\nfilters = {{ from = \"twice.csv\" }}"),
            &none,
            "another filter is called `a` too",
        ),
        ("", format!("{boson}\nfilters = {{ from = \"none.csv\" }}"), &none, "none.csv"),
        (
            "",
            format!("{boson}\nfilters = {{ from = \"any\", place = \"lens\" }}"),
            &none,
            "the place of filters whose edges are ideal",
        ),
        (
            "",
            format!("{boson}\nfilters = {{ place = \"sensor\" }}"),
            &none,
            "a filter before the sensor without its index",
        ),
        ("", format!("{boson}\nframes = []"), &none, "the list is empty"),
        ("", format!("{boson}\nleast = [\"weight\"]"), &none, "`weight` is not known here"),
        ("[requirement]\nby = \"local\"", boson.clone(), &none, "is no limit"),
        (
            "[requirement]\ntime = \"1 s\"",
            format!("{boson}\ntime = \"2 s\""),
            &none,
            "requirement.time is given as well",
        ),
        (
            "[camera]\npreset = \"flir-boson-plus-640\"",
            boson.clone(),
            &none,
            "the camera is flir-boson-plus-640 already",
        ),
        ("[bands]\nranges = [[\"8 um\", \"9 um\"]]", boson, &none, "the bands are given"),
    ];
    for (task, find, own, said) in &cases {
        let error =
            try_find(&question("\"aluminium\"", task, find), own, folder.path(), Skipping::On).unwrap_err();
        assert!(error.contains(said) && !error.contains('\n'), "{find}: {error}");
    }
    let both = format!("cameras = [\"ours\", \"flir-boson-plus-640\"]\n{LENS}");
    let text = question("\"aluminium\"", "", &both);
    let error = try_find(&text, &own("100 to 300 EUR"), folder.path(), Skipping::On).unwrap_err();
    assert!(error.contains("prices in EUR and in USD"), "{error}");
    let cheap = try_find(&text, &own("100 to 300 USD"), folder.path(), Skipping::On).unwrap();
    assert_eq!(cheap.best.unwrap().camera, "ours");
    // A time in which not one reading fits is said of the camera.
    let late = found(&question(
        "\"aluminium\"",
        "",
        &format!("cameras = [\"flir-boson-plus-640\"]\n{LENS}\ntime = \"1 ms\""),
    ));
    assert!(matches!(late.failed[0].why, Why::Time { .. }));
}

proptest! {
    #![proptest_config(seeded(44, 6))]

    /// Fewer filters to choose from, fewer frames and less time never find what more do not, and never tell more.
    #[test]
    fn less_to_choose_from_is_never_better(seed in 0u64..1000, at_most in 1u32..4, ratio in 0.05f64..1.5) {
        let folder = tempfile::tempdir().unwrap();
        let edge = |i: u64| 8.0 + 0.37 * ((seed + 3 * i) % 11) as f64;
        let all: Vec<(String, f64, f64)> =
            (0..6).map(|i| (format!("f{i}"), edge(i), edge(i) + 0.5 + 0.2 * ((seed + i) % 4) as f64)).collect();
        let of = |count: usize, most: u32, frames: &str, time: &str| {
            let some: Vec<(&str, f64, f64)> = all.iter().take(count).map(|(name, a, b)| (name.as_str(), *a, *b)).collect();
            filters(folder.path(), &some);
            let find = format!("cameras = [\"teledyne-geosnap-18-lw\"]\n{LENS}\nfilters = {{ from = \"mine.csv\", at_most = {most} }}\nframes = {frames}\n{time}");
            let text = question("\"pmma\", \"aluminium\"", &format!("[requirement]\ndistance = {}", 4.0 * ratio), &find);
            found_in(&text, folder.path(), Skipping::On)
        };
        let whole = of(6, at_most + 1, "[1, 4, 16]", "");
        for less in [of(5, at_most + 1, "[1, 4, 16]", ""), of(6, at_most, "[1, 4, 16]", ""), of(6, at_most + 1, "[1, 4]", ""), of(6, at_most + 1, "[1, 4, 16]", "time = \"0.2 s\"")] {
            prop_assert!(whole.met || !less.met);
            let fewest = |answer: &FindAnswer| answer.listed.iter().map(|one| one.filters.len()).min();
            if let (Some(whole), Some(less)) = (fewest(&whole), fewest(&less)) {
                prop_assert!(whole <= less);
            }
            for choice in &less.listed {
                prop_assert!(choice.lower >= less.required_distance && choice.lower <= choice.upper * (1.0 + 1e-12));
            }
        }
    }
}

/// A rule over ranges of scenes: what is listed meets it as `hadar rule` judges, and a camera that meets its first scene alone is none.
#[test]
fn what_is_found_for_a_rule_meets_it_everywhere() {
    let text = |envelope: &str, find: &str| {
        format!(
            "[target]\nmaterial = \"skin\"\ntemperature = \"33 degC\"\ndistance = \"10 m\"\n\
             [[environment]]\ntemperature = \"5 degC\"\nlighting = 0.5\n\
             [alternatives]\nmaterials = [\"pmma\", \"aluminium\"]\n[requirement]\ndetection_probability = 0.9\n\
             {envelope}\n[find]\ncameras = [\"flir-boson-plus-640\", \"teledyne-geosnap-18-lw\"]\n{LENS}\n{find}\n"
        )
    };
    let envelope = "[envelope]\ntemperature = [\"12 degC\", \"34 degC\"]\nlighting = [0.2, 0.9]";
    let find = "frames = [1, 16, 64]\nfilters = { at_most = 4 }";
    let rule = Rule::from_toml(&text(envelope, find), None).unwrap();
    let answer = find_for_rule(&rule, &OwnCameras::default(), library(), Skipping::On).unwrap();
    assert!(answer.met && answer.scenes > 1, "{}", answer.scenes);
    for choice in answer.listed.iter().chain(&answer.also) {
        let again = Rule::from_toml(&choice.rule.as_ref().unwrap().to_toml(), None).unwrap();
        let study = RuleStudy::new(&again, library()).unwrap();
        let judged = study.answer(&RuleAsked::default(), &|_, _| ()).unwrap();
        assert!(judged.cameras[0].passes);
        assert!(choice.lower >= choice.required_distance);
        // The conditions are those of the rule.
        assert_eq!(judged.cameras[0].conditions, choice.conditions());
    }
    // The first scene alone asks for less.
    let alone = found(&text("", find));
    let least = |answer: &FindAnswer| {
        let all = answer.listed.iter().chain(&answer.also);
        all.filter(|one| one.camera == "flir-boson-plus-640")
            .map(|one| one.frames * one.filters.len() as u32)
            .min()
    };
    assert!(least(&alone) < least(&answer).or(Some(u32::MAX)), "{:?} {:?}", least(&alone), least(&answer));
    // A rule without a camera is no rule to be judged.
    let error = RuleStudy::new(&rule, library()).unwrap_err().to_string();
    assert!(error.contains("the rule has no camera to check") && error.contains("hadar find"), "{error}");
    let error = Rule::from_toml(&text(envelope, find).replace("[find]", "[sensitivity]\n[find2]"), None);
    assert!(error.is_err());
}
