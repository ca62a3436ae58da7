//! What a camera sees beside the target, against sums written out here.

use hadar::instrument::Camera;
use hadar::material::Library;
use hadar::planck::{occupancy, photon_radiance};
use hadar_scenario::Scenario;
use hadar_study::Study;
use std::f64::consts::PI;
use std::path::Path;

const HEAD: &str = "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\ndistance = \"30 m\"\n";
const REST: &str = "[[environment]]\ntemperature = \"20 degC\"\nlighting = 0.5\n\
                    [alternatives]\nmaterials = [\"pmma\"]\n";
const CAMERA: &str = "[camera]\nexposure = \"10 ms\"\npixel = \"12 um\"\nf_number = 1.3\nfocal_length = \"18 mm\"\n\
                      noise_electrons = 0\n";

fn study(text: &str) -> Study {
    made(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn made(text: &str) -> hadar::Result<Study> {
    Study::new(&Scenario::from_toml(text, None)?, &Library::embedded()?)
}

#[track_caller]
fn near(a: f64, b: f64, tolerance: f64) {
    assert!((a / b - 1.0).abs() <= tolerance, "{a:e} against {b:e}");
}

/// Étendue × exposure of the camera above, m² sr s.
fn kappa() -> f64 {
    let near = 18e-3 / 30.0;
    PI * 12e-6 * 12e-6 / (4.0 * 1.3 * 1.3 + near * near) * 10e-3
}

/// Skin at 37 °C, half lit by 20 °C.
fn skin(nu: f64) -> f64 {
    0.95 * photon_radiance(nu, 310.15) + 0.05 * 0.5 * photon_radiance(nu, 293.15)
}

fn file(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    std::fs::write(&path, text).unwrap();
    path.to_string_lossy().into_owned()
}

#[test]
fn a_target_smaller_than_its_pixel_is_mixed_with_what_is_behind() {
    // A pixel sees 20 mm at 30 m: 10 mm fill a quarter.
    let text = format!(
        "{HEAD}size = \"10 mm\"\n[background]\ntemperature = \"5 degC\"\nmaterial = \"pmma\"\n{REST}{CAMERA}"
    );
    let (study, library) = (study(&text), Library::embedded().unwrap());
    let counting = study.counting().unwrap();
    near(counting.counts_per_radiance, 0.25 * kappa(), 1e-14);
    for w in [0, 200, 535] {
        let nu = 715.0 + w as f64;
        let e = library.get("pmma").unwrap().emissivity(&[nu]).unwrap()[0];
        let behind = e * photon_radiance(nu, 278.15) + (1.0 - e) * 0.5 * photon_radiance(nu, 293.15);
        near(counting.var_added(w), 0.75 * kappa() * behind, 1e-12);
    }
    // Larger than the pixel: nothing of it is seen.
    let whole = study_of_size("30 mm");
    assert_eq!(whole.counting().unwrap().var_added, Vec::<f64>::new());
    near(whole.counting().unwrap().counts_per_radiance, kappa(), 1e-14);
}

fn study_of_size(size: &str) -> Study {
    study(&format!("{HEAD}size = \"{size}\"\n[background]\ntemperature = \"5 degC\"\n{REST}{CAMERA}"))
}

#[test]
fn the_air_takes_light_away_and_adds_its_own() {
    let folder = tempfile::tempdir().unwrap();
    // Grey air: half of it is lost at 100 m, so 0.5^0.3 is left at 30 m (the table's columns are of one gray law).
    let table = file(
        folder.path(),
        "air.csv",
        "wavenumber_cm1,tau_30m,tau_100m,tau_300m\n700,0.8122523963562356,0.5,0.125\n1300,0.8122523963562356,0.5,0.125\n",
    );
    let text = format!("{HEAD}{REST}[atmosphere]\ntable = \"{table}\"\ntemperature = \"10 degC\"\n{CAMERA}");
    let study = study(&text);
    let (counting, tau) = (study.counting().unwrap(), 0.5_f64.powf(0.3));
    let signal = study.target_signal();
    for w in [0, 100, 535] {
        let nu = 715.0 + w as f64;
        near(signal[w], tau * skin(nu), 1e-12);
        near(counting.var_added(w), kappa() * (1.0 - tau) * photon_radiance(nu, 283.15), 1e-12);
    }
    // The same from three times as far: what is lost is lost to the third power.
    let far = study.sight_at(study.camera().unwrap(), Some(90.0)).unwrap();
    near(far.bands.widths_cm1()[0], tau.powi(3), 1e-3);
}

#[test]
fn efficiencies_over_wavenumber_weigh_the_light() {
    let folder = tempfile::tempdir().unwrap();
    let flat = file(folder.path(), "flat.csv", "wavenumber_cm1,efficiency\n700,0.5\n1300,0.5\n");
    let slope = file(folder.path(), "slope.csv", "wavenumber_cm1,efficiency\n700,0.2\n1300,0.8\n");
    let number = study(&format!("{HEAD}{REST}{CAMERA}optics_efficiency = 0.5\nquantum_efficiency = 0.8\n"));
    let filed =
        study(&format!("{HEAD}{REST}{CAMERA}optics_efficiency = \"{flat}\"\nquantum_efficiency = 0.8\n"));
    let counts =
        |study: &Study, w: usize| study.counting().unwrap().counts_per_radiance * study.target_signal()[w];
    let sloped =
        study(&format!("{HEAD}{REST}{CAMERA}optics_efficiency = 0.5\nquantum_efficiency = \"{slope}\"\n"));
    for w in [0, 285, 535] {
        let nu = 715.0 + w as f64;
        near(counts(&number, w), 0.4 * kappa() * skin(nu), 1e-12);
        near(counts(&filed, w), counts(&number, w), 1e-12);
        near(counts(&sloped, w), 0.5 * (0.2 + (nu - 700.0) / 1000.0) * kappa() * skin(nu), 1e-12);
    }
}

/// S8: of the sensor's own emission a filter throws back R, and emits 1 − T − R of its own, at all wavenumbers the
/// detector sees.
#[test]
fn filters_throw_the_sensors_light_back_and_emit() {
    let folder = tempfile::tempdir().unwrap();
    let filters = file(
        folder.path(),
        "filters.csv",
        "wavenumber_cm1,a,a:reflectance,b\n800,0.6,0.3,0\n900,0.6,0.3,0\n901,0,0.8,0\n1000,0,0.8,0.9\n1100,0,0.8,0.9\n",
    );
    let text = |more: &str| {
        format!(
            "{HEAD}{REST}[bands]\nfilters = \"{filters}\"\n[unknown]\nnuisances = [\"temperature\"]\n{CAMERA}{more}"
        )
    };
    let bare = study(&text(""));
    assert!(bare.counting().unwrap().var_added.is_empty());
    let study = study(&text("sensor_temperature = \"30 degC\"\nfilter_temperature = \"10 degC\"\n"));
    let counting = study.counting().unwrap();
    // The rows as straight lines; the sum here is ten times finer than the product's.
    let line = |rows: &[(f64, f64)], nu: f64| {
        let right = rows.iter().position(|row| row.0 >= nu);
        match right {
            Some(i) if i > 0 => {
                let ((x, y), (to, value)) = (rows[i - 1], rows[i]);
                Some(y + (value - y) * (nu - x) / (to - x))
            }
            _ => None,
        }
    };
    let t_a = [(800.0, 0.6), (900.0, 0.6), (901.0, 0.0), (1000.0, 0.0), (1100.0, 0.0)];
    let r_a = [(800.0, 0.3), (900.0, 0.3), (901.0, 0.8), (1000.0, 0.8), (1100.0, 0.8)];
    let t_b = [(800.0, 0.0), (900.0, 0.0), (901.0, 0.0), (1000.0, 0.9), (1100.0, 0.9)];
    let (mut a, mut b) = (0.0, 0.0);
    for i in 0..5350 {
        let nu = 715.0 + 0.05 + 0.1 * f64::from(i);
        let (sensor, filter) = (photon_radiance(nu, 303.15), photon_radiance(nu, 283.15));
        let (t, r) = (line(&t_a, nu).unwrap_or(0.0), line(&r_a, nu).unwrap_or(1.0));
        a += 0.1 * (r * sensor + (1.0 - t - r) * filter);
        b += 0.1 * (1.0 - line(&t_b, nu).unwrap_or(0.0)) * sensor;
    }
    near(counting.var_added(0), kappa() * a, 1e-6);
    near(counting.var_added(1), kappa() * b, 1e-6);
}

/// S12: the variance of a band is N(1 + n̄), n̄ the counted photons per mode: of a blackbody its occupancy times η.
#[test]
fn bunching_adds_the_occupancy_of_what_is_counted() {
    let text = format!(
        "{}{REST}{CAMERA}optics_efficiency = 0.5\nphoton_bunching = true\n",
        HEAD.replace("skin", "blackbody").replace("37 degC", "600 K")
    );
    let study = study(&text);
    let (counting, signal) = (study.counting().unwrap(), study.target_signal());
    for w in [0, 300, 535] {
        let photons = counting.counts_per_radiance * signal[w];
        near(counting.var_added(w), photons * 0.5 * occupancy(715.0 + w as f64, 600.0), 1e-12);
    }
}

#[test]
fn what_is_left_open_is_asked_for() {
    let cases = [
        (
            format!("{HEAD}size = \"10 mm\"\n{REST}{CAMERA}"),
            "line 5: target.size: a size, but what is behind the target is not stated; write [background] with \
             temperature = \"15 degC\" (and a material, else a blackbody)",
        ),
        (
            format!("{HEAD}[background]\ntemperature = \"5 degC\"\n{REST}{CAMERA}"),
            "line 5: background: a background, but the target has no size; write size = \"0.5 m\" in [target]; without \
             it the target fills the pixel",
        ),
        (
            format!(
                "{}[atmosphere]\nmodel = \"tropical\"\n{REST}{CAMERA}",
                HEAD.replace("distance = \"30 m\"\n", "")
            ),
            "line 1: target.distance: air on the path, but the target has no distance; write distance = \"30 m\"",
        ),
        (
            format!("{HEAD}[atmosphere]\nmodel = \"tropic\"\n{REST}{CAMERA}"),
            "line 6: atmosphere.model: there is no model atmosphere `tropic`; did you mean `tropical`?",
        ),
        (
            format!("{HEAD}{REST}{CAMERA}").replace("noise_electrons = 0", "detectivity = \"4e10 Jones\""),
            "line 15: camera.detectivity: detectivity without a bandwidth; write noise_bandwidth = \"175 kHz\", or \
             noise_exposure = \"2.86 us\" for 1/(2 x 2.86 us)",
        ),
        (
            format!("{HEAD}{REST}{CAMERA}frame_rate = \"200 Hz\"\n"),
            "line 11: camera.exposure: exposure is 0.01 s; it must be at most the 5 ms of a frame (frame_rate = \"200 Hz\")",
        ),
        (
            format!("{HEAD}{REST}{CAMERA}quantisation_bits = 14\n"),
            "line 16: camera.quantisation_bits: quantisation_bits without a full_well to divide; write full_well = 1e7 \
             beside it",
        ),
        (
            format!(
                "{HEAD}{REST}[bands]\nranges = [[\"1310 cm^-1\", \"1350 cm^-1\"]]\n{CAMERA}spectral_range = [\"715 cm^-1\", \"1250 cm^-1\"]\n"
            ),
            "line 10: bands: the band from 1310 to 1350 cm^-1 lies outside the range of the detector, 715 to 1250 \
             cm^-1; leave it out, or take another camera",
        ),
    ];
    for (text, message) in cases {
        let found = made(&text).expect_err(&text).to_string();
        assert!(found.starts_with(message), "{found}\n{message}");
    }
}

/// The same camera by an exposure of its own and by the preset it is made of.
#[test]
fn a_camera_that_no_document_completes_asks_for_what_is_missing() {
    let text = format!("{HEAD}{REST}[camera]\npreset = \"flir-a655sc\"\n");
    let message = made(&text).unwrap_err().to_string();
    let (head, block) = message.split_once('\n').unwrap();
    assert_eq!(
        head,
        "line 10: camera.exposure: no document that was read states exposure, pixel, f_number, focal_length of flir-a655sc; \
         write what the camera has in place of the dots:"
    );
    assert!(made(&format!("{text}{block}\n")).unwrap_err().to_string().contains("`…` stands for a figure"));
    let whole = format!("{text}{}\n", block.replace('…', "16"));
    let camera: Camera = study(&whole).camera().unwrap().clone();
    assert!(camera.name.contains("as completed") && !camera.assumed.is_empty(), "{camera:?}");
}

/// Without a preset all figures are asked for at once, and the lines of the message are what to paste.
#[test]
fn a_camera_of_ones_own_asks_for_all_that_it_lacks() {
    let text = format!("{HEAD}{REST}[camera]\nf_number = 1.0\n");
    let message = made(&text).unwrap_err().to_string();
    let (head, block) = message.split_once('\n').unwrap();
    let found = "neither a preset nor exposure, pixel, focal_length, netd is given";
    assert!(head.contains(found) && !message.contains("flir"), "{message}");
    let whole = format!("{text}{}\n", block.replace('…', "16"));
    assert!(made(&whole).unwrap().camera().is_some());
    let blank = made(&format!("{HEAD}{REST}[camera]\nf_number = …\n")).unwrap_err().to_string();
    assert_eq!(blank, "line 11: `…` stands for a figure; write the camera's own in its place");
}
