use super::super::tests::Scene;
use super::*;
use crate::decompose::maps::Maps;
use crate::decompose::{NO_MATERIAL, Options, decompose, flag};
use hadar::cube::{Cube, MemoryCube, Shape};
use hadar::planck::photon_radiance;
use hadar::random::generator;
use nalgebra::DVector;
use rand_distr::{Distribution, Poisson, StandardNormal};

const PRIOR: f64 = 0.1;

fn maps(scene: &Scene, counts: &[f64], other: Option<f64>) -> Maps {
    let bands = scene.bands.len();
    let shape = Shape::new(1, counts.len() / bands, bands).unwrap();
    let cube = Cube::F64(Box::new(MemoryCube::new(shape, counts.to_vec()).unwrap()));
    let options = Options { other, ..Options::default() };
    scene.with(|setting| decompose(setting, &options, &cube, &|_| ()).unwrap())
}

/// Lower triangle of the covariance of emissivities of deviation 1.
fn law(scene: &Scene, correlation_cm1: f64) -> DMatrix<f64> {
    let nu = scene.bands.nodes_cm1();
    let each = |i: usize, j: usize| matern(nu[i] - nu[j], correlation_cm1) + if i == j { 1e-9 } else { 0.0 };
    DMatrix::from_fn(nu.len(), nu.len(), each).cholesky().unwrap().l()
}

/// Counts of surfaces whose emissivities are drawn from a law, each one of its own, and their temperatures.
fn drawn(scene: &Scene, [mean, deviation]: [f64; 2], pixels: usize, seed: u64) -> (Vec<f64>, Vec<f64>) {
    let (mut random, law) = (generator(seed, 0), law(scene, SMOOTH_CM1));
    let (mut counts, mut temperatures) = (Vec::new(), Vec::new());
    let widths = scene.bands.widths_cm1();
    for i in 0..pixels {
        let t = 285.0 + 30.0 * (i as f64 * 0.618_034).fract();
        let v = 0.25 + 0.5 * (i as f64 * 0.414_214).fract();
        let normal = DVector::from_fn(widths.len(), |_, _| StandardNormal.sample(&mut random));
        let off: DVector<f64> = &law * normal * deviation;
        for (w, nu) in scene.bands.nodes_cm1().iter().enumerate() {
            let e = (mean + off[w]).clamp(0.0, 1.0);
            let light = (1.0 - v) * scene.lights[0][w] + v * scene.lights[1][w];
            let sent = e * photon_radiance(*nu, t) + (1.0 - e) * light;
            let n = sent * widths[w] * scene.per_radiance[w];
            counts.push(Poisson::new(n).unwrap().sample(&mut random));
        }
        temperatures.push(t);
    }
    (counts, temperatures)
}

/// −2 ln of the mean of e^(−f/2) over temperatures and shares of the ground, at the middles of so many steps of each.
fn mean_cost([temperatures, shares]: [usize; 2], f: impl Fn(f64, f64) -> f64) -> f64 {
    let at = |i: usize, of: usize| (i as f64 + 0.5) / of as f64;
    let pairs = (0..temperatures).flat_map(|i| (0..shares).map(move |j| (i, j)));
    let costs: Vec<f64> = pairs.map(|(i, j)| f(270.0 + 65.0 * at(i, temperatures), at(j, shares))).collect();
    let least = costs.iter().copied().fold(f64::INFINITY, f64::min);
    let sum: f64 = costs.iter().map(|cost| (-0.5 * (cost - least)).exp()).sum();
    least - 2.0 * (sum / costs.len() as f64).ln()
}

/// The posterior against likelihoods with whole covariances, factored at every state, and their means over temperature and lighting on a
/// grid, within a factor of 12 of the odds (Laplace in a range that a temperature hardly narrows). Of several laws the one counts that costs
/// least.
#[test]
fn the_posterior_is_that_of_mean_likelihoods() {
    let scene = Scene::new(2, 21, 2e3);
    let (law, widths) = ([SMOOTH_CM1, GREY_CM1].map(|l| law(&scene, l)), scene.bands.widths_cm1());
    let mut seen = scene.draw(7, 0.0, 5).0;
    seen.extend(drawn(&scene, [0.75, 0.05], 2, 6).0);
    let found = maps(&scene, &seen, Some(PRIOR));
    let mut compared = 0;
    for (i, n) in seen.chunks(21).enumerate() {
        let n = DVector::from_column_slice(n);
        let known = |m: usize| {
            mean_cost([320, 120], |t, v| {
                let [mean, ..] = scene.mean(m, t, v);
                (0..21).map(|w| (n[w] - mean[w]).powi(2) / mean[w] + mean[w].ln()).sum()
            })
        };
        let unknown = |(place, [level, deviation]): (usize, [f64; 2])| {
            let law = &law[usize::from(GREY.contains(&place))];
            mean_cost([70, 28], |t, v| {
                let sent = |w: usize, e: f64| {
                    let light = (1.0 - v) * scene.lights[0][w] + v * scene.lights[1][w];
                    let planck = photon_radiance(scene.bands.nodes_cm1()[w], t);
                    (e * planck + (1.0 - e) * light) * scene.per_radiance[w] * widths[w]
                };
                let mean = DVector::from_fn(21, |w, _| sent(w, level));
                let reach = DVector::from_fn(21, |w, _| deviation * (sent(w, 1.0) - sent(w, 0.0)));
                let errors = DMatrix::from_diagonal(&reach) * law;
                let whole = DMatrix::from_diagonal(&mean) + &errors * errors.transpose();
                let factor = whole.cholesky().unwrap();
                let off = &n - &mean;
                let logarithm: f64 = factor.l().diagonal().iter().map(|x| 2.0 * x.ln()).sum();
                off.dot(&factor.solve(&off)) + logarithm
            })
        };
        let costs = [known(0), known(1)];
        let other = LAWS.into_iter().enumerate().map(unknown).fold(f64::INFINITY, f64::min);
        // Two materials share 1 − π.
        let weight = |cost: f64| (-0.5 * (cost - other)).exp() * 0.5 * (1.0 - PRIOR);
        let posterior = PRIOR / (PRIOR + weight(costs[0]) + weight(costs[1]));
        let logit = |p: f64| (p / (1.0 - p)).ln();
        if (1e-5..0.9999).contains(&posterior) {
            let off = logit(f64::from(found.other[i])) - logit(posterior);
            assert!(off.abs() < 2.5, "pixel {i}: {} is not {posterior}", found.other[i]);
            compared += 1;
        }
    }
    assert!(compared >= 5, "{compared}");
}

