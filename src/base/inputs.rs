//! What a job reads, noted where it is read, so that no list of it can forget a file.
//!
//! Who asks opens a list on its thread; readers of files note their path, what is built in is noted with its content. Where no
//! list is open nothing is noted. Readers read on the thread that asks, never in parallel.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::marker::PhantomData;
use std::path::{Path, PathBuf};

thread_local! {
    static OPEN: RefCell<Option<Inputs>> = const { RefCell::new(None) };
}

/// What was read.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Inputs {
    /// Files, in the order they were first read, as they were named.
    pub files: Vec<PathBuf>,
    /// Content of what is built in, by kind and name (`material`, `skin`).
    pub built_in: BTreeMap<(&'static str, String), Vec<u8>>,
}

/// A list that is open on this thread until it is dropped.
#[derive(Debug)]
#[must_use]
pub struct Noting(PhantomData<*const ()>);

impl Noting {
    /// Begins an empty list.
    pub fn open() -> Self {
        OPEN.set(Some(Inputs::default()));
        Self(PhantomData)
    }

    /// What was read since.
    #[must_use]
    pub fn so_far(&self) -> Inputs {
        so_far()
    }
}

impl Drop for Noting {
    fn drop(&mut self) {
        OPEN.set(None);
    }
}

/// What was read since a list was opened on this thread; nothing where none is open.
#[must_use]
pub fn so_far() -> Inputs {
    OPEN.with_borrow(|open| open.clone().unwrap_or_default())
}

/// A file was read.
pub fn file(path: &Path) {
    OPEN.with_borrow_mut(|open| {
        if let Some(inputs) = open
            && !inputs.files.iter().any(|known| known == path)
        {
            inputs.files.push(path.to_owned());
        }
    });
}

/// Something built in was used. `content` is what it consists of, and changes when that does and not with its neighbours.
pub(crate) fn built_in(kind: &'static str, name: &str, content: impl FnOnce() -> Vec<u8>) {
    OPEN.with_borrow_mut(|open| {
        if let Some(inputs) = open {
            inputs.built_in.entry((kind, name.to_owned())).or_insert_with(content);
        }
    });
}

#[cfg(all(test, feature = "library"))]
mod tests {
    use super::*;
    use crate::material::Library;

    #[test]
    fn what_is_used_is_noted_with_what_it_is_made_of() {
        let noting = Noting::open();
        let library = Library::embedded().unwrap();
        assert_eq!(noting.so_far(), Inputs::default());
        library.get("brass-rough").unwrap();
        crate::instrument::presets::get("ideal-pnrd").unwrap();
        crate::atmosphere::Atmosphere::embedded("tropical").unwrap();
        let found = noting.so_far();
        let names: Vec<_> = found.built_in.keys().map(|(kind, name)| format!("{kind} {name}")).collect();
        assert_eq!(names, ["air tropical", "camera ideal-pnrd", "material brass-rough"]);
        // Its own entry, that of the brass it is made of, and the constants of that, not those of others.
        let content = &found.built_in[&("material", "brass-rough".to_owned())];
        let content = String::from_utf8(content.clone()).unwrap();
        assert!(
            content.contains("name = \"brass-rough\"") && content.contains("name = \"brass\""),
            "{content}"
        );
        assert!(content.contains("n,k") || content.lines().count() > 50, "{content}");
        assert!(!content.contains("name = \"iron\""));
        drop(noting);
        library.get("gold").unwrap();
        assert_eq!(so_far(), Inputs::default());
    }
}
