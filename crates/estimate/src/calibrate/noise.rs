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
//! neighbouring band: ½(⟨d d_A⟩ m/m_A + ⟨d d_B⟩ m/m_B). Of the pairs of one brightness the half is taken that all other
//! bands together tell least apart.
//!
//! Samples are gathered in bins of their mean; the line is fitted by weighted least squares. Noise of the means themselves, which would
//! make b too small, and the skewness of photon counts, which would make it too large, are taken out of the sums. Errors are those of a
//! jackknife of [`GROUPS`] interleaved groups; intervals hold the truth with 95 % (Student's t). Differences beyond 6 deviations are
//! left out; bins of few differences are joined with the next, so that nothing else is.
//!
//! Whether K bands have one line: the residuals r of their variances about it, each over its error of the same jackknife. That square has
//! Fisher's law of 1 and GROUPS − 1 degrees of freedom; K of them, less the terms of the line, are taken as a χ² of the same mean and
//! variance.
//!
//! Assumes noise that is independent between frames, pixels ([`noise_correlations`]) and bands, and photon counts that are Poissonian. Source: J. R. Janesick, Photon
//! Transfer (SPIE, 2007); paper, supplement S10–S16.

mod cells;
mod correlation;
mod fit;
mod start;

pub use correlation::{Correlation, noise_correlations};
pub use fit::Line;

use self::cells::{Cell, Cells, GROUPS, gathered};
use self::fit::{Bin, NoLine, line, replicated};
use self::start::Start;
use hadar::cube::{Rows, Sample};
use hadar::error::{Error, Result};
use hadar::statistics::chi_square_quantile as chi_square;
use hadar::words::significant;

/// Fewest differences of a bin that is fitted and of a band, and of all.
const FEWEST: f64 = 16.0;
const FEWEST_OF_ALL: f64 = 256.0;
/// Probability by which bands of one line are within their limit.
const ALIKE: f64 = 0.999;
/// Standard errors by which the mean of a band may be below the dark level.
const BELOW_DARK: f64 = 5.0;
/// Standard errors beyond which a bend is no chance (Student's law of 31 degrees of freedom: 4 in 10 000), and its share of the slope from
/// which on it matters.
const BENT: f64 = 4.0;
const MATTERS: f64 = 0.05;
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
    /// The noise of each band by itself.
    pub bands: Vec<OfBand>,
    /// One line for all bands.
    pub common: Line,
    /// χ²/ν of the bands' variances about the common line; NaN of too few bands.
    pub chi_square_reduced: f64,
    /// c of a parabola in place of the line, with its standard error, where the line is straight: beyond chance gains of pixels differ or
    /// the detector is not linear, and b and a are those of neither end.
    pub bend: Option<[f64; 2]>,
    /// What it stays below with a probability of 99.9 % where bands have that line in common.
    pub chi_square_limit: f64,
    /// Share of the differences that were left out as outliers.
    pub outliers: f64,
    /// Share of the pairs of neighbours that were left out since the bands together distinguish them; `None` of frames.
    pub uneven: Option<f64>,
}

/// The noise of a band.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct OfBand {
    /// Its own line; `None` where its means do not spread enough.
    pub line: Option<Line>,
    /// Mean of all its samples above the dark level.
    pub mean_of_all: f64,
    /// Mean of those that were compared.
    pub mean: f64,
    /// Variance at that mean, as measured without any line.
    pub variance: f64,
    /// Standard error of that variance, unit² of the cube.
    pub sigma_variance: f64,
    /// Variance of texture that was taken out, over the noise's.
    pub texture: f64,
    /// Mean, variance and its error of every bin.
    pub bins: Vec<[f64; 3]>,
}

impl OfBand {
    /// Variance of a sample at the mean of all: of a line that holds; else what was measured and its standard error, more where the mean
    /// of all is brighter than what was compared.
    #[must_use]
    pub fn variance_at_mean(&self, common: Option<&Line>) -> f64 {
        if let Some(line) = common {
            return line.variance(self.mean_of_all);
        }
        let more = self.line.map_or(0.0, |line| line.variance(self.mean_of_all) - line.variance(self.mean));
        // Gains that differ make a variance that goes with the square of the mean; no noise of a camera grows faster.
        let most = (self.mean_of_all / self.mean).max(1.0).powi(2) * self.variance;
        // No `clamp`: the variance of readings whose squares overflow is no number.
        (self.variance + more).min(most).max(self.variance) + self.sigma_variance
    }
}

impl Transfer {
    /// Whether bands have one line in common, as far as can be seen.
    #[must_use]
    pub fn is_common(&self) -> bool {
        // One or two bands have no scatter.
        self.chi_square_reduced.is_nan() || self.chi_square_reduced <= self.chi_square_limit
    }

