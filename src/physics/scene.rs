//! The heat signal of a target and its surroundings: the only nonlinear physics of the crate.
//!
//! S(ν) = G·[ e(ν) B(ν,T) + (1 − e(ν)) Σₖ Vₖ εₖ(ν) B(ν,Tₖ) ]
//!
//! with target emissivity e and temperature T (K), environment objects k of temperature Tₖ (K), emissivity
//! εₖ and thermal lighting factor Vₖ (Vₖ ≥ 0, ΣVₖ ≤ 1; the rest is deep space without radiation), and an
//! overall gain G (1 for a calibrated camera). S is photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹.
//!
//! Assumptions: one scattering off the target (k objects, l = 1), Lambertian and angle-independent
//! emissivities, an opaque target (Kirchhoff: reflectance 1 − e), no atmosphere on the path.
//!
//! Source: paper S2, S3, S18, S30, S48.

mod careful;
mod jacobian;

pub(crate) use careful::{Asked, CarefulScene, Column};
pub(crate) use jacobian::Columns;
pub use jacobian::{Jacobian, Parameter};

use crate::error::{Error, Result, check};
use crate::planck;
use crate::simd::dispatched;
use crate::sum::Compensated;

/// Temperature of the blackbody that given spectra are shares of, times the hottest of their brightness.
const HOTTER: f64 = 1.01;

/// ΣVₖ may exceed 1 by this much, which is rounding of the user's own numbers.
const LIGHTING_TOLERANCE: f64 = 1e-12;

/// One object that lights the target.
#[derive(Debug, Clone, PartialEq)]
pub struct EnvironmentObject {
    /// Temperature Tₖ, K.
    pub temperature_k: f64,
    /// Emissivity εₖ at the nodes of the bands; a blackbody where `None`.
    pub emissivity: Option<Vec<f64>>,
}

/// What the target may be doing: all that is unknown about it but its material.
#[derive(Debug, PartialEq)]
pub struct State {
    /// Target temperature T, K.
    pub temperature_k: f64,
    /// Thermal lighting factors Vₖ, one per environment object.
    pub lighting: Vec<f64>,
    /// Overall gain G, 1 for a calibrated camera.
    pub gain: f64,
    /// Temperatures Tₖ of the environment objects, K.
    pub environment_k: Vec<f64>,
}

impl Clone for State {
    fn clone(&self) -> Self {
        Self { lighting: self.lighting.clone(), environment_k: self.environment_k.clone(), ..*self }
    }

    /// In the memory of the other one.
    fn clone_from(&mut self, other: &Self) {
        (self.temperature_k, self.gain) = (other.temperature_k, other.gain);
        self.lighting.clone_from(&other.lighting);
        self.environment_k.clone_from(&other.environment_k);
    }
}

/// Nodes of the spectral axis and the objects that light the target, with their radiances computed once.
#[derive(Debug, Clone, PartialEq)]
pub struct Surroundings {
    nodes_cm1: Vec<f64>,
    objects: Vec<EnvironmentObject>,
    /// B(Tₖ) at the nodes, object by object.
    blackbody: Vec<Vec<f64>>,
}

impl Surroundings {
    /// Surroundings seen at `nodes_cm1` (cm⁻¹). No objects at all is deep space.
    ///
    /// # Errors
    /// A temperature or wavenumber that is not positive, an emissivity outside [0, 1] or of the wrong length.
    pub fn new(nodes_cm1: &[f64], objects: Vec<EnvironmentObject>) -> Result<Self> {
        for &node in nodes_cm1 {
            check::positive("wavenumber", node, "cm^-1")?;
        }
        for object in &objects {
            check::positive("temperature of an environment object", object.temperature_k, "K")?;
            if let Some(emissivity) = &object.emissivity {
                check_emissivity(emissivity, nodes_cm1.len())?;
            }
        }
        let blackbody = objects
            .iter()
            .map(|object| {
                let mut radiance = vec![0.0; nodes_cm1.len()];
                planck::photon_radiance_into(nodes_cm1, object.temperature_k, &mut radiance);
                radiance
            })
            .collect();
        Ok(Self { nodes_cm1: nodes_cm1.to_vec(), objects, blackbody })
    }

