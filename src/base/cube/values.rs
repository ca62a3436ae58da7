//! What stored numbers stand for: gain · number + offset by band, and numbers that mean that nothing was measured.

use super::Sample;

/// Gains, offsets and numbers for nothing; each one for all bands, or one for each.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Values {
    gain: Vec<f64>,
    offset: Vec<f64>,
    missing: Vec<f64>,
}

impl Values {
    /// None where the numbers are the samples themselves. Without a list a gain is 1 and an offset 0.
    pub(super) fn new(gain: Option<Vec<f64>>, offset: Option<Vec<f64>>, missing: Vec<f64>) -> Option<Self> {
        let or = |list: Option<Vec<f64>>, silent: f64| {
            list.filter(|list| !list.is_empty()).unwrap_or(vec![silent])
        };
        let (gain, offset) = (or(gain, 1.0), or(offset, 0.0));
        let same = gain.iter().all(|gain| *gain == 1.0) && offset.iter().all(|offset| *offset == 0.0);
        (!same || !missing.is_empty()).then_some(Self { gain, offset, missing })
    }

    /// The numbers that stand for nothing.
    pub(super) fn missing(&self) -> &[f64] {
        &self.missing
    }

    /// Samples out of what is stored, NaN where nothing was measured.
    pub(super) fn of_stored<S: Sample>(&self, samples: &mut [S], bands: usize) {
        let missing: Vec<S> = self.missing.iter().map(|value| S::of(*value)).collect();
        let of = |list: &[f64], band: usize| list.get(band).or(list.last()).copied().unwrap_or(f64::NAN);
        let lines: Vec<(f64, f64)> =
            (0..bands).map(|band| (of(&self.gain, band), of(&self.offset, band))).collect();
        for pixel in samples.chunks_mut(bands) {
            for (sample, (gain, offset)) in pixel.iter_mut().zip(&lines) {
                let value = match missing.contains(sample) {
                    true => f64::NAN,
                    false => gain * (*sample).into() + offset,
                };
                *sample = S::of(value);
            }
        }
    }
}
