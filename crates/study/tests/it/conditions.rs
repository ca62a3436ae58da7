//! A verdict is as sure as what it rests on: a figure that nobody states never helps without being said.

use hadar::instrument::presets;
use hadar::material::Library;
use hadar_scenario::Scenario;
use hadar_study::{Condition, Grade, Study, Verdict, YesNo};
use std::fmt::Write as _;
use std::sync::OnceLock;

/// A scene and a camera of which all is stated, as rows of table, key and value.
const STATED: &[[&str; 3]] = &[
    ["target", "material", "\"skin\""],
    ["target", "temperature", "\"33 degC\""],
    ["target", "distance", "\"30 m\""],
    ["target", "size", "\"0.25 m\""],
    ["background", "temperature", "\"5 degC\""],
    ["[environment]", "temperature", "\"5 degC\""],
    ["[environment]", "lighting", "0.6"],
    ["atmosphere", "model", "\"us-standard\""],
    ["alternatives", "materials", "[\"pmma\"]"],
    ["alternatives", "temperature", "[\"0 degC\", \"50 degC\"]"],
    ["bands", "ranges", "[[\"8 um\", \"9 um\"], [\"9 um\", \"10.5 um\"], [\"10.5 um\", \"13 um\"]]"],
    ["unknown", "nuisances", "[\"temperature\", \"lighting\"]"],
    ["camera", "exposure", "\"10 ms\""],
    ["camera", "frame_rate", "\"60 Hz\""],
    ["camera", "pixel", "\"12 um\""],
    ["camera", "f_number", "1.0"],
    ["camera", "focal_length", "\"24 mm\""],
    ["camera", "optics_efficiency", "0.85"],
    ["camera", "quantum_efficiency", "0.7"],
    ["camera", "noise_electrons", "20000"],
    ["camera", "noise_exposure", "\"10 ms\""],
    ["camera", "flicker_fraction", "0.1"],
    ["camera", "fixed_pattern", "\"20 mK\""],
    ["camera", "row_noise", "\"10 mK\""],
    ["camera", "column_noise", "\"10 mK\""],
    ["camera", "offset_drift", "\"10 mK\""],
    ["camera", "pattern_drift", "\"1 min\""],
    ["camera", "dark_rate", "\"1e6 1/s\""],
    ["camera", "read_noise", "100"],
    ["camera", "full_well", "2e11"],
    ["camera", "quantisation_bits", "20"],
    ["camera", "readout", "\"sequential\""],
    ["camera", "frames", "4"],
    ["camera", "field_of_view", "\"18 deg\""],
    ["camera", "pixels", "640"],
    ["camera", "spectral_range", "[\"8 um\", \"14 um\"]"],
    ["requirement", "distance", "0.02"],
    ["requirement", "speed", "\"1 km/h\""],
    ["requirement", "time", "\"1 s\""],
];

