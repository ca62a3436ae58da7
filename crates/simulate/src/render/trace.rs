//! Rays through the pixels of both cameras, and what they add up to.
//!
//! A pixel is s × s rays at the middles of equal squares. What each of them meets adds its weight 1/s² to the
//! coefficients of e B(T) and (1 − e) S_k of the surface it belongs to; those are linear in τ, 1 − τ and V.

use super::light_map::LightMap;
use super::lighting::{Room, Shares, factors, mean_shares, shares};
use super::radiosity::Basis;
use super::rig::{Camera, Rig};
use super::scene::{GROUND, SKY, SURFACES, Scene, Target};
use super::surface::{Footprint, RoadLine, Surface, Texture};
use super::uneven::NODES;
use super::vector::{UP, Vector, along, dot, scaled, subtract};
use super::view::{Centre, MixedRow, View};
use hadar::cube::Shape;
use hadar::error::{Error, Result, check};
use hadar::parallel;
use hadar::spectrum::Bands;
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
#[non_exhaustive]
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
    /// use hadar_simulate::render::{Options, Part, Rig, Scene, StreetSpec};
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
        let [left, right] = self.drawn(rig, [-0.5, 0.5], bands, options, progress)?;
        Ok(StereoPair { left, right })
    }

    /// Draws the picture of the left camera alone, as [`Scene::render`].
    ///
    /// # Errors
    /// As [`Scene::render`].
    pub fn view(
        &self,
        rig: &Rig,
        bands: &Bands,
        options: &Options,
        progress: &(dyn Fn(usize, usize) + Sync),
    ) -> Result<View> {
        let [left] = self.drawn(rig, [-0.5], bands, options, progress)?;
        Ok(left)
    }

    fn drawn<const VIEWS: usize>(
        &self,
        rig: &Rig,
        sides: [f64; VIEWS],
        bands: &Bands,
        options: &Options,
        progress: &(dyn Fn(usize, usize) + Sync),
    ) -> Result<[View; VIEWS]> {
        let rig = rig.clone().checked()?;
        options.check()?;
        self.check(&rig)?;
        let shape = Shape::new(rig.rows, rig.columns, bands.len())?;
        let basis = Arc::new(Basis::new(self, &mean_shares(self, PATCHES), bands, options.bounces)?);
        let map = LightMap::new(self, &rig)?;
        let done = AtomicUsize::new(0);
        let tell = || progress(done.fetch_add(1, Ordering::Relaxed) + 1, VIEWS * rig.rows);
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
        Ok(sides.map(draw))
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

/// What a ray meets.
#[derive(Clone, Copy)]
struct Met {
    target: Target,
    point: Vector,
    smooth: Vector,
    texture: f64,
}

/// The road along a row of rays.
struct RoadRow<'a> {
    depth: f64,
    z: f64,
    line: RoadLine<'a>,
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
        let drawn: Vec<(MixedRow, Vec<Centre>)> = parallel::map_with(
            shape.rows(),
            || (Vec::new(), Room::default()),
            |(rays, room), row| {
                let drawn = self.row(row, rays, room);
                tell();
                drawn
            },
        );
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
            pure: Vec::with_capacity(pixels),
            seen_by_other: Vec::with_capacity(pixels),
        };
        for (row, centres) in drawn {
            view.rows.push(row);
            for centre in centres {
                view.depth_m.push(centre.depth_m);
                view.disparity_px.push(self.rig.disparity_px(centre.depth_m));
                view.temperature_k.push(centre.temperature_k);
                view.surface.push(centre.surface);
                view.texture.push(centre.texture);
                view.lighting.extend(centre.lighting.iter().take(sources));
                view.pure.push(centre.pure);
                view.seen_by_other.push(centre.seen_by_other);
            }
        }
        view
    }

    fn row(&self, row: usize, rays: &mut Vec<Met>, room: &mut Room) -> (MixedRow, Vec<Centre>) {
        let (columns, samples) = (self.rig.columns, self.options.samples);
        let (mut mixed, mut centres) = (MixedRow::default(), Vec::with_capacity(columns));
        let weight = 1.0 / (samples * samples) as f64;
        let offset = |i: usize| (i as f64 + 0.5) / samples as f64 - 0.5;
        let y = row as f64;
        let mut roads: Vec<_> = (0..samples).map(|i| self.road(y + offset(i))).collect();
        let (mut mixture, mut across, mut places) = (Mixture::default(), Vec::new(), Vec::new());
        for column in 0..columns {
            hadar::stop::check();
            let x = column as f64;
            let solids = candidates(&self.outlines, x, y);
            across.clear();
            across.extend((0..samples).map(|j| self.camera.direction(x + offset(j), y)[0]));
            if solids == 0 && self.road_alone(&across, &mut places, &mut roads, &mut mixture) {
                centres.push(self.centre(x, y, solids, &mixture));
                mixture.store(self.basis, &mut mixed);
                mixture.clear();
                continue;
            }
            rays.clear();
            for (i, road) in roads.iter_mut().enumerate() {
                for j in 0..samples {
                    let direction = self.camera.direction(x + offset(j), y + offset(i));
                    let (depth, target) = self.scene.hit(self.camera.origin, direction, solids);
                    rays.push(self.met(direction, depth, target, road));
                }
            }
            self.shade(rays, weight, &mut mixture, room);
            centres.push(self.centre(x, y, solids, &mixture));
            mixture.store(self.basis, &mut mixed);
            mixture.clear();
        }
        (mixed, centres)
    }

    /// The road as the rays of a row meet it, which are of one depth on it.
    fn road(&self, y: f64) -> Option<RoadRow<'_>> {
        let direction = self.camera.direction(0.0, y);
        let (depth, target) = self.scene.hit(self.camera.origin, direction, 0);
        let ground = self.scene.surfaces.get(GROUND).filter(|ground| ground.is_mixed())?;
        match &ground.texture {
            Texture::Road(road) if target == Target::Ground => {
                let z = along(self.camera.origin, depth, direction)[2];
                Some(RoadRow { depth, z, line: road.line(z, &self.footprint(direction, depth)) })
            }
            _ => None,
        }
    }

    /// Adds a pixel without solids whose rays, of these directions across, all meet the road; false where they do not, or where more
    /// than its texture varies. `places` is room.
    fn road_alone(
        &self,
        across: &[f64],
        places: &mut Vec<f64>,
        roads: &mut [Option<RoadRow<'_>>],
        mixture: &mut Mixture,
    ) -> bool {
        let plain = |ground: &&Surface| ground.bump.is_none() && ground.uneven.is_none();
        let Some(ground) = self.scene.surfaces.get(GROUND).filter(plain) else { return false };
        if roads.iter().any(Option::is_none) {
            return false;
        }
        let share = 1.0 / (across.len() * across.len()) as f64;
        let (mut texture, mut middle) = (0.0, [0.0; 3]);
        for RoadRow { depth, z, line } in roads.iter_mut().flatten() {
            places.clear();
            places.extend(across.iter().map(|direction| self.camera.origin[0] + *depth * direction));
            texture += share * line.sum(places);
            middle[0] += share * places.iter().sum::<f64>();
            middle[2] += *z / across.len() as f64;
        }
        mixture.add(1.0, GROUND, texture, ground, middle, &shares(&self.map.at(middle), UP));
        true
    }

    /// What a ray in `direction` meets at `depth`, with the road of its row.
    #[inline]
    fn met(&self, direction: Vector, depth: f64, target: Target, road: &mut Option<RoadRow<'_>>) -> Met {
        if target == Target::Sky {
            return Met { target, point: direction, smooth: UP, texture: 0.0 };
        }
        let mut point = along(self.camera.origin, depth, direction);
        if target == Target::Ground {
            point[1] = 0.0;
        }
        let object = &self.scene.surfaces[self.scene.surface_of(target)];
        let texture = match road {
            Some(road) if target == Target::Ground => road.line.at(point[0]),
            _ if object.is_mixed() => object.texture.at(point, &self.footprint(direction, depth)),
            _ => 0.0,
        };
        Met { target, point, smooth: self.scene.smooth_normal(target, point), texture }
    }

    /// Adds the rays of a pixel, side by side on each face: how it is lit is taken at the middle of what they meet there, since form
    /// factors vary over decimetres; how it is turned, at each ray.
    fn shade(&self, rays: &mut [Met], weight: f64, mixture: &mut Mixture, room: &mut Room) {
        hadar::stop::check();
        let mut left = rays;
        while let Some(&first) = left.first() {
            let flat =
                !matches!(first.target, Target::Solid(index) if self.scene.solids[index].shape.is_round());
            let alike = |met: &Met| met.target == first.target && (!flat || met.smooth == first.smooth);
            let mut count = 0;
            for i in 0..left.len() {
                if alike(&left[i]) {
                    left.swap(count, i);
                    count += 1;
                }
            }
            let (own, rest) = std::mem::take(&mut left).split_at_mut(count);
            left = rest;
            let surface = self.scene.surface_of(first.target);
            let object = &self.scene.surfaces[surface];
            if first.target == Target::Sky {
                own.iter().for_each(|met| {
                    mixture.add(weight, surface, met.texture, object, met.point, &[0.0; SURFACES])
                });
                continue;
            }
            let sum = own.iter().fold([0.0; 3], |sum, met| along(sum, 1.0, met.point));
            let middle = scaled(sum, 1.0 / count as f64);
            let factors = match first.target {
                Target::Ground => self.map.at(middle),
                Target::Solid(index) => {
                    let smooth = self.scene.smooth_normal(first.target, middle);
                    factors(self.scene, middle, smooth, Some(index), room)
                }
                Target::Wall(_) | Target::Sky => Default::default(),
            };
            if flat && object.bump.is_none() && object.uneven.is_none() {
                // All of them alike but for the texture, of which a mixture is linear.
                let texture = own.iter().map(|met| met.texture).sum::<f64>() / count as f64;
                let lit = shares(&factors, first.smooth);
                mixture.add(weight * count as f64, surface, texture, object, middle, &lit);
                continue;
            }
            for met in own.iter() {
                let lit = shares(&factors, object.normal(met.point, met.smooth));
                mixture.add(weight, surface, met.texture, object, met.point, &lit);
            }
        }
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

    fn centre(&self, column: f64, row: f64, solids: u32, mixture: &Mixture) -> Centre {
        let direction = self.camera.direction(column, row);
        let (depth_m, target) = self.scene.hit(self.camera.origin, direction, solids);
        let surface = self.scene.surface_of(target);
        let seen_by_other = self.seen_by_other(column, row, direction, depth_m);
        let mut centre = mixture.mean_of(surface).unwrap_or_else(|| {
            // Between the rays the centre alone meets it.
            let mut alone = Mixture::default();
            let met = self.met(direction, depth_m, target, &mut None);
            self.shade(&mut [met], 1.0, &mut alone, &mut Room::default());
            Centre { pure: false, ..alone.mean_of(surface).unwrap_or_default() }
        });
        (centre.depth_m, centre.seen_by_other) = (depth_m, seen_by_other);
        centre
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
    parts: [Part; SURFACES],
}

/// Those of one surface.
#[derive(Default, Clone, Copy)]
struct Part {
    /// Of each emissivity: weight of the emission at each temperature, then weight × V of every surface.
    kinds: [([f64; NODES], Shares); 2],
    /// Weight, weight × τ, weight × T.
    sums: [f64; 3],
    /// Whether each of the emissivities is there.
    seen: [bool; 2],
}

impl Mixture {
    /// Takes everything out.
    fn clear(&mut self) {
        for (surface, part) in self.parts.iter_mut().enumerate() {
            if self.present >> surface & 1 == 1 {
                *part = Part::default();
            }
        }
        self.present = 0;
    }

    #[inline]
    fn add(
        &mut self,
        weight: f64,
        surface: usize,
        texture: f64,
        object: &Surface,
        point: Vector,
        lit: &Shares,
    ) {
        let Some(part) = self.parts.get_mut(surface) else { return };
        self.present |= 1 << surface;
        let temperature_k = object.temperature_at(point);
        let nodes = object.weights(temperature_k);
        for (sum, x) in part.sums.iter_mut().zip([1.0, texture, temperature_k]) {
            *sum += weight * x;
        }
        for ((kind, seen), share) in part.kinds.iter_mut().zip(&mut part.seen).zip([1.0 - texture, texture]) {
            // What rounding leaves of the other one is none of it.
            if share > 1e-9 {
                *seen = true;
                kind.0.iter_mut().zip(nodes).for_each(|(sum, node)| *sum += weight * share * node);
                kind.1.iter_mut().zip(lit).for_each(|(sum, v)| *sum += weight * share * v);
            }
        }
    }

    /// Means over what is there of a surface.
    fn mean_of(&self, surface: usize) -> Option<Centre> {
        let part = self.parts.get(surface).filter(|part| part.sums[0] > 0.0)?;
        let [weight, texture, kelvin] = part.sums;
        let mut lighting = Shares::default();
        for (mean, (a, b)) in lighting.iter_mut().zip(part.kinds[0].1.iter().zip(part.kinds[1].1)) {
            *mean = (a + b) / weight;
        }
        Some(Centre {
            surface: surface as u8,
            texture: texture / weight,
            temperature_k: kelvin / weight,
            lighting,
            pure: self.present == 1 << surface && part.seen != [true; 2],
            ..Centre::default()
        })
    }

    fn store(&self, basis: &Basis, row: &mut MixedRow) {
        for (surface, part) in self.parts.iter().enumerate() {
            if self.present >> surface & 1 == 0 {
                continue;
            }
            row.surfaces.push(surface as u8);
            let end = row.coefficients.len() + basis.rows(surface);
            let temperatures = basis.temperatures.get(surface).copied().unwrap_or(1);
            for (emitted, shares) in &part.kinds {
                if row.coefficients.len() < end {
                    row.coefficients.extend(emitted.iter().take(temperatures));
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
