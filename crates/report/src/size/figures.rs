//! The plots of the main job, each with its table.
//!
//! Every function takes results and gives a figure with the CSV of just what it shows.

use crate::figures::{Plot, band_axis, information_axis, over_bands, wavenumber_axis};
use crate::plot::{self, Axis, HeatMap, LineFigure, Marker, Panel, Rule, Series, Style};
use crate::table::Table;
use crate::words::size::captions;
use hadar::spectrum::Bands;
use hadar_study::{InformationCurves, ObjectAnswer, ObjectCurve, PhotonMap, Spectra, Surface};

/// Curves of a picture: as many as there are colours.
const CURVES: usize = 7;
/// Emissivities are drawn over a range no smaller than this: what is flat shall look flat.
const LEAST_RANGE: f64 = 0.1;

/// Share of the axis by which curves must differ to be seen apart.
const SEEN: f64 = 4e-3;

/// Emissivities at the nodes: as many pictures as it takes to tell the curves apart.
#[must_use]
pub fn emissivities(title: &str, wavenumbers_cm1: &[f64], surfaces: &[&Surface]) -> Vec<Plot> {
    let pictures = surfaces.len().div_ceil(CURVES);
    let one = |(i, drawn): (usize, &[&Surface])| {
        let curves = drawn.iter().map(|own| (format!("emissivity_{}", own.name), own.emissivity.as_slice()));
        let nodes = ("wavenumber_cm1".to_owned(), wavenumbers_cm1);
        let table = Table::of_columns(std::iter::once(nodes).chain(curves));
        let (low, high) = emissivity_range(drawn);
        let (name, title) = match pictures {
            1 => ("emissivities".into(), title.to_owned()),
            _ => (numbered(i).into(), format!("{title}, {} of {pictures}", i + 1)),
        };
        let axis = Axis::linear("emissivity").range(low, high);
        let mut figure = LineFigure::new(title, wavenumber_axis(wavenumbers_cm1), axis);
        for (i, surface) in drawn.iter().enumerate() {
            // On top of an equal curve, so that both are seen.
            let equal = drawn[..i].iter().filter(|other| coincide(surface, other, SEEN * (high - low)));
            let style = [Style::Line, Style::Dashed, Style::Dotted][equal.count().min(2)];
            let curve = Series::line(&surface.name, wavenumbers_cm1.to_vec(), surface.emissivity.clone());
            figure = figure.series(curve.style(style));
        }
        if let Some(panel) = near_ones(wavenumbers_cm1, drawn) {
            figure = figure.lower(panel);
        }
        Plot { name, figure: figure.into(), table }
    };
    surfaces.chunks(CURVES).enumerate().map(one).collect()
}

/// Curves that differ from the first by less than this share of the range of all are drawn once more, as their differences.
const NEAR: f64 = 0.25;

/// Differences from the first surface of those that are near it, where others are so far that these are one line beside them.
fn near_ones(wavenumbers_cm1: &[f64], drawn: &[&Surface]) -> Option<Panel> {
    let (first, others) = drawn.split_first()?;
    let (low, high) = emissivity_range(drawn);
    let off = |other: &Surface| -> Vec<f64> {
        other.emissivity.iter().zip(&first.emissivity).map(|(e, own)| e - own).collect()
    };
    let is_near = |off: &[f64]| off.iter().all(|off| off.abs() < NEAR * (high - low));
    let near: Vec<(usize, Vec<f64>)> = (others.iter().enumerate())
        .map(|(i, other)| (i + 1, off(other)))
        .filter(|(_, off)| is_near(off))
        .collect();
    if near.is_empty() || near.len() == others.len() {
        return None;
    }
    let mut panel =
        Panel::new(Axis::linear(format!("difference from {}", first.name))).rule(Rule::horizontal(0.0, ""));
    for (colour, off) in near {
        panel = panel.series(Series::line("", wavenumbers_cm1.to_vec(), off).colour(colour));
    }
    Some(panel)
}

