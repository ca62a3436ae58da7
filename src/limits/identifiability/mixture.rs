//! The least distance between mixtures of the members of two classes, with a proof.
//!
//! A pixel may hold several members of a class: its emissivity is Σ p_i e_i, p ≥ 0, Σp = 1, at one temperature. For a given temperature
//! T′ of the alternative the counts of both sides are linear in the shares, and ‖√(N + v) − √(M + v)‖² is jointly convex in them (`hull`); over T′ a
//! branch and bound goes (`boxes`). Parts of the alternative may each have a lighting of their own within the range, by which the problem
//! stays convex: [`MixtureDistance::lower`] holds for all such mixtures and so for those in one lighting, in which
//! [`MixtureDistance::distance`] is attained.
//!
//! Symbols: e emissivities at the nodes; T, T′ temperatures, K; V lighting factors; N, M counts; v variance beside that of the photons.
//!
//! Assumptions: the unknowns are temperature and lighting, or none of them; no priors; parts of a pixel are of one temperature, and the target's of
//! one lighting, which is known. Up to four surroundings.
//!
//! Source: design of the project ('Two facts to build on').

mod boxes;
mod hull;
mod scene;

use self::boxes::Interval;
use self::hull::{Hulls, Mixed};
use self::scene::{Scene, Side};
use super::multi::LibraryScene;
use crate::best_first::BestFirst;
use crate::error::{Error, Result};
use crate::fisher::{Counting, Nuisance};
use crate::scene::State;
use crate::sum;

/// Intervals of temperature that are looked at before the search gives up.
const MOST_BOXES: u64 = 4_000;
/// Turns between shares and state.
const TURNS: usize = 12;
/// Share of a distance that a turn must win.
const WORTH: f64 = 1e-5;
const MOST_OBJECTS: usize = 4;

/// Two classes whose members mix.
#[derive(Debug, Clone, Copy)]
pub struct Mixtures<'m> {
    /// What they share.
    pub scene: &'m LibraryScene<'m>,
    /// Emissivities of the target's members.
    pub targets: &'m [&'m [f64]],
    /// Emissivities of the alternative's.
    pub alternatives: &'m [&'m [f64]],
    /// A camera's counting; without one distances are per √photon of the target.
    pub counting: Option<&'m Counting>,
}

/// The least distance found, and what is proved.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct MixtureDistance {
    /// Distance of the two mixtures, every part in the same lighting.
    pub distance: f64,
    /// No mixture is nearer.
    pub lower: f64,
    /// Shares of the target's members.
    pub target: Vec<f64>,
    /// Shares of the alternative's.
    pub alternative: Vec<f64>,
    /// The alternative's nearest state.
    pub state: State,
    /// Intervals of temperature that the proof took.
    pub boxes: usize,
}

