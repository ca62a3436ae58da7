//! Stereo matching of noisy views, held against its bound.
//!
//! A window of the left view about column x is looked for in the right view, at x − d. Two matchers:
//!
//! * [`block`]: correlation (or squared differences) at whole disparities, the peak by a parabola;
//! * [`likelihood`]: least squares weighted by the noise, with the other view interpolated.
//!
//! Around them: [`trials`] draws noise about the expected counts of both views and repeats the match at given
//! centres; [`report`] sets bias and variance beside the bound δd ≥ √(1/J_left + 1/J_right); [`dense`] makes a disparity
//! map; [`texture`] makes views whose true disparity is exact.
//!
//! Conventions: images `[row][column][band]`, row 0 on top; the left camera at −b/2, the right one at +b/2,
//! parallel; d = x_left − x_right in pixels.
//!
//! Assumptions: rectified views, the same disparity in all of a window, the same counts in both views at matching
//! points; photons and electronic noise independent in every sample.
//!
//! Source: paper, Methods 'Fig. 4' and SI C (S41), doi:10.1038/s41586-023-06174-6.

pub mod block;
pub mod dense;
mod interpolation;
mod lanes;
mod layout;
pub mod likelihood;
pub mod report;
mod search;
mod strip;
#[cfg(test)]
mod tests;
pub mod texture;
pub mod trials;

pub use self::search::{Failure, Match, Search, StereoPair};

use hadar::ranging::information::Window;

/// A matcher.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Matcher {
    /// Correlation of blocks.
    Block(block::Block),
    /// Maximum likelihood.
    Likelihood(likelihood::Likelihood),
}

impl Matcher {
    /// Its window.
    #[must_use]
    pub const fn window(&self) -> Window {
        match self {
            Self::Block(block) => block.window,
            Self::Likelihood(likelihood) => likelihood.window,
        }
    }
}
