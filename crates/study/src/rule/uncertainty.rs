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
//! figures at their ends: another camera may have another worst scene. The interval is the wider one of the two. A camera meets a
//! demand if the interval is above 1, fails if it is below, and is undecided between: the limits are guarded by k u on both sides.
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
use hadar_scenario::rule::Verdict;
use std::sync::Arc;

/// Draws of figures alone, which a lattice spreads evenly, and with errors of emissivities, which are random.
const DRAWS: usize = 512;
const RANDOM_DRAWS: usize = 2048;
/// Uncertain figures of a camera at most.
const MOST_FIGURES: usize = 8;
/// Uncertain figures of which all ends together are looked at, at most.
const FEW_FIGURES: usize = 3;
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
    /// Upper end.
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
    /// How many.
    pub count: usize,
    /// Their mean.
    pub mean: f64,
    /// Their deviation.
    pub deviation: f64,
    /// The interval that holds as much as ±k deviations of a Gaussian.
    pub interval: [f64; 2],
}

/// What one figure puts on the margin.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct BudgetLine {
    /// Its key, or `emissivities`.
    pub figure: String,
    /// Its value, in the unit used inside.
    pub value: Option<f64>,
    /// Its standard uncertainty.
    pub uncertainty: f64,
    /// That unit.
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
    figures: Vec<(&'static figures::Row, f64, f64)>,
    coverage_factor: f64,
    place: &'a (dyn Fn(&str) -> Place + Sync),
}

