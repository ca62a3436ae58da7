//! Noise in three dimensions: what readings of one array have in common, beside the noise that each pixel has for itself.
//!
//! A reading of pixel (v, h) in frame t is its signal plus independent deviations that differ from pixel to pixel (VH), from row to
//! row (V), from column to column (H), and from frame to frame of each (TVH, TV, TH, T). A NETD is TVH; the other six are here, and what all
//! readings of a band have in common from calibration to calibration (S), which a cube does not show. Of the sum over h rows and w columns of an object in one frame the variance is
//!
//! | term | key | variance, counts² | grows as |
//! |---|---|---|---|
//! | σ_VH | `fixed_pattern` | h w σ² | t² |
//! | σ_V | `row_noise` | h w² σ² | t² |
//! | σ_H | `column_noise` | h² w σ² | t² |
//! | σ_S | `offset_drift` | h² w² σ² | t² |
//! | σ_TV | `temporal_row_noise` | h w² σ² | t |
//! | σ_TH | `temporal_column_noise` | h² w σ² | t |
//! | σ_T | `frame_noise` | h² w² σ² | t |
//!
//! so that the mean of N frames has σ_TVH²/(Nhw) + σ_VH²/(hw) + σ_TV²/(Nh) + σ_TH²/(Nw) + σ_V²/h + σ_H²/w + σ_T²/N + σ_S². They are
//! stated in K as the NETD is, beside it and for one pixel as for many, and σ = K dN/dT counts of a reading follows at its conditions. A
//! pattern that is a new one after the time τ has (2τ/t)(1 − (τ/t)(1 − exp(−t/τ))) of its variance left in the mean over t.
//!
//! Assumptions: the terms are independent, also between bands (each filter has a pattern of its own); a pattern is an offset, the
//! same at all signals. Offsets that are one pattern in all bands take away one direction of the spectrum alone.
//!
//! Source: J. D'Agostino, C. Webb, Proc. SPIE 1488, 110 (1991), doi:10.1117/12.45794 (three-dimensional noise).

mod spec;

pub use spec::{Pattern, PatternFigures};

use self::spec::{TERMS, Term};
use super::budget::BandLine;
use super::equivalents::per_kelvin;
use super::noise::NetdConditions;
use super::{Camera, View};
use crate::error::Result;

impl Pattern {
    /// As it would be stated for other conditions; what is not stated stays so.
    #[must_use]
    pub(super) fn stated_at(&self, camera: &Camera, at: NetdConditions) -> PatternFigures {
        if self.is_none() || at == self.at {
            return self.stated;
        }
        let factor = per_kelvin(camera, self.at) / per_kelvin(camera, at);
        PatternFigures::of_sigmas(self.stated.sigmas_k().map(|k| k.map(|k| k * factor)), self.stated.drift_s)
    }
}

impl Camera {
    /// The noise that readings share as lines of the budget of each of so many bands, one variance for all of them, counts² of the sum over
    /// the pixels of the view.
    pub(super) fn shared_noise(&self, bands: usize, view: &View) -> Vec<BandLine> {
        let pattern = &self.pattern;
        if pattern.is_none() {
            return Vec::new();
        }
        let [rows, columns] = view.extent.sides();
        let pixels = rows * columns;
        let mut lines = Vec::new();
        for (term, var) in self.pattern_terms() {
            let [of_row, of_column] = term.of_each;
            let alike = (if of_row { 1.0 } else { rows }) * (if of_column { 1.0 } else { columns });
            lines.push(BandLine {
                label: term.label,
                var_counts: vec![var * pixels * alike; bands],
                scaling: if term.is_fixed { "t^2" } else { "t" },
                source: term.key,
                with_photons: false,
            });
        }
        lines
    }

    /// Every term with its variance in the counts of one pixel.
    fn pattern_terms(&self) -> impl Iterator<Item = (&'static Term, f64)> {
        let pattern = &self.pattern;
        let per_kelvin = per_kelvin(self, pattern.at);
        let stretch = self.integration_s() / self.noise_exposure_s;
        let left = pattern.left_after(self.integration_s());
        TERMS.iter().zip(pattern.sigmas_k()).map(move |(term, sigma_k)| {
            let grown = if term.is_fixed { stretch * stretch * left } else { stretch };
            (term, (sigma_k * per_kelvin).powi(2) * grown)
        })
    }

    /// Variance that the counts of a pixel have in common with its row, with its column and with the whole picture, counts², in each of so many
    /// bands: what stays, and what changes from frame to frame. What a pixel has for itself is the noise of a camera whose pattern is
    /// [`Pattern::of_pixels`].
    #[must_use]
    pub fn var_in_common(&self, bands: usize) -> [[f64; 2]; 3] {
        let mut common = [[0.0; 2]; 3];
        if self.pattern.is_shared() {
            for (term, var) in self.pattern_terms() {
                let kind = usize::from(!term.is_fixed);
                match term.of_each {
                    [true, false] => common[0][kind] += var,
                    [false, true] => common[1][kind] += var,
                    [false, false] => common[2][kind] += var,
                    [true, true] => {}
                }
            }
        }
        common.map(|kinds| kinds.map(|var| var * self.spread(bands)))
    }

