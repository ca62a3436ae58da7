//! What amplitudes may be, and the least of what is linear, quadratic or a length over them, against points drawn at random.

use super::super::amplitudes::{Amplitudes, Piece, Pieces, Ray};
use super::super::hull::{Hull, Quadratic, factor_of};
use super::super::orthogonal::inner;
use super::draws;

/// Two pieces of the surface, two of object 0 and one of object 1.
fn pieces() -> Pieces {
    Pieces {
        source: vec![0, 0, 1, 1, 2],
        length: vec![1.0, 1.7, 0.4, 0.9, 0.6],
        cap: vec![f64::INFINITY, f64::INFINITY, 0.3, f64::INFINITY, f64::INFINITY],
        temperature_k: vec![0.0; 5],
        unit: vec![[1.0; 2]; 5],
    }
}

fn amplitudes(gain_free: bool, sum_known: bool) -> Amplitudes {
    let ranges = vec![[0.1, 0.8], [0.0, 0.7]];
    Amplitudes { gain_free, ranges, sum: 0.9, sum_known, total: 5.0, gain_cap: f64::INFINITY }
}

/// Amplitudes that are allowed, drawn anyhow.
fn allowed(draw: &mut impl FnMut() -> f64, of: &Amplitudes) -> Vec<f64> {
    loop {
        let v = [0.1 + 0.7 * draw(), if of.sum_known { 0.0 } else { 0.7 * draw() }];
        let v = [v[0], if of.sum_known { of.sum - v[0] } else { v[1] }];
        if v[0] + v[1] > of.sum + 1e-12 || v[1] > 0.7 || v[1] < 0.0 {
            continue;
        }
        let (a, b) = (draw(), draw());
        let mut z = vec![a, 1.0 - a, v[0] * b, v[0] * (1.0 - b), v[1]];
        if of.gain_free {
            let length = inner(&z, &pieces().length);
            let scale = (of.total / length).min(of.gain_cap) * draw();
            z.iter_mut().for_each(|z| *z *= scale);
        } else if z[2] > 0.3 {
            continue;
        }
        return z;
    }
}

#[test]
fn no_amplitudes_cost_less_than_the_cheapest() {
    let mut draw = draws(3);
    let free = [(true, false), (true, true)];
    let known = [(false, false, f64::INFINITY), (false, true, f64::INFINITY)];
    let capped = [f64::INFINITY, 3.3, 2.6, 0.5].into_iter();
    let capped = capped.flat_map(|cap| free.map(|(gain, sum)| (gain, sum, cap)));
    let mut both = 0;
    for (gain_free, sum_known, gain_cap) in known.into_iter().chain(capped) {
        let of = Amplitudes { gain_cap, ..amplitudes(gain_free, sum_known) };
        for _ in 0..200 {
            let cost: Vec<f64> = (0..5).map(|_| draw() - 0.6).collect();
            let mut vertex = vec![0.0; 5];
            let least = of.least(&pieces(), &cost, &mut vertex, &mut Ray::default());
            assert!((inner(&cost, &vertex) - least).abs() < 1e-12 * (1.0 + least.abs()));
            if gain_free && least < 0.0 {
                // It is allowed itself.
                let (gain, length) = (vertex[0] + vertex[1], inner(&vertex, &pieces().length));
                assert!(gain <= gain_cap * (1.0 + 1e-12) && length <= of.total * (1.0 + 1e-12));
                both += u32::from(gain > 0.999 * gain_cap && length > 0.999 * of.total);
            }
            let mut lowest = f64::INFINITY;
            for _ in 0..300 {
                lowest = lowest.min(inner(&cost, &allowed(&mut draw, &of)));
            }
            assert!(least <= lowest + 1e-12, "{least} {lowest}");
            // Caps aside it is reached, not only kept below.
            if vertex[2] <= 0.3 || gain_free {
                assert!(lowest - least < 0.8 * (1.0 + least.abs()), "{least} {lowest}");
            }
        }
    }
    assert!(both > 50, "{both}");
}

/// Where costs are all but a multiple of lengths any ray is as good as another one, but for rounding; both limits bind.
#[test]
fn nothing_costs_less_where_all_cost_alike() {
    let mut draw = draws(41);
    let mut within = 0;
    for trial in 0..40_000 {
        let mut own = pieces();
        own.length.iter_mut().for_each(|length| *length = 0.1 + 2.0 * draw());
        let price = 10f64.powf(4.0 * draw() - 2.0);
        let last_digit = |x: f64, draw: &mut dyn FnMut() -> f64| x * (1.0 + 4e-16 * (draw() - 0.5));
        let cost: Vec<f64> = own.length.iter().map(|length| last_digit(-price * length, &mut draw)).collect();
        let ranges = vec![[0.0, 1.0], [0.0, 1.0]];
        let of = Amplitudes {
            ranges,
            sum: 1.0,
            gain_cap: 0.3 + draw(),
            total: 0.5 + draw(),
            ..amplitudes(true, false)
        };
        let (mut vertex, mut ray) = (vec![0.0; 5], Ray::default());
        let least = of.least(&own, &cost, &mut vertex, &mut ray);
        let lower = least - of.rounding(&own, &cost, &vertex, &ray);
        // The longest ray of the largest gain, or the total.
        let longest = own.length[0].max(own.length[1]) + own.length[2..].iter().copied().fold(0.0, f64::max);
        let exact = -price * of.total.min(of.gain_cap * longest);
        within += u32::from(of.total < of.gain_cap * longest);
        assert!(lower <= exact * (1.0 - 1e-14), "{trial}: {lower} {exact}");
        assert!(lower >= exact * (1.0 + 1e-11), "{trial}: {lower} {exact}");
    }
    assert!(within > 10_000, "{within}");
}

