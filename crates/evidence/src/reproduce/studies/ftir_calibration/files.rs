//! Tables and pictures.

use super::choice::EmissivityError;
use super::shown::{Plane, SURROUNDINGS_K, Shown, TEMPERATURE_ERROR_K, WANTED_K};
use hadar_report::figures::Plot;
use hadar_report::plot::{Axis, HeatMap, LineFigure, Marker, Series, Style};
use hadar_report::table::{Table, number};

pub(super) fn coverage(shown: &Shown) -> Table {
    let mut table =
        Table::new(["blackbodies_k", "temperature_errors_k", "quantity", "coverage", "deviation"]);
    let list = |values: &[f64]| values.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
    for held in &shown.held {
        let c = held.coverage;
        for (name, one) in [
            ("response", c.response),
            ("offset", c.offset),
            ("radiance", c.radiance),
            ("emissivity", c.emissivity),
            ("surroundings", c.surroundings),
        ] {
            table.push(vec![
                list(held.blackbodies_k),
                list(held.errors_k),
                name.into(),
                number(one.share),
                number(one.sigma),
            ]);
        }
    }
    table
}

pub(super) fn best(shown: &Shown) -> Table {
    let mut table = Table::new([
        "lowest_allowed_k",
        "highest_allowed_k",
        "settings",
        "temperatures_k",
        "error_k",
        "by_noise_k",
        "by_temperatures_k",
    ]);
    for best in &shown.best {
        let settings = best.temperatures_k.len();
        let list = best.temperatures_k.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
        let [a, b] = best.within_k.map(number);
        let error = [best.error.total_k(), best.error.noise_k, best.error.temperature_k].map(number);
        table.push([a, b, settings.to_string(), list].into_iter().chain(error).collect());
    }
    table
}

/// Rows of a plane: both temperatures, then numbers.
fn rows<T: Copy>(table: &mut Table, plane: &Plane<T>, of: impl Fn(T) -> Vec<f64>) {
    let n = plane.axis_k.len();
    for (i, error) in plane.errors.iter().enumerate() {
        if let Some(error) = error {
            let first = vec![plane.axis_k[i % n], plane.axis_k[i / n]];
            table.push_numbers(&[first, of(*error)].concat());
        }
    }
}

pub(super) fn pairs(shown: &Shown) -> Plot {
    let plane = &shown.pairs;
    let mut table = Table::new(["colder_k", "warmer_k", "error_k", "by_noise_k", "by_temperatures_k"]);
    rows(&mut table, plane, |e| vec![e.total_k(), e.noise_k, e.temperature_k]);
    let values = plane.errors.iter().map(|e| e.map_or(f64::NAN, |e| 1e3 * e.total_k())).collect();
    let mut figure = HeatMap::new(
        "Which two blackbodies calibrate best?",
        (Axis::linear("colder blackbody (K)"), plane.axis_k.clone()),
        (Axis::linear("warmer blackbody (K)"), plane.axis_k.clone()),
        (Axis::log("error of a calibrated radiance (mK)").range(10.0, 1000.0), values),
    )
    .subtitle(format!(
        "Root mean square over scenes of 270 to 320 K and 71 channels; blackbodies to {:.0} mK, noise of 30 mK a reading, 64 readings in all.",
        1e3 * TEMPERATURE_ERROR_K
    ))
    .no_value("the same temperature, or the colder one warmer")
    .contours(vec![25.0, 30.0, 50.0, 100.0]);
    if let Some((x, y, _)) = plane.least(0.0, |e| e.total_k()) {
        figure = figure.marker(Marker::new("best", x, y));
    }
    if let Some((x, y, _)) = plane.least(300.0, |e| e.total_k()) {
        figure = figure.marker(Marker::new("best without a cooler", x, y));
    }
    Plot { name: "blackbodies".into(), figure: figure.into(), table }
}

pub(super) fn surface(shown: &Shown) -> Plot {
    let plane = &shown.surface;
    let mut table = Table::new([
        "colder_k",
        "warmer_k",
        "error",
        "by_noise",
        "by_temperatures",
        "by_change_of_emissivity",
    ]);
    rows(&mut table, plane, |e| vec![e.total(), e.noise, e.temperature, e.bias]);
    let values = plane.errors.iter().map(|e| e.map_or(f64::NAN, |e| e.total())).collect();
    let mut figure = HeatMap::new(
        "Which two temperatures of a surface determine its emissivity best?",
        (Axis::linear("temperature of the colder reading (K)"), plane.axis_k.clone()),
        (Axis::linear("temperature of the warmer reading (K)"), plane.axis_k.clone()),
        (Axis::log("error of the emissivity (1)").range(1e-3, 0.02), values),
    )
    .subtitle(format!(
        "Emissivity 0.9, wanted at {WANTED_K} K, changing by 1e-4 per K, under surroundings at {SURROUNDINGS_K} K. Noise, temperatures and \
         change together."
    ))
    .no_value("the same temperature, or the colder one warmer")
    .contours(vec![1e-3, 2e-3, 5e-3, 1e-2]);
    if let Some((x, y, _)) = plane.least(0.0, |e| e.total()) {
        figure = figure.marker(Marker::new("best", x, y));
    }
    if let Some((x, y, _)) = plane.least(300.0, |e| e.total()) {
        figure = figure.marker(Marker::new("best above 300 K", x, y));
    }
    Plot { name: "surface".into(), figure: figure.into(), table }
}

pub(super) fn spacing(shown: &Shown) -> Plot {
    let mut table =
        Table::new(["apart_k", "by_noise", "by_temperatures", "by_change_of_emissivity", "error"]);
    for (apart, e) in &shown.spacing {
        table.push_numbers(&[*apart, e.noise, e.temperature, e.bias, e.total()]);
    }
    let x: Vec<f64> = shown.spacing.iter().map(|one| one.0).collect();
    let of = |pick: &dyn Fn(&EmissivityError) -> f64| {
        shown.spacing.iter().map(|one| pick(&one.1)).collect::<Vec<f64>>()
    };
    let figure = LineFigure::new(
        "Two temperatures close to each other do not take the change of the emissivity away",
        Axis::log("distance of the two temperatures (K)"),
        Axis::log("error of the emissivity"),
    )
    .subtitle(format!(
        "About {WANTED_K} K, under surroundings at {SURROUNDINGS_K} K, emissivity 0.9, changing by 1e-4 per K."
    ))
    .series(Series::line("noise", x.clone(), of(&|e| e.noise)).style(Style::Marked).colour(0))
    .series(Series::line("temperatures", x.clone(), of(&|e| e.temperature)).style(Style::Marked).colour(2))
    .series(Series::line("change of the emissivity", x.clone(), of(&|e| e.bias)).style(Style::Marked).colour(1))
    .series(Series::line("together", x, of(&|e| e.total())).style(Style::Dashed).colour(6));
    Plot { name: "spacing".into(), figure: figure.into(), table }
}
