//! What is said of simulated decisions between materials whose states are drawn from priors.

use crate::text::footing::{assumptions, warnings};
use crate::text::numbers::significant;
use crate::words::probability::percent;
use hadar_study::{AveragePoint, AverageSimulation, PhotonLaw, Study};
use std::fmt::Write as _;

/// The answer in a sentence for each number of photons, and what it rests on.
#[must_use]
pub fn text(result: &AverageSimulation, study: &Study) -> String {
    let mut out = String::new();
    for point in &result.averages {
        let _ = writeln!(out, "{}", sentence(point, result));
    }
    let trials = result.averages.first().map_or(0, |point| point.decisions.trials);
    let states = result.averages.first().map_or(0, |point| point.decisions.states);
    let changed =
        result.averages.iter().map(|point| point.decisions.changed_by_half_the_states).fold(0.0, f64::max);
    let law = match result.photon_law {
        PhotonLaw::Poisson => "photons counted one by one (Poisson)",
        PhotonLaw::NegativeBinomial => "bunched photons of thermal light (negative binomial)",
        PhotonLaw::FixedTotal => "as many photons in every spectrum (multinomial)",
    };
    let noise = if result.camera_noise { ", and the camera's electronic noise" } else { "" };
    let generator = result.averages.first().map_or("", |point| point.decisions.generator);
    let _ = writeln!(
        out,
        "\nDrawn: {trials} decisions, half of them with each material, every one with a state out of its prior;\n  {law}{noise}; seed {}, {generator}",
        result.seed
    );
    let _ = writeln!(
        out,
        "Test: the ratio of the two likelihoods, each averaged over {states} states of the prior; counts are taken to be {};\n  half as many states would change {} of the decisions\n",
        result.judged_as,
        percent(changed)
    );
    out.push_str(&assumptions(
        study,
        "two equally likely materials, the state of either drawn from the priors",
    ));
    out.push_str(&warnings(&result.warnings));
    out
}

fn sentence(point: &AveragePoint, result: &AverageSimulation) -> String {
    let (target, alternative) = (&result.target, &result.alternative);
    let bracket = match point.probability_lower {
        Some(lower) => {
            format!("the best test is right in {} to {}", percent(lower), percent(point.probability_upper))
        }
        None => format!("no test is right in more than {}", percent(point.probability_upper)),
    };
    let holds = if point.bracket_holds { "" } else { "The limit does not hold: " };
    format!(
        "{holds}With {} photons the Bayes test distinguishes {target} from {alternative} in {} of the cases ({} to {}), averaged over the priors; {bracket}.",
        significant(point.photons, 3),
        percent(point.decisions.probability),
        percent(point.decisions.interval.low),
        percent(point.decisions.interval.high)
    )
}
