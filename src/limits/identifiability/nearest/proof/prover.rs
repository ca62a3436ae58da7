//! A pair as a proof sees it: in bands counted together and in all, with the ends of intervals that both know.

use super::amplitudes::Amplitudes;
use super::bound::{Bounder, Mixture};
use super::groups::{neighbours_summed, whole};
use super::priors::Priors;
use super::sources::Sources;
use super::vectors::scale;
use super::view::View;
use crate::aligned::Aligned;
use crate::fisher::Nuisance;
use crate::identifiability::nearest::residual::{Comparison, Target};
use crate::identifiability::space::LARGEST_LN_GAIN;
use crate::scene::{Parameter, State};

/// Share of what is enough that bands counted together must bound for all to be looked at in a wide box, and from how many
/// times as warm at its hot end on it is wide.
const HOPE: f64 = 0.7;
const WIDE: f64 = 1.05;

/// What is found of a box.
#[derive(Debug, Clone, Copy)]
pub(super) struct Looked {
    /// No d² in it is below.
    pub(super) lower: f64,
    /// The axis along which it is best halved.
    pub(super) axis: usize,
    /// Whether all bands were looked at.
    pub(super) in_all: bool,
}

/// What is to be shown.
#[derive(Debug, Clone, Copy)]
pub(super) struct Goal {
    /// A state of less d² than this ends the proof.
    pub(super) limit: f64,
    /// The bound of d² that is enough.
    pub(super) enough: f64,
    /// By what share rounding may have lifted the distance at the best state, and the bound of the box closed about it.
    pub(super) rounding: f64,
    /// Boxes looked at most.
    pub(super) boxes: u64,
}

/// Memory that one proof leaves to the next, of bands counted together and of all.
#[derive(Debug, Clone, Default)]
pub(in super::super) struct Memory {
    merged: Bounder,
    all: Bounder,
}

/// What a proof works with.
pub(super) struct Prover<'a, 'm> {
    /// How many neighbouring bands count as one for a first look, if any, and the pair in these once it was looked at.
    pub(super) merging: Option<usize>,
    pub(super) merged: Option<View<'a>>,
    few: &'m mut Bounder,
    pub(super) all: View<'a>,
    pub(super) bounder: &'m mut Bounder,
    /// Ends of intervals, by axis.
    pub(super) temperature_k: Vec<Vec<f64>>,
}

impl<'a, 'm> Prover<'a, 'm> {
    pub(super) fn new(
        comparison: &Comparison<'a>,
        merging: Option<usize>,
        memory: &'m mut Memory,
        target: &Target<'_>,
        reach: f64,
    ) -> Self {
        let space = &comparison.space;
        let reach = reach * (1.0 + 1e-9);
        let mut priors = Priors::new(comparison, target, reach);
        let sources =
            Sources::new(comparison, target, |parameter, range| priors.within_reach(parameter, range));
        let signal = comparison.target.signal();
        let [root, mut counts, noise] = [comparison.root(), signal, comparison.noise()]
            .map(|bands| Aligned::padded(whole(bands.len()), bands));
        scale(&mut counts, target.counts);
        let bands = [root, counts, noise];
        let unknown_lighting = space.unknowns.contains(Nuisance::Lighting);
        let known_total = space.unknowns.known_lighting_total();
        let lit = target.state.lighting.iter().enumerate();
        let mut ranges: Vec<[f64; 2]> = lit
            .map(|(k, &v)| if unknown_lighting { space.bounds(Parameter::Lighting(k)) } else { [v, v] })
            .collect();
        let mut sum = if unknown_lighting { space.lighting_sum() } else { f64::INFINITY };
        let sum_known = unknown_lighting && known_total.is_some();
        if unknown_lighting && ranges.iter().map(|range| range[0]).sum::<f64>() > sum {
            // By rounding.
            ranges.iter_mut().for_each(|range| range[0] = 0.0);
        }
        if sum_known {
            // The last factor is what the others leave, whatever its range.
            if let Some(last) = ranges.last_mut() {
                *last = [0.0, sum];
            }
        }
        // By the rounding of the user's own numbers.
        sum *= 1.0 + 1e-15;
        for (k, range) in ranges.iter_mut().enumerate() {
            *range = priors.within_reach(Parameter::Lighting(k), *range);
        }
        let gain_free = space.unknowns.contains(Nuisance::Gain);
        let gain_cap = LARGEST_LN_GAIN.exp() * (1.0 + 1e-12);
        let allowed = Amplitudes { gain_free, ranges, sum, sum_known, total: 0.0, gain_cap };
        priors.put_rows(&allowed);
        let all = View::new(sources, allowed, priors, bands, reach);
        let temperature_k = all.axes.iter().map(|_| Vec::new()).collect();
        let Memory { merged: few, all: bounder } = memory;
        Self { merging, merged: None, few, all, bounder, temperature_k }
    }

    /// The state of a mixture, if its cost is below the limit.
    pub(super) fn nearer(
        &self,
        comparison: &mut Comparison<'_>,
        target: &Target<'_>,
        limit: f64,
        mixture: &Mixture,
    ) -> Option<State> {
        let (state, cost) = self.candidate(comparison, target, mixture);
        (cost < limit * (1.0 - 1e-12)).then_some(state)
    }

