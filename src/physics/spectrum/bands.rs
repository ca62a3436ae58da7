//! Bands and the nodes that sample them.

mod build;
mod join;

use super::filter::FilterCurve;
use super::rows::Gaps;
use crate::error::{Error, Result};
use crate::simd::dispatched;

/// Transmittance of what is opaque.
pub(crate) const OPAQUE: f64 = 1e-30;

/// One spectral band as reports show it.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Band {
    /// Centre (of a filter: its transmission-weighted mean), cm⁻¹.
    pub center_cm1: f64,
    /// Wavenumber of the lower edge of the band, cm⁻¹.
    pub low_cm1: f64,
    /// Wavenumber of the upper edge of the band, cm⁻¹.
    pub high_cm1: f64,
    /// Name of the filter, if it has one.
    pub name: Option<String>,
}

/// What lets light into a band.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Shape {
    /// Everything between the edges.
    TopHat,
    /// A filter curve.
    Filter(FilterCurve),
}

/// Bands in ascending wavenumber with the nodes and weights that sample them.
///
/// ```
/// use hadar::spectrum::Bands;
/// let bands = Bands::uniform(715.0, 1250.0, 1.0)?;
/// assert_eq!(bands.len(), 536);
/// assert_eq!(bands.sum_nodes(bands.nodes_cm1())[0], 715.0);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Bands {
    pub(super) bands: Vec<Band>,
    pub(super) shapes: Vec<Shape>,
    pub(super) nodes_cm1: Vec<f64>,
    pub(super) weights_cm1: Vec<f64>,
    /// First node of each band, and the number of nodes at the end.
    pub(super) first_node: Vec<usize>,
}

impl Bands {
    /// Number of bands W.
    #[must_use]
    pub fn len(&self) -> usize {
        self.bands.len()
    }

