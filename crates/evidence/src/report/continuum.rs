//! What bands of finite width cost: plot and text.

use crate::accuracy::{Continuum, GOOD, MaterialStep, Recommended};
use hadar::words::significant;
use hadar_report::figures::Plot;
use hadar_report::plot::{Axis, LineFigure, Rule, Series};
use hadar_report::table::{Table, markdown, number};

/// Error of the nearest distance over the step, pair by pair.
#[must_use]
pub fn continuum_plot(continuum: &Continuum) -> Plot {
    let mut figure = LineFigure::new(
        "What bands of finite width cost against the continuous spectrum",
        Axis::log("width of a band (cm⁻¹)"),
        Axis::log("relative error of the nearest distance"),
    )
    .subtitle("Target at 37 °C among surroundings at 20 °C, V = 0.5; temperature and lighting unknown; 714.5 to 1250.5 cm⁻¹.")
    .rule(Rule::horizontal(GOOD, "good enough"));
    let mut table = Table::new([
        "target",
        "alternative",
        "step_cm1",
        "error_radiance",
        "error_distance_local",
        "error_distance_nearest",
    ]);
    for pair in &continuum.recommended {
        if pair.drawn {
            let (x, y) = of(continuum, pair).map(|step| (step.step_cm1, step.error_nearest)).unzip();
            figure = figure.series(Series::line(format!("{} / {}", pair.target, pair.alternative), x, y));
        }
        for step in of(continuum, pair) {
            let mut row = vec![pair.target.clone(), pair.alternative.clone()];
            let numbers = [step.step_cm1, step.error_radiance, step.error_local, step.error_nearest];
            row.extend(numbers.map(number));
            table.push(row);
        }
    }
    Plot { name: "continuum".into(), figure: figure.into(), table }
}

/// The paper's step of 1 cm⁻¹, and the widest good one, pair by pair.
#[must_use]
pub fn continuum_text(continuum: &Continuum) -> String {
    let mut text = format!(
        "Bands against the continuous spectrum: errors of steps of 1 cm^-1, and the widest step whose nearest distance errs by less than {GOOD}\n\n"
    );
    let row = |pair: &Recommended| {
        let paper = of(continuum, pair).find(|step| (step.step_cm1 - 1.0).abs() < 1e-9);
        let errors = paper.map_or_else(Default::default, |step| {
            [step.error_radiance, step.error_local, step.error_nearest].map(|error| format!("{error:.0e}"))
        });
        let [radiance, local, nearest] = errors;
        let [target, alternative] = [&pair.target, &pair.alternative].map(String::clone);
        [target, alternative, radiance, local, nearest, step_in_words(pair.step_cm1)]
    };
    let head = [
        "target",
        "alternative",
        "photon radiance",
        "local distance",
        "nearest distance",
        "recommended step",
    ];
    let drawn = continuum.recommended.iter().filter(|pair| pair.drawn);
    text.push_str(&markdown(&head, drawn.map(row)));
    let others: Vec<&Recommended> = continuum.recommended.iter().filter(|pair| !pair.drawn).collect();
    let narrowest =
        others.iter().min_by(|a, b| a.step_cm1.unwrap_or(0.0).total_cmp(&b.step_cm1.unwrap_or(0.0)));
    if let Some(narrowest) = narrowest {
        let at_least = |step: f64| others.iter().filter(|pair| pair.step_cm1 >= Some(step)).count();
        text.push_str(&format!(
            "\nOf {} other materials against skin {} need no narrower steps than 4 cm^-1, {} none than 1 cm^-1; the most \
             demanding is {}: {}.\n",
            others.len(),
            at_least(3.99),
            at_least(0.99),
            narrowest.target,
            step_in_words(narrowest.step_cm1)
        ));
    }
    text
}

/// The steps of a pair.
fn of<'c>(continuum: &'c Continuum, pair: &'c Recommended) -> impl Iterator<Item = &'c MaterialStep> {
    let same = |step: &&MaterialStep| step.target == pair.target && step.alternative == pair.alternative;
    continuum.steps.iter().filter(same)
}

fn step_in_words(step_cm1: Option<f64>) -> String {
    step_cm1.map_or_else(|| "below 0.1 cm^-1".into(), |step| format!("{} cm^-1", significant(step, 2)))
}
