//! The unknowns besides T′ fitted at one T′: weighted least squares in thinned bands.
//!
//! With the target's own weights W = κ/(2√(κS + σ²)) the residual is r = W(S − S′), and S′ is linear in the lighting
//! factors (and, with the gain, in G′ and G′V′). The derivative of ‖r‖² along T′ follows from r alone, by the
//! envelope theorem: −2 G′ r·W e′B′(T′), here without the 2.

use super::table::Emission;
use super::whitened::Whitened;
use crate::aligned::Aligned;
use crate::box_least_squares::BoxLeastSquares;
use crate::few::FewColumns;
use crate::scene::State;
use crate::simd::{Chunk, LANES, added, dispatched, fold, fused, product};
use crate::sum::dot;

/// Cost of a fit, and half its derivative along T′.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fitted {
    pub(super) cost: f64,
    pub(super) slope: f64,
}

/// The unknowns besides T′, fitted by least squares at each T′.
pub(super) struct Fit {
    /// Whitened scattered light of the unknown factors, and whose they are.
    pub(super) free: Vec<Aligned>,
    pub(super) lit: Vec<usize>,
    /// w² and centre of the prior of each, where the gain is known; w = 0 for none.
    pub(super) priors: Vec<[f64; 2]>,
    /// Whitened scattered light of the others.
    pub(super) known: Aligned,
    pub(super) range: [f64; 2],
    /// What the unknown factors may sum to.
    pub(super) sum_limit: f64,
    /// Whether the overall scale is free too.
    pub(super) gain: bool,
}

impl Fit {
    /// At one T′, for any number of unknown factors, and the gain.
    pub(super) fn point(&self, whitened: &Whitened, own: &State, emission: &Emission) -> (State, Fitted) {
        crate::stop::check();
        let [mut base, slope] = whitened.emission(emission);
        add(&mut base, 1.0, &self.known);
        let signal = &whitened.signal;
        let (gain, factors) =
            if self.gain { self.scaled(signal, &base) } else { (own.gain, self.plain(signal, &base, own)) };
        let mut state = State { temperature_k: emission.temperature_k, gain, ..own.clone() };
        let mut residual = signal.to_vec();
        add(&mut residual, -gain, &base);
        for ((&factor, column), &k) in factors.iter().zip(&self.free).zip(&self.lit) {
            add(&mut residual, -gain * factor, column);
            state.lighting[k] = factor;
        }
        let slope = -gain * dot(&residual, &slope);
        let of_priors: f64 = match self.gain {
            true => 0.0,
            false => {
                let off = factors.iter().zip(&self.priors).map(|(v, [square, centre])| (square, v - centre));
                off.map(|(square, off)| square * off * off).sum()
            }
        };
        (state, Fitted { cost: dot(&residual, &residual) + of_priors, slope })
    }

    /// For at most one unknown factor and no gain: what does not hang on T′. `None` if the scene is not of this kind.
    pub(super) fn alone(&self, whitened: &Whitened, own: &State) -> Option<Alone> {
        crate::stop::check();
        if self.gain || self.free.len() > 1 {
            return None;
        }
        let [low, high] = self.range;
        let high = high.min(self.sum_limit).max(low);
        // Zeros up to a whole chunk add nothing to any sum.
        let strength = &whitened.strength;
        let zeros = || Aligned::zeros(strength.len().next_multiple_of(LANES));
        let (mut goal, mut column, mut scaled) = (zeros(), zeros(), zeros());
        add(&mut goal, 1.0, &whitened.signal);
        add(&mut goal, -own.gain, &self.known);
        if let Some(free) = self.free.first() {
            add(&mut column, own.gain, free);
        }
        add(&mut scaled, own.gain, strength);
        let prior = self.priors.first().copied().unwrap_or_default();
        let size = dot(&column, &column) + prior[0];
        let reach = if size > 0.0 { 1.0 / size } else { 0.0 };
        Some(Alone { goal, column, strength: scaled, reach, prior, limits: [low, high] })
    }

    /// Factors within their range and sum, for the scale the target has.
    fn plain(&self, signal: &[f64], base: &[f64], own: &State) -> Vec<f64> {
        let n = self.free.len();
        let [low, high] = self.range;
        let mut goal = signal.to_vec();
        add(&mut goal, -own.gain, base);
        // p = V′ − low, so that p = 0 meets the bounds.
        for column in &self.free {
            add(&mut goal, -own.gain * low, column);
        }
        let columns: Vec<&[f64]> = self.free.iter().map(|column| &**column).collect();
        let limit = (self.sum_limit - low * n as f64).max(0.0);
        let priors: Vec<[f64; 2]> =
            self.priors.iter().map(|[square, centre]| [*square, centre - low]).collect();
        let fitted = least_squares(&columns, &goal, own.gain, &priors, [high - low, limit]);
        fitted.iter().map(|p| p + low).collect()
    }

