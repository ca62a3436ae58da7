use super::super::information;
use super::super::tests::{counts, cube, request};
use super::*;
use crate::cube::{MemoryCube, Shape};
use crate::ranging::derivative::Derivative;
use crate::ranging::noise::{Joined, NoiseVariance};
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn decisions_are_those_of_the_map(
        (rows, columns, bands) in (3usize..30, 9usize..200, prop_oneof![1usize..20, Just(54)]),
        (half_rows, half_columns, seed) in (0usize..6, 0usize..4, any::<u64>()),
        (level, narrow, kind) in (0usize..3, any::<bool>(), 0usize..3),
    ) {
        let shape = Shape::new(rows, columns, bands).unwrap();
        let height = 2 * half_rows.min((rows - 1) / 2) + 1;
        let window = Window::new(height, 2 * half_columns.min((columns - 3) / 2) + 1).unwrap();
        // Textured; level but for a part; with little texture but for a part.
        let (scale, part) = ([1.0, 0.0, 1e-2][level], (seed as usize / 7 % rows, seed as usize / 11 % columns));
        let mut samples = counts(shape, seed);
        for (i, sample) in samples.iter_mut().enumerate() {
            let (y, x) = (i / bands / columns, i / bands % columns);
            if y < part.0 || x < part.1 {
                *sample = 100.0 + scale * (*sample - 100.0) + (i % bands) as f64;
            }
        }
        let noise = match kind {
            0 => NoiseVariance::None,
            1 => NoiseVariance::Uniform(300.0),
            _ => NoiseVariance::PerSample(cube(shape, &counts(shape, !seed))),
        };
        let cube: Cube = if narrow {
            MemoryCube::new(shape, samples.iter().map(|count| *count as f32).collect()).unwrap().into()
        } else {
            cube(shape, &samples)
        };
        let (derivative, joined) = (Derivative::Central, Joined::SumOfReadings);
        let request =
            Request { window, derivative, noise: &noise, joined, cells: &[Cell::Full], centres: 0..rows };
        let map = information(&cube, &request).unwrap();
        let full = map.cell(Cell::Full);
        let most = full.iter().fold(f64::MIN_POSITIVE, |most, j| j.max(most));
        let value = full[seed as usize % full.len()].max(f64::MIN_POSITIVE);
        for required in [value, value.next_up(), value.next_down(), 0.1 * most, most, 2.0 * most] {
            let decision = decide(&cube, &request, required.max(f64::MIN_POSITIVE)).unwrap();
            let expected: Vec<bool> = full.iter().map(|full| *full >= required).collect();
            prop_assert_eq!(decision.above, expected);
            let stats = decision.stats;
            let proved = stats.windows_proved_above + stats.windows_proved_below;
            prop_assert_eq!(proved + stats.windows_computed, full.len());
        }
    }
}

#[test]
fn level_areas_are_proved_below() {
    let shape = Shape::new(60, 200, 9).unwrap();
    let mut samples = counts(shape, 1);
    let patch = |i: usize| i / 9 / 200 >= 40 && i / 9 % 200 >= 150;
    for (_, sample) in samples.iter_mut().enumerate().filter(|(i, _)| !patch(*i)) {
        *sample = 500.0;
    }
    let noise = NoiseVariance::None;
    let of = |samples: &[f64]| decide(&cube(shape, samples), &request(&noise, &[], 60), 1000.0);
    let decision = of(&samples).unwrap();
    let stats = decision.stats;
    assert!(stats.windows_proved_below > 8000 && stats.windows_computed < 1000, "{stats:?}");
    assert!(stats.samples_evaluated * 2 < stats.samples_total, "{stats:?}");
    // A count that is none is not taken for a level one.
    for value in [f64::NAN, f64::INFINITY, -1.0] {
        let mut samples = samples.clone();
        samples[(21 * 200 + 100) * 9 + 4] = value;
        assert!(of(&samples).unwrap_err().to_string().starts_with("the count at row 21, column 100, band 4"));
    }
}

#[test]
fn strong_texture_is_decided_from_a_third_of_the_rows() {
    let shape = Shape::new(60, 200, 5).unwrap();
    let noise = NoiseVariance::None;
    let cube = cube(shape, &counts(shape, 1));
    let decision = decide(&cube, &request(&noise, &[], 60), 1.0).unwrap();
    assert!(decision.above.iter().all(|above| *above));
    assert_eq!(decision.stats.windows_computed, 0);
    assert_eq!(decision.stats.samples_evaluated * 3, decision.stats.samples_total);
    assert!(decide(&cube, &request(&noise, &[], 60), f64::NAN).is_err());
}
