//! What a figure of named values consists of, as plain data.

use super::axis::Axis;
use hadar::{Error, Result};

/// One value for each name, with one symbol and colour.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedSeries {
    /// Legend entry; there is no legend of the series where only one is drawn.
    pub label: String,
    /// A value for each name, in the unit of the axis.
    pub values: Vec<f64>,
    /// Lower and upper end of an interval for each name; no interval where one of the two is NaN.
    pub intervals: Option<(Vec<f64>, Vec<f64>)>,
    /// Index into the palette; the place among the series of the figure where `None`.
    pub colour: Option<usize>,
}

impl NamedSeries {
    /// Values without intervals.
    pub fn new(label: impl Into<String>, values: Vec<f64>) -> Self {
        Self { label: label.into(), values, intervals: None, colour: None }
    }

    /// Adds an interval for each value.
    #[must_use]
    pub fn intervals(mut self, low: Vec<f64>, high: Vec<f64>) -> Self {
        self.intervals = Some((low, high));
        self
    }

    /// Chooses the colour by its index in the palette.
    #[must_use]
    pub fn colour(mut self, index: usize) -> Self {
        self.colour = Some(index);
        self
    }

    /// Value and ends of the interval for the name with this index; NaN where there is none.
    pub(super) fn at(&self, row: usize) -> (f64, Option<(f64, f64)>) {
        let value = self.values.get(row).copied().unwrap_or(f64::NAN);
        let interval = self.intervals.as_ref().and_then(|(low, high)| {
            let (low, high) = (*low.get(row)?, *high.get(row)?);
            (!low.is_nan() && !high.is_nan()).then_some((low, high))
        });
        (value, interval)
    }
}

/// One or more quantities for each of many names, such as the distance of each material from its nearest
/// alternative: a row for each name, the first at the top, with points on a common horizontal axis.
///
/// What cannot be drawn at its place is an arrow at that edge of the axis, explained in the legend: values of
/// zero or below on a logarithmic axis, infinite ones, those outside of a stated range. A row where
/// every value is NaN says so.
///
/// ```
/// use hadar_report::plot::{Axis, NamedSeries, NamedValues, render_svg};
/// let names = vec!["skin".to_owned(), "aluminium".to_owned()];
/// let distances = NamedSeries::new("calibrated", vec![2e-3, 4e-4]).intervals(vec![1e-3, 3e-4], vec![3e-3, 6e-4]);
/// let figure = NamedValues::new("Nearest distance", names, Axis::log("distance d₀ (per √photon)"))
///     .series(distances)
///     .interval_meaning("95 % of the draws")
///     .threshold(6.3e-4, "required: 6.3×10⁻⁴")
///     .below("too alike for the camera");
/// assert!(render_svg(&figure.into())?.contains("aluminium"));
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct NamedValues {
    /// One line that says what is shown; wraps when long.
    pub title: String,
    /// Small print under the title; wraps when long, nothing where empty.
    pub subtitle: String,
    /// Names of the rows, from the top.
    pub names: Vec<String>,
    /// The horizontal axis.
    pub axis: Axis,
    /// Values, one for each name.
    pub series: Vec<NamedSeries>,
    /// The least value that is good enough, in the unit of the axis, and what is printed at its line. Lower
    /// values have open symbols, names that have no other values are grey.
    pub threshold: Option<(f64, String)>,
    /// Which names fail, where more than the threshold decides: their rows are grey and their symbols open.
    pub failing: Option<Vec<bool>>,
    /// Further values of the axis at which lines are drawn, with their legend entries.
    pub lines: Vec<(f64, String)>,
    /// What a value below the threshold means, for the legend.
    pub below: String,
    /// What the intervals are, for the legend; nothing where empty.
    pub interval_meaning: String,
    /// What is printed beside a name without any value.
    pub no_value: String,
}

impl NamedValues {
    /// Names without values.
    pub fn new(title: impl Into<String>, names: Vec<String>, axis: Axis) -> Self {
        Self {
            title: title.into(),
            subtitle: String::new(),
            names,
            axis,
            series: vec![],
            threshold: None,
            failing: None,
            lines: vec![],
            below: "below the threshold".to_owned(),
            interval_meaning: String::new(),
            no_value: "no value".to_owned(),
        }
    }

    /// Sets the small print under the title.
    #[must_use]
    pub fn subtitle(mut self, subtitle: impl Into<String>) -> Self {
        self.subtitle = subtitle.into();
        self
    }

    /// Adds a value for each name.
    #[must_use]
    pub fn series(mut self, series: NamedSeries) -> Self {
        self.series.push(series);
        self
    }

