//! The target against its alternatives, one line each.

use super::columns::{Columns, left, right};
use super::numbers::{between, numbers, photons_between, shortened, significant};
use hadar::order;
use hadar_scenario::DistanceKind;
use hadar_study::{NearestProof, PairResult, Study};
use std::fmt::Write as _;

/// The pairs, that which is hardest to tell apart by the distance that decides first.
pub(crate) fn pair_table(pairs: &[PairResult], study: &Study) -> String {
    let kind = study.scenario().requirement.by;
    let decisive = |pair: &PairResult| pair.statistical_distance.unwrap_or_else(|| pair.distance(kind));
    let all_proved = pairs.iter().all(|pair| pair.proof == NearestProof::Proved);
    // What is proved and what was found stand side by side where they are not the same.
    let wide = if all_proved { 9 } else { 20 };
    let by_local = kind != DistanceKind::Nearest;
    let with_camera = pairs.iter().any(|pair| pair.statistical_distance.is_some());
    let short = shortened(pairs.iter().map(|pair| pair.alternative.as_str()));
    let width = short.width().max(11);
    let proved = if all_proved {
        format!(", the nearest proved to {:e} of it", study.tolerance())
    } else {
        ", from what is proved to what was found".into()
    };
    let mut out = format!("  distances per sqrt(photon){proved}; photons by shot noise alone");
    if with_camera {
        let required = significant(study.required_distance(), 4);
        let _ = write!(out, "; camera d: statistical distance, required {required}");
        if by_local {
            out.push_str(", by the local distance; limit d: by the nearest");
        }
    }
    out.push('\n');
    let mut columns = vec![
        left("alternative", width),
        right("nearest", wide),
        right("local", 9),
        right("S29", 9),
        right("photons required", 18),
        right("closest confuser", 24),
    ];
    if with_camera {
        columns.extend([right("camera d", wide.max(10)), right("distinguished", 10)]);
        columns.extend(by_local.then_some(right("limit d", 9)));
    }
    let mut table = Columns::new(columns);
    let mut sorted: Vec<&PairResult> = pairs.iter().collect();
    order::ascending(&mut sorted, |pair| decisive(pair));
    for pair in sorted {
        let nearest = &pair.nearest_state;
        let distances = [pair.distance_local, pair.distance_local_unknown_gain];
        let [lower, nearest_found] = [pair.distance_nearest_lower, pair.distance_nearest];
        let mut cells = vec![short.of(&pair.alternative).to_owned()];
        cells.push(match pair.proof {
            NearestProof::Proved => significant(nearest_found, 3),
            NearestProof::Searched => between([lower, nearest_found], 3),
        });
        cells.extend(distances.map(|distance| significant(distance, 3)));
        cells.push(photons_between(pair.photons_required_bounds));
        cells.push(study.units().temperature(nearest.temperature_k) + &numbers(", V ", &nearest.lighting, 2));
        cells.extend(pair.statistical_distance_bounds.map(|bounds| between(bounds, 3)));
        cells.extend(pair.told.map(|told| told.name().to_owned()));
        let limit = pair.statistical_distance_nearest.filter(|_| by_local);
        cells.extend(limit.map(|d| significant(d, 3)));
        table.row(cells);
    }
    out + &table.text()
}
