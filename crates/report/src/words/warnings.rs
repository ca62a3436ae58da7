//! The words of every warning: what it means, what to do about it, its sentence. A block each, in the file of its topic.
//!
//! The warnings themselves, their data and their codes, are rows of `hadar_study::warning`. A row without words does not compile.

mod block;
mod calibrate;
mod camera;
mod cubes;
mod identify;
mod library;
mod ranging;
mod rule;
mod simulate;

pub use block::Words;

use super::Say;
use hadar_study::warning::{Code, Warning};

const TOPICS: [&[Words]; 8] = [
    library::WORDS,
    cubes::WORDS,
    calibrate::WORDS,
    identify::WORDS,
    camera::WORDS,
    rule::WORDS,
    ranging::WORDS,
    simulate::WORDS,
];

/// The words of every code, made while this is compiled, which fails with the name of a warning that has none.
static BY_CODE: [&Words; Code::ALL.len()] = {
    let mut by_code = [&TOPICS[0][0]; Code::ALL.len()];
    let mut row = 0;
    while row < Warning::ALL.len() {
        let (variant, code) = Warning::ALL[row];
        match of(variant, code) {
            Some(words) => by_code[code as usize] = words,
            // Evaluated by the compiler alone: what runs has words for every warning.
            None => panic!("{}", variant),
        }
        row += 1;
    }
    by_code
};

/// The words of a warning, found in the topics.
const fn of(variant: &str, code: Code) -> Option<&'static Words> {
    let mut topic = 0;
    while topic < TOPICS.len() {
        let mut block = 0;
        while block < TOPICS[topic].len() {
            let words = &TOPICS[topic][block];
            let mut sentence = 0;
            while words.code as usize == code as usize && sentence < words.variants.len() {
                if equal(words.variants[sentence].as_bytes(), variant.as_bytes()) {
                    return Some(words);
                }
                sentence += 1;
            }
            block += 1;
        }
        topic += 1;
    }
    None
}

const fn equal(a: &[u8], b: &[u8]) -> bool {
    let mut at = 0;
    while at < a.len() && at < b.len() && a[at] == b[at] {
        at += 1;
    }
    at == a.len() && at == b.len()
}

/// What the warnings of a code mean, and what to do about them.
#[must_use]
pub fn of_code(code: Code) -> &'static Words {
    BY_CODE[code as usize]
}

impl Say for Warning {
    fn say(&self) -> String {
        match self {
            Self::OfPair { target, alternative, warning } => {
                format!("{target} against {alternative}: {}", warning.say())
            }
            Self::OfCameras { who, warning } => format!("{who}: {}", warning.say()),
            // Every warning has a sentence: see `BY_CODE`.
            warning => (of_code(warning.code()).sentence)(warning).unwrap_or_default(),
        }
    }
}

/// Whether a reader is told the same, digits that are not shown left out.
pub(crate) fn say_the_same(one: &Warning, other: &Warning) -> bool {
    one.code() == other.code() && one.say() == other.say()
}

#[cfg(test)]
mod tests {
    use super::*;
    use hadar::scene::Parameter;
    use hadar_study::Proviso;

    #[test]
    fn meanings_and_remedies_are_sentences() {
        for code in Code::ALL {
            let words = of_code(*code);
            assert_eq!(words.code, *code);
            for text in [words.meaning, words.remedy] {
                assert!(text.ends_with('.') && text.starts_with(char::is_uppercase), "{code:?}: {text}");
            }
        }
        let blocks: usize = TOPICS.iter().map(|topic| topic.len()).sum();
        assert_eq!(blocks, Code::ALL.len(), "blocks of one code in two places, or of none");
    }

    #[test]
    fn a_warning_is_its_code_and_its_message() {
        let of_pair = Warning::OfPair {
            target: "skin".into(),
            alternative: "pmma".into(),
            warning: Box::new(Warning::NearestAtEdge {
                parameters: vec![Parameter::Temperature, Parameter::Lighting(1)],
                objects: 2,
            }),
        };
        assert_eq!(
            crate::json::line(&of_pair).unwrap(),
            "{\"code\":\"nearest-at-edge\",\"message\":\"skin against pmma: the closest confuser is at the edge of its range \
             (temperature, lighting of environment[1]); the range decides the answer\"}"
        );
        let digits = |relative_error| Warning::FewDigits { distance: "local distance", relative_error }.say();
        assert!(digits(2e-2).ends_with("its relative error is about 2e-2"), "{}", digits(2e-2));
        for error in [1e300, f64::NAN] {
            assert!(digits(error).ends_with("it may have any value"), "{}", digits(error));
        }
        // Digits that are not shown make no second warning.
        let moving = |time_s| Warning::FramesInMotion(Proviso { frames: 60, time_s, way_m: 1.7 });
        assert!(say_the_same(&moving(1.0), &moving(1.0 + 1e-9)));
        assert!(!say_the_same(&moving(1.0), &moving(1.2)));
    }
}
