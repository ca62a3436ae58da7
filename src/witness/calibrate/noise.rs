//! Photon transfer: the noise of a cube out of the cube, variance against mean.
//!
//! A sample y of mean m (in the unit of the cube, above its dark level) scatters by
//!
//!   var y = a + b·m (+ c·m²)
//!
//! a: variance of the electronic noise, unit²; b: what one photon is in the unit of the cube, since the variance of n photons is n;
//! c: relative variance of the gains of pixels that are compared with each other, where that is asked for.
//!
//! Samples that see the same are two or more frames of one scene, or else neighbours of a row in one frame. What neighbours differ by
//! truly (texture) is common to bands, noise is not. With d the differences over √2 of a band and of two bands A and B beside it, texture
//! alone is in the means ⟨d d_A⟩, ⟨d d_B⟩ and ⟨d_A d_B⟩, and ⟨d²⟩ − ⟨d d_A⟩⟨d d_B⟩/⟨d_A d_B⟩ is without it as far as the textures of the
//! three bands are proportional to each other. Where there is too little of it for a ratio, its contrast is taken to be that of the
//! neighbouring band: ½(⟨d d_A⟩ m/m_A + ⟨d d_B⟩ m/m_B). Of the pairs the half is taken that all other bands together tell
//! least apart.
//!
//! Samples are gathered in bins of their mean; the line is fitted by weighted least squares. Noise of the means themselves, which would
//! make b too small, and the skewness of photon counts, which would make it too large, are taken out of the sums. Errors are those of a
//! jackknife of [`GROUPS`] interleaved groups; intervals hold the truth with 95 % (Student's t). Differences beyond 6 deviations are
//! left out.
//!
//! Assumes noise that is independent between pixels and bands, and photon counts that are Poissonian. Source: J. R. Janesick, Photon
//! Transfer (SPIE, 2007); paper, supplement S10–S16.

mod cells;
mod fit;
mod start;

pub use fit::Line;

use self::cells::{Cells, GROUPS, gathered};
use self::fit::{Bin, fitted};
use self::start::Start;
use crate::error::{Error, Result};
use crate::ranging::cube::{Rows, Sample};

/// Fewest samples of a bin that is fitted.
const FEWEST: f64 = 64.0;
/// Deviations of ⟨d_A d_B⟩ above which a ratio by it is taken.
const TOLD: f64 = 10.0;

/// What is asked of a photon transfer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Asked {
    /// Sample without light, in the unit of the cube.
    pub dark_level: f64,
    /// Whether c is fitted too.
    pub gain_spread: bool,
}

/// The noise of a cube.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Transfer {
    /// Each band.
    pub bands: Vec<OfBand>,
    /// One line for all bands.
    pub common: Line,
    /// χ²/ν of the bands' lines about the common one.
    pub chi_square_reduced: f64,
    /// Share of the differences that were left out as outliers.
    pub outliers: f64,
    /// Share of the pairs of neighbours that were left out since the bands together tell them apart; `None` of frames.
    pub uneven: Option<f64>,
}

/// The noise of a band.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct OfBand {
    /// Its own line; `None` where its means do not spread enough.
    pub line: Option<Line>,
    /// Mean of its samples above the dark level.
    pub mean: f64,
    /// Variance at that mean, as measured without any line.
    pub variance: f64,
    /// Standard error of it.
    pub sigma_variance: f64,
    /// Variance of texture that was taken out, over the noise's.
    pub texture: f64,
    /// Mean, variance and its error of every bin.
    pub bins: Vec<[f64; 3]>,
}

