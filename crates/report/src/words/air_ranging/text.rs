//! A study of ranging by air as text: the answer, errors over distances, bands, the estimator, what it rests on.

use crate::text::columns::{Columns, right};
use crate::text::footing::{ASSUMPTIONS, warnings};
use crate::text::numbers::{listed, some};
use crate::words::{Say, conditions};
use hadar::order;
use hadar::words::{fixed, length, share, significant};
use hadar_scenario::air_ranging::AirStereo;
use hadar_study::air_ranging::{AirBand, AirPoint, AirRanging};
use std::fmt::Write as _;

/// Distances of a table at most; all of them are in the files.
const SHOWN: usize = 12;
/// Bands that are listed.
const LISTED: usize = 5;

/// The whole answer.
#[must_use]
pub fn text(result: &AirRanging) -> String {
    let verdict = &result.verdict;
    let mut out = format!("{}\n\n", verdict.sentence.say());
    out += &conditions::paragraph(&verdict.conditions, verdict.met == Some(true));
    out.push_str(&distances(result));
    out.push_str(&bands(result));
    out.push_str(&best(result));
    out.push_str(&estimates(result));
    out.push_str(&assumptions(result));
    out.push_str(&warnings(&result.warnings));
    out
}

fn shown(value: Option<f64>) -> String {
    value.map_or_else(|| "none".into(), length)
}

fn signed(bias: f64) -> String {
    format!("{}{}", if bias < 0.0 { "-" } else { "+" }, length(bias.abs()))
}

/// A column: heading, whether there is anything in it, and its cells.
type Column<'a> = (&'a str, Box<dyn Fn(&AirPoint) -> String>);

fn distances(result: &AirRanging) -> String {
    let any = |of: &dyn Fn(&AirPoint) -> Option<f64>| result.curve.iter().any(|point| of(point).is_some());
    let mut columns: Vec<Column<'_>> = vec![("least error", Box::new(|point| shown(point.sigma_m)))];
    if any(&|point| point.sigma_emissivity_known_m) {
        columns.push(("emissivity known", Box::new(|point| shown(point.sigma_emissivity_known_m))));
    }
    if any(&|point| point.sigma_lighting_known_m) {
        columns.push(("lighting known", Box::new(|point| shown(point.sigma_lighting_known_m))));
    }
    columns.push(("all else known", Box::new(|point| shown(point.sigma_others_known_m))));
    if any(&|point| point.bias_without_sky_m) {
        columns.push((
            "off without sky",
            Box::new(|point| match point.bias_without_sky_m {
                // The end of the table says no more than that.
                Some(bias) if point.without_sky_at_edge => {
                    if bias < 0.0 {
                        "to the shortest".into()
                    } else {
                        "to the longest".into()
                    }
                }
                Some(bias) => signed(bias),
                None => "no fit".into(),
            }),
        ));
    }
    if any(&|point| point.sigma_stereo_m) {
        columns.push(("window, air", Box::new(|point| shown(point.sigma_window_m))));
        columns.push(("window, stereo", Box::new(|point| shown(point.sigma_stereo_m))));
    }
    let mut out =
        String::from("Least error of the distance (Cramer-Rao), one pixel, one reading of all bands\n");
    let heads = columns.iter().map(|(heading, _)| right(heading, heading.chars().count().max(11)));
    let mut table = Columns::new(std::iter::once(right("distance", 9)).chain(heads));
    for point in some(result.curve.len(), SHOWN).into_iter().filter_map(|i| result.curve.get(i)) {
        let distance = format!("{} m", significant(point.distance_m, 3));
        table.row(std::iter::once(distance).chain(columns.iter().map(|(_, cell)| cell(point))));
    }
    out.push_str(&table.text());
    if any(&|point| point.bias_without_sky_m) {
        out.push_str(
            "  off without sky: what a model finds too much that takes all light of the target for its own, from counts without noise\n",
        );
    }
    if any(&|point| point.sigma_stereo_m) {
        let said = match result.stereo_crossing_m {
            Some(crossing) => {
                format!("the air is more precise than stereo beyond {} m", significant(crossing, 2))
            }
            None => {
                let air = result.curve.iter().all(|point| point.sigma_window_m < point.sigma_stereo_m);
                let who = if air {
                    "the air is more precise than stereo"
                } else {
                    "stereo is more precise than the air"
                };
                format!("{who} at all of these distances")
            }
        };
        let _ = writeln!(out, "  of a window: {said}");
    }
    out.push('\n');
    out
}

fn bands(result: &AirRanging) -> String {
    let total: f64 = result.bands.iter().map(|band| band.information_per_m2).sum();
    if total <= 0.0 {
        return String::new();
    }
    let mut order: Vec<&AirBand> = result.bands.iter().collect();
    order::descending(&mut order, |b| b.information_per_m2);
    let mut table = Columns::new([
        right("cm^-1", 9),
        right("share of it", 13),
        right("transmittance", 14),
        right("light of the path", 18),
    ]);
    for band in order.iter().take(LISTED) {
        table.row([
            format!("{:.1}", band.center_cm1),
            share(band.information_per_m2 / total),
            significant(band.transmittance, 3),
            share(band.share_of_path),
        ]);
    }
    let at = significant(result.at.distance_m, 3);
    format!("The most informative bands at {at} m, of {}\n{}\n", result.bands.len(), table.text())
}

