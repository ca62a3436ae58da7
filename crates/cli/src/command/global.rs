//! What every command shares: its options, the library, the study, and how answers leave the process.

use super::progress::Bar;
use super::provenance;
use super::stderr::say;
use super::terminal::Stream;
use clap::{ArgMatches, Args};
use hadar::demand::{Reason, Skipping, Thing, Work};
use hadar::error::{Error, Result};
use hadar::inputs::{self, Held};
use hadar::material::Library;
use hadar::units::decimal_comma;
use hadar_formats::ReadLibrary as _;
use hadar_report::bundle::{About, Bundle};
use hadar_report::folder::{Folder, Scratch, Strangers};
use hadar_report::json;
use hadar_report::manifest::{Input, Provenance, answer_json, sha256};
use hadar_report::text::{self, with_settings};
use hadar_scenario::{Date, Scenario, Setting, Written};
use hadar_study::budget::{self, Limits, Takes};
use hadar_study::warning::Warning;
use hadar_study::{Condition, OwnCameras, Study};
use serde_json::Value;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Duration;

/// Flags that several commands have; which of them a command takes is said in one table.
#[derive(Debug, Clone, Args)]
pub struct Global {
    /// Print one JSON object on stdout and nothing else
    #[arg(long)]
    pub(super) json: bool,
    /// Write a report into this folder: one page, the answer, scenario, tables and plots
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Write the tables of a report as Parquet too, in addition to CSV
    #[arg(long, value_name = "FORMAT", requires = "out")]
    pub(super) format: Option<Format>,
    /// Take an --out folder although it holds files that hadar did not write, or that were changed: those in the way are
    /// replaced, the others stay
    #[arg(long)]
    pub(super) force: bool,
    /// Replace a value of the file, as in camera.exposure="5 ms" or environment[0].lighting=0.3; may be given several
    /// times
    #[arg(long, value_name = "KEY=VALUE", value_parser = setting)]
    pub(super) set: Vec<Setting>,
    /// Materials of your own, a folder or a file; may be given several times
    #[arg(long, value_name = "DIR")]
    pub library: Vec<PathBuf>,
    /// Use the materials of --library alone, not the built-in ones
    #[arg(long)]
    pub(super) only_library: bool,
    /// Refuse a folder of spectra for any file in it that cannot be used, instead of passing it over with a warning
    #[arg(long)]
    pub(super) strict: bool,
    /// Cameras of your own that a file may name, [[camera]] tables with a name and the keys of [camera]; may be given several times
    #[arg(long, value_name = "FILE")]
    pub(super) cameras: Vec<PathBuf>,
    /// Folder that relative paths of the file start from (default: its own)
    #[arg(long, value_name = "DIR")]
    pub(super) inputs: Option<PathBuf>,
    /// Leave out alternatives whose spectra do not cover the bands, with a warning
    #[arg(long)]
    pub(super) skip_uncovered: bool,
    /// Seed of random numbers; the same seed gives the same result, for any number of threads
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Number of threads (default: all cores); the result does not depend on it
    #[arg(long, value_name = "N")]
    pub(super) threads: Option<usize>,
    /// Stop after this time, as 90 s or 5 min, with nothing written and exit code 1. What is known to take longer is refused at once
    #[arg(long, value_name = "DURATION", value_parser = time)]
    time_limit: Option<Duration>,
    /// Stop where the program has taken more memory than this, as 500 MB or 2 GB (watched on Linux); what is known to take more is
    /// refused at once
    #[arg(long, value_name = "SIZE", value_parser = memory)]
    memory_limit: Option<u64>,
    /// Both of them.
    #[arg(skip)]
    pub(super) limits: Limits,
    /// Say on stderr what was computed, what was not, and why (with --json always under `stats`)
    #[arg(long)]
    pub(super) stats: bool,
    /// Compute in full what a proof would spare; the answer is the same
    #[arg(long)]
    pub(super) no_skip: bool,
    /// Print nothing on stderr but errors
    #[arg(short, long)]
    pub(super) quiet: bool,
    /// What was said of the library, for JSON.
    #[arg(skip)]
    said_of_library: Arc<OnceLock<Vec<Warning>>>,
    /// Of one of several scenarios: its answer, which is kept and not printed.
    #[arg(skip)]
    kept: Option<Arc<Mutex<Option<Value>>>>,
    /// Words of the command that are of other scenarios.
    #[arg(skip)]
    of_others: Vec<String>,
    /// Of a report that is made again: what it says of itself.
    #[arg(skip)]
    remade: Option<Arc<Remade>>,
}

