use super::super::model::{Light, Setting};
use super::*;
use hadar::planck::photon_radiance;
use hadar::spectrum::Bands;
use nalgebra::{DMatrix, DVector};

/// Cost, slope and information against matrices that are written out and factored whole.
#[test]
fn the_modes_give_what_the_whole_covariance_gives() {
    let bands = Bands::uniform(800.0, 1200.0, 20.0).unwrap();
    let nu = bands.nodes_cm1().to_vec();
    let (scale, error) = (1e-12, LibraryError { relative: 0.02, correlation_cm1: 60.0 });
    let e: Vec<f64> = nu.iter().map(|nu| 0.7 + 0.2 * (nu / 80.0).sin()).collect();
    let sky: Vec<f64> = nu.iter().map(|nu| 0.8 * photon_radiance(*nu, 265.0)).collect();
    let model = Model::new(&Setting {
        bands: &bands,
        library: std::slice::from_ref(&e),
        surroundings: &[Light::Radiance(sky.clone())],
        counts_per_radiance: &vec![scale / 20.0; nu.len()],
        var_added: &[],
        units_per_count: 1.0,
        temperature_k: [250.0, 340.0],
        lighting_total: None,
        gain: false,
        bad_bands: &[],
        path: None,
        light_besides: &[],
    })
    .unwrap();
    let modes = Modes::new(&model, error).unwrap();
    let (t, v) = (301.7, 0.6);
    let mut state = State::at(t);
    (state.mixture[0], state.mixture[1]) = (1.0 - v, v);
    let mean = |t: f64, v: f64| -> DVector<f64> {
        DVector::from_fn(nu.len(), |w, _| {
            scale * (e[w] * photon_radiance(nu[w], t) + (1.0 - e[w]) * v * sky[w])
        })
    };
    let n = mean(t, v);
    let counts: Vec<f64> =
        n.iter().enumerate().map(|(w, n)| n * (1.0 + 0.01 * (1.3 * w as f64).cos())).collect();
    let mut shifted = vec![1.0; model.width];
    shifted[..nu.len()].copy_from_slice(&counts);
    let mut found = Sums::default();
    Workplace::default().sums(&model, &modes, 0, &shifted, &state, &mut found);
    // The covariance of the emissivity by its own formula: the modes leave a thousandth of it to the diagonal, where it stays.
    let covariance = DMatrix::from_fn(nu.len(), nu.len(), |i, j| {
        let x = 3.55 * (nu[i] - nu[j]).abs() / 60.0;
        let reach = |w: usize| scale * e[w] * (photon_radiance(nu[w], t) - v * sky[w]);
        let own = if i == j { n[i] } else { 0.0 };
        own + 0.02 * 0.02 * (1.0 + x + x * x / 3.0) * (-x).exp() * reach(i) * reach(j)
    });
    let factor = covariance.clone().cholesky().unwrap();
    let off = DVector::from_column_slice(&counts) - &n;
    let columns =
        [(mean(t + 0.01, v) - mean(t - 0.01, v)) / 0.02, (mean(t, v + 0.1) - mean(t, v - 0.1)) / 0.2];
    let close = |found: f64, exact: f64| assert!((found / exact - 1.0).abs() < 5e-3, "{found} {exact}");
    close(found.chi_square, off.dot(&factor.solve(&off)));
    let logarithm: f64 = factor.l().diagonal().iter().map(|x| 2.0 * x.ln()).sum();
    assert!((found.deviance - found.chi_square - logarithm).abs() < 5e-2, "{} {logarithm}", found.deviance);
    for (i, a) in columns.iter().enumerate() {
        close(found.slope[i], off.dot(&factor.solve(a)));
        for (j, b) in columns.iter().enumerate() {
            close(found.information[i][j], a.dot(&factor.solve(b)));
        }
    }
}
