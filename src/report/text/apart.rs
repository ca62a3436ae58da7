//! All materials against all: who can be told from whom.

use super::many::camera;
use super::numbers::{exponential, listed};
use crate::study::{self, Apart, Matrix, Study};
use std::fmt::Write as _;

/// Which materials can be told apart, and which cannot.
pub(super) fn apart(apart: &Apart, study: &Study) -> String {
    let camera = match camera(study) {
        "the camera" => "The camera",
        name => name,
    };
    let pairs = apart.told_apart.len() + apart.not_told_apart.len();
    let reliability = study::reliability(study.required_distance());
    let mut out = format!(
        "{camera} tells {} of {pairs} pairs apart with {reliability} reliability, either of them the target\n",
        apart.told_apart.len()
    );
    if apart.told_apart.is_empty() {
        return out + "  not one pair\n\n";
    }
    let names =
        |pairs: &[[String; 2]]| -> Vec<String> { pairs.iter().map(|[a, b]| format!("{a} | {b}")).collect() };
    let _ = writeln!(out, "  told apart      {}", listed(&names(&apart.told_apart)));
    if !apart.not_told_apart.is_empty() {
        let _ = writeln!(out, "  not told apart  {}", listed(&names(&apart.not_told_apart)));
    }
    if !apart.clusters.is_empty() {
        out.push_str("Clusters of which no two members are told apart\n");
    }
    for (i, cluster) in apart.clusters.iter().enumerate() {
        let _ = writeln!(out, "  {:<3} ({}) {}", i + 1, cluster.len(), listed(cluster));
    }
    out.push('\n');
    out
}

/// Every material as a target, the hardest first.
pub(super) fn matrix(matrix: &Matrix, study: &Study) -> String {
    let mut out = format!("Every material as the target, by the {} distance\n", matrix.by);
    let width = matrix.materials.iter().map(String::len).max().unwrap_or(0).max(8);
    let with_camera = matrix.statistical_distance.is_some();
    let _ = write!(out, "  {:<width$}  {:<width$}  {:>12}", "target", "hardest", "per photon^.5");
    let _ = writeln!(out, "{}", if with_camera { "    camera d   as a target" } else { "" });
    for target in matrix.hardest_first() {
        let _ = write!(
            out,
            "  {:<width$}  {:<width$}  {:>13}",
            target.material,
            target.limiting,
            exponential(target.distance_minimum, 2)
        );
        if let (Some(d), Some(yes)) = (target.statistical_distance_minimum, target.identifiable) {
            let answer = if yes { "yes" } else { "no" };
            let _ = write!(out, "  {:>10}  {answer:>12}", exponential(d, 2));
        }
        out.push('\n');
    }
    out.push('\n');
    if let Some(found) = &matrix.apart {
        out.push_str(&apart(found, study));
    }
    out
}
