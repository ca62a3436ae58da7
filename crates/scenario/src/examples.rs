//! The scenarios of the repository's `examples/` that figures and measurements rest on.
//!
//! The files stand there; `examples/` of this package leads to them, so that they are part of it wherever it is built.

/// A person, and the robot it could be taken for; the camera of the paper.
pub const HUMAN_VS_ROBOT: &str = include_str!("../examples/human_vs_robot.toml");
/// The person and the robot in three bands.
pub const HUMAN_VS_ROBOT_3_BANDS: &str = include_str!("../examples/human_vs_robot_3_bands.toml");
/// Five materials at 60 °C.
pub const FIVE_MATERIALS: &str = include_str!("../examples/five_materials.toml");
/// Silicon carbide on a heating plate before the spectrometer.
pub const THERMOMETRY_SIC: &str = include_str!("../examples/thermometry_sic.toml");
/// Skin before the camera.
pub const THERMOMETRY_SKIN: &str = include_str!("../examples/thermometry_skin.toml");
/// A street at night, in many bands.
pub const STREET: &str = include_str!("../examples/street.toml");
/// The same street with all of it at one temperature, as in the paper.
pub const STREET_AT_ONE_TEMPERATURE: &str = include_str!("../examples/street_at_one_temperature.toml");
