//! Probabilities and information against 30-digit references.

use hadar::identifiability::detection;

/// One row: d and the three answers, each rounded once to `f64` (u = 1.1e-16).
fn rows() -> Option<Vec<[f64; 4]>> {
    let rows = hadar_testing::reference_rows("detection.csv")?;
    let number = |cell: &String| cell.parse::<f64>().unwrap();
    Some(rows.iter().map(|row| [0, 1, 2, 3].map(|column| number(&row[column]))).collect())
}

fn relative(value: f64, exact: f64) -> f64 {
    if value == exact { 0.0 } else { (value / exact - 1.0).abs() }
}

/// Tolerance 1e-15·(10 + d²): a rounding of d alone moves the tail by d² u, the rest is a handful of operations. It is
/// a relative one throughout, so the miss probability must hold its digits at 5.7e-300 and the information
/// at 1.2e-12 bit.
#[test]
fn probabilities_and_information_agree_with_thirty_digit_references() {
    let Some(rows) = rows() else { return };
    assert!(rows.len() >= 14);
    for [d, probability, miss, bits] in rows {
        let tolerance = 1e-15 * (10.0 + d * d);
        for (name, value, exact) in [
            ("detection probability", detection::probability(d), probability),
            ("miss probability", detection::miss_probability(d), miss),
            ("information", detection::information_bits(d), bits),
        ] {
            let error = relative(value, exact);
            println!("d = {d:<6} {name:21} error {error:.1e} = {:.2} of the tolerance", error / tolerance);
            assert!(error <= tolerance, "d = {d}: {name} is {value:e}, not {exact:e}: {error:e}");
        }
    }
}

/// The two tails belong together: Φ(d) = 1 − Φ(−d), with the same function on both sides of 0.
#[test]
fn the_tails_are_each_others_mirror() {
    let Some(rows) = rows() else { return };
    for [d, _, miss, _] in rows {
        let error = relative(detection::probability(-d), miss);
        assert!(error <= 1e-15 * (10.0 + d * d), "d = {d}: {error:e}");
    }
}
