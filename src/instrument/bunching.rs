//! Photon bunching: how the counts of thermal light scatter more than those of independent photons.
//!
//! * P(n) = Γ(n+m)/(n! Γ(m)) · (N/m)ⁿ/(1 + N/m)ⁿ⁺ᵐ: N mean counts in m modes, m > 0 (S12; m = 1 is S11);
//! * variance N(1 + N/m), Fisher information of the mean exactly its inverse (one parameter of an exponential family);
//! * m → ∞ is Poisson (S13). Total variation distance from it at most (1 − e⁻ᴺ)N/m, and near 0.242 N/m where
//!   N ≫ 1 ≫ N/m;
//! * m = 2cν²·Δν·E·t modes, both polarisations, of wavenumber ν and width Δν (cm⁻¹), étendue E (m² sr), time t (s);
//! * N/m = η × photons per mode, η efficiency of optics and detector. Photons lost at random leave m as it is and take
//!   their share off N alone, so that losses make light more Poissonian;
//! * modes that are not filled alike have the variance of M = (ΣN)²/Σ(N²/m) equal ones, M ≤ Σm.
//!
//! The noise of a blackbody's light is thus raised by 1 + η·occupancy: 1.034 at 715 cm⁻¹ and 300 K, 1.0025 at
//! 1250 cm⁻¹. The λ of S7 is no such occupancy: it is the photons of a pixel in a coherence time, in all the E ν²
//! modes of its étendue together, and 1 + λ is many times too large.
//!
//! ln P is formed without a difference of ln Γ (Loader): with u = m(N − n)/(n(N + m)), v = (n − N)/(N + m),
//! λ(x) = x − ln(1 + x) ≥ 0 and Stirling's error s(x) = ln Γ(x) − (x − ½)ln x + x − ½ln 2π,
//! ln P = −nλ(u) − mλ(v) − ½ln(1 + n/m) − ½ln(2πn) + s(n+m) − s(m) − s(n), in which nothing large cancels.
//!
//! Assumptions: light of many independent emitters, flat over a band; m ≥ 1, a coherence area and a coherence time
//! at least (the law itself holds for any m > 0); no dead time.
//!
//! Sources: paper S11–S13; Mandel and Wolf, 'Optical Coherence and Quantum Optics' (1995), section 14.9; Loader, 'Fast
//! and accurate computation of binomial probabilities' (2000); bound: Barbour, Holst and Janson, 'Poisson
//! Approximation' (1992), theorem 1.C.

use crate::error::{Error, Result, check};
use crate::planck;
use crate::sum::Compensated;

/// Probabilities below this are not added.
const NOTHING: f64 = 1e-22;
/// Most counts that are added.
const MOST_COUNTS: f64 = 2e6;

/// Modes m of a band, both polarisations: wavenumber and width in cm⁻¹, étendue in m² sr, time in s.
///
/// ```
/// use hadar::instrument::bunching::modes;
/// // One spatial mode (étendue λ²) for one coherence time (1/cΔν) has its two polarisations.
/// let (etendue, coherence_s) = (1e-10, 1.0 / 299_792_458e2);
/// assert!((modes(1000.0, 1.0, etendue, coherence_s) - 2.0).abs() < 1e-12);
/// ```
#[must_use]
pub fn modes(wavenumber_cm1: f64, width_cm1: f64, etendue_m2_sr: f64, time_s: f64) -> f64 {
    planck::mode_density(wavenumber_cm1) * width_cm1 * etendue_m2_sr * time_s
}

/// Counts per mode N/m of a photon radiance (photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹) at ν (cm⁻¹): radiance/2cν² × efficiency.
#[must_use]
pub fn counts_per_mode(wavenumber_cm1: f64, photon_radiance: f64, efficiency: f64) -> f64 {
    photon_radiance / planck::mode_density(wavenumber_cm1) * efficiency
}

