//! What comes of a rule in sentences.

use super::results::{
    Certified, EmissivityError, EnvelopeResult, IdealCamera, LightTime, Proof, Quotable, StopResult, WhoMeets,
};
use crate::proviso::Proviso;
use crate::words::demanded;
use hadar::words::{quantity, significant};
use hadar_scenario::{Units, interval};
use serde::ser::{Serialize, SerializeStruct, Serializer};
use std::fmt::{self, Display, Formatter};

impl Display for WhoMeets {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let all = self.meet.len() + self.undecided.len() + self.fail.len();
        let what = if self.clause { "clause" } else { "rule" };
        if let Some(idle) = &self.idle {
            write!(f, "Nothing is demanded: {idle}. As if it did: ")?;
        }
        let meet: Vec<String> = self
            .meet
            .iter()
            .map(|(name, proviso)| match proviso {
                None => name.clone(),
                Some(Proviso { frames, .. }) => format!("{name} (if its {frames} frames can be registered)"),
            })
            .collect();
        let others: Vec<String> =
            self.undecided.iter().map(|(name, _)| name.clone()).chain(self.fail.iter().cloned()).collect();
        match (meet.as_slice(), others.as_slice()) {
            ([], [one]) if self.fail.is_empty() => write!(f, "Whether {one} meets the {what} is undecided."),
            ([], _) if !self.undecided.is_empty() => {
                write!(f, "None of {all} cameras surely meets the {what}.")
            }
            ([one], []) => write!(f, "{one} meets the {what}."),
            ([], [one]) => write!(f, "{one} does not meet the {what}."),
            (names, []) => write!(f, "All {all} cameras meet the {what}: {}.", names.join(", ")),
            ([], names) => write!(f, "None of {all} cameras meets the {what}: {}.", names.join(", ")),
            ([one], _) => write!(f, "1 of {all} cameras meets the {what}: {one}."),
            (some, _) => write!(f, "{} of {all} cameras meet the {what}: {}.", some.len(), some.join(", ")),
        }?;
        let named = all > 1;
        for (name, interval) in &self.undecided {
            let of = if named { format!(" of {name}") } else { String::new() };
            match interval {
                Some([low, high]) if *low < 1.0 && *high >= 1.0 => {
                    let ends = [low, high].map(|end| significant(*end, 3));
                    let said = if named { "Undecided" } else { "It" };
                    let verb = if named { ":" } else { " is so because" };
                    write!(f, " {said}{of}{verb} the margin lies between {} and {}.", ends[0], ends[1])?;
                }
                _ if named => write!(f, " Undecided{of}.")?,
                _ => {}
            }
        }
        if !self.unproved.is_empty() {
            write!(
                f,
                " Not proved of {}: no scene below the requirement was found.",
                self.unproved.join(", ")
            )?;
        }
        self.placeholders.iter().try_for_each(|(target, alternative, [one, other])| {
            write!(
                f,
                " It hangs on {target} against {alternative}, which are entered as one number each ({one} and {other}): that \
                 says nothing of real surfaces."
            )
        })
    }
}

impl EnvelopeResult {
    /// Names, those of classes with how many spectra they rest on.
    fn with_spectra(&self, names: &[String]) -> Vec<String> {
        let named = |name: &String| match self.classes.iter().find(|class| class.name == *name) {
            Some(class) => format!("any of {} spectra of {name}", class.spectra),
            None => name.clone(),
        };
        names.iter().map(named).collect()
    }
}

