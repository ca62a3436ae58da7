//! Bounds of the probability of a right answer between two spectra that are known, whatever the number of counts.
//!
//! Two equally likely laws p and q of the counts in W bands, of means N and N′. The best test errs with ε = ½Σ min(p, q), and
//! Φ(d), d = ‖√N − √N′‖, is what 1 − ε becomes where counts are many. Here 1 − ε lies between two bounds:
//!
//! * Without reading noise Λ = ln(q/p) is, under the law √(pq)e^C of exponent C, a Poisson sum of events X: N^{½}N′^{½} events of
//!   step ln(N′/N) in every band, clusters of them where light is bunched. With its mean μ and variance v and
//!   L = Σ E|X|³/(Σ E X²)^{3/2} its distribution function is nowhere further from the normal one than 0.3041 L (Berry and Esseen;
//!   the constant of Korolev and Shevtsova for Poisson sums). The error is ε = ½e^{−C}E[e^{−|Λ|/2}], and e^{−|Λ|/2} rises and falls
//!   by 1, so that
//!
//!   |2εe^C − e^{−μ²/2v}[M(x₁) + M(x₂)]| ≤ 2 · 0.3041 L, x₁,₂ = √v/2 ∓ μ/√v, M(x) = Φ(−x)e^{x²/2}.
//!
//!   [`DecisionLaw::Gaussian`]: this interval, extended to Φ(d), leaves the error unknown by less than 1 %. It takes about 1e5
//!   counts in the bands that differ. Over 0.1 to 1e4 counts in each of 1 to 50 bands 1 − Φ(d) was off by 1e-6 of the error at most
//!   wherever this was said (tests).
//! * [`DecisionLaw::Exact`]: else the law itself, where [`super::ratio`] finds it in some milliseconds, with twice its numerical
//!   error, inside the rigorous bounds.
//! * [`DecisionLaw::Bracket`]: else what is left of the interval and the bracket of Bhattacharyya and Kailath.
//!
//! With reading noise of variance σ² the counts are Poisson (or bunched) counts plus normal ones. Where the interval above for Poisson
//! counts of means N + σ² (bunching: + NN′/m), which have the same variance, is that narrow, it is taken, after its distance has been made
//! larger by the share ½σ⁴/V³ (V the variance of a band), twice the information on the mean that normal noise leaves beyond 1/V: not
//! proved, but held against quadrature of the true law (tests). Else the bounds are rigorous: above what the counts tell without
//! reading noise, below the right answers of a linear test, whose statistic is a limit of Poisson sums and obeys the same inequality.
//!
//! Symbols: N, N′ mean counts of the whole exposure, σ² counts², m modes, x = N/m.
//!
//! Sources: Korolev and Shevtsova, Scand. Actuar. J. 2012, 81, doi:10.1080/03461238.2010.485370 (0.3041); the tilted form is derived
//! here; `bracket` and `ratio` name the others.

use super::bracket::KnownStates;
use super::detection;
use super::ratio::RatioLaw;
use crate::error::{Error, Result, check};
use crate::statistics::Statistics;
use libm::erfc;
use std::f64::consts::{FRAC_1_SQRT_2, LN_2, PI};

/// Constant of the inequality of Berry and Esseen for Poisson sums.
const BERRY_ESSEEN: f64 = 0.3041;
/// Share of the error that may be unknown where Φ(d) is taken for the law.
const NEAR: f64 = 0.01;
/// Share of an error that the law found by numbers may be unknown by.
const SETTLED: f64 = 0.01;

/// What two bounds rest on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum DecisionLaw {
    /// Counts are many: Φ(d) lies between the bounds, which leave the error unknown by 1 % at most.
    Gaussian,
    /// The exact law, up to its numerical error.
    Exact,
    /// Rigorous bounds alone.
    Bracket,
}

/// Bounds of the best probability of a right answer.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct DecisionBounds {
    /// Some test is right at least so often.
    pub lower: f64,
    /// No test is right more often.
    pub upper: f64,
    /// 1 − `upper`, to its own digits.
    pub error_lower: f64,
    /// Upper bound of the probability of error, 1 − `lower`.
    pub error_upper: f64,
    /// The law of the counts on which the bounds rest.
    pub law: DecisionLaw,
}

/// Errors from the least to the largest possible.
type Errors = [f64; 2];

