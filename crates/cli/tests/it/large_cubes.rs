//! Cubes whose pixels are too many to be kept: what memory the program takes, where the system can limit it (Linux).

use crate::decompose;
use crate::support::folder::Folder;
use hadar::cube::{Cube, Shape};
use hadar_formats::cube::write_npy;
use std::fs::OpenOptions;
use std::process::Command;

const ROWS: usize = 1500;
const COLUMNS: usize = 1500;
const BANDS: usize = 128;

const SCENARIO: &str = "[cube]\nleft = \"left.npy\"\ndepth = \"10 m\"\nnoise_variance = 50.0\n\
                        [stereo]\nbaseline = \"0.2 m\"\nfocal_length = \"14 mm\"\npixel = \"12 um\"\n\
                        [requirement]\nrelative_depth_error = 0.05\n";

/// kB of address space: the pixels alone would take 700 MB if they were kept, the file has 1.15 GB.
const LIMIT_KB: usize = 560_000;

/// A file of zeros that takes no room: a header and so many bytes.
fn sparse(folder: &Folder, name: &str, [rows, columns, bands]: [usize; 3]) {
    let text = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({rows}, {columns}, {bands}), }}");
    let header = [b"\x93NUMPY\x01\x00\x76\x00".as_slice(), format!("{text:<117}\n").as_bytes()].concat();
    assert_eq!(header.len(), 128);
    let path = folder.path().join(name);
    std::fs::write(&path, header).unwrap();
    let file = OpenOptions::new().write(true).open(path).unwrap();
    file.set_len((128 + rows * columns * bands * 4) as u64).unwrap();
}

/// The answer of a command that may not take more address space than so many kB.
fn limited(folder: &Folder, command: &str) -> serde_json::Value {
    let program = assert_cmd::cargo::cargo_bin!("hadar").display().to_string();
    let limited =
        format!("ulimit -v {LIMIT_KB}; exec '{program}' {command} a.toml --threads 2 --out out --json");
    let output = Command::new("sh")
        .args(["-c", &limited])
        .current_dir(folder.path())
        // Each thread's own share of the address space is not what is limited here.
        .env("MALLOC_ARENA_MAX", "1")
        .output()
        .unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{error}");
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn a_cube_is_ranged_in_less_memory_than_its_pixels_would_take() {
    if cfg!(debug_assertions) || !cfg!(target_os = "linux") {
        println!("skipped: only with optimisation, on Linux");
        return;
    }
    let folder = Folder::with(SCENARIO);
    sparse(&folder, "left.npy", [ROWS, COLUMNS, BANDS]);
    let result = limited(&folder, "range");
    let all = &result["objects"][0];
    assert_eq!(all["windows"], (ROWS - 4) * (COLUMNS - 6));
    // Without texture nothing tells the distance, and 0 is exact.
    assert_eq!(all["signals"][1]["information_per_px2"], 0.0);
    assert_eq!(all["signals"][1]["share"], 0.0);
    assert!(result["quantile_error"].as_f64().is_some_and(|error| error < 1e-4));
    let map =
        hadar_formats::cube::open(&folder.path().join("out/disparity_error_px_heat_cube.npy"), None).unwrap();
    assert_eq!((map.shape().rows(), map.shape().columns()), (ROWS - 4, COLUMNS - 6));
    let Cube::F64(rows) = &map else { panic!("no doubles") };
    let mut buffer = Vec::new();
    for row in [0, ROWS / 2, ROWS - 5] {
        assert!(rows.read(row..row + 1, &mut buffer).unwrap().iter().all(|px| px.is_infinite()));
    }
    let left = std::fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(left, 3, "nothing is left beside the report");
}

/// Maps in memory would take 860 MB with their report.
#[test]
fn a_cube_is_decomposed_in_less_memory_than_its_maps_would_take() {
    const SIDE: usize = 2200;
    if cfg!(debug_assertions) || !cfg!(target_os = "linux") {
        println!("skipped: only with optimisation, on Linux");
        return;
    }
    let folder = decompose::with(decompose::SCENARIO.split("[truth]").next().unwrap());
    let before = std::fs::read_dir(folder.path()).unwrap().count();
    sparse(&folder, "counts.npy", [SIDE, SIDE, decompose::BANDS]);
    let result = limited(&folder, "decompose");
    assert_eq!(result["pixels"], SIDE * SIDE);
    let map = hadar_formats::cube::open(&folder.path().join("out/temperature_k.npy"), None).unwrap();
    assert_eq!((map.shape().rows(), map.shape().columns()), (SIDE, SIDE));
    let left = std::fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(left, before + 1, "nothing is left beside the report");
}

/// A cube whose windows are kept has no error of its medians to state.
#[test]
fn medians_of_a_small_cube_are_exact() {
    let folder = Folder::with(SCENARIO);
    let shape = Shape::new(60, 40, 3).unwrap();
    let samples: Vec<f32> = (0..shape.len()).map(|i| 1e3 + (i * i % 977) as f32).collect();
    write_npy(&folder.path().join("left.npy"), shape, &samples).unwrap();
    let small = folder.json(&["range", "a.toml"]);
    assert!(small.get("quantile_error").is_none(), "a small cube is exact");
}
