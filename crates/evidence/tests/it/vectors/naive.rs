//! Programs that are wrong by what people are wrong by: which vectors tell them so.

use super::judge::{Found, share};
use super::read::{Scene, camera, counting, number, numbers, vector, vectors};
use hadar::fisher::Counting;
use hadar::identifiability::detection::probability;
use hadar::identifiability::local::LocalSolver;
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::instrument::{View, gamma_per_band};
use hadar::planck::photon_radiance;
use hadar::scene::{Jacobian, Parameter};
use nalgebra::DMatrix;
use serde_json::Value;

/// Names of the vectors of a topic in which an answer is wrong.
fn told(topic: &str, name: &str, answer: impl Fn(&Value) -> Option<Found>) -> Vec<String> {
    let wrong = |vector: &Value| {
        let found = answer(&vector["inputs"]).filter(|_| !vector["answers"][name].is_null());
        found.is_some_and(|found| share(&found, &vector["answers"][name]) > 1.0)
    };
    let id = |vector: Value| vector["id"].as_str().unwrap().to_owned();
    vectors(topic).into_iter().filter(wrong).map(id).collect()
}

fn wavenumber_and(inputs: &Value, temperature: &str) -> Option<(f64, f64)> {
    Some((number(&inputs["wavenumber_cm1"]), inputs[temperature].as_f64()?))
}

#[test]
fn exp_of_x_less_1_and_subtracted_radiances() {
    let textbook = |inputs: &Value| {
        let (nu, t) = wavenumber_and(inputs, "temperature_k")?;
        let x = 1.438_776_877_503_933_8 * nu / t;
        Some(Found::Number(599_584_916_000_000.0 * nu * nu / (x.exp() - 1.0)))
    };
    assert_eq!(told("planck", "photon_radiance_per_s_m2_sr_cm1", textbook), ["radio", "radio-hot"]);
    let slope = |inputs: &Value| {
        let (nu, t) = wavenumber_and(inputs, "temperature_k")?;
        let x = 1.438_776_877_503_933_8 * nu / t;
        Some(Found::Number(599_584_916_000_000.0 * nu * nu * x * x.exp() / (t * (x.exp() - 1.0).powi(2))))
    };
    let found = told("planck", "photon_radiance_slope_per_s_m2_sr_cm1_k", slope);
    assert_eq!(found, ["radio", "radio-hot", "wien", "dark", "darkest", "both-dark"]);
    let difference = |inputs: &Value| {
        let (nu, base_k) = wavenumber_and(inputs, "base_temperature_k")?;
        let t = number(&inputs["temperature_k"]);
        Some(Found::Number(photon_radiance(nu, t) - photon_radiance(nu, base_k)))
    };
    let found = told("planck", "photon_radiance_difference_per_s_m2_sr_cm1", difference);
    assert_eq!(found, ["warmer-by-10-mk", "warmer-by-1-nk", "warmer-by-a-bit", "cooler-by-1-uk"]);
}

/// B(T) − ΣVB(Tₖ) and B(T₀) − B(T₁) as they stand, every radiance to the last bits, in bands of one node.
#[test]
fn contrasts_by_subtraction() {
    let material = |inputs: &Value| {
        let scene = Scene::read(inputs);
        scene.bands.one_node_per_band().then_some(Found::Numbers(contrast(&scene)))
    };
    let found = told("signal", "derivative_material_per_s_m2_sr", material);
    assert_eq!(found, ["near-equilibrium", "last-bit"]);
    let lighting = |inputs: &Value| {
        let scene = Scene::read(inputs);
        scene.unknowns.known_lighting_total()?;
        let difference = |(j, nu): (usize, &f64)| {
            let apart = object(&scene, 0, j, *nu) - object(&scene, 1, j, *nu);
            scene.bands.weights_cm1()[j] * (1.0 - scene.target[j]) * apart
        };
        Some(Found::Numbers(scene.bands.nodes_cm1().iter().enumerate().map(difference).collect()))
    };
    assert_eq!(told("signal", "derivative_lighting_0_per_s_m2_sr", lighting), ["total-known-alike"]);
}

