//! What GDAL says beside a picture of its samples.

use hadar::error::{Error, Result};
use std::fs::File;
use std::io::BufReader;
use tiff::decoder::Decoder;
use tiff::tags::Tag;

/// Metadata as `<Item name="…" sample="…" role="…">value</Item>`, and the number for nothing.
const METADATA: Tag = Tag::Unknown(42112);
const NOTHING: Tag = Tag::Unknown(42113);

/// What is said, a number for each band where all of them have one.
#[derive(Debug, Default)]
pub(super) struct Said {
    pub(super) scale: Vec<f64>,
    pub(super) offset: Vec<f64>,
    pub(super) missing: Option<f64>,
    pub(super) unit: Option<String>,
    pub(super) centres_cm1: Vec<f64>,
    pub(super) widths_cm1: Vec<f64>,
}

impl Said {
    pub(super) fn of(decoder: &mut Decoder<BufReader<File>>, bands: usize) -> Result<Self> {
        let mut text = |tag: Tag| -> Result<String> {
            let value = decoder.find_tag(tag).map_err(damaged)?;
            Ok(value.and_then(|value| value.into_string().ok()).unwrap_or_default())
        };
        let missing = text(NOTHING)?
            .trim_matches(['\0', ' ', '\n'])
            .parse()
            .ok()
            .filter(|number: &f64| number.is_finite());
        let metadata = text(METADATA)?;
        let items: Vec<Item<'_>> = metadata.split("<Item ").skip(1).filter_map(Item::read).collect();
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
        // Of one unit alone it is that of all.
        let unit = units
            .first()
            .filter(|first| units.iter().all(|unit| unit == *first))
            .map(|unit| (*unit).to_owned());
        let centres_um = numbers(&named("CENTRAL_WAVELENGTH_UM"), None);
        let widths_um = numbers(&named("FWHM_UM"), None);
        let width = |(centre, width): (&f64, &f64)| 1e4 * width / (centre * centre);
        Ok(Self {
            scale: numbers(&role("scale"), Some(1.0)),
            offset: numbers(&role("offset"), Some(0.0)),
            missing,
            unit: unit.filter(|unit| !unit.trim().is_empty()),
            widths_cm1: centres_um.iter().zip(&widths_um).map(width).collect(),
            centres_cm1: centres_um
                .iter()
                .map(|um| 1e4 / um)
                .filter(|nu| *nu > 0.0 && nu.is_finite())
                .collect(),
        })
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
