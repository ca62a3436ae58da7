//! The `[find]` of a scenario: what may be chosen where a camera is sought, and what is to be small.

use super::bands::{FilterList, FilterPlace, filter_list, filter_list_written};
use super::entries::Entries;
use super::paths::Paths;
use super::section::{Entry, Section, without_repetition};
use hadar::error::{Error, Result};
use hadar::instrument::Price;
use hadar::instrument::presets::Cooling;
use hadar::units::{Dimension, Spectral};
use toml::Value;

/// Filters at once where nothing is said, and frames that are tried.
const AT_MOST: u32 = 3;
const FRAMES: [u32; 4] = [1, 4, 16, 64];
/// Step of free edges, µm.
const STEP_UM: f64 = 0.5;

hadar::named! {
    /// What is to be small.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Merit {
        /// What the camera costs, with lens and filters where their price is known.
        Price = "price",
        /// Time until all bands of all frames are read.
        Time = "time",
        /// Number of filters.
        Filters = "filters",
        /// Diameter of the lens's opening.
        Aperture = "aperture",
    }
    /// The name in a file.
    name
}

/// What may be chosen (`[find]`).
#[derive(Debug, Clone, PartialEq)]
pub struct FindSpec {
    /// Names of cameras, `*` for any letters.
    pub cameras: Vec<String>,
    /// Cooled ones or uncooled ones alone.
    pub kind: Option<Cooling>,
    /// Lenses for every camera; those of the catalogue for each where `None`.
    pub lenses: Option<Vec<LensSpec>>,
    /// Filters.
    pub filters: FiltersToChoose,
    /// Numbers of frames, rising.
    pub frames: Vec<u32>,
    /// Time until the decision, s.
    pub time_s: Option<f64>,
    /// What is to be small, the most important first.
    pub least: Vec<Merit>,
}

/// A lens as a file states it.
#[derive(Debug, Clone, PartialEq)]
pub struct LensSpec {
    /// Its name.
    pub name: Option<String>,
    /// Focal length over aperture.
    pub f_number: f64,
    /// Focal length, m.
    pub focal_length_m: f64,
    /// What it costs.
    pub price: Option<Price>,
}

/// Filters of which some are chosen.
#[derive(Debug, Clone, PartialEq)]
pub struct FiltersToChoose {
    /// Of which.
    pub from: FilterSupply,
    /// So many at most.
    pub at_most: u32,
    /// Where they stand.
    pub place: Option<FilterPlace>,
    /// What each costs.
    pub price: Option<Price>,
}

/// Where filters come from.
#[derive(Debug, Clone, PartialEq)]
pub enum FilterSupply {
    /// A list.
    List(FilterList),
    /// Ideal ones that pass all between two wavelengths, their edges multiples of a step, µm.
    Any {
        /// The step.
        step_um: f64,
    },
}

impl Default for FiltersToChoose {
    fn default() -> Self {
        let from = FilterSupply::List(FilterList::Catalogue);
        Self { from, at_most: AT_MOST, place: None, price: None }
    }
}

impl Default for FindSpec {
    fn default() -> Self {
        Self {
            cameras: vec!["*".into()],
            kind: None,
            lenses: None,
            filters: FiltersToChoose::default(),
            frames: FRAMES.to_vec(),
            time_s: None,
            least: vec![Merit::Price, Merit::Time, Merit::Filters],
        }
    }
}

impl FindSpec {
    pub(super) fn read(entry: &Entry<'_>) -> Result<Self> {
        let section = entry.section()?;
        let default = Self::default();
        let cameras = section.read("cameras", |entry| {
            let items = not_empty(entry, "cameras = [\"flir-boson*\"]")?;
            without_repetition(&items, |item| item.name("\"flir-boson*\""))
        })?;
        let lenses = section.read("lenses", |entry| {
            let items = not_empty(entry, "lenses = [{ f_number = 1.0, focal_length = \"14 mm\" }]")?;
            let lenses = items.iter().map(LensSpec::read).collect::<Result<Vec<_>>>()?;
            for (index, lens) in lenses.iter().enumerate() {
                let twice = |other: &LensSpec| lens.name.is_some() && other.name == lens.name;
                if let (Some(name), Some(item)) = (lens.name.as_ref(), items.get(index))
                    && lenses.iter().take(index).any(twice)
                {
                    let found = format!("another lens is called {name} too");
                    return Err(item.fail(Error::malformed(found, "give it a name of its own")));
                }
            }
            Ok(lenses)
        })?;
        let frames = section.read("frames", |entry| {
            let items = not_empty(entry, "frames = [1, 4, 16, 64]")?;
            let mut frames = without_repetition(&items, |item| item.count("16"))?;
            frames.sort_unstable();
            Ok(frames)
        })?;
        let least = section.read("least", |entry| {
            let items = not_empty(entry, "least = [\"price\", \"time\", \"filters\"]")?;
            without_repetition(&items, |item| item.choice(&Merit::ALL.map(|merit| (merit.name(), merit))))
        })?;
        Ok(Self {
            cameras: cameras.unwrap_or(default.cameras),
            kind: section.choice("kind", &Cooling::ALL.map(|kind| (kind.name(), kind)))?,
            lenses,
            filters: section.read("filters", FiltersToChoose::read)?.unwrap_or(default.filters),
            frames: frames.unwrap_or(default.frames),
            time_s: section.quantity("time")?,
            least: least.unwrap_or(default.least),
        })
    }

