//! The plots of ranging by air: errors over distance, the bias without sky, what each band tells, stereo beside it.

use crate::figures::{Plot, wavenumber_axis};
use crate::plot::{Axis, Band, LineFigure, Panel, Rule, Series, Style};
use crate::table::Table;
use crate::text::significant;
use crate::words::air_ranging::{one_reading, window, without_sky};
use hadar::words::length;
use hadar_study::air_ranging::{AirBand, AirPoint, AirRanging};

fn distance() -> Axis {
    Axis::log("distance (m)")
}

fn of(curve: &[AirPoint], what: impl Fn(&AirPoint) -> Option<f64>) -> Vec<f64> {
    curve.iter().map(|point| what(point).unwrap_or(f64::NAN)).collect()
}

/// The least error over distances, with less unknown, and estimates beside it.
#[must_use]
pub fn error_over_distance(result: &AirRanging) -> Plot {
    let curve = &result.curve;
    let x: Vec<f64> = curve.iter().map(|point| point.distance_m).collect();
    let columns = [
        ("bound, as asked", "sigma_m", Style::Line, 0, of(curve, |point| point.sigma_m)),
        (
            "emissivity known",
            "sigma_emissivity_known_m",
            Style::Dashed,
            1,
            of(curve, |point| point.sigma_emissivity_known_m),
        ),
        (
            "lighting known",
            "sigma_lighting_known_m",
            Style::Dotted,
            2,
            of(curve, |point| point.sigma_lighting_known_m),
        ),
        (
            "all else known",
            "sigma_others_known_m",
            Style::Line,
            3,
            of(curve, |point| point.sigma_others_known_m),
        ),
    ];
    let of_table = columns.iter().map(|column| (column.1, &column.4));
    let table = Table::of_columns(std::iter::once(("distance_m", &x)).chain(of_table));
    let name = &result.target;
    let mut figure = LineFigure::new(
        format!("How precisely can the distance of {name} be read from the air?"),
        distance(),
        Axis::log("error of the distance (m)"),
    )
    .subtitle(one_reading(result));
    for (label, _, style, colour, values) in columns {
        if values.iter().any(|value| value.is_finite()) {
            figure = figure.series(Series::line(label, x.clone(), values).style(style).colour(colour));
        }
    }
    figure = figure.series(Series::line("the distance itself", x.clone(), x).style(Style::Dotted).colour(6));
    if !result.witness.is_empty() {
        let at: Vec<f64> = result.witness.iter().map(|one| one.distance_m).collect();
        let rms = result.witness.iter().map(|one| one.errors.rmse).collect();
        figure = figure.series(Series::points("maximum likelihood, rms", at.clone(), rms).colour(0));
        let ratio = |what: &dyn Fn(usize) -> f64| (0..at.len()).map(what).collect::<Vec<f64>>();
        let low = ratio(&|i| result.witness[i].rmse_over_bound_interval.low);
        let high = ratio(&|i| result.witness[i].rmse_over_bound_interval.high);
        let value = ratio(&|i| result.witness[i].rmse_over_bound);
        figure = figure.lower(
            Panel::new(Axis::linear("rms over bound"))
                .band(Band::new("95 % interval", at.clone(), low, high).colour(0))
                .rule(Rule::horizontal(1.0, ""))
                .series(Series::points("", at, value).colour(0)),
        );
    }
    Plot { name: "error_over_distance".into(), figure: figure.into(), table }
}

/// What a model without sky finds too much, beside the bound; `None` where there is no sky.
#[must_use]
pub fn bias(result: &AirRanging) -> Option<Plot> {
    let curve = &result.curve;
    if curve.iter().all(|point| point.bias_without_sky_m.is_none()) {
        return None;
    }
    let x: Vec<f64> = curve.iter().map(|point| point.distance_m).collect();
    let inside = |edge: bool| {
        of(curve, |point| {
            point.bias_without_sky_m.filter(|_| point.without_sky_at_edge == edge).map(f64::abs)
        })
    };
    let (own, edge) = (inside(false), inside(true));
    let signed = of(curve, |point| point.bias_without_sky_m);
    let bound = of(curve, |point| point.sigma_m);
    let table = Table::of_columns([("distance_m", &x), ("bias_without_sky_m", &signed), ("sigma_m", &bound)]);
    let bound_shown = bound.clone();
    let mut figure = LineFigure::new(
        "What does a model lose that leaves out the sky?",
        distance(),
        Axis::log("error of the distance (m)"),
    )
    .subtitle(without_sky(&result.target))
    .series(Series::line("off, without sky", x.clone(), own).style(Style::Marked).colour(1))
    .series(Series::line("bound, with sky", x.clone(), bound).colour(0))
    .series(Series::line("the distance itself", x.clone(), x.clone()).style(Style::Dotted).colour(6));
    // The end of a search is no estimate: where there is none is shown, not a value.
    if edge.iter().any(|value| value.is_finite()) {
        let known = |values: &[f64]| values.iter().copied().filter(|v| v.is_finite()).collect::<Vec<f64>>();
        let drawn = [known(&bound_shown), known(&x)].concat();
        let low = drawn.iter().copied().fold(f64::INFINITY, f64::min);
        let high = drawn.iter().copied().fold(0.0, f64::max);
        let level = |end: f64| edge.iter().map(|e| if e.is_finite() { end } else { f64::NAN }).collect();
        figure = figure.band(Band::new(
            "no distance found without sky: the search ends at its shortest or longest",
            x,
            level(low),
            level(high),
        ));
    }
    Some(Plot { name: "bias_without_sky".into(), figure: figure.into(), table })
}