/// εₖB(Tₖ) at node j.
fn object(scene: &Scene, k: usize, j: usize, nu: f64) -> f64 {
    let emissivity = scene.surroundings.objects()[k].emissivity.as_ref().map_or(1.0, |e| e[j]);
    emissivity * photon_radiance(nu, scene.state.environment_k[k])
}

/// The derivative along the material in bands of one node, its contrast by subtraction.
fn contrast(scene: &Scene) -> Vec<f64> {
    let at = |(j, nu): (usize, &f64)| {
        let lighting = scene.state.lighting.iter().enumerate();
        let lit: f64 = lighting.map(|(k, factor)| factor * object(scene, k, j, *nu)).sum();
        let contrast = photon_radiance(*nu, scene.state.temperature_k) - lit;
        scene.bands.weights_cm1()[j] * scene.state.gain * (scene.alternative[j] - scene.target[j]) * contrast
    };
    scene.bands.nodes_cm1().iter().enumerate().map(at).collect()
}

/// 1/(2√[J⁻¹]_gg) with a Fisher matrix that is inverted, and the contrast by subtraction.
#[test]
fn inverted_fisher_matrices() {
    let fisher = |subtracted: bool| {
        move |inputs: &Value| {
            let scene = Scene::read(inputs);
            let mut parameters = scene.unknowns.parameters(scene.state.lighting.len());
            parameters.push(Parameter::Material);
            let total_known = scene.unknowns.known_lighting_total().is_some();
            let mut jacobian = Jacobian::new(&scene.bands, &scene.surroundings);
            let Scene { target, alternative, state, .. } = &scene;
            jacobian.evaluate(target, alternative, state, &parameters, total_known);
            let total: f64 = jacobian.signal().iter().sum();
            let weight = |w: usize, signal: f64| match counting(inputs) {
                Ok(Counting { counts_per_radiance: counts, var_added }) => {
                    counts * counts / (counts * signal + var_added[w])
                }
                Err(_) => 1.0 / (signal * total),
            };
            let weights: Vec<f64> =
                jacobian.signal().iter().enumerate().map(|(w, s)| weight(w, *s)).collect();
            let columns: Vec<Vec<f64>> = (0..parameters.len())
                .map(|i| match parameters[i] {
                    Parameter::Material if subtracted => contrast(&scene),
                    _ => jacobian.column(i).to_vec(),
                })
                .collect();
            let mut matrix = DMatrix::from_fn(parameters.len(), parameters.len(), |i, j| {
                (0..weights.len()).map(|w| weights[w] * columns[i][w] * columns[j][w]).sum::<f64>()
            });
            for (i, parameter) in parameters.iter().enumerate() {
                let photons = counting(inputs).err().unwrap_or(1.0);
                matrix[(i, i)] +=
                    scene.unknowns.sigma_prior(*parameter).map_or(0.0, |s| 1.0 / (s * s * photons));
            }
            let last = parameters.len() - 1;
            let found = matrix.try_inverse().map_or(f64::NAN, |inverse| 0.5 / inverse[(last, last)].sqrt());
            Some(Found::Number(found))
        }
    };
    let holds = |found: &[String], ids: &[&str]| ids.iter().all(|id| found.contains(&(*id).to_owned()));
    let found = told("local", "distance", fisher(false));
    assert!(holds(&found, &["equilibrium", "identical", "blind", "nearly-dependent"]), "{found:?}");
    assert!(!holds(&found, &["near-equilibrium"]) && !holds(&found, &["last-bit"]), "{found:?}");
    let found = told("local", "distance", fisher(true));
    assert!(holds(&found, &["near-equilibrium", "last-bit"]), "{found:?}");
}

