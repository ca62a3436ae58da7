use super::*;
use std::collections::BTreeMap;

pub(super) mod calls;
mod killed;

fn files(names: &[&str], content: &str) -> Vec<(String, Held)> {
    names.iter().map(|name| ((*name).to_owned(), format!("{name} {content}").into_bytes().into())).collect()
}

fn write(folder: &Folder, names: &[&str], content: &str) -> Result<()> {
    folder.write(&files(names, content), &Provenance::default(), &[])
}

/// All files of a folder with their content, but the manifest.
fn content(folder: &Path) -> BTreeMap<String, String> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    let files = entries.filter(|entry| entry.path().is_file() && entry.file_name() != manifest::NAME);
    files.map(|e| (e.file_name().into_string().unwrap(), fs::read_to_string(e.path()).unwrap())).collect()
}

fn of(names: &[&str], text: &str) -> BTreeMap<String, String> {
    names.iter().map(|name| ((*name).to_owned(), format!("{name} {text}"))).collect()
}

#[track_caller]
fn refusal(result: Result<()>, part: &str) {
    let message = result.unwrap_err().to_string();
    assert!(message.contains(part), "{part}: {message}");
}

#[test]
fn a_report_replaces_its_own_files_and_nothing_stays_beside_it() {
    let home = tempfile::tempdir().unwrap();
    let place = home.path().join("a/b");
    let folder = Folder::new(&place, Strangers::Refuse);
    folder.check().unwrap();
    assert!(!home.path().join("a").exists(), "a check makes nothing");
    write(&folder, &["x.csv", "gone.csv"], "1").unwrap();
    folder.check().unwrap();
    write(&folder, &["x.csv", "new.csv"], "2").unwrap();
    assert_eq!(content(&place), of(&["x.csv", "new.csv"], "2"));
    assert_eq!(fs::read_dir(place.parent().unwrap()).unwrap().count(), 1);
    assert_eq!(fs::read_dir(&place).unwrap().count(), 3);
    let manifest = Manifest::in_folder(&place).unwrap().unwrap();
    assert!(
        manifest.files.iter().all(|file| manifest.owns(&place, &file.name).unwrap())
            && manifest.files.len() == 2
    );
}

#[test]
fn strangers_are_refused_before_the_work_and_stay_where_they_are_kept() {
    let home = tempfile::tempdir().unwrap();
    let place = home.path().join("out");
    let (careful, keeping) =
        (Folder::new(&place, Strangers::Refuse), Folder::new(&place, Strangers::KeepBesides));
    fs::create_dir(&place).unwrap();
    careful.check().unwrap();
    fs::write(place.join("x.csv"), "mine").unwrap();
    fs::write(place.join("notes.md"), "mine").unwrap();
    refusal(careful.check(), "it holds `notes.md`, and no hadar.json says that hadar wrote it");
    refusal(write(&careful, &["x.csv"], "1"), "--force");
    assert_eq!(fs::read_to_string(place.join("x.csv")).unwrap(), "mine");
    keeping.check().unwrap();
    write(&keeping, &["x.csv", "y.csv"], "1").unwrap();
    let mut expected = of(&["x.csv", "y.csv"], "1");
    expected.insert("notes.md".into(), "mine".into());
    assert_eq!(content(&place), expected);
    refusal(careful.check(), "`notes.md` in it was not written by the run");
    fs::remove_file(place.join("notes.md")).unwrap();
    careful.check().unwrap();
    // What was changed since is another's.
    fs::write(place.join("y.csv"), "edited").unwrap();
    refusal(careful.check(), "its `y.csv` was changed since hadar wrote it");
    write(&keeping, &["x.csv"], "2").unwrap();
    assert_eq!(fs::read_to_string(place.join("y.csv")).unwrap(), "edited");
    // Hidden files and reports of their own are in nobody's way.
    fs::remove_file(place.join("y.csv")).unwrap();
    fs::write(place.join(".gitignore"), "*").unwrap();
    write(&Folder::new(place.join("below"), Strangers::Refuse), &["z.csv"], "1").unwrap();
    write(&careful, &["x.csv"], "3").unwrap();
    assert!(place.join(".gitignore").exists() && place.join("below/z.csv").exists());
    fs::create_dir(place.join("folder.csv")).unwrap();
    refusal(write(&keeping, &["folder.csv"], "1"), "`folder.csv` is a folder");
}

