//! Where the numbers of a rule are from: a clause of a document in its own words, or a choice with its reason.
//!
//! A rule that names any source (`[[source]]`) names one for each of its figures: a number that is nobody's is refused when the
//! rule is read. Figures are all values in the tables of the scenes, the demands, `[stop]` and the clauses; names, wording
//! and tests are none. A camera's own figures (`camera[0].netd`, or `camera[0]` for all of them) may have a source, and need none; those of a
//! known camera have the documents of that.

use crate::Source;
use crate::entries::Entries;
use crate::section::{Entry, Section};
use crate::source::dotted;
use hadar::error::{Error, Result};
use serde::{Serialize, Serializer};
use toml::de::{DeTable, DeValue};
use toml::value::Date;

/// Tables and keys at the top of a rule that hold no figures of its own.
const NO_FIGURES: &[&str] = &["title", "cameras", "rule", "camera", "source", "test", "find", "reform"];
/// Keys of a camera that are no figures of it.
const NO_FIGURES_OF_CAMERA: &[&str] = &["name", "preset", "share"];
/// The same of a clause.
const NO_FIGURES_OF_CLAUSE: &[&str] = &["name", "kind", "text"];

/// The source of some figures of a rule (`[[source]]`).
#[derive(Debug, Clone, PartialEq)]
pub struct Citation {
    /// Keys of the figures, or of tables with all their figures, e.g. `stop.latency` or `clause[1].operating envelope`.
    pub keys: Vec<String>,
    /// The document or choice on which the figures are based.
    pub ground: Ground,
}

/// A document, or a choice.
#[derive(Debug, Clone, PartialEq)]
pub enum Ground {
    /// A document says so.
    Document {
        /// Title of the document, as it is cited.
        document: String,
        /// Clause or page of the document.
        clause: String,
        /// The words of the document, quoted.
        quote: String,
        /// Date of the document or of the choice.
        date: Date,
        /// How the document was read, as a mark.
        mark: Mark,
    },
    /// Nobody says so but the author of the rule, for this reason.
    Choice(String),
}

hadar::named! {
    /// How a document was read.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Mark {
        /// In the text itself.
        Seen = "seen",
        /// In an excerpt or abstract.
        Excerpt = "excerpt",
        /// In somebody's copy or summary, not the issuer's; a summary's words are quoted then.
        Copy = "copy",
        /// From memory.
        Recalled = "recalled",
        /// Computed from numbers that were seen.
        Computed = "computed",
    }
    /// The name in a rule, e.g. `seen`.
    name
}

impl Citation {
    /// Whether it stands behind the figure at `key`.
    #[must_use]
    pub fn covers(&self, key: &str) -> bool {
        self.keys.iter().any(|own| within(key, own))
    }

    fn entries(&self) -> Entries {
        Entries::default().put("keys", self.keys.clone()).and(self.ground.entries())
    }
}

impl Ground {
    pub(super) fn entries(&self) -> Entries {
        match self {
            Self::Document { document, clause, quote, date, mark } => Entries::default()
                .put("document", document.as_str())
                .put("clause", clause.as_str())
                .put("quote", quote.as_str())
                .put("date", date.to_string())
                .put("mark", mark.name()),
            Self::Choice(reason) => Entries::default().put("choice", reason.as_str()),
        }
    }
}

/// The keys that it has in a rule.
impl Serialize for Ground {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        self.entries().serialize(serializer)
    }
}

/// The keys that it has in a rule.
impl Serialize for Citation {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        self.entries().serialize(serializer)
    }
}

/// Whether `key` is `own`, or stands in it.
fn within(key: &str, own: &str) -> bool {
    key.strip_prefix(own).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

/// The sources of a rule, every key in them checked against the file.
pub(super) fn read(root: &Section<'_>) -> Result<Vec<Citation>> {
    let source = root.source();
    let Some(entry) = root.get("source") else { return Ok(Vec::new()) };
    let items = entry.items("each source as [[source]], in double brackets")?;
    let citations: Vec<Citation> = items.iter().map(|item| one(item, source)).collect::<Result<_>>()?;
    let keys = figures(root.document()).into_iter().map(|(_, key)| key);
    // Who sets a value says so in the answer.
    let is_set = |key: &String| source.settings.iter().any(|set| set.covers(key));
    let untagged = keys.into_iter().find(|key| !is_set(key) && !citations.iter().any(|one| one.covers(key)));
    if let Some(key) = untagged {
        let instead = format!(
            "name `{key}` in the keys of a [[source]], with document, clause, quote, date and mark, or with choice = \"why\""
        );
        return Err(Error::malformed("the figure has no source", instead).at(source.place(&key)));
    }
    Ok(citations)
}

fn one(item: &Entry<'_>, source: &Source) -> Result<Citation> {
    let section = item.section()?;
    let example = "[\"stop.latency\"]";
    let keys = section.require("keys")?;
    let items = keys.items(&format!("keys = {example}"))?;
    if items.is_empty() {
        return Err(keys.fail(Error::malformed("the list is empty", format!("write keys = {example}"))));
    }
    let keys = items
        .iter()
        .map(|item| {
            let key = item.text("\"stop.latency\"")?.trim();
            // What is set over the file stands on no line of it.
            let is_set =
                source.settings.iter().any(|set| set.covers(key) || set.is_in(key) || within(&set.key, key));
            if source.line(key).is_some() || is_set {
                return Ok(key.to_owned());
            }
            let known = source.lines.keys().map(String::as_str);
            Err(item.fail(Error::unknown_name("key of this file", key, known)))
        })
        .collect::<Result<_>>()?;
    Ok(Citation { keys, ground: ground(&section)? })
}

/// What stands behind something: a document with the keys for it, or a choice.
pub(super) fn ground(section: &Section<'_>) -> Result<Ground> {
    for key in ["document", "clause", "quote", "date", "mark"] {
        section.at_most_one(&["choice", key])?;
    }
    if let Some(reason) = section.read("choice", |entry| entry.name("\"why\""))? {
        return Ok(Ground::Choice(reason));
    }
    let text = |key, example| section.require(key)?.name(example);
    let marks = Mark::ALL.map(|mark| (mark.name(), mark));
    Ok(Ground::Document {
        document: text("document", "\"49 CFR 571.127\"")?,
        clause: text("clause", "\"S8.2\"")?,
        quote: text("quote", "\"its own words\"")?,
        date: section.require("date")?.date()?,
        mark: section.require("mark")?.choice(&marks)?,
    })
}

/// A figure of a rule as its file has it.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Figure {
    /// Key of the figure, as a path in the file.
    pub key: String,
    /// Its value as it is written.
    pub value: String,
    /// Number of the line of the file that states the figure.
    pub line: usize,
}

