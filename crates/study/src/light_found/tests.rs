//! A small cube with a sky above, things between and a ground below, its noise the same always.

use super::*;
use hadar::cube::{Cube, MemoryCube, Shape};
use hadar::planck::photon_radiance;

const ROWS: usize = 36;
const COLUMNS: usize = 30;
const BANDS: usize = 16;
const AIR_K: f64 = 288.0;
const GROUND_K: f64 = 284.0;
const KAPPA: f64 = 1e-14;

fn nu(band: usize) -> f64 {
    800.0 + 25.0 * band as f64
}

fn emissivity(band: usize) -> f64 {
    0.15 + 0.45 * (-((nu(band) - 1040.0) / 40.0).powi(2)).exp()
        + 0.4 * (-((nu(band) - 800.0) / 30.0).powi(2)).exp()
}

fn sky(band: usize) -> f64 {
    emissivity(band) * photon_radiance(nu(band), AIR_K)
}

/// Even numbers between -1 and 1, of variance 1/3.
fn even(i: usize) -> f64 {
    ((i * 7919 + i / 7 * 104_729) % 2003) as f64 / 1001.0 - 1.0
}

/// What a pixel of a row sends.
fn scene(row: usize, pixel: usize, band: usize) -> f64 {
    match row {
        0..8 => sky(band),
        8..18 => {
            let e = 0.5 + 0.3 * (nu(band) / 60.0).sin();
            e * photon_radiance(nu(band), 290.0 + 10.0 * even(pixel)) + (1.0 - e) * sky(band)
        }
        _ => 0.98 * photon_radiance(nu(band), GROUND_K + 0.5 * even(pixel)) + 0.02 * sky(band),
    }
}

fn samples(scene: impl Fn(usize, usize, usize) -> f64) -> Vec<f64> {
    let of = |i: usize| {
        let (pixel, band) = (i / BANDS, i % BANDS);
        let n = KAPPA * 25.0 * scene(pixel / COLUMNS, pixel, band);
        n + n.sqrt() * 3.0_f64.sqrt() * even(i)
    };
    (0..ROWS * COLUMNS * BANDS).map(of).collect()
}

/// A light that is looked for, and what is said of it.
fn found(samples: Vec<f64>, like: LightLike, rows: Option<[usize; 2]>) -> Result<(Vec<f64>, LightFound)> {
    let nodes: Vec<f64> = (0..BANDS).map(nu).collect();
    let bands = Bands::from_centers(&nodes)?;
    let widths = bands.widths_cm1();
    let kappa: Vec<f64> = widths.iter().map(|width| KAPPA * 25.0 / width).collect();
    let cube = MemoryCube::new(Shape::new(ROWS, COLUMNS, BANDS)?, samples)?;
    let readings = Readings {
        bands: &bands,
        bad_bands: &[3],
        counts_per_radiance: &kappa,
        var_added: &[],
        units_per_count: 1.0,
    };
    let cube = Cube::F64(Box::new(cube));
    let looked = Looked::at(&cube, readings)?;
    let (light, found) = looked.find(1, (like, rows))?;
    let Light::Counts(counts) = light else { unreachable!("found in counts") };
    Ok((counts, found))
}

/// Largest share by which counts of the bands that count are off.
fn off(counts: &[f64], expected: impl Fn(usize) -> f64) -> f64 {
    let share = |band: usize| (counts[band] / (KAPPA * 25.0 * expected(band)) - 1.0).abs();
    (0..BANDS).filter(|band| *band != 3).map(share).fold(0.0, f64::max)
}

fn ground(band: usize) -> f64 {
    0.98 * photon_radiance(nu(band), GROUND_K) + 0.02 * sky(band)
}

/// Medians of 240 and 540 pixels: noise of a sample (1 % to 2 %) by the root of their number, times five; of the ground also five deviations
/// (12 mK each) of the median of its temperatures.
#[test]
fn sky_and_ground_are_what_is_there() {
    let (counts, found_sky) = found(samples(scene), LightLike::Sky, None).unwrap();
    assert!(off(&counts, sky) < 6e-3, "{}", off(&counts, sky));
    assert_eq!((found_sky.pixels, found_sky.pixels_asked, found_sky.light), (240, ROWS * COLUMNS, 1));
    assert!(found_sky.scale_sigma.unwrap() >= SCALE && found_sky.shape_sigma >= SKY_SHAPE);
    assert_eq!((found_sky.path_sigma, found_sky.temperature_sigma_k), (Some(PATH), None));
    // A band that is left out has no light either.
    assert_eq!(counts[3], 0.0);
    let (counts, found) = found(samples(scene), LightLike::Ground, None).unwrap();
    assert!(off(&counts, ground) < 5e-3, "{}", off(&counts, ground));
    assert!(found.pixels > 500 && found.pixels_asked == ROWS / 2 * COLUMNS, "{found:?}");
    let sigma_k = found.temperature_sigma_k.unwrap();
    assert!((super::GROUND_K..1.5).contains(&sigma_k), "{sigma_k}");
}

