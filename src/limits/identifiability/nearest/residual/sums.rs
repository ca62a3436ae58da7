//! Cost, gradient and second derivatives of a residual in one pass over the bands.
//!
//! Symbols as in [`super`]: with p = r s and h = s²(1 + r/ρ) of each band the sums are Σ r², Σ p S′ᵢ, Σ s² S′ᵢS′ⱼ,
//! Σ h S′ᵢS′ⱼ and Σ p S′_TT. They are added in lanes over blocks of bands and compensated from block to block
//! ([`crate::sum`]), so that their error does not grow with the number of bands.

use crate::few::{Few, FewColumns};
use crate::identifiability::space::Quadratic;
use crate::scene::Jacobian;
use crate::simd::{Chunk, LANES, added, dispatched, fold, fused, padded, product};
use crate::sum::Compensated;

/// Columns that are worked on together; more of them go two by two.
const TOGETHER: usize = 4;
/// Chunks in a block of a compensated sum.
const BLOCK_CHUNKS: usize = 32;

/// Spectra of the bands that the sums are made of.
#[derive(Clone, Copy)]
pub(super) struct Lines<'a> {
    /// Counts per unit of band signal.
    pub(super) counts: f64,
    /// √(N + σ²) of the target, and σ².
    pub(super) root: &'a [f64],
    pub(super) noise: &'a [f64],
    /// S − S′, and S′_TT where T′ is a parameter.
    pub(super) separation: &'a [f64],
    pub(super) curvature: &'a [f64],
    /// S′.
    pub(super) signal: &'a [f64],
}

/// Sums over the bands.
pub(super) struct Sums {
    /// Σ r².
    pub(super) cost: f64,
    /// Σ p S′_TT.
    pub(super) curvature: f64,
    /// Without the second derivatives of S′.
    pub(super) quadratic: Quadratic,
}

/// Σ r² alone.
pub(super) fn cost(lines: Lines<'_>) -> f64 {
    crate::stop::check();
    pass(lines, [&[]; TOGETHER], 0).cost
}

/// All sums, for the columns of a surface.
pub(super) fn sums(lines: Lines<'_>, surface: &Jacobian<'_>) -> Sums {
    let n = surface.parameters().len();
    let (gradient, gauss_newton) = (Few::zeros(n), FewColumns::zeros(n, n));
    let quadratic = Quadratic { gradient, hessian: gauss_newton.clone(), gauss_newton };
    let mut sums = Sums { cost: 0.0, curvature: 0.0, quadratic };
    if n <= TOGETHER {
        sums.put(lines, surface, &[0, 1, 2, 3][..n]);
    } else {
        for i in 0..n {
            for j in i + 1..n {
                sums.put(lines, surface, &[i, j]);
            }
        }
    }
    sums
}

impl Sums {
    /// The sums of the columns at these places.
    fn put(&mut self, lines: Lines<'_>, surface: &Jacobian<'_>, places: &[usize]) {
        crate::stop::check();
        let mut columns: [&[f64]; TOGETHER] = [&[]; TOGETHER];
        for (column, &place) in columns.iter_mut().zip(places) {
            *column = surface.column(place);
        }
        let found = pass(lines, columns, places.len());
        (self.cost, self.curvature) = (found.cost, found.curvature);
        for (a, &i) in places.iter().enumerate() {
            self.quadratic.gradient[i] = found.gradient[a];
            for (b, &j) in places.iter().enumerate() {
                let (first, second) = (a.min(b), a.max(b));
                self.quadratic.gauss_newton[(i, j)] = found.gauss_newton[first][second];
                self.quadratic.hessian[(i, j)] = found.hessian[first][second];
            }
        }
    }
}

/// Sums of a handful of columns; of the matrices the upper triangle.
#[derive(Default)]
struct Found {
    cost: f64,
    curvature: f64,
    gradient: [f64; TOGETHER],
    gauss_newton: [[f64; TOGETHER]; TOGETHER],
    hessian: [[f64; TOGETHER]; TOGETHER],
}

dispatched! {
    /// The sums of the first `count` columns.
    fn pass<'a>(lines: Lines<'a>, columns: [&'a [f64]; TOGETHER], count: usize) -> Found {
        match count {
            0 => all::<0>(lines, columns),
            1 => all::<1>(lines, columns),
            2 => all::<2>(lines, columns),
            3 => all::<3>(lines, columns),
            _ => all::<4>(lines, columns),
        }
    }
}

