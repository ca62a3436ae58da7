//! The street of the paper's Fig. 4: ground, sky, a car and a person.

use super::body::{Body, Object};
use super::scene::Scene;
use super::surface::{Bump, Emissivity, Road, Surface, Texture};
use hadar::error::Result;

/// A car and a person on a road.
///
/// From the paper: ground and sky at 20 °C, ground emissivity between 0.8 and 1 (Fig. 4), paint at 37 °C
/// (Extended Data Fig. 7), a person at 37 °C of emissivity 0.95 (Fig. 3). The rest is chosen.
///
/// ```
/// use hadar_simulate::render::{Scene, StreetSpec};
/// let warm_sky = StreetSpec { sky_k: 300.0, ..StreetSpec::default() };
/// assert_eq!(Scene::street(&warm_sky)?.surfaces()[0].temperature_k, 300.0);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct StreetSpec {
    /// Temperature of the sky, taken as a blackbody, K.
    pub sky_k: f64,
    /// Sky emissivity; what is missing to 1 is deep space without radiation.
    pub sky_emissivity: Emissivity,
    /// Mean temperature of the ground, K.
    pub ground_k: f64,
    /// Emissivities of the ground where its texture is 0 and where it is 1.
    pub ground_emissivity: [Emissivity; 2],
    /// The texture of the ground.
    pub road: Road,
    /// Roughness of the ground's normals.
    pub ground_bump: Option<Bump>,
    /// Whether the car is there.
    pub car: bool,
    /// Middle of the car's rear bumper: x and z on the ground, m. The car is parallel to z.
    pub car_at_m: [f64; 2],
    /// Length, width and height of the car, m.
    pub car_size_m: [f64; 3],
    /// Temperature of its paint, K.
    pub car_k: f64,
    /// Emissivity of the paint of the car, 0 to 1.
    pub car_emissivity: Emissivity,
    /// Roughness of the panels of the car, as slopes.
    pub car_bump: Option<Bump>,
    /// Temperature of its tyres, K.
    pub tyre_k: f64,
    /// Emissivity of the tyres of the car, 0 to 1.
    pub tyre_emissivity: Emissivity,
    /// Whether the person is there.
    pub person: bool,
    /// Place of the person on the ground, x and z, m.
    pub person_at_m: [f64; 2],
    /// Height of the person, m.
    pub person_height_m: f64,
    /// Temperature of the person, K.
    pub person_k: f64,
    /// Emissivity of the surface of the person, 0 to 1.
    pub person_emissivity: Emissivity,
    /// Roughness of the clothing of the person, as slopes.
    pub person_bump: Option<Bump>,
}

impl Default for StreetSpec {
    fn default() -> Self {
        let constant = Emissivity::Constant;
        Self {
            sky_k: 293.15,
            sky_emissivity: constant(1.0),
            ground_k: 293.15,
            ground_emissivity: [constant(0.8), constant(1.0)],
            road: Road::default(),
            ground_bump: None,
            car: true,
            car_at_m: [1.0, 12.0],
            car_size_m: [4.2, 1.8, 1.45],
            car_k: 310.15,
            car_emissivity: constant(0.9),
            car_bump: Some(Bump { size_m: 0.12, slope: 0.05, seed: 11 }),
            tyre_k: 298.15,
            tyre_emissivity: constant(0.95),
            person: true,
            person_at_m: [-0.9, 8.0],
            person_height_m: 1.75,
            person_k: 310.15,
            person_emissivity: constant(0.95),
            person_bump: Some(Bump { size_m: 0.06, slope: 0.2, seed: 12 }),
        }
    }
}

impl Scene {
    /// The street.
    ///
    /// # Errors
    /// A temperature that is not positive, an emissivity outside [0, 1], a size or distance that is not positive.
    pub fn street(spec: &StreetSpec) -> Result<Self> {
        let mut scene = Self::new(spec.sky(), spec.ground())?;
        spec.objects().into_iter().try_for_each(|object| scene.add(object))?;
        Ok(scene)
    }
}

impl StreetSpec {
    /// Its sky.
    #[must_use]
    pub fn sky(&self) -> Surface {
        Surface::plain("sky", self.sky_k, &self.sky_emissivity)
    }

    /// Its road.
    #[must_use]
    pub fn ground(&self) -> Surface {
        let mut ground = Surface::plain("ground", self.ground_k, &self.ground_emissivity[0]);
        ground.emissivity = self.ground_emissivity.clone();
        ground.texture = Texture::Road(self.road.clone());
        ground.bump = self.ground_bump;
        ground
    }

    /// Car and person.
    #[must_use]
    pub fn objects(&self) -> Vec<Object> {
        let mut objects = Vec::new();
        if self.car {
            let mut surface = Surface::plain("car", self.car_k, &self.car_emissivity);
            surface.bump = self.car_bump;
            let tyres = Box::new(Surface::plain("tyres", self.tyre_k, &self.tyre_emissivity));
            let body = Body::Car { size_m: self.car_size_m, tyres };
            objects.push(Object { surface, at_m: self.car_at_m, body });
        }
        if self.person {
            let mut surface = Surface::plain("person", self.person_k, &self.person_emissivity);
            surface.bump = self.person_bump;
            let body = Body::Person { height_m: self.person_height_m };
            objects.push(Object { surface, at_m: self.person_at_m, body });
        }
        objects
    }
}
