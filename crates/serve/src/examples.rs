//! The scenarios that the page offers to begin from: those of `examples/` that `hadar size` answers and that name no files.

use hadar::error::Result;
use hadar_scenario::Scenario;
use serde::Serialize;

const TEXTS: [&str; 4] = [
    include_str!("../examples/human_vs_robot.toml"),
    include_str!("../examples/sizing.toml"),
    include_str!("../examples/what_can_my_flir_tell_apart.toml"),
    include_str!("../examples/thermometry_sic.toml"),
];

/// A scenario that is offered.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct Example {
    /// What it asks.
    title: String,
    /// The file.
    text: &'static str,
}

/// All of them, in the order in which they are offered.
pub(crate) fn all() -> Result<Vec<Example>> {
    let example = |text: &'static str| {
        let title = Scenario::from_toml(text, None)?.title.unwrap_or_default();
        Ok(Example { title, text })
    };
    TEXTS.into_iter().map(example).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_example_has_a_title_and_names_no_file() {
        for example in all().unwrap() {
            assert!(!example.title.is_empty());
            let written = hadar_scenario::Written::of(example.text, None).refusing_files();
            assert!(Scenario::from_written(&written).is_ok(), "{}", example.title);
        }
    }
}
