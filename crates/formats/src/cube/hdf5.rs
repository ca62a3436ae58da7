//! HDF5 files, NetCDF-4 and MATLAB files of version 7.3 among them.
//!
//! What is not packed stands in the file as it is, and is read by rows at its place; packed chunks are read by blocks of rows
//! where rows are the first dimension, else whole. MATLAB has its first index run fastest, which makes it the last dimension.
//!
//! Sources: The HDF Group, HDF5 File Format Specification 3.0; NetCDF Users Guide, Attribute Conventions.

mod array;
mod band_axis;
mod dimensions;
mod links;
mod sound;
mod source;

use self::array::{Array, listed, said};
use self::band_axis::BandAxis;
use self::sound::{damaged, sound};
use self::source::{Bounded, check_chunks};
use super::axes::Axes;
use super::choice::{Listed, choose};
use super::found::{Found, Opened};
use super::packed;
use super::raw::{MAX_INFLATION, Raw};
use super::scaling;
use super::text_unit;
use hadar::cube::Shape;
use hadar::error::{Error, Result};
use hdf5_pure::{Datatype, Layout};
use std::fs::File;
use std::path::Path;

/// Opens a file whose first bytes have been seen.
pub(super) fn open(file: File, path: &Path, name: Option<&str>, axes: Option<Axes>) -> Result<Opened> {
    let len = file.metadata().map_err(damaged)?.len();
    let bytes = Bounded { file: file.try_clone().map_err(damaged)?, path: path.to_owned(), len };
    let source = sound(|| hdf5_pure::File::from_source(bytes).map_err(damaged))?;
    let (name, array) = sound(|| chosen(&source, name))?;
    let axes = match axes {
        None => {
            sound(|| dimensions::axes(&source, &name, &array)).map_err(|error| error.for_key(name.clone()))?
        }
        said => said,
    };
    sound(|| check_scaling(&source, &name, &array, len))?;
    let opened = of_array(file, path, len, array, axes).map_err(|error| error.for_key(name.clone()))?;
    let bands = opened.found.shape.bands();
    let axis = sound(|| Ok(BandAxis::of(&source, &name, bands, len)))?;
    let beside = || sound(|| Ok(unit_beside(&source, &name, len))).ok().flatten();
    let unit = opened.found.unit.clone().or_else(beside);
    let found = Found {
        variable: Some(name),
        unit,
        centres_cm1: axis.centres_cm1,
        widths_cm1: axis.widths_cm1,
        bad_bands: axis.bad,
        axis_without_unit: axis.unused,
        ..opened.found
    };
    Ok(Opened { found, ..opened })
}

/// Refuses a factor or an offset that is not applied: of the array, of a folder that it is in, or in an array beside it.
fn check_scaling(source: &hdf5_pure::File, name: &str, array: &Array, len: u64) -> Result<()> {
    let (folder, own) = name.rsplit_once('/').unwrap_or(("", name));
    let outer = name.match_indices('/').filter(|(place, _)| *place > 0).map(|(place, _)| &name[..place]);
    let groups = outer.filter_map(|outer| source.group(outer).ok()).chain([source.root()]);
    let of_groups = groups.map(|group| said(&group.attrs().unwrap_or_default()));
    array.attributes.check_scaling(own, of_groups).map_err(|error| error.for_key(name))?;
    let bands = array.sides.clone();
    for (other, dataset) in listed(source) {
        let (beside, last) = other.rsplit_once('/').unwrap_or(("", &other));
        if beside != folder || !scaling::is_named(last, own) {
            continue;
        }
        let count = |list: &Array| list.sides.iter().product::<usize>();
        let list = Array::of(dataset).ok().filter(|list| count(list) == 1 || bands.contains(&count(list)));
        if let Some(numbers) = list.and_then(|list| list.numbers(count(&list), len)) {
            scaling::check(last, own, &numbers)?;
        }
    }
    Ok(())
}

