//! A camera with its figures, what follows from them, and where they are from.

mod compare;
mod list;
mod rows;

pub use compare::comparison;
pub(crate) use compare::{caveats, comparison_sentence};
pub use list::list;
pub(crate) use rows::{alone, in_scene};

use crate::cameras::Sheet;
use crate::text::columns::{Columns, left, right};
use crate::text::numbers::{celsius, fixed, quantity, significant};
use crate::words::Say;
use hadar::instrument::equivalents::blackbody_microflick;
use hadar::instrument::figures::{CameraSpec, Kind, Line, Row, StatedNoise, TABLE};
use hadar::instrument::presets::Preset;
use hadar::instrument::{Equivalents, Figures, NoiseLine, Readout};
use hadar::units::Dimension;
use std::fmt::Write as _;

const NOT_STATED: &str = "not stated";

/// A camera with its figures, what follows from them, what is missing, and where they are from.
#[must_use]
pub fn text(sheet: &Sheet) -> String {
    let preset = &sheet.preset;
    let mut out = format!("{}: {}\n", preset.name, preset.description);
    if !sheet.missing.0.is_empty() {
        let _ = writeln!(
            out,
            "\nIt cannot be used as it is: no document that was read states all of it. Write in a scenario, with what the \
             camera has in place of the dots:\n\n  [camera]\n  preset = {:?}",
            preset.name
        );
        for line in sheet.missing.lines() {
            let _ = writeln!(out, "  {line}");
        }
    }
    out.push_str("\nFigures\n");
    out.push_str(&figures(sheet));
    let worked = sheet.worked.as_ref();
    let assumed = worked.map_or(&[][..], |worked| &worked.camera.assumed);
    section(&mut out, "Assumed", &assumed.iter().map(Say::say).collect::<Vec<_>>());
    if let Some(worked) = worked {
        out.push_str(&one_exposure(&worked.figures));
        out.push_str(&equivalents(&worked.equivalents));
        out.push_str(&budget(&worked.noise_budget));
    }
    let document: Vec<String> = preset.document.iter().chain(&preset.provenance).cloned().collect();
    section(&mut out, "Provenance", &document);
    out
}

fn section(out: &mut String, title: &str, notes: &[String]) {
    if notes.is_empty() {
        return;
    }
    let _ = writeln!(out, "\n{title}");
    for note in notes {
        let _ = writeln!(out, "  - {note}");
    }
}

fn lines(rows: &[(&str, String)]) -> String {
    rows.iter().fold(String::new(), |mut out, (label, text)| {
        let _ = writeln!(out, "  {label:<34} {text}");
        out
    })
}

fn figures(sheet: &Sheet) -> String {
    let (stated, worked) = (&sheet.preset.figures, sheet.worked.as_ref());
    let taken = worked.map(|worked| CameraSpec::of(&worked.camera));
    let mut rows = Vec::new();
    for row in in_order() {
        let line = match (row.number(stated), taken.as_ref().and_then(|taken| row.number(taken))) {
            (Some(value), _) => shown(row, value),
            // What stands for a figure that is not stated is listed as assumed.
            (None, Some(value)) => format!("not stated; {} taken", shown(row, value)),
            (None, None) => NOT_STATED.to_owned(),
        };
        match row.line {
            Line::Always => rows.push((row.label, line)),
            Line::IfStated if row.is_given(stated) => rows.push((row.label, line)),
            _ => {}
        }
        match row.key {
            "quantum_efficiency" => rows.push(("noise", noise(&sheet.preset))),
            "full_well" => {
                if let Some([band, range]) = worked.and_then(|worked| worked.full_well_exposures_s) {
                    let [band, range] = [band, range].map(|s| quantity(s, "s"));
                    let text = format!("{band} (a band of 1 cm^-1), {range} (all of the range)");
                    rows.push(("full after, at 300 K", text));
                }
            }
            "quantisation_bits" => rows.extend([("bands", full_bands(stated)), ("array", array(stated))]),
            _ => {}
        }
    }
    let range = |[low, high]: [f64; 2]| format!("{low} to {high} cm^-1");
    let range = match (stated.spectral_range_cm1, worked) {
        (Some(stated), _) => range(stated),
        (None, Some(worked)) => format!("not stated; {} taken", range(worked.camera.spectral_range_cm1)),
        (None, None) => NOT_STATED.into(),
    };
    rows.push(("spectral range", range));
    let pixels = |pixels: f64| format!("{} pixels, lambda F / pixel", significant(pixels, 2));
    rows.push(("diffraction at 10 um", sheet.diffraction_pixels().map_or_else(|| NOT_STATED.into(), pixels)));
    lines(&rows)
}

