//! The cube without its stripes.

use super::found::{Axis, Destriped, Stripe};
use hadar::cube::{Rows, Sample};
use hadar::error::Result;
use rayon::prelude::*;

impl Destriped {
    /// All samples `[row][column][band]`, those of striped lines corrected, all others bit by bit as they are.
    ///
    /// # Errors
    /// A cube that cannot be read.
    pub fn corrected<S: Sample>(&self, cube: &dyn Rows<S>) -> Result<Vec<S>> {
        let shape = cube.shape();
        let (rows, length, bands) = (shape.rows(), shape.row_len(), shape.bands());
        let mut of_line: Vec<&[Stripe]> = vec![&[]; self.lines];
        for own in self.stripes.chunk_by(|a, b| a.line == b.line) {
            if let Some(place) = own.first().and_then(|stripe| of_line.get_mut(stripe.line)) {
                *place = own;
            }
        }
        let put = |samples: &mut [S], stripes: &[Stripe]| {
            for stripe in stripes {
                for sample in samples.iter_mut().skip(stripe.band).step_by(bands) {
                    *sample = S::of(stripe.corrected((*sample).into()));
                }
            }
        };
        let mut all = vec![S::zeroed(); shape.len()];
        all.par_chunks_mut(length).enumerate().try_for_each_init(Vec::new, |buffer, (row, own)| {
            hadar::stop::check();
            own.copy_from_slice(cube.read(row..row + 1, buffer)?);
            match self.axis {
                Axis::Rows => put(own, of_line.get(row).copied().unwrap_or_default()),
                Axis::Columns => {
                    own.chunks_exact_mut(bands)
                        .zip(&of_line)
                        .for_each(|(pixel, stripes)| put(pixel, stripes));
                }
            }
            Ok(())
        })?;
        debug_assert_eq!(all.len(), rows * length);
        Ok(all)
    }

    /// A value of every line and band, `[line][band]`: that of its stripe, or that of a clean one.
    #[must_use]
    pub fn map(&self, clean: f64, value: impl Fn(&Stripe) -> f64) -> Vec<f32> {
        let mut map = vec![clean as f32; self.lines * self.bands];
        for stripe in &self.stripes {
            if let Some(place) = map.get_mut(stripe.line * self.bands + stripe.band) {
                *place = value(stripe) as f32;
            }
        }
        map
    }
}
