//! A scene that is rendered: sky, ground and what stands on it (`[scene]`, `[[object]]`).
//!
//! Without objects it is the renderer's street with a car and a person, of which the keys of `[scene]` change a few figures.

mod read;
mod write;

pub(crate) use read::{scene, scene_of};
pub(crate) use write::{document as scene_document, scene as scene_written};

use super::MaterialRef;
use std::path::PathBuf;

/// A rendered scene (`[scene]`). What is silent is the renderer's.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SceneSpec {
    /// Temperature of the ground, K.
    pub ground_temperature_k: Option<f64>,
    /// Temperature of the sky, a blackbody, K.
    pub sky_temperature_k: Option<f64>,
    /// Temperature of the car, K.
    pub car_temperature_k: Option<f64>,
    /// Temperature of the person, K.
    pub person_temperature_k: Option<f64>,
    /// Emissivity of the ground between which its texture varies, lower one first.
    pub ground_emissivity: Option<[f64; 2]>,
    /// Material of the car.
    pub car: Option<MaterialRef>,
    /// Material of the person.
    pub person: Option<MaterialRef>,
    /// Distance of the car, m.
    pub car_distance_m: Option<f64>,
    /// Distance of the person, m.
    pub person_distance_m: Option<f64>,
    /// What the sky sends.
    pub sky: Option<SkySpec>,
    /// What the ground is made of.
    pub ground: Option<GroundSpec>,
    /// What stands on it, instead of car and person.
    pub objects: Option<Vec<ObjectSpec>>,
    /// Materials besides those of the scene that a decomposition chooses from.
    pub library: Option<Vec<MaterialRef>>,
    /// Height of the cameras above the ground, m.
    pub camera_height_m: Option<f64>,
    /// Angle by which they look down, rad.
    pub camera_pitch_rad: Option<f64>,
    /// Times that light is scattered before it reaches the camera.
    pub bounces: Option<u32>,
    /// Rows and columns of the image.
    pub size: Option<[usize; 2]>,
}

/// What the sky sends.
#[derive(Debug, Clone, PartialEq)]
pub enum SkySpec {
    /// A column of a table of radiances, photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹ where its header has no unit.
    Spectrum {
        /// The table.
        path: PathBuf,
        /// Its column.
        column: String,
    },
    /// A surface at a temperature, a blackbody without a material.
    Surface {
        /// Its material.
        material: Option<MaterialRef>,
        /// Its temperature, K.
        temperature_k: f64,
    },
}

/// A surface of one material.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceSpec {
    /// Its material.
    pub material: MaterialRef,
    /// Its mean temperature, K.
    pub temperature_k: f64,
    /// Root mean square of the temperature over it, K.
    pub variation_k: f64,
    /// Size of what is warmer or cooler, m; the renderer's if silent.
    pub variation_size_m: Option<f64>,
    /// Root mean square slope of its bumps; smooth if 0.
    pub roughness: f64,
    /// Size of its bumps, m; the renderer's if silent.
    pub roughness_size_m: Option<f64>,
}

/// The ground.
#[derive(Debug, Clone, PartialEq)]
pub struct GroundSpec {
    /// Its surface.
    pub surface: SurfaceSpec,
    /// Material of lane marks; none if silent.
    pub marks: Option<MaterialRef>,
}

/// Something that stands in the scene (`[[object]]`).
#[derive(Debug, Clone, PartialEq)]
pub struct ObjectSpec {
    /// Its name; that of its form if silent.
    pub name: Option<String>,
    /// Its form.
    pub form: Form,
    /// Where it stands: to the right of the middle, and ahead, m.
    pub at_m: [f64; 2],
    /// Its surface.
    pub surface: SurfaceSpec,
}

/// The form of an object, lengths in m; a length that is silent is a usual one.
#[derive(Debug, Clone, PartialEq)]
pub enum Form {
    /// A person of a height.
    Person(Option<f64>),
    /// A robot of a height.
    Robot(Option<f64>),
    /// A car: length, width and height, and its tyres, of its own surface if silent.
    Car(Option<[f64; 3]>, Option<SurfaceSpec>),
    /// A block: length along the road, width and height.
    Block([f64; 3]),
    /// A post: height and radius.
    Post([f64; 2]),
    /// A ball: length along the road, width and height, and its height above the ground.
    Ball([f64; 3], f64),
}

impl Form {
    /// Its name in a scenario.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Person(_) => "person",
            Self::Robot(_) => "robot",
            Self::Car(..) => "car",
            Self::Block(_) => "block",
            Self::Post(_) => "post",
            Self::Ball(..) => "ball",
        }
    }
}
