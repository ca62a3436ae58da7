//! The answer to a rule: that of `hadar rule`, and of its reforms that of `hadar rule --reforms`.

use crate::engine::Engine;
use crate::packs::{self, Pack};
use crate::said::{Said, told};
use crate::size_limit::{self, Command};
use hadar::demand::{Reason, Thing, Work};
use hadar::error::{Error, Result};
use hadar::inputs::{self, Inputs, inputs_of};
use hadar_report::bundle::About;
use hadar_report::json;
use hadar_report::manifest::{Provenance, VERSION, answer_json};
use hadar_report::rule::{self, Output, rows};
use hadar_scenario::rule::Reform;
use hadar_scenario::{Date, Rule, Written, day};
use hadar_study::{ClauseAnswer, Reforms, RuleAnswer, RuleAsked, RuleStudy};
use serde::{Deserialize, Serialize};

/// What a rule of the page is called in its report.
const NAME: &str = "rule.toml";
/// The seed of `hadar rule` where none is given.
const SEED: u64 = 1;

/// A question of the page for rules.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RuleAsk {
    /// The text of the rule.
    rule: String,
    /// The day that is asked about, as `--on` has it; silent or empty: none.
    #[serde(default)]
    on: Option<String>,
}

/// A question about the reforms of a rule.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ReformsAsk {
    /// The text of the rule.
    rule: String,
}

/// A rule with what it names looked up.
#[derive(Debug)]
pub(crate) struct PreparedRule {
    text: String,
    study: Result<(RuleStudy, Option<Date>)>,
    read: Inputs,
}

/// A rule of which every reform can be computed, or why not.
#[derive(Debug)]
pub(crate) struct PreparedReforms(Result<Written>);

impl PreparedRule {
    /// Whether there is nothing to compute.
    pub(crate) const fn is_quick(&self) -> bool {
        self.study.is_err()
    }
}

impl PreparedReforms {
    /// Whether there is nothing to compute.
    pub(crate) const fn is_quick(&self) -> bool {
        self.0.is_err()
    }
}

/// An answer as it is shown.
#[derive(Debug, Serialize)]
struct Answer {
    shown: rows::Shown,
    /// What each camera's verdict on the whole rule rests on; those that rest on nothing are left out.
    conditions: Vec<RestsOn>,
    /// Clause by clause and camera by camera, what its verdict rests on.
    clauses_rest_on: Vec<Vec<Vec<Said>>>,
    warnings: Vec<Said>,
    /// Reforms that can be held beside the rule.
    reforms: Vec<Offered>,
    /// Names and drawings (SVG).
    pictures: Vec<(String, String)>,
    /// The whole answer as `hadar rule` prints it.
    text: String,
    /// What `hadar rule --json` prints.
    json: String,
    /// The page of the report that `hadar rule --out` writes.
    report: String,
}

/// What the verdict on a camera rests on.
#[derive(Debug, Serialize)]
struct RestsOn {
    camera: String,
    conditions: Vec<Said>,
}

/// A reform before it is computed.
#[derive(Debug, Serialize)]
struct Offered {
    name: String,
    status: Option<String>,
    from: Option<String>,
}

/// Reforms as they are shown.
#[derive(Debug, Serialize)]
struct ReformsAnswer {
    reforms: Vec<rows::ReformShown>,
    /// What they are held beside the rule for.
    beside: &'static str,
    /// Names and drawings (SVG).
    pictures: Vec<(String, String)>,
    /// What `hadar rule --reforms` prints.
    text: String,
    /// What `hadar rule --reforms --json` prints.
    json: String,
}

