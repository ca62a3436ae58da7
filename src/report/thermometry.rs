//! Thermometry against its bound: table, two plots and text.

use super::bundle::Bundle;
use super::figures::Plot;
use super::plot::{Axis, Band, LineFigure, Panel, Rule, Series, Style};
use super::table::{Table, number, optional};
use super::tables;
use super::text::significant;
use crate::error::Result;
use crate::simulate::efficiency::{Errors, Verdict};
use crate::study::{Reader, Study, Thermometry, ThermometryRow};
use std::fmt::Write as _;
use std::path::Path;

/// All files; paths in the scenario are written relative to `out` where they lie below it.
///
/// # Errors
/// A figure that cannot be drawn.
pub fn bundle(study: &Study, result: &Thermometry, out: &Path) -> Result<Bundle> {
    let mut bundle = Bundle::default();
    bundle.add("scenario.toml", study.scenario().to_toml_beside(out));
    bundle.add("thermometry.csv", table(result).to_csv()?);
    bundle.add("warnings.csv", tables::warnings(&result.warnings).to_csv()?);
    bundle.add_plots(&[errors(result), rmse(result)])?;
    Ok(bundle)
}

/// The reader that stands for what a spectrum tells: lighting unknown where there are surroundings.
fn decisive(row: &ThermometryRow) -> &Reader {
    row.lighting_unknown.as_ref().unwrap_or(&row.lighting_known)
}

/// Everything, a row for every true temperature.
#[must_use]
pub fn table(result: &Thermometry) -> Table {
    let mut header = vec!["temperature_k".to_owned(), "photons".into()];
    for reader in ["lighting_known", "lighting_unknown"] {
        for column in [
            "bound_k",
            "bias_k",
            "bias_low_k",
            "bias_high_k",
            "rmse_k",
            "rmse_low_k",
            "rmse_high_k",
            "variance_over_bound",
            "variance_over_bound_low",
            "variance_over_bound_high",
            "verdict",
            "bound_applies",
            "share_of_fits_at_edge",
            "unconverged_fits",
        ] {
            header.push(format!("{column}_{reader}"));
        }
    }
    header.push("bound_lighting_within_range_k".into());
    for imager in ["fixed", "manual"] {
        for column in ["mean_reading", "bias", "rmse"] {
            header.push(format!("{column}_k_{imager}_emissivity"));
        }
        header.push(format!("without_reading_{imager}_emissivity"));
    }
    let mut table = Table::new(header);
    for row in &result.rows {
        let mut cells = vec![number(row.temperature_k), number(row.photons)];
        for reader in [Some(&row.lighting_known), row.lighting_unknown.as_ref()] {
            cells.extend(reader_cells(reader));
        }
        cells.push(optional(row.bound_range_k));
        for imager in [&row.fixed, &row.manual] {
            let errors = imager.errors;
            cells.push(optional(errors.map(|errors| row.temperature_k + errors.bias)));
            cells.push(optional(errors.map(|errors| errors.bias)));
            cells.push(optional(errors.map(|errors| errors.rmse)));
            cells.push(imager.without_reading.to_string());
        }
        table.push(cells);
    }
    table
}

fn reader_cells(reader: Option<&Reader>) -> Vec<String> {
    let Some(reader) = reader else { return vec![String::new(); 14] };
    let Errors { bias, bias_interval, rmse, rmse_interval, .. } = reader.errors;
    let efficiency = reader.efficiency;
    vec![
        optional(reader.bound_k),
        number(bias),
        number(bias_interval.low),
        number(bias_interval.high),
        number(rmse),
        number(rmse_interval.low),
        number(rmse_interval.high),
        optional(efficiency.map(|e| e.ratio)),
        optional(efficiency.map(|e| e.ratio_interval.low)),
        optional(efficiency.map(|e| e.ratio_interval.high)),
        efficiency.map_or("", |e| e.verdict.text()).into(),
        if reader.bound_applies { "yes" } else { "no" }.into(),
        number(reader.at_edge),
        reader.unconverged.to_string(),
    ]
}

