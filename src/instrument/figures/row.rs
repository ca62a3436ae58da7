//! A row of the table of figures: what a figure is, and what may be done with any of them.

use super::spec::{CameraSpec, Efficiency};
use crate::allowed::{ABOVE_ZERO, Allowed};
use crate::error::{Error, Result};
use crate::instrument::Readout;
use crate::units::Dimension;
use std::path::{Path, PathBuf};

/// Share by which two values of a figure may differ and are still the same: the rounding of a conversion of units.
const ROUNDING: f64 = 1e-9;

/// Stands where a figure is to be filled in.
pub const BLANK: &str = "…";

/// Where a figure stands in [`CameraSpec`].
#[derive(Debug)]
#[non_exhaustive]
pub struct Slot<T: 'static> {
    /// To look at.
    pub of: fn(&CameraSpec) -> &Option<T>,
    /// To write to.
    pub at: fn(&mut CameraSpec) -> &mut Option<T>,
}

// Two pointers, whatever they point to.
impl<T> Clone for Slot<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Slot<T> {}

/// What kind of value a figure is, which are allowed, and where it stands.
#[derive(Debug, Clone, Copy)]
pub enum Kind {
    /// A number with its unit.
    Quantity(Dimension, Allowed, Slot<f64>),
    /// A plain number.
    Number(Allowed, Slot<f64>),
    /// A plain number, or a file of it over wavenumber.
    Efficiency(Allowed, Slot<Efficiency>),
    /// A whole number of at least 1.
    Count(Slot<u32>),
    /// True or false.
    Flag(Slot<bool>),
    /// When the bands are exposed.
    Readout(Slot<Readout>),
    /// A range of wavenumbers, cm⁻¹.
    Span(Slot<[f64; 2]>),
    /// A file.
    File(Slot<PathBuf>),
    /// The name of a known camera.
    Name(Slot<String>),
}

/// Which part of a camera a figure belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// It stands for itself.
    Own,
    /// It states the electronic noise: at most one of [`super::NOISES`] does.
    Noise,
    /// A condition under which the noise of one of these keys is stated.
    Condition(&'static [&'static str]),
}

impl Part {
    /// Whether it is a condition of the noise of a key.
    #[must_use]
    pub fn is_condition_of(self, noise: &str) -> bool {
        matches!(self, Self::Condition(noises) if noises.contains(&noise))
    }
}

/// Whether the sheet of a camera has a line for a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Line {
    /// Stated or not.
    Always,
    /// Where it is stated.
    IfStated,
    /// Not one of its own: another line says it, or none.
    Elsewhere,
}

/// A key of `[camera]`.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    /// The key.
    pub key: &'static str,
    /// Its name in a text.
    pub label: &'static str,
    /// What kind of value it is.
    pub kind: Kind,
    /// A value to write.
    pub example: &'static str,
    /// The part of the camera.
    pub part: Part,
    /// Its line in the sheet of a camera.
    pub line: Line,
    /// What it means and what its absence means, in a sentence.
    pub meaning: &'static str,
    /// Where it enters: an equation of the paper, or what is done with it.
    pub enters: &'static str,
}

/// Whether two values of a figure differ by no more than the rounding of a conversion of units.
fn is_rounding(a: f64, b: f64) -> bool {
    (a - b).abs() <= ROUNDING * a.abs().max(b.abs())
}

/// The same expression for a slot of any type.
macro_rules! with_slot {
    ($kind:expr, $slot:ident => $body:expr) => {
        match $kind {
            Kind::Quantity(_, _, $slot) | Kind::Number(_, $slot) => $body,
            Kind::Efficiency(_, $slot) => $body,
            Kind::Count($slot) => $body,
            Kind::Flag($slot) => $body,
            Kind::Readout($slot) => $body,
            Kind::Span($slot) => $body,
            Kind::File($slot) => $body,
            Kind::Name($slot) => $body,
        }
    };
}

impl Row {
    /// Whether the figure is stated.
    #[must_use]
    pub fn is_given(&self, spec: &CameraSpec) -> bool {
        with_slot!(self.kind, slot => (slot.of)(spec).is_some())
    }

    /// The figure of one camera in place of that of another, where the one states it.
    pub fn lay(&self, over: &CameraSpec, under: &mut CameraSpec) {
        if self.is_given(over) {
            with_slot!(self.kind, slot => (slot.at)(under).clone_from((slot.of)(over)));
        }
    }

