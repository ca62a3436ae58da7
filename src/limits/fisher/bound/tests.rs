use super::*;

#[test]
fn a_plane_and_a_point_above_it() {
    // Columns (1,0,0), (1,1,0) and (3,4,5): what is left is 5; coefficients −1 and 4.
    let mut columns = [1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 3.0, 4.0, 5.0];
    let p = Projector::default().project(&mut columns, &[1.0; 3], 1.0);
    assert!((p.residual - 5.0).abs() < 1e-15 && (p.norm - 50f64.sqrt()).abs() < 1e-14);
    assert!((p.coefficients[0] + 1.0).abs() < 1e-15 && (p.coefficients[1] - 4.0).abs() < 1e-15);
    assert!(p.dropped.is_empty());
}

#[test]
fn zero_and_dependent_nuisances_are_dropped_and_reported() {
    let mut columns = [0.0, 0.0, 0.0, 1.0, 2.0, 3.0, -2e100, -4e100, -6e100, 3.0, 2.0, 1.0];
    let p = Projector::default().project(&mut columns, &[1.0; 3], 1.0);
    assert_eq!(p.dropped, [0, 2]);
    // |(3,2,1) − (10/14)(1,2,3)|² = 14 − 100/14.
    assert!((p.residual - (14.0 - 100.0 / 14.0_f64).sqrt()).abs() < 1e-15);
}

#[test]
fn the_scaled_condition_number_of_two_columns_is_that_of_their_angle() {
    let angle: f64 = 1e-3;
    let mut columns = [1e9, 0.0, 1e-7 * angle.cos(), 1e-7 * angle.sin()];
    let p = Projector::default().project(&mut columns, &[1.0; 2], 1.0);
    let exact = ((1.0 + angle.cos()) / (1.0 - angle.cos())).sqrt();
    assert!((p.condition_number() / exact - 1.0).abs() < 1e-6);
}

/// Columns with a known answer: (1, t, t²) on t = −n…n with weight 1. What is left of t² is t² − ⟨t²⟩, so
/// the residual is √(Σt⁴ − (Σt²)²/N) with N = 2n + 1, Σt² = n(n+1)N/3, Σt⁴ = Σt²(3n² + 3n − 1)/5.
fn parabola(n: i32, scales: [f64; 3]) -> (Vec<f64>, f64) {
    let t = || (-n..=n).map(f64::from);
    let columns =
        t().map(|_| scales[0]).chain(t().map(|t| scales[1] * t)).chain(t().map(|t| scales[2] * t * t));
    let (half, count) = (f64::from(n), f64::from(2 * n + 1));
    let second = half * (half + 1.0) * count / 3.0;
    let fourth = second * (3.0 * half * half + 3.0 * half - 1.0) / 5.0;
    (columns.collect(), scales[2] * (fourth - second * second / count).sqrt())
}

/// Tolerance 8u: two sums, a square root and their squares, whatever the number of rows and the scales.
#[test]
fn widely_different_scales_cost_no_digits() {
    for n in [3, 31, 268, 5000] {
        for scales in [[1.0, 1.0, 1.0], [1e-60, 1e50, 3.0], [7e40, 1e-90, 1e-30]] {
            let (mut columns, exact) = parabola(n, scales);
            let weights = vec![1.0; 2 * n as usize + 1];
            let p = Projector::default().project(&mut columns, &weights, 1.0);
            let error = (p.residual / exact - 1.0).abs();
            assert!(error < 8.0 * UNIT_ROUNDOFF, "{n} {scales:?}: {error:e}");
            assert!(p.dropped.is_empty() && error <= p.relative_error);
        }
    }
}

/// Any number of columns, past what is worked on together: the identity's last column keeps length 1.
#[test]
fn many_columns_are_no_special_case() {
    for count in 1..12 {
        let rows = 2 * count + 5;
        let mut columns = vec![0.0; count * rows];
        for i in 0..count {
            // Lower triangle of ones: the last is what the others leave of it, a single 1 in length.
            columns[i * rows..i * rows + i + 1].fill(1.0);
        }
        let p = Projector::default().project(&mut columns, &vec![1.0; rows], 1.0);
        assert!(
            (p.residual - 1.0).abs() < 1e-14 && (p.norm - (count as f64).sqrt()).abs() < 1e-14,
            "{count}"
        );
    }
}

proptest::proptest! {
    /// Powers of two change no bit of the residual; other factors some ulp of what is projected away.
    #[test]
    fn scaling_a_column_changes_nothing(
        seed in proptest::collection::vec(-1.0..1.0_f64, 4 * 37),
        powers in proptest::array::uniform3(-200..200_i32),
        factors in proptest::array::uniform3(1e-3..1e3_f64),
    ) {
        let weights: Vec<f64> = seed[..37].iter().map(|w| 1.5 + w).collect();
        let project = |scale: &dyn Fn(usize) -> f64| {
            let mut columns: Vec<f64> = seed.iter().enumerate().map(|(i, x)| x * scale(i / 37)).collect();
            Projector::default().project(&mut columns, &weights, 1.0)
        };
        let plain = project(&|_| 1.0);
        let shifted = project(&|i| powers.get(i).map_or(1.0, |&power| f64::from(power).exp2()));
        proptest::prop_assert_eq!(plain.residual.to_bits(), shifted.residual.to_bits());
        proptest::prop_assert_eq!(plain.norm.to_bits(), shifted.norm.to_bits());
        proptest::prop_assert_eq!(plain.relative_error.to_bits(), shifted.relative_error.to_bits());
        let scaled = project(&|i| factors.get(i).copied().unwrap_or(1.0));
        let bound = 4.0 * f64::EPSILON + plain.relative_error;
        proptest::prop_assert!((scaled.residual / plain.residual - 1.0).abs() <= bound);
    }
}
