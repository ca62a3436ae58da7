//! The vectors in the repository: that the product meets every one of them, that they agree with references of others, and that
//! what they are there to catch is caught.

mod fast;
mod judge;
mod naive;
mod read;

use judge::{Found, Verdict, share};
use read::vectors;
use serde_json::Value;

const TOPICS: [&str; 9] =
    ["planck", "signal", "counts", "local", "nearest", "probability", "requirement", "stop", "identify"];

/// The fast path is within every tolerance, and by far: in a fifth of it, as the README says.
#[test]
fn the_product_meets_every_vector() {
    let mut wrong = Vec::new();
    for topic in TOPICS {
        let mut verdict = Verdict::default();
        for vector in vectors(topic) {
            verdict.judge(&vector, &fast::answers(topic, &vector));
        }
        let Verdict { answers, wrong: own, worst: (share, place) } = verdict;
        assert!(share < 0.2 || !own.is_empty(), "{topic} {place}: {share}");
        println!("{topic}: {answers} answers, at most {share:.2e} of what is allowed ({place})");
        wrong.extend(own.into_iter().map(|answer| format!("{topic} {answer}")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Whatever is wrong by a per cent is told, unless it is nothing.
#[test]
fn a_per_cent_is_told_everywhere() {
    let scaled = |digits: &Value| 1.01 * digits.as_str().unwrap().parse::<f64>().unwrap();
    let mut numbers = 0;
    for (topic, vector) in TOPICS.iter().flat_map(|topic| vectors(topic).into_iter().map(move |v| (topic, v)))
    {
        for (name, answer) in vector["answers"].as_object().unwrap() {
            let value = &answer["value"];
            let largest = match value {
                Value::String(word) if word.parse::<f64>().is_err() => continue,
                Value::Array(values) => values.iter().map(scaled).fold(0.0, |a, b| f64::max(a, b.abs())),
                Value::String(_) => scaled(value).abs(),
                _ => continue,
            };
            let found = match value {
                Value::Array(values) => Found::Numbers(values.iter().map(scaled).collect()),
                value => Found::Number(scaled(value)),
            };
            let nothing = largest <= 1.01 * answer["absolute_tolerance"].as_f64().unwrap_or(0.0);
            assert!(nothing || share(&found, answer) > 100.0, "{topic} {}: {name}", vector["id"]);
            numbers += usize::from(!nothing);
        }
    }
    assert!(numbers > 380, "{numbers}");
}

/// Answers that another program has given to 30 digits, for the very same doubles: 24 of theirs are ours.
#[test]
fn digits_are_those_of_other_references() {
    let agree = |answer: &Value, digits: &str| {
        use hadar_evidence::reference::Extended;
        let [ours, theirs] = [answer["value"].as_str().unwrap(), digits].map(Extended::parse);
        let error = ours.relative_error_to(&theirs);
        assert!(error < 1e-24, "{ours:?} {digits}");
    };
    let row = |rows: &[Vec<String>], key: &[f64]| {
        let is = |cells: &&Vec<String>| key.iter().zip(*cells).all(|(key, cell)| cell.parse() == Ok(*key));
        rows.iter().find(is).cloned()
    };
    let (mut radiances, mut probabilities) = (0, 0);
    if let Some(rows) = hadar_testing::reference_rows("planck.csv") {
        for vector in vectors("planck") {
            let key = ["wavenumber_cm1", "temperature_k"].map(|key| read::number(&vector["inputs"][key]));
            let Some(cells) = row(&rows, &key) else { continue };
            agree(&vector["answers"]["photon_radiance_per_s_m2_sr_cm1"], &cells[2]);
            agree(&vector["answers"]["photon_radiance_slope_per_s_m2_sr_cm1_k"], &cells[3]);
            radiances += 1;
        }
        assert!(radiances >= 4, "{radiances}");
    }
    if let Some(rows) = hadar_testing::reference_rows("detection.csv") {
        for vector in vectors("probability") {
            let Some(distance) = vector["inputs"]["statistical_distance"].as_f64() else { continue };
            let Some(cells) = row(&rows, &[distance]) else { continue };
            let names = ["detection_probability", "miss_probability", "information_bits"];
            names.iter().zip(&cells[1..]).for_each(|(name, digits)| agree(&vector["answers"][name], digits));
            probabilities += 1;
        }
        assert!(probabilities >= 8, "{probabilities}");
    }
}