impl Figure {
    /// That of a key with a value as it is written, on no line.
    #[must_use]
    pub fn new(key: &str, value: &str) -> Self {
        Self { key: key.to_owned(), value: value.to_owned(), line: 0 }
    }
}

/// All figures in the text of a rule.
pub(super) fn of(source: &Source) -> Vec<Figure> {
    written(source, figures)
}

/// The figures of a camera's own in the text of a rule, by where the camera stands in it.
pub(super) fn of_camera(source: &Source, key: &str) -> Vec<Figure> {
    if let Some(setting) = source.setting(key) {
        return vec![Figure::new(key, &setting.value)];
    }
    let mut found = written(source, |document| {
        let mut found = Vec::new();
        if let Some(DeValue::Array(items)) = document.get("camera").map(toml::Spanned::get_ref) {
            let tables = items.iter().enumerate().map(|(index, item)| (format!("camera[{index}]"), item));
            for (_, item) in tables.filter(|(own, _)| own == key) {
                if let DeValue::Table(inner) = item.get_ref() {
                    for (name, value) in inner
                        .iter()
                        .filter(|(name, _)| !NO_FIGURES_OF_CAMERA.contains(&name.get_ref().as_ref()))
                    {
                        found.push((value.span(), dotted(key, name.get_ref())));
                    }
                }
            }
        }
        found.sort_by_key(|(span, _)| span.start);
        found
    });
    for set in &source.settings {
        let name = set.key.strip_prefix(key).and_then(|rest| rest.strip_prefix('.')).unwrap_or_default();
        let is_new = !found.iter().any(|figure| set.covers(&figure.key) || set.is_in(&figure.key));
        if is_new && !name.is_empty() && !NO_FIGURES_OF_CAMERA.contains(&name) {
            found.push(Figure::new(&set.key, &set.value));
        }
    }
    found
}

fn written(source: &Source, figures: impl Fn(&DeTable<'_>) -> Vec<(Span, String)>) -> Vec<Figure> {
    let text = &source.text;
    let (document, _) = DeTable::parse_recoverable(text);
    let figure = |(span, key): (Span, String)| {
        let own = || text.get(span).unwrap_or_default().split_whitespace().collect::<Vec<_>>().join(" ");
        // What is set over the file stands there.
        let value = source.setting(&key).map_or_else(own, |setting| setting.value.clone());
        Figure { value, line: source.place(&key).line.unwrap_or_default(), key }
    };
    figures(document.get_ref()).into_iter().map(figure).collect()
}

/// Where the value of a figure stands in the text.
type Span = std::ops::Range<usize>;

/// All figures of a rule with their values, in the order of its file.
fn figures(document: &DeTable<'_>) -> Vec<(Span, String)> {
    let mut found = Vec::new();
    table(document, "", NO_FIGURES, &mut found);
    found.sort_by_key(|(span, _)| span.start);
    found
}

fn table(entries: &DeTable<'_>, name: &str, other: &[&str], found: &mut Vec<(Span, String)>) {
    let own = entries.iter().filter(|(key, _)| !other.contains(&key.get_ref().as_ref()));
    for (key, value) in own {
        let full = dotted(name, key.get_ref());
        match value.get_ref() {
            DeValue::Table(inner) => table(inner, &full, &[], found),
            DeValue::Array(items) if items.iter().any(|item| matches!(item.get_ref(), DeValue::Table(_))) => {
                let other =
                    if ["clause", "grid"].contains(&full.as_str()) { NO_FIGURES_OF_CLAUSE } else { &[] };
                for (index, item) in items.iter().enumerate() {
                    if let DeValue::Table(inner) = item.get_ref() {
                        table(inner, &format!("{full}[{index}]"), other, found);
                    }
                }
            }
            _ => found.push((value.span(), full)),
        }
    }
}
