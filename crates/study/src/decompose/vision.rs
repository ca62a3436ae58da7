//! What is drawn of a decomposed cube: hues of the materials, limits of the temperature, texture, thermal image.
//!
//! * Texture X = Σₖ Vₖ ∫Sₖ dν over the bands that count: what is around, as a surface sees it from its place, photons s⁻¹ m⁻² sr⁻¹.
//! * Thermal image ∫S dν over the same bands, photons s⁻¹ m⁻² sr⁻¹: what a camera without bands sees.
//! * Hues: those the scenario states, then the paper's for vegetation, water and sand, then by the place in the library, so that a
//!   material keeps its hue whatever is in the picture. The first ones alternate between blue and yellow, which the colour-blind tell
//!   apart; after them each is in the middle of the widest gap.
//!
//! Source: paper, supplement SIII C.

use super::DecomposeStudy;
use super::kept::Block;
use hadar::cube::{Cube, Rows, Sample};
use hadar::error::Result;
use hadar::parallel;
use hadar_estimate::decompose::{Maps, Residue, Setting, Sky, Told, distil};
use hadar_scenario::MaterialRef;
use hadar_scenario::decompose::LightSource;
use serde::Serialize;
use std::ops::Range;

/// Hues of the first materials, degrees: blue, amber, pink, bluish green, vermillion, violet, lime, cyan.
const HUES_DEG: [f64; 8] = [210.0, 45.0, 330.0, 165.0, 15.0, 270.0, 75.0, 190.0];
/// Hues that are closer than this are not both among the first, degrees.
const APART_DEG: f64 = 15.0;
/// Hues of the paper, of 255.
const NAMED: [(&str, f64); 3] = [("vegetation", 90.0), ("water", 160.0), ("sand", 40.0)];
/// Shares of the decided pixels that are colder than the limits.
pub(super) const DRAWN: [f64; 2] = [0.1, 0.9];

/// What is drawn.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Vision {
    /// Hue of each material of the library, degrees.
    pub hues_deg: Vec<f64>,
    /// Temperatures of the palest and the fullest colour, K.
    pub temperature_k: [f64; 2],
    /// Texture of the sky's light alone, where a sky is named.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distilled: Option<DistilledTexture>,
}

/// A distilled texture, and what it is made of.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DistilledTexture {
    /// The texture of every pixel, photons s⁻¹ m⁻² sr⁻¹; NaN where material or lighting is unknown.
    #[serde(skip)]
    pub texture: Vec<f32>,
    /// Its deviation.
    #[serde(skip)]
    pub sigma: Vec<f32>,
    /// Median of the texture, and of its deviation.
    pub medians: [f64; 2],
    /// Scatterings of the sky's light between the surroundings until nothing changed.
    pub scatterings: usize,
    /// How much of the residue of each material is light.
    pub residues: Vec<Residue>,
}

impl Vision {
    /// With the limits of the temperature that the scenario states, or else these; `maps` are all of them where a sky is named.
    ///
    /// # Errors
    /// A cube that cannot be read.
    pub(super) fn of(
        study: &DecomposeStudy,
        setting: &Setting<'_>,
        temperature_k: [f64; 2],
        maps: Option<&Maps>,
    ) -> Result<Self> {
        let spec = &study.scenario.vision;
        Ok(Self {
            hues_deg: hues_deg(&study.names, |name| spec.hues_deg.get(name).copied()),
            temperature_k: spec.temperature_k.unwrap_or(temperature_k),
            distilled: spec
                .sky
                .zip(maps)
                .map(|(sky, maps)| distilled(study, setting, maps, sky))
                .transpose()?,
        })
    }
}

impl Block {
    /// Maps from row `first` on with their texture and thermal image.
    ///
    /// # Errors
    /// A cube that cannot be read.
    pub(super) fn of(study: &DecomposeStudy, told: &Told, first: usize, maps: Maps) -> Result<Self> {
        let rows = first..first + maps.material.len() / study.cube.shape().columns();
        Ok(Self {
            first,
            texture: texture(told, &maps),
            thermal: match &study.cube {
                Cube::F32(cube) => thermal(study, cube.as_ref(), rows),
                Cube::F64(cube) => thermal(study, cube.as_ref(), rows),
            }?,
            maps,
        })
    }
}

/// The texture of the sky's light. Surroundings that are rows of the cube are shown by these, those of a material of the library by its
/// pixels; of others it is not known what they scatter.
fn distilled(
    study: &DecomposeStudy,
    setting: &Setting<'_>,
    maps: &Maps,
    sky: usize,
) -> Result<DistilledTexture> {
    let columns = study.cube.shape().columns();
    let shown = |light: &LightSource| -> Vec<usize> {
        match light {
            LightSource::Rows([first, last]) => (first * columns..last * columns).collect(),
            LightSource::Surface { material: Some(MaterialRef::Name(name)), .. } => {
                let place = study.names.iter().position(|own| own == name);
                let is_own = |i: &usize| place.is_some_and(|place| usize::from(maps.material[*i]) == place);
                (0..maps.material.len()).filter(is_own).collect()
            }
            _ => Vec::new(),
        }
    };
    let shown_by: Vec<Vec<usize>> = study.scenario.environment.iter().map(shown).collect();
    let found = distil(setting, maps, &study.cube, Sky { place: sky, shown_by: &shown_by })?;
    let median = |of: &[f32]| {
        let mut known: Vec<f64> = of.iter().map(|x| f64::from(*x)).filter(|x| x.is_finite()).collect();
        known.sort_by(f64::total_cmp);
        known.get(known.len() / 2).copied().unwrap_or(f64::NAN)
    };
    Ok(DistilledTexture {
        medians: [median(&found.texture), median(&found.sigma)],
        texture: found.texture,
        sigma: found.sigma,
        scatterings: found.scatterings,
        residues: found.residues,
    })
}

