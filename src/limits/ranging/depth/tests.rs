use super::*;

fn stereo() -> StereoGeometry {
    StereoGeometry::new(0.2, 0.014, 12e-6).unwrap()
}

fn close(a: f64, b: f64, tolerance: f64) {
    assert!((a / b - 1.0).abs() < tolerance, "{a} {b}");
}

#[test]
fn disparity_and_depth_are_each_others_inverse() {
    for z in [0.3, 7.0, 30.0, 1e4] {
        close(stereo().depth_m(stereo().disparity_px(z).unwrap()).unwrap(), z, 1e-15);
        // δz from the difference of two depths.
        let d = stereo().disparity_px(z).unwrap();
        let step = stereo().depth_m(d * (1.0 - 1e-6)).unwrap() - stereo().depth_m(d * (1.0 + 1e-6)).unwrap();
        close(stereo().depth_error_m(z, d * 2e-6).unwrap(), step, 1e-9);
    }
}

/// S43 as it is written, in metres.
#[test]
fn the_bound_is_that_of_the_paper() {
    let (j, n, v, z, pitch, var_d): (f64, f64, f64, f64, f64, f64) = (321.0, 4e4, 9e4, 30.0, 12e-6, 3e-11);
    let window = WindowInformation::new(j, n, v).unwrap();
    let gamma = v / n;
    let var_c = pitch * pitch * n / (j * (1.0 + gamma));
    for (image, var_d) in [(Image::Measured, 0.0), (Image::Ideal { var_diffraction_m2: var_d }, var_d)] {
        let s43 = z * z / (0.2 * 0.014) * (2.0 * (var_c + var_d) * (1.0 + gamma) / n).sqrt();
        let bound = stereo().depth_bound(z, [window; 2], image).unwrap();
        close(bound.sigma_z_m, s43, 1e-14);
        close(bound.relative, s43 / z, 1e-14);
        close(bound.sigma_content_px.hypot(bound.sigma_diffraction_px), bound.sigma_disparity_px, 1e-14);
    }
    close(window.var_content_px2() * pitch * pitch, var_c, 1e-14);
    close(window.gamma(), gamma, 1e-15);
    close(z * z / (0.2 * 0.014), 3.214e5, 1e-3);
    close(disparity_bound_px(16.0, Some(9.0)).unwrap(), 5.0 / 12.0, 1e-15);
    close(disparity_bound_px(16.0, None).unwrap(), 2.0_f64.sqrt() / 4.0, 1e-15);
}

#[test]
fn without_texture_the_bound_is_infinite() {
    assert_eq!(disparity_bound_px(0.0, Some(4.0)).unwrap(), f64::INFINITY);
    let flat = WindowInformation::new(0.0, 1e4, 0.0).unwrap();
    assert_eq!(stereo().depth_bound(3.0, [flat; 2], Image::Measured).unwrap().sigma_z_m, f64::INFINITY);
    assert_eq!(flat.var_content_px2(), f64::INFINITY);
}

/// J of a density on a grid.
fn information(f: &[f64], step: f64) -> f64 {
    let largest = f.iter().fold(0.0_f64, |a, b| a.max(*b));
    f.windows(3)
        .filter(|f| f[1] > 1e-14 * largest)
        .map(|f| ((f[2] - f[0]) / (2.0 * step)).powi(2) / f[1] * step)
        .sum()
}

fn normalised(f: impl Fn(f64) -> f64, n: usize, step: f64) -> Vec<f64> {
    let mut f: Vec<f64> = (0..=2 * n).map(|i| f((i as f64 - n as f64) * step)).collect();
    let sum: f64 = f.iter().sum();
    f.iter_mut().for_each(|f| *f /= sum * step);
    f
}

