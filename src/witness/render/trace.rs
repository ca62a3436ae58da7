//! Rays through the pixels of both cameras, and what they add up to.
//!
//! A pixel is s × s rays at the middles of equal squares. What each of them meets adds its weight 1/s² to the
//! coefficients of e B(T) and (1 − e) S_k of the surface it belongs to; those are linear in τ, 1 − τ and V.

use super::light_map::LightMap;
use super::lighting::{Shares, factors, mean_shares, shares};
use super::radiosity::Basis;
use super::rig::{Camera, Rig};
use super::scene::{SKY, SURFACES, Scene, Target};
use super::surface::Footprint;
use super::vector::{Vector, along, dot, subtract};
use super::view::{Centre, MixedRow, View};
use crate::error::{Error, Result, check};
use crate::ranging::cube::Shape;
use crate::spectrum::Bands;
use rayon::prelude::*;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// More rays along a pixel than this change nothing.
const MAX_SAMPLES: usize = 32;
/// More scatterings than this change nothing unless everything is a mirror.
const MAX_BOUNCES: usize = 10_000;
/// Patches along a side of a box, over which mean factors are taken.
const PATCHES: usize = 6;
/// By how much a point seen by the other camera may seem further away than what that camera meets, relative.
const SAME_DEPTH: f64 = 1e-7;

/// How a scene is drawn.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Options {
    /// Scatterings between emission and camera, the last one at the point that is seen; 0 for emission alone.
    pub bounces: usize,
    /// Rays along each side of a pixel.
    pub samples: usize,
    /// Size of the finest grains of the road that are drawn, pixels: a lens would have blurred what is finer.
    pub finest_px: f64,
}

impl Default for Options {
    /// 8 scatterings (the paper's Fig. 4), 4 × 4 rays per pixel, grains of two pixels.
    fn default() -> Self {
        Self { bounces: 8, samples: 4, finest_px: 2.0 }
    }
}

impl Options {
    fn check(&self) -> Result<()> {
        check::non_negative("size of the finest grains", self.finest_px, "pixel")?;
        if self.samples == 0 || self.samples > MAX_SAMPLES {
            let found = format!("{} rays along the side of a pixel", self.samples);
            return Err(Error::malformed(found, format!("give from 1 to {MAX_SAMPLES}")));
        }
        if self.bounces > MAX_BOUNCES {
            let found = format!("{} scatterings", self.bounces);
            return Err(Error::malformed(found, format!("give at most {MAX_BOUNCES}")));
        }
        Ok(())
    }
}

/// Both pictures.
#[derive(Debug)]
pub struct StereoPair {
    /// The picture of the camera at x = −b/2.
    pub left: View,
    /// The picture of the camera at x = +b/2.
    pub right: View,
}

impl Scene {
    /// Draws both pictures. `progress` is told the rows done and their number, from any thread.
    ///
    /// # Errors
    /// A rig or options out of range, a camera inside a solid, emissivities that do not fit the nodes of the bands.
    ///
    /// ```
    /// use hadar::render::{Options, Part, Rig, Scene, StreetSpec};
    /// use hadar::spectrum::Bands;
    /// let bands = Bands::from_rows([(769.0, 1.0)])?;
    /// let rig = Rig { rows: 24, columns: 32, pixel_m: 240e-6, ..Rig::default() };
    /// let street = Scene::street(&StreetSpec::default())?;
    /// let pair = street.render(&rig, &bands, &Options::default(), &|_, _| ())?;
    /// let scattered = pair.left.cube(Part::Scattered, 1.0)?;
    /// assert_eq!(scattered.samples().len(), 24 * 32);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn render(
        &self,
        rig: &Rig,
        bands: &Bands,
        options: &Options,
        progress: &(dyn Fn(usize, usize) + Sync),
    ) -> Result<StereoPair> {
        let rig = rig.clone().checked()?;
        options.check()?;
        self.check(&rig)?;
        let shape = Shape::new(rig.rows, rig.columns, bands.len())?;
        let basis = Arc::new(Basis::new(self, &mean_shares(self, PATCHES), bands, options.bounces)?);
        let map = LightMap::new(self, &rig)?;
        let done = AtomicUsize::new(0);
        let tell = || progress(done.fetch_add(1, Ordering::Relaxed) + 1, 2 * rig.rows);
        let draw = |side: f64| {
            let (camera, other) = (rig.camera(side), rig.camera(-side));
            let tracer = Tracer {
                scene: self,
                rig: &rig,
                options,
                map: &map,
                basis: &basis,
                outlines: outlines(self, &camera),
                other_outlines: outlines(self, &other),
                camera,
                other,
            };
            tracer.view(shape, &tell)
        };
        Ok(StereoPair { left: draw(-0.5), right: draw(0.5) })
    }
}

