//! The target against its alternatives, one line each.

use super::columns::{Columns, left, right};
use super::numbers::{numbers, photons, shortened, significant};
use crate::table::yes_no;
use hadar::order;
use hadar_scenario::DistanceKind;
use hadar_study::{NearestProof, PairResult, Study};
use std::fmt::Write as _;

/// The pairs, that which is hardest to tell apart by the distance that decides first.
pub(crate) fn pair_table(pairs: &[PairResult], study: &Study) -> String {
    let kind = study.scenario().requirement.by;
    let decisive = |pair: &PairResult| pair.statistical_distance.unwrap_or_else(|| pair.distance(kind));
    let by_local = kind != DistanceKind::Nearest;
    let with_camera = pairs.iter().any(|pair| pair.statistical_distance.is_some());
    let short = shortened(pairs.iter().map(|pair| pair.alternative.as_str()));
    let width = short.width().max(11);
    let proved = pairs.iter().all(|pair| pair.proof == NearestProof::Proved);
    let proved =
        if proved { format!(", the nearest proved to {:e} of it", study.tolerance()) } else { String::new() };
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
        right("nearest", 9),
        right("local", 9),
        right("S29", 9),
        right("photons required", 18),
        right("nearest state", 24),
    ];
    if with_camera {
        columns.extend([right("camera d", 10), right("told apart", 10)]);
        columns.extend(by_local.then_some(right("limit d", 9)));
    }
    let mut table = Columns::new(columns);
    let mut sorted: Vec<&PairResult> = pairs.iter().collect();
    order::ascending(&mut sorted, |pair| decisive(pair));
    for pair in sorted {
        let nearest = &pair.nearest_state;
        let distances = [pair.distance_nearest, pair.distance_local, pair.distance_local_unknown_gain];
        let mut cells = vec![short.of(&pair.alternative).to_owned()];
        cells.extend(distances.map(|distance| significant(distance, 3)));
        cells.push(photons(pair.photons_required));
        cells.push(study.units().temperature(nearest.temperature_k) + &numbers(", V ", &nearest.lighting, 2));
        cells.extend(pair.statistical_distance.map(|d| significant(d, 3)));
        cells.extend(pair.told_apart.map(yes_no));
        let limit = pair.statistical_distance_nearest.filter(|_| by_local);
        cells.extend(limit.map(|d| significant(d, 3)));
        table.row(cells);
    }
    out + &table.text()
}