/// The number M = (ΣN)²/Σ(N²/m) of equally filled modes whose counts vary as much as those of all `parts`, each its
/// mean N and its modes m. `None` without light.
#[must_use]
pub fn effective_modes(parts: &[(f64, f64)]) -> Option<f64> {
    let (mut mean, mut excess) = (Compensated::default(), Compensated::default());
    for &(part, modes) in parts {
        mean.add(part);
        excess.add(part * (part / modes));
    }
    let mean = mean.value();
    (mean > 0.0).then(|| mean * (mean / excess.value()))
}

/// Counts of mean N in m modes.
///
/// ```
/// use hadar::instrument::bunching::Bunched;
/// let thermal = Bunched::new(50.0, 1000.0)?;
/// assert_eq!(thermal.variance(), 52.5);
/// assert!((1.0 / thermal.fisher_information() - 52.5).abs() < 1e-12);
/// assert!(thermal.distance_from_poisson()? < thermal.largest_distance_from_poisson());
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bunched {
    mean: f64,
    modes: f64,
}

impl Bunched {
    /// N above 0, m above 0; m may be infinite, which is Poisson.
    ///
    /// # Errors
    /// A mean that is not above 0 or not finite, modes that are not above 0, more counts per mode than a double holds.
    pub fn new(mean: f64, modes: f64) -> Result<Self> {
        check::positive("mean counts", mean, "counts")?;
        if modes != f64::INFINITY {
            check::positive("modes", modes, "")?;
            check::finite("counts per mode", mean / modes, "")?;
        }
        Ok(Self { mean, modes })
    }

    /// Mean N.
    #[must_use]
    pub const fn mean(&self) -> f64 {
        self.mean
    }

    /// Number of modes m.
    #[must_use]
    pub const fn modes(&self) -> f64 {
        self.modes
    }

    /// 1 + N/m, by which the variance exceeds that of independent photons.
    #[must_use]
    pub fn factor(&self) -> f64 {
        1.0 + self.mean / self.modes
    }

    /// N(1 + N/m), counts².
    #[must_use]
    pub fn variance(&self) -> f64 {
        self.mean * self.factor()
    }

    /// Fisher information of a reading about N, counts⁻²: 1/[N(1 + N/m)] exactly, m known.
    #[must_use]
    pub fn fisher_information(&self) -> f64 {
        1.0 / self.variance()
    }

    /// ln P(n) for a whole `count` n ≥ 0 (as a double, for counts beyond 2⁶⁴), to about 1e-14 of it.
    ///
    /// # Errors
    /// A count that is negative or not whole.
    pub fn ln_probability(&self, count: f64) -> Result<f64> {
        check::non_negative("count", count, "")?;
        if count != count.trunc() {
            return Err(Error::out_of_range("count", count, "", "a whole number"));
        }
        Ok(self.ln_of(count))
    }

    /// P(n); see [`Bunched::ln_probability`].
    ///
    /// # Errors
    /// As [`Bunched::ln_probability`].
    pub fn probability(&self, count: f64) -> Result<f64> {
        self.ln_probability(count).map(f64::exp)
    }

    /// ½Σ|P(n) − Poisson(n)|, summed over all counts that matter, to about 1e-11 of it.
    ///
    /// # Errors
    /// More counts than can be summed: a deviation above some 3·10⁴. There the bound is of use
    /// ([`Bunched::largest_distance_from_poisson`]).
    pub fn distance_from_poisson(&self) -> Result<f64> {
        // The tail falls as e^(−n/(1 + N/m)), that of a Gaussian before it.
        let width = 12.0 * self.variance().sqrt() + 60.0 * self.factor();
        if 2.0 * width > MOST_COUNTS {
            let expected = "fewer: the sum over all counts is too long, use the bound";
            return Err(Error::out_of_range("mean counts", self.mean, "counts", expected));
        }
        let poisson = Self { modes: f64::INFINITY, ..*self };
        let mut total = Compensated::default();
        // Whether there was anything to add.
        let mut add = |count: f64| {
            let (ln_p, ln_q) = (self.ln_of(count), poisson.ln_of(count));
            // Neighbouring laws from their ratio, which is known to all its digits.
            let difference = if (ln_p - ln_q).abs() < 1.0 {
                ln_q.exp() * self.ln_over_poisson(count).exp_m1()
            } else {
                ln_p.exp() - ln_q.exp()
            };
            total.add(0.5 * difference.abs());
            ln_p.max(ln_q) > NOTHING.ln()
        };
        let middle = self.mean.floor();
        let mut count = middle;
        while add(count) {
            count += 1.0;
        }
        count = middle - 1.0;
        // Below, P of few modes rises again towards 0 counts.
        while count >= 0.0 && (add(count) || self.modes < 1.0) {
            count -= 1.0;
        }
        Ok(total.value())
    }