fn best(result: &AirRanging) -> String {
    let Some(best) = &result.best_bands else { return String::new() };
    let centres: Vec<String> = best.centers_cm1.iter().map(|nu| format!("{nu:.1}")).collect();
    let proved = match (best.exact, best.sigma_proved_m) {
        (true, _) => "proved to be the best choice".to_owned(),
        (false, Some(least)) => format!("no choice of as many is below +- {}: proved", length(least)),
        (false, None) => "nothing is proved of other choices".to_owned(),
    };
    let centres = listed(&centres);
    format!(
        "Best {} bands at {} m: +- {} ({proved}; all {}: +- {})\n  at {centres} cm^-1, exposed as all are\n\n",
        best.count,
        significant(result.at.distance_m, 3),
        shown(best.sigma_m),
        result.bands.len(),
        shown(best.sigma_all_bands_m)
    )
}

fn estimates(result: &AirRanging) -> String {
    if result.witness.is_empty() {
        return String::new();
    }
    let mut table = Columns::new([
        right("distance", 9),
        right("bound", 9),
        right("rms", 9),
        right("rms over bound", 20),
        right("bias", 9),
        right("verdict", 17),
        right("at edge", 8),
    ]);
    for one in &result.witness {
        let interval = one.rmse_over_bound_interval;
        table.row([
            format!("{} m", significant(one.distance_m, 3)),
            length(one.bound_m),
            length(one.errors.rmse),
            format!(
                "{} ({} to {})",
                fixed(one.rmse_over_bound, 3),
                fixed(interval.low, 3),
                fixed(interval.high, 3)
            ),
            signed(one.errors.bias),
            one.verdict.text().to_owned(),
            share(one.at_edge),
        ]);
    }
    let mut out = format!(
        "Maximum likelihood compared with the bound, {} spectra at each distance (95 % intervals), seed {}\n{}",
        result.trials,
        result.seed,
        table.text()
    );
    out.push_str(
        "  where the bound is not small compared with the distance, the estimate is biased and the bound, of unbiased ones, says little; at edge: fits \
         that end at an end of the table of the air\n\n",
    );
    out
}

fn assumptions(result: &AirRanging) -> String {
    let sight = &result.sight;
    let mut out = format!("{ASSUMPTIONS}\n");
    let unknown = if sight.unknown.is_empty() { "nothing".to_owned() } else { sight.unknown.join(", ") };
    let _ = writeln!(out, "  unknown in addition to the distance: {unknown}");
    if let Some(errors) = result.scenario.unknown.emissivity {
        let _ = writeln!(
            out,
            "  emissivity: known but for smooth errors of deviation {} that lose three quarters of their correlation over {} cm^-1 ({} modes)",
            significant(errors.sigma, 2),
            significant(errors.correlation_cm1, 3),
            sight.emissivity_modes
        );
    }
    let _ = writeln!(
        out,
        "  air of {} at {:.1} degC, homogeneous, without haze, rain or scattering; its light is part of the counts and of their noise",
        result.air,
        result.air_temperature_k - 273.15
    );
    let _ = writeln!(
        out,
        "  {} before {}, which fills its pixel; bounds of unbiased estimates, with a prior averaged over it",
        result.camera, result.target
    );
    if let Some(stereo) = &result.scenario.stereo {
        let _ = writeln!(
            out,
            "  stereo: the same camera twice, {} apart, a window of {} x {} pixels whose light changes by {} % from pixel to pixel; by air each \
             of its pixels has its own unknowns",
            length(stereo.baseline_m),
            stereo.window[0],
            stereo.window[1],
            significant(100.0 * stereo.texture, 2)
        );
    }
    out
}

/// Below the pictures of one pixel.
pub(crate) fn one_reading(result: &AirRanging) -> String {
    let unknown = match result.sight.unknown.is_empty() {
        true => "nothing else unknown".to_owned(),
        false => format!("unknown in addition: {}", result.sight.unknown.join(", ")),
    };
    format!("{}, {} bands, one pixel, one reading; {unknown}.", result.camera, result.bands.len())
}

/// Below the errors of a model that leaves the sky out.
pub(crate) fn without_sky(target: &str) -> String {
    format!(
        "Distance of {target} from counts without noise, by a model that takes all of its light for its own emission. Size of the error; its \
         sign is in the table."
    )
}

/// Below a window by the air and by stereo.
pub(crate) fn window(spec: &AirStereo, target: &str) -> String {
    format!(
        "Window of {} × {} pixels of {target}. Stereo: baseline {} m, texture {} % from pixel to pixel.",
        spec.window[0],
        spec.window[1],
        significant(spec.baseline_m, 2),
        significant(100.0 * spec.texture, 2)
    )
}
