//! Local distances of every material against every other one, in one scene.
//!
//! All that depends on the target alone is done once per target: signal, weights u, the nuisance columns
//! orthogonalised to q̂ᵢ. For an alternative e′ the score of the material is v = (e′ − e)·c with c = G w C (C
//! contrast), so that with Δ = e′ − e
//!
//!   4d² = Σ m Δ² − Σᵢ (Σ kᵢ Δ)²,   m = u c²,  kᵢ = u c q̂ᵢ
//!
//! is one pass over the bands with 2 + n multiplications each. The subtraction loses u·(none/d)² of d, none the
//! distance with no nuisance; where it would lose more than [`ONE_PASS`] allows, the residual is formed
//! band by band in a second pass, and beyond [`TWO_PASSES`] the pair goes to [`LocalSolver`], which judges rank
//! and rounding. So do targets with a nuisance that is dependent, or nearly, and those whose contrast nearly vanishes at
//! a node. Results agree with those of [`LocalSolver`] to 1e-14·none/d, or by as much as rounding may have turned the
//! directions of the nuisances: [`LocalMatrix::relative_errors`].
//!
//! Assumption: all targets in the same state. Source: paper S27–S30, Algorithm 3.

mod kernels;

use self::kernels::{
    Contrast, Lent, MOST_NUISANCES, TOGETHER, contrast_into, direction_into, projections, residual_square,
    weighted_square,
};
use crate::error::{Error, Result};
use crate::fisher::{Counting, Projector, Unknowns};
use crate::identifiability::local::{LocalSolver, SAFE_RANGE};
use crate::scene::{Jacobian, Parameter, State, Surroundings};
use crate::simd::{Aligned, LANES, spaced};
use crate::spectrum::Bands;
use rayon::prelude::*;

/// Largest none/d for which the one-pass difference of squares keeps 1e-14·none/d: 2u·(none/d)² below it.
const ONE_PASS: f64 = 16.0;
/// Largest none/d for which a residual once projected is good; beyond it rank and rounding are judged too.
const TWO_PASSES: f64 = 1e5;
/// Rounding of the elements of a score whose terms do not cancel, and most that they may cancel for targets to share.
const ROUNDING: f64 = 1e-15;
const MOST_CANCELLATION: f64 = 1e3;
/// Squares of lengths that lose no digits.
const SAFE_SQUARES: std::ops::RangeInclusive<f64> = 1e-280..=1e280;
/// Bands × materials² beyond which threads are worth their while.
const WORTH_THREADS: usize = 2_000_000;

/// Which noise weighs the bands.
#[derive(Debug, Clone, Copy)]
enum Weights<'c> {
    PerPhoton,
    Counting(&'c Counting),
}

/// Local distances of materials against each other, row by row of the target.
///
/// ```
/// use hadar::fisher::{Nuisance, Unknowns};
/// use hadar::identifiability::multi::LocalMatrix;
/// use hadar::scene::{EnvironmentObject, Surroundings};
/// use hadar::spectrum::Bands;
///
/// let bands = Bands::uniform(715.0, 1250.0, 5.0)?;
/// let object = EnvironmentObject { temperature_k: 293.15, emissivity: None };
/// let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object])?;
/// let state = surroundings.state(310.15, &[0.5])?;
/// let grey = vec![0.95; bands.len()];
/// let sloped: Vec<f64> = bands.nodes_cm1().iter().map(|nu| 0.9 - 1e-7 * (nu - 900.0).powi(2)).collect();
/// let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting])?;
/// let matrix = LocalMatrix::new(&bands, &surroundings, unknowns).per_photon(&[&grey, &sloped], &state)?;
/// assert!(matrix[0] == 0.0 && matrix[1] > 0.0 && matrix[1] != matrix[2]);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct LocalMatrix<'a> {
    passes: Passes,
    library: Aligned,
    unknowns: Unknowns,
    parameters: Vec<Parameter>,
    jacobian: Jacobian<'a>,
    pair: LocalSolver<'a>,
    projector: Projector,
    shared: Shared,
    lost: Lost,
}

/// What rounding may have done to the distances of the last matrix.
#[derive(Debug, Clone, Default)]
struct Lost {
    /// 4(none)² of the pairs, or where they were judged on their own their relative error, with a minus sign.
    pairs: Vec<f64>,
    /// Relative error of every target's distances, times the distance, over √(4 none²).
    targets: Vec<f64>,
}

/// How the pairs of a matrix were computed: what was shared, and what that left to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[non_exhaustive]
pub struct Passes {
    /// Targets whose signal, weights and orthogonal nuisances served all their pairs.
    pub shared_targets: usize,
    /// Pairs for which one pass over the bands kept all digits.
    pub one_pass: usize,
    /// Pairs that lost digits to the subtraction and took a second pass.
    pub two_passes: usize,
    /// Pairs that were judged on their own.
    pub alone: usize,
}

