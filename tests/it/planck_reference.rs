//! Photon radiance against 30-digit references.

#[test]
fn photon_radiance_agrees_with_thirty_digit_references() {
    let Some(references) = hadar_testing::reference_rows("planck.csv") else { return };
    let mut worst: (f64, f64) = (0.0, 0.0);
    let mut rows = 0;
    for line in references {
        let v: Vec<f64> = line.iter().map(|cell| cell.parse().unwrap()).collect();
        let x = 1.438_776_877_503_933_8 * v[0] / v[1];
        // The bound of the specification: the input's own rounding costs x·u, the rest is a few ulp.
        let bound = 2e-16 * (10.0 + x);
        for (value, exact) in [
            (hadar::planck::photon_radiance(v[0], v[1]), v[2]),
            (hadar::planck::photon_radiance_slope(v[0], v[1]), v[3]),
        ] {
            if exact < 1e-290 {
                assert!(value >= 0.0 && value <= 1.001 * exact + f64::MIN_POSITIVE, "{line:?}: {value}");
                continue;
            }
            let error = (value / exact - 1.0).abs();
            assert!(error <= bound, "{line:?}: {value:e} is off by {error:e}, more than {bound:e}");
            if error / bound > worst.0 {
                worst = (error / bound, x);
            }
        }
        rows += 1;
    }
    assert!(rows > 20);
    println!("{rows} rows; worst error is {:.3} of the bound, at x = {}", worst.0, worst.1);
}
