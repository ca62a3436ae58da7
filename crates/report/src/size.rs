//! The files of the main job: scenario, tables, the four plots of the limiting pair, and the trade-offs.

pub mod figures;
mod trade_off;

pub use crate::words::size::{check, rows, text};

use self::figures::{Collected, InformationMarks};
use crate::bundle::Bundle;
use crate::classes;
use crate::figures::Plot;
use crate::table::{Table, number, optional};
use crate::tables;
use crate::words::size::captions;
use hadar::error::Result;
use hadar::identifiability::detection;
use hadar::order;
use hadar::parallel;
use hadar::policy::Quantity;
use hadar::policy::trade_off::Resolution;
use hadar_study::{PairResult, Sensitivity, Sizing, Study, Surface};

/// Most alternatives that are drawn into one plot.
const DRAWN: usize = 6;

/// All files of a sizing; paths in the scenario are written relative to `out` where they lie below it.
///
/// # Errors
/// A figure that cannot be drawn.
pub fn bundle(study: &Study, result: &Sizing) -> Result<Bundle> {
    let mut bundle = Bundle::about(study.scenario().title.as_deref());
    bundle.add_asked("scenario.toml", result.scenario.to_toml());
    bundle.add_table("pairs.csv", tables::pairs(&result.pairs))?;
    bundle.add_table("requirement.csv", requirement(result))?;
    if let Some(camera) = &result.camera {
        let mut table = Table::new(["line", "variance_counts2", "grows_with_integration_time_as"]);
        for line in &camera.noise_budget {
            table.push(vec![line.label.into(), number(line.var_counts), line.scaling.into()]);
        }
        bundle.add_table("noise_budget.csv", table)?;
        bundle.add_table("solve_for.csv", solve_for(result))?;
    }
    if let Some(found) = &result.sensitivity {
        bundle.add_table("sensitivity.csv", sensitivity(found))?;
    }
    if let Some(found) = &result.companion {
        bundle.add_table("companion.csv", tables::companions([found]))?;
    }
    bundle.add_conditions(&result.verdict.conditions.iter().map(|one| ("", one)).collect::<Vec<_>>())?;
    if !result.safety.is_empty() {
        bundle.add_table("safety.csv", tables::safety(&result.safety))?;
    }
    bundle.add_warnings(&result.warnings)?;
    bundle.add_plots(&classes::pictures(&result.classes))?;
    bundle.add_plots(&drawn(study, result)?)?;
    let curves = result.trade_offs.iter().flatten();
    bundle.add_plots(&curves.map(|curve| trade_off::trade_off(curve, result)).collect::<Vec<_>>())?;
    Ok(bundle)
}

/// The emissivities of the target and of the alternatives nearest to it, and what the camera receives of the target and of
/// the nearest one.
///
/// # Errors
/// A scene without photons.
pub(crate) fn pictures_of_pairs(study: &Study, pairs: &[PairResult], limiting: &str) -> Result<Vec<Plot>> {
    let mut ranked: Vec<_> = pairs.iter().zip(study.alternatives()).collect();
    order::ascending(&mut ranked, |a| a.0.distance_nearest);
    let nodes = study.surroundings().nodes_cm1();
    let mut closest = vec![study.target()];
    closest.extend(ranked.iter().take(DRAWN).map(|(_, surface)| *surface));
    let target = &study.target().name;
    let others: Vec<&str> = closest.iter().skip(1).map(|surface| surface.name.as_str()).collect();
    let title = captions::emissivities(target, &others, ranked.len());
    let mut drawn = figures::emissivities(&title, nodes, &closest);
    if let Some(surface) = study.alternative(limiting) {
        drawn.push(figures::spectra(&study.spectra(surface)?, study.bands(), target, &surface.name));
    }
    Ok(drawn)
}

/// The two pictures that change with every figure of the camera: information against photons, and one trade-off.
///
/// # Errors
/// A scene without photons.
pub fn followed(
    study: &Study,
    result: &Sizing,
    traded: Option<(Quantity, Quantity)>,
    resolution: Resolution,
) -> Result<Bundle> {
    let limiting = rows::limiting(result).zip(study.alternative(&result.limiting));
    let plots = parallel::booked(2, |i| match i {
        0 => Ok(limiting
            .map(|(pair, surface)| identifiability(study, result, pair, surface, resolution))
            .transpose()?
            .flatten()),
        _ => {
            let curve = traded.map(|pair| study.trade_off(result, pair, resolution)).transpose()?;
            Ok(curve.flatten().map(|curve| trade_off::trade_off(&curve, result)))
        }
    })?;
    let mut bundle = Bundle::default();
    bundle.add_plots(&plots.into_iter().flatten().collect::<Vec<_>>())?;
    Ok(bundle)
}

/// Information against photons; nothing where no photons suffice.
fn identifiability(
    study: &Study,
    result: &Sizing,
    pair: &PairResult,
    surface: &Surface,
    resolution: Resolution,
) -> Result<Option<Plot>> {
    if result.requirement.photons_bounds[0].is_none() {
        return Ok(None);
    }
    let marks = InformationMarks {
        camera: match (&result.camera, pair.information_bits) {
            (Some(camera), Some(bits)) => Some((camera.camera.name.clone(), camera.photons, bits)),
            _ => None,
        },
        required_bits: detection::information_bits(study.required_distance()),
        required_distance: study.required_distance(),
    };
    let [nearest, local] = [pair.distance_nearest, pair.distance_local];
    let curves = study.information_curves(surface, nearest, local, 2 * resolution.points - 1)?;
    Ok(Some(figures::identifiability(&curves, &pair.target, &pair.alternative, &marks)))
}

