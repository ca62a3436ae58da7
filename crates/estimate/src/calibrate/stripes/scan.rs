//! The striped lines of one band.

use super::fit::{Fitted, fitted, median, scatter};
use super::segments::Segments;

/// Deviations above which a line is off.
const OFF: f64 = 6.0;
/// Share of its segments that a stripe is seen in.
const ALONG: f64 = 0.8;
/// Rounds in which lines are set apart.
const ROUNDS: usize = 8;
/// Farthest line that stands for a neighbour.
const FARTHEST: usize = 8;
/// Deviations by which two references differ where an edge lies between them.
const EDGE: f64 = 4.0;
/// Part of a line that is looked at for itself; deviations by which it is off from the line; share of the stripe below which it is none.
const PARTS: usize = 16;
const APART: f64 = 5.0;
const NEARER: f64 = 0.6;
/// Scatter of lines, over that of a segment, from which on they vary; share of it below which a line between them does not.
const CONTRAST: f64 = 6.0;
const FLAT: f64 = 0.2;
/// Clean lines of a band on which it is tried what would be seen, and how often what they are off by is doubled.
const TRIED: usize = 24;
const DOUBLED: u32 = 24;
/// Rounding of samples of 32 bits, relative.
const ROUNDING: f64 = 1e-7;

/// A band that was looked at.
#[derive(Debug)]
pub(super) struct Band {
    /// Lines that have samples.
    pub(super) usable: usize,
    /// Striped lines that have no clean one near.
    pub(super) without_reference: usize,
    /// Median of its lines.
    pub(super) level: f64,
    /// Every line against the clean ones beside it.
    pub(super) fits: Vec<Option<Fitted>>,
    /// Whether all of a line follows its gain and offset.
    pub(super) follows: Vec<bool>,
    /// Lines that are off from both sides the same way, all along.
    pub(super) candidate: Vec<bool>,
    /// Least scatter of the segments.
    pub(super) least: f64,
    /// Deviation of the gains.
    pub(super) prior: f64,
    /// Lines of one value.
    pub(super) dead: Vec<bool>,
    look: Vec<Look>,
    lines: Lines,
}

impl Band {
    /// Whether a line is off from its two neighbours the same way, a ridge or none.
    pub(super) fn is_ridge(&self, line: usize) -> bool {
        self.lines.is_off(line, false)
    }

    /// How far a clean line must be off to be set apart, tried on some of them: nine of ten are by so much; NaN of none.
    pub(super) fn seen_from(&self) -> f64 {
        let clean: Vec<usize> = (0..self.lines.clean.len()).filter(|line| self.lines.clean[*line]).collect();
        let every = clean.len().div_ceil(TRIED).max(1);
        let some = clean.iter().step_by(every);
        let mut from: Vec<f64> = some.filter_map(|line| self.lines.seen_from(*line)).collect();
        from.sort_by(f64::total_cmp);
        from.get(from.len() * 9 / 10).copied().unwrap_or(f64::NAN)
    }

    /// Sets more lines apart, and looks at all of them beside those that are left.
    pub(super) fn again(&mut self, more: &[usize]) {
        for line in more {
            if let (Some(look), Some(clean)) = (self.look.get_mut(*line), self.lines.clean.get_mut(*line)) {
                (*look, *clean) = (Look::Second, false);
            }
        }
        let (look, lines) = (&self.look, &self.lines);
        let all = 0..look.len();
        // Beside all those that were set apart since, it may look clean.
        self.candidate = all
            .clone()
            .map(|line| match look[line] {
                Look::None => false,
                own => lines.is_off(line, own == Look::First),
            })
            .collect();
        let fits: Vec<Option<(Fitted, bool)>> = all.map(|line| lines.fit(line)).collect();
        self.follows = fits.iter().map(|fit| fit.is_none_or(|(_, follows)| follows)).collect();
        self.fits = fits.into_iter().map(|fit| fit.map(|(fit, _)| fit)).collect();
        // A line that was set apart and is a candidate no more, as nothing is left to compare it with, is none to be called clean.
        let pairs = self.look.iter().zip(&self.fits);
        self.without_reference = pairs.filter(|(own, fit)| **own != Look::None && fit.is_none()).count();
    }

