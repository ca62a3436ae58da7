//! Pictures of a library out of a cube: emissivities with their errors, and the map of clusters.

use crate::figures::{Plot, wavenumber_axis};
use crate::plot::{Axis, Band, LineFigure, Picture, Pictures, Series};
use crate::table::{Table, number};
use hadar_study::library::LibraryFound;

/// Widest picture, pixels: of larger cubes every second, third… row and column is shown.
const WIDEST: usize = 320;
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
    .subtitle(format!(
        "Shaded: one standard deviation, with all temperatures and lightings unknown.{}",
        if result.clusters.len() > MOST {
            " The clusters of the most pixels; all are in library.csv."
        } else {
            ""
        }
    ));
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
    let (rows, columns) = (result.shape.rows(), result.shape.columns());
    let stride = columns.max(rows).div_ceil(WIDEST);
    let shown: Vec<(usize, usize)> = (0..rows)
        .step_by(stride)
        .flat_map(|row| (0..columns).step_by(stride).map(move |column| (row, column)))
        .collect();
    let maps = &result.maps;
    let take = |value: &dyn Fn(usize) -> f64| -> Vec<f64> {
        shown.iter().map(|(row, column)| value(row * columns + column)).collect()
    };
    let finite = |x: f32| if x.is_finite() { f64::from(x) } else { f64::NAN };
    let layers = [
        (
            "cluster",
            "Cluster",
            Axis::linear("number of the cluster"),
            take(&|i| {
                if maps.material[i] == u16::MAX { f64::NAN } else { f64::from(maps.material[i]) + 1.0 }
            }),
        ),
        (
            "temperature_k",
            "Temperature",
            Axis::linear("temperature (K)"),
            take(&|i| finite(maps.temperature_k[i])),
        ),
    ];
    let mut table = Table::new(["row", "column"].into_iter().chain(layers.iter().map(|layer| layer.0)));
    for (i, (row, column)) in shown.iter().enumerate() {
        let values = layers.iter().map(|layer| number(layer.3[i]));
        table.push([row.to_string(), column.to_string()].into_iter().chain(values).collect());
    }
    let wide = columns.div_ceil(stride);
    let pictures =
        layers.into_iter().map(|(_, title, axis, values)| Picture::new(title, axis, wide, values)).collect();
    let every = match stride {
        1 => String::new(),
        stride => {
            format!(" Every {stride}th row and column of {rows} × {columns}; all are in the NPY files.")
        }
    };
    let figure = Pictures::new("Clusters and temperatures by the library that was found", pictures)
        .subtitle(format!("The most probable cluster of each pixel, and its temperature.{every}"))
        .no_value("nothing is told");
    Plot { name: "clusters_map".into(), figure: figure.into(), table }
}
