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
//! Assumptions: no atmosphere, thin-lens blur or vignetting; the ground is lit by the sky alone when it lights others (no shadows in
//! what it sends); a ball or a limb lights others as an outline of eight corners or two such.
//!
//! Source: paper S1–S4, Fig. 4, Methods 'Monte Carlo path tracing' (there: path tracing, ray depth 8).

mod body;
mod factor;
mod light_map;
mod lighting;
mod noise;
mod outline;
mod radiosity;
mod rig;
mod scene;
mod shape;
mod street;
mod surface;
mod trace;
mod uneven;
mod vector;
mod view;
mod wall;

pub use body::{Body, MOST_SURFACES, Object};
pub use rig::Rig;
pub use scene::Scene;
pub use street::StreetSpec;
pub use surface::{Bump, Emissivity, Road, Surface, Texture, Wave};
pub use trace::{Options, StereoPair};
pub use uneven::Uneven;
pub use view::{Part, View};
pub use wall::WallSpec;
