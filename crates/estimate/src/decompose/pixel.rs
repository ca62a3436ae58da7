//! All materials of the library for one pixel: the best, what the others are worth beside it, and whether anything is known at all.
//!
//! With Dₘ the least deviance of material m and πₘ its prior, the posterior is πₘ exp(−Dₘ/2)/Σ (profile likelihoods). The candidates are
//! the fewest materials that hold 95 % of it. Materials are looked at in the order of their bounds ([`super::screen`]); those whose
//! bound alone makes them e^([`super::thresholds::CUT`]/2) times less likely than the best do not count, fitted or not, unless the counts alone do not exclude
//! the category of one that its prior makes so unlikely ([`super::possible`]).
//!
//! The residual is Pearson's χ² of the best, with one degree of freedom for each band less the unknowns that no limit holds.

use super::fit::{COMPARED, Fit, fit, scan};
use super::kernel::Sums;
use super::library_error::{Errors, Other, Workplace};
use super::mixed::{self, Mixed, Mixture};
use super::model::Model;
use super::possible::{Members, Possible};
use super::ranked::Ranked;
use super::screen::{MOST_STARTS, Screen, Screened};
use super::setting::MOST_SURROUNDINGS;
use super::step::State;
use super::thresholds::beyond;
pub use super::thresholds::{NO_FIT, NO_MATERIAL};
use hadar::aligned::Aligned;
use hadar::cube::Sample;
use hadar::demand::{Reason, Thing, Work};
use hadar::statistics::chi_square_survival;

/// Deviation of a lighting factor, as a share of its range, beyond which it is not known: half of 1/√12, what a blind guess has.
pub(super) const ANY_LIGHTING: f64 = 0.144_337_567_297_406_43;

/// What is said of a pixel besides its numbers: bits of `flags`.
pub mod flag {
    /// The temperature is at an end of its range.
    pub const TEMPERATURE_AT_LIMIT: u8 = 1;
    /// A lighting factor is at an end of its range.
    pub const LIGHTING_AT_LIMIT: u8 = 2;
    /// What the pixel sends is what its surroundings send: nothing tells its material.
    pub const NO_INFORMATION: u8 = 4;
    /// The lighting could be nearly anything: a factor has half the deviation of a blind guess or more.
    pub const LIGHTING_UNKNOWN: u8 = 8;
    /// No material of the library fits (p below 1e-4), or one that is none of the library, or two in one pixel, are more probable.
    pub const NO_FIT: u8 = 16;
    /// Several materials are left.
    pub const UNDECIDED: u8 = 32;
    /// A count is missing: the pixel was left out.
    pub const SKIPPED: u8 = 64;
    /// The temperature could be anything: the target emits nothing.
    pub const TEMPERATURE_UNKNOWN: u8 = 128;
    /// All of them with their names in results.
    pub const NAMES: [(u8, &str); 8] = [
        (TEMPERATURE_AT_LIMIT, "temperature-at-limit"),
        (LIGHTING_AT_LIMIT, "lighting-at-limit"),
        (NO_INFORMATION, "no-information"),
        (LIGHTING_UNKNOWN, "lighting-unknown"),
        (NO_FIT, "no-fit"),
        (UNDECIDED, "undecided"),
        (SKIPPED, "skipped"),
        (TEMPERATURE_UNKNOWN, "temperature-unknown"),
    ];
}

