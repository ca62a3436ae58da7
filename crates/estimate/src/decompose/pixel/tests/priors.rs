//! What a prior may not do: exclude what the counts leave.

use super::*;
use crate::decompose::LibraryError;

/// Prior of each other material to that of the one that matters.
const RATIOS: [f64; 5] = [1.0, 1e3, 1e5, 1e7, 1e9];
const PIXELS: usize = 1000;
/// Counts per radiance with which most pixels of the last material exclude the first, and not all.
const KAPPA: f64 = 1e-16;

/// Pixels of the first material and, every second one, of the last, which resembles it: the share of its own pixels in which the first is
/// excluded is 1 % at most whatever is stated of it before, with errors of the library or without, and the same with all bounds.
#[test]
fn no_prior_excludes_a_material_that_the_counts_leave() {
    for library_error in [None, Some(LibraryError { relative: 2e-3, correlation_cm1: 30.0 })] {
        let mut scene = Scene::new(KAPPA, 1, None);
        let nodes = scene.bands.nodes_cm1();
        scene.library[3] =
            scene.library[0].iter().zip(nodes).map(|(e, nu)| e + 0.01 * (nu / 40.0).sin()).collect();
        let mut random = generator(11, 0);
        let mut counts = Vec::new();
        for i in 0..PIXELS {
            let (t, v) = (random.random_range(285.0..315.0), random.random_range(0.1..0.6));
            let mean = scene.mean(if i % 2 == 0 { 0 } else { 3 }, t, &[v]);
            counts.extend(mean.iter().map(|n| Poisson::new(*n).unwrap().sample(&mut random)));
        }
        let shape = Shape::new(1, PIXELS, scene.bands.len()).unwrap();
        let cube = Cube::F64(Box::new(MemoryCube::new(shape, counts).unwrap()));
        let excluded = |ratio: f64, skipping: Skipping| -> Vec<bool> {
            let options = Options {
                prior: vec![1.0, ratio, ratio, ratio],
                categories: vec![1, 2, 2, 2],
                library_error,
                skipping,
                ..Options::default()
            };
            let maps = scene.with(|setting| decompose(setting, &options, &cube, &|_| ()).unwrap());
            (0..PIXELS).map(|i| maps.possible(i).at_99 & 1 == 0).collect()
        };
        for ratio in RATIOS {
            let found = excluded(ratio, Skipping::On);
            let of = |first: usize| found.iter().skip(first).step_by(2).filter(|is| **is).count();
            let (missed, others) = (of(0), of(1));
            assert!(missed * 200 <= PIXELS, "{missed} of {} at {ratio:e}, {library_error:?}", PIXELS / 2);
            // What never excludes anything would prove nothing.
            assert!(others * 10 > PIXELS, "{others} at {ratio:e}, {library_error:?}");
            assert_eq!(found, excluded(ratio, Skipping::Off), "{ratio:e}");
        }
    }
}
