//! `hadar calibrate blackbody` and `response` as their user runs them: files, numbers, mistakes.

use crate::support::folder::Folder;
use hadar::cube::{Cube, Shape};
use hadar::planck::photon_radiance;
use hadar::statistics::Statistics;
use hadar::units::{PLANCK_J_S, SPEED_OF_LIGHT_M_S};
use hadar_estimate::calibrate::twin::{FilterWheelTwin, passband};
use hadar_formats::cube::write_npy;
use hadar_simulate::draws::{Draws, generator};
use std::path::Path;

pub(crate) const SPECTROMETER: &str = r#"title = "FTIR of today"
[bands]
start = "800 cm^-1"
stop = "1200 cm^-1"
step = "20 cm^-1"
[[blackbody]]
temperature = "10 degC"
uncertainty = "30 mK"
emissivity = 1.0
data = "cold.npy"
[[blackbody]]
temperature = "35 degC"
uncertainty = "30 mK"
emissivity = 1.0
data = "mild.npy"
[[blackbody]]
temperature = "60 degC"
uncertainty = "30 mK"
emissivity = 1.0
data = "warm.npy"
[noise]
sample = 2.0
[scene]
data = "scene.npy"
"#;
const BANDS: usize = 21;

fn wavenumber(band: usize) -> f64 {
    800.0 + 20.0 * band as f64
}

/// Normal numbers.
fn normal(count: usize, stream: u64) -> Vec<f64> {
    let draws = Draws::new(&Statistics::Poisson, &vec![0.0; count]).unwrap();
    let draws = draws.with_electronic_noise(&vec![1.0; count]).unwrap();
    let mut out = vec![0.0; count];
    draws.draw_into(&mut generator(17, stream), &mut out);
    out
}

fn write(folder: &Folder, name: &str, size: [usize; 3], samples: &[f64]) {
    write_npy(&folder.path().join(name), Shape::new(size[0], size[1], size[2]).unwrap(), samples).unwrap();
}

/// Rows and columns of the scene; a pixel has a temperature of its own.
const SIZE: [usize; 2] = [20, 30];

fn scene_k(pixel: usize) -> f64 {
    290.0 + 0.05 * pixel as f64
}

/// Blackbodies of 8 × 8 pixels, the mildest 60 mK warmer than it says; a scene; noise of 2.
pub(crate) fn spectrometer(scenario: &str) -> Folder {
    let folder = Folder::with(scenario);
    let response = |band: usize| 1e-15 * (1.0 + 0.3 * (band as f64 / 4.0).sin());
    let cube = |temperatures: &[f64], stream: u64| -> Vec<f64> {
        let noise = normal(temperatures.len() * BANDS, stream);
        let pixel = |(i, z): (usize, &f64)| {
            let band = i % BANDS;
            let b = photon_radiance(wavenumber(band), temperatures[i / BANDS]);
            response(band) * b - 300.0 + 2.0 * z
        };
        noise.iter().enumerate().map(pixel).collect()
    };
    for (stream, (name, t)) in
        [("cold.npy", 283.15), ("mild.npy", 308.21), ("warm.npy", 333.15)].iter().enumerate()
    {
        write(&folder, name, [8, 8, BANDS], &cube(&[*t; 64], stream as u64));
    }
    let pixels: Vec<f64> = (0..SIZE[0] * SIZE[1]).map(scene_k).collect();
    write(&folder, "scene.npy", [SIZE[0], SIZE[1], BANDS], &cube(&pixels, 9));
    folder
}

fn read(path: &Path) -> Vec<f64> {
    let mut buffer = Vec::new();
    match hadar_formats::cube::open(path, None).unwrap() {
        Cube::F32(cube) => {
            let rows = cube.read(0..cube.shape().rows(), &mut buffer).unwrap();
            rows.iter().map(|x| f64::from(*x)).collect()
        }
        Cube::F64(_) => panic!("calibrated cubes are of 32 bits"),
    }
}

