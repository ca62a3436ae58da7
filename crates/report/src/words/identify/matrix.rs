//! All materials against all: who can be told from whom.

use super::terms::{camera, told_by};
use crate::table::yes_no;
use crate::text::columns::{Columns, left, right};
use crate::text::numbers::{between, listed, shortened, significant};
use crate::words::{probability as words, safety};
use hadar_study::{Apart, Matrix, Study};
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// Which materials can be told apart, and which cannot.
pub(super) fn apart(apart: &Apart, study: &Study) -> String {
    let camera = match camera(study) {
        "the camera" => "The camera",
        name => name,
    };
    let pairs = apart.told_apart.len() + apart.not_told_apart.len();
    let reliability = words::demanded(study.required_distance());
    let mut out = format!(
        "{camera} distinguishes {} of {pairs} pairs with a probability of {reliability}, either of them the target{}\n",
        apart.told_apart.len(),
        told_by(study)
    );
    if apart.told_apart.is_empty() {
        return out + "  not one pair\n\n";
    }
    let all = apart.told_apart.iter().chain(&apart.not_told_apart).flatten();
    let short = shortened(all.map(String::as_str));
    let names = |pairs: &[[String; 2]]| -> Vec<String> {
        pairs.iter().map(|pair| pair.each_ref().map(|name| short.of(name)).join(" | ")).collect()
    };
    let _ = writeln!(out, "  distinguished      {}", listed(&names(&apart.told_apart)));
    if !apart.not_told_apart.is_empty() {
        let _ = writeln!(out, "  not distinguished  {}", listed(&names(&apart.not_told_apart)));
    }
    let mut groups = |heading: &str, groups: &[Vec<String>]| {
        if groups.is_empty() {
            return;
        }
        let _ = writeln!(out, "{heading}");
        for (i, group) in groups.iter().enumerate() {
            let members: Vec<&str> = group.iter().map(|name| short.of(name)).collect();
            let _ = writeln!(out, "  {:<3} ({}) {}", i + 1, group.len(), listed(&members));
        }
    };
    if same_groups(&apart.clusters, &apart.chains) {
        groups("Clusters of which no two members are distinguished", &apart.clusters);
    } else {
        groups(
            "Clusters of which no two members are distinguished; members of different clusters may still be confused",
            &apart.clusters,
        );
        groups("Chains: groups connected by pairs that are not distinguished", &apart.chains);
    }
    out.push('\n');
    out
}

/// Whether two lists of groups are the same, in whatever order.
fn same_groups(a: &[Vec<String>], b: &[Vec<String>]) -> bool {
    let sets = |groups: &[Vec<String>]| -> BTreeSet<BTreeSet<String>> {
        groups.iter().map(|group| group.iter().cloned().collect()).collect()
    };
    sets(a) == sets(b)
}

/// Which materials can be told apart, then every material as a target, the hardest first.
pub(super) fn matrix(matrix: &Matrix, study: &Study) -> String {
    let mut out = matrix.apart.as_ref().map_or_else(String::new, |found| apart(found, study));
    let short = shortened(matrix.materials.iter().map(String::as_str));
    let with_camera = matrix.statistical_distance.is_some();
    let _ = writeln!(
        out,
        "Every material as the target, by the {} distance (per sqrt(photon){})",
        matrix.by,
        if with_camera { "; camera d: statistical distance" } else { "" }
    );
    let width = short.width().max(8);
    let mut columns = vec![left("target", width), left("hardest", width), right("distance", 12)];
    if with_camera {
        columns.extend([right("camera d", 10), right(" as a target", 11)]);
    }
    let mut table = Columns::new(columns);
    for target in matrix.hardest_first() {
        let distance = significant(target.distance_minimum, 3);
        let names = [&target.material, &target.limiting].map(|name| short.of(name).to_owned());
        let mut cells: Vec<String> = names.into_iter().chain([distance]).collect();
        if let (Some(d), Some(yes)) = (target.statistical_distance_minimum, target.identifiable) {
            let lower = target.statistical_distance_minimum_lower.unwrap_or(d);
            cells.extend([between([lower, d], 3), yes_no(yes)]);
        }
        table.row(cells);
    }
    out.push_str(&table.text());
    out.push('\n');
    out + &safety::of_matrix(&matrix.safety)
}
