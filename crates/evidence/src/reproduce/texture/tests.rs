use super::*;
use hadar::cube::Shape;
use hadar::random::generator;
use rand::RngExt;

fn image(rows: usize, columns: usize, at: impl Fn(usize, usize) -> f64) -> MemoryCube<f64> {
    let samples = (0..rows * columns).map(|i| at(i / columns, i % columns)).collect();
    MemoryCube::new(Shape::new(rows, columns, 1).unwrap(), samples).unwrap()
}

fn window(rows: usize, columns: usize) -> Window {
    Window::new(rows, columns).unwrap()
}

fn random(rows: usize, columns: usize, seed: u64) -> MemoryCube<f64> {
    let mut rng = generator(seed, 0);
    let samples: Vec<f64> = (0..rows * columns).map(|_| rng.random()).collect();
    MemoryCube::new(Shape::new(rows, columns, 1).unwrap(), samples).unwrap()
}

/// The windows' values, row after row.
fn whole_windows(image: &MemoryCube<f64>, window: Window) -> Vec<Vec<f64>> {
    let (rows, columns) = (image.shape().rows(), image.shape().columns());
    let mut all = Vec::new();
    for top in 0..=rows - window.rows() {
        for left in 0..=columns - window.columns() {
            let row = |y: usize| &image.samples()[(top + y) * columns + left..][..window.columns()];
            all.push((0..window.rows()).flat_map(|y| row(y).to_vec()).collect());
        }
    }
    all
}

