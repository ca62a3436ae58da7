//! `hadar render` as its user runs it: the cube and its truth, both layouts, the way back, mistakes.

use crate::support::folder::Folder;
use hadar::cube::Cube;
use hadar::planck::photon_radiance;
use std::fs;

pub(crate) const SCENARIO: &str = r#"title = "Three at night"
[scene]
sky = { material = "sky-us-standard", temperature = "288 K" }
ground = { material = "asphalt", temperature = "12 degC", variation = "1 K", marks = "marble" }
library = ["concrete", "asphalt"]
size = [48, 64]
[[object]]
shape = "person"
material = "skin"
temperature = "33 degC"
at = ["-1.2 m", "8 m"]
roughness = 0.2
[[object]]
shape = "robot"
material = "aluminium"
temperature = "72.5 degC"
variation = "2 K"
at = ["0 m", "8 m"]
[[object]]
name = "cab"
shape = "car"
material = "pmma"
temperature = "37 degC"
tyres = { material = "rubber-tyre", temperature = "30 degC" }
at = ["1.8 m", "11 m"]
[bands]
start = "800 cm^-1"
stop = "1200 cm^-1"
step = "20 cm^-1"
[camera]
exposure = "2 ms"
pixel = "120 um"
f_number = 1.4
focal_length = "14 mm"
noise_electrons = 300
noise_exposure = "2 ms"
"#;

const ROWS: usize = 48;
const COLUMNS: usize = 64;

/// The samples of a file, and its dimensions.
fn samples(folder: &Folder, name: &str) -> (Vec<f64>, [usize; 3]) {
    let cube = hadar_formats::cube::open(&folder.path().join(name), None).unwrap();
    let shape = cube.shape();
    let rows = 0..shape.rows();
    let values = match &cube {
        Cube::F32(cube) => cube.read(rows, &mut Vec::new()).unwrap().iter().map(|x| f64::from(*x)).collect(),
        Cube::F64(cube) => cube.read(rows, &mut Vec::new()).unwrap().to_vec(),
    };
    (values, [shape.rows(), shape.columns(), shape.bands()])
}

/// The rows of a table of numbers.
fn table(folder: &Folder, name: &str) -> Vec<Vec<f64>> {
    let text = fs::read_to_string(folder.path().join(name)).unwrap();
    text.lines().skip(1).map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect()
}

/// ∂²B/∂T²: B ∝ 1 / (eˣ − 1), x = 1.438777 cm K ν̃ / T.
fn photon_radiance_curvature(nu: f64, temperature_k: f64) -> f64 {
    let x = 1.438776877 * nu / temperature_k;
    let slope = x / (1.0 - (-x).exp());
    photon_radiance(nu, temperature_k) * slope * (x / (0.5 * x).tanh() - 2.0) / temperature_k.powi(2)
}

