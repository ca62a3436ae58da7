//! `hadar find` as text: what to take and on which conditions, what else meets, and why the others do not.

pub mod rows;

use crate::text::columns::{Columns, left, right};
use crate::text::footing::warnings;
use crate::text::numbers::{between, listed, significant};
use crate::words::size::text::solutions;
use crate::words::{Say, conditions};
use hadar::instrument::presets;
use hadar::words::{length, quantity};
use hadar_scenario::Units;
use hadar_scenario::find::{FilterSupply, Merit};
use hadar_study::Condition;
use hadar_study::find::{Choice, Failed, FilterUsed, FindAnswer, LensUsed, Why};
use std::fmt::Write as _;

/// Filters that are named in a sentence at most.
const NAMED: usize = 8;

/// What to take, and everything behind it.
#[must_use]
pub fn text(found: &FindAnswer) -> String {
    let mut out = format!("{}\n\n", sentence(found));
    if let Some(best) = &found.best {
        out += &bought(best);
        out += &conditions::paragraph(best.conditions(), true);
    }
    let merits: Vec<&str> = merits(found).iter().map(|merit| merit.name()).collect();
    let head = match merits[..] {
        [only] => format!("Least {only}"),
        _ => format!("Pareto-optimal in {}, sorted in this order", listed(&merits)),
    };
    out += &table(&head, &found.listed);
    out += &of_others(found);
    out += &table("The best of every other camera that meets the requirement", &found.also);
    out += &table("Undecided: d reaches the requirement by the search, not by the proof", &found.undecided);
    if let Some(near) = &found.near {
        out += &table("The closest", std::slice::from_ref(&near.choice));
        out += &solutions(&near.sizing, Units::of(&found.scenario.source));
    }
    out += &failures(found);
    out += &missing(found);
    out += &footing(found);
    if let Some(best) = &found.best {
        out += &warnings(&best.warnings);
    }
    out
}

/// The answer.
#[must_use]
pub fn sentence(found: &FindAnswer) -> String {
    let required = significant(found.required_distance, 4);
    let Some(best) = &found.best else {
        let judged = found.failed.iter().filter(|one| one.upper.is_some()).count();
        let all_judged =
            !found.failed.iter().any(|one| matches!(one.why, Why::Distance { all_judged: false, .. }));
        let near = found.near.as_ref().map_or_else(String::new, |near| {
            let choice = &near.choice;
            let d = significant(choice.upper, 3);
            format!(" The closest is {}: d is {d} at most.", called(choice))
        });
        if !found.undecided.is_empty() {
            let cameras: Vec<&str> = found.undecided.iter().map(|choice| choice.camera.as_str()).collect();
            return format!(
                "Undecided: no camera is proved to reach d = {required}; {} may.{near}",
                listed(&cameras)
            );
        }
        return match judged {
            0 => "No: no camera can be judged; the figures that each lacks are listed below.".into(),
            1 if all_judged => {
                format!("No: the only camera that can be judged does not reach d = {required}.{near}")
            }
            _ if !all_judged => format!(
                "No camera was found that reaches d = {required}; only {judged} of them with their lenses were searched.{near}"
            ),
            _ => format!(
                "No: none of the {judged} cameras that can be judged reaches d = {required} with its lenses.{near}"
            ),
        };
    };
    let first = match merits(found).first() {
        Some(Merit::Price) if best.price.is_some() => {
            match found.listed.iter().chain(&found.also).all(|one| one.price.is_some()) {
                true => "The cheapest that meets",
                false => "The cheapest of known price that meets",
            }
        }
        Some(Merit::Price) if merits(found).len() == 1 => {
            "No price is known; the one of largest d that meets"
        }
        Some(Merit::Price) => "No price is known; the best by the other criteria that meets",
        Some(Merit::Time) => "The fastest that meets",
        Some(Merit::Filters) => "The one with the fewest filters that meets",
        Some(Merit::Aperture) => "The one with the smallest lens that meets",
        None => "What meets",
    };
    let first = match &found.rule {
        Some(_) => format!("{first} the rule in all of its scenes is"),
        None => format!("{first} the requirement is"),
    };
    let open: Vec<&Condition> = Condition::open(best.conditions()).collect();
    let subject = match open.split_first() {
        None => String::new(),
        Some((one, [])) => format!(", if {}", one.say()),
        Some((one, [_])) => format!(", if {}, and under 1 more condition", one.say()),
        Some((one, rest)) => format!(", if {}, and under {} more conditions", one.say(), rest.len()),
    };
    format!(
        "{first} {}{}{subject}.",
        called(best),
        paid(best).map_or_else(String::new, |paid| format!(", {paid}"))
    )
}