    /// The bound min(1, (1 − e⁻ᴺ)N/m) of that distance.
    #[must_use]
    pub fn largest_distance_from_poisson(&self) -> f64 {
        (-(-self.mean).exp_m1() * (self.mean / self.modes)).min(1.0)
    }

    fn ln_of(&self, n: f64) -> f64 {
        let Self { mean, modes: m } = *self;
        let bunched = m.is_finite();
        if n == 0.0 {
            return if bunched { -m * (mean / m).ln_1p() } else { -mean };
        }
        let off = n - mean;
        // (n + m)/(N + m), and its distance v from 1; m(N − n)/(n(N + m)).
        let (ratio, v) = if bunched { ((n + m) / (mean + m), off / (mean + m)) } else { (1.0, 0.0) };
        let share = if bunched { 1.0 / (1.0 + mean / m) } else { 1.0 };
        let photons = above_log(n, -off / n * share, mean / n * ratio);
        let ln_poissonian = -photons - 0.5 * (std::f64::consts::TAU * n).ln() - stirling_error(n);
        if !bunched {
            return ln_poissonian;
        }
        let stirling = stirling_error(n + m) - stirling_error(m);
        ln_poissonian - above_log(m, v, ratio) - 0.5 * (n / m).ln_1p() + stirling
    }

    /// ln P(n) − ln Poisson(n), where that is small: (n + m)ln[(n + m)/(N + m)] − (n − N) − ½ln(1 + n/m) + …
    fn ln_over_poisson(&self, n: f64) -> f64 {
        let Self { mean, modes: m } = *self;
        if !m.is_finite() {
            return 0.0;
        }
        if n == 0.0 {
            let x = mean / m;
            return above_log(m, x, 1.0 + x);
        }
        // x ln(x/y) + y − x = xλ(y/x − 1), x = n + m, y = N + m.
        let deviance = above_log(n + m, (mean - n) / (n + m), (mean + m) / (n + m));
        deviance - 0.5 * (n / m).ln_1p() + (stirling_error(n + m) - stirling_error(m))
    }
}

/// kλ(x), λ(x) = x − ln(1 + x), given k, x and 1 + x. k may be so large that x² underflows where kx² does not.
fn above_log(k: f64, x: f64, one_more: f64) -> f64 {
    if x.abs() > 0.15 {
        return k * (x - one_more.ln());
    }
    // x²/2 − x³/3 + …: at 0.15 what follows the 20th power is below 1e-17 of the whole.
    let series = (2..=20).rev().fold(0.0, |sum, power| 1.0 / f64::from(power) - x * sum);
    k * x * (x * series)
}

/// s(x) = ln Γ(x) − (x − ½)ln x + x − ½ln 2π: Stirling's series from 10 on, below that by
/// s(x) − s(x + 1) = (x + ½)ln(1 + 1/x) − 1.
fn stirling_error(x: f64) -> f64 {
    let (mut at, mut below) = (x, 0.0);
    while at < 10.0 {
        below += (at + 0.5) * (1.0 / at).ln_1p() - 1.0;
        at += 1.0;
    }
    let square = 1.0 / (at * at);
    // B₂ₖ/(2k(2k − 1)); the next term is below 1e-16 at 10.
    let series = [
        -3617.0 / 122_400.0,
        1.0 / 156.0,
        -691.0 / 360_360.0,
        1.0 / 1188.0,
        -1.0 / 1680.0,
        1.0 / 1260.0,
        -1.0 / 360.0,
        1.0 / 12.0,
    ]
    .into_iter()
    .fold(0.0, |sum, coefficient| sum * square + coefficient);
    below + series / at
}

#[cfg(test)]
mod tests;
