//! What is solved for is put into the scenario and asked again: it meets the demand, 1 % worse does not.

use super::super::{DepthSolutions, RangePlan, RangeStudy, Ranging};
use super::*;
use hadar::material::Library;
use hadar_formats::cube::write_npy;
use hadar_scenario::RangeScenario;
use std::path::Path;

/// Uniform numbers from a seed (xorshift).
struct Uniform(u64);

impl Uniform {
    fn draw(&mut self, low: f64, high: f64) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        low + (high - low) * (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

fn study(folder: &Path, scenario: &str) -> RangeStudy {
    let path = folder.join("a.toml");
    std::fs::write(&path, scenario).unwrap();
    RangeStudy::new(&RangeScenario::from_file(&path).unwrap(), &Library::embedded().unwrap()).unwrap()
}

fn asked(folder: &Path, scenario: &str) -> Ranging {
    study(folder, scenario).range(&RangePlan::default(), None, &|_, _| ()).unwrap()
}

fn value(found: &DepthSolutions, of: fn(&DepthSolutions) -> Option<&DepthSolution>) -> Option<f64> {
    of(found).and_then(|solution| solution.value)
}

/// Rows of two kinds of texture: bright with little of it, dark with much, of random sizes, periods and numbers.
fn textures(rng: &mut Uniform, shape: Shape) -> Vec<f64> {
    let mut draw = |low: f64, high: f64| 10_f64.powf(rng.draw(low, high));
    let bright = [draw(5.0, 6.5), draw(-3.2, -2.5)];
    let dark = [draw(1.5, 3.0), draw(-0.5, -0.1)];
    let (kind, period) = (draw(-0.5, -0.2), draw(0.8, 1.1));
    let rows = shape.rows() as f64;
    let of = |row: usize, column: usize, band: usize| {
        let [mean, depth] = if (row as f64) < kind * rows { bright } else { dark };
        let more = 1.0 + 0.2 * (row as f64 * 1.7).sin();
        mean * (1.0
            + depth * more * (2.0 * std::f64::consts::PI * column as f64 / period + band as f64).sin())
    };
    (0..shape.len())
        .map(|i| of(i / shape.row_len(), i / shape.bands() % shape.columns(), i % shape.bands()))
        .collect()
}

/// 24 random cubes: noise and baseline of cubes that are kept, and of the same by rows.
#[test]
fn what_is_solved_for_holds_of_all_windows() {
    let folder = tempfile::tempdir().unwrap();
    let mut rng = Uniform(0x2545_f491_4f6c_dd1d);
    let shape = Shape::new(16, 40, 2).unwrap();
    let mut changed = 0;
    for _ in 0..24 {
        write_npy(&folder.path().join("left.npy"), shape, &textures(&mut rng, shape)).unwrap();
        let share = rng.draw(0.2, 0.95);
        let demand = 10_f64.powf(rng.draw(-2.5, -0.5));
        let scenario = |noise: f64, baseline: f64| {
            format!(
                "[cube]\nleft = \"left.npy\"\ndepth = \"20 m\"\n\
                 [bands]\nstart = \"800 cm^-1\"\nstop = \"820 cm^-1\"\nstep = \"20 cm^-1\"\n\
                 [camera]\nexposure = \"1 ms\"\npixel = \"12 um\"\nf_number = 1.4\nfocal_length = \"14 mm\"\n\
                 noise_electrons = {noise:e}\nnoise_exposure = \"1 ms\"\n\
                 [stereo]\nbaseline = \"{baseline:e} m\"\nwindow = [3, 3]\n\
                 [requirement]\nrelative_depth_error = {demand}\nshare = {share}\n"
            )
        };
        let of = |by_rows: bool, noise: f64, baseline: f64| -> Ranging {
            let study = study(folder.path(), &scenario(noise, baseline));
            let Resolved::Cube(cube) = &study.subject else { panic!("no cube") };
            match by_rows {
                true => study.streamed(cube, &RangePlan::default(), None, &|_, _| ()).unwrap(),
                false => study.range(&RangePlan::default(), None, &|_, _| ()).unwrap(),
            }
        };
        for by_rows in [false, true] {
            let met = |noise: f64, baseline: f64| of(by_rows, noise, baseline).verdict.met.unwrap();
            let Some(found) = of(by_rows, 1.0, 0.2).solve_for else { continue };
            if let Some(noise) = value(&found, |found| found.noise_counts.as_ref()) {
                assert!(met(noise, 0.2), "{noise} of\n{}", scenario(1.0, 0.2));
                assert!(!met(1.01 * noise, 0.2), "{noise} of\n{}", scenario(1.0, 0.2));
                changed += 1;
            }
            let baseline = value(&found, |found| Some(&found.baseline_m)).unwrap();
            assert!(met(1.0, baseline) && !met(1.0, 0.99 * baseline), "{baseline}\n{}", scenario(1.0, 0.2));
        }
    }
    println!("{changed} figures of noise");
    assert!(changed > 10);
}

/// A rendered scene: exposure and lens.
#[test]
fn what_is_solved_for_holds_of_a_scene() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = |exposure: f64, f_number: f64, well: &str| {
        format!(
            "[scene]\nsize = [40, 56]\nsky_temperature = \"-15 degC\"\n\
             [bands]\nstart = \"800 cm^-1\"\nstop = \"1200 cm^-1\"\nstep = \"100 cm^-1\"\n\
             [camera]\nexposure = \"{exposure:e} s\"\npixel = \"48 um\"\nf_number = {f_number:e}\n\
             focal_length = \"14 mm\"\nnoise_electrons = 200\nnoise_exposure = \"1 ms\"\n{well}\
             [stereo]\nbaseline = \"0.2 m\"\n\
             [requirement]\nrelative_depth_error = 0.02\nshare = 0.6\n"
        )
    };
    let met = |exposure: f64, f_number: f64| {
        asked(folder.path(), &scenario(exposure, f_number, "")).verdict.met.unwrap()
    };
    let found = asked(folder.path(), &scenario(1e-3, 1.4, "")).solve_for.unwrap();
    let exposure = value(&found, |found| found.exposure_s.as_ref()).unwrap();
    assert!(met(exposure, 1.4) && !met(0.99 * exposure, 1.4), "{exposure}");
    if let Some(aperture) = value(&found, |found| found.aperture_m.as_ref()) {
        assert!(met(1e-3, 0.014 / aperture) && !met(1e-3, 0.014 / (0.99 * aperture)), "{aperture}");
    }
    // A well that this exposure overfills is no solution.
    let full = asked(folder.path(), &scenario(1e-3, 1.4, "full_well = 1000\n")).solve_for.unwrap();
    let full = full.exposure_s.unwrap();
    assert!(full.value.is_none() && full.reason.unwrap().contains("well"));
}
