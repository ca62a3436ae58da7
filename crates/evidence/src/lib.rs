//! What holds `hadar` against something else: references in extended precision, and the paper.
//!
//! * [`reference`](mod@reference): the same quantities in 512-bit arithmetic, sharing no code with what they judge.
//! * [`accuracy`]: run time against error, method by method; what the width of bands costs; what skipping is worth; generated
//!   extremes.
//! * [`vectors`]: questions with answers and tolerances, for anyone's own program.
//! * [`report`]: text, tables and plots of the last two.
//! * `reproduce`: the paper's figures and tables made again, and further studies.
//! * `command`: the program `hadar-evidence`, to which `hadar reproduce` and `hadar accuracy` hand over.
//!
//! Nothing in the program depends on this package, and a build of the program does not compile it.

pub mod accuracy;
mod command;
pub mod reference;
pub mod report;
mod reproduce;
pub mod vectors;

pub use command::main;
