//! Sweeps: rows against the single commands, what is done again and what is not, shards, mistakes, tables that others read.

use crate::support::folder::{Folder, SCENARIO};
use hadar::cube::Shape;
use hadar_formats::cube::write_npy;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

const GRID: [&str; 6] = [
    "--vary",
    "camera.exposure=1 ms, 4 ms",
    "--vary",
    "target.temperature=30 degC..40 degC:2",
    "--columns",
    "verdict,requirement.photons,pairs[0].distance_return,pairs[0].relative_error",
];

fn sweep(folder: &Folder, more: &[&str]) -> Value {
    folder.json(&[&["sweep", "a.toml", "--out", "out"], more].concat())
}

/// Rows of a table by the heads of its columns.
fn rows(path: &Path) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    reader.deserialize().map(Result::unwrap).collect()
}

fn number(row: &BTreeMap<String, String>, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column} in {row:?}"))
}

/// Every row says what the command says of a file in which its values are written.
#[test]
fn a_row_is_the_answer_of_the_command() {
    let folder = Folder::with(SCENARIO);
    let said = sweep(&folder, &GRID);
    assert_eq!((&said["rows"], &said["answered"], &said["computed"]), (&4.into(), &4.into(), &4.into()));
    let table = rows(&folder.path().join("out/sweep.csv"));
    assert_eq!(table.len(), 4);
    for (row, (exposure, temperature)) in
        table.iter().zip([("1", "30"), ("1", "40"), ("4", "30"), ("4", "40")])
    {
        assert_eq!(
            (number(row, "camera.exposure_ms"), number(row, "target.temperature_degC")),
            (exposure.parse().unwrap(), temperature.parse().unwrap())
        );
        let text = SCENARIO.replace("37 degC", &format!("{temperature} degC"));
        folder.file("b.toml", &format!("{text}exposure = \"{exposure} ms\"\n"));
        let alone = folder.json(&["size", "b.toml"]);
        let margin = alone["verdict"]["margin"].as_f64().unwrap();
        assert_eq!(number(row, "verdict.margin"), margin, "{exposure} ms, {temperature} degC");
        // Rows of one temperature share what does not depend on the exposure, to the last bit.
        let photons = alone["requirement"]["photons"].as_f64().unwrap();
        assert_eq!(number(row, "requirement.photons"), photons, "{exposure} ms, {temperature} degC");
        for name in ["distance_return", "relative_error"] {
            let own = alone["pairs"][0][name].as_f64().unwrap();
            assert_eq!(number(row, &format!("pairs[0].{name}")), own, "{name}");
        }
        assert_eq!(row["verdict.sentence"], alone["verdict"]["sentence"].as_str().unwrap());
        assert_eq!(row["status"], "ok");
    }
    for name in
        ["map_verdict_margin.svg", "map_verdict_margin.csv", "sweep.parquet", "report.html", "hadar.json"]
    {
        assert!(folder.path().join("out").join(name).is_file(), "{name}");
    }
    // The picture's numbers are those of the table.
    let map = rows(&folder.path().join("out/map_verdict_margin.csv"));
    assert_eq!(number(&map[1], "verdict.margin"), number(&table[2], "verdict.margin"));
    let manifest = fs::read_to_string(folder.path().join("out/hadar.json")).unwrap();
    assert!(manifest.contains("built-in: material skin") && manifest.contains("a.toml"), "{manifest}");
}

