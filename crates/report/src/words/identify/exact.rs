//! Simulated decisions beside their limits.

use crate::text::numbers::{shortened, significant};
use hadar_study::{Exact, ExactPair, Study};
use std::fmt::Write as _;

/// Probabilities from here on are 1 to three digits.
const CERTAIN: f64 = 0.9995;

/// The simulated decisions beside their limits.
pub(super) fn exact(found: &Exact, study: &Study) -> String {
    let percent = 100.0 * found.level;
    let normal = found.normal_error.map_or_else(String::new, |error| {
        format!(", distribution function of a band off by at most {}", significant(error, 1))
    });
    let mut out = format!(
        "Maximum-likelihood decision, states unknown, {} counts{normal} (seed {}, {percent:.0} % intervals)\n",
        found.statistics, found.seed
    );
    let short = shortened(found.pairs.iter().map(|pair| pair.alternative.as_str()));
    let width = short.width().max(11);
    let _ = writeln!(
        out,
        "  {:<width$}  {:>9}  {:>18}  {:>11}  {:>11}  {:>9}  {:>17}",
        "alternative",
        "photons",
        "correct decisions",
        "limit Phi(d)",
        "two-sided",
        "local",
        "rigorous limits"
    );
    let shown = |pair: &&ExactPair| pair.limit < CERTAIN || pair.balanced < CERTAIN;
    let certain = found.pairs.iter().filter(|pair| !shown(pair)).count();
    for pair in found.pairs.iter().filter(shown) {
        let _ = write!(
            out,
            "  {:<width$}  {:>9}  {:>9.3} +- {:.3}    {:>12.3}  {:>11.3}  {:>9.3}  {:>8.3} to {:.3}",
            short.of(&pair.alternative),
            significant(pair.photons, 3),
            pair.balanced,
            pair.balanced_interval.half_width(),
            pair.limit,
            pair.two_sided,
            pair.local,
            1.0 - pair.error_upper,
            1.0 - pair.error_lower
        );
        if let Some(lattice) = &pair.lattice {
            let p = lattice.probabilities.first().copied().unwrap_or(f64::NAN);
            let _ = write!(out, "  Algorithm 1: {p:.3}");
        }
        out.push('\n');
    }
    if certain > 0 {
        let _ =
            writeln!(out, "  {certain} more, with limit and correct decisions both 1.000 to three digits");
    }
    if let Some(library) = &found.library {
        let _ = writeln!(
            out,
            "  among all at once {} is recognised in {:.3} +- {:.3} of {} trials{}",
            study.target().name,
            library.probability,
            library.interval.half_width(),
            library.trials,
            if library.union_bound_known_states > 0.0 {
                format!(
                    "; if all states were known, in at least {:.3} (union bound)",
                    library.union_bound_known_states
                )
            } else {
                String::new()
            }
        );
    }
    out.push_str(
        "  correct decisions: averaged over the target's state and the alternative's nearest; the rigorous limits are those of\n  the best test between these two known states, which no test exceeds\n",
    );
    if found.pairs.iter().any(|pair| pair.lattice.is_some()) {
        let target = &study.target().name;
        let _ = writeln!(
            out,
            "  Algorithm 1: share of correct decisions with {target} true (not averaged), all states on a mesh"
        );
    }
    out.push('\n');
    out
}
