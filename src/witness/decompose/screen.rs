//! Which materials a pixel's counts exclude without a fit, and where to begin with the others.
//!
//! All spectra that a material can send lie near a space of few dimensions: what its lighting changes, and the curve of its
//! emission over temperature, which a handful of directions holds to a small part of the noise. In counts divided by √v, v the
//! variances of the cube's mean spectrum, the distance of a pixel's counts to that space (less what the space leaves out of the
//! curve, ρ) bounds every fit of the material from below, at the cost of a few products a band:
//!
//! D ≥ Σ (n′ − N′)²/max(n′, N′) ≥ f ‖z − model‖² ≥ f (√(‖z‖² − ‖Qᵀz‖²) − ρ)²,  f = minᵥ v/n′ / (1 + δ).
//!
//! N′ ≤ (1 + δ) n′ in every band of a fit that is not worse than `cut`, since D ≥ (N′ − n′)²/N′ of each band alone.
//!
//! Within the space the curve is replaced by chords between some temperatures, from which it is away by a sag at most. The distance of
//! the coordinates from each chord, and from the values that the lighting allows beside it, adds to the bound; where it is least, a fit
//! begins.
//!
//! Assumptions: none for the bound; the gain is known (else nothing is excluded).

use super::kernel::MOST;
use super::model::Model;
use super::space::{Space, dot};
use super::step::State;
use crate::simd::{Aligned, Chunk, LANES, added, dispatched, fold};

/// Temperatures of the table from one start to the next.
const STRIDE: usize = 2;
/// Starts of a fit at most.
pub(super) const MOST_STARTS: usize = 3;

/// The spaces of all materials.
#[derive(Debug)]
pub(super) struct Screen {
    /// Bands without the padding.
    used: usize,
    /// What is taken off the counts, and 1/√v.
    reference: Aligned,
    whitening: Aligned,
    /// Directions of a space, those of the lighting first.
    rank: usize,
    lights: usize,
    /// Places of all coordinates of all materials, padded.
    columns: usize,
    /// Q: `[band][material][direction]`.
    directions: Aligned,
    /// Lighting columns in coordinates: `[material][light][direction]`, triangular.
    lighting: Vec<f64>,
    /// Coordinates at the temperatures between which chords are drawn, and what they change along a chord:
    /// `[material][direction][chord]`.
    curve: Aligned,
    along: Aligned,
    /// 1/length² of the chords beyond the lighting, `[material][chord]`.
    shortness: Aligned,
    temperatures_k: Vec<f64>,
    /// Chords, padded.
    grid: usize,
    left_out: Vec<f64>,
    sag: Vec<f64>,
}

/// A pixel before the screen.
#[derive(Debug)]
pub(super) struct Screened {
    white: Aligned,
    coordinates: Aligned,
    /// Squared distances from the chords, and where on them.
    costs: Aligned,
    shares: Aligned,
    square: f64,
    /// Squared distance from the space of each material.
    outside: Vec<f64>,
    /// min v/n′.
    lightest: f64,
    least: f64,
    /// The least of the costs.
    nearest: f64,
}

/// A coordinate beyond all others.
const BEYOND: f64 = 1e150;

