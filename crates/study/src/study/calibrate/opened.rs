//! The cubes of a calibration, opened.

use crate::scenario::Source;
use crate::scenario::calibrate::Frames;
use hadar::cube::Cube;
use hadar::error::{Error, Result};

/// Opens every frame; errors name the file, and the key where it was named by one.
pub(super) fn opened(frames: &Frames, source: &Source) -> Result<Vec<Cube>> {
    let many = frames.data.len() > 1;
    let open = |(i, path): (usize, &std::path::PathBuf)| {
        let key = if many { format!("cube.data[{i}]") } else { "cube.data".to_owned() };
        Cube::open(path, frames.variable.as_deref()).map_err(|error| match (&error, &source.path) {
            (Error::At { place, .. }, Some(_)) if place.path.is_some() => error.for_key(key),
            (_, Some(_)) => error.at(source.place(&key)),
            (_, None) => error,
        })
    };
    frames.data.iter().enumerate().map(open).collect()
}
