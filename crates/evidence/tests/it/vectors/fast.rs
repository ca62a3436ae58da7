//! What the product answers, through its public functions.

use super::judge::Found;
use super::read::{Scene, camera, counting, folder, number, numbers, range};
use hadar::identifiability::local::LocalSolver;
use hadar::identifiability::nearest::NearestSolver;
use hadar::identifiability::ratio::RatioLaw;
use hadar::identifiability::{Status, detection};
use hadar::instrument::{View, gamma_per_band, view};
use hadar::material::Library;
use hadar::planck;
use hadar::policy::solve::{CameraTask, Quantity, Trial};
use hadar::policy::stop::{Start, Stop, StopFigures};
use hadar::policy::{hardware_required_m2_s, photons_required};
use hadar::scene::{Jacobian, Parameter};
use hadar::spectrum::Bands;
use hadar::statistics::Statistics;
use hadar_scenario::Scenario;
use hadar_study::Study;
use serde_json::Value;

type Answers = Vec<(String, Found)>;

/// The answers of the product to a vector of a topic.
pub(super) fn answers(topic: &str, vector: &Value) -> Answers {
    let inputs = &vector["inputs"];
    match topic {
        "planck" => radiance(inputs),
        "signal" => signal(inputs),
        "counts" => counts(inputs),
        "local" => local(inputs),
        "nearest" => nearest(inputs),
        "probability" => probability(inputs),
        "requirement" => requirement(inputs, vector),
        "stop" => stop(inputs),
        "identify" => identify(inputs, vector),
        _ => panic!("a topic that nothing answers: {topic}"),
    }
}

fn named<const N: usize>(answers: [(&str, Found); N]) -> Answers {
    answers.into_iter().map(|(name, found)| (name.to_owned(), found)).collect()
}

fn radiance(inputs: &Value) -> Answers {
    let [nu, t] = ["wavenumber_cm1", "temperature_k"].map(|key| number(&inputs[key]));
    let mut answers = named([
        ("photon_radiance_per_s_m2_sr_cm1", planck::photon_radiance(nu, t).into()),
        ("photon_radiance_slope_per_s_m2_sr_cm1_k", planck::photon_radiance_slope(nu, t).into()),
    ]);
    if let Some(base_k) = inputs["base_temperature_k"].as_f64() {
        let (base, mut difference) = ([planck::photon_radiance(nu, base_k)], [0.0]);
        planck::photon_radiance_difference_into(&[nu], base_k, t - base_k, &base, &mut difference);
        answers.push(("photon_radiance_difference_per_s_m2_sr_cm1".into(), difference[0].into()));
    }
    answers
}

fn signal(inputs: &Value) -> Answers {
    let scene = Scene::read(inputs);
    let objects = scene.surroundings.objects().len();
    let total_known = scene.unknowns.known_lighting_total().is_some();
    let mut parameters = vec![Parameter::Temperature, Parameter::Gain, Parameter::Material];
    parameters.extend((0..objects - usize::from(total_known)).map(Parameter::Lighting));
    parameters.extend((0..objects).map(Parameter::EnvironmentTemperature));
    let mut jacobian = Jacobian::new(&scene.bands, &scene.surroundings);
    jacobian.evaluate(&scene.target, &scene.alternative, &scene.state, &parameters, total_known);
    let mut answers = named([
        ("photon_radiance_per_s_m2_sr", hadar::sum::sum(jacobian.signal()).into()),
        ("band_signal_per_s_m2_sr", jacobian.signal().into()),
    ]);
    for (i, parameter) in parameters.iter().enumerate() {
        let name = match parameter {
            Parameter::Temperature => "temperature_per_s_m2_sr_k".into(),
            Parameter::Gain => "log_gain_per_s_m2_sr".into(),
            Parameter::Material => "material_per_s_m2_sr".into(),
            Parameter::Lighting(k) => format!("lighting_{k}_per_s_m2_sr"),
            Parameter::EnvironmentTemperature(k) => format!("environment_temperature_{k}_per_s_m2_sr_k"),
        };
        answers.push((format!("derivative_{name}"), jacobian.column(i).into()));
    }
    answers
}

fn counts(inputs: &Value) -> Answers {
    let camera = camera(&inputs["camera"]);
    let [centers, widths, signal] =
        ["band_wavenumber_cm1", "band_width_cm1", "band_signal_per_s_m2_sr"].map(|key| numbers(&inputs[key]));
    let bands = Bands::from_rows(centers.into_iter().zip(widths)).unwrap();
    let distance_m = inputs["distance_m"].as_f64();
    let fill = match (inputs["target_size_m"].as_f64(), distance_m) {
        (Some(size_m), Some(z)) => view::fill(size_m, camera.pixel_m, camera.focal_length_m, z),
        _ => 1.0,
    };
    let view = View { fill, signal: signal.clone(), ..View::at(distance_m) };
    let counting = camera.counting(&bands, &view);
    let counts: Vec<f64> = signal.iter().map(|s| s * counting.counts_per_radiance).collect();
    let variance: Vec<f64> = (0..bands.len()).map(|band| counting.var_added(band)).collect();
    named([
        ("etendue_m2_sr", camera.etendue_m2_sr(distance_m).into()),
        ("counts_per_radiance_s_m2_sr", counting.counts_per_radiance.into()),
        ("counts", counts.as_slice().into()),
        ("added_variance_counts2", variance.as_slice().into()),
        ("gamma", gamma_per_band(&counting, &signal).into()),
    ])
}

