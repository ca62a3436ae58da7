//! Files about what hangs on the figures of a rule.

use crate::bundle::Bundle;
use crate::table::{Table, optional, yes_no};
use crate::words::rule::title_of_figures;
use hadar::error::Result;
use hadar_study::FiguresMoved;

/// All files.
///
/// # Errors
/// A table that cannot be written.
pub fn moved_bundle(found: &FiguresMoved, title: Option<&str>) -> Result<Bundle> {
    let title = title_of_figures(title);
    let mut bundle = Bundle::about(Some(&title));
    let mut table =
        Table::new(["figure", "value", "moved_to", "largest_change", "verdicts", "breaks_a_test", "refused"]);
    for one in &found.figures {
        table.push(vec![
            one.key.clone(),
            one.value.clone(),
            one.moved_to.clone(),
            optional(one.largest_change),
            one.verdicts.join("; "),
            one.breaks_a_test.map(yes_no).unwrap_or_default(),
            one.refused.clone().unwrap_or_default(),
        ]);
    }
    bundle.add_table("figures.csv", table)?;
    Ok(bundle)
}