/// Noise of each sample as stated, and the error of all pixels together within what is common to them.
#[test]
fn radiances_err_as_they_say() {
    let folder = spectrometer(SPECTROMETER);
    let found = folder.json(&["calibrate", "blackbody", "a.toml", "--out", "out"]);
    assert_eq!(found["channels"].as_array().unwrap().len(), BANDS);
    assert_eq!(found["warnings"].as_array().unwrap().len(), 0, "{}", found["warnings"]);
    let out = folder.path().join("out");
    let (radiance, common) = (read(&out.join("radiance.npy")), read(&out.join("sigma_common.npy")));
    let pixels = SIZE[0] * SIZE[1];
    let (mut worst, mut sum) = (0.0_f64, 0.0);
    for band in 0..BANDS {
        let joules = PLANCK_J_S * SPEED_OF_LIGHT_M_S * 100.0 * wavenumber(band);
        let noise = found["scene"]["sigma_noise"][band].as_f64().unwrap();
        let off = |pixel: usize| {
            radiance[pixel * BANDS + band] - joules * photon_radiance(wavenumber(band), scene_k(pixel))
        };
        let mean = (0..pixels).map(off).sum::<f64>() / pixels as f64;
        let var = (0..pixels).map(|pixel| (off(pixel) - mean).powi(2)).sum::<f64>() / (pixels - 1) as f64;
        // 600 samples know a deviation to 3 %; the slope of the common error adds little.
        assert!((var.sqrt() / noise - 1.0).abs() < 0.13, "{band} {}", var.sqrt() / noise);
        let sigma = common[(pixels / 2) * BANDS + band].hypot(noise / (pixels as f64).sqrt());
        worst = worst.max((mean / sigma).abs());
        sum += (mean / sigma).powi(2);
    }
    // One blackbody is off by two deviations.
    assert!(worst < 4.5 && sum / (BANDS as f64) < 6.0, "{worst} {sum}");
    // Of three blackbodies the middle one is seen to be off.
    let shift = found["temperature_shifts_k"][1][0].as_f64().unwrap();
    assert!(shift > 0.01 && shift < 0.08, "{shift}");
    let text = folder.run(&["calibrate", "blackbody", "a.toml"]).stdout;
    assert!(
        text.starts_with(
            "21 channels calibrated by 3 blackbodies: radiances as at 283.1 to 333.1 K err by up to "
        ) || text.starts_with(
            "21 channels calibrated by 3 blackbodies: radiances as at 283.2 to 333.2 K err by up to "
        ),
        "{text}"
    );
    // What was written can be run again, and decomposed.
    let again = folder.json(&["calibrate", "blackbody", "out/scenario.toml"]);
    assert_eq!(again["channels"], found["channels"]);
    assert!(text.contains("unit = \"W m^-2 sr^-1 per cm^-1\""), "{text}");
}

/// Pixels of responses and offsets of their own: by each for itself errors are as stated, by a common one it is said that they are not.
#[test]
fn pixels_that_differ_are_calibrated_each_for_itself() {
    let folder = spectrometer(SPECTROMETER);
    let [rows, columns] = SIZE;
    let differ =
        |pixel: usize| (1e-15 * (1.0 + 0.2 * (pixel as f64 * 0.7).sin()), 40.0 * (pixel as f64).cos());
    let of = |t: &dyn Fn(usize) -> f64, stream: u64| -> Vec<f64> {
        let noise = normal(rows * columns * BANDS, stream);
        let sample = |(i, z): (usize, &f64)| {
            let (pixel, band) = (i / BANDS, i % BANDS);
            let (response, offset) = differ(pixel);
            response * photon_radiance(wavenumber(band), t(pixel)) + offset + 2.0 * z
        };
        noise.iter().enumerate().map(sample).collect()
    };
    for (stream, (name, t)) in
        [("cold.npy", 283.15), ("mild.npy", 308.15), ("warm.npy", 333.15)].iter().enumerate()
    {
        write(&folder, name, [rows, columns, BANDS], &of(&|_| *t, 20 + stream as u64));
    }
    write(&folder, "scene.npy", [rows, columns, BANDS], &of(&scene_k, 29));
    let common = folder.json(&["calibrate", "blackbody", "a.toml"]);
    assert!(codes(&common).contains(&"blackbody-not-even".to_owned()), "{}", common["warnings"]);
    folder.file(
        "a.toml",
        &SPECTROMETER.replace("data = \"scene.npy\"", "data = \"scene.npy\"\nresponse = \"each-pixel\""),
    );
    let found = folder.json(&["calibrate", "blackbody", "a.toml", "--out", "out"]);
    assert_eq!(codes(&found), Vec::<String>::new());
    let out = folder.path().join("out");
    let [radiance, common, pixel] =
        ["radiance.npy", "sigma_common.npy", "sigma_pixel.npy"].map(|name| read(&out.join(name)));
    let mut held = 0;
    for i in 0..radiance.len() {
        let (at, band) = (i / BANDS, i % BANDS);
        let joules = PLANCK_J_S * SPEED_OF_LIGHT_M_S * 100.0 * wavenumber(band);
        let truth = joules * photon_radiance(wavenumber(band), scene_k(at));
        let sigma = (joules * 2.0 / differ(at).0).hypot(pixel[i]).hypot(common[i]);
        held += usize::from((radiance[i] - truth).abs() < 1.96 * sigma);
    }
    // 12 600 intervals; their common part, of temperatures that are exact here, makes them a little too wide.
    let share = held as f64 / radiance.len() as f64;
    assert!((0.94..0.985).contains(&share), "{share}");
    write(&folder, "mild.npy", [8, 8, BANDS], &(0..64 * BANDS).map(|i| i as f64).collect::<Vec<_>>());
    let line = folder.refusal(&["calibrate", "blackbody", "a.toml"]);
    assert!(line.contains("blackbody[1].data") && line.contains("the scene is 20 x 30 x 21"), "{line}");
}