#[test]
fn what_is_done_is_not_done_again_unless_something_it_read_has_changed() {
    let folder = Folder::with(&SCENARIO.replace("\"aluminium\"", "\"./own.csv\""));
    folder.file("own.csv", "wavenumber_cm1,emissivity\n500,0.5\n2000,0.6\n");
    let vary = |values: &str| {
        ["--vary".to_owned(), format!("target.distance={values}"), "--columns".into(), "verdict".into()]
    };
    let done = |values: &str| {
        let vary = vary(values);
        let said = sweep(&folder, &vary.each_ref().map(String::as_str));
        (
            said["computed"].as_u64().unwrap(),
            said["kept"].as_u64().unwrap(),
            said["answered"].as_u64().unwrap(),
        )
    };
    assert_eq!(done("5 m,6 m,7 m"), (3, 0, 3));
    let table = folder.path().join("out/sweep.csv");
    let first = fs::read(&table).unwrap();
    assert_eq!(done("5 m,6 m,7 m"), (0, 3, 3));
    assert_eq!(fs::read(&table).unwrap(), first);
    // More values: the others stay.
    assert_eq!(done("4 m,5 m,6 m,7 m"), (1, 3, 4));
    // Killed within a line: that row alone is lost.
    let journal = folder.path().join("out/.sweep/1-of-1.jsonl");
    let text = fs::read(&journal).unwrap();
    fs::write(&journal, &text[..text.len() - 40]).unwrap();
    assert_eq!(done("4 m,5 m,6 m,7 m"), (1, 3, 4));
    assert_eq!(done("4 m,5 m,6 m,7 m"), (0, 4, 4));
    folder.file("own.csv", "wavenumber_cm1,emissivity\n500,0.5\n2000,0.7\n");
    assert_eq!(done("5 m,6 m,7 m"), (3, 0, 3));
    assert_ne!(fs::read(&table).unwrap(), first);
    folder.file("a.toml", &SCENARIO.replace("37 degC", "36 degC"));
    assert_eq!(done("5 m,6 m,7 m"), (3, 0, 3));
}

#[test]
fn a_bad_row_has_its_message_and_the_others_their_answers() {
    let folder = Folder::with(SCENARIO);
    let said = sweep(
        &folder,
        &["--vary", "target.material=skin,wood-that-is-none,pmma", "--columns", "verdict.margin"],
    );
    assert_eq!((&said["answered"], &said["failed"]), (&2.into(), &1.into()));
    let table = rows(&folder.path().join("out/sweep.csv"));
    assert_eq!(table[1]["status"], "error");
    let message = &table[1]["message"];
    assert!(
        message.starts_with("'--vary target.material: there is no material `wood-that-is-none`"),
        "{message}"
    );
    assert!(table[1]["verdict.margin"].is_empty() && number(&table[2], "verdict.margin") > 0.0);
    // Where nothing goes well the code says so.
    let lost = folder.run(&["sweep", "a.toml", "--out", "lost", "--vary", "target.material=none-1,none-2"]);
    assert_eq!(lost.code, 1, "{}", lost.stdout);
    assert!(lost.stdout.contains("2 failed"), "{}", lost.stdout);
}

#[test]
fn shards_and_threads_make_the_table_of_one_run() {
    let folder = Folder::with(SCENARIO);
    sweep(&folder, &[&GRID[..], &["--threads", "1"]].concat());
    let of = |out: &str, more: &[&str]| {
        folder.json(&[&["sweep", "a.toml", "--out", out], &GRID[..], more].concat())
    };
    let first = of("shards", &["--shard", "1/3"]);
    assert_eq!(
        (&first["computed"], &first["to_go"], &first["files"]),
        (&2.into(), &2.into(), &Value::Array(vec![]))
    );
    assert!(!folder.path().join("shards/sweep.csv").exists());
    let merged = of("shards", &["--merge"]);
    assert_eq!(
        (&merged["computed"], &merged["answered"], &merged["to_go"]),
        (&0.into(), &2.into(), &2.into())
    );
    assert_eq!(rows(&folder.path().join("shards/sweep.csv")).len(), 2);
    of("shards", &["--shard", "3/3", "--threads", "3"]);
    assert_eq!(of("shards", &["--shard", "2/3"])["to_go"], 0);
    for name in ["sweep.csv", "sweep.parquet", "hadar.json", "report.html"] {
        let read = |out: &str| fs::read(folder.path().join(out).join(name)).unwrap();
        assert_eq!(read("shards"), read("out"), "{name}");
    }
}

#[test]
fn cases_go_together_and_an_empty_cell_leaves_what_the_file_says() {
    let folder = Folder::with(SCENARIO);
    folder.file("cases.csv", "target.temperature,camera.preset\n30 degC,ideal-pnrd\n,\n");
    sweep(
        &folder,
        &[
            "--cases",
            "cases.csv",
            "--vary",
            "alternatives.materials=[\"aluminium\"]",
            "--columns",
            "verdict.margin,camera.name",
        ],
    );
    let table = rows(&folder.path().join("out/sweep.csv"));
    assert_eq!(table.len(), 2);
    assert_eq!(
        (number(&table[0], "target.temperature_degC"), table[1]["target.temperature_degC"].as_str()),
        (30.0, "")
    );
    let alone = folder.json(&["size", "a.toml"]);
    assert_eq!(number(&table[1], "verdict.margin"), alone["verdict"]["margin"].as_f64().unwrap());
    assert_eq!(table[0]["camera.name"], "ideal-pnrd");
}