/// Shares below this are not drawn, percent.
const LEAST_SHARE: f64 = 1e-3;

/// What each band tells of the distance, with what the air does there.
#[must_use]
pub fn information(result: &AirRanging) -> Plot {
    let x: Vec<f64> = result.bands.iter().map(|band| band.center_cm1).collect();
    let shares = |what: &dyn Fn(&AirBand) -> f64| -> Vec<f64> {
        let total: f64 = result.bands.iter().map(what).sum();
        result
            .bands
            .iter()
            .map(|band| if total > 0.0 { 100.0 * what(band) / total } else { f64::NAN })
            .collect()
    };
    let known = shares(&|band| band.information_others_known_per_m2);
    let own = shares(&|band| band.information_per_m2);
    let label = |what: &str, sigma_m: Option<f64>| match sigma_m {
        Some(sigma_m) => format!("{what}, ± {} in all", length(sigma_m)),
        None => format!("{what}, none"),
    };
    let tau: Vec<f64> = result.bands.iter().map(|band| band.transmittance).collect();
    let table = Table::of_numbers(
        &result.bands,
        &[
            ("wavenumber_cm1", &|band| band.center_cm1),
            ("information_per_m2", &|band| band.information_per_m2),
            ("information_others_known_per_m2", &|band| band.information_others_known_per_m2),
            ("transmittance", &|band| band.transmittance),
            ("share_of_path", &|band| band.share_of_path),
            ("counts", &|band| band.counts),
        ],
    );
    let figure = LineFigure::new(
        format!(
            "Which bands hold the information on a distance of {} m?",
            significant(result.at.distance_m, 3)
        ),
        wavenumber_axis(&x),
        Axis::log("share of the information (%)").range(LEAST_SHARE, 100.0),
    )
    .subtitle(one_reading(result))
    .series(
        Series::line(label("all else known", result.at.sigma_others_known_m), x.clone(), known)
            .style(Style::Dashed)
            .colour(3),
    )
    .series(Series::line(label("as asked", result.at.sigma_m), x.clone(), own).colour(0))
    .lower(
        Panel::new(Axis::linear("transmittance of the air"))
            .series(Series::line("transmittance of the air", x, tau).colour(4)),
    );
    Plot { name: "information_by_band".into(), figure: figure.into(), table }
}

/// A window by air and by stereo; `None` without a second camera.
#[must_use]
pub fn stereo(result: &AirRanging) -> Option<Plot> {
    let spec = result.scenario.stereo?;
    let curve = &result.curve;
    let x: Vec<f64> = curve.iter().map(|point| point.distance_m).collect();
    let (air, stereo) = (of(curve, |point| point.sigma_window_m), of(curve, |point| point.sigma_stereo_m));
    let table = Table::of_columns([("distance_m", &x), ("sigma_air_m", &air), ("sigma_stereo_m", &stereo)]);
    let mut figure = LineFigure::new(
        "Ranging of a window: by the air and by stereo",
        distance(),
        Axis::log("error of the distance (m)"),
    )
    .subtitle(window(&spec, &result.target))
    .series(Series::line("air", x.clone(), air).colour(0))
    .series(Series::line("stereo", x, stereo).style(Style::Dashed).colour(1));
    if let Some(crossing) = result.stereo_crossing_m {
        figure = figure.rule(Rule::vertical(crossing, format!("{} m", significant(crossing, 2))));
    }
    Some(Plot { name: "stereo_against_air".into(), figure: figure.into(), table })
}
