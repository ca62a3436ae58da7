//! Classes of several spectra, as a person has them: the verdict, what it rests on, every mistake.

use crate::support::answers::{close, has, number, texts};
use crate::support::folder::Folder;

/// A person of two spectra before robots of three, from files.
const CLASSES: &str = r#"[class.person]
materials = ["skin.csv", "cloth.csv"]
weights = [1.0, 3.0]

[class.robot]
materials = ["robots/"]

[target]
material = "person"
temperature = "37 degC"

[[environment]]
temperature = "20 degC"
lighting = 0.5

[alternatives]
materials = ["robot"]

[bands]
start = "760 cm^-1"
stop = "1240 cm^-1"
step = "20 cm^-1"

[camera]
preset = "ideal-pnrd"
exposure = "1 ms"

[requirement]
distance = 1.0
"#;

/// A spectrum of a level with one wave.
fn spectrum(level: f64, wave: f64, periods: f64) -> String {
    let mut text = "wavenumber_cm1,emissivity\n".to_owned();
    for i in 0..=60 {
        let (nu, t) = (700.0 + 10.0 * f64::from(i), f64::from(i) / 60.0);
        text += &format!("{nu},{}\n", level + wave * (6.3 * periods * t).cos());
    }
    text
}

fn folder(scenario: &str) -> Folder {
    let folder = Folder::with(scenario);
    std::fs::create_dir_all(folder.path().join("robots")).unwrap();
    std::fs::create_dir_all(folder.path().join("none")).unwrap();
    for (name, level, wave, periods) in [
        ("skin.csv", 0.95, 0.01, 1.0),
        ("cloth.csv", 0.88, 0.02, 0.5),
        ("robots/paint-a.csv", 0.93, 0.02, 1.5),
        ("robots/paint-b.csv", 0.90, 0.03, 2.0),
        ("robots/steel.csv", 0.30, 0.02, 0.7),
    ] {
        folder.file(name, &spectrum(level, wave, periods));
    }
    folder.file("short.csv", "wavenumber_cm1,emissivity\n800,0.5\n1400,0.6\n");
    folder
}

/// The answer on classes is that of the worst of all pairs of members, each asked for by itself.
#[test]
fn a_class_is_as_good_as_its_worst_member() {
    let folder = folder(CLASSES);
    let answer = folder.json(&["identify", "a.toml"]);
    let class = &answer["classes"][0];
    has(
        class,
        &[
            "target",
            "alternative",
            "pairs",
            "searched",
            "worst",
            "distance",
            "distance_lower",
            "told_apart",
            "leave_one_out",
        ],
    );
    assert_eq!(number(&class["pairs"]), 6.0);
    let (mut least, mut told, mut shares, mut mean) = (f64::INFINITY, 0.0, 0.0, 0.0);
    let mut worst = Vec::new();
    for (own, weight) in [("skin.csv", 0.25), ("cloth.csv", 0.75)] {
        for other in ["robots/paint-a.csv", "robots/paint-b.csv", "robots/steel.csv"] {
            let alone = CLASSES
                .replace("material = \"person\"", &format!("material = \"{own}\""))
                .replace("materials = [\"robot\"]", &format!("materials = [\"{other}\"]"));
            folder.file("pair.toml", &alone);
            let pair = folder.json(&["identify", "pair.toml"])["pairs"][0].clone();
            let distance = number(&pair["statistical_distance"]);
            if distance < least {
                (least, worst) =
                    (distance, vec![format!("person/{}", stem(own)), format!("robot/{}", stem(other))]);
            }
            shares += weight / 3.0;
            told += weight / 3.0 * f64::from(u8::from(distance >= 1.0));
            mean += weight / 3.0 * number(&pair["detection_probability"]);
        }
    }
    close("shares", shares, 1.0, 1e-12);
    close("the worst pair", number(&class["distance"]), least, 1e-6);
    assert_eq!(texts(&class["worst"]), worst);
    close("the pair in the answer", number(&answer["pairs"][0]["statistical_distance"]), least, 1e-6);
    assert!((number(&class["share_of_pairs_told"]) - told).abs() < 1e-12);
    let [low, high] = [0, 1].map(|end| number(&class["mean_detection_probability"][end]));
    assert!(low <= mean + 1e-6 && mean <= high + 1e-6, "{low} {mean} {high}");
    let text = folder.run(&["size", "a.toml"]);
    assert!(
        text.stdout.contains("It rests on 2 spectra of person and 3 spectra of robot"),
        "{}",
        text.stdout
    );
}

