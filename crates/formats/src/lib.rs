//! Files to values: what `hadar` computes with, read from the files of a user.
//!
//! * [`cube`]: heat cubes, NPY, NPZ, ENVI, MATLAB, HDF5 and NetCDF-4 (feature `hdf5`, which is a default);
//! * [`noise_variance`]: the electronic noise of a cube.
//!
//! ```no_run
//! use hadar_formats::cube;
//!
//! let street = cube::open("street.npy".as_ref(), None)?;
//! let noise = hadar_formats::noise_variance("read_noise.csv".as_ref(), street.shape())?;
//! # Ok::<(), hadar::Error>(())
//! ```

pub mod cube;
mod noise_variance;

pub use noise_variance::noise_variance;
