//! The pictures of the response's calibration.

use super::designs::Choice;
use super::shown::Shown;
use hadar_report::figures::Plot;
use hadar_report::plot::{Axis, Band, LineFigure, NamedSeries, NamedValues, Panel, Rule, Series, Style};
use hadar_report::table::{Table, number};

pub(super) fn all(shown: &Shown) -> [Plot; 5] {
    [response(shown), kernels(shown), directions(shown), over_noise(shown), choices(shown)]
}

fn bars(x: &[f64], low: &[f64], high: &[f64]) -> Series {
    let xs = x.iter().flat_map(|&x| [x, x, f64::NAN]).collect();
    let ys = low.iter().zip(high).flat_map(|(&low, &high)| [low, high, f64::NAN]).collect();
    Series::line("", xs, ys)
}

fn response(shown: &Shown) -> Plot {
    let nu = shown.twin.wheel.centres_cm1().to_vec();
    let (truth, typical) = (&shown.twin.response, shown.twin.prior.mean());
    let values = &shown.found.values;
    let sigma: Vec<f64> = (0..nu.len()).map(|j| shown.found.sigma(j)).collect();
    let mut table = Table::new(["wavenumber_cm1", "true", "typical", "estimated", "sigma_95"]);
    for j in 0..nu.len() {
        table.push_numbers(&[nu[j], truth[j], typical[j], values[j], 1.96 * sigma[j]]);
    }
    let edge = |sign: f64| -> Vec<f64> {
        values.iter().zip(&sigma).map(|(value, sigma)| value + sign * 1.96 * sigma).collect()
    };
    let off = |of: &[f64]| of.iter().zip(truth).map(|(a, b)| a - b).collect::<Vec<f64>>();
    let figure = LineFigure::new(
        "Response of a twin of prototype 1, calibrated by 31 blackbodies through 10 filters",
        Axis::linear("wavenumber (cm⁻¹)"),
        Axis::linear("response (peak of the typical curve: 1)"),
    )
    .subtitle(
        "Bars: 95 %, of the readings together with what is known of smooth curves about the typical one.",
    )
    .series(Series::line("true", nu.clone(), truth.clone()).colour(0))
    .series(Series::line("typical curve", nu.clone(), typical.to_vec()).style(Style::Dashed).colour(6))
    .series(Series::points("estimated", nu.clone(), values.clone()).colour(1))
    .series(bars(&nu, &edge(-1.0), &edge(1.0)).colour(1))
    .lower(
        Panel::new(Axis::linear("less the true one"))
            .series(Series::line("", nu.clone(), off(typical)).style(Style::Dashed).colour(6))
            .series(Series::points("", nu.clone(), off(values)).colour(1))
            .series(bars(&nu, &off(&edge(-1.0)), &off(&edge(1.0))).colour(1))
            .rule(Rule::horizontal(0.0, "")),
    );
    Plot { name: "response".into(), figure: figure.into(), table }
}

/// Kernels of these values are drawn.
const VALUES: [usize; 3] = [4, 14, 26];

fn kernels(shown: &Shown) -> Plot {
    let nu = shown.twin.wheel.centres_cm1().to_vec();
    let names = VALUES.map(|j| format!("estimate_at_{:.0}_cm1", nu[j]));
    let mut table = Table::new(std::iter::once("wavenumber_cm1".to_owned()).chain(names));
    let of = |j: usize| shown.uncertain.kernels.row(j).iter().copied().collect::<Vec<f64>>();
    for (i, nu) in nu.iter().enumerate() {
        let row: Vec<f64> = std::iter::once(*nu).chain(VALUES.map(|j| of(j)[i])).collect();
        table.push_numbers(&row);
    }
    let mut figure = LineFigure::new(
        "Which part of the true response does a value of the estimate see?",
        Axis::linear("wavenumber of the true response (cm⁻¹)"),
        Axis::linear("share (resolving kernel)"),
    )
    .subtitle("A value that is resolved has a share of 1 at its own wavenumber and of 0 elsewhere; values 25.7 cm⁻¹ apart.");
    for (colour, j) in VALUES.into_iter().enumerate() {
        let label = format!("estimate at {:.0} cm⁻¹", nu[j]);
        figure = figure.series(Series::line(label, nu.clone(), of(j)).style(Style::Marked).colour(colour));
    }
    Plot { name: "resolved".into(), figure: figure.into(), table }
}

/// What is unknown to more than this many peaks of the response is drawn at this level: how much is not told by the readings.
const UNKNOWN: f64 = 1e4;

/// A deviation beyond which rounding has a say is none.
pub(super) fn told(sigma: f64) -> f64 {
    if sigma < UNKNOWN { sigma } else { f64::NAN }
}

