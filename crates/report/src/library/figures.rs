//! Pictures of a library out of a cube: emissivities with their errors, and the map of clusters.

use crate::figures::{Plot, wavenumber_axis};
use crate::plot::{Axis, Band, LineFigure, Pictures, Series};
use crate::shown::Shown;
use crate::table::{Table, number};
use crate::words::library as words;
use crate::words::pictures::NOTHING_TOLD;
use hadar_study::library::LibraryFound;

/// Curves of a figure.
const MOST: usize = 12;

pub(super) fn emissivities(result: &LibraryFound) -> Plot {
    let nu = &result.wavenumbers_cm1;
    let shown = &result.clusters[..result.clusters.len().min(MOST)];
    let mut columns = vec!["wavenumber_cm1".to_owned()];
    columns.extend(shown.iter().flat_map(|row| [row.name.clone(), format!("{}_sigma", row.name)]));
    let mut table = Table::new(columns);
    for (band, nu) in nu.iter().enumerate() {
        let own = shown.iter().flat_map(|row| [row.cluster.emissivity[band], row.cluster.sigma[band]]);
        table.push(std::iter::once(*nu).chain(own).map(number).collect());
    }
    let mut figure = LineFigure::new(
        "Emissivities found in the heat cube",
        wavenumber_axis(nu),
        Axis::linear("emissivity").range(0.0, 1.02),
    )
    .subtitle(words::one_deviation(result.clusters.len() > MOST));
    for (i, row) in shown.iter().enumerate() {
        let one = &row.cluster;
        let edge = |sign: f64| -> Vec<f64> {
            one.emissivity
                .iter()
                .zip(&one.sigma)
                .map(|(e, sigma)| (e + sign * sigma).clamp(0.0, 1.02))
                .collect()
        };
        figure = figure
            .band(Band::new("", nu.clone(), edge(-1.0), edge(1.0)).colour(i))
            .series(Series::line(row.name.clone(), nu.clone(), one.emissivity.clone()).colour(i));
    }
    Plot { name: "emissivities".into(), figure: figure.into(), table }
}

pub(super) fn maps(result: &LibraryFound) -> Plot {
    let (shown, maps) = (Shown::of(result.shape), &result.maps);
    let finite = |x: f32| if x.is_finite() { f64::from(x) } else { f64::NAN };
    let (table, pictures) = shown.layers(vec![
        (
            "cluster",
            "Cluster",
            Axis::linear("number of the cluster"),
            shown.values(|i| {
                if maps.material[i] == u16::MAX { f64::NAN } else { f64::from(maps.material[i]) + 1.0 }
            }),
        ),
        (
            "temperature_k",
            "Temperature",
            Axis::linear("temperature (K)"),
            shown.values(|i| finite(maps.temperature_k[i])),
        ),
    ]);
    let figure = Pictures::new("Clusters and temperatures by the library that was found", pictures)
        .subtitle(words::most_probable(shown))
        .no_value(NOTHING_TOLD);
    Plot { name: "clusters_map".into(), figure: figure.into(), table }
}
