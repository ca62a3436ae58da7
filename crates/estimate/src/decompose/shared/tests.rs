//! Cubes in which several things are otherwise than told, all of them stated as unknown.

use super::*;
use crate::decompose::effect::Effect;
use crate::decompose::judge::tests::{EXACT, Otherwise, PIXELS, causes, counted, state, told};
use crate::decompose::tangent::{Tangent, Tangents};
use crate::decompose::{Alike, Light, widen};
use hadar::cube::{MemoryCube, Shape};
use hadar::random::generator;
use hadar::spectrum::Bands;
use rand_distr::{Distribution, Poisson};

/// The slope of each cause is the difference of the counts with a little more and less of it.
#[test]
fn a_cause_to_first_order_is_what_it_does() {
    let told = told();
    let setting = told.setting();
    let tangents = Tangents::new(&setting).unwrap();
    for cause in causes(&setting) {
        let effect = Effect::new(&cause, &setting, &tangents).unwrap();
        let h = match cause {
            Cause::WavelengthShift(_) => 1.0,
            Cause::LightTemperature { .. } => 0.1,
            Cause::Air { .. } => 1.0,
            _ => 1e-3,
        };
        for i in [0, 5, 77] {
            let (m, t, v) = state(i);
            let lit = [v, 1.0 - v];
            let mut tangent = Tangent::default();
            assert!(tangents.at(m, t, &lit, &mut tangent));
            let mut slope = Vec::new();
            effect.slope(&tangents, (m, t, &lit), &tangent, &mut slope);
            // Light and air cannot be taken away where there is none.
            let below =
                if matches!(cause, Cause::LightMissing { .. } | Cause::Air { .. }) { 0.0 } else { -h };
            let at = |amount: f64| {
                let told = told.with(&cause, amount).unwrap();
                let total = told.lighting_total.unwrap();
                let lit = lit.map(|v| v * total);
                let mut mean = Vec::new();
                Tangents::new(&told.setting()).unwrap().mean((m, t, &lit), &mut mean).unwrap();
                mean
            };
            // A sum above 1 is none.
            let (low, high) = if cause == Cause::LightingTotal { (-h, 0.0) } else { (below, h) };
            let (less, more) = (at(low), at(high));
            let largest = slope.iter().fold(0.0_f64, |most, d| most.max(d.abs()));
            for w in 0..slope.len() {
                let by_hand = (more[w] - less[w]) / (high - low) / tangent.sigma[w];
                assert!((by_hand - slope[w]).abs() < 2e-3 * largest, "{cause:?} {w}: {by_hand} {}", slope[w]);
            }
        }
    }
}

/// Gain, shift, scale and shape of the sky, temperature of the ground and a missing light, all off at once by a prior deviation or so: what is
/// estimated is within 4.5 deviations of the truth, 95 % intervals of 720 temperatures hold .93 to .97 (deviation .008), and the model is not
/// rejected; without it most intervals miss.
#[test]
fn shared_unknowns_are_estimated_with_the_pixels() {
    let told = told();
    let all = causes(&told.setting());
    let otherwise = Otherwise {
        gain: 0.01,
        shift_cm1: 3.0,
        sky: -0.03,
        tilt: 0.01,
        ground_k: 1.5,
        missing: 0.05,
        ..Otherwise::default()
    };
    let truth = [0.01, 3.0, -0.03, 0.01, 0.05, 1.5];
    let sigmas = [0.02, 4.0, 0.05, 0.02, 0.05, 2.0];
    let chosen = [0, 1, 2, 3, 5, 6];
    let unknowns: Vec<Unknown> =
        chosen.iter().zip(sigmas).map(|(i, sigma)| Unknown { cause: all[*i].clone(), sigma }).collect();
    let (mut held, mut missed, mut square) = (0, 0, 0.0);
    for seed in 1..4 {
        let mut random = generator(seed, 0);
        let cube = counted(|n| Poisson::new(n).unwrap().sample(&mut random), otherwise, &EXACT);
        let options = Options::default();
        let samples = [cube];
        let shared = estimate(&told, &unknowns, None, &options, &samples).unwrap();
        assert!(shared.settled && shared.pixels > PIXELS / 2 && shared.same.is_empty());
        for (i, truth) in truth.iter().enumerate() {
            let z = (shared.amounts[i] - truth) / shared.sigma(i);
            square += z * z;
            assert!(z.abs() < 4.5, "{:?}: {} of {truth}, {z} deviations", unknowns[i], shared.amounts[i]);
        }
        let here = shared.put_into(&told).unwrap();
        let setting = here.setting();
        let mut maps = decompose(&setting, &options, &samples[0], &|_| ()).unwrap();
        let others: Vec<Cause> = all.iter().filter(|one| !shared.causes().contains(one)).cloned().collect();
        let found = judge(&setting, &others, (None, Some(&shared)), &maps, &samples[0]).unwrap();
        for (i, other) in others.iter().enumerate() {
            let gain = found.fitting.alone(i).map_or(0.0, |alone| alone.gain_chi_square);
            assert!(gain < 20.25, "{other:?} is accused by {gain}");
        }
        let unaware = decompose(&told.setting(), &options, &samples[0], &|_| ()).unwrap();
        widen(&setting, &mut maps, &[], &[], Some(&shared)).unwrap();
        for i in 0..PIXELS {
            let t = state(i).1;
            let off = |maps: &Maps| {
                (f64::from(maps.temperature_k[i]) - t).abs() / f64::from(maps.temperature_sigma_k[i])
            };
            held += usize::from(off(&maps) < 1.96);
            missed += usize::from(off(&unaware) > 1.96);
        }
    }
    let count = (3 * PIXELS) as f64;
    assert!((0.93..0.975).contains(&(held as f64 / count)), "{}", held as f64 / count);
    assert!(missed as f64 > 0.5 * count, "{missed}");
    // χ² of 18 is 18 +- 6, less where the prior is all that is known and the truth within it.
    assert!(square < 40.0, "{square}");
}