/// A camera with what is before it, in a line.
fn called(choice: &Choice) -> String {
    let filters = match choice.filters.len() {
        0 => String::new(),
        1 => " behind 1 filter".into(),
        count => format!(" behind {count} filters"),
    };
    let frames = if choice.frames == 1 { "1 frame".into() } else { format!("{} frames", choice.frames) };
    format!(
        "{} with {}{filters} and {frames} ({})",
        choice.camera,
        lens(&choice.lens),
        quantity(choice.time_s, "s")
    )
}

fn lens(lens: &LensUsed) -> String {
    format!("f/{} {} mm", significant(lens.f_number, 3), significant(1e3 * lens.focal_length_m, 3))
}

/// What is known of its price.
fn paid(choice: &Choice) -> Option<String> {
    let price = choice.price.as_ref()?;
    Some(match choice.price_without.as_slice() {
        [] => price.to_string(),
        parts => format!("{price} without {}", listed(parts)),
    })
}

/// What is to be bought, part by part.
fn bought(best: &Choice) -> String {
    let mut out = String::from("To be bought\n");
    let mut line = |label: &str, value: &str| {
        let _ = writeln!(out, "  {label:<10} {value}");
    };
    let preset = presets::all().ok().and_then(|all| all.iter().find(|preset| preset.name == best.camera));
    line(
        "camera",
        &preset
            .map_or_else(|| best.camera.clone(), |preset| format!("{}: {}", best.camera, preset.description)),
    );
    match (&best.lens.name, &best.lens.document) {
        (Some(name), Some(document)) => line("lens", &format!("{} ({name}; {document})", lens(&best.lens))),
        (Some(name), None) => line("lens", &format!("{} ({name})", lens(&best.lens))),
        (None, _) => line("lens", &lens(&best.lens)),
    }
    for (index, filter) in best.filters.iter().enumerate() {
        line(if index == 0 { "filters" } else { "" }, &of_filter(filter));
    }
    line("price", &paid(best).unwrap_or_else(|| "not known".into()));
    if let Some(source) = preset.and_then(|preset| preset.price_source.as_ref()) {
        line("", source);
    }
    if let Some(exposure_s) = best.exposure_s {
        line("exposure", &format!("{}, shortened so that no reading saturates", quantity(exposure_s, "s")));
    }
    out.push('\n');
    out
}

fn of_filter(filter: &FilterUsed) -> String {
    let [from, to] = filter.range_um.map(|um| significant(um, 4));
    match &filter.name {
        Some(name) => format!("{name}, {from} to {to} um"),
        None => format!("ideal, {from} to {to} um"),
    }
}

/// What is to be small.
fn merits(found: &FindAnswer) -> Vec<Merit> {
    found.scenario.find.as_ref().map(|spec| spec.least.clone()).unwrap_or_default()
}

