//! The files of `identify`: tables and plots of a target against a library, and of all against all.

mod figures;

pub use crate::words::identify::{check, text};

use crate::bundle::Bundle;
use crate::classes;
use crate::size::pictures_of_pairs;
use crate::table::{Table, number, optional, yes_no};
use crate::tables;
use hadar::error::Result;
use hadar_study::{Answers, Apart, BandsThatMatter, Exact, Matrix, Rows, Study};

/// All files of the answers; paths in the scenario are written relative to `out` where they lie below it.
/// `seed` is that of sample spectra.
///
/// # Errors
/// A figure that cannot be drawn.
pub fn bundle(study: &Study, answers: &Answers, seed: u64) -> Result<Bundle> {
    let mut bundle = Bundle::about(study.scenario().title.as_deref());
    let result = &answers.identification;
    bundle.add_asked("scenario.toml", study.scenario().to_toml());
    bundle.add_table("pairs.csv", tables::pairs(&result.pairs))?;
    bundle.add_conditions(&result.conditions.iter().map(|one| ("", one)).collect::<Vec<_>>())?;
    if !result.safety.is_empty() {
        bundle.add_table("safety.csv", tables::safety(&result.safety))?;
    }
    bundle.add_warnings(&result.warnings)?;
    if let Some(prediction) = &result.identifiability.prediction_heuristic {
        let mut table = Table::new(["material", "prediction_s32_heuristic"]);
        for entry in prediction {
            table.push(vec![entry.material.clone(), number(entry.probability)]);
        }
        bundle.add_table("prediction.csv", table)?;
    }
    let mut plots = classes::pictures(&result.classes);
    plots.push(figures::distances(study, &result.pairs));
    plots.extend(pictures_of_pairs(study, &result.pairs, &result.limiting)?);
    if let Some(matrix) = &answers.matrix {
        bundle.add_table("matrix_nearest.csv", square(matrix, &matrix.distance_nearest, PER_PHOTON))?;
        bundle.add_table("matrix_local.csv", square(matrix, &matrix.distance_local, PER_PHOTON))?;
        if let Some(unknown_gain) = &matrix.distance_local_unknown_gain {
            bundle.add_table("matrix_local_unknown_gain.csv", square(matrix, unknown_gain, PER_PHOTON))?;
        }
        if let Some(statistical) = &matrix.statistical_distance {
            bundle.add_table("matrix_camera.csv", square(matrix, statistical, STATISTICAL))?;
        }
        if let Some(lower) = matrix.statistical_distance_lower.as_ref().filter(|_| matrix.unproved > 0) {
            bundle.add_table("matrix_camera_lower.csv", square(matrix, lower, STATISTICAL))?;
        }
        bundle.add_table("targets.csv", targets(matrix))?;
        if !matrix.safety.is_empty() {
            bundle.add_table("matrix_safety.csv", tables::safety(&matrix.safety))?;
        }
        plots.push(figures::distance_matrix(matrix));
        plots.push(figures::minimum_distances(matrix));
        if let Some(spectra) = study.sample_spectra(seed)? {
            plots.push(figures::sample_spectra(&spectra, study.bands(), &result.limiting));
        }
    }
    if let Some(apart) = answers.apart.as_ref().or(answers.matrix.as_ref().and_then(|m| m.apart.as_ref())) {
        bundle.add_table("told_apart.csv", told_apart(apart))?;
        bundle.add_table("clusters.csv", clusters(apart))?;
    }
    if let Some(scaling) = &answers.scaling {
        plots.extend(figures::library_size(scaling, &study.target().name));
        plots.extend(figures::band_number(scaling, study));
    }
    if let Some(bands) = &answers.bands_that_matter {
        bundle.add_table("best_bands.csv", best_bands(bands, study.camera().is_some()))?;
        plots.push(figures::bands_that_matter(bands, study));
    }
    if let Some(exact) = &answers.exact {
        bundle.add_table("exact.csv", crate::identify::exact(exact))?;
    }
    bundle.add_plots(&plots)?;
    Ok(bundle)
}

/// What a distance is measured in, as it stands in the heads of columns.
const PER_PHOTON: &str = "distance_per_sqrt_photon";
const STATISTICAL: &str = "statistical_distance";