#[test]
fn what_a_spectrometer_cannot_be_calibrated_with_is_said() {
    let folder = spectrometer(SPECTROMETER);
    let says = |scenario: &str, words: &[&str]| {
        folder.file("a.toml", scenario);
        let line = folder.refusal(&["calibrate", "blackbody", "a.toml"]);
        assert!(words.iter().all(|word| line.contains(word)), "{line}");
    };
    let equal = SPECTROMETER.replace("35 degC", "10 degC").replace("60 degC", "10 degC");
    says(
        &equal,
        &["a.toml:12: blackbody[1].temperature", "blackbody[0] and blackbody[1] are both at 283.15 K"],
    );
    let one = SPECTROMETER.split("[[blackbody]]\ntemperature = \"35").next().unwrap().to_owned();
    says(&(one + "[noise]\nsample = 2.0\n"), &["one temperature does not determine response and offset"]);
    says(
        &SPECTROMETER.replace("sample = 2.0\n", ""),
        &["the noise of the samples is not stated", "sample = 1.5"],
    );
    says(&SPECTROMETER.replace("mild.npy", "none.npy"), &["none.npy", "there is no such file"]);
    says(
        &SPECTROMETER.replace("20 cm^-1", "10 cm^-1"),
        &["blackbody[0].data", "8 x 8 x 21", "[bands] are 41"],
    );
    let mut samples: Vec<f64> = (0..64 * BANDS).map(|i| i as f64).collect();
    samples[3 * BANDS + 5] = f64::NAN;
    write(&folder, "nan.npy", [8, 8, BANDS], &samples);
    let words = ["nan.npy", "row 0, column 3, band 5 (counted from 0)", "sample is NaN"];
    says(&SPECTROMETER.replace("mild.npy", "nan.npy"), &words[1..]);
    // Swapped data: warmer blackbodies read less.
    let swapped = SPECTROMETER
        .replace("cold.npy", "x")
        .replace("warm.npy", "cold.npy")
        .replace("\"x\"", "\"warm.npy\"");
    says(&swapped, &["warmer blackbodies read less in 21 of 21 channels", "swapped"]);
    let same = SPECTROMETER.replace("mild.npy", "cold.npy").replace("warm.npy", "cold.npy");
    says(&same, &["response of a channel is 0"]);
    let cold = read_doubles(&folder.path().join("cold.npy"));
    // Another reading of the same: 64 pixels, a mean of which scatters by 0.25.
    let again: Vec<f64> = cold.iter().enumerate().map(|(i, x)| x + 0.1 * (i as f64).sin() + 0.1).collect();
    write(&folder, "again.npy", [8, 8, BANDS], &again);
    says(&same.replacen("cold.npy", "again.npy", 1), &["read the same within noise in every channel"]);
    let turned: Vec<f64> =
        cold.iter().enumerate().map(|(i, x)| if i % BANDS == 7 { -x } else { *x }).collect();
    let mut warmer = read_doubles(&folder.path().join("warm.npy"));
    warmer.iter_mut().skip(7).step_by(BANDS).for_each(|x| *x = -*x);
    write(&folder, "turned.npy", [8, 8, BANDS], &turned);
    write(&folder, "turned-warm.npy", [8, 8, BANDS], &warmer);
    let two = SPECTROMETER.replace("cold.npy", "turned.npy").replace("warm.npy", "turned-warm.npy");
    says(&two, &["read less in 1 of 21 channels (the first at 940", "order of the bands"]);
    // Temperatures that do not differ beyond what they are known to.
    let near = SPECTROMETER.replace("35 degC", "10.01 degC").replace("60 degC", "10.1 degC");
    says(&near, &["differ by 100 mK that is known to 42.4 mK only", "127 mK apart or more"]);
    says(
        &SPECTROMETER.replace("sample = 2.0", "sample = 2e-200"),
        &["noise.sample", "give the cubes in counts"],
    );
    // A calibration is no scenario of a target, and is sent where it belongs.
    folder.file("a.toml", SPECTROMETER);
    assert!(folder.refusal(&["size", "a.toml"]).contains("hadar calibrate blackbody"));
}