/// Mean first, then the squares of what is left of it.
fn two_pass(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let pivot = values[0];
    let mean = values.iter().map(|v| v - pivot).sum::<f64>() / n;
    (values.iter().map(|v| (v - pivot - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt()
}

#[test]
fn deviations_are_those_of_two_passes_for_any_window_and_offset() {
    for (rows, columns) in [(1, 7), (3, 3), (5, 1), (5, 9), (13, 11), (31, 31)] {
        for (height, width) in [(31, 31), (32, 45), (40, 33)] {
            for offset in [0.0, 1e9, -3e12] {
                let noise = random(height, width, 7);
                let image = image(height, width, |y, x| offset + noise.samples()[y * width + x]);
                let map = standard_deviation(&image, window(rows, columns)).unwrap();
                let direct = whole_windows(&image, window(rows, columns));
                assert_eq!(
                    (map.rows.len() * map.columns.len(), map.values.len()),
                    (direct.len(), direct.len())
                );
                assert_eq!((map.rows.start, map.rows.end), (rows / 2, height - rows / 2));
                assert_eq!((map.columns.start, map.columns.end), (columns / 2, width - columns / 2));
                for (found, values) in map.values.iter().zip(&direct) {
                    // 2n roundings at most, see the module; 2·961·u = 2e-13.
                    assert!((found / two_pass(values) - 1.0).abs() < 2e-13, "{rows} {columns} {offset}");
                }
            }
        }
    }
}

#[test]
fn a_bright_region_leaves_no_trace_in_the_deviation_beside_it() {
    // Running sums would carry the rounding of (1e12)² = 1e24, about 1e8, on to all windows after.
    let spot = |y: usize, x: usize| {
        if y < 10 && x < 10 { 1e12 * ((x * y % 3) as f64) } else { ((x * 7 + y * 3) % 5) as f64 * 1e-3 }
    };
    let image = image(40, 40, spot);
    let map = standard_deviation(&image, window(5, 5)).unwrap();
    for (found, values) in map.values.iter().zip(whole_windows(&image, window(5, 5))) {
        assert!((found / two_pass(&values) - 1.0).abs() < 1e-13);
    }
}

#[test]
fn deviations_in_closed_form() {
    let close = |map: TextureMap, expected: f64| {
        map.values.iter().for_each(|s| assert!((s / expected - 1.0).abs() < 1e-14, "{s} {expected}"));
    };
    // Checkerboard of 0 and 1 in n = 25: 12 or 13 ones, Σ(I − Ī)² = 12·13/25.
    let board = image(20, 21, |y, x| ((x + y) % 2) as f64);
    close(standard_deviation(&board, window(5, 5)).unwrap(), (12.0 * 13.0 / 25.0 / 24.0_f64).sqrt());
    // Ramp of slope a along x, w wide and h high: Σ(I − Ī)² = a² h w (w² − 1)/12.
    let ramp = image(20, 21, |_, x| 0.25 * x as f64 - 3.0);
    close(
        standard_deviation(&ramp, window(3, 7)).unwrap(),
        0.25 * (3.0 * 7.0 * 48.0 / 12.0 / 20.0_f64).sqrt(),
    );
    let flat = image(9, 9, |_, _| 0.1);
    assert!(standard_deviation(&flat, window(3, 5)).unwrap().values.iter().all(|&s| s == 0.0));
}

#[test]
fn neither_measure_knows_the_direction_of_stripes() {
    // The Fisher information about x of the first is 0, of the second not.
    let along_x = image(15, 15, |y, _| [1.0, 4.0, 2.0][y % 3]);
    let along_y = image(15, 15, |_, x| [1.0, 4.0, 2.0][x % 3]);
    let both = [along_x, along_y].map(|image| {
        let deviation = standard_deviation(&image, window(3, 3)).unwrap().values;
        (deviation, local_entropy(&image, window(3, 3), None).unwrap().values)
    });
    for (first, second) in both[0].0.iter().zip(&both[1].0) {
        // 1, 4 and 2, each three times: Σ(I − Ī)² = 3·14/3.
        assert!(
            (first / second - 1.0).abs() < 1e-14 && (first / (14.0_f64 / 8.0).sqrt() - 1.0).abs() < 1e-14
        );
    }
    assert_eq!(both[0].1, both[1].1);
    assert!((both[0].1[0] / 3.0_f64.log2() - 1.0).abs() < 1e-14);
}

#[test]
fn entropy_of_equally_likely_levels_is_the_logarithm_of_their_number() {
    assert_eq!(global_entropy(&image(4, 4, |_, _| 7.5), None).unwrap(), 0.0);
    let flat = local_entropy(&image(9, 9, |_, _| 7.5), window(5, 3), None).unwrap();
    assert!(flat.values.iter().all(|&bits| bits == 0.0));
    for levels in [2_usize, 3, 5, 16, 256] {
        let image = image(levels, levels, |y, x| ((x + y) % levels) as f64);
        assert!((global_entropy(&image, None).unwrap() - (levels as f64).log2()).abs() < 1e-14, "{levels}");
    }
    // All levels of a window different: log₂ n. One of n different: log₂ n − (n − 1)/n log₂(n − 1).
    let all = local_entropy(&image(9, 12, |y, x| (y * 12 + x) as f64), window(3, 5), None).unwrap();
    all.values.iter().for_each(|bits| assert!((bits / 15.0_f64.log2() - 1.0).abs() < 1e-14));
    let point = image(9, 9, |y, x| f64::from(u8::from((y, x) == (4, 4))));
    let one = local_entropy(&point, window(5, 5), None).unwrap();
    let expected = 25.0_f64.log2() - 24.0 / 25.0 * 24.0_f64.log2();
    one.values.iter().for_each(|bits| assert!((bits / expected - 1.0).abs() < 1e-13, "{bits} {expected}"));
}

#[test]
fn sliding_entropy_is_that_of_every_window_alone() {
    for (rows, columns) in [(1, 1), (1, 9), (9, 1), (5, 5), (21, 17)] {
        let image = random(30, 37, 11);
        let map = local_entropy(&image, window(rows, columns), Some([0.0, 1.0])).unwrap();
        let direct = whole_windows(&image, window(rows, columns));
        assert_eq!(map.values.len(), direct.len());
        for (found, values) in map.values.iter().zip(direct) {
            let shape = Shape::new(1, values.len(), 1).unwrap();
            let alone = global_entropy(&MemoryCube::new(shape, values).unwrap(), Some([0.0, 1.0])).unwrap();
            assert!((found - alone).abs() < 1e-13, "{found} {alone}");
        }
    }
}

#[test]
fn levels_are_the_nearest_of_256_within_the_range() {
    // 0.5/255 is rounded up, what lies beyond the range belongs to its ends.
    for (value, level) in [(0.49, 0.0), (0.51, 1.0), (254.51, 255.0), (300.0, 255.0), (-9.0, 0.0)] {
        let same = image(1, 2, |_, x| [value, level][x]);
        assert_eq!(global_entropy(&same, Some([0.0, 255.0])).unwrap(), 0.0, "{value}");
    }
    let apart = image(1, 2, |_, x| [0.49, 0.51][x]);
    assert_eq!(global_entropy(&apart, Some([0.0, 255.0])).unwrap(), 1.0);
    assert_eq!(global_entropy(&apart, Some([0.0, 1e6])).unwrap(), 0.0);
    // Offset and gain do not matter to the image's own range.
    let noise = random(20, 20, 3);
    let scaled = image(20, 20, |y, x| 1024.0 * noise.samples()[y * 20 + x]);
    assert_eq!(global_entropy(&noise, None).unwrap(), global_entropy(&scaled, None).unwrap());
}

#[test]
fn what_cannot_be_measured_is_refused() {
    let fine = image(4, 6, |y, x| (y + x) as f64);
    let message = |outcome: Result<TextureMap>| outcome.unwrap_err().to_string();
    assert_eq!(
        message(standard_deviation(&fine, window(5, 5))),
        "a window of 5 x 5 pixels in an image of 4 x 6; give one that fits into the image"
    );
    assert!(message(local_entropy(&fine, window(3, 7), None)).starts_with("a window of 3 x 7"));
    assert!(message(standard_deviation(&fine, window(1, 1))).contains("no standard deviation"));
    let two_bands = MemoryCube::new(Shape::new(4, 3, 2).unwrap(), vec![0.0; 24]).unwrap();
    assert!(message(standard_deviation(&two_bands, window(3, 3))).starts_with("an image of 2 bands"));
    for bad in [f64::NAN, f64::INFINITY, -1e141] {
        let image = image(4, 6, |y, x| if (y, x) == (2, 5) { bad } else { 0.0 });
        for text in [
            message(standard_deviation(&image, window(3, 3))),
            message(local_entropy(&image, window(3, 3), None)),
        ] {
            assert!(text.starts_with("row 2, column 5 (counted from 0): grey value is "), "{text}");
        }
        assert!(global_entropy(&image, None).is_err());
    }
    for range in [[1.0, 1.0], [2.0, 1.0], [0.0, f64::NAN], [f64::NEG_INFINITY, 0.0], [-1.7e308, 1.7e308]] {
        assert!(global_entropy(&fine, Some(range)).unwrap_err().to_string().starts_with("grey levels from"));
    }
}

#[test]
fn small_images_by_hand() {
    let image = |shape, samples| MemoryCube::new(shape, samples).unwrap();
    let three = Window::new(1, 3).unwrap();
    let row = Shape::new(1, 4, 1).unwrap();
    let map = standard_deviation(&image(row, vec![1.0, 2.0, 3.0, 3.0]), three).unwrap();
    assert_eq!((map.rows, map.columns), (0..1, 1..3));
    assert!((map.values[0] - 1.0).abs() < 1e-15 && (map.values[1] - 3_f64.sqrt().recip()).abs() < 1e-15);
    let map = local_entropy(&image(row, vec![5.0, 5.0, 5.0, 9.0]), three, None).unwrap();
    assert_eq!(map.values[0], 0.0);
    assert!((map.values[1] - (3_f64.log2() - 2.0 / 3.0)).abs() < 1e-15);
    let square = image(Shape::new(2, 2, 1).unwrap(), vec![3.0, 8.0, 8.0, 3.0]);
    assert_eq!(global_entropy(&square, None).unwrap(), 1.0);
}
