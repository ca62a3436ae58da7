//! Where the machine fails, not the user: nobody takes what is said, threads cannot be had, a file has no end. And what no
//! file may do: make the program end without a word, or say what is in it.

use crate::support::folder::{Folder, SCENARIO};
use crate::support::sound::fault;
use std::process::{Command, Stdio};

fn program() -> Command {
    Command::new(assert_cmd::cargo::cargo_bin!("hadar"))
}

/// Commands that answer, and one that warns besides.
const ANSWERS: &[&[&str]] = &[
    &["size", "a.toml"],
    &["size", "a.toml", "--stats", "--out", "out"],
    &["identify", "a.toml", "--library", "aluminium.csv"],
    &["cameras", "list"],
    &["materials", "list"],
    &["simulate", "a.toml", "--spectra", "80"],
];

fn folder() -> Folder {
    let folder = Folder::with(SCENARIO);
    folder.file("aluminium.csv", "wavenumber_cm1,emissivity\n600,0.05\n1400,0.06\n");
    folder
}

#[cfg(target_os = "linux")]
#[test]
fn a_stderr_that_takes_nothing_changes_no_answer() {
    let full = || std::fs::File::options().write(true).open("/dev/full").unwrap();
    for arguments in ANSWERS {
        let run = |stderr: Stdio| {
            let folder = folder();
            program().current_dir(folder.path()).args(*arguments).stderr(stderr).output().unwrap()
        };
        let (heard, unheard) = (run(Stdio::piped()), run(full().into()));
        assert_eq!((unheard.status.code(), &unheard.stdout), (Some(0), &heard.stdout), "{arguments:?}");
    }
    for (arguments, code) in
        [(&["size", "none.toml"][..], 1), (&["size"], 2), (&["size", "a.toml", "--threads", "9999"], 1)]
    {
        let status = program().current_dir(folder().path()).args(arguments).stderr(full()).status().unwrap();
        assert_eq!(status.code(), Some(code), "{arguments:?}");
    }
    // Where the answer cannot be given, that is an error: nobody may take the silence for one.
    for arguments in [&["cameras", "list"][..], &["--help"], &["size", "--help"]] {
        let output = program().args(arguments).stdout(full()).stderr(Stdio::piped()).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        assert!(String::from_utf8_lossy(&output.stderr).starts_with("error: "), "{arguments:?}");
    }
}

/// The program behind a limit of the shell's, such as that of its stack.
#[cfg(target_os = "linux")]
fn limited(limit: &str) -> Command {
    let mut shell = Command::new("sh");
    shell.args(["-c", &format!("ulimit {limit}; exec \"$0\" \"$@\"")]);
    shell.arg(assert_cmd::cargo::cargo_bin!("hadar"));
    shell
}

/// In two gigabytes of addresses there is no room for the stacks of a thousand threads.
#[cfg(target_os = "linux")]
#[test]
fn threads_that_cannot_be_started_leave_one_that_does_the_work() {
    let folder = folder();
    let run = |mut program: Command, threads: &str, flags: &[&str]| {
        let arguments = [&["size", "a.toml", "--threads", threads], flags].concat();
        let output = program.current_dir(folder.path()).args(arguments).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{said}");
        (output.stdout, said)
    };
    let (answer, silent) = run(program(), "3", &[]);
    let (same, said) = run(limited("-v 2000000"), "1024", &[]);
    assert_eq!((answer == same, silent.as_str()), (true, ""));
    assert!(said.starts_with("warning: 1024 threads cannot be started ("), "{said}");
    assert!(said.trim_end().ends_with("); one does the work"), "{said}");
    assert_eq!(run(limited("-v 2000000"), "1024", &["--quiet"]), (answer, String::new()));
}

/// Neither the shell's limit nor the environment says how deep the work may go.
#[cfg(target_os = "linux")]
#[test]
fn the_stack_is_that_of_the_program() {
    let folder = folder();
    let run = |mut program: Command| {
        let output = program.current_dir(folder.path()).args(["size", "a.toml"]).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        output.stdout
    };
    let answer = run(program());
    assert!(answer == run(limited("-s 256")));
    let mut small = program();
    small.env("RUST_MIN_STACK", "16384");
    assert!(answer == run(small));
}

#[test]
fn more_threads_than_any_machine_has_are_capped() {
    let folder = folder();
    let output = program()
        .current_dir(folder.path())
        .args(["size", "a.toml"])
        .env("RAYON_NUM_THREADS", "100000")
        .output()
        .unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("RAYON_NUM_THREADS is 100000; 1024 threads are taken"), "{said}");
    let refused = folder.refusal(&["size", "a.toml", "--threads", "100000"]);
    assert_eq!(refused, "--threads is 100000; it must be at most 1024, or 0 for all cores");
}