impl Mixtures<'_> {
    /// The least distance of mixtures, proved to `tolerance` of itself, or of `enough`, where that takes no more than some thousand
    /// intervals. Nobody asks for what is farther than `enough`, where the proof may end.
    ///
    /// # Errors
    /// Unknowns other than temperature and lighting, priors, more than four surroundings; a scene without photons.
    pub fn nearest(&self, tolerance: f64, enough: f64) -> Result<MixtureDistance> {
        let scene = self.checked()?;
        let range_k = match self.scene.unknowns.contains(Nuisance::Temperature) {
            true => self.scene.range.temperature_k,
            false => [self.scene.state.temperature_k; 2],
        };
        let start = Mixed {
            shares: [
                vec![1.0 / self.targets.len() as f64; self.targets.len()],
                vec![1.0; self.alternatives.len() * scene.lightings.len()],
            ],
            cost: f64::INFINITY,
        };
        let mut search = BestFirst::new(MOST_BOXES);
        search.push(0.0, 0, (range_k, start));
        let mut best: Option<(Mixed, f64)> = None;
        // There is always one look.
        let proved = |lower: f64, best: &Option<(Mixed, f64)>| {
            best.as_ref().is_some_and(|(best, _)| {
                // Of what is far nearer than anybody asks for only that is of interest.
                let close = enough.is_finite() && best.cost.sqrt() - lower.sqrt() <= tolerance * enough;
                lower >= best.cost * (1.0 - tolerance).powi(2) || lower >= enough * enough || close
            })
        };
        while let Some((lower, (ends_k, start))) = search.take(|lower| proved(lower, &best)) {
            search.look();
            let [cold, hot] = ends_k;
            let middle = (cold * hot).sqrt().clamp(cold, hot);
            let (found, plane) = scene.at(middle, start);
            if best.as_ref().is_none_or(|(best, _)| found.cost < best.cost) {
                best = Some((found.clone(), middle));
            }
            let bound = |ends_k| scene.bound(&Interval::new(self.scene.bands.nodes_cm1(), ends_k), &plane);
            let whole = bound(ends_k).max(lower);
            let least = best.as_ref().map_or(f64::INFINITY, |(best, _)| best.cost);
            let point = middle <= cold || middle >= hot;
            if point || whole >= least * (1.0 - tolerance).powi(2) {
                // It need not be cut; of a point the bound is all there is.
                search.push(whole, 0, (ends_k, found));
                if point {
                    break;
                }
                continue;
            }
            for ends_k in [[cold, middle], [middle, hot]] {
                search.push(bound(ends_k).max(whole), 0, (ends_k, found.clone()));
            }
        }
        let (best, temperature_k) = best
            .ok_or_else(|| Error::malformed("the alternative has no temperature in its range", "widen it"))?;
        let mut found = self.in_one_lighting(&scene, &best, temperature_k)?;
        // Shares and lighting together have more than one valley: from every corner, and from the middle of them.
        let count = scene.lightings.len() as f64;
        let objects = scene.light.len();
        let middle: Vec<f64> =
            (0..objects).map(|k| scene.lightings.iter().map(|v| v[k]).sum::<f64>() / count).collect();
        let mut lightings: Vec<Vec<f64>> = vec![middle.clone(), self.scene.state.lighting.clone()];
        for corner in &scene.lightings {
            lightings.push(corner.iter().zip(&middle).map(|(v, m)| 0.5 * (v + m)).collect());
            lightings.push(corner.clone());
        }
        if scene.lightings.len() > 1 {
            for lighting in lightings {
                crate::stop::check();
                let [cold, hot] = range_k;
                let own_k = self.scene.state.temperature_k.clamp(cold, hot);
                for kelvin in [temperature_k, own_k] {
                    let one = Scene { lightings: vec![lighting.clone()], ..scene.clone() };
                    let start = Mixed {
                        shares: [vec![1.0; self.targets.len()], vec![1.0; self.alternatives.len()]],
                        cost: f64::INFINITY,
                    };
                    let (start, _) = one.at(kelvin, start);
                    let other = self.in_one_lighting(&one, &start, kelvin)?;
                    if other.distance < found.distance {
                        found = other;
                    }
                }
            }
        }
        found.lower = search.bound().max(0.0).sqrt().min(found.distance);
        found.boxes = search.looked_at() as usize;
        Ok(found)
    }

    fn checked(&self) -> Result<Scene<'_>> {
        let LibraryScene { bands, surroundings, unknowns, range, state, .. } = self.scene;
        let other = Nuisance::ALL.into_iter().find(|nuisance| {
            unknowns.contains(*nuisance) && !matches!(nuisance, Nuisance::Temperature | Nuisance::Lighting)
        });
        if let Some(other) = other {
            let found = format!("mixtures of a class while {} is unknown", other.name());
            return Err(Error::malformed(found, "leave temperature and lighting unknown, or mixtures out"));
        }
        if unknowns.has_priors() {
            let found = "mixtures of a class beside priors, which have no part in a proof";
            return Err(Error::malformed(found, "leave the priors or the mixtures out"));
        }
        range.check()?;
        let objects = surroundings.objects().len();
        let lightings = if unknowns.contains(Nuisance::Lighting) {
            if objects > MOST_OBJECTS {
                let found = format!("mixtures of a class amid {objects} surroundings");
                return Err(Error::malformed(
                    found,
                    "put surroundings of one temperature together, up to four",
                ));
            }
            let total = unknowns.known_lighting_total();
            let [low, high] = range.lighting;
            let sum = total.unwrap_or(range.lighting_sum);
            corners(objects, [low.min(sum / objects.max(1) as f64), high], sum, total.is_some())?
        } else {
            vec![state.lighting.clone()]
        };
        let kappa = self.counting.map_or(1.0, |counting| counting.counts_per_radiance);
        let var_added: Vec<f64> =
            (0..bands.len()).map(|w| self.counting.map_or(0.0, |counting| counting.var_added(w))).collect();
        let counts: Vec<Vec<f64>> = self
            .targets
            .iter()
            .map(|emissivity| {
                let counts = bands.weigh(&surroundings.signal(emissivity, state));
                counts.iter().map(|n| kappa * n).collect()
            })
            .collect();
        let photons: Vec<f64> = counts.iter().map(|n| sum::sum(n)).collect();
        photons
            .iter()
            .try_for_each(|n| crate::error::check::positive("photons of the target", *n, "").map(drop))?;
        let photons = if self.counting.is_some() { vec![1.0; photons.len()] } else { photons };
        Ok(Scene {
            library: self.scene,
            own: Side { counts, photons },
            alternatives: self.alternatives,
            lightings,
            light: (0..objects).map(|k| surroundings.object_signal(k, state)).collect(),
            kappa,
            var_added,
        })
    }

    /// The mixtures in one lighting for all parts: shares and state in turn, the other held.
    fn in_one_lighting(
        &self,
        scene: &Scene<'_>,
        best: &Mixed,
        temperature_k: f64,
    ) -> Result<MixtureDistance> {
        crate::stop::check();
        let lit = scene.lightings.len();
        let mut own: Vec<f64> = best.shares[0].iter().zip(&scene.own.photons).map(|(s, d)| s / d).collect();
        let mut other: Vec<f64> = best.shares[1].chunks(lit).map(|parts| parts.iter().sum()).collect();
        let total: f64 = other.iter().sum();
        let mut lighting = vec![0.0; scene.light.len()];
        for parts in best.shares[1].chunks(lit) {
            for (share, corner) in parts.iter().zip(&scene.lightings) {
                lighting.iter_mut().zip(corner).for_each(|(v, corner)| *v += share / total * corner);
            }
        }
        let mut state = State { temperature_k, lighting, ..self.scene.state.clone() };
        let mut found: Option<MixtureDistance> = None;
        let mut solver = self.scene.solver();
        for _ in 0..TURNS {
            normalise(&mut own);
            normalise(&mut other);
            let pair = [mixed(self.targets, &own), mixed(self.alternatives, &other)];
            let nearest = match self.counting {
                Some(counting) => solver.with_counting(&pair[0], &pair[1], self.scene.state, counting),
                None => solver.per_photon(&pair[0], &pair[1], self.scene.state, f64::INFINITY),
            }?;
            let better = found.as_ref().is_none_or(|found| nearest.distance < found.distance * (1.0 - WORTH));
            if found.as_ref().is_none_or(|found| nearest.distance < found.distance) {
                state = nearest.state.clone();
                found = Some(MixtureDistance {
                    distance: nearest.distance,
                    lower: 0.0,
                    target: own.clone(),
                    alternative: other.clone(),
                    state: nearest.state,
                    boxes: 0,
                });
            }
            if !better {
                break;
            }
            let alternatives = scene.counts(&state.lighting, state.temperature_k);
            let hulls = Hulls {
                targets: &scene.own.counts,
                photons: &scene.own.photons,
                alternatives: &alternatives,
                var_added: &scene.var_added,
            };
            let shares: Vec<f64> = own.iter().zip(&scene.own.photons).map(|(p, d)| p * d).collect();
            let sum_of: f64 = shares.iter().sum();
            let start =
                [shares.iter().map(|s| s / sum_of).collect(), other.iter().map(|q| q / sum_of).collect()];
            let (step, _) = hulls.nearest(Mixed { shares: start, cost: f64::INFINITY });
            own = step.shares[0].iter().zip(&scene.own.photons).map(|(s, d)| s / d).collect();
            other.clone_from(&step.shares[1]);
        }
        found.ok_or_else(|| Error::malformed("a class has no members", "name some"))
    }
}

