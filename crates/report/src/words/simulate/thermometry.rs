//! Thermometry as text for people.

use crate::simulate::thermometry::rows::{decisive, rising};
use crate::text::columns::{Columns, right};
use crate::text::numbers::in_a_row;
use crate::text::significant;
use crate::words::Say;
use hadar::fisher::Nuisance;
use hadar::fisher::precision::Sight;
use hadar::words::fixed;
use hadar_scenario::Units;
use hadar_simulate::efficiency::{Errors, Verdict};
use hadar_simulate::sequential::Interval;
use hadar_study::{Reader, Thermometry, ThermometryRow};
use std::fmt::Write as _;

/// Without the sign of a number whose digits are all 0.
fn unsigned_zero(number: String) -> String {
    match number.strip_prefix('-') {
        Some(zero) if !zero.contains(|c: char| ('1'..='9').contains(&c)) => zero.to_owned(),
        _ => number,
    }
}

fn decimal(value: f64, decimals: usize) -> String {
    unsigned_zero(fixed(value, decimals))
}

fn degrees(temperature_k: f64, decimals: usize, units: Units) -> String {
    decimal(units.temperature_number(temperature_k), decimals)
}

/// Three digits at most, of which the last is no finer than a tenth of half the interval.
fn trusted(value: f64, interval: Interval) -> String {
    let half = 0.5 * (interval.high - interval.low);
    if !(half > 0.0 && half.is_finite() && value.is_finite()) {
        return unsigned_zero(significant(value, 3));
    }
    let tenth = half.log10().floor() as i32 - 1;
    let digits = if value == 0.0 { 1 } else { value.abs().log10().floor() as i32 - tenth + 1 };
    match usize::try_from(digits) {
        Ok(digits @ 1..) => unsigned_zero(significant(value, digits.min(3))),
        // All of it is less than what the last digit may be off by.
        _ => "0".into(),
    }
}

/// A ratio and its interval, each to the decimals that the distance of its own end, or the nearer one, allows.
fn trusted_ratio(ratio: f64, Interval { low, high }: Interval) -> String {
    let show = |x: f64, width: f64| match x {
        x if x.abs() >= 1e5 => significant(x, 2),
        x if x.abs() >= 10.0 => decimal(x, 0),
        x if width > 0.0 => decimal(x, (1 - width.log10().floor() as i32).clamp(0, 3) as usize),
        x => decimal(x, 3),
    };
    let (below, above) = (ratio - low, high - ratio);
    format!("{} [{}, {}]", show(ratio, below.min(above)), show(low, below), show(high, above))
}

/// Least and largest of some numbers in words.
fn span(values: &[f64], unit: &str, show: impl Fn(f64) -> String) -> String {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let (least, most) = (show(low), show(high));
    if least == most { format!("{least} {unit}") } else { format!("{least} to {most} {unit}") }
}

/// The answer in a sentence, then the numbers, then what they rest on.
#[must_use]
pub fn text(result: &Thermometry) -> String {
    let rows = rising(result);
    let units = result.units;
    let two = rows.iter().any(|row| row.lighting_unknown.is_some());
    let mut out = headline(result, &rows);
    out.push_str(
        "\n\nRoot mean squared error in K (bound; variance over that of the bound with its interval)\n",
    );
    let known = if result.environment_k.is_empty() { "maximum likelihood" } else { "lighting known" };
    let columns = [right(units.temperature_unit(), 8), right(known, 34)].into_iter();
    let columns = columns.chain(two.then(|| right("lighting unknown", 34)));
    let mut table = Columns::new(columns.chain([right("e fixed", 9), right("e manual", 9)]));
    for row in &rows {
        let imager =
            |errors: Option<Errors>| errors.map_or("none".into(), |e| trusted(e.bias, e.bias_interval));
        let mut cells = vec![degrees(row.temperature_k, 2, units), reader(&row.lighting_known)];
        cells.extend(two.then(|| row.lighting_unknown.as_ref().map_or_else(String::new, reader)));
        cells.extend([imager(row.fixed.errors), imager(row.manual.errors)]);
        table.row(cells);
    }
    out.push_str(&table.text());
    out.push_str("  Last two columns: mean error of thermal imaging, K.\n\nAssumptions\n");
    for assumption in assumptions(result) {
        let _ = writeln!(out, "  {assumption}");
    }
    if !result.warnings.is_empty() {
        out.push_str("\nWarnings\n");
        for warning in &result.warnings {
            let _ = writeln!(out, "  {} [{}]", warning.say(), warning.code().name());
        }
    }
    out
}

