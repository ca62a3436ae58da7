//! Run time against error, method by method.
//!
//! Each [`Item`] is a computation that can be done in several ways. Every way is timed over the knob that makes it
//! dearer (step, tolerance, trials, bands), and its true error is taken against a reference that shares no arithmetic
//! with it ([`crate::reference`], a closed form, or another algorithm taken much further; each chart says which).
//! A method is on the Pareto front where no other that answers the same is faster and no less accurate, nor as fast and
//! more accurate.
//!
//! Times are of one thread, the least of many short runs ([`timing`]); errors are relative unless a chart says otherwise.

mod band_integrals;
mod chart;
mod continuum;
mod decisions;
mod draws;
mod local;
mod nearest;
mod planck;
mod probability;
mod quadrature;
mod scene;
pub mod skipping;
pub mod stress;
pub mod timing;
mod windows;

pub use chart::{Chart, Measured, ROUNDED};
pub use continuum::{Continuum, GOOD, MaterialStep, Recommended, continuum};

use crate::reference::Extended;
use hadar::error::Result;

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
    pub const ALL: [Self; 9] = [
        Self::Planck,
        Self::BandIntegrals,
        Self::Local,
        Self::LocalNearEquilibrium,
        Self::Nearest,
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
            Self::Probability => "probability",
            Self::Decisions => "decisions",
            Self::Windows => "windows",
            Self::Draws => "draws",
        }
    }

    /// Times and errors of all its methods.
    ///
    /// # Errors
    /// None with the built-in cases, unless memory runs out.
    pub fn measure(self, order: Order) -> Result<Chart> {
        let mut chart = match self {
            Self::Planck => planck::measure(order)?,
            Self::BandIntegrals => band_integrals::measure(order)?,
            Self::Local => local::aluminium(order)?,
            Self::LocalNearEquilibrium => local::near_equilibrium(order)?,
            Self::Nearest => nearest::measure(order)?,
            Self::Probability => probability::measure(order)?,
            Self::Decisions => decisions::measure(order)?,
            Self::Windows => windows::measure(order)?,
            Self::Draws => draws::measure(order)?,
        };
        chart.mark_front();
        Ok(chart)
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
    fn some<T: Copy>(self, values: &[T]) -> Vec<T> {
        values.iter().copied().step_by(if self.quick { 2 } else { 1 }).collect()
    }
}

/// Relative error of a double against extended precision.
fn off(value: f64, exact: &Extended) -> f64 {
    Extended::from(value).relative_error_to(exact)
}
