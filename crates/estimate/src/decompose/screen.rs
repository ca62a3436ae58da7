//! Which materials a pixel's counts exclude without a fit, and where to begin with the others.
//!
//! All spectra that a material can send lie near a space of few dimensions: what its lighting changes, and the curve of its
//! emission over temperature, which a handful of directions holds to a small part of the noise. In counts divided by √v, v the
//! variances of a blackbody in the middle of the range, the distance of a pixel's counts to that space (less what the space leaves out of the
//! curve, ρ) bounds every fit of the material from below, at the cost of a few products a band:
//!
//! D ≥ Σ (n′ − N′)²/max(n′, N′) ≥ f ‖z − model‖² ≥ f (√(‖z‖² − ‖Qᵀz‖²) − ρ)²,  f = minᵥ v/n′ / (1 + δ).
//!
//! N′ ≤ (1 + δ) n′ in every band of a fit that is not worse than `cut`, since D ≥ (N′ − n′)²/N′ of each band alone.
//!
//! With errors of the library ([`super::library_error`]) variances are at most N′ + ε max(N′, X)², ε the largest eigenvalue of the
//! covariance of the relative errors and X the brightest of the surroundings: what errors reach is N′ − X. v and n′ above are of that form
//! too, and N′ + ε max(N′, X)² ≤ (1 + δ)² (n′ + ε max(n′, X)²).
//!
//! Within the space the curve is replaced by chords between some temperatures, from which it is away by a sag at most. The distance of
//! the coordinates from each chord, and from the values that the lighting allows beside it, adds to the bound; where it is least, a fit
//! begins.
//!
//! Assumptions: none for the bound; the gain is known (else nothing is excluded).

use super::model::{MOST, Model};
use super::space::{Space, dot};
use super::step::State;
use hadar::aligned::Aligned;
use hadar::simd::{Chunk, LANES, added, dispatched, fold, fused};

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
    /// ε, and X of each band.
    error: f64,
    brightest: Aligned,
    /// Directions of a space, those of the lighting first.
    rank: usize,
    lights: usize,
    /// Places of all coordinates of all materials, padded.
    columns: usize,
    /// Q: `[band][material][direction]`.
    directions: Aligned,
    /// Lighting columns in coordinates: `[material][light][direction]`, triangular.
    lighting: Vec<f64>,
    /// Coordinates at the temperatures between which chords are drawn, the last one again and again behind them:
    /// `[material][direction][temperature]`, `nodes` a direction.
    curve: Aligned,
    nodes: usize,
    /// 1/length² and length² of the chords beyond the lighting, `[material][chord]`.
    shortness: Aligned,
    length: Aligned,
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
    /// Squared distances from the chords, and where on them: `[material][chord]`.
    costs: Aligned,
    shares: Aligned,
    square: f64,
    /// Squared distance from the space of each material.
    outside: Vec<f64>,
    /// min v/n′, with ε its likes.
    lightest: f64,
    least: f64,
    /// max (X/n′)².
    glare: f64,
    /// The least of the costs of each material whose chords were looked at, else NaN.
    nearest: Vec<f64>,
}

impl Screened {
    /// The counts, divided by their deviations.
    pub(super) fn white(&self) -> &[f64] {
        &self.white
    }
}

/// Share of a square that rounding may take off what is left of it: a hundred operations.
const ROUNDING: f64 = 2e-14;

