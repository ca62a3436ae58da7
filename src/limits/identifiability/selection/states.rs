//! The best few of many readings against states of the alternatives that were found.
//!
//! A reading w (a filter before the camera) tells the target from a state s of an alternative by the square
//! D_ws = (√(N_w + σ_w²) − √(N′_ws + σ_w²))², and a choice S of readings by Σ_{w∈S} D_ws + c_s, where c_s is what prior knowledge says
//! against the state. The nearest state of all is at least as near as the nearest of some:
//!
//! d²(S) ≤ u(S) = min_s [Σ_{w∈S} D_ws + c_s].
//!
//! [`States::best`] gives the choice of at most k readings with the greatest u, so that no such choice has a greater d² (a cutting-plane
//! bound; J. E. Kelley, J. SIAM 8, 703 (1960)). It goes through choices depth first and leaves out every start of one which, with the
//! k best of the readings that are left for each state by itself, does not reach what is known already.
//!
//! Assumption: the noises of two readings have nothing in common.

/// States that were found, each with the squares by which every reading tells it from the target.
#[derive(Debug, Clone, Default)]
pub struct States {
    readings: usize,
    /// One row of squares a state.
    squares: Vec<Vec<f64>>,
    /// What prior knowledge says against each.
    fixed: Vec<f64>,
    /// The first reading that may stand beside each one and behind it.
    next: Vec<usize>,
}

/// A choice of readings, and the least square by which the states that were found are told by it.
#[derive(Debug, Clone, PartialEq)]
pub struct Chosen {
    /// Indices of the readings, rising.
    pub readings: Vec<usize>,
    /// No choice of as many, but those that were left out, has a greater d².
    pub square: f64,
}

impl States {
    /// No states yet, of so many readings, any of which may stand beside any other.
    #[must_use]
    pub fn of(readings: usize) -> Self {
        Self { readings, next: (1..=readings).collect(), ..Self::default() }
    }

    /// The same where beside reading i and behind it only those from `next[i]` on may stand.
    #[must_use]
    pub fn with_next(mut self, next: Vec<usize>) -> Self {
        for (i, (own, next)) in self.next.iter_mut().zip(next).enumerate() {
            *own = next.max(i + 1);
        }
        self
    }

    /// One state more; squares that are missing or no numbers count as infinite, which cuts nothing.
    pub fn add(&mut self, squares: &[f64], fixed: f64) {
        let at =
            |w: usize| squares.get(w).copied().filter(|square| !square.is_nan()).unwrap_or(f64::INFINITY);
        self.squares.push((0..self.readings).map(at).collect());
        self.fixed.push(if fixed.is_nan() { f64::INFINITY } else { fixed });
    }

    /// Number of states.
    #[must_use]
    pub fn len(&self) -> usize {
        self.squares.len()
    }

    /// Whether there is no state yet.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.squares.is_empty()
    }

    /// The least square with the readings of a choice: d² is no greater.
    #[must_use]
    pub fn square(&self, choice: &[usize]) -> f64 {
        let of =
            |(squares, fixed): (&Vec<f64>, &f64)| fixed + choice.iter().map(|w| squares[*w]).sum::<f64>();
        self.squares.iter().zip(&self.fixed).map(of).fold(f64::INFINITY, f64::min)
    }

    /// The state that is nearest by the readings of a choice.
    #[must_use]
    pub fn nearest(&self, choice: &[usize]) -> Option<usize> {
        let of =
            |place: &usize| self.fixed[*place] + choice.iter().map(|w| self.squares[*place][*w]).sum::<f64>();
        (0..self.len()).min_by(|a, b| of(a).total_cmp(&of(b)))
    }

    /// The least square with all readings side by side, whether they may stand so or not.
    #[must_use]
    pub fn square_of_all(&self) -> f64 {
        self.square(&(0..self.readings).collect::<Vec<_>>())
    }

    /// The choice of at most k readings with the greatest least square, of those that are not among `without`; the first one in the order
    /// of their readings where several have it. `None` where there is none left.
    ///
    /// ```
    /// use hadar::identifiability::selection::States;
    /// let mut states = States::of(3);
    /// states.add(&[4.0, 0.0, 1.0], 0.0);
    /// states.add(&[0.0, 4.0, 1.0], 0.0);
    /// assert_eq!(states.best(1, &[]).unwrap().readings, [2]);
    /// let two = states.best(2, &[]).unwrap();
    /// assert_eq!((two.readings, two.square), (vec![0, 1], 4.0));
    /// assert_eq!(states.best(2, &[vec![0, 1]]).unwrap().square, 1.0);
    /// ```
    #[must_use]
    pub fn best(&self, k: usize, without: &[Vec<usize>]) -> Option<Chosen> {
        let mut search =
            Search { states: self, k, without, most: self.most_behind(k), chosen: Vec::new(), best: None };
        search.extend(0, &self.fixed);
        search.best
    }

    /// For each reading, count and state the sum of the largest squares of so many readings from this one on.
    fn most_behind(&self, k: usize) -> Vec<Vec<Vec<f64>>> {
        let mut most = vec![vec![vec![0.0; self.len()]; k + 1]; self.readings + 1];
        for (s, squares) in self.squares.iter().enumerate() {
            let mut largest: Vec<f64> = Vec::new();
            for w in (0..self.readings).rev() {
                let place = largest.partition_point(|other| *other >= squares[w]);
                largest.insert(place, squares[w]);
                largest.truncate(k);
                let mut sum = 0.0;
                for (count, of_state) in most[w].iter_mut().enumerate().skip(1) {
                    sum += largest.get(count - 1).copied().unwrap_or(0.0);
                    of_state[s] = sum;
                }
            }
        }
        most
    }
}

