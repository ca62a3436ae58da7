use super::*;
use crate::render::StreetSpec;
use crate::render::vector::{UP, norm};

fn street() -> Scene {
    Scene::street(&StreetSpec::default()).unwrap()
}

#[test]
fn factors_add_up_to_one_everywhere() {
    let scene = street();
    let normals = [UP, [0.0, -1.0, 0.0], [0.6, 0.0, -0.8], [0.0, 0.6, 0.8], [-0.48, 0.6, -0.64]];
    for i in 0..200 {
        let point = [f64::from(i % 10) - 4.5, f64::from(i % 3) * 0.7, f64::from(i) * 0.12];
        for normal in normals {
            let shares = shares(&factors(&scene, point, normal, None), normal);
            assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-14, "{point:?} {normal:?} {shares:?}");
            assert!(shares.iter().all(|&v| v >= 0.0));
        }
    }
    for (k, shares) in mean_shares(&scene, 4).iter().enumerate().skip(1) {
        assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-12, "{k}: {shares:?}");
    }
}

#[test]
fn without_solids_the_hemisphere_is_split_by_the_normal_alone() {
    let [sky, ground, ..] = shares(&Factors::default(), [0.0, 0.28, 0.96]);
    assert!((sky - 0.64).abs() < 1e-15 && (ground - 0.36).abs() < 1e-15);
}

/// Two boxes without anything around them, each of a surface of its own.
fn boxes() -> Scene {
    let mut scene = street();
    scene.solids.clear();
    scene.lights.clear();
    for (surface, low, high) in
        [(2, [-1.0, 2.0, 5.0], [0.5, 3.0, 6.0]), (3, [0.0, 2.5, 7.0], [1.0, 5.0, 9.0])]
    {
        let shape = crate::render::shape::Shape::Cuboid { low, high };
        let light = scene.lights.len();
        scene.solids.push(crate::render::scene::Solid { shape, surface, light });
        scene.lights.push(crate::render::scene::Light { surface, form: Form::Cuboid { low, high } });
    }
    scene
}

#[test]
fn factors_between_boxes_are_reciprocal() {
    // A₂ V₂₃ = A₃ V₃₂, each a midpoint rule over the one of the exact factor of the other.
    let scene = boxes();
    let mean = mean_shares(&scene, 24);
    let area = |i: usize| scene.solids[i].shape.patches(1).iter().map(|p| p.area_m2).sum::<f64>();
    let (there, back) = (area(0) * mean[2][3], area(1) * mean[3][2]);
    assert!((there / back - 1.0).abs() < 2e-4, "{there} {back}");
    assert!(there > 0.01 * area(0));
}

#[test]
fn a_box_is_what_rays_of_a_cosine_law_meet() {
    // V = ∫∫ hit d(sin²θ) dφ/2π on a fine grid; the grid's error is of the order of its spacing at the edges.
    let scene = boxes();
    let point = [0.2, 1.0, 4.0];
    let n = 1000;
    let mut met = [0.0; 2];
    for i in 0..n * n {
        let (r2, angle) = ((f64::from(i / n) + 0.5) / f64::from(n), f64::from(i % n) + 0.5);
        let (sin, cos) = (angle * std::f64::consts::TAU / f64::from(n)).sin_cos();
        let direction = [r2.sqrt() * cos, (1.0 - r2).sqrt(), r2.sqrt() * sin];
        for (met, solid) in met.iter_mut().zip(&scene.solids) {
            *met += f64::from(u8::from(solid.shape.hit(point, direction).is_some())) / f64::from(n * n);
        }
    }
    let shares = shares(&factors(&scene, point, UP, None), UP);
    for (k, met) in [2, 3].into_iter().zip(met) {
        assert!((shares[k] / met - 1.0).abs() < 3e-3, "{k}: {} {met}", shares[k]);
    }
}

#[test]
fn a_person_far_away_is_a_small_source_of_its_silhouette() {
    let mut scene = street();
    scene.lights.retain(|light| light.surface == 4);
    let Form::Screen { half_width_m, height_m, .. } = scene.lights[0].form else { panic!("not a screen") };
    let silhouette = 2.0 * half_width_m * height_m;
    assert!((0.5..0.9).contains(&silhouette), "{silhouette}");
    // A wall element 40 m away that faces it: V → A/(π d²), next order (height/d)².
    let point = [-0.9, 0.5 * height_m, 48.0];
    let factors = factors(&scene, point, [0.0, 0.0, -1.0], None);
    let share = shares(&factors, [0.0, 0.0, -1.0])[4];
    let small = silhouette / (std::f64::consts::PI * 40.0 * 40.0);
    assert!((share / small - 1.0).abs() < 2e-3, "{share} {small}");
    // Half of it covers ground, half sky; straight below its middle there is nothing to tell.
    assert!((norm(factors[4].above) / norm(factors[4].below) - 1.0).abs() < 1e-9);
    let foot = [-0.9, 0.0, 8.0];
    assert_eq!(super::factors(&scene, foot, UP, None)[4], Factor::default());
}
