use super::pixels::{airy, airy_out_to, beyond, gaussian, lattice};
use super::*;

const SIGMA_AIRY_M: f64 = 1e-5;

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

/// The lattice, fed a Gaussian, against differences of error functions. Tolerance: three points per eighth of σ.
#[test]
fn the_lattice_agrees_with_error_functions() {
    let density = |r2: f64| (-0.5 * r2).exp() / (2.0 * PI);
    for pitch in [0.4, 1.5, 3.0] {
        let found = lattice(pitch, 8, 9.0, &density).unwrap();
        for (ours, exact) in found.iter().zip(gaussian(pitch, 8, 8)) {
            let ours = ours[0] + ours[1];
            assert!((ours / exact - 1.0).abs() < 1e-7, "{pitch}: {ours} {exact}");
        }
    }
}

/// Twice as far, where half as much is extrapolated. Tolerance: what the documentation says.
#[test]
fn what_is_beyond_the_lattice_is_known_to_a_thousandth() {
    for (pitch, reach) in [(0.3, 8.0), (0.6, 16.0), (1.0, 16.0), (1.4, 16.0)] {
        let (near, far) =
            (airy_out_to(pitch, 8, reach).unwrap(), airy_out_to(pitch, 8, 2.0 * reach).unwrap());
        for (near, far) in near.iter().zip(&far) {
            assert!((near / far - 1.0).abs() < 2e-3, "{pitch}: {near} {far}");
        }
    }
}

/// σ²(1 + p²/12σ²), and by how much it is not: less than 1e-6 up to σ/2, 1e-5 at σ, 0.1 % at 2 σ, 5 % too little at 4 σ.
#[test]
fn the_formula_of_thompson_holds_up_to_pixels_of_two_sigma() {
    let spread = PointSpread::gaussian(3e-6).unwrap();
    let excess = |pixels: f64| {
        let found = spread.in_pixels(3e-6 * pixels).unwrap().var_mean_m2 / 9e-12;
        found / (1.0 + pixels * pixels / 12.0) - 1.0
    };
    for (pixels, low, high) in [
        (1e-4, -1e-13, 1e-13),
        (0.5, -1e-6, 0.0),
        (1.0, -1.2e-5, -6e-6),
        (2.0, -1.2e-3, -0.9e-3),
        (4.0, 0.05, 0.06),
    ] {
        assert!((low..=high).contains(&excess(pixels)), "{pixels}: {}", excess(pixels));
    }
}

/// A source on the edge of wide pixels is a matter of left or right: J = 4 l(0)², l the line spread, 1/√(2π) or 8/(3π).
/// Tolerance for the Airy disk: the photons that miss both pixels, some 5 % at 8 λF, tell a little more by doing so.
#[test]
fn the_best_place_in_wide_pixels_is_the_edge() {
    let bound = PointSpread::gaussian(1.0).unwrap().in_pixels(20.0).unwrap();
    assert!((bound.var_best_m2 / (0.5 * PI) - 1.0).abs() < 1e-12);
    assert!(bound.var_worst_m2 > 1e20 && bound.var_mean_m2.is_finite());
    // Row 16 of 32: in the middle between edges along y.
    let places = airy_out_to(8.0, 32, 48.0).unwrap();
    let line = 8.0 / (3.0 * PI);
    let excess = places[16 * 32] / (4.0 * line * line) - 1.0;
    assert!((0.0..0.05).contains(&excess), "{excess}");
}

#[test]
fn pixels_only_take_away_and_fine_ones_nothing() {
    let mut last = 1.0;
    for pitch in [1e-3, 0.02, 0.06, 0.12, 0.3, 0.7, 1.0, 1.5, 3.0] {
        for spread in [disk(), PointSpread::gaussian(PI * SIGMA_AIRY_M).unwrap()] {
            let bound = spread.in_pixels(pitch * PI * SIGMA_AIRY_M).unwrap();
            let [best, mean, worst] =
                [bound.var_best_m2, bound.var_mean_m2, bound.var_worst_m2].map(|var| var / spread.var_m2());
            assert!(1.0 <= best && best <= mean * (1.0 + 1e-14) && mean <= worst * (1.0 + 1e-14), "{pitch}");
            if spread == disk() {
                assert!(mean > last, "{pitch}: {mean}");
                last = mean;
                // Dark rings make the loss proportional to the pitch: 0.9 of J per λF.
                if pitch <= 0.12 {
                    assert!(((1.0 - 1.0 / mean) / pitch / 0.91 - 1.0).abs() < 0.02, "{pitch} {mean}");
                }
            }
        }
    }
    // As large as the disk's width λF, they treble the variance.
    let bound = disk().in_pixels(PI * SIGMA_AIRY_M).unwrap();
    assert!((bound.var_mean_m2 / disk().var_m2() / 3.077 - 1.0).abs() < 3e-3);
}

#[test]
fn bands_apart_add_their_information() {
    let (one, two) = (PointSpread::airy(1.0, 800.0).unwrap(), PointSpread::airy(1.0, 1200.0).unwrap());
    let exact = 0.25 * one.information_per_m2() + 0.75 * two.information_per_m2();
    let bands = [(one, 1e3), (two, 3e3)];
    assert!((bands_var_m2(&bands).unwrap() * exact - 1.0).abs() < 1e-14);
    let [low, high, both] =
        [one.in_pixels(1e-5).unwrap(), two.in_pixels(1e-5).unwrap(), bands_in_pixels(&bands, 1e-5).unwrap()];
    assert!(high.var_mean_m2 < both.var_mean_m2 && both.var_mean_m2 < low.var_mean_m2);
    let same = bands_in_pixels(&[(one, 0.0), (two, 5.0), (two, 2.0)], 1e-5).unwrap();
    assert!((same.var_mean_m2 / high.var_mean_m2 - 1.0).abs() < 1e-3);
    // A Gaussian beside a disk is taken at the same places.
    let narrow = PointSpread::gaussian(5e-6).unwrap();
    let alone = narrow.in_pixels(1e-5).unwrap();
    let beside = bands_in_pixels(&[(narrow, 1.0), (one, 0.0)], 1e-5).unwrap();
    assert!((alone.var_mean_m2 / beside.var_mean_m2 - 1.0).abs() < 1e-6);
}

#[test]
fn impossible_numbers_are_refused() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e200] {
        assert!(PointSpread::gaussian(bad).is_err() && PointSpread::airy(bad, 1000.0).is_err(), "{bad}");
    }
    assert!(PointSpread::airy(1.0, 0.0).is_err() && PointSpread::airy_of_aperture(0.0, 1.0, 1.0).is_err());
    let disk = disk();
    assert!(disk.in_pixels(0.0).is_err() && disk.in_pixels(f64::NAN).is_err());
    assert!(disk.in_pixels(1e-3).unwrap_err().to_string().contains("finer pixels"));
    assert!(bands_var_m2(&[]).is_err() && bands_in_pixels(&[(disk, 0.0)], 1e-5).is_err());
    assert!(bands_var_m2(&[(disk, -1.0), (disk, 2.0)]).is_err());
}
