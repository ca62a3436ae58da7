//! Writes ENVI images: header and data, `f32` or `f64` in the order of bytes that comes least first.
//!
//! Source: NV5 Geospatial, ENVI Header Files (documentation of ENVI).

use crate::envi_header::Interleave;
use hadar::cube::{Sample, Shape};
use hadar::error::{Error, Result};
use std::fmt::Write as _;

/// What the header says of the bands: in wavenumbers, cm⁻¹.
#[derive(Debug, Clone, Copy)]
pub struct EnviBands<'a> {
    /// Their centres.
    pub centres_cm1: &'a [f64],
    /// Their widths, where they are said.
    pub widths_cm1: Option<&'a [f64]>,
}

/// Samples `[row][column][band]` as an ENVI image: the text of its header, and its data.
///
/// # Errors
/// A number of samples or of bands that is not that of the shape.
///
/// ```
/// use hadar::cube::Shape;
/// use hadar_formats::cube::envi_files;
/// use hadar_formats::envi_header::Interleave;
/// let shape = Shape::new(1, 2, 2)?;
/// let (header, data) = envi_files(shape, &[10.0_f32, 11.0, 20.0, 21.0], Interleave::Bsq, None)?;
/// assert!(header.starts_with("ENVI\nsamples = 2\nlines = 1\nbands = 2\n"));
/// assert_eq!(data[4..8], 20.0_f32.to_le_bytes());
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn envi_files<S: Sample>(
    shape: Shape,
    samples: &[S],
    interleave: Interleave,
    bands: Option<EnviBands<'_>>,
) -> Result<(String, Vec<u8>)> {
    let length = |what: &str, found: usize, expected: usize| match found == expected {
        true => Ok(()),
        false => Err(Error::Length { what: what.to_owned(), found, expected }),
    };
    length("samples of a cube", samples.len(), shape.len())?;
    let single = S::NAME == f32::NAME;
    let (data_type, name) = (
        if single { 4 } else { 5 },
        match interleave {
            Interleave::Bsq => "bsq",
            Interleave::Bil => "bil",
            Interleave::Bip => "bip",
        },
    );
    let mut header = format!(
        "ENVI\nsamples = {}\nlines = {}\nbands = {}\nheader offset = 0\nfile type = ENVI Standard\n\
         data type = {data_type}\ninterleave = {name}\nbyte order = 0\n",
        shape.columns(),
        shape.rows(),
        shape.bands()
    );
    if let Some(bands) = bands {
        header.push_str("wavelength units = Wavenumber\n");
        for (key, numbers) in [("wavelength", Some(bands.centres_cm1)), ("fwhm", bands.widths_cm1)] {
            let Some(numbers) = numbers else { continue };
            length(&format!("{key} of the bands"), numbers.len(), shape.bands())?;
            let numbers: Vec<String> = numbers.iter().map(f64::to_string).collect();
            let _ = writeln!(header, "{key} = {{{}}}", numbers.join(",\n "));
        }
    }
    let mut data = Vec::with_capacity(size_of_val(samples));
    let mut put = |sample: &S| {
        let value: f64 = (*sample).into();
        match single {
            true => data.extend_from_slice(&(value as f32).to_le_bytes()),
            false => data.extend_from_slice(&value.to_le_bytes()),
        }
    };
    let by_band = |lines: &[S], put: &mut dyn FnMut(&S)| {
        for band in 0..shape.bands() {
            lines.iter().skip(band).step_by(shape.bands()).for_each(&mut *put);
        }
    };
    match interleave {
        Interleave::Bip => samples.iter().for_each(put),
        Interleave::Bil => samples.chunks(shape.row_len()).for_each(|line| by_band(line, &mut put)),
        Interleave::Bsq => by_band(samples, &mut put),
    }
    Ok((header, data))
}