/// Surfaces of no material: what is decided without the hypothesis, and what with it; what is there is left as it is.
#[test]
fn what_is_none_of_the_library_is_told_and_what_is_of_it_stays() {
    for counts in [1e4, 1e5] {
        let scene = Scene::new(6, 41, counts);
        let decided = |maps: &Maps| (0..maps.material.len()).filter(|i| maps.is_decided(*i)).count();
        let (seen, truth) = scene.draw(600, 0.0, 7);
        let [before, after] = [None, Some(PRIOR)].map(|other| maps(&scene, &seen, other));
        assert!(
            decided(&after) as f64 > 0.95 * decided(&before) as f64,
            "{counts}: {} of {}",
            decided(&after),
            decided(&before)
        );
        let taken =
            (0..600).filter(|i| after.material[*i] == NO_MATERIAL && after.candidates[*i] == 1).count();
        assert!(taken <= 1, "{counts}: {taken}");
        let wrong =
            (0..600).filter(|i| after.is_decided(*i) && usize::from(after.material[*i]) != truth[*i].0);
        assert!(wrong.count() <= 6);
        for drawn_from in [[0.75, 0.15], [0.4, 0.25]] {
            let (seen, temperatures) = drawn(&scene, drawn_from, 300, 11);
            let [before, after] = [None, Some(PRIOR)].map(|other| maps(&scene, &seen, other));
            assert!(
                decided(&after) <= decided(&before) && decided(&after) <= 6,
                "{counts}: {} of {}",
                decided(&after),
                decided(&before)
            );
            let alone: Vec<usize> =
                (0..300).filter(|i| after.material[*i] == NO_MATERIAL && after.candidates[*i] == 1).collect();
            assert!(alone.len() > 250, "{counts}: {}", alone.len());
            assert!(alone.iter().all(|i| after.flags[*i] & flag::NO_FIT != 0));
            let off = |i: &&usize| {
                let (t, sigma) =
                    (f64::from(after.temperature_k[**i]), f64::from(after.temperature_sigma_k[**i]));
                (t - temperatures[**i]).abs() < 1.96 * sigma
            };
            let held = alone.iter().filter(off).count() as f64 / alone.len() as f64;
            assert!(held > 0.85, "{counts}, {drawn_from:?}: {held}");
        }
    }
}

/// Whatever is there: the hypothesis decides no pixel, and takes no candidate from one.
#[test]
fn one_more_hypothesis_never_decides_a_pixel() {
    for (counts, prior) in [(30.0, 0.01), (3e2, 0.5), (3e3, 0.1), (3e5, 0.9)] {
        let scene = Scene::new(5, 17, counts);
        let mut seen = scene.draw(60, 0.0, 3).0;
        seen.extend(drawn(&scene, [0.95, 0.03], 60, 4).0);
        seen.extend(drawn(&scene, [0.4, 0.25], 60, 5).0);
        let [before, after] = [None, Some(prior)].map(|other| maps(&scene, &seen, other));
        for i in 0..180 {
            assert!(!after.is_decided(i) || before.is_decided(i) && after.material[i] == before.material[i]);
            let none = after.material[i] == NO_MATERIAL;
            assert!(none || after.candidates[i] >= before.candidates[i], "{counts}, pixel {i}");
        }
    }
}

#[test]
fn a_probability_is_between_none_and_all() {
    let scene = Scene::new(2, 9, 1e3);
    for wrong in [0.0, 1.0, -0.1, f64::NAN] {
        assert!(scene.with(|setting| Other::new(setting, [wrong, 1.0 - wrong], &[1.0, 1.0])).is_err());
    }
}

/// Against the determinant by another decomposition; where nothing is told, P alone is left, and rounding makes no pivot smaller.
#[test]
fn the_volume_is_that_of_the_determinant() {
    let scene = Scene::new(2, 21, 1e4);
    let model = scene.with(|setting| Model::new(setting).unwrap());
    let mut seen = Sums::default();
    let prior = [12.0_f64 / (65.0 * 65.0), 12.0];
    assert!((volume(&model, &seen) - (prior[0] * prior[1]).ln()).abs() < 1e-12);
    let rows = [[40.0, -130.0], [-130.0, 900.0]];
    for (i, row) in rows.iter().enumerate() {
        seen.information[i][..2].copy_from_slice(row);
    }
    let whole = DMatrix::from_fn(2, 2, |i, j| rows[i][j] + if i == j { prior[i] } else { 0.0 });
    assert!((volume(&model, &seen) - whole.lu().determinant().ln()).abs() < 1e-10);
    // Temperature and lighting that do the same but for rounding.
    for (i, row) in [[1e18, 1e19], [1e19, 1e20 * (1.0 - 1e-15)]].iter().enumerate() {
        seen.information[i][..2].copy_from_slice(row);
    }
    assert!(volume(&model, &seen) >= (1e18_f64 * prior[1]).ln() - 1e-12);
}
