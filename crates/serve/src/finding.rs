//! Which cameras meet the scenario of the page: that of `hadar find`, with the camera and its bands left open.
//!
//! Scene, alternatives and requirement stay as they are written. Where the scenario has no `[find]`, all cameras are searched: those without a
//! fixed lens with that of the scenario's own camera if it states one, else with those that a document names for them.

use crate::engine::Engine;
use crate::said::told;
use crate::size_limit::{self, Command};
use hadar::demand::Skipping;
use hadar::error::{Error, Result};
use hadar_report::find::{self, Row};
use hadar_scenario::Scenario;
use serde::{Deserialize, Serialize};
use toml_edit::{Array, DocumentMut, InlineTable, Item, Table, TableLike, value};

/// A question for cameras.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FindAsk {
    /// The text of the scenario.
    scenario: String,
}

/// A question that can be read, or why not.
#[derive(Debug)]
pub(crate) struct PreparedFind(Result<Scenario>);

impl PreparedFind {
    /// Whether there is nothing to compute.
    pub(crate) const fn is_quick(&self) -> bool {
        self.0.is_err()
    }
}

/// The answer as it is shown.
#[derive(Debug, Serialize)]
struct FindShown {
    sentence: String,
    rows: Vec<Row>,
    /// The whole answer as the command prints it.
    text: String,
}

impl Engine {
    /// Reads the scenario of a question, without its camera.
    pub(crate) fn prepare_find(&self, ask: &FindAsk) -> PreparedFind {
        PreparedFind(question(&ask.scenario).and_then(|text| {
            let scenario = Scenario::from_written(&self.written(&text))?;
            size_limit::surroundings(scenario.environment.len(), Command::Find)?;
            Ok(scenario)
        }))
    }

    /// The cameras that meet it.
    pub(crate) fn find_answer(&self, prepared: PreparedFind) -> Result<String> {
        told(prepared.0.and_then(|scenario| {
            let found = hadar_study::find::find(&scenario, &self.cameras, &self.library, Skipping::On)?;
            let text = find::text(&found);
            Ok(FindShown { sentence: find::sentence(&found), rows: find::rows(&found), text })
        }))
    }
}

/// A scenario as a question for cameras.
fn question(text: &str) -> Result<String> {
    let mut document: DocumentMut = text.parse().map_err(|_| {
        Error::malformed("the text of the scenario is no TOML", "mend the text before cameras are searched")
    })?;
    let camera = document.remove("camera");
    document.remove("bands");
    if !document.contains_key("find") {
        let mut find = Table::new();
        if let Some(lens) = camera.as_ref().and_then(Item::as_table_like).and_then(lens) {
            find.insert("lenses", value(Array::from_iter([lens])));
        }
        document.insert("find", Item::Table(find));
    }
    Ok(document.to_string())
}

/// The lens that a camera is stated to have.
fn lens(camera: &dyn TableLike) -> Option<InlineTable> {
    // Without the comments beside them.
    let own = |name: &str| Some(camera.get(name)?.as_value()?.clone().decorated("", ""));
    let (f_number, focal_length) = (own("f_number")?, own("focal_length")?);
    let mut lens = InlineTable::from_iter([("f_number", f_number), ("focal_length", focal_length)]);
    lens.fmt();
    Some(lens)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_camera_is_left_open_and_its_lens_is_tried() {
        let text = "[target]\nmaterial = \"skin\" # whom\n[bands]\nranges = []\n[camera]\nf_number = 1.2 # fast\nfocal_length = \"14 mm\"\n";
        assert_eq!(
            question(text).unwrap(),
            "[target]\nmaterial = \"skin\" # whom\n\n[find]\nlenses = [{ f_number = 1.2, focal_length = \"14 mm\" }]\n"
        );
        assert_eq!(question("[find]\nkind = \"cooled\"\n[camera]\n").unwrap(), "[find]\nkind = \"cooled\"\n");
        assert_eq!(question("[camera]\npreset = \"flir-lepton-3.5\"\n").unwrap(), "[find]\n");
        assert!(question("[camera").is_err());
    }
}
