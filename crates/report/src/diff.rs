//! Two reports, or two answers as JSON, held against each other: what was asked, the verdict, the figures that moved, the warnings.

mod difference;
mod side;

pub use crate::words::diff::text;
pub use difference::{Changed, Curve, Difference, Moved, Warned};
pub use side::Side;
pub(crate) use side::plain;
