//! `[[category]]` in `hadar decompose` and `hadar render`: categories and objects, and mistakes.

use crate::support::folder::Folder;
use hadar::cube::Shape;
use hadar::planck::photon_radiance;
use hadar_formats::cube::{npy_map, write_npy};
use std::fs;

const SCENARIO: &str = r#"[cube]
data = "counts.npy"
counts_per_photon_radiance = 1e-13
[bands]
start = "800 cm^-1"
stop = "1200 cm^-1"
step = "20 cm^-1"
[[environment]]
temperature = "-10 degC"
[library]
path = "library.csv"
[unknown]
temperature = ["250 K", "340 K"]
lighting_total = 1.0
[[category]]
name = "house"
materials = ["brick", "pane"]
enclosed = ["pane"]
labels = [7, 9]
[[category]]
name = "lamp"
materials = ["pane"]
labels = [3]
[segmentation]
smoothing = false
smallest_object = 2
[truth]
category = "labels.npy"
"#;

const BANDS: usize = 21;
/// b brick, p pane, x neither: its sample is missing.
const PICTURE: [&str; 5] = [
    "bbbbbxx", //
    "bppbbxp", "bppbbxp", "bbbbbxp", "bbbbbxx",
];

fn emissivity(material: usize, nu: f64) -> f64 {
    [0.9 + 0.05 * (nu / 30.0).sin(), 0.5 + 0.3 * (-((nu - 1000.0) / 50.0).powi(2)).exp()][material]
}

fn with(scenario: &str) -> Folder {
    let folder = Folder::with(scenario);
    let nodes: Vec<f64> = (0..BANDS).map(|w| 800.0 + 20.0 * w as f64).collect();
    let rows = nodes.iter().map(|nu| format!("\n{nu},{},{}", emissivity(0, *nu), emissivity(1, *nu)));
    folder.file("library.csv", &format!("wavenumber_cm1,brick,pane{}", rows.collect::<String>()));
    let letters: Vec<u8> = PICTURE.concat().into_bytes();
    let mut counts = Vec::new();
    for (i, letter) in letters.iter().enumerate() {
        let material = usize::from(*letter == b'p');
        let kelvin = 285.0 + 0.1 * i as f64;
        counts.extend(nodes.iter().map(|nu| {
            let e = emissivity(material, *nu);
            let signal = e * photon_radiance(*nu, kelvin) + (1.0 - e) * photon_radiance(*nu, 263.15);
            if *letter == b'x' { f64::NAN } else { 1e-13 * signal }
        }));
    }
    let (rows, columns) = (PICTURE.len(), PICTURE[0].len());
    write_npy(&folder.path().join("counts.npy"), Shape::new(rows, columns, BANDS).unwrap(), &counts).unwrap();
    // Bricks and the pane in them are the house by two labels, what stands alone is the lamp, 200 is none.
    let label = |i: usize| match (letters[i], i % columns) {
        (b'b', _) => 7_u8,
        (b'p', 6) => 3,
        (b'p', _) => 9,
        _ => 200,
    };
    let labels: Vec<u8> = (0..letters.len()).map(label).collect();
    fs::write(folder.path().join("labels.npy"), npy_map(&[rows, columns], &labels).unwrap()).unwrap();
    folder
}

