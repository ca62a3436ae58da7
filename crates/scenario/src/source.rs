//! Where a scenario was read from: its file, the directory of its relative paths, the line of each key.

use std::collections::BTreeMap;
use std::ops::Bound;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use toml::de::{DeTable, DeValue};

use super::kept::Kept;
use super::report_inputs::ReportInputs;
use super::setting::Setting;
pub(super) use super::setting::dotted;
use super::stated_camera::StatedCamera;
use hadar::error::{Place, Result};
use hadar::instrument::CameraSpec;

/// Longest name of a table or list whose entries are noted, bytes. No scenario needs as much, and names of entries
/// repeat it: a long one with a long list would fill the memory.
const LONGEST_NAME: usize = 100;

/// Longest text that is noted, bytes: longer ones are no quantities.
const LONGEST_TEXT: usize = 40;

/// Where a scenario was read from.
#[derive(Debug, Clone, Default)]
pub struct Source {
    /// The scenario file as it was named, `None` for text from elsewhere.
    pub path: Option<PathBuf>,
    /// The folder that its relative paths start from, if that is not its own.
    pub inputs: Option<PathBuf>,
    /// Of a scenario that a report wrote: where that has its files from.
    pub(super) report: Option<Arc<ReportInputs>>,
    /// Its text.
    pub text: Arc<str>,
    /// Line of each key of the file, e.g. `target.material` or `environment[0].lighting`.
    pub lines: Arc<BTreeMap<String, usize>>,
    /// Short texts of the file, among them all quantities, as they were written, e.g. `37 degC` at `target.temperature`.
    pub texts: Arc<BTreeMap<String, String>>,
    /// What settings leave of these keys, which all readings of a file share: a text, or nothing; none of them has a line.
    pub(super) over: BTreeMap<String, Option<String>>,
    /// Keys under which something stands that messages know by another: what a clause calls `things` is looked up as
    /// `envelope.materials`.
    pub(super) called: Vec<(&'static str, &'static str)>,
    /// What stands in the place of its own values.
    pub settings: Vec<Setting>,
    /// Cameras of the user's own, which it may name.
    pub cameras: Arc<[StatedCamera]>,
    /// Whether it may name files.
    pub files_refused: bool,
    /// Its cameras by their keys as the file states them, where values stand in the place of figures that a noise is stated for.
    pub(super) filed: BTreeMap<String, Arc<CameraSpec>>,
    /// Of a text that is read many times: its tables in which nothing is set.
    pub(super) kept: Option<Arc<Kept>>,
}

impl Source {
    /// The directory that relative paths of the scenario start from; empty for the current one.
    #[must_use]
    pub fn directory(&self) -> &Path {
        self.inputs.as_deref().unwrap_or_else(|| self.own_directory())
    }

    fn own_directory(&self) -> &Path {
        self.path.as_deref().and_then(Path::parent).unwrap_or(Path::new(""))
    }

    /// Where a file is that the scenario names.
    ///
    /// # Errors
    /// One of a report that is not there as the report has read it.
    pub(super) fn located(&self, name: &str) -> Result<PathBuf> {
        match &self.report {
            Some(report) => report.located(name, self.own_directory(), self.inputs.as_deref()),
            None => Ok(self.directory().join(name)),
        }
    }

    /// Where `key` stands; see [`super::Scenario::place`].
    #[must_use]
    pub fn place(&self, key: &str) -> Place {
        let own =
            self.called.iter().find_map(|(known, own)| Some(format!("{own}{}", key.strip_prefix(known)?)));
        let key = own.as_deref().unwrap_or(key);
        if let Some(place) = self.set_at(key) {
            return place;
        }
        let mut known = key;
        let line = loop {
            match self.line(known) {
                Some(line) => break Some(line),
                None => match known.rfind(['.', '[']) {
                    Some(end) => known = known.get(..end).unwrap_or_default(),
                    None => break None,
                },
            }
        };
        let key = (!key.is_empty()).then(|| key.to_owned());
        Place { path: self.path.clone(), line, key }
    }

    /// What is stated of the user's own camera of a name.
    pub(super) fn own_camera(&self, name: &str) -> Option<Arc<CameraSpec>> {
        self.cameras.iter().find(|camera| camera.name == name).map(|camera| Arc::new(camera.spec.clone()))
    }

    /// Whether anything is set at `key` or in what stands there.
    pub(super) fn is_set_in(&self, key: &str) -> bool {
        self.settings.iter().any(|setting| setting.covers(key) || setting.is_in(key))
    }

    /// Whether the file or a setting over it says anything at `key`.
    #[must_use]
    pub fn states(&self, key: &str) -> bool {
        self.line(key).is_some() || self.is_set_in(key)
    }

