//! The maximum-likelihood decision among materials whose states are not known, by Monte Carlo.
//!
//! Counts are drawn about the mean spectrum of a true material in a true state; to every candidate material its own free
//! state is fitted (`likelihood`), and the material of the largest likelihood is the answer. The share of right
//! answers is an estimate of what such a test achieves, with its confidence interval (`sequential`).
//!
//! Averaged over the target's state and the nearest state of an alternative ([`DecisionScene::balanced`]) it is what the
//! nearest distance d limits: no test is right more often than Φ(d) at large N, or than 1 − ½(1 − √(1 − ρ²)),
//! ρ = exp(−d²/2), at any N (Poisson). The test between two known states ([`DecisionScene::known_states`]) reaches the
//! limit; for one class alone there is none.
//!
//! Fits start from the truth and from all minima of the noiseless distance within the reach of the noise: a minimum at
//! distance d′ beats one at d only if the noise is beyond d′ − d of its deviations in one given direction. (Of 6000
//! fits in random scenes of 0.7 to 5 deviations, 2 ended below those from a lattice of 72 starts, by 0.07 in ln L, and 7
//! more, by up to 0.5, where gain is unknown too and the surface colder than 90 K.) A
//! candidate whose nearest state is farther than [`OUT_OF_REACH`] is not fitted: the likelihood of a state at
//! distance d beats that of the truth with probability at most exp(−d²/2) (Poisson; Gaussian at large N).
//!
//! Source: design of the project; Algorithm 1 of the paper maximises over a lattice of states instead.

mod trials;

use self::trials::{Test, Trials, run};
use super::classifier::{BestFits, Candidate, LikelihoodRatio};
use super::draws::{Draws, GENERATOR};
use super::sequential::{Interval, Plan};
use hadar::error::{Error, Result, check};
use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::detection;
use hadar::identifiability::likelihood::MaximumLikelihood;
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::planck;
use hadar::scene::{State, Surroundings, check_emissivity};
use hadar::spectrum::Bands;
use hadar::statistics::Statistics;

/// Minima this much farther than the nearest one are no starts.
const REACH: f64 = 6.0;
/// Relative difference of states below which fits start from one of them only.
const ALIKE: f64 = 1e-6;
/// Halvings of the range of ln T that tell where a surface begins to emit.
const BISECTIONS: usize = 12;
/// A candidate is not fitted beyond this statistical distance.
pub const OUT_OF_REACH: f64 = 9.0;

/// Everything around a decision that does not depend on the materials.
///
/// ```
/// use hadar::fisher::{Nuisance, Unknowns};
/// use hadar::identifiability::nearest::StateRange;
/// use hadar::scene::{EnvironmentObject, Surroundings};
/// use hadar_simulate::decision::DecisionScene;
/// use hadar_simulate::sequential::Plan;
/// use hadar::spectrum::Bands;
/// use hadar::statistics::Statistics;
///
/// let bands = Bands::uniform(720.0, 1250.0, 53.0)?;
/// let ambient = EnvironmentObject { temperature_k: 293.15, emissivity: None };
/// let surroundings = Surroundings::new(bands.nodes_cm1(), vec![ambient])?;
/// let scene = DecisionScene {
///     bands: &bands,
///     surroundings: &surroundings,
///     unknowns: &Unknowns::new([Nuisance::Temperature])?,
///     range: StateRange::default(),
///     counts_per_radiance: 1e-16,
///     statistics: &Statistics::Poisson,
/// };
/// let (paint, metal) = (vec![0.95; bands.len()], vec![0.1; bands.len()]);
/// let state = surroundings.state(310.15, &[0.5])?;
/// let detection = scene.detection(&[&paint, &metal], 0, &state, &Plan::new(1, 0.01, 10_000)?)?;
/// assert!(detection.probability > 0.99);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct DecisionScene<'a> {
    /// Bands.
    pub bands: &'a Bands,
    /// Surroundings.
    pub surroundings: &'a Surroundings,
    /// What is not known of a material's state.
    pub unknowns: &'a Unknowns,
    /// What is physically possible for every candidate's state; the true one should lie within it.
    pub range: StateRange,
    /// κ, counts per unit of band signal, m² sr s.
    pub counts_per_radiance: f64,
    /// How counts scatter.
    pub statistics: &'a Statistics,
}

/// How often the decision is right when one material in one state is true.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Detection {
    /// Share of correct decisions; ties are split.
    pub probability: f64,
    /// Wilson's interval of it at the plan's level.
    pub interval: Interval,
    /// Decisions for each of the candidates, ties split.
    pub decisions: Vec<f64>,
    /// Number of trials that were made.
    pub trials: u64,
    /// Trials in which a fit did not converge (its best state so far counts).
    pub unconverged: u64,
    /// Candidates too far away to be fitted.
    pub out_of_reach: Vec<usize>,
    /// Level, half width, limit and seed that were asked for.
    pub plan: Plan,
    /// The generator that the seed belongs to.
    pub generator: &'static str,
}