/// Other values that keys may have.
const OTHERS: &[(&str, &str, &[&str])] = &[
    ("target", "size", &["\"0.02 m\"", "\"0.01 m\""]),
    ("target", "distance", &["\"3 m\"", "\"300 m\""]),
    ("atmosphere", "model", &["\"tropical\""]),
    ("[environment]", "lighting", &["0.1", "1.0"]),
    (
        "unknown",
        "nuisances",
        &["[]", "[\"temperature\", \"lighting\", \"gain\", \"environment-temperature\"]"],
    ),
    ("camera", "frame_rate", &["\"10 Hz\"", "\"100 Hz\""]),
    ("camera", "optics_efficiency", &["0.1", "1.0"]),
    ("camera", "quantum_efficiency", &["0.1", "1.0"]),
    ("camera", "noise_exposure", &["\"1 ms\"", "\"100 ms\""]),
    ("camera", "flicker_fraction", &["0.0", "0.5", "1.0"]),
    ("camera", "fixed_pattern", &["\"0 mK\"", "\"100 mK\""]),
    ("camera", "row_noise", &["\"0 mK\"", "\"100 mK\""]),
    ("camera", "column_noise", &["\"0 mK\"", "\"100 mK\""]),
    ("camera", "offset_drift", &["\"0 mK\"", "\"100 mK\""]),
    ("camera", "pattern_drift", &["\"1 ms\"", "\"1 h\""]),
    ("camera", "temporal_row_noise", &["\"0 mK\"", "\"100 mK\""]),
    ("camera", "temporal_column_noise", &["\"0 mK\"", "\"100 mK\""]),
    ("camera", "frame_noise", &["\"0 mK\"", "\"100 mK\""]),
    ("requirement", "of", &["\"pixel\""]),
    ("sensitivity", "emissivity_error", &["\"0.002 absolute\"", "\"0.02 absolute\""]),
    ("camera", "dark_rate", &["\"0 1/s\"", "\"1e12 1/s\""]),
    ("camera", "read_noise", &["0", "1e6"]),
    ("camera", "full_well", &["1e4", "1e12"]),
    ("camera", "quantisation_bits", &["4", "24"]),
    ("camera", "readout", &["\"simultaneous\"", "\"fourier-transform\"", "\"dispersive\""]),
    ("camera", "frames", &["1", "16"]),
    ("camera", "field_of_view", &["\"10 deg\"", "\"60 deg\""]),
    ("camera", "pixels", &["80", "1280"]),
    ("camera", "spectral_range", &["[\"7 um\", \"13.5 um\"]", "[\"3 um\", \"5 um\"]"]),
    ("camera", "exposure", &["\"1 ms\"", "\"16 ms\""]),
    ("camera", "spectral_bands", &["1", "3"]),
    ("camera", "netd_temperature", &["\"0 degC\"", "\"60 degC\""]),
    ("camera", "netd_f_number", &["0.7", "2.0"]),
    ("camera", "netd_optics_efficiency", &["0.3", "1.0"]),
    ("camera", "netd_pixel", &["\"6 um\"", "\"50 um\""]),
    ("requirement", "speed", &["\"1 m/s\"", "\"200 km/h\""]),
    ("requirement", "time", &["\"1 ms\"", "\"10 s\""]),
    ("alternatives", "temperature", &["[\"-100 degC\", \"900 degC\"]", "[\"32 degC\", \"34 degC\"]"]),
];

/// The same with a noise that is measured in front of the lens, and all that it is stated for.
fn with_netd() -> Vec<[&'static str; 3]> {
    let netd = [
        ["camera", "netd", "\"60 mK\""],
        ["camera", "netd_temperature", "\"30 degC\""],
        ["camera", "netd_f_number", "1.0"],
        ["camera", "netd_optics_efficiency", "0.85"],
        ["camera", "netd_pixel", "\"12 um\""],
        ["camera", "spectral_bands", "3"],
    ];
    let is_electrons = |row: &&[&str; 3]| row[1] == "noise_electrons";
    let place = STATED.iter().position(|row| is_electrons(&row)).unwrap();
    let (before, after) = STATED.split_at(place);
    before.iter().chain(&netd).chain(&after[1..]).copied().collect()
}

/// The same of all pixels of the object, with errors of the emissivities that they share.
fn of_object() -> Vec<[&'static str; 3]> {
    let mut rows = with_netd();
    rows.push(["requirement", "of", "\"object\""]);
    rows.push(["sensitivity", "emissivity_error", "\"0.0005 absolute\""]);
    let place = rows.iter().position(|row| row[1] == "column_noise").unwrap();
    for key in ["temporal_row_noise", "temporal_column_noise", "frame_noise"] {
        rows.insert(place, ["camera", key, "\"5 mK\""]);
    }
    rows
}

fn library() -> &'static Library {
    static LIBRARY: OnceLock<Library> = OnceLock::new();
    LIBRARY.get_or_init(|| Library::embedded().unwrap())
}

/// The rows as text.
fn text(rows: &[[&str; 3]]) -> String {
    let (mut out, mut table) = (String::new(), "");
    for [of, key, value] in rows {
        if *of != table {
            table = of;
            let _ = writeln!(out, "[{of}]");
        }
        let _ = writeln!(out, "{key} = {value}");
    }
    out
}

