//! Which materials a category is made of.

use crate::decompose::possible::MOST;
use hadar::error::{Error, Result};

/// The category of a pixel that has none.
pub const NO_CATEGORY: u8 = u8::MAX;
/// Categories at most.
pub const MOST_CATEGORIES: usize = MOST;

/// A material as a part of a category.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// Its place in the library.
    pub material: usize,
    /// Whether other parts of the category are around it (η = 1 in the paper).
    pub enclosed: bool,
}

impl Part {
    /// A material that may be on the outside.
    #[must_use]
    pub const fn open(material: usize) -> Self {
        Self { material, enclosed: false }
    }

    /// A material that is only within.
    #[must_use]
    pub const fn enclosed(material: usize) -> Self {
        Self { material, enclosed: true }
    }
}

/// A category that a material can be in, and whether it is enclosed there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Candidate {
    pub(super) category: u8,
    pub(super) enclosed: bool,
}

/// For every material the categories that it is a part of, in their order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Categories {
    of_material: Vec<Vec<Candidate>>,
    count: usize,
}

impl Categories {
    /// From the parts of every category, of a library of so many materials.
    ///
    /// # Errors
    /// A category without a part, or with a material twice or of another library; more than [`MOST_CATEGORIES`]. The index in the message
    /// is that of the category, from 0.
    pub fn new(materials: usize, categories: &[Vec<Part>]) -> Result<Self> {
        if categories.len() > MOST_CATEGORIES {
            let found = format!("{} categories", categories.len());
            return Err(Error::malformed(
                found,
                format!(
                    "write at most {MOST_CATEGORIES}, as each is a bit of the set that a pixel may be of"
                ),
            ));
        }
        let mut of_material = vec![Vec::new(); materials];
        for (category, parts) in categories.iter().enumerate() {
            let wrong = |found: &str, instead: &str| {
                let error = Error::malformed(found, instead);
                error.for_key(format!("category[{category}]"))
            };
            if parts.is_empty() {
                return Err(wrong("no material", "name a material, or leave the category out"));
            }
            let category = u8::try_from(category).unwrap_or(NO_CATEGORY);
            for part in parts {
                let candidates: &mut Vec<Candidate> =
                    of_material.get_mut(part.material).ok_or_else(|| {
                        let found = format!("material {} of {materials}", part.material);
                        wrong(&found, "count from 0 in the order of the library")
                    })?;
                if candidates.last().is_some_and(|last| last.category == category) {
                    return Err(wrong(
                        &format!("material {} stands in it twice", part.material),
                        "name it once",
                    ));
                }
                candidates.push(Candidate { category, enclosed: part.enclosed });
            }
        }
        Ok(Self { of_material, count: categories.len() })
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Whether a material can be a part of a category.
    #[must_use]
    pub fn contains(&self, category: u8, material: u16) -> bool {
        self.of(material).iter().any(|one| one.category == category)
    }

    /// The set of the categories of each material, a bit each ([`crate::decompose::possible`]); empty for a material that is in none.
    #[must_use]
    pub fn sets(&self) -> Vec<u64> {
        self.of_material.iter().map(|own| set(own)).collect()
    }

    /// What materials of exactly these categories can be a part of, if that is the same for all of them.
    pub(super) fn alike(&self, categories: u64) -> Option<&[Candidate]> {
        let mut own = self.of_material.iter().filter(|own| set(own) == categories);
        let first = own.next()?;
        own.all(|other| other == first).then_some(first.as_slice())
    }

    /// What a material can be a part of; nothing for no material, or one that is in no category.
    pub(super) fn of(&self, material: u16) -> &[Candidate] {
        self.of_material.get(usize::from(material)).map_or(&[], Vec::as_slice)
    }
}

fn set(candidates: &[Candidate]) -> u64 {
    candidates.iter().fold(0, |set, one| set | bit(one.category))
}

/// The bit of a category in a set.
pub(super) fn bit(category: u8) -> u64 {
    1_u64.checked_shl(category.into()).unwrap_or(0)
}
