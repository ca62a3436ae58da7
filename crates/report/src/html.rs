//! A report as one page: the verdict, its conditions, two pictures, the answer as tables, warnings with what to do, who made it of what; all
//! other pictures, the tables of its files and the question are folded, and not printed.
//!
//! One file that loads nothing from elsewhere, so that it can be mailed, archived and printed as it is. Its script reads values off the
//! pictures ([`READINGS`]); nothing else needs it. Every picture has its title as its name, every table a caption and heads of rows and columns; order and headings are those
//! of reading. It is set for a telephone, a screen and paper by one style sheet.

mod answer;
pub(crate) mod element;
mod printed;
mod table;

use self::element::{escape, table, wide};
use crate::manifest::{Input, Provenance, VERSION};
use crate::table::Table;
use crate::text::footing::RESTS_ON;
use crate::words::warnings::of_code;
use crate::words::{Say, page as words};
use hadar_study::Warning;
use hadar_study::warning::{Code, by_code};
use std::fmt::Write as _;

const STYLE: &str = include_str!("html/style.css");
/// Script of a page that reads values off its pictures: `readable(figure, focused, svg)`.
pub const READINGS: &str = include_str!("html/readings.js");

/// A figure.
pub(crate) struct Drawing<'a> {
    /// Of its files, without ending.
    pub(crate) name: &'a str,
    pub(crate) svg: &'a str,
    /// What is said of it beside its title; nothing where empty.
    pub(crate) said: &'a str,
}

/// What is on a page.
pub(crate) struct Page<'a> {
    pub(crate) title: Option<&'a str>,
    /// What stands before everything else, as HTML; nothing where empty.
    pub(crate) first: &'a str,
    /// The answer, as it is printed.
    pub(crate) answer: &'a str,
    pub(crate) drawings: Vec<Drawing<'a>>,
    /// Tables with the names of their files.
    pub(crate) tables: &'a [(String, Table)],
    pub(crate) warnings: &'a [Warning],
    /// What was asked: the name of a file that asks it again, and its text.
    pub(crate) asked: Option<(&'a str, &'a str)>,
    pub(crate) provenance: &'a Provenance,
}

/// The page as a file.
pub(crate) fn page(page: &Page<'_>) -> String {
    let answer = answer::Answer::of(page.answer);
    let title = escape(page.title.unwrap_or(words::TITLE));
    let mut sections = vec![
        Section::open("first", words::FIRST, page.first.to_owned()),
        Section::open("conditions", CONDITIONS, printed::html(&answer.conditions)),
        Section::open("assumptions", RESTS_ON, list(&answer.assumptions)),
    ];
    let (mut drawn, mut more) = (String::new(), String::new());
    let shown = most_telling(&page.drawings);
    for (i, drawing) in page.drawings.iter().enumerate() {
        let out = if shown.contains(&i) { &mut drawn } else { &mut more };
        out.push_str(&figure(i + 1, drawing));
    }
    sections.push(Section::open("pictures", "Pictures", drawn));
    sections.push(Section::open("answer", "Answer", printed::html(&answer.details)));
    sections.push(Section::open("warnings", "Warnings", warnings(page.warnings)));
    sections.push(Section::folded("more-pictures", MORE_PICTURES, more));
    let tables: String = page.tables.iter().map(|(name, rows)| table::html(name, rows)).collect();
    sections.push(Section::folded("tables", "Tables", tables));
    let asked = page.asked.map_or_else(String::new, |(name, text)| {
        let given = words::ASKED_AGAIN;
        format!("<p><code>{name}</code>: {given}</p>\n{}", verbatim(name, &escape(text.trim_end())))
    });
    sections.push(Section::folded("question", "The question", asked));
    sections.push(Section::open("provenance", "Provenance", provenance(page.provenance)));
    sections.retain(|section| !section.content.is_empty());

    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"generator\" content=\"hadar {VERSION}\">\n<title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n\
         <header>\n<h1>{title}</h1>\n<p class=\"verdict\">{}</p>\n<nav aria-label=\"Contents\">\n<ul>\n",
        escape(answer.verdict)
    );
    for Section { id, heading, .. } in &sections {
        let _ = writeln!(out, "<li><a href=\"#{id}\">{heading}</a></li>");
    }
    out.push_str("</ul>\n</nav>\n</header>\n<main>\n");
    for Section { id, heading, content, is_folded } in &sections {
        // Followed to its name, what is folded opens.
        let heading = format!("<h2 id=\"{id}-heading\">{heading}</h2>");
        let (class, begin, end) = match is_folded {
            true => (
                " class=\"folded\"",
                format!("<details>\n<summary>{heading}</summary>\n<div id=\"{id}\">"),
                "</div>\n</details>\n",
            ),
            false => ("", heading, ""),
        };
        let own = if *is_folded { format!("{id}-section") } else { (*id).to_owned() };
        let _ = writeln!(out, "<section id=\"{own}\"{class} aria-labelledby=\"{id}-heading\">");
        let _ = writeln!(out, "{begin}\n{content}{end}</section>");
    }
    let _ = write!(
        out,
        "</main>\n<script>\n{READINGS}for (const svg of document.querySelectorAll(\"figure svg\")) readable(svg.closest(\"figure\"), svg.closest(\".wide\"), svg);\n</script>\n</body>\n</html>\n"
    );
    out
}

