//! Bands from grids, rows, centres, ranges and filter curves.

use super::{Band, Bands, Shape, edges, transmittance};
use crate::error::{Error, Result, check};
use crate::order;
use crate::spectrum::FilterCurve;
use crate::spectrum::rows::distinct;

/// Widest stretch of a range or filter that one midpoint node may stand for, cm⁻¹: the paper's step.
const NODE_SPACING_CM1: f64 = 1.0;
/// More bands or nodes than this are taken for a slip of the pen.
const MAX_NODES: f64 = 1e7;

impl Bands {
    /// The same bands with nodes and edges so many cm⁻¹ higher, of the same weights; a filter's own curve stays where it is.
    ///
    /// # Errors
    /// A shift with which a node is not above 0.
    pub fn shifted(&self, by_cm1: f64) -> Result<Self> {
        let mut bands = self.clone();
        for band in &mut bands.bands {
            for edge in [&mut band.center_cm1, &mut band.low_cm1, &mut band.high_cm1] {
                *edge += by_cm1;
            }
        }
        for node in &mut bands.nodes_cm1 {
            *node += by_cm1;
            check::positive("wavenumber", *node, "cm^-1")?;
        }
        Ok(bands)
    }

    /// Bands of width `step` centred at start, start + step, … up to stop (cm⁻¹), one node each.
    ///
    /// # Errors
    /// Values that are not positive, stop below start, or more than 10⁷ bands.
    pub fn uniform(start_cm1: f64, stop_cm1: f64, step_cm1: f64) -> Result<Self> {
        let centers = Self::uniform_centers(start_cm1, stop_cm1, step_cm1)?;
        Self::from_rows(centers.into_iter().map(|center| (center, step_cm1)))
    }

    /// The centres of such bands, cm⁻¹.
    pub(crate) fn uniform_centers(start_cm1: f64, stop_cm1: f64, step_cm1: f64) -> Result<Vec<f64>> {
        let count = steps(start_cm1, stop_cm1, step_cm1, "cm^-1")?;
        Ok((0..count).map(|i| (i as f64).mul_add(step_cm1, start_cm1)).collect())
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
        let center_um = |i: usize| (i as f64).mul_add(step_um, start_um);
        let mut bands = Self::from_rows((0..count).map(|i| {
            // 10⁴/(λ − δ) − 10⁴/(λ + δ) with δ half the step, without the subtraction.
            let width = 1e4 * step_um / ((center_um(i) - 0.5 * step_um) * (center_um(i) + 0.5 * step_um));
            (1e4 / center_um(i), width)
        }))?;
        // The centre in wavelength is not the middle in wavenumber, and rows are taken for symmetric.
        for (i, band) in bands.bands.iter_mut().rev().enumerate() {
            band.low_cm1 = 1e4 / (center_um(i) + 0.5 * step_um);
            band.high_cm1 = 1e4 / (center_um(i) - 0.5 * step_um);
        }
        Ok(bands)
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
            check::finite("upper edge of a band", center + 0.5 * width, "cm^-1")?;
        }
        order::ascending(&mut rows, |a| a.0);
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
        order::ascending(&mut filters, |a| a.range_cm1().0);
        let shaped = filters.into_iter().map(|filter| {
            let (low, high) = filter.range_cm1();
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
            let Band { low_cm1, high_cm1, name, .. } = &bands.bands[q];
            let quantity = || format!("width that filter `{}` lets through", name.as_deref().unwrap_or(""));
            // Transmittances next to 0 over a width next to 0.
            check::positive("", weight, "").and(check::positive("", moment, "")).map_err(|_| {
                Error::out_of_range(quantity(), weight, "cm^-1", "a number above 0 that can be divided by")
            })?;
            bands.bands[q].center_cm1 = (moment / weight).clamp(*low_cm1, *high_cm1);
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
                let node = |i: usize| (i as f64 + 0.5).mul_add(width, piece[0]);
                nodes.extend((0..count as usize).map(node));
                match shape {
                    Shape::TopHat => weights.resize(nodes.len(), width),
                    Shape::Filter(_) => {
                        let new = nodes.get(weights.len()..).unwrap_or_default();
                        weights.extend(new.iter().map(|node| width * transmittance(shape, *node)));
                    }
                }
            }
            first_node.push(nodes.len());
        }
        let (bands, shapes) = shaped.into_iter().unzip();
        Ok(Self { bands, shapes, nodes_cm1: nodes, weights_cm1: weights, first_node })
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
            assert!(pair[0].center_cm1 < pair[1].center_cm1);
            assert!((pair[0].high_cm1 / pair[1].low_cm1 - 1.0).abs() < 1e-14);
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