fn stem(name: &str) -> &str {
    name.rsplit('/').next().unwrap().trim_end_matches(".csv")
}

/// Mixtures of members can only be nearer; a class of a sample covariance is its mean, and says how it scatters.
#[test]
fn mixtures_and_means_of_a_class() {
    let alone = folder(CLASSES).json(&["size", "a.toml"]);
    let mixed = CLASSES.replace("[class.robot]", "[class.robot]\nmixtures = true");
    let answer = folder(&mixed).json(&["size", "a.toml"]);
    let (members, mixtures) = (&alone["classes"][0], &answer["classes"][0]["mixtures"]);
    let (lower, found) = (number(&mixtures["distance_lower"]), number(&mixtures["distance"]));
    assert!(lower <= found && found <= number(&members["distance"]) * (1.0 + 1e-9), "{mixtures}");
    let mean = CLASSES
        .replace("[class.robot]", "[class.robot]\ncovariance = \"sample\"")
        .replace("[bands]", "[bands]\nintegrate = false");
    let answer = folder(&mean).json(&["size", "a.toml"]);
    let of = &answer["sensitivity"]["emissivity"]["of_classes"][0];
    assert_eq!((of["class"].as_str(), number(&of["spectra"])), (Some("robot"), 3.0));
    // Sample variance of three spectra, averaged over the bands, written down once more.
    let value = |level: f64, wave: f64, periods: f64, t: f64| level + wave * (6.3 * periods * t).cos();
    let bands: Vec<f64> = (0..25).map(|i| (60.0 + 20.0 * f64::from(i)) / 600.0).collect();
    let variance: f64 = bands
        .iter()
        .map(|t| {
            let e = [value(0.93, 0.02, 1.5, *t), value(0.90, 0.03, 2.0, *t), value(0.30, 0.02, 0.7, *t)];
            let mean = e.iter().sum::<f64>() / 3.0;
            e.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / 2.0
        })
        .sum();
    close("the scatter of the class", number(&of["error"]), (variance / 25.0).sqrt(), 1e-9);
}

/// Every member is searched in a rule, and the certificate says how many there are.
#[test]
fn a_rule_looks_at_every_member() {
    let rule = CLASSES.replace("[camera]\npreset = \"ideal-pnrd\"\nexposure = \"1 ms\"\n", "")
        + "\n[envelope]\ntemperature = [\"30 degC\", \"37 degC\"]\n";
    let rule = format!("cameras = [\"ideal-pnrd\"]\n{rule}");
    let folder = folder(&rule);
    let answer = folder.json(&["rule", "a.toml"]);
    let limiting = &answer["cameras"][0]["limiting"];
    let mut least = f64::INFINITY;
    for own in ["skin.csv", "cloth.csv"] {
        for other in ["robots/paint-a.csv", "robots/paint-b.csv", "robots/steel.csv"] {
            let alone = rule
                .replace("material = \"person\"", &format!("material = \"{own}\""))
                .replace("materials = [\"robot\"]", &format!("materials = [\"{other}\"]"));
            folder.file("pair.toml", &alone);
            least = least.min(number(&folder.json(&["rule", "pair.toml"])["cameras"][0]["margin"]));
        }
    }
    // Worst cases are proved to 1 %.
    close("the margin", number(&answer["cameras"][0]["margin"]), least, 0.01);
    assert!(limiting["target"].as_str().unwrap().starts_with("person/"), "{limiting}");
    let text = folder.run(&["rule", "a.toml"]).stdout;
    assert!(text.contains("any of 2 spectra of person") || text.contains("person"), "{text}");
}

