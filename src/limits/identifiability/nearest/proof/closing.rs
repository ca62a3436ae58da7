//! The box around a minimum in which nothing is nearer, closed at once.
//!
//! About the minimum (c*, T*) with residual r and p = −r/s the bound of `metric` is, for c_j(A_j(T) − A_j(T*)) =
//! y_j(A_j′ + ½t_jA_j″ + ⅙t_j²A_j‴(ξ)), y_j = c_j t_j and t_j = T_j − T_j*, in the changes δc of the amplitudes and y
//!
//! d² + g·z + ½Σ y_jt_j p·A_j″(ξ) + ‖W(Σ δc_jA_j + Σ y_jA_j′ + ½Σ y_jt_j(A_j″ + ⅓t_jA_j‴(ξ)))‖²,   z = (δc, y).
//!
//! What A_j″ has along the amplitudes' columns, Σ w A, only shifts δc by ½y_jt_jw. With P taking these columns out, and
//! |a + b|² ≥ (1 − η)|a|² − (1/η − 1)|b|², for |t_j| ≤ h_j and c_j ≥ l_j and multipliers λ ≥ 0 of the limits of z, ĝ = g − Σλa,
//!
//! ≥ d² + ĝ·z + (1 − η)‖WZz‖² − Σ K_j y_j² − Σ λ·slack,
//! K_j = (κ_j + |ĝ·w_j|)/(2l_j) + (1/η − 1) n [½h_j(‖PWA_j″‖ + ⅓h_j‖WA_j‴‖)]²,
//!
//! −κ_j the least p·A_j″ in the box, n sources of unknown temperature. If that quadratic is convex, (1 − η)RᵀR − K = FᵀF, it
//! falls below d² by no more than ¼‖F⁻ᵀĝ‖² + Σλ·slack: a lower bound of the whole box, and d² but for what the minimum is off.

use super::amplitudes::{Amplitudes, Pieces, Ray};
use super::groups::whole;
use super::hull::{Hull, Quadratic};
use super::orthogonal::{add, back_substitute, inner, orthonormalise, reduce, reduced};
use super::priors::PriorAt;
use super::sources::{Sources, Spectrum};
use super::vectors::{
    Weights, add_into, add_root_into, add_size_into, add_square_into, largest_quotient, least_above_nothing,
    product_into, sizes_into, square_of_quotient, weights_into,
};
use crate::aligned::Aligned;
use crate::few::{Few, FewColumns};
use crate::sum::dot;

/// η at most.
const SHARE: f64 = 0.6;
/// How often the weights are made better, and each time how often what is within reach is narrowed down.
const WEIGHTS: usize = 2;
const CLOSER: usize = 8;
/// Share of y within which d is too small to matter for the weights.
const SMALL: f64 = 0.01;
/// What must be left of a direction of temperature, as a share, once all amplitudes have been fitted to it.
const LEFT: f64 = 1e-12;
/// What the losses must leave of its square.
const KEPT: f64 = 1e-6;
/// Share of its terms below which a coefficient is nothing but their rounding.
const CANCELLED: f64 = 1e-12;
/// Share of c₀ within which an amplitude is near to a limit.
const NEAR: f64 = 1e-6;

/// A minimum in the bands.
pub(super) struct Minimum {
    /// Amplitude and spectrum of every source.
    pub(super) amplitudes: Vec<f64>,
    pub(super) spectra: Vec<Spectrum>,
    /// −r/s.
    pub(super) pull: Aligned,
    /// y and s of every band; 0 for both where a band is left out.
    pub(super) root: Aligned,
    pub(super) other: Aligned,
    /// √(y/s)/(s + y + reach).
    pub(super) weight: Aligned,
    /// The priors there.
    pub(super) priors: Vec<PriorAt>,
    /// The distance within which everything is.
    pub(super) reach: f64,
    /// d².
    pub(super) cost: f64,
}

impl Minimum {
    /// ½‖W⁻¹p‖, with the residuals of the priors.
    fn shift(&self, weight: &[f64]) -> f64 {
        let of_priors: f64 = self.priors.iter().map(|prior| prior.residual * prior.residual).sum();
        (0.25 * square_of_quotient(&self.pull, weight) + of_priors).sqrt()
    }
}

