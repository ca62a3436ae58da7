//! What a verdict rests on beside the distance: data made with the answer, never read back from remarks.
//!
//! A figure that nobody stated is asked for, or the worst value stands for it, or it is a favourable condition here: a 'yes' holds only if
//! it is as good as what was taken. What absence means, figure by figure:
//!
//! | not stated | means |
//! |---|---|
//! | of the camera | [`hadar::instrument::Camera::assumed`]: asked for, the worst, or [`Condition::Assumed`] |
//! | `target.distance`, `target.size` | the target fills a pixel: [`Condition::FillsPixel`] |
//! | `requirement.of` | the verdict is of one pixel; of an object [`Condition::AlikePixels`] and [`Condition::FrameNoise`] |
//! | `background` | asked for where the target does not fill its pixel |
//! | `[atmosphere]` | the air takes nothing away: [`Condition::NoAir`] |
//! | `[[environment]]` | nothing lights the target: [`Condition::NoSurroundings`], or no more than is there: [`Condition::DarkRest`] |
//! | `[alternatives]` ranges | all that physics allows, the worst; where a range that was set decides, [`Condition::Range`] |
//! | `gain`, `environment-temperature` among `unknown.nuisances` | they are known: [`Condition::Calibrated`], [`Condition::SurroundingsKnown`] |
//! | `temperature`, `lighting` among them | they are known: [`Condition::TemperatureKnown`], [`Condition::LightingKnown`] |
//! | `material` of an `[[environment]]` | it is black, which [`Condition::SurroundingsKnown`] says |
//! | `requirement.speed` | nothing moves while frames and bands are read: [`Condition::StillScene`] |
//! | `stop.crossing_speed` | nothing but the vehicle moves: [`Condition::NobodyCrosses`]; of who crosses [`Condition::InView`] where the view is not stated |
//! | `requirement.time` | the decision may wait: [`Condition::StillScene`], at a speed [`Condition::Waits`] |
//! | reliability | d = 1, which the sentence tells |

use crate::Shortfall;
use crate::proviso::Proviso;
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
        /// What the verdict is of.
        Scope = "scope",
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
    /// The widest that was found not to change the answer, likewise; `None` where it was not searched.
    pub holds: Option<[f64; 2]>,
}

/// What is said of a condition whatever its data.
#[derive(Debug, Clone, Copy)]
struct Row {
    code: &'static str,
    kind: ConditionKind,
    figure: &'static str,
}

