//! `hadar calibrate` as its user runs it: noise and stripes, files, mistakes; and that a decomposition holds with what came out.

use crate::support::folder::Folder;
use hadar::cube::{Cube, Shape};
use hadar::planck::photon_radiance;
use hadar::statistics::Statistics;
use hadar_formats::cube::write_npy;
use hadar_simulate::draws::{Draws, generator};
use hadar_testing::repository;
use rand::RngExt;

const ROWS: usize = 24;
const COLUMNS: usize = 40;
const BANDS: usize = 15;
const ELECTRONS: f64 = 3000.0;

const DECOMPOSITION: &str = r#"[cube]
data = "frame_1.npy"
counts_per_photon_radiance = 1e-13
[bands]
start = "800 cm^-1"
stop = "1080 cm^-1"
step = "20 cm^-1"
[[environment]]
temperature = "10 degC"
[library]
path = "library.csv"
[unknown]
temperature = ["250 K", "340 K"]
lighting_total = 1.0
[truth]
temperature = "temperature.npy"
"#;

fn wavenumber(band: usize) -> f64 {
    800.0 + 20.0 * band as f64
}

fn emissivity(band: usize) -> f64 {
    0.9 + 0.05 * (wavenumber(band) / 30.0).sin()
}

/// Means of a wall whose temperature changes, and the temperatures.
fn wall() -> (Vec<f64>, Vec<f64>) {
    let (mut means, mut temperature) = (Vec::new(), Vec::new());
    for i in 0..ROWS * COLUMNS {
        let t = 275.0 + 45.0 * (i % COLUMNS) as f64 / COLUMNS as f64 + 3.0 * (i as f64 / 90.0).sin();
        temperature.push(t);
        for band in 0..BANDS {
            let (e, nu) = (emissivity(band), wavenumber(band));
            means.push(1e-13 * (e * photon_radiance(nu, t) + (1.0 - e) * photon_radiance(nu, 283.15)));
        }
    }
    (means, temperature)
}

fn drawn(means: &[f64], stream: u64) -> Vec<f64> {
    let draws = Draws::new(&Statistics::Poisson, means).unwrap();
    let draws = draws.with_electronic_noise(&vec![ELECTRONS * ELECTRONS; means.len()]).unwrap();
    let mut counts = vec![0.0; means.len()];
    draws.draw_into(&mut generator(8, stream), &mut counts);
    counts
}

fn written(folder: &Folder, name: &str, bands: usize, samples: &[f64]) {
    let shape = Shape::new(samples.len() / COLUMNS / bands, COLUMNS, bands).unwrap();
    write_npy(&folder.path().join(name), shape, samples).unwrap();
}

pub(crate) fn walls() -> Folder {
    let folder = Folder::with(DECOMPOSITION);
    let (means, temperature) = wall();
    written(&folder, "frame_1.npy", BANDS, &drawn(&means, 0));
    written(&folder, "frame_2.npy", BANDS, &drawn(&means, 1));
    written(&folder, "temperature.npy", 1, &temperature);
    let rows: Vec<String> =
        (0..BANDS).map(|w| format!("{},{},{}", wavenumber(w), emissivity(w), emissivity(w))).collect();
    folder.file(
        "library.csv",
        &format!(
            "wavenumber_cm1,wall\n{}\n",
            rows.iter().map(|row| row.rsplit_once(',').unwrap().0).collect::<Vec<_>>().join("\n")
        ),
    );
    folder
}

