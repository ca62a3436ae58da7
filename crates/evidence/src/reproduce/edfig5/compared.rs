//! The images of the yard, their standard deviations and their information, as numbers.

use super::super::order::Order;
use super::super::textured::{EXPOSURE, Textured, median, window_sums};
use crate::reproduce::texture::standard_deviation;
use hadar::cube::{MemoryCube, Shape};
use hadar::error::Result;
use hadar::ranging::information::Window;
use hadar::ranging::levels::share_left;
use hadar_estimate::decompose::{Maps, NO_MATERIAL, TextureInformation, texture_information};
use hadar_report::decompose::{Clahe, DARKEST, brightness};
use hadar_study::render::Picture as Rendered;

/// Side of the windows of the standard deviation, and half of it without the middle.
pub(super) const SIDE: usize = 3;
pub(super) const HALF: usize = 1;
/// Levels of an image on a screen.
pub(super) const LEVELS: usize = 256;
/// Noise reaches so far, in deviations.
const REACH: f64 = 8.0;
/// One image: its standard deviation, and its information over that of the cube.
pub(super) struct Row {
    pub(super) name: &'static str,
    /// Mean standard deviation over windows, of 1 for the whole scale; none of a cube.
    pub(super) deviation: Option<f64>,
    /// The same of the image without noise.
    pub(super) deviation_noise_free: Option<f64>,
    /// Median information of windows on the ground, pixel⁻².
    pub(super) information: f64,
    /// The same over all pixels of one surface.
    pub(super) information_all: f64,
    /// S37 of the noisy image with the variance of matched pixels; none where that is not asked.
    pub(super) by_matching: Option<f64>,
}

/// Everything that is made of the yard.
pub(super) struct Compared {
    pub(super) yard: Textured,
    pub(super) maps: Maps,
    pub(super) rows: Vec<Row>,
    pub(super) information: TextureInformation,
    pub(super) equalised_information: Vec<f64>,
    /// Windows in which an equalised image would tell more than the thermal one.
    pub(super) violations: usize,
    pub(super) thermal: Vec<f64>,
    pub(super) equalised: Vec<f64>,
    pub(super) texture: Vec<f32>,
    pub(super) distilled: Vec<f32>,
}

/// A shown image in 256 levels, from 0 to 1.
pub(super) fn levels(image: &[f64]) -> Vec<f64> {
    let top = (LEVELS - 1) as f64;
    image.iter().map(|x| (x * top).round() / top).collect()
}

/// Values between their least and largest as 0 to 1.
pub(super) fn scaled(image: &[f64]) -> Vec<f64> {
    let (low, high) = image
        .iter()
        .filter(|x| x.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)));
    image.iter().map(|x| (x - low) / (high - low)).collect()
}

/// Equalised logarithm of a texture, from 0 to 1.
pub(super) fn shown(texture: &[f32], columns: usize) -> Vec<f64> {
    brightness(texture, columns).iter().map(|b| (b - DARKEST) / (1.0 - DARKEST)).collect()
}

pub(super) fn f32s(values: &[f64]) -> Vec<f32> {
    values.iter().map(|x| *x as f32).collect()
}

/// Mean standard deviation of windows all of whose pixels count.
fn density(image: &[f64], counts: &[bool], shape: Shape) -> Result<f64> {
    let filled: Vec<f64> = image.iter().map(|x| if x.is_finite() { *x } else { 0.0 }).collect();
    let single = Shape::new(shape.rows(), shape.columns(), 1)?;
    let map = standard_deviation(&MemoryCube::new(single, filled)?, Window::new(SIDE, SIDE)?)?;
    let whole: Vec<f64> = counts.iter().map(|counts| if *counts { 0.0 } else { f64::NAN }).collect();
    let whole = window_sums(&whole, shape, HALF);
    let (mut sum, mut count) = (0.0, 0.0);
    for (row, values) in map.rows.clone().zip(map.values.chunks(map.columns.len())) {
        for (column, value) in map.columns.clone().zip(values) {
            if whole[row * shape.columns() + column].is_finite() {
                sum += value;
                count += 1.0;
            }
        }
    }
    Ok(sum / count)
}