/// The prior alone where nothing is told; two that are one are named; a prior without a width is refused.
#[test]
fn what_pixels_do_not_tell_stays_as_stated() {
    let told = told();
    let all = causes(&told.setting());
    let of = |i: usize, sigma: f64| Unknown { cause: all[i].clone(), sigma };
    let cube = [counted(|n| n, Otherwise::default(), &EXACT)];
    let twice = estimate(&told, &[of(0, 0.02), of(0, 0.01)], None, &Options::default(), &cube).unwrap();
    assert_eq!(twice.same, [[0, 1]]);
    // Their sum is told, their difference is not: 1/σ² of it is that of both priors.
    let difference = twice.sigma_of(&[1.0, -1.0]);
    let sum = twice.sigma_of(&[1.0, 1.0]);
    assert!(sum < 1e-3 && difference > 0.01, "{sum} {difference}");
    assert!(estimate(&told, &[of(0, 0.0)], None, &Options::default(), &cube).is_err());
    // A cube of fewest counts, of which every pixel may be anything.
    let few = [counted(|n| (1e-5 * n).round(), Otherwise::default(), &EXACT)];
    let mut faint = told.clone();
    faint.counts_per_radiance.iter_mut().for_each(|k| *k *= 1e-5);
    let prior = estimate(&faint, &[of(0, 0.02)], None, &Options::default(), &few).unwrap();
    assert!(prior.pixels == 0 && prior.amounts == [0.0] && (prior.sigma(0) - 0.02).abs() < 1e-12);
}

/// Noise of 1.3 times its deviation is found, to 2 %, and χ² is then that of a right model.
#[test]
fn a_larger_noise_is_found() {
    let told = told();
    let mut random = generator(9, 0);
    let cube = counted(
        |n| {
            n + 1.3
                * n.sqrt()
                * <rand_distr::StandardNormal as Distribution<f64>>::sample(
                    &rand_distr::StandardNormal,
                    &mut random,
                )
        },
        Otherwise::default(),
        &EXACT,
    );
    let shared = estimate(&told, &[], Some(0.5), &Options::default(), &[cube]).unwrap();
    assert!((shared.noise / 1.3 - 1.0).abs() < 0.02, "{}", shared.noise);
}

/// A mirror among pixels that are nearly black, which none of the sample is: what is not known of the sky may move it by far more than its noise. It
/// is not decided, and may be anything; those that are nearly black stay decided.
#[test]
fn a_pixel_that_hangs_on_what_is_not_known_is_not_decided() {
    let mut told = told();
    told.lighting_total = None;
    let count = told.bands.nodes_cm1().len();
    told.library = vec![
        (0..count).map(|i| 0.99 + 0.005 * (0.3 * i as f64).sin()).collect(),
        (0..count).map(|i| 0.1 + 0.05 * (0.2 * i as f64).cos()).collect(),
    ];
    // A sky whose shape is not known, of which a mirror shows more than its strength.
    let cause = Cause::LightShape { light: 0, order: 1 };
    let tangents = Tangents::new(&told.setting()).unwrap();
    let cube = |materials: &[usize]| {
        let mut samples = Vec::new();
        for (i, m) in materials.iter().enumerate() {
            let mut mean = Vec::new();
            tangents.mean((*m, 290.0 + i as f64 % 15.0, &[0.6, 0.3]), &mut mean).unwrap();
            samples.extend(mean);
        }
        let shape = Shape::new(1, materials.len(), samples.len() / materials.len()).unwrap();
        Cube::F64(Box::new(MemoryCube::new(shape, samples).unwrap()))
    };
    let options = Options { categories: vec![1, 2], ..Options::default() };
    let black = [cube(&[0; 60])];
    let shared = estimate(&told, &[Unknown { cause, sigma: 0.3 }], None, &options, &black).unwrap();
    assert!(shared.pixels == 60 && shared.off_chi_square_mean.unwrap() < 0.1, "{shared:?}");
    let setting = told.setting();
    let both = cube(&[0, 0, 0, 1]);
    let mut maps = decompose(&setting, &options, &both, &|_| ()).unwrap();
    assert!((0..4).all(|i| maps.is_decided(i)), "{maps:?}");
    widen(&setting, &mut maps, &[], &[], Some(&shared)).unwrap();
    assert!((0..3).all(|i| maps.is_decided(i)) && !maps.is_decided(3), "{maps:?}");
    assert!(maps.possible_99[3] == u64::MAX && maps.possible_99[0] == 1);
}

