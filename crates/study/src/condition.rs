//! What a verdict rests on beside the distance: data made with the answer, never read back from remarks.
//!
//! A figure that nobody stated is asked for, or the worst value stands for it, or it is a favourable condition here: a 'yes' holds only if
//! it is as good as what was taken. What absence means, figure by figure:
//!
//! | not stated | means |
//! |---|---|
//! | of the camera | [`hadar::instrument::Camera::assumed`]: asked for, the worst, or [`Condition::Assumed`] |
//! | `target.distance`, `target.size` | the target fills a pixel: [`Condition::FillsPixel`] |
//! | `background` | asked for where the target does not fill its pixel |
//! | `[atmosphere]` | the air takes nothing away: [`Condition::NoAir`] |
//! | `[[environment]]` | nothing lights the target: [`Condition::NoSurroundings`] |
//! | `[alternatives]` ranges | all that physics allows, the worst; where a range that was set decides, [`Condition::Range`] |
//! | `gain` or `environment-temperature` among `unknown.nuisances` | gain and temperatures of the surroundings are known: [`Condition::Calibrated`] |
//! | `requirement.speed` | nothing moves while frames and bands are read: [`Condition::StillScene`] |
//! | `requirement.time` | it may take as long as it takes, which that condition tells |
//! | reliability | d = 1, which the sentence tells |

use crate::proviso::Proviso;
use hadar::fisher::Nuisance;
use hadar::instrument::Assumed;

hadar::named! {
    /// What kind of condition it is.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum ConditionKind {
        /// A figure that nobody stated.
        Assumed = "assumed",
        /// What must hold meanwhile.
        Proviso = "proviso",
        /// A range of the user that decides.
        Range = "range",
        /// A value set over the file.
        Setting = "setting",
        /// An alternative that was left out.
        Omitted = "omitted",
    }
    /// The name in JSON, e.g. `proviso`.
    name
}

/// A range of the user that a verdict rests on.
#[derive(Debug, Clone, PartialEq)]
pub struct RangeDecides {
    /// The key that states it.
    pub figure: &'static str,
    /// As it is stated, K, or a share.
    pub stated: [f64; 2],
    /// The widest that was found not to change the answer, likewise.
    pub holds: [f64; 2],
}

/// What a verdict rests on.
#[derive(Debug, Clone, PartialEq)]
pub enum Condition {
    /// A range that the scenario sets keeps out states that would not be told apart.
    Range(RangeDecides),
    /// Frames that are added up while something moves.
    RegisteredFrames(Proviso),
    /// Nothing moves for so long, s.
    StillScene {
        /// Until all bands of all frames are read.
        time_s: f64,
    },
    /// Materials that are entered as one number for all wavenumbers.
    Constants {
        /// The two of the pair that decides.
        emissivities: [f64; 2],
    },
    /// Emissivities with such an error, root mean square, of which so many draws meet the requirement.
    Emissivities {
        /// Root mean square.
        error: f64,
        /// Share of the draws.
        share_met: f64,
    },
    /// A figure of the camera that nobody stated; of a full well the counts that must not fill it.
    Assumed {
        /// The figure, and what stands for it.
        figure: Assumed,
        /// Counts of the fullest reading, where it is the full well.
        counts: Option<f64>,
    },
    /// A reading of the distance decides which is no limit.
    NoLimit,
    /// Photon bunching that was not asked for would decide.
    Bunching {
        /// Photons per mode.
        occupancy: f64,
    },
    /// The target fills the pixel.
    FillsPixel {
        /// Side of what the pixel sees, m, where the distance is known.
        footprint_m: Option<f64>,
    },
    /// A camera of one band that its entry models as if it read so many at once.
    Modelled {
        /// How many.
        bands: usize,
    },
    /// Bands beyond the stated range of the detector, of so many.
    BeyondRange {
        /// How many.
        outside: usize,
        /// Of how many.
        bands: usize,
    },
    /// Wide bands are taken at their centres.
    Sampled {
        /// Width of the widest, cm⁻¹.
        width_cm1: f64,
    },
    /// The target fills a part of one pixel and lies in no other.
    InOnePixel {
        /// Share of the pixel.
        fill: f64,
    },
    /// The lens blurs a point over more than a pixel.
    Diffraction {
        /// Over how much, m.
        blur_m: f64,
    },
    /// Filters neither shine nor throw the sensor's light back.
    NoFilterLight,
    /// The air takes nothing away.
    NoAir,
    /// Nothing around the target lights it.
    NoSurroundings,
    /// What is not among the unknowns is known.
    Calibrated {
        /// What that is.
        known: Vec<Nuisance>,
    },
    /// Materials that were left out of the alternatives.
    LeftOut {
        /// Their names.
        materials: Vec<String>,
    },
    /// A value in the place of the file's.
    Setting {
        /// Its key.
        key: String,
        /// The value.
        value: String,
        /// Whether it stands in the place of what a rule says, which is then another rule.
        of_rule: bool,
    },
}

