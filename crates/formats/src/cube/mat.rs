//! MATLAB files of version 5: which arrays there are, and which of them is the cube.
//!
//! A file is a header of 128 bytes and then elements, each a tag (type and bytes) and its content; an array is an
//! element of subelements (flags, dimensions, name, numbers), or a zlib stream of one. Only the array that is asked
//! for is read, and lists of wavelengths or wavenumbers of its bands. Nothing in the file is believed before it fits into the element
//! that holds it.
//!
//! Source: MathWorks, 'MAT-File Format' (R2025a), level 5.

mod element;
mod write;

pub use write::mat_file;

use self::element::{COMPRESSED, Class, Element, Head, MATRIX};
use super::arrange;
use super::axes::Axes;
use super::band_list;
use super::found::{Found, Opened};
use super::scaling;
use super::text_unit;
use hadar::cube::{Cube, MemoryCube, Sample, Shape};
use hadar::error::{Error, Result};
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};

/// Bytes before the first element.
const HEADER: u64 = 128;

/// An array of the file, and where it is.
#[derive(Debug)]
struct Variable {
    head: Head,
    compressed: bool,
    /// Place and bytes of its content.
    place: u64,
    len: u64,
}

/// Opens a file whose header has been seen.
pub(super) fn open(
    file: File,
    little_endian: bool,
    name: Option<&str>,
    axes: Option<Axes>,
) -> Result<Opened> {
    let variables = directory(&file, little_endian)?;
    let chosen = choose(&variables, name)?;
    let head = &chosen.head;
    let of_variable = |error: Error| error.for_key(head.name.clone());
    let class = numeric(head).map_err(of_variable)?;
    let mut sides: Vec<usize> = head.dimensions.iter().map(|side| *side as usize).collect();
    // MATLAB drops a last dimension of 1.
    if axes.is_some() && sides.len() == 2 {
        sides.push(1);
    }
    let said = axes.unwrap_or_default();
    let shape = said.shape(&sides).map_err(of_variable)?;
    let content = content(&file, chosen)?;
    let mut element = Element::of(content, chosen.compressed, chosen.len, little_endian)?;
    // The head again, to come to the numbers.
    element.head()?;
    // The first index runs fastest.
    let order = said.reversed();
    let cube = match class.is_double() {
        true => samples::<f64>(&mut element, shape, order).map(Cube::from),
        false => samples::<f32>(&mut element, shape, order).map(Cube::from),
    }
    .map_err(of_variable)?;
    let bytes = shape.len() as u64 * if class.is_double() { 8 } else { 4 };
    let lists = |is_meant: &dyn Fn(&str) -> bool, lengths: &[usize]| {
        lists(&file, &variables, is_meant, lengths, little_endian)
    };
    for (name, numbers) in lists(&|name| scaling::is_named(name, &head.name), &[1, shape.bands()]) {
        scaling::check(&name, &head.name, &numbers)?;
    }
    let is_axis = |name: &str| band_list::unit(name, None).is_some();
    let (centres_cm1, axis_without_unit) = band_list::centres(&lists(&is_axis, &[shape.bands()]))?;
    let found = Found {
        variable: Some(head.name.clone()),
        memory_bytes: Some(bytes),
        axes,
        centres_cm1,
        axis_without_unit,
        unit: unit(&file, &variables, &head.name, little_endian),
        ..Found::array("MATLAB 5", shape, class.name(), &sides)
    };
    Ok(Opened { cube, found })
}

fn samples<S: Sample>(element: &mut Element<impl Read>, shape: Shape, order: Axes) -> Result<MemoryCube<S>> {
    let stored = element.numbers(shape.len() as u64)?;
    let samples = arrange::whole(shape, order, |slices: &mut [S]| element.fill(stored, slices))?;
    element.finish()?;
    MemoryCube::new(shape, samples)
}

/// Lists of so many numbers, by their names.
fn lists(
    file: &File,
    variables: &[Variable],
    is_meant: &dyn Fn(&str) -> bool,
    lengths: &[usize],
    little_endian: bool,
) -> Vec<(String, Vec<f64>)> {
    let list = |variable: &Variable| {
        let head = &variable.head;
        let sides: Vec<usize> = head.dimensions.iter().map(|side| *side as usize).collect();
        numeric(head).ok().filter(|_| is_meant(&head.name))?;
        let count = *lengths.iter().find(|length| band_list::is_list(&sides, **length))?;
        let content = content(file, variable).ok()?;
        let mut element = Element::of(content, variable.compressed, variable.len, little_endian).ok()?;
        element.head().ok()?;
        let stored = element.numbers(count as u64).ok()?;
        let mut numbers = vec![0.0_f64; count];
        element.fill(stored, &mut numbers).ok()?;
        Some((head.name.clone(), numbers))
    };
    variables.iter().filter_map(list).collect()
}

