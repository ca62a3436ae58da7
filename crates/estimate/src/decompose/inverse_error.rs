//! By how much the paper's inverse functions err: the bias of what S46 leaves out, and the noise that differences of neighbouring bands make.
//!
//! To first order, with h_p = (w ΔG B̄′)_p/Σ(w ΔG² B̄′²) the weight of pair p of neighbours in the temperature (K for each unit of ΔF),
//! B̄′ = ∂B̄/∂T and w = 1/var ΔF:
//!
//! * bias: Σ_p h_p (Ḡ ΔB + ΔX)_p, what S46 leaves out. At bands δν apart it is as large as the slopes of B and X along wavenumber times
//!   δν, and so is ΔG: the bias does not vanish with δν, and it grows where bands are wider than the features of e;
//! * variance: Σ_w (h_(w−1) − h_w)² var F_w, neighbouring differences sharing a band;
//! * one pair alone, which is S46 at one wavenumber: 1/(w ΔG² B̄′²)_p. At fixed light var F goes with 1/δν and ΔG with δν, so that it goes with
//!   δν⁻³: this is the noise of differentiation. Of all pairs together it cancels where h is smooth, since Σ h ΔF = −Σ F Δh: the
//!   variance of T then tends to a constant as bands become narrower.
//!
//! Source: S46 as printed; propagation of errors.

use super::inverse::Inverse;
use super::setting::Setting;
use hadar::error::{Error, Result};

/// Errors of a temperature by S46, to first order.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct InverseError {
    /// Without any noise, K.
    pub bias_k: f64,
    /// Deviation by noise, K.
    pub sigma_k: f64,
    /// Deviation of the pair of neighbouring bands that tells the most, alone, K.
    pub pair_sigma_k: f64,
}

/// Errors of S46 for material `m` of the library, known, at a temperature within the range (K) under lighting factors Vₖ of the
/// surroundings; NaN where its emissivity has no slope.
///
/// # Errors
/// A setting that is impossible, a material it does not have, another number of lighting factors than of surroundings.
pub fn inverse_error(
    setting: &Setting<'_>,
    m: usize,
    temperature_k: f64,
    lighting: &[f64],
) -> Result<InverseError> {
    let inverse = Inverse::new(setting)?;
    if m >= setting.library.len() {
        return Err(Error::malformed(format!("material {m} of {}", setting.library.len()), "count from 0"));
    }
    let (found, expected) = (lighting.len(), setting.surroundings.len());
    if found != expected {
        return Err(Error::Length { what: "lighting factors".into(), found, expected });
    }
    let model = &inverse.model;
    let (emitted, _) = model.emitted(m, temperature_k);
    let mut counts = emitted[..model.used.len()].to_vec();
    for (k, v) in lighting.iter().enumerate() {
        let scattered = model.scattered_of(m, 1 + k);
        counts.iter_mut().zip(scattered).for_each(|(n, c)| *n = v.mul_add(*c, *n));
    }
    let differences = inverse.differences(m, &counts);
    let [value, slope] = inverse.blackbody(temperature_k);
    let mean = |of: &[f64], [a, b]: [usize; 2]| 0.5 * (of[a] + of[b]);
    let (mut bias, mut square, mut most) = (0.0, 0.0, 0.0);
    let mut by_band = vec![0.0; counts.len()];
    for (i, pair) in differences.pairs.iter().enumerate() {
        let change = differences.slope[i] * mean(&slope, *pair);
        let h = differences.weight[i] * change;
        bias += h * (differences.signal[i] - differences.slope[i] * mean(&value, *pair));
        square += h * change;
        most = f64::max(most, h * change);
        by_band[pair[0]] -= h;
        by_band[pair[1]] += h;
    }
    let var = by_band.iter().zip(&differences.var).filter(|(h, _)| **h != 0.0).map(|(h, var)| h * h * var);
    let var: f64 = var.sum();
    Ok(InverseError {
        bias_k: bias / square,
        sigma_k: var.sqrt() / square,
        pair_sigma_k: most.sqrt().recip(),
    })
}