/// Every pure pixel is S = e B(T) + (1 − e) ΣVS of the files beside the cube, in one scale of counts.
#[test]
fn counts_are_those_of_the_truth_beside_them() {
    let folder = Folder::with(SCENARIO);
    let found = folder.json(&["render", "a.toml", "--no-noise", "--out", "out"]);
    let materials: Vec<&str> =
        found["materials"].as_array().unwrap().iter().filter_map(|m| m.as_str()).collect();
    assert_eq!(materials, ["asphalt", "marble", "skin", "aluminium", "pmma", "rubber-tyre", "concrete"]);
    assert_eq!(found["surroundings"][0], "sky");
    let (counts, shape) = samples(&folder, "out/counts.npy");
    assert_eq!(shape, [ROWS, COLUMNS, 21]);
    let [material, temperature_k, depth_m, surface] = ["material", "temperature_k", "depth_m", "surface"]
        .map(|map| samples(&folder, &format!("out/{map}.npy")).0);
    let (lighting, [.., lights]) = samples(&folder, "out/lighting.npy");
    let (library, surroundings) = (table(&folder, "out/library.csv"), table(&folder, "out/surroundings.csv"));
    let (mut scale, mut compared, mut seen) = (None, 0, [0; 6]);
    // From a surface of one temperature first: the scale is its.
    let all_lit = |i: &usize| {
        surface[*i] == 2.0 && lighting[i * lights..(i + 1) * lights].iter().sum::<f64>() > 1.0 - 1e-7
    };
    for i in (0..ROWS * COLUMNS).filter(all_lit).chain(0..ROWS * COLUMNS) {
        if depth_m[i].is_infinite() {
            assert!(material[i] == 65535.0 && temperature_k[i].is_nan());
            continue;
        }
        let v = &lighting[i * lights..(i + 1) * lights];
        // Where surfaces that are no surroundings light it, the files do not tell all: what is missing sends no more than twice as much.
        let missing = 1.0 - v.iter().sum::<f64>();
        if material[i] == 65535.0 || missing > 0.01 {
            continue;
        }
        let mut var_t = None;
        for (w, spectrum) in library.iter().enumerate().rev() {
            let (e, nu) = (spectrum[1 + material[i] as usize], spectrum[0]);
            let light: f64 = v.iter().zip(&surroundings[w][1..]).map(|(v, s)| v * s).sum();
            let radiance = e * photon_radiance(nu, temperature_k[i]) + (1.0 - e) * light;
            let ratio = counts[i * 21 + w] / radiance;
            let scale = *scale.get_or_insert(ratio);
            // Single precision; what is missing is no more than twice as bright.
            let tolerance = 2e-6 + 2.0 * (1.0 - e) * missing.abs();
            let apart = ratio / scale - 1.0;
            // Temperatures that vary within a pixel: ½ var_T B″ is more than B of their mean, with one variance in all bands, to
            // the third moment of what lies within (x³/6 (σ/T)³, 1e-5).
            let curved = 0.5 * e * photon_radiance_curvature(nu, temperature_k[i]) / radiance;
            let widest_k = [0.0, 1.0, 0.0, 2.0, 0.0, 0.0][surface[i] as usize];
            let var_t = *var_t.get_or_insert(if widest_k > 0.0 { apart / curved } else { 0.0 });
            let third = if widest_k > 0.0 { 2e-5 } else { 0.0 };
            assert!(
                var_t * curved > -tolerance
                    && var_t * curved < 3.0 * widest_k * widest_k * curved + tolerance,
                "{i}: {var_t} K²"
            );
            assert!(
                (apart - var_t * curved).abs() < tolerance + third,
                "{i} {w}: {apart} {}",
                var_t * curved
            );
        }
        seen[surface[i] as usize] += 1;
        compared += 1;
    }
    assert!(compared > 1000 && seen[1] > 500, "{compared} {seen:?}");
}

/// The scenario that is written takes it apart, and its intervals hold what is there.
#[test]
fn what_is_rendered_is_taken_apart_again() {
    let folder = Folder::with(SCENARIO);
    folder.json(&["render", "a.toml", "--out", "out", "--seed", "7"]);
    let found = folder.json(&["decompose", "out/decompose.toml"]);
    let truth = &found["truth"];
    let share = |key: &str| truth[key].as_f64().unwrap();
    assert!(share("right_material") > 0.95, "{truth}");
    assert!(share("right_where_decided") > 0.99, "{truth}");
    assert!(share("coverage_95") > 0.92, "{truth}");
    // The same seed draws the same counts, another one others.
    let first = fs::read(folder.path().join("out/counts.npy")).unwrap();
    folder.json(&["render", "a.toml", "--out", "again", "--seed", "7", "--threads", "1"]);
    assert!(first == fs::read(folder.path().join("again/counts.npy")).unwrap());
    folder.json(&["render", "a.toml", "--out", "again", "--seed", "8"]);
    assert!(first != fs::read(folder.path().join("again/counts.npy")).unwrap());
}

