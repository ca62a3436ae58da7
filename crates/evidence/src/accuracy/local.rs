//! Local distance of a pair: by normal equations, by orthogonalisation, with compensated sums.
//!
//! The residual of the material's column a_g off the nuisances' columns, in the inner product ⟨a,b⟩ = Σ a b/S:
//!
//! * normal equations: Cholesky factor of the Gram matrix, whose last diagonal element is the residual. The matrix holds
//!   squares, so that digits are lost to the square of none/d;
//! * Householder: QR of the whitened columns (nalgebra);
//! * Gram–Schmidt, twice: the crate's own ([`hadar::fisher`]);
//! * compensated: the same with every inner product in twice the precision (Dot2), to see whether that is worth it;
//! * matrix: what a pair costs among thirty materials, each against all ([`LocalMatrix`]).
//!
//! Everything from emissivities to the distance is timed, another temperature every time.
//!
//! Source of Dot2: Ogita, Rump, Oishi, SIAM J. Sci. Comput. 26, 1955 (2005), doi:10.1137/030601818.

use super::chart::{Chart, Measured};
use super::scene::{AMBIENT_K, Pair, bands, unknowns};
use super::timing::{Budget, seconds_of};
use super::{Item, Order};
use hadar::error::Result;
use hadar::identifiability::local::LocalSolver;
use hadar::identifiability::multi::LocalMatrix;
use hadar::scene::{EnvironmentObject, Jacobian, State, Surroundings};
use hadar::sum::Compensated;
use nalgebra::DMatrix;

/// Numbers of bands over 536 cm⁻¹: steps of 53.6 to 0.1 cm⁻¹.
const COUNTS: [usize; 5] = [10, 54, 536, 1072, 5360];
/// The paper's step of 1 cm⁻¹.
const PAPER: usize = 536;
/// Materials of the matrix.
const MATERIALS: usize = 30;
/// Target above its surroundings in the second case, K.
const ABOVE_K: f64 = 0.01;

/// Skin and aluminium.
pub(super) fn aluminium(order: Order) -> Result<Chart> {
    chart(order, Item::Local, "Local distance of skin from aluminium", Pair::skin_and_aluminium)
}

/// Two greys a hundredth of a kelvin above surroundings that light them from everywhere.
pub(super) fn near_equilibrium(order: Order) -> Result<Chart> {
    chart(order, Item::LocalNearEquilibrium, "Local distance 0.01 K above equilibrium", |count| {
        let bands = bands(count)?;
        let object = EnvironmentObject { temperature_k: AMBIENT_K, emissivity: None };
        let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object])?;
        let state = surroundings.state(AMBIENT_K + ABOVE_K, &[1.0])?;
        let (target, alternative) = (vec![0.95; count], vec![0.6; count]);
        Ok(Pair { bands, surroundings, target, alternative, state })
    })
}

fn chart(
    order: Order,
    item: Item,
    title: &'static str,
    pair: impl Fn(usize) -> Result<Pair>,
) -> Result<Chart> {
    let mut measured = Vec::new();
    for count in order.some(&COUNTS) {
        let pair = pair(count)?;
        let truth = pair.local()?;
        let budget = Budget::of(order.quick);
        let off = |distance: f64| super::item::off(distance, &truth);
        let effort = count as f64;
        let question = || format!("one pair, {count} bands");
        for (name, residual) in [
            ("normal equations", normal_equations as Residual),
            ("Householder (nalgebra)", householder),
            ("Gram-Schmidt, compensated", compensated),
        ] {
            let mut jacobian = Jacobian::new(&pair.bands, &pair.surroundings);
            let error = off(pair.by(&mut jacobian, residual, &pair.state)?);
            let mut flips = Flips::new(&pair.state);
            let seconds = seconds_of(budget, || pair.by(&mut jacobian, residual, flips.next()));
            measured.push(Measured::new(name, effort, seconds, error).answering(question()));
        }
        let mut solver = LocalSolver::new(&pair.bands, &pair.surroundings, unknowns()?);
        let mut solve =
            |state: &State| solver.per_photon(&pair.target, &pair.alternative, state, f64::INFINITY);
        let found = solve(&pair.state)?;
        let mut flips = Flips::new(&pair.state);
        let seconds = seconds_of(budget, || solve(flips.next()));
        let one = Measured::new("Gram-Schmidt, twice", effort, seconds, off(found.distance));
        measured.push(one.answering(question()).default_if(count == PAPER).reporting(found.relative_error));

        let materials = pair.materials();
        let materials: Vec<&[f64]> = materials.iter().map(Vec::as_slice).collect();
        let mut matrix = LocalMatrix::new(&pair.bands, &pair.surroundings, unknowns()?);
        let error = off(matrix.per_photon(&materials, &pair.state)?[1]);
        let mut flips = Flips::new(&pair.state);
        let pairs = (MATERIALS * (MATERIALS - 1)) as f64;
        let seconds =
            super::timing::one_thread(|| seconds_of(budget, || matrix.per_photon(&materials, flips.next())));
        let one = Measured::new("matrix of 30, per pair", effort, seconds / pairs, error);
        measured.push(one.answering(format!("one of 870 pairs, {count} bands")));
    }
    Ok(Chart {
        name: item.name(),
        title,
        timed: "one distance, from emissivities on",
        effort: "bands over 536 cm^-1",
        error: "relative error against the same bands in extended precision",
        reference: "Gram-Schmidt of the textbook's columns in extended precision",
        measured,
        remark: String::new(),
    })
}

