//! Spectra of the surroundings that a cube itself shows: the median of pixels that are like the sky, or like the ground.
//!
//! Up to [`ASKED`] pixels with all samples are looked at, evenly over the cube; T_w is the brightness temperature of a pixel in band w, K, T̄
//! its mean over the bands that count, s the spread 1.4826 times the median distance from a median.
//!
//! | like | pixels | refused where | error |
//! |---|---|---|---|
//! | sky | as bright as the darkest five hundredth of them, all bands together and rms over the bands, to [`ALIKE`] and noise | T̄ of their median is less than [`DARKER_K`] below that of all others; rows are not named, and T_w of the median differ by less than [`CLEAR_K`], as those of a wall do | scale s and [`SCALE`]; shape s and [`SKY_SHAPE`], rms; path [`PATH`] |
//! | ground | of the lower half of the rows, or the rows that are named; rms of T_w about T̄ below [`BLACK_K`] beside noise; T̄ within 3 s of the median | they are fewer than one in [`ONE_IN_GROUND`] | temperature s of T̄ of all such, and [`GROUND_K`]; shape s and [`GROUND_SHAPE`] |
//!
//! The spread is that of the pixels, not of their median: which of them light a surface is not known. What a camera sees of the sky is some
//! strip of it at the height θ, through 1/sin θ times the air above; what lights a surface is the mean of the hemisphere, nearly the sky seen
//! through 1.66 times that air. From the zenith to 10° above the horizon that is 1.66 down to 0.29 of the path seen: 1 ± 0.5.
//! What one such path leaves of the mean, up to a twentieth where the air is not of one temperature, is in scale and shape.
//!
//! Assumptions: pictures are upright; the air between a pixel and the camera is none. Sources: W. M. Elsasser, Heat transfer by infrared
//! radiation in the atmosphere (Harvard, 1942), for 1.66; F. R. Hampel, J. Am. Stat. Assoc. 69, 383 (1974), doi:10.2307/2285666.

use hadar::cube::{Cube, Rows, Sample};
use hadar::error::{Error, Result};
use hadar::planck::{brightness_temperature, photon_radiance_slope};
use hadar::spectrum::{Bands, interpolated};
use hadar_estimate::decompose::Light;
use hadar_scenario::decompose::LightLike;
use serde::Serialize;

/// Pixels that are looked at.
const ASKED: usize = 1 << 14;
/// Of so many pixels looked at, the darkest one tells where the sky is.
const DARKEST_ONE_IN: usize = 512;
/// Fewer pixels are no sky, and no ground.
const LEAST: usize = 32;
/// Of so many pixels looked at one is sky at least.
const ONE_IN_SKY: usize = 1000;
/// The same of the ground in its rows.
const ONE_IN_GROUND: usize = 20;
/// Share by which pixels of the sky differ at most.
const ALIKE: f64 = 0.15;
/// Kelvin by which the sky is darker than what is no sky.
const DARKER_K: f64 = 10.0;
/// Kelvin between the darkest and the brightest band of a clear sky.
const CLEAR_K: f64 = 10.0;
/// Kelvin by which what is nearly a blackbody differs from one.
const BLACK_K: f64 = 3.0;
/// Deviations from the median within which the ground is.
const WITHIN: f64 = 3.0;
/// Least of them, K.
const WITHIN_K: f64 = 1.0;
/// What the strip of sky that is seen leaves of the hemisphere's mean beside the length of the path, as shares.
const SCALE: f64 = 0.05;
const SKY_SHAPE: f64 = 0.05;
const PATH: f64 = 0.5;
/// By how much the ground that lights something may differ from the ground that is seen, beside its spread.
const GROUND_K: f64 = 1.0;
const GROUND_SHAPE: f64 = 0.01;
/// The median distance of a normal distribution is its deviation over this.
const NORMAL: f64 = 1.4826;
/// Rounds in which pixels like the median are chosen again.
const ROUNDS: usize = 4;
/// Emissivities of air that has a path.
const AIR: [f64; 2] = [1e-3, 0.995];

/// Surroundings that were found in a cube.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LightFound {
    /// Which of the surroundings, from 0.
    pub light: usize,
    /// `sky` or `ground`.
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

/// What the samples of a cube are.
#[derive(Debug, Clone, Copy)]
pub(super) struct Readings<'a> {
    pub(super) bands: &'a Bands,
    pub(super) bad_bands: &'a [usize],
    pub(super) counts_per_radiance: &'a [f64],
    pub(super) var_added: &'a [f64],
    pub(super) units_per_count: f64,
}

