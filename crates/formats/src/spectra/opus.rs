//! OPUS files of Bruker spectrometers.
//!
//! Blocks of parameters and of data, and a directory that says what each is, where it stands and how long it is (three 32-bit integers,
//! little-endian). Bits of what a block is: 0 and 1 real, imaginary or amplitude; 2 and 3 sample, reference or ratio; 4 to 9 which
//! parameters, 0 for data, 1 for the parameters of data; 10 to 16 the quantity; 17 and 18 the derivative; 19 to 21 an extension. A data
//! block is NPT numbers of 32 bits at places evenly spaced from FXV to LXV in the unit DXU, each times CSF. The parameters of data have
//! all the bits of their block but those 4 to 9.
//!
//! A file has the spectrum beside single-channel spectra and interferograms: the reflectance is taken, and which block it was is said.
//!
//! Source: format as described by brukeropus (J. Tran et al., MIT licence) and opusreader2 (P. Baumann, T. Knecht, P. Roudier), which
//! took it from files; there is no description by its maker.

use super::bytes::{Bytes, FETCH_AGAIN};
use super::content::{Content, short_name, stem};
use super::header::{self, Quantity};
use super::reading::Reading;
use super::samples::{Origin, Said, Samples, told};
use crate::envi_header::{ByteOrder, DataType};
use crate::spectral_unit::SpectralUnit;
use hadar::error::{Error, Result};
use hadar::words::kebab_case;
use std::collections::BTreeMap;
use std::path::Path;

/// The first bytes of every such file.
const MAGIC: [u8; 4] = [0x0a, 0x0a, 0xfe, 0xfe];
/// Bytes of an entry of the directory.
const ENTRY: usize = 12;
/// The most blocks of a file.
const MOST_BLOCKS: usize = 10_000;
/// What parameters of the sample are called.
const OF_SAMPLE: usize = 10;
/// By how much the largest value may differ from what the parameters say, relative to it.
const ROUNDED: f64 = 1e-3;
/// Quantities by their number.
const QUANTITIES: [(usize, &str); 18] = [
    (1, "single-channel spectrum"),
    (2, "interferogram"),
    (3, "phase"),
    (4, "absorbance"),
    (5, "transmittance"),
    (6, "Kubelka-Munk"),
    (7, "trace"),
    (8, "series of interferograms"),
    (9, "series of spectra"),
    (10, "Raman spectrum"),
    (EMISSION, "emission"),
    (REFLECTANCE, "reflectance"),
    (14, "power"),
    (15, "log reflectance"),
    (16, "ATR spectrum"),
    (17, "photoacoustic spectrum"),
    (18, "result like transmittance"),
    (19, "result like absorbance"),
];
const EMISSION: usize = 11;
const REFLECTANCE: usize = 12;
/// Those that every file has beside the spectrum.
const BESIDE: [usize; 3] = [1, 2, 3];

/// Whether bytes are such a file.
pub(super) fn is_one(bytes: &[u8]) -> bool {
    bytes.starts_with(&MAGIC)
}

/// A block of the directory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Block {
    kind: usize,
    at: usize,
    length: usize,
}

impl Block {
    /// Bits of what it is, shifted to the right.
    const fn bits(self, from: u32, count: u32) -> usize {
        (self.kind >> from) & ((1 << count) - 1)
    }

    const fn quantity(self) -> usize {
        self.bits(10, 7)
    }

    /// Whether it is data of a quantity, neither parameters nor an extension such as a report or a list of peaks.
    const fn is_data(self) -> bool {
        self.bits(4, 6) == 0 && self.bits(19, 3) == 0 && self.bits(0, 2) != 0
    }

    fn name(self) -> String {
        let name = QUANTITIES
            .iter()
            .find(|(code, _)| *code == self.quantity())
            .map_or("unknown quantity", |known| known.1);
        match self.bits(17, 2) {
            0 => name.to_owned(),
            _ => format!("derivative of {name}"),
        }
    }
}

