//! The residual r = √(N + σ²) − √(N′ + σ²) of a candidate state, its gradient and second derivatives.
//!
//! With ρ = √(κS′ + σ²) and s = ∂r/∂S′ = −κ/(2ρ), half the cost has the second derivatives
//! Σ s²(1 + r/ρ) S′ᵢS′ⱼ + Σ r s S′ᵢⱼ. The first sum without r/ρ is the Gauss–Newton matrix; where temperature and
//! lighting of the alternative are nearly degenerate it alone converges slowly, so the rest is added:
//! S′_TT = G e′ B″ (`curvature`), and S′_gj = S′ⱼ for the logarithm g of the gain.
//! (Second derivatives along environment temperatures are left out.)

mod rounding;
mod sums;

use self::sums::{Lines, Sums};
use super::blackbodies::Blackbodies;
use crate::aligned::Aligned;
use crate::error::{Error, Result};
use crate::fisher::{Counting, Unknowns};
use crate::identifiability::curvature::{Curvature, curvature_into};
use crate::identifiability::space::{Quadratic, StateRange, StateSpace, value};
use crate::scene::{Jacobian, Parameter, State, Surroundings, check_emissivity};
use crate::simd::dispatched;
use crate::spectrum::Bands;
use std::sync::Arc;

/// What a step may promise, as a share of the cost, for the search to end before it.
pub(super) const NO_GAIN: f64 = 2e-15;

/// Share of the target's N + σ² below which a band is as good as dark.
const DARK: f64 = 1e-6;

/// What the counts are compared in.
#[derive(Debug, Clone, Copy)]
pub(super) enum Metric<'a> {
    /// Shot noise per √photon, the photons being those of the target; priors as among `photons`.
    PerPhoton { photons: f64 },
    /// Counts with the camera's noise.
    Counting(&'a Counting),
}

/// The target as every candidate state is compared with it.
pub(super) struct Target<'t> {
    pub(super) emissivity: &'t [f64],
    pub(super) alternative: &'t [f64],
    pub(super) state: &'t State,
    /// Counts per unit of band signal.
    pub(super) counts: f64,
    pub(super) metric: Metric<'t>,
}

/// Cost ‖r‖², and half of it to second order, at a candidate state.
pub(super) struct Linearised {
    pub(super) cost: f64,
    pub(super) quadratic: Quadratic,
}

/// Spectra kept between calls so that none allocates.
#[derive(Debug, Clone)]
struct Workspace {
    /// σ²_w of each band, and √(N + σ²) of the target.
    noise: Aligned,
    root: Aligned,
    /// S − S′ and G e′B″ in the bands.
    separation: Aligned,
    curvature: Aligned,
    /// B(T) − B(T′) and X − X′ at the nodes.
    difference: Aligned,
    lighting: Aligned,
    /// Spectra at the nodes on their way to the bands.
    node: Aligned,
}

impl Workspace {
    fn new(bands: usize, nodes: usize) -> Self {
        let (band, node) = (|| Aligned::zeros(bands), || Aligned::zeros(nodes));
        Self {
            noise: band(),
            root: band(),
            separation: band(),
            curvature: band(),
            difference: node(),
            lighting: node(),
            node: node(),
        }
    }

    /// Noise and √(N + σ²) of the target, once per search.
    fn weigh_target(&mut self, target: &Target<'_>, signal: &[f64]) {
        match target.metric {
            Metric::PerPhoton { .. } => self.noise.fill(0.0),
            Metric::Counting(counting) => {
                for (band, noise) in self.noise.iter_mut().enumerate() {
                    *noise = counting.var_added(band);
                }
            }
        }
        roots_into(target.counts, signal, &self.noise, &mut self.root);
    }
}

/// The target and a candidate state of the alternative, band by band.
#[derive(Debug, Clone)]
pub(super) struct Comparison<'a> {
    pub(super) space: StateSpace,
    surface: Jacobian<'a>,
    pub(super) target: Jacobian<'a>,
    work: Workspace,
    /// Lowest and highest wavenumber.
    pub(super) range_cm1: (f64, f64),
    pub(super) blackbodies: Arc<Blackbodies>,
    /// The state that was compared last, and whether with columns.
    compared: Option<(State, bool)>,
    /// The state whose terms were measured last, and their size.
    measured: Option<(State, f64)>,
}

