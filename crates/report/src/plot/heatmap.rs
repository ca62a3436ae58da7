//! What a heat map consists of, as plain data.

use super::axis::{Axis, Scale, transform};
use super::figure::Marker;
use hadar::{Error, Result};

/// A quantity over a plane: colours, contour lines, markers, a colour bar.
///
/// Cells are given by the positions of their centres, between which colours are interpolated; they meet half-way (on the scale of the axis). A
/// value that is not finite, or zero or below on a logarithmic colour scale, is drawn as "no value".
#[derive(Debug, Clone, PartialEq)]
pub struct HeatMap {
    /// One line that says what is shown; wraps when long.
    pub title: String,
    /// Small print under the title; wraps when long, nothing where empty.
    pub subtitle: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// The colour axis: title with unit, scale, range; colours of values outside the range are those at
    /// its ends.
    pub colour: Axis,
    /// Horizontal positions of the centres of the columns, rising.
    pub columns: Vec<f64>,
    /// Vertical positions of the centres of the rows, rising.
    pub rows: Vec<f64>,
    /// Values, row after row: the one of row i and column j is at `i * columns.len() + j`.
    pub values: Vec<f64>,
    /// What a cell without value means, for the legend.
    pub no_value: String,
    /// Values at which to draw contour lines.
    pub contours: Vec<f64>,
    /// Labelled points.
    pub markers: Vec<Marker>,
    /// Values marked beside the colour bar, with what the legend says of them.
    pub marks: Vec<(f64, String)>,
}

impl HeatMap {
    /// A map without contours or markers.
    pub fn new(
        title: impl Into<String>,
        (x, columns): (Axis, Vec<f64>),
        (y, rows): (Axis, Vec<f64>),
        (colour, values): (Axis, Vec<f64>),
    ) -> Self {
        Self {
            title: title.into(),
            subtitle: String::new(),
            x,
            y,
            colour,
            columns,
            rows,
            values,
            no_value: "no value".to_owned(),
            contours: vec![],
            markers: vec![],
            marks: vec![],
        }
    }

    /// Sets the small print under the title.
    #[must_use]
    pub fn subtitle(mut self, subtitle: impl Into<String>) -> Self {
        self.subtitle = subtitle.into();
        self
    }

    /// Says what a cell without value means.
    #[must_use]
    pub fn no_value(mut self, meaning: impl Into<String>) -> Self {
        self.no_value = meaning.into();
        self
    }

    /// Sets the values at which to draw contour lines.
    #[must_use]
    pub fn contours(mut self, levels: Vec<f64>) -> Self {
        self.contours = levels;
        self
    }

    /// Marks a value beside the colour bar.
    #[must_use]
    pub fn mark(mut self, value: f64, label: impl Into<String>) -> Self {
        self.marks.push((value, label.into()));
        self
    }

    /// Adds a labelled point.
    #[must_use]
    pub fn marker(mut self, marker: Marker) -> Self {
        self.markers.push(marker);
        self
    }

    pub(super) fn check(&self) -> Result<()> {
        let expected = self.columns.len().saturating_mul(self.rows.len());
        if self.values.len() != expected {
            let what = format!("cells of the heat map `{}`", self.title);
            return Err(Error::Length { what, found: self.values.len(), expected });
        }
        rising("columns", &self.columns, self.x.scale)?;
        rising("rows", &self.rows, self.y.scale)
    }
}

fn rising(what: &str, centres: &[f64], scale: Scale) -> Result<()> {
    let mut before = f64::NEG_INFINITY;
    for &centre in centres {
        match transform(scale, centre) {
            Some(t) if t > before => before = t,
            _ => {
                return Err(Error::malformed(
                    format!("the centres of the {what} of a heat map do not rise at {centre}"),
                    "give finite numbers in rising order (above zero on a logarithmic axis)",
                ));
            }
        }
    }
    Ok(())
}

/// The edges of cells with these centres, on the transformed scale: one more than there are cells.
pub(super) fn edges(centres: &[f64], scale: Scale) -> Vec<f64> {
    let t: Vec<f64> = centres.iter().filter_map(|&centre| transform(scale, centre)).collect();
    let (Some(&first), Some(&last)) = (t.first(), t.last()) else { return vec![] };
    let middles: Vec<f64> = t.iter().zip(t.iter().skip(1)).map(|(a, b)| a + (b - a) / 2.0).collect();
    // The outer cells are as wide outwards as inwards; a lone cell gets a width from its own size.
    let lone = if first == 0.0 || scale == Scale::Log { 0.5 } else { 0.5 * first.abs() };
    let low = middles.first().map_or(lone, |middle| middle - first);
    let high = middles.last().map_or(lone, |middle| last - middle);
    std::iter::once(first - low).chain(middles).chain(std::iter::once(last + high)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_meet_half_way_on_the_scale_of_the_axis() {
        assert_eq!(edges(&[1.0, 2.0, 4.0], Scale::Linear), [0.5, 1.5, 3.0, 5.0]);
        assert_eq!(edges(&[1.0, 100.0], Scale::Log), [-1.0, 1.0, 3.0]);
        assert_eq!(edges(&[0.0], Scale::Linear), [-0.5, 0.5]);
    }

    #[test]
    fn a_wrong_number_of_cells_and_unordered_centres_are_errors() {
        let map = |columns, values| {
            let axis = Axis::linear("");
            HeatMap::new("map", (axis.clone(), columns), (axis.clone(), vec![0.0]), (axis, values)).check()
        };
        assert!(map(vec![1.0, 2.0], vec![0.0; 2]).is_ok());
        assert!(matches!(map(vec![1.0, 2.0], vec![0.0; 3]), Err(Error::Length { expected: 2, .. })));
        assert!(map(vec![2.0, 1.0], vec![0.0; 2]).is_err());
        assert!(map(vec![1.0, f64::NAN], vec![0.0; 2]).is_err());
    }
}