impl Display for Quotable {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "A camera meets this rule if, in every scene of the envelope ({}), it tells {} from {} with {} reliability \
             (statistical distance d of at least {})",
            in_words(&self.envelope, self.stop.as_ref(), self.units),
            either(&self.envelope.with_spectra(&self.envelope.materials)),
            either(&self.envelope.with_spectra(&self.envelope.alternatives)),
            demanded(self.required),
            significant(self.required, 4),
        )?;
        if let Some((start_m, time_s)) =
            self.stop.and_then(|stop| stop.hastiest).and_then(|one| one.start_m.zip(one.time_s))
        {
            write!(
                f,
                ", it has read its frames {} s after the target comes into view at {}",
                significant(time_s, 3),
                self.units.lengths([significant(start_m, 3).parse().unwrap_or(start_m); 2])
            )?;
        }
        if let Some(speed) = self.speed_m_s {
            let speed = self.units.speed(speed);
            write!(
                f,
                ", and nothing that stands moves by a pixel while all bands are exposed, seen from a vehicle that drives \
                 forward at {speed}"
            )?;
        }
        f.write_str(".")?;
        if let Some(hardware) = self.hardware_m2_s {
            write!(
                f,
                " Where its noise is spread over the bands as its photons are, this is t A_p/((1+gamma) F^2) >= {} m^2 s \
                 (exposure t, pixel area A_p, noise over photons gamma, f-number F; lossless optics).",
                significant(hardware, 3)
            )?;
        }
        Ok(())
    }
}

impl Display for Certified {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let percent = 100.0 * self.gap.unwrap_or(0.0).max(0.0);
        match self.kind {
            Proof::Equilibrium => f.write_str("proved: the envelope holds a scene in which nothing differs"),
            Proof::DenseSearch => {
                f.write_str("searched, not proved: the best of a dense search and its refinements")
            }
            Proof::BranchAndBound => write!(f, "proved by branch and bound to {percent:.2} %"),
            Proof::Bounded => {
                write!(f, "searched; proved that no scene is more than {percent:.2} % below")
            }
            Proof::Counterexample => f.write_str("proved by this scene; a worse one was not looked for"),
        }
    }
}

impl Display for IdealCamera {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let distance = self.distance_m.map_or_else(String::new, |z| format!(" at {}", self.units.length(z)));
        write!(
            f,
            "no camera: a detector that counts every photon and adds no noise, f/{}, pixel {} (the largest of the \
             cameras), light of {} ({}), target filling the pixel{distance}, does not tell the pair with {} reliability",
            self.f_number,
            quantity(self.pixel_m, "m"),
            quantity(self.time_s, "s"),
            self.why,
            demanded(self.required)
        )
    }
}

impl Display for LightTime {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sharp { frames, speed_m_s, distance_m, units } => {
                if *frames > 1 {
                    write!(f, "{frames} frames, each ")?;
                }
                let (speed, distance) = (units.speed(*speed_m_s), units.length(*distance_m));
                write!(f, "as long as less than a pixel of blur allows at {speed} and {distance}")
            }
            Self::LongestIntegration => f.write_str("the longest integration among the cameras"),
        }
    }
}

impl Display for EmissivityError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let percent = 100.0 * self.0;
        write!(
            f,
            "errors of {percent} % in the emissivities, independent from band to band, make up more than the distance, \
             whatever the camera"
        )
    }
}

/// `a, b or c`.
fn either(names: &[String]) -> String {
    match names {
        [] => "nothing".into(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}

/// The ranges of an envelope in a few words.
fn in_words(envelope: &EnvelopeResult, stop: Option<&StopResult>, units: Units) -> String {
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

impl Serialize for Certified {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut object = serializer.serialize_struct("Certified", 3)?;
        object.serialize_field("kind", &self.kind)?;
        object.serialize_field("statement", &self.to_string())?;
        object.serialize_field("gap", &self.gap)?;
        object.end()
    }
}

impl Serialize for WhoMeets {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl Serialize for Quotable {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl Serialize for IdealCamera {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl Serialize for EmissivityError {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A yes that rests on a search alone is not read as one that is proved.
    #[test]
    fn a_yes_that_is_not_proved_says_so() {
        let proved = WhoMeets { meet: vec![("a".into(), None), ("b".into(), None)], ..WhoMeets::default() };
        assert_eq!(proved.to_string(), "All 2 cameras meet the rule: a, b.");
        let searched = WhoMeets { unproved: vec!["b".into()], ..proved };
        let said =
            "All 2 cameras meet the rule: a, b. Not proved of b: no scene below the requirement was found.";
        assert_eq!(searched.to_string(), said);
    }
}