/// The mean of two detections: one state each of two materials, equally likely.
#[derive(Debug, Clone, PartialEq)]
pub struct Balanced {
    /// Share of correct decisions, averaged over the two.
    pub probability: f64,
    /// Interval of it at the plan's level.
    pub interval: Interval,
    /// With the target true, and with the alternative true.
    pub classes: [Detection; 2],
    /// The alternative's state: its nearest, or the one given.
    pub alternative_state: State,
    /// Half the separation of the two states in units of the noise.
    pub distance: f64,
}

impl DecisionScene<'_> {
    /// How often the true one of `materials` (emissivities at the nodes) is recognised in `state`.
    ///
    /// # Errors
    /// No such material; an emissivity or a state that does not fit the scene; no photons, or too many.
    pub fn detection(
        &self,
        materials: &[&[f64]],
        truth: usize,
        state: &State,
        plan: &Plan,
    ) -> Result<Detection> {
        let tests = [self.test(materials, truth, state)?];
        let trials = run(plan, &tests, |trials: &[Trials; 1]| trials[0].interval(truth, plan));
        let ([test], [trials]) = (tests, trials);
        Ok(detection(test, trials, plan))
    }

    /// How often a target in `state` and an alternative in its nearest state are told apart, states unknown.
    ///
    /// # Errors
    /// As [`DecisionScene::detection`].
    pub fn balanced(&self, pair: (&[f64], &[f64]), state: &State, plan: &Plan) -> Result<Balanced> {
        let materials = [pair.0, pair.1];
        let target = self.test(&materials, 0, state)?;
        let counting = self.counting(&self.means(pair.0, state)?);
        let nearest = self.solver().with_counting(pair.0, pair.1, state, &counting)?;
        let alternative = self.test(&materials, 1, &nearest.state)?;
        Ok(balanced([target, alternative], nearest.state, nearest.distance, plan))
    }

    /// How often two materials are told apart that are in known states, by their likelihood ratio.
    ///
    /// # Errors
    /// As [`DecisionScene::detection`].
    pub fn known_states(
        &self,
        target: (&[f64], &State),
        alternative: (&[f64], &State),
        plan: &Plan,
    ) -> Result<Balanced> {
        let means = [self.means(target.0, target.1)?, self.means(alternative.0, alternative.1)?];
        let counting = self.counting(&means[0]);
        let distance = detection::half_separation(&means[0], &means[1], &counting);
        let test = |truth: usize| -> Result<Test<'_>> {
            let draws = Draws::new(self.statistics, &means[truth])?;
            let rule = Box::new(LikelihoodRatio::new(self.statistics, &means)?);
            Ok(Test { truth, draws, rule, out_of_reach: Vec::new() })
        };
        let tests = [test(0)?, test(1)?];
        Ok(balanced(tests, alternative.1.clone(), distance, plan))
    }

    /// The rule that knows the materials but none of their states, for counts that come from any of `classes`, each a
    /// material in a state. What is not unknown has its value in the state of the first.
    ///
    /// # Errors
    /// As [`DecisionScene::detection`]; no classes.
    pub fn best_fits<'m>(&'m self, classes: &[(&'m [f64], &State)]) -> Result<BestFits<'m>> {
        let Some((_, known)) = classes.first() else {
            return Err(Error::malformed("there are no materials to distinguish", "give two"));
        };
        let mut candidates = Vec::with_capacity(classes.len());
        for &(own, state) in classes {
            let mut starts = vec![state.clone()];
            for &(emissivity, truth) in classes {
                for start in self.starts(emissivity, own, truth)? {
                    if !starts.iter().any(|known| alike(known, &start)) {
                        starts.push(start);
                    }
                }
            }
            candidates.push(Candidate { emissivity: own, starts });
        }
        Ok(BestFits::new(self.fits()?, candidates, (*known).clone(), self.bands.len()))
    }

    /// States of `other` from which it is fitted to counts of `emissivity` in `state`: its nearest ones, and for one so
    /// cold that its own emission is below the noise, which likelihood then hardly depends on, one where it is not;
    /// none at all if it is out of reach.
    ///
    /// # Errors
    /// As [`DecisionScene::detection`].
    pub fn starts(&self, emissivity: &[f64], other: &[f64], state: &State) -> Result<Vec<State>> {
        let means = self.means(emissivity, state)?;
        let counting = self.counting(&means);
        check_emissivity(other, self.bands.nodes_cm1().len())?;
        let minima = self.solver().minima_with_counting(emissivity, other, state, &counting, REACH)?;
        let within = minima.into_iter().filter(|minimum| minimum.distance <= OUT_OF_REACH);
        let mut starts: Vec<State> = within.map(|minimum| minimum.state).collect();
        if self.unknowns.contains(Nuisance::Temperature) {
            let variances =
                means.iter().enumerate().map(|(band, mean)| self.statistics.variance(band, *mean));
            let warm_k = self.emitting(other, variances.sum::<f64>().sqrt());
            for i in 0..starts.len() {
                if starts[i].temperature_k < warm_k {
                    starts.push(State { temperature_k: warm_k, ..starts[i].clone() });
                }
            }
        }
        Ok(starts)
    }

    /// Temperature (K, within its range) at which a surface emits `counts` in all bands together.
    fn emitting(&self, emissivity: &[f64], counts: f64) -> f64 {
        let nu = self.bands.nodes_cm1();
        let mut radiance = vec![0.0; nu.len()];
        let [mut low, mut high] = self.range.temperature_k.map(f64::ln);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            planck::photon_radiance_into(nu, middle.exp(), &mut radiance);
            radiance.iter_mut().zip(emissivity).for_each(|(radiance, e)| *radiance *= e);
            let emitted = self.counts_per_radiance * self.bands.weigh(&radiance).iter().sum::<f64>();
            if emitted < counts { low = middle } else { high = middle }
        }
        low.exp()
    }

    /// Counts from material `truth` in `state`, judged by fits of all `materials`.
    fn test<'m>(&'m self, materials: &[&'m [f64]], truth: usize, state: &State) -> Result<Test<'m>> {
        let Some(&emissivity) = materials.get(truth) else {
            return Err(Error::Length {
                what: "materials".into(),
                found: materials.len(),
                expected: truth.saturating_add(1),
            });
        };
        let means = self.means(emissivity, state)?;
        let mut candidates = Vec::with_capacity(materials.len());
        for (i, &other) in materials.iter().enumerate() {
            let mut starts = self.starts(emissivity, other, state)?;
            if i == truth && !starts.contains(state) {
                starts.insert(0, state.clone());
            }
            candidates.push(Candidate { emissivity: other, starts });
        }
        let rule = BestFits::new(self.fits()?, candidates, state.clone(), self.bands.len());
        let out_of_reach = rule.out_of_reach();
        Ok(Test { draws: Draws::new(self.statistics, &means)?, truth, rule: Box::new(rule), out_of_reach })
    }

    fn fits(&self) -> Result<MaximumLikelihood<'_>> {
        MaximumLikelihood::new(
            self.bands,
            self.surroundings,
            self.unknowns.clone(),
            self.range,
            self.counts_per_radiance,
            self.statistics.clone(),
        )
    }

    fn solver(&self) -> NearestSolver<'_> {
        NearestSolver::new(self.bands, self.surroundings, self.unknowns.clone(), self.range)
    }

    /// Mean counts of each band.
    fn means(&self, emissivity: &[f64], state: &State) -> Result<Vec<f64>> {
        check::positive("counts per unit of band signal", self.counts_per_radiance, "m^2 sr s")?;
        check_emissivity(emissivity, self.bands.nodes_cm1().len())?;
        let objects = self.surroundings.objects().len();
        for given in [state.lighting.len(), state.environment_k.len()] {
            if given != objects {
                return Err(Error::Length {
                    what: "environment objects of the state".into(),
                    found: given,
                    expected: objects,
                });
            }
        }
        let mut means = self.bands.weigh(&self.surroundings.signal(emissivity, state));
        means.iter_mut().for_each(|mean| *mean *= self.counts_per_radiance);
        self.statistics.check_bands(means.len())?;
        Ok(means)
    }

    /// The noise as the nearest distance takes it: what the law adds to the variance of a Poisson law.
    fn counting(&self, means: &[f64]) -> Counting {
        let excess = |(band, &mean): (usize, &f64)| self.statistics.variance(band, mean) - mean;
        let var_added = match self.statistics {
            Statistics::Poisson => Vec::new(),
            _ => means.iter().enumerate().map(excess).collect(),
        };
        Counting { counts_per_radiance: self.counts_per_radiance, var_added }
    }
}

