//! The scenes of the paper looked up in the built-in library.

use hadar::error::Result;
use hadar::material::Library;
use hadar_scenario::Scenario;
use hadar_study::Study;

/// A scenario with its materials; grids are sampled at the centres of their bands, as in the paper.
pub(super) fn study(toml: &str) -> Result<Study> {
    let mut scenario = Scenario::from_toml(toml, None)?;
    scenario.bands.integrate = Some(false);
    Study::new(&scenario, &Library::embedded()?)
}
