//! The columns of all states of a prior under each other, and the material's projected off the others.

use super::prior::Node;
use crate::error::Result;
use crate::fisher::{Projector, Unknowns};
use crate::scene::{Jacobian, Parameter, State, Surroundings};
use crate::spectrum::Bands;
use crate::sum::dot;

/// More numbers than this are not stacked.
pub(super) const MAX_STACK: usize = 100_000_000;

/// The task of a [`BayesianBound`](super::BayesianBound): the pair of materials and the nominal state, about which the priors are
/// centred.
#[derive(Debug, Clone, Copy)]
pub struct Pair<'a> {
    /// Emissivity of the target at the nodes of the bands.
    pub emissivity: &'a [f64],
    /// Emissivity of the alternative at the nodes.
    pub alternative: &'a [f64],
    /// Nominal state.
    pub state: &'a State,
}

/// The hybrid Cramér–Rao bound as a distance.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct BayesianDistance {
    /// d_B per √photon of the nominal state; 0 where no prior helps.
    pub distance: f64,
    /// Number of nodes of the average over the priors.
    pub nodes: usize,
    /// Relative change of the distance from half the states.
    pub quadrature_change: f64,
    /// Estimated bound on the relative rounding error.
    pub relative_error: f64,
}

/// Columns of all nodes, nuisances in their order, the material last: as the triangle of their orthogonalisation, whose
/// columns have the same inner products.
pub(super) struct Stack {
    /// Row by row of each column.
    columns: Vec<Vec<f64>>,
    /// Relative rounding error of what is left of the last column.
    relative_error: f64,
    /// Factor by which rounding errors of the material's column exceed a few ulp of its length.
    cancellation: f64,
    /// (column, deviation) of each prior.
    priors: Vec<(usize, f64)>,
    nodes: usize,
}

impl Stack {
    /// `total` is ΣS of the nominal state.
    pub(super) fn new(
        bands: &Bands,
        surroundings: &Surroundings,
        unknowns: &Unknowns,
        pair: Pair<'_>,
        total: f64,
        nodes: &[Node],
    ) -> Result<Self> {
        let mut parameters = unknowns.parameters(surroundings.objects().len());
        let priors: Vec<(usize, f64)> = parameters
            .iter()
            .enumerate()
            .filter_map(|(i, parameter)| unknowns.sigma_prior(*parameter).map(|sigma| (i, sigma)))
            .collect();
        parameters.push(Parameter::Material);
        let mut jacobian = Jacobian::new(bands, surroundings);
        let mut columns = vec![Vec::with_capacity(nodes.len() * bands.len()); parameters.len()];
        let mut weights = Vec::with_capacity(nodes.len() * bands.len());
        let (mut square, mut error) = (0.0, 0.0);
        let total_known = unknowns.known_lighting_total().is_some();
        for Node { state, weight } in nodes {
            crate::stop::check();
            jacobian.evaluate(pair.emissivity, pair.alternative, state, &parameters, total_known);
            for (i, column) in columns.iter_mut().enumerate() {
                column.extend_from_slice(jacobian.column(i));
            }
            let start = weights.len();
            // A band without photons tells nothing.
            weights.extend(jacobian.signal().iter().map(|&signal| {
                let weight = weight / signal / total;
                if weight.is_finite() { weight } else { 0.0 }
            }));
            let material = jacobian.column(parameters.len() - 1);
            let squares: Vec<f64> = material.iter().map(|g| g * g).collect();
            let own = dot(&squares, &weights[start..]);
            if own > 0.0 {
                square += own;
                error += own * jacobian.cancellation().powi(2);
            }
        }
        let cancellation = if square > 0.0 { (error / square).sqrt() } else { 1.0 };
        let count = columns.len();
        let found = Projector::default().project(&mut columns.concat(), &weights, cancellation);
        let (triangle, norms) = found.factor();
        let row = |i: usize, row: usize| norms[row] * triangle[row * count + i];
        let columns = (0..count).map(|i| (0..count).map(|j| row(i, j)).collect()).collect();
        let relative_error = found.relative_error;
        Ok(Self { columns, relative_error, cancellation, priors, nodes: nodes.len() })
    }

    /// d_B when the nominal state sends `photons`: each prior is one row more, which holds 1/(σ_p √N) in its
    /// own column alone.
    pub(super) fn project(&self, photons: f64) -> BayesianDistance {
        let rows = self.columns.len() + self.priors.len();
        let mut columns = Vec::with_capacity(self.columns.len() * rows);
        for (i, column) in self.columns.iter().enumerate() {
            columns.extend_from_slice(column);
            columns.extend(
                self.priors.iter().map(
                    |&(owner, sigma)| {
                        if owner == i { 1.0 / (sigma * photons.sqrt()) } else { 0.0 }
                    },
                ),
            );
        }
        let found = Projector::default().project(&mut columns, &vec![1.0; rows], self.cancellation);
        let known = found.relative_error < 1.0 && found.residual > 0.0;
        BayesianDistance {
            distance: if known { 0.5 * found.residual } else { 0.0 },
            nodes: self.nodes,
            quadrature_change: 0.0,
            relative_error: if known { found.relative_error.max(self.relative_error) } else { 0.0 },
        }
    }
}
