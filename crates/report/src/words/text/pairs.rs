//! The target against its alternatives, one line each.

use super::numbers::{numbers, photons, shortened, significant};
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
    let _ = write!(
        out,
        "  {:<width$}  {:>9}  {:>9}  {:>9}  {:>18}  {:>24}",
        "alternative", "nearest", "local", "S29", "photons required", "nearest state"
    );
    out.push_str(if with_camera { "    camera d  told apart" } else { "" });
    out.push_str(if with_camera && by_local { "    limit d\n" } else { "\n" });
    let mut sorted: Vec<&PairResult> = pairs.iter().collect();
    sorted.sort_by(|a, b| decisive(a).total_cmp(&decisive(b)));
    for pair in sorted {
        let nearest = &pair.nearest_state;
        let state = study.units().temperature(nearest.temperature_k) + &numbers(", V ", &nearest.lighting, 2);
        let _ = write!(
            out,
            "  {:<width$}  {:>9}  {:>9}  {:>9}  {:>18}  {state:>24}",
            short.of(&pair.alternative),
            significant(pair.distance_nearest, 3),
            significant(pair.distance_local, 3),
            significant(pair.distance_local_unknown_gain, 3),
            photons(pair.photons_required)
        );
        let reached =
            pair.statistical_distance.map_or_else(String::new, |d| format!("  {:>10}", significant(d, 3)));
        let told = pair.told_apart.map_or("", |told| if told { "         yes" } else { "          no" });
        let limit = pair.statistical_distance_nearest.filter(|_| by_local);
        let limit = limit.map_or_else(String::new, |d| format!("  {:>9}", significant(d, 3)));
        let _ = writeln!(out, "{reached}{told}{limit}");
    }
    out
}
