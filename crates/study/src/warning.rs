//! What the reader of a result must know: a code that programs can rely on, and the data of its message.
//!
//! Codes with their meaning and what to do are rows of [`Code`]; messages are worded in the file `message` alone.

mod catalogue;
mod message;

pub use catalogue::Code;

use crate::proviso::Proviso;
use crate::spoken::{Phrase, Spoken};
use hadar::instrument::Readout;
use hadar::scene::Parameter;
use hadar_simulate::classifier::Method;
use serde::ser::{Serialize, SerializeStruct, Serializer};
use toml::value::Date;

/// Something the reader of a result must know. Its `Display` is the message, one sentence.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields are told with their variant")]
pub enum Warning {
    /// One of a pair of materials.
    OfPair { target: String, alternative: String, warning: Box<Self> },
    /// One that concerns some cameras of several.
    OfCameras { who: String, warning: Box<Self> },

    /// What was passed over or replaced while files of a library were read.
    Library { remark: String },
    /// What the entry of a material says.
    Material { material: String, remark: String },
    /// The target was named among its alternatives.
    TargetAmongAlternatives { target: String },
    /// The spectrum does not cover the bands.
    MaterialSkipped { material: String },
    /// A class of the scenario is called as a material that is entered as one number.
    ClassReplacesPlaceholder { class: String },
    /// Figures of a camera are solved for one pair of members of classes.
    SolvedForOnePair { target: String, alternative: String },
    /// Classes stand by the pair of members that is hardest to tell apart.
    WorstMembers { target: String, alternative: String },