/// A shape of a light that is counted is that of its bands, also where a band has several nodes.
#[test]
fn a_shape_of_counts_is_that_of_bands() {
    let mut told = told();
    told.bands = Bands::from_ranges(&[(800.0, 900.0), (900.0, 1000.0), (1000.0, 1100.0)]).unwrap();
    told.surroundings = vec![Light::Counts(vec![100.0; 3])];
    let tilted = told.with(&Cause::LightShape { light: 0, order: 1 }, 0.3).unwrap();
    let Light::Counts(counts) = &tilted.surroundings[0] else { panic!("{tilted:?}") };
    // Centres of the bands at −2/3, 0 and 2/3 of the range.
    for (n, expected) in counts.iter().zip([80.0, 100.0, 120.0]) {
        assert!((n - expected).abs() < 0.5, "{counts:?}");
    }
}

/// A calibration that errs by 0.3 % in each band and by 0.2 % in all, in all pixels alike: the gain, the sky and the air's light of 60 cubes without other noise
/// are off by as much as is said. 120 z of which those of a cube are dependent: their mean square is 1 within .35. Without it they are many deviations off.
#[test]
fn errors_that_all_pixels_have_alike_are_in_the_deviations() {
    let told = told();
    let all = causes(&told.setting());
    let sigmas = [0.05, 0.2];
    let unknowns: Vec<Unknown> =
        [0, 2].iter().zip(sigmas).map(|(i, sigma)| Unknown { cause: all[*i].clone(), sigma }).collect();
    let plain = [counted(|n| n, Otherwise::default(), &EXACT)];
    let (shape, samples) = match &plain[0] {
        Cube::F64(rows) => {
            (rows.shape(), rows.read(0..rows.shape().rows(), &mut Vec::new()).unwrap().to_vec())
        }
        Cube::F32(_) => panic!("f64"),
    };
    let bands = shape.bands();
    let mean = |w: usize| samples.iter().skip(w).step_by(bands).sum::<f64>() / (samples.len() / bands) as f64;
    let alike = Alike {
        of_bands: (0..bands).map(|w| 0.003 * mean(w)).collect(),
        together: (0..bands).map(|w| 0.002 * mean(w)).collect(),
    };
    // Noise of each pixel that covers it, as a table of noise does.
    let mut noisy = told;
    noisy.var_added = alike.of_bands.iter().zip(&alike.together).map(|(c, t)| c * c + t * t).collect();
    let options = Options { alike, ..Options::default() };
    let (mut square, mut unaware) = (0.0, 0.0);
    for seed in 0..60 {
        let mut random = generator(seed, 7);
        let mut z = || -> f64 { rand_distr::StandardNormal.sample(&mut random) };
        let common = z();
        let off: Vec<f64> = (0..bands)
            .map(|w| options.alike.of_bands[w] * z() + options.alike.together[w] * common)
            .collect();
        let counts: Vec<f64> = samples.iter().enumerate().map(|(i, n)| n + off[i % bands]).collect();
        let cube = [Cube::F64(Box::new(MemoryCube::new(shape, counts).unwrap()))];
        let shared = estimate(&noisy, &unknowns, None, &options, &cube).unwrap();
        let without = estimate(&noisy, &unknowns, None, &Options::default(), &cube).unwrap();
        assert_eq!(shared.amounts, without.amounts);
        for i in 0..2 {
            square += (shared.amounts[i] / shared.sigma(i)).powi(2) / 120.0;
            unaware += (shared.amounts[i] / without.sigma(i)).powi(2) / 120.0;
        }
    }
    println!("{square} {unaware}");
    assert!((square - 1.0_f64).abs() < 0.35, "{square}");
    assert!(unaware > 4.0, "{unaware}");
}