fn read_doubles(path: &Path) -> Vec<f64> {
    let mut buffer = Vec::new();
    match hadar_formats::cube::open(path, None).unwrap() {
        Cube::F64(cube) => cube.read(0..cube.shape().rows(), &mut buffer).unwrap().to_vec(),
        Cube::F32(_) => panic!("cubes of these tests are of 64 bits"),
    }
}

fn codes(found: &serde_json::Value) -> Vec<String> {
    let all = found["warnings"].as_array().unwrap().iter();
    all.map(|warning| warning["code"].as_str().unwrap().to_owned()).collect()
}

/// Temperatures that are hardly apart, or of which nothing is said; the first sentence has the largest error, not the least.
#[test]
fn a_response_that_is_hardly_known_is_said_to_be() {
    let folder = spectrometer(SPECTROMETER);
    let (first, rest) = SPECTROMETER.split_once("[[blackbody]]\ntemperature = \"35").unwrap();
    let (_, last) = rest.split_once("[[blackbody]]").unwrap();
    let two = format!("{first}[[blackbody]]{last}");
    // A kelvin apart, each known to 0.2 K: the response to 28 %.
    let near = two.replace("60 degC", "11 degC").replace("30 mK", "200 mK");
    folder.file("a.toml", &near);
    let found = folder.json(&["calibrate", "blackbody", "a.toml"]);
    assert!(codes(&found).contains(&"response-barely-known".to_owned()), "{}", found["warnings"]);
    // By hand: at either blackbody a radiance errs by 0.2 K as its temperature does, in the middle by 0.2/√2.
    folder.file("a.toml", &two.replace("30 mK", "200 mK"));
    let found = folder.json(&["calibrate", "blackbody", "a.toml"]);
    // Two blackbodies are on any line. A hundredth of the span of 50 K, by hand at 1200 cm^-1: (0.0080 - 0.0032)/100/0.000093.
    assert_eq!(codes(&found), ["linearity-not-tested"]);
    assert!(
        found["warnings"][0]["message"].as_str().unwrap().contains("1.0 % of the span"),
        "{}",
        found["warnings"]
    );
    let worst = found["worst"]["sigma_common_k"][1].as_f64().unwrap();
    assert!((worst / 0.2 - 1.0).abs() < 1e-3, "{worst}");
    let most = found["scene"]["sigma_common_most_k"].as_f64().unwrap();
    assert!(most > 0.14 && most < 0.21, "{most}");
    let text = folder.run(&["calibrate", "blackbody", "a.toml"]).stdout;
    assert!(text.contains("only sigma.csv carries it"), "{text}");
    folder.file("a.toml", &two.replacen("uncertainty = \"30 mK\"\n", "", 1));
    let found = folder.json(&["calibrate", "blackbody", "a.toml", "--out", "out"]);
    assert_eq!(codes(&found), ["uncertainty-not-stated", "linearity-not-tested"]);
    assert!(found["warnings"][0]["message"].as_str().unwrap().contains("blackbody[0]"));
    // And said again when what was written is run.
    assert_eq!(
        codes(&folder.json(&["calibrate", "blackbody", "out/scenario.toml"])),
        ["uncertainty-not-stated", "linearity-not-tested"]
    );
}

/// A detector that is not linear: three blackbodies show it, and no errors are written for other commands to read; two cannot.
#[test]
fn errors_of_a_detector_that_is_not_linear_are_not_written() {
    let folder = spectrometer(SPECTROMETER);
    for (name, size) in [("cold", [8, 8]), ("mild", [8, 8]), ("warm", [8, 8]), ("scene", SIZE)] {
        let path = folder.path().join(format!("{name}.npy"));
        // By 2 % of a reading of 1500 counts.
        let bent: Vec<f64> = read_doubles(&path).iter().map(|x| x - 0.02 * x * x / 1500.0).collect();
        write(&folder, &format!("{name}.npy"), [size[0], size[1], BANDS], &bent);
    }
    let found = folder.json(&["calibrate", "blackbody", "a.toml", "--out", "out"]);
    assert_eq!(codes(&found), ["blackbodies-do-not-fit"]);
    assert_eq!(found["misfit"], true);
    let out = folder.path().join("out");
    let written = ["radiance.npy", "sigma.csv", "sigma_common.npy"].map(|name| out.join(name).exists());
    assert_eq!(written, [true, false, false]);
    let text = folder.run(&["calibrate", "blackbody", "a.toml"]).stdout;
    assert!(
        text.starts_with("The blackbodies do not lie on straight lines, so that no error below holds"),
        "{text}"
    );
    assert!(!text.contains("sigma.csv"), "{text}");
}

