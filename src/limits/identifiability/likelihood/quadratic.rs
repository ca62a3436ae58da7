//! Gradient and second derivatives of the loss along the free parameters, from those along the bands' signals.
//!
//! With p, E and O the derivatives of a band's loss along its signal S (`terms`): gradient Σ p Sᵢ, Fisher matrix
//! Σ E Sᵢ Sⱼ, Hessian Σ O Sᵢ Sⱼ + Σ p Sᵢⱼ, where Sᵢⱼ is known along T and along the logarithm of the gain
//! (`curvature`); those along environment temperatures are left out.

use super::terms::Terms;
use crate::aligned::Aligned;
use crate::few::FewColumns;
use crate::identifiability::curvature::{Curvature, curvature_into};
use crate::identifiability::space::Quadratic;
use crate::scene::{Jacobian, Parameter, State};
use crate::simd::{Chunk, LANES, added, dispatched, fold, padded, product};
use crate::sum::dot;

/// Spectra for the second derivative along T.
#[derive(Debug, Clone)]
pub(super) struct Scratch {
    pub(super) node: Aligned,
    pub(super) band: Aligned,
}

/// The loss to second order at `state`, at which `surface` and `terms` were evaluated last.
pub(super) fn quadratic(
    surface: &Jacobian<'_>,
    emissivity: &[f64],
    state: &State,
    terms: &Terms,
    scratch: &mut Scratch,
) -> Quadratic {
    let parameters = surface.parameters();
    let n = parameters.len();
    let gradient = (0..n).map(|i| dot(&terms.pull, surface.column(i))).collect();
    let (mut expected, mut hessian) = (FewColumns::zeros(n, n), FewColumns::zeros(n, n));
    for i in 0..n {
        for j in i..n {
            let (mean, own) = weighed(Pair {
                first: surface.column(i),
                second: surface.column(j),
                expected: &terms.expected,
                observed: &terms.observed,
            });
            expected[(i, j)] = mean;
            expected[(j, i)] = mean;
            hessian[(i, j)] = own + second_derivative(surface, emissivity, state, terms, scratch, (i, j));
            hessian[(j, i)] = hessian[(i, j)];
        }
    }
    Quadratic { gradient, gauss_newton: expected, hessian }
}

/// Σ p Sᵢⱼ.
fn second_derivative(
    surface: &Jacobian<'_>,
    emissivity: &[f64],
    state: &State,
    terms: &Terms,
    scratch: &mut Scratch,
    (i, j): (usize, usize),
) -> f64 {
    crate::stop::check();
    let parameters = surface.parameters();
    match (parameters[i], parameters[j]) {
        // ∂²S/∂g∂θⱼ = ∂S/∂θⱼ.
        (Parameter::Gain, _) => dot(&terms.pull, surface.column(j)),
        (_, Parameter::Gain) => dot(&terms.pull, surface.column(i)),
        (Parameter::Temperature, Parameter::Temperature) => {
            curvature_into(Curvature {
                nu: surface.surroundings().nodes_cm1(),
                temperature_k: state.temperature_k,
                gain: state.gain,
                emissivity,
                value: surface.radiance(),
                slope: surface.radiance_slope(),
                out: &mut scratch.node,
            });
            surface.bands().weigh_into(&scratch.node, &mut scratch.band);
            dot(&terms.pull, &scratch.band)
        }
        _ => 0.0,
    }
}

struct Pair<'a> {
    first: &'a [f64],
    second: &'a [f64],
    expected: &'a [f64],
    observed: &'a [f64],
}

#[inline(always)]
fn weigh(a: Chunk, b: Chunk, weights: [Chunk; 2], sums: [Chunk; 2]) -> [Chunk; 2] {
    let both = product(a, b);
    [added(both, weights[0], sums[0]), added(both, weights[1], sums[1])]
}

dispatched! {
    /// Σ E a b and Σ O a b. Plain sums in eight lanes: the errors are far below the noise of the counts.
    fn weighed<'a>(pair: Pair<'a>) -> (f64, f64) {
        let (a8, a_rest) = pair.first.as_chunks::<LANES>();
        let (b8, b_rest) = pair.second.as_chunks::<LANES>();
        let (e8, e_rest) = pair.expected.as_chunks::<LANES>();
        let (o8, o_rest) = pair.observed.as_chunks::<LANES>();
        let mut sums = [[0.0; LANES]; 2];
        for (((a, b), e), o) in a8.iter().zip(b8).zip(e8).zip(o8) {
            sums = weigh(*a, *b, [*e, *o], sums);
        }
        sums = weigh(padded(a_rest), padded(b_rest), [padded(e_rest), padded(o_rest)], sums);
        (fold(&sums[0]), fold(&sums[1]))
    }
}