/// Codes of all conditions but those of camera figures, which are called as their keys are.
const CODES: [&str; 19] = [
    "range",
    "registered-frames",
    "still-scene",
    "constant-emissivities",
    "emissivities",
    "no-limit",
    "photon-bunching",
    "fills-pixel",
    "modelled",
    "beyond-range",
    "bands-sampled",
    "in-one-pixel",
    "diffraction",
    "no-filter-light",
    "no-air",
    "no-surroundings",
    "calibrated",
    "materials-left-out",
    "setting",
];

impl Condition {
    /// All codes.
    #[must_use]
    pub fn codes() -> Vec<String> {
        let figures = Assumed::FIGURES.iter().map(|figure| kebab(figure));
        CODES.iter().map(|code| (*code).to_owned()).chain(figures).collect()
    }

    /// Stable code, e.g. `still-scene`, or the key of a camera figure, e.g. `full-well`.
    #[must_use]
    pub fn code(&self) -> String {
        let code = match self {
            Self::Range(_) => "range",
            Self::RegisteredFrames(_) => Proviso::CODE,
            Self::StillScene { .. } => "still-scene",
            Self::Constants { .. } => "constant-emissivities",
            Self::Emissivities { .. } => "emissivities",
            Self::Assumed { figure, .. } => return kebab(figure.figure),
            Self::NoLimit => "no-limit",
            Self::Bunching { .. } => "photon-bunching",
            Self::FillsPixel { .. } => "fills-pixel",
            Self::Modelled { .. } => "modelled",
            Self::BeyondRange { .. } => "beyond-range",
            Self::Sampled { .. } => "bands-sampled",
            Self::InOnePixel { .. } => "in-one-pixel",
            Self::Diffraction { .. } => "diffraction",
            Self::NoFilterLight => "no-filter-light",
            Self::NoAir => "no-air",
            Self::NoSurroundings => "no-surroundings",
            Self::Calibrated { .. } => "calibrated",
            Self::LeftOut { .. } => "materials-left-out",
            Self::Setting { .. } => "setting",
        };
        code.to_owned()
    }

    /// Whether another is of the same code.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        self.code().eq(&other.code())
    }

    /// Its kind.
    #[must_use]
    pub const fn kind(&self) -> ConditionKind {
        match self {
            Self::Range(_) => ConditionKind::Range,
            Self::RegisteredFrames(_) | Self::StillScene { .. } | Self::Emissivities { .. } => {
                ConditionKind::Proviso
            }
            Self::LeftOut { .. } => ConditionKind::Omitted,
            Self::Setting { .. } => ConditionKind::Setting,
            _ => ConditionKind::Assumed,
        }
    }

    /// Whether the answer may be worse where it does not hold.
    #[must_use]
    pub const fn favourable(&self) -> bool {
        match self {
            Self::Assumed { figure, .. } => figure.favourable,
            Self::Setting { of_rule, .. } => *of_rule,
            _ => true,
        }
    }

    /// Whether a verdict rests on it: a 'no' on what was taken on the unfavourable side, and on a readout, which is slow where nobody says.
    pub(crate) fn counts(&self, met: bool) -> bool {
        let is_readout = matches!(self, Self::Assumed { figure, .. } if figure.figure == "readout");
        met || is_readout || !self.favourable()
    }

    /// The key that would settle it.
    #[must_use]
    pub fn figure(&self) -> Option<String> {
        let key = match self {
            Self::Range(range) => range.figure,
            Self::RegisteredFrames(_) => "camera.frames",
            Self::StillScene { .. } => "requirement.speed",
            Self::Constants { .. } => "alternatives.materials",
            Self::Emissivities { .. } => "sensitivity.emissivity_error",
            Self::Assumed { figure, .. } => return Some(format!("camera.{}", figure.figure)),
            Self::NoLimit => "requirement.by",
            Self::Bunching { .. } => "camera.photon_bunching",
            Self::FillsPixel { footprint_m: None } => "target.distance",
            Self::FillsPixel { .. } => "target.size",
            Self::Modelled { .. } => "camera.readout",
            Self::BeyondRange { .. } => "camera.spectral_range",
            Self::Sampled { .. } => "bands.integrate",
            Self::InOnePixel { .. } => "target.size",
            Self::Diffraction { .. } => "camera.pixel",
            Self::NoFilterLight => "camera.sensor_temperature",
            Self::NoAir => "atmosphere",
            Self::NoSurroundings => "environment",
            Self::Calibrated { .. } => "unknown.nuisances",
            Self::LeftOut { .. } => "alternatives.skip_uncovered",
            Self::Setting { key, .. } => return Some(key.clone()),
        };
        Some(key.to_owned())
    }

    /// How hard it is to keep, hardest first: the sentence of a 'yes' names the first.
    pub(crate) fn rank(&self) -> (u8, f64) {
        /// Nobody stands still for longer than this without a word, s.
        const STILL_S: f64 = 0.1;
        match self {
            Self::Range(_) => (0, 0.0),
            Self::NoLimit => (1, 0.0),
            Self::RegisteredFrames(proviso) => (2, -proviso.way_m),
            Self::StillScene { time_s } if *time_s > STILL_S => (2, -time_s),
            Self::Constants { .. } => (3, 0.0),
            Self::LeftOut { .. } => (4, 0.0),
            Self::Emissivities { share_met, .. } => (5, *share_met),
            Self::FillsPixel { footprint_m } => match footprint_m {
                Some(footprint_m) => (6, -footprint_m),
                None => (6, f64::NEG_INFINITY),
            },
            Self::Assumed { figure, .. } if !figure.favourable => (11, 0.0),
            Self::Assumed { figure, .. } => match figure.figure {
                "flicker_fraction" => (7, 0.0),
                "spectral_range" => (7, 1.0),
                "netd_f_number" => (7, 2.0),
                _ => (8, 0.0),
            },
            Self::Bunching { .. } => (8, 1.0),
            Self::Modelled { .. } => (1, 1.0),
            Self::BeyondRange { .. } => (6, 1.0),
            Self::InOnePixel { .. } => (6, 2.0),
            Self::Diffraction { .. } => (6, 3.0),
            Self::Sampled { .. } => (8, 3.0),
            Self::NoFilterLight => (8, 2.0),
            Self::NoAir => (9, 0.0),
            Self::NoSurroundings => (9, 1.0),
            Self::StillScene { .. } => (10, 0.0),
            Self::Calibrated { .. } => (10, 1.0),
            Self::Setting { of_rule, .. } => (if *of_rule { 0 } else { 12 }, 0.0),
        }
    }
}

