//! The whole program against wrong files and wrong flags: whatever it is given, it ends with an answer or with one message.
//!
//! Files are changed as those of the readers are (`fuzz_readers` of the study), flags are those that `--help` lists.
//! `HADAR_FUZZ_COMMANDS=20000 cargo test --release -p hadar-cli --test it fuzz` runs so many; `HADAR_FUZZ_SEED` makes others.

use crate::support::mutation::mutated;
use crate::support::sound::{all, fault};
use hadar::cube::Shape;
use hadar_formats::cube::write_npy_to;
use hadar_testing::repository;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use std::path::Path;
use std::sync::OnceLock;

/// Runs where nothing is said.
const RUNS: u64 = 150;

/// What flags are given.
const VALUES: &[&str] = &[
    "0",
    "1",
    "2",
    "3",
    "7",
    "-1",
    "1.5",
    "1e308",
    "5e-324",
    "NaN",
    "inf",
    "18446744073709551616",
    "",
    "x",
    "all",
    ".",
    "none",
    "a.toml",
    "my.csv",
    "local",
    "likelihood-ratio",
    "30 degC",
    "20 degC..40 degC",
];

const FILES: &str = r#"[target]
material = "my.csv"
temperature = "37 degC"
distance = "30 m"
[[environment]]
temperature = "20 degC"
lighting = 0.5
[alternatives]
materials = ["aluminium", "two.csv"]
[atmosphere]
table = "air.csv"
temperature = "15 degC"
[bands]
filters = "filters.csv"
[camera]
exposure = "12 ms"
pixel = "12 um"
f_number = 1.3
focal_length = "18 mm"
noise_electrons = 1e5
quantum_efficiency = "efficiency.csv"
"#;

const PRIORS: &str = r#"[target]
material = "skin"
temperature = "37 degC"
[[environment]]
temperature = "20 degC"
lighting = 0.5
[alternatives]
materials = ["aluminium", "pmma"]
temperature = ["0 degC", "120 degC"]
[bands]
rows = "bands.csv"
[unknown]
nuisances = ["temperature", "lighting", "gain"]
priors = { temperature = "2 K" }
[camera]
preset = "flir-a325sc"
exposure = "10 ms"
flicker_fraction = 0.5
full_well = 1e9
frames = 4
[requirement]
detection_probability = 0.99
speed = "30 mph"
[sensitivity]
emissivity_error = 0.005
"#;

const RULE: &str = r#"cameras = ["flir-a325sc", "ideal-pnrd"]
[rule]
name = "People and robots"
[target]
material = "skin"
temperature = "33 degC"
[[environment]]
temperature = "10 degC"
lighting = 0.5
[alternatives]
materials = ["aluminium", "two.csv"]
[bands]
start = "750 cm^-1"
stop = "1250 cm^-1"
step = "100 cm^-1"
[envelope]
temperature = ["25 degC", "37 degC"]
lighting = [0.2, 0.8]
surroundings = ["-10 degC", "15 degC"]
distance = ["5 m", "15 m"]
materials = ["skin", "fabric"]
"#;

const SCENE: &str = r#"[scene]
size = [24, 32]
ground_temperature = "12 degC"
sky_temperature = "-15 degC"
ground_emissivity = [0.9, 0.98]
person = "my.csv"
person_distance = "8 m"
[bands]
start = "720 cm^-1"
stop = "1240 cm^-1"
step = "130 cm^-1"
[camera]
exposure = "12 ms"
pixel = "240 um"
f_number = 1.4
focal_length = "14 mm"
noise_electrons = 3000
[stereo]
baseline = "0.2 m"
window = [3, 3]
lines = [15]
[requirement]
relative_depth_error = 0.01
"#;

const CUBE: &str = r#"[cube]
left = "left.npy"
right = "right.npy"
photons_per_unit = 2.5
noise_variance = "noise.csv"
depth = "depth.npy"
[stereo]
baseline = "0.02 m"
focal_length = "14 mm"
pixel = "12 um"
window = [3, 5]
lines = [4]
diffraction = "gaussian"
psf_sigma = "5 um"
[requirement]
depth_error = "10 cm"
"#;

const MATLAB: &str = r#"[cube]
left = "left.mat"
variable = "S"
noise_variance = 5
depth = "12 m"
[stereo]
baseline = "0.2 m"
focal_length = "14 mm"
pixel = "12 um"
window = [1, 1]
"#;

