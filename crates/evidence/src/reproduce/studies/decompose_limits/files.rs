//! Tables and plots.

use super::sets::{Decided, TWO};
use super::temperatures::Read;
use hadar_report::figures::Plot;
use hadar_report::plot::{Axis, LineFigure, Panel, Rule, Series, Style};
use hadar_report::table::Table;

/// Photons, two materials, many.
pub(super) type Row = (f64, Decided, Decided);

pub(super) fn materials(rows: &[Row]) -> Plot {
    let mut table =
        Table::new(["photons"].map(str::to_owned).into_iter().chain(["two", "many"].iter().flat_map(|of| {
            [
                "right",
                "unnamed",
                "right_standard_error",
                "best_decision",
                "best_decision_standard_error",
                "best_decision_exact",
                "right_random_pixels",
                "phi_random_pixels",
            ]
            .map(|what| format!("{of}_{what}"))
        })));
    for (photons, two, many) in rows {
        let cells = [two, many].map(|d| {
            [
                d.right,
                d.unnamed,
                d.right_error,
                d.best,
                d.best_error,
                d.exact.unwrap_or(f64::NAN),
                d.right_random,
                d.phi,
            ]
        });
        table.push_numbers(&[[*photons].as_slice(), &cells.concat()].concat());
    }
    let x: Vec<f64> = rows.iter().map(|row| row.0).collect();
    let y = |pick: &dyn Fn(&Row) -> f64| rows.iter().map(pick).collect::<Vec<f64>>();
    let mut figure = LineFigure::new(
        "How many materials are right, and how many do the photons allow?",
        Axis::log("photons of a pixel"),
        Axis::linear("right materials").range(0.0, 1.0),
    )
    .subtitle("A pixel is in a random state, or in the nearest state of one of the others; each as often.");
    let of_two = format!("{} and {}", TWO[0], TWO[1]);
    for (i, name) in [of_two.as_str(), "20 materials"].into_iter().enumerate() {
        let of = |row: &Row| if i == 0 { row.1 } else { row.2 };
        let (best, right) = (y(&|row| of(row).best), y(&|row| of(row).right));
        figure = figure
            .series(Series::line(format!("{name}: best decision"), x.clone(), best).colour(i))
            .series(Series::points(format!("{name}: found"), x.clone(), right).colour(i));
    }
    figure = figure
        .series(
            Series::line("20 materials, random pixels: Φ(d)", x.clone(), y(&|row| row.2.phi))
                .style(Style::Dotted)
                .colour(2),
        )
        .series(
            Series::points("20 materials, random pixels: found", x, y(&|row| row.2.right_random))
                .open()
                .colour(2),
        );
    Plot { name: "right_material".into(), figure: figure.into(), table }
}

pub(super) fn temperatures(rows: &[Read]) -> Plot {
    let mut table = Table::new([
        "photons",
        "right_and_within_limits",
        "right_and_held",
        "temperature_error_over_bound_rms",
        "coverage_95",
        "coverage_95_held",
        "temperature_rmse_k",
        "cramer_rao_rms_k",
    ]);
    for r in rows {
        let cells = [r.photons, r.open, r.held, r.over_bound, r.covered, r.covered_held, r.rmse_k, r.bound_k];
        table.push_numbers(&cells);
    }
    let x: Vec<f64> = rows.iter().map(|row| row.photons).collect();
    let y = |pick: fn(&Read) -> f64| rows.iter().map(pick).collect::<Vec<f64>>();
    let figure = LineFigure::new(
        "Temperatures against the Cramér–Rao bound",
        Axis::log("photons of a pixel"),
        Axis::linear("error over bound, rms").range(0.0, 1.2),
    )
    .subtitle("Random pixels of 20 materials whose material is right and whose state no limit holds.")
    .series(
        Series::line("error over its bound", x.clone(), y(|r| r.over_bound)).style(Style::Marked).colour(0),
    )
    .rule(Rule::horizontal(1.0, "bound"))
    .lower(
        Panel::new(Axis::linear("share of intervals that hold the truth").range(0.7, 1.0))
            .series(
                Series::line("95 % intervals", x.clone(), y(|r| r.covered)).style(Style::Marked).colour(1),
            )
            .series(
                Series::line("95 % intervals where a limit holds the state", x, y(|r| r.covered_held))
                    .style(Style::Marked)
                    .colour(2),
            )
            .rule(Rule::horizontal(0.95, "95 %")),
    );
    Plot { name: "temperature".into(), figure: figure.into(), table }
}
