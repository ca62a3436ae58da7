//! Numbers and names as text: as short as they can be without losing what matters.

pub(crate) use hadar::words::fixed;
use hadar::words::whole;
pub use hadar::words::{quantity, significant};
use std::collections::{BTreeMap, BTreeSet};

/// Share up to which two ends of an interval are one number: that to which a distance of many unknowns is proved.
const SAME: f64 = 0.998;

pub(crate) fn photons(count: Option<f64>) -> String {
    count.map_or_else(|| "no number suffices".into(), |count| significant(count, 3))
}

/// What is between two ends: one number where they are the same in the digits shown.
#[must_use]
pub fn between([low, high]: [f64; 2], digits: u32) -> String {
    let [from, to] = [low, high].map(|end| significant(end, digits as usize));
    if from == to || low >= SAME * high { to } else { format!("{from} to {to}") }
}

/// A number of pixels, which may be one on average: all digits of a whole one.
pub(crate) fn in_number(count: f64) -> String {
    if count.fract() == 0.0 && count < 1e15 { whole(count as u64) } else { significant(count, 3) }
}

/// Photons that a task takes: the least number that may do, and that which is proved to.
#[must_use]
pub fn photons_between([least, enough]: [Option<f64>; 2]) -> String {
    match (least, enough) {
        (Some(least), Some(enough)) => between([least, enough], 3),
        (Some(least), None) => format!("from {}", significant(least, 3)),
        (None, _) => photons(None),
    }
}

pub(crate) fn celsius(kelvin: f64) -> String {
    format!("{} degC", fixed(kelvin - 273.15, 2))
}

/// Degrees Celsius, without their unit.
pub(crate) fn degrees(kelvin: f64) -> String {
    fixed(kelvin - 273.15, 1)
}

/// `a`, `a and b`, `a, b and c`, or with another word before the last one.
pub(crate) fn in_a_row<S: AsRef<str>>(names: &[S], before_last: &str) -> String {
    let names: Vec<&str> = names.iter().map(AsRef::as_ref).collect();
    match names.as_slice() {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [first @ .., last] => format!("{} {before_last} {last}", first.join(", ")),
    }
}

/// Places of `most` of many things, evenly from the first to the last; of all where they are no more.
pub(crate) fn some(all: usize, most: usize) -> Vec<usize> {
    match all <= most {
        true => (0..all).collect(),
        false => (0..most).map(|i| i * (all - 1) / (most - 1)).collect(),
    }
}

/// Numbers with `decimals` decimals behind a label; nothing where there are none.
pub(crate) fn numbers(label: &str, values: &[f64], decimals: usize) -> String {
    let values: Vec<String> = values.iter().map(|value| fixed(*value, decimals)).collect();
    if values.is_empty() { String::new() } else { format!("{label}{}", values.join(" ")) }
}

/// Names listed in one line at most; all of them are in the tables.
const LISTED: usize = 12;
/// Characters of a name in a table: at its start and at its end, where files of a library differ.
const NAME: [usize; 2] = [12, 29];

/// A list, cut short where it is long.
pub(crate) fn listed<S: AsRef<str>>(all: &[S]) -> String {
    let shown: Vec<&str> = all.iter().take(LISTED).map(AsRef::as_ref).collect();
    match all.len().checked_sub(LISTED) {
        Some(more) if more > 0 => format!("{} and {more} more", shown.join(", ")),
        _ => shown.join(", "),
    }
}

/// Names as they fit into a table.
pub(crate) struct Shortened<'a>(BTreeMap<&'a str, String>);

impl<'a> Shortened<'a> {
    /// The name as it is shown.
    pub(crate) fn of(&self, name: &'a str) -> &str {
        self.0.get(name).map_or(name, String::as_str)
    }

    /// Characters of the longest one.
    pub(crate) fn width(&self) -> usize {
        self.0.values().map(|name| name.chars().count()).max().unwrap_or(0)
    }
}

/// Long names cut in the middle, since they differ at their ends; whole where two would become the same.
pub(crate) fn shortened<'a>(names: impl IntoIterator<Item = &'a str>) -> Shortened<'a> {
    let names: BTreeSet<&str> = names.into_iter().collect();
    let mut found: BTreeMap<String, usize> = BTreeMap::new();
    for name in &names {
        *found.entry(cut(name)).or_default() += 1;
    }
    let shown = |name: &str| Some(cut(name)).filter(|short| found.get(short) == Some(&1));
    let pairs = names.iter().map(|name| (*name, shown(name).unwrap_or_else(|| (*name).to_owned())));
    Shortened(pairs.collect())
}

fn cut(name: &str) -> String {
    let characters: Vec<char> = name.chars().collect();
    let [first, last] = NAME;
    if characters.len() <= first + 3 + last {
        return name.to_owned();
    }
    let part = |range: &[char]| range.iter().collect::<String>();
    format!("{}...{}", part(&characters[..first]), part(&characters[characters.len() - last..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_names_are_cut_in_the_middle_unless_they_become_the_same() {
        let long = "basalt@rock-igneous-mafic-solid-basalt-h1-jhu-nicolet";
        let names = shortened([long, "skin"]);
        assert_eq!(names.of(long), "basalt@rock-...c-solid-basalt-h1-jhu-nicolet");
        assert_eq!((names.of("skin"), names.of("other"), names.width()), ("skin", "other", 44));
        let twin = "basalt@rock-igneous-felsic-solid-basalt-h1-jhu-nicolet";
        assert_eq!(shortened([long, twin]).of(twin), twin);
        assert_eq!(listed(&["b"; 14]), "b, ".repeat(11) + "b and 2 more");
        assert_eq!(shortened(["ä".repeat(60).as_str()]).width(), 44);
    }
}
