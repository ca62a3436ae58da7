//! `hadar range` as a user runs it: scenes and cubes, bounds against closed forms, every mistake one line.

use crate::support::folder::{Folder, Outcome};
use hadar::cube::Shape;
use hadar_formats::cube::write_npy;
use serde_json::Value;
use std::f64::consts::PI;
use std::fs;
use std::path::Path;

const ROWS: usize = 9;
const COLUMNS: usize = 40;
const BANDS: usize = 3;
const PHOTONS: f64 = 1000.0;
const CONTRAST: f64 = 0.1;
const OMEGA: f64 = 0.5;

/// A texture N(1 + c sin ωx), the same in every row and band.
fn samples() -> Vec<f64> {
    let pixel = |x: usize| PHOTONS * (1.0 + CONTRAST * (OMEGA * x as f64).sin());
    (0..ROWS * COLUMNS).flat_map(|i| [pixel(i % COLUMNS); BANDS]).collect()
}

fn shape() -> Shape {
    Shape::new(ROWS, COLUMNS, BANDS).unwrap()
}

pub(crate) const CUBE: &str = "[cube]\nleft = \"left.npy\"\ndepth = \"10 m\"\n[stereo]\nbaseline = \"0.2 m\"\n\
                    focal_length = \"14 mm\"\npixel = \"12 um\"\n[requirement]\nrelative_depth_error = 0.05\n";

/// A small, quick street.
pub(crate) const SCENE: &str = "[scene]\nsize = [60, 80]\nsky_temperature = \"-15 degC\"\n\
                     [bands]\nstart = \"720 cm^-1\"\nstop = \"1240 cm^-1\"\nstep = \"40 cm^-1\"\n\
                     [camera]\nexposure = \"12 ms\"\npixel = \"96 um\"\nf_number = 1.4\nfocal_length = \"14 mm\"\nnoise_electrons = 0\n\
                     [stereo]\nbaseline = \"0.2 m\"\n";

