//! Calls to the file system, counted on each thread, and what happens before one of them: the process is killed, or another one works.

use std::cell::{Cell, RefCell};
use std::fs;
use std::io;
use std::path::Path;

type Before = Box<dyn FnMut() -> io::Result<()>>;

thread_local! {
    /// What happens before each call of this thread.
    static BEFORE: RefCell<Option<Before>> = const { RefCell::new(None) };
    static EXCHANGE: Cell<bool> = const { Cell::new(true) };
}

/// Before each call of the product.
pub(in crate::folder) fn call() -> io::Result<()> {
    // Taken out meanwhile: the calls of another process are not those of this one.
    let Some(mut before) = BEFORE.take() else { return Ok(()) };
    let outcome = before();
    BEFORE.set(Some(before));
    outcome
}

/// Empties a folder call by call, as the standard library does.
pub(in crate::folder) fn emptied(folder: &Path) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        if entry.file_type()?.is_dir() {
            emptied(&entry.path())?;
            call()?;
            fs::remove_dir(entry.path())?;
        } else {
            call()?;
            fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}

pub(in crate::folder) fn exchange_is_possible() -> io::Result<()> {
    if EXCHANGE.get() { Ok(()) } else { Err(io::ErrorKind::Unsupported.into()) }
}

/// What `work` returns where `before` happens before each of its calls.
pub(super) fn with<T>(before: impl FnMut() -> io::Result<()> + 'static, work: impl FnOnce() -> T) -> T {
    BEFORE.set(Some(Box::new(before)));
    let outcome = work();
    BEFORE.set(None);
    outcome
}

/// Whether `work` was killed before the call of this number: none of its calls from there on is made. Its locks are given back with
/// what it returns, as the system gives back those of the dead.
pub(super) fn killed<T>(at: usize, work: impl FnOnce() -> T) -> bool {
    let (mut number, killed) = (0, std::rc::Rc::new(Cell::new(false)));
    let dead = killed.clone();
    let before = move || {
        dead.set(dead.get() || number == at);
        number += 1;
        if dead.get() { Err(io::Error::other("killed")) } else { Ok(()) }
    };
    with(before, || drop(work()));
    killed.get()
}

/// What `work` returns where the call of this number fails, and no other; whether there was such a call.
pub(super) fn failing<T>(at: usize, work: impl FnOnce() -> T) -> (T, bool) {
    let (mut number, failed) = (0, std::rc::Rc::new(Cell::new(false)));
    let seen = failed.clone();
    let before = move || {
        number += 1;
        if number - 1 != at {
            return Ok(());
        }
        seen.set(true);
        Err(io::Error::other("failed"))
    };
    (with(before, work), failed.get())
}

/// What `work` returns on a file system that cannot exchange two folders.
pub(super) fn without_exchange<T>(work: impl FnOnce() -> T) -> T {
    EXCHANGE.set(false);
    let outcome = work();
    EXCHANGE.set(true);
    outcome
}
