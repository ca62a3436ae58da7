//! What blackbodies send, by a table over temperature.
//!
//! A signal S(T) of blackbodies, such as ∫B(T) dν over a band, has a logarithm that is nearly a straight line over x = −1/T, and exactly so in the limit
//! of short waves. Between knots in even steps of ln T it is the cubic that has values and slopes d ln S/dx = T² S′/S of both (Hermite), and so is x
//! over ln S: a relative error below 10⁻⁹ of S, and of T.
//!
//! Assumption: S rises with T. Units: K; S in whatever it is given in.

use crate::error::{Error, Result};

/// Steps of ln T: a hundredth.
const STEP: f64 = 1e-2;
/// Signals below are none, so that slopes of the logarithm keep their digits.
const LEAST: f64 = 1e-290;

/// Signals of blackbodies over temperature.
///
/// ```
/// use hadar::planck::{Tabulated, photon_radiance, photon_radiance_slope};
/// let at = |t: f64| vec![[photon_radiance(1000.0, t), photon_radiance_slope(1000.0, t)]];
/// let table = Tabulated::new([200.0, 400.0], at)?;
/// let radiance = table.signal(0, 300.0).unwrap();
/// assert!((radiance / photon_radiance(1000.0, 300.0) - 1.0).abs() < 1e-9);
/// assert!((table.temperature_k(0, radiance).unwrap() / 300.0 - 1.0).abs() < 1e-9);
/// assert!(table.signal(0, 500.0).is_none());
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug)]
pub struct Tabulated {
    low: f64,
    step: f64,
    /// x of the knots.
    inverse: Vec<f64>,
    /// Of each signal ln S and d ln S/dx at the knots; −∞ where there is none.
    signals: Vec<Vec<[f64; 2]>>,
}

impl Tabulated {
    /// Tables of all signals whose values and slopes by T `at` gives at a temperature, K.
    ///
    /// # Errors
    /// A range that is none.
    pub fn new(range_k: [f64; 2], mut at: impl FnMut(f64) -> Vec<[f64; 2]>) -> Result<Self> {
        let [low, high] = range_k;
        if !(low > 0.0 && high > low && high.is_finite()) {
            return Err(Error::out_of_range(
                "range of a table",
                low,
                "K",
                format!("from above 0 to {high} K"),
            ));
        }
        let (low, span) = (libm::log(low), libm::log(high / low));
        let steps = (span / STEP).ceil().max(1.0);
        let step = span / steps;
        let (mut inverse, mut signals) = (Vec::new(), Vec::new());
        for knot in 0..=steps as usize {
            let t = if knot == 0 { range_k[0] } else { libm::exp(low + step * knot as f64) };
            inverse.push(-1.0 / t);
            let values = at(t);
            signals.resize_with(values.len(), Vec::new);
            for (signal, [value, slope]) in signals.iter_mut().zip(values) {
                signal.push(match value > LEAST {
                    true => [libm::log(value), t * t * slope / value],
                    false => [f64::NEG_INFINITY, 0.0],
                });
            }
        }
        Ok(Self { low, step, inverse, signals })
    }

    /// A signal at a temperature, K; none outside of the table, or where it is none.
    #[must_use]
    pub fn signal(&self, of: usize, temperature_k: f64) -> Option<f64> {
        let place = (libm::log(temperature_k) - self.low) / self.step;
        let last = self.inverse.len() - 1;
        if !(place >= 0.0 && place <= last as f64) {
            return None;
        }
        let knot = (place as usize).min(last - 1);
        let [a, b] = self.knots(of, knot)?;
        Some(libm::exp(hermite(a, b, -1.0 / temperature_k)))
    }

    /// The temperature of a signal, K; none outside of the table.
    #[must_use]
    pub fn temperature_k(&self, of: usize, signal: f64) -> Option<f64> {
        let wanted = (signal > 0.0).then(|| libm::log(signal))?;
        let knots = self.signals.get(of)?;
        let above = knots.partition_point(|[ln, _]| *ln <= wanted);
        let is_last = above == knots.len() && knots.last().is_some_and(|[ln, _]| *ln == wanted);
        let [a, b] = self.knots(of, (if is_last { above - 1 } else { above }).checked_sub(1)?)?;
        let turned = |[x, ln, slope]: [f64; 3]| [ln, x, 1.0 / slope];
        Some(-1.0 / hermite(turned(a), turned(b), wanted))
    }

    /// Two neighbouring knots: x, ln S and its slope.
    fn knots(&self, of: usize, first: usize) -> Option<[[f64; 3]; 2]> {
        let signal = self.signals.get(of)?;
        let one = |knot: usize| {
            let ([ln, slope], x) = (*signal.get(knot)?, *self.inverse.get(knot)?);
            ln.is_finite().then_some([x, ln, slope])
        };
        Some([one(first)?, one(first + 1)?])
    }
}

/// The cubic through two places with their slopes.
fn hermite([x0, y0, slope0]: [f64; 3], [x1, y1, slope1]: [f64; 3], x: f64) -> f64 {
    let width = x1 - x0;
    let (u, rise) = ((x - x0) / width, y1 - y0);
    let (bend0, bend1) = (slope0 * width - rise, slope1 * width - rise);
    y0 + u * (rise + (1.0 - u) * (bend0 * (1.0 - u) - bend1 * u))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planck::{photon_radiance, photon_radiance_slope};
    use crate::spectrum::Bands;

    /// Against sums of Planck's law itself, from narrow bands to the whole infrared, from 10 K to 100 000 K.
    #[test]
    fn signals_and_temperatures_are_those_of_the_law() {
        for (low, high, step) in
            [(100.0, 101.0, 0.5), (714.0, 1250.0, 4.0), (50.0, 10_000.0, 50.0), (1e4, 2e4, 1e3)]
        {
            let bands = Bands::uniform(low, high, step).unwrap();
            let sum = |t: f64| -> [f64; 2] {
                [photon_radiance, photon_radiance_slope]
                    .map(|law| bands.nodes_cm1().iter().map(|nu| law(*nu, t)).sum::<f64>())
            };
            let table = Tabulated::new([10.0, 1e5], |t| vec![[1.0, 0.0], sum(t)]).unwrap();
            for place in 0..=5000 {
                let t = 10.0 * libm::pow(1e4, f64::from(place) / 5000.0);
                let [signal, _] = sum(t);
                let Some(found) = table.signal(1, t) else {
                    assert!(t > 9.99e4 || signal < 1e-270, "{t} K: {signal:e}");
                    continue;
                };
                assert!((found / signal - 1.0).abs() < 1e-9, "{low} {t} K: {}", found / signal - 1.0);
                let back = table.temperature_k(1, signal).unwrap();
                assert!((back / t - 1.0).abs() < 1e-9, "{low} {t} K: {}", back / t - 1.0);
            }
            assert!(table.temperature_k(1, 0.0).is_none() && table.temperature_k(1, f64::NAN).is_none());
            assert!(
                table.temperature_k(1, 1.01 * sum(1e5)[0]).is_none() && table.signal(1, f64::NAN).is_none()
            );
            assert!(table.signal(2, 300.0).is_none());
        }
        assert!(Tabulated::new([0.0, 1.0], |_| Vec::new()).is_err());
        assert!(Tabulated::new([2.0, 1.0], |_| Vec::new()).is_err());
    }
}
