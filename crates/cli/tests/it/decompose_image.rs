//! `hadar decompose` with a prior over the image, and the picture that it draws.

use crate::support::folder::Folder;
use hadar::cube::{Cube, Rows, Sample, Shape};
use hadar::planck::photon_radiance;
use hadar_formats::cube::write_npy;
use std::collections::HashMap;

const SCENARIO: &str = r#"[cube]
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
[library]
path = "library.csv"
[unknown]
temperature = ["250 K", "340 K"]
lighting_total = 1.0
[spatial]
prior = "potts"
temperature_step = "500 mK"
[vision]
hues = { "Wall Paint" = 30 }
temperature = ["10 degC", "40 degC"]
"#;

const ROWS: usize = 48;
const COLUMNS: usize = 72;
const BANDS: usize = 21;
const HOLE: usize = 5 * COLUMNS + 7;

fn wavenumber(band: usize) -> f64 {
    800.0 + 20.0 * band as f64
}

fn emissivity(material: usize, band: usize) -> f64 {
    let nu = wavenumber(band);
    [
        0.9 + 0.05 * (nu / 30.0).sin(),
        0.5 + 0.3 * (-((nu - 1000.0) / 50.0).powi(2)).exp(),
        0.8 + 0.1 * (nu / 45.0).cos(),
    ][material]
}

fn sky(band: usize) -> f64 {
    photon_radiance(wavenumber(band), 260.0) * (0.7 + 0.2 * (wavenumber(band) / 45.0).cos())
}

/// Material, temperature and share of the sky of a pixel: blocks, each with a slope of temperature, and waves of lighting over all.
fn truth(i: usize) -> (usize, f64, f64) {
    let (row, column) = (i / COLUMNS, i % COLUMNS);
    let block = row / 16 * 3 + column / 24;
    let temperature_k = 283.15 + 3.0 * block as f64 + 0.2 * (column % 24) as f64;
    (block * 2 % 3, temperature_k, 0.5 + 0.3 * (row as f64 / 5.0).sin() * (column as f64 / 7.0).cos())
}

fn with(scenario: &str) -> Folder {
    let folder = Folder::with(scenario);
    let mut library = String::from("wavenumber_cm1,Wall Paint,pane,vegetation\n");
    let mut light = String::from("wavenumber_cm1,sky\n");
    for w in 0..BANDS {
        let e = [0, 1, 2].map(|m| emissivity(m, w).to_string());
        library.push_str(&format!("{},{}\n", wavenumber(w), e.join(",")));
        light.push_str(&format!("{},{}\n", wavenumber(w), sky(w)));
    }
    folder.file("library.csv", &library);
    folder.file("light.csv", &light);
    let counts: Vec<f64> = (0..ROWS * COLUMNS)
        .flat_map(|i| {
            let (m, t, v) = truth(i);
            (0..BANDS).map(move |w| {
                let (e, nu) = (emissivity(m, w), wavenumber(w));
                let light = v * sky(w) + (1.0 - v) * photon_radiance(nu, 293.15);
                let n = 1e-13 * (e * photon_radiance(nu, t) + (1.0 - e) * light);
                if i == HOLE { f64::NAN } else { n }
            })
        })
        .collect();
    write_npy(&folder.path().join("counts.npy"), Shape::new(ROWS, COLUMNS, BANDS).unwrap(), &counts).unwrap();
    folder
}

fn map(folder: &Folder, name: &str) -> Vec<f64> {
    fn all<S: Sample>(rows: &dyn Rows<S>) -> Vec<f64> {
        let mut buffer = Vec::new();
        rows.read(0..ROWS, &mut buffer).unwrap().iter().map(|x| (*x).into()).collect()
    }
    match hadar_formats::cube::open(&folder.path().join("out").join(name), None).unwrap() {
        Cube::F32(rows) => all(rows.as_ref()),
        Cube::F64(rows) => all(rows.as_ref()),
    }
}

