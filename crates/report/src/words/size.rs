//! The verdict on a camera in a sentence.

pub(crate) mod captions;
pub mod rows;
pub(crate) mod text;

pub use text::{check, text};

use super::probability::{demanded, reliability};
use super::shortfall::clauses;
use super::text::numbers::{in_a_row, in_number};
use super::{Say, conditions};
use hadar::fisher::Nuisance;
use hadar::words::significant;
use hadar_scenario::DistanceKind;
use hadar_study::{Answer, Finding, MixtureAnswer};

/// Share by which two numbers of photons are one in the digits shown.
pub(crate) const ROUNDED: f64 = 4e-3;

impl Say for Finding {
    fn say(&self) -> String {
        let mut out = match &self.classes {
            None => answered(self),
            Some(classes) => {
                let of_all = Self {
                    target: classes.target.name.clone(),
                    alternative: self.alternative.is_some().then(|| classes.alternative.name.clone()),
                    ..self.clone()
                };
                let verdict = match &classes.mixtures {
                    Some(found)
                        if classes.statistical
                            && found.distance_lower < self.required
                            && found.distance >= self.required =>
                    {
                        not_proved_of_mixtures(&of_all, &classes.alternative.name, found)
                    }
                    _ => answered(&of_all),
                };
                format!("{verdict} {}", classes.say())
            }
        };
        if let Some([one, other]) = self.placeholders {
            out += &format!(
                " Both are entered as one number ({one} and {other}): that says nothing of real surfaces."
            );
        }
        out
    }
}

/// Mixtures of which more is found than is proved.
fn not_proved_of_mixtures(finding: &Finding, alternative: &str, found: &MixtureAnswer) -> String {
    format!(
        "No: that {} distinguishes {} from {alternative} with a probability of {} holds for the worst mixture found (d = {}), but only d = {} is \
         proved of all mixtures.",
        finding.camera,
        finding.target,
        demanded(finding.required),
        significant(found.distance, 3),
        significant(found.distance_lower, 3)
    )
}

/// A 'yes', with what it is subject to.
fn yes(finding: &Finding) -> String {
    conditions::yes(&finding.conditions).replacen('y', "Y", 1)
}

/// Of a pixel, where the target has more: what all of them together would tell, if nothing is common to their noise.
fn of_pixels(finding: &Finding, reached: f64) -> String {
    finding.pixels.map_or_else(String::new, |pixels| {
        format!(
            "; for all {} pixels on it together {}, if they are alike and share no noise",
            significant(pixels, 3),
            reliability(reached * pixels.sqrt())
        )
    })
}

/// Of an object: that all of its pixels decide together.
fn by_pixels(finding: &Finding) -> String {
    match finding.pixels.filter(|_| finding.of_object) {
        Some(1.0) => " by the one pixel on it".into(),
        Some(pixels) => format!(" by the {} pixels on it together", in_number(pixels)),
        None => String::new(),
    }
}

