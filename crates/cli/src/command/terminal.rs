//! How texts look on a terminal: a verdict, an error and a warning in colour, long lines wrapped to its width.
//!
//! Where the output is no terminal nothing is changed, so that a text is the same in every file and pipe. Colour follows
//! `NO_COLOR` and `CLICOLOR_FORCE`.

use console::{Style, Term};
use hadar::words::visible;

/// Narrowest column that is worth wrapping into.
const NARROWEST: usize = 24;
/// Words from which on the last cell of a row is a sentence, which may be wrapped.
const SENTENCE: usize = 5;

/// Where a text goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stream {
    Out,
    Err,
}

impl Stream {
    /// Columns of a terminal; none of a file or pipe.
    fn width(self) -> Option<usize> {
        let term = match self {
            Self::Out => Term::stdout(),
            Self::Err => Term::stderr(),
        };
        // A terminal that does not know its size says 0.
        term.size_checked().map(|(_, columns)| usize::from(columns)).filter(|columns| *columns > NARROWEST)
    }

    fn is_coloured(self) -> bool {
        match self {
            Self::Out => console::colors_enabled(),
            Self::Err => console::colors_enabled_stderr(),
        }
    }

    /// An answer as it is shown here.
    pub(super) fn answer(self, text: &str) -> String {
        dressed(&visible(text), self.width(), self.is_coloured())
    }

    /// A message behind its first word (`error:`), as it is shown here.
    pub(super) fn message(self, word: &str, text: &str) -> String {
        let line = wrapped(&format!("{word} {}", visible(text)), self.width());
        match line.strip_prefix(word) {
            Some(rest) => {
                format!("{}{rest}", style_of(word).force_styling(self.is_coloured()).apply_to(word))
            }
            None => line,
        }
    }
}

fn style_of(word: &str) -> Style {
    match word {
        "Yes" => Style::new().green().bold(),
        "No" | "error:" => Style::new().red().bold(),
        _ => Style::new().yellow().bold(),
    }
}

/// A text, its lines wrapped and its verdict and warnings coloured.
fn dressed(text: &str, width: Option<usize>, coloured: bool) -> String {
    let mut lines = text.lines().enumerate().map(|(index, line)| {
        let word = marked(index, line);
        let line = wrapped(line, width);
        match line.split_once(word).filter(|_| !word.is_empty()) {
            Some((before, after)) => {
                format!("{before}{}{after}", style_of(word).force_styling(coloured).apply_to(word))
            }
            None => line,
        }
    });
    let first = lines.next().unwrap_or_default();
    lines.fold(first, |all, line| all + "\n" + &line)
}

/// The part of a line to be coloured: the verdict that it begins with, the head or the code of a warning.
fn marked(index: usize, line: &str) -> &str {
    let is_word =
        |word: &&str| line.strip_prefix(word).is_some_and(|rest| rest.starts_with([' ', ':', ',', '.']));
    if index == 0 {
        return ["Yes", "No"].into_iter().find(is_word).unwrap_or_default();
    }
    match line.strip_prefix("  [").and_then(|rest| rest.split_once(']')) {
        _ if line == "Warnings" => line,
        Some((code, _)) if code.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-') => {
            &line[2..code.len() + 4]
        }
        _ => "",
    }
}

/// A text in lines of so many columns, each of its lines on its own; what does not fit is continued below where it began.
fn wrapped(text: &str, width: Option<usize>) -> String {
    let Some(width) = width else { return text.to_owned() };
    let lines: Vec<String> = text.lines().map(|line| wrapped_line(line, width)).collect();
    lines.join("\n")
}

fn wrapped_line(line: &str, width: usize) -> String {
    let letters = |text: &str| text.chars().count();
    let Some(indent) = hanging(line).filter(|indent| letters(line) > width && indent + NARROWEST <= width)
    else {
        return line.to_owned();
    };
    let start = line.char_indices().nth(indent).map_or(line.len(), |(at, _)| at);
    let (head, rest) = line.split_at(start);
    let (mut out, mut column) = (head.to_owned(), indent);
    for (index, word) in rest.split(' ').enumerate() {
        let wide = letters(word);
        if index > 0 && column + 1 + wide > width {
            out.push('\n');
            out.extend(std::iter::repeat_n(' ', indent));
            column = indent;
        } else if index > 0 {
            out.push(' ');
            column += 1;
        }
        out.push_str(word);
        column += wide;
    }
    out
}

/// The column in which the continuation of a line begins: that of its text behind a label; none of the row of a table.
fn hanging(line: &str) -> Option<usize> {
    let letters: Vec<char> = line.chars().collect();
    let indent = letters.iter().take_while(|letter| **letter == ' ').count();
    let gaps = |from: usize| {
        (from..letters.len().saturating_sub(1)).filter(|at| letters[*at] == ' ' && letters[at + 1] == ' ')
    };
    match gaps(indent).next_back() {
        None => Some(indent),
        Some(at) => {
            let words = letters[at + 2..].split(|letter| *letter == ' ').count();
            (words >= SENTENCE).then_some(at + 2)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "No: the camera cannot distinguish skin from aluminium with a probability of 84.1 %\n\n  reading            distance  photons\n  \
                        exposure           longer than a frame allows, and more than the well holds\nWarnings\n  [small-target] the target \
                        is small\n";

    #[test]
    fn a_file_gets_the_text_as_it_is() {
        assert_eq!(dressed(TEXT, None, false) + "\n", TEXT);
    }

    #[test]
    fn lines_are_wrapped_and_rows_of_tables_are_not() {
        let shown = dressed(TEXT, Some(50), false);
        let expected = "No: the camera cannot distinguish skin from\naluminium with a probability of 84.1 %\n\n  reading            distance  photons\n  \
                        exposure           longer than a frame allows,\n                     and more than the well holds\nWarnings\n  \
                        [small-target] the target is small";
        assert_eq!(shown, expected);
        assert!(dressed(TEXT, Some(30), false).contains("  reading            distance  photons\n"));
        let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        for width in 25..100 {
            assert_eq!(words(&dressed(TEXT, Some(width), false)), words(TEXT), "{width}");
        }
    }

    #[test]
    fn the_verdict_and_warnings_are_coloured() {
        let shown = dressed(TEXT, None, true);
        assert!(shown.starts_with("\u{1b}[31m\u{1b}[1mNo\u{1b}[0m: the camera"), "{shown:?}");
        assert!(shown.contains("\n\u{1b}[33m\u{1b}[1mWarnings\u{1b}[0m\n"), "{shown:?}");
        assert!(shown.contains("  \u{1b}[33m\u{1b}[1m[small-target]\u{1b}[0m the target"), "{shown:?}");
        assert_eq!(console::strip_ansi_codes(&shown), TEXT.trim_end());
        assert!(!dressed("Nothing is said.\n", None, true).contains('\u{1b}'));
    }
}
