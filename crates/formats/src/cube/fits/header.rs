//! The header of a FITS image: its cards, by their keywords.

use crate::cube::raw::read_at;
use crate::cube::stored::Stored;
use hadar::error::{Error, Result};
use std::fs::File;
use std::path::Path;

/// Bytes of a block, and of a card.
pub(super) const BLOCK: u64 = 2880;
const CARD: usize = 80;
/// Blocks that a header may have: 36 000 cards.
const MOST: u64 = 1000;
/// Axes that an image may have.
const MOST_AXES: usize = 9;
/// Kinds of spectral coordinates that are linear in what they are called after, vacuum wavelengths among them.
/// Columns of a table that are looked at.
const MOST_COLUMNS: usize = 999;
const SPECTRAL: [&str; 6] = ["WAVE", "WAVN", "FREQ", "WAVELENGTH", "LAMBDA", "WAVENUMBER"];
/// Of those that have one by the standard.
const STANDARD_UNITS: [&str; 3] = ["m", "m-1", "Hz"];

/// The cards of an image.
#[derive(Debug)]
pub(super) struct Header {
    cards: Vec<(String, String)>,
    /// Bytes of its blocks.
    pub(super) bytes: u64,
}

/// A spectral axis: a number for each pixel, counted from 1.
#[derive(Debug)]
pub(super) struct SpectralAxis {
    /// The fastest axis is 1.
    pub(super) number: usize,
    /// None of a kind that is not read.
    pub(super) unit: Option<String>,
    value: f64,
    pixel: f64,
    step: f64,
}

impl SpectralAxis {
    pub(super) fn at(&self, pixel: f64) -> f64 {
        self.value + (pixel - self.pixel) * self.step
    }
}

impl Header {
    /// Reads the cards from a place on.
    pub(super) fn read(file: &File, path: &Path, place: u64) -> Result<Self> {
        let mut cards = Vec::new();
        let mut block = [0; BLOCK as usize];
        for number in 0..MOST {
            read_at(file, path, &mut block, place.saturating_add(number * BLOCK))
                .map_err(|_| damaged("it ends within a header"))?;
            let (found, _) = block.as_chunks::<CARD>();
            for card in found {
                let text: String = card.iter().map(|byte| char::from(*byte)).collect();
                let keyword = text.get(..8).unwrap_or_default().trim_end();
                if keyword == "END" {
                    return Ok(Self { cards, bytes: (number + 1) * BLOCK });
                }
                if let Some(value) = text.get(8..).and_then(|rest| rest.strip_prefix("= ")) {
                    cards.push((keyword.to_owned(), value_of(value)));
                }
            }
        }
        Err(damaged("its header has no END"))
    }

    /// The value of a keyword, without quotes.
    pub(super) fn text(&self, keyword: &str) -> Option<&str> {
        self.cards.iter().find(|(own, _)| own == keyword).map(|(_, value)| value.as_str())
    }

