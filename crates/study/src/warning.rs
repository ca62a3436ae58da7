//! What the reader of a result must know: a code that programs can rely on, and the data of its message.
//!
//! Remarks are made last, of the same data as the answer; nothing reads them back. Their words are those of the one who writes
//! ([`crate::spoken`]).

mod table;

pub use table::{Code, Warning};

impl Warning {
    /// The same, said of cameras among several.
    #[must_use]
    pub fn of_cameras(self, who: &str) -> Self {
        Self::OfCameras { who: who.to_owned(), warning: Box::new(self) }
    }
}

/// Remarks by their codes, in the order of the first of each, for those who print them.
#[must_use]
pub fn by_code<'a>(warnings: impl IntoIterator<Item = &'a Warning>) -> Vec<(Code, Vec<&'a Warning>)> {
    let mut by_code: Vec<(Code, Vec<&Warning>)> = Vec::new();
    for warning in warnings {
        match by_code.iter_mut().find(|(code, _)| *code == warning.code()) {
            Some((_, said)) => said.push(warning),
            None => by_code.push((warning.code(), vec![warning])),
        }
    }
    by_code
}

/// A blackbody whose readings are those of another temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorstBlackbody {
    /// Its place, from 0.
    pub blackbody: usize,
    /// Its temperature as stated, K.
    pub temperature_k: f64,
    /// By how much warmer its readings are than that, K.
    pub off_k: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_unique() {
        let mut names: Vec<&str> = Code::ALL.iter().map(|code| code.name()).collect();
        let written = |name: &&str| name.chars().all(|char| char.is_ascii_lowercase() || char == '-');
        assert!(names.iter().all(written), "{names:?}");
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), Code::ALL.len());
    }

    #[test]
    fn a_warning_of_a_pair_has_the_code_of_what_it_is_of() {
        let warning = Box::new(Warning::SensorTemperatureIdle);
        let of_pair = Warning::OfPair { target: "skin".into(), alternative: "pmma".into(), warning };
        assert_eq!(of_pair.of_cameras("a").code().name(), "filter-light");
    }
}
