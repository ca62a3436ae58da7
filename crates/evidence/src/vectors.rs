//! Test vectors: questions with answers and tolerances, by which anyone can check a program of their own.
//!
//! Every answer comes from the reference path ([`crate::reference`]), in 512 bits and by the plainest formulas, and none from
//! what it is there to check. Inputs are doubles of which all bits count. A tolerance is what a careful program in doubles
//! reaches: 1e-15·(10 + x), x = hcν/kT the largest of the scene, times what the question itself magnifies (the sum of its
//! terms' magnitudes over their sum), rounded up. It is far below a per cent, so that a wrong formula fails, and below what
//! the known short cuts lose where a vector is there for one of them.
//!
//! Nothing is drawn and nothing depends on threads: the same program makes the same bytes. Library functions of a machine have no
//! part in it but to lead Newton's method in 512 bits to where it starts (spectra are rational functions, rounded to four
//! decimals).
//!
//! * `scene`: what is seen, as numbers; `json`: how it is written; `answer`: digits and tolerances;
//! * one module a topic: `planck`, `signal`, `counts`, `local`, `nearest`, `probability`, `requirement`, `stop`, and `identify`, whole
//!   scenarios as files.

mod answer;
mod counts;
mod identify;
mod json;
mod local;
mod nearest;
mod planck;
mod probability;
mod requirement;
mod scene;
mod signal;
mod solve;
mod stop;
mod topic;

pub use answer::{Answer, Vector};
pub use topic::{SCHEMA, Topic, VERSION};

use hadar::error::Result;

/// All topics, in the order in which one is built on those before it.
///
/// # Errors
/// None, unless a vector is no possible question.
///
/// ```
/// let topics = hadar_evidence::vectors::topics()?;
/// assert_eq!(topics[0].written()[0].0, "planck.json");
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn topics() -> Result<Vec<Topic>> {
    Ok(vec![
        planck::topic(),
        signal::topic()?,
        counts::topic()?,
        local::topic()?,
        nearest::topic()?,
        probability::topic(),
        requirement::topic()?,
        stop::topic(),
        identify::topic()?,
    ])
}
