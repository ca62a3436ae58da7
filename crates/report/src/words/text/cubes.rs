//! What decompositions and libraries of a cube say alike.

use hadar_scenario::decompose::CubeUnit;

/// The heading of what a comparison with the truth gives.
pub(crate) const AGAINST: &str = "Against what is there";

/// What is taken for the noise of a cube.
pub(crate) const fn noise(unit: &CubeUnit) -> &'static str {
    match unit {
        CubeUnit::Radiance { .. } => "the stated noise, the same for all samples",
        CubeUnit::BrightnessTemperature { .. } => {
            "the stated noise, that of a blackbody at 300 K, the same in radiance for all samples"
        }
        CubeUnit::CountsPerPhotonRadiance(_) | CubeUnit::Camera => {
            "Poisson counts with the stated electronic noise"
        }
    }
}

/// What the lighting factors of a pixel add up to.
pub(crate) fn lighting_total(total: Option<f64>) -> String {
    total.map_or_else(|| "at most 1".to_owned(), |total| format!("{total} in all"))
}
