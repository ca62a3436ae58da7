//! What stands in a scene, put together from convex solids.
//!
//! A car is a body on four wheels with a cabin on top; a person has legs, a torso, arms and a head; a robot has the same limbs about a box.
//! All are in proportion to the size that is given.

use super::scene::{Scene, Solid};
use super::shape::Shape;
use super::surface::Surface;
use super::vector::Vector;
use hadar::error::{Error, Result, check};

/// Most surfaces of a scene, sky and ground among them.
pub const MOST_SURFACES: usize = super::scene::SURFACES;
/// Solids that fit into the bits of a word.
const MOST_SOLIDS: usize = 32;

/// The form of an object. Sizes are in m; whatever it is, it stands on the ground.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Body {
    /// A person of this height.
    Person {
        /// Height of the object above its base, m.
        height_m: f64,
    },
    /// A robot of a person's form, of this height.
    Robot {
        /// Height of the object above its base, m.
        height_m: f64,
    },
    /// A car along z; its tyres are a surface of their own.
    Car {
        /// Length, width and height, m.
        size_m: [f64; 3],
        /// The surface of the tyres of the car.
        tyres: Box<Surface>,
    },
    /// A box: a wall, a crate.
    Block {
        /// Length along z, width and height, m.
        size_m: [f64; 3],
    },
    /// An upright cylinder with round ends: a post, a trunk.
    Post {
        /// Height of the object above its base, m.
        height_m: f64,
        /// Radius of the round object, m.
        radius_m: f64,
    },
    /// An ellipsoid, its middle above the ground: a bush, a crown.
    Ball {
        /// Length along z, width and height, m.
        size_m: [f64; 3],
        /// Height of its lowest point, m.
        above_m: f64,
    },
}

/// An object of a scene.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Object {
    /// The surface that the object shows.
    pub surface: Surface,
    /// Its place on the ground, x and z, m; of a car and a block the middle of the near end.
    pub at_m: [f64; 2],
    /// The geometric form of the object.
    pub body: Body,
}

impl Scene {
    /// A scene of sky and ground.
    ///
    /// # Errors
    /// A temperature that is not positive, an emissivity outside [0, 1].
    ///
    /// ```
    /// use hadar_simulate::render::{Body, Emissivity, Object, Scene, Surface};
    /// let surface = |name: &str, kelvin| Surface::plain(name, kelvin, &Emissivity::Constant(0.95));
    /// let mut scene = Scene::new(surface("sky", 260.0), surface("ground", 285.0))?;
    /// let body = Body::Person { height_m: 1.75 };
    /// scene.add(Object { surface: surface("person", 306.0), at_m: [0.0, 8.0], body })?;
    /// assert_eq!(scene.surfaces().len(), 3);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn new(sky: Surface, ground: Surface) -> Result<Self> {
        let scene = Self { surfaces: vec![sky, ground], solids: Vec::new(), wall: None };
        scene.surfaces.iter().try_for_each(Surface::check)?;
        Ok(scene)
    }

    /// Puts an object into the scene.
    ///
    /// # Errors
    /// A size that is not positive, a place that is not before the cameras, more objects than a scene holds.
    pub fn add(&mut self, object: Object) -> Result<()> {
        let name = object.surface.name.clone();
        let surface = self.surfaces.len();
        self.surfaces.push(object.surface);
        if let Body::Car { tyres, .. } = &object.body {
            self.surfaces.push(Surface::clone(tyres));
        }
        let check = || -> Result<()> {
            self.surfaces.iter().skip(surface).try_for_each(Surface::check)?;
            if self.surfaces.len() > MOST_SURFACES {
                let found = format!("{} surfaces in one scene", self.surfaces.len());
                return Err(Error::malformed(found, format!("give at most {MOST_SURFACES}")));
            }
            check::finite("place across the view", object.at_m[0], "m")?;
            check::positive("distance", object.at_m[1], "m").map(drop)
        };
        check()
            .and_then(|()| self.stand(surface, object.at_m, &object.body))
            .map_err(|error| error.for_key(&name))
    }

    /// The solids of a body of surface `surface`; the tyres of a car are the surface after it.
    fn stand(&mut self, surface: usize, [x, z]: [f64; 2], body: &Body) -> Result<()> {
        let parts = body.parts(x, z)?;
        for (shape, further) in parts {
            self.solids.push(Solid { shape, surface: surface + further });
        }
        if self.solids.len() > MOST_SOLIDS {
            let found = format!("{} solids in one scene", self.solids.len());
            return Err(Error::malformed(
                found,
                format!("give at most {MOST_SOLIDS}: a person, robot or car is six, anything else one"),
            ));
        }
        Ok(())
    }
}

