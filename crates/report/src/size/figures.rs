//! The four plots of the main job, each with its table.
//!
//! Every function takes results and gives a figure with the CSV of just what it shows.

use crate::figures::{Plot, wavenumber_axis};
use crate::plot::{Axis, Band, HeatMap, LineFigure, Marker, Panel, Rule, Series, Style};
use crate::table::Table;
use crate::text::significant;
use hadar_study::study::{InformationCurves, PhotonMap, Spectra, Surface};

/// Emissivities of a first surface and of others at the nodes.
#[must_use]
pub fn emissivities(
    title: &str,
    wavenumbers_cm1: &[f64],
    target: &Surface,
    alternatives: &[&Surface],
) -> Plot {
    let mut header = vec!["wavenumber_cm1".to_owned(), format!("emissivity_{}", target.name)];
    header.extend(alternatives.iter().map(|surface| format!("emissivity_{}", surface.name)));
    let mut table = Table::new(header);
    for (j, &nu) in wavenumbers_cm1.iter().enumerate() {
        let mut row = vec![nu, target.emissivity[j]];
        row.extend(alternatives.iter().map(|surface| surface.emissivity[j]));
        table.push_numbers(&row);
    }
    let mut figure =
        LineFigure::new(title, wavenumber_axis(wavenumbers_cm1), Axis::linear("emissivity").range(0.0, 1.0))
            .series(Series::line(&target.name, wavenumbers_cm1.to_vec(), target.emissivity.clone()));
    for surface in alternatives {
        figure =
            figure.series(Series::line(&surface.name, wavenumbers_cm1.to_vec(), surface.emissivity.clone()));
    }
    Plot { name: "emissivities".into(), figure: figure.into(), table }
}

/// The two spectra that look alike, and their difference against the noise of one reading.
#[must_use]
pub fn spectra(spectra: &Spectra, target: &str, alternative: &str) -> Plot {
    let unit = "photons_per_s_m2_sr_cm1";
    let mut header = vec![
        "wavenumber_cm1".to_owned(),
        format!("target_{target}_{unit}"),
        format!("nearest_{alternative}_{unit}"),
        "relative_difference".to_owned(),
    ];
    let noisy = !spectra.sigma.is_empty();
    if noisy {
        header.push("relative_sigma_shot".to_owned());
        header.push("relative_sigma_camera".to_owned());
    }
    let mut table = Table::new(header);
    let relative: Vec<f64> = spectra
        .nearest
        .iter()
        .zip(&spectra.target)
        .map(|(nearest, own)| 100.0 * (nearest / own - 1.0))
        .collect();
    let share = |sigma: &[f64]| -> Vec<f64> {
        sigma.iter().zip(&spectra.target).map(|(sigma, own)| 100.0 * sigma / own).collect()
    };
    let (shot, total) = (share(&spectra.sigma_shot), share(&spectra.sigma));
    for j in 0..spectra.wavenumber_cm1.len() {
        let mut row =
            vec![spectra.wavenumber_cm1[j], spectra.target[j], spectra.nearest[j], 0.01 * relative[j]];
        if noisy {
            row.extend([0.01 * shot[j], 0.01 * total[j]]);
        }
        table.push_numbers(&row);
    }
    let x = &spectra.wavenumber_cm1;
    let celsius = spectra.state.temperature_k - 273.15;
    let lighting: Vec<String> = spectra.state.lighting.iter().map(|v| format!("{v:.3}")).collect();
    let mut lower = Panel::new(Axis::linear("difference (%)"));
    if noisy {
        let limits = |sigma: &[f64]| (sigma.iter().map(|s| -s).collect::<Vec<f64>>(), sigma.to_vec());
        let (low, high) = limits(&shot);
        lower = lower.band(Band::new("± shot noise, one reading", x.clone(), low, high));
    }
    lower = lower.series(Series::line("nearest − target", x.clone(), relative).colour(1));
    let camera_note = match (spectra.sigma.first(), total.is_empty()) {
        (Some(_), false) => {
            let mean = total.iter().sum::<f64>() / total.len() as f64;
            format!(" Noise of one reading of the camera: {} % of the signal.", significant(mean, 2))
        }
        _ => String::new(),
    };
    let mut figure = LineFigure::new(
        format!("What the camera receives: {target} and the nearest {alternative}"),
        wavenumber_axis(x),
        Axis::linear("photon radiance (photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹)"),
    )
    .subtitle(format!(
        "The nearest {alternative} is at {celsius:.2} °C with lighting {}.{camera_note}",
        lighting.join(", ")
    ))
    .series(Series::line(target, x.clone(), spectra.target.clone()).colour(0))
    .series(
        Series::line(format!("{alternative} at {celsius:.1} °C"), x.clone(), spectra.nearest.clone())
            .style(Style::Dashed)
            .colour(1),
    )
    .lower(lower);
    if noisy {
        let edge = |sign: f64| -> Vec<f64> {
            spectra.target.iter().zip(&spectra.sigma).map(|(own, sigma)| own + sign * sigma).collect()
        };
        figure =
            figure.band(Band::new("± camera noise, one reading", x.clone(), edge(-1.0), edge(1.0)).colour(2));
    }
    Plot { name: "incident_spectra".into(), figure: figure.into(), table }
}

