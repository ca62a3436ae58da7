//! What stored numbers stand for: gain · number + offset by band, and numbers that mean that nothing was measured.

use super::found::Found;
use hadar::cube::Sample;

/// All numbers are valid.
pub(super) const ALL_VALID: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// Gains, offsets and numbers for nothing; each one for all bands, or one for each.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Values {
    gain: Vec<f64>,
    offset: Vec<f64>,
    missing: Vec<f64>,
    /// Least and largest of the numbers that mean something.
    valid: [f64; 2],
}

impl Values {
    /// None where the numbers are the samples themselves. Without a list a gain is 1 and an offset 0.
    pub(super) fn new(
        gain: Option<Vec<f64>>,
        offset: Option<Vec<f64>>,
        missing: Vec<f64>,
        valid: [f64; 2],
    ) -> Option<Self> {
        let or = |list: Option<Vec<f64>>, silent: f64| {
            list.filter(|list| !list.is_empty()).unwrap_or(vec![silent])
        };
        let (gain, offset) = (or(gain, 1.0), or(offset, 0.0));
        let same = gain.iter().all(|gain| *gain == 1.0) && offset.iter().all(|offset| *offset == 0.0);
        let all = missing.is_empty() && valid == ALL_VALID;
        (!same || !all).then_some(Self { gain, offset, missing, valid })
    }

    /// Puts what is made of the numbers into what is said of the file.
    pub(super) fn tell(&self, found: &mut Found) {
        let unless = |list: &[f64], silent: f64| match list.iter().all(|value| *value == silent) {
            true => Vec::new(),
            false => list.to_vec(),
        };
        found.missing.clone_from(&self.missing);
        (found.gain, found.offset) = (unless(&self.gain, 1.0), unless(&self.offset, 0.0));
        found.valid = (self.valid != ALL_VALID).then_some(self.valid);
    }

    /// Samples out of what is stored, NaN where nothing was measured.
    pub(super) fn of_stored<S: Sample>(&self, samples: &mut [S], bands: usize) {
        let missing: Vec<S> = self.missing.iter().map(|value| S::of(*value)).collect();
        let [least, most] = self.valid.map(S::of);
        let of = |list: &[f64], band: usize| list.get(band).or(list.last()).copied().unwrap_or(f64::NAN);
        let lines: Vec<(f64, f64)> =
            (0..bands).map(|band| (of(&self.gain, band), of(&self.offset, band))).collect();
        for pixel in samples.chunks_mut(bands) {
            for (sample, (gain, offset)) in pixel.iter_mut().zip(&lines) {
                let is_valid = (least..=most).contains(sample) && !missing.contains(sample);
                let value = if is_valid { gain * (*sample).into() + offset } else { f64::NAN };
                *sample = S::of(value);
            }
        }
    }
}
