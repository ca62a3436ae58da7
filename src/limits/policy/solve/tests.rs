//! Solutions against closed forms.

use super::*;
use crate::fisher::Counting;
use crate::instrument::{Camera, View, presets};
use crate::spectrum::Bands;

/// d² = N²/(N + σ²)·10⁻⁶ for one band: closed form of every solution.
fn one_band(trial: &Trial) -> Result<f64> {
    let counting = seen(&trial.camera);
    let photons = counting.counts_per_radiance * 1e21;
    Ok(1e-3 * photons / (photons + counting.var_added(0)).sqrt())
}

fn seen(camera: &Camera) -> Counting {
    let bands = Bands::from_rows([(900.0, 1.0)]).unwrap();
    camera.counting(&bands, &View::at(Some(30.0)))
}

fn task<'a>(camera: &'a Camera, bands: &'a Bands, required: f64) -> CameraTask<'a> {
    CameraTask {
        camera,
        bands,
        required,
        distance_m: Some(30.0),
        farthest_m: None,
        size_m: None,
        of_object: false,
    }
}

#[test]
fn every_solution_fed_forward_gives_the_demanded_distance() {
    let mut camera = presets::get("flir-a325sc").unwrap();
    camera.flicker_fraction = 0.01;
    let bands = Bands::from_rows([(900.0, 1.0)]).unwrap();
    let now = one_band(&own(&camera)).unwrap();
    for required in [0.2 * now, now, 1.3 * now] {
        let task = task(&camera, &bands, required);
        for quantity in Quantity::OF_CAMERA {
            let solution = task.solve(quantity, one_band).unwrap();
            let value = solution.value.unwrap_or_else(|| panic!("{quantity:?}: {solution:?}"));
            let reached = one_band(&task.forward(quantity, value)).unwrap();
            if quantity == Quantity::Frames {
                assert!(reached >= required * (1.0 - 1e-9));
            } else {
                assert!((reached / required - 1.0).abs() < 1e-9, "{quantity:?} {reached} {required}");
            }
        }
    }
}

#[test]
fn the_flicker_floor_is_found_exactly() {
    let camera = presets::get("flir-a325sc").unwrap();
    let bands = Bands::from_rows([(900.0, 1.0)]).unwrap();
    // t → ∞: d → 10⁻³ N/σ_F, σ_F² = φσ² at the stated exposure.
    let counting = camera.counting(&bands, &View::at(Some(30.0)));
    let floor = 1e-3 * counting.counts_per_radiance * 1e21 / (0.5 * counting.var_added(0)).sqrt();
    let below = task(&camera, &bands, 0.999_999 * floor).solve(Quantity::Exposure, one_band).unwrap();
    assert!(below.value.is_some());
    let above = task(&camera, &bands, 1.000_001 * floor).solve(Quantity::Exposure, one_band).unwrap();
    assert!(above.value.is_none() && above.reason.unwrap().contains("flicker"));
    assert!((above.statistical_distance / floor - 1.0).abs() < 1e-9);
}

#[test]
fn what_cannot_be_told_apart_is_said_to_be_so() {
    let camera = presets::get("flir-a325sc").unwrap();
    let bands = Bands::from_rows([(900.0, 1.0)]).unwrap();
    for quantity in Quantity::OF_CAMERA {
        let solution = task(&camera, &bands, 1.0).solve(quantity, |_| Ok(0.0)).unwrap();
        assert_eq!((solution.value, solution.reason.as_deref()), (None, Some(NEVER)), "{quantity:?}");
    }
}

fn own(camera: &Camera) -> Trial {
    Trial { camera: camera.clone(), distance_m: Some(30.0) }
}

/// d² = N²/(N + σ²)·10⁻⁶ of n frames: N = nN₁ and, without flicker, σ² = nσ₁².
#[test]
fn noise_is_that_of_one_reading() {
    let mut camera = presets::get("flir-a325sc").unwrap();
    (camera.flicker_fraction, camera.frames) = (0.0, 100);
    let bands = Bands::from_rows([(900.0, 1.0)]).unwrap();
    let photons = camera.counting(&bands, &View::at(Some(30.0))).counts_per_radiance * 1e21;
    let required = 1e-3 * (photons / 5.0).sqrt();
    let solution = task(&camera, &bands, required).solve(Quantity::Noise, one_band).unwrap();
    // N²/(N + nσ₁²) = N/5, so σ₁² = 4N/n.
    let exact = (4.0 * photons / 100.0).sqrt();
    assert!((solution.value.unwrap() / exact - 1.0).abs() < 1e-9, "{solution:?} {exact}");
    assert!((solution.camera / 1.769e6 - 1.0).abs() < 1e-3);
}

