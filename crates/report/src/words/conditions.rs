//! What a verdict rests on. A favourable condition completes 'yes, if ', another says what was taken.

use super::Say;
use super::text::footing::ASK_MORE;
use super::text::numbers::{celsius, in_number, listed};
use hadar::instrument::Assumed;
use hadar::words::{length, quantity, share, significant};
use hadar_study::{Condition, Proviso, RangeDecides};
use std::fmt::Write as _;

/// Physics ends there; a range that reaches it is no range, K.
const NO_END_K: [f64; 2] = [0.2, 9e5];

impl Say for Assumed {
    fn say(&self) -> String {
        format!("{} is not stated; taken: {}", self.figure, self.taken)
    }
}

impl Say for Proviso {
    fn say(&self) -> String {
        let (time, way) = (quantity(self.time_s, "s"), length(self.way_m));
        format!("its {} frames can be registered ({time}, {way} of travel)", self.frames)
    }
}

impl Say for RangeDecides {
    fn say(&self) -> String {
        let [low, high] = self.stated;
        match self.figure {
            "alternatives.temperature" => {
                let ends = [low, high].map(celsius);
                let end = |k: f64, word: &str| {
                    if k <= NO_END_K[0] || k >= NO_END_K[1] {
                        format!("{word} however far")
                    } else {
                        format!("{word} to {}", celsius(k))
                    }
                };
                let far = self.holds.unwrap_or(self.stated);
                let holds = match (far[0] < low, far[1] > high) {
                    _ if self.holds.is_none() => "how far the answer holds was not searched".to_owned(),
                    (false, false) => "beyond either end the answer changes".to_owned(),
                    (below, above) => {
                        let down = if below { end(far[0], "down") } else { "not below".into() };
                        let up = if above { end(far[1], "up") } else { "not above".into() };
                        format!("the answer holds {down} and {up}")
                    }
                };
                format!("no alternative is colder than {} or warmer than {} ({holds})", ends[0], ends[1])
            }
            _ => {
                let holds = self.holds.map_or_else(
                    || "how far the answer holds was not searched".to_owned(),
                    |far| {
                        format!(
                            "the answer holds from {} to {}",
                            significant(far[0], 3),
                            significant(far[1], 3)
                        )
                    },
                );
                format!("the lighting of the alternatives stays between {low} and {high} ({holds})")
            }
        }
    }
}

/// What holds of a camera whose figure nobody stated.
fn holds(figure: &Assumed, counts: Option<f64>) -> String {
    let taken = &figure.taken;
    let said = match figure.figure {
        "exposure" => format!("its exposure is {taken}"),
        "optics_efficiency" => "its optics transmit everything".into(),
        "quantum_efficiency" => "all photons on its detector are counted".into(),
        "netd_temperature" => format!("its NETD is of a blackbody of {taken}"),
        "netd_f_number" => format!("its NETD is that behind {taken}"),
        "netd_pixel" => format!("its NETD is that of a pixel of {taken}"),
        "netd_optics_efficiency" => "its NETD is that behind its own lens".into(),
        "spectral_bands" => "it measures as many bands as the scenario has".into(),
        "noise_exposure" => format!("its noise is that of an exposure of {taken}"),
        "spectral_range" => format!("its detector sees {taken} and no more"),
        "flicker_fraction" => "all of its noise averages out over the exposures".into(),
        "fixed_pattern" => {
            return format!(
                "the correction leaves no fixed pattern of pixels, rows or columns and no lasting offset ({} not stated)",
                taken.trim_start_matches("0 (").trim_end_matches(')')
            );
        }
        "readout" => format!("its readout is {taken}"),
        "frame_rate" => "exposures follow each other without a pause".into(),
        "full_well" => match counts {
            Some(counts) => format!("{} counts do not saturate a pixel", significant(counts, 2)),
            None => "no pixel saturates".into(),
        },
        "dark_rate" => "it counts nothing in the dark".into(),
        "read_noise" => "reading it adds no noise".into(),
        "quantisation_bits" => "its converter adds no noise".into(),
        "pixels" => "it has as many pixels as the object fills".into(),
        other => format!("{other} is {taken}"),
    };
    format!("{said} ({} is not stated)", figure.figure)
}

