//! What a job reads, noted where it is read, so that no list of it can forget a file.
//!
//! Who asks opens a list on its thread; readers of files note their path with what they read of it, what is built in is noted with its
//! content. Where no
//! list is open nothing is noted. Readers read on the thread that asks, never in parallel.

use std::cell::RefCell;
use std::collections::{BTreeMap, HashSet};
use std::marker::PhantomData;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

thread_local! {
    static OPEN: RefCell<Option<Inputs>> = const { RefCell::new(None) };
}

/// A file that was read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileRead {
    /// As it was named.
    pub path: PathBuf,
    /// What it held.
    pub held: Held,
}

/// What a file held when it was read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Held {
    /// Bytes of this SHA-256, in hexadecimal digits.
    Sha256(String),
    /// What it still holds as long as this is true of it: too much to be kept, it is read part by part.
    Since(Stamp),
}

/// By which a file is known that nobody has written to or put another one in the place of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stamp {
    /// Length, bytes.
    pub length: u64,
    /// When it was last written to.
    pub modified: Option<SystemTime>,
    /// Device, number on it, and when the system last changed what it knows of the file, which nobody can set (seconds, ns).
    pub known_by: [i128; 4],
}

/// What was read.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Inputs {
    /// Files, in the order they were first read; one of which the content changed between is there with each.
    pub files: Vec<FileRead>,
    /// Folders whose files were looked for, as they were named: a file more there is another answer.
    pub folders: Vec<PathBuf>,
    /// What can be read only once, such as standard input: what it is called, and its content.
    pub streams: Vec<(String, Vec<u8>)>,
    /// Content of what is built in, by kind and name (`material`, `skin`).
    pub built_in: BTreeMap<(&'static str, String), Arc<[u8]>>,
}

impl Inputs {
    /// The files, as they were named.
    #[must_use]
    pub fn paths(&self) -> Vec<PathBuf> {
        let mut paths: Vec<PathBuf> = Vec::with_capacity(self.files.len());
        for file in &self.files {
            if !paths.contains(&file.path) {
                paths.push(file.path.clone());
            }
        }
        paths
    }

    /// The folder that names of files are said from ([`called`]): that of what was read first, the current one for a stream.
    #[must_use]
    pub fn home(&self) -> Option<PathBuf> {
        let stream = self.streams.first().map(|(name, _)| Path::new(name));
        let first = stream.or_else(|| self.files.first().map(|file| file.path.as_path()))?;
        std::path::absolute(first).ok()?.parent().map(Path::to_owned)
    }
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

/// What comes of a job, and what it read; the list that is open around it is left as it is.
pub fn inputs_of<T>(job: impl FnOnce() -> T) -> (T, Inputs) {
    let around = OPEN.replace(Some(Inputs::default()));
    let made = job();
    (made, OPEN.replace(around).unwrap_or_default())
}

/// What another list has was read.
pub fn add(other: &Inputs) {
    other.files.iter().for_each(|read| file(&read.path, read.held.clone()));
    other.folders.iter().for_each(|path| folder(path));
    other.streams.iter().for_each(|(name, content)| stream(name, content));
    OPEN.with_borrow_mut(|open| {
        if let Some(inputs) = open {
            for (name, content) in &other.built_in {
                inputs.built_in.entry(name.clone()).or_insert_with(|| Arc::clone(content));
            }
        }
    });
}

/// A file was read, and held this.
pub fn file(path: &Path, held: Held) {
    OPEN.with_borrow_mut(|open| {
        if let Some(inputs) = open
            && !inputs.files.iter().any(|known| known.path == path && known.held == held)
        {
            inputs.files.push(FileRead { path: path.to_owned(), held });
        }
    });
}

/// Files were read, each of another path than the others and than those before.
pub fn files(all: impl IntoIterator<Item = (PathBuf, Held)>) {
    OPEN.with_borrow_mut(|open| {
        if let Some(inputs) = open {
            let known: HashSet<PathBuf> = inputs.files.iter().map(|read| read.path.clone()).collect();
            let new = all.into_iter().filter(|(path, _)| !known.contains(path));
            inputs.files.extend(new.map(|(path, held)| FileRead { path, held }));
        }
    });
}

/// Something that can be read only once was read.
pub fn stream(name: &str, content: &[u8]) {
    OPEN.with_borrow_mut(|open| {
        if let Some(inputs) = open {
            inputs.streams.push((name.to_owned(), content.to_vec()));
        }
    });
}

/// The files of a folder were looked for.
pub fn folder(path: &Path) {
    OPEN.with_borrow_mut(|open| {
        if let Some(inputs) = open
            && !inputs.folders.iter().any(|known| known == path)
        {
            inputs.folders.push(path.to_owned());
        }
    });
}

/// How a file is called in what is said and written, so that it is the same wherever the folder `home` is and wherever one stands: by the
/// way from `home` to what is in it, with `/` on every system; else by its name alone, beside which its hash says which it is.
///
/// ```
/// use hadar::inputs::called;
/// use std::path::Path;
/// let home = Path::new("/home/a/sizing");
/// assert_eq!(called(Some(home), Path::new("/home/a/sizing/spectra/skin.csv")), "spectra/skin.csv");
/// assert_eq!(called(Some(home), Path::new("/data/skin.csv")), "skin.csv");
/// ```
#[must_use]
pub fn called(home: Option<&Path>, file: &Path) -> String {
    let whole = |path: &Path| std::path::absolute(path).ok();
    let plain = |inside: &PathBuf| inside.components().all(|part| matches!(part, Component::Normal(_)));
    let inside = |home: Option<PathBuf>, file: Option<PathBuf>| {
        Some(file?.strip_prefix(home?).ok()?.to_owned()).filter(plain)
    };
    let way = inside(home.and_then(whole), whole(file))
        // Links are followed, as they are by whoever goes there.
        .or_else(|| inside(home?.canonicalize().ok(), file.canonicalize().ok()))
        .map(|way| if way.as_os_str().is_empty() { PathBuf::from(".") } else { way });
    let name = || PathBuf::from(file.file_name().unwrap_or(file.as_os_str()));
    slashed(&way.unwrap_or_else(name))
}

/// A path as it is written on every system.
#[must_use]
pub fn slashed(path: &Path) -> String {
    path.to_string_lossy().replace(std::path::MAIN_SEPARATOR, "/")
}

/// Something built in was used. `content` is what it consists of, and changes when that does and not with its neighbours; whoever is asked
/// many times puts it together once.
pub(crate) fn built_in(kind: &'static str, name: &str, content: impl FnOnce() -> Arc<[u8]>) {
    OPEN.with_borrow_mut(|open| {
        if let Some(inputs) = open {
            inputs.built_in.entry((kind, name.to_owned())).or_insert_with(content);
        }
    });
}
