//! Class errors as integrals along Re z = s, 0 < s < 1.
//!
//! α = P_p(Λ > 0) = (e^{−C}/2π)∫φ dτ/(s + iτ), β = P_q(Λ < 0) = (e^{−C}/2π)∫φ dτ/(1 − s − iτ), ties split by
//! themselves; α + β has the kernel 1/z(1 − z). With τ = r sinh u, r the distance of the nearer pole, the integrand
//! is analytic for |Im u| < π/2 and falls exponentially, so the trapezoidal rule converges exponentially whether
//! Λ scatters by 10⁻⁹ or by 10⁴. Counts make φ almost periodic: where all steps of Λ come into phase again it revives.
//! What lies beyond the first lobe is looked at, and estimated from the mean of |φ| over all τ.
//!
//! Sources: Helstrom, IEEE Trans. Aerosp. Electron. Syst. 14, 630 (1978) for the contour through the saddle point of
//! the whole integrand; Trefethen and Weideman, SIAM Rev. 56, 385 (2014), doi:10.1137/130932132 for the rule.

use super::effort::Effort;
use super::integrals::Integrals;
use super::line::{Line, Mode};
use std::f64::consts::PI;

/// |integrand| that no longer counts, against the largest.
const NOTHING: f64 = 1e-18;
/// Points that must be that small one after another.
const IN_A_ROW: usize = 12;
/// Most points on the way outwards, and of the finest rule.
const OUTWARDS: usize = 1 << 12;
const POINTS: usize = 1 << 15;
/// Bands that are counted as so many when points are.
const FEW_BANDS: usize = 100;
/// Bands of which whole turns are looked at.
const TURNED: usize = 16;

/// One point of the rule on the straight line: the two integrands and the modulus of their sum's.
fn straight(line: &Line, radius: f64, u: f64) -> [f64; 3] {
    crate::stop::check();
    let tau = radius * u.sinh();
    let (ln_modulus, late) = line.ln_phi(tau);
    let modulus = ln_modulus.exp() * radius * u.cosh() / PI;
    let (sine, cosine) = (tau * line.moments.slope + late).sin_cos();
    let (s, t) = (line.s, line.t);
    // 1/(s + iτ) and 1/(t − iτ), the parts that are left of φ/z.
    let (to_0, to_1) = (s.hypot(tau), t.hypot(tau));
    let first = (s * cosine + tau * sine) / to_0 / to_0;
    let second = (t * cosine - tau * sine) / to_1 / to_1;
    [modulus * first, modulus * second, modulus / to_0 / to_1]
}

/// The same on z = s + r[lean(cosh u − 1)/2 + i(√3/2) sinh u], for normal counts: their φ falls like a power of τ with
/// a phase of e^{iτΛ} at the end of Λ, which a line that leans the right way turns into an exponential.
fn leaning(line: &Line, radius: f64, lean: f64, u: f64) -> [f64; 3] {
    crate::stop::check();
    let (width, height) = (0.5 * lean * radius, 0.75_f64.sqrt() * radius);
    let zeta = (2.0 * width * (0.5 * u).sinh().powi(2), height * u.sinh());
    let along = (width * u.sinh(), height * u.cosh());
    let start = (zeta.0 * line.moments.slope, zeta.1 * line.moments.slope);
    let (re, im) = line
        .modes
        .iter()
        .filter_map(|mode| mode.normal(zeta))
        .fold(start, |sum, (term, _)| (sum.0 + term.0, sum.1 + term.1));
    // (1/2πi)∫F dz, F real on the real axis: the imaginary part of F dz/du over π.
    let turned = im + along.1.atan2(along.0);
    let modulus = re.exp() * along.0.hypot(along.1) / PI;
    let (sine, cosine) = turned.sin_cos();
    let (x, y, to_1) = (line.s + zeta.0, zeta.1, line.t - zeta.0);
    let (norm_0, norm_1) = (x.hypot(y), to_1.hypot(y));
    let first = (sine * x - cosine * y) / norm_0 / norm_0;
    let second = (sine * to_1 + cosine * y) / norm_1 / norm_1;
    [modulus * first, modulus * second, modulus / norm_0 / norm_1]
}

