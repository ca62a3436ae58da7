//! Emissivity of smooth surfaces seen at normal incidence, by Kirchhoff's law e = 1 − R − T.
//!
//! With the complex refractive index m = n + ik of the medium beside air, ν in cm⁻¹, thickness d in µm:
//!
//! - half-space: e = 1 − |(m − 1)/(m + 1)|² = 4n/((n + 1)² + k²), the last form without cancellation,
//!   since the emissivity of a metal is a small difference 1 − R;
//! - coherent film on a thick substrate: r = (r₀₁ + r₁₂β)/(1 + r₀₁r₁₂β), β = exp(4πi m ν d), e = 1 − |r|²;
//! - free-standing slab, all reflections added as powers: with E the half-space value and
//!   t = exp(−4πkνd), e = E(1 − t)/((1 − t) + Et).
//!
//! Assumptions: smooth, homogeneous, isothermal; the half-space and the substrate are opaque.
//! Source: Born and Wolf, Principles of Optics, 7th ed., sections 1.5, 1.6 and 14.4 (textbook optics).

use nalgebra::Complex;
use std::f64::consts::PI;

/// Centimetres in a micrometre.
const CM_PER_UM: f64 = 1e-4;

/// Opaque half-space.
pub(super) fn half_space(index: Complex<f64>) -> f64 {
    let Complex { re: n, im: k } = index;
    4.0 * n / ((n + 1.0) * (n + 1.0) + k * k)
}

/// Film of `thickness_um` on an opaque substrate, with interference.
pub(super) fn film(
    film: Complex<f64>,
    substrate: Complex<f64>,
    thickness_um: f64,
    wavenumber_cm1: f64,
) -> f64 {
    let outer = (1.0 - film) / (1.0 + film);
    let inner = (film - substrate) / (film + substrate);
    let there_and_back =
        (Complex::<f64>::i() * film * (4.0 * PI * wavenumber_cm1 * CM_PER_UM * thickness_um)).exp();
    let reflected = (outer + inner * there_and_back) / (1.0 + outer * inner * there_and_back);
    1.0 - reflected.norm_sqr()
}

/// Free-standing slab of `thickness_um`, without interference.
pub(super) fn slab(index: Complex<f64>, thickness_um: f64, wavenumber_cm1: f64) -> f64 {
    let depth = 4.0 * PI * index.im * wavenumber_cm1 * CM_PER_UM * thickness_um;
    let (absorbed, passed) = (-(-depth).exp_m1(), (-depth).exp());
    let face = half_space(index);
    if absorbed == 0.0 { 0.0 } else { face * absorbed / (absorbed + face * passed) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GLASS: Complex<f64> = Complex::new(1.5, 0.0);
    const METAL: Complex<f64> = Complex::new(10.0, 60.0);
    const OXIDE: Complex<f64> = Complex::new(1.2, 0.5);

    #[test]
    fn closed_forms_of_the_half_space() {
        assert!((half_space(GLASS) - 0.96).abs() < 1e-15);
        assert_eq!(half_space(Complex::new(1.0, 0.0)), 1.0);
        for index in [GLASS, METAL, OXIDE] {
            let reflected = ((index - 1.0) / (index + 1.0)).norm_sqr();
            assert!((half_space(index) - (1.0 - reflected)).abs() < 4e-16, "{index}");
        }
    }

    #[test]
    fn a_film_without_thickness_is_its_substrate_and_a_thick_one_hides_it() {
        assert!((film(OXIDE, METAL, 0.0, 1000.0) / half_space(METAL) - 1.0).abs() < 1e-13);
        assert!((film(OXIDE, METAL, 1e4, 1000.0) / half_space(OXIDE) - 1.0).abs() < 1e-13);
    }

    /// A lossless quarter-wave layer of index √n_s is a perfect antireflection coating.
    #[test]
    fn a_quarter_wave_layer_removes_the_reflection() {
        let (coating, substrate) = (Complex::new(2.0, 0.0), Complex::new(4.0, 0.0));
        let quarter_um = 10.0 / (4.0 * 2.0);
        assert!((film(coating, substrate, quarter_um, 1000.0) - 1.0).abs() < 1e-15);
        assert!((film(coating, substrate, 2.0 * quarter_um, 1000.0) - 0.64).abs() < 1e-14);
    }

    #[test]
    fn a_slab_without_thickness_or_absorption_emits_nothing_and_a_thick_one_is_a_half_space() {
        assert_eq!(slab(OXIDE, 0.0, 1000.0), 0.0);
        assert_eq!(slab(GLASS, 100.0, 1000.0), 0.0);
        assert!((slab(OXIDE, 1e4, 1000.0) / half_space(OXIDE) - 1.0).abs() < 1e-15);
    }

    /// Against the sum over all internal reflections, term by term.
    #[test]
    fn the_slab_is_the_sum_of_its_reflections() {
        let (index, thickness_um, wavenumber) = (Complex::new(3.4, 2e-3), 500.0, 900.0);
        let passed = (-4.0 * PI * 2e-3 * wavenumber * 0.05).exp();
        let face = 1.0 - half_space(index);
        let (mut inside, mut emitted) = (1.0 - face, 0.0);
        for _ in 0..500 {
            emitted += inside * (1.0 - passed);
            inside *= passed * face;
        }
        assert!((slab(index, thickness_um, wavenumber) / emitted - 1.0).abs() < 1e-13);
    }

    /// Hagen and Rubens: a metal at low frequency emits 2√(2/Im ε), to first order.
    #[test]
    fn a_good_conductor_follows_hagen_and_rubens() {
        let permittivity = 1e8f64;
        let index = Complex::new(1.0, 1.0) * (permittivity / 2.0).sqrt();
        let first_order = 2.0 * (2.0 / permittivity).sqrt();
        assert!((half_space(index) / first_order - 1.0).abs() < 2e-4);
    }
}
