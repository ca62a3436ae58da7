//! Air within wide bands: the worst distance need not be an end of its range, and the nearest may be the worst.
//!
//! The distances held against were found by another program (a least-squares search over the states of both materials,
//! at distances of its own): fabric against Kapton tape in three bands falls from d = 2.149 at 10 m to 0.0297 at 1 km and
//! rises to 0.840 at 3 km; skin against PMMA is at 2.1564 at 10 m and at 2.903 at 1 km.

use hadar::material::Library;
use hadar_study::scenario::Rule;
use hadar_study::study::{CameraVerdict, RuleAsked, RuleStudy};

fn judged(target: &str, other: &str, farthest: &str, demanded: f64) -> CameraVerdict {
    let text = format!(
        "[target]\nmaterial = \"{target}\"\ntemperature = \"33 degC\"\n\
         [[environment]]\ntemperature = \"10 degC\"\nlighting = 0.5\n\
         [atmosphere]\nmodel = \"tropical\"\ntemperature = \"300 K\"\n\
         [alternatives]\nmaterials = [\"{other}\"]\ntemperature = [\"200 K\", \"450 K\"]\n\
         [bands]\nranges = [[\"714.5 cm^-1\", \"893.5 cm^-1\"], [\"893.5 cm^-1\", \"1072.5 cm^-1\"], \
         [\"1072.5 cm^-1\", \"1250.5 cm^-1\"]]\n\
         [requirement]\ndistance = {demanded}\n[envelope]\ndistance = [\"10 m\", \"{farthest}\"]\n\
         [[camera]]\nname = \"camera\"\nexposure = \"10 ms\"\npixel = \"12 um\"\nf_number = 1.0\n\
         focal_length = \"24 mm\"\nnetd = \"30 mK\"\nnetd_temperature = \"30 degC\"\nframes = 100\n"
    );
    let rule = Rule::from_toml(&text, None).unwrap();
    let study = RuleStudy::new(&rule, &Library::embedded().unwrap()).unwrap();
    let answer = study.answer(&RuleAsked::default(), &|_, _| ()).unwrap();
    answer.cameras.into_iter().next().unwrap()
}

#[test]
fn the_worst_distance_may_be_between_the_ends() {
    let verdict = judged("fabric", "kapton-tape", "3000 m", 0.5);
    assert!(!verdict.passes && verdict.statistical_distance < 0.03, "{verdict:?}");
    let distance_m = verdict.limiting.distance_m.unwrap();
    assert!((800.0..1200.0).contains(&distance_m), "{distance_m}");
    assert_eq!((verdict.lower_bound, verdict.certificate.kind), (None, "dense-search"));
}

#[test]
fn the_nearest_distance_may_be_the_worst() {
    let verdict = judged("skin", "pmma", "1000 m", 2.4);
    assert!(!verdict.passes, "{verdict:?}");
    assert!((verdict.statistical_distance / 2.156_394_7 - 1.0).abs() < 1e-6, "{verdict:?}");
    assert!((verdict.limiting.distance_m.unwrap() / 10.0 - 1.0).abs() < 1e-9);
}
