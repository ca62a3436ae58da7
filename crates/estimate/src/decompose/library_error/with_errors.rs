//! The materials of a pixel compared with errors of the library.

use super::*;
use crate::decompose::pixel::{Room, Spared, Task};

impl Task {
    /// Fits all materials with errors of the library; deviances with the handicap of the prior.
    pub(in crate::decompose) fn fit_with_errors(
        &self,
        errors: &Errors,
        room: &mut Room,
        spared: &mut Spared,
    ) {
        let model = &self.model;
        let Room { sums, workplace, screened, counts, shifted, bounds, fits, .. } = room;
        let nothing = State::at(model.range_k[0]);
        let mut starts = [nothing; MOST_STARTS];
        bounds.clear();
        bounds.extend((0..self.kinds.len()).map(|kind| (0.0, kind)));
        if let (Some(screen), Some(seen)) = (&self.screen, screened.as_mut()) {
            screen.look(counts, shifted, seen);
            bounds.iter_mut().for_each(|(bound, kind)| *bound = screen.outside(*kind, seen));
            screen.nearest_first(bounds, seen);
        }
        let nothing = Fit { state: nothing, deviance: f64::INFINITY, chi_square: f64::INFINITY };
        fits.clear();
        fits.extend((0..self.kinds.len()).map(|kind| (kind, nothing)));
        workplace.floors.clear();
        workplace.floors.resize(self.kinds.len(), f64::INFINITY);
        // The nearest one first: what it costs at its best share excludes most of the others.
        let (nearest, others) = bounds.split_at(1);
        let (mut beside, mut reach) = (f64::INFINITY, f64::INFINITY);
        for some in [nearest, others] {
            for (_, kind) in some {
                if let (Some(screen), Some(seen)) = (&self.screen, screened.as_mut())
                    && (screen.is_beyond(*kind, reach, seen) || screen.is_beyond_within(*kind, reach, seen))
                {
                    spared.excluded += 1;
                    continue;
                }
                spared.fitted += 1;
                let mut count = match (&self.screen, screened.as_mut()) {
                    (Some(screen), Some(seen)) => screen.starts(model, *kind, seen, &mut starts),
                    _ => 0,
                };
                if count == 0 {
                    starts[0] = self.scan(*kind, shifted, sums, spared);
                    count = 1;
                }
                let beside = beside + self.beyond(*kind);
                let asked = |start: &State| self.asked(*kind, *start, [beside, f64::INFINITY]);
                workplace.queue.extend(starts[..count].iter().map(asked));
            }
            spared.looks += workplace.run(model, errors, shifted, sums) as u64;
            workplace.collect(&self.handicap, fits);
            let (best, is_fitting) = self.best_of(errors, fits);
            let within = if self.skip { best + BESIDE } else { f64::INFINITY };
            let counts =
                |kind: usize| workplace.floors[kind] <= within + self.handicap[kind] + self.beyond(kind);
            for (_, kind) in some.iter().filter(|(_, kind)| counts(*kind)) {
                let (_, fit) = fits[*kind];
                let worse = fit.deviance - self.handicap[*kind] + WORSE;
                let asked = self.asked(*kind, fit.state, [f64::INFINITY, worse]);
                workplace.queue.extend(LADDER.map(|share| Asked { share, ..asked }));
            }
            spared.looks += workplace.run(model, errors, shifted, sums) as u64;
            workplace.collect(&self.handicap, fits);
            // One that does not fit may cost less than one that does and count for no more.
            if self.skip && is_fitting {
                beside = self.best_of(errors, fits).0 + BESIDE;
                if let (Some(screen), Some(seen)) = (&self.screen, screened.as_ref()) {
                    let farthest = beside + self.beyond_any();
                    let most = screen.most_chi_square(farthest - logarithm_of_all(shifted), shifted);
                    reach = screen.reach(most, seen);
                }
            }
        }
        spared.equal += self.alike.iter().map(|alike| *alike as u64 - 1).sum::<u64>();
        let (least, _) = self.best_of(errors, fits);
        // With errors of the library a material that does not fit may cost less than one that does, as ln det C of what is
        // scattered is smaller: it never counts for more.
        fits.iter_mut().for_each(|(_, fit)| fit.deviance = fit.deviance.max(least));
    }

    fn asked(&self, kind: usize, start: State, [beside, worse]: [f64; 2]) -> Asked {
        Asked { kind, m: self.kinds[kind], share: 1.0, start, short: COMPARED, beside, worse }
    }

    /// The least cost of those that fit, or of all where none does, and whether one does.
    fn best_of(&self, errors: &Errors, fits: &[(usize, Fit)]) -> (f64, bool) {
        let (mut fitting, mut all) = (f64::INFINITY, f64::INFINITY);
        for (_, fit) in fits {
            all = all.min(fit.deviance);
            let most = errors.misfits.get(self.freedom(&fit.state)).copied().unwrap_or(f64::INFINITY);
            if fit.deviance < fitting && fit.chi_square <= most {
                fitting = fit.deviance;
            }
        }
        if fitting.is_finite() { (fitting, true) } else { (all, false) }
    }
}