#[test]
fn no_lens_is_faster_than_half() {
    let camera = presets::get("ideal-pnrd").unwrap();
    let bands = Bands::from_rows([(900.0, 1.0)]).unwrap();
    let now = one_band(&own(&camera)).unwrap();
    // d ∝ 1/F for shot noise: f/1.3 → f/0.5 gains 2.6.
    let solution = task(&camera, &bands, 2.7 * now).solve(Quantity::FNumber, one_band).unwrap();
    assert!(solution.value.is_none() && solution.reason.unwrap().contains("f/0.5"));
    let solution = task(&camera, &bands, 2.0 * now).solve(Quantity::FNumber, one_band).unwrap();
    assert!((solution.value.unwrap() / 0.65 - 1.0).abs() < 1e-6);
}

/// A requirement that the best end meets but for rounding, each value evaluated with another rounding: the end is the answer, and
/// none is refused.
#[test]
fn an_end_that_meets_the_requirement_but_for_rounding_is_the_answer() {
    let camera = presets::get("ideal-pnrd").unwrap();
    let bands = Bands::from_rows([(900.0, 1.0)]).unwrap();
    for seed in 0..200_u32 {
        let anything = task(&camera, &bands, 1.0);
        let fastest = anything.scaled(Quantity::FNumber, (camera.f_number / FASTEST_F_NUMBER).ln().exp());
        let best = one_band(&anything.forward(Quantity::FNumber, fastest)).unwrap();
        let mut count = seed;
        // The first value is that of the best end; of the later ones a third are up to four units lower in the last place.
        let mut uneven = |trial: &Trial| -> Result<f64> {
            let lower = if count > seed && count.is_multiple_of(3) { f64::from(count % 5) } else { 0.0 };
            count += 1;
            Ok(one_band(trial)? * (1.0 - lower * f64::EPSILON))
        };
        let required = best * (1.0 - 2.0 * f64::EPSILON * f64::from(seed % 2));
        let solution = task(&camera, &bands, required).solve(Quantity::FNumber, &mut uneven).unwrap();
        let value = solution.value.unwrap_or(f64::NAN);
        assert!((value / FASTEST_F_NUMBER - 1.0).abs() < 1e-9, "{seed}: {solution:?}");
    }
}

/// d = 30/z: the target shrinks within its pixel.
#[test]
fn the_farthest_distance_is_where_the_task_is_just_met() {
    let camera = presets::get("flir-a325sc").unwrap();
    let bands = Bands::from_rows([(900.0, 1.0)]).unwrap();
    let reached = |trial: &Trial| Ok(30.0 / trial.distance_m.unwrap());
    for required in [1e-3, 0.7, 1.0, 90.0] {
        let solution = task(&camera, &bands, required).solve(Quantity::Distance, reached).unwrap();
        assert!((solution.value.unwrap() * required / 30.0 - 1.0).abs() < 1e-12, "{solution:?}");
        assert_eq!(solution.camera, 30.0);
    }
    // Nearer than two focal lengths there is no image.
    let solution = task(&camera, &bands, 1e4).solve(Quantity::Distance, reached).unwrap();
    assert!(solution.value.is_none() && solution.reason.unwrap().contains("short enough"));
    // Tables of the air that end, the first just before, the others just behind where the task is no longer met: nothing is
    // asked of them beyond their end, and nothing is left out before it.
    for end_m in [29.9, 30.1, 47.0, 90.0, 8803.0] {
        let known = |trial: &Trial| match trial.distance_m {
            Some(z) if z > end_m => Err(crate::Error::malformed("the table ends", "go nearer")),
            _ => reached(trial),
        };
        let task = CameraTask { farthest_m: Some(end_m), ..task(&camera, &bands, 1.0) };
        let solution = task.solve(Quantity::Distance, known).unwrap();
        match solution.value {
            Some(value) => assert!(end_m > 30.0 && (value / 30.0 - 1.0).abs() < 1e-12, "{solution:?}"),
            None => assert!(
                end_m < 30.0
                    && solution.reason.unwrap().contains("up to where the data of the air end, 29.9 m")
            ),
        }
    }
}

#[test]
fn distance_does_not_matter_to_a_target_that_fills_its_pixels() {
    let camera = presets::get("flir-a325sc").unwrap();
    let bands = Bands::from_rows([(900.0, 1.0)]).unwrap();
    let reached = |trial: &Trial| {
        let counting = trial.camera.counting(&bands, &View::at(trial.distance_m));
        Ok(counting.counts_per_radiance)
    };
    let required = 0.5 * reached(&own(&camera)).unwrap();
    let solution = task(&camera, &bands, required).solve(Quantity::Distance, reached).unwrap();
    assert!(solution.value.is_none() && solution.reason.unwrap().contains("does not matter"));
}

