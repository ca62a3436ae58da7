//! Picture of a decomposed cube after the paper (SIII C): hue the material, saturation the temperature, brightness the texture.
//!
//! Saturation goes from [`PALEST`] at the lower limit of the temperature to 1 at the upper one, so that what is decided is never
//! grey; grey is what is undecided. Brightness goes from [`DARKEST`] to 1 over the logarithm of the texture X, equalised
//! ([`super::equalise`]), so that hues are seen in the shade too; where the lighting is unknown it is in the middle.

use super::equalise::{Clahe, Curves, LIMIT};
use crate::figures::Plot;
use crate::plot::{Axis, Painted, Picture, Pictures, Rgb, image_png};
use crate::shown::Shown;
use crate::table::{Table, optional};
use crate::words::decompose::brightness_said;
use hadar::error::Result;
use hadar_scenario::decompose::Brightness;
use hadar_study::decompose::{Block, Decomposed, ranked};
use rayon::prelude::*;
use std::io::Write;

/// Saturation at the lower limit of the temperature; the paper has 0, which is also that of nothing known.
const PALEST: f64 = 0.25;
/// Brightness of the darkest texture; the paper has 0.
pub const DARKEST: f64 = 0.3;
/// Saturation and brightness of what shows a material alone, in the order of the library. Where hues look alike to the colour-blind the
/// one is dark or pale: of the first eight materials and white no two are closer than 15 of CIEDE2000 to any eyes.
const PLAIN: [[f64; 2]; 8] =
    [[1.0, 1.0], [0.8, 0.55], [0.8, 0.25], [0.6, 0.45], [0.4, 0.95], [1.0, 0.75], [1.0, 0.25], [1.0, 1.0]];
/// What is undecided, beside them.
const UNDECIDED: Rgb = (255, 255, 255);
/// Share of the textures that are darker than the scale, and brighter.
const BEYOND: f64 = 0.005;
/// Materials in the legend.
const LISTED: usize = 36;

/// Hue, saturation and brightness of every pixel; no hue where it is undecided.
#[derive(Debug, Clone, PartialEq)]
pub struct Vision {
    /// Hues in degrees; `None` where nothing is decided.
    pub hue_deg: Vec<Option<f64>>,
    /// From 0 to 1.
    pub saturation: Vec<f64>,
    /// From 0 to 1.
    pub brightness: Vec<f64>,
}

impl Vision {
    /// Colours of the pixels, red, green and blue.
    #[must_use]
    pub fn pixels(&self) -> Vec<Rgb> {
        let each = self.hue_deg.iter().zip(self.saturation.iter().zip(&self.brightness));
        each.map(|(hue, (s, v))| rgb(hue.unwrap_or(0.0), *s, *v)).collect()
    }
}

/// What pixels of a decomposed cube are painted with.
#[derive(Debug)]
pub(super) struct Brush<'a> {
    result: &'a Decomposed,
    tones: Tones,
}

impl<'a> Brush<'a> {
    /// Laid out by the textures of all pixels.
    pub(super) fn of(result: &'a Decomposed) -> Result<Self> {
        let [rows, columns] = [result.shape.rows(), result.shape.columns()];
        let tones = Tones::of(rows, columns, &mut |take| {
            result.kept.each(&mut |block| {
                let first = block.first * columns;
                let of_block = first..first + block.texture.len();
                take(first, of_sky(result).and_then(|all| all.get(of_block)).unwrap_or(&block.texture));
                Ok(())
            })
        })?;
        Ok(Self { result, tones })
    }

    /// Hue, saturation and brightness of the pixels of a block, which are at these `places`, counted row after row.
    pub(super) fn vision(&self, block: &Block, places: impl Iterator<Item = usize>) -> Vision {
        let (maps, asked) = (&block.maps, &self.result.vision);
        let hue = |i: usize| {
            let material = maps.material.get(i).filter(|_| maps.is_decided(i))?;
            asked.hues_deg.get(usize::from(*material)).copied()
        };
        let hue_deg: Vec<Option<f64>> = (0..maps.material.len()).map(hue).collect();
        let saturations = hue_deg.iter().zip(&maps.temperature_k).map(|(hue, t)| match hue {
            Some(_) if t.is_finite() => saturation(f64::from(*t), asked.temperature_k),
            Some(_) => PALEST,
            None => 0.0,
        });
        let saturation = saturations.collect();
        let of_sky = of_sky(self.result);
        let lit: Vec<(usize, f32)> = places
            .zip(&block.texture)
            .map(|(at, own)| (at, of_sky.and_then(|all| all.get(at)).copied().unwrap_or(*own)))
            .collect();
        let brightness =
            lit.into_par_iter().map(|(at, texture)| self.tones.brightness(at, texture)).collect();
        Vision { hue_deg, saturation, brightness }
    }

    /// The picture, a pixel each.
    pub(super) fn image(&self, to: impl Write) -> Result<()> {
        let shape = self.result.shape;
        image_png(to, [shape.rows(), shape.columns()], &mut |put| {
            self.result
                .kept
                .each(&mut |block| put(&self.vision(block, block.first * shape.columns()..).pixels()))
        })
    }
}