impl Screen {
    /// For materials `kinds` of the model. It is laid out for a blackbody in the middle of the range of temperatures, not for what the cube
    /// holds: no pixel changes how another one is rounded.
    pub(super) fn new(model: &Model, kinds: &[usize], error: f64) -> Self {
        let width = model.width;
        let mut brightest = Aligned::zeros(width);
        for j in 0..model.vertices {
            brightest.iter_mut().zip(model.light(j)).for_each(|(most, light)| *most = most.max(*light));
        }
        let mut whitening = Aligned::zeros(width);
        let mut reference = Aligned::zeros(width);
        let [low, high] = model.range_k;
        for (w, &mean) in model.blackbody(0.5 * (low + high)).iter().enumerate() {
            let shot = (mean.max(0.0) + model.var_added[w]).max(1.0);
            let most = shot.max(brightest[w]);
            whitening[w] = 1.0 / (error * most).mul_add(most, shot).sqrt();
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
        let nodes = grid + LANES;
        let mut screen = Self {
            used: model.used.len(),
            reference,
            whitening,
            error,
            brightest,
            rank,
            lights,
            columns,
            directions: Aligned::zeros(width * columns),
            lighting: vec![0.0; kinds.len() * lights * rank],
            curve: Aligned::zeros(kinds.len() * rank * nodes),
            nodes,
            shortness: Aligned::zeros(kinds.len() * grid),
            length: Aligned::zeros(kinds.len() * grid),
            temperatures_k: starts.iter().map(|row| model.temperature_of(*row as f64)).collect(),
            grid,
            left_out: spaces.iter().map(|space| space.left_out).collect(),
            sag: spaces.iter().map(|space| space.sag(&starts)).collect(),
        };
        for (kind, space) in spaces.iter().enumerate() {
            hadar::stop::check();
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
                let curve = &mut screen.curve[(kind * rank + i) * nodes..][..nodes];
                for (place, to) in curve.iter_mut().enumerate() {
                    *to = dot(direction, &space.points[starts[place.min(starts.len() - 1)]]);
                }
            }
            for place in 0..starts.len() - 1 {
                let along = (lights..rank).map(|i| screen.along(kind, i, place).1);
                let square: f64 = along.map(|x| x * x).sum();
                screen.shortness[kind * grid + place] = if square > 0.0 { 1.0 / square } else { 0.0 };
                screen.length[kind * grid + place] = square;
            }
        }
        screen
    }

    /// The space of a material, in counts divided by their deviations as here.
    pub(super) fn space(&self, model: &Model, m: usize) -> Space {
        Space::new(model, m, &self.reference, &self.whitening, model.rows())
    }

    pub(super) fn room(&self, width: usize) -> Screened {
        Screened {
            white: Aligned::zeros(width),
            coordinates: Aligned::zeros(self.columns),
            costs: Aligned::zeros(self.left_out.len() * self.grid),
            shares: Aligned::zeros(self.left_out.len() * self.grid),
            square: 0.0,
            outside: vec![0.0; self.left_out.len()],
            lightest: 0.0,
            least: 0.0,
            glare: 0.0,
            nearest: vec![f64::NAN; self.left_out.len()],
        }
    }

    /// Looks at a pixel of counts n and n′.
    pub(super) fn look(&self, counts: &[f64], shifted: &[f64], to: &mut Screened) {
        project(self, counts, shifted, to);
        let Screened { coordinates, outside, square, nearest, .. } = to;
        for (outside, coordinates) in outside.iter_mut().zip(coordinates.chunks_exact(self.rank.max(1))) {
            let inside: f64 = coordinates.iter().map(|c| c * c).sum();
            *outside = (*square * (1.0 - ROUNDING) - inside).max(0.0);
        }
        nearest.fill(f64::NAN);
    }

    /// The farthest that a fit which costs no more than `cut` may be from the counts: √(cut/f), δ from
    /// δ² = cut [(1 + δ)/n′ + ε (1 + δ)² + ε (X/n′)²].
    pub(super) fn reach(&self, cut: f64, seen: &Screened) -> f64 {
        let left = 1.0 - cut * self.error;
        if left <= 0.0 {
            return f64::INFINITY;
        }
        let half = 0.5 * cut * (1.0 + 2.0 * self.error * seen.least);
        let alone = cut * seen.least * self.error.mul_add((1.0 + seen.glare) * seen.least, 1.0);
        let excess = (half + (half * half + left * alone).sqrt()) / (left * seen.least);
        let grown = if self.error > 0.0 { (1.0 + excess).powi(2) } else { 1.0 + excess };
        (cut * grown / seen.lightest).sqrt()
    }

    /// The most that χ² of a fit may be where χ² + Σ ln (N′/n′) is `excess`: with variances of at most u n′², Σ |ln (N′/n′)| is at most
    /// 3 √(χ² Σ u) of bands with N′ above n′/16, and below it a band adds more to χ² than it takes of the logarithms.
    pub(super) fn most_chi_square(&self, excess: f64, shifted: &[f64]) -> f64 {
        let each = shifted[..self.used].iter().zip(&*self.brightest).map(|(n, bright)| {
            let most = n.max(*bright) / n;
            (self.error * most).mul_add(most, 1.0 / n)
        });
        let (sum, largest) = each.fold((0.0, 0.0), |(sum, most): (f64, f64), u| (sum + u, most.max(u)));
        let half = 1.5 * sum.sqrt();
        let most = (half + (half * half + excess.max(0.0)).sqrt()).powi(2);
        if largest <= 0.02 { most } else { f64::INFINITY }
    }

