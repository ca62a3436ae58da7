//! Analytic derivatives of the heat signal against dual numbers of an independent formula.

use crate::support::scenes::{Inputs, Scene, recipe};
use hadar::scene::{Jacobian, Parameter};
use hadar_testing::seeded;
use num_dual::{Dual64, DualNum};
use proptest::prelude::*;

/// Every kind of parameter, with the total of the lighting known or not.
fn parameters(objects: usize, total_known: bool) -> Vec<Parameter> {
    let mut all = vec![Parameter::Material, Parameter::Temperature, Parameter::Gain];
    all.extend((0..if total_known { objects - 1 } else { objects }).map(Parameter::Lighting));
    all.extend((0..objects).map(Parameter::EnvironmentTemperature));
    all
}

/// ∂S/∂θ in every band by dual numbers. The gain's derivative is with respect to ln G.
fn by_dual_numbers(scene: &Scene, parameter: Parameter, total_known: bool) -> Vec<f64> {
    let mut inputs = Inputs::<Dual64>::of(&scene.state);
    let mut total = Dual64::from(0.0);
    inputs.lighting.iter().for_each(|v| total += *v);
    match parameter {
        Parameter::Material => inputs.mixing = inputs.mixing.derivative(),
        Parameter::Temperature => inputs.temperature_k = inputs.temperature_k.derivative(),
        Parameter::Gain => inputs.gain = inputs.gain.ln().derivative().exp(),
        Parameter::Lighting(k) => {
            inputs.lighting[k] = inputs.lighting[k].derivative();
            if total_known {
                let last = inputs.lighting.len() - 1;
                let others = inputs.lighting[..last].iter().fold(Dual64::from(0.0), |sum, v| sum + *v);
                inputs.lighting[last] = total - others;
            }
        }
        Parameter::EnvironmentTemperature(k) => {
            inputs.environment_k[k] = inputs.environment_k[k].derivative();
        }
    }
    let slopes: Vec<f64> = scene.signal(&inputs).iter().map(|value| value.eps).collect();
    scene.bands.weigh(&slopes)
}

proptest! {
    #![proptest_config(seeded(20, 100))]

    /// 1e-12 of the column's norm. Both sides round a few times (1e-16 each); only the contrast B(T) − ΣVB(Tₖ) cancels,
    /// and the dual numbers, unlike the crate, subtract plainly: what that loses is added.
    #[test]
    fn derivatives_equal_those_of_dual_numbers(recipe in recipe(), gain in 0.5..2.0, total_known: bool) {
        let mut scene = recipe.scene();
        scene.state.gain = gain;
        let objects = scene.state.lighting.len();
        let parameters = parameters(objects, total_known);
        let mut jacobian = Jacobian::new(&scene.bands, &scene.surroundings);
        jacobian.evaluate(&scene.emissivity, &scene.alternative, &scene.state, &parameters, total_known);
        let signal: Vec<f64> = scene.signal(&Inputs::<f64>::of(&scene.state));
        for (value, exact) in jacobian.signal().iter().zip(scene.bands.weigh(&signal)) {
            prop_assert!((value / exact - 1.0).abs() < 1e-13, "signal {value:e} {exact:e}");
        }
        let norm = |values: &[f64]| values.iter().map(|v| v * v).sum::<f64>().sqrt();
        for (i, &parameter) in parameters.iter().enumerate() {
            let dual = by_dual_numbers(&scene, parameter, total_known);
            let error: Vec<f64> = jacobian.column(i).iter().zip(&dual).map(|(a, b)| a - b).collect();
            let lost = match parameter {
                Parameter::Material | Parameter::Lighting(_) => 1e-15 * norm(jacobian.signal()) * objects as f64,
                _ => 0.0,
            };
            let tolerance = 1e-12 * norm(&dual) + lost;
            prop_assert!(norm(&error) <= tolerance, "{parameter:?}: {:e} of {:e}", norm(&error), norm(&dual));
        }
    }
}