    /// The segments of a line.
    pub(super) fn means(&self, line: usize) -> &[f64] {
        self.lines.means.get(line).map_or(&[], Vec::as_slice)
    }

    /// Whether a line was set apart, and has nothing left to compare it with.
    pub(super) fn is_alone(&self, line: usize) -> bool {
        self.look.get(line).is_some_and(|look| *look != Look::None)
            && matches!(self.fits.get(line), Some(None))
    }

    /// How far a line that looks striped, or any, is off; 0 of a clean one.
    pub(super) fn offset(&self, line: usize, any: bool) -> f64 {
        let own = any || self.candidate.get(line).copied().unwrap_or(false);
        let fit = self.fits.get(line).copied().flatten().filter(|_| own);
        fit.map_or(0.0, |fit| fit.off)
    }
}

/// Lines of a band with what is known of them.
#[derive(Debug)]
struct Lines {
    means: Vec<Vec<f64>>,
    /// Lines that may stand for others.
    clean: Vec<bool>,
    /// Scatter of a segment's difference from its neighbour.
    least: f64,
    prior: f64,
}

/// Looks at a band.
pub(super) fn striped(segments: &Segments, band: usize, prior: f64) -> Band {
    let mut means = segments.of_band(band);
    let mut dead = segments.flat(band);
    let there = |line: &Vec<f64>| 2 * line.iter().filter(|mean| mean.is_finite()).count() >= line.len();
    let mut clean: Vec<bool> = means.iter().zip(&dead).map(|(line, dead)| there(line) && !dead).collect();
    let own = |(line, dead): (&mut Vec<f64>, &bool)| {
        if *dead {
            line.fill(f64::NAN);
        }
    };
    means.iter_mut().zip(&dead).for_each(own);
    let finite = means.iter().flatten().copied().filter(|mean| mean.is_finite());
    let level = median(&mut finite.collect::<Vec<f64>>());
    let mut within: Vec<f64> = means
        .windows(2)
        .filter_map(|pair| {
            let apart: Vec<f64> =
                pair[0].iter().zip(&pair[1]).map(|(a, b)| a - b).filter(|d| d.is_finite()).collect();
            (apart.len() > 5).then(|| scatter(&apart))
        })
        .collect();
    let least = median(&mut within).max(ROUNDING * level.abs());
    for line in without_contrast(&means, least) {
        (dead[line], clean[line]) = (true, false);
        means[line].fill(f64::NAN);
    }
    let usable = clean.iter().filter(|clean| **clean).count();
    let mut lines = Lines { means, clean, least, prior };
    let mut flagged = vec![false; segments.lines];
    for _ in 0..ROUNDS {
        let more: Vec<usize> =
            (0..segments.lines).filter(|line| lines.clean[*line] && lines.is_off(*line, true)).collect();
        if more.is_empty() {
            break;
        }
        for line in more {
            flagged[line] = true;
            lines.clean[line] = false;
        }
    }
    let look = flagged.iter().map(|flagged| if *flagged { Look::First } else { Look::None }).collect();
    let mut band = Band {
        usable,
        without_reference: 0,
        level,
        fits: Vec::new(),
        follows: Vec::new(),
        candidate: Vec::new(),
        least,
        prior,
        dead,
        look,
        lines,
    };
    band.again(&[]);
    band
}

/// Lines that do not vary where both lines beside them do: nothing of the scene is in them.
fn without_contrast(means: &[Vec<f64>], least: f64) -> Vec<usize> {
    let is = |(l, three): (usize, &[Vec<f64>])| {
        let [above, own, below] = three else { return None };
        let [above, own, below] = [above, own, below].map(|line| {
            let there: Vec<f64> = line.iter().copied().filter(|mean| mean.is_finite()).collect();
            scatter(&there)
        });
        let beside = above.min(below);
        (beside > CONTRAST * least && own < FLAT * beside).then_some(l + 1)
    };
    means.windows(3).enumerate().filter_map(is).collect()
}

/// When a line was set apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Look {
    None,
    /// By this band alone.
    First,
    /// As the bands beside show nothing of it.
    Second,
}