    /// Whether a material is farther away than that, whatever its temperature and lighting.
    pub(super) fn is_beyond(&self, kind: usize, reach: f64, seen: &Screened) -> bool {
        seen.outside[kind] > (reach + self.left_out[kind]).powi(2)
    }

    /// The same with the range of temperature and lighting, from the chords.
    pub(super) fn is_beyond_within(&self, kind: usize, reach: f64, seen: &mut Screened) -> bool {
        seen.outside[kind] + self.nearest(kind, seen) > (reach + self.left_out[kind] + self.sag[kind]).powi(2)
    }

    /// Squared distance of a pixel's counts from what a material sends, without a range of temperature or lighting.
    pub(super) fn outside(&self, kind: usize, seen: &Screened) -> f64 {
        seen.outside[kind]
    }

    /// Squared distance of a pixel from the nearest chord of a material.
    fn nearest(&self, kind: usize, seen: &mut Screened) -> f64 {
        if seen.nearest[kind].is_nan() {
            let Screened { coordinates, costs, shares, nearest, .. } = seen;
            let [costs, shares] = [costs, shares].map(|of| &mut of[kind * self.grid..][..self.grid]);
            nearest[kind] =
                chord_distances(self, kind, &coordinates[kind * self.rank..][..self.rank], costs, shares);
        }
        seen.nearest[kind]
    }

    /// Brings the material whose chords come nearest to a pixel to the front, of materials with their distances without a range.
    /// Chords of materials that are farther away than that are not looked at.
    pub(super) fn nearest_first(&self, outside: &mut [(f64, usize)], seen: &mut Screened) {
        let mut best = f64::INFINITY;
        for looked in 0..outside.len() {
            let rest = outside[looked..].iter().enumerate();
            let Some((next, _)) = rest.min_by(|a, b| a.1.0.total_cmp(&b.1.0)) else { return };
            outside.swap(looked, looked + next);
            let (square, kind) = outside[looked];
            if square > best {
                return;
            }
            let within = square + self.nearest(kind, seen);
            if within < best {
                best = within;
                outside.swap(0, looked);
            }
        }
    }

