//! Rules as a program sees them: text, JSON, files, exit codes; worst cases known by hand; what would fix a camera, put back.

use crate::support::folder::Folder;
use hadar::material::Library;
use hadar_report::words::Say;
use hadar_scenario::{Rule, Scenario};
use hadar_study::{ApartAnswer, Extent, Proof, RuleAnswer, RuleAsked, RuleStudy, Shortfall, Study};
use serde_json::Value;
use std::fs;
use std::sync::OnceLock;

/// A rule of one camera that meets it and one that does not.
const RULE: &str = r#"cameras = ["flir-a325sc", "ideal-pnrd"]
[rule]
name = "People and robots"
version = "1"
[target]
material = "skin"
temperature = "33 degC"
[[environment]]
temperature = "10 degC"
lighting = 0.5
[alternatives]
materials = ["aluminium", "pmma"]
[bands]
start = "750 cm^-1"
stop = "1250 cm^-1"
step = "100 cm^-1"
[requirement]
distance = 1.0
[envelope]
temperature = ["25 degC", "37 degC"]
lighting = [0.2, 0.8]
surroundings = ["-10 degC", "15 degC"]
distance = ["5 m", "15 m"]
materials = ["skin", "fabric"]
"#;

/// One band, nothing unknown: everything can be worked out by hand.
const ONE_BAND: &str = r#"cameras = ["ideal-pnrd"]
[target]
material = "skin"
temperature = "33 degC"
[[environment]]
temperature = "10 degC"
lighting = 0.5
[alternatives]
materials = ["fabric"]
[bands]
ranges = [["900 cm^-1", "901 cm^-1"]]
[unknown]
nuisances = []
[envelope]
temperature = ["25 degC", "37 degC"]
lighting = [0.2, 0.8]
surroundings = ["-10 degC", "15 degC"]
distance = ["5 m", "15 m"]
"#;

fn library() -> &'static Library {
    static LIBRARY: OnceLock<Library> = OnceLock::new();
    LIBRARY.get_or_init(|| Library::embedded().unwrap())
}