    /// The state of a mixture, and its cost.
    pub(super) fn candidate(
        &self,
        comparison: &mut Comparison<'_>,
        target: &Target<'_>,
        mixture: &Mixture,
    ) -> (State, f64) {
        crate::stop::check();
        let mut state = target.state.clone();
        let space = &comparison.space;
        let surface = mixture.amplitudes[0];
        for parameter in &space.parameters {
            match *parameter {
                Parameter::Temperature => state.temperature_k = mixture.temperature_k[0],
                Parameter::Lighting(k) => {
                    state.lighting[k] = if surface > 0.0 { mixture.amplitudes[k + 1] / surface } else { 0.0 };
                }
                Parameter::Gain => state.gain = surface.max(f64::MIN_POSITIVE),
                Parameter::EnvironmentTemperature(k) => state.environment_k[k] = mixture.temperature_k[k + 1],
                Parameter::Material => {}
            }
        }
        let state = space.within_range(&state);
        let cost = comparison.cost(target, &state);
        (state, cost)
    }

    /// The place of an end of an interval.
    pub(super) fn end(&mut self, axis: usize, temperature_k: f64) -> usize {
        let known = self.temperature_k[axis].iter().position(|t| *t == temperature_k);
        known.unwrap_or_else(|| {
            self.temperature_k[axis].push(temperature_k);
            self.temperature_k[axis].len() - 1
        })
    }

    /// What is found of a box: bands are looked at together first.
    pub(super) fn bound(
        &mut self,
        ends: &[[usize; 2]],
        narrower: Option<&Amplitudes>,
        enough: f64,
    ) -> Looked {
        crate::stop::check();
        let known = &self.temperature_k;
        let know = |view: &mut View<'_>| {
            for (axis, ends) in ends.iter().enumerate() {
                ends.iter().for_each(|&end| view.know(axis, end, known[axis][end]));
            }
        };
        let mut least = 0.0;
        if let Some(merged) = merged_into(&mut self.merged, &self.all, self.merging) {
            know(merged);
            let found = self.few.bound(merged, ends, narrower, enough, None);
            // Where they are far from it all bands would hardly do either.
            let wide = || ends.iter().zip(known).any(|([a, b], known)| known[*b] > WIDE * known[*a]);
            let hopeless = found.lower < if found.coarse { enough } else { HOPE * enough };
            if found.lower >= enough || (hopeless && (found.coarse || wide())) {
                return Looked { lower: found.lower, axis: found.axis, in_all: false };
            }
            least = found.lower;
        }
        know(&mut self.all);
        let start = self.merged.as_ref().map(|_| self.few.point());
        let found = self.bounder.bound(&mut self.all, ends, narrower, enough, start);
        Looked { lower: found.lower.max(least), axis: found.axis, in_all: true }
    }

    /// A lower bound of d² in an interval of the one unknown temperature, that of source `s`, in all bands: the first quadratic is about
    /// these amplitudes, with so much of the source's at the hot end.
    pub(super) fn bound_from(
        &mut self,
        ends: &[[usize; 2]],
        s: usize,
        share: f64,
        amplitudes: &[f64],
        enough: f64,
    ) -> f64 {
        crate::stop::check();
        let known = &self.temperature_k;
        ends[0].iter().for_each(|&end| self.all.know(0, end, known[0][end]));
        let unit = self.all.unit(0, ends[0], share);
        let mut start = Vec::with_capacity(amplitudes.len() + 1);
        for (source, amplitude) in amplitudes.iter().enumerate() {
            if source == s {
                start.extend([amplitude * unit, share * amplitude * unit]);
            } else {
                start.push(*amplitude);
            }
        }
        self.bounder.bound(&mut self.all, ends, None, enough, Some(&start)).lower
    }

    /// The range of an unknown temperature, cut off where a known amplitude is too bright in some band.
    pub(super) fn range(&mut self, axis: usize, warm: &State) -> [f64; 2] {
        crate::stop::check();
        let s = self.all.axes[axis];
        let [low, high] = self.all.sources.list[s].temperature_k;
        let low = low.max(self.all.coldest_k(axis)).min(high);
        let Some(amplitude) = self.all.held(s) else { return [low, high] };
        let mut t = 1.2 * temperature_of(warm, s).max(low);
        while t < high {
            let end = self.end(axis, t);
            // What is too bright in bands counted together is so in all of them.
            let too_bright = match merged_into(&mut self.merged, &self.all, self.merging) {
                Some(merged) => merged.too_bright(axis, end, t, amplitude),
                None => self.all.too_bright(axis, end, t, amplitude),
            };
            if too_bright {
                return [low, t];
            }
            t *= 1.3;
        }
        [low, high]
    }
}

/// The pair with so many neighbouring bands counted as one, where any are.
pub(super) fn merged_into<'v, 'a>(
    merged: &'v mut Option<View<'a>>,
    all: &View<'a>,
    merging: Option<usize>,
) -> Option<&'v mut View<'a>> {
    let count = merging?;
    Some(merged.get_or_insert_with(|| {
        let bands = all.sources.bands.len();
        let [counts, noise] = [&all.counts, &all.noise].map(|x| neighbours_summed(&x[..bands], count));
        let root = counts.iter().zip(noise.iter()).map(|(n, v)| (n + v).sqrt());
        let root = Aligned::filled(counts.len(), root);
        let (sources, allowed, priors) = (all.sources.merged(count), all.allowed.clone(), all.priors.clone());
        let mut view = View::new(sources, allowed, priors, [root, counts, noise], all.reach);
        view.shaped.clone_from(&all.shaped);
        view
    }))
}

pub(super) fn temperature_of(state: &State, s: usize) -> f64 {
    s.checked_sub(1).map_or(state.temperature_k, |k| state.environment_k[k])
}
