//! The characteristic function of Λ = ln(q/p) along the line Re z = s.
//!
//! φ(τ) = E[e^{iτΛ}] under the tilted law p^{1−s}q^s e^{C(s)}, so that E_p[e^{zΛ}] = e^{−C(s)}φ(τ), z = s + iτ.
//! With μ′ the mean of Λ, ln φ = iτμ′ + Σ over the bands of
//!
//! * Poisson, G = N^{1−s}N′^s, θ = τ ln(N′/N): G(e^{iθ} − 1 − iθ);
//! * negative binomial, occupancy x of the tilted law, θ = τλ: −m[ln(1 − x(e^{iθ} − 1)) + ixθ];
//! * Gaussian, y = τ(v′ − v)/u, A = Δ²vv′/u³, u = (1−s)v′ + sv: −½τ²A/(1 − iy) − ½[ln(1 − iy) + iy],
//!
//! which all begin with the square of τ; parts that cancel are left out by hand (derived here; symbols as in
//! `bracket/tilted.rs`).

use super::super::bracket::tilted::{Moments, Tilted, geometric};
use crate::order;

/// ln |φ| of nothing, also beside the widest step of the rules that weigh it (e^40 at most).
const NOTHING: f64 = -120.0;
/// Bands between two looks at whether anything is left.
const AT_A_TIME: usize = 8;

/// One band that scatters.
#[derive(Debug, Clone, Copy)]
pub(super) enum Mode {
    /// Mean counts and step of Λ with each.
    Poisson { mean: f64, step: f64 },
    /// Modes, occupancy of each, step of Λ with each count.
    Bunched { modes: f64, occupancy: f64, step: f64 },
    /// A and (v′ − v)/u.
    Normal { square: f64, tilt: f64 },
}

/// All bands at one s.
#[derive(Debug, Clone)]
pub(super) struct Line {
    pub(super) s: f64,
    /// 1 − s.
    pub(super) t: f64,
    /// C(s), μ′ and μ″.
    pub(super) moments: Moments,
    pub(super) modes: Vec<Mode>,
}

impl Mode {
    fn new(band: &Tilted, s: f64) -> Option<Self> {
        let t = 1.0 - s;
        match *band {
            Tilted::Same | Tilted::Dark { .. } => None,
            Tilted::Poisson { mean, other, log } => {
                Some(Self::Poisson { mean: geometric(mean, other, log, s), step: log })
            }
            Tilted::Gaussian { square, var, other, .. } => {
                let u = t * other + s * var;
                let square = square / u * (var / u) * (other / u);
                Some(Self::Normal { square, tilt: (other - var) / u })
            }
            Tilted::Bunched { modes, a, other, log, log_dark } => {
                let lit = geometric(a, other, log, s);
                let dark = geometric(1.0 + a, 1.0 + other, log_dark, s);
                // G₁ − G₀ ≥ 1; near one it is a difference, which C and μ′ do without.
                Some(Self::Bunched { modes, occupancy: lit / (dark - lit).max(1.0), step: log - log_dark })
            }
        }
    }

    /// Real and imaginary part of ln φ without iτμ′.
    #[inline]
    fn ln_phi(&self, tau: f64) -> (f64, f64) {
        crate::stop::check();
        match *self {
            Self::Poisson { mean, step } => {
                let theta = tau * step;
                let (sine, cosine) = (0.5 * theta).sin_cos();
                (-2.0 * mean * sine * sine, mean * sine_beyond(theta, 2.0 * sine * cosine))
            }
            Self::Bunched { modes, occupancy: x, step } => {
                let theta = tau * step;
                let (sine, cosine) = (0.5 * theta).sin_cos();
                let square = sine * sine;
                let full = 2.0 * sine * cosine;
                let base = 1.0 + 2.0 * x * square;
                let tangent = x * full / base;
                // atan y − xθ, in parts of one sign while θ is small.
                let late = x * (sine_beyond(theta, full) - 2.0 * x * theta * square) / base;
                let modulus = -0.5 * modes * (4.0 * x * (1.0 + x) * square).ln_1p();
                (modulus, modes * (atan_beyond(tangent) + late))
            }
            Self::Normal { square, tilt } => {
                let y = tau * tilt;
                let drop = -0.5 * tau * square * tau / (1.0 + y * y);
                (drop - 0.25 * (y * y).ln_1p(), drop * y + 0.5 * atan_beyond(y))
            }
        }
    }