/// Hues of the materials of a library, some of them stated, degrees.
#[must_use]
pub fn hues_deg(names: &[String], stated: impl Fn(&str) -> Option<f64>) -> Vec<f64> {
    let of_paper = |name: &str| {
        let named = NAMED.iter().find(|(one, _)| one.eq_ignore_ascii_case(name.trim()));
        named.map(|(_, hue)| hue * 360.0 / 255.0)
    };
    let fixed: Vec<Option<f64>> = names.iter().map(|name| stated(name).or_else(|| of_paper(name))).collect();
    let mut taken: Vec<f64> = fixed.iter().flatten().copied().collect();
    let mut free = |fixed: &Option<f64>| {
        fixed.unwrap_or_else(|| {
            let apart = |a: f64, b: f64| 180.0 - ((a - b).abs() - 180.0).abs();
            let first = HUES_DEG.iter().find(|hue| taken.iter().all(|one| apart(*one, **hue) >= APART_DEG));
            let hue = first.copied().unwrap_or_else(|| middle_of_widest_gap(&mut taken));
            taken.push(hue);
            hue
        })
    };
    fixed.iter().map(&mut free).collect()
}

/// The middle of the widest gap between hues on their circle, the first of equals.
fn middle_of_widest_gap(hues: &mut [f64]) -> f64 {
    hues.sort_by(f64::total_cmp);
    let next = hues.iter().skip(1).copied().chain(hues.first().map(|first| first + 360.0));
    let gaps = hues.iter().zip(next);
    let widest = gaps.fold((0.0, 0.0), |widest, (from, to)| {
        if to - from > widest.0 + 1e-9 { (to - from, 0.5 * (from + to)) } else { widest }
    });
    widest.1 % 360.0
}

/// Limits of the temperature that are at least a kelvin apart.
pub(super) fn apart([low, high]: [f64; 2]) -> [f64; 2] {
    let short = (1.0 - (high - low)).max(0.0);
    [low - 0.5 * short, high + 0.5 * short]
}

/// Bands that count.
fn used(told: &Told) -> Vec<usize> {
    (0..told.bands.len()).filter(|band| !told.bad_bands.contains(band)).collect()
}

fn texture(told: &Told, maps: &Maps) -> Vec<f32> {
    let lights = told.setting().textures();
    if lights.is_empty() {
        return vec![f32::NAN; maps.material.len()];
    }
    let sum = |v: &[f32]| v.iter().zip(&lights).map(|(v, light)| f64::from(*v) * light).sum::<f64>() as f32;
    maps.lighting.chunks(lights.len()).map(sum).collect()
}

fn thermal<S: Sample>(study: &DecomposeStudy, cube: &dyn Rows<S>, rows: Range<usize>) -> Result<Vec<f32>> {
    let used = used(&study.told);
    let scale: Vec<f64> =
        study.told.counts_per_radiance.iter().map(|k| 1.0 / (k * study.told.units_per_count)).collect();
    let sum = |pixel: &[S]| {
        let of = |band: &usize| Some(scale.get(*band)? * (*pixel.get(*band)?).into());
        used.iter().filter_map(of).sum::<f64>() as f32
    };
    let shape = cube.shape();
    let of_row = |buffer: &mut Vec<S>, i: usize| {
        let row = rows.start + i;
        Ok(cube.read(row..row + 1, buffer)?.chunks(shape.bands()).map(sum).collect::<Vec<f32>>())
    };
    Ok(parallel::try_map_with(rows.len(), Vec::new, of_row)?.concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No two of thirty hues are closer than half of an even spread, and what is stated holds.
    #[test]
    fn hues_are_apart_and_stay() {
        let names: Vec<String> =
            (0..30).map(|i| if i == 4 { "Water".to_owned() } else { format!("m{i}") }).collect();
        let found = hues_deg(&names, |name| (name == "m7").then_some(33.0));
        assert_eq!((found[0], found[7]), (210.0, 33.0));
        assert!((found[4] - 225.882_352_941).abs() < 1e-6);
        let mut sorted = found.clone();
        sorted.sort_by(f64::total_cmp);
        assert!(sorted.windows(2).all(|pair| pair[1] - pair[0] >= 5.5), "{sorted:?}");
        assert!(sorted.iter().all(|hue| (0.0..360.0).contains(hue)));
        // Materials that are added at the end change no hue.
        assert_eq!(hues_deg(&names[..20], |name| (name == "m7").then_some(33.0)), found[..20]);
    }
}