impl Body {
    /// Its solids, each with its place among the surfaces of the body.
    fn parts(&self, x: f64, z: f64) -> Result<Vec<(Shape, usize)>> {
        let lengths = |[length, width, height]: [f64; 3]| -> Result<()> {
            check::positive("length", length, "m")?;
            check::positive("width", width, "m")?;
            check::positive("height", height, "m").map(drop)
        };
        match *self {
            Self::Person { height_m } => {
                check::positive("height", height_m, "m")?;
                let (limbs, ball) = (limbs(x, z, height_m), ball(x, z, height_m));
                let trunk =
                    [ball([0.0, 1.15, 0.0], [0.2, 0.38, 0.13]), ball([0.0, 1.625, 0.0], [0.085, 0.125, 0.1])];
                Ok(limbs.into_iter().chain(trunk).map(|shape| (shape, 0)).collect())
            }
            Self::Robot { height_m } => {
                check::positive("height", height_m, "m")?;
                let s = height_m / 1.75;
                let at = |[a, b, c]: Vector| [x + a * s, b * s, z + c * s];
                let trunk = Shape::Cuboid { low: at([-0.17, 0.87, -0.11]), high: at([0.17, 1.45, 0.11]) };
                let head = Shape::Cuboid { low: at([-0.09, 1.49, -0.1]), high: at([0.09, 1.75, 0.1]) };
                Ok(limbs(x, z, height_m).into_iter().chain([trunk, head]).map(|shape| (shape, 0)).collect())
            }
            Self::Car { size_m, .. } => {
                lengths(size_m)?;
                let [length, width, height] = size_m;
                let at =
                    |across: f64, up: f64, ahead: f64| [x + across * width, up * height, z + ahead * length];
                let mut parts = vec![
                    (Shape::Cuboid { low: at(-0.5, 0.18, 0.0), high: at(0.5, 0.62, 1.0) }, 0),
                    (Shape::Cuboid { low: at(-0.43, 0.62, 0.1), high: at(0.43, 1.0, 0.7) }, 0),
                ];
                for ahead in [0.12, 0.74] {
                    for across in [-0.48, 0.36] {
                        let (low, high) = (at(across, 0.0, ahead), at(across + 0.12, 0.18, ahead + 0.14));
                        parts.push((Shape::Cuboid { low, high }, 1));
                    }
                }
                Ok(parts)
            }
            Self::Block { size_m } => {
                lengths(size_m)?;
                let [length, width, height] = size_m;
                let low = [x - 0.5 * width, 0.0, z];
                Ok(vec![(Shape::Cuboid { low, high: [x + 0.5 * width, height, z + length] }, 0)])
            }
            Self::Post { height_m, radius_m } => {
                check::positive("radius", radius_m, "m")?;
                check::positive("height above its round ends", height_m - 2.0 * radius_m, "m")?;
                let ends = [[x, radius_m, z], [x, height_m - radius_m, z]];
                Ok(vec![(Shape::Capsule { ends, radius: radius_m }, 0)])
            }
            Self::Ball { size_m, above_m } => {
                lengths(size_m)?;
                check::non_negative("height above the ground", above_m, "m")?;
                let [length, width, height] = size_m.map(|size| 0.5 * size);
                let centre = [x, above_m + height, z];
                Ok(vec![(Shape::Ellipsoid { centre, semi: [width, height, length] }, 0)])
            }
        }
    }
}

/// Legs and arms of somebody of this height.
fn limbs(x: f64, z: f64, height_m: f64) -> [Shape; 4] {
    let s = height_m / 1.75;
    let at = |[a, b, c]: Vector| [x + a * s, b * s, z + c * s];
    let limb =
        |a: Vector, b: Vector, radius: f64| Shape::Capsule { ends: [at(a), at(b)], radius: radius * s };
    [
        limb([-0.11, 0.075, 0.0], [-0.1, 0.87, 0.0], 0.075),
        limb([0.11, 0.075, 0.08], [0.1, 0.87, 0.0], 0.075),
        limb([-0.22, 1.37, 0.0], [-0.3, 0.8, -0.05], 0.05),
        limb([0.22, 1.37, 0.0], [0.3, 0.8, 0.05], 0.05),
    ]
}

fn ball(x: f64, z: f64, height_m: f64) -> impl Fn(Vector, Vector) -> Shape {
    let s = height_m / 1.75;
    move |[a, b, c], semi| Shape::Ellipsoid {
        centre: [x + a * s, b * s, z + c * s],
        semi: semi.map(|r| r * s),
    }
}