/// Sums of a block in lanes, and with T = [`Compensated`] of all.
struct Total<T, const N: usize> {
    cost: T,
    curvature: T,
    gradient: [T; N],
    gauss_newton: [[T; N]; N],
    hessian: [[T; N]; N],
}

impl<T: Copy, const N: usize> Total<T, N> {
    #[inline(always)]
    fn of(zero: T) -> Self {
        let (gradient, matrix) = ([zero; N], [[zero; N]; N]);
        Self { cost: zero, curvature: zero, gradient, gauss_newton: matrix, hessian: matrix }
    }
}

impl<const N: usize> Total<Compensated, N> {
    /// Adds the lanes of a block. Never inlined: the lanes then go through memory all at once, which keeps the
    /// loop before in full-width registers.
    #[inline(never)]
    fn add(&mut self, block: &Total<Chunk, N>) {
        self.cost.add(fold(&block.cost));
        if N == 0 {
            return;
        }
        self.curvature.add(fold(&block.curvature));
        for i in 0..N {
            self.gradient[i].add(fold(&block.gradient[i]));
            for j in i..N {
                self.gauss_newton[i][j].add(fold(&block.gauss_newton[i][j]));
                self.hessian[i][j].add(fold(&block.hessian[i][j]));
            }
        }
    }
}

#[inline(always)]
fn all<const N: usize>(lines: Lines<'_>, columns: [&[f64]; TOGETHER]) -> Found {
    let Lines { counts, root, noise, separation, curvature, signal } = lines;
    let bands = root.len();
    let spectra = [root, noise, separation, curvature, signal].map(|line| line[..bands].as_chunks());
    let columns: [_; N] = std::array::from_fn(|i| columns[i][..bands].as_chunks());
    let mut total = Total::of(Compensated::default());
    run(counts, spectra.map(|line| line.0), columns.map(|column| column.0), &mut total);
    if !bands.is_multiple_of(LANES) {
        let (spectra, columns) =
            (spectra.map(|line| [padded(line.1)]), columns.map(|column| [padded(column.1)]));
        let spectra = spectra.each_ref().map(|line| &line[..]);
        run(counts, spectra, columns.each_ref().map(|column| &column[..]), &mut total);
    }
    let mut found =
        Found { cost: total.cost.value(), curvature: total.curvature.value(), ..Found::default() };
    for i in 0..N {
        found.gradient[i] = total.gradient[i].value();
        for j in i..N {
            found.gauss_newton[i][j] = total.gauss_newton[i][j].value();
            found.hessian[i][j] = total.hessian[i][j].value();
        }
    }
    found
}

/// The bands of [`all`] in whole chunks: the spectra of [`Lines`] in the order they stand in there. Values pass through
/// locals, chunk by chunk: only then are they kept in full-width registers.
#[allow(clippy::needless_range_loop, reason = "two columns at a time")]
#[inline(always)]
fn run<const N: usize>(
    counts: f64,
    spectra: [&[Chunk]; 5],
    columns: [&[Chunk]; N],
    total: &mut Total<Compensated, N>,
) {
    let count = spectra[0].len();
    let [root, noise, separation, curvature, signal] = spectra.map(|spectrum| &spectrum[..count]);
    let columns = columns.map(|column| &column[..count]);
    for start in (0..count).step_by(BLOCK_CHUNKS) {
        let mut block = Total::of([0.0; LANES]);
        for c in start..(start + BLOCK_CHUNKS).min(count) {
            let (own, other) = (root[c], square_root(fused(counts, signal[c], noise[c])));
            let residual = quotient(times(counts, separation[c]), sum(own, other));
            block.cost = added(residual, residual, block.cost);
            if N == 0 {
                continue;
            }
            let inverse = quotient([1.0; LANES], other);
            let slope = times(-0.5 * counts, inverse);
            let (pull, square) = (product(residual, slope), product(slope, slope));
            let bent = added(pull, product(slope, inverse), square);
            block.curvature = added(pull, curvature[c], block.curvature);
            for i in 0..N {
                let column = columns[i][c];
                block.gradient[i] = added(pull, column, block.gradient[i]);
                let (squared, bent) = (product(square, column), product(bent, column));
                for j in i..N {
                    let other = columns[j][c];
                    block.gauss_newton[i][j] = added(squared, other, block.gauss_newton[i][j]);
                    block.hessian[i][j] = added(bent, other, block.hessian[i][j]);
                }
            }
        }
        total.add(&block);
    }
}