/// Blackbodies of an emissivity of 0.97 and 0.98 before a room of 22 °C, drawn by Planck's law.
#[test]
fn a_blackbody_that_is_not_quite_black_reflects_its_surroundings() {
    let grey = |k: usize, e: f64, error: f64| {
        let own = format!("emissivity = {e}\nemissivity_error = {error}\nsurroundings = \"22 degC\"\n");
        let mut parts: Vec<String> = SPECTROMETER.split("emissivity = 1.0\n").map(str::to_owned).collect();
        parts[k] += &own;
        parts
    };
    let folder = spectrometer(SPECTROMETER);
    let sent = |band: usize, t: f64, e: f64| {
        let nu = wavenumber(band);
        e * photon_radiance(nu, t) + (1.0 - e) * photon_radiance(nu, 295.15)
    };
    for (name, t, e) in [("cold.npy", 283.15, 0.97), ("warm.npy", 333.15, 0.98)] {
        let samples: Vec<f64> = normal(64 * BANDS, 31)
            .iter()
            .enumerate()
            .map(|(i, z)| {
                let band = i % BANDS;
                1e-15 * (1.0 + 0.3 * (band as f64 / 4.0).sin()) * sent(band, t, e) - 300.0 + 2.0 * z
            })
            .collect();
        write(&folder, name, [8, 8, BANDS], &samples);
    }
    // The coldest and the warmest alone.
    let (first, rest) = SPECTROMETER.split_once("[[blackbody]]\ntemperature = \"35").unwrap();
    let two = format!("{first}[[blackbody]]{}", rest.split_once("[[blackbody]]").unwrap().1);
    let [start, middle, end] =
        <[&str; 3]>::try_from(two.split("emissivity = 1.0\n").collect::<Vec<_>>()).unwrap();
    let own = |e: f64| format!("emissivity = {e}\nemissivity_error = 0.005\nsurroundings = \"22 degC\"\n");
    folder.file("grey.toml", &format!("{start}{}{middle}{}{end}", own(0.97), own(0.98)));
    folder.file("black.toml", &format!("{start}{middle}{end}"));
    let found = folder.json(&["calibrate", "blackbody", "grey.toml", "--out", "grey"]);
    let black = folder.json(&["calibrate", "blackbody", "black.toml", "--out", "black"]);
    assert_eq!(codes(&found), ["linearity-not-tested"]);
    assert_eq!(codes(&black), ["blackbodies-taken-as-black", "linearity-not-tested"]);
    let message = black["warnings"][0]["message"].as_str().unwrap();
    assert!(
        message.contains("one of 0.98 at 333.1 K") || message.contains("one of 0.98 at 333.2 K"),
        "{message}"
    );
    // Where the scene is as warm as it says, and where blackbodies taken as black put it: 0.02 (B - B_s)/B' too warm near the warm one.
    let means = ["grey", "black"].map(|out| {
        let radiance = read(&folder.path().join(out).join("radiance.npy"));
        let pixels = SIZE[0] * SIZE[1];
        let off = |pixel: usize, band: usize| {
            let joules = PLANCK_J_S * SPEED_OF_LIGHT_M_S * 100.0 * wavenumber(band);
            radiance[pixel * BANDS + band] / joules - photon_radiance(wavenumber(band), scene_k(pixel))
        };
        let slope = |band: usize| hadar::planck::photon_radiance_slope(wavenumber(band), 305.0);
        let all = (0..pixels).flat_map(|pixel| (0..BANDS).map(move |band| (pixel, band)));
        all.map(|(pixel, band)| off(pixel, band) / slope(band)).sum::<f64>() / (pixels * BANDS) as f64
    });
    // By hand, a line through both blackbodies that are taken for black, at the mean radiance of the scene.
    let expected = (0..BANDS)
        .map(|band| {
            let nu = wavenumber(band);
            let [cold, warm] = [283.15, 333.15].map(|t| photon_radiance(nu, t));
            let [grey_cold, grey_warm] = [sent(band, 283.15, 0.97), sent(band, 333.15, 0.98)];
            let scene = (0..600).map(|pixel| photon_radiance(nu, scene_k(pixel))).sum::<f64>() / 600.0;
            let taken = cold + (scene - grey_cold) * (warm - cold) / (grey_warm - grey_cold);
            (taken - scene) / hadar::planck::photon_radiance_slope(nu, 305.0)
        })
        .sum::<f64>()
        / BANDS as f64;
    assert!(
        means[0].abs() < 0.02 && (means[1] - means[0] - expected).abs() < 0.01 * expected.abs(),
        "{means:?} {expected}"
    );
    // At the radiance of a blackbody the error of all bands together is its own: of 30 mK and of 0.005.
    for band in 0..BANDS {
        let nu = wavenumber(band);
        let joules = PLANCK_J_S * SPEED_OF_LIGHT_M_S * 100.0 * nu;
        let own = |t: f64, e: f64| {
            let slope = hadar::planck::photon_radiance_slope(nu, t);
            (0.03 * e * slope).hypot(0.005 * (photon_radiance(nu, t) - photon_radiance(nu, 295.15)))
        };
        let hand = joules * own(283.15, 0.97).max(own(333.15, 0.98));
        let together = found["scene"]["sigma_together"][band].as_f64().unwrap();
        assert!((together / hand - 1.0).abs() < 1e-6, "{band} {together} {hand}");
    }
    let again = folder.json(&["calibrate", "blackbody", "grey/scenario.toml"]);
    assert_eq!(again["channels"], found["channels"]);
    let says = |parts: Vec<String>, words: &str| {
        folder.file("a.toml", &parts.concat());
        let line = folder.refusal(&["calibrate", "blackbody", "a.toml"]);
        assert!(line.contains(words), "{line}");
    };
    let without = |parts: Vec<String>| {
        parts.iter().map(|part| part.replace("surroundings = \"22 degC\"\n", "")).collect()
    };
    says(
        without(grey(1, 0.98, 0.0)),
        "blackbody[1].surroundings: the surroundings that a blackbody of emissivity below 1 reflects are missing",
    );
    says(grey(1, 1.2, 0.0), "above 0, at most 1");
}