/// What a report says of itself that is made again.
#[derive(Debug)]
pub(super) struct Remade {
    /// The file of the question as the command names it, and the text that stands in its place.
    asked: Option<(PathBuf, String)>,
    stored: Provenance,
    /// What was read now.
    inputs: Mutex<Vec<Input>>,
}

impl Remade {
    pub(super) fn new(asked: Option<(PathBuf, String)>, stored: Provenance) -> Self {
        Self { asked, stored, inputs: Mutex::default() }
    }

    /// What was read until its report was written.
    pub(super) fn inputs(&self) -> Vec<Input> {
        self.inputs.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// That of the report, once what was read now is kept to be compared.
    fn provenance(&self, now: Provenance) -> Provenance {
        *self.inputs.lock().unwrap_or_else(PoisonError::into_inner) = now.inputs;
        self.stored.clone()
    }
}

impl Global {
    /// What was given, in the first of the places in which it is; else its default.
    pub(super) fn of(places: [&ArgMatches; 2]) -> Self {
        let (time_limit, memory_limit) = (one(places, "time_limit"), one(places, "memory_limit"));
        Self {
            json: yes(places, "json"),
            out: one(places, "out"),
            format: one(places, "format"),
            force: yes(places, "force"),
            set: many(places, "set"),
            library: many(places, "library"),
            only_library: yes(places, "only_library"),
            strict: yes(places, "strict"),
            cameras: many(places, "cameras"),
            inputs: one(places, "inputs"),
            skip_uncovered: yes(places, "skip_uncovered"),
            seed: one(places, "seed").unwrap_or(1),
            threads: one(places, "threads"),
            time_limit,
            memory_limit,
            limits: Limits { time: time_limit, memory_bytes: memory_limit },
            stats: yes(places, "stats"),
            no_skip: yes(places, "no_skip"),
            quiet: yes(places, "quiet"),
            said_of_library: Arc::default(),
            kept: None,
            of_others: Vec::new(),
            remade: None,
        }
    }

    /// The same for a report that is made again into a folder of its own, with nothing printed, of materials in `library` where there are any.
    pub(super) fn made_again(
        self,
        out: &Path,
        remade: Arc<Remade>,
        by: &Self,
        library: Vec<PathBuf>,
    ) -> Self {
        let (out, kept) = (Some(out.to_owned()), Some(Arc::default()));
        let library = if library.is_empty() { self.library } else { library };
        Self { out, kept, remade: Some(remade), quiet: true, threads: by.threads, library, ..self }
    }

    /// The embedded library with the user's own materials.
    pub(super) fn library(&self) -> Result<Library> {
        let library = if self.only_library { Library::empty() } else { Library::embedded()? };
        let library = self.with_own(library)?;
        if library.is_empty() {
            let instead = "add spectra with --library DIR, or leave out --only-library";
            return Err(Error::malformed("the library is empty", instead));
        }
        Ok(library)
    }

