//! A figure with the table of just what it shows.

use super::plot::{Axis, Figure};
use super::table::Table;
use hadar::spectrum::{Band, Bands};
use std::borrow::Cow;

/// A figure and the numbers in it.
#[derive(Debug, Clone)]
pub struct Plot {
    /// File name without ending.
    pub name: Cow<'static, str>,
    /// What is drawn.
    pub figure: Figure,
    /// What is drawn, as numbers.
    pub table: Table,
}

/// Wavelengths that are labelled above a wavenumber axis, µm.
const WAVELENGTHS_UM: [f64; 26] = [
    3.0, 3.5, 4.0, 4.5, 5.0, 5.5, 6.0, 6.5, 7.0, 7.5, 8.0, 8.5, 9.0, 9.5, 10.0, 10.5, 11.0, 12.0, 13.0, 14.0,
    15.0, 16.0, 18.0, 20.0, 25.0, 30.0,
];

/// Bits of information at the left, the probability of a right decision that they stand for at the right.
pub(crate) fn information_axis(title: &str) -> Axis {
    const SHARES: [f64; 8] = [0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99, 1.0];
    let ticks = SHARES.map(|share| ((2.0 * share).log2(), format!("{:.0} %", 100.0 * share)));
    Axis::linear(title).range(0.0, 1.05).secondary("correct decisions (%)", ticks.to_vec())
}

/// More bands than this are drawn as a curve through their centres.
const MOST_STEPS: usize = 30;

/// A value for each band as a curve: level across each of a few wide bands, through the centres of many.
pub(crate) fn over_bands(bands: &Bands, values: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let bands = bands.bands();
    if bands.len() > MOST_STEPS {
        return (bands.iter().map(|band| band.center_cm1).collect(), values.to_vec());
    }
    let level = |(band, value): (&Band, &f64)| {
        [(band.low_cm1, *value), (band.high_cm1, *value), (band.high_cm1, f64::NAN)]
    };
    bands.iter().zip(values).flat_map(level).unzip()
}

/// Wavenumbers below, wavelengths above, from the first edge of all bands to the last.
pub(crate) fn band_axis(bands: &Bands) -> Axis {
    let edges: Vec<f64> = bands.bands().iter().flat_map(|band| [band.low_cm1, band.high_cm1]).collect();
    wavenumber_axis(&edges)
}

/// Wavenumbers below, wavelengths above.
pub(crate) fn wavenumber_axis(wavenumbers_cm1: &[f64]) -> Axis {
    let low = wavenumbers_cm1.iter().copied().fold(f64::INFINITY, f64::min);
    let high = wavenumbers_cm1.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let mut ticks: Vec<(f64, String)> = WAVELENGTHS_UM
        .iter()
        .map(|um| (1e4 / um, format!("{um}")))
        .filter(|(at, _)| (low..=high).contains(at))
        .collect();
    // Too close together they would touch.
    let gap = 0.05 * (high - low);
    let mut last = f64::INFINITY;
    ticks.retain(|(at, _)| {
        let keep = last - at >= gap || last.is_infinite();
        if keep {
            last = *at;
        }
        keep
    });
    Axis::linear("wavenumber (cm⁻¹)").range(low, high).secondary("wavelength (µm)", ticks)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_bands_are_level_and_many_are_a_curve() {
        let bands = Bands::from_rows([(800.0, 1.0), (801.0, 1.0)]).unwrap();
        let (x, y) = over_bands(&bands, &[5.0, 7.0]);
        assert_eq!(x, [799.5, 800.5, 800.5, 800.5, 801.5, 801.5]);
        assert_eq!((y[0], y[1], y[3], y[4]), (5.0, 5.0, 7.0, 7.0));
        assert!(y[2].is_nan() && y[5].is_nan());
        let many = Bands::from_rows((0..100).map(|i| (800.0 + f64::from(i), 1.0))).unwrap();
        let values: Vec<f64> = (0..100).map(f64::from).collect();
        assert_eq!(over_bands(&many, &values), ((0..100).map(|i| 800.0 + f64::from(i)).collect(), values));
    }
}
