//! Numerical stress: generated cases over extremes, each judged by the reference path.
//!
//! A case must not panic; must not give a NaN or an infinity that is not declared; must say the right status; may be an
//! error only where the input is outside what is declared; and its relative error must stay within the bound that the
//! answer brings with it (or that its documentation gives). Case i depends on the seed and i alone, so that a failure
//! is repeated by its number.
//!
//! What is declared, beside each answer's own estimate:
//!
//! * B is exactly 0 where x > 708, and a scene with a band whose signal is above 0 but below 1e-150, or with an
//!   unknown that changes signals by less than 1e-250 per unit, must only give finite numbers;
//! * distances below 1e-200 need not keep their digits;
//! * B, its slope and differences are good to 2e-16·(10 + x), probabilities to 1e-15·(10 + d²) and photon radiances to 16
//!   half-ulps;
//! * a distance below 16 ε of that with no nuisance is nothing, and so is one at equilibrium to the last bit of ΣV;
//! * a nuisance of which less than 1e-130 is left of what it is made of depends on the others exactly. All others count.

pub(super) mod draw;
mod findings;
mod local;
mod many;
mod nearest;
mod planck;
mod probability;
mod report;
mod requirement;
mod scene;
mod there_and_back;

pub use findings::{Family, Point};
pub use report::{Failure, FamilyReport, StressReport};

use self::draw::Draw;
use self::findings::Findings;
use self::report::Tallies;
use hadar::error::{Result, check};
use hadar::stop::unless_it_panics;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Cases that are done one after the other.
const TOGETHER: u64 = 50;

/// What to run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct StressPlan {
    /// Number of cases that are generated.
    pub cases: u64,
    /// Seed that determines which cases are generated.
    pub seed: u64,
}

/// Runs the suite, telling `progress` how many cases of how many are done.
///
/// # Errors
/// A plan without cases.
pub fn stress(plan: &StressPlan, progress: &(dyn Fn(u64, u64) + Sync)) -> Result<StressReport> {
    check::positive("stress cases", plan.cases as f64, "")?;
    let done = AtomicU64::new(0);
    let run = |block: u64| {
        let mut tallies = Tallies::default();
        let first = block * TOGETHER;
        let count = TOGETHER.min(plan.cases - first);
        for case in (0..count).map(|case| first + case) {
            tallies.add(case, Family::of(case), caught(|| one(plan.seed, case)));
        }
        progress(done.fetch_add(count, Ordering::Relaxed) + count, plan.cases);
        tallies
    };
    let blocks = (0..plan.cases.div_ceil(TOGETHER)).into_par_iter();
    let tallies = blocks.map(run).reduce(Tallies::default, Tallies::then);
    Ok(tallies.report(plan.cases, plan.seed))
}

/// What a case finds; a panic of it is a fault.
fn caught(case: impl FnOnce() -> Findings) -> Findings {
    let panicked = || Findings { faults: vec!["panic".into()], ..Findings::default() };
    unless_it_panics(case).unwrap_or_else(panicked)
}

fn one(seed: u64, case: u64) -> Findings {
    let mut draw = Draw::new(seed, case);
    let mut found = Findings::default();
    let outcome = match Family::of(case) {
        Family::Planck => {
            planck::judge(&mut draw, &mut found);
            Ok(())
        }
        Family::Local => local::judge(&mut draw, &mut found, scene::Hardship::Ranges, false),
        Family::Noise => local::judge(&mut draw, &mut found, scene::Hardship::Ranges, true),
        Family::Equilibrium => local::near_equilibrium(&mut draw, &mut found, case),
        Family::Dependence => {
            let noise = draw.chance(0.3);
            local::judge(&mut draw, &mut found, scene::Hardship::Dependence, noise)
        }
        Family::ManyBands => many::bands(&mut draw, &mut found),
        Family::Matrix => many::materials(&mut draw, &mut found),
        Family::Nearest => nearest::judge(&mut draw, &mut found),
        Family::ThereAndBack => there_and_back::judge(&mut draw, &mut found),
        Family::Detection => {
            probability::detection(&mut draw, &mut found);
            Ok(())
        }
        Family::Exact => probability::exact(&mut draw, &mut found),
        Family::Requirement => requirement::judge(&mut draw, &mut found),
    };
    if let Err(error) = outcome {
        found.faults.push(format!("an error where the input is in order: {error}"));
    }
    found
}

#[cfg(test)]
mod tests;
