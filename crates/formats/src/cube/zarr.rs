//! Zarr arrays of versions 2 and 3, in folders: by blocks of rows where rows are their first dimension.
//!
//! A folder with `.zarray` or `zarr.json` is an array, one with `.zgroup` or a `zarr.json` of a group holds some. Its numbers are in chunks, a file
//! each; chunks at the border are whole. A chunk that is not there was never written: its samples are missing, whatever they would be filled with. Of
//! xarray the names of the dimensions and the attributes of NetCDF are read.
//!
//! Source: Zarr storage specification 2; Zarr core specification 3.0.

mod blosc;
mod codecs;
mod meta;
mod streams;

use self::meta::{Meta, damaged};
use super::axes::Axes;
use super::band_list;
use super::choice::{Listed, choose};
use super::found::{Found, Opened};
use super::names::is_zarr;
use super::packed::{self, Slices};
use super::stored::{Stored, decode};
use super::values::Values;
use crate::hash::stamp;
use hadar::cube::Sample;
use hadar::error::{Error, Result};
use hadar::inputs::{self, Held};
use std::path::{Path, PathBuf};

/// Groups within groups, and arrays, that are looked at.
const MOST_DEPTH: usize = 8;
const MOST_ARRAYS: usize = 1000;
/// Chunks of an array.
const MOST_CHUNKS: usize = 1_000_000;

/// An array, and where its chunks are.
#[derive(Debug)]
struct Array {
    folder: PathBuf,
    meta: Meta,
    values: Option<Values>,
}

/// Opens the folder of an array or a group.
pub(super) fn open(path: &Path, name: Option<&str>, axes: Option<Axes>) -> Result<Opened> {
    inputs::folder(path);
    let mut arrays: Vec<(String, PathBuf, Meta)> = Vec::new();
    let mut unread: Vec<Listed> = Vec::new();
    within(path, "", MOST_DEPTH, &mut arrays, &mut unread)?;
    let mut listed: Vec<Listed> = arrays
        .iter()
        .map(|(name, _, meta)| Listed {
            name: name.clone(),
            sides: meta.sides.clone(),
            stored: meta.stored.name(),
            unread: None,
        })
        .collect();
    // Those that can be read stand first, at their places.
    listed.extend(unread);
    let lone = listed.len() == 1 && listed.iter().all(|array| array.name.is_empty());
    if lone && name.is_some() {
        return Err(Error::malformed("the folder is one array, which has no name", "leave the variable out"));
    }
    let place = choose(&listed, name)?;
    let Some((name, folder, meta)) = arrays.get(place).cloned() else {
        return Err(damaged("an array is lost"));
    };
    let of_array = |error: Error| if name.is_empty() { error } else { error.for_key(name.clone()) };
    let by_name = || {
        let [a, b, c] = meta.dimensions.as_slice() else { return None };
        Axes::of_dimensions([a, b, c])
    };
    let axes = axes.or_else(by_name);
    let order = axes.unwrap_or_default();
    let shape = order.shape(&meta.sides).map_err(of_array)?;
    let outer = folder.ancestors().skip(1).take_while(|outer| outer.starts_with(path));
    let groups = outer.map(meta::of_group).collect::<Result<Vec<_>>>()?;
    let own = name.rsplit('/').next().unwrap_or_default();
    meta.attributes.check_scaling(own, groups).map_err(of_array)?;
    let values = meta.values().map_err(of_array)?;
    let found = Found::array(meta.version, shape, meta.stored.name(), &meta.sides);
    let variable = (!name.is_empty()).then(|| name.clone());
    let mut found = Found { variable, axes, unit: meta.attributes.unit(), ..found };
    values.iter().for_each(|values| values.tell(&mut found));
    let chunk = meta.chunk.first().copied().unwrap_or(1);
    let array = Array { folder, meta, values };
    let (absent, of) = array.noted().map_err(of_array)?;
    if absent == of {
        return Err(of_array(damaged("none of its chunks is there")));
    }
    (found.centres_cm1, found.axis_without_unit) = band_axis(&arrays, place, shape.bands());
    found.absent_chunks = absent;
    let (cube, memory_bytes) = packed::cube(array, shape, order, chunk).map_err(of_array)?;
    found.memory_bytes = memory_bytes;
    Ok(Opened { cube, found })
}

