//! What a camera does not meet, or what a value of one of its figures would spoil: as a clause of a sentence, as a noun, as a code.

use hadar_study::Shortfall;

/// Codes of what a camera falls short of, each with its meaning and what to do about it.
pub(crate) const EXPLAINED: [[&str; 3]; 13] = [
    [
        "distance",
        "the statistical distance from the closest confuser is below the required one: the counts do not distinguish the two with the required probability",
        "more light (exposure, frames, f-number, pixel), less noise, other bands, or states of the alternative that are ruled out (priors, temperature of the alternatives)",
    ],
    [
        "pixels",
        "fewer pixels lie across the target than required, or motion blurs them during an exposure",
        "a longer focal length, a shorter exposure, or a decision nearer to the target",
    ],
    [
        "temperature-error",
        "the temperature of the target is not known as accurately as required",
        "more light, less noise, more bands, or an emissivity that is better known",
    ],
    [
        "depth-error",
        "the distance is not known as accurately as required in the required share of windows",
        "a longer baseline or focal length, larger windows, less noise",
    ],
    [
        "decision-time",
        "the frames are read after the time at which the decision is due",
        "fewer frames or bands, a higher frame rate, or a target that comes into view earlier",
    ],
    [
        "motion-blur",
        "the image of the target moves by a pixel or more while all bands are exposed",
        "a shorter exposure, bands that are read together, a shorter focal length or a lower speed",
    ],
    [
        "motion-unknown",
        "a speed is required, but the distance of the target is not stated: its motion blur is unknown, which counts as not met",
        "state target.distance or envelope.distance",
    ],
    [
        "out-of-view",
        "a crossing target is not in the camera's view in time for the decision",
        "a wider field of view (field_of_view), or a minimum speed of the vehicle at which the target is in view",
    ],
    [
        "full-well",
        "a reading of the brightest scene exceeds the well capacity: the pixel saturates",
        "a shorter exposure, a smaller aperture, or a filter",
    ],
    ["frame-rate", "the exposure is longer than a frame", "a shorter exposure or a lower frame rate"],
    [
        "diffraction",
        "the lens blurs a point over more than the pixel",
        "a smaller f-number or a larger pixel",
    ],
    ["impractical", "no camera is built or used like that", "change another quantity"],
    [
        "lowest-noise",
        "read noise and quantisation alone exceed this noise, whatever the detector",
        "change another quantity",
    ],
];

/// What is wrong with an image, each in a clause of its own.
pub(super) fn clauses(spoiled: &[Shortfall]) -> String {
    spoiled.iter().map(|by| clause(*by)).collect::<Vec<_>>().join(", and ")
}

/// It in a clause that follows 'but'.
const fn clause(by: Shortfall) -> &'static str {
    match by {
        Shortfall::Distance => "the statistical distance is below the required one",
        Shortfall::Pixels => "too few pixels lie across the target",
        Shortfall::TemperatureError => "the temperature is not known as accurately as required",
        Shortfall::DepthError => "the distance is not known as accurately as required",
        Shortfall::DecisionTime => "its frames are read after the decision is due",
        Shortfall::MotionBlur => "the target moves by a pixel or more while all bands are exposed",
        Shortfall::MotionUnknown => {
            "whether the target moves by a pixel while all bands are exposed is not known without target.distance"
        }
        Shortfall::OutOfView => "the target is not in the view in time",
        Shortfall::FullWell => "a reading exceeds the well capacity (the pixel saturates)",
        Shortfall::FrameRate => "the exposure is longer than a frame",
        Shortfall::Diffraction => "the lens blurs a point over more than the pixel",
        Shortfall::Impractical => "no camera is built or used like that",
        Shortfall::LowestNoise => {
            "read noise and quantisation alone exceed this noise, whatever the detector"
        }
    }
}

/// What is wrong with an image, in a list.
pub(crate) fn in_words(spoiled: &[Shortfall]) -> String {
    let words = spoiled.iter().map(|reason| match reason {
        Shortfall::Distance => "distance",
        Shortfall::MotionBlur => "motion blur of a pixel or more",
        Shortfall::MotionUnknown => "motion blur unknown without a distance",
        Shortfall::OutOfView => "the target is not in the view in time",
        Shortfall::FullWell => "the brightest scene saturates the pixels",
        Shortfall::FrameRate => "longer than a frame",
        Shortfall::Impractical => "not a practical camera",
        Shortfall::Diffraction => "diffraction blurs over more than a pixel",
        Shortfall::LowestNoise => "below read noise and quantisation",
        Shortfall::Pixels => "too few pixels",
        Shortfall::TemperatureError => "the temperature is not known well enough",
        Shortfall::DepthError => "the distance is not known well enough",
        Shortfall::DecisionTime => "its frames are read after the decision is due",
    });
    words.collect::<Vec<_>>().join(", ")
}

/// That a demand is not met, and by what, in the fewest words.
pub(crate) fn no(shortfalls: &[Shortfall]) -> String {
    let word = |by: &Shortfall| match by {
        Shortfall::Distance => "d too small".to_owned(),
        other => other.code().replace('-', " "),
    };
    format!("no: {}", shortfalls.iter().map(word).collect::<Vec<_>>().join(", "))
}

/// Codes, one after the other.
pub(crate) fn codes(shortfalls: &[Shortfall], between: &str) -> String {
    shortfalls.iter().map(|by| by.code()).collect::<Vec<_>>().join(between)
}
