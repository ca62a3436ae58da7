//! The page for rules: its answers are those of the engine, it says no 'yes' that the engine does not, and no rule of it reads a file.

use crate::support::{get, paths_of_files, post, post_with, server};
use hadar::material::Library;
use hadar_report::json::value;
use hadar_report::rule::{self, Output};
use hadar_scenario::keys::FILES;
use hadar_scenario::{Rule, Written, day};
use hadar_study::{Reforms, RuleAnswer, RuleAsked, RuleStudy};
use serde_json::{Value as Json, json};
use std::io::Write;
use std::net::TcpStream;

const FEVER: &str = include_str!("../../rules/fever_screening.toml");
const R152: &str = include_str!("../../rules/un_r152_pedestrian.toml");
const WASHINGTON: &str = include_str!("../../rules/delivery_robots_washington.toml");

/// A rule of one clause that a camera meets under conditions.
const BRIEF: &str = "cameras = [\"flir-a325sc\", \"ideal-pnrd\"]\n[rule]\nname = \"Ours\"\nfrom = 2029-09-01\n\
    [target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\n[[environment]]\ntemperature = \"20 degC\"\nlighting = 0.5\n\
    [alternatives]\nmaterials = [\"pmma\"]\n[bands]\nstart = \"750 cm^-1\"\nstop = \"1250 cm^-1\"\nstep = \"100 cm^-1\"\n\
    [envelope]\ntemperature = [\"30 degC\", \"37 degC\"]\n";

const REFORM: &str = "[[reform]]\nname = \"surer\"\nset = [\"requirement.detection_probability = 0.999999\"]\nchoice = \"a test\"\n\
    [[reform]]\nname = \"the same\"\nset = [\"envelope.temperature[1] = \\\"36 degC\\\"\"]\nchoice = \"a test\"\n";

fn asked(path: &str, body: &Json) -> Json {
    let (status, answer) = post(path, body);
    assert_eq!(status, 200, "{answer}");
    serde_json::from_str(&answer).unwrap()
}

fn of_engine(text: &str, on: Option<&str>) -> (RuleAnswer, String) {
    let library = Library::embedded().unwrap();
    let study = RuleStudy::new(&Rule::from_toml(text, None).unwrap(), &library).unwrap();
    let asked = RuleAsked { seed: 1, on: on.and_then(day), ..RuleAsked::default() };
    let answer = study.answer(&asked, &|_, _| ()).unwrap();
    let text = rule::text(&answer, &study);
    (answer, text)
}

/// Without what was read and what it took.
fn bare(mut answer: Json) -> Json {
    for key in ["inputs", "stats", "hadar", "schema"] {
        answer.as_object_mut().unwrap().remove(key);
    }
    answer
}

#[test]
fn the_answer_is_that_of_the_engine() {
    for (text, on) in
        [(FEVER, None), (R152, Some("2030-01-01")), (R152, Some("1990-01-01")), (BRIEF, Some("2029-09-01"))]
    {
        let page = asked("/rule", &json!({ "rule": text, "on": on }))["answer"].take();
        let (own, printed) = of_engine(text, on);
        let of_page: Json = serde_json::from_str(page["json"].as_str().unwrap()).unwrap();
        let of_engine = value(&Output::of(&own, &[])).unwrap();
        assert_eq!(bare(of_page), bare(of_engine.clone()));
        assert_eq!(page["text"], printed);
        let shown = &page["shown"];
        assert_eq!((&shown["sentence"], &shown["result"]), (&of_engine["sentence"], &of_engine["result"]));
        assert_eq!(shown["reasons"].as_array().unwrap().is_empty(), shown["result"] == "PASSED");
        // The margins, and the approach of each clause that has one.
        let pictures = page["pictures"].as_array().unwrap();
        let approaches = of_engine["clauses"].as_array().into_iter().flatten();
        let approaches = approaches.filter(|clause| !clause["stop"].is_null()).count();
        assert!(pictures[0][0] == "margins" && pictures.len() > approaches, "{}", pictures.len());
        let report = page["report"].as_str().unwrap();
        let command =
            on.map_or("hadar rule rule.toml".to_owned(), |on| format!("hadar rule rule.toml --on {on}"));
        assert!(report.starts_with("<!DOCTYPE html>") && report.contains(&command), "{command}");
    }
}