#[test]
fn noise_of_two_frames_makes_the_intervals_of_a_decomposition_hold() {
    let folder = walls();
    let found = folder.json(&["calibrate", "noise", "frame_1.npy", "frame_2.npy", "--out", "noise"]);
    // Levels that differ by a factor of two tell the noise without light badly.
    let [low, high] = [1, 2].map(|i| found["noise_electrons"][i].as_f64().unwrap());
    assert!(low < ELECTRONS && ELECTRONS < high && high < 4.0 * ELECTRONS, "{low} {high}");
    // The scenario that was written asks the same again, for any number of threads.
    let again = folder.json(&["calibrate", "noise", "noise/scenario.toml", "--threads", "1"]);
    assert_eq!(again["common"], found["common"]);
    // Without noise intervals hold half of the temperatures.
    let covered = |text: &str| {
        folder.file("b.toml", text);
        folder.json(&["decompose", "b.toml"])["truth"]["coverage_95"].as_f64().unwrap()
    };
    let without = covered(DECOMPOSITION);
    let with = covered(&DECOMPOSITION.replace("1e-13\n", "1e-13\nnoise = \"noise/sigma.csv\"\n"));
    // 960 pixels: 0.95 +- 0.007.
    assert!(without < 0.7 && (0.925..=0.975).contains(&with), "{without} {with}");
}

#[test]
fn an_error_that_all_pixels_have_in_common_is_in_the_intervals() {
    // Each cube has gains of its own, 1 % rms: as a calibration leaves them. 24 cubes.
    let folder = walls();
    let (means, _) = wall();
    let mean = |w: usize| means.iter().skip(w).step_by(BANDS).sum::<f64>() / (ROWS * COLUMNS) as f64;
    let table = |common: bool| {
        let rows =
            (0..BANDS).map(|w| format!("{w},{ELECTRONS},{}", if common { 0.01 * mean(w) } else { 0.0 }));
        format!("band,electronic_sigma,sigma_common\n{}\n", rows.collect::<Vec<_>>().join("\n"))
    };
    folder.file("with.csv", &table(true));
    folder.file("without.csv", &table(false));
    let mut random = generator(9, 0);
    let mut held = [0.0; 2];
    for cube in 0..24 {
        let half = 0.01 * 3.0_f64.sqrt();
        let gains: Vec<f64> = (0..BANDS).map(|_| 1.0 + random.random_range(-half..half)).collect();
        let samples: Vec<f64> =
            drawn(&means, 10 + cube).iter().enumerate().map(|(i, x)| x * gains[i % BANDS]).collect();
        written(&folder, "frame_1.npy", BANDS, &samples);
        for (held, name) in held.iter_mut().zip(["with", "without"]) {
            let noise = format!("1e-13\nnoise = \"./{name}.csv\"\n");
            folder.file("b.toml", &DECOMPOSITION.replace("1e-13\n", &noise));
            let found = folder.json(&["decompose", "b.toml", "--threads", "1"]);
            *held += found["truth"]["coverage_95"].as_f64().unwrap() / 24.0;
        }
    }
    // Pixels of a cube err together: 24 draws of what is off, 0.95 +- 0.045. Without, a cube that is far off is found out by itself, and its
    // deviations hold what may be the cause; what is not seen is not held.
    println!("intervals hold {} with the common error, {} without", held[0], held[1]);
    assert!(held[0] > 0.92 && held[1] < 0.92, "{held:?}");
}