    /// A library with the user's own materials; what is to be said about them is said, and goes into the JSON.
    pub fn with_own(&self, library: Library) -> Result<Library> {
        let mut library = library.strict(self.strict);
        self.library.iter().try_for_each(|path| library.add_path(path))?;
        self.said_of_library.get_or_init(|| {
            for warning in library.warnings() {
                self.note(&Stream::Err.message("warning:", warning));
            }
            // In an answer files have the names of its inputs; where the library is all that was read, from here.
            let of_library = |home: &PathBuf| {
                self.library
                    .iter()
                    .any(|path| std::path::absolute(path).is_ok_and(|path| home.starts_with(path)))
            };
            let home = inputs::so_far().home().filter(|home| !of_library(home));
            let home = home.or_else(|| std::env::current_dir().ok());
            let said = |remark: &String| {
                let name = |said: String, path: &PathBuf| {
                    said.replace(&*path.to_string_lossy(), &inputs::called(home.as_deref(), path))
                };
                Warning::Library { remark: self.library.iter().fold(remark.clone(), name) }
            };
            library.warnings().iter().map(said).collect()
        });
        Ok(library)
    }

    /// A file of a question as it is to be read, with what was set; `-` is standard input.
    pub(super) fn written(&self, path: &Path) -> Result<Written> {
        let asked = self.remade.as_ref().and_then(|remade| remade.asked.as_ref());
        let written = match asked {
            Some((path, text)) => {
                inputs::file(path, Held::Sha256(sha256(text.as_bytes())));
                Written::of(text, Some(path))
            }
            None if path.as_os_str() == "-" => Written::from_stdin(std::io::stdin().lock())?,
            None => Written::from_file(path)?,
        };
        for (index, one) in self.set.iter().enumerate() {
            if self.set.iter().skip(index + 1).any(|other| other.key == one.key) {
                let found = Error::malformed("it is set twice", "name it once");
                return Err(found.for_key(format!("--set {}", one.key)));
            }
        }
        Ok(written
            .with(self.set.iter().cloned())
            .with_inputs(self.inputs.clone())
            .with_cameras(OwnCameras::from_files(&self.cameras)?.stated.into()))
    }

    /// Refuses values for what has no keys.
    pub(super) fn sets_nothing(&self, what: &str) -> Result<()> {
        match self.set.first() {
            Some(one) => {
                let found = Error::malformed(format!("{what} has no keys"), "leave out --set");
                Err(found.for_key(format!("--set {}", one.key)))
            }
            None => Ok(()),
        }
    }

    /// For one of several scenarios: its report in a folder of its own, its answer kept.
    pub(super) fn of_several(&self, folder: &str, others: impl Iterator<Item = String>) -> Self {
        let out = self.out.as_ref().map(|out| out.join(folder));
        Self { out, kept: Some(Arc::default()), of_others: others.collect(), ..self.clone() }
    }

    /// The answer that was kept.
    pub(super) fn kept(&self) -> Option<Value> {
        self.kept.as_ref()?.lock().ok()?.take()
    }

    /// A bar on stderr for long work; nothing where stderr is no terminal, or quiet.
    pub fn progress(&self, what: &'static str) -> Bar {
        Bar::new(what, self.quiet)
    }

    /// A line on stderr, unless quiet.
    pub fn note(&self, text: &str) {
        if !self.quiet {
            say(text);
        }
    }

    /// Whether proofs may spare work.
    pub(super) fn skipping(&self) -> Skipping {
        if self.no_skip { Skipping::Off } else { Skipping::On }
    }

    /// A folder to be written to.
    pub fn folder(&self, path: &Path) -> Folder {
        Folder::new(path, if self.force { Strangers::KeepBesides } else { Strangers::Refuse })
    }

    /// Makes sure, before the work, that it can be done within the limits, and its report written.
    pub(super) fn admit(&self, takes: Takes) -> Result<()> {
        self.limits.admit(takes, rayon::current_num_threads())?;
        self.inputs_are_safe()
    }

    /// Makes sure, before the work, that what was read so far is not where the report will be.
    pub(super) fn inputs_are_safe(&self) -> Result<()> {
        match &self.out {
            Some(out) => self.folder(out).check_inputs(&inputs::so_far().paths(), &provenance::USUAL_NAMES),
            None => Ok(()),
        }
    }

    /// Room for what is too large to be kept until the report is written, where there will be one.
    pub(super) fn scratch(&self) -> Result<Option<Scratch>> {
        self.out.as_ref().map(|out| self.folder(out).scratch()).transpose()
    }

