//! The parts of an answer as it is printed: the verdict, what is behind it, what it rests on.

use crate::text::footing::{ASSUMPTIONS, WARNINGS};

/// An answer in parts.
pub(super) struct Answer<'a> {
    /// The first paragraph.
    pub(super) verdict: &'a str,
    /// The rest, without what the page says in sections of its own.
    pub(super) details: &'a str,
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
        Self { verdict, details: rest[..end].trim_matches('\n'), assumptions: assumptions.collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_is_parted_where_its_sections_are() {
        let of = |text| {
            let found = Answer::of(text);
            (found.verdict.to_owned(), found.details.to_owned(), found.assumptions)
        };
        let whole = "No: it cannot.\n\nMargins\n  a  1\n\nAssumptions\n  one\n  two\nWarnings\n  [x] why\n";
        let two = vec!["one".to_owned(), "two".to_owned()];
        assert_eq!(of(whole), ("No: it cannot.".into(), "Margins\n  a  1".into(), two));
        assert_eq!(of("Yes."), ("Yes.".into(), String::new(), vec![]));
        let warned = "Yes.\n\nWarnings\n  [x] why\n";
        assert_eq!(of(warned), ("Yes.".into(), String::new(), vec![]));
    }
}
