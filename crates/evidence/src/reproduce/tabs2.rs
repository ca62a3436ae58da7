//! Table S2: photons and noise of the paper's detectors.

use super::ledger::{Line, Verdict};
use super::order::{Figures, Made};
use super::scene;
use hadar::error::Result;
use hadar::instrument::{Camera, presets};
use hadar::planck;
use hadar::spectrum::Bands;
use hadar::units::SPEED_OF_LIGHT_M_S;
use hadar_report::bundle::Bundle;
use hadar_report::text::significant;
use hadar_scenario::examples;

/// Relative difference up to which a figure counts as the same: the table has three digits.
const TOLERANCE: f64 = 0.02;
/// Temperature of the scenes, K.
const SCENE_K: f64 = 300.0;

pub(super) fn make() -> Result<Made> {
    let study = scene::study(examples::HUMAN_VS_ROBOT)?;
    let mut bundle = Bundle::default();
    bundle.add_asked("scenario.toml", study.scenario().to_toml());
    let (flir, spectrometer) = (presets::get("flir-a325sc")?, presets::get("nicolet-is50")?);
    let mut lines = microbolometer(&flir)?;
    lines.extend(mct(&spectrometer)?);
    lines.extend(occupancies(&flir, &spectrometer)?);
    Ok((bundle, lines, Figures::default()))
}

fn microbolometer(flir: &Camera) -> Result<Vec<Line>> {
    let figures = flir.figures()?;
    let bands = flir.own_bands()?.len() as f64;
    let name = |quantity: &str| format!("FLIR A325sc: {quantity}");
    let line = |quantity: &str, paper: (&str, f64), ours: (String, f64), why: &str| {
        Line::compared("Table S2", name(quantity), paper, ours, (TOLERANCE, false), why)
    };
    let (photons, sigma, gamma) = (figures.photons, figures.noise_counts, figures.gamma_per_band);
    let (in_one, half) = (photons / bands, gamma * (1.0 - flir.flicker_fraction));
    Ok(vec![
        line(
            "photons of a 30 degC blackbody in one frame",
            ("2.51e9 (implied by sigma and gamma)", 2.51e9),
            (format!("{photons:.3e}"), photons),
            "12 um, f/1.3, efficiency 0.99, 12 ms, 715 to 1250 cm^-1; a pixel of 25 um gives 1.08e10",
        ),
        line(
            "the same in one band",
            ("4.69e6 (implied)", 4.69e6),
            (format!("{in_one:.2e}"), in_one),
            "536 bands of 1 cm^-1",
        ),
        line(
            "sigma, counts",
            ("1.77e6", 1.77e6),
            (format!("{sigma:.3e}"), sigma),
            "NETD x dN/dT at 30 degC, optics efficiency 1, sum of 536 bands",
        ),
        line(
            "gamma",
            ("6.68e5", 6.68e5),
            (format!("{gamma:.2e}"), gamma),
            "sigma^2/N of a band; with the photons of all bands it would be 1.25e3",
        ),
        line("gamma_0 = gamma_1 N", ("3.34e5", 3.34e5), (format!("{half:.2e}"), half), "half of gamma each"),
        Line::new(
            "Table S2",
            name("dark counts"),
            "1.15e9",
            "-",
            Verdict::NotReproduced,
            "calibration data: 0.46 of the photons at 30 degC; no figure of the table leads to it",
        ),
    ])
}

fn mct(spectrometer: &Camera) -> Result<Vec<Line>> {
    let bands = Bands::uniform(715.0, 1250.0, 1.0)?;
    let sigma = spectrometer.reading_sigma(&bands).unwrap_or_default();
    let middle = bands.nodes_cm1().iter().position(|nu| *nu == 1000.0);
    let at_10_um = middle.and_then(|i| sigma.get(i)).copied().unwrap_or(f64::NAN);
    Ok(vec![
        Line::compared(
            "Table S2",
            "Nicolet iS50: sigma, counts",
            ("4.53e4", 4.53e4),
            (format!("{at_10_um:.2e} at 10 um"), at_10_um),
            (TOLERANCE, false),
            "sqrt(A/2t)/D* x t/(h c nu); no unique factor explains 0.35 (1/(2 sqrt 2) at 10 um fits, so do others)",
        ),
        Line::new(
            "Table S2",
            "Nicolet iS50: dark counts",
            "-1.46e8",
            "-",
            Verdict::NotReproduced,
            "calibration data: 0.14 of the photons at 30 degC; a 77 K body gives 1e4",
        ),
    ])
}

/// Photons of a coherence time, which the theory takes for few.
fn occupancies(flir: &Camera, spectrometer: &Camera) -> Result<Vec<Line>> {
    let bands = Bands::uniform(715.0, 1250.0, 1.0)?;
    let mut radiance = vec![0.0; bands.len()];
    planck::photon_radiance_into(bands.nodes_cm1(), SCENE_K, &mut radiance);
    let range = |camera: &Camera| {
        let lambda = |radiance: &f64| radiance * camera.etendue_m2_sr(None) / (100.0 * SPEED_OF_LIGHT_M_S);
        let all = radiance.iter().map(lambda);
        let (low, high) = (all.clone().fold(f64::INFINITY, f64::min), all.fold(0.0, f64::max));
        (format!("{} to {}", significant(low, 2), significant(high, 2)), high)
    };
    let line = |camera: &str, (ours, high): (String, f64)| {
        let quantity = format!("{camera}: photons of a coherence time, 300 K");
        if high < 0.1 {
            Line::new("S7", quantity, "<< 1", ours, Verdict::Reproduced, "bunching is negligible")
        } else {
            let why = "S7 lumps 1300 to 3900 modes of its large detector; per mode it is at most 0.034, so the theory holds";
            Line::new("S7", quantity, "<< 1", ours, Verdict::PaperInError, why)
        }
    };
    Ok(vec![line("FLIR A325sc", range(flir)), line("Nicolet iS50", range(spectrometer))])
}