/// Times in two units are numbers in that of the first; cases that are a grid are drawn as axes are, in any order.
#[test]
fn cases_that_are_a_grid_are_drawn_and_others_say_why_not() {
    let folder = Folder::with(SCENARIO);
    let of = |out: &str, more: &[&str]| {
        folder.run(&[&["sweep", "a.toml", "--out", out, "--columns", "verdict.margin"], more].concat())
    };
    folder.file(
        "grid.csv",
        "camera.exposure;target.temperature\n0.001 s;30 degC\n4 ms;40 degC\n1 ms;40 degC\n4000 \u{3bc}s;30 degC\n",
    );
    let drawn = of("grid", &["--cases", "grid.csv"]);
    assert!(drawn.code == 0 && !drawn.stdout.contains("No picture"), "{}{}", drawn.stdout, drawn.stderr);
    let table = rows(&folder.path().join("grid/sweep.csv"));
    let exposures: Vec<f64> = table.iter().map(|row| number(row, "camera.exposure_s")).collect();
    assert_eq!(exposures, [0.001, 0.004, 0.001, 0.004]);
    let map = |out: &str| {
        let mut map: Vec<Vec<String>> = rows(&folder.path().join(out).join("map_verdict_margin.csv"))
            .iter()
            .map(|row| ["target.temperature_degC", "verdict.margin"].map(|name| row[name].clone()).into())
            .collect();
        map.sort();
        map
    };
    of("axes", &["--vary", "camera.exposure=1 ms,4 ms", "--vary", "target.temperature=30 degC..40 degC:2"]);
    assert_eq!(map("grid"), map("axes"));
    folder.file("none.csv", "camera.exposure,target.temperature\n1 ms,30 degC\n4 ms,40 degC\n");
    let none = of("none", &["--cases", "none.csv"]);
    assert!(none.stdout.contains("No picture is drawn: the cases are no grid"), "{}", none.stdout);
    assert!(!folder.path().join("none/map_verdict_margin.csv").exists());
    let three = "--vary|camera.exposure=1 ms,4 ms|--vary|target.distance=5 m,6 m|--vary|target.temperature=30 degC,31 degC";
    let three = of("three", &three.split('|').collect::<Vec<_>>());
    assert!(three.stdout.contains("No picture is drawn: 3 keys vary"), "{}", three.stdout);
}

