//! What skipping is worth: text and table.

use crate::accuracy::skipping::Skipped;
use hadar::words::{quantity, significant};
use hadar_report::table::{Table, markdown, number};

/// A line for every question.
#[must_use]
pub fn skipping_text(found: &[Skipped]) -> String {
    let same = found.iter().filter(|one| one.answers_equal).count();
    let text = format!(
        "Questions answered with everything needless left out, and with all of it computed: {same} of {} answers are the same\n\n",
        found.len()
    );
    let row = |one: &Skipped| {
        let [on, off] = [one.seconds_on, one.seconds_off].map(|seconds| quantity(seconds, "s"));
        let same = if one.answers_equal { "yes" } else { "no" };
        [one.scenario.into(), one.question.into(), on, off, significant(one.gain(), 2), same.into()]
    };
    let head = ["scenario", "question", "left out", "all computed", "gain", "same answer"];
    text + &markdown::<[String; 6]>(&head, found.iter().map(row))
}

/// The same as numbers.
#[must_use]
pub fn skipping_table(found: &[Skipped]) -> Table {
    let mut table = Table::new(["scenario", "question", "skipping_s", "in_full_s", "gain", "same_answer"]);
    for one in found {
        let [on, off, gain] = [one.seconds_on, one.seconds_off, one.gain()].map(number);
        let same = if one.answers_equal { "yes" } else { "no" };
        table.push(vec![one.scenario.into(), one.question.into(), on, off, gain, same.into()]);
    }
    table
}
