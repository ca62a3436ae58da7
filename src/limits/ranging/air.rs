//! Depth from one view: the air between as a ruler.
//!
//! Of a target at distance z (m) a camera sees, at wavenumber ν (cm⁻¹),
//!
//! L = G [τ S + (1 − τ) B(T_air)],   τ = e⁻ᴰ(ν, z),   S = e B(T) + (1 − e) Σₖ Vₖ εₖ B(Tₖ)
//!
//! with the transmittance τ of an [`Atmosphere`], the signal S of the target ([`crate::scene`]), the temperature T_air of the air
//! (K) and an overall gain G. Air that absorbs also shines: what it takes from the target it replaces by its own light, and
//! that exchange grows with z:
//!
//! ∂L/∂z = −G τ D′ (S − B(T_air)),   D′ = ∂D/∂z (m⁻¹),
//!
//! which is nothing where the target looks like the air, however much air there is. S − B(T_air) is formed of differences of
//! radiances, so that it keeps its digits there: e[B(T) − B_air] + (1 − e)[Σ Vₖεₖ(B(Tₖ) − B_air) − (1 − ΣVₖεₖ)B_air].
//!
//! Counts are N = κ ∫ L, their variance N + σ²: the light of the path is part of N, since it tells of z too, and its photons
//! are noise like all others.
//!
//! [`AirSolver`] gives the least error of z ([`AirBound`]) and the bands that tell most of it ([`AirChoice`]); an emissivity may be
//! known but for smooth errors ([`SmoothEmissivity`]).
//!
//! Assumptions: those of the table (homogeneous air at rest, no scattering: [`crate::atmosphere`]); the target fills the pixel; one
//! scattering off the target; the lighting is that of the target's place, unchanged by the path. That a lens near the target gathers
//! less light (f/z in the étendue) is no ruler: the target's own brightness is not known that well.
//!
//! Sources: Hawks, 'Passive ranging using atmospheric oxygen absorption spectra', thesis, Air Force Institute of Technology (2006) for
//! the principle; in the long-wave infrared Dorken Gallastegi et al., Opt. Express 32, 151 (2024), doi:10.1364/OE.507927 (bounds without
//! reflected light), arXiv:2308.05818 (images) and arXiv:2603.00273 (with the light of the sky).

mod bound;
mod choice;
mod smooth;
#[cfg(test)]
mod tests;

pub use bound::{AirBound, AirSolver};
pub use choice::AirChoice;
pub use smooth::{SmoothEmissivity, SmoothModes};

use crate::atmosphere::Atmosphere;
use crate::error::{Error, Result, check};
use crate::fisher::Unknowns;
use crate::planck;
use crate::scene::{Jacobian, Parameter, State, Surroundings, check_emissivity, unlit};
use crate::spectrum::Bands;

/// What a spectrum through air depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum AirParameter {
    /// Distance of the target, m.
    Distance,
    /// Temperature, lighting and gain of the scene.
    Scene(Parameter),
    /// Temperature of the air, K.
    AirTemperature,
    /// Size of mode m of the errors of the emissivity, in deviations of its prior.
    Emissivity(usize),
}

/// What is unknown besides the distance.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AirUnknowns {
    /// Of target, surroundings and camera.
    pub scene: Unknowns,
    /// Temperature of the air, with the deviation of its prior, K, where it has one.
    pub air_temperature: Option<Option<f64>>,
    /// Errors of the emissivity; it is known exactly if silent.
    pub emissivity: Option<SmoothEmissivity>,
}

/// Target, surroundings and air, seen in bands. The bands have the weights of the camera and not those of the air.
#[derive(Debug, Clone, Copy)]
pub struct AirScene<'a> {
    /// Bands.
    pub bands: &'a Bands,
    /// Surroundings at their nodes.
    pub surroundings: &'a Surroundings,
    /// Emissivity of the target at their nodes.
    pub emissivity: &'a [f64],
    /// The air.
    pub air: &'a Atmosphere,
}

/// What the scene is doing.
#[derive(Debug, Clone, PartialEq)]
pub struct AirState {
    /// Distance z, m.
    pub distance_m: f64,
    /// Target and surroundings; the gain is that of the camera, of all light.
    pub target: State,
    /// Temperature of the air, K.
    pub air_k: f64,
}

/// Signal of each band and its derivatives, photons s⁻¹ m⁻² sr⁻¹, per unit of each parameter.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct AirSignal {
    /// L integrated over each band.
    pub signal: Vec<f64>,
    /// ∂L/∂θ of each parameter asked for.
    pub columns: Vec<Vec<f64>>,
}

