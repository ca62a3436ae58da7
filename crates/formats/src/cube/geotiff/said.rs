//! What GDAL says beside a picture of its samples.

use crate::cube::band_list;
use crate::cube::scaling;
use crate::spectral_unit::SpectralUnit;
use hadar::error::{Error, Result};
use std::fs::File;
use std::io::BufReader;
use tiff::decoder::Decoder;
use tiff::tags::Tag;

/// Metadata as `<Item name="…" sample="…" role="…">value</Item>`, and the number for nothing.
const METADATA: Tag = Tag::Unknown(42112);
const NODATA: Tag = Tag::Unknown(42113);

/// What is said, a number for each band where all of them have one.
#[derive(Debug, Default)]
pub(super) struct Said {
    pub(super) scale: Vec<f64>,
    pub(super) offset: Vec<f64>,
    pub(super) missing: Vec<f64>,
    pub(super) unit: Option<String>,
    pub(super) centres_cm1: Vec<f64>,
    pub(super) widths_cm1: Vec<f64>,
    /// Whether there are wavelengths that are not used.
    pub(super) axis_unused: bool,
}

impl Said {
    pub(super) fn of(decoder: &mut Decoder<BufReader<File>>, bands: usize) -> Result<Self> {
        let mut text = |tag: Tag| -> Result<String> {
            let value = decoder.find_tag(tag).map_err(damaged)?;
            Ok(value.and_then(|value| value.into_string().ok()).unwrap_or_default())
        };
        let missing = text(NODATA)?
            .trim_matches(['\0', ' ', '\n'])
            .parse()
            .ok()
            .filter(|number: &f64| number.is_finite());
        let metadata = text(METADATA)?;
        let items: Vec<Item<'_>> = metadata.split("<Item ").skip(1).filter_map(Item::read).collect();
        // What is no number would be taken as if nothing were said.
        let wrong = |item: &&Item<'_>| {
            let number = item.value.trim().parse().ok().filter(|number: &f64| number.is_finite());
            match item.role {
                "scale" => number.is_none_or(|scale| scale == 0.0) || item.sample.is_none(),
                "offset" => number.is_none() || item.sample.is_none(),
                _ => false,
            }
        };
        if let Some(item) = items.iter().find(wrong) {
            let found = format!("the {} of a band is `{}`", item.role, item.value.escape_debug());
            return Err(Error::malformed(found, "write it as a number, with a decimal point and its sample"));
        }
        for item in items.iter().filter(|item| !["scale", "offset"].contains(&item.role)) {
            if let Ok(number) = item.value.trim().parse() {
                scaling::check(item.name, "", &[number])?;
            }
        }
        let numbers = |is: &dyn Fn(&Item<'_>) -> bool, silent: Option<f64>| -> Vec<f64> {
            let of = |band: usize| {
                let item = items.iter().find(|item| is(item) && item.sample == Some(band));
                item.and_then(|item| item.value.trim().parse().ok()).or(silent)
            };
            if items.iter().any(is) { (0..bands).map_while(of).collect() } else { Vec::new() }
        };
        let role = |role: &'static str| move |item: &Item<'_>| item.role == role;
        let named = |name: &'static str| move |item: &Item<'_>| item.name.eq_ignore_ascii_case(name);
        let units: Vec<&str> =
            items.iter().filter(|item| item.role == "unittype").map(|item| item.value).collect();
        let differ = units.windows(2).any(|pair| pair[0] != pair[1]);
        if differ || !units.is_empty() && units.len() != bands {
            let found = format!("{} units for {bands} bands", units.len());
            return Err(Error::malformed(found, "write the same unit for every band"));
        }
        let unit = units.first().map(|unit| (*unit).to_owned());
        let centres_um = numbers(&named("CENTRAL_WAVELENGTH_UM"), None);
        let is_axis = |item: &Item<'_>| item.name.to_lowercase().contains("wavelength");
        let widths_um = numbers(&named("FWHM_UM"), None);
        let centres_cm1 =
            band_list::in_unit(SpectralUnit::Micrometre, &centres_um).filter(|centres| !centres.is_empty());
        let widths_cm1 = band_list::widths_cm1(SpectralUnit::Micrometre, &centres_um, &widths_um);
        Ok(Self {
            scale: numbers(&role("scale"), Some(1.0)),
            offset: numbers(&role("offset"), Some(0.0)),
            missing: missing.into_iter().collect(),
            unit: unit.filter(|unit| !unit.trim().is_empty()),
            widths_cm1: widths_cm1.unwrap_or_default(),
            axis_unused: centres_cm1.is_none() && items.iter().any(is_axis),
            centres_cm1: centres_cm1.unwrap_or_default(),
        })
    }
}

impl Said {
    /// What pages say that are the bands of one picture, each of its own.
    ///
    /// # Errors
    /// Scales, offsets or units that are not those of all.
    pub(super) fn of_pages(mut pages: Vec<Self>) -> Result<Self> {
        if pages.len() < 2 {
            return Ok(pages.pop().unwrap_or_default());
        }
        let scaled = pages.iter().any(|page| !(page.scale.is_empty() && page.offset.is_empty()));
        let differ = pages.windows(2).any(|pair| pair[0].unit != pair[1].unit);
        if scaled || differ {
            let found = format!("{} pages with a scale, an offset or a unit of their own", pages.len());
            return Err(Error::malformed(
                found,
                "write one page with all bands, or name one as the variable",
            ));
        }
        let axis_unused = pages.iter().any(|page| page.axis_unused);
        let mut all = Self { axis_unused, ..Self::default() };
        for page in pages {
            all.unit = page.unit;
            all.centres_cm1.extend(page.centres_cm1);
            all.widths_cm1.extend(page.widths_cm1);
            all.missing.extend(page.missing);
        }
        all.missing.sort_by(f64::total_cmp);
        all.missing.dedup();
        Ok(all)
    }
}

/// One item of the metadata.
#[derive(Debug)]
struct Item<'a> {
    name: &'a str,
    role: &'a str,
    sample: Option<usize>,
    value: &'a str,
}

impl<'a> Item<'a> {
    /// From what follows `<Item `.
    fn read(text: &'a str) -> Option<Self> {
        let (attributes, rest) = text.split_once('>')?;
        let (value, _) = rest.split_once("</Item>")?;
        let of = |key: &str| -> &'a str {
            let found = attributes.split_once(key).map(|(_, after)| after);
            found.and_then(|after| after.split('"').next()).unwrap_or_default()
        };
        Some(Self { name: of("name=\""), role: of("role=\""), sample: of("sample=\"").parse().ok(), value })
    }
}

/// A file that cannot be read.
pub(super) fn damaged(error: impl std::fmt::Display) -> Error {
    Error::malformed(
        format!("the TIFF file cannot be read: {error}"),
        "write or copy it again, unpacked: tifffile.imwrite('cube.tif', tifffile.imread('old.tif'))",
    )
}
