//! The message of every warning, made of its data.

use super::Warning;
use crate::proviso::Proviso;
use hadar::instrument::Readout;
use hadar::scene::Parameter;
use hadar::words::{length, quantity, significant};
use std::fmt::{self, Display, Formatter};

impl Display for Warning {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::OfPair { target, alternative, warning } => {
                write!(f, "{target} against {alternative}: {warning}")
            }
            Self::OfCameras { who, warning } => write!(f, "{who}: {warning}"),
            Self::Library { remark } => f.write_str(remark),
            Self::Material { material, remark } => write!(f, "{material}: {remark}"),
            Self::TargetAmongAlternatives { target } => {
                write!(f, "{target} is left out of the alternatives: it is the target")
            }
            Self::AxesInDoubt { rows, columns, bands } => write!(
                f,
                "the cube was read as {rows} rows x {columns} columns x {bands} bands, though its first axis is the shortest by far"
            ),
            Self::BandOrderTaken => f.write_str(
                "the bands are written as wavelengths, but the cube's file does not say them: its first band was taken as that of the \
                 longest wavelength",
            ),
            Self::WavelengthsUnused => f.write_str(
                "the cube's file lists its wavelengths or wavenumbers without a unit, so that they were not used: its first band was taken \
                 as that of the longest wavelength; write the unit into the file",
            ),
            Self::CubeDark { view, pixels, of } if pixels == of => {
                write!(f, "all samples of the {view} view are 0: it is empty")
            }
            Self::CubeDark { view, pixels, of } => {
                write!(f, "{pixels} of {of} pixels of the {view} view that were looked at are 0 in all bands")
            }
            Self::CubeSaturated { view, pixels, of, value, largest } => write!(
                f,
                "{pixels} of {of} pixels of the {view} view that were looked at have a sample at {}, the largest value of all{}: where \
                 readings are cut off their texture is gone, and edges are there that are none",
                short(*value),
                if *largest { " and of the file's type" } else { "" }
            ),
            Self::WindowsMissing { windows, of } => write!(
                f,
                "{windows} of {of} windows hold a sample that is missing: they have no bound, and NaN in the maps"
            ),
            Self::PixelsSkipped { pixels, of } => {
                write!(f, "{pixels} of {of} pixels have a sample that is no number; they were left out")
            }
            Self::LibraryDoesNotFit { pixels, of } => {
                write!(f, "{pixels} of {of} pixels are explained by no material of the library (p below 1e-4)")
            }
            Self::NoRelativeEmissivity { pixels, of } => write!(
                f,
                "{pixels} of {of} pixels that were looked at have no emissivity by themselves: they send what they are lit by, or \
                 what no surface sends"
            ),
            Self::OneCluster => f.write_str("one emissivity stands for all pixels, whatever they are made of"),
            Self::ClustersWithoutPixels { left, asked } => {
                write!(f, "of {asked} clusters {left} have pixels; the others were left out")
            }
            Self::MagnitudeHardlyTold { clusters, sigma } => write!(
                f,
                "the magnitude of {} is hardly told from the temperatures (mean emissivity +- {} at most): what was said of \
                 emissivities beforehand holds it",
                clusters.join(", "),
                significant(*sigma, 2)
            ),
            Self::ClusterDoesNotFit { clusters, chi_square } => write!(
                f,
                "the pixels of {} are not explained by one emissivity each (chi2/nu up to {}): they are several materials or none that was \
                 found, and their errors do not hold",
                clusters.join(", "),
                significant(*chi_square, 3)
            ),
            Self::MirrorNotExcluded { surroundings } => write!(
                f,
                "{surroundings} surroundings light a pixel as much as they like: a mirror of them looks as well as a warm surface does, so that \
                 emissivities and temperatures may be wrong altogether, by far more than their errors"
            ),
            Self::ClustersNotSettled { rounds } => {
                write!(f, "after {rounds} rounds clusters and emissivities still changed")
            }
            Self::ObjectsUndecided { objects, of } => write!(
                f,
                "in {objects} of {of} objects less than half of the pixels have one material left: their category is the likelier one, and no \
                 finding"
            ),
            Self::NoiseOutliers { share } => write!(
                f,
                "{} % of the differences are beyond 6 deviations and were left out: frames of a scene that moved, bad pixels or edges",
                significant(100.0 * share, 2)
            ),
            Self::TextureInNoise { share } => write!(
                f,
                "texture was taken out of the noise of single bands, up to {} of it: as far as it is not alike in neighbouring bands, \
                 the noise is too large",
                significant(*share, 2)
            ),
            Self::BandsDifferInNoise { chi_square, limit } => write!(
                f,
                "bands do not have one noise model in common (chi2/nu {}, by chance below {}): neither photons per unit nor electronic noise \
                 hold for all",
                significant(*chi_square, 2),
                significant(*limit, 2)
            ),
            Self::NoiseBelowZero { electronic, sigma, dark_level } => write!(
                f,
                "the variance of a sample without light would be {} +- {}, below 0, or the line is below 0 where samples are darkest: no \
                 camera does that; is no light at the level {} (noise.dark_level)?",
                significant(*electronic, 2),
                significant(*sigma, 2),
                significant(*dark_level, 4)
            ),
            Self::PhotonsNotTold { per_photon, sigma } => write!(
                f,
                "noise that grows with light is not told from noise that does not: one photon is {} +- {} unit(s)",
                significant(*per_photon, 2),
                significant(*sigma, 2)
            ),
            Self::LinesLikeObjects { axis, lines } => {
                let shown: Vec<String> = lines.iter().take(10).map(usize::to_string).collect();
                let more = if lines.len() > 10 { ", …" } else { "" };
                write!(
                    f,
                    "{} {axis} ({}{more}, counted from 0) are off in all bands alike, as a thin object along them would be; they were left as \
                     they are",
                    lines.len(),
                    shown.join(", ")
                )
            }
            Self::BlackbodyNotEven { blackbody, over } => write!(
                f,
                "the pixels of blackbody[{blackbody}] scatter by {} times the stated noise: errors that are said to be common to all pixels \
                 may be larger",
                significant(*over, 2)
            ),
            Self::UncertaintyNotStated { blackbodies, of } => {
                let which: Vec<String> = blackbodies.iter().map(|k| format!("blackbody[{k}]")).collect();
                let which = if blackbodies.len() == *of { "all blackbodies".to_owned() } else { which.join(", ") };
                write!(f, "the temperature of {which} is taken as exact since no uncertainty is stated: errors are larger than said")
            }
            Self::ResponseBarelyKnown { channels, of, worst } => write!(
                f,
                "the response of {channels} of {of} channels is hardly known (to {} % of it at worst): errors of radiances to first order \
                 do not hold there",
                significant(100.0 * worst, 2)
            ),
            Self::VignetteDiffers { chi_square } => write!(
                f,
                "one vignetting does not explain all filters (chi2/nu {}): away from the centre radiances err by more than is said",
                significant(*chi_square, 3)
            ),
            Self::ResponseDoesNotFit { chi_square, worst } => {
                write!(
                    f,
                    "the readings lie off the response (chi2/nu {}): errors that are said, and intervals, do not hold",
                    significant(*chi_square, 3)
                )?;
                match worst {
                    Some(worst) => write!(
                        f,
                        "; blackbody[{}] ({:.2} K) explains most of it: it reads as if it were {} {}",
                        worst.blackbody,
                        worst.temperature_k,
                        quantity(worst.off_k.abs(), "K"),
                        if worst.off_k > 0.0 { "warmer" } else { "colder" }
                    ),
                    None => f.write_str("; no single blackbody explains it"),
                }
            }
            Self::MissingSamples { samples } => {
                write!(f, "{samples} sample(s) of the scene are no numbers: no radiance is given for them")
            }
            Self::DeadSamples { samples } => write!(
                f,
                "{samples} sample(s) are of pixels whose readings of the blackbodies do not differ beyond noise: no radiance is given for them"
            ),
            Self::BlackbodiesDoNotFit { chi_square } => write!(
                f,
                "the blackbodies do not lie on straight lines (chi2/nu {}): errors are larger than stated",
                significant(*chi_square, 2)
            ),
            Self::BeyondBlackbodies { share, low_k, high_k } => write!(
                f,
                "{} % of the samples are outside of the blackbodies' radiances ({low_k} to {high_k} K)",
                significant(100.0 * share, 2)
            ),
            Self::LinesOffInPart { axis, lines } => write!(
                f,
                "{} are off in a part of their length only, as an object along them would be; they were left as they are",
                places(axis, lines)
            ),
            Self::LinesOffBeside { axis, lines } => write!(
                f,
                "{} are off the same way in bands side by side, as a feature of a material would be; they were left as they are",
                places(axis, lines)
            ),
            Self::LinesBesideSteps { axis, lines } => write!(
                f,
                "{} lie at a step from line to line that the bands beside do not have: lines striped side by side, or the edge of a material; \
                 nothing tells which, and they were left as they are",
                places(axis, lines)
            ),
            Self::LinesDead { axis, lines } => write!(
                f,
                "{} hold one value alone where the lines beside vary: nothing of the scene is in them, and they were left as they are",
                places(axis, lines)
            ),
            Self::LinesWithoutReference { axis, lines } => write!(
                f,
                "{} look striped and have no clean line near to be compared with; they were left as they are",
                places(axis, lines)
            ),
            Self::LinesMissing { axis, lines } => {
                write!(f, "{} have less than half of their samples and were not looked at", places(axis, lines))
            }
            Self::StripesInAllBands { axis, lines } => {
                let shown: Vec<String> = lines.iter().take(10).map(usize::to_string).collect();
                let more = if lines.len() > 10 { ", …" } else { "" };
                write!(
                    f,
                    "{} {axis} ({}{more}, counted from 0) were off in most bands and taken as striped, as was asked for: objects along them \
                     would have been taken out too",
                    lines.len(),
                    shown.join(", ")
                )
            }
            Self::StripesOfFewBands { bands } => write!(
                f,
                "of {bands} band(s) none tells a stripe from a thin object that lies along a line: what was taken out may have been one"
            ),
            Self::LibraryTakenAsExact => f.write_str(
                "the library is taken as exact: with errors of its emissivities temperatures are off by more than is said",
            ),
            Self::SpatialPrior { changed, pixels, settled } => {
                write!(
                    f,
                    "materials, candidates and temperatures rest on a prior over the image, which changed the material of {changed} \
                     of {pixels} pixels"
                )?;
                f.write_str(if *settled { "" } else { "; its last sweep still changed something" })
            }
            Self::MaterialSkipped { material } => {
                write!(f, "{material} is left out: its spectrum does not cover the bands")
            }
            Self::ClassReplacesPlaceholder { class } => write!(
                f,
                "`{class}` is the class of this scenario, not the material of the library that is entered as one number"
            ),
            Self::SolvedForOnePair { target, alternative } => write!(
                f,
                "what each figure may be is solved for {target} against {alternative}, the hardest pair before the camera as it is; before \
                 another camera another pair of members may be harder"
            ),
            Self::WorstMembers { target, alternative } => write!(
                f,
                "classes stand by the pair of members that is hardest to tell apart, {target} and {alternative}; the others are not \
                 drawn"
            ),
            Self::Identical => f.write_str("the two emissivities are equal in every band"),
            Self::Equilibrium => f.write_str(
                "target and surroundings are in thermal equilibrium; every material looks like a blackbody",
            ),
            Self::Blind => f.write_str("a change of the unknowns looks exactly like the change of material"),
            Self::NearestAtEdge { parameters, objects } => write!(
                f,
                "the nearest state stands at the edge of its range ({}); the range decides the answer",
                listed(parameters, *objects)
            ),
            Self::MatrixNotProved { searches } => {
                write!(f, "{searches} nearest distances of the matrix are searched and not proved; verdicts rest on what is proved")
            }
            Self::LocalDiffers { local, nearest, ratio } => write!(
                f,
                "local ({}) and nearest ({}) distance differ by a factor {ratio:.1}; only the nearest one is a limit",
                significant(*local, 3),
                significant(*nearest, 3)
            ),
            Self::Fragile => f.write_str(
                "the spectra are nearly featureless: errors of 0.1 % in the emissivities can change this distance several \
                 times over",
            ),
            Self::FragileScene => f.write_str(
                "the spectra of the limiting scene are nearly featureless: errors of 0.1 % in the emissivities \
                 can change the distance several times over",
            ),
            Self::UnknownWithoutEffect { parameters, objects } => {
                let change = if parameters.len() == 1 { "changes" } else { "change" };
                write!(f, "{} {change} nothing in this scene", listed(parameters, *objects))
            }
            Self::FewDigits { distance, relative_error } if *relative_error < 1.0 => {
                write!(f, "of the {distance} rounding leaves no more than its first digits: it is known to a share of {relative_error:.0e}")
            }
            Self::FewDigits { distance, .. } => write!(f, "of the {distance} rounding leaves nothing: it may have any value"),
            Self::NearestSearch { distance, lower, priors } => {
                let why = if *priors { ", which leaves priors out" } else { "" };
                write!(f, "the nearest distance, {}, is the best of a search; the proof{why} ", significant(*distance, 3))?;
                match 1.0 - lower / distance {
                    // Three digits would show the same number twice.
                    gap if gap < 0.01 => write!(f, "comes within {gap:.0e} of it"),
                    _ => write!(f, "says no more than that it is at least {}", significant(*lower, 3)),
                }
            }
            Self::Bunching { occupancy, wavenumber_cm1, included } => {
                let what = if *included {
                    "bunching raises the noise of the light that is counted, which is included"
                } else {
                    "bunching, which is neglected (camera.photon_bunching), raises the noise by as much"
                };
                write!(f, "{occupancy:.2} photons per mode at {wavenumber_cm1:.0} cm^-1: {what}")
            }
            Self::EnvelopeNotSearched => f.write_str(
                "this is the answer for the one scene; the [envelope] is searched by `hadar rule`",
            ),
            Self::BandsModelled { camera, bands, readout } => write!(
                f,
                "{camera} has one band; its entry models it as if it read {bands} bands {}, as no such camera does",
                match readout {
                    Readout::FourierTransform => "through an interferometer",
                    Readout::Dispersive => "side by side",
                    Readout::Simultaneous | Readout::Sequential => "at once",
                }
            ),
            Self::BandsSampled { width_cm1 } => write!(
                f,
                "bands up to {} cm^-1 wide are taken at their centres alone; integrated, a distance may be another",
                significant(*width_cm1, 3)
            ),
            Self::SequentialReadout { acquisition_s, bands } => write!(
                f,
                "bands are read one after the other: {} until all {bands} are there, during which nothing may change",
                quantity(*acquisition_s, "s")
            ),
            Self::MotionBlur { pixels } => write!(
                f,
                "the target moves {} pixels until all bands are exposed; the bound assumes less than 1",
                significant(*pixels, 2)
            ),
            Self::MotionBlurUnknown => f.write_str(
                "a speed is given, but for the motion blur the scenario must say target.distance",
            ),
            Self::RuleMotionBlurUnknown => f.write_str("a speed is given, but motion blur needs a distance"),
            Self::ContradictoryView { finer_rad, coarser_rad } => write!(
                f,
                "its figures contradict each other: a pixel sees {} or {} mrad, by its side and the focal length or by the view and \
                 the pixels across it; the coarser counts for pixels on the target, the finer for motion blur",
                significant(1e3 * finer_rad, 3),
                significant(1e3 * coarser_rad, 3)
            ),
            Self::NotInForce { day, from, until } => {
                write!(f, "the rule does not hold on {day}")?;
                match (from, until) {
                    (Some(from), _) if day < from => write!(f, ", it holds from {from}"),
                    (_, Some(until)) => write!(f, ", it held until {until}"),
                    _ => Ok(()),
                }
            }
            Self::FilterLightLeftOut => f.write_str(
                "the light that filters throw back onto the sensor, and their own, is left out: sensor_temperature is not \
                 given",
            ),
            Self::SensorTemperatureIdle => f.write_str(
                "sensor_temperature changes nothing: there are no filters that throw its light back",
            ),
            Self::Placeholders { target, alternative, emissivities } => write!(
                f,
                "{target} and {alternative} are each entered as one number ({} and {}): that they can or cannot be told apart \
                 says nothing of real surfaces",
                emissivities[0], emissivities[1]
            ),
            Self::NoSurroundings => f.write_str(
                "there are no surroundings: the target is in empty space, and nothing is seen but its own emission",
            ),
            Self::TargetSizeUnknown { footprint_m } => write!(
                f,
                "a pixel sees {} at the target, which is taken to fill it; a person does not",
                length(*footprint_m)
            ),
            Self::TargetSmallerThanPixel { fill } => write!(
                f,
                "the target fills {} % of its pixel, as long as it stands in the middle of one; on the edge of two or \
                 four of them it is seen by each in part",
                significant(100.0 * fill, 2)
            ),
            Self::Diffraction { wavelength_m, blur_m, ring_m, pixel_m } => write!(
                f,
                "at {} the lens blurs a point over lambda F = {} (first dark ring at {}), more than the pixel of {}: \
                 neighbours see the same, and an edge of the target is spread over pixels",
                quantity(*wavelength_m, "m"),
                quantity(*blur_m, "m"),
                quantity(*ring_m, "m"),
                quantity(*pixel_m, "m"),
            ),
            Self::FrameRate { exposures, acquisition_s, frame_rate_hz, exposed_s } => write!(
                f,
                "{exposures:.0} exposures take {} at {} frames per second, not {}; nothing may change meanwhile",
                quantity(*acquisition_s, "s"),
                significant(*frame_rate_hz, 3),
                quantity(*exposed_s, "s"),
            ),
            Self::OutsideDetectorRange { outside, bands, range_cm1: [low, high] } => write!(
                f,
                "{outside} of {bands} bands are for the most part outside {low} to {high} cm^-1, the range in which the \
                 figures of the detector are stated; they are taken to hold there too"
            ),
            Self::GammaShortcut { off } => {
                let percent = 100.0 * off;
                write!(
                    f,
                    "the shortcut sqrt(N/(1+gamma)) d0 is off by {percent:+.0} %; the exact value is used"
                )
            }
            Self::FullWell { counts, full_well } => {
                let (counts, full_well) = (significant(*counts, 3), significant(*full_well, 3));
                write!(f, "{counts} photons in one reading exceed the full well of {full_well}")
            }
            Self::PixelFull { counts, full_well } => write!(
                f,
                "the brightest band of the brightest pixel holds {} photons, the well {}: shorten the exposure",
                short(*counts),
                short(*full_well)
            ),
            Self::CameraFiguresAssumed { camera, figures } => {
                write!(f, "no document states all of {camera}: {}", figures.join("; "))
            }
            Self::CameraFigureAssumed { figure } => f.write_str(figure),
            Self::MatrixPriors => f.write_str(
                "the matrix's distances per sqrt(photon) are those of many photons, where priors count for nothing; \
                 its statistical distances have them",
            ),
            Self::TrialsEnded { wide, simulations, most_trials, widest, asked } => write!(
                f,
                "{wide} of {simulations} simulations ended after {most_trials} trials of a state with intervals of up to \
                 +- {widest:.2}, not the +- {asked} asked for; raise --trials, or ask for less with --half-width"
            ),
            Self::EmissivityErrorsLeftOut => f.write_str(
                "errors of the emissivities, [sensitivity], are not in it: all spectra are taken to be exact",
            ),
            Self::NotProved => f.write_str(
                "that no scene of the envelope is below the requirement was searched, not proved",
            ),
            Self::BrightestNoise => f.write_str(
                "noise that depends on the scene is taken in the brightest scene, so the distance is a lower bound; \
                 what would fix the camera is computed in the limiting scene itself",
            ),
            Self::FramesInMotion(Proviso { frames, time_s, way_m }) => write!(
                f,
                "its {frames} frames take {} s, at the demanded speed a way of {} m: they must be laid over each other, and the \
                 scene must not change; motion blur counts each by itself",
                short(*time_s),
                short(*way_m)
            ),
            Self::NoiseMovesWithFigure { figure, condition } => write!(
                f,
                "camera.{figure} is set, and camera.{condition} is not stated: the noise is taken to hold for what is set, as in a file \
                 that says so, and another {figure} is another noise"
            ),
            Self::SamplesNotChecked { evaluated, samples } => write!(
                f,
                "{evaluated} of {samples} samples decided; the others were not looked at, nor checked for counts that are \
                 none: --no-skip does"
            ),
            Self::NoiseOfDemanded { floor_per_px2, demanded_per_px2 } => write!(
                f,
                "if these counts are measured, their own noise makes an information of {} pixel^-2 of the {} demanded: give \
                 expected counts",
                short(*floor_per_px2),
                short(*demanded_per_px2)
            ),
            Self::NoiseOfFound { floor_per_px2, found_per_px2 } if floor_per_px2 > found_per_px2 => write!(
                f,
                "the noise of single readings would make an information of {} pixel^-2, more than the {} that were found (median): \
                 if these counts are averages of readings, what was found may be their noise; give expected counts",
                short(*floor_per_px2),
                short(*found_per_px2)
            ),
            Self::NoiseOfFound { floor_per_px2, found_per_px2 } => write!(
                f,
                "if these counts are measured, their own noise makes an information of {} pixel^-2 of the {} that were \
                 found (median): give expected counts, or averages of many frames",
                short(*floor_per_px2),
                short(*found_per_px2)
            ),
            Self::DarkSamples { signal, left_out, windows } => write!(
                f,
                "{signal}: {left_out} of {windows} windows have no bound, for a sample in them is 0 and has no noise"
            ),
            Self::ScatteredAsMeasured { ratio } => write!(
                f,
                "the scattered signal as if measured promises {} times less error than the heat cube holds: the photons that \
                 are emitted are left out there, and no processing of the cube reaches it",
                short(*ratio)
            ),
            Self::NoDepth => f.write_str(
                "no depth is given: the bounds are on disparity; write depth = \"12 m\" or a file of depths in [cube]",
            ),
            Self::Derivative { ratio } => write!(
                f,
                "texture near the limit of the pixels: another derivative gives {} times the information; bounds are uncertain \
                 by the square root of that",
                short(*ratio)
            ),
            Self::FewBands { bands: 2 } => f.write_str(
                "two bands cannot tell temperature, strength of the emission and scattered light apart",
            ),
            Self::FewBands { .. } => f.write_str(
                "one band cannot tell emission from scattered light: nothing is left where the temperature is estimated",
            ),
            Self::DistanceUnchanged { distance_m } => write!(
                f,
                "at {} m the distance changes nothing in any band: the target looks like the air",
                significant(*distance_m, 3)
            ),
            Self::DistanceImitated { distance_m } => write!(
                f,
                "at {} m other unknowns imitate any change of the distance",
                significant(*distance_m, 3)
            ),
            Self::AirUnknownWithoutEffect { unknowns } => write!(
                f,
                "{} {} nothing in this scene",
                unknowns.join(", "),
                if unknowns.len() == 1 { "changes" } else { "change" }
            ),
            Self::EmissivityTakenAsExact => f.write_str(
                "the emissivity is taken as exact: errors of it look like more or less air, and the distance is off by more than \
                 is said",
            ),
            Self::AirBandMeans { narrowest_cm1, table_cm1 } => write!(
                f,
                "the air is known as means over {} cm^-1, and bands are as narrow as {} cm^-1: what single lines would tell is not in \
                 the answer, nor what errors of the table do",
                significant(*table_cm1, 2),
                significant(*narrowest_cm1, 2)
            ),
            Self::AirExtrapolated { nearest_m, shortest_m } => write!(
                f,
                "distances from {} m are asked for, the shortest path of the table is {} m: below it the air is extrapolated",
                significant(*nearest_m, 3),
                significant(*shortest_m, 3)
            ),
            Self::AirMirroredSky => f.write_str(
                "the target mirrors a sky whose lines are those of the air on the path; means over bands take the two as if they had \
                 none: what is mirrored comes through better or worse than is said",
            ),
            Self::PriorsLeftOut => f.write_str(
                "priors are left out: the spectra that are drawn, and what is learnt from them, know nothing of them",
            ),
            Self::SpectraEmpty { photons } => {
                write!(f, "with {} photons most spectra are empty in every band", significant(*photons, 3))
            }
            Self::CountsRounded { photons } => write!(
                f,
                "with {} photons counts of a band leave the whole numbers that 64-bit floating point holds: \
                 they are rounded to it",
                short(*photons)
            ),
            Self::FewSpectra { training } => write!(f, "{training} training spectra of each class teach little"),
            Self::ModelPhotons { method, photons } => write!(
                f,
                "the saved {} was trained with {} photons: with others its scale is wrong",
                method.words(),
                significant(*photons, 4)
            ),
            Self::NormalLikelihood { error } => write!(
                f,
                "likelihoods take counts for normal; their distribution function is up to {} off, so the \
                 likelihood ratio may fall short of the optimum (draws are exact)",
                short(*error)
            ),
            Self::LimitNormal => f.write_str(
                "with a fixed total only the limit of many photons is known; nothing is held against it",
            ),
            Self::RangeHoldsTheEstimates { at_edge, held } => write!(
                f,
                "up to {:.1} % of the fits at a temperature end at the edge of the physical range of lighting or temperature: \
                 they may be biased, and the range limits their errors, so that the Cramer-Rao bound, which is for unbiased \
                 estimates, is not applied where more than {:.1} % do",
                100.0 * at_edge,
                100.0 * held
            ),
            Self::UnconvergedFits { fits } => {
                write!(f, "{fits} fits did not converge; their best state so far counts")
            }
            Self::NoReading { sums } => {
                write!(f, "{sums} sums of counts are explained by no temperature; thermal imaging is without them")
            }
            Self::TemperatureNotSeen => f.write_str(
                "the spectrum tells nothing of the temperature, or nothing that the other unknowns do not imitate",
            ),
        }
    }
}

/// Parameters as a reader calls them.
fn listed(parameters: &[Parameter], objects: usize) -> String {
    let words = parameters.iter().map(|parameter| in_words(*parameter, objects));
    words.collect::<Vec<_>>().join(", ")
}

fn in_words(parameter: Parameter, objects: usize) -> String {
    let of = |what: &str, k: usize| {
        if objects > 1 {
            format!("{what} of environment[{k}]")
        } else {
            format!("{what} of the surroundings")
        }
    };
    match parameter {
        Parameter::Temperature => "temperature".into(),
        Parameter::Lighting(k) => of("lighting", k),
        Parameter::Gain => "gain".into(),
        Parameter::EnvironmentTemperature(k) => of("temperature", k),
        Parameter::Material => "material".into(),
    }
}

fn short(value: f64) -> String {
    significant(value, 2)
}

/// Lines of single bands, so many that are read.
fn places(axis: &str, lines: &[[usize; 2]]) -> String {
    let shown: Vec<String> =
        lines.iter().take(10).map(|[line, band]| format!("{line} of band {band}")).collect();
    let more = if lines.len() > 10 { ", …" } else { "" };
    format!("{} {axis} of single bands ({}{more}, counted from 0)", lines.len(), shown.join(", "))
}
