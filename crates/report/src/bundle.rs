//! What a command has to say in files: what was asked, tables, figures, warnings, and all of it in one page.
//!
//! Figures are drawn only as they are written, and all files appear together or not at all ([`Folder`]).

use super::figures::Plot;
use super::folder::{Folder, Held};
use super::html;
use super::json;
use super::manifest::Provenance;
use super::parquet;
use super::plot::{Drawn, Figure, render, render_svg};
use super::table::Table;
use super::tables;
use hadar::error::{Error, Result};
use hadar::words::visible;
use hadar_study::{Condition, Warning};
use rayon::prelude::*;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// The file of what a verdict rests on.
pub(crate) const CONDITIONS: &str = "conditions.csv";

const ANSWER: &str = "answer.txt";

/// Files of a report, by name.
#[derive(Debug, Clone, Default)]
pub struct Bundle {
    title: Option<String>,
    files: Vec<(String, Content)>,
    /// Figures with the names of their files, without ending.
    figures: Vec<(String, Figure)>,
    tables: Vec<(String, Table)>,
    warnings: Vec<Warning>,
    /// What was asked, as a file that asks it again.
    asked: Option<(&'static str, String)>,
    /// What stands before everything else on the page, as HTML.
    first: String,
    /// A statement about all other files, without its subjects.
    statement: Option<(&'static str, &'static str, Value)>,
}

/// What a file holds.
#[derive(Debug, Clone)]
enum Content {
    Held(Held),
    /// Of a figure.
    Svg(usize),
    Png(usize),
}

/// What is written beside the files of a bundle.
#[derive(Debug, Clone, Copy)]
pub struct About<'a> {
    /// The answer, as it is printed.
    pub answer: &'a str,
    /// Who made it of what.
    pub provenance: &'a Provenance,
    /// Files that were read, which are never replaced.
    pub inputs: &'a [PathBuf],
}

impl Bundle {
    /// Files about something.
    #[must_use]
    pub fn about(title: Option<&str>) -> Self {
        Self { title: title.map(str::to_owned), ..Self::default() }
    }

    /// The same files under another title.
    #[must_use]
    pub fn titled(self, title: &str) -> Self {
        Self { title: Some(title.to_owned()), ..self }
    }

    /// Adds a file.
    pub fn add(&mut self, name: impl Into<String>, content: impl Into<Vec<u8>>) {
        self.files.push((name.into(), Content::Held(content.into().into())));
    }

    /// Adds a file that is too large to be kept: what one in a [`Scratch`](super::folder::Scratch) holds.
    pub fn add_file(&mut self, name: impl Into<String>, path: impl Into<PathBuf>) {
        self.files.push((name.into(), Content::Held(Held::File(path.into()))));
    }

    /// Adds what was asked, as a file that asks it again.
    pub fn add_asked(&mut self, name: &'static str, text: impl Into<String>) {
        let text = text.into();
        self.add(name, text.clone());
        self.asked = Some((name, text));
    }

    /// What stands before everything else on the page, as HTML.
    pub(crate) fn begin_with(&mut self, html: String) {
        self.first = html;
    }

    /// Adds a statement whose `subject` will be all other files of the report, the one that it is about first.
    pub(crate) fn add_statement(&mut self, name: &'static str, about: &'static str, statement: Value) {
        self.statement = Some((name, about, statement));
    }

    /// Adds a table as CSV.
    ///
    /// # Errors
    /// A row whose length is not the header's.
    pub fn add_table(&mut self, name: &str, table: Table) -> Result<()> {
        self.add(name, table.to_csv()?);
        self.tables.push((name.to_owned(), table));
        Ok(())
    }

    /// Adds the warnings as a table.
    ///
    /// # Errors
    /// As [`Bundle::add_table`].
    pub fn add_warnings(&mut self, warnings: &[Warning]) -> Result<()> {
        self.add("warnings.csv", tables::warnings(warnings).to_csv()?);
        self.warnings = warnings.to_vec();
        Ok(())
    }

    /// Adds what verdicts rest on as a table, each with the camera that it is of; nothing where there is nothing.
    ///
    /// # Errors
    /// As [`Bundle::add_table`].
    pub fn add_conditions(&mut self, all: &[(&str, &Condition)]) -> Result<()> {
        if all.is_empty() {
            Ok(())
        } else {
            self.add_table(CONDITIONS, tables::conditions(all.iter().copied()))
        }
    }

    /// Adds PNG and CSV of every plot, and SVG of those that are no images.
    ///
    /// # Errors
    /// A table that cannot be written.
    pub fn add_plots(&mut self, plots: &[Plot]) -> Result<()> {
        for plot in plots {
            let figure = self.figures.len();
            if !plot.figure.is_image() {
                self.files.push((format!("{}.svg", plot.name), Content::Svg(figure)));
            }
            self.files.push((format!("{}.png", plot.name), Content::Png(figure)));
            // The table of which it is a picture may be there already.
            let name = format!("{}.csv", plot.name);
            if !self.tables.iter().any(|(own, _)| *own == name) {
                self.add(name, plot.table.to_csv()?);
            }
            self.figures.push((plot.name.clone().into_owned(), plot.figure.clone()));
        }
        Ok(())
    }

