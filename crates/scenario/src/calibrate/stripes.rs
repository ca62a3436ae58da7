//! Which stripes are to be taken out of a cube (`hadar calibrate stripes`): the cube, and how they lie (`[stripes]`).

use super::super::entries::{Document, Entries};
use super::super::keys::files;
use super::super::kind::Kind;
use super::super::paths::Paths;
use super::super::reader::file;
use super::super::section::{Entry, Section};
use super::super::source::Source;
use super::frames::Frames;
use hadar::error::{Error, Result};
use hadar_estimate::calibrate::{Axis, Sought};
use std::path::Path;

const MINIMUM: &str = "write [cube] with data = \"counts.npy\", and [stripes] with axis = \"rows\"";

/// Where nothing is said: rows, gains that differ by some percent.
const SOUGHT: Sought = Sought { axis: Axis::Rows, gain_deviation: 0.1, in_all_bands: false };

/// Everything that the file says.
#[derive(Debug, Clone)]
pub struct StripesScenario {
    /// What it is about, for headings.
    pub title: Option<String>,
    /// The cube that is to be destriped (`[cube]`).
    pub cube: Frames,
    /// Direction and treatment of the stripes (`[stripes]`).
    pub stripes: Sought,
    /// Where it was read from.
    pub source: Source,
}

file!(StripesScenario, source, (Kind::Calibrate, MINIMUM, &files::STRIPES));

impl StripesScenario {
    /// A bare cube, with what holds where nothing is said.
    #[must_use]
    pub fn bare(path: &Path) -> Self {
        let cube = Frames::bare(&[path.to_owned()]);
        let source = cube.home();
        Self { title: None, cube, stripes: SOUGHT, source }
    }

    fn of_root(root: &Section<'_>) -> Result<Self> {
        let scenario = Self {
            title: root.title("\"A striped cube\"")?,
            cube: Frames::read(&root.table("cube", MINIMUM)?)?,
            stripes: root.read("stripes", stripes)?.unwrap_or(SOUGHT),
            source: Source::default(),
        };
        if scenario.cube.data.len() != 1 {
            let found = format!("{} cubes", scenario.cube.data.len());
            return Err(root.fail("cube.data", Error::malformed(found, "write one: data = \"counts.npy\"")));
        }
        Ok(scenario)
    }

    fn document(&self, paths: Paths<'_>) -> Document {
        let stripes = Entries::default()
            .put("axis", self.stripes.axis.name())
            .put("gain_deviation", self.stripes.gain_deviation)
            .put("in_all_bands", self.stripes.in_all_bands);
        Document::titled(self.title.as_ref()).put("cube", self.cube.written(paths)).put("stripes", stripes)
    }
}

fn stripes(entry: &Entry<'_>) -> Result<Sought> {
    let section = entry.section()?;
    let axes = [Axis::Rows, Axis::Columns].map(|axis| (axis.name(), axis));
    Ok(Sought {
        axis: section.choice("axis", &axes)?.unwrap_or(SOUGHT.axis),
        gain_deviation: section.number("gain_deviation")?.unwrap_or(SOUGHT.gain_deviation),
        in_all_bands: section.read("in_all_bands", Entry::boolean)?.unwrap_or(SOUGHT.in_all_bands),
    })
}