/// Two states in turn, so that nothing can be taken from the call before.
struct Flips {
    states: [State; 2],
    calls: usize,
}

impl Flips {
    fn new(state: &State) -> Self {
        let other = State { temperature_k: state.temperature_k + 1.0, ..state.clone() };
        Self { states: [other, state.clone()], calls: 0 }
    }

    fn next(&mut self) -> &State {
        self.calls += 1;
        &self.states[self.calls % 2]
    }
}

/// ‖P⊥ a_g‖ of the last of the columns, with weights.
type Residual = fn(Vec<Vec<f64>>, &[f64]) -> f64;

impl Pair {
    /// The distance by another residual.
    fn by(&self, jacobian: &mut Jacobian<'_>, residual: Residual, state: &State) -> Result<f64> {
        let mut parameters = unknowns()?.parameters(1);
        parameters.push(hadar::scene::Parameter::Material);
        jacobian.evaluate(&self.target, &self.alternative, state, &parameters, false);
        let total = hadar::sum::sum(jacobian.signal());
        let weights: Vec<f64> = jacobian.signal().iter().map(|signal| 1.0 / (signal * total)).collect();
        let columns = (0..parameters.len()).map(|i| jacobian.column(i).to_vec()).collect();
        Ok(0.5 * residual(columns, &weights))
    }

    /// The two, and mixtures of them.
    fn materials(&self) -> Vec<Vec<f64>> {
        let mixed = |share: f64| {
            let pairs = self.target.iter().zip(&self.alternative);
            pairs.map(|(a, b)| a + share * (b - a)).collect()
        };
        (0..MATERIALS)
            .map(|i| if i == 1 { self.alternative.clone() } else { mixed(i as f64 / MATERIALS as f64) })
            .collect()
    }
}

fn normal_equations(columns: Vec<Vec<f64>>, weights: &[f64]) -> f64 {
    let count = columns.len();
    let mut gram = DMatrix::<f64>::zeros(count, count);
    for i in 0..count {
        for j in 0..=i {
            let terms = columns[i].iter().zip(&columns[j]).zip(weights);
            let product: f64 = terms.map(|((a, b), weight)| a * b * weight).sum();
            gram[(i, j)] = product;
            gram[(j, i)] = product;
        }
    }
    gram.cholesky().map_or(0.0, |factor| factor.l_dirty()[(count - 1, count - 1)])
}

fn householder(columns: Vec<Vec<f64>>, weights: &[f64]) -> f64 {
    let (rows, count) = (weights.len(), columns.len());
    let whitened = columns
        .iter()
        .flat_map(|column| column.iter().zip(weights).map(|(value, weight)| value * weight.sqrt()));
    let upper = DMatrix::from_iterator(rows, count, whitened).qr().unpack_r();
    upper[(count - 1, count - 1)].abs()
}

fn compensated(mut columns: Vec<Vec<f64>>, weights: &[f64]) -> f64 {
    for _ in 0..2 {
        for pivot in 0..columns.len() {
            let (done, later) = columns.split_at_mut(pivot + 1);
            let pivot = &done[pivot];
            let square = dot(pivot, pivot, weights);
            for column in later {
                let share = dot(pivot, column, weights) / square;
                for (value, pivot) in column.iter_mut().zip(pivot) {
                    *value = (-share).mul_add(*pivot, *value);
                }
            }
        }
    }
    columns.last().map_or(0.0, |last| dot(last, last, weights).sqrt())
}

/// Σ a b w with the rounding of every product and sum kept.
fn dot(a: &[f64], b: &[f64], weights: &[f64]) -> f64 {
    let (mut sum, mut lost) = (Compensated::default(), 0.0);
    for ((a, b), weight) in a.iter().zip(b).zip(weights) {
        let product = a * b;
        let rest = a.mul_add(*b, -product);
        let weighed = product * weight;
        lost += product.mul_add(*weight, -weighed) + rest * weight;
        sum.add(weighed);
    }
    sum.value() + lost
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Columns 1, t, t² on t = −3…3: what is left of t² is √84.
    #[test]
    fn all_residuals_are_the_same_where_nothing_is_lost() {
        let columns: Vec<Vec<f64>> =
            (0..3).map(|power| (-3..=3).map(|t| f64::from(t).powi(power)).collect()).collect();
        for residual in [normal_equations as Residual, householder, compensated] {
            let found = residual(columns.clone(), &[1.0; 7]);
            assert!((found / 84.0_f64.sqrt() - 1.0).abs() < 1e-14, "{found}");
        }
    }

    /// Σ (1e16, 1, −1e16)·1 is 1, which a plain sum loses.
    #[test]
    fn compensated_products_lose_nothing() {
        assert_eq!(dot(&[1e16, 1.0, -1e16], &[1.0; 3], &[1.0; 3]), 1.0);
    }

    #[test]
    fn states_alternate() {
        let state = State { temperature_k: 310.15, lighting: vec![], gain: 1.0, environment_k: vec![] };
        let mut flips = Flips::new(&state);
        assert_eq!(flips.next().temperature_k, 310.15);
        assert_ne!(flips.next().temperature_k, 310.15);
    }
}
