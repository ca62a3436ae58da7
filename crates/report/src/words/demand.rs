//! What somebody demands, in words.

use hadar::ranging::depth::Demand;
use hadar::words::{length, significant};

/// The error of a depth that somebody demands.
pub(super) fn error_of(demand: Demand) -> String {
    match demand {
        Demand::Absolute(error_m) => length(error_m),
        Demand::Relative(share) => format!("{} % of it", significant(100.0 * share, 3)),
    }
}
