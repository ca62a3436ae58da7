//! `hadar reproduce`: the paper's figures and tables made again, with a ledger of what agrees.

use super::Global;
use crate::reproduce::{Effort, Item, Line, Order, Verdict, markdown, table};
use clap::Args;
use hadar::demand::{Reason, Thing, Work};
use hadar::error::{Error, Result};
use hadar_report::bundle::Bundle;
use std::process::ExitCode;
use std::time::Instant;

#[derive(Debug, Args)]
pub(super) struct ReproduceArgs {
    /// Figures and tables: fig3b, figs7, fig3c, fig4, figs12, edfig6, edfig9, tabs2, tabs5, policy, or all
    #[arg(value_name = "ID", default_value = "all")]
    items: Vec<String>,
    /// Some of the experiments only: within a minute on two cores
    #[arg(long)]
    quick: bool,
}

/// What is printed with `--json`.
#[derive(serde::Serialize)]
struct Output {
    effort: &'static str,
    seed: u64,
    ledger: Vec<Line>,
    stats: Work,
}

pub(super) fn run(args: &ReproduceArgs, global: &Global) -> Result<ExitCode> {
    if global.only_library || !global.library.is_empty() {
        let found = "the paper's figures are made with the built-in library";
        return Err(Error::malformed(found, "leave out --library and --only-library"));
    }
    let items = items(&args.items)?;
    let effort = if args.quick { Effort::Quick } else { Effort::Full };
    let order = Order { effort, seed: global.seed };
    let mut ledger = Vec::new();
    let mut stats = Work::default();
    stats.compute(Thing::Reproductions, items.len() as u64);
    stats.spare(Thing::Reproductions, Reason::NotAsked, (Item::ALL.len() - items.len()) as u64);
    for (i, item) in items.iter().enumerate() {
        let start = Instant::now();
        let bar = global.progress(item.name());
        let folder = global.out.as_ref().map(|out| out.join(item.name()));
        let place = folder.clone().unwrap_or_default();
        let made = item.make(order, &place, &|done, total| bar.set(done, total))?;
        bar.finish();
        let took = start.elapsed().as_secs_f64();
        global.note(&format!("{} of {}: {}, {took:.1} s", i + 1, items.len(), item.title()));
        let figures = made.bundle.figures() as u64;
        if let Some(folder) = folder {
            global.write(&made.bundle, &folder)?;
            stats.compute(Thing::Reports, 1);
            stats.compute(Thing::Figures, figures);
        } else {
            stats.spare(Thing::Reports, Reason::NotAsked, 1);
            stats.spare(Thing::Figures, Reason::NotAsked, figures);
        }
        ledger.extend(made.lines);
    }
    if let Some(out) = global.out.as_ref().filter(|_| items.len() == Item::ALL.len()) {
        let mut bundle = Bundle::default();
        bundle.add("ledger.csv", table(&ledger).to_csv()?);
        bundle.add("README.md", overview(&items, effort, &ledger));
        global.write(&bundle, out)?;
    }
    let text = text(&items, &ledger);
    let effort = if args.quick { "quick" } else { "full" };
    let output = Output { effort, seed: global.seed, ledger, stats };
    global.answer(&output, &text, &output.stats)?;
    Ok(ExitCode::SUCCESS)
}

fn items(names: &[String]) -> Result<Vec<Item>> {
    if names.iter().any(|name| name == "all") {
        if names.len() > 1 {
            return Err(Error::malformed("`all` beside other names", "write `all` alone, or the names"));
        }
        return Ok(Item::ALL.to_vec());
    }
    let mut items = Vec::new();
    for name in names {
        let item = Item::from_name(name)?;
        if !items.contains(&item) {
            items.push(item);
        }
    }
    Ok(items)
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
        (Verdict::PaperInError, "in error in the paper"),
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
        "\nFurther studies, made by the programs of `examples/`: [exact decisions](exact_probability/README.md), \
         [the paper's own library](library_figures/README.md), [priors](priors/README.md); and [run time against error](accuracy/README.md), by `hadar accuracy`.\n\n",
    );
    page.push_str(&markdown(ledger));
    page
}