    /// ln φ of normal counts at ζ = z − s anywhere in the plane, real and imaginary part, without ζμ′; and where
    /// Λ − μ′ of the band ends (its largest or smallest value), if it does.
    pub(super) fn normal(&self, zeta: (f64, f64)) -> Option<((f64, f64), f64)> {
        let Self::Normal { square, tilt } = *self else { return None };
        // 1 − ζ(v′ − v)/u
        let (a, b) = (1.0 - zeta.0 * tilt, -zeta.1 * tilt);
        let norm = a * a + b * b;
        let half = 0.5 * square;
        let (re, im) = (zeta.0 * zeta.0 - zeta.1 * zeta.1, 2.0 * zeta.0 * zeta.1);
        let lean = (half * (re * a + im * b) / norm, half * (im * a - re * b) / norm);
        // |1 − x|² − 1 without the 1.
        let modulus =
            0.5 * (-2.0 * zeta.0 * tilt + tilt * tilt * (zeta.0 * zeta.0 + zeta.1 * zeta.1)).ln_1p();
        let log = (-0.5 * (modulus + zeta.0 * tilt), -0.5 * (b.atan2(a) + zeta.1 * tilt));
        let end = if tilt == 0.0 { 0.0 } else { -0.5 * (square / tilt + tilt) };
        Some(((lean.0 + log.0, lean.1 + log.1), end))
    }

    /// ln E[e^{θ(Λ − μ′)}] for real θ; infinite beyond what the law allows.
    fn cumulant(&self, theta: f64) -> f64 {
        crate::stop::check();
        let beyond = |x: f64| if x.abs() < 1e-4 { 0.5 * x * x * (1.0 + x / 3.0) } else { x.exp_m1() - x };
        match *self {
            Self::Poisson { mean, step } => mean * beyond(theta * step),
            Self::Bunched { modes, occupancy, step } => {
                let grown = occupancy * (theta * step).exp_m1();
                if grown >= 1.0 {
                    return f64::INFINITY;
                }
                -modes * ((-grown).ln_1p() + occupancy * theta * step)
            }
            Self::Normal { square, tilt } => {
                let y = theta * tilt;
                if y >= 1.0 {
                    return f64::INFINITY;
                }
                0.5 * theta * theta * square / (1.0 - y) - 0.5 * ((-y).ln_1p() + y)
            }
        }
    }

    /// Step of Λ with each count and how many there are; none for a law without counts.
    pub(super) fn counted(&self) -> Option<(f64, f64)> {
        match *self {
            Self::Poisson { mean, step } => Some((step, mean)),
            Self::Bunched { modes, occupancy, step } => Some((step, modes * occupancy)),
            Self::Normal { .. } => None,
        }
    }

    /// About the mean of |φ| over all τ: that of a Poisson law, e^{−G}I₀(G) ≤ 1/√(1 + 2G).
    fn mean_modulus(&self) -> f64 {
        match *self {
            Self::Poisson { mean, .. } => (1.0 + 2.0 * mean).sqrt().recip(),
            Self::Bunched { modes, occupancy: x, .. } => {
                (1.0 + 2.0 * modes * x * (1.0 + x)).powf(-0.5 * modes.min(1.0))
            }
            Self::Normal { .. } => 0.0,
        }
    }
}

impl Line {
    pub(super) fn new(bands: &[Tilted], moments: Moments, s: f64) -> Self {
        let modes = bands.iter().filter_map(|band| Mode::new(band, s)).collect();
        Self { s, t: 1.0 - s, moments, modes }
    }

    /// ln |φ(τ)|, and the phase without τμ′; −∞ where |φ| is nothing, for which a few of many bands are enough: no band makes it larger.
    pub(super) fn ln_phi(&self, tau: f64) -> (f64, f64) {
        let (mut re, mut im) = (0.0, 0.0);
        for modes in self.modes.chunks(AT_A_TIME) {
            for mode in modes {
                let (more_re, more_im) = mode.ln_phi(tau);
                (re, im) = (re + more_re, im + more_im);
            }
            if re < NOTHING {
                return (f64::NEG_INFINITY, 0.0);
            }
        }
        (re, im)
    }