    /// Refuses a folder for what writes nothing.
    pub(super) fn writes_nothing(&self, what: &str) -> Result<()> {
        match self.out {
            Some(_) => {
                Err(Error::malformed(format!("{what} has nothing to write into --out"), "leave out --out"))
            }
            None => Ok(()),
        }
    }

    /// Makes and writes a report where there is a folder for it; what that took.
    pub(super) fn report(&self, answer: &str, make: impl FnOnce() -> Result<Bundle>) -> Result<Work> {
        let mut work = Work::default();
        let Some(out) = &self.out else {
            work.spare(Thing::Reports, Reason::NotAsked, 1);
            return Ok(work);
        };
        let bundle = make()?;
        self.write(&bundle, out, Some(&with_settings(answer, &self.set)))?;
        work.compute(Thing::Reports, 1);
        work.compute(Thing::Figures, bundle.figures() as u64);
        Ok(work)
    }

    /// Prints a result that has its ledger in it, and with `--stats` the ledger.
    pub fn answer(&self, json: &impl serde::Serialize, text: &str, work: &Work) -> Result<()> {
        if self.stats {
            self.note(text::stats(work).trim_end());
        }
        self.print(json, text)
    }

    /// Prints a result that has no ledger in it, with `stats` beside its keys.
    pub fn answer_with(&self, mut json: serde_json::Value, text: &str, work: &Work) -> Result<()> {
        if let Some(object) = json.as_object_mut() {
            object.insert("stats".into(), json::value(work)?);
        }
        self.answer(&json, text, work)
    }

    /// Prints a result: JSON with `--json`, with the version of the program and of its form, else the text.
    pub(super) fn print(&self, json: &impl serde::Serialize, text: &str) -> Result<()> {
        let of_library = self.said_of_library.get().map_or(&[][..], Vec::as_slice);
        if let Some(kept) = &self.kept {
            let answer = answer_json(json, of_library, &self.set)?;
            let answer = serde_json::from_str(&answer)
                .map_err(|error| Error::malformed(error.to_string(), "report this as a bug"))?;
            if let Ok(mut kept) = kept.lock() {
                *kept = Some(answer);
            }
            return Ok(());
        }
        let text = if self.json {
            answer_json(json, of_library, &self.set)?
        } else {
            Stream::Out.answer(with_settings(text, &self.set).trim_end())
        };
        put(&text)
    }

    pub(super) fn study(&self, path: &Path, by: Option<hadar_scenario::DistanceKind>) -> Result<Study> {
        let mut scenario = Scenario::from_written(&self.written(path)?)?;
        if let Some(by) = by {
            scenario.requirement.by = by;
        }
        scenario.alternatives.skip_uncovered |= self.skip_uncovered;
        let study = Study::new_skipping(&scenario, &self.library()?, self.skipping())?;
        self.admit(study.takes())?;
        Ok(study)
    }

    /// The same files with tables in the format that was asked for.
    pub(super) fn formatted<'b>(&self, bundle: &'b Bundle) -> Result<Cow<'b, Bundle>> {
        let mut bundle = Cow::Borrowed(bundle);
        if self.format.is_some() {
            bundle.to_mut().add_parquet()?;
        }
        Ok(bundle)
    }

    /// Who makes the report of what.
    pub(super) fn provenance(&self) -> Result<Provenance> {
        self.provenance_with(&BTreeMap::new())
    }

    /// The same, where more of what is built in was used than was noted.
    pub(super) fn provenance_with(&self, built_in: &BTreeMap<String, Input>) -> Result<Provenance> {
        let mut now = provenance::of_this_run(self.seed, &self.of_others)?;
        now.inputs.retain(|input| !built_in.contains_key(&input.path));
        now.inputs.extend(built_in.values().cloned());
        Ok(match &self.remade {
            Some(remade) => remade.provenance(now),
            None => now,
        })
    }

    /// Writes the files, with the answer and a page of all where there is an answer, and says where.
    pub fn write(&self, bundle: &Bundle, out: &Path, answer: Option<&str>) -> Result<()> {
        let bundle = self.formatted(bundle)?;
        let (provenance, inputs) = (self.provenance()?, inputs::so_far().paths());
        let about = About { answer: answer.unwrap_or_default(), provenance: &provenance, inputs: &inputs };
        let folder = self.folder(out);
        let count = match answer {
            Some(_) => bundle.write_report(&folder, &about)?,
            None => bundle.write_files(&folder, &about)?,
        };
        let (page, out) = (out.join("report.html"), out.join(""));
        let look = answer.map_or_else(String::new, |_| format!("; {} shows them all", page.display()));
        self.note(&format!("wrote {count} files to {}{look}", out.display()));
        Ok(())
    }
}

