//! Calibration: stripes, noise, blackbodies, responses.

use super::block::words;
use hadar::words::{quantity, significant};

words! {
    LinesLikeObjects {
        meaning: "Lines of a cube are off in all bands alike, and were left as they are: a thin object \
            along them looks like that.",
        remedy: "Write stripes.in_all_bands = true where they are stripes.",
        LinesLikeObjects { axis, lines } => {
            let shown: Vec<String> = lines.iter().take(10).map(usize::to_string).collect();
            let more = if lines.len() > 10 { ", …" } else { "" };
            format!(
                "{} {axis} ({}{more}, counted from 0) are off in all bands alike, as a thin object along them would be; they were left as \
                 they are",
                lines.len(),
                shown.join(", ")
            )
        },
    }
    LinesDiffer {
        meaning: "Most lines of a cube differ from their neighbours by more than noise: the structure of the \
            scene, or stripes of every line.",
        remedy: "Correct the cube by a uniform source, or give one of a scene that is even from line to line.",
        LinesDiffer { axis, bands, of, apart, noise } => format!(
            "{axis} differ from their neighbours by up to {} % of their level (rms; noise explains {} %) in {} of {of} bands: the scene's own \
             structure or stripes of every one of them explain that alike, and nothing was corrected for it",
            significant(100.0 * apart, 2),
            significant(100.0 * noise, 2),
            bands.len()
        ),
    }
    BlackbodyNotEven {
        meaning: "Pixels of a blackbody scatter more than the noise that is stated: they differ in their \
            response, or the noise is larger.",
        remedy: "State the noise that hadar calibrate noise finds; calibrate pixels of different response \
            one by one.",
        BlackbodyNotEven { blackbody, over } => format!(
            "the pixels of blackbody[{blackbody}] scatter by {} times the stated noise: errors that are said to be common to all pixels \
             may be larger",
            significant(*over, 2)
        ),
    }
    UncertaintyNotStated {
        meaning: "Temperatures of blackbodies are taken as exact, since no uncertainty of them is stated.",
        remedy: "State blackbody.uncertainty of each blackbody (\"0 K\" where it is exact).",
        UncertaintyNotStated { blackbodies, of } => {
            let which: Vec<String> = blackbodies.iter().map(|k| format!("blackbody[{k}]")).collect();
            let which = if blackbodies.len() == *of { "all blackbodies".to_owned() } else { which.join(", ") };
            format!("the temperature of {which} is taken as exact since no uncertainty is stated: errors are larger than given")
        },
    }
    LinearityNotTested {
        meaning: "Two blackbodies lie on a line whatever the response: nothing shows one that is not linear.",
        remedy: "Give a third blackbody between them, or know that the detector is linear.",
        LinearityNotTested { share, off_k } => format!(
            "errors hold if the response is linear, and two blackbodies cannot show that it is not: a bend of {} % of the span between them is \
             {} in the middle, in all pixels alike",
            significant(100.0 * share, 2),
            quantity(*off_k, "K")
        ),
    }
    SmoothnessNotStated {
        meaning: "Errors of a response rest on how smooth it is, and nothing is said of that.",
        remedy: "State response.shape_error and response.correlation as the detector's data sheet has them; take \
            sigma_kinked where the response may have edges.",
        SmoothnessNotStated { keys, smooth, kinked } => {
            let keys: Vec<String> = keys.iter().map(|key| format!("response.{key}")).collect();
            format!(
                "errors rest on how smooth the response is, and {} {} not stated: values are known to {} % of the peak if it is as smooth as \
                 is taken, to {} % if it has kinks (sigma_kinked)",
                keys.join(" and "),
                if keys.len() == 1 { "is" } else { "are" },
                significant(100.0 * smooth, 2),
                significant(100.0 * kinked, 2)
            )
        },
    }
    BlackbodiesTakenAsBlack {
        meaning: "Blackbodies are taken as black, since no emissivity of them is stated: what they reflect \
            is taken for their own light.",
        remedy: "State blackbody.emissivity, its error and the surroundings (emissivity = 1 where it is black).",
        BlackbodiesTakenAsBlack { blackbodies, of, emissivity, warm_k, colder_k } => {
            let which: Vec<String> = blackbodies.iter().map(|k| format!("blackbody[{k}]")).collect();
            let which = if blackbodies.len() == *of { "all blackbodies are".to_owned() } else { format!("{} is", which.join(", ")) };
            format!(
                "{which} taken as black since no emissivity is stated: one of {emissivity} at {} K that reflects the coldest of them sends as \
                 if it were {} colder",
                significant(*warm_k, 4),
                quantity(*colder_k, "K")
            )
        },
    }
    ResponseBarelyKnown {
        meaning: "Responses of some channels are known to no better than a fifth.",
        remedy: "Give blackbodies further apart, or better known, or read longer; leave out channels that \
            see nothing.",
        ResponseBarelyKnown { channels, of, worst } => format!(
            "the response of {channels} of {of} channels is hardly known (to {} % of it at worst): errors of radiances to first order \
             do not hold there",
            significant(100.0 * worst, 2)
        ),
    }
    VignetteDiffers {
        meaning: "What filters transmit over the image differs from filter to filter by more than noise.",
        remedy: "Use the pixels about the centre, or calibrate filter by filter with hadar calibrate \
            blackbody and response = \"each-pixel\".",
        VignetteDiffers { chi_square } => format!(
            "one vignetting does not explain all filters (chi2/nu {}): away from the centre radiances err by more than is stated",
            significant(*chi_square, 3)
        ),
    }
    ResponseDoesNotFit {
        meaning: "Readings of blackbodies behind filters lie off the response by more than their noise and \
            temperatures allow.",
        remedy: "Check the temperature of the blackbody that is named, the stated noise, and whether the \
            response is linear.",
        ResponseDoesNotFit { chi_square, worst } => {
            let explained = match worst {
                Some(worst) => format!(
                    "blackbody[{}] ({:.2} K) explains most of it: it reads as if it were {} {}",
                    worst.blackbody,
                    worst.temperature_k,
                    quantity(worst.off_k.abs(), "K"),
                    if worst.off_k > 0.0 { "warmer" } else { "colder" }
                ),
                None => "no single blackbody explains it".into(),
            };
            format!(
                "the readings lie off the response (chi2/nu {}): errors that are said, and intervals, do not hold; {explained}",
                significant(*chi_square, 3)
            )
        },
    }
    MissingSamples {
        meaning: "A scene has samples that are no numbers.",
        remedy: "Nothing if they are the camera's bad pixels.",
        MissingSamples { samples } => {
            format!("{samples} sample(s) of the scene are no numbers: no radiance is given for them")
        },
    }
    DeadSamples {
        meaning: "Samples of pixels that read the same before all blackbodies have no radiance.",
        remedy: "Nothing if they are the camera's bad pixels.",
        DeadSamples { samples } => format!(
            "{samples} sample(s) are of pixels whose readings of the blackbodies do not differ beyond noise: no radiance is given for them"
        ),
    }
    BlackbodiesDoNotFit {
        meaning: "Readings of three or more blackbodies lie off straight lines by more than their noise and \
            temperatures allow.",
        remedy: "State a larger noise or uncertainty; look for a response that is not linear.",
        BlackbodiesDoNotFit { chi_square } => format!(
            "the blackbodies do not lie on straight lines (chi2/nu {}): errors are larger than stated",
            significant(*chi_square, 2)
        ),
    }
    BeyondBlackbodies {
        meaning: "A scene has radiances below those of the coldest blackbody, or above those of the warmest.",
        remedy: "Give blackbodies that enclose the scene: errors grow outside of them, and the response may \
            bend.",
        BeyondBlackbodies { share, low_k, high_k } => format!(
            "{} % of the samples are outside of the blackbodies' radiances ({low_k} to {high_k} K)",
            significant(100.0 * share, 2)
        ),
    }
    LinesOffInPart {
        meaning: "Lines of a band are off in a part of their length only, as an object along them would be, \
            and were left as they are.",
        remedy: "Look at these lines; a striped one is off along its whole length.",
        LinesOffInPart { axis, lines } => format!(
            "{} are off in a part of their length only, as an object along them would be; they were left as they are",
            places(axis, lines)
        ),
    }
    LinesOffBeside {
        meaning: "Lines are off the same way in bands side by side, as a feature of a material would be, \
            and were left as they are.",
        remedy: "Look at these lines; correct them by a uniform source where they are stripes.",
        LinesOffBeside { axis, lines } => format!(
            "{} are off the same way in bands side by side, as a feature of a material would be; they were left as they are",
            places(axis, lines)
        ),
    }
    LinesBesideSteps {
        meaning: "A band steps from line to line where other bands do not: lines striped side by side, or \
            the edge of a material.",
        remedy: "Look at these lines; correct them by a uniform source where they are stripes.",
        LinesBesideSteps { axis, lines } => format!(
            "{} lie at a step from line to line that the neighbouring bands do not have: lines striped side by side, or the edge of a material; \
             which of the two cannot be decided, and they were left as they are",
            places(axis, lines)
        ),
    }
    LinesDead {
        meaning: "Lines of a band hold one value alone: nothing of the scene is in them, and they were left \
            as they are.",
        remedy: "Set their samples to NaN, or leave the band out.",
        LinesDead { axis, lines } => format!(
            "{} hold one value alone where the neighbouring lines vary: nothing of the scene is in them, and they were left as they are",
            places(axis, lines)
        ),
    }
    LinesWithoutReference {
        meaning: "Lines of a band look striped, have no clean line near to be compared with, and were left \
            as they are.",
        remedy: "Correct them by a uniform source, or leave the band out.",
        LinesWithoutReference { axis, lines } => format!(
            "{} look striped and have no clean line near to be compared with; they were left as they are",
            places(axis, lines)
        ),
    }
    LinesMissing {
        meaning: "Lines of a band have no samples, or less than half of them, and were not looked at.",
        remedy: "Nothing; or look where the samples went.",
        LinesMissing { axis, lines } => {
            format!("{} have less than half of their samples and were not looked at", places(axis, lines))
        },
    }
    StripesInAllBands {
        meaning: "Lines that are off in most bands were taken as striped since that was asked for: thin \
            objects along them look the same.",
        remedy: "Look at the picture of what was taken out.",
        StripesInAllBands { axis, lines } => {
            let shown: Vec<String> = lines.iter().take(10).map(usize::to_string).collect();
            let more = if lines.len() > 10 { ", …" } else { "" };
            format!(
                "{} {axis} ({}{more}, counted from 0) were off in most bands and taken as striped, as was asked for: objects along them \
                 would have been taken out too",
                lines.len(),
                shown.join(", ")
            )
        },
    }
    StripesOfFewBands {
        meaning: "Stripes were taken out of a cube of too few bands to distinguish them from thin objects.",
        remedy: "Look at the picture of what was taken out.",
        StripesOfFewBands { bands } => format!(
            "of {bands} band(s) none distinguishes a stripe from a thin object that lies along a line: what was taken out may have been one"
        ),
    }
    NoiseOutliers {
        meaning: "Differences of samples were left out of a noise since they are far larger than it.",
        remedy: "Nothing if they are few; else give frames of a scene that does not move.",
        NoiseOutliers { share } => format!(
            "{} % of the differences are beyond 6 deviations and were left out: frames of a scene that moved, bad pixels or edges",
            significant(100.0 * share, 2)
        ),
    }
    TextureInNoise {
        meaning: "A single frame has texture in what neighbours differ by, and other bands had to distinguish it from noise.",
        remedy: "Give two or more frames of the same scene, or one of an even surface.",
        TextureInNoise { share } => format!(
            "texture was taken out of the noise of single bands, up to {} of it: where it is not alike in neighbouring bands, the noise is too large",
            significant(*share, 2)
        ),
    }
    CorrelatedNoise {
        meaning: "The noise of frames goes together from frame to frame or from pixel to pixel: the camera filters in time or \
            in space, or the scene moves. Filtered noise has less variance than its photons, which would come out as too many.",
        remedy: "Give frames as the detector made them, with noise reduction and sharpening switched off, of a scene that stays.",
        CorrelatedNoise { of, value, limit } => format!(
            "the noise goes together along {of}: neighbours have a correlation of {}, independent ones stay within {}. The camera filters \
             its frames, or the scene moves: photons would be miscounted",
            significant(*value, 2),
            significant(*limit, 2)
        ),
    }
    NoiseNotStraight {
        meaning: "Variance over mean is no straight line: the detector is not linear, samples are cut off, or gains of pixels that are \
            compared differ.",
        remedy: "Give counts that are in proportion to light; ask for noise.gain_spread = true where gains of pixels differ.",
        NoiseNotStraight { bend, sigma } => format!(
            "variance over mean is bent (m^2 times {} +- {}): a detector that is not linear, or gains that differ; photons and electronic \
             noise by a straight line hold for neither end",
            significant(*bend, 2),
            significant(*sigma, 2)
        ),
    }
    BandsDifferInNoise {
        meaning: "Bands of a cube scatter by different noise models.",
        remedy: "Use the variance of each band (sigma.csv); give counts as the camera made them, before \
            bands were scaled.",
        BandsDifferInNoise { chi_square, limit } => format!(
            "bands do not have one noise model in common (chi2/nu {}, by chance below {}): neither photons per unit nor electronic noise \
             hold for all",
            significant(*chi_square, 2),
            significant(*limit, 2)
        ),
    }
    NoiseBelowZero {
        meaning: "The noise of a sample without light comes out below 0: the level of no light is wrong, \
            or samples are not photon counts.",
        remedy: "State the sample without light, noise.dark_level; give counts as the camera made them, one \
            scene for all bands.",
        NoiseBelowZero { electronic, sigma, dark_level } => format!(
            "the variance of a sample without light would be {} +- {}, below 0, or the line is below 0 where samples are darkest: no \
             camera does that; is no light at the level {} (noise.dark_level)?",
            significant(*electronic, 2),
            significant(*sigma, 2),
            significant(*dark_level, 4)
        ),
    }
    PhotonsNotTold {
        meaning: "The slope of variance over mean is not distinguished from 0.",
        remedy: "Give a scene of darker and brighter parts, or more frames.",
        PhotonsNotTold { per_photon, sigma } => format!(
            "noise that grows with light is not distinguished from noise that does not: one photon is {} +- {} unit(s)",
            significant(*per_photon, 2),
            significant(*sigma, 2)
        ),
    }
}

/// Lines of single bands, so many that are read.
fn places(axis: &str, lines: &[[usize; 2]]) -> String {
    let shown: Vec<String> =
        lines.iter().take(10).map(|[line, band]| format!("{line} of band {band}")).collect();
    let more = if lines.len() > 10 { ", …" } else { "" };
    format!("{} {axis} of single bands ({}{more}, counted from 0)", lines.len(), shown.join(", "))
}
