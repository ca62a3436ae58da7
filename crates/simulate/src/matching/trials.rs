//! Matches of views with noise drawn again and again.
//!
//! Every sample that a window, or the search for it, needs is drawn about its expected counts, and no other:
//! Poisson photons and normal electronic noise. The views of trial i have streams 2i (left) and 2i + 1 (right)
//! of the run's.

use super::Matcher;
use super::layout::{Layout, View};
use super::likelihood::Scratch;
use super::search::{Match, Search, StereoPair, check_window};
use super::strip::Strip;
use crate::draws::{Draws, STREAMS, generator};
use hadar::error::{Error, Result, check};
use hadar::ranging::noise::NoiseVariance;
use hadar::statistics::Statistics;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::ops::Range;

pub use super::likelihood::Noisy;
pub use crate::thermometry::Run;

/// Columns beyond the search that an interpolation may look at.
const MARGIN: usize = 16;
/// Trials that a thread takes at least.
const TOGETHER: usize = 4;

/// A window of the left view.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Centre {
    /// Row of the middle of the window, counted from 0.
    pub row: usize,
    /// Column of the middle of the window, counted from 0.
    pub column: usize,
    /// True disparity at the middle of the window, pixels.
    pub disparity: f64,
}

/// What is matched.
#[derive(Debug, Clone, Copy)]
pub struct Setup<'a> {
    /// Expected counts.
    pub pair: &'a StereoPair<'a>,
    /// Electronic noise of either view.
    pub noise: &'a NoiseVariance,
    /// Which views are noisy.
    pub noisy: Noisy,
    /// How they are matched.
    pub matcher: Matcher,
    /// Disparities tried.
    pub search: Search,
    /// Windows matched.
    pub centres: &'a [Centre],
}

/// Matches of all windows.
#[derive(Debug, Clone, PartialEq)]
pub struct Matches {
    /// The windows.
    pub centres: Vec<Centre>,
    /// Without noise.
    pub noise_free: Vec<Match>,
    /// `[trial][window]`.
    pub trials: Vec<Match>,
}

impl Matches {
    /// Matches of one window, trial after trial.
    pub fn of(&self, centre: usize) -> impl Iterator<Item = Match> + '_ {
        self.trials.iter().skip(centre).step_by(self.centres.len().max(1)).copied()
    }
}

/// Repeated matches, ready to run.
///
/// ```
/// use hadar::cube::Shape;
/// use hadar::ranging::{information::Window, noise::NoiseVariance};
/// use hadar_simulate::matching::{Matcher, Search, StereoPair, block::Block, texture::Texture};
/// use hadar_simulate::matching::trials::{Centre, MatchingTrials, Noisy, Run, Setup};
/// let shape = Shape::new(5, 60, 1)?;
/// let texture = Texture::random(1, &[1e5], 0.1, 0.2, 40)?;
/// let (left, right) = (texture.view(shape, 0.0)?, texture.view(shape, 6.25)?);
/// let trials = MatchingTrials::new(&Setup {
///     pair: &StereoPair::new(shape, &left, &right)?,
///     noise: &NoiseVariance::Uniform(100.0),
///     noisy: Noisy::Both,
///     matcher: Matcher::Block(Block::new(Window::new(5, 5)?)),
///     search: Search::new(0, 15)?,
///     centres: &[Centre { row: 2, column: 40, disparity: 6.25 }],
/// })?;
/// let matches = trials.run(Run { index: 0, trials: 10, seed: 1 });
/// assert!(matches.of(0).all(|found| (found.unwrap() - 6.25).abs() < 0.3));
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug)]
pub struct MatchingTrials {
    matcher: Matcher,
    search: Search,
    noisy: Noisy,
    centres: Vec<Centre>,
    groups: Vec<Group>,
    layouts: [Layout; 2],
    expected: [Vec<f64>; 2],
    var: Vec<f64>,
    draws: [Draws; 2],
}

/// Windows of the same row.
#[derive(Debug, Default)]
struct Group {
    row: usize,
    columns: Vec<usize>,
    numbers: Vec<usize>,
}

/// A thread's.
struct Workspace {
    strip: Option<Strip>,
    scratch: Scratch,
    readings: [Vec<f64>; 2],
}