/// A pixel that was looked at: its row, counts in the bands that count.
struct Seen {
    row: usize,
    counts: Vec<f64>,
}

/// Pixels of a cube that were looked at.
pub(super) struct Looked<'a> {
    readings: Readings<'a>,
    rows: usize,
    used: Vec<usize>,
    /// Mean wavenumbers and κ Δν of the bands that count.
    centres_cm1: Vec<f64>,
    kappa: Vec<f64>,
    seen: Vec<Seen>,
    /// T̄ of each.
    means_k: Vec<f64>,
}

impl<'a> Looked<'a> {
    pub(super) fn at(cube: &Cube, readings: Readings<'a>) -> Result<Self> {
        let Readings { bands, bad_bands, .. } = readings;
        let used: Vec<usize> = (0..bands.len()).filter(|band| !bad_bands.contains(band)).collect();
        let (wide, widths) = (bands.weigh(bands.nodes_cm1()), bands.widths_cm1());
        let seen = match cube {
            Cube::F32(rows) => seen(rows.as_ref(), &used, readings.units_per_count),
            Cube::F64(rows) => seen(rows.as_ref(), &used, readings.units_per_count),
        }?;
        let mut looked = Self {
            readings,
            rows: cube.shape().rows(),
            centres_cm1: used.iter().map(|band| wide[*band] / widths[*band]).collect(),
            kappa: used.iter().map(|band| readings.counts_per_radiance[*band] * widths[*band]).collect(),
            used,
            seen,
            means_k: Vec::new(),
        };
        looked.means_k = looked.seen.iter().map(|one| mean(&looked.temperatures_k(&one.counts))).collect();
        Ok(looked)
    }

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

    fn within(&self, rows: [usize; 2]) -> Vec<usize> {
        (0..self.seen.len()).filter(|i| (rows[0]..rows[1]).contains(&self.seen[*i].row)).collect()
    }

