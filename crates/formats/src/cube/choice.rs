//! Which of a file's arrays is the cube.

use hadar::error::{Error, Result};

/// An array of numbers of a file.
#[derive(Debug, Clone)]
pub(super) struct Listed {
    pub(super) name: String,
    pub(super) sides: Vec<usize>,
    /// How its numbers are stored, `f32`.
    pub(super) stored: &'static str,
}

/// The place of the array of this name, or of the only one that can be meant: the only one in three dimensions, else in two.
///
/// # Errors
/// No such name, no such array, or several.
pub(super) fn choose(arrays: &[Listed], name: Option<&str>) -> Result<usize> {
    if let Some(name) = name {
        let place = arrays.iter().position(|array| array.name == name);
        let known = arrays.iter().map(|array| array.name.as_str());
        return place.ok_or_else(|| Error::unknown_name("variable", name, known));
    }
    let places = |sides: usize| {
        arrays.iter().enumerate().filter(move |(_, array)| array.sides.len() == sides).map(|(place, _)| place)
    };
    let count = if places(3).next().is_some() { 3 } else { 2 };
    let mut meant = places(count);
    match (meant.next(), meant.next()) {
        (Some(place), None) => Ok(place),
        (None, _) => Err(Error::malformed(
            "the file has no array of numbers in two or three dimensions",
            "write the cube as one of floats or whole numbers",
        )),
        _ => {
            let shown: Vec<String> = arrays
                .iter()
                .filter(|array| matches!(array.sides.len(), 2 | 3))
                .map(|Listed { name, sides, stored }| {
                    let sides: Vec<String> = sides.iter().map(usize::to_string).collect();
                    format!("`{name}` ({} {stored})", sides.join(" x "))
                })
                .collect();
            let found =
                format!("the file has {} arrays that may be meant: {}", shown.len(), shown.join(", "));
            Err(Error::malformed(found, "name one of them as the variable"))
        }
    }
}

/// The number of the frame that is named, of so many; the only one needs no name.
///
/// # Errors
/// Several and no name, or none of this number.
pub(super) fn one_of_frames(name: Option<&str>, frames: usize) -> Result<usize> {
    let last = frames.saturating_sub(1);
    match name {
        None if frames == 1 => Ok(0),
        None => Err(Error::malformed(
            format!("the file has {frames} frames"),
            format!("name one by its number, from variable = \"0\" to \"{last}\""),
        )),
        Some(name) => name.parse().ok().filter(|number| *number < frames).ok_or_else(|| {
            Error::malformed(
                format!("there is no frame `{}`", name.escape_debug()),
                format!("count from 0 up to {last}"),
            )
        }),
    }
}
