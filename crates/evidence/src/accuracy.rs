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
pub mod brute_force;
mod chart;
mod continuum;
mod decisions;
mod draws;
mod hard_scenes;
mod item;
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
pub use item::{Item, Order};

use hadar::error::Result;

impl Item {
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
            Self::NearestHard => hard_scenes::measure(order)?,
            Self::Probability => probability::measure(order)?,
            Self::Decisions => decisions::measure(order)?,
            Self::Windows => windows::measure(order)?,
            Self::Draws => draws::measure(order)?,
        };
        chart.mark_front();
        Ok(chart)
    }
}
