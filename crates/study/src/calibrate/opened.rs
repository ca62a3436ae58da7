//! The cubes of a calibration, opened.

use crate::Warning;
use crate::cube_bad::{BadBand, bands_found, bands_without_readings};
use crate::cube_bands::{InOrder, axes_in_doubt};
use hadar::cube::Cube;
use hadar::error::{Error, Result};
use hadar_formats::cube::Found;
use hadar_scenario::Source;
use hadar_scenario::calibrate::Frames;

/// Cubes that are open.
#[derive(Debug)]
pub(super) struct Measured {
    pub(super) cubes: Vec<Cube>,
    /// What their files were read as.
    pub(super) read: Vec<Found>,
    /// Bands without readings, as was found, in rising wavenumber.
    pub(super) found_bad: Vec<BadBand>,
    /// The bands that are looked at, in rising wavenumber.
    pub(super) good: Vec<usize>,
}

impl Measured {
    /// Opens every frame; errors name the file, and the key where it was named by one.
    pub(super) fn open(frames: &Frames, source: &Source) -> Result<Self> {
        let many = frames.data.len() > 1;
        let open = |(i, path): (usize, &std::path::PathBuf)| {
            let key = if many { format!("cube.data[{i}]") } else { "cube.data".to_owned() };
            let opened = InOrder::open(path, frames.variable.as_deref(), frames.axes, None);
            opened.map_err(|error| match (&error, &source.path) {
                (Error::At { place, .. }, Some(_)) if place.path.is_some() => error.for_key(key),
                (_, Some(_)) => error.at(source.place(&key)),
                (_, None) => error,
            })
        };
        let opened = frames.data.iter().enumerate().map(open).collect::<Result<Vec<InOrder>>>()?;
        let at = |error: Error| match &source.path {
            Some(_) => error.at(source.place("cube.bad_bands")),
            None => error,
        };
        let (mut bad, mut found_bad) = (Vec::new(), Vec::<BadBand>::new());
        for one in &opened {
            bad.extend(one.bad_bands(&frames.bad_bands).map_err(at)?);
        }
        for one in &opened {
            let known: Vec<usize> = bad.iter().copied().chain(found_bad.iter().map(|one| one.band)).collect();
            found_bad.extend(bands_without_readings(&one.cube, &known)?);
        }
        found_bad.sort_by_key(|one| one.band);
        let bands = opened.first().map_or(0, |one| one.order.len());
        bad.extend(found_bad.iter().map(|one| one.band));
        let (cubes, read) = opened.into_iter().map(|opened| (opened.cube, opened.found)).unzip();
        Ok(Self { cubes, read, found_bad, good: (0..bands).filter(|band| !bad.contains(band)).collect() })
    }

    /// What is not sure of their axes.
    pub(super) fn warnings(&self) -> Vec<Warning> {
        let doubt = self.read.first().and_then(|found| axes_in_doubt(found, None));
        doubt.into_iter().chain(bands_found(&self.found_bad)).collect()
    }
}
