//! Nearest distances in scenes that searches find hard: the search alone, as all of it once was, and the proof.
//!
//! The scenes are drawn as those of the brute force ([`super::brute_force`]), which also says what is right; the error of a
//! method is the share by which nine in ten of its distances are above that at most, its time that of the scene in the middle.

use super::brute_force::answer;
use super::brute_force::scene::{Scene, Set};
use super::chart::{Chart, Measured, ROUNDED};
use super::stress::draw::Draw;
use super::{Item, Order};
use crate::reference::brute_force::BruteForce;
use crate::reference::double_double::Real;
use crate::reference::local::{Noise, Pair};
use hadar::error::Result;
use std::time::Instant;

/// Scenes of a set of unknowns, and of a quick run.
const SCENES: u64 = 60;
const QUICK_SCENES: u64 = 6;
/// Shares of the scenes whose time and whose error are told.
const MIDDLE: f64 = 0.5;
const MOST: f64 = 0.9;
/// To what shares distances are proved; what is asked for where nothing else is, with one unknown temperature and with more.
const PROOFS: [f64; 3] = [1e-2, 1e-3, 1e-6];
const DEFAULT: [f64; 2] = [1e-6, 1e-3];
/// Share of the separation at the target's own state below which a distance is none.
const VANISHING: f64 = 1e-12;

pub(super) fn measure(order: Order) -> Result<Chart> {
    let open = Set { temperature: true, lighting: true, total_known: false, gain: false, environment: false };
    let gain = (Set { gain: true, ..open }, "gain unknown");
    let environment = (Set { environment: true, ..open }, "surroundings' temperatures unknown");
    let mut measured = Vec::new();
    for (set, unknown) in [gain, environment] {
        let count = if order.quick { QUICK_SCENES } else { SCENES };
        let posed: Vec<(Scene, f64)> =
            (0..count).filter_map(|case| posed(order.seed, case, set).transpose()).collect::<Result<_>>()?;
        let mut add = |method: &str, tolerance: Option<f64>| -> Result<()> {
            let (mut seconds, mut errors) = (Vec::new(), Vec::new());
            for (scene, least) in &posed {
                let start = Instant::now();
                let found = answer(scene, tolerance)?;
                seconds.push(start.elapsed().as_secs_f64());
                errors.push((found.distance / least - 1.0).max(ROUNDED));
            }
            let middle = at(MIDDLE, seconds);
            let default = tolerance == Some(DEFAULT[usize::from(set.environment)]);
            let method = format!("{method}, {unknown}");
            let measurement = Measured::new(method, tolerance.unwrap_or(f64::NAN), middle, at(MOST, errors));
            measured.push(measurement.default_if(default).answering(set.name()));
            Ok(())
        };
        add("search", None)?;
        for tolerance in PROOFS {
            add("proof", Some(tolerance))?;
        }
    }
    Ok(Chart {
        name: Item::NearestHard.name(),
        title: "Nearest distances in hard scenes",
        timed: "one distance",
        effort: "share of the distance to be proved",
        error: "share above the brute force, of nine in ten at most",
        reference: "a brute force in 31 digits, its best state",
        measured,
        remark: "Temperature and lighting are unknown as well. Few bands, equilibrium, materials nearly equal, ends of ranges. What is not proved says so; its distance \
                 counts here all the same."
            .into(),
    })
}

/// What that share of some values is no larger than.
fn at(share: f64, mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let place = (share * values.len() as f64).ceil() as usize;
    values.get(place.saturating_sub(1)).copied().unwrap_or(f64::NAN)
}

/// A scene with its distance, unless there is none.
fn posed(seed: u64, case: u64, set: Set) -> Result<Option<(Scene, f64)>> {
    let scene = Scene::draw(&mut Draw::new(seed, case), set)?;
    let found = answer(&scene, Some(PROOFS[PROOFS.len() - 1]))?;
    let force = BruteForce::new(&scene.bands, &scene.surroundings, &scene.unknowns, scene.range);
    let pair = Pair { emissivity: &scene.target, alternative: &scene.alternative, state: &scene.state };
    let noise = scene.counting.as_ref().map_or(Noise::PerPhoton { photons: f64::INFINITY }, Noise::Counting);
    let Some(lattice) = force.nearest(pair, noise) else { return Ok(None) };
    let least =
        lattice.distance.to_f64().min(force.nearest_from(pair, &found.state, noise).distance.to_f64());
    let own = force.separation(pair, &scene.state, noise).to_f64();
    Ok((least > VANISHING * own).then_some((scene, least)))
}