/// Bounds of the best probability of a right answer between mean counts `counts` and `alternative_counts`, equally likely, with reading
/// noise of variance `var_reading` (counts²) in every band, and the modes of bunched light where it is bunched. Microseconds where counts
/// are many, else some milliseconds.
///
/// ```
/// use hadar::identifiability::decision::{DecisionLaw, decision_bounds};
/// // 0.2 or 0.6 photons in one band: the brighter one is said whenever there is any.
/// let few = decision_bounds(&[0.2], &[0.6], &[0.0], None)?;
/// let exact = 0.5 * ((-0.2_f64).exp() + 1.0 - (-0.6_f64).exp());
/// assert_eq!(few.law, DecisionLaw::Exact);
/// assert!(few.lower <= exact && exact <= few.upper && few.upper - few.lower < 1e-9);
/// // A million: d = √1.002e6 − √1e6 = 0.99950, Φ(d) = 0.8412.
/// let many = decision_bounds(&[1e6], &[1.002e6], &[0.0], None)?;
/// assert_eq!(many.law, DecisionLaw::Gaussian);
/// assert!(many.lower > 0.840 && many.lower <= 0.8412 && many.upper >= 0.8413 && many.upper < 0.843);
/// # Ok::<(), hadar::Error>(())
/// ```
///
/// # Errors
/// Lengths that differ, counts or variances that are negative or not finite, modes that are not positive.
pub fn decision_bounds(
    counts: &[f64],
    alternative_counts: &[f64],
    var_reading: &[f64],
    modes: Option<&[f64]>,
) -> Result<DecisionBounds> {
    if var_reading.len() != counts.len() {
        let what = "variances of reading noise".into();
        return Err(Error::Length { what, found: var_reading.len(), expected: counts.len() });
    }
    for var in var_reading {
        check::non_negative("variance of reading noise", *var, "counts^2")?;
    }
    let statistics = match modes {
        Some(modes) => Statistics::negative_binomial(modes.to_vec())?,
        None => Statistics::Poisson,
    };
    let silent = RatioLaw::new(counts, alternative_counts, &statistics)?;
    if var_reading.iter().all(|var| *var == 0.0) {
        return Ok(without_reading(&silent));
    }
    let bands = Bands { counts, others: alternative_counts, var_reading, modes };
    if let Some(found) = bands.many()? {
        return Ok(found);
    }
    let [least, _] = errors(without_reading(&silent));
    Ok(bounds([least, bands.linear().max(least)], DecisionLaw::Bracket))
}

const fn errors(bounds: DecisionBounds) -> Errors {
    [bounds.error_lower, bounds.error_upper]
}

fn bounds([least, most]: Errors, law: DecisionLaw) -> DecisionBounds {
    let most = if most.is_nan() { 0.5 } else { most.clamp(0.0, 0.5) };
    let least = if least.is_nan() { 0.0 } else { least.clamp(0.0, most) };
    DecisionBounds { lower: 1.0 - most, upper: 1.0 - least, error_lower: least, error_upper: most, law }
}

fn without_reading(law: &RatioLaw) -> DecisionBounds {
    let close = near_normal(law.states());
    if let Some(many) = close.and_then(|close| taken_for_normal(close, law.states())) {
        return bounds(many, DecisionLaw::Gaussian);
    }
    let close = close.unwrap_or([0.0, 0.5]);
    // Found inside the rigorous bracket, which is wider.
    if let Some(found) = law.quick_error().filter(|found| found.numerical < SETTLED) {
        let numerical = 2.0 * found.numerical + 1e-13 * (10.0 - found.ln_error.max(-1e6));
        let exact = [found.error * (1.0 - numerical), found.error * (1.0 + numerical)];
        return bounds(meet(exact, close), DecisionLaw::Exact);
    }
    let bracket = law.states().bracket();
    // Rounding of the exponents.
    let slack = 1e-13 * (10.0 - bracket.ln_lower.max(-1e6));
    bounds(meet([bracket.lower * (1.0 - slack), bracket.upper * (1.0 + slack)], close), DecisionLaw::Bracket)
}

/// What lies in both; the first where nothing does, which is rounding.
fn meet(a: Errors, b: Errors) -> Errors {
    let both = [a[0].max(b[0]), a[1].min(b[1])];
    if both[0] <= both[1] { both } else { a }
}

/// The interval of Berry and Esseen; nothing where Λ does not scatter, or leans so far that it is of no use.
fn near_normal(states: &KnownStates) -> Option<Errors> {
    let (at, grain) = states.halfway();
    let spread = at.variance.sqrt();
    let (half, lean) = (0.5 * spread, at.slope / spread);
    if !(spread > 0.0 && grain.is_finite() && lean.abs() <= half) {
        return None;
    }
    let center = (-0.5 * lean * lean).exp() * (mills(half - lean) + mills(half + lean));
    let slack = 2.0 * BERRY_ESSEEN * grain;
    let scale = (-LN_2 - at.exponent).exp();
    let rounding = 1e-13 * (10.0 + at.exponent);
    Some([scale * (center * (1.0 - rounding) - slack).max(0.0), scale * (center * (1.0 + rounding) + slack)])
}

