//! What is seen: bands, two materials, surroundings, what is unknown, and the noise, all of it as numbers.
//!
//! The materials are made up, with t = (ν − 1000)/300 and the line L(c, w) = 1/(1 + ((ν − c)/w)²), ν in cm⁻¹, rounded to
//! four decimals:
//!
//! * coat 0.94 + 0.006 t − 0.03 L(1150, 60); metal 0.42 − 0.06 t + 0.04 t²;
//! * glass 0.92 − 0.45 L(1080, 70); sand 0.95 − 0.3 L(1130, 50) − 0.1 L(800, 25);
//! * sky 0.35 + 0.6 L(750, 80) + 0.2 L(1040, 20).

use super::answer::reach;
use super::json::Json;
use crate::reference::local::{Noise, Pair};
use hadar::error::Result;
use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::nearest::StateRange;
use hadar::scene::{EnvironmentObject, State, Surroundings};
use hadar::spectrum::Bands;

/// hc/k, cm K.
const SECOND_RADIATION_CM_K: f64 = 1.438_776_877_503_933_8;

/// A material: emissivity at a wavenumber in cm⁻¹.
pub(super) type Material = fn(f64) -> f64;

fn line(nu: f64, center: f64, half_width: f64) -> f64 {
    1.0 / (1.0 + ((nu - center) / half_width).powi(2))
}

fn rounded(emissivity: f64) -> f64 {
    (emissivity * 1e4).round() / 1e4
}

pub(super) fn coat(nu: f64) -> f64 {
    rounded(0.94 + 0.006 * (nu - 1000.0) / 300.0 - 0.03 * line(nu, 1150.0, 60.0))
}

pub(super) fn metal(nu: f64) -> f64 {
    let t = (nu - 1000.0) / 300.0;
    rounded(0.42 - 0.06 * t + 0.04 * t * t)
}

pub(super) fn glass(nu: f64) -> f64 {
    rounded(0.92 - 0.45 * line(nu, 1080.0, 70.0))
}

pub(super) fn sand(nu: f64) -> f64 {
    rounded(0.95 - 0.3 * line(nu, 1130.0, 50.0) - 0.1 * line(nu, 800.0, 25.0))
}

pub(super) fn sky(nu: f64) -> f64 {
    rounded(0.35 + 0.6 * line(nu, 750.0, 80.0) + 0.2 * line(nu, 1040.0, 20.0))
}

/// An object that lights the target.
#[derive(Debug, Clone)]
pub(super) struct Object {
    pub(super) temperature_k: f64,
    pub(super) lighting: f64,
    /// Of a blackbody where `None`.
    pub(super) material: Option<Material>,
}

/// Black surroundings of a temperature (K) and a lighting factor.
pub(super) fn black(temperature_k: f64, lighting: f64) -> Object {
    Object { temperature_k, lighting, material: None }
}

/// A question about two materials.
#[derive(Debug, Clone)]
pub(super) struct Scene {
    pub(super) bands: Bands,
    pub(super) target: Vec<f64>,
    pub(super) alternative: Vec<f64>,
    pub(super) temperature_k: f64,
    pub(super) gain: f64,
    pub(super) objects: Vec<Object>,
    pub(super) unknown: Vec<Nuisance>,
    pub(super) lighting_total: Option<f64>,
    /// Deviations of priors.
    pub(super) priors: Vec<(Nuisance, f64)>,
    /// Photons that the priors compete with; without a camera.
    pub(super) photons: Option<f64>,
    /// Counts with the noise of a camera.
    pub(super) counting: Option<Counting>,
    pub(super) range: StateRange,
}

impl Scene {
    /// Two materials at 310.15 K in black surroundings of 293.15 K, V = 0.5, in twenty bands of 25 cm⁻¹, nothing unknown.
    pub(super) fn of(target: Material, alternative: Material) -> Result<Self> {
        let bands = Bands::from_rows((0..20).map(|i| (750.0 + 25.0 * f64::from(i), 25.0)))?;
        Ok(Self {
            target: Vec::new(),
            alternative: Vec::new(),
            bands: bands.clone(),
            temperature_k: 310.15,
            gain: 1.0,
            objects: vec![black(293.15, 0.5)],
            unknown: Vec::new(),
            lighting_total: None,
            priors: Vec::new(),
            photons: None,
            counting: None,
            range: StateRange::default(),
        }
        .seen_in(bands, target, alternative))
    }

    /// The same materials, or others, in other bands.
    pub(super) fn seen_in(self, bands: Bands, target: Material, alternative: Material) -> Self {
        let at = |material: Material| bands.nodes_cm1().iter().map(|nu| material(*nu)).collect();
        let [target, alternative] = [target, alternative].map(at);
        Self { bands, target, alternative, ..self }
    }

