//! The ledger: kind by kind, how many things were computed, and how many were spared for which reason.

use serde::ser::{Serialize, SerializeMap, SerializeStruct, Serializer};
use std::collections::BTreeMap;

/// A kind of thing that can be computed or left out, in the order of the ledger.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Thing {
    /// Spectra of the library that are made from their optical constants or rows.
    LibrarySpectra,
    /// Known cameras, their figures worked out.
    Cameras,
    /// Choices of filters and frames of a camera, each judged by itself.
    CameraChoices,
    /// Figures and tables of the paper.
    Reproductions,
    /// Integrals of the spectra over a band.
    BandIntegrals,
    /// Sections of an answer that were asked for.
    Sections,
    /// Derivatives of all bands with respect to one parameter, formed for local distances.
    DerivativeColumns,
    /// Local distances of pairs of materials.
    LocalDistances,
    /// Bounds of the nearest distances of a target to all alternatives at once.
    SharedBounds,
    /// Distances to the alternative in the target's own state.
    OwnStateDistances,
    /// Local distances in a few of the bands, which say what is worth trying.
    FewBandEstimates,
    /// Descents from the target's own state to a nearer one.
    Descents,
    /// Searches for the closest confuser in a few of the bands.
    FewBandSearches,
    /// Searches for the closest confuser in all bands.
    NearestSearches,
    /// Closest confusers followed from one that was found, as a quantity is solved for.
    RefinedSearches,
    /// Worst cases over an operating envelope of scenes, one for each pair of materials and camera.
    WorstCases,
    /// Boxes of scenes and states of which a bound is proved.
    Boxes,
    /// Samples of a heat cube, or of a pair of them.
    Samples,
    /// Windows of pixels whose information is asked for.
    Windows,
    /// Noisy views that are matched.
    MatchedViews,
    /// Trials of a decision, each with separate counts.
    Trials,
    /// Spectra drawn for classifiers or thermometers.
    Spectra,
    /// Likelihood ratios drawn without spectra.
    Ratios,
    /// Classifiers that were trained on drawn spectra.
    TrainedClassifiers,
    /// Spectra read by a fit or by an imager.
    Readings,
    /// Fits of one material of a library to one pixel of a cube.
    MaterialFits,
    /// Reports of tables and figures.
    Reports,
    /// Figures that were drawn for reports.
    Figures,
}

impl Thing {
    /// In JSON.
    #[must_use]
    pub const fn key(self) -> &'static str {
        match self {
            Self::LibrarySpectra => "library_spectra",
            Self::Cameras => "cameras",
            Self::CameraChoices => "camera_choices",
            Self::Reproductions => "reproductions",
            Self::BandIntegrals => "band_integrals",
            Self::Sections => "sections",
            Self::DerivativeColumns => "derivative_columns",
            Self::LocalDistances => "local_distances",
            Self::SharedBounds => "shared_bounds",
            Self::OwnStateDistances => "own_state_distances",
            Self::FewBandEstimates => "few_band_estimates",
            Self::Descents => "descents",
            Self::FewBandSearches => "few_band_searches",
            Self::NearestSearches => "nearest_searches",
            Self::RefinedSearches => "refined_searches",
            Self::WorstCases => "worst_cases",
            Self::Boxes => "boxes",
            Self::Samples => "samples",
            Self::Windows => "windows",
            Self::MatchedViews => "matched_views",
            Self::Trials => "trials",
            Self::Spectra => "spectra",
            Self::Ratios => "ratios",
            Self::TrainedClassifiers => "trained_classifiers",
            Self::Readings => "readings",
            Self::MaterialFits => "material_fits",
            Self::Reports => "reports",
            Self::Figures => "figures",
        }
    }

    /// In a table.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::LibrarySpectra => "spectra of the library",
            Self::Cameras => "cameras",
            Self::CameraChoices => "choices of filters and frames",
            Self::Reproductions => "figures and tables of the paper",
            Self::BandIntegrals => "integrals over a band",
            Self::Sections => "sections of the answer",
            Self::DerivativeColumns => "columns of derivatives",
            Self::LocalDistances => "local distances",
            Self::SharedBounds => "bounds shared by a target's pairs",
            Self::OwnStateDistances => "distances in the own state",
            Self::FewBandEstimates => "estimates in a few bands",
            Self::Descents => "descents from the own state",
            Self::FewBandSearches => "searches in a few bands",
            Self::NearestSearches => "searches in all bands",
            Self::RefinedSearches => "nearest states followed",
            Self::WorstCases => "worst cases of an envelope",
            Self::Boxes => "boxes of scenes bounded",
            Self::Samples => "samples",
            Self::Windows => "windows",
            Self::MatchedViews => "noisy views matched",
            Self::Trials => "trials",
            Self::Spectra => "spectra drawn",
            Self::Ratios => "likelihood ratios drawn",
            Self::TrainedClassifiers => "classifiers trained",
            Self::Readings => "readings",
            Self::MaterialFits => "fits of a material to a pixel",
            Self::Reports => "reports of tables and figures",
            Self::Figures => "figures",
        }
    }
}

