//! A rule cell by cell: each cell is what a rule of that one speed and light says, and no more is told apart in a cell than in none.

use hadar::material::Library;
use hadar_scenario::Rule;
use hadar_scenario::rule::Verdict;
use hadar_study::{Extent, Found, Grid, GridCell, RuleAnswer, RuleAsked, RuleStudy, Shortfall};

const NIGHT: &str = r#"cameras = ["ideal-pnrd"]
[target]
material = "skin"
temperature = "33 degC"
[[environment]]
temperature = "10 degC"
lighting = 0.5
[alternatives]
materials = ["aluminium", "pmma"]
[bands]
ranges = [["8 um", "9 um"], ["9 um", "10 um"], ["11 um", "12 um"]]
[envelope]
temperature = ["25 degC", "37 degC"]
lighting = [0.2, 0.8]
[stop]
speed = ["2 km/h", "21 km/h"]
latency = "0.2 s"
deceleration = "8 m/s^2"
start = "4.0 s"
crossing_speed = "2 km/h"
[[clause]]
name = "tell"
[[clause]]
name = "shape"
kind = "resolution"
[clause.requirement]
pixels = 6
size = "0.5 m"
[[camera]]
name = "ours"
preset = "flir-a325sc"
focal_length = "40 mm"
field_of_view = "42 deg"
frames = 40
[[grid]]
name = "night"
speed_step = "5 km/h"
[[grid]]
name = "evening"
speed_step = "10 km/h"
surroundings = ["18 degC", "24 degC"]
"#;

fn rule(text: &str) -> Rule {
    Rule::from_toml(text, None).unwrap()
}

fn answered(rule: &Rule) -> RuleAnswer {
    let study = RuleStudy::new(rule, &Library::embedded().unwrap()).unwrap();
    study.answer(&RuleAsked { extent: Extent::Margins, ..RuleAsked::default() }, &|_, _| ()).unwrap()
}

fn grid(text: &str) -> Vec<GridCell> {
    Grid::of(&rule(text), &Library::embedded().unwrap(), &|_, _| ()).unwrap().cells
}

#[test]
fn every_cell_is_the_rule_of_its_speed_and_light() {
    let cells = grid(NIGHT);
    let of = |clause: &str, light: Option<&str>| {
        let own = cells.iter().filter(|cell| cell.clause.as_deref() == Some(clause));
        own.filter(|cell| cell.light.as_deref() == light)
            .map(|cell| (cell.speed_m_s * 3.6 * 1e6).round() / 1e6)
            .collect::<Vec<_>>()
    };
    assert_eq!(of("tell", Some("night")), [2.0, 7.0, 12.0, 17.0, 21.0]);
    assert_eq!(of("tell", Some("evening")), [2.0, 12.0, 21.0]);
    // Geometry once.
    assert_eq!(of("shape", None), [2.0, 7.0, 12.0, 17.0, 21.0]);
    assert_eq!(cells.len(), 13);
    for cell in &cells {
        let speed = format!("speed = \"{} m/s\"", cell.speed_m_s);
        let mut own = NIGHT.replace("speed = [\"2 km/h\", \"21 km/h\"]", &speed);
        if cell.light.as_deref() == Some("evening") {
            own = own.replace("[0.2, 0.8]\n", "[0.2, 0.8]\nsurroundings = [\"18 degC\", \"24 degC\"]\n");
        }
        let alone = answered(&rule(&own));
        let clause = alone.clauses.iter().find(|clause| clause.name == cell.clause).unwrap();
        for (line, found) in clause.lines().iter().zip(&cell.cameras) {
            assert_eq!(
                (line.camera, line.verdict, line.fails_by),
                (&*found.camera, found.verdict, &*found.fails_by),
                "{cell:?}"
            );
            // Each is its worst to 1 %, and what hardly differs is shared.
            assert!((line.margin / found.margin - 1.0).abs() < 0.011, "{cell:?} {}", line.margin);
            assert_eq!(line.grade, found.grade, "{cell:?}");
        }
    }
}

