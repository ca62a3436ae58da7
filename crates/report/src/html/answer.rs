//! The parts of an answer as it is printed: the verdict, what is behind it, what it rests on.

use crate::text::footing::{ASSUMPTIONS, WARNINGS};

/// An answer in parts.
pub(super) struct Answer<'a> {
    /// The first paragraph.
    pub(super) verdict: &'a str,
    /// What a yes holds only if, and what it rests on, as they are printed.
    pub(super) conditions: String,
    /// The rest, without what the page says in sections of its own.
    pub(super) details: String,
    /// What it rests on, a sentence each.
    pub(super) assumptions: Vec<String>,
}

impl<'a> Answer<'a> {
    pub(super) fn of(text: &'a str) -> Self {
        let text = text.trim();
        let (verdict, rest) = text.split_once("\n\n").unwrap_or((text, ""));
        let from = |heading: &str| {
            let heading = format!("{heading}\n");
            if rest.starts_with(&heading) {
                Some(0)
            } else {
                rest.find(&format!("\n{heading}")).map(|at| at + 1)
            }
        };
        let (assumptions, warnings) = (from(ASSUMPTIONS), from(WARNINGS));
        let end = assumptions.into_iter().chain(warnings).min().unwrap_or(rest.len());
        let assumptions = assumptions.map_or("", |at| &rest[at..]).lines().skip(1);
        let assumptions =
            assumptions.take_while(|line| line.starts_with(' ')).map(|line| line.trim().to_owned());
        let (conditions, details): (Vec<&str>, Vec<&str>) =
            rest[..end].trim_matches('\n').split("\n\n").partition(|block| is_condition(block));
        let (conditions, details) = (conditions.join("\n\n"), details.join("\n\n"));
        Self { verdict, conditions, details, assumptions: assumptions.collect() }
    }
}

/// Whether a paragraph tells on what a verdict depends: below its heading are codes alone.
fn is_condition(block: &str) -> bool {
    let mut lines = block.lines();
    let is_heading = lines.next().is_some_and(|heading| !heading.starts_with(' '));
    let below: Vec<&str> = lines.filter(|line| line.starts_with(' ')).collect();
    is_heading && !below.is_empty() && below.iter().all(|line| line.trim_start().starts_with('['))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_is_parted_where_its_sections_are() {
        let of = |text| {
            let found = Answer::of(text);
            (found.verdict.to_owned(), found.details, found.assumptions)
        };
        let whole = "No: it cannot.\n\nMargins\n  a  1\n\nAssumptions\n  one\n  two\nWarnings\n  [x] why\n";
        let two = vec!["one".to_owned(), "two".to_owned()];
        assert_eq!(of(whole), ("No: it cannot.".into(), "Margins\n  a  1".into(), two));
        assert_eq!(of("Yes."), ("Yes.".into(), String::new(), vec![]));
        let held = Answer::of(
            "Yes, if.\n\nPairs\n  a  1\n\nA yes holds only if\n  [x] why\nIt rests on as well\n  [y] z\n",
        );
        assert_eq!(held.details, "Pairs\n  a  1");
        assert_eq!(held.conditions, "A yes holds only if\n  [x] why\nIt rests on as well\n  [y] z");
        let warned = "Yes.\n\nWarnings\n  [x] why\n";
        assert_eq!(of(warned), ("Yes.".into(), String::new(), vec![]));
    }
}