/// A cube of `bands` bands with some texture.
fn cube(bands: usize, level: f64) -> Vec<u8> {
    let shape = Shape::new(9, 24, bands).unwrap();
    let samples: Vec<f32> =
        (0..shape.len()).map(|i| (level * (1.0 + 0.1 * (i as f64 * 0.7).sin())) as f32).collect();
    let mut bytes = Vec::new();
    write_npy_to(&mut bytes, shape, &samples).unwrap();
    bytes
}

/// Every file that a command may be given.
fn files() -> &'static [(&'static str, Vec<u8>)] {
    static FILES_THERE: OnceLock<Vec<(&str, Vec<u8>)>> = OnceLock::new();
    FILES_THERE.get_or_init(|| {
        let seed = |name: &str| std::fs::read(repository().join("fuzz/seeds").join(name)).unwrap();
        let text = |text: &str| text.as_bytes().to_vec();
        vec![
            ("a.toml", text(crate::support::folder::SCENARIO)),
            ("files.toml", text(FILES)),
            ("three.toml", text(include_str!("../../../../examples/human_vs_robot_3_bands.toml"))),
            ("priors.toml", text(PRIORS)),
            ("rule.toml", text(RULE)),
            ("scene.toml", text(SCENE)),
            ("cube.toml", text(CUBE)),
            ("matlab.toml", text(MATLAB)),
            ("my.csv", text("wavenumber_cm1,emissivity\n600,0.9\n900,0.95\n1400,0.8\n")),
            ("two.csv", text("wavelength_um,reflectance\n6,0.5\n10,0.25\n20,0.1\n")),
            ("air.csv", text("wavenumber_cm1,tau_10m,tau_100m\n600,0.9,0.5\n1400,0.99,0.9\n")),
            ("filters.csv", text("wavelength_um,a,b,c,d\n8,0,0,0,0\n9,1,0,0,0\n10,0,1,0,0\n11,0,0,1,0\n12,0,0,0,1\n13,0,0,0,0\n")),
            ("bands.csv", text("wavenumber_cm1,width_cm1\n760,10\n800,20\n900,20\n1000,20\n1100,20\n1200,10\n")),
            ("efficiency.csv", text("wavenumber_cm1,efficiency\n600,0.5\n1400,0.8\n")),
            ("left.npy", cube(3, 1000.0)),
            ("right.npy", cube(3, 1010.0)),
            ("depth.npy", cube(1, 10.0)),
            ("noise.csv", text("band,variance_counts2\n1,50\n2,60\n3,70\n")),
            ("left.mat", seed("mat/plain")),
            ("model.json", seed("model/logistic")),
            ("library.toml", text("version = 1\n[[material]]\nname = \"a\"\nmodel = { table = \"my.csv\" }\n[[material]]\nname = \"b\"\nmodel = { constant = 0.5 }\n")),
        ]
    })
}

/// A command, the files that it reads, the one first that it is named.
const COMMANDS: &[(&[&str], &[&str])] = &[
    (&["size", "a.toml"], &["a.toml"]),
    (
        &["size", "files.toml"],
        &["files.toml", "my.csv", "two.csv", "air.csv", "filters.csv", "efficiency.csv"],
    ),
    (&["size", "priors.toml"], &["priors.toml", "bands.csv"]),
    (&["identify", "priors.toml"], &["priors.toml", "bands.csv"]),
    (&["identify", "files.toml", "--matrix", "--by", "local"], &["files.toml", "two.csv", "filters.csv"]),
    (&["identify", "priors.toml", "--exact", "--trials", "64"], &["priors.toml"]),
    (&["simulate", "a.toml", "--spectra", "80"], &["a.toml"]),
    (&["simulate", "three.toml", "--spectra", "80", "--model", "model.json"], &["model.json", "three.toml"]),
    (
        &[
            "simulate",
            "files.toml",
            "--thermometry",
            "20 degC..40 degC",
            "--temperatures",
            "2",
            "--spectra",
            "20",
        ],
        &["files.toml"],
    ),
    (&["rule", "rule.toml"], &["rule.toml", "two.csv"]),
    (&["range", "scene.toml"], &["scene.toml", "my.csv"]),
    (&["range", "scene.toml", "--trials", "2"], &["scene.toml"]),
    (&["range", "cube.toml"], &["cube.toml", "left.npy", "right.npy", "depth.npy", "noise.csv"]),
    (&["range", "matlab.toml"], &["matlab.toml", "left.mat"]),
    (&["materials", "import", "my.csv"], &["my.csv"]),
    (&["materials", "list", "--library", "library.toml"], &["library.toml"]),
    (&["cameras", "list"], &["a.toml"]),
];