/// A list of bands in any order: the scenario that is written has it in that of the cube, whatever the list is of.
#[test]
fn a_list_of_bands_is_written_in_the_order_of_the_cube() {
    let ranges = "[bands]\nranges = [[\"8 um\", \"9 um\"], [\"11 um\", \"12.5 um\"], [\"9 um\", \"10 um\"], [\"10 um\", \"11 um\"]]\n";
    let grid = "[bands]\nstart = \"800 cm^-1\"\nstop = \"1200 cm^-1\"\nstep = \"20 cm^-1\"\n";
    let filters = "[bands]\nfilters = \"filters.csv\"\n";
    let rows = "[bands]\nrows = \"bands.csv\"\n";
    for bands in [ranges, filters, rows] {
        let folder = Folder::with(
            &SCENARIO.replace(grid, bands).replace("[camera]\n", "[camera]\nreadout = \"simultaneous\"\n"),
        );
        folder.file(
            "filters.csv",
            "wavelength_um,c,a,e,b,d\n8,0,1,0,0,0\n8.5,0,1,0,1,0\n9,0,0,0,1,0\n9.5,1,0,0,1,0\n10,1,0,0,0,1\n11,0,0,1,0,1\n12,0,0,1,0,0\n12.5,0,0,1,0,0\n",
        );
        folder.file("bands.csv", "wavenumber_cm1,width_cm1\n1200,90\n800,100\n1100,80\n900,70\n1000,90\n");
        folder.json(&["render", "a.toml", "--out", "out", "--no-noise"]);
        let found = folder.json(&["decompose", "out/decompose.toml"]);
        assert!(found["truth"]["temperature_rmse_k"].as_f64().unwrap() < 2.0, "{bands}: {}", found["truth"]);
        assert!(
            found["truth"]["right_where_decided"].as_f64().unwrap() > 0.95,
            "{bands}: {}",
            found["truth"]
        );
        let codes = found["warnings"].as_array().unwrap();
        assert!(codes.iter().all(|one| one["code"] != "band-order-taken"), "{bands}: {codes:?}");
    }
}

