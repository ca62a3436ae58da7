use super::*;

const SIGMA_AIRY_M: f64 = 1e-5;

/// h at the squared distance `r2`, (λF)⁻²: (π/4)[2J₁(v)/v]², v = πr.
fn airy(r2: f64) -> f64 {
    let v = PI * r2.sqrt();
    let amplitude = if v < 1e-4 { 1.0 - 0.125 * v * v } else { 2.0 * libm::j1(v) / v };
    0.25 * PI * amplitude * amplitude
}

/// Share of J that comes from beyond the distance `r` (λF).
fn beyond(r: f64) -> f64 {
    let v = PI * r;
    libm::j0(v).powi(2) + 2.0 * libm::j1(v).powi(2) + libm::jn(2, v).powi(2)
}

/// λF = 10π µm, so that σ_d = 10 µm.
fn disk() -> PointSpread {
    PointSpread::airy(1.0, 0.01 / (PI * SIGMA_AIRY_M)).unwrap()
}

/// ∬(∂ₓh)²/h in polar coordinates by the midpoint rule, ∂h by differences: no Parseval, no closed form but that of the rest.
/// Tolerance: steps of 1e-3 and differences over 2e-5.
#[test]
fn the_information_of_an_airy_disk_is_that_of_its_integral() {
    let (step, to) = (1e-3, 12.0);
    let (mut photons, mut rings) = (0.0, [0.0; 12]);
    for i in 0..(to / step) as usize {
        let r = (i as f64 + 0.5) * step;
        let h = airy(r * r);
        let slope = (airy((r + 1e-5).powi(2)) - airy((r - 1e-5).powi(2))) / 2e-5;
        photons += 2.0 * PI * r * h * step;
        // cos² averages to 1/2.
        rings[r as usize] += PI * r * slope * slope / h * step;
    }
    // Encircled energy 1 − J₀² − J₁².
    let v = PI * to;
    assert!((photons + libm::j0(v).powi(2) + libm::j1(v).powi(2) - 1.0).abs() < 1e-5, "{photons}");
    let mut within = 0.0;
    for (i, ring) in rings.iter().enumerate() {
        within += ring;
        let exact = PI * PI * (1.0 - beyond(i as f64 + 1.0));
        assert!((within / exact - 1.0).abs() < 1e-4, "{i}: {within} {exact}");
    }
    assert!((disk().sigma_m() / SIGMA_AIRY_M - 1.0).abs() < 1e-14);
    assert!((disk().information_per_m2() * 1e-10 - 1.0).abs() < 1e-14);
}

/// h ≈ h(0)(1 − v²/4): the Gaussian of the same core has σ = √2 λF/π, so that the rings halve the variance.
#[test]
fn an_airy_disk_tells_twice_what_the_gaussian_of_its_core_does() {
    let r = 1e-3;
    let sigma_core = (r * r / (-2.0 * (airy(r * r) / airy(0.0)).ln())).sqrt();
    assert!((sigma_core * PI / 2.0_f64.sqrt() - 1.0).abs() < 1e-5);
    let aperture = PointSpread::airy_of_aperture(0.01, 0.014, 769.0).unwrap();
    assert!((aperture.sigma_m() / PointSpread::airy(1.4, 769.0).unwrap().sigma_m() - 1.0).abs() < 1e-14);
}

#[test]
fn bands_apart_add_their_information() {
    let (one, two) = (PointSpread::airy(1.0, 800.0).unwrap(), PointSpread::airy(1.0, 1200.0).unwrap());
    let exact = 0.25 * one.information_per_m2() + 0.75 * two.information_per_m2();
    let bands = [(one, 1e3), (two, 3e3)];
    assert!((bands_var_m2(&bands).unwrap() * exact - 1.0).abs() < 1e-14);
}

#[test]
fn impossible_numbers_are_refused() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e200] {
        assert!(PointSpread::gaussian(bad).is_err() && PointSpread::airy(bad, 1000.0).is_err(), "{bad}");
    }
    assert!(PointSpread::airy(1.0, 0.0).is_err() && PointSpread::airy_of_aperture(0.0, 1.0, 1.0).is_err());
    let disk = disk();
    assert!(bands_var_m2(&[]).is_err() && bands_var_m2(&[(disk, 0.0)]).is_err());
    assert!(bands_var_m2(&[(disk, -1.0), (disk, 2.0)]).is_err());
}