    /// A cube that was read so, whose first axis may be the bands.
    AxesInDoubt { rows: usize, columns: usize, bands: usize },
    /// Bands said as wavelengths, of a cube whose file does not say their order.
    BandOrderTaken,
    /// The file of a cube lists wavelengths without a unit.
    WavelengthsUnused,
    /// Pixels that are 0 in all bands, of so many that were looked at.
    CubeDark { view: &'static str, pixels: usize, of: usize },
    /// Pixels with a sample at the largest value of all, of so many that were looked at; and whether it is the largest that the file's type has.
    CubeSaturated { view: &'static str, pixels: usize, of: usize, value: f64, largest: bool },
    /// Windows with a missing sample.
    WindowsMissing { windows: usize, of: usize },
    /// Pixels with a missing sample.
    PixelsSkipped { pixels: usize, of: usize },
    /// Pixels that no material explains.
    LibraryDoesNotFit { pixels: usize, of: usize },
    /// Pixels that have no emissivity by themselves, of so many that were looked at.
    NoRelativeEmissivity { pixels: usize, of: usize },
    /// A library of one emissivity for all pixels.
    OneCluster,
    /// Clusters whose pixels all went to others, of so many that were asked for.
    ClustersWithoutPixels { left: usize, asked: usize },
    /// Emissivities of which the magnitude is hardly told: names, and the largest deviation of their means.
    MagnitudeHardlyTold { clusters: Vec<String>, sigma: f64 },
    /// Clusters whose pixels one emissivity does not explain, and the largest χ²/ν of them.
    ClusterDoesNotFit { clusters: Vec<String>, chi_square: f64 },
    /// So many surroundings, and nothing said of how much they light together.
    MirrorNotExcluded { surroundings: usize },
    /// A last round that still changed something.
    ClustersNotSettled { rounds: usize },
    /// Objects most of whose pixels have no decided material, of so many that are listed.
    ObjectsUndecided { objects: usize, of: usize },
    /// Share of differences that were left out of a noise.
    NoiseOutliers { share: f64 },
    /// Largest texture that was taken out of the noise of a band, over that noise.
    TextureInNoise { share: f64 },
    /// χ²/ν of the noise of bands about one line, and what it stays below by chance.
    BandsDifferInNoise { chi_square: f64, limit: f64 },
    /// Variance that a sample without light would have, its error, and the level that was taken as no light.
    NoiseBelowZero { electronic: f64, sigma: f64, dark_level: f64 },
    /// Slope of variance over mean, and its error.
    PhotonsNotTold { per_photon: f64, sigma: f64 },
    /// Lines that are off in all bands alike.
    LinesLikeObjects { axis: &'static str, lines: Vec<usize> },
    /// Lines of single bands that look striped in a part of their length and were left, as (line, band).
    LinesOffInPart { axis: &'static str, lines: Vec<[usize; 2]> },
    /// Such lines that are off the same way in bands side by side.
    LinesOffBeside { axis: &'static str, lines: Vec<[usize; 2]> },
    /// Such lines at a step that the bands beside do not have.
    LinesBesideSteps { axis: &'static str, lines: Vec<[usize; 2]> },
    /// Lines of single bands of which all samples are the same.
    LinesDead { axis: &'static str, lines: Vec<[usize; 2]> },
    /// Lines of single bands that lack half of their samples or more.
    LinesMissing { axis: &'static str, lines: Vec<[usize; 2]> },
    /// Lines that are off in most bands, and were taken as striped since that was asked for.
    StripesInAllBands { axis: &'static str, lines: Vec<usize> },
    /// Lines of single bands that look striped and have no clean one near.
    LinesWithoutReference { axis: &'static str, lines: Vec<[usize; 2]> },
    /// Stripes of a cube of so many bands.
    StripesOfFewBands { bands: usize },
    /// Scatter of the pixels of a blackbody over the stated noise.
    BlackbodyNotEven { blackbody: usize, over: f64 },
    /// Blackbodies whose temperatures are taken as exact since nothing is said of them.
    UncertaintyNotStated { blackbodies: Vec<usize>, of: usize },
    /// Channels whose response is known to no better than a fifth, and the largest error over the response.
    ResponseBarelyKnown { channels: usize, of: usize, worst: f64 },
    /// χ²/ν of readings about a response, and the blackbody that explains most of it by another temperature.
    ResponseDoesNotFit { chi_square: f64, worst: Option<WorstBlackbody> },
    /// χ²/ν of what one vignetting for all filters leaves of the readings.
    VignetteDiffers { chi_square: f64 },
    /// Samples of a scene that are no numbers.
    MissingSamples { samples: usize },
    /// Samples of pixels that respond to nothing.
    DeadSamples { samples: usize },
    /// χ²/ν of blackbodies about straight lines.
    BlackbodiesDoNotFit { chi_square: f64 },
    /// Share of samples beyond the radiances of the blackbodies.
    BeyondBlackbodies { share: f64, low_k: f64, high_k: f64 },
    /// A library without errors.
    LibraryTakenAsExact,
    /// Pixels whose material a prior over the image changed, and whether its last sweep still changed something.
    SpatialPrior { changed: usize, pixels: usize, settled: bool },

    /// Equal emissivities.
    Identical,
    /// What both of a pair are entered as.
    Placeholders { target: String, alternative: String, emissivities: [f64; 2] },
    /// Equal temperatures.
    Equilibrium,
    /// The unknowns imitate the material.
    Blind,
    /// Parameters of the nearest state at ends of ranges that the scenario set, among so many objects around.
    NearestAtEdge { parameters: Vec<Parameter>, objects: usize },
    /// How many nearest distances of the matrix are not proved.
    MatrixNotProved { searches: usize },
    /// Distances per √photon.
    LocalDiffers { local: f64, nearest: f64, ratio: f64 },
    /// Of a pair.
    Fragile,
    /// Of the limiting scene of a rule.
    FragileScene,
    /// Parameters that change nothing, among so many objects around.
    UnknownWithoutEffect { parameters: Vec<Parameter>, objects: usize },
    /// A nearest distance that was searched, what is proved of it, and whether priors kept it from being proved.
    NearestSearch { distance: f64, lower: f64, priors: bool },
    /// A distance that rounding has left few digits of, and its relative error.
    FewDigits { distance: &'static str, relative_error: f64 },
    /// Photons per mode at the lowest wavenumber, and whether the camera's noise has bunching in it.
    Bunching { occupancy: f64, wavenumber_cm1: f64, included: bool },
    /// An envelope beside the one scene.
    EnvelopeNotSearched,

    /// A camera of one band that is modelled with so many.
    BandsModelled { camera: String, bands: usize, readout: Readout },
    /// Width of the widest band that is taken at its centre, cm⁻¹.
    BandsSampled { width_cm1: f64 },
    /// Time until all bands are read.
    SequentialReadout { acquisition_s: f64, bands: usize },
    /// Motion until all bands are exposed.
    MotionBlur { pixels: f64 },
    /// A scenario with a speed and no distance.
    MotionBlurUnknown,
    /// A rule with a speed and no distance.
    RuleMotionBlurUnknown,
    /// What a pixel sees by two statements of a camera.
    ContradictoryView { finer_rad: f64, coarser_rad: f64 },
    /// A rule on a day on which it does not hold.
    NotInForce { day: Date, from: Option<Date>, until: Option<Date> },
    /// Filters and no temperature of the sensor.
    FilterLightLeftOut,
    /// A temperature of the sensor and no filters.
    SensorTemperatureIdle,
    /// Nothing around the target.
    NoSurroundings,
    /// Side of a pixel's footprint, m.
    TargetSizeUnknown { footprint_m: f64 },
    /// Share of the pixel that the target fills.
    TargetSmallerThanPixel { fill: f64 },
    /// Blur λF and radius of the first dark ring at the longest wavelength, beside the pixel.
    Diffraction { wavelength_m: f64, blur_m: f64, ring_m: f64, pixel_m: f64 },
    /// Exposures at a frame rate, and their sum.
    FrameRate { exposures: f64, acquisition_s: f64, frame_rate_hz: f64, exposed_s: f64 },
    /// So many bands of all that lie for the most part outside a range.
    OutsideDetectorRange { outside: usize, bands: usize, range_cm1: [f64; 2] },
    /// By how much the shortcut is off, as a share of the exact distance.
    GammaShortcut { off: f64 },
    /// Photons of a reading.
    FullWell { counts: f64, full_well: f64 },
    /// Photons of the brightest band of the brightest pixel of a scene.
    PixelFull { counts: f64, full_well: f64 },
    /// Figures that no document states, each in the words of the camera's entry.
    CameraFiguresAssumed { camera: String, figures: Vec<String> },
    /// One of them.
    CameraFigureAssumed { figure: String },

    /// A matrix of distances with priors.
    MatrixPriors,
    /// Simulations whose intervals are wider than asked for.
    TrialsEnded { wide: usize, simulations: usize, most_trials: u64, widest: f64, asked: f64 },

    /// Errors of emissivities beside what knows nothing of them.
    EmissivityErrorsLeftOut,
    /// A worst case that was searched for.
    NotProved,
    /// Noise of the brightest scene.
    BrightestNoise,
    /// Frames that take time while something moves.
    FramesInMotion(Proviso),
    /// A figure that is set beside a noise that holds for it.
    NoiseMovesWithFigure { figure: &'static str, condition: &'static str },

    /// Samples of a cube that were looked at.
    SamplesNotChecked { evaluated: usize, samples: usize },
    /// Information that noise of the counts would make, and that demanded.
    NoiseOfDemanded { floor_per_px2: f64, demanded_per_px2: f64 },
    /// Information that noise of the counts would make, and that found.
    NoiseOfFound { floor_per_px2: f64, found_per_px2: f64 },
    /// Disparity error of the cube over that promised.
    ScatteredAsMeasured { ratio: f64 },
    /// Windows that have no bound by a signal.
    DarkSamples { signal: &'static str, left_out: usize, windows: usize },
    /// A cube without depth.
    NoDepth,
    /// Information by another derivative over that by the one asked for.
    Derivative { ratio: f64 },
    /// Two bands, or one.
    FewBands { bands: usize },

    /// A target that looks like the air before it.
    DistanceUnchanged { distance_m: f64 },
    /// A distance whose change others imitate.
    DistanceImitated { distance_m: f64 },
    /// Unknowns of ranging by air that change nothing.
    AirUnknownWithoutEffect { unknowns: Vec<String> },
    /// A distance from a spectrum whose emissivity is taken to be known.
    EmissivityTakenAsExact,
    /// Width of the narrowest band, and of those that the air is known in, cm⁻¹.
    AirBandMeans { narrowest_cm1: f64, table_cm1: f64 },
    /// The nearest distance, and the shortest path of the table, m.
    AirExtrapolated { nearest_m: f64, shortest_m: f64 },
    /// A sky with lines of its own.
    AirMirroredSky,

    /// Priors of a simulation.
    PriorsLeftOut,
    /// The fewest photons of an experiment.
    SpectraEmpty { photons: f64 },
    /// The most photons of an experiment.
    CountsRounded { photons: f64 },
    /// Training spectra of each class.
    FewSpectra { training: usize },
    /// What a saved model was trained with.
    ModelPhotons { method: Method, photons: f64 },
    /// Error of the distribution function.
    NormalLikelihood { error: f64 },
    /// A fixed total of photons.
    LimitNormal,
    /// Largest share of fits of a temperature at an edge, and the share up to which the bound applies.
    RangeHoldsTheEstimates { at_edge: f64, held: f64 },
    /// How many fits.
    UnconvergedFits { fits: usize },
    /// How many sums of counts.
    NoReading { sums: usize },
    /// A spectrum without temperature in it.
    TemperatureNotSeen,
}

impl Warning {
    /// The stable code, with its meaning and what to do.
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::OfPair { warning, .. } | Self::OfCameras { warning, .. } => warning.code(),
            Self::Library { .. } => Code::Library,
            Self::Material { .. } => Code::Material,
            Self::TargetAmongAlternatives { .. } => Code::TargetAmongAlternatives,
            Self::MaterialSkipped { .. } => Code::MaterialSkipped,
            Self::ClassReplacesPlaceholder { .. } => Code::ClassReplacesPlaceholder,
            Self::WorstMembers { .. } => Code::WorstMembers,
            Self::SolvedForOnePair { .. } => Code::SolvedForOnePair,
            Self::AxesInDoubt { .. } => Code::AxesInDoubt,
            Self::BandOrderTaken => Code::BandOrderTaken,
            Self::WavelengthsUnused => Code::WavelengthsUnused,
            Self::CubeDark { .. } => Code::CubeDark,
            Self::CubeSaturated { .. } => Code::CubeSaturated,
            Self::WindowsMissing { .. } => Code::WindowsMissing,
            Self::PixelsSkipped { .. } => Code::PixelsSkipped,
            Self::LibraryDoesNotFit { .. } => Code::LibraryDoesNotFit,
            Self::NoRelativeEmissivity { .. } => Code::NoRelativeEmissivity,
            Self::OneCluster => Code::OneCluster,
            Self::ClustersWithoutPixels { .. } => Code::ClustersWithoutPixels,
            Self::MagnitudeHardlyTold { .. } => Code::MagnitudeHardlyTold,
            Self::ClustersNotSettled { .. } => Code::ClustersNotSettled,
            Self::ClusterDoesNotFit { .. } => Code::ClusterDoesNotFit,
            Self::MirrorNotExcluded { .. } => Code::MirrorNotExcluded,
            Self::ObjectsUndecided { .. } => Code::ObjectsUndecided,
            Self::NoiseOutliers { .. } => Code::NoiseOutliers,
            Self::TextureInNoise { .. } => Code::TextureInNoise,
            Self::BandsDifferInNoise { .. } => Code::BandsDifferInNoise,
            Self::NoiseBelowZero { .. } => Code::NoiseBelowZero,
            Self::PhotonsNotTold { .. } => Code::PhotonsNotTold,
            Self::LinesLikeObjects { .. } => Code::LinesLikeObjects,
            Self::LinesOffInPart { .. } => Code::LinesOffInPart,
            Self::LinesOffBeside { .. } => Code::LinesOffBeside,
            Self::LinesBesideSteps { .. } => Code::LinesBesideSteps,
            Self::LinesDead { .. } => Code::LinesDead,
            Self::LinesMissing { .. } => Code::LinesMissing,
            Self::LinesWithoutReference { .. } => Code::LinesWithoutReference,
            Self::StripesInAllBands { .. } => Code::StripesInAllBands,
            Self::StripesOfFewBands { .. } => Code::StripesOfFewBands,
            Self::BlackbodyNotEven { .. } => Code::BlackbodyNotEven,
            Self::UncertaintyNotStated { .. } => Code::UncertaintyNotStated,
            Self::ResponseBarelyKnown { .. } => Code::ResponseBarelyKnown,
            Self::VignetteDiffers { .. } => Code::VignetteDiffers,
            Self::ResponseDoesNotFit { .. } => Code::ResponseDoesNotFit,
            Self::MissingSamples { .. } => Code::MissingSamples,
            Self::DeadSamples { .. } => Code::DeadSamples,
            Self::BlackbodiesDoNotFit { .. } => Code::BlackbodiesDoNotFit,
            Self::BeyondBlackbodies { .. } => Code::BeyondBlackbodies,
            Self::LibraryTakenAsExact => Code::LibraryTakenAsExact,
            Self::SpatialPrior { .. } => Code::SpatialPrior,
            Self::Identical => Code::Identical,
            Self::Equilibrium => Code::Equilibrium,
            Self::Blind => Code::Blind,
            Self::NearestAtEdge { .. } => Code::NearestAtEdge,
            Self::MatrixNotProved { .. } => Code::NearestSearch,
            Self::LocalDiffers { .. } => Code::LocalDiffers,
            Self::Fragile | Self::FragileScene => Code::Fragile,
            Self::UnknownWithoutEffect { .. } => Code::UnknownWithoutEffect,
            Self::NearestSearch { .. } => Code::NearestSearch,
            Self::FewDigits { .. } => Code::FewDigits,
            Self::Bunching { .. } => Code::Bunching,
            Self::EnvelopeNotSearched => Code::EnvelopeNotSearched,
            Self::BandsModelled { .. } => Code::BandsModelled,
            Self::BandsSampled { .. } => Code::BandsSampled,
            Self::SequentialReadout { .. } => Code::SequentialReadout,
            Self::MotionBlur { .. } => Code::MotionBlur,
            Self::MotionBlurUnknown | Self::RuleMotionBlurUnknown => Code::MotionBlurUnknown,
            Self::ContradictoryView { .. } => Code::ContradictoryView,
            Self::NotInForce { .. } => Code::NotInForce,
            Self::FilterLightLeftOut | Self::SensorTemperatureIdle => Code::FilterLight,
            Self::Placeholders { .. } => Code::Placeholders,
            Self::NoSurroundings => Code::NoSurroundings,
            Self::TargetSizeUnknown { .. } => Code::TargetSizeUnknown,
            Self::TargetSmallerThanPixel { .. } => Code::TargetSmallerThanPixel,
            Self::Diffraction { .. } => Code::Diffraction,
            Self::FrameRate { .. } => Code::FrameRate,
            Self::OutsideDetectorRange { .. } => Code::OutsideDetectorRange,
            Self::GammaShortcut { .. } => Code::GammaShortcut,
            Self::FullWell { .. } | Self::PixelFull { .. } => Code::FullWell,
            Self::CameraFiguresAssumed { .. } | Self::CameraFigureAssumed { .. } => Code::CameraFigureAssumed,
            Self::MatrixPriors => Code::MatrixPriors,
            Self::TrialsEnded { .. } => Code::TrialsEnded,
            Self::EmissivityErrorsLeftOut => Code::EmissivityErrorsLeftOut,
            Self::NotProved => Code::NotProved,
            Self::BrightestNoise => Code::BrightestNoise,
            Self::FramesInMotion(_) => Code::FramesInMotion,
            Self::NoiseMovesWithFigure { .. } => Code::NoiseMovesWithFigure,
            Self::SamplesNotChecked { .. } => Code::SamplesNotChecked,
            Self::NoiseOfDemanded { .. } | Self::NoiseOfFound { .. } => Code::NoiseInCounts,
            Self::DarkSamples { .. } => Code::DarkSamples,
            Self::ScatteredAsMeasured { .. } => Code::ScatteredAsMeasured,
            Self::NoDepth => Code::NoDepth,
            Self::Derivative { .. } => Code::Derivative,
            Self::FewBands { .. } => Code::FewBands,
            Self::DistanceUnchanged { .. } | Self::DistanceImitated { .. } => Code::DistanceNotSeen,
            Self::AirUnknownWithoutEffect { .. } => Code::UnknownWithoutEffect,
            Self::EmissivityTakenAsExact => Code::EmissivityTakenAsExact,
            Self::AirBandMeans { .. } => Code::AirBandMeans,
            Self::AirExtrapolated { .. } => Code::AirExtrapolated,
            Self::AirMirroredSky => Code::AirMirroredSky,
            Self::PriorsLeftOut => Code::PriorsLeftOut,
            Self::SpectraEmpty { .. } => Code::SpectraEmpty,
            Self::CountsRounded { .. } => Code::CountsRounded,
            Self::FewSpectra { .. } => Code::FewSpectra,
            Self::ModelPhotons { .. } => Code::ModelPhotons,
            Self::NormalLikelihood { .. } => Code::NormalLikelihood,
            Self::LimitNormal => Code::LimitNormal,
            Self::RangeHoldsTheEstimates { .. } => Code::RangeHoldsTheEstimates,
            Self::UnconvergedFits { .. } => Code::UnconvergedFits,
            Self::NoReading { .. } => Code::NoReading,
            Self::TemperatureNotSeen => Code::TemperatureNotSeen,
        }
    }
}

impl Warning {
    /// The same, said of cameras among several.
    #[must_use]
    pub fn of_cameras(self, who: &str) -> Self {
        Self::OfCameras { who: who.to_owned(), warning: Box::new(self) }
    }

    /// Whether a reader is told the same, digits that are not shown left out.
    #[must_use]
    pub fn says_as(&self, other: &Self) -> bool {
        self.code() == other.code() && self.to_string() == other.to_string()
    }
}

/// A blackbody whose readings are those of another temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorstBlackbody {
    /// Its place, from 0.
    pub blackbody: usize,
    /// Its temperature as stated, K.
    pub temperature_k: f64,
    /// By how much warmer its readings are than that, K.
    pub off_k: f64,
}

impl Serialize for Warning {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut object = serializer.serialize_struct("Warning", 2)?;
        object.serialize_field("code", self.code().name())?;
        object.serialize_field("message", &Spoken(Phrase::Warning(self)))?;
        object.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_warning_is_its_code_and_its_message() {
        let of_pair = Warning::OfPair {
            target: "skin".into(),
            alternative: "pmma".into(),
            warning: Box::new(Warning::NearestAtEdge {
                parameters: vec![Parameter::Temperature, Parameter::Lighting(1)],
                objects: 2,
            }),
        };
        let said = serde_json::to_string(&of_pair).unwrap();
        assert_eq!(
            said,
            "{\"code\":\"nearest-at-edge\",\"message\":\"skin against pmma: the nearest state stands at the edge of its range \
             (temperature, lighting of environment[1]); the range decides the answer\"}"
        );
        // Digits that are not shown make no second warning.
        let moving = |time_s| Warning::FramesInMotion(Proviso { frames: 60, time_s, way_m: 1.7 });
        assert!(moving(1.0).says_as(&moving(1.0 + 1e-9)) && !moving(1.0).says_as(&moving(1.2)));
    }
}
