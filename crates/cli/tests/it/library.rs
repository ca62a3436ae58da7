//! `hadar library` as its user runs it: files, numbers, mistakes.

use crate::support::folder::Folder;
use hadar::atmosphere::Atmosphere;
use hadar::cube::Shape;
use hadar::planck::photon_radiance;
use hadar_formats::cube::{npy_map, write_npy};
use hadar_simulate::draws::generator;
use rand::RngExt;
use std::fs;

pub(crate) const SCENARIO: &str = r#"title = "Wall and pane"
[cube]
data = "counts.npy"
counts_per_photon_radiance = 1e-13
[bands]
start = "800 cm^-1"
stop = "1200 cm^-1"
step = "20 cm^-1"
[[environment]]
spectrum = "light.csv"
column = "sky"
[[environment]]
temperature = "20 degC"
[clusters]
count = 2
max_emissivity = 0.96
[unknown]
temperature = ["250 K", "340 K"]
lighting_total = 1.0
[truth]
material = "material.npy"
temperature = "temperature.npy"
"#;

const ROWS: usize = 12;
const COLUMNS: usize = 16;
const BANDS: usize = 21;

fn wavenumber(band: usize) -> f64 {
    800.0 + 20.0 * band as f64
}

pub(crate) fn emissivity(material: usize, band: usize) -> f64 {
    let nu = wavenumber(band);
    [0.93 + 0.03 * (nu / 60.0).sin(), 0.6 + 0.3 * (-((nu - 1000.0) / 80.0).powi(2)).exp()][material]
}

fn sky(band: usize) -> f64 {
    photon_radiance(wavenumber(band), 260.0) * [0.4, 0.8, 0.3, 0.6][band % 4]
}

/// Two materials in halves, temperatures and lighting at random, some 10⁶ counts a band, no noise.
pub(crate) fn with(scenario: &str) -> Folder {
    let folder = Folder::with(scenario);
    let rows: Vec<String> = (0..BANDS).map(|w| format!("{},{}", wavenumber(w), sky(w))).collect();
    folder.file("light.csv", &format!("wavenumber_cm1,sky\n{}\n", rows.join("\n")));
    let mut random = generator(4, 0);
    let (mut counts, mut material, mut temperature) = (Vec::new(), Vec::new(), Vec::new());
    for i in 0..ROWS * COLUMNS {
        let own = usize::from(i % COLUMNS >= COLUMNS / 2);
        let t: f64 = random.random_range(295.0..315.0);
        let v: f64 = random.random_range(0.1..0.9);
        for w in 0..BANDS {
            let (e, nu) = (emissivity(own, w), wavenumber(w));
            let light = v * sky(w) + (1.0 - v) * photon_radiance(nu, 293.15);
            counts.push(1e-13 * (e * photon_radiance(nu, t) + (1.0 - e) * light));
        }
        material.push(own as u16);
        temperature.push(t);
    }
    let shape = |bands| Shape::new(ROWS, COLUMNS, bands).unwrap();
    write_npy(&folder.path().join("counts.npy"), shape(BANDS), &counts).unwrap();
    write_npy(&folder.path().join("temperature.npy"), shape(1), &temperature).unwrap();
    fs::write(folder.path().join("material.npy"), npy_map(&[ROWS, COLUMNS], &material).unwrap()).unwrap();
    folder
}