/// Whatever is put into one pixel, what is found moves by no more than a neighbour in the order of a median.
#[test]
fn a_spoilt_pixel_moves_the_median_only() {
    for like in [LightLike::Sky, LightLike::Ground] {
        let (before, _) = found(samples(scene), like, None).unwrap();
        for place in [5, 300, 700, 1000] {
            for value in [0.0, f64::NAN, 1e36, -1e20, 1.0] {
                let mut samples = samples(scene);
                samples[place * BANDS..(place + 1) * BANDS].fill(value);
                let (after, _) = found(samples, like, None).unwrap();
                for (a, b) in before.iter().zip(&after).filter(|(a, _)| **a > 0.0) {
                    assert!((a / b - 1.0).abs() < 2e-3, "{like:?} {place} {value}: {a} {b}");
                }
            }
        }
    }
}

/// Where nothing is like a sky none is invented: a room, and a wall that is cold in all bands; that one is taken where its rows are named.
#[test]
fn what_is_no_sky_is_refused() {
    let room = samples(|_, pixel, band| photon_radiance(nu(band), 293.0 + 0.3 * even(pixel)));
    let told = found(room.clone(), LightLike::Sky, None).unwrap_err().to_string();
    assert!(told.contains("K colder than all others") || told.contains("alike"), "{told}");
    found(room.clone(), LightLike::Sky, Some([0, 8])).unwrap_err();
    let with_wall = |row: usize, pixel: usize, band: usize| match row {
        0..8 => photon_radiance(nu(band), 262.0),
        _ => scene(ROWS - 1, pixel, band),
    };
    let told = found(samples(with_wall), LightLike::Sky, None).unwrap_err().to_string();
    assert!(told.contains("as a cold wall does") && told.contains("name rows"), "{told}");
    let (_, wall) = found(samples(with_wall), LightLike::Sky, Some([0, 8])).unwrap();
    assert_eq!(wall.pixels, 240);
    // A room has a ground, mirrors have none, nor has a cube rows that it does not have.
    found(room, LightLike::Ground, None).unwrap();
    let told = found(samples(|_, _, band| sky(band)), LightLike::Ground, None).unwrap_err().to_string();
    assert!(told.contains("what a blackbody does"), "{told}");
    let told = found(samples(scene), LightLike::Sky, Some([0, ROWS + 1])).unwrap_err().to_string();
    assert!(told.contains("a cube of 36"), "{told}");
}

/// Twenty pixels darker than the sky are not taken for it.
#[test]
fn a_few_darker_pixels_are_passed_over() {
    let mut samples = samples(scene);
    samples[400 * BANDS..420 * BANDS].iter_mut().for_each(|n| *n *= 0.05);
    let (counts, found) = found(samples, LightLike::Sky, None).unwrap();
    assert!(found.pixels == 240 && off(&counts, sky) < 6e-3, "{found:?}");
}

/// The emissivity of its air is that by which a sky was made, at the temperature of its brightest band or the one that is told.
#[test]
fn the_air_of_a_sky_is_found() {
    let nodes: Vec<f64> = (0..BANDS).map(nu).collect();
    let bands = Bands::from_centers(&nodes).unwrap();
    let radiances: Vec<f64> =
        bands.widths_cm1().iter().enumerate().map(|(w, width)| width * sky(w)).collect();
    let found = air_of_sky((&bands, &[]), &radiances, Some(AIR_K));
    for (w, e) in found.iter().enumerate() {
        assert!((e - emissivity(w)).abs() < 1e-9, "{w}: {e}");
    }
    // Of no light nothing is known.
    assert!(air_of_sky((&bands, &[]), &[0.0; BANDS], None).iter().all(|e| *e == AIR[1]));
}
