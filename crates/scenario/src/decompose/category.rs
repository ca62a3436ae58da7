//! What materials are parts of (`[[category]]`), and how that is found (`[segmentation]`).

use super::super::entries::Entries;
use super::super::section::{Entry, Section, without_repetition};
use hadar::error::{Error, Result};
use hadar_estimate::segmentation::Rule;

/// A kind of thing, and what it is made of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CategorySpec {
    /// Its name.
    pub name: String,
    /// Materials or classes of the library.
    pub materials: Vec<String>,
    /// Those of them that have other parts of it around them.
    pub enclosed: Vec<String>,
    /// Whether it matters for safety: it is said where it cannot be excluded, and no neighbour takes it away.
    pub safety: bool,
    /// Numbers that stand for it in the map of the truth; its own place among the categories if silent.
    pub labels: Vec<usize>,
    /// Surfaces of a scene to be rendered that it is.
    pub surfaces: Vec<String>,
}

/// What says which pixels are in truth of a category.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Told {
    /// `labels`, numbers of a map.
    ByLabels,
    /// `surfaces`, names of a scene to be rendered.
    BySurfaces,
}

impl Told {
    const fn key(self) -> &'static str {
        match self {
            Self::ByLabels => "labels",
            Self::BySurfaces => "surfaces",
        }
    }
}

/// How pixels get a category.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SegmentationSpec {
    /// By which rule, where a material is in several.
    pub rule: Rule,
    /// Whether the likeliest category of each pixel is the commonest of 5 × 5 in the end.
    pub smoothing: bool,
    /// Pixels from which on an object is listed without a decided pixel too.
    pub smallest_object: usize,
}

impl Default for SegmentationSpec {
    fn default() -> Self {
        Self { rule: Rule::default(), smoothing: true, smallest_object: 25 }
    }
}

const RULES: [(&str, Rule); 2] = [("regions", Rule::Regions), ("raster", Rule::Raster)];
const EXAMPLE: &str = "materials = [\"pmma\", \"rubber-tyre\", \"soda-lime-glass\"]";

/// All categories in their order.
pub(crate) fn categories(entry: &Entry<'_>, told: Told) -> Result<Vec<CategorySpec>> {
    let items = entry.items("[[category]]")?;
    let mut all: Vec<CategorySpec> = Vec::with_capacity(items.len());
    for item in &items {
        let section = item.section()?;
        let category = category(&section)?;
        let fail = |key: &str, found: String, instead: &str| {
            Err(section.fail(key, Error::malformed(found, instead)))
        };
        if all.iter().any(|other| other.name == category.name) {
            return fail("name", format!("`{}` is a category twice", category.name), "name it once");
        }
        let twice = "stands for two categories";
        if let Some(label) = category.labels.iter().find(|l| all.iter().any(|other| other.labels.contains(l)))
        {
            return fail("labels", format!("{label} {twice}"), "give it to one of them");
        }
        if let Some(one) =
            category.surfaces.iter().find(|s| all.iter().any(|other| other.surfaces.contains(s)))
        {
            return fail("surfaces", format!("`{one}` {twice}"), "give it to one of them");
        }
        all.push(category);
    }
    let is_told = |one: &CategorySpec| !one.labels.is_empty() || !one.surfaces.is_empty();
    if let Some(without) = all.iter().position(|one| !is_told(one))
        && all.iter().any(is_told)
    {
        let key = told.key();
        let found = format!("no {key}, while other categories have some");
        let instead = format!("write {key} for all of them, or for none");
        return Err(items[without].fail(Error::malformed(found, instead)));
    }
    Ok(all)
}

fn category(section: &Section<'_>) -> Result<CategorySpec> {
    let name = section.require("name")?.name("\"car\"")?;
    if name.is_empty() || ["none", "undecided"].iter().any(|taken| name.eq_ignore_ascii_case(taken)) {
        let found = format!("`{name}`, which says that a pixel has no category");
        return Err(section.fail("name", Error::malformed(found, "give it another name")));
    }
    let text = |item: &Entry<'_>| item.name("\"pmma\"");
    let listed = section.require("materials")?;
    let items = listed.items(EXAMPLE)?;
    if items.is_empty() {
        let found = format!("the category `{name}` has no materials");
        return Err(listed.fail(Error::malformed(found, format!("write {EXAMPLE}, or leave it out"))));
    }
    let materials = without_repetition(&items, text)?;
    let enclosed = section.read("enclosed", |entry| {
        let items = entry.items("enclosed = [\"soda-lime-glass\"]")?;
        let enclosed = without_repetition(&items, text)?;
        match enclosed.iter().zip(&items).find(|(one, _)| !materials.contains(one)) {
            Some((one, item)) => {
                let found = format!("`{one}` is none of the materials of `{name}`");
                Err(item.fail(Error::malformed(found, "name one of them")))
            }
            None => Ok(enclosed),
        }
    })?;
    let labels = section.read("labels", |entry| {
        let items = entry.items("labels = [4, 5]")?;
        let label = |item: &Entry<'_>| Ok(item.number("4")? as usize);
        without_repetition(&items, label)
    })?;
    let surfaces = section.read("surfaces", |entry| {
        without_repetition(&entry.items("surfaces = [\"car\", \"tyres of car\"]")?, text)
    })?;
    let safety = section.read("safety", Entry::boolean)?;
    Ok(CategorySpec {
        name,
        materials,
        enclosed: enclosed.unwrap_or_default(),
        safety: safety.unwrap_or_default(),
        labels: labels.unwrap_or_default(),
        surfaces: surfaces.unwrap_or_default(),
    })
}

pub(super) fn segmentation(entry: &Entry<'_>) -> Result<SegmentationSpec> {
    let section = entry.section()?;
    let default = SegmentationSpec::default();
    Ok(SegmentationSpec {
        rule: section.choice("rule", &RULES)?.unwrap_or(default.rule),
        smoothing: section.read("smoothing", Entry::boolean)?.unwrap_or(default.smoothing),
        smallest_object: section
            .number("smallest_object")?
            .map_or(default.smallest_object, |pixels| pixels as usize),
    })
}

/// The tables of categories, if there are any.
pub(crate) fn categories_written(categories: &[CategorySpec]) -> Option<Vec<Entries>> {
    (!categories.is_empty()).then(|| categories.iter().map(category_written).collect())
}

fn category_written(category: &CategorySpec) -> Entries {
    let some = |names: &Vec<String>| (!names.is_empty()).then(|| names.clone());
    let labels: Vec<i64> = category.labels.iter().map(|label| *label as i64).collect();
    Entries::default()
        .put("name", category.name.clone())
        .put("materials", category.materials.clone())
        .put_if("enclosed", some(&category.enclosed))
        .put_if("safety", category.safety.then_some(true))
        .put_if("labels", (!labels.is_empty()).then_some(labels))
        .put_if("surfaces", some(&category.surfaces))
}

pub(super) fn segmentation_written(spec: SegmentationSpec) -> Entries {
    let rule = RULES.iter().find(|(_, rule)| *rule == spec.rule).map_or("", |(name, _)| name);
    Entries::default()
        .put("rule", rule)
        .put("smoothing", spec.smoothing)
        .put("smallest_object", spec.smallest_object as i64)
}