    /// Of a cube of so many bands, of which those looked at were `of`: NaN for the others.
    #[must_use]
    pub fn among(mut self, of: &[usize], bands: usize) -> Self {
        let nan = f64::NAN;
        let [mean_of_all, mean, variance, sigma_variance, texture] = [nan; 5];
        let none =
            OfBand { line: None, mean_of_all, mean, variance, sigma_variance, texture, bins: Vec::new() };
        self.bands = super::spread::spread(self.bands, of, bands, none);
        self
    }

    /// Whether variance over mean is bent beyond chance, and by more than a twentieth of the photons' share at the brightest mean.
    #[must_use]
    pub fn is_bent(&self) -> bool {
        let bins = self.bands.iter().flat_map(|band| &band.bins);
        let most = bins.map(|bin| bin[0].abs()).fold(0.0, f64::max);
        self.bend.is_some_and(|[c, sigma]| {
            c.abs() > BENT * sigma && c.abs() * most > MATTERS * self.common.per_photon.abs()
        })
    }

    /// The least variance that the common line has at a mean that was seen.
    #[must_use]
    pub fn least_variance(&self) -> f64 {
        let bins = self.bands.iter().flat_map(|band| &band.bins);
        bins.map(|bin| self.common.variance(bin[0])).fold(f64::INFINITY, f64::min)
    }
}