pub(super) fn compared(order: Order) -> Result<Compared> {
    let yard = Textured::new(EXPOSURE, order.seed)?;
    let (shape, columns, all) = (yard.shape, yard.shape.columns(), yard.all());
    let [expected, drawn] = [&yard.expected.views[0], &yard.drawn.views[0]];
    let cube = yard.cube(expected)?;
    let (true_fit, _) = yard.apart(expected, all)?;
    let (maps, found) = yard.apart(drawn, all)?;
    let (maps_right, found_right) = yard.apart(yard.right(&yard.drawn)?, all)?;
    let information = texture_information(&yard.setting(all), &true_fit, &cube, &found)?;
    let (thermal, mean) = (yard.thermal(drawn), yard.thermal(expected));
    let curves = Clahe::of(shape.rows(), columns).curves(&thermal, columns);
    let smooth =
        |image: &[f64]| image.iter().enumerate().map(|(i, n)| curves.at(i, *n)).collect::<Vec<f64>>();
    let equalise = |image: &[f64]| levels(&smooth(image));
    let top = (LEVELS - 1) as f64;
    let steps: Vec<f64> = (1..LEVELS).map(|k| (k as f64 - 0.5) / top).collect();
    let added: f64 = yard.expected.var_added.iter().sum();
    let left = |i: usize| {
        let sigma = (mean[i] + added).sqrt();
        let edges = curves.crossings(i, [mean[i] - REACH * sigma, mean[i] + REACH * sigma], &steps);
        share_left(mean[i], sigma, &edges)
    };
    let equalised_information: Vec<f64> =
        information.thermal.iter().enumerate().map(|(i, j)| j * left(i)).collect();
    let more = |i: &usize| equalised_information[*i] > information.thermal[*i] * (1.0 + 1e-9);
    let violations = (0..mean.len()).filter(more).count();
    let texture = f32s(&yard.texture(&maps));
    let counts: Vec<bool> =
        (0..mean.len()).map(|i| yard.left().material[i] != NO_MATERIAL && texture[i].is_finite()).collect();
    let ground = yard.of_ground();
    let typical = |j: &[f64]| {
        let sums = window_sums(j, shape, HALF);
        let of = |own: &[bool]| median(sums.iter().zip(own).filter(|(_, own)| **own).map(|(j, _)| *j));
        [of(&ground), of(&counts)]
    };
    let row = |name, images: Option<[&[f64]; 2]>, j: &[f64], by_matching: Option<f64>| -> Result<Row> {
        let [information, information_all] = typical(j);
        let deviation = |k: usize| images.map(|both| density(both[k], &counts, shape)).transpose();
        Ok(Row {
            name,
            deviation: deviation(0)?,
            deviation_noise_free: deviation(1)?,
            information,
            information_all,
            by_matching,
        })
    };
    let truth = [yard.light(expected), yard.light_of_sky()?].map(|light| f32s(&light));
    let right = yard.right(&yard.drawn)?;
    let matched = |of_left: &[f64], of_right: &[f64]| {
        Some(by_matching(&yard, [expected, right], [of_left, of_right], &ground))
    };
    let f64s = |of: &[f32]| of.iter().map(|x| f64::from(*x)).collect::<Vec<f64>>();
    let (equalised, equalised_mean) = (equalise(&thermal), equalise(&mean));
    let rows = vec![
        row("heat cube, all bands", None, &information.cube, None)?,
        row("temperature and lighting together", None, &information.together, None)?,
        row(
            "thermal image",
            Some([&scaled(&thermal), &scaled(&mean)]),
            &information.thermal,
            matched(&thermal, &yard.thermal(right)),
        )?,
        row(
            "thermal image, equalised, 256 levels (AGC)",
            Some([&equalised, &equalised_mean]),
            &equalised_information,
            matched(&equalised, &equalise(&yard.thermal(right))),
        )?,
        row(
            "thermal image, equalised, no levels",
            Some([&smooth(&thermal), &smooth(&mean)]),
            &information.thermal,
            None,
        )?,
        row(
            "pseudo-TeX vision, its brightness",
            Some([&equalised, &equalised_mean]),
            &equalised_information,
            None,
        )?,
        row(
            "texture X",
            Some([&scaled(&f64s(&texture)), &scaled(&f64s(&truth[0]))]),
            &information.texture,
            matched(&f64s(&texture), &yard.texture(&maps_right)),
        )?,
        row(
            "texture X, logarithm equalised (TeX vision)",
            Some([&shown(&texture, columns), &shown(&truth[0], columns)]),
            &information.texture,
            None,
        )?,
        row(
            "distilled texture",
            Some([&scaled(&f64s(&found.texture)), &scaled(&f64s(&truth[1]))]),
            &information.distilled,
            matched(&f64s(&found.texture), &f64s(&found_right.texture)),
        )?,
        row(
            "distilled texture, logarithm equalised (TeX vision)",
            Some([&shown(&found.texture, columns), &shown(&truth[1], columns)]),
            &information.distilled,
            None,
        )?,
    ];
    Ok(Compared {
        maps,
        rows,
        information,
        equalised_information,
        violations,
        thermal,
        equalised,
        texture,
        distilled: found.texture,
        yard,
    })
}

/// S37 as the paper evaluates it: differences of the noisy image itself over the variance of pixels that match by the true disparity,
/// median over windows on the ground.
fn by_matching(yard: &Textured, [left, right]: [&Rendered; 2], [a, b]: [&[f64]; 2], ground: &[bool]) -> f64 {
    let columns = yard.shape.columns();
    let disparity = |i: usize| yard.disparity_px(f64::from(left.depth_m[i]));
    let (mut square, mut count) = (0.0, 0.0);
    for i in (0..a.len()).filter(|i| ground[*i] && a[*i].is_finite()) {
        let place = (i % columns) as f64 - disparity(i);
        if !(place >= 0.0 && place < (columns - 1) as f64) {
            continue;
        }
        let j = i / columns * columns + place as usize;
        let (share, same) = (place.fract(), |j: usize| right.surface[j] == left.surface[i]);
        let pure = |j: usize| right.material[j] != NO_MATERIAL;
        let there = (1.0 - share) * b[j] + share * b[j + 1];
        if same(j) && same(j + 1) && pure(j) && pure(j + 1) && there.is_finite() {
            // The mean of two has less noise than one.
            let noise = 1.0 + (1.0 - share).powi(2) + share * share;
            square += (a[i] - there).powi(2) / noise;
            count += 1.0;
        }
    }
    let var = square / count;
    let slope = |i: usize| match i % columns {
        0 => f64::NAN,
        x if x + 1 == columns => f64::NAN,
        _ => 0.5 * (a[i + 1] - a[i - 1]),
    };
    let j: Vec<f64> = (0..a.len()).map(|i| slope(i).powi(2) / var).collect();
    let sums = window_sums(&j, yard.shape, HALF);
    median(sums.iter().zip(ground).filter(|(_, own)| **own).map(|(j, _)| *j))
}
