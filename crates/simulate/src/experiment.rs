//! One experiment: spectra of known classes drawn, classifiers trained on a part of them, all judged on the rest.
//!
//! A quarter of the spectra of each class is for training, a quarter for validation, half for the test, as in the paper.
//! Test spectra are drawn, judged by every classifier and forgotten, so that their number takes no memory; training spectra
//! are drawn only if something is trained.

use super::classifier::{BestFits, Classifier, Confusion, LikelihoodRatio, Method, Trained, share};
use super::draws::{Draws, STREAMS};
use super::ratio::RatioDraws;
use super::sequential::Interval;
use super::spectra::{LabelledSpectra, Parts};
use hadar::demand::{Reason, Thing, Work};
use hadar::error::{Error, Result};
use hadar::identifiability::ratio::State;
use hadar::statistics::Statistics;

/// What is drawn, and how it is judged.
pub struct Experiment<'a> {
    /// The law of each class's counts.
    pub draws: &'a [Draws],
    /// Mean counts of each class.
    pub means: &'a [Vec<f64>],
    /// The law that the likelihood ratio takes the counts to follow.
    pub statistics: &'a Statistics,
    /// The rule of best fits, where it takes part.
    pub best_fits: Option<&'a BestFits<'a>>,
    /// Classifiers trained before, which take part as they are.
    pub trained: &'a [Trained],
}

/// How it is made.
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    /// Spectra of each class: a quarter each for training and validation, half for the test.
    pub per_class: usize,
    /// Who takes part.
    pub methods: Vec<Method>,
    /// Seed of everything that is drawn.
    pub seed: u64,
    /// Level of the confidence intervals.
    pub level: f64,
    /// Whether the likelihood ratio itself is drawn instead of spectra, where it alone takes part, there are two classes,
    /// and counts follow the law by which it judges: as good, and hundreds of times as fast.
    pub skip_spectra: bool,
}

/// How often one classifier was right on the test spectra.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Performance {
    /// Name of the classifier that was tested.
    pub method: Method,
    /// Whether it was trained before, and taken from a file.
    pub saved: bool,
    /// Balanced accuracy: share of correct decisions, averaged over the classes.
    pub accuracy: f64,
    /// Confidence interval of the balanced accuracy, 0 to 1.
    pub interval: Interval,
    /// Share of correct decisions of each class, and of wrong ones for each.
    pub confusion: Confusion,
    /// How the training of the classifier ended, in words.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub training: Option<String>,
}

impl Performance {
    /// What it is called in a table.
    #[must_use]
    pub fn name(&self) -> String {
        format!("{}{}", self.method.name(), if self.saved { " (saved)" } else { "" })
    }

    /// What it is called in a figure.
    #[must_use]
    pub fn words(&self) -> String {
        format!("{}{}", self.method.words(), if self.saved { ", saved" } else { "" })
    }
}

impl Design {
    /// What an experiment with so many classes draws and trains, and what nobody who takes part needs.
    ///
    /// # Errors
    /// Fewer than 4 spectra of a class, or too many.
    pub fn work(&self, classes: usize) -> Result<Work> {
        let Parts { training, validation, test } = Parts::of(self.per_class)?;
        let spectra = |range: &std::ops::Range<u64>| (range.end - range.start) * classes as u64;
        let (learnt, tested) = (spectra(&training) + spectra(&validation), spectra(&test));
        let trained = self.methods.iter().filter(|method| method.is_trained()).count() as u64;
        let can_be_trained = Method::ALL.iter().filter(|method| method.is_trained()).count() as u64;
        let mut work = Work::default();
        work.compute(Thing::TrainedClassifiers, if self.skip_spectra { 0 } else { trained });
        work.spare(Thing::TrainedClassifiers, Reason::NotAsked, can_be_trained.saturating_sub(trained));
        if self.skip_spectra {
            work.compute(Thing::Ratios, tested);
            work.spare(Thing::Spectra, Reason::Decided, tested);
        } else {
            work.compute(Thing::Spectra, tested);
        }
        if trained > 0 && !self.skip_spectra {
            work.compute(Thing::Spectra, learnt);
        } else {
            work.spare(Thing::Spectra, Reason::NotAsked, learnt);
        }
        Ok(work)
    }
}