pub(crate) fn with_cube(scenario: &str) -> Folder {
    let folder = Folder::with(scenario);
    write_npy(&folder.path().join("left.npy"), shape(), &samples()).unwrap();
    folder
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// Depth error of a window by hand: J = Σ (N c sin(ω) cos(ωx))²/N(x), central difference of the sine.
#[test]
fn a_cube_has_the_bound_of_its_closed_form() {
    let folder = with_cube(CUBE);
    let result = folder.json(&["range", "a.toml"]);
    let information = |centre: usize| -> f64 {
        let pixel = |x: usize| {
            let slope = PHOTONS * CONTRAST * OMEGA.sin() * (OMEGA * x as f64).cos();
            slope * slope / (PHOTONS * (1.0 + CONTRAST * (OMEGA * x as f64).sin()))
        };
        (5 * BANDS) as f64 * (centre - 2..=centre + 2).map(pixel).sum::<f64>()
    };
    let mut all: Vec<f64> = (3..COLUMNS - 3).map(information).collect();
    all.sort_by(f64::total_cmp);
    let found = &result["objects"][0]["signals"][1];
    assert_eq!(found["signal"], "heat-cube");
    let j = number(&found["information_per_px2"]);
    // The median of an even number of windows is one of the two in the middle.
    let middle = [all[all.len() / 2 - 1], all[all.len() / 2]];
    assert!(middle.iter().any(|m| (j / m - 1.0).abs() < 1e-12), "{j} is not among {middle:?}");
    let disparity = number(&found["disparity_error_px"]);
    assert!(middle.iter().any(|m| (disparity / (2.0 / m).sqrt() - 1.0).abs() < 1e-12));
    let depth = number(&found["depth_error_m"][1]);
    assert!((depth / (100.0 / (0.2 * 0.014) * 12e-6 * disparity) - 1.0).abs() < 1e-12);
    // A texture common to all bands: joining them loses nothing without electronic noise.
    let thermal = number(&result["objects"][0]["signals"][0]["information_per_px2"]);
    assert!((thermal / j - 1.0).abs() < 1e-12);
    assert_eq!(result["verdict"]["met"], true);
    assert_eq!(number(&result["objects"][0]["depth_m"][1]), 10.0);
}

/// With noise σ² in every sample J is lower in closed form; bands read apart have as much of it each.
#[test]
fn noise_of_every_reading_is_counted_once_for_each() {
    let with_noise = |joined: &str| {
        let scenario =
            CUBE.replace("depth = ", "noise_variance = 4000.0\ndepth = ").replace("[requirement]", joined);
        let folder = with_cube(&scenario);
        let signals = folder.json(&["range", "a.toml"])["objects"][0]["signals"].clone();
        [0, 1].map(|i| number(&signals[i]["information_per_px2"]))
    };
    let [sum, apart] = with_noise("[requirement]");
    assert!((sum / apart - 1.0).abs() < 1e-12, "as many readings either way");
    let [once, again] = with_noise("joined = \"one-reading\"\n[requirement]");
    assert_eq!(again, apart);
    // (3N)'²/(3N + σ²) against 3 N'²/(N + σ²), N = 1000 within a tenth and σ² = 4000: 3(N + σ²)/(3N + σ²) = 15/7.
    assert!((once / apart / (15.0 / 7.0) - 1.0).abs() < 0.02, "{once} {apart}");
}

/// A unit of the file that stands for g photons: information grows with g.
#[test]
fn photons_per_unit_scale_the_information() {
    let of = |scenario: &str| {
        let result = with_cube(scenario).json(&["range", "a.toml"]);
        number(&result["objects"][0]["signals"][1]["information_per_px2"])
    };
    let scaled = CUBE.replace("depth = ", "photons_per_unit = 25.0\ndepth = ");
    assert!((of(&scaled) / of(CUBE) / 25.0 - 1.0).abs() < 1e-12);
}

/// Two views add their variances; a right view with a quarter of the photons has four times the variance.
#[test]
fn the_right_view_counts_as_it_is() {
    let folder = with_cube(&CUBE.replace("depth = ", "right = \"right.npy\"\ndepth = "));
    let quarter: Vec<f64> = samples().iter().map(|n| 0.25 * n).collect();
    write_npy(&folder.path().join("right.npy"), shape(), &quarter).unwrap();
    let both = folder.json(&["range", "a.toml"]);
    // d = 23.3 pixels at 10 m: only windows far to the right have a partner in view.
    let windows = both["objects"][0]["windows"].as_u64().unwrap();
    let alone = with_cube(CUBE).json(&["range", "a.toml"])["objects"][0]["windows"].as_u64().unwrap();
    assert!(windows < alone, "{windows} of {alone}");
    assert!(windows > 0);
}

#[test]
fn a_scene_orders_its_signals_and_repeats_itself() {
    let folder = Folder::with(SCENE);
    let result = folder.json(&["range", "a.toml"]);
    for object in result["objects"].as_array().unwrap() {
        let information: Vec<f64> = object["signals"]
            .as_array()
            .unwrap()
            .iter()
            .map(|found| number(&found["information_per_px2"]))
            .collect();
        let [thermal, cube, known, blind, _] = information[..] else { panic!("{information:?}") };
        // No cell exceeds the cube's, nothing that is estimated from the cube tells more than the cube.
        assert!(
            thermal <= cube * (1.0 + 1e-9) && known <= cube * (1.0 + 1e-9),
            "{}: {information:?}",
            object["name"]
        );
        assert!(blind <= known * (1.0 + 1e-9), "{}: {information:?}", object["name"]);
        assert!(information.iter().all(|j| j.is_finite()));
    }
    let again = folder.run(&["range", "a.toml", "--json", "--threads", "1"]).stdout;
    assert_eq!(serde_json::from_str::<Value>(&again).unwrap(), result);
    let cells = &result["cells"];
    let at = |cell: &str| number(&cells[cell]);
    assert!(at("total") <= at("spatial") && at("spatial") <= at("full") && at("spectral") <= at("full"));
}

/// Equilibrium: road, sky, car and person at one temperature. Emitted and scattered light add up to the same in every pixel, so that the
/// thermal image and the cube have no texture but rounding; the scattered signal alone is full of it.
#[test]
fn at_one_temperature_there_is_nothing_to_see() {
    let scene = SCENE
        .replace("-15 degC", "20 degC")
        .replace("size", "ground_temperature = \"20 degC\"\ncar_temperature = \"20 degC\"\nperson_temperature = \"20 degC\"\nbounces = 64\nsize");
    let result = Folder::with(&scene).json(&["range", "a.toml"]);
    let ground =
        result["objects"].as_array().unwrap().iter().find(|object| object["name"] == "ground").unwrap();
    let j = |i: usize| number(&ground["signals"][i]["information_per_px2"]);
    let (cube, alone) = (j(1), j(4));
    assert!(cube < 1e-9 * alone, "{cube} beside {alone}");
}

#[test]
fn a_report_has_every_plot_with_its_table_and_its_maps() {
    let folder = Folder::with(&SCENE.replace("[stereo]", "[stereo]\nlines = [38]"));
    let outcome = folder.run(&["range", "a.toml", "--trials", "4", "--out", "out", "-q"]);
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    for name in ["views", "bounds_map", "matched", "line_38", "derivatives"] {
        for kind in ["svg", "png", "csv"] {
            let path = folder.path().join(format!("out/{name}.{kind}"));
            // What is made of images is one.
            let there = kind != "svg" || ["line_38", "derivatives"].contains(&name);
            let found = fs::metadata(&path).is_ok_and(|file| file.len() > 0);
            assert_eq!(found, there, "{}", path.display());
        }
    }
    let map = folder.path().join("out/disparity_error_px_heat_cube.npy");
    let cube = hadar_formats::cube::open(&map, None).unwrap();
    assert_eq!((cube.shape().rows(), cube.shape().columns()), (56, 76));
    let again = folder.run(&["range", "out/scenario.toml", "-q"]);
    assert_eq!(again.code, 0, "{}", again.stderr);
    let line = fs::read_to_string(folder.path().join("out/line_38.csv")).unwrap();
    assert!(line.contains("block matching") && line.contains("maximum likelihood"));
    // Both bounds, whether there are trials or not: matches are of views without diffraction.
    let bare = folder.run(&["range", "a.toml", "--out", "bare", "-q"]);
    assert_eq!(bare.code, 0, "{}", bare.stderr);
    let bounds = |text: &str| -> Vec<[f64; 2]> {
        let head: Vec<&str> = text.lines().next().unwrap().split(',').collect();
        let at = ["bound_m", "bound_without_diffraction_m"]
            .map(|name| head.iter().position(|column| *column == name).unwrap());
        let of_thermal = text.lines().filter(|line| line.contains("thermal image"));
        let rows = of_thermal.map(|line| line.split(',').collect::<Vec<_>>());
        rows.map(|row| at.map(|i| row[i].parse().unwrap())).collect()
    };
    let bare = bounds(&fs::read_to_string(folder.path().join("bare/line_38.csv")).unwrap());
    assert!(!bare.is_empty() && bare.iter().all(|[with, without]| with > without), "{bare:?}");
    assert_eq!(bounds(&line)[..bare.len()], bare);
}

#[test]
fn a_check_says_yes_or_no_by_the_cheapest_proof_and_the_same() {
    for (scenario, code) in [(CUBE.to_owned(), 0), (CUBE.replace("0.05", "0.0001"), 3)] {
        let folder = with_cube(&scenario);
        let accepted = ["range", "a.toml", "--check", "--accept", UNSTATED];
        let quick = folder.run(&[&accepted[..], &["--stats"]].concat());
        let whole = folder.run(&[&accepted[..], &["--no-skip"]].concat());
        assert_eq!((quick.code, whole.code), (code, code), "{} {}", quick.stderr, whole.stderr);
        assert_eq!(folder.run(&["range", "a.toml", "--check"]).code, 3);
        // The proofs say nothing of the thermal image.
        let answer = |outcome: &Outcome| outcome.stdout.split(" required)").next().unwrap().to_owned();
        assert_eq!(answer(&quick), answer(&whole));
    }
}

/// What nobody stated of the cube.
const UNSTATED: &str = "shot-noise-alone,samples-are-photons,expected-counts";

/// A figure that is left out makes no better verdict without saying so.
#[test]
fn a_yes_on_a_cube_names_what_nobody_stated() {
    let codes = |scenario: &str, arguments: &[&str]| -> Vec<String> {
        let result = with_cube(scenario).json(&[&["range", "a.toml"], arguments].concat());
        assert_eq!(result["verdict"]["met"], true);
        let conditions = result["verdict"]["conditions"].as_array().unwrap();
        let mut codes: Vec<String> =
            conditions.iter().map(|one| one["code"].as_str().unwrap().to_owned()).collect();
        codes.sort();
        codes
    };
    let mut all: Vec<&str> = UNSTATED.split(',').collect();
    all.sort_unstable();
    assert_eq!(codes(CUBE, &[]), all);
    assert_eq!(codes(CUBE, &["--set", "requirement.relative_depth_error=0.06"]).len(), 4);
    let stated = CUBE.replace("depth = ", "noise_variance = 0.001\nphotons_per_unit = 1.0\ndepth = ");
    assert_eq!(codes(&stated, &[]), ["expected-counts"]);
}

/// Counts beyond a stated well meet nothing, proved or not; a well that holds them changes nothing.
#[test]
fn no_yes_rests_on_counts_beyond_the_well() {
    let brightest = samples().into_iter().fold(0.0, f64::max);
    for (well, met) in [(0.99 * brightest, false), (1.01 * brightest, true)] {
        let camera = format!(
            "[camera]\nfocal_length = \"14 mm\"\npixel = \"12 um\"\nf_number = 1.0\nexposure = \"10 ms\"\nnoise_electrons = 1\nfull_well = {well}\n[stereo]"
        );
        let scenario = CUBE
            .replace("focal_length = \"14 mm\"\n", "")
            .replace("pixel = \"12 um\"\n", "")
            .replace("depth = ", "noise_variance = 0.001\ndepth = ")
            .replace("[stereo]", &camera);
        let folder = with_cube(&scenario);
        for arguments in [&["range", "a.toml", "--json"][..], &["range", "a.toml", "--check", "--json"]] {
            let result: Value = serde_json::from_str(&folder.run(arguments).stdout).unwrap();
            assert_eq!(result["verdict"]["met"], met, "{arguments:?}: {}", result["verdict"]["sentence"]);
        }
    }
}

/// Windows without a photon, under electronic noise: no texture, no bound, and counted as such by the proofs and by the bounds.
#[test]
fn windows_without_photons_count_as_not_reaching_it() {
    let scenario = CUBE.replace("depth = ", "noise_variance = 4.0\ndepth = ");
    let folder = with_cube(&scenario);
    let dark: Vec<f64> =
        samples().iter().enumerate().map(|(i, n)| if i / BANDS % COLUMNS < 14 { *n } else { 0.0 }).collect();
    write_npy(&folder.path().join("left.npy"), shape(), &dark).unwrap();
    let share = |arguments: &[&str]| {
        let outcome = folder.run(&[&["range", "a.toml", "--json"], arguments].concat());
        let result: Value = serde_json::from_str(&outcome.stdout).unwrap();
        (
            outcome.code,
            number(&result["verdict"]["share"]),
            result["stats"]["windows"]["possible"].as_u64().unwrap(),
        )
    };
    // Centres 3 to 36: those from 17 on see dark pixels alone, and at 16 the slope from the last bright one.
    let (code, proved, windows) = share(&["--check"]);
    assert_eq!((code, windows), (3, 5 * 34));
    assert!((proved - 14.0 / 34.0).abs() < 1e-12, "{proved}");
    assert_eq!(share(&["--check", "--no-skip"]), (code, proved, windows));
    assert_eq!(share(&[]), (0, proved, windows));
}

/// One line on stderr that names file, line or key, what was found and what to write.
#[test]
fn every_mistake_is_one_line() {
    let mistakes: [(&str, String, &str); 17] = [
        ("zero baseline", CUBE.replace("0.2 m", "0 m"), "stereo.baseline: `0 m` is out of range"),
        (
            "even window",
            CUBE.replace("[requirement]", "window = [4, 5]\n[requirement]"),
            "a window of 4 x 5 pixels",
        ),
        ("large window", CUBE.replace("[requirement]", "window = [11, 5]\n[requirement]"), "11"),
        ("wide window", CUBE.replace("[requirement]", "window = [5, 39]\n[requirement]"), "39"),
        ("no cube", CUBE.replace("left.npy", "none.npy"), "none.npy"),
        ("neither", "[stereo]\nbaseline = \"0.2 m\"\n".into(), "neither a [scene] nor a [cube]"),
        ("both", format!("[scene]\n{CUBE}"), "`scene` is given as well"),
        ("no stereo", "[cube]\nleft = \"left.npy\"\n".into(), "stereo: the table is missing"),
        (
            "no focal length",
            CUBE.replace("focal_length = \"14 mm\"\n", ""),
            "write focal_length = \"1.4 cm\"",
        ),
        (
            "unknown derivative",
            CUBE.replace("[requirement]", "derivative = \"sobel\"\n[requirement]"),
            "`sobel` is not known",
        ),
        (
            "bands",
            format!("{CUBE}[bands]\nstart = \"800 cm^-1\"\nstop = \"900 cm^-1\"\nstep = \"100 cm^-1\"\n"),
            "[bands] are 2, the cube has 3",
        ),
        (
            "scene without camera",
            "[scene]\n[stereo]\nbaseline = \"0.2 m\"\n".into(),
            "camera: the table is missing",
        ),
        (
            "line out of view",
            CUBE.replace("[requirement]", "lines = [400]\n[requirement]"),
            "row 400 has no whole window",
        ),
        (
            "negative noise",
            CUBE.replace("depth = ", "noise_variance = -1.0\ndepth = "),
            "noise_variance is -1",
        ),
        (
            "unknown material",
            SCENE.replace("size", "person = \"skinn\"\nsize"),
            "there is no material `skinn`",
        ),
        ("bounces", SCENE.replace("size", "bounces = 1000\nsize"), "write a whole number from 1 to 64"),
        (
            "airy without camera",
            CUBE.replace("[requirement]", "diffraction = \"airy\"\n[requirement]"),
            "needs a camera",
        ),
    ];
    for (what, scenario, said) in mistakes {
        let outcome = with_cube(&scenario).run(&["range", "a.toml"]);
        assert_eq!(outcome.code, 1, "{what}: {}{}", outcome.stdout, outcome.stderr);
        assert!(outcome.stderr.contains(said), "{what}: {}", outcome.stderr);
        assert_eq!(outcome.stderr.trim_end().lines().count(), 1, "{what}: {}", outcome.stderr);
        assert!(outcome.stderr.starts_with("error: "), "{what}: {}", outcome.stderr);
    }
}

/// Counts that are none, views that do not fit, files that are cut short.
#[test]
fn bad_cubes_are_told_by_what_is_wrong_with_them() {
    let said = |scenario: &str, prepare: &dyn Fn(&Path)| {
        let folder = with_cube(scenario);
        prepare(folder.path());
        // A single pixel that is so is left out as bad, unless it is kept.
        let outcome = folder.run(&["range", "a.toml", "--bad", "keep"]);
        assert_eq!(outcome.code, 1, "{}{}", outcome.stdout, outcome.stderr);
        assert_eq!(outcome.stderr.trim_end().lines().count(), 1, "{}", outcome.stderr);
        outcome.stderr
    };
    for (value, words) in [(-5.0, "-5"), (0.0, "0")] {
        let error = said(CUBE, &|folder| {
            let mut bad = samples();
            bad[(4 * COLUMNS + 17) * BANDS + 1] = value;
            write_npy(&folder.join("left.npy"), shape(), &bad).unwrap();
        });
        assert!(
            error.contains("row 4") && error.contains("column 17") && error.contains("band 1"),
            "{error}"
        );
        assert!(error.contains(words), "{error}");
    }
    let right = CUBE.replace("depth = ", "right = \"right.npy\"\ndepth = ");
    let error = said(&right, &|folder| {
        let other = Shape::new(ROWS, COLUMNS - 1, BANDS).unwrap();
        write_npy(&folder.join("right.npy"), other, &vec![1.0; other.len()]).unwrap();
    });
    assert!(error.contains("cube.right") && error.contains("39 columns"), "{error}");
    let error = said(CUBE, &|folder| {
        let path = folder.join("left.npy");
        let bytes = fs::read(&path).unwrap();
        fs::write(&path, &bytes[..bytes.len() - 9]).unwrap();
    });
    assert!(error.contains("left.npy"), "{error}");
    let error = said(CUBE, &|folder| {
        let path = folder.join("left.npy");
        let text = String::from_utf8_lossy(&fs::read(&path).unwrap()[..]).into_owned();
        assert!(text.contains("<f8"));
        let mut bytes = fs::read(&path).unwrap();
        let at = bytes.windows(3).position(|window| window == b"<f8").unwrap();
        bytes[at + 1] = b'c';
        fs::write(&path, bytes).unwrap();
    });
    assert!(error.contains("astype"), "{error}");
    let noise = CUBE.replace("depth = ", "noise_variance = \"noise.csv\"\ndepth = ");
    let error = said(&noise, &|folder| {
        fs::write(folder.join("noise.csv"), "band,variance_counts2\n1,50\n2,50\n").unwrap();
    });
    assert!(error.contains("noise.csv") && error.contains('3'), "{error}");
    let depth = CUBE.replace("\"10 m\"", "\"depth.npy\"");
    let error = said(&depth, &|folder| {
        write_npy(&folder.join("depth.npy"), Shape::new(3, 3, 1).unwrap(), &[1.0; 9]).unwrap();
    });
    assert!(error.contains("cube.depth"), "{error}");
}

/// A texture of known frequency: each derivative finds what its closed form says.
#[test]
fn derivatives_err_as_their_closed_form_says() {
    let folder = with_cube(CUBE);
    assert_eq!(folder.run(&["range", "a.toml", "--out", "out", "-q"]).code, 0);
    let mut reader = csv::Reader::from_path(folder.path().join("out/derivatives.csv")).unwrap();
    let mut rows = 0;
    for record in reader.records().map(Result::unwrap) {
        let value = |i: usize| record[i].parse::<f64>().unwrap();
        // The ends of a row reach into a spline by 0.27 per pixel; of a Fourier series of a mirrored sine by its kink there.
        let tolerance = if &record[1] == "fourier" { 0.02 } else { 1e-9 };
        if value(0) < 0.49 {
            assert!((value(2) - value(3)).abs() < tolerance, "{record:?}");
            rows += 1;
        }
        if &record[1] == "central" {
            let omega = 2.0 * PI * value(0);
            assert!((value(3) - omega.sin() / omega).abs() < 1e-12);
        }
    }
    assert!(rows > 200);
}

/// A sample of 0 counts without noise has no quotient (dN)²/N: where a camera counts it is refused, where it is only imagined
/// the windows that have one have no bound, and how many is said. With noise all of them have one.
#[test]
fn samples_of_nothing_have_no_bound_and_that_is_said() {
    let scene = SCENE.replace("size = [60, 80]", "size = [60, 80]\nground_emissivity = [0.8, 1.0]");
    let result = Folder::with(&scene).json(&["range", "a.toml"]);
    let all = &result["objects"][0];
    let windows = |of: &Value| of["windows"].as_u64().unwrap();
    let dark = windows(all) - windows(&all["signals"][4]);
    assert!(dark > 0 && dark < windows(all) / 2, "{dark} of {}", windows(all));
    for signal in &all["signals"].as_array().unwrap()[..4] {
        assert_eq!(windows(signal), windows(all), "{signal}");
    }
    let said = result["warnings"].as_array().unwrap();
    let said = said.iter().find(|warning| warning["code"] == "dark-samples").unwrap();
    let expected = format!("scattered, as if measured: {dark} of {} windows have no bound", windows(all));
    assert!(said["message"].as_str().unwrap().starts_with(&expected), "{said}");

    let noisy = scene.replace("noise_electrons = 0", "noise_electrons = 10");
    let result = Folder::with(&noisy).json(&["range", "a.toml"]);
    assert_eq!(windows(&result["objects"][0]["signals"][4]), windows(&result["objects"][0]));
    assert!(!result["warnings"].to_string().contains("dark-samples"));

    let folder = Folder::with(CUBE);
    let mut counts = samples();
    counts[500] = 0.0;
    write_npy(&folder.path().join("left.npy"), shape(), &counts).unwrap();
    assert!(folder.refusal(&["range", "a.toml", "--bad", "keep"]).contains("give a noise variance above 0"));
}

/// Windows are those whose centre has a depth.
#[test]
fn depths_that_are_not_known_are_no_windows() {
    let folder = with_cube(&CUBE.replace("\"10 m\"", "\"depth.npy\""));
    let mut depths = vec![f64::NAN; ROWS * COLUMNS];
    for (row, column) in [(5, 7), (5, 8), (6, 20)] {
        depths[row * COLUMNS + column] = 10.0;
    }
    write_npy(&folder.path().join("depth.npy"), Shape::new(ROWS, COLUMNS, 1).unwrap(), &depths).unwrap();
    assert_eq!(folder.json(&["range", "a.toml"])["objects"][0]["windows"], 3);
}

/// An ENVI file of the texture, with more lines in its header.
fn envi(folder: &Folder, more: &str) {
    let data: Vec<u8> = samples().into_iter().flat_map(f64::to_le_bytes).collect();
    fs::write(folder.path().join("left.img"), data).unwrap();
    folder.file(
        "left.hdr",
        &format!(
            "ENVI\nsamples = {COLUMNS}\nlines = {ROWS}\nbands = {BANDS}\ndata type = 5\ninterleave = bip\nbyte order = 0\n{more}\n"
        ),
    );
}

#[test]
fn what_is_no_count_by_its_file_is_refused() {
    let folder = Folder::with(&CUBE.replace("left.npy", "left.hdr"));
    let scaled =
        CUBE.replace("left.npy", "left.hdr").replace("depth = ", "photons_per_unit = 25.0\ndepth = ");
    folder.file("b.toml", &scaled);
    for unit in
        ["data units = Kelvin", "units = K", "data units = 0.01 K", "reflectance scale factor = 10000"]
    {
        envi(&folder, unit);
        for scenario in ["a.toml", "b.toml"] {
            let refused = folder.refusal(&["range", scenario]);
            assert!(refused.contains("cube.left: the samples are `"), "{refused}");
            assert!(
                refused.contains("by their file, of which no factor makes photons; give the counts"),
                "{refused}"
            );
        }
    }
    // Of a unit that may be in proportion to counts the scale has to be said; it is named in the answer.
    for unit in ["W m-2 sr-1 um-1", "DN"] {
        envi(&folder, &format!("data units = {unit}"));
        let refused = folder.refusal(&["range", "a.toml"]);
        assert!(refused.contains(&format!(
            "in `{unit}` by their file, not in photons; give photon counts, or write photons_per_unit"
        )));
        let said = folder.run(&["range", "b.toml"]).stdout;
        assert!(
            said.contains(&format!("left.img (ENVI BIP; in {unit})"))
                || said.contains(&format!("left.hdr (ENVI BIP; in {unit})")),
            "{said}"
        );
    }
    envi(&folder, "data units = Photon counts");
    folder.json(&["range", "a.toml"]);
}

fn codes(found: &Value) -> Vec<&str> {
    found["warnings"].as_array().unwrap().iter().map(|warning| warning["code"].as_str().unwrap()).collect()
}

/// Three missing samples: their windows have no bound and are counted, the others keep theirs, and the maps say where they are.
#[test]
fn missing_samples_cost_their_windows_alone() {
    let folder = with_cube(CUBE);
    let whole = folder.json(&["range", "a.toml", "--out", "whole"]);
    let mut gaps = samples();
    for (row, column) in [(0, 20), (4, 30)] {
        gaps[(row * COLUMNS + column) * BANDS + 1] = f64::NAN;
    }
    write_npy(&folder.path().join("left.npy"), shape(), &gaps).unwrap();
    let found = folder.json(&["range", "a.toml", "--out", "gaps"]);
    let map = |out: &str| {
        let path = folder.path().join(format!("{out}/disparity_error_px_heat_cube.npy"));
        let hadar::cube::Cube::F64(map) = hadar_formats::cube::open(&path, None).unwrap() else {
            panic!("f64")
        };
        assert_eq!((map.shape().rows(), map.shape().columns()), (ROWS - 4, COLUMNS - 6));
        map.read(0..ROWS - 4, &mut Vec::new()).unwrap().to_vec()
    };
    let (before, after) = (map("whole"), map("gaps"));
    let mut missing = 0;
    for (i, (before, after)) in before.iter().zip(&after).enumerate() {
        let (row, column) = (i / (COLUMNS - 6) + 2, i % (COLUMNS - 6) + 3);
        let holds = |y: usize, x: usize| row.abs_diff(y) <= 2 && column.abs_diff(x) <= 3;
        if holds(0, 20) || holds(4, 30) {
            missing += 1;
            assert!(after.is_nan());
        } else {
            assert_eq!(before, after);
        }
    }
    assert_eq!(missing, 7 + 5 * 7);
    assert_eq!(found["missing_windows"], missing);
    assert_eq!(found["maps_begin_at"], serde_json::json!([2, 3]));
    assert_eq!(
        whole["objects"][0]["windows"].as_u64().unwrap(),
        found["objects"][0]["windows"].as_u64().unwrap() + missing
    );
    assert!(whole.get("missing_windows").is_none() && codes(&found).contains(&"windows-missing"));
    let said = folder.run(&["range", "a.toml"]).stdout;
    assert!(said.contains("42 of 170 windows hold a sample that is missing"), "{said}");
    assert!(said.contains("their first is at row 2, column 3 of the view"), "{said}");
    // Yes or no alone comes to the same.
    let alone = folder.run(&["range", "a.toml", "--check"]);
    assert!(
        alone.stdout.contains("100 % of the windows") || alone.stdout.starts_with("Yes"),
        "{}",
        alone.stdout
    );
    // Splines need whole rows: those of window rows 0 to 6 are gone.
    folder
        .file("spline.toml", &CUBE.replace("[requirement]", "derivative = \"cubic-spline\"\n[requirement]"));
    let refused = folder.refusal(&["range", "spline.toml"]);
    assert!(refused.contains("windows hold a missing sample, and no other"), "{refused}");
}

#[test]
fn what_is_cut_off_or_empty_is_remarked() {
    let folder = with_cube(&CUBE.replace("depth = ", "noise_variance = 10.0\ndepth = "));
    let with = |name: &str, samples: &[f64]| {
        write_npy(&folder.path().join("left.npy"), shape(), samples).unwrap();
        let found = folder.json(&["range", "a.toml"]);
        let codes: Vec<String> = codes(&found).into_iter().map(str::to_owned).collect();
        assert!(!codes.is_empty(), "{name}");
        (codes, found["warnings"].to_string())
    };
    // Each pixel its own value.
    let level = |i: usize| 100.0 * ((i * 7919 % 10_007) as f64 + 1.0).sqrt();
    let plain: Vec<f64> = (0..shape().len()).map(level).collect();
    let has = |codes: &[String], code: &str| codes.iter().any(|own| own == code);
    let (codes, _) = with("plain", &plain);
    assert!(!has(&codes, "cube-saturated") && !has(&codes, "cube-dark"), "{codes:?}");
    let cut: Vec<f64> = plain.iter().map(|n| n.min(8000.0)).collect();
    let at_most = cut.chunks(BANDS).filter(|pixel| pixel.contains(&8000.0)).count();
    let (codes, said) = with("cut", &cut);
    assert!(has(&codes, "cube-saturated") && said.contains(&format!("{at_most} of 360 pixels")), "{said}");
    let (codes, said) = with("empty", &vec![0.0; shape().len()]);
    assert!(has(&codes, "cube-dark") && said.contains("all samples of the left view are 0"), "{said}");
    assert!(!has(&codes, "noise-in-counts"), "{said}");
    let mut half = plain;
    half[..shape().len() / 2].fill(0.0);
    assert!(has(&with("half", &half).0, "cube-dark"));
}
