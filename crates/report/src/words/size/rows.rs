//! The numbers of a sizing one by one: what each is called, its value with its unit, and the key of the JSON that it stands at.

use crate::text::numbers::{between, fixed, in_number, quantity, significant};
use crate::words::probability::probability;
use crate::words::size::no_limit;
use hadar::identifiability::decision::DecisionLaw;
use hadar::policy::{Quantity, Solution};
use hadar::words::share;
use hadar_scenario::Units;
use hadar_study::{PairResult, Sizing, Study};

/// A number that is shown.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Row {
    /// Name of the number as it is shown.
    pub label: &'static str,
    /// The number with its unit, with no more digits than are trusted.
    pub value: String,
    /// Its key in the JSON, by which it is explained.
    pub key: &'static str,
}

/// A figure of the camera that was solved for.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Solved {
    /// What it is called; nothing where one sentence says it of all.
    pub label: &'static str,
    /// Whether there is such a value.
    pub found: bool,
    /// The value that meets the requirement, with its unit, or that none does.
    pub value: String,
    /// What the camera has; empty where that is not known.
    pub now: String,
    /// Remark on the value, after a semicolon; may be empty.
    pub remark: String,
    /// Limits of the camera that the value would break, in words.
    pub caps: Vec<String>,
    /// Its key in the JSON.
    pub key: &'static str,
}

/// What the camera delivers in the scene, against the limiting alternative; nothing without a camera.
#[must_use]
pub fn of_camera(result: &Sizing, study: &Study) -> Vec<Row> {
    let (Some(camera), Some(pair)) = (&result.camera, limiting(result)) else { return Vec::new() };
    let mut rows = Vec::new();
    let mut row = |label, value, key| rows.push(Row { label, value, key });
    row("photons at the detector", significant(camera.photons, 4), "camera.photons");
    let of_band = match camera.camera.frames {
        1 => "electronic noise of a reading",
        _ => "electronic noise of a band",
    };
    row(of_band, format!("{} counts", significant(camera.noise_counts, 4)), "camera.noise_counts");
    row("gamma, electronic/photon noise", significant(camera.gamma_per_band, 3), "camera.gamma_per_band");
    let hardware = format!("{} m^2 s", significant(camera.hardware_m2_s, 4));
    row("H = t A_p / ((1+gamma) F^2)", hardware, "camera.hardware_m2_s");
    let by_local = no_limit(study.scenario().requirement.by).is_some();
    if let Some(d) = pair.statistical_distance {
        let required = significant(result.verdict.required_distance, 4);
        let label = if by_local { "statistical distance, local" } else { "statistical distance d" };
        let d = pair.statistical_distance_bounds.map_or_else(|| significant(d, 3), |ends| between(ends, 3));
        row(label, format!("{d} (required {required})"), "verdict.statistical_distance");
    }
    if let (Some(d), Some(miss), Some(bits)) =
        (pair.statistical_distance, pair.miss_probability, pair.information_bits)
    {
        let label =
            if by_local { "P by local distance (no limit)" } else { "P of a correct decision, at most" };
        let error = match miss {
            0.0 => "below 1e-300".to_owned(),
            miss => significant(miss, 3),
        };
        let few = pair.decided_by.is_some_and(|law| law != DecisionLaw::Gaussian);
        let law = if few { ", by the law of small counts" } else { "" };
        row(label, format!("{} (error {error}{law})", probability(d, 4)), "pairs.detection_probability");
        row("information log2 2P", format!("{} bit", significant(bits, 3)), "pairs.information_bits");
    }
    if let (true, Some(d)) = (by_local, pair.statistical_distance_nearest) {
        let limit = format!("{} (probability {})", significant(d, 3), probability(d, 4));
        row("the limit, by the nearest distance", limit, "verdict.statistical_distance_nearest");
    }
    let least = format!("{} per sqrt(photon)", significant(camera.least_distance, 3));
    row("least semantic distance resolved", least, "camera.least_distance");
    if let Some(footprint) = camera.footprint_m {
        row("pixel footprint at the target", study.units().length(footprint), "camera.footprint_m");
    }
    if let Some(blur) = camera.motion_blur_pixels {
        let of_bands = camera.camera.readout.exposures(study.bands().len()) > 1;
        let label = if of_bands { "motion while bands are exposed" } else { "motion during an exposure" };
        row(label, format!("up to {} pixel", significant(blur, 2)), "camera.motion_blur_pixels");
    }
    rows
}

/// What all pixels of the object say together; nothing of one pixel.
#[must_use]
pub fn of_object(result: &Sizing) -> Vec<Row> {
    let Some(object) = &result.object else { return Vec::new() };
    let mut rows = Vec::new();
    let mut row = |label, value, key| rows.push(Row { label, value, key });
    let readings = object.pixels * f64::from(object.frames);
    let sides = [object.rows, object.columns].map(in_number).join(" x ");
    let frames = if object.frames > 1 { format!(", {} frames", object.frames) } else { String::new() };
    row("pixels on the object", format!("{} ({sides}{frames})", in_number(object.pixels)), "object.pixels");
    let one = between(object.distance_of_one_bounds, 2);
    row("d of one pixel in one frame", one, "object.distance_of_one_bounds");
    row("d of all readings", between(object.distance_bounds, 2), "object.distance_bounds");
    let worth = format!("{} of {}", significant(object.effective_readings, 2), significant(readings, 3));
    row("equivalent independent readings", worth, "object.effective_readings");
    match object.ceiling_bounds {
        Some(ceiling) => {
            let shares = object.ceiling_made_of.iter();
            let shares: Vec<String> =
                shares.map(|one| format!("{} {}", one.label, share(one.share))).collect();
            row("d in the limit of many frames", between(ceiling, 2), "object.ceiling_bounds");
            row("  noise that remains there", shares.join(", "), "object.ceiling_made_of");
        }
        None => row(
            "d in the limit of many frames",
            "grows as the square root of the number of frames".into(),
            "object.ceiling_bounds",
        ),
    }
    if let Some(frames) = object.frames_worth {
        row("frames that reach 90 % of that", fixed(frames, 0), "object.frames_worth");
    }
    let errors = match object.emissivity_error {
        Some(error) => format!("{error} rms, the same in all pixels, is included in these figures"),
        None => "not included in these figures (state [sensitivity])".into(),
    };
    row("errors of the emissivities", errors, "object.emissivity_error");
    rows
}

