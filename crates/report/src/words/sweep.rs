//! What is printed of a sweep.

use super::Say;
use crate::sweep::{Swept, Undrawn, none};
use crate::text::significant;
use hadar_study::sweep::Cell;
use std::fmt::Write as _;

/// Columns of which the text tells what they are like.
const TOLD: usize = 12;
/// Rows that failed of which the text tells why.
const FAILED: usize = 5;

/// How many rows were answered, what the chosen columns are like, which rows failed.
#[must_use]
pub fn text(swept: &Swept) -> String {
    let gathered = &swept.gathered;
    let (rows, answered, failed) = (gathered.rows(), gathered.answered(), gathered.failed().count());
    let mut text = format!("{answered} of {rows} rows are answered as by hadar {}", swept.question.name());
    if failed > 0 {
        let _ = write!(text, ", {failed} failed");
    }
    let missing = rows - answered - failed;
    if missing > 0 {
        let _ = write!(text, ", {missing} are not there");
    }
    text.push_str(".\n");
    let mut lines: Vec<(&str, String)> = Vec::new();
    for name in swept.drawn().into_iter().take(TOLD) {
        if let Some(said) = gathered.values(name).and_then(told) {
            lines.push((name, said));
        }
    }
    let width = lines.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    if !lines.is_empty() {
        text.push('\n');
    }
    for (name, said) in lines {
        let _ = writeln!(text, "{name:width$}  {said}");
    }
    if let Some(reason) = none(swept) {
        let _ = writeln!(text, "\nNo picture is drawn: {}.", reason.say());
    }
    if failed > 0 {
        text.push_str("\nRows that failed\n");
        for (row, message) in gathered.failed().take(FAILED) {
            let _ = writeln!(text, "  {row}: {message}");
        }
        if failed > FAILED {
            let _ = writeln!(text, "  and {} more, in the column `message`", failed - FAILED);
        }
    }
    text
}

/// Which rows this run has taken over; nothing where it took none.
#[must_use]
pub fn kept(swept: &Swept) -> String {
    let again = match (swept.recomputed, swept.kept) {
        (_, 0) => return String::new(),
        (0, _) => "none of them was computed again".to_owned(),
        (again, all) if again == all => "all of them were computed again, and are the same".to_owned(),
        (again, _) => format!("{again} of them were computed again, and are the same"),
    };
    format!("\n{} rows are of earlier runs or other shards; {again}.\n", swept.kept)
}

/// The extremes of numbers, the counts of yes and no.
fn told(cells: &[Cell]) -> Option<String> {
    let yes = cells.iter().filter(|cell| **cell == Cell::Boolean(true)).count();
    let no = cells.iter().filter(|cell| **cell == Cell::Boolean(false)).count();
    if yes + no > 0 {
        return Some(format!("{yes} yes, {no} no"));
    }
    let numbers = || cells.iter().filter_map(Cell::number).filter(|number| number.is_finite());
    let (low, high) = (numbers().reduce(f64::min)?, numbers().reduce(f64::max)?);
    let none = cells.len() - numbers().count();
    let range = match low == high {
        true => significant(low, 4),
        false => format!("{} to {}", significant(low, 4), significant(high, 4)),
    };
    Some(if none > 0 { format!("{range}; none in {none} rows") } else { range })
}

impl Say for Undrawn {
    fn say(&self) -> String {
        match self {
            Self::Keys(keys) => format!("{keys} keys vary, and pictures are over one or two"),
            Self::NoGrid => {
                "the cases are no grid, which has every value of one key with every value of the other once"
                    .into()
            }
            Self::Curves { key, values, most } => {
                format!("`{key}` has {values} values, and a picture {most} curves at most")
            }
            Self::NoNumbers { keys: 2 } => "the values of neither key are numbers in one unit".into(),
            Self::NoNumbers { .. } => "the values of the key are no numbers in one unit".into(),
        }
    }
}

/// Below a map.
pub(crate) fn interpolated(columns: usize, rows: usize) -> String {
    format!("{columns} x {rows} values; colours between them are interpolated")
}
