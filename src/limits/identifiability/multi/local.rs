//! Local distances of every material against every other one, in one scene.
//!
//! All that depends on the target alone is done once per target: signal, weights u, the nuisance columns
//! orthogonalised to q̂ᵢ. For an alternative e′ the score of the material is v = (e′ − e)·c with c = G w C (C
//! contrast), so that with Δ = e′ − e
//!
//!   4d² = Σ m Δ² − Σᵢ (Σ kᵢ Δ)²,   m = u c²,  kᵢ = u c q̂ᵢ
//!
//! is one pass over the bands with 2 + n multiplications each, of a few targets with a few alternatives at a time ([`lent`]).
//! The subtraction loses u·(none/d)² of d, none the distance with no nuisance; where it would lose too much, the residual is
//! formed band by band in a second pass, and where that is not enough the pair goes to [`LocalSolver`], which judges rank
//! and rounding. So do targets with a nuisance that is dependent, or nearly, and those whose contrast nearly vanishes at
//! a node. Results agree with those of [`LocalSolver`] to 1e-14·none/d, or by as much as rounding may have turned the
//! directions of the nuisances: [`LocalMatrix::relative_errors`].
//!
//! Assumption: all targets in the same state. Source: paper S27–S30, Algorithm 3.

mod kernels;
mod lent;

use self::kernels::{Contrast, MOST_NUISANCES, TOGETHER, contrast_into, weighted_square};
use self::lent::{Lent, grouped};
use super::count::check_count;
use crate::aligned::Aligned;
use crate::error::{Error, Result};
use crate::fisher::{Counting, Projector, Unknowns};
use crate::identifiability::local::{LocalSolver, SAFE_RANGE};
use crate::scene::{Jacobian, Parameter, State, Surroundings};
use crate::spectrum::Bands;
use rayon::prelude::*;

/// Targets that take turns with a group of alternatives: what they lend stays in the second-level cache.
const TARGETS: usize = 16;
/// Groups of alternatives that stay in the second-level cache, and targets in the first.
const GROUPS: usize = 32;
const NEAR: usize = 2;
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
    unknowns: Unknowns,
    parameters: Vec<Parameter>,
    jacobian: Jacobian<'a>,
    pair: LocalSolver<'a>,
    projector: Projector,
    /// σ²/κ of each band.
    noise: Aligned,
    lent: Vec<Lent>,
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

