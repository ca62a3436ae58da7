//! A segmented cube: categories and objects in words, tables and a picture.

use super::shown::places;
use crate::figures::Plot;
use crate::plot::{Axis, Painted, Picture, Pictures, categorical};
use crate::table::{Table, number};
use hadar::words::{share, significant, whole};
use hadar_estimate::segmentation::{Agreement, Rule};
use hadar_study::decompose::{Block, Decomposed, Segmented};
use std::fmt::Write as _;

/// 0 degC, K.
const FREEZING_K: f64 = 273.15;
/// Objects that are listed.
const LISTED: usize = 12;
/// The colour of no category.
const NONE: (u8, u8, u8) = (190, 190, 190);

/// Categories and objects, in words.
pub(super) fn text(found: &Segmented) -> String {
    let width = found.categories.iter().map(|row| row.category.chars().count()).max().unwrap_or(0).max(8);
    let mut out =
        format!("Categories\n  {:width$}  {:>9}  {:>9}  {:>7}\n", "", "pixels", "decided", "objects");
    for row in &found.categories {
        let _ = writeln!(
            out,
            "  {:width$}  {:>9}  {:>9}  {:>7}",
            row.category,
            whole(row.pixels as u64),
            whole(row.decided as u64),
            row.objects
        );
    }
    if found.none > 0 {
        let _ = writeln!(out, "  {:width$}  {:>9}", "none", whole(found.none as u64));
    }
    let _ = writeln!(
        out,
        "\nObjects of {} pixels or more{}\n  {:width$}  {:>9}  {:>9}  {:>13}  {:>13}  {:>14}  {:>10}",
        found.smallest_object,
        if found.objects.is_empty() { ": none" } else { "" },
        "",
        "pixels",
        "decided",
        "rows",
        "columns",
        "median (degC)",
        "sigma (K)"
    );
    let span = |[first, after]: [usize; 2]| format!("{first} to {}", after - 1);
    for row in found.objects.iter().take(LISTED) {
        let celsius = match row.temperature_median_k {
            k if k.is_finite() => format!("{:.1}", k - FREEZING_K),
            _ => "-".to_owned(),
        };
        let sigma = match row.temperature_sigma_median_k {
            k if k.is_finite() => significant(k, 2),
            _ => "-".to_owned(),
        };
        let guessed = if 2 * row.decided < row.pixels { "  undecided" } else { "" };
        let _ = writeln!(
            out,
            "  {:width$}  {:>9}  {:>9}  {:>13}  {:>13}  {celsius:>14}  {sigma:>10}{guessed}",
            row.category,
            whole(row.pixels as u64),
            whole(row.decided as u64),
            span(row.rows),
            span(row.columns)
        );
    }
    if let Some(more) = found.objects.len().checked_sub(LISTED).filter(|more| *more > 0) {
        let _ = writeln!(out, "  and {more} more: objects.csv");
    }
    let said = |agreement: &Agreement| match (agreement.mean_iou, agreement.right) {
        (Some(iou), Some(right)) => {
            format!("mIoU {}, {} of the pixels right", significant(iou, 3), share(right))
        }
        (None, Some(right)) => format!("no pixel is of a category or was given one, {} right", share(right)),
        _ => "the truth of no pixel is known".to_owned(),
    };
    if let Some(agreement) = &found.agreement {
        let _ = writeln!(out, "  against what is there: {}", said(agreement));
    }
    if let Some(agreement) = &found.agreement_by_brightness {
        let _ = writeln!(
            out,
            "  the most that the brightness of a pixel in all bands together could say, laid out with what is there: {}",
            said(agreement)
        );
    }
    let rule = match found.rule {
        Rule::Raster => "the neighbour before says it (Algorithm 4 of the paper)",
        Rule::Regions => "what encloses its region, or the outside",
    };
    let _ = writeln!(
        out,
        "  decided: one material left, of this category; objects may join where they touch, and what is not in the library may be taken for what is\n  \
         sigma: of one pixel, its material certain; no category: no material, or none that fits\n  a material in several categories: {rule}{}\n",
        if found.smoothing { "; then the commonest of 5 x 5 pixels" } else { "" }
    );
    out
}

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
    let mut table = Table::new([
        "category",
        "pixels",
        "decided",
        "first_row",
        "after_last_row",
        "first_column",
        "after_last_column",
        "temperature_median_k",
        "temperature_sigma_median_k",
    ]);
    for row in &found.objects {
        let places = [row.pixels, row.decided, row.rows[0], row.rows[1], row.columns[0], row.columns[1]];
        let kelvin =
            [row.temperature_median_k, row.temperature_sigma_median_k].map(|k| match k.is_finite() {
                true => number(k),
                false => String::new(),
            });
        let cells = std::iter::once(row.category.clone());
        table.push(cells.chain(places.map(|place| place.to_string())).chain(kelvin).collect());
    }
    table
}

/// The map of categories beside the thermal image, of the pixels that are shown: every `stride`th row and column.
pub(super) fn plot(result: &Decomposed, found: &Segmented, shown: &Block, stride: usize) -> Plot {
    let (places, wide) = places(result.shape, stride);
    let colour = |category: u8| match usize::from(category) {
        place if place < found.categories.len() => categorical(place),
        _ => NONE,
    };
    let of = |at: &usize| found.map.get(*at).copied().unwrap_or(u8::MAX);
    let pixels = places.iter().map(|[_, _, at]| colour(of(at))).collect();
    let thermal: Vec<f64> = shown.thermal.iter().map(|x| f64::from(*x)).collect();
    let mut table = Table::new(["row", "column", "category", "thermal_photons_s1_m2_sr1"]);
    for ([row, column, at], thermal) in places.iter().zip(&thermal) {
        let name = found.categories.get(usize::from(of(at))).map_or("", |row| row.category.as_str());
        table.push(vec![row.to_string(), column.to_string(), name.to_owned(), number(*thermal)]);
    }
    let pictures = vec![
        Picture::painted("Categories", Axis::linear(""), wide, Painted { pixels, ramp: None }),
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
        .subtitle("Every pixel is in segmentation.npy, every object in objects.csv.")
        .no_value("nothing is told")
        .keys(keys);
    Plot { name: "segmentation".into(), figure: figure.into(), table }
}
