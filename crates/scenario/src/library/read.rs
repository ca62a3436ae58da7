//! Reads what a library is to be made from: every key checked, every error one line with file, line and key.

use super::super::decompose::read::{air, heat_cube, light, no_air_without, truth, unknown};
use super::super::decompose::{PixelUnknown, SharedUnknown};
use super::super::keys::files;
use super::super::kind::Kind;
use super::super::reader::file;
use super::super::section::{Entry, Section};
use super::super::{BandsSpec, Source, camera};
use super::{ClustersSpec, EMISSIVITY, LibraryScenario};
use hadar::error::{Error, Result};
use hadar::fisher::emissivity::Smoothness;
use hadar_formats::cube::is_called_so as is_cube;
use std::path::Path;

const MINIMUM: &str =
    "write [cube] with data = \"counts.npy\", [bands], [[environment]], and [clusters] with count = 6";
const MAX_EMISSIVITY: f64 = 0.99;

file!(LibraryScenario, source, (Kind::Library, MINIMUM, &files::LIBRARY));

impl LibraryScenario {
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

    fn of_root(root: &Section<'_>) -> Result<Self> {
        let camera = root.read_once("camera", camera::read)?;
        let cube = root.table("cube", MINIMUM)?;
        let unknown = root.read("unknown", unknown)?.unwrap_or(PixelUnknown::default());
        if unknown.gain {
            let found = Error::malformed(
                "no emissivity can be distinguished from an unknown scale of the counts",
                "write gain = false, or leave it out",
            );
            return Err(found.at(root.source().place("unknown.gain")));
        }
        let atmosphere = root.read("atmosphere", air)?;
        no_air_without(root, &unknown, atmosphere.is_some())?;
        let SharedUnknown { missing_light, noise_scale, .. } = unknown.shared;
        let absent = [("missing_light", missing_light), ("noise_scale", noise_scale)];
        if let Some((key, _)) = absent.into_iter().find(|(_, sigma)| sigma.is_some()) {
            let found = "an unknown that is not put into emissivities";
            let instead = "leave it out, or decompose the cube with a library that is there";
            return Err(root.fail(&format!("unknown.{key}"), Error::malformed(found, instead)));
        }
        let environment: Vec<_> = root
            .read("environment", |entry| entry.items("[[environment]]")?.iter().map(light).collect())?
            .unwrap_or_default();
        if unknown.lighting_total.is_some() && environment.is_empty() {
            let found = Error::malformed("a total of no lighting", "write [[environment]], or leave it out");
            return Err(found.at(root.source().place("unknown.lighting_total")));
        }
        let cube = heat_cube(&cube, camera.is_some())?;
        let data = cube.data.clone();
        Ok(Self {
            title: root.title("\"What is in this street?\"")?,
            cube,
            bands: root.read_once("bands", BandsSpec::read)?,
            camera,
            atmosphere,
            environment,
            clusters: clusters(&root.table("clusters", MINIMUM)?)?,
            emissivity: root.read("emissivity", emissivity)?.unwrap_or(EMISSIVITY),
            unknown,
            truth: root.read("truth", |entry| truth(entry, &data))?,
            source: Source::default(),
        })
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
