//! A few bands or filters as all that the camera has.

use crate::{Study, Surface};
use hadar::error::Result;
use hadar::fisher::Counting;
use hadar::identifiability::nearest::NearestSolver;
use hadar::parallel;
use hadar::scene::{EnvironmentObject, Surroundings};
use std::ops::Range;

/// Share of the distance that another filter must add to be worth it.
const WORTH: f64 = 1e-3;

/// What the camera reaches with the chosen bands alone.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Reached {
    /// Least nearest statistical distance to the alternatives that were counted.
    pub statistical_distance: f64,
    /// The alternative it belongs to.
    pub limiting: String,
    /// Statistical distance d that is required of the camera.
    pub required: f64,
}

/// The fewest of up to `most` filters with no less than 99.9 % of the distance of all of them, by trying ever fewer.
pub(crate) fn fewest_as_good<T>(
    most: usize,
    choose: impl Fn(usize) -> Result<T>,
    distance: impl Fn(&T) -> f64,
) -> Result<(T, T)>
where
    T: Clone,
{
    let whole = choose(most)?;
    let mut best = whole.clone();
    if distance(&whole) <= 0.0 {
        return Ok((best, whole));
    }
    for fewer in (1..most).rev() {
        let next = choose(fewer)?;
        if distance(&next) < (1.0 - WORTH) * distance(&whole) {
            break;
        }
        best = next;
    }
    Ok((best, whole))
}

impl Study {
    /// Least nearest statistical distance with nothing but `runs` of bands, each summed and read once with the
    /// noise of a reading that its bands have on average; `None` without a camera.
    pub(crate) fn reached_with(
        &self,
        runs: &[Range<usize>],
        alternatives: &[&Surface],
    ) -> Result<Option<Reached>> {
        let Some(counting) = self.counting() else { return Ok(None) };
        let (bands, places) = self.bands.chosen(runs);
        let kept = |values: &[f64]| -> Vec<f64> { places.iter().map(|&j| values[j]).collect() };
        let objects = self.surroundings.objects().iter().map(|object| EnvironmentObject {
            temperature_k: object.temperature_k,
            emissivity: object.emissivity.as_deref().map(kept),
        });
        let surroundings = Surroundings::new(bands.nodes_cm1(), objects.collect())?;
        // What comes with photons adds up over the bands.
        let light = self.var_with_photons();
        let noise = |run: &Range<usize>| {
            let of_readings = run.clone().map(|w| counting.var_added(w) - light[w]).sum::<f64>();
            of_readings.max(0.0) / run.len().max(1) as f64 + light[run.clone()].iter().sum::<f64>()
        };
        let counting = Counting {
            counts_per_radiance: counting.counts_per_radiance,
            var_added: runs.iter().map(noise).collect(),
        };
        let own = kept(&self.target.emissivity);
        let solver = || {
            NearestSolver::new(&bands, &surroundings, self.unknowns.clone(), self.range)
                .proving(self.tolerance())
        };
        let found = parallel::try_map_with(alternatives.len(), solver, |solver, i| {
            let other = kept(&alternatives[i].emissivity);
            Ok(solver.with_counting(&own, &other, &self.state, &counting)?.distance)
        })?;
        let least = found.into_iter().zip(alternatives).min_by(|a, b| a.0.total_cmp(&b.0));
        Ok(least.map(|(statistical_distance, surface)| Reached {
            statistical_distance,
            limiting: surface.name.clone(),
            required: self.required,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hadar::material::Library;
    use hadar_scenario::Scenario;

    fn study(nuisances: &str) -> Study {
        let text = format!(
            "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\n\
             [[environment]]\ntemperature = \"20 degC\"\nlighting = 0.5\n\
             [alternatives]\nmaterials = [\"pmma\", \"concrete\"]\n[bands]\nstart = \"715 cm^-1\"\n\
             stop = \"1250 cm^-1\"\nstep = \"5 cm^-1\"\n[unknown]\nnuisances = [{nuisances}]\n\
             [camera]\npreset = \"flir-a325sc\"\n"
        );
        Study::new(&Scenario::from_toml(&text, None).unwrap(), &Library::embedded().unwrap()).unwrap()
    }

    #[test]
    fn all_bands_one_by_one_are_the_camera_itself() {
        let study = study("\"temperature\", \"lighting\"");
        let all: Vec<&Surface> = study.alternatives.iter().collect();
        let singles: Vec<Range<usize>> = (0..study.bands.len()).map(|w| w..w + 1).collect();
        let reached = study.reached_with(&singles, &all).unwrap().unwrap();
        let result = study.identify().unwrap();
        let least = result.identifiability.statistical_distance_minimum.unwrap();
        assert_eq!((reached.statistical_distance, reached.limiting), (least, result.limiting));
    }

    /// With nothing unknown there is one state: d² = Σ(√(N + σ²) − √(N′ + σ²))² of the summed counts, σ² the mean.
    #[test]
    fn filters_are_summed_and_read_once() {
        let study = study("");
        let runs = [3..20, 40..41, 60..100];
        let counting = study.counting().unwrap();
        let counts = |emissivity: &[f64]| -> Vec<f64> {
            let signal = study.bands.weigh(&study.surroundings.signal(emissivity, &study.state));
            let sum = |run: &Range<usize>| signal[run.clone()].iter().sum::<f64>();
            runs.iter().map(|run| counting.counts_per_radiance * sum(run)).collect()
        };
        let own = counts(&study.target.emissivity);
        for surface in &study.alternatives {
            let other = counts(&surface.emissivity);
            let square: f64 = (0..3)
                .map(|i| {
                    let noise = &counting.var_added[runs[i].clone()];
                    let var = noise.iter().sum::<f64>() / noise.len() as f64;
                    ((own[i] + var).sqrt() - (other[i] + var).sqrt()).powi(2)
                })
                .sum();
            let reached = study.reached_with(&runs, &[surface]).unwrap().unwrap().statistical_distance;
            // The closed form loses what the two counts have in common, some four digits of sixteen.
            assert!((reached / square.sqrt() - 1.0).abs() < 1e-9, "{reached} {}", square.sqrt());
        }
    }

    #[test]
    fn filters_that_add_nothing_are_dropped_and_others_are_not() {
        let distances = [0.0, 0.5, 0.9, 0.9999, 1.0, 1.0];
        let fewest = |most| fewest_as_good(most, Ok, |k: &usize| distances[*k]).unwrap();
        assert_eq!([fewest(5), fewest(4), fewest(3), fewest(2)], [(3, 5), (3, 4), (3, 3), (2, 2)]);
    }
}