impl Passes {
    fn and(self, other: Self) -> Self {
        Self {
            shared_targets: self.shared_targets + other.shared_targets,
            one_pass: self.one_pass + other.one_pass,
            two_passes: self.two_passes + other.two_passes,
            alone: self.alone + other.alone,
        }
    }
}

/// What one target lends to all its pairs.
#[derive(Debug, Clone)]
struct Shared {
    /// σ²/κ, u and c of each band.
    noise: Aligned,
    weights: Aligned,
    contrast: Aligned,
    /// m, and k₁, k₂… one after the other.
    square: Aligned,
    directions: Aligned,
    /// Bands rounded up.
    stride: usize,
    /// Nuisances that are left, and which column each is.
    live: Vec<(usize, f64)>,
    /// Factor from the norm to the distance.
    half: f64,
}

impl<'a> LocalMatrix<'a> {
    /// A workspace for one set of bands, surroundings and unknowns.
    #[must_use]
    pub fn new(bands: &'a Bands, surroundings: &'a Surroundings, unknowns: Unknowns) -> Self {
        let count = bands.len();
        Self {
            passes: Passes::default(),
            library: Aligned::default(),
            parameters: unknowns.parameters(surroundings.objects().len()),
            jacobian: Jacobian::new(bands, surroundings),
            pair: LocalSolver::new(bands, surroundings, unknowns.clone()),
            projector: Projector::default(),
            lost: Lost::default(),
            shared: Shared {
                noise: Aligned::zeros(count),
                weights: Aligned::zeros(count),
                contrast: Aligned::zeros(count),
                square: Aligned::zeros(count),
                directions: Aligned::default(),
                stride: count.next_multiple_of(LANES),
                live: Vec::new(),
                half: 0.5,
            },
            unknowns,
        }
    }

    /// d₀ per √photon of every target (row) against every alternative (column), shot noise only; 0 on the
    /// diagonal. Priors count for nothing.
    ///
    /// # Errors
    /// As [`LocalSolver::per_photon`], for the first target that fails.
    pub fn per_photon(&mut self, emissivities: &[&[f64]], state: &State) -> Result<Vec<f64>> {
        self.matrix(emissivities, state, Weights::PerPhoton)
    }

    /// The same as statistical distances d with the camera's own noise.
    ///
    /// # Errors
    /// As [`LocalSolver::with_counting`], for the first target that fails.
    pub fn with_counting(
        &mut self,
        emissivities: &[&[f64]],
        state: &State,
        counting: &Counting,
    ) -> Result<Vec<f64>> {
        self.matrix(emissivities, state, Weights::Counting(counting))
    }

    /// Estimated bounds on the relative rounding errors of the distances of the last matrix, 0 where they are 0.
    #[must_use]
    pub fn relative_errors(&self, distances: &[f64]) -> Vec<f64> {
        let count = self.lost.targets.len();
        let target = |i: usize| self.lost.targets.get(i / count.max(1)).copied().unwrap_or(f64::INFINITY);
        let error = |(i, (distance, lost)): (usize, (&f64, &f64))| match lost.is_sign_negative() {
            _ if *distance == 0.0 => 0.0,
            true => -lost,
            false => target(i) * lost.sqrt() / distance,
        };
        distances.iter().zip(&self.lost.pairs).enumerate().map(error).collect()
    }

    /// How the last matrix was computed.
    #[must_use]
    pub fn passes(&self) -> Passes {
        self.passes
    }

    fn matrix(&mut self, emissivities: &[&[f64]], state: &State, weights: Weights<'_>) -> Result<Vec<f64>> {
        let count = emissivities.len();
        let nodes = self.jacobian.surroundings().nodes_cm1().len();
        if let Some(other) = emissivities.iter().find(|emissivity| emissivity.len() != nodes) {
            let (what, found) = ("emissivity".into(), other.len());
            return Err(Error::Length { what, found, expected: nodes });
        }
        let mut distances = vec![0.0; count * count];
        self.lost = Lost { pairs: vec![0.0; count * count], targets: vec![0.0; count] };
        if count < 2 {
            return Ok(distances);
        }
        // A copy whose rows start at cache lines: every spectrum is read once per other material.
        let stride = spaced(nodes);
        let mut library = std::mem::take(&mut self.library);
        library.set_len(stride * count);
        for (row, emissivity) in library.chunks_mut(stride).zip(emissivities) {
            row[..nodes].copy_from_slice(emissivity);
        }
        let aligned: Vec<&[f64]> = library.chunks(stride).map(|row| &row[..nodes]).collect();
        let mut lost = std::mem::take(&mut self.lost);
        let found = self.rows(&aligned, state, weights, &mut distances, &mut lost);
        self.library = library;
        self.lost = lost;
        found.map(|passes| {
            self.passes = passes;
            distances
        })
    }