fn without(rows: &[[&'static str; 3]], table: &str, key: &str) -> Vec<[&'static str; 3]> {
    rows.iter().filter(|[of, name, _]| (*of, *name) != (table, key)).copied().collect()
}

fn with(rows: &[[&'static str; 3]], table: &str, key: &str, value: &'static str) -> Vec<[&'static str; 3]> {
    let set = |row: &[&'static str; 3]| {
        if (row[0], row[1]) == (table, key) { [row[0], row[1], value] } else { *row }
    };
    rows.iter().map(set).collect()
}

fn verdict(text: &str) -> Result<Verdict, String> {
    let study = Scenario::from_toml(text, None).and_then(|scenario| Study::new(&scenario, library()));
    study.and_then(|study| study.size()).map(|found| found.verdict).map_err(|error| error.to_string())
}

/// What a verdict is worth: its margin, nothing where it is no 'yes'.
fn worth(verdict: &Result<Verdict, String>) -> f64 {
    match verdict {
        Ok(verdict) if verdict.answer == Some(YesNo::Yes) => verdict.margin.unwrap_or(0.0),
        _ => 0.0,
    }
}

fn figures(verdict: &Verdict) -> Vec<String> {
    verdict.conditions.iter().filter(|one| one.favourable()).map(Condition::figure).collect()
}

/// What one key stands for among the figures of conditions: a table that is made of it, or what asks about the same.
fn about(table: &str, key: &str) -> Vec<String> {
    let table = table.trim_matches(['[', ']']);
    // One condition says all of a kind that are not stated.
    let of_kind = match key {
        "row_noise" | "column_noise" | "offset_drift" => "fixed_pattern",
        "temporal_row_noise" | "temporal_column_noise" => "frame_noise",
        key => key,
    };
    vec![format!("{table}.{of_kind}"), table.to_owned()]
}

/// Deleting a key gives no better verdict than each value of it would, unless a favourable condition says so.
#[test]
fn what_is_not_stated_never_helps_in_silence() {
    let mut tried = 0;
    let cases = [STATED.to_vec(), with_netd(), of_object()];
    for (rows, (table, key, values)) in
        cases.iter().flat_map(|rows| OTHERS.iter().map(move |other| (rows, other)))
    {
        let whole = verdict(&text(rows)).unwrap();
        assert_eq!(whole.answer, Some(YesNo::Yes), "{whole:?}");
        if !rows.iter().any(|row| (row[0], row[1]) == (*table, *key)) {
            continue;
        }
        let deleted = verdict(&text(&without(rows, table, key)));
        // Asked for.
        let Ok(found) = &deleted else { continue };
        let said = figures(found);
        let is_said = about(table, key).iter().any(|figure| said.contains(figure));
        for value in *values {
            tried += 1;
            let stated = verdict(&text(&with(rows, table, key, value)));
            let (with, less) = (worth(&stated), worth(&deleted));
            assert!(
                is_said || less <= with * (1.0 + 1e-9),
                "{table}.{key}: {less} without it, {with} with {value}; said: {said:?}; {stated:?}"
            );
        }
    }
    println!("{tried} pairs of a deletion and a value");
    assert!(tried > 70, "{tried}");
}

/// Of any two keys deleted together, the verdict is no better than with one of them deleted, unless it is said.
#[test]
fn two_deletions_are_said_too() {
    for (index, (table, key, _)) in OTHERS.iter().enumerate() {
        let one = without(STATED, table, key);
        let Ok(first) = verdict(&text(&one)) else { continue };
        for (other, name, _) in OTHERS.iter().skip(index + 1).step_by(3) {
            let Ok(both) = verdict(&text(&without(&one, other, name))) else { continue };
            let said = figures(&both);
            let better = worth(&Ok(both)) > worth(&Ok(first.clone())) * (1.0 + 1e-9);
            let is_said = about(other, name).iter().any(|figure| said.contains(figure));
            assert!(!better || is_said, "{table}.{key} and {other}.{name}: {said:?}");
        }
    }
}

/// Of every known camera: what its entry does not state is asked for, or a 'yes' says it, and is graded so.
#[test]
fn a_yes_of_a_known_camera_lists_what_its_entry_leaves_open() {
    let scene: Vec<[&'static str; 3]> = STATED.iter().filter(|row| row[0] != "camera").copied().collect();
    let mut judged = 0;
    for preset in presets::all().unwrap() {
        let camera = format!("{}[camera]\npreset = {:?}\n", text(&scene), preset.name);
        let Ok(found) = verdict(&camera.replace("distance = 0.02", "distance = 1e-6")) else { continue };
        judged += 1;
        if found.answer != Some(YesNo::Yes) {
            continue;
        }
        let said = figures(&found);
        let open = [
            ("full_well", preset.figures.full_well.is_none()),
            ("spectral_range", preset.figures.spectral_range_cm1.is_none()),
        ];
        for (figure, is_open) in open {
            let key = format!("camera.{figure}");
            assert_eq!(said.contains(&key), is_open, "{}: {key} in {said:?}", preset.name);
        }
        assert_eq!(found.grade == Some(Grade::Assumed), !said.is_empty(), "{}", preset.name);
        assert!(found.lower <= found.upper, "{}", preset.name);
    }
    assert!(judged > 3, "{judged}");
}

/// One band: at 60 degC instead of 40 the alternative looks like the target.
#[test]
fn a_range_that_decides_is_said_with_how_far_it_holds() {
    let rows = STATED.iter().map(|row| match (row[0], row[1]) {
        ("bands", "ranges") => ["bands", "ranges", "[[\"8 um\", \"13 um\"]]"],
        ("alternatives", "materials") => ["alternatives", "materials", "[\"aluminium\"]"],
        ("alternatives", "temperature") => ["alternatives", "temperature", "[\"0 degC\", \"40 degC\"]"],
        ("[environment]", "lighting") => ["[environment]", "lighting", "1.0"],
        _ => *row,
    });
    let rows: Vec<[&'static str; 3]> = rows.collect();
    let found = verdict(&text(&rows)).unwrap();
    assert_eq!(found.answer, Some(YesNo::Yes), "{found:?}");
    let Condition::Range(range) = &found.conditions[0] else { panic!("{:?}", found.conditions) };
    assert_eq!(range.figure, "alternatives.temperature");
    let at = |hottest_k: f64| {
        let value = format!("[\"0 degC\", \"{hottest_k} K\"]");
        let rows = with(&rows, "alternatives", "temperature", String::leak(value));
        verdict(&text(&rows)).unwrap().answer
    };
    // It holds so far, and no farther.
    assert_eq!(at(range.holds.unwrap()[1]), Some(YesNo::Yes));
    assert_ne!(at(range.holds.unwrap()[1] + 0.5), Some(YesNo::Yes));
}

/// What is taken out of the unknowns is taken as known, which is said, each by its own code; so are surroundings that nobody states a material of,
/// and rows and columns of an object of which only the number is stated.
#[test]
fn what_is_taken_out_of_the_unknowns_is_said() {
    const KNOWN: [(&str, &str); 4] = [
        ("temperature", "temperature-known"),
        ("lighting", "lighting-known"),
        ("gain", "calibrated"),
        ("environment-temperature", "surroundings-known"),
    ];
    // Three bands do not distinguish beside three unknowns.
    for kept in (0..16_usize).filter(|kept| kept.count_ones() < 3) {
        let is_kept = |place: usize| kept >> place & 1 == 1;
        let unknown: Vec<&str> = (0..4).filter(|place| is_kept(*place)).map(|place| KNOWN[place].0).collect();
        let rows = text(STATED).replace("[\"temperature\", \"lighting\"]", &format!("{unknown:?}"));
        let found = verdict(&rows.replace("distance = 0.02", "distance = 1e-6")).unwrap();
        assert_eq!(found.answer, Some(YesNo::Yes), "{unknown:?}");
        let codes: Vec<String> =
            found.conditions.iter().filter(|one| one.favourable()).map(Condition::code).collect();
        for (place, (_, code)) in KNOWN.iter().enumerate() {
            assert_eq!(
                codes.iter().any(|one| one == code),
                !is_kept(place),
                "{unknown:?}: {code} in {codes:?}"
            );
        }
    }
    let black = |more: &str| {
        let rows = text(STATED).replace("lighting = 0.6", &format!("lighting = 0.6\n{more}"));
        let found = verdict(&rows.replace("distance = 0.02", "distance = 1e-6")).unwrap();
        found.conditions.iter().find_map(|one| match one {
            Condition::SurroundingsKnown { black } => Some(*black),
            _ => None,
        })
    };
    assert_eq!((black(""), black("material = \"concrete\"")), (Some(1), Some(0)));
    let square = |pixels: &str| {
        let rows = text(&of_object()).replace("size = \"0.25 m\"", &format!("pixels = {pixels}"));
        let rows = rows.replace("[background]\ntemperature = \"5 degC\"\n", "");
        let found = verdict(&rows.replace("distance = 0.02", "distance = 1e-6")).unwrap();
        found.conditions.iter().any(|one| matches!(one, Condition::AlikePixels { square: true, .. }))
    };
    assert!(square("45") && !square("[5, 9]") && !square("1"));
}
