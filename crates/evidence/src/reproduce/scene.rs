//! The scenes of the paper looked up in the built-in library.

use hadar::error::Result;
use hadar::material::Library;
use hadar_scenario::Scenario;
use hadar_study::Study;

/// A scenario with its materials.
pub(super) fn study(toml: &str) -> Result<Study> {
    Study::new(&Scenario::from_toml(toml, None)?, &Library::embedded()?)
}