    /// The whole matrix, row by row.
    fn rows(
        &mut self,
        emissivities: &[&[f64]],
        state: &State,
        weights: Weights<'_>,
        distances: &mut [f64],
        lost: &mut Lost,
    ) -> Result<Passes> {
        let count = emissivities.len();
        let lost = lost.pairs.chunks_mut(count).zip(&mut lost.targets);
        let rows = distances.chunks_mut(count).zip(lost).enumerate();
        let few = count * count * self.jacobian.bands().len() < WORTH_THREADS;
        if few || rayon::current_num_threads() == 1 {
            let mut passes = Passes::default();
            for (target, (out, (pairs, own))) in rows {
                let row = Out { distances: out, lost: pairs, target: own };
                passes = passes.and(self.row(emissivities, target, state, weights, row)?);
            }
            Ok(passes)
        } else {
            rows.collect::<Vec<_>>()
                .into_par_iter()
                .map_init(
                    || self.clone(),
                    |own, (target, (out, (pairs, of_target)))| {
                        let row = Out { distances: out, lost: pairs, target: of_target };
                        own.row(emissivities, target, state, weights, row)
                    },
                )
                .try_reduce(Passes::default, |a, b| Ok(a.and(b)))
        }
    }

    /// Distances of one target to all.
    fn row(
        &mut self,
        emissivities: &[&[f64]],
        target: usize,
        state: &State,
        weights: Weights<'_>,
        out: Out<'_>,
    ) -> Result<Passes> {
        crate::stop::check();
        let own = emissivities[target];
        let others = out.distances.len() - 1;
        let shared = self.share(own, state, weights);
        *out.target = shared.unwrap_or(0.0);
        let mut passes = Passes::default();
        if shared.is_some() {
            passes.shared_targets = 1;
            let columns = self.jacobian.columns_mut();
            let row = Row { shared: &self.shared, own, columns: columns.values, stride: columns.stride };
            let outs = out.distances.chunks_mut(TOGETHER).zip(out.lost.chunks_mut(TOGETHER));
            for (group, (out, lost)) in emissivities.chunks(TOGETHER).zip(outs) {
                passes.two_passes += row.distances(group, out, lost);
            }
        } else {
            out.distances.fill(f64::NAN);
        }
        for (alternative, (distance, lost)) in out.distances.iter_mut().zip(out.lost).enumerate() {
            if alternative == target {
                *distance = 0.0;
            } else if distance.is_nan() {
                let error;
                (*distance, error) = self.alone(own, emissivities[alternative], state, weights)?;
                *lost = -error;
                passes.alone += 1;
                passes.two_passes = passes.two_passes.saturating_sub(1);
            }
        }
        passes.one_pass = others.saturating_sub(passes.two_passes + passes.alone);
        Ok(passes)
    }

    /// One pair, judged with all care: its distance and relative error.
    fn alone(
        &mut self,
        own: &[f64],
        other: &[f64],
        state: &State,
        weights: Weights<'_>,
    ) -> Result<(f64, f64)> {
        crate::stop::check();
        match weights {
            Weights::PerPhoton => self.pair.distance(own, other, state),
            Weights::Counting(counting) => {
                let local = self.pair.with_counting(own, other, state, counting)?;
                Ok((local.distance, local.relative_error))
            }
        }
    }