impl Lines {
    /// The two nearest clean lines on a side.
    fn clean_on(&self, line: usize, up: bool) -> Vec<usize> {
        let near = 1..=FARTHEST;
        let place = |by: usize| if up { line.checked_sub(by) } else { Some(line + by) };
        near.filter_map(place).filter(|at| self.clean.get(*at) == Some(&true)).take(2).collect()
    }

    /// The clean lines on both sides at a segment, the farther one extrapolated beyond the ends of the image, with the share of the first.
    fn sides(&self, line: usize) -> Option<[Vec<f64>; 3]> {
        let (above, below) = (self.clean_on(line, true), self.clean_on(line, false));
        let of = |at: usize| self.means.get(at);
        let beyond = |near: &[f64], far: &[f64], [a, b]: [usize; 2]| -> Vec<f64> {
            let share = line.abs_diff(a) as f64 / a.abs_diff(b) as f64;
            near.iter().zip(far).map(|(near, far)| near + (near - far) * share).collect()
        };
        match (above.as_slice(), below.as_slice()) {
            ([a, ..], [b, ..]) => {
                let share = line.abs_diff(*b) as f64 / a.abs_diff(*b) as f64;
                let between = of(*a)?.iter().zip(of(*b)?).map(|(a, b)| share * a + (1.0 - share) * b);
                Some([of(*a)?.clone(), of(*b)?.clone(), between.collect()])
            }
            ([a, b, ..], []) | ([], [a, b, ..]) => {
                let far = beyond(of(*a)?, of(*b)?, [*a, *b]);
                Some([of(*a)?.clone(), far.clone(), far])
            }
            _ => None,
        }
    }

    /// What the clean lines on each side say of a line: the nearest, and the two nearest on a straight line.
    fn told(&self, line: usize, straight: bool) -> Vec<Vec<f64>> {
        let mut told = Vec::new();
        for up in [true, false] {
            let near = self.clean_on(line, up);
            let means = |place: Option<&usize>| place.and_then(|at| self.means.get(*at));
            if let Some(one) = means(near.first()) {
                told.push(one.clone());
                if straight && let Some(straight) = self.straight(line, up) {
                    told.push(straight);
                }
            }
        }
        told
    }

    /// How far a line must be off on either side to be set apart, to a tenth.
    fn seen_from(&self, line: usize) -> Option<f64> {
        let is_seen = |off: f64| self.would_be_off(line, true, off) && self.would_be_off(line, true, -off);
        let mut doubled = (0..DOUBLED).map(|times| self.least * f64::from(1_u32 << times));
        let mut high = doubled.find(|off| is_seen(*off))?;
        let mut low = 0.5 * high;
        for _ in 0..3 {
            let middle = 0.5 * (low + high);
            *(if is_seen(middle) { &mut high } else { &mut low }) = middle;
        }
        Some(high)
    }

    /// Whether a line is off the same way from all that both sides say, all along: no edge, no slope and, with straight lines, no ridge is.
    fn is_off(&self, line: usize, straight: bool) -> bool {
        self.would_be_off(line, straight, 0.0)
    }

    /// The same of a line that were off by `more`.
    fn would_be_off(&self, line: usize, straight: bool, more: f64) -> bool {
        let Some([_, _, between]) = self.sides(line) else { return false };
        let Some(own) = self.means.get(line) else { return false };
        let told = self.told(line, straight);
        let off: Vec<f64> = own
            .iter()
            .enumerate()
            .map(|(i, own)| {
                let mut least = f64::INFINITY;
                for told in &told {
                    let apart = own + more - told.get(i).copied().unwrap_or(f64::NAN);
                    if apart.is_nan() {
                        return f64::NAN;
                    }
                    if least.is_infinite() {
                        least = apart;
                    } else if apart * least <= 0.0 {
                        return 0.0;
                    } else if apart.abs() < least.abs() {
                        least = apart;
                    }
                }
                least
            })
            .collect();
        let Some(fit) = fitted(&between, &off, self.least, self.prior) else { return false };
        let (mut square, mut seen, mut same) = (0.0, 0.0, 0.0);
        for (x, off) in between.iter().zip(&off) {
            let model = fit.at(*x);
            if !(model.is_finite() && off.is_finite()) {
                continue;
            }
            square += model * model;
            if model.abs() > 0.5 * self.least {
                seen += 1.0;
                same += f64::from(u8::from(off * model > 0.0));
            }
        }
        let there = off.iter().filter(|off| off.is_finite()).count() as f64;
        square.sqrt() > OFF * self.least && 2.0 * seen > there && same >= ALONG * seen
    }