/// Two such rays that took each other's place until the steps ran out; the least by rational numbers.
#[test]
fn rays_that_alternate_do_not_hide_the_least() {
    let length = [
        0.691_845_986_622_443_6,
        0.759_434_529_539_388_7,
        0.774_519_193_638_224_5,
        0.449_188_684_031_161_86,
        1.404_612_397_134_735_5,
    ];
    let cost = [
        -0.085_246_468_008_691_58,
        -0.093_829_532_948_158_81,
        -0.095_433_126_648_503_45,
        -0.055_347_215_310_255_76,
        -0.173_070_666_148_565_45,
    ];
    let own = Pieces { source: vec![0, 0, 1, 2, 3], length: length.to_vec(), ..pieces() };
    let of = Amplitudes {
        ranges: vec![[0.0, 1.0]; 3],
        sum: 1.000_000_000_000_001,
        gain_cap: 0.792_635_405_847_953_2,
        total: 1.027_877_535_811_033_5,
        ..amplitudes(true, false)
    };
    let (mut vertex, mut ray) = (vec![0.0; 5], Ray::default());
    let least = of.least(&own, &cost, &mut vertex, &mut ray);
    assert!((least + 0.126_85).abs() < 1e-5, "{least}");
}

/// Units of the sources may differ by any factor, and so the lengths of rays: a short one that is cheaper for its length is found
/// beside a long one whose rounding is more than all of it.
#[test]
fn a_cheaper_ray_is_found_however_short() {
    let mut draw = draws(17);
    let of = Amplitudes { gain_free: true, ..amplitudes(true, false) };
    let (mut short, mut known) = (0, 0);
    for trial in 0..4000 {
        let sum_known = trial % 2 == 1;
        let of = Amplitudes { sum_known, ranges: vec![[0.0, 0.8], [0.0, 0.7]], ..of.clone() };
        let scale = [0, 1, 2].map(|_| 10f64.powf(40.0 * draw() - 20.0));
        let mut own = pieces();
        let units = [0, 1, 2].map(|_| {
            let least = 10f64.powf(40.0 * draw() - 20.0);
            [least, least * 10f64.powf(25.0 * draw().powi(3))]
        });
        for (i, &source) in own.source.iter().enumerate() {
            own.length[i] *= scale[source];
            own.unit[i] = units[source];
        }
        let rate = 2.0 * draw() - 1.5;
        // Costs of the objects for their length nearly alike, so that what joins hangs on their last digits.
        let near = 10f64.powf(-18.0 * draw());
        let cost: Vec<f64> = (0..5)
            .map(|i| own.length[i] * (rate + if own.source[i] == 0 { 1.0 } else { near } * (draw() - 0.5)))
            .collect();
        let mut vertex = vec![0.0; 5];
        let mut ray = Ray::default();
        let least = of.least(&own, &cost, &mut vertex, &mut ray);
        if least.is_nan() {
            continue;
        }
        known += 1;
        let rounding = of.rounding(&own, &cost, &vertex, &ray);
        let longest = inner(&vertex, &own.length);
        assert!(longest <= of.total * (1.0 + 1e-14), "{trial}: {longest}");
        for end in 0..40 {
            // Surface at either end, and the objects dark, full, or anyhow: with one of them dark as far as that is allowed.
            let mut v = [0.8, 0.7].map(|most| most * [0.0, 1.0, draw()][end % 3]);
            if sum_known {
                v[0] = [0.2, 0.8, 0.2 + 0.6 * draw()][end % 3];
                v[1] = 0.9 - v[0];
            } else if v[0] + v[1] > 0.9 {
                v[end / 3 % 2] = 0.0;
            }
            let [a, b] = [end / 6 % 2, end / 12 % 2].map(|side| side as f64);
            let [at, first, second] = [0, 1, 2]
                .map(|k| units[k][0] * (units[k][1] / units[k][0]).powf([0.0, 1.0, draw()][(end + k) % 3]));
            let z = [a / at, (1.0 - a) / at, v[0] * b / first, v[0] * (1.0 - b) / first, v[1] / second];
            let share = of.total / inner(&z, &own.length);
            let value = share * inner(&cost, &z);
            assert!(least - rounding <= value, "{trial}: {least:e} {rounding:e} {value:e}");
            short += usize::from(value < 0.9 * least.min(0.0) && v[0] + v[1] == 0.0);
        }
    }
    assert!(known > 3900 && short > 1000, "{known} {short}");
}