/// What is found of a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pixel {
    /// The most probable material of the library, [`NO_MATERIAL`] where nothing tells, where it is none of the library or where there are two.
    pub material: u16,
    /// Its temperature, K, of two that of the larger; NaN where the pixel was left out or emits nothing.
    pub temperature_k: f64,
    /// Deviation of the temperature, K, were the material certain and right: where none fits ([`flag::NO_FIT`]) it says nothing.
    pub sigma_k: f64,
    /// Thermal lighting factors of the fit, also where it does not tell them ([`flag::LIGHTING_UNKNOWN`]).
    pub lighting: [f64; MOST_SURROUNDINGS],
    /// Their deviations, beside a limit as far as it lets the truth be off; infinite where nothing tells a factor.
    pub lighting_sigma: [f64; MOST_SURROUNDINGS],
    /// Deviation of the texture Σₖ Vₖ ∫Sₖ dν over the bands that count, photons s⁻¹ m⁻² sr⁻¹.
    pub texture_sigma: f64,
    /// Probability of a larger residual, were the material right, or both where two are likeliest; NaN where there are as many unknowns as bands.
    pub p_value: f64,
    /// Posterior probability of the material.
    pub posterior: f64,
    /// Posterior probability that it is none of the library; 0 where that is not asked.
    pub other: f64,
    /// What it is as two surfaces.
    pub mixed: Mixture,
    /// It and those that come next to it.
    pub ranked: Ranked,
    /// Materials that 95 % of the posterior leave.
    pub candidates: u16,
    /// Bits of [`flag`].
    pub flags: u8,
    /// The categories that it may be of; anything where no categories are given.
    pub possible: Possible,
}

impl Pixel {
    /// A pixel that was left out, of which nothing is known.
    pub(super) const SKIPPED: Self = Self {
        material: NO_MATERIAL,
        temperature_k: f64::NAN,
        sigma_k: f64::NAN,
        lighting: [f64::NAN; MOST_SURROUNDINGS],
        lighting_sigma: [f64::NAN; MOST_SURROUNDINGS],
        texture_sigma: f64::NAN,
        p_value: f64::NAN,
        posterior: 0.0,
        other: f64::NAN,
        mixed: Mixture { probability: f64::NAN, ..Mixture::NOTHING },
        ranked: Ranked::NOTHING,
        candidates: 0,
        flags: flag::SKIPPED,
        possible: Possible::ANYTHING,
    };
}

/// What was done and what was spared.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize)]
#[non_exhaustive]
pub struct Spared {
    /// Pairs of pixel and material that were fitted.
    pub fitted: u64,
    /// Pairs that a bound excluded without a fit.
    pub excluded: u64,
    /// Pairs that share the fit of an equal material, or of the pixel compared with them with the same counts.
    pub equal: u64,
    /// Looks at all bands of a pixel for one material.
    pub looks: u64,
}

impl Spared {
    /// As lines of a ledger.
    #[must_use]
    pub fn work(&self) -> Work {
        let mut work = Work::default();
        work.compute(Thing::MaterialFits, self.fitted);
        work.spare(Thing::MaterialFits, Reason::Bounded, self.excluded);
        work.spare(Thing::MaterialFits, Reason::Shared, self.equal);
        work
    }
}

impl std::ops::Add for Spared {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            fitted: self.fitted + other.fitted,
            excluded: self.excluded + other.excluded,
            equal: self.equal + other.equal,
            looks: self.looks + other.looks,
        }
    }
}

/// What is the same for all pixels.
#[derive(Debug)]
pub(super) struct Task {
    pub(super) model: Model,
    pub(super) screen: Option<Screen>,
    /// The first of each set of equal materials.
    pub(super) kinds: Vec<usize>,
    /// How many materials are equal to it, itself included.
    pub(super) alike: Vec<usize>,
    /// The kind of each material.
    pub(super) kind_of: Vec<usize>,
    /// Texture of a surface that sees one of the surroundings alone, of each; none without surroundings.
    pub(super) textures: Vec<f64>,
    /// −2 ln π of each kind, from the most probable of its materials.
    pub(super) handicap: Vec<f64>,
    /// Errors of the library.
    pub(super) errors: Option<Errors>,
    /// A surface of none of its materials, where that is asked.
    pub(super) other: Option<Other>,
    /// Two surfaces in a pixel, where that is asked.
    pub(super) mixed: Option<Mixed>,
    /// What its materials are parts of, where categories are given.
    pub(super) members: Option<Members>,
    /// Whether bounds exclude materials.
    pub(super) skip: bool,
}