impl<'a> LocalMatrix<'a> {
    /// A workspace for one set of bands, surroundings and unknowns.
    #[must_use]
    pub fn new(bands: &'a Bands, surroundings: &'a Surroundings, unknowns: Unknowns) -> Self {
        let count = bands.len();
        Self {
            passes: Passes::default(),
            parameters: unknowns.parameters(surroundings.objects().len()),
            jacobian: Jacobian::new(bands, surroundings),
            pair: LocalSolver::new(bands, surroundings, unknowns.clone()),
            projector: Projector::default(),
            noise: Aligned::zeros(count),
            lent: Vec::new(),
            lost: Lost::default(),
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
        check_count(count)?;
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
        let mut lost = std::mem::take(&mut self.lost);
        let found = self.blocks(emissivities, state, weights, &mut distances, &mut lost);
        self.lost = lost;
        found.map(|passes| {
            self.passes = passes;
            distances
        })
    }

    /// The whole matrix, some rows at a time.
    fn blocks(
        &mut self,
        emissivities: &[&[f64]],
        state: &State,
        weights: Weights<'_>,
        distances: &mut [f64],
        lost: &mut Lost,
    ) -> Result<Passes> {
        let count = emissivities.len();
        let groups = grouped(emissivities);
        let library = Library { emissivities, groups: &groups };
        let lost = lost.pairs.chunks_mut(TARGETS * count).zip(lost.targets.chunks_mut(TARGETS));
        let blocks = distances.chunks_mut(TARGETS * count).zip(lost).enumerate();
        let few = count * count * self.jacobian.bands().len() < WORTH_THREADS;
        if few || rayon::current_num_threads() == 1 {
            let mut passes = Passes::default();
            for (block, (out, (pairs, targets))) in blocks {
                let out = Out { distances: out, lost: pairs, targets };
                passes = passes.and(self.block(library, block * TARGETS, state, weights, out)?);
            }
            Ok(passes)
        } else {
            blocks
                .collect::<Vec<_>>()
                .into_par_iter()
                .map_init(
                    || self.clone(),
                    |own, (block, (out, (pairs, targets)))| {
                        let out = Out { distances: out, lost: pairs, targets };
                        own.block(library, block * TARGETS, state, weights, out)
                    },
                )
                .try_reduce(Passes::default, |a, b| Ok(a.and(b)))
        }
    }

    /// Distances of some targets, from `first` on, to all.
    fn block(
        &mut self,
        library: Library<'_>,
        first: usize,
        state: &State,
        weights: Weights<'_>,
        out: Out<'_>,
    ) -> Result<Passes> {
        let Library { emissivities, groups } = library;
        let count = emissivities.len();
        let mut passes = Passes::default();
        let mut lent = std::mem::take(&mut self.lent);
        lent.resize_with(out.targets.len(), Lent::default);
        for ((lent, lost), own) in lent.iter_mut().zip(&mut *out.targets).zip(&emissivities[first..]) {
            crate::stop::check();
            let error = self.share(own, state, weights, lent);
            lent.is_shared = error.is_some();
            *lost = error.unwrap_or(0.0);
            passes.shared_targets += usize::from(lent.is_shared);
        }
        let group_len = groups.len() / count.div_ceil(TOGETHER);
        let others: Vec<_> =
            emissivities.chunks(TOGETHER).zip(groups.chunks(group_len)).enumerate().collect();
        for some in others.chunks(GROUPS) {
            for near in (0..lent.len()).step_by(NEAR) {
                crate::stop::check();
                for (group, (others, grouped)) in some {
                    for row in near..(near + NEAR).min(lent.len()) {
                        let start = row * count + group * TOGETHER;
                        let range = start..start + others.len();
                        let (distances, lost) = (&mut out.distances[range.clone()], &mut out.lost[range]);
                        let own = emissivities[first + row];
                        if lent[row].is_shared {
                            passes.two_passes += lent[row].distances(own, others, grouped, distances, lost);
                        } else {
                            distances.fill(f64::NAN);
                        }
                    }
                }
            }
        }
        self.lent = lent;
        let rows = out.distances.chunks_mut(count).zip(out.lost.chunks_mut(count)).enumerate();
        for (row, (distances, lost)) in rows {
            let target = first + row;
            for (alternative, (distance, lost)) in distances.iter_mut().zip(lost).enumerate() {
                if alternative == target {
                    *distance = 0.0;
                } else if distance.is_nan() {
                    let error;
                    (*distance, error) =
                        self.alone(emissivities[target], emissivities[alternative], state, weights)?;
                    *lost = -error;
                    passes.alone += 1;
                }
            }
        }
        passes.one_pass = (out.targets.len() * (count - 1)).saturating_sub(passes.two_passes + passes.alone);
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
    fn share(&mut self, own: &[f64], state: &State, weights: Weights<'_>, lent: &mut Lent) -> Option<f64> {
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
        lent.clear(bands.len());
        let counts = match weights {
            Weights::PerPhoton => {
                lent.half = 0.5 / total.sqrt();
                self.noise.fill(0.0);
                1.0
            }
            Weights::Counting(counting) => {
                lent.half = 0.5;
                for (w, noise) in self.noise.iter_mut().enumerate() {
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
            noise: &self.noise,
            u: &mut lent.weights,
            c: &mut lent.contrast,
            m: &mut lent.square,
        });
        let root = |w: usize| lent.weights[w].sqrt();
        let blurred = if total_known { self.jacobian.lighting_cancellation(own, state, root) } else { 1.0 };
        if blurred > MOST_CANCELLATION {
            return None;
        }
        if count > 0 {
            let columns = self.jacobian.columns_mut();
            let safe = |column: &[f64]| {
                let column = &column[..bands.len()];
                let square = weighted_square(column, &lent.weights);
                SAFE_SQUARES.contains(&square) || column.iter().all(|&value| value == 0.0)
            };
            if !columns.values.chunks(columns.stride).take(count).all(safe) {
                return None;
            }
            let norms = self.projector.orthogonalise(columns.values, columns.stride, &lent.weights);
            for (column, &norm) in columns.values.chunks(columns.stride).zip(norms) {
                if norm > 0.0 {
                    lent.take(&column[..bands.len()], norm);
                }
            }
            let exactly = |&i: &usize| self.pair.depends_exactly(i, state);
            if !self.projector.well_known() || !self.projector.dropped().iter().all(exactly) {
                return None;
            }
        }
        lent.interleave(own);
        let turned = if count > 0 { self.projector.turned() } else { 0.0 };
        Some(blurred * lent.half * (ROUNDING * cancellation.max(10.0) + turned))
    }
}

/// All materials, and the same in groups.
#[derive(Clone, Copy)]
struct Library<'l> {
    emissivities: &'l [&'l [f64]],
    groups: &'l [f64],
}

/// Where the distances of some targets go, and what rounding may have done to them.
struct Out<'o> {
    distances: &'o mut [f64],
    lost: &'o mut [f64],
    targets: &'o mut [f64],
}
