//! One surface in a pixel, or two with their shares, and what is seen of their counts: deviance, slope and information of f, T and u.
//!
//! N = Σₚ fₚ [A(Tₚ) + Σⱼ uₚⱼ Cⱼ] over parts p ([`crate::decompose::model`]); deviance and information are those of [`crate::decompose::kernel`].

use crate::decompose::kernel::{Bent, Compared, Fitting, compare, emit, far_deviance, over_bands};
use crate::decompose::model::{Hermite, MOST, Model};
use hadar::simd::dispatched;

/// The smaller of two parts is at least so large.
pub(in crate::decompose) const LEAST_SHARE: f64 = 0.1;
/// Coordinates at most: a share, and temperature and lighting of two parts.
pub(super) const MOST_COORDINATES: usize = 2 * MOST - 1;
/// A start is so far inside the range of temperatures, as a share of it.
const INSIDE: f64 = 1e-2;

/// One of the surfaces in a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::decompose) struct Part {
    /// Its material in the model.
    pub(in crate::decompose) m: usize,
    pub(in crate::decompose) share: f64,
    pub(in crate::decompose) sigma_share: f64,
    pub(in crate::decompose) temperature_k: f64,
    pub(in crate::decompose) sigma_k: f64,
    pub(super) mixture: [f64; MOST],
}

/// A number for each coordinate.
pub(super) type Point = [f64; MOST_COORDINATES];
/// Rows of a symmetric matrix.
pub(super) type Square = [Point; MOST_COORDINATES];

/// Room for the work, and what was seen at the last look.
#[derive(Debug, Default)]
pub(in crate::decompose) struct Room {
    planes: Vec<f64>,
    /// Pearson's.
    pub(super) chi_square: f64,
    /// Slope and information of the first one's share, then of T and u but the first of each part.
    pub(super) slope: Point,
    pub(super) information: Square,
    pub(super) looks: u64,
}

impl Part {
    pub(super) fn weight(&self, j: usize) -> f64 {
        self.share * self.mixture[j]
    }

    /// Where its temperature is in the range, as a share of it.
    pub(super) fn place(&self, model: &Model) -> f64 {
        let [low, high] = model.range_k;
        (self.temperature_k - low) / (high - low)
    }
}

/// Parts of equal shares, each lit by the middle of what is possible.
pub(super) fn start<const P: usize>(model: &Model, ms: [usize; P], temperatures_k: [f64; P]) -> [Part; P] {
    let [low, high] = model.range_k;
    std::array::from_fn(|p| {
        let mut mixture = [0.0; MOST];
        mixture[..model.vertices].fill(1.0 / model.vertices as f64);
        let within = INSIDE * (high - low);
        Part {
            m: ms[p],
            share: 1.0 / P as f64,
            sigma_share: 0.0,
            temperature_k: temperatures_k[p].clamp(low + within, high - within),
            sigma_k: 0.0,
            mixture,
        }
    })
}

/// Where the share of the first part is between its limits.
pub(super) fn place_of(share: f64) -> f64 {
    (share - LEAST_SHARE) / (1.0 - 2.0 * LEAST_SHARE)
}

dispatched! {
    /// Slope and information at a state into `room`; how well it fits.
    fn accumulate<'a>(model: &'a Model, parts: &'a [Part], counts: &'a [f64], room: &'a mut Room) -> Fitting {
        let (width, vertices) = (model.width, model.vertices);
        let count = parts.len() - 1 + parts.len() * vertices;
        room.planes.resize(width * (5 + count), 0.0);
        let (mean, rest) = room.planes.split_at_mut(width);
        let (weight, rest) = rest.split_at_mut(width);
        let (relative, rest) = rest.split_at_mut(width);
        let (series, rest) = rest.split_at_mut(width);
        let (sent, columns) = rest.split_at_mut(width);
        mean.copy_from_slice(&model.var_added);
        if parts.len() > 1 {
            columns[..width].fill(0.0);
        }
        for (p, part) in parts.iter().enumerate() {
            let place = model.place(part.temperature_k);
            let hermite = Hermite::at(place.share);
            let emission = model.emission(part.m, place.row);
            emit(hermite.value, emission, sent);
            for (j, u) in part.mixture[..vertices].iter().enumerate() {
                sent.iter_mut().zip(model.scattered_of(part.m, j)).for_each(|(n, c)| *n = u.mul_add(*c, *n));
            }
            mean.iter_mut().zip(&*sent).for_each(|(mean, n)| *mean = part.share.mul_add(*n, *mean));
            if parts.len() > 1 {
                let sign: f64 = if p == 0 { 1.0 } else { -1.0 };
                columns[..width].iter_mut().zip(&*sent).for_each(|(to, n)| *to = sign.mul_add(*n, *to));
            }
            let at = parts.len() - 1 + p * vertices;
            let own = &mut columns[at * width..(at + vertices) * width];
            let (slope, lights) = own.split_at_mut(width);
            emit(hermite.slope, emission, slope);
            let per_kelvin = part.share / place.step_k;
            slope.iter_mut().for_each(|slope| *slope *= per_kelvin);
            for (to, from) in lights.chunks_exact_mut(width).zip(model.columns(part.m)) {
                to.iter_mut().zip(from).for_each(|(to, c)| *to = part.share * c);
            }
        }
        compare(counts, mean, weight, relative, series);
        let compared = Compared { counts, mean, weight, relative, series, columns };
        over_bands(compared, count, Bent { slope: &mut room.slope, information: &mut room.information })
    }
}

/// Deviance at a state.
pub(super) fn look(model: &Model, parts: &[Part], counts: &[f64], room: &mut Room) -> f64 {
    room.looks += 1;
    let fitting = accumulate(model, parts, counts, room);
    room.chi_square = fitting.chi_square;
    if fitting.is_far { far_deviance(counts, &room.planes[..model.width]) } else { fitting.deviance }
}

/// Coordinates of parts: the share of the first of two, then the temperature and the lighting of each.
pub(super) fn temperature_at(model: &Model, parts: &[Part], p: usize) -> usize {
    parts.len() - 1 + p * model.vertices
}
