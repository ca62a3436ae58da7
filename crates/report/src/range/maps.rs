//! Maps of the bounds as NPY files: those that are kept, and those of cubes that are too large for it.

use crate::bundle::Bundle;
use crate::folder::Scratch;
use hadar::cube::Shape;
use hadar::error::{Error, Result};
use hadar_formats::cube::{NpyRows, npy_map, write_npy_to};
use hadar_study::range::{MapSink, Ranging, Signal};
use std::sync::OnceLock;

/// Maps that are written as their rows come, until the report takes them.
#[derive(Debug)]
pub struct MapFiles {
    scratch: Scratch,
    files: OnceLock<Vec<(Signal, NpyRows<f64>)>>,
}

impl MapFiles {
    /// Room for maps.
    #[must_use]
    pub const fn new(scratch: Scratch) -> Self {
        Self { scratch, files: OnceLock::new() }
    }
}

impl MapSink for MapFiles {
    fn begin(&self, signals: &[Signal], rows: usize, columns: usize) -> Result<()> {
        let create = |signal: &Signal| {
            let path = self.scratch.place().join(file_name(*signal));
            Ok((*signal, NpyRows::create(&path, &[rows, columns, 1])?))
        };
        let files = signals.iter().map(create).collect::<Result<_>>()?;
        self.files.set(files).map_err(|_| Error::malformed("maps begun twice", "report this as a bug"))
    }

    fn put(&self, signal: Signal, first: usize, disparity_error_px: &[f64]) -> Result<()> {
        match self.files.get().into_iter().flatten().find(|(own, _)| *own == signal) {
            Some((_, file)) => file.write(first, disparity_error_px),
            None => Err(Error::malformed("a map that was not begun", "report this as a bug")),
        }
    }
}

fn file_name(signal: Signal) -> String {
    format!("disparity_error_px_{}.npy", signal.key())
}

/// The maps of all windows.
pub(super) fn add_maps(bundle: &mut Bundle, result: &Ranging, large: Option<&MapFiles>) -> Result<()> {
    for view in &result.bad {
        let size = [result.shape.rows(), result.shape.columns()];
        bundle.add(format!("bad_pixels_{}.npy", view.view), npy_map(&size, &view.map)?);
    }
    if let Some(files) = large.and_then(|large| large.files.get()) {
        for (signal, file) in files {
            bundle.add_file(file_name(*signal), file.path());
        }
        return Ok(());
    }
    let maps = &result.maps;
    let Ok(shape) = Shape::new(maps.rows.len(), maps.columns.len(), 1) else { return Ok(()) };
    for (signal, values) in &maps.disparity_error_px {
        let mut file = Vec::new();
        write_npy_to(&mut file, shape, values)?;
        bundle.add(file_name(*signal), file);
    }
    Ok(())
}
