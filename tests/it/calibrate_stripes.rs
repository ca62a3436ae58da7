//! Stripes put into twins and taken out again.

use hadar::cube::{MemoryCube, Shape};
use hadar_estimate::calibrate::{Axis, Destriped, Sought, Why, find_stripes};
use hadar_simulate::draws::generator;
use rand::RngExt;

const SOUGHT: Sought = Sought { axis: Axis::Rows, gain_deviation: 0.1, in_all_bands: false };
const ROWS: usize = 90;
const COLUMNS: usize = 320;
const BANDS: usize = 12;

fn shape() -> Shape {
    Shape::new(ROWS, COLUMNS, BANDS).unwrap()
}

/// A normal deviate, well enough: twelve uniform ones.
fn normal(random: &mut impl RngExt) -> f64 {
    (0..12).map(|_| random.random_range(0.0..1.0)).sum::<f64>() - 6.0
}

/// A scene with a horizon over its whole width, a slope, true rows that differ, blocks with edges along rows, a texture, and noise of 0.3 %.
fn scene(seed: u64, noise: f64) -> Vec<f64> {
    let mut random = generator(seed, 0);
    let wave: Vec<[f64; 3]> = (0..30)
        .map(|_| {
            [random.random_range(0.02..0.6), random.random_range(0.02..0.6), random.random_range(0.0..6.3)]
        })
        .collect();
    let mut samples = Vec::with_capacity(shape().len());
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            let (y, x) = (row as f64, column as f64);
            let mut level = if row < 31 { 0.7 } else { 1.0 + 0.002 * y };
            if (50..62).contains(&row) {
                level += 0.08;
            }
            if (40..70).contains(&row) && (60..130).contains(&column) {
                level += 0.25;
            }
            let texture: f64 = wave.iter().map(|[a, b, c]| (a * x + b * y + c).sin()).sum();
            for band in 0..BANDS {
                let w = band as f64;
                let contrast = 1.0 + 0.3 * (w / 5.0).sin();
                let mean = 1000.0 * (1.0 + 0.05 * w) * (1.0 + contrast * (level - 1.0) + 0.001 * texture);
                samples.push(mean * (1.0 + noise * normal(&mut random)));
            }
        }
    }
    samples
}

fn found(samples: &[f64], sought: &Sought) -> Destriped {
    find_stripes(&MemoryCube::new(shape(), samples.to_vec()).unwrap(), sought).unwrap()
}

/// Puts gains and offsets into a share of the lines of each band; which, as (line, band, gain, offset).
fn striped(samples: &mut [f64], share: f64, seed: u64) -> Vec<(usize, usize, f64, f64)> {
    let mut random = generator(seed, 1);
    let mut put = Vec::new();
    for row in 0..ROWS {
        for band in 0..BANDS {
            if random.random_range(0.0..1.0) < share {
                let gain = 1.0 + 0.03 * normal(&mut random);
                let offset = 20.0 * normal(&mut random);
                put.push((row, band, gain, offset));
                let line = &mut samples[row * COLUMNS * BANDS..(row + 1) * COLUMNS * BANDS];
                line.iter_mut()
                    .skip(band)
                    .step_by(BANDS)
                    .for_each(|sample| *sample = gain * *sample + offset);
            }
        }
    }
    put
}

#[test]
fn a_clean_cube_stays_as_it_is() {
    for seed in 0..6 {
        for noise in [0.0, 0.003, 0.02] {
            let samples = scene(seed, noise);
            for axis in [Axis::Rows, Axis::Columns] {
                let cube = MemoryCube::new(shape(), samples.clone()).unwrap();
                let seen = find_stripes(&cube, &Sought { axis, ..SOUGHT }).unwrap();
                assert!(seen.stripes.is_empty(), "{seed} {noise} {axis:?}: {:?}", &seen.stripes[0]);
                assert!(seen.corrected(&cube).unwrap() == samples);
            }
        }
    }
}