impl Experiment<'_> {
    /// Trains and judges. The trained classifiers come with their performances, all in the order of the design, those
    /// that were trained before last.
    ///
    /// # Errors
    /// Fewer than 4 spectra of a class; best fits asked for that are not given; classes that do not fit together.
    pub fn run(&self, design: &Design) -> Result<(Vec<Performance>, Vec<Trained>)> {
        let parts = Parts::of(design.per_class)?;
        if design.skip_spectra {
            return Ok((
                vec![self.without_spectra(design, (parts.test.end - parts.test.start) as usize)?],
                Vec::new(),
            ));
        }
        let mut learnt = Vec::new();
        if design.methods.iter().any(|method| method.is_trained()) {
            let training = LabelledSpectra::draw(self.draws, parts.training.clone(), design.seed)?;
            let validation = LabelledSpectra::draw(self.draws, parts.validation.clone(), design.seed)?;
            for method in &design.methods {
                learnt.extend(method.train(&training, &validation, design.seed)?);
            }
        }
        let ratio = LikelihoodRatio::new(self.statistics, self.means)?;
        let mut rules: Vec<(Method, bool, &dyn Classifier, Option<String>)> = Vec::new();
        let mut waiting = learnt.iter();
        for &method in &design.methods {
            match method {
                Method::LikelihoodRatio => rules.push((method, false, &ratio, None)),
                Method::BestFits => {
                    let Some(fits) = self.best_fits else {
                        let found = "best fits take part, but no materials to fit are given";
                        return Err(Error::malformed(found, "give them"));
                    };
                    rules.push((method, false, fits, None));
                }
                _ => rules.extend(
                    waiting.next().map(|t| (method, false, t as &dyn Classifier, Some(t.training()))),
                ),
            }
        }
        rules.extend(
            self.trained.iter().map(|t| (t.method(), true, t as &dyn Classifier, Some(t.training()))),
        );
        let classifiers: Vec<&dyn Classifier> = rules.iter().map(|rule| rule.2).collect();
        let confusions = Confusion::of_draws(&classifiers, self.draws, parts.test, design.seed)?;
        let performances = rules
            .into_iter()
            .zip(confusions)
            .map(|((method, saved, _, training), confusion)| Performance {
                method,
                saved,
                accuracy: confusion.accuracy(),
                interval: confusion.interval(design.level),
                confusion,
                training,
            })
            .collect();
        Ok((performances, learnt))
    }

    /// The spectra that classifiers are judged on.
    ///
    /// # Errors
    /// As [`Parts::of`] and [`LabelledSpectra::draw`].
    pub fn test_spectra(&self, design: &Design) -> Result<LabelledSpectra> {
        LabelledSpectra::draw(self.draws, Parts::of(design.per_class)?.test, design.seed)
    }

    /// The likelihood ratio of two classes from draws of itself.
    fn without_spectra(&self, design: &Design, tests: usize) -> Result<Performance> {
        let ([first, second], [Method::LikelihoodRatio], []) =
            (self.means, design.methods.as_slice(), self.trained)
        else {
            let found = "spectra can be skipped for the likelihood ratio of two classes alone";
            return Err(Error::malformed(
                found,
                "leave the other classifiers and classes out, or draw spectra",
            ));
        };
        let mut decisions = Vec::with_capacity(2);
        for (class, truth) in [State::First, State::Second].into_iter().enumerate() {
            let draws = RatioDraws::new(first, second, self.statistics, truth)?;
            let mut row = vec![0.0; 2];
            for ratio in draws.values(design.seed, class as u64 * STREAMS, tests) {
                share(&[0.0, ratio], &mut row);
            }
            decisions.push(row);
        }
        let confusion = Confusion { decisions, unconverged: 0 };
        Ok(Performance {
            method: Method::LikelihoodRatio,
            saved: false,
            accuracy: confusion.accuracy(),
            interval: confusion.interval(design.level),
            confusion,
            training: None,
        })
    }
}