/// Why something was not computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Reason {
    /// Nobody asked for the result of it.
    NotAsked,
    /// Computed once for several that need the same.
    Shared,
    /// The alternative in the target's own state is nearer than required.
    OwnState,
    /// It would hardly have decided anything.
    Hopeless,
    /// A descent from the target's own state found one nearer than required.
    Descent,
    /// A few of the bands suffice to tell.
    FewBands,
    /// The search ended at the first state that is nearer than required.
    NearerState,
    /// Another one had settled the question.
    AnotherOne,
    /// A part proves that the whole reaches the requirement.
    ProvedAbove,
    /// A bound proves that the whole does not reach it.
    ProvedBelow,
    /// Whatever it is needed for was decided without it.
    Decided,
    /// The interval was narrow enough.
    NarrowEnough,
    /// A bound shows that it cannot change the answer.
    Bounded,
    /// No spectrum has rows nearer to each other than the band is wide.
    NoNearerRows,
}

impl Reason {
    /// In JSON.
    #[must_use]
    pub const fn key(self) -> &'static str {
        match self {
            Self::NotAsked => "not_asked",
            Self::Shared => "shared",
            Self::OwnState => "own_state",
            Self::Hopeless => "hopeless",
            Self::Descent => "descent",
            Self::FewBands => "few_bands",
            Self::NearerState => "nearer_state",
            Self::AnotherOne => "another_one",
            Self::ProvedAbove => "proved_above",
            Self::ProvedBelow => "proved_below",
            Self::Decided => "decided",
            Self::NarrowEnough => "narrow_enough",
            Self::Bounded => "bounded",
            Self::NoNearerRows => "no_nearer_rows",
        }
    }

    /// In a table.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::NotAsked => "not asked for",
            Self::Shared => "shared with others",
            Self::OwnState => "decided in the own state",
            Self::Hopeless => "not worth trying",
            Self::Descent => "decided by a descent",
            Self::FewBands => "decided by a few bands",
            Self::NearerState => "ended at the first state nearer than required",
            Self::AnotherOne => "decided by another one",
            Self::ProvedAbove => "proved to reach the demand",
            Self::ProvedBelow => "proved not to reach it",
            Self::Decided => "decided without them",
            Self::NarrowEnough => "interval narrow enough",
            Self::Bounded => "excluded by a bound",
            Self::NoNearerRows => "no rows nearer than the band is wide",
        }
    }
}

/// One kind of thing.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Line {
    computed: u64,
    spared: BTreeMap<Reason, u64>,
}

impl Line {
    /// How many there could have been.
    #[must_use]
    pub fn possible(&self) -> u64 {
        self.computed.saturating_add(self.spared())
    }

    /// How many were computed.
    #[must_use]
    pub const fn computed(&self) -> u64 {
        self.computed
    }

    /// How many were not.
    #[must_use]
    pub fn spared(&self) -> u64 {
        self.spared.values().fold(0, |sum, count| sum.saturating_add(*count))
    }

    /// How many were not, by reason.
    pub fn reasons(&self) -> impl Iterator<Item = (Reason, u64)> {
        self.spared.iter().map(|(reason, count)| (*reason, *count))
    }
}

/// What a question took, and what it was spared.
///
/// ```
/// use hadar::demand::{Reason, Thing, Work};
/// let mut work = Work::default();
/// work.compute(Thing::Windows, 3);
/// work.spare(Thing::Windows, Reason::ProvedAbove, 5);
/// assert_eq!(work.possible(Thing::Windows), 8);
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Work(BTreeMap<Thing, Line>);

impl Work {
    /// So many were computed.
    pub fn compute(&mut self, thing: Thing, count: u64) {
        let line = self.0.entry(thing).or_default();
        line.computed = line.computed.saturating_add(count);
    }

    /// So many were not, for a reason.
    pub fn spare(&mut self, thing: Thing, reason: Reason, count: u64) {
        let line = self.0.entry(thing).or_default();
        if count > 0 {
            let spared = line.spared.entry(reason).or_default();
            *spared = spared.saturating_add(count);
        }
    }

    /// Adds what another ledger has.
    pub fn add(&mut self, other: &Self) {
        for (thing, line) in &other.0 {
            self.compute(*thing, line.computed);
            line.reasons().for_each(|(reason, count)| self.spare(*thing, reason, count));
        }
    }

    /// Both together.
    #[must_use]
    pub fn and(mut self, other: &Self) -> Self {
        self.add(other);
        self
    }

    /// The lines, kind by kind.
    pub fn lines(&self) -> impl Iterator<Item = (Thing, &Line)> {
        self.0.iter().map(|(thing, line)| (*thing, line))
    }

    /// How many there could have been.
    #[must_use]
    pub fn possible(&self, thing: Thing) -> u64 {
        self.0.get(&thing).map_or(0, Line::possible)
    }

    /// How many were computed.
    #[must_use]
    pub fn computed(&self, thing: Thing) -> u64 {
        self.0.get(&thing).map_or(0, Line::computed)
    }

    /// How many were spared for a reason.
    #[must_use]
    pub fn spared(&self, thing: Thing, reason: Reason) -> u64 {
        self.0.get(&thing).and_then(|line| line.spared.get(&reason)).copied().unwrap_or(0)
    }

    /// Whether anything was spared.
    #[must_use]
    pub fn spares_anything(&self) -> bool {
        self.0.values().any(|line| line.spared() > 0)
    }
}

impl Serialize for Work {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (thing, line) in &self.0 {
            map.serialize_entry(thing.key(), line)?;
        }
        map.end()
    }
}

impl Serialize for Line {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let spared: BTreeMap<&str, u64> = self.reasons().map(|(reason, n)| (reason.key(), n)).collect();
        let mut line = serializer.serialize_struct("Line", 3)?;
        line.serialize_field("possible", &self.possible())?;
        line.serialize_field("computed", &self.computed)?;
        line.serialize_field("spared", &spared)?;
        line.end()
    }
}
