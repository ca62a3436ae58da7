//! What stripes cost: Fisher information of a parameter where gain and offset of each line are unknown.
//!
//! Samples i of a line of a band read y_i = g·N_i(θ) + o, with variance v_i. At g = 1, o = 0 the whitened scores are
//! s_θ = ∂N/√v, s_g = (N − x₀)/√v and s_o = 1/√v, o counted at a level x₀. What is known of gain and offset beforehand, independent
//! at x₀ with deviations σ_g and σ_o, is an observation of each: a row 1/σ_g, 1/σ_o below the scores. The information of θ is the
//! square of what is left of s_θ once the span of s_g and s_o is projected out: ‖P⊥ s_θ‖². With σ = 0 nothing is lost; with σ = ∞
//! nothing is known. Lines and bands have gains and offsets of their own: their informations add.
//!
//! θ may be the position of a window (∂N = ∂N/∂x, S37: the clean information is Σ(∂ₓN)²/(N + σ²)) or a temperature of one pixel
//! (∂N = ∂N/∂T there and 0 elsewhere). Source: paper, supplement S27, S37, SV A.

/// What is known of gain and offset of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LineKnown {
    /// Deviation of the gain from 1; infinite where nothing is known.
    pub(super) sigma_gain: f64,
    /// Deviation of the offset at `level`; infinite where nothing is known.
    pub(super) sigma_offset: f64,
    /// Level at which the two are independent.
    pub(super) level: f64,
}

impl LineKnown {
    /// Nothing is known.
    pub(super) const NOTHING: Self =
        Self { sigma_gain: f64::INFINITY, sigma_offset: f64::INFINITY, level: 0.0 };
    /// All is known: a calibrated line.
    pub(super) const ALL: Self = Self { sigma_gain: 0.0, sigma_offset: 0.0, level: 0.0 };
}

/// A sample of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LineSample {
    /// Mean.
    pub(super) mean: f64,
    /// Its derivative with respect to the parameter.
    pub(super) derivative: f64,
    /// Variance, above 0.
    pub(super) var: f64,
}

/// Fisher information of the parameter in the samples of a line of a band; 0 of samples that scatter by nothing or by what is no number.
#[must_use]
pub(super) fn information(line: &[LineSample], known: LineKnown) -> f64 {
    let rows = line.len();
    let mut score = vec![0.0; rows + 2];
    let (mut gain, mut offset) = (score.clone(), score.clone());
    for (i, sample) in line.iter().enumerate() {
        let scale = sample.var.sqrt().recip();
        if !(scale.is_finite() && scale > 0.0) {
            return 0.0;
        }
        score[i] = sample.derivative * scale;
        gain[i] = (sample.mean - known.level) * scale;
        offset[i] = scale;
    }
    gain[rows] = known.sigma_gain.recip();
    offset[rows + 1] = known.sigma_offset.recip();
    // The offset first: what the gain does beyond it is the contrast of the line.
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for (mut nuisance, sigma) in [(offset, known.sigma_offset), (gain, known.sigma_gain)] {
        if sigma == 0.0 {
            continue;
        }
        let whole = norm(&nuisance);
        // Twice, as one round leaves what rounding made of a nearly dependent one.
        for _ in 0..2 {
            basis.iter().for_each(|own| take_out(&mut nuisance, own));
        }
        let left = norm(&nuisance);
        if left > 1e-12 * whole {
            nuisance.iter_mut().for_each(|x| *x /= left);
            basis.push(nuisance);
        }
    }
    for _ in 0..2 {
        basis.iter().for_each(|own| take_out(&mut score, own));
    }
    score.iter().map(|x| x * x).sum()
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn take_out(values: &mut [f64], unit: &[f64]) {
    let along: f64 = values.iter().zip(unit).map(|(a, b)| a * b).sum();
    values.iter_mut().zip(unit).for_each(|(value, unit)| *value -= along * unit);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(count: usize) -> Vec<LineSample> {
        (0..count)
            .map(|i| {
                let x = i as f64;
                LineSample {
                    mean: 1e4 + 300.0 * (0.7 * x).sin(),
                    derivative: 210.0 * (0.7 * x).cos(),
                    var: 1e4 + x,
                }
            })
            .collect()
    }

    #[test]
    fn an_unknown_offset_takes_the_mean_of_the_derivatives() {
        let line = [1.0, -2.0, 0.5].map(|derivative| LineSample { mean: 100.0, derivative, var: 4.0 });
        assert_eq!(information(&line, LineKnown::ALL), (1.0 + 4.0 + 0.25) / 4.0);
        let left = information(&line, LineKnown::NOTHING);
        assert!((left - (5.25 - 0.25 / 3.0) / 4.0).abs() < 1e-12);
    }

    #[test]
    fn one_pixel_has_the_error_of_its_line_beside_its_noise() {
        let sample = LineSample { mean: 1200.0, derivative: 30.0, var: 1500.0 };
        let known = LineKnown { sigma_gain: 0.02, sigma_offset: 25.0, level: 1000.0 };
        let expected = 900.0 / (1500.0 + 625.0 + 16.0);
        assert!((information(&[sample], known) / expected - 1.0).abs() < 1e-12);
        assert!(information(&[sample], LineKnown::NOTHING).abs() < 1e-20);
    }

    #[test]
    fn many_pixels_agree_with_the_schur_complement_of_the_fisher_matrix() {
        let samples = line(40);
        let known = LineKnown { sigma_gain: 0.01, sigma_offset: 15.0, level: 9900.0 };
        let sum = |value: &dyn Fn(&LineSample) -> f64| samples.iter().map(|s| value(s) / s.var).sum::<f64>();
        let gain = |s: &LineSample| s.mean - known.level;
        let (gg, go, oo) = (sum(&|s| gain(s).powi(2)) + 1e4, sum(&|s| gain(s)), sum(&|_| 1.0) + 1.0 / 225.0);
        let (tg, to) = (sum(&|s| s.derivative * gain(s)), sum(&|s| s.derivative));
        let det = gg * oo - go * go;
        let expected =
            sum(&|s| s.derivative.powi(2)) - (tg * tg * oo - 2.0 * tg * to * go + to * to * gg) / det;
        let found = information(&samples, known);
        assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
    }

    #[test]
    fn more_known_is_more_information() {
        let samples = line(9);
        let mut before = 0.0;
        for sigma in [f64::INFINITY, 1.0, 1e-2, 1e-4, 0.0] {
            let known = LineKnown { sigma_gain: sigma, sigma_offset: 1e4 * sigma, level: 1e4 };
            let found = information(&samples, known);
            assert!(found >= before * (1.0 - 1e-12), "{sigma}: {found} {before}");
            before = found;
        }
        let clean: f64 = samples.iter().map(|s| s.derivative.powi(2) / s.var).sum();
        assert!((before / clean - 1.0).abs() < 1e-14);
    }
}
