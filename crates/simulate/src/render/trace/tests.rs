use super::*;
use crate::render::{Emissivity, Part, StreetSpec, WallSpec, Wave};
use hadar::planck::photon_radiance;

const NU: f64 = 769.0;

fn bands() -> Bands {
    Bands::from_rows([(NU, 1.0)]).unwrap()
}

fn small() -> Rig {
    Rig { rows: 60, columns: 80, pixel_m: 96e-6, ..Rig::default() }
}

fn quick() -> Options {
    Options { samples: 2, ..Options::default() }
}

fn drawn(scene: &Scene, rig: &Rig, options: &Options) -> StereoPair {
    scene.render(rig, &bands(), options, &|_, _| ()).unwrap()
}

fn samples(view: &View, part: Part) -> Vec<f64> {
    view.cube(part, 1.0).unwrap().samples().to_vec()
}

/// Everything at one temperature.
fn equilibrium(kelvin: f64) -> StreetSpec {
    StreetSpec {
        sky_k: kelvin,
        ground_k: kelvin,
        car_k: kelvin,
        tyre_k: kelvin,
        person_k: kelvin,
        ..StreetSpec::default()
    }
}

#[test]
fn in_equilibrium_there_is_no_texture_at_all() {
    let scene = Scene::street(&equilibrium(293.15)).unwrap();
    let blackbody = photon_radiance(NU, 293.15);
    let scattered_texture = |bounces| {
        let pair = drawn(&scene, &small(), &Options { bounces, ..quick() });
        let worst =
            samples(&pair.left, Part::Total).iter().map(|s| (s / blackbody - 1.0).abs()).fold(0.0, f64::max);
        let ground = samples(&pair.left, Part::Scattered).into_iter().zip(&pair.left.surface);
        let (low, high) = ground
            .filter(|(_, surface)| **surface == 1)
            .fold((f64::INFINITY, 0.0_f64), |(low, high), (s, _)| (low.min(s), high.max(s)));
        let spread = (high - low) / blackbody;
        (worst, spread)
    };
    // What is missing after b scatterings is at the most (1 − 0.8)^b.
    let mut last = f64::INFINITY;
    for bounces in [0, 1, 2, 4, 8, 30] {
        let (worst, _) = scattered_texture(bounces);
        assert!(worst <= 0.2_f64.powi(bounces as i32) + 1e-14, "{bounces}: {worst}");
        assert!(worst <= last + 1e-14);
        last = worst;
    }
    assert!(last < 1e-14, "{last}");
    let (_, spread) = scattered_texture(8);
    assert!(spread > 0.05, "the scattered signal must have texture: {spread}");
}

#[test]
fn black_surfaces_scatter_nothing_and_zero_bounces_are_emission() {
    let one = || Emissivity::Constant(1.0);
    let black = StreetSpec {
        ground_emissivity: [one(), one()],
        car_emissivity: one(),
        tyre_emissivity: one(),
        person_emissivity: one(),
        ..StreetSpec::default()
    };
    let pair = drawn(&Scene::street(&black).unwrap(), &small(), &quick());
    assert!(samples(&pair.right, Part::Scattered).iter().all(|&s| s == 0.0));
    let scene = Scene::street(&StreetSpec::default()).unwrap();
    let pair = drawn(&scene, &small(), &Options { bounces: 0, ..quick() });
    assert!(samples(&pair.right, Part::Scattered).iter().all(|&s| s == 0.0));
    assert_eq!(samples(&pair.right, Part::Total), samples(&pair.right, Part::Emission));
}

