//! What the proof rests on, piece by piece, against points drawn at random; whole proofs are held against a brute force that
//! shares no code with them in `hadar accuracy brute-force`.

use super::amplitudes::{Amplitudes, Pieces};
use super::amplitudes::{Piece, Ray};
use super::hull::{Hull, Quadratic, factor_of};
use super::metric::{Ellipsoid, Metric};
use super::orthogonal::{inner, orthonormalise, reduce, reduced};
use super::prover::{Memory, Prover};
use super::sources::{Chord, chord};
use crate::fisher::{Nuisance, Unknowns};
use crate::identifiability::nearest::residual::{self, Comparison};
use crate::identifiability::nearest::{NearestSolver, StateRange};
use crate::planck;
use crate::scene::{EnvironmentObject, Surroundings};
use crate::spectrum::Bands;

/// Numbers from 0 to 1.
fn draws(mut seed: u64) -> impl FnMut() -> f64 {
    move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    }
}

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
    Amplitudes { gain_free, ranges, sum: 0.9, sum_known, total: 5.0, gain_cap: None }
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
            let scale = of.total / length * draw();
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
    for (gain_free, sum_known) in [(false, false), (false, true), (true, false), (true, true)] {
        let of = amplitudes(gain_free, sum_known);
        for _ in 0..200 {
            let cost: Vec<f64> = (0..5).map(|_| draw() - 0.6).collect();
            let mut vertex = vec![0.0; 5];
            let least = of.least(&pieces(), &cost, &mut vertex, &mut Ray::default());
            assert!((inner(&cost, &vertex) - least).abs() < 1e-12 * (1.0 + least.abs()));
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
        gain_cap: None,
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

#[test]
fn curves_lie_within_half_a_sag_of_the_lowered_chord() {
    for (a, b) in [(290.0, 310.0), (30.0, 300.0), (300.0, 1e6), (300.0, 300.1)] {
        let nodes: Vec<f64> = (1..=64).map(|i| 40.0 * f64::from(i)).collect();
        let spectrum = |t: f64| {
            let (mut value, mut slope) = (vec![0.0; nodes.len()], vec![0.0; nodes.len()]);
            planck::photon_radiance_and_slope_into(&nodes, t, &mut value, &mut slope);
            [value, slope]
        };
        let ([cold, cold_slope], [hot, hot_slope]) = (spectrum(a), spectrum(b));
        let [mut low, mut rise, mut half] = [(); 3].map(|()| vec![0.0; nodes.len()]);
        chord(Chord {
            width: b - a,
            more: 2e-15,
            cold: [&cold, &cold_slope],
            hot: [&hot, &hot_slope],
            low: &mut low,
            rise: &mut rise,
            half: &mut half,
        });
        let mut largest = 0.0_f64;
        for step in 0..=50 {
            let share = f64::from(step) / 50.0;
            let [value, _] = spectrum(a + share * (b - a));
            for (j, value) in value.iter().enumerate() {
                let middle = low[j] + share * rise[j];
                let off = (value - middle).abs();
                assert!(off <= half[j] * (1.0 + 1e-9) + 1e-14 * value, "{a} {b} {j}: {off} {}", half[j]);
                largest = largest.max(off / half[j]);
            }
        }
        assert!(largest > 0.9, "{a} {b}: {largest}");
    }
}

#[test]
fn no_state_within_reach_is_below_a_quadratic() {
    let mut draw = draws(7);
    for _ in 0..2000 {
        let counts: Vec<f64> = (0..8).map(|_| 10.0 * draw()).collect();
        let noise: Vec<f64> = (0..8).map(|_| draw()).collect();
        let root: Vec<f64> = counts.iter().zip(&noise).map(|(n, v)| (n + v).sqrt()).collect();
        let scale = 10f64.powf(-4.0 * draw());
        let mut near =
            || counts.iter().map(|n| n * (1.0 + scale * (2.0 * draw() - 1.0))).collect::<Vec<f64>>();
        let (centre, other) = (near(), near());
        let separation = |other: &[f64]| {
            let bands = other.iter().zip(&noise).zip(&root);
            bands.map(|((n, v), y)| (y - (n + v).sqrt()).powi(2)).sum::<f64>()
        };
        let cost = separation(&other);
        let reach = cost.sqrt() * (1.0 + draw());
        let value = |metric: &Metric, about: &[f64]| {
            let bands = other.iter().zip(about).zip(metric.weight.iter().zip(&metric.shift));
            let square: f64 = bands.map(|((n, from), (w, b))| ((n - from) * w + b).powi(2)).sum();
            metric.cost + square - metric.length.powi(2)
        };
        let about = |centre: &[f64]| {
            let mut metric = Metric::default();
            let brightest: Vec<f64> = root.iter().map(|y| y + reach).collect();
            metric.put_about(centre, [&root, &counts, &noise], &brightest);
            value(&metric, centre)
        };
        for below in [value(&Metric::about_target(&root, &counts, reach), &[0.0; 8]), about(&centre)] {
            assert!(below <= cost * (1.0 + 1e-9) + 1e-13, "{below} {cost}");
        }
        // About the state itself it is exact.
        let exact = about(&other);
        assert!((exact - cost).abs() < 1e-9 * cost + 1e-14, "{exact} {cost}");
    }
}

/// Whole proofs: below every state drawn at random, and as near to the distance as was asked for.
#[test]
fn proofs_are_below_every_state_and_near_the_nearest() {
    let mut draw = draws(11);
    let bands = Bands::uniform(720.0, 1240.0, 20.0).unwrap();
    let nodes = bands.nodes_cm1().to_vec();
    let all = [Nuisance::Temperature, Nuisance::Lighting, Nuisance::Gain, Nuisance::EnvironmentTemperature];
    for set in 1..16_usize {
        let unknowns = Unknowns::new((0..4).filter(|i| set >> i & 1 == 1).map(|i| all[i])).unwrap();
        let object = EnvironmentObject { temperature_k: 260.0 + 60.0 * draw(), emissivity: None };
        let surroundings = Surroundings::new(&nodes, vec![object]).unwrap();
        let state = surroundings.state(280.0 + 60.0 * draw(), &[0.2 + 0.6 * draw()]).unwrap();
        let mut wave = || {
            let (a, b, c) = (0.5 + 0.4 * draw(), 0.08 * draw(), 40.0 + 200.0 * draw());
            nodes.iter().map(|nu| (a + b * (nu / c).sin()).clamp(0.05, 0.98)).collect::<Vec<f64>>()
        };
        let (target, other) = (wave(), wave());
        let tolerance = if set & 9 == 9 { 1e-3 } else { 1e-6 };
        let mut solver = NearestSolver::new(&bands, &surroundings, unknowns.clone(), StateRange::default())
            .proving(tolerance);
        let found = solver.per_photon(&target, &other, &state, f64::INFINITY).unwrap();
        assert!(found.is_proved_to(tolerance) && found.lower > 0.0, "{set}: {found:?}");
        assert!(found.lower <= found.distance, "{set}: {found:?}");
        let total: f64 = bands.weigh(&surroundings.signal(&target, &state)).iter().sum();
        for trial in 0..4000 {
            let mut candidate = if trial % 2 == 0 { found.state.clone() } else { state.clone() };
            let mut near = |x: f64| x * (1.0 + 10f64.powf(-5.0 * draw()) * (draw() - 0.5));
            if set & 1 == 1 {
                candidate.temperature_k = near(candidate.temperature_k);
            }
            if set & 2 == 2 {
                candidate.lighting[0] =
                    (near(candidate.lighting[0]) + 1e-3 * (near(1.0) - 1.0)).clamp(0.0, 1.0);
            }
            if set & 4 == 4 {
                candidate.gain = near(candidate.gain);
            }
            if set & 8 == 8 {
                candidate.environment_k[0] = near(candidate.environment_k[0]);
            }
            let signals = [(&target, &state), (&other, &candidate)]
                .map(|(e, state)| bands.weigh(&surroundings.signal(e, state)));
            let cost: f64 = (0..bands.len())
                .map(|w| ((signals[0][w] / total).sqrt() - (signals[1][w] / total).sqrt()).powi(2))
                .sum();
            assert!(cost.sqrt() >= found.lower * (1.0 - 1e-9), "{set}: {} {found:?}", cost.sqrt());
        }
    }
}

/// A state within reach, written as amplitudes of the pieces of any box that it lies in, costs no less than the cheapest, whatever
/// the costs; and the pieces are its spectrum but for what the chords may miss.
#[test]
fn states_within_reach_are_among_the_amplitudes_of_their_box() {
    let mut draw = draws(13);
    let bands = Bands::uniform(200.0, 1800.0, 100.0).unwrap();
    let nodes = bands.nodes_cm1().to_vec();
    let (mut cheapest, mut farthest, mut shapes) = (0.0_f64, 0.0_f64, 0);
    for trial in 0..3000 {
        let [gain_free, light_free, total] = [1, 2, 4].map(|bit| trial & bit > 0);
        let mut unknown = vec![Nuisance::Temperature, Nuisance::EnvironmentTemperature];
        unknown.extend(light_free.then_some(Nuisance::Lighting));
        unknown.extend(gain_free.then_some(Nuisance::Gain));
        let objects =
            [290.0, 250.0].map(|temperature_k| EnvironmentObject { temperature_k, emissivity: None });
        let surroundings = Surroundings::new(&nodes, objects.to_vec()).unwrap();
        let mut spectrum = || nodes.iter().map(|_| 0.02 + 0.96 * draw()).collect::<Vec<f64>>();
        let (own, other) = (spectrum(), spectrum());
        let mut any = |lit: [f64; 2]| {
            let mut state = surroundings.state(30.0 * 20f64.powf(draw()), &lit).unwrap();
            state.environment_k = vec![30.0 * 20f64.powf(draw()), 30.0 * 3000f64.powf(draw())];
            state
        };
        let (state, mut known) = (any([0.4, 0.3]), any([0.4, 0.3]));
        if light_free {
            let first = 0.7 * draw();
            known.lighting = vec![first, if total { 0.7 - first } else { (1.0 - first) * draw() }];
        }
        known.gain = if gain_free { 3f64.powf(2.0 * draw() - 1.0) } else { 1.0 };
        let known_total = (light_free && total).then_some(0.7);
        let unknowns = Unknowns::new(unknown).unwrap().lighting_total(known_total).unwrap();
        let mut comparison = Comparison::new(&bands, &surroundings, unknowns, StateRange::default());
        let metric = residual::Metric::PerPhoton { photons: f64::INFINITY };
        let target = comparison.aim(&own, &other, &state, metric).unwrap();
        let reach = comparison.cost(&target, &known).sqrt();
        let mut memory = Memory::default();
        let mut prover = Prover::new(&comparison, None, &mut memory, &target, reach);
        let temperatures = [known.temperature_k, known.environment_k[0], known.environment_k[1]];
        let mut ends = Vec::new();
        let width = [0.2, 2.0, 300.0][trial % 3];
        for (axis, t) in temperatures.into_iter().enumerate() {
            let faces = [t / (1.0 + width * draw().powi(2)), t * (1.0 + width * draw().powi(2))];
            ends.push(faces.map(|face| {
                let end = prover.end(axis, face);
                prover.all.know(axis, end, face);
                end
            }));
        }
        let (pieces, columns, halves) = prover.bounder.laid(&mut prover.all, &ends);
        let (mut point, mut off, mut missed) = (vec![0.0; 6], vec![0.0; bands.len()], vec![0.0; bands.len()]);
        for (s, t) in temperatures.into_iter().enumerate() {
            let amplitude = known.gain * if s == 0 { 1.0 } else { known.lighting[s - 1] };
            let [cold, hot] = [2 * s, 2 * s + 1];
            let shaped = pieces.unit[cold][0] < pieces.unit[cold][1];
            let along = |t: f64| if shaped { -1.0 / t } else { t };
            let [a, b] = [cold, hot].map(|i| along(pieces.temperature_k[i]));
            let share = (along(t) - a) / (b - a);
            let unit = if shaped { prover.all.sources.scale(t) } else { 1.0 };
            shapes += usize::from(shaped);
            (point[cold], point[hot]) = (amplitude * unit * (1.0 - share), amplitude * unit * share);
            let exact = prover.all.sources.spectrum(s, t);
            for w in 0..bands.len() {
                off[w] += (point[cold] + point[hot]) * columns[cold][w] + point[hot] * columns[hot][w]
                    - amplitude * exact.counts[w];
                missed[w] += amplitude * unit * halves[s][w] + 1e-14 * amplitude * exact.counts[w];
            }
        }
        for (off, missed) in off.iter().zip(&missed) {
            assert!(off.abs() <= *missed, "{trial}: {off} {missed}");
            farthest = farthest.max(off.abs() / missed);
        }
        let allowed = &prover.all.allowed;
        let mut vertex = vec![0.0; 6];
        for _ in 0..20 {
            let cost: Vec<f64> = point.iter().map(|z| (2.0 * draw() - 1.2) / z.max(1e-300)).collect();
            let least = allowed.least(&pieces, &cost, &mut vertex, &mut Ray::default());
            let own = inner(&cost, &point);
            let size: f64 = cost.iter().zip(&point).map(|(c, z)| (c * z).abs()).sum();
            assert!(
                least.is_nan() || least <= own + 1e-12 * size,
                "{trial}: {least} {own} {pieces:?} {point:?}"
            );
            cheapest = cheapest.max(if least < 0.0 && own < 0.0 { own / least } else { 0.0 });
        }
    }
    // The limits are nearly reached somewhere, so that looser ones would not have passed unseen.
    assert!(cheapest > 0.7 && farthest > 0.9 && shapes > 1000, "{cheapest} {farthest} {shapes}");
}

/// −s²f″/f never exceeds (as)²e^{−as}/24 (`sources`).
#[test]
fn shapes_are_all_but_convex() {
    let psi = |y: f64| y / -(-y).exp_m1();
    let mut largest = 0.0_f64;
    for i in 0..400 {
        let a = 0.05 * 1000f64.powf(f64::from(i) / 400.0);
        for j in 0..400 {
            let b = a * (1.0 + 1e-3 * 1e5f64.powf(f64::from(j) / 400.0));
            let (p, q) = (psi(a), psi(b));
            let bend = -(q * (2.0 * q - 2.0 * p - b) + p * a);
            let most = a * a * (-a).exp() / 24.0;
            assert!(bend <= most + 1e-14 * q * q, "{a} {b}: {bend} {most}");
            largest = largest.max(bend / most);
        }
    }
    assert!(largest > 0.9, "{largest}");
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

/// By products or one after the other: the same triangle, and no less of what is left.
#[test]
fn columns_are_reduced_alike_by_products() {
    let mut draw = draws(29);
    let (mut by_products, mut refused) = (0, 0);
    for trial in 0..400 {
        let near = 10f64.powf(-8.0 * draw());
        let first: Vec<f64> = (0..40).map(|_| draw()).collect();
        let second: Vec<f64> = first.iter().map(|x| x + near * (draw() - 0.5)).collect();
        let other: Vec<f64> = (0..40).map(|_| draw()).collect();
        let columns = vec![first, second];
        let mut basis = columns.clone();
        let (triangle, along) = reduce(&mut basis, &[&other]);
        let Some((quick, quick_along)) = reduced(&columns, &[&other]) else {
            assert!(near < 0.1, "{trial}: {near}");
            refused += 1;
            continue;
        };
        by_products += 1;
        let pairs = triangle.iter().flatten().zip(quick.iter().flatten());
        for (a, b) in pairs.chain(along[0].iter().zip(&quick_along[0])) {
            assert!((a - b).abs() < 1e-7 * triangle[0][0], "{trial} {near}: {a} {b}");
        }
        assert!(quick_along[0][2] >= along[0][2] * (1.0 - 1e-8), "{trial}");
        let mut straight = columns;
        orthonormalise(&mut straight, &quick);
        let off = basis.iter().zip(&straight).map(|(a, b)| a.iter().zip(b).map(|(a, b)| (a - b).abs()));
        assert!(off.flatten().all(|off| off < 1e-6), "{trial} {near}");
    }
    assert!(by_products > 50 && refused > 50, "{by_products} {refused}");
}

/// What a quadratic says of the states within reach: none of them has a brighter band.
#[test]
fn no_state_within_reach_is_brighter_than_told() {
    let mut draw = draws(31);
    let (mut within, mut narrowed, mut nearly) = (0, 0, 0.0_f64);
    for _ in 0..300 {
        let mut spectrum = |least: f64| (0..16).map(|_| least + draw()).collect::<Vec<f64>>();
        let (counts, columns) = (spectrum(1.0), vec![spectrum(0.2), spectrum(0.2)]);
        let noise = vec![0.1; 16];
        let root: Vec<f64> = counts.iter().map(|n| (n + 0.1).sqrt()).collect();
        let mixed = |z: &[f64; 2]| -> Vec<f64> {
            (0..16).map(|w| z[0] * columns[0][w] + z[1] * columns[1][w]).collect()
        };
        let cost = |n: &[f64]| -> f64 {
            n.iter().zip(&root).map(|(n, y)| (y - (n + 0.1).sqrt()).powi(2)).sum::<f64>()
        };
        let centre = [1.0 + 0.2 * (draw() - 0.5), 1.0 + 0.2 * (draw() - 0.5)];
        let about = mixed(&centre);
        let reach = cost(&about).sqrt() * (1.0 + 0.3 * draw());
        let mut brightest: Vec<f64> = root.iter().map(|y| y + reach).collect();
        let before = brightest.clone();
        for _ in 0..3 {
            let mut metric = Metric::default();
            metric.put_about(&about, [&root, &counts, &noise], &brightest);
            let mut basis: Vec<Vec<f64>> = columns
                .iter()
                .map(|column| column.iter().zip(&metric.weight).map(|(a, w)| a * w).collect())
                .collect();
            let (_, along) = reduce(&mut basis, &[&metric.shift]);
            let rest = metric.cost - metric.length * metric.length;
            let radius = (reach * reach - rest - along[0][2] * along[0][2]).max(0.0).sqrt();
            let missed = [0.0; 16];
            let ellipsoid =
                Ellipsoid { basis: &basis, along: &along[0], radius, counts: &about, missed: &missed };
            ellipsoid.lower(&metric.weight, &noise, &mut brightest);
        }
        narrowed += usize::from(brightest.iter().zip(&before).all(|(now, before)| now < before));
        for _ in 0..2000 {
            let size = 10f64.powf(-2.0 * draw());
            let state = mixed(&[centre[0] + size * (draw() - 0.5), centre[1] + size * (draw() - 0.5)]);
            if cost(&state).sqrt() >= reach {
                continue;
            }
            within += 1;
            for (n, most) in state.iter().zip(&brightest) {
                let s = (n + 0.1).sqrt();
                assert!(s <= *most, "{s} {most}");
                nearly = nearly.max(s / most);
            }
        }
    }
    assert!(within > 10_000 && narrowed > 200 && nearly > 0.99, "{within} {narrowed} {nearly}");
}
