//! The committed vectors as values of the crate, read from their JSON and nothing else.

use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::nearest::StateRange;
use hadar::instrument::{Camera, NoiseSpec, Readout, presets};
use hadar::scene::{EnvironmentObject, State, Surroundings};
use hadar::spectrum::Bands;
use serde_json::Value;
use std::path::PathBuf;

/// The folder of the vectors.
pub(super) fn folder() -> PathBuf {
    hadar_testing::repository().join("vectors")
}

/// The vectors of a topic.
pub(super) fn vectors(topic: &str) -> Vec<Value> {
    let text = std::fs::read_to_string(folder().join(format!("{topic}.json"))).unwrap();
    let file: Value = serde_json::from_str(&text).unwrap();
    file["vectors"].as_array().unwrap().clone()
}

/// One vector by its name.
pub(super) fn vector(topic: &str, id: &str) -> Value {
    vectors(topic).into_iter().find(|vector| vector["id"] == id).unwrap()
}

/// Numbers of a list.
pub(super) fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

pub(super) fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// A question about two materials.
pub(super) struct Scene {
    pub(super) bands: Bands,
    pub(super) surroundings: Surroundings,
    pub(super) state: State,
    pub(super) target: Vec<f64>,
    pub(super) alternative: Vec<f64>,
    pub(super) unknowns: Unknowns,
}

impl Scene {
    pub(super) fn read(inputs: &Value) -> Self {
        let bands = bands(inputs);
        let objects = inputs["environment"].as_array().unwrap();
        let object = |object: &Value| EnvironmentObject {
            temperature_k: number(&object["temperature_k"]),
            emissivity: (!object["emissivity"].is_null()).then(|| numbers(&object["emissivity"])),
        };
        let surroundings =
            Surroundings::new(bands.nodes_cm1(), objects.iter().map(object).collect()).unwrap();
        let lighting: Vec<f64> = objects.iter().map(|object| number(&object["lighting"])).collect();
        let state = surroundings.state(number(&inputs["temperature_k"]), &lighting).unwrap();
        Self {
            state: State { gain: number(&inputs["gain"]), ..state },
            target: numbers(&inputs["emissivity"]),
            alternative: numbers(&inputs["alternative_emissivity"]),
            unknowns: unknowns(inputs),
            surroundings,
            bands,
        }
    }
}

/// Bands whose nodes and weights are those of the vector.
fn bands(inputs: &Value) -> Bands {
    let [nodes, weights, of_node] =
        ["node_wavenumber_cm1", "node_weight_cm1", "node_band"].map(|key| numbers(&inputs[key]));
    let count = of_node[of_node.len() - 1] as usize + 1;
    let bands = if count == nodes.len() {
        Bands::from_rows(nodes.iter().copied().zip(weights.iter().copied())).unwrap()
    } else {
        let range = |band: usize| {
            let mut own = (0..nodes.len()).filter(|&node| of_node[node] as usize == band);
            let first = own.next().unwrap();
            let last = own.next_back().unwrap_or(first);
            (nodes[first] - 0.5 * weights[first], nodes[last] + 0.5 * weights[last])
        };
        Bands::from_ranges(&(0..count).map(range).collect::<Vec<_>>()).unwrap()
    };
    assert_eq!((bands.nodes_cm1(), bands.weights_cm1()), (nodes.as_slice(), weights.as_slice()));
    bands
}

fn unknowns(inputs: &Value) -> Unknowns {
    let names = inputs["unknown"].as_array().cloned().unwrap_or_default();
    let named = |nuisance: &Nuisance| names.iter().any(|name| name == nuisance.name());
    let set = Nuisance::ALL.into_iter().filter(named);
    let unknowns = Unknowns::new(set.clone()).unwrap();
    let unknowns = unknowns.lighting_total(inputs["lighting_total"].as_f64()).unwrap();
    set.fold(unknowns, |unknowns, nuisance| match inputs["prior_sigma"][nuisance.name()].as_f64() {
        Some(sigma) => unknowns.prior(nuisance, sigma).unwrap(),
        None => unknowns,
    })
}

/// Photons of the priors, or the counts of a camera.
pub(super) fn counting(inputs: &Value) -> Result<Counting, f64> {
    let noise = &inputs["noise"];
    match noise["counts_per_radiance_s_m2_sr"].as_f64() {
        Some(counts_per_radiance) => {
            Ok(Counting { counts_per_radiance, var_added: numbers(&noise["added_variance_counts2"]) })
        }
        None => Err(noise["photons"].as_f64().unwrap_or(f64::INFINITY)),
    }
}

pub(super) fn range(inputs: &Value) -> StateRange {
    let pair = |key: &str| <[f64; 2]>::try_from(numbers(&inputs["range"][key])).unwrap();
    StateRange {
        temperature_k: pair("temperature_k"),
        lighting: pair("lighting"),
        lighting_sum: number(&inputs["range"]["lighting_sum"]),
    }
}

pub(super) fn camera(camera: &Value) -> Camera {
    let figure = |key: &str| number(&camera[key]);
    let noise = &camera["noise"];
    let stated = |key: &str| noise[key].as_f64();
    let bandwidth_hz = stated("noise_bandwidth_hz");
    let spec = if let Some(netd_k) = stated("netd_k") {
        NoiseSpec::Netd {
            netd_k,
            temperature_k: number(&noise["netd_temperature_k"]),
            f_number: number(&noise["netd_f_number"]),
            optics_efficiency: number(&noise["netd_optics_efficiency"]),
            pixel_m: number(&noise["netd_pixel_m"]),
        }
    } else if let Some(detectivity_cm_hz05_w) = stated("detectivity_cm_hz05_w") {
        NoiseSpec::Detectivity { detectivity_cm_hz05_w, bandwidth_hz }
    } else if let Some(nep_w_hz05) = stated("nep_w_hz05") {
        NoiseSpec::Nep { nep_w_hz05, bandwidth_hz }
    } else if let Some(sigma_counts) = stated("noise_counts") {
        NoiseSpec::Counts { sigma_counts }
    } else {
        assert!(noise.is_null());
        NoiseSpec::None
    };
    let readout = Readout::ALL.into_iter().find(|readout| camera["readout"] == readout.name());
    let mut range = [715.0, 1250.0];
    if !noise["spectral_range_cm1"].is_null() {
        range = numbers(&noise["spectral_range_cm1"]).try_into().unwrap();
    }
    Camera {
        exposure_s: figure("exposure_s"),
        pixel_m: figure("pixel_m"),
        f_number: figure("f_number"),
        focal_length_m: figure("focal_length_m"),
        optics_efficiency: figure("optics_efficiency"),
        quantum_efficiency: figure("quantum_efficiency"),
        noise: spec,
        noise_exposure_s: figure("noise_exposure_s"),
        flicker_fraction: figure("flicker_fraction"),
        dark_rate_per_s: figure("dark_rate_per_s"),
        read_noise_counts: figure("read_noise_counts"),
        quantisation_bits: camera["quantisation_bits"].as_f64().map(|bits| bits as u32),
        full_well: camera["full_well_counts"].as_f64(),
        photon_bunching: false,
        readout: readout.unwrap(),
        frames: figure("frames") as u32,
        frame_rate_hz: None,
        spectral_range_cm1: range,
        ..presets::get("ideal-pnrd").unwrap()
    }
}
