//! Pixel locking: the bias of a matcher as a function of the sub-pixel part of the true disparity.
//!
//! Of windows of a texture, at every disparity of a list: the mean error without noise (systematic), its root
//! mean square over the windows (a window's own error may be of either sign), and with noise the mean error
//! with its interval and the deviation of single matches about the mean of their window. Windows are drawn
//! together (a mean of all windows in every trial), so the interval of the bias is right though their searches
//! share samples.

use super::texture::Texture;
use super::trials::{Centre, Matches, MatchingTrials, Noisy, Run, Setup};
use super::{Matcher, Search, StereoPair};
use crate::efficiency::Errors;
use crate::sequential::Interval;
use hadar::cube::Shape;
use hadar::error::{Error, Result};
use hadar::ranging::noise::NoiseVariance;

/// At one disparity.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct LockingPoint {
    /// True disparity, pixels.
    pub disparity: f64,
    /// Mean error without noise, pixels.
    pub systematic: f64,
    /// Root mean square of it over the windows, pixels.
    pub systematic_rms: f64,
    /// Mean error with noise, pixels.
    pub bias: f64,
    /// Interval of it.
    pub bias_interval: Interval,
    /// Deviation about the mean of each window, pixels.
    pub deviation: f64,
    /// Share of matches that failed or were off by more than a pixel; they do not count in any of the above.
    pub lost: f64,
}

/// What a locking curve is measured on.
#[derive(Debug, Clone, Copy)]
pub struct Locking<'a> {
    /// Texture of the windows.
    pub texture: &'a Texture,
    /// Its bands.
    pub bands: usize,
    /// Electronic noise.
    pub noise: &'a NoiseVariance,
    /// Which views are noisy.
    pub noisy: Noisy,
    /// The matcher.
    pub matcher: Matcher,
    /// Windows, side by side.
    pub windows: usize,
    /// Trials of each.
    pub run: Run,
    /// Confidence level of intervals.
    pub level: f64,
}

impl Locking<'_> {
    /// The curve at true `disparities`, each searched for ± 4 pixels about it.
    ///
    /// # Errors
    /// No windows, fewer than two trials, disparities that are not finite, noise that does not fit.
    pub fn curve(&self, disparities: &[f64]) -> Result<Vec<LockingPoint>> {
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
        let good = |found: &Option<f64>| found.is_some_and(|off| off.abs() <= super::report::OUTLIER);
        let error = |found: &super::Match| found.ok().map(|d| d - part).filter(|off| good(&Some(*off)));
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