/// The two ends of a box along one source, also relative to T*, and the least amplitude in it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reach {
    pub(super) faces: [f64; 2],
    pub(super) down_k: f64,
    pub(super) up_k: f64,
    pub(super) least: f64,
}

/// Columns of the quadratic: amplitudes that may change, then sources of unknown temperature.
struct Columns<'m> {
    minimum: &'m Minimum,
    lit: Few<usize>,
    axes: Vec<(usize, Reach)>,
    /// p·column, with ½‖W⁻¹p‖, and R of the weighted columns.
    linear: Few,
    length: f64,
    triangle: FewColumns,
    /// QᵀWA″ with what is left of it, and ‖WA‴‖, of every source of unknown temperature.
    bent: FewColumns,
    third: Few,
}

/// What a box around a minimum has come to.
pub(super) struct Closed {
    /// No d² in it is below.
    pub(super) lower: f64,
    /// Amplitudes and temperatures at which the quadratic is least.
    pub(super) amplitudes: Vec<f64>,
    pub(super) temperature_k: Vec<f64>,
}

/// Closes a box; `None` if the quadratic is not convex in it.
pub(super) fn close(
    sources: &Sources<'_>,
    minimum: &Minimum,
    reach: &[Option<Reach>],
    allowed: &Amplitudes,
    enough: f64,
) -> Option<Closed> {
    let count = minimum.spectra.len();
    // Light of a known factor changes with the gain alone: it is part of the first column.
    let varies = |s: usize| s.checked_sub(1).map_or(allowed.gain_free, |k| allowed.tied(k).is_none());
    let lit: Few<usize> = (0..count).filter(|&s| varies(s)).collect();
    let axes: Vec<(usize, Reach)> = (0..count).filter_map(|s| Some((s, reach[s]?))).collect();
    let mut first = None;
    for (k, spectrum) in minimum.spectra[1..].iter().enumerate() {
        if let (true, Some(factor)) = (allowed.gain_free, allowed.tied(k)) {
            let first = first.get_or_insert_with(|| minimum.spectra[0].counts.clone());
            add_into(factor, &spectrum.counts, first);
        }
    }
    let first = first.as_ref().unwrap_or(&minimum.spectra[0].counts);
    let raw: Vec<&[f64]> =
        (lit.iter().map(|&s| if s == 0 { &first[..] } else { &minimum.spectra[s].counts }))
            .chain(axes.iter().map(|&(s, _)| &minimum.spectra[s].slope[..]))
            .collect();
    let mut pull_sizes = Aligned::unset(minimum.pull.len());
    sizes_into(&minimum.pull, &mut pull_sizes);
    let priors = minimum.priors.iter().map(|prior| prior.entries(&lit, axes.iter().map(|(s, _)| *s)));
    let priors: Vec<Vec<f64>> = priors.collect();
    let along_priors = |i: usize| {
        let rows = minimum.priors.iter().zip(&priors);
        rows.map(|(prior, entries)| prior.residual * entries[i]).sum::<f64>()
    };
    let linear = raw.iter().enumerate();
    let linear: Few = linear.map(|(i, column)| dot(&minimum.pull, column) + 2.0 * along_priors(i)).collect();
    let bends: Vec<[Aligned; 2]> = axes
        .iter()
        .map(|&(s, Reach { faces, .. })| sources.bend(s, minimum.spectra[s].temperature_k, faces))
        .collect();
    let pulled: Vec<[f64; 2]> =
        bends.iter().map(|[bend, third]| [dot(&minimum.pull, bend), dot(&pull_sizes, third)]).collect();
    let is_far = minimum.reach > SMALL * least_above_nothing(&minimum.root);
    let rounds = if is_far && !axes.is_empty() { WEIGHTS } else { 0 };
    let length = minimum.shift(&minimum.weight);
    let (triangle, bent, third) = Default::default();
    let mut columns = Columns { minimum, lit, axes, linear, length, triangle, bent, third };
    let bands = minimum.weight.len();
    let size = whole(bands + priors.len());
    let mut basis: Vec<Aligned> = raw.iter().map(|_| Aligned::unset(size)).collect();
    let mut turns: Vec<[Aligned; 2]> = bends.iter().map(|_| [(); 2].map(|()| Aligned::unset(size))).collect();
    turns.iter_mut().flatten().for_each(|turn| turn[bands..].fill(0.0));
    let (mut closed, mut better) = (None, None);
    for round in 0..=rounds {
        let weight = better.as_ref().unwrap_or(&minimum.weight);
        for (i, (column, out)) in raw.iter().zip(&mut basis).enumerate() {
            product_into(column, weight, out);
            out[bands..].fill(0.0);
            out[bands..].iter_mut().zip(&priors).for_each(|(out, entries)| *out = entries[i]);
        }
        let pairs = bends.iter().flatten().zip(turns.iter_mut().flatten());
        pairs.for_each(|(spectrum, out)| product_into(spectrum, weight, out));
        let bent: Vec<&[f64]> = turns.iter().map(|[bend, _]| &bend[..]).collect();
        let by_products = reduced(&basis, &bent);
        let is_orthonormal = by_products.is_none();
        (columns.triangle, columns.bent) = by_products.unwrap_or_else(|| reduce(&mut basis, &bent));
        columns.third = turns.iter().map(|[_, third]| dot(third, third).sqrt()).collect();
        closed = columns.closed(&pulled, allowed, enough).or(closed);
        if round == rounds || closed.as_ref().is_some_and(|closed| closed.lower >= enough) {
            break;
        }
        if !is_orthonormal {
            orthonormalise(&mut basis, &columns.triangle);
        }
        let Some(now) = columns.weighed(weight, &basis, &turns) else { break };
        better = Some(now);
    }
    closed
}