impl Screen {
    /// For materials `kinds` of the model and a cube whose mean counts are `mean` (padded as the model).
    pub(super) fn new(model: &Model, kinds: &[usize], mean: &[f64]) -> Self {
        let width = model.width;
        let mut whitening = Aligned::zeros(width);
        let mut reference = Aligned::zeros(width);
        for (w, &mean) in mean.iter().enumerate() {
            whitening[w] = 1.0 / (mean.max(0.0) + model.var_added[w]).max(1.0).sqrt();
            reference[w] = mean.max(0.0);
        }
        let rows = model.rows();
        let spaces: Vec<Space> =
            kinds.iter().map(|&m| Space::new(model, m, &reference, &whitening, rows)).collect();
        let lights = model.vertices - 1;
        let rank = lights + spaces.iter().map(|space| space.curve.len()).max().unwrap_or(0);
        let columns = (kinds.len() * rank).next_multiple_of(LANES);
        let starts: Vec<usize> = (0..rows)
            .step_by(STRIDE)
            .chain((!(rows - 1).is_multiple_of(STRIDE)).then_some(rows - 1))
            .collect();
        let grid = (starts.len() - 1).next_multiple_of(LANES);
        let mut screen = Self {
            used: model.used.len(),
            reference,
            whitening,
            rank,
            lights,
            columns,
            directions: Aligned::zeros(width * columns),
            lighting: vec![0.0; kinds.len() * lights * rank],
            curve: Aligned::zeros(kinds.len() * rank * grid),
            along: Aligned::zeros(kinds.len() * rank * grid),
            shortness: Aligned::zeros(kinds.len() * grid),
            temperatures_k: starts.iter().map(|row| model.temperature_of(*row as f64)).collect(),
            grid,
            left_out: spaces.iter().map(|space| space.left_out).collect(),
            sag: spaces.iter().map(|space| space.sag(&starts)).collect(),
        };
        for (kind, space) in spaces.iter().enumerate() {
            let all: Vec<Option<&Vec<f64>>> =
                space.lights.iter().map(Option::as_ref).chain(space.curve.iter().map(Some)).collect();
            for (i, direction) in all.iter().enumerate() {
                let Some(direction) = direction else { continue };
                for (w, q) in direction.iter().enumerate() {
                    screen.directions[w * columns + kind * rank + i] = *q;
                }
                for (light, column) in space.columns.iter().enumerate() {
                    screen.lighting[(kind * lights + light) * rank + i] = dot(direction, column);
                }
                for (place, ends) in starts.windows(2).enumerate() {
                    let [from, to] = [ends[0], ends[1]].map(|row| dot(direction, &space.points[row]));
                    screen.curve[(kind * rank + i) * grid + place] = from;
                    screen.along[(kind * rank + i) * grid + place] = to - from;
                }
            }
            // What fills the last chunk is farther away than any chord.
            if lights < rank {
                let first = (kind * rank + lights) * grid;
                screen.curve[first + starts.len() - 1..first + grid].fill(BEYOND);
            }
            for place in 0..starts.len() - 1 {
                let along = (lights..rank).map(|i| screen.along[(kind * rank + i) * grid + place]);
                let square: f64 = along.map(|x| x * x).sum();
                screen.shortness[kind * grid + place] = if square > 0.0 { 1.0 / square } else { 0.0 };
            }
        }
        screen
    }

    pub(super) fn room(&self, width: usize) -> Screened {
        Screened {
            white: Aligned::zeros(width),
            coordinates: Aligned::zeros(self.columns),
            costs: Aligned::zeros(self.grid),
            shares: Aligned::zeros(self.grid),
            square: 0.0,
            outside: vec![0.0; self.left_out.len()],
            lightest: 0.0,
            least: 0.0,
            nearest: f64::INFINITY,
        }
    }

    /// Looks at a pixel of counts n and n′.
    pub(super) fn look(&self, counts: &[f64], shifted: &[f64], to: &mut Screened) {
        project(self, counts, shifted, to);
        let Screened { coordinates, outside, square, .. } = to;
        for (outside, coordinates) in outside.iter_mut().zip(coordinates.chunks_exact(self.rank.max(1))) {
            *outside = (*square - coordinates.iter().map(|c| c * c).sum::<f64>()).max(0.0);
        }
    }

    /// What a fit of a material must cost at least if it is to cost no more than `cut`, whatever its temperature and lighting.
    pub(super) fn at_least(&self, kind: usize, cut: f64, seen: &Screened) -> f64 {
        let distance = seen.outside[kind].sqrt() - self.left_out[kind];
        seen.share(cut) * distance.max(0.0).powi(2)
    }

    /// The same with the range of temperature and lighting, from the chords ([`Screen::chords`]).
    pub(super) fn at_least_within(&self, kind: usize, cut: f64, seen: &Screened) -> f64 {
        let distance = (seen.outside[kind] + seen.nearest).sqrt() - self.left_out[kind] - self.sag[kind];
        seen.share(cut) * distance.max(0.0).powi(2)
    }

