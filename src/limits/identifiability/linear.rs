//! Theorem 1: the detection probability of two parallel material surfaces, exactly.
//!
//! Model, generalised from one nuisance and two bands to any number: counts n_w of W bands,
//!
//! n = A g + B θ + C + ξ,   ξ_w ~ Normal(0, σ_w²) independent,
//!
//! g = 0 for the target's material and 1 for the other, θ any real numbers (the surface), A the step from one
//! surface to the other, the columns of B the directions along both, C an offset that drops out. The
//! decision is for the material whose nearest state is the more likely. In whitened counts it compares
//! ‖P⊥(n − C)‖ with ‖P⊥(n − C − A)‖, which is ⟨P⊥A, n − C⟩ < ½‖P⊥A‖² in the inner product with weights
//! 1/σ_w²; the left side is normal with mean 0 and variance ‖P⊥A‖² whatever θ is, so
//!
//! P = Φ(d),   d = ½‖P⊥A‖,   σ²_CRB = 1/‖P⊥A‖²   (S20, S25).
//!
//! With W = 2 and one column B this is S26, σ²_CRB = [(B₁σ₂)² + (B₂σ₁)²]/det(Λ)²; S23 needs |det Λ| where
//! it writes det Λ. Where A lies in the span of B (singular Λ) the surfaces coincide and P = ½.
//!
//! Source: paper, Theorem 1, S19–S26.

use super::detection;
use crate::error::{Error, Result, check};
use crate::fisher::{Projector, project_columns};
use crate::scene::Columns;

/// What Theorem 1 says of a pair of parallel surfaces.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct LinearDetection {
    /// d = ½‖P⊥A‖, in units of the noise; 0 where the surfaces coincide.
    pub distance: f64,
    /// Probability of a correct decision Φ(d), 0.5 to 1.
    pub probability: f64,
    /// Miss probability 1 − Φ(d), to full relative precision.
    pub miss_probability: f64,
    /// Cramér–Rao bound of g; infinite where the surfaces coincide.
    pub var_material: f64,
    /// Estimated bound on the relative rounding error of `distance`.
    pub relative_error: f64,
    /// Columns of B that are zero or dependent on the others.
    pub dropped: Vec<usize>,
}

