//! The camera: from radiance to counts, and the noise beside them.
//!
//! * étendue of a pixel π A_p/(4F² + (f/z)²) (S7), A_p pixel area (m²), F f-number, f focal length (m),
//!   z distance (m);
//! * counts of band w: N_w = S_w × étendue × optics efficiency × quantum efficiency × exposure × frames, where a
//!   pixel that the target does not fill counts its share ([`View`]); efficiencies that depend on wavenumber
//!   ([`EfficiencyCurve`]) are in the weights of the bands;
//! * everything else that adds variance, as a budget of labelled lines ([`budget`]), the electronic noise of a
//!   band reading among them ([`noise`]);
//! * γ = Σσ²_w/ΣN_w, the noise of a reading over the photons of that band (the paper's γ per band);
//! * H = t A_p/((1 + γ)F²), the hardware figure of the paper's policy inequality, m² s.
//!
//! Assumptions: every band is read with the same exposure; linear response; photon bunching neglected
//! (occupancy per mode ≪ 1) unless it is asked for. Averaged frames add photons, Johnson noise and (fully
//! correlated) flicker noise as one longer exposure does; read noise and quantisation come with every frame; what pixels, rows
//! and columns have in common is in [`pattern`].
//!
//! What may be stated of a camera is one table ([`figures`]), from which [`presets`] and scenarios are read; [`Camera`] is
//! what it takes to count.
//!
//! Source: paper S7–S16, Tables S1 and S2, Methods 'Guiding public policy'.

mod assumed;
pub mod budget;
pub mod bunching;
mod camera;
#[cfg(feature = "library")]
pub mod catalogue;
mod checked;
pub mod comparison;
mod counting;
pub mod efficiency;
pub mod equivalents;
pub mod figures;
mod made;
pub mod noise;
pub mod pattern;
pub mod presets;
mod price;
mod readout;
pub mod view;

pub use assumed::{Assumed, PAPER_RANGE_CM1};
pub use budget::NoiseLine;
pub use camera::{Camera, Figures, gamma_per_band};
pub use comparison::Comparison;
pub use counting::Counting;
pub use efficiency::EfficiencyCurve;
pub use equivalents::Equivalents;
pub use figures::{CameraSpec, Efficiency, FASTEST_F_NUMBER};
pub use made::REFERENCE_K;
pub use noise::NoiseSpec;
pub use pattern::{Pattern, PatternFigures};
pub use presets::NoiseCamera;
pub use price::Price;
pub use readout::Readout;
pub use view::{Extent, Light, View};