    /// Surroundings that send these spectra (photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹ at `nodes_cm1`), each as shares of a blackbody a little hotter
    /// than the hottest of its brightness.
    ///
    /// # Errors
    /// A wavenumber that is not positive, a spectrum of another length or without light.
    ///
    /// ```
    /// use hadar::planck::photon_radiance;
    /// use hadar::scene::Surroundings;
    /// let nodes = [800.0, 1000.0];
    /// let sky = vec![0.2 * photon_radiance(800.0, 280.0), photon_radiance(1000.0, 280.0)];
    /// let around = Surroundings::of_radiances(&nodes, &[sky.clone()])?;
    /// let object = &around.objects()[0];
    /// let sent = object.emissivity.as_ref().map(|e| e[0] * photon_radiance(800.0, object.temperature_k));
    /// assert!((sent.unwrap() / sky[0] - 1.0).abs() < 1e-12);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn of_radiances(nodes_cm1: &[f64], radiances: &[Vec<f64>]) -> Result<Self> {
        let object = |radiance: &Vec<f64>| {
            let brightness =
                nodes_cm1.iter().zip(radiance).map(|(nu, s)| planck::brightness_temperature(*nu, *s));
            let temperature_k = HOTTER * brightness.fold(1.0, f64::max);
            let mut blackbody = vec![0.0; nodes_cm1.len()];
            planck::photon_radiance_into(nodes_cm1, temperature_k, &mut blackbody);
            let emissivity = radiance.iter().zip(&blackbody).map(|(s, b)| (s / b).min(1.0)).collect();
            EnvironmentObject { temperature_k, emissivity: Some(emissivity) }
        };
        Self::new(nodes_cm1, radiances.iter().map(object).collect())
    }

    /// The environment objects.
    #[must_use]
    pub fn objects(&self) -> &[EnvironmentObject] {
        &self.objects
    }

    /// Where spectra are sampled, cm⁻¹.
    #[must_use]
    pub fn nodes_cm1(&self) -> &[f64] {
        &self.nodes_cm1
    }

    /// The state of a target at `temperature_k` (K), lit by `lighting`, with everything else nominal.
    ///
    /// # Errors
    /// T ≤ 0 K, V < 0, ΣV > 1, or not one V per environment object.
    pub fn state(&self, temperature_k: f64, lighting: &[f64]) -> Result<State> {
        check::positive("target temperature", temperature_k, "K")?;
        if lighting.len() != self.objects.len() {
            return Err(Error::Length {
                what: "thermal lighting factors".into(),
                found: lighting.len(),
                expected: self.objects.len(),
            });
        }
        for &factor in lighting {
            check::non_negative("thermal lighting factor V", factor, "")?;
        }
        let total: f64 = lighting.iter().sum();
        if total > 1.0 + LIGHTING_TOLERANCE {
            return Err(Error::out_of_range("sum of the thermal lighting factors V", total, "", "at most 1"));
        }
        Ok(State {
            temperature_k,
            lighting: lighting.to_vec(),
            gain: 1.0,
            environment_k: self.objects.iter().map(|object| object.temperature_k).collect(),
        })
    }

    /// Checks a state whose fields were set one by one.
    ///
    /// # Errors
    /// Those of [`Surroundings::state`]; a gain or a temperature of the surroundings that is not positive, or not one per object.
    pub fn check(&self, state: &State) -> Result<()> {
        self.state(state.temperature_k, &state.lighting)?;
        check::positive("gain", state.gain, "")?;
        let (found, expected) = (state.environment_k.len(), self.objects.len());
        if found != expected {
            return Err(Error::Length { what: "temperatures of the surroundings".into(), found, expected });
        }
        for &temperature_k in &state.environment_k {
            check::positive("temperature of an environment object", temperature_k, "K")?;
        }
        Ok(())
    }

    /// εₖ at node j.
    fn object_emissivity(&self, object: usize, node: usize) -> f64 {
        self.objects[object].emissivity.as_ref().map_or(1.0, |emissivity| emissivity[node])
    }

    /// B(Tₖ) at the nodes for the temperature the state gives object k.
    fn object_blackbody(&self, object: usize, state: &State) -> Vec<f64> {
        let temperature_k = state.environment_k[object];
        let mut radiance = self.blackbody[object].clone();
        if temperature_k != self.objects[object].temperature_k {
            planck::photon_radiance_into(&self.nodes_cm1, temperature_k, &mut radiance);
        }
        radiance
    }

    /// εₖB(Tₖ) at the nodes for the temperature the state gives object k.
    pub fn object_signal(&self, object: usize, state: &State) -> Vec<f64> {
        let mut radiance = self.object_blackbody(object, state);
        if let Some(emissivity) = &self.objects[object].emissivity {
            radiance.iter_mut().zip(emissivity).for_each(|(radiance, e)| *radiance *= e);
        }
        radiance
    }

    /// Signal S at the nodes of a surface of emissivity `emissivity` (values at the nodes) in `state`.
    #[must_use]
    pub fn signal(&self, emissivity: &[f64], state: &State) -> Vec<f64> {
        crate::stop::check();
        let mut signal = vec![0.0; self.nodes_cm1.len()];
        planck::photon_radiance_into(&self.nodes_cm1, state.temperature_k, &mut signal);
        for (signal, e) in signal.iter_mut().zip(emissivity) {
            *signal *= e * state.gain;
        }
        for (object, factor) in state.lighting.iter().enumerate() {
            let radiance = self.object_blackbody(object, state);
            for (j, signal) in signal.iter_mut().enumerate() {
                let scattered = factor * self.object_emissivity(object, j) * radiance[j];
                *signal += state.gain * (1.0 - emissivity[j]) * scattered;
            }
        }
        signal
    }
}

/// 1 − ΣVₖ without the rounding error of the sum.
pub(crate) fn unlit(lighting: &[f64]) -> f64 {
    let mut rest = Compensated::default();
    rest.add(1.0);
    for factor in lighting {
        rest.add(-factor);
    }
    rest.value()
}

/// Checks that an emissivity has one value in [0, 1] per node.
///
/// # Errors
/// A wrong length or a value outside [0, 1].
pub fn check_emissivity(emissivity: &[f64], nodes: usize) -> Result<()> {
    if emissivity.len() != nodes {
        return Err(Error::Length { what: "emissivity".into(), found: emissivity.len(), expected: nodes });
    }
    if are_shares(emissivity) {
        return Ok(());
    }
    emissivity.iter().try_for_each(|value| check::unit_interval("emissivity", *value).map(drop))
}

dispatched! {
    /// Whether all are from 0 to 1.
    fn are_shares<'a>(values: &'a [f64]) -> bool {
        let mut all = true;
        for value in values {
            all &= (0.0..=1.0).contains(value);
        }
        all
    }
}