/// One line, nothing written, before any work.
#[test]
fn mistakes_are_refused_before_any_work() {
    let folder = Folder::with(SCENARIO);
    folder.file("short.csv", "target.temperature,target.distance\n30 degC,5 m\n31 degC\n");
    folder.file("unknown.csv", "target.temprature\n30 degC\n");
    folder.file("twice.csv", "target.distance,target.distance\n5 m,6 m\n");
    let refused =
        |arguments: &[&str]| folder.refusal(&[&["sweep", "a.toml", "--out", "out"], arguments].concat());
    for (vary, said) in [
        (
            "camera.expsure=1 ms..5 ms:3",
            "--vary camera.expsure: there is no key `expsure`; the nearest are `exposure`",
        ),
        ("camera.exposure=1 m..5 m:3", "--vary camera.exposure: `m` is not a unit of time"),
        ("camera.exposure=1..5:3", "--vary camera.exposure: `1` is a number without a unit"),
        ("camera.exposure=5 ms..5 ms:3", "--vary camera.exposure: the range goes from 5 ms to 5 ms"),
        ("camera.exposure=9 ms..5 ms:3", "--vary camera.exposure: the range goes from 9 ms to 5 ms"),
        (
            "camera.exposure=1 us..5 ms:3",
            "--vary camera.exposure: the range goes from `1 us` to `5 ms`, in two units",
        ),
        ("camera.exposure=0 ms..5 ms:3:log", "--vary camera.exposure: `0 ms` on a logarithmic scale"),
        (
            "camera.exposure=1 ms..5 ms:3:lin",
            "--vary camera.exposure: `1 ms..5 ms:3:lin` ends in something unknown",
        ),
        ("camera.exposure=1 ms..5 ms", "--vary camera.exposure: `1 ms..5 ms` does not say how many"),
        ("camera.exposure=1 ms..5 ms:0", "--vary camera.exposure: `0` values of a range"),
        ("camera.exposure=1 ms..5 ms:1", "--vary camera.exposure: `1` values of a range"),
        (
            "camera.exposure=1 ms..5 ms:99999999999999999999",
            "--vary camera.exposure: `99999999999999999999` values",
        ),
        (
            "target.temperature=1 degC..9 degC:3:log",
            "--vary target.temperature: degrees of degC on a logarithmic",
        ),
        ("camera.exposure", "`camera.exposure` is no key with values"),
        ("camera.exposure=", "`camera.exposure=` is no key with values"),
        ("target.material=skin,,pmma", "--vary target.material: the list has nothing at place 2"),
        ("target.material=skin,skin", "--vary target.material: `skin` stands there twice"),
        ("environment[3].lighting=0.1,0.2", "--vary environment[3].lighting: there is no environment[3]"),
        ("environment.lighting=0.1,0.2", "--vary environment.lighting: environment is a list"),
        ("target.material.x=1,2", "--vary target.material.x: target.material is a value and no table"),
        ("a..b=1,2", "--vary a..b: this is no key"),
    ] {
        let message = refused(&["--vary", vary]);
        assert!(message.starts_with(said), "{vary}: {message}");
    }
    let big = "camera.exposure=1 ms..5 ms:1000000";
    for (arguments, said) in [
        (&["--vary", big, "--vary", "target.distance=1 m..9 m:1000000"][..], "1000000 x 1000000 rows"),
        (
            &["--vary", "target.distance=5 m,6 m", "--vary", "target.distance=7 m,8 m"],
            "`target.distance` is varied twice",
        ),
        (&["--vary", "target.distance=5 m,6 m", "--shard", "3/2"], "--shard: `3/2` is no shard"),
        (&["--vary", "target.distance=5 m,6 m", "--shard", "0/2"], "--shard: `0/2` is no shard"),
        (
            &["--vary", "target.distance=5 m,6 m", "--command", "sizes"],
            "--command: there is no command for rows `sizes`",
        ),
        (&["--cases", "short.csv"], "short.csv:3: 1 cells where the header has 2"),
        (&["--cases", "unknown.csv"], "--cases target.temprature: there is no key `temprature`"),
        (&["--cases", "twice.csv"], "twice.csv:1: two columns of the key `target.distance`"),
        (&["--cases", "none.csv"], "none.csv: cannot read the cases: there is no such file"),
        (&[], "nothing is varied"),
    ] {
        let message = refused(arguments);
        assert!(message.starts_with(said), "{arguments:?}: {message}");
    }
    assert!(
        folder
            .refusal(&["sweep", "a.toml", "--vary", "target.distance=5 m,6 m"])
            .starts_with("there is no folder")
    );
    // Files of others in the folder.
    fs::create_dir(folder.path().join("mine")).unwrap();
    folder.file("mine/notes.txt", "x");
    let message = folder.refusal(&["sweep", "a.toml", "--vary", "target.distance=5 m,6 m", "--out", "mine"]);
    assert!(message.contains("it holds `notes.txt`"), "{message}");
}

#[test]
fn a_column_that_is_none_is_refused_with_those_that_are_like_it_and_no_row_is_lost() {
    let folder = Folder::with(SCENARIO);
    let arguments = ["sweep", "a.toml", "--out", "out", "--vary", "target.distance=5 m,6 m", "--columns"];
    let outcome = folder.run(&[&arguments[..], &["verdict.margn"]].concat());
    assert_eq!(outcome.code, 1);
    assert!(
        outcome
            .stderr
            .contains("--columns: there is no column `verdict.margn`; the nearest are `verdict.margin`"),
        "{}",
        outcome.stderr
    );
    let said = folder.json(&[&arguments[..], &["verdict.margin"]].concat());
    assert_eq!(said["computed"], 0, "{said}");
}

