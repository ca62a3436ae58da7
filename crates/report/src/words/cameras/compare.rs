//! Two cameras side by side: the answer, the numbers, what they rest on.

use super::noise;
use super::rows::{Row, alone, in_scene};
use crate::cameras::{Sheet, SideBySide};
use crate::text::footing::RESTS_ON;
use crate::text::numbers::significant;
use crate::words::Say;
use hadar::instrument::{Comparison, Readout};
use std::fmt::Write as _;

/// Relative difference below which two figures are the same.
const SAME: f64 = 5e-4;

/// Which one collects more photons, which has less noise, and what that means for the distance d.
#[must_use]
pub(crate) fn comparison_sentence(both: &SideBySide) -> String {
    let (a, b) = (both.a.preset.name.as_str(), both.b.preset.name.as_str());
    if a == b {
        return format!("{a} is compared with itself: all ratios are 1.");
    }
    let Some(ratios) = &both.comparison else { return incomplete(&both.a, &both.b) };
    // The one that tells more apart comes first, whichever of the two it is.
    let (better, worse, sign) = if ratios.distance < 1.0 { (a, b, -1) } else { (b, a, 1) };
    let same_time = match same(ratios.a.acquisition_s / ratios.b.acquisition_s) {
        true => String::new(),
        false => format!(
            ", in the time of the slower one {} times",
            times(ratios.distance_in_same_time.powi(sign))
        ),
    };
    let lens = both.lens.map_or_else(String::new, |lens| format!(", both behind {},", lens_of_both(lens)));
    format!(
        "In one acquisition{lens} {}, and {}. In a scene of 300 K a pair whose spectra differ little has {} times the distance d \
         with {better} that it has with {worse}{same_time}.",
        photons(ratios.photons, a, b),
        noises(ratios, a, b),
        times(ratios.distance.powi(sign)),
    )
}

fn lens_of_both([f_number, focal_length_m]: [f64; 2]) -> String {
    format!("f/{} of {} mm", significant(f_number, 2), significant(1e3 * focal_length_m, 3))
}

fn same(ratio: f64) -> bool {
    (ratio - 1.0).abs() < SAME
}

fn photons(ratio: f64, a: &str, b: &str) -> String {
    let (more, factor) = if ratio > 1.0 { (b, ratio) } else { (a, 1.0 / ratio) };
    match same(ratio) {
        true => "both collect the same photons".into(),
        false => format!("{more} collects more photons ({} times)", times(factor)),
    }
}

fn noises(ratios: &Comparison, a: &str, b: &str) -> String {
    let only = |noisy: &str| format!("only {noisy} has noise other than theirs");
    match ratios.noise_over_photons {
        None if ratios.b.noise_counts > 0.0 => only(b),
        None => "neither has noise other than theirs".into(),
        Some(0.0) => only(a),
        Some(ratio) if same(ratio) => "both have the same noise for their photons".into(),
        Some(ratio) => {
            let (less, factor) = if ratio < 1.0 { (b, 1.0 / ratio) } else { (a, ratio) };
            format!("{less} has less noise for its photons (by a factor of {})", times(factor))
        }
    }
}

fn times(ratio: f64) -> String {
    significant(ratio, 3)
}

fn incomplete(a: &Sheet, b: &Sheet) -> String {
    let lacks = |sheet: &Sheet| {
        let keys = &sheet.missing.0;
        (!keys.is_empty()).then(|| format!("the {} of {}", keys.join(", "), sheet.preset.name))
    };
    let mut lacking: Vec<String> = [a, b].into_iter().filter_map(lacks).collect();
    lacking.dedup();
    format!(
        "Which of {} and {} distinguishes more cannot be said: no document that was read states {}.",
        a.preset.name,
        b.preset.name,
        lacking.join(", or ")
    )
}

/// Two cameras side by side.
#[must_use]
pub fn comparison(both: &SideBySide) -> String {
    let (a, b) = (&both.a.preset, &both.b.preset);
    let (figures, scene) = (alone(both), in_scene(both));
    let cells = |row: &Row| row.values.map(|value| value.map_or_else(|| "-".to_owned(), row.shown));
    let widest = figures.iter().chain(&scene).flat_map(cells).map(|cell| cell.len()).max().unwrap_or(0);
    let width = widest.max(a.name.len()).max(b.name.len());
    let line = |label: &str, [a, b]: [&str; 2], ratio: &str| {
        format!("  {label:<34} {a:>width$}  {b:>width$}  {ratio:>9}\n")
    };
    let rows = |rows: &[Row]| -> String {
        let of = |row: &Row| {
            let [a, b] = cells(row);
            line(row.label, [&a, &b], &row.ratio().map_or_else(|| "-".into(), times))
        };
        rows.iter().map(of).collect()
    };
    let mut out = comparison_sentence(both) + "\n\n";
    out += &line("", [&a.name, &b.name], "ratio B/A");
    out += &rows(&figures);
    let _ = writeln!(out, "  {:<34} {}", "noise of A as stated", noise(a));
    let _ = writeln!(out, "  {:<34} {}", "noise of B as stated", noise(b));
    if let Some(ratios) = &both.comparison {
        let [low, high] = ratios.range_cm1;
        let bands = ratios.a.bands;
        let _ = writeln!(
            out,
            "\nA blackbody at 300 K, the {bands} bands of 1 cm^-1 from {low} to {high} cm^-1 that both see"
        );
        out += &rows(&scene);
        if !same(ratios.a.acquisition_s / ratios.b.acquisition_s) {
            out += &line("d in the time of the slower one", ["", ""], &times(ratios.distance_in_same_time));
        }
    }
    let _ = writeln!(out, "\n{RESTS_ON}");
    for caveat in caveats(both) {
        let _ = writeln!(out, "  - {caveat}");
    }
    out
}

/// What the comparison rests on.
#[must_use]
pub(crate) fn caveats(both: &SideBySide) -> Vec<String> {
    let mut all = Vec::new();
    for sheet in [&both.a, &both.b] {
        let name = &sheet.preset.name;
        for assumed in sheet.worked.iter().flat_map(|worked| &worked.camera.assumed) {
            all.push(format!("{name}: {}", assumed.say()));
        }
        if sheet.worked.is_none() {
            let keys = &sheet.missing.0;
            all.push(format!("{name}: not stated, to be given in a scenario: {}", keys.join(", ")));
        }
        let figures = &sheet.preset.figures;
        match (figures.spectral_bands, figures.readout) {
            (Some(1), None | Some(Readout::Sequential)) => all.push(format!(
                "{name} separates no bands: a spectrum takes filters, one after the other, here without loss"
            )),
            (Some(1), Some(readout)) => all.push(format!(
                "{name} separates no bands and is modelled as if it read a whole spectrum, {}",
                readout.name()
            )),
            _ => {}
        }
        if both.b.preset.name == both.a.preset.name {
            break;
        }
    }
    if let Some(lens) = both.lens {
        all.push(format!("where no document names a lens, both are behind {}", lens_of_both(lens)));
    }
    if both.a.preset.name != both.b.preset.name {
        all.push(format!(
            "before a question of your own, with its filters and frames: `hadar find` with find.cameras = [{:?}, {:?}]",
            both.a.preset.name, both.b.preset.name
        ));
    }
    if both.comparison.is_some() {
        all.push(
            "d is for spectra that differ by the same small share in every band and fill a pixel; pixels, and what they \
             see at a distance, are not of the same size"
                .into(),
        );
    }
    all
}
