//! SPC files of Galactic and Thermo GRAMS, new (version bytes `K`, little-endian, and `L`, big-endian) and old (`M`).
//!
//! A header, then one or more traces, each with a header of 32 bytes. Axes are evenly spaced from the first place to the last, one
//! list of 32-bit floats for all traces, or a list in each. Ordinates are 32-bit floats, or integers n of b = 16 or 32 bits that stand for
//! n 2^(exponent − b); in the old version the two halves of a 32-bit integer are swapped. Types of the axis and of the ordinates are codes, or
//! labels where the header says so: only reflectance and emissivity are taken.
//!
//! Source: Galactic Industries, A Brief Guide to SPC File Format and Using GSPCIO (1997), and its header file SPC.H.

mod header;

use self::header::{FLOATS, Flags, Header, TRACE_HEADER};
use super::bytes::{Bytes, FETCH_AGAIN};
use super::content::{Content, stem};
use super::reading::Reading;
use super::samples::{Origin, Samples, told};
use crate::envi_header::{ByteOrder, DataType};
use hadar::error::{Error, Result};
use std::path::Path;

/// The most traces of a file.
const MOST_TRACES: usize = 100_000;
/// Whether bytes look like one: the version in the second of them, and some that no text has.
pub(super) fn is_one(bytes: &[u8]) -> bool {
    let start = bytes.get(..header::NEW).unwrap_or(bytes);
    matches!(start.get(1), Some(b'K' | b'L' | b'M')) && start.contains(&0)
}

pub(super) fn parse(all: &[u8], source: &Path, reading: &Reading) -> Result<Content> {
    let order = if all.get(1) == Some(&b'L') { ByteOrder::Big } else { ByteOrder::Little };
    let bytes = Bytes { all, order };
    let header = Header::read(bytes)?;
    let (unit, quantity, percent) = match told(header.unit()?, header.values(), reading)? {
        Ok(told) => told,
        Err(reason) => return Ok(Content::NoEmissivity(reason)),
    };
    let traces = traces(bytes, &header)?;
    let many = traces.len() > 1;
    let comment = header.comment.as_str();
    let own = stem(source);
    let mut materials = Vec::with_capacity(traces.len());
    for (at, points) in traces.into_iter().enumerate() {
        let name = if many { format!("{own}@{}", at + 1) } else { own.clone() };
        let format = if many { format!("SPC, trace {}", at + 1) } else { "SPC".to_owned() };
        let description = if comment.is_empty() { format!("spectrum of {name}") } else { comment.to_owned() };
        let origin = Origin { name, description, format: &format, source, remark: "" };
        let samples = Samples { unit, quantity, percent, points };
        let in_trace = |error: Error| if many { error.for_key(format!("trace {}", at + 1)) } else { error };
        materials.push(samples.material(origin, reading).map_err(in_trace)?);
    }
    Ok(Content::Materials(materials))
}

/// Place and value of all points, trace by trace.
fn traces(bytes: Bytes<'_>, header: &Header) -> Result<Vec<Vec<(f64, f64)>>> {
    // A point takes two bytes at least; the axis of an even one none, so that it is not made for a file that has not as many.
    let too_many = !header.flags.has(Flags::AXIS_EACH) && header.points > bytes.all.len() / 2;
    if header.traces > MOST_TRACES || too_many {
        let found = format!("{} traces of {} points", header.traces, header.points);
        return Err(Error::malformed(found, FETCH_AGAIN));
    }
    if header.flags.has(Flags::AXIS_EACH) {
        return with_own_axes(bytes, header);
    }
    let mut at = header.end;
    let axis = match header.flags.has(Flags::AXIS) {
        true => {
            let axis = bytes.numbers(at, header.points, DataType::F32)?;
            at += header.points * DataType::F32.size();
            axis
        }
        false => header.even()?,
    };
    let mut traces = Vec::new();
    while header.is_more(traces.len(), at, bytes.all.len()) {
        let (values, end) = ordinates(bytes, header, at, at + TRACE_HEADER, header.points)?;
        traces.push(axis.iter().copied().zip(values).collect());
        at = end;
    }
    Ok(traces)
}

/// Traces with an axis in each, from a directory of where they are or one behind the other.
fn with_own_axes(bytes: Bytes<'_>, header: &Header) -> Result<Vec<Vec<(f64, f64)>>> {
    /// Bytes of an entry: place, length, and the third axis.
    const ENTRY: usize = 12;
    let (directory, mut next) = (header.points, header.end);
    // Traces do not share their points, or a short file would have any number of them.
    let mut left = bytes.all.len();
    let mut traces = Vec::new();
    for trace in 0..header.traces {
        let at = match directory {
            0 => next,
            _ => {
                let entry = directory.saturating_add(trace * ENTRY);
                bytes.part(entry, ENTRY)?;
                bytes.count(entry, DataType::U32)?
            }
        };
        let points = bytes.count(at.saturating_add(16), DataType::U32)?;
        let places = at.saturating_add(TRACE_HEADER);
        let Some(rest) = left.checked_sub(points.saturating_mul(DataType::F32.size())) else {
            let found = format!("more points than {} bytes have room for", bytes.all.len());
            return Err(Error::malformed(found, FETCH_AGAIN));
        };
        left = rest;
        let axis = bytes.numbers(places, points, DataType::F32)?;
        let (values, end) = ordinates(bytes, header, at, places + points * DataType::F32.size(), points)?;
        traces.push(axis.into_iter().zip(values).collect());
        next = end;
    }
    Ok(traces)
}

/// The ordinates of a trace whose header is at `at`, and where they end.
fn ordinates(
    bytes: Bytes<'_>,
    header: &Header,
    at: usize,
    from: usize,
    points: usize,
) -> Result<(Vec<f64>, usize)> {
    // Of several traces each has its exponent.
    let exponent = match header.flags.has(Flags::MANY) {
        false => header.exponent,
        true => {
            let own = header::exponent(bytes, at + 1)?;
            // A file of integers may have a trace of floats, not the other way round.
            if header.exponent == FLOATS && own != FLOATS {
                let found =
                    "the file and one of its traces say otherwise whether values are floats or integers";
                return Err(Error::malformed(found, "export the spectrum again, or as JCAMP-DX"));
            }
            own
        }
    };
    let (kind, bits) = match (exponent == FLOATS, header.flags.has(Flags::SHORT)) {
        (true, false) => (DataType::F32, 0),
        (true, true) => {
            let found = "values that are floats by their exponent and of 16 bits by a flag";
            return Err(Error::malformed(found, "export the spectrum again, or as JCAMP-DX"));
        }
        (false, true) => (DataType::I16, 16),
        (false, false) => (DataType::I32, 32),
    };
    let mut values = bytes.numbers(from, points, kind)?;
    let end = from + points * kind.size();
    if bits > 0 {
        if header.is_old && bits == 32 {
            let halves = bytes.numbers(from, 2 * points, DataType::U16)?;
            let (pairs, _) = halves.as_chunks::<2>();
            values = pairs.iter().map(|[high, low]| signed(high * 65536.0 + low)).collect();
        }
        let step = 2.0_f64.powi(exponent - bits);
        values.iter_mut().for_each(|value| *value *= step);
    }
    Ok((values, end))
}

/// The integer of 32 bits with a sign that has these bits.
fn signed(bits: f64) -> f64 {
    if bits >= 2_147_483_648.0 { bits - 4_294_967_296.0 } else { bits }
}

#[cfg(test)]
mod tests;