/// Choices in a table.
fn table(head: &str, choices: &[Choice]) -> String {
    if choices.is_empty() {
        return String::new();
    }
    let width = choices.iter().map(|choice| choice.camera.chars().count()).max().unwrap_or(6).max(6);
    let mut columns = Columns::new([
        left("camera", width),
        left("lens", 14),
        right("filters", 7),
        right("frames", 6),
        right("time", 8),
        right("aperture", 8),
        right("d", 14),
        left("price", 5),
    ]);
    for choice in choices {
        columns.row([
            choice.camera.clone(),
            lens(&choice.lens),
            choice.filters.len().to_string(),
            choice.frames.to_string(),
            quantity(choice.time_s, "s"),
            length(choice.aperture_m),
            between([choice.lower, choice.upper], 3),
            paid(choice).unwrap_or_else(|| "not known".into()),
        ]);
        if !choice.filters.is_empty() {
            let names = choice.filters.iter().take(NAMED).map(|filter| match &filter.name {
                Some(name) => name.clone(),
                None => of_filter(filter),
            });
            columns.line(&format!("    {}", names.collect::<Vec<_>>().join(", ")));
        }
    }
    format!("{head}\n{}\n", columns.text())
}

/// Conditions that another choice has and the first does not.
fn of_others(found: &FindAnswer) -> String {
    let codes = |choice: &Choice| -> Vec<String> {
        Condition::open(choice.conditions()).map(Condition::code).collect()
    };
    let of_best = found.best.as_ref().map(codes).unwrap_or_default();
    let mut out = String::new();
    for choice in found.listed.iter().skip(1).chain(&found.also) {
        let more: Vec<String> = codes(choice).into_iter().filter(|code| !of_best.contains(code)).collect();
        if !more.is_empty() {
            let _ = writeln!(out, "  {}: {}", called(choice), listed(&more));
        }
    }
    if out.is_empty() { out } else { format!("Further conditions of the others\n{out}\n") }
}

/// Why the others do not meet.
fn failures(found: &FindAnswer) -> String {
    let shown: Vec<&Failed> = found
        .failed
        .iter()
        .filter(|one| !matches!(one.why, Why::Figures { .. } | Why::NoLens | Why::NotSold))
        .collect();
    if shown.is_empty() {
        return String::new();
    }
    let width = shown.iter().map(|one| one.camera.chars().count()).max().unwrap_or(6).max(6);
    let mut columns =
        Columns::new([left("camera", width), left("lens", 14), right("d at most", 9), left("why", 3)]);
    for one in shown {
        columns.row([
            one.camera.clone(),
            one.lens.as_ref().map_or_else(|| "-".into(), lens),
            one.upper.map_or_else(|| "-".into(), |d| significant(d, 3)),
            why(one, found.required_distance),
        ]);
    }
    format!("Do not meet d = {}\n{}\n", significant(found.required_distance, 4), columns.text())
}

/// Why a camera does not meet.
#[must_use]
pub fn why(failed: &Failed, required: f64) -> String {
    let short = failed.upper.filter(|upper| *upper > 0.0).map_or_else(String::new, |upper| {
        format!("; short by a factor {}", significant(required / upper, 2))
    });
    match &failed.why {
        Why::Figures { missing } => format!("no document states {}", listed(missing)),
        Why::NoLens => "no document names a lens for it: give find.lenses".into(),
        Why::NoFilter { range_um: [from, to] } => {
            format!(
                "no filter lies within its range of {} to {} um",
                significant(*from, 3),
                significant(*to, 3)
            )
        }
        Why::Refused { because } => because.clone(),
        Why::NotSold => "it is not sold as a camera".into(),
        Why::AllFilters { frames_would_do: true } => {
            format!("fails even with all filters at once and the most frames; more frames would do{short}")
        }
        Why::AllFilters { frames_would_do: false } => {
            format!("fails even with all filters at once, for any number of frames{short}")
        }
        Why::Distance { filters, frames, all_judged, is_cut } => {
            let searched = if *all_judged { "" } else { " among those that were searched" };
            let frames = if *frames == 1 { "1 frame".into() } else { format!("{frames} frames") };
            let filters = if *filters == 1 { "1 filter".into() } else { format!("up to {filters} filters") };
            let cut = if *is_cut { ", and more exceed the time or the motion allowed" } else { "" };
            format!("no choice of {filters} and {frames} suffices{searched}{cut}{short}")
        }
        Why::Time { takes_s } => format!("even its fewest readings take {}", quantity(*takes_s, "s")),
        Why::Motion => "the target moves by a pixel or more while its bands are exposed".into(),
        Why::FullWell => "a reading exceeds the full well at the fixed exposure".into(),
        Why::Undecided => "undecided".into(),
        Why::NotAsAWhole => "its best choice distinguishes every pair but does not meet the requirement as a whole: check it with `hadar size` or `hadar rule`".into(),
    }
}