#[test]
fn stripes_are_taken_out_and_the_rest_stays() {
    let folder = Folder::with("[cube]\ndata = \"cube.npy\"\n[stripes]\naxis = \"rows\"\n");
    let (means, _) = wall();
    let mut samples = drawn(&means, 0);
    for (row, band) in [(5, 3), (11, 7), (16, 7), (18, 0)] {
        for column in 0..COLUMNS {
            let sample = &mut samples[(row * COLUMNS + column) * BANDS + band];
            *sample = 1.03 * *sample + 2e4;
        }
    }
    written(&folder, "cube.npy", BANDS, &samples);
    let found = folder.json(&["calibrate", "stripes", "a.toml", "--out", "out"]);
    let lines: Vec<[u64; 2]> = found["stripes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| ["line", "band"].map(|key| one[key].as_u64().unwrap()))
        .collect();
    assert_eq!(lines, [[5, 3], [11, 7], [16, 7], [18, 0]]);
    let cube = hadar_formats::cube::open(&folder.path().join("out/destriped.npy"), None).unwrap();
    let Cube::F64(rows) = cube else { panic!("the samples have another type") };
    let mut buffer = Vec::new();
    let own = rows.read(0..ROWS, &mut buffer).unwrap();
    for (i, (own, was)) in own.iter().zip(&samples).enumerate() {
        let (row, band) = ((i / BANDS / COLUMNS) as u64, (i % BANDS) as u64);
        assert_eq!(own.to_bits() != was.to_bits(), lines.contains(&[row, band]), "{row} {band}");
    }
    // Bare, it says the same.
    assert_eq!(folder.json(&["calibrate", "stripes", "cube.npy"])["stripes"], found["stripes"]);
    let again = folder.json(&["calibrate", "stripes", "out/scenario.toml", "--threads", "1"]);
    assert_eq!(again["stripes"], found["stripes"]);
    let clean = folder.run(&["calibrate", "stripes", "out/destriped.npy"]);
    assert!(clean.stdout.starts_with("No stripes: none of 24 rows is off"), "{}", clean.stdout);
}

/// A line alone is seen from the limit on that the answer states, and not below.
#[test]
fn what_would_have_been_seen_of_a_line_is_said() {
    let folder = Folder::with("[cube]\ndata = \"cube.npy\"\n");
    let samples = drawn(&wall().0, 0);
    written(&folder, "cube.npy", BANDS, &samples);
    let found = folder.json(&["calibrate", "stripes", "cube.npy"]);
    for band in [2, 9] {
        let [gain, off] = ["detectable_gain", "detectable"].map(|key| found[key][band].as_f64().unwrap());
        let level = found["levels"][band].as_f64().unwrap();
        assert!((gain * level / off - 1.0).abs() < 1e-12);
        for (times, seen) in [(0.2, 0), (1.3, 1)] {
            let mut striped = samples.clone();
            let row = striped.iter_mut().skip(12 * COLUMNS * BANDS).take(COLUMNS * BANDS);
            row.skip(band).step_by(BANDS).for_each(|sample| *sample *= 1.0 + times * gain);
            written(&folder, "striped.npy", BANDS, &striped);
            let found = folder.json(&["calibrate", "stripes", "striped.npy"]);
            assert_eq!(found["striped"], seen, "{band} {times} {gain} {}", found["kept"]);
        }
    }
}

/// Every row has a gain of its own, the same in all bands: no row stands out, and it is not said that there are no stripes.
#[test]
fn stripes_of_every_row_are_not_called_none() {
    let folder = Folder::with("[cube]\ndata = \"cube.npy\"\n");
    let mut random = generator(6, 0);
    let half = 0.02 * 3.0_f64.sqrt();
    let gains: Vec<f64> = (0..ROWS).map(|_| 1.0 + random.random_range(-half..half)).collect();
    let samples: Vec<f64> =
        drawn(&wall().0, 0).iter().enumerate().map(|(i, x)| x * gains[i / BANDS / COLUMNS]).collect();
    written(&folder, "cube.npy", BANDS, &samples);
    let found = folder.json(&["calibrate", "stripes", "cube.npy", "--out", "out"]);
    let warnings = found["warnings"].as_array().unwrap();
    let own = warnings.iter().find(|one| one["code"] == "lines-differ").unwrap();
    assert!(own["message"].as_str().unwrap().contains("stripes of every one of them explain that alike"));
    // By 20 interior rows, the median of which knows a deviation of 2 % to a third.
    let apart = found["apart"][7]["lines"].as_f64().unwrap();
    assert!((apart / 0.02 - 1.0).abs() < 0.7, "{apart}");
    let text = folder.run(&["calibrate", "stripes", "cube.npy"]).stdout;
    assert!(!text.contains("No stripes"), "{text}");
    let table = std::fs::read_to_string(folder.path().join("out/limits.csv")).unwrap();
    assert!(table.starts_with("band,offset_seen,gain_seen,lines_differ,noise_explains\n0,"), "{table}");
}

/// A band without readings spoils no other one: it is named, and the others have the noise that they have without it.
#[test]
fn bands_without_readings_are_named_and_left_out() {
    let folder = walls();
    let without = |samples: &[f64], band: usize| -> Vec<f64> {
        samples.iter().enumerate().filter(|(i, _)| i % BANDS != band).map(|(_, x)| *x).collect()
    };
    let samples = drawn(&wall().0, 0);
    written(&folder, "without.npy", BANDS - 1, &without(&samples, 4));
    let alone = folder.json(&["calibrate", "noise", "without.npy"]);
    for (value, why) in [(f64::NAN, "missing"), (777.0, "stuck")] {
        let mut spoilt = samples.clone();
        spoilt.iter_mut().skip(4).step_by(BANDS).for_each(|sample| *sample = value);
        written(&folder, "spoilt.npy", BANDS, &spoilt);
        let found = folder.json(&["calibrate", "noise", "spoilt.npy", "--out", "noise"]);
        assert_eq!(found["common"], alone["common"], "{why}");
        let said = found["warnings"].to_string();
        assert!(said.contains(&format!("bands 4 (from 0, in rising wavenumber) are {why}")), "{said}");
        assert_eq!(found["bands"][5], alone["bands"][4]);
        // A row for every band: a decomposition that leaves the band out takes it.
        let table = std::fs::read_to_string(folder.path().join("noise/sigma.csv")).unwrap();
        assert_eq!(table.lines().count(), BANDS + 1, "{table}");
        assert!(!table.contains("NaN"), "{table}");
        let stripes = folder.json(&["calibrate", "stripes", "spoilt.npy"]);
        assert!(stripes["warnings"].to_string().contains("bands-found-bad"), "{}", stripes["warnings"]);
        assert_eq!(stripes["levels"][4], serde_json::Value::Null);
    }
    // Named: not found, and the same.
    folder.file("named.toml", "[cube]\ndata = \"spoilt.npy\"\nbad_bands = [4]\n[noise]\n");
    let found = folder.json(&["calibrate", "noise", "named.toml", "--out", "named"]);
    assert_eq!(found["common"], alone["common"]);
    assert!(!found["warnings"].to_string().contains("bands-found-bad"));
    assert_eq!(folder.json(&["calibrate", "noise", "named/scenario.toml"])["common"], alone["common"]);
    folder.file("named.toml", "[cube]\ndata = \"spoilt.npy\"\nbad_bands = [15]\n[noise]\n");
    let refusal = folder.refusal(&["calibrate", "noise", "named.toml"]);
    assert!(refusal.contains("cube.bad_bands: band 15 of 15; count from 0 up to 14"), "{refusal}");
}

#[test]
fn mistakes_are_one_message() {
    let folder = walls();
    folder.file("noise.toml", "[cube]\ndata = [\"frame_1.npy\", \"none.npy\"]\n[noise]\n");
    folder.file("stripes.toml", "[cube]\ndata = \"frame_1.npy\"\n[stripes]\naxis = \"bands\"\n");
    folder.file("two.toml", "[cube]\ndata = [\"frame_1.npy\", \"frame_2.npy\"]\n[stripes]\n");
    written(&folder, "one_row.npy", BANDS, &drawn(&wall().0[..COLUMNS * BANDS], 3));
    written(&folder, "constant.npy", 4, &vec![5.0; 20 * COLUMNS * 4]);
    written(&folder, "two_bands.npy", 2, &drawn(&wall().0[..20 * COLUMNS * 2], 4));
    let mut random = generator(3, 3);
    let (means, _) = wall();
    let gains: Vec<f64> = (0..ROWS * BANDS).map(|_| random.random_range(0.9..1.1)).collect();
    let filled: Vec<f64> = drawn(&means, 5)
        .iter()
        .enumerate()
        .map(|(i, x)| x * gains[i / BANDS / COLUMNS * BANDS + i % BANDS])
        .collect();
    written(&folder, "filled.npy", BANDS, &filled);
    for (arguments, message) in [
        (["noise", "noise.toml"], "none.npy: cube.data[1]: cannot read the cube"),
        (
            ["noise", "two_bands.npy"],
            "two_bands.npy: a single frame of 2 band(s); give two or more frames of the same scene",
        ),
        (["noise", "constant.npy"], "constant.npy: samples do not scatter at all"),
        (
            ["stripes", "stripes.toml"],
            "stripes.toml:4: stripes.axis: `bands` is not known here; write \"rows\" or \"columns\"",
        ),
        (["stripes", "two.toml"], "two.toml:2: cube.data: 2 cubes; write one"),
        (["stripes", "one_row.npy"], "one_row.npy: 1 rows of 40 pixels; stripes are seen in 8 rows or more"),
        (["stripes", "constant.npy"], "constant.npy: all samples of the cube are the same"),
        (
            ["stripes", "filled.npy"],
            "stripes, too many to distinguish them from the scene; correct the cube by a uniform source first",
        ),
        (["noise", "a.toml"], "this is a decomposition scenario"),
    ] {
        let refusal = folder.refusal(&["calibrate", arguments[0], arguments[1]]);
        assert!(refusal.contains(message), "{arguments:?}: {refusal}");
    }
    let several = folder.refusal(&["calibrate", "noise", "frame_1.npy", "noise.toml"]);
    assert!(several.contains("noise.toml: a scenario among several files"), "{several}");
    folder.file("sigma.csv", "band,sigma\n0,1\n");
    folder.file("b.toml", &DECOMPOSITION.replace("1e-13\n", "1e-13\nnoise = \"sigma.csv\"\n"));
    let refusal = folder.refusal(&["decompose", "b.toml"]);
    assert!(refusal.contains("sigma.csv") && refusal.contains("no column electronic_sigma"), "{refusal}");
    folder.file("sigma.csv", "band,electronic_sigma\n0,1\n");
    let refusal = folder.refusal(&["decompose", "b.toml"]);
    // Rows that say their band may be fewer, but for bands that are read.
    assert!(refusal.contains("sigma.csv") && refusal.contains("no row for band 1 "), "{refusal}");
    folder.file("sigma.csv", "row,electronic_sigma\n0,1\n");
    let refusal = folder.refusal(&["decompose", "b.toml"]);
    assert!(refusal.contains("noise of the bands: 1 values where 15 are needed"), "{refusal}");
    // Rows that say of which bands they are.
    let rows = |first: f64| {
        let row = |w: usize| format!("{},1\n", first + 20.0 * w as f64);
        format!("wavenumber_cm1,electronic_sigma\n{}", (0..BANDS).map(row).collect::<String>())
    };
    folder.file("sigma.csv", &rows(300.0));
    let refusal = folder.refusal(&["decompose", "b.toml"]);
    let message = "sigma.csv:2: wavenumber_cm1: a row at 300.000 cm^-1 for band 0 at 800.000 cm^-1";
    assert!(refusal.contains(message), "{refusal}");
    for name in ["Wavenumber_cm1", "wavenumber", "wavelength_nm"] {
        folder.file("sigma.csv", &rows(801.0).replace("wavenumber_cm1", name));
        let refusal = folder.refusal(&["decompose", "b.toml"]);
        assert!(
            refusal.contains(&format!(
                "sigma.csv:1: cube.noise: a column `{name}`; name the column wavenumber_cm1"
            )),
            "{refusal}"
        );
    }
    folder.file("sigma.csv", &rows(801.0));
    assert_eq!(folder.run(&["decompose", "b.toml"]).code, 0);
    // A file of [cube] data alone is of whichever command it is given to.
    folder.file("alone.toml", "[cube]\ndata = [\"frame_1.npy\", \"frame_2.npy\"]\n");
    assert_eq!(folder.run(&["calibrate", "noise", "alone.toml"]).code, 0);
    // Temperatures are not in proportion to photons.
    let flir = repository().join("tests/data/cubes/flir.jpg");
    folder.file(
        "warm.toml",
        &format!("[cube]\ndata = [{0:?}, {0:?}]\nvariable = \"temperature\"\n", flir.display().to_string()),
    );
    let other = folder.refusal(&["calibrate", "noise", "warm.toml"]);
    assert!(other.contains("the samples are `K` by their file"), "{other}");
    let other = folder.refusal(&["range", "alone.toml"]);
    assert!(other.contains("there is no key `data`"), "{other}");
    let other = folder.refusal(&["range", "stripes.toml"]);
    assert!(other.contains("this is a calibration; hadar calibrate stripes"), "{other}");
}

#[test]
fn a_dark_level_that_is_not_said_makes_no_camera() {
    let folder = walls();
    let (means, _) = wall();
    let least = means.iter().copied().fold(f64::INFINITY, f64::min);
    for stream in [0, 1] {
        let samples: Vec<f64> = drawn(&means, 10 + stream).iter().map(|n| n + 100.0 * least).collect();
        written(&folder, &format!("off_{stream}.npy"), BANDS, &samples);
    }
    let found = folder.json(&["calibrate", "noise", "off_0.npy", "off_1.npy", "--out", "off"]);
    assert_eq!(found["usable"], false);
    assert!(found["warnings"].to_string().contains("noise-below-zero"), "{}", found["warnings"]);
    assert!(!folder.path().join("off/camera.toml").exists());
    let text = folder.run(&["calibrate", "noise", "off_0.npy", "off_1.npy"]).stdout;
    assert!(text.starts_with("No camera's figures follow") && text.contains("noise.dark_level"), "{text}");
    let asked = |dark: f64| {
        format!("[cube]\ndata = [\"off_0.npy\", \"off_1.npy\"]\n[noise]\ndark_level = {dark:e}\n")
    };
    folder.file("dark.toml", &asked(100.0 * least));
    assert_eq!(folder.json(&["calibrate", "noise", "dark.toml"])["usable"], true);
    folder.file("dark.toml", &asked(1e12));
    let refusal = folder.refusal(&["calibrate", "noise", "dark.toml"]);
    assert!(
        refusal.contains("dark.toml:4: noise.dark_level: 1000000000000, but samples of band 0"),
        "{refusal}"
    );
}

/// Frames of which each is the mean of two exposures have less noise than their photons: nothing that another command reads is written.
#[test]
fn frames_that_a_camera_filtered_leave_nothing_to_read() {
    let folder = walls();
    let (means, _) = wall();
    let frames: Vec<Vec<f64>> = (0..5).map(|stream| drawn(&means, 30 + stream)).collect();
    let ask = |name: &str, of: &dyn Fn(usize, usize) -> f64| {
        let mut args = vec!["calibrate".to_owned(), "noise".to_owned()];
        for k in 1..frames.len() {
            let file = format!("{name}_{k}.npy");
            written(&folder, &file, BANDS, &(0..means.len()).map(|i| of(k, i)).collect::<Vec<f64>>());
            args.push(file);
        }
        args.extend(["--out".to_owned(), name.to_owned()]);
        let found = folder.json(&args.iter().map(String::as_str).collect::<Vec<_>>());
        let there = |file: &str| folder.path().join(name).join(file).exists();
        (found["usable"].as_bool().unwrap(), ["camera.toml", "variance.csv", "sigma.csv"].map(there), found)
    };
    let (usable, files, found) = ask("whole", &|k, i| frames[k][i]);
    assert!(usable && files == [true; 3], "{found:#}");
    // The noise of a ranging scenario, where photons follow.
    let range = "[cube]\nleft = \"frame_1.npy\"\nnoise_variance = \"whole/variance.csv\"\n[stereo]\nbaseline = \"0.2 m\"\n\
                 focal_length = \"14 mm\"\npixel = \"24 um\"\nwindow = [5, 5]\n";
    folder.file("range.toml", range);
    let outcome = folder.run(&["range", "range.toml"]);
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    let (usable, files, found) = ask("mean", &|k, i| 0.5 * (frames[k][i] + frames[k - 1][i]));
    assert!(!usable && files == [false; 3], "{found:#}");
    assert!(found["warnings"].to_string().contains("correlated-noise"), "{}", found["warnings"]);
    let of_frames = found["correlations"].as_array().unwrap().iter().find(|of| of["of"] == "frames").unwrap();
    // The mean of two has a correlation of a half.
    assert!((of_frames["value"].as_f64().unwrap() - 0.5).abs() < 0.1, "{of_frames:#}");
}

/// Frames of a shutter before a camera of one band: what pixels and rows share is found, and put into a camera by the NETD, as a scenario reads it.
#[test]
fn frames_of_a_shutter_tell_what_rows_and_pixels_share() {
    let folder = Folder::with("");
    let (rows, columns, bands, frames) = (40, 48, 1, 12);
    let shape = Shape::new(rows, columns, bands).unwrap();
    let normals = |stream: u64, count: usize, sigma: f64| -> Vec<f64> {
        let draws = Draws::new(&Statistics::Poisson, &vec![1e6; count]).unwrap();
        let mut counts = vec![0.0; count];
        draws.draw_into(&mut generator(9, stream), &mut counts);
        counts.iter().map(|n| sigma * (n - 1e6) / 1e3).collect()
    };
    let (of_pixel, of_row) = (normals(1, shape.len(), 20.0), normals(2, rows * bands, 14.0));
    let mut names = Vec::new();
    for frame in 0..frames {
        let own = normals(10 + frame, shape.len(), 40.0);
        let sample =
            |i: usize| 5e4 + own[i] + of_pixel[i] + of_row[i / (columns * bands) * bands + i % bands];
        let samples: Vec<f64> = (0..shape.len()).map(sample).collect();
        let name = format!("shutter_{frame}.npy");
        write_npy(&folder.path().join(&name), shape, &samples).unwrap();
        names.push(format!("{name:?}"));
    }
    let file = format!("[cube]\ndata = [{}]\n[noise]\n", names.join(", "));
    folder.file("shutter.toml", &format!("{file}uniform = true\nnetd = \"40 mK\"\n"));
    let found = folder.json(&["calibrate", "noise", "shutter.toml", "--out", "shutter"]);
    let terms = found["three_dimensional"].as_array().unwrap();
    for (of, truth) in
        [("tvh", 1600.0), ("vh", 400.0), ("v", 196.0), ("h", 0.0), ("tv", 0.0), ("th", 0.0), ("t", 0.0)]
    {
        let term = terms.iter().find(|term| term["of"] == of).unwrap();
        let [low, high] = [0, 1].map(|end| term["interval"][end].as_f64().unwrap());
        assert!(low <= truth && truth <= high, "{of}: {term}");
    }
    let camera = std::fs::read_to_string(folder.path().join("shutter/camera.toml")).unwrap();
    let value = |key: &str| -> f64 {
        let line =
            camera.lines().find(|line| line.starts_with(key)).unwrap_or_else(|| panic!("{key}: {camera}"));
        line.split('"').nth(1).unwrap().trim_end_matches(" mK").parse().unwrap()
    };
    // Of 40 mK: 20 and 14 of 40 units; a row's from 80 rows, 8 %.
    assert!(
        (value("fixed_pattern") - 20.0).abs() < 1.0 && (value("row_noise") - 14.0).abs() < 4.5,
        "{camera}"
    );
    assert!(value("column_noise") < 3.0 && camera.contains("# at most"), "{camera}");
    let said = folder.run(&["calibrate", "noise", "shutter.toml"]).stdout;
    assert!(said.starts_with("In addition to ") && said.contains("row to row, staying (v)"), "{said}");
    // The camera is one that a scenario takes.
    folder.file("size.toml", &format!("[target]\nmaterial = \"skin\"\ntemperature = \"34 degC\"\n[alternatives]\nmaterials = [\"pmma\"]\n{}\npreset = \"flir-a325sc\"\n", camera.trim_end()));
    assert!(folder.json(&["size", "size.toml"])["camera"]["pattern"]["row_k"].as_f64().is_some());
    // Of a scene nobody says to be the same everywhere what stays is not the camera's alone.
    folder.file("scene.toml", &file);
    let refused = folder.refusal(&["calibrate", "noise", "scene.toml"]);
    assert!(
        refused.contains("scene.toml:2: cube.data") && refused.contains("darker and brighter"),
        "{refused}"
    );
    // Photons are of one brightness not told, and no table says that they are.
    assert!(found.get("photons_per_unit").is_none() && !folder.path().join("shutter/variance.csv").exists());
}
