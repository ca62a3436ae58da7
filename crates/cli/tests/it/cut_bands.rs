//! Cubes that lack bands, and bands that are bad: what is left out of a cube in one way or another leaves the same answer.

use crate::support::folder::Folder;
use crate::{calibrate_blackbodies, decompose, library};
use hadar::cube::{Cube, Shape};
use hadar_formats::cube::write_npy;
use hadar_simulate::draws::generator;
use rand::RngExt;
use std::fs;

const BANDS: usize = 21;

fn samples(folder: &Folder, name: &str) -> (Shape, Vec<f64>) {
    let cube = hadar_formats::cube::open(&folder.path().join(name), None).unwrap();
    let shape = cube.shape();
    let Cube::F64(cube) = cube else { panic!("f64") };
    (shape, cube.read(0..shape.rows(), &mut Vec::new()).unwrap().to_vec())
}

/// `counts.npy` as an ENVI file of falling wavenumber without the bands `cut` (in rising wavenumber), centres off theirs by up to a fifth of the step.
fn envi(folder: &Folder, name: &str, cut: &[usize]) {
    let (shape, counts) = samples(folder, "counts.npy");
    let kept: Vec<usize> = (0..BANDS).rev().filter(|band| !cut.contains(band)).collect();
    let centre = |band: &usize| 800.0 + 20.0 * *band as f64 + 4.0 * (*band as f64).sin();
    let lambda: Vec<String> = kept.iter().map(|band| (1e4 / centre(band)).to_string()).collect();
    let header = format!(
        "ENVI\nsamples = {}\nlines = {}\nbands = {}\ndata type = 5\ninterleave = bsq\nbyte order = 0\n\
         wavelength units = Micrometers\nwavelength = {{{}}}\n",
        shape.columns(),
        shape.rows(),
        kept.len(),
        lambda.join(", ")
    );
    folder.file(&format!("{name}.hdr"), &header);
    let pixels = shape.rows() * shape.columns();
    let value = |(band, pixel): (&usize, usize)| counts[pixel * BANDS + band].to_le_bytes();
    let data = kept.iter().flat_map(|band| (0..pixels).map(move |pixel| (band, pixel)));
    fs::write(folder.path().join(format!("{name}.img")), data.flat_map(value).collect::<Vec<u8>>()).unwrap();
    // A row for each band of the file, in its order.
    let rows: Vec<String> =
        kept.iter().enumerate().map(|(i, band)| format!("{i},{}", 300.0 + 20.0 * *band as f64)).collect();
    folder.file(&format!("{name}.csv"), &format!("band,electronic_sigma\n{}\n", rows.join("\n")));
}

fn some(random: &mut impl RngExt) -> Vec<usize> {
    let mut cut: Vec<usize> = (0..BANDS).filter(|_| random.random_range(0.0..1.0) < 0.3).collect();
    cut.truncate(BANDS - 8);
    if cut.is_empty() { vec![4] } else { cut }
}

/// Every map and every number of a cube without some bands is that of the whole cube with these bands named, bit by bit.
#[test]
fn a_cube_that_lacks_bands_is_one_with_bad_bands() {
    let mut random = generator(23, 0);
    for round in 0..8 {
        let (command, scenario) = match round % 2 {
            0 => ("decompose", decompose::SCENARIO),
            _ => ("library", library::SCENARIO),
        };
        let folder = if command == "decompose" { decompose::with(scenario) } else { library::with(scenario) };
        let cut = some(&mut random);
        envi(&folder, "whole", &[]);
        envi(&folder, "cut", &cut);
        let of_file: Vec<usize> = cut.iter().map(|band| BANDS - 1 - band).collect();
        // Every other time with noise of its own in each band.
        let asked = |name: &str, more: &str| {
            let noise = if round % 4 < 2 { String::new() } else { format!("noise = \"{name}.csv\"\n") };
            scenario.replace("data = \"counts.npy\"\n", &format!("data = \"{name}.hdr\"\n{noise}{more}"))
        };
        folder.file("whole.toml", &asked("whole", &format!("bad_bands = {of_file:?}\n")));
        folder.file("cut.toml", &asked("cut", ""));
        let whole = folder.json(&[command, "whole.toml", "--out", "whole"]);
        let cut_out = folder.json(&[command, "cut.toml", "--out", "cut"]);
        let named: Vec<usize> = cut_out["bad"]["bands"]
            .as_array()
            .unwrap()
            .iter()
            .map(|bad| {
                assert_eq!(bad["why"], "absent");
                bad["band"].as_u64().unwrap() as usize
            })
            .collect();
        assert_eq!(named, cut, "{command}");
        for key in ["truth", "materials", "clusters", "chi_square_reduced", "model"] {
            assert_eq!(whole[key], cut_out[key], "{command} {key} without {cut:?}");
        }
        let mut maps = 0;
        for file in fs::read_dir(folder.path().join("whole")).unwrap() {
            let name = file.unwrap().file_name().into_string().unwrap();
            if name.ends_with(".npy") {
                let [a, b] = ["whole", "cut"].map(|of| fs::read(folder.path().join(of).join(&name)).unwrap());
                assert!(a == b, "{command} {name} without {cut:?}");
                maps += 1;
            }
        }
        assert!(maps > 3, "{maps}");
        let said = folder.run(&[command, "cut.toml"]).stdout;
        assert!(
            said.contains("of [bands] (from 0, in rising wavenumber) are not in the cube's file"),
            "{said}"
        );
    }
}