/// Samples of a scene that are no numbers have no radiance; all others have what they had.
#[test]
fn a_scene_may_miss_samples() {
    let folder = spectrometer(SPECTROMETER);
    folder.json(&["calibrate", "blackbody", "a.toml", "--out", "whole"]);
    let mut samples = read_doubles(&folder.path().join("scene.npy"));
    samples[5 * BANDS + 3] = f64::NAN;
    samples.iter_mut().skip(4).step_by(BANDS).for_each(|x| *x = f64::NAN);
    write(&folder, "scene.npy", [SIZE[0], SIZE[1], BANDS], &samples);
    let found = folder.json(&["calibrate", "blackbody", "a.toml", "--out", "holes"]);
    assert_eq!(codes(&found), ["missing-samples"]);
    assert_eq!(found["scene"]["missing"], SIZE[0] * SIZE[1] + 1);
    assert!(
        found["scene"]["sigma_common_most"].as_array().unwrap().iter().all(|x| x.as_f64().unwrap() > 0.0)
    );
    let [whole, holes] = ["whole", "holes"].map(|out| read(&folder.path().join(out).join("radiance.npy")));
    for (i, (a, b)) in whole.iter().zip(&holes).enumerate() {
        match i == 5 * BANDS + 3 || i % BANDS == 4 {
            true => assert!(b.is_nan()),
            false => assert!((a / b - 1.0).abs() < 1e-12, "{i} {a} {b}"),
        }
    }
}

pub(crate) const WHEEL: &str = r#"title = "Response of a camera"
[response]
filters = "filters.csv"
typical = "typical.csv"
centre_half = 3
[[blackbody]]
temperature = "35 degC"
emissivity = 1.0
data = "bb0.npy"
[[blackbody]]
temperature = "60 degC"
emissivity = 1.0
data = "bb1.npy"
[[blackbody]]
temperature = "85 degC"
emissivity = 1.0
data = "bb2.npy"
[[blackbody]]
temperature = "110 degC"
emissivity = 1.0
data = "bb3.npy"
[noise]
sample = 1.0
[scene]
data = "scene.npy"
reference = "bb0.npy"
reference_temperature = "35 degC"
"#;

/// Parts of each response value of the twin.
const PARTS: usize = 21;

