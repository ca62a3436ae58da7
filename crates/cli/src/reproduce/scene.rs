//! The scenes of the paper as scenarios.

use hadar::error::Result;
use hadar::material::Library;
use hadar_study::scenario::Scenario;
use hadar_study::study::Study;

/// A person, and the robot it could be taken for; the camera of the paper.
pub(super) const HUMAN_VS_ROBOT: &str = include_str!("../../../../examples/human_vs_robot.toml");
/// Five materials at 60 °C.
pub(super) const FIVE_MATERIALS: &str = include_str!("../../../../examples/five_materials.toml");
/// Silicon carbide on a heating plate before the spectrometer.
pub(super) const THERMOMETRY_SIC: &str = include_str!("../../../../examples/thermometry_sic.toml");
/// Skin before the camera.
pub(super) const THERMOMETRY_SKIN: &str = include_str!("../../../../examples/thermometry_skin.toml");
/// The person and the robot in three bands.
pub(super) const THREE_BANDS: &str = include_str!("../../../../examples/human_vs_robot_3_bands.toml");

/// A scenario looked up in the built-in library.
pub(super) fn study(toml: &str) -> Result<Study> {
    Study::new(&Scenario::from_toml(toml, None)?, &Library::embedded()?)
}