/// What is kept of a row is what was asked for: less of it is there at once, more is computed.
#[test]
fn rows_keep_the_columns_that_were_asked_for() {
    let folder = Folder::with(SCENARIO);
    let of = |columns: &str| {
        let said = sweep(&folder, &["--vary", "target.distance=5 m,6 m", "--columns", columns]);
        (said["computed"].as_u64().unwrap(), said["kept"].as_u64().unwrap())
    };
    assert_eq!(of("requirement,limiting"), (2, 0));
    let journal = fs::read_to_string(folder.path().join("out/.sweep/1-of-1.jsonl")).unwrap();
    assert_eq!(journal.lines().count(), 3, "{journal}");
    assert!(journal.contains("\"requirement.photons\"") && !journal.contains("photon_radiance"), "{journal}");
    let photons = |name: &str| rows(&folder.path().join("out/sweep.csv"))[1][name].clone();
    let first = photons("requirement.photons");
    assert_eq!(of("requirement.photons"), (0, 2));
    assert_eq!(photons("requirement.photons"), first);
    // A verdict rests on the errors of the emissivities, which nobody has computed yet.
    assert_eq!(of("verdict.margin"), (2, 0));
    let alone = folder.run(&[
        "sweep",
        "a.toml",
        "--out",
        "alone",
        "--vary",
        "target.distance=5 m,6 m",
        "--columns",
        "verdict.margin",
    ]);
    assert_eq!(alone.code, 0, "{}", alone.stderr);
    let [again, alone] =
        ["out", "alone"].map(|out| fs::read(folder.path().join(out).join("sweep.csv")).unwrap());
    assert_eq!(again, alone);
}

/// The table that a sweep has written is asked again, to the last byte, bad rows among it.
#[test]
fn a_table_of_a_sweep_is_asked_again() {
    let folder = Folder::with(SCENARIO);
    folder.file(
        "cases.csv",
        "target.temperature,target.material,camera.exposure,camera.frames,alternatives.lighting\n\
         30 degC,skin,1 ms,,\"[0.1, 0.9]\"\n31.5 degC,none-such,0.5 ms,4,\n,pmma,,2,\n",
    );
    let of = |cases: &str, out: &str| {
        let columns = "verdict.margin,requirement.photons";
        let said = folder.json(&["sweep", "a.toml", "--cases", cases, "--out", out, "--columns", columns]);
        assert_eq!((&said["answered"], &said["failed"]), (&2.into(), &1.into()), "{said}");
        fs::read_to_string(folder.path().join(out).join("sweep.csv")).unwrap()
    };
    let first = of("cases.csv", "out");
    assert!(first.starts_with("row,target.temperature_degC,target.material,camera.exposure_ms,"), "{first}");
    assert_eq!(of("out/sweep.csv", "again"), first);
}

#[test]
fn two_processes_do_not_work_on_the_same_rows() {
    let folder = Folder::with(SCENARIO);
    fs::create_dir_all(folder.path().join("out/.sweep")).unwrap();
    let held = fs::File::create(folder.path().join("out/.sweep/1-of-1.jsonl")).unwrap();
    held.lock().unwrap();
    let arguments =
        ["sweep", "a.toml", "--out", "out", "--vary", "target.distance=5 m,6 m", "--columns", "verdict"];
    let message = folder.refusal(&arguments);
    assert!(message.contains("another process works on the same rows"), "{message}");
    drop(held);
    assert_eq!(folder.json(&arguments)["answered"], 2);
}

