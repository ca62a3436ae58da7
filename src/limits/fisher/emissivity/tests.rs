use super::*;
use crate::planck;

const CENTRES: [f64; 6] = [800.0, 840.0, 900.0, 960.0, 1040.0, 1180.0];

fn seen() -> [Vec<f64>; 4] {
    let mut out = [vec![0.0; 6], vec![0.0; 6], vec![0.0; 6], vec![0.0; 6]];
    let [black, slope, light, sigma] = &mut out;
    planck::photon_radiance_and_slope_into(&CENTRES, 300.0, black, slope);
    for (w, nu) in CENTRES.iter().enumerate() {
        light[w] = [0.2, 0.9, 0.3, 0.1, 0.95, 0.25][w] * planck::photon_radiance(*nu, 285.0);
        sigma[w] = 0.05 * slope[w];
    }
    out
}

fn of(parts: &[Vec<f64>; 4]) -> Seen<'_> {
    let [blackbody, slope, light, sigma] = parts;
    Seen { blackbody, slope, light, sigma }
}

const KNOWN: Smoothness = Smoothness { mean: 0.9, magnitude: 0.2, shape: 0.05, correlation_cm1: 60.0 };

/// The same by another way: σ_T⁻² = sᵀC⁻¹s with C = σ² + (B − X) K (B − X), by Gaussian elimination of the whole matrix.
#[test]
fn the_temperature_has_the_bound_of_the_marginal_counts() {
    let parts = seen();
    let prior = EmissivityPrior::smooth(&CENTRES, KNOWN).unwrap();
    let e = [0.9, 0.92, 0.8, 0.7, 0.95, 0.99];
    let found = Separation::at(&prior, &e, &of(&parts)).unwrap();
    let [black, slope, light, sigma] = &parts;
    let contrast = |w: usize| black[w] - light[w];
    let covariance = DMatrix::from_fn(6, 6, |v, w| {
        let own = if v == w { sigma[w] * sigma[w] } else { 0.0 };
        own + contrast(v) * contrast(w) * prior.covariance(v, w)
    }) / 1e30;
    let s = DVector::from_fn(6, |w, _| e[w] * slope[w] / 1e15);
    let information = s.dot(&covariance.lu().solve(&s).unwrap());
    assert!((found.sigma_temperature_k * information.sqrt() - 1.0).abs() < 1e-9);
    // Averaged over the prior there is more, since E[e²] exceeds the square of the mean.
    let mean = Separation::at(&prior, prior.mean(), &of(&parts)).unwrap();
    let averaged = Separation::averaged(&prior, &of(&parts)).unwrap();
    assert!(averaged.sigma_temperature_k < mean.sigma_temperature_k);
}

/// An emissivity that is known leaves σ_T = 1/‖e B′/σ‖; one of which nothing is known but a huge range leaves what no bands tell.
#[test]
fn limits_of_what_is_known() {
    let parts = seen();
    let tight = Smoothness { magnitude: 1e-9, shape: 1e-9, ..KNOWN };
    let prior = EmissivityPrior::smooth(&CENTRES, tight).unwrap();
    let found = Separation::at(&prior, prior.mean(), &of(&parts)).unwrap();
    let expected = 0.05 / 0.9 / 6f64.sqrt();
    assert!((found.sigma_temperature_k / expected - 1.0).abs() < 1e-9);
    assert!(found.sigma_emissivity.iter().all(|sigma| *sigma < 1.5e-9));
    // Without contrast the emissivity stays what it was before, and the temperature is that of a blackbody.
    let mut dark = seen();
    dark[2] = dark[0].clone();
    let prior = EmissivityPrior::smooth(&CENTRES, KNOWN).unwrap();
    let found = Separation::at(&prior, prior.mean(), &of(&dark)).unwrap();
    assert!((found.sigma_temperature_k / expected - 1.0).abs() < 1e-9);
    let before = prior.covariance(2, 2).sqrt();
    assert!((found.sigma_emissivity[2] / before - 1.0).abs() < 1e-9);
    // A shape of which less is known tells less.
    let loose = EmissivityPrior::smooth(&CENTRES, Smoothness { shape: 0.1, ..KNOWN }).unwrap();
    let parts = seen();
    let [known, loose] = [&prior, &loose].map(|p| Separation::at(p, prior.mean(), &of(&parts)).unwrap());
    assert!(loose.sigma_temperature_k > known.sigma_temperature_k);
}

/// Principal components of spectra of known covariance.
#[test]
fn spectra_make_their_own_prior() {
    let a = [0.9, 0.8, 0.7];
    let b = [0.7, 0.8, 0.9];
    let prior = EmissivityPrior::of_spectra(&[&a, &b], 1).unwrap();
    assert!(prior.mean().iter().all(|mean| (mean - 0.8).abs() < 1e-15));
    assert!((prior.covariance(0, 0) - 0.02).abs() < 1e-12 && (prior.covariance(0, 2) + 0.02).abs() < 1e-12);
    assert!(prior.covariance(1, 1).abs() < 1e-12);
    assert!(EmissivityPrior::of_spectra(&[&a], 1).is_err());
    assert!(EmissivityPrior::of_spectra(&[&a, &b[..2]], 1).is_err());
    let parts = seen();
    assert!(Separation::at(&prior, &a, &of(&parts)).is_err());
    for wrong in [0.0, f64::NAN] {
        assert!(EmissivityPrior::smooth(&CENTRES, Smoothness { shape: wrong, ..KNOWN }).is_err());
    }
}