/// Rows by rising temperature.
fn rising(result: &Thermometry) -> Vec<&ThermometryRow> {
    let mut rows: Vec<&ThermometryRow> = result.rows.iter().collect();
    rows.sort_by(|a, b| a.temperature_k.total_cmp(&b.temperature_k));
    rows
}

fn true_temperature() -> Axis {
    Axis::linear("true temperature (°C)")
}

fn imager_error(errors: Option<Errors>, what: impl Fn(Errors) -> f64) -> f64 {
    errors.map_or(f64::NAN, what)
}

/// Mean error of the readings against the true temperature: the paper's Extended Data Fig. 9e.
#[must_use]
pub fn errors(result: &Thermometry) -> Plot {
    let rows = rising(result);
    let celsius: Vec<f64> = rows.iter().map(|row| row.temperature_k - 273.15).collect();
    let of = |what: &dyn Fn(&ThermometryRow) -> f64| rows.iter().map(|row| what(row)).collect::<Vec<f64>>();
    let own = of(&|row| decisive(row).errors.bias);
    let (low, high) = (
        of(&|row| decisive(row).errors.bias_interval.low),
        of(&|row| decisive(row).errors.bias_interval.high),
    );
    let fixed = of(&|row| imager_error(row.fixed.errors, |errors| errors.bias));
    let manual = of(&|row| imager_error(row.manual.errors, |errors| errors.bias));
    let mut table = Table::new([
        "temperature_k",
        "error_maximum_likelihood_k",
        "error_maximum_likelihood_low_k",
        "error_maximum_likelihood_high_k",
        "error_fixed_emissivity_k",
        "error_manual_emissivity_k",
    ]);
    for (i, row) in rows.iter().enumerate() {
        table.push_numbers(&[row.temperature_k, own[i], low[i], high[i], fixed[i], manual[i]]);
    }
    // Millikelvin where that keeps the numbers short.
    let largest = low.iter().chain(&high).fold(0.0_f64, |largest, x| largest.max(x.abs()));
    let (factor, unit) = if largest < 1.0 { (1e3, "mK") } else { (1.0, "K") };
    let scaled = |values: &[f64]| values.iter().map(|x| factor * x).collect::<Vec<f64>>();
    let lower = Panel::new(Axis::linear(format!("mean error ({unit})")))
        .band(Band::new("95 % interval of the mean", celsius.clone(), scaled(&low), scaled(&high)).colour(1))
        .rule(Rule::horizontal(0.0, ""))
        .series(Series::line("maximum likelihood", celsius.clone(), scaled(&own)).colour(1));
    let lighting =
        if rows.iter().any(|row| row.lighting_unknown.is_some()) { ", lighting unknown" } else { "" };
    let figure = LineFigure::new(
        format!("How far from the truth {} is read", result.target),
        true_temperature(),
        Axis::linear("mean error (K)"),
    )
    .subtitle(format!(
        "{}, {} spectra at each temperature, emissivity known to maximum likelihood{lighting}. Below: maximum likelihood \
         alone. Manual emissivity {} is calibrated at {:.1} °C.",
        result.camera,
        result.trials,
        significant(result.manual.emissivity, 3),
        result.calibrated_k - 273.15
    ))
    .rule(Rule::horizontal(0.0, ""))
    .series(Series::line("maximum likelihood", celsius.clone(), own).colour(1))
    .series(Series::line(
        format!("thermal imaging, emissivity {}", result.fixed.emissivity),
        celsius.clone(),
        fixed,
    ).colour(2))
    .series(
        Series::line("thermal imaging, emissivity entered by hand", celsius, manual)
            .style(Style::Dashed)
            .colour(3),
    )
    .lower(lower);
    Plot { name: "temperature_error", figure: figure.into(), table }
}