#[test]
fn stripes_are_found_and_their_errors_hold() {
    let (mut held, mut all, mut missed, mut left, mut false_ones) = (0.0, 0.0, 0, 0, 0);
    let (mut before, mut after) = (0.0, 0.0);
    for seed in 0..30 {
        let clean = scene(seed, 0.003);
        let mut samples = clean.clone();
        let put = striped(&mut samples, 0.1, seed);
        let seen = found(&samples, &SOUGHT);
        false_ones += seen
            .stripes
            .iter()
            .filter(|one| !put.iter().any(|(line, band, ..)| (one.line, one.band) == (*line, *band)))
            .count();
        for (line, band, gain, offset) in &put {
            match seen.stripes.iter().find(|one| (one.line, one.band) == (*line, *band)) {
                None => {
                    // What is neither found nor named is hardly more than what is said to be seen.
                    let named = seen.left.contains(line)
                        || seen.kept.iter().any(|one| (one.line, one.band) == (*line, *band));
                    left += usize::from(named);
                    let level = if *line < 31 { 0.7 } else { 1.0 } * seen.levels[*band];
                    missed += usize::from(
                        !named && ((gain - 1.0) * level + offset).abs() > 2.0 * seen.detectable[*band],
                    );
                }
                Some(one) => {
                    let at = gain * one.level + offset;
                    let error = (one.corrected(at) - one.level).abs();
                    all += 1.0;
                    held += f64::from(u8::from(error <= 1.96 * one.sigma_common(one.level)));
                    before += (at - one.level).powi(2);
                    after += error * error;
                }
            }
        }
        let corrected = seen.corrected(&MemoryCube::new(shape(), samples.clone()).unwrap()).unwrap();
        let touched =
            |line: usize, band: usize| seen.stripes.iter().any(|one| (one.line, one.band) == (line, band));
        for (i, (own, was)) in corrected.iter().zip(&samples).enumerate() {
            let (line, band) = (i / (COLUMNS * BANDS), i % BANDS);
            if own.to_bits() != was.to_bits() {
                assert!(touched(line, band));
            }
        }
    }
    let share = held / all;
    println!(
        "{all} stripes, held {share}, missed {missed}, left and named {left}, false {false_ones}, rms {} -> {}",
        f64::sqrt(before / all),
        f64::sqrt(after / all)
    );
    // Without the quarter that is added for stripes beside that are too small to be seen: 0.896.
    assert!((0.9..=0.995).contains(&share), "{share}");
    // Where one line in ten is striped some stand side by side: those are left and named, and a clean one between them is taken for a
    // stripe now and then (measured: 37 of 2064).
    assert!(
        (missed as f64) < 0.03 * all && (false_ones as f64) < 0.025 * all,
        "{missed} {false_ones} of {all}"
    );
    assert!(after < 0.02 * before, "{after} {before}");
}

#[test]
fn columns_are_rows_of_the_turned_cube() {
    let mut samples = scene(3, 0.003);
    striped(&mut samples, 0.08, 3);
    let mut turned = vec![0.0; samples.len()];
    for (i, sample) in samples.iter().enumerate() {
        let (row, column, band) = (i / (COLUMNS * BANDS), i / BANDS % COLUMNS, i % BANDS);
        turned[(column * ROWS + row) * BANDS + band] = *sample;
    }
    let cube = MemoryCube::new(Shape::new(COLUMNS, ROWS, BANDS).unwrap(), turned).unwrap();
    let by_columns = find_stripes(&cube, &Sought { axis: Axis::Columns, ..SOUGHT }).unwrap();
    let by_rows = found(&samples, &SOUGHT);
    assert_eq!(by_columns.stripes.len(), by_rows.stripes.len());
    for (a, b) in by_columns.stripes.iter().zip(&by_rows.stripes) {
        assert!((a.off - b.off).abs() < 1e-9 * b.level && (a.gain - b.gain).abs() < 1e-9, "{a:?} {b:?}");
    }
}