/// What the cameras lack that could not be asked, in one block to be filled in.
fn missing(found: &FindAnswer) -> String {
    let mut out = String::new();
    let of = |is_so: &dyn Fn(&Why) -> bool| -> Vec<&str> {
        found.failed.iter().filter(|one| is_so(&one.why)).map(|one| one.camera.as_str()).collect()
    };
    let (not_sold, no_lens) = (of(&|why| *why == Why::NotSold), of(&|why| *why == Why::NoLens));
    if !not_sold.is_empty() {
        let _ = writeln!(
            out,
            "Not considered, since they are not sold as cameras: {}. Name one in find.cameras to include it.\n",
            listed(&not_sold)
        );
    }
    if !no_lens.is_empty() {
        let _ = writeln!(
            out,
            "No lens fits what is stated of {}, and no document names one: give find.lenses.\n",
            listed(&no_lens)
        );
    }
    let mut blocks = String::new();
    for one in &found.failed {
        if let Why::Figures { missing } = &one.why {
            let _ = writeln!(blocks, "  [[camera]]\n  name = \"my-{0}\"\n  preset = \"{0}\"", one.camera);
            for line in presets::Missing(missing.clone()).lines() {
                let _ = writeln!(blocks, "  {line}");
            }
        }
    }
    if !blocks.is_empty() {
        let head = "No document states all of these figures; replace the dots, and save this as a file for --cameras";
        let _ = writeln!(out, "{head}\n{blocks}");
    }
    out
}

/// What the answer rests on as a whole.
fn footing(found: &FindAnswer) -> String {
    let Some(spec) = &found.scenario.find else { return String::new() };
    let put = match &found.rule {
        Some(_) => format!(
            "what meets was checked against the whole rule as by `hadar rule`, after a search in {} of its scenes",
            found.scenes
        ),
        None => "every camera that meets was checked by `hadar size` with its scenario".into(),
    };
    let mut notes = vec![
        format!("{put}; a price is a class of one piece where a public page states one"),
        "several filters are exposed one after the other; of all choices of as many filters the most informative is taken"
            .to_owned(),
    ];
    match &spec.filters.from {
        FilterSupply::Any { step_um } => notes.push(format!(
            "filters are ideal, with edges at multiples of {} um, which no maker sells",
            significant(*step_um, 3)
        )),
        FilterSupply::List(hadar_scenario::FilterList::Catalogue) => notes.push(
            "filters are shapes of cameras/filters.toml, bands of instruments and choices: no list of stock filters with prices was found".into(),
        ),
        FilterSupply::List(_) => {}
    }
    if !found.filters_left_out.is_empty() {
        notes.push(format!(
            "filters not considered, since a spectrum of the scene does not cover them: {}",
            listed(&found.filters_left_out)
        ));
    }
    if found.exposures_tried {
        notes.push("where a pixel would saturate, exposures a factor 2 apart are tried, each with the filters that do not saturate it".into());
    }
    let lines: Vec<String> = notes.iter().map(|note| format!("  {note}\n")).collect();
    format!("Assumptions\n{}", lines.concat())
}
