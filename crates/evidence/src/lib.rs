//! `hadar` held against itself in extended precision: what is fast, how wrong it is, and whether it says so.
//!
//! * [`reference`](mod@reference): the same quantities in 512-bit arithmetic, sharing no code with what they judge.
//! * [`accuracy`]: run time against error, method by method; what the width of bands costs; what skipping is worth; generated
//!   extremes.
//! * [`vectors`]: questions with answers and tolerances, for anyone's own program.

pub mod accuracy;
pub mod reference;
pub mod vectors;
