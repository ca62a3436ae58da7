//! A library out of a heat cube.
//!
//! 1. Some pixels are drawn. Each has its emissivity by NEM, under that of a few lightings which leaves it smoothest, and β = e/mean(e) by
//!    RATIO; pixels without one are declared and left out.
//! 2. K-means makes more groups of β, in units of its noise, than are asked for: what is lit differently may look different.
//! 3. Each group has emissivities fitted to its pixels, one in each of three parts of [0, 1]: its magnitude is the ε_max of NEM there that
//!    explains them best, each with a temperature and lighting of its own; then all bands are free ([`super::group`]).
//! 4. Of these emissivities as many as asked for are taken, those whose physics loss over the pixels is least together.
//! 5. Rounds: every pixel goes to the emissivity that explains it best, with its temperature and lighting ([`crate::decompose`]); the
//!    emissivities are fitted to all pixels at once; a step that makes the loss larger is taken back and shortened.
//! 6. Where a range of counts is asked for, each has a loss on pixels that were kept apart: the mean over them of
//!    ν ln(χ²/ν) − 2 ln π, χ² the physics loss with ν degrees of freedom, π the share of the pixel's group. The first term is that of a
//!    likelihood with a scale of its own for each pixel, the second what the name of a group costs: a group that is split in two
//!    without need costs 2 ln 2 and gains nothing, so that the loss does not fall for ever. The fewest groups within a
//!    standard error of the least loss are taken.
//!
//! The whole cube is then decomposed by the library. In all of this the prior density of an emissivity's mean counts for every pixel
//! that is given to it: in a street that lights itself a mirror of the ground sends what the ground sends.
//!
//! Source: paper, supplement SV C, which chooses K by hand and names the scan over K as future work.

mod counts;
mod fit;
mod starts;

pub use self::fit::Asked;

use self::fit::{Made, Maker};
use super::group::{Curve, Information};
use super::radiometry::Radiometry;
use super::sample::Sample;
use crate::decompose::{Maps, Options, Setting, decompose};
use hadar::cube::Cube;
use hadar::error::{Error, Result, check};
use hadar::fisher::emissivity::EmissivityPrior;

/// Pixels that emissivities are fitted to, and those that counts of groups are judged by.
const FITTED: usize = 12_000;
const KEPT: usize = 4_000;
/// Pixels that counts are tried with.
const TRIED: usize = 4_000;

/// A group of pixels with one emissivity; values of all bands in their order.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Cluster {
    /// Emissivity of the group in every band, 0 to 1.
    pub emissivity: Vec<f64>,
    /// Its deviation: noise, all temperatures and lightings unknown, what the prior leaves.
    pub sigma: Vec<f64>,
    /// The part of it that goes with the mean of all bands: the systematic part, which a shift of all temperatures hides.
    pub sigma_magnitude: Vec<f64>,
    /// Deviation of the pixels' emissivities about this one, beyond their noise; 0 for bands that do not count.
    pub spread: Vec<f64>,
    /// Deviation of the mean emissivity.
    pub sigma_mean: f64,
    /// Deviation of what all its temperatures have in common, K.
    pub sigma_temperature_k: f64,
    /// χ² for each degree of freedom.
    pub chi_square_reduced: f64,
    /// Pixels that it was fitted to.
    pub fitted: usize,
    /// Bands held at 0 or 1.
    pub held: usize,
}

/// A count of groups and its loss on pixels that were kept apart.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Tried {
    /// Number of groups that was asked for.
    pub count: usize,
    /// Number of groups to which pixels belong in the end.
    pub left: usize,
    /// Mean loss of a pixel.
    pub loss: f64,
    /// Standard error of its difference from the least one; 0 for that.
    pub error: f64,
    /// Mean χ² for each degree of freedom, its logarithm averaged.
    pub chi_square_reduced: f64,
}

/// A library and what it makes of the cube.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The groups, that of the most pixels first.
    pub clusters: Vec<Cluster>,
    /// Prior probability of each, in any scale: that of its mean emissivity.
    pub prior: Vec<f64>,
    /// Every count that was tried, where there were several.
    pub tried: Vec<Tried>,
    /// Pixels that were drawn and have all their samples.
    pub drawn: usize,
    /// Those of them that have no NEM: in equilibrium, or impossible.
    pub without_nem: usize,
    /// Rounds until nothing changed, or all.
    pub rounds: usize,
    /// Whether nothing changed in the last one.
    pub settled: bool,
    /// The whole cube, decomposed by the library.
    pub maps: Maps,
}

/// The key of an error about how many groups are asked for.
pub const COUNT: &str = "clusters.count";