/// What the identifiability plot marks besides its curves.
#[derive(Debug, Clone, Default)]
pub struct InformationMarks {
    /// Name of the camera, its photons and bits.
    pub camera: Option<(String, f64, f64)>,
    /// Bits that the requirement demands.
    pub required_bits: f64,
    /// Statistical distance that the requirement demands.
    pub required_distance: f64,
}

/// Information against photons, with this camera marked.
#[must_use]
pub fn identifiability(
    curves: &InformationCurves,
    target: &str,
    alternative: &str,
    marks: &InformationMarks,
) -> Plot {
    let mut header = vec!["photons", "information_bits_nearest", "information_bits_local"];
    let with_camera = !curves.camera_bits.is_empty();
    if with_camera {
        header.push("information_bits_camera");
    }
    let mut table = Table::new(header);
    for j in 0..curves.photons.len() {
        let mut row = vec![curves.photons[j], curves.nearest_bits[j], curves.local_bits[j]];
        if with_camera {
            row.push(curves.camera_bits[j]);
        }
        table.push_numbers(&row);
    }
    let x = &curves.photons;
    let mut figure = LineFigure::new(
        format!("How many photons it takes to tell {target} from {alternative}"),
        Axis::log("photons at the detector"),
        Axis::linear("information (bits)").range(0.0, 1.05),
    )
    .subtitle("Information log₂ 2P; 1 bit is certainty. The camera's photons grow with its exposure.")
    .series(Series::line("shot-noise limit (nearest distance)", x.clone(), curves.nearest_bits.clone()))
    .series(
        Series::line("shot noise, local distance", x.clone(), curves.local_bits.clone()).style(Style::Dashed),
    )
    .rule(Rule::horizontal(
        marks.required_bits,
        format!("required: d = {:.3}, {:.2} bit", marks.required_distance, marks.required_bits),
    ));
    if with_camera {
        let name = marks.camera.as_ref().map_or("camera", |(name, ..)| name.as_str());
        figure = figure.series(Series::line(
            format!("{name}, exposure varied"),
            x.clone(),
            curves.camera_bits.clone(),
        ));
    }
    if let Some((name, photons, bits)) = &marks.camera {
        figure = figure.marker(Marker::new(name.clone(), *photons, *bits));
    }
    Plot { name: "identifiability".into(), figure: figure.into(), table }
}

/// Required photons over target temperature and lighting; the equilibrium singularity is marked.
#[must_use]
pub fn photon_map(map: &PhotonMap, target: &str, alternative: &str, here: (f64, f64), by: &str) -> Plot {
    let mut table = Table::new(["temperature_k", "lighting", "photons_required"]);
    for (j, &lighting) in map.lightings.iter().enumerate() {
        for (i, &temperature_k) in map.temperatures_k.iter().enumerate() {
            table.push_numbers(&[temperature_k, lighting, map.photons[j * map.temperatures_k.len() + i]]);
        }
    }
    let mut finite: Vec<f64> = map.photons.iter().copied().filter(|n| n.is_finite()).collect();
    finite.sort_by(f64::total_cmp);
    let quantile = |share: f64| {
        let last = finite.len().saturating_sub(1);
        finite.get((share * last as f64) as usize).copied().unwrap_or(1.0)
    };
    // The singularity reaches to infinity; the colours end where one cell in fifty begins.
    let low = 10f64.powf(quantile(0.0).log10().floor());
    let high = 10f64.powf(quantile(0.98).log10().ceil()).max(10.0 * low);
    let levels: Vec<f64> =
        (0..40).map(|i| low * 10f64.powi(i)).filter(|level| *level > low && *level < high).collect();
    let celsius: Vec<f64> = map.temperatures_k.iter().map(|t| t - 273.15).collect();
    let top = map.lightings.last().copied().unwrap_or(1.0);
    let mut figure = HeatMap::new(
        format!("Photons needed to tell {target} from {alternative}"),
        (Axis::linear("target temperature (°C)"), celsius),
        (Axis::linear("thermal lighting factor V"), map.lightings.clone()),
        (Axis::log("required photons").range(low, high), map.photons.clone()),
    )
    .subtitle(if top == 1.0 {
        format!(
            "By the {by} distance, shot noise only. In equilibrium (V = 1, T = {:.1} °C) no number of photons suffices.",
            map.equilibrium_k - 273.15
        )
    } else {
        format!("By the {by} distance, shot noise only. V is that of the first of the surroundings, the others' held.")
    })
    .no_value("no number of photons suffices")
    .contours(levels)
    .marker(Marker::new("this scene", here.0 - 273.15, here.1));
    if top == 1.0 {
        figure = figure.marker(Marker::new("equilibrium", map.equilibrium_k - 273.15, 1.0));
    }
    Plot { name: "required_photons".into(), figure: figure.into(), table }
}
