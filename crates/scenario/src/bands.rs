//! The `[bands]` of a scenario: an even grid, ranges, or a file of rows or filters.

use std::path::PathBuf;

use super::entries::Entries;
use super::paths::{Paths, file};
use super::section::{Entry, Section, without_repetition};
use hadar::error::{Error, Result};
use hadar::units::{Dimension, Spectral};

/// Start, stop and step of the paper's bands, cm⁻¹.
const PAPERS_GRID: [f64; 3] = [715.0, 1250.0, 1.0];
/// The most bands a grid may have.
const MOST_BANDS: f64 = 1e6;

/// The spectral bands and how a band is evaluated (`[bands]`).
#[derive(Debug, Clone, PartialEq)]
pub struct BandsSpec {
    /// Where the bands come from.
    pub source: BandSource,
    /// Whether the spectrum is integrated over each band of a grid or of rows, or its value at the centre counts; where nothing is
    /// said it is integrated over bands in which a spectrum has rows nearer to each other than the band is wide.
    pub integrate: Option<bool>,
    /// Relative tolerance of that integral.
    pub tolerance: f64,
}

/// Where the bands come from. File paths are absolute.
#[derive(Debug, Clone, PartialEq)]
pub enum BandSource {
    /// Nothing is said: the one band of a camera that has one, else 715 to 1250 cm⁻¹ in steps of 1 cm⁻¹.
    Unsaid,
    /// Band centres `start`, `start + step`, … up to and including `stop`; a band is one `step` wide.
    /// All three in wavenumber or all three in wavelength; `0 < start < stop`, `0 < step ≤ stop − start`.
    Grid {
        /// First band centre.
        start: Spectral,
        /// End of the grid, itself a centre if a whole number of steps away.
        stop: Spectral,
        /// Distance of the centres.
        step: Spectral,
    },
    /// Filters by their transmission.
    Filters(Filters),
    /// CSV with a row per band: its centre and optionally its width.
    Rows(PathBuf),
    /// Bands from edge to edge, both of one kind, lower first.
    Ranges(Vec<[Spectral; 2]>),
}

/// Filters, all of a list or some of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Filters {
    /// The list.
    pub list: FilterList,
    /// Names of those that are used; all where `None`.
    pub names: Option<Vec<String>>,
    /// Where they stand, and their effective index where that matters.
    pub place: Option<FilterPlace>,
}

/// A list of filters.
#[derive(Debug, Clone, PartialEq)]
pub enum FilterList {
    /// CSV with one column of transmission per filter; an absolute path.
    File(PathBuf),
    /// The shapes of the program.
    Catalogue,
}

/// Where a filter stands, which decides at which angles light passes it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FilterPlace {
    /// Before the lens: light of one point is parallel.
    Lens,
    /// Before the sensor, in the cone of the lens.
    Sensor {
        /// Effective index of the filter; at least 1.
        index: f64,
    },
}

/// What stands for the catalogue of the program.
const CATALOGUE: &str = "catalogue";

impl Filters {
    /// All filters of a file.
    #[must_use]
    pub fn of_file(path: PathBuf) -> Self {
        Self { list: FilterList::File(path), names: None, place: None }
    }

    fn read(section: &Section<'_>) -> Result<Self> {
        let names = section.read("names", |entry| {
            let items = entry.items("names = [\"choice-9-0.5\"]")?;
            if items.is_empty() {
                let instead = "name some filters, or leave the key out to take all";
                return Err(entry.fail(Error::malformed("the list is empty", instead)));
            }
            without_repetition(&items, |item| item.name("\"choice-9-0.5\""))
        })?;
        let list = section.require("filters")?;
        Ok(Self { list: filter_list(&list)?, names, place: FilterPlace::read(section)? })
    }

    fn put(&self, entries: Entries, paths: Paths<'_>) -> Entries {
        let entries = entries
            .put("filters", filter_list_written(&self.list, paths))
            .put_if("names", self.names.clone());
        match self.place {
            None => entries,
            Some(place) => place.put(entries),
        }
    }
}