impl MatchingTrials {
    /// Prepares them.
    ///
    /// # Errors
    /// No window at all, one that reaches beyond the left view, or a true disparity outside the search;
    /// negative counts or noise that does not fit, where they are needed.
    pub fn new(setup: &Setup) -> Result<Self> {
        let (shape, window, search) = (setup.pair.shape(), setup.matcher.window(), setup.search);
        check_window(window, shape)?;
        if setup.centres.is_empty() {
            return Err(Error::malformed("no windows to match", "give at least one centre"));
        }
        let half = [window.half_rows(), window.half_columns()];
        let mut groups = BTreeMap::<usize, Group>::new();
        for (number, centre) in setup.centres.iter().enumerate() {
            let fits = |at: usize, half: usize, all: usize| at >= half && at < all - half;
            if !fits(centre.row, half[0], shape.rows()) || !fits(centre.column, half[1], shape.columns()) {
                let found = format!("a window about row {}, column {}", centre.row, centre.column);
                return Err(Error::malformed(found, "give centres whose window lies within the image"));
            }
            let (least, most) = (f64::from(search.least()), f64::from(search.most()));
            if !(least..=most).contains(&centre.disparity) {
                let expected = format!("within the search, {least} to {most}");
                return Err(Error::out_of_range("true disparity", centre.disparity, "pixels", expected));
            }
            let group = groups.entry(centre.row).or_default();
            group.row = centre.row;
            group.columns.push(centre.column);
            group.numbers.push(number);
        }
        let groups: Vec<Group> = groups.into_values().collect();
        let margin = if matches!(setup.matcher, Matcher::Likelihood(_)) { MARGIN } else { 0 };
        let [mut left, mut right] = [Vec::new(), Vec::new()];
        for group in &groups {
            let rows = group.row - half[0]..group.row + half[0] + 1;
            let hull = hull(&group.columns);
            left.push((rows.clone(), hull.start - half[1]..hull.end + half[1]));
            let start = hull.start as i64 - (half[1] + margin) as i64 - i64::from(search.most());
            let end = hull.end as i64 + (half[1] + margin) as i64 - i64::from(search.least());
            right.push((rows, start.max(0) as usize..end.max(0) as usize));
        }
        let layouts = [Layout::around(shape, &left), Layout::around(shape, &right)];
        let expected = [layouts[0].gather(setup.pair.left()), layouts[1].gather(setup.pair.right())];
        let var = [layouts[0].variances(setup.noise)?, layouts[1].variances(setup.noise)?];
        let draws = [draws(&expected[0], &var[0])?, draws(&expected[1], &var[1])?];
        let [var, _] = var;
        let centres = setup.centres.to_vec();
        Ok(Self {
            matcher: setup.matcher,
            search,
            noisy: setup.noisy,
            centres,
            groups,
            layouts,
            expected,
            var,
            draws,
        })
    }

    /// Samples drawn in a trial, of both views.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.layouts[0].len() + if self.noisy == Noisy::Both { self.layouts[1].len() } else { 0 }
    }

    /// Matches without noise and of all trials.
    #[must_use]
    pub fn run(&self, run: Run) -> Matches {
        let mut workspace = self.workspace();
        let [left, right] = &self.expected;
        let noise_free = self.matches(&mut workspace, left, right);
        let first = u64::from(run.index).wrapping_mul(STREAMS);
        let trials: Vec<Vec<Match>> = (0..run.trials)
            .into_par_iter()
            .with_min_len(TOGETHER)
            .map_init(
                || self.workspace(),
                |workspace, trial| {
                    hadar::stop::check();
                    let mut readings = std::mem::take(&mut workspace.readings);
                    let noisy = if self.noisy == Noisy::Both { 2 } else { 1 };
                    for (view, (draws, readings)) in
                        (0_u64..).zip(self.draws.iter().zip(&mut readings).take(noisy))
                    {
                        let stream = first.wrapping_add(2 * trial as u64 + view);
                        draws.draw_into(&mut generator(run.seed, stream), readings);
                    }
                    let [left, right] = &readings;
                    let matches = self.matches(workspace, left, right);
                    workspace.readings = readings;
                    matches
                },
            )
            .collect();
        Matches { centres: self.centres.clone(), noise_free, trials: trials.into_iter().flatten().collect() }
    }

    fn workspace(&self) -> Workspace {
        let strip = match &self.matcher {
            Matcher::Block(block) => Some(block.strip(self.search)),
            Matcher::Likelihood(_) => None,
        };
        Workspace { strip, scratch: Scratch::default(), readings: self.expected.clone() }
    }

    fn matches(&self, workspace: &mut Workspace, left: &[f64], right: &[f64]) -> Vec<Match> {
        let views = [
            View { layout: &self.layouts[0], samples: left },
            View { layout: &self.layouts[1], samples: right },
        ];
        let mut all = vec![Ok(f64::NAN); self.centres.len()];
        let mut put = |number: Option<&usize>, found| {
            if let Some(to) = number.and_then(|number| all.get_mut(*number)) {
                *to = found;
            }
        };
        match (&self.matcher, &mut workspace.strip) {
            (Matcher::Block(block), Some(strip)) => {
                for group in &self.groups {
                    let put = |at: usize, found| put(group.numbers.get(at), found);
                    block.row(strip, views, group.row, &group.columns, self.search, put);
                }
            }
            (Matcher::Likelihood(likelihood), _) => {
                let scratch = &mut workspace.scratch;
                likelihood.prepare(scratch, views[1]);
                for group in &self.groups {
                    likelihood.row(scratch, views, &self.var, group.row, &hull(&group.columns), self.search);
                    for (column, number) in group.columns.iter().zip(&group.numbers) {
                        put(
                            Some(number),
                            likelihood.window(scratch, views[1], self.noisy, *column, self.search),
                        );
                    }
                }
            }
            (Matcher::Block(_), None) => {}
        }
        all
    }
}

/// From the first to the last one.
fn hull(columns: &[usize]) -> Range<usize> {
    let first = columns.iter().copied().min().unwrap_or(0);
    first..columns.iter().copied().max().map_or(first, |last| last + 1)
}

fn draws(means: &[f64], var: &[f64]) -> Result<Draws> {
    means.iter().try_for_each(|&mean| check::non_negative("expected counts", mean, "counts").map(drop))?;
    let draws = Draws::new(&Statistics::Poisson, means)?;
    if var.iter().all(|var| *var == 0.0) { Ok(draws) } else { draws.with_electronic_noise(var) }
}
