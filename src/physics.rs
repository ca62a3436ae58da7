//! The heat signal: spectra, materials, the air between, and how they depend on what is unknown.

pub mod atmosphere;
pub mod material;
pub mod planck;
pub mod scene;
pub mod spectrum;
