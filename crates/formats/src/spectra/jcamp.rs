//! JCAMP-DX: spectra of spectrometers as labelled text.
//!
//! `##LABEL= value` over one or several lines, `$$` begins a comment; a block from `##TITLE=` to `##END=`, blocks within blocks. Data
//! are `##XYDATA= (X++(Y..Y))`, evenly spaced from FIRSTX to LASTX, y = YFACTOR × ordinate ([`ordinates`]), or
//! `##XYPOINTS= (XY..XY)`, pairs. XUNITS is any unit of a spectral axis, YUNITS reflectance or emissivity, as a fraction or in
//! percent. NPOINTS, FIRSTX, LASTX, DELTAX, FIRSTY and the checks within the data must agree with them.
//!
//! A block from which no emissivity follows is left out where another has one. Blocks of one title are told apart by their number.
//!
//! Values below 0 or above 1 are kept and reported, and an error once a band needs them. Transmittance, absorbance and tables of peaks are
//! recognised and refused.
//!
//! Source: McDonald & Wilks, Appl. Spectrosc. 42, 151 (1988), JCAMP-DX 4.24.

mod ordinates;

use super::checked::{Checked, checked};
use super::content::{Content, joined, of_all, short_name, stem};
use super::header::{self, Meaning, Values};
use super::reading::Reading;
use crate::spectral_unit::SpectralUnit;
use hadar::error::{Error, Result, check};
use hadar::grid::number;
use hadar::material::Material;
use hadar::material::Provenance;
use hadar::material::Table;
use hadar::words::{kebab_case, one_line};
use std::collections::BTreeMap;
use std::path::Path;

/// Relative difference that rounding of what a header says may make.
const ROUNDED: f64 = 1e-2;

/// Whether the text looks like one: its first line begins with a label.
pub(super) fn is_one(text: &str) -> bool {
    let first = text.lines().map(str::trim).find(|line| !line.is_empty() && !line.starts_with("$$"));
    first.and_then(label).is_some_and(|(key, _)| matches!(key.as_str(), "TITLE" | "JCAMPDX"))
}

/// Label without blanks, hyphens, slashes and underscores, in capitals; and its value.
fn label(line: &str) -> Option<(String, &str)> {
    let (key, value) = line.trim_start().strip_prefix("##")?.split_once('=')?;
    let plain = key.chars().filter(|char| !matches!(char, ' ' | '-' | '/' | '_' | '\t'));
    Some((plain.flat_map(char::to_uppercase).collect(), value.trim()))
}

/// A block: labels with the line each is on, and the lines below that of the data.
#[derive(Default)]
struct Block<'a> {
    labels: BTreeMap<String, (usize, String)>,
    data: Vec<(usize, &'a str)>,
}

/// Labels whose value is data, and what their form must be.
const DATA: [&str; 4] = ["XYDATA", "XYPOINTS", "PEAKTABLE", "PEAKASSIGNMENTS"];

pub(super) fn parse(text: &str, source: &Path, reading: &Reading) -> Result<Content> {
    let blocks = blocks(text);
    let many = blocks.len() > 1;
    let (mut found, mut refused) = (Vec::new(), Vec::new());
    for block in &blocks {
        match block.material(source, many, reading)? {
            Ok(material) => found.push((block, material)),
            Err(reason) => refused.push((block, reason)),
        }
    }
    if found.is_empty() {
        let instead = "write a block with ##XYDATA= (X++(Y..Y)) or ##XYPOINTS= (XY..XY)";
        let none = || Error::malformed("the file has no spectrum", instead);
        return Ok(Content::NoEmissivity(refused.into_iter().next().map_or_else(none, |(_, reason)| reason)));
    }
    let left_out: Vec<String> = refused
        .iter()
        .map(|(block, reason)| format!("the block `{}` is left out: {reason}", block.value("TITLE")))
        .collect();
    let titles: Vec<String> = found.iter().map(|(_, material)| material.name().to_owned()).collect();
    let named = |(at, (block, material)): (usize, (&Block<'_>, Material))| {
        let own = |of: &[String]| of.iter().filter(|title| *title == material.name()).count();
        let (all, number) = (own(&titles), own(titles.get(..=at).unwrap_or_default()));
        let material = material.clone().warn(left_out.clone());
        if all < 2 {
            return material;
        }
        let line = block.labels.get("TITLE").map_or(0, |(line, _)| *line);
        let remark = format!("{all} blocks have this title: it is number {number}, that of line {line}");
        let name = format!("{}@{number}", material.name());
        material.with_name(name).warn([remark])
    };
    Ok(Content::Materials(found.into_iter().enumerate().map(named).collect()))
}

/// All blocks that have data.
fn blocks(text: &str) -> Vec<Block<'_>> {
    let mut open: Vec<Block<'_>> = Vec::new();
    let mut closed = Vec::new();
    let mut key = String::new();
    for (index, line) in text.lines().enumerate() {
        let content = line.split("$$").next().unwrap_or_default().trim_end();
        if let Some((found, value)) = label(content) {
            if found == "TITLE" {
                open.push(Block::default());
            }
            if found == "END" {
                closed.extend(open.pop());
            } else if let Some(block) = open.last_mut() {
                block.labels.entry(found.clone()).or_insert_with(|| (index + 1, one_line(value)));
            }
            key = found;
        } else if let Some(block) = open.last_mut()
            && DATA.contains(&key.as_str())
            && !content.trim().is_empty()
        {
            block.data.push((index + 1, content.trim()));
        }
    }
    closed.extend(open);
    closed.retain(|block| {
        DATA.iter().any(|data| block.labels.contains_key(*data)) || block.labels.contains_key("NTUPLES")
    });
    closed
}

