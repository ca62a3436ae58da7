//! A figure with the table of just what it shows.

use super::plot::{Axis, Figure};
use super::table::Table;
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
