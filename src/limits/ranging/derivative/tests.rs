use super::*;

/// Slopes of a row of one band, with the columns at its ends left out.
fn slopes(scheme: Derivative, row: &[f64]) -> Vec<f64> {
    let mut slope = vec![0.0; row.len() - 2 * scheme.margin()];
    Differentiator::new(scheme, row.len()).unwrap().apply(row, 1, &mut slope).unwrap();
    slope
}

#[test]
fn sinusoids_come_out_as_the_closed_form_says() {
    let n = 200;
    for scheme in [Derivative::Central, Derivative::Simoncelli, Derivative::CubicSpline] {
        for omega in [0.05, 0.3, 1.0, 2.0, 3.0] {
            let row: Vec<f64> = (0..n).map(|x| (omega * f64::from(x)).sin()).collect();
            let slope = slopes(scheme, &row);
            let response = scheme.response(omega).unwrap();
            // 40 columns from the ends, what the spline is off there has fallen by (2 - sqrt 3)^40 = 1e-23.
            for x in 40..160 {
                let expected = response * omega * (omega * x as f64).cos();
                assert!(
                    (slope[x - scheme.margin()] - expected).abs() < 1e-13 * omega.max(1.0),
                    "{scheme:?} {omega} {x}"
                );
            }
        }
    }
    for k in [1, 7, 150, 199] {
        // The cosines that are level half a pixel beyond the ends are exact all along.
        let omega = PI * f64::from(k) / f64::from(n);
        let row: Vec<f64> = (0..n).map(|x| (omega * (f64::from(x) + 0.5)).cos()).collect();
        for (x, slope) in slopes(Derivative::Fourier, &row).iter().enumerate() {
            let expected = -omega * (omega * (x as f64 + 0.5)).sin();
            assert!((slope - expected).abs() < 1e-12, "{k} {x}");
        }
    }
}

#[test]
fn polynomials_are_exact_up_to_the_degree_that_is_said() {
    for n in [4, 5, 6, 30] {
        let place = |x: usize| (x as f64 - 7.0) / 10.0;
        let row: Vec<f64> =
            (0..n).map(|x| 2.0 - place(x) + place(x).powi(2) - 3.0 * place(x).powi(3)).collect();
        for (x, slope) in slopes(Derivative::CubicSpline, &row).iter().enumerate() {
            let expected = (-1.0 + 2.0 * place(x) - 9.0 * place(x).powi(2)) / 10.0;
            assert!((slope - expected).abs() < 1e-13, "{n} {x}: {slope} {expected}");
        }
        let row: Vec<f64> = (0..n).map(|x| 2.0 - place(x) + place(x).powi(2)).collect();
        for (x, slope) in slopes(Derivative::Central, &row).iter().enumerate() {
            assert!((slope - (-1.0 + 2.0 * place(x + 1)) / 10.0).abs() < 1e-14);
        }
    }
}

#[test]
fn bands_do_not_mix() {
    let bands = [3.0, -1.0, 0.5];
    let row: Vec<f64> = (0..36).map(|i| bands[i % 3] * ((i / 3) as f64).powi(2)).collect();
    for scheme in Derivative::ALL {
        let mut slope = vec![0.0; 36 - 6 * scheme.margin()];
        Differentiator::new(scheme, 12).unwrap().apply(&row, 3, &mut slope).unwrap();
        let single: Vec<f64> = (0..12).map(|x| f64::from(x * x)).collect();
        for (i, expected) in slopes(scheme, &single).iter().enumerate() {
            for b in 0..3 {
                assert!((slope[3 * i + b] - bands[b] * expected).abs() < 1e-11, "{scheme:?}");
            }
        }
    }
}

#[test]
fn responses_have_their_limits() {
    let low = Derivative::ALL.map(|scheme| scheme.response(0.0).unwrap());
    assert_eq!(low[0], 1.0);
    // 2 (0.276691 + 2 x 0.109604)
    assert!((low[1] - 0.991_798).abs() < 1e-12);
    assert_eq!(low[2..], [1.0, 1.0]);
    for scheme in Derivative::ALL {
        assert!(scheme.response(PI).unwrap().abs() < 1e-15);
        assert!(scheme.response(3.2).is_err());
        assert!(Differentiator::new(scheme, 1).is_err());
    }
    // Of the image smoothed by their prefilter the five taps are right to 2 % up to a third of the sampling frequency.
    let smoothing =
        |omega: f64| 0.426_375 + 2.0 * (0.249_153 * omega.cos() + 0.037_659 * (2.0 * omega).cos());
    for omega in [0.1, 0.5, 1.0, 1.5, 2.0] {
        let of_smoothed = Derivative::Simoncelli.response(omega).unwrap() / smoothing(omega);
        assert!((of_smoothed - 1.0).abs() < 0.02, "{omega}");
        assert!(
            (Derivative::Central.relative_error(omega).unwrap() - (omega.sin() / omega - 1.0)).abs() < 1e-15
        );
    }
}
