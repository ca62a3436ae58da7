//! Tables and plots.

use super::found::Found;
use hadar_report::figures::Plot;
use hadar_report::plot::{Axis, LineFigure, Rule, Series, Style};
use hadar_report::table::Table;
use hadar_study::air_ranging::AirPoint;

/// Digits that an iteration gives on any machine.
const DIGITS: usize = 5;

/// The same with numbers of so few digits that they do not hang on the last bit of an iteration.
pub(super) fn rounded(table: &Table) -> Table {
    let mut out = Table::new(table.header().iter().cloned());
    for row in table.rows() {
        let cell = |cell: &String| match cell.parse::<f64>() {
            Ok(value) if value.fract() != 0.0 => format!("{value:.*e}", DIGITS - 1),
            _ => cell.clone(),
        };
        out.push(row.iter().map(cell).collect());
    }
    out
}

fn of(points: &[(f64, AirPoint)], what: impl Fn(&AirPoint) -> Option<f64>) -> Vec<f64> {
    points.iter().map(|(_, point)| what(point).unwrap_or(f64::NAN)).collect()
}

/// The least error over the contrast of target and air.
pub(super) fn contrast(found: &Found) -> Plot {
    let points = &found.contrasts;
    let x: Vec<f64> = points.iter().map(|(by_k, _)| *by_k).collect();
    let columns = [
        ("as asked", Style::Line, 0, of(points, |point| point.sigma_m)),
        ("emissivity known", Style::Dashed, 1, of(points, |point| point.sigma_emissivity_known_m)),
        ("lighting known", Style::Dotted, 2, of(points, |point| point.sigma_lighting_known_m)),
        ("all else known", Style::Line, 3, of(points, |point| point.sigma_others_known_m)),
    ];
    let mut table = Table::new([
        "target_less_air_k",
        "sigma_m",
        "sigma_emissivity_known_m",
        "sigma_lighting_known_m",
        "sigma_others_known_m",
    ]);
    for (i, x) in x.iter().enumerate() {
        table.push_numbers(&[*x, columns[0].3[i], columns[1].3[i], columns[2].3[i], columns[3].3[i]]);
    }
    let mut figure = LineFigure::new(
        "No range is measured where the target looks like the air",
        Axis::linear("temperature of the target less that of the air (K)"),
        Axis::log("least error of 100 m (m)"),
    )
    .subtitle("One pixel, one reading. What the wall mirrors of the sky still differs from the air at equal temperatures.")
    .rule(Rule::vertical(0.0, ""));
    for (label, style, colour, values) in columns {
        figure = figure.series(Series::line(label, x.clone(), values).style(style).colour(colour));
    }
    Plot { name: "error_over_contrast".into(), figure: figure.into(), table }
}

/// Air and stereo over long distances.
pub(super) fn stereo(found: &Found) -> Plot {
    let curve = |i: usize| found.stereo.get(i).map_or(&[][..], |(_, result)| result.curve.as_slice());
    let x: Vec<f64> = curve(0).iter().map(|point| point.distance_m).collect();
    let air: Vec<f64> = curve(0).iter().map(|point| point.sigma_window_m.unwrap_or(f64::NAN)).collect();
    let by_texture: Vec<(f64, Vec<f64>)> = (found.stereo.iter().enumerate())
        .map(|(i, (texture, _))| {
            (*texture, curve(i).iter().map(|point| point.sigma_stereo_m.unwrap_or(f64::NAN)).collect())
        })
        .collect();
    let mut header = vec!["distance_m".to_owned(), "sigma_air_m".into()];
    header.extend(by_texture.iter().map(|(texture, _)| format!("sigma_stereo_texture_{texture}_m")));
    let mut table = Table::new(header);
    for (i, x) in x.iter().enumerate() {
        let mut row = vec![*x, air[i]];
        row.extend(by_texture.iter().map(|(_, values)| values[i]));
        table.push_numbers(&row);
    }
    let mut figure = LineFigure::new(
        "Where is the air more precise than a second camera?",
        Axis::log("distance (m)"),
        Axis::log("least error of the distance (m)"),
    )
    .subtitle(
        "A window of 5 × 5 pixels of the same camera, 0.2 m to the second one. Texture: change of the wall's light from pixel to pixel.",
    )
    .series(Series::line("air", x.clone(), air).colour(0));
    for (i, (texture, values)) in by_texture.into_iter().enumerate() {
        let label = format!("stereo, texture {} %", 100.0 * texture);
        figure = figure.series(Series::line(label, x.clone(), values).style(Style::Dashed).colour(i + 1));
    }
    figure = figure.series(Series::line("the distance itself", x.clone(), x).style(Style::Dotted).colour(6));
    Plot { name: "stereo_against_air".into(), figure: figure.into(), table }
}