#[test]
fn a_pixel_is_the_heat_signal_equation_of_its_surface() {
    // One ray per pixel: the pixel's maps tell all there is to know about it.
    let spec = StreetSpec { car_k: 320.0, sky_k: 260.0, ..StreetSpec::default() };
    let scene = Scene::street(&spec).unwrap();
    let options = Options { bounces: 1, samples: 1, ..Options::default() };
    let view = drawn(&scene, &small(), &options).left;
    let (total, emission) = (samples(&view, Part::Total), samples(&view, Part::Emission));
    let temperatures = [260.0, 293.15, 320.0, 298.15, 310.15];
    // Lit by what the others emit; of the ground, at its mean texture.
    let means = [1.0, 0.8 + 0.2 * scene.surfaces[1].texture.mean(), 0.9, 0.95, 0.95];
    let mut met = [0; 5];
    for (i, &surface) in view.surface.iter().enumerate() {
        let surface = usize::from(surface);
        let e = [1.0, 0.8 + 0.2 * view.texture[i], 0.9, 0.95, 0.95][surface];
        let emitted = e * photon_radiance(NU, temperatures[surface]);
        let light: f64 =
            (0..5).map(|k| view.lighting[5 * i + k] * means[k] * photon_radiance(NU, temperatures[k])).sum();
        assert!((emission[i] / emitted - 1.0).abs() < 1e-12);
        assert!((total[i] / (emitted + (1.0 - e) * light) - 1.0).abs() < 1e-12);
        assert_eq!(view.temperature_k[i], temperatures[surface]);
        met[surface] += 1;
    }
    assert!(met.iter().all(|&n| n > 5), "{met:?}");
}

#[test]
fn a_wave_on_a_wall_is_drawn_as_its_closed_form_and_shifted_exactly() {
    let rig = Rig { pitch_rad: 0.0, ..small() };
    let (a, b, distance_m) = (0.13, 0.07, 9.3);
    let wave = Wave {
        cycles_per_m: [rig.cycles_per_m(distance_m, a), rig.cycles_per_m(distance_m, b)],
        amplitude: 0.3,
        phase_rad: 0.4,
    };
    let spec = WallSpec { distance_m, waves: vec![wave], wall_k: 300.0, ..WallSpec::default() };
    let pair = drawn(&Scene::wall(&spec).unwrap(), &rig, &Options { samples: 3, ..Options::default() });
    let kept = |f: f64| {
        let f = std::f64::consts::PI * f;
        f.sin() / (3.0 * (f / 3.0).sin())
    };
    let disparity = rig.disparity_px(distance_m);
    for (view, side) in [(&pair.left, 0.5), (&pair.right, -0.5)] {
        let emission = samples(view, Part::Emission);
        for row in [0, 31, 59] {
            for column in [0, 17, 79] {
                let x = column as f64 - 39.5 - side * disparity;
                let y = 29.5 - row as f64 + rig.height_m * rig.focal_px() / distance_m;
                let cycles = std::f64::consts::TAU * (a * x + b * y);
                let tau = 0.5 + 0.3 * kept(a) * kept(b) * (cycles + 0.4).cos();
                let exact = (0.8 + 0.2 * tau) * photon_radiance(NU, 300.0);
                assert!((emission[row * 80 + column] / exact - 1.0).abs() < 1e-12);
            }
        }
        assert!(view.depth_m.iter().all(|z| (z / distance_m - 1.0).abs() < 1e-14));
    }
}

#[test]
fn the_truth_maps_of_both_views_agree() {
    let rig = Rig { rows: 120, columns: 160, pixel_m: 48e-6, ..Rig::default() };
    let scene = Scene::street(&StreetSpec::default()).unwrap();
    let pair = drawn(&scene, &rig, &quick());
    let (left, right) = (&pair.left, &pair.right);
    let (mut compared, mut hidden) = (0, 0);
    for row in 0..rig.rows {
        for column in 0..rig.columns {
            let i = row * rig.columns + column;
            let d = left.disparity_px[i];
            assert!(d == rig.disparity_px(left.depth_m[i]));
            let there = (column as f64 - d).round();
            if !left.seen_by_other[i] || there < 0.0 {
                hidden += 1;
                continue;
            }
            let j = row * rig.columns + there as usize;
            // The ground has one depth along a row: to rounding, the same in both.
            if left.surface[i] == 1 && right.surface[j] == 1 {
                assert!((left.depth_m[i] / right.depth_m[j] - 1.0).abs() < 1e-12);
                compared += 1;
            }
        }
    }
    assert!(compared > 10_000 && hidden > 100, "{compared} {hidden}");
    // Where the right camera has the person, it does not see what the left one sees behind.
    let mut hidden = 0;
    for i in (0..left.surface.len()).filter(|&i| left.surface[i] != 4) {
        let (row, there) = (i / rig.columns, (i % rig.columns) as f64 - left.disparity_px[i]);
        if there < 1.0 {
            continue;
        }
        let at = row * rig.columns + there.round() as usize;
        if right.surface[at - 1..=at + 1] == [4; 3] && left.disparity_px[i] < right.disparity_px[at] - 0.1 {
            assert!(!left.seen_by_other[i], "pixel {i}");
            hidden += 1;
        }
    }
    assert!(hidden > 100, "{hidden}");
}

