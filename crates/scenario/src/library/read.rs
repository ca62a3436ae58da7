//! Reads what a library is to be made from: every key checked, every error one line with file, line and key.

use super::super::decompose::PixelUnknown;
use super::super::decompose::read::{heat_cube, light, truth, unknown};
use super::super::keys::files;
use super::super::kind::Kind;
use super::super::paths::is_cube;
use super::super::read::document;
use super::super::section::{Entry, Section};
use super::super::written::Written;
use super::super::{BandsSpec, Source, camera};
use super::{ClustersSpec, EMISSIVITY, LibraryScenario};
use hadar::error::{Error, Result};
use hadar::fisher::emissivity::Smoothness;
use std::path::Path;

const MINIMUM: &str =
    "write [cube] with data = \"counts.npy\", [bands], [[environment]], and [clusters] with count = 6";
const MAX_EMISSIVITY: f64 = 0.99;

impl LibraryScenario {
    /// Reads the file. Relative paths in it start from its directory.
    ///
    /// # Errors
    /// The first thing that is wrong, in one line with file, line and key; a bare cube, with what to write instead.
    pub fn from_file(path: &Path) -> Result<Self> {
        Self::check_path(path)?;
        Self::from_written(&Written::from_file(path)?)
    }

    /// Refuses a bare cube, which is without what a library needs besides.
    ///
    /// # Errors
    /// A path that names a cube, with what to write instead.
    pub fn check_path(path: &Path) -> Result<()> {
        if is_cube(path) {
            let found = "a cube alone says nothing of its bands, its surroundings and its noise";
            let name = path.file_name().map_or_else(|| "counts.npy".into(), |name| name.to_string_lossy());
            let instead = format!(
                "write a file cube.toml with [cube] data = \"{name}\" and counts_per_photon_radiance or a noise, [bands], \
                 [[environment]] and [clusters] count = 6, and name that"
            );
            return Err(Error::malformed(found, instead).in_file(path));
        }
        Ok(())
    }

    /// Reads it from text; `path` as in [`crate::Scenario::from_toml`].
    ///
    /// # Errors
    /// As [`LibraryScenario::from_file`], except those of the file itself.
    ///
    /// ```
    /// use hadar_scenario::LibraryScenario;
    /// let text = r#"
    ///     [cube]
    ///     data = "counts.npy"
    ///     counts_per_photon_radiance = 2e-14
    ///     [bands]
    ///     start = "720 cm^-1"
    ///     stop = "1250 cm^-1"
    ///     step = "10 cm^-1"
    ///     [[environment]]
    ///     temperature = "-10 degC"
    ///     [clusters]
    ///     count = [2, 8]
    /// "#;
    /// let scenario = LibraryScenario::from_toml(text, None)?;
    /// assert_eq!(scenario.clusters.count, [2, 8]);
    /// let error = LibraryScenario::from_toml(&text.replace("[2, 8]", "0"), None).unwrap_err();
    /// assert!(error.to_string().starts_with("line 12: clusters.count: "));
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn from_toml(text: &str, path: Option<&Path>) -> Result<Self> {
        Self::from_written(&Written::of(text, path))
    }

    /// Reads it with values in the place of its own.
    ///
    /// # Errors
    /// As [`Self::from_toml`].
    pub fn from_written(written: &Written) -> Result<Self> {
        let mut source = written.source();
        let document = document(written, (Kind::Library, MINIMUM), &mut source)?;
        let root = Section::open(&document, "", &source, &files::LIBRARY)?;
        let missing = |key: &str| root.fail(key, Error::malformed("the table is missing", MINIMUM));
        let camera = root.read("camera", camera::read)?;
        let cube = root.get("cube").ok_or_else(|| missing("cube"))?;
        let unknown = root.read("unknown", unknown)?.unwrap_or(PixelUnknown::default());
        if unknown.gain {
            let found = Error::malformed(
                "no emissivity can be told from an unknown scale of the counts",
                "write gain = false, or leave it out",
            );
            return Err(found.at(source.place("unknown.gain")));
        }
        let environment: Vec<_> = root
            .read("environment", |entry| entry.items("[[environment]]")?.iter().map(light).collect())?
            .unwrap_or_default();
        if unknown.lighting_total.is_some() && environment.is_empty() {
            let found = Error::malformed("a total of no lighting", "write [[environment]], or leave it out");
            return Err(found.at(source.place("unknown.lighting_total")));
        }
        let cube = heat_cube(&cube, camera.is_some())?;
        let data = cube.data.clone();
        let scenario = Self {
            title: root.read("title", |entry| Ok(entry.text("\"What is in this street?\"")?.to_owned()))?,
            cube,
            bands: root.read("bands", BandsSpec::read)?,
            camera,
            environment,
            clusters: root.read("clusters", clusters)?.ok_or_else(|| missing("clusters"))?,
            emissivity: root.read("emissivity", emissivity)?.unwrap_or(EMISSIVITY),
            unknown,
            truth: root.read("truth", |entry| truth(entry, &data))?,
            source: Source::default(),
        };
        Ok(Self { source, ..scenario })
    }
}

fn clusters(entry: &Entry<'_>) -> Result<ClustersSpec> {
    let section = entry.section()?;
    let count = section.require("count")?;
    let one = |entry: &Entry<'_>| entry.count("6").map(|count| count as usize);
    let count = match count.is_list() {
        true => {
            let [low, high] = count.pair("[2, 12]")?;
            let [low, high] = [one(&low)?, one(&high)?];
            if low > high {
                let found = format!("from {low} to {high} clusters");
                return Err(count.fail(Error::malformed(found, format!("write count = [{high}, {low}]"))));
            }
            [low, high]
        }
        false => [one(&count)?; 2],
    };
    let max_emissivity = section.number("max_emissivity")?;
    Ok(ClustersSpec { count, max_emissivity: max_emissivity.unwrap_or(MAX_EMISSIVITY) })
}

fn emissivity(entry: &Entry<'_>) -> Result<Smoothness> {
    let section = entry.section()?;
    Ok(Smoothness {
        mean: section.number("mean")?.unwrap_or(EMISSIVITY.mean),
        magnitude: section.number("magnitude_error")?.unwrap_or(EMISSIVITY.magnitude),
        shape: section.number("shape_error")?.unwrap_or(EMISSIVITY.shape),
        correlation_cm1: section.quantity("correlation")?.unwrap_or(EMISSIVITY.correlation_cm1),
    })
}
