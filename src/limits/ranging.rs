//! Passive ranging: how well depth can be measured from heat.
//!
//! A window of a stereo pair is found again in the other view no better than its own position can be known
//! from the photons in it. With J the Fisher information about the window's x position (pixel⁻²), the disparity
//! is known to δd ≥ √(1/J_left + 1/J_right) pixels (S41) and depth to δz = z²/(b f)·pitch·δd (S36).
//!
//! * [`noise`]: electronic noise of the counts of a heat cube;
//! * [`derivative`]: ∂N/∂x on a grid of pixels; [`information`]: J of every window (S37, Tables S4 and S5);
//! * [`psf`]: what diffraction and the pixel's size leave of a point source; [`depth`]: δz, and what it demands;
//! * [`reconstruction`]: the same for a scattered signal that is itself estimated from the bands;
//! * [`air`]: depth from one view, by what the air on the path takes away and adds;
//! * [`levels`]: what is left of it in an image of grey levels;
//! * [`metrics`]: measures of the error of a depth map.
//!
//! Assumptions: parallel, calibrated, rectified cameras (no vergence), matching along x alone; no bias bound.
//!
//! Source: paper eq. 3, S35–S43, Tables S4 and S5 (doi:10.1038/s41586-023-06174-6).

pub mod air;
pub mod depth;
pub mod derivative;
pub mod information;
pub mod levels;
pub mod metrics;
pub mod noise;
pub mod psf;
pub mod reconstruction;
