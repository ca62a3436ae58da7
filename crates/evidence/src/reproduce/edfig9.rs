//! Extended Data Fig. 9e, f: thermometry of silicon carbide on a heating plate, and of skin.
//!
//! 16 heating powers; the paper gives no temperatures for them, ours are even steps over a stated range. Its 20
//! measurements at each would leave the ratio of variances uncertain by a third; ours are as many as the verdicts take.

use super::ledger::{Line, Verdict};
use super::order::{Effort, Figures, Made, Order, Progress};
use super::scene;
use hadar::error::Result;
use hadar_report::bundle::Bundle;
use hadar_report::figures::Plot;
use hadar_report::simulate::thermometry;
use hadar_report::text::significant;
use hadar_scenario::examples;
use hadar_simulate::efficiency::{Errors, Verdict as Standing};
use hadar_study::{Reader, Thermometry, ThermometryRow};

/// Heating powers.
const POWERS: usize = 16;
/// Spectra at each.
const TRIALS: usize = 12_000;
/// Of the temperatures, the quick form makes so many, from the coldest on.
const QUICK: usize = 2;
/// Error that is severe, K, and share of fits at the edge of the range of V that is more than chance.
const SEVERE_K: f64 = 5.0;
const HELD: f64 = 1e-3;
/// Ranges of the true temperature, °C: a heating plate, and people.
const PLATE_C: [f64; 2] = [30.0, 105.0];
const PEOPLE_C: [f64; 2] = [33.0, 40.5];

pub(super) fn make(order: Order, progress: Progress<'_>) -> Result<Made> {
    let mut bundle = Bundle::default();
    let mut lines = Vec::new();
    let mut text = String::new();
    let samples = [
        ("sic", ["sic_errors", "sic_rmse"], examples::THERMOMETRY_SIC, PLATE_C),
        ("skin", ["skin_errors", "skin_rmse"], examples::THERMOMETRY_SKIN, PEOPLE_C),
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
        bundle.add(format!("{name}_scenario.toml"), study.scenario().to_toml());
        bundle.add(format!("{name}_thermometry.csv"), thermometry::table(&result).to_csv()?);
        bundle.add_plots(&[
            Plot { name: plots[0].into(), ..thermometry::errors(&result) },
            Plot { name: plots[1].into(), ..thermometry::rmse(&result) },
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
    let is_sic = name == "sic";
    let sample = if is_sic { "SiC, Nicolet iS50" } else { "skin, FLIR A325sc" };
    let mut lines = vec![reached(is_sic, sample, "known", result, |row| Some(&row.lighting_known))];
    lines.push(reached(is_sic, sample, "unknown", result, |row| row.lighting_unknown.as_ref()));
    let bias = |errors: Option<Errors>| errors.map_or(f64::NAN, |errors| errors.bias);
    let fixed: Vec<f64> = result.rows.iter().map(|row| bias(row.fixed.errors)).collect();
    let manual: Vec<f64> = result.rows.iter().map(|row| bias(row.manual.errors)).collect();
    let (range, place) = (|values: &[f64]| format!("{} K off", span(values)), "Ext. Data Fig. 9e");
    let quantity = |what: &str| format!("{sample}: thermal imaging with emissivity {what}");
    if !is_sic {
        let why = "its emissivity is right; what is left is the lighting taken for 1";
        lines.push(Line::new(place, quantity("0.95"), "-", range(&fixed), Verdict::NotInThePaper, why));
        return lines;
    }
    let severe = fixed.iter().all(|k| k.abs() > SEVERE_K);
    let why = "more than 5 K at every temperature; the sample reflects, its emissivity is far from 0.95 in its reststrahlen band";
    lines.push(Line::new(
        place,
        quantity("0.95"),
        "severely deviates",
        range(&fixed),
        qualitative(severe),
        why,
    ));
    let rising = manual.windows(2).all(|pair| pair[1].abs() > pair[0].abs());
    let why = "rising at every step: it takes the scattered light of the surroundings for emission, thermal camouflage";
    let what = quantity("entered by hand at the lowest power");
    lines.push(Line::new(
        place,
        what,
        "deviates as the power increases",
        range(&manual),
        qualitative(rising),
        why,
    ));
    lines
}

/// A statement in words that holds under the choices of the scenario, or not.
fn qualitative(holds: bool) -> Verdict {
    if holds { Verdict::UnderAChoice } else { Verdict::NotReproduced }
}

/// From the least to the largest, to two digits.
fn span(values: &[f64]) -> String {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let short = |value: f64| if value.abs() < 0.05 { "0".to_owned() } else { significant(value, 2) };
    let [least, most] = [least, most].map(short);
    if least == most { least } else { format!("{least} to {most}") }
}

/// Whether maximum likelihood reaches the bound, and in how many rows.
fn reached(
    is_sic: bool,
    sample: &str,
    lighting: &str,
    result: &Thermometry,
    reader: impl Fn(&ThermometryRow) -> Option<&Reader>,
) -> Line {
    let found: Vec<&Reader> = result.rows.iter().filter_map(reader).collect();
    let rows = found.len();
    let efficiencies = || found.iter().filter_map(|reader| reader.efficiency.as_ref());
    let of = |verdict| efficiencies().filter(|e| e.verdict == verdict).count();
    let (reaches, undecided) = (of(Standing::Reaches), of(Standing::Undecided));
    let ratio = efficiencies().map(|e| e.ratio).sum::<f64>() / efficiencies().count().max(1) as f64;
    let bounds: Vec<f64> = found.iter().filter_map(|reader| reader.bound_k).collect();
    let ours = format!(
        "{reaches} of {rows} temperatures; variance {ratio:.3} of the bound's on average; bound {} K",
        span(&bounds)
    );
    let quantity = format!("{sample}: maximum likelihood reaches the bound, lighting {lighting}");
    let held = found.iter().any(|reader| reader.at_edge > HELD);
    let why = if held {
        "the range 0 <= V <= 1 stops the fits, so that they are not unbiased whatever V is: the bound for unbiased estimates does not apply"
    } else {
        "simulated, with temperatures, lighting and a library emissivity that the paper does not state; interval of the ratio of \
         variances below 1.1, bias below 0.2 of the deviation, all rows together at 95 %"
    };
    let (paper, verdict) = match (is_sic, reaches == rows, reaches + undecided == rows) {
        (false, _, _) => ("-", Verdict::NotInThePaper),
        (true, true, _) => ("reaches it", Verdict::UnderAChoice),
        (true, false, true) => ("reaches it", Verdict::TooFewToSay),
        (true, false, false) => ("reaches it", Verdict::NotReproduced),
    };
    Line::new("Ext. Data Fig. 9f", quantity, paper, ours, verdict, why)
}