impl FilterPlace {
    /// `place` and `index` of a table.
    pub(super) fn read(section: &Section<'_>) -> Result<Option<Self>> {
        let index = section.number("index")?;
        match (section.choice("place", &[("lens", false), ("sensor", true)])?, index) {
            (None, None) => Ok(None),
            (Some(true), Some(index)) => Ok(Some(Self::Sensor { index })),
            (Some(false), None) => Ok(Some(Self::Lens)),
            (Some(true), None) => {
                let instead = "write index = 2.0 beside it, as its maker states it";
                Err(section
                    .fail("place", Error::malformed("a filter before the sensor without its index", instead)))
            }
            (_, Some(_)) => {
                let found = "the index of a filter that is not said to stand before the sensor";
                Err(section.fail(
                    "index",
                    Error::malformed(found, "write place = \"sensor\" beside it, or leave it out"),
                ))
            }
        }
    }

    /// The same as it is written.
    pub(super) fn put(self, entries: Entries) -> Entries {
        match self {
            Self::Lens => entries.put("place", "lens"),
            Self::Sensor { index } => entries.put("place", "sensor").put("index", index),
        }
    }
}

/// A file of filters, or the catalogue of the program.
pub(super) fn filter_list(entry: &Entry<'_>) -> Result<FilterList> {
    match entry.text("\"my_data.csv\"")?.trim() {
        CATALOGUE => Ok(FilterList::Catalogue),
        _ => file(entry).map(FilterList::File),
    }
}

/// The same as it is written.
pub(super) fn filter_list_written(list: &FilterList, paths: Paths<'_>) -> String {
    match list {
        FilterList::Catalogue => CATALOGUE.into(),
        FilterList::File(path) => paths.file(path),
    }
}

impl Default for BandsSpec {
    fn default() -> Self {
        Self { source: BandSource::Unsaid, integrate: None, tolerance: 1e-9 }
    }
}

impl BandSource {
    /// The grid of the paper: 715 to 1250 cm⁻¹ in steps of 1 cm⁻¹.
    pub fn papers_grid() -> Self {
        let [start, stop, step] = PAPERS_GRID.map(Spectral::Wavenumber);
        Self::Grid { start, stop, step }
    }
}

impl BandsSpec {
    pub(super) fn read(entry: &Entry<'_>) -> Result<Self> {
        let section = entry.section()?;
        for grid in ["start", "stop", "step"] {
            section.at_most_one(&[grid, "filters", "rows", "ranges"])?;
        }
        let default = Self::default();
        let of_filters = ["names", "place", "index"].into_iter().find(|key| section.get(key).is_some());
        if let (Some(key), None) = (of_filters, section.get("filters")) {
            let found = format!("{key} without filters");
            return Err(
                section.fail(key, Error::malformed(found, "write filters = \"filters.csv\" beside it"))
            );
        }
        let source = match section.at_most_one(&["filters", "rows", "ranges"])? {
            Some("filters") => Some(BandSource::Filters(Filters::read(&section)?)),
            Some("rows") => section.read("rows", file)?.map(BandSource::Rows),
            Some(_) => section.read("ranges", ranges)?.map(BandSource::Ranges),
            None => Some(grid(&section)?),
        };
        Ok(Self {
            source: source.unwrap_or(default.source),
            integrate: section.read("integrate", Entry::boolean)?,
            tolerance: section.number("tolerance")?.unwrap_or(default.tolerance),
        })
    }

    pub(super) fn written(&self, paths: Paths<'_>) -> Entries {
        let entries = Entries::default();
        let entries = match &self.source {
            BandSource::Unsaid => entries,
            BandSource::Grid { start, stop, step } => {
                let put = |entries: Entries, key, end: &Spectral| {
                    entries.put_written(key, end.dimension(), end.format())
                };
                put(put(put(entries, "start", start), "stop", stop), "step", step)
            }
            BandSource::Filters(filters) => filters.put(entries, paths),
            BandSource::Rows(path) => entries.put("rows", paths.file(path)),
            BandSource::Ranges(ranges) => {
                let pairs: Vec<Vec<String>> =
                    ranges.iter().map(|range| range.map(|end| end.format()).to_vec()).collect();
                let dimension = ranges.first().map_or(Dimension::Wavenumber, |[low, _]| low.dimension());
                entries.put_written("ranges", dimension, pairs)
            }
        };
        entries.put_if("integrate", self.integrate).put("tolerance", self.tolerance)
    }
}

