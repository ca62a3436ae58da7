//! Rows of a map against points computed one by one.

use super::*;
use crate::fisher::Nuisance::{EnvironmentTemperature, Gain, Lighting, Temperature};
use crate::identifiability::local::LocalSolver;
use crate::scene::EnvironmentObject;
use proptest::prelude::*;

/// Largest error in units of 1e-14·none/d, or of what the solver says of its own result where that is more: nuisances that
/// are nearly dependent leave fewer digits in both.
fn worst(scene: &MapScene<'_>, temperatures_k: &[f64], lightings: &[f64]) -> f64 {
    let points = scene.local(temperatures_k, lightings).unwrap();
    let mut solver = LocalSolver::new(scene.bands, scene.surroundings, scene.unknowns.clone());
    let mut worst: f64 = 0.0;
    for (row, &temperature_k) in points.chunks(lightings.len()).zip(temperatures_k) {
        for (point, &lighting) in row.iter().zip(lightings) {
            let state = scene.at(temperature_k, lighting);
            let local =
                solver.per_photon(scene.emissivity, scene.alternative, &state, f64::INFINITY).unwrap();
            assert!((point.photon_radiance / local.photon_radiance - 1.0).abs() < 2e-15);
            assert_eq!(point.distance == 0.0, local.distance == 0.0, "{temperature_k} K, V = {lighting}");
            if local.distance > 0.0 {
                let allowed = 1e-14 * local.distance_no_nuisance / local.distance;
                let error = (point.distance / local.distance - 1.0).abs();
                worst = worst.max(error / allowed.max(local.relative_error));
            }
        }
    }
    worst
}

fn materials(bands: &Bands) -> Vec<Vec<f64>> {
    let place = |nu: f64| (nu - 985.0) / 265.0;
    let of = |e: &dyn Fn(f64) -> f64| bands.nodes_cm1().iter().map(|&nu| e(nu)).collect();
    vec![
        vec![0.95; bands.len()],
        vec![0.05; bands.len()],
        of(&|nu| 0.49287 - 0.0782 * place(nu) + 0.00892 * place(nu).powi(2)),
        of(&|nu| 0.5 + 0.45 * (nu / 37.0).sin()),
        of(&|nu| 0.95 + 1e-9 * place(nu).sin()),
    ]
}

#[test]
fn rows_agree_with_points_one_by_one() {
    let bands = Bands::uniform(715.0, 1250.0, 5.0).unwrap();
    let materials = materials(&bands);
    let black = || EnvironmentObject { temperature_k: 293.15, emissivity: None };
    let grey = EnvironmentObject { temperature_k: 250.0, emissivity: Some(materials[3].clone()) };
    let one = Surroundings::new(bands.nodes_cm1(), vec![black()]).unwrap();
    let two = Surroundings::new(bands.nodes_cm1(), vec![black(), grey]).unwrap();
    // In equilibrium, nearly so on both sides, and far from it.
    let temperatures_k = [200.0, 290.0, 293.149_999, 293.15, 293.15 + 1e-9, 293.16, 320.0, 1000.0];
    let mut lightings: Vec<f64> = (0..=60).map(|i| f64::from(i) / 60.0).collect();
    lightings.extend([1e-9, 1.0 - 1e-9, 0.5, 1.0 - f64::EPSILON]);
    for (surroundings, lighting) in [(&one, &[0.5][..]), (&two, &[0.5, 0.0])] {
        let state = surroundings.state(300.0, lighting).unwrap();
        for set in [
            &[][..],
            &[Temperature],
            &[Temperature, Lighting],
            &[Temperature, Gain],
            &[Temperature, Lighting, Gain],
            &[Temperature, Lighting, EnvironmentTemperature],
        ] {
            let unknowns = Unknowns::new(set.iter().copied()).unwrap();
            for (i, emissivity) in materials.iter().enumerate() {
                for alternative in materials.iter().skip(i % 2).step_by(2) {
                    let scene = MapScene {
                        bands: &bands,
                        surroundings,
                        unknowns: &unknowns,
                        emissivity,
                        alternative,
                        state: &state,
                    };
                    let worst = worst(&scene, &temperatures_k, &lightings);
                    assert!(worst <= 1.0, "{set:?}: {worst} of the tolerance");
                }
            }
        }
    }
}

#[test]
fn a_row_without_photons_is_refused_like_a_point() {
    let bands = Bands::uniform(4000.0, 4100.0, 5.0).unwrap();
    let object = EnvironmentObject { temperature_k: 1.0, emissivity: None };
    let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object]).unwrap();
    let state = surroundings.state(1.0, &[0.5]).unwrap();
    let (unknowns, grey, black) = (Unknowns::default(), vec![0.5; bands.len()], vec![1.0; bands.len()]);
    let scene = MapScene {
        bands: &bands,
        surroundings: &surroundings,
        unknowns: &unknowns,
        emissivity: &grey,
        alternative: &black,
        state: &state,
    };
    let lightings: Vec<f64> = (0..40).map(|i| f64::from(i) / 40.0).collect();
    assert!(scene.local(&[1.0], &lightings).is_err());
}

proptest! {
    /// Any emissivities, smooth or not, any order and range of lighting factors.
    #[test]
    fn any_row_agrees_with_its_points(
        emissivities in proptest::collection::vec((0.01..1.0_f64, 0.01..1.0_f64), 23),
        temperature_k in 30.0..3000.0_f64,
        surroundings_k in 30.0..3000.0_f64,
        lightings in proptest::collection::vec(0.0..1.0_f64, 12..70),
        narrow in 1e-6..1.0_f64,
        known in 0..4_usize,
    ) {
        let (emissivity, alternative): (Vec<f64>, Vec<f64>) = emissivities.into_iter().unzip();
        let bands = Bands::uniform(700.0, 1140.0, 20.0).unwrap();
        prop_assert_eq!(bands.len(), emissivity.len());
        let object = EnvironmentObject { temperature_k: surroundings_k, emissivity: None };
        let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object]).unwrap();
        let state = surroundings.state(300.0, &[0.5]).unwrap();
        let unknowns = Unknowns::new([Temperature, Lighting, Gain].into_iter().take(known)).unwrap();
        let scene = MapScene {
            bands: &bands,
            surroundings: &surroundings,
            unknowns: &unknowns,
            emissivity: &emissivity,
            alternative: &alternative,
            state: &state,
        };
        let lightings: Vec<f64> = lightings.iter().map(|v| 1.0 - narrow * v).collect();
        let worst = worst(&scene, &[temperature_k], &lightings);
        prop_assert!(worst <= 1.0, "{worst} of the tolerance");
    }
}
