//! The order of choices by what is to be small, and those that are beaten by none.

use super::results::Choice;
use hadar::error::Result;
use hadar_scenario::FindSpec;
use hadar_scenario::find::Merit;

/// Relative difference of figures that is rounding.
const SAME: f64 = 1e-9;

/// One of the choices, and where it stands in the order that was asked for.
#[derive(Debug, Clone)]
pub(super) struct Ranked {
    pub(super) choice: Choice,
    pub(super) sought: Sought,
}

/// What of a choice is to be small.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sought {
    /// Price at most; infinite where it is not known.
    price: f64,
    time_s: f64,
    filters: f64,
    aperture_m: f64,
}

impl Sought {
    pub(super) fn of(choice: &Choice) -> Self {
        Self {
            price: choice.price.as_ref().map_or(f64::INFINITY, |price| price.range[1]),
            time_s: choice.time_s,
            filters: choice.filters.len() as f64,
            aperture_m: choice.aperture_m,
        }
    }

    const fn figure(&self, merit: Merit) -> f64 {
        match merit {
            Merit::Price => self.price,
            Merit::Time => self.time_s,
            Merit::Filters => self.filters,
            Merit::Aperture => self.aperture_m,
        }
    }
}

/// Choices that the main job calls met, and those that it does not.
pub(super) struct Listed {
    pub(super) met: Vec<Ranked>,
    pub(super) refused: Vec<Choice>,
    /// Whether they must be searched again, as more is known of what they must do.
    pub(super) again: bool,
}

/// What the one to whom a choice is put says of it.
pub(super) enum Put {
    /// It meets.
    Met,
    /// It does not, or that is not shown.
    Refused,
    /// It does not, and now more is known of what it takes.
    Again,
}

/// Puts those that would be listed to the main job, until all that are listed have been; one that it does not call met makes room for
/// another.
pub(super) fn confirmed(
    mut all: Vec<Ranked>,
    spec: &FindSpec,
    mut put: impl FnMut(&mut Choice) -> Result<Put>,
) -> Result<Listed> {
    let mut refused = Vec::new();
    loop {
        let mut listed = beaten_by_none(&all, spec);
        listed.extend(best_of_each(&all, &listed));
        let Some(open) = listed.iter().copied().find(|index| !all[*index].choice.is_judged()) else {
            let met = listed.into_iter().map(|index| all[index].clone()).collect();
            return Ok(Listed { met, refused, again: false });
        };
        match put(&mut all[open].choice)? {
            Put::Met => {}
            Put::Refused => refused.push(all.remove(open).choice),
            Put::Again => return Ok(Listed { met: Vec::new(), refused, again: true }),
        }
    }
}

/// Places of those that no other beats in all that is to be small, the first in the order of the question first.
pub(super) fn beaten_by_none(all: &[Ranked], spec: &FindSpec) -> Vec<usize> {
    let figures = |index: usize, merit: &Merit| all[index].sought.figure(*merit);
    let no_worse = |a: f64, b: f64| a <= b * (1.0 + SAME) || a == b;
    let beats = |a: usize, b: usize| {
        let none_worse = spec.least.iter().all(|merit| no_worse(figures(a, merit), figures(b, merit)));
        let one_better = spec.least.iter().any(|merit| !no_worse(figures(b, merit), figures(a, merit)));
        // Of equals the one that tells more, then the first.
        let (more, first) = (all[a].choice.upper, all[b].choice.upper);
        none_worse && (one_better || more > first || (more == first && a < b))
    };
    let count = all.len();
    let mut found: Vec<usize> = (0..count).filter(|b| !(0..count).any(|a| a != *b && beats(a, *b))).collect();
    found.sort_by(|a, b| order(all, spec, *a, *b));
    found
}

/// The best of every camera that is not among those that are listed.
pub(super) fn best_of_each(all: &[Ranked], listed: &[usize]) -> Vec<usize> {
    let mut best: Vec<usize> = Vec::new();
    let is_listed = |camera: &str| listed.iter().any(|index| all[*index].choice.camera == camera);
    for (index, one) in all.iter().enumerate() {
        let camera = one.choice.camera.as_str();
        if is_listed(camera) {
            continue;
        }
        let cost = |one: &Ranked| (one.choice.filters.len(), one.choice.time_s);
        match best.iter_mut().find(|known| all[**known].choice.camera == camera) {
            None => best.push(index),
            Some(known) => {
                let (own, other) = (cost(one), cost(&all[*known]));
                if own.0 < other.0 || (own.0 == other.0 && own.1 < other.1) {
                    *known = index;
                }
            }
        }
    }
    best
}

/// By the figures in the order of the question.
fn order(all: &[Ranked], spec: &FindSpec, a: usize, b: usize) -> std::cmp::Ordering {
    let by = |merit: &Merit| all[a].sought.figure(*merit).total_cmp(&all[b].sought.figure(*merit));
    spec.least.iter().map(by).find(|order| order.is_ne()).unwrap_or_else(|| a.cmp(&b))
}

/// Each choice once.
pub(super) fn distinct(all: Vec<Choice>) -> Vec<Choice> {
    let mut once: Vec<Choice> = Vec::with_capacity(all.len());
    for one in all {
        if !once.iter().any(|other| other.is_same(&one)) {
            once.push(one);
        }
    }
    once
}
