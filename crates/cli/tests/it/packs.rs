//! The rules that come with the program: each number has a source, their own tests hold, and a threshold that is moved breaks one.

use crate::support::folder::Folder;
use hadar::material::Library;
use hadar_scenario::{Rule, Written};
use hadar_study::{Extent, FiguresMoved, RuleAsked, RuleStudy};
use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

/// All rules of `rules/`, and the example.
fn packs() -> Vec<(PathBuf, String)> {
    let root = hadar_testing::repository();
    let mut paths: Vec<PathBuf> = fs::read_dir(root.join("rules"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    paths.push(root.join("examples/rule_delivery_robots_at_night.toml"));
    paths.sort();
    paths.into_iter().map(|path| (path.clone(), fs::read_to_string(path).unwrap())).collect()
}

/// Tests of a rule that do not hold; all of them if it is refused.
fn broken(rule: &Rule, library: &Library) -> usize {
    let Ok(study) = RuleStudy::new(rule, library) else { return usize::MAX };
    let asked = RuleAsked { extent: Extent::Margins, ..RuleAsked::default() };
    let answer = study.answer(&asked, &|_, _| ()).unwrap();
    answer.tested().iter().filter(|test| !test.passes).count()
}

#[test]
fn tests_beside_the_rules_hold_and_every_figure_has_a_source() {
    let library = Library::embedded().unwrap();
    let packs = packs();
    assert!(packs.len() >= 6, "{packs:?}");
    for (path, text) in packs {
        let rule = Rule::from_toml(&text, Some(&path)).unwrap();
        assert!(!rule.tests.is_empty() && !rule.sources.is_empty(), "{}", path.display());
        assert_eq!(broken(&rule, &library), 0, "{}", path.display());
        for figure in rule.figures() {
            assert!(rule.sources.iter().any(|source| source.covers(&figure.key)), "{figure:?}");
        }
    }
}

/// Every figure of a demand or of a stop, a tenth larger, breaks a test of its rule.
#[test]
fn a_threshold_that_is_moved_breaks_a_test() {
    let library = Library::embedded().unwrap();
    for (path, text) in packs() {
        let rule = Rule::from_toml(&text, Some(&path)).unwrap();
        let mut moved = 0;
        for figure in rule.figures() {
            let leaf = figure.key.rsplit('.').next().unwrap();
            let threshold = figure.key.contains("requirement.") || figure.key.contains("stop.");
            // What a camera has to do at most at that speed is the example's last word on blur, which none of its tests is near.
            if !threshold || (leaf == "speed" && figure.key.contains("requirement.")) {
                continue;
            }
            let line = text.lines().nth(figure.line - 1).unwrap();
            let (key, value) = line.split_once('=').unwrap();
            let changed = format!("{key}={}", tenth_more(value));
            // A tenth of nothing.
            let digits = |text: &str| text.chars().filter(char::is_ascii_digit).all(|digit| digit == '0');
            if value.contains('0') && digits(value.split('#').next().unwrap()) {
                continue;
            }
            let mut lines: Vec<&str> = text.lines().collect();
            lines[figure.line - 1] = &changed;
            let changed_rule = Rule::from_toml(&lines.join("\n"), None).ok();
            // One camera before one clause is enough, if it breaks there.
            let breaks = changed_rule.is_none_or(|rule| broken(&alone(rule, &figure.key), &library) > 0);
            assert!(breaks, "{}: {changed} breaks nothing", path.display());
            moved += 1;
        }
        assert!(moved > 0, "{}", path.display());
    }
}

/// Every number of some packs, moved by a tenth either way, breaks a test of its rule or is listed with the reason why it decides nothing; what is
/// listed breaks none.
fn numbers_break_tests_or_are_listed(wanted: impl Fn(&str) -> bool) {
    let library = Library::embedded().unwrap();
    let list = fs::read_to_string(hadar_testing::repository().join("rules/decide_nothing.tsv")).unwrap();
    let listed: BTreeSet<(&str, &str)> = list
        .lines()
        .skip(1)
        .map(|line| line.split('\t').collect::<Vec<_>>())
        .inspect(|row| assert!(row.len() == 3 && row[2].len() > 10, "{row:?}"))
        .map(|row| (row[0], row[1]))
        .collect();
    for (path, text) in packs() {
        let name = path.file_stem().unwrap().to_str().unwrap();
        if !wanted(name) {
            continue;
        }
        let found = FiguresMoved::of(&Written::of(&text, Some(&path)), &library, false, &|_, _| ()).unwrap();
        let broken: BTreeSet<&str> = found
            .figures
            .iter()
            .filter(|moved| moved.breaks_a_test == Some(true))
            .map(|moved| moved.key.as_str())
            .collect();
        let decide: BTreeSet<&str> = found.figures.iter().map(|moved| moved.key.as_str()).collect();
        let idle: BTreeSet<(&str, &str)> = decide.difference(&broken).map(|key| (name, *key)).collect();
        let own: BTreeSet<(&str, &str)> = listed.iter().filter(|(rule, _)| *rule == name).copied().collect();
        assert_eq!(idle, own, "{name}");
    }
}

#[test]
fn every_number_of_a_pack_breaks_a_test_or_is_listed() {
    numbers_break_tests_or_are_listed(|name| name == "fever_screening");
}

/// Of all packs but one, whose rendered street takes half a minute for each number.
#[test]
#[ignore = "minutes: part of .ci/evidence"]
fn every_number_of_all_packs_breaks_a_test_or_is_listed() {
    numbers_break_tests_or_are_listed(|name| !name.contains("delivery_robots"));
}

/// The rule with its first camera alone, before the clause that a figure belongs to.
fn alone(mut rule: Rule, key: &str) -> Rule {
    let index = rule.clauses.iter().position(|clause| !clause.key.is_empty() && key.starts_with(&clause.key));
    let index = index.unwrap_or(0);
    rule.clauses = vec![rule.clauses.swap_remove(index)];
    rule.cameras.truncate(1);
    rule.tests.retain(|test| test.camera == 0 && test.clause.is_none_or(|clause| clause == index));
    rule.tests.iter_mut().for_each(|test| test.clause = test.clause.map(|_| 0));
    rule
}

/// All numbers of a value a tenth larger; of an inline table as well.
fn tenth_more(value: &str) -> String {
    let mut out = String::new();
    let mut number = String::new();
    let mut word = false;
    for char in value.chars().chain([' ']) {
        let digit = char.is_ascii_digit() || (char == '.' && !number.is_empty());
        if digit && !word {
            number.push(char);
            continue;
        }
        if !number.is_empty() {
            out += &format!("{}", 1.1 * number.parse::<f64>().unwrap());
            number.clear();
        }
        word = char.is_alphabetic() || char == '^' || (word && char.is_ascii_digit());
        out.push(char);
    }
    out
}

#[test]
fn a_figure_without_a_source_is_refused_by_its_line() {
    for (path, text) in packs() {
        let from = text.find("keys = [\"").unwrap() + "keys = [\"".len();
        let key = text[from..].split('"').next().unwrap().to_owned();
        // The first key of the first source is named by none any more.
        let without = match text[from + key.len() + 1..].starts_with(", ") {
            true => text.replacen(&format!("\"{key}\", "), "", 1),
            false => text.replacen(&format!("keys = [\"{key}\"]"), "keys = [\"title\"]", 1),
        };
        let error = Rule::from_toml(&without, Some(&path)).unwrap_err().to_string();
        assert!(error.contains("the figure has no source") && error.contains(&key), "{error}");
        assert!(error.contains(&format!("{}:", path.display())), "{error}");
    }
}

#[test]
fn sources_and_tests_as_a_user_sees_them() {
    let folder = Folder::with("");
    let pack = hadar_testing::repository().join("rules/fmvss_127_night.toml");
    let pack = pack.display().to_string();
    let sources = folder.run(&["rule", &pack, "--sources"]);
    assert_eq!((sources.code, sources.stderr.as_str()), (0, ""));
    insta::assert_snapshot!("fmvss_sources", sources.stdout);
    let json = folder.json(&["rule", &pack, "--sources"]);
    assert!(json["figures"].as_array().unwrap().len() > 30);
    assert_eq!(json["sources"][0]["mark"], "copy");

    let tests = folder.run(&["rule", &pack, "--test"]);
    assert_eq!((tests.code, tests.stderr.as_str()), (0, ""));
    assert!(tests.stdout.starts_with("All 20 tests of the rule hold.\n"), "{}", tests.stdout);
    let text = fs::read_to_string(&pack).unwrap();
    folder.file("moved.toml", &text.replacen("margin = 0.919", "margin = 0.95", 1));
    let moved = folder.run(&["rule", "moved.toml", "--test"]);
    assert_eq!(moved.code, 3);
    assert!(moved.stdout.starts_with("1 of 20 tests of the rule do not hold.\n"), "{}", moved.stdout);
    assert!(moved.stdout.contains("margin is 0.9209, not 0.9500"), "{}", moved.stdout);
    // A rule says on which days it holds.
    let fever = hadar_testing::repository().join("rules/fever_screening.toml").display().to_string();
    let early = folder.json(&["rule", &fever, "--on", "2016-11-23"]);
    assert_eq!(early["warnings"][0]["code"], "not-in-force");
    assert!(early["warnings"][0]["message"].as_str().unwrap().contains("it holds from 2017-09-25"));
    let later = folder.json(&["rule", &fever, "--on", "2017-09-25"]);
    assert!(later["warnings"].as_array().unwrap().iter().all(|warning| warning["code"] != "not-in-force"));
}
