//! Bands whose lines all differ from those beside them, by what other bands do not show: stripes that fill a band.
//!
//! Where every line has a gain or an offset of its own, the lines scatter about each other by nothing but stripes, and none stands out. What
//! is real on a line is in the bands beside too. From a line to the next, segment s of a band changes by the share j_s of the band's level; the
//! median of the same shares in up to [`REACH`] bands on each side is r_s. A step is the band's **own** where the mean of j − r over the
//! segments is beyond [`SURE`] times its error, and beyond [`OWN`] times the larger of the two steps, so that what a scene does a
//! little differently in each band does not count. A stripe makes two steps: where more than [`MOST`] of all steps are a band's own, about
//! half of its lines are striped or more.

use super::segments::Segments;

/// Bands on each side that a step is held against.
const REACH: usize = 3;
/// Fewest of them.
const FEWEST: usize = 2;
/// Errors that a step must be beyond.
const SURE: f64 = 4.0;
/// Share of a step that must be the band's own.
const OWN: f64 = 0.3;
/// Share of the steps from which on stripes fill a band.
const MOST: f64 = 0.7;
/// Rounding of samples of 32 bits, relative.
const ROUNDING: f64 = 1e-6;

/// The first band that is filled with stripes, and the median of its own steps, as a share of its level.
pub(super) fn filled(segments: &Segments, levels: &[f64]) -> Option<(usize, f64)> {
    let bands = levels.len();
    (FEWEST..bands.saturating_sub(FEWEST)).find_map(|band| {
        let reach = REACH.min(band).min(bands - 1 - band);
        let mut own: Vec<f64> = Vec::new();
        let mut steps = 0_usize;
        for line in 1..segments.lines {
            let share = |segment: usize, b: usize| {
                (segments.mean(line, segment, b) - segments.mean(line - 1, segment, b)) / levels[b].abs()
            };
            let mut sums = [0.0; 4];
            for segment in 0..segments.count {
                let mut beside: Vec<f64> = (band - reach..=band + reach)
                    .filter(|b| *b != band)
                    .map(|b| share(segment, b))
                    .filter(|x| x.is_finite())
                    .collect();
                let step = share(segment, band);
                if !step.is_finite() || beside.len() < 2 * FEWEST {
                    continue;
                }
                beside.sort_by(f64::total_cmp);
                let told = 0.5 * (beside[(beside.len() - 1) / 2] + beside[beside.len() / 2]);
                let apart = step - told;
                for (sum, x) in sums.iter_mut().zip([1.0, apart, apart * apart, step]) {
                    *sum += x;
                }
            }
            let [n, apart, squares, step] = sums;
            if 2.0 * n < segments.count as f64 || n < 3.0 {
                continue;
            }
            steps += 1;
            let (mean, step) = (apart / n, step / n);
            let error = ((squares / n - mean * mean).max(0.0) / (n - 1.0)).sqrt();
            let larger = step.abs().max((step - mean).abs());
            if mean.abs() > (SURE * error).max(OWN * larger).max(ROUNDING) {
                own.push(mean.abs());
            }
        }
        own.sort_by(f64::total_cmp);
        let is_filled = steps > 0 && own.len() as f64 > MOST * steps as f64;
        is_filled.then(|| (band, own[own.len() / 2]))
    })
}