    /// x above (`sign` 1) or below (−1) the mean of Λ, beyond which less than e^{−`ln_mass`} of the law lies.
    pub(super) fn reach(&self, sign: f64, ln_mass: f64) -> f64 {
        let spread = self.moments.variance.sqrt();
        let bound = |k: i32| {
            let theta = f64::powi(2.0, k) * 0.25 / spread;
            let cumulant: f64 = self.modes.iter().map(|mode| mode.cumulant(sign * theta)).sum();
            (ln_mass + cumulant) / theta
        };
        (-6..12).map(bound).filter(|x| x.is_finite()).fold(f64::INFINITY, f64::min)
    }

    /// Largest step of Λ with one count, and the mean of |φ| over all τ if steps of other size are incommensurate.
    pub(super) fn graininess(&self) -> (f64, f64) {
        let mut steps: Vec<(f64, f64)> = self
            .modes
            .iter()
            .filter_map(|mode| mode.counted().map(|(step, _)| (step.abs(), mode.mean_modulus())))
            .collect();
        order::ascending(&mut steps, |a| a.0);
        let largest = steps.last().map_or(0.0, |last| last.0);
        if steps.is_empty() {
            return (0.0, 0.0);
        }
        // Of bands with the same step the darkest peaks are those of the brightest band.
        let (mut mean, mut size, mut group) = (1.0, 0.0, 1.0_f64);
        for (step, modulus) in steps {
            if step > size * (1.0 + 1e-9) {
                mean *= group;
                (size, group) = (step, 1.0);
            }
            group = group.min(modulus);
        }
        (largest, mean * group)
    }

    /// How deep |φ| can sink for want of counts: −ln of its smallest value.
    pub(super) fn depth(&self) -> f64 {
        let depth = |mode: &Mode| match *mode {
            Mode::Poisson { mean, .. } => 2.0 * mean,
            Mode::Bunched { modes, occupancy, .. } => modes * (2.0 * occupancy).ln_1p(),
            Mode::Normal { .. } => f64::INFINITY,
        };
        self.modes.iter().map(depth).sum()
    }
}

/// sin x − x; `sine` is sin x.
fn sine_beyond(x: f64, sine: f64) -> f64 {
    if x.abs() > 0.7 {
        return sine - x;
    }
    let square = x * x;
    let series = (2..=9).rev().fold(1.0, |sum, k| 1.0 - square / f64::from(2 * k * (2 * k + 1)) * sum);
    -x * square / 6.0 * series
}

/// atan x − x.
fn atan_beyond(x: f64) -> f64 {
    if x.abs() > 0.3 {
        return x.atan() - x;
    }
    let square = x * x;
    // −x³/3 + x⁵/5 − …, to x³³.
    let series = (1..=15).rev().fold(0.0, |sum, k| 1.0 / f64::from(2 * k + 1) - square * sum);
    -x * square * series
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identifiability::bracket::KnownStates;
    use crate::statistics::Statistics;

    #[test]
    fn what_is_left_of_sine_and_arc_tangent_meets_its_series() {
        for x in [0.7_f64, 0.69, 0.31] {
            assert!((sine_beyond(x, x.sin()) / (x.sin() - x) - 1.0).abs() < 4e-15, "{x}");
        }
        for x in [0.3_f64, 0.25] {
            assert!((atan_beyond(x) / (x.atan() - x) - 1.0).abs() < 2e-14, "{x}");
        }
    }

    /// Moments of Λ are derivatives of ln φ at 0, and the cumulant is φ at an imaginary place.
    #[test]
    fn variance_and_cumulant_belong_to_the_characteristic_function() {
        let laws = [
            Statistics::Poisson,
            Statistics::gaussian(vec![4.0, 1.0]).unwrap(),
            Statistics::negative_binomial(vec![3.0, 40.0]).unwrap(),
        ];
        for statistics in &laws {
            let states = KnownStates::new(&[10.0, 7.0], &[17.0, 3.0], statistics).unwrap();
            let (s, h) = (0.4, 1e-4);
            let line = Line::new(states.bands(), states.at(s), s);
            let variance = line.moments.variance;
            let (re, _) = line.ln_phi(h);
            assert!((-2.0 * re / (h * h) / variance - 1.0).abs() < 1e-6, "{statistics:?}");
            let cumulant: f64 = line.modes.iter().map(|mode| mode.cumulant(0.3)).sum();
            let exact = line.moments.exponent - states.exponent(s + 0.3) - 0.3 * line.moments.slope;
            assert!((cumulant / exact - 1.0).abs() < 1e-11, "{statistics:?} {cumulant} {exact}");
        }
    }
}
