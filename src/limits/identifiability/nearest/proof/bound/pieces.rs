//! The pieces of a box: their spectra, products of these, and the cheapest amplitudes.

use super::super::amplitudes::{Amplitudes, Pieces, Ray};
use super::super::vectors::product_into;
use super::super::view::View;
use crate::sum::dot;

/// Where the spectrum of a piece is.
#[derive(Debug, Clone, Copy)]
pub(super) enum Place {
    /// Of a source of known temperature.
    Fixed(usize),
    /// Of an axis.
    Low(usize),
    Rise(usize),
}

/// Where rises stand; each comes after the cold end it begins at. A source stands in the quadratic by its amplitude and by that
/// share of it which is hot: both ends may be nearly the same, what is between them keeps its digits.
pub(super) fn rises(places: &[Place]) -> impl Iterator<Item = usize> {
    places.iter().enumerate().filter(|(_, place)| matches!(place, Place::Rise(_))).map(|(i, _)| i)
}

/// The spectrum of a piece.
pub(super) fn column<'s>(view: &'s View<'_>, [low, rise]: [&'s [Vec<f64>]; 2], place: Place) -> &'s [f64] {
    match place {
        Place::Fixed(s) => view.fixed[s].as_ref().map_or(&[], |spectrum| &spectrum.counts),
        Place::Low(axis) => &low[axis],
        Place::Rise(axis) => &rise[axis],
    }
}

/// Spectra of all pieces times weights.
pub(super) fn put_products(
    whitened: &mut Vec<Vec<f64>>,
    of: [&[Vec<f64>]; 2],
    view: &View<'_>,
    places: &[Place],
    weight: &[f64],
) {
    whitened.resize_with(whitened.len().max(places.len()), Vec::new);
    for (out, place) in whitened.iter_mut().zip(places) {
        out.resize(weight.len(), 0.0);
        product_into(column(view, of, *place), weight, out);
    }
}

/// Products of all columns with each other, with the rows of the priors.
pub(super) fn put_square(square: &mut Vec<f64>, columns: &[Vec<f64>], rows: &[f64]) {
    let m = columns.len();
    square.resize(m * m, 0.0);
    for i in 0..m {
        for j in 0..=i {
            let of_priors: f64 = rows.chunks(m).map(|row| row[i] * row[j]).sum();
            let product = dot(&columns[i], &columns[j]) + of_priors;
            (square[i * m + j], square[j * m + i]) = (product, product);
        }
    }
}

/// Memory of [`Cheapest`].
#[derive(Debug, Clone, Default)]
pub(super) struct Vertex {
    both: Vec<f64>,
    ray: Ray,
}

/// Finds the cheapest amplitudes of the pieces.
pub(super) struct Cheapest<'a> {
    pub(super) allowed: &'a Amplitudes,
    pub(super) pieces: &'a Pieces,
    pub(super) places: &'a [Place],
}

impl Cheapest<'_> {
    /// Puts them, and returns what rounding may have lifted their cost by.
    pub(super) fn put(&self, costs: &[f64], vertex: &mut [f64], memory: &mut Vertex) -> f64 {
        let Self { allowed, pieces, places } = self;
        let Vertex { both, ray } = memory;
        both.clear();
        both.extend_from_slice(costs);
        rises(places).for_each(|i| both[i] += costs[i - 1]);
        allowed.least(pieces, both, vertex, ray);
        let rounding = allowed.rounding(pieces, both, vertex, ray);
        rises(places).for_each(|i| vertex[i - 1] += vertex[i]);
        rounding
    }

    /// How large each amplitude can be.
    pub(super) fn put_most(&self, most: &mut Vec<f64>) {
        most.clear();
        most.extend((0..self.places.len()).map(|i| self.allowed.most(self.pieces, i)));
    }
}