pub(super) fn parse(all: &[u8], source: &Path, reading: &Reading) -> Result<Content> {
    let bytes = Bytes { all, order: ByteOrder::Little };
    let blocks = directory(bytes)?;
    let data: Vec<Block> = blocks.iter().copied().filter(|block| block.is_data()).collect();
    let is_spectrum = |block: &&Block| !BESIDE.contains(&block.quantity());
    let names = |of: &[Block]| of.iter().map(|block| block.name()).collect::<Vec<_>>().join(", ");
    let of = |quantity: usize| -> Vec<Block> {
        data.iter().copied().filter(|block| block.quantity() == quantity && block.bits(17, 2) == 0).collect()
    };
    let (wanted, values) = match (of(REFLECTANCE), of(EMISSION)) {
        (none, emission) if none.is_empty() && !emission.is_empty() => {
            (emission, Said::Open("emission".into()))
        }
        (found, _) if !found.is_empty() => (found, Said::Values(Quantity::Reflectance, false)),
        _ => {
            let spectra: Vec<Block> = data.iter().filter(is_spectrum).copied().collect();
            let shown = if spectra.is_empty() { &data } else { &spectra };
            let found = match shown.is_empty() {
                true => "the file has no block of a spectrum".to_owned(),
                false => format!("the file has blocks of {}, from which no emissivity follows", names(shown)),
            };
            let instead = "use the spectrum of an opaque sample that was measured or saved as reflectance";
            return Ok(Content::NoEmissivity(Error::malformed(found, instead)));
        }
    };
    let [block] = wanted[..] else {
        let found = format!("{} blocks of {}", wanted.len(), names(&wanted[..1]));
        return Err(Error::malformed(found, "save each as a file of its own, or export it as JCAMP-DX"));
    };
    let parameters = blocks.iter().find(|other| other.kind == block.kind | 1 << 4);
    let Some(parameters) = parameters else {
        let found = format!("the parameters of the block of {} are missing", block.name());
        return Err(Error::malformed(found, FETCH_AGAIN));
    };
    let parameters = Parameters::read(bytes, *parameters)?;
    let points = points(bytes, block, &parameters)?;
    let unit = unit(&parameters, &points)?;
    let (unit, quantity, percent) = match told(unit, values, reading)? {
        Ok(told) => told,
        Err(reason) => return Ok(Content::NoEmissivity(reason)),
    };
    let beside: Vec<Block> =
        data.iter().filter(is_spectrum).copied().filter(|other| *other != block).collect();
    let beside = if beside.is_empty() { String::new() } else { format!(" (beside it {})", names(&beside)) };
    let format = format!("OPUS, its block of {}{beside}", block.name());
    let title = sample_name(bytes, &blocks)?;
    let own = short_name(&kebab_case(&title));
    let name = if own.is_empty() { stem(source) } else { own };
    let description = if title.is_empty() { format!("spectrum of {name}") } else { title };
    let origin = Origin { name, description, format: &format, source, remark: "" };
    let samples = Samples { unit, quantity, percent, points };
    Ok(Content::Materials(vec![samples.material(origin, reading)?]))
}

/// All blocks of the file.
fn directory(bytes: Bytes<'_>) -> Result<Vec<Block>> {
    let (start, most, count) =
        (bytes.count(12, DataType::U32)?, bytes.count(16, DataType::U32)?, bytes.count(20, DataType::U32)?);
    if count > MOST_BLOCKS || count > most {
        return Err(Error::malformed(format!("{count} blocks where {most} have room"), FETCH_AGAIN));
    }
    let mut blocks = Vec::with_capacity(count);
    for entry in 0..count {
        let at = start.saturating_add(entry * ENTRY);
        let kind = bytes.count(at, DataType::U32)?;
        let length = bytes.count(at + 4, DataType::U32)?.saturating_mul(4);
        let block = Block { kind, at: bytes.count(at + 8, DataType::U32)?, length };
        // A place of 0 ends the list of some files.
        if block.at == 0 {
            break;
        }
        // All of it must be there, whether it is used or not.
        bytes.part(block.at, block.length)?;
        blocks.push(block);
    }
    Ok(blocks)
}

/// Parameters by their names of three letters.
struct Parameters {
    numbers: BTreeMap<String, f64>,
    texts: BTreeMap<String, String>,
}