/// A material, or why there is none.
type Found = std::result::Result<Material, Error>;

impl Block<'_> {
    fn value(&self, key: &str) -> &str {
        self.labels.get(key).map_or("", |(_, value)| value.as_str())
    }

    fn at(&self, key: &str, error: Error) -> Error {
        match self.labels.get(key) {
            Some((line, _)) => error.for_key(key).on_line(*line),
            None => error,
        }
    }

    /// A number that the header says.
    fn number(&self, key: &str) -> Result<Option<f64>> {
        match self.value(key) {
            "" => Ok(None),
            text => number(text).map(Some).map_err(|error| self.at(key, error)),
        }
    }

    fn factor(&self, key: &str) -> Result<f64> {
        let factor = self.number(key)?.unwrap_or(1.0);
        if factor == 0.0 {
            let error =
                Error::malformed("a factor of 0", "write the factor of the ordinates, 1 if there is none");
            return Err(self.at(key, error));
        }
        Ok(factor)
    }

    fn needed(&self, key: &str) -> Result<f64> {
        let missing =
            || Error::malformed(format!("there is no ##{key}="), format!("write ##{key}= above the data"));
        self.number(key)?.ok_or_else(missing)
    }

    fn material(&self, source: &Path, many: bool, reading: &Reading) -> Result<Found> {
        let refused =
            |key: &str, found: String, instead: &str| Ok(Err(self.at(key, Error::malformed(found, instead))));
        if self.labels.contains_key("NTUPLES") {
            return refused(
                "NTUPLES",
                "this is a table of several variables".into(),
                "export the spectrum alone as ##XYDATA=",
            );
        }
        if let Some(key) =
            ["PEAKTABLE", "PEAKASSIGNMENTS"].into_iter().find(|key| self.labels.contains_key(*key))
        {
            return refused(
                key,
                "peaks are no spectrum: nothing is known between them".into(),
                "export it as ##XYDATA=",
            );
        }
        let (x_units, y_units) = (self.value("XUNITS"), self.value("YUNITS"));
        let Some(unit) = SpectralUnit::spelt(x_units).or_else(|| header::axis(x_units).ok().flatten()?.unit)
        else {
            let found = format!("`{x_units}` is no unit of wavelengths");
            return refused(
                "XUNITS",
                found,
                "write ##XUNITS= 1/CM, MICROMETERS or NANOMETERS, whichever is true",
            );
        };
        let quantity = match header::values(y_units) {
            Meaning::Values(Values { quantity: Some(quantity), percent, .. }) => (quantity, percent),
            _ => {
                let found = format!("`{y_units}`, from which no emissivity follows");
                let instead =
                    "use a spectrum of an opaque sample with ##YUNITS= REFLECTANCE, %R or EMISSIVITY";
                return refused("YUNITS", found, instead);
            }
        };
        let (quantity, percent) = quantity;
        let points = if self.labels.contains_key("XYPOINTS") { self.pairs()? } else { self.evenly_spaced()? };
        if let Some(announced) = self.number("NPOINTS")?
            && announced != points.len() as f64
        {
            let found = format!("{} points where the header announces {announced}", points.len());
            let error = Error::malformed(found, "fetch the file again: it is cut short or damaged");
            return Err(self.at("NPOINTS", error));
        }
        let scale = if percent { 100.0 } else { 1.0 };
        let most = points.iter().map(|point| point.1 / scale).fold(f64::NEG_INFINITY, f64::max);
        if most > 2.0 {
            let found = format!("{} up to {} where 1 is all there is", quantity.name(), most);
            let instead = format!("write ##YUNITS= %{} if it is percent", quantity.name().to_uppercase());
            return Err(self.at("YUNITS", Error::malformed(found, instead)));
        }
        let mut rows = Vec::with_capacity(points.len());
        for (x, y) in points {
            let wavenumber = check::positive("x", x, unit.name())
                .and_then(|x| check::positive("wavenumber", unit.wavenumber_cm1(x), "cm^-1"))
                .map_err(|error| self.at("XUNITS", error))?;
            rows.push((wavenumber, [quantity.emissivity(y / scale)]));
        }
        let Checked { table, mut warnings, note } = checked(Table::new(&rows)?, reading.clip())?;
        warnings.extend(of_all(quantity.name(), most * scale, scale));
        let title = self.value("TITLE");
        let own = short_name(&kebab_case(title));
        let name = match (own.is_empty(), many) {
            (true, false) => stem(source),
            (true, true) => {
                let error = Error::malformed("a block of several has no title", "write one after ##TITLE=");
                return Err(self.at("TITLE", error));
            }
            _ => own,
        };
        let said = |keys: &[&str]| {
            let parts = keys.iter().map(|key| self.value(key)).filter(|value| !value.is_empty());
            parts.collect::<Vec<_>>().join("; ")
        };
        let share = if percent { " in percent" } else { "" };
        let source = [source.display().to_string(), said(&["ORIGIN", "OWNER"])].join("; ");
        let source = source.trim_end_matches("; ").to_owned();
        let note = joined(&[quantity.note(), &note], "; ");
        let provenance = Provenance::of_file(said(&["TITLE", "SAMPLEDESCRIPTION"]), source, &note);
        let read_as = format!("JCAMP-DX, {} in {}, {}{share}", unit.quantity(), unit.name(), quantity.name());
        Ok(Ok(Material::of_table(name, provenance, table).reading(read_as).warn(warnings)))
    }

    /// `(XY..XY)`: pairs with a comma between them, and blanks or semicolons between pairs.
    fn pairs(&self) -> Result<Vec<(f64, f64)>> {
        self.form("XYPOINTS", "(XY..XY)")?;
        let (x_factor, y_factor) = (self.factor("XFACTOR")?, self.factor("YFACTOR")?);
        let mut points = Vec::new();
        for (line, content) in &self.data {
            let cells = content.split([',', ';', ' ', '\t']).filter(|cell| !cell.is_empty());
            let numbers =
                cells.map(number).collect::<Result<Vec<f64>>>().map_err(|error| error.on_line(*line))?;
            let (pairs, rest) = numbers.as_chunks::<2>();
            if !rest.is_empty() {
                let found = "an odd count of numbers";
                return Err(Error::malformed(found, "write pairs of x and y").on_line(*line));
            }
            points.extend(pairs.iter().map(|[x, y]| (x * x_factor, y * y_factor)));
        }
        Ok(points)
    }

    fn form(&self, key: &str, form: &str) -> Result<()> {
        let said: String = self.value(key).chars().filter(|char| !char.is_whitespace()).collect();
        if said.eq_ignore_ascii_case(form) {
            return Ok(());
        }
        let error = Error::malformed(
            format!("`{}` is another form of data", self.value(key)),
            format!("export them as ##{key}= {form}"),
        );
        Err(self.at(key, error))
    }

    /// `(X++(Y..Y))`: ordinates at evenly spaced x.
    fn evenly_spaced(&self) -> Result<Vec<(f64, f64)>> {
        self.form("XYDATA", "(X++(Y..Y))")?;
        let (first, last) = (self.needed("FIRSTX")?, self.needed("LASTX")?);
        let y_factor = self.factor("YFACTOR")?;
        let (values, starts) = ordinates::read(&self.data)?;
        // A header that announces another count is refused by who asked.
        let step = (last - first) / (values.len().max(2) - 1) as f64;
        if let Some(delta) = self.number("DELTAX")?
            && self.number("NPOINTS")?.is_none_or(|points| points == values.len() as f64)
            && !((delta - step).abs() <= ROUNDED * step.abs() || (delta + step).abs() <= ROUNDED * step.abs())
        {
            let found =
                format!("steps of {delta} where FIRSTX, LASTX and the number of points make it {step}");
            return Err(self
                .at("DELTAX", Error::malformed(found, "fetch the file again: it is cut short or damaged")));
        }
        self.check_starts(&starts, first, step, values.len())?;
        if let (Some(announced), Some(value)) = (self.number("FIRSTY")?, values.first()) {
            let found = value * y_factor;
            // As many digits as headers usually have.
            let largest = announced.abs().max(found.abs()).max(y_factor.abs());
            let agrees = (found - announced).abs() <= ROUNDED * largest;
            if !agrees {
                let error = Error::malformed(
                    format!("the first ordinate is {found} where FIRSTY is {announced}"),
                    "correct YFACTOR or FIRSTY, or fetch the file again",
                );
                return Err(self.at("FIRSTY", error));
            }
        }
        Ok(values
            .iter()
            .enumerate()
            .map(|(index, value)| (first + step * index as f64, value * y_factor))
            .collect())
    }

    /// The x that lines begin with, each against that of its first ordinate.
    fn check_starts(&self, starts: &[ordinates::Start], first: f64, step: f64, points: usize) -> Result<()> {
        let factor = self.factor("XFACTOR")?;
        if self.number("NPOINTS")?.is_some_and(|announced| announced != points as f64) {
            return Ok(());
        }
        for start in starts {
            let (found, due) = (start.x * factor, first + step * start.index as f64);
            // Some writers state the x of the line's check value, some that of the next one; most round it.
            let rounding = factor.abs() * start.last_digit;
            let agrees = (found - due).abs() <= 1.5 * step.abs() + rounding;
            if !agrees {
                let error = Error::malformed(
                    format!("this line begins at x = {found} where its first ordinate is at {due}"),
                    "fetch the file again: a line is lost or damaged",
                );
                return Err(error.on_line(start.line));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