    /// The figure as a plain number in the unit used inside, where it is one.
    #[must_use]
    pub fn number(&self, spec: &CameraSpec) -> Option<f64> {
        match self.kind {
            Kind::Quantity(_, _, slot) | Kind::Number(_, slot) => *(slot.of)(spec),
            Kind::Efficiency(_, slot) => (slot.of)(spec).as_ref().and_then(Efficiency::number),
            Kind::Count(slot) => (slot.of)(spec).map(f64::from),
            _ => None,
        }
    }

    /// States a plain number, where the figure is one that need not be whole.
    pub fn put_number(&self, spec: &mut CameraSpec, value: f64) {
        match self.kind {
            Kind::Quantity(_, _, slot) | Kind::Number(_, slot) => *(slot.at)(spec) = Some(value),
            Kind::Efficiency(_, slot) => *(slot.at)(spec) = Some(Efficiency::Number(value)),
            _ => {}
        }
    }

    /// The file that is stated, where it is one.
    #[must_use]
    pub fn file<'s>(&self, spec: &'s CameraSpec) -> Option<&'s Path> {
        match self.kind {
            Kind::File(slot) => (slot.of)(spec).as_deref(),
            Kind::Efficiency(_, slot) => match (slot.of)(spec) {
                Some(Efficiency::File(path)) => Some(path),
                _ => None,
            },
            _ => None,
        }
    }

    /// Whether two cameras state the same figure, but for the rounding of a conversion of units.
    #[must_use]
    pub fn is_same(&self, a: &CameraSpec, b: &CameraSpec) -> bool {
        match (self.number(a), self.number(b)) {
            (Some(a), Some(b)) => is_rounding(a, b),
            _ if matches!(self.kind, Kind::Span(_)) => match (a.spectral_range_cm1, b.spectral_range_cm1) {
                (Some([a, b]), Some([c, d])) => is_rounding(a, c) && is_rounding(b, d),
                (a, b) => a == b,
            },
            _ => with_slot!(self.kind, slot => (slot.of)(a) == (slot.of)(b)),
        }
    }

    /// Refuses a number that is not allowed.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] with the key.
    pub fn check(&self, spec: &CameraSpec) -> Result<()> {
        let (allowed, unit) = match self.kind {
            Kind::Quantity(dimension, allowed, _) => (allowed, dimension.unit()),
            Kind::Number(allowed, _) | Kind::Efficiency(allowed, _) => (allowed, ""),
            Kind::Count(_) => (ABOVE_ZERO, ""),
            _ => return Ok(()),
        };
        match self.number(spec) {
            Some(value) if !allowed.allows(value) => {
                let expected = format!("a finite number, {}", allowed.expected);
                Err(Error::out_of_range(self.key, value, unit, expected))
            }
            _ => Ok(()),
        }
    }

    /// `key = …` with the unit of the example: a figure to be filled in, of which nothing is known.
    #[must_use]
    pub fn blank(&self) -> String {
        let number = |char: char| char.is_ascii_digit() || matches!(char, '.' | '-');
        let value = match self.example.strip_prefix('"') {
            Some(quantity) => format!("\"{BLANK} {}", quantity.trim_start_matches(number).trim_start()),
            None => BLANK.to_owned(),
        };
        format!("{} = {value}", self.key)
    }

    /// What may be written, in a few words.
    #[must_use]
    pub fn value(&self) -> String {
        match self.kind {
            Kind::Quantity(dimension, allowed, _) => format!("{}, {}", dimension.name(), allowed.expected),
            Kind::Number(allowed, _) => format!("number, {}", allowed.expected),
            Kind::Efficiency(allowed, _) => format!("number, {}, or a file of rows", allowed.expected),
            Kind::Count(_) => "whole number, at least 1".into(),
            Kind::Flag(_) => "true or false".into(),
            Kind::Readout(_) => {
                let names = Readout::ALL.map(|readout| format!("\"{}\"", readout.name()));
                names.join(", ")
            }
            Kind::Span(_) => "two wavelengths or wavenumbers".into(),
            Kind::File(_) => "file of rows".into(),
            Kind::Name(_) => "name of a known camera".into(),
        }
    }
}