/// 1/J(X + ξ) ≥ 1/J(X) + 1/J(ξ) for five textures and three point spreads, with equality for two Gaussians; with the
/// variance of ξ for 1/J(ξ) it would fail. Tolerance: the grid.
#[test]
fn the_bound_of_an_ideal_image_is_below_that_of_the_blurred_one() {
    let (step, n) = (0.02, 600);
    let sinc =
        |x: f64| if x == 0.0 { 1.0 } else { (std::f64::consts::PI * x).sin() / (std::f64::consts::PI * x) };
    let gauss = |x: f64| (-0.5 * x * x).exp();
    let textures: [&dyn Fn(f64) -> f64; 5] = [
        &gauss,
        &|x| 1.0 / x.cosh(),
        &|x| gauss((x - 1.5) / 0.6) + 0.5 * gauss((x + 1.0) / 0.8),
        &|x| if x.abs() < 2.0 { (std::f64::consts::FRAC_PI_4 * x).cos().powi(2) } else { 0.0 },
        &|x| (1.0 + 0.9 * (3.0 * x).cos()) * gauss(x / 1.5),
    ];
    let spreads: [&dyn Fn(f64) -> f64; 3] =
        [&|x| gauss(x / 0.7), &|x| if x.abs() < 4.0 { sinc(x).powi(2) } else { 0.0 }, &|x| {
            1.0 / (x / 0.5).cosh().powi(2)
        }];
    let (mut cases, mut above_variance) = (0, 0);
    for (i, texture) in textures.iter().enumerate() {
        let scene = normalised(texture, n, step);
        for (k, spread) in spreads.iter().enumerate() {
            let psf = normalised(spread, n, step);
            let mut blurred = vec![0.0; 4 * n + 1];
            for (a, scene) in scene.iter().enumerate().filter(|scene| *scene.1 > 0.0) {
                blurred[a..=a + 2 * n].iter_mut().zip(&psf).for_each(|(sum, psf)| *sum += scene * psf * step);
            }
            let truth = 1.0 / information(&blurred, step);
            let claimed = 1.0 / information(&scene, step) + 1.0 / information(&psf, step);
            assert!(truth >= claimed * (1.0 - 2e-3), "{i} {k}: {truth} {claimed}");
            if (i, k) == (0, 0) {
                close(truth, claimed, 1e-3);
                close(truth, 1.0 + 0.49, 1e-3);
            }
            let var: f64 =
                psf.iter().enumerate().map(|(j, f)| f * step * ((j as f64 - n as f64) * step).powi(2)).sum();
            above_variance += usize::from(truth < (1.0 / information(&scene, step) + var) * (1.0 - 1e-2));
            cases += 1;
        }
    }
    assert!(cases == 15 && above_variance >= 2, "{above_variance}");
}

fn samples(noise: f64) -> WindowSamples {
    let counts: Vec<f64> = (0..25).map(|i| 1e4 + 2e3 * (0.9 * f64::from(i)).sin()).collect();
    let derivative = (0..25).map(|i| 1.8e3 * (0.9 * f64::from(i)).cos()).collect();
    let var = (0..25).map(|i| noise * (1.0 + 0.1 * f64::from(i))).collect();
    WindowSamples::new(counts, derivative, var).unwrap()
}

fn task(window: &WindowSamples, image: Image, demand: Demand) -> DepthTask<'_> {
    DepthTask { geometry: stereo(), distance_m: 30.0, views: [window; 2], image, demand }
}

const SIGMA_D_M: f64 = 5e-6;
const IDEAL: Image = Image::Ideal { var_diffraction_m2: SIGMA_D_M * SIGMA_D_M };
/// Put back, a solution meets the demand but for the rounding of a logarithm up to 69.
const MET: f64 = 1e-12;

#[test]
fn distances_put_back_meet_the_demand() {
    let window = samples(3e3);
    let now = window.window_at(1.0, 1.0).unwrap();
    for image in [Image::Measured, IDEAL] {
        for demand in
            [Demand::Absolute(0.1), Demand::Absolute(4.0), Demand::Relative(0.002), Demand::Relative(0.3)]
        {
            let task = task(&window, image, demand);
            let far = task.distance_texture_in_image().unwrap();
            let z = far.value.unwrap();
            close(stereo().depth_bound(z, [now; 2], image).unwrap().sigma_z_m, far.sigma_z_m, MET);
            close(
                far.sigma_z_m,
                if let Demand::Relative(share) = demand { share * z } else { far.sigma_z_m },
                MET,
            );

            // On the object N ∝ 1/z², and J per pixel² stays: slopes grow as the photons go.
            let z = task.distance_texture_on_object().unwrap().value.unwrap();
            let fewer = (30.0 / z) * (30.0 / z);
            let there = WindowInformation::new(
                now.information_px2(),
                now.photons() * fewer,
                now.gamma() * now.photons() * fewer,
            );
            let reached = stereo().depth_bound(z, [there.unwrap(); 2], image).unwrap();
            match demand {
                Demand::Absolute(error_m) => close(reached.sigma_z_m, error_m, MET),
                Demand::Relative(share) => close(reached.relative, share, MET),
            }
        }
    }
}

