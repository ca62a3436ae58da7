//! Reforms compared with the law, in words.

use super::market::of_market;
use super::sources::from_where;
use crate::text::columns::aligned;
use crate::text::significant;
use crate::words::shortfall::codes;
use hadar_scenario::rule::Verdict;
use hadar_study::{BeforeLaw, Reformed, Reforms};
use std::fmt::Write as _;

/// What reforms are held beside the rule for.
pub const BESIDE: &str = "These are proposals to change the rule: they change no certificate.";

/// A reform compared with the rule, as a page shows it.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct ReformShown {
    /// Name by which the reform is shown.
    pub name: String,
    /// What it changes, in a sentence.
    pub changes: String,
    /// What it sets, and who says so, in a sentence.
    pub sets: String,
    /// Every camera, in the order of the rule.
    pub cells: Vec<Change>,
}

/// A camera by the rule as it is and by a reform, as a page shows it.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Change {
    /// By the rule as it is: `yes`, `yes, if`, `undecided` or `no`, with the least margin and its clause.
    pub before: String,
    /// Verdict by the reform: `yes`, `yes, if`, `undecided` or `no`, with the least margin and its clause.
    pub after: String,
    /// Whether it is another verdict.
    pub changed: bool,
}

/// Every reform as a page shows it.
#[must_use]
pub fn shown(found: &Reforms) -> Vec<ReformShown> {
    let change = |law: &BeforeLaw, own: &BeforeLaw| Change {
        before: cell(law),
        after: cell(own),
        changed: law.differs_from(own),
    };
    let one = |reform: &Reformed| ReformShown {
        name: reform.name.clone(),
        changes: changes(&found.law, reform),
        sets: what_it_sets(reform),
        cells: found.law.iter().zip(&reform.cameras).map(|(law, own)| change(law, own)).collect(),
    };
    found.reforms.iter().map(one).collect()
}

/// What each reform changes, then every camera by the law and by each.
#[must_use]
pub fn reforms(found: &Reforms) -> String {
    let mut out = String::new();
    for reform in &found.reforms {
        let _ = writeln!(out, "{}", changes(&found.law, reform));
    }
    out.push('\n');
    let heads = found.reforms.iter().map(|reform| reform.name.clone());
    let head: Vec<String> =
        ["camera".to_owned(), "the rule as it is".to_owned()].into_iter().chain(heads).collect();
    let mut rows = vec![head];
    for (index, law) in found.law.iter().enumerate() {
        let by_reform = found.reforms.iter().filter_map(|reform| reform.cameras.get(index)).map(cell);
        rows.push([law.camera.clone(), cell(law)].into_iter().chain(by_reform).collect());
    }
    out += &aligned(&rows, &[]);
    out += "  in brackets: least margin, above 1 where the demand is met, or what spoils the image, and the clause of it\n\n";
    for (name, market) in std::iter::once(("the rule as it is", found.market))
        .chain(found.reforms.iter().map(|reform| (reform.name.as_str(), reform.market)))
    {
        if let Some(market) = market {
            let _ = writeln!(out, "{name}: {}", of_market(&market));
        }
    }
    for reform in &found.reforms {
        let _ = writeln!(out, "{}", what_it_sets(reform));
    }
    let _ = writeln!(out, "{BESIDE}");
    out
}

/// Which verdicts a reform changes.
fn changes(law: &[BeforeLaw], reform: &Reformed) -> String {
    let when = reform.from.as_ref().map(|day| format!("from {day}"));
    let about: Vec<String> = when.into_iter().chain(reform.status.clone()).collect();
    let about = if about.is_empty() { String::new() } else { format!(" ({})", about.join(", ")) };
    let other = law.iter().zip(&reform.cameras).filter(|(law, own)| law.differs_from(own));
    let changes: Vec<String> =
        other.map(|(law, own)| format!("{} from {} to {}", law.camera, of(law), of(own))).collect();
    let changes = if changes.is_empty() { "no verdict".to_owned() } else { changes.join("; ") };
    format!("{}{about} changes {changes}.", reform.name)
}

/// What a reform sets, and who says so.
fn what_it_sets(reform: &Reformed) -> String {
    let set: Vec<String> = reform.set.iter().map(|one| format!("{} = {}", one.key, one.value)).collect();
    format!("{} sets {}: {}", reform.name, set.join("; "), from_where(&reform.ground))
}

/// A verdict with its margin and the clause of that.
fn cell(one: &BeforeLaw) -> String {
    let (why, clause) = match one.spoiled_by.as_slice() {
        [] => (significant(one.margin, 3), &one.limiting_clause),
        by => (codes(by, ", ").replace('-', " "), &one.spoiled_clause),
    };
    let by = clause.as_ref().map_or_else(String::new, |clause| format!(", {clause}"));
    format!("{} ({why}{by})", of(one))
}

fn of(one: &BeforeLaw) -> &'static str {
    verdict(one.verdict, one.conditions.is_empty())
}

/// A verdict in a word or two, a 'meets' with or without open conditions.
pub(super) const fn verdict(of: Verdict, unconditional: bool) -> &'static str {
    match (of, unconditional) {
        (Verdict::Meets, true) => "yes",
        (Verdict::Meets, false) => "yes, if",
        (Verdict::Undecided, _) => "undecided",
        (Verdict::Fails, _) => "no",
    }
}

/// The title of a report about reforms.
pub(crate) fn title_of_reforms(rule: Option<&str>) -> String {
    rule.map_or_else(|| "Reforms compared with the law".into(), |rule| format!("{rule}: reforms"))
}
