use super::decide::{self, decide};
use super::*;
use crate::cube::{Cube, MemoryCube, Shape};
use crate::ranging::derivative::{Derivative, Differentiator};
use crate::ranging::noise::{Joined, NoiseVariance};
use proptest::prelude::*;

/// Counts from a small generator, [row][column][band]; whole numbers, so that f32 holds them exactly.
pub(super) fn counts(shape: Shape, seed: u64) -> Vec<f64> {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 44) as f64 % 1000.0
    };
    (0..shape.len()).map(|_| 100.0 + next()).collect()
}

pub(super) fn cube(shape: Shape, samples: &[f64]) -> Cube {
    MemoryCube::new(shape, samples.to_vec()).unwrap().into()
}

struct Naive<'a> {
    shape: Shape,
    counts: &'a [f64],
    var: &'a [f64],
    joined: Joined,
    derivative: Derivative,
}

impl Naive<'_> {
    /// The four cells by the formulas, in the order of [`Cell::ALL`], and the photons.
    fn at(&self, window: Window, y: usize, x: usize) -> [f64; 5] {
        let (bands, columns) = (self.shape.bands(), self.shape.columns());
        let margin = self.derivative.margin();
        let rows = y - window.half_rows()..=y + window.half_rows();
        let mut pixels = Vec::new();
        for y in rows {
            let row = &self.counts[y * columns * bands..(y + 1) * columns * bands];
            let mut slope = vec![0.0; (columns - 2 * margin) * bands];
            Differentiator::new(self.derivative, columns).unwrap().apply(row, bands, &mut slope).unwrap();
            for x in x - window.half_columns()..=x + window.half_columns() {
                let var = &self.var[(y * columns + x) * bands..];
                let of = |b: usize| (slope[(x - margin) * bands + b], row[x * bands + b], var[b]);
                pixels.push((0..bands).map(of).collect::<Vec<_>>());
            }
        }
        let n = pixels.len();
        let ratio = |samples: &mut dyn Iterator<Item = (f64, f64, f64)>| {
            let (mut d, mut count, mut var, mut len) = (0.0, 0.0, 0.0, 0.0);
            for sample in samples {
                (d, count, var, len) = (d + sample.0, count + sample.1, var + sample.2, len + 1.0);
            }
            let var = if self.joined == Joined::OneReading { var / len } else { var };
            d * d / (count + var)
        };
        let all = || pixels.iter().flatten().copied();
        let total = ratio(&mut all());
        let spatial = pixels.iter().map(|pixel| ratio(&mut pixel.iter().copied())).sum();
        let spectral = (0..bands).map(|b| ratio(&mut (0..n).map(|p| pixels[p][b]))).sum();
        let full = all().map(|sample| ratio(&mut std::iter::once(sample))).sum();
        [total, spatial, spectral, full, all().map(|sample| sample.1).sum()]
    }
}