/// A pipe that nobody writes would be waited for, for ever.
#[cfg(unix)]
#[test]
fn pipes_and_devices_are_refused_wherever_a_file_is_read() {
    let folder = Folder::with(SCENARIO);
    let made = Command::new("mkfifo").arg(folder.path().join("pipe")).status();
    assert!(made.is_ok_and(|status| status.success()), "a pipe could not be made");
    std::fs::copy(folder.path().join("a.toml"), folder.path().join("b.toml")).unwrap();
    let scenario = |from: &str, to: &str| {
        let text = SCENARIO.replace(from, to);
        assert_ne!(text, SCENARIO);
        text
    };
    let cube = "[cube]\nleft = \"FILE\"\n[stereo]\nbaseline = \"0.2 m\"\nfocal_length = \"14 mm\"\npixel = \"12 um\"\n";
    for file in ["pipe", "/dev/zero", "/dev/null"] {
        let named = |text: &str| text.replace("FILE", file);
        folder.file("spectrum.toml", &named(&scenario("\"skin\"", "\"./FILE\"").replace("./FILE", "FILE")));
        folder.file("filters.toml", &named(&scenario("step = \"5 cm^-1\"", "filters = \"FILE\"")));
        folder.file("rows.toml", &named(&scenario("step = \"5 cm^-1\"", "rows = \"FILE\"")));
        folder.file(
            "air.toml",
            &named(
                &scenario("[bands]", "[atmosphere]\ntable = \"FILE\"\ntemperature = \"15 degC\"\n[bands]")
                    .replace("37 degC\"", "37 degC\"\ndistance = \"1 m\""),
            ),
        );
        folder.file(
            "efficiency.toml",
            &named(&scenario(
                "preset = \"flir-a325sc\"",
                "preset = \"flir-a325sc\"\nquantum_efficiency = \"FILE\"",
            )),
        );
        folder.file("cube.toml", &named(cube));
        for arguments in [
            &["size", file][..],
            &["rule", file],
            &["range", file],
            &["size", "filters.toml"],
            &["size", "rows.toml"],
            &["size", "air.toml"],
            &["size", "efficiency.toml"],
            &["range", "cube.toml"],
            &["materials", "import", file],
            &["materials", "list", "--library", file],
            &["simulate", "b.toml", "--model", file],
        ] {
            let said = folder.refusal(arguments);
            assert!(
                said.contains("this is no ordinary file but a pipe or a device"),
                "{arguments:?}: {said}"
            );
        }
    }
}

#[test]
fn nothing_of_a_file_that_is_no_spectrum_is_said() {
    for secret in [
        "hunter2 is the password\nof all\n",
        "root:x:0:0:root:/root:/bin/sh\n",
        "hunter2,root\n1,2\n",
        "hunter2;root\n1;2\n",
    ] {
        for (key, from) in [("\"my.csv\"", "\"skin\""), ("filters = \"my.csv\"", "step = \"5 cm^-1\"")] {
            let folder = Folder::with(&SCENARIO.replace(from, key));
            folder.file("my.csv", secret);
            let said = folder.refusal(&["size", "a.toml"]);
            assert!(!said.contains("hunter2") && !said.contains("root"), "{said}");
            assert!(
                said.contains("my.csv")
                    && (said.contains("wavenumber_cm1") || said.contains("wavelength_um")),
                "{said}"
            );
        }
    }
}

/// What lies beyond all measure is refused from its size, before memory is asked for.
#[test]
fn cameras_beyond_all_measure_are_refused_before_they_are_drawn() {
    let scene = "[scene]\nsize = [24, 32]\n[bands]\nstep = \"100 cm^-1\"\n[camera]\nexposure = \"12 ms\"\npixel = \"12 um\"\n\
                 f_number = 1.4\nfocal_length = \"14 mm\"\nnoise_electrons = 0\n[stereo]\nbaseline = \"0.2 m\"\n";
    for (from, to, said) in [
        ("0.2 m", "1e30 m", "disparity of the nearest ground is"),
        ("0.2 m", "1e9 m", "disparity of the nearest ground is"),
        ("12 um", "1e-17 um", "disparity of the nearest ground is"),
        ("[24, 32]", "[16000, 16000]", "pixels fit into memory"),
    ] {
        let folder = Folder::with(&scene.replace(from, to));
        assert_eq!(fault(folder.path(), &["range", "a.toml"].map(str::to_owned)), None);
        let refused = folder.refusal(&["range", "a.toml"]);
        assert!(refused.contains(said), "{to}: {refused}");
    }
}

#[test]
fn temperatures_of_alternatives_are_those_that_a_scene_may_have() {
    for end in ["1e308 degC", "2e6 K"] {
        let range = format!("[alternatives]\ntemperature = [\"0 degC\", \"{end}\"]");
        let said = Folder::with(&SCENARIO.replace("[alternatives]", &range)).refusal(&["size", "a.toml"]);
        assert!(said.starts_with("a.toml:8: alternatives.temperature: temperature is "), "{said}");
        assert!(said.ends_with("it must be between 1e-6 and 1e6 K"), "{said}");
    }
}