/// The folders of the database: the same numbers in other files, temperatures in degC, materials counted from 1.
#[test]
fn both_layouts_hold_the_same() {
    let folder = Folder::with(SCENARIO);
    folder.json(&["render", "a.toml", "--out", "npy"]);
    folder.json(&["render", "a.toml", "--out", "mat", "--layout", "hadar"]);
    let pair = |npy: &str, mat: &str| [samples(&folder, npy), samples(&folder, mat)];
    let [(a, shape), (b, other)] = pair("npy/counts.npy", "mat/HeatCubes/L_0001_heatcube.mat");
    assert!(a == b && shape == other);
    let [(a, shape), (b, other)] = pair("npy/lighting.npy", "mat/GroundTruth/vMap/vMap_L_0001.mat");
    assert!(a == b && shape == other);
    let [(a, _), (b, _)] = pair("npy/temperature_k.npy", "mat/GroundTruth/tMap/tMap_L_0001.mat");
    let same = |(k, c): (&f64, &f64)| (k - 273.15 - c).abs() < 1e-4 || (k.is_nan() && c.is_nan());
    assert!(a.iter().zip(&b).all(same));
    let [(a, _), (b, _)] = pair("npy/material.npy", "mat/GroundTruth/eMap/eMap_L_0001.mat");
    assert!(a.iter().zip(&b).all(|(from_0, from_1)| (from_0 + 1.0) % 65536.0 == *from_1));
    let (list, _) = samples(&folder, "mat/GroundTruth/eMap/eList.mat");
    assert_eq!(list, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
    // Written over itself, and taken apart.
    folder.json(&["render", "a.toml", "--out", "mat", "--layout", "hadar", "--seed", "2"]);
    let found = folder.json(&["decompose", "mat/decompose.toml"]);
    assert_eq!(found["pixels"].as_u64(), Some((ROWS * COLUMNS) as u64));
    // What somebody else put there stays.
    folder.file("mat/GroundTruth/mine.txt", "mine");
    let refused = folder.refusal(&["render", "a.toml", "--out", "mat", "--layout", "hadar"]);
    assert!(refused.contains("`GroundTruth`"), "{refused}");
}

/// Taken apart, the truth of the database's folders, converted, says what that of NPY files does; so does an ENVI file.
#[test]
fn every_layout_is_taken_apart_to_the_same() {
    let folder = Folder::with(&SCENARIO.replace("size = [48, 64]", "size = [12, 16]"));
    let found = [("npy", "--layout", "npy"), ("mat", "--layout", "hadar"), ("envi", "--cube-format", "envi")]
        .map(|(out, key, value)| {
            folder.json(&["render", "a.toml", "--out", out, key, value]);
            folder.json(&["decompose", &format!("{out}/decompose.toml")])
        });
    assert_eq!(found[2]["read"]["format"], "ENVI BIP");
    for key in ["right_material", "temperature_rmse_k", "coverage_95"] {
        let [npy, mat, envi] = [0, 1, 2].map(|i| found[i]["truth"][key].as_f64().unwrap());
        assert_eq!(npy, envi, "{key}");
        // Temperatures of the database are rounded in degC.
        assert!((npy - mat).abs() < 1e-3 * npy, "{key}: {npy} {mat}");
    }
}

/// A scene of the database by its folder: the left view, and its maps where they are asked for.
#[test]
fn a_folder_of_the_database_is_a_cube_and_its_truth() {
    let folder = Folder::with(
        &(SCENARIO.replace("size = [48, 64]", "size = [12, 16]") + "[stereo]\nbaseline = \"0.2 m\"\n"),
    );
    folder.json(&["render", "a.toml", "--out", "Scene1", "--layout", "hadar"]);
    let own = folder.json(&["decompose", "Scene1/decompose.toml"]);
    let text = fs::read_to_string(folder.path().join("Scene1/decompose.toml")).unwrap();
    let (head, truth) = text.split_once("[truth]\n").unwrap();
    let rest = truth.split_once("\n\n").map_or("", |(_, rest)| rest);
    let data = head.lines().find(|line| line.starts_with("data = ")).unwrap().to_owned();
    let head = head.replace(&data, "data = \"../Scene1\"").replace("variable = \"S\"\n", "");
    folder.file("Scene1/b.toml", &format!("{head}[truth]\nscene = \"../Scene1\"\n\n{rest}"));
    let found = folder.json(&["decompose", "Scene1/b.toml"]);
    assert_eq!(found["read"]["file"], "L_0001_heatcube.mat");
    assert_eq!(found["truth"], own["truth"]);
    folder.file(
        "Scene1/c.toml",
        &format!("{head}[truth]\nscene = \"../Scene1\"\ntemperature = \"a.npy\"\n\n{rest}"),
    );
    assert!(folder.refusal(&["decompose", "Scene1/c.toml"]).contains("truth"));
    // Several views of one side are not guessed among.
    let cubes = folder.path().join("Scene1/HeatCubes");
    fs::copy(cubes.join("L_0001_heatcube.mat"), cubes.join("L_0002_heatcube.mat")).unwrap();
    let refused = folder.refusal(&["decompose", "Scene1/b.toml"]);
    assert!(
        refused
            .contains("holds L_0001_heatcube.mat, L_0002_heatcube.mat, R_0001_heatcube.mat; name the file"),
        "{refused}"
    );
    fs::remove_file(cubes.join("L_0002_heatcube.mat")).unwrap();
    folder.file(
        "range.toml",
        "[cube]\nleft = \"Scene1\"\nright = \"Scene1\"\ndepth = \"10 m\"\nnoise_variance = 10.0\n[stereo]\nbaseline = \"1 mm\"\n\
         focal_length = \"14 mm\"\npixel = \"12 um\"\n",
    );
    let found = folder.json(&["range", "range.toml"]);
    assert!(found["scenario"]["cube"]["right"].as_str().unwrap().ends_with("HeatCubes/R_0001_heatcube.mat"));
    fs::create_dir(folder.path().join("none")).unwrap();
    folder.file("d.toml", "[cube]\nleft = \"none\"\n[stereo]\nbaseline = \"1 mm\"\nfocal_length = \"14 mm\"\npixel = \"12 um\"\n");
    assert!(folder.refusal(&["range", "d.toml"]).contains("has no HeatCubes; name the file of a cube"));
}

/// A sky of a spectrum is that of the material that it was written from; a pair of cameras gives two views.
#[test]
fn skies_and_views_are_what_is_said() {
    let folder = Folder::with(SCENARIO);
    folder.json(&["render", "a.toml", "--no-noise", "--out", "out"]);
    fs::copy(folder.path().join("out/surroundings.csv"), folder.path().join("sky.csv")).unwrap();
    let spectral = SCENARIO.replace(
        "sky = { material = \"sky-us-standard\", temperature = \"288 K\" }",
        "sky = { spectrum = \"sky.csv\", column = \"sky\" }",
    );
    folder.file("b.toml", &(spectral + "[stereo]\nbaseline = \"0.2 m\"\n"));
    folder.json(&["render", "b.toml", "--no-noise", "--out", "pair"]);
    let (one, _) = samples(&folder, "out/counts.npy");
    let (right, _) = samples(&folder, "pair/right_counts.npy");
    let (left, _) = samples(&folder, "pair/counts.npy");
    assert_ne!(left, right);
    // The left camera of the pair stands 10 cm to the left; the ground far ahead and the sky look the same.
    let sky = |cube: &[f64]| cube[..21].to_vec();
    assert!(sky(&one).iter().zip(sky(&left)).all(|(a, b)| (a / b - 1.0).abs() < 1e-6));
    // The same file is a ranging scenario.
    let ranged = folder.json(&["range", "b.toml"]);
    assert!(ranged["verdict"].is_object(), "{ranged}");
}

#[test]
fn mistakes_are_told_in_one_line() {
    let folder = Folder::with(SCENARIO);
    assert!(folder.refusal(&["render", "a.toml"]).contains("--out"));
    for (wrong, instead, said) in [
        ("shape = \"robot\"", "shape = \"robt\"", "object[1].shape"),
        ("shape = \"robot\"\n", "", "object[1].shape"),
        ("at = [\"0 m\", \"8 m\"]", "at = [\"0 m\", \"-8 m\"]", "object[1].at[1]"),
        ("at = [\"0 m\", \"8 m\"]", "at = [\"0 m\"]", "object[1].at"),
        ("at = [\"0 m\", \"8 m\"]\n", "", "object[1].at"),
        ("material = \"skin\"", "material = \"skim\"", "object[0].material"),
        ("material = \"skin\"\n", "", "object[0].material"),
        ("roughness = 0.2", "roughness = 2", "object[0].roughness"),
        ("roughness = 0.2", "radius = \"1 m\"", "object[0].radius"),
        ("variation = \"2 K\"", "variation = \"20 K\"", "at most 12 K"),
        ("variation = \"2 K\"", "variation = \"-2 K\"", "object[1].variation"),
        ("size = [48, 64]", "size = [0, 64]", "scene"),
        ("size = [48, 64]", "size = [48, 64]\ncar_temperature = \"20 degC\"", "scene.car_temperature"),
        ("size = [48, 64]", "size = [48, 64]\nsky_temperature = \"20 degC\"", "scene"),
        ("library = [\"concrete\", \"asphalt\"]", "library = [\"concret\"]", "scene.library[0]"),
        ("temperature = \"288 K\" }", "temperature = \"0 K\" }", "scene.sky.temperature"),
        ("[scene]", "[scenery]", "scenery"),
        ("at = [\"-1.2 m\", \"8 m\"]", "at = [\"0 m\", \"0.1 m\"]\nheight = \"3 m\"", "inside"),
    ] {
        assert!(SCENARIO.contains(wrong), "{wrong}");
        folder.file("wrong.toml", &SCENARIO.replacen(wrong, instead, 1));
        let refused = folder.refusal(&["render", "wrong.toml", "--out", "out"]);
        assert!(refused.contains(said), "{instead}: {refused}");
    }
}
