//! Numbers of a picture in memory, as a cube.

use super::arrange;
use super::axes::Axes;
use super::found::{Found, Opened};
use super::stored::Stored;
use super::values::Values;
use hadar::cube::{Cube, MemoryCube, Sample, Shape};
use hadar::error::Result;

/// Numbers in an order of axes, with what they stand for.
#[derive(Debug)]
pub(super) struct Image {
    pub(super) format: &'static str,
    pub(super) shape: Shape,
    /// Outermost first.
    pub(super) order: Axes,
    pub(super) stored: Stored,
    pub(super) numbers: Vec<f64>,
    pub(super) values: Option<Values>,
}

impl Image {
    /// The cube, `f64` where its numbers need that.
    pub(super) fn opened(self, sides: &[usize]) -> Result<Opened> {
        let found = Found::array(self.format, self.shape, self.stored.name(), sides);
        let bytes = self.shape.len() as u64 * if self.stored.is_double() { 8 } else { 4 };
        let mut found = Found { memory_bytes: Some(bytes), ..found };
        self.values.iter().for_each(|values| values.tell(&mut found));
        let cube = match self.stored.is_double() {
            true => self.cube::<f64>().map(Cube::from),
            false => self.cube::<f32>().map(Cube::from),
        }?;
        Ok(Opened { cube, found })
    }

    fn cube<S: Sample>(self) -> Result<MemoryCube<S>> {
        let mut rest = self.numbers.as_slice();
        let mut samples = arrange::whole(self.shape, self.order, |out: &mut [S]| {
            let (numbers, after) = rest.split_at(out.len().min(rest.len()));
            rest = after;
            out.iter_mut().zip(numbers).for_each(|(sample, number)| *sample = S::of(*number));
            Ok(())
        })?;
        if let Some(values) = &self.values {
            values.of_stored(&mut samples, self.shape.bands());
        }
        MemoryCube::new(self.shape, samples)
    }
}
