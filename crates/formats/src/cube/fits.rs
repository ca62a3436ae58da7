//! FITS files: the image of the file itself or of one of its extensions.
//!
//! A header is cards of 80 bytes in blocks of 2880, `KEYWORD = value / comment`, up to `END`; the numbers of an array of NAXIS1 × NAXIS2 × … follow,
//! their greatest byte first, the first axis the fastest: a cube is `[NAXIS3][NAXIS2][NAXIS1]`: bands, rows, columns, as NumPy has it. A sample is BSCALE · number
//! and BZERO added, and BLANK means that nothing was measured. The world coordinate of a linear spectral axis (CTYPE WAVE, WAVN or FREQ) says where the
//! bands are, and which axis is theirs. `variable` names an extension by EXTNAME, or by its number from 0.
//!
//! Source: FITS Standard 4.0 (IAU FITS Working Group, 2018); spectral axes: Greisen et al. 2006, A&A 446, 747.

mod header;

use self::header::{Header, damaged};
use super::axes::Axes;
use super::band_list;
use super::choice::{Listed, choose};
use super::found::{Found, Opened};
use super::raw::Raw;
use super::stored::Stored;
use super::values::{ALL_VALID, Values};
use crate::spectral_unit::SpectralUnit;
use hadar::error::{Error, Result};
use std::fs::File;
use std::path::Path;

/// What a file begins with.
pub(super) const MAGIC: &[u8] = b"SIMPLE  =";
/// Images that are looked at.
const MOST: usize = 1000;

/// An image: its header, and where its numbers begin.
#[derive(Debug)]
struct Image {
    name: String,
    header: Header,
    start: u64,
    sides: Vec<usize>,
    stored: Stored,
    /// Why it cannot be read, if it cannot.
    unread: Option<Error>,
}

/// Opens a file whose first bytes have been seen.
pub(super) fn open(file: File, path: &Path, name: Option<&str>, axes: Option<Axes>) -> Result<Opened> {
    let len = file.metadata().map_err(damaged)?.len();
    let (images, has_list) = images(&file, path, len)?;
    let listed: Vec<Listed> = images
        .iter()
        .map(|image| Listed {
            name: image.name.clone(),
            sides: image.sides.clone(),
            stored: image.stored.name(),
            unread: image.unread.clone(),
        })
        .collect();
    let place = choose(&listed, name)?;
    let Some(Image { name, header, start, sides, stored, .. }) = images.into_iter().nth(place) else {
        return Err(damaged("an image is lost"));
    };
    let of_image = |error: Error| error.for_key(name.clone());
    let spectral = header.spectral_axis().map_err(of_image)?;
    // Axes are counted from the fastest.
    let on = spectral.as_ref().map_or(2, |axis| axis.number - 1);
    let usual = (sides.len() == 3).then(|| Axes::with_bands_on(2_usize.saturating_sub(on)));
    let axes = axes.or(usual);
    let order = axes.unwrap_or_default();
    let shape = order.shape(&sides).map_err(of_image)?;
    let bytes = Raw::bytes(shape, stored);
    if start.checked_add(bytes).is_none_or(|end| end > len) {
        return Err(of_image(damaged("it ends within the image")));
    }
    let (gain, offset) =
        (header.number("BSCALE").map_err(of_image)?, header.number("BZERO").map_err(of_image)?);
    if gain == Some(0.0) {
        let error = Error::malformed("BSCALE is 0, which makes all samples one", "write another number");
        return Err(of_image(error));
    }
    // BLANK is of whole numbers alone.
    let is_float = matches!(stored, Stored::F32 | Stored::F64);
    let missing = header.number("BLANK").map_err(of_image)?.filter(|_| !is_float).into_iter().collect();
    let list = |number: Option<f64>| number.map(|number| vec![number]);
    let values = Values::new(list(gain), list(offset), missing, ALL_VALID);
    let found = Found::array("FITS", shape, stored.name(), &sides);
    let unit = header.text("BUNIT").map(str::to_owned).filter(|unit| !unit.trim().is_empty());
    let mut found = Found { variable: Some(name), axes, unit, ..found };
    values.iter().for_each(|values| values.tell(&mut found));
    if let Some(axis) = spectral {
        // Centres are of the axis that is that of the bands, and of no other.
        let is_of_bands = usual.is_some() && axes == usual;
        found.centres_cm1 = axis.unit.as_deref().filter(|_| is_of_bands).and_then(|unit| {
            let places = (1..=shape.bands()).map(|pixel| axis.at(pixel as f64)).collect::<Vec<_>>();
            band_list::in_unit(SpectralUnit::spelt(unit)?, &places)
        });
        found.axis_without_unit = found.centres_cm1.is_none();
    } else {
        found.axis_without_unit = has_list;
    }
    let cube =
        Raw { file, path: path.to_owned(), shape, start, order, stored, little_endian: false, values }.cube();
    Ok(Opened { cube, found })
}

/// All images of two or more axes, and whether there is a table of the bands' places. An image without a name has its number.
fn images(file: &File, path: &Path, len: u64) -> Result<(Vec<Image>, bool)> {
    let (mut images, mut has_list) = (Vec::new(), false);
    let (mut place, mut number) = (0, 0);
    while place < len && number < MOST {
        let header = Header::read(file, path, place)?;
        let start = place + header.bytes;
        let sides = header.sides("NAXIS")?;
        let stored = header.stored()?;
        place = start.saturating_add(header.data_bytes(&sides, stored)?.next_multiple_of(header::BLOCK));
        let kind = header.text("XTENSION").map_or("IMAGE", str::trim);
        has_list |= kind == "BINTABLE" && header.columns().any(band_list::may_be);
        let (sides, unread) = match (kind, header.text("ZIMAGE")) {
            ("IMAGE", _) => (sides, None),
            ("BINTABLE", Some(_)) => {
                let instead = "unpack it with funpack, or with astropy: fits.writeto('cube.fits', fits.getdata('cube.fits.fz'))";
                let error = Error::malformed("the image is compressed in a table (ZIMAGE)", instead);
                (header.sides("ZNAXIS")?, Some(error))
            }
            _ => (Vec::new(), None),
        };
        if sides.len() > 1 {
            let name =
                header.text("EXTNAME").map_or_else(|| number.to_string(), |name| name.trim().to_owned());
            // The fastest axis is written first; sides of 1 before three others are none.
            let mut sides: Vec<usize> = sides.into_iter().rev().collect();
            while sides.len() > 3 && sides.first() == Some(&1) {
                sides.remove(0);
            }
            images.push(Image { name, header, start, sides, stored, unread });
        }
        number += 1;
    }
    Ok((images, has_list))
}
