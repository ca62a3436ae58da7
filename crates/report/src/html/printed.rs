//! An answer as it is printed, read back into headings, sentences and tables.
//!
//! A printed table has columns apart by two spaces or more, aligned at either end. The longest rows show where the columns are; a cell of a
//! shorter row belongs to the columns that it stands under, and to all of them where it stands under several. Where two cells would stand
//! in one column, nothing is guessed: the lines stay as they were printed.

use super::element::{escape, wide};
use std::fmt::Write as _;
use std::ops::Range;

/// A piece of a line between gaps of two spaces or more, with its place in letters.
#[derive(Debug, Clone)]
struct Piece<'a> {
    text: &'a str,
    at: Range<usize>,
}

/// The text of an answer as HTML.
pub(super) fn html(text: &str) -> String {
    text.split("\n\n").filter(|block| !block.trim().is_empty()).map(block).collect()
}

/// Lines without an empty one between them: headings, each with what is indented below it, and sentences.
fn block(text: &str) -> String {
    let lines: Vec<&str> = text.lines().filter(|line| !line.trim().is_empty()).collect();
    let is_below = |line: &str| line.starts_with(' ') || line.starts_with("* ");
    let (mut out, mut rest) = (String::new(), lines.as_slice());
    while let Some((first, after)) = rest.split_first() {
        let below = after.iter().take_while(|line| is_below(line)).count();
        let (mine, others) = after.split_at_checked(below).unwrap_or((after, &[]));
        if is_below(first) {
            let count = rest.iter().take_while(|line| is_below(line)).count();
            let (all, others) = rest.split_at_checked(count).unwrap_or((rest, &[]));
            out += &indented("", all);
            rest = others;
            continue;
        }
        let kind = if mine.is_empty() { "p" } else { "h3" };
        let _ = writeln!(out, "<{kind}>{}</{kind}>", escape(first.trim()));
        out += &indented(first.trim(), mine);
        rest = others;
    }
    out
}

/// Lines below a heading: a table wherever a line has several pieces, else sentences.
fn indented(heading: &str, lines: &[&str]) -> String {
    let base = lines.iter().map(|line| indent(line)).min().unwrap_or(0);
    let (mut out, mut rows, mut said) = (String::new(), Vec::new(), Vec::new());
    for line in lines {
        let pieces = pieces(line);
        let is_sentence = pieces.len() < 2 && (rows.is_empty() || indent(line) <= base);
        if is_sentence {
            out += &table(heading, &std::mem::take(&mut rows));
            said.push(line.trim());
        } else {
            out += &sentences(&std::mem::take(&mut said));
            rows.push((*line, pieces));
        }
    }
    out + &table(heading, &rows) + &sentences(&said)
}

fn indent(line: &str) -> usize {
    line.len() - line.trim_start_matches(' ').len()
}

/// Sentences; one that goes on in the next line is one paragraph with it, those behind a code are a list.
fn sentences(lines: &[&str]) -> String {
    let mut whole: Vec<String> = Vec::new();
    for line in lines {
        match whole.last_mut() {
            Some(before) if line.starts_with(char::is_lowercase) && !before.ends_with(['.', ':']) => {
                *before += " ";
                *before += line;
            }
            _ => whole.push((*line).to_owned()),
        }
    }
    if whole.len() > 1 && whole.iter().all(|line| line.starts_with('[')) {
        let items: String = whole.iter().map(|line| format!("<li>{}</li>\n", escape(line))).collect();
        return format!("<ul>\n{items}</ul>\n");
    }
    whole.iter().map(|line| format!("<p>{}</p>\n", escape(line))).collect()
}

/// The pieces of a line.
fn pieces(line: &str) -> Vec<Piece<'_>> {
    let (mut out, mut at) = (Vec::new(), 0);
    for part in line.split("  ") {
        let (text, width) = (part.trim(), part.chars().count());
        if !text.is_empty() {
            let begin = at + part.chars().take_while(|char| *char == ' ').count();
            out.push(Piece { text, at: begin..begin + text.chars().count() });
        }
        at += width + 2;
    }
    out
}

/// A row: each cell with the columns that it stands under. None where two would stand in one.
fn placed<'a>(pieces: &[Piece<'a>], columns: &[Range<usize>]) -> Option<Vec<(Range<usize>, &'a str)>> {
    let mut out: Vec<(Range<usize>, &str)> = Vec::new();
    for piece in pieces {
        let under = |column: &Range<usize>| column.start < piece.at.end && piece.at.start < column.end;
        let first = columns.iter().position(under)?;
        let last = columns.iter().rposition(under)?;
        if out.last().is_some_and(|(before, _)| before.end > first) {
            return None;
        }
        out.push((first..last + 1, piece.text));
    }
    Some(out)
}