impl Say for Condition {
    fn say(&self) -> String {
        match self {
            Self::Range(range) => range.say(),
            Self::RegisteredFrames(proviso) => proviso.say(),
            Self::StillScene { time_s } => format!("nothing moves for {}", quantity(*time_s, "s")),
            Self::Constants { emissivities: [one, other] } => format!(
                "real surfaces have the constant emissivities entered ({one} and {other}), which were not measured"
            ),
            Self::Emissivities { error, share_met } => format!(
                "the emissivities are known better than to {error} rms ({} of draws with such errors meet the requirement)",
                share(*share_met)
            ),
            Self::SharedErrors { error, distance, undone: false } => format!(
                "the emissivities are as entered (with errors of {error} rms, shared by all pixels, d is {} at most, still enough)",
                significant(*distance, 2)
            ),
            Self::SharedErrors { error, distance, .. } => format!(
                "the emissivities are known better than to {error} rms (with such errors, shared by all pixels, d is {} at most)",
                significant(*distance, 2)
            ),
            Self::ErrorsCorrelated { length_cm1 } => {
                format!("errors of the emissivities are correlated over {length_cm1} cm^-1 and no more")
            }
            Self::NobodyCrosses => "what is looked for neither crosses the way nor leaves the view".into(),
            Self::InView { bearing_rad } => format!(
                "a target that crosses, up to {} deg off the axis, is in its view (field_of_view is not stated)",
                significant(bearing_rad.to_degrees(), 2)
            ),
            Self::PatternOfEachBand => {
                "the fixed pattern is independent from band to band, as after a correction behind each filter".into()
            }
            Self::PatternOfEachPixel => {
                "row and column noise is independent between the pixels of a window".into()
            }
            Self::PixelsByLens => {
                "as many pixels are on the target as pixel and focal length give, which the field of view contradicts".into()
            }
            Self::AlikePixels { pixels, square } => format!(
                "the {} pixels that are added up are identified{}, and all see the target in the same state",
                in_number(*pixels),
                if *square { ", fill a square (their rows and columns are not stated)" } else { "" }
            ),
            Self::FrameNoise { figures } => format!(
                "rows, columns and frames of the array have no common noise from frame to frame ({} not stated)",
                figures.join(", ")
            ),
            Self::Assumed { figure, counts } if figure.favourable => holds(figure, *counts),
            Self::Assumed { figure, .. } => figure.say(),
            Self::Spoiled { by } => {
                format!("it does not matter that {}", super::shortfall::clauses(std::slice::from_ref(by)))
            }
            Self::NoLimit => "the paper's local distance, which is no limit, can be trusted".into(),
            Self::Bunching { occupancy } => format!(
                "the bunching of thermal photons is left out ({} photons per mode)",
                significant(*occupancy, 2)
            ),
            Self::FillsPixel { footprint_m: Some(footprint_m) } => {
                format!("the target fills a pixel, which sees {} there", length(*footprint_m))
            }
            Self::FillsPixel { footprint_m: None } => "the target fills a pixel at its distance".into(),
            Self::Modelled { bands } => {
                format!("a camera with one band reads {bands} bands at once, which none can do")
            }
            Self::BeyondRange { outside, bands } => {
                format!("the detector's figures also hold outside its range ({outside} of {bands} bands)")
            }
            Self::Sampled { width_cm1 } => {
                format!("bands up to {} cm^-1 wide can be sampled at their centres", significant(*width_cm1, 3))
            }
            Self::InOnePixel { fill } => {
                format!("the target, which fills {} of a pixel, lies in the middle of one", share(*fill))
            }
            Self::Diffraction { blur_m } => format!(
                "the neighbourhood of the target does not matter, although the lens blurs a point over {}",
                quantity(*blur_m, "m")
            ),
            Self::NoFilterLight => {
                "the filters neither emit nor reflect radiation onto the sensor (sensor_temperature is not stated)".into()
            }
            Self::FilterAngle { before_lens: true, .. } => {
                "the target is near the axis: off axis, filters before the lens pass shorter wavelengths".into()
            }
            Self::FilterAngle { before_lens: false, sine } => format!(
                "the filters transmit the same at up to {:.0} degrees as at normal incidence (place is not stated)",
                sine.asin().to_degrees()
            ),
            Self::FilterCut { share: cut } => format!(
                "the filters transmit nothing beyond the rows of their tables, at whose ends they transmit up to {}",
                share(*cut)
            ),
            Self::NoAir => "the air on the path absorbs nothing".into(),
            Self::NoSurroundings => "no surroundings illuminate the target".into(),
            Self::DarkRest { share: rest } => format!(
                "up to {} of the hemisphere above the target is filled by no object and sends no radiation",
                share(*rest)
            ),
            Self::Waits { time_s } => {
                format!("the decision may wait {} until all is read", quantity(*time_s, "s"))
            }
            Self::EmissivityKnown => "the emissivity of the measured surface is exactly as entered".into(),
            Self::AirTemperatureKnown => "the temperature of the air on the path is exactly as entered".into(),
            Self::ShotNoiseAlone => "the cube has no noise but the shot noise of its counts".into(),
            Self::SamplesArePhotons => "one unit of its samples is one photon".into(),
            Self::ExpectedCounts => "its counts are expectations, and none of their texture is noise".into(),
            Self::OneScene => "real objects have the texture of the one scene that is rendered".into(),
            Self::SurroundingsKnown { black: 0 } => "the temperatures of the surroundings are known".into(),
            Self::SurroundingsKnown { black } => {
                format!("the temperatures of the surroundings are known; taken as black: {black} (no material is stated)")
            }
            Self::TemperatureKnown => "the temperature of the target is known".into(),
            Self::LightingKnown => "how much each of the surroundings lights the target is known".into(),
            Self::Calibrated => "the gain of the camera is known".into(),
            Self::Extrapolated { materials } => {
                format!("spectra continue beyond their tables as extrapolated ({})", listed(materials))
            }
            Self::LeftOut { materials } => {
                format!("the omitted materials never occur ({})", listed(materials))
            }
            Self::Setting { key, value, of_rule: true } => {
                format!("{key} = {value} replaces the value of the rule")
            }
            Self::Setting { key, value, .. } => format!("{key} = {value} replaces the value of the file"),
        }
    }
}

