//! What is said of decisions that are averaged over priors.

use crate::text::numbers::significant;
use crate::words::probability::percent;
use hadar_study::{PriorAverage, Study};
use std::fmt::Write as _;

/// How many photons it takes, how often a camera is right, and what the two numbers rest on.
pub(super) fn text(average: &PriorAverage, target: &str, reliability: &str, study: &Study) -> String {
    let mut out = String::new();
    let alternative = &average.alternative;
    if let (Some(upper), Some(photons)) = (average.probability_upper, average.photons) {
        let camera = format!("With the camera ({} photons)", significant(photons, 3));
        let _ = match average.probability_lower {
            Some(lower) => writeln!(
                out,
                "{camera} the best test distinguishes {target} from {alternative} in {} to {} of the cases, averaged over the priors of both.",
                percent(lower),
                percent(upper)
            ),
            None => writeln!(
                out,
                "{camera} no test distinguishes {target} from {alternative} in more than {} of the cases, averaged over the priors of both.",
                percent(upper)
            ),
        };
    }
    let photons = |count: f64| significant(count, 3);
    let needed = match (average.photons_required_lower, average.photons_required_upper) {
        (None, _) => "no number of photons suffices".to_owned(),
        (Some(lower), Some(upper)) => {
            format!("it takes between {} and {} photons", photons(lower), photons(upper))
        }
        (Some(lower), None) => {
            format!("it takes at least {} photons; how many suffice is not known", photons(lower))
        }
    };
    let _ = writeln!(
        out,
        "Averaged over the priors of both, to distinguish {target} from {alternative} with a probability of {reliability} {needed}, by shot noise alone.",
    );
    if !average.without_prior.is_empty() {
        let _ = writeln!(
            out,
            "  No prior is stated for: {}. There the alternative looks as much like the target as it can, and what a test reaches is not bounded.",
            average.without_prior.join(", ").replace('_', " ")
        );
    }
    let hybrid = average.photons_required_hybrid_bound;
    let hybrid = hybrid.map_or_else(|| "no number of".into(), photons);
    let _ = writeln!(
        out,
        "  Hybrid Cramer-Rao bound of estimates of the material fraction, which does not limit decisions: {hybrid} photons.{}",
        if study.camera().is_none() { "" } else { " `hadar simulate --average` tests the camera's figures." }
    );
    out
}
