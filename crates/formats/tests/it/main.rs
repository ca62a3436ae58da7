//! Tests of the readers of files, seen from outside.

mod cubes;
mod materials;
mod spectra;
