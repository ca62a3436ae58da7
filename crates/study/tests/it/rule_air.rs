//! Air within wide bands: the worst distance need not be an end of its range, and the nearest may be the worst; which it is, is
//! proved.
//!
//! The distances held against were found by another program (a least-squares search over the states of both materials,
//! at distances of its own): fabric against Kapton tape in three bands falls from d = 2.149 at 10 m to 0.0297 at 1 km and
//! rises to 0.840 at 3 km; skin against PMMA is at 2.1564 at 10 m and at 2.903 at 1 km.

use hadar::material::Library;
use hadar_scenario::Rule;
use hadar_study::{CameraVerdict, Proof, RuleAsked, RuleStudy};

fn rule(target: &str, others: &str, range: [&str; 2], demanded: f64, more: &str) -> String {
    let [nearest, farthest] = range;
    format!(
        "[target]\nmaterial = \"{target}\"\ntemperature = \"33 degC\"\n\
         [[environment]]\ntemperature = \"10 degC\"\nlighting = 0.5\n\
         [atmosphere]\nmodel = \"tropical\"\ntemperature = \"300 K\"\n\
         [alternatives]\nmaterials = [{others}]\ntemperature = [\"200 K\", \"450 K\"]\n\
         [bands]\nranges = [[\"714.5 cm^-1\", \"893.5 cm^-1\"], [\"893.5 cm^-1\", \"1072.5 cm^-1\"], \
         [\"1072.5 cm^-1\", \"1250.5 cm^-1\"]]\n\
         [requirement]\ndistance = {demanded}\n{more}[envelope]\ndistance = [\"{nearest}\", \"{farthest}\"]\n\
         [[camera]]\nname = \"camera\"\nexposure = \"10 ms\"\npixel = \"12 um\"\nf_number = 1.0\n\
         focal_length = \"24 mm\"\nnetd = \"30 mK\"\nnetd_temperature = \"30 degC\"\nnetd_f_number = 1.0\nframes = 100\n"
    )
}

fn answered(text: &str) -> CameraVerdict {
    let rule = Rule::from_toml(text, None).unwrap();
    let study = RuleStudy::new(&rule, &Library::embedded().unwrap()).unwrap();
    let answer = study.answer(&RuleAsked::default(), &|_, _| ()).unwrap();
    answer.only().unwrap().cameras[0].clone()
}

fn judged(target: &str, other: &str, farthest: &str, demanded: f64) -> CameraVerdict {
    answered(&rule(target, &format!("\"{other}\""), ["10 m", farthest], demanded, ""))
}

#[test]
fn the_worst_distance_may_be_between_the_ends() {
    let verdict = judged("fabric", "kapton-tape", "3000 m", 0.5);
    assert!(!verdict.passes && verdict.statistical_distance < 0.03, "{verdict:?}");
    let distance_m = verdict.limiting.distance_m.unwrap();
    assert!((800.0..1200.0).contains(&distance_m), "{distance_m}");
    // How far below the requirement is not proved.
    assert_ne!(verdict.certificate.kind, Proof::BranchAndBound);
}

#[test]
fn the_nearest_distance_may_be_the_worst() {
    let verdict = judged("skin", "pmma", "1000 m", 2.4);
    assert!(!verdict.passes, "{verdict:?}");
    assert!((verdict.statistical_distance / 2.157_949_5 - 1.0).abs() < 1e-6, "{verdict:?}");
    assert!((verdict.limiting.distance_m.unwrap() / 10.0 - 1.0).abs() < 1e-9);
    assert_eq!(verdict.certificate.kind, Proof::BranchAndBound, "{verdict:?}");
    let lower = verdict.lower_bound.unwrap();
    assert!(
        lower <= verdict.statistical_distance && lower >= 0.99 * verdict.statistical_distance,
        "{verdict:?}"
    );
}

