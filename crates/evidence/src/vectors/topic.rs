//! Vectors about one thing, and the files that they are written to.

use super::answer::Vector;
use super::json::Json;

/// The number of the answers. It rises when one changes beyond its tolerance, when inputs of a vector change, or when a vector
/// goes; vectors may be added without.
pub const VERSION: u32 = 2;

/// The number of the form of the files. It rises when a key goes or changes its meaning.
pub const SCHEMA: u32 = 1;

/// Vectors about one thing.
#[derive(Debug, Clone)]
pub struct Topic {
    /// Name of the file, without its ending.
    pub name: &'static str,
    /// What is asked.
    pub title: &'static str,
    /// Which faults of a program they tell of.
    pub catches: &'static str,
    /// The questions with their answers.
    pub vectors: Vec<Vector>,
    /// Files that the questions rest on, by name.
    pub files: Vec<(String, String)>,
}

impl Topic {
    /// How many answers its vectors have.
    #[must_use]
    pub fn answers(&self) -> usize {
        self.vectors.iter().map(|vector| vector.answers.len()).sum()
    }

    /// Its files with their content: the JSON, then what that rests on.
    #[must_use]
    pub fn written(&self) -> Vec<(String, String)> {
        let vectors = self.vectors.iter().map(Vector::json).collect();
        let json = Json::object([
            ("hadar", env!("CARGO_PKG_VERSION").into()),
            ("schema", f64::from(SCHEMA).into()),
            ("version", f64::from(VERSION).into()),
            ("topic", self.name.into()),
            ("title", self.title.into()),
            ("vectors", Json::List(vectors)),
        ]);
        let mut files = vec![(format!("{}.json", self.name), json.written())];
        files.extend(self.files.iter().cloned());
        files
    }
}
