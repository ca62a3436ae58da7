//! The cubes of a calibration, opened.

use crate::Warning;
use crate::cube_bands::{InOrder, axes_in_doubt};
use hadar::cube::{Cube, Found};
use hadar::error::{Error, Result};
use hadar_scenario::Source;
use hadar_scenario::calibrate::Frames;

/// Cubes that are open.
#[derive(Debug)]
pub(super) struct Measured {
    pub(super) cubes: Vec<Cube>,
    /// What their files were read as.
    pub(super) read: Vec<Found>,
}

impl Measured {
    /// Opens every frame; errors name the file, and the key where it was named by one.
    pub(super) fn open(frames: &Frames, source: &Source) -> Result<Self> {
        let many = frames.data.len() > 1;
        let open = |(i, path): (usize, &std::path::PathBuf)| {
            let key = if many { format!("cube.data[{i}]") } else { "cube.data".to_owned() };
            let opened = InOrder::open(path, frames.variable.as_deref(), frames.axes);
            opened.map_err(|error| match (&error, &source.path) {
                (Error::At { place, .. }, Some(_)) if place.path.is_some() => error.for_key(key),
                (_, Some(_)) => error.at(source.place(&key)),
                (_, None) => error,
            })
        };
        let opened = frames.data.iter().enumerate().map(open).collect::<Result<Vec<InOrder>>>()?;
        let (cubes, read) = opened.into_iter().map(|opened| (opened.cube, opened.found)).unzip();
        Ok(Self { cubes, read })
    }

    /// What is not sure of their axes.
    pub(super) fn warnings(&self) -> Vec<Warning> {
        self.read.first().and_then(|found| axes_in_doubt(found, None)).into_iter().collect()
    }
}
