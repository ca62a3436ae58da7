//! What the proof rests on, piece by piece, against points drawn at random; whole proofs are held against a brute force that
//! shares no code with them in `hadar accuracy brute-force`.

mod amplitudes;
mod priors;

use super::amplitudes::Ray;
use super::metric::Metric;
use super::orthogonal::{inner, orthonormalise, reduce, reduced};
use super::prover::{Memory, Prover};
use super::sources::{Chord, chord};
use super::tangent::{self, slopes};
use crate::aligned::Aligned;
use crate::fisher::{Nuisance, Unknowns};
use crate::identifiability::nearest::residual::{self, Comparison};
use crate::identifiability::nearest::{NearestSolver, StateRange};
use crate::planck;
use crate::scene::{EnvironmentObject, State, Surroundings};
use crate::spectrum::Bands;

/// Numbers from 0 to 1.
fn draws(mut seed: u64) -> impl FnMut() -> f64 {
    move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
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
fn no_state_within_reach_is_below_the_quadratic() {
    let mut draw = draws(7);
    for _ in 0..2000 {
        let counts: Vec<f64> = (0..8).map(|_| 10.0 * draw()).collect();
        let noise: Vec<f64> = (0..8).map(|_| draw()).collect();
        let root: Vec<f64> = counts.iter().zip(&noise).map(|(n, v)| (n + v).sqrt()).collect();
        let scale = 10f64.powf(-4.0 * draw());
        let other: Vec<f64> = counts.iter().map(|n| n * (1.0 + scale * (2.0 * draw() - 1.0))).collect();
        let bands = other.iter().zip(&noise).zip(&root);
        let cost = bands.map(|((n, v), y)| (y - (n + v).sqrt()).powi(2)).sum::<f64>();
        let metric = Metric::about_target(&root, &counts, cost.sqrt() * (1.0 + draw()));
        let bands = other.iter().zip(metric.weight.iter().zip(&metric.shift));
        let below: f64 = bands.map(|(n, (w, h))| (n * w + h).powi(2)).sum();
        assert!(below <= cost * (1.0 + 1e-9) + 1e-13, "{below} {cost}");
    }
}

/// Dark bands of either side among them; what chords may miss, too.
#[test]
fn no_counts_are_below_a_tangent() {
    let mut draw = draws(8);
    let mut nearest = f64::INFINITY;
    for trial in 0..4000 {
        let mut bands = |dark: f64, most: f64| -> Vec<f64> {
            (0..8).map(|_| if draw() < dark { 0.0 } else { most * draw() }).collect()
        };
        let noise = if trial % 2 == 0 { vec![0.0; 8] } else { bands(0.3, 1.0) };
        let (own, centre, missed) = (bands(0.2, 10.0), bands(0.2, 10.0), bands(0.5, 0.5));
        let (other, wider) = (bands(0.2, 10.0), bands(0.5, 0.5));
        let sides: Vec<f64> = bands(0.0, 2.0).iter().map(|x| x - 1.0).collect();
        let root: Vec<f64> = own.iter().zip(&noise).map(|(n, v)| (n + v).sqrt()).collect();
        let mut pull = vec![0.0; 8];
        let bands =
            tangent::Bands { root: &root, own: &own, noise: &noise, counts: &centre, missed: &missed };
        let [cost, _] = slopes(bands, &root, &mut pull);
        let tangent = |counts: &[f64], wide: &[f64]| -> f64 {
            let change = |w: usize| pull[w] * (counts[w] - centre[w]) - pull[w].abs() * (wide[w] - missed[w]);
            cost + (0..8).map(change).sum::<f64>()
        };
        let separation = |counts: &[f64]| -> f64 {
            let root_of = |w: usize| (counts[w].max(0.0) + noise[w]).sqrt();
            (0..8).map(|w| (root[w] - root_of(w)).powi(2)).sum()
        };
        let seen: Vec<f64> = (0..8).map(|w| other[w] + sides[w] * wider[w]).collect();
        // Counts below none are not seen by the cost, and are no counts.
        if seen.iter().all(|n| *n >= 0.0) {
            let (below, apart) = (tangent(&other, &wider), separation(&seen));
            assert!(below <= apart + 1e-9 * (apart + below.abs()), "{trial}: {below} {apart}");
            nearest = nearest.min(apart - below);
        }
        // Within what is missed there is a state that costs as little.
        let best: Vec<f64> =
            (0..8).map(|w| own[w].clamp(centre[w] - missed[w], centre[w] + missed[w]).max(0.0)).collect();
        let dark: f64 = (0..8).filter(|w| root[*w] == 0.0).map(|w| (missed[w] - centre[w]).max(0.0)).sum();
        assert!((separation(&best) - cost - dark).abs() < 1e-9 * cost.abs() + 1e-10, "{trial}");
    }
    assert!(nearest < 1.0, "{nearest}");
}

/// Whole proofs: below every state drawn at random, and as near to the distance as was asked for.
#[test]
fn proofs_are_below_every_state_and_near_the_nearest() {
    let mut draw = draws(11);
    let bands = Bands::uniform(720.0, 1240.0, 20.0).unwrap();
    let nodes = bands.nodes_cm1().to_vec();
    let all = [Nuisance::Temperature, Nuisance::Lighting, Nuisance::Gain, Nuisance::EnvironmentTemperature];
    // With priors on all of them where each is a residual of the bound: without the gain, and one of lighting and surroundings.
    for (set, with_priors) in
        (1..16_usize).map(|set| (set, false)).chain([1, 2, 3, 8, 9].map(|set| (set, true)))
    {
        let unknown: Vec<Nuisance> = (0..4).filter(|i| set >> i & 1 == 1).map(|i| all[i]).collect();
        let mut unknowns = Unknowns::new(unknown.iter().copied()).unwrap();
        let photons = 1e4;
        let mut weights = [0.0; 4];
        for (i, nuisance) in all.iter().enumerate().filter(|(_, one)| with_priors && unknown.contains(one)) {
            let sigma = if *nuisance == Nuisance::Lighting { 0.02 } else { 2.0 };
            weights[i] = 0.5 / (sigma * f64::sqrt(photons));
            unknowns = unknowns.prior(*nuisance, sigma).unwrap();
        }
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
        let found = solver.per_photon(&target, &other, &state, photons).unwrap();
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
            let values = |at: &State| [at.temperature_k, at.lighting[0], at.gain.ln(), at.environment_k[0]];
            let off = values(&candidate).into_iter().zip(values(&state)).map(|(a, b)| a - b);
            let cost = cost + off.zip(weights).map(|(off, weight)| (weight * off).powi(2)).sum::<f64>();
            assert!(cost.sqrt() >= found.lower * (1.0 - 1e-9), "{set}: {} {found:?}", cost.sqrt());
        }
    }
}

