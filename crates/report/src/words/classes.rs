//! How many spectra a verdict on classes rests on, and which two decide.

use super::Say;
use hadar_study::{ClassAnswer, ClassSide};

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
        (true, false) if side.spectra == 1 => format!("1 spectrum of {}", side.name),
        (true, false) => format!("{} spectra of {}", side.spectra, side.name),
    }
}