/// Codes of conditions, what they mean, and what to do; figures of a camera are explained as their keys are.
pub(crate) const EXPLAINED: [[&str; 3]; 43] = [
    [
        "range",
        "A range that the scenario sets for the alternatives excludes states that could not be distinguished.",
        "Widen the range to all that may happen, or make sure that nothing is beyond it.",
    ],
    [
        "registered-frames",
        "Frames are added up while something moves at the required speed: they must be registered first.",
        "Take fewer frames, or make sure that they can be registered.",
    ],
    [
        "still-scene",
        "No speed is stated: nothing may move by a pixel until all bands of all frames are read.",
        "Write requirement.speed, and requirement.time for how long it may take.",
    ],
    [
        "constant-emissivities",
        "Both materials of the deciding pair are entered as one number: the differences of real surfaces are not known.",
        "Measure their spectra, or name materials of which one is known.",
    ],
    [
        "emissivities",
        "Errors of the emissivities, of the usual size, may undo the answer.",
        "Measure these emissivities, and state sensitivity.emissivity_error.",
    ],
    [
        "shared-emissivity-errors",
        "How well the emissivities are known is not stated: all pixels of an object share their errors, and no number of pixels or frames \
         averages them away.",
        "Measure these emissivities, and state sensitivity.emissivity_error, which the verdict then includes.",
    ],
    [
        "errors-correlated",
        "The correlation length of errors of the emissivities is not stated.",
        "State sensitivity.correlation together with the error.",
    ],
    [
        "extrapolated",
        "Bands lie outside the measured range of a spectrum, which extrapolate = \"hold\" or \"linear\" continues by a guess.",
        "Choose bands that the spectra cover, or measure a wider range.",
    ],
    [
        "nobody-crosses",
        "Only the vehicle moves: a crossing target blurs more, and is outside the view of a slow vehicle's camera.",
        "State [stop] crossing_speed (0 for a target that does not move) and offset.",
    ],
    [
        "in-view",
        "Whether a crossing target is in view until the decision is not known.",
        "State camera.field_of_view, or pixels.",
    ],
    [
        "pattern-of-each-band",
        "Fixed patterns are taken as independent between bands; an offset common to all bands may be worse or better.",
        "Correct the non-uniformity behind every filter.",
    ],
    [
        "pattern-of-each-pixel",
        "Row and column noise is taken as independent in every pixel; noise common to a whole column of a window shifts a disparity more.",
        "Take out stripes first (`hadar calibrate stripes`), and state what is left as camera.fixed_pattern.",
    ],
    [
        "pixels-by-lens",
        "Field of view and pixels across it contradict pixel and focal length, by which the pixels on the object are counted.",
        "State the camera.field_of_view of this lens.",
    ],
    [
        "alike-pixels",
        "The counts of all pixels of an object are added up: they must be known to lie on it, and all see it in one state.",
        "Segment the image first; ask of one pixel (requirement.of = \"pixel\") where the object is of several materials or temperatures.",
    ],
    [
        "frame-noise",
        "Temporal noise of rows, columns and frames is not stated; the pixels of an object do not average it away.",
        "State camera.temporal_row_noise, temporal_column_noise and frame_noise, from the data sheet or `hadar calibrate noise`.",
    ],
    [
        "image",
        "Only distances are compared, but the image fails: by motion blur, saturation, or a decision that comes too late.",
        "Shorten the exposure, or ask `hadar size`, which judges the image.",
    ],
    [
        "no-limit",
        "A local distance decides, which is no limit and can err either way.",
        "Leave out requirement.by.",
    ],
    [
        "photon-bunching",
        "The bunching of thermal photons is neglected, but could change the verdict.",
        "Write camera.photon_bunching = true.",
    ],
    [
        "fills-pixel",
        "The size of the target or its distance is not stated: it is taken to fill a pixel.",
        "Write target.size with a [background], and target.distance.",
    ],
    [
        "modelled",
        "The camera has one band, and its entry models it as reading all bands at once, which no such camera can.",
        "Write camera.readout = \"sequential\" for filters before it, one after the other.",
    ],
    [
        "beyond-range",
        "Some bands lie mostly outside the range in which the detector's figures are stated.",
        "Narrow the bands, or state a camera.spectral_range that holds them.",
    ],
    [
        "bands-sampled",
        "Wide bands of a grid or of rows are sampled at their centres, which may differ from the mean over the band.",
        "Write bands.integrate = true, or the bands as ranges.",
    ],
    [
        "in-one-pixel",
        "The target is smaller than a pixel, and is taken to lie within one.",
        "Keep a margin for targets between pixels, or magnify.",
    ],
    [
        "diffraction",
        "The lens blurs a point over more than a pixel: the edge of the target mixes with its neighbourhood.",
        "Lower the f-number or enlarge the pixel.",
    ],
    [
        "no-filter-light",
        "The radiation that filters emit and reflect onto the sensor is omitted.",
        "Write camera.sensor_temperature.",
    ],
    [
        "filter-angle",
        "An interference filter passes shorter wavelengths at an angle; its transmission at normal incidence is used for the whole beam.",
        "Write place = \"sensor\" and index in [bands] (or find.filters): the transmission is then averaged over the cone of the lens; before the lens keep the target near the axis.",
    ],
    [
        "filter-cut",
        "The table of a filter ends where the filter still transmits; beyond it nothing is taken to be transmitted.",
        "Add rows down to where it transmits nothing, or write a camera.spectral_range that ends with the table.",
    ],
    ["no-air", "There is no air on the path.", "Write [atmosphere] with model = \"us-standard\"."],
    [
        "no-surroundings",
        "No surroundings illuminate the target.",
        "Write [[environment]] with what is around the target.",
    ],
    [
        "dark-rest",
        "The lighting factors add up to less than 1: a part of what is around the target is black and cold.",
        "Write an [[environment]] for the rest: sky, ground, walls.",
    ],
    [
        "acquisition-time",
        "How long the decision may take is not stated: all bands of all frames are read first.",
        "Write requirement.time.",
    ],
    [
        "calibrated",
        "The gain of the camera is not among the unknowns: it is taken as known.",
        "Add \"gain\" to unknown.nuisances if it is unknown.",
    ],
    [
        "surroundings-known",
        "The temperatures of the surroundings are not among the unknowns: they are taken as known; surroundings without a material are \
         taken as black.",
        "Add \"environment-temperature\" to unknown.nuisances if they are unknown; write the material of every [[environment]].",
    ],
    [
        "temperature-known",
        "The temperature of the target is not among the unknowns: whoever decides is taken to know it exactly.",
        "Add \"temperature\" to unknown.nuisances if nobody measures it.",
    ],
    [
        "lighting-known",
        "The lighting is not among the unknowns: whoever decides is taken to know how much each of the surroundings lights the target.",
        "Add \"lighting\" to unknown.nuisances if nobody measures it.",
    ],
    [
        "emissivity-known",
        "The emissivity of the measured surface is taken as exact: its error is not included in the bound of the temperature.",
        "Write [sensitivity] with emissivity_error: the clause is undecided then.",
    ],
    [
        "air-temperature-known",
        "The temperature of the air is not among the unknowns: it is taken as entered, and an error of it imitates a distance.",
        "Add \"air-temperature\" to unknown.nuisances.",
    ],
    [
        "shot-noise-alone",
        "The noise of the cube is not stated: only the shot noise of its counts is taken.",
        "Write noise_variance, or a [camera] with [bands].",
    ],
    [
        "samples-are-photons",
        "Neither photons_per_unit nor a unit in the file says what one unit of the samples is: it is taken as one photon.",
        "Write photons_per_unit.",
    ],
    [
        "expected-counts",
        "The noise of measured counts looks like texture, so that the bound on the depth comes out too small.",
        "Give expected counts or the mean of many frames; the warning noise-in-counts says how much it may be.",
    ],
    [
        "one-scene",
        "How well a distance is known depends on the texture, which is that of the one rendered scene.",
        "Accept it, or ask `hadar range` about scenes of your own.",
    ],
    [
        "materials-left-out",
        "Alternatives that do not cover the bands were left out, as was asked for.",
        "Choose bands that they cover, or make sure that they are never met.",
    ],
    [
        "setting",
        "A value replaces that of the file; a rule with other values is another rule.",
        "Write it into the file.",
    ],
];