/// Fits the noise of a cube: of two or more `frames` of the same scene, or of one with three bands or more.
///
/// # Errors
/// Frames of different shapes, one frame of fewer than three bands, too few samples, samples that do not scatter at all.
pub fn photon_transfer<S: Sample>(frames: &[&dyn Rows<S>], asked: &Asked) -> Result<Transfer> {
    let shape = frames.first().map(|frame| frame.shape()).ok_or_else(|| {
        Error::malformed("no frame", "give two or more of one scene, or one of three bands or more")
    })?;
    if let Some((i, other)) = frames.iter().enumerate().find(|(_, frame)| frame.shape() != shape) {
        let other = other.shape();
        let of = |s: crate::ranging::cube::Shape| format!("{} x {} x {}", s.rows(), s.columns(), s.bands());
        let found = format!("frame {} is {}, the first one {}", i + 1, of(other), of(shape));
        return Err(Error::malformed(found, "give frames of one scene by one camera, all of one shape"));
    }
    if frames.len() == 1 && shape.bands() < 3 {
        let found = format!("a single frame of {} band(s)", shape.bands());
        let instead = "give two or more frames of the same scene: what neighbours differ by is taken for texture by other bands, and there are too few";
        return Err(Error::malformed(found, instead));
    }
    if frames.len() == 1 && shape.columns() < 2 {
        return Err(Error::malformed("a single frame of one column", "give two or more frames of the scene"));
    }
    let start = Start::new(frames, asked.dark_level)?;
    let cells = gathered(frames, &start)?;
    let bands = shape.bands();
    let count = cells.count();
    if count < FEWEST * 4.0 {
        let found = format!("{count} differences of samples, too few to see how they scatter");
        return Err(Error::malformed(found, "give more pixels or more frames"));
    }
    // The mean of a pair or of all frames.
    let averaged = frames.len().max(2) as f64;
    let spatial = frames.len() == 1;
    let sets: Vec<Vec<Vec<Bin>>> = (0..bands).map(|band| replicates(&cells, band, spatial)).collect();
    let of_bands: Vec<OfBand> =
        sets.iter().enumerate().map(|(band, sets)| of_band(&cells, band, sets, averaged, asked)).collect();
    let all: Vec<Vec<Bin>> = (0..=GROUPS)
        .map(|group| sets.iter().flat_map(|sets| sets.get(group).into_iter().flatten().copied()).collect())
        .collect();
    let common = fitted(&all, averaged, asked.gain_spread).ok_or_else(|| {
        let found = "samples of nearly one level, so that noise that grows with light cannot be told from noise that does not";
        Error::malformed(found, "give a scene of darker and brighter parts")
    })?;
    Ok(Transfer {
        chi_square_reduced: misfit(&of_bands, &common),
        bands: of_bands,
        common,
        outliers: cells.outliers / (cells.outliers + count),
        uneven: spatial.then(|| cells.uneven / (cells.uneven + cells.even).max(1.0)),
    })
}

/// Bins of a band with all groups, then without each of them.
fn replicates(cells: &Cells, band: usize, spatial: bool) -> Vec<Vec<Bin>> {
    let whole = cells.bins(band, None);
    let neighbours = cells.beside(band);
    (0..=GROUPS)
        .map(|left_out| {
            let parts = match left_out {
                0 => whole.clone(),
                group => cells.bins(band, Some(group - 1)),
            };
            parts
                .iter()
                .zip(&whole)
                .filter(|(part, whole)| whole.dof >= FEWEST && part.dof > 0.0)
                .map(|(part, whole)| {
                    let texture = if spatial { part.texture(whole, TOLD, neighbours) } else { 0.0 };
                    let (mean, all) = (part.mean / part.dof, part.square / part.dof);
                    Bin { mean, variance: all - texture, texture, weight: part.dof }
                })
                .collect()
        })
        .collect()
}

fn of_band(cells: &Cells, band: usize, sets: &[Vec<Bin>], averaged: f64, asked: &Asked) -> OfBand {
    let pooled = |bins: &[Bin]| {
        let weight: f64 = bins.iter().map(|bin| bin.weight).sum();
        let of = |value: &dyn Fn(&Bin) -> f64| {
            bins.iter().map(|bin| bin.weight * value(bin)).sum::<f64>() / weight
        };
        [of(&|bin| bin.mean), of(&|bin| bin.variance), of(&|bin| bin.texture)]
    };
    let whole = sets.first().map_or(&[][..], Vec::as_slice);
    let [mean, variance, texture] = pooled(whole);
    let others: Vec<f64> = sets.iter().skip(1).map(|bins| pooled(bins)[1]).collect();
    let bins = whole
        .iter()
        .enumerate()
        .map(|(i, bin)| {
            let others: Vec<f64> =
                sets.iter().skip(1).filter_map(|bins| bins.get(i).map(|bin| bin.variance)).collect();
            [bin.mean, bin.variance, fit::jackknife(&others)]
        })
        .collect();
    let _ = (cells, band);
    OfBand {
        line: fitted(sets, averaged, asked.gain_spread),
        mean,
        variance,
        sigma_variance: fit::jackknife(&others),
        texture: texture / variance,
        bins,
    }
}

/// Lines of the bands about the common one, at two levels of each band: χ²/ν.
fn misfit(bands: &[OfBand], common: &Line) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for band in bands {
        if band.sigma_variance > 0.0 {
            sum += ((band.variance - common.variance(band.mean)) / band.sigma_variance).powi(2);
            count += 1.0;
        }
    }
    if count > 2.0 { sum / (count - 2.0) } else { f64::NAN }
}
