//! Spectra of the surroundings that a cube itself shows: the median of pixels that are like the sky, or like the ground.
//!
//! Up to 16 384 pixels with all samples are looked at, evenly over the cube; T_w is the brightness temperature of a pixel in band w, K, T̄
//! its mean over the bands that count, s the spread 1.4826 times the median distance from a median.
//!
//! | like | pixels | refused where | error |
//! |---|---|---|---|
//! | sky | as bright as the darkest five hundredth of them, all bands together and rms over the bands, to 15 % and noise | T̄ of their median is less than [`DARKER_K`] below that of all others; rows are not named, and T_w of the median differ by less than [`CLEAR_K`], as those of a wall do | scale s and [`SCALE`]; shape s and [`SKY_SHAPE`], rms; path [`PATH`] |
//! | ground | of the lower half of the rows, or the rows that are named; rms of T_w about T̄ below 3 K beside noise; T̄ within 3 s of the median | they are fewer than one in [`ONE_IN_GROUND`] | temperature s of T̄ of all such, and [`GROUND_K`]; shape s and [`GROUND_SHAPE`] |
//!
//! Of these pixels those count that have the shape of most of them. The median is that of their shapes, as strong as their median.
//!
//! The spread is that of the pixels, not of their median: which of them light a surface is not known. What a camera sees of the sky is some
//! strip of it at the height θ, through 1/sin θ times the air above; what lights a surface is the mean of the hemisphere, 1 − 2E₃(τ) of a
//! blackbody in air of the optical depth τ, nearly the sky seen through 1.66 times that air. Of the US standard sky, 720 to 1250 cm⁻¹, the mean is fitted
//! by 2.0 times the path seen at the zenith and 0.35 times that seen 10° above the horizon, by 0.90 of its strength, with 1.6 % rms left and 5 % at
//! most. What differs more finely along the wavenumbers than three polynomials is in no deviation: many counts show it as a model that is rejected.
//!
//! Assumptions: pictures are upright; the air between a pixel and the camera is none. Sources: W. M. Elsasser, Heat transfer by infrared
//! radiation in the atmosphere (Harvard, 1942), for 1.66; F. R. Hampel, J. Am. Stat. Assoc. 69, 383 (1974), doi:10.2307/2285666.

mod looked;

pub(super) use looked::{Looked, Readings};

use hadar::error::{Error, Result};
use hadar::planck::{brightness_temperature, photon_radiance};
use hadar::spectrum::{Bands, interpolated};
use hadar_estimate::decompose::Light;
use hadar_scenario::decompose::LightLike;
use looked::{BLACK_K, NORMAL, mean, middle, range};
use serde::Serialize;

/// Of so many pixels looked at, the darkest one tells where the sky is.
const DARKEST_ONE_IN: usize = 512;
/// Times so many that are darker than the sky.
const PASSED_OVER: usize = 4;
/// Fewer pixels are no sky, and no ground.
const LEAST: usize = 32;
/// Of so many pixels looked at one is sky at least.
const ONE_IN_SKY: usize = 1000;
/// The same of the ground in its rows.
const ONE_IN_GROUND: usize = 20;
/// Kelvin by which the sky is darker than what is no sky.
const DARKER_K: f64 = 10.0;
/// Kelvin between the darkest and the brightest band of a clear sky.
const CLEAR_K: f64 = 10.0;
/// Deviations from the median within which the ground is.
const WITHIN: f64 = 3.0;
/// Least of them, K.
const WITHIN_K: f64 = 1.0;
/// What the strip of sky that is seen leaves of the hemisphere's mean beside the length of the path, as shares.
const SCALE: f64 = 0.1;
const SKY_SHAPE: f64 = 0.05;
const PATH: f64 = 0.5;
/// By how much the ground that lights something may differ from the ground that is seen, beside its spread.
const GROUND_K: f64 = 1.0;
const GROUND_SHAPE: f64 = 0.01;
/// Emissivities of air that has a path.
const AIR: [f64; 2] = [1e-3, 0.995];
/// Rounds in which pixels like the median are chosen again.
const ROUNDS: usize = 4;

