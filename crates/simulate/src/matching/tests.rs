//! Matchers against naive sums, exact shifts and each other.

mod bound;

use super::block::{Block, Fit, Score};
use super::dense::disparity_map;
use super::likelihood::{Interpolation, Likelihood};
use super::texture::Texture;
use super::trials::{Centre, Matches, MatchingTrials, Noisy, Run, Setup};
use super::*;
use crate::draws::generator;
use hadar::cube::{Cube, MemoryCube, Shape};
use hadar::error::Error;
use hadar::ranging::noise::NoiseVariance;
use rand::RngExt;

fn window() -> Window {
    Window::new(5, 5).unwrap()
}

fn likelihood(interpolation: Interpolation) -> Matcher {
    Matcher::Likelihood(Likelihood { window: window(), interpolation })
}

/// Thirteen windows of a line, none of which overlap.
fn centres(disparity: f64) -> Vec<Centre> {
    (40..170).step_by(10).map(|column| Centre { row: 2, column, disparity }).collect()
}

fn run(
    texture: &Texture,
    bands: usize,
    disparity: f64,
    noise: &NoiseVariance,
    (noisy, matcher): (Noisy, Matcher),
    trials: usize,
) -> Matches {
    let shape = Shape::new(5, 200, bands).unwrap();
    let (left, right) = (texture.view(shape, 0.0).unwrap(), texture.view(shape, disparity).unwrap());
    let pair = StereoPair::new(shape, &left, &right).unwrap();
    let (search, centres) = (Search::new(0, 15).unwrap(), centres(disparity));
    let setup = Setup { pair: &pair, noise, noisy, matcher, search, centres: &centres };
    MatchingTrials::new(&setup).unwrap().run(Run { index: 0, trials, seed: 1 })
}

/// Bits, so that NaN would be compared too.
fn bits(matches: &[Match]) -> Vec<std::result::Result<u64, Failure>> {
    matches.iter().map(|found| found.map(f64::to_bits)).collect()
}

/// By the sums themselves, two passes.
fn naive(pair: &StereoPair, block: &Block, search: Search, row: usize, column: usize) -> Match {
    let shape = pair.shape();
    let half = [block.window.half_rows(), block.window.half_columns()];
    let window = |view: &[f64], column: usize, band: usize| -> Vec<f64> {
        let rows = row - half[0]..=row + half[0];
        let at = |row: usize, column: usize| (row * shape.columns() + column) * shape.bands() + band;
        rows.flat_map(|row| (column - half[1]..=column + half[1]).map(move |column| at(row, column)))
            .map(|at| view[at])
            .collect()
    };
    let scores: Vec<f64> = (search.least()..=search.most())
        .map(|d| {
            let to = column as i64 - i64::from(d);
            if to < half[1] as i64 || to + half[1] as i64 >= shape.columns() as i64 {
                return f64::NAN;
            }
            let [mut ll, mut rr, mut lr, mut off] = [0.0; 4];
            for band in 0..shape.bands() {
                let (l, r) = (window(pair.left(), column, band), window(pair.right(), to as usize, band));
                let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
                let (ml, mr) = (mean(&l), mean(&r));
                for (l, r) in l.iter().zip(&r) {
                    ll += (l - ml) * (l - ml);
                    rr += (r - mr) * (r - mr);
                    lr += (l - ml) * (r - mr);
                    off += (l - r) * (l - r);
                }
            }
            if block.score == Score::Correlation { lr / (ll * rr).sqrt() } else { -off }
        })
        .collect();
    let known: Vec<usize> = (0..scores.len()).filter(|i| !scores[*i].is_nan()).collect();
    let within = known.first().map_or(0..0, |first| *first..known[known.len() - 1] + 1);
    block.peak(&scores, within, search)
}

/// Noise has no peak in common: every score counts. Rows enough for running sums to start anew.
#[test]
fn running_sums_are_the_sums() {
    let mut rng = generator(4, 0);
    for (bands, rows, columns, score) in
        [(1, 3, 7, Score::Correlation), (3, 5, 3, Score::Correlation), (2, 1, 5, Score::SquaredDifferences)]
    {
        let shape = Shape::new(60, 37, bands).unwrap();
        let mut view =
            || -> Vec<f64> { (0..shape.len()).map(|_| 1e4 + 100.0 * rng.random::<f64>()).collect() };
        let (left, right) = (view(), view());
        let pair = StereoPair::new(shape, &left, &right).unwrap();
        let block = Block { window: Window::new(rows, columns).unwrap(), score, fit: Fit::Parabola };
        for search in [Search::new(-3, 9).unwrap(), Search::new(2, 60).unwrap()] {
            let map = disparity_map(&pair, &block, search).unwrap();
            for row in map.rows.clone() {
                for column in map.columns.clone() {
                    let (found, naive) =
                        (map.at(row, column).unwrap(), naive(&pair, &block, search, row, column));
                    match (found, naive) {
                        (Ok(found), Ok(naive)) => assert!((found - naive).abs() < 1e-7, "{row} {column}"),
                        other => assert_eq!(other.0, other.1, "{row} {column}"),
                    }
                }
            }
        }
    }
}