/// Rows that somebody else wrote are told by computing some of them again; all of them, where that is asked for.
#[test]
fn a_forged_row_is_not_believed() {
    let folder = Folder::with(SCENARIO);
    let arguments =
        ["sweep", "a.toml", "--out", "out", "--vary", "target.distance=5 m,6 m,7 m", "--columns", "verdict"];
    assert_eq!(folder.json(&arguments)["answered"], 3);
    let [journal, table] = ["out/.sweep/1-of-1.jsonl", "out/sweep.csv"].map(|name| folder.path().join(name));
    let (true_rows, true_table) = (fs::read_to_string(&journal).unwrap(), fs::read(&table).unwrap());
    let forgeries: [&dyn Fn(&str) -> String; 4] = [
        &|row| row.replace("\"verdict.met\":false", "\"verdict.met\":true"),
        &|row| row.replace("\"verdict.lower\":", "\"verdict.lower\":9"),
        &|row| row.replace("\"verdict.scope\":\"pixel\",", ""),
        &|row| row.replace("\"verdict.scope\"", "\"verdict.more\":1,\"verdict.scope\""),
    ];
    for forged in forgeries {
        for which in 0..3 {
            // Before the rows stands what they rest on.
            let rows = true_rows.lines().enumerate();
            let rows: Vec<String> =
                rows.map(|(at, row)| if at == which + 1 { forged(row) } else { row.to_owned() }).collect();
            assert_ne!(rows.join("\n"), true_rows.trim_end());
            fs::write(&journal, rows.join("\n") + "\n").unwrap();
            let message = folder.refusal(&arguments);
            assert!(message.contains(", of an earlier run or another shard, has "), "{message}");
            assert_eq!(fs::read(&table).unwrap(), true_table);
            // Its own rows are those of this run, whatever else stands there.
            let all = folder.json(&[&arguments[..], &["--recompute", "all"]].concat());
            assert_eq!((&all["computed"], &all["kept"]), (&3.into(), &0.into()), "{all}");
            assert_eq!(fs::read(&table).unwrap(), true_table);
            fs::write(&journal, &true_rows).unwrap();
        }
    }
    let kept = folder.run(&[&arguments[..], &["--recompute", "2"]].concat());
    let said = "3 rows are of earlier runs or other shards; 2 of them were computed again, and are the same.";
    assert!(kept.stdout.contains(said), "{}", kept.stdout);
    let usage = folder.run(&[&arguments[..], &["--recompute", "some"]].concat());
    assert_eq!(usage.code, 2);
    assert!(usage.stderr.contains("write a number of rows, or all"), "{}", usage.stderr);
}

/// Neither the folder of the rows nor a file in it leads anywhere else.
#[cfg(unix)]
#[test]
fn no_link_of_the_rows_is_followed() {
    use std::os::unix::fs::symlink;
    let arguments =
        ["sweep", "a.toml", "--out", "out", "--vary", "target.distance=5 m,6 m", "--columns", "verdict"];
    let plant = |name: &str, how: &dyn Fn(&std::path::Path, &std::path::Path)| {
        let folder = Folder::with(SCENARIO);
        let at = |name: &str| folder.path().join(name);
        fs::create_dir_all(at("away")).unwrap();
        fs::write(at("away/precious"), "mine\n").unwrap();
        fs::create_dir_all(at("out").join(name).parent().unwrap()).unwrap();
        how(folder.path(), &at("out").join(name));
        let outcome = folder.run(&arguments);
        let told = outcome.stderr.contains("is a link or no ordinary file, which is not followed");
        assert!(outcome.code == 1 && told, "{name}: {}{}", outcome.stdout, outcome.stderr);
        assert_eq!(fs::read_to_string(at("away/precious")).unwrap(), "mine\n", "{name}");
        assert_eq!(fs::read_dir(at("away")).unwrap().count(), 1, "{name}");
    };
    let file =
        |home: &std::path::Path, at: &std::path::Path| symlink(home.join("away/precious"), at).unwrap();
    let none = |home: &std::path::Path, at: &std::path::Path| symlink(home.join("away/none"), at).unwrap();
    let hard =
        |home: &std::path::Path, at: &std::path::Path| fs::hard_link(home.join("away/precious"), at).unwrap();
    let folder = |home: &std::path::Path, at: &std::path::Path| symlink(home.join("away"), at).unwrap();
    let pipe = |_: &std::path::Path, at: &std::path::Path| {
        assert!(std::process::Command::new("mkfifo").arg(at).status().unwrap().success());
    };
    for how in [&file as &dyn Fn(&std::path::Path, &std::path::Path), &none, &hard, &folder, &pipe] {
        plant(".sweep/1-of-1.jsonl", how);
        plant(".sweep/report.lock", how);
    }
    plant(".sweep/2-of-2.jsonl", &file);
    plant(".sweep", &folder);
    plant(".sweep", &file);
}

