//! Local distances along a row of a map: many lighting factors V at one temperature T.
//!
//! Along a row the signal and the material's column are linear in V, the span of the nuisance columns stays the same.
//! With τ = (V − V₀)/(V₁ − V₀) between the ends of the row, V* the lighting of the least contrast, and all per
//! band:
//!
//!   S(V) = S₀ + τS₁,   ∂S/∂g(V) = c* − (V − V*)x,   c* = ∂S/∂g(V*),   x = −∂²S/∂g∂V
//!
//! Nuisances, x and c* are orthogonalised once, in this order, under the weights 1/S of one V: qᵢ, then x⊥, then r, with
//! s the share of x⊥ in c*. What has to cancel cancels there, band by band. Under the weights of another V
//! the columns are still nearly orthogonal, and
//!
//!   4d²ΣS = ‖P⊥v‖²,   v = r + ψx⊥,   ψ = s − (V − V*)
//!
//! follows from their inner products without loss; those are interpolated in V with a known error, see
//! [`super::chebyshev`]. Since V* minimises the contrast, neither c* nor (V − V*)x is longer than the contrast at V.
//!
//! Points where digits would be lost, or where it might be that nothing can be told apart, go to [`LocalSolver`], as do
//! sets of unknowns whose span changes along the row. Results agree with those of [`LocalSolver`] to
//! 1e-14·none/d, none the distance with no nuisance.

use super::MapPoint;
use super::chebyshev::{Chebyshev, Cosines, Points, left_into};
use super::passes::{Entries, MOST_COLUMNS, Slope, growth_into, products_at, slope_into};
use crate::error::Result;
use crate::fisher::{Nuisance, Projector, Unknowns};
use crate::identifiability::local::{LocalSolver, SAFE_RANGE};
use crate::scene::{Columns, Jacobian, Parameter, State, Surroundings};
use crate::simd::{Aligned, Chunk, LANES, spaced};
use crate::spectrum::Bands;

/// Points for which a row is worth its while.
const FEWEST: usize = 12;
/// Nodes at most, however many points there are.
const MOST_NODES: usize = 16;
/// Share of the contrast that v may be, times the shares that are left of the nuisances: below it, rounding of the
/// columns may be all there is, and [`LocalSolver`] is to judge.
const LEAST_LEFT: f64 = 1e-10;

/// Computes rows of a map again and again.
pub(super) struct RowSolver<'a> {
    solver: LocalSolver<'a>,
    /// Whether the nuisances span the same along a row, and whether V = 0 is an exception.
    fixed_span: bool,
    none_at_zero: bool,
    parameters: Vec<Parameter>,
    total_known: bool,
    jacobian: Jacobian<'a>,
    projector: Projector,
    /// S₀, S₁, u at the reference, and ∂S/∂g at the first end.
    low: Aligned,
    growth: Aligned,
    /// Largest so far along the row.
    cancellation: f64,
    weights: Aligned,
    first: Aligned,
    columns: Aligned,
    cosines: Cosines,
    nodes: Vec<f64>,
    values: Vec<Entries>,
    coefficients: Vec<Entries>,
    points: [Vec<Chunk>; 3],
}

/// A surface and what it is compared with.
#[derive(Clone, Copy)]
pub(super) struct Pair<'e> {
    pub(super) emissivity: &'e [f64],
    pub(super) alternative: &'e [f64],
}

/// What the orthogonal columns tell of v at any V.
struct Reference {
    /// V*, and s.
    lighting: f64,
    share: f64,
    /// ‖c*‖ and ‖x‖, and what the columns before leave of them, times the shares that are left of those and divided by
    /// the cancellation: see [`LEAST_LEFT`].
    lengths: [f64; 2],
    sure: [f64; 2],
}

impl<'a> RowSolver<'a> {
    pub(super) fn new(bands: &'a Bands, surroundings: &'a Surroundings, unknowns: &Unknowns) -> Self {
        let mut parameters = unknowns.parameters(surroundings.objects().len());
        parameters.push(Parameter::Material);
        let total_known = unknowns.known_lighting_total().is_some();
        // ∂S/∂ln G = S changes along the row by a multiple of ∂S/∂V.
        let gain = unknowns.contains(Nuisance::Gain);
        let gain_moves = gain && (total_known || !unknowns.contains(Nuisance::Lighting));
        Self {
            solver: LocalSolver::new(bands, surroundings, unknowns.clone()),
            fixed_span: !gain_moves && parameters.len() < MOST_COLUMNS && bands.len() > parameters.len() + 1,
            none_at_zero: unknowns.contains(Nuisance::EnvironmentTemperature),
            parameters,
            total_known,
            jacobian: Jacobian::new(bands, surroundings),
            projector: Projector::default(),
            low: Aligned::zeros(bands.len()),
            growth: Aligned::zeros(bands.len()),
            cancellation: 1.0,
            weights: Aligned::zeros(bands.len()),
            first: Aligned::zeros(bands.len()),
            columns: Aligned::default(),
            cosines: Cosines::default(),
            nodes: Vec::new(),
            values: Vec::new(),
            coefficients: Vec::new(),
            points: Default::default(),
        }
    }

