//! `hadar reproduce` and `hadar accuracy` are answered by `hadar-evidence` in the folder of `hadar`: what that program is given, its
//! exit code, and what is said where it is not there. What it answers is tested in its own package.

use crate::support::folder::Folder;
use std::fs;
use std::process::{Command, Output};

/// A folder with a `hadar` of its own, alone.
fn alone() -> Folder {
    let folder = Folder::with("");
    let program = folder.path().join("hadar");
    // A link would be resolved to the folder in which the other program may be.
    fs::copy(crate::PROGRAM, program).unwrap();
    folder
}

fn asked(folder: &Folder, arguments: &[&str]) -> (i32, String, String) {
    let program = folder.path().join("hadar");
    let Output { status, stdout, stderr } = Command::new(program).args(arguments).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (status.code().unwrap(), text(stdout), text(stderr))
}

#[test]
fn where_it_is_missing_one_line_says_what_builds_it() {
    let folder = alone();
    for (arguments, command) in [
        (["reproduce", "tabs2"].as_slice(), "`hadar reproduce`"),
        (&["--json", "accuracy", "vectors", "--threads", "1"], "`hadar accuracy`"),
    ] {
        let (code, stdout, stderr) = asked(&folder, arguments);
        assert_eq!((code, stdout.as_str(), stderr.lines().count()), (1, "", 1), "{stderr}");
        assert!(
            stderr.starts_with(&format!("error: {command} ")) && stderr.contains("there is no "),
            "{stderr}"
        );
        assert!(stderr.ends_with("`cargo build --release -p hadar-evidence`\n"), "{stderr}");
    }
    // Help and usage errors need no other program.
    let (code, stdout, _) = asked(&folder, &["help", "accuracy"]);
    assert!(code == 0 && stdout.contains("--scenes <N>") && stdout.contains("--format <FORMAT>"), "{stdout}");
    let (code, _, stderr) = asked(&folder, &["reproduce", "--cameras", "a.toml"]);
    assert!(code == 2 && stderr.contains("`hadar reproduce` takes no `--cameras`"), "{stderr}");
    let (code, stdout, _) = asked(&folder, &["explain", "reproduce"]);
    assert!(code == 0 && stdout.starts_with("hadar reproduce: The paper's figures"), "{stdout}");
}

#[cfg(unix)]
#[test]
fn where_it_is_it_gets_the_words_and_its_exit_code_is_passed_on() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = alone();
    let script = "#!/bin/sh\nread line\necho \"$line:$HADAR_HANDED_OVER_BY:$*\"\necho said >&2\nexit 3\n";
    let other = folder.file("hadar-evidence", script);
    let (code, _, stderr) = asked(&folder, &["accuracy", "stress"]);
    assert!(code == 1 && stderr.contains("cannot be run") && stderr.lines().count() == 1, "{stderr}");
    fs::set_permissions(other, fs::Permissions::from_mode(0o755)).unwrap();
    let mut command = assert_cmd::Command::new(folder.path().join("hadar"));
    let output = command.args(["--stats", "accuracy", "stress", "-q"]).write_stdin("in\n").output().unwrap();
    let build = format!("in:{}, commit ", env!("CARGO_PKG_VERSION"));
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.starts_with(&build) && said.ends_with(":--stats accuracy stress -q\n"), "{said}");
    assert_eq!((output.status.code(), output.stderr.as_slice()), (Some(3), b"said\n".as_slice()));
}
