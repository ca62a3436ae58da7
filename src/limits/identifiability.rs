//! How far apart two materials are when temperature and lighting are unknown.
//!
//! * [`local`]: the paper's semantic distance d₀, the tangent at the target (Algorithm 2);
//! * [`multi`]: all materials against all, and which can be told apart; classes of several spectra;
//! * [`mixture`]: the least distance between mixtures of the members of two classes;
//! * [`nearest`]: half the separation from the nearest state of the alternative, in units of the noise;
//! * [`selection`]: which bands or filters tell the most, and what the best few of them keep;
//! * [`detection`]: probability, information and rigorous brackets from a statistical distance d;
//! * [`linear`]: Theorem 1, exact for parallel surfaces;
//! * [`likelihood`]: the state of a material that explains given counts best;
//! * [`lattice`]: Algorithm 1, exact for up to three bands;
//! * [`bracket`]: rigorous bounds on the error between known states, two or many;
//! * [`decision`]: bounds of the probability of a right answer between known states, quickly and for any number of counts;
//! * [`ratio`]: the error between two known states itself, from the law of their likelihood ratio;
//! * [`shared`]: errors that all readings of an object share;
//! * [`bayes`]: what priors do to the distance and to the probability.

pub mod bayes;
pub mod bracket;
mod curvature;
pub mod decision;
pub mod detection;
pub mod lattice;
pub mod likelihood;
pub mod linear;
pub mod local;
pub mod mixture;
pub mod multi;
pub mod nearest;
pub mod ratio;
mod rectangle;
pub mod selection;
pub mod shared;
mod space;

pub(super) use self::space::{ENVIRONMENT_K, LARGEST_LN_GAIN};

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