#[test]
fn bands_that_are_none_of_those_asked_for_are_refused() {
    let folder = decompose::with(decompose::SCENARIO);
    envi(&folder, "cut", &[3, 4, 11]);
    let says = |from: &str, to: &str, words: &str| {
        let scenario = decompose::SCENARIO.replace("counts.npy", "cut.hdr").replace(from, to);
        folder.file("a.toml", &scenario);
        let line = folder.refusal(&["decompose", "a.toml"]);
        assert!(line.contains(words), "{line}");
    };
    // Band 0 of the file is the one of 1200 cm^-1.
    says(
        "\"1200 cm^-1\"\nstep = \"20 cm^-1\"",
        "\"1180 cm^-1\"\nstep = \"10 cm^-1\"",
        "by its file, but at 1180.00 cm^-1",
    );
    says("step = \"20 cm^-1\"", "step = \"5 cm^-1\"", "by its file, but at");
    // Widths that cannot be told of distances.
    let bands = "[bands]\nstart = \"800 cm^-1\"\nstop = \"1200 cm^-1\"\nstep = \"20 cm^-1\"\n";
    says(bands, "", "or [bands] with start, stop and step");
    // Nothing says which bands of those asked for the file has.
    let (shape, counts) = samples(&folder, "counts.npy");
    let less: Vec<f64> = counts.chunks(BANDS).flat_map(|pixel| pixel[..20].to_vec()).collect();
    let shape = Shape::new(shape.rows(), shape.columns(), 20).unwrap();
    write_npy(&folder.path().join("less.npy"), shape, &less).unwrap();
    says(
        "cut.hdr",
        "less.npy",
        "but [bands] are 21; make [bands] those of the cube, or write into its file where",
    );
}

/// A band that is spoilt in one cube of a calibration is left out of all, and the others come out as without it.
#[test]
fn bad_bands_of_a_spectrometer_are_left_out() {
    let folder = calibrate_blackbodies::spectrometer(calibrate_blackbodies::SPECTROMETER);
    for (name, spoil) in [("cold", 0), ("mild", 1), ("warm", 2), ("scene", 3)] {
        let (shape, mut counts) = samples(&folder, &format!("{name}.npy"));
        let good: Vec<usize> = (0..BANDS).filter(|band| ![2, 5, 6, 9].contains(band)).collect();
        let less: Vec<f64> =
            counts.chunks(BANDS).flat_map(|pixel| good.iter().map(|band| pixel[*band])).collect();
        let fewer = Shape::new(shape.rows(), shape.columns(), good.len()).unwrap();
        write_npy(&folder.path().join(format!("less-{name}.npy")), fewer, &less).unwrap();
        let mean = counts.iter().skip(9).step_by(BANDS).sum::<f64>() / (counts.len() / BANDS) as f64;
        for pixel in counts.chunks_mut(BANDS) {
            match spoil {
                0 => pixel[5] = f64::NAN,
                1 => pixel[6] = 0.0,
                2 => pixel[9] = pixel[9].min(mean) + 1e4,
                _ => pixel[2] = 1e9,
            }
        }
        write_npy(&folder.path().join(format!("{name}.npy")), shape, &counts).unwrap();
    }
    let scenario = calibrate_blackbodies::SPECTROMETER
        .replace("data = \"scene.npy\"", "data = \"scene.npy\"\nbad_bands = [2]");
    folder.file("a.toml", &scenario);
    let found = folder.json(&["calibrate", "blackbody", "a.toml", "--out", "out"]);
    let whys: Vec<(u64, &str)> = found["left_out"]
        .as_array()
        .unwrap()
        .iter()
        .map(|bad| (bad["band"].as_u64().unwrap(), bad["why"].as_str().unwrap()))
        .collect();
    assert_eq!(whys, [(2, "named"), (5, "missing"), (6, "stuck"), (9, "saturated")]);
    let rows: String = (0..BANDS)
        .filter(|band| ![2, 5, 6, 9].contains(band))
        .map(|band| format!("{},20\n", 800.0 + 20.0 * band as f64))
        .collect();
    folder.file("bands.csv", &format!("wavenumber_cm1,width_cm1\n{rows}"));
    let bands = "start = \"800 cm^-1\"\nstop = \"1200 cm^-1\"\nstep = \"20 cm^-1\"";
    let less = ["cold", "mild", "warm", "scene"]
        .iter()
        .fold(calibrate_blackbodies::SPECTROMETER.replace(bands, "rows = \"bands.csv\""), |text, name| {
            text.replace(&format!("\"{name}.npy\""), &format!("\"less-{name}.npy\""))
        });
    folder.file("less.toml", &less);
    let without = folder.json(&["calibrate", "blackbody", "less.toml"]);
    assert_eq!(found["channels"], without["channels"]);
    assert_eq!(found["scene"]["sigma_noise"], without["scene"]["sigma_noise"]);
    assert_eq!(
        (&found["scene"]["shape"]["bands"], &without["scene"]["shape"]["bands"]),
        (&21.into(), &17.into())
    );
    // The radiances, and their noise without rows for bands that are left out, are read as they are.
    folder.file("light.csv", "wavenumber_cm1,sky\n700,0\n1300,0\n");
    let emissivities = "wavenumber_cm1,black,grey\n700,0.999,0.8\n1300,0.999,0.9\n";
    folder.file("library.csv", emissivities);
    folder.file(
        "d.toml",
        &format!(
            "[cube]\ndata = \"out/radiance.npy\"\nunit = \"W m^-2 sr^-1 per cm^-1\"\nnoise = \"out/sigma.csv\"\n[bands]\n{bands}\n\
             [[environment]]\ntemperature = \"20 degC\"\n[library]\npath = \"library.csv\"\n[unknown]\ntemperature = [\"250 K\", \"340 K\"]\n"
        ),
    );
    let taken_apart = folder.json(&["decompose", "d.toml"]);
    let bad = &taken_apart["bad"]["bands"];
    assert_eq!(bad.as_array().unwrap().len(), 4, "{bad}");
    assert!(bad.as_array().unwrap().iter().all(|bad| bad["why"] == "missing"), "{bad}");
    // A band that has readings and no noise.
    let sigma = fs::read_to_string(folder.path().join("out/sigma.csv")).unwrap();
    let fewer: Vec<&str> = sigma.lines().filter(|line| !line.starts_with("7,")).collect();
    folder.file("out/sigma.csv", &fewer.join("\n"));
    let line = folder.refusal(&["decompose", "d.toml"]);
    assert!(line.contains("no row for band 7"), "{line}");
}

