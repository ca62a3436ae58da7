//! What is estimated from counts: the limits of [`hadar`] are what these estimators are held against.
//!
//! * [`decompose`]: heat cubes into material, temperature and lighting of every pixel (S44–S48);
//! * [`separation`]: temperature and emissivity without a library, and a library out of a heat cube (SV C);
//! * [`segmentation`]: maps of materials as maps of categories and objects (SIII E, Algorithm 4);
//! * [`calibrate`]: the response and the noise of a camera, and its stripes.
//!
//! Nothing here draws counts of a scene or reads files.

pub mod calibrate;
pub mod decompose;
pub mod segmentation;
pub mod separation;
