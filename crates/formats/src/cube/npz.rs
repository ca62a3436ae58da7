//! NPZ files: ZIP archives of NPY files, each an array by its name.
//!
//! An array that is only stored in the archive is read by rows at its place, as one of its own file; a packed one is unpacked
//! whole. A list of wavelengths or wavenumbers beside the cube says its bands, if its name has their unit.
//!
//! Source: NumPy, `numpy.savez` and `numpy.savez_compressed`.

use super::axes::Axes;
use super::band_list;
use super::found::{Found, Opened};
use super::npy::{self, Array};
use super::raw::MAX_INFLATION;
use super::scaling;
use super::stored::decode_next;
use super::text_unit;
use super::{READ_CUBE, arrange};
use hadar::cube::{Cube, MemoryCube, Sample};
use hadar::error::{Error, Result};
use std::borrow::Cow;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;
use zip::result::ZipResult;
use zip::{CompressionMethod, ZipArchive};

/// Arrays that are looked at where none is named.
const MOST: usize = 1000;
const FORMAT: &str = "NPZ";

/// Opens an archive.
pub(super) fn open(file: File, path: &Path, name: Option<&str>, axes: Option<Axes>) -> Result<Opened> {
    let len = file.metadata().map_err(|error| Error::file(READ_CUBE, path, error))?.len();
    let source = file.try_clone().map_err(|error| Error::file(READ_CUBE, path, error))?;
    let mut archive = ZipArchive::new(BufReader::new(source)).map_err(damaged)?;
    let place = choose(&mut archive, name)?;
    let entry = archive.by_index(place).map_err(damaged)?;
    let variable = array_name(entry.name());
    let of_variable = |error: Error| error.for_key(variable.clone());
    let (bytes, packed) = (entry.size(), entry.compressed_size().min(len));
    if bytes > packed.saturating_mul(MAX_INFLATION) {
        return Err(of_variable(damaged("an array announces more than its bytes can stand for")));
    }
    let opened = if entry.compression() == CompressionMethod::Stored {
        let start = entry.data_start().ok_or_else(|| damaged("an array has no place"))?;
        if start.checked_add(bytes).is_none_or(|end| end > len) {
            return Err(of_variable(damaged("the file ends within the array")));
        }
        drop(entry);
        npy::open(file, path, (start, bytes), axes, FORMAT).map_err(of_variable)?
    } else {
        let mut entry = entry;
        let array = Array::read(&mut entry, bytes, axes).map_err(of_variable)?;
        let cube = match array.stored.is_double() {
            true => unpacked::<f64>(&mut entry, &array).map(Cube::from),
            false => unpacked::<f32>(&mut entry, &array).map(Cube::from),
        }
        .map_err(of_variable)?;
        let memory = array.shape.len() as u64 * if array.stored.is_double() { 8 } else { 4 };
        let found = Found::array(FORMAT, array.shape, array.stored.name(), &array.sides);
        Opened { cube, found: Found { axes, memory_bytes: Some(memory), ..found } }
    };
    let bands = opened.found.shape.bands();
    let (centres_cm1, axis_without_unit) =
        band_list::centres(&read(&mut archive, |name| band_list::unit(name, None).is_some(), &[bands]))?;
    for (name, numbers) in read(&mut archive, |name| scaling::is_named(name, &variable), &[1, bands]) {
        scaling::check(&name, &variable, &numbers)?;
    }
    let unit = unit(&mut archive, &variable);
    let found = Found { variable: Some(variable), centres_cm1, axis_without_unit, unit, ..opened.found };
    Ok(Opened { found, ..opened })
}

/// Lists of so many numbers, by their names.
fn read(
    archive: &mut ZipArchive<BufReader<File>>,
    is_meant: impl Fn(&str) -> bool,
    lengths: &[usize],
) -> Vec<(String, Vec<f64>)> {
    let count = archive.len().min(MOST);
    let mut list = |place: usize, length: usize| {
        let mut entry = archive.by_index(place).ok()?;
        let (len, name) = (entry.size(), array_name(entry.name()));
        let list = if is_meant(&name) { npy::list(&mut entry, len, length) } else { None };
        list.map(|list| (name, list))
    };
    (0..count).filter_map(|place| lengths.iter().find_map(|length| list(place, *length))).collect()
}

/// The unit of the samples, in a text beside them.
fn unit(archive: &mut ZipArchive<BufReader<File>>, of_array: &str) -> Option<String> {
    let count = archive.len().min(MOST);
    let text = |place: usize| {
        let mut entry = archive.by_index(place).ok()?;
        let (len, name) = (entry.size(), array_name(entry.name()));
        if !text_unit::is_name(&name, of_array) {
            return None;
        }
        text_unit::of(&npy::text(&mut entry, len, text_unit::MOST)?)
    };
    (0..count).find_map(text)
}

fn unpacked<S: Sample>(entry: &mut impl Read, array: &Array) -> Result<MemoryCube<S>> {
    let samples = arrange::whole(array.shape, array.order, |slices: &mut [S]| {
        let exact = |bytes: &mut [u8]| entry.read_exact(bytes).map_err(damaged);
        decode_next(exact, array.stored, array.little_endian, slices)
    })?;
    // To the end, so that its checksum is looked at.
    entry.read(&mut [0]).map_err(damaged)?;
    MemoryCube::new(array.shape, samples)
}

/// The array of this name, or the only one that can be meant.
fn choose(archive: &mut ZipArchive<BufReader<File>>, name: Option<&str>) -> Result<usize> {
    let names: Vec<String> = archive.file_names().map(array_name).collect();
    if let Some(name) = name {
        let place = names.iter().position(|own| own == name);
        return place.ok_or_else(|| Error::unknown_name("array", name, names.iter().map(String::as_str)));
    }
    let mut cubes = Vec::new();
    for place in 0..archive.len().min(MOST) {
        let mut entry = archive.by_index(place).map_err(damaged)?;
        let (len, name) = (entry.size(), array_name(entry.name()));
        // What cannot be a cube is left out: text, objects, one dimension.
        if let Ok(array) = Array::read(&mut entry, len, None) {
            cubes.push((place, array.sides, name));
        }
    }
    let deep: Vec<_> = cubes.iter().filter(|(_, sides, _)| sides.len() == 3).collect();
    match (deep.as_slice(), cubes.as_slice()) {
        ([(place, ..)], _) | ([], [(place, ..)]) => Ok(*place),
        ([], []) => Err(Error::malformed(
            format!("the archive has {} files, none of them an array [row][column][band]", names.len()),
            "write it with np.savez(path, cube=a)",
        )),
        _ => {
            let listed: Vec<String> = cubes
                .iter()
                .map(|(_, sides, name)| {
                    let sides: Vec<String> = sides.iter().map(usize::to_string).collect();
                    format!("`{name}` ({})", sides.join(" x "))
                })
                .collect();
            let found =
                format!("the file has {} arrays that may be meant: {}", listed.len(), listed.join(", "));
            Err(Error::malformed(found, "name one of them as the variable"))
        }
    }
}

/// The name of an array by that of its file; none of one that is no text.
fn array_name(file: ZipResult<Cow<'_, str>>) -> String {
    let file = file.unwrap_or_default();
    file.strip_suffix(".npy").unwrap_or(&file).to_owned()
}

fn damaged(error: impl std::fmt::Display) -> Error {
    Error::malformed(format!("the archive is damaged: {error}"), "write or copy it again")
}
