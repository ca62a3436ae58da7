//! The space that the spectra of one material lie in, or near: directions of its lighting, and a few of its emission over temperature.
//!
//! In counts divided by their deviations. The curve of the emission is spanned by its own points, the farthest from what is spanned so
//! far first, until what is left out is a small part of the noise.

use super::model::Model;

/// What may be left out of the curve, in deviations of the counts.
const LEFT_OUT: f64 = 0.05;
/// Most directions of a curve.
const MOST_DIRECTIONS: usize = 8;

/// The space of one material, whitened.
pub(super) struct Space {
    /// Orthonormal directions of the lighting; `None` where it changes nothing more.
    pub(super) lights: Vec<Option<Vec<f64>>>,
    pub(super) columns: Vec<Vec<f64>>,
    /// Orthonormal directions of the curve.
    pub(super) curve: Vec<Vec<f64>>,
    /// The curve itself.
    pub(super) points: Vec<Vec<f64>>,
    pub(super) left_out: f64,
}

impl Space {
    pub(super) fn new(model: &Model, m: usize, reference: &[f64], whitening: &[f64], rows: usize) -> Self {
        hadar::stop::check();
        let width = model.width;
        let scattered = model.scattered(m);
        let (base, others) = scattered.split_at(width);
        let columns: Vec<Vec<f64>> = others
            .chunks(width)
            .map(|column| (0..width).map(|w| (column[w] - base[w]) * whitening[w]).collect())
            .collect();
        let points: Vec<Vec<f64>> = (0..rows)
            .map(|row| {
                let (emitted, _) = model.emitted(m, model.temperature_of(row as f64));
                (0..width).map(|w| (emitted[w] + base[w] - reference[w]) * whitening[w]).collect()
            })
            .collect();
        let mut lights: Vec<Option<Vec<f64>>> = Vec::new();
        for column in &columns {
            let mut rest = column.clone();
            for _ in 0..2 {
                lights.iter().flatten().for_each(|q| remove(&mut rest, q));
            }
            lights.push(unit(rest, 1e-9 * norm(column)));
        }
        let mut rests = points.clone();
        for rest in &mut rests {
            lights.iter().flatten().for_each(|q| remove(rest, q));
            lights.iter().flatten().for_each(|q| remove(rest, q));
        }
        let mut curve: Vec<Vec<f64>> = Vec::new();
        let mut left_out;
        loop {
            let (farthest, length) = rests
                .iter()
                .map(|rest| norm(rest))
                .enumerate()
                .fold((0, 0.0), |most, one| if one.1 > most.1 { one } else { most });
            left_out = length;
            if length <= LEFT_OUT || curve.len() == MOST_DIRECTIONS {
                break;
            }
            let Some(mut q) = unit(rests[farthest].clone(), 0.0) else { break };
            lights.iter().flatten().chain(&curve).for_each(|other| remove(&mut q, other));
            let Some(q) = unit(q, 0.0) else { break };
            rests.iter_mut().for_each(|rest| remove(rest, &q));
            curve.push(q);
        }
        // Between two temperatures of the table the curve goes on as smoothly as at them.
        Self { lights, columns, curve, points, left_out: 1.1 * left_out + 1e-3 }
    }

    /// All its directions.
    pub(super) fn directions(&self) -> impl Iterator<Item = &Vec<f64>> + Clone {
        self.lights.iter().flatten().chain(&self.curve)
    }

    /// The farthest that the curve is from its chords between these rows.
    pub(super) fn sag(&self, starts: &[usize]) -> f64 {
        let mut most: f64 = 0.0;
        for ends in starts.windows(2) {
            let (from, to) = (&self.points[ends[0]], &self.points[ends[1]]);
            for row in ends[0]..ends[1] {
                let share = (row - ends[0]) as f64 / (ends[1] - ends[0]) as f64;
                let off = (0..from.len())
                    .map(|w| (self.points[row][w] - (1.0 - share) * from[w] - share * to[w]).powi(2));
                most = most.max(off.sum::<f64>().sqrt());
            }
        }
        // A chord over h sags by h²/8 times the bend: between two rows by a part more.
        1.25 * most + 1e-3
    }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    hadar::sum::dot(a, b)
}

pub(super) fn norm(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}

pub(super) fn remove(from: &mut [f64], direction: &[f64]) {
    let along = dot(from, direction);
    from.iter_mut().zip(direction).for_each(|(x, q)| *x -= along * q);
}

pub(super) fn unit(mut x: Vec<f64>, least: f64) -> Option<Vec<f64>> {
    let length = norm(&x);
    (length > least && length > 0.0).then(|| {
        x.iter_mut().for_each(|x| *x /= length);
        x
    })
}