#[test]
fn a_library_comes_out_and_takes_the_cube_apart() {
    let folder = with(SCENARIO);
    let found = folder.json(&["library", "a.toml", "--out", "out"]);
    let clusters = found["clusters"].as_array().unwrap();
    assert_eq!(clusters.len(), 2);
    assert_eq!(found["truth"]["right_material"].as_f64(), Some(1.0));
    for (own, material) in clusters.iter().zip(found["truth"]["material_of_cluster"].as_array().unwrap()) {
        assert_eq!(own["pixels"].as_u64(), Some((ROWS * COLUMNS / 2) as u64));
        let material = material.as_u64().unwrap() as usize;
        for w in 0..BANDS {
            let [e, sigma] = ["emissivity", "sigma"].map(|key| own[key][w].as_f64().unwrap());
            let off = (e - emissivity(material, w)).abs();
            assert!(off < 3.0 * sigma && sigma < 0.05, "{material} {w}: {e} {sigma}");
        }
    }
    let out = folder.path().join("out");
    for name in
        ["library.csv", "library_sigma.csv", "clusters.csv", "cluster.npy", "report.html", "emissivities.png"]
    {
        assert!(out.join(name).exists(), "{name}");
    }
    let head = fs::read_to_string(out.join("library.csv")).unwrap();
    assert!(head.starts_with("wavenumber_cm1,cluster-1,cluster-2\n800,"), "{head}");
    // The scenario that was written runs, and what asked for the library asks for it again.
    let parts = folder.json(&["decompose", "out/decompose.toml"]);
    assert_eq!(parts["materials"], serde_json::json!(["cluster-1", "cluster-2"]));
    assert!(parts["truth"]["temperature_rmse_k"].as_f64().unwrap() < 1.0, "{}", parts["truth"]);
    assert_eq!(folder.json(&["library", "out/scenario.toml"])["clusters"], found["clusters"]);
    // The seed and the number of threads are no part of the answer here.
    let other = folder.json(&["library", "a.toml", "--threads", "1"]);
    assert_eq!(other["clusters"], found["clusters"]);
    let text = folder.run(&["library", "a.toml"]).stdout;
    assert!(text.starts_with("2 emissivities found in 192 pixels"), "{text}");
}

/// The cube through 80 m of air: with it told the emissivities are those without air, within a fifth of their deviations; not told, they are off by
/// more than a deviation; the scenario that is written has the air. What the length may be off by is in the deviations.
#[test]
fn a_library_is_found_through_the_air() {
    const AIR: &str =
        "[atmosphere]\nmodel = \"us-standard\"\ntemperature = \"288.15 K\"\ndistance = \"80 m\"\n";
    let nodes: Vec<f64> = (0..BANDS).map(wavenumber).collect();
    let air = Atmosphere::embedded("us-standard").unwrap();
    let tau = air.transmittance(&nodes, 80.0).unwrap();
    let own = air.path_radiance(&nodes, 80.0, 288.15).unwrap();
    let behind = |scenario: &str| {
        let folder = with(scenario);
        let path = folder.path().join("counts.npy");
        let bytes = fs::read(&path).unwrap();
        let first = bytes.len() - 8 * ROWS * COLUMNS * BANDS;
        let counts: Vec<f64> = bytes[first..]
            .as_chunks::<8>()
            .0
            .iter()
            .enumerate()
            .map(|(i, n)| tau[i % BANDS] * f64::from_le_bytes(*n) + 1e-13 * own[i % BANDS])
            .collect();
        write_npy(&path, Shape::new(ROWS, COLUMNS, BANDS).unwrap(), &counts).unwrap();
        folder
    };
    let emissivities = |found: &serde_json::Value| -> Vec<[f64; 2]> {
        let mut clusters: Vec<(u64, Vec<[f64; 2]>)> = Vec::new();
        let materials = found["truth"]["material_of_cluster"].as_array().unwrap();
        for (own, material) in found["clusters"].as_array().unwrap().iter().zip(materials) {
            let of = |w: usize| ["emissivity", "sigma"].map(|key| own[key][w].as_f64().unwrap());
            clusters.push((material.as_u64().unwrap(), (0..BANDS).map(of).collect()));
        }
        clusters.sort_by_key(|one| one.0);
        clusters.into_iter().flat_map(|one| one.1).collect()
    };
    let off = |a: &[[f64; 2]], b: &[[f64; 2]]| -> f64 {
        a.iter().zip(b).map(|([a, _], [b, sigma])| (a - b).abs() / sigma).fold(0.0, f64::max)
    };
    let without = emissivities(&with(SCENARIO).json(&["library", "a.toml"]));
    let told = behind(&format!("{SCENARIO}{AIR}"));
    let found = told.json(&["library", "a.toml", "--out", "out"]);
    let with_it = emissivities(&found);
    assert!(off(&with_it, &without) < 0.2, "{}", off(&with_it, &without));
    let silent = emissivities(&behind(SCENARIO).json(&["library", "a.toml"]));
    assert!(off(&silent, &without) > 1.0, "{}", off(&silent, &without));
    let written = fs::read_to_string(told.path().join("out/decompose.toml")).unwrap();
    assert!(written.contains("[atmosphere]") && written.contains("distance = \"80 m\""), "{written}");
    let unsure = SCENARIO.replace("[unknown]\n", "[unknown]\nair = \"40 m\"\n");
    let found = behind(&format!("{unsure}{AIR}")).json(&["library", "a.toml"]);
    assert_eq!(found["shared"][0]["unknown"], "air");
    let wider = emissivities(&found);
    assert!(wider.iter().zip(&with_it).all(|(wide, own)| wide[1] >= own[1]));
    let refused = behind(&unsure).refusal(&["library", "a.toml"]);
    assert!(refused.contains("unknown.air") && refused.contains("write [atmosphere] too"), "{refused}");
}