/// Fits the noise of a cube: of two or more `frames` of the same scene, or of one with three bands or more.
///
/// # Errors
/// Frames of different shapes, one frame of fewer than three bands, too few samples, samples that do not scatter at all, a dark level
/// above the samples.
pub fn photon_transfer<S: Sample>(frames: &[&dyn Rows<S>], asked: &Asked) -> Result<Transfer> {
    let shape = frames.first().map(|frame| frame.shape()).ok_or_else(|| {
        Error::malformed("no frame", "give two or more of one scene, or one of three bands or more")
    })?;
    if let Some((i, other)) = frames.iter().enumerate().find(|(_, frame)| frame.shape() != shape) {
        let other = other.shape();
        let of = |s: hadar::cube::Shape| format!("{} x {} x {}", s.rows(), s.columns(), s.bands());
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
    if count < FEWEST_OF_ALL {
        let found = format!("{count} differences of samples, too few to see how they scatter");
        return Err(Error::malformed(found, "give more pixels or more frames"));
    }
    let spatial = frames.len() == 1;
    check_bands(&cells, asked.dark_level, spatial)?;
    // The mean of a pair or of all frames.
    let averaged = frames.len().max(2) as f64;
    let sets: Vec<Vec<Vec<Bin>>> = (0..bands).map(|band| replicates(&cells, band, spatial)).collect();
    let of_bands: Vec<OfBand> = sets
        .iter()
        .enumerate()
        .map(|(band, sets)| {
            let [mean_of_all, _] = cells.of_all(band);
            OfBand { mean_of_all, ..of_band(sets, averaged, asked) }
        })
        .collect();
    let all: Vec<Vec<Bin>> = (0..=GROUPS)
        .map(|group| sets.iter().flat_map(|sets| sets.get(group).into_iter().flatten().copied()).collect())
        .collect();
    let solutions =
        replicated(&all, averaged, asked.gain_spread).map_err(|why| no_line(why, count, spatial))?;
    let common = line(&solutions).ok_or_else(|| no_line(NoLine::Bins(0, 2), count, spatial))?;
    let [chi_square_reduced, chi_square_limit] =
        misfit(&sets, &solutions, if asked.gain_spread { 3.0 } else { 2.0 })?;
    let bent = || line(&replicated(&all, averaged, true).ok()?).map(|bent| [bent.spread, bent.sigma_spread]);
    Ok(Transfer {
        bend: if asked.gain_spread { None } else { bent() },
        chi_square_reduced,
        chi_square_limit,
        bands: of_bands,
        common,
        outliers: cells.outliers / (cells.outliers + count),
        uneven: spatial.then(|| cells.uneven / (cells.uneven + cells.even).max(1.0)),
    })
}

/// Bands whose samples are too few, or below the dark level.
fn check_bands(cells: &Cells, dark_level: f64, spatial: bool) -> Result<()> {
    for band in 0..cells.bands() {
        let whole = cells.bins(band, None);
        let dof: f64 = whole.iter().map(|bin| bin.dof).sum();
        if dof < FEWEST {
            let found =
                format!("{dof} differences of samples of band {band}, too few to see how they scatter");
            let instead = match spatial {
                true => "give two or more frames, or more pixels; leave a band without samples out",
                false => "give more pixels or more frames; leave a band without samples out",
            };
            return Err(Error::malformed(found, instead));
        }
        let [mean, count] = cells.of_all(band);
        let var: f64 = whole.iter().map(|bin| bin.square).sum::<f64>() / dof;
        if mean < -BELOW_DARK * (var / count).sqrt() {
            let found = format!(
                "{dark_level}, but samples of band {band} have a mean of {}, and none has less than no light",
                significant(mean + dark_level, 4)
            );
            let instead = "write the sample without light as noise.dark_level, in the unit of the cube";
            return Err(Error::malformed(found, instead).for_key("noise.dark_level"));
        }
    }
    Ok(())
}

/// What keeps a line from being fitted, by its true name.
fn no_line(why: NoLine, differences: f64, spatial: bool) -> Error {
    let [found, instead] = match why {
        NoLine::Bins(bins, needed) => [
            format!("{differences} differences of samples at {bins} level(s) that are distinguished, where a line needs {needed}"),
            "give more pixels, more frames, or a scene of darker and brighter parts".into(),
        ],
        NoLine::AllTexture => [
            "what neighbours differ by is texture of the scene as far as bands can tell: no noise is left beside it".into(),
            "give two or more frames of the same scene, or one of an even surface".into(),
        ],
        NoLine::OneLevel([spread, noise]) => [
            format!(
                "levels of samples that were compared differ by {} (rms) where their own noise is {}, so that noise that grows with light \
                 cannot be distinguished from noise that does not",
                significant(spread, 2),
                significant(noise, 2)
            ),
            match spatial {
                true => "give two or more frames, or a scene of darker and brighter parts",
                false => "give a scene of darker and brighter parts",
            }
            .into(),
        ],
    };
    Error::malformed(found, instead)
}

/// Which joined bin each bin goes to: from the lowest on until there are enough differences; a rest goes to the last.
fn joined(whole: &[Cell]) -> Vec<usize> {
    let (mut places, mut dof, mut place) = (Vec::with_capacity(whole.len()), 0.0, 0_usize);
    for bin in whole {
        places.push(place);
        dof += bin.dof;
        if dof >= FEWEST {
            (dof, place) = (0.0, place + 1);
        }
    }
    let last = place.saturating_sub(1);
    places.iter_mut().for_each(|own| *own = (*own).min(last));
    places
}

/// Sums of joined bins.
fn gathered_in(places: &[usize], bins: &[Cell]) -> Vec<Cell> {
    let mut sums = vec![Cell::default(); places.last().map_or(0, |last| last + 1)];
    for (place, bin) in places.iter().zip(bins) {
        if let Some(sum) = sums.get_mut(*place) {
            sum.add(bin);
        }
    }
    sums
}

/// Bins of a band with all groups, then without each of them.
fn replicates(cells: &Cells, band: usize, spatial: bool) -> Vec<Vec<Bin>> {
    let whole = cells.bins(band, None);
    let places = joined(&whole);
    let whole = gathered_in(&places, &whole);
    let neighbours = cells.beside(band);
    (0..=GROUPS)
        .map(|left_out| {
            let parts = match left_out {
                0 => whole.clone(),
                group => gathered_in(&places, &cells.bins(band, Some(group - 1))),
            };
            parts
                .iter()
                .zip(&whole)
                .filter(|(part, _)| part.dof > 0.0)
                .map(|(part, whole)| {
                    let texture = if spatial { part.texture(whole, TOLD, neighbours) } else { 0.0 };
                    let (mean, all) = (part.mean / part.dof, part.square / part.dof);
                    Bin { mean, variance: all - texture, texture, weight: part.dof }
                })
                .collect()
        })
        .collect()
}

fn of_band(sets: &[Vec<Bin>], averaged: f64, asked: &Asked) -> OfBand {
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
    OfBand {
        line: replicated(sets, averaged, asked.gain_spread).ok().and_then(|solutions| line(&solutions)),
        mean_of_all: mean,
        mean,
        variance,
        sigma_variance: fit::jackknife(&others),
        texture: texture / variance,
        bins,
    }
}

/// Variances of the bands about the common line: χ²/ν, and what it stays below where they have that line. An error of a residual has that
/// of the line in it.
fn misfit(sets: &[Vec<Vec<Bin>>], solutions: &[[f64; 3]], terms: f64) -> Result<[f64; 2]> {
    let (mut sum, mut count) = (0.0, 0.0);
    for band in sets {
        let residuals: Vec<f64> = band
            .iter()
            .zip(solutions)
            .map(|(bins, [a, b, c])| {
                let weight: f64 = bins.iter().map(|bin| bin.weight).sum();
                let off = |bin: &Bin| bin.weight * (bin.variance - a - (b + c * bin.mean) * bin.mean);
                bins.iter().map(off).sum::<f64>() / weight
            })
            .collect();
        let Some((residual, others)) = residuals.split_first() else { continue };
        let sigma = fit::jackknife(others);
        if sigma > 0.0 {
            sum += (residual / sigma).powi(2);
            count += 1.0;
        }
    }
    let freedom = count - terms;
    if freedom < 1.0 {
        return Ok([f64::NAN; 2]);
    }
    // Mean and variance of Fisher's F of 1 and n degrees of freedom.
    let n = (GROUPS - 1) as f64;
    let mean = n / (n - 2.0);
    let var = 2.0 * n * n * (n - 1.0) / ((n - 2.0).powi(2) * (n - 4.0));
    let of_law = 2.0 * mean * mean / var;
    Ok([sum / count / mean, chi_square(ALIKE, of_law * freedom)?])
}