/// Fed forward, a speed sets the exposure in which the target moves by one pixel, and in which the task is just met.
#[test]
fn the_largest_speed_is_that_of_the_least_exposure() {
    let mut camera = presets::get("ideal-pnrd").unwrap();
    (camera.pixels, camera.field_of_view_rad) = (Some(320), Some(0.4));
    camera.focal_length_m = camera.pixel_m * 320.0 / 0.4;
    let bands = Bands::from_rows([(900.0, 1.0)]).unwrap();
    for share in [0.1, 1.0, 7.0] {
        let required = share * one_band(&own(&camera)).unwrap();
        let task = task(&camera, &bands, required);
        let solution = task.solve(Quantity::Speed, one_band).unwrap();
        let speed = solution.value.unwrap();
        // Shot noise: t ∝ d²; Δ = v t L sin(θ/2)/(r θ) = 1.
        let exact = 30.0 * 0.4 / (0.2f64.sin() * 320.0 * camera.exposure_s * share * share);
        // Less than a whole pixel.
        assert!(speed < exact && (speed / exact - 1.0).abs() < 1e-8, "{speed} {exact}");
        let forward = task.forward(Quantity::Speed, speed);
        assert!((one_band(&forward).unwrap() / required - 1.0).abs() < 1e-8);
    }
    let nowhere = CameraTask { distance_m: None, ..task(&camera, &bands, 1.0) };
    let solution = nowhere.solve(Quantity::Speed, one_band).unwrap();
    assert!(solution.value.is_none() && solution.reason.unwrap().contains("target.distance"));
}

/// d = a² of a pixel up to the one that the target fills, and no more beyond.
#[test]
fn a_pixel_larger_than_the_target_is_no_better() {
    let camera = presets::get("flir-a325sc").unwrap();
    let bands = Bands::from_rows([(900.0, 1.0)]).unwrap();
    let size_m = 4.0 * camera.pixel_m * 30.0 / camera.focal_length_m;
    let reached = |trial: &Trial| {
        let side = trial.camera.pixel_m / camera.pixel_m;
        Ok(if side <= 4.0 { side * side } else { 16.0 / (side / 4.0) })
    };
    let solve = |required: f64| {
        let task = CameraTask { size_m: Some(size_m), ..task(&camera, &bands, required) };
        task.solve(Quantity::Pixel, reached).unwrap()
    };
    assert!((solve(9.0).value.unwrap() / (3.0 * camera.pixel_m) - 1.0).abs() < 1e-9);
    let solution = solve(17.0);
    assert!(solution.value.is_none() && solution.reason.unwrap().contains("that the target fills"));
    assert!((solution.statistical_distance / 16.0 - 1.0).abs() < 1e-9);
}

/// The least number of frames is that of a search by halves, whatever stops d from growing as their root, and takes few trials where nothing does.
#[test]
fn frames_are_those_of_a_search_by_halves() {
    let bands = Bands::from_rows([(900.0, 1.0)]).unwrap();
    let camera = presets::get("flir-a325sc").unwrap();
    for floor in [0.0, 1e-9, 1e-4, 0.1] {
        for at_one in [1e-6, 3e-3, 0.2, 0.999_999_999, 1.0, 7.0] {
            for own in [1, 16, u32::MAX] {
                let camera = Camera { frames: own, ..camera.clone() };
                let d = |frames: f64| at_one * (frames / (1.0 + floor * frames)).sqrt();
                let mut trials = 0;
                let found = task(&camera, &bands, 1.0).solve(Quantity::Frames, |trial| {
                    trials += 1;
                    Ok(d(f64::from(trial.camera.frames)))
                });
                let enough = |frames: u32| d(f64::from(frames)) >= 1.0 - 1e-9;
                let expected = enough(u32::MAX).then(|| {
                    let (mut few, mut many) = (0, u32::MAX);
                    while many - few > 1 {
                        let middle = few.midpoint(many);
                        *(if enough(middle) { &mut many } else { &mut few }) = middle;
                    }
                    f64::from(many)
                });
                assert_eq!(found.unwrap().value, expected, "{floor} {at_one} {own}");
                assert!(trials <= if floor == 0.0 { 8 } else { 100 }, "{floor} {at_one} {own}: {trials}");
            }
        }
    }
}
