//! Cameras: readout, motion, view, what is around the target.

use super::block::{short, words};
use crate::words::Say;
use hadar::instrument::Readout;
use hadar::words::{length, quantity, significant};

words! {
    BandsModelled {
        meaning: "The camera has one band, and its entry models it as reading all bands at once, which no \
            such camera can.",
        remedy: "Write camera.readout = \"sequential\" for filters before it, one after the other.",
        BandsModelled { camera, bands, readout } => format!(
            "{camera} has one band; its entry models it as reading {bands} bands {}, which no such camera can",
            match readout {
                Readout::FourierTransform => "through an interferometer",
                Readout::Dispersive => "side by side",
                Readout::Simultaneous | Readout::Sequential => "at once",
            }
        ),
    }
    BandsSampled {
        meaning: "Wide bands of a grid or of rows are taken at their centres alone, which may miss what \
            distinguishes materials in them.",
        remedy: "Write bands.integrate = true, or the bands as ranges.",
        BandsSampled { width_cm1 } => format!(
            "bands up to {} cm^-1 wide are taken at their centres alone; integrated over the band, distances may differ",
            significant(*width_cm1, 3)
        ),
    }
    SequentialReadout {
        meaning: "Bands are read one after the other, and the scene must hold still for all of them.",
        remedy: "Shorten the exposure, or take a camera that reads all bands at once.",
        SequentialReadout { acquisition_s, bands } => format!(
            "bands are read one after the other: {} until all {bands} are read, during which nothing may change",
            quantity(*acquisition_s, "s")
        ),
    }
    MotionBlur {
        meaning: "The target moves by a pixel or more while all bands are exposed; the bound assumes less.",
        remedy: "Shorten the exposure, or allow less speed.",
        MotionBlur { pixels } => format!(
            "the target moves {} pixels while all bands are exposed; the bound assumes less than 1",
            significant(*pixels, 2)
        ),
    }
    MotionBlurUnknown {
        meaning: "A speed is required, but without a distance the motion blur is unknown.",
        remedy: "Write target.distance, or distance in [envelope].",
        MotionBlurUnknown => "a speed is given, but for the motion blur the scenario must say target.distance",
        RuleMotionBlurUnknown => "a speed is given, but motion blur needs a distance",
    }
    ContradictoryView {
        meaning: "Pixel and focal length of the camera give another angle per pixel than its field of view \
            and number of pixels.",
        remedy: "Correct the figure that is wrong: pixel, focal_length, field_of_view or pixels.",
        ContradictoryView { finer_rad, coarser_rad } => format!(
            "its figures contradict each other: a pixel sees {} or {} mrad, by its side and the focal length or by the field of \
             view and the pixels across it; motion blur is the largest that any three of the four figures make, and a rule counts \
             pixels on the target by the coarser angle",
            significant(1e3 * finer_rad, 3),
            significant(1e3 * coarser_rad, 3)
        ),
    }
    FilterLightLeftOut {
        meaning: "Light of filters and of the sensor is left out, or the sensor's temperature is given \
            where it has no effect.",
        remedy: "Write camera.sensor_temperature where there are filters, and only there.",
        FilterLightLeftOut => "the light that filters reflect onto the sensor and emit is left out: sensor_temperature is not \
             given",
        SensorTemperatureIdle => "sensor_temperature has no effect: there are no filters that reflect its light back",
    }
    NoSurroundings {
        meaning: "There are no surroundings: the target is in empty space, where nothing but its own \
            emission is seen.",
        remedy: "Write [[environment]] with what is around the target: walls, ground, sky.",
        NoSurroundings => "there are no surroundings: the target is in empty space, and nothing is seen but its own emission",
    }
    TargetSizeUnknown {
        meaning: "A pixel sees more than a person at the target's distance, and the target is taken to fill \
            it.",
        remedy: "Write target.size and a [background], or come nearer.",
        TargetSizeUnknown { footprint_m } => format!(
            "a pixel sees {} at the target, which is taken to fill it; a person does not",
            length(*footprint_m)
        ),
    }
    TargetSmallerThanPixel {
        meaning: "The target does not fill its pixel.",
        remedy: "Keep a margin for targets between pixels, or magnify.",
        TargetSmallerThanPixel { fill } => format!(
            "the target fills {} % of its pixel, if it is in the middle of one; on the edge of two or \
             four of them it is seen by each in part",
            significant(100.0 * fill, 2)
        ),
    }
    Diffraction {
        meaning: "The lens blurs a point over more than a pixel.",
        remedy: "Lower the f-number or enlarge the pixel; expect neighbours to mix.",
        Diffraction { wavelength_m, blur_m, ring_m, pixel_m } => format!(
            "at {} the lens blurs a point over lambda F = {} (first dark ring at {}), more than the pixel of {}: \
             neighbours see the same, and an edge of the target is spread over pixels",
            quantity(*wavelength_m, "m"),
            quantity(*blur_m, "m"),
            quantity(*ring_m, "m"),
            quantity(*pixel_m, "m"),
        ),
    }
    FrameRate {
        meaning: "Several exposures come at the frame rate and so take longer than their sum.",
        remedy: "Take fewer frames or a faster camera, or make sure that nothing changes.",
        FrameRate { exposures, acquisition_s, frame_rate_hz, exposed_s } => format!(
            "{exposures:.0} exposures take {} at {} frames per second, not {}; nothing may change meanwhile",
            quantity(*acquisition_s, "s"),
            significant(*frame_rate_hz, 3),
            quantity(*exposed_s, "s"),
        ),
    }
    OutsideDetectorRange {
        meaning: "Some bands lie mostly outside the range in which the detector's figures are stated.",
        remedy: "Narrow the bands, or state figures that hold there.",
        OutsideDetectorRange { outside, bands, range_cm1: [low, high] } => format!(
            "{outside} of {bands} bands are for the most part outside {low} to {high} cm^-1, the range in which the \
             figures of the detector are stated; they are taken to hold there too"
        ),
    }
    GammaShortcut {
        meaning: "The shortcut by a mean noise is off; the exact distance is what is reported.",
        remedy: "Nothing; do not use the shortcut here.",
        GammaShortcut { off } => {
            let percent = 100.0 * off;
            format!(
                "the shortcut sqrt(N/(1+gamma)) d0 is off by {percent:+.0} %; the exact value is used"
            )
        },
    }
    FullWell {
        meaning: "A reading exceeds the full well of a pixel.",
        remedy: "Shorten the exposure, or take more frames of less each.",
        FullWell { counts, full_well } => {
            let (counts, full_well) = (significant(*counts, 3), significant(*full_well, 3));
            format!("{counts} photons in one reading exceed the full well of {full_well}")
        },
        PixelFull { counts, full_well } => format!(
            "the brightest band of the brightest pixel holds {} photons, the well {}: shorten the exposure",
            short(*counts),
            short(*full_well)
        ),
    }
    CameraFigureAssumed {
        meaning: "No document states a figure of the camera: it was assumed.",
        remedy: "Measure it or ask the maker, and write it under [camera].",
        CameraFigureAssumed { figure } => figure.say(),
        CameraFiguresAssumed { camera, figures } => {
            format!("no document states all of {camera}: {}", figures.iter().map(Say::say).collect::<Vec<_>>().join("; "))
        },
    }
}
