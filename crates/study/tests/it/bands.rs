//! Integrals over bands against sums written out here, and what light from elsewhere does to filters.

use hadar::material::Library;
use hadar::planck::photon_radiance;
use hadar_scenario::Scenario;
use hadar_study::Study;
use hadar_testing::seeded;
use proptest::prelude::*;
use std::fmt::Write;
use std::path::Path;

/// A spectrum that is straight between its rows.
#[derive(Debug, Clone)]
struct Rows(Vec<(f64, f64)>);

impl Rows {
    fn at(&self, nu: f64) -> f64 {
        let right = self.0.iter().position(|row| row.0 >= nu).unwrap();
        let (high, low) = (self.0[right], self.0[right.saturating_sub(1)]);
        if right == 0 { high.1 } else { low.1 + (high.1 - low.1) * (nu - low.0) / (high.0 - low.0) }
    }

    fn write(&self, folder: &Path, name: &str, column: &str) {
        let mut text = format!("wavenumber_cm1,{column}\n");
        self.0.iter().for_each(|(nu, value)| writeln!(text, "{nu},{value}").unwrap());
        std::fs::write(folder.join(name), text).unwrap();
    }
}

/// From 690 to 1010 cm^-1, in steps of which some are far below 1 cm^-1.
fn rows(steps: std::ops::Range<f64>) -> impl Strategy<Value = Rows> {
    let count = (320.0 / steps.start) as usize;
    prop::collection::vec((steps, 0.02..0.98f64), count).prop_map(|steps| {
        let mut nu = 690.0;
        let mut rows = vec![(nu, 0.5)];
        for (step, value) in steps {
            nu += step;
            rows.push((nu, value));
            if nu > 1010.0 {
                break;
            }
        }
        Rows(rows)
    })
}

#[derive(Debug, Clone)]
enum Asked {
    Ranges(Vec<(f64, f64)>),
    Filter(Rows),
    Grid(f64),
}

#[derive(Debug, Clone)]
struct Case {
    target: Rows,
    alternative: Rows,
    asked: Asked,
    temperature_k: f64,
    lighting: f64,
}

fn case() -> impl Strategy<Value = Case> {
    let ranges = prop::collection::vec((720.0..900.0f64, 0.3..80.0f64), 2..5).prop_map(|ranges| {
        Asked::Ranges(ranges.into_iter().map(|(low, width)| (low, low + width)).collect())
    });
    // Less than the whole range, with a row of no transmittance at either end.
    let filter = rows(3.0..30.0).prop_map(|Rows(mut rows)| {
        rows.retain(|row| (720.0..980.0).contains(&row.0));
        rows.insert(0, (719.0, 0.0));
        rows.push((981.0, 0.0));
        Asked::Filter(Rows(rows))
    });
    let grid = prop_oneof![Just(1.0), Just(2.5), Just(20.0)].prop_map(Asked::Grid);
    (rows(0.4..6.0), rows(0.2..9.0), prop_oneof![ranges, filter, grid], 250.0..350.0f64, 0.0..1.0f64)
        .prop_map(|(target, alternative, asked, temperature_k, lighting)| Case {
            target,
            alternative,
            asked,
            temperature_k,
            lighting,
        })
}

impl Case {
    fn study(&self, folder: &Path, unknown: &str, more: &str) -> Study {
        self.target.write(folder, "t.csv", "emissivity");
        self.alternative.write(folder, "a.csv", "emissivity");
        let bands = match &self.asked {
            Asked::Ranges(ranges) => {
                let each = ranges.iter().map(|(low, high)| format!("[\"{low} cm^-1\", \"{high} cm^-1\"]"));
                format!("ranges = [{}]", each.collect::<Vec<_>>().join(", "))
            }
            Asked::Filter(rows) => {
                rows.write(folder, "f.csv", "f");
                "filters = \"f.csv\"".to_owned()
            }
            Asked::Grid(step) => {
                format!("start = \"750 cm^-1\"\nstop = \"850 cm^-1\"\nstep = \"{step} cm^-1\"")
            }
        };
        let text = format!(
            "[target]\nmaterial = \"t.csv\"\ntemperature = \"{} K\"\n[[environment]]\ntemperature = \"290 K\"\n\
             lighting = {}\n[alternatives]\nmaterials = [\"a.csv\"]\n[bands]\n{bands}\n{more}\n[unknown]\n\
             nuisances = [{unknown}]\n",
            self.temperature_k, self.lighting
        );
        let path = folder.join("s.toml");
        std::fs::write(&path, &text).unwrap();
        let scenario = Scenario::from_toml(&text, Some(&path)).unwrap();
        Study::new(&scenario, &Library::embedded().unwrap()).unwrap()
    }

