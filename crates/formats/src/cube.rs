//! Heat cubes from files and to files: NPY, NPZ, ENVI, MATLAB, HDF5, NetCDF, Zarr, FITS, TIFF and radiometric files of cameras.
//!
//! From a file: [`open`], or [`open_as`], which says what the file was read as; to one: [`write_npy`], or by rows [`NpyRows`],
//! [`envi_files`] and [`mat_file`]. A cube that is not packed is left in its file and read by rows where they are asked for.

mod arrange;
mod attributes;
mod axes;
mod band_list;
mod blocks;
mod choice;
mod envi;
mod fits;
mod flir;
mod found;
#[cfg(feature = "tiff")]
mod geotiff;
#[cfg(feature = "hdf5")]
mod hdf5;
mod image;
mod mat;
mod names;
mod netcdf3;
mod npy;
mod npy_rows;
mod npz;
mod open;
#[cfg(any(feature = "hdf5", feature = "zarr"))]
mod packed;
mod raw;
mod sample_unit;
mod scaling;
mod stored;
mod telops;
mod text_unit;
mod values;
#[cfg(feature = "zarr")]
mod zarr;

pub use axes::{Axes, dimension_names};
pub use envi::{EnviBands, envi_files};
pub use found::{Found, Opened};
pub use mat::mat_file;
pub use names::{ENDINGS, cubes_in, is_called_so, is_zarr};
pub use npy::{Value, npy_map, write_npy, write_npy_to};
pub use npy_rows::NpyRows;
pub(crate) use open::is_cube;
pub use open::{open, open_as};
pub use sample_unit::{SampleUnit, TemperatureUnit};

/// What opening a cube is called in messages.
const READ_CUBE: &str = "read the cube";
