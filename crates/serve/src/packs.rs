//! The rules that the page for rules offers: those of `rules/` and the example, as they are.

use hadar::error::Result;
use hadar_scenario::Rule;
use serde::Serialize;

/// Names of the files with their texts.
pub(crate) const PACKS: [(&str, &str); 8] = [
    ("fmvss_127_night.toml", include_str!("../rules/fmvss_127_night.toml")),
    ("un_r152_pedestrian.toml", include_str!("../rules/un_r152_pedestrian.toml")),
    ("euro_ncap_night.toml", include_str!("../rules/euro_ncap_night.toml")),
    ("delivery_robots_washington.toml", include_str!("../rules/delivery_robots_washington.toml")),
    ("agv_iso_3691.toml", include_str!("../rules/agv_iso_3691.toml")),
    ("farm_machine.toml", include_str!("../rules/farm_machine.toml")),
    ("fever_screening.toml", include_str!("../rules/fever_screening.toml")),
    ("rule_delivery_robots_at_night.toml", include_str!("../rules/rule_delivery_robots_at_night.toml")),
];

/// A rule that is offered.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct Pack {
    /// Its file.
    file: &'static str,
    /// What it is called.
    name: String,
    /// Whether it is law, a draft, postponed; empty where it does not say.
    status: String,
    /// The file.
    text: &'static str,
}

/// All of them, in the order in which they are offered.
pub(crate) fn all() -> Result<Vec<Pack>> {
    let pack = |(file, text): (&'static str, &'static str)| {
        let about = Rule::from_toml(text, None)?.about;
        let name = about.name.unwrap_or_else(|| file.to_owned());
        Ok(Pack { file, name, status: about.status.unwrap_or_default(), text })
    };
    PACKS.into_iter().map(pack).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No pack of the folder is forgotten, and none is another text than its file.
    #[test]
    fn they_are_the_rules_of_the_repository() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../rules");
        let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        let rules = files.filter(|file| file.extension().is_some_and(|kind| kind == "toml"));
        let mut found = 0;
        for file in rules {
            let name = file.file_name().unwrap().to_string_lossy().into_owned();
            let (_, text) = PACKS.iter().find(|(own, _)| *own == name).unwrap();
            assert_eq!(*text, std::fs::read_to_string(&file).unwrap(), "{name}");
            found += 1;
        }
        // The example is in another folder.
        assert_eq!(found + 1, PACKS.len());
        assert!(all().unwrap().iter().all(|pack| !pack.name.contains(".toml")));
    }
}
