//! Cameras whose figures are uncertain: what a margin is worth, and who is neither said to meet nor to fail.

use crate::support::folder::Folder;
use crate::support::rules::{NIGHT, close, library, measured, only};
use hadar::instrument::presets;
use hadar_scenario::Rule;
use hadar_scenario::rule::Verdict;
use hadar_study::{RuleAsked, RuleStudy};
use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::fs;

/// A rule of a camera whose noise is all electronic: d goes with 1/NETD, 1/F² and the root of the exposure.
fn uncertain(figures: &str, demanded: f64, more: &str) -> String {
    let text = NIGHT.replace("cameras = [\"flir-a325sc\"]\n", "");
    let (scene, _) = text.split_once("[stop]").unwrap();
    format!(
        "{scene}[requirement]\ndistance = {demanded}\n{more}[[camera]]\nname = \"ours\"\nnoise_exposure = \"10 ms\"\npixel = \"12 um\"\n\
         focal_length = \"14 mm\"\nnetd_temperature = \"25 degC\"\nnetd_f_number = 1.0\n{figures}\n"
    )
}

const FIGURES: &str = "netd = { value = \"50 mK\", u = \"1 mK\" }\nf_number = { value = 1.0, u = 0.01 }\nexposure = { value = \"10 ms\", u = \"0.1 ms\" }";

/// First order by hand: shares 2 %, 2 · 1 %, ½ · 1 % of the margin (noise that averages), in all 2.87 %; draws agree to 2 %; the interval is ±k of that.
#[test]
fn the_margin_of_uncertain_figures_is_known_by_hand() {
    let camera = only(&uncertain(FIGURES, 0.01, ""));
    let found = camera.uncertainty.as_ref().unwrap();
    let share = found.first_order / camera.margin;
    // The photons' own noise is a part of 1e-3 of the whole.
    assert!(close(share, (0.02f64.powi(2) + 0.02f64.powi(2) + 0.005f64.powi(2)).sqrt(), 0.01), "{share}");
    let contribution = |figure: &str| {
        let line = found.budget.iter().find(|line| line.figure == figure).unwrap();
        line.contribution / camera.margin
    };
    assert!(close(contribution("netd"), -0.02, 0.01) && close(contribution("f_number"), -0.02, 0.01));
    assert!(close(contribution("exposure"), 0.005, 0.01));
    assert!(close(found.budget.iter().map(|line| line.share).sum(), 1.0, 1e-12));
    let drawn = found.draws.unwrap();
    assert!(close(drawn.deviation, found.first_order, 0.02), "{drawn:?} {}", found.first_order);
    assert!(close(0.25 * (drawn.interval[1] - drawn.interval[0]), found.first_order, 0.02), "{drawn:?}");
    assert!(found.low <= camera.margin - 2.0 * found.first_order && found.high >= drawn.interval[1]);
    // The nominal margin is that of the figures without their uncertainties.
    let plain = FIGURES.lines().map(|line| {
        let (key, value) = line.split_once(" = { value = ").unwrap();
        format!("{key} = {}\n", value.split(", u").next().unwrap())
    });
    let certain = only(&uncertain(&plain.collect::<String>(), 0.01, ""));
    assert!(certain.uncertainty.is_none() && close(certain.margin, camera.margin, 1e-9));
}

/// 0.07 above or below the demand with 3 % of uncertainty is decided by two deviations, 0.03 is not; exit code 3 is not 'yes'.
#[test]
fn a_camera_near_the_demand_is_undecided() {
    let least = only(&uncertain(FIGURES, 1.0, "")).statistical_distance;
    for (factor, verdict) in
        [(0.9, Verdict::Meets), (0.97, Verdict::Undecided), (1.03, Verdict::Undecided), (1.1, Verdict::Fails)]
    {
        let text = uncertain(FIGURES, factor * least, "");
        let camera = only(&text);
        assert_eq!((camera.verdict, camera.passes), (verdict, verdict == Verdict::Meets), "{factor}");
        let folder = Folder::with(&text);
        let outcome = folder.accepting(&["rule", "a.toml", "--check"]);
        assert_eq!(
            outcome.code,
            if verdict == Verdict::Meets { 0 } else { 3 },
            "{factor}: {}",
            outcome.stdout
        );
        if verdict == Verdict::Undecided {
            assert!(outcome.stdout.contains("undecided: the margin lies between"), "{}", outcome.stdout);
            let json = folder.json(&["rule", "a.toml"]);
            assert_eq!(json["cameras"][0]["verdict"], "undecided");
            assert!(
                json["sentence"].as_str().unwrap().starts_with("Whether ours meets the rule is undecided.")
            );
        }
        // With a wider guard the surest are undecided too.
        let wide = only(&uncertain(FIGURES, factor * least, "[uncertainty]\ncoverage_factor = 5\n"));
        assert_eq!(wide.verdict, Verdict::Undecided, "{factor}");
    }
}