/// First and last column, first and last row in which a solid may be seen.
type Outline = [f64; 4];

fn outlines(scene: &Scene, camera: &Camera) -> Vec<Outline> {
    let everywhere = [f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY];
    let outline = |[low, high]: [Vector; 2]| {
        let mut outline = [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY];
        for corner in 0..8 {
            let point = std::array::from_fn(|i| if corner >> i & 1 == 1 { high[i] } else { low[i] });
            let Some([column, row, depth]) = camera.project(point) else { return everywhere };
            if depth < 1e-3 {
                return everywhere;
            }
            outline[0] = outline[0].min(column - 1.0);
            outline[1] = outline[1].max(column + 1.0);
            outline[2] = outline[2].min(row - 1.0);
            outline[3] = outline[3].max(row + 1.0);
        }
        outline
    };
    scene.solids.iter().map(|solid| outline(solid.shape.bounds())).collect()
}

/// Solids that may be seen in a pixel, as bits.
fn candidates(outlines: &[Outline], column: f64, row: f64) -> u32 {
    let within = |o: &Outline| column >= o[0] && column <= o[1] && row >= o[2] && row <= o[3];
    outlines.iter().enumerate().fold(0, |bits, (i, outline)| bits | u32::from(within(outline)) << i)
}

/// A surface point as a ray sees it.
struct Seen {
    surface: usize,
    texture: f64,
    shares: Shares,
}

struct Tracer<'a> {
    scene: &'a Scene,
    rig: &'a Rig,
    options: &'a Options,
    map: &'a LightMap,
    basis: &'a Arc<Basis>,
    camera: Camera,
    other: Camera,
    outlines: Vec<Outline>,
    other_outlines: Vec<Outline>,
}