/// The twin of prototype 1 before four blackbodies and a scene of 330 K.
pub(crate) fn wheel(scenario: &str) -> (Folder, FilterWheelTwin) {
    let folder = Folder::with(scenario);
    // What a camera reads is an integral: a sum three times as fine as the program's.
    let twin = FilterWheelTwin::cut(PARTS).unwrap();
    let fine: Vec<f64> = (0..1201).map(|i| 400.0 + f64::from(i)).collect();
    let filters: Vec<[f64; 2]> = hadar_estimate::calibrate::twin::FILTERS.to_vec();
    let curves: Vec<Vec<f64>> = filters.iter().map(|filter| passband(*filter, &fine)).collect();
    let names: Vec<String> = (0..10).map(|q| format!("f{q}")).collect();
    let mut text = format!("wavenumber_cm1,{}\n", names.join(","));
    for (i, nu) in fine.iter().enumerate() {
        let cells: Vec<String> = curves.iter().map(|curve| curve[i].to_string()).collect();
        text += &format!("{nu},{}\n", cells.join(","));
    }
    folder.file("filters.csv", &text);
    let centres = twin.wheel.centres_cm1().to_vec();
    let typical: Vec<String> =
        centres.iter().zip(twin.prior.mean()).map(|(nu, r)| format!("{nu},{r}")).collect();
    folder.file("typical.csv", &format!("wavenumber_cm1,response\n{}\n", typical.join("\n")));
    let mut rng = generator(8, 0);
    for (k, t) in [308.15, 333.15, 358.15, 383.15].iter().enumerate() {
        let cube = twin.blackbody_cube(*t, [15, 17], 1.0, &mut rng);
        write(&folder, &format!("bb{k}.npy"), [15, 17, 10], &cube);
    }
    write(&folder, "scene.npy", [15, 17, 10], &twin.blackbody_cube(330.0, [15, 17], 1.0, &mut rng));
    write(&folder, "small.npy", [15, 16, 10], &vec![1.0; 15 * 16 * 10]);
    (folder, twin)
}

#[test]
fn a_response_comes_with_what_is_determined_and_radiances_with_their_errors() {
    let (folder, twin) = wheel(WHEEL);
    let found = folder.json(&["calibrate", "response", "a.toml", "--out", "out"]);
    let determined = found["determined"].as_u64().unwrap();
    assert!((3..20).contains(&determined), "{determined}");
    let text = folder.run(&["calibrate", "response", "a.toml"]).stdout;
    let first =
        format!("Of 30 response values the readings determine {determined}; the rest is the typical curve");
    assert!(text.starts_with(&first), "{text}");
    // Counts per radiance of the twin at a response of 1.
    let step = twin.wheel.centres_cm1()[1] - twin.wheel.centres_cm1()[0];
    let scale = twin.wheel.weight(0, 210) / step / twin.wheel.transmittance(0)[210];
    let mut square = 0.0;
    for (j, truth) in twin.response.iter().skip(PARTS / 2).step_by(PARTS).enumerate() {
        let row = &found["response"][j];
        let [value, sigma] = ["response", "sigma"].map(|key| row[key].as_f64().unwrap());
        square += ((value / scale - truth) * scale / sigma).powi(2);
    }
    // Neighbours go together: far fewer than 30 errors, each of a deviation of 1.
    assert!(square / 30.0 < 3.5, "{}", square / 30.0);
    // The vignette, and the same radiance in all pixels.
    let radiance = read(&folder.path().join("out/radiance.npy"));
    let blackbody: Vec<f64> = twin.wheel.centres_cm1().iter().map(|nu| photon_radiance(*nu, 330.0)).collect();
    for q in 0..10 {
        let truth = twin.wheel.counts(q, &twin.response, &blackbody)
            / twin.wheel.counts(q, &twin.response, &[1.0; 30 * PARTS]);
        let mean = radiance.iter().skip(q).step_by(10).sum::<f64>() / 255.0;
        let of = |key: &str| found["scene"][key][q].as_f64().unwrap();
        // The reference is one of the blackbodies, so that noise is not quite independent: 0.2 % more, a tenth of a kelvin.
        let sigma = of("sigma_common").hypot(of("sigma_noise") / 255f64.sqrt()).hypot(0.002 * truth);
        assert!((mean - truth).abs() < 4.5 * sigma, "{q} {mean} {truth} {sigma}");
    }
    let again = folder.json(&["calibrate", "response", "out/scenario.toml"]);
    assert_eq!(again["response"], found["response"]);
}