/// Windows of a line and those of a map are the same windows.
#[test]
fn a_line_is_a_row_of_the_map() {
    let texture = Texture::random(5, &[1e4, 3e4], 0.1, 0.25, 40).unwrap();
    let shape = Shape::new(9, 80, 2).unwrap();
    let (left, right) = (texture.view(shape, 0.0).unwrap(), texture.view(shape, 4.3).unwrap());
    let pair = StereoPair::new(shape, &left, &right).unwrap();
    let (block, search) = (Block::new(window()), Search::new(0, 9).unwrap());
    let map = disparity_map(&pair, &block, search).unwrap();
    // In any order, in several rows, up to the image's edge.
    let at = [(6, 77), (2, 20), (4, 33), (2, 60), (4, 2), (2, 19)];
    let centres = at.map(|(row, column)| Centre { row, column, disparity: 4.3 });
    let (noise, matcher) = (NoiseVariance::None, Matcher::Block(block));
    let setup = Setup { pair: &pair, noise: &noise, noisy: Noisy::Both, matcher, search, centres: &centres };
    let matches = MatchingTrials::new(&setup).unwrap().run(Run { index: 0, trials: 0, seed: 1 });
    for ((row, column), found) in at.into_iter().zip(&matches.noise_free) {
        match (map.at(row, column).unwrap(), *found) {
            (Ok(a), Ok(b)) => assert!((a - b).abs() < 1e-9, "{row} {column}"),
            (a, b) => assert_eq!(a, b),
        }
    }
    assert_eq!(matches.noise_free[4], Err(Failure::RangeEnd));
}

#[test]
fn a_whole_shift_is_found_exactly_and_gain_and_offset_do_not_matter() {
    let texture = Texture::random(6, &[1e4], 0.1, 0.25, 40).unwrap();
    let shape = Shape::new(40, 90, 1).unwrap();
    let (left, right) = (texture.view(shape, 0.0).unwrap(), texture.view(shape, 7.0).unwrap());
    let pair = StereoPair::new(shape, &left, &right).unwrap();
    let search = Search::new(0, 15).unwrap();
    let whole = Block { fit: Fit::Whole, ..Block::new(window()) };
    let map = disparity_map(&pair, &whole, search).unwrap();
    for column in 20..80 {
        assert_eq!(map.at(20, column), Some(Ok(7.0)), "{column}");
    }
    for kind in [Interpolation::Sinc, Interpolation::CubicSpline] {
        let matches = run(&texture, 1, 7.0, &NoiseVariance::None, (Noisy::Both, likelihood(kind)), 0);
        assert!(matches.noise_free.iter().all(|found| (found.unwrap() - 7.0).abs() < 1e-6), "{kind:?}");
    }
    let brighter: Vec<f64> = right.iter().map(|x| 3.7 * x + 5e4).collect();
    let other = StereoPair::new(shape, &left, &brighter).unwrap();
    let block = Block::new(window());
    let maps = [pair, other].map(|pair| disparity_map(&pair, &block, search).unwrap().matches);
    for (a, b) in maps[0].iter().zip(&maps[1]) {
        let [a, b] = [a, b].map(|found| found.unwrap_or(-1.0));
        assert!((a - b).abs() < 1e-8, "{a} {b}");
    }
}

#[test]
fn without_texture_there_is_no_disparity() {
    let shape = Shape::new(5, 60, 1).unwrap();
    let flat = vec![1e4; shape.len()];
    let pair = StereoPair::new(shape, &flat, &flat).unwrap();
    let search = Search::new(0, 15).unwrap();
    let centres = [30, 40].map(|column| Centre { row: 2, column, disparity: 7.0 });
    for matcher in [Matcher::Block(Block::new(window())), likelihood(Interpolation::Sinc)] {
        let noise = NoiseVariance::None;
        let setup =
            Setup { pair: &pair, noise: &noise, noisy: Noisy::Both, matcher, search, centres: &centres };
        let matches = MatchingTrials::new(&setup).unwrap().run(Run { index: 0, trials: 400, seed: 1 });
        assert_eq!(matches.noise_free, vec![Err(Failure::Flat); 2]);
        // Of noise alone any disparity is the best; 2 or 3 of 16 whole ones are within a pixel.
        let report = matches.report(&[], &Default::default()).unwrap();
        assert!(report.lost > 0.75, "{}", report.lost);
    }
}