/// The texture of the sky's light, if brightness is to be that.
fn of_sky(result: &Decomposed) -> Option<&[f32]> {
    let is_asked = result.scenario.vision.brightness == Brightness::Distilled;
    result.vision.distilled.as_ref().filter(|_| is_asked).map(|of_sky| of_sky.texture.as_slice())
}

/// How textures become brightness: their logarithms, equalised; those of the darkest and the brightest few at the ends of the others.
#[derive(Debug)]
struct Tones {
    /// The least and the most texture that are told from what is beyond; none without any.
    ends: Option<[f32; 2]>,
    curves: Curves,
}

/// Hands on textures, with the place of the first of them.
type Take<'a> = dyn FnMut(usize, &[f32]) + 'a;

impl Tones {
    /// Of an image whose textures `pass` hands on, all of them each time.
    fn of(rows: usize, columns: usize, pass: &mut dyn FnMut(&mut Take<'_>) -> Result<()>) -> Result<Self> {
        let rank = |share: f64, count: u64| (share * (count.max(1) - 1) as f64) as u64;
        let found = ranked(&[&[BEYOND, 1.0 - BEYOND]], rank, &mut |count| {
            pass(&mut |_, textures| {
                textures.iter().filter(|x| **x > 0.0 && x.is_finite()).for_each(|x| count(0, *x));
            })
        })?;
        let ends = match found.first().map(Vec::as_slice) {
            Some([Some(low), Some(high)]) => Some([*low, *high]),
            _ => None,
        };
        let span = ends.map_or([f64::NAN; 2], |ends| ends.map(|x| f64::from(x).ln()));
        let mut tiles = Clahe::of(rows, columns).tiles(rows, columns, span);
        if ends.is_some() {
            pass(&mut |first, textures| {
                tiles.count(first, textures.iter().map(|x| logarithm(*x, ends)));
            })?;
        }
        Ok(Self { ends, curves: tiles.curves() })
    }

    /// Brightness of a pixel; in the middle where it has no texture.
    fn brightness(&self, at: usize, texture: f32) -> f64 {
        let x = self.curves.at(at, logarithm(texture, self.ends));
        DARKEST + (1.0 - DARKEST) * if x.is_finite() { x } else { 0.5 }
    }
}

fn logarithm(texture: f32, ends: Option<[f32; 2]>) -> f64 {
    match ends {
        Some([low, high]) if !texture.is_nan() => f64::from(texture.clamp(low, high)).ln(),
        _ => f64::NAN,
    }
}

/// Brightness of textures: their logarithms, equalised; in the middle where there is none.
#[must_use]
pub fn brightness(textures: &[f32], columns: usize) -> Vec<f64> {
    let rows = textures.len().checked_div(columns).unwrap_or(0);
    let tones = Tones::of(rows, columns, &mut |take| {
        take(0, textures);
        Ok(())
    });
    // What is in memory can be read.
    let Ok(tones) = tones else { return vec![0.5 * (DARKEST + 1.0); textures.len()] };
    textures.iter().enumerate().map(|(at, texture)| tones.brightness(at, *texture)).collect()
}

/// Saturation of a temperature between limits.
#[must_use]
pub fn saturation(temperature_k: f64, [low, high]: [f64; 2]) -> f64 {
    PALEST + (1.0 - PALEST) * ((temperature_k - low) / (high - low)).clamp(0.0, 1.0)
}

/// The colour of a material alone.
fn plain(hues_deg: &[f64], place: usize) -> Rgb {
    let [saturation, brightness] = PLAIN.get(place % PLAIN.len()).copied().unwrap_or([1.0; 2]);
    hues_deg.get(place).map_or(UNDECIDED, |hue| rgb(*hue, saturation, brightness))
}

/// A colour of hue (degrees), saturation and brightness.
fn rgb(hue_deg: f64, saturation: f64, brightness: f64) -> Rgb {
    let part = |n: f64| {
        let k = (n + hue_deg / 60.0).rem_euclid(6.0);
        let least = k.min(4.0 - k).clamp(0.0, 1.0);
        (255.0 * brightness * (1.0 - saturation * least)).round() as u8
    };
    (part(5.0), part(3.0), part(1.0))
}

/// The picture beside the thermal image, the material alone and the texture alone, of the pixels that are shown.
#[must_use]
pub(super) fn plot(brush: &Brush<'_>, pixels: &Block, shown: Shown) -> Plot {
    let result = brush.result;
    let (places, wide): (Vec<_>, _) = (shown.places().collect(), shown.wide());
    let asked = &result.vision;
    let vision = brush.vision(pixels, places.iter().map(|[_, _, at]| *at));
    let take = |all: &[f32], is_shown: fn(f32) -> bool| -> Vec<f64> {
        all.iter().map(|x| if is_shown(*x) { f64::from(*x) } else { f64::NAN }).collect()
    };
    let plain = |place: Option<usize>| place.map_or(UNDECIDED, |place| plain(&asked.hues_deg, place));
    let areas: Vec<Option<usize>> = (0..pixels.maps.material.len())
        .map(|i| pixels.maps.material.get(i).filter(|_| pixels.maps.is_decided(i)).map(|m| usize::from(*m)))
        .collect();
    let materials: Vec<Rgb> = areas.iter().map(|area| plain(*area)).collect();
    let [low, high] = asked.temperature_k;
    let ramp_hue = result
        .found
        .first()
        .and_then(|row| result.materials.iter().position(|name| *name == row.material))
        .and_then(|place| asked.hues_deg.get(place).copied())
        .unwrap_or(0.0);
    let ramp = [PALEST, 1.0].map(|saturation| rgb(ramp_hue, saturation, 1.0));
    let unit = "(photons s⁻¹ m⁻² sr⁻¹)";
    let thermal = take(&pixels.thermal, f32::is_finite);
    let texture = take(&pixels.texture, |x| x > 0.0);
    let mut pictures = vec![
        Picture::painted(
            "TeX vision: hue the material, saturation the temperature, brightness the texture",
            Axis::linear("temperature (K)").range(low, high),
            wide,
            Painted { pixels: vision.pixels(), ramp: Some(ramp) },
        )
        .name_areas(&areas, &result.materials),
        Picture::new(
            "Thermal image, all bands together",
            Axis::linear(format!("radiance {unit}")),
            wide,
            thermal.clone(),
        ),
        Picture::painted(
            "Material, where one is left",
            Axis::linear(""),
            wide,
            Painted { pixels: materials, ramp: None },
        )
        .name_areas(&areas, &result.materials),
        Picture::new(
            "Texture: what the surfaces see around them",
            Axis::log(format!("incident radiance {unit}")),
            wide,
            texture.clone(),
        ),
    ];
    if let Some(of_sky) = &asked.distilled {
        let of_shown: Vec<f32> =
            places.iter().filter_map(|[_, _, at]| of_sky.texture.get(*at).copied()).collect();
        pictures.push(Picture::new(
            "Distilled texture: what they see of the sky's light",
            Axis::log(format!("incident radiance {unit}")),
            wide,
            take(&of_shown, |x| x > 0.0),
        ));
    }
    let mut keys: Vec<(Rgb, String)> = Vec::new();
    for row in result.found.iter().filter(|row| row.decided > 0).take(LISTED) {
        let place = result.materials.iter().position(|name| *name == row.material);
        keys.push((plain(place), row.material.clone()));
    }
    if result.decided < result.pixels {
        keys.push((plain(None), "undecided".to_owned()));
    }
    let at = |values: &[f64], i: usize| optional(values.get(i).copied());
    let rows: Vec<(usize, &[usize; 3])> = places.iter().enumerate().collect();
    let table = Table::of(
        &rows,
        &[
            ("row", &|(_, [row, ..])| row.to_string()),
            ("column", &|(_, [_, column, _])| column.to_string()),
            ("hue_deg", &|(i, _)| optional(vision.hue_deg.get(*i).copied().flatten())),
            ("saturation", &|(i, _)| at(&vision.saturation, *i)),
            ("brightness", &|(i, _)| at(&vision.brightness, *i)),
            ("texture_photons_s1_m2_sr1", &|(i, _)| at(&texture, *i)),
            ("thermal_photons_s1_m2_sr1", &|(i, _)| at(&thermal, *i)),
        ],
    );
    let figure =
        Pictures::new("Which materials, temperatures and textures does the heat cube hold?", pictures)
            .subtitle(brightness_said(LIMIT, 0.5 * (DARKEST + 1.0)))
            .no_value("nothing is told, or no light")
            .keys(keys);
    Plot { name: "tex_vision".into(), figure: figure.into(), table }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hadar_study::decompose::hues_deg;
    use hadar_testing::vision::closest;

    /// Materials of any names, and those that the paper has given hues of their own, by eyes of four kinds.
    #[test]
    fn materials_are_told_apart_by_the_colour_blind() {
        let distance = |names: &[String]| {
            let hues = hues_deg(names, |_| None);
            let colours = names.iter().enumerate().map(|(i, name)| (name.clone(), plain(&hues, i)));
            closest(&colours.chain([("undecided".to_owned(), UNDECIDED)]).collect::<Vec<_>>())
        };
        let eight: Vec<String> = (0..8).map(|i| format!("m{i}")).collect();
        let found = distance(&eight);
        println!("TeX vision: {found:?}");
        assert!(found.distance >= 15.0, "{found:?}");
    }

    /// Corners of the colour solid, and its axis.
    #[test]
    fn colours_are_those_of_their_hue() {
        for (hue, expected) in [
            (0.0, (255, 0, 0)),
            (60.0, (255, 255, 0)),
            (120.0, (0, 255, 0)),
            (180.0, (0, 255, 255)),
            (240.0, (0, 0, 255)),
            (300.0, (255, 0, 255)),
            (30.0, (255, 128, 0)),
        ] {
            assert_eq!(rgb(hue, 1.0, 1.0), expected, "{hue}");
            assert_eq!(rgb(hue, 0.0, 0.4), (102, 102, 102));
        }
        assert_eq!(rgb(240.0, 0.5, 0.8), (102, 102, 204));
    }
}
