//! Extended Data Fig. 9e, f: thermometry of silicon carbide on a heating plate, and of skin.
//!
//! 16 heating powers; the paper gives no temperatures for them, ours are even steps over a stated range. Its 20
//! measurements at each would leave the ratio of variances uncertain by a third; ours are as many as the verdicts take.

use super::{Effort, Figures, Line, Made, Order, Progress, Verdict, scene};
use crate::error::Result;
use crate::report::bundle::Bundle;
use crate::report::figures::Plot;
use crate::report::thermometry;
use crate::simulate::efficiency::{Errors, Verdict as Standing};
use crate::study::{Reader, Thermometry};
use std::path::Path;

/// Heating powers.
const POWERS: usize = 16;
/// Spectra at each.
const TRIALS: usize = 12_000;
/// Of the temperatures, the quick form makes so many, from the coldest on.
const QUICK: usize = 2;
/// Ranges of the true temperature, °C: a heating plate, and people.
const PLATE_C: [f64; 2] = [30.0, 105.0];
const PEOPLE_C: [f64; 2] = [33.0, 40.5];

pub(super) fn make(order: Order, out: &Path, progress: Progress<'_>) -> Result<Made> {
    let mut bundle = Bundle::default();
    let mut lines = Vec::new();
    let mut text = String::new();
    let samples = [
        ("sic", ["sic_errors", "sic_rmse"], scene::THERMOMETRY_SIC, PLATE_C),
        ("skin", ["skin_errors", "skin_rmse"], scene::THERMOMETRY_SKIN, PEOPLE_C),
    ];
    for (i, (name, plots, toml, [low, high])) in samples.into_iter().enumerate() {
        let study = scene::study(toml)?;
        let step = (high - low) / (POWERS - 1) as f64;
        let mut temperatures: Vec<f64> = (0..POWERS).map(|k| low + step * k as f64 + 273.15).collect();
        if order.effort == Effort::Quick {
            temperatures.truncate(QUICK);
        }
        let total = temperatures.len();
        let tell = |done: usize, _: usize| progress(i * total + done, 2 * total);
        let result = study.thermometry(&temperatures, TRIALS, order.seed, &tell)?;
        bundle.add(format!("{name}_scenario.toml"), study.scenario().to_toml_beside(out));
        bundle.add(format!("{name}_thermometry.csv"), thermometry::table(&result).to_csv()?);
        bundle.add_plots(&[
            Plot { name: plots[0], ..thermometry::errors(&result) },
            Plot { name: plots[1], ..thermometry::rmse(&result) },
        ])?;
        text.push_str(&format!("```text\n{}```\n\n", thermometry::text(&result)));
        lines.extend(self::lines(name, &result));
    }
    let pictures = vec![
        ("sic_rmse.png", "Errors of each reading against the bound, silicon carbide"),
        ("sic_errors.png", "Mean error of each reading, silicon carbide"),
        ("skin_rmse.png", "Errors of each reading against the bound, skin"),
        ("skin_errors.png", "Mean error of each reading, skin"),
    ];
    Ok((bundle, lines, Figures { pictures, text }))
}

fn lines(name: &str, result: &Thermometry) -> Vec<Line> {
    let sample = if name == "sic" { "SiC, Nicolet iS50" } else { "skin, FLIR A325sc" };
    let mut lines = vec![reached(sample, "known", result, |row| Some(&row.0))];
    lines.push(reached(sample, "unknown", result, |row| row.1.as_ref()));
    let bias = |errors: Option<Errors>| errors.map_or(f64::NAN, |errors| errors.bias);
    let fixed: Vec<f64> = result.rows.iter().map(|row| bias(row.fixed.errors)).collect();
    let manual: Vec<f64> = result.rows.iter().map(|row| bias(row.manual.errors)).collect();
    let range = |values: &[f64]| {
        let (low, high) = values
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &v| (low.min(v), high.max(v)));
        format!("{low:.1} to {high:.1} K off")
    };
    let place = "Ext. Data Fig. 9e";
    if name == "sic" {
        lines.push(Line::new(
            place,
            format!("{sample}: thermal imaging with emissivity 0.95"),
            "severely deviates",
            range(&fixed),
            Verdict::Reproduced,
            "the sample reflects: its emissivity is far from 0.95 in its reststrahlen band",
        ));
        lines.push(Line::new(
            place,
            format!("{sample}: emissivity entered by hand at the lowest power"),
            "deviates as the power increases",
            range(&manual),
            Verdict::Reproduced,
            "it takes the scattered light of the surroundings for emission: thermal camouflage",
        ));
    } else {
        lines.push(Line::new(
            place,
            format!("{sample}: thermal imaging with emissivity 0.95"),
            "-",
            range(&fixed),
            Verdict::NoValuePrinted,
            "its emissivity is right here; the error is that of the lighting taken for 1",
        ));
    }
    lines
}

type Readers = (Reader, Option<Reader>);

/// Whether maximum likelihood reaches the bound, and in how many rows.
fn reached(
    sample: &str,
    lighting: &str,
    result: &Thermometry,
    reader: impl Fn(&Readers) -> Option<&Reader>,
) -> Line {
    let readers: Vec<Readers> =
        result.rows.iter().map(|row| (row.lighting_known.clone(), row.lighting_unknown.clone())).collect();
    let found: Vec<&Reader> = readers.iter().filter_map(&reader).collect();
    let rows = found.len();
    let verdicts = found.iter().filter_map(|reader| reader.efficiency.as_ref());
    let reaches = verdicts.clone().filter(|e| e.verdict == Standing::Reaches).count();
    let ratios: Vec<f64> = verdicts.map(|e| e.ratio).collect();
    let mean = ratios.iter().sum::<f64>() / ratios.len().max(1) as f64;
    let bounds: Vec<f64> = found.iter().filter_map(|reader| reader.bound_k).map(|k| 1e3 * k).collect();
    let (low, high) =
        bounds.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &v| (low.min(v), high.max(v)));
    let ours = format!(
        "{reaches} of {rows} temperatures; variance {mean:.3} of the bound on average; bound {low:.3} to {high:.3} mK"
    );
    let quantity = format!("{sample}: maximum likelihood reaches the bound, lighting {lighting}");
    let held = found.iter().any(|reader| reader.at_edge > 1e-3);
    if reaches == rows {
        let why = "interval of the ratio of variances below 1.1, bias below 0.2 of the deviation, all rows together at 95 %";
        return Line::new("Ext. Data Fig. 9f", quantity, "reaches it", ours, Verdict::Reproduced, why);
    }
    let why = if held {
        "the range 0 <= V <= 1 stops the fits: the estimate is biased and errs less than the bound for unbiased ones, which does not apply"
    } else {
        "see the table"
    };
    Line::new("Ext. Data Fig. 9f", quantity, "-", ours, Verdict::NoValuePrinted, why)
}
