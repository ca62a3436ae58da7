//! The scene and its variants, as scenarios.

use hadar::error::Result;
use hadar::material::Library;
use hadar_scenario::AirRangingScenario;
use hadar_study::air_ranging::AirRangingStudy;
use std::fmt::Write as _;

/// A wall under a clear sky, seen in 256 bands from 8 to 13 µm.
const SCENE: &str = r#"title = "A wall under a clear sky in 256 bands"
signal = "air"

[target]
material = "concrete"
temperature = "TEMPERATURE K"
distance = "100 m"

[[environment]]                      # above it
material = "sky-midlatitude-summer"
temperature = "294.2 K"
lighting = 0.5

[[environment]]                      # below it
temperature = "24 degC"
lighting = 0.5

[atmosphere]
model = "midlatitude-summer"

[bands]
start = "8 um"
stop = "13 um"
step = "0.0196 um"

[unknown]
nuisances = ["temperature", "lighting", "emissivity"]
emissivity_error = ERROR
emissivity_correlation = "100 cm^-1"

[camera]
exposure = "10 ms"
pixel = "30 um"
f_number = 2.0
focal_length = "50 mm"
nesr = "NOISE uflick"

[distances]
DISTANCES

[stereo]
baseline = "0.2 m"
window = [5, 5]
texture = TEXTURE
"#;

/// Temperature of the air of the model, K.
const AIR_K: f64 = 294.2;

/// What of the scene is varied.
#[derive(Debug, Clone)]
pub(super) struct Scene {
    /// Temperature of the target less that of the air, K.
    pub(super) contrast_k: f64,
    /// Deviation of the emissivity.
    pub(super) emissivity_error: f64,
    /// Change of the wall's light from pixel to pixel, as a share of it.
    pub(super) texture: f64,
    /// Noise of a band, µflick.
    pub(super) noise_microflick: f64,
    /// The lines of `[distances]`.
    pub(super) distances: String,
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            contrast_k: 10.0,
            emissivity_error: 0.01,
            texture: 0.01,
            noise_microflick: 1.0,
            distances: String::new(),
        }
    }
}

impl Scene {
    /// At these distances, m.
    pub(super) fn over(self, distances_m: &[f64]) -> Self {
        let lengths: Vec<String> = distances_m.iter().map(|m| format!("\"{m} m\"")).collect();
        Self { distances: format!("list = [{}]", lengths.join(", ")), ..self }
    }

    /// At distances from one to the other, m.
    pub(super) fn between(self, [from, to]: [f64; 2]) -> Self {
        Self { distances: format!("from = \"{from} m\"\nto = \"{to} m\"\npoints = 25"), ..self }
    }

    /// The scenario.
    pub(super) fn text(&self) -> String {
        let mut temperature = String::new();
        let _ = write!(temperature, "{:.1}", AIR_K + self.contrast_k);
        SCENE
            .replace("TEMPERATURE", &temperature)
            .replace("ERROR", &self.emissivity_error.to_string())
            .replace("NOISE", &self.noise_microflick.to_string())
            .replace("DISTANCES", &self.distances)
            .replace("TEXTURE", &self.texture.to_string())
    }

    /// The scenario looked up.
    pub(super) fn study(&self, library: &Library) -> Result<AirRangingStudy> {
        AirRangingStudy::new(&AirRangingScenario::from_toml(&self.text(), None)?, library)
    }
}