/// A 'yes' with the hardest of its conditions, and how many more there are.
pub(crate) fn yes(conditions: &[Condition]) -> String {
    let mut open = Condition::open(conditions);
    match (open.next(), open.count()) {
        (None, _) => "yes".into(),
        (Some(one), 0) => format!("yes, if {}", one.say()),
        (Some(one), 1) => format!("yes, if {}, and under 1 more condition", one.say()),
        (Some(one), more) => format!("yes, if {}, and under {more} more conditions", one.say()),
    }
}

/// A 'yes' on a line of its own.
pub(crate) fn yes_alone(conditions: &[Condition]) -> String {
    match under(conditions) {
        none if none.is_empty() => "met".into(),
        under => format!("yes{under}"),
    }
}

/// What follows a statement that holds under conditions: the hardest in words, the others by their codes; nothing without.
pub(crate) fn under<'c>(conditions: impl IntoIterator<Item = &'c Condition>) -> String {
    let mut open = conditions.into_iter().filter(|one| one.favourable());
    let Some(hardest) = open.next() else { return String::new() };
    let more: Vec<String> = open.map(Condition::code).collect();
    let more = if more.is_empty() { String::new() } else { format!(" (and {})", more.join(", ")) };
    format!(", if {}{more}", hardest.say())
}

