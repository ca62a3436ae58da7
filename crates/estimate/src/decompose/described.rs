//! What is said of a pixel: its hypotheses weighed against each other, and the state of the likeliest one.
//!
//! Beside the materials of the library, each worth its least deviance, there may be a surface of none of them ([`super::library_error`]) and two
//! surfaces in one pixel ([`super::mixed`]), both on the scale of these deviances. What is not asked for has no weight. A doubt that is stated only
//! takes back: it makes no material the only candidate that is not without it, and excludes no category.

use super::fit::{Fit, TOLD, fit};
use super::kernel::{Asked, contrast};
use super::library_error::Other;
use super::mixed::Mixture;
use super::model::Model;
use super::pixel::{ANY_LIGHTING, NO_FIT, NO_MATERIAL, Pixel, Room, Spared, Task, flag};
use super::possible::{self, CANDIDATE_SHARE, Possible, TIE};
use super::ranked::Ranked;
use super::setting::MOST_SURROUNDINGS;
use super::step::Deviations;
use hadar::statistics::chi_square_survival;

/// Squared deviations by which what a pixel sends must differ from what its surroundings send.
const CONTRAST: f64 = 16.0;

/// The hypotheses beside the materials.
const OTHER: usize = 0;
const TWO: usize = 1;

/// What the hypotheses of a pixel are worth.
#[derive(Debug)]
struct Weighed {
    /// Deviance of weight 1.
    least: f64,
    /// Weight of all materials, and of everything.
    known: f64,
    total: f64,
    /// Posterior of none of the materials, and of two surfaces.
    besides: [f64; 2],
    /// Whether these are candidates.
    are_left: [bool; 2],
    /// Which of them is likelier than the material that is told, if one is.
    likeliest: Option<usize>,
    candidates: usize,
}

impl Weighed {
    fn weight(&self, fit: &Fit) -> f64 {
        libm::exp(-0.5 * (fit.deviance - self.least))
    }

    fn posterior(&self, fit: &Fit) -> f64 {
        self.weight(fit) / self.total
    }

    fn is_likeliest(&self, hypothesis: usize) -> bool {
        self.likeliest == Some(hypothesis)
    }
}

/// Whether what has this share of the posterior is among what 99 % leave, by the rules of [`possible`].
fn is_not_excluded(share: f64, odds_against: f64) -> bool {
    let odds = share / (1.0 - share).max(f64::MIN_POSITIVE);
    share > possible::MISSED || odds * odds_against > possible::MISSED / (1.0 - possible::MISSED)
}

impl Task {
    /// What is said of a pixel whose fits are in `room`, the best first, as `kind` with its `fit`.
    pub(super) fn described(&self, kind: usize, fit: Fit, room: &mut Room, spared: &mut Spared) -> Pixel {
        let other = self.other(room, spared);
        let costs = [other.map(|(_, other)| other.deviance), self.mixed(room, spared)];
        let weighed = self.weighed(&room.fits, fit.deviance, costs);
        let possible = self.possible(&weighed, room);
        let others = room.fits.iter().filter(|(other, _)| *other != kind);
        let others = others.map(|(other, one)| (*other, weighed.posterior(one)));
        let ranked = self.ranked(std::iter::once((kind, weighed.posterior(&fit))).chain(others));
        let posterior = match weighed.likeliest {
            Some(hypothesis) => weighed.besides[hypothesis],
            None => weighed.posterior(&fit),
        };
        let m = self.kinds[kind];
        let fit = self.told(m, fit, room, spared);
        let p_value = self.p_value(&fit.state, room.sums.chi_square);
        let mixture = &fit.state.mixture[..self.model.vertices];
        let asked = Asked { m, shifted: &room.shifted, temperature_k: fit.state.temperature_k, mixture };
        let no_information = contrast(&self.model, asked, &mut room.mean) < CONTRAST;
        // Where no single material fits anything may be there, whatever two would.
        let fits = p_value.is_nan() || p_value >= NO_FIT;
        let is_told = fits && !no_information && !weighed.are_left[OTHER] && !weighed.is_likeliest(OTHER);
        let pixel = Pixel {
            material: if no_information || weighed.likeliest.is_some() { NO_MATERIAL } else { m as u16 },
            p_value,
            posterior,
            other: weighed.besides[OTHER],
            ranked: if no_information { Ranked::NOTHING } else { ranked },
            candidates: weighed.candidates as u16,
            flags: [
                (no_information, flag::NO_INFORMATION),
                (!fits || weighed.likeliest.is_some(), flag::NO_FIT),
                (weighed.candidates > 1, flag::UNDECIDED),
            ]
            .into_iter()
            .fold(0, |flags, (condition, flag)| if condition { flags | flag } else { flags }),
            possible: possible.filter(|_| is_told).unwrap_or(Possible::ANYTHING),
            mixed: Mixture::NOTHING,
            ..Pixel::SKIPPED
        };
        if let (Some(hypothesis), Some(other)) = (&self.other, other.filter(|_| weighed.is_likeliest(OTHER)))
        {
            let room_of_fit = (&*room.shifted, &mut room.workplace, &mut room.sums);
            let (model, fit) = hypothesis.told(other, room_of_fit);
            return self.two(self.one(model, &fit, room, pixel), &weighed, room);
        }
        self.two(self.one(&self.model, &fit, room, pixel), &weighed, room)
    }

