//! The margin of a camera whose figures are uncertain, and a guard band around the demand.
//!
//! Figures q_i have standard uncertainties u_i, independent of each other; emissivities have the errors of `[sensitivity]`, where the
//! rule has that table. Two ways to the uncertainty u of the margin m, side by side:
//!
//! (a figure that is moved takes with it what is stated by it, as if the rule had the other value: a NETD through the camera's own
//! optics stays what it is, whatever they pass)
//!
//! * first order: u² = Σ c_i², c_i = ½[m(q_i + u_i) − m(q_i − u_i)], line by line the budget;
//! * draws: all figures at once, Gaussian, at the points of a lattice; their deviation, and the interval that holds as much as
//!   ±k deviations of a Gaussian do.
//!
//! m is taken anew in the worst scenes of all pairs of materials that come near the worst of all, and in those of the camera with its
//! figures at their ends: another camera may have another worst scene. For draws about the lower end of the interval all scenes are searched
//! again, until that finds no worse one. The lower end is that of which 95 % of as many draws are surer: the order statistic n p − 1.96 √(n p (1 − p)), of one figure alone n p − 1.
//! The interval is the wider one of the two. A camera meets a
//! demand if the interval is above 1, fails if it is below, and is undecided between: the limits are guarded by k u on both sides.
//!
//! Figures may share an error (`same`), of which each has so many of its own deviations; a rectangular one goes to √3 u. A figure that is a limit
//! (`at_most`) is taken at it: whoever meets a demand there meets it, and whoever fails may be better.
//!
//! Source: JCGM 100:2008 (GUM) 5.1 (first order), JCGM 101:2008 (draws), JCGM 106:2012 8.3 (guard bands).

use super::cameras::Named;
use crate::{Shortfall, camera};
use hadar::error::{Error, Place, Result};
use hadar::identifiability::detection;
use hadar::instrument::figures::{self, Kind};
use hadar::instrument::{Camera, presets};
use hadar::lattice_points::GoldenLattice;
use hadar::order;
use hadar::parallel;
use hadar_scenario::CameraSpec;
use hadar_scenario::rule::{Known, Uncertainty, Verdict};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Draws of figures alone, which a lattice spreads evenly, and with errors of emissivities, which are random.
const DRAWS: usize = 512;
const RANDOM_DRAWS: usize = 2048;
/// Uncertain figures of a camera at most.
const MOST_FIGURES: usize = 8;
/// Uncertain figures of which all ends together are looked at, at most.
const FEW_FIGURES: usize = 3;
/// Deviations that hold 95 % of a Gaussian.
const SURE: f64 = 1.96;
/// Draws go as many deviations far at most.
const FARTHEST: f64 = 4.0;

/// How well a margin is known.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct MarginUncertainty {
    /// Deviations to both sides that the interval holds.
    pub coverage_factor: f64,
    /// Lower end of the interval: the lower one of the two ways.
    pub low: f64,
    /// Upper end of the interval of the margin.
    pub high: f64,
    /// Standard uncertainty by first order.
    pub first_order: f64,
    /// By draws; `None` where a draw would take too long.
    pub draws: Option<Drawn>,
    /// What it is made of, by first order, the largest first.
    pub budget: Vec<BudgetLine>,
}

/// A margin by draws.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Drawn {
    /// Number of draws of the figures.
    pub count: usize,
    /// Mean margin over all draws.
    pub mean: f64,
    /// Standard deviation of the margin over all draws.
    pub deviation: f64,
    /// The interval that holds as much as ±k deviations of a Gaussian.
    pub interval: [f64; 2],
    /// Lower end of the margin by this number of draws: 95 of 100 such sets have it above.
    pub surely_above: f64,
}

/// A margin taken anew, in scenes of which more are found as they are needed.
pub(super) trait Anew: Sync {
    /// The margin of a camera in the scenes that are known.
    fn margin(&self, camera: &Camera, errors: Errors) -> Result<f64>;

    /// Those of draws, each of a camera with errors of its own if they are `random`, in the scenes known from `since` on at least, and how many
    /// are known; infinite where a draw is no camera.
    fn margins(&self, draws: &[Option<Camera>], random: bool, _since: usize) -> Result<(Vec<f64>, usize)> {
        let of = |index: usize| match &draws[index] {
            Some(camera) => self.margin(camera, Errors::of_draw(index, random)),
            None => Ok(f64::INFINITY),
        };
        Ok((parallel::try_map(draws.len(), of)?, 0))
    }