/// From no distance of the range, each judged alone, is the worst scene below what is proved of all: with temperatures and lighting in
/// ranges, for targets that fill the pixel and such that do not, in wide bands and in those of one node.
#[test]
fn no_distance_of_the_range_is_below_the_bound() {
    let ranges = "lighting = [0.2, 0.8]\ntemperature = [\"25 degC\", \"37 degC\"]\n";
    let fine = "start = \"760 cm^-1\"\nstop = \"1240 cm^-1\"\nstep = \"60 cm^-1\"\n";
    let small = "[background]\ntemperature = \"15 degC\"\n";
    for (others, wide, size) in [
        ("\"pmma\", \"kapton-tape\"", true, None),
        ("\"pmma\", \"steel-rough\"", true, None),
        ("\"polycarbonate\"", true, Some("size = \"0.4 m\"\n")),
        ("\"pmma\"", false, None),
        ("\"pmma\"", false, Some("size = \"0.4 m\"\n")),
    ] {
        let text = |range: [&str; 2]| {
            let text = rule("skin", others, range, 0.3, if size.is_some() { small } else { "" });
            let text = text.replace("[envelope]\n", &format!("[envelope]\n{ranges}"));
            let text = text.replace("[[environment]]", &format!("{}[[environment]]", size.unwrap_or("")));
            let (from, to) = (text.find("ranges = [[").unwrap(), text.find("[requirement]").unwrap());
            if wide { text } else { [&text[..from], fine, &text[to..]].concat() }
        };
        let all = answered(&text(["20 m", "1200 m"]));
        let lower = all.lower_bound.unwrap_or(0.0);
        assert!(lower <= all.statistical_distance, "{others}: {all:?}");
        println!("{others} {wide} {size:?}: {} {lower} {:?}", all.statistical_distance, all.certificate);
        // Of a distance that is next to nothing no more is asked.
        let proved =
            all.certificate.kind == Proof::BranchAndBound && lower >= 0.99 * all.statistical_distance;
        assert_eq!(proved, !others.contains("kapton"), "{others}: {all:?}");
        assert!(proved || all.statistical_distance < 0.03, "{others}: {all:?}");
        for z in [20.0, 21.3, 29.0, 34.5, 71.0, 130.0, 290.0, 310.0, 620.0, 1010.0, 1190.0, 1200.0] {
            let there = answered(&text([&format!("{z} m"), &format!("{z} m")]));
            assert!(there.statistical_distance >= lower * (1.0 - 1e-9), "{others} {z}: {there:?} {all:?}");
        }
    }
}

#[test]
fn a_distance_beyond_the_air_s_table_is_refused_by_its_key() {
    let text = rule("skin", "\"pmma\"", ["10 m", "20 km"], 0.3, "");
    let rule = Rule::from_toml(&text, None).unwrap();
    let error = RuleStudy::new(&rule, &Library::embedded().unwrap()).unwrap_err().to_string();
    assert!(error.contains("envelope.distance: distance is 20000 m; it must be at most 10000 m"), "{error}");
}

/// A plateau of a table ends at a column where rounding may let a cubic rise by an ulp: narrow ranges there are judged all the same.
#[test]
fn ranges_of_nearly_one_distance_are_judged() {
    let table = "wavenumber_cm1,tau_10m,tau_100m,tau_1km,tau_10km\n690,1,0.5,0.5,0.1\n800,0.9,0.2,0.2,0\n\
                 850,0.99,0.98,0.98,0.97\n900,0.99999,0.3,0.3,0.3\n1000,0.5,0.1,0.1,0\n1001,0.99,0.98,0.97,0.5\n\
                 1300,0.9,0.9,0.9,0.9\n";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("plateau.csv");
    std::fs::write(&path, table).unwrap();
    for nearest in ["99.99998583970157 m", "99.9999999 m", "99.99999999999 m", "99.999 m"] {
        let text = rule("skin", "\"pmma\"", [nearest, "100 m"], 0.3, "")
            .replace("model = \"tropical\"", &format!("table = {path:?}"));
        let verdict = answered(&text);
        assert_eq!(verdict.certificate.kind, Proof::BranchAndBound, "{nearest}: {verdict:?}");
    }
}
