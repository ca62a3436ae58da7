//! What a figure of curves consists of, as plain data.
//!
//! Positions are in the units of the axes they are drawn against; the figure attaches no meaning to them.

use super::axis::Axis;
use hadar::{Error, Result};

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Style {
    /// A line through the points; gaps where a number is missing.
    #[default]
    Line,
    /// A dashed line.
    Dashed,
    /// A dotted line.
    Dotted,
    /// Unconnected points, whose shape goes with the colour.
    Points,
    /// Points joined by a line.
    Marked,
}

/// Numbers drawn as one curve, with one entry in the legend.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Legend entry; none where empty.
    pub label: String,
    /// Horizontal positions.
    pub x: Vec<f64>,
    /// Vertical positions, as many.
    pub y: Vec<f64>,
    /// Line or points.
    pub style: Style,
    /// Index into the palette; the place among the series of the figure where `None`. Beyond the seven
    /// colours the palette starts again with another dash.
    pub colour: Option<usize>,
    /// Points are white inside.
    pub open: bool,
    /// Points are pale, so that a line of the same colour is seen among them.
    pub pale: bool,
}

impl Series {
    /// A line.
    pub fn line(label: impl Into<String>, x: Vec<f64>, y: Vec<f64>) -> Self {
        Self { label: label.into(), x, y, style: Style::Line, colour: None, open: false, pale: false }
    }

    /// Unconnected points.
    pub fn points(label: impl Into<String>, x: Vec<f64>, y: Vec<f64>) -> Self {
        Self { style: Style::Points, ..Self::line(label, x, y) }
    }

    /// Chooses the colour by its index in the palette.
    #[must_use]
    pub fn colour(mut self, index: usize) -> Self {
        self.colour = Some(index);
        self
    }

    /// Draws points white inside.
    #[must_use]
    pub fn open(mut self) -> Self {
        self.open = true;
        self
    }

    /// Draws points in a pale colour.
    #[must_use]
    pub fn pale(mut self) -> Self {
        self.pale = true;
        self
    }

    /// Chooses line, dashes, dots or points.
    #[must_use]
    pub fn style(mut self, style: Style) -> Self {
        self.style = style;
        self
    }
}

/// The area between two curves, shaded: a noise of ± one standard deviation, say.
#[derive(Debug, Clone, PartialEq)]
pub struct Band {
    /// Legend entry; none where empty.
    pub label: String,
    /// Horizontal positions.
    pub x: Vec<f64>,
    /// One edge.
    pub low: Vec<f64>,
    /// The other edge.
    pub high: Vec<f64>,
    /// Index into the palette; grey where `None`.
    pub colour: Option<usize>,
}

impl Band {
    /// A grey band.
    pub fn new(label: impl Into<String>, x: Vec<f64>, low: Vec<f64>, high: Vec<f64>) -> Self {
        Self { label: label.into(), x, low, high, colour: None }
    }

    /// Chooses the colour by its index in the palette.
    #[must_use]
    pub fn colour(mut self, index: usize) -> Self {
        self.colour = Some(index);
        self
    }
}

/// A point with its label beside it. Not drawn where outside of the axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Marker {
    /// What is printed beside the point.
    pub label: String,
    /// Horizontal position.
    pub x: f64,
    /// Vertical position.
    pub y: f64,
}

impl Marker {
    /// A labelled point.
    pub fn new(label: impl Into<String>, x: f64, y: f64) -> Self {
        Self { label: label.into(), x, y }
    }
}

/// A straight line across the panel, with its label along it. Not drawn where outside of the axes.
#[derive(Debug, Clone, PartialEq)]
pub enum Rule {
    /// At one value of the vertical axis.
    Horizontal {
        /// Where.
        y: f64,
        /// What is printed along it; nothing where empty.
        label: String,
    },
    /// At one value of the horizontal axis.
    Vertical {
        /// Where.
        x: f64,
        /// What is printed along it; nothing where empty.
        label: String,
    },
}

impl Rule {
    /// A horizontal line.
    pub fn horizontal(y: f64, label: impl Into<String>) -> Self {
        Self::Horizontal { y, label: label.into() }
    }

