//! `hadar_limits._hadar`: what the Python package `hadar_limits` is made of; how it is called stands in `hadar_limits/_hadar.pyi`.
//!
//! Numbers come as NumPy arrays and are worked on where they lie, scenarios as files, text or dicts. The interpreter is free
//! meanwhile. Errors are those of the command, as exceptions.

// Linked for what it replaces: its own documentation.
use hadar_elementary as _;

mod answer;
mod array;
mod asked;
mod decompose;
mod error;
mod lent;
mod library;
mod order;
mod pairs;
mod planck;
mod quantity;
mod question;
mod scene;
mod states;
mod threads;
mod windows;

/// The compiled part of the package.
#[pyo3::pymodule]
mod _hadar {
    #[pymodule_export]
    use crate::answer::{Answer, identify, range_, rule, simulate, size};
    #[pymodule_export]
    use crate::decompose::{decompose, left_out};
    #[pymodule_export]
    use crate::error::HadarError;
    #[pymodule_export]
    use crate::library::{emissivity, materials};
    #[pymodule_export]
    use crate::order::{dimension_names, order_of_bands, plain};
    #[pymodule_export]
    use crate::pairs::{Local, Nearest, local, matrix, nearest};
    #[pymodule_export]
    use crate::planck::{brightness_temperature, planck, planck_slope};
    #[pymodule_export]
    use crate::scene::Scene;
    #[pymodule_export]
    use crate::states::over_states;
    #[pymodule_export]
    use crate::windows::window_information;

    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "a name of Python")]
    const __version__: &str = hadar_report::manifest::VERSION;
}
