//! Pictures with bad pixels and with depths that are not known: what is left out is named and counted, and no 'yes' rests on it.

use crate::air_ranging::WALL;
use crate::range::{CUBE, SCENE};
use crate::support::folder::Folder;
use hadar::cube::Shape;
use hadar::random::generator;
use hadar_formats::cube::write_npy;
use rand::RngExt;
use serde_json::Value;

/// A name, and what is done to the samples of a pixel.
type Kind<'a> = (&'a str, &'a dyn Fn(&mut [f64]));

const ROWS: usize = 40;
const COLUMNS: usize = 60;
const BANDS: usize = 6;
const HALF: [usize; 2] = [2, 3];

/// A wall whose texture is the noise of averages of many frames, so little that no window reaches the demand.
fn wall(contrast: f64) -> Vec<f64> {
    let mut random = generator(42, 0);
    let of = |i: usize| {
        let normal = (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
        (4000.0 + 200.0 * (i % BANDS) as f64) * (1.0 + contrast * normal)
    };
    (0..ROWS * COLUMNS * BANDS).map(of).collect()
}

/// Spoils every fiftieth pixel or so, by places that do not repeat from row to row.
fn spoilt(mut samples: Vec<f64>, of: &dyn Fn(&mut [f64])) -> Vec<f64> {
    for pixel in samples.chunks_mut(BANDS).skip(17).step_by(53) {
        of(pixel);
    }
    samples
}

fn put(folder: &Folder, samples: &[f64]) {
    write_npy(&folder.path().join("left.npy"), Shape::new(ROWS, COLUMNS, BANDS).unwrap(), samples).unwrap();
}

fn asked(samples: &[f64]) -> Folder {
    let folder = Folder::with(&CUBE.replace("0.05", "0.02"));
    put(&folder, samples);
    folder
}

fn map(folder: &Folder, out: &str) -> Vec<f64> {
    let path = folder.path().join(format!("{out}/disparity_error_px_heat_cube.npy"));
    let hadar::cube::Cube::F64(map) = hadar_formats::cube::open(&path, None).unwrap() else { panic!("f64") };
    map.read(0..ROWS - 2 * HALF[0], &mut Vec::new()).unwrap().to_vec()
}

/// Two in a hundred pixels that are dead, stuck, hot in one band, cold in one band: a flat wall has no depth with them either.
#[test]
fn bad_pixels_are_no_texture() {
    let good = wall(1e-4);
    let folder = asked(&good);
    assert_eq!(folder.json(&["range", "a.toml"])["verdict"]["met"], false);
    let kinds: [Kind<'_>; 4] = [
        ("dead", &|pixel| pixel.fill(0.0)),
        ("stuck", &|pixel| pixel.fill(16_383.0)),
        ("outlier", &|pixel| pixel[2] *= 1.5),
        ("outlier", &|pixel| pixel[1] *= 0.5),
    ];
    for (why, spoils) in kinds {
        put(&folder, &spoilt(good.clone(), spoils));
        let found = folder.json(&["range", "a.toml", "--out", "out", "--force"]);
        let bad = &found["bad"][0];
        assert_eq!((&bad["view"], &bad["pixels"][0]["why"]), (&"left".into(), &why.into()), "{found:#}");
        assert_eq!(bad["pixels"][0]["pixels"], 45);
        assert!(folder.path().join("out/bad_pixels_left.npy").exists());
        let verdict = &found["verdict"];
        assert_ne!(verdict["met"], true, "{why}: {verdict}");
        assert_eq!(verdict["share"].as_f64(), Some(0.0), "{why}: {verdict}");
        let [judged, all] = ["windows", "windows_of"].map(|key| verdict[key].as_u64().unwrap());
        assert_eq!(all as usize, (ROWS - 4) * (COLUMNS - 6));
        assert_eq!(judged + found["missing_windows"].as_u64().unwrap(), all);
        let said = verdict["sentence"].as_str().unwrap();
        assert!(said.contains(&format!("{judged} of {all} windows were judged")), "{said}");
        if why != "dead" {
            let kept = folder.json(&["range", "a.toml", "--bad", "keep"]);
            assert!(kept["verdict"]["share"].as_f64().unwrap() > 0.3, "{why}: {}", kept["verdict"]);
            assert!(kept.get("bad").is_none());
        }
    }
}

/// Whatever is put into one pixel: windows without it keep their bits, and no becomes no yes, at the very edge of it too.
#[test]
fn one_spoilt_pixel_costs_its_own_windows() {
    let good = wall(3e-3);
    let folder = asked(&good);
    let before = folder.json(&["range", "a.toml", "--out", "before"]);
    let errors = map(&folder, "before");
    let mut sorted = errors.clone();
    sorted.sort_by(f64::total_cmp);
    // A demand that one window too few reaches.
    let edge = sorted[sorted.len() / 2 - 2].midpoint(sorted[sorted.len() / 2 - 1]);
    let metres = before["geometry"]["depth_error_per_px_at_10_m"].as_f64().unwrap() * edge;
    let demand = format!("requirement.depth_error=\"{metres} m\"");
    folder.file("a.toml", &CUBE.replace("relative_depth_error = 0.05\n", ""));
    let verdict =
        |folder: &Folder| -> Value { folder.json(&["range", "a.toml", "--set", &demand])["verdict"].clone() };
    assert_eq!(verdict(&folder)["met"], false);
    let values = [0.0, f64::NAN, 1e36, 65_535.0, -1.0];
    for (case, (row, column)) in [(0, 0), (7, 31), (20, 59), (39, 30), (18, 18)].into_iter().enumerate() {
        let mut samples = good.clone();
        let at = (row * COLUMNS + column) * BANDS;
        let bands = if case % 2 == 0 { BANDS } else { 1 };
        samples[at..at + bands].fill(values[case]);
        put(&folder, &samples);
        assert_ne!(verdict(&folder)["met"], true);
        let out = format!("after{case}");
        folder.json(&["range", "a.toml", "--out", &out]);
        for (i, (before, after)) in errors.iter().zip(map(&folder, &out)).enumerate() {
            let (y, x) = (i / (COLUMNS - 6) + 2, i % (COLUMNS - 6) + 3);
            let holds = y.abs_diff(row) <= HALF[0] && x.abs_diff(column) <= HALF[1];
            let same = if holds { after.is_nan() } else { before.to_bits() == after.to_bits() };
            assert!(same, "{case}: row {y}, column {x}: {before} {after}");
        }
    }
}

/// A map of depths that is empty but for 3 % does not say yes of the picture.
#[test]
fn no_yes_rests_on_a_few_windows() {
    let folder = asked(&wall(0.2));
    assert_eq!(folder.json(&["range", "a.toml"])["verdict"]["met"], true);
    folder.file("a.toml", &CUBE.replace("\"10 m\"", "\"depth.npy\""));
    let depth = |filled: usize| {
        let map: Vec<f64> = (0..ROWS * COLUMNS).map(|i| if i % 100 < filled { 10.0 } else { 0.0 }).collect();
        write_npy(&folder.path().join("depth.npy"), Shape::new(ROWS, COLUMNS, 1).unwrap(), &map).unwrap();
        folder.json(&["range", "a.toml"])
    };
    let found = depth(3);
    let verdict = &found["verdict"];
    assert!(verdict["met"].is_null() && verdict["share"].as_f64().unwrap() < 0.05, "{verdict}");
    assert!(verdict["sentence"].as_str().unwrap().starts_with("Undecided: "), "{verdict}");
    assert!(found["solve_for"].is_null(), "no camera makes up for depths that are not known");
    assert_eq!(folder.run(&["range", "a.toml", "--check"]).code, 3);
    let most = depth(80);
    assert_eq!(most["verdict"]["met"], true);
    let said = most["verdict"]["sentence"].as_str().unwrap();
    assert!(
        said.contains(" of all 1944 windows at best") && said.contains("count as not reaching it"),
        "{said}"
    );
}

/// Where there is no cube the flag means nothing, and says so; of a cube it is what the key is.
#[test]
fn a_flag_of_bad_pixels_without_a_cube_is_refused() {
    for (text, words) in [(SCENE, "the views are rendered"), (WALL, "ranging by air reads no cube")] {
        let folder = Folder::with(text);
        for bad in ["keep", "leave-out"] {
            let refused = folder.refusal(&["range", "a.toml", "--bad", bad]);
            assert!(refused.contains("--bad") && refused.contains(words), "{refused}");
        }
    }
    let folder = asked(&spoilt(wall(1e-4), &|pixel| pixel[0] *= 1.5));
    let [mut by_flag, mut by_key] = [
        (CUBE.to_owned(), &["--bad", "keep"][..]),
        (CUBE.replace("depth =", "bad = \"keep\"\ndepth ="), &[]),
    ]
    .map(|(text, flags)| {
        folder.file("a.toml", &text);
        folder.json(&[&["range", "a.toml"][..], flags].concat())
    });
    for answer in [&mut by_flag, &mut by_key] {
        answer.as_object_mut().unwrap().remove("stats");
    }
    assert_eq!(by_flag, by_key);
}
