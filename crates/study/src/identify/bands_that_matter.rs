//! Which bands matter for the scenario's task, and what the best few bands or filters keep of the distance.

use crate::identify::chosen_bands::{Reached, fewest_as_good};
use crate::{Study, Surface};
use hadar::demand::{self, Thing};
use hadar::error::{Error, Result};
use hadar::identifiability::selection::{
    FilterSelection, Quality, Scores, best_bands, best_filters, shares_between,
};
use hadar::identifiability::{Status, local::LocalSolver};
use hadar::parallel;
use hadar::scene::State;
use std::ops::Range;

/// A band, or a filter made of neighbouring bands.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Passband {
    /// Wavenumber of the lower edge of the band, cm⁻¹.
    pub low_cm1: f64,
    /// Wavenumber of the upper edge of the band, cm⁻¹.
    pub high_cm1: f64,
    /// Centre of a single band, else the middle, cm⁻¹.
    pub center_cm1: f64,
}

/// A choice of bands or filters and how good it is.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Choice {
    /// The bands or filters, rising.
    pub passbands: Vec<Passband>,
    /// Local distance of the pair that fares worst: statistical with a camera, else per √photon of all bands.
    pub distance: f64,
    /// The same with all bands, each read on its own.
    pub distance_all_bands: f64,
    /// The first over the second.
    pub kept: f64,
    /// How many were asked for; fewer are chosen where more would add less than 0.1 %.
    pub asked: usize,
    /// No choice of as many as were asked for has a greater distance.
    pub bound: f64,
    /// Whether the choice is proven to be the best of as many as were asked for.
    pub exact: bool,
    /// The alternative that fares worst with the choice.
    pub limiting: Option<String>,
    /// Fewest that tell anything: one more than there are unknowns.
    pub fewest: usize,
    /// What the camera reaches with these alone; `None` without a camera, or where they tell nothing.
    pub reached: Option<Reached>,
}

/// Information band by band, and the choices asked for.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct BandsThatMatter {
    /// Names of the alternatives that are taken into account.
    pub alternatives: Vec<String>,
    /// Those left out since not even all bands distinguish them.
    pub left_out: Vec<String>,
    /// Those left out since not even all bands with shot noise alone tell them as required. None is left out for that
    /// where it holds for all.
    pub out_of_reach: Vec<String>,
    /// The alternative the shares below are of: the hardest of those counted.
    pub alternative: String,
    /// Centres of the bands, cm⁻¹.
    pub center_cm1: Vec<f64>,
    /// Share of each band in the square of the local distance.
    pub share_local: Vec<f64>,
    /// Share of the square that is lost without the band alone.
    pub lost_without: Vec<f64>,
    /// Share of each band in the separation from the closest confuser.
    pub share_nearest: Vec<f64>,
    /// The best single bands; `None` if not asked for.
    pub bands: Option<Choice>,
    /// The best contiguous filters; `None` if not asked for.
    pub filters: Option<Choice>,
}

