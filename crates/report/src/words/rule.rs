//! What comes of a rule, in sentences.

pub(crate) mod certificate;
mod check;
pub(crate) mod course;
pub(crate) mod grid;
mod hardest;
mod market;
mod measured;
mod moved;
mod reasons;
mod reforms;
pub mod rows;
mod sources;
mod stand_in;
mod stop;
mod text;

pub use check::check;
pub use grid::cell_by_cell;
pub(crate) use hardest::{HardestScene, hardest_scenes};
pub(crate) use measured::measure;
pub use moved::figures_moved;
pub(crate) use moved::title_of_figures;
pub(crate) use reasons::REASONS;
pub use reforms::reforms;
pub(crate) use reforms::title_of_reforms;
pub use sources::{sources, tests};
pub(crate) use stand_in::below_a_line;
pub use stand_in::stand_in;
pub use text::text;
pub(crate) use text::together;

use super::Say;
use super::classes::one_number;
use super::probability::demanded;
use super::text::numbers::{in_a_row, in_number};
use hadar::ranging::depth::Demand;
use hadar::words::{self, fixed, length, quantity, significant};
use hadar_scenario::{Units, interval};
use hadar_study::{
    Certified, Condition, Definition, EmissivityError, EnvelopeResult, IdealCamera, LightTime, Proof,
    Quotable, StopResult, WhoMeets,
};

impl Say for WhoMeets {
    fn say(&self) -> String {
        let mut out = self.idle.as_ref().map_or_else(String::new, |idle| {
            format!("Nothing is required: {}. If it were in force: ", idle.say())
        });
        out += &which(self);
        let named = self.meet.len() + self.undecided.len() + self.fail.len() > 1;
        for (name, interval) in &self.undecided {
            let of = if named { format!(" of {name}") } else { String::new() };
            match interval {
                Some([low, high]) if *low < 1.0 && *high >= 1.0 => {
                    let ends = [low, high].map(|end| significant(*end, 3));
                    let said = if named { "Undecided" } else { "It" };
                    let verb = if named { ":" } else { " is so because" };
                    out += &format!(" {said}{of}{verb} the margin lies between {} and {}.", ends[0], ends[1]);
                }
                _ if named => out += &format!(" Undecided{of}."),
                _ => {}
            }
        }
        if !self.unproved.is_empty() {
            let names = self.unproved.join(", ");
            out += &format!(" Not proved of {names}: no scene below the requirement was found.");
        }
        for (target, alternative, [one, other]) in &self.placeholders {
            out += &format!(
                " The deciding pair is {target} and {alternative}, each entered as one number ({one} and {other}): the result \
                 says nothing about real surfaces."
            );
        }
        out
    }
}

/// Which cameras meet a rule or a clause.
fn which(who: &WhoMeets) -> String {
    let all = who.meet.len() + who.undecided.len() + who.fail.len();
    let what = if who.clause { "clause" } else { "rule" };
    let meet: Vec<String> = who
        .meet
        .iter()
        .map(|(name, conditions)| match Condition::open(conditions).next() {
            None => name.clone(),
            Some(hardest) => format!("{name} (if {})", hardest.say()),
        })
        .collect();
    let others: Vec<String> =
        who.undecided.iter().map(|(name, _)| name.clone()).chain(who.fail.iter().cloned()).collect();
    match (meet.as_slice(), others.as_slice()) {
        ([], [one]) if who.fail.is_empty() => format!("Whether {one} meets the {what} is undecided."),
        ([], _) if !who.undecided.is_empty() => format!("No camera of {all} is shown to meet the {what}."),
        ([one], []) => format!("{one} meets the {what}."),
        ([], [one]) => format!("{one} does not meet the {what}."),
        (names, []) => format!("All {all} cameras meet the {what}: {}.", names.join(", ")),
        ([], names) => format!("None of {all} cameras meets the {what}: {}.", names.join(", ")),
        ([one], _) => format!("1 of {all} cameras meets the {what}: {one}."),
        (some, _) => format!("{} of {all} cameras meet the {what}: {}.", some.len(), some.join(", ")),
    }
}