/// What was found of one pair of spectra.
fn answered(finding: &Finding) -> String {
    let Finding { camera, target, .. } = finding;
    let other = finding.alternative.as_deref().unwrap_or("every alternative");
    let wanted = demanded(finding.required);
    if let Some(reading) = no_limit(finding.by) {
        return by_local(finding, reading, other, &wanted);
    }
    match &finding.answer {
        Answer::NothingDiffers => {
            format!("No camera can distinguish {target} from {other} here: nothing in the spectrum differs.")
        }
        Answer::UnknownsExplain => format!(
            "No camera can distinguish {target} from {other} here: the unknowns explain every difference in the spectrum."
        ),
        Answer::TooFewBands { bands, unknowns } => {
            let (yes, colon) = if camera.is_empty() {
                (format!("No camera can distinguish {target} from {other} here"), String::new())
            } else {
                ("No".into(), format!(": {camera} cannot distinguish {target} from {other}"))
            };
            let (unknown, are) = together(unknowns);
            let many = match bands {
                1 => "one band".into(),
                bands => format!("{bands} bands"),
            };
            format!("{yes}: {many} cannot distinguish materials while {unknown} {are} unknown{colon}.")
        }
        Answer::Takes { photons, enough, .. } => {
            let more = match enough {
                Some(enough) if *enough <= *photons * (1.0 + ROUNDED) => String::new(),
                Some(enough) => format!("; the proof allows for up to {}", significant(*enough, 3)),
                None => "; no number is proved to suffice".into(),
            };
            format!(
                "Distinguishing {target} from {other} with a probability of {wanted} takes at least {} photons{more}.",
                significant(*photons, 3)
            )
        }
        Answer::Judged { undecided: true, reached: Some(reached), proved: Some(proved), .. } => {
            let [proved, reached] = [proved, reached].map(|d| reliability(*d));
            format!(
                "Undecided: whether {camera} can distinguish {target} from {other} with a probability of {wanted}{}; {proved} is proved, and no state \
                 was found in which the probability is below {reached}.",
                by_pixels(finding)
            )
        }
        Answer::Judged { enough, spoiled, reached, few_counts, .. } => {
            let (yes, can) = match (enough, spoiled.is_empty()) {
                (true, true) => (yes(finding), "can"),
                (true, false) => ("No".into(), "could"),
                (false, _) => ("No".into(), "cannot"),
            };
            let end = match reached {
                _ if *enough && !spoiled.is_empty() => format!(", but {}.", clauses(spoiled)),
                Some(reached) => {
                    let (of, all) = match finding.pixels {
                        Some(_) if !finding.of_object => (" for one pixel", of_pixels(finding, *reached)),
                        _ => ("", String::new()),
                    };
                    let few = if *few_counts { ", by the law of small counts" } else { "" };
                    format!("; upper limit{of} {}{few}{all}.", reliability(*reached))
                }
                None => ".".into(),
            };
            let by = by_pixels(finding);
            format!(
                "{yes}: {camera} {can} distinguish {target} from {other} with a probability of {wanted}{by}{end}"
            )
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

/// By a reading that is no limit: what it says, what it is, and what the limit is. It rules nothing out.
fn by_local(finding: &Finding, reading: &str, other: &str, wanted: &str) -> String {
    let Finding { camera, target, .. } = finding;
    match &finding.answer {
        Answer::NothingDiffers => format!(
            "{target} is not distinguished from {other} here by {reading}: to first order nothing in the spectrum differs."
        ),
        Answer::UnknownsExplain => format!(
            "{target} is not distinguished from {other} here by {reading}: to first order the unknowns explain every \
             difference in the spectrum."
        ),
        Answer::TooFewBands { bands, unknowns } => {
            let (unknown, are) = together(unknowns);
            format!(
                "No: {target} is not distinguished from {other} here by {reading}: there are {bands} bands, and {unknown} {are} \
                 unknown."
            )
        }
        Answer::Takes { photons, limit, .. } => {
            let photons = significant(*photons, 3);
            let limit =
                limit.map_or_else(|| "no number of photons suffices".into(), |limit| significant(limit, 3));
            format!(
                "Distinguishing {target} from {other} with a probability of {wanted} takes {photons} photons by {reading}; by the \
                 nearest distance (the limit): {limit}."
            )
        }
        Answer::Judged { enough, spoiled, reached, limit, .. } => {
            let (yes, distinguishes) = match (enough, spoiled.is_empty()) {
                (true, true) => (yes(finding), "distinguishes"),
                (true, false) => ("No".into(), "would distinguish"),
                (false, _) => ("No".into(), "does not distinguish"),
            };
            let but = match *enough && !spoiled.is_empty() {
                true => format!(", but {}", clauses(spoiled)),
                false => String::new(),
            };
            let end = match (reached, limit) {
                (Some(reached), Some(limit)) => {
                    let [reached, limit] = [reached, limit].map(|d| reliability(*d));
                    format!(": it gives {reached}; the limit, by the nearest distance, is {limit}.")
                }
                _ => ".".into(),
            };
            format!(
                "{yes}: {camera} {distinguishes} {target} from {other} with a probability of {wanted}{but}, by {reading}{end}"
            )
        }
    }
}

/// Unknowns in a sentence, and the verb that goes with them.
fn together(unknowns: &[Nuisance]) -> (String, &'static str) {
    let names: Vec<&str> = unknowns.iter().map(|nuisance| nuisance.name()).collect();
    match names.len() {
        0 => ("nothing".into(), "is"),
        count => (in_a_row(&names, "and"), if count == 1 { "is" } else { "are" }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hadar_study::{Condition, Proviso, Shortfall};

    fn finding(answer: Answer) -> Finding {
        Finding {
            camera: "ours".into(),
            target: "skin".into(),
            alternative: Some("aluminium".into()),
            required: 1.0,
            by: DistanceKind::Nearest,
            answer,
            placeholders: None,
            classes: None,
            conditions: Vec::new(),
            pixels: None,
            of_object: false,
        }
    }

    fn judged(enough: bool, spoiled: Vec<Shortfall>) -> Finding {
        finding(Answer::Judged {
            enough,
            undecided: false,
            spoiled,
            reached: Some(2.0),
            proved: Some(2.0),
            few_counts: false,
            limit: Some(2.0),
        })
    }

    #[test]
    fn a_yes_says_what_it_is_subject_to() {
        let yes = judged(true, Vec::new());
        assert_eq!(
            yes.say(),
            "Yes: ours can distinguish skin from aluminium with a probability of 84.1 %; upper limit 97.7 %."
        );
        let conditions = vec![Condition::RegisteredFrames(Proviso { frames: 4, time_s: 0.062, way_m: 0.83 })];
        let said = Finding { conditions, placeholders: Some([0.95, 0.9]), ..yes }.say();
        assert!(
            said.starts_with("Yes, if its 4 frames can be registered (62.0 ms, 83 cm of travel): "),
            "{said}"
        );
        let end = "Both are entered as one number (0.95 and 0.9): that says nothing of real surfaces.";
        assert!(said.ends_with(end), "{said}");
    }

    /// What is proved does not reach it, what was found does: neither yes nor no.
    #[test]
    fn what_is_not_proved_is_undecided() {
        let found = Answer::Judged {
            enough: false,
            undecided: true,
            spoiled: Vec::new(),
            reached: Some(1.1),
            proved: Some(0.8),
            few_counts: false,
            limit: Some(1.1),
        };
        let said = finding(found).say();
        assert!(said.starts_with("Undecided: whether ours can distinguish skin from aluminium"), "{said}");
        assert!(said.contains("78.8 % is proved") && said.contains("below 86.4 %"), "{said}");
    }

    /// No shortfall is called by another's name.
    #[test]
    fn a_no_names_what_spoils_the_image() {
        use Shortfall as S;
        let all = [
            (S::Distance, "distance is below"),
            (S::Pixels, "too few pixels"),
            (S::TemperatureError, "temperature is not known"),
            (S::DepthError, "distance is not known"),
            (S::DecisionTime, "read after"),
            (S::MotionBlur, "moves by a pixel or more"),
            (S::MotionUnknown, "not known without target.distance"),
            (S::FullWell, "well capacity"),
            (S::FrameRate, "longer than a frame"),
            (S::Diffraction, "the lens blurs"),
            (S::Impractical, "no camera is built"),
            (S::LowestNoise, "read noise"),
        ];
        for (by, part) in all {
            let said = judged(true, vec![by]).say();
            let start = "No: ours could distinguish skin from aluminium with a probability of 84.1 %, but ";
            assert!(said.starts_with(start) && said.contains(part), "{said}");
            assert_eq!(all.iter().filter(|(_, part)| said.contains(part)).count(), 1, "{said}");
        }
    }

    #[test]
    fn one_band_is_not_enough_while_something_is_unknown() {
        let unknowns = vec![Nuisance::Temperature, Nuisance::Lighting];
        let said = finding(Answer::TooFewBands { bands: 1, unknowns }).say();
        let start = "No: one band cannot distinguish materials while temperature and lighting are unknown: ours cannot";
        assert!(said.starts_with(start), "{said}");
    }
}