/// Both integrals, or nothing if the rule does not settle.
pub(super) fn integrate(line: &Line, effort: Effort) -> Option<Integrals> {
    let radius = line.s.min(line.t);
    rule(line, radius, effort, |u| straight(line, radius, u)).or_else(|| {
        let ends: Option<Vec<f64>> =
            line.modes.iter().map(|mode| mode.normal((0.0, 0.0)).map(|(_, end)| end)).collect();
        let end = line.moments.slope + ends?.iter().sum::<f64>();
        rule(line, radius, effort, |u| leaning(line, radius, -end.signum(), u))
    })
}

/// The trapezoidal rule in u, halved until it settles.
fn rule(line: &Line, radius: f64, effort: Effort, at: impl Fn(f64) -> [f64; 3]) -> Option<Integrals> {
    let most = POINTS.min(effort.points / line.modes.len().max(FEW_BANDS));
    let spread = line.moments.variance.sqrt();
    let mut step = (0.4 * (1.0 / (spread * radius)).asinh()).min(0.2);
    if !(step > 0.0 && spread > 0.0) {
        return None;
    }
    // Outwards until nothing is left; the first lobe only falls.
    let mut values = Vec::new();
    let (mut largest, mut quiet) = (0.0_f64, 0);
    while quiet < IN_A_ROW && values.len() < OUTWARDS.min(most) {
        let value = at(values.len() as f64 * step);
        largest = largest.max(value[2]);
        let class = value[0].abs().max(value[1].abs());
        quiet = if class.max(value[2]) <= NOTHING * largest { quiet + 1 } else { 0 };
        values.push(value);
    }
    if quiet < IN_A_ROW {
        return None;
    }
    let end = values.len();
    let mut sums = [0.0; 2];
    for (k, value) in values.iter().enumerate() {
        let weight = if k == 0 { 0.5 } else { 1.0 };
        sums.iter_mut().zip(value).for_each(|(sum, value)| *sum += weight * value);
    }
    let (mut count, mut old) = (end, sums.map(|sum| sum * step));
    let mut before = f64::INFINITY;
    let (found, left) = loop {
        for k in 0..count {
            let value = at((k as f64 + 0.5) * step);
            sums.iter_mut().zip(&value).for_each(|(sum, value)| *sum += value);
        }
        (count, step) = (2 * count, 0.5 * step);
        let new = sums.map(|sum| sum * step);
        let change = (new[0] - old[0]).abs().max((new[1] - old[1]).abs());
        if change <= 1e-12 * (new[0] + new[1]).abs() {
            // Changes fall at least as fast as the last one did.
            break (new, change * (change / before).min(1.0));
        }
        if count > most {
            return None;
        }
        (old, before) = (new, change);
    };
    let total = found[0] + found[1];
    let rounding = f64::EPSILON * (4.0 + 0.1 * line.moments.exponent.abs());
    let settled = left + rounding * total;
    // Where the outward walk of the first step ended.
    let (revival, revival_class) = beyond(line, radius, count as f64 * step);
    Some(Integrals {
        first: found[0],
        second: found[1],
        exponent: line.moments.exponent,
        numerical: settled + revival,
        numerical_class: settled + revival_class,
    })
}

/// What revivals beyond `start` may add to the sum and to either integral.
fn beyond(line: &Line, radius: f64, start: f64) -> (f64, f64) {
    crate::stop::check();
    let (largest_step, mean) = line.graininess();
    if largest_step == 0.0 {
        return (0.0, 0.0);
    }
    // Steps cannot come into phase again before the largest of them has turned once.
    let turn = (radius * start.sinh()).max(PI / largest_step);
    let (mut seen, mut seen_class) = (0.0_f64, 0.0_f64);
    let (points, span) = (256, 16.0);
    for k in 0..points {
        // Not in step with any period.
        let u = start + span * (f64::from(k) + 0.5) / f64::from(points);
        let [first, second, sum] = straight(line, radius, u);
        seen += sum;
        seen_class += first.abs().max(second.abs());
    }
    let width = span / f64::from(points);
    (seen, seen_class) = (seen * width, seen_class * width);
    // Whole turns of one band, in case the others' steps are multiples or parts of its own.
    let lobe = (2.0 / PI).sqrt() / line.moments.variance.sqrt();
    for step in line.modes.iter().filter_map(Mode::counted).map(|(step, _)| step.abs()).take(TURNED) {
        for turns in 1..=3 {
            let tau = 2.0 * PI * f64::from(turns) / step;
            let revived = line.ln_phi(tau).0.exp() * lobe / tau;
            seen += revived / tau;
            seen_class += revived;
        }
    }
    (mean / (PI * turn) + seen, 0.5 * mean + seen_class)
}