    /// Searches all scenes before a camera; whether one is found in which its margin is smaller, which is known from then on.
    fn search(&self, camera: &Camera) -> Result<bool>;

    /// The same, as thoroughly as for the camera as it is stated.
    fn search_thoroughly(&self, camera: &Camera) -> Result<bool> {
        self.search(camera)
    }
}

/// A margin that depends on no scene.
pub(super) struct Geometry<F>(pub(super) F);

impl<F: Fn(&Camera) -> f64 + Sync> Anew for Geometry<F> {
    fn margin(&self, camera: &Camera, _: Errors) -> Result<f64> {
        Ok(self.0(camera))
    }

    fn search(&self, _: &Camera) -> Result<bool> {
        Ok(false)
    }
}

/// Share by which a margin must be smaller for its scene to be a new one.
pub(super) const SMALLER: f64 = 1e-3;
/// Rounds in which scenes are searched again for draws about the lower end.
const ROUNDS: usize = 6;

/// What one figure puts on the margin.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct BudgetLine {
    /// Key of the figure, or `emissivities` for those of the library.
    pub figure: String,
    /// Its value, in the unit used inside.
    pub value: Option<f64>,
    /// Standard uncertainty of the figure, in `unit`.
    pub uncertainty: f64,
    /// Unit in which the uncertainty is given.
    pub unit: &'static str,
    /// Standard uncertainty of the margin from it alone; signed: how the margin goes with the figure.
    pub contribution: f64,
    /// Its share of the variance of the margin.
    pub share: f64,
}

/// The uncertain figures of one camera.
pub(super) struct Uncertain<'a> {
    /// What the rule says of it.
    spec: CameraSpec,
    figures: Vec<Figure>,
    /// How many errors there are: figures may share one.
    errors: usize,
    coverage_factor: f64,
    place: &'a (dyn Fn(&str) -> Place + Sync),
}

/// A figure with its error.
struct Figure {
    row: &'static figures::Row,
    value: f64,
    sigma: f64,
    rectangular: bool,
    /// Which of the errors it has.
    error: usize,
}

impl Figure {
    /// How many of its deviations its error goes, at most.
    fn reach(&self, coverage_factor: f64) -> f64 {
        if self.rectangular { 3f64.sqrt() } else { coverage_factor }
    }

    /// Its deviations where the share `p` of errors is smaller.
    fn deviations(&self, p: f64) -> f64 {
        if self.rectangular { 3f64.sqrt() * (2.0 * p - 1.0) } else { quantile(p) }
    }
}

/// Which errors of emissivities a margin is taken with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Errors {
    None,
    /// Those of a stream of random numbers.
    Stream(u64),
}

impl Errors {
    pub(super) const fn of_draw(index: usize, random: bool) -> Self {
        if random { Self::Stream(index as u64) } else { Self::None }
    }
}