/// The page says 'yes' where the engine says so unconditionally, and passed where it says passed.
#[test]
fn no_verdict_is_better_than_that_of_the_engine() {
    let mut seen = Vec::new();
    for text in [FEVER, R152, BRIEF] {
        let shown = asked("/rule", &json!({ "rule": text }))["answer"]["shown"].take();
        assert_ne!(shown["result"], "PASSED", "no day was stated");
        let (own, _) = of_engine(text, None);
        for (clause, of_page) in own.clauses.iter().zip(shown["clauses"].as_array().unwrap()) {
            for (line, cell) in clause.lines().iter().zip(of_page["cells"].as_array().unwrap()) {
                let open = line.conditions.iter().any(|one| one.favourable());
                let expected = match (line.verdict.name(), open) {
                    ("meets", false) => "yes",
                    ("meets", true) => "yes, if",
                    ("undecided", _) => "undecided",
                    _ => "no",
                };
                assert_eq!(cell["verdict"], expected, "{}", line.camera);
                for said in ["short", "full"] {
                    assert!(cell[said].as_str().unwrap().starts_with(expected), "{cell}");
                }
                assert!(!cell["scene"].as_str().unwrap().is_empty(), "{cell}");
                seen.push(expected);
            }
        }
        let whole = shown["whole"].as_array().unwrap();
        assert_eq!(whole.len(), if own.clauses.len() > 1 { own.cameras.len() } else { 0 });
        for (camera, cell) in own.cameras.iter().zip(whole) {
            assert_eq!(cell["verdict"].as_str().unwrap().starts_with("yes"), camera.passes, "{cell}");
        }
    }
    for verdict in ["no", "yes, if"] {
        assert!(seen.contains(&verdict), "{verdict}");
    }
}

#[test]
fn a_reform_stands_beside_the_rule_as_the_command_has_it() {
    let text = BRIEF.to_owned() + REFORM;
    let answer = asked("/rule", &json!({ "rule": text }))["answer"].take();
    let offered: Vec<&str> =
        answer["reforms"].as_array().unwrap().iter().map(|one| one["name"].as_str().unwrap()).collect();
    assert_eq!(offered, ["surer", "the same"]);
    let page = asked("/rule/reforms", &json!({ "rule": text }))["answer"].take();
    let own =
        Reforms::of(&Written::of(&text, None), &Library::embedded().unwrap(), false, &|_, _| ()).unwrap();
    let of_page: Json = serde_json::from_str(page["json"].as_str().unwrap()).unwrap();
    assert_eq!(bare(of_page), bare(value(&own).unwrap()));
    assert_eq!(page["text"], rule::reforms(&own));
    for (reform, shown) in own.reforms.iter().zip(page["reforms"].as_array().unwrap()) {
        let sentence = shown["changes"].as_str().unwrap();
        assert!(page["text"].as_str().unwrap().contains(sentence), "{sentence}");
        assert_eq!(sentence.contains("changes no verdict"), reform.changed.is_empty(), "{sentence}");
        let cells = shown["cells"].as_array().unwrap();
        for (law, cell) in own.law.iter().zip(cells) {
            assert_eq!(cell["changed"], reform.changed.contains(&law.camera), "{cell}");
        }
    }
    assert!(!own.reforms[0].changed.is_empty() && own.reforms[1].changed.is_empty());
    // The rule itself is answered as without its reforms.
    let without = asked("/rule", &json!({ "rule": BRIEF }))["answer"].take();
    for key in ["sentence", "result", "reasons", "clauses"] {
        assert_eq!(answer["shown"][key], without["shown"][key], "{key}");
    }
}

