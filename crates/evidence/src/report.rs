//! Run time against error: plots, tables and text of [`crate::accuracy`].

mod brute_force;
mod continuum;
mod skipping;
mod stress;
mod vectors;

pub use brute_force::{brute_force_table, brute_force_text};
pub use continuum::{continuum_plot, continuum_text};
pub use skipping::{skipping_table, skipping_text};
pub use stress::{stress_plots, stress_text};
pub use vectors::{vectors_bundle, vectors_text};

use crate::accuracy::{Chart, Measured, ROUNDED};
use hadar::words::{quantity, significant};
use hadar_report::figures::Plot;
use hadar_report::plot::{self, Axis, LineFigure, Marker, Series, Style};
use hadar_report::table::{self, Table, number, optional};

/// Errors are drawn down to this: exact to the last bit.
const FLOOR: f64 = 0.25 * ROUNDED;

/// A longer name of the error is not written along its axis, letters.
const LONGEST: usize = 40;

/// Error against time of every method, with the Pareto front and the default.
#[must_use]
pub fn plot(chart: &Chart) -> Plot {
    // What the error is of needs the room of a subtitle.
    let (short, long) = match chart.error.char_indices().nth(LONGEST) {
        Some(_) => ("error", format!(" Error: {}.", chart.error)),
        None => (chart.error, String::new()),
    };
    let mut figure = LineFigure::new(
        format!("{}: what accuracy costs how much time?", chart.title),
        Axis::log(format!("time of {} (s), one thread", chart.timed)),
        Axis::log(short),
    )
    .subtitle(
        format!(
            "{}Along a line: {}. Full symbols: the Pareto front{}, nothing is both faster and better. Reference: {}. Errors below {} \
             are drawn there: exact to the last bit.",
            if long.is_empty() { String::new() } else { format!("{} ", long.trim()) },
            chart.effort,
            if chart.questions().len() > 1 { " of each question" } else { "" },
            chart.reference,
            plot::number(FLOOR)
        )
        .replace("^-1", "⁻¹"),
    );
    let drawn = |measured: &Measured| (measured.seconds, measured.error.max(FLOOR));
    for (colour, method) in chart.methods().into_iter().enumerate() {
        let of = |on_front: Option<bool>| -> (Vec<f64>, Vec<f64>) {
            let all = chart.measured.iter().filter(|measured| measured.method == method);
            all.filter(|measured| on_front.is_none_or(|front| measured.on_front == front)).map(drawn).unzip()
        };
        let label = method.replace("^-1", "⁻¹");
        let (x, y) = of(None);
        figure = figure.series(Series::line(label, x, y).style(Style::Marked).open().colour(colour));
        // Filled where nothing else is both faster and more accurate.
        let (x, y) = of(Some(true));
        figure = figure.series(Series::points("", x, y).colour(colour));
    }
    for default in chart.defaults() {
        let (x, y) = drawn(default);
        // Many settings of one method would cover each other.
        if chart.defaults().count() <= 2 {
            figure = figure.marker(Marker::new("default", x, y));
        }
    }
    Plot { name: chart.name.into(), figure: figure.into(), table: table(std::slice::from_ref(chart)) }
}

/// All measurements.
#[must_use]
pub fn table(charts: &[Chart]) -> Table {
    let mut table = Table::new([
        "computation",
        "question",
        "method",
        "effort",
        "effort_is",
        "time_s",
        "time_of",
        "error",
        "reported_error",
        "default",
        "pareto_front",
    ]);
    for chart in charts {
        for measured in &chart.measured {
            let yes = |flag: bool| if flag { "yes" } else { "no" }.to_owned();
            table.push(vec![
                chart.name.into(),
                measured.question.clone().into_owned(),
                measured.method.clone().into_owned(),
                optional(measured.effort),
                chart.effort.into(),
                number(measured.seconds),
                chart.timed.into(),
                number(measured.error),
                optional(measured.reported),
                yes(measured.is_default),
                yes(measured.on_front),
            ]);
        }
    }
    table
}

/// The answer in a sentence, and the measurements.
#[must_use]
pub fn text(chart: &Chart) -> String {
    let mut text = format!("{}: {}\n", chart.title, verdict(chart));
    text.push_str(&format!("  time of {}; {}; {}\n", chart.timed, chart.error, chart.reference));
    let width = chart.methods().iter().map(|name| name.chars().count()).max().unwrap_or(0);
    for measured in &chart.measured {
        let effort = measured.effort.map_or_else(String::new, |effort| significant(effort, 3));
        let marks = match (measured.is_default, measured.on_front) {
            (true, true) => "  default, on the front",
            (true, false) => "  default",
            (false, true) => "  on the front",
            (false, false) => "",
        };
        text.push_str(&format!(
            "  {:width$}  {effort:>8}  {:>9}  {:>8}{marks}\n",
            measured.method,
            quantity(measured.seconds, "s"),
            error_of(measured.error),
        ));
    }
    if !chart.remark.is_empty() {
        text.push_str(&format!("  {}\n", chart.remark));
    }
    text
}

/// Whether the default is on the front.
#[must_use]
pub fn verdict(chart: &Chart) -> String {
    let (on, all) = chart.defaults().fold((0, 0), |(on, all), one| (on + usize::from(one.on_front), all + 1));
    match (on, all) {
        (_, 0) => "no default among these".into(),
        (1, 1) => "the default is on the Pareto front".into(),
        (0, 1) => "the default is not on the Pareto front".into(),
        _ => format!("the default is on the Pareto front in {on} of {all} settings"),
    }
}

/// A row for each default: what the README shows.
#[must_use]
pub fn markdown(charts: &[Chart]) -> String {
    let row = |chart: &Chart| {
        let defaults: Vec<&Measured> = chart.defaults().collect();
        // In the middle of the settings, where there are several.
        let shown = defaults.get(defaults.len() / 2)?;
        let other_as_good = |other: &&Measured| {
            other.question == shown.question
                && other.method != shown.method
                && other.error.max(ROUNDED) <= 2.0 * shown.error.max(ROUNDED)
        };
        let others = chart.measured.iter().filter(other_as_good);
        let rival = others.min_by(|a, b| a.seconds.total_cmp(&b.seconds)).map_or_else(
            || "none".into(),
            |rival| format!("{}: {}", rival.method, quantity(rival.seconds, "s")),
        );
        let of = if shown.question.is_empty() { String::new() } else { format!(", {}", shown.question) };
        Some([
            format!("{}{of}", chart.title),
            shown.method.clone().into_owned(),
            quantity(shown.seconds, "s"),
            error_of(shown.error),
            if shown.on_front { "yes" } else { "no" }.to_owned(),
            rival,
        ])
    };
    let head =
        ["computation", "default", "time of one", "true error", "on the front", "fastest other as good"];
    table::markdown(&head, charts.iter().filter_map(row))
}

fn error_of(error: f64) -> String {
    if error < FLOOR { "exact".into() } else { format!("{error:.0e}") }
}
