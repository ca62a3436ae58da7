//! Temperature and emissivity told apart without a library, and a library out of a heat cube.
//!
//! A surface sends S = e·B(T) + (1 − e)·X: W bands have W + 1 unknowns, and what tells them apart has to be assumed. [`nem()`] assumes
//! that the largest emissivity of all bands is known (normalised emissivity method); [`ratio`] is what of it does not hang on that. What
//! is known by a Gaussian prior has a bound, [`hadar::fisher::emissivity`].
//!
//! Many pixels of a few materials tell more: [`library_from_cube`] groups them by their relative emissivities and fits one emissivity
//! for each group, with a temperature and a lighting of every pixel, to all of them at once.
//!
//! Source: paper, supplement SV C; Gillespie et al., IEEE Trans. Geosci. Remote Sens. 36, 1113 (1998), doi:10.1109/36.700995, and
//! 'Temperature/Emissivity Separation Algorithm Theoretical Basis Document', version 2.4 (1999).

mod group;
mod k_means;
mod library;
mod nem;
mod radiometry;
mod sample;

pub use k_means::{Means, k_means};
pub use library::{Asked, COUNT, Cluster, Found, Tried, library_from_cube};
pub use nem::{Separated, Surface, nem, ratio};
