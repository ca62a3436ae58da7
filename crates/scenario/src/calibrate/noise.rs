//! Which noise is asked for (`hadar calibrate noise`): frames, and what is known of the camera (`[noise]`).

use super::super::entries::{Document, Entries};
use super::super::keys::files;
use super::super::kind::Kind;
use super::super::paths::Paths;
use super::super::reader::file;
use super::super::section::{Entry, Section};
use super::super::source::Source;
use super::frames::Frames;
use hadar::error::Result;
use hadar::units::Dimension;

const MINIMUM: &str = "write [cube] with data = [\"frame_1.npy\", \"frame_2.npy\"], and [noise]";

/// Everything that the file says.
#[derive(Debug, Clone)]
pub struct NoiseScenario {
    /// What it is about, for headings.
    pub title: Option<String>,
    /// Frames of one scene, or one frame (`[cube]`).
    pub cube: Frames,
    /// What is known of the camera (`[noise]`).
    pub noise: NoiseSpec,
    /// Where it was read from.
    pub source: Source,
}

/// What is known of the camera (`[noise]`).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NoiseSpec {
    /// Sample without light, in the unit of the cube.
    pub dark_level: f64,
    /// Whether gains of pixels differ by an unknown share.
    pub gain_spread: bool,
    /// Exposure of a frame, s.
    pub exposure_s: Option<f64>,
    /// Whether the scene is the same everywhere.
    pub uniform: bool,
    /// NETD of a frame, K.
    pub netd_k: Option<f64>,
}

file!(NoiseScenario, source, (Kind::Calibrate, MINIMUM, &files::NOISE));

impl NoiseScenario {
    /// Bare cubes, with what holds where nothing is said.
    #[must_use]
    pub fn bare(paths: &[std::path::PathBuf]) -> Self {
        let cube = Frames::bare(paths);
        let source = cube.home();
        Self { title: None, cube, noise: NoiseSpec::default(), source }
    }

    fn of_root(root: &Section<'_>) -> Result<Self> {
        Ok(Self {
            title: root.title("\"Noise of the camera\"")?,
            cube: Frames::read(&root.table("cube", MINIMUM)?)?,
            noise: root.read("noise", noise)?.unwrap_or_default(),
            source: Source::default(),
        })
    }

    fn document(&self, paths: Paths<'_>) -> Document {
        let noise = Entries::default()
            .put("dark_level", self.noise.dark_level)
            .put("gain_spread", self.noise.gain_spread)
            .put_quantity("exposure", Dimension::Time, self.noise.exposure_s)
            .put("uniform", self.noise.uniform)
            .put_quantity("netd", Dimension::TemperatureDifference, self.noise.netd_k);
        Document::titled(self.title.as_ref()).put("cube", self.cube.written(paths)).put("noise", noise)
    }
}

fn noise(entry: &Entry<'_>) -> Result<NoiseSpec> {
    let section = entry.section()?;
    Ok(NoiseSpec {
        dark_level: section.number("dark_level")?.unwrap_or(0.0),
        gain_spread: section.read("gain_spread", Entry::boolean)?.unwrap_or(false),
        exposure_s: section.quantity("exposure")?,
        uniform: section.read("uniform", Entry::boolean)?.unwrap_or(false),
        netd_k: section.quantity("netd")?,
    })
}