/// The interval extended to the error of the normal law, if that leaves the error unknown by no more than 1 %.
fn taken_for_normal([least, most]: Errors, states: &KnownStates) -> Option<Errors> {
    // For Poisson counts the distance itself.
    let miss = detection::miss_probability((2.0 * states.exponent(0.5)).sqrt());
    let both = [least.min(miss), most.max(miss)];
    (both[1] - both[0] <= NEAR * both[1]).then_some(both)
}

/// M(x) = Φ(−x)e^{x²/2} for x ≥ 0.
fn mills(x: f64) -> f64 {
    if x < 20.0 {
        return 0.5 * erfc(x * FRAC_1_SQRT_2) * (0.5 * x * x).exp();
    }
    // The next term is below 105/x⁸ = 4e-9 of it; what it leaves is far below the slack.
    let inverse = 1.0 / (x * x);
    (1.0 - inverse * (1.0 - 3.0 * inverse * (1.0 - 5.0 * inverse))) / (x * (2.0 * PI).sqrt())
}

/// Two spectra that are read with noise.
struct Bands<'a> {
    counts: &'a [f64],
    others: &'a [f64],
    var_reading: &'a [f64],
    modes: Option<&'a [f64]>,
}

impl Bands<'_> {
    /// Means N and N′, σ² and modes, band by band.
    fn each(&self) -> impl Iterator<Item = (f64, f64, f64, f64)> {
        let modes = |band: usize| self.modes.and_then(|modes| modes.get(band)).copied();
        let means = self.counts.iter().zip(self.others).zip(self.var_reading).enumerate();
        means.map(move |(band, ((mean, other), var))| {
            (*mean, *other, *var, modes(band).unwrap_or(f64::INFINITY))
        })
    }

    /// Many counts, or much noise.
    fn many(&self) -> Result<Option<DecisionBounds>> {
        let (mut means, mut others) = (Vec::new(), Vec::new());
        let (mut square, mut excess, mut lumps) = (0.0, 0.0, 1.0_f64);
        for (mean, other, var, modes) in self.each() {
            let bunched = mean / modes * other;
            let added = var + bunched;
            means.push(mean + added);
            others.push(other + added);
            let total = mean.min(other) + added;
            let part = if total > 0.0 { (mean - other) / total * (mean - other) } else { 0.0 };
            let lump = 1.0 + 2.0 * mean.max(other) / modes;
            // Information on the mean beyond 1/V: twice what noise that is normal adds, or all that is lost by it.
            let normal = if var < 1.0 { f64::INFINITY } else { 0.5 * (lump * var / total).powi(2) / total };
            square += part;
            excess += part * normal.min(0.5 * var / mean.min(other));
            if part > 0.0 {
                lumps = lumps.max(lump);
            }
        }
        let states = KnownStates::new(&means, &others, &Statistics::Poisson)?;
        let Some(close) = near_normal(&states) else { return Ok(None) };
        let Some([least, most]) = taken_for_normal(close, &states) else { return Ok(None) };
        let distance = (2.0 * states.exponent(0.5)).sqrt();
        let miss = |distance: f64| detection::miss_probability(distance);
        let further = miss(distance * (1.0 + excess / square)) / miss(distance);
        let middle = 0.5 * (least + most);
        let reach = (middle - least) * lumps;
        let found = [((middle - reach) * further).max(0.0), middle + reach];
        let narrow = found[1] - found[0] <= NEAR * found[1];
        Ok(narrow.then(|| bounds(found, DecisionLaw::Gaussian)))
    }

    /// The largest error of the test that weighs counts by (N′ − N)/√(VV′) and compares their sum with a threshold.
    fn linear(&self) -> f64 {
        let (mut mean, mut var, mut third) = ([0.0; 2], [0.0; 2], [0.0; 2]);
        for (own, other, noise, modes) in self.each() {
            let of = |mean: f64| {
                let bunched = 1.0 + mean / modes;
                (noise + mean * bunched, mean * bunched * (1.0 + 2.0 * mean / modes))
            };
            let moments = [of(own), of(other)];
            let [(v, _), (w, _)] = moments;
            if own == other {
                continue;
            }
            let weight = (other - own) / (v * w).sqrt();
            for (i, (count, (v, k))) in [own, other].into_iter().zip(moments).enumerate() {
                mean[i] += weight * count;
                var[i] += weight * weight * v;
                third[i] += weight.abs().powi(3) * k;
            }
        }
        let spread = var.map(f64::sqrt);
        let apart = (mean[1] - mean[0]) / (spread[0] + spread[1]);
        let grain = third[0] / (var[0] * spread[0]) + third[1] / (var[1] * spread[1]);
        let error = detection::miss_probability(apart) + 0.5 * BERRY_ESSEEN * grain;
        if error < 0.5 { error * (1.0 + 1e-13) } else { 0.5 }
    }
}

#[cfg(test)]
mod tests;