#[test]
fn an_input_is_never_replaced() {
    let home = tempfile::tempdir().unwrap();
    let place = home.path().join("out");
    let folder = Folder::new(&place, Strangers::KeepBesides);
    write(&folder, &["scenario.toml"], "1").unwrap();
    let [same, linked] = ["out/./scenario.toml", "linked.toml"].map(|name| home.path().join(name));
    #[cfg(unix)]
    std::os::unix::fs::symlink("out/scenario.toml", &linked).unwrap();
    #[cfg(not(unix))]
    fs::hard_link(&same, &linked).unwrap();
    for input in [same, linked] {
        let inputs = [input];
        refusal(folder.check_inputs(&inputs, &[]), "`scenario.toml` in it is read by this run");
        let result = folder.write(&files(&["a.csv"], "2"), &Provenance::default(), &inputs);
        refusal(result, "name another folder");
    }
    assert_eq!(content(&place), of(&["scenario.toml"], "1"));
    // Beside the report it is in nobody's way.
    fs::write(place.join("mine.toml"), "mine").unwrap();
    let inputs = [place.join("mine.toml")];
    folder.write(&files(&["a.csv"], "2"), &Provenance::default(), &inputs).unwrap();
    assert_eq!(content(&place).len(), 2);
    refusal(folder.write(&files(&["mine.toml"], "2"), &Provenance::default(), &inputs), "`mine.toml`");
}

#[test]
fn what_is_no_folder_is_refused() {
    let home = tempfile::tempdir().unwrap();
    let at = |name: &str| Folder::new(home.path().join(name), Strangers::KeepBesides);
    fs::write(home.path().join("file"), "").unwrap();
    refusal(at("file").check(), "this is a file");
    refusal(at("file/below").check(), "part of the path is a file");
    refusal(Folder::new("", Strangers::Refuse).check(), "the name is empty");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("nowhere", home.path().join("dangling")).unwrap();
        refusal(at("dangling").check(), "a link to nothing");
        refusal(at("dangling/below").check(), "a link to nothing");
        // A link to a folder is that folder.
        fs::create_dir(home.path().join("real")).unwrap();
        std::os::unix::fs::symlink("real", home.path().join("link")).unwrap();
        write(&at("link"), &["a.csv"], "1").unwrap();
        assert!(home.path().join("link").is_symlink() && home.path().join("real/a.csv").exists());
    }
    refusal(write(&at("out"), &["a.csv", "a.csv/below.csv"], "1"), "write the report");
    assert!(!home.path().join("out").exists());
}

/// A folder as a process makes it, or open to others as well.
fn made(path: &Path, private: bool) {
    fs::create_dir(path).unwrap();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        fs::set_permissions(path, fs::Permissions::from_mode(if private { 0o700 } else { 0o755 })).unwrap();
    }
}

#[test]
fn folders_of_the_dead_are_cleared_and_those_of_the_living_are_not() {
    let home = tempfile::tempdir().unwrap();
    let place = home.path().join("out");
    let alive = Staging::in_folder(home.path()).unwrap();
    let [dead, begun, only_made] =
        ["0123456789ab", "0123456789ac", "0123456789ad"].map(|end| home.path().join(format!(".hadar-{end}")));
    [&dead, &begun, &only_made].into_iter().for_each(|path| made(path, true));
    fs::create_dir(dead.join("new")).unwrap();
    fs::write(dead.join("lock"), "").unwrap();
    fs::write(dead.join("new/x.csv"), "").unwrap();
    fs::write(begun.join("unlocked"), "").unwrap();
    Folder::new(&place, Strangers::Refuse).check().unwrap();
    assert!(!dead.exists() && !begun.exists() && !only_made.exists());
    assert!(alive.new_report().exists());
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        let staging = alive.new_report().parent().unwrap().metadata().unwrap();
        assert_eq!(staging.permissions().mode() & 0o777, 0o700);
        // The report itself is as open as any other folder that is made here.
        let mode = |path: &Path| path.metadata().unwrap().permissions().mode() & 0o777;
        let plain = home.path().join("plain");
        fs::create_dir(&plain).unwrap();
        write(&Folder::new(&place, Strangers::Refuse), &["x.csv"], "1").unwrap();
        assert_eq!(mode(&place), mode(&plain));
        fs::set_permissions(&place, fs::Permissions::from_mode(0o750)).unwrap();
        write(&Folder::new(&place, Strangers::Refuse), &["x.csv"], "2").unwrap();
        assert_eq!(mode(&place), 0o750);
    }
}