/// The rows of the table, a frame rate beside the exposure that it bounds and bits behind the well that they divide.
fn in_order() -> Vec<&'static Row> {
    let place = |row: &Row| {
        let beside = match row.key {
            "frame_rate" => "exposure",
            "quantisation_bits" => "full_well",
            key => key,
        };
        (TABLE.iter().position(|row| row.key == beside), row.key != beside)
    };
    let mut rows: Vec<&Row> = TABLE.iter().collect();
    rows.sort_by_key(|row| place(row));
    rows
}

/// A figure in the unit in which it is read best.
fn shown(row: &Row, value: f64) -> String {
    match (row.key, row.kind) {
        ("f_number", _) => format!("f/{value}"),
        ("full_well", _) => format!("{} counts", significant(value, 3)),
        ("read_noise", _) => format!("{} counts", significant(value, 3)),
        (_, Kind::Quantity(Dimension::Rate, ..)) => format!("{} per s", significant(value, 3)),
        (_, Kind::Quantity(Dimension::Frequency, ..)) => format!("{} Hz", significant(value, 3)),
        (_, Kind::Quantity(Dimension::Angle, ..)) => {
            format!("{} deg across", significant(value.to_degrees(), 3))
        }
        (_, Kind::Quantity(Dimension::Temperature, ..)) => celsius(value),
        (_, Kind::Quantity(dimension, ..)) => quantity(value, dimension.unit()),
        _ => format!("{value}"),
    }
}

fn array(figures: &CameraSpec) -> String {
    match (figures.pixels, figures.lines) {
        (Some(pixels), Some(lines)) => format!("{pixels} x {lines}"),
        (Some(pixels), None) => format!("{pixels} across"),
        _ => NOT_STATED.into(),
    }
}

fn full_bands(figures: &CameraSpec) -> String {
    let one = "one, the detector's: a spectrum takes filters, one after the other";
    let Some(readout) = figures.readout else {
        return if figures.spectral_bands == Some(1) { one } else { NOT_STATED }.into();
    };
    match figures.spectral_bands {
        Some(1) if readout != Readout::Sequential => {
            format!("one, the detector's, modelled as any number, {}", readout.name())
        }
        Some(1) => one.into(),
        Some(bands) => format!("{bands}, {}", readout.name()),
        None => readout.name().into(),
    }
}

/// The noise as it is stated, with its conditions.
fn noise(preset: &Preset) -> String {
    let bandwidth = |hz: Option<f64>| {
        hz.map_or_else(|| ", bandwidth 1/(2 x exposure)".into(), |hz| format!(" in {}", quantity(hz, "Hz")))
    };
    match preset.figures.noise.stated() {
        None => NOT_STATED.into(),
        Some(StatedNoise::None) => "no electronic noise".into(),
        Some(StatedNoise::Netd { netd_k, temperature_k, f_number, .. }) => format!(
            "NETD {} at {}, {}",
            quantity(netd_k, "K"),
            temperature_k.map_or_else(|| "a temperature not stated".into(), celsius),
            f_number.map_or_else(|| "an f-number not stated".into(), |f_number| format!("f/{f_number}")),
        ),
        Some(StatedNoise::Detectivity { detectivity_cm_hz05_w, bandwidth_hz }) => {
            format!("D* {} cm Hz^0.5/W{}", significant(detectivity_cm_hz05_w, 3), bandwidth(bandwidth_hz))
        }
        Some(StatedNoise::Nep { nep_w_hz05, bandwidth_hz }) => {
            format!("NEP {} W/Hz^0.5{}", significant(nep_w_hz05, 3), bandwidth(bandwidth_hz))
        }
        Some(StatedNoise::Nesr { microflick, wavelength_um, .. }) => {
            let at = wavelength_um.map_or_else(String::new, |um| {
                let (all, slope) = blackbody_microflick(um, 300.0);
                let kelvin = quantity(microflick / slope, "K");
                format!(
                    " at {um} um: {kelvin} of a blackbody at 300 K there, 1 of {}",
                    fixed(all / microflick, 0)
                )
            });
            format!("NESR {microflick} uflick{at}")
        }
        Some(StatedNoise::Counts { sigma_counts }) => format!("{} counts", significant(sigma_counts, 3)),
    }
}

