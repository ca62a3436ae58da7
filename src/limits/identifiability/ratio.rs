//! The law of the likelihood ratio between two known states, and with it the exact error of the best test.
//!
//! Two equally likely product laws p and q over the counts of W bands; Λ = ln(q/p) is a sum over the bands, for
//! Poisson Λ = Σ [n ln(N′/N) − (N′ − N)]. The best test says q where Λ > 0, p where Λ < 0, and tosses a coin between.
//! It errs with probability
//!
//! α = P_p(Λ > 0) + ½P_p(Λ = 0), β = P_q(Λ < 0) + ½P_q(Λ = 0), error = ½(α + β) = ½Σ min(p, q).
//!
//! No spectrum is drawn. With C(s) = −ln Σ p^{1−s}q^s and the tilted law p^{1−s}q^s e^{C(s)} (see [`super::bracket`]),
//! error = ½e^{−C(s)} E[min(e^{−sΛ}, e^{(1−s)Λ})], what may be tiny times what is not, so that an error of 10⁻¹⁰⁰ has
//! as many good digits as one of 0.1. s is where C(s) + ln s + ln(1 − s) is largest. The expectation is
//!
//! * [`Route::Sum`]: the sum over all counts, where bands of different step ln(N′/N) are few;
//! * [`Route::Integral`]: the inverse Fourier transform along Re z = s (`inversion`), else; normal counts with
//!   variances that differ have their characteristic function in closed form and need no approximation;
//! * [`Route::Lattice`]: a discrete Fourier transform (`lattice`), where counts are so few that the integral does not
//!   settle;
//! * [`Route::Bracket`]: none of them settled: only the rigorous bracket is known, and drawing counts tells more.
//!
//! The numerical error of each is estimated: rounding, what halving the step changes, what revivals of the
//! characteristic function may add.
//!
//! Symbols: N, N′ mean counts of a band, n its counts, z = s + iτ. Source: Helstrom, 'Elements of Signal Detection and
//! Estimation' (1995), chapter 5; the rest is derived here or named where it is done.

mod distribution;
mod effort;
mod enumeration;
mod integrals;
mod inversion;
mod lattice;
mod line;

pub use self::distribution::RatioDistribution;
use self::effort::{Effort, QUICK, WHOLE};
use self::integrals::Integrals;
use self::line::Line;
use super::bracket::KnownStates;
use super::bracket::tilted::{Moments, Tilted};
use crate::error::Result;
use crate::root::crossing_by_newton;
use crate::statistics::Statistics;
use std::f64::consts::LN_2;

/// s stays this far from 0 and 1.
const EDGE: f64 = 1e-12;
/// −ln |φ| that a characteristic function must be able to reach.
const DEEP: f64 = 60.0;

/// How an error was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Route {
    /// The states do not differ, or Λ takes a single value.
    Single,
    /// Sum over all counts.
    Sum,
    /// Integral over the characteristic function.
    Integral,
    /// Discrete Fourier transform on a lattice.
    Lattice,
    /// Middle of the rigorous bracket, which is all that is known without drawing counts.
    Bracket,
}

/// One of the two states.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum State {
    /// p.
    First,
    /// q.
    Second,
}

/// Error probabilities of the best test between two known, equally likely states.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct TestError {
    /// Probability of error, the mean ½(α + β) of both kinds.
    pub error: f64,
    /// Its natural logarithm, where it would underflow.
    pub ln_error: f64,
    /// α: the first state is taken for the second.
    pub first: f64,
    /// β: the second state is taken for the first.
    pub second: f64,
    /// Estimated numerical error of `error`, relative to it (and so of `ln_error`).
    pub numerical: f64,
    /// Estimated numerical error of `first` and of `second`, relative to `error`.
    pub numerical_class: f64,
    /// The method by which they were computed.
    pub route: Route,
}

impl TestError {
    /// 1 − error.
    #[must_use]
    pub fn accuracy(&self) -> f64 {
        1.0 - self.error
    }
}

/// The law of Λ = ln(q/p) of two known states.
///
/// ```
/// use hadar::identifiability::ratio::RatioLaw;
/// use hadar::statistics::Statistics;
/// // One count more or less: the threshold is between 2 and 3 photons.
/// let law = RatioLaw::new(&[2.0], &[3.0], &Statistics::Poisson)?;
/// let exact = 0.5 * (1.0 - 5.0 * (-2.0_f64).exp() + 8.5 * (-3.0_f64).exp());
/// let found = law.error();
/// assert!((found.error / exact - 1.0).abs() < 1e-13 && found.numerical < 1e-13);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct RatioLaw {
    states: KnownStates,
}

impl RatioLaw {
    /// States with mean counts `means` (p) and `others` (q) in the bands.
    ///
    /// # Errors
    /// As [`KnownStates::new`].
    pub fn new(means: &[f64], others: &[f64], statistics: &Statistics) -> Result<Self> {
        Ok(Self { states: KnownStates::new(means, others, statistics)? })
    }

    /// Error probabilities of the best test.
    #[must_use]
    pub fn error(&self) -> TestError {
        self.settled(WHOLE).unwrap_or_else(|| self.bracketed())
    }

    /// The same to some six digits, if that takes no more than some milliseconds; else nothing.
    pub(super) fn quick_error(&self) -> Option<TestError> {
        self.settled(QUICK)
    }

    /// The two states.
    pub(super) const fn states(&self) -> &KnownStates {
        &self.states
    }

    fn settled(&self, effort: Effort) -> Option<TestError> {
        let line = self.line(self.saddle());
        if line.modes.is_empty() { single(&line) } else { self.found(&line, effort) }
    }