    /// Share of the variance of the electronic noise of a band, at the exposure for which it is stated, that grows as the square of the
    /// time: flicker and fixed patterns. Of one pixel, mean over bands of 1 cm⁻¹ in its range.
    ///
    /// # Errors
    /// As [`Camera::own_bands`].
    pub fn lasting_share(&self) -> Result<f64> {
        if self.pattern.is_none() {
            return Ok(self.flicker_fraction);
        }
        let bands = &self.received(&self.own_bands()?);
        let once = Self { exposure_s: self.noise_exposure_s, frames: 1, ..self.clone() };
        let mean = |lines: &[f64]| lines.iter().sum::<f64>() / lines.len() as f64;
        let sigma = once.reading_sigma(bands).unwrap_or_default();
        let own = if sigma.is_empty() { 0.0 } else { mean(&sigma.iter().map(|s| s * s).collect::<Vec<_>>()) };
        let [mut lasting, mut all] = [self.flicker_fraction * own, own];
        for line in once.shared_noise(1, &View::default()) {
            all += line.var_counts[0];
            if line.scaling == "t^2" {
                lasting += line.var_counts[0];
            }
        }
        Ok(if all > 0.0 { lasting / all } else { 0.0 })
    }
}

#[cfg(all(test, feature = "library"))]
mod tests {
    use super::*;
    use crate::instrument::{Extent, presets};
    use crate::spectrum::Bands;
    use rand::SeedableRng;
    use rand::rngs::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    fn boson() -> Camera {
        let mut preset = presets::find("flir-boson-640-14mm").unwrap().clone();
        preset.figures.f_number = Some(1.0);
        preset.camera().unwrap().checked().unwrap()
    }

    fn bands() -> Bands {
        Bands::uniform(800.0, 1200.0, 200.0).unwrap()
    }

    /// Deviation of the mean over an object in K: that of the sum over its pixels, over what 1 K makes of it.
    fn sigma_k(camera: &Camera, extent: Extent, labels: &[&str]) -> f64 {
        let view = View { extent, ..View::at(None) };
        let lines = camera.added_noise(&bands(), &view);
        let var: f64 =
            lines.iter().filter(|line| labels.contains(&line.label)).map(|line| line.var_counts[0]).sum();
        let stretch = camera.integration_s() / camera.noise_exposure_s;
        var.sqrt() / (extent.pixels() * stretch * per_kelvin(camera, camera.pattern.at))
    }

    /// Table 13 of the Boson's sheet: 40 mK a pixel, 14 mK rows and columns each. By hand: a pixel of 60 averaged frames √(2·14² + 40²/60)
    /// = 20.5 mK; 30 × 10 pixels √(14²/30 + 14²/10 + 40²/(60·300)) = 5.12 mK, and no less with a hundred times as many frames.
    #[test]
    fn rows_and_columns_do_not_average_away() {
        let of = |frames: u32, sides: [f64; 2]| {
            let camera = Camera { frames, ..boson() };
            let labels = ["Johnson noise", "row noise", "column noise", "fixed pattern"];
            1e3 * sigma_k(&camera, Extent::new(sides).unwrap(), &labels)
        };
        // A NETD holds the shot noise of its photons, some 0.1 % of it.
        assert!((of(60, [1.0, 1.0]) / 20.463 - 1.0).abs() < 3e-4, "{}", of(60, [1.0, 1.0]));
        assert!((of(60, [30.0, 10.0]) / 5.1206 - 1.0).abs() < 1e-4, "{}", of(60, [30.0, 10.0]));
        assert!((of(6000, [30.0, 10.0]) / 5.1121 - 1.0).abs() < 1e-4, "{}", of(6000, [30.0, 10.0]));
    }