#[test]
fn baseline_noise_aperture_and_exposure_put_back_meet_the_demand() {
    let window = samples(3e3);
    for image in [Image::Measured, IDEAL] {
        let now = task(&window, image, Demand::Absolute(1.0)).bound().unwrap().sigma_z_m;
        for share in [0.6, 0.95, 1.0, 3.0] {
            let task = task(&window, image, Demand::Absolute(share * now));
            let reached = |photons: f64, noise: f64, image: Image| {
                let windows = [window.window_at(photons, noise).unwrap(); 2];
                stereo().depth_bound(30.0, windows, image).unwrap().sigma_z_m / (share * now)
            };
            close(task.baseline().unwrap().value.unwrap(), 0.2 / share, MET);

            let airy = |aperture_m: f64| Ok((SIGMA_D_M * 0.01 / aperture_m).powi(2));
            let aperture = task.aperture(0.01, airy).unwrap();
            let factor = aperture.value.unwrap() / 0.01;
            let sharper = match image {
                Image::Measured => image,
                Image::Ideal { .. } => Image::Ideal { var_diffraction_m2: airy(0.01 * factor).unwrap() },
            };
            close(reached(factor * factor, 1.0, sharper), 1.0, MET);
            close(aperture.sigma_z_m, share * now, MET);

            let noise = ExposureNoise { exposure_s: 0.01, noise_exposure_s: 0.02, flicker_fraction: 0.05 };
            let factor = task.exposure(noise).unwrap().value.unwrap() / 0.01;
            let growth = factor * (0.95 + 0.05 * 0.5 * factor) / (0.95 + 0.05 * 0.5);
            close(reached(factor, growth, image), 1.0, MET);

            if share >= 0.95 {
                let noise = task.noise().unwrap();
                let factor = noise.value.unwrap() / noise.camera;
                close(reached(1.0, factor * factor, image), 1.0, MET);
            }
        }
    }
}

/// d²/(N + σ²) of one sample: all in closed form.
#[test]
fn one_sample_is_solved_by_hand() {
    let window = WindowSamples::new(vec![1e4], vec![500.0], vec![1e4]).unwrap();
    let pixel_m = 30.0 * 30.0 / (0.2 * 0.014) * 12e-6;
    // J = 12.5 now; 20 demanded: N + σ² = 12500.
    let wanted = Demand::Absolute(pixel_m * (2.0 / 20.0_f64).sqrt());
    let task = task(&window, Image::Measured, wanted);
    close(task.noise().unwrap().value.unwrap(), 50.0, MET);
    // k² 25/(k + 1) = 20.
    let k = (20.0 + (400.0_f64 + 2000.0).sqrt()) / 50.0;
    close(task.aperture(0.01, |_| Ok(0.0)).unwrap().value.unwrap(), 0.01 * k.sqrt(), MET);
    // Johnson noise alone: J ∝ t.
    let noise = ExposureNoise { exposure_s: 0.01, noise_exposure_s: 0.01, flicker_fraction: 0.0 };
    close(task.exposure(noise).unwrap().value.unwrap(), 0.016, MET);
    close(window.noise_counts(), 100.0, 1e-15);
}

/// t → ∞: J → Σd²/σ_F², the flicker variance at the exposure now.
#[test]
fn the_floors_are_found() {
    let window = WindowSamples::new(vec![1e4], vec![500.0], vec![1e4]).unwrap();
    let pixel_m = 30.0 * 30.0 / (0.2 * 0.014) * 12e-6;
    let floor = pixel_m * (2.0 / (2.5e5 / 4e3_f64)).sqrt();
    let noise = ExposureNoise { exposure_s: 0.01, noise_exposure_s: 0.01, flicker_fraction: 0.4 };
    let at = |share: f64| task(&window, Image::Measured, Demand::Absolute(floor * share));
    assert!(at(1.000_001).exposure(noise).unwrap().value.is_some());
    let none = at(0.999_999).exposure(noise).unwrap();
    assert!(none.value.is_none() && none.reason.unwrap().contains("no exposure is long enough"));
    close(none.sigma_z_m, floor, 1e-12);
    // Shot noise alone: J = 25.
    let quiet = pixel_m * (2.0 / 25.0_f64).sqrt();
    let none = task(&window, Image::Measured, Demand::Absolute(0.999 * quiet)).noise().unwrap();
    assert!(none.value.is_none() && none.reason.unwrap().contains("shot noise"));
    // D = 2f = 28 mm: k = 7.84.
    let best = pixel_m * (2.0 / (7.84 * 7.84 * 25.0 / 8.84_f64)).sqrt();
    let none =
        task(&window, Image::Measured, Demand::Absolute(0.999 * best)).aperture(0.01, |_| Ok(0.0)).unwrap();
    assert!(none.value.is_none() && none.reason.unwrap().contains("f/0.5"));
    close(none.sigma_z_m, best, 1e-12);
    assert!(task(&window, Image::Measured, Demand::Absolute(best)).aperture(0.028, |_| Ok(0.0)).is_ok());
}