/// Newton's method downhill from the target's own state alone.
#[test]
fn a_search_from_one_start() {
    let down = |inputs: &Value| {
        let scene = Scene::read(inputs);
        let Scene { bands, surroundings, state, target, alternative, unknowns } = &scene;
        let signal = bands.weigh(&surroundings.signal(target, state));
        let one_photon = Counting::shot(1.0, &signal);
        let counting = counting(inputs).unwrap_or(one_photon);
        let mut solver =
            NearestSolver::new(bands, surroundings, unknowns.clone(), super::read::range(inputs));
        let found = solver.refine_with_counting(target, alternative, state, &counting, state).unwrap();
        (!unknowns.has_priors()).then_some(Found::Number(found.distance))
    };
    assert_eq!(told("nearest", "distance_nearest", down), ["two-valleys"]);
    // All that physics allows instead of what is allowed.
    let free = |inputs: &Value| {
        let scene = Scene::read(inputs);
        let Scene { bands, surroundings, state, target, alternative, unknowns } = &scene;
        let range = StateRange { lighting: [0.0, 10.0], lighting_sum: 10.0, ..StateRange::default() };
        let mut solver = NearestSolver::new(bands, surroundings, unknowns.clone(), range).proving(1e-6);
        let found = solver.per_photon(target, alternative, state, f64::INFINITY).unwrap();
        counting(inputs).is_err().then_some(Found::Number(found.distance))
    };
    let found = told("nearest", "distance_nearest", free);
    for id in ["warm-edge", "two-objects", "surroundings", "priors"] {
        assert!(found.contains(&id.to_owned()), "{id}: {found:?}");
    }
}

#[test]
fn probabilities_less_1() {
    let of = |value: fn(f64) -> f64| {
        move |inputs: &Value| Some(Found::Number(value(inputs["statistical_distance"].as_f64()?)))
    };
    let miss = told("probability", "miss_probability", of(|d| 1.0 - probability(d)));
    assert_eq!(miss, ["five", "ten", "twenty", "thirty-seven"]);
    let bits = told("probability", "information_bits", of(|d| (2.0 * probability(d)).log2()));
    assert_eq!(bits, ["next-to-nothing", "tiny"]);
    // The normal law where counts are few: √(Σ(√a − √b)²).
    let normal = |inputs: &Value| {
        let means = (!inputs["mean_counts"].is_null()).then_some(["mean_counts", "other_mean_counts"])?;
        let [means, others] = means.map(|key| numbers(&inputs[key]));
        let square: f64 = means.iter().zip(&others).map(|(a, b)| (a.sqrt() - b.sqrt()).powi(2)).sum();
        Some(Found::Number(probability(-square.sqrt())))
    };
    assert_eq!(told("probability", "error_of_best_test", normal).len(), 4);
}

/// t = (d_req/d₀)²(1 + γ)/(N/t), the paper's shortcut, with noise that grows as the exposure.
#[test]
fn one_gamma_for_all_bands() {
    let vector = vector("requirement", "exposure-noisy");
    let inputs = &vector["inputs"];
    let (scene, camera) = (Scene::read(inputs), camera(&inputs["camera"]));
    let Scene { bands, surroundings, state, target, alternative, unknowns } = &scene;
    let signal = bands.weigh(&surroundings.signal(target, state));
    let counting = camera.counting(bands, &View::at(inputs["distance_m"].as_f64()));
    let photons: f64 = signal.iter().map(|signal| signal * counting.counts_per_radiance).sum();
    let mut solver = LocalSolver::new(bands, surroundings, unknowns.clone());
    let d0 = solver.per_photon(target, alternative, state, f64::INFINITY).unwrap().distance;
    let needed = (number(&inputs["statistical_distance_required"]) / d0).powi(2);
    let exposure_s = camera.exposure_s * needed * (1.0 + gamma_per_band(&counting, &signal)) / photons;
    let share = share(&Found::Number(exposure_s), &vector["answers"]["exposure_s"]);
    assert!(share > 1e6, "{exposure_s} {share}");
}
