//! Cubes of several formats and orders as their user has them: one scene comes out the same of all.

use crate::decompose::{SCENARIO, with};
use crate::support::folder::Folder;
use hadar::cube::{Cube, Shape};
use hadar_formats::cube::write_npy;
use std::fs;

const BANDS: &str = "[bands]\nstart = \"800 cm^-1\"\nstop = \"1200 cm^-1\"\nstep = \"20 cm^-1\"\n";

/// The counts of the scene, `[pixel][band]` of 2 x 3 pixels and 21 bands.
fn counts(folder: &Folder) -> Vec<f64> {
    let Cube::F64(cube) = hadar_formats::cube::open(&folder.path().join("counts.npy"), None).unwrap() else {
        panic!("f64")
    };
    cube.read(0..2, &mut Vec::new()).unwrap().to_vec()
}

/// An ENVI file of rising wavelength, which is falling wavenumber, `[band][row][column]`.
fn envi(folder: &Folder, more: &str, change: impl Fn(usize, usize, f64) -> f64) {
    let counts = counts(folder);
    let lambda: Vec<String> =
        (0..21).rev().map(|band| (1e4 / (800.0 + 20.0 * f64::from(band))).to_string()).collect();
    let header = format!(
        "ENVI\nsamples = 3\nlines = 2\nbands = 21\ndata type = 5\ninterleave = bsq\nbyte order = 1\n\
         wavelength units = Micrometers\nwavelength = {{{}}}\n{more}",
        lambda.join(", ")
    );
    folder.file("scene.hdr", &header);
    let value = |band: usize, pixel: usize| change(band, pixel, counts[pixel * 21 + 20 - band]);
    let data: Vec<u8> = (0..21)
        .flat_map(|band| (0..6).flat_map(move |pixel| [(band, pixel)]))
        .flat_map(|(b, p)| value(b, p).to_be_bytes())
        .collect();
    fs::write(folder.path().join("scene.img"), data).unwrap();
}

fn rmse(found: &serde_json::Value) -> f64 {
    assert_eq!(found["truth"]["right_material"].as_f64(), Some(1.0), "{found}");
    found["truth"]["temperature_rmse_k"].as_f64().unwrap()
}

#[test]
fn an_envi_file_says_its_bands_in_any_order() {
    let own = SCENARIO.replace("counts.npy", "scene.hdr").replace(BANDS, "");
    let folder = with(&own);
    envi(&folder, "", |_, _, count| count);
    let found = folder.json(&["decompose", "a.toml", "--out", "out"]);
    assert!(rmse(&found) < 1e-4);
    assert_eq!((&found["read"]["format"], &found["read"]["stored"]), (&"ENVI BSQ".into(), &"f64".into()));
    // The scenario that was written means the same.
    assert!(rmse(&folder.json(&["decompose", "out/scenario.toml"])) < 1e-4);
    // With [bands] too, by header or by data; the text says what was read.
    folder.file("b.toml", &SCENARIO.replace("counts.npy", "scene.img"));
    assert!(rmse(&folder.json(&["decompose", "b.toml"])) < 1e-4);
    let said = folder.run(&["decompose", "b.toml"]).stdout;
    assert!(said.contains("\nCube: 2 rows x 3 columns x 21 bands, f64, scene.img (ENVI BSQ)\n"), "{said}");
    // Bands that are not those of the file are refused, and a file that says none needs them.
    folder.file(
        "c.toml",
        &SCENARIO
            .replace("counts.npy", "scene.img")
            .replace("800 cm", "840 cm")
            .replace("1200 cm", "1240 cm"),
    );
    let refused = folder.refusal(&["decompose", "c.toml"]);
    assert!(
        refused.contains(
            "band 20 of the cube is at 800.000 cm^-1 by its file, but at 840.000 cm^-1 in [bands]; leave"
        ),
        "{refused}"
    );
    folder.file("d.toml", &SCENARIO.replace(BANDS, ""));
    let refused = folder.refusal(&["decompose", "d.toml"]);
    assert!(
        refused.contains("d.toml: bands: the table is missing, and the cube's file does not say"),
        "{refused}"
    );
}