    /// Finds the distances of a pixel from the chords of a material.
    pub(super) fn chords(&self, kind: usize, seen: &mut Screened) {
        let Screened { coordinates, costs, shares, nearest, .. } = seen;
        chord_distances(self, kind, &coordinates[kind * self.rank..][..self.rank], (costs, shares, nearest));
    }

    /// Where fits of the material whose chords were looked at begin, the most promising first; how many there are.
    pub(super) fn starts(
        &self,
        model: &Model,
        kind: usize,
        seen: &Screened,
        starts: &mut [State; MOST_STARTS],
    ) -> usize {
        let coordinates = self.coordinates(kind, seen);
        let count = self.chord_count();
        let costs = &seen.costs[..count];
        let promising = 2.0 * seen.nearest + seen.outside[kind] + 20.0;
        let (mut found, mut best) = (0, f64::INFINITY);
        for place in 0..count {
            let cost = costs[place];
            let before = place.checked_sub(1).map_or(f64::INFINITY, |before| costs[before]);
            let after = costs.get(place + 1).copied().unwrap_or(f64::INFINITY);
            if !(cost < before && cost <= after) || cost > promising || found == MOST_STARTS {
                continue;
            }
            let share = seen.shares[place];
            let [from, to] = [self.temperatures_k[place], self.temperatures_k[place + 1]];
            let weights = self.weights(kind, coordinates, place, share);
            let mut state = State::at(share.mul_add(to - from, from));
            state.mixture[0] = 1.0 - weights.iter().sum::<f64>();
            state.mixture[1..=self.lights].copy_from_slice(&weights[..self.lights]);
            state.clear(model.vertices);
            starts[found] = state;
            found += 1;
            if cost < best {
                best = cost;
                starts[..found].rotate_right(1);
            }
        }
        found
    }

    fn coordinates<'a>(&self, kind: usize, seen: &'a Screened) -> &'a [f64] {
        &seen.coordinates[kind * self.rank..][..self.rank]
    }

    fn chord_count(&self) -> usize {
        self.temperatures_k.len() - 1
    }

    /// Weights of the vertices but the first that suit a place on a chord best, brought into their range.
    fn weights(&self, kind: usize, coordinates: &[f64], place: usize, share: f64) -> [f64; MOST] {
        let rank = self.rank;
        let off = |i: usize| {
            let at = (kind * rank + i) * self.grid + place;
            coordinates[i] - share.mul_add(self.along[at], self.curve[at])
        };
        let column = |light: usize, i: usize| self.lighting[(kind * self.lights + light) * rank + i];
        let mut weights = [0.0; MOST];
        for light in (0..self.lights).rev() {
            let rest: f64 = (light + 1..self.lights).map(|other| column(other, light) * weights[other]).sum();
            let along = column(light, light);
            weights[light] = if along == 0.0 { 0.0 } else { ((off(light) - rest) / along).clamp(0.0, 1.0) };
        }
        let total: f64 = weights[..self.lights].iter().sum();
        if total > 1.0 {
            weights[..self.lights].iter_mut().for_each(|u| *u /= total);
        }
        weights
    }
}

impl Screened {
    /// f, of fits that cost no more than `cut`: N′ ≤ n′ + cut/2 + √(cut²/4 + cut n′).
    fn share(&self, cut: f64) -> f64 {
        let half = 0.5 * cut;
        let excess = (half + (half * half + cut * self.least).sqrt()) / self.least;
        self.lightest / (1.0 + excess)
    }
}