fn close(a: f64, b: f64, scale: f64) -> bool {
    // Rounding of sums that partly cancel is relative to what is summed, here to the largest of the cells.
    (a - b).abs() <= 1e-11 * scale.max(b.abs())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn maps_are_those_of_the_formulas(
        (rows, columns, bands) in (1usize..16, 9usize..40, prop_oneof![1usize..20, Just(54)]),
        (half_rows, half_columns) in (0usize..7, 0usize..7),
        (kind, one, scheme, seed) in (0usize..4, any::<bool>(), 0usize..4, any::<u64>()),
    ) {
        let shape = Shape::new(rows, columns, bands).unwrap();
        let half_rows = half_rows.min((rows - 1) / 2);
        let half_columns = half_columns.min((columns - 5) / 2);
        let window = Window::new(2 * half_rows + 1, 2 * half_columns + 1).unwrap();
        let counts = counts(shape, seed);
        let var: Vec<f64> = match kind {
            0 => vec![0.0; shape.len()],
            1 => vec![50.0; shape.len()],
            2 => (0..shape.len()).map(|i| (i % bands) as f64).collect(),
            _ => self::counts(shape, seed ^ 77),
        };
        let noise = match kind {
            0 => NoiseVariance::None,
            1 => NoiseVariance::Uniform(50.0),
            2 => NoiseVariance::PerBand(var[..bands].to_vec()),
            _ => NoiseVariance::PerSample(cube(shape, &var)),
        };
        let joined = if one { Joined::OneReading } else { Joined::SumOfReadings };
        let derivative = Derivative::ALL[scheme];
        let request =
            Request { window, derivative, noise: &noise, joined, cells: &Cell::ALL, centres: 0..rows };
        let map = information(&cube(shape, &counts), &request).unwrap();
        let narrow: Vec<f32> = counts.iter().map(|count| *count as f32).collect();
        let narrow: Cube = MemoryCube::new(shape, narrow).unwrap().into();
        prop_assert_eq!(&map, &information(&narrow, &request).unwrap());
        let naive = Naive { shape, counts: &counts, var: &var, joined, derivative };
        let mut index = 0;
        for y in map.rows.clone() {
            for x in map.columns.clone() {
                let expected = naive.at(window, y, x);
                let scale = expected[..4].iter().fold(0.0, |a: f64, b| a.max(*b));
                for (cell, expected) in Cell::ALL.into_iter().zip(expected) {
                    let found = map.cell(cell)[index];
                    prop_assert!(close(found, expected, scale), "{:?} {} {}", cell, found, expected);
                }
                prop_assert_eq!(map.photons[index], expected[4]);
                if kind == 0 {
                    // Cauchy and Schwarz, to rounding.
                    let [total, spatial, spectral, full] = Cell::ALL.map(|cell| map.cell(cell)[index]);
                    prop_assert!(full * (1.0 + 1e-12) >= spatial.max(spectral));
                    prop_assert!(spatial.min(spectral) * (1.0 + 1e-12) + 1e-14 * full >= total);
                }
                index += 1;
            }
        }
        prop_assert_eq!(index, map.photons.len());

        // The same bits in blocks of other heights, for part of the rows, and in the decision.
        let plan = blocks::Plan::new(shape, &request).unwrap();
        prop_assert_eq!(&whole((&cube(shape, &counts)).into(), &plan, 1 + seed as usize % 5).unwrap(), &map);
        let parts = std::sync::Mutex::new(Vec::new());
        information_by_rows(&cube(shape, &counts), &request, &|part| {
            parts.lock().unwrap().push(part.clone());
            Ok(())
        }).unwrap();
        let mut parts = parts.into_inner().unwrap();
        parts.sort_by_key(|part| part.rows.start);
        let joined = |of: &dyn Fn(&InformationMap) -> Vec<f64>| parts.iter().flat_map(of).collect::<Vec<_>>();
        for cell in Cell::ALL {
            prop_assert_eq!(&joined(&|part| part.cell(cell).to_vec()), map.cell(cell));
        }
        prop_assert_eq!(joined(&|part| part.photons.clone()), map.photons.clone());
        prop_assert_eq!(joined(&|part| part.var_added.clone()), map.var_added.clone());
        let part = Request { centres: map.rows.start + map.rows.len() / 2..rows, ..request.clone() };
        let part = information(&cube(shape, &counts), &part).unwrap();
        for cell in Cell::ALL {
            prop_assert!(map.cell(cell).ends_with(part.cell(cell)));
        }
        let full = map.cell(Cell::Full);
        let required = full[seed as usize % full.len()];
        let decision = decide(&cube(shape, &counts), &request, required).unwrap();
        let expected: Vec<bool> = full.iter().map(|full| *full >= required).collect();
        let parts = decide::in_parts(&cube(shape, &counts), &request, required, 1).unwrap();
        prop_assert_eq!((&parts.above, &parts.rows), (&expected, &decision.rows));
        prop_assert_eq!(parts.stats.samples_total, decision.stats.samples_total);
        prop_assert_eq!(decision.above, expected);
        let stats = decision.stats;
        let windows = stats.windows_proved_above + stats.windows_proved_below + stats.windows_computed;
        prop_assert_eq!(windows, full.len());
    }
}

pub(super) fn request<'a>(noise: &'a NoiseVariance, cells: &'a [Cell], rows: usize) -> Request<'a> {
    let window = Window::new(3, 5).unwrap();
    let (derivative, joined) = (Derivative::Central, Joined::SumOfReadings);
    Request { window, derivative, noise, joined, cells, centres: 0..rows }
}