#[test]
fn a_flat_window_has_no_solution() {
    let flat = WindowSamples::new(vec![1e4], vec![0.0], vec![]).unwrap();
    let task = task(&flat, IDEAL, Demand::Relative(0.1));
    let noise = ExposureNoise { exposure_s: 0.01, noise_exposure_s: 0.01, flicker_fraction: 0.0 };
    for solution in [
        task.distance_texture_in_image().unwrap(),
        task.distance_texture_on_object().unwrap(),
        task.baseline().unwrap(),
        task.aperture(0.01, |_| Ok(1e-12)).unwrap(),
        task.exposure(noise).unwrap(),
        task.noise().unwrap(),
    ] {
        assert!(solution.value.is_none() && solution.sigma_z_m.is_infinite());
        assert!(solution.reason.unwrap().contains("no texture"));
    }
}

#[test]
fn impossible_input_is_refused() {
    let message = StereoGeometry::new(0.0, 0.014, 1e-5).unwrap_err().to_string();
    assert!(message.contains("baseline = \"0.2 m\""), "{message}");
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(StereoGeometry::new(bad, 1.0, 1.0).is_err() && StereoGeometry::new(1.0, bad, 1.0).is_err());
        assert!(StereoGeometry::new(1.0, 1.0, bad).is_err() && stereo().disparity_px(bad).is_err());
        assert!(stereo().depth_m(bad).is_err() && stereo().depth_error_m(bad, 1.0).is_err());
        assert!(disparity_bound_px(bad, None).is_err() && disparity_bound_px(1.0, Some(bad)).is_err());
        assert!(
            WindowInformation::new(bad, 1.0, 1.0).is_err() && WindowInformation::new(1.0, bad, 1.0).is_err()
        );
        let image = Image::Ideal { var_diffraction_m2: bad };
        let window = WindowInformation::new(1.0, 1.0, 0.0).unwrap();
        assert!(stereo().depth_bound(1.0, [window; 2], image).is_err());
        let window = samples(1.0);
        for demand in [Demand::Absolute(bad), Demand::Relative(bad)] {
            let task = task(&window, Image::Measured, demand);
            assert!(task.baseline().is_err() && task.noise().is_err());
            assert!(task.distance_texture_in_image().is_err() && task.distance_texture_on_object().is_err());
        }
        let task = DepthTask { distance_m: bad, ..task(&window, Image::Measured, Demand::Absolute(1.0)) };
        assert!(task.bound().is_err() && task.aperture(0.01, |_| Ok(0.0)).is_err());
    }
    assert!(stereo().depth_m(0.0).is_err() && stereo().depth_error_m(1.0, -1.0).is_err());
    assert!(WindowInformation::new(1.0, 0.0, 0.0).is_err());
    assert!(WindowSamples::new(vec![], vec![], vec![]).is_err());
    assert!(WindowSamples::new(vec![1.0], vec![], vec![]).is_err());
    assert!(WindowSamples::new(vec![1.0], vec![1.0], vec![1.0, 2.0]).is_err());
    assert!(WindowSamples::new(vec![-1.0], vec![1.0], vec![]).is_err());
    assert!(WindowSamples::new(vec![1.0], vec![f64::NAN], vec![]).is_err());
    let window = samples(1.0);
    assert!(task(&window, Image::Measured, Demand::Absolute(1.0)).aperture(0.03, |_| Ok(0.0)).is_err());
    assert!(window.information_at(f64::NAN, 1.0).is_err() && window.information_at(1.0, -1.0).is_err());
}