dispatched! {
    /// Coordinates of a pixel in the spaces of all materials.
    fn project<'a>(screen: &'a Screen, counts: &'a [f64], shifted: &'a [f64], to: &'a mut Screened) {
        let width = counts.len();
        let (mut square, mut lightest, mut least) = ([0.0; LANES], f64::INFINITY, f64::INFINITY);
        for at in (0..width).step_by(LANES) {
            let white: Chunk = std::array::from_fn(|i| {
                (counts[at + i] - screen.reference[at + i]) * screen.whitening[at + i]
            });
            square = added(white, white, square);
            for i in 0..LANES {
                to.white[at + i] = white[i];
                let root = screen.whitening[at + i];
                if at + i < screen.used {
                    lightest = f64::min(lightest, 1.0 / (root * root * shifted[at + i]));
                    least = f64::min(least, shifted[at + i]);
                }
            }
        }
        to.square = fold(&square);
        to.lightest = lightest;
        to.least = least;
        // Four chunks of columns stay in registers while the bands go by.
        const TILE: usize = 4 * LANES;
        let mut at = 0;
        while at < screen.columns {
            let tile = TILE.min(screen.columns - at);
            if tile == TILE {
                let mut sums = [[0.0; LANES]; 4];
                for (w, z) in to.white.iter().enumerate() {
                    let row = &screen.directions[w * screen.columns + at..][..TILE];
                    for (part, sum) in sums.iter_mut().enumerate() {
                        *sum = std::array::from_fn(|i| z.mul_add(row[part * LANES + i], sum[i]));
                    }
                }
                for (part, sum) in sums.iter().enumerate() {
                    to.coordinates[at + part * LANES..][..LANES].copy_from_slice(sum);
                }
                at += TILE;
            } else {
                let mut sum = [0.0; LANES];
                for (w, z) in to.white.iter().enumerate() {
                    let row = &screen.directions[w * screen.columns + at..][..LANES];
                    sum = std::array::from_fn(|i| z.mul_add(row[i], sum[i]));
                }
                to.coordinates[at..][..LANES].copy_from_slice(&sum);
                at += LANES;
            }
        }
    }
}

dispatched! {
    /// Squared distances from the chords of a material, and where on them.
    fn chord_distances<'a>(
        screen: &'a Screen,
        kind: usize,
        coordinates: &'a [f64],
        found: (&'a mut Aligned, &'a mut Aligned, &'a mut f64),
    ) {
        let (costs, shares, nearest) = found;
        let (rank, grid, lights) = (screen.rank, screen.grid, screen.lights);
        let mut least = [f64::INFINITY; LANES];
        for at in (0..grid).step_by(LANES) {
            let lanes = |from: &[f64], i: usize| -> Chunk {
                let from = &from[(kind * rank + i) * grid + at..][..LANES];
                std::array::from_fn(|k| from[k])
            };
            let (mut square, mut dot) = ([0.0; LANES], [0.0; LANES]);
            for (i, coordinate) in coordinates.iter().enumerate().skip(lights) {
                let (curve, along) = (lanes(&screen.curve, i), lanes(&screen.along, i));
                let off: Chunk = std::array::from_fn(|k| coordinate - curve[k]);
                square = added(off, off, square);
                dot = added(off, along, dot);
            }
            let shortness = &screen.shortness[kind * grid + at..][..LANES];
            let share: Chunk = std::array::from_fn(|k| {
                (dot[k] * shortness[k]).clamp(0.0, 1.0)
            });
            // What is left at the place: |off|² - share (2 dot - share |along|²), formed anew so that nothing cancels.
            let mut cost = [0.0; LANES];
            for (i, coordinate) in coordinates.iter().enumerate().skip(lights) {
                let (curve, along) = (lanes(&screen.curve, i), lanes(&screen.along, i));
                let off: Chunk = std::array::from_fn(|k| coordinate - share[k].mul_add(along[k], curve[k]));
                cost = added(off, off, cost);
            }
            if lights == 1 {
                // Beside a chord the lighting reaches an interval.
                let reach = screen.lighting[kind * rank];
                let (curve, along) = (lanes(&screen.curve, 0), lanes(&screen.along, 0));
                let beyond: Chunk = std::array::from_fn(|k| {
                    let low = curve[k] + f64::min(along[k], 0.0) + f64::min(reach, 0.0);
                    let high = curve[k] + f64::max(along[k], 0.0) + f64::max(reach, 0.0);
                    f64::max(0.0, f64::max(low - coordinates[0], coordinates[0] - high))
                });
                cost = added(beyond, beyond, cost);
            }
            costs[at..][..LANES].copy_from_slice(&cost);
            shares[at..][..LANES].copy_from_slice(&share);
            least = std::array::from_fn(|k| if cost[k] < least[k] { cost[k] } else { least[k] });
        }
        *nearest = least.into_iter().fold(f64::INFINITY, f64::min);
    }
}
