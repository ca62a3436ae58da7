//! What a ranging study looks at: a rendered pair with all its truth, or measured cubes.

use super::watched::Watch;
use crate::Warning;
use crate::cube_bad::BadFound;
use hadar::cube::{Cube, Shape};
use hadar::error::{Error, Result};
use hadar::fisher::Counting;
use hadar::ranging::noise::NoiseVariance;
use hadar_formats::cube::Found;
use hadar_simulate::render::{Options, Part, Rig, Scene, View};
use std::sync::Arc;

/// The subject with its names looked up.
#[derive(Debug)]
pub(super) enum Resolved {
    Scene(Box<Rendered>),
    Cube(Box<Measured>),
}

/// A scene in front of its camera.
#[derive(Debug)]
pub(super) struct Rendered {
    pub(super) scene: Scene,
    pub(super) rig: Rig,
    pub(super) options: Options,
    pub(super) counting: Counting,
    pub(super) noise: NoiseVariance,
}

/// Cubes from files.
#[derive(Debug)]
pub(super) struct Measured {
    pub(super) left: Cube,
    /// What the file of the left view was read as.
    pub(super) read: Found,
    pub(super) warnings: Vec<Warning>,
    pub(super) right: Option<Cube>,
    /// What is seen of both views as they are read.
    pub(super) watches: Vec<Arc<Watch>>,
    pub(super) noise: NoiseVariance,
    pub(super) photons_per_unit: f64,
    pub(super) depth: Option<Depth>,
    /// Pixels of each view that were found to be bad; their samples are missing in it.
    pub(super) bad: Vec<BadFound>,
}

/// Depth of a cube's pixels, m.
#[derive(Debug)]
pub(super) enum Depth {
    Uniform(f64),
    Map(Vec<f64>),
}

impl Rendered {
    /// σ² of each band, counts².
    pub(super) fn var_per_band(&self, bands: usize) -> Vec<f64> {
        (0..bands).map(|band| self.counting.var_added(band)).collect()
    }

    /// Expected counts of a part of the signal in one view.
    pub(super) fn counts(&self, view: &View, part: Part) -> Result<Cube> {
        Ok(Cube::from(view.cube(part, self.counting.counts_per_radiance)?))
    }
}

/// What is at each pixel of the left view: depth, and which object.
#[derive(Debug, Default)]
pub(super) struct Truth {
    /// m; NaN where not known, infinite in the sky.
    pub(super) depth_m: Vec<f64>,
    /// Whether the right camera sees the same.
    pub(super) seen: Vec<bool>,
    /// Names of the objects, and the place in them of each pixel.
    pub(super) names: Vec<String>,
    pub(super) object: Vec<u8>,
}

impl Truth {
    pub(super) fn of_scene(scene: &Scene, view: &View) -> Self {
        Self {
            depth_m: view.depth_m.clone(),
            seen: view.seen_by_other.clone(),
            names: scene.surfaces().iter().map(|surface| surface.name.clone()).collect(),
            object: view.surface.clone(),
        }
    }

    pub(super) fn of_cube(depth: Option<&Depth>, shape: Shape) -> Self {
        let pixels = shape.rows() * shape.columns();
        let depth_m = match depth {
            None => vec![f64::NAN; pixels],
            Some(Depth::Uniform(depth_m)) => vec![*depth_m; pixels],
            Some(Depth::Map(map)) => map.clone(),
        };
        Self { depth_m, seen: vec![true; pixels], names: Vec::new(), object: Vec::new() }
    }
}

/// No window has a bound: what to say of it.
pub(super) fn nothing_to_see() -> Error {
    Error::malformed(
        "no window has all of its pixels in both views",
        "make the window smaller or the view wider, lower the baseline, or move things away",
    )
}

/// The same where so many windows hold a missing sample.
pub(super) fn nothing_left(missing: usize) -> Error {
    if missing == 0 {
        return nothing_to_see();
    }
    Error::malformed(
        format!("{missing} windows hold a missing sample, and no other has all of its pixels in both views"),
        "fill missing samples, or make the window smaller; where every row misses some, write derivative = \"central\"",
    )
}

impl Measured {
    /// The noise in units of the file, where these are not photons.
    pub(super) fn noise_per_unit(&self) -> Result<Option<NoiseVariance>> {
        let g = self.photons_per_unit;
        Ok(match &self.noise {
            _ if g == 1.0 => None,
            NoiseVariance::None => None,
            NoiseVariance::Uniform(var) => Some(NoiseVariance::Uniform(var / g)),
            NoiseVariance::PerBand(var) => {
                Some(NoiseVariance::PerBand(var.iter().map(|var| var / g).collect()))
            }
            NoiseVariance::PerSample(_) => {
                let instead = "give the counts in photons, or one variance per band";
                return Err(Error::malformed("variances per sample beside photons_per_unit", instead));
            }
        })
    }
}
