//! A segmented cube in words: categories and objects.

use crate::text::columns::{Columns, left, right};
use crate::text::numbers::degrees;
use hadar::words::{share, significant, whole};
use hadar_estimate::segmentation::{Agreement, Rule};
use hadar_study::decompose::Segmented;
use std::fmt::Write as _;

/// Objects that are listed.
const LISTED: usize = 12;

/// Categories and objects, in words.
pub(super) fn text(found: &Segmented) -> String {
    let width = found.categories.iter().map(|row| row.category.chars().count()).max().unwrap_or(0).max(8);
    let mut table =
        Columns::new([left("", width), right("pixels", 9), right("decided", 9), right("objects", 7)]);
    for row in &found.categories {
        let counts = [row.pixels, row.decided].map(|count| whole(count as u64));
        table.row(std::iter::once(row.category.clone()).chain(counts).chain([row.objects.to_string()]));
    }
    if found.none > 0 {
        table.row(["none", &whole(found.none as u64)]);
    }
    let mut out = format!("Categories\n{}", table.text());
    let _ = writeln!(
        out,
        "\nObjects of {} pixels or more{}",
        found.smallest_object,
        if found.objects.is_empty() { ": none" } else { "" },
    );
    let mut table = Columns::new([
        left("", width),
        right("pixels", 9),
        right("decided", 9),
        right("rows", 13),
        right("columns", 13),
        right("median (degC)", 14),
        right("sigma (K)", 10),
    ]);
    let span = |[first, after]: [usize; 2]| format!("{first} to {}", after - 1);
    let known = |k: f64, shown: &dyn Fn(f64) -> String| if k.is_finite() { shown(k) } else { "-".to_owned() };
    for row in found.objects.iter().take(LISTED) {
        let guessed = if 2 * row.decided < row.pixels { "  undecided" } else { "" };
        table.row([
            row.category.clone(),
            whole(row.pixels as u64),
            whole(row.decided as u64),
            span(row.rows),
            span(row.columns),
            known(row.temperature_median_k, &degrees),
            format!("{:>10}{guessed}", known(row.temperature_sigma_median_k, &|k| significant(k, 2))),
        ]);
    }
    out.push_str(&table.text());
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