/// A matrix with the names of its rows and columns, these with the unit.
fn square(matrix: &Matrix, rows: &Rows, unit: &str) -> Table {
    let columns = matrix.materials.iter().map(|name| format!("{unit}_{name}"));
    let mut table = Table::new(std::iter::once("target".to_owned()).chain(columns));
    for (name, row) in matrix.materials.iter().zip(rows) {
        table.push(std::iter::once(name.clone()).chain(row.iter().map(|d| optional(*d))).collect());
    }
    table
}

fn targets(matrix: &Matrix) -> Table {
    Table::of(
        &matrix.targets,
        &[
            ("target", &|target| target.material.clone()),
            ("hardest_alternative", &|target| target.limiting.clone()),
            ("distance_minimum_per_sqrt_photon", &|target| number(target.distance_minimum)),
            ("statistical_distance_minimum_camera", &|target| optional(target.statistical_distance_minimum)),
            ("identifiable", &|target| target.identifiable.map_or_else(String::new, yes_no)),
        ],
    )
}

fn told_apart(apart: &Apart) -> Table {
    let mut table = Table::new(["material", "other", "told_apart"]);
    for (pairs, told) in [(&apart.told_apart, "yes"), (&apart.not_told_apart, "no")] {
        for [a, b] in pairs {
            table.push(vec![a.clone(), b.clone(), told.into()]);
        }
    }
    table
}

fn clusters(apart: &Apart) -> Table {
    let mut table = Table::new(["cluster", "material"]);
    for (i, members) in apart.clusters.iter().enumerate() {
        for member in members {
            table.push(vec![(i + 1).to_string(), member.clone()]);
        }
    }
    table
}

fn best_bands(found: &BandsThatMatter, with_camera: bool) -> Table {
    let unit = if with_camera { "statistical_distance_camera" } else { PER_PHOTON };
    let mut table = Table::new([
        "choice".to_owned(),
        "low_cm1".into(),
        "high_cm1".into(),
        "center_cm1".into(),
        format!("local_{unit}"),
        "kept_of_all_bands".into(),
        format!("bound_local_{unit}"),
        "proven_best".into(),
        "nearest_statistical_distance_camera".into(),
    ]);
    for (choice, what) in [(&found.bands, "band"), (&found.filters, "filter")] {
        let Some(choice) = choice else { continue };
        for passband in &choice.passbands {
            table.push(vec![
                what.into(),
                number(passband.low_cm1),
                number(passband.high_cm1),
                number(passband.center_cm1),
                number(choice.distance),
                number(choice.kept),
                number(choice.bound),
                yes_no(choice.exact),
                optional(choice.reached.as_ref().map(|reached| reached.statistical_distance)),
            ]);
        }
    }
    table
}

fn exact(found: &Exact) -> Table {
    Table::of(
        &found.pairs,
        &[
            ("alternative", &|pair| pair.alternative.clone()),
            ("photons", &|pair| number(pair.photons)),
            ("balanced_accuracy", &|pair| number(pair.balanced)),
            ("interval_low", &|pair| number(pair.balanced_interval.low)),
            ("interval_high", &|pair| number(pair.balanced_interval.high)),
            ("target_right", &|pair| number(pair.classes[0])),
            ("alternative_right", &|pair| number(pair.classes[1])),
            ("limit_nearest", &|pair| number(pair.limit)),
            ("estimate_best_fits", &|pair| number(pair.two_sided)),
            ("by_local_distance", &|pair| number(pair.local)),
            ("statistical_distance_nearest", &|pair| number(pair.statistical_distance_nearest)),
            ("statistical_distance_local", &|pair| number(pair.statistical_distance_local)),
            ("error_lower_bound", &|pair| number(pair.error_lower)),
            ("error_upper_bound_known_states", &|pair| number(pair.error_upper)),
            ("lattice_target_right", &|pair| {
                optional(pair.lattice.as_ref().and_then(|lattice| lattice.probabilities.first().copied()))
            }),
            ("trials", &|pair| pair.trials.to_string()),
            ("unconverged_fits", &|pair| pair.unconverged.to_string()),
            ("statistics", &|_| found.statistics.into()),
            ("seed", &|_| found.seed.to_string()),
            ("generator", &|_| found.generator.into()),
        ],
    )
}
