//! Spectral axes: where a spectrum is sampled, and how samples make bands.
//!
//! The signal of band q is a weighted sum over nodes, S_q = Σ_j w_qj S(ν_j), with ν in cm⁻¹ and w in
//! cm⁻¹ times transmittance. One code path covers every case:
//!
//! * the paper's band-centre sum: one node per band, w = Δν (Methods, 'HADAR estimation theory');
//! * a filter: the rows of its curve, w = T_q(ν_j)·Δν_j (S8 without back reflection);
//! * `bands.integrate = true`: Gauss–Legendre nodes between breakpoints ([`Bands::integrated`]).
//!
//! Bands are kept in ascending wavenumber whatever the order of the input rows.

mod bands;
mod filter;
mod integrate;
mod read;

pub use bands::{Band, Bands};
pub use filter::FilterCurve;
pub use integrate::INTEGRATION_TOLERANCE;

/// The value at x on straight lines between rows of ascending x; beyond them that of the last one.
pub(crate) fn interpolated(xs: &[f64], ys: &[f64], x: f64) -> f64 {
    let right = xs.partition_point(|&row| row < x);
    match (xs.get(right), ys.get(right)) {
        (Some(&row), Some(&value)) if row == x || right == 0 => value,
        (Some(&high), Some(&value_high)) => {
            let (low, value_low) = (xs[right - 1], ys[right - 1]);
            value_low + (value_high - value_low) * ((x - low) / (high - low))
        }
        _ => ys.last().copied().unwrap_or(0.0),
    }
}