/// All conditions of a 'yes', or of a 'no', in a paragraph of their own; nothing without.
pub(crate) fn paragraph(conditions: &[Condition], met: bool) -> String {
    match paragraph_of("", conditions, met) {
        none if none.is_empty() => none,
        said => format!("{}\n{ASK_MORE}\n\n", said.trim_end()),
    }
}

/// The same of a camera among several.
pub(crate) fn paragraph_of(camera: &str, conditions: &[Condition], met: bool) -> String {
    if conditions.is_empty() {
        return String::new();
    }
    let mut out = if camera.is_empty() { String::new() } else { format!("{camera}: ") };
    let (open, rest): (Vec<_>, Vec<_>) = conditions.iter().partition(|one| met && one.favourable());
    if !open.is_empty() {
        out += "The yes holds only if\n";
        for one in &open {
            let _ = writeln!(out, "  [{}] {}", one.code(), one.say());
        }
    }
    if !rest.is_empty() {
        out += if open.is_empty() { "The verdict assumes\n" } else { "It assumes as well\n" };
        for one in rest {
            let _ = writeln!(out, "  [{}] {}", one.code(), one.say());
        }
    }
    out + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_yes_names_the_hardest_and_counts_the_rest() {
        assert_eq!(yes(&[]), "yes");
        let still = Condition::StillScene { time_s: 88.0 };
        assert_eq!(yes(std::slice::from_ref(&still)), "yes, if nothing moves for 88.0 s");
        let set = Condition::Setting { key: "camera.frames".into(), value: "256".into(), of_rule: false };
        let all = [still, Condition::NoAir, Condition::NoSurroundings, set];
        assert_eq!(yes(&all), "yes, if nothing moves for 88.0 s, and under 2 more conditions");
        let said = paragraph(&all, true);
        assert_eq!(said.matches("\n  [").count(), 4, "{said}");
        assert!(said.contains("It assumes as well\n  [setting] camera.frames = 256"), "{said}");
    }

    #[test]
    fn every_code_is_explained() {
        let figures = Assumed::FIGURES.iter().map(|figure| figure.replace('_', "-"));
        let mut explained: Vec<String> =
            EXPLAINED.iter().map(|row| row[0].to_owned()).chain(figures).collect();
        let mut codes = Condition::codes();
        codes.sort();
        explained.sort();
        assert_eq!(codes, explained);
    }

    #[test]
    fn a_range_says_how_far_the_answer_holds() {
        let kelvin = |ends: [f64; 2]| ends.map(|celsius| celsius + 273.15);
        let range = |holds| RangeDecides {
            figure: "alternatives.temperature",
            stated: kelvin([0.0, 40.0]),
            holds: Some(kelvin(holds)),
        };
        let said = range([-273.0, 44.0]).say();
        assert!(said.ends_with("(the answer holds down however far and up to 44.00 degC)"), "{said}");
        assert!(range([0.0, 40.0]).say().ends_with("(beyond either end the answer changes)"));
    }
}
