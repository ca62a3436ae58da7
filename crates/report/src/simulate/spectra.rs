//! The spectra of a test as they were drawn: a witness that anybody can judge anew.
//!
//! `spectra.csv` has a row for each, `spectra.npy` of many an array of float64, (experiments × trials, classes, bands);
//! `spectra_classes.csv` what the classes are: state, seed, mean counts and reading noise of every band.

use crate::bundle::Bundle;
use crate::table::{Table, number};
use hadar::cube::Shape;
use hadar::error::Result;
use hadar_formats::cube::write_npy_to;
use hadar_study::{SimulatedPoint, Simulation, TestSpectra};

/// Counts from which on they are an array instead of a table.
const MANY: usize = 1_000_000;

/// Adds the spectra of all experiments that have them.
pub(super) fn add(bundle: &mut Bundle, result: &Simulation) -> Result<()> {
    let with = |point| -> Option<(&SimulatedPoint, &TestSpectra)> {
        let point: &SimulatedPoint = point;
        Some((point, point.spectra.as_ref()?))
    };
    let saved: Vec<_> = result.points.iter().filter_map(with).collect();
    let Some((_, first)) = saved.first() else { return Ok(()) };
    bundle.add_table("spectra_classes.csv", classes(&saved))?;
    let (bands, of_class) = (first.counts.bands(), first.counts.classes());
    let counts: usize = saved.iter().map(|(_, spectra)| spectra.counts.counts().len()).sum();
    if counts < MANY {
        bundle.add("spectra.csv", table(&saved, bands).to_csv()?);
        return Ok(());
    }
    let all: Vec<f64> =
        saved.iter().flat_map(|(_, spectra)| spectra.counts.counts().iter().copied()).collect();
    let mut bytes = Vec::new();
    write_npy_to(&mut bytes, Shape::new(counts / (of_class * bands), of_class, bands)?, &all)?;
    bundle.add("spectra.npy", bytes);
    Ok(())
}

fn classes(saved: &[(&SimulatedPoint, &TestSpectra)]) -> Table {
    let mut table = Table::new([
        "photons",
        "class",
        "material",
        "temperature_k",
        "lighting",
        "seed",
        "band",
        "center_cm1",
        "mean_counts",
        "var_reading",
    ]);
    for (point, spectra) in saved {
        for (place, (class, means)) in point.classes.iter().zip(&spectra.means).enumerate() {
            let lighting: Vec<String> = class.lighting.iter().map(|v| number(*v)).collect();
            let bands = means.iter().zip(&spectra.var_reading).zip(&spectra.centres_cm1).enumerate();
            for (band, ((mean, var), center_cm1)) in bands {
                table.push(vec![
                    number(point.photons),
                    place.to_string(),
                    class.material.clone(),
                    number(class.temperature_k),
                    lighting.join(" "),
                    spectra.seed.to_string(),
                    band.to_string(),
                    number(*center_cm1),
                    number(*mean),
                    number(*var),
                ]);
            }
        }
    }
    table
}

fn table(saved: &[(&SimulatedPoint, &TestSpectra)], bands: usize) -> Table {
    let head = ["photons", "trial", "class"].map(str::to_owned).into_iter();
    let mut table = Table::new(head.chain((0..bands).map(|band| format!("band_{band}"))));
    for (point, spectra) in saved {
        let classes = spectra.counts.classes().max(1);
        for (i, (counts, class)) in spectra.counts.iter().enumerate() {
            let mut row = vec![number(point.photons), (i / classes).to_string(), class.to_string()];
            row.extend(counts.iter().map(|count| number(*count)));
            table.push(row);
        }
    }
    table
}
