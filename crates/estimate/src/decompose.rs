//! Heat cubes decomposed into material, temperature and lighting of every pixel, by maximum likelihood.
//!
//! A pixel sends S = e(m)·B(T) + (1 − e(m))·Σₖ Vₖ Sₖ (S44): material m of a library, temperature T, and how much of each of its
//! surroundings' spectra Sₖ it scatters. For each material the likelihood of its counts is brought to its most over T and V within
//! their range; what the materials are worth beside each other is their posterior. Where the photons do not tell, it is said.
//!
//! * [`Setting`], [`Options`]: what is known; [`decompose()`]: a cube to [`Maps`];
//! * [`widen`]: what an error that all bands and pixels have in common adds to the deviations;
//! * [`estimate`]: unknowns that the whole cube shares, with the pixels; [`Told`]: a setting with a cause put into it;
//! * [`judge()`]: what all pixels together say of the model, and of each [`Cause`] why it may not hold;
//! * [`Method`], [`decompose_by`]: methods that it is compared with; [`decompose_by_rows`]: maps that are too large to be kept; [`inverse_error`]: by how much one of them errs;
//! * [`SpatialPrior`]: what neighbours tell about a pixel, where it is asked for;
//! * [`distil()`]: what of the light on a surface is the sky's; [`texture_information()`]: what cube and textures tell of a place;
//! * [`Pixel`], [`flag`]: what is found of a pixel, and what is said of it; [`possible`]: the categories that it may be of.
//!
//! Intervals are those of the Cramér–Rao bound at the fit, were the material certain, also where a limit holds a lighting factor: its
//! truth may be a little way off; those of lighting and texture end where its limits end them; those of a prior over the image are its own ([`SpatialPrior`]).
//!
//! Assumptions: counts are Poisson with added Gaussian noise; bands are independent; the library is exact.
//!
//! Source: paper S44, S48, Methods 'TeX degeneracy'.

mod alike;
mod cause;
mod described;
mod distil;
mod effect;
mod fit;
mod grey_body;
mod inverse;
mod inverse_error;
mod judge;
mod kernel;
mod library_error;
mod maps;
mod method;
mod mixed;
mod model;
mod pixel;
pub mod possible;
mod ranked;
mod screen;
mod setting;
mod shared;
mod space;
mod spatial;
mod spectra;
mod step;
mod tangent;
mod texture_information;
mod thresholds;
mod together;
mod told;

pub use alike::Alike;
pub use cause::Cause;
pub use distil::{Distilled, Residue, Sky, distil};
pub use inverse_error::{InverseError, inverse_error};
pub use judge::{Alone, Judged, Together, p_deviations};
pub use library_error::LibraryError;
pub use maps::{Maps, Options};
pub use method::{Method, decompose, decompose_by, decompose_by_rows};
pub use mixed::{MOST_MIXED, Mixture};
pub use pixel::{NO_FIT, NO_MATERIAL, Pixel, Spared, flag};
pub use possible::CANDIDATE_SHARE;
pub use ranked::{MOST_RANKED, Ranked};
pub use setting::{Light, MOST_SURROUNDINGS, Path, Setting};
pub use shared::{Shared, Unknown, estimate, judge};
pub use spatial::{Spatial, SpatialPrior};
pub use spectra::Spectra;
pub use texture_information::{TextureInformation, texture_information};
pub use together::{ToHold, widen};
pub use told::Told;
