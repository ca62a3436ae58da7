//! What can be asked of a library besides the distances to the target, and the answers together.

use crate::{Apart, BandsThatMatter, Exact, Identification, Matrix, Scaling, Study, Trial, Warning};
use hadar::demand::{self, Ledger, Skipping, Thing, if_asked};
use hadar::error::{Error, Result};
use hadar::identifiability::multi::{self, Progress};

/// What is asked besides the distances to every alternative: nothing else is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Asked {
    /// All materials against all.
    pub matrix: bool,
    /// Only which of them can be told apart.
    pub apart: bool,
    /// Whether pairs that a cheap bound decides are skipped.
    pub skipping: Skipping,
    /// The scaling laws.
    pub scaling: bool,
    /// Which bands matter, and the best so many single bands and contiguous filters.
    pub bands: Option<(Option<usize>, Option<usize>)>,
    /// What a test that knows no state achieves, by simulation.
    pub exact: Option<Trial>,
    /// What the priors make of the hardest pair on average.
    pub average: bool,
}

/// The distances to every alternative and whatever else was asked for, in one object.
#[derive(Debug, Clone, serde::Serialize)]
#[non_exhaustive]
pub struct Answers {
    /// The target against every alternative.
    #[serde(flatten)]
    pub identification: Identification,
    /// Distances of all materials against all others.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub matrix: Option<Matrix>,
    /// Which of them can be distinguished.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub apart: Option<Apart>,
    /// Scaling of the least distance with the size of the library and with the number of bands.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scaling: Option<Scaling>,
    /// Which spectral bands carry the information, and which are enough.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bands_that_matter: Option<BandsThatMatter>,
    /// Simulated decisions, at the numbers of photons that are counted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exact: Option<Exact>,
}

/// Is told how many of how many are done, part by part.
#[derive(Clone, Copy)]
pub struct Watch<'w> {
    /// Targets of a matrix, or of the subsets of a library, whose nearest distances are searched.
    pub searched: Progress<'w>,
    /// Pairs that are or are not told apart.
    pub decided: Progress<'w>,
    /// Pairs whose decisions are simulated.
    pub simulated: Progress<'w>,
    /// States of the average over the priors.
    pub averaged: Progress<'w>,
}

impl Watch<'_> {
    /// Nobody looks.
    pub const NONE: Self =
        Self { searched: &|_, _| (), decided: &|_, _| (), simulated: &|_, _| (), averaged: &|_, _| () };
}

impl Study {
    /// Answers all that is asked, and computes no more.
    ///
    /// # Errors
    /// As [`Study::identify`], [`Study::matrix`] and [`Study::told_apart`].
    pub fn answer(&self, asked: &Asked, watch: &Watch<'_>) -> Result<Answers> {
        if asked.bands.is_some() && self.has_classes() {
            let found = "bands are chosen for one material against others, and there is a class";
            let instead = "name those of its members that decide (they stand in the answer without --bands)";
            return Err(Error::malformed(found, instead).at(self.scenario().place("class")));
        }
        let (bands, filters) = asked.bands.unwrap_or_default();
        number_of("--bands", bands, self.bands.len())?;
        number_of("--filters", filters, self.bands.len())?;
        if asked.matrix || asked.apart {
            // Before the target is compared with each of them.
            let count = self.materials()?.len();
            multi::check_count(count)
                .map_err(|error| error.at(self.scenario().place("alternatives.materials")))?;
        }
        let ledger = Ledger::open();
        let section = Thing::Sections;
        let mut identification = self.identify()?;
        demand::add(&identification.stats);
        demand::computed(section, 1);
        let limiting = self.alternative(&identification.limiting);
        let average = if_asked(asked.average, section, 1, || match limiting {
            Some(alternative) => self.prior_average(alternative, watch.averaged),
            None => Ok(None),
        })?;
        identification.prior_average = average.flatten();
        if asked.matrix && self.unknowns.has_priors() {
            identification.warnings.push(Warning::MatrixPriors);
        }
        let matrix = if_asked(asked.matrix, section, 1, || self.matrix(watch.searched))?;
        if let Some(searches) = matrix.as_ref().map(|matrix| matrix.unproved).filter(|&unproved| unproved > 0)
        {
            identification.warnings.push(Warning::MatrixNotProved { searches });
        }
        let exact = if_asked(asked.exact.is_some(), section, 1, || {
            asked.exact.map(|trial| self.exact(&trial, watch.simulated)).transpose()
        })?;
        let exact = exact.flatten();
        if let (Some(exact), Some(trial)) = (&exact, asked.exact) {
            identification.warnings.extend(exact.ended_early(&trial.plan));
        }
        let apart = if_asked(asked.apart, section, 1, || self.told_apart(asked.skipping, watch.decided))?;
        let scaling = if_asked(asked.scaling, section, 1, || self.scaling(watch.searched))?;
        let bands_that_matter =
            if_asked(asked.bands.is_some(), section, 1, || self.bands_that_matter(bands, filters))?;
        if let Some(camera) = &self.camera {
            let told = [matrix.as_ref().and_then(|matrix| matrix.apart.as_ref()), apart.as_ref()];
            let told: Vec<&Apart> = told.into_iter().flatten().collect();
            identification.conditions = self.conditions_of_pairs(camera, &identification.pairs, &told)?;
        }
        identification.stats = ledger.close();
        Ok(Answers { identification, matrix, apart, scaling, bands_that_matter, exact })
    }
}

/// How many bands or filters can be asked for.
fn number_of(flag: &str, asked: Option<usize>, most: usize) -> Result<()> {
    match asked {
        Some(k) if k == 0 || k > most => {
            let expected = format!("from 1 to the number of bands, {most}");
            Err(Error::out_of_range(flag, k as f64, "", expected))
        }
        _ => Ok(()),
    }
}