fn one_exposure(figures: &Figures) -> String {
    let head = format!("\nOne exposure of a blackbody at {}\n", celsius(figures.reference_temperature_k));
    head + &lines(&[
        ("photons", significant(figures.photons, 3)),
        ("noise of a band reading", format!("{} counts", significant(figures.noise_counts, 3))),
        (&format!("gamma of a band, {} bands", figures.bands), significant(figures.gamma_per_band, 2)),
        ("etendue of a pixel", format!("{} m^2 sr", significant(figures.etendue_m2_sr, 3))),
        ("H = t A_p / ((1+gamma) F^2)", format!("{} m^2 s", significant(figures.hardware_m2_s, 3))),
    ])
}

fn equivalents(noise: &Equivalents) -> String {
    let watt = |value: f64, unit: &str| format!("{} {unit}", significant(value, 3));
    let head = format!(
        "\nIts electronic noise, every way of stating it ({}; bands of 1 cm^-1; NEP, D*, NESR at {} cm^-1)\n",
        quantity(noise.exposure_s, "s"),
        significant(noise.mid_cm1, 4)
    );
    let at = format!("at {}, f/{}", celsius(noise.reference_temperature_k), noise.f_number);
    head + &lines(&[
        ("sigma", watt(noise.sigma_counts, "counts")),
        ("NETD, all of the range", format!("{} {at}, behind its optics", quantity(noise.netd_k, "K"))),
        ("NETD with shot noise", quantity(noise.netd_with_shot_noise_k, "K")),
        ("NETD of a single band", quantity(noise.netd_of_a_band_k, "K")),
        ("NEP", format!("{} in {} Hz", watt(noise.nep_w, "W"), significant(noise.bandwidth_hz, 3))),
        ("NEP of 1 Hz", watt(noise.nep_w_hz05, "W/Hz^0.5")),
        (
            "D*",
            noise.detectivity_cm_hz05_w.map_or_else(|| "no noise".into(), |d| watt(d, "cm Hz^0.5/W (Jones)")),
        ),
        ("NESR", format!("{} uflick", significant(noise.nesr_microflick, 3))),
        ("gamma of a band", significant(noise.gamma_per_band, 3)),
    ])
}

fn budget(budget: &[NoiseLine]) -> String {
    let total: f64 = budget.iter().map(|line| line.var_counts).sum();
    let mut table = Columns::new([
        left("line", 34),
        right("variance", 11),
        right("share", 8),
        left("grows as", 8),
        left("from", 0),
    ]);
    for line in budget {
        let (variance, share) = (significant(line.var_counts, 3), part(line.var_counts / total));
        table.row([line.label, &variance, &share, line.scaling, line.source]);
    }
    table.row(["sum", &significant(total, 3)]);
    format!("\nNoise of an average band of 1 cm^-1, blackbody at 300 K\n{}", table.text())
}

fn part(share: f64) -> String {
    if share >= 1e-3 {
        format!("{} %", fixed(100.0 * share, 1))
    } else {
        format!("{} %", significant(100.0 * share, 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A camera whose every figure is stated: what the built-in ones do not show.
    #[test]
    fn a_full_well_and_its_bits_are_shown() {
        let mut preset = hadar::instrument::presets::find("flir-a325sc").unwrap().clone();
        let figures = &mut preset.figures;
        (figures.full_well, figures.quantisation_bits) = (Some(1e7), Some(14));
        (figures.read_noise_counts, figures.dark_rate_per_s) = (Some(360.0), Some(3.3e5));
        let text = text(&Sheet::of(preset).unwrap());
        for part in ["1.00e7 counts", "full after, at 300 K", "quantisation", "read noise", "dark counts"] {
            assert!(text.contains(part), "{part}: {text}");
        }
    }
}