#[test]
fn what_is_wrong_is_one_message() {
    let wrong = |rule: &str, on: &str, expected: &str| {
        for path in ["/rule", "/rule/reforms"] {
            let question = match path {
                "/rule" => json!({ "rule": rule, "on": on }),
                _ if on.is_empty() => json!({ "rule": rule }),
                _ => continue,
            };
            let answered = asked(path, &question);
            let message = answered["error"]["message"].as_str().unwrap();
            assert!(answered["answer"].is_null() && message.contains(expected), "{path} {message}");
            assert!(!message.contains('\n') && !message.starts_with(':'), "{message}");
        }
    };
    wrong("[target", "", "line 1");
    wrong("", "", "the file is empty");
    wrong(&BRIEF.replace("\"flir-a325sc\", \"ideal-pnrd\"", ""), "", "no camera");
    wrong(&BRIEF.replace("\"ideal-pnrd\"", "\"ideal-prd\""), "", "ideal-pnrd");
    wrong(&BRIEF.replace("[\"30", "[\"40"), "", "envelope.temperature");
    wrong(BRIEF, "yesterday", "is no day");
    let sets = "[[reform]]\nname = \"x\"\nset = [\"envelope.nothing = 1\"]\nchoice = \"a test\"\n";
    let answered = asked("/rule/reforms", &json!({ "rule": BRIEF.to_owned() + sets }));
    assert!(answered["error"]["message"].as_str().unwrap().contains("reform"), "{answered}");
    let none = asked("/rule/reforms", &json!({ "rule": BRIEF }));
    assert!(none["error"]["message"].as_str().unwrap().starts_with("the rule has no reforms"), "{none}");
    // What is too large says who answers it.
    let finer = BRIEF.replace("100 cm^-1", "0.001 cm^-1");
    let many: String = (0..60)
        .map(|i| {
            format!("[[clause]]\nname = \"{i}\"\n[[camera]]\nname = \"{i}\"\npreset = \"flir-a325sc\"\n")
        })
        .collect();
    for large in [finer, BRIEF.to_owned() + &many] {
        wrong(&large, "", "more than this page computes; take fewer, or ask `hadar rule`");
    }
}

/// A rule that can have a key, up to a value there.
fn rule_for(key: &str) -> String {
    let key_of_clause = key.strip_prefix("clause[0].");
    let head = key_of_clause.unwrap_or(key).split(['.', '[']).next().unwrap_or_default();
    let rule = match head {
        "bands" => {
            BRIEF.lines().filter(|line| !line.contains("cm^-1")).map(|line| format!("{line}\n")).collect()
        }
        "background" => BRIEF.to_owned() + "[background]\ntemperature = \"5 degC\"\n",
        _ => BRIEF.to_owned(),
    };
    let clause = match (key_of_clause, head) {
        (None, _) => "",
        (_, "scene") => {
            "[[clause]]\nname = \"x\"\nkind = \"depth-error\"\n[clause.scene]\nsize = [48, 64]\n[clause.stereo]\nbaseline = \"0.1 m\"\n\
             [clause.requirement]\ndepth_error = \"0.5 m\"\nshare = 0.5\n[clause.envelope]\ndistance = [\"5 m\", \"15 m\"]\n"
        }
        (_, "things") => "[[clause]]\nname = \"x\"\nkind = \"false-alarm\"\n",
        _ => "[[clause]]\nname = \"x\"\n",
    };
    rule + clause
}

/// That rule with a value at the key: one of a camera in its text, else what a reform sets, where a reform may.
fn with_file(key: &str, value: &Json) -> Option<String> {
    let rule = rule_for(key);
    if let Some(own) = key.strip_prefix("camera[0].") {
        return Some(format!("{rule}[[camera]]\nname = \"x\"\npreset = \"flir-a325sc\"\n{own} = {value}\n"));
    }
    let law = ["find", "reform", "source", "test"].iter().all(|other| !key.starts_with(other));
    let set = format!("{key} = {value}");
    law.then(|| format!("{rule}[[reform]]\nname = \"x\"\nset = [{}]\nchoice = \"a test\"\n", json!(set)))
}