impl Engine {
    /// What the page for rules begins with.
    pub(crate) fn rules(&self) -> Result<String> {
        #[derive(Serialize)]
        struct Start<'a> {
            version: &'static str,
            /// The rule that it begins with; none where that is the first pack.
            begin: Option<&'a str>,
            packs: Vec<Pack>,
            /// Words of the page, each with its meaning.
            words: &'a [[&'a str; 2]],
            library_warnings: &'a [String],
        }
        json::line(&Start {
            version: VERSION,
            begin: self.begin_rule.as_deref(),
            packs: packs::all()?,
            words: &rows::WORDS,
            library_warnings: self.library.warnings(),
        })
    }

    /// Reads the rule of a question and looks up what it names.
    pub(crate) fn prepare_rule(&self, ask: RuleAsk) -> PreparedRule {
        let (study, read) = inputs_of(|| {
            let on = asked_day(ask.on.as_deref())?;
            Ok((self.rule_study(&self.written(&ask.rule))?, on))
        });
        PreparedRule { text: ask.rule, study, read }
    }

    /// Reads the rule of a question, and looks up what it names as it is and by each of its reforms.
    pub(crate) fn prepare_reforms(&self, ask: &ReformsAsk) -> PreparedReforms {
        let written = self.written(&ask.rule);
        let looked_up = self.rule_study(&written).and_then(|law| {
            let reforms = &law.rule().reforms;
            // What one of them sets is told by its name when it is computed.
            reforms.iter().try_for_each(|reform| self.rule_study(&written.with(reform.set.clone())).map(drop))
        });
        PreparedReforms(looked_up.map(|()| written))
    }

    /// A rule's answer.
    pub(crate) fn rule_answer(&self, prepared: PreparedRule) -> Result<String> {
        let PreparedRule { text, study, read } = prepared;
        told(study.and_then(|(study, on)| self.shown(&text, &study, on, &read)))
    }

    /// Every camera by a rule and by its reforms.
    pub(crate) fn reforms_answer(&self, PreparedReforms(written): PreparedReforms) -> Result<String> {
        told(written.and_then(|written| {
            let found = Reforms::of(&written, &self.library, false, &|_, _| ())?;
            let title = Rule::from_written(&written)?.about.name;
            Ok(ReformsAnswer {
                reforms: rows::reforms(&found),
                beside: rows::BESIDE,
                pictures: rule::reforms_bundle(&found, title.as_deref())?.drawings()?,
                text: rule::reforms(&found),
                json: self.rule_json(&found)?,
            })
        }))
    }

    fn shown(&self, text: &str, study: &RuleStudy, on: Option<Date>, read: &Inputs) -> Result<Answer> {
        let asked = RuleAsked { seed: SEED, on, ..RuleAsked::default() };
        let (answer, mut read) = inputs_of(|| {
            inputs::add(read);
            study.answer(&asked, &|_, _| ())
        });
        let mut answer = answer?;
        let mut no_report = Work::default();
        no_report.spare(Thing::Reports, Reason::NotAsked, 1);
        answer.stats.add(&no_report);
        read.streams.insert(0, (NAME.to_owned(), text.as_bytes().to_vec()));
        let day = on.map(|day| day.to_string());
        let of_day = day.iter().flat_map(|day| ["--on", day]);
        let command = ["hadar", "rule", NAME].into_iter().chain(of_day).map(str::to_owned).collect();
        let provenance = Provenance::of(&self.commit, command, SEED, &read)?;
        let bundle = rule::bundle(study, &answer, &provenance)?;
        let printed = rule::text(&answer, study);
        Ok(Answer {
            shown: rows::of(&answer),
            conditions: rests_on(&answer),
            clauses_rest_on: answer.clauses.iter().map(clause_rests_on).collect(),
            warnings: rows::warnings(&answer).iter().map(Said::from).collect(),
            reforms: study.rule().reforms.iter().map(offered).collect(),
            pictures: bundle.drawings()?,
            json: self.rule_json(&Output::of(&answer, &provenance.inputs))?,
            report: bundle.page(&About { answer: &printed, provenance: &provenance, inputs: &[] })?,
            text: printed,
        })
    }

    fn rule_json(&self, answer: &impl Serialize) -> Result<String> {
        answer_json(answer, &self.library_warnings(), &[]).map(|text| text + "\n")
    }

    fn rule_study(&self, written: &Written) -> Result<RuleStudy> {
        let asked = Rule::from_written(written)?;
        size_limit::lines(asked.cameras.len(), asked.clauses.len())?;
        for clause in &asked.clauses {
            size_limit::surroundings(clause.scenario.environment.len(), Command::Rule)?;
        }
        let study = RuleStudy::new(&asked, &self.library)?;
        study.studies().try_for_each(|study| size_limit::bands(study, Command::Rule))?;
        self.limits.admit(study.takes(), rayon::current_num_threads())?;
        Ok(study)
    }
}

/// The day of a question.
fn asked_day(on: Option<&str>) -> Result<Option<Date>> {
    let Some(text) = on.map(str::trim).filter(|text| !text.is_empty()) else { return Ok(None) };
    let wrong =
        || Error::malformed(format!("`{text}` is no day"), "write year, month and day, as in 2029-09-01");
    day(text).map(Some).ok_or_else(wrong)
}

fn rests_on(answer: &RuleAnswer) -> Vec<RestsOn> {
    let of_camera = answer.cameras.iter().map(|camera| RestsOn {
        camera: camera.name.clone(),
        conditions: camera.conditions.iter().map(Said::from).collect(),
    });
    of_camera.filter(|one| !one.conditions.is_empty()).collect()
}

fn clause_rests_on(clause: &ClauseAnswer) -> Vec<Vec<Said>> {
    clause.lines().iter().map(|line| line.conditions.iter().map(Said::from).collect()).collect()
}

fn offered(reform: &Reform) -> Offered {
    Offered {
        name: reform.name.clone(),
        status: reform.status.clone(),
        from: reform.from.map(|day| day.to_string()),
    }
}
