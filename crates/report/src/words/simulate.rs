//! What a simulation found, as text.

pub(crate) mod average;
pub(crate) mod thermometry;

use crate::text::columns::{Columns, left, right};
use crate::text::footing::{assumptions, warnings};
use crate::text::numbers::{fixed, shortened, significant, some};
use crate::words::probability::percent;
use crate::words::safety;
use hadar_scenario::Units;
use hadar_study::{PhotonLaw, SimulatedPerformance, SimulatedPoint, Simulation, Standing, Study};
use std::fmt::Write as _;

/// Classes that are named in a sentence beside the target.
const NAMED: usize = 4;

/// Shares of photons whose interval ends above this are not printed.
const WIDEST_SHARE: f64 = 3.0;
/// Columns that a confusion matrix may take.
const MATRIX_WIDTH: usize = 64;
/// Experiments that are printed; of more the first, the last and some between.
const SHOWN: usize = 5;

/// The answer, the experiments, and what they rest on.
#[must_use]
pub fn text(result: &Simulation, study: &Study) -> String {
    let mut out = format!("{}\n\n", sentence(result));
    out.push_str(&safety::beside_draws(&result.safety));
    let points = &result.points;
    let shown = some(points.len(), SHOWN);
    if shown.len() < points.len() {
        let _ = writeln!(out, "{} of {} experiments; --out DIR has them all\n", shown.len(), points.len());
    }
    for i in shown {
        out.push_str(&experiment(&points[i], result, study.units()));
        out.push('\n');
    }
    if let [point] = points.as_slice() {
        out.push_str(&confusions(point));
    }
    let law = match result.photon_law {
        PhotonLaw::Poisson => "photons counted one by one (Poisson)",
        PhotonLaw::NegativeBinomial => "bunched photons of thermal light (negative binomial)",
        PhotonLaw::FixedTotal => "as many photons in every spectrum (multinomial)",
    };
    let noise = if result.camera_noise { ", and the camera's electronic noise" } else { "" };
    let drawn = if result.skipped_spectra {
        "the likelihood ratio itself, half as often for each class as there would be spectra".to_owned()
    } else {
        format!(
            "{} spectra of each class, a quarter for training, a quarter for validation, half for the test",
            result.spectra_per_class
        )
    };
    let error = result.points.iter().filter_map(|point| point.normal_error).fold(0.0, f64::max);
    let judged = if result.points.iter().any(|point| point.normal_error.is_some()) {
        format!("normal (distribution function off by at most {})", significant(error, 1))
    } else {
        result.judged_as.to_owned()
    };
    let _ = writeln!(
        out,
        "Drawn: {drawn};\n  {law}{noise}; likelihoods take counts to be {judged};\n  seed {}, {}\n",
        result.seed, result.generator
    );
    out.push_str(&assumptions(
        study,
        "equally likely classes in the states above; likelihoods of single bands multiply",
    ));
    out.push_str(&warnings(&result.warnings));
    out
}

/// The answer in a sentence.
fn sentence(result: &Simulation) -> String {
    let apart = pair(result);
    let all = || result.points.iter().flat_map(|point| &point.performances).map(|found| &found.performance);
    let Some(best) = all().max_by(|a, b| a.accuracy.total_cmp(&b.accuracy)) else { return String::new() };
    let often = format!(
        "{} of the cases ({} to {})",
        percent(best.accuracy),
        percent(best.interval.low),
        percent(best.interval.high)
    );
    let judged = result.points.first().map_or(0, |point| point.performances.len());
    let which = if judged == 1 { "the only one".to_owned() } else { format!("the best of {judged}") };
    let name = format!("{which} ({})", best.words());
    if result.comparisons == 0 {
        return format!("{name} distinguishes {apart} in {often}; there is no limit to compare it with.");
    }
    let beyond = of_standing(result, Standing::Beyond);
    if beyond > 0 {
        return format!(
            "The limit does not hold: {beyond} of {} times a classifier distinguished {apart} more often than it allows.",
            result.comparisons
        );
    }
    match result.points.as_slice() {
        [point] => {
            let limit = percent(point.limit_accuracy.unwrap_or(point.limit_accuracy_normal));
            format!(
                "No classifier beats the limit of {limit} by more than chance: {name} distinguishes {apart} in {often}."
            )
        }
        points => format!(
            "No classifier beats the limit by more than chance: none of {judged} at {} photon numbers distinguishes {apart} more \
             often than it allows.",
            points.len()
        ),
    }
}

fn of_standing(result: &Simulation, standing: Standing) -> usize {
    let all = result.points.iter().flat_map(|point| &point.performances);
    all.filter(|found| found.standing == Some(standing)).count()
}