/// Whether a file is there or not cannot be told from outside: no key of a rule reaches one, nor does what a reform sets.
#[test]
fn no_rule_reads_a_file() {
    let there = std::env::current_exe().unwrap().display().to_string();
    let paths = [there.as_str(), "/nowhere/at-all.csv", "../Cargo.toml", "C:\\x.csv"];
    let refused = |path: &str, body: &Json, file: &str| {
        let answered = asked(path, body);
        assert!(answered["answer"].is_null(), "{body}");
        let message = answered["error"]["message"].as_str().unwrap();
        assert!(message.contains("no files are read here"), "{body} {message}");
        message.replace(file, "PATH")
    };
    let of_text = |made: &dyn Fn(&str) -> String| {
        let said = paths.map(|file| refused("/rule", &json!({ "rule": made(file) }), file));
        assert!(said.iter().all(|one| *one == said[0]), "{said:?}");
    };
    of_text(&|file| BRIEF.replace("\"skin\"", &json!(file).to_string()));
    of_text(&|file| BRIEF.replace("\"pmma\"", &json!(file).to_string()));
    of_text(&|file| {
        BRIEF.to_owned()
            + &format!(
                "[[camera]]\nname = \"x\"\npreset = \"flir-a325sc\"\nquantum_efficiency = {}\n",
                json!(file)
            )
    });
    of_text(&|file| {
        BRIEF.to_owned() + &format!("[[clause]]\nname = \"x\"\n[clause.target]\nmaterial = {}\n", json!(file))
    });

    let root = FILES.iter().find(|kind| kind.commands.contains(&"rule")).unwrap().root;
    let mut keys = Vec::new();
    paths_of_files(root, "", &mut keys);
    let mut tried = 0;
    for (key, list) in keys {
        let said = paths.map(|file| {
            let value = if list { json!([file]) } else { json!(file) };
            let answered = asked("/rule/reforms", &json!({ "rule": with_file(&key, &value)? }));
            assert!(answered["answer"].is_null(), "{key} = {file}");
            Some(
                answered["error"]["message"]
                    .as_str()
                    .unwrap()
                    .replace(&json!(file).to_string(), "PATH")
                    .replace(file, "PATH"),
            )
        });
        // Some keys want another one beside them first.
        assert!(said.iter().all(|one| *one == said[0]), "{key}: {said:?}");
        tried += usize::from(said[0].as_ref().is_some_and(|one| one.contains("no files are read here")));
    }
    assert!(tried >= 20, "{tried}");
}

#[test]
fn strangers_are_refused() {
    for path in ["/rules", "/rules.js", "/rules.css", "/shared.js", "/rules/start"] {
        assert_eq!(get(path).0, 200, "{path}");
    }
    let host = server();
    let json = "Content-Type: application/json\r\n";
    let body = json!({ "rule": BRIEF }).to_string();
    for path in ["/rule", "/rule/reforms"] {
        assert_eq!(get(path).0, 404);
        for (headers, status) in [
            (format!("Host: {host}\r\n{json}Origin: https://evil.example\r\n"), 403),
            (format!("Host: {host}\r\n{json}Sec-Fetch-Site: cross-site\r\n"), 403),
            (format!("Host: evil.example\r\n{json}"), 403),
            (format!("Host: {host}\r\nContent-Type: text/plain\r\n"), 415),
        ] {
            let (found, answer) = post_with(path, &headers, &body);
            assert_eq!(found, status, "{headers}: {answer}");
            assert!(!answer.contains("sentence"));
        }
        for body in [json!({}), json!([]), json!({ "rule": 1 }), json!({ "rule": "", "other": 1 })] {
            assert_eq!(post(path, &body).0, 400, "{body}");
        }
        assert_eq!(post(path, &json!({ "rule": "#".repeat(300 << 10) })).0, 413);
    }
}

/// Questions that nobody waits for any more are stopped: the next one is answered within the time of a page, which the others together would exceed.
#[test]
fn a_question_that_is_given_up_gives_its_turn_back() {
    let body = json!({ "rule": WASHINGTON }).to_string();
    for _ in 0..20 {
        let mut stream = TcpStream::connect(server()).unwrap();
        let head = format!("POST /rule HTTP/1.1\r\nHost: {}\r\nContent-Type: application/json\r\n", server());
        write!(stream, "{head}Content-Length: {}\r\n\r\n{body}", body.len()).unwrap();
    }
    assert!(asked("/rule", &json!({ "rule": FEVER }))["answer"].is_object());
}
