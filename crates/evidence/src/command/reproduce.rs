//! `hadar reproduce`: the paper's figures and tables made again, with a ledger of what agrees.

use crate::reproduce::{Effort, FurtherStudy, Item, Line, Order, Verdict, markdown, table};
use hadar::demand::{Reason, Thing, Work};
use hadar::error::{Error, Result};
use hadar::material::Library;
use hadar_cli::evidence::ReproduceArgs;
use hadar_cli::{Bar, Global};
use hadar_report::bundle::Bundle;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

/// What is printed with `--json`.
#[derive(serde::Serialize)]
struct Output {
    effort: &'static str,
    seed: u64,
    ledger: Vec<Line>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    studies: Vec<Finding>,
    stats: Work,
}

/// What came of a study that is no figure of the paper.
#[derive(serde::Serialize)]
struct Finding {
    study: &'static str,
    title: &'static str,
    finding: String,
}

/// What is asked for.
struct Asked {
    items: Vec<Item>,
    studies: Vec<FurtherStudy>,
}

pub(super) fn run(args: &ReproduceArgs, global: &Global) -> Result<ExitCode> {
    let Asked { items, studies } = asked(&args.items)?;
    let library = library(&items, &studies, global)?;
    let effort = if args.quick { Effort::Quick } else { Effort::Full };
    let order = Order { effort, seed: global.seed };
    let count = items.len() + studies.len();
    if let Some(out) = &global.out {
        let folders =
            items.iter().map(|item| item.name().to_owned()).chain(studies.iter().map(|study| study.folder()));
        folders.map(|name| out.join(name)).try_for_each(|folder| global.folder(&folder).check())?;
        if items.len() == Item::ALL.len() {
            global.folder(out).check()?;
        }
    }
    let mut stats = Work::default();
    stats.compute(Thing::Reproductions, items.len() as u64);
    stats.spare(Thing::Reproductions, Reason::NotAsked, (Item::ALL.len() - items.len()) as u64);
    let mut ledger = Vec::new();
    for (i, item) in items.iter().enumerate() {
        let folder = global.out.as_ref().map(|out| out.join(item.name()));
        let watch = Watch::start(global, item.name());
        let made = item.make(order, &|done, total| watch.bar.set(done, total))?;
        watch.stop(&format!("{} of {count}: {}", i + 1, item.title()));
        stats.add(&write(global, &made.bundle, folder, &text(&[*item], &made.lines))?);
        ledger.extend(made.lines);
    }
    let mut findings = Vec::new();
    for (i, study) in studies.iter().enumerate() {
        let watch = Watch::start(global, study.name());
        let (bundle, finding) = study.make(order, &library, &|done, total| watch.bar.set(done, total))?;
        watch.stop(&format!("{} of {count}: {}", items.len() + i + 1, study.title()));
        let folder = global.out.as_ref().map(|out| out.join(study.folder()));
        stats.add(&write(global, &bundle, folder, &finding)?);
        findings.push(Finding { study: study.name(), title: study.title(), finding });
    }
    if let Some(out) = global.out.as_ref().filter(|_| items.len() == Item::ALL.len()) {
        let mut bundle = Bundle::about(Some("What of the paper comes out again"));
        bundle.add_table("ledger.csv", table(&ledger))?;
        bundle.add("README.md", overview(&items, effort, &ledger));
        global.write(&bundle, out, Some(&text(&items, &ledger)))?;
    }
    let mut text = if items.is_empty() { String::new() } else { text(&items, &ledger) };
    for found in &findings {
        let gap = if text.is_empty() { "" } else { "\n" };
        text.push_str(&format!("{gap}{}\n\n{}\n", found.title, found.finding));
    }
    let effort = if args.quick { "quick" } else { "full" };
    let output = Output { effort, seed: global.seed, ledger, studies: findings, stats };
    global.answer(&output, &text, &output.stats)?;
    Ok(ExitCode::SUCCESS)
}

/// A bar and a clock.
struct Watch<'a> {
    global: &'a Global,
    bar: Bar,
    start: Instant,
}

impl<'a> Watch<'a> {
    fn start(global: &'a Global, name: &'static str) -> Self {
        Self { global, bar: global.progress(name), start: Instant::now() }
    }

    fn stop(&self, what: &str) {
        self.bar.finish();
        self.global.note(&format!("{what}, {:.1} s", self.start.elapsed().as_secs_f64()));
    }
}

/// Writes what was made where there is a folder for it; what that took.
fn write(global: &Global, bundle: &Bundle, folder: Option<PathBuf>, answer: &str) -> Result<Work> {
    let mut stats = Work::default();
    let figures = bundle.figures() as u64;
    if let Some(folder) = folder {
        global.write(bundle, &folder, Some(answer))?;
        stats.compute(Thing::Reports, 1);
        stats.compute(Thing::Figures, figures);
    } else {
        stats.spare(Thing::Reports, Reason::NotAsked, 1);
        stats.spare(Thing::Figures, Reason::NotAsked, figures);
    }
    Ok(stats)
}

fn asked(names: &[String]) -> Result<Asked> {
    let mut asked = Asked { items: Vec::new(), studies: Vec::new() };
    if names.iter().any(|name| name == "all") {
        if names.len() > 1 {
            return Err(Error::malformed("`all` beside other names", "write `all` alone, or the names"));
        }
        return Ok(Asked { items: Item::ALL.to_vec(), ..asked });
    }
    for name in names {
        match FurtherStudy::from_name(name) {
            Some(study) if asked.studies.contains(&study) => {}
            Some(study) => asked.studies.push(study),
            None => {
                let item = Item::from_name(name)?;
                if !asked.items.contains(&item) {
                    asked.items.push(item);
                }
            }
        }
    }
    Ok(asked)
}

