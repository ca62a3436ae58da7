//! Derivative of the trigonometric interpolation of a row and its mirror image.
//!
//! The row of n pixels is followed by itself in reverse, a sequence with a period of 2n and no jump. Its discrete
//! Fourier coefficients are multiplied by iω_k, ω_k = πk/n for |k| < n (that of the Nyquist frequency is 0), and
//! transformed back. Two bands are transformed at once, as the real and the imaginary part.

use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};
use std::sync::Arc;

/// Transforms for rows of a certain length.
#[derive(Clone)]
pub(super) struct Fourier {
    columns: usize,
    forward: Arc<dyn Fft<f64>>,
    back: Arc<dyn Fft<f64>>,
    values: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

impl std::fmt::Debug for Fourier {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Fourier").field("columns", &self.columns).finish_non_exhaustive()
    }
}

impl Fourier {
    pub(super) fn new(columns: usize) -> Self {
        let mut planner = FftPlanner::new();
        let [forward, back] = [planner.plan_fft_forward(2 * columns), planner.plan_fft_inverse(2 * columns)];
        let scratch = forward.get_inplace_scratch_len().max(back.get_inplace_scratch_len());
        let zero = Complex::new(0.0, 0.0);
        Self { columns, forward, back, values: vec![zero; 2 * columns], scratch: vec![zero; scratch] }
    }

    pub(super) fn apply(&mut self, row: &[f64], bands: usize, slope: &mut [f64]) {
        let n = self.columns;
        for band in (0..bands).step_by(2) {
            let other = (band + 1).min(bands - 1);
            for x in 0..n {
                let value = Complex::new(row[x * bands + band], row[x * bands + other]);
                self.values[x] = value;
                self.values[2 * n - 1 - x] = value;
            }
            self.forward.process_with_scratch(&mut self.values, &mut self.scratch);
            // The inverse transform lacks a factor of 1/2n.
            let unit = std::f64::consts::PI / (n as f64 * 2.0 * n as f64);
            for k in 1..n {
                let omega = unit * k as f64;
                let [up, down] = [k, 2 * n - k];
                self.values[up] *= Complex::new(0.0, omega);
                self.values[down] *= Complex::new(0.0, -omega);
            }
            self.values[0] = Complex::new(0.0, 0.0);
            self.values[n] = Complex::new(0.0, 0.0);
            self.back.process_with_scratch(&mut self.values, &mut self.scratch);
            for (x, value) in self.values[..n].iter().enumerate() {
                slope[x * bands + band] = value.re;
                if other != band {
                    slope[x * bands + other] = value.im;
                }
            }
        }
    }
}