    /// Cubes drawn reading by reading, with every term of its own size; four deviations of a variance of 4000 sums.
    #[test]
    fn sums_over_drawn_cubes_scatter_as_the_budget_says() {
        let (rows, columns, frames, draws) = (4usize, 3usize, 5usize, 4000);
        let terms_k = [0.03, 0.02, 0.025, 0.012, 0.04, 0.035, 0.015];
        let stated = PatternFigures::of_sigmas(terms_k.map(Some), None);
        let own = boson();
        let camera = Camera {
            frames: frames as u32,
            exposure_s: own.noise_exposure_s,
            pattern: Pattern::new(stated, own.pattern.at),
            ..own
        };
        let extent = Extent::new([rows as f64, columns as f64]).unwrap();
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let mut normals =
            |count: usize| -> Vec<f64> { (0..count).map(|_| StandardNormal.sample(&mut random)).collect() };
        let [vh, v, h, s, tv, th, t] = terms_k;
        let mut squares = 0.0;
        for _ in 0..draws {
            let (of_pixel, of_row, of_column) = (normals(rows * columns), normals(rows), normals(columns));
            let (rows_t, columns_t, frames_t) =
                (normals(frames * rows), normals(frames * columns), normals(frames));
            let offset = normals(1)[0];
            let mut sum = 0.0;
            for frame in 0..frames {
                for row in 0..rows {
                    for column in 0..columns {
                        sum += vh * of_pixel[row * columns + column]
                            + v * of_row[row]
                            + h * of_column[column]
                            + s * offset
                            + tv * rows_t[frame * rows + row]
                            + th * columns_t[frame * columns + column]
                            + t * frames_t[frame];
                    }
                }
            }
            squares += sum * sum;
        }
        let readings = (rows * columns * frames) as f64;
        let drawn = (squares / f64::from(draws)).sqrt() / readings;
        let labels = TERMS.map(|term| term.label);
        let budget = sigma_k(&camera, extent, &labels);
        assert!((drawn / budget - 1.0).abs() < 4.0 * (0.5 / f64::from(draws)).sqrt(), "{drawn} {budget}");
    }

    /// Against the mean of exp(−|s − s′|/τ) over a square, by a sum over 400 × 400 midpoints.
    #[test]
    fn a_pattern_that_drifts_averages_away() {
        let own = boson();
        for ratio in [1e-6, 1e-3, 0.5, 3.0, 40.0] {
            let stated = PatternFigures { drift_s: Some(2.0), ..own.pattern.stated };
            let found = Pattern::new(stated, own.pattern.at).left_after(2.0 * ratio);
            let steps = 400;
            let at = |i: i32| ratio * (f64::from(i) + 0.5) / f64::from(steps);
            let sum: f64 = (0..steps)
                .flat_map(|i| (0..steps).map(move |j| (i, j)))
                .map(|(i, j)| (-(at(i) - at(j)).abs()).exp())
                .sum();
            let exact = sum / f64::from(steps * steps);
            assert!((found / exact - 1.0).abs() < 2e-3, "{ratio}: {found} {exact}");
        }
    }

    /// One pixel without patterns is what it was, bit for bit; a pattern never makes anything better, and more pixels or frames never worse.
    #[test]
    fn more_readings_are_never_worse_and_patterns_never_better() {
        let bands = bands();
        let quality = |camera: &Camera, extent: Extent| {
            let counting = camera.counting(&bands, &View { extent, ..View::at(None) });
            counting.counts_per_radiance / counting.var_added[0].sqrt()
        };
        let with = |sigmas_k: [f64; 7], drift_s: Option<f64>, frames: u32| {
            let own = boson();
            let stated = PatternFigures::of_sigmas(sigmas_k.map(Some), drift_s);
            Camera { frames, pattern: Pattern::new(stated, own.pattern.at), ..own }
        };
        let mut random = ChaCha8Rng::seed_from_u64(11);
        let mut draw = || -> f64 { StandardNormal.sample(&mut random) };
        for _ in 0..300 {
            let sigmas_k = [(); 7].map(|()| (draw() - 1.0).max(0.0) * 0.05);
            let drift_s = Some(draw().exp()).filter(|_| draw() > 0.0);
            let frames = (draw().abs() * 50.0) as u32 + 1;
            let sides = [1.0 + draw().abs() * 20.0, 1.0 + draw().abs() * 20.0];
            let extent = Extent::new(sides).unwrap();
            let camera = with(sigmas_k, drift_s, frames);
            let here = quality(&camera, extent);
            let silent = quality(&with([0.0; 7], None, frames), extent);
            assert!(here <= silent * (1.0 + 1e-12));
            let white = quality(&with([0.0; 7], None, 1), Extent::ONE);
            let root = (extent.pixels() * f64::from(frames)).sqrt();
            assert!(
                (silent / (white * root) - 1.0).abs() < 1e-12,
                "without anything in common the root of the readings"
            );
            for more in [[sides[0] + 1.0, sides[1]], [sides[0], sides[1] + 1.0]] {
                assert!(quality(&camera, Extent::new(more).unwrap()) >= here * (1.0 - 1e-12));
            }
            assert!(quality(&with(sigmas_k, drift_s, frames + 1), extent) >= here * (1.0 - 1e-12));
            for term in 0..7 {
                let mut noisier = sigmas_k;
                noisier[term] += 0.01;
                assert!(quality(&with(noisier, drift_s, frames), extent) <= here);
            }
        }
    }

    #[test]
    fn a_pattern_is_stated_again_as_it_was() {
        let camera = boson();
        assert_eq!(crate::instrument::CameraSpec::of(&camera).pattern, camera.pattern.stated);
        // Behind a slower lens 1 K makes fewer counts, and the same counts more K.
        let mut slow = camera.pattern.at;
        slow.f_number *= 2.0;
        let again = camera.pattern.stated_at(&camera, slow);
        assert!((again.row_k.unwrap() / 56e-3 - 1.0).abs() < 1e-12 && again.pixel_k.is_none());
    }
}