impl<'a> Uncertain<'a> {
    /// Of a camera; `None` where nothing is uncertain, not even `emissivities`.
    ///
    /// # Errors
    /// A figure without a value; an uncertainty that leads out of what the figure may be.
    pub(super) fn of(
        named: &Named,
        (coverage_factor, emissivities): (f64, bool),
        place: &'a (dyn Fn(&str) -> Place + Sync),
    ) -> Result<Option<Self>> {
        // Whatever of it is uncertain, its noise is the one that is stated.
        let filed = named.spec.filed.clone().unwrap_or_else(|| Arc::new(named.spec.clone()));
        let spec = CameraSpec { filed: Some(filed), ..named.spec.clone() };
        let preset = spec.preset.as_ref().and_then(|name| presets::find(name).ok());
        let stated = |row: &figures::Row| row.number(&spec).or_else(|| row.number(&preset.as_ref()?.figures));
        let mut known: Vec<Figure> = Vec::with_capacity(named.uncertainty.len());
        let mut shared: Vec<Option<&str>> = Vec::new();
        for (key, known_of) in &named.uncertainty {
            let Known::Within(Uncertainty { sigma, rectangular, same }) = known_of else { continue };
            let Some((row, value)) = figures::row(key).and_then(|row| Some((row, stated(row)?))) else {
                let found = format!("the uncertainty of a {key} that is not stated");
                let instead = format!("write its value beside it, as in {key} = {{ value = ..., u = ... }}");
                return Err(Error::malformed(found, instead).at(place(key)));
            };
            let same = same.as_deref();
            let of_another = same.and_then(|same| shared.iter().position(|one| *one == Some(same)));
            let error = of_another.unwrap_or_else(|| {
                shared.push(same);
                shared.len() - 1
            });
            known.push(Figure { row, value, sigma: *sigma, rectangular: *rectangular, error });
        }
        if known.len() > MOST_FIGURES {
            let found = format!("{} uncertain figures", known.len());
            let instead = format!("state the uncertainty of the {MOST_FIGURES} that matter most");
            return Err(
                Error::malformed(found, instead).at(place(known.last().map_or("", |figure| figure.row.key)))
            );
        }
        let own = Self { spec, figures: known, errors: shared.len(), coverage_factor, place };
        for (index, figure) in own.figures.iter().enumerate() {
            for side in [-1.0, 1.0] {
                own.moved(index, side * figure.reach(coverage_factor))?;
            }
        }
        Ok(Some(own).filter(|own| emissivities || !own.figures.is_empty()))
    }

    /// The camera with one figure so many of its deviations away, and the others as they are.
    fn moved(&self, index: usize, deviations: f64) -> Result<Camera> {
        let at = |i: usize| if i == index { deviations } else { 0.0 };
        self.camera(&(0..self.figures.len()).map(at).collect::<Vec<_>>())
    }

    /// The camera with every error on its side, or in the middle: as far away as the interval goes.
    fn at_ends(&self, side: impl Fn(usize) -> f64) -> Result<Camera> {
        let of = |figure: &Figure| side(figure.error) * figure.reach(self.coverage_factor);
        self.camera(&self.figures.iter().map(of).collect::<Vec<_>>())
    }

    /// The camera with every figure so many of its deviations away.
    fn camera(&self, deviations: &[f64]) -> Result<Camera> {
        let mut spec = self.spec.clone();
        for (Figure { row, value, sigma, .. }, deviations) in self.figures.iter().zip(deviations) {
            let moved = value + deviations * sigma;
            let allowed = match row.kind {
                Kind::Quantity(_, allowed, _) | Kind::Number(allowed, _) | Kind::Efficiency(allowed, _) => {
                    allowed.allows(moved)
                }
                _ => false,
            };
            if !allowed {
                let unit = unit(row);
                let space = if unit.is_empty() { "" } else { " " };
                let moved = hadar::words::significant(moved, 3);
                let found =
                    format!("its uncertainty leads to {moved}{space}{unit}, which no {} can be", row.key);
                let error = Error::malformed(found, "write a smaller u");
                return Err(error.at((self.place)(row.key)));
            }
            row.put_number(&mut spec, moved);
        }
        camera::resolved_at(&spec, self.place)
    }

