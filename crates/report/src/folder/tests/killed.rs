//! Runs that are killed before any of their calls to the file system, and runs beside each other: every call is tried, none by its time.

use super::calls::{failing, killed, with, without_exchange};
use super::*;
use std::cell::Cell;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::mpsc;

const OLD: [&str; 2] = ["a.csv", "gone.csv"];
const NEW: [&str; 2] = ["a.csv", "below/new.csv"];

/// A way to publish.
#[derive(Debug, Clone, Copy)]
struct Way {
    /// Below the test's own folder.
    place: &'static str,
    /// Whether there is an older report.
    old: bool,
    /// Whether there is a file of somebody else.
    stranger: bool,
    /// Whether a large file is made on the disk of the report first.
    scratch: bool,
    /// Whether the file system exchanges folders.
    exchange: bool,
}

/// Every way that makes other calls.
const WAYS: [Way; 7] = {
    let first = Way { place: "out", old: false, stranger: false, scratch: false, exchange: true };
    [
        first,
        Way { place: "x/y/out", scratch: true, ..first },
        Way { old: true, ..first },
        Way { old: true, scratch: true, ..first },
        Way { old: true, exchange: false, ..first },
        Way { stranger: true, scratch: true, ..first },
        Way { old: true, stranger: true, ..first },
    ]
};

/// One way in a folder of its own.
struct World {
    way: Way,
    home: tempfile::TempDir,
    place: PathBuf,
    folder: Folder,
}

impl World {
    fn new(way: Way) -> Self {
        // In memory where the system has such a folder: thousands of worlds are made.
        let home = tempfile::tempdir_in("/dev/shm").or_else(|_| tempfile::tempdir()).unwrap();
        let place = home.path().join(way.place);
        let folder = Folder::new(&place, Strangers::KeepBesides);
        if way.old {
            write(&folder, &OLD, "1").unwrap();
        }
        if way.stranger {
            fs::create_dir_all(&place).unwrap();
            fs::write(place.join("mine"), "mine").unwrap();
        }
        Self { way, home, place, folder }
    }

    /// A run as the program makes it. It returns what goes with its end.
    fn run(&self) -> Result<Option<Scratch>> {
        let publish = || {
            self.folder.check()?;
            let mut files = files(&NEW, "2");
            let scratch = self.way.scratch.then(|| self.folder.scratch()).transpose()?;
            if let Some(scratch) = &scratch {
                let large = scratch.place().join("large");
                fs::write(&large, "a.csv 2").unwrap();
                files[0].1 = Held::File(large);
            }
            self.folder.write(&files, &Provenance::default(), &[])?;
            Ok(scratch)
        };
        if self.way.exchange { publish() } else { without_exchange(publish) }
    }

    /// Whether there is a report, which is whole; `Some(true)` if it is the new one. Without one there is none of its files either.
    #[track_caller]
    fn report(&self, what: &str) -> Option<bool> {
        let mut found = tree(&self.place);
        found.retain(|name, _| !name.starts_with(".hadar-"));
        let mine = found.remove("mine").is_some_and(|mine| mine == "mine");
        assert_eq!(mine, self.way.stranger, "{what}");
        if found.remove(manifest::NAME).is_none() {
            assert!(found.is_empty(), "{what}: {found:?}");
            return None;
        }
        assert!(found == of(&OLD, "1") || found == of(&NEW, "2"), "{what}: {found:?}");
        let manifest = Manifest::in_folder(&self.place).unwrap().unwrap();
        assert!(found.keys().all(|name| manifest.owns(&self.place, name).unwrap()), "{what}");
        assert_eq!(found.len(), manifest.files.len(), "{what}");
        Some(found == of(&NEW, "2"))
    }

    /// Whether the report must be moved file by file.
    fn moves(&self) -> bool {
        self.way.stranger || !self.way.exchange
    }

    /// What is true as soon as a process is dead.
    #[track_caller]
    fn is_whole_or_says_so(&self, what: &str) {
        if !self.moves() || Manifest::in_folder(&self.place).unwrap().is_some() {
            // Obsolete files and empty folders go after their list.
            self.report(what);
        }
    }

    /// What is true after the next run that names the folder; whether the report is the new one.
    #[track_caller]
    fn is_clear(&self, what: &str) -> bool {
        let report = self.report(what);
        assert!(!self.way.old || report.is_some(), "{what}: no report");
        let left: Vec<_> =
            tree(self.home.path()).into_keys().filter(|name| name.contains(".hadar-")).collect();
        assert!(left.is_empty(), "{what}: {left:?}");
        report == Some(true)
    }
}

/// All files below a folder with their content, and all empty folders.
fn tree(folder: &Path) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).into_iter().flatten().map(|entry| entry.unwrap()) {
        let name = entry.file_name().into_string().unwrap();
        if entry.path().is_dir() {
            let inner = tree(&entry.path());
            if inner.is_empty() {
                found.insert(name.clone(), String::new());
            }
            found.extend(inner.into_iter().map(|(inner, text)| (format!("{name}/{inner}"), text)));
        } else {
            found.insert(name, fs::read_to_string(entry.path()).unwrap());
        }
    }
    found
}

