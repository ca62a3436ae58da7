//! A spectrometer before blackbodies (`hadar calibrate blackbody`): its channels, the blackbodies, the noise, a cube to be calibrated.

use super::super::entries::{Document, Entries};
use super::super::keys::files;
use super::super::kind::Kind;
use super::super::paths::Paths;
use super::super::reader::file;
use super::super::section::Section;
use super::super::{BandsSpec, Source};
use super::blackbodies::{BlackbodySpec, CubeFile, blackbodies, noise};
use hadar::error::Result;

const MINIMUM: &str = "write [bands], [[blackbody]] twice with temperature = \"10 degC\" and data = \"cold.npy\", and [noise] with sample = 1.5";

/// Everything that the file says.
///
/// ```
/// use hadar_scenario::calibrate::BlackbodyScenario;
/// let text = r#"
///     [bands]
///     start = "700 cm^-1"
///     stop = "1400 cm^-1"
///     step = "10 cm^-1"
///     [[blackbody]]
///     temperature = "10 degC"
///     data = "cold.npy"
///     [[blackbody]]
///     temperature = "60 degC"
///     data = "warm.npy"
///     [noise]
///     sample = 1.5
/// "#;
/// assert_eq!(BlackbodyScenario::from_toml(text, None)?.blackbodies.len(), 2);
/// let error = BlackbodyScenario::from_toml(&text.replace("60", "10"), None).unwrap_err().to_string();
/// assert!(error.contains("blackbody[0] and blackbody[1] are both at 283.15 K"), "{error}");
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct BlackbodyScenario {
    /// What it is about, for headings.
    pub title: Option<String>,
    /// The channels, bands of one wavenumber each.
    pub bands: BandsSpec,
    /// The blackbodies that were recorded (`[[blackbody]]`).
    pub blackbodies: Vec<BlackbodySpec>,
    /// Deviation of one sample, in the unit of the cubes (`[noise] sample`).
    pub noise: f64,
    /// The cube to be calibrated (`[scene]`).
    pub scene: Option<SpectralScene>,
    /// Where it was read from.
    pub source: Source,
}

/// A cube to be calibrated (`[scene]`).
#[derive(Debug, Clone, PartialEq)]
pub struct SpectralScene {
    /// The cube.
    pub data: CubeFile,
    /// Whether each pixel has a response and an offset of its own, which cubes of blackbodies of the same size tell.
    pub each_pixel: bool,
}

const RESPONSES: [(&str, bool); 2] = [("common", false), ("each-pixel", true)];

file!(BlackbodyScenario, source, (Kind::Calibrate, MINIMUM, &files::BLACKBODY));

impl BlackbodyScenario {
    fn of_root(root: &Section<'_>) -> Result<Self> {
        Ok(Self {
            title: root.title("\"FTIR of today\"")?,
            bands: BandsSpec::read(&root.table("bands", MINIMUM)?)?,
            blackbodies: blackbodies(root)?,
            noise: noise(root)?,
            scene: root.read("scene", |entry| {
                let section = entry.section()?;
                Ok(SpectralScene {
                    data: CubeFile::read(&section)?,
                    each_pixel: section.choice("response", &RESPONSES)?.unwrap_or(false),
                })
            })?,
            source: Source::default(),
        })
    }

    fn document(&self, paths: Paths<'_>) -> Document {
        let scene = |scene: &SpectralScene| {
            scene.data.written(paths).put("response", RESPONSES[usize::from(scene.each_pixel)].0)
        };
        Document::titled(self.title.as_ref())
            .put("bands", self.bands.written(paths))
            .put("blackbody", self.blackbodies.iter().map(|spec| spec.written(paths)).collect::<Vec<_>>())
            .put("noise", Entries::default().put("sample", self.noise))
            .put_if("scene", self.scene.as_ref().map(scene))
    }
}
