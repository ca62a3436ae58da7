//! Electronic noise of the samples of a cube, and what it is where samples are joined.
//!
//! σ² is the variance of one sample (one band of one pixel), counts². Where a window is looked at without its spatial
//! or its spectral resolution, samples are joined: either their readings are added, so that the noise of every one of them counts,
//! or the detector collects all their photons and is read once, with the mean noise of one reading. Shot noise does not
//! care; with electronic noise the choice decides whether resolution helps at all: at a fixed σ per reading,
//! spectral resolution in B bands multiplies the noise by B (`Table S4` is ordered only without it).
//!
//! Source: paper S37, Tables S4 and S5.

use crate::cube::{Cube, Shape};
use crate::error::{Error, Result, check};

/// Variance σ² of the electronic noise of each sample, counts².
#[derive(Debug, Default)]
pub enum NoiseVariance {
    /// Shot noise alone.
    #[default]
    None,
    /// The same for all.
    Uniform(f64),
    /// One per band.
    PerBand(Vec<f64>),
    /// One per sample, in a cube of the same shape.
    PerSample(Cube),
}

impl NoiseVariance {
    /// Checks it against the cube it is for.
    ///
    /// # Errors
    /// A variance that is negative, NaN or infinite, a list or cube that does not fit `shape`. The samples of a cube of variances are
    /// checked where they are used.
    pub fn check(&self, shape: Shape) -> Result<()> {
        match self {
            Self::None => Ok(()),
            Self::Uniform(var) => check::non_negative("noise variance", *var, "counts^2").map(drop),
            Self::PerBand(var) if var.len() != shape.bands() => Err(Error::Length {
                what: "noise variances, one per band".to_owned(),
                found: var.len(),
                expected: shape.bands(),
            }),
            Self::PerBand(var) => var
                .iter()
                .try_for_each(|var| check::non_negative("noise variance", *var, "counts^2").map(drop)),
            Self::PerSample(cube) if cube.shape() != shape => {
                let [ours, theirs] =
                    [cube.shape(), shape].map(|s| format!("{} x {} x {}", s.rows(), s.columns(), s.bands()));
                Err(Error::malformed(
                    format!("the noise variances are {ours} samples, the cube has {theirs}"),
                    "give one variance per sample of the cube",
                ))
            }
            Self::PerSample(_) => Ok(()),
        }
    }
}

crate::base::named::named! {
    /// What the electronic noise of joined samples is.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Joined {
        /// Readings are added: the variances of all of them count.
        #[default]
        SumOfReadings = "sum-of-readings",
        /// Their photons are read at once: the mean variance of one reading counts.
        OneReading = "one-reading",
    }
    /// The name in a scenario.
    name
}