/// The heading of what a yes holds only if, and of pictures that are folded.
const CONDITIONS: &str = "Conditions";
const MORE_PICTURES: &str = "More pictures";

/// A part of the page under its heading; what is folded is not printed.
struct Section {
    id: &'static str,
    heading: &'static str,
    content: String,
    is_folded: bool,
}

impl Section {
    fn open(id: &'static str, heading: &'static str, content: String) -> Self {
        Self { id, heading, content, is_folded: false }
    }

    fn folded(id: &'static str, heading: &'static str, content: String) -> Self {
        Self { is_folded: true, ..Self::open(id, heading, content) }
    }
}

/// Pictures that are shown before one asks for more.
const SHOWN: usize = 2;
/// Beginnings of the names of those that answer a question by themselves, the most telling first.
const TELLING: [&str; 5] = ["identifiability", "trade_off", "bounds_map", "distances", "map_verdict"];

/// Which pictures are shown at once: those that tell most, else the first.
fn most_telling(drawings: &[Drawing<'_>]) -> Vec<usize> {
    let rank = |i: &usize| {
        let name = drawings.get(*i).map_or("", |drawing| drawing.name);
        TELLING.iter().position(|telling| name.starts_with(telling)).unwrap_or(TELLING.len())
    };
    let mut order: Vec<usize> = (0..drawings.len()).collect();
    order.sort_by_key(rank);
    order.truncate(SHOWN);
    order
}

/// A picture within the page, named by its own title.
fn figure(number: usize, drawing: &Drawing<'_>) -> String {
    let (id, name) = (format!("figure-{number}"), drawing.name);
    let (described, said) = match drawing.said {
        "" => Default::default(),
        said => {
            let described = format!(" aria-describedby=\"{id}-said\"");
            (described, format!("\n<desc id=\"{id}-said\">{}</desc>", escape(said)))
        }
    };
    // Within a page the names of elements need no address.
    let svg = drawing.svg.replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1);
    let svg = svg.replacen("<svg ", &format!("<svg aria-labelledby=\"{id}\"{described} "), 1);
    let svg = svg.replacen("<title>", &format!("<title id=\"{id}\">"), 1);
    let svg = svg.replacen("</title>", &format!("</title>{said}"), 1);
    format!(
        "<figure>\n{}<figcaption>{}</figcaption>\n</figure>\n",
        wide(&format!("Figure {number}"), &svg),
        words::figure(number, name)
    )
}

/// Text as it stands in a file.
fn verbatim(name: &str, text: &str) -> String {
    format!("<pre tabindex=\"0\" role=\"group\" aria-label=\"{name}\">{text}</pre>\n")
}

fn list(items: &[String]) -> String {
    if items.is_empty() {
        return String::new();
    }
    let items: String = items.iter().map(|item| format!("<li>{}</li>\n", escape(item))).collect();
    format!("<ul>\n{items}</ul>\n")
}

/// Every kind of warning once: what it means, what to do, and what was said of which.
fn warnings(warnings: &[Warning]) -> String {
    let of = |(code, said): (Code, Vec<&Warning>)| {
        let block = of_code(code);
        format!(
            "<h3><code>{}</code></h3>\n<p>{} <strong>{}</strong> {}</p>\n{}",
            code.name(),
            escape(block.meaning),
            words::REMEDY,
            escape(block.remedy),
            list(&said.into_iter().map(Say::say).collect::<Vec<_>>())
        )
    };
    by_code(warnings).into_iter().map(of).collect()
}

fn provenance(made: &Provenance) -> String {
    let rows = [
        ("Program", format!("hadar {VERSION}")),
        ("Commit", made.commit.clone()),
        ("Command", made.command_line()),
        ("Seed", made.seed.to_string()),
    ];
    let rows = rows.map(|(name, value)| format!("<dt>{name}</dt><dd><code>{}</code></dd>\n", escape(&value)));
    let mut out = format!("<dl>\n{}</dl>\n", rows.concat());
    if !made.inputs.is_empty() {
        let row = |input: &Input| {
            let hash = input.sha256.as_deref().unwrap_or(words::READ_ONCE);
            (escape(&input.path), format!("<td><code>{hash}</code></td>"))
        };
        let head = ("input", "<th scope=\"col\">SHA-256</th>");
        let hashes = table(" class=\"hashes\"", words::INPUTS, head, made.inputs.iter().map(row));
        let _ = write!(
            out,
            "<details>\n<summary>{}</summary>\n{}</details>\n",
            words::INPUTS,
            wide("Inputs", &hashes)
        );
    }
    out + &format!("<p>{}</p>\n", words::WRITTEN)
}