    fn sky(&self, light: usize, rows: Option<[usize; 2]>) -> Result<(Vec<f64>, LightFound)> {
        let mut asked = self.within(rows.unwrap_or([0, self.rows]));
        let refused = |found: String| {
            let instead = "name rows that show the sky beside it, or give what lights the scene as a temperature or a spectrum";
            Err(Error::malformed(found, instead).for_key("found"))
        };
        if asked.len() < LEAST {
            return refused(format!("no sky among {} pixels with all their samples", asked.len()));
        }
        let total = |i: usize| self.seen[i].counts.iter().zip(&self.kappa).map(|(n, k)| n / k).sum::<f64>();
        asked.sort_by(|a, b| total(*a).total_cmp(&total(*b)));
        let darkest = (asked.len() / DARKEST_ONE_IN).max(LEAST / 2);
        let mut chosen: Vec<usize> = asked[..darkest].to_vec();
        let mut median = self.median(&chosen);
        for _ in 0..ROUNDS {
            chosen = asked.iter().copied().filter(|i| self.is_alike(*i, &median)).collect();
            if chosen.is_empty() {
                break;
            }
            median = self.median(&chosen);
        }
        let of = asked.len();
        if chosen.len() < LEAST.max(of / ONE_IN_SKY) {
            return refused(format!(
                "{} of {of} pixels are as dark as the darkest: that is no sky",
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
                others_k - own_k
            ));
        }
        let range = range(&bands_k);
        if rows.is_none() && range[1] - range[0] < CLEAR_K {
            return refused(format!(
                "the darkest pixels look as warm in all bands to {:.1} K, as a cold wall does: a clear sky differs by at least {CLEAR_K} K",
                range[1] - range[0]
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
            Err(Error::malformed(found, instead).for_key("found"))
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

    /// Brightness temperatures in the bands that count, K; 0 where nothing is sent.
    fn temperatures_k(&self, counts: &[f64]) -> Vec<f64> {
        let each = counts.iter().zip(&self.kappa).zip(&self.centres_cm1);
        each.map(|((n, k), nu)| if *n > 0.0 { brightness_temperature(*nu, n / k) } else { 0.0 }).collect()
    }

    /// Variance of the noise of counts in the `w`th band that counts.
    fn var(&self, w: usize, counts: f64) -> f64 {
        let added = self.used.get(w).and_then(|band| self.readings.var_added.get(*band));
        counts.max(0.0) + added.copied().unwrap_or(0.0)
    }

    /// Whether a pixel is like a median in strength and shape.
    fn is_alike(&self, i: usize, median: &[f64]) -> bool {
        let [strength, shape, noise] = self.off(i, median);
        let var = ALIKE * ALIKE;
        strength * strength <= var + 9.0 * noise / median.len() as f64 && shape <= var + 4.0 * noise
    }

    /// By what share a pixel is stronger than a median, the mean square over the bands of what it differs by besides, and what noise does to that.
    fn off(&self, i: usize, median: &[f64]) -> [f64; 3] {
        let counts = &self.seen[i].counts;
        let used = || counts.iter().zip(median).enumerate().filter(|(_, (_, m))| **m > 0.0);
        let bands = used().count().max(1) as f64;
        let share = |n: f64, m: f64| n / m;
        let strength = used().map(|(_, (n, m))| share(*n, *m)).sum::<f64>() / bands;
        let shape = used().map(|(_, (n, m))| (share(*n, *m) - strength).powi(2)).sum::<f64>() / bands;
        let noise = used().map(|(w, (_, m))| self.var(w, *m) / m / m).sum::<f64>() / bands;
        [strength - 1.0, shape, noise]
    }

    /// Spread of the strengths of pixels, and of their shapes beside noise, as shares.
    fn spread(&self, chosen: &[usize], median: &[f64]) -> [f64; 2] {
        let off: Vec<[f64; 3]> = chosen.iter().map(|i| self.off(*i, median)).collect();
        let mut strengths: Vec<f64> = off.iter().map(|[strength, ..]| strength.abs()).collect();
        let mut shapes: Vec<f64> = off.iter().map(|[_, shape, noise]| shape - noise).collect();
        [NORMAL * middle(&mut strengths), middle(&mut shapes).max(0.0).sqrt()]
    }

    /// Whether a pixel sends nearly what a blackbody does.
    fn is_black(&self, i: usize) -> bool {
        let (counts, mean_k) = (&self.seen[i].counts, self.means_k[i]);
        let bands_k = self.temperatures_k(counts);
        let bands = bands_k.len().max(1) as f64;
        let square = bands_k.iter().map(|t| (t - mean_k).powi(2)).sum::<f64>() / bands;
        let of_noise = |w: usize| {
            let slope = self.kappa[w] * photon_radiance_slope(self.centres_cm1[w], mean_k);
            self.var(w, counts[w]) / slope / slope
        };
        let noise = (0..bands_k.len()).map(of_noise).sum::<f64>() / bands;
        // What noise adds scatters itself.
        square - noise <= BLACK_K * BLACK_K + 3.0 * noise * (2.0 / bands).sqrt()
    }

    fn median(&self, chosen: &[usize]) -> Vec<f64> {
        let of = |w: usize| middle(&mut chosen.iter().map(|i| self.seen[*i].counts[w]).collect::<Vec<_>>());
        (0..self.used.len()).map(of).collect()
    }
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
            let black = hadar::planck::photon_radiance(nu, air_k);
            (nu, if black > 0.0 { (radiance / black).clamp(least, most) } else { most })
        })
        .unzip();
    match xs.is_empty() {
        true => vec![most; bands.nodes_cm1().len()],
        false => bands.nodes_cm1().iter().map(|nu| interpolated(&xs, &ys, *nu)).collect(),
    }
}

fn seen<S: Sample>(cube: &dyn Rows<S>, used: &[usize], unit: f64) -> Result<Vec<Seen>> {
    let shape = cube.shape();
    // By its place, not by how many are whole: a pixel that is missing moves no other.
    let stride = (shape.rows() * shape.columns()).div_ceil(ASKED).max(1);
    let (mut all, mut buffer) = (Vec::new(), Vec::new());
    for row in 0..shape.rows() {
        hadar::stop::check();
        let own = cube.read(row..row + 1, &mut buffer)?.chunks(shape.bands()).enumerate();
        for (_, pixel) in own.filter(|(x, _)| (row * shape.columns() + x).is_multiple_of(stride)) {
            let counts: Vec<f64> = used.iter().map(|band| pixel[*band].into() / unit).collect();
            if counts.iter().all(|n| n.is_finite()) {
                all.push(Seen { row, counts });
            }
        }
    }
    Ok(all)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

fn range(values: &[f64]) -> [f64; 2] {
    let ends = |f: fn(f64, f64) -> f64| values.iter().copied().reduce(f).unwrap_or(f64::NAN);
    [ends(f64::min), ends(f64::max)]
}

fn middle(values: &mut [f64]) -> f64 {
    let place = values.len() / 2;
    if values.is_empty() { f64::NAN } else { *values.select_nth_unstable_by(place, f64::total_cmp).1 }
}