/// The classes of the library for a person and a machine need no table, and what of them has no spectrum is said wherever they are.
#[test]
fn a_person_and_a_robot_are_in_the_library() {
    let (_, question) = CLASSES.split_once("[target]").unwrap();
    let folder = folder(&format!("[target]{question}"));
    #[track_caller]
    fn says(text: &str, parts: &[&str]) {
        parts.iter().for_each(|part| assert!(text.contains(part), "{text}\n{part}"));
    }
    let answer = folder.json(&["size", "a.toml"]);
    let class = &answer["classes"][0];
    assert_eq!(texts(&class["target"]["one_number"]), ["person/skin", "person/fabric"]);
    assert!(texts(&class["alternative"]["one_number"]).is_empty());
    says(
        answer["verdict"]["sentence"].as_str().unwrap(),
        &["3 spectra of person (2 entered as one number) and 24 spectra of robot"],
    );
    says(
        &folder.run(&["size", "a.toml"]).stdout,
        &["entered as one number              person/skin, person/fabric"],
    );
    let listed = folder.run(&["materials", "list"]).stdout;
    says(&listed, &["  person: skin (one number), tissue-blood-proxy, fabric (one number)"]);
    let shown = folder.run(&["materials", "show", "person"]).stdout;
    says(&shown, &["human skin, one number for all wavenumbers", "clothing, one number for all wavenumbers"]);
    let shown = folder.json(&["materials", "show", "robot"]);
    assert_eq!(texts(&shown["members"]).len(), 24);
    for (word, class) in [("human", "person"), ("people", "person"), ("vehicle", "robot")] {
        folder.file("a.toml", &format!("[target]{question}").replace("\"person\"", &format!("{word:?}")));
        let said = folder.refusal(&["size", "a.toml"]);
        says(
            &said,
            &[&format!(
                "a.toml:2: target.material: there is no material `{word}`; write `{class}`, the class"
            )],
        );
    }
}

#[test]
fn every_mistake_about_classes_is_one_line() {
    let with = |old: &str, new: &str| CLASSES.replace(old, new);
    for (scenario, flags, said) in [
        (
            with("materials = [\"robots/\"]", "materials = []"),
            vec![],
            "class.robot.materials: the class has no members; write",
        ),
        (with("\"robots/\"", "\"none/\""), vec![], "no file of spectra is here"),
        (with("\"robots/\"", "\"robots/*.txt\""), vec![], "no file of spectra is here"),
        (
            with("\"cloth.csv\"", "\"short.csv\""),
            vec![],
            "target.material: 1 of 2 members of `person` do not cover the bands (760 to 1240 cm^-1): person/short; leave them out",
        ),
        (
            with(
                "[class.person]\nmaterials = [\"skin.csv\", \"cloth.csv\"]\nweights = [1.0, 3.0]",
                "[class.person]\nmaterials = [\"short.csv\"]",
            ),
            vec!["--skip-uncovered"],
            "1 of 1 members of `person` do not cover the bands (760 to 1240 cm^-1): person/short; choose bands",
        ),
        (
            with("class.robot", "class.gold"),
            vec![],
            "class.gold: `gold` is a class here and a material of the library; call the class otherwise",
        ),
        (with("class.robot", "class.\"a b\""), vec![], "`a b` is no name for a class; write small letters"),
        (
            with("weights = [1.0, 3.0]", "weights = [1.0]"),
            vec![],
            "class.person.weights: 1 weights for 2 materials; write one for each",
        ),
        (
            with("weights = [1.0, 3.0]", "weights = [0.0, 0.0]"),
            vec![],
            "class.person: the weights of the class add up to nothing",
        ),
        (with("weights = [1.0, 3.0]", "weights = [-1.0, 3.0]"), vec![], "class.person.weights[0]"),
        (
            with("weights = [1.0, 3.0]", "covariance = \"sample\"\nmixtures = true"),
            vec![],
            "mixtures of a class that stands as its mean",
        ),
        (
            with("weights = [1.0, 3.0]", "emissivity_error = 0.01"),
            vec![],
            "errors of an emissivity without their correlation",
        ),
        (with("weights = [1.0, 3.0]", "correlation = \"10 cm^-1\""), vec![], "a correlation of no errors"),
        (
            with("\"cloth.csv\"", "\"skin.csv\""),
            vec![],
            "class.person.materials[1]: the same is already in the list",
        ),
        (
            with("temperature = \"20 degC\"", "temperature = \"20 degC\"\nmaterial = \"robot\""),
            vec![],
            "environment[0].material: `robot` is a class of several spectra, and one is needed here",
        ),
        (
            CLASSES.to_owned(),
            vec!["--bands", "3"],
            "bands are chosen for one material against others, and there is a class",
        ),
    ] {
        let said_here = folder(&scenario).refusal(&[&["identify", "a.toml"], flags.as_slice()].concat());
        assert!(said_here.contains(said), "{said_here}\n{said}");
    }
}