#[track_caller]
fn whole(text: &str, asked: &RuleAsked) -> RuleAnswer {
    let rule = Rule::from_toml(text, None).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let study = RuleStudy::new(&rule, library()).unwrap_or_else(|error| panic!("{error}\n{text}"));
    study.answer(asked, &|_, _| ()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// The one clause of a rule without `[[clause]]`.
#[track_caller]
fn answer_as(text: &str, asked: &RuleAsked) -> ApartAnswer {
    whole(text, asked).only().unwrap().clone()
}

#[track_caller]
fn answer(text: &str) -> ApartAnswer {
    answer_as(text, &RuleAsked { seed: 1, ..RuleAsked::default() })
}

#[track_caller]
fn keys(value: &Value, expected: &[&str]) {
    let object = value.as_object().unwrap_or_else(|| panic!("not an object: {value}"));
    for key in expected {
        assert!(object.contains_key(*key), "`{key}` is missing among {:?}", object.keys());
    }
}

#[test]
fn the_example_reads_as_it_should() {
    let folder = Folder::with("");
    let example = hadar_testing::repository().join("examples/rule_delivery_robots_at_night.toml");
    let outcome = folder.run(&["rule", &example.display().to_string()]);
    assert_eq!((outcome.code, outcome.stderr.as_str()), (0, ""));
    // How much is proved beyond the tolerance depends on the rounding of the vector units.
    let proved = |line: &str| match line.find("branch and bound to ") {
        Some(at) => line[..at].to_owned() + "branch and bound",
        None => line.to_owned(),
    };
    let text: Vec<String> = outcome.stdout.lines().map(proved).collect();
    insta::assert_snapshot!("rule_delivery_robots_at_night", text.join("\n"));
}

#[test]
fn json_has_the_agreed_keys() {
    let folder = Folder::with(RULE);
    let json = folder.json(&["rule", "a.toml"]);
    keys(
        &json,
        &[
            "rule",
            "sentence",
            "requirement",
            "envelope",
            "cameras",
            "not_identifiable",
            "inputs",
            "warnings",
            "stats",
        ],
    );
    keys(
        &json["requirement"],
        &["distance", "detection_probability", "speed_m_s", "hardware_m2_s", "quotable"],
    );
    keys(
        &json["envelope"],
        &["temperature_k", "lighting", "surroundings_k", "distance_m", "materials", "alternatives"],
    );
    keys(
        &json["not_identifiable"],
        &["fraction", "standard_error", "definition", "fraction_within_emissivity_error", "scenes"],
    );
    let cameras = json["cameras"].as_array().unwrap();
    for camera in cameras {
        keys(
            camera,
            &[
                "name",
                "passes",
                "fails_by",
                "margin",
                "statistical_distance",
                "lower_bound",
                "certificate",
                "limiting",
                "fixes",
                "motion_blur_pixels",
                "longest_exposure_s",
                "warnings",
            ],
        );
        keys(&camera["certificate"], &["kind", "statement", "gap"]);
        keys(
            &camera["limiting"],
            &[
                "target",
                "alternative",
                "temperature_k",
                "lighting",
                "surroundings_k",
                "distance_m",
                "nearest_state",
            ],
        );
    }
    let names: Vec<&str> = cameras.iter().map(|camera| camera["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["flir-a325sc", "ideal-pnrd"]);
    assert_eq!((&cameras[0]["passes"], &cameras[1]["passes"]), (&Value::Bool(false), &Value::Bool(true)));
    keys(
        &cameras[0]["fixes"],
        &["any", "spoils", "exposure_s", "pixel_m", "f_number", "noise_counts", "frames"],
    );
    assert!(cameras[1]["fixes"].is_null());
    assert_eq!(json["rule"]["camera"][0]["preset"], "flir-a325sc");
    let meets =
        "1 of 2 cameras meets the rule: ideal-pnrd (if the target fills a pixel, which sees 1.0 cm there).";
    assert_eq!(json["sentence"], meets);
    for input in json["inputs"].as_array().unwrap() {
        assert_eq!(input["sha256"].as_str().unwrap().len(), 64, "{input}");
    }
    // The rule, the entries of two cameras and of every material.
    let inputs = json["inputs"].as_array().unwrap().iter().map(|input| input["path"].as_str().unwrap());
    let (materials, others): (Vec<&str>, Vec<&str>) = inputs.partition(|path| path.contains("material"));
    assert_eq!(others, ["a.toml", "built-in: camera flir-a325sc", "built-in: camera ideal-pnrd"]);
    assert!(materials.len() == 4 && materials.contains(&"built-in: material skin"), "{materials:?}");
}

#[test]
fn check_tells_scripts_whether_cameras_meet_the_rule() {
    let folder = Folder::with(RULE);
    folder.file("easy.toml", &RULE.replace("\"flir-a325sc\", ", ""));
    folder.file("hard.toml", &RULE.replace(", \"ideal-pnrd\"", ""));
    for (arguments, code) in [
        (["rule", "a.toml"].as_slice(), 0),
        (&["rule", "a.toml", "--check"], 3),
        (&["rule", "a.toml", "--check", "--json"], 3),
        (&["rule", "a.toml", "--check", "--any"], 0),
        (&["rule", "a.toml", "--check", "--no-skip"], 3),
        (&["rule", "easy.toml", "--check"], 0),
        (&["rule", "hard.toml", "--check", "--any"], 3),
        (&["rule", "a.toml", "--any"], 2),
        (&["rule"], 2),
    ] {
        let outcome = folder.accepting(arguments);
        assert_eq!(outcome.code, code, "{arguments:?}: {}{}", outcome.stdout, outcome.stderr);
    }
}

#[test]
fn the_verdict_alone_is_the_same_and_takes_less() {
    for required in [0.01, 0.3, 1.0, 3.0, 30.0, 300.0] {
        let text = RULE.replace("distance = 1.0", &format!("distance = {required}"));
        let whole = answer(&text);
        let alone = answer_as(&text, &RuleAsked { extent: Extent::Verdicts, ..RuleAsked::default() });
        for (whole, alone) in whole.cameras.iter().zip(&alone.cameras) {
            assert_eq!((whole.passes, &whole.fails_by), (alone.passes, &alone.fails_by), "{required}");
            // A scene that shows a failure is below the requirement, if not the worst.
            assert!(alone.statistical_distance >= whole.statistical_distance * (1.0 - 1e-9));
            assert_eq!(alone.passes, alone.statistical_distance >= required);
            assert!(alone.fixes.is_none());
        }
        assert!(alone.not_identifiable.is_none());
    }
}

/// One band, nothing unknown: d = (N − N′)/(√N + √N′) with N − N′ = κ(e − e′)[B(T) − V B(T₀)] is least for the coldest
/// target in the warmest and fullest light.
#[test]
fn the_worst_case_is_at_the_corner_known_by_hand() {
    let answer = answer(ONE_BAND);
    let camera = &answer.cameras[0];
    let scene = &camera.limiting;
    let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-4;
    assert!(close(scene.temperature_k, 298.15) && close(scene.lighting[0], 0.8), "{scene:?}");
    assert!(close(scene.surroundings_k[0], 288.15), "{scene:?}");
    // A lens set to a near target collects less: with nothing on the path the nearest is the worst.
    assert_eq!(scene.distance_m, Some(5.0));
    let etendue = std::f64::consts::PI * 12e-6 * 12e-6 / (4.0 * 1.3 * 1.3 + (18e-3f64 / 5.0).powi(2));
    let kappa = etendue * 0.99 * 12e-3;
    let photons = |e: f64| kappa * (e * blackbody(298.15) + (1.0 - e) * 0.8 * blackbody(288.15));
    let expected = photons(0.95).sqrt() - photons(0.88).sqrt();
    assert!(
        (camera.statistical_distance / expected - 1.0).abs() < 1e-8,
        "{} {expected}",
        camera.statistical_distance
    );
    // The bound proved is below, by at most the tolerance where it says so.
    if let Some(bound) = camera.lower_bound {
        assert!(
            bound <= expected * (1.0 + 1e-9)
                && (camera.certificate.kind != Proof::BranchAndBound || bound > 0.98 * expected)
        );
    }
}

/// The scenario of a limiting scene, with `camera` as its keys.
fn limiting_scenario(scene: &hadar_study::LimitingScene, camera: &str, required: f64) -> Scenario {
    let text = format!(
        "[target]\nmaterial = {:?}\ntemperature = \"{:e} K\"\ndistance = \"{:e} m\"\n\
         [[environment]]\ntemperature = \"{:e} K\"\nlighting = {:e}\n\
         [alternatives]\nmaterials = [{:?}]\n\
         [bands]\nstart = \"750 cm^-1\"\nstop = \"1250 cm^-1\"\nstep = \"100 cm^-1\"\n\
         [camera]\npreset = \"flir-a325sc\"\n{camera}\n[requirement]\ndistance = {required:e}\n",
        scene.target,
        scene.temperature_k,
        scene.distance_m.unwrap(),
        scene.surroundings_k[0],
        scene.lighting[0],
        scene.alternative
    );
    Scenario::from_toml(&text, None).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// 3e-9: a thousand-millionth more is asked for than is required; the crossing is found to the last bits, the nearest distance itself to 1e-11.
#[test]
fn what_would_fix_a_camera_does_when_it_is_put_back() {
    let now = answer(RULE).cameras[0].statistical_distance;
    for required in [1.2 * now, 3.0 * now] {
        let text = RULE.replace("distance = 1.0", &format!("distance = {required:e}"));
        let answer = answer(&text);
        let camera = &answer.cameras[0];
        let fixes = camera.fixes.as_ref().unwrap();
        let mut seen = 0;
        for (quantity, solution, _) in fixes.that_do() {
            let value = solution.value.unwrap();
            let changed = match quantity.key() {
                "exposure_s" => format!("exposure = \"{value:e} s\""),
                "pixel_m" => format!("pixel = \"{value:e} m\""),
                "f_number" => format!("f_number = {value:e}"),
                "noise_counts" => format!("noise_electrons = {value:e}"),
                "frames" => format!("frames = {value:.0}"),
                _ => continue,
            };
            let scenario = limiting_scenario(&camera.limiting, &changed, required);
            let sizing = Study::new(&scenario, library()).and_then(|study| study.size()).unwrap();
            let reached = sizing.verdict.statistical_distance.unwrap() / required;
            let exact = quantity.key() != "frames";
            assert!(reached > 1.0 - 1e-9 && (!exact || reached < 1.0 + 3e-9), "{quantity:?}: {reached}");
            seen += 1;
        }
        assert!(seen >= 2, "{fixes:?}");
        // And as it is, the camera reaches there just what the rule says.
        let study = Study::new(&limiting_scenario(&camera.limiting, "", required), library()).unwrap();
        let verdict = study.size().unwrap().verdict;
        assert!((verdict.margin.unwrap() / camera.margin - 1.0).abs() < 1e-9);
    }
}

/// No scene of the envelope, drawn anew, is below what was found or proved.
#[test]
fn no_scene_is_below_the_worst_case() {
    let answer = answer(RULE);
    let camera = &answer.cameras[0];
    let mut step = 0.37f64;
    let mut draw = |low: f64, high: f64| {
        // The irrational rotation by the square root of 2, a sequence of its own.
        step = (step + std::f64::consts::SQRT_2).fract();
        low + (high - low) * step
    };
    let mut least = f64::INFINITY;
    for trial in 0..120 {
        let mut scene = camera.limiting.clone();
        scene.target = ["skin", "fabric"][trial % 2].into();
        scene.alternative = ["aluminium", "pmma"][(trial / 2) % 2].into();
        scene.temperature_k = draw(298.15, 310.15);
        scene.lighting = vec![draw(0.2, 0.8)];
        scene.surroundings_k = vec![draw(263.15, 288.15)];
        scene.distance_m = Some(draw(5.0, 15.0));
        let study = Study::new(&limiting_scenario(&scene, "", 1.0), library()).unwrap();
        let reached = study.size().unwrap().verdict.statistical_distance.unwrap();
        least = least.min(reached);
        assert!(reached >= camera.statistical_distance * (1.0 - 1e-6), "{scene:?} {reached}");
    }
    // The draw comes near enough to have found one.
    assert!(least < 3.0 * camera.statistical_distance, "{least}");
    assert!(camera.lower_bound.is_none_or(|bound| bound <= camera.statistical_distance));
}

/// What the alternative does not know is no reason to do without a proof, and brings nothing farther apart.
#[test]
fn more_unknowns_are_proved_too() {
    let rule = |unknown: &str| {
        let text = RULE.replace("\"flir-a325sc\", ", "").replace("[\"skin\", \"fabric\"]", "[\"fabric\"]");
        answer(&format!("{}[unknown]\n{unknown}\n", text.replace(", \"pmma\"", ""))).cameras.remove(0)
    };
    let known = rule(r#"nuisances = ["temperature", "lighting"]"#);
    for unknown in [
        r#"nuisances = ["temperature", "lighting", "gain"]"#,
        r#"nuisances = ["temperature", "lighting", "environment-temperature"]"#,
    ] {
        let camera = rule(unknown);
        let (bound, distance) = (camera.lower_bound.unwrap(), camera.statistical_distance);
        let proved = camera.certificate.kind == Proof::BranchAndBound;
        assert!(proved || !unknown.contains("gain"), "{unknown}: {camera:?}");
        assert!(bound > 0.0 && bound <= distance, "{unknown}: {bound} {distance}");
        assert!(!proved || bound >= 0.99 * distance, "{unknown}: {bound} {distance}");
        assert!(distance <= known.statistical_distance * (1.0 + 1e-9), "{unknown}: {distance}");
    }
    let lit = |unknown: &str| {
        let text = RULE.replace("\"flir-a325sc\", ", "").replace("[\"skin\", \"fabric\"]", "[\"fabric\"]");
        let text = text.replace("lighting = [0.2, 0.8]", "lighting = [0.5, 0.5]").replace(", \"pmma\"", "");
        answer(&format!("{text}[unknown]\n{unknown}\n")).cameras.remove(0)
    };
    let known = lit(r#"nuisances = ["temperature", "lighting"]"#);
    let total = lit("nuisances = [\"temperature\", \"lighting\"]\nlighting_total = 0.5");
    assert_eq!(total.certificate.kind, Proof::BranchAndBound, "{total:?}");
    assert!(total.statistical_distance >= known.statistical_distance * (1.0 - 1e-9), "{total:?}");
}

#[test]
fn a_wider_envelope_is_never_easier() {
    let mut before = f64::INFINITY;
    for (temperature, lighting) in [
        ("\"33 degC\", \"33 degC\"", "0.5, 0.5"),
        ("\"30 degC\", \"35 degC\"", "0.4, 0.6"),
        ("\"25 degC\", \"37 degC\"", "0.2, 0.8"),
    ] {
        let text = RULE
            .replace("\"25 degC\", \"37 degC\"", temperature)
            .replace("lighting = [0.2, 0.8]", &format!("lighting = [{lighting}]"));
        let margin = answer(&text).cameras[0].margin;
        assert!(margin <= before * (1.0 + 1e-9), "{margin} {before}");
        before = margin;
    }
}

#[test]
fn where_nothing_differs_no_camera_does() {
    let text = RULE
        .replace("\"-10 degC\", \"15 degC\"", "\"-10 degC\", \"30 degC\"")
        .replace("lighting = [0.2, 0.8]", "lighting = [0.2, 1.0]");
    let answer = answer(&text);
    for camera in &answer.cameras {
        assert_eq!((camera.passes, camera.margin, camera.lower_bound), (false, 0.0, Some(0.0)));
        assert_eq!(camera.certificate.kind, Proof::Equilibrium);
        assert!(!camera.fixes.as_ref().unwrap().any);
    }
    assert_eq!(answer.requirement.hardware_m2_s, None);
    let sentence = whole(&text, &RuleAsked::default()).sentence.say();
    assert_eq!(sentence, "None of 2 cameras meets the rule: flir-a325sc, ideal-pnrd.");
}

#[test]
fn a_material_is_not_told_from_itself_by_any_camera() {
    let text = RULE
        .replace("[\"aluminium\", \"pmma\"]", "[\"skin\"]")
        .replace("materials = [\"skin\", \"fabric\"]", "materials = [\"skin\"]");
    let answer = answer(&text);
    let part = answer.not_identifiable.unwrap();
    assert_eq!((part.fraction, part.standard_error), (1.0, 0.0));
    assert!(answer.cameras.iter().all(|camera| !camera.passes && camera.margin == 0.0));
}

/// Photons s⁻¹ m⁻² sr⁻¹ between 900 and 901 cm⁻¹: 2cν²/(e^x − 1) by Simpson's rule.
fn blackbody(kelvin: f64) -> f64 {
    let at = |nu_per_m: f64| {
        2.0 * 299_792_458.0 * nu_per_m * nu_per_m * 100.0 / (1.438_776_877e-2 * nu_per_m / kelvin).exp_m1()
    };
    (at(900e2) + 4.0 * at(900.5e2) + at(901e2)) / 6.0
}

/// One band, nothing unknown, target lit wholly: d grows with T from 0 at the temperature of the surroundings, so the share
/// that no camera does is the part of the range below the T at which d of the ideal camera is that demanded.
#[test]
fn the_share_no_camera_does_is_the_one_known_by_hand() {
    let text = ONE_BAND
        .replace("lighting = [0.2, 0.8]", "lighting = [1.0, 1.0]")
        .replace("lighting = 0.5", "lighting = 1.0")
        .replace("[\"-10 degC\", \"15 degC\"]", "[\"15 degC\", \"15 degC\"]")
        .replace("[\"25 degC\", \"37 degC\"]", "[\"15 degC\", \"17 degC\"]");
    // f/0.5 makes the etendue pi A_p; 12 ms are the longest integration of the cameras.
    let kappa = std::f64::consts::PI * 12e-6 * 12e-6 * 12e-3;
    let distance = |kelvin: f64| {
        let counts = |e: f64| kappa * (e * blackbody(kelvin) + (1.0 - e) * blackbody(288.15));
        counts(0.95).sqrt() - counts(0.88).sqrt()
    };
    // Demanded is what is reached at 15.8 degC, two fifths of the range.
    let demanded = distance(288.95);
    let answer =
        answer(&text.replace("[envelope]", &format!("[requirement]\ndistance = {demanded:e}\n[envelope]")));
    let part = answer.not_identifiable.unwrap();
    assert!((part.fraction - 0.4).abs() < 4.0 * part.standard_error + 1.0 / 128.0, "{part:?}");
    assert!(part.standard_error < 0.01, "{part:?}");
    let near = part.neighbourhood.unwrap();
    assert!((near.temperature_difference_k - 0.72).abs() < 0.03 && near.unlit == 0.0, "{near:?}");
}

/// A target that does not fill its pixel sends less the farther it is.
#[test]
fn the_farthest_is_the_worst_for_a_small_target() {
    let text = RULE
        .replace("temperature = \"33 degC\"\n", "temperature = \"33 degC\"\nsize = \"5 mm\"\ndistance = \"10 m\"\n[background]\ntemperature = \"10 degC\"\n")
        .replace("\"flir-a325sc\", ", "");
    let small = answer(&text);
    assert_eq!(small.cameras[0].limiting.distance_m, Some(15.0));
    assert!(small.cameras[0].margin < answer(&RULE.replace("\"flir-a325sc\", ", "")).cameras[0].margin);
}

#[test]
fn blur_and_a_full_well_fail_a_camera_that_sees_enough() {
    let camera = |keys: &str| format!("{RULE}[[camera]]\nname = \"ours\"\npreset = \"ideal-pnrd\"\n{keys}\n");
    let text = camera("full_well = 1e6").replace("distance = 1.0", "distance = 1.0\nspeed = \"10 m/s\"");
    let answer = answer(&text);
    let ours = answer.cameras.iter().find(|camera| camera.name == "ours").unwrap();
    assert!(ours.margin > 1.0 && !ours.passes);
    assert_eq!(ours.fails_by, [Shortfall::MotionBlur, Shortfall::FullWell]);
    // Δ = v sin(Lα/2) t/(r α) at the least distance, by hand: 10 m/s, 320 pixels of 12 um behind 18 mm, 12 ms, 5 m; a lens that keeps
    // straight lines straight sees 0.2 % more of an angle by its view.
    let blur = 10.0 * (160.0 / 1500.0_f64).sin() * 12e-3 * 1500.0 / 5.0;
    assert!((ours.motion_blur_pixels.unwrap() / blur - 1.0).abs() < 4e-3);
    // Light is proportional to the exposure: at the longest one nothing is spoiled, a little beyond it is.
    let longest = ours.longest_exposure_s.unwrap();
    for (share, passes) in [(0.999, true), (1.001, false)] {
        let keys = format!("full_well = 1e6\nexposure = \"{:e} s\"", share * longest);
        let text = camera(&keys)
            .replace("distance = 1.0", "distance = 0.01\nspeed = \"10 m/s\"")
            .replace("cameras = [\"flir-a325sc\", \"ideal-pnrd\"]\n", "");
        assert_eq!(self::answer(&text).cameras[0].passes, passes, "{share}");
    }
}

/// What the picture is drawn from: a camera that has signal enough and fails by its image is below all that meet the rule.
#[test]
fn a_full_well_is_drawn_as_failing_and_named() {
    let rule = format!("{RULE}[[camera]]\nname = \"ours\"\npreset = \"ideal-pnrd\"\nfull_well = 1e6\n");
    let folder = Folder::with(&rule);
    let outcome = folder.run(&["rule", "a.toml", "--out", "out"]);
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    let row = outcome.stdout.lines().find(|line| line.starts_with("ours")).unwrap();
    assert!(row.contains("no: "), "{row}");
    let margins = fs::read_to_string(folder.path().join("out/margins.csv")).unwrap();
    let rows: Vec<Vec<&str>> = margins.lines().skip(1).map(|line| line.split(',').collect()).collect();
    let met: Vec<&str> = rows.iter().map(|row| row[1]).collect();
    assert_eq!(met, ["yes", "no", "no"], "{margins}");
    let ours = rows.iter().find(|row| row[0] == "ours").unwrap();
    assert!(ours[2] == "full-well" && ours[3].parse::<f64>().unwrap() > 1.0, "{margins}");
    let svg = fs::read_to_string(folder.path().join("out/margins.svg")).unwrap();
    assert!(svg.contains("no: full well") && svg.contains("no: d too small"));
}

#[test]
fn the_report_is_complete_and_the_same_every_time() {
    let folder = Folder::with(RULE);
    for out in ["one", "two"] {
        assert_eq!(folder.run(&["rule", "a.toml", "--out", out]).code, 0);
    }
    let names = [
        "cameras.csv",
        "certificate.md",
        "inputs.csv",
        "margins.csv",
        "margins.png",
        "margins.svg",
        "rule.toml",
        "warnings.csv",
        "worst_cases.csv",
    ];
    for name in names {
        let [one, two] = ["one", "two"].map(|out| fs::read(folder.path().join(out).join(name)).unwrap());
        assert!(!one.is_empty() && one == two, "{name}");
    }
    let certificate = fs::read_to_string(folder.path().join("one/certificate.md")).unwrap();
    assert!(certificate.starts_with("# People and robots\n"), "{certificate}");
    for part in [
        "> A camera meets this rule if",
        "t A_p/((1+gamma) F^2) >=",
        "| flir-a325sc | no: it cannot distinguish ",
        "## Inputs",
    ] {
        assert!(certificate.contains(part), "{part}\n{certificate}");
    }
    // The rule with its defaults gives the same answer, but for its own hash.
    fs::copy(folder.path().join("one/rule.toml"), folder.path().join("again.toml")).unwrap();
    let strip = |mut json: Value| {
        json["inputs"][0] = Value::Null;
        json["warnings"] = Value::Null;
        json
    };
    let [first, again] = ["a.toml", "again.toml"].map(|name| strip(folder.json(&["rule", name])));
    assert_eq!(first["cameras"], again["cameras"]);
    assert_eq!(first["rule"], again["rule"]);
}

#[test]
fn a_scenario_with_an_envelope_says_that_size_does_not_search_it() {
    let text = RULE.replace("cameras = [\"flir-a325sc\", \"ideal-pnrd\"]\n[rule]\nname = \"People and robots\"\nversion = \"1\"\n", "");
    let folder = Folder::with(&text);
    let size = folder.json(&["size", "a.toml"]);
    let codes: Vec<&str> =
        size["warnings"].as_array().unwrap().iter().map(|w| w["code"].as_str().unwrap()).collect();
    assert!(codes.contains(&"envelope-not-searched"), "{codes:?}");
    assert_eq!(size["scenario"]["envelope"]["lighting"], serde_json::json!([[0.2, 0.8]]));
}