/// Prints a text and ends its last line.
pub(super) fn put(text: &str) -> Result<()> {
    match writeln!(std::io::stdout(), "{text}") {
        // A reader that has seen enough (`| head`) is no error.
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Error::file("print the result", Path::new("stdout"), error))
        }
        _ => Ok(()),
    }
}

type Places<'a> = [&'a ArgMatches; 2];

/// The value of a flag, where a command has it and it was given.
fn one<T: Clone + Send + Sync + 'static>(places: Places<'_>, id: &str) -> Option<T> {
    places.iter().find_map(|place| place.try_get_one::<T>(id).ok().flatten().cloned())
}

fn many<T: Clone + Send + Sync + 'static>(places: Places<'_>, id: &str) -> Vec<T> {
    let values = places.iter().find_map(|place| place.try_get_many::<T>(id).ok().flatten());
    values.into_iter().flatten().cloned().collect()
}

fn yes(places: Places<'_>, id: &str) -> bool {
    places.iter().any(|place| place.try_get_one::<bool>(id).ok().flatten() == Some(&true))
}

/// A value given to --set.
fn setting(text: &str) -> std::result::Result<Setting, String> {
    Setting::parse(text, "--set").map_err(|error| error.to_string())
}

/// A time given to --time-limit.
fn time(text: &str) -> std::result::Result<Duration, String> {
    budget::time(text).map_err(|error| error.to_string())
}

/// A size given to --memory-limit.
fn memory(text: &str) -> std::result::Result<u64, String> {
    budget::size(text).map_err(|error| error.to_string())
}

/// A day as a flag has it.
pub(super) fn day(text: &str) -> std::result::Result<Date, String> {
    hadar_scenario::day(text).ok_or_else(|| "write year, month and day, as in 2029-09-01".to_owned())
}

/// The code of a condition given to a flag.
pub(super) fn condition(text: &str) -> std::result::Result<String, String> {
    known_condition(text).map(|()| text.to_owned()).map_err(|error| error.to_string())
}

/// Refuses a code that no condition has.
pub(super) fn known_condition(code: &str) -> Result<()> {
    let codes = Condition::codes();
    if codes.iter().any(|one| one == code) {
        return Ok(());
    }
    Err(Error::unknown_name("condition", code, codes.iter().map(String::as_str)))
}

/// A number given to a flag.
pub(super) fn plain_number(text: &str) -> std::result::Result<f64, String> {
    text.parse().map_err(|error: std::num::ParseFloatError| {
        decimal_comma(text).map_or_else(|| error.to_string(), |comma| comma.to_string())
    })
}

/// Formats of tables, as a flag.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
pub(super) enum Format {
    /// Apache Parquet
    Parquet,
}

/// The distance that decides, as a flag.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
pub(super) enum By {
    /// To the closest confuser, the most similar state of the alternative: the limit
    Nearest,
    /// The paper's local distance, calibrated camera (S27)
    Local,
    /// The paper's local distance with unknown gain (S29)
    LocalUnknownGain,
}

impl From<By> for hadar_scenario::DistanceKind {
    fn from(by: By) -> Self {
        match by {
            By::Nearest => Self::Nearest,
            By::Local => Self::Local,
            By::LocalUnknownGain => Self::LocalUnknownGain,
        }
    }
}