impl<'a> Comparison<'a> {
    pub(super) fn new(
        bands: &'a Bands,
        surroundings: &'a Surroundings,
        unknowns: Unknowns,
        range: StateRange,
    ) -> Self {
        Self {
            space: StateSpace::new(unknowns, range, surroundings.objects().len()),
            surface: Jacobian::new(bands, surroundings),
            target: Jacobian::new(bands, surroundings),
            work: Workspace::new(bands.len(), surroundings.nodes_cm1().len()),
            range_cm1: bands.range_cm1(),
            blackbodies: Arc::default(),
            compared: None,
            measured: None,
        }
    }

    /// Evaluates the target, with which every candidate is compared.
    pub(super) fn aim<'t>(
        &mut self,
        emissivity: &'t [f64],
        alternative: &'t [f64],
        state: &'t State,
        metric: Metric<'t>,
    ) -> Result<Target<'t>> {
        self.space.range.check()?;
        let nodes = self.target.surroundings().nodes_cm1().len();
        check_emissivity(emissivity, nodes)?;
        check_emissivity(alternative, nodes)?;
        if let Metric::Counting(counting) = metric {
            counting.check(self.target.bands().len())?;
        }
        (self.compared, self.measured) = (None, None);
        self.target.evaluate(emissivity, alternative, state, &[], false);
        let total = crate::sum::sum(self.target.signal());
        // Per photon there must be some; counts may be none.
        let least = if matches!(metric, Metric::Counting(_)) { 0.0 } else { f64::MIN_POSITIVE };
        if !(least..f64::INFINITY).contains(&total) {
            return Err(Error::out_of_range(
                "photon radiance of the target",
                total,
                "photons s^-1 m^-2 sr^-1",
                "above 0: a warmer scene, or bands at lower wavenumbers",
            ));
        }
        let counts = match metric {
            Metric::PerPhoton { .. } => 1.0 / total,
            Metric::Counting(counting) => counting.counts_per_radiance,
        };
        let target = Target { emissivity, alternative, state, counts, metric };
        self.work.weigh_target(&target, self.target.signal());
        Ok(target)
    }

    /// Cost, gradient and second derivatives at a state of the alternative.
    pub(super) fn linearise(&mut self, target: &Target<'_>, state: &State) -> Linearised {
        crate::stop::check();
        self.separate(target, state, true);
        let along = self.space.parameters.iter().position(|parameter| *parameter == Parameter::Temperature);
        let (surface, work) = (&self.surface, &mut self.work);
        if along.is_some() {
            surface.sampling().sample(surface.bands(), &mut work.node, &mut work.curvature, |out| {
                curvature_into(Curvature {
                    nu: surface.surroundings().nodes_cm1(),
                    temperature_k: state.temperature_k,
                    gain: state.gain,
                    emissivity: target.alternative,
                    value: surface.radiance(),
                    slope: surface.radiance_slope(),
                    out,
                });
            });
        }
        let Sums { mut cost, curvature, mut quadratic } = sums::sums(self.lines(target), &self.surface);
        let Quadratic { gradient, gauss_newton, hessian } = &mut quadratic;
        if let Some(i) = along {
            hessian[(i, i)] += curvature;
        }
        if let Some(i) = self.space.parameters.iter().position(|parameter| *parameter == Parameter::Gain) {
            // ∂²S′/∂g∂θⱼ = ∂S′/∂θⱼ.
            for j in 0..gradient.len() {
                hessian[(i, j)] += gradient[j];
                if i != j {
                    hessian[(j, i)] += gradient[j];
                }
            }
        }
        for (i, weight, row) in self.prior_rows(target, state) {
            cost += row * row;
            gradient[i] += weight * row;
            gauss_newton[(i, i)] += weight * weight;
            hessian[(i, i)] += weight * weight;
        }
        Linearised { cost, quadratic }
    }

    /// The cost alone.
    pub(super) fn cost(&mut self, target: &Target<'_>, state: &State) -> f64 {
        crate::stop::check();
        self.separate(target, state, false);
        let bands = sums::cost(self.lines(target));
        bands + self.prior_rows(target, state).map(|(_, _, row)| row * row).sum::<f64>()
    }

    /// r and √(N′ + σ²) of every band at a state.
    pub(super) fn residual(&mut self, target: &Target<'_>, state: &State) -> (Aligned, Aligned) {
        crate::stop::check();
        self.separate(target, state, false);
        let mut other = Aligned::unset(self.work.root.len());
        roots_into(target.counts, self.surface.signal(), &self.work.noise, &mut other);
        let mut residual = Aligned::unset(other.len());
        quotients_into(target.counts, &self.work.separation, [&self.work.root, &other], &mut residual);
        (residual, other)
    }

    /// B(T′) and ∂B/∂T′ at the nodes, of the state that was compared last.
    pub(super) fn radiances(&self) -> [&[f64]; 2] {
        [self.surface.radiance(), self.surface.radiance_slope()]
    }

    /// Bands of the target in which a state counts as good as nothing.
    pub(super) fn dark(&mut self, target: &Target<'_>, state: &State) -> Vec<usize> {
        crate::stop::check();
        self.separate(target, state, false);
        let lines = self.lines(target);
        let Lines { counts, signal, noise, root, .. } = lines;
        if !any_dark(counts, signal, noise, root) {
            return Vec::new();
        }
        (0..root.len()).filter(|&w| is_dark(counts * signal[w] + noise[w], root[w])).collect()
    }

    /// How much more of a parameter makes these bands, taken together, as bright as the target; `None` where it makes them no brighter.
    pub(super) fn lighting_of(
        &mut self,
        target: &Target<'_>,
        state: &State,
        place: usize,
        dark: &[usize],
    ) -> Option<f64> {
        crate::stop::check();
        self.separate(target, state, true);
        let (column, own) = (self.surface.column(place), self.target.signal());
        let sum = |spectrum: &[f64]| dark.iter().map(|&w| spectrum[w]).sum::<f64>();
        let (more, all) = (sum(column), sum(own));
        (more > 0.0 && all > 0.0).then(|| all / more).filter(|step| step.is_finite())
    }

    /// √(N + σ²) of the target.
    pub(super) fn root(&self) -> &[f64] {
        &self.work.root
    }

    /// σ²_w of each band.
    pub(super) fn noise(&self) -> &[f64] {
        &self.work.noise
    }

    fn lines(&self, target: &Target<'_>) -> Lines<'_> {
        Lines {
            counts: target.counts,
            root: &self.work.root,
            noise: &self.work.noise,
            separation: &self.work.separation,
            curvature: &self.work.curvature,
            signal: self.surface.signal(),
        }
    }

    /// Index and weight 1/(2σ_p) of every parameter with a prior.
    pub(super) fn priors(&self, target: &Target<'_>) -> impl Iterator<Item = (usize, f64)> {
        self.space.parameters.iter().enumerate().filter_map(move |(i, &parameter)| {
            let sigma = self.space.unknowns.sigma_prior(parameter)?;
            let weight = match target.metric {
                Metric::PerPhoton { photons } => 0.5 / (sigma * photons.sqrt()),
                Metric::Counting(_) => 0.5 / sigma,
            };
            Some((i, weight))
        })
    }

    /// The same with the row (θ′ − θ)/(2σ_p) of a state.
    fn prior_rows(&self, target: &Target<'_>, state: &State) -> impl Iterator<Item = (usize, f64, f64)> {
        self.priors(target).map(move |(i, weight)| {
            let parameter = self.space.parameters[i];
            (i, weight, weight * (value(state, parameter) - value(target.state, parameter)))
        })
    }

    /// Evaluates the alternative, with its columns or without, and the band integrals of S − S′ from differences that
    /// lose no digits; nothing is done where they stand there from the last comparison.
    fn separate(&mut self, target: &Target<'_>, state: &State, columns: bool) {
        let last = self.compared.take();
        if last.as_ref().is_some_and(|(last, had)| last == state && (*had || !columns)) {
            self.compared = last;
            return;
        }
        self.separate_anew(target, state, columns);
        let compared = last.map(|(mut last, _)| {
            last.clone_from(state);
            last
        });
        self.compared = Some((compared.unwrap_or_else(|| state.clone()), columns));
    }

    fn separate_anew(&mut self, target: &Target<'_>, state: &State, columns: bool) {
        let (own, work) = (target.state, &mut self.work);
        let total_known = self.space.unknowns.known_lighting_total().is_some();
        let parameters = if columns { &self.space.parameters[..] } else { &[] };
        let (alternative, difference) = (target.alternative, &mut work.difference);
        self.surface.evaluate_beside(&self.target, alternative, state, parameters, total_known, difference);
        if is_other_scale(own.gain, state.gain) {
            let signals = self.target.signal().iter().zip(self.surface.signal());
            work.separation.iter_mut().zip(signals).for_each(|(out, (own, other))| *out = own - other);
            return;
        }
        self.target.lighting_difference_into(own, &self.surface, state, &mut work.lighting);
        self.target.sampling().sample(self.target.bands(), &mut work.node, &mut work.separation, |out| {
            separation_into(Separation {
                gain: own.gain,
                emissivity: target.emissivity,
                alternative,
                contrast: self.target.contrast(),
                difference: &work.difference,
                lighting: &work.lighting,
                out,
            });
        });
        let gain = state.gain - own.gain;
        if gain != 0.0 {
            for (separation, other) in work.separation.iter_mut().zip(self.surface.signal()) {
                // S = G s and S′ = G′ s′: S − S′ = G(s − s′) − (G′ − G)s′.
                *separation -= gain * other / state.gain;
            }
        }
    }
}

