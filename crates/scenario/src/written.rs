//! A file as it is to be read: its text, where it is from, and the values that stand in the place of its own.

use super::parsed::Parsed;
use super::report_inputs::ReportInputs;
use super::setting::Setting;
use super::source::Source;
use super::stated_camera::StatedCamera;
use hadar::error::{Error, Result};
use hadar_formats::file;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The longest file taken for a scenario, bytes.
const LONGEST_FILE: u64 = 1 << 20;
const ACTION: &str = "read the scenario";

/// What stands for the file of a text from standard input.
pub const STDIN: &str = "<stdin>";

/// A file as it is to be read.
#[derive(Debug, Clone, Default)]
pub struct Written {
    /// Its text, which all that is read of it shares.
    pub text: Arc<str>,
    /// The file, `None` for text from elsewhere.
    pub path: Option<PathBuf>,
    /// The folder that its relative paths start from, if that is not its own.
    pub inputs: Option<PathBuf>,
    /// What stands in the place of its own values, the last one of a key.
    pub settings: Vec<Setting>,
    /// Cameras of the user's own, which it may name.
    pub cameras: Arc<[StatedCamera]>,
    /// Whether it may name files: a text of a stranger may not.
    pub files_refused: bool,
    /// Its text parsed, for many readings that differ by what is set.
    parsed: Option<Arc<Parsed>>,
}

impl Written {
    /// The text of a file.
    ///
    /// # Errors
    /// A file that is missing, a directory, too long, or not UTF-8.
    pub fn from_file(path: &Path) -> Result<Self> {
        if path.is_dir() {
            return Err(Error::file(ACTION, path, "it is a directory; name the .toml file inside it"));
        }
        Self::of_bytes(file::bytes(path, ACTION, LONGEST_FILE)?, path)
    }

    /// The text of standard input; paths in it start from the current directory.
    ///
    /// # Errors
    /// What cannot be read, is too long, or not UTF-8.
    pub fn from_stdin(stdin: impl Read) -> Result<Self> {
        Self::of_bytes(file::stream(stdin, STDIN, ACTION, LONGEST_FILE)?, Path::new(STDIN))
    }

    fn of_bytes(bytes: Vec<u8>, path: &Path) -> Result<Self> {
        let text = String::from_utf8(bytes).map_err(|error| {
            let valid = error.utf8_error().valid_up_to();
            let line = 1 + error.as_bytes().iter().take(valid).filter(|byte| **byte == b'\n').count();
            Error::malformed("the file is not UTF-8 text", "name a TOML file, saved as UTF-8")
                .on_line(line)
                .in_file(path)
        })?;
        Ok(Self::of(&text, Some(path)))
    }

    /// A text, of the file `path` if it is from one.
    #[must_use]
    pub fn of(text: &str, path: Option<&Path>) -> Self {
        Self { text: text.into(), path: path.map(Path::to_owned), ..Self::default() }
    }

    /// The same with values in the place of its own.
    ///
    /// ```
    /// use hadar_scenario::{Scenario, Setting, Written};
    /// let text = "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"";
    /// let set = |key: &str, value: &str| Setting { key: key.into(), value: value.into(), by: "--set" };
    /// let written = Written::of(text, None).with([set("target.temperature", "20 degC")]);
    /// assert_eq!(Scenario::from_written(&written)?.target.temperature_k, 293.15);
    ///
    /// let error = Scenario::from_written(&written.with([set("target.distance", "5 kg")])).unwrap_err();
    /// assert!(error.to_string().starts_with("--set target.distance: `kg` is not a unit of length"), "{error}");
    /// # Ok::<(), hadar::Error>(())
    /// ```
    #[must_use]
    pub fn with(&self, settings: impl IntoIterator<Item = Setting>) -> Self {
        let settings = self.settings.iter().cloned().chain(settings).collect();
        Self { settings, ..self.clone() }
    }

    /// The same, parsed once for all readings that differ by what is set ([`Written::with`]); each reads what it would have read.
    ///
    /// ```
    /// use hadar_scenario::{Scenario, Setting, Written};
    /// let text = "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"";
    /// let (once, anew) = (Written::of(text, None).parsed(), Written::of(text, None));
    /// for value in ["20 degC", "20 kg"] {
    ///     let set = [Setting { key: "target.temperature".into(), value: value.into(), by: "--vary" }];
    ///     let read = |written: &Written| Scenario::from_written(&written.with(set.clone()));
    ///     assert_eq!(read(&once), read(&anew));
    /// }
    /// ```
    #[must_use]
    pub fn parsed(self) -> Self {
        let parsed = Parsed::of(&self.text, self.path.as_deref(), self.source()).map(Arc::new);
        Self { parsed, ..self }
    }

    /// Its text parsed before, if it is still that text of that file.
    pub(super) fn parsed_before(&self) -> Option<&Parsed> {
        self.parsed.as_deref().filter(|parsed| parsed.is_of(&self.text, self.path.as_deref()))
    }

    /// The same with cameras of the user's own that it may name.
    #[must_use]
    pub fn with_cameras(self, cameras: Arc<[StatedCamera]>) -> Self {
        Self { cameras, ..self }
    }

    /// The same, whose relative paths start from a folder, if one is given.
    #[must_use]
    pub fn with_inputs(self, inputs: Option<PathBuf>) -> Self {
        Self { inputs, ..self }
    }

    /// The same, which may name no file of this machine: one that does is refused before anything is looked for.
    ///
    /// ```
    /// use hadar_scenario::{Scenario, Written};
    /// let text = "[target]\nmaterial = \"/etc/skin.csv\"\ntemperature = \"37 degC\"";
    /// let error = Scenario::from_written(&Written::of(text, None).refusing_files()).unwrap_err();
    /// assert!(error.to_string().contains("no files are read here"), "{error}");
    /// ```
    #[must_use]
    pub fn refusing_files(self) -> Self {
        Self { files_refused: true, ..self }
    }

    /// Where it is read from, before anything is read.
    pub(super) fn source(&self) -> Source {
        let (path, settings, cameras) = (self.path.clone(), self.settings.clone(), Arc::clone(&self.cameras));
        let report = match self.parsed_before() {
            Some(parsed) => parsed.report.clone(),
            None => path.as_deref().and_then(ReportInputs::beside).map(Arc::new),
        };
        Source {
            report,
            path,
            inputs: self.inputs.clone(),
            text: Arc::clone(&self.text),
            settings,
            cameras,
            files_refused: self.files_refused,
            ..Source::default()
        }
    }
}