fn directions(shown: &Shown) -> Plot {
    let sigma = |d: &[f64]| d.iter().map(|d| told(1.0 / d)).collect::<Vec<f64>>();
    let (exact, uncertain) = (sigma(&shown.exact.singular), sigma(&shown.uncertain.singular));
    let mut table = Table::new(["direction", "sigma_exact_temperatures", "sigma"]);
    for i in 0..exact.len() {
        table.push_numbers(&[(i + 1) as f64, exact[i], uncertain[i]]);
    }
    let x: Vec<f64> = (1..=exact.len()).map(|i| i as f64).collect();
    let first = exact.iter().zip(&uncertain).position(|(a, b)| a.is_nan() && b.is_nan()).unwrap_or(x.len());
    let unknown = [first as f64 + 0.5, x.len() as f64 + 0.5];
    let beyond = exact.iter().chain(&uncertain).filter(|sigma| sigma.is_nan()).count();
    let figure = LineFigure::new(
        format!("How many values do the readings alone determine? {} of 30", shown.uncertain.number),
        Axis::linear("direction of the response, the best known first").range(0.0, x.len() as f64 + 1.0),
        Axis::log("σ of its coefficient (peak of the response: 1)").range(1e-5, 3.0 * UNKNOWN),
    )
    .subtitle(format!(
        "Singular values of the scores, inverted. Below the dashed line a direction is determined; shaded: {beyond} points that are not, to \
         10⁴ or more."
    ))
    .band(Band::new("no value: rounding has a say", unknown.to_vec(), vec![1e-5; 2], vec![3.0 * UNKNOWN; 2]))
    .series(Series::points("temperatures exact", x.clone(), exact).style(Style::Marked).colour(0))
    .series(Series::points("temperatures to 20 mK", x, uncertain).style(Style::Marked).colour(1))
    .rule(Rule::horizontal(0.1, "a tenth of the peak"));
    Plot { name: "directions".into(), figure: figure.into(), table }
}

fn over_noise(shown: &Shown) -> Plot {
    let mut table = Table::new([
        "sigma_mk",
        "determined_exact_temperatures",
        "determined",
        "effective_exact_temperatures",
        "effective",
    ]);
    for row in &shown.over_noise {
        table.push_numbers(&[50.0 * row[0], row[1], row[2], row[3], row[4]]);
    }
    let x: Vec<f64> = shown.over_noise.iter().map(|row| 50.0 * row[0]).collect();
    let of = |i: usize| shown.over_noise.iter().map(|row| row[i]).collect::<Vec<f64>>();
    let figure = LineFigure::new(
        "Less noise determines few values more",
        Axis::log("noise of a reading as temperature at 30 °C without a filter (mK)"),
        Axis::linear("values of 30").range(0.0, 30.0),
    )
    .subtitle("Determined: by the readings alone, to a tenth of the peak. Effective: by the readings where smoothness is known.")
    .series(Series::points("determined, temperatures exact", x.clone(), of(1)).style(Style::Marked).colour(0))
    .series(Series::points("determined, to 20 mK", x.clone(), of(2)).style(Style::Marked).colour(1))
    .series(Series::line("effective, temperatures exact", x.clone(), of(3)).style(Style::Dashed).colour(0))
    .series(Series::line("effective, to 20 mK", x, of(4)).style(Style::Dashed).colour(1));
    Plot { name: "number_over_noise".into(), figure: figure.into(), table }
}

fn choices(shown: &Shown) -> Plot {
    let names: Vec<String> = shown.choices.iter().map(|one| one.name.clone()).collect();
    let mut table = Table::new(["choice", "determined", "effective", "effective_exact_temperatures"]);
    let of = |pick: &dyn Fn(&Choice) -> f64| shown.choices.iter().map(pick).collect::<Vec<f64>>();
    let (determined, effective, exact) = (
        of(&|one| one.uncertain.number as f64),
        of(&|one| one.uncertain.effective),
        of(&|one| one.exact.effective),
    );
    for (i, name) in names.iter().enumerate() {
        let numbers = [determined[i], effective[i], exact[i]].map(number);
        table.push(std::iter::once(name.clone()).chain(numbers).collect());
    }
    let figure = NamedValues::new(
        "What other temperatures and filters would determine in the same time",
        names,
        Axis::linear("values of 30").range(0.0, 30.0),
    )
    .subtitle("Temperatures to 20 mK but where they are called exact. '10 filters' of the twin where nothing else is said.")
    .series(NamedSeries::new("determined", determined).colour(1))
    .series(NamedSeries::new("effective, with smoothness", effective).colour(2))
    .series(NamedSeries::new("effective, temperatures exact", exact).colour(0));
    Plot { name: "choices".into(), figure: figure.into(), table }
}