/// Whether two curves lie on each other.
fn coincide(a: &Surface, b: &Surface, within: f64) -> bool {
    a.emissivity.iter().zip(&b.emissivity).all(|(a, b)| (a - b).abs() <= within)
}

fn numbered(i: usize) -> String {
    if i == 0 { "emissivities".into() } else { format!("emissivities_{}", i + 1) }
}

/// Range of an axis that fits the emissivities, within 0 to 1.
fn emissivity_range(drawn: &[&Surface]) -> (f64, f64) {
    let all = || drawn.iter().flat_map(|surface| &surface.emissivity).copied();
    let (low, high) = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
    if low > high {
        return (0.0, 1.0);
    }
    let margin = (0.06 * (high - low)).max(0.5 * (LEAST_RANGE - (high - low)));
    // What the end of the range cuts off is added at the other end.
    let (low, high) = (low - margin, high + margin);
    let (low, high) = (low - (high - 1.0).max(0.0), high + (-low).max(0.0));
    (low.max(0.0), high.min(1.0))
}

/// The two spectra that look alike, and their difference beside the noise of one reading.
#[must_use]
pub fn spectra(spectra: &Spectra, bands: &Bands, target: &str, alternative: &str) -> Plot {
    let unit = "photons_per_s_m2_sr_cm1";
    let noisy = !spectra.sigma.is_empty();
    let difference: Vec<f64> =
        spectra.nearest.iter().zip(&spectra.target).map(|(nearest, own)| nearest / own - 1.0).collect();
    let share = |sigma: &[f64]| -> Vec<f64> {
        sigma.iter().zip(&spectra.target).map(|(sigma, own)| sigma / own).collect()
    };
    let (shot, total) = (share(&spectra.sigma_shot), share(&spectra.sigma));
    let mut columns = vec![
        ("wavenumber_cm1".to_owned(), &spectra.wavenumber_cm1),
        (format!("target_{target}_{unit}"), &spectra.target),
        (format!("nearest_{alternative}_{unit}"), &spectra.nearest),
        ("relative_difference".to_owned(), &difference),
    ];
    if noisy {
        columns.push(("relative_sigma_shot".to_owned(), &shot));
        columns.push(("relative_sigma_camera".to_owned(), &total));
    }
    let table = Table::of_columns(columns);
    let curve = |label: String, values: &[f64]| {
        let (x, y) = over_bands(bands, values);
        Series::line(label, x, y)
    };
    let percent = |values: &[f64]| values.iter().map(|value| 100.0 * value.abs()).collect::<Vec<f64>>();
    let celsius = spectra.state.temperature_k - 273.15;
    // What is left of a difference where there is none is rounding.
    let equal = difference.iter().all(|share| share.abs() < ROUNDING);
    let mut lower = Panel::new(Axis::log("share of the signal (%)"));
    if !equal {
        lower = lower.series(curve("|nearest − target|".into(), &percent(&difference)).colour(3));
    }
    if noisy {
        lower = lower.series(
            curve("shot noise of one reading, σ".into(), &percent(&shot)).style(Style::Dotted).colour(2),
        );
        // Of a camera without other noise the two are one.
        if shot.iter().zip(&total).any(|(shot, total)| *total > shot * (1.0 + ROUNDING)) {
            let label = "noise of one reading of the camera, σ".into();
            lower = lower.series(curve(label, &percent(&total)).style(Style::Dashed).colour(6));
        }
        lower.y.range = share_range(&percent(&difference), &percent(&shot), &percent(&total));
    }
    let mut figure = LineFigure::new(
        format!("What the camera receives: {target} and the nearest {alternative}"),
        band_axis(bands),
        Axis::linear("photon radiance (photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹)"),
    )
    .subtitle(captions::nearest(alternative, celsius, &spectra.state.lighting, equal))
    .series(curve(target.into(), &spectra.target).colour(0))
    .series(
        curve(format!("{alternative} at {celsius:.1} °C"), &spectra.nearest).style(Style::Dashed).colour(1),
    );
    if !lower.series.is_empty() {
        figure = figure.lower(lower);
    }
    Plot { name: "incident_spectra".into(), figure: figure.into(), table }
}

