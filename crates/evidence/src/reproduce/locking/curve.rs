//! Pixel locking: the bias of a matcher as a function of the sub-pixel part of the true disparity.
//!
//! Of windows of a texture, at every disparity of a list: the mean error without noise (systematic), its root
//! mean square over the windows (a window's own error may be of either sign), and with noise the mean error
//! with its interval and the deviation of single matches about the mean of their window. Windows are drawn
//! together (a mean of all windows in every trial), so the interval of the bias is right though their searches
//! share samples.

use hadar::cube::Shape;
use hadar::error::{Error, Result};
use hadar::ranging::noise::NoiseVariance;
use hadar_simulate::efficiency::Errors;
use hadar_simulate::matching::report::OUTLIER;
use hadar_simulate::matching::texture::Texture;
use hadar_simulate::matching::trials::{Centre, Matches, MatchingTrials, Noisy, Run, Setup};
use hadar_simulate::matching::{Match, Matcher, Search, StereoPair};
use hadar_simulate::sequential::Interval;

/// At one disparity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LockingPoint {
    /// True disparity, pixels.
    pub(super) disparity: f64,
    /// Mean error without noise, pixels.
    pub(super) systematic: f64,
    /// Root mean square of it over the windows, pixels.
    pub(super) systematic_rms: f64,
    /// Mean error with noise, pixels.
    pub(super) bias: f64,
    /// Interval of it.
    pub(super) bias_interval: Interval,
    /// Deviation about the mean of each window, pixels.
    pub(super) deviation: f64,
    /// Share of matches that failed or were off by more than a pixel; they do not count in any of the above.
    pub(super) lost: f64,
}

/// What a locking curve is measured on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Locking<'a> {
    /// Texture of the windows.
    pub(super) texture: &'a Texture,
    /// Its bands.
    pub(super) bands: usize,
    /// Electronic noise.
    pub(super) noise: &'a NoiseVariance,
    /// Which views are noisy.
    pub(super) noisy: Noisy,
    /// The matcher.
    pub(super) matcher: Matcher,
    /// Windows, side by side.
    pub(super) windows: usize,
    /// Trials of each.
    pub(super) run: Run,
    /// Confidence level of intervals.
    pub(super) level: f64,
}

