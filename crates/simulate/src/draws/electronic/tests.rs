use super::*;
use hadar::statistics::Statistics;

fn noise(bands: usize) -> ElectronicNoise {
    let flicker = Flicker::new(0.01, 100.0, 2).unwrap();
    ElectronicNoise::new(&vec![3.0; bands], &vec![1.0; bands], &vec![16.0; bands], flicker).unwrap()
}

/// Double sum over pairs of frames, also where nothing has relaxed.
#[test]
fn the_variance_of_an_average_is_the_mean_of_the_covariances() {
    let flicker = Flicker::new(1e-2, 1e3, 2).unwrap();
    for (frames, spacing) in [(1, 0.1), (2, 0.1), (50, 0.03), (50, 1e-6), (50, 1e-9), (7, 1e5), (200, 0.0)] {
        let m = f64::from(frames);
        let pairs = (0..frames).flat_map(|i| (0..frames).map(move |j| f64::from(i) - f64::from(j)));
        let exact = pairs.map(|lag| flicker.covariance(lag * spacing)).sum::<f64>() / (m * m);
        let found = flicker.var_average(frames, spacing);
        assert!((found / exact - 1.0).abs() < 1e-11, "{frames} {spacing}: {found} {exact}");
    }
}

/// 1/[f ln(τ_max/τ_min)] within the ends; all of the spectrum is the variance.
#[test]
fn the_spectrum_falls_like_one_over_f() {
    for (per_decade, tolerance) in [(1, 0.25), (2, 0.04), (5, 1e-2)] {
        let flicker = Flicker::new(1e-4, 1e4, per_decade).unwrap();
        for k in -20..=20 {
            let f = 10_f64.powf(f64::from(k) / 10.0) / std::f64::consts::TAU;
            let found = flicker.spectrum(f) * f * (1e8_f64).ln();
            assert!((found - 1.0).abs() < tolerance, "{per_decade} {f}: {found}");
        }
        let log_step = 1e-2;
        let steps = (-2500..2500).map(|k| (f64::from(k) * log_step).exp());
        let all: f64 = steps.map(|f| flicker.spectrum(f) * f * log_step).sum();
        assert!((all - 1.0).abs() < 1e-3, "{all}");
    }
}

/// Variance of a reading, covariances at several unequal spacings, variance of an average: 4 comparisons, 4.5
/// deviations each (by chance 7e-6), over 40 000 independent bands.
#[test]
fn frames_have_the_covariance_that_is_told() {
    let bands = 40_000;
    let draws = Draws::new(&Statistics::Poisson, &vec![9.0; bands]).unwrap();
    let noise = noise(bands);
    let mut frames = Frames::new(draws, noise.clone(), 4, 2).unwrap();
    let spacings = [0.0, 0.05, 2.0];
    let mut readings = vec![vec![0.0; bands]; 3];
    for (reading, spacing) in readings.iter_mut().zip(spacings) {
        frames.next_into(spacing, reading).unwrap();
    }
    let n = bands as f64;
    let product = |i: usize, j: usize| {
        let products = readings[i].iter().zip(&readings[j]).map(|(a, b)| (a - 9.0) * (b - 9.0));
        let (sum, square) = products.fold((0.0, 0.0), |(s, q), x| (s + x, q + x * x));
        (sum / n, ((square / n - (sum / n).powi(2)) / n).sqrt())
    };
    // 9 of the photons, 4 white, 16 flicker.
    for (i, j, exact) in [
        (2, 2, 9.0 + noise.var_reading()[0]),
        (0, 1, noise.covariance(0, 0.05)),
        (1, 2, noise.covariance(0, 2.0)),
        (0, 2, noise.covariance(0, 2.05)),
    ] {
        let (found, deviation) = product(i, j);
        assert!((found - exact).abs() < 4.5 * deviation, "{i} {j}: {found} {exact} {deviation}");
    }
    assert!(noise.covariance(0, 2.0) < 0.7 * noise.covariance(0, 0.05));
}

/// Averages of 30 frames, variance within 4.5 deviations (by chance 7e-6).
#[test]
fn an_average_of_frames_keeps_the_flicker() {
    let bands = 20_000;
    let noise = noise(bands);
    let draws = Draws::new(&Statistics::Poisson, &vec![0.0; bands]).unwrap();
    let mut frames = Frames::new(draws, noise.clone(), 9, 0).unwrap();
    let (mut sums, mut reading) = (vec![0.0; bands], vec![0.0; bands]);
    for _ in 0..30 {
        frames.next_into(0.04, &mut reading).unwrap();
        sums.iter_mut().zip(&reading).for_each(|(sum, value)| *sum += value / 30.0);
    }
    let found = sums.iter().map(|x| x * x).sum::<f64>() / bands as f64;
    let exact = noise.var_average(0, 30, 0.04);
    assert!((found / exact - 1.0).abs() < 4.5 * (2.0 / bands as f64).sqrt(), "{found} {exact}");
    // Were frames independent, it would be this.
    assert!(exact > 5.0 * noise.var_reading()[0] / 30.0);
}

#[test]
fn first_frames_stay_and_impossible_noise_is_refused() {
    let draws = Draws::new(&Statistics::Poisson, &[9.0, 100.0]).unwrap();
    let mut frames = Frames::new(draws.clone(), noise(2), 20, 7).unwrap();
    let mut reading = [0.0; 2];
    frames.next_into(0.0, &mut reading).unwrap();
    let first = reading;
    frames.next_into(0.1, &mut reading).unwrap();
    assert_eq!(first, [12.769_774_260_204_906, 92.212_494_089_568_65]);
    assert_eq!(reading, [16.063_655_183_985_556, 71.731_437_168_409_13]);
    assert!(
        frames.next_into(-1.0, &mut reading).is_err() && frames.next_into(f64::NAN, &mut reading).is_err()
    );
    assert!(Frames::new(draws, noise(3), 1, 1).is_err());
    let flicker = Flicker::new(1.0, 1.0, 1).unwrap();
    assert_eq!(flicker.relaxation_s(), [1.0]);
    for (var, other) in [([-1.0], [1.0]), ([f64::NAN], [1.0]), ([f64::MAX], [f64::MAX])] {
        assert!(ElectronicNoise::new(&var, &other, &[0.0], flicker.clone()).is_err());
    }
    assert!(ElectronicNoise::new(&[1.0], &[1.0, 2.0], &[1.0], flicker).is_err());
    for (shortest, longest, per_decade) in
        [(0.0, 1.0, 2), (2.0, 1.0, 2), (1.0, f64::INFINITY, 2), (1.0, 2.0, 0), (f64::NAN, 1.0, 1)]
    {
        assert!(Flicker::new(shortest, longest, per_decade).is_err());
    }
}