/// All arrays below a folder by their paths, those of numbers that cannot be read apart; the only one of a folder that is an array has no name.
fn within(
    folder: &Path,
    name: &str,
    depth: usize,
    arrays: &mut Vec<(String, PathBuf, Meta)>,
    unread: &mut Vec<Listed>,
) -> Result<()> {
    match Meta::of_folder(folder) {
        Ok(Some(meta)) => {
            arrays.push((name.to_owned(), folder.to_owned(), meta));
            return Ok(());
        }
        Err(error) if name.is_empty() => return Err(error),
        Err(error) => {
            // Texts and the like are no cubes.
            let (name, stored) = (name.to_owned(), "numbers that are not read");
            let of_numbers = Meta::sides_of_numbers(folder);
            unread.extend(of_numbers.map(|sides| Listed { name, sides, stored, unread: Some(error) }));
            return Ok(());
        }
        Ok(None) => {}
    }
    let failed = |error: std::io::Error| damaged(format!("{}: {error}", folder.display()));
    let mut inner = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if is_zarr(&path) {
            inner.push(path);
        }
    }
    inner.sort();
    for path in inner {
        let own = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        if depth > 0 && arrays.len() < MOST_ARRAYS {
            let path_name = if name.is_empty() { own } else { format!("{name}/{own}") };
            within(&path, &path_name, depth - 1, arrays, unread)?;
        }
    }
    Ok(())
}

/// Centres of the bands, cm⁻¹, by a list beside the cube or an attribute of it; and whether there is only one whose unit is not known.
fn band_axis(arrays: &[(String, PathBuf, Meta)], cube: usize, bands: usize) -> (Option<Vec<f64>>, bool) {
    let folder = |name: &str| name.rsplit_once('/').map_or("", |(folder, _)| folder).to_owned();
    let own = arrays.get(cube).map_or_else(String::new, |(name, ..)| folder(name));
    let mut unused = false;
    for (name, path, meta) in arrays {
        let last = name.rsplit('/').next().unwrap_or(name);
        if meta.sides != [bands] || folder(name) != own {
            continue;
        }
        let array = Array { folder: path.clone(), meta: meta.clone(), values: None };
        let read = || {
            let mut numbers = vec![0.0_f64; bands];
            array.slices(0, bands, &mut numbers).is_ok().then_some(numbers)
        };
        match band_list::of_array(last, &meta.attributes, meta.stored, read) {
            Some(Some(centres)) => return (Some(centres), false),
            list => unused |= list.is_some(),
        }
    }
    let (centres, unknown) = match arrays.get(cube) {
        Some((_, _, meta)) => band_list::of_attributes(&meta.attributes, bands),
        None => (None, false),
    };
    let unused = centres.is_none() && (unused || unknown);
    (centres, unused)
}

impl Array {
    /// How many chunks there are along each dimension.
    fn counts(&self) -> Vec<usize> {
        self.meta.sides.iter().zip(&self.meta.chunk).map(|(side, chunk)| side.div_ceil(*chunk)).collect()
    }

    /// Notes the chunks that are there as they are now: how many are not, of how many.
    ///
    /// # Errors
    /// More than anybody has.
    fn noted(&self) -> Result<(usize, usize)> {
        let counts = self.counts();
        let all = counts.iter().try_fold(1_usize, |all, count| all.checked_mul(*count));
        let Some(all) = all.filter(|all| *all <= MOST_CHUNKS) else {
            return Err(damaged(format!("it announces more than {MOST_CHUNKS} chunks")));
        };
        let mut there = Vec::new();
        for number in 0..all {
            hadar::stop::check();
            let path = self.folder.join(self.meta.key(&places(number, &counts)));
            if let Some(found) = path.metadata().ok().filter(std::fs::Metadata::is_file) {
                there.push((path, Held::Since(stamp(&found))));
            }
        }
        let absent = all - there.len();
        inputs::files(there);
        Ok((absent, all))
    }

