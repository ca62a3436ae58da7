//! Figures: one description, drawn as SVG and as PNG with the same look.
//!
//! A [`Figure`] is plain data: titles, axes, numbers. [`render_svg`] and [`render_png`] lay it out
//! once (text measured with the embedded font, so that nothing is clipped or overlaps) into a list of
//! marks, which two painters draw. White background, one font
//! (DejaVu Sans), colours that the colour-blind can tell apart (Okabe and Ito, *Color Universal
//! Design*, 2008), labels beside the ends of the curves, else legends outside the data.
//!
//! A number that cannot be drawn (NaN, infinite, zero or below on a logarithmic axis) is a gap in a
//! curve and a cell without value in a map, never an error. Beside a name it is an arrow at the edge of the
//! axis, or the words "no value".
//!
//! ```
//! use hadar_report::plot::{Axis, Figure, LineFigure, Series, render_svg};
//! let figure = LineFigure::new("Two materials", Axis::linear("wavenumber (cm⁻¹)"), Axis::linear("emissivity"))
//!     .series(Series::line("skin", vec![715.0, 1250.0], vec![0.97, 0.98]).colour(0))
//!     .series(Series::line("aluminium", vec![715.0, 1250.0], vec![0.2, 0.1]).colour(1));
//! let svg = render_svg(&Figure::from(figure))?;
//! assert!(svg.starts_with("<svg"));
//! # Ok::<(), hadar::Error>(())
//! ```

mod axis;
mod canvas;
mod colour;
mod contour;
mod direct;
mod dots;
mod encode;
mod figure;
mod frame;
mod geometry;
mod grid;
mod heat;
mod heatmap;
mod label;
mod legend;
mod lines;
mod mask;
mod matrix;
mod named;
mod names;
mod pictures;
mod png;
mod readings;
mod scene;
mod svg;
mod symbol;
mod text;
mod ticks;

pub use axis::{Axis, Scale, Secondary};
pub use figure::{Band, LineFigure, Marker, Panel, Rule, Series, Style};
pub use heatmap::HeatMap;
pub use matrix::{Matrix, Threshold};
pub use named::{NamedSeries, NamedValues};
pub use pictures::{Painted, Picture, Pictures, Rgb};
pub use png::PutRows;

use hadar::Result;

/// Colour of the area with this index, in pictures of categories.
#[must_use]
pub fn categorical(index: usize) -> Rgb {
    colour::area(index)
}

/// A number as it is written in pictures: three digits, powers of ten with superscripts.
#[must_use]
pub fn number(value: f64) -> String {
    ticks::label(value)
}

/// Anything that can be drawn.
#[derive(Debug, Clone)]
pub enum Figure {
    /// Curves and points over one or several panels.
    Line(LineFigure),
    /// A quantity over a plane, in colours.
    HeatMap(HeatMap),
    /// A quantity for every pair of names, in colours.
    Matrix(Matrix),
    /// Quantities of every name, as points on one axis.
    Named(NamedValues),
    /// Images side by side.
    Pictures(Pictures),
}

impl Figure {
    /// Whether it is made of images, which no curves, letters or cells describe: it has no file of its own as SVG.
    #[must_use]
    pub fn is_image(&self) -> bool {
        match self {
            Self::Pictures(_) => true,
            Self::Matrix(matrix) => grid::is_image(matrix),
            Self::Line(_) | Self::HeatMap(_) | Self::Named(_) => false,
        }
    }

    /// The small print under the title; nothing where empty.
    #[must_use]
    pub fn subtitle(&self) -> &str {
        match self {
            Self::Line(figure) => &figure.subtitle,
            Self::HeatMap(figure) => &figure.subtitle,
            Self::Matrix(figure) => &figure.subtitle,
            Self::Named(figure) => &figure.subtitle,
            Self::Pictures(figure) => &figure.subtitle,
        }
    }
}

impl From<LineFigure> for Figure {
    fn from(figure: LineFigure) -> Self {
        Self::Line(figure)
    }
}

impl From<HeatMap> for Figure {
    fn from(figure: HeatMap) -> Self {
        Self::HeatMap(figure)
    }
}

impl From<Matrix> for Figure {
    fn from(figure: Matrix) -> Self {
        Self::Matrix(figure)
    }
}

impl From<Pictures> for Figure {
    fn from(figure: Pictures) -> Self {
        Self::Pictures(figure)
    }
}

impl From<NamedValues> for Figure {
    fn from(figure: NamedValues) -> Self {
        Self::Named(figure)
    }
}

/// The figure as an SVG document, 800 px wide.
///
/// # Errors
/// [`hadar::Error::Length`] where lists that belong together differ in length, and
/// [`hadar::Error::Malformed`] where the cells of a heat map or the groups of a matrix are not in rising order.
pub fn render_svg(figure: &Figure) -> Result<String> {
    svg::paint(&scene(figure)?)
}

/// The figure as a PNG file, 1200 pixels wide.
///
/// # Errors
/// As [`render_svg`].
pub fn render_png(figure: &Figure) -> Result<Vec<u8>> {
    png::paint(&scene(figure)?)
}

/// An image of so many rows and columns as a PNG file, whose pixels `paint` hands on row after row, whole rows at a time.
///
/// # Errors
/// An image of no pixels; more or fewer pixels than it has; what `paint` meets.
pub fn image_png(
    to: impl std::io::Write,
    size: [usize; 2],
    paint: &mut dyn FnMut(&mut PutRows<'_>) -> Result<()>,
) -> Result<()> {
    png::by_rows(to, size, paint)
}

/// A figure in both forms.
pub(crate) struct Drawn {
    /// Empty where it is not wanted.
    pub(crate) svg: String,
    pub(crate) png: Vec<u8>,
}

/// Both, laid out once.
///
/// # Errors
/// As [`render_svg`].
pub(crate) fn render(figure: &Figure, with_svg: bool) -> Result<Drawn> {
    let scene = scene(figure)?;
    // The longer one first; rasters of the other are shared out.
    let svg = || if with_svg { svg::paint(&scene) } else { Ok(String::new()) };
    let (png, svg) = rayon::join(|| png::paint(&scene), svg);
    Ok(Drawn { svg: svg?, png: png? })
}

fn scene(figure: &Figure) -> Result<scene::Scene> {
    match figure {
        Figure::Line(figure) => lines::scene(figure),
        Figure::HeatMap(map) => heat::scene(map),
        Figure::Matrix(matrix) => grid::scene(matrix),
        Figure::Named(named) => dots::scene(named),
        Figure::Pictures(figure) => pictures::scene(figure),
    }
}