/// Makes the conditions and their rows of one table: documentation, data, code, kind, and the key that would settle it. A sentence and an
/// explanation for each are in `hadar_report::words::conditions`.
macro_rules! conditions {
    ($(
        $(#[doc = $of:literal])+
        $variant:ident $({ $($(#[doc = $field_of:literal])+ $field:ident: $type:ty,)+ })? $(($tuple:ty))?
            = $code:literal, $kind:ident, $figure:literal;
    )+) => {
        /// What a verdict rests on.
        #[derive(Debug, Clone, PartialEq)]
        pub enum Condition {
            $($(#[doc = $of])+ $variant $({ $($(#[doc = $field_of])+ $field: $type,)+ })? $(($tuple))?,)+
        }

        /// The hardest to keep first.
        const ROWS: &[Row] = &[$(Row { code: $code, kind: ConditionKind::$kind, figure: $figure },)+];

        impl Condition {
            /// Its place among the rows.
            fn place(&self) -> usize {
                let mut place = 0;
                $(
                    if matches!(self, Self::$variant { .. }) {
                        return place;
                    }
                    place += 1;
                )+
                place
            }
        }
    };
}

conditions! {
    /// A value in the place of the file's.
    Setting {
        /// Its key.
        key: String,
        /// The value.
        value: String,
        /// Whether it stands in the place of what a rule says, which is then another rule.
        of_rule: bool,
    } = "setting", Setting, "";
    /// A range that the scenario sets keeps out states that would not be told apart.
    Range(RangeDecides) = "range", Range, "alternatives.temperature";
    /// What spoils the image, where distances alone are compared.
    Spoiled {
        /// By what.
        by: Shortfall,
    } = "image", Proviso, "camera.exposure";
    /// A reading of the distance decides which is no limit.
    NoLimit = "no-limit", Assumed, "requirement.by";
    /// A camera of one band that its entry models as if it read so many at once.
    Modelled {
        /// How many.
        bands: usize,
    } = "modelled", Assumed, "camera.readout";
    /// The emissivities of an object's materials are as entered: nobody states their errors, which all of its pixels share.
    SharedErrors {
        /// Root mean square.
        error: f64,
        /// Statistical distance with such errors, at most.
        distance: f64,
        /// Whether what is proved with them does not reach the requirement.
        undone: bool,
    } = "shared-emissivity-errors", Proviso, "sensitivity.emissivity_error";
    /// Frames that are added up while something moves.
    RegisteredFrames(Proviso) = "registered-frames", Proviso, "camera.frames";
    /// Nothing moves until all bands of all frames are read.
    StillScene {
        /// For so long, s.
        time_s: f64,
    } = "still-scene", Proviso, "requirement.speed";
    /// Materials that are entered as one number for all wavenumbers.
    Constants {
        /// The two of the pair that decides.
        emissivities: [f64; 2],
    } = "constant-emissivities", Assumed, "alternatives.materials";
    /// Spectra go on beyond where they were measured as they are guessed to.
    Extrapolated {
        /// Of which materials.
        materials: Vec<String>,
    } = "extrapolated", Assumed, "target.extrapolate";
    /// Materials that were left out of the alternatives, or that a class lacks.
    LeftOut {
        /// Their names.
        materials: Vec<String>,
    } = "materials-left-out", Omitted, "alternatives.skip_uncovered";
    /// Emissivities are known better than to an error with which too few draws meet the requirement.
    Emissivities {
        /// Root mean square.
        error: f64,
        /// Share of the draws.
        share_met: f64,
    } = "emissivities", Proviso, "sensitivity.emissivity_error";
    /// The emissivity of what is measured is exactly as entered.
    EmissivityKnown = "emissivity-known", Assumed, "sensitivity.emissivity_error";
    /// The temperature of the air on the path is exactly as entered.
    AirTemperatureKnown = "air-temperature-known", Assumed, "unknown.nuisances";
    /// Nothing but the shot noise of its counts is in a cube.
    ShotNoiseAlone = "shot-noise-alone", Assumed, "cube.noise_variance";
    /// A unit of the samples of a cube is a photon.
    SamplesArePhotons = "samples-are-photons", Assumed, "cube.photons_per_unit";
    /// The counts of a cube are expectations, none of their texture noise.
    ExpectedCounts = "expected-counts", Proviso, "cube.left";
    /// What is ranged looks as in the one scene that is rendered.
    OneScene = "one-scene", Assumed, "stereo";
    /// The pixels that are added up are the target's, and all see the same of it.
    AlikePixels {
        /// How many.
        pixels: f64,
        /// Whether a square stands for rows and columns that nobody states.
        square: bool,
    } = "alike-pixels", Scope, "requirement.of";
    /// Errors of the emissivities are correlated over a length that nobody states.
    ErrorsCorrelated {
        /// The length that is taken, cm⁻¹.
        length_cm1: f64,
    } = "errors-correlated", Assumed, "sensitivity.correlation";
    /// What rows, columns and pixels of an array have in common is another pattern in every band.
    PatternOfEachBand = "pattern-of-each-band", Assumed, "camera.fixed_pattern";
    /// What rows and columns of an array have in common is another noise in every pixel of a window.
    PatternOfEachPixel = "pattern-of-each-pixel", Assumed, "camera.row_noise";
    /// The pixels on an object are counted by the lens, where the view contradicts it.
    PixelsByLens = "pixels-by-lens", Assumed, "camera.field_of_view";
    /// Rows, columns and frames have no noise of their own beside that of the pixels.
    FrameNoise {
        /// Keys of the camera that are not stated.
        figures: Vec<&'static str>,
    } = "frame-noise", Assumed, "camera.frame_noise";
    /// The target fills the pixel.
    FillsPixel {
        /// Side of what the pixel sees, m, where the distance is known.
        footprint_m: Option<f64>,
    } = "fills-pixel", Assumed, "target.size";
    /// Bands beyond the stated range of the detector.
    BeyondRange {
        /// How many.
        outside: usize,
        /// Of how many.
        bands: usize,
    } = "beyond-range", Assumed, "camera.spectral_range";
    /// The target fills a part of one pixel and lies in no other.
    InOnePixel {
        /// Share of the pixel.
        fill: f64,
    } = "in-one-pixel", Assumed, "target.size";
    /// The lens blurs a point over more than a pixel.
    Diffraction {
        /// Over how much, m.
        blur_m: f64,
    } = "diffraction", Assumed, "camera.pixel";
    /// A figure of the camera that nobody stated.
    Assumed {
        /// The figure, and what stands for it.
        figure: Assumed,
        /// Counts of the fullest reading, where it is the full well.
        counts: Option<f64>,
    } = "", Assumed, "";
    /// Photon bunching that was not asked for would decide.
    Bunching {
        /// Photons per mode.
        occupancy: f64,
    } = "photon-bunching", Assumed, "camera.photon_bunching";
    /// Filters neither shine nor throw the sensor's light back.
    NoFilterLight = "no-filter-light", Assumed, "camera.sensor_temperature";
    /// Nothing but the vehicle moves: what is looked for neither crosses nor leaves the view.
    NobodyCrosses = "nobody-crosses", Proviso, "stop.crossing_speed";
    /// Who crosses is in the view until the decision.
    InView {
        /// How far beside the axis that is, rad.
        bearing_rad: f64,
    } = "in-view", Assumed, "camera.field_of_view";
    /// Filters pass at the angles of the beam what they pass at right angles.
    FilterAngle {
        /// Whether they stand before the lens, so that the target must be near the axis.
        before_lens: bool,
        /// Sine of the rim of the cone of light.
        sine: f64,
    } = "filter-angle", Assumed, "bands.place";
    /// Filters transmit nothing beyond the rows of their table.
    FilterCut {
        /// What they transmit at its ends, at most.
        share: f64,
    } = "filter-cut", Assumed, "bands.filters";
    /// Wide bands are taken at their centres.
    Sampled {
        /// Width of the widest, cm⁻¹.
        width_cm1: f64,
    } = "bands-sampled", Assumed, "bands.integrate";
    /// The air takes nothing away.
    NoAir = "no-air", Assumed, "atmosphere";
    /// Nothing around the target lights it.
    NoSurroundings = "no-surroundings", Assumed, "environment";
    /// A part of the hemisphere above the target that no object fills is black and cold.
    DarkRest {
        /// What part.
        share: f64,
    } = "dark-rest", Assumed, "environment";
    /// The decision may wait until all bands of all frames are read.
    Waits {
        /// So long, s.
        time_s: f64,
    } = "acquisition-time", Proviso, "requirement.time";
    /// The temperatures of what is around the target are known.
    SurroundingsKnown {
        /// How many surroundings are black, as no material is stated.
        black: usize,
    } = "surroundings-known", Assumed, "unknown.nuisances";
    /// The temperature of the target is known.
    TemperatureKnown = "temperature-known", Assumed, "unknown.nuisances";
    /// How much each of the surroundings lights the target is known.
    LightingKnown = "lighting-known", Assumed, "unknown.nuisances";
    /// The gain of the camera is known.
    Calibrated = "calibrated", Assumed, "unknown.nuisances";
}

impl Condition {
    /// All codes.
    #[must_use]
    pub fn codes() -> Vec<String> {
        let figures = Assumed::FIGURES.iter().map(|figure| kebab(figure));
        let own = ROWS.iter().map(|row| row.code).filter(|code| !code.is_empty());
        own.map(str::to_owned).chain(figures).collect()
    }

    fn row(&self) -> Option<&'static Row> {
        ROWS.get(self.place())
    }

    /// Stable code, e.g. `still-scene`, or the key of a camera figure, e.g. `full-well`.
    #[must_use]
    pub fn code(&self) -> String {
        match self {
            Self::Assumed { figure, .. } => kebab(figure.figure),
            _ => self.row().map_or_else(String::new, |row| row.code.to_owned()),
        }
    }

    /// Whether another is of the same code.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        self.code().eq(&other.code())
    }

    /// Its kind.
    #[must_use]
    pub fn kind(&self) -> ConditionKind {
        self.row().map_or(ConditionKind::Assumed, |row| row.kind)
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

    /// Those without which a 'yes' may be none, hardest first.
    pub fn open(conditions: &[Self]) -> impl Iterator<Item = &Self> {
        conditions.iter().filter(|one| one.favourable())
    }

    /// Those of them that are not among the accepted codes: with one of them, a 'yes' is none that a program may rely on.
    pub fn unaccepted<'a>(conditions: &'a [Self], accepted: &'a [String]) -> impl Iterator<Item = &'a Self> {
        Self::open(conditions).filter(|one| !accepted.contains(&one.code()))
    }

    /// Whether a program may rely on a verdict: it is met, under no condition but the accepted ones.
    #[must_use]
    pub fn hold(met: Option<bool>, conditions: &[Self], accepted: &[String]) -> bool {
        met == Some(true) && Self::unaccepted(conditions, accepted).next().is_none()
    }

    /// Whether a verdict rests on it: a 'no' on what was taken on the unfavourable side, and on a readout, which is slow where nobody says.
    pub(crate) fn counts(&self, met: bool) -> bool {
        let is_readout = matches!(self, Self::Assumed { figure, .. } if figure.figure == "readout");
        met || is_readout || !self.favourable()
    }

    /// The key that would settle it.
    #[must_use]
    pub fn figure(&self) -> String {
        match self {
            Self::Range(range) => range.figure.to_owned(),
            Self::Assumed { figure, .. } => format!("camera.{}", figure.figure),
            Self::FillsPixel { footprint_m: None } => "target.distance".to_owned(),
            Self::Setting { key, .. } => key.clone(),
            _ => self.row().map_or_else(String::new, |row| row.figure.to_owned()),
        }
    }

    /// How hard it is to keep, hardest first: the sentence of a 'yes' names the first. By the rows, then by how much of it there is.
    pub(crate) fn rank(&self) -> (usize, f64) {
        /// Nobody stands still for longer than this without a word, s.
        const STILL_S: f64 = 0.1;
        let short = Self::Waits { time_s: 0.0 }.place();
        let place = match self {
            Self::StillScene { time_s } if *time_s <= STILL_S => short,
            // Errors that would not undo it are as those of a pixel.
            Self::SharedErrors { undone: false, .. } => {
                Self::Emissivities { error: 0.0, share_met: 1.0 }.place()
            }
            // What makes nothing better stands last.
            _ if !self.favourable() => ROWS.len(),
            _ => self.place(),
        };
        let less = match self {
            Self::RegisteredFrames(proviso) => -proviso.way_m,
            Self::StillScene { time_s } | Self::Waits { time_s } => -time_s,
            Self::Emissivities { share_met, .. } => *share_met,
            Self::FillsPixel { footprint_m } => footprint_m.map_or(f64::NEG_INFINITY, |side| -side),
            Self::Assumed { figure, .. } => {
                let place = Assumed::FIGURES.iter().position(|key| *key == figure.figure);
                place.map_or(0.0, |place| place as f64)
            }
            Self::Setting { .. } => f64::INFINITY,
            _ => 0.0,
        };
        (place, less)
    }
}

/// Puts the hardest first.
pub(crate) fn hardest_first(conditions: &mut [Condition]) {
    conditions.sort_by(|a, b| {
        let (a, b) = (a.rank(), b.rank());
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
}

fn kebab(key: &str) -> String {
    key.replace('_', "-")
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
            Self::StillScene { time_s } | Self::Waits { time_s } => Taken::Number(*time_s),
            Self::SurroundingsKnown { black } => Taken::Number(*black as f64),
            Self::DarkRest { share } | Self::FilterCut { share } => Taken::Number(*share),
            Self::Constants { emissivities } => Taken::Pair(*emissivities),
            Self::Emissivities { error, .. } | Self::SharedErrors { error, .. } => Taken::Number(*error),
            Self::Assumed { counts: Some(counts), .. } => Taken::Number(*counts),
            Self::Assumed { figure, .. } => Taken::Text(&figure.taken),
            Self::Bunching { occupancy } => Taken::Number(*occupancy),
            Self::Modelled { bands } => Taken::Number(*bands as f64),
            Self::BeyondRange { outside, .. } => Taken::Number(*outside as f64),
            Self::Sampled { width_cm1 } => Taken::Number(*width_cm1),
            Self::ErrorsCorrelated { length_cm1 } => Taken::Number(*length_cm1),
            Self::InOnePixel { fill } => Taken::Number(*fill),
            Self::InView { bearing_rad } => Taken::Number(*bearing_rad),
            Self::FilterAngle { sine, .. } => Taken::Number(*sine),
            Self::Diffraction { blur_m } => Taken::Number(*blur_m),
            Self::FillsPixel { footprint_m: Some(footprint_m) } => Taken::Number(*footprint_m),
            Self::AlikePixels { pixels, .. } => Taken::Number(*pixels),
            Self::FrameNoise { figures } => Taken::Texts(figures.clone()),
            Self::LeftOut { materials } | Self::Extrapolated { materials } => {
                Taken::Texts(materials.iter().map(String::as_str).collect())
            }
            Self::Setting { value, .. } => Taken::Text(value),
            Self::Spoiled { by } => Taken::Text(by.code()),
            Self::NoLimit
            | Self::FillsPixel { .. }
            | Self::NoFilterLight
            | Self::NobodyCrosses
            | Self::NoAir
            | Self::EmissivityKnown
            | Self::AirTemperatureKnown
            | Self::ShotNoiseAlone
            | Self::SamplesArePhotons
            | Self::ExpectedCounts
            | Self::OneScene
            | Self::PatternOfEachBand
            | Self::PatternOfEachPixel
            | Self::PixelsByLens
            | Self::TemperatureKnown
            | Self::LightingKnown
            | Self::Calibrated
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
        assert_eq!(codes.len(), ROWS.len() - 1 + Assumed::FIGURES.len());
        let still = |time_s| Condition::StillScene { time_s };
        let mut all = vec![Condition::NoAir, still(0.01), still(2.0), still(88.0)];
        hardest_first(&mut all);
        assert_eq!(all, [still(88.0), still(2.0), Condition::NoAir, still(0.01)]);
        assert!(all.iter().all(|one| Condition::codes().contains(&one.code())));
        // Each by its own row.
        assert_eq!((all[0].code(), all[2].code()), ("still-scene".into(), "no-air".into()));
        assert_eq!((all[0].kind(), all[2].kind()), (ConditionKind::Proviso, ConditionKind::Assumed));
    }
}