/// Room for one pixel's work.
#[derive(Debug)]
pub(super) struct Room {
    pub(super) sums: Sums,
    pub(super) workplace: Workplace,
    pub(super) mixed: mixed::Workplace,
    pub(super) screened: Option<Screened>,
    pub(super) counts: Aligned,
    pub(super) shifted: Aligned,
    pub(super) mean: Vec<f64>,
    pub(super) bounds: Vec<(f64, usize)>,
    /// Kinds that count of the pixel at hand, the best first.
    pub(super) fits: Vec<(usize, Fit)>,
    /// Shares of the categories in the posterior of the pixel at hand.
    pub(super) shares: Vec<f32>,
}

impl Task {
    /// Of kinds in their order, each with the posterior of one of its materials: those that are equal share it.
    pub(super) fn ranked(&self, order: impl Iterator<Item = (usize, f64)>) -> Ranked {
        let equal = |kind: usize| {
            let all = (self.kinds[kind]..self.kind_of.len()).filter(move |m| self.kind_of[*m] == kind);
            all.take(self.alike[kind])
        };
        Ranked::of(order.flat_map(|(kind, posterior)| equal(kind).map(move |m| (m, posterior))))
    }

    pub(super) fn room(&self) -> Room {
        let width = self.model.width;
        Room {
            sums: Sums::default(),
            workplace: Workplace::default(),
            mixed: mixed::Workplace::default(),
            screened: self.screen.as_ref().map(|screen| screen.room(width)),
            counts: Aligned::zeros(width),
            shifted: Aligned::zeros(width),
            mean: vec![0.0; width],
            bounds: Vec::with_capacity(self.kinds.len()),
            fits: Vec::with_capacity(self.kinds.len()),
            shares: Vec::new(),
        }
    }

    /// Takes the samples of a pixel as counts into `room`.
    pub(super) fn load<S: Sample>(&self, sample: &[S], per_unit: f64, room: &mut Room) {
        for (to, &band) in room.counts.iter_mut().zip(&self.model.used) {
            let value: f64 = sample[band].into();
            *to = per_unit * value;
        }
    }

    /// Decomposes the counts in `room`.
    pub(super) fn pixel(&self, room: &mut Room, spared: &mut Spared) -> Pixel {
        self.pixel_of(None, room, spared)
    }

    /// The same as if `kind` were the material, if the counts leave it; else as the best.
    pub(super) fn pixel_of(&self, kind: Option<usize>, room: &mut Room, spared: &mut Spared) -> Pixel {
        let model = &self.model;
        if !room.counts[..model.used.len()].iter().all(|n| n.is_finite()) {
            return Pixel::SKIPPED;
        }
        for (to, (n, var)) in room.shifted.iter_mut().zip(room.counts.iter().zip(&*model.var_added)) {
            *to = (n + var).max(0.0);
        }
        match &self.errors {
            None => self.fit_all(room, spared),
            Some(errors) => self.fit_with_errors(errors, room, spared),
        }
        let best = room.fits.iter().map(|(_, fit)| fit.deviance).fold(f64::INFINITY, f64::min);
        room.fits.retain(|(kind, fit)| fit.deviance <= best + self.handicap[*kind] + self.beyond(*kind));
        let order = |a: &(usize, Fit), b: &(usize, Fit)| {
            a.1.deviance
                .total_cmp(&b.1.deviance)
                .then(a.1.chi_square.total_cmp(&b.1.chi_square))
                .then(a.0.cmp(&b.0))
        };
        room.fits.sort_by(order);
        let asked = room.fits.iter().find(|(one, _)| Some(*one) == kind);
        let Some(&(kind, fit)) = asked.or(room.fits.first()) else { return Pixel::SKIPPED };
        self.described(kind, fit, room, spared)
    }

    /// Deviance of a kind without the handicap of its prior, beyond the best one with it, from which on it no longer counts.
    pub(super) fn beyond(&self, kind: usize) -> f64 {
        beyond(self.handicap[kind], self.members.as_ref())
    }

    /// The same of every kind: none has less handicap than none.
    pub(super) fn beyond_any(&self) -> f64 {
        beyond(0.0, self.members.as_ref())
    }