    pub(super) fn written(&self, paths: Paths<'_>) -> Entries {
        let lens = |lens: &LensSpec| {
            let mut table = toml::Table::new();
            if let Some(name) = &lens.name {
                drop(table.insert("name".into(), name.as_str().into()));
            }
            drop(table.insert("f_number".into(), lens.f_number.into()));
            drop(table.insert("focal_length".into(), Dimension::Length.format(lens.focal_length_m).into()));
            if let Some(price) = &lens.price {
                drop(table.insert("price".into(), price.to_string().into()));
            }
            Value::Table(table)
        };
        let lenses = self.lenses.as_ref().map(|lenses| lenses.iter().map(lens).collect::<Vec<_>>());
        let frames: Vec<i64> = self.frames.iter().map(|frames| i64::from(*frames)).collect();
        let least: Vec<&str> = self.least.iter().map(|merit| merit.name()).collect();
        Entries::default()
            .put("cameras", self.cameras.clone())
            .put_if("kind", self.kind.map(Cooling::name))
            .put_if("lenses", lenses)
            .put("filters", self.filters.written(paths))
            .put("frames", frames)
            .put_quantity("time", Dimension::Time, self.time_s)
            .put("least", least)
    }
}

impl LensSpec {
    fn read(entry: &Entry<'_>) -> Result<Self> {
        let section = entry.section()?;
        let required = |key: &str| section.require(key);
        Ok(Self {
            name: section.text("name", "\"wide\"")?,
            f_number: required("f_number")?.number("1.0")?,
            focal_length_m: required("focal_length")?.quantity()?,
            price: price(&section)?,
        })
    }
}

impl FiltersToChoose {
    fn read(entry: &Entry<'_>) -> Result<Self> {
        let section = entry.section()?;
        let default = Self::default();
        let step_um = section.read("step", |entry| {
            let text = entry.quantity_text()?;
            match Spectral::parse(&text).map_err(|error| entry.fail(error))? {
                Spectral::Wavelength(step) if (0.05..=5.0).contains(&step) => Ok(step),
                _ => {
                    let instead = "write a wavelength from \"0.05 um\" to \"5 um\"";
                    Err(entry
                        .fail(Error::malformed(format!("`{}` is no step of edges", text.trim()), instead)))
                }
            }
        })?;
        let is_any =
            section.get("from").is_some_and(|entry| entry.text("").is_ok_and(|text| text.trim() == "any"));
        let from = match (is_any, step_um) {
            (true, step) => FilterSupply::Any { step_um: step.unwrap_or(STEP_UM) },
            (false, Some(_)) => {
                let found = "a step of edges without from = \"any\": filters of a list have their own";
                return Err(
                    section.fail("step", Error::malformed(found, "leave it out, or write from = \"any\""))
                );
            }
            (false, None) => section.read("from", filter_list)?.map_or(default.from, FilterSupply::List),
        };
        let place = FilterPlace::read(&section)?;
        if is_any && place.is_some() {
            let found = "the place of filters whose edges are ideal";
            return Err(section
                .fail("place", Error::malformed(found, "leave it out: they pass the same at every angle")));
        }
        Ok(Self {
            from,
            at_most: section.read("at_most", |entry| entry.count("3"))?.unwrap_or(default.at_most),
            place,
            price: price(&section)?,
        })
    }

    fn written(&self, paths: Paths<'_>) -> Value {
        let mut table = toml::Table::new();
        let mut put = |key: &str, value: Value| drop(table.insert(key.into(), value));
        match &self.from {
            FilterSupply::List(list) => put("from", filter_list_written(list, paths).into()),
            FilterSupply::Any { step_um } => {
                put("from", "any".into());
                put("step", Spectral::Wavelength(*step_um).format().into());
            }
        }
        put("at_most", i64::from(self.at_most).into());
        match self.place {
            None => {}
            Some(FilterPlace::Lens) => put("place", "lens".into()),
            Some(FilterPlace::Sensor { index }) => {
                put("place", "sensor".into());
                put("index", index.into());
            }
        }
        if let Some(price) = &self.price {
            put("price", price.to_string().into());
        }
        Value::Table(table)
    }
}

/// The price of a part.
pub(super) fn price(section: &Section<'_>) -> Result<Option<Price>> {
    section.read("price", |entry| {
        Price::parse(entry.text("\"300 to 1 000 USD\"")?).map_err(|error| entry.fail(error))
    })
}

/// The items of a list that has some.
fn not_empty<'a>(entry: &Entry<'a>, example: &str) -> Result<Vec<Entry<'a>>> {
    let items = entry.items(example)?;
    if items.is_empty() {
        return Err(entry.fail(Error::malformed("the list is empty", format!("write {example}"))));
    }
    Ok(items)
}