#[test]
fn feet_and_wheels_stand_on_the_ground() {
    let scene = Scene::street(&StreetSpec::default()).unwrap();
    for surface in [3, 4] {
        let lowest = scene
            .solids
            .iter()
            .filter(|solid| solid.surface == surface)
            .map(|solid| solid.shape.bounds()[0][1])
            .fold(f64::INFINITY, f64::min);
        assert!(lowest.abs() < 1e-12, "{surface}: {lowest}");
    }
    let highest = scene.solids.iter().filter(|s| s.surface == 4).map(|s| s.shape.bounds()[1][1]);
    assert!((highest.fold(0.0, f64::max) - 1.75).abs() < 1e-9);
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let scene = Scene::street(&StreetSpec::default()).unwrap();
    let all = || {
        let pair = drawn(&scene, &small(), &quick());
        [samples(&pair.left, Part::Total), samples(&pair.right, Part::Scattered), pair.left.lighting.clone()]
    };
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(all);
    let three = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap().install(all);
    assert_eq!(alone, three);
}

#[test]
fn progress_ends_with_all_rows() {
    let told = AtomicUsize::new(0);
    let scene = Scene::street(&StreetSpec::default()).unwrap();
    let progress = |done: usize, of: usize| {
        assert!(done <= of && of == 120);
        told.fetch_max(done, Ordering::Relaxed);
    };
    scene.render(&small(), &bands(), &quick(), &progress).unwrap();
    assert_eq!(told.load(Ordering::Relaxed), 120);
}

#[test]
fn impossible_pictures_are_errors() {
    let street = |spec: StreetSpec| {
        Scene::street(&spec).and_then(|scene| scene.render(&small(), &bands(), &quick(), &|_, _| ()))
    };
    let spec = StreetSpec::default;
    for bad in [
        StreetSpec { sky_k: 0.0, ..spec() },
        StreetSpec { car_k: f64::NAN, ..spec() },
        StreetSpec { car_emissivity: Emissivity::Constant(-0.1), ..spec() },
        StreetSpec { car_emissivity: Emissivity::Spectrum(vec![0.9; 2]), ..spec() },
        StreetSpec { car_at_m: [0.0, 0.0], ..spec() },
        StreetSpec { car_at_m: [f64::INFINITY, 3.0], ..spec() },
        StreetSpec { car_size_m: [4.0, 0.0, 1.0], ..spec() },
        StreetSpec { person_at_m: [0.0, -1.0], ..spec() },
        StreetSpec { person_height_m: 0.0, ..spec() },
        // A very big person stands where the camera is.
        StreetSpec { person_at_m: [0.75, 0.3], person_height_m: 12.0, ..spec() },
    ] {
        assert!(street(bad.clone()).is_err(), "{bad:?}");
    }
    assert!(street(spec()).is_ok());
    assert!(Scene::wall(&WallSpec { distance_m: 0.0, ..WallSpec::default() }).is_err());
    let scene = Scene::street(&spec()).unwrap();
    for options in [
        Options { samples: 0, ..quick() },
        Options { bounces: usize::MAX, ..quick() },
        Options { finest_px: f64::NAN, ..quick() },
    ] {
        assert!(scene.render(&small(), &bands(), &options, &|_, _| ()).is_err());
    }
    let pair = drawn(&scene, &small(), &quick());
    for factor in [0.0, -1.0, f64::NAN, f64::MAX] {
        assert!(pair.left.cube(Part::Total, factor).is_err());
    }
}