    /// Fits what no bound excludes; deviances with the handicap of the prior.
    fn fit_all(&self, room: &mut Room, spared: &mut Spared) {
        hadar::stop::check();
        let Room { sums, screened, counts, shifted, bounds, fits, .. } = room;
        fits.clear();
        bounds.clear();
        let mut best = f64::INFINITY;
        let mut starts = [State::at(self.model.range_k[0]); MOST_STARTS];
        if let (Some(screen), Some(seen)) = (&self.screen, screened.as_mut()) {
            screen.look(counts, shifted, seen);
            bounds.extend((0..self.kinds.len()).map(|kind| (screen.outside(kind, seen), kind)));
            screen.nearest_first(bounds, seen);
            // Without what the prior takes off: farther than need be.
            let mut reach = f64::INFINITY;
            let mut place = 0;
            while let Some(&(_, kind)) = bounds.get(place) {
                place += 1;
                if screen.is_beyond(kind, reach, seen) || screen.is_beyond_within(kind, reach, seen) {
                    spared.excluded += 1;
                    continue;
                }
                let mut count = screen.starts(&self.model, kind, seen, &mut starts);
                if count == 0 {
                    // Too few bands for chords to be near or far.
                    starts[0] = self.scan(kind, shifted, sums, spared);
                    count = 1;
                }
                let found = self.least(kind, &starts[..count], shifted, sums, spared);
                fits.push((kind, found));
                if self.skip && found.deviance < best {
                    reach = screen.reach(found.deviance.max(0.0) + self.beyond_any(), seen);
                }
                best = best.min(found.deviance);
                if place == 1 {
                    // The first fit excludes most; what it leaves goes in order.
                    let all = bounds.len();
                    let mut rest = 1;
                    for at in 1..all {
                        if !screen.is_beyond(bounds[at].1, reach, seen) {
                            bounds.swap(rest, at);
                            rest += 1;
                        }
                    }
                    bounds.truncate(rest);
                    spared.excluded += (all - rest) as u64;
                    bounds[1..].sort_by(|a, b| a.0.total_cmp(&b.0));
                }
            }
        } else {
            for kind in 0..self.kinds.len() {
                let start = self.scan(kind, shifted, sums, spared);
                let found = self.least(kind, &[start], shifted, sums, spared);
                fits.push((kind, found));
            }
        }
        spared.equal += (0..self.kinds.len()).map(|kind| self.alike[kind] as u64 - 1).sum::<u64>();
    }

    /// The best fit of a kind from some starts.
    fn least(
        &self,
        kind: usize,
        starts: &[State],
        shifted: &[f64],
        sums: &mut Sums,
        spared: &mut Spared,
    ) -> Fit {
        spared.fitted += 1;
        let mut best: Option<Fit> = None;
        for start in starts {
            let (model, m) = (&self.model, self.kinds[kind]);
            let (found, looks) = fit(model, m, shifted, *start, COMPARED, sums);
            spared.looks += looks as u64;
            if best.is_none_or(|best| found.deviance < best.deviance) {
                best = Some(found);
            }
        }
        let mut best = best.unwrap_or_else(|| Fit {
            state: State::at(self.model.range_k[0]),
            deviance: f64::INFINITY,
            chi_square: f64::INFINITY,
        });
        best.deviance += self.handicap[kind];
        best
    }

    /// [`scan`] of a kind.
    pub(super) fn scan(&self, kind: usize, shifted: &[f64], at: &mut Sums, spared: &mut Spared) -> State {
        scan(&self.model, self.kinds[kind], shifted, at, &mut spared.looks)
    }

    /// Degrees of freedom that a state leaves to its residual.
    pub(super) fn freedom(&self, state: &State) -> usize {
        let model = &self.model;
        let free = (0..model.vertices).filter(|&j| state.free[j]).count();
        let unknowns = usize::from(!state.held) + free - usize::from(!model.gain).min(free);
        model.used.len().saturating_sub(unknowns)
    }

    /// Probability of a larger residual; NaN where as many unknowns as bands fit everything, which says nothing.
    pub(super) fn p_value(&self, state: &State, chi_square: f64) -> f64 {
        chi_square_survival(chi_square, self.freedom(state) as f64)
    }
}

#[cfg(test)]
mod tests;
