//! The worst mixture of the members of two classes.

use super::members::mixed;
use super::{Members, MixtureAnswer};
use crate::{Study, Surface};
use hadar::error::{Error, Result};
use hadar::fisher::Counting;
use hadar::identifiability::mixture::{MixtureDistance, Mixtures};
use hadar::order;
use hadar::parallel;
use hadar_scenario::DistanceKind;

/// To what share of a distance that of mixtures is proved.
const TOLERANCE: f64 = 1e-3;

impl Study {
    /// The worst mixture found, as surfaces, and what is proved of all; `worst` is the pair of members that is hardest to tell apart, at
    /// `distance`.
    pub(super) fn worst_mixture(
        &self,
        own: &Members,
        other: &Members,
        worst: (usize, usize),
        distance: f64,
    ) -> Result<((Surface, Surface), MixtureAnswer)> {
        let key = format!("class.{}", if own.mixtures() { &own.name } else { &other.name });
        let at = |error: Error| error.at(self.scenario.place(&key));
        if self.scenario.requirement.by != DistanceKind::Nearest {
            let found = "mixtures of a class by another than the nearest distance";
            let instead = "write requirement.by = \"nearest\", or leave mixtures out";
            return Err(at(Error::malformed(found, instead)));
        }
        let counting = self.noisiest(own)?;
        // Without mixtures every member stands for itself.
        let sides = [own, other].map(|members| -> Vec<Vec<usize>> {
            let count = members.surfaces.len();
            if members.mixtures() {
                vec![(0..count).collect()]
            } else {
                (0..count).map(|i| vec![i]).collect()
            }
        });
        let jobs: Vec<(&Vec<usize>, &Vec<usize>)> =
            sides[0].iter().flat_map(|a| sides[1].iter().map(move |b| (a, b))).collect();
        let scene = self.library_scene();
        let found = parallel::try_map(jobs.len(), |i| {
            let (a, b) = jobs[i];
            let spectra = |members: &Members, which: &[usize]| -> Vec<Vec<f64>> {
                which.iter().map(|i| members.surfaces[*i].emissivity.clone()).collect()
            };
            let (targets, alternatives) = (spectra(own, a), spectra(other, b));
            let [targets, alternatives] =
                [&targets, &alternatives].map(|all| all.iter().map(Vec::as_slice).collect::<Vec<_>>());
            let mixtures = Mixtures {
                scene: &scene,
                targets: &targets,
                alternatives: &alternatives,
                counting: counting.as_ref(),
            };
            // What is beyond the worst pair of members is not asked for.
            mixtures.nearest(TOLERANCE, distance)
        });
        let found: Vec<MixtureDistance> = found.map_err(at)?;
        let lower = found.iter().map(|found| found.lower).fold(f64::INFINITY, f64::min);
        let nearest = found.iter().zip(&jobs).min_by(|a, b| a.0.distance.total_cmp(&b.0.distance));
        let shares = |members: &Members, which: &[usize], shares: &[f64]| {
            let mut all = vec![0.0; members.surfaces.len()];
            which.iter().zip(shares).for_each(|(i, share)| all[*i] = *share);
            all
        };
        let (target, alternative, reached) = match nearest {
            Some((found, (a, b))) if found.distance < distance => {
                (shares(own, a, &found.target), shares(other, b, &found.alternative), found.distance)
            }
            // No mixture is worse than members alone.
            _ => (shares(own, &[worst.0], &[1.0]), shares(other, &[worst.1], &[1.0]), distance),
        };
        let answer = MixtureAnswer {
            target: parts(own, &target),
            alternative: parts(other, &alternative),
            distance: reached,
            distance_lower: lower.min(reached),
        };
        let surface = |members: &Members, shares: &[f64]| match members
            .surfaces
            .iter()
            .zip(shares)
            .find(|(_, s)| **s == 1.0)
        {
            Some((pure, _)) => pure.clone(),
            None => Surface {
                name: format!("{}/mixture", members.name),
                emissivity: mixed(&members.surfaces, shares),
                one_number: None,
            },
        };
        Ok(((surface(own, &target), surface(other, &alternative)), answer))
    }

    /// The camera's counting with the most added variance that any target of a class gives it, band by band.
    fn noisiest(&self, own: &Members) -> Result<Option<Counting>> {
        let mut noisiest: Option<Counting> = None;
        for target in &own.surfaces {
            let Some(counting) = (Self { target: target.clone(), ..self.clone() }).counting() else {
                continue;
            };
            noisiest = Some(match noisiest {
                None => counting,
                Some(known) => Counting {
                    var_added: (0..self.bands.len())
                        .map(|w| known.var_added(w).max(counting.var_added(w)))
                        .collect(),
                    ..known
                },
            });
        }
        Ok(noisiest)
    }
}

/// Members with a share, the largest first.
fn parts(members: &Members, shares: &[f64]) -> Vec<(String, f64)> {
    const WORTH_NAMING: f64 = 1e-4;
    let mut parts: Vec<(String, f64)> = members
        .surfaces
        .iter()
        .zip(shares)
        .filter(|(_, share)| **share > WORTH_NAMING)
        .map(|(surface, share)| (surface.name.clone(), *share))
        .collect();
    order::descending(&mut parts, |b| b.1);
    parts
}
