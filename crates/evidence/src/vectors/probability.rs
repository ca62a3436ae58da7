//! From a statistical distance to probabilities and bits, also where they are next to nothing; and exact errors of few counts.

use super::answer::{Answer, Vector, reach};
use super::json::Json;
use super::solve::crossing;
use super::topic::Topic;
use crate::reference::Extended;
use crate::reference::probability::{information_bits, mutual_information_bits, normal_tail, poisson_error};

const DISTANCES: [(&str, &str, f64); 10] = [
    ("nothing", "no distance: a guess", 0.0),
    ("next-to-nothing", "bits far below 1: log2(2P) of a rounded P is 0", 1e-12),
    ("tiny", "mutual information is of second order", 1e-6),
    ("small", "an ordinary value", 0.1),
    ("criterion", "the paper's criterion: 84.13 %", 1.0),
    ("two", "an ordinary value", 2.0),
    ("five", "a miss in three million", 5.0),
    ("ten", "1 - P is 0: the miss probability has to be an erfc", 10.0),
    ("twenty", "3e-89", 20.0),
    ("thirty-seven", "6e-300, among the last that a double holds", 37.0),
];

/// What is near the least of normal doubles has lost digits.
const LEAST: f64 = 1e-306;

/// Mean counts of two states.
const COUNTS: [(&str, &str, &[f64], &[f64]); 4] = [
    ("counts-of-one-band", "a threshold between 2 and 3 counts", &[2.0], &[3.0]),
    ("counts-of-two-bands", "the normal law is off by a tenth", &[3.0, 7.5], &[4.25, 6.0]),
    ("counts-of-a-dark-band", "a band that is dark in one of the states", &[0.0, 4.0], &[2.0, 4.0]),
    ("counts-of-many", "hundreds of counts, still not the normal law", &[300.0], &[350.5]),
];

/// Probabilities that are doubles.
const PROBABILITIES: [(&str, &str, f64); 4] = [
    ("reliability-nine-tenths", "an ordinary requirement", 0.9),
    ("reliability-near-a-guess", "P = 1/2 + 2^-30", 0.5 + 1.0 / (1_u64 << 30) as f64),
    ("reliability-high", "P = 1 - 1e-9 as the double that it is", 0.999_999_999),
    ("reliability-highest", "P = 1 - 2^-50", 1.0 - 1.0 / (1_u64 << 50) as f64),
];

pub(super) fn topic() -> Topic {
    let of_distances = DISTANCES.iter().map(|(id, about, d)| of_distance(id, about, *d));
    let of_counts = COUNTS.iter().map(|(id, about, means, others)| of_counts(id, about, [means, others]));
    let backwards = PROBABILITIES.iter().map(|(id, about, p)| of_probability(id, about, *p));
    Topic {
        name: "probability",
        title: "Probabilities and information of a statistical distance, and exact errors of few counts",
        catches: "erf of d for erf of d/sqrt 2, natural logarithms for bits, mutual information for log2(2P) or the other way round, a \
                  bracket with rho for rho^2; 1 - P where erfc is due, P where log1p is; the normal law where counts are few",
        vectors: of_distances.chain(backwards).chain(of_counts).collect(),
        files: Vec::new(),
    }
}

/// What a statistical distance comes to, by name.
pub(super) fn of(d: f64) -> [(&'static str, Extended); 6] {
    let half = Extended::from(0.5);
    let rho = (-(Extended::from(d).square() * &half)).exp();
    // 1 − √(1 − ρ²) = ρ²/(1 + √(1 − ρ²)).
    let lower = &half * rho.square() / (Extended::one() + (Extended::one() - rho.square()).sqrt());
    [
        ("detection_probability", normal_tail(-d)),
        ("miss_probability", normal_tail(d)),
        ("information_bits", information_bits(d)),
        ("mutual_information_bits", mutual_information_bits(d)),
        ("error_lower", lower),
        ("error_upper", half * rho),
    ]
}

fn of_distance(id: &'static str, about: &'static str, d: f64) -> Vector {
    // A relative error of d, or of d²/2, is one of d² in the tail.
    let answers = of(d).map(|(name, value)| (name, Answer::one(&value, reach(d * d)).or_within(LEAST)));
    Vector::new(id, about, Json::object([("statistical_distance", d.into())]), answers)
}

fn of_counts(id: &'static str, about: &'static str, [means, others]: [&[f64]; 2]) -> Vector {
    let inputs = Json::object([("mean_counts", means.into()), ("other_mean_counts", others.into())]);
    let error = Answer::one(&poisson_error(means, others), 1e-12);
    Vector::new(id, about, inputs, [("error_of_best_test", error)])
}

/// The distance at which a probability is reached, to the last bit of a double.
pub(super) fn needed_for(probability: f64) -> f64 {
    let missed = Extended::one() - Extended::from(probability);
    crossing([0.0, 40.0], |d| normal_tail(d) <= missed)
}

fn of_probability(id: &'static str, about: &'static str, probability: f64) -> Vector {
    let inputs = Json::object([("detection_probability", probability.into())]);
    let distance = Answer::double(needed_for(probability), 1e-12);
    Vector::new(id, about, inputs, [("statistical_distance", distance)])
}