    /// Draws a line at the least value that is good enough, and marks what is below.
    #[must_use]
    pub fn threshold(mut self, value: f64, label: impl Into<String>) -> Self {
        self.threshold = Some((value, label.into()));
        self
    }

    /// Says of every name whether it fails, whatever its values.
    #[must_use]
    pub fn failing(mut self, failing: Vec<bool>) -> Self {
        self.failing = Some(failing);
        self
    }

    /// Draws a further line, that divides nothing.
    #[must_use]
    pub fn line(mut self, value: f64, label: impl Into<String>) -> Self {
        self.lines.push((value, label.into()));
        self
    }

    /// Says what a value below the threshold means.
    #[must_use]
    pub fn below(mut self, meaning: impl Into<String>) -> Self {
        self.below = meaning.into();
        self
    }

    /// Says what the intervals are.
    #[must_use]
    pub fn interval_meaning(mut self, meaning: impl Into<String>) -> Self {
        self.interval_meaning = meaning.into();
        self
    }

    /// Says what a name without any value means.
    #[must_use]
    pub fn no_value(mut self, meaning: impl Into<String>) -> Self {
        self.no_value = meaning.into();
        self
    }

    pub(super) fn check(&self) -> Result<()> {
        let expected = self.names.len();
        if let Some(found) = self.failing.as_ref().map(Vec::len).filter(|found| *found != expected) {
            return Err(Error::Length { what: "names said to fail or not".into(), found, expected });
        }
        for NamedSeries { label, values, intervals, .. } in &self.series {
            let ends = intervals.iter().flat_map(|(low, high)| {
                [("lower ends of the intervals", low), ("upper ends of the intervals", high)]
            });
            for (what, list) in std::iter::once(("values", values)).chain(ends) {
                if list.len() != expected {
                    let what = format!("{what} of the series `{label}`");
                    return Err(Error::Length { what, found: list.len(), expected });
                }
            }
        }
        Ok(())
    }

    /// Whether a value of this name is not good enough.
    pub(super) fn is_below(&self, row: usize, value: f64) -> bool {
        match &self.failing {
            Some(failing) => failing.get(row) == Some(&true),
            None => self.threshold.as_ref().is_some_and(|(least, _)| value < *least),
        }
    }

    /// Whether the name with this index is said to fail, or has values, none of them good enough.
    pub(super) fn fails(&self, row: usize) -> bool {
        if let Some(failing) = &self.failing {
            return failing.get(row) == Some(&true);
        }
        let mut known = self.series.iter().map(|series| series.at(row).0).filter(|value| !value.is_nan());
        let first = known.next();
        first.is_some_and(|value| self.is_below(row, value)) && known.all(|value| self.is_below(row, value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(series: NamedSeries) -> NamedValues {
        NamedValues::new("", vec!["skin".to_owned(), "glass".to_owned()], Axis::log("d")).series(series)
    }

    #[test]
    fn every_list_has_one_number_for_each_name() {
        let series = |count: usize| NamedSeries::new("d", vec![1.0; count]);
        assert!(named(series(2).intervals(vec![0.5; 2], vec![2.0; 2])).check().is_ok());
        for (wrong, message) in [
            (series(3), "values of the series `d`: 3 values where 2 are needed"),
            (
                series(2).intervals(vec![], vec![2.0; 2]),
                "lower ends of the intervals of the series `d`: 0 values where 2 are needed",
            ),
            (
                series(2).intervals(vec![0.5; 2], vec![2.0; 5]),
                "upper ends of the intervals of the series `d`: 5 values where 2 are needed",
            ),
        ] {
            assert_eq!(named(wrong).check().unwrap_err().to_string(), message);
        }
    }

    #[test]
    fn a_name_fails_when_it_has_values_and_all_are_below() {
        let figure = named(NamedSeries::new("a", vec![0.5, f64::NAN]));
        assert!(!figure.fails(0));
        let figure = figure.threshold(1.0, "").series(NamedSeries::new("b", vec![f64::NAN, f64::NAN]));
        assert!(figure.fails(0) && !figure.fails(1) && !figure.fails(2));
        assert!(!figure.clone().series(NamedSeries::new("c", vec![1.0, 1.0])).fails(0));
        // What is said of a name outweighs its values.
        let said = figure.failing(vec![false, true]);
        assert!(!said.fails(0) && said.fails(1) && said.is_below(1, 9.0) && !said.is_below(0, 0.5));
        assert!(said.failing(vec![true]).check().is_err());
    }
}