/// An even grid, what is silent of it taken from the paper's.
fn grid(section: &Section<'_>) -> Result<BandSource> {
    if ["start", "stop", "step"].iter().all(|key| section.get(key).is_none()) {
        return Ok(BandSource::Unsaid);
    }
    let read = |key: &'static str, silent: f64| {
        let written = section.read(key, spectral)?;
        Ok((key, written.is_some(), written.unwrap_or(Spectral::Wavenumber(silent))))
    };
    let [start, stop, step] = PAPERS_GRID;
    let keys = [read("start", start)?, read("stop", stop)?, read("step", step)?];
    let is_wavenumber = |value: Spectral| matches!(value, Spectral::Wavenumber(_));
    if keys.iter().any(|(_, _, value)| !is_wavenumber(*value))
        && let Some((key, written, value)) = keys.iter().find(|(_, _, value)| is_wavenumber(*value))
    {
        let silent = if *written { "" } else { "silent, which means " };
        let found = format!("{key} is {silent}{}, but another of the three is a wavelength", value.format());
        let instead = "write start, stop and step all in cm^-1, or all in um or nm";
        return Err(section.fail(key, Error::malformed(found, instead)));
    }
    let [start, stop, step] = keys.map(|(_, _, value)| value);
    let (low, high, width) = (start.number(), stop.number(), step.number());
    let refuse =
        |key: &str, found: String, instead: &str| Err(section.fail(key, Error::malformed(found, instead)));
    if high <= low {
        let found = format!("stop ({}) is not above start ({})", stop.format(), start.format());
        return refuse("stop", found, "write the lower end as start");
    }
    if width > high - low {
        let found = format!("the step ({}) is larger than the range from start to stop", step.format());
        return refuse("step", found, "lower it, or write a single band as ranges = [[\"8 um\", \"14 um\"]]");
    }
    if (high - low) / width + 1.0 > MOST_BANDS {
        let found = format!("a step of {} makes more than a million bands", step.format());
        return refuse("step", found, "raise it");
    }
    Ok(BandSource::Grid { start, stop, step })
}

fn ranges(entry: &Entry<'_>) -> Result<Vec<[Spectral; 2]>> {
    let example = "ranges = [[\"715 cm^-1\", \"800 cm^-1\"]]";
    let items = entry.items(example)?;
    if items.is_empty() {
        return Err(entry.fail(Error::malformed("the list is empty", format!("write {example}"))));
    }
    items.iter().map(range).collect()
}

/// From edge to edge, both of one kind.
pub(super) fn range(entry: &Entry<'_>) -> Result<[Spectral; 2]> {
    let example = "[\"715 cm^-1\", \"800 cm^-1\"]";
    let [low, high] = entry.pair(example)?;
    let (low, high) = (spectral(&low)?, spectral(&high)?);
    if !same_axis(low, high) {
        let found = format!("the range goes from {} to {}", low.format(), high.format());
        let instead = "write both ends in cm^-1, or both in um or nm";
        return Err(entry.fail(Error::malformed(found, instead)));
    }
    entry.wide_range(example, spectral, Spectral::number)
}

/// The wavenumbers of a range, lower one first, cm⁻¹.
pub(super) fn wavenumbers(ends: [Spectral; 2]) -> [f64; 2] {
    let [a, b] = ends.map(Spectral::wavenumber_cm1);
    [a.min(b), a.max(b)]
}

/// A position or step above 0.
fn spectral(entry: &Entry<'_>) -> Result<Spectral> {
    let text = entry.quantity_text()?;
    let value = Spectral::parse(&text).map_err(|error| entry.fail(error))?;
    if value.number().is_finite() && value.number() > 0.0 {
        return Ok(value);
    }
    Err(entry.fail(Error::malformed(format!("`{}` is out of range", text.trim()), "it must be above 0")))
}

fn same_axis(a: Spectral, b: Spectral) -> bool {
    matches!(a, Spectral::Wavenumber(_)) == matches!(b, Spectral::Wavenumber(_))
}