/// A prior that is all but certain is certain: what is known to 1e-20 and to 5e-324 gives one answer.
#[test]
fn a_prior_of_next_to_nothing_is_certainty() {
    let with = |sigma: &str| {
        let text =
            SCENARIO.replace("[camera]", &format!("[unknown]\npriors = {{ lighting = {sigma} }}\n[camera]"));
        let result = Folder::with(&text).json(&["size", "a.toml"]);
        ["distance_local", "distance_nearest", "photons_required"]
            .map(|key| result["pairs"][0][key].as_f64().unwrap())
    };
    let certain = with("1e-20");
    for sigma in ["5e-324", "1e-310", "1e-160"] {
        for (found, expected) in with(sigma).iter().zip(&certain) {
            assert!((found / expected - 1.0).abs() < 1e-9, "{sigma}: {found}, {expected}");
        }
    }
}

/// The last bit of a number of photons draws the same counts.
#[test]
fn the_last_bit_of_the_photons_changes_no_draw() {
    let folder = Folder::with(SCENARIO);
    let drawn = |photons: f64| {
        let photons = format!("{photons:e}");
        let arguments = [
            "simulate",
            "a.toml",
            "--shot-noise-only",
            "--spectra",
            "200",
            "--classifiers",
            "likelihood-ratio,discriminant",
        ];
        let result = folder.json(&[&arguments[..], &["--photons", &photons]].concat());
        let mut found = result["points"][0]["performances"].clone();
        // The share of photons is of the limit, which follows the photons to the last bit.
        for performance in found.as_array_mut().into_iter().flatten() {
            let Some(performance) = performance.as_object_mut() else { continue };
            performance.retain(|key, _| !key.starts_with("photon_share"));
        }
        found
    };
    let photons = 2.345_678_912_345_678e5;
    assert!(drawn(photons).is_array());
    assert_eq!(drawn(photons), drawn(f64::next_up(photons)));
    assert_ne!(drawn(photons), drawn(photons * (1.0 + 1e-6)));
}

/// By a distance that is no limit nothing is ruled out, and the limit stands beside it.
#[test]
fn a_local_distance_is_never_called_a_limit() {
    let photons = [
        "",
        "[camera]\npreset = \"flir-a325sc\"\n",
        "[camera]\npreset = \"ideal-pnrd\"\n",
        "[camera]\npreset = \"flir-a325sc\"\nfull_well = 1e3\n",
    ];
    let head = SCENARIO.split("[camera]").next().unwrap();
    for camera in photons {
        for by in ["local", "local-unknown-gain"] {
            let folder = Folder::with(&format!("{head}{camera}"));
            for command in [
                &["size"][..],
                &["identify"],
                &["identify", "--matrix"],
                &["size", "--check"],
                &["identify", "--check"],
            ] {
                if camera.is_empty() && command.contains(&"--check") {
                    continue;
                }
                for json in [&[][..], &["--json"]] {
                    let outcome =
                        folder.run(&[&command[..1], &["a.toml", "--by", by], &command[1..], json].concat());
                    let said = &outcome.stdout;
                    assert!(matches!(outcome.code, 0 | 3), "{}", outcome.stderr);
                    for never in [
                        "at most",
                        "cannot distinguish",
                        "cannot be distinguished",
                        "upper limit",
                        "No camera",
                        "no algorithm",
                        "d is a limit",
                    ] {
                        assert!(!said.contains(never), "{command:?} by {by}: `{never}` in\n{said}");
                    }
                    // A matrix in JSON has no sentence.
                    if json.is_empty() || command[0] == "size" {
                        assert!(said.contains("no limit"), "{command:?} by {by}: {said}");
                    }
                }
            }
            let result = folder.json(&["size", "a.toml", "--by", by]);
            let nearest = folder.json(&["size", "a.toml"]);
            for value in [&result["verdict"], &result["pairs"][0]] {
                assert_eq!(value["statistical_distance_nearest"], nearest["verdict"]["statistical_distance"]);
            }
            assert!(
                camera.is_empty()
                    || result["verdict"]["sentence"].as_str().unwrap().contains("the limit, by the nearest")
            );
        }
    }
}

/// A mirror in all but empty space beside a metal: its distance is beyond all numbers, which is said, not `null` and `ok`.
#[test]
fn a_distance_beyond_all_numbers_is_refused() {
    let dark =
        SCENARIO.replace("\"skin\"", "\"mirror.csv\"").replace("[camera]\npreset = \"flir-a325sc\"\n", "");
    for lighting in ["1e-300", "1e-310", "5e-324"] {
        let folder = Folder::with(&dark.replace("lighting = 0.5", &format!("lighting = {lighting}")));
        folder.file("mirror.csv", "wavenumber_cm1,emissivity\n600,0\n1400,0\n");
        let said = folder.refusal(&["identify", "a.toml"]);
        assert!(said.contains("a distance beyond all numbers: the target sends next to nothing"), "{said}");
    }
    // As little light as still has a distance: an alternative that is dark and cold is as dim.
    let folder = Folder::with(&dark.replace("lighting = 0.5", "lighting = 1e-130"));
    folder.file("mirror.csv", "wavenumber_cm1,emissivity\n600,0\n1400,0\n");
    let pair = &folder.json(&["identify", "a.toml"])["pairs"][0];
    assert!(pair["distance_nearest"].as_f64().is_some_and(|distance| distance < 1.0), "{pair}");
}