    /// Integral over each band: Simpson's rule on eight parts between all rows.
    fn integrals(&self, surface: &Rows) -> Vec<f64> {
        let one = |low: f64, high: f64, through: &dyn Fn(f64) -> f64, more: &[(f64, f64)]| {
            let rows = self.target.0.iter().chain(&self.alternative.0).chain(more).map(|row| row.0);
            let mut edges: Vec<f64> = rows.filter(|nu| low < *nu && *nu < high).chain([low, high]).collect();
            edges.sort_by(f64::total_cmp);
            let signal = |nu: f64| {
                let e = surface.at(nu);
                let own = photon_radiance(nu, self.temperature_k);
                through(nu) * (e * own + (1.0 - e) * self.lighting * photon_radiance(nu, 290.0))
            };
            let over = |pair: &[f64]| {
                let h = (pair[1] - pair[0]) / 16.0;
                let at = |i: usize| signal(pair[0] + h * i as f64);
                let simpson = |i: usize| h / 3.0 * (at(2 * i) + 4.0 * at(2 * i + 1) + at(2 * i + 2));
                (0..8).map(simpson).sum::<f64>()
            };
            edges.windows(2).map(over).sum::<f64>()
        };
        match &self.asked {
            Asked::Ranges(ranges) => {
                let mut ranges = ranges.clone();
                ranges.sort_by(|a, b| a.partial_cmp(b).unwrap());
                ranges.iter().map(|(low, high)| one(*low, *high, &|_| 1.0, &[])).collect()
            }
            Asked::Filter(rows) => vec![one(719.0, 981.0, &|nu| rows.at(nu), &rows.0)],
            Asked::Grid(step) => {
                let count = (100.0 / step) as usize;
                let center = |i: usize| 750.0 + step * i as f64;
                (0..=count)
                    .map(|i| one(center(i) - 0.5 * step, center(i) + 0.5 * step, &|_| 1.0, &[]))
                    .collect()
            }
        }
    }
}

/// Distance per photon of two spectra of counts, nothing unknown.
fn distance(own: &[f64], other: &[f64]) -> f64 {
    let square: f64 = own.iter().zip(other).map(|(a, b)| (a.sqrt() - b.sqrt()).powi(2)).sum();
    (square / own.iter().sum::<f64>()).sqrt()
}

proptest! {
    #![proptest_config(seeded(41, 40))]

    /// Signals and distances are those of the integrals, and finer nodes move a distance by no more than is printed.
    #[test]
    fn bands_with_rows_of_their_own_are_integrals(case in case()) {
        let folder = tempfile::tempdir().unwrap();
        let study = case.study(folder.path(), "", "");
        let (own, other) = (case.integrals(&case.target), case.integrals(&case.alternative));
        // Of a grid of 1 cm^-1 those bands are sampled in which no rows are nearer.
        let all = !matches!(case.asked, Asked::Grid(step) if step < 20.0);
        if all {
            for (found, exact) in study.target_signal().iter().zip(&own) {
                prop_assert!((found / exact - 1.0).abs() < 1e-9, "{} {}", found, exact);
            }
            let pair = study.identify().unwrap().pairs[0].clone();
            let exact = distance(&own, &other);
            let allowed = pair.relative_error_nearest + 1e-9 / exact;
            prop_assert!((pair.distance_nearest / exact - 1.0).abs() < allowed, "{} {exact}", pair.distance_nearest);
        }
        for unknown in ["", "\"temperature\""] {
            if own.len() < 2 && !unknown.is_empty() {
                continue;
            }
            let of = |more: &str| case.study(folder.path(), unknown, more).identify().unwrap().pairs[0].clone();
            let (coarse, plain, fine) = (of("tolerance = 1e-3"), of(""), of("tolerance = 1e-12"));
            for (pair, share) in [(&coarse, 1e-5), (&plain, 1e-11)] {
                let (a, b) = (pair.distance_nearest, fine.distance_nearest);
                let error = pair.relative_error_nearest;
                prop_assert!((a - b).abs() <= (error + fine.relative_error_nearest) * a.max(b), "{a} {b} {error}");
                // What is printed is no more than the tolerance makes.
                prop_assert!(error <= 2.0 * share / a + 1e-9, "{error} {a}");
                let local = (pair.distance_local - fine.distance_local).abs();
                prop_assert!(local <= (pair.relative_error + fine.relative_error) * fine.distance_local.max(pair.distance_local));
                prop_assert!(pair.distance_nearest_lower <= fine.distance_nearest * (1.0 + fine.relative_error_nearest));
            }
        }
    }
}