impl Say for Quotable {
    fn say(&self) -> String {
        let mut out = format!(
            "A camera meets this rule if, in every scene of the operating envelope ({}), it distinguishes {} from {}{} with a probability of {} \
             (statistical distance d of at least {})",
            ranges(&self.envelope, self.stop.as_ref(), self.units),
            either(&with_spectra(&self.envelope, &self.envelope.materials)),
            either(&with_spectra(&self.envelope, &self.envelope.alternatives)),
            self.alternatives_k
                .map_or_else(String::new, |kelvin| format!(" of {}", self.units.temperatures(kelvin))),
            demanded(self.required),
            significant(self.required, 4),
        );
        let hastiest = self.stop.and_then(|stop| stop.hastiest);
        if let Some((start_m, time_s)) = hastiest.and_then(|one| one.start_m.zip(one.time_s)) {
            out += &format!(
                ", it has read its frames {} s after the target comes into view at {}",
                significant(time_s, 3),
                self.units.lengths([significant(start_m, 3).parse().unwrap_or(start_m); 2])
            );
        }
        let crossing = self.stop.and_then(|stop| stop.crossing);
        if let (Some(speed), Some(crossing)) = (self.speed_m_s, crossing) {
            let way = match crossing.speed_m_s {
                0.0 => "which does not cross".to_owned(),
                speed => format!("which crosses at {}", self.units.speed(speed)),
            };
            let (offset, speed) = (self.units.length(crossing.offset_m), self.units.speed(speed));
            out += &format!(
                ", and the target, {way} and is met within {offset} of the camera's axis, is in its view in time and moves by less than a \
                 pixel while all bands are exposed, seen from a vehicle that drives forward at {speed}"
            );
        } else if let Some(speed) = self.speed_m_s {
            let speed = self.units.speed(speed);
            out += &format!(
                ", and no object at rest moves by a pixel while all bands are exposed, seen from a vehicle that drives \
                 forward at {speed}"
            );
        }
        if self.of_object {
            out += ", by all pixels that surely lie on the target together, whose emissivities are known exactly";
        }
        out += ".";
        if let Some(hardware) = self.hardware_m2_s {
            out += &format!(
                " Where its noise is spread over the bands as its photons are, this is t A_p/((1+gamma) F^2) >= {} m^2 s \
                 (exposure t, pixel area A_p, noise over photons gamma, f-number F; lossless optics).",
                significant(hardware, 3)
            );
        }
        out
    }
}

/// What a certificate states.
impl Say for Certified {
    fn say(&self) -> String {
        let percent = 100.0 * self.gap.unwrap_or(0.0).max(0.0);
        match self.kind {
            Proof::Equilibrium => {
                "proved: the operating envelope contains a scene in which the spectra do not differ".into()
            }
            Proof::DenseSearch => {
                "searched, not proved: the lowest value of a dense search with refinements".into()
            }
            Proof::BranchAndBound => format!("proved by branch and bound to {} %", fixed(percent, 2)),
            Proof::Bounded => {
                format!("searched; proved that no scene is more than {} % below", fixed(percent, 2))
            }
            Proof::Counterexample => "proved by this scene; a worse one was not looked for".into(),
        }
    }
}

/// What a clause demands.
impl Say for Definition {
    fn say(&self) -> String {
        match self {
            Self::Pixels { pixels, size_m } => format!(
                "{pixels} pixels across {} at the greatest distance, by geometry and motion alone",
                length(*size_m)
            ),
            Self::Temperature { coverage_factor, error_k, without_emissivity_errors } => {
                let unasked = match without_emissivity_errors {
                    true => " (errors of the emissivities are not included: no camera is judged to meet it)",
                    false => "",
                };
                format!(
                    "{coverage_factor} standard deviations of an unbiased estimate of the temperature, the emissivity known, \
                     within {error_k} K{unasked}"
                )
            }
            Self::Depth { object, error, share, distances, without_air, without_uncertainty } => {
                let error = match error {
                    Demand::Absolute(error_m) => length(*error_m),
                    Demand::Relative(part) => words::share(*part),
                };
                let from = match distances {
                    0 | 1 => String::new(),
                    looks => format!(", at {looks} distances from the nearest to the farthest"),
                };
                let mut out = format!(
                    "least depth error of the {object} within {error} in {} of its windows{from}",
                    words::share(*share)
                );
                if *without_air {
                    out += " (the air of the rule is not included: no camera is judged to meet it)";
                }
                if *without_uncertainty {
                    out += " (uncertain figures are not propagated: no camera that has any is judged to meet it)";
                }
                out
            }
        }
    }
}

