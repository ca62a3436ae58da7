//! A textured wall across the optical axis: everything about its image has a closed form.
//!
//! A wave of τ with a cycles per pixel in x and b in y, drawn with s × s rays per pixel, is the same wave of pixel
//! values with its amplitude times D(a) D(b), D(a) = sin(πa)/(s sin(πa/s)), whatever its phase: a shift by any part
//! of a pixel is exact.

use super::scene::Scene;
use super::surface::{Emissivity, Surface, Texture, Wave};
use hadar::error::{Result, check};

/// An endless upright wall at one distance, half lit by the sky and half by the ground.
///
/// Seen by a rig without pitch, its depth and disparity are the same everywhere.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct WallSpec {
    /// Distance of the wall, m.
    pub distance_m: f64,
    /// Temperature of the sky, taken as a blackbody, K.
    pub sky_k: f64,
    /// Temperature of the ground below the sky, K.
    pub ground_k: f64,
    /// Emissivity of the ground, 0 to 1.
    pub ground_emissivity: Emissivity,
    /// Temperature of the wall in front of the cameras, K.
    pub wall_k: f64,
    /// Emissivities of the wall where its texture is 0 and where it is 1.
    pub wall_emissivity: [Emissivity; 2],
    /// Mean of the texture of the wall, 0 to 1.
    pub mean: f64,
    /// Sinusoids of the texture; see [`Rig::cycles_per_m`](super::Rig::cycles_per_m).
    pub waves: Vec<Wave>,
}

impl Default for WallSpec {
    /// Everything at 20 °C, emissivity 0.8 to 1, no waves, 10 m away.
    fn default() -> Self {
        let constant = Emissivity::Constant;
        Self {
            distance_m: 10.0,
            sky_k: 293.15,
            ground_k: 293.15,
            ground_emissivity: constant(0.95),
            wall_k: 293.15,
            wall_emissivity: [constant(0.8), constant(1.0)],
            mean: 0.5,
            waves: Vec::new(),
        }
    }
}

impl Scene {
    /// The wall.
    ///
    /// # Errors
    /// A distance or temperature that is not positive, an emissivity outside [0, 1], waves that leave [0, 1].
    pub fn wall(spec: &WallSpec) -> Result<Self> {
        check::positive("distance of the wall", spec.distance_m, "m")?;
        let sky = Surface::plain("sky", spec.sky_k, &Emissivity::Constant(1.0));
        let ground = Surface::plain("ground", spec.ground_k, &spec.ground_emissivity);
        let mut wall = Surface::plain("wall", spec.wall_k, &spec.wall_emissivity[0]);
        wall.emissivity = spec.wall_emissivity.clone();
        wall.texture = Texture::Waves { mean: spec.mean, waves: spec.waves.clone() };
        let surfaces = vec![sky, ground, wall];
        surfaces.iter().try_for_each(Surface::check)?;
        Ok(Self { surfaces, solids: Vec::new(), wall: Some((spec.distance_m, 2)) })
    }
}