    /// All errors at once, each on one side or the other, as far away as the interval goes: what is as it should be in all of these is
    /// surely so.
    pub(super) fn sides(&self) -> impl Iterator<Item = Result<Camera>> + '_ {
        let side = |number: usize, error: usize| if number >> error & 1 == 1 { 1.0 } else { -1.0 };
        (0..1usize << self.errors).map(move |number| self.at_ends(|error| side(number, error)))
    }

    /// All errors on either side, or, where these are many, each of them alone: the worst scene of such a camera may be another one.
    pub(super) fn ends(&self) -> Result<Vec<Camera>> {
        if self.errors <= FEW_FIGURES {
            return self.sides().collect();
        }
        let alone = |one: usize, side: f64| self.at_ends(|error| if error == one { side } else { 0.0 });
        (0..self.errors).flat_map(|one| [-1.0, 1.0].map(|side| alone(one, side))).collect()
    }

    /// The verdict on a margin that fails `by` itself; `other` says what else is wrong with a camera.
    pub(super) fn verdict(
        uncertain: Option<Self>,
        margin: f64,
        by: Shortfall,
        own: &Named,
        other: &dyn Fn(&Camera) -> Vec<Shortfall>,
        anew: &dyn Anew,
    ) -> Result<(Judged, Option<MarginUncertainty>)> {
        let mut others = vec![other(&own.camera)];
        let mut found = None;
        if let Some(uncertain) = uncertain.filter(|_| margin > 0.0) {
            for camera in uncertain.sides() {
                others.push(other(&camera?));
            }
            found = Some(uncertain.of_margin(margin, None, anew)?);
        }
        Ok((judged(margin, found.as_ref(), (by, own.may_be_better()), &others), found))
    }

    /// The uncertainty of a `margin`; `emissivities` is what their errors put on it to first order.
    pub(super) fn of_margin(
        &self,
        margin: f64,
        emissivities: Option<(f64, f64)>,
        anew: &dyn Anew,
    ) -> Result<MarginUncertainty> {
        // First, since it finds scenes for all.
        let drawn = self.drawn(emissivities.is_some(), anew)?;
        let mut budget = Vec::with_capacity(self.figures.len() + 1);
        for (index, Figure { row, value, sigma, .. }) in self.figures.iter().enumerate() {
            let side = |deviations| anew.margin(&self.moved(index, deviations)?, Errors::None);
            let unit = unit(row);
            let contribution = 0.5 * (side(1.0)? - side(-1.0)?);
            let (figure, value, uncertainty) = (row.key.to_owned(), Some(*value), *sigma);
            budget.push(BudgetLine { figure, value, uncertainty, unit, contribution, share: 0.0 });
        }
        // Figures with the same error move the margin together.
        let mut together = vec![0.0; self.errors];
        budget
            .iter()
            .zip(&self.figures)
            .for_each(|(line, figure)| together[figure.error] += line.contribution);
        if let Some((uncertainty, contribution)) = emissivities {
            let (figure, value) = ("emissivities".to_owned(), None);
            budget.push(BudgetLine { figure, value, uncertainty, unit: "", contribution, share: 0.0 });
        }
        let errors = together.iter().copied().chain(emissivities.map(|(_, contribution)| contribution));
        let var: f64 = errors.map(|all| all * all).sum();
        for (index, line) in budget.iter_mut().enumerate().filter(|_| var > 0.0) {
            let all = self.figures.get(index).map_or(line.contribution, |figure| together[figure.error]);
            line.share = line.contribution * all / var;
        }
        order::descending(&mut budget, |b| b.share);
        let (k, first_order) = (self.coverage_factor, var.sqrt());
        let (low, high) = (margin - k * first_order, margin + k * first_order);
        // No margin is below 0.
        let (low, high) = (low.min(drawn.surely_above).max(0.0), high.max(drawn.interval[1]));
        Ok(MarginUncertainty { coverage_factor: k, low, high, first_order, draws: Some(drawn), budget })
    }

    /// All figures at once, again and again until the scenes before draws about the lower end are known.
    fn drawn(&self, random: bool, anew: &dyn Anew) -> Result<Drawn> {
        let count = if random { RANDOM_DRAWS } else { DRAWS };
        let lattice = GoldenLattice::new(vec![0.5; self.errors]);
        // What no camera can be has no margin of its own; it counts as the least that was found.
        let draw = |index: usize| {
            let point = lattice.point(index);
            let of = |figure: &Figure| figure.deviations(point[figure.error]);
            self.camera(&self.figures.iter().map(of).collect::<Vec<_>>()).ok()
        };
        let draws: Vec<Option<Camera>> = parallel::map(count, draw);
        let possible = draws.iter().flatten().count();
        let outside = detection::miss_probability(self.coverage_factor);
        let (mut margins, mut known) = (vec![f64::INFINITY; count], 0);
        let mut ordered: Vec<usize> = (0..count).collect();
        let mut searched = BTreeSet::new();
        for _ in 0..ROUNDS {
            let (found, all) = anew.margins(&draws, random, known)?;
            known = all;
            margins.iter_mut().zip(found).for_each(|(margin, found)| *margin = margin.min(found));
            order::ascending(&mut ordered, |index| margins[*index]);
            let mean = possible as f64 * outside;
            // About the lower end, and the lowest of all.
            let ranks = [0.0, mean - 2.0 * mean.sqrt(), mean, mean + 2.0 * mean.sqrt()];
            let mut ranks = ranks.map(|rank| rank.max(0.0) as usize).to_vec();
            ranks.dedup();
            let mut found = false;
            let near =
                |rank: usize| ordered.get(rank).and_then(|index| Some((*index, draws[*index].as_ref()?)));
            for (index, camera) in ranks.iter().filter_map(|rank| near(*rank)) {
                // What a draw has to show is found once.
                found |= searched.insert((index, false)) && anew.search(camera)?;
            }
            if let (false, Some((index, camera))) = (found, near(mean as usize)) {
                found = searched.insert((index, true)) && anew.search_thoroughly(camera)?;
            }
            if !found {
                break;
            }
        }
        let ordered = ordered.into_iter().filter(|index| draws[*index].is_some());
        let margins: Vec<f64> = ordered.map(|index| margins[index]).collect();
        let least = margins.first().copied();
        let margins: Vec<f64> =
            std::iter::repeat_n(least, count - possible).flatten().chain(margins).collect();
        let n = margins.len() as f64;
        let mean = margins.iter().sum::<f64>() / n.max(1.0);
        let squares: f64 = margins.iter().map(|margin| (margin - mean) * (margin - mean)).sum();
        let deviation = (squares / (n - 1.0).max(1.0)).sqrt();
        let at = |share: f64| crate::identify::quantile(&margins, share);
        // Points of a lattice in one dimension are within one of their share, in more as scattered as random ones.
        let scatter =
            if self.errors == 1 && !random { 1.0 } else { SURE * (n * outside * (1.0 - outside)).sqrt() };
        let surer = n * outside - scatter;
        let surely_above = margins.get(surer.max(0.0) as usize).copied().unwrap_or(f64::NAN);
        let interval = [at(outside), at(1.0 - outside)];
        Ok(Drawn { count: possible, mean, deviation, interval, surely_above: surely_above.min(interval[0]) })
    }
}