/// The array of this name, or the only one that can be meant.
fn chosen(source: &hdf5_pure::File, name: Option<&str>) -> Result<(String, Array)> {
    if let Some(name) = name {
        let Ok(dataset) = source.dataset(name) else {
            let names: Vec<String> = listed(source).into_iter().map(|(name, _)| name).collect();
            return Err(Error::unknown_name("variable", name, names.iter().map(String::as_str)));
        };
        let array = Array::of(dataset).and_then(Array::with_values);
        return array.map(|array| (name.to_owned(), array)).map_err(|error| error.for_key(name));
    }
    let (mut arrays, mut known, mut unread) = (Vec::new(), Vec::new(), Vec::new());
    for (name, dataset) in listed(source) {
        let of = |sides, stored, unread| Listed { name: name.clone(), sides, stored, unread };
        let kind = dataset.datatype();
        let is_number = matches!(kind, Ok(Datatype::FixedPoint { .. } | Datatype::FloatingPoint { .. }));
        let shape = dataset.shape().unwrap_or_default();
        match Array::of(dataset) {
            Ok(array) if array.sides.len() > 1 => {
                known.push(of(array.sides.clone(), array.stored.name(), None));
                arrays.push((name, array));
            }
            Err(error) if is_number && shape.len() > 1 => {
                let sides = shape.iter().map(|side| usize::try_from(*side).unwrap_or(usize::MAX)).collect();
                unread.push(of(sides, "numbers that are not read", Some(error)));
            }
            _ => {}
        }
    }
    // Those that can be read stand first, at their places.
    known.extend(unread);
    let Some((name, array)) = arrays.into_iter().nth(choose(&known, None)?) else {
        return Err(damaged("an array is lost"));
    };
    let array = array.with_values().map_err(|error| error.for_key(name.clone()))?;
    Ok((name, array))
}

/// The unit of the samples in a text beside their array, which MATLAB writes as an array of characters.
fn unit_beside(source: &hdf5_pure::File, array: &str, len: u64) -> Option<String> {
    let (folder, own) = array.rsplit_once('/').unwrap_or(("", array));
    let text = |(name, dataset): (String, hdf5_pure::Dataset)| {
        let (other, last) = name.rsplit_once('/').unwrap_or(("", &name));
        if other != folder || !text_unit::is_name(last, own) {
            return None;
        }
        let strings = || dataset.read_string().ok().filter(|all| all.len() == 1)?.pop();
        let text = match dataset.attrs().ok()?.contains_key("MATLAB_class") {
            true => Array::of(dataset).ok()?.text(text_unit::MOST, len),
            false => strings(),
        };
        text_unit::of(&text?)
    };
    listed(source).into_iter().find_map(text)
}

fn of_array(file: File, path: &Path, len: u64, array: Array, axes: Option<Axes>) -> Result<Opened> {
    let mut sides = array.sides.clone();
    if array.matlab && axes.is_some() && sides.len() == 2 {
        sides.push(1);
    }
    let said = axes.unwrap_or_default();
    let shape = said.shape(&sides)?;
    let order = if array.matlab { said.reversed() } else { said };
    let most = len.saturating_mul(MAX_INFLATION);
    let fits =
        |samples: u64| samples.checked_mul(array.stored.size() as u64).is_some_and(|bytes| bytes <= most);
    let chunk = match sound(|| array.dataset.layout().map_err(damaged))? {
        Layout::Contiguous { address: Some(start), .. } => {
            if start.saturating_add(Raw::bytes(shape, array.stored)) > len {
                return Err(damaged("it ends within the array"));
            }
            let found = found(&array, shape, axes, &sides);
            let Array { stored, little_endian, values, .. } = array;
            let cube =
                Raw { file, path: path.to_owned(), shape, start, order, stored, little_endian, values }
                    .cube();
            return Ok(Opened { found, cube });
        }
        Layout::Contiguous { address: None, .. } => return Err(damaged("the array was never written")),
        Layout::Chunked { chunk_shape, .. } => {
            sound(|| check_chunks(&array.dataset, len).map_err(damaged))?;
            if !fits(chunk_shape.iter().try_fold(1_u64, |n, side| n.checked_mul(*side)).unwrap_or(u64::MAX)) {
                return Err(damaged("a chunk announces more than the file can stand for"));
            }
            chunk_shape.first().copied().unwrap_or(1)
        }
        _ => 1,
    };
    if !fits(shape.len() as u64) {
        return Err(damaged("the array announces more than the file can stand for"));
    }
    let mut found = found(&array, shape, axes, &sides);
    let chunk = usize::try_from(chunk).unwrap_or(usize::MAX);
    let (cube, memory_bytes) = packed::cube(array, shape, order, chunk)?;
    found.memory_bytes = memory_bytes;
    Ok(Opened { found, cube })
}

fn found(array: &Array, shape: Shape, axes: Option<Axes>, sides: &[usize]) -> Found {
    let format = if array.matlab { "MATLAB 7.3" } else { "HDF5" };
    let unit = array.attributes.unit();
    let mut found = Found { axes, unit, ..Found::array(format, shape, array.stored.name(), sides) };
    array.values.iter().for_each(|values| values.tell(&mut found));
    found
}
