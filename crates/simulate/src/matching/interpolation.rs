//! Counts and their slope between the pixels of a row.

use super::layout::{Layout, View};
use std::f64::consts::PI;

/// Pole of the cubic spline's filter: √3 − 2.
const POLE: f64 = -0.267_949_192_431_122_7;
/// Pixels on either side that a windowed sinc uses.
pub(super) const LOBES: usize = 8;
/// Most values that one interpolated value is made of.
pub(super) const TAPS: usize = 2 * LOBES;

/// How the other view is interpolated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Interpolation {
    /// The interpolating cubic spline. Between pixels it smooths noise: half-way white noise has 0.76 of its
    /// variance.
    CubicSpline,
    /// Sinc under a Lanczos window of 8 lobes, weights divided by their sum: closer to white noise's full variance
    /// everywhere (half-way 0.92), so that no place between pixels is much preferred.
    #[default]
    Sinc,
}

/// Weights of the values beside a place, of its value and of its slope.
#[derive(Debug, Clone, Copy)]
pub(super) struct Weights {
    pub(super) value: [f64; TAPS],
    pub(super) slope: [f64; TAPS],
}

impl Interpolation {
    /// How many values are used.
    pub(super) const fn taps(self) -> usize {
        match self {
            Self::CubicSpline => 4,
            Self::Sinc => TAPS,
        }
    }

    /// Values before the pixel left of a place.
    pub(super) const fn before(self) -> usize {
        self.taps() / 2 - 1
    }

