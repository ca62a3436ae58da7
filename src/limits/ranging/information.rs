//! Fisher information about the x position of a window, with and without spatial and spectral resolution.
//!
//! With counts N and their derivative ∂N = ∂N/∂x (pixel⁻¹) in pixel p of the window and band b, electronic noise of
//! variance σ² per sample:
//!
//! * both resolutions:   J = Σ_p Σ_b (∂N)²/(N + σ²)
//! * spatial alone:      J = Σ_p (Σ_b ∂N)²/Σ_b (N + σ²)
//! * spectral alone:     J = Σ_b (Σ_p ∂N)²/Σ_p (N + σ²)
//! * neither:            J = (Σ_p Σ_b ∂N)²/Σ_p Σ_b (N + σ²)
//!
//! in pixel⁻². Where samples are joined, Σσ² is what [`Joined`](crate::ranging::noise::Joined) says. Without electronic noise none of the four exceeds the
//! one above it in this list that has all of its resolutions and more (Cauchy–Schwarz).
//!
//! The information of one photon is J⁰ = J (1 + γ)/N with the window's photons N = ΣΣN and γ = ΣΣσ²/N; σ_c² = 1/J⁰.
//!
//! A count that is missing is NaN. So is then the information of every window that it lies in or whose derivative is taken of it: one or two
//! more columns on either side by differences ([`Derivative::margin`](crate::ranging::derivative::Derivative::margin)), the whole row by splines and Fourier.
//!
//! Assumptions: the counts are expectations (no noise of their own: noise in N adds texture that is not there); pixels
//! and bands independent.
//!
//! Source: paper S37–S40, Tables S4 and S5.

mod blocks;
mod bounds;
mod boxes;
mod checks;
pub mod decide;
mod direct;
mod kernels;
mod limits;
mod parts;
mod pixels;
mod request;
mod rows;
mod samples;
mod strips;
#[cfg(test)]
mod tests;

pub use self::request::{Cell, InformationMap, Request, Window};

use self::blocks::{Plan, run};
use self::parts::Part;
use crate::cube::{Cube, CubeRef, Shape};
use crate::error::Result;
use std::ops::Range;

/// J of every window whose centre lies in the rows asked for.
///
/// # Errors
/// A window or derivative that does not fit into the image; noise that does not fit the cube; a count that is negative, infinite or
/// beyond 1e27; a variance that is so, or NaN beside a count that is not; a count below 1e-27 without electronic noise; a cube that cannot be read.
pub fn information<'c>(cube: impl Into<CubeRef<'c>>, request: &Request<'_>) -> Result<InformationMap> {
    let cube = cube.into();
    let plan = Plan::new(cube.shape(), request)?;
    whole(cube, &plan, plan.block_rows())
}

/// The same for images that are larger than memory: `take` is given maps of some rows each, in any order and by several threads.
/// They are the same whatever the number of threads, but for where one ends and the next begins.
///
/// # Errors
/// Those of [`information`], and those of `take`.
///
/// ```
/// use hadar::cube::{MemoryCube, Shape};
/// use hadar::ranging::derivative::Derivative;
/// use hadar::ranging::information::{Cell, Request, Window, information_by_rows};
/// use hadar::ranging::noise::{Joined, NoiseVariance};
/// use std::sync::atomic::{AtomicUsize, Ordering};
/// let cube = MemoryCube::new(Shape::new(90, 20, 2)?, (0..3600).map(|i| 100.0 + f64::from(i % 7)).collect())?.into();
/// let request = Request {
///     window: Window::new(5, 5)?,
///     derivative: Derivative::Central,
///     noise: &NoiseVariance::None,
///     joined: Joined::SumOfReadings,
///     cells: &[Cell::Full],
///     centres: 0..90,
/// };
/// let rows = AtomicUsize::new(0);
/// information_by_rows(&cube, &request, &|map| {
///     rows.fetch_add(map.rows.len(), Ordering::Relaxed);
///     Ok(())
/// })?;
/// assert_eq!(rows.into_inner(), 90 - 4);
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn information_by_rows(
    cube: &Cube,
    request: &Request<'_>,
    take: &(dyn Fn(&InformationMap) -> Result<()> + Sync),
) -> Result<()> {
    let plan = Plan::new(cube.shape(), request)?;
    let (height, end) = (plan.block_rows(), plan.tops.end);
    let parts = plan.tops.clone().step_by(height).map(|start| plan.part(start..end.min(start + height)));
    run(parts.collect(), |plan, (room, map): &mut (Room, InformationMap)| {
        room.make(cube.into(), &plan, &mut Part::all(map, &plan))?;
        take(map)
    })
}

/// Rows and columns of the centres of all windows of a request in a cube of this shape.
///
/// # Errors
/// A window or derivative that does not fit into the image; noise that does not fit the cube.
pub fn centres(shape: Shape, request: &Request<'_>) -> Result<[Range<usize>; 2]> {
    let (plan, half) = (Plan::new(shape, request)?, request.window.half_rows());
    Ok([plan.tops.start + half..plan.tops.end + half, plan.centres()])
}

/// The map in blocks of so many rows.
fn whole(cube: CubeRef<'_>, plan: &Plan<'_>, block_rows: usize) -> Result<InformationMap> {
    let mut map = InformationMap::default();
    let mut all = Part::all(&mut map, plan);
    run(all.cut(block_rows), |mut part, room: &mut Room| {
        room.make(cube, &plan.part(part.tops.clone()), &mut part)
    })?;
    Ok(map)
}

/// What a thread keeps from part to part.
#[derive(Default)]
struct Room {
    samples: samples::Room,
    sums: samples::BandSums,
    pixels: pixels::Room,
}

impl Room {
    /// All windows of a plan.
    fn make(&mut self, cube: CubeRef<'_>, plan: &Plan<'_>, to: &mut Part<'_>) -> Result<()> {
        samples::band_sums(cube, plan, &mut self.samples, &mut self.sums, to.spectral)?;
        pixels::windows(plan, &self.sums, to, &mut self.pixels)?;
        to.finite()
    }
}
