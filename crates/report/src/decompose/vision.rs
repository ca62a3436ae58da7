//! Picture of a decomposed cube after the paper (SIII C): hue the material, saturation the temperature, brightness the texture.
//!
//! Saturation goes from [`PALEST`] at the lower limit of the temperature to 1 at the upper one, so that what is decided is never
//! grey; grey is what is undecided. Brightness goes from [`DARKEST`] to 1 over the logarithm of the texture X, equalised
//! ([`super::equalise`]), so that hues are seen in the shade too; where the lighting is unknown it is in the middle.

use super::equalise::{Clahe, LIMIT};
use crate::figures::Plot;
use crate::plot::{Axis, Painted, Picture, Pictures};
use crate::table::{Table, number};
use hadar_study::scenario::decompose::Brightness;
use hadar_study::study::decompose::Decomposed;

/// Saturation at the lower limit of the temperature; the paper has 0, which is also that of nothing known.
const PALEST: f64 = 0.25;
/// Brightness of the darkest texture; the paper has 0.
pub const DARKEST: f64 = 0.3;
/// Saturation and brightness of what shows the material alone.
const PLAIN: [f64; 2] = [0.8, 0.9];
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
    /// Of a decomposed cube.
    #[must_use]
    pub fn of(result: &Decomposed) -> Self {
        let (maps, asked) = (&result.maps, &result.vision);
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
        let is_of_sky = result.scenario.vision.brightness == Brightness::Distilled;
        let of_sky = asked.distilled.as_ref().filter(|_| is_of_sky);
        let texture = of_sky.map_or(&asked.texture, |of_sky| &of_sky.texture);
        Self { hue_deg, saturation, brightness: brightness(texture, result.shape.columns()) }
    }

    /// Colours of the pixels, red, green and blue.
    #[must_use]
    pub fn pixels(&self) -> Vec<(u8, u8, u8)> {
        let each = self.hue_deg.iter().zip(self.saturation.iter().zip(&self.brightness));
        each.map(|(hue, (s, v))| rgb(hue.unwrap_or(0.0), *s, *v)).collect()
    }
}

/// Brightness of textures: their logarithms, equalised; in the middle where there is none.
#[must_use]
pub fn brightness(textures: &[f32], columns: usize) -> Vec<f64> {
    let rows = textures.len().checked_div(columns).unwrap_or(0);
    let equalised = Clahe::of(rows, columns).equalised(&logarithms(textures), columns);
    let bright = |x: f64| DARKEST + (1.0 - DARKEST) * if x.is_finite() { x } else { 0.5 };
    equalised.into_iter().map(bright).collect()
}

/// Saturation of a temperature between limits.
#[must_use]
pub fn saturation(temperature_k: f64, [low, high]: [f64; 2]) -> f64 {
    PALEST + (1.0 - PALEST) * ((temperature_k - low) / (high - low)).clamp(0.0, 1.0)
}

/// Logarithms, those of the darkest and the brightest few at the ends of the others.
fn logarithms(textures: &[f32]) -> Vec<f64> {
    let mut known: Vec<f64> = textures.iter().filter(|x| **x > 0.0).map(|x| f64::from(*x)).collect();
    known.sort_by(f64::total_cmp);
    let at = |share: f64| known.get((share * (known.len().max(1) - 1) as f64) as usize).copied();
    let Some((low, high)) = at(BEYOND).zip(at(1.0 - BEYOND)) else { return vec![f64::NAN; textures.len()] };
    let one = |x: &f32| if x.is_nan() { f64::NAN } else { f64::from(*x).clamp(low, high).ln() };
    textures.iter().map(one).collect()
}

/// A colour of hue (degrees), saturation and brightness.
fn rgb(hue_deg: f64, saturation: f64, brightness: f64) -> (u8, u8, u8) {
    let part = |n: f64| {
        let k = (n + hue_deg / 60.0).rem_euclid(6.0);
        let least = k.min(4.0 - k).clamp(0.0, 1.0);
        (255.0 * brightness * (1.0 - saturation * least)).round() as u8
    };
    (part(5.0), part(3.0), part(1.0))
}