/// The corners of all lightings within a range of each and of their sum. Where that is known to be `sum`, the last object has what the others
/// leave of it, whatever its range, as nearest states have it.
fn corners(objects: usize, [low, high]: [f64; 2], sum: f64, is_total: bool) -> Result<Vec<Vec<f64>>> {
    let high = high.min(sum);
    let free = if is_total { objects.saturating_sub(1) } else { objects };
    // What rounding of sums may leave out is taken in: a larger set has no greater least distance.
    let slack = 1e-12 * sum.max(1.0);
    let mut corners: Vec<Vec<f64>> = Vec::new();
    let mut add = |corner: Vec<f64>| {
        if !corners.contains(&corner) {
            corners.push(corner);
        }
    };
    for ends in 0..1_usize << free {
        let corner: Vec<f64> = (0..free).map(|k| if ends >> k & 1 == 0 { low } else { high }).collect();
        let lit: f64 = corner.iter().sum();
        if lit <= sum + slack {
            add(corner.clone());
        }
        for k in 0..free {
            let rest = sum - (lit - corner[k]);
            if rest >= low - slack && rest <= high + slack {
                let mut corner = corner.clone();
                corner[k] = rest.max(0.0);
                add(corner);
            }
        }
    }
    if corners.is_empty() {
        let found = format!("no lighting from {low} to {high} adds up to {sum} at most");
        return Err(Error::malformed(found, "widen alternatives.lighting"));
    }
    if is_total && objects > 0 {
        for corner in &mut corners {
            let lit: f64 = corner.iter().sum();
            corner.push((sum - lit).max(0.0));
        }
    }
    Ok(corners)
}

/// The emissivity Σ p_i e_i of a mixture, at the nodes of its members.
#[must_use]
pub fn mixed(members: &[&[f64]], shares: &[f64]) -> Vec<f64> {
    let nodes = members.first().map_or(0, |member| member.len());
    let at = |node: usize| {
        let parts = members.iter().zip(shares).map(|(member, share)| share * member[node]);
        // Rounding of shares that add up to 1.
        parts.sum::<f64>().clamp(0.0, 1.0)
    };
    (0..nodes).map(at).collect()
}

fn normalise(shares: &mut [f64]) {
    let total: f64 = shares.iter().sum();
    shares.iter_mut().for_each(|share| *share /= total);
}
