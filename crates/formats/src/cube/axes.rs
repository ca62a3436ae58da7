//! Which axis of an array is which.

use hadar::cube::Shape;
use hadar::error::{Error, Result};
use std::fmt;

/// What an axis counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Axis {
    Rows,
    Columns,
    Bands,
}

/// What dimensions are called, in lower case.
const NAMES: [(Axis, &[&str]); 3] = [
    (
        Axis::Bands,
        &[
            "band",
            "bands",
            "wavelength",
            "wavelengths",
            "wavenumber",
            "wavenumbers",
            "lambda",
            "frequency",
            "wl",
            "nu",
            "channel",
            "channels",
            "spectral",
        ],
    ),
    (Axis::Rows, &["row", "rows", "y", "line", "lines", "lat", "latitude"]),
    (Axis::Columns, &["column", "columns", "x", "sample", "samples", "lon", "longitude"]),
];

/// Names of the dimensions of bands, rows and columns, in lower case.
#[must_use]
pub fn dimension_names() -> [&'static [&'static str]; 3] {
    NAMES.map(|(_, names)| names)
}

impl Axis {
    const ALL: [Self; 3] = [Self::Rows, Self::Columns, Self::Bands];

    const fn name(self) -> &'static str {
        match self {
            Self::Rows => "rows",
            Self::Columns => "columns",
            Self::Bands => "bands",
        }
    }

    const fn place(self) -> usize {
        self as usize
    }
}

/// The axes of an array in the order of its dimensions, as NumPy or MATLAB say them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Axes([Axis; 3]);

impl Default for Axes {
    fn default() -> Self {
        Self(Axis::ALL)
    }
}

impl Axes {
    /// `[band][row][column]`, as a file of images.
    pub(super) const IMAGES: Self = Self([Axis::Bands, Axis::Rows, Axis::Columns]);
    /// `[row][band][column]`.
    pub(super) const LINES: Self = Self([Axis::Rows, Axis::Bands, Axis::Columns]);

    /// With the bands on one of the dimensions, the rows before the columns.
    pub(super) const fn with_bands_on(dimension: usize) -> Self {
        match dimension {
            0 => Self::IMAGES,
            1 => Self::LINES,
            _ => Self(Axis::ALL),
        }
    }

    /// Axes from their names.
    ///
    /// # Errors
    /// Another name, one that is missing or there twice.
    ///
    /// ```
    /// use hadar_formats::cube::Axes;
    /// assert_eq!(Axes::named("bands, rows, columns")?.to_string(), "bands,rows,columns");
    /// assert_eq!(Axes::named("rows,columns,bands")?, Axes::default());
    /// assert!(Axes::named("bands,rows,rows").is_err());
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn named(text: &str) -> Result<Self> {
        let axes = text
            .split(',')
            .map(|name| Axis::ALL.into_iter().find(|axis| axis.name() == name.trim()))
            .collect::<Option<Vec<Axis>>>();
        match axes.as_deref() {
            Some(&[a, b, c]) if a != b && b != c && a != c => Ok(Self([a, b, c])),
            _ => Err(Error::malformed(
                format!("`{}` are no axes of a cube", text.escape_debug()),
                "write \"rows,columns,bands\", \"bands,rows,columns\" or another order of the three",
            )),
        }
    }

    /// Axes from what their dimensions are called, outermost first: one of them has to be that of the bands; rows come before columns
    /// unless their names say otherwise.
    pub(super) fn of_dimensions(names: [&str; 3]) -> Option<Self> {
        let axis = |name: &str| {
            let name = name.to_lowercase();
            NAMES.iter().find(|(_, own)| own.contains(&name.as_str())).map(|(axis, _)| *axis)
        };
        let found = names.map(axis);
        let bands = found.iter().position(|axis| *axis == Some(Axis::Bands))?;
        let mut others = found.iter().enumerate().filter(|(place, _)| *place != bands).map(|(_, axis)| *axis);
        let turned = match (others.next().flatten(), others.next().flatten()) {
            // Two axes of bands, or of rows.
            (Some(a), Some(b)) if a == b => return None,
            (Some(Axis::Bands), _) | (_, Some(Axis::Bands)) => return None,
            (Some(Axis::Columns), _) | (_, Some(Axis::Rows)) => true,
            _ => false,
        };
        let mut others =
            if turned { [Axis::Columns, Axis::Rows] } else { [Axis::Rows, Axis::Columns] }.into_iter();
        let mut axes = [Axis::Bands; 3];
        for (place, axis) in axes.iter_mut().enumerate() {
            if place != bands {
                *axis = others.next()?;
            }
        }
        Some(Self(axes))
    }

    /// The shape of an array of these dimensions; one of two has no axis of bands.
    pub(super) fn shape(self, dimensions: &[usize]) -> Result<Shape> {
        let dimensions = match *dimensions {
            [a, b] if self == Self::default() => [a, b, 1],
            [_, _] => {
                let found = format!("axes = \"{self}\" of an array of two dimensions");
                return Err(Error::malformed(found, "leave axes out: they are rows and columns of one band"));
            }
            [a, b, c] => [a, b, c],
            ref other => {
                let found = other.len();
                return Err(Error::malformed(
                    format!("the array has {found} dimension{}", if found == 1 { "" } else { "s" }),
                    match found {
                        1 => "give [row][column][band]; a spectrum as [1][1][band]",
                        _ => "give [row][column][band], or [row][column] for one band",
                    },
                ));
            }
        };
        let mut sides = [0; 3];
        self.0.iter().zip(dimensions).for_each(|(axis, side)| sides[axis.place()] = side);
        Shape::new(sides[0], sides[1], sides[2])
    }

    /// The other way round, as an array is stored of which the first index runs fastest.
    pub(super) fn reversed(self) -> Self {
        let Self([a, b, c]) = self;
        Self([c, b, a])
    }

    /// Lengths of the axes, outermost first.
    pub(super) fn sides(self, shape: Shape) -> [usize; 3] {
        self.0.map(|axis| match axis {
            Axis::Rows => shape.rows(),
            Axis::Columns => shape.columns(),
            Axis::Bands => shape.bands(),
        })
    }

    /// The axis that runs slowest.
    pub(super) fn outermost(self) -> Axis {
        self.0[0]
    }

    /// The place of the rows, 0 where they are outermost.
    pub(super) fn place_of_rows(self) -> usize {
        self.0.iter().position(|axis| *axis == Axis::Rows).unwrap_or(0)
    }

    /// How many samples apart neighbours are along rows, columns and bands, in an array of this shape.
    pub(super) fn strides(self, shape: Shape) -> [usize; 3] {
        let [_, middle, inner] = self.sides(shape);
        let mut strides = [0; 3];
        self.0
            .iter()
            .zip([middle * inner, inner, 1])
            .for_each(|(axis, stride)| strides[axis.place()] = stride);
        strides
    }
}

impl fmt::Display for Axes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.map(Axis::name).join(","))
    }
}

impl serde::Serialize for Axes {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