    /// Forms what the target lends to its pairs; their relative error × distance ÷ √(4 none²), or `None` if they must go
    /// pair by pair.
    fn share(&mut self, own: &[f64], state: &State, weights: Weights<'_>) -> Option<f64> {
        let bands = self.jacobian.bands();
        let priors = matches!(weights, Weights::Counting(_)) && self.unknowns.has_priors();
        let count = self.parameters.len();
        let few = count <= MOST_NUISANCES && bands.len() > count;
        let each_alone = self.pair.loses_light(state) || self.pair.in_equilibrium(state);
        if priors || !few || !bands.one_node_per_band() || each_alone {
            return None;
        }
        let total_known = self.unknowns.known_lighting_total().is_some();
        self.jacobian.evaluate(own, own, state, &self.parameters, total_known);
        let total = crate::sum::sum(self.jacobian.signal());
        let cancellation = self.jacobian.contrast_cancellation(state);
        if !SAFE_RANGE.contains(&total) || cancellation > MOST_CANCELLATION {
            return None;
        }
        let shared = &mut self.shared;
        let counts = match weights {
            Weights::PerPhoton => {
                shared.half = 0.5 / total.sqrt();
                shared.noise.fill(0.0);
                1.0
            }
            Weights::Counting(counting) => {
                shared.half = 0.5;
                for (w, noise) in shared.noise.iter_mut().enumerate() {
                    *noise = counting.var_added(w) / counting.counts_per_radiance;
                }
                counting.counts_per_radiance
            }
        };
        contrast_into(Contrast {
            gain: state.gain,
            counts,
            contrast: self.jacobian.contrast(),
            widths: bands.weights_cm1(),
            signal: self.jacobian.signal(),
            noise: &shared.noise,
            u: &mut shared.weights,
            c: &mut shared.contrast,
            m: &mut shared.square,
        });
        shared.live.clear();
        let root = |w: usize| shared.weights[w].sqrt();
        let blurred = if total_known { self.jacobian.lighting_cancellation(own, state, root) } else { 1.0 };
        if blurred > MOST_CANCELLATION {
            return None;
        }
        if count > 0 {
            let columns = self.jacobian.columns_mut();
            let safe = |column: &[f64]| {
                let column = &column[..bands.len()];
                let square = weighted_square(column, &shared.weights);
                SAFE_SQUARES.contains(&square) || column.iter().all(|&value| value == 0.0)
            };
            if !columns.values.chunks(columns.stride).take(count).all(safe) {
                return None;
            }
            let norms = self.projector.orthogonalise(columns.values, columns.stride, &shared.weights);
            let live = norms.iter().copied().enumerate().filter(|(_, norm)| *norm > 0.0);
            shared.live.extend(live);
            let exactly = |&i: &usize| self.pair.depends_exactly(i, state);
            if !self.projector.well_known() || !self.projector.dropped().iter().all(exactly) {
                return None;
            }
            shared.directions.set_len(shared.stride * shared.live.len());
            let outs = shared.directions.chunks_mut(shared.stride);
            for (&(column, norm), out) in shared.live.iter().zip(outs) {
                let start = column * columns.stride;
                let column = &columns.values[start..start + bands.len()];
                direction_into(column, &shared.weights, &shared.contrast, 1.0 / norm, out);
            }
        }
        let turned = if count > 0 { self.projector.turned() } else { 0.0 };
        Some(blurred * shared.half * (ROUNDING * cancellation.max(10.0) + turned))
    }
}

/// Where the distances of one target go, and what rounding may have done to them.
struct Out<'o> {
    distances: &'o mut [f64],
    lost: &'o mut [f64],
    target: &'o mut f64,
}

/// A target against groups of alternatives.
struct Row<'r> {
    shared: &'r Shared,
    own: &'r [f64],
    /// The orthogonal nuisance columns, each beginning `stride` after the one before.
    columns: &'r [f64],
    stride: usize,
}

impl Row<'_> {
    /// Distances to up to [`TOGETHER`] alternatives, NaN where the pair must be judged on its own; how many took a
    /// second pass.
    fn distances(&self, group: &[&[f64]], out: &mut [f64], lost: &mut [f64]) -> usize {
        crate::stop::check();
        let mut others = [self.own; TOGETHER];
        for (other, given) in others.iter_mut().zip(group) {
            *other = given;
        }
        let shared = self.shared;
        let k = |i: usize| shared.directions.chunks(shared.stride).nth(i).unwrap_or_default();
        let lent = Lent { own: self.own, square: &shared.square, directions: [k(0), k(1), k(2), k(3)] };
        let (squares, dots) = projections(lent, others, shared.live.len());
        for (lost, square) in lost.iter_mut().zip(squares) {
            *lost = square;
        }
        let mut second = 0;
        for (i, (out, other)) in out.iter_mut().zip(group).enumerate() {
            let dots = dots[i];
            let along: f64 = dots.iter().map(|dot| dot * dot).sum();
            let left = squares[i] - along;
            *out = if squares[i] == 0.0 {
                // Nothing, or so little that its square is; of itself that need not be looked at.
                if std::ptr::eq(self.own, *other) || self.own == *other { 0.0 } else { f64::NAN }
            } else if !squares[i].is_finite() {
                f64::NAN
            } else if left * (ONE_PASS * ONE_PASS) >= squares[i] {
                shared.half * left.sqrt()
            } else {
                second += 1;
                let left = self.residual(other, dots);
                let good = left * (TWO_PASSES * TWO_PASSES) >= squares[i];
                if good { shared.half * left.sqrt() } else { f64::NAN }
            };
        }
        second
    }

    /// Σ u r² with the residual r formed band by band.
    fn residual(&self, other: &[f64], dots: [f64; MOST_NUISANCES]) -> f64 {
        let mut taken = [(0.0, self.own); MOST_NUISANCES];
        for ((taken, (column, norm)), dot) in taken.iter_mut().zip(&self.shared.live).zip(dots) {
            *taken = (dot / norm, &self.columns[column * self.stride..][..self.own.len()]);
        }
        let count = self.shared.live.len();
        residual_square(self.own, other, &self.shared.contrast, &self.shared.weights, taken, count)
    }
}