/// Relative difference of two spectra that is only rounding.
const ROUNDING: f64 = 1e-9;

/// Range of a logarithmic axis on which noise and difference are seen, %: a difference that changes its sign goes through
/// all powers of ten.
fn share_range(difference: &[f64], shot: &[f64], total: &[f64]) -> Option<(f64, f64)> {
    let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    let least = |values: &[f64]| values.iter().copied().fold(f64::INFINITY, f64::min);
    let (difference, high) = (most(difference), most(difference).max(most(shot)).max(most(total)));
    let low = if difference > 1e2 * ROUNDING { least(shot).min(0.05 * difference) } else { least(shot) };
    (low > 0.0 && high.is_finite()).then_some((low / 1.5, high * 1.5))
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
    let with_camera = !curves.camera_bits.is_empty();
    let mut columns = vec![
        ("photons", &curves.photons),
        ("information_bits_nearest", &curves.nearest_bits),
        ("information_bits_local", &curves.local_bits),
    ];
    columns.extend(with_camera.then_some(("information_bits_camera", &curves.camera_bits)));
    let table = Table::of_columns(columns);
    let x = &curves.photons;
    let mut figure = LineFigure::new(
        format!("How many photons distinguish {target} from {alternative}?"),
        Axis::log("photons at the detector"),
        information_axis("information (bits)"),
    )
    .subtitle(captions::INFORMATION)
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

/// The statistical distance of an object over its readings, frames varied, with its ceiling and what is required.
#[must_use]
pub fn object(curve: &ObjectCurve, object: &ObjectAnswer, pair: [&str; 2], required: f64) -> Plot {
    let [target, alternative] = pair;
    let columns = [
        ("frames", &curve.frames),
        ("readings", &curve.readings),
        ("distance_of_object", &curve.of_object),
        ("distance_of_pixel", &curve.of_pixel),
        ("distance_of_independent_readings", &curve.independent),
    ];
    let table = Table::of_columns(columns);
    let (x, frames) = (&curve.readings, &curve.frames);
    // As the root of the readings, from the first one on.
    let (one, last) = (curve.of_pixel[0], x.last().copied().unwrap_or(1.0));
    let independent = (vec![1.0, last], vec![one, one * last.sqrt()]);
    let top = curve.of_object.iter().copied().fold(required, f64::max);
    let low = curve.of_pixel.iter().copied().filter(|d| *d > 0.0).fold(required, f64::min);
    let mut figure = LineFigure::new(
        format!("{target} against {alternative}: {} pixels over frames", plot::number(object.pixels.round())),
        Axis::log("readings (pixels × frames)"),
        Axis::log("statistical distance d").range(low / 1.5, top * 4.0),
    )
    .subtitle(captions::OBJECT)
    .series(Series::line("all pixels of the object", x.clone(), curve.of_object.clone()))
    .series(Series::line("one pixel of it", frames.clone(), curve.of_pixel.clone()).style(Style::Dotted))
    .series(
        Series::line("readings without anything in common", independent.0, independent.1)
            .style(Style::Dashed),
    )
    .rule(Rule::horizontal(required, format!("required: d = {required:.3}")));
    if let Some([_, ceiling]) = object.ceiling_bounds {
        figure = figure.rule(Rule::horizontal(ceiling, format!("frames without end: d = {ceiling:.2}")));
    }
    let here = object.pixels * f64::from(object.frames);
    figure = figure.marker(Marker::new("this camera", here, object.distance_bounds[1]));
    Plot { name: "object".into(), figure: figure.into(), table }
}

/// What a camera collects from the scene, and what that is worth.
#[derive(Debug, Clone)]
pub struct Collected {
    /// Name of the camera.
    pub camera: String,
    /// Photons in all bands of all frames.
    pub photons: f64,
    /// Photons without any other noise that would tell as much.
    pub worth: f64,
}

/// Required photons over target temperature and lighting; the equilibrium singularity is marked, and the scene `here`.
/// Nothing where no number of photons suffices anywhere.
#[must_use]
pub fn photon_map(
    map: &PhotonMap,
    pair: [&str; 2],
    here: (f64, f64),
    by: &str,
    collected: Option<&Collected>,
) -> Option<Plot> {
    let [target, alternative] = pair;
    let mut table = Table::new(["temperature_k", "lighting", "photons_required"]);
    for (j, &lighting) in map.lightings.iter().enumerate() {
        for (i, &temperature_k) in map.temperatures_k.iter().enumerate() {
            table.push_numbers(&[temperature_k, lighting, map.photons[j * map.temperatures_k.len() + i]]);
        }
    }
    let mut finite: Vec<f64> = map.photons.iter().copied().filter(|n| n.is_finite()).collect();
    if finite.is_empty() {
        return None;
    }
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
        format!("Photons required to distinguish {target} from {alternative}"),
        (Axis::linear("target temperature (°C)"), celsius),
        (Axis::linear("thermal lighting factor V"), map.lightings.clone()),
        (Axis::log("required photons").range(low, high), map.photons.clone()),
    )
    .subtitle(captions::photon_map(by, (top == 1.0).then_some(map.equilibrium_k - 273.15)))
    .no_value("no number of photons suffices")
    .contours(levels);
    let at_equilibrium = top == 1.0 && here == (map.equilibrium_k, 1.0);
    let label = if at_equilibrium { "this scene, in equilibrium" } else { "this scene" };
    figure = figure.marker(Marker::new(label, here.0 - 273.15, here.1));
    if top == 1.0 && !at_equilibrium {
        figure = figure.marker(Marker::new("equilibrium", map.equilibrium_k - 273.15, 1.0));
    }
    if let Some(Collected { camera, photons, worth }) = collected {
        let photons_text = plot::number(*photons);
        figure = figure.mark(*photons, format!("{camera} collects {photons_text} in this scene"));
        if *worth < 0.99 * photons {
            figure = figure
                .mark(*worth, format!("what they are worth with its own noise: {}", plot::number(*worth)));
        }
    }
    Some(Plot { name: "required_photons".into(), figure: figure.into(), table })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn surface(emissivity: &[f64]) -> Surface {
        Surface { name: "a".into(), emissivity: emissivity.to_vec(), one_number: None }
    }

    #[test]
    fn emissivities_are_drawn_where_they_are_and_seven_at_a_time() {
        let [flat, black, both] = [surface(&[0.5, 0.5]), surface(&[1.0, 0.98]), surface(&[0.0, 1.0])];
        let range = |drawn: &[&Surface]| emissivity_range(drawn);
        let close = |(a, b): (f64, f64), (c, d): (f64, f64)| (a - c).abs() < 1e-12 && (b - d).abs() < 1e-12;
        assert!(close(range(&[&flat]), (0.45, 0.55)), "{:?}", range(&[&flat]));
        assert!(close(range(&[&black]), (0.9, 1.0)), "{:?}", range(&[&black]));
        assert!(close(range(&[&both, &flat]), (0.0, 1.0)));
        let drawn = emissivities("E", &[800.0, 900.0], &[&flat; 15]);
        let names: Vec<&str> = drawn.iter().map(|plot| plot.name.as_ref()).collect();
        assert_eq!(names, ["emissivities", "emissivities_2", "emissivities_3"]);
        assert!(drawn[2].table.to_csv().unwrap().starts_with("wavenumber_cm1,emissivity_a\n"));
    }

    #[test]
    fn noise_and_difference_are_both_in_view() {
        let (low, high) = share_range(&[0.3, 0.0], &[0.04], &[42.0]).unwrap();
        assert!(low <= 0.015 && high >= 42.0);
        assert_eq!(share_range(&[0.0], &[0.0], &[1.0]), None);
    }
}
