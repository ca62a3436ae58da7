//! The street of the paper's Fig. 4: ground, sky, a car and a person.

use super::scene::{Form, Light, Scene, Solid};
use super::shape::Shape;
use super::surface::{Bump, Emissivity, Road, Surface, Texture};
use super::vector::{Vector, along};
use crate::error::{Result, check};
use std::f64::consts::PI;

const CAR: usize = 2;
const TYRES: usize = 3;
const PERSON: usize = 4;

/// A car and a person on a road.
///
/// From the paper: ground and sky at 20 °C, ground emissivity between 0.8 and 1 (Fig. 4), paint at 37 °C
/// (Extended Data Fig. 7), a person at 37 °C of emissivity 0.95 (Fig. 3). The rest is chosen.
///
/// ```
/// use hadar::render::{Scene, StreetSpec};
/// let warm_sky = StreetSpec { sky_k: 300.0, ..StreetSpec::default() };
/// assert_eq!(Scene::street(&warm_sky)?.surfaces()[0].temperature_k, 300.0);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct StreetSpec {
    /// Sky temperature, K.
    pub sky_k: f64,
    /// Sky emissivity; what is missing to 1 is deep space without radiation.
    pub sky_emissivity: Emissivity,
    /// Ground temperature, K.
    pub ground_k: f64,
    /// Emissivities of the ground where its texture is 0 and where it is 1.
    pub ground_emissivity: [Emissivity; 2],
    /// The texture of the ground.
    pub road: Road,
    /// Roughness of the ground's normals.
    pub ground_bump: Option<Bump>,
    /// Whether the car is there.
    pub car: bool,
    /// Middle of the car's rear bumper: x and z on the ground, m. The car stands along z.
    pub car_at_m: [f64; 2],
    /// Length, width and height of the car, m.
    pub car_size_m: [f64; 3],
    /// Temperature of its paint, K.
    pub car_k: f64,
    /// Emissivity of its paint.
    pub car_emissivity: Emissivity,
    /// Roughness of its panels.
    pub car_bump: Option<Bump>,
    /// Temperature of its tyres, K.
    pub tyre_k: f64,
    /// Emissivity of its tyres.
    pub tyre_emissivity: Emissivity,
    /// Whether the person is there.
    pub person: bool,
    /// Where the person stands: x and z on the ground, m.
    pub person_at_m: [f64; 2],
    /// Height of the person, m.
    pub person_height_m: f64,
    /// Temperature of the person, K.
    pub person_k: f64,
    /// Emissivity of the person.
    pub person_emissivity: Emissivity,
    /// Folds of the clothing.
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
        let mut ground = Surface::plain("ground", spec.ground_k, &spec.ground_emissivity[0]);
        ground.emissivity = spec.ground_emissivity.clone();
        ground.texture = Texture::Road(spec.road.clone());
        ground.bump = spec.ground_bump;
        let mut car = Surface::plain("car", spec.car_k, &spec.car_emissivity);
        car.bump = spec.car_bump;
        let mut person = Surface::plain("person", spec.person_k, &spec.person_emissivity);
        person.bump = spec.person_bump;
        let sky = Surface::plain("sky", spec.sky_k, &spec.sky_emissivity);
        let tyres = Surface::plain("tyres", spec.tyre_k, &spec.tyre_emissivity);
        let surfaces = vec![sky, ground, car, tyres, person];
        surfaces.iter().try_for_each(Surface::check)?;
        let mut scene = Self { surfaces, solids: Vec::new(), lights: Vec::new(), wall: None };
        if spec.car {
            scene.add_car(spec.car_at_m, spec.car_size_m)?;
        }
        if spec.person {
            scene.add_person(spec.person_at_m, spec.person_height_m)?;
        }
        Ok(scene)
    }

    fn add_box(&mut self, surface: usize, low: Vector, high: Vector) {
        self.solids.push(Solid { shape: Shape::Cuboid { low, high }, surface, light: self.lights.len() });
        self.lights.push(Light { surface, form: Form::Cuboid { low, high } });
    }

    /// A body on four wheels with a cabin on top, in proportion to the size.
    fn add_car(&mut self, at_m: [f64; 2], size_m: [f64; 3]) -> Result<()> {
        let [x, z] = at_m;
        check::finite("place of the car across the road", x, "m")?;
        check::positive("distance of the car", z, "m")?;
        let [length, width, height] = size_m;
        check::positive("length of the car", length, "m")?;
        check::positive("width of the car", width, "m")?;
        check::positive("height of the car", height, "m")?;
        let at = |across: f64, up: f64, ahead: f64| [x + across * width, up * height, z + ahead * length];
        self.add_box(CAR, at(-0.5, 0.18, 0.0), at(0.5, 0.62, 1.0));
        self.add_box(CAR, at(-0.43, 0.62, 0.1), at(0.43, 1.0, 0.7));
        for ahead in [0.12, 0.74] {
            for across in [-0.48, 0.36] {
                let low = at(across, 0.0, ahead);
                self.add_box(TYRES, low, at(across + 0.12, 0.18, ahead + 0.14));
            }
        }
        Ok(())
    }

    /// Legs, torso, arms and head, in proportion to the height.
    fn add_person(&mut self, at_m: [f64; 2], height_m: f64) -> Result<()> {
        let [x, z] = at_m;
        check::finite("place of the person across the road", x, "m")?;
        check::positive("distance of the person", z, "m")?;
        check::positive("height of the person", height_m, "m")?;
        let s = height_m / 1.75;
        let at = |across: f64, up: f64, ahead: f64| [x + across * s, up * s, z + ahead * s];
        let limb = |a: Vector, b: Vector, radius: f64| Shape::Capsule { ends: [a, b], radius: radius * s };
        let ball = |centre: Vector, semi: Vector| Shape::Ellipsoid { centre, semi: semi.map(|a| a * s) };
        let parts = [
            limb(at(-0.11, 0.075, 0.0), at(-0.1, 0.87, 0.0), 0.075),
            limb(at(0.11, 0.075, 0.08), at(0.1, 0.87, 0.0), 0.075),
            ball(at(0.0, 1.15, 0.0), [0.2, 0.38, 0.13]),
            limb(at(-0.22, 1.37, 0.0), at(-0.3, 0.8, -0.05), 0.05),
            limb(at(0.22, 1.37, 0.0), at(0.3, 0.8, 0.05), 0.05),
            ball(at(0.0, 1.625, 0.0), [0.085, 0.125, 0.1]),
        ];
        // The silhouette of all parts, laid side by side, makes the width of the screen.
        let silhouette: f64 = parts.iter().map(silhouette_m2).sum();
        let light = self.lights.len();
        for shape in parts {
            self.solids.push(Solid { shape, surface: PERSON, light });
        }
        let half_width_m = 0.5 * silhouette / height_m;
        self.lights.push(Light {
            surface: PERSON,
            form: Form::Screen { foot: [x, 0.0, z], half_width_m, height_m },
        });
        Ok(())
    }
}

/// Area of a part seen along z.
fn silhouette_m2(shape: &Shape) -> f64 {
    match *shape {
        Shape::Cuboid { low, high } => (high[0] - low[0]) * (high[1] - low[1]),
        Shape::Ellipsoid { semi, .. } => PI * semi[0] * semi[1],
        Shape::Capsule { ends: [a, b], radius } => {
            let [x, y, _] = along(b, -1.0, a);
            PI * radius * radius + 2.0 * radius * x.hypot(y)
        }
    }
}
