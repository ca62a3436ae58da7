//! `hadar range` of a scenario with `signal = "air"`, as a user runs it: the closed form, the blind case, every mistake one line.

use crate::support::folder::Folder;
use hadar::planck;
use serde_json::Value;
use std::fmt::Write as _;
use std::fs;

const AIR_K: f64 = 290.0;
const TARGET_K: f64 = 305.0;
const NOISE: f64 = 3000.0;
const DISTANCE_M: f64 = 80.0;

/// A grey target in front of nothing, in air of Beer's law.
const GREY: &str = r#"signal = "air"
[target]
material = "grey.csv"
temperature = "305 K"
distance = "80 m"
[atmosphere]
table = "air.csv"
temperature = "290 K"
[bands]
start = "800 cm^-1"
stop = "1200 cm^-1"
step = "20 cm^-1"
[unknown]
nuisances = []
[camera]
exposure = "10 ms"
pixel = "30 um"
f_number = 2.0
focal_length = "50 mm"
noise_electrons = 3000
[distances]
list = ["20 m", "80 m", "400 m"]
"#;

/// A wall between sky and ground.
pub(crate) const WALL: &str = r#"signal = "air"
[target]
material = "concrete"
temperature = "35 degC"
distance = "100 m"
[[environment]]
temperature = "-20 degC"
lighting = 0.5
[atmosphere]
model = "midlatitude-summer"
[bands]
start = "770 cm^-1"
stop = "1250 cm^-1"
step = "20 cm^-1"
[unknown]
nuisances = ["temperature", "lighting", "emissivity"]
emissivity_error = 0.005
[camera]
exposure = "10 ms"
pixel = "30 um"
f_number = 2.0
focal_length = "50 mm"
nesr = "0.1 uflick"
[distances]
from = "15 m"
to = "150 m"
points = 4
[stereo]
baseline = "0.2 m"
texture = 0.01
[requirement]
relative_distance_error = 0.2
"#;

fn coefficient(nu: f64) -> f64 {
    5e-4 + 4e-3 * (-((nu - 950.0) / 70.0).powi(2)).exp()
}