    /// The same with this unknown.
    pub(super) fn not_knowing<const N: usize>(self, unknown: [Nuisance; N]) -> Self {
        Self { unknown: unknown.into(), ..self }
    }

    pub(super) fn surroundings(&self) -> Result<Surroundings> {
        let nodes = self.bands.nodes_cm1();
        let at = |object: &Object| EnvironmentObject {
            temperature_k: object.temperature_k,
            emissivity: object.material.map(|material| nodes.iter().map(|nu| material(*nu)).collect()),
        };
        Surroundings::new(nodes, self.objects.iter().map(at).collect())
    }

    pub(super) fn state(&self) -> State {
        State {
            temperature_k: self.temperature_k,
            lighting: self.objects.iter().map(|object| object.lighting).collect(),
            gain: self.gain,
            environment_k: self.objects.iter().map(|object| object.temperature_k).collect(),
        }
    }

    pub(super) fn unknowns(&self) -> Result<Unknowns> {
        let unknowns = Unknowns::new(self.unknown.iter().copied())?.lighting_total(self.lighting_total)?;
        self.priors.iter().try_fold(unknowns, |unknowns, (nuisance, sigma)| unknowns.prior(*nuisance, *sigma))
    }

    pub(super) fn noise(&self) -> Noise<'_> {
        let photons = self.photons.unwrap_or(f64::INFINITY);
        self.counting.as_ref().map_or(Noise::PerPhoton { photons }, Noise::Counting)
    }

    pub(super) fn pair<'a>(&'a self, state: &'a State) -> Pair<'a> {
        Pair { emissivity: &self.target, alternative: &self.alternative, state }
    }

    /// What doubles can do here: [`reach`] at the largest hcν/kT of what is seen.
    pub(super) fn reach(&self) -> f64 {
        let lit = self.objects.iter().filter(|object| object.lighting > 0.0);
        let coldest = lit.map(|object| object.temperature_k).fold(self.temperature_k, f64::min);
        let highest = self.bands.nodes_cm1().iter().copied().fold(0.0, f64::max);
        reach(SECOND_RADIATION_CM_K * highest / coldest)
    }

    /// Bands, target and surroundings.
    pub(super) fn seen(&self) -> Vec<(String, Json)> {
        let ones = vec![1.0; self.bands.nodes_cm1().len()];
        let counts = self.bands.sum_nodes(&ones);
        let band_of_node: Vec<f64> =
            (0..).zip(counts).flat_map(|(band, count)| vec![f64::from(band); count as usize]).collect();
        let nodes = self.bands.nodes_cm1();
        let object = |object: &Object| {
            let emissivity =
                object.material.map(|material| nodes.iter().map(|nu| material(*nu)).collect::<Vec<_>>());
            Json::object([
                ("temperature_k", object.temperature_k.into()),
                ("lighting", object.lighting.into()),
                ("emissivity", emissivity.as_deref().into()),
            ])
        };
        [
            ("node_wavenumber_cm1", nodes.into()),
            ("node_weight_cm1", self.bands.weights_cm1().into()),
            ("node_band", band_of_node.as_slice().into()),
            ("emissivity", self.target.as_slice().into()),
            ("alternative_emissivity", self.alternative.as_slice().into()),
            ("temperature_k", self.temperature_k.into()),
            ("gain", self.gain.into()),
            ("environment", Json::List(self.objects.iter().map(object).collect())),
            ("lighting_total", self.lighting_total.into()),
        ]
        .map(|(key, value)| (key.to_owned(), value))
        .into()
    }

    /// That with what is unknown, and the noise.
    pub(super) fn asked(&self) -> Vec<(String, Json)> {
        let mut inputs = self.seen();
        let names = self.unknown.iter().map(|nuisance| nuisance.name().into()).collect();
        inputs.push(("unknown".into(), Json::List(names)));
        let priors =
            self.priors.iter().map(|(nuisance, sigma)| (nuisance.name().to_owned(), (*sigma).into()));
        inputs.push(("prior_sigma".into(), Json::Object(priors.collect())));
        let noise = match &self.counting {
            None => Json::object([("photons", self.photons.into())]),
            Some(counting) => Json::object([
                ("counts_per_radiance_s_m2_sr", counting.counts_per_radiance.into()),
                ("added_variance_counts2", counting.var_added.as_slice().into()),
            ]),
        };
        inputs.push(("noise".into(), noise));
        inputs
    }
}