/// Whether fits from two states are one and the same.
fn alike(a: &State, b: &State) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() <= ALIKE * (1.0 + a.abs().max(b.abs()));
    let all = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| near(*a, *b));
    near(a.temperature_k, b.temperature_k)
        && near(a.gain, b.gain)
        && all(&a.lighting, &b.lighting)
        && all(&a.environment_k, &b.environment_k)
}

fn detection(test: Test<'_>, trials: Trials, plan: &Plan) -> Detection {
    Detection {
        probability: trials.share(test.truth),
        interval: trials.interval(test.truth, plan),
        decisions: trials.decisions,
        trials: trials.trials,
        unconverged: trials.unconverged,
        out_of_reach: test.out_of_reach,
        plan: *plan,
        generator: GENERATOR,
    }
}

fn balanced(tests: [Test<'_>; 2], alternative_state: State, distance: f64, plan: &Plan) -> Balanced {
    let estimate = |trials: &[Trials; 2]| {
        let intervals = [trials[0].interval(0, plan), trials[1].interval(1, plan)];
        Interval::of_mean(&[trials[0].share(0), trials[1].share(1)], &intervals)
    };
    let trials = run(plan, &tests, estimate);
    let interval = estimate(&trials);
    let ([first, second], [of_first, of_second]) = (tests, trials);
    let classes = [detection(first, of_first, plan), detection(second, of_second, plan)];
    let probability = 0.5 * (classes[0].probability + classes[1].probability);
    Balanced { probability, interval, classes, alternative_state, distance }
}