fn local(inputs: &Value) -> Answers {
    let scene = Scene::read(inputs);
    let mut solver = LocalSolver::new(&scene.bands, &scene.surroundings, scene.unknowns.clone());
    let found = match counting(inputs) {
        Ok(counting) => solver.with_counting(&scene.target, &scene.alternative, &scene.state, &counting),
        Err(photons) => solver.per_photon(&scene.target, &scene.alternative, &scene.state, photons),
    };
    let found = found.unwrap();
    let status = match found.status {
        Status::Ok => "ok",
        Status::Equilibrium => "equilibrium",
        Status::Blind => "blind",
        Status::Identical => "identical",
    };
    named([
        ("status", Found::Word(status.into())),
        ("distance", found.distance.into()),
        ("distance_no_nuisance", found.distance_no_nuisance.into()),
    ])
}

fn nearest(inputs: &Value) -> Answers {
    let scene = Scene::read(inputs);
    let Scene { bands, surroundings, unknowns, .. } = &scene;
    let mut solver = NearestSolver::new(bands, surroundings, unknowns.clone(), range(inputs)).proving(1e-6);
    let found = match counting(inputs) {
        Ok(counting) => solver.with_counting(&scene.target, &scene.alternative, &scene.state, &counting),
        Err(photons) => solver.per_photon(&scene.target, &scene.alternative, &scene.state, photons),
    };
    let found = found.unwrap();
    let mut answers = named([("distance_nearest", found.distance.into())]);
    for parameter in unknowns.parameters(1) {
        answers.push(match parameter {
            Parameter::Temperature => ("nearest_temperature_k".into(), found.state.temperature_k.into()),
            Parameter::Lighting(_) => ("nearest_lighting".into(), found.state.lighting.as_slice().into()),
            Parameter::Gain => ("nearest_gain".into(), found.state.gain.into()),
            Parameter::EnvironmentTemperature(_) => {
                ("nearest_environment_temperature_k".into(), found.state.environment_k.as_slice().into())
            }
            Parameter::Material => continue,
        });
    }
    if unknowns.known_lighting_total().is_some() {
        answers.push(("nearest_lighting".into(), found.state.lighting.as_slice().into()));
    }
    answers
}

fn probability(inputs: &Value) -> Answers {
    if let Some(d) = inputs["statistical_distance"].as_f64() {
        let bracket = detection::error_bracket(d);
        return named([
            ("detection_probability", detection::probability(d).into()),
            ("miss_probability", detection::miss_probability(d).into()),
            ("information_bits", detection::information_bits(d).into()),
            ("mutual_information_bits", detection::mutual_information_bits(d).into()),
            ("error_lower", bracket.lower.into()),
            ("error_upper", bracket.upper.into()),
        ]);
    }
    if let Some(probability) = inputs["detection_probability"].as_f64() {
        let d = detection::distance_for_probability(probability).unwrap();
        return named([("statistical_distance", d.into())]);
    }
    let [means, others] = ["mean_counts", "other_mean_counts"].map(|key| numbers(&inputs[key]));
    let law = RatioLaw::new(&means, &others, &Statistics::Poisson).unwrap();
    named([("error_of_best_test", law.error().error.into())])
}

fn requirement(inputs: &Value, vector: &Value) -> Answers {
    let required = number(&inputs["statistical_distance_required"]);
    if let Some(distance) = inputs["distance"].as_f64() {
        let photons = photons_required(required, distance);
        let radiance = number(&inputs["photon_radiance_per_s_m2_sr"]);
        let hardware = photons.map(|photons| hardware_required_m2_s(photons, radiance));
        return named([("photons_required", photons.into()), ("hardware_required_m2_s", hardware.into())]);
    }
    let (scene, camera) = (Scene::read(inputs), camera(&inputs["camera"]));
    let distance_m = inputs["distance_m"].as_f64();
    let name = vector["answers"].as_object().unwrap().keys().next().unwrap();
    let quantity = Quantity::ALL.into_iter().find(|quantity| quantity.key() == name).unwrap();
    let bands = &scene.bands;
    let task = CameraTask {
        camera: &camera,
        bands,
        required,
        distance_m,
        farthest_m: None,
        size_m: None,
        of_object: false,
    };
    let mut solver = LocalSolver::new(bands, &scene.surroundings, scene.unknowns.clone());
    let solution = task.solve(quantity, |trial: &Trial| {
        let counting = trial.camera.counting(bands, &View::at(trial.distance_m));
        let found = solver.with_counting(&scene.target, &scene.alternative, &scene.state, &counting)?;
        Ok(found.distance)
    });
    vec![(name.clone(), solution.unwrap().value.into())]
}

fn stop(inputs: &Value) -> Answers {
    let of = |key: &str| number(&inputs[key]);
    let stop = Stop::new(StopFigures {
        speeds_m_s: [of("speed_m_s"); 2],
        target_m_s: of("target_speed_m_s"),
        latency_s: of("latency_s"),
        deceleration_m_s2: of("deceleration_m_s2"),
        margin_m: of("margin_m"),
        start: Some(Start::TimeToContact(of("time_to_contact_at_start_s"))),
    });
    let [decision, _] = stop.unwrap().decisions();
    named([
        ("closing_speed_m_s", decision.closing_m_s.into()),
        ("decision_distance_m", decision.distance_m.into()),
        ("decision_time_s", decision.time_s.into()),
    ])
}

fn identify(inputs: &Value, vector: &Value) -> Answers {
    let path = folder().join(inputs["scenario"].as_str().unwrap());
    let study = Study::new(&Scenario::from_file(&path).unwrap(), &Library::embedded().unwrap()).unwrap();
    let json = serde_json::to_value(study.identify().unwrap()).unwrap();
    let keys = vector["answers"].as_object().unwrap().keys();
    keys.map(|key| (key.clone(), json.pointer(key).unwrap_or_else(|| panic!("no {key}")).into())).collect()
}
