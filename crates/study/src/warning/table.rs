//! Every warning by a row: what it is of, its data, its code. Its words are a block of `hadar_report::words::warnings`.

use crate::model_judged::CauseRow;
use crate::proviso::Proviso;
use crate::rule::NotInForce;
use crate::warning::WorstBlackbody;
use hadar::instrument::{Assumed, Readout};
use hadar::scene::Parameter;
use hadar_simulate::classifier::Method;

/// Makes warnings and codes of one table. A row ends in the name of the code that it brings, or in the warning whose code it shares.
macro_rules! warnings {
    (@of $name:literal $code:expr) => { $code };
    ($(
        $(#[doc = $of:literal])+
        $variant:ident $({ $($field:ident: $type:ty),+ })? $(($tuple:ty))? $(= $name:literal)? $(as $shared:ident)?;
    )+) => {
        /// Something the reader of a result must know: data, without words.
        #[derive(Debug, Clone, PartialEq)]
        #[expect(missing_docs, reason = "fields are told with their variant")]
        pub enum Warning {
            /// One of a pair of materials.
            OfPair { target: String, alternative: String, warning: Box<Self> },
            /// One that concerns some cameras of several.
            OfCameras { who: String, warning: Box<Self> },
            $($(#[doc = $of])+ $variant $({ $($field: $type),+ })? $(($tuple))?,)+
        }

        /// Stable code of a warning.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Code {
            $($(#[doc = concat!("`", $name, "`.")] $variant,)?)+
        }

        impl Code {
            /// All of them.
            pub const ALL: &'static [Self] = &[$($(warnings!(@of $name Self::$variant),)?)+];

            /// The code as programs know it, e.g. `nearest-at-edge`.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $($(Self::$variant => $name,)?)+ }
            }
        }

        impl Warning {
            /// Names of all warnings that are of nothing else, with their codes: whoever has words for all of them can let the compiler
            /// see that none is forgotten.
            pub const ALL: &'static [(&'static str, Code)] = &[
                $((stringify!($variant), $(warnings!(@of $name Code::$variant))? $(Code::$shared)?),)+
            ];

            /// The stable code.
            #[must_use]
            pub fn code(&self) -> Code {
                match self {
                    Self::OfPair { warning, .. } | Self::OfCameras { warning, .. } => warning.code(),
                    $(Self::$variant { .. } => $(warnings!(@of $name Code::$variant))? $(Code::$shared)?,)+
                }
            }
        }
    };
}

warnings! {
    /// What was passed over or replaced while files of a library were read.
    Library { remark: String } = "library";
    /// What the entry of a material says.
    Material { material: String, remark: String } = "material";
    /// The target was named among its alternatives.
    TargetAmongAlternatives { target: String } = "target-among-alternatives";
    /// The spectrum does not cover the bands.
    MaterialSkipped { material: String } = "material-skipped";
    /// A class of the scenario is called as a material that is entered as one number.
    ClassReplacesPlaceholder { class: String } = "class-replaces-placeholder";
    /// Figures of a camera are solved for one pair of members of classes.
    SolvedForOnePair { target: String, alternative: String } = "solved-for-one-pair";
    /// Classes stand by the pair of members that is hardest to tell apart.
    WorstMembers { target: String, alternative: String } = "worst-members";

    /// A cube that was read so, whose first axis may be the bands.
    AxesInDoubt { rows: usize, columns: usize, bands: usize } = "axes-in-doubt";
    /// A cube whose samples are in another unit by its file than by the scenario.
    UnitConverted { file: String, scenario: String, of_mean: f64 } = "unit-converted";
    /// Bands that begin with the shortest wavelength, of a cube whose file does not say their order; and whether they are a list, which says it.
    BandOrderTaken { listed: bool } = "band-order-taken";
    /// The file of a cube lists wavelengths without a unit.
    WavelengthsUnused = "wavelengths-unused";
    /// Pixels that are 0 in all bands, of so many that were looked at.
    CubeDark { view: &'static str, pixels: usize, of: usize } = "cube-dark";
    /// Pixels with a sample at the largest value of all, of so many that were looked at; and whether it is the largest that the file's type has.
    CubeSaturated { view: &'static str, pixels: usize, of: usize, value: f64, largest: bool } = "cube-saturated";
    /// Windows with a missing sample.
    WindowsMissing { windows: usize, of: usize } = "windows-missing";
    /// Pixels with a missing sample.
    PixelsSkipped { pixels: usize, of: usize } = "pixels-skipped";
    /// Rows that stand for surroundings and are not all alike.
    RowsUneven { environment: usize, pixels: usize, of: usize } = "rows-uneven";
    /// Bands that are left out as they were found to be bad.
    BandsFoundBad { bands: Vec<usize>, why: &'static str } = "bands-found-bad";
    /// Filters that are left out of a calibration as their bands were found to be bad.
    FiltersLeftOut { filters: Vec<String>, why: &'static str } = "filters-left-out";
    /// Pixels that are left out as they were found to be bad.
    PixelsFoundBad { pixels: usize, of: usize, why: &'static str } = "pixels-found-bad";
    /// Pixels of a view that are missing as they were found to be bad.
    ViewFoundBad { view: &'static str, pixels: usize, of: usize, why: &'static str } as PixelsFoundBad;
    /// Pixels that no material explains.
    LibraryDoesNotFit { pixels: usize, of: usize } = "library-does-not-fit";
    /// A cube that does not follow the model it is decomposed with.
    ModelRejected { if_it_holds: usize, causes: Vec<CauseRow> } = "model-rejected";
    /// A library without errors.
    LibraryTakenAsExact = "library-taken-as-exact";
    /// Largest error of the emissivities of a material, over what it reflects.
    LibraryErrorNotSmall { share: f64 } = "library-error-not-small";

    /// Bands whose lines differ from those beside them beyond noise, the rms of it and what noise explains, over their level, in the worst band.
    LinesDiffer { axis: &'static str, bands: Vec<usize>, of: usize, apart: f64, noise: f64 } = "lines-differ";
    /// Lines that are off in all bands alike.
    LinesLikeObjects { axis: &'static str, lines: Vec<usize> } = "lines-like-objects";
    /// Scatter of the pixels of a blackbody over the stated noise.
    BlackbodyNotEven { blackbody: usize, over: f64 } = "blackbody-not-even";
    /// Blackbodies whose temperatures are taken as exact since nothing is said of them.
    UncertaintyNotStated { blackbodies: Vec<usize>, of: usize } = "uncertainty-not-stated";
    /// Two blackbodies lie on any line: what a bend of this share of their span is in the middle, K.
    LinearityNotTested { share: f64, off_k: f64 } = "linearity-not-tested";
    /// Keys of a response's smoothness of which nothing is said, and the errors of its values (rms, of its peak): as smooth as is taken, and
    /// of a response with kinks.
    SmoothnessNotStated { keys: Vec<&'static str>, smooth: f64, kinked: f64 } = "smoothness-not-stated";
    /// Blackbodies that are taken as black since nothing is said of it, and by how much the warmest (K) would send less of this emissivity.
    BlackbodiesTakenAsBlack {
        blackbodies: Vec<usize>,
        of: usize,
        emissivity: f64,
        warm_k: f64,
        colder_k: f64
    } = "blackbodies-taken-as-black";
    /// Channels whose response is known to no better than a fifth, and the largest error over the response.
    ResponseBarelyKnown { channels: usize, of: usize, worst: f64 } = "response-barely-known";
    /// χ²/ν of what one vignetting for all filters leaves of the readings.
    VignetteDiffers { chi_square: f64 } = "vignette-differs-by-filter";
    /// χ²/ν of readings about a response, and the blackbody that explains most of it by another temperature.
    ResponseDoesNotFit { chi_square: f64, worst: Option<WorstBlackbody> } = "response-does-not-fit";
    /// Samples of a scene that are no numbers.
    MissingSamples { samples: usize } = "missing-samples";
    /// Samples of pixels that respond to nothing.
    DeadSamples { samples: usize } = "dead-samples";
    /// χ²/ν of blackbodies about straight lines.
    BlackbodiesDoNotFit { chi_square: f64 } = "blackbodies-do-not-fit";
    /// Share of samples beyond the radiances of the blackbodies.
    BeyondBlackbodies { share: f64, low_k: f64, high_k: f64 } = "beyond-blackbodies";
    /// Lines of single bands that look striped in a part of their length and were left, as (line, band).
    LinesOffInPart { axis: &'static str, lines: Vec<[usize; 2]> } = "lines-off-in-part";
    /// Such lines that are off the same way in bands side by side.
    LinesOffBeside { axis: &'static str, lines: Vec<[usize; 2]> } = "lines-off-in-neighbouring-bands";
    /// Such lines at a step that the bands beside do not have.
    LinesBesideSteps { axis: &'static str, lines: Vec<[usize; 2]> } = "lines-beside-steps";
    /// Lines of single bands of which all samples are the same.
    LinesDead { axis: &'static str, lines: Vec<[usize; 2]> } = "lines-dead";
    /// Lines of single bands that look striped and have no clean one near.
    LinesWithoutReference { axis: &'static str, lines: Vec<[usize; 2]> } = "lines-without-reference";
    /// Lines of single bands that lack half of their samples or more.
    LinesMissing { axis: &'static str, lines: Vec<[usize; 2]> } = "lines-missing";
    /// Lines that are off in most bands, and were taken as striped since that was asked for.
    StripesInAllBands { axis: &'static str, lines: Vec<usize> } = "stripes-in-all-bands";
    /// Stripes of a cube of so many bands.
    StripesOfFewBands { bands: usize } = "stripes-of-few-bands";
    /// Share of differences that were left out of a noise.
    NoiseOutliers { share: f64 } = "noise-outliers";
    /// Largest texture that was taken out of the noise of a band, over that noise.
    TextureInNoise { share: f64 } = "texture-in-noise";
    /// Dimension along which the noise of frames goes together, the correlation of neighbours, and what independent noise stays within.
    CorrelatedNoise { of: &'static str, value: f64, limit: f64 } = "correlated-noise";
    /// c of a parabola through variances over means where a straight line was fitted, and its error.
    NoiseNotStraight { bend: f64, sigma: f64 } = "noise-not-straight";
    /// χ²/ν of the noise of bands about one line, and what it stays below by chance.
    BandsDifferInNoise { chi_square: f64, limit: f64 } = "bands-differ-in-noise";
    /// Variance that a sample without light would have, its error, and the level that was taken as no light.
    NoiseBelowZero { electronic: f64, sigma: f64, dark_level: f64 } = "noise-below-zero";
    /// Slope of variance over mean, and its error.
    PhotonsNotTold { per_photon: f64, sigma: f64 } = "photons-not-told";

    /// Pixels that have no emissivity by themselves, of so many that were looked at.
    NoRelativeEmissivity { pixels: usize, of: usize } = "no-relative-emissivity";
    /// A library of one emissivity for all pixels.
    OneCluster = "one-cluster";
    /// Clusters whose pixels all went to others, of so many that were asked for.
    ClustersWithoutPixels { left: usize, asked: usize } = "clusters-without-pixels";
    /// Emissivities of which the magnitude is hardly told: names, and the largest deviation of their means.
    MagnitudeHardlyTold { clusters: Vec<String>, sigma: f64 } = "magnitude-hardly-told";
    /// Clusters whose pixels one emissivity does not explain, and the largest χ²/ν of them.
    ClusterDoesNotFit { clusters: Vec<String>, chi_square: f64 } = "cluster-does-not-fit";
    /// So many surroundings, and nothing said of how much they light together.
    MirrorNotExcluded { surroundings: usize } = "mirror-not-excluded";
    /// A last round that still changed something.
    ClustersNotSettled { rounds: usize } = "clusters-not-settled";

    /// Objects most of whose pixels have no decided material, of so many that are listed.
    ObjectsUndecided { objects: usize, of: usize } = "objects-undecided";

    /// Pixels whose material a prior over the image changed, and whether its last sweep still changed something.
    SpatialPrior { changed: usize, pixels: usize, settled: bool } = "spatial-prior";

    /// Equal emissivities.
    Identical = "identical";
    /// What both of a pair are entered as.
    Placeholders { target: String, alternative: String, emissivities: [f64; 2] } = "placeholders";
    /// Equal temperatures.
    Equilibrium = "equilibrium";
    /// The unknowns imitate the material.
    Blind = "blind";
    /// Parameters of the nearest state at ends of ranges that the scenario set, among so many objects around.
    NearestAtEdge { parameters: Vec<Parameter>, objects: usize } = "nearest-at-edge";
    /// Distances per √photon.
    LocalDiffers { local: f64, nearest: f64, ratio: f64 } = "local-differs";
    /// Of a pair.
    Fragile = "fragile";
    /// Of the limiting scene of a rule.
    FragileScene as Fragile;
    /// Parameters that change nothing, among so many objects around.
    UnknownWithoutEffect { parameters: Vec<Parameter>, objects: usize } = "unknown-without-effect";
    /// Unknowns of ranging by air that change nothing.
    AirUnknownWithoutEffect { unknowns: Vec<String> } as UnknownWithoutEffect;
    /// A nearest distance that was searched, what is proved of it, and whether priors kept it from being proved.
    NearestSearch { distance: f64, lower: f64, priors: bool } = "nearest-search";
    /// How many nearest distances of the matrix are not proved.
    MatrixNotProved { searches: usize } as NearestSearch;
    /// A distance that rounding has left few digits of, and its relative error.
    FewDigits { distance: &'static str, relative_error: f64 } = "few-digits";
    /// Photons per mode at the lowest wavenumber, and whether the camera's noise has bunching in it.
    Bunching { occupancy: f64, wavenumber_cm1: f64, included: bool } = "bunching";
    /// An envelope beside the one scene.
    EnvelopeNotSearched = "envelope-not-searched";

    /// A camera of one band that is modelled with so many.
    BandsModelled { camera: String, bands: usize, readout: Readout } = "bands-modelled";
    /// Width of the widest band that is taken at its centre, cm⁻¹.
    BandsSampled { width_cm1: f64 } = "bands-sampled";
    /// Time until all bands are read.
    SequentialReadout { acquisition_s: f64, bands: usize } = "sequential-readout";
    /// Motion until all bands are exposed.
    MotionBlur { pixels: f64 } = "motion-blur";
    /// A scenario with a speed and no distance.
    MotionBlurUnknown = "motion-blur-unknown";
    /// A rule with a speed and no distance.
    RuleMotionBlurUnknown as MotionBlurUnknown;
    /// What a pixel sees by two statements of a camera.
    ContradictoryView { finer_rad: f64, coarser_rad: f64 } = "contradictory-view";
    /// A rule on a day on which it does not hold.
    NotInForce(NotInForce) = "not-in-force";
    /// Filters and no temperature of the sensor.
    FilterLightLeftOut = "filter-light";
    /// A temperature of the sensor and no filters.
    SensorTemperatureIdle as FilterLightLeftOut;
    /// Nothing around the target.
    NoSurroundings = "no-surroundings";
    /// Side of a pixel's footprint, m.
    TargetSizeUnknown { footprint_m: f64 } = "target-size-unknown";
    /// Share of the pixel that the target fills.
    TargetSmallerThanPixel { fill: f64 } = "target-smaller-than-pixel";
    /// Blur λF and radius of the first dark ring at the longest wavelength, beside the pixel.
    Diffraction { wavelength_m: f64, blur_m: f64, ring_m: f64, pixel_m: f64 } = "diffraction";
    /// Exposures at a frame rate, and their sum.
    FrameRate { exposures: f64, acquisition_s: f64, frame_rate_hz: f64, exposed_s: f64 } = "frame-rate";
    /// So many bands of all that lie for the most part outside a range.
    OutsideDetectorRange { outside: usize, bands: usize, range_cm1: [f64; 2] } = "outside-detector-range";
    /// By how much the shortcut is off, as a share of the exact distance.
    GammaShortcut { off: f64 } = "gamma-shortcut";
    /// Photons of a reading.
    FullWell { counts: f64, full_well: f64 } = "full-well";
    /// Photons of the brightest band of the brightest pixel of a scene.
    PixelFull { counts: f64, full_well: f64 } as FullWell;
    /// One of them.
    CameraFigureAssumed { figure: Assumed } = "camera-figure-assumed";
    /// Figures that no document states.
    CameraFiguresAssumed { camera: String, figures: Vec<Assumed> } as CameraFigureAssumed;

    /// A matrix of distances with priors.
    MatrixPriors = "matrix-priors";
    /// Simulations whose intervals are wider than asked for.
    TrialsEnded { wide: usize, simulations: usize, most_trials: u64, widest: f64, asked: f64 } = "trials-ended";

    /// Errors of emissivities beside what knows nothing of them.
    EmissivityErrorsLeftOut = "emissivity-errors-left-out";
    /// A worst case that was searched for.
    NotProved = "not-proved";
    /// Noise of the brightest scene.
    BrightestNoise = "brightest-noise";
    /// Frames that take time while something moves.
    FramesInMotion(Proviso) = "frames-in-motion";

    /// Samples of a cube that were looked at.
    SamplesNotChecked { evaluated: usize, samples: usize } = "samples-not-checked";
    /// Information that noise of the counts would make, and that demanded.
    NoiseOfDemanded { floor_per_px2: f64, demanded_per_px2: f64 } = "noise-in-counts";
    /// Information that noise of the counts would make, and that found.
    NoiseOfFound { floor_per_px2: f64, found_per_px2: f64 } as NoiseOfDemanded;
    /// Windows that have no bound by a signal.
    DarkSamples { signal: &'static str, left_out: usize, windows: usize } = "dark-samples";
    /// Disparity error of the cube over that promised.
    ScatteredAsMeasured { ratio: f64 } = "scattered-as-measured";
    /// A cube without depth.
    NoDepth = "no-depth";
    /// Information by another derivative over that by the one asked for.
    Derivative { ratio: f64 } = "derivative";
    /// Two bands, or one.
    FewBands { bands: usize } = "few-bands";
    /// A camera whose rows, columns or pixels have noise that stays or that they share.
    PatternOfEachPixel = "pattern-of-each-pixel";

    /// A target that looks like the air before it.
    DistanceUnchanged { distance_m: f64 } = "distance-not-seen";
    /// A distance whose change others imitate.
    DistanceImitated { distance_m: f64 } as DistanceUnchanged;
    /// A distance from a spectrum whose emissivity is taken to be known.
    EmissivityTakenAsExact = "emissivity-taken-as-exact";
    /// Width of the narrowest band, and of those that the air is known in, cm⁻¹.
    AirBandMeans { narrowest_cm1: f64, table_cm1: f64 } = "air-band-means";
    /// The nearest distance, and the shortest path of the table, m.
    AirExtrapolated { nearest_m: f64, shortest_m: f64 } = "air-extrapolated";
    /// A sky with lines of its own.
    AirMirroredSky = "air-mirrored-sky";

    /// Priors of a simulation.
    PriorsLeftOut = "priors-left-out";
    /// The fewest photons of an experiment.
    SpectraEmpty { photons: f64 } = "spectra-empty";
    /// The most photons of an experiment.
    CountsRounded { photons: f64 } = "counts-rounded";
    /// Training spectra of each class.
    FewSpectra { training: usize } = "few-spectra";
    /// What a saved model was trained with.
    ModelPhotons { method: Method, photons: f64 } = "model-photons";
    /// Error of the distribution function.
    NormalLikelihood { error: f64 } = "normal-likelihood";
    /// A fixed total of photons.
    LimitNormal = "limit-normal";
    /// Largest share of fits of a temperature at an edge, and the share up to which the bound applies.
    RangeHoldsTheEstimates { at_edge: f64, held: f64 } = "range-holds-the-estimates";
    /// How many fits.
    UnconvergedFits { fits: usize } = "unconverged-fits";
    /// How many sums of counts.
    NoReading { sums: usize } = "no-reading";
    /// A spectrum without temperature in it.
    TemperatureNotSeen = "temperature-not-seen";
}