pub(crate) fn with_air(scenario: &str) -> Folder {
    let folder = Folder::with(scenario);
    let mut air = "wavenumber_cm1,tau_10m,tau_100m,tau_1000m".to_owned();
    for i in 0..=20 {
        let nu = 800.0 + 20.0 * f64::from(i);
        let tau = |z: f64| (-coefficient(nu) * z).exp();
        let _ = write!(air, "\n{nu},{:e},{:e},{:e}", tau(10.0), tau(100.0), tau(1000.0));
    }
    folder.file("air.csv", &air);
    folder.file("grey.csv", "wavenumber_cm1,emissivity\n700,0.9\n1300,0.9\n");
    folder
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn a_grey_target_has_the_bound_of_its_closed_form() {
    let result = with_air(GREY).json(&["range", "a.toml"]);
    let bands = result["bands"].as_array().unwrap();
    assert_eq!(bands.len(), 21);
    let (mut zz, mut zt, mut tt) = (0.0, 0.0, 0.0);
    for band in bands {
        let nu = number(&band["center_cm1"]);
        let (k, counts) = (coefficient(nu), number(&band["counts"]));
        let tau = (-k * DISTANCE_M).exp();
        let own = 0.9 * planck::photon_radiance(nu, TARGET_K);
        let air = planck::photon_radiance(nu, AIR_K);
        let kappa = counts / (tau * own + (1.0 - tau) * air);
        let dz = kappa * k * tau * (air - own);
        let dt = kappa * tau * 0.9 * planck::photon_radiance_slope(nu, TARGET_K);
        let var = counts + NOISE * NOISE;
        let found = number(&band["information_per_m2"]);
        assert!((found / (dz * dz / var) - 1.0).abs() < 1e-10, "{nu}: {found} {}", dz * dz / var);
        zz += dz * dz / var;
        zt += dz * dt / var;
        tt += dt * dt / var;
    }
    let sigma = |result: &Value| number(&result["at"]["sigma_m"]);
    assert!((sigma(&result) * zz.sqrt() - 1.0).abs() < 1e-10);
    let unknown = with_air(&GREY.replace("nuisances = []", "nuisances = [\"temperature\"]"));
    let found = sigma(&unknown.json(&["range", "a.toml"]));
    assert!((found * (zz - zt * zt / tt).sqrt() - 1.0).abs() < 1e-10, "{found}");
}

#[test]
fn a_target_like_the_air_has_no_distance() {
    let room = GREY
        .replace("305 K", "290 K")
        .replace("[atmosphere]", "[[environment]]\ntemperature = \"290 K\"\nlighting = 1.0\n[atmosphere]");
    let folder = with_air(&room);
    let result = folder.json(&["range", "a.toml", "--trials", "2"]);
    assert_eq!((&result["sight"]["status"], &result["at"]["sigma_m"]), (&"unchanged".into(), &Value::Null));
    assert_eq!(result["witness"], Value::Array(Vec::new()));
    let codes: Vec<&Value> =
        result["warnings"].as_array().unwrap().iter().map(|warning| &warning["code"]).collect();
    assert!(codes.contains(&&"distance-not-seen".into()), "{codes:?}");
    let outcome = folder.run(&["range", "a.toml"]);
    assert!(
        outcome.stdout.starts_with(
            "At 80.0 m no band holds information on the distance: the target looks like the air"
        )
    );
    // Two bands and two unknowns.
    let few = GREY
        .replace("nuisances = []", "nuisances = [\"temperature\", \"gain\"]")
        .replace("step = \"20 cm^-1\"", "step = \"400 cm^-1\"");
    let few = with_air(&few).json(&["range", "a.toml"]);
    assert_eq!((&few["sight"]["status"], &few["at"]["sigma_m"]), (&"imitated".into(), &Value::Null));
    let blind = few["sight"]["blind_direction"].as_array().unwrap();
    assert_eq!(blind.len(), 2, "{blind:?}");
}

#[test]
fn estimates_are_the_same_again_and_stand_beside_their_bound() {
    let folder = Folder::with(WALL);
    let result = folder.json(&["range", "a.toml", "--trials", "60", "--bands", "4"]);
    let again = folder.json(&["range", "a.toml", "--trials", "60", "--bands", "4", "--threads", "1"]);
    assert_eq!(result["witness"], again["witness"]);
    let witness = result["witness"].as_array().unwrap();
    assert_eq!(witness.len(), 4);
    for one in witness {
        // Of 60 spectra the root mean square is known to 9 %: five times that are allowed.
        let ratio = number(&one["rmse_over_bound"]);
        assert!((0.5..1.5).contains(&ratio) && one["unconverged"] == 0, "{one}");
    }
    let (best, at) = (&result["best_bands"], &result["at"]);
    assert_eq!(best["centers_cm1"].as_array().unwrap().len(), 4);
    let [all, own, proved] = ["sigma_all_bands_m", "sigma_m", "sigma_proved_m"].map(|key| number(&best[key]));
    assert!((all / number(&at["sigma_m"]) - 1.0).abs() < 1e-9 && all < proved && proved <= own);
    // Less unknown is less error; a model without sky is off.
    let [sigma, known, lit, alone] =
        ["sigma_m", "sigma_emissivity_known_m", "sigma_lighting_known_m", "sigma_others_known_m"]
            .map(|key| number(&at[key]));
    assert!(alone < known && known < sigma && alone < lit && lit <= sigma);
    assert!(number(&at["bias_without_sky_m"]).abs() > 0.1);
    assert!(number(&at["sigma_stereo_m"]) > 0.0);
    // What is demanded, and up to where.
    let met = result["verdict"]["met"].as_bool().unwrap();
    let [near, far] = [0, 1].map(|i| number(&result["met_between_m"][i]));
    assert_eq!(met, near <= 100.0 && 100.0 <= far, "{near} {far}");
    // At the nearer end it is just met.
    let there = WALL.replace("distance = \"100 m\"", &format!("distance = \"{near} m\""));
    let there = Folder::with(&there).json(&["range", "a.toml"]);
    assert!((number(&there["at"]["relative_sigma"]) / 0.2 - 1.0).abs() < 1e-9, "{near}");
    // A yes counts under the conditions that are accepted, a no under any.
    let [easy, hard] = ["= 9.0\n", "= 1e-6\n"].map(|demand| Folder::with(&WALL.replace("= 0.2\n", demand)));
    let conditions = easy.json(&["range", "a.toml"])["verdict"]["conditions"].clone();
    let codes: Vec<&str> =
        conditions.as_array().unwrap().iter().map(|one| one["code"].as_str().unwrap()).collect();
    assert!(codes.contains(&"air-temperature-known") && codes.contains(&"full-well"), "{codes:?}");
    let accepted = codes.join(",");
    let check = ["range", "a.toml", "--check", "-q"];
    let with_all = [&check[..], &["--accept", &accepted]].concat();
    assert_eq!([easy.run(&check).code, easy.run(&with_all).code, hard.run(&with_all).code], [3, 0, 3]);
}

#[test]
fn a_report_has_every_plot_with_its_table() {
    let folder = Folder::with(WALL);
    let outcome = folder.run(&["range", "a.toml", "--trials", "3", "--out", "out", "-q"]);
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    for name in ["error_over_distance", "information_by_band", "bias_without_sky", "stereo_against_air"] {
        for kind in ["svg", "png", "csv"] {
            let path = folder.path().join(format!("out/{name}.{kind}"));
            assert!(fs::metadata(&path).is_ok_and(|file| file.len() > 0), "{} is missing", path.display());
        }
    }
    let again = folder.json(&["range", "out/scenario.toml"]);
    let first = folder.json(&["range", "a.toml"]);
    assert_eq!((&again["at"], &again["curve"]), (&first["at"], &first["curve"]));
}

#[test]
fn every_mistake_is_one_line() {
    let said = |from: &str, to: &str, arguments: &[&str]| {
        let scenario = WALL.replace(from, to);
        assert_ne!(scenario, WALL, "{from}");
        let folder = Folder::with(&scenario);
        let outcome = folder.run(&[&["range", "a.toml", "-q"], arguments].concat());
        assert_eq!(outcome.code, 1, "{}", outcome.stderr);
        // A camera without noise is shown what it lacks.
        let lines = if to.is_empty() && from.starts_with("nesr") { 2 } else { 1 };
        assert_eq!(outcome.stderr.trim_end().lines().count(), lines, "{}", outcome.stderr);
        outcome.stderr.trim_end().trim_start_matches("error: ").to_owned()
    };
    for (from, to, expected) in [
        ("nesr = \"0.1 uflick\"\n", "", "a.toml:18: camera.netd: neither a preset nor netd is given"),
        (
            "start = \"770 cm^-1\"",
            "start = \"690 cm^-1\"",
            "a.toml:11: bands: wavenumber is 690 cm^-1; it must be from 700 to 1350 cm^-1",
        ),
        (
            "stop = \"1250 cm^-1\"",
            "stop = \"1390 cm^-1\"",
            "a.toml:3: target.material: `concrete` is known from 690 to 1362 cm^-1",
        ),
        ("[atmosphere]\nmodel = \"midlatitude-summer\"\n", "", "a.toml: atmosphere: the table is missing"),
        (
            "to = \"150 m\"",
            "to = \"20 km\"",
            "a.toml:24: distances: distance is 20000 m; it must be at most 10000 m",
        ),
        ("to = \"150 m\"", "to = \"0 m\"", "a.toml:26: distances.to: `0 m` is out of range"),
        ("to = \"150 m\"", "to = \"9 m\"", "a.toml:26: distances.to: to (9 m) is not above from (15 m)"),
        ("distance = \"100 m\"", "distance = \"-5 m\"", "a.toml:5: target.distance: `-5 m` is out of range"),
        ("distance = \"100 m\"", "distance = \"20 km\"", "a.toml:5: target.distance: distance is 20000 m"),
        (
            "distance = \"100 m\"\n",
            "",
            "a.toml:2: target.distance: the key is missing, and the distance is what is asked for",
        ),
        ("= 0.005", "= nan", "a.toml:17: unknown.emissivity_error: emissivity_error is NaN"),
        (
            ", \"emissivity\"",
            "",
            "a.toml:17: unknown.emissivity_error: emissivity_error, but the emissivity is not among",
        ),
        ("texture = 0.01", "texture = 0", "a.toml:30: stereo.texture: texture is 0"),
        ("\"air\"", "\"sound\"", "a.toml:1: signal: `sound` is not known here; write \"air\""),
        (
            "texture = 0.01",
            "window = [9999, 5]\ntexture = 0.01",
            "a.toml:30: stereo.window[0]: side of the window is 9999 pixels; it must be at most 1000",
        ),
    ] {
        let message = said(from, to, &[]);
        assert!(message.starts_with(expected), "{from}: {message}");
    }
    let few = said("points = 4", "points = 3", &["--bands", "2"]);
    assert!(few.starts_with("--bands: number of bands is 2; it must be at least 3, one more than"), "{few}");
    let fine = WALL
        .replace("step = \"20 cm^-1\"", "step = \"2 cm^-1\"\n")
        .replace("= 0.005", "= 0.005\nemissivity_correlation = \"1 cm^-1\"");
    let outcome = Folder::with(&fine).run(&["range", "a.toml", "-q", "--bands", "4"]);
    assert!(
        outcome.stderr.starts_with("error: --bands: number of unknowns is 243; it must be at most 100"),
        "{}",
        outcome.stderr
    );
    let none = said("[requirement]\nrelative_distance_error = 0.2\n", "", &["--check"]);
    assert!(none.contains("requirement: --check, but nothing is demanded"), "{none}");
    // A target in front of air is no scenario of another command.
    let folder = Folder::with(WALL);
    let message = folder.run(&["size", "a.toml", "-q"]).stderr;
    assert!(message.contains("a.toml:1: this is a ranging scenario; hadar range a.toml"), "{message}");
}

#[test]
fn what_the_air_leaves_open_is_said() {
    let scenario = WALL
        .replace("from = \"15 m\"", "from = \"2 m\"")
        .replace("step = \"20 cm^-1\"", "step = \"2 cm^-1\"")
        .replace("[[environment]]", "[[environment]]\nmaterial = \"sky-midlatitude-summer\"")
        .replace(
            "[\"temperature\", \"lighting\", \"emissivity\"]\nemissivity_error = 0.005",
            "[\"temperature\"]",
        );
    let result = Folder::with(&scenario).json(&["range", "a.toml"]);
    let codes: Vec<&str> = result["warnings"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|warning| warning["code"].as_str())
        .collect();
    for code in ["air-band-means", "air-extrapolated", "air-mirrored-sky", "emissivity-taken-as-exact"] {
        assert!(codes.contains(&code), "{code}: {codes:?}");
    }
}
