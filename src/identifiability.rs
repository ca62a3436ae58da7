//! How far apart two materials are when temperature and lighting are unknown.
//!
//! * [`local`]: the paper's semantic distance d₀, the tangent at the target (Algorithm 2);
//! * [`nearest`]: half the separation from the nearest state of the alternative, in units of the noise;
//! * [`likelihood`]: the state of a material that explains given counts best;
//! * [`detection`]: probability, information and rigorous brackets from a statistical distance d.

mod curvature;
pub mod detection;
pub mod likelihood;
pub mod local;
pub mod map;
pub mod nearest;
mod space;
mod step;

/// What kind of answer a distance is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// The two materials differ beyond what the nuisances can explain.
    Ok,
    /// Target and surroundings are in thermal equilibrium: every material looks the same.
    Equilibrium,
    /// A change of the nuisances looks just like the change of material.
    Blind,
    /// The two emissivities are the same in every band.
    Identical,
}