impl Columns<'_> {
    /// The bound by these columns; `None` if the quadratic is not convex in the box.
    fn closed(&self, pulled: &[[f64; 2]], allowed: &Amplitudes, enough: f64) -> Option<Closed> {
        // |ĝ·w| is known only with the multipliers, which hang on K: what comes out must be within what was put in.
        let mut shifted = Few::zeros(self.axes.len());
        for _ in 0..3 {
            let factor = self.factor(&self.loss(pulled, &shifted)?)?;
            let (fall, rest) = self.fall(&factor, &self.limits(allowed));
            let now: Few = self.bent.iter().map(|bent| self.along_amplitudes(bent, &rest).abs()).collect();
            if now.iter().zip(&*shifted).all(|(now, assumed)| now <= assumed) || self.axes.is_empty() {
                let lower = self.minimum.cost - fall;
                if lower >= enough || !self.axes.is_empty() {
                    return Some(self.moved(lower, &factor, &rest));
                }
                break;
            }
            shifted = now.iter().map(|now| 2.0 * now).collect();
        }
        self.axes.is_empty().then(|| self.searched(allowed, enough))
    }

    /// ½h(‖PWA″‖ + ⅓h‖WA‴‖): how far the slope of a source turns in the box.
    fn turned(&self, j: usize) -> f64 {
        let (amplitudes, reach) = (self.lit.len(), self.axes[j].1);
        let half = reach.down_k.max(reach.up_k);
        let left = inner(&self.bent[j][amplitudes..], &self.bent[j][amplitudes..]).sqrt();
        0.5 * half * (left + half * self.third[j] / 3.0)
    }

    /// What is left of a slope once all amplitudes are fitted.
    fn own(&self, j: usize) -> f64 {
        let place = self.lit.len() + j;
        self.triangle[place][place]
    }

    /// η, and K_j of every source of unknown temperature.
    fn loss(&self, pulled: &[[f64; 2]], shifted: &[f64]) -> Option<(f64, Few)> {
        crate::stop::check();
        let n = self.axes.len() as f64;
        let turn = (0..self.axes.len()).map(|j| self.turned(j) / self.own(j)).fold(0.0, f64::max);
        let share = (n.sqrt() * turn).clamp(1e-12, SHARE);
        let loss = self.axes.iter().enumerate().map(|(j, (_, reach))| {
            let half = reach.down_k.max(reach.up_k);
            let sinking = (half * pulled[j][1] - pulled[j][0]).max(0.0) + shifted[j];
            if sinking > 0.0 && reach.least <= 0.0 {
                return None;
            }
            let sinking = if sinking > 0.0 { 0.5 * sinking / reach.least } else { 0.0 };
            Some(sinking + (1.0 / share - 1.0) * n * self.turned(j).powi(2))
        });
        Some((if self.axes.is_empty() { 0.0 } else { share }, loss.collect::<Option<_>>()?))
    }

    /// Better weights: a state nearer than the reach has ‖WΔN‖ ≤ D = (d + reach)·max√(y/s), and by the quadratic
    /// ‖QᵀWΔN + Qᵀh‖² ≤ reach² − d² + ‖Qᵀh‖² + 2τ‖h‖, τ what of WΔN is not along the columns; as these are few, no single band can
    /// have more of that than its share in them.
    fn weighed(&self, weight: &Aligned, basis: &[Aligned], turns: &[[Aligned; 2]]) -> Option<Aligned> {
        crate::stop::check();
        let Minimum { root, other, reach, cost, .. } = self.minimum;
        let (reach, cost) = (*reach, *cost);
        let of_priors = if self.minimum.priors.is_empty() { 0.0 } else { 1.0 };
        let largest = largest_quotient(root, other, of_priors).sqrt();
        let (n, amplitudes) = (self.axes.len(), self.lit.len());
        // Lengths of the rows of R⁻¹ of the slopes: |y_j| is no more than that times what is along all slopes.
        let mut rows = Few::zeros(n);
        for k in 0..n {
            let mut x = Few::zeros(n);
            for i in (0..=k).rev() {
                let later: f64 =
                    (i + 1..=k).map(|j| self.triangle[amplitudes + j][amplitudes + i] * x[j]).sum();
                x[i] = (f64::from(u8::from(i == k)) - later) / self.own(i);
                rows[i] += x[i] * x[i];
            }
        }
        let turned: f64 = rows.iter().enumerate().map(|(j, row)| row.sqrt() * self.turned(j)).sum();
        if turned.is_nan() || turned >= 0.5 {
            return None;
        }
        let shift = self.minimum.shift(weight);
        let shift_along = self.pulled_along();
        let mut all = largest * (cost.sqrt() + reach);
        for _ in 0..CLOSER {
            let across = 2.0 * turned * all / (1.0 - turned) * shift;
            let square = (reach * reach - cost).max(0.0) + shift_along * shift_along + across;
            all = all.min(square.sqrt() + shift_along + turned * all / (1.0 - turned));
        }
        let along = all / (1.0 - turned);
        let changes: Few = rows.iter().map(|row| row.sqrt() * along).collect();
        let mut steady = all + turned * along;
        let [mut shares, mut most] = [(); 2].map(|()| Aligned::zeros(weight.len()));
        basis.iter().for_each(|column| add_square_into(column, &mut shares));
        for (j, (_, Reach { down_k, up_k, .. })) in self.axes.iter().enumerate() {
            let half = down_k.max(*up_k);
            let factor = changes[j] * 0.5 * half;
            steady += factor * inner(&self.bent[j], &self.bent[j]).sqrt();
            add_size_into(factor, &turns[j][0], &mut most);
            add_size_into(factor * half / 3.0, &turns[j][1], &mut most);
        }
        add_root_into(steady, &shares, &mut most);
        let mut better = weight.clone();
        weights_into(Weights { root, other, reach, most: Some(&most), weight: &mut better });
        Some(better)
    }

    /// ‖Qᵀh‖, Rᵀ Qᵀh = ½ p·columns.
    fn pulled_along(&self) -> f64 {
        let mut along = Few::default();
        for (linear, above) in self.linear.iter().zip(self.triangle.iter()) {
            let k = along.len();
            along.push((0.5 * linear - inner(&above[..k], &along)) / above[k]);
        }
        inner(&along, &along).sqrt()
    }

    /// F of (1 − η)RᵀR − K, column by column, if that is positive semidefinite: K stands at the slopes alone, so that of R only
    /// the triangle that is left of them once all amplitudes are fitted changes.
    fn factor(&self, (share, loss): &(f64, Few)) -> Option<FewColumns> {
        crate::stop::check();
        let amplitudes = self.lit.len();
        let root = (1.0 - share).sqrt();
        let mut factor = self.triangle.clone();
        factor.values_mut().iter_mut().for_each(|x| *x *= root);
        let n = loss.len();
        let entry = |i: usize, j: usize| {
            let [a, b] = [i, j].map(|i| &factor[amplitudes + i][amplitudes..]);
            inner(a, b) - if i == j { loss[i] } else { 0.0 }
        };
        let mut rest: Few = (0..n * n).map(|place| entry(place / n, place % n)).collect();
        for k in 0..n {
            let pivot = rest[k * n + k];
            let own = factor[amplitudes + k][amplitudes + k];
            let all = &self.triangle[amplitudes + k];
            if !(pivot > KEPT * own * own && own > LEFT * inner(all, all).sqrt()) {
                return None;
            }
            let diagonal = pivot.sqrt();
            for j in k..n {
                factor[amplitudes + j][amplitudes + k] = rest[k * n + j] / diagonal;
            }
            for i in k + 1..n {
                for j in k + 1..n {
                    rest[i * n + j] -= rest[k * n + i] * rest[k * n + j] / pivot;
                }
            }
        }
        Some(factor)
    }

    /// The limits of amplitudes and temperatures that the minimum is near to.
    fn limits(&self, allowed: &Amplitudes) -> Vec<Limit> {
        let size = self.lit.len() + self.axes.len();
        let amplitudes = &self.minimum.amplitudes;
        let place = |s: usize| self.lit.iter().position(|&lit| lit == s);
        let mut limits = Vec::new();
        // Σ value·c ≥ 0 over sources, with changes of those that may change.
        let mut put = |terms: &[(usize, f64)], both: bool| {
            let slack = terms.iter().map(|&(s, value)| value * amplitudes[s]).sum::<f64>();
            let slack = if both { slack.abs() } else { slack.max(0.0) };
            let (mut along, mut terms_of) = (Few::zeros(size), Few::zeros(size));
            for &(s, value) in terms {
                let tied = s.checked_sub(1).and_then(|k| allowed.tied(k));
                let (s, value) = tied.map_or((s, value), |factor| (0, factor * value));
                if let Some(place) = place(s) {
                    along[place] += value;
                    terms_of[place] += value.abs();
                }
            }
            // What cancels but for rounding is no limit.
            along.iter_mut().zip(&*terms_of).for_each(|(along, of)| {
                if along.abs() <= CANCELLED * of {
                    *along = 0.0;
                }
            });
            if slack <= NEAR * amplitudes[0] && along.iter().any(|x| *x != 0.0) {
                limits.push(Limit { along, slack, both });
            }
        };
        for (k, [low, high]) in allowed.ranges.iter().enumerate().filter(|(_, [low, high])| low < high) {
            put(&[(k + 1, 1.0), (0, -low)], false);
            put(&[(k + 1, -1.0), (0, *high)], false);
        }
        if allowed.sum.is_finite() {
            let objects = (1..amplitudes.len()).map(|s| (s, -1.0));
            let terms: Vec<(usize, f64)> = objects.chain([(0, allowed.sum)]).collect();
            put(&terms, allowed.sum_known);
        }
        if let Some(place) = place(0).filter(|_| amplitudes[0] >= allowed.gain_cap * (1.0 - NEAR)) {
            let mut along = Few::zeros(size);
            along[place] = -1.0;
            limits.push(Limit { along, slack: (allowed.gain_cap - amplitudes[0]).max(0.0), both: false });
        }
        for (j, (_, Reach { down_k, up_k, .. })) in self.axes.iter().enumerate() {
            for (value, _) in [(1.0, down_k), (-1.0, up_k)].into_iter().filter(|(_, room)| **room == 0.0) {
                let mut along = Few::zeros(size);
                along[self.lit.len() + j] = value;
                limits.push(Limit { along, slack: 0.0, both: false });
            }
        }
        limits
    }

    /// What the quadratic falls below d² by at most, and F⁻ᵀĝ.
    fn fall(&self, factor: &FewColumns, limits: &[Limit]) -> (f64, Few) {
        let solve = |right: &[f64]| -> Few {
            let mut out = Few::zeros(right.len());
            for k in 0..right.len() {
                out[k] = (right[k] - inner(&factor[k][..k], &out[..k])) / factor[k][k];
            }
            out
        };
        let mut rest = solve(&self.linear);
        let columns: Vec<Few> = limits.iter().map(|limit| solve(&limit.along)).collect();
        let mut used: Vec<usize> = (0..limits.len()).collect();
        loop {
            let (triangle, along) =
                reduce(&mut used.iter().map(|&i| columns[i].clone()).collect::<Vec<_>>(), &[&rest]);
            let n = used.len();
            let mut multipliers = Few::from(&along[0][..n]);
            back_substitute(|row, column| triangle[column][row], &mut multipliers);
            let negative = (0..n).filter(|&k| !limits[used[k]].both && multipliers[k] < 0.0);
            if let Some(worst) = negative.min_by(|&a, &b| multipliers[a].total_cmp(&multipliers[b])) {
                used.remove(worst);
                continue;
            }
            let mut slack = 0.0;
            for (multiplier, &i) in multipliers.iter().zip(&used) {
                add(&mut rest, -multiplier, &columns[i]);
                slack += multiplier.abs() * limits[i].slack;
            }
            let fall = 0.25 * inner(&rest, &rest) + slack;
            return (if fall.is_nan() { f64::INFINITY } else { fall }, rest);
        }
    }

    /// ĝ·w: ĝ = Fᵀ`rest`, and R w = `bent` in the columns of the amplitudes.
    fn along_amplitudes(&self, bent: &[f64], rest: &[f64]) -> f64 {
        let n = self.lit.len();
        let mut w = Few::from(&bent[..n]);
        back_substitute(|row, column| self.triangle[column][row], &mut w);
        // The amplitudes' columns of F are those of R but for √(1 − η) ≤ 1.
        let gradient = (0..n).map(|k| inner(&self.triangle[k][..=k], &rest[..=k]));
        gradient.zip(&*w).map(|(g, w)| g * w).sum()
    }

    /// Where the quadratic is least: Fz = −½F⁻ᵀĝ.
    fn moved(&self, lower: f64, factor: &FewColumns, rest: &[f64]) -> Closed {
        let mut z: Few = rest.iter().map(|x| -0.5 * x).collect();
        for k in (0..z.len()).rev() {
            let later: f64 = (k + 1..z.len()).map(|j| factor[j][k] * z[j]).sum();
            z[k] = (z[k] - later) / factor[k][k];
        }
        let mut amplitudes = self.minimum.amplitudes.clone();
        for (&s, change) in self.lit.iter().zip(&*z) {
            amplitudes[s] += if change.is_finite() { *change } else { 0.0 };
        }
        for k in 1..amplitudes.len() {
            if !self.lit.contains(&k) {
                amplitudes[k] *= amplitudes[0] / self.minimum.amplitudes[0];
            }
        }
        let mut temperature_k: Vec<f64> = self.minimum.spectra.iter().map(|own| own.temperature_k).collect();
        for ((s, reach), y) in self.axes.iter().zip(&z[self.lit.len()..]) {
            let t = y / self.minimum.amplitudes[*s];
            temperature_k[*s] += if t.is_finite() { t.max(-reach.down_k).min(reach.up_k) } else { 0.0 };
        }
        Closed { lower, amplitudes, temperature_k }
    }

    /// The least over all amplitudes, by search: where no temperature is unknown and columns may depend on each other.
    fn searched(&self, allowed: &Amplitudes, enough: f64) -> Closed {
        crate::stop::check();
        let Minimum { amplitudes, spectra, cost, .. } = self.minimum;
        let mut pieces = Pieces::default();
        let (n, lit) = (spectra.len(), self.lit.len());
        let mut linear = vec![0.0; n];
        let mut factor = vec![0.0; n * n];
        for (s, spectrum) in spectra.iter().enumerate() {
            pieces.put_known(s, spectrum);
        }
        for (i, &s) in self.lit.iter().enumerate() {
            linear[s] = self.linear[i];
            factor[s * n..s * n + lit].copy_from_slice(&self.triangle[i][..lit]);
        }
        let quadratic = Quadratic {
            linear,
            factor,
            excess: vec![0.0; n],
            origin: amplitudes.clone(),
            most: (0..n).map(|i| allowed.most(&pieces, i)).collect(),
            length: self.length,
        };
        let mut hull = Hull::default();
        let mut ray = Ray::default();
        let cheapest = |costs: &[f64], vertex: &mut [f64]| {
            allowed.least(&pieces, costs, vertex, &mut ray);
            allowed.rounding(&pieces, costs, vertex, &ray)
        };
        let lower = cost + hull.least(&quadratic, cheapest, enough - cost);
        let temperature_k = spectra.iter().map(|own| own.temperature_k).collect();
        Closed { lower, amplitudes: hull.point, temperature_k }
    }
}

/// A limit a·z ≥ −slack that the minimum is near to, or with `both` a·z = 0.
struct Limit {
    along: Few,
    slack: f64,
    both: bool,
}