/// A grid that is off by more than a quarter of a band, wavelengths without a unit, and widths that only distances tell where a band is left out.
#[test]
fn widths_and_units_are_not_guessed() {
    let folder = with(&SCENARIO.replace("counts.npy", "scene.hdr"));
    envi(&folder, "", |_, _, count| count);
    for (start, stop, refused) in [(806, 1206, true), (804, 1204, false)] {
        let own = SCENARIO.replace("counts.npy", "scene.hdr");
        let own =
            own.replace("\"800 cm", &format!("\"{start} cm")).replace("\"1200 cm", &format!("\"{stop} cm"));
        folder.file("b.toml", &own);
        let said = folder.run(&["decompose", "b.toml"]).stderr;
        assert_eq!(said.contains("by its file, but at"), refused, "{start}: {said}");
    }
    let header = fs::read_to_string(folder.path().join("scene.hdr")).unwrap();
    folder.file("scene.hdr", &header.replace("wavelength units = Micrometers\n", ""));
    let found = folder.json(&["decompose", "a.toml"]);
    let codes: Vec<&str> =
        found["warnings"].as_array().unwrap().iter().map(|w| w["code"].as_str().unwrap()).collect();
    assert!(codes.contains(&"wavelengths-unused"), "{codes:?}");
    folder.file("c.toml", &SCENARIO.replace("counts.npy", "scene.hdr").replace(BANDS, ""));
    let refused = folder.refusal(&["decompose", "c.toml"]);
    assert!(refused.contains("lists its wavelengths without a unit"), "{refused}");
    // The tenth band of 21 moved away from its place.
    let moved = format!("{}", 1e4 / 1000.0);
    assert!(header.contains(&moved));
    folder.file("scene.hdr", &header.replace(&format!(" {moved},"), " 10.06,"));
    let refused = folder.refusal(&["decompose", "c.toml"]);
    assert!(refused.contains("which does not say how wide they are; write their widths"), "{refused}");
}

/// What is written without wavelengths is in rising wavenumber, whatever the order of the file was.
#[test]
fn destriped_cubes_are_in_rising_wavenumber() {
    let folder = with(SCENARIO);
    let (rows, columns, bands) = (40, 40, 8);
    let count = |row: usize, column: usize, band: usize| {
        1000.0 * (band + 1) as f64 + ((row * 7919 + column * 104_729 + band * 31) % 1013) as f64 / 50.0
    };
    let lambda: Vec<String> = (0..bands).map(|band| (8.0 + 0.5 * band as f64).to_string()).collect();
    folder.file(
        "a.hdr",
        &format!(
            "ENVI\nsamples = {columns}\nlines = {rows}\nbands = {bands}\ndata type = 5\ninterleave = bip\nbyte order = 0\n\
             wavelength units = Micrometers\nwavelength = {{{}}}\n",
            lambda.join(", ")
        ),
    );
    let places = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    let data: Vec<u8> = places
        .flat_map(|(row, column)| (0..bands).map(move |band| count(row, column, band)))
        .flat_map(f64::to_le_bytes)
        .collect();
    fs::write(folder.path().join("a.img"), data).unwrap();
    folder.json(&["calibrate", "stripes", "a.hdr", "--out", "out"]);
    let first = |path: &str| match hadar_formats::cube::open(&folder.path().join(path), None).unwrap() {
        Cube::F32(cube) => f64::from(cube.read(0..1, &mut Vec::new()).unwrap()[0]),
        Cube::F64(cube) => cube.read(0..1, &mut Vec::new()).unwrap()[0],
    };
    assert!((first("out/destriped.npy") / count(0, 0, bands - 1) - 1.0).abs() < 0.02);
}

/// A band that is bad by the list of the file, or by the scenario in the order of the file, and a pixel that was not measured.
#[test]
fn bad_bands_and_missing_samples_of_a_file_are_left_out() {
    let own = SCENARIO.replace("counts.npy", "scene.hdr").replace(BANDS, "");
    let folder = with(&own.replace("1e-13\n", "1e-13\nbad_bands = [19]\n"));
    let list: Vec<String> = (0..21).map(|band| u8::from(band != 2).to_string()).collect();
    let more = format!("bbl = {{{}}}\ndata ignore value = -1\n", list.join(", "));
    envi(&folder, &more, |band, pixel, count| match (band, pixel) {
        (2 | 19, _) => 7.0 * count,
        (5, 3) => -1.0,
        _ => count,
    });
    let found = folder.json(&["decompose", "a.toml"]);
    assert!(found["truth"]["temperature_rmse_k"].as_f64().unwrap() < 1e-4, "{found}");
    assert_eq!((found["skipped"].as_u64(), found["decided"].as_u64()), (Some(1), Some(5)));
    assert_eq!(found["read"]["bad_bands"], serde_json::json!([2]));
    let said = folder.run(&["decompose", "a.toml"]).stdout;
    assert!(said.contains("scene.hdr (ENVI BSQ; -1 taken as missing; bands 2 bad by its list)"), "{said}");
}

