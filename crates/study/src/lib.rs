//! Questions about thermal cameras answered: scenarios from files, results as data.
//!
//! * [`scenario`]: what a file says, checked, in one unit per dimension; errors name file, line and key.
//! * [`study`]: a scenario with its materials, bands, surroundings and camera looked up, and what follows: a folder a command.
//! * [`explain`]: what a key, a warning and a part of an answer mean.
//! * [`sweep`]: one question about many scenes or cameras, a row of a table for each.
//!
//! ```
//! use hadar::material::Library;
//! use hadar_study::{scenario::Scenario, study::Study};
//!
//! let text = "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\n[alternatives]\nmaterials = [\"aluminium\"]";
//! let study = Study::new(&Scenario::from_toml(text, None)?, &Library::embedded()?)?;
//! assert_eq!(study.identify()?.pairs[0].alternative, "aluminium");
//! # Ok::<(), hadar::Error>(())
//! ```

pub mod explain;
mod proviso;
pub mod scenario;
pub mod study;
pub mod sweep;
pub mod warning;
pub mod words;

#[cfg(doctest)]
#[doc = include_str!("../../../docs/src/reference/programs.md")]
struct Guide;