/// A filter that is spoilt before one blackbody is left out, and the response is that of the others.
#[test]
fn bad_filters_are_left_out() {
    let scenario = calibrate_blackbodies::WHEEL;
    let (folder, _) = calibrate_blackbodies::wheel(scenario);
    let names = ["bb0", "bb1", "bb2", "bb3", "scene"];
    for name in names {
        let (shape, mut counts) = samples(&folder, &format!("{name}.npy"));
        let less: Vec<f64> =
            counts.chunks(10).flat_map(|pixel| [&pixel[..3], &pixel[4..8], &pixel[9..]].concat()).collect();
        let fewer = Shape::new(shape.rows(), shape.columns(), 8).unwrap();
        write_npy(&folder.path().join(format!("less-{name}.npy")), fewer, &less).unwrap();
        if name == "bb2" {
            counts.chunks_mut(10).for_each(|pixel| pixel[3] = f64::NAN);
        }
        write_npy(&folder.path().join(format!("{name}.npy")), shape, &counts).unwrap();
    }
    folder.file("a.toml", &scenario.replacen("data = \"bb1.npy\"", "data = \"bb1.npy\"\nbad_bands = [8]", 1));
    let found = folder.json(&["calibrate", "response", "a.toml", "--out", "out"]);
    let left_out = &found["left_out"];
    assert_eq!(
        (&left_out[0]["filter"], &left_out[0]["why"]),
        (&"f3".into(), &"missing".into()),
        "{left_out}"
    );
    assert_eq!((&left_out[1]["filter"], &left_out[1]["why"]), (&"f8".into(), &"named".into()), "{left_out}");
    let text = folder.run(&["calibrate", "response", "a.toml"]).stdout;
    assert!(text.contains("filters f3 are missing before a blackbody"), "{text}");
    folder
        .file("a.toml", &scenario.replacen("data = \"bb1.npy\"", "data = \"bb1.npy\"\nbad_bands = [10]", 1));
    let line = folder.refusal(&["calibrate", "response", "a.toml"]);
    assert!(line.contains("band 10 of 10") && line.contains("blackbody[1].bad_bands"), "{line}");
    let table = fs::read_to_string(folder.path().join("filters.csv")).unwrap();
    let fewer: Vec<String> = table
        .lines()
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            [&cells[..4], &cells[5..9], &cells[10..]].concat().join(",")
        })
        .collect();
    folder.file("filters.csv", &fewer.join("\n"));
    let less = names.iter().fold(scenario.to_owned(), |text, name| {
        text.replace(&format!("\"{name}.npy\""), &format!("\"less-{name}.npy\""))
    });
    folder.file("less.toml", &less);
    let without = folder.json(&["calibrate", "response", "less.toml"]);
    for key in ["response", "scene", "offsets", "filters"] {
        assert_eq!(found[key], without[key], "{key}");
    }
}