impl Study {
    /// What every band tells, and the best `bands` single bands and `filters` contiguous filters for telling the
    /// target from all alternatives, by the local distance.
    ///
    /// # Errors
    /// More bands or filters asked for than there are bands; no alternative that can be told apart.
    pub fn bands_that_matter(&self, bands: Option<usize>, filters: Option<usize>) -> Result<BandsThatMatter> {
        let counting = self.counting();
        let unknowns = self.decisive_unknowns();
        let photon_noise = counting.as_ref().map_or_else(Vec::new, |_| self.var_with_photons());
        let scores: Vec<Scores> = parallel::try_map(self.alternatives.len(), |i| {
            let scores = Scores::of(
                &self.bands,
                &self.surroundings,
                &unknowns,
                &self.target.emissivity,
                &self.alternatives[i].emissivity,
                &self.state,
                counting.as_ref(),
            )?;
            if counting.is_some() { scores.with_photon_noise(&photon_noise) } else { Ok(scores) }
        })?;
        let (useful, blind): (Vec<usize>, Vec<usize>) =
            (0..scores.len()).partition(|&i| self.is_told_by_all_bands(&self.alternatives[i]));
        self.book_local(&unknowns, scores.len());
        let (_, beyond) = self.within_reach()?;
        let (out_of_reach, reachable): (Vec<usize>, Vec<usize>) =
            useful.iter().partition(|i| beyond.contains(i));
        let (counted, out_of_reach) =
            if reachable.is_empty() { (useful, Vec::new()) } else { (reachable, out_of_reach) };
        let told: Vec<(&Surface, &Scores)> =
            counted.iter().map(|&i| (&self.alternatives[i], &scores[i])).collect();
        let information: Vec<_> = parallel::map(told.len(), |i| told[i].1.information());
        let hardest = (0..told.len())
            .min_by(|&a, &b| information[a].distance.total_cmp(&information[b].distance))
            .ok_or_else(|| {
                let found = "not even all bands distinguish the target from any alternative";
                Error::malformed(found, "change the scene or the alternatives")
                    .at(self.scenario.place("alternatives"))
            })?;
        let scores: Vec<Scores> = told.iter().map(|(_, scores)| (*scores).clone()).collect();
        let name = |index: Option<usize>| index.map(|i| told[i].0.name.clone());
        let counted: Vec<&Surface> = told.iter().map(|(surface, _)| *surface).collect();
        let choice = |quality: Quality, runs: &[Range<usize>], asked: usize| -> Result<Choice> {
            let tells = quality.distance > 0.0;
            Ok(Choice {
                passbands: runs.iter().map(|run| self.passband(run.clone())).collect(),
                asked,
                reached: if tells { self.reached_with(runs, &counted)? } else { None },
                distance: quality.distance,
                distance_all_bands: quality.distance_all_bands,
                kept: quality.kept,
                bound: quality.bound,
                exact: quality.exact,
                limiting: name(quality.limiting_pair),
                fewest: quality.fewest,
            })
        };
        let best_single = |k: usize| -> Result<Choice> {
            let found = best_bands(&scores, k)?;
            let runs: Vec<Range<usize>> = found.bands.iter().map(|&band| band..band + 1).collect();
            choice(found.quality, &runs, k)
        };
        let best_few = |k: usize| -> Result<Choice> {
            let distance = |found: &FilterSelection| found.quality.distance;
            let (few, whole) = fewest_as_good(k, |k| best_filters(&scores, k), distance)?;
            let FilterSelection { filters, mut quality } = few;
            // What bounds as many as were asked for bounds the fewer too.
            quality.exact = whole.quality.exact && quality.distance >= whole.quality.distance;
            quality.bound = whole.quality.bound;
            choice(quality, &filters, k)
        };
        let chosen_bands = bands.map(best_single).transpose()?;
        let chosen_filters = filters.map(best_few).transpose()?;
        let alternative = told[hardest].0;
        let state: State = self.spectra(alternative)?.state;
        demand::computed(Thing::NearestSearches, 1);
        let nearest = self.bands.weigh(&self.surroundings.signal(&alternative.emissivity, &state));
        Ok(BandsThatMatter {
            alternatives: told.iter().map(|(surface, _)| surface.name.clone()).collect(),
            left_out: self.names_of(&blind),
            out_of_reach: self.names_of(&out_of_reach),
            alternative: alternative.name.clone(),
            center_cm1: self.bands.bands().iter().map(|band| band.center_cm1).collect(),
            share_local: information[hardest].share.clone(),
            lost_without: information[hardest].lost_without.clone(),
            share_nearest: shares_between(&self.target_signal(), &nearest, counting.as_ref())?,
            bands: chosen_bands,
            filters: chosen_filters,
        })
    }

    /// Whether the local distance in all bands is more than nothing.
    fn is_told_by_all_bands(&self, alternative: &Surface) -> bool {
        LocalSolver::new(&self.bands, &self.surroundings, self.decisive_unknowns())
            .per_photon(&self.target.emissivity, &alternative.emissivity, &self.state, f64::INFINITY)
            .is_ok_and(|local| local.status == Status::Ok)
    }

    fn passband(&self, range: Range<usize>) -> Passband {
        let bands = self.bands.bands().get(range).unwrap_or_default();
        let low_cm1 = bands.iter().map(|band| band.low_cm1).fold(f64::INFINITY, f64::min);
        let high_cm1 = bands.iter().map(|band| band.high_cm1).fold(0.0, f64::max);
        // A single band has a centre of its own, which a filter's curve need not have in the middle.
        let center_cm1 = match bands {
            [band] => band.center_cm1,
            _ => 0.5 * (low_cm1 + high_cm1),
        };
        Passband { low_cm1, high_cm1, center_cm1 }
    }
}