/// The unit of a figure inside.
fn unit(row: &figures::Row) -> &'static str {
    match row.kind {
        Kind::Quantity(dimension, ..) => dimension.unit(),
        _ => "",
    }
}

/// What a camera does not meet, and what it may or may not.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Judged {
    pub(super) verdict: Verdict,
    pub(super) fails_by: Vec<Shortfall>,
    pub(super) undecided_by: Vec<Shortfall>,
}

/// The verdict on a margin, which fails `by` itself, with what else is wrong: as it is, and with every figure on either side. A camera whose figures
/// are limits, which `may_be_better`, does not fail by its margin.
pub(super) fn judged(
    margin: f64,
    uncertainty: Option<&MarginUncertainty>,
    (by, may_be_better): (Shortfall, bool),
    others: &[Vec<Shortfall>],
) -> Judged {
    let [low, high] = uncertainty.map_or([margin; 2], |interval| [interval.low, interval.high]);
    let (mut fails_by, mut undecided_by) = (Vec::new(), Vec::new());
    // What is no number is not met.
    if (high < 1.0 && !may_be_better) || high.is_nan() {
        fails_by.push(by);
    } else if low < 1.0 || low.is_nan() {
        undecided_by.push(by);
    }
    for shortfall in others.iter().flatten() {
        let list = match others.iter().all(|one| one.contains(shortfall)) {
            true => &mut fails_by,
            false => &mut undecided_by,
        };
        if !list.contains(shortfall) {
            list.push(*shortfall);
        }
    }
    let verdict = match (fails_by.is_empty(), undecided_by.is_empty()) {
        (false, _) => Verdict::Fails,
        (true, false) => Verdict::Undecided,
        (true, true) => Verdict::Meets,
    };
    Judged { verdict, fails_by, undecided_by }
}

/// Deviations of a Gaussian below which the share `p` lies.
fn quantile(p: f64) -> f64 {
    let deviations = match p {
        p if p < 0.5 => -detection::distance_for_miss(p).unwrap_or(FARTHEST),
        p if p > 0.5 => detection::distance_for_miss(1.0 - p).unwrap_or(FARTHEST),
        _ => 0.0,
    };
    deviations.clamp(-FARTHEST, FARTHEST)
}
