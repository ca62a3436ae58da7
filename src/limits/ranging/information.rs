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
mod pixels;
mod request;
mod rows;
mod samples;
mod strips;
#[cfg(test)]
mod tests;

pub use self::request::{Cell, InformationMap, Request, Window};

use crate::cube::CubeRef;
use crate::error::Result;

/// J of every window whose centre lies in the rows asked for.
///
/// # Errors
/// A window or derivative that does not fit into the image; noise that does not fit the cube; a count or variance that is
/// negative, NaN, infinite or beyond 1e27; a count below 1e-27 without electronic noise; a cube that cannot be read.
pub fn information<'c>(cube: impl Into<CubeRef<'c>>, request: &Request<'_>) -> Result<InformationMap> {
    let cube = cube.into();
    let plan = blocks::Plan::new(cube.shape(), request)?;
    let sums = samples::band_sums(cube, &plan, plan.block_rows())?;
    let mut map = pixels::windows(&plan, &sums)?;
    let [_, _, spectral, _] = &mut map.information;
    *spectral = sums.spectral;
    pixels::finite(map)
}
