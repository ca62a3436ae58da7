use super::*;
use crate::render::StreetSpec;
use crate::render::scene::Solid;
use crate::render::shape::Shape;
use crate::render::vector::{UP, cross, unit};

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
            let shares = shares(&factors(&scene, point, normal, None, &mut Room::default()), normal);
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

/// These solids alone, each of a surface of its own.
fn of(shapes: &[Shape]) -> Scene {
    let mut scene = street();
    scene.solids =
        shapes.iter().enumerate().map(|(i, shape)| Solid { shape: *shape, surface: i + 2 }).collect();
    scene
}

/// Two boxes without anything around them.
fn boxes() -> Scene {
    of(&[
        Shape::Cuboid { low: [-1.0, 2.0, 5.0], high: [0.5, 3.0, 6.0] },
        Shape::Cuboid { low: [0.0, 2.5, 7.0], high: [1.0, 5.0, 9.0] },
    ])
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

/// V = ∫∫ hit d(sin²θ) dφ/2π of every surface by rays of a cosine law on a fine grid; its error is of the order of the grid's spacing
/// at the edges.
fn met_by_rays(scene: &Scene, point: Vector, normal: Vector) -> Shares {
    let side = unit(cross(if normal[1].abs() < 0.9 { UP } else { [1.0, 0.0, 0.0] }, normal));
    let up = cross(normal, side);
    let n = 400;
    let mut met = Shares::default();
    for i in 0..n * n {
        let (r2, angle) = ((f64::from(i / n) + 0.5) / f64::from(n), f64::from(i % n) + 0.5);
        let (sin, cos) = (angle * std::f64::consts::TAU / f64::from(n)).sin_cos();
        let direction: Vector = std::array::from_fn(|k| {
            r2.sqrt() * (cos * side[k] + sin * up[k]) + (1.0 - r2).sqrt() * normal[k]
        });
        let all = (1 << scene.solids.len()) - 1;
        met[scene.surface_of(scene.hit(point, direction, all).1)] += 1.0 / f64::from(n * n);
    }
    met
}

#[test]
fn boxes_that_hide_each_other_are_what_rays_meet() {
    let scene = of(&[
        Shape::Cuboid { low: [-1.0, 0.0, 5.0], high: [0.5, 2.0, 6.0] },
        Shape::Cuboid { low: [-2.0, 0.0, 7.0], high: [1.5, 4.0, 9.0] },
        Shape::Cuboid { low: [0.2, 0.0, 3.0], high: [0.7, 0.5, 3.5] },
        // On top of the first one, as a cabin on its body.
        Shape::Cuboid { low: [-0.8, 2.0, 5.0], high: [0.3, 3.0, 6.0] },
    ]);
    for (point, normal) in [
        ([0.2, 1e-6, 1.0], UP),
        ([0.4, 0.0, 2.0], UP),
        ([-3.0, 0.5, 4.0], [0.8, 0.0, 0.6]),
        ([0.0, 1.0, 3.8], [0.0, 0.6, 0.8]),
        ([-1.2, 0.3, 6.5], UP),
    ] {
        let shares = shares(&factors(&scene, point, normal, None, &mut Room::default()), normal);
        for (k, met) in met_by_rays(&scene, point, normal).into_iter().enumerate() {
            assert!((shares[k] - met).abs() < 5e-4 + 4e-3 * met, "{point:?} {k}: {} {met}", shares[k]);
        }
    }
}

#[test]
fn a_box_behind_another_is_a_frame_with_a_closed_form() {
    // Seen from below, a square of 4 m at height 4 m behind one of 1 m at height 2 m, whose shadow on it is 2 m wide.
    let scene = of(&[
        Shape::Cuboid { low: [-2.0, 4.0, -2.0], high: [2.0, 5.0, 2.0] },
        Shape::Cuboid { low: [-0.5, 2.0, -0.5], high: [0.5, 2.1, 0.5] },
    ]);
    // Howell B-3, four corners.
    let square = |half: f64, height: f64| {
        let x = half / height;
        let p = f64::hypot(1.0, x);
        4.0 * (x / p * (x / p).atan()) * 2.0 / (2.0 * std::f64::consts::PI)
    };
    let shares = shares(&factors(&scene, [0.0; 3], UP, None, &mut Room::default()), UP);
    assert!((shares[3] / square(0.5, 2.0) - 1.0).abs() < 1e-12, "{}", shares[3]);
    let frame = square(2.0, 4.0) - square(1.0, 4.0);
    assert!((shares[2] / frame - 1.0).abs() < 1e-12, "{} {frame}", shares[2]);
}

#[test]
fn round_solids_are_what_rays_meet_but_for_their_eight_corners() {
    let ball = Shape::Ellipsoid { centre: [0.3, 1.2, 5.0], semi: [0.4, 0.8, 0.3] };
    let limb = Shape::Capsule { ends: [[-0.5, 0.2, 4.0], [-0.2, 1.6, 4.5]], radius: 0.12 };
    let (near, wall) = (
        Shape::Capsule { ends: [[0.5, 0.1, 3.0], [0.4, 1.1, 3.2]], radius: 0.1 },
        Shape::Cuboid { low: [-2.0, 0.0, 6.0], high: [2.0, 3.0, 6.5] },
    );
    let scene = of(&[ball, limb, near, wall]);
    for (point, normal) in
        [([0.0, 0.0, 2.0], UP), ([0.2, 1.0, 0.5], [0.0, 0.0, 1.0]), ([1.5, 0.4, 4.0], [-0.8, 0.6, 0.0])]
    {
        let shares = shares(&factors(&scene, point, normal, None, &mut Room::default()), normal);
        for (k, met) in met_by_rays(&scene, point, normal).into_iter().enumerate() {
            assert!((shares[k] - met).abs() < 5e-4 + 0.02 * met, "{point:?} {k}: {} {met}", shares[k]);
        }
    }
    // A ball alone, before a surface that faces it: sin² of its half angle.
    let alone = of(&[Shape::Ellipsoid { centre: [0.0, 3.0, 0.0], semi: [1.0; 3] }]);
    let share = shares(&factors(&alone, [0.0; 3], UP, None, &mut Room::default()), UP)[2];
    assert!((share * 9.0 - 1.0).abs() < 2e-3, "{share}");
}

#[test]
fn everywhere_in_the_street_the_light_is_what_rays_meet() {
    let scene = street();
    for i in 0..8 {
        let at = |step: f64, low: f64, high: f64| low + (high - low) * (f64::from(i) * step).fract();
        let point = [at(0.618, -3.0, 3.0), 0.0, at(0.414, 5.0, 17.0)];
        if scene.buried(point, UP) {
            continue;
        }
        let shares = shares(&factors(&scene, point, UP, None, &mut Room::default()), UP);
        for (k, met) in met_by_rays(&scene, [point[0], 1e-9, point[2]], UP).into_iter().enumerate() {
            assert!((shares[k] - met).abs() < 1e-3 + 0.02 * met, "{point:?} {k}: {} {met}", shares[k]);
        }
    }
}

#[test]
fn outlines_are_none_from_inside_and_whole_from_close_by() {
    for shape in [
        Shape::Cuboid { low: [-1.0, 8.0, -1.0], high: [1.0, 10.0, 1.0] },
        Shape::Ellipsoid { centre: [0.0, 9.0, 0.0], semi: [1.0; 3] },
        Shape::Capsule { ends: [[0.0, 7.0, 0.0], [0.0, 11.0, 0.0]], radius: 1.0 },
    ] {
        assert!(shape.outline([0.1, 9.2, 0.3]).is_none() && shape.outline([1.0, 9.0, 0.0]).is_none());
        let near = [1.05, 9.0, 0.0];
        let normal = [-1.0, 0.0, 0.0];
        let met = met_by_rays(&of(&[shape]), near, normal)[2];
        let factor = shape.outline(near).unwrap().factor();
        assert!((dot(factor, normal) / met - 1.0).abs() < 0.03, "{shape:?} {factor:?} {met}");
    }
}