/// A figure that no longer is as it was when its uncertainty is 0 would say that the camera was put together otherwise.
#[test]
fn a_figure_that_is_stated_again_is_the_same_camera() {
    for preset in presets::all().unwrap().iter().filter(|preset| preset.camera().is_ok()) {
        let text = NIGHT.replace("cameras = [\"flir-a325sc\"]\n", "");
        let (scene, _) = text.split_once("[bands]").unwrap();
        let scene = format!("{scene}[envelope]\ntemperature = [\"25 degC\", \"37 degC\"]\n");
        let own = only(&format!("{scene}[[camera]]\npreset = {:?}\n", preset.name));
        let same =
            only(&format!("{scene}[[camera]]\npreset = {:?}\nexposure = {{ u = \"0 s\" }}\n", preset.name));
        // One band tells nothing apart, and what is 0 has no uncertainty.
        let Some(found) = same.uncertainty else { continue };
        assert!(close(same.margin, own.margin, 1e-12), "{}", preset.name);
        assert!(
            close(found.draws.unwrap().mean, own.margin, 1e-9),
            "{}: {found:?} {}",
            preset.name,
            own.margin
        );
    }
}

/// Two figures, each of which fills the well only with the other: met by neither side of one, undecided by both.
#[test]
fn what_spoils_a_picture_by_several_figures_at_once_is_undecided() {
    let scene = uncertain(
        "exposure = { value = \"10 ms\", u = \"0.3 ms\" }\nnetd = \"50 mK\"\nf_number = 1.0\nfull_well = 1e30",
        0.001,
        "",
    );
    let reading = only(&scene).brightest_reading;
    let well = |u: &str| {
        scene.replace("full_well = 1e30", &format!("full_well = {{ value = {:e}, u = {u} }}", reading / 0.93))
    };
    assert_eq!(only(&well(&format!("{:e}", 1e-6 * reading))).verdict, Verdict::Meets);
    let both = only(&well(&format!("{:e}", 0.03 * reading)));
    assert_eq!(both.verdict, Verdict::Undecided);
    assert!(both.undecided_by.iter().any(|by| by.code() == "full-well"));
}

/// A figure whose uncertainty leads to what no camera has is named; only the cameras know it.
#[test]
fn an_uncertainty_beyond_its_figure_is_named() {
    let text = uncertain(
        "exposure = \"10 ms\"\nnetd = { value = \"50 mK\", u = \"30 mK\" }\nf_number = 1.0",
        1.0,
        "",
    );
    let error = RuleStudy::new(&Rule::from_toml(&text, None).unwrap(), library())
        .and_then(|study| study.answer(&RuleAsked::default(), &|_, _| ()))
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("camera[0].netd: its uncertainty leads to -0.0100 K, which no netd can be"),
        "{error}"
    );
}

/// The street is rendered without air, and for the figures as they are stated: who passes there may not pass in a rule that has either.
#[test]
fn a_depth_of_uncertain_figures_or_through_air_is_undecided() {
    let street = |figure: &str, more: &str, demanded: &str| {
        let (scene, _) = NIGHT.split_once("[stop]").unwrap();
        let scene = scene.replace("cameras = [\"flir-a325sc\"]\n", "");
        measured(&format!(
            "{scene}{more}[[clause]]\nname = \"z\"\nkind = \"depth-error\"\n[clause.requirement]\ndepth_error = {demanded:?}\nshare = 0.5\n\
             [clause.stereo]\nbaseline = \"0.3 m\"\n[clause.scene]\nsize = [240, 320]\n\
             [[camera]]\nname = \"ours\"\npreset = \"flir-a325sc\"\nf_number = {figure}\n"
        ))
    };
    let (known, uncertain) = ("1.3", "{ value = 1.3, u = 0.1 }");
    let air = "[atmosphere]\nmodel = \"us-standard\"\ntemperature = \"10 degC\"\n";
    let met = street(known, "", "50 m");
    assert_eq!((met.verdict, met.passes), (Verdict::Meets, true), "{met:?}");
    for (figure, more) in [(uncertain, ""), (known, air), (uncertain, air)] {
        let found = street(figure, more, "50 m");
        assert_eq!((found.verdict, found.passes), (Verdict::Undecided, false), "{found:?}");
        assert!(found.undecided_by.iter().any(|by| by.code() == "depth-error"));
        // What fails as it is stated fails.
        assert_eq!(street(figure, more, "0.1 mm").verdict, Verdict::Fails);
    }
}