/// Other commands answer rows as well; the air's scenario through `range`, a list of cameras through `rule`.
#[test]
fn every_kind_of_file_is_asked_by_its_command() {
    let folder = Folder::with(SCENARIO);
    let said = sweep(
        &folder,
        &[
            "--command",
            "identify",
            "--vary",
            "target.temperature=30 degC,35 degC",
            "--columns",
            "identifiability,pairs[0].alternative",
        ],
    );
    assert_eq!(said["command"], "identify");
    let table = rows(&folder.path().join("out/sweep.csv"));
    assert_eq!(table[0]["pairs[0].alternative"], "aluminium");
    let alone = folder.json(&["identify", "a.toml"]);
    folder.json(&[
        "sweep",
        "a.toml",
        "--command",
        "identify",
        "--out",
        "same",
        "--vary",
        "target.temperature=37 degC,38 degC",
    ]);
    let same = rows(&folder.path().join("same/sweep.csv"));
    let least = alone["identifiability"]["distance_minimum"].as_f64().unwrap();
    assert_eq!(number(&same[0], "identifiability.distance_minimum"), least);
}

/// pandas and polars read the types and values that were written.
#[test]
fn pandas_and_polars_read_the_tables() {
    const READ: &str = r#"
import sys, csv, pandas, polars
out = sys.argv[1]
rows = list(csv.DictReader(open(out + "/sweep.csv")))
for frame in (pandas.read_parquet(out + "/sweep.parquet"), polars.read_parquet(out + "/sweep.parquet")):
    types = {name: str(kind).lower() for name, kind in zip(frame.columns, frame.dtypes)}
    assert types["row"] == "int64" and types["verdict.margin"] == "float64", types
    assert types["camera.exposure_ms"] == "float64", types
    assert types["status"] == types["message"] in ("object", "str", "string") and types["verdict.met"] in ("bool", "boolean"), types
    assert list(frame["verdict.margin"]) == [float(row["verdict.margin"]) for row in rows]
    assert list(frame["verdict.sentence"]) == [row["verdict.sentence"] for row in rows]
    assert list(frame.columns) == list(rows[0]), frame.columns
print("read", len(rows))
"#;
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".into());
    let there = Command::new(&python).args(["-c", "import pandas, pyarrow, polars"]).output();
    if !there.is_ok_and(|output| output.status.success()) {
        println!("skipped: no Python with pandas, pyarrow and polars; PYTHON names one that has them");
        return;
    }
    let folder = Folder::with(SCENARIO);
    sweep(&folder, &GRID);
    let output = Command::new(&python).args(["-c", READ]).arg(folder.path().join("out")).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), "read 4");
}

#[test]
fn tables_of_a_report_are_parquet_too_where_that_is_asked_for() {
    let folder = Folder::with(SCENARIO);
    folder.json(&["identify", "a.toml", "--out", "plain"]);
    folder.json(&["identify", "a.toml", "--out", "out", "--format", "parquet"]);
    let bytes = fs::read(folder.path().join("out/pairs.parquet")).unwrap();
    assert!(bytes.starts_with(b"PAR1") && bytes.ends_with(b"PAR1"));
    let csv = |out: &str| fs::read(folder.path().join(out).join("pairs.csv")).unwrap();
    assert_eq!(csv("out"), csv("plain"));
    let outcome = folder.run(&["identify", "a.toml", "--format", "parquet"]);
    assert_eq!(outcome.code, 2, "{}", outcome.stderr);
}

/// A spectrum more in the folder of a class is another answer; so a table of nothing does not take the place of one that is there.
#[test]
fn a_file_more_in_a_folder_is_noticed() {
    let flat = |e: f64| format!("wavenumber_cm1,emissivity\n600,{e}\n1500,{}\n", e - 0.02);
    let own = "[class.thing]\nmaterials = [\"things/\"]\n";
    let folder = Folder::with(&format!(
        "{}{own}",
        SCENARIO.replace("materials = [\"aluminium\"]", "materials = [\"thing\"]")
    ));
    fs::create_dir(folder.path().join("things")).unwrap();
    folder.file("things/a.csv", &flat(0.6));
    let asked = ["--vary", "target.temperature=30 degC,37 degC", "--columns", "verdict.margin"];
    let before = sweep(&folder, &asked);
    assert_eq!(before["computed"], 2, "{before}");
    assert_eq!(sweep(&folder, &asked)["computed"], 0);
    folder.file("things/b.csv", &flat(0.9));
    let merged = folder.run(&[&["sweep", "a.toml", "--out", "out", "--merge"][..], &asked].concat());
    assert_eq!(merged.code, 1, "{}", merged.stdout);
    assert!(merged.stderr.contains("none of the 2 rows is there"), "{}", merged.stderr);
    assert_eq!(rows(&folder.path().join("out/sweep.csv")).len(), 2);
    assert_eq!(sweep(&folder, &asked)["computed"], 2);
}