/// Whoever likes the name keeps what is in the folder, and no link is followed.
#[test]
#[cfg(unix)]
fn what_only_has_the_name_of_a_staging_folder_stays() {
    let home = tempfile::tempdir().unwrap();
    let place = home.path().join("out");
    let at = |name: &str| home.path().join(name);
    let [name, open, full, written, linked, link] = [
        ".hadar-notes",
        ".hadar-00000000000a",
        ".hadar-00000000000b",
        ".hadar-00000000000c",
        ".hadar-00000000000d",
        ".hadar-00000000000e",
    ]
    .map(at);
    made(&name, true);
    made(&open, false);
    fs::write(open.join("lock"), "").unwrap();
    made(&full, true);
    fs::write(full.join("mine"), "mine").unwrap();
    made(&written, true);
    fs::write(written.join("unlocked"), "mine").unwrap();
    // Links to an empty file and to a folder that a dead process could have left.
    fs::write(at("empty"), "").unwrap();
    made(&at("private"), true);
    made(&linked, true);
    std::os::unix::fs::symlink(at("empty"), linked.join("unlocked")).unwrap();
    std::os::unix::fs::symlink(at("private"), &link).unwrap();
    let folder = Folder::new(&place, Strangers::Refuse);
    folder.check().unwrap();
    write(&folder, &["x.csv"], "1").unwrap();
    assert!(name.is_dir() && open.is_dir() && link.is_symlink());
    assert_eq!(fs::read_to_string(full.join("mine")).unwrap(), "mine");
    assert_eq!(fs::read_to_string(written.join("unlocked")).unwrap(), "mine");
    assert!(linked.join("unlocked").is_symlink() && at("empty").is_file() && at("private").is_dir());
    assert_eq!(fs::read_dir(home.path()).unwrap().count(), 9);
}

/// A report that was half moved is replaced by the next run that names its folder, and by no other; what is in it is hadar's all the same.
#[test]
fn a_report_half_moved_is_replaced_by_the_run_that_names_it() {
    let whole = |folder: &Path| Manifest::in_folder(folder).unwrap().is_some();
    let half = (0..).find_map(|call| {
        let home = tempfile::tempdir().unwrap();
        let folder = Folder::new(home.path(), Strangers::KeepBesides);
        fs::write(home.path().join("mine"), "mine").unwrap();
        write(&folder, &["a.csv", "b.csv"], "1").unwrap();
        let dead = calls::killed(call, || write(&folder, &["a.csv", "c.csv"], "2"));
        assert!(dead, "no call after which the report is half moved");
        (!whole(home.path())).then_some((home, folder))
    });
    let (home, folder) = half.unwrap();
    write(&Folder::new(home.path().join("below"), Strangers::Refuse), &["x.csv"], "1").unwrap();
    folder.check().unwrap();
    assert!(!whole(home.path()), "nothing that is found is acted upon");
    fs::remove_file(home.path().join("mine")).unwrap();
    fs::write(home.path().join(".mine"), "").unwrap();
    let careful = Folder::new(home.path(), Strangers::Refuse);
    careful.check().unwrap();
    fs::write(home.path().join("mine"), "mine").unwrap();
    refusal(careful.check(), "`mine` in it was not written by the run");
    write(&folder, &["a.csv", "d.csv"], "3").unwrap();
    let mut expected = of(&["a.csv", "d.csv"], "3");
    expected.insert(".mine".into(), String::new());
    expected.insert("mine".into(), "mine".into());
    assert!(whole(home.path()) && content(home.path()) == expected);
}

#[test]
fn a_large_file_is_taken_from_where_it_was_made() {
    let home = tempfile::tempdir().unwrap();
    for (place, strangers) in
        [("new", Strangers::Refuse), ("new", Strangers::Refuse), ("kept", Strangers::KeepBesides)]
    {
        let place = home.path().join(place);
        if strangers == Strangers::KeepBesides {
            fs::create_dir(&place).unwrap();
            fs::write(place.join("mine"), "mine").unwrap();
        }
        let folder = Folder::new(&place, strangers);
        let scratch = folder.scratch().unwrap();
        let large = scratch.place().join("large");
        fs::write(&large, "a.npy 1").unwrap();
        folder.write(&[("a.npy".into(), Held::File(large))], &Provenance::default(), &[]).unwrap();
        drop(scratch);
        assert_eq!(content(&place)["a.npy"], "a.npy 1");
        let manifest = Manifest::in_folder(&place).unwrap().unwrap();
        assert!(manifest.owns(&place, "a.npy").unwrap());
    }
    let left = fs::read_dir(home.path()).unwrap().count();
    assert_eq!(left, 2, "nothing is left beside the reports");
}

