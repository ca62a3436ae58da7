//! The command `hadar`: parse, run, print.
//!
//! A library for two programs. `hadar` is [`main`]. `hadar-evidence` answers `hadar reproduce` and `hadar accuracy`; it takes
//! their arguments from [`evidence`], and prints, writes and shows progress through [`Global`], so that each flag and message is
//! defined once.

// Linked for what it replaces: its own documentation.
use hadar_elementary as _;

mod command;
mod evidence_program;

pub use command::evidence;
pub use command::global::Global;
pub use command::main;
pub use command::progress::Bar;
pub use evidence_program::evidence_main;
