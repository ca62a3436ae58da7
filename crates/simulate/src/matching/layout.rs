//! The parts of an image that are needed, in planes `[row][band][column]`, so that no other sample is drawn or
//! copied.

use hadar::cube::{Cube, Rows, Sample, Shape};
use hadar::error::Result;
use hadar::ranging::noise::NoiseVariance;
use std::ops::Range;

/// Which columns of which rows there are.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    shape: Shape,
    first: usize,
    spans: Vec<Span>,
    len: usize,
}

#[derive(Debug, Clone)]
struct Span {
    columns: Range<usize>,
    offset: usize,
}

impl Layout {
    /// All of an image.
    pub(super) fn full(shape: Shape) -> Self {
        Self::around(shape, &[(0..shape.rows(), 0..shape.columns())])
    }

    /// Of every row, all columns from the first to the last that one of the parts (rows, columns) has there. Parts
    /// are cut off at the image.
    pub(super) fn around(shape: Shape, parts: &[(Range<usize>, Range<usize>)]) -> Self {
        let first = parts.iter().map(|(rows, _)| rows.start).min().unwrap_or(0);
        let end = parts.iter().map(|(rows, _)| rows.end.min(shape.rows())).max().unwrap_or(0);
        let mut spans = vec![Span { columns: 0..0, offset: 0 }; end.saturating_sub(first)];
        for (rows, columns) in parts {
            let end = columns.end.min(shape.columns());
            for span in spans.iter_mut().skip(rows.start - first).take(rows.len()) {
                let old = &span.columns;
                span.columns = if old.is_empty() {
                    columns.start.min(end)..end
                } else {
                    old.start.min(columns.start)..old.end.max(end)
                };
            }
        }
        let mut len = 0;
        for span in &mut spans {
            span.offset = len;
            len += span.columns.len() * shape.bands();
        }
        Self { shape, first, spans, len }
    }

    /// Samples.
    pub(super) const fn len(&self) -> usize {
        self.len
    }

    pub(super) const fn shape(&self) -> Shape {
        self.shape
    }

    /// The columns of a row; none where there is nothing.
    pub(super) fn columns(&self, row: usize) -> Range<usize> {
        let span = row.checked_sub(self.first).and_then(|at| self.spans.get(at));
        span.map_or(0..0, |span| span.columns.clone())
    }

    /// Where a row's plane of a band is.
    pub(super) fn plane(&self, row: usize, band: usize) -> Range<usize> {
        let span = row.checked_sub(self.first).and_then(|at| self.spans.get(at));
        let Some(span) = span else { return 0..0 };
        let start = span.offset + band * span.columns.len();
        start..start + span.columns.len()
    }

    /// Planes of an image `[row][column][band]`.
    pub(super) fn gather(&self, image: &[f64]) -> Vec<f64> {
        let mut planes = vec![0.0; self.len];
        for (at, span) in self.spans.iter().enumerate() {
            let start = (self.first + at) * self.shape.row_len() + span.columns.start * self.shape.bands();
            let samples = image.get(start..).unwrap_or(&[]);
            self.fill(span, samples, &mut planes);
        }
        planes
    }

    /// Variances σ² of every sample.
    pub(super) fn variances(&self, noise: &NoiseVariance) -> Result<Vec<f64>> {
        noise.check(self.shape)?;
        match noise {
            NoiseVariance::None => Ok(Vec::new()),
            NoiseVariance::Uniform(var) => Ok(vec![*var; self.len]),
            NoiseVariance::PerBand(var) => {
                let mut planes = Vec::with_capacity(self.len);
                for span in &self.spans {
                    for &var in var {
                        planes.extend(std::iter::repeat_n(var, span.columns.len()));
                    }
                }
                Ok(planes)
            }
            NoiseVariance::PerSample(Cube::F32(cube)) => self.read(&**cube),
            NoiseVariance::PerSample(Cube::F64(cube)) => self.read(&**cube),
        }
    }

    fn read<S: Sample>(&self, cube: &dyn Rows<S>) -> Result<Vec<f64>> {
        let mut planes = vec![0.0; self.len];
        let mut buffer = Vec::new();
        for (at, span) in self.spans.iter().enumerate() {
            let row = self.first + at;
            let samples = cube.read(row..row + 1, &mut buffer)?;
            let samples: Vec<f64> = (samples.iter().skip(span.columns.start * self.shape.bands()))
                .map(|&sample| sample.into())
                .collect();
            self.fill(span, &samples, &mut planes);
        }
        Ok(planes)
    }

    /// Turns `[column][band]` into `[band][column]`.
    fn fill(&self, span: &Span, samples: &[f64], planes: &mut [f64]) {
        let (columns, bands) = (span.columns.len(), self.shape.bands());
        for (column, pixel) in samples.chunks_exact(bands).take(columns).enumerate() {
            let to = planes.iter_mut().skip(span.offset + column).step_by(columns);
            to.zip(pixel).for_each(|(to, from)| *to = *from);
        }
    }
}

/// Samples of a view, as a layout has them.
#[derive(Debug, Clone, Copy)]
pub(super) struct View<'a> {
    pub(super) layout: &'a Layout,
    pub(super) samples: &'a [f64],
}

impl<'a> View<'a> {
    /// The samples of a row in a band.
    pub(super) fn plane(&self, row: usize, band: usize) -> &'a [f64] {
        self.samples.get(self.layout.plane(row, band)).unwrap_or(&[])
    }

    /// Those of some of its columns; empty if not all of them are there.
    pub(super) fn part(&self, row: usize, band: usize, columns: Range<usize>) -> &'a [f64] {
        let start = self.layout.columns(row).start;
        let Some(from) = columns.start.checked_sub(start) else { return &[] };
        self.plane(row, band).get(from..from + columns.len()).unwrap_or(&[])
    }
}