    /// The fit of a material to its end; the sums are those of the last look.
    fn told(&self, m: usize, from: Fit, room: &mut Room, spared: &mut Spared) -> Fit {
        let Room { workplace, shifted, sums, .. } = room;
        let (fit, looks) = match &self.errors {
            None => fit(&self.model, m, shifted, from.state, TOLD, sums),
            Some(errors) => workplace.fit(&self.model, errors, m, shifted, from.state, sums),
        };
        spared.looks += looks as u64;
        fit
    }

    /// A pixel with temperature and lighting of one surface.
    fn one(&self, model: &Model, fit: &Fit, room: &Room, pixel: Pixel) -> Pixel {
        let state = &fit.state;
        let mixture = &state.mixture[..model.vertices];
        let deviations: Deviations = state.deviations(&room.sums, &model.limits());
        let free = (0..model.vertices).filter(|&j| state.free[j]).count();
        // One vertex alone is no choice; a mixture that lacks one is at a limit.
        let lit_at_limit = model.vertices > usize::from(!model.gain) && free < model.vertices;
        let sigma_k = deviations.temperature_k();
        let sigma_of = |a: &[f64]| deviations.of_mixture(&model.slopes_of_lighting(a, mixture));
        let mut lighting_sigma = [f64::NAN; MOST_SURROUNDINGS];
        for (k, sigma) in lighting_sigma[..model.surroundings].iter_mut().enumerate() {
            let mut one = [0.0; MOST_SURROUNDINGS];
            one[k] = 1.0;
            *sigma = sigma_of(&one);
        }
        let any_lighting = ANY_LIGHTING * model.lighting_total.unwrap_or(1.0);
        let mut flags = pixel.flags;
        let mut raise = |condition: bool, flag: u8| flags |= if condition { flag } else { 0 };
        raise(state.held, flag::TEMPERATURE_AT_LIMIT);
        raise(lit_at_limit && !lighting_sigma.contains(&f64::INFINITY), flag::LIGHTING_AT_LIMIT);
        raise(lighting_sigma.iter().any(|sigma| *sigma > any_lighting), flag::LIGHTING_UNKNOWN);
        raise(!sigma_k.is_finite(), flag::TEMPERATURE_UNKNOWN);
        Pixel {
            temperature_k: if sigma_k.is_finite() { state.temperature_k } else { f64::NAN },
            sigma_k,
            lighting: model.lighting(mixture),
            lighting_sigma,
            texture_sigma: if self.textures.is_empty() { f64::NAN } else { sigma_of(&self.textures) },
            flags,
            ..pixel
        }
    }

    /// The same with what it is as two surfaces, whose state is told where they are likeliest.
    fn two(&self, pixel: Pixel, weighed: &Weighed, room: &Room) -> Pixel {
        let Some(hypothesis) = &self.mixed else { return pixel };
        let (mixed, fit) = hypothesis.told(&self.model, &room.mixed, weighed.besides[TWO]);
        let Some((chi_square, unknowns)) = fit.filter(|_| weighed.is_likeliest(TWO)) else {
            return Pixel { mixed, ..pixel };
        };
        let of_single = flag::TEMPERATURE_AT_LIMIT | flag::LIGHTING_AT_LIMIT | flag::TEMPERATURE_UNKNOWN;
        let (mut lighting, mut lighting_sigma) = (pixel.lighting, pixel.lighting_sigma);
        // Each surface has a lighting of its own.
        lighting[..self.model.surroundings].fill(f64::NAN);
        lighting_sigma[..self.model.surroundings].fill(f64::INFINITY);
        let has_lighting = if self.model.surroundings > 0 { flag::LIGHTING_UNKNOWN } else { 0 };
        let freedom = self.model.used.len().saturating_sub(unknowns);
        Pixel {
            mixed,
            temperature_k: mixed.temperature_k[0],
            sigma_k: mixed.sigma_k[0],
            lighting,
            lighting_sigma,
            texture_sigma: f64::NAN,
            p_value: chi_square_survival(chi_square, freedom as f64),
            flags: pixel.flags & !of_single | has_lighting,
            ..pixel
        }
    }

