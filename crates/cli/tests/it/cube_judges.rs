//! A cube that is not as told: its model is rejected and the cause named, bad pixels and bands are left out, and no pixel changes another.

use crate::decompose::{BANDS, SCENARIO, emissivity, sky, wavenumber, with};
use crate::support::folder::Folder;
use hadar::cube::Shape;
use hadar::planck::photon_radiance;
use hadar::random::generator;
use hadar_formats::cube::write_npy;
use rand::RngExt;
use serde_json::Value;
use std::fs;

const ROWS: usize = 20;
const COLUMNS: usize = 25;
const PIXELS: usize = ROWS * COLUMNS;

/// Shot noise of two materials, all counts larger by a share.
fn counts(seed: u64, gain: f64) -> Vec<f64> {
    counts_of(seed, gain, 1e-13)
}

/// The same with so many counts for a photon radiance.
fn counts_of(seed: u64, gain: f64, scale: f64) -> Vec<f64> {
    let mut random = generator(seed, 0);
    let mut all = Vec::with_capacity(PIXELS * BANDS);
    for i in 0..PIXELS {
        let (m, t) = (i % 2, 283.0 + 25.0 * (i as f64 * 0.618_034).fract());
        let v = 0.1 + 0.8 * (i as f64 * 0.414_214).fract();
        for w in 0..BANDS {
            let (e, nu) = (emissivity(m, w), wavenumber(w));
            let lit = v * sky(w) + (1.0 - v) * photon_radiance(nu, 293.15);
            let mean = scale * (1.0 + gain) * (e * photon_radiance(nu, t) + (1.0 - e) * lit);
            // Twelve even numbers have the variance 1; of these counts shot noise is normal.
            let normal = (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
            all.push((mean + mean.sqrt() * normal).round());
        }
    }
    all
}

fn asked(samples: &[f64]) -> Folder {
    let scenario = SCENARIO.split("[truth]").next().unwrap();
    let folder = with(scenario);
    put(&folder, samples);
    folder
}

fn put(folder: &Folder, samples: &[f64]) {
    write_npy(&folder.path().join("counts.npy"), Shape::new(ROWS, COLUMNS, BANDS).unwrap(), samples).unwrap();
}

fn answered(folder: &Folder) -> Value {
    folder.json(&["decompose", "a.toml"])
}

#[test]
fn a_gain_is_named_and_nothing_is_decided() {
    let right = answered(&asked(&counts(1, 0.0)));
    assert_eq!(right["model"]["verdict"], "not-rejected", "{right:#}");
    assert!(right["decided"].as_u64().unwrap() > 450);
    assert_eq!(right["decided"], right["decided_if_model_holds"]);
    let folder = asked(&counts(1, 0.01));
    let wrong = answered(&folder);
    assert_eq!(wrong["model"]["verdict"], "rejected", "{wrong:#}");
    assert_eq!((wrong["decided"].as_u64(), wrong["undecided"].as_u64()), (Some(0), Some(PIXELS as u64)));
    assert!(wrong["decided_if_model_holds"].as_u64().unwrap() > 400);
    assert!(wrong["found"].as_array().unwrap().iter().all(|row| row["decided"] == 0));
    let causes = wrong["model"]["causes"].as_array().unwrap();
    let gain = causes.iter().find(|row| row["cause"] == "gain").unwrap();
    let [estimate, sigma] = ["estimate", "sigma"].map(|key| gain[key].as_f64().unwrap());
    assert!((estimate - 0.01).abs() < 5.0 * sigma && gain["may_be"] == true, "{gain:#}");
    // Deviations hold what it would do: they are wider than those of the right cube.
    let sigma = |result: &Value| result["found"][0]["temperature_sigma_median_k"].as_f64().unwrap();
    assert!(sigma(&wrong) > 1.5 * sigma(&right));
    let text = folder.run(&["decompose", "a.toml"]).stdout;
    assert!(text.starts_with("The cube does not follow its model: "), "{text}");
    assert!(text.contains("none is decided") && text.contains("a gain: all counts larger by "), "{text}");
    assert!(text.contains("[model-rejected]"), "{text}");
}

/// Where fewer than half of the pixels have one candidate no cause is asked for: a wrong gain is then not judged, and nothing speaks for the model.
#[test]
fn a_model_of_which_no_cause_was_asked_is_not_judged() {
    let mut few = 0;
    for scale in [1e-13, 1e-15, 1e-16, 3e-17, 1e-17] {
        let folder = asked(&counts_of(4, 0.05, scale));
        let text = fs::read_to_string(folder.path().join("a.toml")).unwrap();
        folder.file("a.toml", &text.replace("= 1e-13", &format!("= {scale:e}")));
        let found = answered(&folder);
        let model = &found["model"];
        let is_asked = model["pixels_asked"].as_u64().unwrap() > 0;
        assert!(is_asked || model["verdict"] != "not-rejected", "{scale:e}: {model:#}");
        few += usize::from(model["verdict"] == "not-judged");
        if model["verdict"] == "not-judged" {
            let said = folder.run(&["decompose", "a.toml"]).stdout;
            assert!(said.contains("Whether the cube follows its model was not asked"), "{said}");
        }
    }
    assert!(few > 0);
}

/// Errors of the library that are not small beside what its materials reflect are warned of.
#[test]
fn errors_of_the_library_that_are_not_small_are_said() {
    let folder = asked(&counts(5, 0.0));
    let text = fs::read_to_string(folder.path().join("a.toml")).unwrap();
    for (error, is_said) in [("0.0005", false), ("0.02", true)] {
        folder.file(
            "a.toml",
            &text.replace("[library]\n", &format!("[library]\nemissivity_error = {error}\n")),
        );
        let warnings = answered(&folder)["warnings"].to_string();
        assert_eq!(warnings.contains("library-error-not-small"), is_said, "{error}: {warnings}");
    }
}

/// Whatever is put into a pixel, the files of all others keep their bits.
#[test]
fn a_spoilt_pixel_changes_no_other() {
    let good = counts(2, 0.0);
    let folder = asked(&good);
    let maps = |to: &str| -> Vec<(String, Vec<u8>, usize)> {
        assert_eq!(folder.run(&["decompose", "a.toml", "--out", to]).code, 0);
        let names = [
            "material",
            "temperature_k",
            "temperature_sigma_k",
            "p_value",
            "posterior",
            "candidates",
            "flags",
        ];
        names
            .iter()
            .map(|name| {
                let bytes = fs::read(folder.path().join(to).join(format!("{name}.npy"))).unwrap();
                let size = bytes.len() / PIXELS;
                (name.to_string(), bytes[bytes.len() - size * PIXELS..].to_vec(), size)
            })
            .collect()
    };
    let before = maps("before");
    let spoilt =
        [(7, 1e36, 1), (111, 0.0, BANDS), (250, 1e20, BANDS), (333, f64::NAN, 1), (499, 3.0e5, BANDS)];
    for (place, (pixel, value, bands)) in spoilt.into_iter().enumerate() {
        let mut samples = good.clone();
        samples[pixel * BANDS..pixel * BANDS + bands].fill(value);
        put(&folder, &samples);
        for ((name, before, size), (_, after, _)) in before.iter().zip(maps(&format!("after{place}"))) {
            let others = (0..PIXELS).filter(|i| *i != pixel);
            for i in others {
                assert_eq!(
                    before[i * size..][..*size],
                    after[i * size..][..*size],
                    "{name} of {i} by {value} in {pixel}"
                );
            }
        }
        let found = answered(&folder);
        assert_eq!(found["skipped"], 1, "{value}");
        assert_eq!(found["bad"]["pixels"][0]["pixels"], 1);
    }
}

#[test]
fn bad_bands_and_pixels_are_left_out_unless_they_are_kept() {
    let mut samples = counts(3, 0.0);
    samples.iter_mut().skip(4).step_by(BANDS).for_each(|n| *n = 0.0);
    samples.iter_mut().skip(9).step_by(BANDS).for_each(|n| *n = f64::NAN);
    let folder = asked(&samples);
    let found = answered(&folder);
    let bands: Vec<u64> =
        found["bad"]["bands"].as_array().unwrap().iter().map(|bad| bad["band"].as_u64().unwrap()).collect();
    assert_eq!(bands, [4, 9]);
    assert!(found["skipped"] == 0 && found["decided"].as_u64().unwrap() > 450, "{found:#}");
    assert_eq!(found["model"]["verdict"], "not-rejected");
    let kept = folder.json(&["decompose", "a.toml", "--bad", "keep"]);
    assert_eq!(kept["skipped"], PIXELS as u64, "a band without readings leaves no pixel");
    // A map names pixels; one of another size is refused.
    let named: Vec<u16> = (0..PIXELS).map(|i| u16::from(i < 30)).collect();
    write_npy(
        &folder.path().join("bad.npy"),
        Shape::new(ROWS, COLUMNS, 1).unwrap(),
        &named.iter().map(|x| f64::from(*x)).collect::<Vec<f64>>(),
    )
    .unwrap();
    let set = ["decompose", "a.toml", "--set", "cube.bad_pixels=\"bad.npy\""];
    assert_eq!(folder.json(&set)["skipped"], 30);
    write_npy(&folder.path().join("bad.npy"), Shape::new(1, 2, 1).unwrap(), &[0.0, 1.0]).unwrap();
    let told = folder.refusal(&set);
    assert!(told.contains("the map is 1 x 2 x 1, the cube 20 x 25 pixels"), "{told}");
}
