//! Depth by stereo and distance by air.

use super::block::{short, words};
use hadar::words::significant;

words! {
    SamplesNotChecked {
        meaning: "A yes or no was decided by some samples of the cube, and the others were not looked at.",
        remedy: "Use --no-skip to have all of them checked.",
        SamplesNotChecked { evaluated, samples } => format!(
            "{evaluated} of {samples} samples decided; the others were not looked at, nor checked for invalid \
             counts: --no-skip does"
        ),
    }
    NoiseOfDemanded {
        meaning: "Measured counts contain noise, which looks like texture and makes bounds too optimistic.",
        remedy: "Give expected counts, or averages of many frames.",
        NoiseOfDemanded { floor_per_px2, demanded_per_px2 } => format!(
            "if these counts are measured, their own noise contributes {} of the {} pixel^-2 of information required: give \
             expected counts",
            short(*floor_per_px2),
            short(*demanded_per_px2)
        ),
        NoiseOfFound { floor_per_px2, found_per_px2 } if floor_per_px2 > found_per_px2 => format!(
            "the noise of single readings would make an information of {} pixel^-2, more than the {} that were found (median): \
             if these counts are averages of readings, what was found may be their noise; give expected counts",
            short(*floor_per_px2),
            short(*found_per_px2)
        ),
        NoiseOfFound { floor_per_px2, found_per_px2 } => format!(
            "if these counts are measured, their own noise contributes {} of the {} pixel^-2 of information \
             found (median): give expected counts, or averages of many frames",
            short(*floor_per_px2),
            short(*found_per_px2)
        ),
    }
    DarkSamples {
        meaning: "A signal has samples of exactly 0 without noise, whose information is undefined: such \
            windows are left out. A cube or scene with such counts is refused.",
        remedy: "Give the camera its noise, or the surfaces emissivities below 1.",
        DarkSamples { signal, left_out, windows } => format!(
            "{signal}: {left_out} of {windows} windows have no bound, for a sample in them is 0 and has no noise"
        ),
    }
    ScatteredAsMeasured {
        meaning: "The scattered light, as if it were measured alone, promises more than the cube holds.",
        remedy: "Use the bounds of the heat cube.",
        ScatteredAsMeasured { ratio } => format!(
            "the scattered signal as if measured promises {} times less error than the heat cube holds: the photons that \
             are emitted are left out there, and no processing of the cube reaches it",
            short(*ratio)
        ),
    }
    NoDepth {
        meaning: "No depth is given, so that bounds are on disparity, in pixels.",
        remedy: "Write depth in [cube], a length or a file.",
        NoDepth => "no depth is given: the bounds are on disparity; write depth = \"12 m\" or a file of depths in [cube]",
    }
    Derivative {
        meaning: "Texture is near the limit of the pixels, and the information depends on the derivative used.",
        remedy: "Take the square root of the factor as uncertainty, or use finer pixels.",
        Derivative { ratio } => format!(
            "texture near the limit of the pixels: another derivative gives {} times the information; bounds are uncertain \
             by the square root of that",
            short(*ratio)
        ),
    }
    FewBands {
        meaning: "There are too few bands to distinguish emission from scattered light.",
        remedy: "Give three bands or more.",
        FewBands { bands: 2 } => "two bands cannot distinguish temperature, strength of the emission and scattered light",
        FewBands { .. } => "one band cannot distinguish emission from scattered light: nothing is left where the temperature is estimated",
    }
    PatternOfEachPixel {
        meaning: "Row and column noise of the camera is taken as independent in every pixel: noise common to a whole column of a \
            window shifts a disparity more than that.",
        remedy: "Take out stripes first (hadar calibrate stripes), and state what is left as camera.fixed_pattern.",
        PatternOfEachPixel => "row and column noise of the array is taken as independent in each pixel of a window: bounds are \
                               too small where it is not",
    }
    DistanceUnchanged {
        meaning: "The air holds no information on the distance: the target looks like it, or other unknowns \
            imitate any change.",
        remedy: "Look at a target that is warmer or colder than the air, take more bands, or make an \
            unknown known.",
        DistanceUnchanged { distance_m } => format!(
            "at {} m the distance changes nothing in any band: the target looks like the air",
            significant(*distance_m, 3)
        ),
        DistanceImitated { distance_m } => format!(
            "at {} m other unknowns imitate any change of the distance",
            significant(*distance_m, 3)
        ),
    }
    EmissivityTakenAsExact {
        meaning: "The emissivity of the target is taken as exact, but its errors can look like more or less \
            air.",
        remedy: "Add \"emissivity\" to unknown.nuisances, with its error as emissivity_error.",
        EmissivityTakenAsExact => "the emissivity is taken as exact: errors of it look like more or less air, and the distance is off by more than \
             is said",
    }
    AirBandMeans {
        meaning: "Bands are narrower than those that the table of the air is a mean over: what its lines \
            would add is not included.",
        remedy: "Give a finer table of the air, or take bands as wide as its own.",
        AirBandMeans { narrowest_cm1, table_cm1 } => format!(
            "the air is known as means over {} cm^-1, and bands are as narrow as {} cm^-1: what single lines would add is not in \
             the answer, nor are errors of the table",
            significant(*table_cm1, 2),
            significant(*narrowest_cm1, 2)
        ),
    }
    AirExtrapolated {
        meaning: "A distance is shorter than any path of the table of the air, which is extrapolated there.",
        remedy: "Ask for longer distances, or give a table with shorter paths.",
        AirExtrapolated { nearest_m, shortest_m } => format!(
            "distances from {} m are asked for, the shortest path of the table is {} m: below it the air is extrapolated",
            significant(*nearest_m, 3),
            significant(*shortest_m, 3)
        ),
    }
    AirMirroredSky {
        meaning: "The target mirrors a sky whose lines are those of the air on the path: means over bands \
            do not show how they coincide.",
        remedy: "Take the answer as one of a sky without lines, or give tables that resolve them.",
        AirMirroredSky => "the target mirrors a sky whose lines are those of the air on the path; means over bands take the two as if they had \
             none: what is mirrored comes through better or worse than is said",
    }
}
