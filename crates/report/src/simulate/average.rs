//! Simulated decisions between materials whose states are drawn from priors: text and table.

pub use crate::words::simulate::average::text;

use crate::bundle::Bundle;
use crate::table::{Table, number, optional, yes_no};
use hadar::error::Result;
use hadar_study::{AverageSimulation, Study};

/// All files; paths in the scenario are written relative to `out` where they lie below it.
///
/// # Errors
/// A table that cannot be written.
pub fn bundle(study: &Study, result: &AverageSimulation) -> Result<Bundle> {
    let mut bundle = Bundle::about(study.scenario().title.as_deref());
    bundle.add_asked("scenario.toml", study.scenario().to_toml());
    bundle.add_table("average.csv", table(result))?;
    bundle.add_warnings(&result.warnings)?;
    Ok(bundle)
}

fn table(result: &AverageSimulation) -> Table {
    let mut table = Table::new([
        "photons",
        "probability",
        "probability_low",
        "probability_high",
        "probability_lower_bound",
        "probability_upper_bound",
        "bracket_holds",
    ]);
    for point in &result.averages {
        let decisions = &point.decisions;
        table.push(vec![
            number(point.photons),
            number(decisions.probability),
            number(decisions.interval.low),
            number(decisions.interval.high),
            optional(point.probability_lower),
            number(point.probability_upper),
            yes_no(point.bracket_holds),
        ]);
    }
    table
}