    /// Appends the points of `lightings` at the temperature of `state`; its own first lighting factor does not count.
    pub(super) fn row(
        &mut self,
        pair: Pair<'_>,
        state: &mut State,
        lightings: &[f64],
        out: &mut Vec<MapPoint>,
    ) -> Result<()> {
        if lightings.len() >= FEWEST && self.fixed_span && !state.lighting.is_empty() {
            if self.together(pair, state, lightings, out)?.is_some() {
                return Ok(());
            }
            if lightings.len() >= 2 * FEWEST {
                let (a, b) = lightings.split_at(lightings.len() / 2);
                self.row(pair, state, a, out)?;
                return self.row(pair, state, b, out);
            }
        }
        for &lighting in lightings {
            out.push(self.alone(pair, state, lighting)?);
        }
        Ok(())
    }

    /// One point, judged with all care.
    fn alone(&mut self, pair: Pair<'_>, state: &mut State, lighting: f64) -> Result<MapPoint> {
        light(state, lighting);
        let (distance, photon_radiance) = self.solver.point(pair.emissivity, pair.alternative, state)?;
        Ok(MapPoint { distance, photon_radiance })
    }

    /// All points together; `None`, and nothing appended, if they are not alike enough.
    fn together(
        &mut self,
        pair: Pair<'_>,
        state: &mut State,
        lightings: &[f64],
        out: &mut Vec<MapPoint>,
    ) -> Result<Option<()>> {
        let low = lightings.iter().copied().fold(f64::INFINITY, f64::min);
        let high = lightings.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let width = high - low;
        if !(low >= 0.0 && width > 0.0 && width.is_finite()) {
            return Ok(None);
        }
        let Some((chebyshev, total)) = self.ends(pair, state, [low, high], lightings.len() / 2) else {
            return Ok(None);
        };
        let Some(reference) = self.orthogonalise(pair, state, [low, high], chebyshev) else {
            return Ok(None);
        };
        let columns = self.interpolate(chebyshev);
        let total_growth = crate::sum::sum(&self.growth);
        let tau = |lighting: f64| (lighting - low) / width;
        let [t, psi, left] = &mut self.points;
        let eights = || lightings.chunks(LANES);
        t.clear();
        t.extend(eights().map(|eight| chunk(eight, |lighting| chebyshev.t(tau(lighting)))));
        psi.clear();
        psi.extend(eights().map(|eight| chunk(eight, |lighting| reference.psi(lighting))));
        left.clear();
        left.resize(t.len(), [f64::NAN; LANES]);
        left_into(Points { columns, coefficients: &self.coefficients, t, psi, out: left });
        for (i, &lighting) in lightings.iter().enumerate() {
            let left = self.points[2][i / LANES][i % LANES];
            let sure = reference.is_sure(lighting) && !(self.none_at_zero && lighting == 0.0);
            if !(sure && left > 0.0) {
                out.push(self.alone(pair, state, lighting)?);
                continue;
            }
            let tau = tau(lighting);
            let photon_radiance = total + tau * total_growth;
            let distance = 0.5 * (left / (chebyshev.factor(tau) * photon_radiance)).sqrt();
            out.push(MapPoint { distance, photon_radiance });
        }
        Ok(Some(()))
    }

    /// S₀ and S₁, ∂S/∂g at the first end and all columns at the other one, which the Jacobian keeps; ΣS₀.
    fn ends(
        &mut self,
        pair: Pair<'_>,
        state: &mut State,
        [low, high]: [f64; 2],
        most_nodes: usize,
    ) -> Option<(Chebyshev, f64)> {
        light(state, low);
        let material = &[Parameter::Material];
        self.jacobian.evaluate(pair.emissivity, pair.alternative, state, material, self.total_known);
        self.cancellation = self.jacobian.cancellation();
        self.low.copy_from_slice(self.jacobian.signal());
        self.first.copy_from_slice(self.jacobian.column(0));
        light(state, high);
        self.jacobian.evaluate(pair.emissivity, pair.alternative, state, &self.parameters, self.total_known);
        self.cancellation = self.cancellation.max(self.jacobian.cancellation());
        let total = crate::sum::sum(&self.low);
        if !(SAFE_RANGE.contains(&total) && SAFE_RANGE.contains(&crate::sum::sum(self.jacobian.signal()))) {
            return None;
        }
        let (least, most) = growth_into(&self.low, self.jacobian.signal(), &mut self.growth);
        let chebyshev = Chebyshev::new(least, most, most_nodes.min(MOST_NODES))?;
        Some((chebyshev, total))
    }

