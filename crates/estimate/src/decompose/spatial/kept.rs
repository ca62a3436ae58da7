//! What is kept of each pixel for its neighbours: the materials that its counts leave, with what they are worth and their temperature.
//!
//! Of the materials within e¹² of the best the [`MOST_KEPT`] most likely are kept one by one, the others as one that no neighbour
//! supports. 16 bytes for each of them: one for most pixels where photons abound.

use super::super::kernel::{Asked, sums};
use super::super::pixel::{NO_MATERIAL, Pixel, Room, Task};

/// Materials of a pixel that are kept one by one.
const MOST_KEPT: usize = 8;

/// A material that the counts of a pixel leave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in super::super) struct Candidate {
    /// Place among the kinds of the task; `None` for all that are not kept one by one.
    pub(in super::super) kind: Option<u16>,
    /// Natural logarithm of its likelihood over that of the best, with its prior and how many materials are equal to it.
    pub(super) log_odds: f32,
    /// Temperature of the fit, K.
    pub(super) temperature_k: f32,
    /// Its deviation, K; infinite where nothing is emitted.
    pub(super) sigma_k: f32,
}

/// The candidates of the pixels of a row.
#[derive(Debug, Default)]
pub(in super::super) struct KeptRow {
    candidates: Vec<Candidate>,
    ends: Vec<usize>,
    deviances: Vec<f32>,
    others: Vec<u16>,
    /// Shares of the categories in the posterior, category after category of a pixel.
    pub(in super::super) shares: Vec<f32>,
}

/// The candidates of all pixels, the most likely first.
#[derive(Debug, Default)]
pub(in super::super) struct Kept {
    candidates: Vec<Candidate>,
    ends: Vec<usize>,
    deviances: Vec<f32>,
    others: Vec<u16>,
}

impl Task {
    /// Keeps what was found of the pixel that `room` has fitted; nothing of one that was left out or of which nothing is told.
    pub(in super::super) fn keep(&self, pixel: &Pixel, room: &mut Room, row: &mut KeptRow) {
        let is_fitted = room.fits.first().is_some_and(|(_, fit)| fit.deviance.is_finite());
        if pixel.material != NO_MATERIAL && is_fitted {
            self.keep_fits(room, row);
        } else {
            row.deviances.push(0.0);
            row.others.push(0);
        }
        row.ends.push(row.candidates.len());
    }

    fn keep_fits(&self, room: &mut Room, row: &mut KeptRow) {
        let model = &self.model;
        let best = room.fits.first().map_or(0.0, |(_, fit)| fit.deviance);
        row.deviances.push(best as f32);
        let log_odds =
            |kind: usize, deviance: f64| libm::log(self.alike[kind] as f64) - 0.5 * (deviance - best);
        let (one_by_one, others) = room.fits.split_at(room.fits.len().min(MOST_KEPT));
        for (kind, fit) in one_by_one {
            let (m, mut state) = (self.kinds[*kind], fit.state);
            match &self.errors {
                None => {
                    let mixture = &state.mixture[..model.vertices];
                    let asked =
                        Asked { m, shifted: &room.shifted, temperature_k: state.temperature_k, mixture };
                    sums(model, asked, &mut room.sums);
                }
                Some(errors) => {
                    let (fit, _) = room.workplace.fit(model, errors, m, &room.shifted, state, &mut room.sums);
                    state = fit.state;
                }
            }
            row.candidates.push(Candidate {
                kind: Some(*kind as u16),
                log_odds: log_odds(*kind, fit.deviance) as f32,
                temperature_k: state.temperature_k as f32,
                sigma_k: state.deviations(&room.sums, &model.limits()).temperature_k() as f32,
            });
        }
        let weight: f64 = others.iter().map(|(kind, fit)| libm::exp(log_odds(*kind, fit.deviance))).sum();
        let count: usize = others.iter().map(|(kind, _)| self.alike[*kind]).sum();
        row.others.push(count.min(usize::from(u16::MAX)) as u16);
        if count > 0 {
            row.candidates.push(Candidate {
                kind: None,
                log_odds: libm::log(weight) as f32,
                temperature_k: f32::NAN,
                sigma_k: f32::INFINITY,
            });
        }
    }
}

impl Kept {
    /// Of rows one after the other.
    pub(in super::super) fn of_rows(rows: Vec<KeptRow>) -> Self {
        let mut kept = Self::default();
        for mut row in rows {
            let before = kept.candidates.len();
            kept.candidates.append(&mut row.candidates);
            kept.ends.extend(row.ends.iter().map(|end| before + end));
            kept.deviances.append(&mut row.deviances);
            kept.others.append(&mut row.others);
        }
        kept
    }

    /// Of pixels whose best material has this deviance.
    #[cfg(test)]
    pub(super) fn of_pixels(pixels: &[Vec<Candidate>], deviance: f32) -> Self {
        let row = KeptRow {
            candidates: pixels.concat(),
            ends: pixels
                .iter()
                .scan(0, |end, own| {
                    Some({
                        *end += own.len();
                        *end
                    })
                })
                .collect(),
            deviances: vec![deviance; pixels.len()],
            others: vec![0; pixels.len()],
            shares: Vec::new(),
        };
        Self::of_rows(vec![row])
    }

    pub(super) fn pixels(&self) -> usize {
        self.ends.len()
    }

    /// Places of the candidates of pixel `i` among all.
    pub(super) fn places(&self, i: usize) -> std::ops::Range<usize> {
        let before = i.checked_sub(1).and_then(|before| self.ends.get(before)).copied().unwrap_or(0);
        before..self.ends.get(i).copied().unwrap_or(before)
    }

    /// The candidates of pixel `i`; none where nothing is told of it.
    pub(in super::super) fn of(&self, i: usize) -> &[Candidate] {
        self.candidates.get(self.places(i)).unwrap_or_default()
    }

    /// Candidates of all pixels.
    pub(super) fn len(&self) -> usize {
        self.candidates.len()
    }

    /// Deviance of the best material of pixel `i`.
    pub(super) fn deviance(&self, i: usize) -> f64 {
        self.deviances.get(i).copied().unwrap_or(0.0).into()
    }

    /// How many materials of pixel `i` are not kept one by one.
    pub(super) fn others(&self, i: usize) -> usize {
        self.others.get(i).copied().unwrap_or(0).into()
    }
}

/// The pixels beside pixel `i` at these distances (rows, columns) in an image of so many columns.
pub(super) fn beside<'a>(
    i: usize,
    columns: usize,
    pixels: usize,
    at: &'a [(isize, isize)],
) -> impl Iterator<Item = (usize, usize)> + 'a {
    let (row, column) = (i / columns.max(1), i % columns.max(1));
    at.iter().enumerate().filter_map(move |(place, (down, right))| {
        let row = row.checked_add_signed(*down)?;
        let column = column.checked_add_signed(*right).filter(|column| *column < columns)?;
        let j = row * columns + column;
        (j < pixels).then_some((place, j))
    })
}

/// A pixel's neighbours: above, below, at the left, at the right. Each is the opposite of the one it shares a pair of places with.
pub(super) const FOUR: [(isize, isize); 4] = [(-1, 0), (1, 0), (0, -1), (0, 1)];
/// The window of 3 × 3 around a pixel but for itself.
pub(super) const EIGHT: [(isize, isize); 8] =
    [(-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1)];