/// What spoils the image of any member spoils that of the class: here the one that is not in the hardest pair is too bright for the well.
#[test]
fn every_member_must_fit_into_the_well() {
    let scenario = CLASSES
        .replace(
            "materials = [\"skin.csv\", \"cloth.csv\"]\nweights = [1.0, 3.0]",
            "materials = [\"dim.csv\", \"bright.csv\"]",
        )
        .replace("materials = [\"robots/\"]", "materials = [\"alt.csv\", \"alt2.csv\"]");
    let files = |scenario: &str| {
        let folder = folder(scenario);
        for (name, level, wave, periods) in [
            ("dim.csv", 0.3, 0.05, 1.0),
            ("bright.csv", 0.97, 0.02, 3.0),
            ("alt.csv", 0.3, 0.049, 1.0),
            ("alt2.csv", 0.31, 0.05, 1.1),
        ] {
            folder.file(name, &spectrum(level, wave, periods));
        }
        folder
    };
    let reading = |target: &str| {
        let alone = scenario.replace("material = \"person\"", &format!("material = \"{target}\""));
        let answer = files(&alone).json(&["size", "a.toml"]);
        number(&answer["camera"]["brightest_reading"])
    };
    let (dim, bright) = (reading("dim.csv"), reading("bright.csv"));
    assert!(bright > 1.2 * dim, "{dim} {bright}");
    let with_well = |well: f64| {
        scenario.replace("exposure = \"1 ms\"", &format!("exposure = \"1 ms\"\nfull_well = {well}"))
    };
    for (well, met) in [(0.5 * (dim + bright), false), (1.01 * bright, true)] {
        let folder = files(&with_well(well));
        let answer = folder.json(&["size", "a.toml"]);
        assert_eq!(answer["verdict"]["met"].as_bool(), Some(met), "{}", answer["verdict"]);
        assert!(texts(&answer["classes"][0]["worst"])[0].ends_with("dim"));
        assert_eq!(folder.accepting(&["size", "a.toml", "--check"]).code, if met { 0 } else { 3 });
    }
}

/// Two alternatives of one name are told by their place.
#[test]
fn alternatives_of_one_name_do_not_hide_each_other() {
    let scenario = CLASSES.replace("materials = [\"robot\"]", "materials = [\"far/a.csv\", \"near/a.csv\"]");
    let folder = folder(&scenario);
    for (name, level, wave, periods) in [("far/a.csv", 0.3, 0.05, 1.0), ("near/a.csv", 0.95, 0.0105, 1.0)] {
        std::fs::create_dir_all(folder.path().join(name).parent().unwrap()).unwrap();
        folder.file(name, &spectrum(level, wave, periods));
    }
    let answer = folder.json(&["size", "a.toml"]);
    let least = number(&answer["classes"][1]["distance"]);
    assert!(least < 0.1 * number(&answer["classes"][0]["distance"]), "{}", answer["classes"]);
    close("the verdict", number(&answer["verdict"]["statistical_distance"]), least, 1e-6);
    let met = answer["verdict"]["met"].as_bool().unwrap();
    assert_eq!(folder.accepting(&["size", "a.toml", "--check"]).code, if met { 0 } else { 3 });
}