/// What is promised of a camera is no more than its figures keep on their bad side, 2 x 2.87 % below; that rests on draws and is not called
/// proved. Of pixels alike: a focal length of 1 % is 2 % of them.
#[test]
fn what_is_promised_is_the_lower_end_of_uncertain_figures() {
    let least = only(&uncertain(FIGURES, 1.0, "")).statistical_distance;
    let folder = Folder::with(&uncertain(FIGURES, 0.5 * least, ""));
    let said = |folder: &Folder| folder.run(&["rule", "a.toml", "--check"]).stdout;
    let promised = |line: &str| -> f64 {
        let (_, rest) = line.split_once(": simulated: at least ").unwrap_or_else(|| panic!("{line}"));
        assert!(
            line.contains("times the demand") && line.contains(", with its uncertain figures at k = 2"),
            "{line}"
        );
        rest.split(' ').next().unwrap().parse().unwrap()
    };
    let guarded = 2.0 * (1.0 - 2.0 * 0.0287);
    let shown = promised(&said(&folder));
    assert!(shown <= guarded && shown > 0.97 * guarded, "{shown} {guarded}");
    let json = folder.json(&["rule", "a.toml"]);
    let camera = &json["cameras"][0];
    assert_eq!((&camera["evidence"], &camera["grade"]), (&"simulated".into(), &"assumed".into()));
    let [bound, low] =
        [&camera["lower_bound"], &camera["uncertainty"]["low"]].map(|one| one.as_f64().unwrap());
    assert!(bound <= low * 0.5 * least && bound > 0.97 * guarded * 0.5 * least, "{bound} {low}");
    assert_eq!(folder.run(&["rule", "a.toml", "--out", "out", "-q"]).code, 0);
    let read = |name: &str| fs::read_to_string(folder.path().join("out").join(name)).unwrap();
    let record: serde_json::Value = serde_json::from_str(&read("certificate.json")).unwrap();
    let line = &record["clauses"][0]["lines"][0];
    assert!(line["margin_proved"].as_f64().unwrap() <= low && line["evidence"] == "assumed", "{line}");
    assert!(read("certificate.intoto.json").contains("\"result\": \"WARNED\""));
    let (scene, _) = NIGHT.split_once("[stop]").unwrap();
    let shape = format!(
        "{scene}distance = [\"5 m\", \"10 m\"]\n[[clause]]\nname = \"shape\"\nkind = \"resolution\"\n[clause.requirement]\npixels = 20\nsize = \"0.5 m\"\n\
         [[camera]]\nname = \"ours\"\nexposure = \"1 ms\"\npixel = \"12 um\"\nf_number = 1.0\nfocal_length = {{ value = \"14 mm\", u = \"0.14 mm\" }}\n\
         netd = \"50 mK\"\n"
    );
    let folder = Folder::with(&shape.replace("cameras = [\"flir-a325sc\"]\n", ""));
    let shown = promised(said(&folder).lines().nth(1).unwrap());
    let pixels = 0.5 * 14e-3 / (10.0 * 12e-6);
    assert!(shown <= 0.98 * pixels / 20.0 && shown > 0.97 * pixels / 20.0, "{shown} {pixels}");
}

/// A temperature is as wrong as the emissivity is taken to be: who passes for an exact one is undecided in a rule with errors of it.
#[test]
fn a_temperature_of_uncertain_emissivities_is_undecided() {
    let text = |error: &str, demanded: &str| {
        measured(&format!(
            "[target]\nmaterial = \"skin\"\ntemperature = \"33 degC\"\n[alternatives]\nmaterials = [\"pmma\"]\n\
             [bands]\nranges = [[\"8 um\", \"14 um\"]]\nintegrate = true\n[unknown]\nnuisances = [\"temperature\"]\n{error}\
             [[clause]]\nname = \"t\"\nkind = \"temperature-error\"\n[clause.requirement]\ntemperature_error = {demanded:?}\n\
             [[camera]]\npreset = \"flir-a325sc\"\n"
        ))
    };
    let errors = "[sensitivity]\nemissivity_error = 0.01\n";
    assert_eq!(text("", "1 K").verdict, Verdict::Meets);
    assert_eq!(text("[sensitivity]\nemissivity_error = 0.0\n", "1 K").verdict, Verdict::Meets);
    let found = text(errors, "1 K");
    assert_eq!((found.verdict, found.passes), (Verdict::Undecided, false));
    assert!(found.undecided_by.iter().any(|by| by.code() == "temperature-error"));
    assert_eq!(text(errors, "1 mK").verdict, Verdict::Fails);
}

