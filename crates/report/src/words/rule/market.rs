//! Which part of a market meets a rule, in words.

use hadar::words::share;
use hadar_study::Market;

/// Which part of a market meets a rule.
pub(crate) fn of_market(market: &Market) -> String {
    let parts = [
        (market.meets, "meets it"),
        (market.meets_if, "meets it under conditions"),
        (market.undecided, "is undecided"),
        (market.fails, "does not meet it"),
        (market.not_stated, "is of cameras that are not named"),
    ];
    let said = parts
        .into_iter()
        .filter(|(part, _)| *part > 1e-9)
        .map(|(part, what)| format!("{} {what}", share(part)));
    format!("of the market {}", said.collect::<Vec<_>>().join(", "))
}