    /// The line of a key that the file has and nothing is set over.
    #[must_use]
    pub fn line(&self, key: &str) -> Option<usize> {
        self.lines.get(key).copied().filter(|_| !self.over.contains_key(key))
    }

    /// What stands at `key` in the place of what was written.
    pub(super) fn setting(&self, key: &str) -> Option<&Setting> {
        self.settings.iter().rev().find(|setting| setting.covers(key))
    }

    /// Where it was set what stands at `key`; a table that the file has not was made by the setting of a key in it.
    pub(super) fn set_at(&self, key: &str) -> Option<Place> {
        let made = || self.settings.iter().find(|setting| setting.is_in(key));
        match self.setting(key) {
            Some(setting) => Some(setting.place(key)),
            None if self.line(key).is_some() => None,
            None => made().map(|setting| setting.place(&setting.key)),
        }
    }

    /// The short text at `key` as it was written.
    #[must_use]
    pub fn written(&self, key: &str) -> Option<&str> {
        match self.over.get(key) {
            Some(set) => set.as_deref(),
            None => self.texts.get(key).map(String::as_str),
        }
    }

    /// Lines and texts with what is set among them, for who gives them other keys.
    pub(super) fn with_settings_among(&mut self) {
        for (key, text) in std::mem::take(&mut self.over) {
            Arc::make_mut(&mut self.lines).remove(&key);
            let texts = Arc::make_mut(&mut self.texts);
            match text {
                Some(text) => drop(texts.insert(key, text)),
                None => drop(texts.remove(&key)),
            }
        }
    }

    /// Notes the line of every key and list item of a parsed `text`.
    pub(super) fn note_lines(&mut self, text: &str, root: &DeTable<'_>) {
        let starts = LineStarts::of(text);
        self.note_table(Some(&starts), "", root);
    }

    /// Notes the texts of a value that stands in the place of one of the file, whose lines and texts hold no more.
    pub(super) fn note_setting(&mut self, setting: &Setting) {
        let from = || (Bound::Included(setting.key.as_str()), Bound::Unbounded);
        let is_near = |key: &&String| key.starts_with(&setting.key);
        let lines = self.lines.range::<str, _>(from()).map(|(key, _)| key).take_while(is_near);
        let texts = self.texts.range::<str, _>(from()).map(|(key, _)| key).take_while(is_near);
        for key in lines.chain(texts).filter(|key| setting.covers(key)) {
            self.over.insert(key.clone(), None);
        }
        self.over.iter_mut().filter(|(key, _)| setting.covers(key)).for_each(|(_, text)| *text = None);
        self.note_value(None, &setting.key, &setting.toml());
    }

    fn note_table(&mut self, starts: Option<&LineStarts>, name: &str, table: &DeTable<'_>) {
        for (key, value) in table {
            let full = dotted(name, key.get_ref());
            self.note_line(starts, &full, key.span().start);
            self.note_value(starts, &full, value.get_ref());
        }
    }

    fn note_line(&mut self, starts: Option<&LineStarts>, name: &str, offset: usize) {
        if let Some(starts) = starts {
            Arc::make_mut(&mut self.lines).insert(name.to_owned(), starts.line(offset));
        }
    }

    fn note_value(&mut self, starts: Option<&LineStarts>, name: &str, value: &DeValue<'_>) {
        match value {
            _ if name.len() > LONGEST_NAME => {}
            DeValue::String(text) if text.len() <= LONGEST_TEXT => {
                let (name, text) = (name.to_owned(), text.trim().to_owned());
                match starts {
                    Some(_) => drop(Arc::make_mut(&mut self.texts).insert(name, text)),
                    None => drop(self.over.insert(name, Some(text))),
                }
            }
            DeValue::Table(table) => self.note_table(starts, name, table),
            DeValue::Array(items) => {
                for (index, item) in items.iter().enumerate() {
                    let full = format!("{name}[{index}]");
                    self.note_line(starts, &full, item.span().start);
                    self.note_value(starts, &full, item.get_ref());
                }
            }
            _ => {}
        }
    }
}

/// The byte at which each line of a text begins.
pub(super) struct LineStarts(Vec<usize>);

impl LineStarts {
    pub(super) fn of(text: &str) -> Self {
        let breaks = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n').map(|(at, _)| at + 1);
        Self(std::iter::once(0).chain(breaks).collect())
    }

    /// Line, from 1, of a byte offset.
    pub(super) fn line(&self, offset: usize) -> usize {
        self.0.partition_point(|start| *start <= offset)
    }
}