/// One experiment as a table.
fn experiment(point: &SimulatedPoint, result: &Simulation, units: Units) -> String {
    let mut out = format!(
        "{} photons of the target{}: N d0^2 = {}, statistical distance {}\n",
        significant(point.photons, 3),
        if point.classes.len() > 2 { "; to the nearest of the others" } else { "" },
        significant(point.normalised_photons, 3),
        significant(point.statistical_distance, 3)
    );
    for class in &point.classes {
        let lighting: Vec<String> = class.lighting.iter().map(|v| format!("{v:.3}")).collect();
        let _ = writeln!(
            out,
            "  {:<16} {}, lighting {}, {} photons",
            class.material,
            units.temperature(class.temperature_k),
            lighting.join(", "),
            significant(class.photons, 4)
        );
    }
    let interval = format!("{} % interval", 100.0 * result.level);
    let mut table = Columns::narrow([
        left("classifier", 32),
        right("right", 8),
        left("", 0),
        left(&interval, 19),
        left("photons made use of", 22),
        left("against the limit", 0),
    ]);
    for found in &point.performances {
        let performance = &found.performance;
        let [low, high] = [performance.interval.low, performance.interval.high].map(percent);
        table.row([
            performance.words(),
            percent(performance.accuracy),
            String::new(),
            format!("{low} to {high}"),
            used(found),
            against(found, point),
        ]);
        if performance.confusion.unconverged > 0 {
            table.line(&format!("    {} fits stopped early", performance.confusion.unconverged));
        }
    }
    if let Some(limit) = point.limit_accuracy {
        table.row(["limit", &percent(limit), "", "computed, no spectrum drawn"]);
        table.row(["promised by the local distance", &percent(point.local_accuracy)]);
    } else if point.classes.len() == 2 {
        table.row(["limit", &percent(point.limit_accuracy_normal), "", "for many photons"]);
    }
    out + &table.text()
}

/// Which class is taken for which, in percent of the true one; nothing for more classes than fit a line.
fn confusions(point: &SimulatedPoint) -> String {
    let names = shortened(point.classes.iter().map(|class| class.material.as_str()));
    let width = names.width().max(9);
    if point.classes.len() * (width + 2) > MATRIX_WIDTH {
        return String::new();
    }
    let mut out =
        "Confusion: of the spectra of each true class (rows), % taken for each (columns)\n".to_owned();
    let _ = write!(out, "  {:<32} {:<width$}", "classifier", "true");
    for class in &point.classes {
        let _ = write!(out, "  {:>width$}", names.of(&class.material));
    }
    out.push('\n');
    for found in &point.performances {
        let confusion = &found.performance.confusion;
        for (i, (row, spectra)) in confusion.decisions.iter().zip(confusion.spectra()).enumerate() {
            let classifier = if i == 0 { found.performance.words() } else { String::new() };
            let name = point.classes.get(i).map_or("", |class| names.of(&class.material));
            let _ = write!(out, "  {classifier:<32} {name:<width$}");
            for decisions in row {
                let _ = write!(out, "  {:>width$.1}", 100.0 * decisions / spectra.max(1.0));
            }
            out.push('\n');
        }
    }
    out.push('\n');
    out
}

fn used(found: &SimulatedPerformance) -> String {
    match (found.photon_share, found.photon_share_low, found.photon_share_high) {
        // An interval as wide as that says nothing.
        (Some(share), Some(low), Some(high)) if high < WIDEST_SHARE => {
            let percent = |share: f64| format!("{:.0}", 100.0 * share);
            format!("{} % ({} to {})", percent(share), percent(low), percent(high))
        }
        _ => "-".to_owned(),
    }
}

fn against(found: &SimulatedPerformance, point: &SimulatedPoint) -> String {
    let limit = point.limit_accuracy.unwrap_or(point.limit_accuracy_normal);
    match found.standing {
        Some(Standing::Beyond) => "BEYOND the limit".to_owned(),
        Some(Standing::Reaches) => "reaches it".to_owned(),
        Some(Standing::Undecided) => "may reach it; more spectra would decide".to_owned(),
        Some(Standing::Below) => {
            format!("{} points below", fixed(100.0 * (limit - found.performance.accuracy), 1))
        }
        None => "-".to_owned(),
    }
}

pub(crate) fn pair(result: &Simulation) -> String {
    let classes = result.points.first().map(|point| point.classes.as_slice()).unwrap_or_default();
    match classes {
        [target, other] => format!("{} from {}", target.material, other.material),
        [target, others @ ..] if others.len() > NAMED => {
            format!("{} and {} others from each other", target.material, others.len())
        }
        [target, others @ ..] => {
            let names: Vec<&str> = others.iter().map(|class| class.material.as_str()).collect();
            format!("{}, {} from each other", target.material, names.join(", "))
        }
        [] => String::new(),
    }
}

/// The title of all classifiers over photons.
pub(crate) fn retrieved(pair: &str) -> String {
    format!("Distinguishing {pair}: what each classifier retrieves")
}
