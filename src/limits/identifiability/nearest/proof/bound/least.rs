//! The least cost over a box, and the bound by the tangent there ([`super::super::tangent`]).
//!
//! From a point of the box Newton steps lead down, each to the least of a quadratic over all that is allowed, or a part of the way. At every
//! point the tangent is a bound; the search ends where that is enough, where the cost itself is not, or where hardly anything is left between.

use super::super::amplitudes::Amplitudes;
use super::super::hull::factor_of;
use super::super::orthogonal::inner;
use super::super::tangent::{Bands, size_of_product, slopes, weights};
use super::super::vectors::{add_into, square_of_quotient};
use super::super::view::View;
use super::Bounder;
use super::pieces::{Cheapest, Place, column, put_products, put_square};
use crate::sum::dot;

/// Rounding of products and sums of bands, as a share of the sizes of their terms.
const ROUNDING: f64 = 3e-15;
/// Tangents at most, the first of them after steps in which a band alone reaches the target's counts, and parts of a step that are tried.
const TANGENTS: usize = 12;
const STRAIGHT: usize = 2;
const PARTS: [f64; 4] = [1.0, 0.4, 0.1, 0.02];
/// Share of a cost by which a step must lower it, of what its slope promises.
const PROMISED: f64 = 0.01;
/// Share of what is wanting below which a fall of the cost ends the search.
const WORTH: f64 = 0.02;

/// The bands of a view where such counts are compared, of which chords may miss so much.
fn of_bands<'s>(view: &'s View<'_>, [counts, missed]: [&'s [f64]; 2]) -> Bands<'s> {
    Bands { root: &view.root, own: &view.counts, noise: &view.noise, counts, missed }
}

impl Bounder {
    /// A bound by the tangents of the cost from the point on, and the least cost found in the box.
    pub(super) fn tangents(&mut self, view: &View<'_>, allowed: &Amplitudes, enough: f64) -> (f64, f64) {
        let mut lower = 0.0_f64;
        let mut cost = self.evaluate(view);
        for step in 0..TANGENTS {
            crate::stop::check();
            if cost.is_nan() {
                break;
            }
            let (bound, gap) = self.tangent(view, allowed, cost);
            lower = lower.max(bound);
            // The least over the box is no more than what is found in it.
            if lower >= enough || cost < enough || gap <= WORTH * (enough - lower) || step + 1 == TANGENTS {
                break;
            }
            self.newton(view, allowed, step >= STRAIGHT);
            let promised =
                inner(&self.quadratic.linear, &self.hull.point) - inner(&self.quadratic.linear, &self.point);
            let from = self.point.clone();
            let mut fell = false;
            for part in PARTS {
                let points = from.iter().zip(&self.hull.point);
                self.point.clear();
                self.point.extend(points.map(|(from, to)| part.mul_add(to - from, *from)));
                let there = self.evaluate(view);
                if there < cost + PROMISED * part * promised.min(0.0) {
                    (cost, fell) = (there, true);
                    break;
                }
            }
            if !fell {
                self.point = from;
                break;
            }
        }
        (lower, cost)
    }

    /// The least cost at the point within what chords miss; puts its slopes there.
    fn evaluate(&mut self, view: &View<'_>) -> f64 {
        let Self { places, low, rise, half, point, counts, slack, pull, .. } = self;
        let Self { pieces, rows, residuals, .. } = self;
        let bands = view.root.len();
        for line in [&mut *counts, slack] {
            line.clear();
            line.resize(bands, 0.0);
        }
        pull.resize(bands, 0.0);
        for (place, amount) in places.iter().zip(&*point) {
            add_into(*amount, column(view, [low, rise], *place), counts);
            if let Place::Low(axis) = *place {
                add_into(*amount, &half[axis], slack);
            }
        }
        let [cost, by_own] = slopes(of_bands(view, [counts, slack]), &view.in_boxes().share, pull);
        rows.clear();
        residuals.clear();
        view.priors.put_pieces(pieces, |constant, entries| {
            residuals.push(constant + inner(entries, point));
            rows.extend_from_slice(entries);
        });
        self.by_own = by_own;
        cost + inner(residuals, residuals)
    }

    /// The cost at the point if chords missed nothing.
    pub(super) fn without_chords(&mut self, view: &View<'_>) -> f64 {
        let Self { counts, slack, pull, .. } = self;
        slack.fill(0.0);
        slopes(of_bands(view, [counts, slack]), &view.in_boxes().share, pull)[0]
    }

    /// The bound by the tangent at the point, and how far below the cost there it falls but for rounding.
    fn tangent(&mut self, view: &View<'_>, allowed: &Amplitudes, cost: f64) -> (f64, f64) {
        let Self { places, low, rise, half, point, pull, pieces, rows, residuals, .. } = self;
        let Self { quadratic, least_cost, sizes, vertex, memory, .. } = self;
        let m = places.len();
        quadratic.linear.clear();
        least_cost.clear();
        sizes.clear();
        for (i, place) in places.iter().enumerate() {
            let spectrum = column(view, [low, rise], *place);
            let of_priors = residuals.iter().zip(rows.chunks(m));
            let (by_priors, sizes_of_priors) = of_priors.fold((0.0, 0.0), |(sum, size), (residual, row)| {
                let term = 2.0 * residual * row[i];
                (sum + term, size + term.abs())
            });
            let missed = if let Place::Low(axis) = *place { size_of_product(pull, &half[axis]) } else { 0.0 };
            let all = size_of_product(pull, spectrum);
            let size = ROUNDING * (all + missed + sizes_of_priors);
            // What chords miss holds the rounding of their ends.
            let of_spectrum = if let Place::Fixed(_) = *place { view.rounding * all } else { 0.0 };
            let own = dot(pull, spectrum) - missed + by_priors;
            quadratic.linear.push(own);
            least_cost.push(own - size - of_spectrum);
            sizes.push([size, size + of_spectrum]);
        }
        vertex.clear();
        vertex.resize(m, 0.0);
        let lifted = Cheapest { allowed, pieces, places }.put(least_cost, vertex, memory);
        let (mut gap, mut lost) = (0.0, lifted + ROUNDING * cost + view.rounding * self.by_own);
        for i in 0..m {
            gap += quadratic.linear[i] * (point[i] - vertex[i]);
            lost += sizes[i][0] * point[i].abs() + sizes[i][1] * vertex[i].abs();
        }
        let bound = cost - gap.max(0.0) - lost;
        (if bound.is_nan() { f64::NEG_INFINITY } else { bound }, gap)
    }

    /// A Newton step from the point over what is allowed: where it ends is the point of the hull.
    fn newton(&mut self, view: &View<'_>, allowed: &Amplitudes, exact: bool) {
        let Self { places, low, rise, whitened, weight, pull, rows, residuals, point, counts, slack, .. } =
            self;
        weight.resize(view.root.len(), 0.0);
        weights(of_bands(view, [counts, slack]), exact, weight);
        let Self { square, quadratic, hull, pieces, memory, .. } = self;
        put_products(whitened, [low, rise], view, places, weight);
        put_square(square, &whitened[..places.len()], rows);
        factor_of(square, &mut quadratic.factor, &mut quadratic.excess);
        quadratic.origin.clone_from(point);
        let of_priors = inner(residuals, residuals);
        quadratic.length = (0.25 * square_of_quotient(pull, weight) + of_priors).sqrt();
        let oracle = Cheapest { allowed, pieces, places };
        oracle.put_most(&mut quadratic.most);
        hull.least(quadratic, |costs, vertex| oracle.put(costs, vertex, memory), f64::INFINITY);
    }
}
