//! Which of a file's arrays is the cube.

use hadar::error::{Error, Result};

/// An array of numbers of a file.
#[derive(Debug, Clone)]
pub(super) struct Listed {
    pub(super) name: String,
    pub(super) sides: Vec<usize>,
    /// How its numbers are stored, `f32`.
    pub(super) stored: &'static str,
    /// Why it cannot be read, if it cannot: it may be meant all the same.
    pub(super) unread: Option<Error>,
}

impl Listed {
    /// Why it is no cube.
    fn check(&self) -> Result<()> {
        let of = |error: Error| if self.name.is_empty() { error } else { error.for_key(self.name.clone()) };
        match (&self.unread, self.sides.len()) {
            (Some(error), _) => Err(of(error.clone())),
            (None, 2 | 3) => Ok(()),
            (None, dimensions) => {
                let found = format!("the array has {dimensions} dimensions ({})", self.shown_sides());
                let instead = "write it with [row][column][band], as np.squeeze leaves it where the others are 1, or name another variable";
                Err(of(Error::malformed(found, instead)))
            }
        }
    }

    fn shown_sides(&self) -> String {
        let sides: Vec<String> = self.sides.iter().map(usize::to_string).collect();
        sides.join(" x ")
    }
}

/// The place of the array of this name, or of the only one that can be meant: the only one in three dimensions or more, else in two. One that
/// cannot be read is not passed over for another.
///
/// # Errors
/// No such name, no such array, several, or one that cannot be read.
pub(super) fn choose(arrays: &[Listed], name: Option<&str>) -> Result<usize> {
    if let Some(name) = name {
        let place = arrays.iter().position(|array| array.name == name);
        let known = arrays.iter().map(|array| array.name.as_str());
        let place = place.ok_or_else(|| Error::unknown_name("variable", name, known))?;
        return arrays[place].check().map(|()| place);
    }
    let is_deep = |array: &Listed| array.sides.len() > 2;
    let any = arrays.iter().any(is_deep);
    let is_meant = |array: &&Listed| if any { is_deep(array) } else { array.sides.len() == 2 };
    let mut meant = arrays.iter().enumerate().filter(|(_, array)| is_meant(array));
    match (meant.next(), meant.next()) {
        (Some((place, array)), None) => array.check().map(|()| place),
        (None, _) => Err(Error::malformed(
            "the file has no array of numbers in two or three dimensions",
            "write the cube as one of floats or whole numbers",
        )),
        _ => {
            let shown: Vec<String> = arrays
                .iter()
                .filter(|array| array.sides.len() > 1)
                .map(|array| format!("`{}` ({} {})", array.name, array.shown_sides(), array.stored))
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