impl Parameters {
    fn read(bytes: Bytes<'_>, block: Block) -> Result<Self> {
        let mut own = Self { numbers: BTreeMap::new(), texts: BTreeMap::new() };
        let (mut at, end) = (block.at, block.at.saturating_add(block.length));
        while at < end {
            let name = bytes.text(at, 3)?;
            if name == "END" {
                break;
            }
            let kind = bytes.count(at + 4, DataType::U16)?;
            let length = bytes.count(at + 6, DataType::U16)? * 2;
            match kind {
                0 => drop(own.numbers.insert(name, bytes.number(at + 8, DataType::I32)?)),
                1 => drop(own.numbers.insert(name, bytes.number(at + 8, DataType::F64)?)),
                _ => drop(own.texts.insert(name, bytes.text(at + 8, length)?)),
            }
            at += 8 + length;
        }
        Ok(own)
    }

    fn number(&self, name: &str) -> Result<f64> {
        let missing =
            || Error::malformed(format!("the parameter {name} of the spectrum is missing"), FETCH_AGAIN);
        self.numbers.get(name).copied().filter(|value| value.is_finite()).ok_or_else(missing)
    }
}

/// Place and value of every point.
fn points(bytes: Bytes<'_>, block: Block, parameters: &Parameters) -> Result<Vec<(f64, f64)>> {
    let (count, first, last) =
        (parameters.number("NPT")?, parameters.number("FXV")?, parameters.number("LXV")?);
    let kind = if parameters.numbers.get("DPF") == Some(&2.0) { DataType::I32 } else { DataType::F32 };
    let room = block.length / kind.size();
    if !(count >= 2.0 && count <= room as f64) || first == last {
        let found = format!("{count} points from {first} to {last} where there is room for {room}");
        return Err(Error::malformed(found, FETCH_AGAIN));
    }
    let factor = parameters.numbers.get("CSF").copied().unwrap_or(1.0);
    if factor == 0.0 || !factor.is_finite() {
        return Err(Error::malformed(format!("CSF is {factor}, which makes all values one"), FETCH_AGAIN));
    }
    let values = bytes.numbers(block.at, count as usize, kind)?;
    let step = (last - first) / (count - 1.0);
    // The largest and the smallest value are among the parameters.
    for (name, own) in [
        ("MXY", values.iter().copied().fold(f64::NEG_INFINITY, f64::max)),
        ("MNY", values.iter().copied().fold(f64::INFINITY, f64::min)),
    ] {
        if let Some(&due) = parameters.numbers.get(name)
            && (own * factor - due).abs() > ROUNDED * due.abs().max(1.0)
        {
            let found =
                format!("{} is the extreme of the values where {name} of the file is {due}", own * factor);
            return Err(Error::malformed(found, FETCH_AGAIN));
        }
    }
    Ok(values.iter().enumerate().map(|(at, value)| (first + step * at as f64, value * factor)).collect())
}

/// The unit of the axis.
fn unit(parameters: &Parameters, points: &[(f64, f64)]) -> Result<Option<SpectralUnit>> {
    let said = parameters.texts.get("DXU").map_or("", |unit| unit.trim());
    let ends = [points.first(), points.last()].map(|end| end.map_or(f64::NAN, |point| point.0));
    let range = (ends[0].min(ends[1]), ends[0].max(ends[1]));
    match said.to_uppercase().as_str() {
        "WN" => Ok(Some(SpectralUnit::PerCentimetre)),
        "MI" => Ok(Some(SpectralUnit::Micrometre)),
        "NM" => Ok(Some(SpectralUnit::Nanometre)),
        "WL" => Ok(header::unit_of_range("wavelength", range)),
        "" => Ok(None),
        other => {
            let found = format!("the axis is in `{other}`, no wavenumber or wavelength");
            Err(Error::malformed(found, "use a spectrum over wavenumber"))
        }
    }
}

/// The name of the sample, from the first of its parameters that has it.
fn sample_name(bytes: Bytes<'_>, blocks: &[Block]) -> Result<String> {
    for block in blocks.iter().filter(|block| block.bits(4, 6) == OF_SAMPLE) {
        if let Some(name) =
            Parameters::read(bytes, *block)?.texts.get("SNM").filter(|name| !name.trim().is_empty())
        {
            return Ok(name.trim().to_owned());
        }
    }
    Ok(String::new())
}

#[cfg(test)]
mod tests;
