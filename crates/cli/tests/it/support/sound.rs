//! What must hold for whatever the program is given: an exit code that is known, one message, JSON that is whole.

use assert_cmd::Command;
use serde_json::Value;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// Processor time that a case may take, s, where the system has a shell that limits it. Anything small takes a tenth of a second.
const LONGEST_WORK: u64 = 120;
/// Only ends what waits for ever.
const LONGEST: Duration = Duration::from_secs(3600);
/// Address space that the program may take, kB, where the system has a shell that limits it.
const MOST_MEMORY: &str = "4000000";
/// Cases that are run side by side.
const TOGETHER: usize = 2;

/// Runs the program in a folder; what is wrong with how it ended, if anything.
pub(crate) fn fault(folder: &Path, arguments: &[String]) -> Option<String> {
    let program = assert_cmd::cargo::cargo_bin!("hadar");
    let mut command = if cfg!(unix) {
        let mut shell = Command::new("sh");
        shell
            .args(["-c", &format!("ulimit -v {MOST_MEMORY}; ulimit -t {LONGEST_WORK}; exec \"$0\" \"$@\"")])
            .arg(program);
        shell
    } else {
        Command::new(program)
    };
    let output = command
        .current_dir(folder)
        .env("RAYON_NUM_THREADS", "1")
        .args(arguments)
        .timeout(LONGEST)
        .output()
        .expect("a program that can be run");
    let (stdout, stderr) =
        (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr).into_owned());
    let wrong = |what: &str| Some(format!("{what}\n{stderr}"));
    let Some(code) = output.status.code() else { return wrong("killed, or too long at it") };
    if stderr.contains("panicked") || stderr.contains("report this") {
        return wrong("a panic, or as good as one");
    }
    let errors = stderr.lines().filter(|line| line.starts_with("error")).count();
    // Beside the message, warnings, and lines to paste that belong to it.
    let known = |line: &&str| ["error: ", "warning: ", "  "].iter().any(|start| line.starts_with(start));
    let others = stderr.lines().filter(|line| !known(line));
    match code {
        0 | 3 if errors > 0 => wrong("an answer and an error"),
        0 | 3 if stdout.trim().is_empty() => wrong("no answer"),
        0 | 3 if arguments.iter().any(|argument| argument == "--json") => match serde_json::from_str(&stdout)
        {
            Ok(answer) => unsaid(&answer).and_then(|what| wrong(&what)),
            Err(error) => wrong(&format!("JSON: {error}")),
        },
        0 | 3 => None,
        1 if !stdout.is_empty() => wrong("an error after an answer"),
        1 if errors != 1 || others.count() != 0 => wrong("not one message"),
        1 => None,
        2 if stderr.contains("Usage") || stderr.contains("--help") => None,
        _ => wrong(&format!("exit code {code}")),
    }
}

/// A pair said to be in order whose distances are no numbers.
fn unsaid(answer: &Value) -> Option<String> {
    let pairs = answer.get("pairs")?.as_array()?;
    let keys = [
        "distance_local",
        "distance_local_unknown_gain",
        "distance_nearest",
        "distance_return",
        "relative_error",
        "relative_error_unknown_gain",
    ];
    pairs
        .iter()
        .filter(|pair| pair["status"] == "ok")
        .find_map(|pair| keys.iter().find(|key| !pair[**key].is_number()))
        .map(|key| format!("{key} is no number where the status is ok"))
}

/// Runs `check` for all of `count` numbers, some at once; every one that fails is told, and the first ends in a panic.
pub(crate) fn all(count: usize, check: impl Fn(usize) -> Option<String> + Sync) {
    let (next, failed) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    std::thread::scope(|scope| {
        for _ in 0..TOGETHER {
            scope.spawn(|| {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= count {
                        break;
                    }
                    let found = catch_unwind(AssertUnwindSafe(|| check(number)));
                    if let Some(what) =
                        found.unwrap_or_else(|_| Some(format!("case {number}: the test itself")))
                    {
                        failed.lock().unwrap().push(what);
                    }
                }
            });
        }
    });
    let failed = failed.into_inner().unwrap();
    assert!(failed.is_empty(), "{} of {count}:\n{}", failed.len(), failed.join("\n----\n"));
}