/// Bands in which one side sends nothing count. Where the gain alone is unknown, d² = Σn − (Σ√(nm))²/Σm.
#[test]
fn dark_bands_of_either_side_are_part_of_a_proof() {
    let mut draw = draws(43);
    let bands = Bands::uniform(720.0, 1240.0, 40.0).unwrap();
    let nodes = bands.nodes_cm1().to_vec();
    let surroundings = Surroundings::new(&nodes, Vec::new()).unwrap();
    for trial in 0..60 {
        let state = surroundings.state(250.0 + 100.0 * draw(), &[]).unwrap();
        let mut wave = |dark: f64| -> Vec<f64> {
            nodes.iter().map(|_| if draw() < dark { 0.0 } else { 0.1 + 0.8 * draw() }).collect()
        };
        let (target, other) = (wave(0.2), wave(0.2));
        for unknown in
            [&[Nuisance::Gain][..], &[Nuisance::Temperature], &[Nuisance::Temperature, Nuisance::Gain]]
        {
            let unknowns = Unknowns::new(unknown.iter().copied()).unwrap();
            let mut solver =
                NearestSolver::new(&bands, &surroundings, unknowns, StateRange::default()).proving(1e-6);
            let found = solver.per_photon(&target, &other, &state, f64::INFINITY).unwrap();
            assert!(found.is_proved_to(1e-6) && found.lower > 0.0, "{trial} {unknown:?}: {found:?}");
            if unknown == [Nuisance::Gain] {
                let [n, m] = [&target, &other].map(|e| bands.weigh(&surroundings.signal(e, &state)));
                let all = |of: &[f64]| of.iter().sum::<f64>();
                let both: f64 = n.iter().zip(&m).map(|(n, m)| (n * m).sqrt()).sum();
                let exact = (1.0 - both * both / (all(&n) * all(&m))).sqrt();
                assert!((found.distance / exact - 1.0).abs() < 1e-9, "{trial}: {found:?} {exact}");
            }
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
        let columns = vec![Aligned::from(&first[..]), Aligned::from(&second[..])];
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