    /// Gain and offset of a line from the clean ones beside it, and whether all of the line follows them.
    fn fit(&self, line: usize) -> Option<(Fitted, bool)> {
        let [one, other, between] = self.sides(line)?;
        let own = self.means.get(line)?;
        let straight = [true, false].map(|up| self.straight(line, up));
        // A slope is no edge: straight lines from both sides meet on it.
        let edge: Vec<bool> = (0..own.len())
            .map(|i| {
                let apart = (one[i] - other[i]).abs();
                let meet = match &straight {
                    [Some(a), Some(b)] => (a[i] - b[i]).abs() <= (0.5 * apart).max(1.5 * EDGE * self.least),
                    _ => false,
                };
                apart > EDGE * self.least && !meet
            })
            .collect();
        let rule = 2 * edge.iter().filter(|edge| **edge).count() > edge.len();
        let mut found: Option<(Fitted, bool)> = None;
        for _ in 0..3 {
            let reference: Vec<f64> = (0..own.len())
                .map(|i| {
                    if !edge[i] {
                        return between[i];
                    }
                    let Some((fit, _)) = &found else {
                        // The nearer side would hide a part of the stripe: only where all of the line lies at an edge.
                        return match rule {
                            false => f64::NAN,
                            true if (own[i] - one[i]).abs() < (own[i] - other[i]).abs() => one[i],
                            true => other[i],
                        };
                    };
                    // What the line would read if it were clean.
                    let clean = own[i] - fit.at(between[i]);
                    let near = |x: f64| (x - clean).abs();
                    if near(between[i]) < near(one[i]).min(near(other[i])) {
                        between[i]
                    } else if near(one[i]) < near(other[i]) {
                        one[i]
                    } else {
                        other[i]
                    }
                })
                .collect();
            let off: Vec<f64> = own.iter().zip(&reference).map(|(own, x)| own - x).collect();
            let fit = match fitted(&reference, &off, 0.5 * self.least, self.prior) {
                None if found.is_none() => fitted(
                    &between,
                    &own.iter().zip(&between).map(|(own, x)| own - x).collect::<Vec<f64>>(),
                    0.5 * self.least,
                    self.prior,
                )?,
                fit => fit?,
            };
            let follows = self.follows(&fit, &reference, &off, &edge);
            found = Some((fit, follows));
        }
        found
    }

    /// The two nearest clean lines on a side, on a straight line.
    fn straight(&self, line: usize, up: bool) -> Option<Vec<f64>> {
        let near = self.clean_on(line, up);
        let [a, b] = near.as_slice() else { return None };
        let share = line.abs_diff(*a) as f64 / a.abs_diff(*b) as f64;
        let (one, two) = (self.means.get(*a)?, self.means.get(*b)?);
        Some(one.iter().zip(two).map(|(one, two)| one + (one - two) * share).collect())
    }

    /// Whether no part of a line, at its ends or a sixteenth of it, is nearer to its neighbours than to its gain and offset.
    fn follows(&self, fit: &Fitted, reference: &[f64], off: &[f64], edge: &[bool]) -> bool {
        let part = (off.len() / PARTS).max(1);
        let is_off = |range: std::ops::Range<usize>| {
            let (mut count, mut seen, mut said) = (0.0, 0.0, 0.0);
            for i in range {
                let model = fit.at(reference[i]);
                if !edge[i] && model.is_finite() && off[i].is_finite() {
                    count += 1.0;
                    seen += off[i];
                    said += model;
                }
            }
            let towards = seen * f64::signum(said);
            (said - seen).abs() > APART * self.least * f64::sqrt(count)
                && towards < NEARER * said.abs()
                && towards > -0.5 * said.abs()
        };
        let ends = (1..=part).any(|w| is_off(0..w) || is_off(off.len() - w..off.len()));
        let within = |w: usize| (0..=off.len() - w).any(|first| is_off(first..first + w));
        !(ends || [1, 2, 4].iter().any(|times| part * times <= off.len() && within(part * times)))
    }
}