/// Surroundings that were found in a cube.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LightFound {
    /// Which of the surroundings, from 0.
    pub light: usize,
    /// The kind of surroundings: `sky` or `ground`.
    pub like: &'static str,
    /// Pixels whose median it is.
    pub pixels: usize,
    /// Pixels that were looked at.
    pub pixels_asked: usize,
    /// Mean of its brightness temperatures over the bands, K.
    pub temperature_k: f64,
    /// The lowest and the highest of them, K.
    pub temperatures_k: [f64; 2],
    /// Deviation of its strength, as a share; of a sky.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale_sigma: Option<f64>,
    /// Deviation of its shape, rms over the bands, as a share.
    pub shape_sigma: f64,
    /// Deviation of the length of its path through the air, as a share; of a sky.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub path_sigma: Option<f64>,
    /// Deviation of its temperature, K; of a ground.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub temperature_sigma_k: Option<f64>,
    /// Temperature that the air is taken to have, K; of a sky.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub air_k: Option<f64>,
}

impl Looked<'_> {
    /// The light that pixels in some rows are like, and what is said of it.
    pub(super) fn find(
        &self,
        light: usize,
        (like, rows): (LightLike, Option<[usize; 2]>),
    ) -> Result<(Light, LightFound)> {
        if let Some([first, last]) = rows.filter(|rows| rows[1] > self.rows) {
            let found = format!("rows {first} to {last} of a cube of {}", self.rows);
            return Err(Error::malformed(found, format!("write rows up to {}", self.rows)));
        }
        let (median, found) = match like {
            LightLike::Sky => self.sky(light, rows)?,
            LightLike::Ground => self.ground(light, rows)?,
        };
        let mut counts = vec![0.0; self.readings.bands.len()];
        self.used.iter().zip(&median).for_each(|(band, n)| counts[*band] = *n);
        Ok((Light::Counts(counts), found))
    }

    fn sky(&self, light: usize, rows: Option<[usize; 2]>) -> Result<(Vec<f64>, LightFound)> {
        let mut asked = self.within(rows.unwrap_or([0, self.rows]));
        let refused = |found: String| {
            let instead = "name rows that show the sky beside it, or give what lights the scene as a temperature or a spectrum";
            Err(Error::malformed(found, instead))
        };
        if asked.len() < LEAST {
            return refused(format!("no sky among {} pixels with all their samples", asked.len()));
        }
        let total = |i: usize| self.seen[i].counts.iter().zip(&self.kappa).map(|(n, k)| n / k).sum::<f64>();
        asked.sort_by(|a, b| total(*a).total_cmp(&total(*b)));
        let of = asked.len();
        let (darkest, least) = ((of / DARKEST_ONE_IN).max(LEAST / 2), LEAST.max(of / ONE_IN_SKY));
        let (mut chosen, mut median) = (Vec::new(), Vec::new());
        // Few that are darker than the sky are something else, and passed over.
        for skipped in 0..PASSED_OVER {
            let Some(first) = asked.get(skipped * darkest..(skipped + 1) * darkest) else { break };
            median = self.median(first);
            for _ in 0..ROUNDS {
                chosen = asked.iter().copied().filter(|i| self.is_alike(*i, &median)).collect();
                median = self.median(&chosen);
            }
            chosen = self.of_one_shape(&chosen);
            if chosen.len() >= least {
                break;
            }
        }
        median = if chosen.is_empty() { median } else { self.median(&chosen) };
        if chosen.len() < least {
            return refused(format!(
                "{} of {of} pixels are as dark as the darkest: these are too few for a sky",
                chosen.len()
            ));
        }
        let bands_k = self.temperatures_k(&median);
        let own_k = mean(&bands_k);
        let mut others: Vec<f64> =
            (0..self.seen.len()).filter(|i| !self.is_alike(*i, &median)).map(|i| self.means_k[i]).collect();
        if others.is_empty() {
            return refused(format!("all of {of} pixels are alike: none is told to be the sky"));
        }
        let others_k = middle(&mut others);
        if own_k > others_k - DARKER_K {
            return refused(format!(
                "the darkest pixels look {:.1} K colder than all others, the sky at least {DARKER_K} K",
                below(others_k - own_k)
            ));
        }
        let range = range(&bands_k);
        if rows.is_none() && range[1] - range[0] < CLEAR_K {
            return refused(format!(
                "the darkest pixels look as warm in all bands to {:.1} K, as a cold wall does: a clear sky differs by at least {CLEAR_K} K",
                below(range[1] - range[0])
            ));
        }
        let [scale, shape] = self.spread(&chosen, &median);
        Ok((
            median,
            LightFound {
                light,
                like: "sky",
                pixels: chosen.len(),
                pixels_asked: of,
                temperature_k: own_k,
                temperatures_k: range,
                scale_sigma: Some(scale.hypot(SCALE)),
                shape_sigma: shape.hypot(SKY_SHAPE),
                path_sigma: Some(PATH),
                temperature_sigma_k: None,
                air_k: Some(range[1].max(others_k)),
            },
        ))
    }

    fn ground(&self, light: usize, rows: Option<[usize; 2]>) -> Result<(Vec<f64>, LightFound)> {
        let asked = self.within(rows.unwrap_or([self.rows / 2, self.rows]));
        let black: Vec<usize> = asked.iter().copied().filter(|i| self.is_black(*i)).collect();
        let of = asked.len();
        let least = LEAST.max(of / ONE_IN_GROUND);
        let refused = |count: usize| {
            let found = format!("{count} of {of} pixels send what a blackbody does, to {BLACK_K} K");
            let instead = "name rows that show the ground beside it, or give what lights the scene as a temperature or a spectrum";
            Err(Error::malformed(found, instead))
        };
        if black.len() < least {
            return refused(black.len());
        }
        let mut means: Vec<f64> = black.iter().map(|i| self.means_k[*i]).collect();
        let middle_k = middle(&mut means);
        let mut distances: Vec<f64> = means.iter().map(|t| (t - middle_k).abs()).collect();
        let spread_k = NORMAL * middle(&mut distances);
        let far_k = WITHIN_K.max(WITHIN * spread_k);
        let chosen: Vec<usize> =
            black.iter().copied().filter(|i| (self.means_k[*i] - middle_k).abs() <= far_k).collect();
        let chosen = self.of_one_shape(&self.of_one_shape(&chosen));
        if chosen.len() < least {
            return refused(chosen.len());
        }
        let median = self.median(&chosen);
        let bands_k = self.temperatures_k(&median);
        let [_, shape] = self.spread(&chosen, &median);
        Ok((
            median,
            LightFound {
                light,
                like: "ground",
                pixels: chosen.len(),
                pixels_asked: of,
                temperature_k: mean(&bands_k),
                temperatures_k: range(&bands_k),
                scale_sigma: None,
                shape_sigma: shape.hypot(GROUND_SHAPE),
                path_sigma: None,
                temperature_sigma_k: Some(spread_k.hypot(GROUND_K)),
                air_k: None,
            },
        ))
    }
}