#[test]
fn stripes_that_fill_the_cube_are_refused_and_thin_objects_left() {
    let mut samples = scene(1, 0.003);
    striped(&mut samples, 1.0, 1);
    let error = find_stripes(&MemoryCube::new(shape(), samples).unwrap(), &SOUGHT).unwrap_err().to_string();
    assert!(error.contains("too many to distinguish them from the scene"), "{error}");
    // A wire over the whole width: 3 % warmer in all bands.
    let mut samples = scene(1, 0.003);
    samples[20 * COLUMNS * BANDS..21 * COLUMNS * BANDS].iter_mut().for_each(|sample| *sample *= 1.03);
    let seen = found(&samples, &SOUGHT);
    assert_eq!((seen.left.as_slice(), seen.stripes.len()), (&[20][..], 0));
    let seen = found(&samples, &Sought { in_all_bands: true, ..SOUGHT });
    assert_eq!(seen.stripes.len(), BANDS);
    // Missing samples stay missing, and a line without any is no reference.
    let mut samples = scene(1, 0.003);
    striped(&mut samples, 0.05, 1);
    samples[40 * COLUMNS * BANDS..41 * COLUMNS * BANDS].fill(f64::NAN);
    let seen = found(&samples, &SOUGHT);
    let corrected = seen.corrected(&MemoryCube::new(shape(), samples.clone()).unwrap()).unwrap();
    assert_eq!(corrected.iter().filter(|x| x.is_nan()).count(), COLUMNS * BANDS);
    assert!(seen.stripes.iter().all(|one| one.line != 40 && one.sigma.is_finite() && one.gain.is_finite()));
}

/// Every line of every band with a gain of its own: none stands out, and the contrast along the lines hides it.
#[test]
fn gains_of_all_lines_are_refused() {
    for (rows, deviation) in [(24, 0.1), (60, 0.02), (60, 0.3), (200, 0.05)] {
        for seed in 0..5 {
            let (columns, bands) = (40, 15);
            let mut random = generator(seed, 7);
            let gains: Vec<f64> =
                (0..rows * bands).map(|_| 1.0 + deviation * random.random_range(-1.0..1.0)).collect();
            let mut samples = Vec::new();
            for row in 0..rows {
                for column in 0..columns {
                    let level = 1.0 + column as f64 / columns as f64 + 0.1 * (row as f64 / 9.0).sin();
                    for band in 0..bands {
                        let mean = 1e4 * (1.0 + 0.03 * band as f64) * level;
                        samples.push(gains[row * bands + band] * (mean + 50.0 * normal(&mut random)));
                    }
                }
            }
            let cube = MemoryCube::new(Shape::new(rows, columns, bands).unwrap(), samples).unwrap();
            let refused = find_stripes(&cube, &SOUGHT).unwrap_err().to_string();
            assert!(
                refused.contains("too many to distinguish them from the scene"),
                "{rows} {deviation}: {refused}"
            );
        }
    }
}

#[test]
fn what_has_no_stripes_to_see_is_refused() {
    let refused = |rows, columns, samples: Vec<f64>| {
        let shape = Shape::new(rows, columns, 2).unwrap();
        find_stripes(&MemoryCube::new(shape, samples).unwrap(), &SOUGHT).unwrap_err().to_string()
    };
    let one = refused(1, 50, vec![1.0; 100]);
    assert!(one.contains("1 rows of 50 pixels; stripes are seen in 8 rows or more"), "{one}");
    assert!(refused(20, 50, vec![1.0; 2000]).contains("all samples of the cube are the same"));
    assert!(refused(20, 50, vec![f64::NAN; 2000]).contains("the same"), "nothing there");
}

/// A smooth scene, whose rows differ by more than the noise of a segment, without edges.
fn slope(seed: u64) -> (Shape, Vec<f64>) {
    let (rows, columns, bands) = (60, 50, 8);
    let mut random = generator(seed, 2);
    let mut samples = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let level = 1.0 + 0.05 * (column as f64 / 7.0).sin() + 0.05 * (row as f64 / 9.0).cos();
            for band in 0..bands {
                samples.push((1000.0 - 40.0 * band as f64) * level + 3.0 * normal(&mut random));
            }
        }
    }
    (Shape::new(rows, columns, bands).unwrap(), samples)
}

/// Changes the samples of a row in some bands and columns.
fn change(
    (shape, samples): &mut (Shape, Vec<f64>),
    row: usize,
    bands: std::ops::RangeInclusive<usize>,
    columns: usize,
    to: impl Fn(f64) -> f64,
) {
    for column in 0..columns {
        for band in bands.clone() {
            let sample = &mut samples[(row * shape.columns() + column) * shape.bands() + band];
            *sample = to(*sample);
        }
    }
}

fn seen((shape, samples): &(Shape, Vec<f64>), sought: &Sought) -> Result<Destriped, String> {
    find_stripes(&MemoryCube::new(*shape, samples.clone()).unwrap(), sought)
        .map_err(|error| error.to_string())
}