fn kebab(key: &str) -> String {
    key.replace('_', "-")
}

hadar::named! {
    /// How sure a verdict is: the weakest of what went into it.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Sureness {
        /// A figure that nobody stated, or a condition that nobody checked.
        Assumed = "assumed",
        /// The best of a search.
        Searched = "searched",
        /// No state of any alternative is nearer than is said.
        Proved = "proved",
    }
    /// The name in JSON.
    name
}

impl Condition {
    /// Those without which a 'yes' may be none, hardest first.
    pub fn open(conditions: &[Self]) -> impl Iterator<Item = &Self> {
        conditions.iter().filter(|one| one.favourable())
    }
}

/// Puts the hardest first.
pub(crate) fn hardest_first(conditions: &mut [Condition]) {
    conditions.sort_by(|a, b| {
        let (a, b) = (a.rank(), b.rank());
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
}

/// The value of a condition in JSON.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[serde(untagged)]
pub(crate) enum Taken<'a> {
    Number(f64),
    Pair([f64; 2]),
    Text(&'a str),
    Texts(Vec<&'a str>),
    Nothing,
}

impl Condition {
    pub(crate) fn value(&self) -> Taken<'_> {
        match self {
            Self::Range(range) => Taken::Pair(range.stated),
            Self::RegisteredFrames(proviso) => Taken::Number(f64::from(proviso.frames)),
            Self::StillScene { time_s } => Taken::Number(*time_s),
            Self::Constants { emissivities } => Taken::Pair(*emissivities),
            Self::Emissivities { error, .. } => Taken::Number(*error),
            Self::Assumed { counts: Some(counts), .. } => Taken::Number(*counts),
            Self::Assumed { figure, .. } => Taken::Text(&figure.taken),
            Self::Bunching { occupancy } => Taken::Number(*occupancy),
            Self::Modelled { bands } => Taken::Number(*bands as f64),
            Self::BeyondRange { outside, .. } => Taken::Number(*outside as f64),
            Self::Sampled { width_cm1 } => Taken::Number(*width_cm1),
            Self::InOnePixel { fill } => Taken::Number(*fill),
            Self::Diffraction { blur_m } => Taken::Number(*blur_m),
            Self::FillsPixel { footprint_m: Some(footprint_m) } => Taken::Number(*footprint_m),
            Self::Calibrated { known, .. } => Taken::Texts(known.iter().map(|one| one.name()).collect()),
            Self::LeftOut { materials } => Taken::Texts(materials.iter().map(String::as_str).collect()),
            Self::Setting { value, .. } => Taken::Text(value),
            Self::NoLimit
            | Self::FillsPixel { .. }
            | Self::NoFilterLight
            | Self::NoAir
            | Self::NoSurroundings => Taken::Nothing,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_unique_and_the_hardest_is_first() {
        let mut codes = Condition::codes();
        codes.sort();
        codes.dedup();
        assert_eq!(codes.len(), CODES.len() + Assumed::FIGURES.len());
        let still = |time_s| Condition::StillScene { time_s };
        let mut all = vec![Condition::NoAir, still(0.01), still(2.0), still(88.0)];
        hardest_first(&mut all);
        assert_eq!(all, [still(88.0), still(2.0), Condition::NoAir, still(0.01)]);
        assert!(all.iter().all(|one| Condition::codes().contains(&one.code())));
    }
}