/// a/b, and 0 where b is not above 0.
#[inline(always)]
fn quotient(a: Chunk, b: Chunk) -> Chunk {
    std::array::from_fn(|i| if b[i] > 0.0 { a[i] / b[i] } else { 0.0 })
}

#[inline(always)]
fn square_root(a: Chunk) -> Chunk {
    std::array::from_fn(|i| a[i].sqrt())
}

#[inline(always)]
fn sum(a: Chunk, b: Chunk) -> Chunk {
    std::array::from_fn(|i| a[i] + b[i])
}

#[inline(always)]
fn times(factor: f64, a: Chunk) -> Chunk {
    std::array::from_fn(|i| factor * a[i])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fisher::{Nuisance, Unknowns};
    use crate::scene::{EnvironmentObject, Surroundings};
    use crate::spectrum::Bands;

    /// Against sums written out as they are defined, for every number of columns and bands that fill no whole chunk.
    #[test]
    fn sums_are_what_they_are_defined_as() {
        let bands = Bands::uniform(700.0, 1249.0, 1.0).unwrap();
        let n = bands.len();
        for objects in 1..=3 {
            let object = |k: i32| {
                let wave = |nu: &f64| 0.6 + 0.3 * (nu / 40.0 + f64::from(k)).sin();
                let emissivity = Some(bands.nodes_cm1().iter().map(wave).collect());
                EnvironmentObject { temperature_k: 280.0 + 15.0 * f64::from(k), emissivity }
            };
            let objects: Vec<_> = (0..objects).map(object).collect();
            let lighting = vec![0.3; objects.len()];
            let surroundings = Surroundings::new(bands.nodes_cm1(), objects).unwrap();
            let state = surroundings.state(310.0, &lighting).unwrap();
            let all =
                [Nuisance::Temperature, Nuisance::Lighting, Nuisance::Gain, Nuisance::EnvironmentTemperature];
            let unknowns = Unknowns::new(all).unwrap();
            let parameters = unknowns.parameters(lighting.len());
            let own: Vec<f64> = (0..n).map(|i| 0.7 + 0.2 * (i as f64 / 50.0).cos()).collect();
            let mut surface = Jacobian::new(&bands, &surroundings);
            for count in 1..=parameters.len() {
                surface.evaluate(&own, &own, &state, &parameters[..count], false);
                let total: f64 = surface.signal().iter().sum();
                let spectrum =
                    |a: f64, b: f64| (0..n).map(|i| a + b * (i as f64).sin()).collect::<Vec<f64>>();
                let (root, noise) = (spectrum(0.05, 0.01), spectrum(3e-4, 1e-4));
                let (separation, curvature) = (spectrum(0.0, 1e-4 * total), spectrum(1.0, 2.0));
                let lines = Lines {
                    counts: 1.0 / total,
                    root: &root,
                    noise: &noise,
                    separation: &separation,
                    curvature: &curvature,
                    signal: surface.signal(),
                };
                let found = sums(lines, &surface);
                let rho: Vec<f64> = (0..n).map(|w| (surface.signal()[w] / total + noise[w]).sqrt()).collect();
                let r: Vec<f64> = (0..n).map(|w| separation[w] / total / (root[w] + rho[w])).collect();
                let slope = |w: usize| -0.5 / (total * rho[w]);
                let close = |a: f64, f: &dyn Fn(usize) -> f64| {
                    let (b, size): (f64, f64) = ((0..n).map(f).sum(), (0..n).map(|w| f(w).abs()).sum());
                    assert!((a - b).abs() < 1e-13 * size, "{count}: {a} {b}");
                };
                close(found.cost, &|w| r[w] * r[w]);
                close(cost(lines), &|w| r[w] * r[w]);
                close(found.curvature, &|w| r[w] * slope(w) * curvature[w]);
                for i in 0..count {
                    let a = surface.column(i);
                    close(found.quadratic.gradient[i], &|w| r[w] * slope(w) * a[w]);
                    for j in 0..count {
                        let b = surface.column(j);
                        let square = |w: usize| slope(w).powi(2) * a[w] * b[w];
                        close(found.quadratic.gauss_newton[(i, j)], &square);
                        close(found.quadratic.hessian[(i, j)], &|w| square(w) * (1.0 + r[w] / rho[w]));
                    }
                }
            }
        }
    }
}
