//! One question about many scenes or cameras: a scenario whose keys take many values, a row of the table for each.
//!
//! [`Plan`] says which values: axes of which all combinations are rows ([`Axis`]), and cases whose keys change together
//! ([`Cases`]). [`Question`] answers a row as the command of its name does, and [`Record`] is what a row says: the numbers, texts
//! and yeses of the answer, by the names they have in its JSON. Nothing here reads or writes but the scenario's own files.

mod axis;
mod cases;
mod cell;
mod part;
mod plan;
mod question;
mod record;

pub use axis::Axis;
pub use cases::Cases;
pub use cell::Cell;
pub use plan::{Input, Plan};
pub use question::{Answer, Asking, Question, SPECTRA};
pub use record::{Record, asked_of, is_within};
