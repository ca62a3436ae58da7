//! A rule that does not hold yet, or no more.

use toml::value::Date;

/// A rule on a day on which it does not hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NotInForce {
    /// The day.
    pub day: Date,
    /// The day from which the rule holds, if it begins.
    pub from: Option<Date>,
    /// The last day on which it does, if it ends.
    pub until: Option<Date>,
}