    /// A finite number.
    pub(super) fn number(&self, keyword: &str) -> Result<Option<f64>> {
        let Some(text) = self.text(keyword) else { return Ok(None) };
        // Exponents may be written with the D of double precision.
        match text.trim().replace(['D', 'd'], "e").parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(Some(number)),
            _ => Err(Error::malformed(
                format!("{keyword} is `{}`", text.escape_debug()),
                "write a finite number",
            )),
        }
    }

    fn whole(&self, keyword: &str) -> Result<Option<u64>> {
        let Some(text) = self.text(keyword) else { return Ok(None) };
        let number =
            text.trim().parse().map_err(|_| damaged(format!("{keyword} is `{}`", text.escape_debug())))?;
        Ok(Some(number))
    }

    /// What the columns of a table are called.
    pub(super) fn columns(&self) -> impl Iterator<Item = &str> {
        (1..=MOST_COLUMNS).map_while(|column| self.text(&format!("TTYPE{column}"))).map(str::trim)
    }

    /// Lengths of the axes that are counted by a keyword, the fastest first.
    pub(super) fn sides(&self, counted_by: &str) -> Result<Vec<usize>> {
        let count = self.whole(counted_by)?.and_then(|count| usize::try_from(count).ok()).unwrap_or(0);
        if count > MOST_AXES {
            return Err(damaged(format!("an image of {count} axes")));
        }
        let side = |axis: usize| {
            let keyword = format!("{counted_by}{axis}");
            let side = self.whole(&keyword)?.ok_or_else(|| damaged(format!("there is no {keyword}")))?;
            Ok(usize::try_from(side).unwrap_or(usize::MAX))
        };
        (1..=count).map(side).collect()
    }

    /// How numbers are stored.
    pub(super) fn stored(&self) -> Result<Stored> {
        Ok(match self.text("BITPIX").map(str::trim) {
            Some("8") => Stored::U8,
            Some("16") => Stored::I16,
            Some("32") => Stored::I32,
            Some("64") => Stored::I64,
            Some("-32") => Stored::F32,
            Some("-64") => Stored::F64,
            other => return Err(damaged(format!("BITPIX is `{}`", other.unwrap_or("").escape_debug()))),
        })
    }

    /// Bytes of what follows the header: |BITPIX|/8 · GCOUNT · (PCOUNT + NAXIS1 · NAXIS2 · …).
    pub(super) fn data_bytes(&self, sides: &[usize], stored: Stored) -> Result<u64> {
        if sides.is_empty() {
            return Ok(0);
        }
        let numbers = sides.iter().fold(1_u64, |product, side| product.saturating_mul(*side as u64));
        let (beside, groups) = (self.whole("PCOUNT")?.unwrap_or(0), self.whole("GCOUNT")?.unwrap_or(1));
        let all = numbers.saturating_add(beside).saturating_mul(groups);
        // Beyond any file, and still a number of blocks.
        Ok(all.saturating_mul(stored.size() as u64).min(u64::MAX / 2))
    }

    /// The axis that counts wavelengths, wavenumbers or frequencies.
    ///
    /// # Errors
    /// One without its reference point or step, or with numbers that are none.
    pub(super) fn spectral_axis(&self) -> Result<Option<SpectralAxis>> {
        for axis in 1..=3 {
            let of = |keyword: &str| format!("{keyword}{axis}");
            let kind = self.text(&of("CTYPE")).unwrap_or_default().trim();
            let place = SPECTRAL.iter().position(|own| *own == kind);
            // Others are spectral too, but not linear or not in vacuum.
            let other = ["AWAV", "VRAD", "VOPT", "ENER", "WAVE-", "FREQ-", "WAVN-"]
                .iter()
                .any(|own| kind.starts_with(own));
            if place.is_none() && !other {
                continue;
            }
            let step = match self.number(&format!("CD{axis}_{axis}"))? {
                None => {
                    let scale = self.number(&format!("PC{axis}_{axis}"))?.unwrap_or(1.0);
                    self.number(&of("CDELT"))?.map(|step| step * scale)
                }
                step => step,
            };
            // One that is turned against the others has no wavelength of a band.
            let turned = self.cards.iter().any(|(keyword, value)| {
                let matrix = keyword.strip_prefix("PC").or_else(|| keyword.strip_prefix("CD"));
                let ends = matrix.and_then(|places| places.split_once('_'));
                let is_other = ends.is_some_and(|(i, j)| (i == axis.to_string()) != (j == axis.to_string()));
                is_other && value.trim().parse() != Ok(0.0)
            });
            let written = self.text(&of("CUNIT")).map(str::trim).filter(|unit| !unit.is_empty());
            let unit = place
                .filter(|_| !turned)
                .and_then(|place| written.or(STANDARD_UNITS.get(place).copied()))
                .map(str::to_owned);
            let known = |number: Option<f64>, keyword: &str| {
                number.ok_or_else(|| {
                    Error::malformed(format!("{kind} without {keyword}"), "write it into the header")
                })
            };
            return Ok(Some(SpectralAxis {
                number: axis,
                unit,
                value: known(self.number(&of("CRVAL"))?, &of("CRVAL"))?,
                pixel: known(self.number(&of("CRPIX"))?, &of("CRPIX"))?,
                step: known(step, &of("CDELT"))?,
            }));
        }
        Ok(None)
    }
}

/// The value of a card, without its comment and quotes; a quote within is written twice.
fn value_of(text: &str) -> String {
    let text = text.trim_start();
    let Some(quoted) = text.strip_prefix('\'') else {
        return text.split('/').next().unwrap_or_default().trim().to_owned();
    };
    let mut value = String::new();
    let mut rest = quoted.chars().peekable();
    while let Some(char) = rest.next() {
        match (char, rest.peek()) {
            ('\'', Some('\'')) => {
                value.push('\'');
                rest.next();
            }
            ('\'', _) => break,
            (other, _) => value.push(other),
        }
    }
    value.trim_end().to_owned()
}

/// A file that cannot be read.
pub(super) fn damaged(error: impl std::fmt::Display) -> Error {
    Error::malformed(format!("the FITS file cannot be read: {error}"), "write or copy it again")
}