/// To a tenth downwards: what misses a limit does not look as if it met it.
fn below(x: f64) -> f64 {
    (10.0 * x).floor() / 10.0
}

/// What share of a blackbody's radiance at the temperature of its air a sky sends at the nodes: at `least_k`, or as warm as it looks in its brightest band.
pub(super) fn air_of_sky(
    (bands, bad_bands): (&Bands, &[usize]),
    radiances: &[f64],
    least_k: Option<f64>,
) -> Vec<f64> {
    let (wide, widths) = (bands.weigh(bands.nodes_cm1()), bands.widths_cm1());
    let used = (0..bands.len()).filter(|band| !bad_bands.contains(band) && radiances[*band] > 0.0);
    let rows: Vec<(f64, f64)> =
        used.map(|band| (wide[band] / widths[band], radiances[band] / widths[band])).collect();
    let looks = rows.iter().map(|(nu, radiance)| brightness_temperature(*nu, *radiance));
    let air_k = looks.chain(least_k).fold(0.0, f64::max);
    let [least, most] = AIR;
    let (xs, ys): (Vec<f64>, Vec<f64>) = rows
        .into_iter()
        .map(|(nu, radiance)| {
            let black = photon_radiance(nu, air_k);
            (nu, if black > 0.0 { (radiance / black).clamp(least, most) } else { most })
        })
        .unzip();
    match xs.is_empty() {
        true => vec![most; bands.nodes_cm1().len()],
        false => bands.nodes_cm1().iter().map(|nu| interpolated(&xs, &ys, *nu)).collect(),
    }
}

#[cfg(test)]
mod tests;