/// Rows as a table; as they were printed where the columns of a row are not certain.
fn table(heading: &str, rows: &[(&str, Vec<Piece<'_>>)]) -> String {
    let Some(most) = rows.iter().map(|(_, pieces)| pieces.len()).max() else { return String::new() };
    let mut columns: Vec<Range<usize>> = Vec::new();
    for (_, full) in rows.iter().filter(|(_, pieces)| pieces.len() == most) {
        if columns.is_empty() {
            columns = full.iter().map(|piece| piece.at.clone()).collect();
        }
        for (column, piece) in columns.iter_mut().zip(full) {
            *column = column.start.min(piece.at.start)..column.end.max(piece.at.end);
        }
    }
    // The names of rows are a column too where the longest row is one of heads alone.
    let left = rows.iter().map(|(_, pieces)| pieces.first().map_or(0, |piece| piece.at.start)).min();
    if let (Some(left), Some(first)) = (left, columns.first().map(|column| column.start))
        && left + 1 < first
    {
        columns.insert(0, left..first - 1);
    }
    let apart = columns.windows(2).all(|two| matches!(two, [left, right] if left.end <= right.start));
    let cells: Option<Vec<_>> = rows.iter().map(|(_, pieces)| placed(pieces, &columns)).collect();
    let Some(cells) = cells.filter(|_| apart) else {
        let lines: String =
            rows.iter().map(|(line, _)| format!("<span class=\"line\">{}</span>", escape(line))).collect();
        return wide(&escape(heading), &format!("<pre>{lines}</pre>\n"));
    };
    let headed = is_headed(&cells, columns.len());
    let mut body = String::new();
    for (index, cells) in cells.iter().enumerate() {
        body += &row(cells, columns.len(), headed && index == 0);
    }
    let body = match body.split_once("</tr>\n").filter(|_| headed) {
        Some((head, rest)) => format!("<thead>{head}</tr></thead>\n<tbody>\n{rest}</tbody>\n"),
        None => format!("<tbody>\n{body}</tbody>\n"),
    };
    // The heading above says it; the caption is for those who go from table to table.
    let caption = format!("<caption class=\"unseen\">{}</caption>\n", escape(heading));
    wide(&escape(heading), &format!("<table class=\"printed\">\n{caption}{body}</table>\n"))
}

type Cells<'a> = [(Range<usize>, &'a str)];

fn begins_as_number(text: &str) -> bool {
    text.trim_start_matches(['+', '-', '<', '>', ' ']).starts_with(|char: char| char.is_ascii_digit())
}

/// Whether the first row has the heads of columns: no number in it, and some below.
fn is_headed(rows: &[Vec<(Range<usize>, &str)>], columns: usize) -> bool {
    let numbers = |cells: &Cells<'_>| cells.iter().any(|(at, text)| at.start > 0 && begins_as_number(text));
    let Some((first, rest)) = rows.split_first() else { return false };
    let is_full = first.len() + usize::from(first.first().is_none_or(|(at, _)| at.start > 0)) == columns;
    let is_corner_empty = first.first().is_some_and(|(at, _)| at.start > 0);
    columns > 1
        && is_full
        && (columns > 2 || is_corner_empty)
        && !numbers(first)
        && rest.iter().any(|row| numbers(row))
}

fn row(cells: &Cells<'_>, columns: usize, is_head: bool) -> String {
    let mut out = String::from("<tr>");
    let mut next = 0;
    for (at, text) in cells {
        for _ in next..at.start {
            out += "<td></td>";
        }
        // A line that goes on has the rest of the row.
        let end = if cells.len() == 1 { columns } else { at.end };
        let span = end - at.start;
        let span = if span > 1 { format!(" colspan=\"{span}\"") } else { String::new() };
        let text = escape(text);
        let _ = match (is_head, at.start) {
            (true, _) => write!(out, "<th scope=\"col\"{span}>{text}</th>"),
            (_, 0) if cells.len() > 1 => write!(out, "<th scope=\"row\"{span}>{text}</th>"),
            _ => write!(out, "<td{span}>{text}</td>"),
        };
        next = end;
    }
    for _ in next..columns {
        out += "<td></td>";
    }
    out + "</tr>\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_those_that_a_cell_stands_under() {
        let text = "Margins\n              windows      error\n  all, 4 m         12    3.1 mm\n  car               7      none\n\
                    \x20                  no more than that\nIn all.\n";
        let found = html(text);
        assert!(found.starts_with("<h3>Margins</h3>\n"), "{found}");
        let head =
            "<thead><tr><td></td><th scope=\"col\">windows</th><th scope=\"col\">error</th></tr></thead>";
        assert!(found.contains(head), "{found}");
        assert!(found.contains("<tr><th scope=\"row\">car</th><td>7</td><td>none</td></tr>"), "{found}");
        assert!(found.contains("<tr><td></td><td colspan=\"2\">no more than that</td></tr>"), "{found}");
        assert!(found.ends_with("<p>In all.</p>\n"), "{found}");
    }

    #[test]
    fn a_long_cell_has_all_columns_it_stands_under_and_none_is_guessed() {
        let found = html(
            "Solve\n  pixel     13 um       (now 12 um)\n  exposure  none at all, of which\n  frames    7           (now 4)",
        );
        assert!(
            found.contains("<th scope=\"row\">exposure</th><td colspan=\"2\">none at all, of which</td>"),
            "{found}"
        );
        assert!(!found.contains("thead"), "{found}");
        // Two cells under one column: as it was printed.
        let odd = "Odd\n  a  a long cell of words  9\n  b  short  words  x  y\n";
        assert!(html(odd).contains("<pre>"), "{}", html(odd));
    }

    #[test]
    fn sentences_that_go_on_are_one_and_codes_are_a_list() {
        let found =
            html("A yes holds only if\n  [one] it is\n  [two] it was\n\nNote\n  A sentence that\n  goes on.");
        assert_eq!(
            found,
            "<h3>A yes holds only if</h3>\n<ul>\n<li>[one] it is</li>\n<li>[two] it was</li>\n</ul>\n\
             <h3>Note</h3>\n<p>A sentence that goes on.</p>\n"
        );
    }
}
