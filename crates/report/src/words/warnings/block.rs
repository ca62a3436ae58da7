//! A block of words: all that is said of the warnings of one code.

use hadar::words::significant;
use hadar_study::warning::{Code, Warning};

/// What is said of the warnings of a code.
#[derive(Debug)]
pub struct Words {
    pub(super) code: Code,
    /// What it means.
    pub meaning: &'static str,
    /// What to do about it.
    pub remedy: &'static str,
    /// Names of the warnings that have a sentence here.
    pub(super) variants: &'static [&'static str],
    pub(super) sentence: fn(&Warning) -> Option<String>,
}

/// Blocks of words: the code, meaning, remedy, and a sentence for each warning that has the code, made of its data.
macro_rules! words {
    ($($code:ident {
        meaning: $meaning:literal,
        remedy: $remedy:literal,
        $($variant:ident $({ $($field:tt)* })? $(($($tuple:tt)*))? $(if $guard:expr)? => $sentence:expr,)+
    })+) => {
        pub(super) const WORDS: &[$crate::words::warnings::block::Words] = &[$($crate::words::warnings::block::Words {
            code: hadar_study::warning::Code::$code,
            meaning: $meaning,
            remedy: $remedy,
            variants: &[$(stringify!($variant)),+],
            sentence: |warning| match warning {
                $(hadar_study::Warning::$variant $({ $($field)* })? $(($($tuple)*))? $(if $guard)? => Some(String::from($sentence)),)+
                _ => None,
            },
        }),+];
    };
}
pub(super) use words;

/// A number that is told by the way.
pub(super) fn short(value: f64) -> String {
    significant(value, 2)
}