impl Locking<'_> {
    /// The curve at true `disparities`, each searched for ± 4 pixels about it.
    ///
    /// # Errors
    /// No windows, fewer than two trials, disparities that are not finite, noise that does not fit.
    pub(super) fn curve(&self, disparities: &[f64]) -> Result<Vec<LockingPoint>> {
        if self.windows == 0 || self.run.trials < 2 {
            let found = format!("{} windows, {} trials of each", self.windows, self.run.trials);
            return Err(Error::malformed(found, "give at least one window and two trials"));
        }
        disparities.iter().map(|disparity| self.point(*disparity)).collect()
    }

    fn point(&self, disparity: f64) -> Result<LockingPoint> {
        // Only the sub-pixel part matters: the texture is the same at any whole disparity.
        let whole = disparity.floor();
        let part = disparity - whole;
        let window = self.matcher.window();
        let edge = window.half_columns() + 24;
        let columns = self.windows * window.columns() + 2 * edge;
        let shape = Shape::new(window.rows(), columns, self.bands)?;
        let (left, right) = (self.texture.view(shape, 0.0)?, self.texture.view(shape, part)?);
        let centre = |i: usize| Centre {
            row: window.half_rows(),
            column: edge + window.half_columns() + i * window.columns(),
            disparity: part,
        };
        let centres: Vec<Centre> = (0..self.windows).map(centre).collect();
        let trials = MatchingTrials::new(&Setup {
            pair: &StereoPair::new(shape, &left, &right)?,
            noise: self.noise,
            noisy: self.noisy,
            matcher: self.matcher,
            search: Search::new(-4, 4)?,
            centres: &centres,
        })?;
        self.summary(&trials.run(self.run), part, whole)
    }

    fn summary(&self, matches: &Matches, part: f64, whole: f64) -> Result<LockingPoint> {
        let good = |found: &Option<f64>| found.is_some_and(|off| off.abs() <= OUTLIER);
        let error = |found: &Match| found.ok().map(|d| d - part).filter(|off| good(&Some(*off)));
        let free: Vec<f64> = matches.noise_free.iter().filter_map(error).collect();
        let all: Vec<Option<f64>> = matches.trials.iter().map(error).collect();
        let mean = |values: &[f64]| hadar::sum::sum(values) / values.len().max(1) as f64;
        let of_trials: Vec<f64> = (all.chunks(self.windows))
            .map(|trial| trial.iter().flatten().copied().collect::<Vec<f64>>())
            .filter(|errors| !errors.is_empty())
            .map(|errors| mean(&errors))
            .collect();
        if of_trials.len() < 2 {
            let found = format!("hardly any match at a disparity of {} pixels", part + whole);
            return Err(Error::malformed(found, "give a texture with more photons or contrast"));
        }
        let (mut squares, mut freedom) = (0.0, 0.0);
        for window in 0..self.windows {
            let own: Vec<f64> = all.iter().skip(window).step_by(self.windows).flatten().copied().collect();
            let centre = mean(&own);
            squares += own.iter().map(|off| (off - centre) * (off - centre)).sum::<f64>();
            freedom += own.len().saturating_sub(1) as f64;
        }
        let bias = Errors::of(&of_trials, 0.0, self.level)?;
        let lost = all.iter().filter(|found| found.is_none()).count();
        Ok(LockingPoint {
            disparity: part + whole,
            systematic: mean(&free),
            systematic_rms: (free.iter().map(|off| off * off).sum::<f64>() / free.len().max(1) as f64).sqrt(),
            bias: bias.bias,
            bias_interval: bias.bias_interval,
            deviation: if freedom > 0.0 { (squares / freedom).sqrt() } else { 0.0 },
            lost: lost as f64 / all.len().max(1) as f64,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hadar::ranging::information::Window;
    use hadar_simulate::matching::block::{Block, Fit};
    use hadar_simulate::matching::likelihood::{Interpolation, Likelihood};

    /// Largest mean errors over a period, measured, within 10 %; what noise adds is within its interval (99.9 %,
    /// two points).
    #[test]
    fn pixel_locking_is_that_of_the_fit() {
        let texture = Texture::random(3, &[1e5], 0.1, 0.25, 40).unwrap();
        let window = Window::new(5, 5).unwrap();
        let likelihood =
            |interpolation| Matcher::Likelihood(Likelihood { interpolation, ..Likelihood::new(window) });
        let blocks = |fit| Matcher::Block(Block { fit, ..Block::new(window) });
        for (matcher, amplitude) in [
            (blocks(Fit::Parabola), 0.0302),
            (likelihood(Interpolation::Sinc), 3.3e-4),
            (likelihood(Interpolation::CubicSpline), 2.95e-3),
        ] {
            let run = Run { index: 0, trials: 20, seed: 2 };
            let (bands, noise, noisy) = (1, &NoiseVariance::None, Noisy::Left);
            let locking =
                Locking { texture: &texture, bands, noise, noisy, matcher, windows: 100, run, level: 0.999 };
            let [rising, falling] = [0.2, 0.3, 0.7, 0.8]
                .map(|d| locking.curve(&[d]).unwrap()[0])
                .map(|point| {
                    assert!(point.lost == 0.0 && point.systematic.abs() <= point.systematic_rms);
                    let off = point.bias - point.systematic;
                    assert!(off.abs() < 4.0 * point.bias_interval.half_width(), "{point:?}");
                    point.systematic
                })
                .chunks(2)
                .map(|two| if two[0].abs() > two[1].abs() { two[0] } else { two[1] })
                .collect::<Vec<f64>>()
                .try_into()
                .unwrap();
            let found = 0.5 * (rising - falling).abs();
            assert!(rising * falling < 0.0 && (found / amplitude - 1.0).abs() < 0.1, "{found:.3e}");
        }
    }
}
