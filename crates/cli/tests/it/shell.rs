//! Completions in a real bash, scripts read by shells that are there, and pages of the manual.

use crate::support::folder::{Folder, SCENARIO};
use std::process::{Command, Stdio};

/// Runs a script in bash, where there is one.
fn bash(folder: &Folder, script: &str) -> Option<String> {
    let made = Command::new("bash").args(["--norc", "-c", script]).current_dir(folder.path()).output();
    let Ok(output) = made else {
        println!("skipped: there is no bash");
        return None;
    };
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(String::from_utf8(output.stdout).unwrap())
}

#[test]
fn bash_completes_commands_and_their_flags() {
    let folder = Folder::with(SCENARIO);
    folder.file("hadar.bash", &folder.run(&["completions", "bash"]).stdout);
    let completed = |words: &str| {
        let count = words.split(' ').count();
        let script = format!(
            "source ./hadar.bash; complete -p hadar >/dev/null || exit 1; COMP_WORDS=({words}); COMP_CWORD={}; \
             _hadar_words hadar \"${{COMP_WORDS[{}]}}\" \"${{COMP_WORDS[{}]}}\"; printf '%s\\n' \"${{COMPREPLY[@]}}\"",
            count - 1,
            count - 1,
            count - 2,
        );
        bash(&folder, &script)
    };
    let Some(commands) = completed("hadar si") else { return };
    assert_eq!(commands.split_whitespace().collect::<Vec<_>>(), ["size", "simulate"]);
    assert_eq!(completed("hadar identify a.toml --mat").unwrap().trim(), "--matrix");
    assert_eq!(completed("hadar identify a.toml --see").unwrap().trim(), "--seed");
    assert_eq!(completed("hadar size a.toml --see").unwrap().trim(), "", "size takes no seed");
    // Nothing of ours: bash offers files.
    assert_eq!(completed("hadar size ''").unwrap().trim(), "");
    assert!(completed("hadar size -").unwrap().contains("--check"));
    assert!(completed("hadar init ''").unwrap().starts_with("size\nidentify\n"));
    assert!(completed("hadar schema ru").unwrap().starts_with("rule"));
}

#[test]
fn every_shell_has_a_script_that_it_can_read() {
    let folder = Folder::with(SCENARIO);
    for (shell, check) in
        [("bash", "bash"), ("zsh", "zsh"), ("fish", "fish"), ("elvish", ""), ("powershell", "")]
    {
        let script = folder.run(&["completions", shell]);
        assert!(script.code == 0 && script.stdout.contains("stand-in"), "{shell}: {}", script.stderr);
        folder.file(shell, &script.stdout);
        let run =
            Command::new(check).args(["-n", shell]).current_dir(folder.path()).stderr(Stdio::null()).status();
        match run {
            Ok(status) => assert!(status.success(), "{shell} cannot read its script"),
            Err(_) if check.is_empty() => {}
            Err(_) => println!("skipped: there is no {shell}"),
        }
    }
    assert_eq!(folder.run(&["completions", "tcsh"]).code, 2);
}

#[test]
fn every_command_has_a_page_with_its_flags() {
    let folder = Folder::with(SCENARIO);
    let whole = folder.run(&["man"]).stdout;
    assert!(whole.contains(".TH hadar 1") && whole.contains("hadar\\-size(1)"), "{whole}");
    assert_eq!(folder.run(&["man", "--out", "man", "-q"]).code, 0);
    let read = |name: &str| std::fs::read_to_string(folder.path().join("man").join(name)).unwrap();
    assert!(read("hadar-identify.1").contains("\\-\\-matrix") && read("hadar-size.1").contains("\\-\\-set"));
    assert!(read("hadar-calibrate-noise.1").contains(&format!("hadar {}", env!("CARGO_PKG_VERSION"))));
    assert_eq!(read("hadar.1").trim_end(), whole.trim_end());
}
