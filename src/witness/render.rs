//! Renders stereo pairs of heat cubes from a scene of opaque, Lambertian surfaces.
//!
//! S_α(ν) = e_α(ν) B(ν, T_α) + [1 − e_α(ν)] Σ_k V_αk S_k(ν),   Σ_k V_αk = 1
//!
//! for a surface point α with emissivity e, temperature T (K), and thermal lighting factors V of the surfaces k that
//! light it. S and B are photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹.
//!
//! * The final scattering is a gather at every surface point with its own position and normal: a hemisphere of
//!   sky (1 + n_y)/2 and ground (1 − n_y)/2, from which boxes and persons take the share they cover (`factor`).
//! * All scattering before it is between whole surfaces, with factors averaged over each (`radiosity`): S_k is the
//!   mean radiance that leaves surface k after `bounces` − 1 scatterings.
//! * A pixel is the mean of a regular grid of rays over its area (`trace`). All of them add to a few coefficients,
//!   so that a band costs one short sum per pixel, made when it is asked for ([`View::cube`]).
//!
//! World axes: x to the right (along the baseline), y up from the ground, z ahead; metres. Nothing is random:
//! a surface point looks the same to both cameras, and every run gives the same bits.
//!
//! Where solids hide each other their shares are added: on the street's road the lighting that is not sky comes out too
//! large by a tenth (median) and, close behind the car, by up to 1.9 times, against rays through the same solids.
//!
//! Assumptions: no atmosphere, thin-lens blur or vignetting; each surface has one temperature; a solid is seen
//! whole by what it lights, so where solids hide each other or their shadows fall on the ground as a lit surface,
//! factors are approximate; a person lights others as an upright screen of the same silhouette.
//!
//! Source: paper S1–S4, Fig. 4, Methods 'Monte Carlo path tracing' (there: path tracing, ray depth 8).

mod factor;
mod light_map;
mod lighting;
mod noise;
mod radiosity;
mod rig;
mod scene;
mod shape;
mod street;
mod surface;
mod trace;
mod vector;
mod view;
mod wall;

pub use rig::Rig;
pub use scene::Scene;
pub use street::StreetSpec;
pub use surface::{Bump, Emissivity, Road, Surface, Texture, Wave};
pub use trace::{Options, StereoPair};
pub use view::{Part, View};
pub use wall::WallSpec;
