//! Commands that are stopped: by a limit, by a signal. Nothing is left behind, and what was there stays.

use crate::support::folder::{Folder, SCENARIO};
use std::fs;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// Ends a test that hangs; far more than anything here takes on the slowest machine.
const HOPELESS: Duration = Duration::from_secs(120);

/// Eight surroundings of unknown temperatures: minutes of work.
fn heavy() -> String {
    let materials = [
        "concrete",
        "asphalt",
        "grass-dry",
        "brick-red",
        "pmma",
        "steel-rough",
        "soda-lime-glass",
        "aluminium",
    ];
    let object = |(i, material): (usize, &str)| {
        format!(
            "[[environment]]\ntemperature = \"{} degC\"\nlighting = 0.1125\nmaterial = \"{material}\"\n",
            5 + 7 * i
        )
    };
    let surroundings: String = materials.into_iter().enumerate().map(object).collect();
    format!(
        "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\n{surroundings}[alternatives]\nmaterials = [\"pmma\", \"aluminium\"]\n\
         [bands]\nstart = \"715 cm^-1\"\nstop = \"1250 cm^-1\"\nstep = \"0.1 cm^-1\"\n\
         [unknown]\nnuisances = [\"temperature\", \"lighting\", \"gain\", \"environment-temperature\"]\n\
         [camera]\npreset = \"flir-a325sc\"\n"
    )
}

fn begun(folder: &Folder, arguments: &[&str]) -> Child {
    let mut command = Command::new(crate::PROGRAM);
    command.current_dir(folder.path()).args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped());
    command.spawn().unwrap()
}

fn names(folder: &Folder) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn a_limit_that_is_exceeded_ends_a_command_with_nothing_written() {
    let folder = Folder::with(&heavy());
    for (command, limit, said) in [
        ("size", ["--time-limit", "1 s"], "after 1 s, the limit of time"),
        ("identify", ["--time-limit", "1.5 s"], "after 1.500 s, the limit of time"),
        #[cfg(target_os = "linux")]
        ("size", ["--memory-limit", "5 MB"], "above 5 MB of memory, the limit"),
    ] {
        let found = folder.run(&[&[command, "a.toml", "--out", "out"], &limit[..]].concat());
        assert_eq!((found.code, found.stdout.as_str()), (1, ""), "{}", found.stderr);
        assert!(found.stderr.contains(said), "{}", found.stderr);
        assert_eq!(names(&folder), ["a.toml"]);
    }
    for wrong in [
        ["--time-limit", "90"],
        ["--time-limit", "-1 s"],
        ["--memory-limit", "2"],
        ["--memory-limit", "much"],
    ] {
        let found = folder.run(&[&["size", "a.toml"], &wrong[..]].concat());
        assert_eq!(found.code, 2, "{wrong:?}: {}", found.stderr);
    }
    // What is known to take too long is not begun.
    let many = heavy().replace("0.1 cm^-1", "0.001 cm^-1");
    folder.file("many.toml", &many);
    let found = folder.run(&["size", "many.toml", "--time-limit", "1 us"]);
    assert_eq!(found.code, 1, "{}", found.stderr);
    for (command, example) in [("range", "street.toml"), ("render", "night_street.toml")] {
        let path = hadar_testing::repository().join("examples").join(example);
        let (path, large) = (path.to_str().unwrap(), "scene.size=[1200, 1600]");
        let found = folder.run(&[
            command,
            path,
            "--set",
            large,
            "--time-limit",
            "1 s",
            "--threads",
            "1",
            "--out",
            "out",
        ]);
        let foreseen =
            found.stderr.contains("this takes") && found.stderr.contains("the limit of time is 1 s");
        assert!(found.code == 1 && foreseen, "{}", found.stderr);
    }
    // What is within its limits is the same with and without them.
    folder.file("small.toml", SCENARIO);
    let [plain, within] = [&[][..], &["--time-limit", "1 h", "--memory-limit", "100 GB"]]
        .map(|more| folder.run(&[&["size", "small.toml"], more].concat()));
    assert_eq!((within.code, within.stdout), (plain.code, plain.stdout));
}

#[cfg(target_os = "linux")]
mod signals {
    use super::*;

    /// Waits until a condition holds.
    fn when(holds: impl Fn() -> bool) {
        let begun = Instant::now();
        while !holds() {
            assert!(begun.elapsed() < HOPELESS);
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    /// Waits until a program listens for signals.
    fn listens(child: &Child) {
        let tasks = format!("/proc/{}/task", child.id());
        let name = |task: fs::DirEntry| fs::read_to_string(task.path().join("comm")).unwrap_or_default();
        when(|| {
            fs::read_dir(&tasks).into_iter().flatten().flatten().any(|task| name(task).trim() == "signals")
        });
    }

    fn signalled(child: Child, signal: &str) -> Output {
        assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
        let begun = Instant::now();
        let output = child.wait_with_output().unwrap();
        assert!(begun.elapsed() < HOPELESS, "a signal does not end it");
        output
    }

    #[test]
    fn a_signal_ends_a_command_with_nothing_written() {
        let folder = Folder::with(&heavy());
        for (signal, code) in [("-INT", 130), ("-TERM", 143)] {
            let child = begun(&folder, &["size", "a.toml", "--out", "out"]);
            listens(&child);
            let output = signalled(child, signal);
            assert_eq!(output.status.code(), Some(code));
            assert_eq!((output.stdout, output.stderr), (Vec::new(), b"stopped\n".to_vec()));
            assert_eq!(names(&folder), ["a.toml"]);
        }
    }

    /// A row that was there is kept, the one that was computed is neither there nor failed.
    #[test]
    fn a_sweep_that_is_stopped_goes_on_where_it_was() {
        let folder = Folder::with(SCENARIO);
        let rows = |steps: &'static str| {
            [
                "sweep",
                "a.toml",
                "--out",
                "out",
                "--threads",
                "1",
                "--columns",
                "verdict.margin",
                "--vary",
                steps,
            ]
        };
        let both = rows("bands.step=50 cm^-1,0.01 cm^-1");
        let child = begun(&folder, &both);
        let journal = folder.path().join("out/.sweep/1-of-1.jsonl");
        // What the row rests on, and the row.
        when(|| fs::read_to_string(&journal).is_ok_and(|text| text.matches('\n').count() == 2));
        let output = signalled(child, "-INT");
        assert_eq!(output.status.code(), Some(130), "{}", String::from_utf8_lossy(&output.stderr));
        let text = fs::read_to_string(&journal).unwrap();
        assert!(
            text.ends_with('\n') && text.lines().count() == 2 && !text.contains("report this as a bug"),
            "{text}"
        );
        let stopped = folder.run(&[&both[..], &["--time-limit", "1 ms"]].concat());
        assert_eq!(stopped.code, 1, "{}", stopped.stderr);
        assert_eq!(fs::read_to_string(&journal).unwrap(), text);
        let again = folder.json(&rows("bands.step=50 cm^-1"));
        assert_eq!((&again["kept"], &again["computed"], &again["failed"]), (&1.into(), &0.into(), &0.into()));
    }
}
