//! What a calibration leaves in all pixels alike is counted once in a decomposition: by drawing the whole chain many times.
//!
//! Each draw has blackbodies that are off by what is stated of them, readings with noise, and a scene of one pixel. The table `sigma.csv` is that of
//! the first: deviations depend on no draw. Temperatures over their stated deviations then have a mean square of 1: 800 draws know it to
//! √(2/800) = 0.05.

use crate::support::folder::Folder;
use hadar::cube::{Cube, Shape};
use hadar::planck::photon_radiance;
use hadar_formats::cube::{open, write_npy};
use hadar_scenario::calibrate::BlackbodyScenario;
use hadar_study::calibrate::BlackbodyStudy;

const BANDS: [f64; 3] = [800.0, 950.0, 1100.0];
const DRAWS: usize = 800;
const NOISE: f64 = 2.0;
/// The room, which a wall of emissivity 0.95 reflects, and the warmer blackbody, which the wall is about as bright as.
const ROOM_K: f64 = 283.15;
const WARM_K: f64 = 333.15;
const WALL_K: f64 = 335.15;
const UNCERTAIN_K: [f64; 2] = [0.04, 0.1];

const CALIBRATION: &str = "[bands]\nstart = \"800 cm^-1\"\nstop = \"1100 cm^-1\"\nstep = \"150 cm^-1\"\n\
    [[blackbody]]\ntemperature = \"10 degC\"\nuncertainty = \"40 mK\"\nemissivity = 1.0\ndata = \"cold.npy\"\n\
    [[blackbody]]\ntemperature = \"60 degC\"\nuncertainty = \"100 mK\"\nemissivity = 1.0\ndata = \"warm.npy\"\n\
    [noise]\nsample = 2.0\n[scene]\ndata = \"scene.npy\"\n";

const DECOMPOSITION: &str = "[cube]\ndata = \"drawn.npy\"\nunit = \"W m^-2 sr^-1 per cm^-1\"\nnoise = \"TABLE\"\n\
    [bands]\nstart = \"800 cm^-1\"\nstop = \"1100 cm^-1\"\nstep = \"150 cm^-1\"\n\
    [[environment]]\ntemperature = \"10 degC\"\n[library]\npath = \"library.csv\"\n\
    [unknown]\ntemperature = [\"300 K\", \"360 K\"]\nlighting_total = 1.0\n";

/// The noise of a stream of normal numbers.
fn normal(count: usize, stream: u64) -> Vec<f64> {
    use hadar::statistics::Statistics;
    use hadar_simulate::draws::{Draws, generator};
    let draws = Draws::new(&Statistics::Poisson, &vec![0.0; count]).unwrap();
    let draws = draws.with_electronic_noise(&vec![1.0; count]).unwrap();
    let mut out = vec![0.0; count];
    draws.draw_into(&mut generator(42, stream), &mut out);
    out
}

fn write(folder: &Folder, name: &str, size: [usize; 2], samples: &[f64]) {
    let shape = Shape::new(size[0], size[1], samples.len() / size[0] / size[1]).unwrap();
    write_npy(&folder.path().join(name), shape, samples).unwrap();
}

fn read(folder: &Folder, name: &str) -> Vec<f64> {
    let mut buffer = Vec::new();
    match open(&folder.path().join(name), None).unwrap() {
        Cube::F32(cube) => {
            let rows = cube.read(0..cube.shape().rows(), &mut buffer).unwrap();
            rows.iter().map(|x| f64::from(*x)).collect()
        }
        Cube::F64(_) => panic!("maps are of 32 bits"),
    }
}

/// Radiances of all draws, a pixel each; the files of the last one are left.
fn drawn(folder: &Folder, each: bool) -> Vec<f64> {
    let mut radiances = Vec::new();
    // Pixels of a blackbody; where each is calibrated for itself, there is one.
    let pixels = if each { 1 } else { 4 };
    for draw in 0..DRAWS {
        let z = normal(2 + (2 * pixels + 1) * BANDS.len(), draw as u64);
        let (off, mut noise) = (&z[..2], z[2..].iter());
        let mut cube = |name: &str, pixels: usize, radiance: &dyn Fn(f64) -> f64| {
            let samples: Vec<f64> = (0..pixels)
                .flat_map(|_| BANDS)
                .map(|nu| 1e-15 * radiance(nu) - 300.0 + NOISE * noise.next().unwrap())
                .collect();
            write(folder, name, [1, pixels], &samples);
        };
        cube("cold.npy", pixels, &|nu| photon_radiance(nu, ROOM_K + UNCERTAIN_K[0] * off[0]));
        cube("warm.npy", pixels, &|nu| photon_radiance(nu, WARM_K + UNCERTAIN_K[1] * off[1]));
        cube("scene.npy", 1, &|nu| 0.95 * photon_radiance(nu, WALL_K) + 0.05 * photon_radiance(nu, ROOM_K));
        let scenario = BlackbodyScenario::from_file(&folder.path().join("a.toml")).unwrap();
        let scene = BlackbodyStudy::new(&scenario).unwrap().calibrate().unwrap().scene.unwrap();
        radiances.extend(scene.radiance.iter().map(|x| f64::from(*x)));
    }
    radiances
}

/// The mean square of the errors over their deviations, with a table of noise.
fn mean_square(folder: &Folder, table: &str) -> f64 {
    folder.file("b.toml", &DECOMPOSITION.replace("TABLE", table));
    folder.json(&["decompose", "b.toml", "--out", "maps"]);
    let [found, sigma] =
        ["temperature_k", "temperature_sigma_k"].map(|name| read(folder, &format!("maps/{name}.npy")));
    assert_eq!(found.len(), DRAWS);
    found.iter().zip(&sigma).map(|(t, sigma)| ((t - WALL_K) / sigma).powi(2)).sum::<f64>() / DRAWS as f64
}

#[test]
fn what_all_pixels_have_in_common_is_counted_once() {
    for each in [false, true] {
        let text = match each {
            true => CALIBRATION.replace("\"scene.npy\"", "\"scene.npy\"\nresponse = \"each-pixel\""),
            false => CALIBRATION.to_owned(),
        };
        let folder = Folder::with(&text);
        folder.file("library.csv", "wavenumber_cm1,wall\n700,0.95\n1300,0.95\n");
        let radiances = drawn(&folder, each);
        write(&folder, "drawn.npy", [1, DRAWS], &radiances);
        folder.json(&["calibrate", "blackbody", "a.toml", "--out", "out"]);
        let once = std::fs::read_to_string(folder.path().join("out/sigma.csv")).unwrap();
        let rows = once.lines().skip(1).map(|line| {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            // With the part of all bands in the part of each band too, as it was.
            format!("{},{},{},{},{}", cells[0], cells[1], cells[2], cells[3].hypot(cells[4]), cells[4])
        });
        let rows: Vec<String> = rows.collect();
        folder.file("twice.csv", &format!("{}\n{}\n", once.lines().next().unwrap(), rows.join("\n")));
        let [once, twice] = ["out/sigma.csv", "./twice.csv"].map(|table| mean_square(&folder, table));
        println!("mean square of errors over deviations: {once} counted once, {twice} twice");
        assert!((0.9..=1.1).contains(&once) && twice < 0.85, "{each}: {once} {twice}");
    }
}
