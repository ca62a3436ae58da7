//! What the members of two classes say together.

use hadar::identifiability::multi::ClassDistances;

/// A class in an answer; a material is one of itself.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct ClassSide {
    /// Name of the class, or of the material.
    pub name: String,
    /// Spectra that it rests on.
    pub spectra: usize,
    /// Whether it is a class at all.
    pub is_class: bool,
    /// Whether mixtures of its members belong to it.
    pub mixtures: bool,
    /// Whether the class is represented by the mean of its spectra.
    pub mean: bool,
    /// Its members, and their shares.
    pub members: Vec<String>,
    /// A share for each; Σ = 1.
    pub weights: Vec<f64>,
    /// Those of its members that are entered as one number for all wavenumbers: nothing is known of their spectrum.
    pub one_number: Vec<String>,
}

/// The worst pair without one of its members.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct LeftOut {
    /// Name of the class to which the member belongs.
    pub class: String,
    /// Name of the member that is left out.
    pub member: String,
    /// Distance of the worst pair that is left.
    pub distance: Option<f64>,
}

/// The worst mixture of members.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct MixtureAnswer {
    /// Shares of the target's members that are in it.
    pub target: Vec<(String, f64)>,
    /// Shares of the alternative's members that are in it.
    pub alternative: Vec<(String, f64)>,
    /// Distance of the two, all parts in one lighting.
    pub distance: f64,
    /// No mixture is nearer, even if every part has a different lighting.
    pub distance_lower: f64,
}

/// What the members of the target's class and of one alternative's say together.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct ClassAnswer {
    /// The class to which the target belongs.
    pub target: ClassSide,
    /// The class of the alternative that it must be distinguished from.
    pub alternative: ClassSide,
    /// Number of pairs of a target's member with an alternative's.
    pub pairs: usize,
    /// Pairs whose distance was searched; the others were proved to decide nothing.
    pub searched: usize,
    /// Whether distances are the camera's, else per √photon.
    pub statistical: bool,
    /// Statistical distance demanded; `None` without a camera.
    pub required: Option<f64>,
    /// The pair of members that is hardest to distinguish.
    pub worst: [String; 2],
    /// Distance of that pair, per √photon or of the camera as `statistical` says.
    pub distance: f64,
    /// No pair of members is surely nearer than this.
    pub distance_lower: f64,
    /// Whether the camera tells all pairs, and all mixtures where they belong to the classes; `None` without a camera.
    pub told_apart: Option<bool>,
    /// Share of the pairs that the camera tells, by the weights of the members.
    pub share_of_pairs_told: Option<f64>,
    /// Mean probability of a correct decision over the pairs: it is between these.
    pub mean_detection_probability: Option<[f64; 2]>,
    /// The worst pair without the one or the other of its members.
    pub leave_one_out: Vec<LeftOut>,
    /// The worst mixture, where mixtures belong to a class.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mixtures: Option<MixtureAnswer>,
    /// Without a camera, the least d²L over the pairs, L the photon radiance of the target: what decides which hardware is needed.
    #[serde(skip)]
    pub least_information: Option<f64>,
    /// What is known of every pair, target by target.
    #[serde(skip)]
    pub distances: ClassDistances,
}

impl ClassAnswer {
    /// What a verdict may rest on.
    #[must_use]
    pub fn decisive(&self) -> f64 {
        self.mixtures
            .as_ref()
            .map_or(self.distance_lower, |found| found.distance_lower.min(self.distance_lower))
    }

    /// The greatest probability with which one more spectrum, drawn as those of the class were, is nearer than all of them: 1/(n + 1);
    /// `None` where the class is one material or stands as its mean.
    #[must_use]
    pub fn chance_one_more_is_nearer(side: &ClassSide) -> Option<f64> {
        (side.is_class && !side.mean).then(|| 1.0 / (side.spectra as f64 + 1.0))
    }
}