#[test]
fn a_pane_in_the_wall_is_the_house_and_one_beside_what_is_missing_is_open() {
    let folder = with(SCENARIO);
    let found = folder.json(&["decompose", "a.toml", "--out", "out"]);
    let segmentation = &found["segmentation"];
    assert_eq!(segmentation["rule"], "regions");
    let counts = |key: &str| [0, 1].map(|i: usize| segmentation["categories"][i][key].as_u64().unwrap());
    assert_eq!((counts("pixels"), counts("objects")), ([25, 0], [1, 0]));
    // The panes in the wall are no less panes for being the house's: only their neighbours say it.
    assert_eq!(counts("decided"), [21, 0]);
    assert_eq!((&segmentation["none"], &segmentation["undecided"]), (&0.into(), &10.into()));
    let lamp = &segmentation["objects"][1];
    assert_eq!(
        (lamp["category"].as_str(), &lamp["rows"], &lamp["columns"]),
        (Some("house or lamp"), &serde_json::json!([1, 4]), &serde_json::json!([6, 7]))
    );
    let half = |name: &str| serde_json::json!({ "category": name, "probability": 0.5 });
    assert_eq!(lamp["possible"], serde_json::json!([half("house"), half("lamp")]));
    // The middle one of its three pixels, which stand a row apart.
    assert!((lamp["temperature_median_k"].as_f64().unwrap() - 287.0).abs() < 1e-3, "{lamp}");
    // What is undecided is not right; that it is the lamp is only the likeliest.
    let agreement = &segmentation["agreement"];
    assert_eq!((&agreement["mean_iou"], &agreement["pixels"]), (&0.5.into(), &35.into()));
    assert_eq!(
        (&agreement["right"], &agreement["undecided"]),
        (&(25.0 / 35.0).into(), &(10.0 / 35.0).into())
    );
    assert_eq!(segmentation["agreement_of_likeliest"]["mean_iou"], 1.0);
    assert!(segmentation["agreement_by_brightness"]["mean_iou"].as_f64().unwrap() <= 1.0);
    let likeliest = fs::read(folder.path().join("out/likeliest_category.npy")).unwrap();
    assert_eq!(&likeliest[128 + 7..128 + 14], [0, 0, 0, 0, 0, 255, 1]);
    let map = fs::read(folder.path().join("out/segmentation.npy")).unwrap();
    assert_eq!(&map[128 + 7..128 + 14], [0, 0, 0, 0, 0, 255, 255]);
    assert_eq!(&map[128..135], [0, 0, 0, 0, 0, 255, 255]);
    for name in ["segmentation.png", "segmentation.csv", "categories.csv", "objects.csv"] {
        assert!(folder.path().join("out").join(name).exists(), "{name}");
    }
    // The scenario that was written asks the same again.
    let again = folder.json(&["decompose", "out/scenario.toml"]);
    assert_eq!(again["segmentation"]["objects"], segmentation["objects"]);
    let text = folder.run(&["decompose", "a.toml"]).stdout;
    assert!(text.contains("mIoU 1.00") || text.contains("mIoU 1,"), "{text}");
}

#[test]
fn the_papers_rule_can_be_asked_for() {
    let folder = with(&SCENARIO.replace("smoothing = false", "rule = \"raster\"\nsmoothing = false"));
    let found = folder.json(&["decompose", "a.toml"]);
    assert_eq!(found["segmentation"]["rule"], "raster");
    assert_eq!(found["segmentation"]["categories"][0]["pixels"], 25);
}

#[test]
fn what_is_wrong_is_said_with_its_line() {
    for (from, to, says) in [
        ("[\"brick\", \"pane\"]", "[]", "category[0].materials: the category `house` has no materials"),
        (
            "[\"brick\", \"pane\"]",
            "[\"brick\", \"pan\"]",
            "category[0].enclosed[0]: `pane` is none of the materials of `house`",
        ),
        ("materials = [\"pane\"]\n", "materials = [\"pan\"]\n", "category[1].materials[0]: "),
        ("name = \"lamp\"", "name = \"house\"", "category[1].name: `house` is a category twice"),
        ("labels = [3]", "labels = [9]", "category[1].labels: 9 stands for two categories"),
        ("labels = [3]\n", "", "category[1]: no labels"),
        ("labels = [3]", "labels = [3.5]", "category[1].labels[0]: "),
        ("smallest_object = 2", "smallest_object = 0", "segmentation.smallest_object: "),
        ("enclosed = [\"pane\"]", "safety = 1", "category[0].safety: "),
        ("name = \"lamp\"", "name = \"undecided\"", "category[1].name: `undecided`, which says"),
        ("smoothing = false", "rule = \"best\"", "segmentation.rule: "),
        ("enclosed = [\"pane\"]", "surfaces = [\"wall\"]", "category[0]: there is no key `surfaces`"),
    ] {
        assert!(SCENARIO.contains(from), "{from}");
        let folder = with(&SCENARIO.replacen(from, to, 1));
        let refused = folder.run(&["decompose", "a.toml"]);
        assert_eq!(refused.code, 1, "{to}");
        assert!(
            refused.stderr.contains(says) && refused.stderr.lines().count() == 1,
            "{to}: {}",
            refused.stderr
        );
    }
    let start = SCENARIO.find("[[category]]").unwrap();
    let end = SCENARIO.find("[segmentation]").unwrap();
    let folder = with(&format!("{}{}", &SCENARIO[..start], &SCENARIO[end..]));
    let refused = folder.run(&["decompose", "a.toml"]);
    assert!(refused.stderr.contains("segmentation: no category to find"), "{}", refused.stderr);
    let refused = with(SCENARIO).run(&["decompose", "a.toml", "--method", "grey-body"]);
    assert!(
        refused.stderr.contains("category: the method grey-body names no materials"),
        "{}",
        refused.stderr
    );
}