    /// Nuisances, x and c* made orthogonal under the weights in the middle.
    fn orthogonalise(
        &mut self,
        pair: Pair<'_>,
        state: &mut State,
        [low, high]: [f64; 2],
        chebyshev: Chebyshev,
    ) -> Option<Reference> {
        let (nuisances, bands, stride) = (self.parameters.len() - 1, self.low.len(), spaced(self.low.len()));
        self.columns.set_len(stride * (nuisances + 2));
        for (i, out) in self.columns.chunks_mut(stride).take(nuisances).enumerate() {
            out[..bands].copy_from_slice(self.jacobian.column(i));
        }
        let (_, material) = self.columns.split_at_mut(stride * nuisances);
        let (slope, least) = material.split_at_mut(stride);
        let (slope, least) = (&mut slope[..bands], &mut least[..bands]);
        let (square, along) = slope_into(Slope {
            low: &self.low,
            growth: &self.growth,
            reference: chebyshev.middle(),
            first: &self.first,
            last: self.jacobian.column(nuisances),
            per_lighting: 1.0 / (high - low),
            weights: &mut self.weights,
            slope: &mut *slope,
        });
        let lighting = (low + along / square).clamp(low, high);
        if lighting == low {
            least.copy_from_slice(&self.first);
        } else if lighting < high {
            light(state, lighting);
            let material = &[Parameter::Material];
            self.jacobian.evaluate(pair.emissivity, pair.alternative, state, material, self.total_known);
            self.cancellation = self.cancellation.max(self.jacobian.cancellation());
            least.copy_from_slice(self.jacobian.column(0));
        } else {
            least.copy_from_slice(self.jacobian.column(nuisances));
        }
        if !lighting.is_finite() {
            return None;
        }
        let columns = Columns { values: &mut self.columns, stride };
        // No more than the shares and lengths it leaves behind are needed.
        let _ = self.projector.reduce(columns, &self.weights, 1.0);
        let (lengths, norms) = self.projector.lengths_and_norms();
        // A nuisance that changes nothing is left out, but whether one is dependent is not to be judged here.
        let left = |i: usize| if lengths[i] > 0.0 { norms[i] / lengths[i] } else { 1.0 };
        let sure = (0..nuisances).map(left).product::<f64>() / self.cancellation;
        (norms[nuisances] > 0.0 && sure > 0.0).then(|| Reference {
            lighting,
            share: self.projector.share_in_last(nuisances),
            lengths: [lengths[nuisances + 1], lengths[nuisances]],
            sure: [sure * norms[nuisances + 1], sure * norms[nuisances]],
        })
    }

    /// Coefficients of the inner products of the columns that are left; how many columns these are.
    fn interpolate(&mut self, chebyshev: Chebyshev) -> usize {
        let (_, norms) = self.projector.lengths_and_norms();
        let (bands, stride) = (self.low.len(), spaced(self.low.len()));
        let mut columns: [&[f64]; MOST_COLUMNS] = [&[]; MOST_COLUMNS];
        let mut count = 0;
        for (i, column) in self.columns.chunks(stride).enumerate() {
            // A nuisance that changes nothing is left out; r may vanish and stays.
            if norms[i] > 0.0 || i + 1 == norms.len() {
                columns[count] = &column[..bands];
                count += 1;
            }
        }
        self.cosines.prepare(chebyshev.count);
        chebyshev.nodes(&self.cosines, &mut self.nodes);
        self.values.clear();
        self.values.resize(chebyshev.count, Entries::default());
        products_at(&self.low, &self.growth, &columns[..count], &self.nodes, &mut self.values);
        chebyshev.coefficients(&self.cosines, &self.nodes, &self.values, &mut self.coefficients);
        count
    }
}

impl Reference {
    /// ψ = s − (V − V*).
    fn psi(&self, lighting: f64) -> f64 {
        self.share - (lighting - self.lighting)
    }

    /// Whether v at V is long enough that the distance is certainly more than its rounding error.
    fn is_sure(&self, lighting: f64) -> bool {
        let [r, x] = self.sure;
        let contrast = self.lengths[0] + (lighting - self.lighting).abs() * self.lengths[1];
        r.max(self.psi(lighting).abs() * x) >= LEAST_LEFT * contrast
    }
}

fn light(state: &mut State, lighting: f64) {
    if let Some(first) = state.lighting.first_mut() {
        *first = lighting;
    }
}

/// Eight points; the last one again where there are fewer.
fn chunk(points: &[f64], of: impl Fn(f64) -> f64) -> Chunk {
    std::array::from_fn(|i| points.get(i).or(points.last()).map_or(0.0, |point| of(*point)))
}
