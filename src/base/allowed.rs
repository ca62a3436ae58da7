//! What a number must satisfy, and how that is said.

/// A condition on a number that is finite.
#[derive(Debug, Clone, Copy)]
pub struct Allowed {
    /// Whether a number satisfies it.
    pub holds: fn(f64) -> bool,
    /// The condition in words, after 'it must be'.
    pub expected: &'static str,
}

/// Above 0.
pub const ABOVE_ZERO: Allowed = Allowed { holds: |value| value > 0.0, expected: "above 0" };
/// 0 or above.
pub const FROM_ZERO: Allowed = Allowed { holds: |value| value >= 0.0, expected: "0 or above" };
/// A share of something.
pub const SHARE: Allowed =
    Allowed { holds: |value| (0.0..=1.0).contains(&value), expected: "between 0 and 1" };
/// A temperature in K.
pub const ABSOLUTE_TEMPERATURE: Allowed =
    Allowed { holds: |value| value > 0.0, expected: "above 0 K (-273.15 degC)" };

impl Allowed {
    /// Whether the number is finite and satisfies it.
    #[must_use]
    pub fn allows(&self, value: f64) -> bool {
        value.is_finite() && (self.holds)(value)
    }
}