/// The materials of the studies: the built-in ones, but those of --library for studies of other ones.
fn library(items: &[Item], studies: &[FurtherStudy], global: &Global) -> Result<Library> {
    let own = studies.iter().find_map(|study| study.own_library().map(|what| (study.name(), what)));
    if let Some((name, _)) = own
        && items.len() + studies.len() > 1
    {
        let found = format!("{name} is made with another library than the rest");
        return Err(Error::malformed(found, "ask for it alone"));
    }
    if let Some((name, what)) = own
        && global.library.is_empty()
    {
        let (what, instead) = what.split_once("; ").unwrap_or((what, "give it with --library"));
        return Err(Error::malformed(format!("{name} {what}"), instead));
    }
    let own = own.is_some();
    if !own && !global.library.is_empty() {
        let found = "the paper's figures are made with the built-in library";
        return Err(Error::malformed(found, "leave out --library"));
    }
    let adds = studies.contains(&FurtherStudy::PersonOrRobot);
    global.with_own(if own && !adds { Library::empty() } else { Library::embedded()? })
}

fn counts(ledger: &[Line]) -> String {
    let of = |verdicts: &[Verdict]| ledger.iter().filter(|line| verdicts.contains(&line.verdict)).count();
    let compared = ledger.len() - of(&[Verdict::NoValuePrinted, Verdict::NotInThePaper]);
    let mut counts = format!(
        "Of {compared} values and statements of the paper {} come out again, {} more under a choice that it does not state, {} do not",
        of(&[Verdict::Reproduced]),
        of(&[Verdict::UnderAChoice]),
        of(&[Verdict::NotReproduced])
    );
    for (verdict, words) in [
        (Verdict::PaperInError, "are errors in the paper"),
        (Verdict::TooFewToSay, "left open by too few experiments"),
    ] {
        if of(&[verdict]) > 0 {
            counts.push_str(&format!(", {} {words}", of(&[verdict])));
        }
    }
    counts + "."
}

fn text(items: &[Item], ledger: &[Line]) -> String {
    let names: Vec<&str> = items.iter().map(|item| item.title()).collect();
    let mut text = format!("{}\n\n{}\n", counts(ledger), names.join("\n"));
    for line in ledger {
        text.push_str(&format!(
            "\n{}: {}\n  paper  {}\n  ours   {}\n  {}: {}\n",
            line.place,
            line.quantity,
            line.paper,
            line.ours,
            line.verdict.words(),
            line.why
        ));
    }
    text
}

fn overview(items: &[Item], effort: Effort, ledger: &[Line]) -> String {
    let made = match effort {
        Effort::Full => "Made by `hadar reproduce all`",
        Effort::Quick => "Some of the experiments only, made by `hadar reproduce all --quick`",
    };
    let mut page = format!(
        "# What of the paper comes out again\n\n{made}. Paper: Bao et al., \
         Nature 619, 743 (2023), doi:10.1038/s41586-023-06174-6.\n\n{}\n\n",
        counts(ledger)
    );
    for item in items {
        page.push_str(&format!("* [{}]({}/README.md)\n", item.title(), item.name()));
    }
    page.push_str(
        "\nNot made again here: Fig. 3a's 72.5 degC, the formulas S28 and S31 to S34, Fig. S10 (a trained network), the optical images of Fig. 4. A \
         verdict of numbers is computed: the same within the tolerance printed beside it.\n",
    );
    page.push_str(
        "\nFurther studies, made by `hadar reproduce` when asked for by name: [exact decisions](exact_probability/README.md), \
         [the paper's own library](library_figures/README.md), [priors](priors/README.md), \
         [heat cubes against their limits](decompose_limits/README.md), [emissivity without a library](emissivity_from_data/README.md), \
         [distances from the air](air_ranging/README.md), [stripes of a cube](stripes/README.md), \
         [person or robot, of several spectra each](person_or_robot/README.md), \
         [calibration of a spectrometer](ftir_calibration/README.md); and [run time against error](accuracy/README.md), by `hadar accuracy`.\n\n",
    );
    page.push_str(&markdown(ledger));
    page
}

#[cfg(test)]
mod tests {
    use super::{FurtherStudy, Item};

    /// The help of the command is written where the items are not known.
    #[test]
    fn the_help_names_all_that_can_be_made() {
        let path = hadar_testing::repository().join("crates/cli/src/command/evidence.rs");
        let text = std::fs::read_to_string(path).unwrap();
        let help = text.split("pub struct ReproduceArgs").nth(1).and_then(|rest| rest.split("#[arg").next());
        let is_part = |letter: char| letter.is_alphanumeric() || letter == '-';
        let words: Vec<&str> = help.unwrap().split(|letter| !is_part(letter)).collect();
        let names = Item::ALL.iter().map(|item| item.name());
        let missing: Vec<&str> = names
            .chain(FurtherStudy::ALL.iter().map(|study| study.name()))
            .filter(|name| !words.contains(name))
            .collect();
        assert!(missing.is_empty(), "not in the help of `hadar reproduce`: {missing:?}");
    }
}
