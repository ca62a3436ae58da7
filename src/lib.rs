//! The physical limits of seeing by heat: from the photons of a scene to what no algorithm can beat.
//!
//! A surface sends S = e·B(T) + (1 − e)·Σₖ Vₖ εₖ B(Tₖ): its own emission, and what it scatters of its surroundings. Temperature T,
//! emissivity e and lighting V are mixed in it, so that a warm robot can look exactly like a person. This crate computes how far
//! apart two materials are when temperature and lighting are unknown, how precisely temperature and depth can be read, what a
//! camera must have for a task, and draws photons that show it. Files, sentences, plots and the command `hadar` are built on
//! it in other crates.
//!
//! ```
//! use hadar::fisher::{Nuisance, Unknowns};
//! use hadar::identifiability::nearest::{NearestSolver, StateRange};
//! use hadar::scene::{EnvironmentObject, State, Surroundings};
//! use hadar::spectrum::Bands;
//!
//! let bands = Bands::uniform(800.0, 1200.0, 10.0)?;
//! let room = EnvironmentObject { temperature_k: 293.15, emissivity: None };
//! let surroundings = Surroundings::new(bands.nodes_cm1(), vec![room])?;
//! let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting])?;
//! let mut solver = NearestSolver::new(&bands, &surroundings, unknowns, StateRange::default());
//! let person = State { temperature_k: 310.15, lighting: vec![0.5], gain: 1.0, environment_k: vec![293.15] };
//! let (skin, metal) = (vec![0.98; bands.len()], vec![0.60; bands.len()]);
//! let pair = solver.per_photon(&skin, &metal, &person, f64::INFINITY)?;
//! // No spectrum tells them apart better than chance by more than this for each root of a photon.
//! assert!(pair.distance < 1e-2);
//! # Ok::<(), hadar::Error>(())
//! ```
//!
//! # The house
//!
//! Each storey uses those above it in this list, never one below; a test holds the arrows.
//!
//! | storey | modules | what is there |
//! |---|---|---|
//! | base | [`error`], [`units`], [`statistics`] | errors with place and remedy; constants and quantities; laws of counts |
//! | | [`sum`], [`root`], [`minimum`] | sums without growing error, crossings and minima in one dimension |
//! | | [`lattice_points`], [`grid`] | points that fill the unit cube, text of tables |
//! | | [`cube`] | heat cubes, in memory or given by rows |
//! | | [`demand`], [`allowed`], [`words`] | what a question needs and what of it was computed; ranges of figures; numbers in words |
//! | | [`parallel`], [`order`] | jobs in parallel, their results in order; things in the order of a number |
//! | physics | [`planck`] | photon radiance of a blackbody and its differences |
//! | | [`spectrum`] | bands: grids, filters, integrals |
//! | | [`material`] | emissivities: rows, optical constants, library with provenance |
//! | | [`atmosphere`] | the air between |
//! | | [`scene`] | the heat signal S and its derivatives |
//! | instrument | [`instrument`] | the camera: étendue, efficiencies, noise budget, photon bunching, presets |
//! | limits | [`calibration`] | what errors of the calibration leave of the information |
//! | | [`fisher`] | Fisher information and Cramér–Rao bounds |
//! | | [`identifiability`] | distances between materials: local, nearest, exact; many materials; bands that matter |
//! | | [`ranging`] | precision of depth: windows, textures, diffraction, heat cubes |
//! | | [`policy`] | requirements: solved for, traded off, proved over envelopes of scenes |
//!
//! # Where an equation is computed
//!
//! Numbers are those of Bao et al., *Heat-assisted detection and ranging*, Nature 619, 743 (2023), [doi:10.1038/s41586-023-06174-6].
//! They are written with Unicode signs here; the guide, `docs/` of the repository, has the main ones set as a book does.
//!
//! | equation | what | where |
//! |---|---|---|
//! | 2 | identifiability, log₂ 2P | [`identifiability::detection`] |
//! | 3 | depth error in a scattered signal that has to be reconstructed | [`ranging::depth`], [`ranging::reconstruction`] |
//! | S1–S4 | heat signal; multiple scattering | [`scene`]; `hadar_simulate::render` |
//! | S5, S6 | thermal lighting factors of surfaces | `hadar_simulate::render` |
//! | S7 | étendue of a pixel, counts | [`instrument::Camera::etendue_m2_sr`], [`instrument::view`] |
//! | S8, S9 | filters, and the light that sensor and filters add | [`spectrum`], [`instrument::view`] |
//! | S10, Table S2 | counts from what data sheets state | [`instrument::noise`], [`instrument::equivalents`] |
//! | S11–S13 | photon bunching: the law of counts, its variance | [`statistics`], [`instrument::bunching`] |
//! | S14–S16 | what a reading scatters by: shot noise and a budget of lines | [`statistics`], [`instrument::budget`] |
//! | S18, S30 | mixed emissivity, derivatives of the signal | [`scene`] |
//! | S16, Algorithm 1 | exact detection probability on a lattice of counts | [`identifiability::lattice`] |
//! | S19–S26, Theorem 1 | parallel surfaces; P = Φ(d) | [`identifiability::linear`], [`identifiability::detection`] |
//! | S27 | Fisher matrix of a calibrated camera | [`fisher`] |
//! | S28 | what joining bands loses | [`ranging::reconstruction`] |
//! | S29 | the Fisher matrix with unknown gain | [`fisher::Nuisance::Gain`] |
//! | Algorithm 2 | semantic distance d₀ = 1/(2σ₀) | [`identifiability::local`] |
//! | S31–S34, Algorithm 3 | many materials, prediction probabilities | [`identifiability::multi`] |
//! | S35, S36 | depth from disparity, and its error δz | [`ranging::depth`] |
//! | S37–S40, Tables S4, S5 | information of windows, four cells | [`ranging::information`], [`ranging::noise`] |
//! | S41–S43 | two views, diffraction, the limit of δz | [`ranging::depth`], [`ranging::psf`] |
//! | S44 | decomposition of a heat cube | `hadar_estimate::decompose` |
//! | S45, Ext. Data Fig. 1b | texture of the sky's light alone | `hadar_estimate::decompose::distil` |
//! | S46, S47 | temperature and lighting by slopes along wavenumber, and their errors | `hadar_estimate::decompose::Method`, `hadar_estimate::decompose::inverse_error` |
//! | SV C | a library out of a heat cube | `hadar_estimate::separation`; its bound [`fisher::emissivity`] |
//! | S48 | known total of the lighting factors | [`fisher`], [`scene`], `hadar_estimate::decompose` |
//! | SIII E, Algorithm 4 | semantic segmentation by materials | `hadar_estimate::segmentation` |
//! | Ext. Data Fig. 9 | thermometry | [`fisher::precision`], `hadar_simulate::thermometry` |
//! | SII E, Fig. 3d, e | H = t A_p/((1 + γ)F²), motion, requirements | [`policy`] |
//!
//! [doi:10.1038/s41586-023-06174-6]: https://doi.org/10.1038/s41586-023-06174-6

mod base;
pub mod instrument;
mod limits;
mod physics;

pub use base::error::{Error, Result};
pub use base::{
    aligned, allowed, correlation, cube, demand, error, grid, inputs, lattice_points, minimum, order,
    parallel, radiance_unit, random, root, simd, statistics, stop, sum, units, words,
};
pub(crate) use base::{best_first, box_least_squares, few, wide};
pub use limits::{calibration, fisher, identifiability, policy, ranging};
pub use physics::{atmosphere, material, planck, scene, spectrum};

#[cfg(doctest)]
#[doc = include_str!("README.md")]
struct Readme;
