//! All known cameras, a line each.

use crate::cameras::Sheet;
use crate::text::numbers::{quantity, significant};
use hadar::instrument::Readout;
use hadar::instrument::figures::StatedNoise;
use hadar::instrument::presets::Preset;
use std::fmt::Write as _;

/// All cameras, those of the paper (without a document of their own) first.
#[must_use]
pub fn list(sheets: &[Sheet]) -> String {
    let complete = sheets.iter().filter(|sheet| sheet.missing.0.is_empty()).count();
    let mut out = format!(
        "{} cameras, {complete} of them complete; the others lack what no document states and a scenario must give.\n",
        sheets.len()
    );
    let name = sheets.iter().map(|sheet| sheet.preset.name.len()).max().unwrap_or(0);
    let origins = ["As the paper models them", "From public documents", "Of your own"];
    let origin = |preset: &Preset| match (&preset.file, &preset.document) {
        (Some(_), _) => 2,
        (None, Some(_)) => 1,
        (None, None) => 0,
    };
    for (at, title) in origins.iter().enumerate() {
        let of_origin = |sheet: &&Sheet| origin(&sheet.preset) == at;
        if at == 2 && !sheets.iter().any(|sheet| of_origin(&sheet)) {
            continue;
        }
        let _ = writeln!(
            out,
            "\n{title}\n{:<name$} {:>8} {:>6}  {:<18} {:<15} give",
            "name", "pixel", "f/#", "noise", "bands"
        );
        for sheet in sheets.iter().filter(of_origin) {
            let preset = &sheet.preset;
            let give: Vec<&str> = sheet.missing.0.iter().map(|key| short(key)).collect();
            let line = format!(
                "{:<name$} {:>8} {:>6}  {:<18} {:<15} {}",
                preset.name,
                preset.figures.pixel_m.map_or_else(|| "-".into(), |pixel| quantity(pixel, "m")),
                preset.figures.f_number.map_or_else(|| "-".into(), |f_number| format!("f/{f_number}")),
                briefly(preset),
                bands(preset),
                give.join(", ")
            );
            let file = preset.file.as_ref().map_or_else(String::new, |file| format!("  ({file})"));
            let _ = writeln!(out, "{}{file}", line.trim_end());
        }
    }
    out.push_str(
        "\n-: not stated. `hadar cameras show NAME` gives the figures, what is assumed, and the documents.\n",
    );
    out
}

/// A key of a scenario as a word in the list.
fn short(key: &'static str) -> &'static str {
    match key {
        "f_number" => "f/#",
        "focal_length" => "lens",
        "netd" => "noise",
        other => other,
    }
}

fn briefly(preset: &Preset) -> String {
    match preset.figures.noise.stated() {
        None => "-".into(),
        Some(StatedNoise::None) => match preset.figures.dark_rate_per_s {
            Some(_) => "dark counts".into(),
            None => "photons only".into(),
        },
        Some(StatedNoise::Netd { netd_k, f_number, .. }) => {
            let at = f_number.map_or_else(String::new, |f_number| format!(" at f/{f_number}"));
            format!("{}{at}", quantity(netd_k, "K"))
        }
        Some(StatedNoise::Detectivity { detectivity_cm_hz05_w, .. }) => {
            format!("{} Jones", significant(detectivity_cm_hz05_w, 2))
        }
        Some(StatedNoise::Nep { nep_w_hz05, .. }) => format!("{} W/Hz^0.5", significant(nep_w_hz05, 2)),
        Some(StatedNoise::Nesr { microflick, .. }) => format!("{microflick} uflick"),
        Some(StatedNoise::Counts { sigma_counts }) => format!("{} counts", significant(sigma_counts, 2)),
    }
}

fn bands(preset: &Preset) -> String {
    let how = match preset.figures.readout {
        None if preset.figures.spectral_bands == Some(1) => return "one".into(),
        None => return "-".into(),
        Some(readout) if readout != Readout::Sequential && preset.figures.spectral_bands == Some(1) => {
            return "one, modelled".into();
        }
        Some(Readout::FourierTransform) => "interferogram",
        Some(readout) => readout.name(),
    };
    preset.figures.spectral_bands.map_or_else(|| how.to_owned(), |bands| format!("{bands} {how}"))
}