/// Groups the pixels of a cube and finds the emissivity of each group; the library of `setting` is not looked at. `done` is told how
/// many rows are finished in the end.
///
/// # Errors
/// A setting that is impossible, an unknown gain, no surroundings to tell emission from; no group, more groups than pixels; a cube
/// that cannot be read.
pub fn library_from_cube(
    setting: &Setting<'_>,
    asked: &Asked,
    cube: &Cube,
    done: &(dyn Fn(usize) + Sync),
) -> Result<Found> {
    let [fewest, most] = asked.count;
    if fewest == 0 || most < fewest {
        let found = format!("{fewest} to {most} groups");
        return Err(Error::malformed(found, "ask for one at least, the fewest first"));
    }
    check::unit_interval("largest emissivity", asked.max_emissivity)?;
    check::positive("largest emissivity", asked.max_emissivity, "")?;
    if setting.gain {
        let found = "an unknown gain, which no emissivity can be distinguished from";
        return Err(Error::malformed(found, "give counts of a known scale"));
    }
    let (found, expected) = (cube.shape().bands(), setting.bands.len());
    if found != expected {
        return Err(Error::Length { what: "bands of the cube".into(), found, expected });
    }
    // Everything else that can be wrong with a setting is found by a decomposition of nothing.
    let blank = vec![vec![1.0; setting.bands.nodes_cm1().len()]];
    let radiometry = {
        let check = Sample::of(cube, setting, 1, asked.seed)?;
        if check.pixels() > 0 {
            check.decomposed(setting, &blank, Vec::new())?;
        }
        Radiometry::new(setting)
    };
    let prior = EmissivityPrior::smooth(&radiometry.centres_cm1, asked.prior)?;
    let range = most > fewest;
    let sample = Sample::of(cube, setting, if range { FITTED + KEPT } else { FITTED }, asked.seed)?;
    let drawn = sample.pixels();
    // Every fourth is kept apart, so that both have the whole image.
    let (kept, fitted): (Vec<usize>, Vec<usize>) = (0..drawn).partition(|i| range && i % 4 == 3);
    let (kept, fitted) = (sample.some(&kept), sample.some(&fitted));
    let maker = Maker { setting, radiometry: &radiometry, prior: &prior, asked, sample: &fitted };
    let profiles = maker.profiles();
    if most > profiles.pixels.len() {
        let (pixels, without) = (profiles.pixels.len(), fitted.pixels() - profiles.pixels.len());
        return Err(Error::malformed(
            format!(
                "{most} clusters of {pixels} pixels ({without} more send what they are lit by, or are no surface)"
            ),
            "ask for fewer clusters than pixels",
        )
        .for_key(COUNT));
    }
    let without_nem = fitted.pixels() - profiles.pixels.len();
    let starts = maker.starts(&profiles, most)?;
    let (start, tried) = match range {
        false => (starts.taken(most), Vec::new()),
        true => {
            let fewer = fitted.every(TRIED);
            let mut made = Vec::new();
            for count in fewest..=most {
                let one = maker.fitted(&fewer, starts.taken(count))?;
                made.extend((!one.curves.is_empty()).then_some((count, one)));
            }
            if made.is_empty() {
                return Err(nothing());
            }
            let (chosen, tried) = maker.judged(&made, &kept)?;
            (made.swap_remove(chosen).1.curves.into_iter().map(|curve| curve.emissivity).collect(), tried)
        }
    };
    let Made { curves, information, rounds, settled } = maker.fitted(&fitted, start)?;
    let mut order: Vec<usize> = (0..curves.len()).collect();
    order.sort_by(|a, b| information[*b].pixels.cmp(&information[*a].pixels).then(a.cmp(b)));
    if curves.is_empty() {
        return Err(nothing());
    }
    let clusters: Vec<Cluster> =
        order.iter().map(|i| cluster(&radiometry, &curves[*i], &information[*i])).collect();
    let library: Vec<Vec<f64>> = clusters.iter().map(|one| radiometry.at_nodes(&one.emissivity)).collect();
    let prior: Vec<f64> = clusters.iter().map(|one| maker.probability(&one.emissivity)).collect();
    let options = Options { prior: prior.clone(), ..Options::default() };
    let maps = decompose(&Setting { library: &library, ..*setting }, &options, cube, done)?;
    Ok(Found { clusters, prior, tried, drawn, without_nem, rounds, settled, maps })
}

fn nothing() -> Error {
    Error::malformed(
        "all pixels send what they are lit by: nothing tells an emissivity",
        "check unit and surroundings, or look when the scene is warmer or colder than they are",
    )
}

fn cluster(radiometry: &Radiometry<'_>, curve: &Curve, information: &Information) -> Cluster {
    let mut spread = vec![0.0; curve.emissivity.len()];
    radiometry.used.iter().zip(&curve.spread).for_each(|(band, own)| spread[*band] = *own);
    Cluster {
        emissivity: curve.emissivity.clone(),
        sigma: curve.sigma.clone(),
        sigma_magnitude: curve.sigma_magnitude.clone(),
        spread,
        sigma_mean: curve.sigma_mean,
        sigma_temperature_k: curve.sigma_temperature_k,
        chi_square_reduced: information.reduced(),
        fitted: information.pixels,
        held: curve.held,
    }
}