#[test]
fn a_range_of_counts_finds_how_many_there_are() {
    let folder = with(&SCENARIO.replace("count = 2", "count = [1, 4]"));
    let found = folder.json(&["library", "a.toml", "--out", "out"]);
    assert_eq!(found["clusters"].as_array().unwrap().len(), 2, "{}", found["tried"]);
    assert_eq!(found["tried"].as_array().unwrap().len(), 4);
    assert!(folder.path().join("out/counts.csv").exists());
    let one = with(&SCENARIO.replace("count = 2", "count = 1"));
    let found = one.json(&["library", "a.toml"]);
    let codes: Vec<&str> =
        found["warnings"].as_array().unwrap().iter().map(|one| one["code"].as_str().unwrap()).collect();
    assert!(codes.contains(&"one-cluster"), "{codes:?}");
}

#[test]
fn mistakes_are_one_line_with_what_to_write() {
    let folder = with(SCENARIO);
    let cases = [
        (SCENARIO.replace("count = 2", "count = 193"), "clusters.count: 193 clusters of 192 pixels"),
        (SCENARIO.replace("count = 2", "count = [4, 2]"), "write count = [2, 4]"),
        (SCENARIO.replace("count = 2", "count = 0"), "clusters.count"),
        (SCENARIO.replace("count = 2\n", ""), "clusters.count: the key is missing; write count = 6"),
        (SCENARIO.replace("= 0.96", "= 1.2"), "clusters.max_emissivity"),
        (
            SCENARIO.replace("counts_per_photon_radiance = 1e-13\n", ""),
            "the scale of the samples is not stated",
        ),
        (
            SCENARIO.replace("counts_per_photon_radiance = 1e-13", "unit = \"W m^-2 sr^-1 per cm^-1\""),
            "radiances without their noise; write noise = 1e-4",
        ),
        (SCENARIO.replace("lighting_total = 1.0", "gain = true"), "unknown.gain"),
        (SCENARIO.replace("1200 cm^-1", "1180 cm^-1"), "[bands] are 20"),
        (SCENARIO.replace("[clusters]\ncount = 2\nmax_emissivity = 0.96\n", ""), "hadar decompose b.toml"),
        (SCENARIO.replace("title =", "titel ="), "there is no key `titel`"),
        (SCENARIO.replace("[truth]", "[emissivity]\nshape_error = 0\n[truth]"), "emissivity.shape_error"),
    ];
    for (scenario, message) in cases {
        folder.file("b.toml", &scenario);
        let refusal = folder.refusal(&["library", "b.toml"]);
        assert!(refusal.contains(message), "{message}: {refusal}");
    }
    let refusal = folder.refusal(&["library", "counts.npy"]);
    assert!(refusal.contains("write a file cube.toml with [cube] data = \"counts.npy\""), "{refusal}");
    assert!(folder.refusal(&["decompose", "a.toml"]).contains("hadar library a.toml"));
}

/// Lighting without a total leaves mirrors in, and one emissivity for two materials does not fit: both are said.
#[test]
fn what_may_be_a_mirror_and_what_does_not_fit_is_said() {
    let codes = |scenario: &str| -> Vec<String> {
        let found = with(scenario).json(&["library", "a.toml"]);
        let all = found["warnings"].as_array().unwrap().clone();
        all.iter().map(|one| one["code"].as_str().unwrap().to_owned()).collect()
    };
    let sound = codes(SCENARIO);
    assert!(
        !sound.iter().any(|code| code == "mirror-not-excluded" || code == "cluster-does-not-fit"),
        "{sound:?}"
    );
    let free = codes(&SCENARIO.replace("lighting_total = 1.0\n", ""));
    assert!(free.iter().any(|code| code == "mirror-not-excluded"), "{free:?}");
    let one = codes(&SCENARIO.replace("count = 2", "count = 1"));
    // Pixels that are far from it are left out of the fit, and counted as such.
    let misfit = |code: &String| code == "cluster-does-not-fit" || code == "library-does-not-fit";
    assert!(one.iter().any(misfit) && !sound.iter().any(misfit), "{one:?} {sound:?}");
}
