//! An exclusion is no better than a 'yes' that demands as much: by what spoils the readings, and by what it rests on. Over drawn scenes.

use crate::support::folder::Folder;
use hadar::random::generator;
use rand::RngExt;
use rand::rngs::ChaCha8Rng as Generator;
use serde_json::Value;
use std::collections::BTreeSet;

/// Φ⁻¹(0.99).
const AT_99: f64 = 2.326_347_874_040_841;
const PERSON: &str = "[[category]]\nname = \"person\"\nmaterials = [\"skin\"]\nsafety = true\n";

/// A drawn scene: a robot, a person as an alternative and perhaps something that is nearly the robot itself.
struct Scene {
    exposure: &'static str,
    camera: String,
    speed: &'static str,
    range: &'static str,
    near: bool,
    demand: f64,
}

fn one_of<T: Copy>(random: &mut Generator, all: &[T]) -> T {
    all[random.random_range(0..all.len())]
}

impl Scene {
    fn drawn(random: &mut Generator) -> Self {
        let well = one_of(random, &["", "full_well = 1e6\n", "full_well = 1e12\n"]);
        let readout = one_of(random, &["", "readout = \"sequential\"\n", "readout = \"simultaneous\"\n"]);
        Self {
            exposure: one_of(random, &["0.3 us", "1.5 us", "50 us", "1 ms", "10 ms"]),
            camera: format!("{well}{readout}"),
            speed: one_of(random, &["", "", "speed = \"1 km/h\"\n", "speed = \"100 km/h\"\n"]),
            range: one_of(random, &["", "temperature = [\"10 degC\", \"45 degC\"]\n"]),
            near: one_of(random, &[false, true]),
            demand: one_of(random, &[1.0, 1.6, 3.0]),
        }
    }

    /// The same that demands so much, of the person alone if `alone`, with its camera called so.
    fn text(&self, demand: f64, alone: bool, camera: &str) -> String {
        let near = if self.near && !alone { ", \"near.csv\"" } else { "" };
        format!(
            "[target]\nmaterial = \"robot.csv\"\ntemperature = \"20 degC\"\ndistance = \"10 m\"\nsize = \"1 m\"\n\
             [background]\ntemperature = \"5 degC\"\n[[environment]]\ntemperature = \"5 degC\"\nlighting = 0.5\n\
             [alternatives]\nmaterials = [\"skin\"{near}]\n{}\
             [bands]\nranges = [[\"8 um\", \"9 um\"], [\"9 um\", \"10 um\"], [\"10 um\", \"11 um\"], [\"11 um\", \"13 um\"]]\n\
             {camera}exposure = \"{}\"\npixel = \"17 um\"\nf_number = 1.0\nfocal_length = \"24 mm\"\nnoise_electrons = 3000\n{}\
             [requirement]\ndistance = {demand}\n{}{PERSON}",
            self.range, self.exposure, self.camera, self.speed
        )
    }
}

fn folder(text: &str) -> Folder {
    let folder = Folder::with(text);
    let spectrum = |off: f64| {
        let row = |(nu, e): (u32, f64)| format!("{nu},{}\n", e + off);
        let rows = [(700, 0.3), (850, 0.55), (1000, 0.3), (1150, 0.6), (1300, 0.35)].map(row);
        format!("wavenumber_cm1,emissivity\n{}", rows.concat())
    };
    folder.file("robot.csv", &spectrum(0.0));
    folder.file("near.csv", &spectrum(1e-7));
    folder
}

/// Codes of what is favourable.
fn codes(all: &Value) -> BTreeSet<String> {
    let all = all.as_array().into_iter().flatten().filter(|one| one["favourable"] == true);
    all.map(|one| one["code"].as_str().unwrap().to_owned()).collect()
}

fn warned(answer: &Value) -> BTreeSet<String> {
    let all = answer["warnings"].as_array().unwrap().iter().map(|one| one["code"].as_str().unwrap());
    all.filter(|code| ["full-well", "motion-blur", "motion-blur-unknown"].contains(code))
        .map(str::to_owned)
        .collect()
}