#[test]
fn scaled_mirrored_and_reordered_cubes_give_what_they_must() {
    let shape = Shape::new(9, 300, 11).unwrap();
    let (rows, columns, bands) = (9, 300, 11);
    let counts = counts(shape, 5);
    let noise = NoiseVariance::None;
    let map = information(&cube(shape, &counts), &request(&noise, &Cell::ALL, rows)).unwrap();
    let of = |change: &dyn Fn(usize, usize, usize) -> f64| {
        let samples: Vec<f64> =
            (0..shape.len()).map(|i| change(i / bands / columns, i / bands % columns, i % bands)).collect();
        information(&cube(shape, &samples), &request(&noise, &Cell::ALL, rows)).unwrap()
    };
    let at = |y: usize, x: usize, b: usize| counts[(y * columns + x) * bands + b];
    let scaled = of(&|y, x, b| 3.7 * at(y, x, b));
    let mirrored = of(&|y, x, b| at(y, columns - 1 - x, b));
    let reordered = of(&|y, x, b| at(y, x, (b * 4) % bands));
    let width = map.columns.len();
    for cell in Cell::ALL {
        for (i, j) in map.cell(cell).iter().enumerate() {
            let scale = map.cell(Cell::Full)[i];
            assert!(close(scaled.cell(cell)[i] / 3.7, *j, scale));
            assert!(close(mirrored.cell(cell)[i / width * width + width - 1 - i % width], *j, scale));
            assert!(close(reordered.cell(cell)[i], *j, scale));
        }
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let shape = Shape::new(150, 500, 13).unwrap();
    let (counts, noise) = (counts(shape, 3), NoiseVariance::Uniform(3.0));
    let cube = cube(shape, &counts);
    let maps = [1, 2, 5].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| information(&cube, &request(&noise, &Cell::ALL, 150)).unwrap())
    });
    assert_eq!(maps[0], maps[1]);
    assert_eq!(maps[0], maps[2]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Windows with a missing count are missing, all others keep their bits.
    #[test]
    fn missing_counts_are_those_of_their_windows_alone(
        (rows, columns, bands) in (9usize..40, 20usize..60, prop_oneof![1usize..20, Just(54)]),
        (half_rows, half_columns) in (0usize..5, 0usize..6),
        (kind, scheme, narrow, seed) in (0usize..4, 0usize..4, any::<bool>(), any::<u64>()),
        places in proptest::collection::vec(any::<proptest::sample::Index>(), 1..4),
    ) {
        let shape = Shape::new(rows, columns, bands).unwrap();
        let window = Window::new(2 * half_rows.min((rows - 1) / 2) + 1, 2 * half_columns + 1).unwrap();
        let counts = counts(shape, seed);
        let mut missing = counts.clone();
        let places: Vec<usize> = places.iter().map(|place| place.index(shape.len())).collect();
        places.iter().for_each(|place| missing[*place] = f64::NAN);
        let of = |samples: &[f64]| -> Cube {
            match narrow {
                true => MemoryCube::new(shape, samples.iter().map(|n| *n as f32).collect()).unwrap().into(),
                false => cube(shape, samples),
            }
        };
        let noise = match kind {
            0 => NoiseVariance::None,
            1 => NoiseVariance::Uniform(50.0),
            2 => NoiseVariance::PerBand((0..bands).map(|band| band as f64).collect()),
            // A variance is not looked at where there is no count.
            _ => NoiseVariance::PerSample(of(&missing)),
        };
        let derivative = Derivative::ALL[scheme];
        let joined = Joined::SumOfReadings;
        let request =
            |noise| Request { window, derivative, noise, joined, cells: &Cell::ALL, centres: 0..rows };
        let complete = match kind {
            3 => NoiseVariance::PerSample(of(&counts)),
            _ => NoiseVariance::None,
        };
        let whole = information(&of(&counts), &request(if kind == 3 { &complete } else { &noise })).unwrap();
        let map = information(&of(&missing), &request(&noise)).unwrap();
        let beside = match derivative {
            Derivative::Central | Derivative::Simoncelli => window.half_columns() + derivative.margin(),
            _ => columns,
        };
        let pixels: Vec<(usize, usize)> =
            places.iter().map(|place| (place / bands / columns, place / bands % columns)).collect();
        let holds = |y: usize, x: usize| {
            pixels.iter().any(|(row, column)| row.abs_diff(y) <= window.half_rows() && column.abs_diff(x) <= beside)
        };
        let mut index = 0;
        for y in map.rows.clone() {
            for x in map.columns.clone() {
                for (own, exact) in map.information.iter().zip(&whole.information) {
                    match holds(y, x) {
                        true => prop_assert!(own[index].is_nan(), "{} {}", y, x),
                        false => prop_assert_eq!(own[index], exact[index], "{} {}", y, x),
                    }
                }
                index += 1;
            }
        }
    }
}

#[test]
fn a_bad_sample_is_named() {
    let shape = Shape::new(8, 30, 11).unwrap();
    let (none, some) = (NoiseVariance::None, NoiseVariance::Uniform(1.0));
    for (value, says) in [
        (f64::INFINITY, "is inf; it must be a number of photons"),
        (-1.0, "is -1;"),
        (0.0, "give a noise variance above 0"),
    ] {
        let mut samples = counts(shape, 9);
        samples[(4 * 30 + 17) * 11 + 9] = value;
        let message =
            information(&cube(shape, &samples), &request(&none, &[Cell::Total], 8)).unwrap_err().to_string();
        assert!(message.starts_with("the count at row 4, column 17, band 9 (from 0) is"), "{message}");
        assert!(message.contains(says), "{message}");
        let noisy = information(&cube(shape, &samples), &request(&some, &Cell::ALL, 8));
        assert_eq!(noisy.is_ok(), value == 0.0);
    }
    let mut variances = vec![1.0; shape.len()];
    variances[7] = -2.0;
    let noise = NoiseVariance::PerSample(cube(shape, &variances));
    let error = information(&cube(shape, &counts(shape, 9)), &request(&noise, &Cell::ALL, 8)).unwrap_err();
    assert!(
        error.to_string().starts_with("the noise variance at row 0, column 0, band 7 (from 0) is -2"),
        "{error}"
    );
    let mut large = request(&none, &Cell::ALL, 8);
    large.window = Window::new(3, 29).unwrap();
    let message = information(&cube(shape, &counts(shape, 9)), &large).unwrap_err().to_string();
    assert!(message.contains("3 x 29 pixels in an image of 8 x 30, of which 1 column"), "{message}");
}
