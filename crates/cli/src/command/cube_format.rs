//! As what a command writes cubes (`--cube-format`).

use clap::{Args, ValueEnum};
use hadar_report::cube_format::CubeFormat;

#[derive(Debug, Args)]
pub(super) struct CubeFormatArgs {
    /// File format of written cubes
    #[arg(long, value_enum, default_value_t = Format::Npy)]
    cube_format: Format,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// NPY files
    Npy,
    /// ENVI files, whose header lists the bands
    Envi,
}

impl CubeFormatArgs {
    pub(super) fn format(&self) -> CubeFormat {
        match self.cube_format {
            Format::Npy => CubeFormat::Npy,
            Format::Envi => CubeFormat::Envi,
        }
    }
}