    /// Where fits of a material begin, the most promising first; how many there are.
    pub(super) fn starts(
        &self,
        model: &Model,
        kind: usize,
        seen: &mut Screened,
        starts: &mut [State; MOST_STARTS],
    ) -> usize {
        let promising = 2.0 * self.nearest(kind, seen) + seen.outside[kind] + 20.0;
        let coordinates = self.coordinates(kind, seen);
        let count = self.chord_count();
        let costs = &seen.costs[kind * self.grid..][..count];
        let (mut found, mut best) = (0, f64::INFINITY);
        for place in 0..count {
            let cost = costs[place];
            if cost > promising || found == MOST_STARTS {
                continue;
            }
            let before = place.checked_sub(1).map_or(f64::INFINITY, |before| costs[before]);
            let after = costs.get(place + 1).copied().unwrap_or(f64::INFINITY);
            if !(cost < before && cost <= after) {
                continue;
            }
            let share = seen.shares[kind * self.grid + place];
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

    /// Where a chord begins in a direction, and how far it goes.
    fn along(&self, kind: usize, direction: usize, place: usize) -> (f64, f64) {
        let at = (kind * self.rank + direction) * self.nodes + place;
        (self.curve[at], self.curve[at + 1] - self.curve[at])
    }

    /// Weights of the vertices but the first that suit a place on a chord best, brought into their range.
    fn weights(&self, kind: usize, coordinates: &[f64], place: usize, share: f64) -> [f64; MOST] {
        let rank = self.rank;
        let off = |i: usize| {
            let (from, along) = self.along(kind, i, place);
            coordinates[i] - share.mul_add(along, from)
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

dispatched! {
    /// Coordinates of a pixel in the spaces of all materials.
    fn project<'a>(screen: &'a Screen, counts: &'a [f64], shifted: &'a [f64], to: &'a mut Screened) {
        let width = counts.len();
        let (mut square, mut lightest, mut least) = ([0.0; LANES], f64::INFINITY, f64::INFINITY);
        let mut glare = 0.0;
        for at in (0..width).step_by(LANES) {
            let white: Chunk = std::array::from_fn(|i| {
                (counts[at + i] - screen.reference[at + i]) * screen.whitening[at + i]
            });
            square = added(white, white, square);
            for i in 0..LANES {
                to.white[at + i] = white[i];
                let root = screen.whitening[at + i];
                if at + i < screen.used {
                    let (n, bright) = (shifted[at + i], screen.brightest[at + i]);
                    let most = f64::max(n, bright);
                    let variance = (screen.error * most).mul_add(most, n);
                    lightest = f64::min(lightest, 1.0 / (root * root * variance));
                    least = f64::min(least, n);
                    glare = f64::max(glare, bright / n);
                }
            }
        }
        to.square = fold(&square);
        to.lightest = lightest;
        to.least = least;
        to.glare = glare * glare;
        let chunks = screen.columns / LANES;
        let mut at = 0;
        while at < chunks {
            at += match chunks - at {
                TILE.. => project_tile::<TILE>(screen, at, to),
                4.. => project_tile::<4>(screen, at, to),
                _ => project_tile::<1>(screen, at, to),
            };
        }
    }
}

/// Chunks of columns that stay in registers while the bands go by.
const TILE: usize = 8;

/// [`project`] on N chunks of columns; how many these are.
#[inline(always)]
fn project_tile<const N: usize>(screen: &Screen, at: usize, to: &mut Screened) -> usize {
    let mut sums = [[0.0; LANES]; N];
    for (z, row) in to.white.iter().zip(screen.directions.chunks_exact(screen.columns)) {
        let row = &row[at * LANES..].as_chunks().0[..N];
        for part in 0..N {
            sums[part] = fused(*z, row[part], sums[part]);
        }
    }
    to.coordinates[at * LANES..][..N * LANES].copy_from_slice(sums.as_flattened());
    N
}

dispatched! {
    /// Squared distances from the chords of a material, where on them, and the least of them.
    fn chord_distances<'a>(
        screen: &'a Screen,
        kind: usize,
        coordinates: &'a [f64],
        costs: &'a mut [f64],
        shares: &'a mut [f64],
    ) -> f64 {
        let (rank, grid, lights) = (screen.rank, screen.grid, screen.lights);
        let mut least = [f64::INFINITY; LANES];
        for at in (0..grid).step_by(LANES) {
            let chord = |i: usize| -> [Chunk; 2] {
                let nodes = &screen.curve[(kind * rank + i) * screen.nodes + at..][..LANES + 1];
                [std::array::from_fn(|k| nodes[k]), std::array::from_fn(|k| nodes[k + 1] - nodes[k])]
            };
            let (mut square, mut dot) = ([0.0; LANES], [0.0; LANES]);
            for (i, coordinate) in coordinates.iter().enumerate().skip(lights) {
                let [curve, along] = chord(i);
                let off: Chunk = std::array::from_fn(|k| coordinate - curve[k]);
                square = added(off, off, square);
                dot = added(off, along, dot);
            }
            let shortness = &screen.shortness[kind * grid + at..][..LANES];
            let length = &screen.length[kind * grid + at..][..LANES];
            // Loops instead of closures of this length, which would be compiled for the oldest processor.
            let (mut share, mut cost) = ([0.0; LANES], [0.0; LANES]);
            for k in 0..LANES {
                share[k] = (dot[k] * shortness[k]).clamp(0.0, 1.0);
                // |off|² − share (2 dot − share |along|²), less than what it may lose.
                let gone = share[k] * share[k].mul_add(-length[k], 2.0 * dot[k]);
                cost[k] = f64::max(0.0, square[k].mul_add(1.0 - ROUNDING, -gone));
            }
            if lights == 1 {
                // Beside a chord the lighting reaches an interval.
                let reach = screen.lighting[kind * rank];
                let [curve, along] = chord(0);
                for k in 0..LANES {
                    let low = curve[k] + f64::min(along[k], 0.0) + f64::min(reach, 0.0);
                    let high = curve[k] + f64::max(along[k], 0.0) + f64::max(reach, 0.0);
                    let beyond = f64::max(0.0, f64::max(low - coordinates[0], coordinates[0] - high));
                    cost[k] = beyond.mul_add(beyond, cost[k]);
                }
            }
            costs[at..][..LANES].copy_from_slice(&cost);
            shares[at..][..LANES].copy_from_slice(&share);
            least = std::array::from_fn(|k| if cost[k] < least[k] { cost[k] } else { least[k] });
        }
        least.into_iter().fold(f64::INFINITY, f64::min)
    }
}
