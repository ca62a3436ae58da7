//! What is drawn of a decomposed cube beside its maps: hues of the materials, limits of the temperature, texture, thermal image.
//!
//! * Texture X = Σₖ Vₖ ∫Sₖ dν over the bands that count: what is around, as a surface sees it from its place, photons s⁻¹ m⁻² sr⁻¹.
//! * Thermal image ∫S dν over the same bands, photons s⁻¹ m⁻² sr⁻¹: what a camera without bands sees.
//! * Hues: those the scenario states, then the paper's for vegetation, water and sand, then by the place in the library, so that a
//!   material keeps its hue whatever else is in the picture. The first ones alternate between blue and yellow, which the colour-blind
//!   tell apart.
//!
//! Source: paper, supplement SIII C.

use super::DecomposeStudy;
use hadar::decompose::{Light, Maps};
use hadar::error::Result;
use hadar::ranging::cube::{Cube, Rows, Sample};
use rayon::prelude::*;
use serde::Serialize;

/// Hues of the first materials, degrees: blue, amber, pink, bluish green, vermillion, violet, lime, cyan.
const HUES_DEG: [f64; 8] = [210.0, 45.0, 330.0, 165.0, 15.0, 270.0, 75.0, 190.0];
/// From each of the others to the next: no two of any number are close.
const GOLDEN_ANGLE_DEG: f64 = 137.507_764_050_037_85;
/// Hues of the paper, of 255.
const NAMED: [(&str, f64); 3] = [("vegetation", 90.0), ("water", 160.0), ("sand", 40.0)];
/// Shares of the decided pixels that are colder and hotter than the limits.
const TENTH: f64 = 0.1;

/// What is drawn.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Vision {
    /// Hue of each material of the library, degrees.
    pub hues_deg: Vec<f64>,
    /// Temperatures of the palest and the fullest colour, K.
    pub temperature_k: [f64; 2],
    /// Texture X of every pixel, photons s⁻¹ m⁻² sr⁻¹; NaN where the lighting is unknown.
    #[serde(skip)]
    pub texture: Vec<f32>,
    /// Thermal image, photons s⁻¹ m⁻² sr⁻¹; NaN where a sample is missing.
    #[serde(skip)]
    pub thermal: Vec<f32>,
}

impl Vision {
    /// # Errors
    /// A cube that cannot be read.
    pub(super) fn of(study: &DecomposeStudy, maps: &Maps) -> Result<Self> {
        let spec = &study.scenario.vision;
        let hue = |(place, name): (usize, &String)| {
            let stated = spec.hues_deg.get(name).copied();
            stated.unwrap_or_else(|| hue_deg(place, name))
        };
        Ok(Self {
            hues_deg: study.names.iter().enumerate().map(hue).collect(),
            temperature_k: spec.temperature_k.unwrap_or_else(|| tenths_k(maps)),
            texture: texture(study, maps),
            thermal: match &study.cube {
                Cube::F32(rows) => thermal(study, rows.as_ref()),
                Cube::F64(rows) => thermal(study, rows.as_ref()),
            }?,
        })
    }
}

fn hue_deg(place: usize, name: &str) -> f64 {
    let named = NAMED.iter().find(|(one, _)| one.eq_ignore_ascii_case(name.trim()));
    let of_place = || HUES_DEG.get(place).copied().unwrap_or((GOLDEN_ANGLE_DEG * place as f64) % 360.0);
    named.map_or_else(of_place, |(_, hue)| hue * 360.0 / 255.0)
}

/// Between a tenth and nine tenths of the temperatures of the decided pixels, at least a kelvin apart.
fn tenths_k(maps: &Maps) -> [f64; 2] {
    let decided = maps.temperature_k.iter().enumerate().filter(|(i, t)| t.is_finite() && maps.is_decided(*i));
    let mut values: Vec<f64> = decided.map(|(_, t)| f64::from(*t)).collect();
    values.sort_by(f64::total_cmp);
    let at = |share: f64| {
        let place = (share * values.len() as f64) as usize;
        values.get(place.min(values.len().saturating_sub(1))).copied().unwrap_or(293.15)
    };
    let (low, high) = (at(TENTH), at(1.0 - TENTH));
    let short = (1.0 - (high - low)).max(0.0);
    [low - 0.5 * short, high + 0.5 * short]
}

/// Bands that count.
fn used(study: &DecomposeStudy) -> Vec<usize> {
    (0..study.bands.len()).filter(|band| !study.scenario.cube.bad_bands.contains(band)).collect()
}

fn texture(study: &DecomposeStudy, maps: &Maps) -> Vec<f32> {
    let used = used(study);
    let lights: Vec<f64> = study
        .lights
        .iter()
        .map(|light| {
            let of_bands: Vec<f64> = match light {
                Light::Radiance(radiance) => study.bands.weigh(radiance),
                Light::Counts(counts) => {
                    counts.iter().zip(&study.counts_per_radiance).map(|(n, k)| n / k).collect()
                }
            };
            used.iter().filter_map(|band| of_bands.get(*band)).sum()
        })
        .collect();
    if lights.is_empty() {
        return vec![f32::NAN; maps.material.len()];
    }
    let sum = |v: &[f32]| v.iter().zip(&lights).map(|(v, light)| f64::from(*v) * light).sum::<f64>() as f32;
    maps.lighting.chunks(lights.len()).map(sum).collect()
}

fn thermal<S: Sample>(study: &DecomposeStudy, cube: &dyn Rows<S>) -> Result<Vec<f32>> {
    let used = used(study);
    let scale: Vec<f64> =
        study.counts_per_radiance.iter().map(|k| 1.0 / (k * study.units_per_count)).collect();
    let sum = |pixel: &[S]| {
        let of = |band: &usize| Some(scale.get(*band)? * (*pixel.get(*band)?).into());
        used.iter().filter_map(of).sum::<f64>() as f32
    };
    let shape = cube.shape();
    let rows = (0..shape.rows()).into_par_iter().map_init(Vec::new, |buffer, row| {
        Ok(cube.read(row..row + 1, buffer)?.chunks(shape.bands()).map(sum).collect::<Vec<f32>>())
    });
    Ok(rows.collect::<Result<Vec<_>>>()?.concat())
}
