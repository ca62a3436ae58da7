//! What may be otherwise than it is told, as one number for the whole cube, and what a unit of it changes in a pixel's counts.
//!
//! N_w = κ_w ∫ [e B(T) + (1 − e) Σₖ Vₖ Sₖ] over band w. Its slope along a cause θ, at the fit of a pixel:
//!
//! | cause | unit of θ | ∂N_w/∂θ |
//! |---|---|---|
//! | gain | | N_w, without light that was itself counted |
//! | wavelength shift | cm⁻¹ | difference of the counts with all spectra read a little higher and lower |
//! | scale of light k | | Vₖ Cₖ, Cₖ the counts that are scattered of it at V = 1 |
//! | shape of light k | | Vₖ Cₖ P_w, P Legendre's polynomial of an order over the bands; the tilt is the first |
//! | path of the sky's light through the air | | −Vₖ Cₖ (1 − ε) ln(1 − ε)/ε, ε(ν) the emissivity of that sky: a path longer by θ has 1 − (1 − ε)^(1 + θ) |
//! | temperature of light k | K | κ_w Vₖ (1 − e) ∂Sₖ/∂T |
//! | sum of the lighting factors | | Σ Vₖ Cₖ/ΣVₖ, where it is told |
//! | a light that is missing | | κ_w (1 − e) B(T_x), its V |
//! | air on the path | m | −α_w (N_w − κ_w B(T_air)), α the optical depth of a metre |
//! | one band | | N_w in it |
//!
//! Assumption: to first order. Source: paper S44; the score test is C. R. Rao's, Proc. Camb. Phil. Soc. 44, 50 (1948),
//! doi:10.1017/S0305004100023987.

use super::spectra::Spectra;
use std::sync::Arc;

/// Something that may be otherwise than it is told.
#[derive(Debug, Clone, PartialEq)]
pub enum Cause {
    /// All counts are larger by this share.
    Gain,
    /// The bands lie so many cm⁻¹ higher than told.
    WavelengthShift(Arc<Spectra>),
    /// A light is stronger by this share in all bands.
    LightScale(usize),
    /// A light is stronger by this share of a Legendre polynomial over the bands: of the first order, at their upper end, and weaker as
    /// much at the lower one.
    LightShape {
        /// Which of the surroundings.
        light: usize,
        /// From 1 to 3.
        order: usize,
    },
    /// The light of a sky comes by a path through the air that is longer by this share: as if the sky were seen at another height.
    LightPath {
        /// Which of the surroundings.
        light: usize,
        /// What share of a blackbody's radiance at the temperature of its air it sends at the nodes, above 0 and below 1.
        emissivity: Vec<f64>,
    },
    /// A light is so many kelvin warmer.
    LightTemperature {
        /// Which of the surroundings.
        light: usize,
        /// The temperature that it is told to have, K.
        temperature_k: f64,
    },
    /// The sum of the lighting factors is larger by this.
    LightingTotal,
    /// There is a light besides, a blackbody of a temperature, with this lighting factor.
    LightMissing {
        /// Its temperature, K.
        temperature_k: f64,
    },
    /// So many metres of air are before the camera.
    Air {
        /// Optical depth of one metre at the nodes.
        depth_per_m: Vec<f64>,
        /// Temperature of the air, K.
        temperature_k: f64,
    },
    /// One band, counted from 0 in rising wavenumber, is stronger by this share.
    Band(usize),
}

impl Cause {
    /// Whether its amount is a share of what it is a cause of.
    pub(super) fn is_share(&self) -> bool {
        matches!(self, Self::Gain | Self::LightScale(_) | Self::LightPath { .. } | Self::Band(_))
    }
}
