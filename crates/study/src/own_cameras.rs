//! Cameras of one's own, looked up by name as those of the program are.

use super::camera;
use hadar::error::{Error, Result};
use hadar::instrument::presets::{self, Preset};
use hadar_scenario::cameras::StatedCameras;
use hadar_scenario::{StatedCamera, Written};
use std::path::{Path, PathBuf};

/// The cameras of some files.
#[derive(Debug, Clone, Default)]
pub struct OwnCameras {
    /// As they are stated.
    pub stated: Vec<StatedCamera>,
    /// As they are shown: with what they lie over, and the file that each is of.
    pub presets: Vec<Preset>,
}

impl OwnCameras {
    /// Reads files.
    ///
    /// # Errors
    /// A mistake in a file; a name that another camera has, of the program or of the files; figures that make no camera.
    pub fn from_files(files: &[PathBuf]) -> Result<Self> {
        let mut known = Self::default();
        files.iter().try_for_each(|file| known.add(file))?;
        Ok(known)
    }

    fn add(&mut self, file: &Path) -> Result<()> {
        let read = StatedCameras::from_written(&Written::from_file(file)?)?;
        for (index, own) in read.cameras.iter().enumerate() {
            let place = |key: &str| read.place(index, key);
            let taken = |others: &[Preset]| others.iter().any(|other| other.name == own.name);
            let found = match () {
                () if own.name.is_empty() => Some("the name is empty".to_owned()),
                () if taken(presets::all()?) => Some(format!("the program has a camera `{}`", own.name)),
                () if taken(&self.presets) => Some(format!("another camera is called `{}` too", own.name)),
                () => None,
            };
            if let Some(found) = found {
                return Err(Error::malformed(found, "give it a name of its own").at(place("name")));
            }
            let figures = camera::stated_at(&own.spec, &place)?;
            if let Ok(camera) = figures.camera() {
                camera::checked_at(camera, &place)?;
            }
            self.presets.push(Preset {
                name: own.name.clone(),
                description: own.description.clone(),
                document: own.document.clone(),
                provenance: own.provenance.clone(),
                kind: own.kind.or(figures.kind),
                price: own.price.clone(),
                price_without_lens: None,
                price_source: None,
                sold: None,
                file: Some(file.display().to_string()),
                ..figures
            });
            self.stated.push(own.clone());
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<Preset>> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("my.toml");
        std::fs::write(&file, text).unwrap();
        OwnCameras::from_files(&[file]).map(|own| own.presets)
    }

    #[test]
    fn a_camera_of_a_file_has_its_figures_and_those_of_the_one_that_it_lies_over() {
        let text = "[[camera]]\nname = \"ours\"\npreset = \"flir-a325sc\"\nexposure = \"5 ms\"\n[[camera]]\nname = \"bare\"\npixel = \"12 um\"\n";
        let cameras = read(text).unwrap();
        assert_eq!((cameras[0].figures.exposure_s, cameras[0].figures.f_number), (Some(5e-3), Some(1.3)));
        assert!(cameras[0].camera().is_ok() && cameras[1].camera().is_err());
        for (old, new, said) in [
            ("\"bare\"", "\"flir-a325sc\"", ":6: camera[1].name: the program has a camera `flir-a325sc`"),
            ("\"bare\"", "\"ours\"", ":6: camera[1].name: another camera is called `ours` too"),
            ("pixel =", "pixl =", ":7: camera[1]: there is no key `pixl`"),
            ("\"12 um\"", "12", ":7: camera[1].pixel: `12` is a number without a unit"),
            ("\"flir-a325sc\"", "\"flir-a325s\"", ":3: camera[0].preset: there is no camera `flir-a325s`"),
            ("name = \"bare\"\n", "", "camera[1].name"),
        ] {
            let error = read(&text.replace(old, new)).unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
    }
}
