//! The verdict on a camera in a sentence.

use super::{Answer, Finding};
use crate::Shortfall;
use crate::words::{demanded, reliability};
use hadar::fisher::Nuisance;
use hadar::words::significant;
use hadar_scenario::DistanceKind;
use serde::{Serialize, Serializer};
use std::fmt::{self, Display, Formatter};

impl Display for Finding {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match &self.classes {
            None => self.answered(f)?,
            Some(classes) => {
                let of_all = Self {
                    target: classes.target.name.clone(),
                    alternative: self.alternative.is_some().then(|| classes.alternative.name.clone()),
                    ..self.clone()
                };
                match &classes.mixtures {
                    Some(found)
                        if classes.statistical
                            && found.distance_lower < self.required
                            && found.distance >= self.required =>
                    {
                        write!(
                            f,
                            "No: that {} tells {} from {} with {} reliability is so for the worst mixture found (d = {}), but no more than d = {} is \
                         proved of all mixtures.",
                            self.camera,
                            of_all.target,
                            classes.alternative.name,
                            demanded(self.required),
                            significant(found.distance, 3),
                            significant(found.distance_lower, 3)
                        )?
                    }
                    _ => of_all.answered(f)?,
                }
                write!(f, " {classes}")?;
            }
        }
        match self.placeholders {
            Some([one, other]) => write!(
                f,
                " Both are entered as one number ({one} and {other}): that says nothing of real surfaces."
            ),
            None => Ok(()),
        }
    }
}

impl Finding {
    fn yes(&self) -> String {
        self.provided.map_or_else(|| "Yes".into(), |proviso| format!("Yes, if {proviso}"))
    }

    fn answered(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { camera, target, .. } = self;
        let other = self.alternative.as_deref().unwrap_or("every alternative");
        let wanted = demanded(self.required);
        if let Some(reading) = no_limit(self.by) {
            return self.by_local(f, reading, other, &wanted);
        }
        match &self.answer {
            Answer::NothingDiffers => {
                write!(f, "No camera can tell {target} from {other} here: nothing in the spectrum differs.")
            }
            Answer::UnknownsExplain => write!(
                f,
                "No camera can tell {target} from {other} here: the unknowns explain every difference in the spectrum."
            ),
            Answer::TooFewBands { bands, unknowns } => {
                let (yes, colon) = if camera.is_empty() {
                    (format!("No camera can tell {target} from {other} here"), String::new())
                } else {
                    ("No".into(), format!(": {camera} cannot tell {target} from {other}"))
                };
                let (unknown, are) = together(unknowns);
                let many = match bands {
                    1 => "one band".into(),
                    bands => format!("{bands} bands"),
                };
                write!(f, "{yes}: {many} cannot tell materials while {unknown} {are} unknown{colon}.")
            }
            Answer::Takes { photons, .. } => write!(
                f,
                "Telling {target} from {other} with {wanted} reliability takes at least {} photons.",
                significant(*photons, 3)
            ),
            Answer::Judged { enough, spoiled, reached, .. } => {
                let (yes, can) = match (enough, spoiled.is_empty()) {
                    (true, true) => (self.yes(), "can"),
                    (true, false) => ("No".into(), "could"),
                    (false, _) => ("No".into(), "cannot"),
                };
                write!(f, "{yes}: {camera} {can} tell {target} from {other} with {wanted} reliability")?;
                match reached {
                    _ if *enough && !spoiled.is_empty() => write!(f, ", but {}.", in_words(spoiled)),
                    Some(reached) => write!(f, "; it reaches {} at most.", reliability(*reached)),
                    None => f.write_str("."),
                }
            }
        }
    }
}

/// What a reading that is no limit is called; nothing of the limit.
#[must_use]
pub const fn no_limit(by: DistanceKind) -> Option<&'static str> {
    match by {
        DistanceKind::Nearest => None,
        DistanceKind::Local => Some("the paper's local distance, which is no limit and can err either way"),
        DistanceKind::LocalUnknownGain => Some(
            "the paper's local distance with unknown gain (S29), which is no limit and can err either way",
        ),
    }
}

impl Finding {
    /// By a reading that is no limit: what it says, what it is, and what the limit is. It rules nothing out.
    fn by_local(&self, f: &mut Formatter<'_>, reading: &str, other: &str, wanted: &str) -> fmt::Result {
        let Self { camera, target, .. } = self;
        match &self.answer {
            Answer::NothingDiffers => write!(
                f,
                "{target} is not told from {other} here by {reading}: to first order nothing in the spectrum differs."
            ),
            Answer::UnknownsExplain => write!(
                f,
                "{target} is not told from {other} here by {reading}: to first order the unknowns explain every \
                 difference in the spectrum."
            ),
            Answer::TooFewBands { bands, unknowns } => {
                let (unknown, are) = together(unknowns);
                write!(
                    f,
                    "No: {target} is not told from {other} here by {reading}: there are {bands} bands, and {unknown} {are} \
                     unknown."
                )
            }
            Answer::Takes { photons, limit } => {
                let photons = significant(*photons, 3);
                write!(
                    f,
                    "Telling {target} from {other} with {wanted} reliability takes {photons} photons by {reading}; by the \
                     nearest, the limit, "
                )?;
                match limit {
                    Some(limit) => write!(f, "{}.", significant(*limit, 3)),
                    None => f.write_str("no number suffices."),
                }
            }
            Answer::Judged { enough, spoiled, reached, limit } => {
                let (yes, tells) = match (enough, spoiled.is_empty()) {
                    (true, true) => (self.yes(), "tells"),
                    (true, false) => ("No".into(), "would tell"),
                    (false, _) => ("No".into(), "does not tell"),
                };
                write!(f, "{yes}: {camera} {tells} {target} from {other} with {wanted} reliability")?;
                if *enough && !spoiled.is_empty() {
                    write!(f, ", but {}", in_words(spoiled))?;
                }
                write!(f, ", by {reading}")?;
                match (reached, limit) {
                    (Some(reached), Some(limit)) => {
                        let [reached, limit] = [reached, limit].map(|d| reliability(*d));
                        write!(f, ": it reads {reached}; the limit, by the nearest distance, is {limit}.")
                    }
                    _ => f.write_str("."),
                }
            }
        }
    }
}

/// Unknowns in a sentence, and the verb that goes with them.
fn together(unknowns: &[Nuisance]) -> (String, &'static str) {
    let names: Vec<&str> = unknowns.iter().map(|nuisance| nuisance.name()).collect();
    match names.as_slice() {
        [] => ("nothing".into(), "is"),
        [one] => ((*one).into(), "is"),
        [most @ .., last] => (format!("{} and {last}", most.join(", ")), "are"),
    }
}

/// What is wrong with an image.
fn in_words(spoiled: &[Shortfall]) -> String {
    let words = spoiled.iter().map(|by| match by {
        Shortfall::MotionBlur => "the target moves by a pixel or more while all bands are exposed",
        Shortfall::MotionUnknown => {
            "whether the target moves by a pixel while all bands are exposed is not known without target.distance"
        }
        _ => "a reading does not fit into the full well",
    });
    words.collect::<Vec<_>>().join(", and ")
}

impl Serialize for Finding {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