/// The unit of the samples, in a text beside them.
fn unit(file: &File, variables: &[Variable], of_array: &str, little_endian: bool) -> Option<String> {
    let text = |variable: &Variable| {
        let Head { name, class, dimensions, .. } = &variable.head;
        let is_short =
            dimensions.iter().map(|side| u64::from(*side)).product::<u64>() <= text_unit::MOST as u64;
        if !text_unit::is_name(name, of_array) || !class.is_some_and(Class::is_text) || !is_short {
            return None;
        }
        let content = content(file, variable).ok()?;
        let mut element = Element::of(content, variable.compressed, variable.len, little_endian).ok()?;
        element.head().ok()?;
        text_unit::of(&element.text()?)
    };
    variables.iter().find_map(text)
}

fn content<'a>(mut file: &'a File, variable: &Variable) -> Result<impl Read + use<'a>> {
    file.seek(SeekFrom::Start(variable.place)).map_err(element::unreadable)?;
    Ok(BufReader::with_capacity(1 << 16, file.take(variable.len)))
}

/// All arrays of a file, without their numbers.
fn directory(file: &File, little_endian: bool) -> Result<Vec<Variable>> {
    let len = file.metadata().map_err(element::unreadable)?.len();
    let mut variables = Vec::new();
    let mut place = HEADER;
    while place < len {
        if len - place < 8 {
            return Err(element::damaged("the file ends within the tag of an array"));
        }
        (&mut &*file).seek(SeekFrom::Start(place)).map_err(element::unreadable)?;
        let mut tag = [0; 8];
        (&mut &*file).read_exact(&mut tag).map_err(element::unreadable)?;
        let [kind, bytes] = element::words(tag, little_endian);
        if kind != MATRIX && kind != COMPRESSED {
            return Err(element::damaged(&format!(
                "where an array should begin there is an element of type {kind}"
            )));
        }
        place += 8;
        if u64::from(bytes) > len - place {
            return Err(element::damaged(&format!(
                "the file has {} of the {bytes} bytes of its array number {}",
                len - place,
                variables.len() + 1
            )));
        }
        let mut variable =
            Variable { head: Head::default(), compressed: kind == COMPRESSED, place, len: u64::from(bytes) };
        let content = content(file, &variable)?;
        variable.head = Element::of(content, variable.compressed, variable.len, little_endian)?.head()?;
        place += variable.len;
        variables.push(variable);
    }
    Ok(variables)
}

/// The variable of this name, or the only one that can be meant.
fn choose<'a>(variables: &'a [Variable], name: Option<&str>) -> Result<&'a Variable> {
    let list = |variables: &[&Variable]| {
        let each = variables.iter().map(|variable| variable.head.to_string()).collect::<Vec<_>>();
        each.join(", ")
    };
    // MATLAB keeps what objects need in an array without a name.
    let all: Vec<&Variable> = variables.iter().filter(|variable| !variable.head.name.is_empty()).collect();
    if let Some(name) = name {
        return all.iter().find(|variable| variable.head.name == name).copied().ok_or_else(|| {
            let instead = if all.is_empty() { "none".to_owned() } else { list(&all) };
            Error::malformed(format!("there is no variable `{name}`"), format!("the file has {instead}"))
        });
    }
    let numeric: Vec<&Variable> =
        all.iter().filter(|variable| variable.head.class.is_some_and(Class::is_numeric)).copied().collect();
    let cubes: Vec<&Variable> =
        numeric.iter().filter(|variable| variable.head.dimensions.len() == 3).copied().collect();
    match (cubes.as_slice(), numeric.as_slice()) {
        ([only], _) | ([], [only]) => Ok(only),
        ([], []) => {
            let found = if all.is_empty() { "no variable".to_owned() } else { list(&all) };
            Err(Error::malformed(
                format!("the file has {found}, but no array of numbers"),
                "save the cube as a double or single array [row][column][band]",
            ))
        }
        ([], several) | (several, _) => Err(Error::malformed(
            format!("the file has {} arrays that may be meant: {}", several.len(), list(several)),
            "name one of them as the variable",
        )),
    }
}

/// What the numbers are.
fn numeric(head: &Head) -> Result<Class> {
    let refused = |what: &str| {
        Error::malformed(
            format!("the variable is {what}"),
            "save the cube as a double or single array [row][column][band]",
        )
    };
    let class = head.class.filter(|class| class.is_numeric()).ok_or_else(|| refused(&head.class_name()))?;
    match (head.complex, head.logical) {
        (true, _) => Err(refused("complex")),
        (_, true) => Err(refused("logical")),
        _ => Ok(class),
    }
}

#[cfg(test)]
mod tests;
