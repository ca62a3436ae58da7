//! A text parsed once: what all readings of it share that differ by what is set.
//!
//! Values are set in the parsed document as they are in one that was parsed a moment ago, and everything is read from it anew, so that no
//! key has to be known here. What is no TOML is not kept: its message is that of the reading.
//!
//! A parsed document borrows its text, which therefore stays until the program ends: it is parsed once a job.

use super::reader::parse;
use super::report_inputs::ReportInputs;
use super::source::Source;
use super::written::Written;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use toml::de::DeTable;

/// A text that is TOML.
#[derive(Debug)]
pub(super) struct Parsed {
    text: &'static str,
    path: Option<PathBuf>,
    document: DeTable<'static>,
    lines: Arc<BTreeMap<String, usize>>,
    texts: Arc<BTreeMap<String, String>>,
    /// Of a scenario that a report wrote: where that has its files from.
    pub(super) report: Option<Arc<ReportInputs>>,
}

impl Parsed {
    pub(super) fn of(written: &Written) -> Option<Self> {
        let mut source = written.source();
        parse(&written.text, &source).ok()?;
        let text: &'static str = Box::leak(written.text.clone().into_boxed_str());
        let document = parse(text, &source).ok()?;
        source.note_lines(text, &document);
        Some(Self {
            text,
            path: written.path.clone(),
            document,
            lines: source.lines,
            texts: source.texts,
            report: source.report,
        })
    }

    /// Whether it is that of a text and file.
    pub(super) fn is_of(&self, written: &Written) -> bool {
        self.text == written.text && self.path == written.path
    }

    /// The document, and in `source` where its keys stand.
    pub(super) fn document(&self, source: &mut Source) -> DeTable<'_> {
        source.lines = Arc::clone(&self.lines);
        source.texts = Arc::clone(&self.texts);
        self.document.clone()
    }
}
