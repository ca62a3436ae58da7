//! What the members of classes say together; how many spectra a verdict on classes rests on, and which two decide.

use super::Say;
use super::text::significant;
use hadar::words::fixed;
use hadar::words::share;
use hadar_study::{ClassAnswer, ClassSide};
use std::fmt::Write as _;

/// Members of a mixture that are named.
const NAMED: usize = 3;

impl Say for ClassAnswer {
    fn say(&self) -> String {
        let [own, other] = &self.worst;
        let mut out = format!("It rests on {} and {}", rests(&self.target), rests(&self.alternative));
        if self.pairs > 1 {
            out += &format!("; the hardest of {} pairs is {own} against {other}", self.pairs);
        }
        out += if self.mixtures.is_some() { ", and mixtures are counted in." } else { "." };
        out
    }
}

/// The spectra of a class.
fn rests(side: &ClassSide) -> String {
    match (side.is_class, side.mean) {
        (false, _) => side.name.clone(),
        (true, true) => format!("the mean of {} spectra of {}", side.spectra, side.name),
        (true, false) if side.spectra == 1 => format!("1 spectrum of {}", side.name) + &one_number(side),
        (true, false) => format!("{} spectra of {}", side.spectra, side.name) + &one_number(side),
    }
}

/// Members of a class that have no spectrum, as the rest of a phrase on the class.
pub(super) fn one_number(side: &ClassSide) -> String {
    match (side.one_number.len(), side.members.len()) {
        (0, _) => String::new(),
        (1, 1) => " (entered as one number)".to_owned(),
        (entered, _) => format!(" ({entered} entered as one number)"),
    }
}

/// Class by class what all pairs of members say.
pub(crate) fn text(answers: &[ClassAnswer]) -> String {
    let mut out = String::new();
    for answer in answers {
        let _ = writeln!(
            out,
            "Classes: {} against {}, {}{}",
            with_spectra(&answer.target),
            with_spectra(&answer.alternative),
            match answer.pairs {
                1 => "one pair of members".to_owned(),
                pairs => format!("{pairs} pairs of members"),
            },
            match answer.searched {
                searched if searched == answer.pairs => String::new(),
                searched => format!(" ({searched} searched, the others are proved to decide nothing)"),
            }
        );
        let mut line = |label: &str, text: String| {
            let _ = writeln!(out, "  {label:<34} {text}");
        };
        let unit = if answer.statistical { "" } else { " per sqrt(photon)" };
        let distance = |d: f64| format!("d = {}{unit}", significant(d, 3));
        let [own, other] = &answer.worst;
        line("hardest pair", format!("{own} against {other}, {}", distance(answer.distance)));
        let sides = [&answer.target, &answer.alternative];
        let entered: Vec<&str> = sides.iter().flat_map(|side| &side.one_number).map(String::as_str).collect();
        if !entered.is_empty() && sides.iter().any(|side| side.is_class) {
            line("entered as one number", entered.join(", "));
        }
        if let Some(told) = answer.share_of_pairs_told {
            line(
                if answer.mixtures.is_some() {
                    "unmixed pairs that it tells"
                } else {
                    "pairs that the camera tells"
                },
                format!("{} by the members' weights", share(told)),
            );
        }
        if let Some([low, high]) = answer.mean_detection_probability {
            let words = match high - low {
                _ if low > 0.9995 => "above 0.9995".to_owned(),
                open if open < 1e-3 => format!("{low:.3}"),
                _ => format!("{low:.3} to {high:.3}"),
            };
            line("detection probability, mean", words);
        }
        for left in &answer.leave_one_out {
            let words = left.distance.map_or_else(|| "nothing is left".into(), distance);
            line(&format!("without {}", left.member), words);
        }
        let chance = |side: &ClassSide| {
            let chance = ClassAnswer::chance_one_more_is_nearer(side)?;
            Some(format!("1 in {} of {}", fixed(1.0 / chance, 0), side.name))
        };
        let chance = |side: &ClassSide| chance(side).filter(|_| answer.mixtures.is_none());
        let chances: Vec<String> =
            [&answer.target, &answer.alternative].into_iter().filter_map(chance).collect();
        if !chances.is_empty() {
            let words =
                format!("is harder than all with a chance of at most {}, if drawn alike", chances.join(", "));
            line("one more spectrum", words);
        }
        if let Some(found) = &answer.mixtures {
            let parts = |parts: &[(String, f64)]| {
                let named = parts.iter().take(NAMED).map(|(name, part)| format!("{} {name}", share(*part)));
                let more = if parts.len() > NAMED { " and others" } else { "" };
                named.collect::<Vec<_>>().join(", ") + more
            };
            let (low, high) = (significant(found.distance_lower, 3), distance(found.distance));
            line(
                "worst mixture found",
                format!("{high}: {} against {}", parts(&found.target), parts(&found.alternative)),
            );
            line("all mixtures, each part lit anyhow", format!("at least {low}{unit}, proved"));
        }
        out.push('\n');
    }
    out
}

fn with_spectra(side: &ClassSide) -> String {
    match (side.is_class, side.mean) {
        (false, _) => side.name.clone(),
        (true, false) if side.members.len() == 1 => format!("{} (1 spectrum)", side.name),
        (true, false) => format!("{} ({} spectra)", side.name, side.members.len()),
        (true, true) => format!("{} (mean of {} spectra)", side.name, side.spectra),
    }
}

/// Below the picture of all pairs.
pub(crate) const LIGHTEST: &str =
    "The lightest are proved to have at least the distance that is drawn; they decide nothing.";