/// Whatever is planted in the folder, a run writes nowhere else, and replaces no file that it cannot know.
#[test]
#[cfg(unix)]
fn what_is_planted_is_not_believed() {
    use std::os::unix::fs::symlink;
    let list = |names: &[(&str, &str)]| {
        let files = names.iter().map(|(name, text)| (*name, manifest::sha256(text.as_bytes())));
        Manifest::of(&Provenance::default(), files).to_json().unwrap()
    };
    for (strangers, private) in
        [Strangers::Refuse, Strangers::KeepBesides].into_iter().flat_map(|s| [(s, true), (s, false)])
    {
        let home = tempfile::tempdir().unwrap();
        let at = |name: &str| home.path().join(name);
        let other = Folder::new(at("other"), Strangers::Refuse);
        write(&other, &["x.csv", "y.csv"], "1").unwrap();
        fs::create_dir(at("away")).unwrap();
        fs::write(at("away/keys"), "mine").unwrap();
        fs::create_dir(at("out")).unwrap();
        // One as a dead process leaves it, with a report of anything; one whose report is a link to another one.
        let [full, linked] = ["out/.hadar-00000000000a", "out/.hadar-00000000000b"].map(at);
        for staging in [&full, &linked] {
            made(staging, private);
            fs::write(staging.join("lock"), "").unwrap();
        }
        fs::create_dir_all(full.join("ready/sub")).unwrap();
        for name in ["x.csv", "sub/keys"] {
            fs::write(full.join("ready").join(name), "theirs").unwrap();
        }
        let names = [("x.csv", "theirs"), ("sub/keys", "theirs")];
        fs::write(full.join("ready/hadar.json"), list(&names)).unwrap();
        symlink(at("other"), linked.join("ready")).unwrap();
        symlink(at("away"), at("out/sub")).unwrap();
        fs::write(at("out/x.csv"), "mine").unwrap();
        let folder = Folder::new(at("out"), strangers);
        let outcome = folder.check().and_then(|()| write(&folder, &["x.csv", "sub/keys"], "2"));
        refusal(
            outcome,
            if strangers == Strangers::Refuse { "`sub`" } else { "its `sub` is a file or a link" },
        );
        assert_eq!(fs::read_to_string(at("away/keys")).unwrap(), "mine");
        assert_eq!(fs::read_to_string(at("out/x.csv")).unwrap(), "mine");
        assert_eq!(content(&at("other")), of(&["x.csv", "y.csv"], "1"));
        if strangers == Strangers::KeepBesides {
            write(&folder, &["x.csv"], "2").unwrap();
            assert_eq!(fs::read_to_string(at("out/x.csv")).unwrap(), "x.csv 2");
            assert_eq!(full.exists(), !private, "it goes if it may be this user's");
        }
        // Even where the link appears between the look and the move.
        let inside = Inside::open(&at("out")).unwrap();
        fs::write(at("new"), "").unwrap();
        assert!(inside.take(&at("new"), "sub/keys").is_err() && inside.remove("sub/keys").is_err());
        assert!(inside.file("sub/keys").is_err());
        assert!(inside.take(&at("new"), "../away/keys").is_err() && inside.file("../new").is_err());
        symlink("x.csv", at("out/link")).unwrap();
        assert!(inside.file("link").is_err() && inside.file("x.csv").is_ok());
        assert_eq!(fs::read_to_string(at("away/keys")).unwrap(), "mine");
    }
}

#[test]
fn a_name_that_is_too_long_is_found_before_the_work() {
    let home = tempfile::tempdir().unwrap();
    for name in ["x".repeat(300), format!("not/there/{}", "x".repeat(300)), "xy/".repeat(1400)] {
        let folder = Folder::new(home.path().join(name), Strangers::Refuse);
        refusal(folder.check(), "the name is longer than its file system takes");
    }
    Folder::new(home.path().join("x".repeat(255)), Strangers::Refuse).check().unwrap();
}
