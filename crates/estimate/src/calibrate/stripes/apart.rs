//! By how much the lines of a band differ from what those beside them lead to expect, and how much of that noise explains.
//!
//! Of the means m of the segments of a line, a smooth scene leaves nothing of
//!
//! d = m₀ − [4 (m₋₁ + m₁) − (m₋₂ + m₂)]/6,
//!
//! while lines that are off each for itself by g leave √(1 + 34/36) g. With d̄ the mean over the segments of a line and e its standard error by
//! their scatter (noise, and texture along the line), the medians of |d̄| and of e over the lines tell both: one edge or one stripe among
//! many lines does not count. Where 1.4826 median(|d̄|/e) of all bands exceeds 1 beyond chance, structure of the scene from line to line, or
//! stripes of every line, are there, and nothing in one cube tells which.
//!
//! Units: those of the cube; shares of the level of the band in what is given back.

use super::fit::median;
use super::found::Apart;
use super::scan::Band;

/// Weight of independent lines in d².
const OF_LINES: f64 = 1.0 + 34.0 / 36.0;
const PER_MEDIAN: f64 = 1.482_602;
/// Fewest lines, and segments of a line, that say something.
const FEWEST: [usize; 2] = [8, 6];
/// Deviations that are no chance.
const SURE: f64 = 5.0;
/// Variance of a squared robust scatter over its square, times the lines; neighbouring d share lines, so that half of them count.
const OF_SCATTER: f64 = 4.0 * 1.36 * 2.0;

/// Of every band; `None` of too few lines.
pub(super) fn apart(bands: &[Band], lines: usize) -> Vec<Option<Apart>> {
    let seen: Vec<Vec<[f64; 2]>> = bands.iter().map(|band| differences(band, lines)).collect();
    let enough = |seen: &&Vec<[f64; 2]>| seen.len() >= FEWEST[0];
    let mut all: Vec<f64> =
        seen.iter().filter(enough).flatten().map(|[off, error]| off / error.max(f64::MIN_POSITIVE)).collect();
    let most = 1.0 + SURE * (OF_SCATTER / all.len().max(1) as f64).sqrt();
    // Lines of all bands together, so that no band of many is taken by chance.
    let differ = (PER_MEDIAN * median(&mut all)).powi(2) > most;
    let of_band = |(seen, band): (&Vec<[f64; 2]>, &Band)| {
        let of = |i: usize| median(&mut seen.iter().map(|pair| pair[i]).collect::<Vec<f64>>());
        let (scatter, noise) = (PER_MEDIAN * of(0), of(1));
        let beyond = if differ { (scatter * scatter - noise * noise).max(0.0) } else { 0.0 };
        let share = |var: f64| (var / OF_LINES).sqrt() / band.level.abs();
        let found = Apart { lines: share(beyond), noise: share(noise * noise) };
        (enough(&seen) && found.lines.is_finite() && found.noise.is_finite()).then_some(found)
    };
    seen.iter().zip(bands).map(of_band).collect()
}

/// |d̄| and e of the lines of a band.
fn differences(band: &Band, lines: usize) -> Vec<[f64; 2]> {
    let mut seen = Vec::new();
    for line in 2..lines.saturating_sub(2) {
        let of = |at: usize, segment: usize| band.means(at).get(segment).copied().unwrap_or(f64::NAN);
        let (mut count, mut sum, mut square) = (0.0_f64, 0.0, 0.0);
        for i in 0..band.means(line).len() {
            let near = of(line - 1, i) + of(line + 1, i);
            let d = of(line, i) - (4.0 * near - of(line - 2, i) - of(line + 2, i)) / 6.0;
            if d.is_finite() {
                (count, sum, square) = (count + 1.0, sum + d, square + d * d);
            }
        }
        if count >= FEWEST[1] as f64 {
            let mean = sum / count;
            let var = (square / count - mean * mean).max(0.0) / (count - 1.0);
            seen.push([mean.abs(), var.sqrt()]);
        }
    }
    seen
}

#[cfg(test)]
mod tests {
    use super::super::found::Axis;
    use super::super::scan::striped;
    use super::super::segments::Segments;
    use super::*;
    use crate::calibrate::twin::normal;
    use hadar::cube::{MemoryCube, Shape};
    use hadar::random::generator;

    const COLUMNS: usize = 96;

    /// A smooth scene of the level 1000 whose rows have gains, with noise.
    fn of(gains: &[f64], sigma: f64, seed: u64) -> Apart {
        let mut rng = generator(seed, 0);
        let mut samples = Vec::new();
        for (row, gain) in gains.iter().enumerate() {
            let (y, rows) = (row as f64, gains.len() as f64);
            for column in 0..COLUMNS {
                let scene = 1000.0 + 40.0 * libm::sin(6.0 * y / rows) + 0.2 * column as f64;
                samples.push(gain * scene + sigma * normal(&mut rng));
            }
        }
        let cube = MemoryCube::new(Shape::new(gains.len(), COLUMNS, 1).unwrap(), samples).unwrap();
        let segments = Segments::of(&cube, Axis::Rows).unwrap();
        apart(&[striped(&segments, 0, 0.1)], gains.len())[0].unwrap()
    }

    /// By hand: of gains 1 + g and 1 − g in turn every d is 8/3 g, 1.4826 of which over √(35/18) are g as independent lines would have it.
    #[test]
    fn lines_that_alternate_differ_by_what_a_hand_says() {
        let gains: Vec<f64> = (0..200).map(|row| if row % 2 == 0 { 1.01 } else { 0.99 }).collect();
        let found = of(&gains, 0.0, 1);
        let hand = 1.482_602 * 8.0 / 3.0 * 0.01 / (35.0_f64 / 18.0).sqrt();
        assert!((found.lines / hand - 1.0).abs() < 0.01, "{} {hand}", found.lines);
    }

    /// What noise explains is the noise of a mean of 96 samples, as d has it, and lines of a smooth scene without gains do not differ.
    #[test]
    fn noise_alone_is_no_difference() {
        let found = of(&[1.0; 4000], 5.0, 2);
        let hand = 5.0 / (COLUMNS as f64).sqrt() / 1009.5;
        assert_eq!(found.lines, 0.0);
        // The median of standard errors of six segments is 7 % below their root mean square.
        assert!((found.noise / hand - 0.933).abs() < 0.02, "{} {hand}", found.noise);
        let seeds = (0..40).filter(|seed| of(&[1.0; 80], 5.0, 10 + seed).lines > 0.0).count();
        assert!(seeds <= 1, "{seeds}");
    }

    /// Gains of all lines, drawn: as large as they were, and seen in a cube of 80 lines where they are three times the noise of a line.
    #[test]
    fn stripes_of_every_line_are_seen() {
        let mut rng = generator(3, 0);
        let gains: Vec<f64> = (0..4000).map(|_| 1.0 + 0.01 * normal(&mut rng)).collect();
        let found = of(&gains, 5.0, 4);
        assert!((found.lines / 0.01 - 1.0).abs() < 0.05, "{}", found.lines);
        let seen = (0..40).filter(|first| of(&gains[80 * first..80 * first + 80], 30.0, 5).lines > 0.0);
        assert!(seen.count() >= 38);
    }
}