    /// Weights at t, 0 ≤ t < 1, after a pixel.
    pub(super) fn weights(self, t: f64) -> Weights {
        let (mut value, mut slope) = ([0.0; TAPS], [0.0; TAPS]);
        match self {
            Self::CubicSpline => {
                let s = 1.0 - t;
                let inner = |t: f64| (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0;
                let rise = |t: f64| -2.0 * t + 1.5 * t * t;
                let values = [s * s * s / 6.0, inner(t), inner(s), t * t * t / 6.0];
                let slopes = [-0.5 * s * s, rise(t), -rise(s), 0.5 * t * t];
                for i in 0..4 {
                    (value[i], slope[i]) = (values[i], slopes[i]);
                }
            }
            Self::Sinc => {
                for i in 0..TAPS {
                    (value[i], slope[i]) = lanczos(t + self.before() as f64 - i as f64);
                }
                let (sum, rise): (f64, f64) = (value.iter().sum(), slope.iter().sum());
                for i in 0..TAPS {
                    // Of the quotient.
                    slope[i] = (slope[i] - value[i] * rise / sum) / sum;
                    value[i] /= sum;
                }
            }
        }
        Weights { value, slope }
    }

    /// What the weights are for: the samples, or the spline's coefficients.
    pub(super) fn coefficients_into(self, view: View, to: &mut Vec<f64>) {
        to.clear();
        to.extend_from_slice(view.samples);
        if self == Self::CubicSpline {
            let layout: &Layout = view.layout;
            for row in 0..layout.shape().rows() {
                for band in 0..layout.shape().bands() {
                    if let Some(plane) = to.get_mut(layout.plane(row, band)) {
                        spline(plane);
                    }
                }
            }
        }
    }
}

/// sinc(u) sinc(u/8) and its slope, |u| ≤ 8.
fn lanczos(u: f64) -> (f64, f64) {
    let reach = LOBES as f64;
    if u.abs() >= reach {
        return (0.0, 0.0);
    }
    let sinc = |x: f64| {
        let a = PI * x;
        if a.abs() < 1e-4 {
            // Next terms: a⁴/120 and a³/30.
            return (1.0 - a * a / 6.0, -PI * a / 3.0);
        }
        (libm::sin(a) / a, PI * (libm::cos(a) - libm::sin(a) / a) / a)
    };
    let ((f, df), (g, dg)) = (sinc(u), sinc(u / reach));
    (f * g, df * g + f * dg / reach)
}

/// Samples to coefficients of the cubic spline through them, mirrored at either end.
/// Source: Unser, IEEE Signal Process. Mag. 16 (6), 22 (1999), doi:10.1109/79.799930.
fn spline(x: &mut [f64]) {
    let n = x.len();
    if n < 2 {
        return;
    }
    let (mut power, mut first) = (1.0, 0.0);
    for k in 0..60.min(2 * n - 2) {
        first += power * x[if k < n { k } else { 2 * n - 2 - k }];
        power *= POLE;
    }
    // Of a short row the mirrored samples come again and again.
    if 2 * n - 2 < 60 {
        first /= 1.0 - power;
    }
    let gain = 6.0;
    x[0] = first;
    for i in 1..n {
        x[i] += POLE * x[i - 1];
    }
    x[n - 1] = POLE / (POLE * POLE - 1.0) * (x[n - 1] + POLE * x[n - 2]);
    for i in (0..n - 1).rev() {
        x[i] = POLE * (x[i + 1] - x[i]);
    }
    x.iter_mut().for_each(|x| *x *= gain);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(kind: Interpolation, coefficients: &[f64], x: f64) -> (f64, f64) {
        let (pixel, weights) = (x.floor(), kind.weights(x - x.floor()));
        let from = pixel as usize - kind.before();
        let sum = |w: &[f64; TAPS]| (0..kind.taps()).map(|i| w[i] * coefficients[from + i]).sum();
        (sum(&weights.value), sum(&weights.slope))
    }

    #[test]
    fn a_spline_goes_through_its_samples_and_reproduces_cubics_far_from_the_ends() {
        for n in [2_usize, 3, 7, 40, 100] {
            let samples: Vec<f64> = (0..n).map(|i| ((i * i * 7) % 11) as f64).collect();
            let mut c = samples.clone();
            spline(&mut c);
            let mirrored = |i: i64| {
                c[if i < 0 {
                    -i
                } else if i >= n as i64 {
                    2 * n as i64 - 2 - i
                } else {
                    i
                } as usize]
            };
            for i in 0..n as i64 {
                let value = (mirrored(i - 1) + 4.0 * mirrored(i) + mirrored(i + 1)) / 6.0;
                assert!((value - samples[i as usize]).abs() < 1e-12, "{n} {i}");
            }
        }
        let cubic = |x: f64| 2.0 + 0.1 * x - 0.03 * x * x + 0.001 * x * x * x;
        let slope = |x: f64| 0.1 - 0.06 * x + 0.003 * x * x;
        let mut c: Vec<f64> = (0..80).map(|i| cubic(f64::from(i))).collect();
        spline(&mut c);
        for x in [40.0, 40.3, 39.77] {
            let found = at(Interpolation::CubicSpline, &c, x);
            // The mirror's disturbance has decayed by POLE^38.
            assert!((found.0 - cubic(x)).abs() < 1e-11 && (found.1 - slope(x)).abs() < 1e-11);
        }
    }

    /// Largest error of a wave of u cycles per pixel, and white noise half-way, by the sum of its squared weights.
    #[test]
    fn errors_of_waves_and_the_variance_of_noise_are_as_documented() {
        for (kind, u, error) in [
            (Interpolation::CubicSpline, 0.125, 1.065e-3),
            (Interpolation::Sinc, 0.125, 1.573e-4),
            (Interpolation::CubicSpline, 0.3, 6.759e-2),
            (Interpolation::Sinc, 0.3, 9.129e-4),
        ] {
            let mut c: Vec<f64> = (0..100).map(|i| (2.0 * PI * u * f64::from(i)).cos()).collect();
            if kind == Interpolation::CubicSpline {
                spline(&mut c);
            }
            let places = (0..400).map(|i| 45.0 + f64::from(i) / 40.0);
            let off = places.map(|x| (at(kind, &c, x).0 - (2.0 * PI * u * x).cos()).abs());
            let worst = off.fold(0.0, f64::max);
            assert!((worst / error - 1.0).abs() < 1e-2, "{kind:?} {u}: {worst:.3e}");
        }
        for (kind, variance) in [(Interpolation::CubicSpline, 0.7561), (Interpolation::Sinc, 0.9158)] {
            let found: f64 = (20..80)
                .map(|i| {
                    let mut c = vec![0.0; 100];
                    c[i] = 1.0;
                    if kind == Interpolation::CubicSpline {
                        spline(&mut c);
                    }
                    at(kind, &c, 50.5).0.powi(2)
                })
                .sum();
            assert!((found / variance - 1.0).abs() < 1e-3, "{kind:?}: {found:.4}");
        }
    }

    /// Slopes against differences of values.
    #[test]
    fn slopes_are_those_of_the_values() {
        for kind in [Interpolation::CubicSpline, Interpolation::Sinc] {
            for t in [0.0_f64, 0.2, 0.5, 0.93] {
                // On either side of a pixel the taps are others: step forward.
                let [a, b, c] = [t + 1e-4, t + 2e-4, t + 3e-4].map(|t| kind.weights(t));
                for i in 0..kind.taps() {
                    let slope = (c.value[i] - a.value[i]) / 2e-4;
                    assert!((slope - b.slope[i]).abs() < 1e-6, "{kind:?} {t} {i}");
                }
            }
        }
    }
}