fn assumptions(result: &Thermometry) -> Vec<String> {
    let shown = |kelvin| format!("{} {}", degrees(kelvin, 2, result.units), result.units.temperature_unit());
    let environment: Vec<String> = (result.environment_k.iter().zip(&result.lighting))
        .map(|(t, v)| format!("{} with lighting {}", shown(*t), unsigned_zero(significant(*v, 3))))
        .collect();
    let bare = environment.is_empty();
    let is_unknown = |nuisance: Nuisance| result.unknown.contains(&nuisance.name());
    let mut known = vec!["emissivity"];
    if !bare && !is_unknown(Nuisance::EnvironmentTemperature) {
        known.push("temperature of the surroundings");
    }
    if !bare && !is_unknown(Nuisance::Lighting) {
        known.push("lighting");
    }
    if !is_unknown(Nuisance::Gain) {
        known.push("the camera's response");
    }
    let mut unknown = result.unknown.join(", ");
    if let Some(total) = result.lighting_total {
        let _ = write!(unknown, "; the lighting factors are known to sum to {total}");
    }
    let mut lines = vec![
        format!(
            "surroundings {}",
            if bare { "without radiation".to_owned() } else { environment.join(", ") }
        ),
        format!("known: {}; unknown: {unknown}", in_a_row(&known, "and")),
    ];
    if is_unknown(Nuisance::Lighting) {
        lines.push("the reader with the lighting known differs in that alone".into());
    }
    if !result.priors.is_empty() {
        let priors = result.priors.iter().map(|(name, sigma)| {
            let unit = if name.contains("temperature") { " K" } else { "" };
            format!("{name} to +- {sigma}{unit}")
        });
        lines.push(format!(
            "known beforehand, which lowers the bound: {} (with an independent error of that deviation in every spectrum)",
            priors.collect::<Vec<_>>().join(", ")
        ));
    }
    lines.push(format!(
        "{} spectra at each temperature: photons counted one by one{}; likelihoods take counts to be {}; seed {} ({})",
        result.trials,
        if result.statistics == "poisson" { "" } else { " with the camera's electronic noise" },
        result.statistics,
        result.seed,
        result.generator
    ));
    let level = significant(100.0 * result.criteria.level, 3);
    lines.push(match result.criteria.together {
        1 => format!("intervals and the verdict at {level} %"),
        together => {
            format!("intervals at {level} %; the {together} verdicts are right all together at that level")
        }
    });
    lines.push(format!(
        "imaging with emissivity {}: black surroundings at {} all around are subtracted",
        result.fixed.emissivity,
        result.fixed.reflected_k.map_or("no temperature".to_owned(), shown)
    ));
    lines.push(format!(
        "imaging with emissivity {} by hand: right at {}, nothing subtracted",
        significant(result.manual.emissivity, 4),
        shown(result.calibrated_k)
    ));
    lines
}

fn headline(result: &Thermometry, rows: &[&ThermometryRow]) -> String {
    let worst = |imager: &dyn Fn(&ThermometryRow) -> Option<Errors>| {
        let biases = rows.iter().filter_map(|row| imager(row)).map(|errors| errors.bias.abs());
        let worst =
            biases.fold(None, |worst: Option<f64>, bias| Some(worst.map_or(bias, |worst| worst.max(bias))));
        worst.map_or("nothing it can read".into(), |k| format!("{} K", significant(k, 2)))
    };
    format!(
        "{} Thermal imaging of the same counts is off by up to {} with emissivity {}, and by up to {} with one entered \
         by hand.",
        likelihood(result, rows),
        worst(&|row| row.fixed.errors),
        result.fixed.emissivity,
        worst(&|row| row.manual.errors),
    )
}

/// What maximum likelihood does, in one or two sentences.
fn likelihood(result: &Thermometry, rows: &[&ThermometryRow]) -> String {
    let temperatures: Vec<f64> = rows.iter().map(|row| row.temperature_k).collect();
    // The relative error of a root mean square is about 1/sqrt(2n).
    let digits = if result.trials < 20 { 1 } else { 2 + usize::from(result.trials >= 5000) };
    let kelvin = |readers: &[&Reader]| {
        let errors: Vec<f64> = readers.iter().map(|reader| reader.errors.rmse).collect();
        span(&errors, "K", |k| significant(k, digits))
    };
    let at = span(&temperatures, result.units.temperature_unit(), |k| degrees(k, 1, result.units));
    let own: Vec<&Reader> = rows.iter().map(|row| decisive(row)).collect();
    let unknown = rows.iter().any(|row| row.lighting_unknown.is_some());
    let seen: Vec<&Reader> = own.iter().copied().filter(|reader| reader.sight == Sight::Seen).collect();
    if seen.is_empty() {
        let known: Vec<&Reader> =
            rows.iter().map(|row| &row.lighting_known).filter(|reader| reader.sight == Sight::Seen).collect();
        let mut out = "A spectrum in these bands holds no information on the temperature.".to_owned();
        if own.iter().all(|reader| reader.sight == Sight::Imitated) {
            out.push_str(" The other unknowns imitate all that it changes.");
        }
        if unknown && !known.is_empty() {
            let _ = write!(
                out,
                " With the lighting known, {} would read {} at {at} with errors of {} (root mean square).",
                result.camera,
                result.target,
                kelvin(&known)
            );
        }
        return out;
    }
    let lighting = match (unknown, result.environment_k.is_empty()) {
        (true, _) => ", its lighting unknown,",
        (false, false) => ", its lighting known,",
        (false, true) => "",
    };
    format!(
        "{} reads {} at {at}{lighting} with errors of {} (root mean square): {}.",
        result.camera,
        result.target,
        kelvin(&seen),
        standing(&own, unknown)
    )
}

