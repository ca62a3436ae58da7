//! A library made out of a heat cube, as files: emissivities with their errors, the map of clusters, a scenario that uses it, pictures.

mod figures;

pub use crate::words::library::text;

use crate::bundle::Bundle;
use crate::table::{Table, number};
use hadar::error::Result;
use hadar::order;
use hadar_formats::cube::npy_map;
use hadar_scenario::DecomposeScenario;
use hadar_scenario::decompose::{LibrarySpec, TruthSpec};
use hadar_study::library::LibraryFound;

/// Least error of the emissivities that is handed on: with less than this a library is exact.
const LEAST_ERROR: f64 = 1e-5;

/// All files; paths in the scenarios are written relative to `out` where they lie below it.
///
/// # Errors
/// A figure that cannot be drawn.
pub fn bundle(result: &LibraryFound) -> Result<Bundle> {
    let mut bundle = Bundle::about(result.scenario.title.as_deref());
    bundle.add_asked("scenario.toml", result.scenario.to_toml());
    bundle.add_table("library.csv", library(result))?;
    bundle.add_table("library_sigma.csv", sigma(result))?;
    bundle.add_table("clusters.csv", clusters(result))?;
    if !result.tried.is_empty() {
        bundle.add_table("counts.csv", tried(result))?;
    }
    bundle.add_warnings(&result.warnings)?;
    let (maps, size) = (&result.maps, [result.shape.rows(), result.shape.columns()]);
    let lights = maps.lighting.len() / maps.material.len().max(1);
    bundle.add("cluster.npy", npy_map(&size, &maps.material)?);
    bundle.add("temperature_k.npy", npy_map(&size, &maps.temperature_k)?);
    bundle.add("temperature_sigma_k.npy", npy_map(&size, &maps.temperature_sigma_k)?);
    bundle.add("lighting.npy", npy_map(&[size[0], size[1], lights], &maps.lighting)?);
    bundle.add("p_value.npy", npy_map(&size, &maps.p_value)?);
    bundle.add("flags.npy", npy_map(&size, &maps.flags)?);
    bundle.add("decompose.toml", decomposition(result).to_toml());
    bundle.add_plots(&[figures::emissivities(result), figures::maps(result)])?;
    Ok(bundle)
}

/// Emissivities, a column for each cluster; a row more at an end where a band is sampled beyond its mean wavenumber.
fn library(result: &LibraryFound) -> Table {
    let names = result.clusters.iter().map(|row| row.name.as_str());
    let mut table = Table::new(std::iter::once("wavenumber_cm1").chain(names));
    let nu = &result.wavenumbers_cm1;
    let mut order: Vec<usize> = (0..nu.len()).collect();
    order::ascending(&mut order, |a| nu[*a]);
    let mut row = |at: f64, band: usize| {
        let values = result.clusters.iter().map(|own| own.cluster.emissivity[band]);
        table.push(std::iter::once(at).chain(values).map(number).collect());
    };
    let [low, high] = result.range_cm1;
    if let Some(first) = order.first().filter(|first| nu[**first] > low) {
        row(low, *first);
    }
    for band in &order {
        row(nu[*band], *band);
    }
    if let Some(last) = order.last().filter(|last| nu[**last] < high) {
        row(high, *last);
    }
    table
}

/// Errors, three columns for each cluster.
fn sigma(result: &LibraryFound) -> Table {
    let columns = result
        .clusters
        .iter()
        .flat_map(|row| ["sigma", "sigma_magnitude", "spread"].map(|what| format!("{}_{what}", row.name)));
    let mut table = Table::new(std::iter::once("wavenumber_cm1".to_owned()).chain(columns));
    for (band, nu) in result.wavenumbers_cm1.iter().enumerate() {
        let own = result.clusters.iter().flat_map(|row| {
            let one = &row.cluster;
            [one.sigma[band], one.sigma_magnitude[band], one.spread[band]]
        });
        table.push(std::iter::once(*nu).chain(own).map(number).collect());
    }
    table
}

fn clusters(result: &LibraryFound) -> Table {
    let rows: Vec<_> = result.clusters.iter().enumerate().collect();
    Table::of(
        &rows,
        &[
            ("cluster", &|(_, row)| row.name.clone()),
            ("index", &|(index, _)| index.to_string()),
            ("pixels", &|(_, row)| row.pixels.to_string()),
            ("fitted_pixels", &|(_, row)| row.cluster.fitted.to_string()),
            ("emissivity_mean", &|(_, row)| number(row.emissivity_mean)),
            ("emissivity_mean_sigma", &|(_, row)| number(row.cluster.sigma_mean)),
            ("temperature_median_k", &|(_, row)| number(row.temperature_median_k)),
            ("temperature_common_sigma_k", &|(_, row)| number(row.cluster.sigma_temperature_k)),
            ("chi_square_reduced", &|(_, row)| number(row.cluster.chi_square_reduced)),
            ("bands_at_limit", &|(_, row)| row.cluster.held.to_string()),
        ],
    )
}

fn tried(result: &LibraryFound) -> Table {
    Table::of(
        &result.tried,
        &[
            ("clusters", &|one| one.count.to_string()),
            ("clusters_with_pixels", &|one| one.left.to_string()),
            ("loss", &|one| number(one.loss)),
            ("loss_error", &|one| number(one.error)),
            ("chi_square_reduced", &|one| number(one.chi_square_reduced)),
        ],
    )
}

/// The scenario that takes the cube apart with the library.
fn decomposition(result: &LibraryFound) -> DecomposeScenario {
    let scenario = &result.scenario;
    // What a cluster's emissivity may be off by is above all its magnitude, which all bands have in common.
    let [first, last] = result.range_cm1;
    let together = scenario.emissivity.correlation_cm1.max(last - first);
    let error = (result.emissivity_error > LEAST_ERROR).then(|| rounded_up(result.emissivity_error));
    DecomposeScenario {
        classes: std::collections::BTreeMap::new(),
        title: scenario.title.clone(),
        cube: scenario.cube.clone(),
        bands: scenario.bands.clone(),
        camera: scenario.camera.clone(),
        atmosphere: scenario.atmosphere.clone(),
        environment: scenario.environment.clone(),
        library: LibrarySpec {
            path: Some("library.csv".into()),
            prior: Some(result.prior.clone()),
            emissivity_error: error,
            emissivity_correlation_cm1: error.map(|_| together),
            ..LibrarySpec::default()
        },
        unknown: scenario.unknown,
        spatial: None,
        vision: Default::default(),
        categories: Vec::new(),
        segmentation: Default::default(),
        // Materials of the truth are those of another library.
        truth: scenario
            .truth
            .as_ref()
            .and_then(|truth| truth.temperature.clone())
            .map(|temperature| TruthSpec { temperature: Some(temperature), ..TruthSpec::default() }),
        // Its other files are those of this scenario.
        source: scenario.source.clone(),
    }
}

/// Two digits, upwards: an error is not made smaller.
fn rounded_up(value: f64) -> f64 {
    let scale = 10f64.powi(1 - value.log10().floor() as i32);
    ((value * scale).ceil() / scale).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::rounded_up;

    #[test]
    fn an_error_is_rounded_upwards() {
        assert_eq!([0.0123, 0.5, 0.00301, 2.0].map(rounded_up), [0.013, 0.5, 0.0031, 1.0]);
    }
}
