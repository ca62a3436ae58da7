//! A report is the same bytes wherever its inputs lie and wherever it is asked from: every command that writes one, in two folders of
//! different depth, from three places, with paths from there and whole ones.

use crate::support::folder::{Folder, SCENARIO};
use crate::support::rules::rule;
use crate::{air_ranging, calibrate, calibrate_blackbodies, decompose, library, range, render};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const OWN: &str = "wavenumber_cm1,emissivity\n600,0.9\n900,0.95\n1400,0.8\n";

/// A scenario with files beside it, below it, above it, and one named with its whole path.
fn of_files(outside: &Path) -> Folder {
    let listed = format!("\"own/paint.csv\", \"../beside.csv\", \"{}\"", outside.join("whole.csv").display());
    let folder = Folder::with(&SCENARIO.replace("\"aluminium\"", &listed));
    fs::create_dir(folder.path().join("own")).unwrap();
    folder.file("own/paint.csv", OWN);
    folder.file("b.toml", SCENARIO);
    folder.file("rule.toml", &rule("flir-a325sc").replace("\"aluminium\"", "\"own/paint.csv\""));
    folder
}

/// What is asked, of the files of which folder. `@` is the folder outside, which is the same for all.
fn asked(outside: &Path) -> Vec<(Folder, Vec<&'static str>)> {
    let of = |folder: Folder, commands: &[&'static str]| (folder, commands.to_vec());
    vec![
        of(
            of_files(outside),
            &[
                "size a.toml",
                "size a.toml b.toml",
                "identify a.toml --library @/lib --seed 3",
                "rule rule.toml",
                "simulate a.toml --spectra 40 --classifiers likelihood-ratio",
                "simulate a.toml --spectra 4 --thermometry 300K",
                "simulate a.toml --average --spectra 40 --set unknown.priors={temperature=\"2K\",lighting=0.1}",
                "sweep a.toml --vary target.distance=5m..10m:2",
                "materials plot skin --library own",
            ],
        ),
        of(range::with_cube(range::CUBE), &["range a.toml"]),
        of(air_ranging::with_air(air_ranging::WALL), &["range a.toml"]),
        of(decompose::with(decompose::SCENARIO), &["decompose a.toml"]),
        of(library::with(library::SCENARIO), &["library a.toml"]),
        of(Folder::with(render::SCENARIO), &["render a.toml", "render a.toml --layout hadar"]),
        of(
            calibrate::walls(),
            &["decompose a.toml", "calibrate noise frame_1.npy frame_2.npy", "calibrate stripes frame_1.npy"],
        ),
        of(
            calibrate_blackbodies::spectrometer(calibrate_blackbodies::SPECTROMETER),
            &["calibrate blackbody a.toml"],
        ),
        of(calibrate_blackbodies::wheel(calibrate_blackbodies::WHEEL).0, &["calibrate response a.toml"]),
    ]
}

/// Copies a folder with all that is in it.
fn copied(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let there = to.join(path.file_name().unwrap());
        if path.is_dir() {
            copied(&path, &there);
        } else {
            fs::copy(&path, &there).unwrap();
        }
    }
}

/// Where the program is run, and how it is told of a file from there.
struct Place {
    stands: PathBuf,
    /// What is written before the name of a file of the scenario's folder, and before the folder outside; in a value of the scenario that
    /// is its whole path.
    before: [String; 3],
    out: PathBuf,
}

impl Place {
    /// What is printed as JSON, and every file that is written.
    fn run(&self, command: &str, home: &Path) -> (String, BTreeMap<String, Vec<u8>>) {
        let word = |word: &str| match word.split_once('@') {
            Some((key, rest)) if key.contains('=') => format!("{key}{}{rest}", self.before[2]),
            Some((key, rest)) => format!("{key}{}{rest}", self.before[1]),
            None if home.join(word).exists() => format!("{}{word}", self.before[0]),
            None => word.to_owned(),
        };
        let mut program = Command::new(assert_cmd::cargo::cargo_bin!("hadar"));
        program.args(command.split(' ').map(word)).args(["--json", "--out"]).arg(&self.out);
        let output = program.current_dir(&self.stands).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(matches!(output.status.code(), Some(0 | 3)), "{command}: {said}");
        let files = bytes(&self.stands.join(&self.out));
        fs::remove_dir_all(self.stands.join(&self.out)).unwrap();
        (String::from_utf8(output.stdout).unwrap(), files)
    }
}