#[test]
fn axes_are_as_the_scenario_says() {
    let folder = with(&SCENARIO.replace("1e-13\n", "1e-13\naxes = \"bands,rows,columns\"\n"));
    let counts = counts(&folder);
    let images: Vec<f64> =
        (0..21).flat_map(|band| (0..6).map(move |pixel| pixel * 21 + band)).map(|i| counts[i]).collect();
    write_npy(&folder.path().join("counts.npy"), Shape::new(21, 2, 3).unwrap(), &images).unwrap();
    let found = folder.json(&["decompose", "a.toml", "--out", "out"]);
    assert!(rmse(&found) < 1e-4);
    assert_eq!(found["read"]["axes"], "bands,rows,columns");
    assert!(rmse(&folder.json(&["decompose", "out/scenario.toml"])) < 1e-4);
    folder.file("a.toml", SCENARIO);
    let refused = folder.refusal(&["decompose", "a.toml"]);
    assert!(
        refused.contains("if these are the bands of its file, write axes = \"bands,rows,columns\""),
        "{refused}"
    );
    // What is said to write holds of the file, whatever was said before.
    folder.file("a.toml", &SCENARIO.replace("1e-13\n", "1e-13\naxes = \"rows,bands,columns\"\n"));
    let refused = folder.refusal(&["decompose", "a.toml"]);
    assert!(refused.contains("write axes = \"bands,rows,columns\""), "{refused}");
    folder.file("a.toml", &SCENARIO.replace("1e-13\n", "1e-13\naxes = \"bands,lines,samples\"\n"));
    let refused = folder.refusal(&["decompose", "a.toml"]);
    assert!(
        refused.contains("a.toml:5: cube.axes: `bands,lines,samples` are no axes of a cube"),
        "{refused}"
    );
}

/// Whatever order a list of bands has, a file that does not say its bands has the same: the answer is that of rising wavenumber.
#[test]
fn a_list_of_bands_is_in_the_order_of_the_file() {
    let folder = with(SCENARIO);
    let counts = counts(&folder);
    let warned = |found: &serde_json::Value| {
        found["warnings"].as_array().unwrap().iter().any(|warning| warning["code"] == "band-order-taken")
    };
    let whole = folder.json(&["decompose", "a.toml"]);
    assert!(!warned(&whole));
    let shape = Shape::new(2, 3, 21).unwrap();
    for step in [1, 20, 2, 5, 13] {
        // A permutation of 21 bands: 20 turns them round.
        let order: Vec<usize> = (0..21).map(|band| (band * step + step / 20 * 20) % 21).collect();
        let of_order: Vec<f64> = (0..6)
            .flat_map(|pixel| order.iter().map(move |band| (pixel, *band)))
            .map(|(p, b)| counts[p * 21 + b])
            .collect();
        write_npy(&folder.path().join("turned.npy"), shape, &of_order).unwrap();
        let rows: String = order.iter().map(|band| format!("{}\n", 800 + 20 * band)).collect();
        folder.file("bands.csv", &format!("wavenumber_cm1\n{rows}"));
        let text =
            SCENARIO.replace("counts.npy", "turned.npy").replace(BANDS, "[bands]\nrows = \"bands.csv\"\n");
        folder.file("b.toml", &text);
        let found = folder.json(&["decompose", "b.toml"]);
        assert_eq!(rmse(&found), rmse(&whole), "{order:?}");
        assert_eq!(warned(&found), step != 1, "{order:?}");
        // Another order of the list is another cube.
        folder.file(
            "bands.csv",
            &format!("wavenumber_cm1\n{}", rows.lines().rev().collect::<Vec<_>>().join("\n")),
        );
        let other = folder.json(&["decompose", "b.toml"]);
        assert!(other["truth"]["temperature_rmse_k"].as_f64().unwrap() > 0.1, "{other}");
    }
}

/// A unit that is off by a thousand is told by the file that has it, not by the spectrum that does not reach there.
#[test]
fn bands_that_nobody_has_are_refused_by_their_file() {
    let folder = with(&SCENARIO.replace("counts.npy", "scene.hdr").replace(BANDS, ""));
    envi(&folder, "", |_, _, count| count);
    let header = fs::read_to_string(folder.path().join("scene.hdr")).unwrap();
    folder.file("scene.hdr", &header.replace("Micrometers", "Nanometers"));
    let refused = folder.refusal(&["decompose", "a.toml"]);
    assert!(
        refused.contains("scene.hdr: bands: band 0 of the cube is at 0.00833 um by its file"),
        "{refused}"
    );
}

/// Bands as wavelengths of a file that says none, and a first axis that may be the bands: nothing is refused, both are said.
#[test]
fn what_cannot_be_known_is_warned_of() {
    let codes = |found: &serde_json::Value| -> Vec<String> {
        let all = found["warnings"].as_array().unwrap().iter();
        all.map(|warning| warning["code"].as_str().unwrap().to_owned()).collect()
    };
    let grid = "[bands]\nstart = \"8.34 um\"\nstop = \"12.34 um\"\nstep = \"0.2 um\"\n";
    let folder = with(&SCENARIO.replace(BANDS, grid));
    assert!(codes(&folder.json(&["decompose", "a.toml"])).contains(&"band-order-taken".to_owned()));
    let mut state = 1_u64;
    let noise = (0..8 * 40 * 40).map(|_| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        1000.0 + (state >> 40) as f32 / 1e6
    });
    write_npy(&folder.path().join("a.npy"), Shape::new(8, 40, 40).unwrap(), &noise.collect::<Vec<f32>>())
        .unwrap();
    let found = folder.json(&["calibrate", "stripes", "a.npy"]);
    assert!(codes(&found).contains(&"axes-in-doubt".to_owned()), "{:?}", codes(&found));
    assert_eq!(found["read"]["rows"].as_u64(), Some(8));
}