#[test]
fn errors_of_stripes_alone_on_a_slope_hold() {
    let (mut held, mut all, mut bias) = (0, 0, 0.0);
    for seed in 0..40 {
        let mut cube = slope(seed);
        let put = [
            (10, 1, 1.02, 0.0),
            (20, 2, 1.03, 0.0),
            (30, 3, 0.97, 5.0),
            (40, 4, 1.0, -15.0),
            (50, 5, 1.05, 10.0),
        ];
        for (row, band, gain, offset) in put {
            change(&mut cube, row, band..=band, 50, |x| gain * x + offset);
        }
        let found = seen(&cube, &SOUGHT).unwrap();
        assert_eq!(found.stripes.len(), put.len(), "{seed} {:?}", found.kept);
        for (one, (row, band, gain, offset)) in found.stripes.iter().zip(put) {
            assert_eq!((one.line, one.band), (row, band));
            let truly = (gain - 1.0) * one.level + offset;
            all += 1;
            held += usize::from((one.off - truly).abs() <= 1.96 * one.sigma);
            bias += (one.off / truly - 1.0) / 200.0;
        }
    }
    println!("{held} of {all}, too little by {bias}");
    // 200 draws of 0.95 lie between 0.93 and 0.99 but for one time in ten; too little was taken out where a slope passed for an edge.
    assert!(held >= 186 && bias.abs() < 0.01, "{held} of {all}, {bias}");
}

#[test]
fn what_may_be_the_scene_is_left_and_named() {
    // An object with a feature in three bands, along a part of a row or along all of it.
    for columns in [38, 45, 50] {
        let mut cube = slope(1);
        change(&mut cube, 30, 4..=6, columns, |x| 0.87 * x);
        let found = seen(&cube, &SOUGHT).unwrap();
        assert!(found.stripes.is_empty(), "{columns}: {:?}", found.stripes);
        // Along less than four fifths it does not look striped at all, and is the scene's without a word.
        let named = found.left.contains(&30) || found.kept.iter().any(|kept| kept.line == 30);
        assert!(named || columns == 38, "{columns}");
    }
    // A warm object along most of a row, where stripes in all bands are sought.
    let mut cube = slope(2);
    change(&mut cube, 30, 0..=7, 40, |x| 1.06 * x);
    let found = seen(&cube, &Sought { in_all_bands: true, ..SOUGHT }).unwrap();
    assert!(found.stripes.is_empty() && found.kept.iter().all(|kept| kept.why == Why::InPart));
    assert_eq!(found.kept.len(), 8);
    // Rows side by side: their clean neighbours are not made striped.
    for rows in [20..22, 20..23, 20..28] {
        let mut cube = slope(3);
        rows.clone().for_each(|row| change(&mut cube, row, 2..=2, 50, |x| 1.03 * x));
        let found = seen(&cube, &SOUGHT).unwrap();
        assert!(found.stripes.iter().all(|one| rows.contains(&one.line)), "{rows:?} {:?}", found.stripes);
        for row in [rows.start, rows.end - 1] {
            let named = found.kept.iter().any(|kept| (kept.line, kept.band) == (row, 2));
            assert!(named || found.stripes.iter().any(|one| one.line == row), "{rows:?} {row}");
        }
    }
    // Every second row.
    for bands in [2..=2, 0..=7] {
        let mut cube = slope(4);
        (0..60).step_by(2).for_each(|row| change(&mut cube, row, bands.clone(), 50, |x| 1.02 * x));
        assert!(seen(&cube, &SOUGHT).unwrap_err().contains("too many to distinguish them from the scene"));
    }
    // Nothing of the scene is in a dead row, be it without noise or with it.
    for noise in [0.0, 1.0] {
        let mut cube = slope(5);
        let own = slope(6).1;
        let noise_of = |i: usize| noise * (own[i] - 1000.0).rem_euclid(6.0);
        for column in 0..50 {
            let i = (20 * 50 + column) * 8 + 2;
            cube.1[i] = 500.0 + noise_of(i);
        }
        let found = seen(&cube, &SOUGHT).unwrap();
        assert!(found.stripes.is_empty(), "{:?}", found.stripes);
        let kept: Vec<_> = found.kept.iter().map(|kept| (kept.line, kept.band, kept.why)).collect();
        assert_eq!(kept, [(20, 2, Why::Dead)]);
    }
}
