//! Bands and the nodes that sample them.

use super::filter::FilterCurve;
use crate::error::{Error, Result, check};
use crate::simd::dispatched;
use std::ops::Range;

/// Widest stretch of a range or filter that one midpoint node may stand for, cm⁻¹: the paper's step.
const NODE_SPACING_CM1: f64 = 1.0;
/// More bands or nodes than this are taken for a slip of the pen.
const MAX_NODES: f64 = 1e7;

/// One spectral band as reports show it.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Band {
    /// Centre (of a filter: its transmission-weighted mean), cm⁻¹.
    pub center_cm1: f64,
    /// Lower edge, cm⁻¹.
    pub low_cm1: f64,
    /// Upper edge, cm⁻¹.
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
    /// Bands of width `step` centred at start, start + step, … up to stop (cm⁻¹), one node each.
    ///
    /// # Errors
    /// Values that are not positive, stop below start, or more than 10⁷ bands.
    pub fn uniform(start_cm1: f64, stop_cm1: f64, step_cm1: f64) -> Result<Self> {
        let count = steps(start_cm1, stop_cm1, step_cm1, "cm^-1")?;
        Self::from_rows((0..count).map(|i| (i as f64).mul_add(step_cm1, start_cm1)).map(|c| (c, step_cm1)))
    }

    /// Bands of equal width in wavelength (µm), one node each at the central wavelength.
    ///
    /// # Errors
    /// As [`Bands::uniform`].
    pub fn uniform_wavelength(start_um: f64, stop_um: f64, step_um: f64) -> Result<Self> {
        let count = steps(start_um, stop_um, step_um, "um")?;
        if step_um >= 2.0 * start_um {
            return Err(Error::out_of_range("band step", step_um, "um", "below twice the first wavelength"));
        }
        Self::from_rows((0..count).map(|i| {
            let center_um = (i as f64).mul_add(step_um, start_um);
            // 10⁴/(λ − δ) − 10⁴/(λ + δ) with δ half the step, without the subtraction.
            let width = 1e4 * step_um / ((center_um - 0.5 * step_um) * (center_um + 0.5 * step_um));
            (1e4 / center_um, width)
        }))
    }

    /// Bands given by rows (centre, width) in cm⁻¹, in any order, one node each.
    ///
    /// # Errors
    /// No rows, values that are not positive, or a centre that comes twice.
    pub fn from_rows(rows: impl IntoIterator<Item = (f64, f64)>) -> Result<Self> {
        let mut rows: Vec<(f64, f64)> = rows.into_iter().collect();
        for &(center, width) in &rows {
            check::positive("band centre", center, "cm^-1")?;
            check::positive("band width", width, "cm^-1")?;
        }
        rows.sort_by(|a, b| a.0.total_cmp(&b.0));
        distinct(rows.iter().map(|row| row.0), "the bands")?;
        if rows.is_empty() {
            return Err(Error::malformed("there are no bands", "give at least one"));
        }
        let bands = rows.iter().map(|&(center, width)| Band {
            center_cm1: center,
            low_cm1: center - 0.5 * width,
            high_cm1: center + 0.5 * width,
            name: None,
        });
        Ok(Self {
            bands: bands.collect(),
            shapes: vec![Shape::TopHat; rows.len()],
            first_node: (0..=rows.len()).collect(),
            nodes_cm1: rows.iter().map(|row| row.0).collect(),
            weights_cm1: rows.iter().map(|row| row.1).collect(),
        })
    }

    /// Bands given by their centres (cm⁻¹) alone: each reaches half-way to its neighbours.
    ///
    /// # Errors
    /// As [`Bands::from_rows`], or a single centre, whose width cannot be known.
    pub fn from_centers(centers_cm1: &[f64]) -> Result<Self> {
        let mut centers = centers_cm1.to_vec();
        centers.sort_by(f64::total_cmp);
        distinct(centers.iter().copied(), "the bands")?;
        let last = centers.len().saturating_sub(1);
        if last == 0 {
            return Err(Error::malformed("one band centre without a width", "add a column width_cm1"));
        }
        let rows: Vec<_> = (0..=last)
            .map(|i| {
                let (left, right) = (centers[i.saturating_sub(1)], centers[(i + 1).min(last)]);
                let spans = if i == 0 || i == last { 1.0 } else { 2.0 };
                (centers[i], (right - left) / spans)
            })
            .collect();
        Self::from_rows(rows)
    }

    /// Bands given by ranges (low, high) in cm⁻¹, sampled at midpoints no further apart than 1 cm⁻¹.
    ///
    /// # Errors
    /// No ranges, or one that is empty or not positive.
    pub fn from_ranges(ranges_cm1: &[(f64, f64)]) -> Result<Self> {
        let mut ranges = ranges_cm1.to_vec();
        for &(low, high) in &ranges {
            check::positive("lower edge of a band", low, "cm^-1")?;
            check::finite("upper edge of a band", high, "cm^-1")?;
            if high <= low {
                return Err(Error::out_of_range(
                    "upper edge of a band",
                    high,
                    "cm^-1",
                    format!("above {low}"),
                ));
            }
        }
        ranges.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let shaped = ranges.into_iter().map(|(low, high)| {
            let band = Band { center_cm1: 0.5 * (low + high), low_cm1: low, high_cm1: high, name: None };
            (band, Shape::TopHat)
        });
        Self::sampled(shaped.collect())
    }

    /// Bands given by filter curves, sampled at midpoints no further apart than 1 cm⁻¹ between rows.
    ///
    /// # Errors
    /// No filters.
    pub fn from_filters(mut filters: Vec<FilterCurve>) -> Result<Self> {
        filters.sort_by(|a, b| a.support().0.total_cmp(&b.support().0));
        let shaped = filters.into_iter().map(|filter| {
            let (low, high) = filter.support();
            let band = Band {
                center_cm1: 0.5 * (low + high),
                low_cm1: low,
                high_cm1: high,
                name: Some(filter.name.clone()),
            };
            (band, Shape::Filter(filter))
        });
        let mut bands = Self::sampled(shaped.collect())?;
        for q in 0..bands.len() {
            let nodes = bands.first_node[q]..bands.first_node[q + 1];
            let weight: f64 = bands.weights_cm1[nodes.clone()].iter().sum();
            let moment: f64 = nodes.map(|j| bands.weights_cm1[j] * bands.nodes_cm1[j]).sum();
            bands.bands[q].center_cm1 = moment / weight;
        }
        Ok(bands)
    }

    fn sampled(shaped: Vec<(Band, Shape)>) -> Result<Self> {
        if shaped.is_empty() {
            return Err(Error::malformed("there are no bands", "give at least one"));
        }
        let (mut nodes, mut weights, mut first_node) = (Vec::new(), Vec::new(), vec![0]);
        for (band, shape) in &shaped {
            for piece in edges(band, shape, &[]).windows(2) {
                let count = ((piece[1] - piece[0]) / NODE_SPACING_CM1).ceil().max(1.0);
                if nodes.len() as f64 + count > MAX_NODES {
                    return Err(Error::out_of_range("number of band samples", count, "", "below 10^7"));
                }
                let width = (piece[1] - piece[0]) / count;
                for i in 0..count as usize {
                    let node = (i as f64 + 0.5).mul_add(width, piece[0]);
                    nodes.push(node);
                    weights.push(width * transmittance(shape, node));
                }
            }
            first_node.push(nodes.len());
        }
        let (bands, shapes) = shaped.into_iter().unzip();
        Ok(Self { bands, shapes, nodes_cm1: nodes, weights_cm1: weights, first_node })
    }

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
        let low = self.nodes_cm1.iter().copied().fold(f64::INFINITY, f64::min);
        let high = self.nodes_cm1.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        (low, high)
    }

    /// Whether every band has just one node, so that samples map to bands one to one.
    #[must_use]
    pub fn one_node_per_band(&self) -> bool {
        self.nodes_cm1.len() == self.bands.len()
    }

    /// Every `stride`-th band, and where its nodes stand among those of the whole.
    pub(crate) fn every(&self, stride: usize) -> (Self, Vec<usize>) {
        let places: Vec<Range<usize>> = (0..self.len()).step_by(stride.max(1)).map(|q| q..q + 1).collect();
        self.chosen(&places)
    }

    /// Runs of neighbouring bands (rising, within the whole), each joined to one, and where their nodes stand among
    /// those of the whole.
    pub(crate) fn chosen(&self, runs: &[Range<usize>]) -> (Self, Vec<usize>) {
        let mut kept = Self {
            bands: Vec::new(),
            shapes: Vec::new(),
            nodes_cm1: Vec::new(),
            weights_cm1: Vec::new(),
            first_node: vec![0],
        };
        let mut places = Vec::new();
        for run in runs {
            let (band, shape) = match (&self.bands[run.clone()], &self.shapes[run.clone()]) {
                ([band], [shape]) => (band.clone(), shape.clone()),
                (bands, _) => (joined(bands), Shape::TopHat),
            };
            let nodes = self.first_node[run.start]..self.first_node[run.end];
            kept.bands.push(band);
            kept.shapes.push(shape);
            kept.nodes_cm1.extend_from_slice(&self.nodes_cm1[nodes.clone()]);
            kept.weights_cm1.extend_from_slice(&self.weights_cm1[nodes.clone()]);
            kept.first_node.push(kept.nodes_cm1.len());
            places.extend(nodes);
        }
        (kept, places)
    }

    /// Every `group` neighbouring bands joined to one, the last one of what is left.
    pub(crate) fn merged(&self, group: usize) -> Self {
        let group = group.max(1);
        if group == 1 {
            return self.clone();
        }
        let bands: Vec<Band> = self.bands.chunks(group).map(joined).collect();
        let mut first_node: Vec<usize> = self.first_node.iter().copied().step_by(group).collect();
        if first_node.len() == bands.len() {
            first_node.push(self.nodes_cm1.len());
        }
        Self {
            shapes: vec![Shape::TopHat; bands.len()],
            bands,
            nodes_cm1: self.nodes_cm1.clone(),
            weights_cm1: self.weights_cm1.clone(),
            first_node,
        }
    }

    /// Weight of each node, cm⁻¹.
    pub(crate) fn weights_cm1(&self) -> &[f64] {
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

/// What spans some bands.
fn joined(parts: &[Band]) -> Band {
    let low_cm1 = parts.iter().map(|band| band.low_cm1).fold(f64::INFINITY, f64::min);
    let high_cm1 = parts.iter().map(|band| band.high_cm1).fold(0.0, f64::max);
    Band { center_cm1: 0.5 * (low_cm1 + high_cm1), low_cm1, high_cm1, name: None }
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

fn steps(start: f64, stop: f64, step: f64, unit: &'static str) -> Result<usize> {
    check::positive("start of the bands", start, unit)?;
    check::positive("stop of the bands", stop, unit)?;
    check::positive("step of the bands", step, unit)?;
    if stop < start {
        return Err(Error::out_of_range(
            "stop of the bands",
            stop,
            unit,
            format!("at or above the start, {start}"),
        ));
    }
    // The last band is kept when rounding alone puts it beyond the stop.
    let count = ((stop - start) / step * (1.0 + 4.0 * f64::EPSILON)).floor() + 1.0;
    if count > MAX_NODES {
        return Err(Error::out_of_range("number of bands", count, "", "below 10^7"));
    }
    Ok(count as usize)
}

pub(super) fn distinct(ascending: impl Iterator<Item = f64>, what: &str) -> Result<()> {
    let mut last = f64::NAN;
    for value in ascending {
        if value == last {
            return Err(Error::malformed(
                format!("wavenumber {value} cm^-1 comes twice in {what}"),
                "keep one of the rows",
            ));
        }
        last = value;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_bands_are_536() {
        let bands = Bands::uniform(715.0, 1250.0, 1.0).unwrap();
        assert_eq!((bands.len(), bands.range_cm1()), (536, (715.0, 1250.0)));
        assert!(bands.widths_cm1().iter().all(|&width| width == 1.0));
    }

    #[test]
    fn steps_that_are_no_binary_fractions_keep_their_last_band() {
        assert_eq!(Bands::uniform(700.0, 1300.0, 0.1).unwrap().len(), 6001);
    }

    #[test]
    fn wavelength_bands_tile_the_wavenumber_axis() {
        let bands = Bands::uniform_wavelength(8.0, 14.0, 0.05).unwrap();
        for pair in bands.bands().windows(2) {
            // Widths are formed around 10⁴/λ, which is not the mid-point; the total must still fit.
            assert!(pair[0].center_cm1 < pair[1].center_cm1);
        }
        let total: f64 = bands.widths_cm1().iter().sum();
        let exact = 1e4 / 7.975 - 1e4 / 14.025;
        assert!((total / exact - 1.0).abs() < 1e-13, "{total} {exact}");
    }

    #[test]
    fn row_order_does_not_matter_and_twins_are_refused() {
        let a = Bands::from_centers(&[900.0, 800.0, 850.0]).unwrap();
        assert_eq!(a, Bands::from_centers(&[800.0, 850.0, 900.0]).unwrap());
        assert_eq!(a.widths_cm1(), [50.0; 3]);
        assert!(Bands::from_centers(&[800.0, 800.0]).is_err());
        assert!(Bands::from_centers(&[800.0]).is_err());
    }

    #[test]
    fn a_triangular_filter_passes_half_its_width() {
        let filter = FilterCurve::new("f", vec![(1000.0, 1.0), (990.0, 0.0), (1010.0, 0.0)]).unwrap();
        let bands = Bands::from_filters(vec![filter]).unwrap();
        // Midpoint nodes are exact for a function that is linear between them.
        assert!((bands.widths_cm1()[0] - 10.0).abs() < 1e-12);
        assert!((bands.bands()[0].center_cm1 - 1000.0).abs() < 1e-9);
    }
}