    /// Adds every table as Parquet too, beside its CSV.
    ///
    /// # Errors
    /// A program that was built without Parquet.
    pub fn add_parquet(&mut self) -> Result<()> {
        let mut made = Vec::new();
        for (name, content) in &self.files {
            let (Some(stem), Content::Held(Held::Bytes(bytes))) = (name.strip_suffix(".csv"), content) else {
                continue;
            };
            let name = format!("{stem}.parquet");
            if self.names().all(|known| known != name) {
                let columns = parquet::of_csv(&String::from_utf8_lossy(bytes))?;
                made.push((name, Content::Held(parquet::file(&columns)?.into())));
            }
        }
        self.files.extend(made);
        Ok(())
    }

    /// Names of the files, in the order they were added.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.files.iter().map(|(name, _)| name.as_str())
    }

    /// How many figures there are to draw.
    #[must_use]
    pub fn figures(&self) -> usize {
        self.figures.len()
    }

    /// The figures as SVG, with the names of their files without ending.
    ///
    /// # Errors
    /// A figure that cannot be drawn.
    pub fn drawings(&self) -> Result<Vec<(String, String)>> {
        self.figures.par_iter().map(|(name, figure)| Ok((name.clone(), render_svg(figure)?))).collect()
    }

    /// Writes all files into a folder, which is made if it is not there, with the answer as text and everything on one page;
    /// how many there are.
    ///
    /// # Errors
    /// A figure that cannot be drawn; a folder that cannot be written to. Then none of the files is there.
    pub fn write_report(&self, folder: &Folder, about: &About<'_>) -> Result<usize> {
        let drawn = self.drawn(|_| true)?;
        let page = self.page_of(drawn.iter().map(|drawn| drawn.svg.as_str()), about);
        let mut files = self.files_with(&drawn);
        if self.names().all(|name| name != ANSWER) {
            files
                .push((ANSWER.into(), format!("{}\n", visible(about.answer.trim_end())).into_bytes().into()));
        }
        files.push(("report.html".into(), page.into_bytes().into()));
        if let Some((name, about, statement)) = &self.statement {
            let mut subject = Vec::with_capacity(files.len());
            for (name, held) in &files {
                let hash =
                    held.sha256().map_err(|error| Error::file("read", Path::new(name), error.kind()))?;
                subject.push(json!({ "name": name, "digest": { "sha256": hash } }));
            }
            // What it is about before what belongs to it.
            subject.sort_by_key(|one| one["name"] != *about);
            let mut statement = statement.clone();
            statement["subject"] = subject.into();
            files.push(((*name).to_owned(), (json::pretty(&statement)? + "\n").into_bytes().into()));
        }
        folder.write(&files, about.provenance, about.inputs)?;
        Ok(files.len() + 1)
    }

    /// Everything on one page, without the files.
    ///
    /// # Errors
    /// A figure that cannot be drawn.
    pub fn page(&self, about: &About<'_>) -> Result<String> {
        let drawn = self.drawings()?;
        Ok(self.page_of(drawn.iter().map(|(_, svg)| svg.as_str()), about))
    }

    fn page_of<'a>(&'a self, svgs: impl Iterator<Item = &'a str>, about: &About<'_>) -> String {
        let drawings = svgs.zip(&self.figures).map(|(svg, (name, figure))| html::Drawing {
            name,
            svg,
            said: figure.subtitle(),
        });
        html::page(&html::Page {
            first: &self.first,
            title: self.title.as_deref(),
            answer: about.answer,
            drawings: drawings.collect(),
            tables: &self.tables,
            warnings: &self.warnings,
            asked: self.asked.as_ref().map(|(name, text)| (*name, text.as_str())),
            provenance: about.provenance,
        })
    }

    /// Writes the files alone, without an answer and a page; how many there are.
    ///
    /// # Errors
    /// As [`Bundle::write_report`].
    pub fn write_files(&self, folder: &Folder, about: &About<'_>) -> Result<usize> {
        let drawn = self.drawn(|figure| !figure.is_image())?;
        let files = self.files_with(&drawn);
        folder.write(&files, about.provenance, about.inputs)?;
        Ok(files.len() + 1)
    }

    /// Every figure drawn, as SVG those that are `wanted` so.
    fn drawn(&self, wanted: impl Fn(&Figure) -> bool + Sync) -> Result<Vec<Drawn>> {
        self.figures.par_iter().map(|(_, figure)| render(figure, wanted(figure))).collect()
    }

    /// Every file with its content.
    fn files_with(&self, drawn: &[Drawn]) -> Vec<(String, Held)> {
        let content = |content: &Content| match content {
            Content::Held(held) => held.clone(),
            Content::Svg(figure) => drawn[*figure].svg.clone().into_bytes().into(),
            Content::Png(figure) => drawn[*figure].png.clone().into(),
        };
        self.files.iter().map(|(name, kind)| (name.clone(), content(kind))).collect()
    }
}