/// The picture beside the thermal image, the material alone and the texture alone, every `stride`th row and column of them.
#[must_use]
pub(super) fn plot(result: &Decomposed, vision: &Vision, stride: usize) -> Plot {
    let (rows, columns) = (result.shape.rows(), result.shape.columns());
    let shown: Vec<(usize, usize)> = (0..rows)
        .step_by(stride)
        .flat_map(|row| (0..columns).step_by(stride).map(move |column| (row, column)))
        .collect();
    let wide = columns.div_ceil(stride);
    let asked = &result.vision;
    let pick = |all: &[(u8, u8, u8)]| -> Vec<(u8, u8, u8)> {
        shown.iter().filter_map(|(row, column)| all.get(row * columns + column).copied()).collect()
    };
    let take = |all: &[f32], is_shown: fn(f32) -> bool| -> Vec<f64> {
        let one = |(row, column): &(usize, usize)| {
            all.get(row * columns + column).filter(|x| is_shown(**x)).map_or(f64::NAN, |x| f64::from(*x))
        };
        shown.iter().map(one).collect()
    };
    let plain =
        |hue: &Option<f64>| rgb(hue.unwrap_or(0.0), if hue.is_some() { PLAIN[0] } else { 0.0 }, PLAIN[1]);
    let materials: Vec<(u8, u8, u8)> = vision.hue_deg.iter().map(plain).collect();
    let [low, high] = asked.temperature_k;
    let ramp_hue = result
        .found
        .first()
        .and_then(|row| result.materials.iter().position(|name| *name == row.material))
        .and_then(|place| asked.hues_deg.get(place).copied())
        .unwrap_or(0.0);
    let ramp = [PALEST, 1.0].map(|saturation| rgb(ramp_hue, saturation, 1.0));
    let unit = "(photons s⁻¹ m⁻² sr⁻¹)";
    let thermal = take(&asked.thermal, f32::is_finite);
    let texture = take(&asked.texture, |x| x > 0.0);
    let mut pictures = vec![
        Picture::painted(
            "TeX vision: hue the material, saturation the temperature, brightness the texture",
            Axis::linear("temperature (K)").range(low, high),
            wide,
            Painted { pixels: pick(&vision.pixels()), ramp: Some(ramp) },
        ),
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
            Painted { pixels: pick(&materials), ramp: None },
        ),
        Picture::new(
            "Texture: what the surfaces see around them",
            Axis::log(format!("incident radiance {unit}")),
            wide,
            texture.clone(),
        ),
    ];
    if let Some(of_sky) = &asked.distilled {
        pictures.push(Picture::new(
            "Distilled texture: what they see of the sky's light",
            Axis::log(format!("incident radiance {unit}")),
            wide,
            take(&of_sky.texture, |x| x > 0.0),
        ));
    }
    let mut keys: Vec<((u8, u8, u8), String)> = Vec::new();
    for row in result.found.iter().filter(|row| row.decided > 0).take(LISTED) {
        let place = result.materials.iter().position(|name| *name == row.material);
        let hue = place.and_then(|place| asked.hues_deg.get(place).copied());
        keys.push((plain(&hue), row.material.clone()));
    }
    if vision.hue_deg.iter().any(Option::is_none) {
        keys.push((plain(&None), "undecided, or not told".to_owned()));
    }
    let mut table = Table::new([
        "row",
        "column",
        "hue_deg",
        "saturation",
        "brightness",
        "texture_photons_s1_m2_sr1",
        "thermal_photons_s1_m2_sr1",
    ]);
    for (i, (row, column)) in shown.iter().enumerate() {
        let at = row * columns + column;
        let of = |values: &[f64], i: usize| values.get(i).map_or_else(String::new, |x| number(*x));
        table.push(vec![
            row.to_string(),
            column.to_string(),
            vision.hue_deg.get(at).copied().flatten().map_or_else(String::new, number),
            of(&vision.saturation, at),
            of(&vision.brightness, at),
            of(&texture, i),
            of(&thermal, i),
        ]);
    }
    let said = format!(
        "Brightness: logarithm of the texture, equalised in tiles (contrast limited to {LIMIT}); {} where the lighting is unknown. \
         Temperatures beyond the scale have the colours of its ends. Every pixel is in tex_vision_image.png, texture.npy and thermal.npy.",
        number(0.5 * (DARKEST + 1.0)),
    );
    let figure = Pictures::new("Material, temperature and texture of the heat cube", pictures)
        .subtitle(said)
        .no_value("nothing is told, or no light")
        .keys(keys);
    Plot { name: "tex_vision".into(), figure: figure.into(), table }
}

#[cfg(test)]
mod tests {
    use super::*;

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