/// Root mean squared error against the true temperature, with the bounds: the paper's Extended Data Fig. 9f.
#[must_use]
pub fn rmse(result: &Thermometry) -> Plot {
    let rows = rising(result);
    let celsius: Vec<f64> = rows.iter().map(|row| row.temperature_k - 273.15).collect();
    let of = |what: &dyn Fn(&ThermometryRow) -> Option<f64>| {
        rows.iter().map(|row| what(row).map_or(f64::NAN, |k| 1e3 * k)).collect::<Vec<f64>>()
    };
    let columns = [
        ("bound, lighting known", Style::Line, 0, of(&|row| row.lighting_known.bound_k)),
        ("likelihood, lighting known", Style::Points, 0, of(&|row| Some(row.lighting_known.errors.rmse))),
        ("bound, lighting unknown", Style::Line, 1, of(&|row| row.lighting_unknown.as_ref()?.bound_k)),
        (
            "likelihood, lighting unknown",
            Style::Points,
            1,
            of(&|row| row.lighting_unknown.as_ref().map(|reader| reader.errors.rmse)),
        ),
        ("bound, lighting within its range", Style::Dotted, 1, of(&|row| row.bound_range_k)),
        ("imaging, fixed emissivity", Style::Dashed, 2, of(&|row| row.fixed.errors.map(|e| e.rmse))),
        ("imaging, manual emissivity", Style::Dashed, 3, of(&|row| row.manual.errors.map(|e| e.rmse))),
    ];
    let mut table = Table::new([
        "temperature_k",
        "bound_lighting_known_mk",
        "rmse_lighting_known_mk",
        "bound_lighting_unknown_mk",
        "rmse_lighting_unknown_mk",
        "bound_lighting_within_range_mk",
        "rmse_fixed_emissivity_mk",
        "rmse_manual_emissivity_mk",
        "rmse_lighting_known_low_mk",
        "rmse_lighting_known_high_mk",
        "rmse_lighting_unknown_low_mk",
        "rmse_lighting_unknown_high_mk",
    ]);
    for (i, row) in rows.iter().enumerate() {
        let mut cells = vec![row.temperature_k];
        cells.extend(columns.iter().map(|(.., values)| values[i]));
        for reader in [Some(&row.lighting_known), row.lighting_unknown.as_ref()] {
            let interval = reader.map(|reader| reader.errors.rmse_interval);
            cells.extend(
                [interval.map(|i| i.low), interval.map(|i| i.high)].map(|k| k.map_or(f64::NAN, |k| 1e3 * k)),
            );
        }
        table.push_numbers(&cells);
    }
    let mut figure = LineFigure::new(
        format!("How precisely {} is read, and could be", result.target),
        true_temperature(),
        Axis::log("root mean squared error (mK)"),
    )
    .subtitle(format!(
        "{}, {} spectra at each temperature. Bounds are Cramér-Rao's, for unbiased estimates; the dotted one is van Trees' for \
         any estimate, averaged over the lighting.{}",
        result.camera,
        result.trials,
        if rows.iter().all(|row| decisive(row).bound_applies) {
            ""
        } else {
            " Fits held by the range of the lighting are biased: no bound of theirs is Cramér-Rao's."
        }
    ));
    for (label, style, colour, values) in columns {
        if values.iter().any(|value| value.is_finite()) {
            figure = figure.series(Series::line(label, celsius.clone(), values).style(style).colour(colour));
        }
    }
    Plot { name: "temperature_rmse", figure: figure.lower(over_bound(&rows, &celsius)).into(), table }
}