    /// Scale and factors: with u = sΣ·G − ΣG V ≥ 0 for the unused part of the sum sΣ, G·S′ is a sum with
    /// non-negative coefficients of base/sΣ and base/sΣ + column.
    fn scaled(&self, signal: &[f64], base: &[f64]) -> (f64, Vec<f64>) {
        let limit = if self.free.is_empty() || self.sum_limit <= 0.0 { 1.0 } else { self.sum_limit };
        let share: Vec<f64> = base.iter().map(|b| b / limit).collect();
        let lit: Vec<Vec<f64>> = self
            .free
            .iter()
            .map(|column| share.iter().zip(column).map(|(share, c)| share + c).collect())
            .collect();
        let mut columns = vec![share.as_slice()];
        columns.extend(lit.iter().map(Vec::as_slice));
        let fitted = least_squares(&columns, signal, 1.0, &[], [f64::INFINITY; 2]);
        let gain = fitted.iter().sum::<f64>() / limit;
        if gain <= 0.0 {
            return (1.0, vec![0.0; self.free.len()]);
        }
        let [low, high] = self.range;
        (gain, fitted[1..].iter().map(|p| (p / gain).clamp(low, high)).collect())
    }
}

/// A fit of at most one factor.
pub(super) struct Alone {
    /// What the alternative has to send besides light of known factors, and W(1 − e′)εB of the unknown one.
    goal: Aligned,
    column: Aligned,
    strength: Aligned,
    /// 1/‖column‖², 0 for no column, with the prior's w² in that.
    reach: f64,
    prior: [f64; 2],
    limits: [f64; 2],
}

impl Alone {
    /// The factor and the fit at one T′.
    pub(super) fn at(&self, emission: &Emission) -> (f64, Fitted) {
        let [value, slope] = emission.spectra();
        let spectra = Spectra { goal: &self.goal, strength: &self.strength, value, slope };
        let (factor, cost, slope) = fit_one(spectra, &self.column, self.reach, self.prior, self.limits);
        (factor, Fitted { cost, slope })
    }
}

/// Coefficients p of `columns` times `scale` that fit `goal` and their priors best, 0 ≤ p ≤ `upper`, Σp ≤ `sum_limit`.
fn least_squares(
    columns: &[&[f64]],
    goal: &[f64],
    scale: f64,
    priors: &[[f64; 2]],
    [upper, sum_limit]: [f64; 2],
) -> Vec<f64> {
    let n = columns.len();
    let [square, centre] = [0, 1].map(|part| move |i: usize| priors.get(i).map_or(0.0, |prior| prior[part]));
    let gram = FewColumns::from_fn(n, n, |i, j| {
        scale * scale * dot(columns[i], columns[j]) + if i == j { square(i) } else { 0.0 }
    });
    let size = (0..n).map(|i| gram[(i, i)]).fold(0.0, f64::max);
    if size <= 0.0 {
        // Nothing to fit with: any coefficients will do.
        return vec![0.0; n];
    }
    let pull = columns.iter().enumerate();
    let pull: Vec<f64> =
        pull.map(|(i, column)| -(scale * dot(column, goal) + square(i) * centre(i)) / size).collect();
    if n == 1 {
        return vec![(-pull[0] * size / gram[(0, 0)]).clamp(0.0, upper.min(sum_limit))];
    }
    let hessian = FewColumns::from_fn(n, n, |i, j| gram[(i, j)] / size + if i == j { 1e-13 } else { 0.0 });
    let step = BoxLeastSquares {
        hessian: &hessian,
        gradient: &pull,
        lower: &vec![0.0; n],
        upper: &vec![upper; n],
        summed: &vec![true; n],
        sum_limit,
    };
    step.solve().map_or_else(|| vec![0.0; n], |step| step.to_vec())
}

fn add(to: &mut [f64], factor: f64, column: &[f64]) {
    for (to, column) in to.iter_mut().zip(column) {
        *to += factor * column;
    }
}

/// Whitened spectra of a fit, in whole chunks.
struct Spectra<'a> {
    goal: &'a [f64],
    strength: &'a [f64],
    value: &'a [f64],
    slope: &'a [f64],
}

dispatched! {
    /// The factor of `column` within its limits that leaves least of goal − strength·value, with the cost and
    /// half its derivative along T′; `reach` is 1/‖column‖², 0 for no column, with the prior's w² in that.
    fn fit_one<'a>(
        spectra: Spectra<'a>,
        column: &'a [f64],
        reach: f64,
        prior: [f64; 2],
        limits: [f64; 2],
    ) -> (f64, f64, f64) {
        let Spectra { goal, strength, value, slope } = spectra;
        let ((g, _), (s, _)) = (goal.as_chunks(), strength.as_chunks());
        let ((b, _), (d, _), (c, _)) = (value.as_chunks(), slope.as_chunks(), column.as_chunks());
        let mut pull = [0.0; LANES];
        for (((g, s), b), c) in g.iter().zip(s).zip(b).zip(c) {
            pull = added(left(*g, *s, *b), *c, pull);
        }
        let [square, centre] = prior;
        let factor = (square.mul_add(centre, total(&pull)) * reach).clamp(limits[0], limits[1]);
        let (mut cost, mut along) = ([0.0; LANES], [0.0; LANES]);
        for ((((g, s), b), d), c) in g.iter().zip(s).zip(b).zip(d).zip(c) {
            let r = fused(-factor, *c, left(*g, *s, *b));
            cost = added(r, r, cost);
            along = added(product(r, *s), *d, along);
        }
        let off = factor - centre;
        (factor, total(&cost) + square * off * off, -total(&along))
    }
}

/// g − s b.
#[inline(always)]
fn left(g: Chunk, s: Chunk, b: Chunk) -> Chunk {
    std::array::from_fn(|i| (-s[i]).mul_add(b[i], g[i]))
}

/// Never inlined, for the reason given at [`crate::sum::CompensatedLanes::value`].
#[inline(never)]
fn total(lanes: &Chunk) -> f64 {
    fold(lanes)
}