/// That it does not tell the pair.
impl Say for IdealCamera {
    fn say(&self) -> String {
        let filled = match self.pixels {
            1.0 => "target filling the pixel".to_owned(),
            pixels => format!("target filling {} pixels", in_number(pixels)),
        };
        let distance = self.distance_m.map_or_else(String::new, |z| format!(" at {}", self.units.length(z)));
        format!(
            "no camera: a detector that counts every photon and adds no noise, f/{}, pixel {} (the largest of the \
             cameras), exposure of {} ({}), {filled}{distance}, does not distinguish the pair with a probability of {}",
            self.f_number,
            quantity(self.pixel_m, "m"),
            quantity(self.time_s, "s"),
            self.why.say(),
            demanded(self.required)
        )
    }
}

impl Say for LightTime {
    fn say(&self) -> String {
        match self {
            Self::Sharp { frames, speed_m_s, distance_m, units } => {
                let frames = if *frames > 1 { format!("{frames} frames, each ") } else { String::new() };
                let (speed, distance) = (units.speed(*speed_m_s), units.length(*distance_m));
                format!("{frames}as long as blur stays below a pixel at {speed} and {distance}")
            }
            Self::LongestIntegration => "the longest integration among the cameras".into(),
        }
    }
}

/// That it makes up more than the distance.
impl Say for EmissivityError {
    fn say(&self) -> String {
        let percent = 100.0 * self.0;
        format!(
            "errors of {percent} % in the emissivities, independent from band to band, exceed the distance, \
             whatever the camera"
        )
    }
}

/// Names, those of classes with how many spectra they rest on.
fn with_spectra(envelope: &EnvelopeResult, names: &[String]) -> Vec<String> {
    let named = |name: &String| match envelope.classes.iter().find(|class| class.name == *name) {
        Some(class) => format!("any of {} spectra of {name}{}", class.spectra, one_number(class)),
        None => name.clone(),
    };
    names.iter().map(named).collect()
}

/// `a, b or c`.
fn either(names: &[String]) -> String {
    if names.is_empty() { "nothing".into() } else { in_a_row(names, "or") }
}

/// The ranges of an envelope in a few words.
fn ranges(envelope: &EnvelopeResult, stop: Option<&StopResult>, units: Units) -> String {
    let mut parts = vec![format!("target {}", units.temperatures(envelope.temperature_k))];
    let objects = envelope.surroundings_k.iter().zip(&envelope.lighting);
    parts.extend(objects.map(|(kelvin, lighting)| {
        format!("surroundings {} lighting it by {}", units.temperatures(*kelvin), interval(*lighting, ""))
    }));
    // What follows from a stop has not the digits of what was written.
    let distance = |range: [f64; 2]| match stop {
        None => units.lengths(range),
        Some(_) => units.lengths(range.map(|z| significant(z, 3).parse().unwrap_or(z))),
    };
    parts.extend(envelope.distance_m.map(|range| format!("distance {}", distance(range))));
    parts.join(", ")
}

/// What a kind of clause demands, in words.
pub(crate) fn in_words_of_kind(kind: &str) -> &str {
    match kind {
        "tell-apart" => "distinguishes materials",
        "false-alarm" => "no false alarm",
        "contrast" => "detects an object",
        "resolution" => "pixels on the target",
        "temperature-error" => "measures a temperature",
        "depth-error" => "measures a distance",
        other => other,
    }
}

/// Below the margins by reforms.
pub(crate) const LEAST: &str = "The least margin of all clauses and scenes.";

/// Below the margins over all clauses.
pub(crate) const ALL_CLAUSES: &str =
    "Least over all clauses. Filled symbols meet the rule; below a name are the clauses that it fails.";

/// Below the margins of a rule that only tells materials apart.
pub(crate) fn one_clause(distance: f64) -> String {
    format!(
        "Least over the operating envelope; d = {} is required. Filled symbols meet the rule; a camera may have enough signal and \
         still fail by its image.",
        significant(distance, 3)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A yes that rests on a search alone is not read as one that is proved.
    #[test]
    fn a_yes_that_is_not_proved_says_so() {
        let proved = WhoMeets {
            meet: vec![("a".into(), Vec::new()), ("b".into(), Vec::new())],
            ..WhoMeets::default()
        };
        assert_eq!(proved.say(), "All 2 cameras meet the rule: a, b.");
        let searched = WhoMeets { unproved: vec!["b".into()], ..proved };
        let said =
            "All 2 cameras meet the rule: a, b. Not proved of b: no scene below the requirement was found.";
        assert_eq!(searched.say(), said);
    }
}
