//! Variances against the bound, and errors that are there without noise.

use super::*;

/// Trials of 13 windows; the ratio of the variances of so many has the deviation √(2/5200) for normal errors.
const TRIALS: usize = 400;
const SIGMA: f64 = 0.0196;

/// 1/J of the windows of the left view by the sum itself; the texture's slope is exact.
fn one_view(texture: &Texture, var: f64) -> Vec<f64> {
    let shape = Shape::new(5, 200, 1).unwrap();
    let (counts, slopes) = (texture.view(shape, 0.0).unwrap(), texture.derivative(shape, 0.0).unwrap());
    let information = |centre: &Centre| {
        let pixels =
            (0..5).flat_map(|row| (centre.column - 2..centre.column + 3).map(move |x| row * 200 + x));
        pixels.map(|at| slopes[at] * slopes[at] / (counts[at] + var)).sum::<f64>()
    };
    centres(0.0).iter().map(|centre| 1.0 / information(centre)).collect()
}

/// Mean squared deviation, about the mean or else the truth, of every window over its bound.
fn ratios(matches: &Matches, bounds: &[f64], about_mean: bool) -> Vec<f64> {
    let of = |(window, bound): (usize, &f64)| {
        let found: Vec<f64> = matches.of(window).map(|found| found.unwrap()).collect();
        let n = found.len() as f64;
        let mean = if about_mean { found.iter().sum::<f64>() / n } else { matches.centres[window].disparity };
        let freedom = if about_mean { n - 1.0 } else { n };
        found.iter().map(|d| (d - mean) * (d - mean)).sum::<f64>() / freedom / bound
    };
    bounds.iter().enumerate().map(of).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// False alarm of each: 1e-3 (3.3 deviations), and 1 % for the systematic error of the interpolation.
#[test]
fn with_a_known_template_the_mean_square_error_is_the_bound() {
    let texture = Texture::random(3, &[1e5], 0.1, 0.25, 40).unwrap();
    for var in [0.0, 2e5] {
        let noise = NoiseVariance::Uniform(var);
        let matches = run(&texture, 1, 6.3, &noise, (Noisy::Left, likelihood(Interpolation::Sinc)), TRIALS);
        let ratio = mean(&ratios(&matches, &one_view(&texture, var), false));
        assert!((ratio - 1.0).abs() < 3.3 * SIGMA + 0.01, "{var}: {ratio}");
    }
}

/// The other view's window is moved, but has the same counts about it: 1/J_left + 1/J_right = 2/J_left. With
/// 1e6 photons a pixel the slope of the noise does not matter; with 1e4 it does, by ⟨(π²/3)/S⟩ = 0.051 at a
/// whole disparity (measured 0.06 to 0.07 with 13 000 matches). Chance: 3.3 deviations, 1e-3.
#[test]
fn with_both_views_noisy_strong_texture_reaches_the_bound_and_weak_does_not() {
    for (photons, disparity, low, high) in
        [(1e6, 6.0, 1.0, 1.0), (1e6, 6.5, 0.98, 1.0), (1e4, 6.0, 1.04, 1.25)]
    {
        let texture = Texture::random(3, &[photons], 0.1, 0.25, 40).unwrap();
        let how = (Noisy::Both, likelihood(Interpolation::Sinc));
        let matches = run(&texture, 1, disparity, &NoiseVariance::None, how, TRIALS);
        let bounds: Vec<f64> = one_view(&texture, 0.0).iter().map(|bound| 2.0 * bound).collect();
        let ratio = mean(&ratios(&matches, &bounds, true));
        assert!(ratio > low - 3.3 * SIGMA && ratio < high + 3.3 * SIGMA, "{photons} {disparity}: {ratio}");
    }
}

/// Block matching has a bias b(d), so its variance obeys (1 + b′)²/J, not 1/J, and is below 1/J at whole
/// disparities. b′ from matches without noise 0.04 pixels apart.
#[test]
fn block_matching_obeys_the_bound_of_its_own_bias() {
    let texture = Texture::random(3, &[1e6], 0.1, 0.25, 40).unwrap();
    let bounds: Vec<f64> = one_view(&texture, 0.0).iter().map(|bound| 2.0 * bound).collect();
    let matcher = Matcher::Block(Block::new(window()));
    for (disparity, below) in [(6.0, true), (6.25, true), (6.4, false)] {
        let of = |d: f64, trials| run(&texture, 1, d, &NoiseVariance::None, (Noisy::Both, matcher), trials);
        let [low, high] = [-0.02, 0.02].map(|step| of(disparity + step, 0).noise_free);
        let found = ratios(&of(disparity, TRIALS), &bounds, true);
        let relative: Vec<f64> = (found.iter().zip(low.iter().zip(&high)))
            .map(|(ratio, (low, high))| ratio / ((high.unwrap() - low.unwrap()) / 0.04).powi(2))
            .collect();
        assert!(mean(&relative) > 1.0 - 3.3 * SIGMA, "{disparity}: {relative:?}");
        assert_eq!(mean(&found) < 1.0 - 3.3 * SIGMA, below, "{disparity}: {found:?}");
    }
}