/// Hue, saturation, texture and thermal image are those of what is there.
#[test]
fn the_picture_shows_what_is_there() {
    let folder = with(SCENARIO);
    let found = folder.json(&["decompose", "a.toml", "--out", "out"]);
    assert_eq!(found["spatial"]["changed"].as_u64(), Some(0));
    assert_eq!(found["spatial"]["temperature_step_k"].as_f64(), Some(0.5));
    let hues: Vec<f64> =
        found["vision"]["hues_deg"].as_array().unwrap().iter().map(|hue| hue.as_f64().unwrap()).collect();
    assert_eq!((hues[0], hues[1]), (30.0, 210.0));
    assert!((hues[2] - 360.0 * 90.0 / 255.0).abs() < 1e-9);
    let codes: Vec<&str> =
        found["warnings"].as_array().unwrap().iter().filter_map(|one| one["code"].as_str()).collect();
    assert!(codes.contains(&"spatial-prior"), "{codes:?}");
    let sum = |light: &dyn Fn(usize) -> f64| 20.0 * (0..BANDS).map(light).sum::<f64>();
    let (from_sky, from_ground) = (sum(&sky), sum(&|w| photon_radiance(wavenumber(w), 293.15)));
    let (texture, thermal) = (map(&folder, "texture.npy"), map(&folder, "thermal.npy"));
    let text = std::fs::read_to_string(folder.path().join("out/tex_vision.csv")).unwrap();
    let mut lines = text.lines();
    let names: HashMap<&str, usize> =
        lines.next().unwrap().split(',').enumerate().map(|(i, name)| (name, i)).collect();
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), ROWS * COLUMNS);
    let mut brightness = Vec::new();
    for (i, row) in rows.iter().enumerate() {
        let cell = |name: &str| row[names[name]].parse::<f64>();
        if i == HOLE {
            assert!(cell("hue_deg").is_err() && texture[i].is_nan() && thermal[i].is_nan());
            assert_eq!(cell("saturation"), Ok(0.0));
            assert!((cell("brightness").unwrap() - 0.65).abs() < 1e-9);
            continue;
        }
        let (m, t, v) = truth(i);
        assert!((cell("hue_deg").unwrap() - hues[m]).abs() < 1e-9, "{i}");
        let saturation = 0.25 + 0.75 * ((t - 283.15) / 30.0).clamp(0.0, 1.0);
        assert!((cell("saturation").unwrap() - saturation).abs() < 2e-3, "{i}");
        let x = v * from_sky + (1.0 - v) * from_ground;
        assert!((texture[i] / x - 1.0).abs() < 1e-4, "{i}: {} {x}", texture[i]);
        let sent = sum(&|w| {
            let (e, nu) = (emissivity(m, w), wavenumber(w));
            e * photon_radiance(nu, t) + (1.0 - e) * (v * sky(w) + (1.0 - v) * photon_radiance(nu, 293.15))
        });
        assert!((thermal[i] / sent - 1.0).abs() < 1e-6, "{i}");
        brightness.push(cell("brightness").unwrap());
    }
    let (low, high) = brightness.iter().fold((1.0f64, 0.0f64), |(l, h), x| (l.min(*x), h.max(*x)));
    assert!((0.3..0.4).contains(&low) && (0.9..=1.0).contains(&high), "{low} {high}");
    // The bare image has a pixel for each of the cube's.
    let image = std::fs::read(folder.path().join("out/tex_vision_image.png")).unwrap();
    assert_eq!(image[16..24], [0, 0, 0, COLUMNS as u8, 0, 0, 0, ROWS as u8]);
    // What was asked is written, and asks the same again.
    let again = folder.json(&["decompose", "out/scenario.toml"]);
    assert_eq!((&again["found"], &again["vision"]), (&found["found"], &found["vision"]));
    let said = folder.run(&["decompose", "a.toml"]).stdout;
    assert!(said.contains("neighbours (Potts): each of four adds 1.00"), "{said}");
    assert!(said.contains("were it and the prior certain"), "{said}");
    let sgd = SCENARIO.replace("\"potts\"\ntemperature_step = \"500 mK\"", "\"tex-sgd\"");
    folder.file("b.toml", &sgd);
    let said = folder.run(&["decompose", "b.toml"]).stdout;
    assert!(said.contains("pulled to the median of 3 x 3 pixels, p = 0.100"), "{said}");
}