/// A blackbody whose temperature is stated wrongly is named, with how far it is off; errors are then said not to hold.
#[test]
fn a_wrong_temperature_behind_filters_is_named() {
    let (folder, _) = wheel(WHEEL);
    let scenario = WHEEL.split("[scene]").next().unwrap().to_owned();
    folder.file("a.toml", &scenario);
    let found = folder.json(&["calibrate", "response", "a.toml", "--out", "out"]);
    assert_eq!(codes(&found), ["smoothness-not-stated", "uncertainty-not-stated"]);
    // Errors of a response that has kinks are larger, in every value and behind every filter; who states how smooth it is is not told.
    for row in found["response"].as_array().unwrap() {
        let [smooth, kinked] = ["sigma", "sigma_kinked"].map(|key| row[key].as_f64().unwrap());
        assert!(kinked > 0.999 * smooth, "{row}");
    }
    folder.file(
        "stated.toml",
        &scenario
            .replace("centre_half = 3", "centre_half = 3\nshape_error = 0.15\ncorrelation = \"100 cm^-1\""),
    );
    let stated = folder.json(&["calibrate", "response", "stated.toml"]);
    assert_eq!(codes(&stated), ["uncertainty-not-stated"]);
    assert_eq!(stated["response"], found["response"]);
    // 40 readings, less 10 offsets and what the readings tell of the curve.
    let freedom = found["freedom"].as_f64().unwrap();
    let effective = found["effective"].as_f64().unwrap();
    assert!((freedom - (30.0 - effective)).abs() < 1e-3, "{freedom} {effective}");
    let chi = found["chi_square_reduced"].as_f64().unwrap();
    assert!((chi - 1.0).abs() < 5.0 * (2.0 / freedom).sqrt(), "{chi}");
    assert_eq!(found["misfit"], false);
    let text = folder.run(&["calibrate", "response", "a.toml"]).stdout;
    assert!(text.contains("counts (unit of the cubes) per photon s^-1 m^-2 sr^-1"), "{text}");
    // Offsets with their deviations, also without a scene.
    let table = std::fs::read_to_string(folder.path().join("out/filters.csv")).unwrap();
    let [offset, sigma] = [1, 2].map(|c| table.lines().nth(1).unwrap().split(',').nth(c).unwrap().to_owned());
    assert!(table.starts_with("filter,offset,offset_sigma"), "{table}");
    assert!(sigma.parse::<f64>().unwrap() > 0.0 && offset.parse::<f64>().is_ok(), "{table}");
    folder.file("a.toml", &scenario.replace("\"85 degC\"", "\"87.5 degC\""));
    let found = folder.json(&["calibrate", "response", "a.toml"]);
    let warning = &found["warnings"][0];
    assert_eq!(warning["code"], "response-does-not-fit", "{}", found["warnings"]);
    let message = warning["message"].as_str().unwrap();
    assert!(
        message.contains("blackbody[2] (360.65 K)") && message.contains("2.5") && message.contains("colder"),
        "{message}"
    );
    let text = folder.run(&["calibrate", "response", "a.toml"]).stdout;
    assert!(
        text.starts_with("The readings do not fit a response, so that no error or interval below holds"),
        "{text}"
    );
    assert!(text.contains("values known to no stated share"), "{text}");
    // Noise that is stated far too small: no blackbody is to blame.
    folder.file("a.toml", &scenario.replace("sample = 1.0", "sample = 0.01"));
    let found = folder.json(&["calibrate", "response", "a.toml"]);
    assert_eq!(found["misfit"], true, "{}", found["warnings"]);
    for (values, says) in [("0", "from 2 to 200"), ("1", "from 2 to 200")] {
        folder.file("a.toml", &scenario.replace("centre_half = 3", &format!("values = {values}")));
        let line = folder.refusal(&["calibrate", "response", "a.toml"]);
        assert!(line.contains(says), "{line}");
    }
}

#[test]
fn what_no_response_comes_from_is_said() {
    let (folder, _) = wheel(WHEEL);
    let says = |scenario: &str, words: &[&str]| {
        folder.file("a.toml", scenario);
        let line = folder.refusal(&["calibrate", "response", "a.toml"]);
        assert!(words.iter().all(|word| line.contains(word)), "{line}");
    };
    says(
        &WHEEL.replace("reference = \"bb0.npy\"", "reference = \"small.npy\""),
        &["a.toml:", "scene.reference", "15 x 16 x 10", "the scene is 15 x 17 x 10"],
    );
    let equal = ["60", "85", "110"]
        .iter()
        .fold(WHEEL.to_owned(), |text, t| text.replace(&format!("\"{t} degC\""), "\"35 degC\""));
    says(&equal, &["blackbody[1].temperature", "blackbody[0] and blackbody[1] are both at 308.15 K"]);
    says(&WHEEL.replace("sample = 1.0\n", ""), &["the noise of the samples is not stated"]);
    // What a curve does between its values would be in no error.
    says(
        &WHEEL.replace("[response]\n", "[response]\ncorrelation = \"5 cm^-1\"\n"),
        &["response.correlation", "5 cm^-1", "24.5 or more for 30 values 25.69 cm^-1 apart"],
    );
    // The last filter is a mixture of two others.
    let table = std::fs::read_to_string(folder.path().join("filters.csv")).unwrap();
    let mixed = table.lines().enumerate().map(|(i, line)| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if i > 0 {
            let of = |q: usize| cells[q].parse::<f64>().unwrap();
            cells[10] = (0.3 * of(2) + 0.6 * of(5)).to_string();
        }
        cells.join(",")
    });
    folder.file("filters.csv", &mixed.collect::<Vec<_>>().join("\n"));
    says(WHEEL, &["response.filters", "filter `f9`", "the most like `f4`", "linearly dependent"]);
}