/// The clause over all speeds is no better than any of its cells in the envelope's own light.
#[test]
fn no_cell_is_worse_than_the_clause() {
    let whole = answered(&rule(NIGHT));
    for cell in grid(NIGHT).iter().filter(|cell| cell.light.as_deref() != Some("evening")) {
        let clause = whole.clauses.iter().find(|clause| clause.name == cell.clause).unwrap();
        for (line, found) in clause.lines().iter().zip(&cell.cameras) {
            assert!(found.margin >= line.margin * (1.0 - 0.011), "{cell:?} {}", line.margin);
            assert!(found.verdict == Verdict::Meets || line.verdict != Verdict::Meets, "{cell:?}");
        }
    }
}

/// What is proved of one clause is taken over by one that hardly differs no further than it holds there.
#[test]
fn what_is_shared_is_proved_of_each() {
    let (cells, _) = rule(NIGHT).of_cells().unwrap();
    let study = RuleStudy::new(&cells, &Library::embedded().unwrap()).unwrap();
    let with = RuleAsked { extent: Extent::Margins, nearly_alike: true, ..RuleAsked::default() };
    let shared = study.answer(&with, &|_, _| ()).unwrap();
    let alone = answered(&cells);
    let mut told = 0;
    for (shared, alone) in shared.clauses.iter().zip(&alone.clauses) {
        let (Found::Apart(shared), Found::Apart(alone)) = (&shared.found, &alone.found) else { continue };
        for (shared, alone) in shared.cameras.iter().zip(&alone.cameras) {
            let (bound, distance) = (shared.lower_bound.unwrap_or(0.0), shared.statistical_distance);
            assert!(bound <= distance && bound <= alone.statistical_distance, "{shared:?} {alone:?}");
            assert!(alone.lower_bound.unwrap_or(0.0) <= distance, "{shared:?} {alone:?}");
            told += usize::from(bound != alone.lower_bound.unwrap_or(0.0));
        }
    }
    assert!(told > 0, "nothing was shared");
}

/// Who is only late brakes from where its frames are read; who sees nothing does not brake.
#[test]
fn what_is_left_at_contact() {
    let late = NIGHT
        .replace("start = \"4.0 s\"", "start = \"3.0 m\"")
        .replace("frames = 40", "frames = 10")
        .replace("= \"2 km/h\"\n[[clause]]", "= \"0 km/h\"\noffset = \"0 m\"\n[[clause]]")
        .replace("\"21 km/h\"", "\"18 km/h\"");
    let mut braked = 0;
    for cell in grid(&late).iter().filter(|cell| cell.clause.as_deref() == Some("shape")) {
        for camera in &cell.cameras {
            let closing = cell.speed_m_s;
            let expected = match (camera.verdict, camera.fails_by.as_slice()) {
                (Verdict::Meets, _) => 0.0,
                (_, [Shortfall::DecisionTime]) => {
                    // 10 exposures of 12 ms, all bands at once; then 0.2 s.
                    let gap = 3.0 - closing * 0.12 - 0.2 * closing;
                    (closing * closing - 16.0 * gap.max(0.0)).max(0.0).sqrt()
                }
                _ => closing,
            };
            braked += usize::from(expected > 0.0 && expected < closing);
            let found = camera.impact_m_s.unwrap();
            assert!((found - expected).abs() < 1e-9, "{cell:?} {expected}");
        }
    }
    assert!(braked > 0, "{:?}", grid(&late));
}