/// With a sky named its light alone is written, V S_sky where the ground is black, and makes the picture bright if asked.
#[test]
fn the_light_of_the_sky_is_distilled() {
    let folder = with(&SCENARIO.replace("hues =", "sky = 0\nbrightness = \"distilled\"\nhues ="));
    let found = folder.json(&["decompose", "a.toml", "--out", "out"]);
    let from_sky = 20.0 * (0..BANDS).map(sky).sum::<f64>();
    let [texture, sigma] =
        ["distilled_texture.npy", "distilled_texture_sigma.npy"].map(|name| map(&folder, name));
    for i in (0..ROWS * COLUMNS).filter(|i| *i != HOLE) {
        let expected = truth(i).2 * from_sky;
        assert!((texture[i] / expected - 1.0).abs() < 1e-3, "{i}: {} {expected}", texture[i]);
        assert!(sigma[i] > 0.0 && sigma[i] < 0.2 * expected, "{i}: {}", sigma[i]);
    }
    assert!(texture[HOLE].is_nan() && sigma[HOLE].is_nan());
    let of_sky = &found["vision"]["distilled"];
    assert!(
        of_sky["medians"][1].as_f64().unwrap() > 0.0 && of_sky["residues"].as_array().unwrap().len() == 3
    );
    let again = folder.json(&["decompose", "out/scenario.toml"]);
    assert_eq!(
        (&again["scenario"]["vision"], of_sky),
        (&found["scenario"]["vision"], &again["vision"]["distilled"])
    );
    assert_eq!(found["scenario"]["vision"]["brightness"], "distilled");
    let said = folder.run(&["decompose", "a.toml"]).stdout;
    assert!(said.contains("Texture of the sky's light (distilled_texture.npy)"), "{said}");
    // The same texture as without its use for the picture, whose brightness it changes.
    let bright = std::fs::read(folder.path().join("out/tex_vision_image.png")).unwrap();
    folder.file("b.toml", &SCENARIO.replace("hues =", "sky = 0\nhues ="));
    folder.json(&["decompose", "b.toml", "--out", "out"]);
    assert_eq!(map(&folder, "distilled_texture.npy")[0], texture[0]);
    assert_ne!(std::fs::read(folder.path().join("out/tex_vision_image.png")).unwrap(), bright);
}

#[test]
fn mistakes_about_the_image_are_one_line_with_what_to_write() {
    let folder = with(SCENARIO);
    for (from, to, message) in [
        ("\"potts\"", "\"pots\"", "spatial.prior"),
        ("\"potts\"", "\"tex-sgd\"", "a step of temperatures beside a prior that has none"),
        ("prior = \"potts\"", "prior = \"potts\"\nweight = 11", "spatial.weight"),
        ("prior = \"potts\"\n", "", "the key is missing; write prior = \"potts\""),
        (
            "\"Wall Paint\" = 30",
            "\"Wal Paint\" = 30",
            "there is no material `Wal Paint`; did you mean `Wall Paint`?",
        ),
        ("= 30 }", "= 400 }", "vision.hues"),
        (
            "hues =",
            "sky = 2\nhues =",
            "vision.sky: environment 2 as the sky, of 2; count the [[environment]] tables from 0",
        ),
        ("hues =", "sky = 0.5\nhues =", "vision.sky"),
        ("hues =", "brightness = \"distilled\"\nhues =", "a distilled texture without a sky; write sky = 0"),
        (
            "[\"10 degC\", \"40 degC\"]",
            "[\"10 degC\", \"10 degC\"]",
            "the two ends of the range are the same",
        ),
        (
            "\"library.csv\"\n[unknown]",
            "\"library.csv\"\nemissivity_error = 0.01\n[unknown]",
            "its cost knows no errors of the library",
        ),
    ] {
        let mut scenario = SCENARIO.replace(from, to);
        if message.starts_with("its cost") {
            scenario = scenario.replace("\"potts\"\ntemperature_step = \"500 mK\"", "\"tex-sgd\"");
        }
        folder.file("a.toml", &scenario);
        let outcome = folder.run(&["decompose", "a.toml"]);
        assert_eq!(outcome.code, 1, "{message}: {}", outcome.stdout);
        assert!(
            outcome.stderr.contains(message) && outcome.stderr.trim().lines().count() == 1,
            "{message}: {}",
            outcome.stderr
        );
    }
}
