//! What a camera falls short of, in the fewest words.

use hadar_study::Shortfall;

/// That a demand is not met, and by what.
pub(crate) fn no(shortfalls: &[Shortfall]) -> String {
    let word = |by: &Shortfall| match by {
        Shortfall::Distance => "d too small".to_owned(),
        other => other.code().replace('-', " "),
    };
    format!("no: {}", shortfalls.iter().map(word).collect::<Vec<_>>().join(", "))
}
