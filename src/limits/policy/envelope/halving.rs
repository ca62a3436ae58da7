//! The intervals of a cell's sources: the whole range of each, and halves of them.
//!
//! What is nearer than the distance attained, D, has √(N′ + v) ≤ √(N + v) + D in every band, so that no source of the
//! alternative is brighter: c·g(T_low) ≤ (√(N + v) + D)² − v bounds its factor, and an interval too hot for the least factor
//! is empty.

use super::cell::Cell;
use super::linear::{RANK, Vector};
use super::model::Model;
use super::node::{Detail, Node, RADII, Reach, Spread};
use super::series::{TERMS, planck_series, remainder};
use crate::spectrum::Bands;
use crate::sum::dot;

/// Largest half width of a temperature of the alternative's own, as a share of its middle.
const WIDEST_FREE: f64 = 0.25;
/// Rounding of a count, relative.
const ROUNDING: f64 = 1e-9;

impl Cell {
    /// The whole range of a source.
    pub(super) fn root(&self, model: &Model<'_>, s: usize) -> Node {
        let t = self.region[s].t;
        let spreads = self.spreads(model, s, t[1]);
        self.node(model, s, t, spreads, None)
    }

    /// The two halves of an interval.
    pub(super) fn halve(&self, model: &Model<'_>, s: usize, node: u32) -> [Node; 2] {
        let whole = &self.sources[s][node as usize];
        let [low, high] = whole.t;
        let middle = if whole.detail == Detail::Wide { (low * high).sqrt() } else { 0.5 * (low + high) };
        let top = [whole.own_spread.clone(), whole.other_spread.clone()];
        let below = self.spreads(model, s, middle);
        [
            self.node(model, s, [low, middle], below, Some(whole)),
            self.node(model, s, [middle, high], top, Some(whole)),
        ]
    }

    fn node(
        &self,
        model: &Model<'_>,
        s: usize,
        t: [f64; 2],
        top: [Spread; 2],
        parent: Option<&Node>,
    ) -> Node {
        let [own_spread, other_spread] = top;
        let (centre, half) = (0.5 * (t[0] + t[1]), 0.5 * (t[1] - t[0]));
        // What holds of the whole of a narrow interval holds of its halves.
        let known = parent.filter(|parent| parent.detail == Detail::Cubic);
        let reach = known.map_or_else(|| self.reach(model, s, t), |parent| parent.reach);
        let most = self.most(model, s, t[0]);
        let mut node = Node {
            t,
            detail: Detail::Cubic,
            own: [[0.0; RANK]; TERMS],
            other: [[0.0; RANK]; TERMS],
            along: None,
            own_rest: 0.0,
            other_rest: 0.0,
            own_spread,
            other_spread,
            most,
            reach,
            halves: None,
        };
        let span = self.region[s];
        let largest = span.own[1].min(most[0]) * reach.size[0] + span.other[1].min(most[1]) * reach.size[1];
        if known.is_none() && largest <= self.faint {
            node.detail = Detail::Faint;
            [node.own_rest, node.other_rest] = reach.size;
            return node;
        }
        let source = &model.sources[s];
        if source.role.is_free() && half > WIDEST_FREE * centre {
            node.detail = Detail::Wide;
            return node;
        }
        let series = planck_series(model.scene.bands.nodes_cm1(), centre, half);
        let second = span.other[1] > 0.0;
        for (term, radiance) in series.iter().enumerate() {
            node.own[term] = self.components(&model.counts(&source.own, radiance));
            if second {
                node.other[term] = self.components(&model.counts(&source.other, radiance));
            }
        }
        if let Some(stretch) = &model.along {
            let mut along = Box::new([[[[0.0; RANK]; TERMS]; 2]; 2]);
            for (term, radiance) in series.iter().enumerate() {
                let of = |bands: &Bands, strength: &[f64]| {
                    self.components(&model.counts_in(bands, strength, radiance))
                };
                let corners = |near: &mut Vector, strength: &[f64]| {
                    corners_of(near, &of(stretch.middle, strength), &of(stretch.far, strength))
                };
                [along[0][0][term], along[1][0][term]] = corners(&mut node.own[term], &source.own);
                if second {
                    [along[0][1][term], along[1][1][term]] = corners(&mut node.other[term], &source.other);
                }
            }
            node.along = Some(along);
        }
        let least = |which: usize| {
            let radii = RADII.iter().zip(&reach.discs);
            radii
                .map(|(share, norms)| norms[which] * remainder(half, share * reach.lowest_k))
                .fold(f64::INFINITY, f64::min)
                * if node.along.is_some() { 1.5 } else { 1.0 }
        };
        let [own_sag, other_sag] = node.reach.sag;
        (node.own_rest, node.other_rest) =
            (least(0) + own_sag, if second { least(1) + other_sag } else { 0.0 });
        node
    }

    fn reach(&self, model: &Model<'_>, s: usize, t: [f64; 2]) -> Reach {
        let bands = model.scene.bands;
        let discs = RADII.map(|share| self.norms(model, bands, s, t[1] + share * t[0]));
        let sag = model.along.map_or([0.0; 2], |along| self.norms(model, along.sag, s, t[1]));
        Reach { lowest_k: t[0], size: self.norms(model, bands, s, t[1]), sag, discs }
    }

    /// Norms of the whitened magnitudes of f and g at a temperature, in bands of some weights.
    fn norms(&self, model: &Model<'_>, bands: &Bands, s: usize, temperature_k: f64) -> [f64; 2] {
        let radiance = model.radiance(temperature_k);
        let norm = |strength: &[f64]| {
            let magnitude: Vec<f64> = strength.iter().map(|x| x.abs()).collect();
            let counts = self.whitened(model.counts_in(bands, &magnitude, &radiance));
            dot(&counts, &counts).sqrt()
        };
        let second = self.region[s].other[1] > 0.0;
        [norm(&model.sources[s].own), if second { norm(&model.sources[s].other) } else { 0.0 }]
    }

    /// The largest factors with which a source of the alternative is not too bright at a temperature.
    pub(super) fn most(&self, model: &Model<'_>, s: usize, temperature_k: f64) -> [f64; 2] {
        let (source, span) = (&model.sources[s], self.region[s]);
        let least = |strength: &[f64]| {
            let counts = model.counts_of_far(strength, &model.radiance(temperature_k));
            let shares = counts.iter().zip(&self.brightest).filter(|(count, _)| **count > 0.0);
            shares.map(|(count, most)| most / count).fold(f64::INFINITY, f64::min) * (1.0 + ROUNDING)
        };
        match (source.role.is_free(), span.other[1] > 1.0) {
            (true, _) => [least(&source.alternative), f64::INFINITY],
            // Beyond 1 only where the gain is unknown: elsewhere this would cost more than it spares.
            (false, true) => [f64::INFINITY, least(&source.alone)],
            (false, false) => [f64::INFINITY; 2],
        }
    }
}

/// h and β of a stretch (`stretch`); near becomes the middle.
fn corners_of(near: &mut Vector, middle: &Vector, far: &Vector) -> [Vector; 2] {
    let (mut half, mut bend) = ([0.0; RANK], [0.0; RANK]);
    for (i, near) in near.iter_mut().enumerate() {
        half[i] = 0.5 * (far[i] - *near);
        bend[i] = middle[i] - 0.5 * (*near + far[i]);
        *near = middle[i];
    }
    [half, bend]
}