/// `size`, `identify`, all against all and `simulate` say the same of a person: excluded where `size` of the person alone, at 99 %, is a 'yes',
/// and under its conditions, whatever else there is to be told and whatever the verdict on that.
#[test]
fn an_exclusion_is_a_yes_at_99_percent() {
    let mut random = generator(3, 0);
    let (mut excluded, mut spoiled, mut under_no) = (0, 0, 0);
    for _ in 0..24 {
        let scene = Scene::drawn(&mut random);
        let camera = "[camera]\n";
        let folder = folder(&scene.text(scene.demand, false, camera));
        let size = folder.json(&["size", "a.toml"]);
        let found = &size["safety"][0];
        folder.file("strict.toml", &scene.text(scene.demand.max(AT_99), true, camera));
        let strict = folder.json(&["size", "strict.toml"])["verdict"].clone();
        let context = || scene.text(scene.demand, false, camera);
        assert_eq!(found["excluded"], strict["answer"] == "yes", "{found:#}\n{strict:#}\n{}", context());
        assert_eq!(found["materials"][0]["excluded"], found["excluded"]);
        let spoils = |by: &&Value| *by != "distance";
        let fails: Vec<&Value> = strict["fails_by"].as_array().unwrap().iter().filter(spoils).collect();
        let by: Vec<&Value> = found["spoiled_by"].as_array().into_iter().flatten().collect();
        assert_eq!(by, fails, "{}", context());
        spoiled += u32::from(!fails.is_empty());
        let text = folder.run(&["size", "a.toml"]).stdout;
        let sentence = text.lines().find(|line| line.starts_with("A person ")).unwrap();
        if found["excluded"] == true {
            excluded += 1;
            under_no += u32::from(size["verdict"]["answer"] == "no");
            let own = codes(&found["conditions"]);
            assert_eq!(own, codes(&strict["conditions"]), "{}", context());
            assert!(!own.is_empty() && sentence.contains(" at 99 %, if "), "{sentence}");
            // The hardest in words, all others by their codes.
            let told = own.iter().filter(|code| sentence.contains(code.as_str())).count();
            assert!(told + 1 >= own.len(), "{sentence}");
        } else {
            assert!(sentence.starts_with("A person cannot be excluded where "), "{sentence}");
            assert_eq!(codes(&found["conditions"]).len(), 0);
        }
        assert_eq!(&folder.json(&["identify", "a.toml"])["safety"][0], found);
        let matrix = folder.json(&["identify", "a.toml", "--matrix"])["matrix"]["safety"].clone();
        let of_target = matrix.as_array().unwrap().iter().find(|row| row["target"] == "robot");
        assert_eq!(of_target.unwrap(), found);
        let few = ["--classifiers", "likelihood-ratio", "--spectra", "40"];
        let simulated = folder.json(&[&["simulate", "a.toml"], few.as_slice()].concat());
        assert_eq!(&simulated["safety"][0], found);
        assert_eq!(warned(&simulated), warned(&size), "{}", context());
    }
    assert!(excluded > 3 && spoiled > 3 && under_no > 0, "{excluded} {spoiled} {under_no}");
}

/// A camera of a rule excludes a person where it meets the same rule at 99 %, and under the conditions of that.
#[test]
fn an_exclusion_by_a_rule_is_a_yes_at_99_percent() {
    let mut random = generator(5, 0);
    let (mut excluded, mut near) = (0, 0);
    for _ in 0..16 {
        let scene = Scene { near: false, ..Scene::drawn(&mut random) };
        let rule = |demand: f64| {
            let camera = "[[camera]]\nname = \"core\"\nfield_of_view = \"30 deg\"\n";
            scene.text(demand, true, camera)
                + "[rule]\nname = \"n\"\n[envelope]\ntemperature = [\"18 degC\", \"22 degC\"]\n"
        };
        let folder = folder(&rule(scene.demand));
        let answer = folder.json(&["rule", "a.toml"]);
        folder.file("strict.toml", &rule(scene.demand.max(AT_99)));
        let strict = folder.json(&["rule", "strict.toml"])["cameras"][0].clone();
        let found = &answer["safety"][0];
        let lower = &answer["cameras"][0]["lower_bound"];
        assert_eq!(&found["statistical_distance_lower"], lower);
        assert_eq!(found["excluded"], strict["passes"], "{found:#}\n{}", rule(scene.demand));
        near += u32::from(lower.as_f64().is_some_and(|lower| lower < AT_99 && lower * scene.demand >= AT_99));
        if found["excluded"] == true {
            excluded += 1;
            assert_eq!(codes(&found["conditions"]), codes(&strict["conditions"]), "{}", rule(scene.demand));
            assert!(folder.run(&["rule", "a.toml"]).stdout.contains(", at 99 %, if "));
        } else {
            assert_eq!(codes(&found["conditions"]).len(), 0);
        }
    }
    assert!(excluded > 3 && near > 0, "{excluded} {near}");
}
