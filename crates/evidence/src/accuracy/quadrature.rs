//! Integrals in extended precision by the tanh-sinh rule.
//!
//! x = tanh(½π sinh t) takes (−1, 1) to the whole line, where the trapezoidal rule converges faster than any power of
//! its step for integrands that are analytic inside: ∫f dx = h Σ f(x(t)) x′(t), x′ = 2π cosh t·u/(u + 1)² and
//! x = (u − 1)/(u + 1) with u = exp(π sinh t). The step is halved until nothing changes in [`DIGITS`].
//!
//! Source: Takahasi and Mori, Publ. RIMS Kyoto Univ. 9, 721 (1974), doi:10.2977/prims/1195192451.

use crate::reference::Extended;

/// Relative change below which an integral has settled.
const DIGITS: f64 = 1e-30;
/// Halvings after which it is taken as it is.
const MOST_HALVINGS: u32 = 9;
/// |t| beyond which nothing is left: x′ is below 1e-40.
const REACH: f64 = 4.0;

/// ∫ of `integrand` over the pieces between neighbouring `edges`.
pub(super) fn integral(integrand: impl Fn(&Extended) -> Extended, edges: &[f64]) -> Extended {
    edges.windows(2).map(|piece| over_piece(&integrand, piece[0], piece[1])).sum()
}

fn over_piece(integrand: &impl Fn(&Extended) -> Extended, low: f64, high: f64) -> Extended {
    let half = (Extended::from(high) - Extended::from(low)).times_power_of_two(-1);
    let middle = (Extended::from(high) + Extended::from(low)).times_power_of_two(-1);
    let term = |t: f64| {
        let one = Extended::one();
        let (up, down) = (Extended::from(t).exp(), Extended::from(-t).exp());
        let u = (Extended::pi() * (&up - &down).times_power_of_two(-1)).exp();
        let below = &u + &one;
        let x = (&u - &one) / &below;
        let slope = Extended::pi() * (up + down) * u / below.square();
        integrand(&(&middle + x * &half)) * slope * &half
    };
    let mut step = 0.5;
    let points = |first: f64, step: f64| {
        let mut sum = Extended::zero();
        let mut t = first;
        while t <= REACH {
            sum = sum + term(t) + term(-t);
            t += step;
        }
        sum
    };
    let mut sum = term(0.0) + points(step, step);
    let mut value = &sum * Extended::from(step);
    for _ in 0..MOST_HALVINGS {
        // Those between the points there are.
        sum = sum + points(0.5 * step, step);
        step *= 0.5;
        let finer = &sum * Extended::from(step);
        let settled = value.relative_error_to(&finer) < DIGITS;
        value = finer;
        if settled {
            break;
        }
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ 1/(1 + x²) from 0 to 1 is π/4, and ∫ eˣ from −1 to 2 is e² − 1/e.
    #[test]
    fn thirty_digits_of_closed_forms() {
        let line = integral(|x| Extended::one() / (Extended::one() + x.square()), &[0.0, 0.3, 1.0]);
        assert!(line.relative_error_to(&Extended::pi().times_power_of_two(-2)) < 1e-30);
        let growth = integral(Extended::exp, &[-1.0, 2.0]);
        let exact = Extended::from(2.0).exp() - Extended::from(-1.0).exp();
        assert!(growth.relative_error_to(&exact) < 1e-30);
    }
}