/// Three ways to say it, of a spectrum with a line between the centres.
#[test]
fn the_key_decides_over_grids_alone() {
    let target = Rows(vec![(690.0, 0.5), (1010.0, 0.5)]);
    let line = vec![(690.0, 0.5), (790.0, 0.5), (791.0, 0.9), (792.0, 0.5), (1010.0, 0.5)];
    let case = |asked: Asked| Case {
        target: target.clone(),
        alternative: Rows(line.clone()),
        asked,
        temperature_k: 300.0,
        lighting: 0.0,
    };
    let folder = tempfile::tempdir().unwrap();
    let nodes = |case: &Case, more: &str| {
        let study = case.study(folder.path(), "", more);
        (study.bands().nodes_cm1().len(), study.identify().unwrap().pairs[0].distance_nearest)
    };
    let grid = case(Asked::Grid(20.0));
    let (sampled, integrated, plain) =
        (nodes(&grid, "integrate = false"), nodes(&grid, "integrate = true"), nodes(&grid, ""));
    assert_eq!(sampled, (6, 0.0));
    // The one band of six that has rows takes more than its centre: from 780 to 800 cm^-1.
    assert!(plain.0 > 6 && plain.0 < integrated.0, "{plain:?} {integrated:?}");
    assert!((plain.1 / integrated.1 - 1.0).abs() < 1e-4 && plain.1 > 1e-3, "{plain:?} {integrated:?}");
    let range = case(Asked::Ranges(vec![(780.0, 800.0), (800.0, 850.0)]));
    assert_eq!(nodes(&range, "integrate = false"), nodes(&range, ""));
    let exact = distance(&range.integrals(&range.target), &range.integrals(&range.alternative));
    assert!((nodes(&range, "").1 / exact - 1.0).abs() < 1e-9);
}

/// A camera without noise of its own behind air, before a background, with bunched photons.
fn scene(seed: [f64; 6], which: [bool; 3]) -> String {
    let [a, b, c, d, e, f] = seed;
    let mut text = format!(
        "[target]\nmaterial = \"{}\"\ntemperature = \"{} K\"\ndistance = \"{} m\"\n",
        ["skin", "fabric", "pmma"][(3.0 * a) as usize],
        270.0 + 60.0 * b,
        50.0 + 900.0 * c
    );
    if which[0] {
        text += "size = \"20 mm\"\n[background]\ntemperature = \"320 K\"\n";
    }
    if which[1] {
        text += "[atmosphere]\nmodel = \"tropical\"\n";
    }
    text += &format!(
        "[[environment]]\ntemperature = \"{} K\"\nlighting = {e}\n[alternatives]\nmaterials = [\"concrete\"]\n\
         [bands]\nstart = \"750 cm^-1\"\nstop = \"1200 cm^-1\"\nstep = \"{} cm^-1\"\n[unknown]\nnuisances = [\"lighting\"]\n\
         [camera]\nexposure = \"1 ms\"\npixel = \"12 um\"\nf_number = 1.3\nfocal_length = \"18 mm\"\nnoise_electrons = 0\n\
         photon_bunching = {}\n",
        260.0 + 50.0 * d,
        25.0 + 25.0 * (2.0 * f).floor(),
        which[2]
    );
    text
}

proptest! {
    #![proptest_config(seeded(42, 40))]

    /// Summed counts never tell more than the counts themselves: whatever other light there is, without the noise of a
    /// reading neither filters nor a choice of bands exceed all bands.
    #[test]
    fn without_noise_of_a_reading_no_filters_exceed_their_bands(
        seed in prop::array::uniform6(0.0..1.0f64), which in prop::array::uniform3(any::<bool>()), k in 2..4usize,
    ) {
        let study = Study::new(
            &Scenario::from_toml(&scene(seed, which), None).unwrap(),
            &Library::embedded().unwrap(),
        ).unwrap();
        let found = study.bands_that_matter(Some(k), Some(k)).unwrap();
        for choice in [found.bands.unwrap(), found.filters.unwrap()] {
            prop_assert!(choice.kept <= 1.0 + 1e-9, "{choice:?}");
            prop_assert!(!choice.exact || choice.bound <= choice.distance_all_bands * (1.0 + 1e-9));
            let whole = study.identify().unwrap().identifiability.statistical_distance_minimum.unwrap();
            let reached = choice.reached.map_or(0.0, |reached| reached.statistical_distance);
            prop_assert!(reached <= whole * (1.0 + 1e-6), "{reached} {whole}");
        }
    }
}