#[test]
fn threads_and_the_way_noise_is_given_do_not_change_a_bit() {
    let texture = Texture::random(7, &[1e4, 2e4], 0.1, 0.25, 40).unwrap();
    let pools = [1, 3].map(|n| rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap());
    for matcher in [Matcher::Block(Block::new(window())), likelihood(Interpolation::CubicSpline)] {
        let shape = Shape::new(5, 200, 2).unwrap();
        let samples = [900.0_f32, 400.0].repeat(1000);
        let noises = [
            NoiseVariance::PerBand(vec![900.0, 400.0]),
            NoiseVariance::PerSample(Cube::from(MemoryCube::new(shape, samples).unwrap())),
        ];
        let of = |pool: usize, noise: usize| {
            pools[pool].install(|| run(&texture, 2, 6.3, &noises[noise], (Noisy::Both, matcher), 30)).trials
        };
        let first = bits(&of(0, 0));
        assert!(first.iter().filter(|found| found.is_ok()).count() > 300);
        assert_eq!(first, bits(&of(1, 0)));
        assert_eq!(first, bits(&of(1, 1)));
    }
    let shape = Shape::new(90, 70, 2).unwrap();
    let (left, right) = (texture.view(shape, 0.0).unwrap(), texture.view(shape, 4.3).unwrap());
    let pair = StereoPair::new(shape, &left, &right).unwrap();
    let search = Search::new(0, 9).unwrap();
    let map =
        |pool: usize| pools[pool].install(|| disparity_map(&pair, &Block::new(window()), search).unwrap());
    assert_eq!(bits(&map(0).matches), bits(&map(1).matches));
}

#[test]
fn what_does_not_fit_is_refused() {
    let shape = Shape::new(4, 30, 1).unwrap();
    let good = vec![100.0; shape.len()];
    let with = |value: f64| [vec![value], good[1..].to_vec()].concat();
    assert!(matches!(StereoPair::new(shape, &good, &good[1..]), Err(Error::Length { .. })));
    for bad in [f64::NAN, f64::INFINITY] {
        let message = StereoPair::new(shape, &good, &with(bad)).unwrap_err().to_string();
        assert!(message.contains("right view, row 0, column 0"), "{message}");
    }
    let pair = StereoPair::new(shape, &good, &good).unwrap();
    let search = Search::new(0, 5).unwrap();
    assert!(disparity_map(&pair, &Block::new(window()), search).is_err());
    assert!(Search::new(0, 1).is_err() && Search::new(i32::MIN, i32::MAX).is_err());
    let small = Matcher::Block(Block::new(Window::new(3, 3).unwrap()));
    let negative = with(-1.0);
    let negative = StereoPair::new(shape, &negative, &good).unwrap();
    let fine = Centre { row: 1, column: 1, disparity: 2.0 };
    let none = NoiseVariance::None;
    let try_it = |pair: &StereoPair, matcher, noise: &NoiseVariance, centres: &[Centre]| {
        MatchingTrials::new(&Setup { pair, noise, noisy: Noisy::Both, matcher, search, centres }).is_ok()
    };
    assert!(try_it(&pair, small, &none, &[fine]));
    assert!(!try_it(&pair, likelihood(Interpolation::Sinc), &none, &[fine]));
    assert!(!try_it(&negative, small, &none, &[fine]));
    assert!(!try_it(&pair, small, &none, &[]));
    assert!(!try_it(&pair, small, &NoiseVariance::Uniform(-1.0), &[fine]));
    assert!(!try_it(&pair, small, &NoiseVariance::PerBand(vec![1.0; 2]), &[fine]));
    for wrong in [
        Centre { row: 0, ..fine },
        Centre { column: 29, ..fine },
        Centre { column: usize::MAX, ..fine },
        Centre { disparity: 6.0, ..fine },
        Centre { disparity: f64::NAN, ..fine },
    ] {
        assert!(!try_it(&pair, small, &none, &[wrong]), "{wrong:?}");
    }
}