/// The bound of the hull against the same problem on a fine lattice of one amplitude.
#[test]
fn the_least_of_a_quadratic_is_bounded_tightly() {
    let of = Amplitudes {
        gain_free: false,
        ranges: vec![[0.0, 1.0]],
        sum: 1.0,
        sum_known: false,
        total: 0.0,
        gain_cap: f64::INFINITY,
    };
    let (mut pieces, mut ray) = (Pieces::default(), Ray::default());
    (0..2).for_each(|source| {
        let (cap, unit) = (f64::INFINITY, [1.0; 2]);
        pieces.put(Piece { source, length: 1.0, cap, temperature_k: 0.0, unit });
    });
    let mut draw = draws(5);
    for _ in 0..300 {
        let mut vector = || (0..3).map(|_| draw() - 0.5).collect::<Vec<f64>>();
        // φ = ‖F(z − z₀) + h‖² − ‖h‖².
        let (columns, shift) = ([vector(), vector()], vector());
        let product = |i: usize, j: usize| inner(&columns[i], &columns[j]);
        let (mut factor, mut excess) = (Vec::new(), Vec::new());
        factor_of(&[product(0, 0), product(0, 1), product(1, 0), product(1, 1)], &mut factor, &mut excess);
        let quadratic = Quadratic {
            linear: columns.iter().map(|column| 2.0 * inner(column, &shift)).collect(),
            factor,
            excess,
            origin: vec![0.3, 0.1],
            most: vec![1.0, 1.0],
            length: inner(&shift, &shift).sqrt(),
        };
        let value = |v: f64| {
            let change = [1.0 - 0.3, v - 0.1];
            let image: Vec<f64> =
                (0..3).map(|i| shift[i] + change[0] * columns[0][i] + change[1] * columns[1][i]).collect();
            inner(&image, &image) - inner(&shift, &shift)
        };
        let cheapest = |cost: &[f64], vertex: &mut [f64]| {
            of.least(&pieces, cost, vertex, &mut ray);
            0.0
        };
        let lower = Hull::default().least(&quadratic, cheapest, f64::INFINITY);
        let lowest = (0..=2000).map(|i| value(f64::from(i) / 2000.0)).fold(f64::INFINITY, f64::min);
        assert!(lower <= lowest + 1e-13, "{lower} {lowest}");
        assert!(lowest - lower < 1e-6, "{lower} {lowest}");
    }
}

/// A length less what is linear: below every mixture, and exact where the least needs nothing of the piece that takes away.
#[test]
fn lengths_less_what_is_linear_are_bounded() {
    let of = amplitudes(false, false);
    let mut draw = draws(23);
    let (mut exact, mut close) = (0, 0);
    for _ in 0..500 {
        let columns: Vec<Vec<f64>> = (0..5).map(|_| (0..6).map(|_| draw() - 0.3).collect()).collect();
        let shift: Vec<f64> = (0..6).map(|_| draw() - 0.3).collect();
        let square: Vec<f64> = (0..25).map(|i| inner(&columns[i / 5], &columns[i % 5])).collect();
        let (mut factor, mut excess) = (Vec::new(), Vec::new());
        factor_of(&square, &mut factor, &mut excess);
        let quadratic = Quadratic {
            linear: columns.iter().map(|column| 2.0 * inner(column, &shift)).collect(),
            factor,
            excess,
            origin: vec![0.0; 5],
            most: vec![1.0; 5],
            length: inner(&shift, &shift).sqrt(),
        };
        let less = [0.0, 0.0, 0.4 * draw(), 0.0, 0.4 * draw()];
        let (own, mut ray, mut hull) = (pieces(), Ray::default(), Hull::default());
        let mut cheapest = |cost: &[f64], vertex: &mut [f64]| {
            of.least(&own, cost, vertex, &mut ray);
            0.0
        };
        hull.least(&quadratic, &mut cheapest, f64::INFINITY);
        let lower = hull.length_less(&quadratic, &mut cheapest, &less);
        let length = |z: &[f64]| {
            let image: Vec<f64> =
                (0..6).map(|w| shift[w] + (0..5).map(|i| z[i] * columns[i][w]).sum::<f64>()).collect();
            inner(&image, &image).sqrt() - inner(&less, z)
        };
        let mut lowest = length(&hull.point);
        exact += usize::from(lower > lowest - 1e-9);
        for _ in 0..200 {
            lowest = lowest.min(length(&allowed(&mut draw, &of)));
        }
        assert!(lower <= lowest + 1e-12, "{lower} {lowest}");
        close += usize::from(lowest - lower < 0.3);
    }
    assert!(exact > 20 && close > 400, "{exact} {close}");
}