/// What would do, quantity by quantity; where nothing helps for one and the same reason a single one without a name.
#[must_use]
pub fn solved(result: &Sizing, units: Units) -> Vec<Solved> {
    let Some(solutions) = &result.solve_for else { return Vec::new() };
    let hopeless = |solution: &Solution| solution.value.is_none() && solution.statistical_distance == 0.0;
    if solutions.0.iter().all(|(_, solution)| hopeless(solution))
        && let Some(reason) = solutions.0.iter().find_map(|(_, solution)| solution.reason.as_ref())
    {
        let value = format!("nothing: {reason}");
        let (now, remark) = (String::new(), String::new());
        return vec![Solved {
            label: "",
            found: false,
            value,
            now,
            remark,
            caps: Vec::new(),
            key: "solve_for",
        }];
    }
    // A speed that was not asked for and cannot be worked out is of no interest.
    let of_interest =
        |(solved, solution): &&(Quantity, Solution)| *solved != Quantity::Speed || !solution.camera.is_nan();
    let row = |(solved, solution): &(Quantity, Solution)| one(*solved, solution, result, units);
    solutions.0.iter().filter(of_interest).map(row).collect()
}

/// Whether two values of a quantity are the same in the digits shown.
fn same(one: f64, other: f64) -> bool {
    (one - other).abs() <= 2e-3 * other.abs()
}

fn one(solved: Quantity, solution: &Solution, result: &Sizing, units: Units) -> Solved {
    let label = match solved {
        Quantity::Speed => "speed, at the exposure required",
        other => other.name(),
    };
    let value = match (solution.value, &solution.reason) {
        (Some(value), _)
            if solution.necessary.is_some_and(|other| !same(value, other)) && solution.reason.is_none() =>
        {
            let necessary = in_unit(solved, solution.necessary.unwrap_or(value), units);
            let side = if solved.is_least() { "at least" } else { "at most" };
            format!("{}, {necessary} {side}", in_unit(solved, value, units))
        }
        (Some(value), _) => in_unit(solved, value, units),
        (None, Some(reason)) if solution.necessary.is_some() => {
            let necessary = in_unit(solved, solution.necessary.unwrap_or(f64::NAN), units);
            format!("none: {reason} ({necessary} would distinguish the two)")
        }
        (None, Some(reason)) if solution.statistical_distance >= result.requirement.distance => {
            format!("any: {reason}")
        }
        (None, Some(reason)) if solution.statistical_distance.is_nan() => format!("not solved: {reason}"),
        (None, Some(reason)) => {
            format!(
                "no value meets the requirement: {reason} (reaches d = {})",
                significant(solution.statistical_distance, 2)
            )
        }
        (None, None) => "no value meets the requirement".into(),
    };
    // The noise of bands may differ: what is solved for is a factor of them all.
    let factor = match (solved, solution.value) {
        (Quantity::Noise, Some(value)) if solution.camera > 0.0 => {
            format!(", times {}", significant(value / solution.camera, 3))
        }
        _ => String::new(),
    };
    let now = match solution.camera.is_finite() {
        true => format!("now {}{factor}", in_unit(solved, solution.camera, units)),
        false => String::new(),
    };
    let remark = solution.value.and(solution.reason.as_ref()).map(|reason| format!("; {reason}"));
    let caps = solution.caps.iter().map(|cap| {
        let side = if cap.blocks { "but" } else { "preferably" };
        let bound = match (cap.blocks, solved.is_least()) {
            (true, true) | (false, false) => "no more than",
            (true, false) | (false, true) => "no less than",
        };
        format!("[{}] {side} {bound} {}: {}", cap.code.name(), in_unit(solved, cap.limit, units), cap.reason)
    });
    Solved {
        label,
        found: solution.value.is_some(),
        value,
        now,
        remark: remark.unwrap_or_default(),
        caps: caps.collect(),
        key: "solve_for",
    }
}

/// The alternative that is hardest to tell apart.
pub(crate) fn limiting(result: &Sizing) -> Option<&PairResult> {
    result.pairs.iter().find(|pair| pair.alternative == result.limiting)
}

pub(crate) fn in_unit(solved: Quantity, value: f64, units: Units) -> String {
    match solved {
        Quantity::Exposure => quantity(value, "s"),
        Quantity::Pixel => quantity(value, "m"),
        Quantity::FNumber => format!("f/{}", significant(value, 3)),
        Quantity::Noise => format!("{} counts", significant(value, 3)),
        Quantity::Frames => fixed(value, 0),
        Quantity::Distance => units.length(value),
        Quantity::Speed => units.speed(value),
    }
}