/// Whether the gains differ so much that signals are best subtracted as they are: what nearly cancels then is not that of one
/// gain, which may be any number of times as bright.
fn is_other_scale(own: f64, other: f64) -> bool {
    !(0.5..=2.0).contains(&(other / own))
}

dispatched! {
    /// √(κS + σ²) of each band.
    fn roots_into<'a>(counts: f64, signal: &'a [f64], noise: &'a [f64], out: &'a mut [f64]) {
        for ((root, signal), noise) in out.iter_mut().zip(signal).zip(noise) {
            *root = (counts * signal + noise).sqrt();
        }
    }
}

/// Whether a band is as good as dark, by its N′ + σ² and the target's root.
#[inline(always)]
fn is_dark(other: f64, root: f64) -> bool {
    other < DARK * root * root
}

dispatched! {
    /// Whether any band is.
    fn any_dark<'a>(counts: f64, signal: &'a [f64], noise: &'a [f64], root: &'a [f64]) -> bool {
        let mut any = false;
        for ((signal, noise), root) in signal.iter().zip(noise).zip(root) {
            any |= is_dark(counts * signal + noise, *root);
        }
        any
    }
}

dispatched! {
    /// κ(S − S′) over the sum of both roots, 0 where that is.
    fn quotients_into<'a>(counts: f64, separation: &'a [f64], roots: [&'a [f64]; 2], out: &'a mut [f64]) {
        let [own, other] = roots;
        for ((out, separation), (own, other)) in out.iter_mut().zip(separation).zip(own.iter().zip(other)) {
            let sum = own + other;
            *out = if sum > 0.0 { counts * separation / sum } else { 0.0 };
        }
    }
}

struct Separation<'a> {
    gain: f64,
    emissivity: &'a [f64],
    alternative: &'a [f64],
    contrast: &'a [f64],
    difference: &'a [f64],
    lighting: &'a [f64],
    out: &'a mut [f64],
}

dispatched! {
    /// (e − e′)C + e′[B(T) − B(T′)] + (1 − e′)(X − X′), times the target's gain.
    fn separation_into<'a>(spectra: Separation<'a>) {
        let Separation { gain, emissivity, alternative, contrast, difference, lighting, out } = spectra;
        let own = emissivity.iter().zip(alternative);
        let terms = contrast.iter().zip(difference).zip(lighting);
        for ((out, (e, other)), ((contrast, difference), lighting)) in out.iter_mut().zip(own).zip(terms) {
            let mixed = (e - other).mul_add(*contrast, other * difference);
            *out = gain * (1.0 - other).mul_add(*lighting, mixed);
        }
    }
}