/// The bound of mixtures is below every mixture that a pair alone finds, with a known total of the lighting and a narrow range too; a
/// common member is no distance at all.
#[test]
fn bounds_of_mixtures_hold_for_mixtures_one_by_one() {
    let ranged = |more: &str, unknown: &str| {
        CLASSES
            .replace("[camera]\npreset = \"ideal-pnrd\"\nexposure = \"1 ms\"\n", unknown)
            .replace("materials = [\"robot\"]", &format!("materials = [\"robot\"]\n{more}"))
            .replace(
                "lighting = 0.5",
                "lighting = 0.5\n[[environment]]\ntemperature = \"-20 degC\"\nlighting = 0.4",
            )
            .replace("material = \"person\"", "material = \"skin.csv\"")
            .replace(
                "materials = [\"robots/\"]",
                "materials = [\"robots/paint-a.csv\", \"robots/paint-b.csv\"]\nmixtures = true",
            )
    };
    for (more, unknown) in [
        ("", ""),
        (
            "lighting = [0.0, 0.5]",
            "[unknown]\nnuisances = [\"temperature\", \"lighting\"]\nlighting_total = 0.9\n",
        ),
        (
            "lighting = [0.3, 0.6]",
            "[unknown]\nnuisances = [\"temperature\", \"lighting\"]\nlighting_total = 0.9\n",
        ),
        ("", "[unknown]\nnuisances = [\"temperature\"]\n"),
        ("", "[unknown]\nnuisances = []\n"),
    ] {
        let scenario = ranged(more, unknown);
        let folder = folder(&scenario);
        let answer = folder.json(&["identify", "a.toml"]);
        let mixtures = &answer["classes"][0]["mixtures"];
        let (lower, found) = (number(&mixtures["distance_lower"]), number(&mixtures["distance"]));
        let mut least = f64::INFINITY;
        for tenth in 0..=10 {
            let p = f64::from(tenth) / 10.0;
            let (a, b) = (spectrum(0.93, 0.02, 1.5), spectrum(0.90, 0.03, 2.0));
            let mut text = "wavenumber_cm1,emissivity\n".to_owned();
            for (a, b) in a.lines().zip(b.lines()).skip(1) {
                let value = |line: &str| line.split_once(',').unwrap().1.parse::<f64>().unwrap();
                text +=
                    &format!("{},{}\n", a.split_once(',').unwrap().0, p * value(a) + (1.0 - p) * value(b));
            }
            folder.file("mixed.csv", &text);
            folder.file(
                "pair.toml",
                &scenario.replace("materials = [\"robot\"]", "materials = [\"mixed.csv\"]"),
            );
            let pair = folder.json(&["identify", "pair.toml"])["pairs"][0].clone();
            least = least.min(number(&pair["distance_nearest"]));
        }
        assert!(lower <= least * (1.0 + 1e-9), "{more} {unknown}: {lower} {least}");
        assert!(found <= least * 1.001, "{more} {unknown}: {found} {least}");
    }
    let common = ranged("", "").replace("\"robots/paint-b.csv\"", "\"skin.csv\"");
    let answer = folder(&common).json(&["identify", "a.toml"]);
    assert_eq!(number(&answer["classes"][0]["distance"]), 0.0);
}

/// Without alternatives named, the target's own members are none.
#[test]
fn the_members_of_the_target_are_no_alternatives() {
    let scenario = CLASSES
        .replace(
            "[class.person]\nmaterials = [\"skin.csv\", \"cloth.csv\"]\nweights = [1.0, 3.0]",
            "[class.metal]\nmaterials = [\"gold\", \"iron\"]",
        )
        .replace("material = \"person\"", "material = \"metal\"")
        .replace("[alternatives]\nmaterials = [\"robot\"]\n", "");
    let answer = folder(&scenario).json(&["identify", "a.toml", "--skip-uncovered"]);
    let names: Vec<&str> = answer["pairs"]
        .as_array()
        .unwrap()
        .iter()
        .map(|pair| pair["alternative"].as_str().unwrap())
        .collect();
    assert!(names.contains(&"copper") && !names.contains(&"gold") && !names.contains(&"iron"), "{names:?}");
}