/// Frames that are read too late are read nearer: blurred there, without the target, or of a camera that may not tell, they stop nobody.
#[test]
fn who_is_late_and_sees_nothing_does_not_brake() {
    let base = NIGHT
        .replace("start = \"4.0 s\"", "start = \"2.0 s\"")
        .replace("[\"2 km/h\", \"21 km/h\"]", "\"30 km/h\"")
        .replace("latency = \"0.2 s\"", "latency = \"0.3 s\"")
        .replace("8 m/s^2", "6 m/s^2")
        .replace("cameras = [\"ideal-pnrd\"]\n", "");
    let camera = |offset: &str, more: &str| {
        let text = base
            .replace("= \"2 km/h\"\n[[clause]]", &format!("= \"0 km/h\"\noffset = \"{offset}\"\n[[clause]]"));
        let (head, tail) = text.split_once("[[camera]]").unwrap();
        let place = tail.find("[[grid]]").unwrap();
        let text =
            format!("{head}[[camera]]\nname = \"slow\"\npreset = \"ideal-pnrd\"\n{more}{}", &tail[place..]);
        let cells = grid(&text);
        let cell = cells.into_iter().find(|cell| cell.clause.as_deref() == Some("tell")).unwrap();
        cell.cameras[0].clone()
    };
    let closing = 30.0 / 3.6;
    // Read at 8.75 m, where 2 m beside the axis are outside half of 20 degrees: they were inside down to 11.3 m.
    let narrow = "exposure = \"0.25 ms\"\nframe_rate = \"20 Hz\"\nfield_of_view = \"20 deg\"\npixels = 600\nframes = 20\n";
    let beside = camera("2 m", narrow);
    assert_eq!(beside.fails_by, [Shortfall::DecisionTime], "{beside:?}");
    assert!((beside.impact_m_s.unwrap() - closing).abs() < 1e-9, "{beside:?}");
    // The same of one straight ahead stops.
    let ahead = camera("0 m", narrow);
    assert!(ahead.impact_m_s.unwrap() < closing, "{ahead:?}");
    // 1.9 pixels of blur where the last frames are read, .7 where the decision must stand.
    let fine = camera(
        "2 m",
        "exposure = \"1.5 ms\"\nframe_rate = \"10 Hz\"\nfield_of_view = \"60 deg\"\npixels = 2101\nframes = 15\n",
    );
    assert_eq!(fine.fails_by, [Shortfall::DecisionTime], "{fine:?}");
    assert!((fine.impact_m_s.unwrap() - closing).abs() < 1e-9, "{fine:?}");
}

#[test]
fn what_is_no_grid_is_refused() {
    let error = |text: String| match Rule::from_toml(&text, None) {
        Ok(rule) => Grid::of(&rule, &Library::embedded().unwrap(), &|_, _| ()).unwrap_err().to_string(),
        Err(error) => error.to_string(),
    };
    let without = NIGHT[..NIGHT.find("[[grid]]").unwrap()].to_owned();
    let refused = |text: String, what: &str| {
        let found = error(text);
        assert!(found.contains(what), "{found}");
    };
    refused(without.clone(), "the rule has no grid");
    refused(format!("{without}[[grid]]\nname = \"a\"\n"), "grid[0].speed_step");
    refused(format!("{without}[[grid]]\nspeed_step = \"5 km/h\"\n"), "grid[0].name");
    refused(NIGHT.replace("\"5 km/h\"", "\"0 km/h\""), "grid[0].speed_step");
    refused(NIGHT.replace("\"5 km/h\"", "\"0.001 m/s\""), "more than 1000 cells");
    refused(NIGHT.replace("\"evening\"", "\"night\""), "another light has this name");
    refused(NIGHT.replace("surroundings", "distance"), "there is no key `distance`");
    refused(format!("{NIGHT}lighting = [[0.1, 0.2], [0.3, 0.4]]\n"), "2 ranges for 1");
    let (stop, clause) = (NIGHT.find("[stop]").unwrap(), NIGHT.find("[[clause]]\nname = \"tell\"").unwrap());
    let still = format!("{}distance = [\"2 m\", \"9 m\"]\n{}", &NIGHT[..stop], &NIGHT[clause..]);
    refused(still, "no clause has a speed");
    let two = "[[clause.environment]]\ntemperature = \"5 degC\"\nlighting = 0.2\n".repeat(2);
    refused(
        NIGHT.replacen("name = \"tell\"\n", &format!("name = \"tell\"\n{two}"), 1),
        "a light of 1 surroundings",
    );
    // What is known of the light must hold in every one.
    let known = NIGHT
        .replace("[0.2, 0.8]", "[0.5, 0.5]")
        .replace("[envelope]", "[unknown]\nlighting_total = 0.5\n[envelope]");
    refused(format!("{known}lighting = [0.2, 0.3]\n"), "lighting_total");
    // And it comes back as it was written.
    let again = rule(NIGHT);
    assert_eq!(Rule::from_toml(&again.to_toml(), None).unwrap().grid, again.grid);
}