/// The four plots of the limiting pair; what it takes is left out where nothing suffices.
fn drawn(study: &Study, result: &Sizing) -> Result<Vec<Plot>> {
    let mut drawn = pictures_of_pairs(study, &result.pairs, &result.limiting)?;
    let limiting =
        result.pairs.iter().zip(study.alternatives()).find(|(pair, _)| pair.alternative == result.limiting);
    let Some((pair, surface)) = limiting else { return Ok(drawn) };
    let (target, other) = (pair.target.as_str(), pair.alternative.as_str());
    drawn.extend(identifiability(study, result, pair, surface, Resolution::FINE)?);
    if let Some((curve, object)) = study.object_curve(surface)?.zip(result.object.as_ref()) {
        let required = result.requirement.distance;
        drawn.push(figures::object(&curve, object, [target, other], required));
    }
    if let Some(map) = study.photon_map(surface)? {
        let state = study.state();
        let here = (state.temperature_k, state.lighting.first().copied().unwrap_or(0.0));
        let collected = collected(result, pair);
        let by = result.requirement.by;
        drawn.extend(figures::photon_map(&map, [target, other], here, by, collected.as_ref()));
    }
    Ok(drawn)
}

/// Photons of the camera, and the number without other noise that reaches the same statistical distance.
fn collected(result: &Sizing, pair: &PairResult) -> Option<Collected> {
    let (camera, needed) = (result.camera.as_ref()?, result.requirement.photons_bounds[0]?);
    let margin = pair.statistical_distance? / result.requirement.distance;
    Some(Collected {
        camera: camera.camera.name.clone(),
        photons: camera.photons,
        worth: needed * margin * margin,
    })
}

fn requirement(result: &Sizing) -> Table {
    let mut table = Table::new([
        "reading",
        "distance_per_sqrt_photon",
        "photons",
        "hardware_m2_s",
        "decides",
        "photons_proved",
        "hardware_proved_m2_s",
    ]);
    let pair = rows::limiting(result);
    let (n, h) = (result.requirement.photons_by, result.requirement.hardware_by_m2_s);
    let distances = pair.map_or([0.0; 3], |pair| {
        [pair.distance_nearest, pair.distance_local, pair.distance_local_unknown_gain]
    });
    let readings = [
        ("nearest", n.nearest, h.nearest),
        ("local", n.local, h.local),
        ("local-unknown-gain", n.local_unknown_gain, h.local_unknown_gain),
    ];
    for ((reading, photons, hardware), distance) in readings.into_iter().zip(distances) {
        let decides = if reading == result.requirement.by { "yes" } else { "no" };
        let proved = result.requirement.photons.zip(result.requirement.hardware_m2_s);
        let proved = proved.filter(|_| reading == result.requirement.by);
        let row = [
            reading.into(),
            number(distance),
            optional(photons),
            optional(hardware),
            decides.into(),
            optional(proved.map(|proved| proved.0)),
            optional(proved.map(|proved| proved.1)),
        ];
        table.push(row.to_vec());
    }
    table
}

fn solve_for(result: &Sizing) -> Table {
    let mut table = Table::new(["quantity", "value", "camera", "statistical_distance", "reason", "caps"]);
    for (quantity, solution) in result.solve_for.iter().flat_map(|solutions| &solutions.0) {
        table.push(vec![
            quantity.key().into(),
            optional(solution.value),
            // A distance that is not stated, a speed that nobody knows.
            optional(Some(solution.camera).filter(|value| value.is_finite())),
            optional(Some(solution.statistical_distance).filter(|value| value.is_finite())),
            solution.reason.clone().unwrap_or_default(),
            solution.caps.iter().map(|cap| cap.code.name()).collect::<Vec<_>>().join(" "),
        ]);
    }
    table
}

fn sensitivity(found: &Sensitivity) -> Table {
    let mut table = Table::new(["quantity", "value", "numerical_error"]);
    for (lever, elasticity) in &found.elasticities.0 {
        let of = |number: fn(&hadar::policy::elasticity::Elasticity) -> f64| {
            optional(elasticity.as_ref().map(number))
        };
        table.push(vec![format!("elasticity_{}", lever.key()), of(|e| e.value), of(|e| e.error)]);
    }
    let of = &found.emissivity;
    let rows = [
        ("emissivity_error", Some(of.error)),
        ("emissivity_correlation_cm1", Some(of.correlation_cm1)),
        ("distance", Some(of.distance)),
        ("distance_5", Some(of.distance_5)),
        ("distance_50", Some(of.distance_50)),
        ("distance_95", Some(of.distance_95)),
        ("share_met", Some(of.share_met)),
        ("sigma_linear", of.sigma_linear),
    ];
    for (name, value) in rows {
        table.push(vec![name.into(), optional(value), String::new()]);
    }
    table
}
