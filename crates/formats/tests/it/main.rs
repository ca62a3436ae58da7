//! Tests of the readers of files, seen from outside.

mod cubes;
mod cubes_of_cameras;
mod materials;
mod spectra;