    /// The numbers of a chunk, in the order of the array's dimensions; none of one that is not there.
    fn chunk<S: Sample>(&self, place: &[usize]) -> Result<Option<Vec<S>>> {
        let path = self.folder.join(self.meta.key(place));
        let packed = match std::fs::read(&path) {
            Ok(packed) => packed,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(damaged(format!("{}: {error}", path.display()))),
        };
        let count: usize = self.meta.chunk.iter().product();
        let bytes = codecs::unpacked(packed, &self.meta.codecs, count * self.meta.stored.size())
            .map_err(|error| damaged(format!("chunk {}: {error}", self.meta.key(place))))?;
        let mut numbers = vec![S::zeroed(); count];
        decode(&bytes, self.meta.stored, self.meta.little_endian, &mut numbers);
        if self.meta.fastest_first && self.meta.chunk.len() > 1 {
            let reversed: Vec<usize> = self.meta.chunk.iter().rev().copied().collect();
            let mut turned = numbers.clone();
            for (number, out) in turned.iter_mut().enumerate() {
                let place: Vec<usize> = places(number, &self.meta.chunk).into_iter().rev().collect();
                *out = numbers.get(index(&place, &reversed)).copied().unwrap_or(S::of(f64::NAN));
            }
            return Ok(Some(turned));
        }
        Ok(Some(numbers))
    }
}

impl Slices for Array {
    fn stored(&self) -> Stored {
        self.meta.stored
    }

    fn values(&self) -> Option<&Values> {
        self.values.as_ref()
    }

    fn slices<S: Sample>(&self, first: usize, count: usize, out: &mut [S]) -> Result<()> {
        let (sides, chunk) = (&self.meta.sides, &self.meta.chunk);
        let counts = self.counts();
        let (Some(height), Some(inner)) = (chunk.first(), counts.get(1..)) else {
            return Err(damaged("an array without dimensions"));
        };
        // Slices of an array of one dimension are its numbers.
        let within: usize = sides.iter().skip(1).product();
        let across: usize = inner.iter().product();
        for outer in first / height..(first + count).div_ceil(*height) {
            for number in 0..across {
                hadar::stop::check();
                let mut place = vec![outer];
                place.extend(places(number, inner));
                let numbers: Option<Vec<S>> = self.chunk(&place)?;
                let begins: Vec<usize> = place.iter().zip(chunk).map(|(place, side)| place * side).collect();
                let extents: Vec<usize> = begins
                    .iter()
                    .zip(chunk)
                    .zip(sides)
                    .map(|((begin, chunk), side)| (*chunk).min(side - begin))
                    .collect();
                // Runs along the last dimension.
                let run = if sides.len() == 1 { 1 } else { extents.last().copied().unwrap_or(1) };
                let lines: usize = extents.iter().product::<usize>() / run.max(1);
                let grid: Vec<usize> = if sides.len() == 1 {
                    extents.clone()
                } else {
                    extents.iter().rev().skip(1).rev().copied().collect()
                };
                for line in 0..lines {
                    let mut at = places(line, &grid);
                    if sides.len() > 1 {
                        at.push(0);
                    }
                    let row = begins[0] + at[0];
                    if !(first..first + count).contains(&row) {
                        continue;
                    }
                    let mut to: Vec<usize> = begins.iter().zip(&at).map(|(begin, at)| begin + at).collect();
                    to[0] = row - first;
                    let to = index(&to, sides);
                    let Some(target) = out.get_mut(to..to + run) else {
                        return Err(damaged("a chunk beyond the array"));
                    };
                    match numbers.as_ref().and_then(|numbers| numbers.get(index(&at, chunk)..)?.get(..run)) {
                        Some(own) => target.copy_from_slice(own),
                        None => target.fill(S::of(f64::NAN)),
                    }
                }
            }
        }
        debug_assert!(out.len() >= count * within);
        Ok(())
    }
}

/// Places along each side of a number that counts them all, the last side the fastest.
fn places(mut number: usize, sides: &[usize]) -> Vec<usize> {
    let mut places = vec![0; sides.len()];
    for (place, side) in places.iter_mut().zip(sides).rev() {
        (*place, number) = (number % side.max(&1), number / side.max(&1));
    }
    places
}

/// The other way round.
fn index(places: &[usize], sides: &[usize]) -> usize {
    places.iter().zip(sides).fold(0, |index, (place, side)| index * side + place)
}
