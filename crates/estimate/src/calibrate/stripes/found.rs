//! What is sought, and what was found.

use super::super::spread::spread;

hadar::named! {
    /// Along what stripes lie.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
    #[serde(rename_all = "lowercase")]
    pub enum Axis {
        /// Every row has a gain and an offset.
        Rows = "rows",
        /// Every column has.
        Columns = "columns",
    }
    /// `rows` or `columns`.
    name
}

/// How stripes are looked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sought {
    /// Along what they lie.
    pub axis: Axis,
    /// Deviation of the gains of lines from 1, as it is known beforehand.
    pub gain_deviation: f64,
    /// Whether a line that is off in all bands alike is a stripe too.
    pub in_all_bands: bool,
}

/// A line of a band that reads g·x + o.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Stripe {
    /// The line, counted from 0.
    pub line: usize,
    /// The band, counted from 0.
    pub band: usize,
    /// Gain g of the line, 1 of a clean one.
    pub gain: f64,
    /// Standard error of the gain g.
    pub sigma_gain: f64,
    /// Offset o, in the unit of the cube.
    pub offset: f64,
    /// Standard error of it, which goes together with that of the gain.
    pub sigma_offset: f64,
    /// Level x₀ at which the errors of gain and line are independent.
    pub level: f64,
    /// How far the line is off there.
    pub off: f64,
    /// Standard error of that, which all pixels of the line have in common.
    pub sigma: f64,
}

impl Stripe {
    /// What the line should read where it reads `sample`.
    #[must_use]
    pub fn corrected(&self, sample: f64) -> f64 {
        (sample - self.offset) / self.gain
    }

    /// Standard error that all pixels of level `x` of the line have in common once it is corrected.
    #[must_use]
    pub fn sigma_common(&self, x: f64) -> f64 {
        self.sigma.hypot(self.sigma_gain * (x - self.level)) / self.gain.abs()
    }
}

/// Why a line of a band was left as it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Why {
    /// A part of it is not off, as where an object lies along the other part.
    InPart,
    /// It is off the same way in the band beside, as a feature of a material is.
    NeighbouringBands,
    /// Its band has a step there that other bands do not have: lines striped side by side, or the edge of a material.
    BesideStep,
    /// All its samples are the same, but for noise, where those of lines beside are not: nothing of the scene is in them.
    Dead,
    /// It looks striped, and has no clean line near that it could be compared with.
    WithoutReference,
    /// It has too few samples.
    Missing,
}

/// A line of a band that is no clean one, and was left as it is.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Kept {
    /// The line, counted from 0.
    pub line: usize,
    /// The band, counted from 0.
    pub band: usize,
    /// Why the line was left as it was.
    pub why: Why,
    /// How far it looks off; NaN where that is not known.
    pub off: f64,
}

/// How lines of a band scatter about what their neighbours lead to expect, over the level of the band.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Apart {
    /// Deviation of a line, as independent ones would have it, beyond noise; 0 where noise explains it.
    pub lines: f64,
    /// Deviation of a line that noise, and texture along it, explains.
    pub noise: f64,
}

impl Destriped {
    /// Of a cube of so many bands, of which those looked at were `of`: NaN for the others.
    #[must_use]
    pub fn among(mut self, of: &[usize], bands: usize) -> Self {
        let numbers = |values: Vec<f64>| spread(values, of, bands, f64::NAN);
        let place = |band: &mut usize| *band = of.get(*band).copied().unwrap_or(*band);
        self.stripes.iter_mut().for_each(|stripe| place(&mut stripe.band));
        self.kept.iter_mut().for_each(|kept| place(&mut kept.band));
        self.detectable = numbers(self.detectable);
        self.detectable_gain = numbers(self.detectable_gain);
        self.levels = numbers(self.levels);
        self.apart = spread(self.apart, of, bands, None);
        self.bands = bands;
        self
    }
}

/// The stripes of a cube.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Destriped {
    /// Direction of the stripes: rows or columns.
    pub axis: Axis,
    /// Number of lines of the cube along that direction.
    pub lines: usize,
    /// Number of spectral bands of the cube.
    pub bands: usize,
    /// The stripes, by line and band.
    pub stripes: Vec<Stripe>,
    /// Lines that are off in all bands alike, and were left as they are.
    pub left: Vec<usize>,
    /// Other lines of single bands that are no clean ones, and were left as they are.
    pub kept: Vec<Kept>,
    /// Least that a line of each band, alone among clean ones, must be off to be seen, in the unit of the cube.
    pub detectable: Vec<f64>,
    /// The same as a gain at the level of each band.
    pub detectable_gain: Vec<f64>,
    /// How the lines of each band differ from those compared with them; none of too few lines.
    pub apart: Vec<Option<Apart>>,
    /// Median of the lines of each band.
    pub levels: Vec<f64>,
}
