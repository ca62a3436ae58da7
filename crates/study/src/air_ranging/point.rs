//! Bounds at one distance, what each band tells there, and the few best bands.

use super::results::{AirBand, AirBest, AirPoint, AirSight, BlindChange};
use super::{AirRangingStudy, Solvers};
use hadar::error::{Error, Result};
use hadar::fisher::precision::Sight;
use hadar::ranging::air::{AirBound, AirParameter, AirSolver};
use hadar::scene::Parameter;

impl AirRangingStudy {
    pub(super) fn point(&self, solvers: &Solvers<'_>, distance_m: f64) -> Result<AirPoint> {
        let state = self.state(distance_m);
        let counting = self.counting(&state)?;
        let bound = solvers.asked.bound(&state, &counting)?;
        let of = |solver: &Option<AirSolver<'_>>| -> Result<Option<f64>> {
            let found = solver.as_ref().map(|solver| solver.bound(&state, &counting)).transpose()?;
            Ok(found.and_then(|bound| finite(bound.sigma_m)))
        };
        let sigma_m = finite(bound.sigma_m);
        let (sigma_window_m, sigma_stereo_m) = match &self.scenario.stereo {
            Some(spec) => (
                sigma_m.map(|sigma| sigma / ((spec.window[0] * spec.window[1]) as f64).sqrt()),
                finite(self.stereo_sigma_m(spec, &state, &counting)?),
            ),
            None => (None, None),
        };
        let scene = self.scene()?;
        let signal = scene.evaluate(scene.emissivity, &state, &[], &[], false)?.signal;
        let without_sky = match &solvers.without_sky {
            Some(solver) => self.without_sky(solver, &state, &counting)?,
            None => None,
        };
        Ok(AirPoint {
            distance_m,
            sigma_m,
            relative_sigma: sigma_m.map(|sigma| sigma / distance_m),
            sigma_emissivity_known_m: of(&solvers.emissivity_known)?,
            sigma_lighting_known_m: of(&solvers.lighting_known)?,
            sigma_others_known_m: finite(bound.sigma_others_known_m),
            bias_without_sky_m: without_sky.map(|(bias, _)| bias),
            without_sky_at_edge: without_sky.is_some_and(|(_, at_edge)| at_edge),
            sigma_window_m,
            sigma_stereo_m,
            counts: counting.counts_per_radiance * signal.iter().sum::<f64>(),
        })
    }

    pub(super) fn sight(&self, solver: &AirSolver<'_>, distance_m: f64) -> Result<AirSight> {
        let state = self.state(distance_m);
        let bound = solver.bound(&state, &self.counting(&state)?)?;
        let modes = |parameter: &&AirParameter| matches!(parameter, AirParameter::Emissivity(_));
        let total = bound.information_per_m2.iter().sum::<f64>() + bound.information_of_priors_per_m2;
        Ok(AirSight {
            status: bound.sight,
            blind_direction: blind(&bound),
            without_effect: bound.dropped.iter().map(|parameter| name(*parameter)).collect(),
            unknown: named(&bound.unknowns),
            emissivity_modes: bound.unknowns.iter().filter(modes).count(),
            relative_error: bound.relative_error,
            condition_number: bound.condition_number,
            share_of_priors: if total > 0.0 { bound.information_of_priors_per_m2 / total } else { 0.0 },
        })
    }

    pub(super) fn band_information(&self, solver: &AirSolver<'_>, distance_m: f64) -> Result<Vec<AirBand>> {
        let (scene, state) = (self.scene()?, self.state(distance_m));
        let counting = self.counting(&state)?;
        let bound = solver.bound(&state, &counting)?;
        let nodes = self.bands.nodes_cm1();
        let tau = scene.air.transmittance(nodes, distance_m)?;
        let path = self.bands.weigh(&scene.air.path_radiance(nodes, distance_m, state.air_k)?);
        let widths = self.bands.widths_cm1();
        let tau: Vec<f64> =
            self.bands.weigh(&tau).iter().zip(&widths).map(|(seen, width)| seen / width).collect();
        let seen = scene.evaluate(scene.emissivity, &state, &[AirParameter::Distance], &[], false)?;
        let kappa = counting.counts_per_radiance;
        let one = |w: usize| {
            let counts = kappa * seen.signal[w];
            let change = kappa * seen.columns[0][w];
            AirBand {
                center_cm1: self.bands.bands()[w].center_cm1,
                transmittance: tau[w],
                counts,
                share_of_path: path[w] / seen.signal[w],
                information_per_m2: bound.information_per_m2[w],
                information_others_known_per_m2: change * change / (counts + counting.var_added(w)),
            }
        };
        Ok((0..self.bands.len()).map(one).collect())
    }

    pub(super) fn best_bands(
        &self,
        solver: &AirSolver<'_>,
        distance_m: f64,
        count: usize,
    ) -> Result<AirBest> {
        let state = self.state(distance_m);
        let found =
            solver.best_bands(&state, &self.counting(&state)?, count).map_err(|error| match error {
                Error::OutOfRange { .. } => error.for_key("--bands"),
                error => error,
            })?;
        let bands = self.bands.bands();
        Ok(AirBest {
            count,
            centers_cm1: found.bands.iter().filter_map(|&w| Some(bands.get(w)?.center_cm1)).collect(),
            sigma_m: finite(found.sigma_m),
            sigma_proved_m: finite(found.sigma_least_m),
            sigma_all_bands_m: finite(found.sigma_all_bands_m),
            exact: found.exact,
        })
    }
}

pub(super) fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

fn blind(bound: &AirBound) -> Vec<BlindChange> {
    if bound.sight != Sight::Imitated {
        return Vec::new();
    }
    let change = |(parameter, change_per_m): &(AirParameter, f64)| BlindChange {
        unknown: name(*parameter),
        change_per_m: *change_per_m,
    };
    bound.blind_direction.iter().map(change).collect()
}

/// Names of unknowns, those of one kind as one.
fn named(parameters: &[AirParameter]) -> Vec<String> {
    let mut names: Vec<String> = parameters
        .iter()
        .map(|parameter| match parameter {
            AirParameter::Emissivity(_) => "emissivity".into(),
            AirParameter::Scene(Parameter::Lighting(_)) => "lighting".into(),
            AirParameter::Scene(Parameter::EnvironmentTemperature(_)) => {
                "temperature of the surroundings".into()
            }
            other => name(*other),
        })
        .collect();
    names.dedup();
    names
}

fn name(parameter: AirParameter) -> String {
    match parameter {
        AirParameter::Distance => "distance".into(),
        AirParameter::Scene(Parameter::Temperature) => "temperature".into(),
        AirParameter::Scene(Parameter::Lighting(k)) => format!("lighting of environment[{k}]"),
        AirParameter::Scene(Parameter::EnvironmentTemperature(k)) => {
            format!("temperature of environment[{k}]")
        }
        AirParameter::Scene(Parameter::Gain) => "gain".into(),
        AirParameter::Scene(Parameter::Material) => "material".into(),
        AirParameter::AirTemperature => "temperature of the air".into(),
        AirParameter::Emissivity(mode) => format!("emissivity, mode {mode}"),
    }
}