/// Which errors of emissivities a margin is taken with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Errors {
    None,
    /// Those of a stream of random numbers.
    Stream(u64),
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
        let mut known = Vec::with_capacity(named.uncertainty.len());
        for (key, u) in &named.uncertainty {
            let Some((row, value)) = figures::row(key).and_then(|row| Some((row, stated(row)?))) else {
                let found = format!("the uncertainty of a {key} that is not stated");
                let instead = format!("write its value beside it, as in {key} = {{ value = ..., u = ... }}");
                return Err(Error::malformed(found, instead).at(place(key)));
            };
            known.push((row, value, *u));
        }
        if known.len() > MOST_FIGURES {
            let found = format!("{} uncertain figures", known.len());
            let instead = format!("state the uncertainty of the {MOST_FIGURES} that matter most");
            return Err(
                Error::malformed(found, instead).at(place(known.last().map_or("", |(row, ..)| row.key)))
            );
        }
        let own = Self { spec, figures: known, coverage_factor, place };
        for index in 0..own.figures.len() {
            for side in [-coverage_factor, coverage_factor] {
                own.moved(index, side)?;
            }
        }
        Ok(Some(own).filter(|own| emissivities || !own.figures.is_empty()))
    }

    /// The camera with one figure so many of its deviations away, and the others as they are.
    fn moved(&self, index: usize, deviations: f64) -> Result<Camera> {
        let at = |i: usize| if i == index { deviations } else { 0.0 };
        self.camera(&(0..self.figures.len()).map(at).collect::<Vec<_>>())
    }

    /// The camera with every figure so many of its deviations away.
    fn camera(&self, deviations: &[f64]) -> Result<Camera> {
        let mut spec = self.spec.clone();
        for ((row, value, u), deviations) in self.figures.iter().zip(deviations) {
            let moved = value + deviations * u;
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

    /// All figures at once, each on one side or the other, as far away as the interval goes: what is as it should be in all of these is
    /// surely so.
    pub(super) fn sides(&self) -> impl Iterator<Item = Result<Camera>> + '_ {
        let count = self.figures.len();
        (0..1usize << count).map(move |number| {
            let side = |bit: usize| {
                if number >> bit & 1 == 1 { self.coverage_factor } else { -self.coverage_factor }
            };
            self.camera(&(0..count).map(side).collect::<Vec<_>>())
        })
    }

    /// All figures on either side, or, where these are many, each of them alone: the worst scene of such a camera may be another one.
    pub(super) fn ends(&self) -> Result<Vec<Camera>> {
        if self.figures.len() <= FEW_FIGURES {
            return self.sides().collect();
        }
        let sides = [-self.coverage_factor, self.coverage_factor];
        (0..self.figures.len()).flat_map(|index| sides.map(|side| self.moved(index, side))).collect()
    }

    /// The verdict on a margin, taken anew by `of`, that fails `by` itself; `other` says what else is wrong with a camera.
    pub(super) fn verdict(
        uncertain: Option<Self>,
        margin: f64,
        (by, draw): (Shortfall, bool),
        own: &Camera,
        other: &dyn Fn(&Camera) -> Vec<Shortfall>,
        of: &(dyn Fn(&Camera) -> Result<f64> + Sync),
    ) -> Result<(Judged, Option<MarginUncertainty>)> {
        let mut others = vec![other(own)];
        let mut found = None;
        if let Some(uncertain) = uncertain.filter(|_| margin > 0.0) {
            for camera in uncertain.sides() {
                others.push(other(&camera?));
            }
            found = Some(uncertain.of_margin(margin, None, draw, &|camera, _| of(camera))?);
        }
        Ok((judged(margin, found.as_ref(), by, &others), found))
    }

    /// The uncertainty of a `margin`, taken anew by `of`; `emissivities` is what their errors put on it to first order.
    pub(super) fn of_margin(
        &self,
        margin: f64,
        emissivities: Option<(f64, f64)>,
        draw: bool,
        of: &(dyn Fn(&Camera, Errors) -> Result<f64> + Sync),
    ) -> Result<MarginUncertainty> {
        let mut budget = Vec::with_capacity(self.figures.len() + 1);
        for (index, (row, value, u)) in self.figures.iter().enumerate() {
            let side = |deviations| of(&self.moved(index, deviations)?, Errors::None);
            let unit = unit(row);
            let contribution = 0.5 * (side(1.0)? - side(-1.0)?);
            let (figure, value, uncertainty) = (row.key.to_owned(), Some(*value), *u);
            budget.push(BudgetLine { figure, value, uncertainty, unit, contribution, share: 0.0 });
        }
        if let Some((uncertainty, contribution)) = emissivities {
            let (figure, value) = ("emissivities".to_owned(), None);
            budget.push(BudgetLine { figure, value, uncertainty, unit: "", contribution, share: 0.0 });
        }
        let var: f64 = budget.iter().map(|line| line.contribution * line.contribution).sum();
        for line in budget.iter_mut().filter(|_| var > 0.0) {
            line.share = line.contribution * line.contribution / var;
        }
        order::descending(&mut budget, |b| b.share);
        let (k, first_order) = (self.coverage_factor, var.sqrt());
        let draws = if draw { Some(self.drawn(emissivities.is_some(), of)?) } else { None };
        let [mut low, mut high] = [margin - k * first_order, margin + k * first_order];
        if let Some(Drawn { interval, .. }) = draws {
            (low, high) = (low.min(interval[0]), high.max(interval[1]));
        }
        Ok(MarginUncertainty { coverage_factor: k, low, high, first_order, draws, budget })
    }

    fn drawn(&self, random: bool, of: &(dyn Fn(&Camera, Errors) -> Result<f64> + Sync)) -> Result<Drawn> {
        let count = if random { RANDOM_DRAWS } else { DRAWS };
        let lattice = GoldenLattice::new(vec![0.5; self.figures.len()]);
        let draw = |index: usize| {
            let deviations: Vec<f64> = lattice.point(index).into_iter().map(quantile).collect();
            // What no camera can be is not drawn; the interval does not reach there.
            let Ok(camera) = self.camera(&deviations) else { return Ok(None) };
            let errors = if random { Errors::Stream(index as u64) } else { Errors::None };
            of(&camera, errors).map(Some)
        };
        let drawn: Vec<Option<f64>> = parallel::try_map(count, draw)?;
        let mut margins: Vec<f64> = drawn.into_iter().flatten().collect();
        margins.sort_by(f64::total_cmp);
        let count = margins.len();
        let mean = margins.iter().sum::<f64>() / count.max(1) as f64;
        let squares: f64 = margins.iter().map(|margin| (margin - mean) * (margin - mean)).sum();
        let deviation = (squares / count.saturating_sub(1).max(1) as f64).sqrt();
        let outside = detection::miss_probability(self.coverage_factor);
        let at = |share: f64| crate::identify::quantile(&margins, share);
        Ok(Drawn { count, mean, deviation, interval: [at(outside), at(1.0 - outside)] })
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

/// The verdict on a margin, which fails `by` itself, with what else is wrong: as it is, and with every figure on either side.
pub(super) fn judged(
    margin: f64,
    uncertainty: Option<&MarginUncertainty>,
    by: Shortfall,
    others: &[Vec<Shortfall>],
) -> Judged {
    let [low, high] = uncertainty.map_or([margin; 2], |interval| [interval.low, interval.high]);
    let (mut fails_by, mut undecided_by) = (Vec::new(), Vec::new());
    // What is no number is not met.
    if high < 1.0 || high.is_nan() {
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
