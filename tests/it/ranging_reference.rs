//! Window information against exact fractions.
//!
//! `support/ranging.json`: counts of 7 × 7 × 3 samples, a window of 5 × 5 pixels around (3, 3), the four cells with and
//! without electronic noise, computed in rational arithmetic.

use hadar::cube::{Cube, MemoryCube, Shape};
use hadar::ranging::derivative::Derivative;
use hadar::ranging::information::{Cell, Request, Window, information};
use hadar::ranging::noise::{Joined, NoiseVariance};

struct Reference {
    counts: Vec<f64>,
    cells: Vec<(Cell, f64, f64)>,
}

fn reference() -> Reference {
    let text = include_str!("support/ranging.json");
    let json: serde_json::Value = serde_json::from_str(text).unwrap();
    let rows = json["counts"].as_array().unwrap().iter();
    let pixels = rows.flat_map(|row| row.as_array().unwrap());
    let samples = pixels.flat_map(|pixel| pixel.as_array().unwrap());
    let counts = samples.map(|count| count.as_f64().unwrap()).collect();
    let cell = |entry: &serde_json::Value| match (entry["spatial"].as_u64(), entry["spectral"].as_u64()) {
        (Some(0), Some(0)) => Cell::Total,
        (Some(1), Some(0)) => Cell::Spatial,
        (Some(0), Some(1)) => Cell::Spectral,
        _ => Cell::Full,
    };
    let number = |entry: &serde_json::Value, key: &str| entry[key].as_f64().unwrap();
    let entries = json["fisher"].as_array().unwrap().iter();
    let cells = entries
        .map(|entry| (cell(entry), number(entry, "noise_variance_per_sample"), number(entry, "value")))
        .collect();
    Reference { counts, cells }
}

fn ulps(a: f64, b: f64) -> u64 {
    a.to_bits().abs_diff(b.to_bits())
}

#[test]
fn all_cells_agree_with_exact_fractions() {
    let Reference { counts, cells } = reference();
    assert_eq!(cells.len(), 8);
    let shape = Shape::new(7, 7, 3).unwrap();
    let narrow = counts.iter().map(|count| *count as f32).collect();
    let cubes: [Cube; 2] = [
        MemoryCube::new(shape, narrow).unwrap().into(),
        MemoryCube::new(shape, counts.clone()).unwrap().into(),
    ];
    for (cell, var, expected) in cells {
        let same = NoiseVariance::Uniform(var);
        let per_band = NoiseVariance::PerBand(vec![var; 3]);
        let variances = MemoryCube::new(shape, vec![var; shape.len()]).unwrap();
        let per_sample = NoiseVariance::PerSample(variances.into());
        for noise in [&same, &per_band, &per_sample] {
            for cube in &cubes {
                let request = Request {
                    window: Window::new(5, 5).unwrap(),
                    derivative: Derivative::Central,
                    noise,
                    joined: Joined::SumOfReadings,
                    cells: &[cell],
                    centres: 0..7,
                };
                let map = information(cube, &request).unwrap();
                assert_eq!((map.rows.clone(), map.columns.clone()), (2..5, 3..4));
                let found = map.cell(cell)[1];
                assert!(ulps(found, expected) <= 4, "{cell:?}, variance {var}: {found} is not {expected}");
                let window = (1..6).flat_map(|y| (1..6).map(move |x| (y * 7 + x) * 3));
                let photons: f64 = window.map(|at| counts[at..at + 3].iter().sum::<f64>()).sum();
                assert_eq!(map.photons[1], photons);
                assert_eq!(map.var_added[1], 75.0 * var);
                for other in Cell::ALL {
                    assert_eq!(map.cell(other).is_empty(), other != cell);
                }
            }
        }
    }
}
