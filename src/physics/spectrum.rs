//! Spectral axes: where a spectrum is sampled, and how samples make bands.
//!
//! The signal of band q is a weighted sum over nodes, S_q = Σ_j w_qj S(ν_j), with ν in cm⁻¹ and w in
//! cm⁻¹ times transmittance. One code path covers every case:
//!
//! * the paper's band-centre sum: one node per band, w = Δν (Methods, 'HADAR estimation theory');
//! * a filter: w = T_q(ν_j)·Δν_j (S8 without back reflection);
//! * integrals: Gauss–Legendre nodes between breakpoints ([`Bands::integrated_where`]), for filters, ranges, and bands within which
//!   a spectrum has rows of its own.
//!
//! Bands are kept in ascending wavenumber whatever the order of the input rows.

mod bands;
mod filter;
mod integrate;
mod rows;

pub(crate) use bands::OPAQUE;
pub use bands::{Band, Bands};
pub use filter::FilterCurve;
pub use integrate::{INTEGRATION_TOLERANCE, Integrated};
pub(crate) use rows::same;
pub use rows::{Gaps, interpolated};
