//! What both backends need of the drawing library: its colours, and its refusals.

use super::colour::Colour;
use hadar::error::Error;
use plotters::style::RGBAColor;

/// A refusal of the drawing library, which no valid scene meets.
pub(super) fn failure(error: impl std::fmt::Display) -> Error {
    Error::malformed(format!("the figure cannot be drawn ({error})"), "report this as an error")
}

/// A colour as the library has it.
pub(super) fn rgba(Colour { rgb: (r, g, b), opacity }: Colour) -> RGBAColor {
    RGBAColor(r, g, b, opacity)
}