    /// The best fit of none of the library's materials, beside the best of the library; nothing where that is not asked.
    fn other(&self, room: &mut Room, spared: &mut Spared) -> Option<(usize, Fit)> {
        let (other, &(kind, fit)) = (self.other.as_ref()?, room.fits.first()?);
        let best = Fit { deviance: fit.deviance - self.handicap[kind], ..fit };
        let at = (&self.model, self.kinds[kind], &best);
        let room = (&*room.shifted, &mut room.workplace, &mut room.sums);
        other.fit(at, self.errors.as_ref(), room, &mut spared.looks)
    }

    /// −2 ln of what two surfaces are worth, beside the best of the library; nothing where that is not asked.
    fn mixed(&self, room: &mut Room, spared: &mut Spared) -> Option<f64> {
        let (mixed, &(kind, fit)) = (self.mixed.as_ref()?, room.fits.first()?);
        let best = Fit { deviance: fit.deviance - self.handicap[kind], ..fit };
        let single = (self.kinds[kind], &best, fit.deviance);
        let screened = self.screen.as_ref().filter(|_| self.skip).zip(room.screened.as_ref());
        let known = (&self.model, &*self.kinds);
        let cost = mixed.fit(known, single, screened, &room.shifted, &mut room.mixed);
        spared.looks += room.mixed.looks();
        Some(cost)
    }

    /// Weighs the fits, the best first, against hypotheses that cost so much; `told` is the deviance of the one that is told.
    fn weighed(&self, fits: &[(usize, Fit)], told: f64, costs: [Option<f64>; 2]) -> Weighed {
        let own = costs.map(|cost| cost.unwrap_or(f64::INFINITY));
        let least = own.into_iter().fold(told, f64::min);
        let weight = |deviance: f64| libm::exp(-0.5 * (deviance - least));
        let known: f64 = fits.iter().map(|(kind, one)| self.alike[*kind] as f64 * weight(one.deviance)).sum();
        let total = known + own.into_iter().map(weight).sum::<f64>();
        let besides = own.map(|cost| weight(cost) / total);
        let order = if besides[OTHER] >= besides[TWO] { [OTHER, TWO] } else { [TWO, OTHER] };
        // The fewest that hold the share, and all materials that are as probable as the last of them.
        let (mut held, mut candidates, mut last, mut are_left) = (0.0, 0, 0.0, [false; 2]);
        let mut take = |held: &mut f64, last: &mut f64, least: f64| {
            for i in order.into_iter().filter(|i| costs[*i].is_some()) {
                if !are_left[i] && besides[i] >= least && *held < CANDIDATE_SHARE {
                    are_left[i] = true;
                    (*held, *last) = (*held + besides[i], besides[i]);
                }
            }
        };
        for (kind, one) in fits {
            let each = weight(one.deviance) / total;
            take(&mut held, &mut last, each);
            if held >= CANDIDATE_SHARE && each < last * (1.0 - TIE) {
                break;
            }
            held += each * self.alike[*kind] as f64;
            candidates += self.alike[*kind];
            last = each;
        }
        take(&mut held, &mut last, 0.0);
        candidates += are_left.into_iter().filter(|left| *left).count();
        let likeliest = Some(order[0]).filter(|i| own[*i] < told);
        Weighed { least, known, total, besides, are_left, likeliest, candidates }
    }

    /// The categories that a pixel may be of, with their shares in `room`: what materials leave were there nothing else, and what else is left.
    fn possible(&self, weighed: &Weighed, room: &mut Room) -> Option<Possible> {
        let members = self.members.as_ref()?;
        let of_known = |one: &Fit| weighed.weight(one) / weighed.known;
        let leading = self.leading(&room.fits, of_known);
        let mut possible = members.possible(&room.fits, of_known, leading, &mut room.shares);
        let share_of_known = weighed.known / weighed.total;
        room.shares.iter_mut().for_each(|share| *share = (f64::from(*share) * share_of_known) as f32);
        let is_left = |hypothesis: usize, odds: f64| is_not_excluded(weighed.besides[hypothesis], odds);
        if self.other.as_ref().map(Other::odds_against).is_some_and(|odds| is_left(OTHER, odds)) {
            possible.at_99 = possible::ANYTHING;
        }
        if let Some(mixed) = &self.mixed {
            let left = [weighed.are_left[TWO], is_left(TWO, mixed.odds_against)];
            mixed.kinds_left(&room.mixed).for_each(|kinds| members.add_pair(&mut possible, kinds, left));
        }
        Some(possible)
    }

    /// How many of the fits, in their order, hold the share of the candidates, and all that are as probable as the last of them.
    fn leading(&self, fits: &[(usize, Fit)], weight: impl Fn(&Fit) -> f64) -> usize {
        let (mut held, mut last) = (0.0, 0.0);
        let is_left = |(kind, one): &&(usize, Fit)| {
            let each = weight(one);
            let is_left = held < CANDIDATE_SHARE || each >= last * (1.0 - TIE);
            (held, last) = (held + each * self.alike[*kind] as f64, each);
            is_left
        };
        fits.iter().take_while(is_left).count()
    }
}
