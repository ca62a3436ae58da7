//! What was measured of a computation, and which of its methods are on the Pareto front.

use std::borrow::Cow;

/// One method at one setting of its knob.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Measured {
    /// Name of the method of computation.
    pub method: Cow<'static, str>,
    /// What it answers, where a chart holds several questions: a method competes with those of the same question.
    pub question: Cow<'static, str>,
    /// Its knob, as [`Chart::effort`] says; none where it has none.
    pub effort: Option<f64>,
    /// Time of one result, s; one thread.
    pub seconds: f64,
    /// True error, as [`Chart::error`] says.
    pub error: f64,
    /// The error the method itself reports, if it does.
    pub reported: Option<f64>,
    /// Whether it is what the crate does where nothing else is asked for.
    pub is_default: bool,
    /// Whether no other is both faster and more accurate.
    pub on_front: bool,
}

/// All methods of a computation.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Chart {
    /// Its name, that of its files.
    pub name: &'static str,
    /// The quantity that is computed, in words.
    pub title: &'static str,
    /// What the time is of, e.g. "one pair".
    pub timed: &'static str,
    /// Name of the knob, with its unit.
    pub effort: &'static str,
    /// How the error is measured, in words.
    pub error: &'static str,
    /// What the true value is taken from.
    pub reference: &'static str,
    /// The measurements, method after method.
    pub measured: Vec<Measured>,
    /// Why the default is not on the front, where it is not, and what else is to be known.
    pub remark: String,
}

/// Errors below this are rounding of the result itself: half a unit in the last place.
pub const ROUNDED: f64 = 0.5 * f64::EPSILON;
/// Times this much apart are the same.
const SAME_TIME: f64 = 1.15;

impl Measured {
    /// A method at one setting; NaN where it has none.
    pub(super) fn new(method: impl Into<Cow<'static, str>>, effort: f64, seconds: f64, error: f64) -> Self {
        Self {
            method: method.into(),
            question: Cow::Borrowed(""),
            effort: effort.is_finite().then_some(effort),
            seconds,
            error,
            reported: None,
            is_default: false,
            on_front: false,
        }
    }

    /// The crate's own choice, if `is_default`.
    pub(super) fn default_if(self, is_default: bool) -> Self {
        Self { is_default, ..self }
    }

    /// As an answer to one of several questions.
    pub(super) fn answering(self, question: impl Into<Cow<'static, str>>) -> Self {
        Self { question: question.into(), ..self }
    }

    /// With the error the method reports of itself.
    pub(super) fn reporting(self, reported: f64) -> Self {
        Self { reported: Some(reported), ..self }
    }

    /// Whether this is better in one respect and no worse in the other: clearly faster, since times are only as good as
    /// the machine is quiet, or as fast and at most half as wrong.
    fn beats(&self, other: &Self) -> bool {
        if self.question != other.question {
            return false;
        }
        let (own, others) = (self.error.max(ROUNDED), other.error.max(ROUNDED));
        let faster = self.seconds * SAME_TIME < other.seconds && own <= others;
        let truer = self.seconds <= other.seconds && own <= 0.5 * others;
        faster || truer
    }
}

impl Chart {
    /// Marks what is on the Pareto front.
    ///
    /// A point is off it if another is faster by more than 15 % and no less accurate, or no slower and at most half as
    /// wrong; errors below half a unit in the last place count as that.
    pub(super) fn mark_front(&mut self) {
        let on_front: Vec<bool> =
            self.measured.iter().map(|one| !self.measured.iter().any(|other| other.beats(one))).collect();
        for (measured, on_front) in self.measured.iter_mut().zip(on_front) {
            measured.on_front = on_front;
        }
    }

    /// The default's measurements.
    pub fn defaults(&self) -> impl Iterator<Item = &Measured> {
        self.measured.iter().filter(|measured| measured.is_default)
    }

    /// The questions, in order.
    #[must_use]
    pub fn questions(&self) -> Vec<&str> {
        distinct(self.measured.iter().map(|measured| measured.question.as_ref()))
    }

    /// Names of the methods, in order.
    #[must_use]
    pub fn methods(&self) -> Vec<&str> {
        distinct(self.measured.iter().map(|measured| measured.method.as_ref()))
    }
}

fn distinct<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut distinct = Vec::new();
    for name in names {
        if !distinct.contains(&name) {
            distinct.push(name);
        }
    }
    distinct
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(points: &[(f64, f64)]) -> Chart {
        let measured = points.iter().map(|&(time, error)| Measured::new("m", 1.0, time, error)).collect();
        let mut chart = Chart {
            name: "test",
            title: "",
            timed: "",
            effort: "",
            error: "",
            reference: "",
            measured,
            remark: String::new(),
        };
        chart.mark_front();
        chart
    }

    fn front(points: &[(f64, f64)]) -> Vec<bool> {
        chart(points).measured.iter().map(|measured| measured.on_front).collect()
    }

    #[test]
    fn the_front_is_what_nothing_beats() {
        assert_eq!(front(&[(1.0, 1e-2), (2.0, 1e-3), (3.0, 1e-2), (4.0, 1e-9)]), [true, true, false, true]);
        // Within the noise of the clock, and both as right as a double can be.
        assert_eq!(front(&[(1.0, 1e-17), (1.1, 0.0)]), [true, true]);
        assert_eq!(front(&[(1.0, 1e-17), (1.2, 0.0)]), [true, false]);
        assert_eq!(front(&[(1.0, 1e-3), (1.0, 1e-4)]), [false, true]);
    }

    #[test]
    fn methods_compete_with_those_of_their_question() {
        let mut chart = chart(&[(1.0, 1e-9), (2.0, 1e-3)]);
        assert!(!chart.measured[1].on_front);
        chart.measured[1].question = "another".into();
        chart.mark_front();
        assert!(chart.measured[1].on_front && chart.questions() == ["", "another"]);
    }
}