#[test]
fn killed_at_any_call_a_run_leaves_the_old_report_or_the_new_one() {
    for way in WAYS {
        let mut calls = 0;
        loop {
            let (world, what) = (World::new(way), format!("{way:?}, killed at call {calls}"));
            let dead = killed(calls, || world.run());
            world.is_whole_or_says_so(&what);
            let before = tree(&world.place);
            world.folder.check().unwrap();
            // What is found is cleared away, or left alone.
            if world.moves() {
                let mut after = tree(&world.place);
                let gone = before.iter().filter(|(name, _)| !after.contains_key(*name));
                assert!(gone.into_iter().all(|(name, _)| name.starts_with(".hadar-")), "{what}");
                after.retain(|name, text| before.get(name) != Some(text));
                assert!(after.is_empty(), "{what}: {after:?}");
            } else {
                assert!(world.is_clear(&what) || dead, "{what}");
            }
            // The next one needs nothing else.
            world.run().unwrap();
            assert!(world.is_clear(&what), "{what}");
            if !dead {
                break;
            }
            calls += 1;
        }
        assert!(calls > 20, "{way:?}: {calls} calls");
    }
}

/// That the system cannot look at a file is not that there is none.
#[test]
fn a_call_that_fails_is_told_or_makes_no_difference() {
    for way in WAYS {
        let mut calls = 0;
        loop {
            let (world, what) = (World::new(way), format!("{way:?}, call {calls} fails"));
            let (outcome, failed) = failing(calls, || world.run().map(drop));
            if outcome.is_ok() {
                assert_eq!(world.report(&what), Some(true), "{what}");
            } else {
                world.is_whole_or_says_so(&what);
            }
            world.run().unwrap();
            assert!(world.is_clear(&what), "{what}");
            if !failed {
                break;
            }
            calls += 1;
        }
        assert!(calls > 20, "{way:?}: {calls} calls");
    }
}

/// The run after it can be killed as well: one that must replace what was begun, and one that must only remove what is left.
#[test]
fn killed_at_any_call_of_its_clearing_a_run_leaves_no_more() {
    for way in WAYS.into_iter().filter(|way| way.old && (way.stranger || way.scratch)) {
        let mut first = 0;
        loop {
            let mut second = 0;
            let dead = loop {
                let (world, what) =
                    (World::new(way), format!("{way:?}, killed at calls {first} and {second}"));
                let dead = killed(first, || world.run());
                let again = killed(second, || world.run());
                world.is_whole_or_says_so(&what);
                world.run().unwrap();
                assert!(world.is_clear(&what), "{what}");
                if !again {
                    break dead;
                }
                second += 1;
            };
            if !dead {
                break;
            }
            first += 1;
        }
    }
}

/// Whoever clears up takes nothing from the living, whatever they are about to do.
#[test]
fn runs_beside_each_other_do_not_disturb() {
    for way in WAYS {
        let mut at = 0;
        loop {
            let world = World::new(way);
            let beside = Folder::new(world.home.path().join("beside"), Strangers::Refuse);
            let (folder, mut number) = (world.folder.clone(), 0);
            let reached = Rc::new(Cell::new(false));
            let seen = reached.clone();
            let other = move || {
                if number == at {
                    seen.set(true);
                    folder.check().unwrap();
                    write(&beside, &OLD, "1").unwrap();
                }
                number += 1;
                Ok(())
            };
            let outcome = with(other, || world.run().map(drop));
            assert!(outcome.is_ok(), "{way:?}, another run before call {at}: {outcome:?}");
            assert!(world.is_clear(&format!("{way:?}, another run before call {at}")));
            if !reached.get() {
                break;
            }
            at += 1;
        }
    }
}

/// A folder is made while another process looks at it: for each call of the one, the other is stopped before each of its own.
#[test]
fn a_folder_that_is_begun_is_cleared_or_used_but_not_both() {
    let (mut first, mut going_on) = (0, true);
    while going_on {
        let mut second = 0;
        loop {
            let home = tempfile::tempdir().unwrap();
            let ((to_clear, begun), (to_make, paused)) = (mpsc::channel(), mpsc::channel());
            let made_to_clear = to_clear.clone();
            let (made, cleared) = std::thread::scope(|scope| {
                let clearing = scope.spawn(|| {
                    // The maker stops, or is done.
                    begun.recv().unwrap();
                    let (mut number, stopped) = (0, Rc::new(Cell::new(false)));
                    let (seen, to_stopped) = (stopped.clone(), to_make.clone());
                    let stop = move || {
                        if number == second {
                            seen.set(true);
                            let _ = to_stopped.send(());
                            // The maker is done.
                            begun.recv().unwrap();
                        }
                        number += 1;
                        Ok(())
                    };
                    with(stop, || clear(home.path(), Left::Unfinished));
                    // Where it was not stopped, the maker still waits.
                    let _ = to_make.send(());
                    stopped.get()
                });
                let making = scope.spawn(|| {
                    let (mut number, stopped) = (0, Rc::new(Cell::new(false)));
                    let seen = stopped.clone();
                    let stop = move || {
                        if number == first {
                            seen.set(true);
                            to_clear.send(()).unwrap();
                            paused.recv().unwrap();
                        }
                        number += 1;
                        Ok(())
                    };
                    let staging = with(stop, || Staging::in_folder(home.path())).unwrap();
                    // It is begun if it was not stopped, and goes on if it is; it may be done.
                    let _ = made_to_clear.send(());
                    let _ = made_to_clear.send(());
                    (staging, stopped.get())
                });
                (making.join().unwrap(), clearing.join().unwrap())
            });
            let (staging, maker_stopped) = made;
            assert!(staging.new_report().is_dir(), "{first} {second}");
            // It is locked: whoever comes later leaves it.
            clear(home.path(), Left::Unfinished);
            assert!(staging.new_report().is_dir(), "{first} {second}");
            drop(staging);
            clear(home.path(), Left::Unfinished);
            assert_eq!(fs::read_dir(home.path()).unwrap().count(), 0, "{first} {second}");
            going_on = maker_stopped;
            if !cleared {
                break;
            }
            second += 1;
        }
        first += 1;
    }
}
