//! Every code of a warning, what it means and what to do about it: one row each.

/// Makes the enum, its list and its texts of one table, so that no code can lack a row or be left out of the list.
macro_rules! catalogue {
    ($($(#[doc = $meaning:literal])+ $variant:ident = $name:literal, $remedy:literal;)+) => {
        /// Stable code of a warning.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        #[allow(rustdoc::broken_intra_doc_links, reason = "a remedy names tables such as [camera], which are no links")]
        pub enum Code {
            $(
                #[doc = concat!("`", $name, "`:")]
                $(#[doc = $meaning])+
                #[doc = concat!("\n\n", $remedy)]
                $variant,
            )+
        }

        impl Code {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// The code as programs know it, e.g. `nearest-at-edge`.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name),+ }
            }

            /// What it means.
            #[must_use]
            pub fn meaning(self) -> &'static str {
                match self { $(Self::$variant => concat!($($meaning),+).trim_start()),+ }
            }

            /// What to do about it.
            #[must_use]
            pub const fn remedy(self) -> &'static str {
                match self { $(Self::$variant => $remedy),+ }
            }
        }
    };
}

catalogue! {
    /// A file of a folder of spectra was passed over, or a material or class was replaced by one of the files.
    Library = "library", "Correct or remove the file; --strict makes it an error.";
    /// The file or library entry of a material says something that whoever uses it must know.
    Material = "material", "Read the entry; use another spectrum if it does not fit your surface.";
    /// The target's own material was named among the alternatives, from which it cannot be told.
    TargetAmongAlternatives = "target-among-alternatives", "Nothing; or leave it out of alternatives.materials.";
    /// An alternative was left out since its spectrum does not cover the bands.
    MaterialSkipped = "material-skipped",
        "Choose bands that its spectrum covers, or alternatives.extrapolate = \"hold\".";
    /// A class of the scenario has the name of a material of the library that is entered as one number, and stands in its place.
    ClassReplacesPlaceholder = "class-replaces-placeholder", "Nothing; or call the class otherwise.";
    /// Figures of the camera, elasticities and pictures are those of the pair of members that is hardest to tell apart before the camera as it is.
    SolvedForOnePair = "solved-for-one-pair", "Ask again with the figure that was solved for: the verdict is then that of all pairs.";
    /// Of classes only the pair of members that is hardest to tell apart is simulated.
    WorstMembers = "worst-members", "Name other members to simulate them.";

    /// The first axis of a cube is so short that it may be that of the bands.
    AxesInDoubt = "axes-in-doubt", "Write cube.axes, \"bands,rows,columns\" or \"rows,columns,bands\".";
    /// Bands are stated as wavelengths, and the file of the cube does not say in which order it has them.
    BandOrderTaken = "band-order-taken",
        "Write the cube with its wavelengths, as an ENVI file, or turn its bands round if they begin with the shortest.";
    /// The file of a cube lists wavelengths or wavenumbers without a unit, which are not used.
    WavelengthsUnused = "wavelengths-unused", "Write the unit into the file, as `wavelength units = Micrometers` in an ENVI header; in NPZ and MATLAB call the list `wavelengths_um`.";
    /// Pixels of a cube are 0 in all bands: nothing was measured there.
    CubeDark = "cube-dark", "Check the file and what was read of it; write NaN where nothing was measured.";
    /// Many pixels of a cube have a sample at one and the same value, the largest of all: readings that were cut off there.
    CubeSaturated = "cube-saturated", "Shorten the exposure, or write NaN where readings are cut off.";
    /// Windows with a missing sample have no bound, and NaN in the maps.
    WindowsMissing = "windows-missing", "Nothing; or fill missing samples, or make the window smaller.";
    /// Pixels of a cube were left out since a sample of them is missing.
    PixelsSkipped = "pixels-skipped", "Nothing; or name bands that are always missing in cube.bad_bands.";
    /// Pixels of a cube are explained by no material of the library.
    LibraryDoesNotFit = "library-does-not-fit",
        "Add materials, state how wrong the library is with library.emissivity_error, or check the unit and the light.";
    /// The emissivities of the library are taken as exact: intervals do not hold what errors of them do.
    LibraryTakenAsExact = "library-taken-as-exact", "State library.emissivity_error where the spectra are measured ones.";

    /// Lines of a cube are off in all bands alike, and were left as they are: a thin object along them looks like that.
    LinesLikeObjects = "lines-like-objects", "Write stripes.in_all_bands = true where they are stripes.";
    /// Pixels of a blackbody scatter more than the noise that is stated: they differ in their response, or the noise is larger.
    BlackbodyNotEven = "blackbody-not-even",
        "State the noise that hadar calibrate noise finds; calibrate pixels of different response one by one.";
    /// Temperatures of blackbodies are taken as exact, since no uncertainty of them is stated.
    UncertaintyNotStated = "uncertainty-not-stated", "State blackbody.uncertainty of each blackbody (\"0 K\" where it is exact).";
    /// Responses of channels are known to no better than a fifth of them.
    ResponseBarelyKnown = "response-barely-known",
        "Give blackbodies further apart, or better known, or read longer; leave out channels that see nothing.";
    /// What filters transmit over the image differs from filter to filter by more than noise.
    VignetteDiffers = "vignette-differs-by-filter",
        "Use the pixels about the centre, or calibrate filter by filter with hadar calibrate blackbody and response = \"each-pixel\".";
    /// Readings of blackbodies behind filters lie off the response by more than their noise and temperatures allow.
    ResponseDoesNotFit = "response-does-not-fit",
        "Check the temperature of the blackbody that is named, the stated noise, and whether the response is linear.";
    /// A scene has samples that are no numbers.
    MissingSamples = "missing-samples", "Nothing if they are the camera's bad pixels.";
    /// Samples of pixels that read the same before all blackbodies have no radiance.
    DeadSamples = "dead-samples", "Nothing if they are the camera's bad pixels.";
    /// Readings of three or more blackbodies lie off straight lines by more than their noise and temperatures allow.
    BlackbodiesDoNotFit = "blackbodies-do-not-fit", "State a larger noise or uncertainty; look for a response that is not linear.";
    /// A scene has radiances below those of the coldest blackbody, or above those of the warmest.
    BeyondBlackbodies = "beyond-blackbodies", "Give blackbodies that enclose the scene: errors grow outside of them, and the response may bend.";
    /// Lines of a band are off in a part of their length only, as an object along them would be, and were left as they are.
    LinesOffInPart = "lines-off-in-part", "Look at these lines; a striped one is off along its whole length.";
    /// Lines are off the same way in bands side by side, as a feature of a material would be, and were left as they are.
    LinesOffBeside = "lines-off-in-neighbouring-bands",
        "Look at these lines; correct them by a uniform source where they are stripes.";
    /// A band steps from line to line where other bands do not: lines striped side by side, or the edge of a material.
    LinesBesideSteps = "lines-beside-steps", "Look at these lines; correct them by a uniform source where they are stripes.";
    /// Lines of a band hold one value alone: nothing of the scene is in them, and they were left as they are.
    LinesDead = "lines-dead", "Set their samples to NaN, or leave the band out.";
    /// Lines of a band look striped, have no clean line near to be compared with, and were left as they are.
    LinesWithoutReference = "lines-without-reference", "Correct them by a uniform source, or leave the band out.";
    /// Lines of a band have no samples, or less than half of them, and were not looked at.
    LinesMissing = "lines-missing", "Nothing; or look where the samples went.";
    /// Lines that are off in most bands were taken as striped since that was asked for: thin objects along them look the same.
    StripesInAllBands = "stripes-in-all-bands", "Look at the picture of what was taken out.";
    /// Stripes were taken out of a cube of too few bands to tell them from thin objects.
    StripesOfFewBands = "stripes-of-few-bands", "Look at the picture of what was taken out.";
    /// Differences of samples were left out of a noise since they are far larger than it.
    NoiseOutliers = "noise-outliers", "Nothing if they are few; else give frames of a scene that stands still.";
    /// A single frame has texture in what neighbours differ by, and other bands had to tell it from noise.
    TextureInNoise = "texture-in-noise", "Give two or more frames of the same scene, or one of an even surface.";
    /// Bands of a cube scatter by noise models of their own.
    BandsDifferInNoise = "bands-differ-in-noise",
        "Use the variance of each band (sigma.csv); give counts as the camera made them, before bands were scaled.";
    /// The noise of a sample without light comes out below 0: what is taken as no light is not, or samples are not photon counts.
    NoiseBelowZero = "noise-below-zero",
        "State the sample without light, noise.dark_level; give counts as the camera made them, one scene for all bands.";
    /// The slope of variance over mean is not told from 0.
    PhotonsNotTold = "photons-not-told", "Give a scene of darker and brighter parts, or more frames.";

    /// Pixels of a cube send what they are lit by, or what no surface sends: no emissivity follows from one of them alone.
    NoRelativeEmissivity = "no-relative-emissivity",
        "Nothing if they are few; else check unit and surroundings, or look when the scene is warmer than its sky.";
    /// One emissivity stands for all pixels, whatever they are.
    OneCluster = "one-cluster", "Write clusters.count = [1, 8], unless the cube shows one material.";
    /// Clusters were left without a pixel: the others explain all of them better.
    ClustersWithoutPixels = "clusters-without-pixels", "Ask for fewer, or for a range of counts.";
    /// The magnitude of an emissivity is hardly told from the temperatures of its pixels: the prior holds it.
    MagnitudeHardlyTold = "magnitude-hardly-told",
        "State unknown.lighting_total, fewer surroundings, or [emissivity] as well as you know it; look under a sky with lines, at pixels of different lighting.";
    /// The pixels of a cluster scatter about one emissivity by more than their noise: several materials, or a group that was not found.
    ClusterDoesNotFit = "cluster-does-not-fit",
        "Ask for more clusters or a range of counts; check unit, noise and light; do not use the emissivities of these.";
    /// Several surroundings light a pixel with nothing said of their total: what mirrors them is not told from what is as warm.
    MirrorNotExcluded = "mirror-not-excluded", "State unknown.lighting_total, or name fewer surroundings.";
    /// The last round of grouping and fitting still changed something.
    ClustersNotSettled = "clusters-not-settled", "Compare with another --seed; ask for fewer clusters.";

    /// Objects rest on pixels whose material is not decided: several are left, or none fits.
    ObjectsUndecided = "objects-undecided", "Do not act on them: look closer, expose longer, or add what is there to the library.";

    /// Materials, posteriors and temperatures rest on a prior over the image: what is small and hardly differs from its surroundings is lost.
    SpatialPrior = "spatial-prior", "Compare with the answer without [spatial]; trust an object of few pixels only if it is in both.";

    /// The two materials have equal emissivities in every band: no camera tells them apart.
    Identical = "identical", "Choose bands in which they differ.";
    /// Both materials are entered as one number for all wavenumbers, so that nothing is known of what tells them apart.
    Placeholders = "placeholders", "Give a measured spectrum of at least one of them.";
    /// Target and surroundings are in thermal equilibrium, where every material looks like a blackbody.
    Equilibrium = "equilibrium", "Look at another time or place, where temperatures differ, or light the scene.";
    /// A change of the unknowns looks exactly like the change of material, to first order.
    Blind = "blind", "Take more bands, or make an unknown known (fewer nuisances, a prior, lighting_total).";
    /// The state in which the alternative is most similar stands at the end of a range that the scenario set.
    NearestAtEdge = "nearest-at-edge", "Check that the range is what can occur: the answer hangs on it.";
    /// Local and nearest distance differ much: the picture that is linear in the unknowns has failed.
    LocalDiffers = "local-differs", "Use the nearest distance (requirement.by = \"nearest\").";
    /// Spectra are nearly featureless, so that small errors of the emissivities change the distance several times over.
    Fragile = "fragile", "Measure the emissivities better, or take the answer as an order of magnitude.";
    /// An unknown changes nothing in this scene and was left out.
    UnknownWithoutEffect = "unknown-without-effect", "Nothing; or take it out of unknown.nuisances.";
    /// The nearest state was searched and could not be proved to be the nearest: its distance may be too large.
    NearestSearch = "nearest-search", "Rely on what is proved (distance_nearest_lower), or make an unknown known.";
    /// Rounding has left less of a distance than is printed of it, or nothing.
    FewDigits = "few-digits", "Do not rely on that distance; take away unknowns that hardly differ from others, or light that nearly cancels.";
    /// Photons per mode are so many that bunching raises the noise noticeably.
    Bunching = "bunching", "Set camera.photon_bunching = true to include it.";
    /// The scenario has an envelope, and this answer is for its one scene.
    EnvelopeNotSearched = "envelope-not-searched", "Ask `hadar rule` for the worst scene of the envelope.";

    /// The camera has one band, and its entry models it as if it read all bands at once, as no such camera does.
    BandsModelled = "bands-modelled", "Write camera.readout = \"sequential\" for filters before it, one after the other.";
    /// Wide bands of a grid or of rows are taken at their centres alone, which may miss what tells materials apart in them.
    BandsSampled = "bands-sampled", "Write bands.integrate = true, or the bands as ranges.";
    /// Bands are read one after the other, and the scene must hold still for all of them.
    SequentialReadout = "sequential-readout", "Shorten the exposure, or take a camera that reads all bands at once.";
    /// The target moves by a pixel or more while all bands are exposed; the bound assumes less.
    MotionBlur = "motion-blur", "Shorten the exposure, or allow less speed.";
    /// A speed is demanded, but without a distance its blur cannot be known.
    MotionBlurUnknown = "motion-blur-unknown", "Write target.distance, or distance in [envelope].";
    /// Pixel and focal length of the camera say another angle of a pixel than its field of view and its pixels.
    ContradictoryView = "contradictory-view", "Correct the figure that is wrong: pixel, focal_length, field_of_view or pixels.";
    /// The rule does not hold on the day that was asked about: nothing is demanded.
    NotInForce = "not-in-force", "Nothing; or ask about another day with --on.";
    /// Light of filters and of the sensor is left out, or the sensor's temperature is given where it does nothing.
    FilterLight = "filter-light", "Write camera.sensor_temperature where there are filters, and only there.";
    /// There are no surroundings: the target is in empty space, where nothing but its own emission is seen.
    NoSurroundings = "no-surroundings", "Write [[environment]] with what is around the target: walls, ground, sky.";
    /// A pixel sees more than a person at the target's distance, and the target is taken to fill it.
    TargetSizeUnknown = "target-size-unknown", "Write target.size and a [background], or come nearer.";
    /// The target does not fill its pixel.
    TargetSmallerThanPixel = "target-smaller-than-pixel", "Keep a margin for targets between pixels, or magnify.";
    /// The lens blurs a point over more than a pixel.
    Diffraction = "diffraction", "Lower the f-number or enlarge the pixel; expect neighbours to mix.";
    /// Several exposures come at the frame rate and so take longer than their sum.
    FrameRate = "frame-rate", "Take fewer frames or a faster camera, or make sure that nothing changes.";
    /// Bands lie for the most part outside the range in which the detector's figures are stated.
    OutsideDetectorRange = "outside-detector-range", "Narrow the bands, or state figures that hold there.";
    /// The shortcut by a mean noise is off; the exact distance is what is reported.
    GammaShortcut = "gamma-shortcut", "Nothing; do not use the shortcut here.";
    /// A reading does not fit into the full well of a pixel.
    FullWell = "full-well", "Shorten the exposure, or take more frames of less each.";
    /// No document states a figure of the camera: it was assumed.
    CameraFigureAssumed = "camera-figure-assumed", "Measure it or ask the maker, and write it under [camera].";

    /// Distances of the matrix per root of the photons know nothing of the priors; its statistical distances do.
    MatrixPriors = "matrix-priors", "Read the statistical distances.";
    /// Simulations ended at the most trials with intervals wider than asked for.
    TrialsEnded = "trials-ended", "Raise --trials, or ask for less with --half-width.";

    /// The rule has errors of emissivities, and this answer takes all spectra to be exact.
    EmissivityErrorsLeftOut = "emissivity-errors-left-out", "Ask for a tolerance of the emissivity that holds them.";
    /// That no scene of the envelope is below the requirement was searched for, not proved.
    NotProved = "not-proved", "Narrow the envelope, so that the search can prove it.";
    /// Noise that depends on the scene is taken where it is largest, so that the distance is a lower bound.
    BrightestNoise = "brightest-noise", "Nothing; the verdict is on the safe side.";
    /// The frames of a camera are added up while something moves: motion blur takes them to be laid over each other.
    FramesInMotion = "frames-in-motion", "Lay the frames over each other, or take fewer.";
    /// A figure of the camera is set in the place of the file's, and its noise is not stated for a value of it: the noise moves with it.
    NoiseMovesWithFigure = "noise-moves-with-figure", "Write the condition into the file beside the noise.";

    /// A yes or no was decided by some samples of the cube, and the others were not looked at.
    SamplesNotChecked = "samples-not-checked", "Use --no-skip to have all of them checked.";
    /// Measured counts have noise of their own, which looks like texture and makes bounds too good.
    NoiseInCounts = "noise-in-counts", "Give expected counts, or averages of many frames.";
    /// A signal has samples of exactly 0 without noise, whose information has no value: such windows are left out. A cube, or a
    /// scene, whose counts are so is refused.
    DarkSamples = "dark-samples", "Give the camera its noise, or the surfaces emissivities below 1.";
    /// The scattered light as if it were measured alone promises more than the cube holds.
    ScatteredAsMeasured = "scattered-as-measured", "Use the bounds of the heat cube.";
    /// No depth is given, so that bounds are on disparity, in pixels.
    NoDepth = "no-depth", "Write depth in [cube], a length or a file.";
    /// Texture is near the limit of the pixels, and another derivative gives other information.
    Derivative = "derivative", "Take the square root of the factor as uncertainty, or use finer pixels.";
    /// There are too few bands to tell emission from scattered light.
    FewBands = "few-bands", "Give three bands or more.";

    /// The air tells nothing of the distance: the target looks like it, or other unknowns imitate any change.
    DistanceNotSeen = "distance-not-seen",
        "Look at a target that is warmer or colder than the air, take more bands, or make an unknown known.";
    /// The emissivity of the target is taken as exact, whose errors can look like more or less air.
    EmissivityTakenAsExact = "emissivity-taken-as-exact",
        "Add \"emissivity\" to unknown.nuisances, with how wrong it may be as emissivity_error.";
    /// Bands are narrower than those that the table of the air is a mean over: what its lines would tell is not in the answer.
    AirBandMeans = "air-band-means", "Give a finer table of the air, or take bands as wide as its own.";
    /// A distance is shorter than any path of the table of the air, which is extrapolated there.
    AirExtrapolated = "air-extrapolated", "Ask for longer distances, or give a table with shorter paths.";
    /// The target mirrors a sky whose lines are those of the air on the path: means over bands do not know how they fall together.
    AirMirroredSky = "air-mirrored-sky", "Take the answer as one of a sky without lines, or give tables that resolve them.";

    /// Priors count for nothing in what is drawn and learnt.
    PriorsLeftOut = "priors-left-out", "Compare with limits without priors.";
    /// With so few photons most spectra are empty.
    SpectraEmpty = "spectra-empty", "Ask for more with --photons.";
    /// Counts are so large that floating point rounds them.
    CountsRounded = "counts-rounded", "Ask for fewer with --photons.";
    /// There are too few training spectra to learn from.
    FewSpectra = "few-spectra", "Raise --spectra.";
    /// A saved model was trained with another number of photons.
    ModelPhotons = "model-photons", "Judge it with the photons it was trained with, or train anew.";
    /// Likelihoods take counts for normal, which they are not quite, so that the likelihood ratio may lose a little.
    NormalLikelihood = "normal-likelihood", "Ask for more photons, or leave the electronic noise out.";
    /// With a fixed total only the limit of many photons is known: nothing is held against it.
    LimitNormal = "limit-normal", "Use --statistics poisson to hold classifiers against their limit.";
    /// Fits end at the edge of what is physically possible and may be biased, where the Cramer-Rao bound says nothing.
    RangeHoldsTheEstimates = "range-holds-the-estimates", "Use more photons or bands, or know the lighting.";
    /// Fits of temperatures did not converge.
    UnconvergedFits = "unconverged-fits", "Nothing if they are few; else take more photons or bands.";
    /// Sums of counts are explained by no temperature.
    NoReading = "no-reading", "Take more photons: noise outweighs the signal.";
    /// The spectrum tells nothing of the temperature that the other unknowns do not imitate.
    TemperatureNotSeen = "temperature-not-seen", "Take more bands, or make an unknown known.";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_unique_and_explained() {
        let mut names: Vec<&str> = Code::ALL.iter().map(|code| code.name()).collect();
        let written = |name: &&str| name.chars().all(|char| char.is_ascii_lowercase() || char == '-');
        assert!(names.iter().all(written), "{names:?}");
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), Code::ALL.len());
        for code in Code::ALL {
            for text in [code.meaning(), code.remedy()] {
                assert!(text.ends_with('.') && text.starts_with(char::is_uppercase), "{code:?}: {text}");
            }
        }
    }
}