/// The worst scene of a noisier camera may be another one: cold, where the gain hardly matters, in the place of hot. The interval of the uncertain
/// camera holds the margins of the cameras at its ends, each with a worst scene of its own.
#[test]
fn the_worst_scene_of_another_camera_is_looked_at() {
    let rule = |netd: &str| {
        measured(&format!(
            "[target]\nmaterial = \"skin\"\ntemperature = \"50 degC\"\ndistance = \"2 m\"\n\
             [[environment]]\ntemperature = \"20 degC\"\nlighting = 1.0\n[alternatives]\nmaterials = [\"fabric\"]\n\
             [bands]\nranges = [[\"8 um\", \"13 um\"]]\n[unknown]\nnuisances = [\"temperature\", \"gain\"]\npriors = {{ gain = 0.01 }}\n\
             [envelope]\ntemperature = [\"0 degC\", \"100 degC\"]\n[[clause]]\nname = \"t\"\nkind = \"temperature-error\"\n\
             [clause.requirement]\ntemperature_error = \"2.3 K\"\ncoverage_factor = 2\n\
             [[camera]]\npreset = \"flir-a325sc-25um\"\nnetd = {netd}\n"
        ))
    };
    let nominal = rule("\"0.35 K\"");
    let uncertain = rule("{ value = \"0.35 K\", u = \"0.15 K\" }");
    let (noisy, quiet) = (rule("\"0.65 K\""), rule("\"0.05 K\""));
    let hot = |one: &hadar_study::MeasuredVerdict| one.limiting.temperature_k.unwrap() > 300.0;
    assert!(hot(&nominal) && !hot(&noisy) && noisy.margin < 1.0 && nominal.margin > 1.05, "{}", noisy.margin);
    let found = uncertain.uncertainty.as_ref().unwrap();
    // Ends of what ±2 deviations hold, found by draws.
    assert!(found.low < 1.01 * noisy.margin, "{} {}", found.low, noisy.margin);
    assert!(found.high > 0.99 * quiet.margin, "{} {}", found.high, quiet.margin);
    assert_eq!(uncertain.verdict, Verdict::Undecided);
}

/// Scenes and pairs searched anew in every draw, as the program does for one camera: the lower end is no higher than theirs, and not far below.
#[test]
fn the_lower_end_is_that_of_cameras_searched_one_by_one() {
    let text = NIGHT.replace("cameras = [\"flir-a325sc\"]\n", "");
    let (scene, _) = text.split_once("[stop]").unwrap();
    let scene = scene
        .replace("[\"aluminium\"]", "[\"aluminium\", \"pmma\", \"polycarbonate\", \"soda-lime-glass\"]")
        .replace("[envelope]", "[unknown]\nnuisances = [\"temperature\", \"lighting\"]\n[envelope]\nlighting = [0.1, 0.9]\nsurroundings = [\"-5 degC\", \"20 degC\"]");
    let camera = |netd: &str, f_number: &str| {
        format!(
            "{scene}[requirement]\ndistance = 0.3\n[[camera]]\nnoise_exposure = \"10 ms\"\nexposure = \"10 ms\"\npixel = \"12 um\"\n\
             focal_length = \"14 mm\"\nnetd_temperature = \"25 degC\"\nnetd_f_number = 1.0\nnetd = {netd}\nf_number = {f_number}\n"
        )
    };
    let guarded = only(&camera("{ value = \"30 mK\", u = \"8 mK\" }", "{ value = 1.1, u = 0.1 }"));
    let found = guarded.uncertainty.unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(45);
    let mut draw = || -> f64 { StandardNormal.sample(&mut random) };
    let mut margins: Vec<f64> = (0..120)
        .filter_map(|_| {
            let (netd, f) = (30.0 + 8.0 * draw(), 1.1 + 0.1 * draw());
            (netd > 0.0 && f > 0.5).then(|| only(&camera(&format!("\"{netd} mK\""), &f.to_string())).margin)
        })
        .collect();
    margins.sort_by(f64::total_cmp);
    // The share of 2.28 % of 120 is below the seventh (95 %).
    assert!(found.low <= margins[6], "{} {:?}", found.low, &margins[..12]);
    let surely = found.draws.unwrap().surely_above;
    assert!(surely <= margins[6] && surely >= 0.7 * margins[0], "{surely} {:?}", &margins[..12]);
}
