//! A text parsed once: what all readings of it share that differ by what is set.
//!
//! Values are set in the parsed document as they are in one that was parsed a moment ago, so that no key has to be known here. Read again
//! are the tables in which something is set; the others are kept as they were read ([`Kept`]). What is no TOML is not kept: its message is
//! that of the reading.
//!
//! A parsed document borrows its text, which therefore stays until the program ends: it is parsed once a job.

use super::kept::Kept;
use super::report_inputs::ReportInputs;
use super::source::{LineStarts, Source};
use super::stated_camera::StatedCamera;
use hadar::error::{Error, Result};
use hadar::instrument::figures::BLANK;
use hadar::units::decimal_comma;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toml::de::DeTable;

/// A text that is TOML.
#[derive(Debug)]
pub(super) struct Parsed {
    text: Arc<str>,
    path: Option<PathBuf>,
    document: DeTable<'static>,
    lines: Arc<BTreeMap<String, usize>>,
    texts: Arc<BTreeMap<String, String>>,
    /// Of a scenario that a report wrote: where that has its files from.
    pub(super) report: Option<Arc<ReportInputs>>,
    kept: Arc<Kept>,
    /// What else its tables were read by.
    by: (Option<PathBuf>, Arc<[StatedCamera]>, bool),
}

impl Parsed {
    /// The text of a file, whose places `source` says; none of what is no TOML.
    pub(super) fn of(text: &Arc<str>, path: Option<&Path>, mut source: Source) -> Option<Self> {
        parse(text, &source).ok()?;
        let kept: &'static str = Box::leak(text.to_string().into_boxed_str());
        let document = parse(kept, &source).ok()?;
        source.note_lines(kept, &document);
        Some(Self {
            text: Arc::clone(text),
            path: path.map(Path::to_owned),
            document,
            lines: source.lines,
            texts: source.texts,
            report: source.report,
            kept: Arc::default(),
            by: (source.inputs, source.cameras, source.files_refused),
        })
    }

    /// Whether it is that of a text and file.
    pub(super) fn is_of(&self, text: &Arc<str>, path: Option<&Path>) -> bool {
        self.text == *text && self.path.as_deref() == path
    }

    /// The document, and in `source` where its keys stand.
    pub(super) fn document(&self, source: &mut Source) -> DeTable<'_> {
        source.lines = Arc::clone(&self.lines);
        source.texts = Arc::clone(&self.texts);
        let (inputs, cameras, files_refused) = &self.by;
        let is_same = source.inputs == *inputs
            && Arc::ptr_eq(&source.cameras, cameras)
            && source.files_refused == *files_refused;
        // Files of a report are held against what it says of them each time.
        source.kept = (is_same && self.report.is_none()).then(|| Arc::clone(&self.kept));
        self.document.clone()
    }
}

/// The table behind the text, or the first thing that is not TOML.
pub(super) fn parse<'t>(text: &'t str, source: &Source) -> Result<DeTable<'t>> {
    let (document, errors) = DeTable::parse_recoverable(text);
    let offset = |error: &toml::de::Error| error.span().map_or(0, |span| span.start);
    let Some(first) = errors.iter().min_by_key(|error| offset(error)) else {
        return Ok(document.into_inner());
    };
    let message: String = first.message().chars().filter(|char| !char.is_control()).collect();
    let line = LineStarts::of(text).line(offset(first));
    if text.lines().nth(line - 1).is_some_and(|line| line.contains(BLANK)) {
        let error =
            Error::malformed(format!("`{BLANK}` stands for a figure"), "write the camera's own in its place");
        return Err(error.on_line(line).at(source.place("")));
    }
    // `f_number = 1,3`: a list of nothing, and a number.
    let value = text.lines().nth(line - 1).and_then(|line| line.split_once('=')).map(|(_, value)| value);
    if let Some(error) = value.and_then(|value| decimal_comma(value.split('#').next().unwrap_or(value))) {
        return Err(error.on_line(line).at(source.place("")));
    }
    let error = Error::malformed(
        format!("this is not TOML: {message}"),
        match message.as_str() {
            "duplicate key" => "write each key and each [table] once",
            _ => "correct the line (a quantity is text in quotes, as in temperature = \"37 degC\")",
        },
    );
    Err(error.on_line(line).at(source.place("")))
}
