//! Every key of every file, once: what it means, what may be written, what silence means, an example, where it enters.
//!
//! The readers open a table of a file with its [`Table`] here and take from it which keys may stand there, in which unit and in
//! which range (`section`); `hadar explain`, `hadar schema` and `hadar init` say what it says. So a key that has no row
//! here cannot be written, and one that has a row cannot mean another range than the row says.
//!
//! | file | what is there |
//! |---|---|
//! | `key` | a key, a table, a kind of value |
//! | `task`, `find`, `scene`, `cube`, `rule`, `calibrate` | the tables |
//! | `files` | which tables a file has, and which commands read it |
//! | `found` | all of them by their paths |
//! | `schema` | all of them as a JSON schema |

mod air;
pub(super) mod calibrate;
pub(super) mod clause;
mod commented;
pub(super) mod cube;
pub(super) mod files;
mod find;
mod found;
mod key;
pub(super) mod rule;
pub(super) mod scene;
mod schema;
mod stop;
pub(super) mod task;
mod views;

pub use commented::commented;
pub use files::{FILES, FileKind};
pub use found::{Place, all, find};
pub use key::{Key, More, Silent, Table, Value};
pub use schema::{kinds_of, schema};