/// The flags that a command says it has.
fn flags(command: &[&str]) -> Vec<String> {
    let depth = if ["materials", "cameras", "calibrate"].contains(&command[0]) { 2 } else { 1 };
    let program = assert_cmd::cargo::cargo_bin!("hadar");
    let said =
        std::process::Command::new(program).args(&command[..depth]).arg("--help").output().unwrap().stdout;
    let said = String::from_utf8(said).unwrap();
    let named = said.split_whitespace().filter(|word| word.starts_with("--") && word.len() > 3);
    let mut named: Vec<String> =
        named.map(|word| word.trim_end_matches([',', '.', ':', ')', ';']).to_owned()).collect();
    named.sort();
    named.dedup();
    // Help is no answer.
    named.retain(|flag| flag != "--help");
    named
}

/// One case: what is changed in which file, or which flags are added.
fn case(seed: u64, number: u64) -> Option<String> {
    static FLAGS: OnceLock<Vec<Vec<String>>> = OnceLock::new();
    let known = FLAGS.get_or_init(|| COMMANDS.iter().map(|(arguments, _)| flags(arguments)).collect());
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(number);
    let which = rng.random_range(0..COMMANDS.len());
    let (command, reads) = COMMANDS[which];
    let mut arguments: Vec<String> = command.iter().map(ToString::to_string).collect();
    let mut changed: Option<(&str, Vec<u8>)> = None;
    if rng.random_bool(0.75) {
        // The named file twice as often as those that it names.
        let at = if rng.random_bool(0.5) { 0 } else { rng.random_range(0..reads.len()) };
        let original = files().iter().filter(|(name, _)| *name == reads[at]).map(|(_, bytes)| bytes.clone());
        changed = Some((
            reads[at],
            mutated(&original.collect::<Vec<_>>(), &format!("{seed} {}", reads[at]), number),
        ));
    }
    for _ in 0..rng.random_range(0..=if changed.is_some() { 1 } else { 3 }) {
        let own = &known[which];
        let flag = &own[rng.random_range(0..own.len())];
        // Joined: a value behind a flag that takes none would be another scenario, whose error stands in a table of answers.
        arguments.push(match rng.random_bool(0.6) {
            true => format!("{flag}={}", VALUES[rng.random_range(0..VALUES.len())]),
            false => flag.clone(),
        });
    }
    if rng.random_bool(0.7) {
        arguments.push("--json".to_owned());
    }
    let folder = tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).unwrap();
    for (name, bytes) in files() {
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    if let Some((name, bytes)) = &changed {
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    let fault = fault(folder.path(), &arguments)?;
    let kept = match &changed {
        Some((name, bytes)) => {
            let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("fuzz-{seed}-{number}-{name}"));
            std::fs::write(&path, bytes).unwrap();
            format!("{name} kept as {}", path.display())
        }
        None => "no file changed".to_owned(),
    };
    Some(format!("case {number} of seed {seed}: hadar {}; {kept}: {fault}", arguments.join(" ")))
}

#[test]
fn wrong_files_and_flags_end_in_an_answer_or_in_one_message() {
    let number = |name: &str, default: u64| std::env::var(name).map_or(default, |text| text.parse().unwrap());
    let (runs, seed) = (number("HADAR_FUZZ_COMMANDS", RUNS), number("HADAR_FUZZ_SEED", 1));
    all(usize::try_from(runs).unwrap(), |run| case(seed, run as u64));
}

/// The cases themselves are right: unchanged, each gives an answer.
#[test]
fn unchanged_every_case_gives_an_answer() {
    all(COMMANDS.len(), |which| {
        let folder = tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).unwrap();
        for (name, bytes) in files() {
            std::fs::write(folder.path().join(name), bytes).unwrap();
        }
        let output = std::process::Command::new(assert_cmd::cargo::cargo_bin!("hadar"))
            .current_dir(folder.path())
            .args(COMMANDS[which].0)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        (!output.status.success()).then(|| format!("{:?}: {said}", COMMANDS[which].0))
    });
}