    /// [`error`](Self::error) by one route alone; nothing if it does not apply or does not settle.
    #[must_use]
    pub fn error_by(&self, route: Route) -> Option<TestError> {
        let line = self.line(self.saddle());
        if line.modes.is_empty() || route == Route::Single {
            return (line.modes.is_empty() && route == Route::Single).then(|| single(&line)).flatten();
        }
        let found = match route {
            Route::Sum => enumeration::enumerate(&line, WHOLE),
            Route::Integral => inversion::integrate(&line, WHOLE),
            Route::Lattice => lattice::transform(&line, WHOLE.lattice),
            Route::Single | Route::Bracket => return Some(self.bracketed()),
        };
        self.checked(found?, route)
    }

    /// 1 − [`error`](Self::error).
    #[must_use]
    pub fn accuracy(&self) -> f64 {
        self.error().accuracy()
    }

    /// The law of Λ under one state, given that Λ is finite; nothing where counts are too few for a smooth law, and
    /// where Λ takes a single value.
    #[must_use]
    pub fn distribution(&self, state: State) -> Option<RatioDistribution> {
        RatioDistribution::new(&self.line(if state == State::First { 0.0 } else { 1.0 }))
    }

    /// Probability under one state of counts that the other state never gives (Λ = −∞ under the first state, ∞ under
    /// the second): counts in a band that is dark in the other.
    #[must_use]
    pub fn certain(&self, state: State) -> f64 {
        let exponents = self.states.bands().iter().filter_map(|band| match *band {
            Tilted::Dark { exponent, first } if first != (state == State::First) => Some(exponent),
            _ => None,
        });
        -(-exponents.sum::<f64>()).exp_m1()
    }

    fn line(&self, s: f64) -> Line {
        Line::new(self.states.bands(), self.states.at(s), s)
    }

    /// The routes in turn.
    fn found(&self, line: &Line, effort: Effort) -> Option<TestError> {
        let inside = |integrals: Integrals, route| self.checked(integrals, route);
        if let Some(found) = enumeration::enumerate(line, effort).and_then(|sum| inside(sum, Route::Sum)) {
            return Some(found);
        }
        let integral = (line.depth() > DEEP).then(|| inversion::integrate(line, effort)).flatten();
        if let Some(settled) = integral.filter(|integral| integral.relative() < effort.settled) {
            return inside(settled, Route::Integral);
        }
        let lattice = lattice::transform(line, effort.lattice);
        match (integral, lattice) {
            (Some(a), Some(b)) if a.relative() < b.relative() => inside(a, Route::Integral),
            (_, Some(b)) => inside(b, Route::Lattice),
            (Some(a), None) => inside(a, Route::Integral),
            (None, None) => None,
        }
    }

    /// The s of the steepest descent of φ/z(1 − z).
    fn saddle(&self) -> f64 {
        crossing_by_newton(EDGE, 1.0 - EDGE, 0.5, |s| {
            let (t, Moments { slope, variance, .. }) = (1.0 - s, self.states.at(s));
            [slope - 1.0 / s + 1.0 / t, variance + 1.0 / (s * s) + 1.0 / (t * t)]
        })
    }

    /// Error probabilities from the integrals; nothing if they are no numbers or outside the rigorous bracket.
    fn checked(&self, found: Integrals, route: Route) -> Option<TestError> {
        let bracket = self.states.bracket();
        let error = assembled(found, route);
        let slack = error.numerical + 1e-13 * (10.0 + found.exponent);
        let inside = error.ln_error >= bracket.ln_lower - slack && error.ln_error <= bracket.ln_upper + slack;
        (inside && error.numerical.is_finite()).then_some(error)
    }

    fn bracketed(&self) -> TestError {
        let bracket = self.states.bracket();
        // The lower bound of an error beyond all measure may be nothing.
        let ln_lower = bracket.ln_lower.max(2.0 * bracket.ln_upper - 600.0).max(f64::MIN);
        let ln_error = 0.5 * (ln_lower + bracket.ln_upper.max(f64::MIN));
        let reach = (0.5 * (bracket.ln_upper - ln_lower).max(0.0)).exp_m1().min(f64::MAX / 4.0);
        let error = ln_error.exp();
        TestError {
            error,
            ln_error,
            first: error,
            second: error,
            numerical: reach,
            // Either is between 0 and twice the upper bound.
            numerical_class: 1.0 + 2.0 * reach,
            route: Route::Bracket,
        }
    }
}

/// Λ takes one value, where it is finite.
fn single(line: &Line) -> Option<TestError> {
    let ratio = line.moments.slope;
    let (first, second) = match ratio {
        _ if ratio == 0.0 => (0.5, 0.5),
        _ if ratio > 0.0 => (1.0, 0.0),
        _ => (0.0, 1.0),
    };
    let weight = if ratio > 0.0 { line.s * ratio } else { -line.t * ratio };
    let exponent = line.moments.exponent + weight;
    let numerical = f64::EPSILON * (2.0 + exponent);
    let found = Integrals { first, second, exponent, numerical, numerical_class: numerical };
    Some(assembled(found, Route::Single)).filter(|error| error.ln_error.is_finite())
}

fn assembled(found: Integrals, route: Route) -> TestError {
    let total = found.first + found.second;
    let ln_error = -LN_2 - found.exponent + total.ln();
    let scale = (-found.exponent).exp();
    TestError {
        // An error of ½ is not overshot by rounding.
        error: (0.5 * scale * total).min(0.5),
        ln_error: ln_error.min(-LN_2),
        first: (scale * found.first).clamp(0.0, 1.0),
        second: (scale * found.second).clamp(0.0, 1.0),
        numerical: found.numerical / total,
        numerical_class: 2.0 * found.numerical_class / total,
        route,
    }
}

#[cfg(test)]
mod tests;