/// A folder of cubes is a table with a row for each: a bad one fails in its row, and what was done is not done again.
#[test]
fn every_cube_of_a_folder_is_a_row() {
    let folder = crate::decompose::with(crate::decompose::SCENARIO);
    let cubes = folder.path().join("cubes");
    std::fs::create_dir(&cubes).unwrap();
    let whole = std::fs::read(folder.path().join("counts.npy")).unwrap();
    for name in ["b.npy", "a.npy", "c.npy"] {
        std::fs::write(cubes.join(name), &whole).unwrap();
    }
    std::fs::write(cubes.join("d.npy"), &whole[..whole.len() / 2]).unwrap();
    std::fs::write(cubes.join("readme.txt"), "no cube").unwrap();
    let sweep = [
        "sweep",
        "a.toml",
        "--vary",
        "cube.data=cubes",
        "--columns",
        "truth.temperature_rmse_k",
        "--out",
        "rows",
    ];
    let found = folder.json(&sweep);
    assert_eq!(
        (found["rows"].as_u64(), found["answered"].as_u64(), found["failed"].as_u64()),
        (Some(4), Some(3), Some(1))
    );
    let table = std::fs::read_to_string(folder.path().join("rows/sweep.csv")).unwrap();
    let rows: Vec<&str> = table.lines().filter(|line| line.contains("cubes/")).collect();
    assert!(rows[0].contains("cubes/a.npy") && rows[3].contains("cubes/d.npy"), "{table}");
    let again = folder.json(&[&sweep[..], &["--force"]].concat());
    assert_eq!(again["computed"].as_u64(), Some(1), "only the one that failed: {again}");
    // By another method, and of other questions about cubes.
    let grey = [&sweep[..4], &["--columns", "undecided", "--method", "grey-body", "--out", "grey"]].concat();
    assert_eq!(folder.json(&grey)["answered"].as_u64(), Some(3));
    let scenario = crate::decompose::SCENARIO.split("[library]").next().unwrap();
    let unknown = "[unknown]\ntemperature = [\"250 K\", \"340 K\"]\nlighting_total = 1.0\n";
    folder.file("a.toml", &format!("{scenario}{unknown}[clusters]\ncount = 2\nmax_emissivity = 0.96\n"));
    folder.file("noise.toml", "[cube]\ndata = \"counts.npy\"\n");
    // Two brightnesses, of which the variance is the mean.
    let frame: Vec<f64> = (0..12 * 16 * 5_u64)
        .map(|i| {
            let draw =
                i.wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(31).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let mean = if i / 5 % 16 < 8 { 2e5_f64 } else { 4e5 };
            mean + ((draw >> 11) as f64 / 2f64.powi(53) - 0.5) * (12.0 * mean).sqrt()
        })
        .collect();
    std::fs::create_dir(folder.path().join("frames")).unwrap();
    write_npy(&folder.path().join("frames/a.npy"), Shape::new(12, 16, 5).unwrap(), &frame).unwrap();
    std::fs::write(folder.path().join("frames/b.npy"), &whole[..whole.len() / 2]).unwrap();
    for (file, command, data, column, answered) in [
        ("a.toml", "library", "cubes", "decided", 3),
        ("noise.toml", "calibrate noise", "frames", "noise_electrons[1]", 1),
    ] {
        let vary = format!("cube.data={data}");
        let ask =
            ["sweep", file, "--command", command, "--vary", &vary, "--columns", column, "--out", command];
        let found = folder.json(&ask);
        let counts = (found["answered"].as_u64(), found["failed"].as_u64());
        assert_eq!(counts, (Some(answered), Some(1)), "{found}");
    }
    std::fs::create_dir(folder.path().join("none")).unwrap();
    let refused = folder.refusal(&["sweep", "a.toml", "--vary", "cube.data=none", "--out", "rows2"]);
    assert!(refused.contains("the folder has no cube"), "{refused}");
    folder.file("b.toml", &crate::decompose::SCENARIO.replace("counts.npy", "cubes"));
    let refused = folder.refusal(&["decompose", "b.toml"]);
    assert!(refused.contains("hadar sweep FILE --vary cube.data=FOLDER"), "{refused}");
}
