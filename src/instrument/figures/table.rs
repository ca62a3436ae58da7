//! The keys of `[camera]`, in the order in which they are read, written and listed.

use super::list::every_figure;
use super::row::{Kind, Line, Part, Row, Slot};
use crate::allowed::{ABOVE_ZERO, ABSOLUTE_TEMPERATURE, Allowed, FROM_ZERO, SHARE};
use crate::units::Dimension;

/// The fastest f-number of a lens in air (Abbe's sine condition).
pub const FASTEST_F_NUMBER: f64 = 0.5;

const F_NUMBER: Allowed = Allowed {
    holds: |value| value >= FASTEST_F_NUMBER,
    expected: "at least 0.5, the fastest that a lens in air can be",
};
/// Of the blackbody of a NETD. Colder or hotter ones than are built change counts by so little, or so much, per K that no digit is
/// left of a noise, which a verdict would then not see.
const BLACKBODY: Allowed =
    Allowed { holds: |value| (50.0..=5000.0).contains(&value), expected: "from 50 K to 5000 K" };
const EFFICIENCY: Allowed =
    Allowed { holds: |value| value > 0.0 && value <= 1.0, expected: "above 0, at most 1" };
const FIELD_OF_VIEW: Allowed = Allowed {
    holds: |value| value > 0.0 && value < std::f64::consts::PI,
    expected: "above 0 and below 180 deg",
};

/// The keys that state the noise, of which there is at most one.
pub const NOISES: [&str; 6] = ["netd", "detectivity", "nep", "nesr", "noise_electrons", "noise_table"];

macro_rules! slot {
    ($($field:ident).+) => { Slot { of: |spec| &spec.$($field).+, at: |spec| &mut spec.$($field).+ } };
}

const fn row(
    key: &'static str,
    label: &'static str,
    kind: Kind,
    example: &'static str,
    meaning: &'static str,
    enters: &'static str,
) -> Row {
    Row { key, label, kind, example, part: Part::Own, line: Line::IfStated, meaning, enters }
}

impl Row {
    const fn always_shown(self) -> Self {
        Self { line: Line::Always, ..self }
    }

    const fn elsewhere(self) -> Self {
        Self { line: Line::Elsewhere, ..self }
    }

    const fn noise(self) -> Self {
        Self { part: Part::Noise, line: Line::Elsewhere, ..self }
    }

    const fn condition_of(self, noises: &'static [&'static str]) -> Self {
        Self { part: Part::Condition(noises), line: Line::Elsewhere, ..self }
    }
}

macro_rules! table {
    ($spec:tt $camera:tt $both:tt $own:tt [$($row:tt)*]) => {
        /// The keys of `[camera]`.
        pub const TABLE: &[Row] = &[$($row)*];
    };
}

every_figure!(table);
