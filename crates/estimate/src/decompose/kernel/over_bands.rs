//! What a state's fit is made of, added up over the bands: deviance D, Pearson's χ², slope Σ r ∂ᵢN/N′ and information Σ ∂ᵢN ∂ⱼN/N′
//! of the unknowns i; symbols as in [`super`].
//!
//! Up to [`AT_ONCE`] unknowns stay in registers while the bands go by once; of more, each sum is a pass of its own.

use super::SMALL;
use hadar::simd::{Chunk, LANES, added, fold, product};

/// Most unknowns whose sums are formed together: with five there are 23 sums in 32 registers.
const AT_ONCE: usize = 5;

/// A state beside the counts: n′, N′, 1/N′, r/N′ and s(x) of every band, and ∂ᵢN one after the other.
#[derive(Clone, Copy)]
pub(in crate::decompose) struct Compared<'a> {
    pub(in crate::decompose) counts: &'a [f64],
    pub(in crate::decompose) mean: &'a [f64],
    pub(in crate::decompose) weight: &'a [f64],
    pub(in crate::decompose) relative: &'a [f64],
    pub(in crate::decompose) series: &'a [f64],
    pub(in crate::decompose) columns: &'a [f64],
}

/// Where the slope and the information go.
pub(in crate::decompose) struct Bent<'a, const M: usize> {
    pub(in crate::decompose) slope: &'a mut [f64; M],
    pub(in crate::decompose) information: &'a mut [[f64; M]; M],
}

/// How well a state fits.
#[derive(Debug, Clone, Copy)]
pub(in crate::decompose) struct Fitting {
    pub(in crate::decompose) deviance: f64,
    pub(in crate::decompose) chi_square: f64,
    /// Whether some |x| is so large that the series, and with it the deviance, does not hold.
    pub(in crate::decompose) is_far: bool,
}

/// All sums of `count` unknowns.
#[inline(always)]
pub(in crate::decompose) fn over_bands<const M: usize>(
    compared: Compared<'_>,
    count: usize,
    mut bent: Bent<'_, M>,
) -> Fitting {
    match count {
        1 => together::<1, M>(compared, &mut bent),
        2 => together::<2, M>(compared, &mut bent),
        3 => together::<3, M>(compared, &mut bent),
        4 => together::<4, M>(compared, &mut bent),
        AT_ONCE => together::<AT_ONCE, M>(compared, &mut bent),
        _ => {
            one_by_one(compared, count, &mut bent);
            together::<0, M>(compared, &mut bent)
        }
    }
}

/// The first `bands` of a spectrum.
#[inline(always)]
fn cut(spectrum: &[f64], bands: usize) -> &[Chunk] {
    spectrum[..bands].as_chunks().0
}

/// D and χ², and slope and information of N unknowns.
#[inline(always)]
fn together<const N: usize, const M: usize>(compared: Compared<'_>, to: &mut Bent<'_, M>) -> Fitting {
    let bands = compared.mean.len();
    let [n, mean] = [compared.counts, compared.mean].map(|x| cut(x, bands));
    let [weight, relative, series] =
        [compared.weight, compared.relative, compared.series].map(|x| cut(x, bands));
    let columns: [&[Chunk]; N] = std::array::from_fn(|i| cut(&compared.columns[i * bands..], bands));
    let mut sums = Sums::<N>::new();
    for c in 0..mean.len() {
        let (n, mean, weight, relative) = (n[c], mean[c], weight[c], relative[c]);
        let residual: Chunk = std::array::from_fn(|k| n[k] - mean[k]);
        for k in 0..LANES {
            // |r| > SMALL (n′ + N′), without a division.
            let over = SMALL.mul_add(-(n[k] + mean[k]), residual[k].abs());
            sums.over[k] = if over > sums.over[k] { over } else { sums.over[k] };
        }
        let squared = product(residual, relative);
        sums.chi_square = added(squared, [1.0; LANES], sums.chi_square);
        sums.deviance = added(squared, series[c], sums.deviance);
        for i in 0..N {
            sums.slope[i] = added(columns[i][c], relative, sums.slope[i]);
            for j in 0..=i {
                sums.information[i][j] =
                    added(product(columns[i][c], columns[j][c]), weight, sums.information[i][j]);
            }
        }
    }
    sums.value(to)
}

/// The same while the bands go by.
struct Sums<const N: usize> {
    /// The largest |r| − SMALL (n′ + N′).
    over: Chunk,
    chi_square: Chunk,
    deviance: Chunk,
    slope: [Chunk; N],
    information: [[Chunk; N]; N],
}

impl<const N: usize> Sums<N> {
    #[inline(always)]
    fn new() -> Self {
        let zero = [0.0; LANES];
        Self { over: zero, chi_square: zero, deviance: zero, slope: [zero; N], information: [[zero; N]; N] }
    }

    /// Never inlined: the lanes then go through memory all at once, which keeps the loop before in full-width registers.
    #[inline(never)]
    fn value<const M: usize>(&self, to: &mut Bent<'_, M>) -> Fitting {
        for i in 0..N {
            to.slope[i] = fold(&self.slope[i]);
            for j in 0..=i {
                let sum = fold(&self.information[i][j]);
                (to.information[i][j], to.information[j][i]) = (sum, sum);
            }
        }
        let is_far = self.over.iter().any(|over| *over > 0.0);
        Fitting { deviance: fold(&self.deviance), chi_square: fold(&self.chi_square), is_far }
    }
}

/// Slope and information, sum by sum.
#[inline(always)]
fn one_by_one<const M: usize>(compared: Compared<'_>, count: usize, to: &mut Bent<'_, M>) {
    let bands = compared.mean.len();
    let [weight, relative] = [compared.weight, compared.relative].map(|x| cut(x, bands));
    for i in 0..count {
        let own = cut(&compared.columns[i * bands..], bands);
        let mut slope = [0.0; LANES];
        for (a, t) in own.iter().zip(relative) {
            slope = added(*a, *t, slope);
        }
        to.slope[i] = fold(&slope);
        for j in 0..=i {
            let other = cut(&compared.columns[j * bands..], bands);
            let mut sum = [0.0; LANES];
            for ((a, b), weight) in own.iter().zip(other).zip(weight) {
                sum = added(product(*a, *b), *weight, sum);
            }
            let sum = fold(&sum);
            (to.information[i][j], to.information[j][i]) = (sum, sum);
        }
    }
}