/// All files below, by the way to them.
fn bytes(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        // The rows of a sweep are no part of its report.
        if name == ".sweep" {
            continue;
        }
        if path.is_dir() {
            found.extend(bytes(&path).into_iter().map(|(below, bytes)| (format!("{name}/{below}"), bytes)));
        } else {
            found.insert(name, fs::read(&path).unwrap());
        }
    }
    found
}

/// The first line of `one` that `other` has not.
fn first_difference(one: &[u8], other: &[u8]) -> String {
    let (one, other) = (String::from_utf8_lossy(one), String::from_utf8_lossy(other));
    let lines = one.lines().zip(other.lines()).find(|(a, b)| a != b);
    lines.map_or_else(|| "another length".into(), |(a, b)| format!("{a:.300}\n{b:.300}"))
}

#[test]
fn reports_are_the_same_bytes_anywhere() {
    let world = tempfile::tempdir().unwrap();
    let root = world.path();
    let outside = root.join("outside");
    fs::create_dir_all(outside.join("lib")).unwrap();
    for name in ["whole.csv", "lib/enamel.csv"] {
        fs::write(outside.join(name), OWN).unwrap();
    }
    let elsewhere = root.join("elsewhere");
    fs::create_dir(&elsewhere).unwrap();
    let mut faults = Vec::new();
    for (number, (folder, commands)) in asked(&outside).into_iter().enumerate() {
        let homes = [root.join(format!("{number}/near")), root.join(format!("{number}/a deep/er/place"))];
        for home in &homes {
            copied(folder.path(), home);
            fs::write(home.with_file_name("beside.csv"), OWN).unwrap();
        }
        let whole = |path: &Path| path.display().to_string();
        let places = [
            // In the folder itself.
            Place {
                stands: homes[0].clone(),
                before: [String::new(), "../../outside".into(), whole(&outside)],
                out: "out".into(),
            },
            // Beside, by a way up and down.
            Place {
                stands: elsewhere.clone(),
                before: [format!("../{number}/a deep/er/place/"), whole(&outside), whole(&outside)],
                out: "report".into(),
            },
            // Above, by the whole path.
            Place {
                stands: root.to_owned(),
                before: [format!("{}/", whole(&homes[1])), "outside".into(), whole(&outside)],
                out: homes[1].join("of this").join("out"),
            },
        ];
        for command in commands {
            let home = |place: usize| &homes[place.min(1)];
            let made: Vec<_> =
                places.iter().enumerate().map(|(i, place)| place.run(command, home(i))).collect();
            let (json, files) = &made[0];
            for (other_json, other) in &made[1..] {
                if json != other_json {
                    let line = first_difference(json.as_bytes(), other_json.as_bytes());
                    faults.push(format!("{command} --json: {line}"));
                }
                assert!(files.keys().eq(other.keys()), "{command}: {:?}", other.keys());
                let different = files.iter().filter(|(name, bytes)| other[*name] != **bytes);
                faults.extend(different.map(|(name, bytes)| {
                    format!("{command}: {name}: {}", first_difference(bytes, &other[name]))
                }));
            }
            // No folder of this machine is in any of it.
            let root = root.file_name().unwrap().to_string_lossy().into_owned();
            let told = files.iter().filter(|(_, bytes)| String::from_utf8_lossy(bytes).contains(&root));
            faults.extend(told.map(|(name, _)| format!("{command}: {name} says where it was made")));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