impl Tracer<'_> {
    fn view(&self, shape: Shape, tell: &(dyn Fn() + Sync)) -> View {
        let drawn: Vec<(MixedRow, Vec<(Centre, Shares)>)> = (0..shape.rows())
            .into_par_iter()
            .map(|row| {
                let drawn = self.row(row);
                tell();
                drawn
            })
            .collect();
        let pixels = shape.rows() * shape.columns();
        let sources = self.basis.sources;
        let mut view = View {
            shape,
            basis: Arc::clone(self.basis),
            rows: Vec::with_capacity(shape.rows()),
            depth_m: Vec::with_capacity(pixels),
            disparity_px: Vec::with_capacity(pixels),
            temperature_k: Vec::with_capacity(pixels),
            surface: Vec::with_capacity(pixels),
            texture: Vec::with_capacity(pixels),
            lighting: Vec::with_capacity(pixels * sources),
            seen_by_other: Vec::with_capacity(pixels),
        };
        for (row, centres) in drawn {
            view.rows.push(row);
            for (centre, shares) in centres {
                view.depth_m.push(centre.depth_m);
                view.disparity_px.push(self.rig.disparity_px(centre.depth_m));
                view.temperature_k.push(self.scene.surfaces[usize::from(centre.surface)].temperature_k);
                view.surface.push(centre.surface);
                view.texture.push(centre.texture);
                view.lighting.extend(shares.iter().take(sources));
                view.seen_by_other.push(centre.seen_by_other);
            }
        }
        view
    }

    fn row(&self, row: usize) -> (MixedRow, Vec<(Centre, Shares)>) {
        let (columns, samples) = (self.rig.columns, self.options.samples);
        let (mut mixed, mut centres) = (MixedRow::default(), Vec::with_capacity(columns));
        let weight = 1.0 / (samples * samples) as f64;
        let offset = |i: usize| (i as f64 + 0.5) / samples as f64 - 0.5;
        for column in 0..columns {
            let (x, y) = (column as f64, row as f64);
            let solids = candidates(&self.outlines, x, y);
            centres.push(self.centre(x, y, solids));
            let mut mixture = Mixture::default();
            for i in 0..samples {
                for j in 0..samples {
                    let direction = self.camera.direction(x + offset(j), y + offset(i));
                    let (depth, target) = self.scene.hit(self.camera.origin, direction, solids);
                    mixture.add(weight, &self.seen(direction, depth, target));
                }
            }
            mixture.store(self.basis, &mut mixed);
        }
        (mixed, centres)
    }

    /// What a ray in `direction` sees at `depth`.
    #[inline]
    fn seen(&self, direction: Vector, depth: f64, target: Target) -> Seen {
        let surface = self.scene.surface_of(target);
        if target == Target::Sky {
            return Seen { surface, texture: 0.0, shares: Shares::default() };
        }
        let mut point = along(self.camera.origin, depth, direction);
        if target == Target::Ground {
            point[1] = 0.0;
        }
        let object = &self.scene.surfaces[surface];
        let texture =
            if object.is_mixed() { object.texture.at(point, &self.footprint(direction, depth)) } else { 0.0 };
        let smooth = self.scene.smooth_normal(target, point);
        let factors = match target {
            Target::Ground => self.map.at(point),
            Target::Solid(index) => {
                factors(self.scene, point, smooth, self.scene.solids.get(index).map(|solid| solid.light))
            }
            Target::Wall(_) | Target::Sky => Default::default(),
        };
        Seen { surface, texture, shares: shares(&factors, object.normal(point, smooth)) }
    }

    /// Distances between rays on the ground: functions of the depth alone, up to rounding, since all of a row have
    /// one.
    #[inline]
    fn footprint(&self, direction: Vector, depth: f64) -> Footprint {
        let pixel_m = depth / self.camera.focal_px;
        let across_m = pixel_m / self.options.samples as f64;
        let [_, cos, sin] = self.camera.up;
        let stretch = depth * cos * direction[2] / self.rig.height_m + sin;
        Footprint {
            across_m,
            ahead_m: across_m * stretch.abs(),
            finest_m: (self.options.finest_px * pixel_m).max(2.0 * across_m),
        }
    }

    fn centre(&self, column: f64, row: f64, solids: u32) -> (Centre, Shares) {
        let direction = self.camera.direction(column, row);
        let (depth, target) = self.scene.hit(self.camera.origin, direction, solids);
        let seen = self.seen(direction, depth, target);
        let seen_by_other = self.seen_by_other(column, row, direction, depth);
        let centre =
            Centre { depth_m: depth, surface: seen.surface as u8, texture: seen.texture, seen_by_other };
        (centre, seen.shares)
    }

    fn seen_by_other(&self, column: f64, row: f64, direction: Vector, depth: f64) -> bool {
        let apart = (self.camera.origin[0] - self.other.origin[0]) * self.camera.focal_px / depth;
        let there = column + apart;
        if !(-0.5..=self.rig.columns as f64 - 0.5).contains(&there) {
            return false;
        }
        let towards = if depth.is_finite() {
            let point = along(self.camera.origin, depth, direction);
            let from = subtract(point, self.other.origin);
            along([0.0; 3], 1.0 / dot(from, self.other.forward), from)
        } else {
            direction
        };
        let bits = candidates(&self.other_outlines, there, row);
        let (met, _) = self.scene.hit(self.other.origin, towards, bits);
        met >= depth * (1.0 - SAME_DEPTH)
    }
}

/// Coefficients of a pixel.
#[derive(Default)]
struct Mixture {
    /// Surfaces that are there, as bits.
    present: u32,
    /// [surface][emissivity]: weight, then weight × V of every surface.
    weights: [[(f64, Shares); 2]; SURFACES],
}

impl Mixture {
    #[inline]
    fn add(&mut self, weight: f64, seen: &Seen) {
        let Some(kinds) = self.weights.get_mut(seen.surface) else { return };
        self.present |= 1 << seen.surface;
        for (kind, share) in kinds.iter_mut().zip([1.0 - seen.texture, seen.texture]) {
            let weight = weight * share;
            kind.0 += weight;
            for (sum, v) in kind.1.iter_mut().zip(seen.shares) {
                *sum += weight * v;
            }
        }
    }

    fn store(&self, basis: &Basis, row: &mut MixedRow) {
        for (surface, kinds) in self.weights.iter().enumerate() {
            if self.present >> surface & 1 == 0 {
                continue;
            }
            row.surfaces.push(surface as u8);
            let end = row.coefficients.len() + basis.rows(surface);
            for (weight, shares) in kinds {
                if row.coefficients.len() < end {
                    row.coefficients.push(*weight);
                    if surface != SKY {
                        row.coefficients.extend(shares.iter().take(basis.sources));
                    }
                }
            }
        }
        row.entries_until.push(row.surfaces.len() as u32);
    }
}

#[cfg(test)]
mod tests;
