//! Reforms of a rule (`[[reform]]`): other values that somebody proposes or has enacted from a later day on, beside the law and never in its place.

use super::citation::{Ground, ground};
use crate::Setting;
use crate::entries::Entries;
use crate::section::{Entry, Section};
use hadar::error::{Error, Result};
use toml::value::Date;

/// Tables that no reform of a law changes.
const NOT_LAW: [&str; 9] = ["title", "camera", "cameras", "rule", "source", "test", "reform", "grid", "find"];

/// Other values of a rule.
#[derive(Debug, Clone, PartialEq)]
pub struct Reform {
    /// What it is called.
    pub name: String,
    /// What became of it, e.g. `bill`.
    pub status: Option<String>,
    /// The day from which it would hold.
    pub from: Option<Date>,
    /// What stands in the place of the rule's own values.
    pub set: Vec<Setting>,
    /// What says so.
    pub ground: Ground,
}

impl Reform {
    pub(super) fn entries(&self) -> Entries {
        let set: Vec<String> = self.set.iter().map(|one| format!("{} = {}", one.key, one.value)).collect();
        Entries::default()
            .put("name", self.name.as_str())
            .put_if("status", self.status.as_deref())
            .put_if("from", self.from.map(|day| day.to_string()))
            .put("set", set)
            .and(self.ground.entries())
    }
}

/// The reforms of a rule that holds from a day on.
pub(super) fn read(root: &Section<'_>, law_from: Option<Date>) -> Result<Vec<Reform>> {
    let Some(entry) = root.get("reform") else { return Ok(Vec::new()) };
    let items = entry.items("each reform as [[reform]], in double brackets")?;
    let mut reforms: Vec<Reform> = Vec::with_capacity(items.len());
    for item in &items {
        let reform = one(item, law_from)?;
        if reforms.iter().any(|other| other.name == reform.name) {
            let error = Error::malformed("another reform has this name", "give it a name of its own");
            return Err(item.section()?.fail("name", error));
        }
        reforms.push(reform);
    }
    Ok(reforms)
}

fn one(item: &Entry<'_>, law_from: Option<Date>) -> Result<Reform> {
    let section = item.section()?;
    let name = section.require("name")?.name("\"H.R. 7353\"")?;
    let from = section.read("from", Entry::date)?;
    if let Some((from, law)) = from.zip(law_from).filter(|(from, law)| from < law) {
        let found = format!("a reform from {from} of a law that holds from {law}");
        return Err(section.fail(
            "from",
            Error::malformed(found, "write a day on which there is the law, or leave it out"),
        ));
    }
    let set = section.require("set")?;
    let example = "set = [\"requirement.detection_probability = 0.95\"]";
    let items = set.items(example)?;
    if items.is_empty() {
        return Err(set.fail(Error::malformed("the list is empty", format!("write {example}"))));
    }
    let setting = |item: &Entry<'_>| -> Result<Setting> {
        let text = item.text("\"requirement.detection_probability = 0.95\"")?;
        let setting = Setting::parse(text, "the reform").map_err(|error| item.fail(error))?;
        let head = setting.key.split(['.', '[']).next().unwrap_or_default();
        if NOT_LAW.contains(&head) {
            let found = format!("a reform that sets {}, which is no demand of the law", setting.key);
            return Err(
                item.fail(Error::malformed(found, "set a figure of the scenes, the demands or a clause"))
            );
        }
        Ok(setting)
    };
    let set: Vec<Setting> = items.iter().map(setting).collect::<Result<_>>()?;
    if let Some(twice) =
        (1..set.len()).find(|index| set[..*index].iter().any(|one| one.key == set[*index].key))
    {
        let found = format!("{} is set twice", set[twice].key);
        return Err(items[twice].fail(Error::malformed(found, "set it once")));
    }
    let status = section.text("status", "\"bill\"")?;
    Ok(Reform { name, status, from, set, ground: ground(&section)? })
}
