//! Thermometry as text for people.

use super::{decisive, rising};
use crate::report::text::significant;
use crate::simulate::efficiency::{Errors, Verdict};
use crate::study::{Reader, Thermometry, ThermometryRow};
use std::fmt::Write as _;

/// Least and largest of some numbers in words; nothing if there are none.
fn span(values: &[f64], unit: &str) -> String {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let (least, most) = (significant(low, 3), significant(high, 3));
    if least == most { format!("{least} {unit}") } else { format!("{least} to {most} {unit}") }
}

/// The answer in a sentence, then the numbers, then what they rest on.
#[must_use]
pub fn text(result: &Thermometry) -> String {
    let rows = rising(result);
    let mut out = headline(result, &rows);
    out.push_str(
        "\n\nRoot mean squared error in K (bound; variance over that of the bound with its interval)\n",
    );
    let _ = writeln!(
        out,
        "  {:>8}  {:>34}  {:>34}  {:>9}  {:>9}",
        "degC", "lighting known", "lighting unknown", "e fixed", "e manual"
    );
    for row in &rows {
        let imager = |errors: Option<Errors>| errors.map_or("none".into(), |e| significant(e.bias, 3));
        let _ = writeln!(
            out,
            "  {:>8.2}  {:>34}  {:>34}  {:>9}  {:>9}",
            row.temperature_k - 273.15,
            reader(&row.lighting_known),
            row.lighting_unknown.as_ref().map_or_else(String::new, reader),
            imager(row.fixed.errors),
            imager(row.manual.errors),
        );
    }
    out.push_str("  Last two columns: mean error of thermal imaging, K.\n\nAssumptions\n");
    let environment: Vec<String> = (result.environment_k.iter().zip(&result.lighting))
        .map(|(t, v)| format!("{:.2} degC with lighting {}", t - 273.15, significant(*v, 3)))
        .collect();
    let mut line = |text: String| {
        let _ = writeln!(out, "  {text}");
    };
    line(format!(
        "surroundings {}; their temperature, the emissivity and the camera's response are known",
        if environment.is_empty() { "without radiation".to_owned() } else { environment.join(", ") }
    ));
    line(format!(
        "{} spectra at each temperature: photons counted one by one{}; likelihoods take counts to be {}; seed {} ({})",
        result.trials,
        if result.statistics == "poisson" { "" } else { " with the camera's electronic noise" },
        result.statistics,
        result.seed,
        result.generator
    ));
    line(format!(
        "intervals at {} %; the {} verdicts are right all together at that level",
        significant(100.0 * result.criteria.level, 3),
        result.criteria.together
    ));
    line(format!(
        "imaging with emissivity {}: black surroundings at {} all around are subtracted",
        result.fixed.emissivity,
        result.fixed.reflected_k.map_or("no temperature".to_owned(), |t| format!("{:.2} degC", t - 273.15))
    ));
    line(format!(
        "imaging with emissivity {} by hand: right at {:.2} degC, nothing subtracted",
        significant(result.manual.emissivity, 4),
        result.calibrated_k - 273.15
    ));
    if !result.warnings.is_empty() {
        out.push_str("\nWarnings\n");
        for warning in &result.warnings {
            let _ = writeln!(out, "  {} [{}]", warning.message, warning.code);
        }
    }
    out
}

fn headline(result: &Thermometry, rows: &[&ThermometryRow]) -> String {
    let celsius: Vec<f64> = rows.iter().map(|row| row.temperature_k - 273.15).collect();
    let own: Vec<f64> = rows.iter().map(|row| decisive(row).errors.rmse).collect();
    let count = |verdict: Verdict| {
        let own = rows.iter().map(|row| decisive(row)).filter(|reader| reader.bound_applies);
        own.filter(|reader| reader.efficiency.is_some_and(|e| e.verdict == verdict)).count()
    };
    let held = rows.iter().filter(|row| !decisive(row).bound_applies).count();
    let mut verdicts: Vec<String> =
        [Verdict::Reaches, Verdict::Undecided, Verdict::Biased, Verdict::Exceeds, Verdict::Below]
            .into_iter()
            .filter(|verdict| count(*verdict) > 0)
            .map(|verdict| {
                let what = match verdict {
                    Verdict::Reaches => "reaches the Cramer-Rao bound",
                    Verdict::Undecided => "is too close to it to say with so few trials",
                    Verdict::Biased => "is biased",
                    Verdict::Exceeds => "exceeds the Cramer-Rao bound",
                    Verdict::Below => "is below the Cramer-Rao bound, as only a biased estimate can be,",
                };
                format!("{what} at {} of {} temperatures", count(verdict), rows.len())
            })
            .collect();
    if held > 0 {
        let what = "is held by the range of the lighting, where that bound does not apply,";
        verdicts.push(format!("{what} at {held} of {} temperatures", rows.len()));
    }
    let verdicts = if verdicts.is_empty() { "has no bound to reach".to_owned() } else { verdicts.join(", ") };
    let worst = |imager: &dyn Fn(&ThermometryRow) -> Option<Errors>| {
        let biases = rows.iter().filter_map(|row| imager(row)).map(|errors| errors.bias.abs());
        biases.fold(None, |worst: Option<f64>, bias| Some(worst.map_or(bias, |worst| worst.max(bias))))
    };
    let off = |worst: Option<f64>| {
        worst.map_or("nothing it can read".into(), |k| format!("{} K", significant(k, 2)))
    };
    let lighting =
        if rows.iter().any(|row| row.lighting_unknown.is_some()) { ", its lighting unknown," } else { "" };
    format!(
        "{} reads {} at {}{lighting} to {} (root mean squared error): maximum likelihood {verdicts}. Thermal imaging of the \
         same counts is off by up to {} with emissivity {}, and by up to {} with one entered by hand.",
        result.camera,
        result.target,
        span(&celsius, "degC"),
        span(&own, "K"),
        off(worst(&|row| row.fixed.errors)),
        result.fixed.emissivity,
        off(worst(&|row| row.manual.errors)),
    )
}

fn reader(reader: &Reader) -> String {
    let rmse = significant(reader.errors.rmse, 3);
    match (reader.bound_k, reader.efficiency) {
        (Some(bound), Some(found)) => format!(
            "{rmse} ({}; {:.3} [{:.3}, {:.3}])",
            significant(bound, 3),
            found.ratio,
            found.ratio_interval.low,
            found.ratio_interval.high
        ),
        _ => format!("{rmse} (no bound)"),
    }
}
