//! Files to values: what `hadar` computes with, read from the files of a user.
//!
//! * [`cube`]: heat cubes, NPY, NPZ, ENVI, MATLAB, FITS, TIFF, Zarr, NetCDF, radiometric files of cameras, HDF5 and NetCDF-4 (feature `hdf5`,
//!   which is a default);
//! * [`spectra`]: emissivities, in CSV and other text, ECOSTRESS, USGS, RELAB, JCAMP-DX, ENVI, SPC, OPUS and ASD files, and radiances;
//!   [`ReadLibrary`] adds those of a file, a folder or a manifest to a library, [`members`] reads those of a class;
//! * [`bands`] and [`filters`]: where a camera's bands are, and what its filters transmit;
//! * [`noise_variance`]: the electronic noise of a cube.
//!
//! ```no_run
//! use hadar_formats::cube;
//!
//! let street = cube::open("street.npy".as_ref(), None)?;
//! let noise = hadar_formats::noise_variance("read_noise.csv".as_ref(), street.shape(), None)?;
//! # Ok::<(), hadar::Error>(())
//! ```

mod bands;
pub mod cube;
pub mod envi_header;
pub mod file;
mod foreign;
pub mod hash;
mod library;
mod members;
mod noise_variance;
pub mod spectra;
pub mod spectral_unit;

pub use bands::{bands, filter_curves, filters, listed_bands};
pub use library::ReadLibrary;
pub use members::{Class, Member, members};
pub use noise_variance::noise_variance;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