    /// Never true: a set of bands has at least one.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.bands.is_empty()
    }

    /// The bands, ascending.
    #[must_use]
    pub fn bands(&self) -> &[Band] {
        &self.bands
    }

    /// Where spectra are sampled, cm⁻¹ (ascending within a band).
    #[must_use]
    pub fn nodes_cm1(&self) -> &[f64] {
        &self.nodes_cm1
    }

    /// Lowest and highest node, cm⁻¹.
    #[must_use]
    pub fn range_cm1(&self) -> (f64, f64) {
        // They ascend within a band, and bands may overlap.
        let ends = |ends: &[usize]| {
            Some([*self.nodes_cm1.get(ends[0])?, *self.nodes_cm1.get(ends[1].checked_sub(1)?)?])
        };
        let of_bands = self.first_node.windows(2).filter_map(ends);
        of_bands.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), [first, last]| {
            (low.min(first), high.max(last))
        })
    }

    /// Whether every band has just one node, so that samples map to bands one to one.
    #[must_use]
    pub fn one_node_per_band(&self) -> bool {
        self.nodes_cm1.len() == self.bands.len()
    }

    /// The same bands behind something that lets the share `transmittance` of each wavenumber (cm⁻¹) through.
    #[must_use]
    pub(crate) fn transmitted(&self, transmittance: impl Fn(f64) -> f64) -> Self {
        let shares: Vec<f64> = self.nodes_cm1.iter().map(|node| transmittance(*node)).collect();
        self.transmitted_at_nodes(&shares)
    }

    /// The same with what is let through given at the nodes.
    #[must_use]
    pub fn transmitted_at_nodes(&self, shares: &[f64]) -> Self {
        let mut bands = self.clone();
        for (weight, share) in bands.weights_cm1.iter_mut().zip(shares) {
            // A band that nothing reaches keeps a weight that can be divided by.
            *weight *= share.max(OPAQUE);
        }
        bands
    }

    /// ∫ f(ν, T, R) dν over `range_cm1` for the filter of each band, T its transmittance and R its reflectance at ν; 0 for bands
    /// without a filter. `None` if there is no filter at all. Between rows of the filter and the other `kinks_cm1` of f by
    /// Gauss–Legendre rules of three points, at most 8 cm⁻¹ wide: thermal radiance is integrated to rounding.
    #[must_use]
    pub fn over_filters(
        &self,
        range_cm1: [f64; 2],
        kinks_cm1: &[f64],
        f: impl Fn(f64, f64, f64) -> f64,
    ) -> Option<Vec<f64>> {
        if self.shapes.iter().all(|shape| *shape == Shape::TopHat) {
            return None;
        }
        let [low, high] = range_cm1;
        let integral = |filter: &FilterCurve| {
            let rows = filter.wavenumbers_cm1.iter().chain(kinks_cm1).filter(|nu| (low..high).contains(*nu));
            let mut edges: Vec<f64> = rows.copied().chain([low, high]).collect();
            edges.sort_by(f64::total_cmp);
            let at = |nu: f64| f(nu, filter.transmittance(nu), filter.reflectance(nu));
            let over = |pair: &[f64]| {
                let count = ((pair[1] - pair[0]) / 8.0).ceil().clamp(1.0, 1e6);
                let half = 0.5 * (pair[1] - pair[0]) / count;
                let part = |i: usize| {
                    let middle = (2.0 * i as f64 + 1.0).mul_add(half, pair[0]);
                    let off = 0.6_f64.sqrt() * half;
                    half * (5.0 * (at(middle - off) + at(middle + off)) + 8.0 * at(middle)) / 9.0
                };
                (0..count as usize).map(part).sum::<f64>()
            };
            edges.windows(2).filter(|pair| pair[1] > pair[0]).map(over).sum::<f64>()
        };
        let of_shape = |shape: &Shape| match shape {
            Shape::TopHat => 0.0,
            Shape::Filter(filter) => integral(filter),
        };
        Some(self.shapes.iter().map(of_shape).collect())
    }

    /// Refuses bands of which a table with rows at these ascending wavenumbers, cm⁻¹, says nothing.
    ///
    /// # Errors
    /// Bands that reach beyond the rows or into a gap of them; `name` is what the table gives.
    ///
    /// ```
    /// use hadar::spectrum::Bands;
    /// let bands = Bands::uniform(800.0, 900.0, 20.0)?;
    /// let rows: Vec<f64> = (0..40).map(|i| 700.0 + 10.0 * f64::from(i)).collect();
    /// assert!(bands.check_within("the noise", &rows).is_ok());
    /// assert!(bands.check_within("the noise", &rows[..15]).is_err());
    /// // Without the rows from 800 to 880 cm⁻¹.
    /// let cut: Vec<f64> = rows.iter().copied().filter(|nu| !(800.0..=880.0).contains(nu)).collect();
    /// assert!(bands.check_within("the noise", &cut).is_err());
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn check_within(&self, name: &str, rows_cm1: &[f64]) -> Result<()> {
        let (low, high) = self.range_cm1();
        if let (Some(from), Some(to)) = (rows_cm1.first(), rows_cm1.last())
            && (low < *from || high > *to)
        {
            return Err(Error::malformed(
                format!(
                    "{name} is given from {from} to {to} cm^-1, the bands reach from {low} to {high} cm^-1"
                ),
                "add rows, or narrow the bands",
            ));
        }
        let gaps = Gaps::of(rows_cm1);
        self.bands.iter().try_for_each(|band| gaps.check_range([band.low_cm1, band.high_cm1]))
    }

    /// The largest transmittance at which the rows of a filter end within a range, cm⁻¹ ([`FilterCurve::cut_within`]).
    #[must_use]
    pub fn cut_filters(&self, range_cm1: [f64; 2]) -> Option<f64> {
        let cut = self.shapes.iter().filter_map(|shape| match shape {
            Shape::TopHat => None,
            Shape::Filter(filter) => filter.cut_within(range_cm1),
        });
        cut.reduce(f64::max)
    }

    /// Weight of each node, cm⁻¹.
    pub fn weights_cm1(&self) -> &[f64] {
        &self.weights_cm1
    }

    /// Effective width Σ_j w_j of each band, cm⁻¹.
    #[must_use]
    pub fn widths_cm1(&self) -> Vec<f64> {
        let ones = vec![1.0; self.nodes_cm1.len()];
        self.weigh(&ones)
    }

    /// Plain sum of node values over each band (for quantities that are zero or equal within a band).
    #[must_use]
    pub fn sum_nodes(&self, values: &[f64]) -> Vec<f64> {
        self.first_node.windows(2).map(|nodes| values[nodes[0]..nodes[1]].iter().sum()).collect()
    }

    /// A value of each band at all of its nodes.
    #[must_use]
    pub fn spread(&self, per_band: &[f64]) -> Vec<f64> {
        self.nodes_per_band()
            .zip(per_band)
            .flat_map(|(nodes, value)| std::iter::repeat_n(*value, nodes))
            .collect()
    }

    /// How many nodes each band has.
    pub(crate) fn nodes_per_band(&self) -> impl Iterator<Item = usize> {
        self.first_node.windows(2).map(|nodes| nodes[1] - nodes[0])
    }

    /// Band integrals Σ_j w_qj f(ν_j) of a spectrum given at the nodes.
    #[must_use]
    pub fn weigh(&self, values: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.len()];
        self.weigh_into(values, &mut out);
        out
    }

    /// [`Bands::weigh`] into a slice of one value per band.
    pub fn weigh_into(&self, values: &[f64], out: &mut [f64]) {
        if self.one_node_per_band() {
            product_into(values, &self.weights_cm1, out);
            return;
        }
        for (out, nodes) in out.iter_mut().zip(self.first_node.windows(2)) {
            let range = nodes[0]..nodes[1];
            *out = crate::sum::dot(&values[range.clone()], &self.weights_cm1[range]);
        }
    }
}

dispatched! {
    fn product_into<'a>(a: &'a [f64], b: &'a [f64], out: &'a mut [f64]) {
        for ((out, a), b) in out.iter_mut().zip(a).zip(b) {
            *out = a * b;
        }
    }
}

/// Where a band must be cut so that its transmittance is a straight line on every piece.
pub(super) fn edges(band: &Band, shape: &Shape, more: &[f64]) -> Vec<f64> {
    let mut edges = vec![band.low_cm1, band.high_cm1];
    if let Shape::Filter(filter) = shape {
        edges.extend(&filter.wavenumbers_cm1);
    }
    edges.extend(more.iter().filter(|&&cut| cut > band.low_cm1 && cut < band.high_cm1));
    edges.sort_by(f64::total_cmp);
    edges.dedup();
    edges
}

pub(super) fn transmittance(shape: &Shape, wavenumber_cm1: f64) -> f64 {
    match shape {
        Shape::TopHat => 1.0,
        Shape::Filter(filter) => filter.transmittance(wavenumber_cm1),
    }
}