/// How the fits stand to their bounds, and at how many temperatures.
fn standing(readers: &[&Reader], lighting_unknown: bool) -> String {
    let of = format!("of {} temperatures", readers.len());
    let (seen, unseen): (Vec<&Reader>, Vec<&Reader>) =
        readers.iter().copied().partition(|reader| reader.sight == Sight::Seen);
    let (free, held): (Vec<&Reader>, Vec<&Reader>) =
        seen.iter().copied().partition(|reader| reader.bound_applies);
    let verdicts = [Verdict::Reaches, Verdict::Undecided, Verdict::Biased, Verdict::Exceeds, Verdict::Below];
    let mut clauses: Vec<String> = verdicts
        .into_iter()
        .filter_map(|verdict| {
            let own = free.iter().filter(|reader| reader.efficiency.is_some_and(|e| e.verdict == verdict));
            let count = own.count();
            let what = match verdict {
                Verdict::Reaches => "reaches the Cramer-Rao bound",
                Verdict::Undecided => "is too close to the Cramer-Rao bound to say more with so few spectra",
                Verdict::Biased => "has the variance of the Cramer-Rao bound but a bias",
                Verdict::Exceeds => "exceeds the Cramer-Rao bound",
                Verdict::Below => "is below the Cramer-Rao bound, as only biased estimates can be,",
            };
            (count > 0).then(|| format!("maximum likelihood {what} at {count} {of}"))
        })
        .collect();
    if !held.is_empty() {
        let shares: Vec<f64> = held.iter().map(|reader| 100.0 * reader.at_edge).collect();
        clauses.push(format!(
            "the range of the {} stops {} of the fits at {} {of}, so the Cramer-Rao bound, which is for unbiased estimates, \
             does not apply there",
            if lighting_unknown { "lighting" } else { "temperature" },
            span(&shares, "%", |share| significant(share, 2)),
            held.len()
        ));
    }
    if !unseen.is_empty() {
        clauses.push(format!("a spectrum holds no information on the temperature at {} {of}", unseen.len()));
    }
    clauses.join("; ")
}

fn reader(reader: &Reader) -> String {
    let rmse = trusted(reader.errors.rmse, reader.errors.rmse_interval);
    match (reader.bound_k, reader.efficiency) {
        (Some(bound), Some(found)) => {
            let mark = if found.verdict == Verdict::Below { " below" } else { "" };
            format!(
                "{rmse} ({}; {}{mark})",
                significant(bound, 3),
                trusted_ratio(found.ratio, found.ratio_interval)
            )
        }
        _ => format!("{rmse} (no bound)"),
    }
}

/// Below the mean errors.
pub(crate) fn errors(result: &Thermometry) -> String {
    format!(
        "{}, emissivity known to maximum likelihood. Below: maximum likelihood alone. Manual emissivity {} is calibrated at {:.1} °C.",
        of_each(result),
        significant(result.manual.emissivity, 3),
        result.calibrated_k - 273.15
    )
}

/// Below the errors and their bounds; `held` says that the range of the lighting stops some fits.
pub(crate) fn bounds(result: &Thermometry, held: bool) -> String {
    let held = match held {
        true => {
            " Estimates that the range of the lighting holds are biased, and can err less than the bound for unknown lighting: \
             to them the dotted one applies, for the error averaged over that range."
        }
        false => "",
    };
    format!("{}. Bounds are Cramér-Rao's, for unbiased estimates.{held}", of_each(result))
}

fn of_each(result: &Thermometry) -> String {
    format!("{}, {} spectra at each temperature", result.camera, result.trials)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No sign before 0, and no digit that the interval does not carry.
    #[test]
    fn numbers_have_the_digits_they_deserve() {
        assert_eq!(
            ["-0.0", "-0", "-0.01", "-1e-20"].map(|x| unsigned_zero(x.into())),
            ["0.0", "0", "-0.01", "-1e-20"]
        );
        let degrees = |kelvin| degrees(kelvin, 1, Units::default());
        assert_eq!((degrees(273.149), degrees(273.05)), ("0.0".into(), "-0.1".into()));
        let interval = |low, high| Interval { low, high };
        assert_eq!(trusted_ratio(0.50912, interval(0.1012, 518.723)), "0.51 [0.10, 519]");
        assert_eq!(trusted_ratio(1.0123, interval(0.9861, 1.0398)), "1.012 [0.986, 1.040]");
        assert_eq!(trusted_ratio(0.0063, interval(0.0012, 5.616)), "0.006 [0.001, 5.6]");
        assert_eq!(trusted_ratio(1234.5, interval(900.4, 1.7e6)), "1234 [900, 1.7e6]");
        assert_eq!(trusted(-3.1433, interval(-3.4, -2.9)), "-3.14");
        assert_eq!(trusted(-3.1433, interval(-6.0, 0.0)), "-3.1");
        assert_eq!(
            (trusted(1.2e-4, interval(-0.5, 0.5)), trusted(-0.0, interval(0.0, 0.0))),
            ("0".into(), "0".into())
        );
    }
}
