//! A study of some of its bands alone, and what it tells at least and at most.

use crate::classes::Members;
use crate::{Study, Surface, YesNo};
use hadar::error::Result;
use hadar::fisher::Counting;
use hadar::parallel;
use hadar::scene::{EnvironmentObject, State, Surroundings};
use hadar_scenario::DistanceKind;
use std::ops::Range;

/// What some bands tell of the target and all alternatives.
#[derive(Debug, Clone)]
pub(super) struct Judged {
    /// The least that is proved, and that was found, of all pairs that were looked at.
    pub(super) lower: f64,
    pub(super) upper: f64,
    /// Whether every pair is told, none is, or that is not shown.
    pub(super) told: YesNo,
    /// Nearest states of the pairs that were looked at.
    pub(super) states: Vec<Nearest>,
    /// Distance searches that it took.
    pub(super) searches: u64,
}

/// The best of some choices.
#[derive(Debug, Clone)]
pub(super) struct Best {
    pub(super) chosen: Vec<usize>,
    pub(super) judged: Judged,
    pub(super) frames: u32,
}

/// The nearest state of an alternative to a member of the target.
#[derive(Debug, Clone)]
pub(super) struct Nearest {
    /// Places of the scene, of the target's member and of the alternative.
    pub(super) place: [usize; 3],
    pub(super) state: State,
    /// Statistical distance.
    pub(super) distance: f64,
    /// Whether the distance is of the law of many counts.
    pub(super) by_many: bool,
}

impl Judged {
    /// Nothing yet.
    pub(super) fn nothing() -> Self {
        Self { lower: f64::INFINITY, upper: f64::INFINITY, told: YesNo::Yes, states: Vec::new(), searches: 0 }
    }

    /// With another pair or scene.
    fn with(&mut self, [lower, upper]: [f64; 2], told: YesNo) {
        (self.lower, self.upper) = (self.lower.min(lower), self.upper.min(upper));
        self.told = match (self.told, told) {
            (YesNo::No, _) | (_, YesNo::No) => YesNo::No,
            (YesNo::Undecided, _) | (_, YesNo::Undecided) => YesNo::Undecided,
            _ => YesNo::Yes,
        };
    }

    /// With what is told in another scene, whose distances count `scale` times.
    pub(super) fn with_scene(&mut self, scene: usize, scale: f64, found: Self) {
        self.with([scale * found.lower, scale * found.upper], found.told);
        self.searches += found.searches;
        self.states.extend(found.states.into_iter().map(|mut nearest| {
            nearest.place[0] = scene;
            nearest
        }));
    }
}

impl Study {
    /// The same scene through some of its bands alone.
    pub(super) fn with_bands_alone(&self, chosen: &[usize]) -> Result<Self> {
        hadar::stop::check();
        let runs: Vec<Range<usize>> = chosen.iter().map(|w| *w..w + 1).collect();
        let (open_bands, places) = self.open_bands.chosen(&runs);
        let (bands, _) = self.bands.chosen(&runs);
        let kept = |values: &[f64]| -> Vec<f64> {
            places.iter().filter_map(|place| values.get(*place).copied()).collect()
        };
        let surface =
            |surface: &Surface| Surface { emissivity: kept(&surface.emissivity), ..surface.clone() };
        let members = |members: &Members| {
            let mut members = members.clone();
            members.surfaces = members.surfaces.iter().map(surface).collect();
            members.modes = members.modes.iter().map(|mode| kept(mode)).collect();
            members
        };
        let objects = self.surroundings.objects().iter().map(|object| EnvironmentObject {
            temperature_k: object.temperature_k,
            emissivity: object.emissivity.as_deref().map(kept),
        });
        let behind = self.behind.clone().map(|mut behind| {
            behind.surface = surface(&behind.surface);
            behind
        });
        Ok(Self {
            surroundings: Surroundings::new(open_bands.nodes_cm1(), objects.collect())?,
            air: kept(&self.air),
            behind,
            target: surface(&self.target),
            alternatives: self.alternatives.iter().map(surface).collect(),
            members: self.members.clone().map(|side| side.iter().map(members).collect()),
            open_bands,
            bands,
            ..self.clone()
        })
    }

    /// What its bands tell; with a `goal` no more pairs are looked at than it takes to see that less than that is told. `first` is the
    /// pair to begin with.
    pub(super) fn judged(&self, first: [usize; 2], goal: f64) -> Result<Judged> {
        let targets = self.members[0].iter().flat_map(|members| &members.surfaces).count();
        let mut pairs: Vec<[usize; 2]> =
            (0..targets).flat_map(|t| (0..self.alternatives.len()).map(move |a| [t, a])).collect();
        if let Some(place) = pairs.iter().position(|pair| *pair == first) {
            pairs.swap(0, place);
        }
        let mut judged = Judged::nothing();
        let (head, rest) = pairs.split_at(pairs.len().min(1));
        for some in [head, rest] {
            if judged.upper <= goal {
                break;
            }
            let found = parallel::booked(some.len(), |i| self.pair_judged(some[i]))?;
            for (nearest, bounds, told) in found {
                judged.searches += 1;
                judged.with(bounds, told);
                judged.states.push(nearest);
            }
        }
        Ok(judged)
    }

    fn pair_judged(&self, pair: [usize; 2]) -> Result<(Nearest, [f64; 2], YesNo)> {
        let own = self.of_target(pair[0]);
        let (counting, alternative) =
            (own.counting().unwrap_or_else(|| nothing(&own)), &own.alternatives[pair[1]]);
        let (found, state) = own.statistical_at(DistanceKind::Nearest, alternative, &counting)?;
        let decision = own.decision(alternative, (&own.bands, &counting), found, state.as_ref())?;
        let state = state.unwrap_or_else(|| own.state.clone());
        let by_many = own.counts_are_many(&own.bands, &counting);
        let nearest = Nearest { place: [0, pair[0], pair[1]], state, distance: found.distance, by_many };
        Ok((nearest, decision.found.bounds(), decision.told))
    }

    /// The same with a member of the target's class as the target.
    pub(super) fn of_target(&self, member: usize) -> Self {
        let target = self.members[0].iter().flat_map(|members| &members.surfaces).nth(member);
        Self { target: target.unwrap_or(&self.target).clone(), ..self.clone() }
    }
}

/// No camera counts nothing.
fn nothing(study: &Study) -> Counting {
    Counting { counts_per_radiance: 0.0, var_added: vec![0.0; study.bands.len()] }
}
