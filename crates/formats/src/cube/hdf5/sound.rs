//! The reader of the format held in: neither its errors nor its panics are those of the program.

use super::source::step;
use hadar::error::{Error, Result};
use hadar::stop::unless_it_panics;

/// What the reader of the format does, without its panics: there are files that it was not made for, and a user's is only
/// refused.
pub(super) fn sound<T>(work: impl FnOnce() -> Result<T>) -> Result<T> {
    step();
    unless_it_panics(work).unwrap_or_else(|| Err(damaged("its parts do not fit together")))
}

/// A file that cannot be read.
pub(super) fn damaged(error: impl std::fmt::Display) -> Error {
    let instead = "write or copy it again, or write the cube with np.save('cube.npy', a)";
    Error::malformed(format!("the HDF5 file cannot be read: {error}"), instead)
}
