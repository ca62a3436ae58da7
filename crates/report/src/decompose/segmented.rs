//! A segmented cube: categories and objects in tables and a picture.

use crate::figures::Plot;
use crate::plot::{Axis, Painted, Picture, Pictures, categorical};
use crate::shown::Shown;
use crate::table::{Table, number};
use crate::words::decompose::SEGMENTED;
use crate::words::pictures::NOTHING_TOLD;
use hadar_estimate::segmentation::Agreement;
use hadar_study::decompose::{Block, Segmented};

/// The colour of no category.
const NONE: (u8, u8, u8) = (190, 190, 190);

/// What was found of every category.
pub(super) fn categories(found: &Segmented) -> Table {
    let mut table =
        Table::new(["category", "index", "pixels", "decided", "objects", "iou", "iou_by_brightness"]);
    let iou = |agreement: &Option<Agreement>, i: usize| {
        agreement.as_ref().and_then(|one| one.iou.get(i).copied().flatten()).map_or_else(String::new, number)
    };
    for (i, row) in found.categories.iter().enumerate() {
        table.push(vec![
            row.category.clone(),
            i.to_string(),
            row.pixels.to_string(),
            row.decided.to_string(),
            row.objects.to_string(),
            iou(&found.agreement, i),
            iou(&found.agreement_by_brightness, i),
        ]);
    }
    table
}

/// Objects, a row for each; rows and columns from the first to the one after the last.
pub(super) fn objects(found: &Segmented) -> Table {
    Table::of(
        &found.objects,
        &[
            ("category", &|row| row.category.clone()),
            ("pixels", &|row| row.pixels.to_string()),
            ("decided", &|row| row.decided.to_string()),
            ("first_row", &|row| row.rows[0].to_string()),
            ("after_last_row", &|row| row.rows[1].to_string()),
            ("first_column", &|row| row.columns[0].to_string()),
            ("after_last_column", &|row| row.columns[1].to_string()),
            ("temperature_median_k", &|row| number(row.temperature_median_k)),
            ("temperature_sigma_median_k", &|row| number(row.temperature_sigma_median_k)),
        ],
    )
}

/// The map of categories beside the thermal image, of the pixels that are shown.
pub(super) fn plot(found: &Segmented, pixels: &Block, shown: Shown) -> Plot {
    let (places, wide): (Vec<_>, _) = (shown.places().collect(), shown.wide());
    let colour = |category: u8| match usize::from(category) {
        place if place < found.categories.len() => categorical(place),
        _ => NONE,
    };
    let of = |at: &usize| found.map.get(*at).copied().unwrap_or(u8::MAX);
    let painted = places.iter().map(|[_, _, at]| colour(of(at))).collect();
    let thermal: Vec<f64> = pixels.thermal.iter().map(|x| f64::from(*x)).collect();
    let mut table = Table::new(["row", "column", "category", "thermal_photons_s1_m2_sr1"]);
    for ([row, column, at], thermal) in places.iter().zip(&thermal) {
        let name = found.categories.get(usize::from(of(at))).map_or("", |row| row.category.as_str());
        table.push(vec![row.to_string(), column.to_string(), name.to_owned(), number(*thermal)]);
    }
    let pictures = vec![
        Picture::painted("Categories", Axis::linear(""), wide, Painted { pixels: painted, ramp: None }),
        Picture::new(
            "Thermal image, all bands together",
            Axis::linear("radiance (photons s⁻¹ m⁻² sr⁻¹)"),
            wide,
            thermal,
        ),
    ];
    let mut keys: Vec<((u8, u8, u8), String)> = found
        .categories
        .iter()
        .enumerate()
        .filter(|(_, row)| row.pixels > 0)
        .map(|(place, row)| (categorical(place), row.category.clone()))
        .collect();
    if found.none > 0 {
        keys.push((NONE, "none".to_owned()));
    }
    let figure = Pictures::new("What is there, by its materials", pictures)
        .subtitle(SEGMENTED)
        .no_value(NOTHING_TOLD)
        .keys(keys);
    Plot { name: "segmentation".into(), figure: figure.into(), table }
}
