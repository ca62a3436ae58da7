//! The figures of a camera, each stated or not.

use super::list::every_figure;
use super::noise::NoiseFigures;
use crate::instrument::{PatternFigures, Readout};
use std::path::PathBuf;
use std::sync::Arc;

/// An efficiency as written: the same at all wavenumbers, or a file of rows.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(untagged)]
pub enum Efficiency {
    /// In (0, 1].
    Number(f64),
    /// CSV with the columns `wavenumber_cm1,efficiency`, absolute path.
    File(PathBuf),
}

impl Efficiency {
    /// The number, if it is one.
    #[must_use]
    pub const fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            Self::File(_) => None,
        }
    }
}

macro_rules! stated {
    ([$($field:tt)*] $camera:tt $both:tt $own:tt $rows:tt) => {
        /// What is stated of a camera; what is not is `None`. What each figure means is said in [`super::TABLE`].
        #[derive(Debug, Clone, PartialEq, Default, serde::Deserialize, serde::Serialize)]
        #[serde(default)]
        pub struct CameraSpec {
            $($field)*
        }
    };
}

every_figure!(stated);

// What a field's default must return.
#[allow(clippy::unnecessary_wraps)]
const fn not_asked_for() -> Option<bool> {
    Some(false)
}