/// Detection probability of the linear model: `material` is A, `nuisances` are the columns of B (counts per
/// unit of each unknown), `sigma` the deviations σ_w (counts).
///
/// ```
/// // One band, nothing unknown but the material: P = Φ(A/2σ).
/// let one = hadar::identifiability::linear::detection(&[2.0], &[], &[1.0])?;
/// assert!((one.probability - 0.841_344_746_068_542_9).abs() < 1e-15);
/// # Ok::<(), hadar::Error>(())
/// ```
///
/// # Errors
/// Lengths that differ, a number that is not finite, or a deviation that is not positive.
pub fn detection(material: &[f64], nuisances: &[Vec<f64>], sigma: &[f64]) -> Result<LinearDetection> {
    let mut columns = Vec::with_capacity((nuisances.len() + 1) * sigma.len());
    for column in nuisances.iter().map(Vec::as_slice).chain([material]) {
        if column.len() != sigma.len() {
            return Err(Error::Length {
                what: "bands of a direction".into(),
                found: column.len(),
                expected: sigma.len(),
            });
        }
        for (&value, &sigma) in column.iter().zip(sigma) {
            check::positive("deviation of a band", sigma, "counts")?;
            // Whitened here, so that no square of a deviation overflows.
            columns.push(check::finite("direction of a surface", value, "counts")? / sigma);
        }
    }
    let mut projector = Projector::default();
    let ones = vec![1.0; sigma.len()];
    let mut found = projector.reduce(Columns { values: &mut columns, stride: sigma.len() }, &ones, 1.0);
    if projector.in_doubt(found, |_| false) {
        let all: Vec<&[f64]> = nuisances.iter().map(Vec::as_slice).chain([material]).collect();
        found = projector.adopt(project_columns(&all, sigma));
    }
    let coincide = found.is_nothing();
    let length = if coincide { 0.0 } else { found.residual };
    let distance = 0.5 * length;
    Ok(LinearDetection {
        distance,
        probability: detection::probability(distance),
        miss_probability: detection::miss_probability(distance),
        var_material: 1.0 / (length * length),
        relative_error: if coincide { 0.0 } else { found.relative_error },
        dropped: projector.projection(found).dropped,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    /// S26 for two bands and one nuisance, to a few ulp over the determinant's own cancellation.
    #[test]
    fn two_bands_are_the_closed_form() {
        for (a, b, sigma) in [
            ([3.0, 1.0], [1.0, 2.0], [1.0, 1.0]),
            ([-2.0, 5.0], [0.5, -4.0], [0.3, 7.0]),
            ([1e5, 2e5], [3e-4, -1e-4], [500.0, 20.0]),
        ] {
            let found = detection(&a, &[b.to_vec()], &sigma).unwrap();
            let det = a[0] * b[1] - a[1] * b[0];
            let var = ((b[0] * sigma[1]).powi(2) + (b[1] * sigma[0]).powi(2)) / (det * det);
            assert!((found.var_material / var - 1.0).abs() < 1e-13, "{found:?} {var}");
            // S23 integrated: Φ(1/(2σ_CRB)), with |det Λ|.
            assert!((found.probability - detection::probability(0.5 / var.sqrt())).abs() < 1e-14);
        }
    }

    /// Share of correct decisions of the maximum-likelihood rule, solved by brute force in two unknowns.
    fn simulate(a: &[f64; 4], b: &[[f64; 4]; 2], sigma: &[f64; 4], draws: u32) -> f64 {
        let white = |x: &[f64; 4]| nalgebra::Vector4::from_fn(|w, _| x[w] / sigma[w]);
        let (step, along) = (white(a), nalgebra::Matrix4x2::from_columns(&[white(&b[0]), white(&b[1])]));
        let normal = (along.transpose() * along).try_inverse().unwrap();
        let misfit = |n: nalgebra::Vector4<f64>| (n - along * (normal * (along.transpose() * n))).norm();
        let mut rng = rand::rngs::ChaCha12Rng::seed_from_u64(19);
        let mut right = 0;
        for _ in 0..draws {
            let mut draw = |_, _| -> f64 { StandardNormal.sample(&mut rng) };
            let noise = nalgebra::Vector4::from_fn(&mut draw);
            // Any state on the target's own surface.
            let n = noise + along * nalgebra::Vector2::new(3.0, -40.0);
            right += u32::from(misfit(n) < misfit(n - step));
        }
        f64::from(right) / f64::from(draws)
    }

    /// Four bands, two nuisances, 4e5 draws: 4.5 standard deviations, a false alarm in 1.5e5.
    #[test]
    fn a_simulated_decision_is_right_as_often_as_it_says() {
        let sigma = [1.0, 2.0, 0.5, 3.0];
        let along = [[1.0, 1.0, 1.0, 1.0], [0.0, 1.0, 0.3, -2.0]];
        for step in [[1.0, -2.0, 0.4, 2.0], [0.3, 0.1, -0.2, 1.0], [4.0, -3.0, 2.0, 5.0]] {
            let exact = detection(&step, &along.map(|b| b.to_vec()), &sigma).unwrap().probability;
            let (draws, share) = (400_000, simulate(&step, &along, &sigma, 400_000));
            let deviation = (exact * (1.0 - exact) / f64::from(draws)).sqrt();
            assert!(exact > 0.55 && exact < 0.999, "{exact}");
            assert!((share - exact).abs() < 4.5 * deviation, "{share} {exact} {deviation}");
        }
    }

    #[test]
    fn a_singular_transform_leaves_chance() {
        let found = detection(&[2.0, 4.0, 6.0], &[vec![1.0, 2.0, 3.0]], &[0.3, 1.0, 7.0]).unwrap();
        assert_eq!((found.distance, found.probability), (0.0, 0.5));
        assert!(found.var_material.is_infinite());
        let twice =
            detection(&[1.0, 0.0], &[vec![0.0, 1.0], vec![0.0, 3.0], vec![0.0, 0.0]], &[1.0; 2]).unwrap();
        assert!((twice.distance - 0.5).abs() < 1e-15 && twice.dropped == [1, 2]);
    }

    #[test]
    fn what_is_no_model_is_refused() {
        assert!(detection(&[1.0], &[vec![1.0, 2.0]], &[1.0]).is_err());
        assert!(detection(&[1.0], &[], &[0.0]).is_err());
        assert!(detection(&[f64::NAN], &[], &[1.0]).is_err());
        assert_eq!(detection(&[], &[], &[]).unwrap().probability, 0.5);
    }
}
