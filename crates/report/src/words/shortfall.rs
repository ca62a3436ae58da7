//! What a camera does not meet, or what a value of one of its figures would spoil: as a clause of a sentence, as a noun, as a code.

use hadar_study::Shortfall;

/// What is wrong with an image, each in a clause of its own.
pub(super) fn clauses(spoiled: &[Shortfall]) -> String {
    spoiled.iter().map(|by| clause(*by)).collect::<Vec<_>>().join(", and ")
}

/// It in a clause that follows 'but'.
const fn clause(by: Shortfall) -> &'static str {
    match by {
        Shortfall::Distance => "the statistical distance is below that demanded",
        Shortfall::Pixels => "too few pixels lie across the target",
        Shortfall::TemperatureError => "the temperature is not known as well as demanded",
        Shortfall::DepthError => "the distance is not known as well as demanded",
        Shortfall::DecisionTime => "its frames are read later than the decision must stand",
        Shortfall::MotionBlur => "the target moves by a pixel or more while all bands are exposed",
        Shortfall::MotionUnknown => {
            "whether the target moves by a pixel while all bands are exposed is not known without target.distance"
        }
        Shortfall::OutOfView => "the target is not in the view in time",
        Shortfall::FullWell => "a reading does not fit into the full well",
        Shortfall::FrameRate => "the exposure is longer than a frame",
        Shortfall::Diffraction => "the lens blurs a point over more than the pixel",
        Shortfall::Impractical => "no camera is built or used like that",
        Shortfall::LowestNoise => {
            "read noise and the steps of the converter leave more noise than that, whatever the detector"
        }
    }
}

/// What is wrong with an image, in a list.
pub(crate) fn in_words(spoiled: &[Shortfall]) -> String {
    let words = spoiled.iter().map(|reason| match reason {
        Shortfall::Distance => "distance",
        Shortfall::MotionBlur => "motion blur of a pixel or more",
        Shortfall::MotionUnknown => "motion that is not known without a distance",
        Shortfall::OutOfView => "the target is not in the view in time",
        Shortfall::FullWell => "the brightest scene fills the well",
        Shortfall::FrameRate => "longer than a frame",
        Shortfall::Impractical => "not a practical camera",
        Shortfall::Diffraction => "diffraction blurs over more than a pixel",
        Shortfall::LowestNoise => "below what read noise and converter leave",
        Shortfall::Pixels => "too few pixels",
        Shortfall::TemperatureError => "the temperature is not known well enough",
        Shortfall::DepthError => "the distance is not known well enough",
        Shortfall::DecisionTime => "its frames are read after the decision must stand",
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