impl AirScene<'_> {
    /// Makes sure that scene and state fit together.
    ///
    /// # Errors
    /// An emissivity that is none, a state that is none, a distance that is not positive or beyond the table, bands that the air does not
    /// cover.
    pub fn check(&self, state: &AirState) -> Result<()> {
        check_emissivity(self.emissivity, self.bands.nodes_cm1().len())?;
        self.surroundings.check(&state.target)?;
        check::positive("temperature of the air", state.air_k, "K")?;
        check::positive("distance", state.distance_m, "m")?;
        self.air.optical_depth(self.bands.nodes_cm1(), state.distance_m).map(drop)
    }

    /// Signal and derivatives of a surface of `emissivity`, which need not be the target's own nor lie in [0, 1].
    ///
    /// # Errors
    /// A distance or bands that the air does not cover; a mode that is not there.
    pub fn evaluate(
        &self,
        emissivity: &[f64],
        state: &AirState,
        parameters: &[AirParameter],
        modes: &[Vec<f64>],
        lighting_total_known: bool,
    ) -> Result<AirSignal> {
        let nodes = self.bands.nodes_cm1();
        let gain = state.target.gain;
        let (depths, growths) = self.air.optical_depth_and_growth(nodes, state.distance_m)?;
        let transmittance: Vec<f64> = depths.iter().map(|depth| (-depth).exp()).collect();
        let seen = self.bands.transmitted_at_nodes(&transmittance);
        let of_scene: Vec<Parameter> = parameters
            .iter()
            .filter_map(|parameter| match parameter {
                AirParameter::Scene(parameter) => Some(*parameter),
                _ => None,
            })
            .collect();
        let mut jacobian = Jacobian::new(&seen, self.surroundings);
        jacobian.evaluate(emissivity, emissivity, &state.target, &of_scene, lighting_total_known);
        let (mut air, mut air_slope) = (vec![0.0; nodes.len()], vec![0.0; nodes.len()]);
        planck::photon_radiance_and_slope_into(nodes, state.air_k, &mut air, &mut air_slope);
        let absorbed = |radiance: &[f64]| -> Vec<f64> {
            radiance
                .iter()
                .zip(&depths)
                .map(|(radiance, depth)| -gain * (-depth).exp_m1() * radiance)
                .collect()
        };
        let path = self.bands.weigh(&absorbed(&air));
        let signal: Vec<f64> = jacobian.signal().iter().zip(&path).map(|(s, path)| s + path).collect();
        let mut scene_column = 0;
        let mut columns = Vec::with_capacity(parameters.len());
        for parameter in parameters {
            columns.push(match parameter {
                AirParameter::Distance => {
                    let beyond = self.beyond_air(emissivity, state, &air);
                    let exchanged: Vec<f64> =
                        beyond.iter().zip(&growths).map(|(beyond, growth)| -gain * growth * beyond).collect();
                    seen.weigh(&exchanged)
                }
                AirParameter::AirTemperature => self.bands.weigh(&absorbed(&air_slope)),
                AirParameter::Scene(parameter) => {
                    let own = jacobian.column(scene_column);
                    scene_column += 1;
                    match parameter {
                        // All light passes the camera, that of the path too.
                        Parameter::Gain => signal.clone(),
                        _ => own.to_vec(),
                    }
                }
                AirParameter::Emissivity(mode) => {
                    let Some(mode) = modes.get(*mode) else {
                        return Err(Error::malformed(
                            "a mode of the emissivity that is not there",
                            "give as many as are asked for",
                        ));
                    };
                    let contrast = seen.weigh(jacobian.contrast());
                    contrast.iter().zip(mode).map(|(contrast, size)| gain * contrast * size).collect()
                }
            });
        }
        Ok(AirSignal { signal, columns })
    }

    /// S/G − B(T_air) at the nodes, of differences of radiances. `air` is B(T_air).
    fn beyond_air(&self, emissivity: &[f64], state: &AirState, air: &[f64]) -> Vec<f64> {
        let nodes = self.bands.nodes_cm1();
        let warmer = |temperature_k: f64| {
            let mut difference = vec![0.0; nodes.len()];
            let by = temperature_k - state.air_k;
            planck::photon_radiance_difference_into(nodes, state.air_k, by, air, &mut difference);
            difference
        };
        let target = &state.target;
        let dark = unlit(&target.lighting);
        let mut lit: Vec<f64> = air.iter().map(|air| -dark * air).collect();
        let objects = self.surroundings.objects().iter().zip(&target.environment_k).zip(&target.lighting);
        for ((object, temperature_k), lighting) in objects {
            let difference = warmer(*temperature_k);
            for (j, lit) in lit.iter_mut().enumerate() {
                let emissivity = object.emissivity.as_ref().map_or(1.0, |emissivity| emissivity[j]);
                *lit += lighting * (emissivity * difference[j] - (1.0 - emissivity) * air[j]);
            }
        }
        let emitted = warmer(target.temperature_k);
        emissivity
            .iter()
            .zip(&emitted)
            .zip(&lit)
            .map(|((e, emitted), lit)| e * emitted + (1.0 - e) * lit)
            .collect()
    }
}
