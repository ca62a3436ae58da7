//! What is measured, and how.

use crate::reference::Extended;

/// A computation that is done in several ways.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Item {
    /// Photon radiance of a blackbody.
    Planck,
    /// Integral of a sharp spectrum over a band.
    BandIntegrals,
    /// Local distance of a pair.
    Local,
    /// Local distance of a pair a hundredth of a kelvin from equilibrium.
    LocalNearEquilibrium,
    /// Nearest distance of a pair.
    Nearest,
    /// Nearest distances in scenes that searches find hard.
    NearestHard,
    /// Error of the best test between two known states.
    Probability,
    /// Detection probability of the best fits, states unknown.
    Decisions,
    /// Fisher information of windows.
    Windows,
    /// Counts drawn.
    Draws,
}

impl Item {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::Planck,
        Self::BandIntegrals,
        Self::Local,
        Self::LocalNearEquilibrium,
        Self::Nearest,
        Self::NearestHard,
        Self::Probability,
        Self::Decisions,
        Self::Windows,
        Self::Draws,
    ];

    /// The name on the command line, and of its files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Planck => "planck",
            Self::BandIntegrals => "band-integrals",
            Self::Local => "local",
            Self::LocalNearEquilibrium => "local-near-equilibrium",
            Self::Nearest => "nearest",
            Self::NearestHard => "nearest-hard",
            Self::Probability => "probability",
            Self::Decisions => "decisions",
            Self::Windows => "windows",
            Self::Draws => "draws",
        }
    }
}

/// How the measurements are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Order {
    /// Fewer points and shorter runs.
    pub quick: bool,
    /// Seed of all that is drawn.
    pub seed: u64,
}

impl Order {
    /// Every value, or with `quick` every other one.
    pub(super) fn some<T: Copy>(self, values: &[T]) -> Vec<T> {
        values.iter().copied().step_by(if self.quick { 2 } else { 1 }).collect()
    }
}

/// Relative error of a double against extended precision.
pub(super) fn off(value: f64, exact: &Extended) -> f64 {
    Extended::from(value).relative_error_to(exact)
}