/// Errors over the bounds that apply to them: 1 is as good as unbiased estimates can be.
fn over_bound(rows: &[&ThermometryRow], celsius: &[f64]) -> Panel {
    let known: Vec<Option<&Reader>> = rows.iter().map(|row| Some(&row.lighting_known)).collect();
    let unknown: Vec<Option<&Reader>> = rows.iter().map(|row| row.lighting_unknown.as_ref()).collect();
    let mut panel = Panel::new(Axis::linear("error over bound")).rule(Rule::horizontal(1.0, ""));
    let likelihoods = [("likelihood, lighting known", known), ("likelihood, lighting unknown", unknown)];
    for (colour, (label, readers)) in likelihoods.into_iter().enumerate() {
        let over = |what: &dyn Fn(&Errors) -> f64| -> Vec<f64> {
            let ratio = |reader: &Reader| Some(what(&reader.errors) / reader.bound_k?);
            let applying = readers.iter().map(|reader| reader.filter(|reader| reader.bound_applies));
            applying.map(|reader| reader.and_then(ratio).unwrap_or(f64::NAN)).collect()
        };
        let values = over(&|errors| errors.rmse);
        if values.iter().any(|value| value.is_finite()) {
            let low = over(&|errors| errors.rmse_interval.low);
            let high = over(&|errors| errors.rmse_interval.high);
            let meaning = if colour == 0 { "95 % interval of error" } else { "" };
            panel = panel
                .band(Band::new(meaning, celsius.to_vec(), low, high).colour(colour))
                .series(Series::points(label, celsius.to_vec(), values).colour(colour));
        }
    }
    panel
}

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
        "{} spectra at each temperature, {} counts, seed {} ({})",
        result.trials, result.statistics, result.seed, result.generator
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Library;
    use crate::scenario::Scenario;

    fn result() -> (Study, Thermometry) {
        let text = "[target]\nmaterial = \"silicon-carbide\"\ntemperature = \"60 degC\"\n\
                    [[environment]]\ntemperature = \"20 degC\"\nlighting = 0.5\n\
                    [alternatives]\nmaterials = [\"aluminium\"]\n\
                    [bands]\nstart = \"720 cm^-1\"\nstop = \"1250 cm^-1\"\nstep = \"50 cm^-1\"\n\
                    [camera]\npreset = \"nicolet-is50\"";
        let study =
            Study::new(&Scenario::from_toml(text, None).unwrap(), &Library::embedded().unwrap()).unwrap();
        let found = study.thermometry(&[350.0, 310.0], 50, 1, &|_, _| {}).unwrap();
        (study, found)
    }

    #[test]
    fn every_row_fills_every_column() {
        let (study, found) = result();
        let csv = table(&found).to_csv().unwrap();
        let columns: Vec<usize> = csv.lines().map(|line| line.split(',').count()).collect();
        assert_eq!(columns, [39, 39, 39]);
        let names: Vec<String> =
            bundle(&study, &found, Path::new("out")).unwrap().names().map(str::to_owned).collect();
        for name in ["thermometry.csv", "temperature_error.png", "temperature_rmse.svg", "scenario.toml"] {
            assert!(names.iter().any(|found| found == name), "{name}: {names:?}");
        }
    }

    /// The plots show what the table says, by rising temperature.
    #[test]
    fn plots_are_the_numbers() {
        let (_, found) = result();
        let csv = rmse(&found).table.to_csv().unwrap();
        let second: Vec<f64> = csv.lines().nth(1).unwrap().split(',').map(|x| x.parse().unwrap()).collect();
        let row = &found.rows[1];
        assert_eq!(second[0], 310.0);
        assert_eq!(second[1], 1e3 * row.lighting_known.bound_k.unwrap());
        assert_eq!(second[4], 1e3 * row.lighting_unknown.as_ref().unwrap().errors.rmse);
        let csv = errors(&found).table.to_csv().unwrap();
        let second: Vec<f64> = csv.lines().nth(1).unwrap().split(',').map(|x| x.parse().unwrap()).collect();
        assert_eq!(second[4], row.fixed.errors.unwrap().bias);
    }

    #[test]
    fn text_leads_with_the_answer() {
        let (_, found) = result();
        let text = text(&found);
        assert!(text.starts_with("nicolet-is50 reads silicon-carbide at 36.9 to 76.9 degC"), "{text}");
        assert!(text.contains("seed 1") && !text.contains("NaN"));
    }
}
