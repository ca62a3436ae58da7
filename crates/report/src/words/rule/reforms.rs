//! Reforms beside the law, in words.

use super::market::of_market;
use super::sources::from_where;
use crate::text::columns::aligned;
use crate::text::significant;
use hadar_scenario::rule::Verdict;
use hadar_study::{BeforeLaw, Reforms};
use std::fmt::Write as _;

/// What each reform changes, then every camera by the law and by each.
#[must_use]
pub fn reforms(found: &Reforms) -> String {
    let mut out = String::new();
    for reform in &found.reforms {
        let when = reform.from.as_ref().map(|day| format!("from {day}"));
        let about: Vec<String> = when.into_iter().chain(reform.status.clone()).collect();
        let about = if about.is_empty() { String::new() } else { format!(" ({})", about.join(", ")) };
        let changes: Vec<String> = found
            .law
            .iter()
            .zip(&reform.cameras)
            .filter(|(law, own)| law.differs_from(own))
            .map(|(law, own)| format!("{} from {} to {}", law.camera, verdict(law), verdict(own)))
            .collect();
        let changes = if changes.is_empty() { "no verdict".to_owned() } else { changes.join("; ") };
        let _ = writeln!(out, "{}{about} changes {changes}.", reform.name);
    }
    out.push('\n');
    let heads = found.reforms.iter().map(|reform| reform.name.clone());
    let head: Vec<String> =
        ["camera".to_owned(), "the rule as it is".to_owned()].into_iter().chain(heads).collect();
    let cell = |one: &BeforeLaw| {
        let by = one.limiting_clause.as_ref().map_or_else(String::new, |clause| format!(", {clause}"));
        format!("{} ({}{by})", verdict(one), significant(one.margin, 3))
    };
    let mut rows = vec![head];
    for (index, law) in found.law.iter().enumerate() {
        let by_reform = found.reforms.iter().filter_map(|reform| reform.cameras.get(index)).map(cell);
        rows.push([law.camera.clone(), cell(law)].into_iter().chain(by_reform).collect());
    }
    out += &aligned(&rows, &[]);
    out += "  in brackets: least margin, above 1 where the demand is met, and the clause of it\n\n";
    for (name, market) in std::iter::once(("the rule as it is", found.market))
        .chain(found.reforms.iter().map(|reform| (reform.name.as_str(), reform.market)))
    {
        if let Some(market) = market {
            let _ = writeln!(out, "{name}: {}", of_market(&market));
        }
    }
    for reform in &found.reforms {
        let set: Vec<String> = reform.set.iter().map(|one| format!("{} = {}", one.key, one.value)).collect();
        let _ = writeln!(out, "{} sets {}: {}", reform.name, set.join("; "), from_where(&reform.ground));
    }
    out += "This holds proposals beside the rule: it changes no certificate.\n";
    out
}

/// A verdict in a word or two.
fn verdict(one: &BeforeLaw) -> &'static str {
    match (one.verdict, one.conditions.is_empty()) {
        (Verdict::Meets, true) => "yes",
        (Verdict::Meets, false) => "yes, if",
        (Verdict::Undecided, _) => "undecided",
        (Verdict::Fails, _) => "no",
    }
}

/// The title of a report about reforms.
pub(crate) fn title_of_reforms(rule: Option<&str>) -> String {
    rule.map_or_else(|| "Reforms beside the law".into(), |rule| format!("{rule}: reforms"))
}