struct Search<'a> {
    states: &'a States,
    k: usize,
    without: &'a [Vec<usize>],
    most: Vec<Vec<Vec<f64>>>,
    chosen: Vec<usize>,
    best: Option<Chosen>,
}

impl Search<'_> {
    /// All choices that begin with those chosen, whose squares so far are `sums`, and go on from a reading.
    fn extend(&mut self, from: usize, sums: &[f64]) {
        crate::stop::check();
        let readings = self.states.readings;
        // More readings tell no less: a choice that can be extended is judged when it is.
        if self.chosen.len() == self.k || from >= readings {
            self.judge(sums);
            return;
        }
        let mut sums_with = vec![0.0; sums.len()];
        for w in from..readings {
            let left = self.k - self.chosen.len();
            let at_most = sums.iter().zip(&self.most[w][left]).map(|(sum, most)| sum + most);
            if self.best.as_ref().is_some_and(|best| at_most.fold(f64::INFINITY, f64::min) <= best.square) {
                // Those behind it have no more.
                break;
            }
            for ((with, sum), squares) in sums_with.iter_mut().zip(sums).zip(&self.states.squares) {
                *with = sum + squares[w];
            }
            self.chosen.push(w);
            self.extend(self.states.next[w], &sums_with);
            self.chosen.pop();
        }
        // What was left out of longer choices may be good enough without more.
        if !self.without.is_empty() && !self.chosen.is_empty() {
            self.judge(sums);
        }
    }

    fn judge(&mut self, sums: &[f64]) {
        if self.chosen.is_empty() || self.without.contains(&self.chosen) {
            return;
        }
        let square = sums.iter().copied().fold(f64::INFINITY, f64::min);
        if self.best.as_ref().is_none_or(|best| square > best.square) {
            self.best = Some(Chosen { readings: self.chosen.clone(), square });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::generator;
    use rand::RngExt;

    /// All choices one by one.
    fn brute(states: &States, k: usize, without: &[Vec<usize>]) -> Option<Chosen> {
        let mut best: Option<Chosen> = None;
        for set in 1u32..1 << states.readings {
            let readings: Vec<usize> = (0..states.readings).filter(|w| set >> w & 1 == 1).collect();
            let apart = readings.windows(2).all(|two| states.next[two[0]] <= two[1]);
            if readings.len() > k || !apart || without.contains(&readings) {
                continue;
            }
            let square = states.square(&readings);
            if best.as_ref().is_none_or(|best| square > best.square * (1.0 + 1e-12)) {
                best = Some(Chosen { readings, square });
            }
        }
        best
    }

    #[test]
    fn no_choice_is_better_than_the_one_found() {
        let mut random = generator(7, 0);
        let mut uniform = || random.random::<f64>();
        for trial in 0..200 {
            let readings = 3 + trial % 8;
            let mut states = States::of(readings);
            if trial % 3 == 0 {
                states = states.with_next((0..readings).map(|i| i + 1 + trial % 2).collect());
            }
            for _ in 0..1 + trial % 6 {
                let squares: Vec<f64> = (0..readings).map(|_| uniform().powi(3)).collect();
                states.add(&squares, 0.1 * uniform());
            }
            let mut without = Vec::new();
            for k in 1..=4 {
                let (found, all) = (states.best(k, &without), brute(&states, k, &without));
                let (found, all) = (found.unwrap(), all.unwrap());
                assert!((found.square / all.square - 1.0).abs() < 1e-12, "{found:?} {all:?}");
                assert!((states.square(&found.readings) / found.square - 1.0).abs() < 1e-12);
                without.push(found.readings);
            }
        }
    }

    #[test]
    fn a_choice_is_none_where_nothing_is_left() {
        let mut states = States::of(1);
        states.add(&[1.0], 0.0);
        assert!(states.best(1, &[vec![0]]).is_none() && States::of(0).best(2, &[]).is_none());
        // What is no number cuts nothing.
        states.add(&[f64::NAN], f64::NAN);
        assert_eq!(states.best(3, &[]).unwrap().square, 1.0);
    }
}