    /// A vertical line.
    pub fn vertical(x: f64, label: impl Into<String>) -> Self {
        Self::Vertical { x, label: label.into() }
    }
}

/// A vertical axis and all that is drawn against it.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// The vertical axis.
    pub y: Axis,
    /// Curves.
    pub series: Vec<Series>,
    /// Shaded areas, below the curves.
    pub bands: Vec<Band>,
    /// Labelled points, above the curves.
    pub markers: Vec<Marker>,
    /// Reference lines, below the curves.
    pub rules: Vec<Rule>,
}

impl Panel {
    /// An empty panel.
    pub fn new(y: Axis) -> Self {
        Self { y, series: vec![], bands: vec![], markers: vec![], rules: vec![] }
    }

    /// Adds a curve.
    #[must_use]
    pub fn series(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// Adds a shaded area.
    #[must_use]
    pub fn band(mut self, band: Band) -> Self {
        self.bands.push(band);
        self
    }

    /// Adds a labelled point.
    #[must_use]
    pub fn marker(mut self, marker: Marker) -> Self {
        self.markers.push(marker);
        self
    }

    /// Adds a reference line.
    #[must_use]
    pub fn rule(mut self, rule: Rule) -> Self {
        self.rules.push(rule);
        self
    }

    pub(super) fn check(&self) -> Result<()> {
        let same = |what: &str, label: &str, found: usize, expected: usize| {
            if found == expected {
                return Ok(());
            }
            Err(Error::Length { what: format!("{what} `{label}`"), found, expected })
        };
        for series in &self.series {
            same("vertical positions of the series", &series.label, series.y.len(), series.x.len())?;
        }
        for band in &self.bands {
            same("lower edge of the band", &band.label, band.low.len(), band.x.len())?;
            same("upper edge of the band", &band.label, band.high.len(), band.x.len())?;
        }
        Ok(())
    }
}

/// Curves over panels that share the horizontal axis.
#[derive(Debug, Clone, PartialEq)]
pub struct LineFigure {
    /// One line that says what is shown; wraps when long.
    pub title: String,
    /// Small print under the title; wraps when long, nothing where empty.
    pub subtitle: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The panel.
    pub panel: Panel,
    /// Lower panels: a single one of less height, e.g. for the difference of two nearly identical curves.
    pub lower: Vec<Panel>,
}

impl LineFigure {
    /// An empty figure.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        Self { title: title.into(), subtitle: String::new(), x, panel: Panel::new(y), lower: Vec::new() }
    }

    /// A figure of panels over each other; of none an empty one.
    pub fn over(title: impl Into<String>, x: Axis, panels: Vec<Panel>) -> Self {
        let mut panels = panels.into_iter();
        let panel = panels.next().unwrap_or_else(|| Panel::new(Axis::linear("")));
        Self { title: title.into(), subtitle: String::new(), x, panel, lower: panels.collect() }
    }

    /// Sets the small print under the title.
    #[must_use]
    pub fn subtitle(mut self, subtitle: impl Into<String>) -> Self {
        self.subtitle = subtitle.into();
        self
    }

    /// Adds a curve.
    #[must_use]
    pub fn series(mut self, series: Series) -> Self {
        self.panel.series.push(series);
        self
    }

    /// Adds a shaded area.
    #[must_use]
    pub fn band(mut self, band: Band) -> Self {
        self.panel.bands.push(band);
        self
    }

    /// Adds a labelled point.
    #[must_use]
    pub fn marker(mut self, marker: Marker) -> Self {
        self.panel.markers.push(marker);
        self
    }

    /// Adds a reference line.
    #[must_use]
    pub fn rule(mut self, rule: Rule) -> Self {
        self.panel.rules.push(rule);
        self
    }

    /// Adds a lower panel that shares the horizontal axis. Of several, all are low: the titles of their vertical axes have room for a few words.
    #[must_use]
    pub fn lower(mut self, panel: Panel) -> Self {
        self.lower.push(panel);
        self
    }
}
